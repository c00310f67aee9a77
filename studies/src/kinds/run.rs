//! `run`: every case of the study is solved on its own.

use super::kind::{KindEntry, LoadedStudy, StudyKind};
use crate::study::{StudyError, StudyFile, StudySource};
use voussoir_core::plugin::{Card, PluginKind};

/// Studies of more cases are streamed: each case is made, solved, written and forgotten.
pub const HELD: usize = 5000;

struct Run;

voussoir_core::inventory::submit! { KindEntry { tag: "run", kind: &Run } }

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::StudyKind,
        tag: "run",
        summary: "answers every case of the study (variants × sweep) on its own",
        file: file!(),
        package: voussoir_core::package!(),
        page: "# `run`\n\nAnswers every case, variants outermost, then the axes of the sweep. One row of the table and one entry of results.json a case. More than 5000 cases are made, solved, written and forgotten one by one: memory does not grow with their number, results.json, results.csv and, where it is asked for, results.parquet are written, and nothing is drawn.\n",
        ..Card::BLANK
    }
}

impl StudyKind for Run {
    fn read(&self, source: StudySource) -> Result<Box<dyn LoadedStudy>, StudyError> {
        let file = StudyFile::read(source)?;
        if file.count() > HELD { Ok(Box::new(file.sweep()?)) } else { Ok(Box::new(file.study()?)) }
    }
}
