//! Non-monotone line search: a step is halved until the merit falls below the greatest of the last iterations.
//!
//! ```text
//! ‖F(x + t Δx)‖ ≤ (1 − σ t) max ‖F‖ of the last m iterations
//! ```
//!
//! Armijo's rule for semismooth systems (De Luca, Facchinei & Kanzow 1996, Math. Programming 75, 407-439). The maximum
//! over several iterations allows a step over a kink that increases the merit (Grippo, Lampariello & Lucidi 1986, SIAM
//! J. Numer. Anal. 23, 707-716). If no halving satisfies the rule, the step with the least merit is used.

/// The rule of a line search and the merits of its last iterations.
#[derive(Debug, Clone)]
pub struct LineSearch {
    /// σ.
    pub decrease: f64,
    /// Greatest number of halvings of one iteration.
    pub halvings: i32,
    /// m.
    pub memory: usize,
    /// Merit below which every step is accepted.
    pub nothing: f64,
    /// ‖F‖ of all iterations.
    pub merits: Vec<f64>,
}

impl LineSearch {
    /// Creates the rule for systems whose pieces all change at once.
    pub fn of_pieces() -> Self {
        LineSearch { decrease: 1e-2, halvings: 8, memory: 3, nothing: 0.0, merits: Vec::new() }
    }

    /// Returns the result of the accepted step, and true if it is the full step. `at` receives the number of halvings
    /// and the step length and returns a result with its merit. If `at` fails for all lengths, the error is its last
    /// one.
    pub fn search<T, E>(
        &mut self,
        most: f64,
        mut at: impl FnMut(i32, f64) -> Result<(f64, T), E>,
    ) -> Result<(T, bool), Option<E>> {
        let reference = self.merits.iter().rev().take(self.memory).fold(0.0, |a: f64, m| a.max(*m));
        let mut best: Option<(f64, T, bool)> = None;
        let mut failure = None;
        for halvings in 0..=self.halvings {
            let share = most * 0.5f64.powi(halvings);
            let (merit, there) = match at(halvings, share) {
                Ok(found) => found,
                Err(why) => {
                    failure = Some(why);
                    continue;
                }
            };
            if best.as_ref().is_none_or(|best| merit < best.0) {
                best = Some((merit, there, halvings == 0));
            }
            if merit <= (1.0 - self.decrease * share) * reference || merit <= self.nothing {
                break;
            }
        }
        let (merit, there, whole) = best.ok_or(failure)?;
        self.merits.push(merit);
        Ok((there, whole))
    }
}
