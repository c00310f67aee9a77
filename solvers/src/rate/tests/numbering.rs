//! Answers do not depend on the numbering of points.

use super::*;
use voussoir_core::random::Random;

/// The case with its points in another order: point k of the new one is point `order[k]`.
fn permuted<'a>(case: &Case<'a>, order: &[usize]) -> Case<'a> {
    let at = |i: usize| 2 * order[i / 2] + i % 2;
    let n = 2 * order.len();
    Case {
        problem: RateProblem {
            points: order.iter().map(|k| case.problem.points[*k].clone()).collect(),
            s: DMatrix::from_fn(n, n, |i, j| case.problem.s[(at(i), at(j))]),
            load_rate: DVector::from_fn(n, |i, _| case.problem.load_rate[at(i)]),
            metric: None,
            ..case.problem
        },
        arrival: Arrival {
            factor: case.arrival.factor,
            points: order.iter().map(|k| case.arrival.points[*k]).collect(),
        },
    }
}

/// Random problems of three points with two in the event: all six orders give the same answer.
#[test]
fn the_order_of_points_does_not_matter() {
    let laws = dry(4.0, 0.0);
    let mut random = Random::from_state(3);
    let mut senses = [0; 4];
    for number in 0..150 {
        let case = super::random::case(&laws, 3, &mut random, number);
        let of = |answer: &RateAnswer, order: &[usize]| match &answer.continuation {
            Continuation::Goes { rate, .. } => {
                let mut modes = rate.modes.clone();
                order.iter().enumerate().for_each(|(k, original)| modes[*original] = rate.modes[k]);
                format!("{} {modes:?}", rate.factor)
            }
            Continuation::NoneContinues(_) => "none".into(),
            Continuation::Open(why) => why.clone(),
        };
        let first = case.answer();
        let known = of(&first, &[0, 1, 2]);
        for order in [[0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
            let found = of(&permuted(&case, &order).answer(), &order);
            assert_eq!(known, found, "{number} {order:?}");
        }
        senses[match first.continuation {
            Continuation::Goes { rate, .. } => (rate.factor + 1.0) as usize,
            _ => 3,
        }] += 1;
    }
    assert!(senses[0] > 3 && senses[2] > 30, "{senses:?}");
}

/// The proof of a permuted problem refers to the permuted points.
#[test]
fn proofs_follow_the_numbering() {
    let laws = dry(4.0, 0.0);
    let mut random = Random::from_state(5);
    let mut proofs = 0;
    for number in 0..150 {
        let case = permuted(&super::random::case(&laws, 3, &mut random, number), &[2, 0, 1]);
        if let Some(proof) = case.answer().none_rises {
            super::proofs::check(&case.problem, &proof);
            proofs += 1;
        }
    }
    assert!(proofs > 5, "{proofs}");
}
