//! Conformance: whether a law keeps what its trait and its card promise, found out without knowing the law.
//!
//! [`conform`] takes a card, walks through its samples and reports every check with the number of times it was made and
//! what it found; `voussoir conform TAG` prints that. A law of another crate calls it in a test of its own:
//!
//! ```
//! use voussoir::conformance::{Options, conform};
//! use voussoir::core::plugin::{PluginKind, card};
//! let report = conform(card(PluginKind::InterfaceLaw, "coulomb").unwrap(), &Options::default());
//! assert!(report.passed(), "{report}");
//! ```
//!
//! What is checked, by name, stands in `docs/reference/conformance.md`. Generic checks cannot see a memory that is missing in a
//! consistent way: each law that answers at a point brings a [known path](voussoir_core::plugin::KnownPath).

mod energy;
mod facets;
mod findings;
mod joint;
mod known_path;
pub mod lies;
mod material;
mod options;
mod point;
mod random;
mod reproduce;
mod samples;
mod sign;
mod subject;
mod units;
mod walk;

pub use findings::{Finding, Report};
pub use options::{CountAllocations, Options};

use findings::Recorder;
use std::panic::{AssertUnwindSafe, catch_unwind};
use voussoir_core::plugin::{Card, PluginKind, cards_of};

/// Checks one law, solver or continuation strategy by its card. Other plug-ins have no checks.
pub fn conform(card: &Card, options: &Options) -> Report {
    let mut recorder = Recorder::new(card);
    // A law that panics fails; the others go on.
    let solver = |recorder: &mut Recorder, card: &Card, _: &Options| lies::check(recorder, card);
    let checks: [fn(&mut Recorder, &Card, &Options); 5] =
        [samples::check, joint::check, material::check, known_path::check, solver];
    for check in checks {
        let ended = catch_unwind(AssertUnwindSafe(|| check(&mut recorder, card, options)));
        if let Err(panic) = ended {
            let said = panic.downcast_ref::<String>().map(String::as_str).or(panic.downcast_ref::<&str>().copied());
            recorder.fail("panic", format!("a panic: {}", said.unwrap_or("it says nothing")));
        }
    }
    recorder.report()
}

/// Checks every registered law of joints and materials; one report each, in the order of `voussoir list`.
pub fn conform_all(options: &Options) -> Vec<Report> {
    let kinds = [PluginKind::InterfaceLaw, PluginKind::BulkMaterial];
    kinds.into_iter().flat_map(cards_of).map(|card| conform(card, options)).collect()
}
