//! `crack_opening`: control of the opening of one joint, arc length while it does not open.
#![doc = include_str!("crack_opening.md")]

use super::arc_length::sphere;
use super::{FIRST_STEP, LARGEST_STEP, first_step};
use serde::{Deserialize, Serialize};
use voussoir_core::path::{Constraint, Continuation, Increment, MOST_MONITORS, Monitor};
use voussoir_core::plugin::{Card, Need, Parameter, PluginKind, Quantity, Range, Shape};

/// c = Δg_n of the joint where it opened enough in the last step, else the arc length.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CrackOpening {
    /// Index of the joint.
    pub joint: usize,
    /// Share of its length from its first end; its mean opening otherwise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<f64>,
    /// Opening per motion of the last step from which the opening is controlled.
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
    0.1
}

impl CrackOpening {
    /// Of a joint, with all else by default.
    pub fn of(joint: usize) -> Self {
        CrackOpening { joint, at: None, switch: switch(), first_step: first_step(), largest_step: None }
    }
}

#[typetag::serde(name = "crack_opening")]
impl Continuation for CrackOpening {
    fn monitors(&self) -> Vec<Monitor> {
        vec![Monitor::Opening { joint: self.joint, at: self.at }]
    }

    fn constraint(&self, increment: &Increment, previous: Option<&Increment>) -> Constraint {
        match previous {
            Some(last) if last.monitored[0] > self.switch * last.motion => {
                let mut monitored = [0.0; MOST_MONITORS];
                monitored[0] = 1.0;
                let derivative = Increment { monitored, ..Increment::default() };
                Constraint { value: increment.monitored[0], derivative }
            }
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
        tag: "crack_opening",
        summary: "steps of the opening of one joint; passes limit points and snap-back while that joint opens",
        parameters: &[
            Parameter {
                name: "joint",
                doc: "index of the joint, as in results",
                shape: Shape::Integer { min: 0, max: 1_000_000 },
                need: Need::Required,
            },
            Parameter::number("at", Quantity::Ratio, Range::new(0.0, false, 1.0, false), "where, as a share of the joint's length from its first end")
                .optional("its mean opening"),
            Parameter::number(
                "switch",
                Quantity::Ratio,
                Range::POSITIVE,
                "opening per motion of the last step from which the opening is controlled",
            )
            .default("0.1"),
            FIRST_STEP,
            LARGEST_STEP,
        ],
        sources: &["de Borst 1987, Computers & Structures 25, 211-224", "Rots & de Borst 1987, J. Engng Mech. 113, 1739-1758"],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("crack_opening.md"),
        ..Card::BLANK
    }
}
