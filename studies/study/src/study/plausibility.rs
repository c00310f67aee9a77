//! Warnings: input that can be computed but is probably not meant. They become notes of the case, not mistakes.

use super::resolved::Resolved;
use crate::config::common_keys::tag_of;
use crate::scenes::bridge::Fill;
use crate::space::near::warnings_of_blocks;
use serde::Deserialize;
use serde_json::Value as Json;
use voussoir_core::model::geometry::{Vec2, bounding_box};
use voussoir_core::model::{Assembly, Body, Joint, Stage, Target, root};
use voussoir_core::plugin::PluginKind;
use voussoir_core::space::SpaceAssembly;

/// Plausible densities of masonry and fill \[kg/m³\].
const DENSITIES: [f64; 2] = [1000.0, 3500.0];
/// Greatest plausible coefficient of friction: an angle of 56°.
const FRICTION: f64 = 1.5;
/// Least plausible angle of friction of a fill \[°\].
const FILL_FRICTION: f64 = 2.0;
/// An opening between blocks that is smaller than this share of the scene's size causes a warning.
const GAP: f64 = 1e-3;
/// Greatest sine of the angle between edges that face each other.
const SLANT: f64 = 0.05;
/// Greatest number of names in a warning; further ones are counted.
const LISTED: usize = 3;

/// Returns the warnings of a case, from its checked study and its scene.
pub(super) fn warnings(resolved: &Resolved, assembly: &Assembly, stages: &[Stage]) -> Vec<String> {
    let mut found = Vec::new();
    densities(assembly, &mut found);
    if let Some(fill) = resolved.at("scene.fill").and_then(|fill| Fill::deserialize(fill).ok()) {
        densities_of_fill(&fill, &mut found);
        frictions_of_fill(&fill, &mut found);
    }
    stages.iter().enumerate().for_each(|(index, stage)| doubted_stage(index, stage, assembly, &mut found));
    for (name, law) in resolved.get("joints").and_then(Json::as_object).into_iter().flatten() {
        if let Some(friction) = law.get("friction").and_then(Json::as_f64).filter(|friction| *friction > FRICTION) {
            found.push(format!(
                "joints.{name}.friction = {} is an angle of {:.0}°; stone on stone has 0.5 to 0.8",
                if friction < 1e6 { friction.to_string() } else { format!("{friction:e}") },
                friction.atan().to_degrees()
            ));
        }
    }
    let number = |key: &str| resolved.at(key).and_then(Json::as_f64);
    if let (Some(thickness), Some(span)) = (number("scene.thickness"), number("scene.profile.span"))
        && thickness > span
    {
        found.push(format!("scene.thickness = {thickness} m is more than the span of {span} m"));
    }
    // Other scenes create their joints themselves.
    if resolved.get("scene").is_some_and(|scene| tag_of(PluginKind::Scene, scene) == "blocks") {
        small_gaps(assembly, &mut found);
        floating(assembly, &mut found);
    }
    found
}

/// Returns the warnings about blocks in space.
pub(super) fn space_warnings(resolved: &Resolved, assembly: &SpaceAssembly) -> Vec<String> {
    // Other scenes create their contacts themselves.
    let given = |scene: &Json| matches!(tag_of(PluginKind::Scene, scene), "assembly" | "blocks_3d");
    if resolved.get("scene").is_some_and(given) { warnings_of_blocks(assembly) } else { Vec::new() }
}

fn densities(assembly: &Assembly, found: &mut Vec<String>) {
    for (index, (name, material)) in assembly.catalogue.materials.iter().enumerate() {
        let used = assembly.bodies.iter().any(|body| body.material == index && !body.fixed);
        if used {
            found.extend(doubted(&format!("materials.{name}.density"), material.density()));
        }
    }
}

fn densities_of_fill(fill: &Fill, found: &mut Vec<String>) {
    let backing = fill.haunching.and_then(|backing| backing.density);
    let own = [("density".to_string(), Some(fill.density)), ("haunching.density".into(), backing)];
    let layers = fill.layers.iter().enumerate();
    let layers = layers.map(|(i, layer)| (format!("layers.{i}.density"), Some(layer.density)));
    let given = own.into_iter().chain(layers).filter_map(|(key, value)| Some((key, value?)));
    found.extend(given.filter_map(|(key, density)| doubted(&format!("scene.fill.{key}"), density)));
}

/// Warns of angles of friction of a fill that are so small that they may be radians or coefficients.
fn frictions_of_fill(fill: &Fill, found: &mut Vec<String>) {
    let layers = fill.layers.iter().enumerate();
    let layers = layers.map(|(i, layer)| (format!("layers.{i}.friction_angle"), layer.friction_angle));
    let all = [("friction_angle".to_string(), fill.friction_angle)].into_iter().chain(layers);
    for (key, angle) in all.filter_map(|(key, value)| Some((key, value?))) {
        if (0.0..FILL_FRICTION).contains(&angle) && angle > 0.0 {
            found.push(format!(
                "scene.fill.{key} = {angle}° is less than {FILL_FRICTION}°; the angle of a fill is given in degrees"
            ));
        }
    }
}

/// Warns of loads that point upwards, and of supports of arches that move further than the thickness of the ring.
fn doubted_stage(index: usize, stage: &Stage, assembly: &Assembly, found: &mut Vec<String>) {
    let sense = match stage.target {
        Target::Factor(factor) => factor,
        Target::Collapse => 1.0,
    };
    let upwards = sense * stage.forces.iter().map(|force| force.force.y).sum::<f64>();
    let size: f64 = stage.forces.iter().map(|force| force.force.norm()).sum();
    if upwards > 1e-9 * size {
        found.push(format!(
            "stages.{index}.loads: the resultant of stage \"{}\" points upwards; y is positive upwards",
            stage.name
        ));
    }
    if assembly.arch.is_none() && assembly.bridge.is_none() {
        return;
    }
    let thickness = assembly.joints.iter().map(Joint::height).fold(0.0, f64::max);
    for (number, settlement) in stage.settlements.iter().enumerate() {
        let moved = settlement.displacement.norm();
        if moved > thickness {
            found.push(format!(
                "stages.{index}.settlement.{number}: \"{}\" moves by {moved} m, more than the thickness of {thickness:.3} m",
                assembly.bodies[settlement.body].name
            ));
        }
    }
}

