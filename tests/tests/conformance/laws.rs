//! Every law conforms, by the module that anybody else's law is checked with. A new law edits nothing here.

use voussoir::conformance::{Options, Report, conform_all};

/// Allocations of a call, by the allocator of this test program.
pub fn allocations(call: &mut dyn FnMut()) -> u64 {
    allocation_counter::measure(call).count_total
}

/// All laws are checked, and all that fail are named.
#[test]
fn every_law_conforms() {
    let reports = conform_all(&Options { allocations: Some(allocations) });
    let failed: Vec<&Report> = reports.iter().filter(|report| !report.passed()).collect();
    let words: String = failed.iter().map(|report| report.to_string()).collect();
    assert!(failed.is_empty(), "{} of {} laws do not conform:\n{words}", failed.len(), reports.len());
    assert!(reports.len() >= 10, "only {} laws are registered", reports.len());
    // No check is made in words only.
    let made = |check: &str| reports.iter().filter_map(|report| report.done.get(check)).sum::<usize>();
    for (check, least) in [("tangent", 10_000), ("facets_and_response", 10_000), ("allocation", 20), ("units", 5_000)] {
        assert!(made(check) >= least, "{check}: {} times", made(check));
    }
}
