//! States of a path that are kept for drawings.

use super::case_input::CaseInput;
use super::path_result::displacements;
use crate::results::StateEntry;
use voussoir_core::path::{PathProblem, PathState};

/// Records states while a path is followed.
pub(super) struct Recorder<'a> {
    input: CaseInput<'a>,
    all: Vec<StateEntry>,
}

impl<'a> Recorder<'a> {
    /// Creates a recorder; it records nothing unless the case requests it.
    pub fn new(input: &CaseInput<'a>) -> Self {
        Recorder { input: *input, all: Vec::new() }
    }

    /// Records a state.
    pub fn state(&mut self, problem: &PathProblem, state: &PathState) {
        if self.input.states == 0 {
            return;
        }
        let (assembly, finite) = (self.input.assembly, self.input.settings.finite);
        let load_step = &problem.load_steps[state.load_step];
        let joints = assembly.joints.len();
        let pressed = problem.contacts.iter().zip(&state.force).filter(|(contact, _)| contact.joint < joints);
        self.all.push(StateEntry {
            stage: self.input.stages[load_step.stage].name.clone(),
            factor: state.factor,
            gravity: load_step.gravity,
            displacement: state.displacement,
            bodies: displacements(assembly, problem, &state.motion, finite),
            pressures: pressed.map(|(contact, force)| force[0] / contact.area).collect(),
        });
    }

    /// Returns the requested number of states, evenly over the path, with the ends of stages and the greatest factor of the last
    /// stage.
    pub fn chosen(self) -> Vec<StateEntry> {
        let Some(last) = self.all.len().checked_sub(1) else { return Vec::new() };
        let wanted = self.input.states.max(2);
        let mut places: Vec<usize> = (0..wanted).map(|i| i * last / (wanted - 1)).collect();
        let kind = |i: usize| (&self.all[i].stage, self.all[i].gravity);
        places.extend((0..last).filter(|i| kind(*i) != kind(i + 1)));
        let of_last = (0..=last).filter(|i| kind(*i) == kind(last));
        places.extend(of_last.max_by(|a, b| self.all[*a].factor.total_cmp(&self.all[*b].factor)));
        places.sort_unstable();
        places.dedup();
        let kept: std::collections::BTreeSet<usize> = places.into_iter().collect();
        self.all.into_iter().enumerate().filter(|(i, _)| kept.contains(i)).map(|(_, state)| state).collect()
    }
}
