//! A path as a chain of states: from the unloaded structure to its end, each state next to the one before.
//!
//! A greatest factor among states proves a peak of the path only if the states follow each other. Each increment is
//! checked: only the factor of one load step changes, supports move by their settlements, and every contact point keeps
//! one mode ([`increment`](super::increment)). With small displacements the chain is then a path, except for rounding.
//! With finite displacements the state midway must also be nearly in equilibrium: states of two branches are not
//! neighbours.

use super::claims::length;
use super::displaced::Displaced;
use super::history::{History, has_history};
use super::increment::{Allowed, first_opening, passed};
use super::none_rises::RateProblem;
use super::point_modes::{ACTIVE, ModeCone, point_modes};
use super::rate_equations::RateEquations;
use crate::linear::vectors::largest;
use crate::path::{FarkasVector, LoadStep, LoadStepEnd, ModeTree, PathProblem, PathState, RateClaim, Witness, Yielded};
use std::sync::Arc;

/// Greatest total distance of the increments from the flow of laws, as a share of the greatest displacement.
const DRIFT: f64 = 1e-7;
/// Greatest opening of closed points, as a share of the greatest displacement.
const CLOSED: f64 = 1e-9;
/// Least slip, as a share of the greatest change of a gap or a displacement.
const SLIPS: f64 = 1e-6;
/// Relative difference below which factors are equal.
const SAME_FACTOR: f64 = 1e-9;
/// Greatest error of the displacement of the load, relative to the greatest motion.
const DISPLACEMENT: f64 = 1e-9;
/// Greatest unbalanced forces of the state midway with finite displacements, as a share of all forces.
const MIDWAY: f64 = 1e-3;
/// Greatest relative change of load and forces along a mechanism of finite displacements.
const STANDS_STILL: f64 = 1e-8;
/// Least motion along it, as a share of the size of the scene.
const MECHANISM: f64 = 1e-3;

/// A state of a chain.
#[derive(Debug, Clone)]
pub(super) struct Link {
    pub(super) state: PathState,
    /// Opening of every contact point \[m\].
    pub(super) openings: Vec<f64>,
    /// The history of laws after the state.
    pub(super) history: History,
    /// Greatest gap or displacement \[m\], and greatest force \[N\].
    sizes: [f64; 2],
}

/// A chain of states.
#[derive(Debug)]
pub struct PathChain {
    pub(super) structure: Arc<PathProblem>,
    pub(super) finite: bool,
    pub(super) links: Vec<Link>,
    /// Distance of the increments so far from the flow of laws \[m\].
    drift: f64,
    /// The reason why the chain ends before its last state.
    broken: Option<String>,
}

/// Returns the greatest size of gaps and displacements.
pub(super) fn deformation(state: &PathState) -> f64 {
    let moves = state.motion.iter().flat_map(|u| [u[0], u[1]]);
    moves.fold(largest(state.gap.as_flattened()), |a: f64, v| a.max(v.abs()))
}

pub(super) fn greatest_force(state: &PathState) -> f64 {
    state.force.iter().map(|r| length(*r)).fold(0.0, f64::max)
}

/// Returns true if a load step has no load, no settlement, no duration and no field that changes, so that its factor has no effect.
fn is_idle(problem: &PathProblem, step: &LoadStep) -> bool {
    !step.period.passes()
        && step.loading.settlements.is_empty()
        && problem.wrenches(&step.loading).iter().all(|w| *w == [0.0; 3])
}

/// Returns the mean of two neighbouring states.
pub(super) fn midway(problem: &PathProblem, last: &PathState, state: &PathState) -> PathState {
    let mean2 = |a: &[[f64; 2]], b: &[[f64; 2]]| -> Vec<[f64; 2]> {
        a.iter().zip(b).map(|(a, b)| [0, 1].map(|i| 0.5 * (a[i] + b[i]))).collect()
    };
    // Applied loads are linear in the factor, whatever the load step of the last state.
    let applied = |of: &PathState| problem.applied(of.load_step, of.factor)[state.load_step];
    let start = problem.load_steps[state.load_step].start;
    let motion = last.motion.iter().zip(&state.motion);
    let deformed = |body: usize| {
        let (from, to) = (last.inelastic(body)?, state.inelastic(body)?);
        let mean = from.displacement.iter().zip(to.displacement.iter()).map(|(a, b)| 0.5 * (a + b));
        Some(Yielded { displacement: Arc::new(mean.collect()), state: to.state.clone() })
    };
    PathState {
        load_step: state.load_step,
        factor: start + 0.5 * (applied(last) + applied(state)),
        force: mean2(&last.force, &state.force),
        gap: mean2(&last.gap, &state.gap),
        motion: motion.map(|(a, b)| [0, 1, 2].map(|i| 0.5 * (a[i] + b[i]))).collect(),
        yielded: (0..problem.bodies.len()).map(deformed).collect(),
        ..PathState::default()
    }
}

