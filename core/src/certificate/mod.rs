//! Certificates: proofs of the answers of solvers. They share no code with solvers.

mod limit;
mod magnitude;
mod mechanism;
mod moving_contact;
mod path;
mod products;
mod residuals;
mod rounding;
mod settlement;
mod space;
mod space_mechanism;
mod space_settlement;

pub use self::limit::{Claim, ContactForce, NonAssociatedClaim, ROUNDING, Verdict, certify, largest_jump, motion_size};
pub use self::magnitude::{GREATEST_NUMBER, in_range};
pub use self::mechanism::{
    CRUSHES, CentroidVelocity, Crushing, Deforming, Hinge, Jump, Mechanism, MechanismKind, MechanismPlace, Side,
    Sliding, jumps, mechanism, mechanism_of_deforming, velocity_at,
};
pub use self::moving_contact::{ClosedPart, ContactMode, MovingContact};
pub use self::path::{
    Displaced, PathChain, PathChecker, TOLERANCES, Tolerance, flow_residual, forces_rest, leaves_forces,
    path_structure, power_residual, ray_residual, tolerance,
};
pub use self::products::{COVERED, proved};
pub use self::residuals::Certificate;
pub use self::settlement::{settlement_residuals, support_motions};
pub use self::space::{SpaceClaim, SpaceVerdict, certify_space};
pub use self::space_mechanism::space_mechanism;
pub use self::space_settlement::{
    space_openings, space_settlement_ray, space_settlement_residuals, space_support_motions,
};
