//! Axes of charts that are drawn by hand: values to pixels, round ticks, and the few marks they need.

use super::format::{escape, format_short};
use super::text_layout::Spot;
use std::fmt::Write;

/// Okabe and Ito (2008), told apart by colour-blind readers.
pub const COLOURS: [&str; 7] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#000000"];
const INK: &str = "#222222";

/// A straight axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axis {
    /// Values at its two ends.
    pub values: [f64; 2],
    /// Places of the two ends \[px\].
    pub places: [f64; 2],
}

impl Axis {
    /// Place of a value \[px\].
    pub fn at(&self, value: f64) -> f64 {
        let share = (value - self.values[0]) / (self.values[1] - self.values[0]);
        self.places[0] + share * (self.places[1] - self.places[0])
    }

    /// Round values on the axis, about `count` of them.
    pub fn ticks(&self, count: usize) -> Vec<f64> {
        let (low, high) = (self.values[0].min(self.values[1]), self.values[0].max(self.values[1]));
        round_values(low, high, count)
    }
}

/// Multiples of 1, 2 or 5 times a power of ten within `low`..`high`, about `count` of them.
pub fn round_values(low: f64, high: f64, count: usize) -> Vec<f64> {
    let rough = (high - low) / count.max(1) as f64;
    if !(rough.is_finite() && rough > 0.0) {
        return vec![low];
    }
    let power = 10f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].into_iter().find(|m| m * power >= 0.999 * rough).unwrap_or(10.0) * power;
    let (first, last) = ((low / step - 1e-9).ceil() as i64, (high / step + 1e-9).floor() as i64);
    (first..=last).map(|i| crate::config::expand::rounded(i as f64 * step)).collect()
}

/// An SVG drawing under way.
#[derive(Debug, Default)]
pub struct Canvas {
    body: String,
}

impl Canvas {
    /// A straight line.
    pub fn line(&mut self, from: Spot, to: Spot, colour: &str, width: f64) {
        let _ = writeln!(
            self.body,
            "<line x1=\"{:.2}\" y1=\"{:.2}\" x2=\"{:.2}\" y2=\"{:.2}\" stroke=\"{colour}\" stroke-width=\"{width}\"/>",
            from[0], from[1], to[0], to[1]
        );
    }

    /// A filled rectangle.
    pub fn rectangle(&mut self, low: Spot, high: Spot, colour: &str) {
        let _ = writeln!(
            self.body,
            "<rect x=\"{:.2}\" y=\"{:.2}\" width=\"{:.2}\" height=\"{:.2}\" fill=\"{colour}\"/>",
            low[0],
            low[1],
            (high[0] - low[0]).max(0.0),
            (high[1] - low[1]).max(0.0)
        );
    }

    /// A line through spots.
    pub fn path(&mut self, spots: &[Spot], colour: &str, width: f64) {
        let points: Vec<String> = spots.iter().map(|s| format!("{:.2},{:.2}", s[0], s[1])).collect();
        let _ = writeln!(
            self.body,
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\"/>",
            points.join(" ")
        );
    }

    /// A dashed line through spots; no dashes where `dash` is empty.
    pub fn dashed(&mut self, spots: &[Spot], colour: &str, width: f64, dash: &str) {
        let points: Vec<String> = spots.iter().map(|s| format!("{:.2},{:.2}", s[0], s[1])).collect();
        let dash = if dash.is_empty() { String::new() } else { format!(" stroke-dasharray=\"{dash}\"") };
        let _ = writeln!(
            self.body,
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\" \
             stroke-linejoin=\"round\"{dash}/>",
            points.join(" ")
        );
    }

    /// A filled polygon.
    pub fn filled(&mut self, spots: &[Spot], colour: &str) {
        let points: Vec<String> = spots.iter().map(|s| format!("{:.2},{:.2}", s[0], s[1])).collect();
        let _ = writeln!(self.body, "<polygon points=\"{}\" fill=\"{colour}\"/>", points.join(" "));
    }

    /// A circle around a spot.
    pub fn ring(&mut self, at: Spot, radius: f64, colour: &str) {
        let _ = writeln!(
            self.body,
            "<circle cx=\"{:.2}\" cy=\"{:.2}\" r=\"{radius}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"2\"/>",
            at[0], at[1]
        );
    }

    /// Begins a group with these attributes; what is in them must be escaped.
    pub fn open(&mut self, attributes: &str) {
        let _ = writeln!(self.body, "<g {attributes}>");
    }

