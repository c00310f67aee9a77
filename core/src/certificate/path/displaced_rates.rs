//! Rates of gaps and of unbalanced forces along a direction, with finite displacements: the equations of
//! [`Displaced`](super::Displaced) with derivatives.

use super::dual::{Dual, Dual2};
use crate::path::{Attachment, Contact, PathProblem, PathRate, PathState};

/// Displacement of a point by the rigid motion and by the deformation of its body.
type Parts = [Dual2; 2];

/// Rates (n, t) of all gaps, and rates of the unbalanced wrench on each body.
pub(super) struct ResidualRates {
    pub gaps: Vec<[Dual; 2]>,
    pub unbalanced: Vec<[Dual; 3]>,
}

/// A state that moves along rates of forces, motions and the factor. The gap rates of `along` are not used.
struct Moving<'a> {
    problem: &'a PathProblem,
    /// Motions of all bodies.
    motion: Vec<[Dual; 3]>,
    force: Vec<[Dual; 2]>,
    /// The applied share of each load step.
    applied: Vec<Dual>,
    /// Deformation of the points of all bodies in axes that rotate with them.
    deformation: Vec<Vec<Dual2>>,
}

/// Returns the rates of residuals along a direction. Bodies must not yield, and no law may be a response.
pub(super) fn residual_rates(problem: &PathProblem, state: &PathState, along: &PathRate) -> ResidualRates {
    let pair = |i: usize, (value, rate): (&[f64; 2], &[f64; 2])| Dual::new(value[i], rate[i]);
    let motion = state.motion.iter().zip(&along.motion);
    let motion = motion.map(|(u, v)| [0, 1, 2].map(|i| Dual::new(u[i], v[i]))).collect();
    let force = state.force.iter().zip(&along.force).map(|own| [0, 1].map(|i| pair(i, own))).collect();
    let applied = problem.applied(state.load_step, state.factor).into_iter().enumerate();
    let applied = applied.map(|(step, a)| Dual::new(a, if step == state.load_step { along.factor } else { 0.0 }));
    let mut moving = Moving { problem, motion, force, applied: applied.collect(), deformation: Vec::new() };
    moving.deformation = moving.deformations();
    ResidualRates { gaps: moving.gaps(), unbalanced: moving.unbalanced() }
}

