//! `path_proofs.jsonl`: for each path whose end is proved a line with its states and witnesses.

use crate::results::sealed_line::sealed_text;
use crate::results::stored_path::{PATH_PROOFS, PathLine};
use crate::results::{CaseResult, StudyResults};
use std::io::{self, Write};

/// Writes the line of a case, if it has a stored path.
pub fn write_path_proof(out: &mut impl Write, case: &CaseResult) -> io::Result<()> {
    let Some(path) = case.stored_path.as_deref() else { return Ok(()) };
    let line = PathLine { id: case.label.id, case_hash: case.label.case_hash.clone(), path };
    out.write_all(&sealed_text(&serde_json::to_vec(&line)?))
}

/// The file; none if no case has a stored path.
pub(super) fn path_proofs(results: &StudyResults) -> Option<(String, Vec<u8>)> {
    let mut text = Vec::new();
    results
        .cases
        .iter()
        .for_each(|case| write_path_proof(&mut text, case).expect("a path has no map with other keys than text"));
    (!text.is_empty()).then(|| (PATH_PROOFS.into(), text))
}
