//! The result of a study in one sentence with its proof, and the critical numbers.

use super::cases::hinges;
use crate::figures::envelope::place_name;
use crate::output::StudyOutput;
use crate::writers::joints_csv::carried_sentences;
use crate::writers::optima_csv;
use crate::writers::record::section;
use crate::writers::seismic::seismic_sentence;
use crate::writers::table::id_list;
use maud::{Markup, html};
use voussoir_core::certificate::Mechanism;
use voussoir_core::limit::Status;
use voussoir_study::results::carried::ReserveFlow;
use voussoir_study::results::format::{
    capitalised, certificate_verdict, contact_words, format_force, format_number, format_short, headline, kind_words,
    open_bounds, proved_interval, status_meaning, status_word, unit_load,
};
use voussoir_study::results::{CaseResult, Comparison, WorstEntry, best_of, governing, least_of};

/// Order of statuses in the sentence.
const STATUSES: [Status; 7] = [
    Status::Collapse,
    Status::Stands,
    Status::Unbounded,
    Status::NoEquilibrium,
    Status::LimitPoint,
    Status::Open,
    Status::Stalled,
];

/// Index of the critical case: the only case, the case that a search has found, or the case with the least load factor.
/// `None` if the study compares scenes, because their load factors cannot be compared.
pub(super) fn worst(study: &StudyOutput) -> Option<usize> {
    let cases = &study.results.cases;
    let place = |id: usize| cases.iter().position(|case| case.label.id == id);
    if cases.len() == 1 {
        return Some(0);
    }
    if study.results.comparison.is_some() {
        return None;
    }
    if let Some(entry) = study.results.own.seismic.as_deref().and_then(governing) {
        return place(entry.case);
    }
    if let Some(best) = study.results.own.optima.as_deref().and_then(best_of) {
        return best.case.and_then(place);
    }
    let found: Vec<usize> = match &study.results.own.worsts {
        Some(worsts) if !worsts.is_empty() => worsts.iter().map(|worst| worst.place.case).collect(),
        _ => return least_of(cases.iter()).and_then(|case| place(case.label.id)),
    };
    let chosen = found.into_iter().filter_map(|id| study.results.case(id));
    least_of(chosen).and_then(|case| place(case.label.id))
}

/// The result in plain words, then its proof.
pub(super) fn answer(study: &StudyOutput) -> Markup {
    html! {
        p class="summary" { strong { (sentence(study)) } @if study.totals.cases > 1 { " " (counts(study)) } }
        (proof(study))
        @if let [case] = study.results.cases.as_slice() && !case.carried.is_empty() {
            p class="proof" { (carried_sentences(case)) }
        }
    }
}

fn sentence(study: &StudyOutput) -> String {
    let cases = &study.results.cases;
    if let Some(comparison) = &study.results.comparison {
        return compared(comparison);
    }
    if let Some(sentence) = seismic_sentence(study) {
        return sentence;
    }
    if let Some(words) = optima_csv::sentence(study) {
        return words;
    }
    let Some(place) = worst(study) else { return "No case has a load factor.".into() };
    let case = &cases[place];
    let words = headline(case, study.scene(place).map_or(&[], |(_, stages)| stages));
    let moving = |own: &Mechanism| match contact_words(own) {
        words if words.is_empty() => String::new(),
        words => format!(" (contacts: {words})"),
    };
    let mechanism = case.mechanism.as_ref();
    let mechanism = mechanism.map_or(String::new(), |own| format!(", {}{}", kind_words(own.kind), moving(own)));
    let words = format!("{words}{mechanism}");
    let at = whereabouts(study, case);
    let own = &study.results.own;
    let worst = own.worsts.iter().flatten().find(|worst| worst.place.case == case.label.id);
    match study.totals.cases {
        1 if let Some((target, factor)) = reserve(case) => {
            format!(
                "Stands at factor {}; by limit analysis it collapses at factor {}.",
                format_number(target, 6),
                format_number(factor, 6)
            )
        }
        1 => format!("{}.", capitalised(&words)),
        _ if let Some(entry) = worst => {
            format!("The most onerous position of the load is {}: {words}.", position(study, entry))
        }
        count if case.load_factor.is_none() => format!("The worst of {count} cases is {at}: {words}."),
        count if at.is_empty() => format!("The least load factor of {count} cases: {words}."),
        count => format!("The least load factor of {count} cases is at {at}: {words}."),
    }
}

/// A position of an envelope with its vehicle and direction: `10.55 m (bogie, forward)`.
fn position(study: &StudyOutput, WorstEntry { place, parameter, .. }: &WorstEntry) -> String {
    let unit = study.keys.unit(parameter).map_or(String::new(), |unit| format!(" {unit}"));
    let value = format_short(place.value, 4);
    let words = place_name(place, &study.keys);
    if words.is_empty() { format!("{value}{unit}") } else { format!("{value}{unit} ({words})") }
}

/// The factor that is carried and the collapse factor, if all laws have associated flow.
fn reserve(case: &CaseResult) -> Option<(f64, f64)> {
    let reserve = case.carried.reserve.as_ref().filter(|own| own.flow == ReserveFlow::Associated)?;
    Some((reserve.target, reserve.factor?))
}

/// Variant, scene and swept values of a case.
fn whereabouts(study: &StudyOutput, case: &CaseResult) -> String {
    let words = [case.label.variant.clone(), case.label.scene.clone(), Some(study.keys.text(&case.label.parameters))];
    words.into_iter().flatten().filter(|words| !words.is_empty()).collect::<Vec<_>>().join(", ")
}

