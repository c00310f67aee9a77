//! Compares files that were written on another processor: words must be equal, numbers may differ by rounding.

/// Greatest difference of two numbers relative to themselves.
const RELATIVE: f64 = 1e-9;
/// Greatest difference relative to the greatest number of the file.
const FLOOR: f64 = 1e-12;
/// Bound of the numbers of a file.
const MAX_NUMBER: f64 = 1e30;

/// Returns true if two texts differ only in the rounding of their numbers: by one unit of the last place, or by 1e-9.
pub(crate) fn same_but_rounding(stored: &[u8], made: &[u8]) -> bool {
    let (Ok(stored), Ok(made)) = (std::str::from_utf8(stored), std::str::from_utf8(made)) else { return false };
    let (stored, made) = (pieces(stored), pieces(made));
    let numbers = stored.iter().chain(&made).filter_map(|piece| piece.number());
    // Parts of hashes can look like powers of ten; no number of a file is so great.
    let greatest = numbers.map(f64::abs).filter(|x| *x < MAX_NUMBER).fold(0.0, f64::max);
    stored.len() == made.len() && stored.iter().zip(&made).all(|(a, b)| a.same(b, greatest))
}

/// A piece of a text.
#[derive(Debug, PartialEq)]
enum Piece<'a> {
    Words(&'a str),
    Number(&'a str),
}

impl Piece<'_> {
    fn number(&self) -> Option<f64> {
        match self {
            Piece::Words(_) => None,
            Piece::Number(text) => text.parse().ok(),
        }
    }

    fn same(&self, other: &Piece, greatest: f64) -> bool {
        let (Piece::Number(a), Piece::Number(b)) = (self, other) else { return self == other };
        if a == b {
            return true;
        }
        let (Some(x), Some(y)) = (self.number(), other.number()) else { return a == b };
        // A whole number is a count or part of a name.
        let whole = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit());
        if whole(a) && whole(b) {
            return a == b;
        }
        let last = unit(a).max(unit(b)).min(x.abs().max(y.abs()).max(1e-3) * 1e-2);
        (x - y).abs() <= (RELATIVE * x.abs().max(y.abs()) + FLOOR * greatest).max(1.000_001 * last)
    }
}

/// One unit of the last place of a number.
fn unit(text: &str) -> f64 {
    let (mantissa, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
    let decimals = mantissa.split_once('.').map_or(0, |(_, after)| after.len() as i32);
    10f64.powi(exponent.parse::<i32>().unwrap_or(0) - decimals)
}

/// Cuts a text into numbers and the words between them.
fn pieces(text: &str) -> Vec<Piece<'_>> {
    let bytes = text.as_bytes();
    let digit = |i: usize| bytes.get(i).is_some_and(u8::is_ascii_digit);
    let (mut out, mut from, mut at) = (Vec::new(), 0, 0);
    while at < bytes.len() {
        let signed = bytes[at] == b'-' && (digit(at + 1) || (bytes.get(at + 1) == Some(&b'.') && digit(at + 2)));
        if !digit(at) && !signed {
            at += 1;
            continue;
        }
        let begin = at;
        at += 1;
        while digit(at) || (bytes.get(at) == Some(&b'.') && digit(at + 1)) {
            at += 1;
        }
        if matches!(bytes.get(at), Some(b'e' | b'E')) {
            let sign = usize::from(matches!(bytes.get(at + 1), Some(b'-' | b'+')));
            if digit(at + 1 + sign) {
                at += 1 + sign;
                while digit(at) {
                    at += 1;
                }
            }
        }
        out.push(Piece::Words(&text[from..begin]));
        out.push(Piece::Number(&text[begin..at]));
        from = at;
    }
    out.push(Piece::Words(&text[from..]));
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_may_be_rounded_and_words_may_not_change() {
        let same = |a: &str, b: &str| same_but_rounding(a.as_bytes(), b.as_bytes());
        assert!(same("x=\"1.25\" y=\"-3\"", "x=\"1.26\" y=\"-3\""), "one unit of the last place");
        assert!(!same("x=\"1.25\"", "x=\"1.27\""), "two units");
        assert!(same("0.333333333333333", "0.333333333333334") && !same("0.333333333333", "0.333333335"));
        assert!(same("1e3 1.2e-17", "1e3 -3.4e-18") && !same("1.2e-17", "2.2e-17"));
        assert!(same("-0.00", "0.00") && !same("collapse 1.5", "stands 1.5") && !same("joint 12", "joint 13"));
        assert!(!same("1.5, 2.5", "1.5") && same("", ""));
    }
}
