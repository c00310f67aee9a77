//! Checks that a stored case fits its scene, before any computation uses it: every index, name and length must fit, and
//! every number must be in range. Later code indexes the scene with these entries and relies on this check.

use crate::results::{CaseResult, FieldEntry, OutputEntry, ProofFields, StateEntry};
use crate::study::Case;
use std::collections::BTreeSet;
use voussoir_core::certificate::{Hinge, Mechanism, in_range};
use voussoir_core::plugin::OutputOf;

/// Greatest number of steps of a lower bound by products. The check of a step costs a dense factorisation.
const MAX_STEPS: usize = 1_000;
/// Greatest number of findings that are listed for one case.
const LISTED: usize = 8;

/// Returns the entries of a stored case that do not fit its scene, in words. Other code may read the case only if this
/// list is empty.
pub fn misfits(case: &Case, result: &CaseResult) -> Vec<String> {
    let mut fit = Fit { case, found: BTreeSet::new() };
    fit.stages(result);
    fit.proof(result);
    fit.space(result);
    fit.motions(result);
    result.mechanism.iter().for_each(|mechanism| fit.mechanism(mechanism));
    fit.path(result);
    result.outputs.iter().for_each(|entry| fit.output(entry));
    fit.numbers("load_factor, bounds or interval", summary(result));
    let mut found: Vec<String> = fit.found.into_iter().collect();
    found.truncate(LISTED);
    found
}

/// Returns load factors and bounds.
fn summary(result: &CaseResult) -> Vec<f64> {
    let factors = [
        result.load_factor,
        result.proof.field_factor,
        result.path.first_limit_point,
        result.non_associated.associated_load_factor,
    ];
    let interval = result.feasible_interval.into_iter().flatten().flatten();
    factors.into_iter().flatten().chain(result.bounds.into_iter().flatten().flatten()).chain(interval).collect()
}

/// Collects entries that do not fit.
struct Fit<'a> {
    case: &'a Case,
    found: BTreeSet<String>,
}

