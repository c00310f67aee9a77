//! Random problems against complete enumeration.

use super::*;
use crate::optimise::lcg::Lcg;
use crate::rate::enumerate::enumerate_modes;

/// A random structure; points are at the apex or pressed and about to slip, the first two in the event.
pub fn case<'a>(laws: &'a [Facet], count: usize, random: &mut Lcg, number: usize) -> Case<'a> {
    let root = DMatrix::from_fn(2 * count, 2 * count, |_, _| random.next());
    let s = &root * root.transpose() + DMatrix::identity(2 * count, 2 * count) * 0.01;
    let load: Vec<f64> = (0..2 * count).map(|_| random.next()).collect();
    let friction = -laws[1].normal[0];
    let points: Vec<(&[usize], [f64; 2])> = (0..count)
        .map(|k| match (number + k) % 4 {
            0 => (&[0, 1, 2][..], [0.0; 2]),
            1 => (&[2][..], [1.0, -friction]),
            _ => (&[1][..], [1.0 + 0.3 * k as f64, friction * (1.0 + 0.3 * k as f64)]),
        })
        .collect();
    let mut case = Case::new(laws, &points, s.as_slice(), &load);
    for k in 0..count.min(2) {
        case = case.arriving(k, ContactMode::Stick, true);
    }
    case
}

/// The first random problem without a continuation.
pub fn without_continuation(laws: &[Facet]) -> Case<'_> {
    let mut random = Lcg::new(17);
    (0..2000)
        .map(|number| case(laws, 2, &mut random, number))
        .find(|case| {
            let all = enumerate_modes(&case.problem, &mut 0);
            all.iter().all(|rate| rate.factor < 0.0 && !case.arrival.continues(&case.problem, rate))
        })
        .expect("a problem without a continuation")
}

/// The answer rises where any combination does, else falls where any combination continues; else it has proofs.
#[test]
fn answers_agree_with_every_combination() {
    let mut random = Lcg::new(11);
    let mut kinds = [0; 4];
    for number in 0..400 {
        let laws = dry(0.3 + 1.2 * (number % 5) as f64, 0.0);
        let case = case(&laws, 1 + number % 3, &mut random, number);
        let all = enumerate_modes(&case.problem, &mut 0);
        let going = all.iter().filter(|rate| {
            (rate.factor != 0.0 || case.problem.leads_on(rate)) && case.arrival.continues(&case.problem, rate)
        });
        let known = going.map(|rate| rate.factor as i32).max();
        let answer = case.answer();
        let found = match &answer.continuation {
            Continuation::Goes { rate, .. } => {
                assert!(case.problem.admits(rate), "{number}: {rate:?}");
                Some(rate.factor as i32)
            }
            Continuation::NoneContinues(proofs) => {
                proofs.iter().for_each(|proof| super::proofs::check(&case.problem, proof));
                None
            }
            Continuation::Open(why) => panic!("{number}: {why}"),
        };
        assert_eq!(known, found, "{number}: {all:?}");
        assert_eq!(answer.none_rises.is_some(), found != Some(1), "{number}");
        if let Some(proof) = &answer.none_rises {
            super::proofs::check(&case.problem, proof);
        }
        kinds[found.map_or(3, |factor| (factor + 1) as usize)] += 1;
    }
    assert!(kinds[2] > 100 && kinds[0] > 5 && kinds[3] > 5, "{kinds:?}");
}
