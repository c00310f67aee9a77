//! The tolerances of limit analysis.

/// Tolerances of limit analysis. Forces are in units of the loads, factors in the unit in which both loads have the
/// same size, multipliers and motions in units of their greatest entry.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LimitSettings {
    /// Error of sums over a scene: a residual below it is rounding.
    pub rounding: f64,
    /// Accepted error of fields and motions: a tenth of the tolerance of certificates.
    pub admissible: f64,
    /// Size above which multipliers, slacks and singular values count as non-zero.
    pub active: f64,
    /// Residual below which a correction gains nothing.
    pub exhausted: f64,
    /// Factor that counts as zero.
    pub zero: f64,
    /// Share of a sum that is rounding of its terms; also the error of a field on the yield surface.
    pub balanced: f64,
    /// Share of the greatest entry below which an entry is negligible and rank ends.
    pub negligible: f64,
    /// Accepted error of a field that only shows that loads are carried: half of the tolerance of certificates.
    pub carried: f64,
    /// Error of an iterate of the interior point method that ends it.
    pub settled: f64,
    /// Gap of the interior point method below which only rounding errors of the motion remain.
    pub exhausted_gap: f64,
    /// Residuals of the interior point method above which no polish is tried.
    pub unpolished: f64,
    /// Gap below which a polish is tried.
    pub close_gap: f64,
    /// Ratio of a multiplier to its slack, or the reverse, that decides which of them is zero.
    pub clear: f64,
    /// Factor in its unit below which it counts as zero.
    pub least_factor: f64,
    /// Factor in its unit above which it may have no bound.
    pub greatest_factor: f64,
    /// Accepted error of the equilibrium of a direction, relative to the gap.
    pub missed: f64,
    /// Addition to each pivot, relative to it.
    pub pivot: f64,
    /// Weight of a force without a bound.
    pub unbounded: f64,
    /// Part of a row that is independent of others, relative to the row.
    pub independent: f64,
    /// Shift of singular systems.
    pub shift: f64,
    /// Shift that is tried if the smaller one leaves no pivot.
    pub great_shift: f64,
    /// Share of the greatest jump, slack or multiplier below which a joint of a mechanism counts as not moving.
    pub moves: f64,
    /// Relative width of a closed bracket, and error of a converged sequence.
    pub closed: f64,
    /// Relative distance below a known state at which a search ends.
    pub below_state: f64,
    /// Relative distance above a known state at which the program of all products ends.
    pub above_state: f64,
    /// Second difference of data, relative to the greatest of their kind, above which data jump.
    pub jump: f64,
    /// Relative distance above which two solutions are distinct.
    pub apart: f64,
    /// Change of forces below which the end of a sequence is solved directly.
    pub close_forces: f64,
    /// Strength in units of the loads above which tangents replace a stress block.
    pub flat: f64,
    /// Strength in units of the loads above which programs are also tried in the unit of the strength.
    pub strong: f64,
    /// Growth of the error beyond the least one after which the tangents count as divergent.
    pub diverged: f64,
    /// Loss of a bound by products per residual.
    pub product_margin: f64,
    /// Size of negative multipliers of products up to which they are corrected.
    pub nearly: f64,
    /// Share of the residual that remains after a correction of products.
    pub left: f64,
    /// Greatest residual of exact multipliers of products.
    pub exact: f64,
}

/// The tolerances that all solvers of limit analysis share, validated by the compiler.
pub const SETTINGS: LimitSettings = match LimitSettings::derived(1e-13, 1e-11, 1e-9).validated() {
    Ok(settings) => settings,
    Err(_) => panic!("a tolerance of limit analysis is wrong"),
};

