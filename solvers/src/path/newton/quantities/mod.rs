//! Quantities of states and rates: tractions, plastic work, sizes, monitors, records.

pub mod ahead;
pub mod control_row;
pub mod events;
pub mod inelastic;
pub mod measure;
pub mod monitors;
pub mod recorded;
pub mod response;
