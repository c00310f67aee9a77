//! `optimise`: the best value of a key.
#![doc = include_str!("optimise.md")]

mod optima;
mod request;
mod search;

use self::request::{Request, STRIDE};
use super::case_study::SceneStudy;
use super::search::{case_at, range_mistakes};
use std::borrow::Cow;
use voussoir_core::plugin::{Card, Diagnostic, PluginKind, Sample};
use voussoir_study::cases::{Observer, solve_cases, solve_unless_cancelled};
use voussoir_study::kind::{KindEntry, LoadedStudy, OwnResults, StudyKind};
use voussoir_study::results::{CaseLabel, CaseResult};
use voussoir_study::side_by_side::side_by_side;
use voussoir_study::study::{Case, Outline, Study, StudyError, StudySource};

struct Optimise;

voussoir_core::inventory::submit! { KindEntry { tag: "optimise", kind: &Optimise } }

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::StudyKind,
        tag: "optimise",
        summary: "the value of a key at which a result is greatest or least, for each variant and sweep point",
        sources: &["Kiefer 1953, Proc. Amer. Math. Soc. 4, 502-506"],
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
            // Checking both ends finds a key that does not exist or that does not accept numbers.
            let at = |value: f64| study.at(0, &request.values(value));
            let middle = 0.5 * (request.range()[0] + request.range()[1]);
            if let (Err(wrong), Err(_), Err(_)) = (at(request.range()[0]), at(request.range()[1]), at(middle)) {
                return Err(wrong);
            }
        }
        Ok(Box::new(SceneStudy(study)))
    }

    fn check(&self, outline: &Outline) -> Vec<Diagnostic> {
        let Some(request) = outline.read::<Request>() else { return Vec::new() };
        if request.parameter.is_some() == request.parameters.is_some() {
            let help =
                "[optimise] parameter = \"scene.springing\", from, to; several keys in lockstep: parameters = [...]";
            return vec![Diagnostic::new("optimise", "needs parameter, or parameters, and not both").help(help)];
        }
        range_mistakes("optimise", request.range(), &request.keys(), outline)
    }

    fn solve(&self, study: &Study, wanted: &[usize], jobs: usize, observer: &dyn Observer) -> Vec<CaseResult> {
        let mut results = solve_cases(study, wanted, jobs, observer);
        let Some(request) = study.outline.read::<Request>() else { return results };
        let all = || {
            let of = |&base: &usize| {
                let first = study.count() + base * STRIDE;
                let solve = |index: usize, value: f64| {
                    let case = case_at(study, base, first + index, &request.values(value))?;
                    let result = solve_unless_cancelled(&case, observer)?;
                    Some((request.merit(&case, &result), result))
                };
                search::best_value(&request, &solve)
            };
            wanted.iter().flat_map(of).collect::<Vec<_>>()
        };
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
        let base = (label.id - study.cases.len()) / STRIDE;
        let value = label.parameters.get(request.keys().first()?)?.as_f64()?;
        case_at(study, base, label.id, &request.values(value)).map(Cow::Owned)
    }

    fn own_results(&self, study: &Study, cases: &[CaseResult]) -> OwnResults {
        let Some(request) = study.outline.read::<Request>() else { return OwnResults::default() };
        OwnResults { entries: optima::entries(study, &request, cases), ..OwnResults::default() }
    }
}
