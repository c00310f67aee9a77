//! `path_proofs.jsonl`: the states and witnesses of each line must prove the entry of their case in results.json, without a solver.
//!
//! The lines are untrusted input. A solver is replaced by the states of a line, which then pass the same checks as in a run; parts of an
//! answer that no check proves are left out. Each number of the entry that follows from the states must agree with them.

use std::io::{BufRead, BufReader, Read};
use std::sync::Arc;
use voussoir_study::cases::proved_case;
use voussoir_study::caught::caught;
use voussoir_study::checks::Agreement;
use voussoir_study::checks::{meaning, misfits};
use voussoir_study::results::sealed_line::case_in;
use voussoir_study::results::stored_path::{PATH_PROOFS, PathEntry, PathLine, StoredPath};
use voussoir_study::results::{CaseResult, OutputEntry};
use voussoir_study::study::Case;

/// Greatest length of a line.
const MAX_LINE_BYTES: u64 = 1 << 30;

/// Reads the lines of a file in order. Only the next line is in memory.
pub struct PathProofLines<'a> {
    file: Option<Box<dyn BufRead + 'a>>,
    line: usize,
    last: Option<usize>,
    next: Option<NumberedLine>,
    /// Findings about lines that belong to no case.
    pub findings: Vec<String>,
}

/// A line with its number, from 1.
pub struct NumberedLine {
    number: usize,
    line: PathLine<StoredPath>,
}

/// A case whose end the stored states prove.
pub struct ProvedCase {
    /// The proved result, completed with the unproved parts of the entry in results.json.
    pub result: CaseResult,
    /// True if the entry claims no more than the states prove.
    pub whole: bool,
}

impl ProvedCase {
    /// Returns true if the case need not be solved again. The same program on the same kind of processor would repeat every bit, so that
    /// solving again also checks the unproved parts.
    pub fn is_enough(&self, case: &Case, agreement: Agreement) -> bool {
        !asks_for_more(case) && (self.whole || agreement != Agreement::Bits)
    }
}

impl<'a> PathProofLines<'a> {
    /// The lines of a file, if there is one.
    pub fn new(file: Option<Box<dyn Read + 'a>>) -> Self {
        let file = file.map(|file| Box::new(BufReader::with_capacity(1 << 16, file)) as Box<dyn BufRead + 'a>);
        let mut lines = PathProofLines { file, line: 0, last: None, next: None, findings: Vec::new() };
        lines.next = lines.read();
        lines
    }

    /// Returns the line of a case. Cases must be requested in order of id.
    pub fn of(&mut self, id: usize) -> Option<NumberedLine> {
        while let Some(next) = self.next.take() {
            if next.line.id > id {
                self.next = Some(next);
                return None;
            }
            self.next = self.read();
            if next.line.id == id {
                return Some(next);
            }
            let why = format!("case {} has no entry in results.json", next.line.id);
            self.findings.push(next.says(&why));
        }
        None
    }

    /// Returns a case with its stored path, if it has a line. Cases must be requested in order of id.
    pub fn attached_to(&mut self, mut case: CaseResult) -> CaseResult {
        let line = self.of(case.label.id).filter(|own| own.line.case_hash == case.label.case_hash);
        case.stored_path = line.map(|own| PathEntry::Numbers(Arc::new(own.line.path)));
        case
    }

    /// Returns the findings of all lines that belong to no case.
    pub fn finish(mut self) -> Vec<String> {
        drop(self.of(usize::MAX));
        self.findings
    }

    /// Reads the next line that is complete and in order.
    fn read(&mut self) -> Option<NumberedLine> {
        loop {
            let mut text = Vec::new();
            let length = Read::take(self.file.as_mut()?, MAX_LINE_BYTES).read_until(b'\n', &mut text);
            self.line += 1;
            let why = match length {
                Ok(0) => return None,
                Ok(length) if length as u64 >= MAX_LINE_BYTES => {
                    self.file = None;
                    "it is longer than 1 GiB".to_string()
                }
                Ok(_) => match self.parsed(&text) {
                    Ok(line) => {
                        self.last = Some(line.id);
                        return Some(NumberedLine { number: self.line, line });
                    }
                    Err(why) => why,
                },
                Err(error) => {
                    self.file = None;
                    error.to_string()
                }
            };
            let case = id_in(&text).map(|id| format!(", case {id}")).unwrap_or_default();
            self.findings.push(format!("{PATH_PROOFS}, line {}{case}: {why}", self.line));
        }
    }

    fn parsed(&self, text: &[u8]) -> Result<PathLine<StoredPath>, String> {
        let line = case_in(text).ok_or("the checksum is wrong")?;
        let line: PathLine<StoredPath> = serde_json::from_slice(&text[line]).map_err(|error| error.to_string())?;
        match self.last.is_some_and(|last| line.id <= last) {
            true => Err("it is there twice, or after the line of a later case".into()),
            false => Ok(line),
        }
    }
}

/// The id of the case in a damaged line, if it can be read.
fn id_in(text: &[u8]) -> Option<usize> {
    let text = String::from_utf8_lossy(&text[..text.len().min(200)]);
    let digits = text.split_once("\"id\":")?.1;
    digits.split(|c: char| !c.is_ascii_digit()).next()?.parse().ok()
}

impl NumberedLine {
    /// Formats a finding about this line.
    fn says(&self, why: &str) -> String {
        format!("{PATH_PROOFS}, line {}: {why}", self.number)
    }

