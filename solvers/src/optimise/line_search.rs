//! Non-monotone line search: a step is halved until the merit falls below the greatest of the last iterations.
//!
//! ```text
//! ‖F(x + t Δx)‖ ≤ (1 − σ t) max ‖F‖ of the last m iterations
//! ```
//!
//! Armijo's rule for semismooth systems (De Luca, Facchinei & Kanzow 1996, Math. Programming 75, 407-439) with the
//! greatest of several merits, so that a step over a kink need not lower each (Grippo, Lampariello & Lucidi 1986,
//! SIAM J. Numer. Anal. 23, 707-716). Where none of the halves does, the one with the least merit is taken.

/// The rule of a line search and the merits of its last iterations.
#[derive(Debug, Clone)]
pub struct LineSearch {
    /// σ.
    pub decrease: f64,
    /// Most halvings of one iteration.
    pub halvings: i32,
    /// m.
    pub memory: usize,
    /// Merits below which every step is taken.
    pub nothing: f64,
    /// ‖F‖ of all iterations.
    pub merits: Vec<f64>,
}

impl LineSearch {
    /// For systems that change their pieces all at once.
    pub fn of_pieces() -> Self {
        LineSearch { decrease: 1e-2, halvings: 8, memory: 3, nothing: 0.0, merits: Vec::new() }
    }

    /// The step that is taken, and whether it is the whole: of what `at` finds at a number of halvings and a share
    /// of the step, with its merit. An error is the last of `at`, where it finds nothing anywhere.
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