impl Fit<'_> {
    fn expect(&mut self, fits: bool, what: impl FnOnce() -> String) {
        if !fits {
            self.found.insert(what());
        }
    }

    fn numbers(&mut self, what: &str, numbers: impl IntoIterator<Item = f64>) {
        let fits = numbers.into_iter().all(in_range);
        self.expect(fits, || format!("{what}: a number is not finite, or it is too large for the check"));
    }

    fn joint(&mut self, what: &str, index: usize) {
        let count = self.case.assembly.joints.len();
        self.expect(index < count, || {
            format!("{what}: there is no joint {index}; the scene has {count} joints, from 0")
        });
    }

    /// Checks the index of a joint and the names of its blocks.
    fn between(&mut self, what: &str, index: usize, names: &[String; 2]) {
        self.joint(what, index);
        let assembly = &self.case.assembly;
        let Some(joint) = assembly.joints.get(index) else { return };
        let own = [joint.minus, joint.plus].map(|body| assembly.bodies[body].name.as_str());
        self.expect(own == names.each_ref().map(String::as_str), || {
            format!(
                "{what}: joint {index} is between \"{}\" and \"{}\", but the study has it between \"{}\" and \"{}\"",
                names[0], names[1], own[0], own[1]
            )
        });
    }

    fn stage(&mut self, what: &str, name: &str) {
        let known = self.case.stages.iter().any(|stage| stage.name == name);
        self.expect(known, || format!("{what}: there is no stage \"{name}\""));
    }

    fn length(&mut self, what: &str, length: usize, expected: usize) {
        self.expect(length == expected, || format!("{what}: {length} entries instead of {expected}"));
    }

    fn hinges(&mut self, what: &str, hinges: &[Hinge]) {
        for hinge in hinges {
            self.between(what, hinge.joint, &hinge.between);
            self.numbers(what, hinge.point.into_iter().chain([hinge.rotation]));
        }
    }

    fn stages(&mut self, result: &CaseResult) {
        let count = self.case.stages.len();
        self.expect(result.stages.len() <= count, || {
            format!("stages has {} entries, but the study has {count} stages", result.stages.len())
        });
        for stage in &result.stages {
            self.hinges("hinges of a stage", &stage.hinges);
            self.numbers("factor of a stage", stage.factor);
        }
    }

    fn forces(&mut self, what: &str, entries: Option<&[FieldEntry]>) {
        for entry in entries.into_iter().flatten() {
            self.joint(what, entry.joint);
            self.numbers(what, entry.point.into_iter().chain(entry.force));
        }
    }

    /// Checks the names of bodies: one for each body of the scene in its order, or an empty list.
    fn bodies<'a>(&mut self, what: &str, names: impl ExactSizeIterator<Item = &'a String>) {
        let bodies = &self.case.assembly.bodies;
        let fits = names.len() == bodies.len() && names.zip(bodies).all(|(name, body)| *name == body.name);
        self.expect(fits, || format!("{what}: there must be one entry for each block of the scene, in its order"));
    }

    fn proof(&mut self, result: &CaseResult) {
        let proof = &result.proof;
        self.forces("field", proof.field.as_deref());
        self.forces("ray", proof.ray.as_deref());
        for entry in &proof.fill {
            let numbers = entry.point.into_iter().chain(entry.direction).chain(entry.bounds).chain([entry.force]);
            self.numbers("fill", numbers);
        }
        if let Some(line) = &proof.thrust_line {
            self.length("thrust_line", line.len(), self.case.assembly.joints.len());
            self.numbers("thrust_line", line.iter().flatten().flatten().copied());
        }
        for entry in &result.carried.joints {
            self.between("joints", entry.joint, &entry.between);
            let forces = [entry.normal, entry.shear, entry.moment, entry.contact_length];
            let others = [entry.eccentricity, entry.greatest_stress, entry.sliding_reserve].into_iter().flatten();
            let block = entry.block.iter().flat_map(|block| [block.length, block.stress, block.strength]);
            self.numbers(
                "joints",
                forces.into_iter().chain(others).chain(block).chain(entry.zone.into_iter().flatten()),
            );
        }
        if let Some(reserve) = &result.carried.reserve {
            let bounds = reserve.bounds.into_iter().flatten().flatten();
            self.numbers("reserve", bounds.chain(reserve.factor).chain([reserve.target]));
        }
        if let Some(lower) = &result.non_associated.lower_proof {
            let count = lower.steps.len();
            self.expect(count <= MAX_STEPS, || format!("lower_proof: {count} steps, more than {MAX_STEPS}"));
            for step in &lower.steps {
                let multipliers = step.multipliers.iter().flat_map(|(_, row)| row.iter().map(|(_, value)| *value));
                self.numbers("lower_proof", step.range.into_iter().chain([step.bound]).chain(multipliers));
            }
        }
        for point in &result.non_associated.bracket {
            self.numbers("bracket", [point.work, point.lower].into_iter().chain(point.found));
        }
    }

    /// Checks that forces and velocities have the dimension of the scene, and the entries of a scene in space.
    fn space(&mut self, result: &CaseResult) {
        let Some(case) = &self.case.space else {
            let plane = result.proof.space.is_none();
            return self.expect(plane, || "field or motion: entries in space, but the scene is plane".into());
        };
        let ProofFields { field, motion, ray, space, .. } = &result.proof;
        let plane = field.is_some() || motion.is_some() || ray.is_some();
        self.expect(!plane, || "field or motion: entries in the plane, but the scene is in space".into());
        let Some(proof) = space else { return };
        for (what, entries) in [("field", &proof.field), ("ray", &proof.ray)] {
            for entry in entries.iter().flatten() {
                let count = case.assembly.contacts.len();
                self.expect(entry.joint < count, || {
                    format!("{what}: there is no contact {}; the scene has {count} contacts, from 0", entry.joint)
                });
                self.numbers(what, entry.point.into_iter().chain(entry.force));
            }
        }
        if let Some(motion) = &proof.motion {
            let names = motion.iter().map(|entry| &entry.body);
            let fits = names.eq(case.assembly.bodies.iter().map(|body| &body.name));
            self.expect(fits, || "motion: there must be one entry for each block of the scene, in its order".into());
            self.numbers("motion", motion.iter().flat_map(|entry| entry.velocity));
        }
    }

    fn motions(&mut self, result: &CaseResult) {
        let motions = [("motion", &result.proof.motion), ("associated_motion", &result.proof.associated_motion)];
        for (what, motion) in motions {
            let Some(motion) = motion else { continue };
            self.bodies(what, motion.iter().map(|entry| &entry.body));
            self.numbers(what, motion.iter().flat_map(|entry| entry.velocity));
        }
        if let Some(displaced) = &result.path.displacements {
            self.bodies("displacements", displaced.iter().map(|entry| &entry.body));
            self.numbers("displacements", displaced.iter().flat_map(|entry| entry.displacement));
        }
    }

    fn mechanism(&mut self, mechanism: &Mechanism) {
        self.hinges("hinges", &mechanism.hinges);
        for sliding in &mechanism.sliding {
            self.between("sliding", sliding.joint, &sliding.between);
            self.numbers("sliding", [sliding.slip]);
        }
        for crushing in &mechanism.crushing {
            self.between("crushing", crushing.joint, &crushing.between);
            let share = (0.0..=1.0).contains(&crushing.share);
            self.expect(share, || format!("crushing: the share {} of a joint is not between 0 and 1", crushing.share));
        }
        let count = self.case.space.as_ref().map_or(0, |space| space.assembly.contacts.len());
        for contact in &mechanism.contacts {
            self.expect(contact.joint < count, || format!("mechanism.contacts: there is no contact {}", contact.joint));
            let numbers = [contact.opening, contact.share].into_iter().chain(contact.rotation).chain(contact.slip);
            self.numbers("mechanism.contacts", numbers.chain(contact.points.iter().flatten().copied()));
        }
    }

    fn path(&mut self, result: &CaseResult) {
        let path = &result.path;
        for event in &path.events {
            self.joint("events", event.joint);
            self.stage("events", &event.stage);
            self.numbers("events", event.point.into_iter().chain([event.factor]));
        }
        let points = result.proof.field.as_ref().map(Vec::len);
        path.states.iter().for_each(|state| self.state(state, points));
        self.numbers("curve", path.curve.iter().flatten().flatten().copied());
        self.numbers("joint_states", path.joint_states.iter().flatten().copied());
        self.numbers("joint_time_step", path.joint_time_step);
        self.numbers("joint_gaps", path.joint_gaps.iter().flatten().flatten().copied());
        for peak in &path.limit_points {
            self.stage("limit_points", &peak.stage);
            let next = peak.next_state.map(|next| next.displacement);
            self.numbers("limit_points", [peak.factor, peak.displacement, peak.fall]);
            self.numbers("limit_points", peak.released_energy.into_iter().chain(next));
        }
        if let Some(end) = &path.followed_to {
            self.stage("followed_to", &end.stage);
            self.numbers("followed_to", [end.factor, end.displacement]);
        }
        for branch in &path.branches {
            self.stage("branches", &branch.stage);
            self.numbers("branches", [branch.factor, branch.released_energy]);
        }
        for entry in &path.yielded {
            let known = self.case.assembly.body(&entry.body).is_some();
            self.expect(known, || format!("yielded: there is no block \"{}\"", entry.body));
            self.numbers("yielded", entry.displacement.iter().chain(&entry.elements).copied());
            let points = entry.points.iter().flat_map(|(_, a, b, state)| [*a, *b].into_iter().chain(state.clone()));
            self.numbers("yielded", points);
        }
    }

    fn output(&mut self, entry: &OutputEntry) {
        let what = format!("output \"{}\"", entry.name);
        let assembly = &self.case.assembly;
        let count = if entry.is_of_blocks() { assembly.bodies.len() } else { assembly.joints.len() };
        self.expect(entry.places.iter().all(|place| *place < count), || format!("{what}: a place is not in the scene"));
        let (places, positions) = match entry.of {
            OutputOf::Case => (0, 0),
            OutputOf::Point => (entry.values.len(), entry.values.len()),
            _ => (entry.values.len(), 0),
        };
        self.length(&format!("places of {what}"), entry.places.len(), places);
        self.length(&format!("positions of {what}"), entry.positions.len(), positions);
        self.numbers(&what, entry.positions.iter().flatten().copied());
    }

    fn state(&mut self, state: &StateEntry, points: Option<usize>) {
        self.stage("states", &state.stage);
        self.length("bodies of a state", state.bodies.len(), self.case.assembly.bodies.len());
        if let Some(points) = points {
            self.length("pressures of a state", state.pressures.len(), points);
        }
        let bodies = state.bodies.iter().flatten().copied();
        let own = [state.factor, state.displacement];
        self.numbers("states", own.into_iter().chain(bodies).chain(state.pressures.iter().copied()));
    }
}
