//! `displacement_control`: the displacement of the load is given at each step.
#![doc = include_str!("displacement_control.md")]

use super::StepKeys;
use voussoir_core::path::{Constraint, Continuation, Increment};
use voussoir_core::plugin::{Card, Keys, PluginKind};

/// c = |Δu|, u the work-conjugate displacement of the load that grows.
#[derive(Debug, Clone, Keys)]
pub struct DisplacementControl {
    /// First step.
    #[key(like = StepKeys, default)]
    pub first_step: f64,
    /// Largest step.
    #[key(like = StepKeys)]
    pub largest_step: Option<f64>,
}

impl Default for DisplacementControl {
    fn default() -> Self {
        Self::defaults()
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

    step_lengths!();
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::Continuation,
        tag: "displacement_control",
        summary: "steps of the load's own displacement; passes limit points, not snap-back",
        sources: &["Batoz & Dhatt 1979, Int. J. Numer. Meth. Engng 14, 1262-1267"],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("displacement_control.md"),
        ..Card::of::<DisplacementControl>()
    }
}
