//! The drawings of a case of a study, in the plane or in space.

use super::drawing::scene_svg;
use super::mechanism::mechanism_svg;
use super::space::{space_mechanism_svg, space_svg};
use crate::output::StudyOutput;

/// Returns the drawing of a case, by its index in the results; `None` if its scene is missing.
pub fn scene_of_case(study: &StudyOutput, place: usize) -> Option<String> {
    let (scene, case) = (study.scenes.get(place)?, study.results.cases.get(place)?);
    let title = study.case_title(case);
    Some(match scene.space {
        Some(space) => space_svg(&title, space, scene.stages, case),
        None => scene_svg(&title, scene.assembly, scene.stages, case),
    })
}

/// Returns the drawing of the mechanism of a case, by its index in the results, if it has one.
pub fn mechanism_of_case(study: &StudyOutput, place: usize) -> Option<String> {
    let (scene, case) = (study.scenes.get(place)?, study.results.cases.get(place)?);
    let title = study.case_title(case);
    match scene.space {
        Some(space) => space_mechanism_svg(&title, space, case),
        None => mechanism_svg(&title, scene.assembly, case),
    }
}
