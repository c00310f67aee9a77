//! Groups of blocks without a chain of joints to the ground. They cannot carry loads with a resultant.

use super::problem::{LimitProblem, Velocity};
use crate::model::{Wrenches, root};

/// Share of a sum of loads that is rounding of its terms.
const BALANCED: f64 = 1e-12;

fn inner(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Returns a rigid motion of a floating group on which the fixed loads do work and the varying loads do none. `None` if
/// there is no such group. Loads of all connected floating groups are added; moments are divided by the scene's length.
pub fn loose_motion(problem: &LimitProblem, fixed: &Wrenches, varying: &Wrenches) -> Option<Vec<Velocity>> {
    let ground = problem.groups;
    let mut parent: Vec<usize> = (0..=ground).collect();
    for joint in &problem.joints {
        let ends = [joint.minus, joint.plus].map(|group| root(&mut parent, group.unwrap_or(ground)));
        parent[ends[0]] = ends[1];
    }
    let roots: Vec<usize> = (0..=ground).map(|group| root(&mut parent, group)).collect();
    let floats: Vec<usize> = (0..ground).filter(|&group| roots[group] != roots[ground]).collect();
    let scaled = |w: &[f64; 3]| [w[0], w[1], w[2] / problem.length];
    let sum = |wrenches: &Wrenches, of: usize| {
        let own = floats.iter().filter(|&&group| roots[group] == of).map(|&group| scaled(&wrenches[group]));
        own.fold(([0.0; 3], 0.0), |(mut sum, mut size), w| {
            (0..3).for_each(|i| sum[i] += w[i]);
            size += inner(&w, &w).sqrt();
            (sum, size)
        })
    };
    floats.iter().filter(|&&group| roots[group] == group).find_map(|&of| {
        let ((w, most), (p, live)) = (sum(fixed, of), sum(varying, of));
        let along = if inner(&p, &p).sqrt() > BALANCED * live { inner(&w, &p) / inner(&p, &p) } else { 0.0 };
        let left: [f64; 3] = std::array::from_fn(|i| w[i] - along * p[i]);
        (inner(&left, &left).sqrt() > BALANCED * most).then(|| {
            let velocity = [left[0], left[1], left[2] / problem.length];
            (0..ground).map(|group| if roots[group] == of { velocity } else { [0.0; 3] }).collect()
        })
    })
}
