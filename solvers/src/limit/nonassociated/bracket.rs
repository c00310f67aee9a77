//! Proof that no limit state has θ in a range, in consecutive ranges from below.
//!
//! In a range a ≤ θ ≤ t linear programs give bounds of each normal force. The bounds exclude pairs that cannot yield,
//! and limit the dissipation on the others. With these limits kinematics refutes mechanisms whose dissipation does not
//! fit the range. The remaining pairs are searched.

use super::conflict_search::{Ending, Search};
use super::curve::Curve;
use crate::limit::settings::SETTINGS;
use crate::limit::systems::Systems;
use crate::optimise::dense_simplex::{Dictionary, Feasibility};
use voussoir_core::limit::BracketWork;

/// Ends of the ranges as shares of the open interval; the ranges need about equal work.
const RANGE_ENDS: [f64; 8] = [0.3, 0.6, 0.77, 0.85, 0.92, 0.96, 0.985, 1.0];

/// If this share of the open interval is not closed with that share of the work, the proof is given up.
const PROBE: [f64; 2] = [0.01, 0.1];

/// The result of the search in a range.
pub enum Range {
    /// No state exists: proved.
    Closed,
    /// A state in which these pairs move.
    State(Vec<usize>),
    /// Undecided within the allowed work.
    Open,
}

/// Counts of the work done, and the bracket it gave.
#[derive(Debug, Clone, Default)]
pub struct Work {
    /// Pivots.
    pub pivots: u64,
    /// Linear feasibility questions.
    pub programs: u64,
    /// Refusals by statics or kinematics.
    pub refusals: u64,
    /// Matrix entries swept.
    pub entries: u64,
    /// Iterations of the program of products.
    pub iterations: u64,
    /// Multiplications of the program of all products.
    pub multiplications: u64,
    /// The bracket as a function of the work.
    pub curve: Curve,
    /// True if the search was given up before its limit.
    pub given_up: bool,
}

impl Work {
    /// Records that the search has proved no state below this θ.
    fn searched(&mut self, theta: f64) {
        self.curve.proved(BracketWork::Search, self.swept(), theta);
    }

    /// Returns the entries swept by the search, in 10⁹.
    pub fn swept(&self) -> f64 {
        self.entries as f64 / 1e9
    }
}

/// Returns the bounds of the dissipation d_i·r on each yielding pair, and marks the pairs that cannot yield.
pub fn dissipations(systems: &Systems, statics: &mut Dictionary) -> (Vec<[f64; 2]>, Vec<bool>) {
    let mut excluded = vec![false; systems.pairs.len()];
    let mut bounds: Vec<[f64; 2]> = systems.pairs.iter().map(|pair| [pair.bound; 2]).collect();
    for (i, pair) in systems.pairs.iter().enumerate() {
        statics.fix(i, true);
        match statics.feasible() {
            Feasibility::Reason(_) => excluded[i] = true,
            Feasibility::Undecided if pair.non_associated() => bounds[i] = [0.0, f64::INFINITY],
            Feasibility::Undecided => {}
            Feasibility::Point if pair.non_associated() => {
                // (d − a)·r = relief Σ N_k, and s_k = b_k + N_k at the ends that open.
                let base: f64 = pair.openings.iter().map(|&k| systems.pairs[k].bound).sum();
                for (side, sign) in [(0, 1.0), (1, -1.0)] {
                    let weights: Vec<(usize, f64)> = pair.openings.iter().map(|&k| (k, sign * pair.relief)).collect();
                    let extreme = match statics.minimise(&weights, 5000) {
                        Some((value, true)) => sign * value,
                        _ if side == 0 => 0.0,
                        _ => f64::INFINITY,
                    };
                    // Rounding must not make the bounds too narrow.
                    let slack = -sign * SETTINGS.active * (1.0 + extreme.abs());
                    let power = pair.bound + extreme + slack - pair.relief * base;
                    bounds[i][side] = if side == 0 { power.max(0.0) } else { power };
                }
            }
            Feasibility::Point => {}
        }
        statics.fix(i, false);
    }
    (bounds, excluded)
}

