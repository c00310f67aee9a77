//! The data of a case for the drawing script of a page: its blocks, their motions, and the states of its path.

use crate::figures::displaced::Placement;
use crate::figures::hinges::{DrawnHinge, drawn_hinges};
use crate::figures::moving_blocks;
use serde::Serialize;
use serde_json::Value as Json;
use voussoir_core::model::geometry::Vec2;
use voussoir_core::model::{Assembly, Body, Bond, Joint};
use voussoir_study::results::{CaseResult, StateEntry};

/// Scenes with more bodies are not drawn by the script.
const BODIES: usize = 400;

/// The data of a case; absent keys have no meaning for it.
#[derive(Serialize)]
struct CaseData {
    id: usize,
    /// Coordinates of the vertices of each body, one after another.
    bodies: Vec<Vec<f64>>,
    centres: Vec<[f64; 2]>,
    free: Vec<bool>,
    /// Bodies on both sides, then the coordinates of both ends.
    joints: Vec<(usize, usize, f64, f64, f64, f64)>,
    thrust: Option<Vec<Option<[f64; 2]>>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    motion: Option<Vec<[f64; 3]>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    closing: Option<Vec<[[f64; 3]; 2]>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    hinges: Option<Vec<(usize, f64, f64)>>,
    #[serde(flatten)]
    path: Option<PathData>,
}

/// The states of a path.
#[derive(Serialize)]
struct PathData {
    states: Vec<StateData>,
    /// Index of the state with the greatest factor of the last stage.
    peak: Option<usize>,
    magnify: f64,
}

/// A state of a path.
#[derive(Serialize)]
struct StateData {
    stage: String,
    factor: f64,
    displacement: f64,
    live: bool,
    bodies: Vec<[f64; 3]>,
    thrust: Vec<Option<[f64; 2]>>,
    /// For each joint: places from its end 0, with the pressure there.
    stress: Vec<Vec<[f64; 2]>>,
}

/// The data of a case with small or `finite` displacements; `None` if the scene is too large.
pub fn case_data(assembly: &Assembly, result: &CaseResult, finite: bool) -> Option<Json> {
    if assembly.bodies.len() > BODIES {
        return None;
    }
    let unit = assembly.size() * 1e-5;
    let round = |x: f64| (x / unit).round() * unit;
    let tidy = |x: f64| format!("{:.6}", round(x)).parse::<f64>().unwrap_or(x);
    let flat = |body: &Body| body.vertices.iter().flat_map(|p| [tidy(p.x), tidy(p.y)]).collect();
    let joint = |joint: &Joint| {
        let [a, b] = joint.ends;
        (joint.minus, joint.plus, tidy(a.x), tidy(a.y), tidy(b.x), tidy(b.y))
    };
    let hinge = |hinge: DrawnHinge| {
        let main = hinge.main();
        (main.joint, tidy(main.point[0]), tidy(main.point[1]))
    };
    let thrust = result.proof.thrust_line.as_ref();
    let across = |joint: usize| assembly.arch.as_ref().is_some_and(|arch| arch.crosses_ring(joint));
    let (motion, closing) = moving_blocks(assembly, result)
        .map(|blocks| blocks.iter().map(|own| (own.velocity.map(fine), own.closing.map(|term| term.map(fine)))).unzip())
        .unzip();
    let hinges = result.mechanism.as_ref().map(|own| drawn_hinges(&own.hinges).into_iter().map(hinge).collect());
    let data = CaseData {
        id: result.label.id,
        bodies: assembly.bodies.iter().map(flat).collect(),
        centres: centres(assembly).into_iter().map(|at| [fine(at.x), fine(at.y)]).collect(),
        free: assembly.bodies.iter().map(|body| !body.fixed).collect(),
        joints: assembly.joints.iter().map(joint).collect(),
        thrust: thrust.map(|line| {
            let points = line.iter().enumerate();
            points.map(|(joint, point)| point.filter(|_| across(joint)).map(|at| at.map(tidy))).collect()
        }),
        motion,
        closing,
        hinges,
        path: path_data(assembly, result, finite),
    };
    serde_json::to_value(data).ok()
}

