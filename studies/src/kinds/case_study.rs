//! Studies with a scene as commands see them: their cases are solved as their kind says, certified, and written by
//! all writers.

use super::backing::{BackingCount, resumed};
use super::kind::{CasesOf, LoadedStudy, Piece, RESULTS, RunOutput, RunRequest, StoredResults, Verification, kind};
use super::stored_cases::read_cases;
use crate::caught::caught;
use crate::figures::envelope::envelope_chart;
use crate::figures::format::{format_number, snap_words};
use crate::figures::sweep::study_chart;
use crate::figures::{curve_svg, mechanism_svg, scene_svg};
use crate::results::case_with_path::read_case;
use crate::results::stored_path::PATH_PROOFS;
use crate::results::{CaseLabel, CaseResult, Origin, StudyResults, words};
use crate::side_by_side::{in_order, side_by_side};
use crate::solve::Observer;
use crate::solve::explain::explain;
use crate::study::{Case, Study, SweptKeys, as_blocks};
use crate::verify::path_proofs::{PathProofLines, check_path_proofs};
use crate::verify::repeat::differences;
use crate::verify::{Agreement, StoredCheck, misfits, solve_others_again};
use crate::writers::comparison::comparison_table;
use crate::writers::record::record;
use crate::writers::results_json::write_results;
use crate::writers::table::results_table;
use crate::writers::{StudyOutput, written};
use serde_json::{Map, Value as Json};
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::io::BufReader;
use voussoir_core::limit::Status;

impl Study {
    /// The case that a result belongs to, as the study's kind finds it.
    pub fn case_of(&self, label: &CaseLabel) -> Option<Cow<'_, Case>> {
        kind(&self.kind)?.case(self, label)
    }

    /// Results of the study from those of its cases.
    pub fn results(&self, version: &str, cases: Vec<CaseResult>) -> StudyResults {
        let own = kind(&self.kind).map(|kind| kind.own_results(self, &cases)).unwrap_or_default();
        let (study, version) = (self.name.clone(), version.to_string());
        let ids: Vec<usize> = cases.iter().map(|case| case.label.id).filter(|id| *id < self.cases.len()).collect();
        let only_cases = (ids.len() < self.cases.len()).then_some(ids);
        let origin = Origin::here(&words(&self.resolved));
        let (comparison, own) = (own.comparison, own.other);
        StudyResults { study, version, origin, date: None, only_cases, files: Vec::new(), cases, comparison, own }
    }

    /// What a run with these results, in order of id, writes and says.
    pub fn output_of(&self, request: &RunRequest, cases: Vec<CaseResult>) -> RunOutput {
        let mut results = StudyResults { date: request.date.clone(), ..self.results(&request.version, cases) };
        let cases: Vec<_> = results.cases.iter().filter_map(|case| self.case_of(&case.label)).collect();
        let output = StudyOutput::new(self, &results, &cases);
        let mut files = side_by_side(request.jobs, || written(&output));
        drop(output);
        results.files = names(&files);
        if !request.results_apart {
            let text = write_results(Vec::new(), &results).expect("results hold no map with other keys than text");
            files.push((RESULTS.into(), text));
        }
        let output = StudyOutput::new(self, &results, &cases);
        let table = if request.quiet { String::new() } else { table(&output) };
        let certified = results.certified();
        let results = request.results_apart.then_some(results);
        RunOutput { files, results, table, remarks: Vec::new(), certified }
    }

    /// The files that results give, by name.
    fn made(&self, results: &StudyResults, jobs: usize) -> Vec<(String, Vec<u8>)> {
        let cases: Vec<_> = results.cases.iter().filter_map(|case| self.case_of(&case.label)).collect();
        side_by_side(jobs, || written(&StudyOutput::new(self, results, &cases)))
    }

    /// Stored cases by id, the last of each, that `kept` wants and that hold by their own proof; and a remark about them.
    fn own_cases(
        &self,
        [results, proofs, journal]: &[String; 3],
        kept: impl Fn(&CaseResult) -> bool,
        jobs: usize,
    ) -> (BTreeMap<usize, CaseResult>, Vec<String>) {
        let whole = serde_json::from_str::<StudyResults>(results).map(|results| results.cases).unwrap_or_default();
        let mut paths = PathProofLines::new(Some(Box::new(proofs.as_bytes())));
        let whole = whole.into_iter().map(|case| paths.attached_to(case));
        // The last line of a killed run may be cut short: it does not parse and is done again.
        let lines = journal.lines().filter_map(|line| read_case(line.as_bytes()).ok());
        let own: BTreeMap<usize, CaseResult> =
            whole.chain(lines).filter(kept).map(|case| (case.label.id, case)).collect();
        let own: Vec<CaseResult> = own.into_values().collect();
        let backings = side_by_side(jobs, || in_order(&own, |case| CasesOf::Held(self).backing(case)));
        let mut count = BackingCount::default();
        backings.iter().flatten().for_each(|backing| count.add(*backing));
        let refused = backings.iter().filter(|backing| backing.is_err()).count();
        let remarks = resumed(own.len() - refused, count, refused);
        let holds = own.into_iter().zip(backings).filter(|(_, backing)| backing.is_ok());
        (holds.map(|(case, _)| (case.label.id, case)).collect(), remarks)
    }
}

