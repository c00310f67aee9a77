//! Test of a local minimum: does an exchange of one mode lower the load of a state?
//!
//! The mechanism of a state moves in some pairs. Together with one pair more these pairs have, in general, exactly one other
//! mechanism: the one with the greatest share of the new pair, in which one of the old pairs rests. Statics decides whether a
//! field with a smaller θ exists in which the pairs of that mechanism yield.

use super::bracket::Work;
use crate::limit::settings::SETTINGS;
use crate::limit::systems::{PIVOTS, Systems, greatest_shares};
use crate::optimise::dense_simplex::Feasibility;

/// The exchanges of one mode of a state.
#[derive(Debug, Clone, Default)]
pub struct Exchanges {
    /// θ of the state.
    pub theta: f64,
    /// Number of other mechanisms that were tried.
    pub tried: u64,
    /// True if every exchange was decided.
    pub complete: bool,
    /// Matrix entries swept.
    pub entries: u64,
    /// Pairs that move in a state with a smaller θ.
    pub lower: Option<Vec<usize>>,
}

/// Tries all exchanges of one mode of the state in which `moving` move at `theta`, with at most `most` swept matrix entries.
pub fn exchanges(systems: &Systems, moving: &[usize], theta: f64, most: u64, work: &mut Work) -> Option<Exchanges> {
    let pairs = systems.pairs.len();
    let mut statics = systems.statics(Some(theta * (1.0 - SETTINGS.closed)))?;
    let open = vec![[0.0, f64::INFINITY]; pairs];
    let mut kinematics = systems.kinematics([f64::NEG_INFINITY, f64::INFINITY], &open, &vec![false; pairs])?;
    let mut found = Exchanges { theta, complete: true, ..Exchanges::default() };
    for new in (0..pairs).filter(|i| !moving.contains(i)) {
        if statics.work() + kinematics.work() > most {
            found.complete = false;
            break;
        }
        (0..pairs).for_each(|i| kinematics.fix(i, i != new && !moving.contains(&i)));
        if kinematics.feasible() != Feasibility::Point {
            found.complete = false;
            continue;
        }
        // Without a bound, the pairs move while the loads do no work: no load factor belongs to such a mechanism.
        let Some((_, ended)) = kinematics.minimise(&[(new, -1.0)], PIVOTS) else { continue };
        let gamma: Vec<f64> = (0..pairs).map(|i| kinematics.value(i).max(0.0)).collect();
        let other = greatest_shares(&gamma);
        if !other.contains(&new) {
            found.complete &= ended;
            continue;
        }
        found.tried += 1;
        (0..pairs).for_each(|i| statics.fix(i, other.contains(&i)));
        match statics.feasible() {
            Feasibility::Point => {
                found.lower = Some(other);
                break;
            }
            Feasibility::Reason(_) => found.complete &= ended,
            Feasibility::Undecided => found.complete = false,
        }
    }
    found.entries = statics.work() + kinematics.work();
    work.pivots += statics.pivots + kinematics.pivots;
    Some(found)
}
