//! Line charts, as SVG: markers and lines, legend below the axes so that it never covers data.

use super::text_layout::{text_width, wrapped};
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::error::Error;

/// One line of a chart.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Series {
    /// For the legend.
    pub name: String,
    /// By growing abscissa.
    pub points: Vec<(f64, f64)>,
    /// Points without an ordinate (unbounded), shown at the top edge; only abscissas count.
    pub open_points: Vec<(f64, f64)>,
    /// What is marked instead of every point: the line is then drawn in the order of its points.
    pub spots: Option<Vec<Spot>>,
}

/// How a place is marked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Marker {
    /// A filled octagon.
    Dot,
    /// A filled square.
    Square,
    /// A circle around what else is there.
    Ring,
}

/// A marked place of a line.
#[derive(Debug, Clone, PartialEq)]
pub struct Spot {
    /// Where.
    pub at: (f64, f64),
    /// What, for the legend: a kind has one marker.
    pub kind: &'static str,
    /// How it is drawn.
    pub marker: Marker,
    /// Written beside it.
    pub label: String,
}

const WIDTH: u32 = 900;
const PLOT: u32 = 480;
const ROW: u32 = 24;
const INK: RGBColor = RGBColor(34, 34, 34);
const GRID: RGBColor = RGBColor(225, 225, 225);
/// Okabe and Ito (2008), told apart by colour-blind readers.
const PALETTE: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(230, 159, 0),
    RGBColor(0, 0, 0),
];

type Canvas<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// The chart, as SVG. Points that are not finite are left out.
pub fn chart_svg(title: &str, x_label: &str, y_label: &str, series: &[Series], notes: &[String]) -> String {
    let mut text = String::new();
    match draw(&mut text, title, x_label, y_label, series, notes) {
        Ok(()) => text,
        Err(error) => format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"60\"><text x=\"10\" y=\"35\">{}</text></svg>",
            super::format::escape(&format!("no chart: {error}"))
        ),
    }
}

/// Offsets of a marker's corners \[px\].
fn corners(kind: usize) -> Vec<(i32, i32)> {
    match kind % 5 {
        0 => vec![(-2, -5), (2, -5), (5, -2), (5, 2), (2, 5), (-2, 5), (-5, 2), (-5, -2)],
        1 => vec![(-4, -4), (4, -4), (4, 4), (-4, 4)],
        2 => vec![(0, -6), (5, 4), (-5, 4)],
        3 => vec![(0, -6), (6, 0), (0, 6), (-6, 0)],
        _ => vec![(0, 6), (5, -4), (-5, -4)],
    }
}

/// Corners of the mark for an unbounded case, from its tip \[px\].
const ARROW: [(i32, i32); 7] = [(0, 0), (7, 9), (3, 9), (3, 19), (-3, 19), (-3, 9), (-7, 9)];

fn mark(area: &Canvas, at: (i32, i32), corners: &[(i32, i32)], colour: RGBColor) -> Result<(), Box<dyn Error>> {
    let spots: Vec<(i32, i32)> = corners.iter().map(|(x, y)| (at.0 + x, at.1 + y)).collect();
    area.draw(&Polygon::new(spots, colour.filled()))?;
    Ok(())
}

fn symbol(area: &Canvas, at: (i32, i32), marker: Marker, colour: RGBColor) -> Result<(), Box<dyn Error>> {
    match marker {
        Marker::Dot => mark(area, at, &corners(0), colour),
        Marker::Square => mark(area, at, &corners(1), colour),
        Marker::Ring => Ok(area.draw(&Circle::new(at, 9, colour.stroke_width(2)))?),
    }
}

fn write(area: &Canvas, at: (i32, i32), words: &str, size: u32, centred: bool) -> Result<(), Box<dyn Error>> {
    let place = Pos::new(if centred { HPos::Center } else { HPos::Left }, VPos::Center);
    area.draw(&Text::new(words.to_string(), at, ("sans-serif", size).into_font().color(&INK).pos(place)))?;
    Ok(())
}

