//! Shared code of kinds that search a range of values: refinement of optima, and intervals of one status.

mod refinement;

pub(super) use self::refinement::{Bracket, Goal, Point, bracket, refine};
use serde_json::Value as Json;
use voussoir_core::plugin::Diagnostic;
use voussoir_study::results::IntervalEntry;
use voussoir_study::study::{Case, Outline, Study};

/// Returns the intervals of one status, from their first value to their last, of (value, status) in ascending order.
pub(super) fn intervals(tried: &[(f64, &str)]) -> Vec<IntervalEntry> {
    let stretches = tried.chunk_by(|a, b| a.1 == b.1);
    let ends = stretches.filter_map(|stretch| Some((stretch.first()?, stretch.last()?)));
    ends.map(|(a, b)| IntervalEntry { from: a.0, to: b.0, status: a.1.into() }).collect()
}

/// Returns a case of a study at other values, without its own figures, with its id among all cases.
pub(super) fn case_at(study: &Study, base: usize, id: usize, values: &[(String, Json)]) -> Option<Case> {
    // A stored id may be out of range.
    if base >= study.count() {
        return None;
    }
    let mut case = study.at(base, values).ok()?;
    case.id = id;
    case.brief = true;
    Some(case)
}

/// Returns the mistakes in a search over a range: ends in the wrong order, and keys that the study also sweeps. `at` and `named`
/// are the keys of the table with the range and of the name.
pub(super) fn range_mistakes(
    [at, named]: [&str; 2],
    [from, to]: [f64; 2],
    keys: &[String],
    outline: &Outline,
) -> Vec<Diagnostic> {
    let reversed =
        (from >= to).then(|| Diagnostic::new(format!("{at}.to"), format!("{to} must be more than from, {from}")));
    let swept = |key: &&String| outline.axes.iter().any(|(swept, _)| swept.contains(key));
    let besides = |key: &String| Diagnostic::new(named, format!("\"{key}\" is swept besides"));
    reversed.into_iter().chain(keys.iter().filter(swept).map(besides)).collect()
}
