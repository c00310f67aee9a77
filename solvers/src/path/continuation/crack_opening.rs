//! `crack_opening`: control of the opening of one joint, arc length while it does not open.
#![doc = include_str!("crack_opening.md")]

use super::StepKeys;
use super::arc_length::sphere;
use voussoir_core::path::{Constraint, Continuation, Increment, MOST_MONITORS, Monitor};
use voussoir_core::plugin::{Card, Keys, PluginKind, Sample};

/// c = Δg_n of the joint where it opened enough in the last step, else the arc length.
#[derive(Debug, Clone, Keys)]
pub struct CrackOpening {
    /// index of the joint, as in results
    #[key(range = "<= 1_000_000")]
    pub joint: usize,
    /// where, as a share of the joint's length from its first end
    #[key(unit = "-", range = ">= 0, <= 1", optional = "its mean opening")]
    pub at: Option<f64>,
    /// opening per motion of the last step from which the opening is controlled
    #[key(unit = "-", range = "> 0", default = 0.1)]
    pub switch: f64,
    /// First step.
    #[key(like = StepKeys, default)]
    pub first_step: f64,
    /// Largest step.
    #[key(like = StepKeys)]
    pub largest_step: Option<f64>,
}

impl CrackOpening {
    /// Creates the strategy for a joint, with defaults.
    pub fn of(joint: usize) -> Self {
        CrackOpening {
            joint,
            at: None,
            switch: Self::default_of("switch"),
            first_step: Self::default_of("first_step"),
            largest_step: None,
        }
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

    step_lengths!();
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::Continuation,
        tag: "crack_opening",
        summary: "steps of the opening of one joint; passes limit points and snap-back while that joint opens",
        sources: &["de Borst 1987, Computers & Structures 25, 211-224", "Rots & de Borst 1987, J. Engng Mech. 113, 1739-1758"],
        samples: &[Sample::keys("joint = 0\nswitch = 0.2")],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("crack_opening.md"),
        ..Card::of::<CrackOpening>()
    }
}