impl Moving<'_> {
    fn angle(&self, body: usize) -> Dual {
        self.motion[body][2]
    }

    fn shift(&self, body: usize) -> Dual2 {
        Dual2 { x: self.motion[body][0], y: self.motion[body][1] }
    }

    /// Returns the axes (n, t), rotated with a share of the relative rotation of both bodies.
    fn axes(&self, contact: &Contact, share: Dual) -> [Dual2; 2] {
        let [low, high] = [contact.minus, contact.plus].map(|side| self.angle(side.body));
        [contact.normal, contact.tangent].map(|e| Dual2::fixed(e).rotated(low + share * (high - low)))
    }

    /// Returns the forces on the points of bodies in axes that rotate with them.
    fn forces_on_points(&self) -> Vec<Vec<Dual2>> {
        let mut forces: Vec<Vec<Dual2>> =
            self.problem.bodies.iter().map(|body| vec![Dual2::default(); body.points.len()]).collect();
        for (contact, r) in self.problem.contacts.iter().zip(&self.force) {
            let push = Dual2::fixed(contact.normal) * r[0] + Dual2::fixed(contact.tangent) * r[1];
            let mean = (self.angle(contact.minus.body) + self.angle(contact.plus.body)) * 0.5;
            for (side, sign) in [(contact.minus, -1.0), (contact.plus, 1.0)] {
                if let Some(slot) = side.slot {
                    let own = push.rotated(mean - self.angle(side.body)) * sign;
                    forces[side.body][slot] = forces[side.body][slot] + own;
                }
            }
        }
        for (step, factor) in self.problem.load_steps.iter().zip(&self.applied) {
            for &(body, slot, _, force) in &step.loading.forces {
                if let Some(slot) = slot {
                    let own = Dual2::fixed(force).rotated(-self.angle(body)) * *factor;
                    forces[body][slot] = forces[body][slot] + own;
                }
            }
        }
        forces
    }

    fn deformations(&self) -> Vec<Vec<Dual2>> {
        let bodies = self.problem.bodies.iter().zip(self.forces_on_points());
        let of = bodies.map(|(body, forces)| {
            let Some(flexibility) = &body.flexibility else { return Vec::new() };
            let row = |i: usize| {
                let mut sum = Dual::default();
                for (k, f) in forces.iter().enumerate() {
                    sum = sum + f.x * flexibility[(i, 2 * k)] + f.y * flexibility[(i, 2 * k + 1)];
                }
                sum
            };
            (0..forces.len()).map(|k| Dual2 { x: row(2 * k), y: row(2 * k + 1) }).collect()
        });
        of.collect()
    }

    fn parts(&self, side: Attachment, point: crate::model::geometry::Vec2) -> Parts {
        let arm = Dual2::fixed(point - self.problem.bodies[side.body].pole);
        let angle = self.angle(side.body);
        let deformed = side.slot.and_then(|slot| self.deformation[side.body].get(slot)).copied().unwrap_or_default();
        [self.shift(side.body) + arm.rotated(angle) - arm, deformed.rotated(angle)]
    }

    fn sides(&self, contact: &Contact) -> [Parts; 2] {
        [contact.plus, contact.minus].map(|side| self.parts(side, contact.position))
    }

    /// Returns β and its derivative with respect to slip.
    fn share(&self, contact: &Contact, [plus, minus]: &[Parts; 2]) -> [Dual; 2] {
        let slip = (plus[0] - minus[0]).dot(self.axes(contact, Dual::fixed(0.5))[1]);
        let [share, first, second] = contact.sliding.share_at(slip.value);
        [Dual::new(share, first * slip.rate), Dual::new(first, second * slip.rate)]
    }

    fn gaps(&self) -> Vec<[Dual; 2]> {
        let gap = |(contact, force): (&Contact, &[Dual; 2])| {
            let sides = self.sides(contact);
            let [share, _] = self.share(contact, &sides);
            let [plus, minus] = sides;
            let (of_motion, mean) = (self.axes(contact, share), self.axes(contact, Dual::fixed(0.5)));
            let initial = [contact.gap, 0.0];
            [0, 1].map(|k| {
                let apart = (plus[0] - minus[0]).dot(of_motion[k]) + (plus[1] - minus[1]).dot(mean[k]);
                apart + Dual::fixed(initial[k]) + force[k] * contact.compliance[k]
            })
        };
        self.problem.contacts.iter().zip(&self.force).map(gap).collect()
    }

    /// Adds a force at a point of a body that has moved by `displacement`.
    fn add(&self, wrench: &mut [[Dual; 3]], body: usize, (point, displacement): (Dual2, Dual2), force: Dual2) {
        let arm = point + displacement - self.shift(body) - Dual2::fixed(self.problem.bodies[body].pole);
        let own = [force.x, force.y, arm.cross(force)];
        (0..3).for_each(|i| wrench[body][i] = wrench[body][i] + own[i]);
    }

    fn unbalanced(&self) -> Vec<[Dual; 3]> {
        let problem = self.problem;
        let mut wrench = vec![[Dual::default(); 3]; problem.bodies.len()];
        for (step, factor) in problem.load_steps.iter().zip(&self.applied) {
            for &(body, slot, point, force) in &step.loading.forces {
                let [rigid, deformed] = self.parts(Attachment { body, slot }, point);
                let at = (Dual2::fixed(point), rigid + deformed);
                self.add(&mut wrench, body, at, Dual2::fixed(force) * *factor);
            }
            for (index, body) in problem.bodies.iter().enumerate() {
                let weight = Dual2::fixed(step.loading.acceleration * body.mass) * *factor;
                self.add(&mut wrench, index, (Dual2::fixed(body.pole), self.shift(index)), weight);
            }
        }
        for (contact, r) in problem.contacts.iter().zip(&self.force) {
            self.add_contact(&mut wrench, contact, r);
        }
        wrench
    }

    fn add_contact(&self, wrench: &mut [[Dual; 3]], contact: &Contact, r: &[Dual; 2]) {
        let (low, high) = (contact.minus.body, contact.plus.body);
        let sides = self.sides(contact);
        let [share, by_slip] = self.share(contact, &sides);
        let [plus, minus] = sides;
        let ([n, t], mean) = (self.axes(contact, share), self.axes(contact, Dual::fixed(0.5)));
        let push = n * r[0] + t * r[1];
        let point = Dual2::fixed(contact.position);
        let mut both = |displacement: Dual2, push: Dual2| {
            self.add(wrench, high, (point, displacement), push);
            self.add(wrench, low, (point, displacement), push * -1.0);
        };
        both(plus[0] * (Dual::fixed(1.0) - share) + minus[0] * share, push);
        let passing = push.cross(plus[0] - minus[0]) * (self.angle(high) - self.angle(low)) * by_slip;
        both((plus[0] + minus[0]) * 0.5, mean[1] * passing);
        let moment = ((plus[1] + minus[1]) * 0.5).cross(mean[0] * r[0] + mean[1] * r[1]);
        wrench[high][2] = wrench[high][2] + moment;
        wrench[low][2] = wrench[low][2] - moment;
    }
}