impl PathChain {
    /// Creates a chain that begins with the unloaded structure.
    pub fn new(structure: Arc<PathProblem>, finite: bool) -> Self {
        let contacts = &structure.contacts;
        let state = PathState {
            factor: structure.load_steps.first().map_or(0.0, |step| step.start),
            force: vec![[0.0; 2]; contacts.len()],
            gap: contacts.iter().map(|contact| [contact.gap, 0.0]).collect(),
            motion: vec![[0.0; 3]; structure.bodies.len()],
            ..PathState::default()
        };
        let openings = contacts.iter().map(first_opening).collect();
        let history = History::untouched(&structure);
        let sizes = [deformation(&state), 0.0];
        PathChain { structure, finite, links: vec![Link { state, openings, history, sizes }], drift: 0.0, broken: None }
    }

    /// Adds the next state of the path.
    pub fn add(&mut self, state: PathState) {
        if self.broken.is_some() {
            return;
        }
        let factor = state.factor;
        match self.links.last().map(|last| self.next(last, state)) {
            None => {}
            Some(Ok((link, drift))) => {
                self.links.push(link);
                self.drift += drift;
            }
            Some(Err(why)) => {
                self.broken = Some(format!("state {} at the factor {factor}: {why}", self.links.len()));
            }
        }
    }

    /// Adds a located peak between two states, which the observer has not received, if it follows from one of them.
    pub fn add_peak(&mut self, state: &PathState) {
        if self.links.iter().any(|link| link.state.is_same(state)) {
            return;
        }
        let mut beside = (0..self.links.len()).rev().filter(|at| self.is_beside(*at, state));
        let before = beside.find_map(|at| Some((at, self.next(&self.links[at], state.clone()).ok()?.0)));
        if let Some((at, link)) = before {
            self.links.insert(at + 1, link);
        }
    }

    /// Returns true if the load has a turning point between two links at which the state may be.
    fn is_beside(&self, at: usize, state: &PathState) -> bool {
        let sense = self.sense(state.load_step);
        let of_step = |other: &Link| other.state.load_step == state.load_step;
        let higher = |other: &Link| of_step(other) && (state.factor - other.state.factor) * sense >= 0.0;
        higher(&self.links[at]) && self.links.get(at + 1).is_none_or(higher)
    }

    /// Returns 1 if a load step raises its factor, else −1.
    pub(super) fn sense(&self, load_step: usize) -> f64 {
        let step = &self.structure.load_steps[load_step];
        if matches!(step.end, LoadStepEnd::Factor(end) if end < step.start) { -1.0 } else { 1.0 }
    }

    /// Returns the link after an increment to a state, and the drift of the increment.
    fn next(&self, last: &Link, state: PathState) -> Result<(Link, f64), String> {
        let problem = &*self.structure;
        if state.load_step < last.state.load_step || state.load_step >= problem.load_steps.len() {
            return Err("its load step is not the next".into());
        }
        self.check_factors(&last.state, &state)?;
        self.check_supports(&state)?;
        self.check_displacement(&state)?;
        let sizes = [deformation(&state), greatest_force(&state)];
        let [size, force] = [0, 1].map(|i| sizes[i].max(last.sizes[i]));
        let rounding = self.rounding();
        let allowed = Allowed { slack: ACTIVE * force, opening: CLOSED * size + rounding };
        let mut openings = Vec::with_capacity(last.openings.len());
        let (mut drift, mut active) = (0.0f64, Vec::new());
        let [forces, gaps] = [last.state.force.iter().zip(&state.force), last.state.gap.iter().zip(&state.gap)];
        let points = problem.contacts.iter().zip(forces.zip(gaps)).zip(&last.openings).enumerate();
        for (index, ((contact, (forces, gaps)), opening)) in points {
            if contact.law.response().is_some() {
                openings.push(0.0);
                continue;
            }
            let ends = [[*forces.0, *forces.1], [*gaps.0, *gaps.1]];
            let passed = passed(&mut active, contact, ends, *opening, allowed);
            let off = passed.outside - rounding;
            if off.is_nan() || self.drift + off.max(0.0) > DRIFT * size {
                return Err(format!("the gap of contact point {index} does not flow as its law says"));
            }
            drift = drift.max(off);
            openings.push(passed.opening);
        }
        let history = match has_history(problem) {
            true => last.history.after(problem, [&last.state, &state], size, self.finite)?,
            false => History::default(),
        };
        if self.finite {
            self.check_midway(&last.state, &state)?;
        }
        Ok((Link { state, openings, history, sizes }, drift))
    }

