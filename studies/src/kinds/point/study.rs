//! The study file of a driven point: its keys, and the cases it becomes.

use super::result::columns;
use crate::config::check::Checker;
use crate::config::diagnostic::{LocatedDiagnostic, sort, suggest};
use crate::config::dotted_key::join;
use crate::config::expand::{Expanded, Expansion};
use crate::study::{DiagnosticList, Drawn, OUTPUT, StudyError, StudySource, SweptKeys, read_plugin};
use serde_json::{Map, Value as Json};
use voussoir_core::law::{BulkMaterial, InterfaceLaw, PlanarUpdate, Plane};
use voussoir_core::plugin::{Need, Parameter, PluginKind, Quantity, Range, Shape};
use voussoir_solvers::point::{Control, PointLaw};

const fn key(name: &'static str, shape: Shape, need: Need, doc: &'static str) -> Parameter {
    Parameter { name, doc, shape, need }
}

const fn component(name: &'static str, quantity: Quantity, doc: &'static str) -> Parameter {
    Parameter { name, doc, shape: Shape::Number(quantity, Range::ANY), need: Need::Optional("it keeps its value") }
}

const STRAIN_DOC: &str = "strain at the end of the segment";
const STRESS_DOC: &str = "stress at the end of the segment";
const GAP_DOC: &str = "gap at the end of the segment";
const TRACTION_DOC: &str = "traction at the end of the segment";

static STRAIN: Shape = Shape::Table(&[
    component("xx", Quantity::Ratio, STRAIN_DOC),
    component("yy", Quantity::Ratio, STRAIN_DOC),
    component("zz", Quantity::Ratio, STRAIN_DOC),
    component("xy", Quantity::Ratio, STRAIN_DOC),
    component("yz", Quantity::Ratio, STRAIN_DOC),
    component("zx", Quantity::Ratio, STRAIN_DOC),
]);
static STRESS: Shape = Shape::Table(&[
    component("xx", Quantity::Stress, STRESS_DOC),
    component("yy", Quantity::Stress, STRESS_DOC),
    component("zz", Quantity::Stress, STRESS_DOC),
    component("xy", Quantity::Stress, STRESS_DOC),
    component("yz", Quantity::Stress, STRESS_DOC),
    component("zx", Quantity::Stress, STRESS_DOC),
]);
static GAP: Shape =
    Shape::Table(&[component("n", Quantity::Length, GAP_DOC), component("t", Quantity::Length, GAP_DOC)]);
static TRACTION: Shape =
    Shape::Table(&[component("n", Quantity::Stress, TRACTION_DOC), component("t", Quantity::Stress, TRACTION_DOC)]);

static SEGMENT: Shape = Shape::Table(&[
    key("steps", Shape::Integer { min: 1, max: 100_000 }, Need::Default("20"), "equal steps of the segment"),
    key(
        "strain",
        STRAIN,
        Need::Default("{}"),
        "strains at the end of the segment, tension positive, engineering shears",
    ),
    key("stress", STRESS, Need::Default("{}"), "stresses at the end of the segment, tension positive"),
    key("gap", GAP, Need::Default("{}"), "gaps of a joint at the end of the segment, n > 0 open"),
    key(
        "traction",
        TRACTION,
        Need::Default("{}"),
        "tractions of a joint at the end of the segment, n > 0 in compression",
    ),
]);

/// Keys of `[point]`.
pub static POINT: &[Parameter] = &[
    key("material", Shape::Reference("materials"), Need::Optional("joint is given"), "the material that is driven"),
    key("joint", Shape::Reference("joints"), Need::Optional("material is given"), "the joint law that is driven"),
    key(
        "plane",
        Shape::Choice(&["strain", "stress"]),
        Need::Optional("a material is driven in space"),
        "plane strain or plane stress",
    ),
    Parameter::number(
        "length",
        Quantity::Length,
        Range::POSITIVE,
        "characteristic length over which the material localises",
    )
    .optional("1 m; only softening materials read it"),
    key(
        "path",
        Shape::List { of: &SEGMENT, min: 1, max: 1000 },
        Need::Required,
        "segments of the path, [[point.path]], in order",
    ),
    key(
        "plot",
        Shape::List { of: &Shape::Text, min: 2, max: 2 },
        Need::Optional("the first component that moves"),
        "columns of the figure, abscissa and ordinate, such as [\"strain_xx\", \"stress_xx\"]",
    ),
];

static MATERIAL: Shape = Shape::Plugin(PluginKind::BulkMaterial);
static LAW: Shape = Shape::Plugin(PluginKind::InterfaceLaw);

/// The keys of such a study.
pub static STUDY: &[Parameter] = &[
    key("name", Shape::Text, Need::Required, "name of the study"),
    key("kind", Shape::Choice(&["point"]), Need::Required, "what is done"),
    key("point", Shape::Table(POINT), Need::Required, "what is driven, and how"),
    key("materials", Shape::Map(&MATERIAL), Need::Default("{}"), "materials by name"),
    key("joints", Shape::Map(&LAW), Need::Default("{}"), "laws of joints by name"),
    key("sweep", Shape::Free, Need::Optional("one case"), "as in other studies"),
    key("variants", Shape::Free, Need::Optional("no variants"), "as in other studies"),
    key("output", OUTPUT, Need::Default("{}"), "what is written besides the results"),
];

