//! Outputs of plug-ins: quantities beyond forces and displacements that a law or a solver computes at the end of a case.

use super::schema::PluginKind;
use serde::{Deserialize, Serialize};

/// The things that an output has one value for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum OutputOf {
    /// Each contact point of a joint, or each stress point of a block.
    Point,
    /// Each joint.
    Joint,
    /// Each block.
    Block,
    /// The whole case.
    Case,
}

impl OutputOf {
    /// Returns the word that results contain.
    pub const fn word(self) -> &'static str {
        match self {
            OutputOf::Point => "point",
            OutputOf::Joint => "joint",
            OutputOf::Block => "block",
            OutputOf::Case => "case",
        }
    }
}

/// The rule that computes the value of a joint, a block or a case from the values of its points.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum OutputRule {
    /// The greatest value.
    Greatest,
    /// The least value.
    Least,
    /// The mean, weighted with the lengths of joints or the areas of blocks that the points represent.
    Mean,
    /// The sum of value × length \[m\] over the points of joints, or of value × area \[m²\] over the points of blocks.
    Integral,
}

impl OutputRule {
    /// Returns the value for pairs of size (length or area) and value; NaN if there are no points or a value is NaN.
    pub fn of(self, points: impl IntoIterator<Item = (f64, f64)>) -> f64 {
        let (mut total, mut sum, mut ends) = (0.0, 0.0, [f64::INFINITY, f64::NEG_INFINITY]);
        let mut count = 0;
        for (size, value) in points {
            if value.is_nan() {
                return f64::NAN;
            }
            (total, sum) = (total + size, sum + size * value);
            ends = [ends[0].min(value), ends[1].max(value)];
            count += 1;
        }
        match self {
            _ if count == 0 => f64::NAN,
            OutputRule::Greatest => ends[1],
            OutputRule::Least => ends[0],
            OutputRule::Mean => sum / total,
            OutputRule::Integral => sum,
        }
    }
}

/// A quantity that a plug-in computes at the end of a case. A law computes its outputs of points; outputs of joints, blocks
/// and the case follow from them by a rule. A solver computes outputs of the case.
///
/// ```
/// use voussoir_core::plugin::Output;
///
/// const OUTPUTS: &[Output] = &[
///     Output::point("open", "-", "1 if the point is open, otherwise 0"),
///     Output::joint("crack_length", "m", "length of the open part").integral("open"),
/// ];
/// # assert_eq!(OUTPUTS[1].from.map(|from| from.0), Some("open"));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct Output {
    /// Its name in results: lower-case letters, digits and `_`.
    pub name: &'static str,
    /// Its SI unit, such as `"Pa"`; `"-"` for a pure number.
    pub unit: &'static str,
    /// Its meaning in one line.
    pub doc: &'static str,
    /// The things that it has one value for.
    pub of: OutputOf,
    /// The name of the output of points that it follows from, with the rule.
    pub from: Option<(&'static str, OutputRule)>,
}

impl Output {
    /// An output of each contact point of a joint, or of each stress point of a block.
    pub const fn point(name: &'static str, unit: &'static str, doc: &'static str) -> Self {
        Output { name, unit, doc, of: OutputOf::Point, from: None }
    }

    /// An output of each joint; add a rule.
    pub const fn joint(name: &'static str, unit: &'static str, doc: &'static str) -> Self {
        Output { name, unit, doc, of: OutputOf::Joint, from: None }
    }

    /// An output of each block; add a rule.
    pub const fn block(name: &'static str, unit: &'static str, doc: &'static str) -> Self {
        Output { name, unit, doc, of: OutputOf::Block, from: None }
    }

    /// An output of the case. For a law, add a rule; a solver computes the value.
    pub const fn case(name: &'static str, unit: &'static str, doc: &'static str) -> Self {
        Output { name, unit, doc, of: OutputOf::Case, from: None }
    }

    /// The greatest value of an output of points.
    pub const fn greatest(self, point: &'static str) -> Self {
        Output { from: Some((point, OutputRule::Greatest)), ..self }
    }

    /// The least value of an output of points.
    pub const fn least(self, point: &'static str) -> Self {
        Output { from: Some((point, OutputRule::Least)), ..self }
    }

    /// The mean of an output of points over the length of joints or the area of blocks.
    pub const fn mean(self, point: &'static str) -> Self {
        Output { from: Some((point, OutputRule::Mean)), ..self }
    }

    /// The integral of an output of points over the length of joints \[m\] or the area of blocks \[m²\].
    pub const fn integral(self, point: &'static str) -> Self {
        Output { from: Some((point, OutputRule::Integral)), ..self }
    }
}

