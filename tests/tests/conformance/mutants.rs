//! Plug-ins with one fault each: the checks must find the fault by name. A plug-in without a fault conforms.

mod facets;
mod files;
mod keys;
mod materials;
mod responses;
mod scenes;

use super::laws::allocations;
use voussoir::conformance::{Options, conform};
use voussoir::core::plugin::{Card, Sample};

/// Checks a plug-in for each fault: (value of the key, names of checks of which at least one must find it). `none` must
/// conform.
fn every_fault_is_found(card: &Card, table: &'static str, sample: Sample, faults: &[(&str, &[&str])]) {
    let options = Options { allocations: Some(allocations) };
    let mut wrong = Vec::new();
    for (fault, checks) in [("none", &[] as &[&str])].iter().chain(faults) {
        // Texts of a card have the lifetime of the program, so these few texts are leaked.
        let with = |table: &str| -> &'static str { format!("fault = \"{fault}\"\n{table}").leak() };
        let samples: &'static [Sample] = Box::leak(Box::new([Sample { table: with(table), ..sample }]));
        let known: Vec<_> = card.known_paths.iter().map(|path| (path, with(path.table))).collect();
        let known: Vec<_> =
            known.into_iter().map(|(path, table)| voussoir::core::plugin::KnownPath { table, ..*path }).collect();
        let card = Card { samples, known_paths: known.leak(), ..copy(card) };
        let report = conform(&card, &options);
        let found = if *fault == "none" { report.passed() } else { checks.iter().all(|check| report.fails(check)) };
        if !found {
            wrong.push(format!("{fault}: {checks:?} should have found it\n{report}"));
        }
    }
    assert!(wrong.is_empty(), "{} faults:\n{}", wrong.len(), wrong.join("\n"));
}

fn copy(card: &Card) -> Card {
    Card { ..*card }
}
