//! A step by pivoting, where Newton's method does not find its modes (small displacements).
//!
//! The step is piecewise linear: every contact point has a *cell* (stuck, on one facet, on two), and in
//! each combination of cells the equations are linear. From any guess y_0 the residual F(y_0) is taken
//! away in proportion,
//!
//! ```text
//! F(y) = (1 − t) F(y_0),   t from 0 to 1,
//! ```
//!
//! and y follows exactly, cell by cell: where a point reaches a wall of its cell it goes over into the
//! neighbour, and t goes on in the sense that leads into it (forwards for ever where flow is
//! associated: the equations are monotone; t may turn back otherwise). A random shift of the guess
//! makes all walls be met one at a time, so that no combination of cells comes twice; it is part of
//! F(y_0) and gone at t = 1. Sources: Eaves & Scarf (1976, Math. Operations Research 1) on piecewise
//! linear paths; Robinson (1992, Math. Operations Research 17) on normal maps; Ralph (1994, ibid. 19)
//! and Dirkse & Ferris (1995, Optim. Methods Software 5) on this path as a globally convergent Newton
//! method for complementarity problems.

use crate::path::shuffle::Shuffle;
use crate::path::walk::{Met, Standing, Walk};
use super::control::Control;
use super::control_row::{control_row, control_value};
use super::frame::Frame;
use super::iteration::iterate;
use super::law::ContactMode;
use super::linearised::residual_of;
use super::state::State;
use super::system::{StepFailure, StepSystem};
use super::tangent::tangent_without_gaps;
use voussoir_core::path::ContactLaw;

/// Sizes of the shift of the guess that are tried, relative to forces.
const SHIFTS: [f64; 3] = [1e-3, 0.03, 0.5];

/// A point of the path.
struct Place {
    state: State,
    /// Δg less what of the residual is left of it, at t = 0 \[m\].
    step_gap: Vec<[f64; 2]>,
    cells: Vec<Option<usize>>,
    /// Residual of the gaps at t = 0 \[m\].
    offset: Vec<[f64; 2]>,
}

/// A step by pivoting from a guess. The control must be linear.
pub(super) fn by_homotopy(
    system: &mut StepSystem,
    start: &State,
    guess: &State,
    control: &Control,
) -> Result<(State, u64), StepFailure> {
    let mut failure = StepFailure::new("pivoting does not apply");
    if !system.piecewise_linear() {
        return Err(failure);
    }
    for (attempt, shift) in SHIFTS.into_iter().enumerate() {
        match walked(system, start, guess, control, shift, attempt as u64) {
            Ok(state) => match polished(system, start, state, control) {
                Ok(found) => return Ok(found),
                Err(why) => failure = why,
            },
            Err(why) => failure.why = why,
        }
    }
    Err(failure)
}

/// Held bodies where their settlements put them.
fn settle_in(system: &StepSystem, state: &mut State) {
    let mut motion = std::mem::take(&mut state.motion);
    system.settle(&mut motion, state.factor);
    state.motion = motion;
}

/// The guess with every point in a cell, shifted.
fn placed(system: &mut StepSystem, start: &State, guess: &State, shift: f64, seed: u64) -> Place {
    let points = guess.gap.len();
    let mut state = guess.clone();
    settle_in(system, &mut state);
    let gap = system.gradient(&state).gap;
    let largest = state.force.iter().flatten().map(|r| r.abs()).fold(0.0, f64::max);
    let mean = system.units().displacement / system.units().force;
    let typical = largest.max(1e-3 * system.units().force) / (points as f64).sqrt();
    let mut random = Shuffle::new(0x9E37_79B9 + 77 * seed);
    let (mut cells, mut step_gap) = (vec![None; points], vec![[0.0; 2]; points]);
    for c in 0..points {
        let noise = [random.next(), random.next()];
        let Some(law) = system.law(c) else { continue };
        let rho = system.laws.compliance[c].map(|own| 1.0 / own.max(1e-6 * mean));
        let r = state.force[c];
        let scale = shift * (r[0].hypot(r[1]) + 0.1 * typical);
        let z = [0, 1].map(|k| r[k] - rho[k] * (gap[c][k] - start.slip[c][k]) + scale * noise[k]);
        let area = system.problem.contacts[c].area;
        let (cell, r) = law.returned(z, rho, area);
        state.force[c] = r;
        step_gap[c] = [0, 1].map(|k| (r[k] - z[k]) / rho[k]);
        cells[c] = Some(cell);
    }
    state.gap = system.gradient(&state).gap;
    let offset = (0..points).map(|c| [0, 1].map(|k| state.gap[c][k] - start.slip[c][k] - step_gap[c][k])).collect();
    Place { state, step_gap, cells, offset }
}

