//! Numbers as texts with a number of significant digits.

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
