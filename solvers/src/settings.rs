//! The numbers that paths, rate problems and contact laws share: tolerances, and parameters of the length of steps.
//!
//! Tolerances derive from three: rounding, admissibility and activity. Each is relative to the size of the judged
//! quantity in the units of the problem, so that results depend neither on the size of a scene nor on its units. Limit
//! analysis has separate tolerances (`limit/settings.rs`).

/// Numbers of paths, rate problems and contact laws.
#[derive(Debug, Clone, Copy)]
pub struct Settings {
    /// Relative residual that is rounding: some hundred times machine precision.
    pub rounding: f64,
    /// Relative error up to which a solution, a state or a law is accepted.
    pub admissible: f64,
    /// Slack up to which a facet takes part in an event, and rate up to which nothing moves.
    pub active: f64,
    /// Residual up to which a solution needs no refinement: ten times machine precision.
    pub refined: f64,
    /// Tolerance of a mode relative to the greatest force. A certificate allows 1e-8.
    pub mode: f64,
    /// Share that is small but not rounding: strength of a pivot, rotation of a step, least motion before an event.
    pub small: f64,
    /// Share below which two effects can be distinguished only with refinement, such as a mechanism and a soft
    /// structure; also the energy error that a step may have.
    pub fine: f64,
    /// Change of the factor in a step with flowing blocks, relative to its motion (elastic step: about 1).
    pub flat: f64,
    /// Accepted energy error of a stage, relative to its energy: half of the tolerance of a certificate.
    pub energy_of_stage: f64,
    /// Visible motion, relative to the size of the scene: a mechanism is followed up to it.
    pub visible: f64,
    /// Motion, relative to the size of the scene, after which a structure counts as fallen.
    pub fallen: f64,
    /// Greatest movement in a step with finite displacements if the strategy sets no bound, relative to the scene.
    pub largest_finite_step: f64,
    /// Load, relative to its unit, at which the modes of the start of a path are determined.
    pub first_load: f64,
    /// Distance of a state from its predictor, relative to the step, at which the next step has the same length.
    pub wanted_error: f64,
    /// Distance of a state from its predictor, relative to the step, above which a step is repeated.
    pub most_error: f64,
    /// Length of a step, relative to the wanted one, above which its error determines the length of the next step.
    pub telling: f64,
    /// Length of a step, relative to the distance to the first event, that makes it contain the event.
    pub beyond: f64,
    /// Load at the end of a falling path, relative to the greatest limit point, by default.
    pub half: f64,
    /// Greatest ratio of successive residuals at which the factorisation of a nearby state is still used.
    pub contraction: f64,
    /// Share of a residual above which an iteration counts as without progress.
    pub stays: f64,
    /// Greatest rotation of an iteration with finite displacements \[rad\].
    pub largest_rotation: f64,
    /// Value of a monitor, relative to its tolerance, up to which it takes part in an event.
    pub together: f64,
    /// Residual of the rates of a chain, relative to one that needs no refinement, above which the next correction is
    /// examined too.
    pub calm: f64,
    /// Decrease of the rates of a chain by a change of modes after which they are summed again, without old rounding.
    pub cancels: f64,
    /// Stiffness of the spring of a weak joint of a chain, relative to the joint with all points stuck.
    pub spring: f64,
    /// Share of the forces of closed points on a moving support below which forces are not compared with each other.
    pub cancelled: f64,
    /// Greatest error of a step in time, relative to the greatest gap and the greatest force.
    pub time_error: f64,
    /// Length of the first step in time, as a share of its load step.
    pub first_time_step: f64,
    /// Least length of a step in time, as a share of its load step.
    pub least_time_step: f64,
}

/// The numbers in use.
pub const SETTINGS: Settings = Settings {
    rounding: 1e-13,
    admissible: 1e-9,
    active: 1e-8,
    refined: 2e-15,
    mode: 3e-9,
    small: 1e-3,
    fine: 1e-4,
    flat: 1e-5,
    energy_of_stage: 5e-4,
    visible: 1e-2,
    fallen: 0.2,
    largest_finite_step: 0.002,
    first_load: 0.05,
    wanted_error: 0.02,
    most_error: 0.1,
    telling: 0.1,
    beyond: 1.02,
    half: 0.5,
    contraction: 0.1,
    stays: 0.3,
    largest_rotation: 0.1,
    together: 100.0,
    calm: 64.0,
    cancels: 16.0,
    spring: 0.1,
    cancelled: 0.1,
    time_error: 1e-6,
    first_time_step: 1.0 / 64.0,
    least_time_step: 1e-9,
}
.validated();

