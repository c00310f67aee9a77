//! Blocks in space: polyhedra, plane contact faces, the problem of limit analysis and its certificate.
//!
//! # Conventions
//! SI units, z upwards. A body has six velocities \[v_x, v_y, v_z, ω_x, ω_y, ω_z\]. At a contact the frame (n, s, t) is
//! right-handed; n points from the *minus* to the *plus* body. A contact force acts as +r on plus and as −r on minus;
//! positive r_n is compressive. The gap rate is v_plus − v_minus; a positive normal component opens the contact.
//!
//! # Forces at the vertices
//! A contact is the convex hull of a plane polygon, and its unknowns are a force (n, s, t) at each vertex. For friction
//! |(s, t)| ≤ μ n without cohesion, tension or crushing this is exact: barycentric weights of a fan of triangles move
//! every admissible pressure and friction to the vertices without a change of their resultants.

mod answer;
mod assembly;
mod certificate;
mod clip;
mod contacts;
mod hull;
mod limit;
mod loads;
mod patch;
mod plane;
mod polyhedron;
mod predicate;

pub use self::answer::{SpaceAnswer, SpaceField, SpaceVelocity, power};
pub use self::assembly::{Contact, SpaceAssembly, SpaceBody};
pub use self::certificate::{SpaceClaim, SpaceVerdict, certify_space};
pub use self::contacts::{ContactBody, ContactTolerances, FoundContacts, NearMiss, find_contacts, near_misses};
pub use self::hull::hull;
pub use self::limit::{Cone, SpaceContact, SpaceProblem, Wrench};
pub use self::loads::{SpaceForce, SpaceLoads, SpaceStage, add_space_force, space_loads};
pub use self::plane::tangents;
pub use self::polyhedron::Polyhedron;

/// Point or vector \[m\].
pub type Vec3 = nalgebra::Vector3<f64>;
