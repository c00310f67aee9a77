//! Every law conforms, checked by the module that checks laws of other projects too. A new law needs no change here.

use voussoir::conformance::{Options, Report, conform_all};

/// Counts the allocations of a call with the allocator of this test program.
pub fn allocations(call: &mut dyn FnMut()) -> u64 {
    allocation_counter::measure(call).count_total
}

/// Every registered law conforms; the test names all laws that do not.
#[test]
fn every_law_conforms() {
    let reports = conform_all(&Options { allocations: Some(allocations) });
    let failed: Vec<&Report> = reports.iter().filter(|report| !report.passed()).collect();
    let words: String = failed.iter().map(|report| report.to_string()).collect();
    assert!(failed.is_empty(), "{} of {} laws do not conform:\n{words}", failed.len(), reports.len());
    assert!(reports.len() >= 10, "only {} laws are registered", reports.len());
    // Every check is really made a minimum number of times.
    let made = |check: &str| reports.iter().filter_map(|report| report.done.get(check)).sum::<usize>();
    for (check, least) in [("tangent", 10_000), ("facets_and_response", 10_000), ("allocation", 20), ("units", 5_000)] {
        assert!(made(check) >= least, "{check}: {} times", made(check));
    }
}
