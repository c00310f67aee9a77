//! Marks for joints: hinges, sliding, crushing; and the symbols of a legend.

use super::lettering::{Area, Spot};
use super::sheet::Sheet;
use voussoir_core::certificate::Mechanism;
use voussoir_core::model::geometry::Vec2;
use voussoir_core::model::{Assembly, Joint};

/// Fill of free blocks.
pub const STONE: &str = "#e9dfcb";
/// Outline of blocks.
pub const OUTLINE: &str = "#6b6150";
/// Loads.
pub const LOAD: &str = "#0072b2";
/// Thrust line and joint forces.
pub const THRUST: &str = "#009e73";
/// Strut of an unbounded case.
pub const STRUT: &str = "#cc79a7";
/// Hinges and sliding joints.
pub const MOTION: &str = "#c8102e";
/// Elements that have yielded.
pub const YIELDED: &str = "#6f6f6f";
/// Crushing joints.
pub const CRUSH: &str = "#7b2d8b";
/// More hinges than this are not numbered.
pub const NUMBERED: usize = 24;

/// A legend's symbol, 34 px wide.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Symbol {
    /// A free block.
    Block,
    /// The ground.
    Ground,
    /// A load's arrow.
    Load,
    /// The thrust line.
    Thrust,
    /// A joint's force.
    Force,
    /// The strut of an unbounded case.
    Strut,
    /// A hinge.
    Hinge,
    /// A hinge with its sense of rotation.
    TurningHinge,
    /// A sliding joint.
    Sliding,
    /// A crushing joint.
    Crushing,
    /// An element that has yielded.
    Yielded,
    /// Where blocks were.
    Before,
}

impl Symbol {
    /// Draws it with its left end at `spot`.
    pub fn draw(self, sheet: &mut Sheet, [x, y]: Spot) {
        let ends = [[x, y], [x + 34.0, y]];
        let middle = [x + 17.0, y];
        match self {
            Symbol::Block => boxed(sheet, [x, y], STONE, OUTLINE, ""),
            Symbol::Ground => boxed(sheet, [x, y], "url(#ground)", OUTLINE, ""),
            Symbol::Before => boxed(sheet, [x, y], "none", "#999999", "4 3"),
            Symbol::Load => sheet.arrow(ends[0], ends[1], LOAD, 2.2, 10.0),
            Symbol::Thrust => sheet.line(&ends, THRUST, 2.2, ""),
            Symbol::Force => sheet.line(&[[x + 6.0, y], [x + 28.0, y]], THRUST, 5.0, ""),
            Symbol::Strut => sheet.line(&ends, STRUT, 3.0, "9 5"),
            Symbol::Hinge => hinge(sheet, middle),
            Symbol::TurningHinge => {
                hinge(sheet, middle);
                turning(sheet, middle, 1.0);
            }
            Symbol::Sliding => sliding(sheet, middle, [1.0, 0.0], 28.0, 1.0),
            Symbol::Yielded => boxed(sheet, [x, y], YIELDED, "none", ""),
            Symbol::Crushing => sheet.line(&ends, CRUSH, 6.0, ""),
        }
    }
}

fn boxed(sheet: &mut Sheet, [x, y]: Spot, fill: &str, stroke: &str, dash: &str) {
    sheet.pixels(
        &[[x + 4.0, y - 7.0], [x + 30.0, y - 7.0], [x + 30.0, y + 7.0], [x + 4.0, y + 7.0]],
        fill,
        stroke,
        dash,
    );
}

fn hinge(sheet: &mut Sheet, spot: Spot) {
    sheet.circle(spot, 5.0, "white", MOTION, 2.2);
}

/// An arc with a head around a hinge; `sense` > 0 anticlockwise.
fn turning(sheet: &mut Sheet, [x, y]: Spot, sense: f64) {
    let radius = 11.0;
    let sign = if sense >= 0.0 { -1.0 } else { 1.0 };
    let on = |angle: f64| [x + radius * angle.cos(), y + radius * angle.sin()];
    let start = if sign < 0.0 { 0.6 } else { std::f64::consts::PI - 0.6 };
    let arc: Vec<Spot> = (0..=16).map(|i| on(start + sign * 4.3 * i as f64 / 16.0)).collect();
    sheet.line(&arc, MOTION, 1.6, "");
    let end = start + sign * 4.3;
    let tip = on(end + sign * 0.5);
    let direction = [-sign * (end + sign * 0.3).sin(), sign * (end + sign * 0.3).cos()];
    sheet.head(tip, direction, 8.0, MOTION);
}