impl LoadedStudy for Study {
    fn name(&self) -> &str {
        &self.name
    }

    fn count(&self) -> usize {
        self.cases.len()
    }

    fn resolved(&self) -> &toml::Value {
        &self.resolved
    }

    fn notes(&self) -> Vec<String> {
        let mut seen = std::collections::BTreeSet::new();
        let notes = self.cases.iter().flat_map(|case| &case.notes);
        notes.filter(|note| seen.insert(note.as_str())).cloned().collect()
    }

    fn explain(&self) -> String {
        explain(self)
    }

    fn cases(&self) -> Option<CasesOf<'_>> {
        Some(CasesOf::Held(self))
    }

    fn piece(&self, results: &str, piece: Piece) -> Option<String> {
        if piece == Piece::Record {
            return Some(record(self));
        }
        let results: StudyResults = serde_json::from_str(results).ok()?;
        let cases: Vec<_> = results.cases.iter().filter_map(|case| self.case_of(&case.label)).collect();
        let fits = |(case, result): (&Cow<Case>, &CaseResult)| misfits(case, result).is_empty();
        if cases.len() != results.cases.len() || !cases.iter().zip(&results.cases).all(fits) {
            return None;
        }
        let output = StudyOutput::new(self, &results, &cases);
        let of_case = |id: usize| {
            let place = results.cases.iter().position(|case| case.label.id == id)?;
            let (assembly, stages) = output.scene(place)?;
            Some((&results.cases[place], assembly, stages))
        };
        match piece {
            Piece::Record => None,
            Piece::Chart => study_chart(&output).or_else(|| envelope_chart(&output)),
            Piece::Scene(id) => {
                of_case(id).map(|(case, assembly, stages)| scene_svg(&output.case_title(case), assembly, stages, case))
            }
            Piece::Mechanism(id) => {
                of_case(id).and_then(|(case, assembly, _)| mechanism_svg(&output.case_title(case), assembly, case))
            }
            Piece::Curve(id) => of_case(id)
                .and_then(|(case, assembly, stages)| curve_svg(&output.case_title(case), assembly, stages, case)),
        }
    }

    fn as_blocks(&self) -> Result<String, String> {
        as_blocks(self.cases.first().ok_or("the study has no case")?, &self.name)
    }

    fn run(&self, request: &RunRequest, observer: &dyn Observer) -> RunOutput {
        let is_wanted = |id: &usize| request.wanted.binary_search(id).is_ok();
        // A finished case does not tell which cases its kind has made from it.
        let resume = request.resume && !kind(&self.kind).is_some_and(|kind| kind.makes_cases());
        let kept = |case: &CaseResult| match is_wanted(&case.label.id) {
            true => resume && case.status != Status::Stalled,
            false => request.keep,
        };
        let stored = request.stored.as_ref().map(|stored| self.own_cases(stored, kept, request.jobs));
        let (mut done, mut told) = stored.unwrap_or_default();
        let others = done.keys().filter(|id| !is_wanted(id)).count();
        let rest: Vec<usize> = request.wanted.iter().copied().filter(|id| !done.contains_key(id)).collect();
        observer.begins(rest.len());
        if let Some(kind) = kind(&self.kind) {
            let solved = kind.solve(self, &rest, request.jobs, observer);
            done.extend(solved.into_iter().map(|case| (case.label.id, case)));
        }
        observer.phase("writing and drawing");
        let output = self.output_of(request, done.into_values().collect());
        let certified = output.certified && !observer.cancelled();
        told.extend(remarks(request, others, self.count()));
        RunOutput { remarks: told, certified, ..output }
    }

    fn verify_stored(&self, stored: &StoredResults, observer: &dyn Observer) -> Result<Verification, String> {
        let file = BufReader::with_capacity(1 << 16, stored.results()?);
        let results: StudyResults = serde_json::from_reader(file).map_err(|error| error.to_string())?;
        let agreement = Agreement::of(&results.origin, &self.resolved);
        let paths = check_path_proofs(self, &results, (stored.file)(PATH_PROOFS), agreement, stored.jobs);
        let proved: BTreeSet<usize> = paths.again.iter().map(|case| case.label.id).collect();
        let again = solve_others_again(self, &results, paths.again, stored.jobs, observer);
        if observer.cancelled() {
            return Err("the check was cancelled".into());
        }
        // Read once more, entry by entry: as a tree of values all of them take more space than everything else here.
        let mut check = StoredCheck::with_proved(self, &results, &again, proved.clone());
        let beside = read_cases(stored.results()?, &mut |_, entry| check.entry(&entry))?;
        let mut findings = check.findings()?;
        findings.extend(paths.findings);
        // Keys that no one reads.
        let read = serde_json::to_value(&results.comparison).unwrap_or_default();
        let foreign = beside.get("comparison").map(|stored| differences(stored, &read)).unwrap_or_default();
        findings.extend(foreign.into_iter().map(|why| (0, format!("comparison: {why}"))));
        let (format, mut listed) = (results.origin.format, results.files.clone());
        let (count, stalled) = (results.cases.len(), stalled(&results));
        let own = results.cases.iter().filter(|case| case.label.id < self.count()).count();
        // Stored results are drawn only if they are confirmed: then each number was solved again.
        let drawn = match findings.is_empty() {
            true => results,
            false => {
                let again = with_costs(again, &results);
                StudyResults { date: results.date, ..self.results(&results.version, again) }
            }
        };
        let (mut made, unmade) = match caught(|| self.made(&drawn, stored.jobs)) {
            Ok(made) => (made, None),
            Err(why) => (Vec::new(), Some(format!("tables and figures cannot be made: {why}"))),
        };
        // Its lines are checked above, not made from results.json.
        made.retain(|(name, _)| name != PATH_PROOFS);
        let mut files = stored.altered(made.iter().map(|(name, bytes)| (name.as_str(), bytes.as_slice())), agreement);
        files.extend(unmade);
        files.extend(paths.lines);
        let lists_paths =
            listed.iter().position(|name| name == PATH_PROOFS).map(|place| listed.remove(place)).is_some();
        if format > 0 && !made.is_empty() && listed != names(&made) {
            files.push(format!("the list of files in {RESULTS} does not match the study"));
        }
        Ok(Verification {
            cases: count,
            stalled,
            findings,
            files,
            made: made
                .into_iter()
                .map(|(name, _)| name)
                .chain([RESULTS.into()])
                .chain(lists_paths.then(|| PATH_PROOFS.into()))
                .collect(),
            paths: [paths.proved, proved.len()],
            own,
            of: self.count(),
            agreement,
            how: HOW,
        })
    }
}

