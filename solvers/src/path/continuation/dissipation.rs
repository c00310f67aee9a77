//! `dissipation`: control of the dissipated energy, arc length while elastic.
#![doc = include_str!("dissipation.md")]

use super::arc_length::sphere;
use super::{FIRST_STEP, LARGEST_STEP, first_step};
use serde::{Deserialize, Serialize};
use voussoir_core::path::{Constraint, Continuation, Increment};
use voussoir_core::plugin::{Card, Parameter, PluginKind, Quantity, Range};

/// c = ΔD where the last step dissipated enough, else the arc length.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Dissipation {
    /// Dissipation per motion of the last step from which dissipation is controlled.
    #[serde(default = "switch")]
    pub switch: f64,
    /// First step.
    #[serde(default = "first_step")]
    pub first_step: f64,
    /// Largest step.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub largest_step: Option<f64>,
}

fn switch() -> f64 {
    0.01
}

impl Default for Dissipation {
    fn default() -> Self {
        Dissipation { switch: switch(), first_step: first_step(), largest_step: None }
    }
}

#[typetag::serde(name = "dissipation")]
impl Continuation for Dissipation {
    fn constraint(&self, increment: &Increment, previous: Option<&Increment>) -> Constraint {
        match previous {
            Some(last) if last.dissipation > self.switch * last.motion => Constraint {
                value: increment.dissipation,
                derivative: Increment { dissipation: 1.0, ..Increment::default() },
            },
            _ => sphere(increment, 1.0),
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
        tag: "dissipation",
        summary: "equal amounts of dissipated energy; arc length while nothing dissipates",
        parameters: &[
            Parameter::number(
                "switch",
                Quantity::Ratio,
                Range::POSITIVE,
                "dissipation per motion of the last step, in units of load, from which dissipation is controlled",
            )
            .default("0.01"),
            FIRST_STEP,
            LARGEST_STEP,
        ],
        sources: &[
            "Gutierrez 2004, Commun. Numer. Meth. Engng 20, 19-29",
            "Verhoosel, Remmers & Gutierrez 2009, Int. J. Numer. Meth. Engng 77, 1290-1321",
        ],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("dissipation.md"),
        ..Card::BLANK
    }
}
