//! A canvas for scenes: metres to pixels, title, legend and scale bar, and labels that keep out of the way of each other.

use std::ops::{Deref, DerefMut};
use voussoir_core::model::geometry::Vec2;
use voussoir_plot::colours::{INK, QUIET};
use voussoir_plot::number::step_below;
use voussoir_plot::svg::{Canvas, SMALL, WIDTH, hatched};
use voussoir_plot::text::{Area, Spot, text_width, wrapped};
use voussoir_study::results::format::format_length;

const TITLE: f64 = 15.0;
const LINE: f64 = 20.0;
const SIDE: f64 = 24.0;
/// The greatest height of a scene \[px\].
const HEIGHT: f64 = 460.0;

/// The id of the hatching of the ground.
const GROUND: &str = "ground";

/// The class of what makes room for a drawing that moves.
pub const REST: &str = "rest";

/// The fill of the ground.
pub fn hatching() -> String {
    hatched(GROUND)
}

/// A symbol of a legend, 34 px wide.
pub trait LegendSymbol: Copy {
    /// Draws it with its left end at `spot`.
    fn draw(self, canvas: &mut SceneCanvas, spot: Spot);
}

/// A drawing of a scene under way.
#[derive(Debug)]
pub struct SceneCanvas {
    canvas: Canvas,
    titles: Vec<String>,
    scale: f64,
    corner: Vec2,
    top_left: Spot,
    drawing: Area,
    taken: Vec<Area>,
}

impl Deref for SceneCanvas {
    type Target = Canvas;

    fn deref(&self) -> &Canvas {
        &self.canvas
    }
}

impl DerefMut for SceneCanvas {
    fn deref_mut(&mut self) -> &mut Canvas {
        &mut self.canvas
    }
}

impl SceneCanvas {
    /// A canvas for a scene within `low`..`high` \[m\] with free margins \[px\] around it
    /// (left, top, right, bottom) for arrows and labels, under these title lines: the first bold.
    pub fn new(low: Vec2, high: Vec2, margins: [f64; 4], titles: &[String]) -> Self {
        let extent = (high - low).sup(&Vec2::repeat(1e-9 * (high - low).norm().max(1e-12)));
        let room = WIDTH - 2.0 * SIDE - margins[0] - margins[2];
        let scale = (room / extent.x).min(HEIGHT / extent.y);
        let size = extent * scale;
        let left = SIDE + margins[0] + (room - size.x) / 2.0;
        let lines: Vec<(String, bool)> = titles
            .iter()
            .enumerate()
            .flat_map(|(i, title)| {
                wrapped(title, TITLE, WIDTH - 2.0 * SIDE).into_iter().map(move |line| (line, i == 0))
            })
            .collect();
        let head = 20.0 + LINE * lines.len() as f64;
        let top = head + margins[1];
        let mut canvas = SceneCanvas {
            canvas: Canvas::default(),
            titles: titles.to_vec(),
            scale,
            corner: Vec2::new(low.x, high.y),
            top_left: [left, top],
            drawing: Area { low: [0.0, head], high: [WIDTH, top + size.y + margins[3]] },
            taken: Vec::new(),
        };
        canvas.define_hatching(GROUND, "#f1f1f1", "#777777");
        for (i, (line, bold)) in lines.iter().enumerate() {
            canvas.text([SIDE, 28.0 + LINE * i as f64], "start", TITLE, line, INK, *bold);
        }
        canvas
    }

    /// The last line of the title, which was left empty.
    pub fn last_title(&mut self, text: &str) {
        self.text([SIDE, self.drawing.low[1] - 12.0], "start", TITLE, text, INK, false);
    }

    /// The place of a point \[m\] on the canvas.
    pub fn at(&self, point: Vec2) -> Spot {
        let from = (point - self.corner) * self.scale;
        [self.top_left[0] + from.x, self.top_left[1] - from.y]
    }

    /// An empty group whose coordinates are metres, x to the right and y down: a script draws blocks that move in it.
    pub fn open_metres(&mut self) {
        let [x, y] = self.at(Vec2::zeros());
        let (scale, place) =
            (format!("{:.6}", self.scale), format!("translate({x:.4} {y:.4}) scale({:.6})", self.scale));
        self.open(&[("class", &"metres"), ("data-scale", &scale), ("transform", &place)]);
        self.close();
    }

    /// Pixels per metre.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// Keeps labels off this box.
    pub fn take(&mut self, area: Area) {
        self.taken.push(area);
    }

