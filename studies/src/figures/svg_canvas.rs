//! A canvas for SVG: metres to pixels, lines, polygons, and text that keeps out of the way of
//! other text. What is drawn on it is decided elsewhere.

use super::text_layout::{Area, Spot, text_width, wrapped};
use svg::Document;
use svg::node::element::{Circle, Definitions, Group, Line, Path, Pattern, Polygon, Rectangle, Text};
use voussoir_core::model::geometry::Vec2;

/// Size of ordinary text \[px\].
pub const TEXT: f64 = 13.0;
/// Colour of ordinary text.
pub const INK: &str = "#222222";
const FONT: &str = "Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif";
const SIDE: f64 = 40.0;

/// A symbol of a legend, 34 px wide.
pub trait LegendSymbol: Copy {
    /// Draws it with its left end at `spot`.
    fn draw(self, canvas: &mut SvgCanvas, spot: Spot);
}

/// A drawing under way.
#[derive(Debug)]
pub struct SvgCanvas {
    document: Document,
    scale: f64,
    corner: Vec2,
    top_left: Spot,
    drawing: Area,
    width: f64,
    taken: Vec<Area>,
}

impl SvgCanvas {
    /// A canvas for a scene within `low`..`high` \[m\] with free margins \[px\] around it
    /// (left, top, right, bottom) for arrows and labels, under these title lines: the first bold.
    pub fn new(low: Vec2, high: Vec2, margins: [f64; 4], titles: &[String]) -> Self {
        let extent = (high - low).sup(&Vec2::repeat(1e-9 * (high - low).norm().max(1e-12)));
        let scale = (860.0 / extent.x).min(480.0 / extent.y);
        let size = extent * scale;
        let inner = size.x + margins[0] + margins[2];
        let width = inner.max(720.0) + 2.0 * SIDE;
        let left = (width - inner) / 2.0 + margins[0];
        let lines: Vec<(String, bool)> = titles
            .iter()
            .enumerate()
            .flat_map(|(i, title)| {
                wrapped(title, TEXT + 2.0, width - 2.0 * SIDE).into_iter().map(move |line| (line, i == 0))
            })
            .collect();
        let head = 24.0 + 21.0 * lines.len() as f64;
        let top = head + margins[1];
        let mut canvas = SvgCanvas {
            document: Document::new(),
            scale,
            corner: Vec2::new(low.x, high.y),
            top_left: [left, top],
            drawing: Area { low: [0.0, head], high: [width, top + size.y + margins[3]] },
            width,
            taken: Vec::new(),
        };
        canvas.document =
            canvas.document.add(Rectangle::new().set("width", "100%").set("height", "100%").set("fill", "white"));
        let hatch = Line::new().set("x1", 0).set("y1", 0).set("x2", 0).set("y2", 7);
        let pattern = Pattern::new()
            .set("id", "ground")
            .set("width", 7)
            .set("height", 7)
            .set("patternUnits", "userSpaceOnUse")
            .set("patternTransform", "rotate(45)")
            .add(Rectangle::new().set("width", 7).set("height", 7).set("fill", "#f1f1f1"))
            .add(hatch.set("stroke", "#777777").set("stroke-width", 1.2));
        canvas.document = canvas.document.add(Definitions::new().add(pattern));
        for (i, (line, bold)) in lines.iter().enumerate() {
            canvas.text([SIDE, 30.0 + 21.0 * i as f64], "start", TEXT + 2.0, line, INK, *bold);
        }
        canvas
    }

    /// The last line of the title, which was left empty.
    pub fn last_title(&mut self, text: &str) {
        self.text([SIDE, self.drawing.low[1] - 15.0], "start", TEXT + 2.0, text, INK, false);
    }

    /// Puts what is drawn meanwhile into a group.
    pub fn group(&mut self, group: Group, draw: impl FnOnce(&mut SvgCanvas)) {
        let outside = std::mem::replace(&mut self.document, Document::new());
        draw(self);
        let inside = std::mem::replace(&mut self.document, outside);
        let children = inside.get_children().iter().cloned();
        self.add(children.fold(group, Group::add));
    }

