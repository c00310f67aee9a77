//! Cards describe plug-ins; the registry contains all cards.
//!
//! A plug-in registers twice, next to its type: `#[typetag::serde]` makes it readable from a configuration, and
//! `inventory::submit!` registers its [`Card`]. Lists, help pages, the JSON Schema, the check of study files and the
//! conformance tests read only cards.

use super::keys::Keys;
use super::output::{self, Output, OutputOf};
use super::registered::names_with_cards;
use super::schema::{Parameter, PluginKind};
use std::sync::OnceLock;

/// A feature that a plug-in offers and a solver may require; compared when a study is loaded. The list is open: a law or
/// solver with a new feature declares a new constant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct Capability {
    /// The kind of plug-in that offers it.
    pub of: PluginKind,
    /// Description in words.
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
    /// Bodies may be treated as rigid without changing the result.
    pub const RIGID_LIMIT: Self = Self::new(PluginKind::BulkMaterial, "a rigid limit");
    /// Equilibrium in displaced positions.
    pub const FINITE_DISPLACEMENTS: Self = Self::new(PluginKind::PathSolver, "finite displacements");
    /// Imposed movements of supports.
    pub const SETTLEMENT: Self = Self::new(PluginKind::PathSolver, "settlements");
    /// The study files of this kind have separate keys and no scene.
    pub const OWN_FILE: Self = Self::new(PluginKind::StudyKind, "separate study files");
    /// The bounds of limit analysis for non-associated flow.
    pub const NON_ASSOCIATED: Self = Self::new(PluginKind::LimitSolver, "flow that is not associated");

    /// The interface law is a cone of isotropic friction, for contacts in space.
    pub const CONE: Self = Self::new(PluginKind::InterfaceLaw, "a cone of isotropic friction");
    /// Scenes in space.
    pub const SPACE: Self = Self::new(PluginKind::LimitSolver, "scenes in space");

    /// Creates a capability of a kind of plug-ins.
    pub const fn new(of: PluginKind, words: &'static str) -> Self {
        Capability { of, words }
    }
}

/// A requirement of a solver on a law: the law must offer one of these.
pub type Requirement = &'static [Capability];

/// Describes a requirement in words.
pub fn describe(requirement: Requirement) -> String {
    requirement.iter().map(|capability| capability.words).collect::<Vec<_>>().join(" or ")
}

/// A property that a law claims for all its parameters. The conformance tests check every known property on every sample;
/// the list is open.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Property(pub &'static str);

impl Property {
    /// Flow is normal to its facet: the bound theorems of limit analysis hold.
    pub const ASSOCIATED: Self = Self("associated");
    /// No update creates energy: the dissipation is never negative.
    pub const DISSIPATIVE: Self = Self("dissipative");
    /// The material has no axes: rotated strains give rotated stresses.
    pub const ISOTROPIC: Self = Self("isotropic");
    /// The tangent of an update is symmetric.
    pub const SYMMETRIC_TANGENT: Self = Self("symmetric_tangent");
}

/// A plug-in with numbers, for the conformance tests. For a law, walks with steps of about `size` must meet every branch in
/// `branches`; other plug-ins have [`Sample::keys`].
///
/// The sample of a study kind is added to a standard study, an arch under a force that grows until collapse; for a kind with
/// separate study files it is the whole file without name and kind. The sample of a scene can use the materials `stone` (rigid) and `brick` (elastic) and the joint laws `dry` and `mortar`.
/// The sample of a load acts on a bridge with a road, with one span of 6 m and the voussoirs `0` to `14`; it can use the
/// vehicle `cart`.
#[derive(Debug, Clone, Copy)]
pub struct Sample {
    /// The law's keys in TOML, without the tag.
    pub table: &'static str,
    /// Strain, or gap \[m\], at which the law changes its branch.
    pub size: f64,
    /// Names of branches that the walks must meet.
    pub branches: &'static [&'static str],
}

