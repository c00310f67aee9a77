//! Figures as SVG files.

use super::register::register;
use super::writer::Writer;
use crate::figures::envelope::{envelope_chart, optimum_chart};
use crate::figures::moving_load::moving_load_svg;
use crate::figures::seismic::capacity_charts;
use crate::figures::sweep::{output_charts, study_chart};
use crate::figures::{curve_charts, curve_svg, mechanism_of_case, scene_of_case};
use crate::output::StudyOutput;
use rayon::prelude::*;
use serde_json::Value as Json;
use voussoir_plot::svg::as_file;
use voussoir_study::results::CaseResult;

/// Writes `figures/*.svg`.
#[derive(Debug)]
pub struct Figures;

impl Writer for Figures {
    fn files(&self, study: &StudyOutput, _options: &Json) -> Vec<(String, Vec<u8>)> {
        if !study.output.figures.anything() {
            return Vec::new();
        }
        let mut files: Vec<(String, String)> =
            study_chart(study).map(|svg| ("figures/sweep.svg".to_string(), svg)).into_iter().collect();
        files.extend(output_charts(study).into_iter().map(|(name, svg)| (format!("figures/sweep-{name}.svg"), svg)));
        files.extend(envelope_chart(study).map(|svg| ("figures/envelope.svg".to_string(), svg)));
        files.extend(capacity_charts(study).into_iter().map(|(name, svg)| (format!("figures/{name}.svg"), svg)));
        files.extend(optimum_chart(study).map(|svg| ("figures/optimum.svg".to_string(), svg)));
        files.extend(moving_load_svg(study).map(|svg| ("figures/moving-load.svg".to_string(), svg)));
        files.extend(curve_charts(study).into_iter().map(|(name, svg)| (format!("figures/{name}.svg"), svg)));
        let drawn: Vec<_> =
            study.results.cases.iter().enumerate().filter(|(_, case)| study.drawn(case.label.id)).collect();
        let of_case = |(place, case): &(usize, &CaseResult)| {
            let Some((assembly, stages)) = study.scene(*place) else { return Vec::new() };
            let name = |what: &str| format!("figures/case-{:04}-{what}.svg", case.label.id);
            let title = study.case_title(case);
            let mut own: Vec<_> = scene_of_case(study, *place).map(|svg| (name("scene"), svg)).into_iter().collect();
            own.extend(mechanism_of_case(study, *place).map(|svg| (name("mechanism"), svg)));
            own.extend(curve_svg(&title, assembly, stages, case).map(|svg| (name("curve"), svg)));
            own
        };
        files.extend(drawn.par_iter().flat_map_iter(of_case).collect::<Vec<_>>());
        files.into_iter().map(|(name, svg)| (name, as_file(&svg).into_bytes())).collect()
    }
}

register!(
    "figures",
    Figures,
    "figures/*.svg: each case's scene, mechanism and path, and charts of sweeps",
    "# `figures`\n\nWrites `figures/case-NNNN-scene.svg`, `figures/case-NNNN-mechanism.svg` and, where exactly one \
     number is swept, `figures/sweep.svg` and `figures/sweep-NAME.svg` for each output of the case that a plug-in declares. \
     Displacements of mechanisms are exaggerated. Where `[output] curve = true`, the \
     load over its displacement is in `figures/case-NNNN-curve.svg`, and two to seven cases together in `figures/curve.svg` \
     (more cases: `figures/curve-N.svg` for the N-th variant), with the joints that become hinges or slide. An optimisation has \
     `figures/optimum.svg`: the result at every value that was tried, with the optima. With `[output] \
     animation = true` an envelope has `figures/moving-load.svg`, which a browser plays; the report shows it too.\n"
);
