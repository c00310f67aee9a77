//! `report.html`: one self-contained page for reading and printing.

use super::comparison::{comparison_rows, figure};
use super::limit_points::limit_points;
use super::live::case_data;
use super::page;
use super::record::record;
use super::register::register;
use super::study_output::StudyOutput;
use super::table::{distinct_notes, id_list};
use super::writer::Writer;
use super::{joints_csv, sensitivities_csv};
use crate::config::common_keys::own_keys;
use crate::figures::envelope::envelope_chart;
use crate::figures::format::{
    format_force, format_number, format_seconds, format_short, format_value, headline, hinge_list, kind_words,
    open_bounds, proved_interval, snap_words, status_meaning, status_word, unit_load,
};
use crate::figures::moving_load::moving_load_svg;
use crate::figures::plot::svg::{escape, own_ids};
use crate::figures::sweep::study_chart;
use crate::figures::{curve_charts, curve_svg, mechanism_svg, scene_svg};
use crate::postprocess::joint_events::{JointEvent, JointState, joint_events};
use crate::results::{CaseResult, least_of};
use serde_json::Value as Json;
use voussoir_core::limit::Status;
use voussoir_core::model::Assembly;
use voussoir_core::plugin::Keys;

/// `[output.options.report]`.
#[derive(Debug, Clone, Keys)]
pub struct ReportOptions {
    /// at most so many cases are drawn
    #[key(range = "<= 100_000", default = 40)]
    drawn: usize,
}

/// Writes `report.html`.
#[derive(Debug)]
pub struct Report;

impl Writer for Report {
    fn files(&self, study: &StudyOutput, options: &Json) -> Vec<(String, Vec<u8>)> {
        let ReportOptions { drawn } = own_keys(options).unwrap_or_else(ReportOptions::defaults);
        vec![("report.html".into(), report_html(study, drawn).into_bytes())]
    }
}

/// The whole page; at most so many cases are drawn.
pub fn report_html(study: &StudyOutput, drawn: usize) -> String {
    let cases = &study.results.cases;
    let mut body = format!("<h1>{}</h1>\n", escape(study.name));
    body += &summary(study);
    if let Some(inputs) = study.inputs {
        body += &format!("<details open><summary>Inputs</summary>\n{}</details>\n", record(inputs));
    }
    if study.output.figures.anything()
        && let Some(chart) = study_chart(study)
    {
        body += "<h2>The sweep</h2>\n<figure>";
        body += &chart;
        body += "<figcaption>Each marker is one case. An arrow at the upper edge is a case that carries any load; \
                 lines only join neighbouring cases.</figcaption></figure>\n";
    }
    if let Some(chart) = study.output.figures.anything().then(|| envelope_chart(study)).flatten() {
        body += &format!(
            "<h2>Envelope</h2>\n<figure>{chart}<figcaption>The load factor at every place that was tried; only the worst \
             is drawn below.</figcaption></figure>\n"
        );
    }
    if let Some(svg) = moving_load_svg(study) {
        body += &format!(
            "<h2>The load on its way</h2>\n<figure>{}<figcaption>Place by place, with the mechanism there; printed, the worst \
             place.</figcaption></figure>\n",
            own_ids(&svg, "moving-load")
        );
    }
    body += &comparison(study);
    body += "<h2>Cases</h2>\n";
    if !study.totals.all_shown() {
        body += &format!(
            "<p>The tables and the chart show {} of {} cases: the least and the greatest load factor of every few neighbours, \
             and cases without a certified answer. All cases are in results.csv.</p>\n",
            cases.len(),
            study.totals.cases
        );
    }
    body += &case_table(study);
    body += &notes(cases);
    if study.output.figures.anything() {
        body += &figures(study, drawn);
    }
    body += &joints_csv::section(study);
    body += &sensitivities_csv::table(study);
    body += &paths(study, drawn);
    body += &certificates(cases);
    body += &format!(
        "<footer>Written by Voussoir {}{}. SI units; forces in N, kN or MN as marked. The numbers to the last bit are in \
         results.json and results.csv beside this page.</footer>\n",
        escape(&study.results.version),
        study.results.date.as_ref().map_or(String::new(), |date| format!(", {}", escape(date)))
    );
    page::whole(study.name, &body, &live(study, drawn))
}

