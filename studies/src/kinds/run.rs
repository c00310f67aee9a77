//! `run`: every case of the study is solved on its own.

use super::kind::{KindEntry, LoadedStudy, StudyKind};
use crate::config::diagnostic::LocatedDiagnostic;
use crate::study::{Study, StudySource};
use voussoir_core::plugin::{Card, PluginKind};

struct Run;

voussoir_core::inventory::submit! { KindEntry { tag: "run", kind: &Run } }

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::StudyKind,
        tag: "run",
        summary: "answers every case of the study (variants × sweep) on its own",
        parameters: &[],
        file: file!(),
        page: "# `run`\n\nAnswers every case, variants outermost, then the axes of the sweep. One row of the table and one entry of results.json a case.\n",
        ..Card::BLANK
    }
}

impl StudyKind for Run {
    fn read(&self, source: StudySource) -> Result<Box<dyn LoadedStudy>, Vec<LocatedDiagnostic>> {
        Ok(Box::new(Study::from_source(source)?))
    }
}