impl Settings {
    /// Returns the same settings if they are consistent.
    ///
    /// # Panics
    /// Panics, when the crate is compiled, if tolerances are not in their order, or a share is not between 0 and 1.
    const fn validated(self) -> Settings {
        assert!(0.0 < self.refined && self.refined < self.rounding, "refined solutions are better than rounding");
        assert!(self.rounding < self.admissible && self.admissible < self.active, "rounding < admissible < active");
        assert!(self.admissible < self.mode && self.mode < self.active, "the tolerance of modes lies below activity");
        assert!(
            self.active < self.flat && self.flat < self.fine && self.fine < self.small && self.small < self.visible
        );
        assert!(self.visible < self.fallen && self.fallen < 1.0, "a structure that has fallen has visibly moved");
        assert!(
            self.fine < self.energy_of_stage && self.energy_of_stage < self.small,
            "a stage leaves more than a step"
        );
        assert!(0.0 < self.largest_finite_step && self.largest_finite_step < self.visible, "steps are not visible");
        assert!(self.wanted_error < self.most_error && self.most_error < 1.0, "a wanted step is not repeated");
        assert!(1.0 < self.beyond && self.beyond < 1.0 + self.most_error, "the event is in the step");
        assert!(0.0 < self.first_load && self.first_load < 1.0 && 0.0 < self.half && self.half < 1.0);
        assert!(self.contraction < self.stays && self.stays < 1.0 && self.telling <= 1.0, "shares of a residual");
        assert!(self.largest_rotation < 1.0 && self.spring < 1.0 && self.cancelled < 1.0 && self.cancelled > 0.0);
        assert!(self.admissible < self.time_error && self.time_error < self.fine, "equilibrium is finer than time");
        assert!(0.0 < self.least_time_step && self.least_time_step < self.first_time_step);
        assert!(self.together >= 1.0 && self.calm > 1.0 && self.cancels > 1.0, "factors above 1");
        self
    }

    /// Returns the precision of a residual.
    pub const fn ulps(&self) -> f64 {
        0.01 * self.rounding
    }

    /// Returns the share of its first size below which an update is negligible.
    pub const fn negligible(&self) -> f64 {
        0.1 * self.rounding
    }

    /// Returns the residual of gaps compared with the rates of forces: the error of the forces.
    pub const fn error_of_forces(&self) -> f64 {
        2.0 * self.rounding
    }

    /// Returns the residual of a direction above which it is solved again.
    pub const fn residual(&self) -> f64 {
        10.0 * self.rounding
    }

    /// Returns the shift of a factorised matrix, which refinement removes. Smaller pivots count as zero.
    pub const fn shift(&self) -> f64 {
        100.0 * self.rounding
    }

    /// Returns the tolerance of inequalities and of equilibrium: a tenth of the tolerance of certificates.
    pub const fn inequality(&self) -> f64 {
        0.1 * self.admissible
    }

    /// Returns the difference up to which two rates are the same.
    pub const fn same_rate(&self) -> f64 {
        10.0 * self.active
    }

    /// Returns the difference above which two loads, motions or works are distinct.
    pub const fn distinct(&self) -> f64 {
        100.0 * self.active
    }

    /// Returns the share of a step after which its corner counts as its end.
    pub const fn nearly(&self) -> f64 {
        1.0 - self.admissible
    }

    /// Returns the rate above which a rate has no bound.
    pub const fn unbounded(&self) -> f64 {
        1.0 / self.inequality()
    }

    /// Returns the flexibility above which a motion has no stiffness.
    pub const fn soft(&self) -> f64 {
        1.0 / self.active
    }

    /// Returns the greatest entry of an inverse, relative to 1: greater entries lose too many digits.
    pub const fn largest_inverse(&self) -> f64 {
        1.0 / self.distinct()
    }
}

#[cfg(test)]
mod tests {
    use super::SETTINGS;

    /// Derived tolerances stay in the order of their use: no later part refuses a state that an earlier one accepts.
    #[test]
    fn derived_tolerances_are_in_order() {
        let ascending = [
            SETTINGS.ulps(),
            SETTINGS.negligible(),
            SETTINGS.rounding,
            SETTINGS.error_of_forces(),
            SETTINGS.residual(),
            SETTINGS.shift(),
            SETTINGS.inequality(),
            SETTINGS.admissible,
            SETTINGS.mode,
            SETTINGS.active,
            SETTINGS.same_rate(),
            SETTINGS.distinct(),
        ];
        assert!(ascending.is_sorted_by(|a, b| a < b), "{ascending:?}");
        const { assert!(SETTINGS.ulps() > f64::EPSILON) };
    }
}
