//! Drives a point along its path, step by step.

use super::result::{PathStatus, PointResult, columns};
use super::study::PointCase;
use std::collections::BTreeMap;
use voussoir_solvers::point::{Control, DrivenPoint, PointLaw};

/// Drives one case.
pub fn drive_point(case: &PointCase) -> PointResult {
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
        // Start value of each component, in the quantity that is controlled now.
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
    // Converts minus zero into zero.
    row.iter_mut().for_each(|entry| *entry += 0.0);
    result.rows.push(row);
    result.regions.push(response.region);
    result.segments.push(segment);
}
