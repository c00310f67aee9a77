//! Blocks in space: polyhedra, plane contact faces, the problem of limit analysis and its certificate.
//!
//! # Conventions
//! SI units, z upwards. A body has six velocities \[v_x, v_y, v_z, ω_x, ω_y, ω_z\]. At a contact the frame (n, s, t) is
//! right-handed; n points from the *minus* to the *plus* body. A contact force acts as +r on plus and as −r on minus;
//! positive r_n is compressive. The gap rate is v_plus − v_minus; a positive normal component opens the contact.
//!
//! # Forces at points
//! A contact is the convex hull of a plane polygon, and its unknowns are forces (n, s, t) at points. For friction
//! |(s, t)| ≤ c + μ n whose tip c/μ is the tensile strength, the vertices are exact. For other strengths inner points bound the
//! load factor from below, and outer points from above (see [`PointSet`]).

pub use crate::certificate::{
    SpaceClaim, SpaceVerdict, certify_space, space_openings, space_settlement_ray, space_settlement_residuals,
    space_support_motions,
};
pub use crate::limit::{
    PointSet, SpaceAnswer, SpaceContact, SpaceField, SpaceNonAssociated, SpaceProblem, SpaceSettled, SpaceVelocity,
    power,
};
pub use crate::model::space::{
    Contact, ContactBody, ContactTolerances, FoundContacts, FoundOverlaps, NearMiss, Polyhedron, SpaceAssembly,
    SpaceBody, SpaceFill, SpaceForce, SpaceLoads, SpaceOverlap, SpaceSettlement, SpaceStage, Vec3, Wrench,
    add_space_force, find_contacts, find_overlaps, hull, near_misses, space_loads, tangents, velocity_at,
};
