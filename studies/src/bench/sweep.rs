//! Accuracy over the settings of a solver: each case of a study on a ladder of settings, from coarse to fine.

use super::measure::{BenchOptions, measure, name_of};
use super::measured::Measurement;
use comfy_table::{ContentArrangement, Table, presets};
use serde_json::{Value as Json, json};
use voussoir_core::plugin::{Card, PluginKind, candidate};
use voussoir_report::writers::csv_table::csv_table;
use voussoir_study::cases::solve_case;
use voussoir_study::results::format::{format_number, format_short, status_word};
use voussoir_study::solve::knobs::{Sets, finer_mesh, smaller_steps};
use voussoir_study::solve::restated::restated;
use voussoir_study::study::{Case, Study};

/// The names of the settings.
pub const PARAMETERS: [&str; 3] = ["tolerance", "first_step", "mesh"];

/// Tolerances of a ladder.
const TOLERANCES: [f64; 5] = [1e-3, 1e-5, 1e-7, 1e-9, 1e-11];
/// Shares of the study's own steps.
const STEPS: [f64; 5] = [1.0, 0.5, 0.25, 0.125, 0.0625];
/// Multiples of the study's own number of elements in each direction.
const MESHES: [f64; 5] = [1.0, 2.0, 3.0, 4.0, 6.0];

/// Differences up to this share of the answer are rounding errors.
const ROUNDING: f64 = 1e-10;

/// A setting to measure: its size, its text, and the keys that set it.
struct Setting {
    size: f64,
    text: String,
    sets: Sets,
}

/// One line of a sweep.
#[derive(Debug, Clone)]
pub struct Rung {
    /// Name of the case.
    pub case: String,
    /// Name of the parameter.
    pub parameter: &'static str,
    /// Its value.
    pub value: String,
    /// Size of the error source: the tolerance, or the step or element relative to the study's own.
    pub size: f64,
    /// The result with its time.
    pub measured: Measurement,
    /// Difference of the load factor from the finest rung with an answer. `None` at this rung, and if there is no answer.
    pub difference: Option<f64>,
    /// Observed order p of the difference between the previous rung and this one, from d = C sizeᵖ.
    pub order: Option<f64>,
}

