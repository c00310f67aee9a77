//! Units: forces by the loads, displacements by F times the mean compliance, so that the units of a study do not matter.

use super::super::{Load, System, Units};
use super::{system, uneven};
use crate::path::two_blocks::{assert_close, block, pushed_at, scene, settlement, stage};
use voussoir_core::path::{LoadStepEnd, PathProblem};

/// The same scene with lengths × `length` and forces × `force`.
fn rescaled(problem: &PathProblem, length: f64, force: f64) -> PathProblem {
    let mut problem = problem.clone();
    problem.length *= length;
    problem.bodies.iter_mut().for_each(|b| b.pole *= length);
    for c in &mut problem.contacts {
        (c.position, c.gap) = (c.position * length, c.gap * length);
        c.compliance = c.compliance.map(|c| c * length / force);
    }
    for f in problem.load_steps.iter_mut().flat_map(|step| &mut step.loading.forces) {
        (f.2, f.3) = (f.2 * length, f.3 * force);
    }
    problem
}

/// F = Σ|forces| of the first loads, U = F × the mean of all compliances, energy F U.
#[test]
fn units_are_those_of_the_first_loads() {
    let problem = uneven();
    let units = system(&problem).units;
    // The first loads are two weights of 1 N.
    assert_close(units.force, 2.0, 1e-15);
    let all: Vec<f64> = problem.contacts.iter().flat_map(|c| c.compliance).collect();
    let mean = all.iter().sum::<f64>() / all.len() as f64;
    assert_close(units.displacement, 2.0 * mean, 1e-15);
    assert_close(units.energy(), 4.0 * mean, 1e-15);
    assert_close(units.motion()[2], 2.0 * mean / problem.length, 1e-15);
}

/// With settlements u alone F = u/c, with the mean compliance c, and U = u.
#[test]
fn units_of_settlements() {
    let mut problem = block(0.3, pushed_at(0.1));
    problem.load_steps = vec![stage(0, settlement(0, [3e-3, 4e-3, 0.0]), LoadStepEnd::Factor(1.0))];
    let units = system(&problem).units;
    assert_close(units.displacement, 5e-3, 1e-15);
    assert_close(units.force, 5e-3 * 1e4, 1e-10);
}

/// The unit of a factor makes the load as great as F, or the settlement as great as U.
#[test]
fn the_unit_of_a_factor() {
    let problem = uneven();
    let units = system(&problem).units;
    let pushed = &problem.load_steps[1].loading;
    let size: f64 = pushed.forces.iter().map(|f| f.3.norm()).sum();
    assert_close(units.of_factor(&problem, pushed) * size, units.force, 1e-14);
    let moved = settlement(0, [0.0, 2e-3, 0.0]);
    assert_close(units.of_factor(&problem, &moved) * 2e-3, units.displacement, 1e-16);
}

/// A scene without loads and without compliance has units of 1 N and its own length.
#[test]
fn units_without_loads_and_compliance() {
    let idle = scene(uneven().bodies, Vec::new(), Vec::new());
    let units = Units::new(&idle, 0.0);
    assert_eq!((units.force, units.displacement, units.length), (1.0, 1.0, 1.0));
}

/// All scaled numbers are the same in millimetres and kilonewtons.
#[test]
fn scaled_numbers_do_not_depend_on_units() {
    let problem = uneven();
    let other = rescaled(&problem, 1e3, 1e-3);
    let numbers = |problem: &PathProblem| -> Vec<f64> {
        let system = system(problem);
        let load = Load::new(&system, problem, &problem.load_steps[1].loading);
        let rows = |rows: usize, of: &dyn Fn(usize) -> Vec<(usize, f64)>| -> Vec<f64> {
            (0..rows).flat_map(of).map(|entry| entry.1).collect()
        };
        let count = 2 * system.contacts;
        let flexibility = rows(count, &|i| system.flexibility.row(i).to_vec());
        let kinematics = rows(count, &|i| system.kinematics.row(i).to_vec());
        let wrench = load.wrench.iter().flatten().copied();
        [flexibility, kinematics, system.gap.clone(), wrench.collect()].concat()
    };
    let [one, other] = [&problem, &other].map(numbers);
    assert!(one.len() > 30 && one.len() == other.len());
    one.iter().zip(&other).for_each(|(a, b)| assert_close(*b, *a, 1e-12 * a.abs().max(1e-3)));
}

/// Strengths become forces: a bound of c on an area A is c A/F.
#[test]
fn bounds_are_forces_on_areas() {
    let mut problem = uneven();
    problem.contacts[0].law = crate::path::two_blocks::coulomb(0.3, 6.0, 0.0);
    problem.contacts[0].area = 0.5;
    let found: System = system(&problem);
    let facets = found.facets[0].as_ref().expect("facets");
    assert_eq!(facets.iter().map(|f| f.bound).collect::<Vec<_>>(), [0.0, 1.5, 1.5]);
    assert_close(facets[1].bound * found.units.force, 3.0, 1e-14);
}

/// Unknowns are two forces of every point and three motions of every free body.
#[test]
fn the_number_of_unknowns() {
    let found = system(&uneven());
    assert_eq!((found.contacts, found.bodies, found.size()), (4, 2, 14));
    assert_eq!(found.free, [None, Some(0), Some(1)]);
}
