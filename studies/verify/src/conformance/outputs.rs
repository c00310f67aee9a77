//! Outputs of laws: as many as the card declares, finite, pure, and in the units of the card.

use super::findings::Recorder;
use super::point::Point;
use super::random::random_step;
use super::scaled::{LENGTH, scale_of};
use super::subject::Subject;
use voussoir_core::law::{PointContext, UpdateContext, UpdateFailure};
use voussoir_core::random::Random;

/// Number of walks and of steps of each walk.
const WALKS: usize = 30;
const STEPS: usize = 20;

/// Returns the outputs at the end of a step; `new` is the state there.
fn outputs(
    point: &Point,
    at: &[f64; 6],
    old: &[f64],
    new: &mut [f64],
    count: usize,
) -> Result<Vec<f64>, UpdateFailure> {
    let mut values = vec![f64::NAN; count];
    match point {
        Point::Joint(law) => {
            let (gap, context) = ([at[0], at[1]], PointContext::default());
            let said = law.respond_point(gap, &context, old, new)?;
            law.outputs(gap, &context, new, &said, &mut values);
        }
        Point::Material(law, length) => {
            let context = UpdateContext::of_length(*length);
            let said = law.update_point(at, &context, old, new)?;
            law.outputs(at, &context, new, &said, &mut values);
        }
    }
    Ok(values)
}

/// Walks through a sample. `other` is the same law in other units.
pub(super) fn check(recorder: &mut Recorder, subject: &Subject, other: Option<&Point>) {
    let declared: Vec<_> = subject.card.point_outputs().collect();
    let Subject { point, again, sample, .. } = subject;
    let (mut random, mut greatest) = (Random::new(31), vec![0.0_f64; declared.len()]);
    let place = if point.components() == 2 { LENGTH } else { 1.0 };
    for _ in 0..WALKS {
        let (mut old, mut old_there) = (point.untouched(), other.map_or(Vec::new(), Point::untouched));
        let (mut at, mut path) = ([0.0; 6], Vec::new());
        for _ in 0..STEPS {
            random_step(&mut random, &mut at, point.components(), sample.size);
            path.push(at);
            let (mut new, mut same) = (old.clone(), old.clone());
            let Ok(values) = outputs(point, &at, &old, &mut new, declared.len()) else { break };
            for (output, value) in declared.iter().zip(&values) {
                recorder.hold_on("outputs", value.is_finite(), &path, || {
                    format!("does not write the output \"{}\", or it is not finite", output.name)
                });
            }
            let twice = outputs(again, &at, &old, &mut same, declared.len());
            recorder.hold_on("outputs", twice.as_ref().is_ok_and(|twice| alike(twice, &values)), &path, || {
                format!("the same call gives the outputs {values:?}, then {twice:?}")
            });
            if let Some(other) = other {
                let (mut new_there, at_there) = (old_there.clone(), at.map(|x| x * place));
                let Ok(there) = outputs(other, &at_there, &old_there, &mut new_there, declared.len()) else { break };
                for (index, output) in declared.iter().enumerate() {
                    let (here, there) = (values[index], there[index] / scale_of(output.unit).unwrap_or(1.0));
                    greatest[index] = greatest[index].max(here.abs());
                    let near = (here - there).abs() <= 1e-6 * (here.abs() + there.abs()) + 1e-9 * greatest[index];
                    recorder.hold_on("outputs", near || here.is_nan(), &path, || {
                        format!("in other units the output \"{}\" is {there}, not {here} {}", output.name, output.unit)
                    });
                }
                old_there = new_there;
            }
            old = new;
        }
    }
}

/// Returns true if two lists have the same bits.
fn alike(one: &[f64], other: &[f64]) -> bool {
    one.iter().map(|value| value.to_bits()).eq(other.iter().map(|value| value.to_bits()))
}
