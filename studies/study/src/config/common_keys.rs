//! Keys and words that every plug-in of a kind accepts, besides the keys of its card.

use serde_json::Value as Json;
use voussoir_core::plugin::{Keys, Parameter, PluginKind, Shape};

/// `stop`: the end of a path after a peak.
#[derive(Debug, Clone, Copy, Keys)]
pub struct Stop {
    /// displacement of the load point after a peak
    #[key(unit = "m", range = "> 0", optional = "not a limit")]
    pub displacement: Option<f64>,
    /// load factor at which a path ends
    #[key(unit = "-", optional = "not a limit")]
    pub factor: Option<f64>,
}

/// Small or finite displacements.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Keys)]
pub enum Kinematics {
    /// Equilibrium in the undeformed position.
    Small,
    /// Equilibrium in displaced positions.
    Finite,
}

/// Keys of `[solver]` that every solver has.
#[derive(Debug, Clone, Keys)]
pub struct SolverKeys {
    /// small or finite displacements
    #[key(default = "small")]
    pub kinematics: Kinematics,
    /// strategy of path solvers: { strategy = "arc_length" }
    #[key(shape = Shape::Plugin(PluginKind::Continuation), optional = "the solver's own")]
    pub continuation: Option<Json>,
    /// relative tolerance of loads: of certificates, and of the states that path solvers accept
    #[key(unit = "-", range = "> 0, <= 0.01", default = 1e-9)]
    pub tolerance: f64,
    /// scenes in space whose joints have more strength than a cone: parts of each side of a contact
    #[key(range = ">= 1, <= 64", optional = "4 parts")]
    pub subdivisions: Option<usize>,
    /// how far to go after a peak
    #[key(optional = "the path ends at collapse")]
    pub stop: Option<Stop>,
}

/// Reads the keys of `T` from a checked table that also has other keys; `None` if they cannot be read.
pub fn own_keys<T: Keys>(table: &Json) -> Option<T> {
    let own = |(name, _): &(&String, &Json)| T::PARAMETERS.iter().any(|key| key.name == name.as_str());
    let own = table.as_object()?.iter().filter(own).map(|(name, value)| (name.clone(), value.clone()));
    serde_json::from_value(Json::Object(own.collect())).ok()
}

/// Returns the tag of the plug-in that a table configures.
pub fn tag_of(kind: PluginKind, table: &Json) -> &str {
    table.get(kind.tag_key()).and_then(Json::as_str).unwrap_or_default()
}

/// Returns the keys that every plug-in of a kind has, besides the keys of its card.
pub fn common_parameters(kind: PluginKind) -> &'static [Parameter] {
    if kind == PluginKind::LimitSolver { SolverKeys::PARAMETERS } else { &[] }
}

/// Returns the name of a kind in messages. Limit and path solvers share one name, because they share one table.
pub fn word_for(kind: PluginKind) -> &'static str {
    if kind == PluginKind::LimitSolver { "solver" } else { kind.describe() }
}

/// Returns the words that a tag may be, besides the registered tags.
pub fn common_words(kind: PluginKind) -> &'static [&'static str] {
    if kind == PluginKind::LimitSolver { &["auto"] } else { &[] }
}
