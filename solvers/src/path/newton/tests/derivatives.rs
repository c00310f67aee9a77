//! The derivatives of the potential against finite differences, and objectivity.

use crate::linear::blocks::GapRows;
use crate::linear::csr::CsrMatrix;
use crate::path::newton::model::geometry::{Geometry, Place};
use crate::path::newton::model::kinematics::{gradient as gradient_of, hessian as hessian_of};
use crate::path::newton::model::loads::Loads;
use crate::path::two_blocks::body;
use nalgebra::{DMatrix, Rotation2};
use voussoir_core::limit::Counters;
use voussoir_core::model::geometry::Vec2;
use voussoir_core::path::{
    Attachment, Contact, LoadStep, LoadStepEnd, Loading, PathProblem, Period, PointLaw, Sliding,
};

/// A symmetric positive definite matrix of plausible entries.
fn flexibility(rows: usize) -> DMatrix<f64> {
    let a = DMatrix::from_fn(rows, rows, |i, j| ((7 * i + 3 * j * j + 1) as f64).sin());
    (&a * a.transpose()) * 0.02 + DMatrix::identity(rows, rows) * 0.01
}

/// A held body, two elastic ones and a rigid one in a chain, loads on two of them.
fn chain() -> PathProblem {
    let points = [Vec2::new(0.0, 0.0), Vec2::new(1.0, 0.2), Vec2::new(2.0, -0.1)];
    let load = Vec2::new(0.6, 0.5);
    let bodies = vec![
        body(Vec2::new(-0.5, 0.1), vec![], None, true),
        body(Vec2::new(0.5, 0.1), vec![points[0], points[1], load], Some(flexibility(6)), false),
        body(Vec2::new(1.5, 0.0), vec![points[1], points[2]], Some(flexibility(4)), false),
        body(Vec2::new(2.5, 0.0), vec![], None, false),
    ];
    let slots = [(None, Some(0)), (Some(1), Some(0)), (Some(1), None)];
    let contacts = (0..3)
        .map(|i| {
            let normal = Rotation2::new(0.3 * i as f64 - 0.2) * Vec2::new(1.0, 0.0);
            Contact {
                joint: i,
                position: points[i],
                normal,
                tangent: Vec2::new(-normal.y, normal.x),
                minus: Attachment { body: i, slot: slots[i].0 },
                plus: Attachment { body: i + 1, slot: slots[i].1 },
                area: 1.0,
                gap: 0.01,
                law: PointLaw::Bonded,
                compliance: [0.003, 0.007],
                sliding: Sliding::middle(0.0),
            }
        })
        .collect();
    let loading = Loading {
        forces: vec![(1, Some(2), load, Vec2::new(0.3, -1.0)), (3, None, Vec2::new(2.6, 0.4), Vec2::new(-0.5, 0.2))],
        acceleration: Vec2::new(0.4, -0.9),
        settlements: vec![(0, [0.02, -0.03, 0.1])],
    };
    PathProblem {
        bodies,
        body_of: vec![0, 1, 2, 3],
        contacts,
        load_steps: vec![LoadStep {
            stage: 0,
            gravity: false,
            loading,
            start: 0.0,
            end: LoadStepEnd::Factor(1.0),
            period: Period::default(),
        }],
        length: 3.0,
        span: 3.0,
        counters: Counters::new(),
        width: 1.0,
    }
}

fn some_state() -> (Vec<[f64; 2]>, Vec<[f64; 3]>) {
    let force = (0..3).map(|i| [1.0 + i as f64, 0.5 - 0.4 * i as f64]).collect();
    let motion = (0..4).map(|i| [0.1 * i as f64, 0.05 - 0.1 * i as f64, 0.3 - 0.25 * i as f64]).collect();
    (force, motion)
}

/// The chain with rigid bodies, whose points slide on one face, on the other, and in between.
fn sliding_chain() -> PathProblem {
    let mut problem = chain();
    problem.bodies.iter_mut().for_each(|body| body.flexibility = None);
    problem.load_steps[0].loading.forces[0].1 = None;
    for (contact, share) in problem.contacts.iter_mut().zip([0.0, 1.0, 0.3]) {
        (contact.minus.slot, contact.plus.slot) = (None, None);
        contact.sliding = Sliding::fixed(share);
    }
    problem
}

/// The same, whose points pass from the middle to a corner as they slip.
fn passing_chain() -> PathProblem {
    let mut problem = sliding_chain();
    let corners = [[0.0, 1.0], [1.0, 0.0], [1.0, 1.0]];
    for ((contact, passing), corners) in problem.contacts.iter_mut().zip([0.4, 0.9, 1.7]).zip(corners) {
        contact.sliding = Sliding { passing, corners, ..Sliding::middle(0.0) };
    }
    problem
}

