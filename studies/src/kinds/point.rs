//! `point`: one law, of a material or an interface, at one point, along a path of strains and stresses.
//!
//! Such a study has no scene: `[point]` names the material or joint and defines its path. Sweeps and variants work as in other
//! studies.

pub mod drive;
pub mod output;
pub mod result;
pub mod study;
mod surface;

use super::kind::{KindEntry, LoadedStudy, StudyKind};
use crate::study::{StudyError, StudySource};
use voussoir_core::plugin::{Card, Keys, Parameter, PluginKind};

struct Point;

voussoir_core::inventory::submit! { KindEntry { tag: "point", kind: &Point } }

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::StudyKind,
        tag: "point",
        summary: "drives one law at one point through strains, stresses or both",
        file: file!(),
        package: voussoir_core::package!(),
        page: "# `point`\n\nDrives a material or a joint through `[[point.path]]`, segment by segment. Each segment moves the components it names, \
               in `steps` equal steps, to the strains (gaps) or stresses (tractions) given; a component that is not named keeps \
               the strain or the stress it was controlled by last, at first a strain of zero. Strains are tension positive with \
               engineering shears; a joint's gap opens and its traction presses positive.\n",
        ..Card::of::<study::PointTable>()
    }
}

impl StudyKind for Point {
    fn read(&self, source: StudySource) -> Result<Box<dyn LoadedStudy>, StudyError> {
        Ok(Box::new(study::PointStudy::from_source(source)?))
    }

    fn file_keys(&self) -> Option<&'static [Parameter]> {
        Some(study::PointFile::PARAMETERS)
    }
}
