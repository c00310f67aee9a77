//! Ends of a path at its last state: no rate continues it, or a joint is lost.

use super::arrival::Arrival;
use super::chain::{Link, PathChain, greatest_force, midway};
use super::none_rises::{RateProblem, Refuted};
use crate::path::{PathState, RateClaim, Witness};

/// Greatest distance of a slip from the bound of its face, as a share of the size of the scene.
const AT_BOUND: f64 = 1e-9;
/// Least force of a contact point that carries, relative to the greatest force.
const PRESSED: f64 = 1e-9;

impl PathChain {
    /// Returns the last state and the state before it in the same load step.
    fn last_piece(&self) -> Result<[&Link; 2], String> {
        match &self.links[..] {
            [.., before, last] if before.state.load_step == last.state.load_step => Ok([before, last]),
            _ => Err("no state of the load step comes before the last".into()),
        }
    }

    /// Returns the piece between two states of a load step.
    fn arrival(&self, [before, last]: [&Link; 2]) -> Arrival {
        let problem = &*self.structure;
        let sense = self.sense(last.state.load_step);
        let openings: Vec<f64> = before.openings.iter().zip(&last.openings).map(|(a, b)| 0.5 * (a + b)).collect();
        let change = |a: [f64; 2], b: [f64; 2]| [b[0] - a[0], b[1] - a[1]];
        let [from, to] = [&before.state, &last.state];
        let increment = |c: usize| [change(from.force[c], to.force[c]), change(from.gap[c], to.gap[c])];
        Arrival {
            falls: (to.factor - from.factor) * sense <= 0.0,
            modes: self.modes(&midway(problem, from, to), &openings),
            increments: (0..problem.contacts.len()).map(increment).collect(),
        }
    }

    /// Checks that one of the witnesses proves that no rate continues the path from its last state.
    ///
    /// # Errors
    /// Names the first part of the last witness that is wrong.
    pub fn check_none_continues(&self, witnesses: &[Witness]) -> Result<(), String> {
        let [before, last] = self.last_piece()?;
        let (_, equations, modes) = self.at(&last.state)?;
        let (rates, arrival) = (RateProblem { equations: &equations, modes: &modes }, self.arrival([before, last]));
        let rising = if arrival.falls { Refuted::RisingNew(&arrival) } else { Refuted::Rising };
        let mut found = Err("no witness that no rate continues the path".to_string());
        for witness in witnesses.iter().filter(|witness| witness.state.is_same(&last.state)) {
            if let RateClaim::NoneContinues(trees) = &witness.claim {
                let checks = [
                    (&trees.rises, rising),
                    (&trees.stands, Refuted::Standing),
                    (&trees.falls, Refuted::FallingNew(&arrival)),
                ];
                found = checks.into_iter().try_for_each(|(tree, refuted)| rates.check_none(tree, refuted).map(|_| ()));
            }
            if found.is_ok() {
                break;
            }
        }
        found
    }

    /// Checks that a loaded contact point leaves its face at the last state and that its blocks separate there.
    ///
    /// # Errors
    /// If there is no such point.
    pub fn check_joint_lost(&self) -> Result<(), String> {
        let [before, last] = self.last_piece()?.map(|link| &link.state);
        let carries = PRESSED * greatest_force(last);
        let lost = |(index, contact): (usize, &crate::path::Contact)| {
            let [was, slip] = [before, last].map(|state: &PathState| state.gap[index][1]);
            let [low, high] = contact.sliding.slip;
            let near = AT_BOUND * self.structure.length;
            let outwards = slip > was && slip >= high - near || slip < was && slip <= low + near;
            outwards && last.force[index][0] > carries && contact.sliding.parts_at_bound()
        };
        if self.finite && self.structure.contacts.iter().enumerate().any(lost) {
            Ok(())
        } else {
            Err("no contact point leaves its face at the last state".into())
        }
    }
}
