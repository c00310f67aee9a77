//! `dissipation`: control of the dissipated energy, arc length while elastic.
#![doc = include_str!("dissipation.md")]

use super::StepKeys;
use super::arc_length::sphere;
use voussoir_core::path::{Constraint, Continuation, Increment};
use voussoir_core::plugin::{Card, Keys, PluginKind};

/// c = ΔD where the last step dissipated enough, else the arc length.
#[derive(Debug, Clone, Keys)]
pub struct Dissipation {
    /// dissipation per motion of the last step, in units of load, from which dissipation is controlled
    #[key(unit = "-", range = "> 0", default = 0.01)]
    pub switch: f64,
    /// First step.
    #[key(like = StepKeys, default)]
    pub first_step: f64,
    /// Largest step.
    #[key(like = StepKeys)]
    pub largest_step: Option<f64>,
}

impl Default for Dissipation {
    fn default() -> Self {
        Self::defaults()
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

    step_lengths!();
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::Continuation,
        tag: "dissipation",
        summary: "equal amounts of dissipated energy; arc length while nothing dissipates",
        sources: &[
            "Gutierrez 2004, Commun. Numer. Meth. Engng 20, 19-29",
            "Verhoosel, Remmers & Gutierrez 2009, Int. J. Numer. Meth. Engng 77, 1290-1321",
        ],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("dissipation.md"),
        ..Card::of::<Dissipation>()
    }
}