    /// Closed outlines \[m\] in one style.
    pub fn shapes<'a>(
        &mut self,
        shapes: impl Iterator<Item = &'a [Vec2]>,
        fill: &str,
        stroke: &str,
        width: f64,
        dash: &str,
    ) {
        let shapes: Vec<Vec<Spot>> = shapes.map(|shape| shape.iter().map(|&point| self.at(point)).collect()).collect();
        self.outlines(&shapes, fill, stroke, width, dash);
    }

    /// Text at a place, with an edge in the colour of the paper. Later labels avoid it.
    pub fn text(&mut self, spot: Spot, anchor: &str, size: f64, text: &str, colour: &str, bold: bool) {
        self.taken.push(Area::of_text(spot, anchor, size, text));
        self.edged(spot, text, (size, anchor, colour), bold);
    }

    /// Text near `spot`, preferably towards `direction`: the nearest free place, else the least
    /// crowded one.
    pub fn label(&mut self, spot: Spot, direction: Spot, text: &str, colour: &str, bold: bool) {
        let length = direction[0].hypot(direction[1]);
        let towards = if length > 1e-9 { direction[1].atan2(direction[0]) } else { -std::f64::consts::FRAC_PI_2 };
        let half = [text_width(text, SMALL) / 2.0, 0.52 * SMALL];
        let mut best: Option<(f64, Spot)> = None;
        for ring in 0..6 {
            for turn in [0.0_f64, 0.4, -0.4, 0.8, -0.8, 1.3, -1.3, 2.0, -2.0, 2.7, -2.7] {
                let (sin, cos) = (towards + turn).sin_cos();
                let reach =
                    (half[0] * cos.abs() + half[1] * sin.abs()).min(half[0].hypot(half[1])) + 13.0 + 9.0 * ring as f64;
                let middle = [spot[0] + reach * cos, spot[1] + reach * sin];
                let area = Area::around(middle, [half[0] + 2.0, half[1] + 1.0]);
                let outside = (half[0] + half[1])
                    * [
                        self.drawing.low[0] + 4.0 - area.low[0],
                        self.drawing.low[1] - area.low[1],
                        area.high[0] + 4.0 - self.drawing.high[0],
                        area.high[1] - self.drawing.high[1],
                    ]
                    .iter()
                    .fold(0.0_f64, |sum, &over| sum + over.max(0.0));
                let crowd: f64 = self.taken.iter().map(|other| other.shared(&area)).sum::<f64>() + outside;
                if best.is_none_or(|(least, _)| crowd < least) {
                    best = Some((crowd, middle));
                }
                if crowd == 0.0 {
                    break;
                }
            }
            if best.is_some_and(|(least, _)| least == 0.0) {
                break;
            }
        }
        let [x, y] = best.map_or(spot, |(_, middle)| middle);
        self.text([x, y + 0.3 * SMALL], "middle", SMALL, text, colour, bold);
    }

    /// Scale bar and legend below the drawing, caption lines under them; then the whole as SVG.
    pub fn finish<S: LegendSymbol>(mut self, legend: &[(S, String)], caption: &[String]) -> String {
        let mut y = self.drawing.high[1] + 24.0;
        let length = step_below(0.2 * (WIDTH - 2.0 * SIDE) / self.scale);
        let (left, right) = (SIDE, SIDE + length * self.scale);
        self.line(&[[left, y], [right, y]], INK, 2.0, "");
        for x in [left, right] {
            self.line(&[[x, y - 5.0], [x, y + 5.0]], INK, 2.0, "");
        }
        self.text([right + 10.0, y + 4.5], "start", SMALL, &format_length(length), INK, false);
        y += 28.0;
        let mut x = SIDE;
        for (symbol, words) in legend {
            let lines = wrapped(words, SMALL, WIDTH - 2.0 * SIDE - 42.0);
            let width = 42.0 + lines.iter().map(|line| text_width(line, SMALL)).fold(0.0, f64::max) + 20.0;
            if x > SIDE && x + width > WIDTH - SIDE / 2.0 {
                (x, y) = (SIDE, y + 22.0);
            }
            symbol.draw(&mut self, [x, y - 4.5]);
            for (i, line) in lines.iter().enumerate() {
                y += if i > 0 { 17.0 } else { 0.0 };
                self.text([x + 42.0, y], "start", SMALL, line, INK, false);
            }
            x += width;
        }
        y += 4.0;
        for line in caption.iter().flat_map(|paragraph| wrapped(paragraph, SMALL, WIDTH - 2.0 * SIDE)) {
            y += 18.0;
            self.text([SIDE, y], "start", SMALL, &line, QUIET, false);
        }
        let described: Vec<&str> = self
            .titles
            .iter()
            .skip(1)
            .chain(caption)
            .map(String::as_str)
            .filter(|line| !line.trim().is_empty())
            .collect();
        let shown: Vec<&str> = legend.iter().map(|(_, words)| words.as_str()).collect();
        let shown = if shown.is_empty() { String::new() } else { format!(" The drawing shows: {}.", shown.join("; ")) };
        let title = self.titles.first().cloned().unwrap_or_default();
        self.canvas.finish(
            [WIDTH, y + 16.0],
            &title,
            &format!("{}.{shown}", described.join(". ").trim_end_matches('.')),
        )
    }
}
