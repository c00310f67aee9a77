//! `load_control`: the factor is given at each step.
#![doc = include_str!("load_control.md")]

use super::{FIRST_STEP, LARGEST_STEP, first_step};
use serde::{Deserialize, Serialize};
use voussoir_core::path::{Constraint, Continuation, Increment};
use voussoir_core::plugin::{Card, PluginKind};

/// c = |Δλ|.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LoadControl {
    /// First step.
    #[serde(default = "first_step")]
    pub first_step: f64,
    /// Largest step.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub largest_step: Option<f64>,
}

impl Default for LoadControl {
    fn default() -> Self {
        LoadControl { first_step: first_step(), largest_step: None }
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
        tag: "load_control",
        summary: "steps of the load factor; stops at the first limit point and says so",
        parameters: &[FIRST_STEP, LARGEST_STEP],
        sources: &["Crisfield 1991, Non-linear Finite Element Analysis of Solids and Structures 1, section 1.2"],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("load_control.md"),
        ..Card::BLANK
    }
}
