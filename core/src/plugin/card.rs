//! Cards: what a plug-in says of itself, and the registry of all of them.
//!
//! A plug-in registers twice, next to its type: `#[typetag::serde]` makes it readable from a
//! configuration, `inventory::submit!` hands in its [`Card`]. Lists, help pages, the JSON Schema,
//! the check of study files and the conformance tests read cards only.

use super::keys::Keys;
use super::schema::{Parameter, PluginKind};
use std::sync::OnceLock;

/// Something that a plug-in offers and a solver may ask for; compared when a study is loaded. The list
/// is open: a law or solver with something new declares a constant of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Capability {
    /// The kind of plug-in that offers it.
    pub of: PluginKind,
    /// In words.
    pub words: &'static str,
}

impl Capability {
    /// The interface law is given by facets a·t ≤ b.
    pub const FACETS: Self = Self::new(PluginKind::InterfaceLaw, "facets");
    /// The interface law is given by tractions from gaps, with state.
    pub const RESPONSE: Self = Self::new(PluginKind::InterfaceLaw, "tractions from gaps");
    /// The bulk material gives stresses from strains at a point, with state.
    pub const STRESS_UPDATE: Self = Self::new(PluginKind::BulkMaterial, "stresses from strains at a point");
    /// The material is linear elastic, or rigid.
    pub const LINEAR: Self = Self::new(PluginKind::BulkMaterial, "a linear law");
    /// Bodies may be read as rigid without changing the answer.
    pub const RIGID_LIMIT: Self = Self::new(PluginKind::BulkMaterial, "a rigid limit");
    /// Equilibrium in displaced positions.
    pub const FINITE_DISPLACEMENTS: Self = Self::new(PluginKind::PathSolver, "finite displacements");
    /// Imposed movements of supports.
    pub const SETTLEMENT: Self = Self::new(PluginKind::PathSolver, "settlements");
    /// The bounds of limit analysis for flow that is not associated.
    pub const NON_ASSOCIATED: Self = Self::new(PluginKind::LimitSolver, "flow that is not associated");

    /// One that plug-ins of a kind offer.
    pub const fn new(of: PluginKind, words: &'static str) -> Self {
        Capability { of, words }
    }
}

/// What a solver asks of a law: one of these.
pub type Requirement = &'static [Capability];

/// A requirement in words.
pub fn describe(requirement: Requirement) -> String {
    requirement.iter().map(|capability| capability.words).collect::<Vec<_>>().join(" or ")
}

/// What a law claims of itself whatever its parameters. The conformance tests check every claim that they
/// know on every sample; the list is open.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Property(pub &'static str);

impl Property {
    /// Flow is normal to the facet it happens on: the bound theorems of limit analysis hold.
    pub const ASSOCIATED: Self = Self("associated");
    /// No update creates energy: what is dissipated is never negative.
    pub const DISSIPATIVE: Self = Self("dissipative");
    /// The material has no axes: turned strains give turned stresses.
    pub const ISOTROPIC: Self = Self("isotropic");
    /// The tangent of an update is symmetric.
    pub const SYMMETRIC_TANGENT: Self = Self("symmetric_tangent");
}

/// A law with numbers, for the conformance tests: walks of steps about as large as `size` meet every branch
/// in `branches`.
#[derive(Debug, Clone, Copy)]
pub struct Sample {
    /// The law's keys in TOML, without the tag.
    pub table: &'static str,
    /// Strain, or gap \[m\], at which something happens.
    pub size: f64,
    /// Names of branches that the walks must meet.
    pub branches: &'static [&'static str],
}

