//! The sequence of programs that answers a question.

use super::by_clarabel;
use super::evidence::{Evidence, Field};
use super::interior_point::{InteriorPoint, greatest};
use super::program::{Bodies, Program, Side};
use super::settings::SETTINGS;
use super::uniqueness;
use voussoir_core::limit::{Counters, LimitQuestion, Status};
use voussoir_core::model::root;
use voussoir_core::space::{SpaceAnswer, SpaceContact, SpaceProblem, SpaceVelocity, power};

const IDLE: &str = "every load of this stage acts on bodies that the ground holds";
const NOT_CLOSED: &str = "the proved bounds of the factor do not meet";

const BRACKETED: &str = "tractions are limited: forces at points inside each contact bound the factor from below, motions at points around \
     from above. A greater `subdivisions` of [solver] brings the bounds closer";

/// A method that solves one program. `held`: only the loads at the start.
type Method = fn(&Program, bool, &mut Counters) -> Option<Evidence>;

/// Answers a question about a problem with associated flow, without panic. The interior point method of this crate is
/// tried first, then Clarabel. Strengths that are more than a cone are left to Clarabel.
pub fn solve(problem: &SpaceProblem, question: LimitQuestion) -> SpaceAnswer {
    if !problem.is_exact() {
        return solve_by_clarabel(problem, question);
    }
    let answer = answer(problem, question, run);
    if answer.status.is_answer() {
        return answer;
    }
    let mut second = solve_by_clarabel(problem, question);
    if !second.status.is_answer() {
        return answer;
    }
    second.notes.push("the interior point method of this project did not settle the question; Clarabel did".into());
    second
}

/// Answers a question with Clarabel in place of the interior point method of this crate, and with the same repair.
pub fn solve_by_clarabel(problem: &SpaceProblem, question: LimitQuestion) -> SpaceAnswer {
    answer(problem, question, by_clarabel::run)
}

/// Returns the reason why a problem cannot be solved.
fn misfit(problem: &SpaceProblem) -> Option<&'static str> {
    let SpaceProblem { bodies, contacts, fixed, varying, .. } = problem;
    if fixed.len() != *bodies || varying.len() != *bodies {
        return Some("the problem does not have one wrench for each free body");
    }
    let fits = |contact: &SpaceContact| {
        let known = [contact.minus, contact.plus].into_iter().flatten().all(|body| body < *bodies);
        let sets = [&contact.inner, &contact.outer];
        let points = sets.iter().flat_map(|set| &set.points).chain(&contact.frame).flat_map(|x| x.iter());
        let law = &contact.law;
        let numbers = sets.iter().flat_map(|set| &set.areas);
        let numbers = numbers.chain([&law.friction, &law.cohesion, &law.tensile_strength, &law.compressive_strength]);
        known
            && contact.minus != contact.plus
            && sets.iter().all(|set| set.points.len() == set.areas.len())
            && points.copied().all(f64::is_finite)
            && numbers.copied().all(|x| x >= 0.0)
    };
    if !contacts.iter().all(fits) || !fixed.iter().chain(varying).flatten().all(|x| x.is_finite()) {
        return Some("a contact joins a body that does not exist, or a number is not finite");
    }
    None
}

/// Answers a question with one method.
fn answer(problem: &SpaceProblem, question: LimitQuestion, method: Method) -> SpaceAnswer {
    if let Some(why) = misfit(problem) {
        return SpaceAnswer::stalled(why);
    }
    let (start, max) = match question {
        LimitQuestion::Admissible(factor) => (factor, factor),
        LimitQuestion::Collapse { start, max } => (start, max),
    };
    if !start.is_finite() {
        return SpaceAnswer::stalled("the factor at the start is not finite");
    }
    let program = Program::new(problem, start, Side::Inner);
    let outer = (!problem.is_exact()).then(|| Program::new(problem, start, Side::Outer));
    let search = matches!(question, LimitQuestion::Collapse { .. });
    let mut case = Case { problem, program: &program, outer: outer.as_ref(), counters: Counters::new() };
    if let Some(motion) = fall(problem, &program) {
        return case.refuted(&motion);
    }
    let mut answer = if search && greatest(&program.varying) > 0.0 {
        case.collapse(method, max)
    } else {
        case.admissible(method, search)
    };
    answer.counters = case.counters;
    answer
}

