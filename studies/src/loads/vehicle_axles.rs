//! `[vehicles.NAME]`: axles that move together.

use serde::{Deserialize, Serialize};
use voussoir_core::plugin::{Need, Parameter, Quantity, Range, Shape};

/// An axle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Axle {
    /// Distance from the vehicle's origin, which is its first axle where that stands at 0 \[m\].
    pub at: f64,
    /// Downwards \[N\].
    pub force: f64,
    /// Of the loaded area, across the road \[m\].
    pub wheel_width: Option<f64>,
    /// Of the loaded area, along the road \[m\].
    #[serde(default)]
    pub length: f64,
    /// Share of the force that stays on the road where wheels lift off, or that a rule adds.
    #[serde(default = "one")]
    pub lift_off: f64,
}

fn one() -> f64 {
    1.0
}

/// A vehicle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VehicleAxles {
    /// In any order.
    pub axles: Vec<Axle>,
}

const AXLE: &[Parameter] = &[
    Parameter::number("at", Quantity::Length, Range::ANY, "distance of the axle from the vehicle's origin"),
    Parameter::number("force", Quantity::Force, Range::ANY, "force of the axle, downwards"),
    Parameter::number("wheel_width", Quantity::Length, Range::POSITIVE, "width of the loaded area, across the road")
        .optional("the whole width"),
    Parameter::number("length", Quantity::Length, Range::NON_NEGATIVE, "length of the loaded area, along the road")
        .default("0.0"),
    Parameter::number("lift_off", Quantity::Ratio, Range::NON_NEGATIVE, "factor of the axle's force").default("1.0"),
];

/// What an entry of `[vehicles]` may hold.
pub static VEHICLE: Shape = Shape::Table(&[Parameter {
    name: "axles",
    doc: "its axles, which move together",
    shape: Shape::List { of: &Shape::Table(AXLE), min: 1, max: 1000 },
    need: Need::Required,
}]);