/// One segment of the path.
#[derive(Debug, Clone)]
pub struct Segment {
    /// Equal steps.
    pub steps: usize,
    /// The end value of each component; `None` if it keeps its value.
    pub targets: Vec<Option<Control>>,
}

/// One point to drive.
#[derive(Debug, Clone)]
pub struct PointCase {
    /// Index from 0, variants outermost.
    pub id: usize,
    /// Name of its variant.
    pub variant: Option<String>,
    /// Swept key → value.
    pub parameters: Map<String, Json>,
    /// Tag of the law.
    pub tag: String,
    /// The law.
    pub law: PointLaw,
    /// Its path.
    pub path: Vec<Segment>,
    /// Columns of the figure.
    pub plot: [String; 2],
    /// Keys that have no influence.
    pub notes: Vec<String>,
}

/// A study of driven points.
#[derive(Debug, Clone)]
pub struct PointStudy {
    /// Its name.
    pub name: String,
    /// Whether figures are wanted.
    pub figures: bool,
    /// Its cases.
    pub cases: Vec<PointCase>,
    /// Units and words of the swept keys.
    pub keys: SweptKeys,
    /// The file with `--set` applied.
    pub resolved: toml::Value,
}

impl PointStudy {
    /// Reads a study from TOML; every mistake at once. Arguments as of [`crate::study::load`].
    pub fn load(text: &str, file: &str, sets: &[(String, String)]) -> Result<Self, StudyError> {
        PointStudy::from_source(StudySource::parse(text, file, sets)?)
    }

    /// The study that a source describes.
    pub fn from_source(source: StudySource) -> Result<Self, StudyError> {
        let StudySource { root, mut diagnostics, .. } = source;
        let expansion = match Expansion::new(&root, &[], STUDY) {
            Ok(expansion) => expansion,
            Err(wrong) => {
                diagnostics.extend(wrong);
                sort(&mut diagnostics);
                return Err(diagnostics.into());
            }
        };
        let (mut cases, mut figures) = (Vec::new(), true);
        for id in 0..expansion.count() {
            match expansion.case(id).and_then(|expanded| build(id, expanded)) {
                Ok((case, drawn)) => {
                    figures = drawn;
                    cases.push(case);
                }
                Err(wrong) => {
                    for diagnostic in wrong {
                        if !diagnostics.contains(&diagnostic) {
                            diagnostics.push(diagnostic);
                        }
                    }
                }
            }
            if diagnostics.len() > 100 {
                break;
            }
        }
        if !diagnostics.is_empty() {
            sort(&mut diagnostics);
            return Err(diagnostics.into());
        }
        let name = root.table().and_then(|table| table.get("name")?.text()).unwrap_or_default().to_string();
        let keys = SweptKeys::of_expansion(STUDY, &expansion);
        Ok(PointStudy { name, figures, cases, keys, resolved: root.to_toml() })
    }
}

fn build(id: usize, expanded: Expanded) -> Result<(PointCase, bool), Vec<LocatedDiagnostic>> {
    let Expanded { variant, parameters, root, .. } = expanded;
    let mut checker = Checker::new(&root);
    let checked = checker.check(&root, &Shape::Table(STUDY), "");
    let (found, unused) = (std::mem::take(&mut checker.diagnostics), std::mem::take(&mut checker.unused));
    let (Some(resolved), true) = (checked, found.is_empty()) else {
        return Err(found);
    };
    let mut diagnostics = DiagnosticList::new(&root, found);
    let point = &resolved["point"];
    let Some((tag, law)) = read_law(&mut diagnostics, &resolved, point) else {
        return Err(diagnostics.found);
    };
    let path: Vec<Segment> = (0..point["path"].as_array().map_or(0, Vec::len))
        .map(|number| read_segment(&mut diagnostics, &law, &point["path"][number], &format!("point.path.{number}")))
        .collect();
    let plot = read_plot(&mut diagnostics, &law, point, &path);
    if !diagnostics.found.is_empty() {
        return Err(diagnostics.found);
    }
    let notes = unused.into_iter().map(|unused| format!("{} is not used by {}", unused.key, unused.by)).collect();
    let drawn = Drawn::read(&resolved["output"]["figures"], 1).anything();
    Ok((PointCase { id, variant, parameters, tag, law, path, plot, notes }, drawn))
}

