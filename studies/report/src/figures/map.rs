//! The figure of a map: for each variant the regions of its mechanisms and contours of its ratio, over two swept numbers.

use super::comparison::open_bracket;
use crate::output::StudyOutput;
use voussoir_core::certificate::MechanismKind;
use voussoir_core::limit::Status;
use voussoir_plot::axis::{Scale, WIDE};
use voussoir_plot::colours::{FAINT, INK, MISSING, REGIONS};
use voussoir_plot::contour::contour;
use voussoir_plot::svg::{Canvas, SMALL, TITLE, WIDTH};
use voussoir_plot::text::{Spot, text_width, wrapped};
use voussoir_study::results::format::{format_short, kind_words, status_word};
use voussoir_study::results::{CaseResult, Comparison, ComparisonCell, MapAxes};

/// Shares of the points below the contours, besides the contour of 1.
const QUANTILES: [f64; 5] = [0.1, 0.3, 0.5, 0.7, 0.9];
/// Ratios nearer to 1 than this are 1.
const SAME: f64 = 1e-6;
const SIDE: f64 = 20.0;

/// The name of the region of a point: the mechanism, or the status of a point without one.
fn region(mechanism: Option<MechanismKind>, status: Option<Status>) -> String {
    match (mechanism, status) {
        (_, None) => "not computed".into(),
        (Some(kind), Some(Status::Collapse)) => kind_words(kind).to_string(),
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

/// A swept axis: on a logarithmic one places are even in the logarithm.
struct Swept<'a> {
    values: &'a [f64],
    log: bool,
}

impl<'a> Swept<'a> {
    fn new(values: &'a [f64]) -> Self {
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        let greatest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        Swept { values, log: least > 0.0 && greatest >= WIDE * least }
    }

    /// Coordinates of the values in which the axis is straight.
    fn places(&self) -> Vec<f64> {
        self.values.iter().map(|x| if self.log { x.log10() } else { *x }).collect()
    }

    fn value(&self, place: f64) -> f64 {
        if self.log { 10f64.powf(place) } else { place }
    }

    fn edges(&self) -> Vec<f64> {
        edges(&self.places()).into_iter().map(|place| self.value(place)).collect()
    }

    fn scale(&self, places: [f64; 2]) -> Scale {
        let edges = self.edges();
        Scale::new([edges[0], edges[edges.len() - 1]], places, self.log)
    }
}

/// One map: the variant of its contours and the one of its regions.
struct Panel {
    title: String,
    values: Vec<Vec<Option<f64>>>,
    regions: Vec<Vec<String>>,
}

/// The maps of a comparison: the one that the study asks for, then the maps of the other variants.
fn panels(comparison: &Comparison, map: &MapAxes) -> Option<Vec<Panel>> {
    let place = |name: &str| comparison.variants.iter().position(|variant| variant == name);
    let (first, colours) = (place(&map.contours)?, place(&map.regions)?);
    let (nx, ny) = (map.x_values.len(), map.y_values.len());
    if comparison.rows.len() != nx * ny {
        return None;
    }
    let reference = place(&comparison.reference)?;
    let panel = |of: usize, regions: usize| {
        let loads = of == reference;
        let value = |cell: &ComparisonCell| if loads { cell.load_factor } else { cell.ratio };
        let cell = |i: usize, j: usize, variant: usize| &comparison.rows[i * ny + j].cells[variant];
        let grid = |i: usize| (0..ny).map(|j| value(cell(i, j, of))).collect();
        let kind = |cell: &ComparisonCell| region(cell.mechanism, cell.status);
        let kinds = |i: usize| (0..ny).map(|j| kind(cell(i, j, regions))).collect();
        let name = &comparison.variants[of];
        let ratio = if loads {
            format!("load factor of \"{name}\"")
        } else {
            format!("\"{name}\" / \"{}\"", comparison.reference)
        };
        let coloured =
            if regions == of { String::new() } else { format!("; colours: \"{}\"", comparison.variants[regions]) };
        Panel { title: ratio + &coloured, values: (0..nx).map(grid).collect(), regions: (0..nx).map(kinds).collect() }
    };
    let others = (0..comparison.variants.len()).filter(|variant| ![first, reference].contains(variant));
    Some([panel(first, colours)].into_iter().chain(others.map(|variant| panel(variant, variant))).collect())
}

/// The figure; `None` if the comparison has no map.
pub fn map_svg(study: &str, comparison: &Comparison) -> Option<String> {
    let map = comparison.map.as_ref()?;
    let panels = panels(comparison, map)?;
    let base = comparison.variants.iter().position(|variant| *variant == comparison.reference)?;
    let open = comparison.rows.iter().filter(|row| open_bracket(&row.cells[base]).is_some()).count();
    let note = format!(
        "at {open} of {} points \"{}\" may be lower than the load found, and the ratio greater",
        comparison.rows.len(),
        comparison.reference
    );
    let notes = if open > 0 { vec![note] } else { Vec::new() };
    Some(figure(&format!("{study}: contours of loads or their ratios, colours of mechanisms"), map, &panels, notes))
}

/// The load factors of a study with two swept numbers, a map for each variant. `None` for other studies.
pub fn load_factor_maps(study: &StudyOutput) -> Option<String> {
    let [x, y] = study.sweep_keys.as_slice() else { return None };
    let cases = &study.results.cases;
    let at = |case: &CaseResult, key: &str| case.label.parameters.get(key)?.as_f64();
    let different = |key: &str| -> Option<Vec<f64>> {
        let mut values: Vec<f64> = cases.iter().map(|case| at(case, key)).collect::<Option<_>>()?;
        values.sort_by(f64::total_cmp);
        values.dedup();
        (values.len() > 1).then_some(values)
    };
    let (x_values, y_values) = (different(x)?, different(y)?);
    let mut variants: Vec<Option<&str>> = cases.iter().map(|case| case.label.variant.as_deref()).collect();
    variants.dedup();
    let panel = |variant: &Option<&str>| {
        let find = |a: f64, b: f64| {
            let here = |case: &&CaseResult| at(case, x) == Some(a) && at(case, y) == Some(b);
            cases.iter().filter(|case| case.label.variant.as_deref() == *variant).find(here)
        };
        let value = |a: f64, b: f64| find(a, b).and_then(|case| case.load_factor);
        let kind = |a: f64, b: f64| {
            let words = |case: &CaseResult| region(case.mechanism.as_ref().map(|own| own.kind), Some(case.status));
            find(a, b).map_or_else(|| region(None, None), words)
        };
        Panel {
            title: variant.map_or("load factor".into(), |variant| format!("load factor of \"{variant}\"")),
            values: x_values.iter().map(|a| y_values.iter().map(|b| value(*a, *b)).collect()).collect(),
            regions: x_values.iter().map(|a| y_values.iter().map(|b| kind(*a, *b)).collect()).collect(),
        }
    };
    let panels: Vec<Panel> = variants.iter().map(panel).collect();
    let [x_label, y_label] = [x, y].map(|key| study.keys.title(key));
    let (contours, regions) = (String::new(), String::new());
    let axes = MapAxes { x: x.clone(), x_values, y: y.clone(), y_values, x_label, y_label, contours, regions };
    let title = format!("{}: contours of the load factor, colours of mechanisms", study.name);
    Some(figure(&title, &axes, &panels, Vec::new()))
}

/// Maps beside each other with one legend.
fn figure(title: &str, map: &MapAxes, panels: &[Panel], more: Vec<String>) -> String {
    let mut kinds: Vec<(&str, usize)> = Vec::new();
    for name in panels.iter().flat_map(|panel| panel.regions.iter().flatten()) {
        match kinds.iter_mut().find(|(kind, _)| kind == name) {
            Some((_, count)) => *count += 1,
            None => kinds.push((name, 1)),
        }
    }
    let columns = if panels.len() == 1 { 1 } else { 2 };
    let size = if columns == 1 { [WIDTH - 84.0 - SIDE, 420.0] } else { [WIDTH / 2.0 - 64.0 - 14.0, 250.0] };
    let mut canvas = Canvas::default();
    let head = canvas.title(&wrapped(title, TITLE, WIDTH - 2.0 * SIDE), WIDTH);
    let wide = WIDTH / columns as f64;
    let titles = panels.iter().map(|panel| wrapped(&panel.title, SMALL, wide - 2.0 * 14.0).len()).max().unwrap_or(1);
    let (above, height) = (18.0 * titles as f64 + 8.0, size[1] + 56.0);
    for (number, panel) in panels.iter().enumerate() {
        let left = wide * (number % columns) as f64 + if columns == 1 { 84.0 } else { 64.0 };
        let top = head + (above + height) * (number / columns) as f64 + above;
        for (i, line) in wrapped(&panel.title, SMALL, wide - 2.0 * 14.0).iter().rev().enumerate() {
            canvas.text([left + size[0] / 2.0, top - 8.0 - 18.0 * i as f64], line, SMALL, "middle");
        }
        panel.draw(&mut canvas, map, &kinds, [left, top], size);
    }
    let rows = panels.len().div_ceil(columns) as f64;
    let mut notes = vec!["numbers after mechanisms: how many computed points, which are the grey dots".to_string()];
    let missing = panels.iter().flat_map(|panel| panel.values.iter().flatten()).filter(|value| value.is_none()).count();
    notes.extend((missing > 0).then(|| format!("red dots: {missing} without a value")));
    notes.extend(more);
    let end = legend(&mut canvas, &kinds, &notes, head + (above + height) * rows + 22.0);
    let described: Vec<String> = panels.iter().map(Panel::described).collect();
    let points = map.x_values.len() * map.y_values.len();
    let axes = format!("{points} points over {} and {}", map.x_label, map.y_label);
    let alternative = format!("Maps of {axes}. {}. {}.", described.join(". "), notes.join("; "));
    canvas.finish([WIDTH, end + 16.0], title, &alternative)
}

/// The kinds of mechanisms with the number of their points, and notes under them; returns where it ends.
fn legend(canvas: &mut Canvas, kinds: &[(&str, usize)], notes: &[String], mut y: f64) -> f64 {
    let mut x = SIDE;
    for (k, (kind, count)) in kinds.iter().enumerate() {
        let words = format!("{kind} ({count})");
        let wide = 25.0 + text_width(&words, SMALL) + 14.0;
        if x > SIDE && x + wide > WIDTH - SIDE {
            (x, y) = (SIDE, y + 22.0);
        }
        canvas.rectangle([x, y - 12.0], [x + 18.0, y + 2.0], REGIONS[k % REGIONS.len()]);
        canvas.text([x + 25.0, y], &words, SMALL, "start");
        x += wide;
    }
    for line in notes.iter().flat_map(|note| wrapped(note, SMALL, WIDTH - 2.0 * SIDE)) {
        y += 20.0;
        canvas.text([SIDE, y], &line, SMALL, "start");
    }
    y
}

/// Levels of contours: quantiles of the values, rounded, and 1 if the values reach it.
fn levels(values: &[f64]) -> Vec<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let (Some(low), Some(high)) = (sorted.first(), sorted.last()) else { return Vec::new() };
    if (high - low).is_nan() || high - low <= SAME * high.abs() {
        return Vec::new();
    }
    let quantile = |share: f64| sorted[(share * (sorted.len() - 1) as f64).round() as usize];
    let middle = [quantile(QUANTILES[0]), quantile(QUANTILES[4])];
    let range = if middle[1] > middle[0] { middle[1] - middle[0] } else { high - low };
    // As many digits as tell a fiftieth of the range.
    let digits = (middle[1].abs().max(range) / range * 50.0).log10().ceil().clamp(2.0, 6.0) as usize;
    let rounded = |x: f64| format_short(x, digits).parse().unwrap_or(x);
    let one = *low <= 1.0 && *high >= 1.0;
    let mut levels: Vec<f64> = QUANTILES.iter().map(|share| rounded(quantile(*share))).collect();
    levels.retain(|level| low < level && level < high && !(one && (level - 1.0).abs() <= 0.02 * range));
    levels.extend(one.then_some(1.0));
    levels.sort_by(f64::total_cmp);
    levels.dedup();
    levels
}

