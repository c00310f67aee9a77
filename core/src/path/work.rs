//! The work between two states of a path, load by load, as scale of energy residuals.

use super::problem::{Loading, PathProblem};
use super::state::PathState;
use crate::model::geometry::{Vec2, turned};
use nalgebra::Rotation2;

impl PathProblem {
    /// Returns Σ|F| of a loading, with the weights of accelerated free bodies \[N\]. This times the displacement of a
    /// state is the work of the loading at factor 1 on rigid motions.
    pub fn load_size(&self, loading: &Loading) -> f64 {
        let forces: f64 = loading.forces.iter().map(|f| f.3.norm()).sum();
        let masses: f64 = self.bodies.iter().filter(|b| !b.held).map(|b| b.mass).sum();
        forces + masses * loading.acceleration.norm()
    }

    /// Returns the greatest displacement of the contact points of supports per unit of the factor of a loading \[m\].
    pub fn settlement_size(&self, loading: &Loading) -> f64 {
        let moves = |&(body, [x, y, theta]): &(usize, [f64; 3])| {
            let pole = self.bodies[body].pole;
            let own = self.contacts.iter().filter(move |c| c.minus.body == body || c.plus.body == body);
            own.map(move |c| (Vec2::new(x, y) + turned(c.position - pole) * theta).norm()).fold(0.0, f64::max)
        };
        loading.settlements.iter().map(moves).fold(0.0, f64::max)
    }

    /// Returns the motions of all bodies from the settlements up to a factor of a load step.
    pub fn settled(&self, load_step: usize, factor: f64) -> Vec<[f64; 3]> {
        let mut settled = vec![[0.0; 3]; self.bodies.len()];
        for (step, applied) in self.load_steps.iter().zip(self.applied(load_step, factor)) {
            for (body, motion) in &step.loading.settlements {
                (0..3).for_each(|i| settled[*body][i] += applied * motion[i]);
            }
        }
        settled
    }

    /// Returns the work-conjugate displacement of a loading on rigid motions: Σ F·u / Σ|F| \[m\], with u by `rigid` of
    /// (body, point). If a loading only moves supports, it is the distance by which it has moved them at its factor.
    pub fn load_displacement(
        &self,
        (loading, factor): (&Loading, f64),
        motion: &[[f64; 3]],
        rigid: impl Fn(usize, Vec2) -> Vec2,
    ) -> f64 {
        let size = self.load_size(loading);
        if size == 0.0 {
            return factor * self.settlement_size(loading);
        }
        let forces: f64 = loading.forces.iter().map(|(body, _, point, f)| f.dot(&rigid(*body, *point))).sum();
        let free = self.bodies.iter().zip(motion).filter(|(b, _)| !b.held);
        let masses: f64 = free.map(|(b, q)| b.mass * loading.acceleration.dot(&Vec2::new(q[0], q[1]))).sum();
        (forces + masses) / size
    }

    /// Returns the displacement of a point of a body by the rigid motion of a state \[m\].
    pub fn rigid_displacement(&self, motion: &[[f64; 3]], body: usize, point: Vec2, finite: bool) -> Vec2 {
        let ([x, y, theta], arm) = (motion[body], point - self.bodies[body].pole);
        Vec2::new(x, y) + if finite { Rotation2::new(theta) * arm - arm } else { turned(arm) * theta }
    }

    /// Returns Σ|work| between two states \[J\]: the work of the loads of earlier steps, which are constant and act on
    /// the rigid motions of bodies, and the work of the changing load and the moving supports. The two are added
    /// without sign, because they cancel along a mechanism.
    pub fn gross_work(&self, from: &PathState, to: &PathState, finite: bool) -> f64 {
        let moved =
            |state: &PathState, body: usize, point: Vec2| self.rigid_displacement(&state.motion, body, point, finite);
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
