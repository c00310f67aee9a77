//! The code that the derive writes.

use super::attributes::{Key, Options, Tagging, core, documentation};
use super::default::{self, Default};
use super::shape::{inside_option, shape};
use proc_macro2::TokenStream;
use quote::{format_ident, quote, quote_spanned};
use syn::ext::IdentExt;
use syn::spanned::Spanned;
use syn::{Data, DeriveInput, Error, Field, Fields, FieldsNamed, Ident, LitStr, Result, Type, Variant};

/// Returns the keys of a type as tokens, or the errors of its attributes. `root` is the path of the module `plugin`.
pub fn expand(input: &DeriveInput, root: &TokenStream) -> Result<TokenStream> {
    if !input.generics.params.is_empty() {
        return Err(Error::new_spanned(&input.generics, "a table of keys has no type parameters"));
    }
    let options = Options::of(&input.attrs)?;
    let (core, written) = (core(), of_type(input, &options)?);
    Ok(quote! {
        const _: () = {
            use #root as #core;
            #written
        };
    })
}

fn of_type(input: &DeriveInput, options: &Options) -> Result<TokenStream> {
    match &input.data {
        Data::Struct(data) => match &data.fields {
            Fields::Named(fields) => of_struct(&input.ident, options, fields),
            Fields::Unit => of_struct(&input.ident, options, &no_fields()),
            Fields::Unnamed(fields) => Err(Error::new_spanned(fields, "the keys of a table are fields with names")),
        },
        Data::Enum(data) => {
            let variants: Vec<&Variant> = data.variants.iter().collect();
            of_enum(&input.ident, options, &variants)
        }
        Data::Union(data) => Err(Error::new_spanned(data.union_token, "keys are those of a struct or an enum")),
    }
}

fn no_fields() -> FieldsNamed {
    FieldsNamed { brace_token: syn::token::Brace::default(), named: syn::punctuated::Punctuated::new() }
}

/// One key: its parameter, its field in the reader, and what goes beside them.
struct Written {
    parameter: TokenStream,
    field: TokenStream,
    beside: TokenStream,
}

/// Everything of the fields of a struct, or of a variant called `of`.
fn keys_of(fields: &FieldsNamed, of: &str) -> Result<(Vec<TokenStream>, Vec<TokenStream>, Vec<TokenStream>)> {
    let (mut parameters, mut shadow, mut beside) = (Vec::new(), Vec::new(), Vec::new());
    let mut wrong: Option<Error> = None;
    for field in &fields.named {
        match key_of(field, of) {
            Ok(written) => {
                parameters.push(written.parameter);
                shadow.push(written.field);
                beside.push(written.beside);
            }
            Err(error) => match &mut wrong {
                Some(errors) => errors.combine(error),
                None => wrong = Some(error),
            },
        }
    }
    wrong.map_or(Ok((parameters, shadow, beside)), Err)
}

/// A key whose attribute is read.
struct Declared<'a> {
    key: Key,
    ident: &'a Ident,
    of: &'a Type,
    /// The type inside of `Option`.
    inside: Option<&'a Type>,
    name: String,
    default: Option<Default>,
}

