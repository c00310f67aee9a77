//! Tables of a study file with a scene that are read as structs; the fields declare the keys.

use super::resolved::Resolved;
use crate::config::common_keys::Stop;
use crate::loads::Place;
use serde_json::{Map, Value as Json};
use std::collections::BTreeMap;
use voussoir_core::plugin::{Keys, PluginKind, Shape};

/// A movement of a support.
#[derive(Debug, Clone, Keys)]
pub struct SettlementTable {
    /// left, right, or the name of a fixed block
    pub support: String,
    /// displacement of the support, x to the right and y upwards; in space x, y, z with z upwards
    #[key(default = [0.0, 0.0])]
    pub displacement: Place,
    /// rotation about the middle of the springing joint, anticlockwise; in space the rotation vector about the centre of the
    /// support's contacts
    #[key(default = 0.0)]
    pub rotation: Rotation,
}

/// Rotation of a support.
#[derive(Debug, Clone, Copy, Keys)]
#[keys(untagged)]
pub enum Rotation {
    /// Angle in the plane.
    #[key(unit = "rad")]
    Plane(f64),
    /// Rotation vector in space.
    #[key(names = ["x", "y", "z"], unit = "rad")]
    Space([f64; 3]),
}

/// Gravity from a stage on.
#[derive(Debug, Clone, Copy, Keys)]
#[keys(untagged)]
pub enum Gravity {
    /// Gravity downwards.
    #[key(unit = "m/s2", range = ">= 0")]
    Down(f64),
    /// Components of gravity.
    #[key(names = ["x", "y"], unit = "m/s2")]
    Vector([f64; 2]),
    /// Components of gravity in space.
    #[key(names = ["x", "y", "z"], unit = "m/s2")]
    Space([f64; 3]),
}

/// `until`: the end of a stage without a factor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Keys)]
pub enum Until {
    /// Raise the factor until collapse.
    Collapse,
    /// Stop a path at its first limit point.
    FirstLimitPoint,
}

impl Until {
    /// Returns the word in a study file.
    pub fn word(self) -> &'static str {
        match self {
            Until::Collapse => "collapse",
            Until::FirstLimitPoint => "first_limit_point",
        }
    }
}

/// `[record]`: the head of the report, for the people who sign it.
#[derive(Debug, Clone, Default, PartialEq, Eq, Keys)]
pub struct RecordTable {
    /// project, shown at the head of the report
    #[key(optional = "not shown")]
    pub project: Option<String>,
    /// author of the calculation
    #[key(optional = "an empty field")]
    pub author: Option<String>,
    /// person who checks the calculation
    #[key(optional = "an empty field")]
    pub checker: Option<String>,
    /// date of the calculation, in quotes
    #[key(optional = "the day of the run")]
    pub date: Option<String>,
    /// version of the document
    #[key(optional = "not shown")]
    pub version: Option<String>,
}

/// Values of fields that joint laws read.
#[derive(Debug, Clone, Keys)]
pub struct FieldTable {
    /// temperature
    #[key(unit = "K", range = "> 0", optional = "no temperature, or as it was")]
    pub temperature: Option<f64>,
    /// height of the water table, in the coordinates of the scene
    #[key(unit = "m", optional = "no water, or as it was")]
    pub water_level: Option<f64>,
    /// fields of your own laws by name, in SI units
    #[key(unit = "-", default = {})]
    pub other: BTreeMap<String, f64>,
}

impl FieldTable {
    /// Returns the fields that are set: the key below `fields`, the name for laws, and the value.
    pub fn values(&self) -> Vec<(String, String, f64)> {
        let named = [("temperature", self.temperature), ("water_level", self.water_level)];
        let named = named.into_iter().filter_map(|(name, value)| Some((name.to_string(), name.to_string(), value?)));
        named.chain(self.other.iter().map(|(name, value)| (format!("other.{name}"), name.clone(), *value))).collect()
    }
}

/// `[[stages]]`: plug-ins in it are read one by one, so that a mistake is reported at its key.
#[derive(Debug, Clone, Keys)]
pub struct StageTable {
    /// name of the stage, unique in the study
    pub name: String,
    /// gravity from this stage on: downwards, or a vector \[gx, gy\], in space \[gx, gy, gz\]
    #[key(optional = "gravity stays as it was")]
    pub gravity: Option<Gravity>,
    /// loads, multiplied by the stage's factor
    #[key(default = [])]
    pub loads: Vec<Json>,
    /// "collapse": raise the factor until collapse; "first_limit_point": stop a path at its first limit point
    #[key(optional = "the stage goes to its factor")]
    pub until: Option<Until>,
    /// factor of this stage's loads
    #[key(unit = "-", optional = "1.0, unless until is given")]
    pub factor: Option<f64>,
    /// least factor searched
    #[key(unit = "-", optional = "0")]
    pub factor_min: Option<f64>,
    /// greatest factor searched
    #[key(unit = "-", optional = "unlimited")]
    pub factor_max: Option<f64>,
    /// movements of supports
    #[key(default = [])]
    pub settlement: Vec<SettlementTable>,
    /// time in which the loads of this stage grow to its factor
    #[key(unit = "s", range = ">= 0", optional = "no time passes")]
    pub duration: Option<f64>,
    /// fields at the end of this stage, for joint laws that depend on them; they grow with the factor from their values in
    /// the stage before
    #[key(optional = "fields stay as they were")]
    pub fields: Option<FieldTable>,
    /// strategy of path solvers in this stage
    #[key(shape = Shape::Plugin(PluginKind::Continuation), optional = "that of [solver]")]
    pub continuation: Option<Json>,
    /// how far to go after a peak in this stage
    #[key(optional = "that of [solver]")]
    pub stop: Option<Stop>,
    /// tag of the limit solver that answers this stage
    #[key(optional = "that of [solver]")]
    pub solver: Option<String>,
}

