//! The keys of a study file.

use super::partial_factors::Factors;
use super::tables::{Axes, OutputKeys, RecordTable, StageTable, VariantTable, WriterKeys};
use crate::loads::{VehicleAxles, load_shape};
use serde_json::Value as Json;
use std::collections::BTreeMap;
use std::sync::LazyLock;
use voussoir_core::law::{BulkMaterial, InterfaceLaw};
use voussoir_core::model::Scene;
use voussoir_core::plugin::{Capability, Card, Keys, Need, Parameter, PluginKind, Shape, cards_of};

/// Returns the shape of `[output]` with the registered writers: the list of active writers, and a table of options for each
/// writer that has keys.
fn output() -> Shape {
    let cards = cards_of(PluginKind::Writer);
    // Made once, from a registry with the lifetime of the program.
    let tags: &'static [&'static str] = Vec::leak(cards.iter().map(|card| card.tag).collect());
    let tag: &'static Shape = Box::leak(Box::new(Shape::Choice(tags)));
    let with_keys = cards.into_iter().filter(|card| !card.parameters.is_empty());
    let table = |card: &Card| {
        let shape = Shape::Table(card.parameters);
        Parameter { name: card.tag, doc: card.summary, shape, need: Need::Default("{}") }
    };
    let options: Vec<Parameter> = with_keys.map(table).collect();
    let list = Shape::List { of: tag, min: 0, max: usize::MAX };
    let of_writers = WriterKeys::PARAMETERS.iter().map(|key| match key.name {
        "writers" => Parameter { shape: list, ..*key },
        _ => Parameter { shape: Shape::Table(options.clone().leak()), ..*key },
    });
    Shape::Table(OutputKeys::PARAMETERS.iter().copied().chain(of_writers).collect::<Vec<_>>().leak())
}

/// Returns the cards of study kinds that have their own table, such as `[compare]`, with their tag as its name.
fn kinds_with_tables() -> impl Iterator<Item = &'static Card> {
    let in_a_study = |card: &&Card| !card.offers(Capability::OWN_FILE) && !card.parameters.is_empty();
    cards_of(PluginKind::StudyKind).into_iter().filter(in_a_study)
}

/// Returns the names of the tables of study kinds, which are not part of a case.
pub fn kind_tables() -> &'static [&'static str] {
    static TABLES: LazyLock<Vec<&'static str>> = LazyLock::new(|| kinds_with_tables().map(|card| card.tag).collect());
    &TABLES
}

/// The table of the people who sign the report.
pub const RECORD: &str = "record";

/// Returns the names of the tables that are not part of a case: those of study kinds and [`RECORD`].
pub fn tables_apart() -> &'static [&'static str] {
    static TABLES: LazyLock<Vec<&'static str>> =
        LazyLock::new(|| kind_tables().iter().copied().chain([RECORD]).collect());
    &TABLES
}

/// Returns the top-level keys that are part of a case.
pub fn case_keys() -> impl Iterator<Item = &'static Parameter> {
    let apart = |name: &str| ["sweep", "variants"].contains(&name) || tables_apart().contains(&name);
    study_keys().iter().filter(move |parameter| !apart(parameter.name))
}

/// Returns the keys of a study file: the keys of every study, and the tables of study kinds.
pub fn study_keys() -> &'static [Parameter] {
    static KEYS: LazyLock<Vec<Parameter>> = LazyLock::new(|| {
        let table = |card: &Card| {
            let shape = Shape::Table(card.parameters);
            Parameter { name: card.tag, doc: card.summary, shape, need: Need::Optional("defaults") }
        };
        let (common, output) = StudyTable::PARAMETERS.split_at(StudyTable::PARAMETERS.len() - 1);
        let with_registry = |key: &Parameter| match key.name {
            "stages" => Parameter { shape: stages(), ..*key },
            "output" => Parameter { shape: self::output(), ..*key },
            _ => *key,
        };
        let kinds = kinds_with_tables().map(table);
        common.iter().map(with_registry).chain(kinds).chain(output.iter().map(with_registry)).collect()
    });
    &KEYS
}

/// Returns the shape of the list of stages, with the registered load kinds.
fn stages() -> Shape {
    let list = Shape::List { of: load_shape(), min: 0, max: usize::MAX };
    let loads = |key: &Parameter| if key.name == "loads" { Parameter { shape: list, ..*key } } else { *key };
    // Made once, from a registry with the lifetime of the program.
    let stage = Box::leak(Box::new(Shape::Table(Vec::leak(StageTable::PARAMETERS.iter().map(loads).collect()))));
    Shape::List { of: stage, min: 1, max: usize::MAX }
}

/// The keys of every study with a scene. They are read key by key, because cases share most of them.
#[derive(Debug, Keys)]
struct StudyTable {
    /// name of the study
    name: String,
    /// what is done with the cases
    #[key(default = "run")]
    kind: String,
    /// head of the report: project, author, checker, date and version
    #[key(optional = "the report has no head")]
    record: Option<RecordTable>,
    /// the geometry
    scene: Box<dyn Scene>,
    /// materials of blocks by name
    materials: BTreeMap<String, Box<dyn BulkMaterial>>,
    /// laws of joints by name
    #[key(default = {})]
    joints: BTreeMap<String, Box<dyn InterfaceLaw>>,
    /// stages of loading, \[\[stages\]\], in order
    #[key(len = ">= 1")]
    stages: Vec<StageTable>,
    /// solver of the cases
    #[key(shape = Shape::Plugin(PluginKind::LimitSolver), default = {})]
    solver: Json,
    /// vehicles by name, for loads of kind "vehicle"
    #[key(optional = "no vehicles")]
    vehicles: Option<BTreeMap<String, VehicleAxles>>,
    /// partial factors on weights, loads and strengths; the values given elsewhere are characteristic ones
    #[key(optional = "all are 1")]
    factors: Option<Factors>,
    /// axes by dotted key in quotes; keys under zip change together
    #[key(optional = "one case")]
    sweep: Option<BTreeMap<String, Axes>>,
    /// each overrides any keys
    #[key(optional = "no variants")]
    variants: Option<Vec<VariantTable>>,
    /// what is written besides the results
    #[key(default = {})]
    output: OutputKeys,
}
