//! `arc_length`: spherical arc length in motion and factor.
#![doc = include_str!("arc_length.md")]

use super::StepKeys;
use voussoir_core::path::{Constraint, Continuation, Increment};
use voussoir_core::plugin::{Card, Keys, PluginKind};

/// c = √(motion² + ψ² Δλ²).
#[derive(Debug, Clone, Keys)]
pub struct ArcLength {
    /// weight of the factor; 0 is cylindrical
    #[key(unit = "-", range = ">= 0", default = 1.0)]
    pub psi: f64,
    /// First step.
    #[key(like = StepKeys, default)]
    pub first_step: f64,
    /// Largest step.
    #[key(like = StepKeys)]
    pub largest_step: Option<f64>,
}

impl Default for ArcLength {
    fn default() -> Self {
        Self::defaults()
    }
}

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

    step_lengths!();
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::Continuation,
        tag: "arc_length",
        summary: "spherical arc length in motion and load factor; passes limit points and snap-back",
        sources: &["Riks 1979, Int. J. Solids Struct. 15, 529-551", "Crisfield 1981, Computers & Structures 13, 55-62"],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("arc_length.md"),
        ..Card::of::<ArcLength>()
    }
}
