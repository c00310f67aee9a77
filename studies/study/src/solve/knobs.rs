//! Settings that change the accuracy of a result: keys of a case's mesh and of the steps of its path, as overrides.

use crate::config::common_keys::tag_of;
use crate::config::default_table::default_table;
use crate::scenes::mesh::{Grading, Mesh};
use crate::study::{Case, stage_tables};
use serde::Deserialize;
use serde_json::{Map, Value as Json, json};
use voussoir_core::elastic::edge_breaks;
use voussoir_core::model::geometry::Vec2;
use voussoir_core::plugin::{Capability, Card, PluginKind, card};
use voussoir_solvers::path::continuation::LARGEST_FINITE_STEP;

/// Dotted keys with their values.
pub type Sets = Vec<(String, Json)>;

/// The strategy of a path by default.
const STRATEGY: &str = "arc_length";

/// Returns the mesh of the scene with its elements filled in, if the scene can have one.
fn mesh_of(case: &Case) -> Option<Mesh> {
    card(PluginKind::Scene, tag_of(PluginKind::Scene, case.resolved.get("scene")?)).filter(|card| has(card, "mesh"))?;
    let mesh = case.resolved.at("scene.mesh").and_then(|mesh| Mesh::deserialize(mesh).ok());
    Some(mesh.unwrap_or_default())
}

/// Multiplies the number of elements along and across each block by a factor, with at least one element; empty if the scene
/// has no mesh.
pub fn finer_mesh(case: &Case, times: f64) -> Sets {
    let finer = mesh_of(case).map(|mesh| {
        let elements = mesh.elements.map(|own| (times * own as f64).round().max(1.0) as usize);
        ("scene.mesh".to_string(), json!(Mesh { elements, ..mesh }))
    });
    finer.into_iter().collect()
}

/// Elements that a mesh has at least if it is to resolve the hinges: the default.
const RESOLVED_ELEMENTS: [usize; 2] = [4, 6];
/// Grading that a mesh has at least if it is to resolve the hinges at the joints' ends.
const RESOLVED_GRADING: f64 = 10.0;
/// Elements of rigid blocks, which have no grading, divided by the numbers in the case.
const RESOLVED_RIGID: usize = 4;

/// Refines the mesh most at the joints' ends, where hinges form, with `times` as many elements as an estimate needs. Also
/// returns the greatest size of an element there divided by the size in the case. `None` if the scene has no mesh.
pub fn mesh_at_hinges(case: &Case, times: f64) -> Option<(Sets, f64)> {
    let own = mesh_of(case)?;
    let assembly = &case.assembly;
    let multiplied = |elements: usize| (times * elements as f64).round() as usize;
    let (fine, share) = if (0..assembly.bodies.len()).any(|body| assembly.is_deformable(body)) {
        let grading = Grading::Each(own.grading.pair().map(|own| own.max(RESOLVED_GRADING)));
        let elements = [0, 1].map(|i| multiplied(RESOLVED_ELEMENTS[i].max(2 * own.elements[i])));
        let fine = Mesh { elements, grading, ..own };
        let shares = [0, 1].map(|i| end_size(fine, i) / end_size(own, i));
        (fine, shares[0].max(shares[1]))
    } else {
        let elements = own.elements.map(|n| multiplied(RESOLVED_RIGID * n));
        (Mesh { elements, ..own }, 1.0 / (times * RESOLVED_RIGID as f64))
    };
    Some((vec![("scene.mesh".to_string(), json!(fine))], share))
}

/// Returns the size of the first element along an edge of a quadrilateral, as a fraction of the edge.
fn end_size(mesh: Mesh, edge: usize) -> f64 {
    let unit = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| Vec2::new(x, y));
    edge_breaks(&unit, &mesh.into(), edge)[1]
}

/// Sets another grading of both directions; empty if the scene has no mesh of deformable blocks or already has this grading.
pub fn other_grading(case: &Case, grading: f64) -> Sets {
    let deformable = (0..case.assembly.bodies.len()).any(|body| case.assembly.is_deformable(body));
    let other = mesh_of(case).filter(|mesh| deformable && mesh.grading.pair() != [grading; 2]);
    let set = |mesh| ("scene.mesh".to_string(), json!(Mesh { grading: Grading::Both(grading), ..mesh }));
    other.map(set).into_iter().collect()
}

/// Sets elements of another order; empty if the scene has no mesh or already has this order.
pub fn other_order(case: &Case, order: usize) -> Sets {
    let other = mesh_of(case).filter(|mesh| mesh.order != order);
    other.map(|mesh| ("scene.mesh".to_string(), json!(Mesh { order, ..mesh }))).into_iter().collect()
}

/// Multiplies the steps of every strategy by a share; empty if the solver goes from event to event.
pub fn smaller_steps(case: &Case, solver: &Card, share: f64) -> Sets {
    if !solver.offers(Capability::FINITE_DISPLACEMENTS) {
        return Vec::new();
    }
    let finite = case.solver.settings.finite;
    let mut sets = Vec::new();
    let own = case.resolved.at("solver.continuation").and_then(Json::as_object).cloned();
    let usual = || Map::from_iter([("strategy".to_string(), json!(STRATEGY))]);
    let table = shortened(own.unwrap_or_else(usual), finite, share);
    sets.extend(table.map(|table| ("solver.continuation".to_string(), table)));
    for (index, stage) in stage_tables(&case.resolved).iter().enumerate() {
        let own = stage.continuation.as_ref().and_then(Json::as_object).cloned();
        let own = own.and_then(|table| shortened(table, finite, share));
        sets.extend(own.map(|table| (format!("stages.{index}.continuation"), table)));
    }
    sets
}

/// Returns a strategy with shorter steps, if it has steps.
fn shortened(mut table: Map<String, Json>, finite: bool, share: f64) -> Option<Json> {
    let card = card(PluginKind::Continuation, table.get("strategy")?.as_str()?)?;
    let defaults = default_table(card);
    let keys = [("first_step", None), ("largest_step", finite.then_some(LARGEST_FINITE_STEP))];
    for (key, usual) in keys.into_iter().filter(|(key, _)| has(card, key)) {
        let step = table.get(key).or(defaults.get(key)).and_then(Json::as_f64).or(usual);
        step.into_iter().for_each(|step| drop(table.insert(key.into(), json!(share * step))));
    }
    has(card, "first_step").then_some(Json::Object(table))
}

fn has(card: &Card, key: &str) -> bool {
    card.parameters.iter().any(|parameter| parameter.name == key)
}
