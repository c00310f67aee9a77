//! Refinement of a local maximum of a function that is piecewise smooth, such as a load factor.
//!
//! Between two values that were tried, the function is bounded by the lines through the neighbours on both sides if it is concave
//! there (Kelley 1960). The two lines meet at the next value. A kink is therefore cut from both sides. If the lines do not
//! bound the function, the interval is bisected.

/// Shares of an interval at which the next value may be, so that results of other processors do not move it.
const GRID: f64 = 64.0;
/// Greatest number of values for one maximum.
const MAX_VALUES: usize = 60;
/// Relative differences of results below this are rounding.
const ROUNDING: f64 = 1e-12;

/// A value that was tried, with its merit: greater is better.
pub(in crate::kinds) type Point = (f64, f64);

/// The end of a refinement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::kinds) struct Goal {
    /// Greatest possible gain, as a share of the merit.
    pub accuracy: f64,
    /// Greatest distance of the neighbours of the best value.
    pub width: f64,
}

/// A maximum with its neighbours.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::kinds) struct Bracket {
    /// The neighbours of the best value.
    pub ends: [f64; 2],
    /// The gain that the lines through the neighbours permit between them.
    pub gain: f64,
}

/// A part of a bracket, on one side of its best value.
struct Part {
    ends: [f64; 2],
    gain: f64,
    next: f64,
}

impl Part {
    fn width(&self) -> f64 {
        self.ends[1] - self.ends[0]
    }
}

/// Returns the line through two points at `x`.
fn line([a, b]: [Point; 2], x: f64) -> f64 {
    b.1 + (b.1 - a.1) * ((x - b.0) / (b.0 - a.0))
}

/// Returns the point of a grid in the interval that is nearest to `x`; it is not an end.
fn inside(low: f64, high: f64, x: f64) -> f64 {
    let share = (GRID * (x - low) / (high - low)).round().clamp(1.0, GRID - 1.0) / GRID;
    low + (high - low) * share
}

/// Returns the bound and the next value between points `i` and `i + 1`, if the greatest merit is `best`.
fn part(points: &[Point], i: usize, best: f64) -> Part {
    let (p, q) = (points[i], points[i + 1]);
    let noise = ROUNDING * best.abs();
    let rising = i.checked_sub(1).map(|before| [points[before], p]);
    let falling = points.get(i + 2).map(|after| [*after, q]);
    // A line bounds the function only if it is above the point on the other side.
    let rising = rising.filter(|own| line(*own, q.0) >= q.1 - noise);
    let falling = falling.filter(|own| line(*own, p.0) >= p.1 - noise);
    let middle = 0.5 * (p.0 + q.0);
    let (top, next) = match (rising, falling) {
        (Some(up), Some(down)) => {
            let (low, high) = (line(down, p.0) - p.1, line(up, q.0) - q.1);
            let share = if low + high > noise { low / (low + high) } else { 0.5 };
            let x = p.0 + (q.0 - p.0) * share;
            (line(up, x).max(p.1).min(line(down, x).max(q.1)), inside(p.0, q.0, x))
        }
        // No point is beyond the first one: the function may rise next to it.
        (None, Some(down)) => (line(down, p.0), if i == 0 { inside(p.0, q.0, p.0) } else { middle }),
        (Some(up), None) => (line(up, q.0), if i + 2 == points.len() { inside(p.0, q.0, q.0) } else { middle }),
        (None, None) => (best + (p.1 - q.1).abs(), middle),
    };
    Part { ends: [p.0, q.0], gain: (top - best).max(0.0), next }
}

/// Returns the index of the greatest merit; of equal ones the first.
fn best_of(points: &[Point]) -> usize {
    let better = |best: usize, other: usize| if points[other].1 > points[best].1 { other } else { best };
    (0..points.len()).reduce(better).unwrap_or(0)
}