/// Right-hand sides of the rows of a contact point, in units: what is left of its residual of the gaps.
fn driven(system: &StepSystem, place: &Place, c: usize) -> [f64; 2] {
    let e = place.offset[c].map(|e| e / system.units().displacement);
    match (place.state.mode[c], system.law(c)) {
        (ContactMode::Facet(i), Some(law)) => {
            let d = law.facets[i as usize].flow;
            [0.0, -(e[0] * d[1] - e[1] * d[0])]
        }
        (ContactMode::Corner(_), Some(_)) => [0.0; 2],
        _ => [-e[0], -e[1]],
    }
}

fn walked(
    system: &mut StepSystem,
    start: &State,
    guess: &State,
    control: &Control,
    shift: f64,
    seed: u64,
) -> Result<State, String> {
    let mut place = placed(system, start, guess, shift, seed);
    let points = place.cells.len();
    let gradient = system.gradient(&place.state);
    let residual = residual_of(system, start, &place.state, &gradient);
    let (left, constraint) = control_value(system, start, &place.state, control);
    let hessian = system.hessian(&place.state, &gradient);
    let row = control_row(system, start, &place.state, control, &constraint, &hessian);
    let size = system.size();
    let mut frame = Frame::new(hessian.rows(&system.unknowns).clone(), points, row);
    let mut right: Vec<f64> = residual.iter().map(|x| -x).collect();
    right[size - 1] = -left;
    frame.load_rate(&right);
    let laws = system.laws.polygons.clone();
    let contacts = &system.problem.contacts;
    let law_of = |c: usize| match contacts[c].law {
        ContactLaw::Law(law) => Some(&laws[law]),
        ContactLaw::Bonded => None,
    };
    let mut standing: Vec<Option<Standing>> = Vec::with_capacity(points);
    for (c, contact) in contacts.iter().enumerate() {
        let cell = place.cells[c].zip(law_of(c));
        place.state.mode[c] = cell.map_or(ContactMode::Stick, |(cell, law)| law.mode_of(cell));
        frame.set(system, c, place.state.mode[c], driven(system, &place, c));
        standing.push(cell.map(|(cell, law)| Standing {
            walls: &law.cells.cells[cell].1,
            force: place.state.force[c],
            gap: place.step_gap[c],
            area: contact.area,
            force_rate: [0.0; 2],
            gap_rate: [0.0; 2],
        }));
    }
    let most = 400 + 20 * points;
    let mut walk = Walk::new();
    for _ in 0..most {
        system.count("pivots", 1);
        let Some((x, factorisations)) = frame.solve(system) else {
            return Err("a combination of cells has no direction".into());
        };
        system.count("factorisations", factorisations);
        if x.iter().any(|x| !x.is_finite()) {
            return Err("a combination of cells has no finite direction".into());
        }
        let rate = tangent_without_gaps(system, &x);
        for (c, point) in standing.iter_mut().enumerate() {
            let Some(point) = point else { continue };
            point.force_rate = rate.force[c];
            // That of a stuck point is nothing.
            point.gap_rate = match place.state.mode[c] {
                ContactMode::Stick => [0.0; 2],
                _ => {
                    let (own, offset) = (frame.gap(c, &x), place.offset[c]);
                    [0, 1].map(|k| own[k] * system.units().displacement + offset[k])
                }
            };
        }
        // Over walls without a change of equations the direction stays.
        loop {
            let (along, met) = walk.on(points, |c| standing[c].as_ref());
            if matches!(met, Met::Ray) {
                return Err("the path of pivoting leaves along a ray".into());
            }
            for point in standing.iter_mut().flatten() {
                for k in 0..2 {
                    point.force[k] += along * point.force_rate[k];
                    point.gap[k] += along * point.gap_rate[k];
                }
            }
            for (c, force) in place.state.force.iter_mut().enumerate() {
                match &standing[c] {
                    Some(point) => *force = point.force,
                    None => (0..2).for_each(|k| force[k] += along * rate.force[c][k]),
                }
            }
            for (q, dq) in place.state.motion.iter_mut().zip(&rate.motion) {
                (0..3).for_each(|k| q[k] += along * dq[k]);
            }
            place.state.factor += along * rate.factor;
            let Met::Wall(c, index) = met else { return Ok(place.state) };
            if walk.is_lost() {
                return Err("the path of pivoting turned back".into());
            }
            let (Some(cell), Some(law), Some(point)) = (place.cells[c], law_of(c), &mut standing[c]) else {
                continue;
            };
            let (to, wall) = law.cells.cells[cell].1[index].behind;
            place.cells[c] = Some(to);
            point.walls = &law.cells.cells[to].1;
            walk.enters(c, wall);
            let mode = law.mode_of(to);
            if mode != place.state.mode[c] {
                place.state.mode[c] = mode;
                frame.set(system, c, mode, driven(system, &place, c));
                break;
            }
        }
    }
    Err(format!("{most} pivots were not enough"))
}

/// Newton's method from what pivoting found.
fn polished(
    system: &mut StepSystem,
    start: &State,
    state: State,
    control: &Control,
) -> Result<(State, u64), StepFailure> {
    iterate(system, start, state, control, 8, None)
}
