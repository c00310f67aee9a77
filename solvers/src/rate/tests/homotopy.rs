//! Piecewise linear homotopy against complete enumeration.

use super::enumeration::enumerate_modes;
use super::*;
use crate::optimise::lcg::Lcg;
use crate::rate::homotopy::rate_by_homotopy;

/// Points at the apex of friction without dilatancy: homotopy finds a rate in nearly all problems in which one rises.
#[test]
fn homotopy_finds_rates_that_rise() {
    let laws = dry(0.7, 0.0);
    let mut random = Lcg::new(5);
    let (mut rising, mut found) = (0, 0);
    for number in 0..200 {
        let count = 1 + number % 4;
        let root = DMatrix::from_fn(2 * count, 2 * count, |_, _| random.next());
        let s = &root * root.transpose() + DMatrix::identity(2 * count, 2 * count) * 0.01;
        let load: Vec<f64> = (0..2 * count).map(|_| random.next()).collect();
        let points = vec![(&[0, 1, 2][..], [0.0; 2]); count];
        let case = Case::new(&laws, &points, s.as_slice(), &load);
        let rises = enumerate_modes(&case.problem, &mut 0).iter().any(|rate| rate.factor > 0.0);
        rising += usize::from(rises);
        if let Some(rate) = rate_by_homotopy(&case.problem, &mut 0) {
            assert!(rises && rate.factor == 1.0 && case.problem.admits(&rate), "{number}");
            found += 1;
        }
    }
    assert!(rising > 100 && 20 * found >= 19 * rising, "{found} of {rising}");
}
