//! Studies with a scene, as commands and programs use them: their kind decides how cases are solved; results are certified and
//! passed to all writers.

use super::outputs::write_files;
use super::verify_study::verify_study;
use crate::figures::envelope::{envelope_chart, optimum_chart};
use crate::figures::seismic::capacity_charts;
use crate::figures::sweep::study_chart;
use crate::figures::{curve_svg, mechanism_of_case, scene_of_case};
use crate::output::StudyOutput;
use crate::writers::files::HeldFiles;
use crate::writers::record::record;
use std::borrow::Cow;
use voussoir_study::cases::Observer;
use voussoir_study::checks::misfits;
use voussoir_study::kind::StoredResults;
use voussoir_study::kind::{LoadedStudy, Piece, RunOutput, RunRequest, Verification};
use voussoir_study::results::{CaseResult, StudyResults, Totals};
use voussoir_study::solve::explain::explain;
use voussoir_study::study::{Case, Study, StudyError, StudySource, as_blocks};

/// A study with a scene.
pub struct SceneStudy(pub Study);

impl SceneStudy {
    /// Reads a study. Its cases are kept in memory if there are few, otherwise they are made when they are needed.
    pub fn read(source: StudySource) -> Result<Box<dyn LoadedStudy>, StudyError> {
        Ok(Box::new(SceneStudy(Study::from_source_in_turn(source)?)))
    }
}

impl LoadedStudy for SceneStudy {
    fn name(&self) -> &str {
        &self.0.name
    }

    fn count(&self) -> usize {
        self.0.count()
    }

    fn resolved(&self) -> &toml::Value {
        &self.0.resolved
    }

    fn notes(&self) -> Vec<String> {
        self.0.notes.clone()
    }

    fn explain(&self) -> String {
        explain(&self.0)
    }

    fn with_cases(&self) -> Option<&Study> {
        Some(&self.0)
    }

    fn piece(&self, results: &str, piece: Piece) -> Option<String> {
        if piece == Piece::Record {
            return Some(record(&self.0).into_string());
        }
        let results: StudyResults = serde_json::from_str(results).ok()?;
        let cases: Vec<_> = results.cases.iter().filter_map(|case| self.0.case_of(&case.label)).collect();
        let fits = |(case, result): (&Cow<Case>, &CaseResult)| misfits(case, result).is_empty();
        if cases.len() != results.cases.len() || !cases.iter().zip(&results.cases).all(fits) {
            return None;
        }
        let totals = Totals::of(&results.cases);
        let output = StudyOutput::new(&self.0, &results, &totals, &cases);
        let place_of = |id: usize| results.cases.iter().position(|case| case.label.id == id);
        let of_case = |id: usize| {
            let place = place_of(id)?;
            let (assembly, stages) = output.scene(place)?;
            Some((&results.cases[place], assembly, stages))
        };
        match piece {
            Piece::Record => None,
            Piece::Chart => study_chart(&output)
                .or_else(|| envelope_chart(&output))
                .or_else(|| optimum_chart(&output))
                .or_else(|| capacity_charts(&output).into_iter().next().map(|(_, svg)| svg)),
            Piece::Scene(id) => scene_of_case(&output, place_of(id)?),
            Piece::Mechanism(id) => mechanism_of_case(&output, place_of(id)?),
            Piece::Curve(id) => of_case(id)
                .and_then(|(case, assembly, stages)| curve_svg(&output.case_title(case), assembly, stages, case)),
        }
    }

    fn as_blocks(&self) -> Result<String, String> {
        as_blocks(&*self.0.case(0).ok_or("the study has no case")?, &self.0.name)
    }

    fn run(&self, request: &RunRequest, observer: &dyn Observer) -> RunOutput {
        let mut cases = Vec::new();
        self.0.solve(&request.wanted, request.jobs, observer, &mut |case| cases.push(case));
        cases.sort_by_key(|case| case.label.id);
        observer.phase("writing and drawing");
        let files = HeldFiles::default();
        match write_files(&self.0, request, cases.as_slice(), &files, &mut |_| Ok(())) {
            Ok(made) => RunOutput {
                files: results_last(files.into_files()),
                table: made.table,
                remarks: Vec::new(),
                certified: made.totals.certified == made.totals.cases && !observer.cancelled(),
            },
            Err(why) => RunOutput { remarks: vec![why.to_string()], ..RunOutput::default() },
        }
    }

    fn verify_stored(&self, stored: &StoredResults, observer: &dyn Observer) -> Result<Verification, String> {
        verify_study(&self.0, stored, observer)
    }
}

/// Returns the same files, with results.json last, after the files that it names.
fn results_last(mut files: Vec<(String, Vec<u8>)>) -> Vec<(String, Vec<u8>)> {
    files.sort_by_key(|(name, _)| name == "results.json");
    files
}

/// Returns the remark of a run of one case about the other cases in the folder.
pub fn one_case(id: usize, of: usize, others: usize) -> String {
    let words = if others == 0 { "no other case is there".into() } else { format!("{others} other(s) are kept") };
    format!("case {id} of {of} was solved; of the study as it stands {words}")
}
