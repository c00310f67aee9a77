//! The attributes `#[key(…)]` of a field and `#[keys(…)]` of a type.

use proc_macro2::TokenStream;
use quote::quote;
use syn::ext::IdentExt;
use syn::parse::{Parse, ParseStream};
use syn::punctuated::Punctuated;
use syn::{Attribute, Error, Expr, ExprArray, ExprLit, Ident, Lit, LitStr, Meta, Path, Result, Token};

/// One `name = value`, or a name alone.
struct Entry {
    name: Ident,
    value: Option<Expr>,
}

impl Parse for Entry {
    fn parse(input: ParseStream<'_>) -> Result<Self> {
        let name = Ident::parse_any(input)?;
        let value = input.parse::<Option<Token![=]>>()?.map(|_| input.parse()).transpose()?;
        Ok(Entry { name, value })
    }
}

fn entries(attributes: &[Attribute], name: &str) -> Result<Vec<Entry>> {
    let mut all = Vec::new();
    for attribute in attributes.iter().filter(|attribute| attribute.path().is_ident(name)) {
        all.extend(attribute.parse_args_with(Punctuated::<Entry, Token![,]>::parse_terminated)?);
    }
    Ok(all)
}

impl Entry {
    fn expression(&self) -> Result<Expr> {
        let missing = || Error::new(self.name.span(), format!("`{}` needs a value: {} = …", self.name, self.name));
        self.value.clone().ok_or_else(missing)
    }

    fn text(&self) -> Result<LitStr> {
        let value = self.expression()?;
        text_of(&value).ok_or_else(|| Error::new_spanned(value, format!("`{}` is a text in quotes", self.name)))
    }

    fn path(&self) -> Result<Path> {
        match self.expression()? {
            Expr::Path(path) => Ok(path.path),
            other => Err(Error::new_spanned(other, format!("`{}` is the name of an item", self.name))),
        }
    }

    /// A text for all entries of a list, or a text for each of them.
    fn texts(&self) -> Result<Texts> {
        let value = self.expression()?;
        let wrong = || Error::new_spanned(&value, format!("`{}` is a text in quotes, or a list of texts", self.name));
        match &value {
            Expr::Array(ExprArray { elems, .. }) => {
                elems.iter().map(|one| text_of(one).ok_or_else(wrong)).collect::<Result<_>>().map(Texts::Each)
            }
            one => text_of(one).ok_or_else(wrong).map(Texts::All),
        }
    }
}

fn text_of(value: &Expr) -> Option<LitStr> {
    match value {
        Expr::Lit(ExprLit { lit: Lit::Str(text), .. }) => Some(text.clone()),
        _ => None,
    }
}

/// A text for all entries of a list, or one for each.
#[derive(Clone)]
pub enum Texts {
    All(LitStr),
    Each(Vec<LitStr>),
}

impl Texts {
    /// The text of an entry.
    pub fn of(&self, index: usize) -> Option<&LitStr> {
        match self {
            Texts::All(text) => Some(text),
            Texts::Each(texts) => texts.get(index),
        }
    }

    /// Any of the texts, to point at.
    pub fn first(&self) -> Option<&LitStr> {
        self.of(0)
    }
}

/// The range of a number: comparisons in a text, or a constant of type `Range`.
#[derive(Clone)]
pub enum RangeOf {
    Texts(Texts),
    Constant(Expr),
}

/// `#[key(…)]` of a field.
#[derive(Default)]
pub struct Key {
    pub name: Option<LitStr>,
    pub unit: Option<Texts>,
    pub range: Option<RangeOf>,
    pub default: Option<Expr>,
    /// `default` alone: that of the key which `like` names.
    pub shared_default: bool,
    pub optional: Option<LitStr>,
    pub reference: Option<LitStr>,
    pub names: Option<Vec<LitStr>>,
    pub len: Option<LitStr>,
    pub like: Option<Path>,
    pub shape: Option<Expr>,
    pub of: Option<Expr>,
    pub doc: Option<LitStr>,
}

const KEY_WORDS: &str = "unit, range, default, optional, reference, names, len, like, name, doc, shape, of (see `voussoir_core::plugin::Keys`)";

impl Key {
    pub fn of(attributes: &[Attribute]) -> Result<Key> {
        let mut key = Key::default();
        for entry in entries(attributes, "key")? {
            match entry.name.to_string().as_str() {
                "unit" => key.unit = Some(entry.texts()?),
                "range" => {
                    let value = entry.expression()?;
                    key.range = Some(match value {
                        Expr::Lit(_) | Expr::Array(_) => RangeOf::Texts(entry.texts()?),
                        constant => RangeOf::Constant(constant),
                    });
                }
                "default" if entry.value.is_none() => key.shared_default = true,
                "default" => key.default = Some(entry.expression()?),
                "optional" => key.optional = Some(entry.text()?),
                "reference" => key.reference = Some(entry.text()?),
                "names" => match entry.texts()? {
                    Texts::Each(names) => key.names = Some(names),
                    Texts::All(text) => return Err(Error::new_spanned(text, "`names` is a list: [\"x\", \"y\"]")),
                },
                "len" => key.len = Some(entry.text()?),
                "like" => key.like = Some(entry.path()?),
                "name" => key.name = Some(entry.text()?),
                "doc" => key.doc = Some(entry.text()?),
                "shape" => key.shape = Some(entry.expression()?),
                "of" => key.of = Some(entry.expression()?),
                other => {
                    let message = format!("`{other}` is not an attribute of a key; write one of: {KEY_WORDS}");
                    return Err(Error::new(entry.name.span(), message));
                }
            }
        }
        Ok(key)
    }
}

/// The way in which the reader distinguishes the variants of an enum.
pub enum Tagging {
    /// By the word under this key.
    Tag(LitStr),
    /// By their form: a number or a table.
    Untagged,
    /// The variants are words.
    Words,
}

/// `#[keys(…)]` of a type.
pub struct Options {
    pub tagging: Tagging,
    pub check: Option<Path>,
}

impl Options {
    pub fn of(attributes: &[Attribute]) -> Result<Options> {
        let mut options = Options { tagging: Tagging::Words, check: None };
        for entry in entries(attributes, "keys")? {
            match entry.name.to_string().as_str() {
                "tag" => options.tagging = Tagging::Tag(entry.text()?),
                "untagged" => options.tagging = Tagging::Untagged,
                "check" => options.check = Some(entry.path()?),
                other => {
                    let message =
                        format!("`{other}` is not an attribute of a table; write one of: tag, untagged, check");
                    return Err(Error::new(entry.name.span(), message));
                }
            }
        }
        Ok(options)
    }
}

/// The first paragraph of a doc comment as one line. A single sentence loses its full stop.
pub fn documentation(attributes: &[Attribute]) -> String {
    let mut words = String::new();
    for attribute in attributes.iter().filter(|attribute| attribute.path().is_ident("doc")) {
        let Meta::NameValue(pair) = &attribute.meta else { continue };
        let Some(line) = text_of(&pair.value) else { continue };
        let line = line.value();
        if line.trim().is_empty() {
            break;
        }
        if !words.is_empty() {
            words.push(' ');
        }
        words.push_str(line.trim());
    }
    let plain = words.replace("\\[", "[").replace("\\]", "]");
    match plain.strip_suffix('.') {
        Some(sentence) if !sentence.contains(". ") && !sentence.ends_with('.') => sentence.to_string(),
        _ => plain,
    }
}

/// The path of the items that the derive uses. Each block of its code imports them under this name.
pub fn core() -> TokenStream {
    quote!(__keys)
}
