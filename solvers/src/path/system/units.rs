//! The units in which the unknowns are of comparable size, so that the units of a study do not matter.

use voussoir_core::path::{Loading, PathProblem};

/// Units of the unknowns.
#[derive(Debug, Clone, Copy)]
pub struct Units {
    /// F: the size of the first loads \[N\].
    pub force: f64,
    /// U = F × the mean compliance of a contact point \[m\].
    pub displacement: f64,
    /// \[m\].
    pub length: f64,
    /// Λ: unit of the factor that grows.
    pub factor: f64,
}

/// Greatest displacement of a point by settlements.
fn settled(loading: &Loading, length: f64) -> f64 {
    let size = |s: &(usize, [f64; 3])| s.1[0].hypot(s.1[1]).max(s.1[2].abs() * length);
    loading.settlements.iter().map(size).fold(0.0, f64::max)
}

impl Units {
    /// Computes the units of a problem whose contact points have a `mean` compliance \[m/N\].
    pub fn new(problem: &PathProblem, mean: f64) -> Self {
        let loadings = || problem.load_steps.iter().map(|step| &step.loading);
        let size = loadings().map(|loading| problem.load_size(loading)).find(|s| *s > 0.0);
        let settlement = loadings().map(|loading| settled(loading, problem.length)).fold(0.0, f64::max);
        let force = size.unwrap_or(if mean > 0.0 { settlement / mean } else { 0.0 });
        let force = if force > 0.0 { force } else { 1.0 };
        let displacement = if mean > 0.0 { force * mean } else { problem.length };
        Units { force, displacement, length: problem.length, factor: 1.0 }
    }

    /// Returns the unit of the factor of a loading that grows.
    pub fn of_factor(&self, problem: &PathProblem, loading: &Loading) -> f64 {
        match (problem.load_size(loading), settled(loading, self.length)) {
            (size, _) if size > 0.0 => self.force / size,
            (_, settlement) if settlement > 0.0 => self.displacement / settlement,
            _ => 1.0,
        }
    }

    /// Returns the units of a body's motion (x, y, θ).
    pub fn motion(&self) -> [f64; 3] {
        [self.displacement, self.displacement, self.displacement / self.length]
    }

    /// Returns the unit of energy.
    pub fn energy(&self) -> f64 {
        self.force * self.displacement
    }
}
