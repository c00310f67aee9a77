//! Output of a bench: a table, a CSV file and the performance profile.

use super::measured::{Bench, Measurement};
use comfy_table::{ContentArrangement, Table, presets};
use voussoir_plot::chart::chart;
use voussoir_plot::series::{ChartStyle, Series};
use voussoir_report::writers::csv_table::csv_table;
use voussoir_study::results::format::{format_number, format_short, status_word};

fn text<T>(value: Option<T>, written: impl Fn(T) -> String) -> String {
    value.map_or(String::new(), written)
}

fn counters(own: &Measurement) -> String {
    own.result.counters.iter().map(|(name, count)| format!("{name} {count}")).collect::<Vec<_>>().join(", ")
}

/// Returns a table for the terminal with one row for each measurement.
pub fn table(bench: &Bench) -> String {
    let several = bench.problems.len() > 1;
    let mut table = Table::new();
    let mut header = vec!["contestant", "status", "load factor", "error", "seconds", "counters"];
    header.splice(0..0, several.then_some("problem"));
    table.load_style(presets::NOTHING).set_content_arrangement(ContentArrangement::Disabled).set_header(header);
    for own in &bench.measurements {
        let from = bench.problems[own.problem].reference.as_ref().is_some_and(|source| source.from == own.contestant);
        let error = if from { "reference".into() } else { text(own.error, |error| format_short(error, 2)) };
        let certified = if own.result.certificate.passed { "" } else { ", not certified" };
        let mut row = vec![
            own.contestant.clone(),
            format!("{}{certified}", status_word(own.result.status)),
            text(own.result.load_factor, |factor| format_number(factor, 10)),
            error,
            format_short(own.seconds, 3),
            counters(own),
        ];
        row.splice(0..0, several.then(|| bench.problems[own.problem].name.clone()));
        table.add_row(row);
    }
    let mut text: String = table.to_string().lines().map(|line| line.trim_end().to_string() + "\n").collect();
    for (problem, name, why) in &bench.refused {
        let of = if several { format!("{}: ", bench.problems[*problem].name) } else { String::new() };
        text += &format!("{of}{name} is not measured: {why}\n");
    }
    text
}

/// Returns the same table as CSV, with all digits.
pub fn csv(bench: &Bench) -> String {
    let header = [
        "problem",
        "contestant",
        "solver",
        "status",
        "certified",
        "load_factor [-]",
        "reference [-]",
        "reference_from",
        "reference_band [-]",
        "error [-]",
        "seconds [s]",
        "counters",
    ];
    let number = |x: f64| format!("{x:?}");
    let row = |own: &Measurement| {
        let problem = &bench.problems[own.problem];
        vec![
            problem.name.clone(),
            own.contestant.clone(),
            own.result.solver.clone(),
            status_word(own.result.status).to_string(),
            own.result.certificate.passed.to_string(),
            text(own.result.load_factor, number),
            text(problem.reference.as_ref(), |source| number(source.factor)),
            text(problem.reference.as_ref(), |source| source.from.clone()),
            text(problem.reference.as_ref().and_then(|source| source.band), number),
            text(own.error, number),
            number(own.seconds),
            counters(own),
        ]
    };
    csv_table(header.map(String::from).to_vec(), bench.measurements.iter().map(row))
}

/// Returns the names of the contestants in order of appearance.
fn names(bench: &Bench) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    for own in &bench.measurements {
        if !names.contains(&own.contestant.as_str()) {
            names.push(&own.contestant);
        }
    }
    names
}

/// Draws a performance profile: the share of problems that a contestant solves within an error, over its time divided by
/// the least time of all contestants (Dolan and Moré, Math. Program. 91, 2002). Returns `None` for a single problem.
pub fn profile_chart(title: &str, bench: &Bench, within: f64) -> Option<String> {
    let count = bench.problems.len();
    if count < 2 {
        return None;
    }
    let reference = |own: &Measurement| {
        bench.problems[own.problem].reference.as_ref().is_some_and(|source| source.from == own.contestant)
    };
    let solved = |own: &&Measurement| reference(own) || own.error.is_some_and(|error| error <= within);
    let of = |problem: usize| bench.measurements.iter().filter(move |own| own.problem == problem).filter(solved);
    let least: Vec<f64> =
        (0..count).map(|problem| of(problem).map(|own| own.seconds).fold(f64::INFINITY, f64::min)).collect();
    let ratios = |name: &str| -> Vec<f64> {
        let own = bench.measurements.iter().filter(|own| own.contestant == name).filter(solved);
        let mut ratios: Vec<f64> = own.map(|own| (own.seconds / least[own.problem]).max(1.0)).collect();
        ratios.sort_by(f64::total_cmp);
        ratios
    };
    let all: Vec<(&str, Vec<f64>)> = names(bench).into_iter().map(|name| (name, ratios(name))).collect();
    let last = all.iter().flat_map(|(_, ratios)| ratios).fold(1.0, |a: f64, b| a.max(*b));
    let series: Vec<Series> = all
        .into_iter()
        .map(|(name, ratios)| {
            let share = |answered: usize| answered as f64 / count as f64;
            let mut points = vec![(1.0, 0.0)];
            for (i, ratio) in ratios.iter().enumerate() {
                points.extend([(*ratio, share(i)), (*ratio, share(i + 1))]);
            }
            points.push((2.0 * last, share(ratios.len())));
            Series { name: name.into(), points, spots: Some(Vec::new()), ..Series::default() }
        })
        .collect();
    let note = format!(
        "Answered: a certified collapse or limit point within a relative error of {}.",
        format_short(within, 2)
    );
    let style = ChartStyle { log: [true, false] };
    let label = "time over the least of all [-]";
    Some(chart(title, label, "share of problems answered [-]", &series, &[note], &style))
}
