//! Energy along a path: the work of loads and of settled supports by the trapezoidal rule, which is exact if everything
//! is linear during a step, and the dissipated energy.

use voussoir_core::model::geometry::Vec2;
use voussoir_core::path::{Loading, PathProblem, PathState};

/// Energies up to the present state \[J\].
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct EnergyBalance {
    pub dissipated: f64,
    pub work: f64,
}

/// The energy balance of a stage.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct StageBalance {
    stage: usize,
    /// Σ|work| of loads and supports over its steps, and its dissipated energy \[J\].
    work: f64,
    dissipated: f64,
    /// Work minus stored and dissipated energy \[J\].
    left: f64,
}

impl StageBalance {
    /// Returns the balance after a step between two states, and the energy error of that step.
    pub fn after(&self, problem: &PathProblem, finite: bool, from: &PathState, to: &PathState) -> (Self, f64) {
        let stage = problem.load_steps[to.load_step].stage;
        let before = if stage == self.stage { *self } else { StageBalance { stage, ..Self::default() } };
        let dissipated = to.dissipated - from.dissipated;
        let left = to.work - from.work - (to.stored - from.stored) - dissipated;
        let after = StageBalance {
            stage,
            work: before.work + problem.gross_work(from, to, finite),
            dissipated: before.dissipated + dissipated.abs(),
            left: before.left + left,
        };
        (after, left)
    }

    /// Returns the energy error \[J\].
    pub fn left(&self) -> f64 {
        self.left
    }

    /// Returns the scale of the energy error if the stored energy is `stored` \[J\].
    pub fn scale(&self, stored: f64) -> f64 {
        self.work + stored.abs() + self.dissipated
    }
}

/// The data of a state for the work of a step that starts or ends at it.
#[derive(Debug, Clone)]
pub(super) struct WorkState {
    /// Factor of each loading.
    pub factors: Vec<f64>,
    /// Displacements of the points that each loading pushes \[m\].
    pub displacements: Vec<Vec<Vec2>>,
    /// Motion of every body about its pole.
    pub motion: Vec<[f64; 3]>,
    /// Unbalanced loads and contact forces of every body about its pole \[N, N m\]: the reaction of held bodies.
    pub unbalanced: Vec<[f64; 3]>,
}

impl EnergyBalance {
    /// Adds the work of loads and of the reactions of settled supports between two states.
    pub fn add_work(&mut self, problem: &PathProblem, loadings: &[&Loading], from: &WorkState, to: &WorkState) {
        for (k, loading) in loadings.iter().enumerate() {
            let mean = 0.5 * (from.factors[k] + to.factors[k]);
            let points = from.displacements[k].iter().zip(&to.displacements[k]);
            for ((_, _, _, force), (before, after)) in loading.forces.iter().zip(points) {
                self.work += mean * force.dot(&(after - before));
            }
            for (body, (q, end)) in problem.bodies.iter().zip(from.motion.iter().zip(&to.motion)) {
                self.work += mean * body.mass * loading.acceleration.dot(&Vec2::new(end[0] - q[0], end[1] - q[1]));
            }
        }
        for (body, _) in problem.bodies.iter().enumerate().filter(|(_, b)| b.held) {
            for k in 0..3 {
                let reaction = -0.5 * (from.unbalanced[body][k] + to.unbalanced[body][k]);
                self.work += reaction * (to.motion[body][k] - from.motion[body][k]);
            }
        }
    }
}
