//! Line charts, as SVG: markers and lines, legend below the axes so that it never covers data.

use super::axis::{Scale, range};
use super::colours::{GRID, INK, line};
use super::series::{ChartStyle, Marker, Series};
use super::svg::{Canvas, SMALL, TITLE, WIDTH};
use super::text::{Area, Spot as Place, text_width, wrapped};
use voussoir_core::number_text::format_short;

/// Height of the box of the axes with its labels \[px\].
const PLOT: f64 = 440.0;
const ROW: f64 = 22.0;
const LEFT: f64 = 84.0;
const RIGHT: f64 = WIDTH - 22.0;
/// Left end of the legend \[px\].
const MARGIN: f64 = 24.0;
/// Dashes of lines, so that they are told apart in grey.
const DASHES: [&str; 5] = ["", "9 4", "2.5 3", "12 4 2.5 4", "6 3"];

/// The chart, as SVG. Points that are not finite are left out.
pub fn chart_svg(title: &str, x_label: &str, y_label: &str, series: &[Series], notes: &[String]) -> String {
    chart(title, x_label, y_label, series, notes, &ChartStyle::default())
}

/// The chart with axes as `style` says.
pub fn chart(
    title: &str,
    x_label: &str,
    y_label: &str,
    series: &[Series],
    notes: &[String],
    style: &ChartStyle,
) -> String {
    let abscissas = series
        .iter()
        .flat_map(|s| s.points.iter().chain(&s.open_points).map(|p| p.0).chain(s.ends.iter().map(|end| end.0)));
    let Some(horizontal) = range(abscissas, style.log[0]) else {
        let mut canvas = Canvas::default();
        canvas.text([10.0, 35.0], "no chart: no finite point", SMALL, "start");
        return canvas.finish([WIDTH, 60.0], title, "This chart has no finite point.");
    };
    let (vertical, broken) = vertical_range(series, style.log[1]);
    let mut lines: Vec<String> = notes.to_vec();
    lines.extend(broken.then(|| "The vertical axis does not begin at zero.".to_string()));
    let described = lines.join(" ");
    let lines: Vec<String> = lines.iter().flat_map(|note| wrapped(note, SMALL, WIDTH - 2.0 * MARGIN)).collect();
    let mut canvas = Canvas::default();
    let head = canvas.title(&wrapped(title, TITLE, WIDTH - 2.0 * MARGIN), WIDTH);
    let frame = Frame {
        x: Scale::new(horizontal, [LEFT, RIGHT], style.log[0]),
        y: Scale::new(vertical, [head + PLOT - 54.0, head + 8.0], style.log[1]),
        top: head + 8.0,
        bottom: head + PLOT - 54.0,
    };
    let legend = Legend::new(series);
    canvas.open(&[("class", &"plot"), ("data-x", &frame.x.describe()), ("data-y", &frame.y.describe())]);
    frame.draw(&mut canvas, x_label, y_label);
    frame.curves(&mut canvas, series);
    frame.marks(&mut canvas, series);
    canvas.close();
    let base = head + PLOT + 14.0;
    legend.draw(&mut canvas, series, base);
    for (i, line) in lines.iter().enumerate() {
        canvas.text([MARGIN, base + 5.0 + ROW * (legend.row + 1.0) + 20.0 * i as f64], line, SMALL, "start");
    }
    let height = head + PLOT + ROW * (legend.row + 1.0) + 20.0 * lines.len() as f64 + 18.0;
    let axes = format!("{x_label} {}; {y_label} {}", frame.x.ends(), frame.y.ends());
    let alternative = format!("A line chart. Axes: {axes}. Lines: {}. {described}", described_lines(series));
    canvas.finish([WIDTH, height], title, alternative.trim_end())
}

