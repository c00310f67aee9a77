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
use voussoir_core::law::{InterfaceResponse, TractionPoint, UpdateBranch};
use voussoir_core::path::PathProblem;

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
    /// Joint of each contact point, and position.
    places: Vec<(usize, [f64; 2])>,
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
        let places = problem.contacts.iter().map(|c| (c.joint, c.position.into())).collect();
        Responses { groups, of, places }
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

    /// Returns the response of the law of a contact point at a gap, from the states of all points before. `None` if it
    /// has no such law or the law fails.
    pub fn at(&self, contact: usize, gap: [f64; 2], before: &[f64]) -> Option<TractionPoint> {
        let (group, at) = self.of[contact]?;
        let law = &self.groups[group].law;
        let old = &before[at..at + law.state_size()];
        law.respond_point(gap, old, &mut old.to_vec()).ok().map(|point| named(point, gap))
    }

    /// Returns a message with the law, the joint, the point and the gap of a failure.
    fn failure(&self, group: &Group, index: usize, gap: Option<&[f64; 2]>, why: &str) -> String {
        let contact = group.points.get(index).copied().unwrap_or_default();
        let place = self.places.get(contact).copied().unwrap_or_default();
        format!(
            "the law {:?} gives no traction at joint {}, point ({}, {}), gap {gap:?}: {why}",
            group.law, place.0, place.1[0], place.1[1]
        )
    }

    /// Updates all points, group by group. An error gives the reason of the failure.
    pub fn update(&self, gaps: &[[f64; 2]], before: &[f64]) -> Result<TractionUpdates, String> {
        if self.is_empty() {
            return Ok(TractionUpdates::default());
        }
        let mut all = vec![TractionPoint::ZERO; self.of.len()];
        let mut memory = before.to_vec();
        for group in &self.groups {
            let size = group.law.state_size();
            let gap: Vec<[f64; 2]> = group.points.iter().map(|c| gaps[*c]).collect();
            let old: Vec<f64> = group.places.iter().flat_map(|at| before[*at..at + size].iter().copied()).collect();
            let mut new = old.clone();
            let mut points = vec![TractionPoint::ZERO; gap.len()];
            group.law.respond(&gap, &old, &mut new, &mut points).map_err(|failed| {
                self.failure(group, failed.point, gap.get(failed.point), &failed.failure.to_string())
            })?;
            let finite = |p: &TractionPoint| {
                p.traction
                    .iter()
                    .chain(p.tangent.as_flattened())
                    .chain([&p.stored, &p.dissipated])
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
        Ok(TractionUpdates { points: all, memory, before: before.to_vec() })
    }
}
