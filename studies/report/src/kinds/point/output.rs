//! The files of a study of driven points: results.json, results.csv, the figure, and the table for the terminal.

use super::drive::drive_point;
use super::result::{PathStatus, PointResult, column};
use super::study::PointStudy;
use super::surface::yield_surface;
use crate::kinds::one_case;
use crate::kinds::stored_results::altered;
use crate::output::columns::swept_text;
use crate::writers::csv_table::csv_table;
use comfy_table::{CellAlignment, ContentArrangement, Table, presets};
use serde::Deserialize;
use serde_json::{Value as Json, json};
use voussoir_plot::chart::chart_svg;
use voussoir_plot::series::Series;
use voussoir_plot::svg::as_file;
use voussoir_study::cases::Observer;
use voussoir_study::checks::Agreement;
use voussoir_study::kind::StoredResults;
use voussoir_study::kind::{LoadedStudy, Piece, RunOutput, RunRequest, Verification};
use voussoir_study::results::format::{format_number, format_value};
use voussoir_study::results::{StoredOutline, head, without_origin};
use voussoir_study::study::SweptKeys;

impl LoadedStudy for PointStudy {
    fn name(&self) -> &str {
        &self.name
    }

    fn count(&self) -> usize {
        self.cases.len()
    }

    fn resolved(&self) -> &toml::Value {
        &self.resolved
    }

    fn explain(&self) -> String {
        let mut text = format!("study \"{}\" (point): {} case(s)\n", self.name, self.cases.len());
        for case in &self.cases {
            let steps: usize = case.path.iter().map(|segment| segment.steps).sum();
            text +=
                &format!("case {}: {} at one point, {} segments, {steps} steps\n", case.id, case.tag, case.path.len());
        }
        text
    }

    fn piece(&self, _results: &str, piece: Piece) -> Option<String> {
        (piece == Piece::Chart).then(|| figure(self, &self.cases.iter().map(drive_point).collect::<Vec<_>>()))
    }

    fn run(&self, request: &RunRequest, observer: &dyn Observer) -> RunOutput {
        let kept = request.kept.as_ref().and_then(|results| serde_json::from_str::<StoredOutline>(results).ok());
        let stored = kept.unwrap_or_default().ids();
        let others: Vec<usize> = stored.into_iter().filter(|id| !request.wanted.contains(id)).collect();
        // Driving a point is cheap: cases that stay in the results are driven again, so that they belong to the current study.
        let chosen = self.cases.iter().filter(|case| request.wanted.contains(&case.id) || others.contains(&case.id));
        let chosen = chosen.take_while(|_| !observer.cancelled());
        let results: Vec<PointResult> = chosen.map(drive_point).collect();
        let others = results.iter().filter(|result| !request.wanted.contains(&result.id)).count();
        RunOutput {
            files: files(self, &results, &request.version)
                .into_iter()
                .map(|(n, text)| (n, text.into_bytes()))
                .collect(),
            table: table(self, &results),
            remarks: match request.wanted[..] {
                [id] if request.kept.is_some() && self.cases.len() > 1 => vec![one_case(id, self.cases.len(), others)],
                _ => Vec::new(),
            },
            certified: results.iter().all(|result| result.status == PathStatus::Reached) && !observer.cancelled(),
        }
    }

    /// Drives all points again: every number must be the same.
    fn verify_stored(&self, stored: &StoredResults, _observer: &dyn Observer) -> Result<Verification, String> {
        let json: Json = serde_json::from_reader(stored.results()?).map_err(|error| error.to_string())?;
        let entries = json.get("cases").and_then(Json::as_array).ok_or("there is no list of cases")?;
        let outline = StoredOutline::deserialize(&json).map_err(|error| error.to_string())?;
        let only = outline.only_cases.as_ref().map(|_| outline.ids());
        let wanted = self.cases.iter().filter(|case| only.as_ref().is_none_or(|ids| ids.contains(&case.id)));
        let driven: Vec<PointResult> = wanted.map(drive_point).collect();
        let version = &outline.version;
        let agreement = json.as_object().map_or(Agreement::Program, |head| Agreement::of_head(head, &self.resolved));
        let stored_rest = without_origin(json.clone());
        let (mut stored_rest, mut again) = (stored_rest, without_origin(results_json(self, &driven, version)));
        if json.get("format").is_none() {
            again.as_object_mut().map(|older| older.shift_remove("files"));
        }
        let mut findings: Vec<_> = outline.origin.too_new().map(|why| (0, why)).into_iter().collect();
        if entries.len() != driven.len() || entries.is_empty() {
            findings.push((0, format!("there are {} cases, the study asks for {}", entries.len(), driven.len())));
        }
        for (entry, result) in entries.iter().zip(&driven) {
            let again = serde_json::to_value(result).map_err(|error| error.to_string())?;
            findings.extend(agreement.differences(entry, &again).into_iter().map(|why| (result.id, why)));
        }
        for rest in [&mut stored_rest, &mut again].into_iter().filter_map(Json::as_object_mut) {
            rest.shift_remove("cases");
        }
        findings.extend(agreement.differences(&stored_rest, &again).into_iter().map(|why| (0, why)));
        let made = files(self, &driven, version);
        Ok(Verification {
            cases: entries.len(),
            stalled: driven.iter().filter(|result| result.status == PathStatus::Stalled).count(),
            findings,
            files: altered(stored, made.iter().map(|(name, text)| (name.as_str(), text.as_bytes())), agreement),
            agreement,
            paths: [0, 0],
            own: driven.len(),
            of: self.cases.len(),
            how: "checked: every number and word against driving the point again; tables and figures against those of the \
                  study. Not checked: counters, version",
        })
    }
}

