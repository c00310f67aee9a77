//! How the next point of a path is chosen.

use std::fmt::Debug;

/// The increment of a step as a continuation strategy sees it: all zero at the last converged state.
/// Units: force F, the size of the loads; displacement U = F × mean compliance; factor Λ, with which
/// the load that grows has the size F; energy F U. So nothing here depends on the unit system.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Increment {
    /// Δλ in its unit Λ.
    pub factor: f64,
    /// Increment of the work-conjugate displacement of the load, in the unit of displacement.
    pub displacement: f64,
    /// Root mean square of the increments of all rigid motions and gaps, in the unit of displacement
    /// (gaps, so that a body that the ground holds but that deforms counts too).
    pub motion: f64,
    /// Increment of dissipated energy, in the unit of energy.
    pub dissipation: f64,
}

/// Value and derivatives of a constraint c(increment) = length.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Constraint {
    /// c.
    pub value: f64,
    /// ∂c by each entry of the increment.
    pub derivative: Increment,
}

/// How the next point of a path is chosen, by `[solver] continuation = { strategy = … }`. Pure: the
/// solver keeps the length of the step and lets it grow and shrink.
#[typetag::serde(tag = "strategy")]
pub trait Continuation: Debug + Send + Sync {
    /// The constraint of a step. `previous` is the increment of the last converged step of this
    /// load step, `None` before the first: a strategy may change what it measures between two steps,
    /// never within one.
    fn constraint(&self, increment: &Increment, previous: Option<&Increment>) -> Constraint;

    /// Whether λ may fall during a step.
    fn passes_limit_points(&self) -> bool;

    /// Whether it steps at all, or goes exactly from event to event.
    fn exact_events(&self) -> bool {
        false
    }

    /// Length of a load step's first step: the share of the unit load (of size F) that an elastic
    /// structure would take up during it.
    fn first_step(&self) -> f64 {
        0.1
    }

    /// Greatest increment of a step in its `motion`, as a share of the scene's length; infinite
    /// where only the solver bounds it.
    fn largest_step(&self) -> f64 {
        f64::INFINITY
    }
}