/// Two lines along the unit vector `t` and half arrows: the left side of `t` moves along
/// −`sense`·t relative to the right side (on the sheet, y down).
fn sliding(sheet: &mut Sheet, [x, y]: Spot, t: Spot, length: f64, sense: f64) {
    let across = [-t[1], t[0]];
    let at = |s: f64, d: f64| [x + s * t[0] + d * across[0], y + s * t[1] + d * across[1]];
    let half = length / 2.0;
    for side in [-1.0, 1.0] {
        sheet.line(&[at(-half, 1.8 * side), at(half, 1.8 * side)], MOTION, 1.3, "");
        let way = side * sense;
        let reach = half.clamp(7.0, 16.0);
        sheet.arrow(at(-reach * way, 6.5 * side), at(reach * way, 6.5 * side), MOTION, 1.3, 6.5);
    }
}

fn on_sheet(sheet: &Sheet, direction: Vec2) -> Spot {
    let (from, to) = (sheet.at(Vec2::zeros()), sheet.at(direction));
    let (x, y) = (to[0] - from[0], to[1] - from[1]);
    let length = x.hypot(y).max(1e-12);
    [x / length, y / length]
}

/// Marks hinges, sliding and crushing joints where `place` puts a joint's points, and returns what
/// the legend must say.
pub fn mark(
    sheet: &mut Sheet,
    assembly: &Assembly,
    mechanism: &Mechanism,
    senses: bool,
    place: impl Fn(&Joint, Vec2) -> Vec2,
) -> Vec<(Symbol, String)> {
    let mut legend = Vec::new();
    let joint_of = |index: usize| assembly.joints.get(index);
    for crushing in &mechanism.crushing {
        let Some(joint) = joint_of(crushing.joint) else { continue };
        let ends = joint.ends.map(|end| sheet.at(place(joint, end)));
        sheet.line(&ends, CRUSH, 6.0, "");
    }
    for slide in &mechanism.sliding {
        let Some(joint) = joint_of(slide.joint) else { continue };
        let t = on_sheet(sheet, joint.frame().1);
        let length = (joint.height() * sheet.scale()).max(8.0);
        let spot = sheet.at(place(joint, joint.middle()));
        // n is right of t; on the sheet (y down) plus lies where `across` is positive.
        sliding(sheet, spot, t, length, slide.slip.signum());
    }
    let spots: Vec<(Spot, Spot, String, f64)> = mechanism
        .hinges
        .iter()
        .filter_map(|hinge| {
            let joint = joint_of(hinge.joint)?;
            let point = Vec2::from(hinge.point);
            let outward = on_sheet(sheet, point - joint.middle());
            Some((sheet.at(place(joint, point)), outward, hinge.joint.to_string(), hinge.rotation))
        })
        .collect();
    let reach = if senses { 14.0 } else { 7.0 };
    for (spot, _, _, rotation) in &spots {
        hinge(sheet, *spot);
        if senses && spots.len() <= NUMBERED {
            turning(sheet, *spot, *rotation);
        }
        sheet.take(Area::around(*spot, [reach, reach]));
    }
    if spots.len() <= NUMBERED {
        for (spot, outward, text, _) in &spots {
            sheet.label(*spot, *outward, text, MOTION, true);
        }
    }
    if !spots.is_empty() {
        let numbered = if spots.len() <= NUMBERED { "with its joint's number" } else { "too many to number" };
        let symbol = if senses && spots.len() <= NUMBERED { Symbol::TurningHinge } else { Symbol::Hinge };
        let sense =
            if symbol == Symbol::TurningHinge { "; arrow: how its plus side turns (right on arches)" } else { "" };
        legend.push((symbol, format!("hinge {numbered}{sense}")));
    }
    if !mechanism.sliding.is_empty() {
        legend.push((Symbol::Sliding, "sliding joint".into()));
    }
    if !mechanism.crushing.is_empty() {
        legend.push((Symbol::Crushing, "crushing joint".into()));
    }
    legend
}
