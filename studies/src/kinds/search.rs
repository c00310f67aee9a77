//! What kinds share that search a range of values: golden sections, and stretches of one status.

use serde_json::{Value as Json, json};

/// Golden section: (√5 − 1)/2.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Narrows a bracket of the greatest merit to a width by golden sections (Kiefer 1953); what has no merit is worse than
/// all. Equal merits, as of two mirrored scenes, leave the left part.
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

/// Stretches of one status from the first of their values to the last, of (value, status) in growing order.
pub(super) fn intervals(tried: &[(f64, Json)]) -> Vec<Json> {
    let stretches = tried.chunk_by(|a, b| a.1 == b.1);
    let ends = stretches.filter_map(|stretch| Some((stretch.first()?, stretch.last()?)));
    ends.map(|(a, b)| json!({ "from": a.0, "to": b.0, "status": a.1 })).collect()
}