/// Returns the translation of a group of bodies that no chain of contacts joins to the ground, along the resultant of its loads at
/// the start. `None` if no such group has a resultant.
fn fall(problem: &SpaceProblem, program: &Program) -> Option<Bodies> {
    let ground = problem.bodies;
    let mut parent: Vec<usize> = (0..=ground).collect();
    for contact in &problem.contacts {
        let ends = [contact.minus, contact.plus].map(|body| root(&mut parent, body.unwrap_or(ground)));
        parent[ends[0]] = ends[1];
    }
    let roots: Vec<usize> = (0..=ground).map(|body| root(&mut parent, body)).collect();
    let mut sums = vec![([0.0; 3], 0.0); ground + 1];
    for (body, load) in program.base.chunks_exact(6).enumerate().filter(|(body, _)| roots[*body] != roots[ground]) {
        let (sum, size) = &mut sums[roots[body]];
        (0..3).for_each(|i| sum[i] += load[i]);
        *size += greatest(&load[..3]);
    }
    let of = sums.iter().position(|(sum, size)| greatest(sum) > SETTINGS.balanced * size)?;
    let moved = |body: usize| if roots[body] == of { sums[of].0 } else { [0.0; 3] };
    Some((0..ground).flat_map(|body| moved(body).into_iter().chain([0.0; 3])).collect())
}

/// A question in work.
struct Case<'a> {
    problem: &'a SpaceProblem,
    program: &'a Program,
    /// The outer points, if they differ.
    outer: Option<&'a Program>,
    counters: Counters,
}

impl Case<'_> {
    /// Solves the program of the inner points; if the outer points differ, their program gives the motions.
    fn evidence(&mut self, method: Method, held: bool) -> Option<Evidence> {
        let mut evidence = method(self.program, held, &mut self.counters)?;
        // A field at the start needs no motion beside it.
        if let Some(outer) = self.outer.filter(|_| !(held && evidence.start.is_some())) {
            let around = method(outer, held, &mut self.counters)?;
            (evidence.upper, evidence.refutation, evidence.unique) = (around.upper, around.refutation, None);
        }
        Some(evidence)
    }

    /// Returns the factor of the problem for one of the program.
    fn factor(&self, lambda: f64) -> f64 {
        self.program.start + lambda * self.program.unit
    }

    fn with_field(&self, status: Status, field: &Field) -> SpaceAnswer {
        let forces = Some(self.program.forces(&field.y));
        SpaceAnswer { status, field_factor: self.factor(field.lambda), field: forces, ..SpaceAnswer::default() }
    }

    /// Returns the answer that a motion refutes equilibrium at the start. Its greatest component is one.
    fn refuted(&self, q: &[f64]) -> SpaceAnswer {
        let mut motion = self.program.motion(q);
        let most = greatest(motion.as_flattened());
        motion.iter_mut().flatten().for_each(|v| *v /= most);
        SpaceAnswer {
            status: Status::NoEquilibrium,
            field_factor: self.program.start,
            motion: Some(motion),
            ..SpaceAnswer::default()
        }
    }

    /// Returns a motion with unit power of the varying loads.
    fn scaled(&self, q: &[f64]) -> Vec<SpaceVelocity> {
        let mut motion = self.program.motion(q);
        let unit = power(&self.problem.varying, &motion);
        motion.iter_mut().flatten().for_each(|v| *v /= unit);
        motion
    }

    /// Finds a field at the start or a refutation of it.
    fn held(&mut self, method: Method) -> Result<Field, Box<SpaceAnswer>> {
        let still = self.program.without_forces();
        if greatest(&self.program.imbalance(&still, 0.0, 1.0)) == 0.0 {
            return Ok(Field { lambda: 0.0, y: still });
        }
        let Some(evidence) = self.evidence(method, true) else {
            return Err(Box::new(SpaceAnswer::stalled("memory is short")));
        };
        match (evidence.start, evidence.refutation) {
            (Some(field), _) => Ok(field),
            (None, Some(q)) => Err(Box::new(self.refuted(&q))),
            (None, None) => Err(Box::new(SpaceAnswer::stalled(
                "neither a field at the start nor a motion that refutes it was found",
            ))),
        }
    }

    /// Answers a question without varying loads.
    fn admissible(&mut self, method: Method, search: bool) -> SpaceAnswer {
        match self.held(method) {
            Ok(field) if search => {
                let ray = Some(self.program.differences(&vec![[0.0; 3]; self.program.points.len()]));
                SpaceAnswer { ray, notes: vec![IDLE.into()], ..self.with_field(Status::Unbounded, &field) }
            }
            Ok(field) => self.with_field(Status::Stands, &field),
            Err(answer) => *answer,
        }
    }

    /// Finds the greatest factor.
    fn collapse(&mut self, method: Method, max: f64) -> SpaceAnswer {
        let Some(mut evidence) = self.evidence(method, false) else {
            return SpaceAnswer::stalled("memory is short");
        };
        if evidence.start.is_none() {
            // Equilibrium at the start follows only for a factor above it.
            match self.held(method) {
                Ok(field) => evidence.start = Some(field),
                Err(refuted) if refuted.status == Status::NoEquilibrium => return self.refutation(&evidence, *refuted),
                Err(answer) => return self.proved(&evidence, *answer),
            }
        }
        if let (Some(ray), Some(start)) = (&evidence.ray, &evidence.start) {
            return self.unbounded(method, ray, start);
        }
        if evidence.lower.is_none() {
            evidence.lower = evidence.start.clone();
        }
        let cap = (max - self.program.start) / self.program.unit;
        if let Some(field) = evidence.between(cap) {
            return SpaceAnswer { field_factor: max, ..self.with_field(Status::Stands, &field) };
        }
        let why = if self.outer.is_some() { BRACKETED } else { NOT_CLOSED };
        let answer = SpaceAnswer { notes: vec![why.into()], ..SpaceAnswer::default() };
        self.proved(&evidence, answer)
    }

    /// Returns the answer with both bounds, and the status collapse if they meet.
    fn proved(&self, evidence: &Evidence, otherwise: SpaceAnswer) -> SpaceAnswer {
        let (Some(lower), Some(upper)) = (&evidence.lower, &evidence.upper) else {
            return otherwise;
        };
        if upper.bound.is_infinite() {
            return SpaceAnswer { notes: otherwise.notes, ..self.with_field(Status::Open, lower) };
        }
        let size = self.factor(lower.lambda).abs().max(SETTINGS.least_factor * self.program.unit);
        let closed = evidence.gap() * self.program.unit <= SETTINGS.closed * size && evidence.start.is_some();
        let (status, notes) = if closed { (Status::Collapse, Vec::new()) } else { (Status::Open, otherwise.notes) };
        SpaceAnswer {
            factor: Some(self.factor(lower.lambda)),
            motion: Some(self.scaled(&upper.q)),
            unique: evidence.unique.filter(|_| closed),
            notes,
            ..self.with_field(status, lower)
        }
    }

    /// Returns the refutation of the start, with the interval of factors that carry in the notes.
    fn refutation(&self, evidence: &Evidence, mut refuted: SpaceAnswer) -> SpaceAnswer {
        if let (Some(upper), Some(lower)) = (&evidence.upper, &evidence.lower) {
            let (greatest, reached) = (self.factor(upper.bound), self.factor(lower.lambda));
            let start = self.program.start;
            refuted.notes.push(format!(
                "equilibrium is impossible at the factor {start} at which the stage begins; the greatest factor with equilibrium lies between {reached:.9} and {greatest:.9}"
            ));
        }
        refuted
    }

    fn unbounded(&mut self, method: Method, ray: &[[f64; 3]], start: &Field) -> SpaceAnswer {
        // The ray balances the varying loads of the program.
        let unit = self.program.unit;
        let mut forces = self.program.differences(ray);
        forces.iter_mut().flatten().flatten().for_each(|f| *f /= unit);
        let program = self.program.of_self_stress();
        let stress = method(&program, false, &mut self.counters).is_some_and(|evidence| evidence.ray.is_some());
        SpaceAnswer { ray: Some(forces), self_stress: stress, ..self.with_field(Status::Unbounded, start) }
    }
}

