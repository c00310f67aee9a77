//! `sensitivities = true`: derivatives of the load factor of limit analysis with respect to every number of the study.
//!
//! The problem is assembled again at two values on each side of a number, with the same joints and blocks. The derivative
//! follows from the differences of the data and from the optimal face of the result: no problem is solved again.

use super::restated::restated;
use crate::caught::caught;
use crate::results::{CaseResult, SensitivityEntry};
use crate::study::{Case, NumberKind, NumericKey, numeric_keys, study_keys};
use serde_json::json;
use voussoir_core::limit::{JointForce, LimitProblem, Status, Velocity};
use voussoir_core::model::geometry::turned;
use voussoir_core::model::{Target, stage_loads};
use voussoir_core::plugin::{PluginKind, Quantity, card};
use voussoir_solvers::limit::sensitivity::{DataRate, OptimalFace, same_data};

/// Step of the differences of data, as a share of the number.
const STEP: f64 = 1e-5;
/// Relative difference up to which two derivatives are equal.
const KINK: f64 = 1e-6;

/// Derivatives below this, relative to factor over number, are zero.
const NOTHING: f64 = 1e-9;

/// Returns the scale of a number that is zero, in the unit of its quantity.
fn usual(quantity: Quantity) -> f64 {
    match quantity {
        Quantity::Ratio | Quantity::Length | Quantity::Radians => 1.0,
        Quantity::Degrees => 10.0,
        Quantity::Force | Quantity::Density => 1e3,
        Quantity::Stress => 1e6,
        Quantity::Stiffness => 1e10,
        Quantity::Acceleration => 10.0,
        Quantity::EnergyPerArea | Quantity::Temperature => 100.0,
        Quantity::Time => 86_400.0,
    }
}

/// Returns the problem of the stage that collapses.
fn problem_of(case: &Case) -> Result<LimitProblem, String> {
    let loads = stage_loads(&case.assembly, &case.stages);
    let last = loads.last().ok_or("the study has no stage")?;
    LimitProblem::new(&case.assembly, last)
}

/// Returns the problem of the case with some numbers changed.
fn assembled(case: &Case, changed: Option<(&str, f64)>) -> Result<LimitProblem, String> {
    problem_of(&restated(case, changed.map(|(key, value)| (key.to_string(), json!(value))))?)
}

/// Returns the forces in the joints of the problem, from the forces of a result.
fn forces(problem: &LimitProblem, result: &CaseResult) -> Result<Vec<JointForce>, String> {
    let field = result.proof.field.as_deref().unwrap_or_default();
    let mut contacts = field.iter();
    let mut next = || contacts.next().ok_or("the result holds no whole field");
    let joint = |fill: Option<usize>| -> Result<JointForce, String> {
        if let Some(index) = fill {
            let own = result.proof.fill.get(index).ok_or("the result holds no force of the fill")?;
            return Ok(JointForce { normal: [own.force - own.bounds[0], 0.0], shear: 0.0 });
        }
        let [a, b] = [next()?.force, next()?.force];
        Ok(JointForce { normal: [a[0], b[0]], shear: a[1] + b[1] })
    };
    problem.joints.iter().map(|joint| joint.fill).map(joint).collect()
}

/// Returns the velocities of the problem's groups about its pole, from the velocities of a result's blocks.
fn motion(case: &Case, problem: &LimitProblem, result: &CaseResult) -> Result<Vec<Velocity>, String> {
    let entries = result.proof.motion.as_deref().ok_or("the result holds no mechanism")?;
    let mut motion = vec![[0.0; 3]; problem.groups];
    for (body, group) in problem.group_of.iter().enumerate() {
        let (Some(group), Some(entry)) = (group, entries.get(body)) else { continue };
        let [x, y, omega] = entry.velocity;
        let back = turned(problem.pole - case.assembly.inertia(body).centroid) * omega;
        motion[*group] = [x + back.x, y + back.y, omega];
    }
    Ok(motion)
}