/// Variants beside each other, where the study compares them.
fn comparison(study: &StudyOutput) -> String {
    let Some(comparison) = &study.results.comparison else { return String::new() };
    let mut body = format!(
        "<h2>Comparison</h2>\n<p>Load factors, then their ratios to those of <em>{}</em>. Where a number follows \
         after ≥, the load was found, and no load below that number is possible. A word stands where there is no load factor.</p>\n",
        escape(&comparison.reference)
    );
    if study.output.figures.anything()
        && let Some((name, svg)) = figure(study, comparison)
    {
        let caption = match name {
            "map" => {
                "One cell for each point of the grid. Contours are linear between points and end where a point has no \
                 ratio."
            }
            _ => "One row for each scene, one mark for each variant; words at the right name what is no collapse.",
        };
        body += &format!("<figure>{svg}<figcaption>{caption}</figcaption></figure>\n");
    }
    let (header, rows) = comparison_rows(comparison, &study.keys);
    body + &page::table(&header, rows.into_iter())
}

/// What came out, in plain words.
fn summary(study: &StudyOutput) -> String {
    let cases = &study.results.cases;
    let mut text = String::from("<p class=\"summary\">");
    if let [case] = cases.as_slice() {
        let stages = study.scene(0).map_or(&[][..], |(_, stages)| stages);
        text += &format!("The scene: <strong>{}</strong>.", escape(&headline(case, stages)));
        if let Some(mechanism) = &case.mechanism {
            text += &format!(" Mechanism: {}.", kind_words(mechanism.kind));
        }
    } else {
        text += &format!("{} cases.", study.totals.cases);
        for status in page::STATUSES {
            let count = study.totals.of_status(status);
            if count > 0 {
                text += &format!(
                    " <strong>{count} {}</strong> ({}).",
                    status_word(status).replace('_', " "),
                    status_meaning(status)
                );
            }
        }
        let factors: Vec<f64> =
            cases.iter().filter(|c| c.status == Status::Collapse).filter_map(|c| c.load_factor).collect();
        if factors.len() > 1 {
            let (low, high) =
                factors.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &f| (l.min(f), h.max(f)));
            text += &format!(
                " <strong>Least: {}</strong>. Load factors at collapse run from {} to {}.",
                escape(&least(study).unwrap_or_default()),
                format_number(low, 4),
                format_number(high, 4)
            );
        }
        if let Some(lowest) = study.totals.lowest_snap {
            text += &format!(
                " <strong>{} of {} cases snap before they reach their load factor</strong>, the lowest from λ = {}.",
                study.totals.snapping,
                study.totals.cases,
                format_number(lowest, 4)
            );
        }
    }
    let unproved = |open: bool| {
        let cases = cases.iter().filter(move |case| !case.certificate.passed && (case.status == Status::Open) == open);
        cases.map(|case| case.label.id).collect::<Vec<usize>>()
    };
    let (open, failed) = (unproved(true), unproved(false));
    // Of very many cases their number.
    let named = |ids: &[usize], count: usize| match study.totals.all_shown() {
        true => id_list(ids, cases.len()),
        false => format!("{count} cases"),
    };
    if !open.is_empty() {
        text += &format!(" <strong>Only bounds are proved for {}.</strong>", named(&open, study.totals.open));
    }
    text += &if failed.is_empty() && !open.is_empty() {
        String::new()
    } else if failed.is_empty() {
        format!(" Every answer passed its certificate: {}.", checked(cases))
    } else {
        format!(
            " <strong class=\"bad\">The certificate failed for {}: do not rely on them.</strong>",
            named(&failed, study.totals.cases - study.totals.certified - study.totals.open)
        )
    };
    text + "</p>\n"
}

