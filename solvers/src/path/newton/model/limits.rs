//! Limits that differ between small and finite displacements, and between laws with and without a history. They are chosen once,
//! when the system of a step is built.

use crate::path::system::Units;
use crate::settings::SETTINGS;
use voussoir_core::path::PathProblem;

/// Limits of the iterations of Newton's method.
#[derive(Debug, Clone)]
pub struct Iterations {
    /// Greatest number of iterations of Newton's method.
    pub iterations: u64,
    /// Greatest number of iterations with equations without a solution: the solution of the shifted equations, which
    /// act as a soft bedding, shows the points that close.
    pub unsolved: u32,
    /// Greatest number of iterations in which few points change and do not become fewer; with more, they form a cycle.
    pub cycle: u32,
    /// Greatest number of iterations for a load in one step.
    pub one_step: u64,
}

/// Limits of Newton's method and of steps.
#[derive(Debug, Clone)]
pub struct Limits {
    /// True if rates depend on the history: points that yield have other tangents than points that unload.
    pub remembers: bool,
    /// True if equations and factors of a state may be used at nearby states: elastic chains with facets.
    pub nearby: bool,
    /// True if one piece may carry any load.
    pub carries_any_load: bool,
    pub newton: Iterations,
    /// Residual that is rounding.
    pub rounding: f64,
    /// Distance from the predictor, relative to the step, beyond which a state is on another branch of a law.
    pub branch: f64,
    /// Size to which rounding of positions is relative \[m\]; zero with small displacements.
    pub place: f64,
    /// Accuracy of positions in Newton's method, relative to the displacements.
    pub position: f64,
    /// Greatest rotation of an iteration \[rad\].
    pub rotation: f64,
    /// Greatest force, relative to its unit, for which forces of a state are compared only with each other.
    pub weak: f64,
    /// First part of the motion of a mechanism that is followed, as a share.
    pub mechanism: f64,
    /// Accepted energy error of a step, relative to its stage.
    pub energy: f64,
}

impl Limits {
    /// Returns the limits of a problem, for `finite` or small displacements; `chain`: its elastic blocks form a chain.
    pub fn of(problem: &PathProblem, finite: bool, chain: bool, units: Units) -> Limits {
        let (bonds, yields) = (problem.contacts.iter().any(|c| c.law.response().is_some()), problem.yields());
        let remembers = bonds || yields;
        let mut limits = Limits {
            remembers,
            nearby: finite && chain && !remembers,
            // The strength of a block that may yield bounds the load, and so do displaced positions.
            carries_any_load: !yields && !finite,
            newton: Iterations { iterations: 30, unsolved: 10, cycle: u32::MAX, one_step: u64::MAX },
            rounding: 0.0,
            branch: f64::INFINITY,
            place: 0.0,
            position: if yields { SETTINGS.inequality() } else { 0.0 },
            rotation: f64::INFINITY,
            weak: -1.0,
            // With small displacements the mechanism does not change.
            mechanism: 1.0,
            energy: SETTINGS.energy_of_stage,
        };
        if finite {
            limits.newton.iterations = 60 + (problem.contacts.len() as u64).min(200);
            (limits.newton.unsolved, limits.newton.cycle, limits.newton.one_step) = (0, 24, 12);
            limits.rounding = 400.0 * f64::EPSILON * units.length / units.displacement;
            (limits.place, limits.rotation) = (units.length, SETTINGS.largest_rotation);
            (limits.weak, limits.mechanism) = (SETTINGS.small, 1e-3);
        }
        if bonds {
            // A softening law converges soon or not at all: shorter steps cost less than more iterations.
            (limits.newton.iterations, limits.branch) = (25, SETTINGS.half);
            limits.rounding = limits.rounding.max(400.0 * f64::EPSILON);
            // Softening bonds need a smaller energy error in each step.
            limits.energy = SETTINGS.fine;
        }
        limits
    }
}