/// Each line with its first, greatest and last value.
fn described_lines(series: &[Series]) -> String {
    let line = |own: &Series| {
        let at = |point: &(f64, f64)| format!("{} at {}", format_short(point.1, 4), format_short(point.0, 4));
        let finite = || own.points.iter().filter(|(x, y)| x.is_finite() && y.is_finite());
        let greatest = finite().max_by(|a, b| a.1.total_cmp(&b.1));
        match (finite().next(), greatest, finite().next_back()) {
            (Some(first), Some(greatest), Some(last)) => {
                format!("{}: from {}, greatest {}, to {}", own.name, at(first), at(greatest), at(last))
            }
            _ => format!("{}: no finite value", own.name),
        }
    };
    series.iter().map(line).collect::<Vec<_>>().join("; ")
}

/// The parts of a line between open points.
fn unbroken(series: &Series) -> Vec<Vec<(f64, f64)>> {
    let mut parts: Vec<Vec<(f64, f64)>> = vec![Vec::new()];
    for &point in series.points.iter().filter(|(x, y)| x.is_finite() && y.is_finite()) {
        let part = parts.last_mut().expect("there is always a part");
        let between = |last: f64| series.open_points.iter().any(|&(x, _)| last < x && x < point.0);
        if part.last().is_some_and(|last| between(last.0)) {
            parts.push(vec![point]);
        } else {
            part.push(point);
        }
    }
    parts
}

/// Least and greatest ordinate of the axis, and whether it does not begin at zero.
fn vertical_range(series: &[Series], log: bool) -> ([f64; 2], bool) {
    let ordinates = series.iter().flat_map(|s| {
        let ends = s.ends.iter().flat_map(|end| [end.1, end.2]).flatten();
        s.points.iter().map(|p| p.1).chain(ends)
    });
    let [low, high] = range(ordinates, log).unwrap_or([if log { 1.0 } else { 0.0 }, if log { 10.0 } else { 1.0 }]);
    let open = series.iter().any(|s| !s.open_points.is_empty());
    if log {
        return ([low, if open { high * (high / low).powf(0.12) } else { high }], false);
    }
    // Values that lie close together would be one line on an axis from zero.
    if !open && low > 0.8 * high && high > low {
        return ([low - 0.2 * (high - low), high + 0.05 * (high - low)], true);
    }
    let bottom = if low > -0.05 * high { 0.0 } else { low };
    ([bottom, high + if open { 0.12 * (high - low.min(0.0)) } else { 0.0 }], false)
}

/// Axes with the box that they span \[px\].
struct Frame {
    x: Scale,
    y: Scale,
    top: f64,
    bottom: f64,
}

impl Frame {
    fn place(&self, (x, y): (f64, f64)) -> Option<Place> {
        let place = [self.x.at(x), self.y.at(y)];
        place.iter().all(|c| c.is_finite()).then_some(place)
    }

    fn draw(&self, canvas: &mut Canvas, x_label: &str, y_label: &str) {
        let mut last = f64::NEG_INFINITY;
        for tick in self.x.ticks(10) {
            let x = self.x.at(tick);
            canvas.line(&[[x, self.top], [x, self.bottom]], GRID, 1.0, "");
            let words = self.x.label(tick);
            let half = text_width(&words, SMALL) / 2.0;
            if x - half > last + 4.0 {
                canvas.text([x, self.bottom + 19.0], &words, SMALL, "middle");
                last = x + half;
            }
        }
        for tick in self.y.ticks(8) {
            let y = self.y.at(tick);
            canvas.line(&[[LEFT, y], [RIGHT, y]], GRID, 1.0, "");
            canvas.text([LEFT - 8.0, y + 5.0], &self.y.label(tick), SMALL, "end");
        }
        canvas.line(&[[LEFT, self.top], [LEFT, self.bottom]], INK, 1.2, "");
        canvas.line(&[[LEFT, self.bottom], [RIGHT, self.bottom]], INK, 1.2, "");
        canvas.text([(LEFT + RIGHT) / 2.0, self.bottom + 42.0], x_label, SMALL, "middle");
        canvas.upright([20.0, (self.top + self.bottom) / 2.0], y_label, SMALL);
    }

