//! The limit points of a path as a table of the page: the fall of the load after each limit point, and the behaviour
//! under a dead load.

use super::page;
use maud::{Markup, html};
use voussoir_study::results::format::{format_energy, format_length, format_number, format_short};
use voussoir_study::results::{CaseResult, LimitPointEntry, NextState};

/// The table of a case; empty if its path has no limit point.
pub(super) fn limit_points(case: &CaseResult) -> Markup {
    let points = &case.path.limit_points;
    if points.is_empty() {
        return html! {};
    }
    let header = ["stage", "limit point at factor", "displacement", "factor falls by", "released energy", "next state"];
    html! {
        p {
            "Under dead load the structure snaps at a limit point. The released energy is counted along the path to the next state \
             that carries the same load, or to the end of the path."
        }
        (page::table(&header.map(String::from), points.iter().map(row)))
    }
}

fn row(point: &LimitPointEntry) -> Vec<String> {
    let stage = if point.gravity { format!("{} (gravity)", point.stage) } else { point.stage.clone() };
    let energy = point.released_energy.map_or("–".into(), format_energy);
    vec![
        stage,
        format_number(point.factor, 7),
        format_length(point.displacement),
        format_short(point.fall, 4),
        energy,
        point.next_state.as_ref().map_or("none".into(), next_state),
    ]
}

fn next_state(next: &NextState) -> String {
    let stability = if next.stable_under_load == Some(true) { "stable" } else { "stability not proved" };
    format!("{} ({stability})", format_length(next.displacement))
}
