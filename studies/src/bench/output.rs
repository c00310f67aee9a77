//! Output of a bench: a table, a CSV file and the performance profile.

use super::measured::{Bench, Measurement, Other};
use comfy_table::{ContentArrangement, Table, presets};
use voussoir_plot::chart::chart;
use voussoir_plot::panels::panels;
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
    for own in &bench.others {
        let mut row = vec![
            own.program.clone(),
            String::new(),
            format_number(own.factor, 10),
            text(own.error, |error| format_short(error, 2)),
            format_short(own.seconds, 3),
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

/// Returns the same table as CSV, with all digits; the measurements of other programs follow, without status.
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
    let of_reference = |problem: usize| {
        let reference = bench.problems[problem].reference.as_ref();
        [
            text(reference, |source| number(source.factor)),
            text(reference, |source| source.from.clone()),
            text(reference.and_then(|source| source.band), number),
        ]
    };
    let row = |own: &Measurement| {
        let [factor, from, band] = of_reference(own.problem);
        vec![
            bench.problems[own.problem].name.clone(),
            own.contestant.clone(),
            own.result.solver.clone(),
            status_word(own.result.status).to_string(),
            own.result.certificate.passed.to_string(),
            text(own.result.load_factor, number),
            factor,
            from,
            band,
            text(own.error, number),
            number(own.seconds),
            counters(own),
        ]
    };
    let other = |own: &Other| {
        let [factor, from, band] = of_reference(own.problem);
        let name = bench.problems[own.problem].name.clone();
        let before = [name, own.program.clone(), String::new(), String::new(), String::new(), number(own.factor)];
        let after = [factor, from, band, text(own.error, number), number(own.seconds), String::new()];
        before.into_iter().chain(after).collect()
    };
    let rows = bench.measurements.iter().map(row).chain(bench.others.iter().map(other));
    csv_table(header.map(String::from).to_vec(), rows)
}

/// A run that counts in a profile: its problem, who ran, and the time.
type Run<'a> = (usize, &'a str, f64);

/// Returns the runs of contestants and other programs whose errors are at most `within`, and the references. A run with
/// another setting counts for its solver.
fn solved(bench: &Bench, within: f64) -> Vec<Run<'_>> {
    let reference = |own: &Measurement| {
        bench.problems[own.problem].reference.as_ref().is_some_and(|source| source.from == own.contestant)
    };
    let near = |error: Option<f64>| error.is_some_and(|error| error <= within);
    let own = bench.measurements.iter().filter(|own| reference(own) || near(own.error));
    let own = own.map(|own| {
        let name = if own.rung.is_some() { &own.result.solver } else { &own.contestant };
        (own.problem, name.as_str(), own.seconds)
    });
    let others = bench.others.iter().filter(|own| near(own.error));
    own.chain(others.map(|own| (own.problem, own.program.as_str(), own.seconds))).collect()
}

/// Draws performance profiles: the share of problems that a contestant solves within an error, over its time divided by
/// the least time of all contestants (Dolan and Moré, Math. Program. 91, 2002). A solver has its fastest setting. Each study
/// with several cases has its own profile. Studies with one case share one. Returns `None` if no profile has at least two
/// problems.
pub fn profile_chart(title: &str, bench: &Bench, within: f64) -> Option<String> {
    let runs = solved(bench, within);
    let mut classes: Vec<(&str, Vec<usize>)> = Vec::new();
    let class = |problem: usize| bench.problems[problem].class.as_str();
    let alone = |problem: usize| bench.problems.iter().filter(|own| own.class == class(problem)).count() == 1;
    for problem in 0..bench.problems.len() {
        let name = if alone(problem) { "" } else { class(problem) };
        match classes.iter_mut().find(|(own, _)| *own == name) {
            Some((_, problems)) => problems.push(problem),
            None => classes.push((name, vec![problem])),
        }
    }
    let some = |problems: &[usize]| runs.iter().any(|run| problems.contains(&run.0));
    let several = classes.iter().filter(|(_, problems)| problems.len() > 1 && some(problems));
    let drawn = several.map(|(name, problems)| {
        let title = if name.is_empty() { title.to_string() } else { format!("{title}: {name}") };
        profile(&title, &runs, problems, within)
    });
    let drawn: Vec<String> = drawn.collect();
    (!drawn.is_empty()).then(|| panels(&drawn))
}

/// Draws the profile of one class of problems.
fn profile(title: &str, runs: &[Run], problems: &[usize], within: f64) -> String {
    let own: Vec<Run> = runs.iter().copied().filter(|run| problems.contains(&run.0)).collect();
    let best = |problem: usize, name: Option<&str>| {
        let times = own.iter().filter(|run| run.0 == problem && name.is_none_or(|name| run.1 == name));
        times.map(|run| run.2).fold(f64::INFINITY, f64::min)
    };
    let mut names: Vec<&str> = Vec::new();
    for run in &own {
        if !names.contains(&run.1) {
            names.push(run.1);
        }
    }
    let ratios = |name: &str| -> Vec<f64> {
        let times = problems.iter().map(|&problem| best(problem, Some(name)) / best(problem, None));
        let mut ratios: Vec<f64> = times.filter(|ratio| ratio.is_finite()).collect();
        ratios.sort_by(f64::total_cmp);
        ratios
    };
    let all: Vec<(&str, Vec<f64>)> = names.into_iter().map(|name| (name, ratios(name))).collect();
    let last = all.iter().flat_map(|(_, ratios)| ratios).fold(1.0, |a: f64, b| a.max(*b));
    let series: Vec<Series> = all
        .into_iter()
        .map(|(name, ratios)| {
            let share = |answered: usize| answered as f64 / problems.len() as f64;
            let mut points = vec![(1.0, 0.0)];
            for (i, ratio) in ratios.iter().enumerate() {
                points.extend([(*ratio, share(i)), (*ratio, share(i + 1))]);
            }
            points.push((2.0 * last, share(ratios.len())));
            Series { name: name.into(), points, spots: Some(Vec::new()), ..Series::default() }
        })
        .collect();
    let note = format!(
        "Answered: a certified collapse or limit point within a relative error of {}, with the fastest setting. Other programs \
         certify nothing.",
        format_short(within, 2)
    );
    let style = ChartStyle { log: [true, false] };
    let label = "time over the least of all [-]";
    chart(title, label, "share of problems answered [-]", &series, &[note], &style)
}
