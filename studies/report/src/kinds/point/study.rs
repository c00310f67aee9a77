//! The study file of a driven point: its keys and its cases.

use super::result::columns;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value as Json};
use std::collections::BTreeMap;
use voussoir_core::law::{BulkMaterial, InterfaceLaw, PlanarUpdate};
use voussoir_core::plugin::{KeyValue, Keys, PluginKind, Shape};
use voussoir_solvers::point::{Control, PointLaw};
use voussoir_study::config::check::Checker;
use voussoir_study::config::common_keys::tag_of;
use voussoir_study::config::diagnostic::{LocatedDiagnostic, sort, suggest};
use voussoir_study::config::dotted_key::join;
use voussoir_study::config::expand::{Expanded, Expansion};
use voussoir_study::scenes::PlaneState;
use voussoir_study::study::{DiagnosticList, Drawn, OutputKeys, StudyError, StudySource, SweptKeys, read_plugin};

/// Strains at the end of a segment.
#[derive(Debug, Clone, Keys)]
pub struct StrainKeys {
    /// strain at the end of the segment
    #[key(unit = "-", optional = "it keeps its value")]
    xx: Option<f64>,
    /// strain at the end of the segment
    #[key(unit = "-", optional = "it keeps its value")]
    yy: Option<f64>,
    /// strain at the end of the segment
    #[key(unit = "-", optional = "it keeps its value")]
    zz: Option<f64>,
    /// strain at the end of the segment
    #[key(unit = "-", optional = "it keeps its value")]
    xy: Option<f64>,
    /// strain at the end of the segment
    #[key(unit = "-", optional = "it keeps its value")]
    yz: Option<f64>,
    /// strain at the end of the segment
    #[key(unit = "-", optional = "it keeps its value")]
    zx: Option<f64>,
}

/// Stresses at the end of a segment.
#[derive(Debug, Clone, Keys)]
pub struct StressKeys {
    /// stress at the end of the segment
    #[key(unit = "Pa", optional = "it keeps its value")]
    xx: Option<f64>,
    /// stress at the end of the segment
    #[key(unit = "Pa", optional = "it keeps its value")]
    yy: Option<f64>,
    /// stress at the end of the segment
    #[key(unit = "Pa", optional = "it keeps its value")]
    zz: Option<f64>,
    /// stress at the end of the segment
    #[key(unit = "Pa", optional = "it keeps its value")]
    xy: Option<f64>,
    /// stress at the end of the segment
    #[key(unit = "Pa", optional = "it keeps its value")]
    yz: Option<f64>,
    /// stress at the end of the segment
    #[key(unit = "Pa", optional = "it keeps its value")]
    zx: Option<f64>,
}

/// Gaps of a joint at the end of a segment.
#[derive(Debug, Clone, Keys)]
pub struct GapKeys {
    /// gap at the end of the segment
    #[key(unit = "m", optional = "it keeps its value")]
    n: Option<f64>,
    /// gap at the end of the segment
    #[key(unit = "m", optional = "it keeps its value")]
    t: Option<f64>,
}

/// Tractions of a joint at the end of a segment.
#[derive(Debug, Clone, Keys)]
pub struct TractionKeys {
    /// traction at the end of the segment
    #[key(unit = "Pa", optional = "it keeps its value")]
    n: Option<f64>,
    /// traction at the end of the segment
    #[key(unit = "Pa", optional = "it keeps its value")]
    t: Option<f64>,
}

/// `[[point.path]]`.
#[derive(Debug, Clone, Keys)]
pub struct SegmentTable {
    /// equal steps of the segment
    #[key(range = ">= 1, <= 100_000", default = 20)]
    steps: usize,
    /// strains at the end of the segment, tension positive, engineering shears
    #[key(default = {})]
    strain: StrainKeys,
    /// stresses at the end of the segment, tension positive
    #[key(default = {})]
    stress: StressKeys,
    /// gaps of a joint at the end of the segment, n > 0 open
    #[key(default = {})]
    gap: GapKeys,
    /// tractions of a joint at the end of the segment, n > 0 in compression
    #[key(default = {})]
    traction: TractionKeys,
}

