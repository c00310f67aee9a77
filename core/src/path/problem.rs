//! The path problem as data: bodies with their flexibility, contact points, load steps, and what they give directly.

use super::point_law::PointLaw;
use super::sliding::Sliding;
use super::state::PathState;
use crate::elastic::InelasticBody;
use crate::law::{Facet, InterfaceResponse};
use crate::limit::Counters;
use crate::model::geometry::{Vec2, cross, turned};
use nalgebra::DMatrix;
use std::sync::Arc;

/// A body of the path problem: one block, or several rigid ones bonded together.
#[derive(Debug, Clone, Default)]
pub struct PathBody {
    /// Blocks of the assembly.
    pub members: Vec<usize>,
    /// Its centroid; the origin where it has no shape; the point about which a support settles \[m\].
    pub pole: Vec2,
    /// Held by the ground: moves by settlement only.
    pub held: bool,
    /// \[kg\].
    pub mass: f64,
    /// Points that something acts on, with a flexibility: contact points first, then loads.
    pub points: Vec<Vec2>,
    /// Displacements (x, y per point) by forces (x, y per point) relative to the mean rigid motion
    /// \[m/N\]; `None` for rigid bodies.
    pub flexibility: Option<Arc<DMatrix<f64>>>,
    /// Where the material yields: the body with its mesh. `flexibility` is then that of the body
    /// before anything has yielded.
    pub inelastic: Option<Arc<InelasticBody>>,
}

/// One side of a contact point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Attachment {
    /// Index of the body.
    pub body: usize,
    /// Index of the point among the body's, where the body has a flexibility.
    pub slot: Option<usize>,
}

/// A contact point.
#[derive(Debug, Clone)]
pub struct Contact {
    /// Index of the joint in the assembly.
    pub joint: usize,
    /// Where it is \[m\].
    pub position: Vec2,
    /// Unit normal from minus to plus.
    pub normal: Vec2,
    /// Unit tangent.
    pub tangent: Vec2,
    /// On the minus body.
    pub minus: Attachment,
    /// On the plus body.
    pub plus: Attachment,
    /// Tributary area \[m²\].
    pub area: f64,
    /// Initial gap \[m\].
    pub gap: f64,
    /// Its law. Where that gives tractions from gaps, the gap holds the compliance of the joint too: it
    /// is part of the law.
    pub law: PointLaw,
    /// Compliance of the joint at this point, normal and tangential \[m/N\].
    pub compliance: [f64; 2],
    /// How it slides with finite displacements.
    pub sliding: Sliding,
}

/// Loads that grow together.
#[derive(Debug, Clone, Default)]
pub struct Loading {
    /// (body, slot of the point in the body where it is elastic, point, force \[N\]).
    pub forces: Vec<(usize, Option<usize>, Vec2, Vec2)>,
    /// Acceleration of all bodies \[m/s²\].
    pub acceleration: Vec2,
    /// (held body, displacement about its pole \[u_x, u_y, θ\]).
    pub settlements: Vec<(usize, [f64; 3])>,
}

/// How far a load step goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LoadStepEnd {
    /// To this factor.
    Factor(f64),
    /// Until no more can be carried, up to this factor (may be ∞).
    Collapse(f64),
}

/// One load history in the sequence: `λ × loading` on top of all earlier ones.
#[derive(Debug, Clone)]
pub struct LoadStep {
    /// Index of the stage.
    pub stage: usize,
    /// Whether it is the stage's change of gravity (factor from 0 to 1) or its loads.
    pub gravity: bool,
    /// What grows.
    pub loading: Loading,
    /// λ at its start.
    pub start: f64,
    /// Where it ends.
    pub end: LoadStepEnd,
}

/// Everything a path solver needs.
#[derive(Debug, Clone)]
pub struct PathProblem {
    /// Bodies.
    pub bodies: Vec<PathBody>,
    /// For each block of the assembly its body.
    pub body_of: Vec<usize>,
    /// Contact points, those of a joint next to each other and in order along it.
    pub contacts: Vec<Contact>,
    /// Load histories in order.
    pub load_steps: Vec<LoadStep>,
    /// Length scale \[m\].
    pub length: f64,
    /// What the movement of the load's point after a peak is measured by \[m\]: [`Assembly::span`](crate::model::Assembly::span).
    pub span: f64,
    /// Work done to build it.
    pub counters: Counters,
}

impl PathProblem {
    /// Laws of facets, each once in the order of the contact points, and for each point the index of its own.
    pub fn shared_facets(&self) -> (Vec<&[Facet]>, Vec<Option<usize>>) {
        let mut laws: Vec<&[Facet]> = Vec::new();
        let of = self.contacts.iter().map(|contact| {
            let own = contact.law.facets()?;
            Some(laws.iter().position(|law| std::ptr::eq(*law, own)).unwrap_or_else(|| {
                laws.push(own);
                laws.len() - 1
            }))
        });
        let of = of.collect();
        (laws, of)
    }

    /// Whether some body's material yields.
    pub fn yields(&self) -> bool {
        self.bodies.iter().any(|body| body.inelastic.is_some())
    }

    /// Whether anything can deform: a scene of rigid bodies without joint compliance has no path
    /// before its collapse.
    pub fn deforms(&self) -> bool {
        self.bodies.iter().any(|body| body.flexibility.is_some())
            || self.contacts.iter().any(|c| c.compliance[0] > 0.0 || c.law.response().is_some())
    }

    /// The law of a contact point, where it gives tractions from gaps.
    pub fn response(&self, contact: usize) -> Option<&dyn InterfaceResponse> {
        self.contacts[contact].law.response().map(|law| &**law)
    }

