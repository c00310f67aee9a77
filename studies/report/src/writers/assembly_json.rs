//! `assemblies/`: blocks, contacts, loads, forces and velocities of each case in space, in the format of compas_assembly.
//!
//! The file is a data set that needs no other file: with it equilibrium, friction, flow and power of a result can be computed by any
//! program, and the scene `assembly` reads it.

use super::register::register;
use super::writer::Writer;
use crate::output::{SceneOutput, StudyOutput};
use serde_json::{Map, Value as Json, json};
use voussoir_core::space::{Contact, SpaceAssembly, Vec3, Wrench};
use voussoir_study::results::{CaseResult, SpaceFieldEntry};
use voussoir_study::study::SpaceCase;

/// Greatest distance of a stored force from the vertex of its contact, relative to the size of the scene.
const SAME_PLACE: f64 = 1e-12;

/// Writes `assemblies/`.
#[derive(Debug)]
pub struct AssemblyJson;

impl Writer for AssemblyJson {
    fn uses_fields(&self) -> bool {
        true
    }

    fn files(&self, study: &StudyOutput, _options: &Json) -> Vec<(String, Vec<u8>)> {
        if !study.output.writers.iter().flatten().any(|tag| tag == "assembly_json") {
            return Vec::new();
        }
        let cases = study.results.cases.iter().zip(&study.scenes);
        let file = |(case, scene): (&CaseResult, &SceneOutput)| {
            let text = assembly_text(&study.case_title(case), case, (scene.space?, scene));
            Some((format!("assemblies/case-{:04}.json", case.label.id), text.into_bytes()))
        };
        cases.filter_map(file).collect()
    }
}

fn wrapped(class: &str, data: Json) -> Json {
    json!({ "dtype": class, "data": data })
}

fn three(vector: &Vec3) -> [f64; 3] {
    [vector.x, vector.y, vector.z]
}

/// Creates the file of a case.
fn assembly_text(title: &str, case: &CaseResult, (space, scene): (&SpaceCase, &SceneOutput)) -> String {
    let assembly = &space.assembly;
    let mut edges: Map<String, Json> =
        assembly.bodies.iter().map(|body| (body.name.clone(), Json::Object(Map::new()))).collect();
    let field = case.proof.space.as_ref().and_then(|proof| proof.field.as_deref()).unwrap_or_default();
    let mut forces: Vec<Vec<&SpaceFieldEntry>> = vec![Vec::new(); assembly.contacts.len()];
    field.iter().for_each(|entry| forces[entry.joint].push(entry));
    let (low, high) = assembly.bounding_box();
    let near = SAME_PLACE * (high - low).norm();
    for (contact, own) in assembly.contacts.iter().zip(&forces) {
        let [minus, plus] = [contact.minus, contact.plus].map(|body| assembly.bodies[body].name.as_str());
        let edge = &mut edges[minus][plus]["interfaces"];
        let interface = interface(assembly, contact, own, near);
        match edge.as_array_mut() {
            Some(all) => all.push(interface),
            None => *edge = json!([interface]),
        }
    }
    let attributes = json!({
        "name": title,
        "units": "m, kg, N; forces balance fixed_load + field_factor × varying_load",
        "status": case.status,
        "load_factor": case.load_factor,
        "field_factor": case.proof.field_factor,
        "bounds": case.bounds,
        "flow_read_as": case.flow_read_as,
        "associated_load_factor": case.non_associated.associated_load_factor,
    });
    let graph = json!({ "node": nodes(space, scene, case), "edge": edges });
    let data = json!({ "attributes": attributes, "graph": wrapped("compas.datastructures/Graph", graph) });
    let file = wrapped("compas_assembly.datastructures/Assembly", data);
    serde_json::to_string(&file).unwrap_or_default() + "\n"
}

