//! The answer with the laws' own flow: the associated bound, and the least state that the courses find.

use super::course::{End, State, course, dead_load, follow, live_load};
use super::descent::{Descent, Dual, Found};
use super::least::Associated;
use super::loading::{Loaded, load};
use super::point::Spring;
use super::refine::refined;
use super::rigid::{Guess, mean, sequence};
use super::standard::Standard;
use super::step::Joints;
use crate::space::program::{Program, Side};
use crate::space::settings::JOINTS;
use voussoir_core::limit::{Counters, LimitQuestion, Status};
use voussoir_core::space::{SpaceAnswer, SpaceContact, SpaceField, SpaceNonAssociated, SpaceProblem, power};

const STRENGTHS: &str = "joints with cohesion, tension or crushing are read with associated flow";

/// Answers a question with the laws' own flow, without panic. `solve` gives the associated answer, which is the bound. It is returned
/// if no flow differs, no load varies, the dead load is not carried, or some joint is not dry. Otherwise courses of elastic joints
/// search collapse states, and the least one is the answer. Their stiffnesses differ; some start at zero stress, the others at the
/// forces of the associated load, which carry the greatest factor. If the associated load is beyond the end of the stage, the courses
/// from zero stress decide if the structure stands there.
pub fn answer(problem: &SpaceProblem, question: LimitQuestion, solve: Associated) -> SpaceAnswer {
    let LimitQuestion::Collapse { start, max } = question else { return solve(problem, question) };
    if !problem.non_associated() {
        return solve(problem, question);
    }
    let searched = |answer: &SpaceAnswer| matches!(answer.status, Status::Collapse | Status::Unbounded | Status::Open);
    if !problem.contacts.iter().all(|contact| contact.law.is_dry()) {
        let mut associated = solve(problem, question);
        associated.notes.extend(searched(&associated).then(|| STRENGTHS.into()));
        return associated;
    }
    // If associated flow carries the end of the stage, this does not decide about the laws' own flow.
    let mut associated = solve(problem, LimitQuestion::Collapse { start, max: f64::INFINITY });
    if !searched(&associated) || problem.varying.iter().flatten().all(|load| *load == 0.0) {
        return associated;
    }
    let descent = Descent { problem, solve, start };
    let program = Program::new(problem, start, Side::Inner);
    let carried = associated.status == Status::Unbounded || associated.field.is_some() && associated.field_factor > max;
    let counters = std::mem::take(&mut associated.counters);
    let mut loaded = Courses::new(descent, (&program, None), counters);
    let verdict = carried.then(|| {
        let end = if max.is_finite() { (max - start) / program.unit } else { JOINTS.end };
        loaded.verdict(end)
    });
    let counters = loaded.counters;
    if let Some(Verdict::Stands(field, note)) = verdict {
        return stands(max, field, note, SpaceAnswer { counters, ..associated });
    }
    let standard = refines(problem).then(|| Standard::new(problem)).flatten();
    let moved = standard.as_ref().map(|standard| Program::new(&standard.problem, start, Side::Inner));
    let mut courses = Courses::new(descent, (moved.as_ref().unwrap_or(&program), standard.as_ref()), counters);
    match &standard {
        Some(Standard { problem, .. }) => {
            courses.search(&solve(problem, LimitQuestion::Collapse { start, max: f64::INFINITY }));
        }
        None => courses.search(&associated),
    }
    let mut answer = courses.answer(associated);
    let open = matches!(verdict, Some(Verdict::Open(_))) || answer.factor.is_some_and(|factor| factor > max);
    match verdict {
        Some(Verdict::Open(note)) => answer.notes.insert(0, note),
        Some(Verdict::Collapses(note)) if max.is_finite() => answer.notes.insert(0, note),
        _ => {}
    }
    SpaceAnswer { status: if open { Status::Open } else { answer.status }, ..answer }
}

/// Returns the answer that the end of the stage is carried. If the stage has no end, this is the associated answer.
fn stands(max: f64, field: SpaceField, note: String, mut associated: SpaceAnswer) -> SpaceAnswer {
    if max.is_infinite() {
        associated.notes.push(note);
        return associated;
    }
    SpaceAnswer {
        status: Status::Stands,
        field_factor: max,
        field: Some(field),
        self_stress: associated.self_stress,
        non_associated: Some(SpaceNonAssociated::default()),
        counters: associated.counters,
        notes: vec![note],
        ..SpaceAnswer::default()
    }
}

