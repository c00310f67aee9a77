//! Colours of figures, each with its counterpart on a dark page. SVG elements carry the light colour as an attribute, which
//! every program can draw; a style sheet replaces it where the reader's screen is dark.

use std::fmt::Write;

/// Colour of the background.
pub const PAPER: &str = "#ffffff";
/// Ordinary text and axes.
pub const INK: &str = "#222222";
/// Text of captions and legends of minor importance.
pub const QUIET: &str = "#555555";
/// Lines of a grid.
pub const GRID: &str = "#e1e1e1";
/// Every second row of a list.
pub const STRIPE: &str = "#f4f4f4";
/// Points, outlines and dashes that are behind everything else.
pub const FAINT: &str = "#999999";
/// Missing values.
pub const MISSING: &str = "#d00000";

/// Lines of charts: Okabe and Ito (2008), told apart by colour-blind readers.
pub const LINES: [&str; 7] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#000000"];
/// Regions of a map: light, so that dark contours stay readable.
pub const REGIONS: [&str; 8] = ["#b8d4e8", "#f6d3b3", "#c3e6d4", "#ecd0e0", "#e6e6e6", "#fbeec0", "#d5cfe9", "#dfc9bd"];

/// The colour of a line by its number.
pub fn line(index: usize) -> &'static str {
    LINES[index % LINES.len()]
}

/// Every colour of a figure with the one that replaces it on a dark page.
pub const DARK: [(&str, &str); 36] = [
    (PAPER, "#16181b"),
    (INK, "#e6e6e6"),
    (QUIET, "#b4b4b4"),
    (GRID, "#34373c"),
    (STRIPE, "#1f2226"),
    (FAINT, "#7d7d7d"),
    (MISSING, "#ff6b6b"),
    ("#777777", "#9a9a9a"),
    ("#f1f1f1", "#26292d"),
    ("#0072b2", "#4ba3e3"),
    ("#d55e00", "#ff8a3d"),
    ("#009e73", "#2fc79a"),
    ("#cc79a7", "#e59cc4"),
    ("#56b4e9", "#7cc8f2"),
    ("#e69f00", "#ffbf3f"),
    ("#000000", "#f2f2f2"),
    ("#b8d4e8", "#274a63"),
    ("#f6d3b3", "#6a4423"),
    ("#c3e6d4", "#265542"),
    ("#ecd0e0", "#5e3a50"),
    ("#e6e6e6", "#3c3f44"),
    ("#fbeec0", "#5c5120"),
    ("#d5cfe9", "#423a63"),
    ("#dfc9bd", "#573f33"),
    ("#e9dfcb", "#5b5443"),
    ("#f4eede", "#35322a"),
    ("#b9ad93", "#7d735c"),
    ("#dce9f1", "#1f3a4d"),
    ("#c9e8dd", "#1f4a3c"),
    ("#e0762e", "#ff9a56"),
    ("#a05a00", "#e3a24d"),
    ("#6b6150", "#b8ab8c"),
    ("#86b8d8", "#4f7f9e"),
    ("#c8102e", "#ff6b7d"),
    ("#6f6f6f", "#c2c2c2"),
    ("#7b2d8b", "#c78ad6"),
];

/// Rules of a style sheet for dark screens: the elements below `selector` that are filled or stroked with a colour of which
/// `used` returns true.
pub fn dark_rules(selector: &str, used: impl Fn(&str) -> bool) -> String {
    let mut rules = String::new();
    for (light, dark) in DARK.into_iter().filter(|(light, _)| used(light)) {
        for property in ["fill", "stroke"] {
            let _ = write!(rules, "{selector} [{property}='{light}']{{{property}:{dark}}}");
        }
    }
    format!("@media screen and (prefers-color-scheme:dark){{{rules}}}")
}
