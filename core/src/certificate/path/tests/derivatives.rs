//! Rates of residuals, compared with differences of the residuals of states.

use super::scenes::{dry, point, structure};
use crate::certificate::path::displaced::Displaced;
use crate::certificate::path::displaced_rates::Moving;
use crate::certificate::path::dual::Dual;
use crate::certificate::path::rate_equations::RateEquations;
use crate::model::geometry::Vec2;
use crate::path::{Attachment, PathProblem, PathRate, PathState, Sliding};
use nalgebra::DMatrix;
use std::sync::Arc;

/// Pseudo-random numbers in [−½, ½).
struct Numbers(f64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = (self.0 * 137.0 + 0.618_033_988_749_894_9).fract();
        self.0 - 0.5
    }

    fn array<const N: usize>(&mut self, size: f64) -> [f64; N] {
        std::array::from_fn(|_| size * self.next())
    }
}

/// A block with three points on flexible ground; the block is flexible too and has a load at a fourth point.
fn flexible(numbers: &mut Numbers) -> PathProblem {
    let at = |x: f64| point(Vec2::new(x, 0.1 * x), Vec2::new(0.6, 0.8), dry(0.3), [1e-3, 2e-3]);
    let mut problem = structure(Vec2::new(0.2, 0.7), vec![at(-1.0), at(0.0), at(1.0)], Vec2::new(3.0, -2.0));
    let passing = Sliding { corners: [0.0, 1.0], passing: 0.4, ..Sliding::fixed(0.5) };
    for (slot, contact) in problem.contacts.iter_mut().enumerate() {
        contact.minus = Attachment { body: 0, slot: Some(slot) };
        contact.plus = Attachment { body: 1, slot: Some(slot) };
        contact.gap = 0.01;
        contact.sliding = [Sliding::fixed(0.0), passing, Sliding::fixed(0.7)][slot];
    }
    problem.load_steps[1].loading.forces[0].1 = Some(3);
    for (body, points) in [(0, 3), (1, 4)] {
        problem.bodies[body].points = vec![Vec2::zeros(); points];
        let half = DMatrix::from_fn(2 * points, 2 * points, |_, _| numbers.next());
        problem.bodies[body].flexibility = Some(Arc::new((&half * half.transpose()) * 1e-2));
    }
    problem
}

fn moved(state: &PathState, along: &PathRate, by: f64) -> PathState {
    let mut state = state.clone();
    state.factor += by * along.factor;
    for (own, rate) in state.force.iter_mut().flatten().zip(along.force.iter().flatten()) {
        *own += by * rate;
    }
    for (own, rate) in state.motion.iter_mut().flatten().zip(along.motion.iter().flatten()) {
        *own += by * rate;
    }
    state
}

#[test]
fn rates_of_residuals_are_their_differences() {
    let mut numbers = Numbers(0.3);
    let problem = flexible(&mut numbers);
    for _ in 0..5 {
        let state = PathState {
            load_step: 1,
            factor: 0.7,
            force: (0..3).map(|_| numbers.array(4.0)).collect(),
            gap: vec![[0.0; 2]; 3],
            motion: vec![numbers.array(0.6), numbers.array(0.6)],
            ..PathState::default()
        };
        let along = PathRate {
            factor: numbers.next(),
            force: (0..3).map(|_| numbers.array(1.0)).collect(),
            gap: Vec::new(),
            motion: vec![numbers.array(1.0), numbers.array(1.0)],
        };
        let found = Moving::new(&problem, &state, &along).rates();
        let gaps = found.gaps.into_iter().flat_map(|(_, gap)| gap);
        let found: Vec<Dual> = gaps.chain(found.unbalanced.into_iter().flat_map(|(_, wrench)| wrench)).collect();
        let step = 1e-6;
        let at = |by: f64| {
            let state = moved(&state, &along, by);
            let displaced = Displaced::new(&problem, &state, true);
            [displaced.gaps().concat(), displaced.unbalanced().concat()].concat()
        };
        let (now, above, below) = (at(0.0), at(step), at(-step));
        assert_eq!(found.len(), now.len());
        for (i, found) in found.iter().enumerate() {
            let rate = (above[i] - below[i]) / (2.0 * step);
            assert!((found.value - now[i]).abs() < 1e-13, "{i}");
            assert!((found.rate - rate).abs() < 1e-8, "{i}: {rate} {found:?}");
        }
    }
}

