//! Energy: work = stored energy + dissipation, and no closed path releases work.

use super::findings::Recorder;
use super::point::Point;
use super::subject::Subject;
use voussoir_core::plugin::Property;
use voussoir_core::random::Random;

/// Number of closed paths of each sample, of corners of each path, and of steps between two corners.
const CYCLES: usize = 20;
const CORNERS: usize = 3;
const STEPS: usize = 150;

/// All checks of energy.
pub(super) fn check(recorder: &mut Recorder, subject: &Subject) {
    balance(recorder, subject);
    cycles(recorder, subject);
}

/// Work along a path of small steps, by the trapezoidal rule.
struct Driven {
    work: f64,
    stored: f64,
    dissipated: f64,
}

fn drive(point: &Point, places: impl Iterator<Item = [f64; 6]>) -> Option<Driven> {
    let (mut old, mut new) = (point.untouched(), vec![0.0; point.state_size()]);
    let (mut work, mut dissipated) = (0.0, 0.0);
    let mut before: Option<([f64; 6], [f64; 6], f64)> = None;
    let mut first = 0.0;
    for at in places {
        let said = point.update(&at, &old, &mut new).ok()?;
        old.copy_from_slice(&new);
        match before {
            None => first = said.stored,
            Some((force, from, _)) => {
                let half = |i: usize| 0.5 * (force[i] + said.force[i]) * (at[i] - from[i]);
                work += point.sign() * (0..point.components()).map(half).sum::<f64>();
                dissipated += said.dissipated;
            }
        }
        before = Some((said.force, at, said.stored));
    }
    Some(Driven { work, stored: before?.2 - first, dissipated })
}

/// Work = change of stored energy + dissipation, with an error that falls in proportion to the step.
fn balance(recorder: &mut Recorder, subject: &Subject) {
    let (point, unit) = (&subject.point, subject.sample.size);
    let place = |s: f64| -> [f64; 6] {
        match point {
            Point::Joint(_) => {
                [unit * (0.6 * (9.0 * s).sin() - 0.25), unit * (1.5 * (7.0 * s).sin() + 0.8 * s), 0.0, 0.0, 0.0, 0.0]
            }
            Point::Material(..) => std::array::from_fn(|i| {
                unit * (1.2 * (f64::from(i as u8 + 3) * s).sin() - if i < 3 { 0.8 * s } else { 0.0 })
            }),
        }
    };
    let mut errors = Vec::new();
    for steps in [1000, 2000, 4000] {
        let places = (0..=steps).map(|step| place(f64::from(step) / f64::from(steps)));
        let Some(Driven { work, stored, dissipated }) = drive(point, places) else {
            return recorder.fail("energy", "refuses a smooth path".into());
        };
        errors.push((work - stored - dissipated).abs() / (subject.stiffness * unit * unit));
    }
    let falls = errors[2] <= 0.6 * errors[0] + 4e-6 && errors[2] < 1.6e-2;
    recorder.hold("energy", falls, || {
        format!(
            "work is not what is stored and dissipated: off by {:.1e}, {:.1e} and {:.1e} of stiffness × size² in 1000, 2000 and 4000 steps",
            errors[0], errors[1], errors[2]
        )
    });
}

/// The work over a closed path from the untouched point is not negative: this point stores no energy that it could release.
fn cycles(recorder: &mut Recorder, subject: &Subject) {
    if !subject.card.claims(Property::DISSIPATIVE) {
        return;
    }
    let (point, unit) = (&subject.point, subject.sample.size);
    let mut random = Random::new(5);
    for _ in 0..CYCLES {
        let mut corners = vec![[0.0; 6]];
        for _ in 0..CORNERS {
            let mut corner = [0.0; 6];
            corner[..point.components()].iter_mut().for_each(|x| *x = unit * random.between(-3.0, 3.0));
            corners.push(corner);
        }
        corners.push([0.0; 6]);
        let places = corners.windows(2).flat_map(|pair| {
            let (from, to) = (pair[0], pair[1]);
            (0..=STEPS).map(move |step| {
                let share = step as f64 / STEPS as f64;
                std::array::from_fn(|i| from[i] + share * (to[i] - from[i]))
            })
        });
        let Some(driven) = drive(point, places) else { continue };
        let work = driven.work / (subject.stiffness * unit * unit);
        recorder.hold_on("cycles", work >= -1e-3, &corners, || {
            format!("a closed path from the untouched point gives away {:.1e} of stiffness × size²", -work)
        });
    }
}
