//! `path_proofs.jsonl`: one line for each path with a proved end, with its states and witnesses.

use super::writer::CaseTable;
use std::io::{self, Write};
use voussoir_study::results::CaseResult;
use voussoir_study::results::sealed_line::sealed_text;
use voussoir_study::results::stored_path::{PATH_PROOFS, PathLine};

/// Writes the file, whichever writers a study lists.
#[derive(Debug)]
pub struct PathProofs;

impl CaseTable for PathProofs {
    fn name(&self) -> String {
        PATH_PROOFS.into()
    }

    fn begin(&mut self, _: &mut dyn Write) -> io::Result<()> {
        Ok(())
    }

    fn add(&mut self, case: &CaseResult, out: &mut dyn Write) -> io::Result<()> {
        let Some(path) = &case.stored_path else { return Ok(()) };
        let line = PathLine { id: case.label.id, case_hash: case.label.case_hash.clone(), path };
        out.write_all(&sealed_text(&serde_json::to_vec(&line)?))
    }
}
