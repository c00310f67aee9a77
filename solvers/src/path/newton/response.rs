//! Contact points with laws of tractions from gaps: r = A t(g, history).
//!
//! Two rows a point, with K = −A ∂t/∂g of the update itself and each row in its own scale,
//!
//! ```text
//! σ (r − A t(g)) = 0,    σ (dr + K dg) = −σ (r − A t(g)),    σ = 1 / (F + U max|K|)
//! ```
//!
//! where the joint is stiff against the rest this is g − c r = 0, where it has lost its stiffness
//! r = A t: both are conditioned like the other rows. The history is that of the last converged state
//! until the step is accepted.

use super::model::{Control, Model, Rate, State};
use std::sync::Arc;
use voussoir_core::law::{InterfaceResponse, TractionPoint, UpdateBranch};
use voussoir_core::path::{ContactEvent, PathProblem};

/// Contact points of one law, and where their states stand.
#[derive(Debug, Clone)]
struct Group {
    law: Arc<dyn InterfaceResponse>,
    /// Contact points.
    points: Vec<usize>,
    /// Place of each point's state among those of all points.
    places: Vec<usize>,
}

/// All contact points with laws of tractions from gaps.
#[derive(Debug, Clone, Default)]
pub(super) struct Responses {
    groups: Vec<Group>,
    /// For each contact point whether it is one.
    is: Vec<bool>,
}

/// What the laws say at a state.
#[derive(Debug, Clone, Default)]
pub(super) struct Answers {
    /// For each contact point; empty without such laws.
    pub points: Vec<TractionPoint>,
    /// States of the laws after the step, contact point after contact point.
    pub memory: Vec<f64>,
    /// Those before it.
    pub before: Vec<f64>,
}

impl Responses {
    pub fn new(problem: &PathProblem) -> Self {
        let mut groups: Vec<Group> = Vec::new();
        let mut is = vec![false; problem.contacts.len()];
        let mut place = 0;
        for (contact, c) in problem.contacts.iter().enumerate() {
            let Some(law) = c.law.response() else { continue };
            is[contact] = true;
            let at = groups.iter().position(|group| Arc::ptr_eq(&group.law, law)).unwrap_or_else(|| {
                groups.push(Group { law: law.clone(), points: Vec::new(), places: Vec::new() });
                groups.len() - 1
            });
            groups[at].points.push(contact);
            groups[at].places.push(place);
            place += law.state_size();
        }
        Responses { groups, is }
    }

    pub fn is_empty(&self) -> bool {
        self.groups.is_empty()
    }

    pub fn is(&self, contact: usize) -> bool {
        self.is[contact]
    }

    /// Number of points.
    pub fn count(&self) -> u64 {
        self.groups.iter().map(|group| group.points.len() as u64).sum()
    }

    /// The contact points.
    pub fn points(&self) -> impl Iterator<Item = usize> + '_ {
        self.groups.iter().flat_map(|group| group.points.iter().copied())
    }

    /// One update of all points, group by group. An error says what went wrong.
    pub fn update(&self, gaps: &[[f64; 2]], before: &[f64]) -> Result<Answers, String> {
        if self.is_empty() {
            return Ok(Answers::default());
        }
        let mut all = vec![TractionPoint::ZERO; self.is.len()];
        let mut memory = before.to_vec();
        for group in &self.groups {
            let size = group.law.state_size();
            let gap: Vec<[f64; 2]> = group.points.iter().map(|c| gaps[*c]).collect();
            let old: Vec<f64> = group.places.iter().flat_map(|at| before[*at..at + size].iter().copied()).collect();
            let mut new = old.clone();
            let mut points = vec![TractionPoint::ZERO; gap.len()];
            group.law.respond(&gap, &old, &mut new, &mut points).map_err(|failed| {
                let contact = group.points[failed.point];
                format!("the law of contact point {contact} gives no traction: {:?}", failed.failure)
            })?;
            for (index, (contact, at)) in group.points.iter().zip(&group.places).enumerate() {
                all[*contact] = points[index];
                memory[*at..at + size].copy_from_slice(&new[index * size..(index + 1) * size]);
            }
        }
        Ok(Answers { points: all, memory, before: before.to_vec() })
    }
}

/// What a point with such a law does, as events see it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum ContactStatus {
    Holds,
    Softens,
    Slides(bool),
    Open,
}

fn doing(point: &TractionPoint, gap: [f64; 2], slip: f64) -> ContactStatus {
    match point.branch {
        _ if gap[0] > 0.0 && point.traction == [0.0; 2] && point.tangent == [[0.0; 2]; 2] => ContactStatus::Open,
        UpdateBranch::Softening | UpdateBranch::SofteningSliding => ContactStatus::Softens,
        UpdateBranch::Sliding => ContactStatus::Slides(slip > 0.0),
        _ => ContactStatus::Holds,
    }
}