    /// How much of each load step's loading is applied at a factor of one of them.
    pub fn applied(&self, load_step: usize, factor: f64) -> Vec<f64> {
        let reached = |(index, d): (usize, &LoadStep)| match (index.cmp(&load_step), d.end) {
            (std::cmp::Ordering::Less, LoadStepEnd::Factor(end) | LoadStepEnd::Collapse(end)) => end - d.start,
            (std::cmp::Ordering::Equal, _) => factor - d.start,
            (std::cmp::Ordering::Greater, _) => 0.0,
        };
        self.load_steps.iter().enumerate().map(reached).collect()
    }

    /// Wrench of a loading on each body about its pole, undeformed positions \[N, N m\].
    pub fn wrenches(&self, loading: &Loading) -> Vec<[f64; 3]> {
        let mut wrenches: Vec<[f64; 3]> = self
            .bodies
            .iter()
            .map(|body| [loading.acceleration.x * body.mass, loading.acceleration.y * body.mass, 0.0])
            .collect();
        for &(body, _, point, force) in &loading.forces {
            let wrench = &mut wrenches[body];
            wrench[0] += force.x;
            wrench[1] += force.y;
            wrench[2] += cross(point - self.bodies[body].pole, force);
        }
        wrenches
    }

    /// Displacement (x, y) of point `slot` of a body by the deformation that a loading causes, small
    /// displacements \[m\].
    pub fn deformation(&self, loading: &Loading, body: usize, slot: usize) -> Vec2 {
        let mut u = Vec2::zeros();
        let Some(flexibility) = &self.bodies[body].flexibility else { return u };
        for &(on, at, _, force) in &loading.forces {
            if let (true, Some(at)) = (on == body, at) {
                for (i, u) in u.iter_mut().enumerate() {
                    *u += flexibility[(2 * slot + i, 2 * at)] * force.x
                        + flexibility[(2 * slot + i, 2 * at + 1)] * force.y;
                }
            }
        }
        u
    }

    /// Gap (n, t) that a loading opens at each contact point with all bodies' motions and contact
    /// forces zero: deformation and settlements, small displacements \[m\].
    pub fn loading_gaps(&self, loading: &Loading) -> Vec<[f64; 2]> {
        let settled = |body: usize, point: Vec2| {
            let mut u = Vec2::zeros();
            for (held, [x, y, theta]) in &loading.settlements {
                if *held == body {
                    u += Vec2::new(*x, *y) + turned(point - self.bodies[body].pole) * *theta;
                }
            }
            u
        };
        let side = |attachment: Attachment, point: Vec2| {
            let elastic =
                attachment.slot.map_or(Vec2::zeros(), |slot| self.deformation(loading, attachment.body, slot));
            elastic + settled(attachment.body, point)
        };
        self.contacts
            .iter()
            .map(|c| {
                let jump = side(c.plus, c.position) - side(c.minus, c.position);
                [jump.dot(&c.normal), jump.dot(&c.tangent)]
            })
            .collect()
    }

    /// Rows of G at a contact point for one side: (n, t) of the displacement of the point per
    /// (u_x, u_y, θ) of the body about its pole, with the side's sign.
    pub fn kinematics(&self, contact: &Contact, plus: bool) -> [[f64; 3]; 2] {
        let (body, sign) = if plus { (contact.plus.body, 1.0) } else { (contact.minus.body, -1.0) };
        let arm = contact.position - self.bodies[body].pole;
        [contact.normal, contact.tangent].map(|e| [sign * e.x, sign * e.y, sign * cross(arm, e)])
    }

    /// Contact forces and loads of a state on the points of every body, in axes that turn with the
    /// body where displacements are `finite` \[N\]: there a contact's frame has the mean rotation of
    /// its two bodies.
    pub fn forces_on_points(&self, state: &PathState, finite: bool) -> Vec<Vec<Vec2>> {
        let mut forces: Vec<Vec<Vec2>> = self.bodies.iter().map(|b| vec![Vec2::zeros(); b.points.len()]).collect();
        let turn = |angle: f64, v: Vec2| if finite { v * angle.cos() + turned(v) * angle.sin() } else { v };
        let angle = |body: usize| state.motion[body][2];
        let on_points = |c: &Contact| c.minus.slot.is_some() || c.plus.slot.is_some();
        for (contact, f) in self.contacts.iter().zip(&state.force).filter(|(c, _)| on_points(c)) {
            let on_plus = contact.normal * f[0] + contact.tangent * f[1];
            let mean = (angle(contact.minus.body) + angle(contact.plus.body)) / 2.0;
            for (side, sign) in [(contact.minus, -1.0), (contact.plus, 1.0)] {
                if let Some(slot) = side.slot {
                    forces[side.body][slot] += turn(mean - angle(side.body), on_plus) * sign;
                }
            }
        }
        for (load_step, factor) in self.load_steps.iter().zip(self.applied(state.load_step, state.factor)) {
            for (body, slot, _, f) in &load_step.loading.forces {
                if let Some(slot) = slot {
                    forces[*body][*slot] += turn(-angle(*body), *f) * factor;
                }
            }
        }
        forces
    }

    /// Numbers in the states of all laws of tractions from gaps.
    pub fn memory_size(&self) -> usize {
        (0..self.contacts.len()).filter_map(|c| self.response(c)).map(|law| law.state_size()).sum()
    }

    /// States of untouched joints, contact point after contact point.
    pub fn untouched(&self) -> Vec<f64> {
        let mut memory = vec![0.0; self.memory_size()];
        let mut at = 0;
        for law in (0..self.contacts.len()).filter_map(|c| self.response(c)) {
            law.initial_state(&mut memory[at..at + law.state_size()]);
            at += law.state_size();
        }
        memory
    }
}