    fn curves(&self, canvas: &mut Canvas, series: &[Series]) {
        for (i, own) in series.iter().enumerate() {
            let finite = own.points.iter().filter(|point| self.place(**point).is_some());
            canvas.open_series(&own.name, &own.cases, &finite.copied().collect::<Vec<_>>());
            for part in unbroken(own).into_iter().filter(|_| !own.unjoined) {
                let spots: Vec<Place> = part.into_iter().filter_map(|point| self.place(point)).collect();
                if spots.len() > 1 {
                    canvas.line(&spots, line(i), 2.0, DASHES[i % DASHES.len()]);
                }
            }
            if own.spots.is_none() || own.dots || own.unjoined {
                for spot in own.points.iter().filter_map(|point| self.place(*point)) {
                    canvas.mark(i, spot);
                }
            }
            canvas.close();
        }
    }

    /// What stands on the lines: spots with their labels, and arrows at the upper edge for unbounded cases.
    fn marks(&self, canvas: &mut Canvas, series: &[Series]) {
        // Arrows of several series at one abscissa stand side by side.
        let with_open: Vec<usize> = (0..series.len()).filter(|&i| !series[i].open_points.is_empty()).collect();
        for (i, own) in series.iter().enumerate() {
            let beside = with_open.iter().position(|&j| j == i).unwrap_or(0) as f64;
            let beside = 15.0 * beside - 7.5 * (with_open.len() as f64 - 1.0);
            for &(x, _) in own.open_points.iter().filter(|(x, _)| self.x.at(*x).is_finite()) {
                arrow(canvas, i, [self.x.at(x) + beside, self.top + 2.0], 1.0);
            }
            for &(x, lower, upper) in &own.ends {
                // An arrow starts at its end and points to where the value lies.
                for (end, sense) in [(lower, 1.0), (upper, -1.0)] {
                    let Some([x, y]) = end.and_then(|end| self.place((x, end))) else { continue };
                    arrow(canvas, i, [x, y - ARROW * sense], sense);
                }
            }
            for spot in own.spots.iter().flatten() {
                let Some([x, y]) = self.place(spot.at) else { continue };
                symbol(canvas, [x, y], spot.marker, line(i));
            }
        }
        self.labels(canvas, series);
    }

    /// The labels of spots, beside them: each at the first of the places around it where it covers no other, else where it covers
    /// least.
    fn labels(&self, canvas: &mut Canvas, series: &[Series]) {
        let mut taken: Vec<Area> = Vec::new();
        for spot in series.iter().flat_map(|own| own.spots.iter().flatten()).filter(|spot| !spot.label.is_empty()) {
            let Some([x, y]) = self.place(spot.at) else { continue };
            let left = x - 4.0 - text_width(&spot.label, SMALL);
            let around =
                [13.0, -7.0, 28.0, -22.0].iter().flat_map(|down| [[x + 10.0, y + down], [left, y + down + 7.0]]);
            let area = |at: Place| Area::of_text(at, "start", SMALL, &spot.label);
            let inside = |at: &Place| {
                let Area { low, high } = area(*at);
                low[0] >= LEFT && high[0] < WIDTH - 6.0 && low[1] >= self.top && high[1] <= self.bottom
            };
            let covered = |at: &Place| taken.iter().map(|other| area(*at).shared(other)).sum::<f64>();
            let best = around.filter(inside).min_by(|a, b| covered(a).total_cmp(&covered(b)));
            let at = best.unwrap_or([x + 10.0, y + 13.0]);
            taken.push(area(at));
            canvas.edged(at, &spot.label, (SMALL, "start", INK), false);
        }
    }
}

/// The mark of an unbounded case, from its tip.
fn arrow(canvas: &mut Canvas, index: usize, [x, y]: Place, sense: f64) {
    let corners = [[0.0, 0.0], [7.0, 9.0], [3.0, 9.0], [3.0, ARROW], [-3.0, ARROW], [-3.0, 9.0], [-7.0, 9.0]];
    let spots: Vec<Place> = corners.iter().map(|c| [x + c[0], y + sense * c[1]]).collect();
    canvas.polygon(&spots, line(index), "", "");
}

