//! Limit solvers that answer a different question.

use super::limit_lie::{LimitAsked, LimitLie};
use voussoir_core::limit::{LimitAnswer, LimitProblem, LowerProof, LowerProofKind, Status};

/// Returns the answer of another problem.
fn other(asked: &LimitAsked, change: impl FnOnce(&mut LimitProblem)) -> Option<LimitAnswer> {
    asked.collapse()?;
    let mut problem = asked.problem.clone();
    change(&mut problem);
    asked.collapse_of(&problem)
}

/// Returns the motion of another problem, scaled to the loads of this one.
fn foreign_motion(asked: &LimitAsked, change: impl FnOnce(&mut LimitProblem)) -> Option<LimitAnswer> {
    let mut answer = asked.collapse()?;
    let mut motion = other(asked, change)?.motion?;
    let loads = asked.problem.varying.iter().flatten();
    let power: f64 = loads.zip(motion.iter().flatten()).map(|(load, velocity)| load * velocity).sum();
    motion.iter_mut().flatten().for_each(|velocity| *velocity /= power);
    answer.motion = Some(motion);
    Some(answer)
}

fn reverse_the_load(problem: &mut LimitProblem) {
    problem.varying.iter_mut().flatten().for_each(|load| *load = -*load);
}

fn turn_the_load(problem: &mut LimitProblem) {
    problem.varying.iter_mut().for_each(|[x, y, _]| (*x, *y) = (*y, *x));
}

/// Returns a state of the laws' own flow at a greater factor, in which two joints lock forces against each other, and claims
/// that this factor is the least one.
fn locked_in(asked: &LimitAsked) -> Option<LimitAnswer> {
    const PRESSURE: f64 = 2000.0;
    let mut answer = asked.ending(Status::Collapse)?;
    answer.non_associated.as_ref()?;
    let motion = answer.motion.clone()?;
    let joints = &asked.problem.joints;
    let opposite = |a: usize, b: usize| {
        let same = joints[a].plus == joints[b].plus && joints[a].minus == joints[b].minus;
        let sign = if same { -1.0 } else { 1.0 };
        (joints[a].normal.dot(&joints[b].normal) - sign).abs() < 1e-12
    };
    let pairs = (0..joints.len()).flat_map(|a| (0..a).map(move |b| (a, b)));
    let (a, b) = pairs.into_iter().find(|(a, b)| joints[*a].normal.y == 0.0 && opposite(*a, *b))?;
    let mut resisted = 0.0;
    for index in [a, b] {
        let joint = &joints[index];
        let wrench = joint.wrenches(asked.problem.pole);
        let power = |of: &[f64; 3]| {
            let on = |group: Option<usize>| group.map_or(0.0, |g| of.iter().zip(motion[g]).map(|(f, v)| f * v).sum());
            on(joint.plus) - on(joint.minus)
        };
        let row = joint.strength.rows.iter().find(|row| row.normal[2] > 0.0)?;
        let shear = -power(&wrench[2]).signum() * 2.0 * PRESSURE * row.normal[0].abs() / row.normal[2];
        let force = &mut answer.field.as_mut()?[index];
        force.normal = force.normal.map(|normal| normal + PRESSURE);
        force.shear += shear;
        resisted -= shear * power(&wrench[2]);
    }
    let factor = answer.factor? + resisted;
    (answer.factor, answer.field_factor) = (Some(factor), factor);
    let own = answer.non_associated.as_mut()?;
    (own.proved_lower, own.lower_proof) = (Some(factor), Some(LowerProof::by(LowerProofKind::Search)));
    Some(answer)
}

/// Answers to other questions.
pub const LIES: &[LimitLie] = &[
    LimitLie::new("forces_locked_in_called_the_least_load", locked_in),
    LimitLie::new("of_heavier_blocks", |asked| {
        other(asked, |problem| problem.fixed.iter_mut().flatten().for_each(|load| *load *= 3.0))
    }),
    LimitLie::new("of_lighter_blocks", |asked| {
        other(asked, |problem| problem.fixed.iter_mut().flatten().for_each(|load| *load *= 0.5))
    }),
    LimitLie::new("of_a_smaller_load", |asked| {
        other(asked, |problem| problem.varying.iter_mut().flatten().for_each(|load| *load *= 0.5))
    }),
    LimitLie::new("of_the_load_reversed", |asked| other(asked, reverse_the_load)),
    LimitLie::new("of_the_load_turned", |asked| other(asked, turn_the_load)),
    LimitLie::new("of_wider_joints", |asked| {
        other(asked, |problem| {
            for joint in problem.joints.iter_mut().filter(|joint| joint.fill.is_none()) {
                let half = (joint.ends[1] - joint.ends[0]) / 4.0;
                joint.ends = [joint.ends[0] - half, joint.ends[1] + half];
            }
        })
    }),
    LimitLie::new("of_joints_that_never_slide", |asked| {
        other(asked, |problem| {
            for joint in problem.joints.iter_mut().filter(|joint| joint.fill.is_none()) {
                joint.strength.rows.retain(|row| row.normal[2] == 0.0);
            }
        })
    }),
    LimitLie::new("of_joints_that_pull", |asked| {
        other(asked, |problem| {
            for row in problem.joints.iter_mut().flat_map(|joint| &mut joint.strength.rows) {
                row.bound += 5000.0;
            }
        })
    }),
    LimitLie::new("motion_of_the_load_reversed", |asked| foreign_motion(asked, reverse_the_load)),
    LimitLie::new("motion_of_the_load_turned", |asked| foreign_motion(asked, turn_the_load)),
    LimitLie::new("motion_of_one_block", |asked| {
        let mut answer = asked.collapse()?;
        let moved = answer.motion.as_mut()?;
        let last = moved.len() - 1;
        moved[..last].fill([0.0; 3]);
        let power: f64 = asked.problem.varying[last].iter().zip(&moved[last]).map(|(p, v)| p * v).sum();
        moved[last].iter_mut().for_each(|v| *v /= power);
        Some(answer)
    }),
    LimitLie::new("field_of_the_load_reversed", |asked| {
        let mut answer = asked.collapse()?;
        answer.field = other(asked, reverse_the_load)?.field;
        Some(answer)
    }),
    LimitLie::new("ray_of_another_load", |asked| {
        let mut answer = asked.ending(Status::Unbounded)?;
        for force in answer.ray.as_mut()? {
            force.normal = [force.normal[0] * 1.5, force.normal[1] * 0.5];
        }
        Some(answer)
    }),
    LimitLie::new("ray_of_nothing", |asked| {
        let mut answer = asked.ending(Status::Unbounded)?;
        answer.ray.iter_mut().for_each(Vec::clear);
        Some(answer)
    }),
];
