//! A scene with what its answer says of it: blocks, supports, loads, thrust line or joint forces,
//! hinges, sliding and crushing joints.

use super::fill;
use super::loads::Loads;
use super::scene_canvas::SceneCanvas;
use super::scene_canvas::{REST, hatching};
use super::symbols::{OUTLINE, STONE, STRUT, Symbol, THRUST, ZONE, mark};
use super::thrust::{resultants, strut_lines, thrust_pieces, zone_parts};
use voussoir_core::limit::Status;
use voussoir_core::model::geometry::{Vec2, bounding_box, turned};
use voussoir_core::model::{Assembly, Stage};
use voussoir_study::results::CaseResult;
use voussoir_study::results::carried::JointEntry;
use voussoir_study::results::format::{format_force, headline};

/// Rings of more voussoirs get two faces instead of outlines.
const MANY: usize = 300;

type Legend = Vec<(Symbol, String)>;

/// The drawing of a case, as SVG. `study` is the study's name, `stages` its stages in order.
pub fn scene_svg(title: &str, assembly: &Assembly, stages: &[Stage], result: &CaseResult) -> String {
    let (low, high) = extent(assembly, &[]);
    let reached = result.load_factor.or_else(|| match result.status {
        Status::Stands => result.stages.last().and_then(|stage| stage.factor),
        _ => None,
    });
    let loads = Loads::new(assembly, stages, reached);
    // A served page shows its own title.
    let titles = [title.to_string(), headline(result, stages)];
    let titles = if title.is_empty() { &[] } else { &titles[..] };
    let mut canvas = SceneCanvas::new(low, high, loads.margins(low, high), titles);
    let mut legend = Legend::new();
    let filled = fill::draw(&mut canvas, assembly);
    let spread = filled && fill::draw_spreads(&mut canvas, stages);
    let layered = filled && fill::draw_layers(&mut canvas, assembly);
    blocks(&mut canvas, assembly);
    fill::name_parts(&mut canvas, assembly);
    if filled {
        legend.push((Symbol::Fill, if layered { "fill, in layers" } else { "fill" }.into()));
    }
    if spread {
        legend.push((Symbol::Spread, "axle, and what it loads".into()));
    }
    if fill::mark_lost_mortar(&mut canvas, assembly) {
        legend.push((Symbol::LostMortar, "joint without mortar".into()));
    }
    if assembly.bodies.iter().any(|body| body.fixed) {
        legend.push((Symbol::Ground, "support".into()));
    }
    canvas.open(&[("class", &REST)]);
    if result.status == Status::Unbounded && result.proof.ray.is_some() {
        strut(&mut canvas, assembly, stages, result, &mut legend);
    } else {
        forces(&mut canvas, assembly, result, &mut legend);
    }
    canvas.close();
    canvas.open_metres();
    if let Some(greatest) = fill::draw_forces(&mut canvas, &result.proof.fill) {
        legend.push((Symbol::Pressure, format!("force of the fill (greatest {})", format_force(greatest))));
    }
    loads.draw(&mut canvas);
    if loads.has_arrows() {
        let meaning = if reached.is_some() { "load at this factor" } else { "load, λ is its factor" };
        legend.push((Symbol::Load, meaning.into()));
    }
    if loads.has_earlier() {
        legend.push((Symbol::EarlierLoad, "load of an earlier stage".into()));
    }
    if loads.has_settlements() {
        legend.push((Symbol::Settlement, "support that moves".into()));
    }
    if let Some(mechanism) = &result.mechanism {
        canvas.open(&[("class", &REST)]);
        legend.extend(mark(&mut canvas, assembly, (result, mechanism), false, |_, point| point));
        canvas.close();
    }
    loads.label(&mut canvas);
    let mut caption = loads.sentences().to_vec();
    if result.mechanism.as_ref().is_some_and(|m| m.unique == Some(false)) {
        caption.push("The mechanism is not the only one with this load factor.".into());
    }
    canvas.finish(&legend, &caption)
}