/// Returns the content of results.json.
fn results_json(study: &PointStudy, results: &[PointResult], version: &str) -> Json {
    let only_cases: Vec<usize> = results.iter().map(|result| result.id).collect();
    let mut whole = head((&study.name, &study.resolved), version, &file_names(study));
    whole.insert("kind".into(), "point".into());
    if only_cases.len() < study.cases.len() {
        whole.insert("only_cases".into(), only_cases.into());
    }
    whole.insert("cases".into(), json!(results));
    whole.into()
}

/// Returns the names of the files beside results.json, sorted.
fn file_names(study: &PointStudy) -> Vec<String> {
    let figure = study.figures.then(|| FIGURE.to_string());
    figure.into_iter().chain(["results.csv".into()]).collect()
}

/// The figure of all paths.
const FIGURE: &str = "figures/path.svg";

/// Returns (name, text) of every file.
pub fn files(study: &PointStudy, results: &[PointResult], version: &str) -> Vec<(String, String)> {
    let whole = results_json(study, results, version);
    let mut out =
        vec![("results.json".to_string(), format!("{whole:#}\n")), ("results.csv".to_string(), csv(study, results))];
    if study.figures {
        out.push((FIGURE.into(), as_file(&figure(study, results))));
    }
    out
}

/// Returns the swept keys in order.
fn keys(results: &[PointResult]) -> Vec<String> {
    results.first().map(|result| result.parameters.keys().cloned().collect()).unwrap_or_default()
}

/// Returns one row per step of every case; columns that a case's law does not have are empty.
pub fn csv(study: &PointStudy, results: &[PointResult]) -> String {
    let mut columns: Vec<&String> = Vec::new();
    for column in results.iter().flat_map(|result| &result.columns) {
        if !columns.contains(&column) {
            columns.push(column);
        }
    }
    let keys = keys(results);
    let header = ["id".to_string(), "variant".into()].into_iter().chain(keys.iter().map(|key| study.keys.column(key)));
    let header = header.chain(["segment".to_string(), "region".into()]).chain(columns.iter().map(|c| c.to_string()));
    let mut rows = Vec::new();
    for result in results {
        let places: Vec<Option<usize>> =
            columns.iter().map(|column| result.columns.iter().position(|own| own == *column)).collect();
        for (index, numbers) in result.rows.iter().enumerate() {
            let mut row = vec![result.id.to_string(), result.variant.clone().unwrap_or_default()];
            row.extend(keys.iter().map(|key| swept_text(result.parameters.get(key))));
            row.extend([result.segments[index].to_string(), result.regions[index].to_string()]);
            row.extend(places.iter().map(|place| place.map_or(String::new(), |place| numbers[place].to_string())));
            rows.push(row);
        }
    }
    csv_table(header.collect(), rows.into_iter())
}

/// Returns the name of a case: its swept values; keys with the same value are joined.
fn name(study: &PointStudy, result: &PointResult) -> String {
    let mut parameters: Vec<(String, String)> = Vec::new();
    for (key, value) in &result.parameters {
        let (short, value) = parameter(&study.keys, key, value);
        match parameters.iter_mut().find(|(_, other)| *other == value) {
            Some((names, _)) => *names += &format!(", {short}"),
            None => parameters.push((short, value)),
        }
    }
    let parameters = parameters.into_iter().map(|(names, value)| format!("{names} = {value}"));
    let words: Vec<String> = result.variant.iter().cloned().chain(parameters).collect();
    if words.is_empty() { result.law.clone() } else { words.join(", ") }
}

/// Returns the short name of a swept key and its value for the legend, with stresses in MPa.
fn parameter(keys: &SweptKeys, key: &str, value: &Json) -> (String, String) {
    let name = match keys.first(key).map(|meaning| (meaning.table, meaning.name)) {
        Some((Some("stress"), component)) => format!("σ_{component}"),
        Some((Some("strain"), component)) => format!("ε_{component}"),
        _ => keys.name(key),
    };
    match (keys.unit(key).as_deref(), value.as_f64()) {
        (Some("Pa"), Some(stress)) => (name, format!("{} MPa", format_value(&(stress / 1e6).into()))),
        _ => (name, keys.value(key, value)),
    }
}

