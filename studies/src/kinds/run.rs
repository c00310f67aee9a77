//! `run`: every case of the study is solved on its own.

use super::kind::{KindEntry, LoadedStudy, StudyKind};
use crate::study::{Study, StudyError, StudySource};
use voussoir_core::plugin::{Card, PluginKind};

struct Run;

voussoir_core::inventory::submit! { KindEntry { tag: "run", kind: &Run } }

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::StudyKind,
        tag: "run",
        summary: "solves every case of the study (variants × sweep)",
        file: file!(),
        package: voussoir_core::package!(),
        page: "# `run`\n\nAnswers every case, variants outermost, then the axes of the sweep. One row of the table and one entry of results.json a case. Cases are made, solved, stored and forgotten one after another: memory does not grow with their forces and motions. Of more than 1000 cases the table, the report and the chart show some hundreds: the least and the greatest load factor of every few neighbours, and cases without a certified answer; all of them are in results.json and results.csv.\n",
        ..Card::BLANK
    }
}

impl StudyKind for Run {
    fn read(&self, source: StudySource) -> Result<Box<dyn LoadedStudy>, StudyError> {
        Ok(Box::new(Study::from_source_in_turn(source)?))
    }
}
