//! Marks for joints: hinges, sliding, crushing; and the symbols of a legend.

use super::hinges::{drawn_hinges, labels};
use super::scene_canvas::{LegendSymbol, SceneCanvas, hatching};
use voussoir_core::certificate::{CRUSHES, Mechanism};
use voussoir_core::model::geometry::Vec2;
use voussoir_core::model::{Assembly, Joint};
use voussoir_plot::colours::{FAINT, PAPER};
use voussoir_plot::text::{Area, Spot};
use voussoir_study::results::CaseResult;

/// Fill of free blocks.
pub const STONE: &str = "#e9dfcb";
/// Fill above the rings.
pub const FILL: &str = "#f4eede";
/// Where loads spread in the fill.
pub const SPREAD: &str = "#dce9f1";
/// Parts of joints without mortar.
pub const LOST: &str = "#e0762e";
/// Forces of the fill.
pub const PRESSURE: &str = "#a05a00";
/// Outline of blocks.
pub const OUTLINE: &str = "#6b6150";
/// Loads.
pub const LOAD: &str = "#0072b2";
/// Loads of stages before the last.
pub const EARLIER: &str = "#86b8d8";
/// Supports that move.
pub const SETTLEMENT: &str = "#d55e00";
/// Thrust line and joint forces.
pub const THRUST: &str = "#009e73";
/// Zone of thrust.
pub const ZONE: &str = "#c9e8dd";
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
    /// The fill of a bridge.
    Fill,
    /// A load that spreads in the fill.
    Spread,
    /// The part of a joint that has lost its mortar.
    LostMortar,
    /// A force of the fill.
    Pressure,
    /// A load's arrow.
    Load,
    /// An arrow of a load before the last stage.
    EarlierLoad,
    /// An arrow along which a support moves.
    Settlement,
    /// The thrust line.
    Thrust,
    /// The zone of thrust.
    Zone,
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

impl LegendSymbol for Symbol {
    fn draw(self, canvas: &mut SceneCanvas, [x, y]: Spot) {
        let ends = [[x, y], [x + 34.0, y]];
        let middle = [x + 17.0, y];
        match self {
            Symbol::Block => boxed(canvas, [x, y], STONE, OUTLINE, ""),
            Symbol::Ground => boxed(canvas, [x, y], &hatching(), OUTLINE, ""),
            Symbol::Before => boxed(canvas, [x, y], "none", FAINT, "4 3"),
            Symbol::Fill => boxed(canvas, [x, y], FILL, "#b9ad93", ""),
            Symbol::Spread => {
                let sides = [[x + 12.0, y - 7.0], [x + 22.0, y - 7.0], [x + 32.0, y + 7.0], [x + 2.0, y + 7.0]];
                canvas.polygon(&sides, SPREAD, LOAD, "");
            }
            Symbol::LostMortar => canvas.line(&[[x + 6.0, y], [x + 28.0, y]], LOST, 3.5, ""),
            Symbol::Pressure => canvas.arrow(ends[0], ends[1], PRESSURE, 1.6, 7.0),
            Symbol::Load => canvas.arrow(ends[0], ends[1], LOAD, 2.2, 10.0),
            Symbol::EarlierLoad => canvas.arrow(ends[0], ends[1], EARLIER, 2.2, 10.0),
            Symbol::Settlement => canvas.arrow(ends[0], ends[1], SETTLEMENT, 3.0, 10.0),
            Symbol::Thrust => canvas.line(&ends, THRUST, 2.2, ""),
            Symbol::Zone => boxed(canvas, [x, y], ZONE, THRUST, ""),
            Symbol::Force => canvas.line(&[[x + 6.0, y], [x + 28.0, y]], THRUST, 5.0, ""),
            Symbol::Strut => canvas.line(&ends, STRUT, 3.0, "9 5"),
            Symbol::Hinge => hinge(canvas, middle),
            Symbol::TurningHinge => {
                hinge(canvas, middle);
                turning(canvas, middle, 1.0);
            }
            Symbol::Sliding => sliding(canvas, middle, [1.0, 0.0], 28.0, 1.0),
            Symbol::Yielded => boxed(canvas, [x, y], YIELDED, "none", ""),
            Symbol::Crushing => canvas.line(&ends, CRUSH, 6.0, ""),
        }
    }
}

fn boxed(canvas: &mut SceneCanvas, [x, y]: Spot, fill: &str, stroke: &str, dash: &str) {
    canvas.polygon(
        &[[x + 4.0, y - 7.0], [x + 30.0, y - 7.0], [x + 30.0, y + 7.0], [x + 4.0, y + 7.0]],
        fill,
        stroke,
        dash,
    );
}

fn hinge(canvas: &mut SceneCanvas, spot: Spot) {
    canvas.circle(spot, 5.0, PAPER, MOTION, 2.2);
}

/// An arc with a head around a hinge; `sense` > 0 anticlockwise.
fn turning(canvas: &mut SceneCanvas, [x, y]: Spot, sense: f64) {
    let radius = 11.0;
    let sign = if sense >= 0.0 { -1.0 } else { 1.0 };
    let on = |angle: f64| [x + radius * angle.cos(), y + radius * angle.sin()];
    let start = if sign < 0.0 { 0.6 } else { std::f64::consts::PI - 0.6 };
    let arc: Vec<Spot> = (0..=16).map(|i| on(start + sign * 4.3 * i as f64 / 16.0)).collect();
    canvas.line(&arc, MOTION, 1.6, "");
    let end = start + sign * 4.3;
    let tip = on(end + sign * 0.5);
    let direction = [-sign * (end + sign * 0.3).sin(), sign * (end + sign * 0.3).cos()];
    canvas.head(tip, direction, 8.0, MOTION);
}