/// Returns the blocks with their loads in the last stage and their velocities.
fn nodes(space: &SpaceCase, scene: &SceneOutput, case: &CaseResult) -> Map<String, Json> {
    let loads = space.loads(scene.stages);
    let loads = loads.get(case.stages.len().saturating_sub(1));
    let proof = case.proof.space.as_ref();
    let motion = proof.and_then(|proof| proof.motion.as_deref()).unwrap_or_default();
    let associated = proof.and_then(|proof| proof.associated_motion.as_deref()).unwrap_or_default();
    let node = |index: usize| {
        let body = &space.assembly.bodies[index];
        let (mass, centroid) = space.assembly.mass_and_centroid(index);
        let about = |[x, y, z, a, b, c]: &Wrench| {
            let force = Vec3::new(*x, *y, *z);
            let moment = Vec3::new(*a, *b, *c) - centroid.cross(&force);
            [force.x, force.y, force.z, moment.x, moment.y, moment.z]
        };
        let vertices = body.shape.vertices.iter().enumerate();
        let vertices = vertices.map(|(k, x)| (k.to_string(), json!({ "x": x.x, "y": x.y, "z": x.z })));
        let faces = body.shape.faces.iter().enumerate().map(|(k, face)| (k.to_string(), json!(face)));
        let block = json!({ "vertex": vertices.collect::<Map<_, _>>(), "face": faces.collect::<Map<_, _>>() });
        json!({
            "is_support": body.fixed,
            "block": wrapped("compas_assembly.datastructures/Block", block),
            "mass": mass,
            "centroid": three(&centroid),
            "fixed_load": loads.map(|loads| about(&loads.fixed[index])),
            "varying_load": loads.map(|loads| about(&loads.varying[index])),
            "velocity": motion.get(index).map(|entry| entry.velocity),
            "associated_velocity": associated.get(index).map(|entry| entry.velocity),
        })
    };
    space.assembly.bodies.iter().enumerate().map(|(index, body)| (body.name.clone(), node(index))).collect()
}

/// Returns a contact with its law and its forces on the plus block. Forces farther than `near` from the vertices are listed with their
/// points.
fn interface(assembly: &SpaceAssembly, contact: &Contact, field: &[&SpaceFieldEntry], near: f64) -> Json {
    let same = |(point, entry): (&Vec3, &&SpaceFieldEntry)| (Vec3::from(entry.point) - point).norm() <= near;
    let at_vertices = field.len() == contact.points.len() && contact.points.iter().zip(field).all(same);
    let force = |entry: &&SpaceFieldEntry| {
        let [n, s, t] = entry.force;
        json!({ "c_np": n.max(0.0), "c_nn": (-n).max(0.0), "c_u": s, "c_v": t })
    };
    let frame = json!({
        "point": three(&contact.points[0]),
        "xaxis": three(&contact.tangents[0]),
        "yaxis": three(&contact.tangents[1]),
    });
    let law = assembly.catalogue.laws.get(contact.law);
    let cone = law.and_then(|(_, law)| law.cone());
    let data = json!({
        "points": contact.points.iter().map(three).collect::<Vec<_>>(),
        "frame": wrapped("compas.geometry/Frame", frame),
        "forces": at_vertices.then(|| field.iter().map(force).collect::<Vec<_>>()),
        "forces_at": (!at_vertices && !field.is_empty())
            .then(|| field.iter().map(|entry| json!({ "point": entry.point, "force": entry.force })).collect::<Vec<_>>()),
        "friction": cone.as_ref().map(|cone| cone.friction),
        "dilatancy": cone.as_ref().map(|cone| cone.dilatancy),
    });
    wrapped("compas_assembly.datastructures/Interface", data)
}

register!(
    "assembly_json",
    AssemblyJson,
    "assemblies/*.json: blocks, contacts, loads, forces and velocities of cases in space, on request",
    "# `assembly_json`\n\nWrites `assemblies/case-NNNN.json` for each case in space: an assembly in the format of compas_assembly that also has the loads and \
     the proof. It writes only where it is named:\n\n```toml\n[output]\nwriters = [\"results_csv\", \"report\", \"assembly_json\"]\n```\n\n\
     | place | keys |\n|---|---|\n\
     | `attributes` | status, load factor, bounds, flow rule that replaced the one of the law, associated load factor, factor of the forces |\n\
     | node | `mass` \\[kg\\], `centroid` \\[m\\], `fixed_load` and `varying_load` \\[N, N m\\] about the centroid, `velocity` of the mechanism at the centroid, `associated_velocity` of the mechanism that proves the associated load factor |\n\
     | interface | `forces` at the points \\[N\\]: c_np − c_nn along the normal xaxis × yaxis, c_u along xaxis, c_v along yaxis, on the second block; `friction`, `dilatancy` |\n\n\
     If forces do not act at the points of an interface, `forces` is null, and `forces_at` lists points and forces (n, u, v). Other programs ignore the additional keys. The scene \
     `assembly` reads the file.\n"
);
