//! Whether a rate with growing λ starts at a converged state (small displacements).
//!
//! Points with slack in all facets stay stuck, open ones open. At the others, which are at the verge of a change,
//!
//! ```text
//! ġ = −Σ γ_i d_i,   ṡ_i = −a_i·ṙ,   0 ≤ γ_i ⟂ ṡ_i ≥ 0   over the facets without slack
//! ```
//!
//! (all three facets of dry friction at its apex together give opening and slip). With these points
//! taken as stuck equilibrium and elasticity are one factorisation, ṡ = q λ̇ + M γ, and λ̇ = 1 leaves a
//! linear complementarity problem (Klarbring 1990, Ing.-Arch. 60), which is searched to its end. Where
//! an opening facet with strength is open already its multiplier has any sign: it belongs to the
//! factorised modes, and only the point's other facets are pairs.

use super::state::{State, Tangent};
use super::system::StepSystem;
use super::tangent::tangent_from;
use crate::contact::mode::ContactMode;
use crate::optimise::branching::{LcpAnswer, solve_by_branching};
use crate::optimise::lcp::Lcp;
use nalgebra::{DMatrix, DVector};
use voussoir_core::law::FacetMode;
use voussoir_core::linear::{Entries, SparseLu};

/// Slack, relative to the greatest force, up to which a facet may yield in a rate.
const VERGE: f64 = 1e-8;

/// Residual of a response, relative to what it is made of.
const RESIDUAL: f64 = 1e-9;

/// Shift of the factorised matrix, taken out by refinement.
const SHIFT: f64 = 1e-11;

/// Linear programs of a search.
const MOST: u64 = 20_000;

/// Contact points at the verge of a change.
struct Verge {
    /// (contact point, facet) without slack.
    facets: Vec<(usize, usize)>,
    /// Regimes that are factorised.
    modes: Vec<ContactMode>,
}

/// The rate problem of a state.
struct RateProblem {
    problem: Lcp,
    /// Multiplier of each facet per unit of z.
    units: Vec<f64>,
    /// Rates of all unknowns but λ by each multiplier and, last, by λ̇ in the sense asked for.
    responses: Vec<Vec<f64>>,
}

/// What is known of rates with growing λ.
pub(super) enum Rising {
    /// There is none.
    None,
    /// One, with its modes.
    Tangent(Tangent, Vec<ContactMode>),
    /// Not decided, and why.
    Unknown(String),
}

/// Looks for a rate with λ growing in the sense `direction` at a converged state, or proves that there is none.
pub(super) fn limit_point_test(system: &mut StepSystem, state: &State, direction: f64) -> Rising {
    let verge = active_set(system, state);
    let facets = verge.facets.len();
    system.count("factorisations", 1);
    let Some(rate) = rate_problem(system, state, &verge, direction) else {
        return Rising::Unknown(format!("the stiffness of {facets} facets at the verge of yielding was not found"));
    };
    let (known, programs) = solve_by_branching(&rate.problem, MOST);
    system.count("rate_programs", programs);
    match known {
        LcpAnswer::NoSolution => Rising::None,
        LcpAnswer::Undecided(why) => {
            Rising::Unknown(format!("{facets} facets at the verge of yielding may let the load grow: {why}"))
        }
        LcpAnswer::Solution(z) => {
            let mut x = rate.responses[facets].clone();
            for ((by, z), unit) in rate.responses.iter().zip(&z).zip(&rate.units) {
                x.iter_mut().zip(by).for_each(|(x, by)| *x += z * unit * by);
            }
            x.push(direction);
            let gradient = system.gradient(state);
            let hessian = system.hessian(state, &gradient);
            let found = tangent_from(system, &x, state, &hessian);
            Rising::Tangent(found, modes_of(system, &verge, &z))
        }
    }
}

