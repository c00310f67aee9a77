//! `displacement_control`: the displacement of the load is given at each step.
#![doc = include_str!("displacement_control.md")]

use super::{FIRST_STEP, LARGEST_STEP, first_step};
use serde::{Deserialize, Serialize};
use voussoir_core::path::{Constraint, Continuation, Increment};
use voussoir_core::plugin::{Card, PluginKind};

/// c = |Δu|, u the work-conjugate displacement of the load that grows.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DisplacementControl {
    /// First step.
    #[serde(default = "first_step")]
    pub first_step: f64,
    /// Largest step.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub largest_step: Option<f64>,
}

impl Default for DisplacementControl {
    fn default() -> Self {
        DisplacementControl { first_step: first_step(), largest_step: None }
    }
}

#[typetag::serde(name = "displacement_control")]
impl Continuation for DisplacementControl {
    fn constraint(&self, increment: &Increment, _previous: Option<&Increment>) -> Constraint {
        let sign = if increment.displacement < 0.0 { -1.0 } else { 1.0 };
        Constraint {
            value: increment.displacement.abs(),
            derivative: Increment { displacement: sign, ..Increment::default() },
        }
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
        tag: "displacement_control",
        summary: "steps of the load's own displacement; passes limit points, not snap-back",
        parameters: &[FIRST_STEP, LARGEST_STEP],
        sources: &["Batoz & Dhatt 1979, Int. J. Numer. Meth. Engng 14, 1262-1267"],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("displacement_control.md"),
        ..Card::BLANK
    }
}
