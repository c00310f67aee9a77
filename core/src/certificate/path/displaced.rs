//! Gaps and equilibrium of a recorded state, from the problem alone: at undeformed positions if displacements are
//! small, else at displaced positions.
//!
//! With finite displacements a point of a body is at x = X + u + R(θ)(ξ + v): X is the pole, ξ the position relative to
//! it, v the deformation in axes that rotate with the body, v = C f, and f the forces on its points in these axes. The
//! axes n and t of a contact rotate by θ⁻ + β (θ⁺ − θ⁻) and its gaps are x⁺ − x⁻ in them. Its force acts on both bodies
//! at (1 − β) x⁺ + β x⁻, the point for which its virtual work is r·δg ([`Sliding`](crate::path::Sliding); β = ½ is the
//! middle; if β depends on slip, there is an additional force along t). Bodies are in equilibrium about their displaced
//! poles.

use crate::law::{Facet, FacetMode};
use crate::linear::vectors::add_product;
use crate::model::geometry::{Vec2, cross, turned};
use crate::path::{Attachment, Contact, PathProblem, PathState, PointLaw};
use std::cell::OnceCell;

/// A state with the deformations of its bodies.
pub struct Displaced<'a> {
    pub(super) problem: &'a PathProblem,
    pub(super) state: &'a PathState,
    finite: bool,
    /// Forces on the points of every body in its axes \[N\].
    forces: Vec<Vec<Vec2>>,
    /// Deformation (x, y) of the points of every body in its axes \[m\].
    deformation: Vec<Vec<f64>>,
    gaps: OnceCell<Vec<[f64; 2]>>,
}

/// Returns v rotated by an angle \[rad\].
fn rotated(v: Vec2, angle: f64) -> Vec2 {
    v * angle.cos() + turned(v) * angle.sin()
}

impl<'a> Displaced<'a> {
    /// Creates it for small or `finite` displacements.
    pub fn new(problem: &'a PathProblem, state: &'a PathState, finite: bool) -> Self {
        let forces = problem.forces_on_points(state, finite);
        let bodies = problem.bodies.iter().zip(&forces).enumerate();
        let mut flat: Vec<f64> = Vec::new();
        let deformation =
            bodies.map(|(index, (body, f))| match (&body.flexibility, &body.inelastic, state.inelastic(index)) {
                (None, ..) => Vec::new(),
                (Some(_), Some(inelastic), Some(recorded)) => inelastic.at_points(&recorded.displacement),
                (Some(flexibility), ..) => {
                    flat.clear();
                    f.iter().for_each(|f| flat.extend([f.x, f.y]));
                    let mut u = vec![0.0; flat.len()];
                    add_product(&mut u, flexibility.nrows(), flexibility.as_slice(), &flat);
                    u
                }
            });
        let deformation = deformation.collect();
        Displaced { problem, state, finite, forces, deformation, gaps: OnceCell::new() }
    }

    /// Returns the displacement of a point of a body by its rigid motion and by its deformation \[m\].
    #[inline(always)]
    fn parts(&self, body: usize, slot: Option<usize>, point: Vec2) -> [Vec2; 2] {
        let [x, y, theta] = self.state.motion[body];
        let arm = point - self.problem.bodies[body].pole;
        let own = slot.and_then(|slot| self.deformation[body].get(2 * slot..2 * slot + 2));
        let deformed = own.map_or_else(Vec2::zeros, |own| Vec2::new(own[0], own[1]));
        let shift = Vec2::new(x, y);
        match self.finite {
            true => [shift + (rotated(arm, theta) - arm), rotated(deformed, theta)],
            false => [shift + turned(arm) * theta, deformed],
        }
    }

    #[inline(always)]
    fn displacement(&self, body: usize, slot: Option<usize>, point: Vec2) -> Vec2 {
        let [rigid, deformed] = self.parts(body, slot, point);
        rigid + deformed
    }

    /// Returns the displacements of the points on plus and minus.
    fn sides(&self, contact: &Contact) -> [[Vec2; 2]; 2] {
        [contact.plus, contact.minus].map(|side: Attachment| self.parts(side.body, side.slot, contact.position))
    }

    /// Returns the axes (n, t) of a contact point, rotated with a share β of the relative rotation of its bodies, for
    /// finite displacements.
    fn axes(&self, contact: &Contact, share: f64) -> [Vec2; 2] {
        let [low, high] = [contact.minus, contact.plus].map(|side| self.state.motion[side.body][2]);
        let turn = low + share * (high - low);
        [contact.normal, contact.tangent].map(|e| rotated(e, turn))
    }

    /// Returns β of a contact point and its derivative with respect to slip, at its slip in the mean axes, for finite
    /// displacements.
    fn share(&self, contact: &Contact, [plus, minus]: &[[Vec2; 2]; 2]) -> [f64; 2] {
        let slip = (plus[0] - minus[0]).dot(&self.axes(contact, 0.5)[1]);
        let [share, first, _] = contact.sliding.share_at(slip);
        [share, first]
    }

    /// Returns the gaps (n, t) of all contact points from motions, forces and loads \[m\].
    pub fn gaps(&self) -> &[[f64; 2]] {
        self.gaps.get_or_init(|| self.all_gaps())
    }

