//! Drawings of scenes and mechanisms, charts of sweeps, and how numbers are written in them.
//!
//! Everything here is a pure function from results to text (SVG). No file is touched.

pub mod comparison;
pub mod curve;
pub mod displaced;
pub mod drawing;
pub mod envelope;
mod fill;
pub mod hinge_closure;
pub mod hinges;
pub mod loads;
pub mod map;
pub mod mechanism;
pub mod moving_load;
mod of_case;
pub mod scene_canvas;
pub mod seismic;
mod space;
pub mod sweep;
pub mod symbols;
pub mod thrust;

#[cfg(test)]
pub(crate) mod sample;

pub use curve::{curve_charts, curve_svg};
pub use drawing::scene_svg;
pub use mechanism::mechanism_svg;
pub(crate) use mechanism::moving_blocks;
pub use of_case::{mechanism_of_case, scene_of_case};
pub(crate) use space::{MOVED, Moves};
pub use space::{space_mechanism_svg, space_svg};
pub use sweep::{sweep_axis, sweep_chart};
