//! The answer of a limit solver in space.

use super::status::{Counters, Status};
use crate::model::space::Wrench;

/// Velocity of a body as a rigid motion about the problem's pole: \[v_x, v_y, v_z, ω_x, ω_y, ω_z\].
pub type SpaceVelocity = [f64; 6];

/// Forces (n, s, t) at the points of each contact of the problem, in their order \[N\].
pub type SpaceField = Vec<Vec<[f64; 3]>>;

/// The answer of a limit solver for one stage of a scene in space. The certificate decides the status.
#[derive(Debug, Clone, Default)]
pub struct SpaceAnswer {
    /// The end of the stage, as a hint.
    pub status: Status,
    /// The collapse factor.
    pub factor: Option<f64>,
    /// The factor at which `field` is in equilibrium.
    pub field_factor: f64,
    /// Forces of an admissible field.
    pub field: Option<SpaceField>,
    /// Velocities of the free bodies about the problem's pole, scaled to varying·q̇ = 1; for `NoEquilibrium` their
    /// scale is arbitrary.
    pub motion: Option<Vec<SpaceVelocity>>,
    /// Forces of a ray, which balance the varying load alone.
    pub ray: Option<SpaceField>,
    /// True if forces strictly inside all cones are in balance without any load: blocks interlock, and every load is in
    /// equilibrium with some forces.
    pub self_stress: bool,
    /// True if the motion is the only one.
    pub unique: Option<bool>,
    /// Set if each contact has the flow of its law.
    pub non_associated: Option<SpaceNonAssociated>,
    /// Work done.
    pub counters: Counters,
    /// Notes for the user.
    pub notes: Vec<String>,
}

/// Additional results if each contact follows its law. Such collapse factors are not unique: `factor` of the answer is one at
/// which a mechanism with the laws' own flow and an admissible field exist together.
#[derive(Debug, Clone, Default)]
pub struct SpaceNonAssociated {
    /// An upper bound of all such factors: that of associated flow.
    pub associated_factor: Option<f64>,
    /// The motion with associated flow that proves it, scaled as `motion`.
    pub associated_motion: Option<Vec<SpaceVelocity>>,
    /// Lower bound of all such factors, by an exhaustive search that leaves no data to check. If a solver proves none, this is the
    /// factor at the start; a solver that proves no lower bounds gives `None`.
    pub searched: Option<f64>,
}

/// The answer of a limit solver about rigid blocks in space whose supports move, with associated flow.
#[derive(Debug, Clone)]
pub enum SpaceSettled {
    /// The blocks follow their supports.
    Follows {
        /// Forces of a field that does no work on the jumps beyond their dissipation.
        field: SpaceField,
        /// Displacement of each free body as a rigid motion about the problem's pole.
        motion: Vec<SpaceVelocity>,
    },
    /// No motion of the blocks is compatible with the motion of the supports. The proof is a set of forces in balance without
    /// loads, inside all cones, that do negative work on the openings of the supports.
    Blocked(SpaceField),
    /// The question is not decided, with the reason.
    Refused(String),
}

impl SpaceAnswer {
    /// Creates an answer that decides nothing, with the reason.
    pub fn stalled(why: impl Into<String>) -> Self {
        SpaceAnswer { notes: vec![why.into()], ..SpaceAnswer::default() }
    }
}

/// Returns the power of wrenches on a motion about the same pole \[W\].
pub fn power(wrenches: &[Wrench], motion: &[SpaceVelocity]) -> f64 {
    wrenches.iter().flatten().zip(motion.iter().flatten()).map(|(force, velocity)| force * velocity).sum()
}
