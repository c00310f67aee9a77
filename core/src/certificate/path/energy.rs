//! The energy balance of a path, step by step and stage by stage.

use crate::path::PathState;

/// What the work of loads and supports leaves of the energy stored and dissipated. Scale of a stage: the sum of |work|
/// over its steps, what is stored at its end and what it has dissipated, and at least a `floor`.
#[derive(Debug, Default, Clone)]
pub(super) struct EnergyBalance {
    /// The worst of the stages before.
    worst: f64,
    stage: usize,
    /// Work, energy stored and dissipated at the last state \[J\].
    last: [f64; 3],
    /// Σ|work|, dissipated, and what is left over in the stage: all of it, and in its worst step \[J\].
    work: f64,
    dissipated: f64,
    left: f64,
    step: f64,
}

impl EnergyBalance {
    /// Adds a state; the worst of all stages so far.
    pub fn add(&mut self, stage: usize, state: &PathState, stored: f64, floor: f64) -> f64 {
        if stage != self.stage {
            self.worst = self.share(self.last[1], floor);
            (self.stage, self.work, self.dissipated, self.left, self.step) = (stage, 0.0, 0.0, 0.0, 0.0);
        }
        let now = [state.work, stored, state.dissipated];
        let [work, gained, dissipated] = [0, 1, 2].map(|i| now[i] - self.last[i]);
        let left = work - gained - dissipated;
        self.work += work.abs();
        self.dissipated += dissipated.abs();
        self.left += left;
        self.step = self.step.max(left.abs());
        self.last = now;
        self.share(stored, floor)
    }

    /// Of the present stage, or of one before it.
    fn share(&self, stored: f64, floor: f64) -> f64 {
        let scale = (self.work + stored.abs() + self.dissipated).max(floor);
        let own = if scale > 0.0 { self.left.abs().max(self.step) / scale } else { 0.0 };
        if own.is_nan() { own } else { own.max(self.worst) }
    }
}
