//! Defaults. One text, which TOML and JSON read alike, serves the card and the reader.

use proc_macro2::TokenStream;
use quote::quote;
use syn::{Error, Expr, ExprArray, ExprLit, ExprUnary, Lit, Result, UnOp};

/// A default as text, and as the compiler can compare it with the shape of its key.
pub struct Default {
    pub text: String,
    pub known: TokenStream,
}

/// Reads a default: a number, a text, `true` or `false`, a list of these, `{}` for an empty table.
pub fn read(value: &Expr) -> Result<Default> {
    let core = super::attributes::core();
    let text = text(value)?;
    let known = match value {
        Expr::Lit(ExprLit { lit: Lit::Str(word), .. }) => quote!(#core::keys::Literal::Word(#word)),
        Expr::Lit(ExprLit { lit: Lit::Float(_) | Lit::Int(_), .. }) | Expr::Unary(_) => {
            quote!(#core::keys::Literal::Number((#value) as f64))
        }
        _ => quote!(#core::keys::Literal::Other),
    };
    Ok(Default { text, known })
}

fn text(value: &Expr) -> Result<String> {
    let wrong = || {
        Error::new_spanned(
            value,
            "a default is a number, a text, true or false, a list of these, or {} for an empty table",
        )
    };
    match value {
        Expr::Lit(ExprLit { lit, .. }) => match lit {
            Lit::Float(number) => Ok(number.base10_digits().to_string()),
            Lit::Int(number) => Ok(number.base10_digits().to_string()),
            Lit::Bool(value) => Ok(value.value.to_string()),
            Lit::Str(text) if !text.value().contains(['"', '\\', '\n']) => Ok(format!("\"{}\"", text.value())),
            _ => Err(wrong()),
        },
        Expr::Unary(ExprUnary { op: UnOp::Neg(_), expr, .. }) => match expr.as_ref() {
            Expr::Lit(ExprLit { lit: Lit::Float(_) | Lit::Int(_), .. }) => Ok(format!("-{}", self::text(expr)?)),
            _ => Err(wrong()),
        },
        Expr::Array(ExprArray { elems, .. }) => {
            Ok(format!("[{}]", elems.iter().map(self::text).collect::<Result<Vec<_>>>()?.join(", ")))
        }
        Expr::Block(block) if block.block.stmts.is_empty() => Ok("{}".into()),
        _ => Err(wrong()),
    }
}