/// The verdict of the certificate: of an open result only the bounds are proved.
fn certificate_word(case: &CaseResult) -> &'static str {
    match (case.certificate.passed, case.status) {
        (true, _) => "passed",
        (false, Status::Open) => "bounds",
        (false, _) => "failed",
    }
}

/// The least load factor with the case it belongs to: `382.1 kN at rise = 5.69 m`.
fn least(study: &StudyOutput) -> Option<String> {
    let cases = &study.results.cases;
    let case = least_of(cases.iter().filter(|case| case.status == Status::Collapse))?;
    let factor = case.load_factor?;
    let place = cases.iter().position(|other| other.label.id == case.label.id)?;
    let unit = study.scene(place).and_then(|(_, stages)| unit_load(stages));
    let load = unit.map_or_else(|| format!("λ = {}", format_number(factor, 4)), |unit| format_force(factor * unit));
    let where_found: Vec<String> = case
        .label
        .variant
        .iter()
        .cloned()
        .chain([study.keys.text(&case.label.parameters)])
        .filter(|words| !words.is_empty())
        .collect();
    Some(if where_found.is_empty() { load } else { format!("{load}, where {}", where_found.join(", ")) })
}

/// What the certificates of these cases have checked, no more.
fn checked(cases: &[CaseResult]) -> String {
    let followed = |case: &&CaseResult| case.path.displacements.is_some();
    let (paths, limits) = (cases.iter().any(|case| followed(&case)), cases.iter().any(|case| !followed(&case)));
    let mut words = Vec::new();
    if limits {
        words.push("of limit analysis, equilibrium and strengths of the forces and the work of the motion were recomputed from the scene");
    }
    if paths {
        words.push("of each path, equilibrium, strengths and contact were checked at every state");
    }
    if cases.iter().any(|case| open_bounds(case).is_some()) {
        words.push("where two numbers stand, the lower one is proved and the upper one was found");
    }
    words.join("; ")
}

fn case_table(study: &StudyOutput) -> String {
    let cases = &study.results.cases;
    let variants = cases.iter().any(|case| case.label.variant.is_some());
    let scenes = cases.iter().any(|case| case.label.scene.is_some());
    let loads: Vec<Option<f64>> =
        (0..cases.len()).map(|i| study.scene(i).and_then(|(_, stages)| unit_load(stages))).collect();
    let with_load = loads.iter().any(Option::is_some);
    let mut header = vec!["id".to_string()];
    header.extend(variants.then(|| "variant".into()));
    header.extend(scenes.then(|| "scene".into()));
    header.extend(study.sweep_keys.iter().map(|key| study.keys.title(key)));
    header.extend(["status".to_string(), "load factor".into()]);
    header.extend(with_load.then(|| "load".into()));
    header.extend(["bounds", "mechanism", "hinges at joints", "certificate", "time"].map(String::from));
    let rows = cases.iter().zip(&loads).map(|(case, load)| {
        let mut row = vec![case.label.id.to_string()];
        row.extend(variants.then(|| case.label.variant.clone().unwrap_or_default()));
        row.extend(scenes.then(|| case.label.scene.clone().unwrap_or_default()));
        row.extend(
            study.sweep_keys.iter().map(|key| case.label.parameters.get(key).map(format_value).unwrap_or_default()),
        );
        row.push(status_word(case.status).replace('_', " "));
        row.push(case.load_factor.map_or("–".into(), |factor| {
            match open_bounds(case) {
                Some([proved, _]) => format!("≥ {} (found {})", format_short(proved, 4), format_number(factor, 7)),
                None => snap_words(case.load_factor, case.path.first_limit_point, |x| format_number(x, 7))
                    .unwrap_or_else(|| format_number(factor, 7)),
            }
        }));
        let force = |load: &f64| {
            let force = |factor: f64| format_force(factor * load);
            let snaps = snap_words(case.load_factor, case.path.first_limit_point, force);
            snaps.or(case.load_factor.map(force)).unwrap_or_default()
        };
        row.extend(with_load.then(|| load.as_ref().map(force).unwrap_or_default()));
        row.push(proved_interval(case).unwrap_or_default());
        row.push(case.mechanism.as_ref().map_or(String::new(), |m| {
            format!("{}{}", kind_words(m.kind), if m.unique == Some(false) { ", not unique" } else { "" })
        }));
        let joints = case.mechanism.as_ref().map(hinge_list).unwrap_or_default();
        row.push(if joints.len() > 12 { format!("{} joints", joints.len()) } else { joints.join(", ") });
        row.push(certificate_word(case).into());
        row.push(format_seconds(case.seconds));
        row
    });
    let joined = cases.iter().filter_map(|case| case.mechanism.as_ref()).flat_map(hinge_list).any(|g| g.contains('+'));
    let words = if joined { "<p>Joints joined by + are neighbours that count as one hinge.</p>\n" } else { "" };
    page::table(&header, rows) + words
}