/// Returns the left and right derivatives of a collapse load with respect to these numbers, 0 if it does not depend on one.
/// `None` if one of them does not exist.
pub fn derivatives(case: &Case, result: &CaseResult, keys: &[&str]) -> Option<Vec<[f64; 2]>> {
    let numbers = numeric_keys(study_keys(), &case.resolved.to_json(), usize::MAX);
    let number = |key: &&str| numbers.iter().find(|number| number.key == **key).cloned();
    let numbers: Vec<NumericKey> = keys.iter().map(number).collect::<Option<_>>()?;
    let found = caught(|| of_numbers(case, result, &numbers)).ok()?.ok()?;
    let sides = |key: &&str| match found.iter().find(|entry| entry.key == **key) {
        Some(entry) => Some([entry.left?, entry.right?]),
        None => Some([0.0; 2]),
    };
    keys.iter().map(sides).collect()
}

/// Returns the derivatives of a collapse load with respect to all numbers that influence it. The error gives the reason if
/// this is not possible.
pub fn sensitivities(case: &Case, result: &CaseResult) -> Result<Vec<SensitivityEntry>, String> {
    of_numbers(case, result, &case.output_sensitivities)
}

/// Returns the derivatives with respect to these numbers.
fn of_numbers(case: &Case, result: &CaseResult, numbers: &[NumericKey]) -> Result<Vec<SensitivityEntry>, String> {
    if case.space.is_some() {
        return Err("they exist for plane scenes only".into());
    }
    let factor = result.load_factor.filter(|_| result.status == Status::Collapse && result.certificate.passed);
    let factor = factor.ok_or("there is no collapse load to differentiate")?;
    if card(PluginKind::LimitSolver, &result.solver).is_none() {
        return Err("only limit analysis gives them, this is a path".into());
    }
    let last = case.stages.last().filter(|stage| stage.target == Target::Collapse);
    if last.is_none_or(|stage| result.stages.last().is_none_or(|done| done.name != stage.name)) {
        return Err("the structure collapses in an earlier stage than the last".into());
    }
    let problem = problem_of(case)?;
    if problem.non_associated {
        return Err("a joint law flows otherwise than associated: the load is no optimum".into());
    }
    if !same_data(&problem, &assembled(case, None)?) {
        return Err("the case cannot be assembled again from its own numbers".into());
    }
    let forces = forces(&problem, result)?;
    let face = OptimalFace::new(&problem, factor, &forces, &motion(case, &problem, result)?)?;
    Ok(numbers.iter().filter_map(|key| entry(case, &problem, &face, key, factor)).collect())
}

/// Returns the derivative with respect to one number; `None` if the data do not depend on it.
fn entry(
    case: &Case,
    problem: &LimitProblem,
    face: &OptimalFace,
    key: &NumericKey,
    factor: f64,
) -> Option<SensitivityEntry> {
    let (NumberKind::Real(quantity, _), Some(value)) = (key.kind, key.value) else { return None };
    let scale = if value == 0.0 { usual(quantity) } else { value.abs() };
    let side = |sense: f64| -> Result<Option<f64>, String> {
        let at = |steps: f64| assembled(case, Some((&key.key, value + sense * steps * STEP * scale)));
        let (near, far) = (at(1.0)?, at(2.0)?);
        if same_data(problem, &near) {
            return Ok(None);
        }
        let rate = DataRate::one_sided(problem, [&near, &far], STEP)?;
        Ok(Some(sense * face.derivative(&rate)? / scale))
    };
    let (left, right) = (side(-1.0), side(1.0));
    if let (Ok(None), Ok(None)) = (&left, &right) {
        return None;
    }
    let why = [&left, &right].into_iter().find_map(|side| side.as_ref().err().cloned());
    // A derivative below the resolution of the program is zero.
    let tidy = |slope: f64| if slope.abs() <= NOTHING * factor.abs() / scale { 0.0 } else { slope };
    let slope = |side: Result<Option<f64>, String>| side.ok().map(|slope| tidy(slope.unwrap_or(0.0)));
    let (left, right) = (slope(left), slope(right));
    let kink = left.zip(right).is_some_and(|(left, right)| {
        (left - right).abs() > KINK * left.abs().max(right.abs()).max(1e-3 * factor.abs() / scale)
    });
    Some(SensitivityEntry { key: key.key.clone(), value, left, right, kink, why })
}