impl Panel {
    fn known(&self) -> Vec<f64> {
        self.values.iter().flatten().flatten().copied().collect()
    }

    fn described(&self) -> String {
        let (low, high) =
            self.known().iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(*x), h.max(*x)));
        match low <= high {
            true => format!("{}: from {} to {}", self.title, format_short(low, 4), format_short(high, 4)),
            false => format!("{}: no value", self.title),
        }
    }

    fn draw(
        &self,
        canvas: &mut Canvas,
        map: &MapAxes,
        kinds: &[(&str, usize)],
        [left, top]: Spot,
        [width, height]: [f64; 2],
    ) {
        let (x_axis, y_axis) = (Swept::new(&map.x_values), Swept::new(&map.y_values));
        let (x, y) = (x_axis.scale([left, left + width]), y_axis.scale([top + height, top]));
        let (xs, ys) = (x_axis.edges(), y_axis.edges());
        for (i, column) in self.regions.iter().enumerate() {
            for (j, kind) in column.iter().enumerate() {
                let colour = REGIONS[kinds.iter().position(|(own, _)| own == kind).unwrap_or(0) % REGIONS.len()];
                let (a, b) = ([x.at(xs[i]), x.at(xs[i + 1])], [y.at(ys[j]), y.at(ys[j + 1])]);
                let low = [a[0].min(a[1]), b[0].min(b[1])];
                // A hair wider, so that no light lines show between cells.
                canvas.rectangle(low, [a[0].max(a[1]) + 0.3, b[0].max(b[1]) + 0.3], colour);
            }
        }
        for (i, &at) in map.x_values.iter().enumerate() {
            for (j, &up) in map.y_values.iter().enumerate() {
                let colour = if self.values[i][j].is_some() { FAINT } else { MISSING };
                let (px, py) = (x.at(at), y.at(up));
                canvas.rectangle([px - 1.2, py - 1.2], [px + 1.2, py + 1.2], colour);
            }
        }
        self.contours(canvas, (&x_axis, &x), (&y_axis, &y));
        frame(canvas, map, &x, &y, [left, top, left + width, top + height]);
    }

    fn contours(&self, canvas: &mut Canvas, (x_axis, x): (&Swept, &Scale), (y_axis, y): (&Swept, &Scale)) {
        let same = |value: f64| if (value - 1.0).abs() <= SAME { 1.0 } else { value };
        let values: Vec<Vec<Option<f64>>> =
            self.values.iter().map(|column| column.iter().map(|value| value.map(same)).collect()).collect();
        let known: Vec<f64> = values.iter().flatten().flatten().copied().collect();
        let below_one = known.iter().any(|value| *value < 1.0);
        let mut labels: Vec<Spot> = Vec::new();
        for level in levels(&known) {
            // If no value is below 1, the contour is the edge of the region where the two loads agree.
            let (at, dash) = match level == 1.0 {
                true if below_one => (1.0, "6 3"),
                true => (1.0 + SAME, "6 3"),
                false => (level, ""),
            };
            let place = |[a, b]: Spot| [x.at(x_axis.value(a)), y.at(y_axis.value(b))];
            let segments = contour(&x_axis.places(), &y_axis.places(), &values, at).into_iter();
            let segments: Vec<[Spot; 2]> = segments.map(|ends| ends.map(place)).collect();
            for ends in &segments {
                canvas.line(ends, INK, if level == 1.0 { 2.4 } else { 1.5 }, dash);
            }
            // One number per level, where it is farthest from those of the others and from the frame.
            let middle = |ends: &[Spot; 2]| [(ends[0][0] + ends[1][0]) / 2.0, (ends[0][1] + ends[1][1]) / 2.0];
            let room = |spot: &Spot| {
                let others = labels.iter().map(|l: &Spot| (l[0] - spot[0]).hypot(l[1] - spot[1]));
                let sides = [(x, spot[0]), (y, spot[1])].map(|(axis, at)| axis.from_ends(at));
                others.chain(sides.map(|side| 2.0 * side)).fold(f64::INFINITY, f64::min)
            };
            let best = segments.iter().map(middle).max_by(|a, b| room(a).total_cmp(&room(b)));
            if let Some(spot) = best.filter(|spot| room(spot) > 24.0) {
                labels.push(spot);
                canvas.edged([spot[0], spot[1] + 4.5], &format_short(level, 6), (SMALL, "middle", INK), level == 1.0);
            }
        }
    }
}

