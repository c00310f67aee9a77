//! Partial factors: from the characteristic values of a study to the design values of the computation.
//!
//! The resolved case keeps the characteristic values; blocks, joints, fill and loads are built from the design values.
//! Weights and loads are multiplied, strengths and coefficients of friction are divided.

use super::diagnostics::DiagnosticList;
use super::resolved::Resolved;
use super::tables::StageTable;
use crate::config::common_keys::tag_of;
use crate::config::dotted_key::join;
use serde_json::{Map, Value as Json};
use std::borrow::Cow;
use std::collections::BTreeMap;
use voussoir_core::model::{Assembly, Stage};
use voussoir_core::plugin::{Keys, PluginKind, card, nearest};
use voussoir_core::space::SpaceStage;

/// Factors on loads.
#[derive(Debug, Clone, Keys)]
#[keys(untagged)]
pub enum LoadFactors {
    /// One factor for all stages.
    #[key(unit = "-", range = "> 0")]
    All(f64),
    /// Factors by the names of stages.
    #[key(unit = "-", range = "> 0")]
    Stages(BTreeMap<String, f64>),
}

/// `[factors]`.
#[derive(Debug, Clone, Keys)]
pub struct Factors {
    /// partial factor on the density of every material, which is multiplied
    #[key(unit = "-", range = "> 0", optional = "1")]
    masonry_weight: Option<f64>,
    /// partial factor on the weight of the fill, which multiplies the densities of fill, layers and backing
    #[key(unit = "-", range = "> 0", optional = "1")]
    fill_weight: Option<f64>,
    /// partial factor on loads, for all stages or for the stages named: { live = 1.5 }
    #[key(optional = "1")]
    loads: Option<LoadFactors>,
    /// partial factor on the friction of joints and of bases of abutments, whose coefficients are divided
    #[key(unit = "-", range = "> 0", optional = "1")]
    friction: Option<f64>,
    /// partial factor on the cohesion of joints, which is divided
    #[key(unit = "-", range = "> 0", optional = "1")]
    cohesion: Option<f64>,
    /// partial factor on the tensile strength of joints, which is divided
    #[key(unit = "-", range = "> 0", optional = "1")]
    tensile_strength: Option<f64>,
    /// partial factor on the crushing strength of joints, which is divided
    #[key(unit = "-", range = "> 0", optional = "1")]
    compressive_strength: Option<f64>,
    /// partial factor on the friction of the fill, which divides the tangents of its angles of friction
    #[key(unit = "-", range = "> 0", optional = "1")]
    fill_friction: Option<f64>,
    /// partial factor on the cohesion of the fill, which is divided
    #[key(unit = "-", range = "> 0", optional = "1")]
    fill_cohesion: Option<f64>,
    /// partial factor on the strength of the backing of rings and abutments, which is divided
    #[key(unit = "-", range = "> 0", optional = "1")]
    backing_strength: Option<f64>,
}

/// The numbers of a table that a factor changes.
enum Change {
    Times,
    Over,
    TangentOver,
}

impl Change {
    fn apply(&self, number: f64, factor: f64) -> f64 {
        match self {
            Change::Times => number * factor,
            Change::Over => number / factor,
            Change::TangentOver => (number.to_radians().tan() / factor).atan().to_degrees(),
        }
    }
}

/// Applies `act` to the tables under a dotted path; `*` matches every entry of a table or a list.
fn each<'a>(value: &'a mut Json, path: &str, act: &mut dyn FnMut(&mut Json)) {
    let (first, rest) = path.split_once('.').map_or((path, None), |(first, rest)| (first, Some(rest)));
    let mut next = |value: &mut Json| match rest {
        Some(rest) => each(value, rest, act),
        None => act(value),
    };
    match value {
        Json::Object(table) if first == "*" => table.values_mut().for_each(&mut next),
        Json::Array(list) if first == "*" => list.iter_mut().for_each(&mut next),
        Json::Object(table) => {
            if let Some(value) = table.get_mut(first) {
                next(value);
            }
        }
        _ => {}
    }
}

/// The numbers that each factor changes.
const CHANGES: &[(&str, &str, Change)] = &[
    ("masonry_weight", "materials.*.density", Change::Times),
    ("fill_weight", "scene.fill.density", Change::Times),
    ("fill_weight", "scene.fill.layers.*.density", Change::Times),
    ("fill_weight", "scene.fill.haunching.density", Change::Times),
    ("friction", "joints.*.friction", Change::Over),
    ("friction", "joints.*.friction_angle", Change::TangentOver),
    ("friction", "joints.*.dilatancy_angle", Change::TangentOver),
    ("friction", "scene.abutments.base_friction", Change::Over),
    ("friction", "scene.abutments.*.base_friction", Change::Over),
    ("cohesion", "joints.*.cohesion", Change::Over),
    ("tensile_strength", "joints.*.tensile_strength", Change::Over),
    ("compressive_strength", "joints.*.compressive_strength", Change::Over),
    ("fill_friction", "scene.fill.friction_angle", Change::TangentOver),
    ("fill_friction", "scene.fill.layers.*.friction_angle", Change::TangentOver),
    ("fill_cohesion", "scene.fill.cohesion", Change::Over),
    ("fill_cohesion", "scene.fill.layers.*.cohesion", Change::Over),
    ("backing_strength", "scene.fill.haunching.strength", Change::Over),
    ("backing_strength", "scene.abutments.backing", Change::Over),
    ("backing_strength", "scene.abutments.*.backing", Change::Over),
];

