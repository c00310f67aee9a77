//! The data of a case for the drawing script of a page: its blocks, their motions, and the states of its path.

use crate::figures::displaced::Placement;
use crate::figures::hinges::{DrawnHinge, drawn_hinges};
use crate::figures::moving_blocks;
use crate::results::{CaseResult, StateEntry};
use serde_json::{Value as Json, json};
use voussoir_core::model::geometry::Vec2;
use voussoir_core::model::{Assembly, Bond};

/// Scenes with more bodies are not drawn by the script.
const BODIES: usize = 400;

/// The data of a case with small or `finite` displacements; `None` if the scene is too large.
pub(crate) fn case_data(assembly: &Assembly, result: &CaseResult, finite: bool) -> Option<Json> {
    if assembly.bodies.len() > BODIES {
        return None;
    }
    let unit = assembly.size() * 1e-5;
    let round = |x: f64| (x / unit).round() * unit;
    let tidy = |x: f64| json!(format!("{:.6}", round(x)).parse::<f64>().unwrap_or(x));
    let flat = |points: &[Vec2]| points.iter().flat_map(|p| [tidy(p.x), tidy(p.y)]).collect::<Json>();
    let centre = |body: usize| {
        let at = assembly.inertia(body).centroid;
        json!([fine(at.x), fine(at.y)])
    };
    let joints = assembly.joints.iter().map(|joint| {
        let [a, b] = joint.ends;
        json!([joint.minus, joint.plus, tidy(a.x), tidy(a.y), tidy(b.x), tidy(b.y)])
    });
    let thrust = result.proof.thrust_line.as_ref().map(|line| {
        line.iter().map(|point| point.map_or(Json::Null, |[x, y]| json!([tidy(x), tidy(y)]))).collect::<Json>()
    });
    let mut data = json!({
        "id": result.label.id,
        "bodies": assembly.bodies.iter().map(|body| flat(&body.vertices)).collect::<Json>(),
        "centres": (0..assembly.bodies.len()).map(centre).collect::<Json>(),
        "free": assembly.bodies.iter().map(|body| !body.fixed).collect::<Json>(),
        "joints": joints.collect::<Json>(),
        "thrust": thrust,
    });
    if let Some(blocks) = moving_blocks(assembly, result) {
        data["motion"] = blocks.iter().map(|own| json!(own.velocity.map(fine))).collect();
        data["closing"] = blocks.iter().map(|own| json!(own.closing.map(|term| term.map(fine)))).collect();
    }
    if let Some(mechanism) = &result.mechanism {
        let hinge = |hinge: DrawnHinge| {
            let main = hinge.main();
            json!([main.joint, tidy(main.point[0]), tidy(main.point[1])])
        };
        data["hinges"] = drawn_hinges(&mechanism.hinges).into_iter().map(hinge).collect();
    }
    if !result.path.states.is_empty() {
        add_states(&mut data, assembly, result, finite);
    }
    Some(data)
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

fn add_states(data: &mut Json, assembly: &Assembly, result: &CaseResult, finite: bool) {
    let Some(field) = &result.proof.field else { return };
    let share = |joint: usize, point: [f64; 2]| {
        let ends = assembly.joints[joint].ends;
        let along = ends[1] - ends[0];
        (Vec2::from(point) - ends[0]).dot(&along) / along.norm_squared()
    };
    let centres: Vec<Vec2> = (0..assembly.bodies.len()).map(|body| assembly.inertia(body).centroid).collect();
    let moved = |body: usize, u: [f64; 3]| Json::from_iter(twist(centres[body], u, finite).map(fine));
    let last = result.stages.last().map(|stage| stage.name.as_str());
    let live = |state: &StateEntry| Some(state.stage.as_str()) == last && !state.gravity;
    let entry = |state: &StateEntry| {
        let mut stress: Vec<Vec<(f64, f64)>> = vec![Vec::new(); assembly.joints.len()];
        for (contact, pressure) in field.iter().zip(&state.pressures) {
            stress[contact.joint].push((share(contact.joint, contact.point), *pressure));
        }
        let thrust = assembly.joints.iter().zip(&mut stress).map(|(joint, points)| {
            // Bonded joints neither open nor transmit contact pressure as other joints do.
            if matches!(joint.bond, Bond::Bonded) {
                points.clear();
            }
            points.sort_by(|a, b| a.0.total_cmp(&b.0));
            let total: f64 = points.iter().map(|(_, p)| p).sum();
            let middle = points.iter().map(|(s, p)| s * p).sum::<f64>() / total;
            let at = joint.ends[0] + (joint.ends[1] - joint.ends[0]) * middle;
            if total > 0.0 && assembly.arch.is_some() { json!([digits(at.x), digits(at.y)]) } else { Json::Null }
        });
        let thrust: Json = thrust.collect();
        let points =
            |points: &Vec<(f64, f64)>| points.iter().map(|(s, p)| json!([digits(*s), digits(*p)])).collect::<Json>();
        json!({
            "stage": if state.gravity { format!("{} (gravity)", state.stage) } else { state.stage.clone() },
            "factor": state.factor,
            "displacement": state.displacement,
            "live": live(state),
            "bodies": state.bodies.iter().enumerate().map(|(body, u)| moved(body, *u)).collect::<Json>(),
            "thrust": thrust,
            "stress": stress.iter().map(points).collect::<Json>(),
        })
    };
    let states = &result.path.states;
    let farthest = states.iter().flat_map(|state| &state.bodies).map(|u| u[0].hypot(u[1])).fold(0.0, f64::max);
    let peak =
        (0..states.len()).filter(|i| live(&states[*i])).max_by(|a, b| states[*a].factor.total_cmp(&states[*b].factor));
    data["states"] = states.iter().map(entry).collect();
    data["peak"] = json!(peak);
    // Magnified so that the greatest displacement is about a twentieth of the scene.
    data["magnify"] = json!((0.05 * assembly.size() / farthest.max(1e-300)).clamp(1.0, 1000.0).round());
}
