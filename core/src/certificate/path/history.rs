//! Laws with a history along a chain of states: responses, and blocks that yield.
//!
//! An increment follows such a law if the update of the law, from the history of the state before, gives the forces of
//! the state. The update follows the straight line between both states. The check therefore also integrates the forces
//! by the trapezoidal rule and compares the work with the energy that the law stores and dissipates on this line: a
//! path that has jumped to another branch releases energy.

use super::response::law_residual;
use super::tolerance::tolerance;
use crate::elastic::InelasticState;
use crate::path::{LawStep, PathProblem, PathState, Yielded};
use std::sync::Arc;

/// Greatest work of an increment that the laws neither store nor dissipate, as a share of all work so far.
const ENERGY: f64 = 1e-3;
/// Greatest difference between the history of a block and the update of its law, relative to its greatest strain.
const REMEMBERED: f64 = 1e-8;

/// The history of all laws at a state, and the energies up to it.
#[derive(Debug, Clone, Default)]
pub(super) struct History {
    /// States of all responses.
    pub memory: Vec<f64>,
    /// Energy stored in responses and yielding blocks \[J\].
    stored: f64,
    /// Σ|work| of loads and supports so far \[J\].
    gross: f64,
}

/// Returns true if a problem has laws with a history.
pub(super) fn has_history(problem: &PathProblem) -> bool {
    problem.yields() || problem.contacts.iter().any(|contact| contact.law.response().is_some())
}

impl History {
    /// Creates the history before any load.
    pub fn untouched(problem: &PathProblem) -> Self {
        History { memory: problem.untouched(), ..History::default() }
    }

    /// Returns the history after an increment between two states. `deformation` is the greatest gap or displacement
    /// \[m\].
    ///
    /// # Errors
    /// If the increment does not follow the laws.
    pub fn after(
        &self,
        problem: &PathProblem,
        [last, state]: [&PathState; 2],
        deformation: f64,
        finite: bool,
    ) -> Result<History, String> {
        let mut next = History { gross: self.gross + problem.gross_work(last, state, finite), ..History::default() };
        let mut taken = 0.0;
        let step = LawStep::between(problem, last, state);
        let before = (&self.memory[..], &step);
        if let Some((worst, (points, after))) = law_residual(problem, state, before, deformation, finite, 0.0) {
            if worst.is_nan() || worst > tolerance("path_law").result {
                return Err("forces do not follow from the law of tractions and the state before".into());
            }
            for (contact, point) in points {
                let area = problem.contacts[contact].area;
                let (from, to) = (last.force[contact], state.force[contact]);
                let (start, end) = (last.gap[contact], state.gap[contact]);
                taken -= (0..2).map(|k| 0.5 * (from[k] + to[k]) * (end[k] - start[k])).sum::<f64>();
                taken += area * (point.supplied - point.dissipated);
                next.stored += area * point.stored;
            }
            next.memory = after;
        }
        let (stored, of_blocks) = block_energies(problem, [last, state], finite)?;
        next.stored += stored;
        let left = (taken + of_blocks - (next.stored - self.stored)).abs();
        if left.is_nan() || left > ENERGY * (next.gross + next.stored.abs()) {
            return Err(format!("the laws leave {left:.1e} J of the work of the increment"));
        }
        Ok(next)
    }
}

/// Returns the energy that yielding blocks store at the end of an increment, and the work of the forces on their points
/// in it minus the energy they dissipate \[J\].
fn block_energies(problem: &PathProblem, states: [&PathState; 2], finite: bool) -> Result<(f64, f64), String> {
    if !problem.yields() {
        return Ok((0.0, 0.0));
    }
    let [before, after] = states.map(|state| problem.forces_on_points(state, finite));
    let (mut stored, mut taken) = (0.0, 0.0);
    for (index, body) in problem.bodies.iter().enumerate() {
        let Some(inelastic) = &body.inelastic else { continue };
        let flat =
            |forces: &[crate::model::geometry::Vec2]| -> Vec<f64> { forces.iter().flat_map(|f| [f.x, f.y]).collect() };
        let forces = [flat(&before[index]), flat(&after[index])];
        let own = |state: usize| match states[state].inelastic(index) {
            Some(Yielded { displacement, state }) => (displacement.clone(), state.clone()),
            None => {
                let (displacement, state) = inelastic.elastic_state(&forces[state]);
                (Arc::new(displacement), Arc::new(state))
            }
        };
        let [from, to]: [(Arc<Vec<f64>>, Arc<InelasticState>); 2] = [own(0), own(1)];
        let passed = inelastic.passed(&to.0, [&from.1.history, &to.1.history])?;
        if passed.drift.is_nan() || passed.drift > REMEMBERED {
            return Err(format!("the history of body {index} does not follow from the state before"));
        }
        let [start, end] = [&from.0, &to.0].map(|displacement| inelastic.at_points(displacement));
        let work = (0..start.len()).map(|i| 0.5 * (forces[0][i] + forces[1][i]) * (end[i] - start[i])).sum::<f64>();
        taken += work - passed.dissipated;
        stored += passed.stored;
    }
    Ok((stored, taken))
}