fn key_of(field: &Field, of: &str) -> Result<Written> {
    let key = Key::of(&field.attrs)?;
    let ident = field.ident.as_ref().ok_or_else(|| Error::new_spanned(field, "a key has a name"))?;
    let name = key.name.as_ref().map_or_else(|| ident.unraw().to_string(), LitStr::value);
    let default = key.default.as_ref().map(default::read).transpose()?;
    let doc = key.doc.as_ref().map_or_else(|| documentation(&field.attrs), LitStr::value);
    let declared = Declared { key, ident, of: &field.ty, inside: inside_option(&field.ty), name, default };
    let parameter = declared.parameter(&doc)?;
    let (attribute, beside) = declared.reader(of, &parameter);
    let of_type = &field.ty;
    Ok(Written { parameter, field: quote!(#attribute #ident: #of_type), beside })
}

impl Declared<'_> {
    /// The `Need` of the key.
    fn need(&self) -> Result<TokenStream> {
        let core = core();
        let key = &self.key;
        if key.shared_default && key.like.is_none() {
            let message = "`default` needs a value: default = 0.0; only with `like` it has none";
            return Err(Error::new(self.ident.span(), message));
        }
        Ok(match (&self.default, &key.optional, self.inside) {
            _ if key.shared_default => quote!(#core::Need::Default(#core::keys::shared_default(LIKE))),
            (Some(_), Some(text), _) => {
                let message = "a key with a default is never absent: `optional` has nothing to say";
                return Err(Error::new(text.span(), message));
            }
            (Some(Default { text, .. }), None, _) => quote!(#core::Need::Default(#text)),
            (None, Some(text), _) => quote!(#core::Need::Optional(#text)),
            (None, None, None) => quote!(#core::Need::Required),
            (None, None, Some(_)) if key.like.is_some() => quote!(#core::keys::otherwise(LIKE)),
            (None, None, Some(_)) => {
                let message = "say what happens without this key: #[key(optional = \"the joint itself is stiff\")]";
                return Err(Error::new_spanned(self.of, message));
            }
        })
    }

    fn parameter(&self, doc: &str) -> Result<TokenStream> {
        let core = core();
        let (need, name) = (self.need()?, &self.name);
        if let Some(path) = &self.key.like {
            let doc = self.key.doc.as_ref().map(|doc| quote!(doc: #doc,));
            return Ok(quote_spanned!(path.span()=> {
                const LIKE: #core::Parameter = #core::keys::like(<#path as #core::Keys>::PARAMETERS, #name);
                #core::Parameter { need: #need, #doc ..LIKE }
            }));
        }
        if doc.is_empty() {
            let message = "this key has no doc comment: users read it as the meaning of the key";
            return Err(Error::new(self.ident.span(), message));
        }
        let shape = shape(self.inside.unwrap_or(self.of), &self.key)?;
        Ok(quote!(#core::Parameter { name: #name, doc: #doc, shape: #shape, need: #need }))
    }

    /// serde's attribute of the field, and what that names.
    fn reader(&self, of: &str, parameter: &TokenStream) -> (TokenStream, TokenStream) {
        let core = core();
        let (name, of_type) = (&self.name, self.of);
        let function = format_ident!("default_of_{}{}", of.to_lowercase(), self.ident.unraw());
        let named = function.to_string();
        if let (Some(Default { text, known }), Some(written)) = (&self.default, &self.key.default) {
            let checked = quote_spanned!(written.span()=> #core::keys::check_default(&(#parameter).shape, #known););
            let beside = quote! {
                fn #function() -> #of_type { #core::keys::read_default(#text) }
                const _: () = #checked
            };
            return (quote!(#[serde(rename = #name, default = #named)]), beside);
        }
        if let (Some(path), true) = (&self.key.like, self.key.shared_default) {
            let like = quote!(#core::keys::like(<#path as #core::Keys>::PARAMETERS, #name));
            let beside = quote! {
                fn #function() -> #of_type { #core::keys::read_default(#core::keys::shared_default(#like)) }
            };
            return (quote!(#[serde(rename = #name, default = #named)]), beside);
        }
        let attribute = match (self.inside, &self.key.optional) {
            (Some(_), _) => quote!(#[serde(rename = #name, skip_serializing_if = "::core::option::Option::is_none")]),
            (None, Some(_)) => quote!(#[serde(rename = #name, default)]),
            (None, None) => quote!(#[serde(rename = #name)]),
        };
        (attribute, quote!())
    }
}

/// The reader and the writer of a type, by way of a copy that serde describes.
fn serde_of(ident: &Ident, container: &TokenStream, shadow: &TokenStream) -> TokenStream {
    let core = core();
    let (serde, name) = (quote!(#core::keys::serde), ident.to_string());
    let root = serde.to_string();
    quote! {
        #[derive(#serde::Serialize, #serde::Deserialize)]
        #[serde(crate = #root, remote = #name, #container)]
        #[allow(dead_code)]
        #shadow
        #[automatically_derived]
        impl #serde::Serialize for #ident {
            fn serialize<S: #serde::Serializer>(&self, serializer: S) -> ::core::result::Result<S::Ok, S::Error> {
                Shadow::serialize(self, serializer)
            }
        }
        #[automatically_derived]
        impl<'de> #serde::Deserialize<'de> for #ident {
            fn deserialize<D: #serde::Deserializer<'de>>(deserializer: D) -> ::core::result::Result<Self, D::Error> {
                Shadow::deserialize(deserializer)
            }
        }
    }
}

fn of_struct(ident: &Ident, options: &Options, fields: &FieldsNamed) -> Result<TokenStream> {
    let core = core();
    if !matches!(options.tagging, Tagging::Words) {
        return Err(Error::new(ident.span(), "`tag` and `untagged` are for an enum"));
    }
    let (parameters, shadow, beside) = keys_of(fields, "")?;
    let serde = serde_of(ident, &quote!(deny_unknown_fields), &quote!(struct Shadow { #(#shadow),* }));
    let check = options.check.as_ref().map(|path| {
        quote_spanned! {path.span()=>
            fn check(&self) -> ::std::vec::Vec<(::std::string::String, ::std::string::String)> { #path(self) }
        }
    });
    Ok(quote! {
        #serde
        #(#beside)*
        #[automatically_derived]
        impl #core::Keys for #ident {
            const PARAMETERS: &'static [#core::Parameter] = &[#(#parameters),*];
            #check
        }
        #[automatically_derived]
        impl #core::KeyValue for #ident {
            const SHAPE: #core::Shape = #core::Shape::Table(<#ident as #core::Keys>::PARAMETERS);
        }
        const _: &[#core::Parameter] = <#ident as #core::Keys>::PARAMETERS;
    })
}

/// `ThreeCentred` as `three_centred`.
fn snake_case(name: &str) -> String {
    let mut out = String::new();
    for (index, letter) in name.chars().enumerate() {
        if letter.is_uppercase() && index > 0 {
            out.push('_');
        }
        out.extend(letter.to_lowercase());
    }
    out
}

fn of_enum(ident: &Ident, options: &Options, variants: &[&Variant]) -> Result<TokenStream> {
    let core = core();
    if let Some(path) = &options.check {
        return Err(Error::new_spanned(path, "`check` is for a struct"));
    }
    let (container, written) = match &options.tagging {
        Tagging::Words => (quote!(), words(variants)?),
        Tagging::Tag(tag) => (quote!(tag = #tag, deny_unknown_fields), tagged(tag, variants)?),
        Tagging::Untagged => (quote!(untagged), untagged(variants)?),
    };
    let EnumWritten { shape, shadow, beside } = written;
    let container = if container.is_empty() { quote!(rename_all = "snake_case") } else { container };
    let serde = serde_of(ident, &container, &quote!(enum Shadow { #(#shadow),* }));
    Ok(quote! {
        #serde
        #(#beside)*
        #[automatically_derived]
        impl #core::KeyValue for #ident {
            const SHAPE: #core::Shape = #shape;
        }
        const _: #core::Shape = <#ident as #core::KeyValue>::SHAPE;
    })
}

struct EnumWritten {
    shape: TokenStream,
    shadow: Vec<TokenStream>,
    beside: Vec<TokenStream>,
}

fn name_of(variant: &Variant) -> Result<String> {
    let own = Key::of(&variant.attrs)?.name;
    Ok(own.map_or_else(|| snake_case(&variant.ident.to_string()), |name| name.value()))
}

/// An enum of words.
fn words(variants: &[&Variant]) -> Result<EnumWritten> {
    let core = core();
    let (mut words, mut shadow) = (Vec::new(), Vec::new());
    for variant in variants {
        if !matches!(variant.fields, Fields::Unit) {
            let message =
                "variants with fields are told apart by #[keys(tag = \"…\")] or #[keys(untagged)] on the enum";
            return Err(Error::new_spanned(variant, message));
        }
        let (ident, word) = (&variant.ident, name_of(variant)?);
        shadow.push(quote!(#[serde(rename = #word)] #ident));
        words.push(word);
    }
    Ok(EnumWritten { shape: quote!(#core::Shape::Choice(&[#(#words),*])), shadow, beside: Vec::new() })
}

/// An enum of tables that a word tells apart.
fn tagged(tag: &LitStr, variants: &[&Variant]) -> Result<EnumWritten> {
    let core = core();
    let (mut shapes, mut shadow, mut all_beside) = (Vec::new(), Vec::new(), Vec::new());
    for variant in variants {
        let (ident, word, doc) = (&variant.ident, name_of(variant)?, documentation(&variant.attrs));
        if doc.is_empty() {
            return Err(Error::new(ident.span(), "this variant has no doc comment: users read it as its meaning"));
        }
        let parameters = match &variant.fields {
            Fields::Unit => {
                // With braces serde refuses unknown keys here too.
                shadow.push(quote!(#[serde(rename = #word)] #ident {}));
                quote!(&[])
            }
            Fields::Named(fields) => {
                let (parameters, own, beside) = keys_of(fields, &format!("{ident}_"))?;
                shadow.push(quote!(#[serde(rename = #word)] #ident { #(#own),* }));
                all_beside.extend(beside);
                quote!(&[#(#parameters),*])
            }
            Fields::Unnamed(fields) if fields.unnamed.len() == 1 => {
                let of = &fields.unnamed[0].ty;
                shadow.push(quote!(#[serde(rename = #word)] #ident(#of)));
                quote!(<#of as #core::Keys>::PARAMETERS)
            }
            Fields::Unnamed(fields) => {
                return Err(Error::new_spanned(fields, "a variant has fields with names, or one table"));
            }
        };
        shapes.push(quote!(#core::Variant { tag: #word, doc: #doc, parameters: #parameters }));
    }
    let shape = quote!(#core::Shape::Tagged { key: #tag, variants: &[#(#shapes),*] });
    Ok(EnumWritten { shape, shadow, beside: all_beside })
}

/// An enum whose variants differ in form.
fn untagged(variants: &[&Variant]) -> Result<EnumWritten> {
    let core = core();
    let (mut shapes, mut shadow) = (Vec::new(), Vec::new());
    for variant in variants {
        let ident = &variant.ident;
        let Fields::Unnamed(fields) = &variant.fields else {
            return Err(Error::new_spanned(variant, "a variant of an untagged enum holds one value"));
        };
        let [field] = &fields.unnamed.iter().collect::<Vec<_>>()[..] else {
            return Err(Error::new_spanned(variant, "a variant of an untagged enum holds one value"));
        };
        let of = &field.ty;
        let attributes: Vec<_> = variant.attrs.iter().chain(&field.attrs).cloned().collect();
        shapes.push(shape(of, &Key::of(&attributes)?)?);
        shadow.push(quote!(#ident(#of)));
    }
    Ok(EnumWritten { shape: quote!(#core::Shape::Either(&[#(#shapes),*])), shadow, beside: Vec::new() })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(input: TokenStream) -> String {
        let input = syn::parse2(input).expect("Rust");
        expand(&input, &quote!(::voussoir_core::plugin)).expect_err("a mistake").to_string()
    }

    #[test]
    fn a_wrong_attribute_is_refused_with_a_sentence() {
        let of = |field: TokenStream| message(quote!(struct Law { #[doc = "strength"] #field }));
        assert!(
            of(quote!(#[key(unit = "Pa", size = 3)] f: f64))
                .contains("`size` is not an attribute of a key; write one of: unit,")
        );
        assert!(of(quote!(f: f64)).contains("the unit of this number is missing"));
        assert!(of(quote!(#[key(unit = "Pa", range = "positive")] f: f64)).contains("`positive` is no comparison"));
        assert!(of(quote!(#[key(unit = "Pa", range = "> 0, > 1")] f: f64)).contains("bound the same end"));
        assert!(of(quote!(#[key(unit = "Pa", range = "> zero point")] f: f64)).contains("is no number"));
        assert!(of(quote!(#[key(unit = "Pa")] f: Option<f64>)).contains("say what happens without this key"));
        assert!(of(quote!(#[key(unit = "Pa")] f: bool)).contains("a unit belongs to a number"));
        assert!(of(quote!(#[key(range = "> 0")] f: String)).contains("a range belongs to a number"));
        assert!(of(quote!(#[key(len = "> 0")] f: String)).contains("a length belongs to a list"));
        assert!(of(quote!(#[key(names = ["x", "y"], unit = "m")] f: f64)).contains("names belong to the entries"));
        assert!(of(quote!(#[key(reference = "joints")] f: bool)).contains("a reference is a name"));
        assert!(of(quote!(#[key(unit = "Pa", default = f())] f: f64)).contains("a default is a number, a text"));
        assert!(of(quote!(#[key(unit = "Pa", default = 1.0, optional = "so")] f: f64)).contains("never absent"));
        assert!(of(quote!(#[key(unit = Pa)] f: f64)).contains("`unit` is a text in quotes"));
        assert!(of(quote!(#[key(unit)] f: f64)).contains("`unit` needs a value"));
        assert!(
            message(quote!(
                struct Law {
                    #[key(unit = "Pa")]
                    f: f64,
                }
            ))
            .contains("has no doc comment")
        );
        assert!(
            message(quote!(
                struct Law<T> {
                    f: T,
                }
            ))
            .contains("no type parameters")
        );
        assert!(
            message(quote!(
                struct Law(f64);
            ))
            .contains("fields with names")
        );
        assert!(
            message(quote!(
                enum Law {
                    One(f64),
                }
            ))
            .contains("told apart by")
        );
        assert!(
            message(quote!(
                #[keys(size)]
                struct Law {}
            ))
            .contains("`size` is not an attribute of a table")
        );
    }

    #[test]
    fn all_wrong_fields_are_named_at_once() {
        let input = syn::parse2(quote!(
            struct Law {
                a: f64,
                b: f64,
            }
        ))
        .expect("Rust");
        assert_eq!(expand(&input, &quote!(::voussoir_core::plugin)).expect_err("mistakes").into_iter().count(), 2);
    }

    #[test]
    fn words_of_variants_are_those_of_study_files() {
        assert_eq!(snake_case("ThreeCentred"), "three_centred");
        assert_eq!(snake_case("Jointed"), "jointed");
    }
}