/// Returns the tables of a checked case with its design values. Adds a note for factors that change nothing.
pub fn design<'a>(resolved: &'a Resolved, notes: &mut Vec<String>) -> Cow<'a, Resolved> {
    let Some(factors) = resolved.get("factors").and_then(Json::as_object) else { return Cow::Borrowed(resolved) };
    let mut out = resolved.clone();
    for (name, factor) in factors.iter().filter_map(|(name, factor)| Some((name, factor.as_f64()?))) {
        let mut changed = name == "loads";
        for (_, path, change) in CHANGES.iter().filter(|(of, ..)| of == name) {
            let Some((table, path)) = path.split_once('.') else { continue };
            let Some(table) = out.get_mut(table) else { continue };
            each(table, path, &mut |value| {
                if let Some(number) = value.as_f64() {
                    *value = change.apply(number, factor).into();
                    changed = true;
                }
            });
        }
        if !changed {
            notes.push(format!("factors.{name} = {factor} changes nothing: the study has no such number"));
        }
    }
    let heavier = factors.get("fill_weight").and_then(Json::as_f64).filter(|factor| *factor > 1.0);
    if let (Some(factor), true) = (heavier, resolved.at("scene.fill.resistance").is_some_and(Json::is_object)) {
        notes.push(format!(
            "factors.fill_weight = {factor} raises the resistance of the fill too (one source, one factor); if more weight \
             raises the load factor, also solve with fill_weight = 1 and use the lower result"
        ));
    }
    out.remove("factors");
    Cow::Owned(out)
}

/// Reports joint laws that are not valid with their design values, and stages that do not exist.
pub(super) fn check(
    diagnostics: &mut DiagnosticList<'_>,
    resolved: &Resolved,
    design: &Resolved,
    stages: &[StageTable],
) {
    let Some(factors) = resolved.read::<Factors>("factors") else { return };
    let tables = |of: &Resolved| of.get("joints").and_then(Json::as_object).cloned().unwrap_or_default();
    let written = tables(resolved);
    for (name, table) in tables(design).iter().filter(|(name, table)| written.get(*name) != Some(*table)) {
        let card = card(PluginKind::InterfaceLaw, tag_of(PluginKind::InterfaceLaw, table));
        let Some((card, table)) = card.zip(table.as_object()) else { continue };
        let known = |name: &str| card.parameters.iter().any(|parameter| parameter.name == name);
        let own: Map<_, _> = table.clone().into_iter().filter(|(name, _)| known(name)).collect();
        for (key, message) in (card.check)(&Json::Object(own)) {
            let path = join(&join("joints", name), &key);
            diagnostics.wrong("factors", format!("{path}, with its design values: {message}"), "change these factors");
        }
    }
    let names: Vec<&str> = stages.iter().map(|stage| stage.name.as_str()).collect();
    let Some(LoadFactors::Stages(of_stages)) = factors.loads else { return };
    for name in of_stages.keys() {
        if !names.contains(&name.as_str()) {
            let help = nearest(name, names.iter().copied())
                .map_or(format!("stages here: {}", names.join(", ")), |near| format!("did you mean \"{near}\"?"));
            diagnostics.wrong(&format!("factors.loads.{name}"), format!("there is no stage \"{name}\""), help);
        }
    }
}

/// Multiplies the loads of stages; `in_space` has the loads of a scene in space.
pub(super) fn multiply_loads(stages: &mut [Stage], in_space: &mut [SpaceStage], resolved: &Resolved) {
    let Some(loads) = resolved.read::<Factors>("factors").and_then(|factors| factors.loads) else { return };
    let factor_of = |stage: &Stage| match &loads {
        LoadFactors::All(factor) => *factor,
        LoadFactors::Stages(of) => of.get(&stage.name).copied().unwrap_or(1.0),
    };
    for (stage, loads) in stages.iter().zip(in_space) {
        let factor = factor_of(stage);
        loads.forces.iter_mut().for_each(|force| force.force *= factor);
        loads.accelerations.iter_mut().for_each(|acceleration| *acceleration *= factor);
    }
    for stage in stages {
        let factor = factor_of(stage);
        stage.forces.iter_mut().for_each(|force| force.force *= factor);
        stage.accelerations.iter_mut().for_each(|acceleration| *acceleration *= factor);
    }
}

/// Adds a note if factors on strengths are given and blocks have a yielding material, which the factors do not change.
pub(super) fn note_of_yielding(assembly: &Assembly, resolved: &Resolved, notes: &mut Vec<String>) {
    let given = resolved.read::<Factors>("factors").is_some_and(|own| {
        [own.friction, own.cohesion, own.tensile_strength, own.compressive_strength].iter().any(Option::is_some)
    });
    if given && (0..assembly.bodies.len()).any(|body| assembly.yields(body)) {
        notes.push(
            "factors on strengths are those of joints: blocks that yield keep the strengths of their materials".into(),
        );
    }
}
