//! The order of bodies and joints along a chain.

use super::super::chain::ranks;
use crate::path::two_blocks::{between, forces, ground, point, rigid, scene, stack, v};
use voussoir_core::path::PathProblem;

/// A scene of `free` blocks and the ground, body 0, with a point for each joint.
fn joined(free: usize, joints: &[(usize, usize)]) -> PathProblem {
    let mut bodies = vec![ground()];
    bodies.extend((0..free).map(|_| rigid(v(0.0, 0.0))));
    let contacts = joints.iter().map(|&(a, b)| between(a, b, point(0, v(0.0, 0.0), v(0.0, 1.0), 0.3, 0.0)));
    scene(bodies, contacts.collect(), Vec::new())
}

fn of(problem: &PathProblem) -> Option<Vec<usize>> {
    let free: Vec<Option<usize>> = (0..problem.bodies.len()).map(|b| b.checked_sub(1)).collect();
    ranks(problem, &free)
}

/// All unknowns of one point, and of one body, have one rank.
#[test]
fn unknowns_that_belong_together_have_one_rank() {
    let problem = stack([0.3, 0.5], forces(&[]));
    let ranks = of(&problem).expect("a chain");
    assert_eq!(ranks.len(), 4 * 2 + 2 * 3);
    let (joints, bodies) = ranks.split_at(8);
    // Two points of each joint.
    assert!(joints.chunks(4).all(|joint| joint.iter().all(|rank| *rank == joint[0])), "{ranks:?}");
    assert!(bodies.chunks(3).all(|body| body.iter().all(|rank| *rank == body[0])), "{ranks:?}");
}

/// In a tower the joint between two blocks lies between them: the equations of a joint reach over neighbouring ranks.
#[test]
fn a_joint_lies_beside_its_bodies() {
    let ranks = of(&joined(5, &[(0, 1), (1, 2), (2, 3), (3, 4), (4, 5)])).expect("a chain");
    for joint in 1..5 {
        let [minus, plus] = [joint - 1, joint].map(|body| ranks[10 + 3 * body]);
        assert!(ranks[2 * joint].abs_diff(minus) <= 2 && ranks[2 * joint].abs_diff(plus) <= 2, "{ranks:?}");
    }
}

/// Two towers that do not touch are eliminated one after the other: their ranks do not overlap.
#[test]
fn separate_parts_have_separate_ranks() {
    let ranks = of(&joined(4, &[(0, 1), (1, 2), (0, 3), (3, 4)])).expect("two chains");
    let part = |joints: [usize; 2], bodies: [usize; 2]| {
        let all = joints.map(|j| ranks[2 * j]).into_iter().chain(bodies.map(|b| ranks[8 + 3 * b]));
        let all: Vec<usize> = all.collect();
        (*all.iter().min().expect("ranks"), *all.iter().max().expect("ranks"))
    };
    let (one, other) = (part([0, 1], [0, 1]), part([2, 3], [2, 3]));
    assert!(one.1 < other.0 || other.1 < one.0, "{ranks:?}");
}

/// A ring of six blocks has at most two bodies in a level: it is a chain.
#[test]
fn a_ring_is_a_chain() {
    let ring = joined(6, &[(1, 2), (2, 3), (3, 4), (4, 5), (5, 6), (6, 1)]);
    assert!(of(&ring).is_some());
}

/// Three arms of blocks are a chain: from the end of one of them the other two have two bodies in a level.
#[test]
fn three_arms_are_a_chain() {
    assert!(of(&joined(7, &[(1, 2), (2, 3), (1, 4), (4, 5), (1, 6), (6, 7)])).is_some());
}

/// Four arms do not form a chain: three bodies lie in one level.
#[test]
fn four_arms_are_no_chain() {
    assert_eq!(of(&joined(5, &[(1, 2), (1, 3), (1, 4), (1, 5)])), None);
}
