//! Numbers in figures: how they are written, and steps of 1, 2 or 5 times a power of ten.

/// `x` with this number of significant digits; powers of ten only below 1e-4 and from 1e7.
pub fn format_number(x: f64, digits: usize) -> String {
    if x == 0.0 || !x.is_finite() {
        return format!("{x}");
    }
    let scientific = format!("{:.*e}", digits.saturating_sub(1), x);
    let exponent: i32 = scientific.split_once('e').and_then(|(_, e)| e.parse().ok()).unwrap_or(0);
    if !(-4..7).contains(&exponent) {
        return scientific;
    }
    format!("{:.*}", (digits as i32 - 1 - exponent).max(0) as usize, x)
}

/// `x` in the shortest form that has at most this number of significant digits.
pub fn format_short(x: f64, digits: usize) -> String {
    let text = format_number(x, digits);
    let (decimals, power) = text.find('e').map_or((text.as_str(), ""), |at| text.split_at(at));
    if !decimals.contains('.') {
        return text;
    }
    format!("{}{power}", decimals.trim_end_matches('0').trim_end_matches('.'))
}

/// `digits` · 10^`exponent` to the nearest double.
fn decimal(digits: i64, exponent: i32) -> f64 {
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
