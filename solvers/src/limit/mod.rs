//! Limit analysis: the greatest factor at which rigid blocks can be in admissible equilibrium.
//!
//! [`answer`] is the sequence of questions behind every status; an [`Engine`] answers the three
//! kinds of single optimisation in it. Two engines: [`chain`] and [`conic`]. [`sequential`] and
//! [`least`] read joints with their laws' own flow instead of the associated one.

pub mod chain;
pub mod conic;
pub mod least;
mod recovery;
pub mod sequential;
mod systems;

use voussoir_core::limit::{
    Counters, JointForce, LimitAnswer, LimitProblem, LimitQuestion, LimitSolver, Status, Velocity,
};
use voussoir_core::model::Wrenches;

/// Whether a fixed load can be carried.
#[derive(Debug, Clone)]
pub enum Verdict {
    /// Yes: an admissible field.
    Field(Vec<JointForce>),
    /// No: a motion on which the load does more work than is dissipated, in any scale.
    Motion(Vec<Velocity>),
    /// Not decided.
    Failed(String),
}

/// The greatest factor of a varying load.
#[derive(Debug, Clone)]
pub enum Greatest {
    /// Finite: both bounds meet.
    Collapse {
        /// The factor.
        factor: f64,
        /// Admissible field at that factor.
        field: Vec<JointForce>,
        /// Mechanism with varying·q̇ = 1, in the relative interior of the optimal ones.
        motion: Vec<Velocity>,
        /// Whether it is the only one.
        unique: bool,
    },
    /// The cap was reached first: a field there.
    Capped(Vec<JointForce>),
    /// No bound: a field in the recession cone that balances the varying load alone.
    Unbounded(Vec<JointForce>),
    /// Not decided.
    Failed(String),
}

/// Something that answers single optimisations over one problem's joints.
pub trait Engine {
    /// Can these loads be carried?
    fn stand(&mut self, loads: &Wrenches) -> Verdict;

    /// Can `fixed + λ varying` be carried for some λ of either sign?
    fn possible(&mut self, fixed: &Wrenches, varying: &Wrenches) -> Verdict;

    /// The greatest λ ≤ `cap` (may be ∞) for which `fixed + λ varying` can be carried, given that
    /// some λ can.
    fn greatest(&mut self, fixed: &Wrenches, varying: &Wrenches, cap: f64) -> Greatest;

    /// Work done so far.
    fn counters(&self) -> Counters;
}

/// The answer with associated flow, by the cheapest engine.
fn associated(problem: &LimitProblem, question: LimitQuestion) -> LimitAnswer {
    let chain = chain::LimitChain {};
    let answered = (chain.refuses(problem).is_none()).then(|| chain.solve(problem, question));
    match answered {
        Some(answer) if answer.status != Status::Stalled => answer,
        _ => conic::LimitConic {}.solve(problem, question),
    }
}

/// Force that makes wrenches of size one; 1 N where they are none.
fn force_unit(problem: &LimitProblem, wrenches: &Wrenches) -> f64 {
    match problem.magnitude(wrenches) {
        0.0 => 1.0,
        magnitude => magnitude,
    }
}

/// Force scale of a program with fixed and varying loads: that of the fixed ones where there are any.
fn force_scale(problem: &LimitProblem, fixed: &Wrenches, varying: &Wrenches) -> f64 {
    force_unit(problem, if problem.magnitude(fixed) > 0.0 { fixed } else { varying })
}

/// The motion scaled so that the wrenches, about the problem's pole, have power 1 on it.
fn driven(wrenches: &Wrenches, mut motion: Vec<Velocity>) -> Vec<Velocity> {
    let power: f64 = wrenches.iter().zip(&motion).map(|(w, v)| w[0] * v[0] + w[1] * v[1] + w[2] * v[2]).sum();
    motion.iter_mut().flatten().for_each(|v| *v /= power);
    motion
}

