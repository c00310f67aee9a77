//! The sequence of questions that leads to every status of limit analysis with associated flow.

use super::engine::{Engine, Equilibrium, GreatestFactor};
use super::floating::loose_motion;
use super::problem::{JointForce, LimitProblem};
use super::scale::combined;
use super::solver::{LimitAnswer, LimitQuestion};
use super::status::Status;
use crate::model::Wrenches;

/// Factor, in the unit in which both loads have the same size, below which it is rounding of zero.
const ZERO: f64 = 1e-15;

const IMPOSSIBLE: &str = "no factor of the last stage's loads makes equilibrium possible";

/// Answers a question with an engine. Every status has a proof.
pub fn answer_by(problem: &LimitProblem, question: LimitQuestion, engine: &mut dyn Engine) -> LimitAnswer {
    let (start, max) = match question {
        LimitQuestion::Admissible(factor) => (factor, factor),
        LimitQuestion::Collapse { start, max } => (start, max),
    };
    let mut answer = LimitAnswer { field_factor: start, ..LimitAnswer::default() };
    let base = combined(&problem.fixed, &problem.varying, start);
    if let Some(motion) = loose_motion(problem, &base, &problem.varying) {
        return LimitAnswer { field_factor: start, ..LimitAnswer::no_equilibrium(motion).noting(IMPOSSIBLE) };
    }
    let grows = matches!(question, LimitQuestion::Collapse { .. }) && problem.magnitude(&problem.varying) > 0.0;
    let at_once = if grows { engine.greatest_if_carried(&base, &problem.varying, max - start) } else { None };
    if let Some((field, greatest)) = at_once {
        answer.start_field = Some(field);
        answer.status = Status::Stands;
        carried(problem, greatest, &base, (start, max), &mut answer);
        answer.counters = engine.counters();
        return answer;
    }
    // Without loads zero forces are a field; a solver would divide by a zero scale.
    let idle = problem.magnitude(&base) == 0.0;
    let nothing = || Equilibrium::Field(vec![JointForce::default(); problem.joints.len()]);
    let carries = |engine: &mut dyn Engine| if grows { engine.carried(&base) } else { engine.admissible(&base) };
    match if idle { nothing() } else { carries(engine) } {
        Equilibrium::Field(field) => {
            answer.start_field = grows.then(|| field.clone());
            answer.field = Some(field);
            answer.status = Status::Stands;
            if matches!(question, LimitQuestion::Collapse { .. }) {
                collapse(problem, engine, &base, start, max, &mut answer);
            }
            // The field shown at the start is the field furthest from all bounds.
            if grows
                && !idle
                && answer.field_factor == start
                && matches!(answer.status, Status::Unbounded | Status::Stalled)
                && let Equilibrium::Field(field) = engine.admissible(&base)
            {
                answer.field = Some(field);
            }
        }
        Equilibrium::Motion(motion) => {
            answer.status = Status::NoEquilibrium;
            answer.motion = Some(motion);
            refuted(problem, engine, &base, start, &mut answer);
        }
        Equilibrium::Failed(why) => answer.notes.push(why),
    }
    answer.counters = engine.counters();
    answer
}

/// The base load is carried: finds the greatest factor.
fn collapse(
    problem: &LimitProblem,
    engine: &mut dyn Engine,
    base: &Wrenches,
    start: f64,
    max: f64,
    answer: &mut LimitAnswer,
) {
    if problem.magnitude(&problem.varying) == 0.0 {
        answer.notes.push("every load of this stage acts on what the ground holds".into());
        answer.status = Status::Unbounded;
        answer.ray = Some(vec![JointForce::default(); problem.joints.len()]);
        return;
    }
    let greatest = engine.greatest(base, &problem.varying, max - start);
    carried(problem, greatest, base, (start, max), answer);
}

/// Returns the answer for the greatest factor from a base load that is carried.
fn carried(
    problem: &LimitProblem,
    greatest: GreatestFactor,
    base: &Wrenches,
    (start, max): (f64, f64),
    answer: &mut LimitAnswer,
) {
    match greatest {
        GreatestFactor::Collapse { factor, field, motion, unique } => {
            // A factor within rounding of zero is zero.
            let dead = problem.magnitude(base);
            let unit = if dead > 0.0 { dead / problem.magnitude(&problem.varying) } else { 1.0 };
            let factor = if factor.abs() < ZERO * unit { 0.0 } else { factor };
            answer.status = Status::Collapse;
            answer.factor = Some(start + factor);
            answer.field_factor = start + factor;
            answer.field = Some(field);
            answer.motion = Some(motion);
            answer.unique = unique;
        }
        GreatestFactor::Capped(field) => {
            answer.field_factor = max;
            answer.field = Some(field);
        }
        GreatestFactor::Unbounded(ray) => {
            answer.status = Status::Unbounded;
            answer.ray = Some(ray);
        }
        GreatestFactor::Failed(why) => {
            answer.status = Status::Stalled;
            answer.notes.push(why);
        }
    }
}

/// The base load is not carried: finds out if another factor would be.
fn refuted(problem: &LimitProblem, engine: &mut dyn Engine, base: &Wrenches, start: f64, answer: &mut LimitAnswer) {
    if problem.magnitude(&problem.varying) == 0.0 {
        return;
    }
    match engine.possible(base, &problem.varying) {
        Equilibrium::Field(_) => {}
        Equilibrium::Motion(motion) => {
            answer.motion = Some(motion);
            answer.notes.push(IMPOSSIBLE.into());
            return;
        }
        Equilibrium::Failed(why) => return answer.notes.push(why),
    }
    let opposite: Wrenches = problem.varying.iter().map(|w| w.map(|x| -x)).collect();
    let upper = engine.greatest(base, &problem.varying, f64::INFINITY);
    let lower = engine.greatest(base, &opposite, f64::INFINITY);
    let end = |greatest: &GreatestFactor| match greatest {
        GreatestFactor::Collapse { factor, .. } => Some(*factor),
        GreatestFactor::Unbounded(_) => Some(f64::INFINITY),
        _ => None,
    };
    let (Some(high), Some(low)) = (end(&upper), end(&lower)) else {
        return answer.notes.push("the interval of factors with equilibrium could not be found".into());
    };
    let interval = [start - low, start + high];
    answer.feasible_interval = Some(interval);
    answer.notes.push(format!(
        "equilibrium is impossible at the factor {start} at which the stage begins; it is possible only for factors from {:.9} to {:.9}: do not read either end as safe",
        interval[0], interval[1]
    ));
    // The motion at the near end of the interval also refutes the base load, and is the most useful one to show.
    let near = if interval[0] > start { lower } else { upper };
    if let GreatestFactor::Collapse { motion, unique, .. } = near {
        answer.motion = Some(motion);
        answer.unique = unique;
    }
}