    /// Checks the line against the entry of its case.
    ///
    /// # Errors
    /// The first reason why it does not prove the entry, with file and line.
    pub fn check(&self, case: &Case, result: &CaseResult) -> Result<ProvedCase, String> {
        let checked = || {
            if self.line.case_hash != result.label.case_hash {
                return Err("another case has this case_hash".into());
            }
            check_stored_path(case, result, &self.line.path)
        };
        caught(checked).and_then(|checked| checked).map_err(|why| self.says(&why))
    }
}

/// Returns true if a case requests numbers that only solving again can give.
fn asks_for_more(case: &Case) -> bool {
    !case.output_sensitivities.is_empty() || case.output_accuracy
}

/// Checks that a stored path proves the result of its case.
///
/// # Errors
/// The first reason why it does not.
pub fn check_stored_path(case: &Case, result: &CaseResult, path: &StoredPath) -> Result<ProvedCase, String> {
    if !misfits(case, result).is_empty() {
        return Err("the entry in results.json does not fit the scene".into());
    }
    let mut again = proved_case(case, &result.solver, path)?;
    let value = |result: &CaseResult| serde_json::to_value(result).map_err(|error| error.to_string());
    again.notes.clone_from(&result.notes);
    let proved = value(&again)?;
    take_unproved(&mut again, result, case.solver.settings.finite);
    if asks_for_more(case) {
        again.load_factor_error.clone_from(&result.load_factor_error);
        again.sensitivities.clone_from(&result.sensitivities);
    }
    let (all, stored) = (value(&again)?, value(result)?);
    match meaning::differences(&stored, &all).first() {
        Some(why) => Err(why.replace("solving the case again gives", "the states give")),
        None => Ok(ProvedCase { result: again, whole: meaning::differences(&all, &proved).is_empty() }),
    }
}

/// Copies the parts of a stored result that no states prove: events, branches, outputs of the solver, stability, the uniqueness of a
/// mechanism, and the rate at a limit point of finite displacements.
fn take_unproved(again: &mut CaseResult, stored: &CaseResult, finite: bool) {
    again.counters.clone_from(&stored.counters);
    let of_solver = |entry: &OutputEntry| !entry.is_of_law();
    let unproved = stored.outputs.iter().filter(|own| of_solver(own)).cloned();
    let proved = again.outputs.iter().filter(|own| !of_solver(own)).cloned();
    again.outputs = unproved.chain(proved).collect();
    again.path.events.clone_from(&stored.path.events);
    again.path.branches.clone_from(&stored.path.branches);
    for (own, stored) in again.path.limit_points.iter_mut().zip(&stored.path.limit_points) {
        own.next_state.clone_from(&stored.next_state);
    }
    for (own, stored) in again.stages.iter_mut().zip(&stored.stages) {
        own.stability.clone_from(&stored.stability);
    }
    if finite {
        again.proof.motion.clone_from(&stored.proof.motion);
        again.mechanism.clone_from(&stored.mechanism);
        if let (Some(own), Some(stored)) = (again.stages.last_mut(), stored.stages.last()) {
            own.hinges.clone_from(&stored.hinges);
        }
    } else if let (Some(own), Some(stored)) = (&mut again.mechanism, &stored.mechanism) {
        own.unique = stored.unique;
    }
}