/// Returns the parts on both sides of a point.
fn parts(points: &[Point], at: usize) -> impl Iterator<Item = Part> + '_ {
    let first = at.saturating_sub(1);
    (first..at + 1).filter(|i| i + 1 < points.len()).map(move |i| part(points, i, points[at].1))
}

/// Returns the neighbours of the point with this index in points in ascending order, and the possible gain between them.
pub(in crate::kinds) fn bracket(points: &[Point], at: usize) -> Bracket {
    let end = |i: usize| points[i.min(points.len() - 1)].0;
    let gain = parts(points, at).map(|part| part.gain).fold(0.0, f64::max);
    Bracket { ends: [end(at.saturating_sub(1)), end(at + 1)], gain }
}

/// Refines the greatest merit of `points`, in ascending order, until neither side of it can gain more than the accuracy, and both
/// neighbours are near. `merit` returns `None` to end the search. The search also ends if the maximum cannot exceed `least`.
pub(in crate::kinds) fn refine(
    points: &mut Vec<Point>,
    goal: Goal,
    least: f64,
    mut merit: impl FnMut(f64) -> Option<f64>,
) {
    for _ in 0..MAX_VALUES {
        let at = best_of(points);
        let best = points[at].1;
        let sides: Vec<Part> = parts(points, at).collect();
        let gain = sides.iter().map(|part| part.gain).fold(0.0, f64::max);
        let width: f64 = sides.iter().map(Part::width).sum();
        let flat = gain <= ROUNDING * best.abs();
        let exact = gain <= goal.accuracy * best.abs();
        // The lines of distant points are only estimates, so the margin is as large as the gain.
        if (exact && (flat || width <= goal.width)) || best + 2.0 * gain < least {
            return;
        }
        let key = |part: &&Part| if exact { part.width() } else { part.gain };
        let Some(next) = sides.iter().max_by(|a, b| key(a).total_cmp(&key(b))) else { return };
        let x = if exact { 0.5 * (next.ends[0] + next.ends[1]) } else { next.next };
        let place = points.partition_point(|point| point.0 < x);
        if points.get(place).is_some_and(|point| point.0 == x) || place == 0 || place == points.len() {
            return;
        }
        let Some(found) = merit(x) else { return };
        points.insert(place, (x, found));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the error of the maximum and the number of evaluations, from a scan of eleven values.
    fn error(f: impl Fn(f64) -> f64, most: f64) -> (f64, usize) {
        let all: Vec<Point> = (0..=10).map(f64::from).map(|x| (x, f(x))).collect();
        let at = best_of(&all);
        let mut points = all[at.saturating_sub(2)..(at + 3).min(all.len())].to_vec();
        let mut count = 0;
        refine(&mut points, Goal { accuracy: 1e-6, width: 1.0 }, f64::NEG_INFINITY, |x| {
            count += 1;
            Some(f(x))
        });
        ((most - points[best_of(&points)].1) / most.abs(), count)
    }

    /// Maxima at kinks, smooth ones, one at an end and one beside a jump are right to 1e-6.
    #[test]
    fn maxima_are_right_to_the_accuracy() {
        type Case = (&'static str, fn(f64) -> f64, f64, usize);
        let cases: [Case; 6] = [
            ("kink", |x| 5.0 - 3.0 * (x - 7.777).abs(), 5.0, 12),
            ("convex sides", |x| (10.0 + x * x).min(200.0 / x), 37.878_630_969_174, 40),
            ("smooth", |x| 2.0 - (x - 2.3).powi(2), 2.0, 24),
            ("slowly smooth", |x| (0.3 * x).sin() + 1.0, 2.0, 24),
            ("convex end", |x| 1.0 + (-x).exp(), 2.0, 24),
            ("jump", |x| if x < 6.3 { 1.0 + x } else { 1.0 }, 7.3, 40),
        ];
        for (name, f, most, limit) in cases {
            let (error, count) = error(f, most);
            println!("{name}: error {error:e} after {count}");
            assert!((-1e-12..=1e-6).contains(&error) && count <= limit, "{name}: {error:e} {count}");
        }
    }
}
