//! The figure of a map: regions of mechanisms and contours of a ratio over two swept numbers.

use super::comparison::open_bracket;
use super::format::{format_short, kind_words, status_word};
use super::plot::axis::Axis;
use super::plot::colours::{FAINT, INK, MISSING, REGIONS};
use super::plot::contour::contour;
use super::plot::number::{round_values, tick_label};
use super::plot::svg::{Canvas, SMALL, TITLE, WIDTH};
use super::plot::text::{Spot, text_width, wrapped};
use crate::results::{Comparison, ComparisonCell, MapAxes};

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
    let (left, plot_width, plot_height, width) = (84.0, WIDTH - 106.0, 424.0, WIDTH);
    let title = match loads {
        true => format!("{study}: load factor (contours) and mechanisms (colours) of \"{}\"", map.contours),
        false => format!(
            "{study}: load of \"{}\" over that of \"{}\" (contours); mechanisms of \"{}\" (colours)",
            map.contours, comparison.reference, map.regions
        ),
    };
    let mut canvas = Canvas::default();
    let top = 6.0 + canvas.title(&wrapped(&title, TITLE, width - 24.0), width);
    let bottom = top + plot_height;
    let (x_edges, y_edges) = (edges(&map.x_values), edges(&map.y_values));
    let axis = |edges: &[f64], places: [f64; 2]| Axis { values: [edges[0], edges[edges.len() - 1]], places };
    let x = axis(&x_edges, [left, left + plot_width]);
    let y = axis(&y_edges, [bottom, top]);
    for i in 0..nx {
        for j in 0..ny {
            let kind = region(cell(i, j, region_of));
            let ground = REGIONS[kinds.iter().position(|k| *k == kind).unwrap_or(0) % REGIONS.len()];
            let (xs, ys) = ([x.at(x_edges[i]), x.at(x_edges[i + 1])], [y.at(y_edges[j]), y.at(y_edges[j + 1])]);
            let low = [xs[0].min(xs[1]), ys[0].min(ys[1])];
            // A hair wider, so that no white lines show between cells.
            let high = [xs[0].max(xs[1]) + 0.3, ys[0].max(ys[1]) + 0.3];
            canvas.rectangle(low, high, ground);
        }
    }
    for (i, &at) in map.x_values.iter().enumerate() {
        for (j, &up) in map.y_values.iter().enumerate() {
            let colour = if ratios[i][j].is_some() { FAINT } else { MISSING };
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
        canvas.text([24.0, legend], &words, SMALL, "start");
    }
    let regions: Vec<String> = kinds.iter().zip(&counts).map(|(kind, count)| format!("{kind} at {count}")).collect();
    let known = ratios.iter().flatten().flatten();
    let (least, greatest) = known.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, g), x| (l.min(*x), g.max(*x)));
    let described = format!(
        "A map of {} points over {} and {}. Values from {} to {}. Regions: {}.",
        nx * ny,
        map.x_label,
        map.y_label,
        format_short(least, 4),
        format_short(greatest, 4),
        regions.join(", ")
    );
    Some(canvas.finish([width, legend + 16.0], &title, &described))
}

/// The kinds of mechanisms with the number of their points, from `legend` downwards; returns where it ends.
fn legend(canvas: &mut Canvas, kinds: &[String], counts: &[usize], width: f64, mut legend: f64, missing: usize) -> f64 {
    let mut at = 24.0;
    for (k, kind) in kinds.iter().enumerate() {
        let words = format!("{kind} ({})", counts[k]);
        let wide = 28.0 + text_width(&words, SMALL) + 16.0;
        if at > 24.0 && at + wide > width - 20.0 {
            (at, legend) = (24.0, legend + 22.0);
        }
        canvas.rectangle([at, legend - 12.0], [at + 18.0, legend + 2.0], REGIONS[k % REGIONS.len()]);
        canvas.text([at + 25.0, legend], &words, SMALL, "start");
        at += wide;
    }
    legend += 22.0;
    let mut words = "numbers after mechanisms: how many computed points, which are the grey dots".to_string();
    if missing > 0 {
        words += &format!("; red dots: {missing} without a ratio");
    }
    canvas.text([24.0, legend], &words, SMALL, "start");
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
            canvas.line(ends, INK, 1.6, "");
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
            canvas.edged([spot[0], spot[1] + 4.5], &format_short(level, 4), (SMALL, "middle", INK), false);
        }
    }
}

fn frame(canvas: &mut Canvas, map: &MapAxes, x: &Axis, y: &Axis, width: f64) {
    let [left, right] = x.places;
    let [bottom, top] = y.places;
    for tick in x.ticks(8) {
        canvas.line(&[[x.at(tick), bottom], [x.at(tick), bottom + 5.0]], INK, 1.0, "");
        canvas.text([x.at(tick), bottom + 20.0], &tick_label(tick), SMALL, "middle");
    }
    for tick in y.ticks(7) {
        canvas.line(&[[left - 5.0, y.at(tick)], [left, y.at(tick)]], INK, 1.0, "");
        canvas.text([left - 9.0, y.at(tick) + 4.5], &tick_label(tick), SMALL, "end");
    }
    canvas.line(&[[left, top], [right, top], [right, bottom], [left, bottom], [left, top]], INK, 1.0, "");
    canvas.text([(left + right).min(width) / 2.0, bottom + 44.0], &map.x_label, SMALL, "middle");
    canvas.upright([20.0, (top + bottom) / 2.0], &map.y_label, SMALL);
}