    /// Checks that only the factor of the state's own load step changes; earlier steps have reached their ends.
    fn check_factors(&self, last: &PathState, state: &PathState) -> Result<(), String> {
        let problem = &*self.structure;
        let [before, now] = [last, state].map(|state| problem.applied(state.load_step, state.factor));
        for (index, step) in problem.load_steps.iter().enumerate() {
            let scale = before[index].abs().max(now[index].abs());
            let same = (before[index] - now[index]).abs() <= SAME_FACTOR * scale;
            if index != state.load_step && !same && !is_idle(problem, step) {
                return Err("loads of another load step change".into());
            }
        }
        Ok(())
    }

    /// Checks that held bodies have moved by their settlements.
    fn check_supports(&self, state: &PathState) -> Result<(), String> {
        let problem = &*self.structure;
        let settled = problem.settled(state.load_step, state.factor);
        let bodies = problem.bodies.iter().zip(state.motion.iter().zip(&settled));
        let off = bodies.filter(|(body, _)| body.held).flat_map(|(_, (own, settled))| {
            (0..3).map(|i| (own[i] - settled[i]).abs() - SAME_FACTOR * settled[i].abs())
        });
        if off.fold(0.0, f64::max) > 0.0 { Err("a support has not moved by its settlement".into()) } else { Ok(()) }
    }

    /// Checks that the displacement of the load follows from the motions.
    fn check_displacement(&self, state: &PathState) -> Result<(), String> {
        let problem = &*self.structure;
        let growing = (&problem.load_steps[state.load_step].loading, state.factor);
        let moved = |body, point| problem.rigid_displacement(&state.motion, body, point, self.finite);
        let right = problem.load_displacement(growing, &state.motion, moved);
        let moves = state.motion.iter().flat_map(|u| [u[0], u[1], u[2] * problem.length]);
        let size = moves.fold(right.abs(), |a: f64, v| a.max(v.abs()));
        let is_right = (state.displacement - right).abs() <= DISPLACEMENT * size;
        if is_right { Ok(()) } else { Err("the displacement of the load does not follow from the motions".into()) }
    }

    /// Checks that the mean of two neighbours is nearly in equilibrium.
    fn check_midway(&self, last: &PathState, state: &PathState) -> Result<(), String> {
        let problem = &*self.structure;
        let midway = midway(problem, last, state);
        let left = Displaced::new(problem, &midway, true).unbalanced();
        let bodies = left.iter().zip(&problem.bodies).filter(|(_, body)| !body.held);
        let worst = bodies.map(|(w, _)| w[0].hypot(w[1]).max(w[2].abs() / problem.length)).fold(0.0, f64::max);
        let size: f64 = midway.force.iter().map(|r| r[0].hypot(r[1])).sum();
        if worst <= MIDWAY * size { Ok(()) } else { Err("it is far from the state before it".into()) }
    }

    /// Returns true if responses or yielding blocks make the path depend on its history.
    pub fn has_history(&self) -> bool {
        has_history(&self.structure)
    }

    /// Returns the reason why the chain ends before the last state that was added.
    pub fn broken(&self) -> Option<&str> {
        self.broken.as_deref()
    }

    /// Iterates over the states of the chain; the first is the unloaded structure.
    pub fn states(&self) -> impl Iterator<Item = &PathState> {
        self.links.iter().map(|link| &link.state)
    }

