//! The last row of the linear equations of a step: the gradient of its control.

use crate::contact::facet::dot;
use crate::path::newton::model::control::Control;
use crate::path::newton::model::equations::Equations;
use crate::path::newton::model::state::{State, Tangent};
use crate::path::newton::model::system::StepSystem;

/// Returns the gradient of a control over the scaled unknowns, with gaps linearised as in some equations.
pub fn control_row(system: &StepSystem, control: &Control, equations: &Equations) -> Vec<f64> {
    match control {
        Control::Along { row, .. } => row.to_vec(),
        Control::Factor(_) => {
            let mut row = vec![0.0; system.size()];
            row[system.size() - 1] = 1.0;
            row
        }
        Control::Zero { contact, by_force, by_gap, .. } => {
            let mut row = vec![0.0; system.size()];
            for (k, weight) in by_gap.iter().enumerate().filter(|(_, weight)| **weight != 0.0) {
                let gap = equations.gaps.row(2 * contact + k);
                gap.for_each(|(j, value)| row[j] += weight * system.units().displacement * value);
            }
            (0..2).for_each(|k| row[2 * contact + k] += by_force[k] * system.units().force);
            row
        }
    }
}

/// Returns the distance of a state from the target of a control.
pub fn control_value(system: &StepSystem, start: &State, state: &State, control: &Control) -> f64 {
    match control {
        Control::Factor(target) => (state.factor - target) / system.units().factor,
        Control::Along { row, length } => along(system, start, state, row) - length,
        Control::Zero { contact, offset, by_force, by_gap } => {
            offset + dot(*by_force, state.force[*contact]) + dot(*by_gap, state.gap[*contact])
        }
    }
}

/// Returns the motions and factor of a tangent over the scaled unknowns.
pub fn scaled_row(system: &StepSystem, tangent: &Tangent) -> Vec<f64> {
    let u = system.units();
    let first = 2 * system.scaled.contacts;
    let mut row = vec![0.0; system.size()];
    for (body, free) in system.scaled.free.iter().enumerate() {
        let Some(free) = free else { continue };
        let unit = u.motion();
        (0..3).for_each(|k| row[first + 3 * free + k] = tangent.motion[body][k] / unit[k]);
    }
    row[system.size() - 1] = tangent.factor / u.factor;
    row
}

/// Returns row · (x − x_start) over the scaled motions and the scaled factor.
fn along(system: &StepSystem, start: &State, state: &State, row: &[f64]) -> f64 {
    let u = system.units();
    let first = 2 * system.scaled.contacts;
    let of_body = |(body, free): (usize, &Option<usize>)| -> f64 {
        let Some(free) = free else { return 0.0 };
        let unit = u.motion();
        let moved = |k: usize| (state.motion[body][k] - start.motion[body][k]) / unit[k];
        (0..3).map(|k| row[first + 3 * free + k] * moved(k)).sum()
    };
    let motions: f64 = system.scaled.free.iter().enumerate().map(of_body).sum();
    motions + row[row.len() - 1] * (state.factor - start.factor) / u.factor
}
