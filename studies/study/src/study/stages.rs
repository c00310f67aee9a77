//! The stages of a case: the action of loads, gravity and settlements on the blocks.

use super::diagnostics::DiagnosticList;
use super::resolved::Resolved;
use super::tables::{FieldTable, Gravity, Rotation, SettlementTable, StageTable, Until};
use crate::config::diagnostic::suggest;
use crate::config::dotted_key::join;
use crate::loads::{Components, LoadKind, LoadSite, LoadTables, Placed};
use serde::Deserialize;
use serde_json::Value as Json;
use voussoir_core::model::geometry::Vec2;
use voussoir_core::model::{Assembly, Joint, Settlement, Stage, Target};

/// Returns all stages; `None` if there is no list of them.
pub(super) fn build_stages(
    diagnostics: &mut DiagnosticList<'_>,
    resolved: &Resolved,
    written: &[StageTable],
    assembly: Option<&Assembly>,
    notes: &mut Vec<String>,
) -> Option<Vec<Stage>> {
    if written.len() != resolved.get("stages")?.as_array().map_or(0, Vec::len) {
        diagnostics.wrong("stages", "cannot be read", "correct this list");
        return None;
    }
    let tables = load_tables(resolved);
    let before = diagnostics.found.len();
    let mut out: Vec<Stage> = Vec::new();
    for (index, raw) in written.iter().enumerate() {
        let at = format!("stages.{index}");
        let (target, factors) = build_target(diagnostics, written, index, &at);
        let settlements = assembly.map(|assembly| build_settlements(diagnostics, &raw.settlement, assembly, &at));
        let settlements = settlements.unwrap_or_default();
        let (placed, whole) = build_loads(diagnostics, &raw.loads, assembly, &tables, &at);
        let Placed { forces, accelerations, spreads, notes: own } = placed;
        let stage = Stage {
            name: raw.name.clone(),
            gravity: raw.gravity.and_then(|gravity| match gravity {
                Gravity::Down(down) => Some(Vec2::new(0.0, -down)),
                Gravity::Vector(vector) => Some(Vec2::from(vector)),
                Gravity::Space(_) => {
                    plane_gravity(diagnostics, assembly, &at);
                    None
                }
            }),
            forces,
            accelerations,
            spreads,
            settlements,
            target,
            factor_min: factors[0],
            factor_max: factors[1],
            duration: raw.duration.unwrap_or(0.0),
            fields: build_fields(diagnostics, written, index, &at),
        };
        // A vehicle that is off the bridge is not a mistake: a note reports it.
        let stands_off = !own.is_empty();
        notes.extend(own);
        if whole && assembly.is_some() && diagnostics.found.len() == before && !stands_off && raises_nothing(&stage) {
            let help = "give this stage a load that is not zero; gravity is not multiplied by the factor";
            let until = raw.until.map_or("", Until::word);
            let message = format!("\"{until}\" needs a load to raise, but this stage has none");
            diagnostics.wrong(&join(&at, "until"), message, help);
        }
        out.push(stage);
    }
    Some(out)
}

/// Reports a gravity with three components in a plane scene.
fn plane_gravity(diagnostics: &mut DiagnosticList<'_>, assembly: Option<&Assembly>, at: &str) {
    if assembly.is_some() {
        let message = "has three components, but the scene is plane";
        diagnostics.wrong(&join(at, "gravity"), message, "write [gx, gy] with y upwards, or one number");
    }
}

/// Returns true if a stage continues until collapse but has no growing load.
fn raises_nothing(stage: &Stage) -> bool {
    stage.target == Target::Collapse
        && stage.forces.iter().all(|force| force.force.norm() == 0.0)
        && stage.accelerations.iter().all(|acceleration| acceleration.norm() == 0.0)
        && stage.settlements.is_empty()
}