    /// Returns true if a contact point opens or closes at a state, by its number in the chain: the point is pressed on one of the
    /// pieces before and after the state and open on the other.
    pub fn opens_or_closes_at(&self, at: usize) -> bool {
        let Some([before, here, after]) = at.checked_sub(1).and_then(|first| self.links.get(first..first + 3)) else {
            return false;
        };
        let [arrival, departure] = [[before, here], [here, after]].map(|ends| self.open_on_piece(ends));
        let differs = |(before, after): (&Option<bool>, &Option<bool>)| before.zip(*after).is_some_and(|(a, b)| a != b);
        arrival.iter().zip(&departure).any(differs)
    }

    /// Returns true if a pressed contact point slips on the piece behind a state, by its number in the chain.
    pub fn slips_after(&self, at: usize) -> bool {
        let Some([from, to]) = self.links.get(at..at + 2) else { return false };
        let moved = from.state.gap.iter().zip(&to.state.gap).map(|(a, b)| [b[0] - a[0], b[1] - a[1]]);
        let motions = from.state.motion.iter().zip(&to.state.motion).map(|(a, b)| [b[0] - a[0], b[1] - a[1]]);
        let least = SLIPS * moved.clone().chain(motions).flatten().fold(0.0, |most: f64, x| most.max(x.abs()));
        let slips = |(open, by): (&Option<bool>, [f64; 2])| *open == Some(false) && by[1].abs() > least;
        self.open_on_piece([from, to]).iter().zip(moved).any(slips)
    }

    /// Returns for every contact point true if it is open on the piece between two states, false if it is pressed, otherwise `None`.
    fn open_on_piece(&self, [from, to]: [&Link; 2]) -> Vec<Option<bool>> {
        let state = midway(&self.structure, &from.state, &to.state);
        let [slack, closed] = self.tolerances(&state);
        let points = state.force.iter().zip(from.openings.iter().zip(&to.openings));
        let of = |(force, (a, b)): (&[f64; 2], (&f64, &f64))| {
            let open = 0.5 * (a + b) > closed;
            (open || force[0] > slack).then_some(open)
        };
        points.map(of).collect()
    }

    /// Returns a state of the chain with the equations of its rates and the modes of its points.
    pub(super) fn at(&self, own: &PathState) -> Result<(&Link, RateEquations, Vec<Vec<ModeCone>>), String> {
        let link =
            self.links.iter().rev().find(|link| link.state.is_same(own)).ok_or("the state is not on the path")?;
        if self.structure.yields() {
            return Err("rates of blocks that yield are checked for one loading set only".into());
        }
        let equations = RateEquations::new(&self.structure, &link.state, self.finite);
        Ok((link, equations, self.modes(&link.state, &link.openings)))
    }

    /// Returns the rounding error of gaps \[m\].
    fn rounding(&self) -> f64 {
        if self.finite { 512.0 * f64::EPSILON * self.structure.length } else { 0.0 }
    }

    /// Returns the greatest slack of active facets \[N\] and the greatest opening of closed points \[m\] at a state.
    fn tolerances(&self, state: &PathState) -> [f64; 2] {
        [ACTIVE * greatest_force(state), CLOSED * deformation(state) + self.rounding()]
    }

    /// Returns the modes that all points may have at a state.
    pub(super) fn modes(&self, state: &PathState, openings: &[f64]) -> Vec<Vec<ModeCone>> {
        let [slack, closed] = self.tolerances(state);
        let points = self.structure.contacts.iter().zip(&state.force).zip(openings);
        points.map(|((contact, force), opening)| point_modes(contact, *force, *opening > closed, slack)).collect()
    }

    /// Checks that no rate raises the load at a state, and that a mechanism continues at constant load. If flow is
    /// associated, the mechanism proves both. Small displacements only.
    ///
    /// # Errors
    /// Names the first part that is wrong.
    pub fn check_collapse(&self, state: &PathState, motion: &[[f64; 3]], witnesses: &[&Witness]) -> Result<(), String> {
        if self.finite {
            return Err("mechanisms at constant load are checked with small displacements only".into());
        }
        let (link, equations, modes) = self.at(state)?;
        let rates = RateProblem { equations: &equations, modes: &modes };
        rates.check_plateau(&self.structure, &link.state, motion)?;
        let own = ModeTree::Leaf(FarkasVector {
            equilibrium: motion.iter().map(|velocity| velocity.map(|v| -equations.sense * v)).collect(),
            gap: vec![[0.0; 2]; self.structure.contacts.len()],
            work: 0.0,
        });
        rates.check_none_rises(&own).map(|_| ()).or_else(|_| self.check_none_rises(state, witnesses))
    }

