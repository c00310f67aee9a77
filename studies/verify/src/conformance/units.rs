//! Units: a plug-in described in other units behaves in the same way. This finds parameters with a missing or wrong unit.

use super::findings::Recorder;
use super::plug_in::PlugIn;
use super::random::random_step;
use super::samples::own_check;
use super::scaled::{LENGTH, STRESS, scaled_table, state_unit};
use super::subject::Subject;
use serde_json::Value as Json;
use voussoir_core::plugin::{Card, Need, Parameter};
use voussoir_core::random::Random;
use voussoir_study::config::default_table::default_of;

/// Returns the plug-in of a sample in the other units; records a finding if it is refused.
pub(super) fn other_units(recorder: &mut Recorder, card: &Card, table: &Json) -> Option<PlugIn> {
    // Defaults have units too.
    let mut whole = table.clone();
    for Parameter { name, need, .. } in card.parameters {
        if let (Need::Default(text), None) = (need, table.get(name))
            && let Some(default) = default_of(text)
        {
            whole[*name] = default;
        }
    }
    let table = scaled_table(&whole, card.parameters);
    let wrong = own_check(card, &table);
    let law = PlugIn::read(card.kind, &table);
    let refused = law.as_ref().err().cloned().or((!wrong.is_empty()).then(|| format!("{wrong:?}")));
    recorder.hold("units", refused.is_none(), || {
        format!(
            "with lengths × {LENGTH} and stresses × {STRESS} it is refused: {}",
            refused.clone().unwrap_or_default()
        )
    });
    law.ok()
}

/// Compares walks in both units.
pub(super) fn check(recorder: &mut Recorder, subject: &Subject, other: &super::point::Point) {
    let Subject { point, sample, stiffness, .. } = subject;
    let joint = point.components() == 2;
    let place = if joint { LENGTH } else { 1.0 };
    let units: Vec<f64> = point.state_names().iter().map(|name| state_unit(name).unwrap_or(1.0)).collect();
    let (mut random, worst) = (Random::new(13), 1e-6 * stiffness * sample.size);
    for _ in 0..30 {
        let (mut old, mut old_there) = (point.untouched(), other.untouched());
        let (mut at, mut path) = ([0.0; 6], Vec::new());
        for _ in 0..20 {
            random_step(&mut random, &mut at, point.components(), sample.size);
            path.push(at);
            let (mut new, mut new_there) = (old.clone(), old_there.clone());
            let here = point.update(&at, &old, &mut new);
            let there = other.update(&at.map(|x| x * place), &old_there, &mut new_there);
            let (Ok(here), Ok(there)) = (here, there) else { break };
            let off = (0..6).map(|i| (there.force[i] / STRESS - here.force[i]).abs()).fold(0.0, f64::max);
            recorder.hold_on("units", off <= worst, &path, || {
                format!(
                    "with lengths × {LENGTH} and stresses × {STRESS} it carries {:?}, not {:?}: a parameter's unit is missing or wrong",
                    there.force.map(|f| f / STRESS),
                    here.force
                )
            });
            let energy = if joint { STRESS * LENGTH } else { STRESS };
            let off = (there.stored / energy - here.stored).abs() + (there.dissipated / energy - here.dissipated).abs();
            recorder.hold_on("units", off <= worst * sample.size, &path, || "its energies depend on the units".into());
            let near = |i: usize| {
                let (a, b) = (new[i], new_there[i] / units[i]);
                (a - b).abs() <= 1e-6 * (a.abs() + b.abs()) + 1e-9 * sample.size
            };
            recorder.hold_on("state", (0..units.len()).all(near), &path, || {
                format!(
                    "in other units the state is {new_there:?}, not {new:?}: a number of {:?} has another unit",
                    point.state_names()
                )
            });
            (old, old_there) = (new, new_there);
        }
    }
}