    /// Where a point \[m\] lies on the canvas.
    pub fn at(&self, point: Vec2) -> Spot {
        let from = (point - self.corner) * self.scale;
        [self.top_left[0] + from.x, self.top_left[1] - from.y]
    }

    /// Pixels per metre.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// Keeps labels off this box.
    pub fn take(&mut self, area: Area) {
        self.taken.push(area);
    }

    fn add(&mut self, node: impl Into<Box<dyn svg::Node>>) {
        svg::Node::append(&mut self.document, node);
    }

    /// Closed outlines \[m\] in one style.
    pub fn outlines<'a>(
        &mut self,
        shapes: impl Iterator<Item = &'a [Vec2]>,
        fill: &str,
        stroke: &str,
        width: f64,
        dash: &str,
    ) {
        let mut d = String::new();
        for shape in shapes.filter(|shape| !shape.is_empty()) {
            for (i, &vertex) in shape.iter().enumerate() {
                let [x, y] = self.at(vertex);
                d.push_str(&format!("{}{x:.2} {y:.2}", if i == 0 { 'M' } else { 'L' }));
            }
            d.push('Z');
        }
        if d.is_empty() {
            return;
        }
        let mut path =
            Path::new().set("d", d).set("fill", fill).set("stroke", stroke).set("stroke-width", format!("{width:.2}"));
        if !dash.is_empty() {
            path = path.set("stroke-dasharray", dash);
        }
        self.add(path.set("stroke-linejoin", "round"));
    }

    /// An open line through spots.
    pub fn line(&mut self, spots: &[Spot], colour: &str, width: f64, dash: &str) {
        if spots.len() < 2 {
            return;
        }
        let d: String = spots
            .iter()
            .enumerate()
            .map(|(i, [x, y])| format!("{}{x:.2} {y:.2}", if i == 0 { 'M' } else { 'L' }))
            .collect();
        let mut path = Path::new()
            .set("d", d)
            .set("fill", "none")
            .set("stroke", colour)
            .set("stroke-width", format!("{width:.2}"));
        if !dash.is_empty() {
            path = path.set("stroke-dasharray", dash);
        }
        self.add(path.set("stroke-linejoin", "round").set("stroke-linecap", "round"));
    }

    /// A closed outline through spots.
    pub fn pixels(&mut self, spots: &[Spot], fill: &str, stroke: &str, dash: &str) {
        let points: Vec<String> = spots.iter().map(|[x, y]| format!("{x:.2},{y:.2}")).collect();
        let polygon = Polygon::new().set("points", points.join(" ")).set("fill", fill).set("stroke", stroke);
        self.add(if dash.is_empty() { polygon } else { polygon.set("stroke-dasharray", dash) });
    }

    /// A circle.
    pub fn circle(&mut self, [x, y]: Spot, radius: f64, fill: &str, stroke: &str, width: f64) {
        let circle = Circle::new().set("cx", format!("{x:.2}")).set("cy", format!("{y:.2}")).set("r", radius);
        self.add(circle.set("fill", fill).set("stroke", stroke).set("stroke-width", width));
    }

    /// An arrow head with its point at `tip`, along the unit vector `direction`.
    pub fn head(&mut self, tip: Spot, direction: Spot, size: f64, colour: &str) {
        let [x, y] = direction;
        let corner = |side: f64| {
            let spot = [tip[0] - size * (x + side * 0.4 * y), tip[1] - size * (y - side * 0.4 * x)];
            format!("{:.2},{:.2}", spot[0], spot[1])
        };
        let points = format!("{:.2},{:.2} {} {}", tip[0], tip[1], corner(1.0), corner(-1.0));
        self.add(Polygon::new().set("points", points).set("fill", colour));
    }

    /// An arrow.
    pub fn arrow(&mut self, from: Spot, to: Spot, colour: &str, width: f64, head: f64) {
        let along = [to[0] - from[0], to[1] - from[1]];
        let length = along[0].hypot(along[1]);
        if length < 1e-9 {
            return;
        }
        let unit = along.map(|c| c / length);
        let neck = [to[0] - 0.8 * head * unit[0], to[1] - 0.8 * head * unit[1]];
        self.line(&[from, neck], colour, width, "");
        self.head(to, unit, head, colour);
    }

    /// Text at a place, with a white halo; the place is taken from then on.
    pub fn text(&mut self, spot: Spot, anchor: &str, size: f64, text: &str, colour: &str, bold: bool) {
        self.taken.push(Area::of_text(spot, anchor, size, text));
        let node = Text::new(text)
            .set("x", format!("{:.2}", spot[0]))
            .set("y", format!("{:.2}", spot[1]))
            .set("font-size", size)
            .set("font-family", FONT)
            .set("text-anchor", anchor)
            .set("fill", colour)
            .set("stroke", "white")
            .set("stroke-width", 3)
            .set("paint-order", "stroke");
        let node = if bold { node.set("font-weight", "bold") } else { node };
        self.add(node);
    }

    /// Text near `spot`, preferably towards `direction`: the nearest free place, else the least
    /// crowded one.
    pub fn label(&mut self, spot: Spot, direction: Spot, text: &str, colour: &str, bold: bool) {
        let length = direction[0].hypot(direction[1]);
        let towards = if length > 1e-9 { direction[1].atan2(direction[0]) } else { -std::f64::consts::FRAC_PI_2 };
        let half = [text_width(text, TEXT) / 2.0, 0.52 * TEXT];
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
        self.text([x, y + 0.3 * TEXT], "middle", TEXT, text, colour, bold);
    }

    /// Scale bar and legend below the drawing, caption lines under them; then the whole as SVG.
    pub fn finish<S: LegendSymbol>(mut self, legend: &[(S, String)], caption: &[String]) -> String {
        let mut y = self.drawing.high[1] + 26.0;
        let length = nice(0.2 * (self.width - 2.0 * SIDE) / self.scale);
        let (left, right) = (SIDE, SIDE + length * self.scale);
        self.line(&[[left, y], [right, y]], INK, 2.0, "");
        for x in [left, right] {
            self.line(&[[x, y - 5.0], [x, y + 5.0]], INK, 2.0, "");
        }
        self.text([right + 10.0, y + 4.5], "start", TEXT, &super::format::format_length(length), INK, false);
        y += 30.0;
        let mut x = SIDE;
        for (symbol, words) in legend {
            let width = 44.0 + text_width(words, TEXT) + 20.0;
            if x > SIDE && x + width > self.width - SIDE / 2.0 {
                (x, y) = (SIDE, y + 24.0);
            }
            symbol.draw(&mut self, [x, y - 4.5]);
            self.text([x + 42.0, y], "start", TEXT, words, INK, false);
            x += width;
        }
        y += 6.0;
        for paragraph in caption {
            for line in wrapped(paragraph, TEXT - 1.0, self.width - 2.0 * SIDE) {
                y += 18.0;
                self.text([SIDE, y], "start", TEXT - 1.0, &line, "#555555", false);
            }
        }
        let height = y + 18.0;
        self.document
            .set("width", format!("{:.0}", self.width))
            .set("height", format!("{height:.0}"))
            .set("viewBox", format!("0 0 {:.0} {height:.0}", self.width))
            .to_string()
    }
}

/// The greatest of 1, 2, 5 times a power of ten that does not exceed `x` > 0.
fn nice(x: f64) -> f64 {
    let power = 10f64.powf(x.log10().floor());
    let step = [5.0, 2.0, 1.0].into_iter().find(|step| step * power <= x * (1.0 + 1e-12)).unwrap_or(1.0);
    step * power
}
