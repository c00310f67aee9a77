//! The answer with the laws' own flow: the associated bound, and the least state that the courses find.

use super::course::{End, State, course, live_load};
use super::descent::{Descent, Dual, Found};
use super::least::Associated;
use super::point::Spring;
use super::step::Joints;
use crate::space::program::{Program, Side};
use crate::space::settings::JOINTS;
use voussoir_core::limit::{Counters, LimitQuestion, Status};
use voussoir_core::space::{SpaceAnswer, SpaceContact, SpaceNonAssociated, SpaceProblem, power};

const STRENGTHS: &str = "joints with cohesion, tension or crushing are read with associated flow";

/// Answers a question with the laws' own flow, without panic. `solve` gives the associated answer, which is the bound. It is returned
/// if no flow differs, no load varies, the dead load is not carried, or some joint is not dry. Otherwise courses of elastic joints
/// search collapse states, and the least one is the answer. Their stiffnesses differ; some start at zero stress, the others at the
/// forces of the associated load, which carry the greatest factor.
pub fn answer(problem: &SpaceProblem, question: LimitQuestion, solve: Associated) -> SpaceAnswer {
    let mut associated = solve(problem, question);
    let LimitQuestion::Collapse { start, max } = question else { return associated };
    if !problem.non_associated() || !matches!(associated.status, Status::Collapse | Status::Unbounded | Status::Open) {
        return associated;
    }
    if !problem.contacts.iter().all(|contact| contact.law.is_dry()) {
        associated.notes.push(STRENGTHS.into());
        return associated;
    }
    let program = Program::new(problem, start, Side::Inner);
    let (mut states, mut failures): (Vec<Found>, Vec<String>) = (Vec::new(), Vec::new());
    let mut counters = std::mem::take(&mut associated.counters);
    let descent = Descent { problem, solve, start };
    let zero_stress = JOINTS.ratios.map(|ratio| (ratio, None));
    let known = associated.field.as_ref().filter(|_| associated.status == Status::Collapse);
    let from_field = known.map(|field| JOINTS.ratios_from_field.map(|ratio| (ratio, Some(field))));
    let courses: Vec<_> = zero_stress.into_iter().chain(from_field.into_iter().flatten()).collect();
    for (ratio, field) in &courses {
        let mut joints = Joints::new(&program, springs(problem, *ratio));
        let end = match field {
            None => course(&mut joints),
            Some(field) => {
                joints.press(field);
                live_load(&mut joints, (associated.field_factor - start) / program.unit)
            }
        };
        let from = if field.is_some() { "the associated forces" } else { "zero stress" };
        let mut fails =
            |why: String| failures.push(format!("elastic joints with k_t/k_n = {ratio}, from {from}: {why}"));
        match end {
            End::Settled(state) => states.push(lowest(&descent, &mut joints, state, &mut counters)),
            End::Wanders([least, greatest], excess) => {
                let [least, greatest] = [least, greatest].map(|lambda| start + lambda * program.unit);
                fails(format!(
                    "no state was reached; the last factors are between {least:.6} and {greatest:.6}, which is no bound, \
                     with shear forces up to {excess:.1e} of the loads beyond friction"
                ));
            }
            End::Stuck => fails("no step under the live load was solved".into()),
            End::Fell => fails("no state under the dead load was found".into()),
        }
        *counters.entry("joint_iterations".into()).or_default() += joints.iterations;
    }
    let bound = associated.motion.filter(|_| associated.status == Status::Collapse);
    let own = SpaceNonAssociated {
        // The upper end of its bounds: no state of any flow rule is above it.
        associated_factor: bound.as_ref().map(|motion| -power(&problem.fixed, motion)),
        associated_motion: bound,
    };
    states.sort_by(|a, b| a.factor.total_cmp(&b.factor));
    let mut notes = if states.is_empty() { failures } else { Vec::new() };
    notes.extend(spread(&states, courses.len()));
    let answer = SpaceAnswer { non_associated: Some(own), counters, ..SpaceAnswer::default() };
    match states.into_iter().next().filter(|state| state.factor <= max) {
        Some(Found { factor, field, motion, .. }) => SpaceAnswer {
            status: Status::Collapse,
            factor: Some(factor),
            field_factor: factor,
            field: Some(field),
            motion: Some(motion),
            notes,
            ..answer
        },
        None => {
            notes.push("no collapse state with the laws' own flow was found".into());
            SpaceAnswer { status: Status::Open, notes, ..answer }
        }
    }
}

/// Returns a note on the factors of the states of some courses, in increasing order, if they differ.
fn spread(states: &[Found], courses: usize) -> Option<String> {
    let (least, greatest) = (states.first()?, states.last()?);
    let near = |state: &&Found| state.factor - least.factor <= JOINTS.differ * least.factor.abs();
    let near = states.iter().filter(near).count();
    let local = if least.local { "; no mechanism tried near it has a lower factor" } else { "" };
    let (count, least, greatest) = (states.len(), least.factor, greatest.factor);
    (near < count).then(|| {
        format!(
            "{count} of {courses} courses of elastic joints end at a collapse state, {near} of them at the least one, which is given; the \
             factors are from {least:.9} to {greatest:.9}{local}"
        )
    })
}

/// Returns the lowest state that is reached from a state: the least one of its mechanism, then of the mechanism of joints that are
/// loaded from there, and so on; at last those of mechanisms nearby.
fn lowest(descent: &Descent, joints: &mut Joints, state: State, counters: &mut Counters) -> Found {
    let (mut lowest, mut dual) = found(descent, joints, &state, counters);
    for _ in 0..JOINTS.rounds {
        joints.press(&lowest.field);
        let lambda = (lowest.factor - joints.program.start) / joints.program.unit;
        let End::Settled(state) = live_load(joints, lambda) else { break };
        let before = lowest.factor;
        let next = found(descent, joints, &state, counters);
        if next.0.factor <= before {
            (lowest, dual) = next;
        }
        if lowest.factor >= before - JOINTS.differ * before.abs() {
            break;
        }
    }
    descent.descend(lowest, dual, counters)
}

/// Returns the least state of the mechanism of a state, with its dual motion.
fn found(descent: &Descent, joints: &Joints, state: &State, counters: &mut Counters) -> (Found, Dual) {
    let program = joints.program;
    let factor = program.start + state.lambda * program.unit;
    let known = (factor, program.by_contacts(&state.forces));
    let jumps = joints.jumps(&state.motion);
    descent.of_mechanism((program.motion(&state.motion), &jumps), known, counters)
}

/// Returns springs in proportion to the areas of the points, with the mean normal stiffness of one.
fn springs(problem: &SpaceProblem, ratio: f64) -> Vec<Spring> {
    let points =
        || problem.contacts.iter().flat_map(|contact| contact.inner.areas.iter().map(move |area| (contact, area)));
    let mean = points().map(|(_, area)| area).sum::<f64>() / points().count().max(1) as f64;
    let spring = |(contact, area): (&SpaceContact, &f64)| {
        // A point without area carries too.
        let normal = if mean > 0.0 { (area / mean).max(JOINTS.softest) } else { 1.0 };
        Spring { stiffness: [normal, ratio * normal], dilatancy: contact.law.dilatancy, friction: contact.law.friction }
    };
    points().map(spring).collect()
}