/// Two lines along the unit vector `t` and half arrows: the left side of `t` moves along
/// −`sense`·t relative to the right side (on the canvas, y down).
fn sliding(canvas: &mut SceneCanvas, [x, y]: Spot, t: Spot, length: f64, sense: f64) {
    let across = [-t[1], t[0]];
    let at = |s: f64, d: f64| [x + s * t[0] + d * across[0], y + s * t[1] + d * across[1]];
    let half = length / 2.0;
    for side in [-1.0, 1.0] {
        canvas.line(&[at(-half, 1.8 * side), at(half, 1.8 * side)], MOTION, 1.3, "");
        let way = side * sense;
        let reach = half.clamp(7.0, 16.0);
        canvas.arrow(at(-reach * way, 6.5 * side), at(reach * way, 6.5 * side), MOTION, 1.3, 6.5);
    }
}

fn on_canvas(canvas: &SceneCanvas, direction: Vec2) -> Spot {
    let (from, to) = (canvas.at(Vec2::zeros()), canvas.at(direction));
    let (x, y) = (to[0] - from[0], to[1] - from[1]);
    let length = x.hypot(y).max(1e-12);
    [x / length, y / length]
}

/// Marks hinges, sliding and crushing joints where `place` puts a joint's points, and returns what
/// the legend must say.
pub fn mark(
    canvas: &mut SceneCanvas,
    assembly: &Assembly,
    (result, mechanism): (&CaseResult, &Mechanism),
    senses: bool,
    place: impl Fn(&Joint, Vec2) -> Vec2,
) -> Vec<(Symbol, String)> {
    let mut legend = Vec::new();
    let joint_of = |index: usize| assembly.joints.get(index);
    let crushes = || mechanism.crushing.iter().filter(|crushing| crushing.share > CRUSHES);
    for crushing in crushes() {
        let Some(joint) = joint_of(crushing.joint) else { continue };
        let ends = joint.ends.map(|end| canvas.at(place(joint, end)));
        canvas.line(&ends, CRUSH, 6.0, "");
    }
    for slide in &mechanism.sliding {
        let Some(joint) = joint_of(slide.joint) else { continue };
        let t = on_canvas(canvas, joint.frame().1);
        let length = (joint.height() * canvas.scale()).max(8.0);
        let spot = canvas.at(place(joint, joint.middle()));
        // n is right of t; on the canvas (y down) plus lies where `across` is positive.
        sliding(canvas, spot, t, length, slide.slip.signum());
    }
    let drawn = drawn_hinges(&mechanism.hinges);
    let spots: Vec<(Spot, Spot, String, f64)> = drawn
        .iter()
        .zip(labels(assembly, result, &drawn))
        .filter_map(|(hinge, label)| {
            let main = hinge.main();
            let joint = joint_of(main.joint)?;
            let point = Vec2::from(main.point);
            let outward = on_canvas(canvas, point - joint.middle());
            Some((canvas.at(place(joint, point)), outward, label, main.rotation))
        })
        .collect();
    // The other joints of a hinge open a little.
    for hinge in drawn.iter().flat_map(|hinge| hinge.joints.iter().filter(|own| **own != hinge.main())) {
        if let Some(joint) = joint_of(hinge.joint) {
            let at = canvas.at(place(joint, Vec2::from(hinge.point)));
            canvas.circle(at, 2.5, MOTION, MOTION, 1.0);
        }
    }
    let reach = if senses { 14.0 } else { 7.0 };
    for (spot, _, _, rotation) in &spots {
        hinge(canvas, *spot);
        if senses && spots.len() <= NUMBERED {
            turning(canvas, *spot, *rotation);
        }
        canvas.take(Area::around(*spot, [reach, reach]));
    }
    if spots.len() <= NUMBERED {
        for (spot, outward, text, _) in &spots {
            canvas.label(*spot, *outward, text, MOTION, true);
        }
    }
    if !spots.is_empty() {
        let numbered = match spots.len() {
            count if count > NUMBERED => "(too many to number)",
            _ if spots.iter().any(|(_, _, label, _)| label.contains(',')) => "with its joints, in order of formation",
            _ if drawn.iter().any(|hinge| hinge.joints.len() > 1) => "with its joints; small: opens a little",
            _ => "with its joint's number",
        };
        let symbol = if senses && spots.len() <= NUMBERED { Symbol::TurningHinge } else { Symbol::Hinge };
        let sense =
            if symbol == Symbol::TurningHinge { "; arrow: how its plus side turns (right on arches)" } else { "" };
        legend.push((symbol, format!("hinge {numbered}{sense}")));
    }
    if !mechanism.sliding.is_empty() {
        legend.push((Symbol::Sliding, "sliding joint".into()));
    }
    if crushes().next().is_some() {
        legend.push((Symbol::Crushing, "joint that crushes over more than half its height".into()));
    }
    legend
}
