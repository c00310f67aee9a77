//! The interface of engines of limit analysis: the three single optimisations that answer every question.

use super::problem::{JointForce, Velocity};
use super::status::Counters;
use crate::model::Wrenches;

/// The result for a fixed load.
#[derive(Debug, Clone)]
pub enum Equilibrium {
    /// The load can be carried: an admissible field.
    Field(Vec<JointForce>),
    /// The load cannot be carried: a motion, in any scale, on which the load does more work than is dissipated.
    Motion(Vec<Velocity>),
    /// Not decided.
    Failed(String),
}

/// The greatest factor of a varying load.
#[derive(Debug, Clone)]
pub enum GreatestFactor {
    /// A finite factor; both bounds are equal.
    Collapse {
        /// The factor.
        factor: f64,
        /// Admissible field at that factor.
        field: Vec<JointForce>,
        /// Mechanism with varying·q̇ = 1, in the relative interior of all optimal mechanisms.
        motion: Vec<Velocity>,
        /// True if the mechanism is the only one; `None` if this is not known.
        unique: Option<bool>,
    },
    /// The cap was reached first: a field at the cap.
    Capped(Vec<JointForce>),
    /// No bound: a field in the recession cone that balances the varying load alone.
    Unbounded(Vec<JointForce>),
    /// Not decided.
    Failed(String),
}

/// The force of a joint at which a linear form of its N_0, N_1 and T is greatest over all admissible fields; or the whole
/// field.
#[derive(Debug, Clone, Copy)]
pub enum Extreme<Force = JointForce> {
    /// The form has a greatest value, and this force has it.
    Finite(Force),
    /// The form grows without bound along this force, in any scale. Among such forces with the same normal force it has
    /// the greatest form, or the next form finds a greater one.
    Ray(Force),
    /// Not decided.
    Failed,
}

impl Extreme<Vec<JointForce>> {
    /// Returns the force of one joint.
    pub fn at(self, joint: usize) -> Extreme {
        match self {
            Extreme::Finite(field) => Extreme::Finite(field[joint]),
            Extreme::Ray(field) => Extreme::Ray(field[joint]),
            Extreme::Failed => Extreme::Failed,
        }
    }
}

/// An engine that solves single optimisations over the joints of one problem. [`answer_by`](super::answer_by) answers
/// every question with it. A solver of linear programs needs no engine: see
/// [`answer_by_programs`](super::answer_by_programs).
pub trait Engine {
    /// Can these loads be carried?
    fn admissible(&mut self, loads: &Wrenches) -> Equilibrium;

    /// Can these loads be carried by any field? The field need not be far from its bounds.
    fn carried(&mut self, loads: &Wrenches) -> Equilibrium {
        self.admissible(loads)
    }

    /// Can `fixed + λ varying` be carried for some λ of either sign?
    fn possible(&mut self, fixed: &Wrenches, varying: &Wrenches) -> Equilibrium;

    /// The greatest λ ≤ `cap` (may be ∞) for which `fixed + λ varying` can be carried, if some λ can.
    fn greatest(&mut self, fixed: &Wrenches, varying: &Wrenches, cap: f64) -> GreatestFactor;

    /// Returns the greatest factor and a field of the fixed loads if they are carried. `None` if they are not, or if
    /// the engine does not support this.
    fn greatest_if_carried(&mut self, _: &Wrenches, _: &Wrenches, _: f64) -> Option<(Vec<JointForce>, GreatestFactor)> {
        None
    }

    /// Returns the greatest value of `form` over (N_0, N_1, T) of a joint, over all fields that carry these loads. At
    /// least one such field must exist. Only the zone of thrust needs it.
    fn extreme(&mut self, _: &Wrenches, _joint: usize, _form: [f64; 3]) -> Extreme {
        Extreme::Failed
    }

    /// Work done so far.
    fn counters(&self) -> Counters {
        Counters::new()
    }
}
