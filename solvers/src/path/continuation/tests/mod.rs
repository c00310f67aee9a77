//! Tests of continuation strategies as functions of an increment.

mod constraints;
mod switches;

use super::arc_length::ArcLength;
use super::crack_opening::CrackOpening;
use super::displacement_control::DisplacementControl;
use super::dissipation::Dissipation;
use super::load_control::LoadControl;
use voussoir_core::path::{Continuation, Increment};

/// All strategies by default.
fn all() -> Vec<Box<dyn Continuation>> {
    vec![
        Box::new(ArcLength::default()),
        Box::new(CrackOpening::of(0)),
        Box::new(DisplacementControl::default()),
        Box::new(Dissipation::default()),
        Box::new(LoadControl::default()),
    ]
}

/// An increment with every entry.
fn some() -> Increment {
    Increment { factor: 0.3, displacement: -0.7, motion: 0.4, dissipation: 0.2, monitored: [0.25, -0.1, 0.0, 0.0] }
}

fn entries(i: &Increment) -> Vec<f64> {
    [i.factor, i.displacement, i.motion, i.dissipation].into_iter().chain(i.monitored).collect()
}

fn of_entries(e: &[f64]) -> Increment {
    Increment { factor: e[0], displacement: e[1], motion: e[2], dissipation: e[3], monitored: [e[4], e[5], e[6], e[7]] }
}

/// Last steps: none, one that dissipates and opens nothing, one that does both.
fn previous() -> [Option<Increment>; 3] {
    let still = Increment { dissipation: 0.0, monitored: [0.0; 4], ..some() };
    [None, Some(still), Some(some())]
}