/// Converts stresses to MPa and lengths to mm; other quantities are unchanged.
fn scaled(label: &str) -> (String, f64) {
    if let Some(word) = label.strip_suffix(" [Pa]") {
        (format!("{} [MPa]", word.replace('_', " ")), 1e-6)
    } else if let Some(word) = label.strip_suffix(" [m]") {
        (format!("{} [mm]", word.replace('_', " ")), 1e3)
    } else {
        (label.replace('_', " "), 1.0)
    }
}

/// Draws the curve of every case as SVG.
pub fn figure(study: &PointStudy, results: &[PointResult]) -> String {
    let mut labels = [String::new(), String::new()];
    let mut notes = Vec::new();
    let mut series: Vec<Series> = results
        .iter()
        .map(|result| (&study.cases[result.id], result))
        .map(|(case, result)| {
            let [x, y] = [0, 1].map(|axis| {
                let place = column(&result.columns, &case.plot[axis]).unwrap_or(axis);
                let (label, factor) = scaled(&result.columns[place]);
                labels[axis] = label;
                (place, factor)
            });
            if result.status == PathStatus::Stalled {
                notes.push(format!("{}: {}", name(study, result), result.notes.last().cloned().unwrap_or_default()));
            }
            let points = result.rows.iter().map(|row| (row[x.0] * x.1, row[y.0] * y.1)).collect();
            Series { name: name(study, result), points, ..Series::default() }
        })
        .collect();
    series.extend(surfaces(study, results));
    let title = format!("{}: {} over {}", study.name, labels[1], labels[0]);
    chart_svg(&title, &labels[0], &labels[1], &series, &notes)
}

/// Returns the yield surface of each variant's law, if the figure shows p and q.
fn surfaces(study: &PointStudy, results: &[PointResult]) -> Vec<Series> {
    let in_plane = |result: &&PointResult| study.cases[result.id].plot == ["p", "q"];
    let greatest = |word: &str| {
        let of = |result: &PointResult| {
            let place = column(&result.columns, word)?;
            Some(result.rows.iter().map(|row| row[place]).fold(0.0, f64::max))
        };
        results.iter().filter_map(of).fold(0.0, f64::max)
    };
    let mut seen = Vec::new();
    let firsts = results.iter().filter(in_plane).filter(|result| {
        let new = !seen.contains(&result.variant);
        seen.push(result.variant.clone());
        new
    });
    let far = [1.2 * greatest("p"), 1.2 * greatest("q")];
    firsts
        .map(|result| {
            let points = yield_surface(&study.cases[result.id].law, far);
            let points: Vec<(f64, f64)> = points.into_iter().map(|(p, q)| (p * 1e-6, q * 1e-6)).collect();
            let name = result.variant.as_ref().map_or(String::new(), |variant| format!(", {variant}"));
            Series { name: format!("yield surface{name}"), points, spots: Some(Vec::new()), ..Series::default() }
        })
        .filter(|series| !series.points.is_empty())
        .collect()
}

/// Returns one row per case: its end, and the least, greatest and last value of the plotted quantity.
pub fn table(study: &PointStudy, results: &[PointResult]) -> String {
    let mut table = Table::new();
    let keys = keys(results);
    let mut header = vec!["id".to_string(), "case".into(), "law".into(), "status".into(), "rows".into()];
    let plotted = study.cases.first().map_or(String::new(), |case| case.plot[1].clone());
    let label = results.first().and_then(|r| Some(r.columns[column(&r.columns, &plotted)?].clone())).unwrap_or(plotted);
    header.extend([
        format!("least {label}"),
        "greatest".into(),
        "last".into(),
        "last region".into(),
        "dissipated".into(),
    ]);
    table.load_style(presets::NOTHING).set_content_arrangement(ContentArrangement::Disabled).set_header(header);
    for result in results {
        let case = &study.cases[result.id];
        let values: Vec<f64> = column(&result.columns, &case.plot[1])
            .map(|place| result.rows.iter().map(|row| row[place]).collect())
            .unwrap_or_default();
        let number = |x: Option<f64>| x.map_or(String::new(), |x| format_number(x, 10));
        let dissipated = column(&result.columns, "dissipated").and_then(|place| Some(result.rows.last()?[place]));
        let told_apart = result.variant.is_some() || !keys.is_empty();
        table.add_row([
            result.id.to_string(),
            if told_apart { name(study, result) } else { String::new() },
            result.law.clone(),
            if result.status == PathStatus::Reached { "reached" } else { "stalled" }.into(),
            result.rows.len().to_string(),
            number(values.iter().copied().reduce(f64::min)),
            number(values.iter().copied().reduce(f64::max)),
            number(values.last().copied()),
            result.regions.last().map_or(String::new(), |region| region.to_string()),
            number(dissipated),
        ]);
    }
    for index in [0, 4, 5, 6, 7, 9] {
        if let Some(column) = table.column_mut(index) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    let mut text: String = table.to_string().lines().map(|line| line.trim_end().to_string() + "\n").collect();
    for result in results {
        result.notes.iter().for_each(|note| text.push_str(&format!("case {}: {note}\n", result.id)));
    }
    text
}