impl Sample {
    /// From its three parts.
    pub const fn new(table: &'static str, size: f64, branches: &'static [&'static str]) -> Self {
        Sample { table, size, branches }
    }
}

/// A path of one point whose answer is known from elsewhere than the law's own code: derived by hand, or published.
/// Generic checks cannot see a memory that is missing in a consistent way; such a path does.
#[derive(Debug, Clone, Copy)]
pub struct KnownPath {
    /// The law's keys in TOML, without the tag.
    pub table: &'static str,
    /// Whose numbers they are, or how they follow.
    pub source: &'static str,
    /// Steps in order: gaps (n, t) \[m\] or strains (xx, yy, zz, xy, yz, zx) at the end of each, with the tractions or
    /// stresses there \[Pa\].
    pub steps: &'static [(&'static [f64], &'static [f64])],
    /// Greatest difference, as a share of the greatest number of the path.
    pub tolerance: f64,
}

/// A crate with its version.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Package {
    /// Name of the crate.
    pub name: &'static str,
    /// Its version.
    pub version: &'static str,
}

/// The [`Package`] of the crate in which it is written.
#[macro_export]
macro_rules! package {
    () => {
        $crate::plugin::Package { name: env!("CARGO_PKG_NAME"), version: env!("CARGO_PKG_VERSION") }
    };
}

/// What a plug-in says of itself. A card states what it has; the rest is that of [`Card::BLANK`].
#[derive(Debug)]
pub struct Card {
    /// Which trait it implements.
    pub kind: PluginKind,
    /// Its name in study files, and of its source file.
    pub tag: &'static str,
    /// One line.
    pub summary: &'static str,
    /// Its keys, without the tag key.
    pub parameters: &'static [Parameter],
    /// What it offers.
    pub provides: &'static [Capability],
    /// What it asks of the laws it meets: all of these. Where a law offers several capabilities of one
    /// requirement, the solver takes the first.
    pub requires: &'static [Requirement],
    /// What a law claims of itself.
    pub claims: &'static [Property],
    /// Laws: numbers for the conformance tests.
    pub samples: &'static [Sample],
    /// Laws: paths whose answers are known; a law with state needs one that goes back after something irreversible.
    pub known_paths: &'static [KnownPath],
    /// Solvers: `auto` takes the cheapest that fits; `None` is for those taken by name only.
    pub cost: Option<u32>,
    /// Where its equations come from.
    pub sources: &'static [&'static str],
    /// Its source file (`file!()`).
    pub file: &'static str,
    /// The crate that brings it, with its version (`package!()`).
    pub package: Package,
    /// Its page: purpose, equations, regimes, state, validity (Markdown).
    pub page: &'static str,
    /// Checks of the whole table that single keys cannot show, for the concrete type:
    /// pairs of key and what is wrong with it. The table has passed the check of its keys.
    pub check: fn(&serde_json::Value) -> Vec<(String, String)>,
}

impl Card {
    /// Nothing but defaults, for `..Card::BLANK`.
    pub const BLANK: Card = Card {
        kind: PluginKind::Scene,
        tag: "",
        summary: "",
        parameters: &[],
        provides: &[],
        requires: &[],
        claims: &[],
        samples: &[],
        known_paths: &[],
        cost: None,
        sources: &[],
        file: "",
        package: Package { name: "unknown", version: "unknown" },
        page: "",
        check: |_| Vec::new(),
    };

    /// Nothing but the keys of a type and their check, for `..Card::of::<Law>()`.
    pub const fn of<T: Keys>() -> Card {
        Card { parameters: T::PARAMETERS, check: |value| check_as::<T>(value, T::check), ..Card::BLANK }
    }

    /// Whether it offers a capability.
    pub fn offers(&self, capability: Capability) -> bool {
        self.provides.contains(&capability)
    }

    /// Whether it meets a requirement of a solver; one that concerns other kinds of plug-in is met.
    pub fn meets(&self, requirement: Requirement) -> bool {
        requirement.iter().all(|one| one.of != self.kind) || requirement.iter().any(|one| self.offers(*one))
    }

    /// Whether it claims a property.
    pub fn claims(&self, property: Property) -> bool {
        self.claims.contains(&property)
    }
}

inventory::collect!(Card);

/// The checks of a concrete type with `fn validate(&self) -> Vec<(String, String)>`.
pub fn check_as<T: serde::de::DeserializeOwned>(
    value: &serde_json::Value,
    validate: impl Fn(&T) -> Vec<(String, String)>,
) -> Vec<(String, String)> {
    match T::deserialize(value) {
        Ok(concrete) => validate(&concrete),
        Err(error) => vec![(String::new(), error.to_string())],
    }
}

