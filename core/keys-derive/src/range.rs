//! Ranges in words that compare: `"> 0"`, `">= 0, < 90"`.

use proc_macro2::TokenStream;
use quote::{quote, quote_spanned};
use syn::{Error, Expr, LitStr, Result};

/// One end of a range.
struct End {
    value: Expr,
    open: bool,
}

/// The two ends that a text gives.
struct Ends {
    low: Option<End>,
    high: Option<End>,
}

const FORM: &str = "a range compares with numbers: \"> 0\", \">= 0, < 90\"; it is \"\" where any number goes";

fn ends(text: &LitStr) -> Result<Ends> {
    let mut ends = Ends { low: None, high: None };
    let wrong = |why: String| Error::new(text.span(), format!("{why}; {FORM}"));
    for part in text.value().split(',').filter(|_| !text.value().is_empty()) {
        let part = part.trim().replace('≥', ">=").replace('≤', "<=");
        let signs = [(">=", true, false), ("<=", false, false), (">", true, true), ("<", false, true)];
        let Some((sign, low, open)) = signs.into_iter().find(|(sign, ..)| part.starts_with(sign)) else {
            return Err(wrong(format!("`{part}` is no comparison")));
        };
        let bound = LitStr::new(part[sign.len()..].trim(), text.span());
        let value = bound.parse().map_err(|_| wrong(format!("`{}` is no number", bound.value())))?;
        let end = if low { &mut ends.low } else { &mut ends.high };
        if end.replace(End { value, open }).is_some() {
            return Err(wrong("two comparisons bound the same end".into()));
        }
    }
    Ok(ends)
}

/// The `Range` of a number.
pub fn number(text: Option<&LitStr>) -> Result<TokenStream> {
    let core = super::attributes::core();
    let Some(text) = text else { return Ok(quote!(#core::Range::ANY)) };
    let ends = ends(text)?;
    let side = |end: &Option<End>, infinite: TokenStream| match end {
        Some(End { value, open }) => quote!((#value) as f64, #open),
        None => quote!(#infinite, true),
    };
    let (low, high) = (side(&ends.low, quote!(f64::NEG_INFINITY)), side(&ends.high, quote!(f64::INFINITY)));
    Ok(quote_spanned!(text.span()=> #core::Range::new(#low, #high)))
}

/// Least and greatest value of a whole number, both included.
pub fn integer(text: Option<&LitStr>, signed: bool) -> Result<[TokenStream; 2]> {
    let mut pair = [if signed { quote!(i64::MIN) } else { quote!(0) }, quote!(i64::MAX)];
    let Some(text) = text else { return Ok(pair) };
    let Ends { low, high } = ends(text)?;
    if let Some(End { value, open }) = low {
        pair[0] = if open { quote!((#value) as i64 + 1) } else { quote!((#value) as i64) };
    }
    if let Some(End { value, open }) = high {
        pair[1] = if open { quote!((#value) as i64 - 1) } else { quote!((#value) as i64) };
    }
    Ok(pair)
}

/// Least and greatest number of entries of a list.
pub fn length(text: Option<&LitStr>) -> Result<[TokenStream; 2]> {
    let mut pair = [quote!(0), quote!(usize::MAX)];
    let Some(text) = text else { return Ok(pair) };
    let Ends { low, high } = ends(text)?;
    if let Some(End { value, open }) = low {
        pair[0] = if open { quote!((#value) as usize + 1) } else { quote!((#value) as usize) };
    }
    if let Some(End { value, open }) = high {
        pair[1] = if open { quote!((#value) as usize - 1) } else { quote!((#value) as usize) };
    }
    Ok(pair)
}
