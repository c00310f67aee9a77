//! `seismic`: the kinematic analysis of mechanisms under horizontal accelerations.
#![doc = include_str!("seismic.md")]

mod checks;
mod conversion;
mod entries;
mod push;
mod request;
mod spectrum;

use self::push::{MADE, Push, made_id};
use self::request::Request;
use super::case_study::SceneStudy;
use super::search::case_at;
use rayon::prelude::*;
use std::borrow::Cow;
use voussoir_core::plugin::{Card, Diagnostic, PluginKind, Sample};
use voussoir_study::cases::{Observer, solve_cases, solve_unless_cancelled};
use voussoir_study::config::diagnostic::LocatedDiagnostic;
use voussoir_study::kind::{KindEntry, LoadedStudy, OwnResults, StudyKind};
use voussoir_study::results::{CaseLabel, CaseResult, ProofFields};
use voussoir_study::side_by_side::side_by_side;
use voussoir_study::study::{Case, Outline, Study, StudyError, StudySource};

struct Seismic;

voussoir_core::inventory::submit! { KindEntry { tag: "seismic", kind: &Seismic } }

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::StudyKind,
        tag: "seismic",
        summary: "the kinematic analysis of a mechanism under horizontal accelerations: activation, capacity curve, check of the demand",
        sources: &[
            "Circolare C.S.LL.PP. 617/2009, C8A.4 (kinematic analysis, conversion, checks)",
            "EN 1998-1:2004, 3.2.2.2 (spectra), 4.3.5.2 (elements above the ground)",
            "NTC 2018, 3.2.3.2 (spectra)",
        ],
        samples: &[Sample::keys(r#"[seismic]
ground_acceleration = "0.2 g"
periods = [0.15, 0.5, 2.0]

[[variants]]
name = "push"
set = { "stages.live.loads" = [{ kind = "body", acceleration = [9.81, 0.0] }] }"#)],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("seismic.md"),
        ..Card::of::<Request>()
    }
}

/// Returns a case that is made from a case of the study; `None` if it has no capacity curve.
fn made_case(study: &Study, base: usize, made: usize) -> Option<Case> {
    if base >= study.count() {
        return None;
    }
    let own = study.case(base)?;
    if made > 0 && !own.assembly.deforms() {
        return None;
    }
    let mut case = case_at(study, base, made_id(study, base, made), &Push::of(&own)?.values(made))?;
    // These settings are equal in all paths.
    case.parameters.retain(|key, _| key != "solver.kinematics" && key != "solver.stop.factor");
    case.brief = false;
    case.output_curve = made > 0;
    Some(case)
}

/// Returns the mistakes in a case of the study.
fn mistakes_of(case: &Case) -> Option<(&'static str, &'static str, &'static str)> {
    if Push::of(case).is_none() {
        let help = "[[stages]] until = \"collapse\", loads = [{ kind = \"body\", acceleration = [9.81, 0.0] }]";
        return Some((
            "stages",
            "the last stage must push all masses horizontally until collapse, with gravity downwards",
            help,
        ));
    }
    if case.assembly.bridge.as_ref().is_some_and(|bridge| !bridge.masses.is_empty()) {
        return Some((
            "scene",
            "the fill has no horizontal inertia: the result would be unsafe",
            "use the scene \"arch\" or \"blocks\"",
        ));
    }
    if case.solver.settings.finite {
        return Some((
            "solver.kinematics",
            "must be small: this kind follows the finite path itself",
            "remove this key",
        ));
    }
    if !case.output_fields {
        return Some(("output.fields", "must be true: the motion of the mechanism is needed", "remove this key"));
    }
    None
}

impl StudyKind for Seismic {
    fn read(&self, source: StudySource) -> Result<Box<dyn LoadedStudy>, StudyError> {
        let study = Study::from_source_in_turn(source)?;
        for id in 0..study.count() {
            let Some(case) = study.case(id) else { continue };
            if let Some((key, message, help)) = mistakes_of(&case) {
                let root = study.root(id)?;
                return Err(vec![LocatedDiagnostic::new(&root.place(key), key, message).help(help)].into());
            }
            let push = Push::of(&case).map(|push| push.values(0)).unwrap_or_default();
            study.at(id, &push)?;
        }
        Ok(Box::new(SceneStudy(study)))
    }

    fn check(&self, outline: &Outline) -> Vec<Diagnostic> {
        match outline.read::<Request>() {
            Some(request) => request.mistakes(),
            None => vec![Diagnostic::new("seismic", "is missing").help("[seismic] ground_acceleration, periods")],
        }
    }

    fn solve(&self, study: &Study, wanted: &[usize], jobs: usize, observer: &dyn Observer) -> Vec<CaseResult> {
        let mut results = solve_cases(study, wanted, jobs, observer);
        let made: Vec<(usize, usize)> = wanted.iter().flat_map(|base| (0..MADE).map(|made| (*base, made))).collect();
        let solve = |&(base, made): &(usize, usize)| solve_unless_cancelled(&made_case(study, base, made)?, observer);
        results.extend(side_by_side(jobs, || made.par_iter().filter_map(solve).collect::<Vec<_>>()));
        results
    }

    fn makes_cases(&self) -> bool {
        true
    }

    fn case<'a>(&self, study: &'a Study, label: &CaseLabel) -> Option<Cow<'a, Case>> {
        let Some(made) = label.id.checked_sub(study.count()) else { return study.case(label.id) };
        made_case(study, made / MADE, made % MADE).map(Cow::Owned)
    }

    fn needed(&self, result: &CaseResult) -> CaseResult {
        let proof = ProofFields { motion: result.proof.motion.clone(), ..ProofFields::default() };
        CaseResult { proof, ..result.brief() }
    }

    fn own_results(&self, study: &Study, cases: &[CaseResult]) -> OwnResults {
        let Some(request) = study.outline.read::<Request>() else { return OwnResults::default() };
        OwnResults { entries: entries::entries(study, &request, cases), ..OwnResults::default() }
    }
}
