//! The canvas of all figures. It writes SVG elements and escapes text.

use super::colours::{INK, PAPER, dark_rules, line};
use super::text::Spot;
use std::fmt::{Display, Write};
use voussoir_core::number_text::format_short;

/// Width of every figure \[px\]: the text of a figure that is printed as wide as a page (18 cm) has at least 9 pt.
pub const WIDTH: f64 = 720.0;
/// The least size of text \[px\].
pub const SMALL: f64 = 13.0;
/// Size of titles \[px\].
pub const TITLE: f64 = 17.0;

/// For XML and HTML: `&`, `<`, `>` and quotes as entities.
pub fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;").replace('\'', "&#39;")
}

/// A drawing under way.
#[derive(Debug, Default)]
pub struct Canvas {
    body: String,
}

/// `x,y` of every spot, or `M x y L x y` of a path.
fn points(spots: &[Spot]) -> String {
    spots.iter().map(|[x, y]| format!("{x:.2},{y:.2}")).collect::<Vec<_>>().join(" ")
}

impl Canvas {
    /// The start of an element with its attributes, which are escaped; those without a value are left out.
    fn start(&mut self, name: &str, attributes: &[(&str, &dyn Display)]) {
        let _ = write!(self.body, "<{name}");
        for (key, value) in attributes {
            let value = value.to_string();
            if !value.is_empty() {
                let _ = write!(self.body, " {key}=\"{}\"", escape(&value));
            }
        }
    }

    /// An element without content.
    fn element(&mut self, name: &str, attributes: &[(&str, &dyn Display)]) {
        self.start(name, attributes);
        self.body += "/>\n";
    }

    /// An element with text.
    fn words(&mut self, name: &str, attributes: &[(&str, &dyn Display)], words: &str) {
        self.start(name, attributes);
        let _ = writeln!(self.body, ">{}</{name}>", escape(words));
    }

    /// Begins a group.
    pub fn open(&mut self, attributes: &[(&str, &dyn Display)]) {
        self.start("g", attributes);
        self.body += ">\n";
    }

    /// Ends the innermost group.
    pub fn close(&mut self) {
        self.body += "</g>\n";
    }

    /// Makes the innermost group visible during a share of a time that repeats.
    pub fn visible_during(&mut self, [from, to]: [f64; 2], seconds: f64) {
        let (values, times) = match from {
            0.0 => ("visible;hidden", format!("0;{to:.4}")),
            _ => ("hidden;visible;hidden", format!("0;{from:.4};{to:.4}")),
        };
        self.element(
            "animate",
            &[
                ("attributeName", &"visibility"),
                ("calcMode", &"discrete"),
                ("dur", &format_args!("{seconds:.1}s")),
                ("repeatCount", &"indefinite"),
                ("values", &values),
                ("keyTimes", &times),
            ],
        );
    }

    /// Begins the group of a line of a chart: its name, the cases that its points belong to, and the values of those
    /// points for scripts.
    pub fn open_series(&mut self, name: &str, cases: &[usize], points: &[(f64, f64)]) {
        let cases: Vec<String> = cases.iter().map(usize::to_string).collect();
        let values: Vec<String> =
            points.iter().map(|(x, y)| format!("{},{}", format_short(*x, 6), format_short(*y, 6))).collect();
        self.open(&[
            ("class", &"series"),
            ("data-name", &name),
            ("data-cases", &cases.join(" ")),
            ("data-points", &values.join(" ")),
        ]);
    }

    /// Defines a hatching; [`hatched`] is the fill that refers to it.
    pub fn define_hatching(&mut self, id: &str, ground: &str, colour: &str) {
        self.body += "<defs>";
        self.start(
            "pattern",
            &[
                ("id", &id),
                ("width", &7),
                ("height", &7),
                ("patternUnits", &"userSpaceOnUse"),
                ("patternTransform", &"rotate(45)"),
            ],
        );
        self.body += ">\n";
        self.rectangle([0.0, 0.0], [7.0, 7.0], ground);
        self.line(&[[0.0, 0.0], [0.0, 7.0]], colour, 1.2, "");
        self.body += "</pattern></defs>\n";
    }

    /// An open line through spots; no dashes if `dash` is empty.
    pub fn line(&mut self, spots: &[Spot], colour: &str, width: f64, dash: &str) {
        if spots.len() < 2 {
            return;
        }
        self.element(
            "polyline",
            &[
                ("points", &points(spots)),
                ("fill", &"none"),
                ("stroke", &colour),
                ("stroke-width", &format_short(width, 3)),
                ("stroke-dasharray", &dash),
                ("stroke-linejoin", &"round"),
                ("stroke-linecap", &if dash.is_empty() { "round" } else { "" }),
            ],
        );
    }

    /// A filled rectangle.
    pub fn rectangle(&mut self, low: Spot, high: Spot, colour: &str) {
        let [x, y, width, height] =
            [low[0], low[1], (high[0] - low[0]).max(0.0), (high[1] - low[1]).max(0.0)].map(|c| format!("{c:.2}"));
        self.element("rect", &[("x", &x), ("y", &y), ("width", &width), ("height", &height), ("fill", &colour)]);
    }

    /// A closed outline through spots.
    pub fn polygon(&mut self, spots: &[Spot], fill: &str, stroke: &str, dash: &str) {
        self.element(
            "polygon",
            &[("points", &points(spots)), ("fill", &fill), ("stroke", &stroke), ("stroke-dasharray", &dash)],
        );
    }

