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
//! and y follows exactly, cell by cell: where a point reaches a boundary of its cell it goes over into the
//! neighbour, and t goes on in the sense that leads into it (forwards for ever where flow is
//! associated: the equations are monotone; t may turn back otherwise). A random shift of the guess
//! makes all boundaries be met one at a time, so that no combination of cells comes twice; it is part of
//! F(y_0) and gone at t = 1. Sources: Eaves & Scarf (1976, Math. Operations Research 1) on piecewise
//! linear paths; Robinson (1992, Math. Operations Research 17) on normal maps; Ralph (1994, ibid. 19)
//! and Dirkse & Ferris (1995, Optim. Methods Software 5) on this path as a globally convergent Newton
//! method for complementarity problems.

use super::control::Control;
use super::control_row::{control_row, control_value};
use super::iteration::iterate;
use super::linearised::residual_of;
use super::state::{State, Tangent};
use super::system::{StepFailure, StepSystem};
use super::tangent::tangent_without_gaps;
use super::updated_equations::UpdatedEquations;
use crate::contact::mode::ContactMode;
use crate::contact::piecewise_path::{PathEnd, PiecewiseLinear, PointInCell, follow};
use crate::optimise::lcg::Lcg;

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

/// The path of a step: where it is and where it goes.
struct StepPath<'m, 'a> {
    system: &'m mut StepSystem<'a>,
    equations: UpdatedEquations,
    place: Place,
    rate: Tangent,
    /// Rates of Δg \[m\].
    gap_rate: Vec<[f64; 2]>,
}

impl StepPath<'_, '_> {
    /// Puts a contact point's equations in its present mode among all. On the right-hand side stands what is
    /// left of its residual of the gaps.
    fn set_equations(&mut self, c: usize) {
        let e = self.place.offset[c].map(|e| e / self.system.units().displacement);
        let mode = self.place.state.mode[c];
        let right = match (mode, self.system.law(c)) {
            (ContactMode::Facet(i), Some(law)) => {
                let d = law.facets[i as usize].flow;
                [0.0, -(e[0] * d[1] - e[1] * d[0])]
            }
            (ContactMode::Corner(..) | ContactMode::Open, Some(_)) => [0.0; 2],
            _ => [-e[0], -e[1]],
        };
        self.equations.set(self.system, c, mode, right);
    }

    /// The mode of a contact point's cell.
    fn mode(&self, c: usize) -> ContactMode {
        let cell = self.place.cells[c].zip(self.system.law(c));
        cell.map_or(ContactMode::Stick, |(cell, law)| law.mode_of(cell))
    }
}

impl PiecewiseLinear for StepPath<'_, '_> {
    fn points(&self) -> usize {
        self.place.cells.len()
    }