/// The range of the ratios of each variant to the reference.
fn compared(comparison: &Comparison) -> String {
    let range = |index: usize| {
        let ratios =
            comparison.rows.iter().filter_map(|row| row.cells.get(index)?.ratio).filter(|ratio| ratio.is_finite());
        let (low, high, count) = ratios
            .fold((f64::INFINITY, f64::NEG_INFINITY, 0), |(low, high, count), x| (low.min(x), high.max(x), count + 1));
        let name = &comparison.variants[index];
        let digits = |x: f64| format_number(x, 4);
        match count {
            0 => format!("\"{name}\": no ratio"),
            _ if high - low <= 1e-4 * high.abs() => format!("\"{name}\": {} times", digits(high)),
            _ => format!("\"{name}\": {} to {} times", digits(low), digits(high)),
        }
    };
    let others = (0..comparison.variants.len()).filter(|i| comparison.variants[*i] != comparison.reference);
    let ranges: Vec<String> = others.map(range).collect();
    let scenes = match comparison.rows.len() {
        1 => String::new(),
        count => format!(", in {count} scenes"),
    };
    format!("The load factor over that of \"{}\"{scenes}: {}.", comparison.reference, ranges.join("; "))
}

/// The number of cases for each status, and the number of cases that snap earlier.
fn counts(study: &StudyOutput) -> Markup {
    let totals = study.totals;
    let of = |status: Status| totals.of_status(status);
    html! {
        (totals.cases) " cases:"
        @for (i, status) in STATUSES.into_iter().filter(|status| of(*status) > 0).enumerate() {
            @if i > 0 { ";" } " " (of(status)) " × " (status_word(status).replace('_', " ")) " (" (status_meaning(status)) ")"
        } "."
        @if let Some(lowest) = totals.lowest_snap {
            " " strong { (totals.snapping) " of " (totals.cases) " cases snap before they reach their load factor" }
            ", the lowest from λ = " (format_number(lowest, 4)) "."
        }
    }
}

/// Describes the proof.
fn proof(study: &StudyOutput) -> Markup {
    let cases = &study.results.cases;
    let of = |verdict: &str| -> Vec<usize> {
        cases.iter().filter(|case| certificate_verdict(case) == verdict).map(|case| case.label.id).collect()
    };
    let (open, failed) = (of("bounds"), of("failed"));
    // If there are very many cases, only their number is shown.
    let named = |ids: &[usize], count: usize| match study.totals.all_shown() {
        true => id_list(ids, cases.len()),
        false => format!("{count} cases"),
    };
    let all_failed = study.totals.cases - study.totals.certified - study.totals.open;
    html! {
        p class="proof" {
            @if !failed.is_empty() {
                strong class="bad" { "The certificate failed for " (named(&failed, all_failed)) ": do not rely on them." }
            } @else if open.len() < cases.len() {
                "Proof: every " @if !open.is_empty() { "other " } "answer passed its certificate. " (checked(cases))
            }
            @if !open.is_empty() { " " strong { "Only bounds are proved for " (named(&open, study.totals.open)) "." } }
        }
    }
}

/// Describes the checks in the certificates of these cases.
fn checked(cases: &[CaseResult]) -> String {
    let followed = |case: &&CaseResult| case.path.displacements.is_some();
    let (paths, limits) = (cases.iter().any(|case| followed(&case)), cases.iter().any(|case| !followed(&case)));
    let mut words = Vec::new();
    if limits {
        words.push(
            "Limit analysis: equilibrium and strengths of the forces and the work of the motion were recomputed from the \
             scene, without the solver.",
        );
    }
    if paths {
        words.push("Paths: equilibrium, strengths and contact were checked at every state.");
    }
    if cases.iter().any(|case| open_bounds(case).is_some()) {
        words.push("If a case has two numbers, the lower one is proved and the upper one was found.");
    }
    words.join(" ")
}

/// The numbers of the critical case.
pub(super) fn critical_numbers(study: &StudyOutput) -> Markup {
    let Some(place) = worst(study) else { return html! {} };
    let case = &study.results.cases[place];
    let unit = study.scene(place).and_then(|(_, stages)| unit_load(stages));
    let force = |factor: f64| unit.map(|unit| format_force(factor * unit));
    let with_force = |factor: f64| match force(factor) {
        Some(force) => format!("{} ({force})", format_number(factor, 7)),
        None => format_number(factor, 7),
    };
    let rows: Vec<(&str, Option<String>)> = vec![
        ("case", (study.results.cases.len() > 1).then(|| case.label.id.to_string())),
        ("variant", case.label.variant.clone()),
        ("scene", case.label.scene.clone()),
        ("status", Some(format!("{}: {}", status_word(case.status).replace('_', " "), status_meaning(case.status)))),
        ("load factor", case.load_factor.map(with_force)),
        ("first limit point", case.snaps_from().map(with_force)),
        ("proved", proved_interval(case)),
        ("mechanism", case.mechanism.as_ref().map(|own| kind_words(own.kind).to_string())),
        ("contacts", case.mechanism.as_ref().map(contact_words).filter(|words| !words.is_empty())),
        ("hinges at joints", Some(hinges(case)).filter(|joints| !joints.is_empty())),
        ("solver", Some(case.solver.clone()).filter(|solver| !solver.is_empty())),
        ("certificate", Some(certificate_verdict(case).to_string())),
    ];
    let mut rows: Vec<(String, String)> =
        rows.into_iter().filter_map(|(words, value)| Some((words.to_string(), value?))).collect();
    let swept =
        case.label.parameters.iter().map(|(key, value)| (study.keys.words_in_place(key), study.keys.value(key, value)));
    let at = rows.iter().position(|(words, _)| words == "status").unwrap_or(0);
    rows.splice(at..at, swept);
    html! { div class="record critical" { (section("Critical numbers", &rows)) } }
}