/// The matrix and the column of λ are the derivatives of gaps and balance, and symmetric.
#[test]
fn the_tangent_is_the_derivative() {
    for (problem, finite) in [(chain(), false), (chain(), true), (sliding_chain(), true), (passing_chain(), true)] {
        let geometry = Geometry::new(&problem, finite);
        let (force, mut motion) = some_state();
        let loading = &problem.load_steps[0].loading;
        let settle = |motion: &mut Vec<[f64; 3]>, factor: f64| {
            motion[0] = [0.02 * factor, -0.03 * factor, 0.1 * factor];
        };
        let factor = 0.7;
        settle(&mut motion, factor);
        let flat = |force: &[[f64; 2]], motion: &[[f64; 3]], factor: f64| {
            let s = gradient_of(
                &geometry,
                &Place { force, motion, loads: &Loads { parts: vec![(factor, loading)] }, blocks: &[] },
            );
            let mut all: Vec<f64> = s.gap.iter().flatten().copied().collect();
            all.extend(s.balance.iter().flatten());
            all
        };
        let loads = Loads { parts: vec![(factor, loading)] };
        let place = Place { force: &force, motion: &motion, loads: &loads, blocks: &[] };
        let gradient = gradient_of(&geometry, &place);
        let hessian = hessian_of(&geometry, &place, &gradient);
        let size = 6 + 12;
        let mut dense = DMatrix::zeros(size, size);
        for &(i, j, value) in &hessian.entries {
            dense[(i, j)] += value;
        }
        let empty = CsrMatrix::empty(6);
        let forces = GapRows { forces: hessian.forces.clone(), others: empty };
        (0..6).for_each(|i| forces.row(i).for_each(|(j, value)| dense[(i, j)] += value));
        assert!((&dense - dense.transpose()).amax() < 1e-13);
        let h = 1e-6;
        let mut checked = 0;
        for j in 0..=size {
            let at = |step: f64| {
                let (mut f, mut m, mut l) = (force.clone(), motion.clone(), factor);
                match j {
                    j if j < 6 => f[j / 2][j % 2] += step,
                    j if j < size => m[(j - 6) / 3][(j - 6) % 3] += step,
                    _ => {
                        l += step;
                        settle(&mut m, l);
                    }
                }
                flat(&f, &m, l)
            };
            let (above, below) = (at(h), at(-h));
            for i in 0..size {
                let difference = (above[i] - below[i]) / (2.0 * h);
                let exact = if j < size { dense[(i, j)] } else { hessian.factor[i] };
                assert!(
                    (difference - exact).abs() < 1e-8,
                    "finite {finite}, row {i}, column {j}: {difference} {exact}"
                );
                checked += 1;
            }
        }
        assert_eq!(checked, 18 * 19);
    }
}

/// Gaps and balance of a scene turned as a whole by a large rotation, loads with it: gaps the same,
/// forces turned, moments the same.
#[test]
fn gaps_are_objective() {
    let mut problem = chain();
    problem.load_steps[0].loading.settlements.clear();
    let (force, motion) = some_state();
    let loading = problem.load_steps[0].loading.clone();
    let geometry = Geometry::new(&problem, true);
    let before = gradient_of(
        &geometry,
        &Place { force: &force, motion: &motion, loads: &Loads { parts: vec![(1.0, &loading)] }, blocks: &[] },
    );
    for angle in [1.0, 3.0, 40.0] {
        let turn = Rotation2::new(angle);
        let turned: Vec<[f64; 3]> = motion
            .iter()
            .zip(&problem.bodies)
            .map(|(q, b)| {
                let place = turn * (b.pole + Vec2::new(q[0], q[1])) - b.pole;
                [place.x, place.y, q[2] + angle]
            })
            .collect();
        let mut load = loading.clone();
        load.acceleration = turn * load.acceleration;
        load.forces.iter_mut().for_each(|f| f.3 = turn * f.3);
        let after = gradient_of(
            &geometry,
            &Place { force: &force, motion: &turned, loads: &Loads { parts: vec![(1.0, &load)] }, blocks: &[] },
        );
        for (a, b) in after.gap.iter().flatten().zip(before.gap.iter().flatten()) {
            assert!((a - b).abs() < 1e-13, "{a} {b}");
        }
        for (a, b) in after.balance.iter().zip(&before.balance) {
            let b_turned = turn * Vec2::new(b[0], b[1]);
            assert!((Vec2::new(a[0], a[1]) - b_turned).norm() < 1e-13 && (a[2] - b[2]).abs() < 1e-13);
        }
        assert!((after.stored - before.stored).abs() < 1e-13);
    }
}