fn symbol(canvas: &mut Canvas, [x, y]: Place, marker: Marker, colour: &str) {
    match marker {
        Marker::Ring => canvas.circle([x, y], 9.0, "none", colour, 2.0),
        Marker::Dot => {
            let on = |i: u32| {
                let angle = f64::from(i) * std::f64::consts::FRAC_PI_4 + std::f64::consts::FRAC_PI_8;
                [x + 5.4 * angle.cos(), y + 5.4 * angle.sin()]
            };
            canvas.polygon(&(0..8).map(on).collect::<Vec<_>>(), colour, "", "");
        }
        Marker::Square => {
            canvas.polygon(
                &[[x - 4.5, y - 4.5], [x + 4.5, y - 4.5], [x + 4.5, y + 4.5], [x - 4.5, y + 4.5]],
                colour,
                "",
                "",
            );
        }
    }
}

/// Length of an arrow [px].
const ARROW: f64 = 19.0;

/// What an entry of the legend explains.
enum Entry {
    Line(usize),
    Open(usize),
    End(usize),
    Kind(Marker),
}

/// The legend: lines, marks of unbounded cases, then kinds of spots, each with its words, place and row.
struct Legend {
    entries: Vec<(Entry, String, Place)>,
    /// The last row.
    row: f64,
}

impl Legend {
    fn new(series: &[Series]) -> Self {
        let mut kinds: Vec<(&str, Marker)> = Vec::new();
        for spot in series.iter().flat_map(|s| s.spots.iter().flatten()) {
            if !kinds.contains(&(spot.kind, spot.marker)) {
                kinds.push((spot.kind, spot.marker));
            }
        }
        kinds.sort_unstable_by_key(|(kind, _)| *kind);
        let lines = series.iter().enumerate().map(|(i, s)| (Entry::Line(i), s.name.clone()));
        let open = series.iter().enumerate().filter(|(_, s)| !s.open_points.is_empty()).map(|(i, s)| {
            (Entry::Open(i), if series.len() > 1 { format!("{}: unbounded", s.name) } else { "unbounded".into() })
        });
        let ends = series.iter().enumerate().filter(|(_, s)| !s.ends.is_empty()).map(|(i, s)| {
            let words = "open: only an end is proved";
            (Entry::End(i), if series.len() > 1 { format!("{}: {words}", s.name) } else { words.into() })
        });
        let spots = kinds.into_iter().map(|(words, marker)| (Entry::Kind(marker), words.to_string()));
        let (mut x, mut row) = (MARGIN, 0.0);
        let mut entries = Vec::new();
        for (entry, words) in lines.chain(open).chain(ends).chain(spots) {
            let width = 46.0 + text_width(&words, SMALL) + 24.0;
            if x > MARGIN && x + width > WIDTH - 20.0 {
                (x, row) = (MARGIN, row + 1.0);
            }
            entries.push((entry, words, [x, row]));
            x += width;
        }
        Legend { entries, row }
    }

    fn draw(&self, canvas: &mut Canvas, series: &[Series], base: f64) {
        for (entry, words, [x, row]) in &self.entries {
            let y = base + row * ROW;
            match entry {
                Entry::Kind(marker) => symbol(canvas, [x + 26.0, y], *marker, INK),
                Entry::Open(i) | Entry::End(i) => arrow(canvas, *i, [x + 16.0, y - 10.0], 1.0),
                Entry::Line(i) => {
                    let own = &series[*i];
                    if !own.unjoined {
                        let ends = [[*x, y], [x + 34.0, y]];
                        canvas.line(&ends, line(*i), 2.0, DASHES[i % DASHES.len()]);
                    }
                    if own.spots.is_none() || own.dots || own.unjoined {
                        canvas.mark(*i, [x + 17.0, y]);
                    }
                }
            }
            canvas.text([x + 42.0, y + 5.0], words, SMALL, "start");
        }
    }
}