/// Returns a warning if a density is unusual for masonry and fill; zero is intended and gives none.
fn doubted(key: &str, density: f64) -> Option<String> {
    let help = if (10.0..40.0).contains(&density) {
        format!("; a specific weight is written \"{density} kN/m3\"")
    } else {
        String::new()
    };
    let implausible = density != 0.0 && !(DENSITIES[0]..=DENSITIES[1]).contains(&density);
    implausible.then(|| {
        let [least, greatest] = DENSITIES;
        format!("{key} = {density} kg/m3 is outside {least} to {greatest}, where masonry is{help}")
    })
}

/// Returns the greatest distance of two edges over the length on which they face each other; `None` if they do not face each
/// other, or if they touch.
fn facing([a, b]: [Vec2; 2], [c, d]: [Vec2; 2], size: f64) -> Option<f64> {
    let length = (b - a).norm();
    let along = (b - a) / length;
    let (across, other) = (Vec2::new(-along.y, along.x), d - c);
    // Both polygons have the same orientation: facing edges have opposite directions.
    if other.dot(&along) >= 0.0 || other.dot(&across).abs() > SLANT * other.norm() {
        return None;
    }
    let [from, to] = [(d - a).dot(&along), (c - a).dot(&along)];
    let (low, high) = (from.max(0.0), to.min(length));
    if high - low <= 0.01 * length.min(other.norm()) {
        return None;
    }
    let at = |s: f64| ((d - a).dot(&across) + (c - d).dot(&across) * (s - from) / (to - from)).abs();
    let [near, far] = [at(low), at(high)];
    let widest = near.max(far);
    (widest > 1e-9 * size && widest < GAP * size).then_some(widest)
}

fn edges(body: &Body) -> impl Iterator<Item = [Vec2; 2]> {
    (0..body.vertices.len()).map(|i| [body.vertices[i], body.vertices[(i + 1) % body.vertices.len()]])
}

/// Warns of blocks that nearly touch and share no joint.
fn small_gaps(assembly: &Assembly, found: &mut Vec<String>) {
    let size = assembly.size();
    let boxes: Vec<(usize, Vec2, Vec2)> = (0..assembly.bodies.len())
        .filter(|body| !assembly.bodies[*body].vertices.is_empty())
        .map(|body| {
            let (low, high) = bounding_box(&assembly.bodies[body].vertices);
            (body, low, high)
        })
        .collect();
    let mut order = boxes.clone();
    order.sort_by(|a, b| a.1.x.total_cmp(&b.1.x));
    let joined: std::collections::HashSet<[usize; 2]> =
        assembly.joints.iter().map(|joint| [joint.minus.min(joint.plus), joint.minus.max(joint.plus)]).collect();
    let mut pairs = Vec::new();
    for (place, (a, low, high)) in order.iter().enumerate() {
        let near = order[place + 1..].iter().take_while(|(_, other, _)| other.x <= high.x + GAP * size);
        for (b, other_low, other_high) in near {
            let level = other_low.y <= high.y + GAP * size && low.y <= other_high.y + GAP * size;
            let bodies = [*a, *b].map(|body| &assembly.bodies[body]);
            if !level || bodies.iter().all(|body| body.fixed) || joined.contains(&[*a.min(b), *a.max(b)]) {
                continue;
            }
            let facing = edges(bodies[0]).flat_map(|e| edges(bodies[1]).filter_map(move |f| facing(e, f, size)));
            if let Some(widest) = facing.reduce(f64::max) {
                pairs.push((bodies.map(|body| body.name.as_str()), widest));
            }
        }
    }
    for ([a, b], widest) in pairs.iter().take(LISTED) {
        found.push(format!(
            "blocks \"{a}\" and \"{b}\" face each other up to {:.3} mm apart, less than 1/1000 of the scene, and share no \
             joint: let their edges touch, or give the opening as gap of a pair",
            widest * 1e3
        ));
    }
    if pairs.len() > LISTED {
        found.push(format!("{} more pairs of blocks nearly touch and share no joint", pairs.len() - LISTED));
    }
}

/// Warns of free blocks without a chain of joints to the ground.
fn floating(assembly: &Assembly, found: &mut Vec<String>) {
    let mut parent: Vec<usize> = (0..assembly.bodies.len()).collect();
    for joint in &assembly.joints {
        let (a, b) = (root(&mut parent, joint.minus), root(&mut parent, joint.plus));
        parent[a] = b;
    }
    let roots: Vec<usize> = (0..assembly.bodies.len()).map(|body| root(&mut parent, body)).collect();
    let mut held = vec![false; roots.len()];
    (0..roots.len()).filter(|body| assembly.bodies[*body].fixed).for_each(|body| held[roots[body]] = true);
    let loose: Vec<String> = (0..roots.len())
        .filter(|body| !held[roots[*body]])
        .map(|body| format!("\"{}\"", assembly.bodies[body].name))
        .collect();
    if loose.is_empty() {
        return;
    }
    let more = loose.len().saturating_sub(LISTED);
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    let names = loose[..loose.len().min(LISTED)].join(", ");
    found.push(format!("no chain of joints joins {names}{more} to a fixed block: nothing holds what floats"));
}