/// All cards, sorted by kind and tag.
pub fn cards() -> &'static [&'static Card] {
    // They are registered before the program starts, and asked for by every key of every case.
    static CARDS: OnceLock<Vec<&'static Card>> = OnceLock::new();
    CARDS.get_or_init(|| {
        let mut all: Vec<_> = inventory::iter::<Card>.into_iter().collect();
        all.sort_by_key(|card| (card.kind, card.tag));
        all
    })
}

/// The cards of one kind, sorted by tag.
pub fn cards_of(kind: PluginKind) -> Vec<&'static Card> {
    cards().iter().copied().filter(|card| card.kind == kind).collect()
}

/// The card with this kind and tag.
pub fn card(kind: PluginKind, tag: &str) -> Option<&'static Card> {
    let place = cards().binary_search_by(|card| (card.kind, card.tag).cmp(&(kind, tag))).ok()?;
    Some(cards()[place])
}

/// The cards that may stand in the place of one kind: `[solver] solver = …` names a limit solver or a
/// path solver. Sorted by kind and tag.
pub fn candidates(kind: PluginKind) -> Vec<&'static Card> {
    candidates_of(kind).collect()
}

fn candidates_of(kind: PluginKind) -> impl Iterator<Item = &'static Card> {
    let place = |of: PluginKind| if of == PluginKind::PathSolver { PluginKind::LimitSolver } else { of };
    cards().iter().copied().filter(move |card| place(card.kind) == place(kind))
}

/// The card with this tag among those that may stand in the place of one kind.
pub fn candidate(kind: PluginKind, tag: &str) -> Option<&'static Card> {
    candidates_of(kind).find(|card| card.tag == tag)
}

/// The name nearest to `wrong` among `names`, if any is near enough to be meant.
pub fn nearest<'a>(wrong: &str, names: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    names
        .into_iter()
        .map(|name| (strsim::damerau_levenshtein(wrong, name), name))
        .min()
        .filter(|(distance, name)| *distance <= 1 + name.chars().count() / 3)
        .map(|(_, name)| name)
}

/// What is wrong with the registry: a kind without plug-ins (a crate that no source names
/// registers nothing), or two plug-ins of one kind with the same tag. Empty when sound.
pub fn audit() -> Vec<String> {
    audit_of(cards())
}

fn audit_of(all: &[&Card]) -> Vec<String> {
    let mut wrong = Vec::new();
    for kind in PluginKind::ALL {
        if !all.iter().any(|card| card.kind == kind) {
            wrong.push(format!("no {} is registered: is its crate named in the facade?", kind.describe()));
        }
    }
    for pair in all.windows(2) {
        if (pair[0].kind, pair[0].tag) == (pair[1].kind, pair[1].tag) {
            wrong.push(format!(
                "two {}s are called \"{}\": {} and {}",
                pair[0].kind.describe(),
                pair[0].tag,
                pair[0].file,
                pair[1].file
            ));
        }
    }
    wrong
}

#[cfg(test)]
mod tests {
    use super::*;

    const ONE: Card = Card { kind: PluginKind::Scene, tag: "arch", file: "here.rs", ..Card::BLANK };

    #[test]
    fn the_audit_finds_an_empty_kind_and_a_duplicate_tag() {
        let wrong = audit_of(&[&ONE, &ONE]);
        assert!(wrong.iter().any(|w| w == "no interface law is registered: is its crate named in the facade?"));
        assert!(wrong.iter().any(|w| w == "two scenes are called \"arch\": here.rs and here.rs"));
    }

    #[test]
    fn the_nearest_name_is_found_or_none() {
        assert_eq!(nearest("coulom", ["unilateral", "coulomb"]), Some("coulomb"));
        assert_eq!(nearest("zzzzzz", ["unilateral", "coulomb"]), None);
    }
}
