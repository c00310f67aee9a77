//! Continuation strategies: the choice of the next point of a path.

use crate::plugin::{KeyValue, PluginKind, Shape};
use std::any::Any;
use std::fmt::{self, Debug};

/// Greatest number of monitors of a strategy.
pub const MOST_MONITORS: usize = 4;

/// A quantity that a strategy uses besides the size of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Monitor {
    /// Opening of a joint: its mean, or at a share (0 to 1) of its length from its first end.
    Opening {
        /// Index of the joint.
        joint: usize,
        /// Share of the length of the joint.
        at: Option<f64>,
    },
    /// Displacement of a point by the rigid motion of its block, along a unit vector.
    Displacement {
        /// Index of the block.
        block: usize,
        /// Position in the undeformed structure \[m\].
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

/// The increment of a step in the units of continuation strategies, which do not depend on the unit system. All entries
/// are zero at the last converged state. Units: force F, the size of the loads; displacement U = F × mean compliance;
/// factor Λ, at which the growing load has the size F; energy F U.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Increment {
    /// Δλ in the unit Λ.
    pub factor: f64,
    /// Increment of the work-conjugate displacement of the load, in the unit of displacement.
    pub displacement: f64,
    /// Root mean square of the increments of all rigid motions and gaps, in the unit of displacement. Gaps are included
    /// for bodies that are held but deform.
    pub motion: f64,
    /// Increment of dissipated energy, in the unit of energy.
    pub dissipation: f64,
    /// Increments of the strategy's monitors, in the unit of displacement.
    pub monitored: [f64; MOST_MONITORS],
}

/// Value and derivatives of a constraint c(increment) = length.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Constraint {
    /// Value c.
    pub value: f64,
    /// Derivatives of c with respect to each entry of the increment.
    pub derivative: Increment,
}

/// A strategy that chooses the next point of a path, set by `[solver] continuation = { strategy = … }`. It has no
/// state: the solver stores and adapts the length of the step.
#[typetag::serde(tag = "strategy")]
pub trait Continuation: Any + Debug + Send + Sync {
    /// Returns the quantities that it uses besides the size of the step: at most [`MOST_MONITORS`], in the order of
    /// [`Increment::monitored`]. A solver refuses quantities that the problem does not have, with their name.
    fn monitors(&self) -> Vec<Monitor> {
        Vec::new()
    }

    /// Returns the constraint of a step. `previous` is the increment of the last converged step of this load step,
    /// `None` before the first. A strategy may change its measure between two steps but not within one.
    fn constraint(&self, increment: &Increment, previous: Option<&Increment>) -> Constraint;

    /// Returns true if λ may fall during a step. A strategy that sets λ itself returns false.
    fn passes_limit_points(&self) -> bool {
        true
    }

    /// Returns the length of the first step of a load step: the share of the unit load (of size F) that an elastic
    /// structure would carry in it.
    fn first_step(&self) -> f64 {
        0.1
    }

    /// Returns the greatest increment of a step in its `motion`, as a share of the length of the scene. It is infinite
    /// if only the solver bounds it.
    fn largest_step(&self) -> f64 {
        f64::INFINITY
    }
}

impl KeyValue for Box<dyn Continuation> {
    const SHAPE: Shape = Shape::Plugin(PluginKind::Continuation);
}
