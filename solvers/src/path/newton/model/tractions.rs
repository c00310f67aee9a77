//! Contact points with laws of tractions from gaps: r = A t(g, history).
//!
//! Each point has two rows. With K = −A ∂t/∂g of the update itself and a separate scale for each row,
//!
//! ```text
//! σ (r − A t(g)) = 0,    σ (dr + K dg) = −σ (r − A t(g)),    σ = 1 / (F + U max|K|)
//! ```
//!
//! If the joint is stiff compared with the rest, this is g − c r = 0; if it has lost its stiffness, it is r = A t. Both
//! are conditioned like the other rows. The history is that of the last converged state until the step is accepted.

use std::sync::Arc;
use voussoir_core::law::{InterfaceResponse, PointContext, TractionPoint, UpdateBranch};
use voussoir_core::path::{Contact, LawStep, PathProblem};

/// Contact points of one law, with the places of their states.
#[derive(Debug, Clone)]
struct Group {
    law: Arc<dyn InterfaceResponse>,
    /// Contact points.
    points: Vec<usize>,
    /// Place of each point's state in the states of all points.
    places: Vec<usize>,
}

/// All contact points with laws of tractions from gaps.
#[derive(Debug, Clone, Default)]
pub struct Responses {
    groups: Vec<Group>,
    /// For each contact point its group and the place of its state, if it has such a law.
    of: Vec<Option<(usize, usize)>>,
    /// Joint of each contact point.
    joints: Vec<usize>,
    /// Context of each contact point without its step.
    contexts: Vec<PointContext<'static>>,
}

/// Returns a point with the name of its branch: if its law names no branches, a point without normal traction is open.
/// Next to the corner a tangent by differences mixes both sides.
fn named(point: TractionPoint, gap: [f64; 2]) -> TractionPoint {
    match point.branch == UpdateBranch::ELASTIC && point.traction[0] == 0.0 && gap[0] > 0.0 {
        true => TractionPoint { branch: UpdateBranch::OPEN, tangent: [[0.0; 2], point.tangent[1]], ..point },
        false => point,
    }
}

/// Responses of the laws at a state.
#[derive(Debug, Clone, Default)]
pub struct TractionUpdates {
    /// Response of each contact point; empty without such laws.
    pub points: Vec<TractionPoint>,
    /// States of the laws after the step, in the order of the contact points.
    pub memory: Vec<f64>,
    /// States of the laws before the step.
    pub before: Vec<f64>,
    /// Gaps before the step, if it has a duration.
    pub previous_gap: Vec<[f64; 2]>,
    /// Duration of the step \[s\].
    pub time_step: f64,
}

impl Responses {
    pub fn new(problem: &PathProblem) -> Self {
        let mut groups: Vec<Group> = Vec::new();
        let mut of = vec![None; problem.contacts.len()];
        let mut place = 0;
        for (contact, c) in problem.contacts.iter().enumerate() {
            let Some(law) = c.law.response() else { continue };
            let at = groups.iter().position(|group| Arc::ptr_eq(&group.law, law)).unwrap_or_else(|| {
                groups.push(Group { law: law.clone(), points: Vec::new(), places: Vec::new() });
                groups.len() - 1
            });
            groups[at].points.push(contact);
            groups[at].places.push(place);
            of[contact] = Some((at, place));
            place += law.state_size();
        }
        let joints = problem.contacts.iter().map(|c| c.joint).collect();
        let context = |c: &Contact| PointContext::at(c.position.into(), c.area / problem.width, problem.width);
        let contexts = problem.contacts.iter().map(context).collect();
        Responses { groups, of, joints, contexts }
    }

    pub fn is_empty(&self) -> bool {
        self.groups.is_empty()
    }

    pub fn is(&self, contact: usize) -> bool {
        self.of[contact].is_some()
    }

    /// Returns the number of points.
    pub fn count(&self) -> u64 {
        self.groups.iter().map(|group| group.points.len() as u64).sum()
    }

    /// Returns the contact points.
    pub fn points(&self) -> impl Iterator<Item = usize> + '_ {
        self.groups.iter().flat_map(|group| group.points.iter().copied())
    }

    /// Returns the context of a contact point in a step.
    fn context<'s>(&self, contact: usize, step: &'s LawStep<'_>) -> PointContext<'s> {
        self.contexts[contact].during(step.previous_gap[contact], step.time_step, step.both_fields())
    }

    /// Returns the response of the law of a contact point at a gap in a step, from the states of all points before.
    /// `None` if it has no such law or the law fails.
    pub fn at(&self, contact: usize, gap: [f64; 2], before: &[f64], step: &LawStep) -> Option<TractionPoint> {
        let (group, at) = self.of[contact]?;
        let law = &self.groups[group].law;
        let old = &before[at..at + law.state_size()];
        law.respond_point(gap, &self.context(contact, step), old, &mut old.to_vec()).ok().map(|point| named(point, gap))
    }

    /// Returns a message with the law, the joint, the point and the gap of a failure.
    fn failure(&self, group: &Group, index: usize, gap: Option<&[f64; 2]>, why: &str) -> String {
        let contact = group.points.get(index).copied().unwrap_or_default();
        let joint = self.joints.get(contact).copied().unwrap_or_default();
        let [x, y] = self.contexts.get(contact).map_or([0.0; 2], |context| context.position);
        format!("the law {:?} gives no traction at joint {joint}, point ({x}, {y}), gap {gap:?}: {why}", group.law)
    }

    /// Updates all points in a step, group by group. An error gives the reason of the failure.
    pub fn update(&self, gaps: &[[f64; 2]], before: &[f64], step: &LawStep) -> Result<TractionUpdates, String> {
        if self.is_empty() {
            return Ok(TractionUpdates::default());
        }
        let mut all = vec![TractionPoint::ZERO; self.of.len()];
        let mut memory = before.to_vec();
        for group in &self.groups {
            let size = group.law.state_size();
            let gap: Vec<[f64; 2]> = group.points.iter().map(|c| gaps[*c]).collect();
            let contexts: Vec<PointContext> = group.points.iter().map(|c| self.context(*c, step)).collect();
            let old: Vec<f64> = group.places.iter().flat_map(|at| before[*at..at + size].iter().copied()).collect();
            let mut new = old.clone();
            let mut points = vec![TractionPoint::ZERO; gap.len()];
            group.law.respond(&gap, &contexts, &old, &mut new, &mut points).map_err(|failed| {
                self.failure(group, failed.point, gap.get(failed.point), &failed.failure.to_string())
            })?;
            let finite = |p: &TractionPoint| {
                p.traction
                    .iter()
                    .chain(p.tangent.as_flattened())
                    .chain([&p.stored, &p.dissipated, &p.supplied])
                    .all(|v| v.is_finite())
            };
            if let Some(index) = points.iter().position(|p| !finite(p)) {
                let why = format!("it says {:?}", points[index]);
                return Err(self.failure(group, index, gap.get(index), &why));
            }
            for (index, (contact, at)) in group.points.iter().zip(&group.places).enumerate() {
                all[*contact] = named(points[index], gap[index]);
                memory[*at..at + size].copy_from_slice(&new[index * size..(index + 1) * size]);
            }
        }
        let previous_gap = if step.time_step > 0.0 { step.previous_gap.to_vec() } else { Vec::new() };
        Ok(TractionUpdates { points: all, memory, before: before.to_vec(), previous_gap, time_step: step.time_step })
    }
}
