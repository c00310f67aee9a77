//! `curve.csv`: the points of load-displacement curves, if a study requests them.

use super::csv_table::csv_row;
use super::register::register;
use super::writer::{CaseTable, Writer};
use crate::output::StudyOutput;
use crate::output::columns::Column;
use serde_json::Value as Json;
use std::io::{self, Write};
use voussoir_study::results::CaseResult;

/// Writes `curve.csv`.
#[derive(Debug)]
pub struct CurveCsv;

/// The columns that identify cases.
struct Rows(Vec<Column>);

impl Writer for CurveCsv {
    fn table<'a>(&self, study: &StudyOutput<'a>, _options: &Json) -> Option<Box<dyn CaseTable + 'a>> {
        study.totals.curves.then(|| Box::new(Rows(study.file_labels().columns())) as Box<dyn CaseTable>)
    }
}

/// One row for each point of a case's curve, in the order of the path.
impl CaseTable for Rows {
    fn name(&self) -> String {
        "curve.csv".into()
    }

    fn begin(&mut self, out: &mut dyn Write) -> io::Result<()> {
        let own = ["stage", "displacement [m]", "load_factor [-]"].map(String::from);
        out.write_all(&csv_row(self.0.iter().map(Column::header).chain(own)))
    }

    fn add(&mut self, case: &CaseResult, out: &mut dyn Write) -> io::Result<()> {
        let labels: Vec<String> = self.0.iter().map(|column| column.cell(case).text()).collect();
        let stage = case.stages.last().map_or("", |stage| stage.name.as_str());
        for [displacement, factor] in case.path.curve.iter().flatten() {
            let own = [stage.to_string(), displacement.to_string(), factor.to_string()];
            out.write_all(&csv_row(labels.iter().cloned().chain(own)))?;
        }
        Ok(())
    }
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
