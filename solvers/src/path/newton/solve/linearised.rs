//! The linear system of a step: residual by modes, rows of constraints, the matrix and its solution.
//!
//! Rows by mode:
//!
//! ```text
//! stuck     g − s = 0                     facet   a·r = b A,  Δg × d = 0
//! corner    r = corner A                  body    ∂Π/∂q = 0          control  c(increment) = length
//! response  r − A t(g) = 0 (see `response`)
//! ```
//!
//! The factorised matrix is shifted by ε: compliance ε C̄ in every contact, stiffness ε / C̄ in every body and in every
//! yielding contact. This makes it quasi-definite (Vanderbei 1995, SIAM J. Optim. 5) if modes repeat a condition or
//! leave a motion free; iterative refinement with the true matrix removes the shift from the solution. If refinement
//! does not converge, the modes have no solution, and the step is refused. The factorisation is described in `border`
//! and [`condensed`](crate::linear::condensed).

use crate::contact::facet::slack;
use crate::contact::mode::ContactMode;
use crate::linear::bordered::{BorderedFactors, BorderedSystem};
use crate::linear::chain::{BodyRows, ChainFactors, ChainRows, PointRows};
use crate::linear::condensed::Condensed;
use crate::linear::csr::CsrMatrix;
use crate::linear::largest;
use crate::path::newton::model::derivatives::Gradient;
use crate::path::newton::model::equations::Equations;
use crate::path::newton::model::factors::{Kept, ModeEquations};
use crate::path::newton::model::state::State;
use crate::path::newton::model::system::StepSystem;
use crate::path::newton::quantities::response::{traction_residual, traction_row};
use crate::settings::SETTINGS;
use std::cell::RefCell;
use std::rc::Rc;

/// Returns the residual of the modes' equations in units.
pub fn residual_of(system: &StepSystem, start: &State, state: &State, gradient: &Gradient) -> Vec<f64> {
    let u = system.units();
    let points = state.gap.len();
    let mut out = vec![0.0; system.size()];
    for c in 0..points {
        if system.laws.responses.is(c) {
            out[2 * c..2 * c + 2].copy_from_slice(&traction_residual(system, state, c));
            continue;
        }
        let gap = system.step_gap(start, state, c).map(|g| g / u.displacement);
        let area = system.problem.contacts[c].area;
        let r = state.force[c];
        let rows = match (state.mode[c], system.law(c)) {
            (ContactMode::Facet(i), Some(law)) => {
                let f = &law.facets[i as usize];
                [-slack(f, r, area) / u.force, gap[0] * f.flow[1] - gap[1] * f.flow[0]]
            }
            (mode @ (ContactMode::Corner(..) | ContactMode::Open), Some(law)) => {
                let corner = law.corner(mode).unwrap_or_default();
                [(r[0] - corner[0] * area) / u.force, (r[1] - corner[1] * area) / u.force]
            }
            _ => gap,
        };
        out[2 * c] = rows[0];
        out[2 * c + 1] = rows[1];
    }
    for (body, balance) in gradient.balance.iter().enumerate() {
        if let Some(free) = system.scaled.free[body] {
            for k in 0..3 {
                let unit = if k == 2 { u.force * u.length } else { u.force };
                out[2 * points + 3 * free + k] = balance[k] / unit;
                if let Some(damping) = &system.loads.damping {
                    let moved = (state.motion[body][k] - damping.from[body][k]) / u.motion()[k];
                    out[2 * points + 3 * free + k] -= damping.rate * moved;
                }
            }
        }
    }
    out
}

/// Returns the normals and flows of the laws' facets.
fn directions(system: &StepSystem) -> Vec<[f64; 4]> {
    let facets = system.laws.polygons.iter().flat_map(|law| &law.facets);
    facets.map(|f| [f.normal[0], f.normal[1], f.flow[0], f.flow[1]]).collect()
}

fn damping(system: &StepSystem) -> f64 {
    system.loads.damping.as_ref().map_or(0.0, |damping| damping.rate)
}

/// Returns the kept factors, if modes alone determine the rows of points.
pub fn all_kept<'s>(system: &'s StepSystem<'_>) -> impl Iterator<Item = &'s Rc<Kept>> {
    let (damping, directions) = (damping(system), directions(system));
    system.cache.factors.held().filter(move |kept| kept.damping == damping && kept.directions == directions)
}

