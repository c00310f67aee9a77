//! The path problem as data: bodies with their flexibility, contact points, load steps, and quantities derived from
//! them.

use super::period::Period;
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
    /// Indices of its blocks in the assembly.
    pub members: Vec<usize>,
    /// Pole of its motion \[m\]: its centroid, the point about which a support settles, or the origin if the body has
    /// no shape.
    pub pole: Vec2,
    /// True if the ground holds it: it moves by settlement only.
    pub held: bool,
    /// Mass \[kg\].
    pub mass: f64,
    /// Points at which forces act on a flexible body: contact points first, then loads.
    pub points: Vec<Vec2>,
    /// Displacements (x, y per point) per force (x, y per point), relative to the mean rigid motion \[m/N\]; `None` for
    /// rigid bodies.
    pub flexibility: Option<Arc<DMatrix<f64>>>,
    /// The body with its mesh, if its material can yield. `flexibility` is then the flexibility before yielding.
    pub inelastic: Option<Arc<InelasticBody>>,
}

/// One side of a contact point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Attachment {
    /// Index of the body.
    pub body: usize,
    /// Index of the point in the list of the body, if the body has a flexibility.
    pub slot: Option<usize>,
}

/// A contact point.
#[derive(Debug, Clone)]
pub struct Contact {
    /// Index of the joint in the assembly.
    pub joint: usize,
    /// Position \[m\].
    pub position: Vec2,
    /// Unit normal from minus to plus.
    pub normal: Vec2,
    /// Unit tangent.
    pub tangent: Vec2,
    /// Attachment to the minus body.
    pub minus: Attachment,
    /// Attachment to the plus body.
    pub plus: Attachment,
    /// Tributary area \[m²\].
    pub area: f64,
    /// Initial gap \[m\].
    pub gap: f64,
    /// Its law. If this is a response, the gap includes the compliance of the joint, which is part of the law.
    pub law: PointLaw,
    /// Compliance of the joint at this point, normal and tangential \[m/N\].
    pub compliance: [f64; 2],
    /// Rule of sliding with finite displacements.
    pub sliding: Sliding,
}

/// Loads that grow together.
#[derive(Debug, Clone, Default)]
pub struct Loading {
    /// (body, index of the point in a flexible body, point, force \[N\]).
    pub forces: Vec<(usize, Option<usize>, Vec2, Vec2)>,
    /// Acceleration of all bodies \[m/s²\].
    pub acceleration: Vec2,
    /// (held body, displacement about its pole \[u_x, u_y, θ\]).
    pub settlements: Vec<(usize, [f64; 3])>,
}

/// The end of a load step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LoadStepEnd {
    /// The load step ends at this factor.
    Factor(f64),
    /// The load step ends at collapse, or at this factor (may be ∞).
    Collapse(f64),
}

/// One part of the load history: `λ × loading` in addition to all earlier load steps.
#[derive(Debug, Clone)]
pub struct LoadStep {
    /// Index of the stage.
    pub stage: usize,
    /// True for the change of gravity of the stage (factor from 0 to 1), false for its loads.
    pub gravity: bool,
    /// The loads that grow.
    pub loading: Loading,
    /// λ at the start.
    pub start: f64,
    /// The end of the load step.
    pub end: LoadStepEnd,
    /// Duration and fields of the load step.
    pub period: Period,
}

/// The input of a path solver.
#[derive(Debug, Clone)]
pub struct PathProblem {
    /// Bodies of the problem.
    pub bodies: Vec<PathBody>,
    /// The body of each block of the assembly.
    pub body_of: Vec<usize>,
    /// Contact points, joint by joint and in order along each joint.
    pub contacts: Vec<Contact>,
    /// Load steps in order.
    pub load_steps: Vec<LoadStep>,
    /// Length scale \[m\].
    pub length: f64,
    /// Length for the displacement of the load after a peak \[m\]: [`Assembly::span`](crate::model::Assembly::span).
    pub span: f64,
    /// Width of all joints, perpendicular to the plane \[m\].
    pub width: f64,
    /// Counts of the work to build the problem.
    pub counters: Counters,
}

impl PathProblem {
    /// Returns the different laws of facets in the order of the contact points, and the index of the law of each point.
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

