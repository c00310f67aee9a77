//! The names by which the program reads plug-ins from a file. The [`audit`](super::audit) compares them with the tags of cards.

use super::schema::PluginKind;
use serde::de::value::MapDeserializer;
use serde::de::{Deserialize, DeserializeOwned, Error};
use std::fmt;

/// The reader of one kind of plug-ins. Each trait with cards registers one, with `inventory::submit!`.
pub struct Registered {
    /// The kind of plug-ins.
    pub kind: PluginKind,
    /// Returns all names that the reader knows, once for each type.
    pub names: fn(PluginKind) -> Vec<&'static str>,
}

impl Registered {
    /// Creates the entry of a trait with `#[typetag::serde(tag = "…")]`. The key of the tag is [`PluginKind::tag_key`].
    pub const fn of<T: ?Sized>(kind: PluginKind) -> Self
    where
        Box<T>: DeserializeOwned,
    {
        Registered { kind, names: typetag_names::<T> }
    }
}

inventory::collect!(Registered);

/// A type that no study file names and that therefore has no card, such as the wrong solvers of the conformance checks.
/// Register it with `inventory::submit!`; otherwise the audit reports the missing card.
pub struct WithoutCard {
    /// The kind of plug-in.
    pub kind: PluginKind,
    /// The name in `#[typetag::serde(name = "…")]`.
    pub name: &'static str,
}

inventory::collect!(WithoutCard);

/// Returns the names of each kind that need a card.
pub(super) fn names_with_cards() -> Vec<(PluginKind, Vec<&'static str>)> {
    let without = |kind: PluginKind, name: &str| {
        inventory::iter::<WithoutCard>.into_iter().any(|own| own.kind == kind && own.name == name)
    };
    let of = |own: &Registered| {
        let names = (own.names)(own.kind);
        (own.kind, names.into_iter().filter(|name| !without(own.kind, name)).collect())
    };
    inventory::iter::<Registered>.into_iter().map(of).collect()
}

/// The error of a reader that does not know a name. It keeps the names that the reader knows.
#[derive(Debug)]
struct KnownNames(&'static [&'static str]);

impl fmt::Display for KnownNames {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "known names: {}", self.0.join(", "))
    }
}

impl std::error::Error for KnownNames {}

impl Error for KnownNames {
    fn custom<T: fmt::Display>(_: T) -> Self {
        KnownNames(&[])
    }

    fn unknown_variant(_: &str, known: &'static [&'static str]) -> Self {
        KnownNames(known)
    }
}

/// Returns the names of `#[typetag::serde(name = "…")]` for a trait. typetag has no list of them, but it passes the list to the
/// error for an unknown name.
fn typetag_names<T: ?Sized>(kind: PluginKind) -> Vec<&'static str>
where
    Box<T>: DeserializeOwned,
{
    /// No type can have this name.
    const UNKNOWN: &str = "\0";
    let table = MapDeserializer::new([(kind.tag_key(), UNKNOWN)].into_iter());
    match Box::<T>::deserialize(table) {
        Err(KnownNames(names)) => names.to_vec(),
        Ok(_) => Vec::new(),
    }
}