/// Searches a ≤ θ ≤ t with at most this work.
fn search(systems: &Systems, range: [f64; 2], most: u64, work: &mut Work) -> Range {
    let [a, t] = range;
    let Some(mut statics) = systems.statics(Some(t)) else { return Range::Closed };
    if a > 0.0 {
        statics.shift(systems.theta(), -a);
    }
    let first = statics.feasible();
    work.programs += 1;
    let (bounds, excluded) = match first {
        Feasibility::Reason(_) => return Range::Closed,
        _ => dissipations(systems, &mut statics),
    };
    let mut kinematics = systems.kinematics(range, &bounds, &excluded);
    let Some(kinematics) = kinematics.take() else { return Range::Closed };
    let mut search = Search::new(statics, kinematics, &excluded);
    for (i, pair) in systems.pairs.iter().enumerate().filter(|(_, pair)| pair.slides()) {
        let other = (0..systems.pairs.len())
            .find(|&k| k > i && systems.pairs[k].slides() && systems.pairs[k].openings == pair.openings);
        if let Some(k) = other.filter(|&k| !excluded[i] && !excluded[k] && !pair.openings.is_empty()) {
            search.not_both(i, k);
        }
    }
    // The work for the bounds is not counted: it is small and fixed.
    let before = search.work();
    let ending = search.run(before + most);
    let found = match ending {
        Ending::Exhausted => Range::Closed,
        Ending::Limit => Range::Open,
        Ending::Found(moving) => {
            (0..systems.pairs.len()).for_each(|i| search.statics.fix(i, false));
            moving.iter().for_each(|&i| search.statics.fix(i, true));
            match search.statics.feasible() {
                Feasibility::Point => match search.statics.minimise(&[(systems.theta(), 1.0)], 5000) {
                    Some(_) => Range::State(moving),
                    None => Range::Open,
                },
                _ => Range::Open,
            }
        }
    };
    work.pivots += search.statics.pivots + search.kinematics.pivots;
    work.entries += search.work() - before;
    work.programs += search.programs;
    work.refusals += search.conflicts;
    found
}

/// Returns true if a state exists at this θ.
pub fn state_at(systems: &Systems, theta: f64, most: u64, work: &mut Work) -> bool {
    matches!(search(systems, [theta, theta], most, work), Range::State(..))
}

/// The end of a proof: a bound, or a lower state.
pub enum Proof {
    /// No state is below this.
    Below(f64),
    /// No state is below this; the pairs move in a state found above it.
    State(f64, Vec<usize>),
    /// No state is below this; the work is used up.
    Open(f64),
}

/// Closes the whole range below a known state in one step, if little work suffices.
pub fn at_once(systems: &Systems, top: f64, most: u64, work: &mut Work) -> Proof {
    let proof = match search(systems, [0.0, top], (most / 50).min(200_000_000), work) {
        Range::Closed => Proof::Below(top),
        Range::State(moving) => Proof::State(0.0, moving),
        Range::Open => Proof::Open(0.0),
    };
    work.searched(if matches!(proof, Proof::Below(_)) { top } else { 0.0 });
    proof
}

/// Closes the range from `proved` to `top` in parts from below. It sweeps at most `most` matrix entries, and a tenth of
/// that if the search makes no progress.
pub fn in_parts(systems: &Systems, [mut proved, top]: [f64; 2], most: u64, work: &mut Work) -> Proof {
    let first = proved;
    let left = most.saturating_sub(work.entries);
    work.given_up = false;
    for share in std::iter::once(PROBE[0]).chain(RANGE_ENDS) {
        let end = if share == 1.0 { top } else { first + share * (top - first) };
        let probes = share == PROBE[0];
        let most = if probes { (PROBE[1] * left as f64) as u64 } else { most.saturating_sub(work.entries) };
        let found = search(systems, [proved, end], most, work);
        work.given_up = probes && left > 0 && matches!(found, Range::Open);
        if matches!(found, Range::Closed) {
            proved = end;
        }
        work.searched(proved);
        match found {
            Range::Closed => {}
            Range::State(moving) => return Proof::State(proved, moving),
            Range::Open => return Proof::Open(proved),
        }
    }
    Proof::Below(proved)
}
