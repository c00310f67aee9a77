//! What is written down at converged states: energies, events, the state as others read it.

use super::kinematics::Slopes;
use super::model::{Model, State};
use crate::contact::mode::ContactMode as Regime;
use voussoir_core::law::FacetMode;
use voussoir_core::model::geometry::Vec2;
use voussoir_core::path::{ContactEvent, PathEvent, PathState};

/// Energies so far \[J\].
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Ledger {
    pub dissipated: f64,
    pub work: f64,
}

/// What a contact point does, as events see it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum ContactStatus {
    Sticks,
    Open,
    Slides(i8),
    Crushes,
}

fn doing(model: &Model, contact: usize, regime: Regime, gap: [f64; 2]) -> ContactStatus {
    let Some(law) = model.law(contact) else { return ContactStatus::Sticks };
    let by = |i: usize| match law.facets[i].mode {
        FacetMode::Opening => ContactStatus::Open,
        FacetMode::Crushing => ContactStatus::Crushes,
        FacetMode::Sliding => ContactStatus::Slides(if law.facets[i].flow[1] < 0.0 { 1 } else { -1 }),
    };
    match regime {
        Regime::Stick => ContactStatus::Sticks,
        Regime::Facet(i) => by(i as usize),
        _ if law.opens(regime) => ContactStatus::Open,
        _ => law.pair(regime, gap).map_or(ContactStatus::Sticks, |(pair, _)| by(pair[0])),
    }
}

/// Events of a step, in the order of the contact points.
pub(super) fn events(model: &Model, load_step: usize, start: &State, state: &State) -> Vec<PathEvent> {
    let mut events = Vec::new();
    for contact in 0..state.gap.len() {
        if model.responses.is(contact) {
            let what = model.response_event(start, state, contact);
            events.extend(what.map(|what| PathEvent { load_step, factor: state.factor, contact, what }));
            continue;
        }
        if start.regime[contact] == state.regime[contact] {
            continue;
        }
        let gap = model.step_gap(start, state, contact);
        let before = doing(model, contact, start.regime[contact], gap);
        let after = doing(model, contact, state.regime[contact], gap);
        if before == after {
            continue;
        }
        let what = match (before, after) {
            (_, ContactStatus::Open) => ContactEvent::Opens,
            (ContactStatus::Open, ContactStatus::Sticks) => ContactEvent::Closes,
            (_, ContactStatus::Slides(1)) => ContactEvent::SlipsForward,
            (_, ContactStatus::Slides(_)) => ContactEvent::SlipsBackward,
            (_, ContactStatus::Crushes) => ContactEvent::Crushes,
            (ContactStatus::Crushes, ContactStatus::Sticks) => ContactEvent::Unloads,
            (_, ContactStatus::Sticks) => ContactEvent::Sticks,
        };
        events.push(PathEvent { load_step, factor: state.factor, contact, what });
    }
    events
}

impl Ledger {
    /// Adds a step: work of loads and reactions of settled supports by the trapezoidal rule, exact
    /// where they change linearly during the step, and dissipation.
    pub fn add(&mut self, model: &Model, start: &State, state: &State, slopes: [&Slopes; 2]) {
        self.dissipated += model.response_dissipated(state);
        for contact in 0..state.gap.len() {
            let Some(law) = model.law(contact) else { continue };
            let (kept, _) = law.irreversible(state.regime[contact], model.step_gap(start, state, contact));
            // Where the point yielded before on the same facet, the trapezoidal rule; where it began
            // to, its force when it began is not known: the force at the end.
            let same = start.regime[contact] == state.regime[contact];
            let (end, begun) = (state.force[contact], if same { start.force[contact] } else { state.force[contact] });
            self.dissipated -= 0.5 * ((begun[0] + end[0]) * kept[0] + (begun[1] + end[1]) * kept[1]);
        }
        self.dissipated += model.plastic_work(start, state) * model.units.force * model.units.displacement;
        let problem = model.problem;
        let place = |state: &State, slopes: &Slopes, body: usize, slot: Option<usize>, point: Vec2| {
            let rigid = model.kinematics.rigid(body, point, &state.motion);
            match slot {
                Some(slot) if !slopes.deformation[body].is_empty() => {
                    let v = &slopes.deformation[body];
                    let theta = if model.finite() { state.motion[body][2] } else { 0.0 };
                    rigid + nalgebra::Rotation2::new(theta) * Vec2::new(v[2 * slot], v[2 * slot + 1])
                }
                _ => rigid,
            }
        };
        let loads = [model.loaded.at(start.factor), model.loaded.at(state.factor)];
        for ((before, loading), (after, _)) in loads[0].parts.iter().zip(&loads[1].parts) {
            let mean = 0.5 * (before + after);
            for &(body, slot, point, force) in &loading.forces {
                let moved = place(state, slopes[1], body, slot, point) - place(start, slopes[0], body, slot, point);
                self.work += mean * force.dot(&moved);
            }
            for (body, b) in problem.bodies.iter().enumerate() {
                let (from, to) = (start.motion[body], state.motion[body]);
                self.work += mean * b.mass * loading.acceleration.dot(&Vec2::new(to[0] - from[0], to[1] - from[1]));
            }
        }
        for (body, _) in problem.bodies.iter().enumerate().filter(|(_, b)| b.held) {
            for k in 0..3 {
                let reaction = -0.5 * (slopes[0].balance[body][k] + slopes[1].balance[body][k]);
                self.work += reaction * (state.motion[body][k] - start.motion[body][k]);
            }
        }
    }

    /// The state as others read it.
    pub fn recorded(&self, model: &Model, load_step: usize, state: &State, slopes: &Slopes) -> PathState {
        let mut stored = slopes.stored + model.response_stored(state);
        for contact in 0..state.gap.len() {
            let Some(law) = model.law(contact) else { continue };
            // A tensile strength that opens holds its force reversibly.
            let gap = [state.gap[contact][0] - state.slip[contact][0], 0.0];
            if law.opens(state.regime[contact]) && state.force[contact][0] < 0.0 {
                stored -= state.force[contact][0] * gap[0].max(0.0);
            }
        }
        PathState {
            load_step,
            factor: state.factor,
            force: state.force.clone(),
            gap: state.gap.clone(),
            motion: state.motion.clone(),
            stored,
            dissipated: self.dissipated,
            work: self.work,
            displacement: model.displacement(&state.motion),
            memory: state.answers.before.clone(),
            yielded: super::inelastic::yielded(&state.blocks),
        }
    }
}
