//! `arc_length`: spherical arc length in motion and factor.
#![doc = include_str!("arc_length.md")]

use super::{FIRST_STEP, LARGEST_STEP, first_step};
use serde::{Deserialize, Serialize};
use voussoir_core::path::{Constraint, Continuation, Increment};
use voussoir_core::plugin::{Card, Parameter, PluginKind, Quantity, Range};

/// c = √(motion² + ψ² Δλ²).
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ArcLength {
    /// ψ.
    #[serde(default = "psi")]
    pub psi: f64,
    /// First step.
    #[serde(default = "first_step")]
    pub first_step: f64,
    /// Largest step.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub largest_step: Option<f64>,
}

fn psi() -> f64 {
    1.0
}

impl Default for ArcLength {
    fn default() -> Self {
        ArcLength { psi: psi(), first_step: first_step(), largest_step: None }
    }
}

/// The spherical constraint.
pub(super) fn sphere(increment: &Increment, psi: f64) -> Constraint {
    let value = increment.motion.hypot(psi * increment.factor);
    let over = |x: f64| if value > 0.0 { x / value } else { 0.0 };
    let derivative = Increment {
        factor: over(psi * psi * increment.factor),
        motion: over(increment.motion),
        ..Increment::default()
    };
    Constraint { value, derivative }
}

#[typetag::serde(name = "arc_length")]
impl Continuation for ArcLength {
    fn constraint(&self, increment: &Increment, _previous: Option<&Increment>) -> Constraint {
        sphere(increment, self.psi)
    }

    fn passes_limit_points(&self) -> bool {
        true
    }

    fn first_step(&self) -> f64 {
        self.first_step
    }

    fn largest_step(&self) -> f64 {
        self.largest_step.unwrap_or(f64::INFINITY)
    }
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::Continuation,
        tag: "arc_length",
        summary: "spherical arc length in motion and load factor; passes limit points and snap-back",
        parameters: &[
            Parameter::number("psi", Quantity::Ratio, Range::NON_NEGATIVE, "weight of the factor; 0 is cylindrical").default("1.0"),
            FIRST_STEP,
            LARGEST_STEP,
        ],
        sources: &["Riks 1979, Int. J. Solids Struct. 15, 529-551", "Crisfield 1981, Computers & Structures 13, 55-62"],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("arc_length.md"),
        ..Card::BLANK
    }
}