    /// Returns true if the material of a body can yield.
    pub fn yields(&self) -> bool {
        self.bodies.iter().any(|body| body.inelastic.is_some())
    }

    /// Returns true if a body or a joint can deform. A scene of rigid bodies without joint compliance has no path
    /// before its collapse.
    pub fn deforms(&self) -> bool {
        self.bodies.iter().any(|body| body.flexibility.is_some())
            || self.contacts.iter().any(|c| c.compliance[0] > 0.0 || c.law.response().is_some())
    }

    /// Returns the law of a contact point if it is a response.
    pub fn response(&self, contact: usize) -> Option<&dyn InterfaceResponse> {
        self.contacts[contact].law.response().map(|law| &**law)
    }

    /// Returns the applied share of each load step at a factor of one of them.
    pub fn applied(&self, load_step: usize, factor: f64) -> Vec<f64> {
        let reached = |(index, d): (usize, &LoadStep)| match (index.cmp(&load_step), d.end) {
            (std::cmp::Ordering::Less, LoadStepEnd::Factor(end) | LoadStepEnd::Collapse(end)) => end - d.start,
            (std::cmp::Ordering::Equal, _) => factor - d.start,
            (std::cmp::Ordering::Greater, _) => 0.0,
        };
        self.load_steps.iter().enumerate().map(reached).collect()
    }

    /// Returns the share of a load step at a factor: 0 at its start, 1 at its end. A load step without a finite end has
    /// no duration and constant fields; its share is 0.
    fn share(&self, load_step: usize, factor: f64) -> f64 {
        let step = &self.load_steps[load_step];
        let (LoadStepEnd::Factor(end) | LoadStepEnd::Collapse(end)) = step.end;
        let range = end - step.start;
        if range == 0.0 || !range.is_finite() { 0.0 } else { (factor - step.start) / range }
    }

    /// Returns the time that passes between two places of a path \[s\]: load steps with factors in them.
    pub fn time_between(&self, from: (usize, f64), to: (usize, f64)) -> f64 {
        let passed = |load_step: usize, share: f64| match self.load_steps[load_step].period.duration {
            duration if duration > 0.0 => duration * share,
            _ => 0.0,
        };
        if from.0 == to.0 {
            return passed(to.0, self.share(to.0, to.1) - self.share(from.0, from.1));
        }
        let between: f64 = (from.0 + 1..to.0).map(|load_step| passed(load_step, 1.0)).sum();
        passed(from.0, 1.0 - self.share(from.0, from.1)) + between + passed(to.0, self.share(to.0, to.1))
    }

    /// Returns the fields at a factor of a load step, by name.
    pub fn fields_at(&self, load_step: usize, factor: f64) -> Vec<(&str, f64)> {
        let share = self.share(load_step, factor);
        let fields = self.load_steps[load_step].period.fields.iter();
        fields.map(|field| (field.name.as_str(), field.from + share * (field.to - field.from))).collect()
    }

    /// Returns the wrench of a loading on each body about its pole, at undeformed positions \[N, N m\].
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

    /// Returns the displacement (x, y) of point `slot` of a body from the deformation that a loading causes, with small
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

    /// Returns the gap (n, t) that a loading opens at each contact point if motions of bodies and contact forces are
    /// zero: deformation and settlements, with small displacements \[m\].
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

    /// Returns the rows of G at a contact point for one side: (n, t) of the displacement of the point per (u_x, u_y, θ)
    /// of the body about its pole, with the sign of the side.
    pub fn kinematics(&self, contact: &Contact, plus: bool) -> [[f64; 3]; 2] {
        let (body, sign) = if plus { (contact.plus.body, 1.0) } else { (contact.minus.body, -1.0) };
        let arm = contact.position - self.bodies[body].pole;
        [contact.normal, contact.tangent].map(|e| [sign * e.x, sign * e.y, sign * cross(arm, e)])
    }

    /// Returns the contact forces and loads of a state on the points of every body \[N\]. With `finite` displacements
    /// the axes rotate with the body, and the frame of a contact has the mean rotation of its two bodies.
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

    /// Returns the number of state variables of all responses.
    pub fn memory_size(&self) -> usize {
        (0..self.contacts.len()).filter_map(|c| self.response(c)).map(|law| law.state_size()).sum()
    }

    /// Returns the initial states of all responses, contact point by contact point.
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
