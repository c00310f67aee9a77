//! Paths: the order in which joints open and slide, limit points, and the energies.

use super::pictures::CURVE;
use crate::figures::curve_charts;
use crate::output::StudyOutput;
use crate::postprocess::joint_events::{JointEvent, JointState, joint_events};
use crate::writers::limit_points::limit_points;
use crate::writers::page;
use maud::{Markup, html};
use voussoir_core::model::Assembly;
use voussoir_study::results::CaseResult;
use voussoir_study::results::format::{format_number, format_short};

/// The paths of at most `drawn` cases.
pub(super) fn paths(study: &StudyOutput, drawn: usize) -> Markup {
    let cases = &study.results.cases;
    let followed: Vec<usize> = (0..cases.len()).filter(|&i| cases[i].path.displacements.is_some()).collect();
    let charts = if study.output.figures.anything() { curve_charts(study) } else { Vec::new() };
    let shown = followed.iter().take(drawn).filter_map(|&place| Some((&cases[place], study.scene(place)?.0)));
    html! {
        @if !followed.is_empty() {
            h2 { "Events in their order" }
            p {
                "A joint is a hinge if one of its ends is the only contact point that is still closed. It slides if all its \
                 closed points slide the same way. Joints that move only in the collapse mechanism are last, at the collapse \
                 load."
            }
            @for (_, chart) in &charts { (page::figure(chart, CURVE)) }
            @for (place, (case, assembly)) in shown.enumerate() {
                details open[place == 0] { summary { (study.case_title(case)) } (path(case, assembly)) }
            }
            @if followed.len() > drawn { p { (followed.len()) " paths: the first " (drawn) " are listed here." } }
        }
    }
}

fn path(case: &CaseResult, assembly: &Assembly) -> Markup {
    let events = joint_events(assembly, case);
    let header = ["order", "stage", "factor", "joint", "event"].map(String::from);
    let rows = events.iter().enumerate().map(|(order, event)| {
        let stage = if event.gravity { format!("{} (gravity)", event.stage) } else { event.stage.clone() };
        let (factor, joint) = (format_number(event.factor, 7), event.joint.to_string());
        vec![(order + 1).to_string(), stage, factor, joint, what(assembly, event)]
    });
    let points = case.path.events.len();
    let counts = case.counters.iter().map(|(name, count)| format!("{}: {count}", name.replace('_', " ")));
    let counts = counts.collect::<Vec<_>>().join(", ");
    html! {
        @if events.is_empty() { p { "No joint became a hinge or slid." } } @else { (page::table(&header, rows)) }
        (limit_points(case))
        p class="quiet" {
            (points) " event" @if points != 1 { "s" } " at contact points. Work done: " (counts) "."
        }
    }
}

/// Describes a change of a joint.
fn what(assembly: &Assembly, event: &JointEvent) -> String {
    let ring = assembly.arch.as_ref().filter(|arch| arch.crosses_ring(event.joint));
    let end = |end: usize| match (ring, end) {
        (Some(_), 0) => "at the intrados".to_string(),
        (Some(_), _) => "at the extrados".to_string(),
        (None, _) => format!("at ({}, {}) m", format_short(event.point[0], 4), format_short(event.point[1], 4)),
    };
    match event.became {
        Some(JointState::Hinge(side)) => {
            format!("becomes a hinge {}{}", end(side), if event.slides { ", its end slides" } else { "" })
        }
        Some(JointState::Slides) => "slides".into(),
        Some(JointState::Open) => "opens over its whole height".into(),
        Some(JointState::Closed) => "closes and does not slide".into(),
        None => "begins to crush".into(),
    }
}