/// Returns the fields at the end of a stage; also checks its duration. Time and fields go with the factor, so a stage in
/// which they change needs a factor.
fn build_fields(
    diagnostics: &mut DiagnosticList<'_>,
    stages: &[StageTable],
    index: usize,
    at: &str,
) -> Vec<(String, f64)> {
    let stage = &stages[index];
    let lasts = stage.duration.is_some_and(|duration| duration > 0.0);
    let values = stage.fields.as_ref().map_or_else(Vec::new, FieldTable::values);
    let before = |name: &str| {
        let earlier = stages[..index].iter().rev().filter_map(|stage| stage.fields.as_ref());
        earlier.flat_map(FieldTable::values).find(|(_, own, _)| own == name).map(|(.., value)| value)
    };
    for (position, (key, name, value)) in values.iter().enumerate() {
        let key = format!("{at}.fields.{key}");
        if values[..position].iter().any(|(_, own, _)| own == name) {
            let message = format!("the field \"{name}\" is set twice");
            diagnostics.wrong(&key, message, "remove this entry: this field has a separate key");
        }
        let last = before(name);
        if index > 0 && last.is_none() {
            let message =
                format!("the first stage does not set the field \"{name}\", so it has no value to change from");
            diagnostics.wrong(&key, message, "set the field in the first stage too, to its value at the start");
        }
        if stage.until.is_some() && last.is_some_and(|last| last != *value) {
            let message = "fields grow to the factor of a stage, and this stage has none";
            diagnostics.wrong(&key, message, "change the field in a stage before, or give this stage a factor");
        }
        if stage.factor == Some(0.0) && last.is_some_and(|last| last != *value) {
            diagnostics.wrong(&key, "fields grow with the factor, which stays 0", "give this stage another factor");
        }
    }
    if lasts && stage.until.is_some() {
        let message = "time grows to the factor of a stage, and this stage has none";
        diagnostics.wrong(
            &join(at, "duration"),
            message,
            "let time pass in a stage before, or give this stage a factor",
        );
    }
    if lasts && stage.factor == Some(0.0) {
        let message = "time grows with the factor, which stays 0";
        diagnostics.wrong(&join(at, "duration"), message, "give this stage another factor, such as 1");
    }
    values.into_iter().map(|(_, name, value)| (name, value)).collect()
}

/// Returns the tables to which loads refer: vehicles, and the law of dispersion in the fill. They are already checked.
fn load_tables(resolved: &Resolved) -> LoadTables {
    let vehicles = resolved.read("vehicles");
    let dispersion = resolved.at("scene.fill.dispersion").and_then(|law| Deserialize::deserialize(law).ok());
    LoadTables { vehicles: vehicles.unwrap_or_default(), dispersion }
}

/// Returns the end of a stage, and the least and greatest factor of its search; also checks its name.
fn build_target(
    diagnostics: &mut DiagnosticList<'_>,
    stages: &[StageTable],
    index: usize,
    at: &str,
) -> (Target, [f64; 2]) {
    let stage = &stages[index];
    if stages[..index].iter().any(|earlier| earlier.name == stage.name) {
        let message = format!("two stages are called \"{}\"", stage.name);
        diagnostics.wrong(&join(at, "name"), message, "give each stage a name of its own");
    }
    let until = stage.until.map(Until::word);
    if let Some(until) = until.filter(|_| stage.factor.is_some()) {
        let help = format!("keep until to raise the loads to {}, or factor to stop at that factor", until_words(until));
        diagnostics.wrong(&join(at, "factor"), format!("is given besides until = \"{until}\""), help);
    }
    if let Some(until) = until.filter(|_| index + 1 < stages.len()) {
        let message = format!("\"{until}\" is only possible in the last stage: nothing can be loaded after it");
        diagnostics.wrong(&join(at, "until"), message, "make it the last stage, or give this stage a factor");
    }
    let (least, greatest) = (stage.factor_min.unwrap_or(0.0), stage.factor_max.unwrap_or(f64::INFINITY));
    if least > greatest {
        let named = if stage.factor_max.is_some() { "factor_max" } else { "factor_min" };
        let message = format!("the search would go from factor_min = {least} to factor_max = {greatest}");
        diagnostics.wrong(&join(at, named), message, "factor_min must be at most factor_max");
    }
    let target = if until.is_some() { Target::Collapse } else { Target::Factor(stage.factor.unwrap_or(1.0)) };
    (target, [least, greatest])
}