/// Corners of the box around everything \[m\], with further points.
pub(super) fn extent(assembly: &Assembly, further: &[Vec2]) -> (Vec2, Vec2) {
    let vertices = assembly.bodies.iter().flat_map(|body| &body.vertices);
    let fill = assembly.bridge.as_ref().map(fill::outline).unwrap_or_default();
    let points: Vec<&Vec2> =
        vertices.chain(&fill).chain(assembly.joints.iter().flat_map(|joint| &joint.ends)).chain(further).collect();
    if points.is_empty() { (Vec2::zeros(), Vec2::repeat(1.0)) } else { bounding_box(points) }
}

/// Width of a block's outline [px]: thin where blocks are small.
pub(super) fn outline_width(canvas: &SceneCanvas, assembly: &Assembly) -> f64 {
    let free = assembly.bodies.iter().filter(|body| !body.fixed && !body.vertices.is_empty());
    let mut sizes: Vec<f64> = free
        .map(|body| {
            let (low, high) = bounding_box(&body.vertices);
            (high - low).norm() * canvas.scale()
        })
        .collect();
    sizes.sort_by(f64::total_cmp);
    let crowd = 300.0 / sizes.len().max(1) as f64;
    sizes.get(sizes.len() / 2).map_or(1.0, |size| (0.03 * size).min(crowd).clamp(0.05, 1.2))
}

fn blocks(canvas: &mut SceneCanvas, assembly: &Assembly) {
    let width = outline_width(canvas, assembly);
    let shapes = |fixed: bool| assembly.bodies.iter().filter(move |b| b.fixed == fixed).map(|b| b.vertices.as_slice());
    canvas.shapes(shapes(true), &hatching(), OUTLINE, 1.0, "");
    canvas.open(&[("class", &REST)]);
    canvas.shapes(shapes(false), STONE, OUTLINE, width, "");
    faces(canvas, assembly, OUTLINE, |_, point| point);
    canvas.close();
    supports(canvas, assembly);
}

/// Intrados and extrados of rings whose voussoirs are too small to have outlines of their own;
/// `place` says where a point of a body lies.
pub(super) fn faces(canvas: &mut SceneCanvas, assembly: &Assembly, colour: &str, place: impl Fn(usize, Vec2) -> Vec2) {
    let Some(arch) = assembly.arch.as_ref().filter(|arch| arch.voussoirs > MANY) else { return };
    let stride = arch.voussoirs.div_ceil(MANY);
    for left in (0..arch.voussoirs).step_by(stride) {
        let right = (left + stride).min(arch.voussoirs);
        let (Some(first), Some(last)) = (assembly.joints.get(left), assembly.joints.get(right)) else { continue };
        for side in 0..2 {
            let (a, b) = (place(first.plus, first.ends[side]), place(last.minus, last.ends[side]));
            let before = (last.ends[side] - first.ends[side]).norm();
            // A chord that changes its length spans an open hinge.
            if ((b - a).norm() - before).abs() < 1e-3 * before {
                let chord = [canvas.at(a), canvas.at(b)];
                canvas.line(&chord, colour, 0.9, "");
            }
        }
    }
}

/// Hatching along the joints of supports that have no shape.
pub(super) fn supports(canvas: &mut SceneCanvas, assembly: &Assembly) {
    for joint in &assembly.joints {
        let shapeless = |body: usize| assembly.bodies[body].fixed && assembly.bodies[body].vertices.is_empty();
        let towards_ground = match (shapeless(joint.minus), shapeless(joint.plus)) {
            (true, false) => -joint.frame().0,
            (false, true) => joint.frame().0,
            _ => continue,
        };
        let along = joint.frame().1;
        let depth = 11.0 / canvas.scale();
        let reach = along * (8.0 / canvas.scale());
        let (from, to) = (joint.ends[0] - reach, joint.ends[1] + reach);
        let face = [canvas.at(from), canvas.at(to)];
        canvas.line(&face, OUTLINE, 2.2, "");
        let strokes = (((to - from).norm() * canvas.scale()) / 7.0).ceil().max(2.0) as usize;
        let slant = turned(towards_ground) * 0.6;
        for i in 0..=strokes {
            let foot = from + (to - from) * (i as f64 / strokes as f64);
            let stroke = [canvas.at(foot), canvas.at(foot + (towards_ground + slant) * depth)];
            canvas.line(&stroke, "#777777", 1.2, "");
        }
    }
}

