//! Compares load-displacement curves as functions.

use crate::checks::tolerances::{CURVE, Route};
use serde_json::Value as Json;

type Point = [f64; 2];

/// Returns true if each vertex of either curve lies on the other one, in the same order, from the same beginning to the same end.
pub(crate) fn same_curve(stored: &Json, again: &Json, route: Route) -> bool {
    let (Some(stored), Some(again)) = (points(stored), points(again)) else { return false };
    let all = || stored.iter().chain(&again);
    let range = |axis: usize| {
        let (low, high) =
            all().fold((f64::INFINITY, 0.0 - f64::INFINITY), |(low, high), p| (low.min(p[axis]), high.max(p[axis])));
        if high > low { high - low } else { 1.0 }
    };
    let ranges = [range(0), range(1)];
    let scaled = |curve: &[Point]| curve.iter().map(|p| [p[0] / ranges[0], p[1] / ranges[1]]).collect::<Vec<_>>();
    let (stored, again) = (scaled(&stored), scaled(&again));
    let ends = |curve: &[Point]| curve.first().copied().zip(curve.last().copied());
    let near = CURVE.of(route);
    let same_ends = match (ends(&stored), ends(&again)) {
        (Some((a, b)), Some((c, d))) => distance(a, [c, c]) <= near && distance(b, [d, d]) <= near,
        (a, b) => a == b,
    };
    same_ends && lies_on(&stored, &again, near) && lies_on(&again, &stored, near)
}

/// Pairs of finite numbers.
fn points(curve: &Json) -> Option<Vec<Point>> {
    let point = |pair: &Json| {
        let pair = pair.as_array().filter(|pair| pair.len() == 2)?;
        Some([pair[0].as_f64()?, pair[1].as_f64()?])
    };
    curve.as_array()?.iter().map(point).collect()
}

/// Distance of a point from a segment.
fn distance(p: Point, [a, b]: [Point; 2]) -> f64 {
    let (along, arm) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let square = along[0] * along[0] + along[1] * along[1];
    let share = if square > 0.0 { ((along[0] * arm[0] + along[1] * arm[1]) / square).clamp(0.0, 1.0) } else { 0.0 };
    (arm[0] - share * along[0]).hypot(arm[1] - share * along[1])
}

/// Returns true if the vertices lie on the curve, each on the segment of the one before or on a later one.
fn lies_on(vertices: &[Point], curve: &[Point], near: f64) -> bool {
    if let [only] = curve {
        return vertices.iter().all(|p| distance(*p, [*only, *only]) <= near);
    }
    let mut segment = 0;
    vertices.iter().all(|p| {
        let found = (segment..curve.len().saturating_sub(1)).find(|i| distance(*p, [curve[*i], curve[*i + 1]]) <= near);
        segment = found.unwrap_or(segment);
        found.is_some()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn parabola(count: usize) -> Json {
        (0..=count).map(|i| i as f64 / count as f64).map(|x| json!([x, 100.0 * x * (2.0 - x)])).collect()
    }

    #[test]
    fn other_steps_are_the_same_curve_and_other_values_are_not() {
        assert!(same_curve(&parabola(100), &parabola(100), Route::Events));
        assert!(same_curve(&parabola(100), &parabola(93), Route::Steps));
        assert!(!same_curve(&parabola(100), &parabola(93), Route::Events));
        for (by, found) in [(0.5e-3, false), (2e-3, true)] {
            let mut forged = parabola(100);
            forged[40][1] = json!(forged[40][1].as_f64().expect("a number") + 100.0 * by);
            assert_eq!(!same_curve(&forged, &parabola(100), Route::Steps), found, "{by}");
        }
        let mut cut = parabola(100);
        cut.as_array_mut().expect("a list").truncate(80);
        assert!(!same_curve(&cut, &parabola(100), Route::Steps));
        let mut exchanged = parabola(100);
        exchanged.as_array_mut().expect("a list").swap(20, 60);
        assert!(!same_curve(&exchanged, &parabola(100), Route::Steps));
        assert!(!same_curve(&json!([[0.0, null]]), &parabola(100), Route::Steps));
    }
}
