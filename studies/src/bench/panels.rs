//! Run time against error: one panel for each problem, with a line for each ladder of a setting.

use super::measured::{Bench, Measurement, Source};
use voussoir_plot::chart::chart;
use voussoir_plot::panels::panels;
use voussoir_plot::series::{ChartStyle, Series};
use voussoir_study::results::format::format_short;

/// Smaller errors are drawn as this value: they are rounding errors.
const NO_ERROR: f64 = 1e-16;
/// Slope of a line whose error falls with the time that is spent; the legend omits flatter ones.
const FLAT: f64 = -0.05;
/// Greatest number of panels; further problems are in the CSV file only.
const MOST_PANELS: usize = 16;

/// Draws error over time in one panel for each problem; if several studies are measured, for the first problem of each.
/// Returns `None` if no measurement has an error.
pub fn error_chart(title: &str, bench: &Bench) -> Option<String> {
    let drawn = error_panels(title, bench);
    (!drawn.is_empty()).then(|| panels(&drawn))
}

/// Returns the panels of [`error_chart`], one drawing each.
pub fn error_panels(title: &str, bench: &Bench) -> Vec<String> {
    let class = |problem: usize| &bench.problems[problem].class;
    let shown = |&problem: &usize| problem == 0 || class(problem).is_empty() || class(problem) != class(problem - 1);
    let drawn = (0..bench.problems.len()).filter(shown).filter_map(|problem| panel(title, bench, problem));
    drawn.take(MOST_PANELS).collect()
}

fn panel(title: &str, bench: &Bench, problem: usize) -> Option<String> {
    let source = bench.problems[problem].reference.as_ref()?;
    let all = || bench.measurements.iter().filter(|own| own.problem == problem);
    let own: Vec<&Measurement> = all().filter(|own| own.error.is_some()).collect();
    let reference = all().filter(|own| own.contestant == source.from);
    let mut series: Vec<Series> = reference
        .map(|own| ladder(&format!("{}, the reference", source.from), vec![(own.seconds, 0.0)], 0.0))
        .collect();
    for base in own.iter().filter(|own| own.rung.is_none()) {
        let rungs = || own.iter().filter(|rung| rung.rung.is_some() && rung.result.solver == base.result.solver);
        let mut ladders: Vec<&str> = rungs().filter_map(|rung| Some(rung.rung?.ladder)).collect();
        ladders.dedup();
        for &ladder in &ladders {
            let on_it = rungs().filter(|rung| rung.rung.is_some_and(|own| own.ladder == ladder));
            series.push(line(&format!("{}, {ladder}", base.contestant), source, on_it.chain([base])));
        }
        if ladders.is_empty() {
            series.push(line(&base.contestant, source, [base].into_iter()));
        }
    }
    series.extend(others(bench, problem));
    let times = || series.iter().flat_map(|own| own.points.iter().map(|point| point.0));
    let ends = [times().fold(f64::INFINITY, f64::min), times().fold(0.0, f64::max)];
    if let Some(band) = source.band.filter(|_| ends[1] > 0.0) {
        let points = ends.map(|time| (time, band.max(NO_ERROR))).to_vec();
        series.push(Series {
            name: "band of the reference".into(),
            points,
            spots: Some(Vec::new()),
            ..Series::default()
        });
    }
    let name = &bench.problems[problem].name;
    let title = if name.is_empty() { title.to_string() } else { format!("{title}: {name}") };
    let notes = [format!("Errors are measured from {}: {}.", source.from, format_short(source.factor, 8))];
    let style = ChartStyle { log: [true, true] };
    (!series.is_empty())
        .then(|| chart(&title, "processor time [s]", "relative error of the load factor [-]", &series, &notes, &style))
}

/// Returns one line for each other program that was measured: at each error the least time of a run that has at most this error.
fn others(bench: &Bench, problem: usize) -> Vec<Series> {
    let own = || bench.others.iter().filter(|own| own.problem == problem && own.error.is_some());
    let mut programs: Vec<&str> = own().map(|own| own.program.as_str()).collect();
    programs.sort_unstable();
    programs.dedup();
    let line = |program: &str| {
        let runs = own().filter(|own| own.program == program);
        let mut runs: Vec<(f64, f64)> = runs.filter_map(|own| Some((own.seconds, own.error?.max(NO_ERROR)))).collect();
        runs.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let mut points: Vec<(f64, f64)> = Vec::new();
        for run in runs {
            if points.last().is_none_or(|last| run.1 < last.1) {
                points.push(run);
            }
        }
        Series { name: program.into(), points, ..Series::default() }
    };
    programs.into_iter().map(line).collect()
}

fn line<'a>(name: &str, source: &Source, own: impl Iterator<Item = &'a &'a Measurement>) -> Series {
    ladder(name, own.filter_map(|own| Some((own.seconds, own.error?))).collect(), source.band.unwrap_or(0.0))
}

/// Returns the line of a ladder from pairs of time and error, by growing time. Its name has the slope if at least three errors
/// exceed `band`, the error of the reference, and fall.
pub fn ladder(name: &str, mut points: Vec<(f64, f64)>, band: f64) -> Series {
    points.iter_mut().for_each(|point| point.1 = point.1.max(NO_ERROR));
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let least = band.max(1e3 * NO_ERROR);
    let above: Vec<[f64; 2]> =
        points.iter().filter(|(_, error)| *error > least).map(|(time, error)| [time.ln(), error.ln()]).collect();
    let name = match slope(&above).filter(|slope| *slope < FLAT) {
        Some(slope) => format!("{name}: error ∝ time^{}", format_short(slope, 2)),
        None => name.into(),
    };
    Series { name, points, ..Series::default() }
}

/// Returns the slope of the line of least squares through at least three points.
fn slope(points: &[[f64; 2]]) -> Option<f64> {
    let count = points.len() as f64;
    let mean = [0, 1].map(|i| points.iter().map(|point| point[i]).sum::<f64>() / count);
    let sum = |i: usize| points.iter().map(|point| (point[0] - mean[0]) * (point[i] - mean[i])).sum::<f64>();
    (points.len() >= 3 && sum(0) > 0.0).then(|| sum(1) / sum(0))
}

#[cfg(test)]
mod tests {
    use super::slope;

    /// The slope of a power law is its exponent; two points have none.
    #[test]
    fn slopes_are_exponents() {
        let law = |x: f64| [x.ln(), (3.0 * x.powf(-1.5)).ln()];
        assert!((slope(&[1.0, 2.0, 5.0].map(law)).expect("three points") + 1.5).abs() < 1e-12);
        assert_eq!(slope(&[1.0, 2.0].map(law)), None);
    }
}
