//! The sequence of linear programs with fictitious cohesion that converges to a state with the laws' own flow.

use super::vertices::Vertices;
use crate::limit::conic;
use crate::limit::settings::SETTINGS;
use crate::limit::systems::{LARGEST, Systems, greatest_shares};
use crate::optimise::dense_simplex::Feasibility;
use voussoir_core::limit::{Counters, GreatestFactor, JointForce, LimitProblem, Velocity, combined};
use voussoir_core::model::Wrenches;

/// The first programs.
const STRICT_PROGRAMS: usize = 36;
/// Greatest number of programs.
const MAX_PROGRAMS: usize = 120;
/// Number of programs solved at vertices before fields in the middle of the optimal ones are used. If the field is not
/// unique, vertices may jump, but the middle changes continuously with the bounds.
const VERTEX_PROGRAMS: usize = 48;

/// A state with the laws' own flow.
#[derive(Debug, Clone)]
pub struct FlowState {
    /// Factor above the base loads.
    pub factor: f64,
    /// Field.
    pub field: Vec<JointForce>,
    /// Mechanism.
    pub motion: Vec<Velocity>,
}

/// The end of a sequence.
pub struct Sequence {
    /// The state to which the programs converge; otherwise the state of the least factor among the mechanisms of the last programs.
    pub state: Option<FlowState>,
    /// Why the programs do not converge.
    pub open: Option<String>,
}

impl Sequence {
    fn converged(state: FlowState) -> Self {
        Sequence { state: Some(state), open: None }
    }

    fn open(why: String, state: Option<FlowState>) -> Self {
        Sequence { state, open: Some(why) }
    }
}

/// Returns the problem with each non-associated row replaced by an associated row with its flow, through the yield
/// point at the normal forces of `reference`: d·r ≤ b + (d − a)·r̄.
fn fictitious(problem: &LimitProblem, reference: &[JointForce]) -> LimitProblem {
    let mut replaced = problem.clone();
    for (joint, force) in replaced.joints.iter_mut().zip(reference) {
        let at = [force.normal[0], force.normal[1], force.shear];
        for row in joint.strength.rows.iter_mut().filter(|row| row.flow != row.normal) {
            let relief: f64 = (0..3).map(|k| (row.flow[k] - row.normal[k]) * at[k]).sum();
            row.bound += relief.max(0.0);
            row.normal = row.flow;
        }
    }
    replaced
}

/// Returns the greatest factor of associated flow up to `most` by the conic engine, with a central optimal field.
fn by_engine(problem: &LimitProblem, base: &Wrenches, most: f64, counters: &mut Counters) -> GreatestFactor {
    let mut engine = conic::engine(problem);
    let greatest = engine.greatest(base, &problem.varying, most);
    for (name, count) in engine.counters() {
        *counters.entry(name).or_default() += count;
    }
    greatest
}

/// Runs the sequence from a field; by default the field of associated flow.
pub fn sequence(problem: &LimitProblem, base: &Wrenches, from: &[JointForce], counters: &mut Counters) -> Sequence {
    let systems = Systems::new(problem, base);
    let mut reference = from.to_vec();
    let mut vertices = Vertices::new(problem, &systems);
    let mut last = f64::NAN;
    let mut course = Course::default();
    let mut last_motions: Vec<(Vec<usize>, Vec<Velocity>)> = Vec::new();
    for step in 0..MAX_PROGRAMS {
        *counters.entry("linear_programs".into()).or_default() += 1;
        if step == VERTEX_PROGRAMS {
            vertices = None;
        }
        let vertex = vertices.as_mut().and_then(|vertices| vertices.greatest(problem, &systems, &reference, counters));
        let greatest =
            vertex.unwrap_or_else(|| by_engine(&fictitious(problem, &reference), base, f64::INFINITY, counters));
        let (factor, field, motion) = match greatest {
            GreatestFactor::Collapse { factor, field, motion, .. } => (factor, field, motion),
            GreatestFactor::Failed(why) => return Sequence::open(format!("linear program {}: {why}", step + 1), None),
            _ => return Sequence::open(format!("linear program {} has no bound", step + 1), None),
        };
        let asked = if step < STRICT_PROGRAMS { SETTINGS.negligible } else { SETTINGS.closed };
        let steady = (factor - last).abs() <= asked * factor.abs().max(SETTINGS.closed * systems.unit);
        last = factor;
        let z = systems.force_variables(&field);
        let worst = (0..systems.pairs.len()).map(|i| -systems.slack(i, &z)).fold(0.0, f64::max);
        let gamma = systems.multipliers(problem, &motion);
        let moving = greatest_shares(&gamma);
        let idle = moving.iter().map(|&i| systems.slack(i, &z)).fold(0.0, f64::max);
        course.take(factor, worst, idle);
        if step + REPORTED_PROGRAMS >= MAX_PROGRAMS && last_motions.iter().all(|(known, _)| *known != moving) {
            last_motions.push((moving.clone(), motion.clone()));
        }
        if worst.max(idle) <= asked
            && let Some(state) = settled(&systems, (z, factor), motion.clone(), &moving)
        {
            return Sequence::converged(state);
        }
        // If the field is not unique, the programs may change between fields at one factor.
        if steady && let Some((field, factor)) = field_at(&systems, problem, factor, &moving) {
            return Sequence::converged(FlowState { factor, field, motion });
        }
        if steady
            && step % 8 == 7
            && let Some((field, factor)) = field_yielding(&systems, problem, base, &moving, counters)
        {
            return Sequence::converged(FlowState { factor, field, motion });
        }
        let share = share(if step < VERTEX_PROGRAMS { step } else { step - VERTEX_PROGRAMS });
        for (old, new) in reference.iter_mut().zip(&field) {
            (0..2).for_each(|k| old.normal[k] += share * (new.normal[k] - old.normal[k]));
            old.shear += share * (new.shear - old.shear);
        }
    }
    let states = last_motions
        .into_iter()
        .filter_map(|(moving, motion)| least_state(&systems, problem, base, (&moving, motion), counters));
    Sequence::open(course.verdict(), states.min_by(|a, b| a.factor.total_cmp(&b.factor)))
}

