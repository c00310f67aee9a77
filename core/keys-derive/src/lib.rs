//! The derive `Keys`, which `voussoir_core::plugin` re-exports and describes.
//!
//! It reads a struct or an enum and writes three things: the keys of the table as `Parameter`s, the reader (`Deserialize`,
//! which refuses unknown keys and fills in the defaults) and the writer (`Serialize`).
#![forbid(unsafe_code)]

mod attributes;
mod default;
mod expand;
mod range;
mod shape;

/// Declares the keys of a table. `voussoir_core::plugin::Keys` describes the attributes.
#[proc_macro_derive(Keys, attributes(key, keys))]
pub fn keys(input: proc_macro::TokenStream) -> proc_macro::TokenStream {
    let expanded = syn::parse(input).and_then(|input| expand::expand(&input));
    expanded.unwrap_or_else(|error| error.to_compile_error()).into()
}
