//! The figure of a map: regions of mechanisms and contours of a ratio over two swept numbers.

use super::axes::{Axis, Canvas, round_values};
use super::comparison::open_bracket;
use super::format::{format_short, kind_words, status_word};
use super::text_layout::{Spot, text_width, wrapped};
use crate::results::{Comparison, ComparisonCell, MapAxes};

/// Light grounds on which dark contours stay readable.
const GROUNDS: [&str; 8] = ["#b8d4e8", "#f6d3b3", "#c3e6d4", "#ecd0e0", "#e6e6e6", "#fbeec0", "#d5cfe9", "#dfc9bd"];

/// What stands at a point of the grid: the mechanism, or the status where there is none.
fn region(cell: &ComparisonCell) -> String {
    match (cell.mechanism, cell.status) {
        (_, None) => "not answered".into(),
        (Some(kind), Some(voussoir_core::limit::Status::Collapse)) => kind_words(kind).to_string(),
        (_, Some(status)) => status_word(status).replace('_', " "),
    }
}

/// Edges of cells around the values: midway between neighbours, half a step beyond the ends.
fn edges(values: &[f64]) -> Vec<f64> {
    let n = values.len();
    if n == 1 {
        let half = (0.05 * values[0].abs()).max(0.05);
        return vec![values[0] - half, values[0] + half];
    }
    let mut edges = vec![1.5 * values[0] - 0.5 * values[1]];
    edges.extend(values.windows(2).map(|pair| (pair[0] + pair[1]) / 2.0));
    edges.push(1.5 * values[n - 1] - 0.5 * values[n - 2]);
    edges
}

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

/// The figure; `None` where the comparison has no map.
pub fn map_svg(study: &str, comparison: &Comparison) -> Option<String> {
    let map = comparison.map.as_ref()?;
    let variant = |name: &str| comparison.variants.iter().position(|variant| variant == name);
    let (ratio_of, region_of) = (variant(&map.contours)?, variant(&map.regions)?);
    let (nx, ny) = (map.x_values.len(), map.y_values.len());
    if comparison.rows.len() != nx * ny {
        return None;
    }
    let cell = |i: usize, j: usize, variant: usize| &comparison.rows[i * ny + j].cells[variant];
    let loads = map.contours == comparison.reference;
    let value = |cell: &ComparisonCell| if loads { cell.load_factor } else { cell.ratio };
    let ratios: Vec<Vec<Option<f64>>> =
        (0..nx).map(|i| (0..ny).map(|j| value(cell(i, j, ratio_of))).collect()).collect();
    let (mut kinds, mut counts): (Vec<String>, Vec<usize>) = (Vec::new(), Vec::new());
    for i in 0..nx {
        for j in 0..ny {
            let name = region(cell(i, j, region_of));
            match kinds.iter().position(|kind| *kind == name) {
                Some(k) => counts[k] += 1,
                None => (kinds.push(name), counts.push(1)).0,
            }
        }
    }
    let (left, plot_width, plot_height, width) = (90.0, 640.0, 460.0, 780.0);
    let title = match loads {
        true => format!("{study}: load factor (contours) and mechanisms (colours) of \"{}\"", map.contours),
        false => format!(
            "{study}: load of \"{}\" over that of \"{}\" (contours); mechanisms of \"{}\" (colours)",
            map.contours, comparison.reference, map.regions
        ),
    };
    let titles = wrapped(&title, 16.0, width - 40.0);
    let top = 22.0 + 23.0 * titles.len() as f64;
    let bottom = top + plot_height;
    let (x_edges, y_edges) = (edges(&map.x_values), edges(&map.y_values));
    let axis = |edges: &[f64], places: [f64; 2]| Axis { values: [edges[0], edges[edges.len() - 1]], places };
    let x = axis(&x_edges, [left, left + plot_width]);
    let y = axis(&y_edges, [bottom, top]);
    let mut canvas = Canvas::default();
    for (i, line) in titles.iter().enumerate() {
        canvas.text([width / 2.0, 28.0 + 23.0 * i as f64], line, 16.0, "middle");
    }
    for i in 0..nx {
        for j in 0..ny {
            let kind = region(cell(i, j, region_of));
            let ground = GROUNDS[kinds.iter().position(|k| *k == kind).unwrap_or(0) % GROUNDS.len()];
            let (xs, ys) = ([x.at(x_edges[i]), x.at(x_edges[i + 1])], [y.at(y_edges[j]), y.at(y_edges[j + 1])]);
            let low = [xs[0].min(xs[1]), ys[0].min(ys[1])];
            // A hair wider, so that no white lines show between cells.
            let high = [xs[0].max(xs[1]) + 0.3, ys[0].max(ys[1]) + 0.3];
            canvas.rectangle(low, high, ground);
        }
    }
    for (i, &at) in map.x_values.iter().enumerate() {
        for (j, &up) in map.y_values.iter().enumerate() {
            let colour = if ratios[i][j].is_some() { "#999999" } else { "#d00000" };
            let (px, py) = (x.at(at), y.at(up));
            canvas.rectangle([px - 1.2, py - 1.2], [px + 1.2, py + 1.2], colour);
        }
    }
    contours(&mut canvas, map, &ratios, &x, &y);
    frame(&mut canvas, map, &x, &y, width);
    let missing = ratios.iter().flatten().filter(|ratio| ratio.is_none()).count();
    let base = variant(&comparison.reference)?;
    let open = comparison.rows.iter().filter(|row| open_bracket(&row.cells[base]).is_some()).count();
    let mut legend = legend(&mut canvas, &kinds, &counts, width, bottom + 74.0, missing);
    if open > 0 {
        legend += 22.0;
        let words = format!(
            "at {open} of {} points \"{}\" may be lower than the load found, and the ratio greater",
            nx * ny,
            comparison.reference
        );
        canvas.text([40.0, legend], &words, 13.0, "start");
    }
    Some(canvas.finish(width, legend + 18.0))
}

