//! `optimise`: the best value of a key.
#![doc = include_str!("optimise.md")]

mod optima;
mod request;
mod search;
mod several;
mod shape;
mod trials;

use self::request::{Axis, Request};
use self::several::Several;
use self::shape::Level;
use super::case_study::SceneStudy;
use super::search::case_at;
use std::borrow::Cow;
use voussoir_core::plugin::{Card, Diagnostic, PluginKind, Sample};
use voussoir_study::cases::{Observer, solve_cases, solve_unless_cancelled};
use voussoir_study::config::diagnostic::LocatedDiagnostic;
use voussoir_study::kind::{KindEntry, LoadedStudy, OwnResults, StudyKind};
use voussoir_study::results::{CaseLabel, CaseResult};
use voussoir_study::side_by_side::side_by_side;
use voussoir_study::solve::sensitivity::derivatives;
use voussoir_study::study::{Case, Outline, Study, StudyError, StudySource};

struct Optimise;

voussoir_core::inventory::submit! { KindEntry { tag: "optimise", kind: &Optimise } }

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::StudyKind,
        tag: "optimise",
        summary: "the value of a key at which a result is greatest or least, for each variant and sweep point",
        sources: &["Kelley 1960, J. Soc. Indust. Appl. Math. 8, 703-712", "Halton 1960, Numer. Math. 2, 84-90"],
        samples: &[Sample::keys(r#"[optimise]
parameter = "scene.thickness"
from = 0.3
to = 0.5
scan = 4
tolerance = 0.05"#)],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("optimise.md"),
        ..Card::of::<Request>()
    }
}

impl StudyKind for Optimise {
    fn read(&self, source: StudySource) -> Result<Box<dyn LoadedStudy>, StudyError> {
        let study = Study::from_source_in_turn(source)?;
        if let Some(request) = study.outline.read::<Request>() {
            // Checking ends and middle finds keys that do not exist or that do not accept numbers.
            let axes = request.axes();
            let at = |share: f64| study.at(0, &Request::values(&axes, &shape::point(&axes, &vec![share; axes.len()])));
            if let (Err(wrong), Err(_), Err(_)) = (at(0.0), at(1.0), at(0.5)) {
                return Err(wrong);
            }
            if let Some(wanted) = request.volume
                && !several::reaches(&request, &Level { wanted, study: &study, base: 0, axes: &axes })
            {
                let origin = study.root(0)?.place("optimise.volume");
                let message = format!("no point in the ranges has the volume {wanted} m³");
                return Err(vec![LocatedDiagnostic::new(&origin, "optimise.volume", message)].into());
            }
        }
        Ok(Box::new(SceneStudy(study)))
    }

    fn check(&self, outline: &Outline) -> Vec<Diagnostic> {
        outline.read::<Request>().map(|request| request.mistakes(outline)).unwrap_or_default()
    }

    fn solve(&self, study: &Study, wanted: &[usize], jobs: usize, observer: &dyn Observer) -> Vec<CaseResult> {
        let mut results = solve_cases(study, wanted, jobs, observer);
        let Some(request) = study.outline.read::<Request>() else { return results };
        let axes = request.axes();
        let search = |base: &usize| searched(study, *base, &request, &axes, observer);
        let all = || wanted.iter().flat_map(search).collect::<Vec<_>>();
        results.extend(side_by_side(jobs, all));
        results
    }

    fn makes_cases(&self) -> bool {
        true
    }

    fn case<'a>(&self, study: &'a Study, label: &CaseLabel) -> Option<Cow<'a, Case>> {
        if label.id < study.count() {
            return study.case(label.id);
        }
        let request = study.outline.read::<Request>()?;
        let base = (label.id - study.count()) / request.stride();
        let axes = request.axes();
        let value = |axis: &Axis| label.parameters.get(axis.keys.first()?)?.as_f64();
        let point: Vec<f64> = axes.iter().map(value).collect::<Option<_>>()?;
        case_at(study, base, label.id, &Request::values(&axes, &point)).map(Cow::Owned)
    }

    fn own_results(&self, study: &Study, cases: &[CaseResult]) -> OwnResults {
        let Some(request) = study.outline.read::<Request>() else { return OwnResults::default() };
        OwnResults { entries: optima::entries(study, &request, cases), ..OwnResults::default() }
    }
}

/// Returns the results of all trials for a case of the study, in order of id.
fn searched(study: &Study, base: usize, request: &Request, axes: &[Axis], observer: &dyn Observer) -> Vec<CaseResult> {
    let first = study.count() + base * request.stride();
    let solve = |index: usize, point: &[f64]| {
        let case = case_at(study, base, first + index, &Request::values(axes, point))?;
        let result = solve_unless_cancelled(&case, observer)?;
        Some((request.merit(&case, &result), result))
    };
    if let [axis] = axes {
        return search::best_value(request, axis, &solve);
    }
    let derivatives = |point: &[f64], result: &CaseResult| {
        let case = case_at(study, base, result.label.id, &Request::values(axes, point))?;
        request.result_of(&case, result).filter(|own| Some(*own) == result.load_factor)?;
        let keys: Vec<&str> = axes.iter().flat_map(|axis| &axis.keys).map(String::as_str).collect();
        derivatives(&case, result, &keys)
    };
    let level = request.volume.map(|wanted| Level { wanted, study, base, axes });
    Several { request, axes, solve: &solve, derivatives: &derivatives, level }.best_point()
}
