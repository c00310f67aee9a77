//! Thickness of a ring: the same all along, or growing from the crown to the springings.

use super::lookup::out_of_range;
use serde::{Deserialize, Serialize};
use voussoir_core::plugin::{Diagnostic, Parameter, Quantity, Range, Shape};

/// Of a ring, along its joints.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Thickness {
    /// The same all along \[m\].
    Even(f64),
    /// Linear in the arc length of the intrados.
    Tapered(Taper),
}

/// A thickness at the crown and one at the springings.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Taper {
    /// \[m\].
    pub crown: f64,
    /// \[m\].
    pub springing: f64,
}

const NUMBER: Shape = Shape::Number(Quantity::Length, Range::POSITIVE);
const TAPER: Shape = Shape::Table(&[
    Parameter::number("crown", Quantity::Length, Range::POSITIVE, "thickness at the crown, the middle of the intrados"),
    Parameter::number("springing", Quantity::Length, Range::POSITIVE, "thickness at both springings"),
]);
/// What `thickness` may hold.
pub const THICKNESS: Shape = Shape::Either(&[NUMBER, TAPER]);

impl Thickness {
    /// At a share of the way along the intrados from the middle (0) to a springing (1) \[m\].
    pub fn at(&self, share: f64) -> f64 {
        match *self {
            Thickness::Even(thickness) => thickness,
            Thickness::Tapered(Taper { crown, springing }) => crown + (springing - crown) * share,
        }
    }

    /// The one number, where it is the same all along \[m\].
    pub fn even(&self) -> Option<f64> {
        match *self {
            Thickness::Even(thickness) => Some(thickness),
            Thickness::Tapered(_) => None,
        }
    }

    /// What is wrong with its numbers, with paths from the scene's or the span's table.
    pub fn mistakes(&self) -> Vec<Diagnostic> {
        let numbers = match *self {
            Thickness::Even(thickness) => vec![("thickness", thickness)],
            Thickness::Tapered(Taper { crown, springing }) => {
                vec![("thickness.crown", crown), ("thickness.springing", springing)]
            }
        };
        numbers.into_iter().filter_map(|(key, number)| out_of_range(key, number, Range::POSITIVE)).collect()
    }
}

impl From<f64> for Thickness {
    fn from(thickness: f64) -> Self {
        Thickness::Even(thickness)
    }
}