/// The columns of small displacements are differences of residuals; at rest without forces the columns of finite
/// displacements are the same.
#[test]
fn columns_are_those_of_residuals() {
    let mut numbers = Numbers(0.7);
    let problem = flexible(&mut numbers);
    let zero = PathState {
        load_step: 1,
        force: vec![[0.0; 2]; 3],
        gap: vec![[0.0; 2]; 3],
        motion: vec![[0.0; 3]; 2],
        ..PathState::default()
    };
    let mut along = PathRate {
        factor: 0.4,
        force: (0..3).map(|_| numbers.array(1.0)).collect(),
        gap: Vec::new(),
        motion: vec![[0.0; 3], numbers.array(1.0)],
    };
    let [before, after] = [0.0, 1.0].map(|by| {
        let state = moved(&zero, &along, by);
        let displaced = Displaced::new(&problem, &state, false);
        (displaced.gaps().to_vec(), displaced.unbalanced())
    });
    // The dead load is the same in both states.
    let rows = RateEquations::new(&problem, &zero, false).products(&along);
    for i in 0..3 {
        assert!((rows[3 + i][0] - (after.1[1][i] - before.1[1][i])).abs() < 1e-13);
        assert_eq!(rows[i], [0.0; 2], "the ground is held");
        for k in 0..2 {
            assert!((rows[6 + 2 * i + k][0] - (after.0[i][k] - before.0[i][k])).abs() < 1e-13);
        }
    }
    // Without forces nothing depends on the rotation of bodies.
    let mut bare = problem.clone();
    bare.load_steps[0].loading.acceleration = Vec2::zeros();
    along.factor = 0.0;
    let rows = RateEquations::new(&bare, &zero, false).products(&along);
    let finite = RateEquations::new(&bare, &zero, true).products(&along);
    for (small, finite) in rows.iter().zip(&finite) {
        assert!((small[0] - finite[0]).abs() < 1e-13, "{small:?} {finite:?}");
    }
}

/// The columns of finite displacements, each derived from the bodies next to its unknown, add up to the rates of all
/// residuals in any direction: a chain of six flexible blocks with a load on the third.
#[test]
fn columns_near_an_unknown_are_whole() {
    let mut numbers = Numbers(0.2);
    let at = |x: f64, y: f64| point(Vec2::new(x, y), Vec2::new(0.6, 0.8), dry(0.3), [1e-3, 2e-3]);
    let points = (0..5).flat_map(|joint| [0.0, 1.0].map(|y| at(f64::from(joint), y))).collect();
    let mut problem = structure(Vec2::new(0.2, 0.7), points, Vec2::new(3.0, -2.0));
    let bodies = 6;
    problem.bodies = (0..bodies).map(|b| problem.bodies[usize::from(b > 0)].clone()).collect();
    problem.body_of = (0..bodies).collect();
    for (index, contact) in problem.contacts.iter_mut().enumerate() {
        let (joint, end) = (index / 2, index % 2);
        contact.minus = Attachment { body: joint, slot: Some(2 + end) };
        contact.plus = Attachment { body: joint + 1, slot: Some(end) };
        contact.sliding =
            [Sliding::fixed(0.0), Sliding { corners: [0.0, 1.0], passing: 0.4, ..Sliding::fixed(0.5) }][end];
    }
    let load = problem.load_steps[1].loading.forces[0];
    problem.load_steps[1].loading.forces[0] = (2, Some(1), load.2, load.3);
    for body in &mut problem.bodies {
        body.points = vec![Vec2::zeros(); 4];
        let half = DMatrix::from_fn(8, 8, |_, _| numbers.next());
        body.flexibility = Some(Arc::new((&half * half.transpose()) * 1e-2));
    }
    let contacts = problem.contacts.len();
    let state = PathState {
        load_step: 1,
        factor: 0.7,
        force: (0..contacts).map(|_| numbers.array(4.0)).collect(),
        gap: vec![[0.0; 2]; contacts],
        motion: (0..bodies).map(|_| numbers.array(0.6)).collect(),
        ..PathState::default()
    };
    let along = PathRate {
        factor: numbers.next(),
        force: (0..contacts).map(|_| numbers.array(1.0)).collect(),
        gap: Vec::new(),
        motion: (0..bodies).map(|b| if b == 0 { [0.0; 3] } else { numbers.array(1.0) }).collect(),
    };
    let rows = RateEquations::new(&problem, &state, true).products(&along);
    let whole = Moving::new(&problem, &state, &along).rates();
    assert_eq!((whole.gaps.len(), whole.unbalanced.len()), (contacts, bodies));
    for (body, wrench) in &whole.unbalanced[1..] {
        (0..3).for_each(|i| assert!((rows[3 * body + i][0] - wrench[i].rate).abs() < 1e-12, "body {body}"));
    }
    for (contact, gap) in &whole.gaps {
        let row = 3 * bodies + 2 * contact;
        (0..2).for_each(|i| assert!((rows[row + i][0] - gap[i].rate).abs() < 1e-12, "contact point {contact}"));
    }
}
