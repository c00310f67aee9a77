//! Mechanisms under constant forces where the modes leave more than one motion.
//!
//! Blocks that slide side by side move independently of each other. The rate of their modes is then one
//! of many, and the one that linear algebra picks may close a point that is open: it does not go on for ever,
//! and steps along it end nowhere. A linear program finds a mechanism where there is one
//! ([`rate::mechanism`](crate::rate::mechanism)).

use super::measure::load_displacement;
use super::state::{State, Tangent};
use super::system::StepSystem;
use super::tangent::tangent_from;
use crate::contact::facet::slack;
use crate::optimise::dense_simplex::Feasibility;
use crate::rate::mechanism::mechanisms;

/// Slack, relative to the greatest force, up to which a facet may yield.
const YIELDING: f64 = 1e-9;

/// A motion on which the load does work and forces stay as they are (small displacements, laws of facets).
pub(super) fn find_mechanism(system: &mut StepSystem, state: &State) -> Option<Tangent> {
    if system.finite() || !system.piecewise_linear() {
        return None;
    }
    let equations = system.equations(state);
    let (points, bodies) = (state.gap.len(), 3 * system.scaled.bodies);
    let largest = state.force.iter().flatten().fold(0.0, |a: f64, r| a.max(r.abs()));
    let mut flows: Vec<(usize, [f64; 2])> = Vec::new();
    for c in 0..points {
        let Some(law) = system.law(c) else { continue };
        let (r, area) = (state.force[c], system.problem.contacts[c].area);
        for f in &law.facets {
            if slack(f, r, area) <= YIELDING * largest {
                flows.push((c, f.flow));
            }
        }
    }
    let row = |i: usize| {
        let mut row = vec![0.0; bodies];
        system.scaled.kinematics.row(i).iter().for_each(|&(j, v)| row[j] += v);
        row
    };
    let rows: Vec<(usize, [Vec<f64>; 2])> = (0..points).map(|c| (c, [row(2 * c), row(2 * c + 1)])).collect();
    let works = |j: usize| {
        let mut motion = vec![0.0; bodies];
        motion[j] = 1.0;
        load_displacement(system, &system.scaled.motions(&motion), 0.0) / system.units().displacement
    };
    let power: Vec<f64> = (0..bodies).map(works).collect();
    let mut program = mechanisms(&rows, &flows, &power)?;
    system.count("rate_programs", 1);
    if program.feasible() != Feasibility::Point {
        return None;
    }
    let values: Vec<f64> = (0..bodies).map(|j| program.value(j) - program.value(j + bodies)).collect();
    let mut x = vec![0.0; 2 * points];
    x.extend(values);
    x.push(0.0);
    Some(tangent_from(system, &x, state, &equations))
}
