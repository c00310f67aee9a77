//! `exact_events`: no steps at all, from event to event.
#![doc = include_str!("exact_events.md")]

use serde::{Deserialize, Serialize};
use std::any::Any;
use voussoir_core::path::{Constraint, Continuation, Increment};
use voussoir_core::plugin::{Card, PluginKind};

/// The path is piecewise linear: the solver knows how far each piece goes.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ExactEvents {}

impl ExactEvents {
    /// Whether a strategy is this one.
    pub fn is(strategy: &dyn Continuation) -> bool {
        let strategy: &dyn Any = strategy;
        strategy.is::<ExactEvents>()
    }
}

#[typetag::serde(name = "exact_events")]
impl Continuation for ExactEvents {
    /// Not asked for: zero.
    fn constraint(&self, _increment: &Increment, _previous: Option<&Increment>) -> Constraint {
        Constraint::default()
    }

    fn passes_limit_points(&self) -> bool {
        true
    }
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::Continuation,
        tag: "exact_events",
        summary: "from event to event of a piecewise linear path, without steps",
        parameters: &[],
        sources: &["Cocchetti & Maier 2003, Int. J. Numer. Meth. Engng 58 (piecewise linear paths as rate complementarity problems)"],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("exact_events.md"),
        ..Card::BLANK
    }
}
