//! Random problems against complete enumeration.

use super::enumeration::enumerate_modes;
use super::*;
use crate::rate::tree::search;
use voussoir_core::random::Random;

/// A random structure; points are at the apex or pressed and about to slip, the first two in the event.
pub fn case<'a>(laws: &'a [Facet], count: usize, random: &mut Random, number: usize) -> Case<'a> {
    let root = DMatrix::from_fn(2 * count, 2 * count, |_, _| random.signed());
    let s = &root * root.transpose() + DMatrix::identity(2 * count, 2 * count) * 0.01;
    let load: Vec<f64> = (0..2 * count).map(|_| random.signed()).collect();
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
    let mut random = Random::from_state(17);
    (0..2000)
        .map(|number| case(laws, 2, &mut random, number))
        .find(|case| {
            let all = enumerate_modes(&case.problem, &mut 0);
            all.iter().all(|rate| rate.factor < 0.0 && !case.arrival.continues(&case.problem, rate))
        })
        .expect("a problem without a continuation")
}

/// The answer rises if any combination that the path follows rises, otherwise it falls if any combination continues;
/// otherwise it has proofs.
#[test]
fn answers_agree_with_every_combination() {
    let mut random = Random::from_state(11);
    let mut kinds = [0; 4];
    for number in 0..400 {
        let laws = dry(0.3 + 1.2 * (number % 5) as f64, 0.0);
        let case = case(&laws, 1 + number % 3, &mut random, number);
        let all = enumerate_modes(&case.problem, &mut 0);
        let goes = |rate: &&Rate| {
            (rate.factor != 0.0 || case.problem.leads_on(rate)) && case.arrival.continues(&case.problem, rate)
        };
        let sense = |rate: &Rate| rate.factor as i32;
        let followed = |rate: &&Rate| case.arrival.is_followed_by(&case.problem, rate);
        let known = all.iter().filter(goes).filter(followed).map(sense).max();
        let known = known.or_else(|| all.iter().filter(goes).map(sense).max());
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
        assert_eq!(answer.none_rises.is_some(), !all.iter().any(|rate| rate.factor > 0.0), "{number}");
        if let Some(proof) = &answer.none_rises {
            super::proofs::check(&case.problem, proof);
        }
        kinds[found.map_or(3, |factor| (factor + 1) as usize)] += 1;
    }
    assert!(kinds[2] > 100 && kinds[0] > 5 && kinds[3] > 5, "{kinds:?}");
}

/// Mirror-symmetric structures have equal pivots and singular values in pairs; their problems are decided as well.
#[test]
fn mirror_symmetric_problems_are_decided() {
    let laws = dry(0.6, 0.0);
    let mut random = Random::from_state(31);
    for number in 0..60 {
        let half = 1 + number % 3;
        let (s, load) = mirrored(half, &mut random);
        let active = |k: usize| match (number + k.min(2 * half - 1 - k)) % 3 {
            0 => (&[0, 1, 2][..], [0.0; 2]),
            _ if k < half => (&[1][..], [1.0, 0.6]),
            _ => (&[2][..], [1.0, -0.6]),
        };
        let points: Vec<(&[usize], [f64; 2])> = (0..2 * half).map(active).collect();
        let mut case = Case::new(&laws, &points, s.as_slice(), load.as_slice());
        case = case.arriving(0, ContactMode::Stick, true).arriving(2 * half - 1, ContactMode::Stick, true);
        if let Continuation::Open(why) = case.answer().continuation {
            panic!("{number}: {why}");
        }
        for factor in [1.0, -1.0] {
            assert_eq!(search(&case.problem, factor, 10_000, &mut 0).open, None, "{number}");
        }
    }
}

/// S and s of a mirror-symmetric structure: its image changes the sign of tangential rates.
fn mirrored(half: usize, random: &mut Random) -> (DMatrix<f64>, DVector<f64>) {
    let n = 4 * half;
    let image = |i: usize| (n - 2 - i / 2 * 2 + i % 2, if i.is_multiple_of(2) { 1.0 } else { -1.0 });
    let root = DMatrix::from_fn(n, n, |_, _| random.signed());
    let s = &root * root.transpose();
    let push = DVector::from_fn(n, |_, _| random.signed());
    let both = |i: usize, j: usize| {
        let ((k, a), (l, b)) = (image(i), image(j));
        s[(i, j)] + a * b * s[(k, l)]
    };
    (DMatrix::from_fn(n, n, both), DVector::from_fn(n, |i, _| push[i] + image(i).1 * push[image(i).0]))
}

/// A stiffness within rounding of zero gives a mechanism: the load does work on it, and no rate rises.
#[test]
fn a_stiffness_that_is_rounding_is_none() {
    let laws = dry(0.6, 0.0);
    #[rustfmt::skip]
    let s = [
        6.6e-16, -9.3e-15, -3.0e-15, 5.6e-15,
        -9.3e-15, 1.8, -5.8e-5, -1.7e-4,
        -3.0e-15, -5.8e-5, 0.92, 2.2e-8,
        5.6e-15, -1.7e-4, 2.2e-8, 2.45,
    ];
    let case = Case::new(&laws, &[(&[0, 1, 2], [0.0; 2]), (&[1], [1.0, 0.6])], &s, &[-0.0323, 6.2e-4, -5.9e-3, 3.9e-4])
        .arriving(0, ContactMode::Stick, true)
        .arriving(1, SLIP, false);
    let answer = case.answer();
    let Continuation::Goes { rate, .. } = answer.continuation else { panic!("{answer:?}") };
    assert!(rate.factor == 0.0 && rate.modes[0] == ContactMode::Open, "{rate:?}");
    assert!(answer.none_rises.is_some());
}
