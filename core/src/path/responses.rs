//! Contact points with laws of tractions from gaps. Points of one law are updated in one call, because a law in another
//! language pays for each call.

use super::law_step::LawStep;
use super::problem::{Contact, PathProblem};
use crate::law::{BatchFailure, InterfaceResponse, PointContext, TractionPoint};
use std::sync::Arc;

/// Contact points of one law, with the places of their states.
#[derive(Debug, Clone)]
struct Group {
    law: Arc<dyn InterfaceResponse>,
    /// Contact points, and the place of the state of each in the states of all points.
    points: Vec<(usize, usize)>,
}

/// A contact point, the place of its state, and a gap.
type Asked = (usize, usize, [f64; 2]);

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

impl Responses {
    /// Groups the contact points of a problem by their laws.
    pub fn new(problem: &PathProblem) -> Self {
        let mut groups: Vec<Group> = Vec::new();
        let mut of = vec![None; problem.contacts.len()];
        let mut place = 0;
        for (contact, c) in problem.contacts.iter().enumerate() {
            let Some(law) = c.law.response() else { continue };
            let at = groups.iter().position(|group| Arc::ptr_eq(&group.law, law)).unwrap_or_else(|| {
                groups.push(Group { law: law.clone(), points: Vec::new() });
                groups.len() - 1
            });
            groups[at].points.push((contact, place));
            of[contact] = Some((at, place));
            place += law.state_size();
        }
        let joints = problem.contacts.iter().map(|c| c.joint).collect();
        let context = |c: &Contact| PointContext::at(c.position.into(), c.area / problem.width, problem.width);
        let contexts = problem.contacts.iter().map(context).collect();
        Responses { groups, of, joints, contexts }
    }

    /// Returns true if no contact point has such a law.
    pub fn is_empty(&self) -> bool {
        self.groups.is_empty()
    }

    /// Returns true if a contact point has such a law.
    pub fn is(&self, contact: usize) -> bool {
        self.of[contact].is_some()
    }

    /// Returns the number of contact points with such laws.
    pub fn count(&self) -> u64 {
        self.groups.iter().map(|group| group.points.len() as u64).sum()
    }

    /// Returns the contact points with such laws, law by law.
    pub fn points(&self) -> impl Iterator<Item = usize> + '_ {
        self.groups.iter().flat_map(|group| group.points.iter().map(|(contact, _)| *contact))
    }

    /// Asks a law for some of its points. Returns the results and the states after the step, point by point.
    fn ask(
        &self,
        law: &dyn InterfaceResponse,
        asked: &[Asked],
        before: &[f64],
        step: &LawStep,
    ) -> Result<(Vec<TractionPoint>, Vec<f64>), BatchFailure> {
        let size = law.state_size();
        let gaps: Vec<[f64; 2]> = asked.iter().map(|(_, _, gap)| *gap).collect();
        let during = |c: usize| self.contexts[c].during(step.previous_gap[c], step.time_step, step.both_fields());
        let contexts: Vec<PointContext> = asked.iter().map(|(contact, _, _)| during(*contact)).collect();
        let old: Vec<f64> = asked.iter().flat_map(|(_, at, _)| before[*at..at + size].iter().copied()).collect();
        let (mut new, mut points) = (old.clone(), vec![TractionPoint::ZERO; asked.len()]);
        law.respond(&gaps, &contexts, &old, &mut new, &mut points)?;
        Ok((points, new))
    }

    /// Returns the results of contact points at gaps in a step, from the states of all points before. `None` where a contact point
    /// has no such law or its law fails.
    pub fn at(&self, asked: &[(usize, [f64; 2])], before: &[f64], step: &LawStep) -> Vec<Option<TractionPoint>> {
        let mut found = vec![None; asked.len()];
        for (index, group) in self.groups.iter().enumerate() {
            let of = |(k, (contact, gap)): (usize, &(usize, [f64; 2]))| match self.of[*contact] {
                Some((own, place)) if own == index => Some((k, (*contact, place, *gap))),
                _ => None,
            };
            let (places, asked): (Vec<usize>, Vec<Asked>) = asked.iter().enumerate().filter_map(of).unzip();
            if asked.is_empty() {
                continue;
            }
            match self.ask(&*group.law, &asked, before, step) {
                Ok((points, _)) => places.iter().zip(points).for_each(|(k, point)| found[*k] = Some(point)),
                // One point fails: the others are asked alone.
                Err(_) => places.iter().zip(&asked).for_each(|(k, one)| {
                    found[*k] = self
                        .ask(&*group.law, &[*one], before, step)
                        .ok()
                        .and_then(|(points, _)| points.first().copied());
                }),
            }
        }
        found
    }

    /// Updates all points in a step, law by law. Returns the results of all contact points, zero without such a law, and the states
    /// after the step.
    ///
    /// # Errors
    /// If a law fails or says a number that is not finite: the law, the joint, the point, the gap and the reason.
    pub fn update(
        &self,
        gaps: &[[f64; 2]],
        before: &[f64],
        step: &LawStep,
    ) -> Result<(Vec<TractionPoint>, Vec<f64>), String> {
        let mut all = vec![TractionPoint::ZERO; self.of.len()];
        let mut memory = before.to_vec();
        for group in &self.groups {
            let size = group.law.state_size();
            let asked: Vec<Asked> = group.points.iter().map(|(contact, at)| (*contact, *at, gaps[*contact])).collect();
            let failure = |index: usize, why: &str| self.failure(&*group.law, asked.get(index), why);
            let (points, new) = self
                .ask(&*group.law, &asked, before, step)
                .map_err(|failed| failure(failed.point, &failed.failure.to_string()))?;
            if let Some(index) = points.iter().position(|point| !point.is_finite()) {
                return Err(failure(index, &format!("it says {:?}", points[index])));
            }
            for (index, (contact, at, _)) in asked.iter().enumerate() {
                all[*contact] = points[index];
                memory[*at..at + size].copy_from_slice(&new[index * size..(index + 1) * size]);
            }
        }
        Ok((all, memory))
    }

    /// Returns a message with the law, the joint, the point and the gap of a failure.
    fn failure(&self, law: &dyn InterfaceResponse, asked: Option<&Asked>, why: &str) -> String {
        let (contact, gap) = asked.map_or((0, None), |(contact, _, gap)| (*contact, Some(gap)));
        let joint = self.joints.get(contact).copied().unwrap_or_default();
        let [x, y] = self.contexts.get(contact).map_or([0.0; 2], |context| context.position);
        format!("the law {law:?} gives no traction at joint {joint}, point ({x}, {y}), gap {gap:?}: {why}")
    }
}
