//! What engines of limit analysis answer: the three single optimisations behind every question.

use voussoir_core::limit::{Counters, JointForce, Velocity};
use voussoir_core::model::Wrenches;

/// Whether a fixed load can be carried.
#[derive(Debug, Clone)]
pub enum Equilibrium {
    /// Yes: an admissible field.
    Field(Vec<JointForce>),
    /// No: a motion on which the load does more work than is dissipated, in any scale.
    Motion(Vec<Velocity>),
    /// Not decided.
    Failed(String),
}

/// The greatest factor of a varying load.
#[derive(Debug, Clone)]
pub enum Greatest {
    /// Finite: both bounds meet.
    Collapse {
        /// The factor.
        factor: f64,
        /// Admissible field at that factor.
        field: Vec<JointForce>,
        /// Mechanism with varying·q̇ = 1, in the relative interior of the optimal ones.
        motion: Vec<Velocity>,
        /// Whether it is the only one.
        unique: bool,
    },
    /// The cap was reached first: a field there.
    Capped(Vec<JointForce>),
    /// No bound: a field in the recession cone that balances the varying load alone.
    Unbounded(Vec<JointForce>),
    /// Not decided.
    Failed(String),
}

/// The force of a joint at which a linear form of its N_0, N_1 and T is greatest over all admissible fields.
#[derive(Debug, Clone, Copy)]
pub enum Extreme {
    /// The form has a greatest value, and this force has it.
    Finite(JointForce),
    /// The form grows without bound along this force, in any scale; of all such forces with the same normal force it has the
    /// greatest form, or a greater one follows at the next form.
    Ray(JointForce),
    /// Not decided.
    Failed,
}

/// Something that answers single optimisations over one problem's joints.
pub trait Engine {
    /// Can these loads be carried?
    fn admissible(&mut self, loads: &Wrenches) -> Equilibrium;

    /// The same where any field will do.
    fn carried(&mut self, loads: &Wrenches) -> Equilibrium {
        self.admissible(loads)
    }

    /// Can `fixed + λ varying` be carried for some λ of either sign?
    fn possible(&mut self, fixed: &Wrenches, varying: &Wrenches) -> Equilibrium;

    /// The greatest λ ≤ `cap` (may be ∞) for which `fixed + λ varying` can be carried, given that
    /// some λ can.
    fn greatest(&mut self, fixed: &Wrenches, varying: &Wrenches, cap: f64) -> Greatest;

    /// The same for fixed loads that may not be carried: the answer if they are, with a field that carries them.
    fn greatest_if_carried(&mut self, _: &Wrenches, _: &Wrenches, _: f64) -> Option<(Vec<JointForce>, Greatest)> {
        None
    }

    /// The greatest value of `form` over (N_0, N_1, T) of a joint, over all fields that carry these loads, which some field does.
    fn extreme(&mut self, loads: &Wrenches, joint: usize, form: [f64; 3]) -> Extreme;

    /// Work done so far.
    fn counters(&self) -> Counters;
}
