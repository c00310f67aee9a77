//! Charts of capacity curves: spectral acceleration over spectral displacement, in both directions.

use crate::output::StudyOutput;
use voussoir_plot::chart::chart_svg;
use voussoir_plot::series::{Marker, Series, Spot};
use voussoir_study::results::format::format_length;
use voussoir_study::results::{CheckedQuantity, SeismicEntry, acceleration_at, governing};

/// Greatest number of charts.
const MAX_CHARTS: usize = 40;

/// Returns a chart for each case of the study that has a capacity curve: (name of the file without its ending, SVG).
pub fn capacity_charts(study: &StudyOutput) -> Vec<(String, String)> {
    let entries = study.results.own.seismic.as_deref().unwrap_or_default();
    let same = |a: &SeismicEntry, b: &SeismicEntry| a.variant == b.variant && a.parameters == b.parameters;
    let groups: Vec<&[SeismicEntry]> = entries.chunk_by(same).collect();
    let name = |index: usize| if groups.len() == 1 { "seismic".into() } else { format!("seismic-{index}") };
    let charts = groups.iter().enumerate().filter_map(|(index, group)| Some((name(index), chart(study, group)?)));
    charts.take(MAX_CHARTS).collect()
}

/// Returns the variant and the swept values of an entry; empty without them.
pub fn entry_name(study: &StudyOutput, entry: &SeismicEntry) -> String {
    study.keys.named(entry.variant.as_deref(), &entry.parameters)
}

fn chart(study: &StudyOutput, entries: &[SeismicEntry]) -> Option<String> {
    let marked = governing(entries);
    let line = |entry: &SeismicEntry| Series {
        name: format!("push to the {}", entry.direction.word()),
        points: entry.curve.iter().map(|&[d, a]| (d, a)).collect(),
        spots: Some(if marked == Some(entry) { spots(entry) } else { Vec::new() }),
        ..Series::default()
    };
    let series: Vec<Series> = entries.iter().filter(|entry| !entry.curve.is_empty()).map(line).collect();
    let case = entry_name(study, entries.first()?);
    let title = if case.is_empty() { study.name.to_string() } else { format!("{}, {case}", study.name) };
    let title = format!("{title}: capacity curve");
    let (x, y) = ("spectral displacement d* [m]", "spectral acceleration a* [m/s²]");
    (!series.is_empty()).then(|| chart_svg(&title, x, y, &series, &[]))
}

/// Returns the displacements that the check compares, as places of the curve. A demand beyond the curve is on the axis.
fn spots(entry: &SeismicEntry) -> Vec<Spot> {
    let Some(own) = &entry.capacity else { return Vec::new() };
    let spot = |d: f64, kind: &'static str, marker: Marker, symbol: &str| Spot {
        at: (d, acceleration_at(&entry.curve, d).unwrap_or(0.0).max(0.0)),
        kind,
        marker,
        label: format!("{symbol} {}", format_length(d)),
    };
    let mut spots = vec![
        spot(own.secant_displacement, "secant displacement ds*", Marker::Dot, "ds*"),
        spot(own.ultimate_displacement, "ultimate displacement du*", Marker::Square, "du*"),
    ];
    let demand = entry.least(CheckedQuantity::Displacement);
    spots.extend(demand.map(|check| spot(check.demand, "demand", Marker::Ring, "demand")));
    spots
}