/// The common result of the courses that load from zero stress, with a note.
enum Verdict {
    /// All carry the end, with the forces of one of them.
    Stands(SpaceField, String),
    /// All collapse below the end.
    Collapses(String),
    /// They differ, or some was not solved.
    Open(String),
}

/// The courses of a problem with different stiffnesses.
struct Courses<'a> {
    descent: Descent<'a>,
    /// The scaled scene in which joints are loaded.
    program: &'a Program,
    /// The standard position, if this is the scene in which joints are loaded.
    standard: Option<&'a Standard>,
    /// The least state that each course leads to.
    states: Vec<Found>,
    /// The courses without a state, with the reason.
    failures: Vec<String>,
    counters: Counters,
}

impl<'a> Courses<'a> {
    fn new(descent: Descent<'a>, (program, standard): (&'a Program, Option<&'a Standard>), counters: Counters) -> Self {
        Courses { descent, program, standard, states: Vec::new(), failures: Vec::new(), counters }
    }

    /// Runs all courses and sequences. Some begin at the forces of the associated load.
    fn search(&mut self, associated: &SpaceAnswer) {
        self.run(JOINTS.soft, None);
        JOINTS.ratios.iter().for_each(|ratio| self.run(*ratio, None));
        let known = associated.field.as_ref().filter(|_| associated.status == Status::Collapse);
        if let Some(field) = known {
            let lambda = (associated.field_factor - self.program.start) / self.program.unit;
            JOINTS.ratios.iter().for_each(|ratio| self.run(*ratio, Some((field, lambda))));
        }
        if let Some(standard) = self.standard {
            self.sequences(standard, known);
        }
    }

