//! Thickness of a ring: constant, or growing from the crown to the springings.

use super::lookup::outside;
use voussoir_core::plugin::{Diagnostic, Keys, Range};

const THICKNESS: Range = Range::POSITIVE;

/// Thickness of a ring, along its joints.
#[derive(Debug, Clone, Copy, PartialEq, Keys)]
#[keys(untagged)]
pub enum Thickness {
    /// Constant thickness \[m\].
    #[key(unit = "m", range = THICKNESS)]
    Even(f64),
    /// Linear in the arc length of the intrados.
    Tapered(Taper),
}

/// A thickness at the crown and one at the springings.
#[derive(Debug, Clone, Copy, PartialEq, Keys)]
pub struct Taper {
    /// thickness at the crown, the middle of the intrados
    #[key(unit = "m", range = THICKNESS)]
    pub crown: f64,
    /// thickness at both springings
    #[key(unit = "m", range = THICKNESS)]
    pub springing: f64,
}

impl Thickness {
    /// Returns the thickness at a share of the length along the intrados from the middle (0) to a springing (1) \[m\].
    pub fn at(&self, share: f64) -> f64 {
        match *self {
            Thickness::Even(thickness) => thickness,
            Thickness::Tapered(Taper { crown, springing }) => crown + (springing - crown) * share,
        }
    }

    /// Returns the thickness if it is constant \[m\].
    pub fn even(&self) -> Option<f64> {
        match *self {
            Thickness::Even(thickness) => Some(thickness),
            Thickness::Tapered(_) => None,
        }
    }

    /// Returns the mistakes in its numbers, with paths from the scene's or the span's table.
    pub fn mistakes(&self) -> Vec<Diagnostic> {
        let numbers = match *self {
            Thickness::Even(thickness) => vec![("thickness", thickness)],
            Thickness::Tapered(Taper { crown, springing }) => {
                vec![("thickness.crown", crown), ("thickness.springing", springing)]
            }
        };
        numbers.into_iter().filter_map(|(key, number)| outside(THICKNESS, key, number)).collect()
    }
}

impl From<f64> for Thickness {
    fn from(thickness: f64) -> Self {
        Thickness::Even(thickness)
    }
}
