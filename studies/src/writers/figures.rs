//! Figures as SVG files.

use super::{StudyOutput, Writer, register};
use crate::figures::sweep::study_chart;
use crate::figures::{mechanism_svg, scene_svg};

/// Writes `figures/*.svg`.
#[derive(Debug)]
pub struct Figures;

impl Writer for Figures {
    fn files(&self, study: &StudyOutput) -> Vec<(String, String)> {
        if !study.figures {
            return Vec::new();
        }
        let mut files: Vec<_> =
            study_chart(study).map(|svg| ("figures/sweep.svg".to_string(), svg)).into_iter().collect();
        for (place, case) in study.results.cases.iter().enumerate() {
            let Some((assembly, stages)) = study.scene(place) else { continue };
            let name = |what: &str| format!("figures/case-{:04}-{what}.svg", case.id);
            files.push((name("scene"), scene_svg(study.name, assembly, stages, case)));
            files.extend(mechanism_svg(study.name, assembly, case).map(|svg| (name("mechanism"), svg)));
        }
        files
    }
}

register!(
    "figures",
    Figures,
    "figures/*.svg: each case's scene and mechanism, and the chart of a sweep over one number",
    "# `figures`\n\nWrites `figures/case-NNNN-scene.svg`, `figures/case-NNNN-mechanism.svg` and, where exactly one \
     number is swept, `figures/sweep.svg`. Displacements of mechanisms are exaggerated.\n"
);
