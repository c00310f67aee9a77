//! Plots as SVG: a canvas, axes, line charts and contours. Nothing here knows of masonry.
#![forbid(unsafe_code)]

pub mod axis;
pub mod chart;
pub mod colours;
pub mod contour;
pub mod number;
pub mod panels;
pub mod series;
pub mod svg;
pub mod text;