impl Sample {
    /// Creates a sample from its three parts.
    pub const fn new(table: &'static str, size: f64, branches: &'static [&'static str]) -> Self {
        Sample { table, size, branches }
    }

    /// Creates a sample of a plug-in that is not a law: keys in TOML, without the tag.
    pub const fn keys(table: &'static str) -> Self {
        Sample::new(table, 1.0, &[])
    }
}

/// A path of one point with a known result that does not come from the law's code: derived by hand, or published. Generic
/// checks cannot find a memory that is missing in a consistent way; such a path can.
#[derive(Debug, Clone, Copy)]
pub struct KnownPath {
    /// The law's keys in TOML, without the tag.
    pub table: &'static str,
    /// Source or derivation of the numbers.
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

/// The description of a plug-in. Omitted fields are those in [`Card::BLANK`].
#[derive(Debug)]
pub struct Card {
    /// The kind of plug-in, which has one trait.
    pub kind: PluginKind,
    /// Its name in study files, which is also the name of its source file.
    pub tag: &'static str,
    /// Summary in one line.
    pub summary: &'static str,
    /// Its keys, without the tag key.
    pub parameters: &'static [Parameter],
    /// Capabilities that it offers.
    pub provides: &'static [Capability],
    /// Requirements on the laws: all must be met. If a law offers several capabilities of one requirement, the solver uses the
    /// first.
    pub requires: &'static [Requirement],
    /// Properties that a law claims.
    pub claims: &'static [Property],
    /// For laws, scenes, loads and study kinds: samples for the conformance tests. A strategy needs one if it has required keys.
    pub samples: &'static [Sample],
    /// For laws: paths with known results. A law with state needs one that unloads after an irreversible change.
    pub known_paths: &'static [KnownPath],
    /// Characteristic length of the point that follows the known paths \[m\], over which a softening material localises.
    pub known_path_length: f64,
    /// For laws, materials and solvers: quantities that they compute at the end of a case.
    pub outputs: &'static [Output],
    /// For solvers: `auto` chooses the least cost among those that support the case; `None` if a solver is used only by name.
    pub cost: Option<u32>,
    /// Sources of its equations.
    pub sources: &'static [&'static str],
    /// Its source file (`file!()`).
    pub file: &'static str,
    /// Its crate, with the version (`package!()`).
    pub package: Package,
    /// Its page: purpose, equations, regimes, state, validity (Markdown).
    pub page: &'static str,
    /// Checks the combination of keys for the concrete type. Returns pairs of key and mistake. The single keys of the table are
    /// already checked.
    pub check: fn(&serde_json::Value) -> Vec<(String, String)>,
}

impl Card {
    /// A card with defaults only, for `..Card::BLANK`.
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
        known_path_length: 1.0,
        outputs: &[],
        cost: None,
        sources: &[],
        file: "",
        package: Package { name: "unknown", version: "unknown" },
        page: "",
        check: |_| Vec::new(),
    };

    /// A card with the keys of a type and their check only, for `..Card::of::<Law>()`.
    pub const fn of<T: Keys>() -> Card {
        Card { parameters: T::PARAMETERS, check: |value| check_as::<T>(value, T::check), ..Card::BLANK }
    }

    /// Returns true if it offers a capability.
    pub fn offers(&self, capability: Capability) -> bool {
        self.provides.contains(&capability)
    }

    /// Returns true if it meets a requirement of a solver; requirements on other kinds of plug-in are always met.
    pub fn meets(&self, requirement: Requirement) -> bool {
        requirement.iter().all(|one| one.of != self.kind) || requirement.iter().any(|one| self.offers(*one))
    }

    /// Iterates over its outputs of points, in the order in which a law writes their values.
    pub fn point_outputs(&self) -> impl Iterator<Item = &'static Output> {
        self.outputs.iter().filter(|output| output.of == OutputOf::Point)
    }

    /// Returns true if it claims a property.
    pub fn claims(&self, property: Property) -> bool {
        self.claims.contains(&property)
    }
}

