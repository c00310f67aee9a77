//! `load_control`: the factor is given at each step.
#![doc = include_str!("load_control.md")]

use super::StepKeys;
use voussoir_core::path::{Constraint, Continuation, Increment};
use voussoir_core::plugin::{Card, Keys, PluginKind};

/// c = |Δλ|.
#[derive(Debug, Clone, Keys)]
pub struct LoadControl {
    /// First step.
    #[key(like = StepKeys, default)]
    pub first_step: f64,
    /// Largest step.
    #[key(like = StepKeys)]
    pub largest_step: Option<f64>,
}

impl Default for LoadControl {
    fn default() -> Self {
        Self::defaults()
    }
}

#[typetag::serde(name = "load_control")]
impl Continuation for LoadControl {
    fn constraint(&self, increment: &Increment, _previous: Option<&Increment>) -> Constraint {
        let sign = if increment.factor < 0.0 { -1.0 } else { 1.0 };
        Constraint { value: increment.factor.abs(), derivative: Increment { factor: sign, ..Increment::default() } }
    }

    fn passes_limit_points(&self) -> bool {
        false
    }

    step_lengths!();
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::Continuation,
        tag: "load_control",
        summary: "steps of the load factor; stops at the first limit point",
        sources: &["Crisfield 1991, Non-linear Finite Element Analysis of Solids and Structures 1, section 1.2"],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("load_control.md"),
        ..Card::of::<LoadControl>()
    }
}
