//! Conformance: checks that a law keeps the promises of its trait and its card, without knowledge of the law.
//!
//! [`conform`] takes a card, walks through its samples and reports every check with its number of repetitions and its
//! findings; `voussoir conform TAG` prints the report. A law of another crate calls it in its own test.
//!
//! The page `docs/reference/conformance.md` lists the checks by name. Generic checks cannot find a memory that is missing in
//! a consistent way. Therefore each law that answers at a point has a [known path](voussoir_core::plugin::KnownPath).

mod energy;
mod facets;
mod findings;
mod joint;
mod keys;
mod known_path;
pub mod lies;
mod material;
mod options;
mod point;
mod random;
mod reproduce;
mod samples;
mod sign;
mod softening;
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
    // A law that panics fails; the other laws are still checked.
    let solver = |recorder: &mut Recorder, card: &Card, _: &Options| lies::check(recorder, card);
    let checks: [fn(&mut Recorder, &Card, &Options); 6] =
        [samples::check, keys::check, joint::check, material::check, known_path::check, solver];
    for check in checks {
        let ended = catch_unwind(AssertUnwindSafe(|| check(&mut recorder, card, options)));
        if let Err(panic) = ended {
            let said = panic.downcast_ref::<String>().map(String::as_str).or(panic.downcast_ref::<&str>().copied());
            recorder.fail("panic", format!("a panic: {}", said.unwrap_or("it says nothing")));
        }
    }
    recorder.report()
}

/// Checks every registered law of joints and materials. Returns one report for each, in the order of `voussoir list`.
pub fn conform_all(options: &Options) -> Vec<Report> {
    let kinds = [PluginKind::InterfaceLaw, PluginKind::BulkMaterial];
    kinds.into_iter().flat_map(cards_of).map(|card| conform(card, options)).collect()
}
