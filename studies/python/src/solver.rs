//! Limit solvers written in Python: `solver = "python_limit"`.
//!
//! The table names a class that `voussoir.limit_solver` has registered, and its parameters. The class solves linear
//! programs; the certificate decides the status of the result.

use crate::law::{bytes_of, numbers_of};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value as Json};
use voussoir::core::limit::{
    LimitAnswer, LimitProblem, LimitQuestion, LimitSolver, LinearProgram, LinearSolution, answer_by_programs,
};
use voussoir::core::plugin::{Capability, Card, Need, Parameter, PluginKind, Shape};

/// A limit solver that is defined in Python.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PythonLimit {
    class: String,
    #[serde(default)]
    parameters: Map<String, Json>,
}

voussoir::core::inventory::submit! {
    Card {
        kind: PluginKind::LimitSolver,
        tag: "python_limit",
        summary: "limit analysis by a Python class that solves linear programs",
        parameters: &[
            Parameter {
                name: "class",
                doc: "name under which the class is registered: @voussoir.limit_solver(\"NAME\")",
                shape: Shape::Text,
                need: Need::Required,
            },
            Parameter {
                name: "parameters",
                doc: "arguments of the constructor of the class",
                shape: Shape::Free,
                need: Need::Default("{}"),
            },
        ],
        requires: &[&[Capability::FACETS], &[Capability::RIGID_LIMIT]],
        file: file!(),
        package: voussoir::core::package!(),
        page: "# `python_limit`\n\nThe class has `solve(program)`, which returns the values of the columns and the duals of the rows of a linear program.\n",
        check: checked,
        ..Card::BLANK
    }
}

/// Returns the mistakes in a table, as reported by Python.
fn checked(table: &Json) -> Vec<(String, String)> {
    let class = table["class"].as_str().unwrap_or_default();
    let parameters = table["parameters"].as_object().map_or("{}".into(), |own| Json::from(own.clone()).to_string());
    Python::attach(|py| {
        let solvers = py.import("voussoir._solvers");
        let found = solvers.and_then(|solvers| solvers.call_method1("check", (class, parameters)));
        match found.and_then(|found| found.extract::<Option<(String, String)>>()) {
            Ok(found) => found.into_iter().collect(),
            Err(error) => vec![("class".into(), error.to_string())],
        }
    })
}

#[typetag::serde(name = "python_limit")]
impl LimitSolver for PythonLimit {
    fn solve(&self, problem: &LimitProblem, question: LimitQuestion) -> LimitAnswer {
        let names =
            problem.matrices().columns.iter().map(|column| [column.joint, column.component]).collect::<Vec<_>>();
        answer_by_programs(problem, question, &mut |program| {
            self.solved(program, &names).map_err(|error| format!("the class \"{}\": {error}", self.class))
        })
    }

    fn refuses(&self, problem: &LimitProblem) -> Option<String> {
        problem.beyond_rows().map(Into::into)
    }
}

impl PythonLimit {
    /// Passes a program to the class. `names` are the joint and the component of each force.
    fn solved(&self, program: &LinearProgram, names: &[[usize; 2]]) -> PyResult<LinearSolution> {
        let integers = |values: &mut dyn Iterator<Item = i64>| values.flat_map(i64::to_ne_bytes).collect::<Vec<u8>>();
        let ends = program.rows.iter().scan(0, |end, row| {
            *end += row.len() as i64;
            Some(*end)
        });
        let entries = || program.rows.iter().flatten();
        let mut names: Vec<i64> = names.as_flattened().iter().map(|index| *index as i64).collect();
        names.resize(2 * program.column_bounds.len(), -1);
        let data: Vec<f64> = entries().map(|entry| entry.1).collect();
        let parts = [
            integers(&mut std::iter::once(0).chain(ends)),
            integers(&mut entries().map(|entry| entry.0 as i64)),
            integers(&mut names.into_iter()),
            bytes_of(&data),
            bytes_of(program.row_bounds.as_flattened()),
            bytes_of(program.column_bounds.as_flattened()),
        ];
        let parameters = Json::from(self.parameters.clone()).to_string();
        Python::attach(|py| {
            let parts: Vec<Bound<'_, PyBytes>> = parts.iter().map(|part| PyBytes::new(py, part)).collect();
            let arguments = (&self.class, parameters, parts, program.equations);
            let answer = py.import("voussoir._solvers")?.call_method1("solve", arguments)?;
            let [columns, duals]: [Bound<'_, PyBytes>; 2] = answer.extract()?;
            Ok(LinearSolution { columns: numbers_of(columns.as_bytes()), duals: numbers_of(duals.as_bytes()) })
        })
    }
}
