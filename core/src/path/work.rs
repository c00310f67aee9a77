//! The work between two states of a path, load by load: what residuals of energy are compared with.

use super::problem::{Loading, PathProblem};
use super::state::PathState;
use crate::model::geometry::{Vec2, turned};
use nalgebra::Rotation2;

impl PathProblem {
    /// Σ|F| of a loading, weights of accelerated free bodies included \[N\]. Times the displacement of a state it is the work
    /// of the loading at factor 1, by rigid motions.
    pub fn load_size(&self, loading: &Loading) -> f64 {
        let forces: f64 = loading.forces.iter().map(|f| f.3.norm()).sum();
        let masses: f64 = self.bodies.iter().filter(|b| !b.held).map(|b| b.mass).sum();
        forces + masses * loading.acceleration.norm()
    }

    /// Σ|work| between two states \[J\]: that of the loads of earlier steps, which stand and act on the bodies' rigid
    /// motions, and that of all else, the load that changes and the supports that move. Where a mechanism moves the two
    /// cancel: their sum would say that nothing was done.
    pub fn gross_work(&self, from: &PathState, to: &PathState, finite: bool) -> f64 {
        let moved = |state: &PathState, body: usize, point: Vec2| {
            let ([x, y, theta], arm) = (state.motion[body], point - self.bodies[body].pole);
            Vec2::new(x, y) + if finite { Rotation2::new(theta) * arm - arm } else { turned(arm) * theta }
        };
        let mut standing = 0.0;
        let applied = self.applied(to.load_step, to.factor);
        for (step, factor) in self.load_steps[..to.load_step].iter().zip(applied).filter(|(_, factor)| *factor != 0.0) {
            let forces = step.loading.forces.iter();
            let forces: f64 =
                forces.map(|&(body, _, p, force)| force.dot(&(moved(to, body, p) - moved(from, body, p)))).sum();
            let weights = self.bodies.iter().enumerate().map(|(body, b)| {
                let [before, after] = [from, to].map(|state| Vec2::new(state.motion[body][0], state.motion[body][1]));
                b.mass * step.loading.acceleration.dot(&(after - before))
            });
            standing += factor * (forces + weights.sum::<f64>());
        }
        standing.abs() + (to.work - from.work - standing).abs()
    }
}
