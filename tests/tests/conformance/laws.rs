//! Every plug-in conforms, checked by the module that checks plug-ins of other projects too. A new plug-in needs no change here.
//! Solvers and strategies are checked with the dishonest versions.

use voussoir::conformance::{Options, Report, conform_all};
use voussoir::core::plugin::card;

/// Counts the allocations of a call with the allocator of this test program.
pub fn allocations(call: &mut dyn FnMut()) -> u64 {
    allocation_counter::measure(call).count_total
}

/// Every registered plug-in conforms; the test names all that do not.
#[test]
fn every_plug_in_conforms() {
    let mut reports = conform_all(&Options { allocations: Some(allocations) });
    // This program also has faulty plug-ins, which other tests need.
    let faulty = |report: &Report| card(report.kind, &report.tag).is_some_and(|card| card.file.contains("mutants"));
    reports.retain(|report| !faulty(report));
    let failed: Vec<&Report> = reports.iter().filter(|report| !report.passed()).collect();
    let words: String = failed.iter().map(|report| report.to_string()).collect();
    assert!(failed.is_empty(), "{} of {} plug-ins do not conform:\n{words}", failed.len(), reports.len());
    assert!(reports.len() >= 30, "only {} plug-ins are registered", reports.len());
    // Every check is really made a minimum number of times.
    let made = |check: &str| reports.iter().filter_map(|report| report.done.get(check)).sum::<usize>();
    for (check, least) in [("tangent", 10_000), ("facets_and_response", 10_000), ("allocation", 20), ("units", 5_000)] {
        assert!(made(check) >= least, "{check}: {} times", made(check));
    }
}
