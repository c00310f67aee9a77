//! Primal–dual active set: a combination of modes is solved, all points that violate theirs change, and so on.

use super::problem::{Rate, RateProblem};
use crate::contact::mode::ContactMode;

/// A rate with λ̇ = 1 from a guess of the modes. `None` where it cycles, or meets a mechanism.
pub fn active_set(problem: &RateProblem, mut modes: Vec<ContactMode>, trials: &mut u64) -> Option<Rate> {
    let mut seen = Vec::new();
    for round in 0..60 + problem.points.len() {
        *trials += 1;
        let attempt = problem.attempt(&modes, 1.0)?;
        if attempt.singular {
            return None;
        }
        let mut violations = problem.violations(&modes, &attempt, 1.0);
        if violations.is_empty() {
            return Some(problem.rate(&modes, &attempt, 1.0, 1.0));
        }
        if seen.contains(&modes) && round > 12 {
            // One at a time, the first by number, cannot jump about.
            violations.sort_by_key(|v| v.1);
            violations.truncate(1);
            if round > 30 && seen.iter().filter(|s| **s == modes).count() > 2 {
                return None;
            }
        }
        seen.push(modes.clone());
        for (_, k, to) in violations {
            modes[k] = to;
        }
    }
    None
}