fn notes(cases: &[CaseResult]) -> String {
    let notes = distinct_notes(cases);
    if notes.is_empty() {
        return String::new();
    }
    let items = notes.iter().map(|(note, ids)| {
        format!("<li>{} <span class=\"quiet\">({})</span></li>\n", escape(note), id_list(ids, cases.len()))
    });
    format!("<h2>Notes</h2>\n<ul>\n{}</ul>\n", items.collect::<String>())
}

fn figures(study: &StudyOutput, drawn: usize) -> String {
    let cases = &study.results.cases;
    let mut text = format!("<h2>Figures</h2>\n{}", page::MEANING);
    let chosen = || cases.iter().enumerate().filter(|(_, case)| study.drawn(case.label.id));
    match chosen().count() {
        count if count > drawn => text += &format!("<p>{count} cases: the first {drawn} are drawn here.</p>\n"),
        count if count < cases.len() => {
            text += &format!("<p>{} cases: the {count} worst or best of them are drawn.</p>\n", cases.len());
        }
        _ => {}
    }
    let first = chosen().next().map(|(place, _)| place);
    for (place, case) in chosen().take(drawn) {
        let Some((assembly, stages)) = study.scene(place) else { continue };
        let open = if Some(place) == first && chosen().count() <= drawn { " open" } else { "" };
        let own = study.case_title(case);
        let title = format!("{own}: {}", headline(case, stages));
        text += &format!("<details{open}><summary>{}</summary>\n", escape(&title));
        let scene = own_ids(&scene_svg(&own, assembly, stages, case), &format!("scene-{}", case.label.id));
        text += &format!(
            "<figure>{scene}<figcaption>The scene with its loads, forces and joints that move.</figcaption></figure>\n"
        );
        if study.output.figures.anything() && (case.proof.motion.is_some() || !case.path.states.is_empty()) {
            text += &format!("<div class=\"moving\" data-case=\"{}\"></div>\n", case.label.id);
        }
        if let Some(svg) = mechanism_svg(&own, assembly, case) {
            let svg = own_ids(&svg, &format!("mechanism-{}", case.label.id));
            text += &format!(
                "<figure>{svg}<figcaption>How it collapses; displacements are exaggerated.</figcaption></figure>\n"
            );
        }
        if let Some(svg) = curve_svg(&own, assembly, stages, case) {
            text += &format!("<figure>{svg}<figcaption>{CURVE}</figcaption></figure>\n");
        }
        text += "</details>\n";
    }
    text
}

/// What the script draws: the cases that figures show, and those of the chart.
fn live(study: &StudyOutput, drawn: usize) -> Vec<Json> {
    if !study.output.figures.anything() {
        return Vec::new();
    }
    let chosen = study.results.cases.iter().enumerate().filter(|(_, case)| study.drawn(case.label.id)).take(drawn);
    chosen.filter_map(|(place, case)| case_data(study.scene(place)?.0, case, study.scenes[place].finite)).collect()
}

/// What a load-displacement curve shows.
const CURVE: &str = "The load over its displacement along itself (that of the rigid motion of the blocks that carry it), \
counted from the scene without any load.";