    /// Closed outlines in one style.
    pub fn outlines(&mut self, shapes: &[Vec<Spot>], fill: &str, stroke: &str, width: f64, dash: &str) {
        let mut path = String::new();
        for shape in shapes.iter().filter(|shape| !shape.is_empty()) {
            for (i, [x, y]) in shape.iter().enumerate() {
                let _ = write!(path, "{}{x:.2} {y:.2}", if i == 0 { 'M' } else { 'L' });
            }
            path.push('Z');
        }
        if path.is_empty() {
            return;
        }
        self.element(
            "path",
            &[
                ("d", &path),
                ("fill", &fill),
                ("stroke", &stroke),
                ("stroke-width", &format_short(width, 3)),
                ("stroke-dasharray", &dash),
                ("stroke-linejoin", &"round"),
            ],
        );
    }

    /// A circle.
    pub fn circle(&mut self, [x, y]: Spot, radius: f64, fill: &str, stroke: &str, width: f64) {
        let [x, y] = [x, y].map(|c| format!("{c:.2}"));
        self.element(
            "circle",
            &[("cx", &x), ("cy", &y), ("r", &radius), ("fill", &fill), ("stroke", &stroke), ("stroke-width", &width)],
        );
    }

    /// An arrow head with its point at `tip`, along the unit vector `direction`.
    pub fn head(&mut self, tip: Spot, [x, y]: Spot, size: f64, colour: &str) {
        let corner = |side: f64| [tip[0] - size * (x + side * 0.4 * y), tip[1] - size * (y - side * 0.4 * x)];
        self.polygon(&[tip, corner(1.0), corner(-1.0)], colour, "", "");
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

    /// The mark of series `index`.
    pub fn mark(&mut self, index: usize, at: Spot) {
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
        let spots: Vec<Spot> = corners.iter().map(|c| [at[0] + c[0], at[1] + c[1]]).collect();
        self.polygon(&spots, line(index), PAPER, "");
    }

    /// Text; `anchor` is `start`, `middle` or `end`.
    pub fn text(&mut self, at: Spot, words: &str, size: f64, anchor: &str) {
        self.styled(at, words, (size, anchor, INK), &[]);
    }

    /// Text with an edge in the colour of the paper, readable on any ground.
    pub fn edged(&mut self, at: Spot, words: &str, (size, anchor, colour): (f64, &str, &str), bold: bool) {
        self.styled(
            at,
            words,
            (size, anchor, colour),
            &[
                ("font-weight", &if bold { "bold" } else { "" }),
                ("stroke", &PAPER),
                ("stroke-width", &3),
                ("stroke-linejoin", &"round"),
                ("paint-order", &"stroke"),
            ],
        );
    }

    /// Text that reads upwards.
    pub fn upright(&mut self, at: Spot, words: &str, size: f64) {
        let turn = format!("rotate(-90 {:.2} {:.2})", at[0], at[1]);
        self.styled(at, words, (size, "middle", INK), &[("transform", &turn)]);
    }

    fn styled(
        &mut self,
        [x, y]: Spot,
        words: &str,
        (size, anchor, colour): (f64, &str, &str),
        more: &[(&str, &dyn Display)],
    ) {
        let [x, y] = [x, y].map(|c| format!("{c:.2}"));
        let own: [(&str, &dyn Display); 5] =
            [("x", &x), ("y", &y), ("font-size", &size), ("text-anchor", &anchor), ("fill", &colour)];
        self.words("text", &[&own[..], more].concat(), words);
    }

    /// Lines of a title in the middle of the figure; returns where the last one ends.
    pub fn title(&mut self, lines: &[String], width: f64) -> f64 {
        for (i, line) in lines.iter().enumerate() {
            self.text([width / 2.0, 26.0 + 23.0 * i as f64], line, TITLE, "middle");
        }
        14.0 + 23.0 * lines.len() as f64
    }

    /// The whole drawing with a background, its title and a description for readers who do not see it.
    pub fn finish(self, [width, height]: [f64; 2], title: &str, description: &str) -> String {
        let mut whole = Canvas::default();
        let (width, height) = (format!("{width:.0}"), format!("{height:.0}"));
        whole.start(
            "svg",
            &[
                ("xmlns", &"http://www.w3.org/2000/svg"),
                ("width", &width),
                ("height", &height),
                ("viewBox", &format_args!("0 0 {width} {height}")),
                ("font-family", &FONT),
                ("role", &"img"),
            ],
        );
        whole.body += ">\n";
        whole.words("title", &[], title);
        whole.words("desc", &[], description);
        whole.element("rect", &[("width", &"100%"), ("height", &"100%"), ("fill", &PAPER)]);
        whole.body + &self.body + "</svg>\n"
    }
}

const FONT: &str = "Helvetica, Arial, Liberation Sans, DejaVu Sans, sans-serif";

/// The fill with the hatching of this id.
pub fn hatched(id: &str) -> String {
    format!("url(#{id})")
}

/// The drawing as a separate file, with a style sheet for dark screens.
pub fn as_file(svg: &str) -> String {
    let rules = dark_rules("svg", |colour| svg.contains(&format!("=\"{colour}\"")));
    svg.replacen("<title>", &format!("<style>{rules}</style>\n<title>"), 1)
}

/// The drawing with a prefix before all ids, since the drawings of a page share their ids.
pub fn own_ids(svg: &str, prefix: &str) -> String {
    let prefix = escape(prefix);
    svg.replace(" id=\"", &format!(" id=\"{prefix}-")).replace("=\"url(#", &format!("=\"url(#{prefix}-"))
}