/// Regimes in which the facets with z > 0 yield.
fn modes_of(system: &StepSystem, verge: &Verge, z: &[f64]) -> Vec<ContactMode> {
    let largest = z.iter().fold(0.0, |a: f64, z| a.max(*z));
    let mut modes = verge.modes.clone();
    for (&(c, i), _) in verge.facets.iter().zip(z).filter(|(_, z)| **z > 1e-9 * largest) {
        let Some(law) = system.law(c) else { continue };
        modes[c] = match modes[c] {
            ContactMode::Stick => ContactMode::Facet(i as u8),
            // Both senses of slip at the apex: it opens.
            ContactMode::Facet(j) => law.mode_of_pair(i, j as usize).unwrap_or(ContactMode::Facet(j)),
            corner => corner,
        };
    }
    modes
}

fn active_set(system: &StepSystem, state: &State) -> Verge {
    let largest = state.force.iter().flatten().map(|r| r.abs()).fold(0.0, f64::max);
    let (mut facets, mut modes) = (Vec::new(), state.mode.clone());
    for (c, mode) in modes.iter_mut().enumerate() {
        let (Some(law), area, r) = (system.law(c), system.problem.contacts[c].area, state.force[c]) else { continue };
        let slack = |i: usize| {
            let f = &law.facets[i];
            f.bound * area - f.normal[0] * r[0] - f.normal[1] * r[1]
        };
        let active = (0..law.facets.len()).filter(|i| slack(*i) <= VERGE * largest);
        let (_, opening) = law.irreversible(state.mode[c], system.step_gap(state, state, c));
        if !(law.opens(state.mode[c]) && opening > 1e-9 * system.units().displacement) {
            *mode = ContactMode::Stick;
            facets.extend(active.map(|i| (c, i)));
            continue;
        }
        let opens = |i: &usize| law.facets[*i].mode == FacetMode::Opening;
        if let Some(facet) = (0..law.facets.len()).find(|i| opens(i) && law.facets[*i].bound > 0.0) {
            *mode = ContactMode::Facet(facet as u8);
            facets.extend(active.filter(|i| !opens(i)).map(|i| (c, i)));
        }
    }
    Verge { facets, modes }
}