/// A change of a joint in words.
fn what(assembly: &Assembly, event: &JointEvent) -> String {
    let end = |end: usize| match (&assembly.arch, end) {
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
        Some(JointState::Closed) => "is no hinge any more and does not slide".into(),
        None => "begins to crush".into(),
    }
}

/// Paths: what happened in which order, and the work done.
fn paths(study: &StudyOutput, drawn: usize) -> String {
    let cases = &study.results.cases;
    let followed: Vec<usize> = (0..cases.len()).filter(|&i| cases[i].path.displacements.is_some()).collect();
    if followed.is_empty() {
        return String::new();
    }
    let mut text = "<h2>What happened in which order</h2>\n<p>A joint is a hinge when one of its ends is the only contact \
                    point still closed, and slides when all its closed points slide the same way. What moves only in the \
                    collapse mechanism stands last, at the collapse load.</p>\n"
        .to_string();
    if study.output.figures.anything() {
        for (_, chart) in curve_charts(study) {
            text += &format!("<figure>{chart}<figcaption>{CURVE}</figcaption></figure>\n");
        }
    }
    for (place, &index) in followed.iter().take(drawn).enumerate() {
        let (case, Some((assembly, _))) = (&cases[index], study.scene(index)) else { continue };
        let events = joint_events(assembly, case);
        let open = if place == 0 { " open" } else { "" };
        text += &format!("<details{open}><summary>{}</summary>\n", escape(&study.case_title(case)));
        if events.is_empty() {
            text += "<p>No joint became a hinge or slid.</p>\n";
        } else {
            let header = ["order", "stage", "factor", "joint", "what"].map(String::from);
            let rows = events.iter().enumerate().map(|(order, event)| {
                let stage = if event.gravity { format!("{} (gravity)", event.stage) } else { event.stage.clone() };
                let (factor, joint) = (format_number(event.factor, 7), event.joint.to_string());
                vec![(order + 1).to_string(), stage, factor, joint, what(assembly, event)]
            });
            text += &page::table(&header, rows);
        }
        text += &limit_points(case);
        let points = case.path.events.len();
        let counts = case.counters.iter().map(|(name, count)| format!("{}: {count}", name.replace('_', " ")));
        text += &format!(
            "<p class=\"quiet\">{points} event{} at contact points. Work done: {}.</p>\n</details>\n",
            if points == 1 { "" } else { "s" },
            escape(&counts.collect::<Vec<_>>().join(", "))
        );
    }
    if followed.len() > drawn {
        text += &format!("<p>{} paths: the first {drawn} are listed here.</p>\n", followed.len());
    }
    text
}

fn certificates(cases: &[CaseResult]) -> String {
    let mut names: Vec<&String> = cases.iter().flat_map(|case| case.certificate.residuals.keys()).collect();
    names.sort();
    names.dedup();
    if names.is_empty() {
        return String::new();
    }
    let mut header = vec!["id".to_string()];
    header.extend(names.iter().map(|name| name.replace('_', " ")));
    header.push("verdict".into());
    let rows = cases.iter().map(|case| {
        let mut row = vec![case.label.id.to_string()];
        row.extend(
            names
                .iter()
                .map(|name| case.certificate.residuals.get(*name).map_or(String::new(), |r| format!("{r:.1e}"))),
        );
        row.push(certificate_word(case).into());
        row
    });
    format!(
        "<h2>Certificates</h2>\n<p>Relative residuals, recomputed from the scene; 0 is perfect. Those of limit \
         analysis share nothing with the solver; those of paths share the elastic blocks and the rule by which contact points slide.</p>\n{}",
        page::table(&header, rows)
    )
}

register!(
    "report",
    Report,
    "report.html: one self-contained page with tables, figures and certificates",
    ReportOptions,
    "# `report`\n\nWrites `report.html`, one page without external resources. At most `drawn` cases are drawn in it: \n\n```toml\n[output.options.report]\ndrawn = 10\n```\n"
);
