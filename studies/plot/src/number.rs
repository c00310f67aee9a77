//! Numbers in figures: how they are written, and steps of 1, 2 or 5 times a power of ten.

use voussoir_core::number_text::format_short;

/// `digits` · 10^`exponent` to the nearest double.
pub fn decimal(digits: i64, exponent: i32) -> f64 {
    format!("{digits}e{exponent}").parse().unwrap_or(f64::NAN)
}

/// The greatest step d · 10^k with d of 1, 2 or 5 that does not exceed `x` > 0, as d and k.
fn step_parts(x: f64) -> (i64, i32) {
    let exponent = x.log10().floor() as i32;
    let most = x * (1.0 + 1e-12);
    let digits = [5, 2, 1].into_iter().find(|digits| decimal(*digits, exponent) <= most);
    digits.map_or((5, exponent - 1), |digits| (digits, exponent))
}

/// The greatest step of 1, 2 or 5 times a power of ten that does not exceed `x` > 0.
pub fn step_below(x: f64) -> f64 {
    let (digits, exponent) = step_parts(x);
    decimal(digits, exponent)
}

/// Multiples of the least step of 1, 2 or 5 times a power of ten that gives about `count` values within `low`..`high`.
pub fn round_values(low: f64, high: f64, count: usize) -> Vec<f64> {
    let rough = (high - low) / count.max(1) as f64;
    if !(rough.is_finite() && rough > 0.0) {
        return vec![low];
    }
    let (below, power) = step_parts(0.999 * rough);
    let (digits, exponent) = match below {
        _ if decimal(below, power) >= 0.998 * rough => (below, power),
        1 => (2, power),
        2 => (5, power),
        _ => (1, power + 1),
    };
    let step = decimal(digits, exponent);
    let (first, last) = ((low / step - 1e-9).ceil() as i64, (high / step + 1e-9).floor() as i64);
    (first..=last).map(|i| decimal(i * digits, exponent)).collect()
}

/// The number of a tick.
pub fn tick_label(value: f64) -> String {
    format_short(if value.abs() < 1e-12 { 0.0 } else { value }, 6)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_within() {
        assert_eq!(round_values(0.63, 1.0, 4), [0.7, 0.8, 0.9, 1.0]);
        assert_eq!(round_values(0.0, 1.0, 5), [0.0, 0.2, 0.4, 0.6, 0.8, 1.0]);
        assert_eq!(round_values(1.0, 1.0, 5), [1.0]);
        assert_eq!(round_values(-0.3, 0.3, 6), [-0.3, -0.2, -0.1, 0.0, 0.1, 0.2, 0.3]);
        assert_eq!(round_values(0.0, 7.0e-7, 3), [0.0, 5e-7]);
    }

    /// The step is within a factor of 2.5 below any number, and a step is its own.
    #[test]
    fn steps_are_one_two_five() {
        for (x, step) in [(1.0, 1.0), (1.99, 1.0), (2.0, 2.0), (4.999, 2.0), (0.05, 0.05), (1e-3, 1e-3), (9.9e6, 5e6)] {
            assert_eq!(step_below(x), step, "{x}");
        }
        for i in -700..700 {
            let x = 1.02_f64.powi(i);
            let step = step_below(x);
            assert!(step <= x * (1.0 + 1e-9) && x < 2.5001 * step, "{x} {step}");
        }
    }
}
