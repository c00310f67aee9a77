//! How the next point of a path is chosen.

use std::any::Any;
use std::fmt::{self, Debug};

/// Monitors that a strategy may have.
pub const MOST_MONITORS: usize = 4;

/// A quantity by name that a strategy sees besides the size of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Monitor {
    /// Opening of a joint, its mean or at a share (0 to 1) of its length from its first end.
    Opening {
        /// Index of the joint.
        joint: usize,
        /// Share of its length.
        at: Option<f64>,
    },
    /// Displacement of a point by the rigid motion of its block, along a unit vector.
    Displacement {
        /// Index of the block.
        block: usize,
        /// Where it is, undeformed \[m\].
        point: [f64; 2],
        /// Unit vector.
        direction: [f64; 2],
    },
}

impl fmt::Display for Monitor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Monitor::Opening { joint, at: None } => write!(f, "mean opening of joint {joint}"),
            Monitor::Opening { joint, at: Some(at) } => write!(f, "opening of joint {joint} at {at} of its length"),
            Monitor::Displacement { block, point: [x, y], .. } => {
                write!(f, "displacement of block {block} at [{x}, {y}]")
            }
        }
    }
}

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
    /// Increments of the strategy's monitors, in the unit of displacement.
    pub monitored: [f64; MOST_MONITORS],
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
pub trait Continuation: Any + Debug + Send + Sync {
    /// What it watches besides the size of the step: at most [`MOST_MONITORS`], in the order of
    /// [`Increment::monitored`]. A solver refuses what the problem does not have, by its name.
    fn monitors(&self) -> Vec<Monitor> {
        Vec::new()
    }

    /// The constraint of a step. `previous` is the increment of the last converged step of this
    /// load step, `None` before the first: a strategy may change what it measures between two steps,
    /// never within one.
    fn constraint(&self, increment: &Increment, previous: Option<&Increment>) -> Constraint;

    /// Whether λ may fall during a step.
    fn passes_limit_points(&self) -> bool;

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
