//! Contours of a function on a grid.

use super::text::Spot;

/// The segments on which a function on a grid takes the value `level`, linear along the grid's
/// edges: marching squares (Lorensen and Cline 1987, in the plane). `values[i][j]` stands at
/// (x\[i\], y\[j\]); squares with a missing corner are left out. Where the diagonal corners agree in
/// pairs, the mean of the four decides which pair is joined.
pub fn contour(x: &[f64], y: &[f64], values: &[Vec<Option<f64>>], level: f64) -> Vec<[Spot; 2]> {
    let mut segments = Vec::new();
    for i in 1..x.len() {
        for j in 1..y.len() {
            let corners = [(i - 1, j - 1), (i, j - 1), (i, j), (i - 1, j)];
            let found: Option<Vec<f64>> = corners.iter().map(|&(a, b)| values[a][b]).collect();
            let Some(v) = found else { continue };
            // The crossing of the edge from corner k to the next; a corner at the level counts above.
            let crossing = |k: usize| {
                let (a, b) = (k, (k + 1) % 4);
                ((v[a] >= level) != (v[b] >= level)).then(|| {
                    let share = (level - v[a]) / (v[b] - v[a]);
                    let at = |axis: &dyn Fn(usize) -> f64| axis(a) + share * (axis(b) - axis(a));
                    [at(&|c| x[corners[c].0]), at(&|c| y[corners[c].1])]
                })
            };
            let found: Vec<Spot> = (0..4).filter_map(crossing).collect();
            match found.as_slice() {
                [a, b] => segments.push([*a, *b]),
                [a, b, c, d] => {
                    let middle = v.iter().sum::<f64>() / 4.0 >= level;
                    let first = v[0] >= level;
                    // Joined corners 0 and 2: the contour cuts off corners 1 and 3.
                    if middle == first {
                        segments.extend([[*a, *b], [*c, *d]]);
                    } else {
                        segments.extend([[*d, *a], [*b, *c]]);
                    }
                }
                _ => {}
            }
        }
    }
    segments
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The contour x + y = 1 of a linear function is exact.
    #[test]
    fn contours_of_a_plane_are_straight() {
        let (x, y) = (vec![0.0, 0.4, 1.0], vec![0.0, 0.7, 1.0]);
        let values: Vec<Vec<Option<f64>>> = x.iter().map(|a| y.iter().map(|b| Some(a + b)).collect()).collect();
        let segments = contour(&x, &y, &values, 1.0);
        let length: f64 = segments.iter().map(|[a, b]| (a[0] - b[0]).hypot(a[1] - b[1])).sum();
        assert!((length - 2f64.sqrt()).abs() < 1e-12, "{segments:?}");
        assert!(segments.iter().flatten().all(|spot| (spot[0] + spot[1] - 1.0).abs() < 1e-12));
    }

    /// A saddle is cut in two ways, by its mean; a missing corner leaves a square out.
    #[test]
    fn saddles_and_gaps() {
        let at = |v: [f64; 4]| vec![vec![Some(v[0]), Some(v[3])], vec![Some(v[1]), Some(v[2])]];
        let axis = [0.0, 1.0];
        for corners in [[1.0, 0.0, 1.0, 0.0], [1.0, -9.0, 1.0, 0.0]] {
            assert_eq!(contour(&axis, &axis, &at(corners), 0.5).len(), 2);
        }
        let joined = contour(&axis, &axis, &at([3.0, 0.0, 3.0, 0.0]), 1.0);
        assert!(joined.iter().any(|[a, b]| a[1] == 0.0 && b[0] == 1.0), "{joined:?}");
        let mut gap = at([1.0, 0.0, 1.0, 0.0]);
        gap[0][0] = None;
        assert!(contour(&axis, &axis, &gap, 0.5).is_empty());
    }
}