/// `[point]`.
#[derive(Debug, Clone, Keys)]
pub struct PointTable {
    /// the material that is driven
    #[key(reference = "materials", optional = "joint is given")]
    material: Option<String>,
    /// the joint law that is driven
    #[key(reference = "joints", optional = "material is given")]
    joint: Option<String>,
    /// plane strain or plane stress
    #[key(optional = "a material is driven in space")]
    plane: Option<PlaneState>,
    /// characteristic length over which the material localises
    #[key(unit = "m", range = "> 0", optional = "1 m; only softening materials read it")]
    length: Option<f64>,
    /// segments of the path, \[\[point.path\]\], in order
    #[key(len = ">= 1, <= 1000")]
    path: Vec<SegmentTable>,
    /// columns of the figure, abscissa and ordinate, such as \["strain_xx", "stress_xx"\]
    #[key(optional = "the first component that moves")]
    plot: Option<[String; 2]>,
}

/// The value of `kind` of such a study.
#[derive(Debug, Clone, Copy, Keys)]
pub enum PointKind {
    /// A point is driven.
    Point,
}

/// A study file of this kind. Its laws are read one by one, so that a mistake is reported at its key.
#[derive(Debug, Clone, Keys)]
pub struct PointFile {
    /// name of the study
    name: String,
    /// kind of the study
    kind: PointKind,
    /// driven law and its path
    point: PointTable,
    /// materials by name
    #[key(of = MATERIAL, default = {})]
    materials: BTreeMap<String, Json>,
    /// laws of joints by name
    #[key(of = LAW, default = {})]
    joints: BTreeMap<String, Json>,
    /// as in other studies
    #[key(optional = "one case")]
    sweep: Option<Json>,
    /// as in other studies
    #[key(optional = "no variants")]
    variants: Option<Json>,
    /// what is written besides the results
    #[key(default = {})]
    output: OutputKeys,
}

const MATERIAL: Shape = Shape::Plugin(PluginKind::BulkMaterial);
const LAW: Shape = Shape::Plugin(PluginKind::InterfaceLaw);

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
    /// Notes about unused keys.
    pub notes: Vec<String>,
}

/// A study of driven points.
#[derive(Debug, Clone)]
pub struct PointStudy {
    /// Its name.
    pub name: String,
    /// True if figures are requested.
    pub figures: bool,
    /// Its cases.
    pub cases: Vec<PointCase>,
    /// Units and descriptions of the swept keys.
    pub keys: SweptKeys,
    /// Returns the file with `--set` applied.
    pub resolved: toml::Value,
}

impl PointStudy {
    /// Reads a study from TOML. The error contains all mistakes. Arguments as for [`voussoir_study::file::load`].
    pub fn load(text: &str, file: &str, sets: &[(String, String)]) -> Result<Self, StudyError> {
        PointStudy::from_source(StudySource::parse(text, file, sets)?)
    }