impl LimitSettings {
    /// Derives all tolerances from three of them.
    pub const fn derived(rounding: f64, admissible: f64, active: f64) -> Self {
        LimitSettings {
            rounding,
            admissible,
            active,
            exhausted: 1e-3 * rounding,
            zero: 1e-2 * rounding,
            balanced: 10.0 * rounding,
            negligible: 0.1 * active,
            carried: 5.0 * admissible,
            settled: 2.0 * rounding,
            exhausted_gap: 0.5 * rounding,
            unpolished: 1e-4,
            close_gap: 1e-5,
            clear: 1e2,
            least_factor: 1e3 * active,
            greatest_factor: 1e7,
            missed: 1e-4,
            pivot: 0.1 * rounding,
            unbounded: active,
            independent: 1e3 * active,
            shift: 10.0 * active,
            great_shift: 1e3 * active,
            moves: 10.0 * active,
            closed: 1e3 * active,
            below_state: 10.0 * active,
            above_state: 1e-5,
            jump: 1e3 * active,
            apart: 1e2 * active,
            close_forces: 1e-4,
            flat: 1e6,
            strong: 1e2,
            diverged: 10.0,
            product_margin: 1e4,
            nearly: 1e3 * active,
            left: 1e2 * active,
            exact: 0.1 * rounding,
        }
    }

    /// Refuses numbers that are not positive and finite, and inconsistent bounds. The error is the tolerance's name.
    pub const fn validated(self) -> Result<Self, &'static str> {
        let shares = [
            ("rounding", self.rounding),
            ("admissible", self.admissible),
            ("active", self.active),
            ("exhausted", self.exhausted),
            ("zero", self.zero),
            ("balanced", self.balanced),
            ("negligible", self.negligible),
            ("carried", self.carried),
            ("settled", self.settled),
            ("exhausted_gap", self.exhausted_gap),
            ("unpolished", self.unpolished),
            ("close_gap", self.close_gap),
            ("least_factor", self.least_factor),
            ("missed", self.missed),
            ("pivot", self.pivot),
            ("unbounded", self.unbounded),
            ("independent", self.independent),
            ("shift", self.shift),
            ("great_shift", self.great_shift),
            ("moves", self.moves),
            ("closed", self.closed),
            ("below_state", self.below_state),
            ("above_state", self.above_state),
            ("jump", self.jump),
            ("apart", self.apart),
            ("close_forces", self.close_forces),
            ("nearly", self.nearly),
            ("left", self.left),
            ("exact", self.exact),
        ];
        let mut k = 0;
        while k < shares.len() {
            if !(shares[k].1 > 0.0 && shares[k].1 < 1.0) {
                return Err(shares[k].0);
            }
            k += 1;
        }
        let ratios = [
            ("clear", self.clear),
            ("greatest_factor", self.greatest_factor),
            ("flat", self.flat),
            ("strong", self.strong),
            ("diverged", self.diverged),
            ("product_margin", self.product_margin),
        ];
        k = 0;
        while k < ratios.len() {
            if !(ratios[k].1 > 1.0 && ratios[k].1 < f64::INFINITY) {
                return Err(ratios[k].0);
            }
            k += 1;
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
        k = 0;
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

    /// The tolerances in use are consistent. Certificates allow twice the errors that these tolerances accept.
    #[test]
    fn the_tolerances_in_use_are_valid() {
        assert_eq!(SETTINGS.validated(), Ok(SETTINGS));
        const { assert!(SETTINGS.carried <= 0.5 * voussoir_core::certificate::ROUNDING) };
    }

    /// NaN, negative and infinite numbers and bounds in the wrong order are refused by name.
    #[test]
    fn nonsense_is_refused_by_name() {
        for (wrong, name) in [
            (LimitSettings { rounding: f64::NAN, ..SETTINGS }, "rounding"),
            (LimitSettings { active: -1e-9, ..SETTINGS }, "active"),
            (LimitSettings { shift: 0.0, ..SETTINGS }, "shift"),
            (LimitSettings { flat: f64::INFINITY, ..SETTINGS }, "flat"),
            (LimitSettings { strong: 0.5, ..SETTINGS }, "strong"),
            (LimitSettings { carried: 1e-12, ..SETTINGS }, "carried"),
            (LimitSettings { great_shift: 1e-8, ..SETTINGS }, "great_shift"),
            (LimitSettings::derived(1e-10, 1e-11, 1e-9), "rounding"),
        ] {
            assert_eq!(wrong.validated(), Err(name));
        }
    }
}
