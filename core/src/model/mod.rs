//! The model: bodies, joints, loads and stages. It is independent of solvers.

mod assembly;
mod bridge;
mod contact;
pub mod geometry;
mod joints;
mod loads;
mod mesh_density;
mod scene;
mod self_crossing;
pub mod space;
mod wrench;

pub use self::assembly::{ArchLayout, Assembly, Body, Catalogue, Inertia, root};
pub use self::bridge::{Bridge, Chord, FillMass, FillPart, FillReaction, carried};
pub use self::contact::{CONTACT_TOLERANCE, Interpenetration, find_joints};
pub use self::joints::{Bond, Gap, Joint};
pub use self::loads::{
    LoadSpread, PointForce, Settlement, Stage, StageLoads, Target, fill_bounds, fill_weights, stage_loads,
};
pub use self::mesh_density::MeshDensity;
pub use self::scene::Scene;
pub use self::self_crossing::crosses_itself;
pub use self::wrench::{Wrenches, add_force};
