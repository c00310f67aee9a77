//! A limit solver on Clarabel, a solver of linear and conic programs.

use clarabel::algebra::CscMatrix;
use clarabel::solver::SupportedConeT::{NonnegativeConeT, ZeroConeT};
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver};
use voussoir_plug::limit::{
    LimitAnswer, LimitProblem, LimitQuestion, LimitSolver, LinearProgram, LinearSolution, answer_by_programs,
};
use voussoir_plug::plugin::{Capability, Card, Keys, PluginKind};
use voussoir_plug::{inventory, typetag};

/// `solver = "clarabel_limit"`: limit analysis of joints with linear strengths.
#[derive(Debug, Keys)]
pub struct ClarabelLimit {}

#[typetag::serde(name = "clarabel_limit")]
impl LimitSolver for ClarabelLimit {
    fn solve(&self, problem: &LimitProblem, question: LimitQuestion) -> LimitAnswer {
        answer_by_programs(problem, question, &mut solved)
    }

    fn refuses(&self, problem: &LimitProblem) -> Option<String> {
        problem.beyond_rows().map(Into::into)
    }
}

/// Solves a program in the form A x + s = b with s = 0 for equations and s ≥ 0 for other rows.
fn solved(program: &LinearProgram) -> Result<LinearSolution, String> {
    let columns = program.column_bounds.len();
    let (mut rows, mut right) = (program.rows.clone(), Vec::new());
    right.extend(program.row_bounds.iter().map(|bounds| bounds[1]));
    let cap = program.column_bounds[columns - 1][1];
    if cap.is_finite() {
        rows.push(vec![(columns - 1, 1.0)]);
        right.push(cap);
    }
    let entries = || rows.iter().enumerate().flat_map(|(i, row)| row.iter().map(move |&(j, value)| (i, j, value)));
    let (i, j, values) =
        (entries().map(|e| e.0).collect(), entries().map(|e| e.1).collect(), entries().map(|e| e.2).collect());
    let matrix = CscMatrix::new_from_triplets(rows.len(), columns, i, j, values);
    let cones = [ZeroConeT(program.equations), NonnegativeConeT(rows.len() - program.equations)];
    let mut objective = vec![0.0; columns];
    objective[columns - 1] = -1.0;
    let (none, tolerance) = (CscMatrix::zeros((columns, columns)), 1e-13);
    let settings = DefaultSettings {
        verbose: false,
        tol_gap_abs: tolerance,
        tol_gap_rel: tolerance,
        tol_feas: tolerance,
        ..DefaultSettings::default()
    };
    let mut solver =
        DefaultSolver::new(&none, &objective, &matrix, &right, &cones, settings).map_err(|e| e.to_string())?;
    solver.solve();
    let solution = &solver.solution;
    if solution.r_prim.max(solution.r_dual) > 1e-8 || !solution.obj_val.is_finite() {
        return Err(format!("the program has no optimum: {:?}", solution.status));
    }
    Ok(LinearSolution { columns: solution.x.clone(), duals: solution.z.clone() })
}

inventory::submit! {
    Card {
        kind: PluginKind::LimitSolver,
        tag: "clarabel_limit",
        summary: "limit analysis by Clarabel, for joints with linear strengths",
        requires: &[&[Capability::FACETS], &[Capability::RIGID_LIMIT]],
        sources: &["Goulart & Chen 2024, Clarabel"],
        file: file!(),
        package: voussoir_plug::package!(),
        page: "# `clarabel_limit`\n\nOne linear program for each optimisation.\n",
        ..Card::of::<ClarabelLimit>()
    }
}