/// The kinds of mechanisms with the number of their points, from `legend` downwards; returns where it ends.
fn legend(canvas: &mut Canvas, kinds: &[String], counts: &[usize], width: f64, mut legend: f64, missing: usize) -> f64 {
    let mut at = 40.0;
    for (k, kind) in kinds.iter().enumerate() {
        let words = format!("{kind} ({})", counts[k]);
        let wide = 28.0 + text_width(&words, 13.0) + 16.0;
        if at > 40.0 && at + wide > width - 20.0 {
            (at, legend) = (40.0, legend + 22.0);
        }
        canvas.rectangle([at, legend - 12.0], [at + 18.0, legend + 2.0], GROUNDS[k % GROUNDS.len()]);
        canvas.text([at + 25.0, legend], &words, 13.0, "start");
        at += wide;
    }
    legend += 22.0;
    let mut words = "numbers after mechanisms: how many computed points, which are the grey dots".to_string();
    if missing > 0 {
        words += &format!("; red dots: {missing} without a ratio");
    }
    canvas.text([40.0, legend], &words, 13.0, "start");
    legend
}

fn contours(canvas: &mut Canvas, map: &MapAxes, ratios: &[Vec<Option<f64>>], x: &Axis, y: &Axis) {
    let known = ratios.iter().flatten().flatten();
    let (low, high) =
        known.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high): (f64, f64), &r| (low.min(r), high.max(r)));
    // Ratios that differ by rounding have no contours.
    if (high - low).is_nan() || high - low <= 1e-6 * high {
        return;
    }
    // Round values; of the level 1 only rounding would be drawn where the two loads agree.
    let levels = round_values(low, high, 9).into_iter().filter(|level| (level - 1.0).abs() > 1e-9);
    let mut labels: Vec<Spot> = Vec::new();
    for level in levels {
        let segments: Vec<[Spot; 2]> = contour(&map.x_values, &map.y_values, ratios, level)
            .into_iter()
            .map(|ends| ends.map(|[a, b]| [x.at(a), y.at(b)]))
            .collect();
        for ends in &segments {
            canvas.path(ends, "#222222", 1.6);
        }
        // One number per level, where it is farthest from those of the others and from the frame.
        let middle = |ends: &[Spot; 2]| [(ends[0][0] + ends[1][0]) / 2.0, (ends[0][1] + ends[1][1]) / 2.0];
        let room = |spot: &Spot| {
            let others = labels.iter().map(|l: &Spot| (l[0] - spot[0]).hypot(l[1] - spot[1]));
            let sides = [(x, spot[0]), (y, spot[1])]
                .map(|(axis, at)| (at - axis.places[0]).abs().min((at - axis.places[1]).abs()));
            others.chain(sides.map(|side| 2.0 * side)).fold(f64::INFINITY, f64::min)
        };
        let best = segments.iter().map(middle).max_by(|a, b| room(a).total_cmp(&room(b)));
        if let Some(spot) = best.filter(|spot| room(spot) > 24.0) {
            labels.push(spot);
            canvas.label([spot[0], spot[1] + 4.5], &format_short(level, 4), 13.0);
        }
    }
}

fn frame(canvas: &mut Canvas, map: &MapAxes, x: &Axis, y: &Axis, width: f64) {
    let [left, right] = x.places;
    let [bottom, top] = y.places;
    for tick in x.ticks(8) {
        canvas.line([x.at(tick), bottom], [x.at(tick), bottom + 5.0], "#222222", 1.0);
        canvas.text([x.at(tick), bottom + 20.0], &Canvas::number(tick), 13.0, "middle");
    }
    for tick in y.ticks(7) {
        canvas.line([left - 5.0, y.at(tick)], [left, y.at(tick)], "#222222", 1.0);
        canvas.text([left - 9.0, y.at(tick) + 4.5], &Canvas::number(tick), 13.0, "end");
    }
    canvas.path(&[[left, top], [right, top], [right, bottom], [left, bottom], [left, top]], "#222222", 1.0);
    canvas.text([(left + right).min(width) / 2.0, bottom + 44.0], &map.x_label, 14.0, "middle");
    canvas.upright([28.0, (top + bottom) / 2.0], &map.y_label, 14.0);
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
