//! `envelope`: the most onerous position of a moving load.
#![doc = include_str!("envelope.md")]

mod places;
mod request;
mod search;
mod worsts;

use self::request::{Request, Run};
use super::case_study::SceneStudy;
use super::search::{case_at, range_mistakes};
use std::borrow::Cow;
use voussoir_core::plugin::{Card, Diagnostic, PluginKind, Sample};
use voussoir_study::cases::{Observer, solve_cases, solve_unless_cancelled};
use voussoir_study::kind::{KindEntry, LoadedStudy, OwnResults, StudyKind};
use voussoir_study::results::{CaseLabel, CaseResult};
use voussoir_study::side_by_side::side_by_side;
use voussoir_study::study::{Case, Outline, Study, StudyError, StudySource};

/// The ids of the cases of one run of one vehicle start at a multiple of this number, after the ids of the study.
const STRIDE: usize = 1_000_000;

struct Envelope;

voussoir_core::inventory::submit! { KindEntry { tag: "envelope", kind: &Envelope } }

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::StudyKind,
        tag: "envelope",
        summary: "moves a load over a range, in both directions and for several vehicles: the worst position, and the factor at each position",
        samples: &[Sample::keys(r#"[envelope]
parameter = "stages.1.loads.0.span_fraction"
from = 0.1
to = 0.5
scan = 5
tolerance = 0.01"#)],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("envelope.md"),
        ..Card::of::<Request>()
    }
}

impl Envelope {
    /// Returns the results at all positions of all runs of one case of the study, in order of id.
    fn of_case(&self, study: &Study, base: usize, request: &Request, observer: &dyn Observer) -> Vec<CaseResult> {
        let Some(case) = study.case(base) else { return Vec::new() };
        let case = case.as_ref();
        let runs = request.runs(case);
        let run = |(number, run): (usize, &Run)| {
            let first = study.count() + (base * runs.len() + number) * STRIDE;
            let solve = |index: usize, value: f64| {
                let case = case_at(study, base, first + index, &request.values(run, value))?;
                solve_unless_cancelled(&case, observer)
            };
            let places = places::places(case, request, run);
            search::worst_place(&places, request, &solve)
        };
        runs.iter().enumerate().flat_map(run).collect()
    }
}

impl StudyKind for Envelope {
    fn read(&self, source: StudySource) -> Result<Box<dyn LoadedStudy>, StudyError> {
        let study = Study::from_source_in_turn(source)?;
        let Some(request) = study.outline.read::<Request>() else { return Ok(Box::new(SceneStudy(study))) };
        // Checking both ends of the range finds mistakes before anything is solved.
        for case in (0..study.count()).filter_map(|id| study.case(id)) {
            for run in request.runs(&case) {
                for value in request.range() {
                    study.at(case.id, &request.values(&run, value))?;
                }
            }
        }
        Ok(Box::new(SceneStudy(study)))
    }

    fn check(&self, outline: &Outline) -> Vec<Diagnostic> {
        let Some(request) = outline.read::<Request>() else {
            return vec![
                Diagnostic::new("envelope", "is missing").help("say what moves: [envelope] parameter, from, to"),
            ];
        };
        range_mistakes(["envelope", "envelope.parameter"], request.range(), &request.keys(), outline)
    }

    fn solve(&self, study: &Study, wanted: &[usize], jobs: usize, observer: &dyn Observer) -> Vec<CaseResult> {
        let mut results = solve_cases(study, wanted, jobs, observer);
        let Some(request) = study.outline.read::<Request>() else { return results };
        let all = || wanted.iter().flat_map(|base| self.of_case(study, *base, &request, observer)).collect::<Vec<_>>();
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
        // Every case has as many runs as the first, because kinds of loads are not swept.
        let runs = request.runs(&*study.case(0)?).len();
        let base = (label.id - study.count()) / STRIDE / runs;
        let keys = request.keys().into_iter();
        let given = keys.filter_map(|key| label.parameters.get(&key).cloned().map(|value| (key, value)));
        case_at(study, base, label.id, &given.collect::<Vec<_>>()).map(Cow::Owned)
    }

    fn own_results(&self, study: &Study, cases: &[CaseResult]) -> OwnResults {
        let Some(request) = study.outline.read::<Request>() else { return OwnResults::default() };
        OwnResults { entries: worsts::entries(study, &request, cases), ..OwnResults::default() }
    }
}