/// Cases with the stored seconds and counters, which are not compared and appear in tables.
fn with_costs(mut cases: Vec<CaseResult>, stored: &StudyResults) -> Vec<CaseResult> {
    let costs: BTreeMap<usize, &CaseResult> = stored.cases.iter().map(|case| (case.label.id, case)).collect();
    for case in &mut cases {
        if let Some(stored) = costs.get(&case.label.id) {
            (case.seconds, case.counters) = (stored.seconds, stored.counters.clone());
        }
    }
    cases
}

/// Number of stalled cases.
fn stalled(results: &StudyResults) -> usize {
    results.cases.iter().filter(|case| case.status == Status::Stalled).count()
}

/// The names of files, sorted.
fn names(files: &[(String, Vec<u8>)]) -> Vec<String> {
    let mut names: Vec<String> = files.iter().map(|(name, _)| name.clone()).collect();
    names.sort();
    names
}

/// The table on the terminal, with what the study's kind adds to it.
fn table(output: &StudyOutput) -> String {
    let mut table = results_table(output);
    if let Some(comparison) = &output.results.comparison {
        table += "\n";
        table += &comparison_table(comparison, &output.keys);
    }
    table + &found(&output.results.own, &output.keys)
}

/// What a kind that searches has found, a line each.
fn found(own: &Map<String, Json>, keys: &SweptKeys) -> String {
    let entries = |name: &str| own.get(name).and_then(Json::as_array).into_iter().flatten();
    let line = |entry: &Json| {
        let words =
            ["variant", "vehicle", "direction"].iter().filter_map(|key| Some(format!(", {}", entry[key].as_str()?)));
        let number = |key: &str| entry[key].as_f64().map_or("-".to_string(), |x| format_number(x, 6));
        let snaps = snap_words(entry["result"].as_f64(), entry["first_limit_point"].as_f64(), |x| format_number(x, 6));
        let status = entry["status"].as_str().unwrap_or_default();
        let (key, case) = (entry["parameter"].as_str().unwrap_or_default(), &entry["case"]);
        format!(
            "\nworst: {} ({status}) at {key} = {}{}{} (case {case})\n",
            snaps.unwrap_or_else(|| number("result")),
            number("value"),
            keys.unit(key).map_or(String::new(), |unit| format!(" {unit}")),
            words.collect::<String>()
        )
    };
    entries("worsts").map(line).collect()
}

/// What `verify` has done with each case.
pub(super) const HOW: &str = "checked: what the stored forces and motions prove, from the scene and without a solver (nothing where [output] fields = false has left them out); then every number \
and word against solving the case again, unless the states in path_proofs.jsonl prove its path; tables and figures against results.json. \
Not checked: counters, seconds, version";

/// What a run of one case says of the others.
pub(super) fn remarks(request: &RunRequest, others: usize, of: usize) -> Vec<String> {
    match request.wanted.as_slice() {
        [id] if request.keep && of > 1 => {
            let words =
                if others == 0 { "no other case is there".into() } else { format!("{others} other(s) are kept") };
            vec![format!("case {id} of {of} was solved; of the study as it stands {words}")]
        }
        _ => Vec::new(),
    }
}