fn frame(canvas: &mut Canvas, map: &MapAxes, x: &Scale, y: &Scale, [left, top, right, bottom]: [f64; 4]) {
    let count = if right - left > 400.0 { 8 } else { 4 };
    for tick in x.ticks(count) {
        canvas.line(&[[x.at(tick), bottom], [x.at(tick), bottom + 5.0]], INK, 1.0, "");
        canvas.text([x.at(tick), bottom + 20.0], &x.label(tick), SMALL, "middle");
    }
    for tick in y.ticks(count) {
        canvas.line(&[[left - 5.0, y.at(tick)], [left, y.at(tick)]], INK, 1.0, "");
        canvas.text([left - 9.0, y.at(tick) + 4.5], &y.label(tick), SMALL, "end");
    }
    canvas.line(&[[left, top], [right, top], [right, bottom], [left, bottom], [left, top]], INK, 1.0, "");
    canvas.text([(left + right) / 2.0, bottom + 42.0], &map.x_label, SMALL, "middle");
    canvas.upright([left - 50.0, (top + bottom) / 2.0], &map.y_label, SMALL);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_quantiles_and_one() {
        let values: Vec<f64> = (0..=100).map(|i| 0.9 + 0.004 * f64::from(i)).collect();
        assert_eq!(levels(&values), [0.94, 1.0, 1.02, 1.1, 1.18, 1.26]);
        // One value far above the others takes no level from them.
        let skewed: Vec<f64> = (0..100).map(|i| 1.0 + 1e-3 * f64::from(i)).chain([90.0]).collect();
        assert!(levels(&skewed).len() > 1 && levels(&skewed).contains(&1.0));
        assert!(levels(&[2.0, 2.0]).is_empty() && levels(&[]).is_empty());
    }
}