fn forces(canvas: &mut SceneCanvas, assembly: &Assembly, result: &CaseResult, legend: &mut Legend) {
    let joint_forces = result.proof.field.as_ref().map(|field| resultants(assembly, field));
    if assembly.arch.is_some() {
        zone(canvas, assembly, &result.carried.joints, legend);
    }
    if let Some(points) = &result.proof.thrust_line {
        let points: Vec<Option<Vec2>> = points.iter().map(|point| point.map(Vec2::from)).collect();
        let pieces = thrust_pieces(assembly, &points, joint_forces.as_deref().unwrap_or(&[]));
        for piece in &pieces {
            let spots: Vec<_> = piece.iter().map(|&point| canvas.at(point)).collect();
            canvas.line(&spots, THRUST, 2.0, "");
        }
        if !pieces.is_empty() {
            legend.push((Symbol::Thrust, "thrust line".into()));
        }
        return;
    }
    let Some(joint_forces) = joint_forces else { return };
    let strongest = joint_forces.iter().flatten().map(|r| r.force.norm()).fold(0.0, f64::max);
    if strongest <= 0.0 {
        return;
    }
    let mut heights: Vec<f64> = assembly.joints.iter().map(|joint| joint.height() * canvas.scale()).collect();
    heights.sort_by(f64::total_cmp);
    let length = (0.6 * heights[heights.len() / 2]).clamp(5.0, 40.0);
    for resultant in joint_forces.iter().flatten() {
        let force = resultant.force.norm();
        let half = resultant.force / force * (length / 2.0);
        let [x, y] = canvas.at(resultant.point);
        let width = (0.3 * length).min(7.0) * force / strongest;
        if width > 0.05 {
            canvas.line(&[[x - half.x, y + half.y], [x + half.x, y - half.y]], THRUST, width, "");
        }
    }
    legend.push((Symbol::Force, format!("joint force, width ∝ force (widest {})", format_force(strongest))));
}

/// The zone of thrust as a band, with the joints across it.
fn zone(canvas: &mut SceneCanvas, assembly: &Assembly, joints: &[JointEntry], legend: &mut Legend) {
    let parts = zone_parts(assembly, joints);
    if !parts.is_empty() {
        canvas.shapes(parts.iter().map(<[Vec2; 4]>::as_slice), ZONE, OUTLINE, outline_width(canvas, assembly), "");
        legend.push((Symbol::Zone, "zone of thrust: all admissible thrust lines cross joints within it".into()));
    }
}

fn strut(canvas: &mut SceneCanvas, assembly: &Assembly, stages: &[Stage], result: &CaseResult, legend: &mut Legend) {
    let ray = resultants(assembly, result.proof.ray.as_deref().unwrap_or(&[]));
    let lines: Vec<Vec<Vec2>> = if assembly.arch.is_some() {
        let points: Vec<_> = ray.iter().map(|r| r.map(|r| r.point)).collect();
        thrust_pieces(assembly, &points, &ray)
    } else {
        let loads: Vec<_> = stages.last().map_or(Vec::new(), |s| s.forces.iter().map(|f| (f.body, f.point)).collect());
        strut_lines(assembly, &ray, &loads).into_iter().map(Vec::from).collect()
    };
    for line in &lines {
        let spots: Vec<_> = line.iter().map(|&point| canvas.at(point)).collect();
        canvas.line(&spots, STRUT, 3.0, "9 5");
    }
    legend.push((Symbol::Strut, "weightless strut that carries the load alone".into()));
}
