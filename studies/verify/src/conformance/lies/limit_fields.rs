//! Limit solvers that change one part of a true answer.

use super::limit_lie::{LimitAsked, LimitLie};
use voussoir_core::limit::{JointForce, LimitAnswer, LowerProof, LowerProofKind, NonAssociated, ProductStep, Velocity};

fn scale(field: &mut Option<Vec<JointForce>>, by: f64) {
    for force in field.iter_mut().flatten() {
        force.normal = force.normal.map(|normal| normal * by);
        force.shear *= by;
    }
}

/// Returns a collapse with its field changed.
fn field(asked: &LimitAsked, change: impl FnOnce(&mut Vec<JointForce>)) -> Option<LimitAnswer> {
    let mut answer = asked.collapse()?;
    change(answer.field.as_mut()?);
    Some(answer)
}

/// Returns a collapse with its motion changed.
fn motion(asked: &LimitAsked, change: impl FnOnce(&mut Vec<Velocity>)) -> Option<LimitAnswer> {
    let mut answer = asked.collapse()?;
    change(answer.motion.as_mut()?);
    Some(answer)
}

/// Returns a collapse with its factor changed.
fn factor(asked: &LimitAsked, change: impl FnOnce(f64) -> f64) -> Option<LimitAnswer> {
    let mut answer = asked.collapse()?;
    answer.factor = Some(change(answer.factor?));
    Some(answer)
}

/// Returns a collapse with a false answer for non-associated flow.
fn lower(asked: &LimitAsked, proved: f64, proof: Option<LowerProof>) -> Option<LimitAnswer> {
    let mut answer = asked.collapse()?;
    let factor = answer.factor?;
    let mut own = answer.non_associated.take().unwrap_or_default();
    (own.proved_lower, own.lower_proof) = (Some(proved * factor), proof);
    answer.non_associated = Some(own);
    Some(answer)
}

