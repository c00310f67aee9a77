//! Mechanisms under constant forces where the modes leave more than one motion.
//!
//! Blocks that slide side by side move independently of each other. The rate of their modes is then one
//! of many, and the one that linear algebra picks may close a point that is open: it does not go on for ever,
//! and steps along it end nowhere. Every rigid motion with
//!
//! ```text
//! G q̇ = −Σ γ_i d_i over the facets without slack,   γ ≥ 0,   p·q̇ > 0
//! ```
//!
//! is a rate of solution with forces that stand still (the flow of limit analysis at a given field: Livesley
//! 1978, Int. J. Numer. Meth. Engng 12): a linear program finds one where there is one.

use super::measure::load_displacement;
use super::state::{State, Tangent};
use super::system::StepSystem;
use super::tangent::tangent_from;
use crate::optimise::dense_simplex::{Equations, Feasibility};

/// Slack, relative to the greatest force, up to which a facet may yield.
const YIELDING: f64 = 1e-9;

/// A motion on which the load does work and forces stay as they are (small displacements, laws of facets).
pub(super) fn find_mechanism(system: &mut StepSystem, state: &State) -> Option<Tangent> {
    if system.finite() || !system.piecewise_linear() {
        return None;
    }
    let gradient = system.gradient(state);
    let hessian = system.hessian(state, &gradient);
    let (points, bodies) = (state.gap.len(), 3 * system.unknowns.bodies);
    let largest = state.force.iter().flatten().fold(0.0, |a: f64, r| a.max(r.abs()));
    let mut flows: Vec<(usize, [f64; 2])> = Vec::new();
    for c in 0..points {
        let Some(law) = system.law(c) else { continue };
        let (r, area) = (state.force[c], system.problem.contacts[c].area);
        for f in &law.facets {
            if f.bound * area - f.normal[0] * r[0] - f.normal[1] * r[1] <= YIELDING * largest {
                flows.push((c, f.flow));
            }
        }
    }
    // Motions forwards and backwards, then multipliers, in the units of the unknowns.
    let width = 2 * bodies + flows.len();
    let mut rows = vec![vec![0.0; width]; 2 * points + 1];
    for &(i, j, value) in hessian.entries.iter().filter(|e| e.0 < 2 * points && e.1 >= 2 * points) {
        if let Some((column, unit)) = system.column(j) {
            let value = value * unit / system.units().displacement;
            rows[i][column - 2 * points] += value;
            rows[i][column - 2 * points + bodies] -= value;
        }
    }
    for (k, (c, flow)) in flows.iter().enumerate() {
        (0..2).for_each(|i| rows[2 * c + i][2 * bodies + k] += flow[i]);
    }
    for j in 0..bodies {
        let mut motion = vec![0.0; bodies];
        motion[j] = 1.0;
        let works = load_displacement(system, &motion_of(system, &motion)) / system.units().displacement;
        (rows[2 * points][j], rows[2 * points][j + bodies]) = (works, -works);
    }
    let mut right = vec![0.0; 2 * points + 1];
    right[2 * points] = 1.0;
    let mut program = Equations { free: 0, variables: width, rows, right }.dictionary()?;
    system.count("rate_programs", 1);
    if program.feasible() != Feasibility::Point {
        return None;
    }
    let values: Vec<f64> = (0..bodies).map(|j| program.value(j) - program.value(j + bodies)).collect();
    let mut x = vec![0.0; 2 * points];
    x.extend(values);
    x.push(0.0);
    Some(tangent_from(system, &x, state, &hessian))
}

/// Motions of all bodies by those of the free ones in the units of the unknowns.
fn motion_of(system: &StepSystem, values: &[f64]) -> Vec<[f64; 3]> {
    let u = system.units();
    let unit = [u.displacement, u.displacement, u.displacement / u.length];
    let of = |free: &Option<usize>| free.map_or([0.0; 3], |f| [0, 1, 2].map(|k| values[3 * f + k] * unit[k]));
    system.unknowns.free.iter().map(of).collect()
}