    /// Checks that after a state the structure moves to the last state at the same load and the same forces.
    ///
    /// # Errors
    /// If the load or a force changes, or the structure hardly moves.
    pub fn stands_still_after(&self, state: &PathState) -> Result<(), String> {
        let last = self.links.last().map(|link| &link.state).ok_or("an empty chain")?;
        let moved = state.motion.iter().zip(&last.motion).flat_map(|(a, b)| (0..2).map(|i| (b[i] - a[i]).abs()));
        let changed = state.force.as_flattened().iter().zip(last.force.as_flattened()).map(|(a, b)| (a - b).abs());
        let same_load = (last.factor - state.factor).abs() <= STANDS_STILL * state.factor.abs();
        if last.load_step != state.load_step || !same_load {
            return Err("the load changes after the state".into());
        }
        if changed.fold(0.0, f64::max) > STANDS_STILL * greatest_force(state) {
            return Err("forces change after the state".into());
        }
        if moved.fold(0.0, f64::max) < MECHANISM * self.structure.length {
            return Err("the structure hardly moves after the state".into());
        }
        Ok(())
    }

    /// Checks that the rates of a witness remain admissible at any distance, so that any load is carried. Small
    /// displacements only.
    ///
    /// # Errors
    /// Names the first part that is wrong.
    pub fn check_ray(&self, witness: &Witness) -> Result<(), String> {
        let RateClaim::Rate(rate) = &witness.claim else { return Err("a ray is a rate".into()) };
        if self.finite {
            return Err("rays are checked with small displacements only".into());
        }
        let (_, equations, modes) = self.at(&witness.state)?;
        RateProblem { equations: &equations, modes: &modes }.check_ray(&self.structure, rate)
    }

    /// Checks that one of the witnesses at a state proves that no rate raises the load there.
    ///
    /// # Errors
    /// Names the first part of the last witness that is wrong.
    pub fn check_none_rises(&self, state: &PathState, witnesses: &[&Witness]) -> Result<(), String> {
        let own =
            |witness: &&&Witness| witness.state.is_same(state) && matches!(witness.claim, RateClaim::NoneRises(_));
        let mut found = Err("no witness that no rate raises the load".to_string());
        let mut witnesses = witnesses.iter().filter(own).peekable();
        if witnesses.peek().is_none() {
            return found;
        }
        let (_, equations, modes) = self.at(state)?;
        let rates = RateProblem { equations: &equations, modes: &modes };
        for witness in witnesses {
            if let RateClaim::NoneRises(tree) = &witness.claim {
                found = rates.check_none_rises(tree).map(|_| ());
            }
            if found.is_ok() {
                break;
            }
        }
        found
    }

    /// Returns true if the last state is at the end of the last load step and no increment moves a factor away from its
    /// end.
    pub fn reaches_end(&self) -> bool {
        let steps = &self.structure.load_steps;
        let Some(last) = self.links.last().filter(|_| self.broken.is_none()) else { return false };
        let end = |step: &LoadStep| match step.end {
            LoadStepEnd::Factor(end) | LoadStepEnd::Collapse(end) => end,
        };
        let there = |step: &LoadStep, factor: f64| (factor - end(step)).abs() <= SAME_FACTOR * end(step).abs();
        let monotone = self.links.windows(2).all(|pair| {
            let [before, now] = [&pair[0].state, &pair[1].state];
            let step = &steps[now.load_step];
            let from = if before.load_step == now.load_step { before.factor } else { step.start };
            (now.factor - from) * (end(step) - step.start).signum() >= 0.0
        });
        let left = steps[last.state.load_step + 1..].iter();
        monotone
            && there(&steps[last.state.load_step], last.state.factor)
            && left.clone().all(|step| is_idle(&self.structure, step))
    }
}
