//! Scenes in space: each converts its geometry into polyhedra with plane contacts. One file each; file = tag.

pub mod assembly;
pub mod barrel_vault;
mod block;
pub mod blocks_3d;
pub mod cross_vault;
pub mod dome;
pub mod fill;
pub(crate) mod import;
pub mod masonry_wall;
pub mod near;
mod obj;
mod parts;
mod shell_block;
mod stored_assembly;

pub use self::block::{Block3d, Search};
