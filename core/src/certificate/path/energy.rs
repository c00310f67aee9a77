//! The energy balance of a path, step by step and stage by stage.

use crate::path::{PathProblem, PathState};

/// The energy error of a path: the work of loads and supports minus the energy stored and dissipated. The scale of a
/// stage is the sum of |work| of loads and supports over its steps, the energy stored at its end and the energy
/// dissipated in it, and at least `floor`.
#[derive(Debug, Default, Clone)]
pub(super) struct EnergyBalance {
    /// The worst value of the stages before.
    worst: f64,
    stage: usize,
    /// The required data of the last state, and the energy stored there \[J\].
    last: Option<(PathState, f64)>,
    /// Σ|work|, dissipated energy, and the energy error of the stage: in total, and in its worst step \[J\].
    work: f64,
    dissipated: f64,
    left: f64,
    step: f64,
}

impl EnergyBalance {
    /// Adds a state of small or `finite` displacements and returns the worst value of all stages so far. A path starts
    /// at rest.
    pub fn add(&mut self, problem: &PathProblem, finite: bool, (state, stored): (&PathState, f64), floor: f64) -> f64 {
        let stage = problem.load_steps[state.load_step].stage;
        if stage != self.stage {
            self.worst = self.share(self.last.as_ref().map_or(0.0, |(_, stored)| *stored), floor);
            (self.stage, self.work, self.dissipated, self.left, self.step) = (stage, 0.0, 0.0, 0.0, 0.0);
        }
        let rest = PathState { motion: vec![[0.0; 3]; problem.bodies.len()], ..PathState::default() };
        let (last, stored_before) = self.last.take().unwrap_or((rest, 0.0));
        let dissipated = state.dissipated - last.dissipated;
        let left = state.work - last.work - (stored - stored_before) - dissipated;
        self.work += problem.gross_work(&last, state, finite);
        self.dissipated += dissipated.abs();
        self.left += left;
        self.step = self.step.max(left.abs());
        let PathState { load_step, factor, work, dissipated, .. } = *state;
        let motion = state.motion.clone();
        self.last = Some((PathState { load_step, factor, work, dissipated, motion, ..PathState::default() }, stored));
        self.share(stored, floor)
    }

    /// Returns the worst value of the present stage and the stages before.
    fn share(&self, stored: f64, floor: f64) -> f64 {
        let scale = (self.work + stored.abs() + self.dissipated).max(floor);
        let own = if scale > 0.0 { self.left.abs().max(self.step) / scale } else { 0.0 };
        if own.is_nan() { own } else { own.max(self.worst) }
    }
}
