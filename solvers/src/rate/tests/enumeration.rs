//! Every combination of modes: all solutions with λ rising, constant (mechanisms) and falling.

use crate::contact::mode::ContactMode;
use crate::rate::problem::{Rate, RateProblem};

/// All rates that solve the problem, each once.
pub fn enumerate_modes(problem: &RateProblem, trials: &mut u64) -> Vec<Rate> {
    let candidates: Vec<Vec<ContactMode>> = problem.points.iter().map(|point| point.candidates()).collect();
    let mut found: Vec<Rate> = Vec::new();
    let mut index = vec![0; candidates.len()];
    loop {
        *trials += 1;
        let modes: Vec<ContactMode> = index.iter().zip(&candidates).map(|(i, c)| c[*i]).collect();
        if let Some(attempt) = problem.attempt(&modes, 1.0) {
            for sign in [1.0, -1.0] {
                if problem.violations(&modes, &attempt, sign).is_empty() {
                    let factor = if attempt.singular { 0.0 } else { sign };
                    let rate = problem.rate(&modes, &attempt, sign, factor);
                    if !found.iter().any(|known| known.is_same(&rate, 1e-7)) {
                        found.push(rate);
                    }
                }
            }
        }
        let Some(place) = (0..index.len()).find(|i| index[*i] + 1 < candidates[*i].len()) else {
            return found;
        };
        index[..place].iter_mut().for_each(|i| *i = 0);
        index[place] += 1;
    }
}