    fn all_gaps(&self) -> Vec<[f64; 2]> {
        let apart = |contact: &Contact| {
            if !self.finite {
                let place = |side: Attachment| self.displacement(side.body, side.slot, contact.position);
                let apart = place(contact.plus) - place(contact.minus);
                return [apart.dot(&contact.normal), apart.dot(&contact.tangent)];
            }
            let sides = self.sides(contact);
            let [share, _] = self.share(contact, &sides);
            let ([plus, minus], [of_motion, of_deformation]) =
                (sides, [share, 0.5].map(|share| self.axes(contact, share)));
            [0, 1].map(|k| (plus[0] - minus[0]).dot(&of_motion[k]) + (plus[1] - minus[1]).dot(&of_deformation[k]))
        };
        let gap = |(contact, force): (&Contact, &[f64; 2])| {
            let ([n, t], [first, second]) = (apart(contact), contact.compliance);
            [contact.gap + n + first * force[0], t + second * force[1]]
        };
        self.problem.contacts.iter().zip(&self.state.force).map(gap).collect()
    }

    /// Returns the elastic energy of blocks and joints \[J\] (Clapeyron). `None` if it is not a function of forces: a
    /// block has yielded, or a joint has a response or a tensile strength.
    pub fn stored(&self) -> Option<f64> {
        let contacts = &self.problem.contacts;
        let pulls = |f: &Facet| f.mode == FacetMode::Opening && f.bound > 0.0;
        // Most contact points have the same law as the point before.
        let mut last: &[Facet] = &[];
        let mut by_history = |law: &'a PointLaw| match law {
            PointLaw::Bonded => false,
            PointLaw::Facets(facets) => {
                let before = std::mem::replace(&mut last, facets);
                !std::ptr::eq(before, last) && facets.iter().any(pulls)
            }
            PointLaw::Response(_) => true,
        };
        if self.state.yielded.iter().any(Option::is_some) || contacts.iter().any(|c| by_history(&c.law)) {
            return None;
        }
        let of_body = |(forces, u): (&Vec<Vec2>, &Vec<f64>)| -> f64 {
            forces.iter().zip(u.chunks_exact(2)).map(|(f, u)| f.x * u[0] + f.y * u[1]).sum()
        };
        let bodies: f64 = self.forces.iter().zip(&self.deformation).map(of_body).sum();
        let of_joint = |(c, r): (&Contact, &[f64; 2])| c.compliance[0] * r[0] * r[0] + c.compliance[1] * r[1] * r[1];
        let joints: f64 = contacts.iter().zip(&self.state.force).map(of_joint).sum();
        Some(0.5 * (bodies + joints))
    }

    /// Returns the unbalanced resultant of loads and contact forces on each body, about its pole \[N, N m\].
    pub fn unbalanced(&self) -> Vec<[f64; 3]> {
        let problem = self.problem;
        let mut wrench = vec![[0.0; 3]; problem.bodies.len()];
        let add = |wrench: &mut [[f64; 3]], body: usize, displacement: Vec2, point: Vec2, force: Vec2| {
            let [x, y, _] = self.state.motion[body];
            let moved = if self.finite { displacement - Vec2::new(x, y) } else { Vec2::zeros() };
            let moment = cross(point + moved - problem.bodies[body].pole, force);
            wrench[body] = [wrench[body][0] + force.x, wrench[body][1] + force.y, wrench[body][2] + moment];
        };
        for (load_step, factor) in
            problem.load_steps.iter().zip(problem.applied(self.state.load_step, self.state.factor))
        {
            for &(body, slot, point, force) in &load_step.loading.forces {
                add(&mut wrench, body, self.displacement(body, slot, point), point, force * factor);
            }
            for (index, body) in problem.bodies.iter().enumerate() {
                let [x, y, _] = self.state.motion[index];
                add(
                    &mut wrench,
                    index,
                    Vec2::new(x, y),
                    body.pole,
                    load_step.loading.acceleration * (body.mass * factor),
                );
            }
        }
        for (contact, r) in problem.contacts.iter().zip(&self.state.force) {
            // With small displacements the force acts at the undeformed position.
            if !self.finite {
                let push = contact.normal * r[0] + contact.tangent * r[1];
                for (body, push) in [(contact.plus.body, push), (contact.minus.body, -push)] {
                    let moment = cross(contact.position - problem.bodies[body].pole, push);
                    let wrench = &mut wrench[body];
                    *wrench = [wrench[0] + push.x, wrench[1] + push.y, wrench[2] + moment];
                }
                continue;
            }
            let sides = self.sides(contact);
            let ([plus, minus], [share, by_slip]) = (sides, self.share(contact, &sides));
            let [n, t] = self.axes(contact, share);
            let by_motion = n * r[0] + t * r[1];
            let mut both = |at: Vec2, push: Vec2| {
                add(&mut wrench, contact.plus.body, at, contact.position, push);
                add(&mut wrench, contact.minus.body, at, contact.position, -push);
            };
            both(plus[0] * (1.0 - share) + minus[0] * share, by_motion);
            let mean = self.axes(contact, 0.5);
            if by_slip != 0.0 {
                // Additional force because β depends on slip: r·∂g/∂β β' along the mean tangent.
                let [low, high] = [contact.minus, contact.plus].map(|side| self.state.motion[side.body][2]);
                let passing = cross(by_motion, plus[0] - minus[0]) * (high - low) * by_slip;
                both((plus[0] + minus[0]) * 0.5, mean[1] * passing);
            }
            // Lever arms from the deformation of the blocks.
            let moment = cross((plus[1] + minus[1]) * 0.5, mean[0] * r[0] + mean[1] * r[1]);
            wrench[contact.plus.body][2] += moment;
            wrench[contact.minus.body][2] -= moment;
        }
        wrench
    }
}
