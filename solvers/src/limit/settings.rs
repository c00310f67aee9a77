//! The tolerances of limit analysis.

/// Defines the struct of tolerances with the value of each. Shares are less than 1, ratios greater.
macro_rules! tolerances {
    (
        from($($given:ident),*)
        shares { $($(#[$share_doc:meta])* $share:ident = $share_value:expr,)* }
        ratios { $($(#[$ratio_doc:meta])* $ratio:ident = $ratio_value:expr,)* }
    ) => {
        /// Tolerances of limit analysis. Forces are in units of the loads, factors in the unit in which both loads have
        /// the same size, multipliers and motions in units of their greatest entry.
        #[derive(Debug, Clone, Copy, PartialEq)]
        pub struct LimitSettings {
            $($(#[$share_doc])* pub $share: f64,)*
            $($(#[$ratio_doc])* pub $ratio: f64,)*
        }

        impl LimitSettings {
            #[cfg(test)]
            const NAMES: &[&str] = &[$(stringify!($share),)* $(stringify!($ratio),)*];

            /// Derives all tolerances from three of them.
            pub const fn derived($($given: f64),*) -> Self {
                LimitSettings { $($share: $share_value,)* $($ratio: $ratio_value,)* }
            }

            /// Returns the first tolerance that is not positive and finite, or a share or ratio on the wrong side of 1.
            const fn out_of_range(&self) -> Option<&'static str> {
                $(if !(self.$share > 0.0 && self.$share < 1.0) { return Some(stringify!($share)); })*
                $(if !(self.$ratio > 1.0 && self.$ratio < f64::INFINITY) { return Some(stringify!($ratio)); })*
                None
            }
        }
    };
}

tolerances! {
    from(rounding, admissible, active)
    shares {
        /// Error of sums over a scene: a residual below it is rounding.
        rounding = rounding,
        /// Accepted error of fields and motions: a tenth of the tolerance of certificates.
        admissible = admissible,
        /// Size above which multipliers, slacks and singular values count as non-zero.
        active = active,
        /// Residual below which a correction gains nothing.
        exhausted = 1e-3 * rounding,
        /// Factor that counts as zero.
        zero = 1e-2 * rounding,
        /// Share of a sum that is rounding of its terms; also the error of a field on the yield surface.
        balanced = 10.0 * rounding,
        /// Share of the greatest entry below which an entry is negligible and rank ends.
        negligible = 0.1 * active,
        /// Accepted error of a field that only shows that loads are carried: half of the tolerance of certificates.
        carried = 5.0 * admissible,
        /// Error of an iterate of the interior point method that ends it.
        settled = 2.0 * rounding,
        /// Gap of the interior point method below which only rounding errors of the motion remain.
        exhausted_gap = 0.5 * rounding,
        /// Residuals of the interior point method above which no polish is tried.
        unpolished = 1e-4,
        /// Gap below which a polish is tried.
        close_gap = 1e-5,
        /// Factor in its unit below which it counts as zero.
        least_factor = 1e3 * active,
        /// Accepted error of the equilibrium of a direction, relative to the gap.
        missed = 1e-4,
        /// Addition to each pivot, relative to it.
        pivot = 0.1 * rounding,
        /// Weight of a force without a bound.
        unbounded = active,
        /// Part of a row that is independent of others, relative to the row.
        independent = 1e3 * active,
        /// Shift of singular systems.
        shift = 10.0 * active,
        /// Shift that is tried if the smaller one leaves no pivot.
        great_shift = 1e3 * active,
        /// Share of the greatest jump, slack or multiplier below which a joint of a mechanism counts as not moving.
        moves = 10.0 * active,
        /// Relative width of a closed bracket, and error of a converged sequence.
        closed = 1e3 * active,
        /// Relative distance below a known state at which a search ends.
        below_state = 10.0 * active,
        /// Relative distance above a known state at which the program of all products ends.
        above_state = 1e-5,
        /// Second difference of data, relative to the greatest of their kind, above which data jump.
        jump = 1e3 * active,
        /// Relative distance above which two solutions are distinct.
        apart = 1e2 * active,
        /// Change of forces below which the end of a sequence is solved directly.
        close_forces = 1e-4,
        /// Size of negative multipliers of products up to which they are corrected.
        nearly = 1e3 * active,
        /// Share of the residual that remains after a correction of products.
        left = 1e2 * active,
        /// Greatest residual of exact multipliers of products.
        exact = 0.1 * rounding,
    }
    ratios {
        /// Ratio of a multiplier to its slack, or the reverse, that decides which of them is zero.
        clear = 1e2,
        /// Factor in its unit above which it may have no bound.
        greatest_factor = 1e7,
        /// Strength in units of the loads above which programs are also tried in the unit of the strength.
        strong = 1e2,
        /// Growth of the error beyond the least one after which the tangents count as divergent.
        diverged = 10.0,
        /// Loss of a bound by products per residual.
        product_margin = 1e4,
    }
}

/// The tolerances that all solvers of limit analysis share, validated by the compiler.
pub const SETTINGS: LimitSettings = match LimitSettings::derived(1e-13, 1e-11, 1e-9).validated() {
    Ok(settings) => settings,
    Err(_) => panic!("a tolerance of limit analysis is wrong"),
};

impl LimitSettings {
    /// Refuses tolerances out of their range, and inconsistent bounds. The error is the tolerance's name.
    pub const fn validated(self) -> Result<Self, &'static str> {
        if let Some(name) = self.out_of_range() {
            return Err(name);
        }
        // Each value is less than the next one.
        let ordered = [
            ("exhausted", self.exhausted, self.rounding),
            ("rounding", self.rounding, self.admissible),
            ("exhausted_gap", self.exhausted_gap, self.settled),
            ("settled", self.settled, self.admissible),
            ("carried", self.admissible, self.carried),
            ("carried", self.carried, self.active),
            ("great_shift", self.shift, self.great_shift),
            ("close_gap", self.close_gap, self.unpolished),
            ("below_state", self.below_state, self.closed),
        ];
        let mut k = 0;
        while k < ordered.len() {
            if ordered[k].1 >= ordered[k].2 {
                return Err(ordered[k].0);
            }
            k += 1;
        }
        Ok(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The tolerances in use are consistent, and at most forty. Certificates allow twice the errors that these tolerances accept.
    #[test]
    fn the_tolerances_in_use_are_valid() {
        assert_eq!(SETTINGS.validated(), Ok(SETTINGS));
        assert!(LimitSettings::NAMES.len() <= 40);
        const { assert!(SETTINGS.carried <= 0.5 * voussoir_core::certificate::ROUNDING) };
    }

    /// NaN, negative and infinite numbers and bounds in the wrong order are refused by name.
    #[test]
    fn nonsense_is_refused_by_name() {
        for (wrong, name) in [
            (LimitSettings { rounding: f64::NAN, ..SETTINGS }, "rounding"),
            (LimitSettings { active: -1e-9, ..SETTINGS }, "active"),
            (LimitSettings { shift: 0.0, ..SETTINGS }, "shift"),
            (LimitSettings { diverged: f64::INFINITY, ..SETTINGS }, "diverged"),
            (LimitSettings { strong: 0.5, ..SETTINGS }, "strong"),
            (LimitSettings { carried: 1e-12, ..SETTINGS }, "carried"),
            (LimitSettings { great_shift: 1e-8, ..SETTINGS }, "great_shift"),
            (LimitSettings::derived(1e-10, 1e-11, 1e-9), "rounding"),
        ] {
            assert_eq!(wrong.validated(), Err(name));
        }
    }
}