/// Returns the stages of a checked case; empty if they have mistakes.
pub fn stage_tables(resolved: &Resolved) -> Vec<StageTable> {
    resolved.read("stages").unwrap_or_default()
}

/// An axis of `[sweep]`, which is read before units are known.
#[derive(Debug, Clone, Keys)]
pub struct Axis {
    /// the values
    #[key(len = ">= 1", optional = "from and to are given")]
    pub list: Option<Vec<Json>>,
    /// first value, in the unit of the key
    #[key(unit = "-", optional = "list is given")]
    pub from: Option<f64>,
    /// last value, in the unit of the key
    #[key(unit = "-", optional = "list is given")]
    pub to: Option<f64>,
    /// step towards `to`, in the unit of the key
    #[key(unit = "-", optional = "count is given")]
    pub step: Option<f64>,
    /// number of values
    #[key(range = ">= 1, <= 1_000_000", optional = "step is given")]
    pub count: Option<usize>,
}

/// An axis, or several axes that change together.
#[derive(Debug, Clone, Keys)]
#[keys(untagged)]
pub enum Axes {
    /// One key.
    One(Axis),
    /// Keys of `zip`.
    Together(BTreeMap<String, Axis>),
}

/// A variant, and a scene of a comparison.
#[derive(Debug, Clone, Keys)]
pub struct VariantTable {
    /// its name, unique in the study
    pub name: String,
    /// dotted keys in quotes, with the values they take
    #[key(default = {})]
    pub set: Map<String, Json>,
}

/// The cases that are drawn, by a word.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Keys)]
pub enum DrawnWord {
    /// All cases.
    All,
    /// The worst case of each variant.
    Worst,
    /// No case is drawn.
    None,
}

/// The cases that are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Keys)]
#[keys(untagged)]
pub enum Figures {
    /// True or false.
    Any(bool),
    /// The cases of this word.
    These(DrawnWord),
}

/// Method for the error of the load factor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Keys)]
pub enum Accuracy {
    /// Estimate by solving again.
    Estimate,
}

/// Keys of `[output]` that studies of every kind have.
#[derive(Debug, Clone, Keys)]
pub struct OutputKeys {
    /// force-displacement points
    #[key(default = false)]
    pub curve: bool,
    /// figures: of all cases, of the worst of each variant, of none; true: of all up to 50 cases, else of the worst
    #[key(default = true)]
    pub figures: Figures,
    /// number of states of each path that are kept, for the drawing that moves in the report
    #[key(range = ">= 2, <= 500", optional = "no states are kept")]
    pub states: Option<usize>,
    /// derivatives of the load factor of limit analysis with respect to every number, on both sides
    #[key(default = false)]
    pub sensitivities: bool,
    /// "estimate": estimated error of the load factor, by solving again on a mesh finer at the joints' ends and with half the step
    #[key(optional = "errors are not estimated")]
    pub accuracy: Option<Accuracy>,
    /// for an envelope: figures/moving-load.svg, the moving load with the mechanism at each position
    #[key(default = false)]
    pub animation: bool,
    /// files for ParaView of the end of each path
    #[key(default = false)]
    pub vtu: bool,
    /// the forces and motions that prove each answer; false: they are checked and not kept, and drawings show the scene
    /// alone
    #[key(default = true)]
    pub fields: bool,
    /// of a load that is carried: forces and stresses of each joint, the reserve to collapse, the permissible limit state
    #[key(default = true)]
    pub joints: bool,
    /// of a load that is carried: the interval of eccentricities of each joint over all admissible fields
    #[key(optional = "if few joints close the blocks to rings and nothing is swept")]
    pub thrust_zone: Option<bool>,
    /// path_proofs.jsonl: the states and witnesses of each path that prove its end without a solver; true: of all paths,
    /// false: of none
    #[key(optional = "paths of up to 200,000 numbers of studies of up to 20 cases")]
    pub path_proofs: Option<bool>,
}

/// Keys of `[output]` of studies with writers. The registry of writers gives the words and the tables.
#[derive(Debug, Clone, Keys)]
pub struct WriterKeys {
    /// tags of the writers that write; results.json is always written
    #[key(optional = "all")]
    pub writers: Option<Vec<String>>,
    /// options of writers, by tag
    #[key(default = {})]
    pub options: Map<String, Json>,
}
