//! The derive `Keys`, which `voussoir_core::plugin` and `voussoir_plug::plugin` re-export. The trait `Keys` describes it.
//!
//! It reads a struct or an enum and writes three things: the keys of the table as `Parameter`s, the reader (`Deserialize`,
//! which refuses unknown keys and fills in the defaults) and the writer (`Serialize`).
#![forbid(unsafe_code)]

mod attributes;
mod default;
mod expand;
mod range;
mod shape;

use quote::quote;

fn derive(input: proc_macro::TokenStream, root: &proc_macro2::TokenStream) -> proc_macro::TokenStream {
    let expanded = syn::parse(input).and_then(|input| expand::expand(&input, root));
    expanded.unwrap_or_else(|error| error.to_compile_error()).into()
}

/// Declares the keys of a table. `voussoir_core::plugin::Keys` describes the attributes.
#[proc_macro_derive(Keys, attributes(key, keys))]
pub fn keys(input: proc_macro::TokenStream) -> proc_macro::TokenStream {
    derive(input, &quote!(::voussoir_core::plugin))
}

/// The derive `Keys` for a crate that depends on `voussoir-plug` and not on `voussoir-core`. A derive cannot find out under
/// which name a crate is linked, so there is one for each name.
#[proc_macro_derive(PlugKeys, attributes(key, keys))]
pub fn plug_keys(input: proc_macro::TokenStream) -> proc_macro::TokenStream {
    derive(input, &quote!(::voussoir_plug::plugin))
}