/// All measurements of a sweep.
#[derive(Debug, Clone, Default)]
pub struct Sweep {
    /// The rungs, from coarse to fine for each case and parameter.
    pub rungs: Vec<Rung>,
    /// Parameters that a case does not have: (case, parameter, reason).
    pub refused: Vec<(String, &'static str, String)>,
    /// True if the sweep was stopped before the last measurement.
    pub cut_short: bool,
}

/// Measures every case of a study on the ladder of each parameter. All rungs use the solver of the case itself.
pub fn sweep(study: &Study, names: &[&'static str], options: &BenchOptions) -> Sweep {
    let mut found = Sweep::default();
    for (index, case) in study.cases.iter().enumerate() {
        let name = case_name(case);
        let solver = candidate(PluginKind::PathSolver, &solve_case(case).solver);
        for parameter in names {
            let ladder = solver.map_or_else(|| Err("no solver".to_string()), |card| ladder(case, card, parameter));
            match ladder {
                Ok(ladder) => climb(&mut found, (index, &name, case), solver, (parameter, ladder), options),
                Err(why) => found.refused.push((name.clone(), parameter, why)),
            }
            if found.cut_short {
                return found;
            }
        }
    }
    found
}

fn case_name(case: &Case) -> String {
    case.variant
        .iter()
        .cloned()
        .chain(Some(name_of(case)).filter(|name| !name.is_empty()))
        .collect::<Vec<_>>()
        .join(", ")
}

/// Returns the settings of a parameter, from coarse to fine.
fn ladder(case: &Case, solver: &Card, parameter: &str) -> Result<Vec<Setting>, String> {
    let path = solver.kind == PluginKind::PathSolver;
    let settings: Vec<Setting> = match parameter {
        "tolerance" if path => {
            let of = |size: &f64| {
                let sets = vec![("solver.tolerance".to_string(), json!(size))];
                Setting { size: *size, text: format!("{size:e}"), sets }
            };
            TOLERANCES.iter().map(of).collect()
        }
        "first_step" if path => {
            let of = |size: &f64| {
                let sets = smaller_steps(case, solver, *size);
                let step = sets.first().and_then(|(_, table)| table.get("first_step")?.as_f64());
                Setting { size: *size, text: format_short(step.unwrap_or(*size), 4), sets }
            };
            STEPS.iter().map(of).collect()
        }
        "mesh" if path => {
            let of = |times: &f64| {
                let sets = finer_mesh(case, *times);
                let elements =
                    sets.first().and_then(|(_, mesh)| mesh.get("elements")).map_or(String::new(), Json::to_string);
                Setting { size: 1.0 / times, text: elements, sets }
            };
            MESHES.iter().map(of).collect()
        }
        _ => return Err(format!("the solver {} does not use it", solver.tag)),
    };
    if settings.iter().any(|setting| setting.sets.is_empty()) {
        return Err(match parameter {
            "mesh" => "the scene has no mesh".into(),
            _ => format!("the solver {} does not use it", solver.tag),
        });
    }
    Ok(settings)
}

/// Measures all rungs of a ladder, and compares them with the finest one.
fn climb(
    found: &mut Sweep,
    (index, name, case): (usize, &str, &Case),
    solver: Option<&Card>,
    (parameter, ladder): (&'static str, Vec<Setting>),
    options: &BenchOptions,
) {
    let first = found.rungs.len();
    for Setting { size, text, sets } in ladder {
        let solver = solver.map(|card| ("solver.solver".to_string(), json!(card.tag)));
        match restated(case, solver.into_iter().chain(sets)) {
            Ok(case) => {
                let measured = measure(index, (format!("{parameter} {text}"), None), &case, options);
                found.cut_short = !(options.told)(&measured);
                let rung =
                    Rung { case: name.into(), parameter, value: text, size, measured, difference: None, order: None };
                found.rungs.push(rung);
            }
            Err(why) => found.refused.push((name.into(), parameter, format!("{text}: {why}"))),
        }
        if found.cut_short {
            break;
        }
    }
    let own = &mut found.rungs[first..];
    let sizes: Vec<f64> = own.iter().map(|rung| rung.size).collect();
    let answers: Vec<Option<f64>> = own.iter().map(|rung| rung.measured.factor()).collect();
    for (rung, (difference, order)) in own.iter_mut().zip(compared(&sizes, &answers)) {
        (rung.difference, rung.order) = (difference, order);
    }
}

/// Returns the difference of each answer from the finest one, and the observed order between the rung before and this one.
fn compared(sizes: &[f64], answers: &[Option<f64>]) -> Vec<(Option<f64>, Option<f64>)> {
    let mut found = vec![(None, None); answers.len()];
    let Some(finest) = answers.iter().rposition(Option::is_some) else { return found };
    for index in 0..finest {
        found[index].0 = answers[index].zip(answers[finest]).map(|(own, finest)| (own - finest).abs());
    }
    for index in 1..finest {
        // Differences of rounding errors have no order.
        let least = ROUNDING * answers[finest].map_or(0.0, f64::abs);
        let differences = found[index - 1].0.zip(found[index].0).filter(|(a, b)| *a > least && *b > least);
        found[index].1 = differences.map(|(a, b)| (a / b).ln() / (sizes[index - 1] / sizes[index]).ln());
    }
    found
}

fn text<T>(value: Option<T>, written: impl Fn(T) -> String) -> String {
    value.map_or(String::new(), written)
}

/// Returns a table for the terminal.
pub fn sweep_table(sweep: &Sweep) -> String {
    let several = sweep.rungs.iter().any(|rung| rung.case != sweep.rungs[0].case);
    let mut table = Table::new();
    let mut header = vec!["parameter", "rung", "seconds", "answer", "difference", "order", "status"];
    header.splice(0..0, several.then_some("case"));
    table.load_style(presets::NOTHING).set_content_arrangement(ContentArrangement::Disabled).set_header(header);
    for (index, rung) in sweep.rungs.iter().enumerate() {
        let ends =
            sweep.rungs.get(index + 1).is_none_or(|next| (next.parameter, &next.case) != (rung.parameter, &rung.case));
        let result = &rung.measured.result;
        let mut row = vec![
            rung.parameter.to_string(),
            rung.value.clone(),
            format_short(rung.measured.seconds, 3),
            text(result.load_factor, |factor| format_number(factor, 10)),
            if ends { "finest".into() } else { text(rung.difference, |difference| format_short(difference, 2)) },
            text(rung.order, |order| format!("{order:.2}")),
            status_word(result.status).to_string(),
        ];
        row.splice(0..0, several.then(|| rung.case.clone()));
        table.add_row(row);
    }
    let mut text: String = table.to_string().lines().map(|line| line.trim_end().to_string() + "\n").collect();
    for (case, parameter, why) in &sweep.refused {
        let of = if case.is_empty() { String::new() } else { format!("{case}: ") };
        text += &format!("{of}{parameter} is not swept: {why}\n");
    }
    text
}

/// Returns the same table as CSV, with all digits.
pub fn sweep_csv(sweep: &Sweep) -> String {
    let header = [
        "case",
        "parameter",
        "rung",
        "size [-]",
        "seconds [s]",
        "load_factor [-]",
        "difference [-]",
        "order [-]",
        "status",
        "certified",
    ];
    let number = |x: f64| format!("{x:?}");
    let row = |rung: &Rung| {
        let result = &rung.measured.result;
        vec![
            rung.case.clone(),
            rung.parameter.to_string(),
            rung.value.clone(),
            number(rung.size),
            number(rung.measured.seconds),
            text(result.load_factor, number),
            text(rung.difference, number),
            text(rung.order, number),
            status_word(result.status).to_string(),
            result.certificate.passed.to_string(),
        ]
    };
    csv_table(header.map(String::from).to_vec(), sweep.rungs.iter().map(row))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Differences d = C h² give the order 2. The finest rung has no difference, and a rung without an answer has none.
    #[test]
    fn the_order_of_a_ladder_is_that_of_its_differences() {
        let sizes = [1.0, 0.5, 0.25, 0.0];
        let answers = sizes.map(|size: f64| Some(7.0 + 3.0 * size * size));
        let found = compared(&sizes, &answers);
        assert_eq!(found[0], (Some(3.0), None));
        assert!((found[1].1.unwrap() - 2.0).abs() < 1e-9 && (found[2].1.unwrap() - 2.0).abs() < 1e-9);
        assert_eq!(found[3], (None, None));
        assert_eq!(compared(&[1.0, 0.5, 0.25], &[Some(2.0), None, Some(1.0)])[..2], [(Some(1.0), None), (None, None)]);
        assert_eq!(compared(&[1.0], &[None]), [(None, None)]);
        // Rounding errors have no order.
        let noise = [1.0 + 1e-14, 1.0 + 3e-15, 1.0].map(Some);
        assert!(compared(&[1.0, 0.5, 0.25], &noise).iter().all(|(_, order)| order.is_none()));
    }
}
