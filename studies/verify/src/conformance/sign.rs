//! Signs: closing gives compression, opening never does, slip is resisted, and more compression does not make a joint slide
//! more easily.

use super::findings::Recorder;
use super::subject::Subject;
use voussoir_core::law::InterfaceLaw;

/// Checks the signs of tractions from gaps.
pub(super) fn check_joint(recorder: &mut Recorder, subject: &Subject, law: &dyn InterfaceLaw) {
    let (size, scale) = (subject.sample.size, subject.stiffness * subject.sample.size);
    let driven = |path: &[[f64; 6]]| {
        let (mut old, mut new) = (subject.point.untouched(), vec![0.0; subject.point.state_size()]);
        let mut last = None;
        for at in path {
            last = subject.point.update(at, &old, &mut new).ok();
            old.copy_from_slice(&new);
        }
        last
    };
    let at = |n: f64, t: f64| [n * size, t * size, 0.0, 0.0, 0.0, 0.0];
    for share in [1e-3, 1e-2, 0.1] {
        let path = [at(-share, 0.0)];
        let traction = driven(&path).map(|said| said.force[0]);
        recorder.hold_on("normal", traction.is_some_and(|t| t > 0.0), &path, || {
            format!("closing by {:e} m gives t_n = {traction:?}: compression is positive", share * size)
        });
        for sense in [1.0, -1.0] {
            let path = [at(-share, 0.0), at(-share, sense * share)];
            let shear = driven(&path).map(|said| said.force[1]);
            recorder.hold_on("friction", shear.is_some_and(|t| t * sense <= 1e-12 * scale), &path, || {
                format!("slip of {:e} m meets t_t = {shear:?}, which pushes it on", sense * share * size)
            });
        }
    }
    for share in [1e-3, 0.1, 1.0, 10.0] {
        let path = [at(share, 0.0)];
        let traction = driven(&path).map(|said| said.force[0]);
        recorder.hold_on("normal", traction.is_some_and(|t| t <= 1e-12 * scale), &path, || {
            format!("opening by {:e} m gives t_n = {traction:?}: an open joint does not press", share * size)
        });
    }
    for sense in [1.0, -1.0] {
        firm_and_light(recorder, subject, sense);
    }
    stiffness(recorder, subject, law, driven(&[at(-1e-6, 0.0)]).map(|said| said.tangent));
}

/// A joint with twice the compression resists every slip with at least as much shear.
fn firm_and_light(recorder: &mut Recorder, subject: &Subject, sense: f64) {
    const STEPS: u16 = 400;
    let (point, size) = (&subject.point, subject.sample.size);
    let (mut light, mut firm) = (point.untouched(), point.untouched());
    let (mut light_after, mut firm_after) = (light.clone(), firm.clone());
    let mut path = Vec::new();
    for step in 0..=STEPS {
        let at = |close: f64| {
            let slip = sense * 10.0 * f64::from(step) / f64::from(STEPS);
            [-close * size, slip * size, 0.0, 0.0, 0.0, 0.0]
        };
        path.push(at(0.04));
        let one = point.update(&at(0.02), &light, &mut light_after);
        let other = point.update(&at(0.04), &firm, &mut firm_after);
        let (Ok(one), Ok(other)) = (one, other) else { return };
        let less = one.force[1].abs() - other.force[1].abs();
        recorder.hold_on("friction", less <= 1e-9 * subject.stiffness * size, &path, || {
            format!(
                "closed twice as far it meets the same slip with {:e} Pa instead of {:e}: compression lowers the shear strength",
                other.force[1], one.force[1]
            )
        });
        light.copy_from_slice(&light_after);
        firm.copy_from_slice(&firm_after);
    }
}

/// `stiffness()` is the tangent of the untouched joint.
fn stiffness(recorder: &mut Recorder, subject: &Subject, law: &dyn InterfaceLaw, tangent: Option<[[f64; 6]; 6]>) {
    let Some(k) = law.stiffness() else {
        return recorder.fail("stiffness", "gives tractions from gaps, but stiffness() is None".into());
    };
    recorder.hold("stiffness", k.iter().all(|k| *k > 0.0 && k.is_finite()), || format!("stiffness() is {k:?}"));
    let off = |tangent: [[f64; 6]; 6]| {
        let errors = [tangent[0][0] + k[0], tangent[1][1] + k[1], tangent[0][1], tangent[1][0]];
        errors.iter().fold(0.0_f64, |a, b| a.max(b.abs())) / subject.stiffness
    };
    // A joint without friction has no shear to compare.
    let slides = tangent.is_some_and(|tangent| tangent[1][1] == 0.0);
    recorder.hold("stiffness", slides || tangent.is_some_and(|tangent| off(tangent) <= 1e-4), || {
        format!(
            "stiffness() is {k:?}, but the untouched joint, pressed a little, has the tangent {:?}",
            tangent.map(|tangent| [[tangent[0][0], tangent[0][1]], [tangent[1][0], tangent[1][1]]])
        )
    });
}

/// Checks the signs of stresses from strains: shortening gives compression, stretching gives tension.
pub(super) fn check_material(recorder: &mut Recorder, subject: &Subject) {
    let (size, mut new) = (subject.sample.size, vec![0.0; subject.point.state_size()]);
    for axis in 0..3 {
        for strain in [1e-3, -1e-3] {
            let mut at = [0.0; 6];
            at[axis] = strain * size;
            let stress = subject.point.update(&at, &subject.point.untouched(), &mut new).map(|said| said.force[axis]);
            recorder.hold_on("normal", stress.is_ok_and(|s| s * strain > 0.0), &[at], || {
                format!(
                    "a strain of {:e} along axis {axis} gives the stress {stress:?}: both are positive in tension",
                    strain * size
                )
            });
        }
    }
}