/// Names of columns and arrays that result files have without plug-ins. An output has another name.
pub const FIXED_COLUMNS: &[&str] = &[
    "id",
    "variant",
    "scene",
    "status",
    "load_factor",
    "first_limit_point",
    "continuation",
    "lower_bound",
    "upper_bound",
    "associated_load_factor",
    "reserve_factor",
    "permissible_share_used",
    "permissible_holds",
    "kind",
    "hinge_count",
    "hinge_joints",
    "sliding_joints",
    "crushing_joints",
    "unique",
    "flow_read_as",
    "certificate_passed",
    "largest_residual",
    "solver",
    "seconds",
    "notes",
    "joint",
    "minus",
    "plus",
    "normal",
    "shear",
    "moment",
    "eccentricity",
    "contact_length",
    "greatest_stress",
    "block_length",
    "block_stress",
    "strength",
    "sliding_reserve",
    "zone_least",
    "zone_greatest",
    "plugin",
    "block",
    "point",
    "x",
    "y",
    "displacement",
    "stress",
    "deformable",
    "output",
    "unit",
    "of",
    "value",
];

/// Units of outputs and of states of laws, as powers of m, Pa, s and K.
const UNITS: &[(&str, [i32; 4])] = &[
    ("-", [0, 0, 0, 0]),
    ("deg", [0, 0, 0, 0]),
    ("rad", [0, 0, 0, 0]),
    ("m", [1, 0, 0, 0]),
    ("m2", [2, 0, 0, 0]),
    ("m3", [3, 0, 0, 0]),
    ("1/m", [-1, 0, 0, 0]),
    ("N", [2, 1, 0, 0]),
    ("N/m", [1, 1, 0, 0]),
    ("N m", [3, 1, 0, 0]),
    ("Pa", [0, 1, 0, 0]),
    ("Pa/m", [-1, 1, 0, 0]),
    ("Pa m", [1, 1, 0, 0]),
    ("Pa s", [0, 1, 1, 0]),
    ("J", [3, 1, 0, 0]),
    ("J/m", [2, 1, 0, 0]),
    ("J/m2", [1, 1, 0, 0]),
    ("J/m3", [0, 1, 0, 0]),
    ("s", [0, 0, 1, 0]),
    ("1/s", [0, 0, -1, 0]),
    ("m/s", [1, 0, -1, 0]),
    ("K", [0, 0, 0, 1]),
];

/// Returns a unit of an output or of a state as powers of m, Pa, s and K; `None` if it is unknown.
pub fn unit_powers(unit: &str) -> Option<[i32; 4]> {
    UNITS.iter().find(|(name, _)| *name == unit).map(|(_, powers)| *powers)
}

/// Returns the mistakes in the outputs of a plug-in: the name of the output and the mistake.
pub(super) fn mistakes(kind: PluginKind, outputs: &[Output]) -> Vec<(&'static str, String)> {
    let mut wrong = Vec::new();
    for (index, output) in outputs.iter().enumerate() {
        let mut says = |what: String| wrong.push((output.name, what));
        if outputs[..index].iter().any(|other| other.name == output.name) {
            says("is declared twice".into());
        }
        let letter = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
        if !output.name.starts_with(|c: char| c.is_ascii_lowercase()) || !output.name.chars().all(letter) {
            says("must have a name of lower-case letters, digits and _".into());
        }
        if FIXED_COLUMNS.contains(&output.name) {
            says("has the name of a column that result files always have".into());
        }
        if unit_powers(output.unit).is_none() {
            let known: Vec<&str> = UNITS.iter().map(|(name, _)| *name).collect();
            says(format!("has the unknown unit \"{}\"; units: {}", output.unit, known.join(", ")));
        }
        if let Some(why) = misplaced(kind, outputs, output) {
            says(why);
        }
    }
    wrong
}

