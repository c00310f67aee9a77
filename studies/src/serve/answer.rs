//! The result of a case as data for the script of the page.

use super::handles::handles;
use crate::config::document::Node;
use crate::figures::format::{format_number, headline, hinge_list, kind_words, proved_interval};
use crate::results::CaseResult;
use crate::study::Case;
use crate::writers::live::case_data;
use serde_json::{Value as Json, json};
use voussoir_core::limit::Status;
use voussoir_core::model::{Assembly, PointForce, Stage};

/// Greatest number of forces of a stage that are drawn; longer lists are thinned.
const ARROWS: usize = 40;

/// Returns all data of a result that the page shows; `toml` is the study file of the case.
pub(super) fn answer(case: &Case, result: &CaseResult, root: &Node, toml: String) -> Json {
    let mechanism = result.mechanism.as_ref().map(|mechanism| {
        let joints = hinge_list(mechanism);
        let hinges =
            if joints.is_empty() { String::new() } else { format!(", hinges at joints {}", joints.join(", ")) };
        let unique = if mechanism.unique == Some(false) { ", not the only one" } else { "" };
        format!("{}{hinges}{unique}", kind_words(mechanism.kind))
    });
    json!({
        "drawing": case_data(&case.assembly, result, case.solver.settings.finite),
        "headline": headline(result, &case.stages),
        "status": result.status,
        "load_factor": result.load_factor,
        "first_limit_point": result.path.first_limit_point,
        "solver": result.solver,
        "certified": result.certificate.passed && result.status.is_answer(),
        "proof": proof(result),
        "mechanism": mechanism,
        "hinges": result.mechanism.iter().flat_map(|own| &own.hinges).map(|hinge| json!(hinge.point)).collect::<Json>(),
        "arrows": arrows(&case.assembly, &case.stages),
        "handles": handles(case, root),
        "notes": result.notes,
        "seconds": result.seconds,
        "toml": toml,
    })
}

/// Describes the proof of the result in one sentence.
fn proof(result: &CaseResult) -> String {
    let bounds = result.both_bounds().filter(|_| result.status.is_answer()).map(|[low, high]| {
        format!(
            "an admissible field carries λ = {}, a mechanism bounds it at {}",
            format_number(low, 7),
            format_number(high, 7)
        )
    });
    let words = match (result.status, bounds) {
        (Status::Stalled, _) => "not proven".into(),
        (Status::Open, _) => format!("proved: {}", proved_interval(result).unwrap_or_default()),
        (_, Some(bounds)) => bounds,
        (Status::Unbounded, _) => "weightless struts carry the load alone".into(),
        _ if result.supports_cannot_move() => {
            "forces in balance that grow without bound while the supports move".into()
        }
        (Status::NoEquilibrium, _) => "a motion on which the loads do more work than is dissipated".into(),
        _ => "equilibrium, strengths and contact hold at every state".to_string(),
    };
    let worst = result.certificate.residuals.values().fold(0.0_f64, |worst, residual| worst.max(residual.abs()));
    let checked = if result.certificate.passed { "certificate passed" } else { "certificate failed" };
    format!("{words}; {checked}, greatest residual {worst:.0e}")
}

/// Returns the forces of all stages as [x, y, x component, y component, true for the last stage], with components as shares
/// of the greatest force.
fn arrows(assembly: &Assembly, stages: &[Stage]) -> Json {
    let size = assembly.size();
    let mut out = Vec::new();
    for (index, stage) in stages.iter().enumerate() {
        let forces: Vec<&PointForce> = stage.forces.iter().filter(|force| force.force.norm() > 0.0).collect();
        let greatest = forces.iter().map(|force| force.force.norm()).fold(0.0, f64::max);
        for force in forces.iter().step_by(forces.len().div_ceil(ARROWS).max(1)) {
            let share = force.force / greatest;
            let tidy = |x: f64| if size > 0.0 { (x / size * 1e6).round() * size / 1e6 } else { x };
            out.push(json!([tidy(force.point.x), tidy(force.point.y), share.x, share.y, index + 1 == stages.len()]));
        }
    }
    out.into()
}
