//! The tensile strength and the fracture energy that a joint law reports agree with its tractions.

use super::findings::Recorder;
use super::subject::Subject;
use voussoir_core::law::InterfaceResponse;

/// Steps until the joint is fully open, and the opening at the end as a multiple of G / f.
const STEPS: u32 = 8000;
const OPEN: f64 = 20.0;
/// Greatest relative difference of the strength, and of the energy.
const STRENGTH: f64 = 0.02;
const ENERGY: f64 = 0.05;

/// Opens an untouched joint until its bond is gone. The greatest tension is f_t and the work is G_I.
pub(super) fn check(recorder: &mut Recorder, subject: &Subject, response: &dyn InterfaceResponse) {
    let Some([strength, energy]) = response.tensile_softening() else { return };
    let possible = [strength, energy].iter().all(|x| x.is_finite() && *x > 0.0);
    recorder.hold("tensile_softening", possible, || format!("tensile_softening() is [{strength}, {energy}]"));
    if !possible {
        return;
    }
    let step = OPEN * energy / strength / f64::from(STEPS);
    let (mut old, mut new) = (subject.point.untouched(), vec![0.0; subject.point.state_size()]);
    let (mut tension, mut greatest, mut work) = (0.0_f64, 0.0_f64, 0.0);
    for index in 1..=STEPS {
        let gap = [step * f64::from(index), 0.0, 0.0, 0.0, 0.0, 0.0];
        let Ok(said) = subject.point.update(&gap, &old, &mut new) else { return };
        work += 0.5 * (tension - said.force[0]) * step;
        tension = -said.force[0];
        greatest = greatest.max(tension);
        old.copy_from_slice(&new);
    }
    recorder.hold("tensile_softening", (greatest / strength - 1.0).abs() <= STRENGTH, || {
        format!("reports a tensile strength of {strength:e} Pa, but the greatest tension is {greatest:e} Pa")
    });
    recorder.hold("tensile_softening", (work / energy - 1.0).abs() <= ENERGY, || {
        format!("reports a fracture energy of {energy:e} J/m², but opening takes {work:e} J/m²")
    });
}
