//! Blocks in space: polyhedra, their contacts, and loads.

mod assembly;
mod clip;
mod contacts;
mod hull;
mod intersect;
mod loads;
mod patch;
mod plane;
mod polyhedron;
mod predicate;
mod vector;

pub use self::assembly::{Contact, SpaceAssembly, SpaceBody, SpaceFill};
pub use self::contacts::{ContactBody, ContactTolerances, FoundContacts, NearMiss, find_contacts, near_misses};
pub use self::hull::hull;
pub use self::intersect::{FoundOverlaps, SpaceOverlap, find_overlaps};
pub use self::loads::{SpaceForce, SpaceLoads, SpaceSettlement, SpaceStage, add_space_force, space_loads};
pub use self::plane::tangents;
pub use self::polyhedron::Polyhedron;
pub use self::vector::{Vec3, Wrench, velocity_at};