/// Returns the reason why a plug-in of this kind cannot have an output, or why its rule does not fit.
fn misplaced(kind: PluginKind, outputs: &[Output], output: &Output) -> Option<String> {
    // The points of joints represent lengths, the points of blocks represent areas.
    let dimension = match kind {
        PluginKind::InterfaceLaw => 1,
        PluginKind::BulkMaterial => 2,
        PluginKind::LimitSolver | PluginKind::PathSolver => {
            let fits = output.of == OutputOf::Case && output.from.is_none();
            return (!fits).then(|| "must be an output of the case without a rule: a solver computes its value".into());
        }
        kind => return Some(format!("is not possible: a {} has no outputs", kind.describe())),
    };
    match (kind, output.of) {
        (PluginKind::InterfaceLaw, OutputOf::Block) => return Some("is of blocks, but the law is of joints".into()),
        (PluginKind::BulkMaterial, OutputOf::Joint) => return Some("is of joints, but the law is of blocks".into()),
        _ => {}
    }
    let Some((name, rule)) = output.from else {
        return (output.of != OutputOf::Point)
            .then(|| format!("needs a rule, such as `.greatest(…)`: it is of the {}", output.of.word()));
    };
    if output.of == OutputOf::Point {
        return Some("is of points and must not have a rule: the law computes it".into());
    }
    let Some(source) = outputs.iter().find(|other| other.of == OutputOf::Point && other.name == name) else {
        return Some(format!("follows from \"{name}\", but the card has no such output of points"));
    };
    let mut powers = unit_powers(source.unit)?;
    powers[0] += if rule == OutputRule::Integral { dimension } else { 0 };
    let fits = unit_powers(output.unit).is_none_or(|own| own == powers);
    (!fits).then(|| {
        format!("has the unit {}, which does not follow from that of \"{name}\", {}", output.unit, source.unit)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(kind: PluginKind, outputs: &[Output]) -> Vec<String> {
        mistakes(kind, outputs).into_iter().map(|(_, what)| what).collect()
    }

    #[test]
    fn rules_weight_points_with_their_size() {
        let points = [(1.0, 2.0), (3.0, -1.0)];
        assert_eq!(OutputRule::Greatest.of(points), 2.0);
        assert_eq!(OutputRule::Least.of(points), -1.0);
        assert_eq!(OutputRule::Mean.of(points), -0.25);
        assert_eq!(OutputRule::Integral.of(points), -1.0);
        for rule in [OutputRule::Greatest, OutputRule::Least, OutputRule::Mean, OutputRule::Integral] {
            assert!(rule.of([]).is_nan() && rule.of([(1.0, f64::NAN), (1.0, 0.0)]).is_nan(), "{rule:?}");
        }
    }

    #[test]
    fn a_law_may_have_outputs_of_points_joints_and_the_case() {
        const OUTPUTS: &[Output] = &[
            Output::point("open", "-", "1 if the point is open"),
            Output::joint("crack_length", "m", "length of the open part").integral("open"),
            Output::case("total_crack_length", "m", "length of all open parts").integral("open"),
            Output::case("open_share", "-", "open share of all joints").mean("open"),
        ];
        assert_eq!(found(PluginKind::InterfaceLaw, OUTPUTS), Vec::<String>::new());
        assert_eq!(found(PluginKind::PathSolver, &[Output::case("work_of_water", "J", "work")]), Vec::<String>::new());
    }

    #[test]
    fn a_mistake_in_an_output_is_named() {
        let one = |kind, outputs: &[Output]| {
            let found = found(kind, outputs);
            assert_eq!(found.len(), 1, "{found:?}");
            found[0].clone()
        };
        let law = PluginKind::InterfaceLaw;
        let says = |text: String, what: &str| assert!(text.ends_with(what), "{text}");
        says(one(law, &[Output::point("a", "-", ""), Output::point("a", "m", "")]), "is declared twice");
        says(one(law, &[Output::point("a b", "-", "")]), "must have a name of lower-case letters, digits and _");
        says(one(law, &[Output::point("shear", "N", "")]), "has the name of a column that result files always have");
        assert!(
            one(law, &[Output::point("a", "MPa", "")]).starts_with("has the unknown unit \"MPa\"; units: -, deg, ")
        );
        says(one(law, &[Output::joint("a", "m", "")]), "needs a rule, such as `.greatest(…)`: it is of the joint");
        says(one(law, &[Output::joint("a", "m", "").least("b")]), "\"b\", but the card has no such output of points");
        says(one(law, &[Output::point("a", "m", "").least("a")]), "must not have a rule: the law computes it");
        says(
            one(law, &[Output::point("a", "-", ""), Output::joint("b", "m2", "").integral("a")]),
            "has the unit m2, which does not follow from that of \"a\", -",
        );
        says(
            one(law, &[Output::point("a", "-", ""), Output::block("b", "-", "").least("a")]),
            "is of blocks, but the law is of joints",
        );
        says(
            one(PluginKind::LimitSolver, &[Output::point("a", "-", "")]),
            "must be an output of the case without a rule: a solver computes its value",
        );
        says(one(PluginKind::Writer, &[Output::case("a", "-", "")]), "is not possible: a writer has no outputs");
    }
}