/// Returns a value of `until` as words in a sentence.
fn until_words(until: &str) -> &str {
    if until == Until::FirstLimitPoint.word() { "the first limit point" } else { until }
}

/// Returns forces on blocks and accelerations of all blocks, load by load, and true if no load is missing.
fn build_loads(
    diagnostics: &mut DiagnosticList<'_>,
    loads: &[Json],
    assembly: Option<&Assembly>,
    tables: &LoadTables,
    at: &str,
) -> (Placed, bool) {
    let (mut all, mut whole) = (Placed::default(), true);
    for (number, table) in loads.iter().enumerate() {
        let path = format!("{at}.loads.{number}");
        let load: Option<Box<dyn LoadKind>> = match Deserialize::deserialize(table) {
            Ok(load) => Some(load),
            Err(error) => {
                diagnostics.wrong(&path, format!("cannot be read: {error}"), "correct this load");
                None
            }
        };
        let (Some(load), Some(assembly)) = (load, assembly) else { continue };
        match load.place(&LoadSite::new(assembly, tables, &path)) {
            Ok(Placed { forces: placed, accelerations: accelerated, spreads, notes }) => {
                let (groups, _) = assembly.rigid_groups();
                let held = placed.iter().find(|f| groups[f.body].is_none() && assembly.is_rigid(f.body));
                if let Some(force) = held {
                    let name = &assembly.bodies[force.body].name;
                    let message = format!(
                        "the load acts on \"{name}\", which is rigid and held by the ground, so it has no effect"
                    );
                    let help = "move the load to a block that can move, or join the ends: ends = \"jointed\"";
                    diagnostics.wrong(&path, message, help);
                }
                all.forces.extend(placed);
                all.accelerations.extend(accelerated);
                all.spreads.extend(spreads);
                all.notes.extend(notes);
            }
            Err(wrong) => {
                whole = false;
                diagnostics.extend(wrong);
            }
        }
    }
    (all, whole)
}

/// Returns the index of the support with a name among bodies with their names, which are held or free; reports a mistake if
/// no support has this name.
pub(super) fn support(
    diagnostics: &mut DiagnosticList<'_>,
    name: &str,
    bodies: &[(&str, bool)],
    at: &str,
) -> Option<usize> {
    let place = bodies.iter().position(|(own, _)| *own == name);
    if let Some(body) = place.filter(|body| bodies[*body].1) {
        return Some(body);
    }
    let message = match place {
        Some(_) => format!("\"{name}\" is no support: the block is free and moves by itself"),
        None => format!("there is no support \"{name}\""),
    };
    let held: Vec<&str> = bodies.iter().filter(|(_, held)| *held).map(|(own, _)| *own).collect();
    diagnostics.wrong(&format!("{at}.support"), message, suggest(name, &held, "supports here"));
    None
}

/// Returns the movements of supports in a stage.
fn build_settlements(
    diagnostics: &mut DiagnosticList<'_>,
    list: &[SettlementTable],
    assembly: &Assembly,
    at: &str,
) -> Vec<Settlement> {
    let mut out = Vec::new();
    for (number, entry) in list.iter().enumerate() {
        let bodies: Vec<(&str, bool)> = assembly.bodies.iter().map(|b| (b.name.as_str(), b.fixed)).collect();
        let at = format!("{at}.settlement.{number}");
        let Some(body) = support(diagnostics, &entry.support, &bodies, &at) else { continue };
        let (Some(displacement), Rotation::Plane(rotation)) = (entry.displacement.plane(), entry.rotation) else {
            let help = "write displacement = [x, y] with y upwards, and rotation as one number";
            diagnostics.wrong(&at, "has components in space, but the scene is plane", help);
            continue;
        };
        let joint = assembly.joints.iter().find(|joint| joint.minus == body || joint.plus == body);
        let about = joint.map_or(Vec2::zeros(), Joint::middle);
        out.push(Settlement { body, displacement, rotation, about });
    }
    out
}