impl Model<'_> {
    /// Brings what the laws say in line with a state's gaps, for a step from `start`.
    pub fn respond(&mut self, start: &State, state: &mut State) -> Result<(), String> {
        let count = self.responses.count();
        if count > 0 {
            self.count("law_evaluations", count);
            state.answers = self.responses.update(&state.gap, &start.answers.memory)?;
        }
        Ok(())
    }

    /// The same without a step: what the laws say when nothing has moved yet.
    pub fn rest(&mut self, state: &mut State) {
        let same = state.clone();
        // The update has succeeded at this very gap.
        _ = self.respond(&same, state);
    }

    /// Scale and scaled stiffness of a point's rows: σ F and σ U K.
    pub fn response_row(&self, state: &State, contact: usize) -> ([f64; 2], [[f64; 2]; 2]) {
        let u = self.units;
        let area = self.problem.contacts[contact].area;
        let stiffness = state.answers.points[contact].tangent.map(|row| row.map(|t| -area * t * u.displacement));
        let sigma = stiffness.map(|row| 1.0 / (u.force + row[0].abs() + row[1].abs()));
        let scaled = [0, 1].map(|k| stiffness[k].map(|s| s * sigma[k]));
        (sigma.map(|s| s * u.force), scaled)
    }

    /// σ (r − A t).
    pub fn response_residual(&self, state: &State, contact: usize) -> [f64; 2] {
        let area = self.problem.contacts[contact].area;
        let (own, _) = self.response_row(state, contact);
        let traction = state.answers.points[contact].traction;
        [0, 1].map(|k| own[k] * (state.force[contact][k] - area * traction[k]) / self.units.force)
    }

    /// Greatest difference between forces and what the laws say, beyond rounding of the gaps, relative to the greatest
    /// force: between soft blocks a stiff law turns what is small among motions into a share of the forces.
    pub fn law_error(&self, state: &State) -> f64 {
        if self.responses.is_empty() {
            return 0.0;
        }
        let largest = state.force.iter().flatten().map(|r| r.abs()).fold(self.units.force, f64::max);
        let moved = state.motion.iter().flat_map(|q| &q[..2]).chain(state.gap.iter().flatten());
        let moved = moved.fold(0.0, |a: f64, x| a.max(x.abs()));
        // Half of what a certificate allows.
        let rounding = f64::EPSILON * if self.finite() { 256.0 * self.units.length } else { 32.0 * moved };
        let mut worst: f64 = 0.0;
        for c in self.responses.points() {
            let (point, area) = (&state.answers.points[c], self.problem.contacts[c].area);
            for k in 0..2 {
                let stiffness = point.tangent[k][0].abs() + point.tangent[k][1].abs();
                let off = (state.force[c][k] - area * point.traction[k]).abs() - rounding * area * stiffness;
                worst = worst.max(off / largest);
            }
        }
        worst
    }

    /// Energy that these laws dissipate in a step \[J\].
    pub fn response_dissipated(&self, state: &State) -> f64 {
        let points = state.answers.points.iter().zip(&self.problem.contacts);
        points.map(|(point, c)| c.area * point.dissipated).sum()
    }

    /// Energy that these laws store \[J\].
    pub fn response_stored(&self, state: &State) -> f64 {
        let points = state.answers.points.iter().zip(&self.problem.contacts);
        points.map(|(point, c)| c.area * point.stored).sum()
    }

    /// Whether a step from `start` is irreversible at some point.
    pub fn response_yields(&self, state: &State) -> bool {
        let most = 1e-13 * (self.response_stored(state).abs() + self.units.force * self.units.displacement);
        self.response_dissipated(state) > most
    }

    /// Points that change what they do between two states.
    pub fn response_changes(&self, start: &State, state: &State) -> usize {
        let of = |state: &State, c: usize| state.answers.points[c].branch;
        self.responses.points().filter(|c| of(start, *c) != of(state, *c)).count()
    }

    /// Derivative of the dissipated energy by the gaps \[J/m\], by central differences: a law gives none.
    /// It steers Newton's method and no answer depends on it.
    pub fn dissipation_slopes(&self, start: &State, state: &State) -> Vec<f64> {
        let mut slopes = vec![0.0; 2 * state.gap.len()];
        if self.responses.is_empty() {
            return slopes;
        }
        let length = |c: usize| {
            let moved = (state.gap[c][0] - start.gap[c][0]).hypot(state.gap[c][1] - start.gap[c][1]);
            1e-6 * moved.max(1e-9 * self.units.displacement)
        };
        for k in 0..2 {
            let sides = [1.0, -1.0].map(|side| {
                let mut gaps = state.gap.clone();
                self.responses.points().for_each(|c| gaps[c][k] += side * length(c));
                self.responses.update(&gaps, &start.answers.memory)
            });
            let [Ok(high), Ok(low)] = sides else { continue };
            for c in self.responses.points() {
                let rise = high.points[c].dissipated - low.points[c].dissipated;
                slopes[2 * c + k] = self.problem.contacts[c].area * rise / (2.0 * length(c));
            }
        }
        slopes
    }

    /// Event of a step at a point.
    pub fn response_event(&self, start: &State, state: &State, contact: usize) -> Option<ContactEvent> {
        let slip = state.gap[contact][1] - start.gap[contact][1];
        let before = doing(&start.answers.points[contact], start.gap[contact], slip);
        let after = doing(&state.answers.points[contact], state.gap[contact], slip);
        Some(match (before, after) {
            (before, after) if before == after => return None,
            (_, ContactStatus::Open) => ContactEvent::Opens,
            (_, ContactStatus::Softens) => ContactEvent::Softens,
            (_, ContactStatus::Slides(true)) => ContactEvent::SlipsForward,
            (_, ContactStatus::Slides(false)) => ContactEvent::SlipsBackward,
            (ContactStatus::Open, ContactStatus::Holds) => ContactEvent::Closes,
            (ContactStatus::Softens, ContactStatus::Holds) => ContactEvent::Unloads,
            (_, ContactStatus::Holds) => ContactEvent::Sticks,
        })
    }

    /// Whether the laws give, however far a rate is followed, the forces that it says (sampled).
    pub fn responses_go_on(&self, state: &State, rate: &Rate) -> bool {
        let u = self.units;
        let motion = self.motion_size(rate).max(1e-300) * u.displacement;
        let largest = |rates: &[[f64; 2]]| rates.iter().flatten().fold(0.0, |a: f64, r| a.max(r.abs()));
        let (held, grown) = (largest(&state.force).max(u.force), largest(&rate.force));
        let small = |x: f64| if x.abs() <= 1e-8 * motion { 0.0 } else { x };
        [1e-9, 1e-6, 1e-3, 1.0].iter().all(|distance| {
            let share = distance * u.length / motion;
            let far = |(g, dg): (&[f64; 2], &[f64; 2])| [0, 1].map(|k| g[k] + share * small(dg[k]));
            let gaps: Vec<[f64; 2]> = state.gap.iter().zip(&rate.gap).map(far).collect();
            let Ok(answers) = self.responses.update(&gaps, &state.answers.memory) else { return false };
            self.responses.points().all(|c| {
                (0..2).all(|k| {
                    let traction = self.problem.contacts[c].area * answers.points[c].traction[k];
                    let told = state.force[c][k] + share * rate.force[c][k];
                    (traction - told).abs() <= 1e-6 * (held + share * grown)
                })
            })
        })
    }

    /// Controls of the gaps of the points that a rate softens, along that rate: monotone through the
    /// sharpest snap-back, where the length of the path is not. First all of them, then those alone
    /// that begin to. Empty where nothing softens.
    pub fn local_controls(&mut self, state: &State, ahead: &State, rate: &Rate) -> Vec<Local> {
        let mut moved = ahead.clone();
        if self.respond(state, &mut moved).is_err() {
            return Vec::new();
        }
        let dissipates = |c: &usize| moved.answers.points[*c].dissipated > 0.0;
        let active: Vec<usize> = self.responses.points().filter(dissipates).collect();
        let begins = |c: &usize| moved.answers.points[*c].branch != state.answers.points[*c].branch;
        let new: Vec<usize> = active.iter().copied().filter(begins).collect();
        let mut all: Vec<Local> = Local::along(&active, &rate.gap).into_iter().collect();
        if new.len() < active.len() {
            all.extend(Local::along(&new, &rate.gap));
        }
        all
    }

    /// Control of the gaps of the points that dissipated in a step, 1 at its end.
    pub fn local_of_step(&self, start: &State, next: &State) -> Option<Local> {
        let active: Vec<usize> = self.responses.points().filter(|c| next.answers.points[*c].dissipated > 0.0).collect();
        let moved: Vec<[f64; 2]> =
            (0..next.gap.len()).map(|c| [0, 1].map(|k| next.gap[c][k] - start.gap[c][k])).collect();
        Local::along(&active, &moved)
    }
}

/// Weights of the gaps in a local control: Σ w·(g − g_start) = length.
#[derive(Debug, Clone)]
pub(super) struct Local {
    pub by_gap: Vec<f64>,
}

impl Local {
    /// Gaps of some points along their `direction`, 1 where they have moved by it.
    fn along(points: &[usize], direction: &[[f64; 2]]) -> Option<Local> {
        let whole: f64 = points.iter().map(|c| direction[*c][0].powi(2) + direction[*c][1].powi(2)).sum();
        let mut by_gap = vec![0.0; 2 * direction.len()];
        for c in points {
            (0..2).for_each(|k| by_gap[2 * c + k] = direction[*c][k] / whole);
        }
        (whole > 0.0).then_some(Local { by_gap })
    }

    pub fn value(&self, start: &State, state: &State) -> f64 {
        let moved = state.gap.iter().flatten().zip(start.gap.iter().flatten());
        moved.zip(&self.by_gap).map(|((g, before), w)| w * (g - before)).sum()
    }

    pub fn control(&self, length: f64) -> Control<'_> {
        Control::Gaps { local: self, length }
    }
}