/// Slack rates by multipliers and by λ̇ in the sense `direction`. `None` where linear algebra fails.
fn rate_problem(system: &mut StepSystem, state: &State, verge: &Verge, direction: f64) -> Option<RateProblem> {
    let gradient = system.gradient(state);
    let hessian = system.hessian(state, &gradient);
    let (u, points) = (system.units(), state.gap.len());
    let size = system.size() - 1;
    let rotates = |row: usize| (row - 2 * points) % 3 == 2;
    // Gap rows by the modes, equilibrium of the bodies; and −∂/∂λ of both.
    let mut rows: Vec<Vec<(usize, f64)>> = vec![Vec::new(); size];
    let mut driven = vec![0.0; size];
    let row_of = |i: usize, value: f64| {
        if i < 2 * points {
            return Some((i, value / u.displacement));
        }
        let (row, _) = system.column(i)?;
        Some((row, value / if rotates(row) { u.force * u.length } else { u.force }))
    };
    for &(i, j, value) in &hessian.entries {
        if let (Some((row, value)), Some((column, unit))) = (row_of(i, value), system.column(j)) {
            rows[row].push((column, value * unit));
        }
    }
    for (i, value) in hessian.factor.iter().enumerate().filter(|(_, v)| **v != 0.0) {
        if let Some((row, value)) = row_of(i, value * u.factor) {
            driven[row] -= value * direction;
        }
    }
    let weighted = |c: usize, weight: [f64; 2]| {
        let [n, t] = [0, 1].map(|k| rows[2 * c + k].iter().map(move |&(j, v)| (j, v * weight[k])));
        n.chain(t).collect::<Vec<_>>()
    };
    let (mut entries, mut shift): (Entries, Entries) = (Vec::new(), Vec::new());
    let mut right = driven.clone();
    for (c, mode) in verge.modes.iter().enumerate() {
        let own: [Vec<(usize, f64)>; 2] = match (mode, system.law(c)) {
            (ContactMode::Facet(i), Some(law)) => {
                let f = &law.facets[*i as usize];
                right[2 * c] = 0.0;
                right[2 * c + 1] = driven[2 * c] * f.flow[1] - driven[2 * c + 1] * f.flow[0];
                [vec![(2 * c, f.normal[0]), (2 * c + 1, f.normal[1])], weighted(c, [f.flow[1], -f.flow[0]])]
            }
            (ContactMode::Corner(..) | ContactMode::Open, Some(_)) => {
                (0..2).for_each(|k| right[2 * c + k] = 0.0);
                [vec![(2 * c, 1.0)], vec![(2 * c + 1, 1.0)]]
            }
            _ => {
                shift.extend((0..2).map(|k| (2 * c + k, 2 * c + k, SHIFT)));
                [weighted(c, [1.0, 0.0]), weighted(c, [0.0, 1.0])]
            }
        };
        for (k, row) in own.into_iter().enumerate() {
            entries.extend(row.into_iter().map(|(j, v)| (2 * c + k, j, v)));
        }
    }
    for (row, own) in rows.iter().enumerate().skip(2 * points) {
        entries.extend(own.iter().map(|&(j, v)| (row, j, v)));
        shift.push((row, row, -SHIFT));
    }
    let facet = |&(c, i): &(usize, usize)| system.law(c).map(|law| law.facets[i]);
    let mut all = Vec::with_capacity(verge.facets.len() + 1);
    for at in &verge.facets {
        let (c, flow) = (at.0, facet(at)?.flow);
        let mut unit = vec![0.0; size];
        match (verge.modes[c], system.law(c)) {
            (ContactMode::Facet(o), Some(law)) => {
                let d = law.facets[o as usize].flow;
                unit[2 * c + 1] = -flow[0] * d[1] + flow[1] * d[0];
            }
            _ => (0..2).for_each(|k| unit[2 * c + k] = -flow[k]),
        }
        all.push(unit);
    }
    all.push(right);
    let x = SparseLu::shifted(size, &entries, &shift)?.solve(&all, 3)?;
    for (x, right) in x.iter().zip(&all) {
        let (mut rest, mut parts) = (right.clone(), 0.0f64);
        for &(i, j, v) in &entries {
            rest[i] -= v * x[j];
            parts = parts.max((v * x[j]).abs());
        }
        if rest.iter().any(|r| r.is_nan() || r.abs() > RESIDUAL * parts) {
            return None;
        }
    }
    let n = verge.facets.len();
    let slack = |i: usize, x: &[f64]| {
        let (c, normal) = (verge.facets[i].0, facet(&verge.facets[i]).map_or([0.0; 2], |f| f.normal));
        -normal[0] * x[2 * c] - normal[1] * x[2 * c + 1]
    };
    let matrix = DMatrix::from_fn(n, n, |i, j| slack(i, &x[j]));
    let constant = DVector::from_fn(n, |i, _| slack(i, &x[n]));
    // Entries of size one on the diagonal and in the constant.
    let largest = if n > 0 { matrix.diagonal().amax() } else { 1.0 }.max(1e-300);
    let own: Vec<f64> = matrix.diagonal().iter().map(|d| d.abs().max(1e-12 * largest).sqrt()).collect();
    let constant = DVector::from_fn(n, |i, _| constant[i] / own[i]);
    let size = if n > 0 { constant.amax().max(1e-300) } else { 1.0 };
    let problem =
        Lcp { matrix: DMatrix::from_fn(n, n, |i, j| matrix[(i, j)] / (own[i] * own[j])), constant: constant / size };
    Some(RateProblem { problem, units: own.iter().map(|own| size / own).collect(), responses: x })
}