    /// Returns the study of a source.
    pub fn from_source(source: StudySource) -> Result<Self, StudyError> {
        let StudySource { root, mut diagnostics, .. } = source;
        let expansion = match Expansion::new(&root, &[], PointFile::PARAMETERS) {
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
        let keys = SweptKeys::of_expansion(PointFile::PARAMETERS, &expansion);
        Ok(PointStudy { name, figures, cases, keys, resolved: root.to_toml() })
    }
}

fn build(id: usize, expanded: Expanded) -> Result<(PointCase, bool), Vec<LocatedDiagnostic>> {
    let Expanded { variant, parameters, root, .. } = expanded;
    let mut checker = Checker::new(&root);
    let checked = checker.check(&root, &PointFile::SHAPE, "");
    let (found, unused) = (std::mem::take(&mut checker.diagnostics), std::mem::take(&mut checker.unused));
    let (Some(resolved), true) = (checked, found.is_empty()) else {
        return Err(found);
    };
    let mut diagnostics = DiagnosticList::new(&root, found);
    let file = PointFile::deserialize(&resolved)
        .map_err(|error| vec![LocatedDiagnostic::new(&root.origin, "", format!("cannot be read: {error}"))])?;
    let point = &file.point;
    let Some((tag, law)) = read_law(&mut diagnostics, &file) else {
        return Err(diagnostics.found);
    };
    let segment = |(number, segment): (usize, &SegmentTable)| {
        read_segment(&mut diagnostics, &law, segment, &format!("point.path.{number}"))
    };
    let path: Vec<Segment> = point.path.iter().enumerate().map(segment).collect();
    let plot = read_plot(&mut diagnostics, &law, point, &path);
    if !diagnostics.found.is_empty() {
        return Err(diagnostics.found);
    }
    let notes = unused.into_iter().map(|unused| format!("{} is not used by {}", unused.key, unused.by)).collect();
    let drawn = Drawn::of(file.output.figures, 1).anything();
    Ok((PointCase { id, variant, parameters, tag, law, path, plot, notes }, drawn))
}

/// Returns the tag of the driven law, and the law.
fn read_law(diagnostics: &mut DiagnosticList<'_>, file: &PointFile) -> Option<(String, PointLaw)> {
    let PointFile { point, materials, joints, .. } = file;
    let tag = |table: &Json| tag_of(PluginKind::InterfaceLaw, table).to_string();
    match (&point.material, &point.joint) {
        (Some(name), None) => {
            let table = materials.get(name)?;
            let material = read_plugin(diagnostics, &join("materials", name), table)?;
            Some((tag(table), material_law(diagnostics, material, &tag(table), point)?))
        }
        (None, Some(name)) => {
            let table = joints.get(name)?;
            let law = read_plugin(diagnostics, &join("joints", name), table)?;
            if point.plane.is_some() {
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

/// Returns a material, driven in space or in a plane.
fn material_law(
    diagnostics: &mut DiagnosticList<'_>,
    material: Box<dyn BulkMaterial>,
    tag: &str,
    point: &PointTable,
) -> Option<PointLaw> {
    let length = point.length.unwrap_or(1.0);
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
    let Some(plane) = point.plane else { return Some(PointLaw::Space(update, length)) };
    match PlanarUpdate::new(update, plane.into()) {
        Ok(planar) => Some(PointLaw::Plane(planar, length)),
        Err(failure) => {
            diagnostics.wrong("point.material", failure.to_string(), "check the parameters of the material");
            None
        }
    }
}

/// Returns a joint law that gives tractions from gaps, directly or by its facets with a stiffness.
fn joint_law(diagnostics: &mut DiagnosticList<'_>, law: Box<dyn InterfaceLaw>, tag: &str) -> Option<PointLaw> {
    if let Some(response) = law.response() {
        return Some(PointLaw::Joint(response));
    }
    let message = format!("interface law \"{tag}\" without stiffness gives no tractions from gaps");
    diagnostics.wrong("point.joint", message, "give the joint normal_stiffness and shear_stiffness");
    None
}

/// Returns the numbers of a table by their keys.
fn numbers(table: &impl Serialize) -> BTreeMap<String, f64> {
    serde_json::to_value(table).and_then(serde_json::from_value).unwrap_or_default()
}

fn read_segment(diagnostics: &mut DiagnosticList<'_>, law: &PointLaw, segment: &SegmentTable, at: &str) -> Segment {
    let names = law.names();
    let mut targets: Vec<Option<Control>> = vec![None; names.len()];
    let joint = matches!(law, PointLaw::Joint(_));
    let SegmentTable { steps, strain, stress, gap, traction } = segment;
    let tables = [
        ("strain", numbers(strain), false, true),
        ("stress", numbers(stress), false, false),
        ("gap", numbers(gap), true, true),
        ("traction", numbers(traction), true, false),
    ];
    for (table, given, of_joint, strain) in tables {
        for (name, value) in given {
            let place = join(&join(at, table), &name);
            if of_joint != joint {
                let help = if joint { "a joint has gap and traction" } else { "a material has strain and stress" };
                diagnostics.wrong(&place, "does not belong to what is driven", help);
                continue;
            }
            let Some(index) = names.iter().position(|known| *known == name) else {
                diagnostics.wrong(&place, "is not a component in a plane", suggest(&name, names, "components"));
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
    Segment { steps: *steps, targets }
}

fn read_plot(
    diagnostics: &mut DiagnosticList<'_>,
    law: &PointLaw,
    point: &PointTable,
    path: &[Segment],
) -> [String; 2] {
    let columns = columns(law);
    let bare: Vec<&str> = columns.iter().filter_map(|column| column.split(' ').next()).collect();
    if let Some(words) = point.plot.clone() {
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
