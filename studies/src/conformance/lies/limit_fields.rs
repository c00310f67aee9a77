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
    LimitLie { name: "factor_5_percent_high", tell: |asked| factor(asked, |factor| 1.05 * factor) },
    LimitLie { name: "factor_5_percent_low", tell: |asked| factor(asked, |factor| 0.95 * factor) },
    LimitLie { name: "factor_a_millionth_high", tell: |asked| factor(asked, |factor| factor * (1.0 + 1e-6)) },
    LimitLie { name: "factor_negative", tell: |asked| factor(asked, |factor| -factor) },
    LimitLie { name: "factor_nan", tell: |asked| factor(asked, |_| f64::NAN) },
    LimitLie { name: "factor_infinite", tell: |asked| factor(asked, |_| f64::INFINITY) },
    LimitLie {
        name: "factor_of_the_field",
        tell: |asked| {
            let mut answer = asked.collapse()?;
            answer.field_factor *= 1.1;
            Some(answer)
        },
    },
    LimitLie {
        name: "all_scaled",
        tell: |asked| {
            let mut answer = asked.collapse()?;
            answer.factor = answer.factor.map(|factor| 1.1 * factor);
            answer.field_factor *= 1.1;
            scale(&mut answer.field, 1.1);
            Some(answer)
        },
    },
    LimitLie {
        name: "stopped_early",
        tell: |asked| {
            let mut answer = asked.collapse()?;
            let half = asked.field_at(answer.factor? / 2.0)?;
            (answer.factor, answer.field, answer.field_factor) =
                (Some(half.field_factor), half.field, half.field_factor);
            Some(answer)
        },
    },
    LimitLie { name: "half_the_field", tell: |asked| field(asked, |field| field.truncate(field.len() / 2)) },
    LimitLie {
        name: "half_the_field_is_zero",
        tell: |asked| {
            field(asked, |field| {
                let half = field.len() / 2;
                field[half..].fill(JointForce::default());
            })
        },
    },
    LimitLie { name: "field_too_long", tell: |asked| field(asked, |field| field.push(JointForce::default())) },
    LimitLie { name: "empty_field", tell: |asked| field(asked, Vec::clear) },
    LimitLie { name: "zero_field", tell: |asked| field(asked, |field| field.fill(JointForce::default())) },
    LimitLie { name: "nan_in_the_field", tell: |asked| field(asked, |field| field[0].normal[0] = f64::NAN) },
    LimitLie { name: "infinity_in_the_field", tell: |asked| field(asked, |field| field[0].shear = f64::INFINITY) },
    LimitLie { name: "reversed_field", tell: |asked| field(asked, |field| field.reverse()) },
    LimitLie {
        name: "shear_reversed",
        tell: |asked| field(asked, |field| field.iter_mut().for_each(|force| force.shear = -force.shear)),
    },
    LimitLie {
        name: "tension",
        tell: |asked| {
            field(asked, |field| field.iter_mut().for_each(|force| force.normal = force.normal.map(|normal| -normal)))
        },
    },
    LimitLie { name: "half_the_motion", tell: |asked| motion(asked, |motion| motion.truncate(motion.len() / 2)) },
    LimitLie { name: "empty_motion", tell: |asked| motion(asked, Vec::clear) },
    LimitLie { name: "no_motion", tell: |asked| motion(asked, |motion| motion.fill([0.0; 3])) },
    LimitLie { name: "nan_in_the_motion", tell: |asked| motion(asked, |motion| motion[0][0] = f64::NAN) },
    LimitLie { name: "infinity_in_the_motion", tell: |asked| motion(asked, |motion| motion[0][2] = f64::INFINITY) },
    LimitLie {
        name: "motion_not_scaled",
        tell: |asked| motion(asked, |motion| motion.iter_mut().flatten().for_each(|v| *v *= 2.0)),
    },
    LimitLie {
        name: "motion_backwards",
        tell: |asked| motion(asked, |motion| motion.iter_mut().flatten().for_each(|v| *v = -*v)),
    },
    LimitLie {
        name: "motion_mirrored",
        tell: |asked| {
            motion(asked, |motion| {
                motion.reverse();
                motion.iter_mut().for_each(|[x, _, turn]| (*x, *turn) = (-*x, -*turn));
            })
        },
    },
    LimitLie {
        name: "motion_without_turns",
        tell: |asked| motion(asked, |motion| motion.iter_mut().for_each(|velocity| velocity[2] = 0.0)),
    },
    LimitLie {
        name: "called_unique",
        tell: |asked| {
            let mut answer = asked.collapse()?;
            answer.unique = Some(true);
            Some(answer)
        },
    },
    LimitLie { name: "lower_bound_without_a_proof", tell: |asked| lower(asked, 1.2, None) },
    LimitLie {
        name: "lower_bound_by_a_search",
        tell: |asked| lower(asked, 1.0, Some(LowerProof::by(LowerProofKind::Search))),
    },
    LimitLie {
        name: "lower_bound_above_the_truth",
        tell: |asked| lower(asked, 1.5, Some(LowerProof::by(LowerProofKind::Search))),
    },
    LimitLie {
        name: "lower_bound_called_associated",
        tell: |asked| lower(asked, 1.0, Some(LowerProof::by(LowerProofKind::Associated))),
    },
    LimitLie {
        name: "lower_bound_of_no_products",
        tell: |asked| lower(asked, 1.0, Some(LowerProof::by(LowerProofKind::Products))),
    },
    LimitLie {
        name: "lower_bound_of_forged_products",
        tell: |asked| {
            let steps = vec![ProductStep {
                range: [0.0, 1e3],
                bound: 1e3,
                multipliers: vec![(i64::MAX, vec![(-2, f64::NAN), (i64::MIN, 1.0)])],
            }];
            lower(asked, 1.0, Some(LowerProof { by: LowerProofKind::Products, steps }))
        },
    },
    LimitLie { name: "lower_bound_nan", tell: |asked| lower(asked, f64::NAN, None) },
    LimitLie {
        name: "associated_factor_below",
        tell: |asked| {
            let mut answer = asked.collapse()?;
            let half = answer.factor.map(|factor| factor / 2.0);
            let own = NonAssociated { associated_factor: half, ..answer.non_associated.take().unwrap_or_default() };
            answer.non_associated = Some(own);
            Some(answer)
        },
    },
    LimitLie {
        name: "associated_factor_above",
        tell: |asked| {
            let mut answer = asked.collapse()?;
            let more = answer.factor.map(|factor| 1.5 * factor);
            let motion = answer.motion.clone();
            let own = answer.non_associated.take().unwrap_or_default();
            let own = NonAssociated { associated_factor: more, associated_motion: motion, ..own };
            answer.non_associated = Some(own);
            Some(answer)
        },
    },
    LimitLie {
        name: "associated_answer_as_non_associated",
        tell: |asked| {
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
        },
    },
];
