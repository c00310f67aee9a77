//! `[vehicles.NAME]`: axles that move together.

use voussoir_core::plugin::Keys;

/// An axle.
#[derive(Debug, Clone, Copy, PartialEq, Keys)]
pub struct Axle {
    /// distance of the axle from the vehicle's origin
    #[key(unit = "m")]
    pub at: f64,
    /// force of the axle, downwards
    #[key(unit = "N")]
    pub force: f64,
    /// width of the loaded area, across the road
    #[key(unit = "m", range = "> 0", optional = "the whole width")]
    pub wheel_width: Option<f64>,
    /// length of the loaded area, along the road
    #[key(unit = "m", range = ">= 0", default = 0.0)]
    pub length: f64,
    /// factor of the axle's force
    #[key(unit = "-", range = ">= 0", default = 1.0)]
    pub lift_off: f64,
}

/// A vehicle.
#[derive(Debug, Clone, PartialEq, Keys)]
pub struct VehicleAxles {
    /// its axles, which move together
    #[key(len = ">= 1, <= 1000")]
    pub axles: Vec<Axle>,
}
