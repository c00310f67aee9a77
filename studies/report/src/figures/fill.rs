//! The fill of a bridge, and what it presses with.

use super::scene_canvas::SceneCanvas;
use super::symbols::{FILL, LOAD, LOST, OUTLINE, PRESSURE, SPREAD};
use voussoir_core::model::geometry::{Vec2, area_and_centroid};
use voussoir_core::model::{Assembly, Body, Bridge, Stage};
use voussoir_plot::svg::SMALL;
use voussoir_study::results::FillEntry;
use voussoir_study::scenes::abutments;

/// Places at which it is asked where a layer ends.
const SAMPLES: usize = 600;

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
pub fn draw(canvas: &mut SceneCanvas, assembly: &Assembly) -> bool {
    let outline = assembly.bridge.as_ref().map(outline).unwrap_or_default();
    if outline.is_empty() {
        return false;
    }
    canvas.shapes([outline.as_slice()].into_iter(), FILL, "#b9ad93", 0.8, "");
    true
}

/// Draws where layers end, as dashed lines; whether there are any.
pub fn draw_layers(canvas: &mut SceneCanvas, assembly: &Assembly) -> bool {
    let Some(bridge) = &assembly.bridge else { return false };
    let (Some(first), Some(last)) = (bridge.extrados.first(), bridge.extrados.last()) else { return false };
    let place = |i: usize| first.left() + (last.right() - first.left()) * i as f64 / SAMPLES as f64;
    let within = |x: f64, level: f64| {
        let above = bridge.extrados.iter().filter(|chord| chord.left() <= x && x <= chord.right());
        let face = above.map(|chord| chord.at(x).y).fold(f64::NEG_INFINITY, f64::max);
        face < level && bridge.road_at(x).is_some_and(|road| level < road)
    };
    let mut drawn = false;
    for &(level, _) in bridge.layers.iter().filter(|(level, _)| level.is_finite()) {
        let mut start = None;
        for i in 0..=SAMPLES + 1 {
            let inside = i <= SAMPLES && within(place(i), level);
            match (inside, start) {
                (true, None) => start = Some(place(i)),
                (false, Some(from)) => {
                    let ends = [from, place(i - 1)].map(|x| canvas.at(Vec2::new(x, level)));
                    canvas.line(&ends, "#b9ad93", 1.0, "5 4");
                    (start, drawn) = (None, true);
                }
                _ => {}
            }
        }
    }
    drawn
}

/// Draws how the loads of the last stage spread between road and extrados; whether there are any.
pub fn draw_spreads(canvas: &mut SceneCanvas, stages: &[Stage]) -> bool {
    let spreads = stages.last().map_or(&[][..], |stage| &stage.spreads);
    for spread in spreads {
        let [a, b] = spread.on_road.map(|point| canvas.at(point));
        let [c, d] = spread.below.map(|point| canvas.at(point));
        canvas.polygon(&[a, b, d, c], SPREAD, LOAD, "");
        canvas.line(&[a, b], LOAD, 4.0, "");
    }
    !spreads.is_empty()
}

fn is_abutment(body: &Body) -> bool {
    abutments::NAMES.contains(&body.name.as_str())
}

/// Writes the names of spans, piers and abutments, as results have them.
pub fn name_parts(canvas: &mut SceneCanvas, assembly: &Assembly) {
    if assembly.bridge.is_none() {
        return;
    }
    for (prefix, part) in (0..).map(|i| (format!("s{i}r0v"), format!("span {i}"))) {
        let ring = assembly.bodies.iter().filter(|body| body.name.starts_with(&prefix));
        let points: Vec<Vec2> = ring.flat_map(|body| body.vertices.iter().copied()).collect();
        if points.is_empty() {
            break;
        }
        let reach = |pick: fn(f64, f64) -> f64, from: f64| points.iter().map(|p| p.x).fold(from, pick);
        let middle = (reach(f64::min, f64::INFINITY) + reach(f64::max, f64::NEG_INFINITY)) / 2.0;
        let low = points.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
        let [x, y] = canvas.at(Vec2::new(middle, low));
        canvas.text([x, y], "middle", SMALL, &part, OUTLINE, false);
    }
    for (index, part) in (0..).map(|i| (i, format!("pier {i}"))) {
        let courses: Vec<_> = assembly
            .bodies
            .iter()
            .filter(|body| body.name.starts_with(&format!("p{index}c")) && !body.name.ends_with("cap"))
            .collect();
        let Some(course) = courses.get(courses.len() / 2) else { break };
        let count = course.vertices.len() as f64;
        let [x, y] = canvas.at(course.vertices.iter().sum::<Vec2>() / count);
        canvas.text([x, y + 4.0], "middle", SMALL, &part, OUTLINE, false);
    }
    for body in assembly.bodies.iter().filter(|body| is_abutment(body)) {
        let [x, y] = canvas.at(area_and_centroid(&body.vertices).1);
        canvas.text([x, y + 4.0], "middle", SMALL, "abutment", OUTLINE, false);
    }
}

/// Marks the parts of joints that have lost their mortar: where a joint ends before the edges of its blocks do; whether
/// there are any.
pub fn mark_lost_mortar(canvas: &mut SceneCanvas, assembly: &Assembly) -> bool {
    let Some(bridge) = &assembly.bridge else { return false };
    let size = assembly.size();
    let mut found = false;
    let across = |index: usize, name: &str| index < bridge.radial || name.starts_with('p');
    for (index, joint) in assembly.joints.iter().enumerate() {
        if !across(index, &assembly.bodies[joint.plus].name) {
            continue;
        }
        let along = joint.frame().1;
        for (end, outwards) in [(joint.ends[0], -along), (joint.ends[1], along)] {
            // Caps of piers and abutments reach over all rings that end on them.
            let voussoirs = [joint.minus, joint.plus].map(|body| &assembly.bodies[body]);
            let voussoirs = voussoirs.into_iter().filter(|body| !body.name.starts_with('p') && !is_abutment(body));
            let beyond = voussoirs.flat_map(|body| &body.vertices).filter(|vertex| {
                let way = **vertex - end;
                way.norm() > 1e-9 * size && (way.normalize() - outwards).norm() < 1e-6
            });
            let Some(face) = beyond.min_by(|a, b| (**a - end).norm().total_cmp(&(**b - end).norm())) else { continue };
            // Where it is repointed another joint stands in its place.
            let middle = (end + face) / 2.0;
            let stands = |other: &voussoir_core::model::Joint| {
                (other.middle() - middle).norm() < 1e-6 * size
                    && [other.minus, other.plus] == [assembly.joints[index].minus, assembly.joints[index].plus]
            };
            if !assembly.joints.iter().skip(bridge.radial).any(stands) {
                let ends = [canvas.at(end), canvas.at(*face)];
                canvas.line(&ends, LOST, 3.0, "");
                found = true;
            }
        }
    }
    found
}

/// Draws the forces of the fill as arrows, the longest 46 px; the greatest force \[N\] where there is one.
pub fn draw_forces(canvas: &mut SceneCanvas, entries: &[FillEntry]) -> Option<f64> {
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
