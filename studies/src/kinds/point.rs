//! `point`: one law, bulk or interface, at one point, through a path of strains and stresses.
//!
//! Such a study has no scene: `[point]` says which material or joint is driven and how. Sweeps and
//! variants work as everywhere. [`load`] reads the file, [`answer`] drives a case, [`output`] writes.

pub mod output;
mod study;

pub use study::{PointCase, PointStudy, is_point, load, schema};

use serde::Serialize;
use serde_json::{Map, Value as Json};
use std::collections::BTreeMap;
use voussoir_core::plugin::{Card, PluginKind};
use voussoir_solvers::point::{Control, DrivenPoint, PointLaw};

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::StudyKind,
        tag: "point",
        summary: "drives one law at one point through strains, stresses or both: voussoir point STUDY.toml",
        parameters: study::POINT,
        file: file!(),
        page: "# `point`\n\nDrives a material or a joint through `[[point.path]]`, segment by segment. Each segment moves the components it names, \
               in `steps` equal steps, to the strains (gaps) or stresses (tractions) given; a component that is not named keeps \
               the strain or the stress it was controlled by last, at first a strain of zero. Strains are tension positive with \
               engineering shears; a joint's gap opens and its traction presses positive.\n",
        ..Card::BLANK
    }
}

/// How a path ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum PathStatus {
    /// At its end.
    Reached,
    /// Before it; the notes say why.
    Stalled,
}

/// A driven point: a row of numbers and a region per step.
#[derive(Debug, Clone, Serialize)]
pub struct PointResult {
    /// Index from 0, variants outermost.
    pub id: usize,
    /// Name of its variant.
    pub variant: Option<String>,
    /// Swept key → value.
    pub parameters: Map<String, Json>,
    /// Tag of the law.
    pub law: String,
    /// How it ended.
    pub status: PathStatus,
    /// What a user should know.
    pub notes: Vec<String>,
    /// Names of the numbers in a row, with units.
    pub columns: Vec<String>,
    /// One row per step, the first before any.
    pub rows: Vec<Vec<f64>>,
    /// Region or regime of each row.
    pub regions: Vec<&'static str>,
    /// Segment of each row.
    pub segments: Vec<usize>,
    /// Greatest error of a controlled stress \[Pa\].
    pub largest_control_error: f64,
    /// Work done.
    pub counters: BTreeMap<&'static str, u64>,
}

/// Drives one case.
pub fn answer(case: &PointCase) -> PointResult {
    let mut result = PointResult {
        id: case.id,
        variant: case.variant.clone(),
        parameters: case.parameters.clone(),
        law: case.tag.clone(),
        status: PathStatus::Reached,
        notes: case.notes.clone(),
        columns: columns(&case.law),
        rows: Vec::new(),
        regions: Vec::new(),
        segments: Vec::new(),
        largest_control_error: 0.0,
        counters: BTreeMap::new(),
    };
    let mut point = match DrivenPoint::new(case.law.clone()) {
        Ok(point) => point,
        Err(failure) => {
            result.status = PathStatus::Stalled;
            result.notes.push(failure.to_string());
            return result;
        }
    };
    let mut dissipated = 0.0;
    record(&mut result, &point, 0, dissipated);
    let mut controls = vec![Control::Strain(0.0); case.law.components()];
    'path: for (number, segment) in case.path.iter().enumerate() {
        // From where each component is, in the quantity that is controlled now.
        let from: Vec<f64> = (0..controls.len())
            .map(|i| match segment.targets[i].unwrap_or(controls[i]) {
                Control::Strain(_) => point.response.strain[i],
                Control::Stress(_) => point.response.stress[i],
            })
            .collect();
        for (control, target) in controls.iter_mut().zip(&segment.targets) {
            *control = target.unwrap_or(*control);
        }
        for step in 1..=segment.steps {
            let share = step as f64 / segment.steps as f64;
            let now: Vec<Control> = controls
                .iter()
                .zip(&from)
                .map(|(control, from)| {
                    let between = |to: f64| if step == segment.steps { to } else { from + share * (to - from) };
                    match *control {
                        Control::Strain(to) => Control::Strain(between(to)),
                        Control::Stress(to) => Control::Stress(between(to)),
                    }
                })
                .collect();
            let outcome = point.step(&now);
            dissipated += point.response.dissipated;
            if let Err(stop) = outcome {
                result.status = PathStatus::Stalled;
                result.notes.push(format!("segment {number}, step {step}: {stop}"));
                break 'path;
            }
            result.largest_control_error = result.largest_control_error.max(point.error(&now));
            record(&mut result, &point, number, dissipated);
        }
    }
    result.counters.insert("law_evaluations", point.evaluations);
    result.counters.insert("halved_steps", point.halvings);
    result
}

/// Names of a row's numbers.
fn columns(law: &PointLaw) -> Vec<String> {
    let names = law.names();
    let (strain, stress, energy) = match law {
        PointLaw::Joint(_) => (("gap", "m"), "traction", "J/m2"),
        _ => (("strain", "-"), "stress", "J/m3"),
    };
    let mut out: Vec<String> = names.iter().map(|name| format!("{}_{name} [{}]", strain.0, strain.1)).collect();
    out.extend(names.iter().map(|name| format!("{stress}_{name} [Pa]")));
    match law {
        PointLaw::Space(..) => out.extend(["p [Pa]".into(), "q [Pa]".into()]),
        PointLaw::Plane(..) => {
            out.extend(["strain_zz [-]".into(), "stress_zz [Pa]".into(), "p [Pa]".into(), "q [Pa]".into()]);
        }
        PointLaw::Joint(_) => {}
    }
    out.push(format!("dissipated [{energy}]"));
    out.extend(law.state_names().iter().map(|name| name.to_string()));
    out
}

fn record(result: &mut PointResult, point: &DrivenPoint, segment: usize, dissipated: f64) {
    let count = point.law().components();
    let response = &point.response;
    let mut row: Vec<f64> = response.strain[..count].to_vec();
    row.extend(&response.stress[..count]);
    let invariants = |stress: [f64; 6]| {
        let p = -(stress[0] + stress[1] + stress[2]) / 3.0;
        let deviator: [f64; 6] = std::array::from_fn(|i| if i < 3 { stress[i] + p } else { stress[i] });
        [p, voussoir_core::law::von_mises(&deviator)]
    };
    match point.law() {
        PointLaw::Space(..) => row.extend(invariants(response.stress)),
        PointLaw::Plane(..) => {
            let [x, y, shear] = [response.stress[0], response.stress[1], response.stress[2]];
            row.extend(response.across);
            row.extend(invariants([x, y, response.across[1], shear, 0.0, 0.0]));
        }
        PointLaw::Joint(_) => {}
    }
    row.push(dissipated);
    row.extend(point.state());
    // Minus zero is zero.
    row.iter_mut().for_each(|entry| *entry += 0.0);
    result.rows.push(row);
    result.regions.push(response.region);
    result.segments.push(segment);
}
