//! Conformance: checks that a plug-in keeps the promises of its trait and its card, without knowledge of the plug-in.
//!
//! [`conform`] takes a card, walks through its samples and reports every check with its number of repetitions and its
//! findings; `voussoir conform TAG` prints the report. A law of another crate calls it in its own test.
//!
//! The page `docs/reference/conformance.md` lists the checks by name. Generic checks cannot find a memory that is missing in
//! a consistent way. Therefore each law that answers at a point has a [known path](voussoir_core::plugin::KnownPath).

mod assembly;
mod cone;
mod energy;
mod facets;
mod findings;
mod joint;
mod keys;
mod known_path;
pub mod lies;
mod load;
mod material;
mod options;
mod outputs;
mod plug_in;
mod point;
mod random;
mod reproduce;
mod samples;
mod scaled;
mod scene;
mod scene_space;
mod sign;
mod site;
mod softening;
mod strategy;
mod subject;
mod units;
mod walk;

pub use findings::{Finding, Recorder, Report};
pub use options::{CountAllocations, Options};

use std::panic::{AssertUnwindSafe, catch_unwind};
use voussoir_core::plugin::{Card, PluginKind, cards};

/// A check of plug-ins that another crate adds. It does nothing for plug-ins of other kinds.
pub struct FurtherCheck(pub fn(&mut Recorder, &Card, &Options));

voussoir_core::inventory::collect!(FurtherCheck);

/// Checks one plug-in by its card.
pub fn conform(card: &Card, options: &Options) -> Report {
    let mut recorder = Recorder::new(card);
    // A plug-in that panics fails; the other plug-ins are still checked.
    let solver = |recorder: &mut Recorder, card: &Card, _: &Options| lies::check(recorder, card);
    let checks: [fn(&mut Recorder, &Card, &Options); 9] = [
        samples::check,
        keys::check,
        joint::check,
        material::check,
        scene::check,
        load::check,
        strategy::check,
        known_path::check,
        solver,
    ];
    let further = voussoir_core::inventory::iter::<FurtherCheck>.into_iter().map(|check| check.0);
    for check in checks.into_iter().chain(further) {
        let ended = catch_unwind(AssertUnwindSafe(|| check(&mut recorder, card, options)));
        if let Err(panic) = ended {
            let said = panic.downcast_ref::<String>().map(String::as_str).or(panic.downcast_ref::<&str>().copied());
            recorder.fail("panic", format!("a panic: {}", said.unwrap_or("it says nothing")));
        }
    }
    recorder.report()
}

/// Checks every registered plug-in but solvers and strategies, whose checks take minutes. Returns one report for each, in the
/// order of `voussoir list`.
pub fn conform_all(options: &Options) -> Vec<Report> {
    let slow = [PluginKind::LimitSolver, PluginKind::PathSolver, PluginKind::Continuation];
    cards().iter().filter(|card| !slow.contains(&card.kind)).map(|card| conform(card, options)).collect()
}
