//! `run`: every case of the study is answered on its own.

use super::{KindEntry, Observer, OnPath, StudyKind};
use crate::answer::{Choice, Question, answer};
use crate::results::CaseResult;
use crate::study::{Case, Kinematics, Study};
use rayon::prelude::*;
use std::sync::Arc;
use std::time::Instant;
use voussoir_core::limit::LimitSolver;
use voussoir_core::path::{Continuation, PathObserver, PathProblem, PathSettings, PathSolver, PathState, Unobserved};
use voussoir_core::plugin::{Card, PluginKind, card};

struct Run;

voussoir_core::inventory::submit! { KindEntry { tag: "run", kind: &Run } }

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::StudyKind,
        tag: "run",
        summary: "answers every case of the study (variants × sweep) on its own",
        parameters: &[],
        file: file!(),
        page: "# `run`\n\nAnswers every case, variants outermost, then the axes of the sweep. One row of the table and one entry of results.json a case.\n",
        ..Card::BLANK
    }
}

/// The solver a case asks for.
pub fn choice(case: &Case) -> Choice {
    let tag = case.solver.tag.clone();
    let table = &case.solver.table;
    if card(PluginKind::LimitSolver, &tag).is_some()
        && let Ok(solver) = serde_json::from_value::<Box<dyn LimitSolver>>(table.clone())
    {
        return Choice::Named(tag, Arc::from(solver));
    }
    match serde_json::from_value::<Box<dyn PathSolver>>(table.clone()) {
        Ok(solver) if tag != "auto" => Choice::Path(tag, Arc::from(solver)),
        _ => Choice::Auto,
    }
}

/// What a path solver is told.
pub fn settings(case: &Case) -> PathSettings {
    let read = |table: &serde_json::Value| serde_json::from_value::<Box<dyn Continuation>>(table.clone()).ok();
    PathSettings {
        finite: case.solver.kinematics == Kinematics::Finite,
        tolerance: case.solver.tolerance,
        stop_displacement: case.solver.stop_displacement,
        stop_factor: case.solver.stop_factor,
        continuation: case.solver.continuation.as_ref().and_then(read).map(Arc::from),
    }
}

/// Tells an observer of a study how far the path of a case has come.
struct Followed<'a> {
    case: &'a Case,
    observer: &'a dyn Observer,
    states: u64,
}

impl PathObserver for Followed<'_> {
    fn state(&mut self, problem: &PathProblem, state: &PathState) -> bool {
        self.states += 1;
        let load_step = &problem.load_steps[state.load_step];
        self.observer.on_path(&OnPath {
            case: self.case.id,
            stage: &self.case.stages[load_step.stage].name,
            gravity: load_step.gravity,
            factor: state.factor,
            states: self.states,
        });
        true
    }
}

/// Answers one case.
pub fn answer_case(case: &Case) -> CaseResult {
    answer_followed(case, &mut Unobserved)
}

fn answer_followed(case: &Case, observer: &mut dyn PathObserver) -> CaseResult {
    let started = Instant::now();
    let question = Question {
        assembly: &case.assembly,
        stages: &case.stages,
        solver: &choice(case),
        tolerance: case.solver.tolerance,
        settings: &settings(case),
    };
    let mut result = answer(&question, observer);
    result.id = case.id;
    result.variant = case.variant.clone();
    result.scene = case.scene.clone();
    result.parameters = case.parameters.clone();
    result.notes.extend(case.notes.iter().cloned());
    if !case.output_curve {
        result.curve = None;
    }
    result.seconds = started.elapsed().as_secs_f64();
    result
}

/// Answers cases, `jobs` of them side by side.
pub fn answer_cases(study: &Study, wanted: &[usize], jobs: usize, observer: &dyn Observer) -> Vec<CaseResult> {
    let one = |id: &usize| {
        let case = &study.cases[*id];
        let result = answer_followed(case, &mut Followed { case, observer, states: 0 });
        observer.answered(&result);
        result
    };
    match rayon::ThreadPoolBuilder::new().num_threads(jobs.max(1)).build() {
        Ok(pool) if jobs > 1 => pool.install(|| wanted.par_iter().map(one).collect()),
        _ => wanted.iter().map(one).collect(),
    }
}

impl StudyKind for Run {
    fn answer(&self, study: &Study, wanted: &[usize], jobs: usize, observer: &dyn Observer) -> Vec<CaseResult> {
        answer_cases(study, wanted, jobs, observer)
    }
}