/// Returns the step length from a reference to the field of its program: half if full steps have not converged, then a
/// quarter and decreasing values, so that fields between which the programs jump are averaged.
fn share(step: usize) -> f64 {
    match step {
        0..12 => 1.0,
        12..36 => 0.5,
        _ => 0.25 * 0.95f64.powf((step - 36) as f64),
    }
}

/// Number of last programs whose factors are reported if the sequence does not converge.
const REPORTED_PROGRAMS: usize = 20;

/// Results of the last programs of a sequence.
#[derive(Default)]
struct Course {
    factors: Vec<f64>,
    violation: f64,
    idle: f64,
}

impl Course {
    fn take(&mut self, factor: f64, violation: f64, idle: f64) {
        self.factors.push(factor);
        (self.violation, self.idle) = (violation, idle);
    }

    /// Returns the reason why the sequence did not converge.
    fn verdict(&self) -> String {
        let last = &self.factors[self.factors.len().saturating_sub(REPORTED_PROGRAMS)..];
        let low = last.iter().copied().fold(f64::INFINITY, f64::min);
        let high = last.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let reason = if high - low > SETTINGS.closed * high.abs() {
            format!("their factors wander between {low:.9} and {high:.9} above the start")
        } else {
            format!("their factor stays at {high:.9} above the start, but fields and mechanisms there do not fit")
        };
        format!(
            "the sequence of {MAX_PROGRAMS} linear programs did not converge: in the last {} {reason}; the last field violates \
             yield by {:.1e} of the loads, and joints move that are {:.1e} short of it (both at most {:.0e} at a state)",
            last.len(),
            self.violation,
            self.idle,
            SETTINGS.closed
        )
    }
}

/// Returns a field at this factor, within the tolerance, in which all moving pairs yield.
fn field_at(
    systems: &Systems,
    problem: &LimitProblem,
    factor: f64,
    moving: &[usize],
) -> Option<(Vec<JointForce>, f64)> {
    if systems.entries() > LARGEST || problem.joints.iter().any(|joint| joint.strength.block.is_some()) {
        return None;
    }
    let theta = factor / systems.unit;
    let mut statics = systems.statics(Some(theta))?;
    moving.iter().for_each(|&i| statics.fix(i, true));
    if statics.feasible() != Feasibility::Point {
        return None;
    }
    let (_, true) = statics.minimise(&[(systems.theta(), -1.0)], 20_000)? else { return None };
    if statics.value(systems.theta()) < theta - SETTINGS.closed * theta.abs() {
        return None;
    }
    let slacks: Vec<f64> = (0..systems.pairs.len()).map(|i| statics.value(i).max(0.0)).collect();
    let (z, violation) = systems.field_with(&slacks)?;
    let idle = moving.iter().map(|&i| systems.slack(i, &z).abs()).fold(0.0, f64::max);
    let near = violation.max(idle) <= SETTINGS.balanced
        && (z[systems.forces] - theta).abs() <= 2.0 * SETTINGS.closed * theta.abs();
    near.then(|| (systems.joint_forces(&z), z[systems.forces] * systems.unit))
}

/// Returns such a field in scenes too large for the simplex method: the greatest factor with equality in the moving
/// rows. Any such field, with the mechanism that moves only there, is a state.
fn field_yielding(
    systems: &Systems,
    problem: &LimitProblem,
    base: &Wrenches,
    moving: &[usize],
    counters: &mut Counters,
) -> Option<(Vec<JointForce>, f64)> {
    let yielding = with_equality(problem, systems, moving);
    let greatest = by_engine(&yielding, base, f64::INFINITY, counters);
    let GreatestFactor::Collapse { factor, field, .. } = greatest else { return None };
    corrected(systems, moving, &field, factor)
}

