//! Shared code of kinds that search a range of values: golden sections, and intervals of one status.

use serde_json::Value as Json;
use voussoir_core::plugin::Diagnostic;
use voussoir_study::results::IntervalEntry;
use voussoir_study::study::{Case, Outline, Study};

/// Golden section: (√5 − 1)/2.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Narrows a bracket of the greatest merit to a width by golden sections (Kiefer 1953). A value without merit is worse than
/// all others. If merits are equal, as for two mirrored scenes, the left part is kept.
pub(super) fn golden_section([mut low, mut high]: [f64; 2], width: f64, mut merit: impl FnMut(f64) -> Option<f64>) {
    let mut at = |x: f64| merit(x).unwrap_or(f64::NEG_INFINITY);
    let (mut a, mut b) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
    let (mut f_a, mut f_b) = (at(a), at(b));
    while high - low > width {
        if f_a >= f_b {
            (high, b, f_b) = (b, a, f_a);
            a = high - GOLDEN * (high - low);
            f_a = at(a);
        } else {
            (low, a, f_a) = (a, b, f_b);
            b = low + GOLDEN * (high - low);
            f_b = at(b);
        }
    }
}

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

/// Returns the mistakes in a search over a range: ends in the wrong order, and keys that the study also sweeps.
pub(super) fn range_mistakes(table: &str, range: [f64; 2], keys: &[String], outline: &Outline) -> Vec<Diagnostic> {
    let [from, to] = range;
    let reversed =
        (from >= to).then(|| Diagnostic::new(format!("{table}.to"), format!("{to} must be more than from, {from}")));
    let swept = |key: &&String| outline.axes.iter().any(|(swept, _)| swept.contains(key));
    let besides = |key: &String| Diagnostic::new(format!("{table}.parameter"), format!("\"{key}\" is swept besides"));
    reversed.into_iter().chain(keys.iter().filter(swept).map(besides)).collect()
}
