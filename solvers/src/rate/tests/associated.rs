//! Associated flow without softening: a monotone problem, which needs no enumeration.

use super::*;
use crate::rate::counts::Algorithm;
use crate::rate::proof::ModeTree;
use voussoir_core::random::Random;

/// A random structure on points at the apex or pressed, with associated friction.
fn random_case(laws: &[Facet], count: usize, columns: usize, seed: u64) -> Case<'_> {
    let mut random = Random::from_state(seed);
    let root = DMatrix::from_fn(2 * count, columns, |_, _| random.signed());
    let s = &root * root.transpose();
    let mut load = &root * DVector::from_fn(columns, |_, _| random.signed());
    if columns < count {
        load = DVector::from_fn(2 * count, |_, _| random.signed());
    }
    let load: Vec<f64> = load.iter().copied().collect();
    let active: Vec<&[usize]> = (0..count).map(|k| if k % 3 == 0 { &[0, 1, 2][..] } else { &[1][..] }).collect();
    let points: Vec<(&[usize], [f64; 2])> = active.iter().map(|own| (*own, [1.0, 0.5])).collect();
    Case::new(laws, &points, s.transpose().as_slice(), &load)
}

/// Thirty-four points are solved by a few linear systems and pivots.
#[test]
fn many_associated_points_need_no_enumeration() {
    let laws = dry(0.5, 0.5);
    for seed in 0..10 {
        let case = random_case(&laws, 34, 80, seed);
        let mut counts = RateCounts::default();
        let found = answer(&case.problem, &case.arrival, &Budget { combinations: 1, leaves: 1 }, &mut counts);
        let Continuation::Goes { rate, .. } = found.continuation else { panic!("{seed}: {found:?}") };
        assert!(rate.factor == 1.0 && case.problem.admits(&rate) && counts.trials < 2000, "{seed}: {}", counts.trials);
    }
}

/// With fewer freedoms than points the load meets mechanisms: each is proved by one dual vector.
#[test]
fn an_associated_mechanism_has_one_dual_vector() {
    let laws = dry(0.5, 0.5);
    let (mut mechanisms, mut rising) = (0, 0);
    for seed in 0..40 {
        let case = random_case(&laws, 12, 9, seed);
        let found =
            answer(&case.problem, &case.arrival, &Budget { combinations: 1, leaves: 1 }, &mut RateCounts::default());
        let Continuation::Goes { rate, .. } = found.continuation else { panic!("{seed}: {found:?}") };
        assert!(case.problem.admits(&rate), "{seed}");
        if rate.factor == 0.0 {
            let proof = found.none_rises.expect("a proof");
            assert!(matches!(proof.tree, ModeTree::Contradiction(_)) && case.problem.power(&rate.gaps) > 0.0);
            super::proofs::check(&case.problem, &proof);
            mechanisms += 1;
        } else {
            rising += 1;
        }
    }
    assert!(mechanisms > 5 && rising > 5, "{mechanisms} {rising}");
}

/// A cycle of the active set does not matter: pivoting decides.
#[test]
fn pivoting_decides_if_the_active_set_does_not() {
    let laws = dry(0.5, 0.5);
    let mut counts = RateCounts::default();
    for seed in 0..60 {
        let case = random_case(&laws, 12, 14, seed);
        let found = answer(&case.problem, &case.arrival, &Budget::default(), &mut counts);
        assert!(matches!(found.continuation, Continuation::Goes { .. }), "{seed}");
    }
    assert!(counts.decided.contains_key(&Algorithm::Neighbours));
}

/// Softening (geometry) makes an associated problem non-convex: it is searched like any other.
#[test]
fn an_associated_problem_that_softens_is_searched() {
    let laws = dry(0.5, 0.5);
    let case = Case::slipping(&laws, 1, &[-1.0, 0.0, 0.0, -1.0], &[0.0, 1.0]).arriving(0, ContactMode::Stick, true);
    let answer = case.answer();
    let Continuation::Goes { rate, .. } = answer.continuation else { panic!() };
    assert_eq!(rate.factor, -1.0);
    super::proofs::check(&case.problem, &answer.none_rises.expect("a proof"));
}