fn centres(assembly: &Assembly) -> Vec<Vec2> {
    (0..assembly.bodies.len()).map(|body| assembly.inertia(body).centroid).collect()
}

/// Rounds to nine digits, so that blocks that move together stay together in the drawing.
fn fine(x: f64) -> f64 {
    format!("{x:.8e}").parse().unwrap_or(x)
}

/// Rounds to four digits.
fn digits(x: f64) -> f64 {
    format!("{x:.3e}").parse().unwrap_or(x)
}

/// The twist that moves a body to its displacement in unit time. If it is magnified, the motion continues in the same
/// way, so that blocks that move together stay together. Small displacements are velocities already.
fn twist(centre: Vec2, displacement: [f64; 3], finite: bool) -> [f64; 3] {
    if finite { Placement::of_displacement(centre, displacement).twist() } else { displacement }
}

fn path_data(assembly: &Assembly, result: &CaseResult, finite: bool) -> Option<PathData> {
    let (field, states) = (result.proof.field.as_ref()?, &result.path.states);
    if states.is_empty() {
        return None;
    }
    let share = |joint: usize, point: [f64; 2]| {
        let ends = assembly.joints[joint].ends;
        let along = ends[1] - ends[0];
        (Vec2::from(point) - ends[0]).dot(&along) / along.norm_squared()
    };
    let centres = centres(assembly);
    let moved = |(body, u): (usize, &[f64; 3])| twist(centres[body], *u, finite).map(fine);
    let last = result.stages.last().map(|stage| stage.name.as_str());
    let live = |state: &StateEntry| Some(state.stage.as_str()) == last && !state.gravity;
    let entry = |state: &StateEntry| {
        let mut stress: Vec<Vec<(f64, f64)>> = vec![Vec::new(); assembly.joints.len()];
        for (contact, pressure) in field.iter().zip(&state.pressures) {
            stress[contact.joint].push((share(contact.joint, contact.point), *pressure));
        }
        let across = |joint: usize| assembly.arch.as_ref().is_some_and(|arch| arch.crosses_ring(joint));
        let thrust = assembly.joints.iter().zip(&mut stress).enumerate().map(|(index, (joint, points))| {
            // Bonded joints neither open nor transmit contact pressure as other joints do.
            if matches!(joint.bond, Bond::Bonded) {
                points.clear();
            }
            points.sort_by(|a, b| a.0.total_cmp(&b.0));
            let total: f64 = points.iter().map(|(_, p)| p).sum();
            let middle = points.iter().map(|(s, p)| s * p).sum::<f64>() / total;
            let at = joint.ends[0] + (joint.ends[1] - joint.ends[0]) * middle;
            (total > 0.0 && across(index)).then(|| [digits(at.x), digits(at.y)])
        });
        let thrust = thrust.collect();
        let points = |points: &Vec<(f64, f64)>| points.iter().map(|(s, p)| [digits(*s), digits(*p)]).collect();
        StateData {
            stage: if state.gravity { format!("{} (gravity)", state.stage) } else { state.stage.clone() },
            factor: state.factor,
            displacement: state.displacement,
            live: live(state),
            bodies: state.bodies.iter().enumerate().map(moved).collect(),
            thrust,
            stress: stress.iter().map(points).collect(),
        }
    };
    let farthest = states.iter().flat_map(|state| &state.bodies).map(|u| u[0].hypot(u[1])).fold(0.0, f64::max);
    let peak =
        (0..states.len()).filter(|i| live(&states[*i])).max_by(|a, b| states[*a].factor.total_cmp(&states[*b].factor));
    // Magnified so that the greatest displacement is about a twentieth of the scene.
    let magnify = (0.05 * assembly.size() / farthest.max(1e-300)).clamp(1.0, 1000.0).round();
    Some(PathData { states: states.iter().map(entry).collect(), peak, magnify })
}