    /// Begins the group of a line of a chart: its name, the cases that its points belong to, and the values of those
    /// points for scripts.
    pub fn open_series(&mut self, name: &str, cases: &[usize], points: &[(f64, f64)]) {
        let cases: Vec<String> = cases.iter().map(usize::to_string).collect();
        let cases = if cases.is_empty() { String::new() } else { format!(" data-cases=\"{}\"", cases.join(" ")) };
        let values: Vec<String> =
            points.iter().map(|(x, y)| format!("{},{}", format_short(*x, 6), format_short(*y, 6))).collect();
        self.open(&format!(
            "class=\"series\" data-name=\"{}\"{cases} data-points=\"{}\"",
            escape(name),
            values.join(" ")
        ));
    }

    /// Ends the innermost group.
    pub fn close(&mut self) {
        self.body.push_str("</g>\n");
    }

    /// The mark of series `index`.
    pub fn mark(&mut self, index: usize, at: Spot) {
        let colour = COLOURS[index % COLOURS.len()];
        let corners: &[Spot] = match index % 5 {
            0 => &[
                [-2.0, -5.0],
                [2.0, -5.0],
                [5.0, -2.0],
                [5.0, 2.0],
                [2.0, 5.0],
                [-2.0, 5.0],
                [-5.0, 2.0],
                [-5.0, -2.0],
            ],
            1 => &[[-4.5, -4.5], [4.5, -4.5], [4.5, 4.5], [-4.5, 4.5]],
            2 => &[[0.0, -6.0], [5.5, 4.0], [-5.5, 4.0]],
            3 => &[[0.0, -6.0], [6.0, 0.0], [0.0, 6.0], [-6.0, 0.0]],
            _ => &[[0.0, 6.0], [5.5, -4.0], [-5.5, -4.0]],
        };
        let points: Vec<String> = corners.iter().map(|c| format!("{:.2},{:.2}", at[0] + c[0], at[1] + c[1])).collect();
        let _ = writeln!(
            self.body,
            "<polygon points=\"{}\" fill=\"{colour}\" stroke=\"white\" stroke-width=\"0.8\"/>",
            points.join(" ")
        );
    }

    /// Text; `anchor` is `start`, `middle` or `end`.
    pub fn text(&mut self, at: Spot, words: &str, size: f64, anchor: &str) {
        self.styled(at, words, size, anchor, "");
    }

    /// Text on a white edge, readable on any ground.
    pub fn label(&mut self, at: Spot, words: &str, size: f64) {
        self.edged(at, words, size, "middle");
    }

    /// The same with another anchor.
    pub fn edged(&mut self, at: Spot, words: &str, size: f64, anchor: &str) {
        let style = " paint-order=\"stroke\" stroke=\"white\" stroke-width=\"4\" stroke-linejoin=\"round\"";
        self.styled(at, words, size, anchor, style);
    }

    /// Text that reads upwards.
    pub fn upright(&mut self, at: Spot, words: &str, size: f64) {
        let style = format!(" transform=\"rotate(-90 {:.2} {:.2})\"", at[0], at[1]);
        self.styled(at, words, size, "middle", &style);
    }

    fn styled(&mut self, at: Spot, words: &str, size: f64, anchor: &str, style: &str) {
        let _ = writeln!(
            self.body,
            "<text x=\"{:.2}\" y=\"{:.2}\" font-size=\"{size}\" text-anchor=\"{anchor}\" fill=\"{INK}\"{style}>{}</text>",
            at[0],
            at[1],
            escape(words)
        );
    }

    /// Number of a tick.
    pub fn number(value: f64) -> String {
        format_short(if value.abs() < 1e-12 { 0.0 } else { value }, 6)
    }

    /// The whole drawing on white.
    pub fn finish(self, width: f64, height: f64) -> String {
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.0}\" height=\"{height:.0}\" viewBox=\"0 0 {width:.0} \
             {height:.0}\" font-family=\"Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif\">\n\
             <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n{}</svg>\n",
            self.body
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_within() {
        assert_eq!(round_values(0.63, 1.0, 4), [0.7, 0.8, 0.9, 1.0]);
        assert_eq!(round_values(0.0, 1.0, 5), [0.0, 0.2, 0.4, 0.6, 0.8, 1.0]);
        assert_eq!(round_values(1.0, 1.0, 5), [1.0]);
    }
}