/// Least and greatest value with a margin of 4 %; a single value gets one of 10 %.
fn range(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    let (low, high) =
        values.filter(|x| x.is_finite()).fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
    if low > high {
        return None;
    }
    let margin = if high > low { 0.04 * (high - low) } else { 0.1 * high.abs().max(1e-9) };
    Some((low - margin, high + margin))
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
fn vertical_range(series: &[Series]) -> (f64, f64, bool) {
    let ordinates = series.iter().flat_map(|s| s.points.iter().map(|p| p.1));
    let (low, high) = range(ordinates).unwrap_or((0.0, 1.0));
    let open = series.iter().any(|s| !s.open_points.is_empty());
    // Values that lie close together would be one line on an axis from zero.
    if !open && low > 0.8 * high && high > low {
        return (low - 0.2 * (high - low), high + 0.05 * (high - low), true);
    }
    let bottom = if low > -0.05 * high { 0.0 } else { low };
    (bottom, high + if open { 0.12 * (high - low.min(0.0)) } else { 0.0 }, false)
}

/// The legend: lines, marks of unbounded cases, then kinds of spots, each with its place and row.
struct Legend<'a> {
    kinds: Vec<(&'a str, Marker)>,
    /// Index of the series or kind, whether it is a mark of unbounded cases, words.
    entries: Vec<(usize, bool, String)>,
    /// How many entries are series.
    lines_end: usize,
    /// x and row of each entry.
    places: Vec<(i32, i32)>,
    /// The last row.
    row: i32,
}

impl<'a> Legend<'a> {
    fn new(series: &'a [Series]) -> Self {
        let mut kinds: Vec<(&str, Marker)> = Vec::new();
        for spot in series.iter().flat_map(|s| s.spots.iter().flatten()) {
            if !kinds.contains(&(spot.kind, spot.marker)) {
                kinds.push((spot.kind, spot.marker));
            }
        }
        kinds.sort_unstable_by_key(|(kind, _)| *kind);
        let open = series.iter().enumerate().filter(|(_, s)| !s.open_points.is_empty()).map(|(i, s)| {
            (i, true, if series.len() > 1 { format!("{}: unbounded", s.name) } else { "unbounded".into() })
        });
        let mut entries: Vec<(usize, bool, String)> =
            series.iter().enumerate().map(|(i, s)| (i, false, s.name.clone())).chain(open).collect();
        let lines_end = entries.len();
        entries.extend(kinds.iter().enumerate().map(|(kind, (words, _))| (kind, false, words.to_string())));
        let (mut places, mut x, mut row) = (Vec::new(), 70, 0);
        for (_, _, words) in &entries {
            let width = 46 + text_width(words, 14.0) as i32 + 24;
            if x > 70 && x + width > WIDTH as i32 - 20 {
                (x, row) = (70, row + 1);
            }
            places.push((x, row));
            x += width;
        }
        Legend { kinds, entries, lines_end, places, row }
    }

    fn draw(&self, root: &Canvas, series: &[Series], base: i32) -> Result<(), Box<dyn Error>> {
        for (entry, ((i, is_open, words), (x, row))) in self.entries.iter().zip(&self.places).enumerate() {
            let (y, colour) = (base + *row * ROW as i32, PALETTE[i % PALETTE.len()]);
            let line = || PathElement::new(vec![(*x, y), (x + 32, y)], colour.stroke_width(2));
            if entry >= self.lines_end {
                symbol(root, (x + 26, y), self.kinds[*i].1, INK)?;
            } else if series[*i].spots.is_some() {
                root.draw(&line())?;
            } else if *is_open {
                mark(root, (x + 16, y - 10), &ARROW, colour)?;
            } else {
                root.draw(&line())?;
                mark(root, (x + 16, y), &corners(*i), colour)?;
            }
            write(root, (x + 42, y), words, 14, false)?;
        }
        Ok(())
    }
}

fn draw(
    text: &mut String,
    title: &str,
    x_label: &str,
    y_label: &str,
    series: &[Series],
    notes: &[String],
) -> Result<(), Box<dyn Error>> {
    let abscissas = series.iter().flat_map(|s| s.points.iter().chain(&s.open_points).map(|p| p.0));
    let (x_low, x_high) = range(abscissas).ok_or("no finite point")?;
    let (bottom, top, broken) = vertical_range(series);
    let broken = broken.then(|| "The vertical axis does not begin at zero.".to_string());
    let legend = Legend::new(series);
    let titles = wrapped(title, 18.0, f64::from(WIDTH) - 40.0);
    let lines: Vec<String> =
        notes.iter().chain(&broken).flat_map(|note| wrapped(note, 13.0, f64::from(WIDTH) - 100.0)).collect();
    let head = 16 + ROW * titles.len() as u32;
    let height = head + PLOT + ROW * (legend.row as u32 + 1) + 20 * lines.len() as u32 + 22;

    let root = SVGBackend::with_string(text, (WIDTH, height)).into_drawing_area();
    root.fill(&WHITE)?;
    for (i, line) in titles.iter().enumerate() {
        write(&root, (WIDTH as i32 / 2, 20 + (ROW as usize * i) as i32), line, 18, true)?;
    }
    let (_, below) = root.split_vertically(head);
    let (plot, _) = below.split_vertically(PLOT);
    let mut chart = ChartBuilder::on(&plot)
        .margin_left(14)
        .margin_right(28)
        .margin_top(8)
        .x_label_area_size(54)
        .y_label_area_size(78)
        .build_cartesian_2d(x_low..x_high, bottom..top)?;
    let number = |x: &f64| super::format::format_short(if x.abs() < 1e-12 * top { 0.0 } else { *x }, 6);
    chart
        .configure_mesh()
        .x_labels(10)
        .y_labels(8)
        .max_light_lines(0)
        .bold_line_style(GRID)
        .axis_style(INK)
        .x_label_formatter(&number)
        .y_label_formatter(&number)
        .label_style(("sans-serif", 14).into_font().color(&INK))
        .axis_desc_style(("sans-serif", 15).into_font().color(&INK))
        .x_desc(x_label)
        .y_desc(y_label)
        .draw()?;
    for (i, s) in series.iter().enumerate() {
        let colour = PALETTE[i % PALETTE.len()];
        for part in unbroken(s) {
            chart.draw_series(LineSeries::new(part.iter().copied(), colour.stroke_width(2)))?;
        }
    }
    draw_marks(&root, series, top, &|point| chart.backend_coord(&point))?;
    let base = (head + PLOT) as i32 + 14;
    legend.draw(&root, series, base)?;
    for (i, line) in lines.iter().enumerate() {
        write(&root, (70, base + ROW as i32 * (legend.row + 1) + 20 * i as i32), line, 13, false)?;
    }
    root.present()?;
    Ok(())
}

/// What stands on the lines: spots with their labels, points, and arrows at the upper edge for unbounded cases.
fn draw_marks(
    root: &Canvas,
    series: &[Series],
    top: f64,
    place: &dyn Fn((f64, f64)) -> (i32, i32),
) -> Result<(), Box<dyn Error>> {
    // Arrows of several series at one abscissa stand side by side.
    let with_open: Vec<usize> = (0..series.len()).filter(|&i| !series[i].open_points.is_empty()).collect();
    let mut beside = vec![0; series.len()];
    for (place, &i) in with_open.iter().enumerate() {
        beside[i] = 15 * place as i32 - 15 * (with_open.len() as i32 - 1) / 2;
    }
    for (i, s) in series.iter().enumerate() {
        let colour = PALETTE[i % PALETTE.len()];
        for spot in s.spots.iter().flatten().filter(|spot| spot.at.0.is_finite() && spot.at.1.is_finite()) {
            let (x, y) = place(spot.at);
            symbol(root, (x, y), spot.marker, colour)?;
            let width = text_width(&spot.label, 13.0) as i32;
            let fits = x + 10 + width < WIDTH as i32 - 6;
            let at = (if fits { x + 10 } else { x - 4 - width }, y + if fits { 9 } else { 16 });
            write(root, at, &spot.label, 13, false)?;
        }
        let every = s.spots.is_none();
        for &point in s.points.iter().filter(|(x, y)| every && x.is_finite() && y.is_finite()) {
            mark(root, place(point), &corners(i), colour)?;
        }
        for &(x, _) in s.open_points.iter().filter(|(x, _)| x.is_finite()) {
            let (x, y) = place((x, top));
            mark(root, (x + beside[i], y + 2), &ARROW, colour)?;
        }
    }
    Ok(())
}