    fn point(&self, c: usize) -> Option<PointInCell<'_>> {
        let (cell, law) = self.place.cells[c].zip(self.system.law(c))?;
        Some(PointInCell {
            boundaries: &law.fan.cells[cell].1,
            force: self.place.state.force[c],
            gap: self.place.step_gap[c],
            area: self.system.problem.contacts[c].area,
            force_rate: self.rate.force[c],
            gap_rate: self.gap_rate[c],
        })
    }

    fn solve_rates(&mut self) -> Result<(), String> {
        self.system.count("pivots", 1);
        let solved = self.equations.solve(self.system);
        let (x, factorisations) = solved.ok_or("a combination of cells has no direction")?;
        self.system.count("factorisations", factorisations);
        if x.iter().any(|x| !x.is_finite()) {
            return Err("a combination of cells has no finite direction".into());
        }
        self.rate = tangent_without_gaps(self.system, &x);
        for (c, rate) in self.gap_rate.iter_mut().enumerate().filter(|(c, _)| self.place.cells[*c].is_some()) {
            // That of a stuck point is nothing.
            *rate = match self.place.state.mode[c] {
                ContactMode::Stick => [0.0; 2],
                _ => {
                    let (own, offset) = (self.equations.gap(c, &x), self.place.offset[c]);
                    [0, 1].map(|k| own[k] * self.system.units().displacement + offset[k])
                }
            };
        }
        Ok(())
    }

    fn advance(&mut self, by: f64) {
        let add = |values: &mut [[f64; 2]], rates: &[[f64; 2]]| {
            values.iter_mut().flatten().zip(rates.iter().flatten()).for_each(|(v, rate)| *v += by * rate);
        };
        add(&mut self.place.state.force, &self.rate.force);
        add(&mut self.place.step_gap, &self.gap_rate);
        for (q, dq) in self.place.state.motion.iter_mut().zip(&self.rate.motion) {
            (0..3).for_each(|k| q[k] += by * dq[k]);
        }
        self.place.state.factor += by * self.rate.factor;
    }

    fn cross(&mut self, c: usize, boundary: usize) -> (usize, bool) {
        let Some((cell, law)) = self.place.cells[c].zip(self.system.law(c)) else { return (boundary, false) };
        let (to, entered) = law.fan.cells[cell].1[boundary].neighbour;
        self.place.cells[c] = Some(to);
        let mode = self.mode(c);
        let changed = mode != self.place.state.mode[c];
        if changed {
            self.place.state.mode[c] = mode;
            self.set_equations(c);
        }
        (entered, changed)
    }
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
        match followed_from(system, start, guess, control, shift, attempt as u64) {
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
    let gap = system.gradient(&state).gap.clone();
    let largest = state.force.iter().flatten().map(|r| r.abs()).fold(0.0, f64::max);
    let mean = system.units().displacement / system.units().force;
    let typical = largest.max(1e-3 * system.units().force) / (points as f64).sqrt();
    let mut random = Lcg::new(0x9E37_79B9 + 77 * seed);
    let (mut cells, mut step_gap) = (vec![None; points], vec![[0.0; 2]; points]);
    for c in 0..points {
        let noise = [random.next(), random.next()];
        let Some(law) = system.law(c) else { continue };
        let rho = system.scaled.compliance[c].map(|own| 1.0 / own.max(1e-6 * mean));
        let r = state.force[c];
        let scale = shift * (r[0].hypot(r[1]) + 0.1 * typical);
        let z = [0, 1].map(|k| r[k] - rho[k] * (gap[c][k] - start.slip[c][k]) + scale * noise[k]);
        let area = system.problem.contacts[c].area;
        let (cell, r) = law.return_map(z, rho, area);
        state.force[c] = r;
        step_gap[c] = [0, 1].map(|k| (r[k] - z[k]) / rho[k]);
        cells[c] = Some(cell);
    }
    state.gap = system.gradient(&state).gap.clone();
    let offset = (0..points).map(|c| [0, 1].map(|k| state.gap[c][k] - start.slip[c][k] - step_gap[c][k])).collect();
    Place { state, step_gap, cells, offset }
}

/// Follows the path of a shift of the guess to its end.
fn followed_from(
    system: &mut StepSystem,
    start: &State,
    guess: &State,
    control: &Control,
    shift: f64,
    seed: u64,
) -> Result<State, String> {
    let place = placed(system, start, guess, shift, seed);
    let points = place.cells.len();
    let gradient = system.gradient(&place.state);
    let residual = residual_of(system, start, &place.state, &gradient);
    let (left, constraint) = control_value(system, start, &place.state, control);
    let equations = system.equations(&place.state);
    let row = control_row(system, start, &place.state, control, &constraint, &equations);
    let mut right: Vec<f64> = residual.iter().map(|x| -x).collect();
    right[row.len() - 1] = -left;
    let mut equations = UpdatedEquations::new(equations, system.scaled.chain.clone(), points, row);
    equations.load_rate(&right);
    let rate = tangent_without_gaps(system, &vec![0.0; right.len()]);
    let mut path = StepPath { system, equations, place, rate, gap_rate: vec![[0.0; 2]; points] };
    for c in 0..points {
        path.place.state.mode[c] = path.mode(c);
        path.set_equations(c);
    }
    match follow(&mut path, 400 + 20 * points)? {
        PathEnd::Arrived => Ok(path.place.state),
        PathEnd::Ray(_) => Err("the path of pivoting leaves along a ray".into()),
    }
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