/// The tag of the law that is driven, and the law.
fn read_law(diagnostics: &mut DiagnosticList<'_>, resolved: &Json, point: &Json) -> Option<(String, PointLaw)> {
    let tag = |table: &Json| table["law"].as_str().unwrap_or_default().to_string();
    match (point["material"].as_str(), point["joint"].as_str()) {
        (Some(name), None) => {
            let table = &resolved["materials"][name];
            let material = read_plugin(diagnostics, &join("materials", name), table)?;
            Some((tag(table), material_law(diagnostics, material, &tag(table), point)?))
        }
        (None, Some(name)) => {
            let table = &resolved["joints"][name];
            let law = read_plugin(diagnostics, &join("joints", name), table)?;
            if point["plane"].is_string() {
                diagnostics.wrong("point.plane", "is for materials; a joint is driven in its own plane", "remove it");
            }
            Some((tag(table), joint_law(diagnostics, law, &tag(table))?))
        }
        _ => {
            diagnostics.wrong("point", "needs either material or joint", "name what is driven");
            None
        }
    }
}

/// A material, driven in space or in a plane.
fn material_law(
    diagnostics: &mut DiagnosticList<'_>,
    material: Box<dyn BulkMaterial>,
    tag: &str,
    point: &Json,
) -> Option<PointLaw> {
    let length = point["length"].as_f64().unwrap_or(1.0);
    let Some(update) = material.stress_update() else {
        let message = format!("bulk material \"{tag}\" gives no stresses from strains at a point");
        diagnostics.wrong("point.material", message, "drive a material that deforms");
        return None;
    };
    if length > update.largest_length() {
        let message = format!(
            "{length} m is too large for the fracture energy: a point would snap back; it must be at most {:.6} m",
            update.largest_length()
        );
        let help = "give a shorter length (smaller elements) or more fracture energy";
        diagnostics.wrong("point.length", message, help);
        return None;
    }
    let plane = match point["plane"].as_str() {
        None => return Some(PointLaw::Space(update, length)),
        Some("stress") => Plane::Stress,
        Some(_) => Plane::Strain,
    };
    match PlanarUpdate::new(update, plane) {
        Ok(planar) => Some(PointLaw::Plane(planar, length)),
        Err(failure) => {
            diagnostics.wrong("point.material", failure.to_string(), "check the parameters of the material");
            None
        }
    }
}

/// A joint law that gives tractions from gaps, by itself or by its facets with a stiffness.
fn joint_law(diagnostics: &mut DiagnosticList<'_>, law: Box<dyn InterfaceLaw>, tag: &str) -> Option<PointLaw> {
    if let Some(response) = law.response() {
        return Some(PointLaw::Joint(response));
    }
    let message = format!("interface law \"{tag}\" without stiffness gives no tractions from gaps");
    diagnostics.wrong("point.joint", message, "give the joint normal_stiffness and shear_stiffness");
    None
}

fn read_segment(diagnostics: &mut DiagnosticList<'_>, law: &PointLaw, segment: &Json, at: &str) -> Segment {
    let names = law.names();
    let mut targets: Vec<Option<Control>> = vec![None; names.len()];
    let joint = matches!(law, PointLaw::Joint(_));
    let tables = [("strain", false, true), ("stress", false, false), ("gap", true, true), ("traction", true, false)];
    for (table, of_joint, strain) in tables {
        for (name, value) in segment[table].as_object().into_iter().flatten() {
            let place = join(&join(at, table), name);
            let Some(value) = value.as_f64() else { continue };
            if of_joint != joint {
                let help = if joint { "a joint has gap and traction" } else { "a material has strain and stress" };
                diagnostics.wrong(&place, "does not belong to what is driven", help);
                continue;
            }
            let Some(index) = names.iter().position(|known| known == name) else {
                diagnostics.wrong(&place, "is not a component in a plane", suggest(name, names, "components"));
                continue;
            };
            if targets[index].is_some() {
                diagnostics.wrong(&place, "is controlled twice in this segment", "give its strain or its stress");
            }
            targets[index] = Some(if strain { Control::Strain(value) } else { Control::Stress(value) });
        }
    }
    if targets.iter().all(Option::is_none) {
        diagnostics.wrong(at, "moves nothing", "name at least one component");
    }
    Segment { steps: segment["steps"].as_u64().unwrap_or(1) as usize, targets }
}

fn read_plot(diagnostics: &mut DiagnosticList<'_>, law: &PointLaw, point: &Json, path: &[Segment]) -> [String; 2] {
    let columns = columns(law);
    let bare: Vec<&str> = columns.iter().filter_map(|column| column.split(' ').next()).collect();
    if let Some([x, y]) = point["plot"].as_array().map(Vec::as_slice) {
        let words = [x, y].map(|word| word.as_str().unwrap_or_default().to_string());
        for (index, word) in words.iter().enumerate() {
            if !bare.contains(&word.as_str()) {
                let help = suggest(word, &bare, "columns");
                diagnostics.wrong(&format!("point.plot.{index}"), format!("there is no column \"{word}\""), help);
            }
        }
        return words;
    }
    let strained = path.iter().flat_map(|s| s.targets.iter().enumerate()).find_map(|(index, target)| match target {
        Some(Control::Strain(value)) if *value != 0.0 => Some(index),
        _ => None,
    });
    let index = strained.unwrap_or(0);
    [bare[index].to_string(), bare[law.components() + index].to_string()]
}
