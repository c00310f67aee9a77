//! The result of a seismic check: its sentence, its section of the report and its lines on the terminal.

use super::page::{self, figure};
use crate::figures::seismic::{capacity_charts, entry_name};
use crate::output::StudyOutput;
use maud::{Markup, html};
use voussoir_plot::svg::own_ids;
use voussoir_study::results::format::format_number;
use voussoir_study::results::{CheckedQuantity, SeismicCheck, SeismicEntry, governing};

/// Returns the result in one sentence or more: the governing case, its margin, and the limits of the result. `None` for other
/// studies.
pub fn seismic_sentence(study: &StudyOutput) -> Option<String> {
    let entries = study.results.own.seismic.as_deref().filter(|entries| !entries.is_empty())?;
    let entry = governing(entries)?;
    let place = entry_name(study, entry);
    let place = if place.is_empty() { place } else { format!(", {place}") };
    let direction = format!("push to the {}{place}", entry.direction.word());
    let Some(check) = entry.deciding() else {
        return Some(format!(
            "No seismic check is possible: no proved activation multiplier or no mechanism ({direction})."
        ));
    };
    let verdict = if check.met { "is met" } else { "is not met" };
    let quantity = match check.unit {
        CheckedQuantity::Displacement => "displacement",
        CheckedQuantity::Acceleration => "acceleration",
    };
    let mut text = format!("The seismic demand {verdict}: the {quantity} capacity is {} ({direction}).", margin(check));
    if check.unit == CheckedQuantity::Displacement
        && let Some(force) = entry.least(CheckedQuantity::Acceleration)
    {
        let met = if force.met { "met" } else { "not met" };
        text += &format!(" The linear check of accelerations is {met}: {}.", margin(force));
    }
    text += match &entry.capacity {
        None if entry.path_case.is_none() => {
            " There is no capacity curve, because all blocks and joints are rigid: give a joint a normal_stiffness."
        }
        None => " There is no capacity curve, because the path is not certified.",
        Some(own) if !own.reaches_zero => {
            " The certified path ends before the acceleration is zero; its last displacement replaces d0*."
        }
        Some(_) => "",
    };
    if study.results.case(entry.case).is_some_and(|case| case.flow_read_as.is_some()) {
        text += " The activation multiplier is an upper bound, because the solver computes with associated flow.";
    }
    Some(text)
}

/// Returns capacity over demand with both numbers: `1.67 times the demand, 0.1296 m over 0.07753 m`.
fn margin(check: &SeismicCheck) -> String {
    let unit = unit(check.unit);
    let [ratio, capacity, demand] = [check.ratio, check.capacity, check.demand].map(|x| format_number(x, 4));
    format!("{ratio} times the demand, {capacity} {unit} over {demand} {unit}")
}

fn unit(unit: CheckedQuantity) -> &'static str {
    match unit {
        CheckedQuantity::Displacement => "m",
        CheckedQuantity::Acceleration => "m/s²",
    }
}

/// Returns the section of the report; empty for other studies.
pub(super) fn section(study: &StudyOutput) -> Markup {
    let entries = study.results.own.seismic.as_deref().unwrap_or_default();
    if entries.is_empty() {
        return html! {};
    }
    let named = entries.iter().any(|entry| !entry_name(study, entry).is_empty());
    html! {
        h2 { "Kinematic analysis" }
        @if study.output.figures.anything() {
            @for (name, svg) in capacity_charts(study) {
                (figure(&own_ids(&svg, &name), "Capacity curve of the mechanism as an oscillator with one degree of freedom. Marks belong to the \
                 direction that governs: the displacement ds* of the secant stiffness, the ultimate displacement du* and the demand."))
            }
        }
        (page::table(&values_header(named), entries.iter().map(|entry| values(study, entry, named))))
        h3 { "Checks" }
        (page::table(&checks_header(named), entries.iter().flat_map(|entry| checks(study, entry, named))))
    }
}

fn headed(named: bool, words: &[&str]) -> Vec<String> {
    let first = named.then_some("case").into_iter();
    first.chain(words.iter().copied()).map(String::from).collect()
}

fn values_header(named: bool) -> Vec<String> {
    headed(
        named,
        &["push", "α₀ [-]", "M* [kg]", "e* [-]", "a₀* [m/s²]", "d₀* [m]", "du* [m]", "ds* [m]", "as* [m/s²]", "Ts [s]"],
    )
}

fn values(study: &StudyOutput, entry: &SeismicEntry, named: bool) -> Vec<String> {
    let number = |x: Option<f64>| x.map_or("-".to_string(), |x| format_number(x, 5));
    let (own, capacity) = (entry.oscillator.as_ref(), entry.capacity.as_ref());
    let zero = number(capacity.map(|own| own.zero_displacement));
    let zero = if capacity.is_some_and(|own| !own.reaches_zero) { format!("≥ {zero}") } else { zero };
    let mut row: Vec<String> = named.then(|| entry_name(study, entry)).into_iter().collect();
    row.extend([
        entry.direction.word().to_string(),
        number(entry.activation_multiplier),
        number(own.map(|own| own.mass)),
        number(own.map(|own| own.mass_fraction)),
        number(own.map(|own| own.activation_acceleration)),
        zero,
        number(capacity.map(|own| own.ultimate_displacement)),
        number(capacity.map(|own| own.secant_displacement)),
        number(capacity.map(|own| own.secant_acceleration)),
        number(capacity.map(|own| own.secant_period)),
    ]);
    row
}

fn checks_header(named: bool) -> Vec<String> {
    headed(named, &["push", "check", "source", "capacity", "demand", "ratio", "met"])
}

fn checks(study: &StudyOutput, entry: &SeismicEntry, named: bool) -> Vec<Vec<String>> {
    let row = |check: &SeismicCheck| {
        let quantity = |x: f64| format!("{} {}", format_number(x, 5), unit(check.unit));
        let mut row: Vec<String> = named.then(|| entry_name(study, entry)).into_iter().collect();
        row.extend([
            entry.direction.word().to_string(),
            check.rule.clone(),
            check.source.clone(),
            quantity(check.capacity),
            quantity(check.demand),
            format_number(check.ratio, 4),
            if check.met { "yes" } else { "no" }.to_string(),
        ]);
        row
    };
    entry.checks.iter().map(row).collect()
}