fn combined(fixed: &Wrenches, varying: &Wrenches, factor: f64) -> Wrenches {
    let add = |(a, b): (&[f64; 3], &[f64; 3])| std::array::from_fn(|i| a[i] + factor * b[i]);
    fixed.iter().zip(varying).map(add).collect()
}

/// Answers a question with an engine: every status with its proof.
pub fn answer(problem: &LimitProblem, question: LimitQuestion, engine: &mut dyn Engine) -> LimitAnswer {
    let (start, max) = match question {
        LimitQuestion::Admissible(factor) => (factor, factor),
        LimitQuestion::Collapse { start, max } => (start, max),
    };
    let mut answer = LimitAnswer {
        status: Status::Stalled,
        factor: None,
        field_factor: start,
        field: None,
        motion: None,
        unique: None,
        ray: None,
        feasible_interval: None,
        non_associated: None,
        counters: Counters::new(),
        notes: Vec::new(),
    };
    let base = combined(&problem.fixed, &problem.varying, start);
    match engine.stand(&base) {
        Verdict::Field(field) => {
            answer.field = Some(field);
            answer.status = Status::Stands;
            if matches!(question, LimitQuestion::Collapse { .. }) {
                collapse(problem, engine, &base, start, max, &mut answer);
            }
        }
        Verdict::Motion(motion) => {
            answer.status = Status::NoEquilibrium;
            answer.motion = Some(motion);
            refuted(problem, engine, &base, start, &mut answer);
        }
        Verdict::Failed(why) => answer.notes.push(why),
    }
    answer.counters = engine.counters();
    answer
}

/// The base load is carried: how much more?
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
    match engine.greatest(base, &problem.varying, max - start) {
        Greatest::Collapse { factor, field, motion, unique } => {
            // Rounding of a zero factor is not a factor.
            let dead = problem.magnitude(base);
            let unit = if dead > 0.0 { dead / problem.magnitude(&problem.varying) } else { 1.0 };
            let factor = if factor.abs() < 1e-15 * unit { 0.0 } else { factor };
            answer.status = Status::Collapse;
            answer.factor = Some(start + factor);
            answer.field_factor = start + factor;
            answer.field = Some(field);
            answer.motion = Some(motion);
            answer.unique = Some(unique);
        }
        Greatest::Capped(field) => {
            answer.field_factor = max;
            answer.field = Some(field);
        }
        Greatest::Unbounded(ray) => {
            answer.status = Status::Unbounded;
            answer.ray = Some(ray);
        }
        Greatest::Failed(why) => {
            answer.status = Status::Stalled;
            answer.notes.push(why);
        }
    }
}

/// The base load is not carried: is there a factor at which it would be?
fn refuted(problem: &LimitProblem, engine: &mut dyn Engine, base: &Wrenches, start: f64, answer: &mut LimitAnswer) {
    if problem.magnitude(&problem.varying) == 0.0 {
        return;
    }
    match engine.possible(base, &problem.varying) {
        Verdict::Field(_) => {}
        Verdict::Motion(motion) => {
            answer.motion = Some(motion);
            answer.notes.push("no factor of the last stage's loads makes equilibrium possible".into());
            return;
        }
        Verdict::Failed(why) => return answer.notes.push(why),
    }
    let opposite: Wrenches = problem.varying.iter().map(|w| w.map(|x| -x)).collect();
    let upper = engine.greatest(base, &problem.varying, f64::INFINITY);
    let lower = engine.greatest(base, &opposite, f64::INFINITY);
    let end = |greatest: &Greatest| match greatest {
        Greatest::Collapse { factor, .. } => Some(*factor),
        Greatest::Unbounded(_) => Some(f64::INFINITY),
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
    // The motion at the near end of the interval refutes the base load as well, and is the one
    // that a reader looks for.
    let near = if interval[0] > start { lower } else { upper };
    if let Greatest::Collapse { motion, unique, .. } = near {
        answer.motion = Some(motion);
        answer.unique = Some(unique);
    }
}
