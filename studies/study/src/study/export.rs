//! A case of any scene as a study of the scene `blocks`: every block by its vertices, every load by its forces.

use super::model::Case;
use super::partial_factors::design;
use crate::scenes::bridge::Damage;
use serde::Deserialize;
use serde_json::{Map, Value as Json, json};
use voussoir_core::model::geometry::Vec2;
use voussoir_core::model::{Assembly, Bond, Joint, PointForce, Stage, fill_weights};

/// Depth of the ground behind a support without a shape, as a share of its face.
const GROUND: f64 = 0.5;

/// Returns the study in TOML. The error names the part that the scene `blocks` does not have.
pub fn as_blocks(case: &Case, name: &str) -> Result<String, String> {
    let assembly = &case.assembly;
    let damage = case.resolved.at("scene.damage").and_then(|list| Vec::<Damage>::deserialize(list).ok());
    if damage.is_some_and(|list| !list.iter().all(|entry| matches!(entry, Damage::LostVoussoir { .. }))) {
        return Err("joints that touch over a part of their edges only have no counterpart there".into());
    }
    let mut study = Map::new();
    study.insert("name".into(), format!("{name}_blocks").into());
    study.insert("scene".into(), scene(case)?);
    let tables = design(&case.resolved, &mut Vec::new());
    for table in ["materials", "joints", "solver"] {
        study.extend(tables.get(table).map(|value| (table.to_string(), value.clone())));
    }
    add_own(&mut study, assembly)?;
    let written = case.resolved.get("stages").and_then(Json::as_array).map(Vec::as_slice).unwrap_or_default();
    let mut gravity = Vec2::zeros();
    let mut stages = Vec::new();
    for (stage, table) in case.stages.iter().zip(written) {
        let change = stage.gravity.map_or(Vec2::zeros(), |now| now - gravity);
        gravity += change;
        stages.extend(stage_tables(assembly, stage, table, change));
    }
    study.insert("stages".into(), stages.into());
    let text = toml::to_string(&without_nulls(Json::Object(study))).map_err(|error| error.to_string())?;
    let resists = !assembly.fill_reactions().is_empty();
    let remark = "# Without the horizontal forces of the fill, which the scene \"blocks\" does not have.\n";
    Ok(format!("{}{text}", if resists { remark } else { "" }))
}

/// Adds joint laws that the scene has made itself.
fn add_own(study: &mut Map<String, Json>, assembly: &Assembly) -> Result<(), String> {
    let Some(tables) = study.get_mut("joints").and_then(Json::as_object_mut) else { return Ok(()) };
    for (name, law) in &assembly.catalogue.laws {
        if !tables.contains_key(name) {
            tables.insert(name.clone(), serde_json::to_value(&**law).map_err(|error| error.to_string())?);
        }
    }
    Ok(())
}

/// Removes keys with the value `null`.
fn without_nulls(value: Json) -> Json {
    match value {
        Json::Object(table) => table
            .into_iter()
            .filter(|(_, value)| !value.is_null())
            .map(|(key, value)| (key, without_nulls(value)))
            .collect(),
        Json::Array(list) => list.into_iter().map(without_nulls).collect(),
        value => value,
    }
}

/// Returns the tables of a stage. If the fill has weight, a stage with all weights comes before it, because the factor of
/// the stage must not multiply them. In this stage the weights grow together as loads: with gravity alone, blocks would have
/// to stand without their fill.
fn stage_tables(assembly: &Assembly, stage: &Stage, table: &Json, gravity: Vec2) -> Vec<Json> {
    let weights = fill_weights(assembly, gravity);
    let point = |force: &PointForce| {
        let (block, point, force): (_, [f64; 2], [f64; 2]) =
            (&assembly.bodies[force.body].name, force.point.into(), force.force.into());
        json!({ "kind": "point", "block": block, "point": point, "force": force })
    };
    let body = |a: &Vec2| json!({ "kind": "body", "acceleration": [a.x, a.y] });
    let mut own = table.clone();
    own["loads"] = stage.forces.iter().map(point).chain(stage.accelerations.iter().map(body)).collect();
    if weights.is_empty() {
        return vec![own];
    }
    let name = format!("{} (weight of blocks and fill)", stage.name);
    let loads: Vec<Json> = weights.iter().map(point).chain([body(&gravity)]).collect();
    own["gravity"].take();
    vec![json!({ "name": name, "loads": loads }), own]
}

/// Returns the table `[scene]`.
fn scene(case: &Case) -> Result<Json, String> {
    let assembly = &case.assembly;
    let catalogue = &assembly.catalogue;
    let mut blocks = Vec::new();
    for (index, body) in assembly.bodies.iter().enumerate() {
        let joints = || assembly.joints.iter().filter(move |joint| joint.minus == index || joint.plus == index);
        let vertices = if body.vertices.is_empty() { ground(index, joints()) } else { body.vertices.clone() };
        if vertices.is_empty() {
            continue;
        }
        let held = joints().any(|joint| {
            let other = if joint.minus == index { joint.plus } else { joint.minus };
            joint.bond == Bond::Bonded && assembly.bodies[other].fixed && assembly.is_rigid(index)
        });
        let outline: Vec<[f64; 2]> = vertices.into_iter().map(Into::into).collect();
        let material = &catalogue.materials[body.material].0;
        blocks
            .push(json!({ "name": body.name, "vertices": outline, "fixed": body.fixed || held, "material": material }));
    }
    let mut pairs = Vec::new();
    let mut first = None;
    for joint in &assembly.joints {
        let names = [joint.minus, joint.plus].map(|body| &assembly.bodies[body].name);
        let fixed = [joint.minus, joint.plus].iter().any(|body| assembly.bodies[*body].fixed);
        match joint.bond {
            Bond::Law(law) => {
                let name = &catalogue.laws[law].0;
                first.get_or_insert(name.clone());
                pairs.push(json!({ "between": names, "joint": name }));
            }
            Bond::Bonded if fixed => {}
            Bond::Bonded => {
                return Err(format!(
                    "\"{}\" and \"{}\" are bonded; scene = \"blocks\" does not support bonded blocks",
                    names[0], names[1]
                ));
            }
        }
    }
    pairs.retain(|pair| pair["joint"].as_str() != first.as_deref());
    pairs.dedup();
    Ok(json!({
        "scene": "blocks", "width": assembly.width, "plane": case.resolved.at("scene.plane"), "mesh": case.resolved.at("scene.mesh"),
        "joint": first, "blocks": blocks, "pairs": pairs,
    }))
}

/// Returns a block of ground behind the joints of a support without a shape.
fn ground<'a>(body: usize, joints: impl Iterator<Item = &'a Joint>) -> Vec<Vec2> {
    let joints: Vec<&Joint> = joints.collect();
    let Some(first) = joints.first() else { return Vec::new() };
    let (normal, along) = first.frame();
    let into = if first.plus == body { normal } else { -normal };
    let ends = || joints.iter().flat_map(|joint| joint.ends);
    let place = |point: &Vec2| point.dot(&along);
    let end = |sign: f64| ends().max_by(|a, b| (sign * place(a)).total_cmp(&(sign * place(b))));
    let (Some(low), Some(high)) = (end(-1.0), end(1.0)) else { return Vec::new() };
    let depth = into * (GROUND * (high - low).norm());
    vec![low, high, high + depth, low + depth]
}
