//! The figure of a comparison: for each scene the ratios of all variants to the reference.

use voussoir_core::limit::Status;
use voussoir_plot::axis::Axis;
use voussoir_plot::colours::{FAINT, GRID, INK, QUIET, STRIPE, line};
use voussoir_plot::number::tick_label;
use voussoir_plot::svg::{Canvas, SMALL, TITLE, WIDTH};
use voussoir_plot::text::{text_width, wrapped};
use voussoir_study::results::format::{format_number, snap_words, status_word};
use voussoir_study::results::{Comparison, ComparisonCell, ComparisonRow};
use voussoir_study::study::SweptKeys;

/// Relative width from which a bracket is open.
pub const OPEN: f64 = 1e-6;

/// The bracket of a cell, where it is open and its lower end says more than "not negative".
fn telling_bracket(cell: &ComparisonCell) -> Option<[f64; 2]> {
    open_bracket(cell).filter(|[low, _]| *low > 0.0)
}

/// The bracket of a cell, where it is open.
pub fn open_bracket(cell: &ComparisonCell) -> Option<[f64; 2]> {
    let [lower, upper] = cell.bounds?;
    let ends = lower.zip(upper).map(|(low, high)| [low, high]);
    ends.filter(|[low, high]| (high - low).abs() > OPEN * high.abs().max(low.abs()))
}

/// The name of a row: its scene and its swept values.
pub fn row_name(row: &ComparisonRow, keys: &SweptKeys) -> String {
    let swept = Some(keys.text(&row.parameters)).filter(|text| !text.is_empty());
    let parts: Vec<String> = row.scene.iter().cloned().chain(swept).collect();
    if parts.is_empty() { "the scene".into() } else { parts.join(", ") }
}

/// Why a cell has no number or, where it has one, what kind of number; empty for a collapse.
pub fn remark(cell: &ComparisonCell) -> String {
    match (cell.status, &cell.flow_read_as) {
        (None, _) => "not answered".into(),
        (Some(Status::Collapse), Some(flow)) => format!("flow read as {flow}"),
        (Some(Status::Collapse), None) => String::new(),
        (Some(status), _) => status_word(status).replace('_', " "),
    }
}

/// Where the rows of the figure stand.
struct Rows<'a> {
    axis: &'a Axis,
    top: f64,
    row_height: f64,
    /// Left end of the plot.
    left: f64,
    /// Right end of the plot.
    right_of: f64,
    remark_width: f64,
}

impl Rows<'_> {
    /// Row `i`: its name, the bracket and ratio of each variant, and its remarks.
    fn draw(
        &self,
        canvas: &mut Canvas,
        i: usize,
        (row, brackets): (&ComparisonRow, &[Option<[f64; 2]>]),
        name: &[String],
        remarks: &str,
    ) {
        let middle = self.top + self.row_height * i as f64 + self.row_height / 2.0;
        for (line, words) in name.iter().enumerate() {
            let shift = 16.0 * (line as f64 - (name.len() as f64 - 1.0) / 2.0);
            canvas.text([self.left - 14.0, middle + shift + 4.5], words, SMALL, "end");
        }
        for (variant, (cell, bracket)) in row.cells.iter().zip(brackets).enumerate() {
            let at = middle + 12.0 * (variant as f64 - (row.cells.len() as f64 - 1.0) / 2.0);
            let colour = line(variant);
            if let Some([a, b]) = bracket.filter(|ends| ends.iter().all(|x| x.is_finite())) {
                let (a, b) = (self.axis.at(a), self.axis.at(b));
                canvas.line(&[[a, at], [b, at]], colour, 3.0, "");
                canvas.line(&[[a, at - 4.0], [a, at + 4.0]], colour, 2.0, "");
            }
            if let Some(ratio) = cell.ratio {
                canvas.mark(variant, [self.axis.at(ratio), at]);
            }
        }
        let lines = wrapped(remarks, SMALL, self.remark_width);
        for (line, words) in lines.iter().enumerate() {
            let shift = 16.0 * (line as f64 - (lines.len() as f64 - 1.0) / 2.0);
            canvas.text([self.right_of + 12.0, middle + shift + 4.0], words, SMALL, "start");
        }
    }
}

