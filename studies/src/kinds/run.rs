//! `run`: every case of the study is answered on its own.

use super::{KindEntry, Observer, StudyKind};
use crate::answer::{Choice, Question, answer};
use crate::results::CaseResult;
use crate::study::{Case, Study};
use rayon::prelude::*;
use std::sync::Arc;
use std::time::Instant;
use voussoir_core::card::{Card, no_further_check};
use voussoir_core::limit::LimitSolver;
use voussoir_core::schema::PluginKind;

struct Run;

voussoir_core::inventory::submit! { KindEntry { tag: "run", kind: &Run } }

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::StudyKind,
        tag: "run",
        summary: "answers every case of the study (variants × sweep) on its own",
        parameters: &[],
        provides: &[],
        requires: &[],
        sources: &[],
        file: file!(),
        page: "# `run`\n\nAnswers every case, variants outermost, then the axes of the sweep. One row of the table and one entry of results.json a case.\n",
        check: no_further_check,
    }
}

/// The solver a case asks for.
pub fn choice(case: &Case) -> Choice {
    match serde_json::from_value::<Box<dyn LimitSolver>>(case.solver.table.clone()) {
        Ok(solver) if case.solver.tag != "auto" => Choice::Named(case.solver.tag.clone(), Arc::from(solver)),
        _ => Choice::Auto,
    }
}

/// Answers one case.
pub fn answer_case(case: &Case) -> CaseResult {
    let started = Instant::now();
    let question = Question {
        assembly: &case.assembly,
        stages: &case.stages,
        solver: &choice(case),
        tolerance: case.solver.tolerance,
    };
    let mut result = answer(&question);
    result.id = case.id;
    result.variant = case.variant.clone();
    result.parameters = case.parameters.clone();
    result.notes.extend(case.notes.iter().cloned());
    result.seconds = started.elapsed().as_secs_f64();
    result
}

impl StudyKind for Run {
    fn answer(&self, study: &Study, wanted: &[usize], jobs: usize, observer: &dyn Observer) -> Vec<CaseResult> {
        let one = |id: &usize| {
            let result = answer_case(&study.cases[*id]);
            observer.answered(&result);
            result
        };
        match rayon::ThreadPoolBuilder::new().num_threads(jobs.max(1)).build() {
            Ok(pool) if jobs > 1 => pool.install(|| wanted.par_iter().map(one).collect()),
            _ => wanted.iter().map(one).collect(),
        }
    }
}
