//! The fill of a bridge, and what it presses with.

use super::svg_canvas::SvgCanvas;
use super::symbols::{FILL, PRESSURE};
use crate::results::FillEntry;
use voussoir_core::model::geometry::Vec2;
use voussoir_core::model::{Assembly, Bridge};

/// Outline of the fill, anticlockwise: the upper faces from left to right, then the road; empty without fill.
pub fn outline(bridge: &Bridge) -> Vec<Vec2> {
    let (Some(first), Some(last)) = (bridge.extrados.first(), bridge.extrados.last()) else { return Vec::new() };
    let (left, right) = (first.left(), last.right());
    let Some((on_left, on_right)) = bridge.road_at(left).zip(bridge.road_at(right)) else { return Vec::new() };
    let faces = bridge.extrados.iter().flat_map(|chord| chord.ends);
    let inner = bridge.road.iter().copied().filter(|point| left < point.x && point.x < right);
    let road: Vec<Vec2> =
        [Vec2::new(left, on_left)].into_iter().chain(inner).chain([Vec2::new(right, on_right)]).collect();
    faces.chain(road.into_iter().rev()).collect()
}

/// Draws the fill, under the blocks.
pub fn draw(canvas: &mut SvgCanvas, assembly: &Assembly) -> bool {
    let outline = assembly.bridge.as_ref().map(outline).unwrap_or_default();
    if outline.is_empty() {
        return false;
    }
    canvas.outlines([outline.as_slice()].into_iter(), FILL, "#b9ad93", 0.8, "");
    true
}

/// Draws the forces of the fill as arrows, the longest 46 px; the greatest force \[N\] where there is one.
pub fn draw_forces(canvas: &mut SvgCanvas, entries: &[FillEntry]) -> Option<f64> {
    let greatest = entries.iter().map(|entry| entry.force).fold(0.0, f64::max);
    let shown = entries.iter().filter(|entry| entry.force > 1e-3 * greatest);
    for entry in shown {
        let [x, y] = canvas.at(Vec2::from(entry.point));
        let length = 46.0 * entry.force / greatest;
        let from = [x - entry.direction[0] * length, y + entry.direction[1] * length];
        canvas.arrow(from, [x, y], PRESSURE, 1.6, (0.3 * length).clamp(3.0, 7.0));
    }
    (greatest > 0.0).then_some(greatest)
}