/// Returns the factorised linear equations of the modes, and true if they were kept: if modes alone determine them,
/// factors of the same modes and equations are reused.
pub fn factorised(
    system: &mut StepSystem,
    state: &State,
    equations: &Rc<Equations>,
    row: &[f64],
) -> Option<(Rc<BorderedFactors<ModeEquations>>, bool)> {
    let same = |kept: &&Rc<Kept>| Rc::ptr_eq(&kept.equations, equations) && kept.modes == state.mode;
    if let Some(kept) = all_kept(system).filter(same).find(|kept| kept.held.serves(row)) {
        return Some((kept.held.clone(), true));
    }
    let (damping, directions) = (damping(system), directions(system));
    system.count("factorisations", 1);
    let chain = system.scaled.chain.clone().filter(|_| system.geometry.pattern.couples());
    let held = match chain {
        Some(chain) => BorderedFactors::new(state.mode.len(), row, |last| {
            ChainFactors::new(chain_rows(system, state, equations), last, &chain).map(ModeEquations::Chain)
        }),
        None => by_rows(system, state, equations, row, damping),
    };
    let held = Rc::new(held?);
    // The tangents of bonds change the matrix, so modes alone do not identify it.
    if system.laws.responses.is_empty() {
        system.cache.factors.hold(Kept {
            equations: equations.clone(),
            modes: state.mode.clone(),
            directions,
            damping,
            held: held.clone(),
            responses: RefCell::default(),
        });
    }
    Some((held, false))
}

/// Returns the equations of a chain of elastic bodies in the modes of a state.
pub fn chain_rows(system: &StepSystem, state: &State, equations: &Equations) -> ChainRows {
    let points = (0..state.mode.len()).map(|c| rows_of_point(system, state, c)).collect();
    let bodies = BodyRows { rows: equations.bodies.clone(), diagonal: -damping(system), shift: -SETTINGS.admissible };
    ChainRows { gaps: equations.gaps.clone(), bodies, points }
}

/// Returns the rows of a contact point, by its mode or by its tractions.
fn rows_of_point(system: &StepSystem, state: &State, c: usize) -> PointRows {
    if system.laws.responses.is(c) {
        let (own, stiffness) = traction_row(system, state, c);
        return Equations::response_rows(own, stiffness);
    }
    Equations::point_rows(system.law(c), state.mode[c])
}

/// Assembles the equations row by row, for any arrangement of bodies, and the added terms.
pub fn assembled(system: &StepSystem, state: &State, equations: &Equations, damping: f64) -> [CsrMatrix; 2] {
    let capacity = equations.bodies.entries() + 8 * system.size();
    let (mut rows, mut shifts) = (CsrMatrix::with_capacity(capacity), CsrMatrix::with_capacity(8 * system.size()));
    for c in 0..state.mode.len() {
        let (point, whole) = (rows_of_point(system, state, c), system.laws.responses.is(c));
        for k in 0..2 {
            equations.add_row(&point, (c, k), whole, rows.open_row(), shifts.open_row());
            rows.end_row();
            shifts.end_row();
        }
    }
    equations.bodies(&mut rows, &mut shifts, damping);
    [rows, shifts]
}

/// Factorises the assembled equations with the row of the control.
fn by_rows(
    system: &mut StepSystem,
    state: &State,
    equations: &Equations,
    row: &[f64],
    damping: f64,
) -> Option<BorderedFactors<ModeEquations>> {
    let [rows, mut shifts] = assembled(system, state, equations, damping);
    shifts.end_row();
    let elimination = &mut system.cache.factors.elimination;
    BorderedFactors::new(state.mode.len(), row, |last| {
        let mut rows = rows.clone();
        rows.open_row().extend(last);
        rows.end_row();
        Condensed::of(rows, &shifts, state.mode.len(), elimination).map(ModeEquations::Sparse)
    })
}

/// Solves the modes' linear equations for one right-hand side in units, and returns true if they are solved. If the
/// equations contradict each other, the result is the solution of the shifted equations.
pub fn solve_linear(
    system: &mut StepSystem,
    state: &State,
    equations: &Rc<Equations>,
    row: &[f64],
    right: &[f64],
) -> Option<(Vec<f64>, bool)> {
    let (held, again) = factorised(system, state, equations, row)?;
    let found = BorderedSystem::new(held, row).and_then(|bordered| refined(&bordered, right));
    if found.as_ref().is_some_and(|(_, solved)| *solved) || !again {
        return found;
    }
    // With another held unknown the control may be better conditioned.
    system.cache.factors.forget();
    let (held, _) = factorised(system, state, equations, row)?;
    refined(&BorderedSystem::new(held, row)?, right)
}

/// Solves the equations without the added terms by refinement, and returns true if a solution exists.
fn refined(bordered: &BorderedSystem<ModeEquations>, right: &[f64]) -> Option<(Vec<f64>, bool)> {
    let mut x = vec![0.0; right.len()];
    let mut rest = right.to_vec();
    let mut before = f64::INFINITY;
    let aim = largest(right);
    if aim == 0.0 {
        return Some((x, true));
    }
    let mut best = x.clone();
    for _ in 0..30 {
        let step = bordered.apply(&rest)?;
        x.iter_mut().zip(&step).for_each(|(x, s)| *x += s);
        let (left, error) = bordered.left(right, &x);
        rest = left;
        let now = largest(&rest);
        if now < before {
            best.copy_from_slice(&x);
        }
        if !now.is_finite() || now > 0.5 * before || now <= 1e-16 * aim || error <= 4.0 * f64::EPSILON {
            before = before.min(now);
            break;
        }
        before = now;
    }
    // The remaining residual is rounding of the solution, or the system has no solution.
    let size = largest(&best).max(aim);
    Some((best, before <= 1e-9 * size))
}