    /// Returns the scene in which joints are loaded.
    fn scene(&self) -> &'a SpaceProblem {
        self.standard.map_or(self.descent.problem, |standard| &standard.problem)
    }

    fn joints(&self, ratio: f64) -> Joints<'a> {
        let settled = if self.standard.is_some() { JOINTS.nearly_settled } else { JOINTS.settled };
        Joints::new(self.program, springs(self.scene(), ratio), settled)
    }

    fn factor(&self, lambda: f64) -> f64 {
        self.program.start + lambda * self.program.unit
    }

    fn count(&mut self, joints: &Joints) {
        *self.counters.entry("joint_iterations".into()).or_default() += joints.iterations;
    }

    /// Runs a course with a ratio of stiffnesses, from zero stress or from forces at a factor.
    fn run(&mut self, ratio: f64, from: Option<(&SpaceField, f64)>) {
        let mut joints = self.joints(ratio);
        let end = match from {
            None => course(&mut joints),
            Some((field, lambda)) => {
                joints.press(field);
                live_load(&mut joints, lambda)
            }
        };
        let from = if from.is_some() { "the associated forces" } else { "zero stress" };
        match self.reached(&joints, end) {
            Ok(first) => self.lower(&mut joints, first),
            Err(why) => self.failures.push(format!("elastic joints with k_t/k_n = {ratio}, from {from}: {why}")),
        }
        self.count(&joints);
    }

    /// Adds the lowest state that is reached from a state.
    fn lower(&mut self, joints: &mut Joints, first: (Found, Dual)) {
        let found = self.lowest(joints, first);
        if self.is_later(&found) {
            self.states.push(found);
        } else {
            self.failures.push("a mechanism has states down to the start of the stage".into());
        }
    }

    /// Returns the lowest state that is reached from a state: the least one of its mechanism, then of the mechanism of joints that are
    /// loaded from there, and so on; at last those of mechanisms nearby.
    fn lowest(&mut self, joints: &mut Joints, (mut lowest, mut dual): (Found, Dual)) -> Found {
        for _ in 0..JOINTS.rounds {
            let field = self.standard.map(|standard| standard.field(self.descent.problem, &lowest.field));
            joints.press(field.as_ref().unwrap_or(&lowest.field));
            let lambda = (lowest.factor - self.program.start) / self.program.unit;
            let end @ End::Settled(_) = live_load(joints, lambda) else { break };
            let Ok(next) = self.reached(joints, end) else { break };
            let before = lowest.factor;
            if next.0.factor <= before {
                (lowest, dual) = next;
            }
            if lowest.factor >= before - JOINTS.differ * before.abs() {
                break;
            }
        }
        self.descent.descend(lowest, dual, &mut self.counters)
    }

    /// Returns true if a state is above the start. Some mechanisms have states under the dead load alone, for example a block that turns
    /// about a vertical axis.
    fn is_later(&self, found: &Found) -> bool {
        found.factor - self.program.start > JOINTS.differ * self.program.unit
    }

    /// Returns the state near the end of a course in standard position.
    fn near(&mut self, state: &State) -> Option<(Found, Dual)> {
        let (field, motion) = (self.program.by_contacts(&state.forces), self.program.motion(&state.motion));
        let guess = Guess { factor: self.factor(state.lambda), field, motion };
        refined(&self.descent, &self.standard?.given(self.descent.problem, &guess), &mut self.counters)
    }

    /// Returns the state at the end of a course or near it, or the reason why the course has no state.
    fn reached(&mut self, joints: &Joints, end: End) -> Result<(Found, Dual), String> {
        match end {
            End::Settled(state) if self.standard.is_none() => {
                Ok(found(&self.descent, joints, &state, &mut self.counters))
            }
            End::Settled(state) => {
                let factor = self.factor(state.lambda);
                self.near(&state).ok_or_else(|| format!("no state was found near the factor {factor:.6}"))
            }
            End::Wanders([least, greatest], excess, state) => {
                let [least, greatest] = [least, greatest].map(|lambda| self.factor(lambda));
                self.near(&state).ok_or_else(|| {
                    format!(
                        "no state was reached; the last factors are between {least:.6} and {greatest:.6}, which is no bound, \
                         with shear forces up to {excess:.1e} of the loads beyond friction"
                    )
                })
            }
            End::Stuck => Err("no step under the live load was solved".into()),
            End::Fell => Err("no state under the dead load was found".into()),
        }
    }

    /// Runs sequences of rigid programs from the normal forces of the associated load, from those of elastic joints under dead load, and
    /// from equal ones that are great, so that hardly any joint slips.
    fn sequences(&mut self, standard: &Standard, associated: Option<&SpaceField>) {
        let mut joints = self.joints(JOINTS.ratios[2]);
        if dead_load(&mut joints).is_none() {
            return;
        }
        let forces: Vec<[f64; 3]> = joints.contacts.iter().map(|contact| contact.force).collect();
        self.count(&joints);
        let pressed = |field: &SpaceField| -> Vec<Vec<f64>> {
            field.iter().map(|forces| forces.iter().map(|force| force[0].max(0.0)).collect()).collect()
        };
        let dead = pressed(&self.program.by_contacts(&forces));
        let mean = mean(&dead);
        let great = JOINTS.sticky.map(|share| {
            let equal = dead.iter().map(|normals| vec![share * mean; normals.len()]).collect();
            (format!("normal forces of {share} times their mean"), equal)
        });
        let associated = associated.map(|field| ("the associated forces".into(), pressed(field)));
        let starts = associated.into_iter().chain([("the dead load".into(), dead)]).chain(great);
        starts.for_each(|(from, normals)| self.sequence(standard, &from, normals));
    }

    /// Runs a sequence of rigid programs, and a course from each guess that is not near a state.
    fn sequence(&mut self, standard: &Standard, from: &str, normals: Vec<Vec<f64>>) {
        let mut least: Option<(Found, Dual)> = None;
        for guess in sequence(&standard.problem, self.program.start, normals) {
            let given = standard.given(self.descent.problem, &guess);
            let next = refined(&self.descent, &given, &mut self.counters).or_else(|| {
                let mut joints = self.joints(JOINTS.ratios[2]);
                joints.press(&guess.field);
                let lambda = (guess.factor - self.program.start) / self.program.unit;
                let end = follow(&mut joints, lambda, self.program.scaled_motion(&guess.motion), JOINTS.guessed);
                self.count(&joints);
                self.reached(&joints, end).ok()
            });
            let next = next.filter(|(found, _)| self.is_later(found));
            least = least.into_iter().chain(next).min_by(|a, b| a.0.factor.total_cmp(&b.0.factor));
        }
        let Some(first) = least else {
            self.failures.push(format!("rigid blocks with fictitious cohesion, from {from}: no state was reached"));
            return;
        };
        let mut joints = self.joints(JOINTS.ratios[2]);
        self.lower(&mut joints, first);
        self.count(&joints);
    }

    /// Loads joints with all ratios from zero stress up to a factor above the start, and again with halved steps.
    fn verdict(&mut self, end: f64) -> Verdict {
        let (mut fields, mut collapses, mut ends) = (Vec::new(), 0, Vec::new());
        for (parts, ratio) in JOINTS.parts.iter().flat_map(|parts| JOINTS.ratios.map(|ratio| (*parts, ratio))) {
            let mut joints = self.joints(ratio);
            let told = match load(&mut joints, end, parts) {
                Loaded::Carries(forces) => {
                    fields.push(self.program.by_contacts(&forces));
                    "carried".into()
                }
                Loaded::Snaps(lambda) => {
                    format!("carried, but the factor falls before from {:.6}", self.factor(lambda))
                }
                Loaded::Collapses(lambda) => {
                    collapses += 1;
                    format!("collapse; the greatest factor is {:.6}", self.factor(lambda))
                }
                Loaded::Stops(lambda) => format!("no step was solved beyond {:.6}", self.factor(lambda)),
                Loaded::Fell => "no state under the dead load was found".into(),
            };
            let halved = if parts > 1.0 { ", halved steps" } else { "" };
            ends.push(format!("k_t/k_n = {ratio}{halved}: {told}"));
            self.count(&joints);
        }
        let factor = self.factor(end);
        let ratios = JOINTS.ratios.map(|ratio| ratio.to_string()).join(", ");
        let list = ends.join("; ");
        if fields.len() == ends.len()
            && let Some(field) = fields.pop()
        {
            return Verdict::Stands(
                field,
                format!(
                    "blocks on elastic joints, loaded step by step from zero stress, carry the factor {factor:.6} with \
                     k_t/k_n = {ratios}, and with halved steps"
                ),
            );
        }
        let whole = "blocks on elastic joints, loaded step by step from zero stress,";
        if collapses == ends.len() {
            return Verdict::Collapses(format!("{whole} do not carry the factor {factor:.6}. {list}"));
        }
        Verdict::Open(format!("{whole} do not decide if the factor {factor:.6} is carried. {list}"))
    }

    /// Returns the answer with the least state.
    fn answer(&mut self, associated: SpaceAnswer) -> SpaceAnswer {
        let bound = associated.motion.filter(|_| associated.status == Status::Collapse);
        let own = SpaceNonAssociated {
            // The upper end of its bounds: no state of any flow rule is above it.
            associated_factor: bound.as_ref().map(|motion| -power(&self.descent.problem.fixed, motion)),
            associated_motion: bound,
            searched: None,
        };
        let mut states = std::mem::take(&mut self.states);
        let courses = states.len() + self.failures.len();
        states.sort_by(|a, b| a.factor.total_cmp(&b.factor));
        let mut notes = if states.is_empty() { std::mem::take(&mut self.failures) } else { Vec::new() };
        notes.extend(spread(&states, courses));
        let answer = SpaceAnswer {
            self_stress: associated.self_stress,
            non_associated: Some(own),
            counters: std::mem::take(&mut self.counters),
            ..SpaceAnswer::default()
        };
        match states.into_iter().next() {
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
}

/// Returns true if guesses are refined: the scene is small, and slip does not dilate.
fn refines(problem: &SpaceProblem) -> bool {
    problem.bodies <= JOINTS.bodies && problem.contacts.iter().all(|contact| contact.law.dilatancy == 0.0)
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
            "{count} of {courses} searches end at a collapse state, {near} of them at the least one, which is given; the \
             factors are from {least:.9} to {greatest:.9}{local}"
        )
    })
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