/// Answers with one part changed.
pub const LIES: &[LimitLie] = &[
    LimitLie::new("factor_5_percent_high", |asked| factor(asked, |factor| 1.05 * factor)),
    LimitLie::new("factor_5_percent_low", |asked| factor(asked, |factor| 0.95 * factor)),
    LimitLie::new("factor_a_millionth_high", |asked| factor(asked, |factor| factor * (1.0 + 1e-6))),
    LimitLie::new("factor_negative", |asked| factor(asked, |factor| -factor)),
    LimitLie::new("factor_nan", |asked| factor(asked, |_| f64::NAN)),
    LimitLie::new("factor_infinite", |asked| factor(asked, |_| f64::INFINITY)),
    LimitLie::new("factor_of_the_field", |asked| {
        let mut answer = asked.collapse()?;
        answer.field_factor *= 1.1;
        Some(answer)
    }),
    LimitLie::new("all_scaled", |asked| {
        let mut answer = asked.collapse()?;
        answer.factor = answer.factor.map(|factor| 1.1 * factor);
        answer.field_factor *= 1.1;
        scale(&mut answer.field, 1.1);
        Some(answer)
    }),
    LimitLie::new("stopped_early", |asked| {
        let mut answer = asked.collapse()?;
        let half = asked.field_at(answer.factor? / 2.0)?;
        (answer.factor, answer.field, answer.field_factor) = (Some(half.field_factor), half.field, half.field_factor);
        Some(answer)
    }),
    LimitLie::new("half_the_field", |asked| field(asked, |field| field.truncate(field.len() / 2))),
    LimitLie::new("half_the_field_is_zero", |asked| {
        field(asked, |field| {
            let half = field.len() / 2;
            field[half..].fill(JointForce::default());
        })
    }),
    LimitLie::new("field_too_long", |asked| field(asked, |field| field.push(JointForce::default()))),
    LimitLie::new("empty_field", |asked| field(asked, Vec::clear)),
    LimitLie::new("zero_field", |asked| field(asked, |field| field.fill(JointForce::default()))),
    LimitLie::new("nan_in_the_field", |asked| field(asked, |field| field[0].normal[0] = f64::NAN)),
    LimitLie::new("infinity_in_the_field", |asked| field(asked, |field| field[0].shear = f64::INFINITY)),
    LimitLie::new("reversed_field", |asked| field(asked, |field| field.reverse())),
    LimitLie::new("shear_reversed", |asked| {
        field(asked, |field| field.iter_mut().for_each(|force| force.shear = -force.shear))
    }),
    LimitLie::new("tension", |asked| {
        field(asked, |field| field.iter_mut().for_each(|force| force.normal = force.normal.map(|normal| -normal)))
    }),
    LimitLie::new("half_the_motion", |asked| motion(asked, |motion| motion.truncate(motion.len() / 2))),
    LimitLie::new("empty_motion", |asked| motion(asked, Vec::clear)),
    LimitLie::new("no_motion", |asked| motion(asked, |motion| motion.fill([0.0; 3]))),
    LimitLie::new("nan_in_the_motion", |asked| motion(asked, |motion| motion[0][0] = f64::NAN)),
    LimitLie::new("infinity_in_the_motion", |asked| motion(asked, |motion| motion[0][2] = f64::INFINITY)),
    LimitLie::new("motion_not_scaled", |asked| {
        motion(asked, |motion| motion.iter_mut().flatten().for_each(|v| *v *= 2.0))
    }),
    LimitLie::new("motion_backwards", |asked| {
        motion(asked, |motion| motion.iter_mut().flatten().for_each(|v| *v = -*v))
    }),
    LimitLie::new("motion_mirrored", |asked| {
        motion(asked, |motion| {
            motion.reverse();
            motion.iter_mut().for_each(|[x, _, turn]| (*x, *turn) = (-*x, -*turn));
        })
    }),
    LimitLie::new("motion_without_turns", |asked| {
        motion(asked, |motion| motion.iter_mut().for_each(|velocity| velocity[2] = 0.0))
    }),
    LimitLie::new("called_unique", |asked| {
        let mut answer = asked.collapse()?;
        answer.unique = Some(true);
        Some(answer)
    }),
    LimitLie::new("lower_bound_without_a_proof", |asked| lower(asked, 1.2, None)),
    LimitLie::new("lower_bound_by_a_search", |asked| lower(asked, 1.0, Some(LowerProof::by(LowerProofKind::Search)))),
    LimitLie::new("lower_bound_above_the_truth", |asked| {
        lower(asked, 1.5, Some(LowerProof::by(LowerProofKind::Search)))
    }),
    LimitLie::new("lower_bound_called_associated", |asked| {
        lower(asked, 1.0, Some(LowerProof::by(LowerProofKind::Associated)))
    }),
    LimitLie::new("lower_bound_of_no_products", |asked| {
        lower(asked, 1.0, Some(LowerProof::by(LowerProofKind::Products)))
    }),
    LimitLie::new("lower_bound_of_forged_products", |asked| {
        let steps = vec![ProductStep {
            range: [0.0, 1e3],
            bound: 1e3,
            multipliers: vec![(i64::MAX, vec![(-2, f64::NAN), (i64::MIN, 1.0)])],
        }];
        lower(asked, 1.0, Some(LowerProof { by: LowerProofKind::Products, steps }))
    }),
    LimitLie::new("lower_bound_nan", |asked| lower(asked, f64::NAN, None)),
    LimitLie::new("associated_factor_below", |asked| {
        let mut answer = asked.collapse()?;
        let half = answer.factor.map(|factor| factor / 2.0);
        let own = NonAssociated { associated_factor: half, ..answer.non_associated.take().unwrap_or_default() };
        answer.non_associated = Some(own);
        Some(answer)
    }),
    LimitLie::new("associated_factor_above", |asked| {
        let mut answer = asked.collapse()?;
        let more = answer.factor.map(|factor| 1.5 * factor);
        let motion = answer.motion.clone();
        let own = answer.non_associated.take().unwrap_or_default();
        let own = NonAssociated { associated_factor: more, associated_motion: motion, ..own };
        answer.non_associated = Some(own);
        Some(answer)
    }),
    LimitLie::new("associated_answer_as_non_associated", |asked| {
        let answer = asked.collapse()?;
        let mut associated = asked.problem.clone();
        for row in associated.joints.iter_mut().flat_map(|joint| &mut joint.strength.rows) {
            row.flow = row.normal;
        }
        associated.non_associated = false;
        let mut other = asked.collapse_of(&associated).unwrap_or_else(|| answer.clone());
        other.factor = other.factor.map(|factor| 1.01 * factor);
        other.non_associated = Some(NonAssociated {
            proved_lower: other.factor,
            lower_proof: Some(LowerProof::by(LowerProofKind::Associated)),
            ..NonAssociated::default()
        });
        Some(other)
    }),
];