/// Returns the state of the least factor at or above zero of the mechanism that moves in these rows: the loads of the greatest
/// factor are reduced as far as the rows permit.
fn least_state(
    systems: &Systems,
    problem: &LimitProblem,
    base: &Wrenches,
    (moving, motion): (&[usize], Vec<Velocity>),
    counters: &mut Counters,
) -> Option<FlowState> {
    let (mut field, mut factor) = field_yielding(systems, problem, base, moving, counters)?;
    let mut reduced = with_equality(problem, systems, moving);
    reduced.varying.iter_mut().flatten().for_each(|load| *load = -*load);
    let loaded = combined(base, &problem.varying, factor);
    let least = match by_engine(&reduced, &loaded, factor, counters) {
        GreatestFactor::Collapse { factor: down, field, .. } => corrected(systems, moving, &field, factor - down),
        GreatestFactor::Capped(field) => corrected(systems, moving, &field, 0.0),
        _ => None,
    };
    if let Some(least) = least.filter(|least| (0.0..factor).contains(&least.1)) {
        (field, factor) = least;
    }
    Some(FlowState { factor, field, motion })
}

/// Returns the problem with equality in the moving rows.
fn with_equality(problem: &LimitProblem, systems: &Systems, moving: &[usize]) -> LimitProblem {
    let mut yielding = problem.clone();
    let mut pair = 0;
    for (joint, &(_, count)) in yielding.joints.iter_mut().zip(&systems.variables.joints) {
        for index in 0..joint.strength.rows.len() {
            let mut row = joint.strength.rows[index];
            if row.normal[..count].iter().all(|a| *a == 0.0) {
                continue;
            }
            if moving.contains(&pair) {
                row.normal.iter_mut().for_each(|a| *a = -*a);
                row.flow = row.normal;
                row.bound = -row.bound;
                joint.strength.rows.push(row);
            }
            pair += 1;
        }
    }
    yielding
}

/// Returns a field moved by the least distance to equilibrium and onto the moving rows, with its factor.
fn corrected(systems: &Systems, moving: &[usize], field: &[JointForce], factor: f64) -> Option<(Vec<JointForce>, f64)> {
    let mut z = systems.force_variables(field);
    z.push(factor / systems.unit);
    let (z, violation) = systems.field(moving, z)?;
    (violation <= SETTINGS.balanced).then(|| (systems.joint_forces(&z), z[systems.forces] * systems.unit))
}

/// Returns a converged field, moved onto the yield surface where the mechanism moves, with the mechanism.
fn settled(
    systems: &Systems,
    (mut z, factor): (Vec<f64>, f64),
    motion: Vec<Velocity>,
    moving: &[usize],
) -> Option<FlowState> {
    z.push(factor / systems.unit);
    let near: Vec<usize> = (0..systems.pairs.len())
        .filter(|&i| systems.slack(i, &z).abs() <= 10.0 * SETTINGS.closed || moving.contains(&i))
        .collect();
    let some: Vec<usize> =
        (0..systems.pairs.len()).filter(|&i| systems.slack(i, &z) <= 0.0 || moving.contains(&i)).collect();
    let (z, _) = [near, some, moving.to_vec()]
        .into_iter()
        .filter_map(|yielding| systems.field(&yielding, z.clone()))
        .find(|(_, violation)| *violation <= SETTINGS.balanced)?;
    Some(FlowState { factor: z[systems.forces] * systems.unit, field: systems.joint_forces(&z), motion })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::limit::tests::scenes::{Dry, STUCK, block};

    /// Full steps come first, then shares that decrease to zero.
    #[test]
    fn shares_fall() {
        let shares: Vec<f64> = (0..MAX_PROGRAMS).map(share).collect();
        assert!(shares.is_sorted_by(|a, b| a >= b) && shares[0] == 1.0 && shares[MAX_PROGRAMS - 1] < 0.01);
    }

    /// The associated row of a joint that slides without dilatancy passes through the yield point of the reference: T ≤ μ N.
    #[test]
    fn fictitious_cohesion_is_the_friction_of_the_reference() {
        let problem = block(1.0, 2.0, Dry { friction: Some(0.6), associated: false, ..STUCK });
        let reference = [JointForce { normal: [0.4, 1.1], shear: 0.2 }];
        let replaced = fictitious(&problem, &reference);
        let sliding =
            replaced.joints[0].strength.rows.iter().filter(|row| row.mode == voussoir_core::law::FacetMode::Sliding);
        let bounds: Vec<f64> = sliding.map(|row| row.bound).collect();
        assert!(bounds.len() == 2 && bounds.iter().all(|bound| (bound - 0.6 * 1.5).abs() < 1e-15), "{bounds:?}");
        assert!(replaced.joints[0].strength.rows.iter().all(|row| row.flow == row.normal));
    }

    /// A verdict distinguishes factors that change from factors that stay constant.
    #[test]
    fn the_verdict_tells_whether_factors_wander() {
        let verdict = |factors: [f64; 3]| {
            let mut course = Course::default();
            factors.into_iter().for_each(|factor| course.take(factor, 0.1, 0.2));
            course.verdict()
        };
        assert!(verdict([1.0, 2.0, 1.5]).contains("wander between 1.000000000 and 2.000000000"));
        assert!(verdict([3.0; 3]).contains("stays at 3.000000000"));
    }
}
