//! Cards: what a plug-in says of itself, and the registry of all of them.
//!
//! A plug-in registers twice, next to its type: `#[typetag::serde]` makes it readable from a
//! configuration, `inventory::submit!` hands in its [`Card`]. Lists, help pages, the JSON Schema,
//! the check of study files and the conformance tests read cards only.

use super::schema::{Parameter, PluginKind};

/// What laws offer and solvers ask for; compared when a study is loaded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Capability {
    /// The interface law is given by facets a·t ≤ b.
    Facets,
    /// The interface law is given by tractions from gaps, with state.
    Response,
    /// The interface law is of either of these two forms. Asked for only: a law gives one of the forms.
    FacetsOrResponse,
    /// The bulk material gives stresses from strains at a point, with state.
    StressUpdate,
    /// The material is linear elastic, or rigid.
    Linear,
    /// Bodies may be read as rigid without changing the answer.
    RigidLimit,
    /// Equilibrium in displaced positions.
    FiniteDisplacements,
    /// Imposed movements of supports.
    Settlement,
}

impl Capability {
    /// In words.
    pub fn describe(self) -> &'static str {
        match self {
            Capability::Facets => "facets",
            Capability::Response => "tractions from gaps",
            Capability::FacetsOrResponse => "facets or tractions from gaps",
            Capability::StressUpdate => "stresses from strains at a point",
            Capability::Linear => "a linear law",
            Capability::RigidLimit => "a rigid limit",
            Capability::FiniteDisplacements => "finite displacements",
            Capability::Settlement => "settlements",
        }
    }
}

/// What a plug-in says of itself.
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
    /// What it asks of the laws it meets.
    pub requires: &'static [Capability],
    /// Where its equations come from.
    pub sources: &'static [&'static str],
    /// Its source file (`file!()`).
    pub file: &'static str,
    /// Its page: purpose, equations, regimes, state, validity (Markdown).
    pub page: &'static str,
    /// Checks of the whole table that single keys cannot show, for the concrete type:
    /// pairs of key and what is wrong with it. The table has passed the check of its keys.
    pub check: fn(&serde_json::Value) -> Vec<(String, String)>,
}

impl Card {
    /// Whether it offers what a solver asks for.
    pub fn gives(&self, need: Capability) -> bool {
        match need {
            Capability::FacetsOrResponse => {
                self.provides.contains(&Capability::Facets) || self.provides.contains(&Capability::Response)
            }
            need => self.provides.contains(&need),
        }
    }
}

inventory::collect!(Card);

/// For cards without a check of their own.
pub fn no_further_check(_: &serde_json::Value) -> Vec<(String, String)> {
    Vec::new()
}

/// The checks of a concrete type with `fn validate(&self) -> Vec<(String, String)>`.
pub fn check_as<T: serde::de::DeserializeOwned>(
    value: &serde_json::Value,
    validate: impl Fn(&T) -> Vec<(String, String)>,
) -> Vec<(String, String)> {
    match serde_json::from_value::<T>(value.clone()) {
        Ok(concrete) => validate(&concrete),
        Err(error) => vec![(String::new(), error.to_string())],
    }
}

/// All cards, sorted by kind and tag.
pub fn cards() -> Vec<&'static Card> {
    let mut all: Vec<_> = inventory::iter::<Card>.into_iter().collect();
    all.sort_by_key(|card| (card.kind, card.tag));
    all
}

/// The cards of one kind, sorted by tag.
pub fn cards_of(kind: PluginKind) -> Vec<&'static Card> {
    cards().into_iter().filter(|card| card.kind == kind).collect()
}

/// The card with this kind and tag.
pub fn card(kind: PluginKind, tag: &str) -> Option<&'static Card> {
    inventory::iter::<Card>.into_iter().find(|card| card.kind == kind && card.tag == tag)
}

/// The cards that may stand in the place of one kind: `[solver] solver = …` names a limit solver or a
/// path solver. Sorted by kind and tag.
pub fn candidates(kind: PluginKind) -> Vec<&'static Card> {
    let place = |of: PluginKind| if of == PluginKind::PathSolver { PluginKind::LimitSolver } else { of };
    cards().into_iter().filter(|card| place(card.kind) == place(kind)).collect()
}

/// The card with this tag among those that may stand in the place of one kind.
pub fn candidate(kind: PluginKind, tag: &str) -> Option<&'static Card> {
    candidates(kind).into_iter().find(|card| card.tag == tag)
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
    audit_of(&cards())
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

    const ONE: Card = Card {
        kind: PluginKind::Scene,
        tag: "arch",
        summary: "",
        parameters: &[],
        provides: &[],
        requires: &[],
        sources: &[],
        file: "here.rs",
        page: "",
        check: no_further_check,
    };

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
