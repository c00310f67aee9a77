//! `point`: one law, of a material or an interface, at one point, along a path of strains and stresses.
//!
//! Such a study has no scene: `[point]` names the material or joint and defines its path. Sweeps and variants work as in other
//! studies.

pub mod drive;
pub mod output;
pub mod result;
pub mod study;
mod surface;

use voussoir_core::plugin::{Capability, Card, Keys, Parameter, PluginKind, Sample};
use voussoir_study::kind::{KindEntry, LoadedStudy, StudyKind};
use voussoir_study::study::{StudyError, StudySource};

struct Point;

voussoir_core::inventory::submit! { KindEntry { tag: "point", kind: &Point } }

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::StudyKind,
        provides: &[Capability::OWN_FILE],
        tag: "point",
        summary: "drives one law at one point through strains, stresses or both",
        samples: &[Sample::keys(r#"[joints.dry]
law = "coulomb"
friction = 0.6
normal_stiffness = 1e10
shear_stiffness = 5e9

[point]
joint = "dry"

[[point.path]]
steps = 1
gap = { n = -1e-4 }

[[point.path]]
steps = 3
gap = { t = 4e-4 }"#)],
        file: file!(),
        package: voussoir_core::package!(),
        page: "# `point`\n\nThis kind of study drives a material or a joint through `[[point.path]]`, segment by \
               segment. Each segment moves the components that it names, in `steps` equal steps, to the given strains (gaps) \
               or stresses (tractions). A component that is not named keeps its last prescribed strain or stress; at first \
               this is a strain of zero. Strains are positive in tension, with engineering shears. The gap of a joint is \
               positive if the joint is open, and its traction is positive in compression.\n",
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
