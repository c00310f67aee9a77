//! `curve.csv`: the points of load-displacement curves, where a study asks for them.

use super::columns::Column;
use super::csv::row;
use super::csv_table::csv_table;
use super::register::register;
use super::study_output::StudyOutput;
use super::writer::Writer;
use serde_json::Value as Json;

/// Writes `curve.csv`.
#[derive(Debug)]
pub struct CurveCsv;

impl Writer for CurveCsv {
    fn files(&self, study: &StudyOutput, _options: &Json) -> Vec<(String, Vec<u8>)> {
        let any = study.results.cases.iter().any(|case| case.path.curve.is_some());
        if any { vec![("curve.csv".into(), curve_csv(study).into_bytes())] } else { Vec::new() }
    }
}

/// One row per point of each case's curve, in the order of the path.
pub fn curve_csv(study: &StudyOutput) -> String {
    let labels = study.file_labels().columns();
    let mut header: Vec<String> = labels.iter().map(Column::header).collect();
    header.extend(["stage", "displacement [m]", "load_factor [-]"].map(String::from));
    let mut rows = Vec::new();
    for case in &study.results.cases {
        let stage = case.stages.last().map_or("", |stage| stage.name.as_str());
        for [displacement, factor] in case.path.curve.iter().flatten() {
            let mut row = row(&labels, case);
            row.extend([stage.to_string(), displacement.to_string(), factor.to_string()]);
            rows.push(row);
        }
    }
    csv_table(header, rows.into_iter())
}

register!(
    "curve_csv",
    CurveCsv,
    "curve.csv: load over displacement along each path, on request",
    "# `curve_csv`\n\nWrites `curve.csv` where `[output] curve = true` and a case was followed by a path solver: a row for each \
     state of the last stage, in order. The displacement is that of the loads along themselves (work-conjugate: for one force, \
     of its point in its direction) by the rigid motion of the blocks that carry them; elastic deformation of those blocks is \
     left out. A case that is answered by limit analysis has no rows.\n"
);