/// Solves a program by the interior point method of this crate. `None` if memory is short.
fn run(program: &Program, held: bool, counters: &mut Counters) -> Option<Evidence> {
    let mut method = InteriorPoint::new(program, held)?;
    let mut evidence = Evidence::default();
    let mut steps = 0;
    while steps < SETTINGS.steps && method.factorise().is_some() {
        evidence.collect(&mut method);
        if ended(&evidence, &method) {
            break;
        }
        if method.is_solvable() && !method.settled {
            method.settle();
            if method.factorise().is_none() {
                break;
            }
        }
        steps += 1;
        if method.step() < SETTINGS.least_step {
            break;
        }
    }
    if evidence.gap().is_finite() && ended(&evidence, &method) {
        evidence.unique = uniqueness::unique(&mut method);
    }
    if !ended(&evidence, &method) {
        let lambda = if held { 0.0 } else { method.state.lambda / method.state.tau };
        evidence.repair(program, method.state.forces(method.state.tau), lambda);
    }
    let mut count = |name: &str, by: u64| *counters.entry(name.into()).or_default() += by;
    count("programs", 1);
    count("interior_point_iterations", steps);
    count("factorisations", method.stiffness.factorisations);
    Some(evidence)
}

/// Returns true if a program is decided.
fn ended(evidence: &Evidence, method: &InteriorPoint) -> bool {
    let refuted = evidence.refutation.is_some() && (method.held || method.state.kappa > method.state.tau);
    evidence.is_within(SETTINGS.aim) || (method.held && evidence.start.is_some()) || evidence.ray.is_some() || refuted
}