inventory::collect!(Card);

/// Runs the check of a concrete type with `fn validate(&self) -> Vec<(String, String)>`.
pub fn check_as<T: serde::de::DeserializeOwned>(
    value: &serde_json::Value,
    validate: impl Fn(&T) -> Vec<(String, String)>,
) -> Vec<(String, String)> {
    match T::deserialize(value) {
        Ok(concrete) => validate(&concrete),
        Err(error) => vec![(String::new(), error.to_string())],
    }
}

/// Returns all cards, sorted by kind and tag.
pub fn cards() -> &'static [&'static Card] {
    // Sorted once: cards are registered before the program starts, and every key of every case needs them.
    static CARDS: OnceLock<Vec<&'static Card>> = OnceLock::new();
    CARDS.get_or_init(|| {
        let mut all: Vec<_> = inventory::iter::<Card>.into_iter().collect();
        all.sort_by_key(|card| (card.kind, card.tag));
        all
    })
}

/// Returns the cards of one kind, sorted by tag.
pub fn cards_of(kind: PluginKind) -> Vec<&'static Card> {
    cards().iter().copied().filter(|card| card.kind == kind).collect()
}

/// Returns the card with this kind and tag.
pub fn card(kind: PluginKind, tag: &str) -> Option<&'static Card> {
    let place = cards().binary_search_by(|card| (card.kind, card.tag).cmp(&(kind, tag))).ok()?;
    Some(cards()[place])
}

/// Returns the cards that a tag of this kind may name: `[solver] solver = …` names a limit solver or a path solver. Sorted by
/// kind and tag.
pub fn candidates(kind: PluginKind) -> Vec<&'static Card> {
    candidates_of(kind).collect()
}

fn candidates_of(kind: PluginKind) -> impl Iterator<Item = &'static Card> {
    let place = |of: PluginKind| if of == PluginKind::PathSolver { PluginKind::LimitSolver } else { of };
    cards().iter().copied().filter(move |card| place(card.kind) == place(kind))
}

/// Returns the card with this tag among the [`candidates`] of a kind.
pub fn candidate(kind: PluginKind, tag: &str) -> Option<&'static Card> {
    candidates_of(kind).find(|card| card.tag == tag)
}

/// Returns the name nearest to `wrong` among `names`, if one is near enough.
pub fn nearest<'a>(wrong: &str, names: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    names
        .into_iter()
        .map(|name| (strsim::damerau_levenshtein(wrong, name), name))
        .min()
        .filter(|(distance, name)| *distance <= 1 + name.chars().count() / 3)
        .map(|(_, name)| name)
}

/// Returns the mistakes in the registry; an empty list if all entries are valid:
/// - a kind without plug-ins (a crate that no source names registers nothing)
/// - two plug-ins of one kind with the same tag
/// - a card without a type, a type without a card, or a type whose name is not the tag of its card
/// - an output with a name that is taken, an unknown unit, or a rule that does not fit.
pub fn audit() -> Vec<String> {
    audit_of(cards(), &names_with_cards())
}

fn audit_of(all: &[&Card], readers: &[(PluginKind, Vec<&str>)]) -> Vec<String> {
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
    wrong.extend(all.iter().flat_map(|card| wrong_outputs(card)));
    for (kind, names) in readers {
        let cards: Vec<&Card> = all.iter().copied().filter(|card| card.kind == *kind).collect();
        wrong.extend(unmatched(*kind, &cards, names));
    }
    wrong
}

/// Returns the mistakes in the outputs of a card.
fn wrong_outputs(card: &Card) -> Vec<String> {
    let (kind, tag, file) = (card.kind.describe(), card.tag, card.file);
    let says = |(name, what)| format!("the output \"{name}\" of the {kind} \"{tag}\" in {file} {what}");
    output::mistakes(card.kind, card.outputs).into_iter().map(says).collect()
}

