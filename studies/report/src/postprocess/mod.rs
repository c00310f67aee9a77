//! Data derived from results: the order in which joints changed, and displaced meshes with stresses.

pub mod displaced_mesh;
pub mod joint_events;
