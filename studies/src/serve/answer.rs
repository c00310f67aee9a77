//! The result of a case as data for the script of the page.

use super::handles::handles;
use serde_json::{Value as Json, json};
use voussoir_core::limit::Status;
use voussoir_report::figures::hinges::hinge_list;
use voussoir_report::figures::{curve_svg, scene_svg, space_svg};
use voussoir_report::writers::live::case_data;
use voussoir_study::config::document::Node;
use voussoir_study::results::CaseResult;
use voussoir_study::results::format::{contact_words, format_number, headline, kind_words, proved_interval};
use voussoir_study::study::Case;

/// Greatest number of hinges that are listed by their joints.
const LISTED: usize = 12;

/// Returns the study file of a case.
pub(super) fn toml_of(root: &Node) -> String {
    toml::to_string(&root.to_toml()).unwrap_or_default()
}

/// Returns all data of a result that the page shows; `root` is the study file of the case.
pub(super) fn answer(case: &Case, result: &CaseResult, root: &Node) -> Json {
    let (assembly, stages) = (&case.assembly, case.stages.as_slice());
    let mechanism = result.mechanism.as_ref().map(|mechanism| {
        let joints = hinge_list(mechanism);
        let hinges = match joints.len() {
            0 => String::new(),
            1..=LISTED => format!(", hinges at joints {}", joints.join(", ")),
            count => format!(", {count} hinges"),
        };
        let unique = if mechanism.unique == Some(false) { ", not the only one" } else { "" };
        let parts = match contact_words(mechanism) {
            words if words.is_empty() => hinges,
            words => format!(", contacts: {words}"),
        };
        format!("{}{parts}{unique}", kind_words(mechanism.kind))
    });
    let scene = match &case.space {
        Some(space) => space_svg("", space, stages, result),
        None => scene_svg("", assembly, stages, result),
    };
    json!({
        "scene": scene,
        "curve": curve_svg("", assembly, stages, result),
        "drawing": case_data(assembly, result, case.solver.settings.finite),
        "headline": headline(result, stages),
        "status": result.status,
        "load_factor": result.load_factor,
        "first_limit_point": result.path.first_limit_point,
        "solver": result.solver,
        "certified": result.certificate.passed && result.status.is_answer(),
        "proof": proof(result),
        "mechanism": mechanism,
        "handles": handles(case, root),
        "notes": result.notes,
        "seconds": result.seconds,
        "toml": toml_of(root),
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