/// Compares the tags of the cards of a kind with the names by which its types are read.
fn unmatched(kind: PluginKind, cards: &[&Card], names: &[&str]) -> Vec<String> {
    let of = kind.describe();
    let mut without_card: Vec<&str> =
        names.iter().copied().filter(|name| cards.iter().all(|card| card.tag != *name)).collect();
    let mut wrong = Vec::new();
    for card in cards.iter().filter(|card| !names.contains(&card.tag)) {
        let (tag, file) = (card.tag, card.file);
        let Some(name) = nearest(tag, without_card.iter().copied()) else {
            wrong.push(format!(
                "the {of} \"{tag}\" has a card in {file}, but no type: is #[typetag::serde(name = \"{tag}\")] missing?"
            ));
            continue;
        };
        wrong.push(format!(
            "the {of} in {file} has the tag \"{tag}\" on its card, but its type is registered as \"{name}\""
        ));
        without_card.retain(|own| *own != name);
    }
    for name in without_card {
        wrong.push(format!(
            "a type is registered as {of} \"{name}\", but no card has this tag: submit a `Card` in the file of the type"
        ));
    }
    let mut seen: Vec<&str> = Vec::new();
    for name in names {
        if seen.contains(name) {
            wrong.push(format!("two types are registered as {of} \"{name}\""));
        }
        seen.push(name);
    }
    wrong
}

#[cfg(test)]
mod tests {
    use super::*;

    const ONE: Card = Card { kind: PluginKind::Scene, tag: "arch", file: "here.rs", ..Card::BLANK };

    #[test]
    fn the_audit_finds_an_empty_kind_and_a_duplicate_tag() {
        let wrong = audit_of(&[&ONE, &ONE], &[]);
        assert!(wrong.iter().any(|w| w == "no interface law is registered: is its crate named in the facade?"));
        assert!(wrong.iter().any(|w| w == "two scenes are called \"arch\": here.rs and here.rs"));
    }

    #[test]
    fn the_audit_finds_a_wrong_output() {
        const WRONG: Card = Card {
            kind: PluginKind::InterfaceLaw,
            tag: "own",
            file: "here.rs",
            outputs: &[Output::point("shear", "N", "")],
            ..Card::BLANK
        };
        let expected = "the output \"shear\" of the interface law \"own\" in here.rs has the name of a column that result files \
                        always have";
        assert!(audit_of(&[&WRONG], &[]).iter().any(|why| why == expected));
    }

    /// Tags of cards and names of types must be the same.
    #[test]
    fn the_audit_compares_cards_with_types() {
        let wrong = |names: &[&'static str]| {
            let found = audit_of(&[&ONE], &[(PluginKind::Scene, names.to_vec())]);
            found.into_iter().filter(|why| !why.starts_with("no ")).collect::<Vec<_>>()
        };
        assert_eq!(wrong(&["arch"]), Vec::<String>::new());
        assert_eq!(
            wrong(&[]),
            ["the scene \"arch\" has a card in here.rs, but no type: is #[typetag::serde(name = \"arch\")] missing?"]
        );
        assert_eq!(
            wrong(&["arhc"]),
            ["the scene in here.rs has the tag \"arch\" on its card, but its type is registered as \"arhc\""]
        );
        assert_eq!(
            wrong(&["arch", "tower"]),
            [
                "a type is registered as scene \"tower\", but no card has this tag: submit a `Card` in the file of the type"
            ]
        );
        assert_eq!(wrong(&["arch", "arch"]), ["two types are registered as scene \"arch\""]);
    }

    #[test]
    fn the_nearest_name_is_found_or_none() {
        assert_eq!(nearest("coulom", ["unilateral", "coulomb"]), Some("coulomb"));
        assert_eq!(nearest("zzzzzz", ["unilateral", "coulomb"]), None);
    }
}
