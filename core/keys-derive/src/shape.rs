//! The shape of a value, from the type of its field and what its attribute adds.

use super::attributes::{Key, RangeOf, core};
use super::range;
use proc_macro2::TokenStream;
use quote::{quote, quote_spanned};
use syn::spanned::Spanned;
use syn::{Error, GenericArgument, PathArguments, PathSegment, Result, Type};

/// The last segment of a type's path.
fn segment(of: &Type) -> Option<&PathSegment> {
    match of {
        Type::Path(path) if path.qself.is_none() => path.path.segments.last(),
        _ => None,
    }
}

fn argument(segment: &PathSegment, index: usize) -> Option<&Type> {
    let PathArguments::AngleBracketed(arguments) = &segment.arguments else { return None };
    let types = arguments.args.iter().filter_map(|argument| match argument {
        GenericArgument::Type(of) => Some(of),
        _ => None,
    });
    types.into_iter().nth(index)
}

/// The type inside of `Option`.
pub fn inside_option(of: &Type) -> Option<&Type> {
    segment(of).filter(|segment| segment.ident == "Option").and_then(|segment| argument(segment, 0))
}

const SIGNED: [&str; 5] = ["i8", "i16", "i32", "i64", "isize"];
const UNSIGNED: [&str; 5] = ["u8", "u16", "u32", "u64", "usize"];

/// The shape of a field, whose `Option` is taken off already.
pub fn shape(of: &Type, key: &Key) -> Result<TokenStream> {
    if let Some(shape) = &key.shape {
        return Ok(quote!(#shape));
    }
    let mut used = Used::default();
    let shape = inner(of, key, 0, &mut used)?;
    let unit = key.unit.as_ref().and_then(|unit| unit.first()).filter(|_| !used.number);
    if let Some(unit) = unit {
        return Err(Error::new(unit.span(), "a unit belongs to a number (f64), and this key holds none"));
    }
    let named = key.names.as_ref().and_then(|names| names.first()).filter(|_| !used.names);
    if let Some(name) = named {
        return Err(Error::new(name.span(), "names belong to the entries of an array, such as [f64; 2]"));
    }
    if let Some(len) = key.len.as_ref().filter(|_| !used.list) {
        return Err(Error::new(len.span(), "a length belongs to a list (Vec)"));
    }
    if let Some(table) = key.reference.as_ref().filter(|_| !used.text) {
        return Err(Error::new(table.span(), "a reference is a name: its type is String"));
    }
    let range = match &key.range {
        Some(RangeOf::Texts(texts)) => texts.first().map(Spanned::span),
        Some(RangeOf::Constant(constant)) => Some(constant.span()),
        None => None,
    };
    match range.filter(|_| !used.number && !used.integer) {
        Some(span) => Err(Error::new(span, "a range belongs to a number, and this key holds none")),
        None => Ok(shape),
    }
}

/// Which attributes the shape has read.
#[derive(Default)]
struct Used {
    number: bool,
    integer: bool,
    names: bool,
    list: bool,
    text: bool,
}

fn inner(of: &Type, key: &Key, entry: usize, used: &mut Used) -> Result<TokenStream> {
    let core = core();
    if let Type::Array(array) = of {
        let length = &array.len;
        let Some(names) = &key.names else {
            let shape = inner(&array.elem, key, entry, used)?;
            return Ok(quote!(#core::Shape::List { of: &#shape, min: #length, max: #length }));
        };
        used.names = true;
        let one = |(index, name)| {
            let shape = inner(&array.elem, key, index, used)?;
            Ok(quote!((#name, #shape)))
        };
        let entries = names.iter().enumerate().map(one).collect::<Result<Vec<_>>>()?;
        return Ok(quote!(#core::Shape::Tuple(&[#(#entries),*])));
    }
    let Some(segment) = segment(of) else {
        return Ok(quote!(<#of as #core::KeyValue>::SHAPE));
    };
    let name = segment.ident.to_string();
    match name.as_str() {
        "Vec" => {
            used.list = true;
            let [min, max] = range::length(key.len.as_ref())?;
            let entry_type = argument(segment, 0).ok_or_else(|| Error::new_spanned(of, "a list of what?"))?;
            let shape = match &key.of {
                Some(shape) => quote!(#shape),
                None => inner(entry_type, key, entry, used)?,
            };
            Ok(quote!(#core::Shape::List { of: &#shape, min: #min, max: #max }))
        }
        "BTreeMap" | "HashMap" => {
            let value = argument(segment, 1).ok_or_else(|| Error::new_spanned(of, "a map to what?"))?;
            let shape = match &key.of {
                Some(shape) => quote!(#shape),
                None => inner(value, key, entry, used)?,
            };
            Ok(quote!(#core::Shape::Map(&#shape)))
        }
        "f64" => {
            used.number = true;
            number(of, key, entry)
        }
        "f32" => Err(Error::new_spanned(of, "numbers of keys are f64")),
        "bool" => Ok(quote!(#core::Shape::Boolean)),
        "String" => {
            used.text = true;
            Ok(match &key.reference {
                Some(table) => quote!(#core::Shape::Reference(#table)),
                None => quote!(#core::Shape::Text),
            })
        }
        "Option" => Err(Error::new_spanned(of, "only a whole key can be optional, not an entry of it")),
        whole if SIGNED.contains(&whole) || UNSIGNED.contains(&whole) => {
            used.integer = true;
            let text = match &key.range {
                Some(RangeOf::Texts(texts)) => texts.of(entry),
                Some(RangeOf::Constant(constant)) => {
                    return Err(Error::new_spanned(
                        constant,
                        "the range of a whole number is a text: \">= 1, <= MOST\"",
                    ));
                }
                None => None,
            };
            let [min, max] = range::integer(text, SIGNED.contains(&whole))?;
            Ok(quote!(#core::Shape::Integer { min: #min, max: #max }))
        }
        _ => Ok(quote!(<#of as #core::KeyValue>::SHAPE)),
    }
}

fn number(of: &Type, key: &Key, entry: usize) -> Result<TokenStream> {
    let core = core();
    let Some(unit) = key.unit.as_ref().and_then(|unit| unit.of(entry)) else {
        let message = "the unit of this number is missing: #[key(unit = \"m\")]; a pure number has the unit \"-\"";
        return Err(Error::new_spanned(of, message));
    };
    let range = match &key.range {
        Some(RangeOf::Constant(constant)) => quote!(#constant),
        Some(RangeOf::Texts(texts)) => range::number(texts.of(entry))?,
        None => range::number(None)?,
    };
    let quantity = quote_spanned!(unit.span()=> #core::Quantity::of_unit(#unit));
    Ok(quote!(#core::Shape::Number(#quantity, #range)))
}
