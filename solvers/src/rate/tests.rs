//! Rate problems by every algorithm against complete enumeration.

use super::branching::branching;
use super::enumerate::enumerate_modes;
use super::problem::{RateOutcome, RateProblem};
use crate::contact::active_point::ActivePoint;
use crate::contact::mode::ContactMode;
use crate::optimise::lcg::Lcg;
use nalgebra::{DMatrix, DVector};
use voussoir_core::law::Facet;

/// Dry friction without dilatancy at its apex.
fn facets(friction: f64) -> Vec<Facet> {
    [vec![Facet::opening(0.0)], Facet::friction(friction, 0.0, 0.0).to_vec()].concat()
}

/// Branching and every combination of modes find the same kind of rate.
#[test]
fn branching_agrees_with_every_combination() {
    let mut random = Lcg::new(11);
    let mut kinds = [0; 4];
    for number in 0..300 {
        let count = 1 + number % 3;
        let laws = facets(0.3 + 1.2 * (number % 5) as f64);
        let root = DMatrix::from_fn(2 * count, 2 * count, |_, _| random.next());
        // At the apex, or pressed and slipping one way.
        let point = |k: usize| ActivePoint {
            facets: &laws,
            active: if (number + k).is_multiple_of(4) { vec![0, 1, 2] } else { vec![1 + k % 2] },
            open: None,
            apex: (number + k).is_multiple_of(4),
            guess: ContactMode::Stick,
            hit: true,
            stiffness: 1.0,
        };
        let problem = RateProblem {
            points: (0..count).map(point).collect(),
            s: &root * root.transpose() + DMatrix::identity(2 * count, 2 * count) * 0.01,
            load_rate: DVector::from_fn(2 * count, |_, _| random.next()),
            from_nothing: false,
        };
        let all = enumerate_modes(&problem, &mut 0);
        let known = if all.iter().any(|r| r.factor > 0.0) {
            0
        } else if all.iter().any(|r| r.factor == 0.0) {
            1
        } else if all.iter().any(|r| problem.goes_on(r)) {
            2
        } else {
            3
        };
        let found = match branching(&problem, &mut 0).expect("decided") {
            RateOutcome::Found(rate, _) if rate.factor > 0.0 => 0,
            RateOutcome::Found(..) => 1,
            RateOutcome::Falling(_) => 2,
            _ => 3,
        };
        assert_eq!(known, found, "{number}: {all:?}");
        kinds[known] += 1;
    }
    assert!(kinds[0] > 100 && kinds[2] + kinds[3] > 10, "{kinds:?}");
}
