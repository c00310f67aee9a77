//! `run`: every case of the study is solved on its own.

use super::case_study::SceneStudy;
use voussoir_core::plugin::{Card, PluginKind, Sample};
use voussoir_study::kind::{KindEntry, LoadedStudy, StudyKind};
use voussoir_study::study::{StudyError, StudySource};

struct Run;

voussoir_core::inventory::submit! { KindEntry { tag: "run", kind: &Run } }

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::StudyKind,
        tag: "run",
        summary: "solves every case of the study (variants × sweep)",
        samples: &[Sample::keys(r#"[sweep]
"joints.dry.friction" = { list = [0.4, 0.7] }"#)],
        file: file!(),
        package: voussoir_core::package!(),
        page: "# `run`\n\nThis kind of study solves every case: variants outermost, then the axes of the sweep. Each \
               case has one row in the table and one entry in results.json. Cases are made, solved and stored one after \
               another, so the memory does not grow with their forces and motions. If there are more than 1000 cases, the \
               table, the report and the chart show a few hundred of them: the least and the greatest load factor of each \
               group of neighbours, and cases without a certified answer. All cases are in results.json and results.csv.\n",
        ..Card::BLANK
    }
}

impl StudyKind for Run {
    fn read(&self, source: StudySource) -> Result<Box<dyn LoadedStudy>, StudyError> {
        SceneStudy::read(source)
    }
}