/// The figure; `None` where no variant has a ratio.
pub fn comparison_svg(study: &str, comparison: &Comparison, keys: &SweptKeys) -> Option<String> {
    let base = |row: &ComparisonRow| {
        let cell = row.cells.get(comparison.variants.iter().position(|variant| *variant == comparison.reference)?)?;
        cell.load_factor.filter(|factor| *factor > 0.0)
    };
    let bracket = |row: &ComparisonRow, cell: &ComparisonCell| {
        Some(telling_bracket(cell)?.map(|x| x / base(row).unwrap_or(f64::NAN)))
    };
    let cells = || comparison.rows.iter().flat_map(|row| row.cells.iter().map(move |cell| (row, cell)));
    let values = cells().flat_map(|(row, cell)| cell.ratio.into_iter().chain(bracket(row, cell).into_iter().flatten()));
    let (low, high) = values
        .filter(|x| x.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    if low > high {
        return None;
    }
    let margin = (0.04 * (high - low)).max(0.01);
    let low = if low - margin < 0.1 * high { 0.0 } else { low - margin };
    let names: Vec<Vec<String>> =
        comparison.rows.iter().map(|row| wrapped(&row_name(row, keys), SMALL, 170.0)).collect();
    let widest = names.iter().flatten().map(|line| text_width(line, SMALL)).fold(60.0, f64::max);
    let remarks: Vec<String> = comparison.rows.iter().map(|row| row_remarks(comparison, row)).collect();
    let longest = remarks.iter().map(|words| text_width(words, SMALL)).fold(30.0, f64::max);
    let (left, right) = (widest + 30.0, longest.min(190.0) + 20.0);
    let (width, plot) = (WIDTH, WIDTH - left - right);
    let axis = Axis { values: [low, high + margin], places: [left, left + plot] };
    let lines = |words: &String| wrapped(words, SMALL, right - 16.0).len();
    let most = names.iter().map(Vec::len).chain(remarks.iter().map(lines)).max().unwrap_or(1) as f64;
    let row_height = (12.0 * comparison.variants.len() as f64 + 12.0).max(16.0 * most + 8.0).max(34.0);
    let title = format!("{study}: load factor over that of \"{}\"", comparison.reference);
    let mut canvas = Canvas::default();
    let top = 6.0 + canvas.title(&wrapped(&title, TITLE, width - 40.0), width);
    let bottom = top + row_height * comparison.rows.len() as f64;
    for (i, _) in comparison.rows.iter().enumerate().filter(|(i, _)| i % 2 == 0) {
        let y = top + row_height * i as f64;
        canvas.rectangle([8.0, y], [width - 8.0, y + row_height], STRIPE);
    }
    for tick in axis.ticks(7) {
        let x = axis.at(tick);
        canvas.line(&[[x, top], [x, bottom]], if tick == 1.0 { FAINT } else { GRID }, 1.0, "");
        canvas.text([x, bottom + 18.0], &tick_label(tick), SMALL, "middle");
    }
    canvas.line(&[[left, bottom], [left + plot, bottom]], INK, 1.0, "");
    let axis_name = format!("load factor / load factor of \"{}\" [-]", comparison.reference);
    canvas.text([left + plot / 2.0, bottom + 40.0], &axis_name, SMALL, "middle");
    let layout = Rows { axis: &axis, top, row_height, left, right_of: left + plot, remark_width: right - 16.0 };
    for (i, row) in comparison.rows.iter().enumerate() {
        let brackets: Vec<_> = row.cells.iter().map(|cell| bracket(row, cell)).collect();
        layout.draw(&mut canvas, i, (row, &brackets), &names[i], &remarks[i]);
    }
    let mut legend = bottom + 66.0;
    let mut x = 24.0;
    for (variant, name) in comparison.variants.iter().enumerate() {
        let wide = 26.0 + text_width(name, SMALL) + 18.0;
        if x > 24.0 && x + wide > width - 20.0 {
            (x, legend) = (24.0, legend + 22.0);
        }
        canvas.mark(variant, [x + 8.0, legend - 4.5]);
        canvas.text([x + 22.0, legend], name, SMALL, "start");
        x += wide;
    }
    if cells().any(|(_, cell)| cell.ratio.is_some() && telling_bracket(cell).is_some()) {
        legend += 22.0;
        canvas.line(&[[24.0, legend - 4.5], [58.0, legend - 4.5]], QUIET, 3.0, "");
        canvas.line(&[[24.0, legend - 8.5], [24.0, legend - 0.5]], QUIET, 2.0, "");
        canvas.text([68.0, legend], "from the proved lower bound to the load found, where they differ", SMALL, "start");
    }
    let rows: Vec<String> = comparison.rows.iter().map(|row| described(comparison, row, keys)).collect();
    let alternative = format!("For each scene the ratio of every variant. {}.", rows.join("; "));
    Some(canvas.finish([width, legend + 18.0], &title, &alternative))
}

/// The ratios of a row in words.
fn described(comparison: &Comparison, row: &ComparisonRow, keys: &SweptKeys) -> String {
    let ratio =
        |(variant, cell): (&String, &ComparisonCell)| Some(format!("{variant} {}", format_number(cell.ratio?, 4)));
    let ratios: Vec<String> = comparison.variants.iter().zip(&row.cells).filter_map(ratio).collect();
    format!("{}: {}", row_name(row, keys), ratios.join(", "))
}

/// The load factor of the reference, and what variants without a collapse say.
fn row_remarks(comparison: &Comparison, row: &ComparisonRow) -> String {
    let reference = comparison.variants.iter().position(|variant| *variant == comparison.reference);
    let base = reference.and_then(|i| {
        let cell = row.cells.get(i)?;
        let digits = |x: f64| format_number(x, 4);
        let snaps = snap_words(cell.load_factor, cell.first_limit_point, digits);
        snaps.map(|words| format!("{} {words}", comparison.reference)).or_else(|| {
            let factor = cell.load_factor.map(digits)?;
            Some(format!("{} = {factor}", comparison.reference))
        })
    });
    let others = row.cells.iter().zip(&comparison.variants).filter_map(|(cell, variant)| {
        let words = remark(cell);
        (!words.is_empty()).then(|| format!("{variant}: {words}"))
    });
    base.into_iter().chain(others).collect::<Vec<_>>().join("; ")
}
