//! The columns of the table of results. CSV, Parquet, the terminal, the report and Python use this list.

use serde_json::Value as Json;
use voussoir_core::certificate::ContactMode;
use voussoir_core::plugin::OutputOf;
use voussoir_study::results::format::{continuation_word, format_value, kind_word, status_word};
use voussoir_study::results::{CaseResult, OutputColumn};
use voussoir_study::study::SweptKeys;

/// Greatest number of characters of a number without a power of ten.
const MAX_PLAIN: usize = 20;

/// One value of a row; the value may be missing.
#[derive(Debug, Clone, PartialEq)]
pub enum Cell {
    /// UTF-8.
    Text(Option<String>),
    /// A double with all its bits.
    Number(Option<f64>),
    /// An integer.
    Whole(Option<i64>),
    /// True or false.
    Truth(Option<bool>),
}

/// The type of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CellKind {
    /// UTF-8.
    Text,
    /// A double.
    Number,
    /// An integer.
    Whole,
    /// True or false.
    Truth,
}

impl Cell {
    /// The type of a column for this cell.
    pub fn kind(&self) -> CellKind {
        match self {
            Cell::Text(_) => CellKind::Text,
            Cell::Number(_) => CellKind::Number,
            Cell::Whole(_) => CellKind::Whole,
            Cell::Truth(_) => CellKind::Truth,
        }
    }

    /// The text in a CSV file; empty without a value. Numbers keep every bit; a long number is written with a power of
    /// ten.
    pub fn text(&self) -> String {
        match self {
            Cell::Text(text) => text.clone(),
            Cell::Number(number) => number.map(|x| {
                let (plain, power) = (x.to_string(), format!("{x:e}"));
                if plain.len() > MAX_PLAIN { power } else { plain }
            }),
            Cell::Whole(count) => count.map(|count| count.to_string()),
            Cell::Truth(truth) => truth.map(|truth| truth.to_string()),
        }
        .unwrap_or_default()
    }
}

/// A swept value in a CSV file; numbers keep every bit.
pub fn swept_text(value: Option<&Json>) -> String {
    let text = |value: &Json| match value.as_f64() {
        Some(number) => Cell::Number(Some(number)).text(),
        None => format_value(value),
    };
    value.map(text).unwrap_or_default()
}

/// The cell of a case.
type Value = fn(&CaseResult) -> Cell;

/// A column of the table of results.
#[derive(Debug, Clone)]
pub struct Column {
    /// Its name in files.
    pub name: String,
    /// Its unit in files: `m`, or `-` for a pure number; `None` for texts, counts and truths.
    pub unit: Option<String>,
    /// Its title on pages, with the unit.
    pub title: String,
    /// The type of its cells.
    pub kind: CellKind,
    value: Source,
}

/// The source of the values of a column.
#[derive(Debug, Clone)]
enum Source {
    Swept(String),
    Field(Value),
    Output(OutputColumn),
}

/// The columns after those that identify a case: name, unit, value.
const FIELDS: [(&str, &str, Value); 22] = [
    ("status", "", |case| word(status_word(case.status))),
    ("load_factor", "-", |case| Cell::Number(case.load_factor)),
    ("first_limit_point", "-", |case| Cell::Number(case.path.first_limit_point)),
    ("continuation", "", |case| Cell::Text(case.path.continuation.map(|end| continuation_word(end).into()))),
    ("lower_bound", "-", |case| Cell::Number(case.bounds.and_then(|bounds| bounds[0]))),
    ("upper_bound", "-", |case| Cell::Number(case.bounds.and_then(|bounds| bounds[1]))),
    ("associated_load_factor", "-", |case| Cell::Number(case.non_associated.associated_load_factor)),
    ("reserve_factor", "-", |case| Cell::Number(case.carried.reserve.as_ref().and_then(|reserve| reserve.factor))),
    ("permissible_share_used", "-", |case| Cell::Number(case.carried.permissible.as_ref().map(|check| check.used))),
    ("permissible_holds", "", |case| Cell::Truth(case.carried.permissible.as_ref().and_then(|check| check.holds))),
    ("kind", "", |case| Cell::Text(case.mechanism.as_ref().map(|found| kind_word(found.kind).into()))),
    ("hinge_count", "", |case| count(case.mechanism.as_ref().map(|found| found.hinge_count))),
    ("hinge_joints", "", |case| {
        joints(case.mechanism.as_ref().map(|found| {
            let in_space = found.contacts_with(&[ContactMode::Hinge]);
            found.hinges.iter().map(|hinge| hinge.joint).chain(in_space).collect()
        }))
    }),
    ("sliding_joints", "", |case| {
        joints(case.mechanism.as_ref().map(|found| {
            let in_space = found.contacts_with(&[ContactMode::Sliding, ContactMode::Twisting]);
            found.sliding.iter().map(|slip| slip.joint).chain(in_space).collect()
        }))
    }),
    ("crushing_joints", "", |case| {
        joints(case.mechanism.as_ref().map(|found| {
            let in_space = found.contacts_with(&[ContactMode::Crushing]);
            found.crushing.iter().map(|crush| crush.joint).chain(in_space).collect()
        }))
    }),
    ("unique", "", |case| Cell::Truth(case.mechanism.as_ref().and_then(|found| found.unique))),
    ("flow_read_as", "", |case| Cell::Text(case.flow_read_as.clone())),
    ("certificate_passed", "", |case| Cell::Truth(Some(case.certificate.passed))),
    ("largest_residual", "-", |case| Cell::Number(case.certificate.residuals.values().copied().reduce(f64::max))),
    ("solver", "", |case| word(&case.solver)),
    ("seconds", "s", |case| Cell::Number(Some(case.seconds))),
    ("notes", "", |case| word(&case.notes.join(" | "))),
];

fn word(word: &str) -> Cell {
    Cell::Text(Some(word.to_string()).filter(|word| !word.is_empty()))
}

fn count(count: Option<usize>) -> Cell {
    Cell::Whole(count.and_then(|count| i64::try_from(count).ok()))
}

/// Joints, separated by blanks.
fn joints(list: Option<Vec<usize>>) -> Cell {
    let text = list.map(|list| list.iter().map(usize::to_string).collect::<Vec<_>>().join(" "));
    Cell::Text(text.filter(|text| !text.is_empty()))
}

impl Column {
    fn of_field(name: &str, unit: &str, value: Value) -> Self {
        let unit = Some(unit.to_string()).filter(|unit| !unit.is_empty());
        let kind = value(&CaseResult::empty()).kind();
        Column { name: name.into(), unit, title: name.replace('_', " "), kind, value: Source::Field(value) }
    }

    fn of_key(key: &str, keys: &SweptKeys) -> Self {
        let kind = if keys.is_number(key) { CellKind::Number } else { CellKind::Text };
        Column {
            name: key.into(),
            unit: keys.unit(key),
            title: keys.title(key),
            kind,
            value: Source::Swept(key.into()),
        }
    }

    fn of_output(output: &OutputColumn, all: &[OutputColumn]) -> Self {
        let name = output.name_among(all);
        let title = name.replace('_', " ");
        let value = Source::Output(output.clone());
        Column { name, unit: Some(output.unit.clone()), title, kind: CellKind::Number, value }
    }

    /// Its header in files: the name with the unit.
    pub fn header(&self) -> String {
        self.unit.as_ref().map_or(self.name.clone(), |unit| format!("{} [{unit}]", self.name))
    }

    /// The cell of a case.
    pub fn cell(&self, case: &CaseResult) -> Cell {
        match (&self.value, self.kind) {
            (Source::Field(value), _) => value(case),
            (Source::Output(output), _) => Cell::Number(output.value(&case.outputs, None)),
            (Source::Swept(key), CellKind::Number) => {
                Cell::Number(case.label.parameters.get(key).and_then(Json::as_f64))
            }
            (Source::Swept(key), _) => Cell::Text(case.label.parameters.get(key).map(format_value)),
        }
    }

    /// The cell of a case for readers: numbers are rounded.
    pub fn words(&self, case: &CaseResult) -> String {
        match &self.value {
            Source::Swept(key) => case.label.parameters.get(key).map(format_value).unwrap_or_default(),
            Source::Field(_) | Source::Output(_) => self.cell(case).text(),
        }
    }

    /// Returns true for the column of a swept key.
    pub fn is_swept(&self) -> bool {
        matches!(self.value, Source::Swept(_))
    }
}

/// The columns that identify cases. In tables for readers, variants and scenes have a column only if some case has one.
#[derive(Debug, Clone, Copy)]
pub struct Labels<'a> {
    /// Swept keys, outermost first.
    pub swept: &'a [String],
    /// Units and descriptions of the swept keys.
    pub keys: &'a SweptKeys,
    /// True if cases have variants, or the table is a file.
    pub variants: bool,
    /// True if the study compares scenes.
    pub scenes: bool,
    /// Outputs of plug-ins.
    pub outputs: &'a [OutputColumn],
}

impl Labels<'_> {
    /// The columns that identify cases.
    pub fn columns(&self) -> Vec<Column> {
        let own = |name: &str, value: Value| Column::of_field(name, "", value);
        let mut columns = vec![own("id", |case| count(Some(case.label.id)))];
        columns.extend(self.variants.then(|| own("variant", |case| Cell::Text(case.label.variant.clone()))));
        columns.extend(self.scenes.then(|| own("scene", |case| Cell::Text(case.label.scene.clone()))));
        columns.extend(self.swept.iter().map(|key| Column::of_key(key, self.keys)));
        columns
    }

    /// All columns of the table of results.
    pub fn with_results(&self) -> Vec<Column> {
        let fields = FIELDS.iter().map(|(name, unit, value)| Column::of_field(name, unit, *value));
        let of_case = self.outputs.iter().filter(|output| output.of == OutputOf::Case);
        let outputs = of_case.map(|output| Column::of_output(output, self.outputs));
        self.columns().into_iter().chain(fields).chain(outputs).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use voussoir_core::limit::Status;
    use voussoir_study::results::OutputEntry;
    use voussoir_study::results::carried::{PermissibleEntry, ReserveEntry, ReserveFlow};

    #[test]
    fn a_cell_without_a_value_has_the_kind_of_its_column() {
        let labels =
            Labels { swept: &["a.b".into()], keys: &SweptKeys::default(), variants: true, scenes: true, outputs: &[] };
        let mut case = CaseResult::stalled("a note");
        case.label.parameters.insert("a.b".into(), "-2 MPa".into());
        for column in labels.with_results() {
            assert_eq!(column.cell(&case).kind(), column.kind, "{}", column.name);
        }
        let names: Vec<String> = labels.with_results().iter().map(Column::header).collect();
        assert_eq!(names[..6], ["id", "variant", "scene", "a.b", "status", "load_factor [-]"]);
    }

    /// A load that is carried has the collapse factor of its loads and the permissible limit state in the table.
    #[test]
    fn the_reserve_and_the_permissible_limit_state_have_columns() {
        let mut case = CaseResult::stalled("a note");
        let (stage, flow) = ("live".to_string(), ReserveFlow::Associated);
        let (status, factor) = (Status::Collapse, Some(4.0));
        case.carried.reserve =
            Some(ReserveEntry { stage, target: 1.0, status, factor, bounds: Some([factor, factor]), flow });
        case.carried.permissible =
            Some(PermissibleEntry { rule: "rule".into(), share: 0.5, used: 0.25, holds: Some(true) });
        let labels = Labels { swept: &[], keys: &SweptKeys::default(), variants: false, scenes: false, outputs: &[] };
        let cell = |name: &str| {
            let columns = labels.with_results();
            columns.iter().find(|column| column.header() == name).map(|column| column.cell(&case).text())
        };
        assert_eq!(cell("reserve_factor [-]").as_deref(), Some("4"));
        assert_eq!(cell("permissible_share_used [-]").as_deref(), Some("0.25"));
        assert_eq!(cell("permissible_holds").as_deref(), Some("true"));
    }

    /// Outputs of the case have columns. If two plug-ins have an output of the same name, the tag is in front of it.
    #[test]
    fn outputs_of_the_case_have_columns() {
        let output = |plugin: &str, name: &str, of: OutputOf, value: Option<f64>| OutputEntry {
            plugin: plugin.into(),
            kind: "bulk_material".into(),
            name: name.into(),
            unit: "-".into(),
            of,
            places: Vec::new(),
            positions: Vec::new(),
            values: vec![value],
        };
        let mut case = CaseResult::stalled("a note");
        case.outputs = vec![
            output("a", "damage", OutputOf::Block, Some(1.0)),
            output("a", "worst", OutputOf::Case, Some(0.5)),
            output("b", "worst", OutputOf::Case, None),
            output("b", "damage", OutputOf::Case, Some(0.25)),
        ];
        let outputs: Vec<OutputColumn> = case.outputs.iter().map(OutputColumn::of).collect();
        let keys = SweptKeys::default();
        let labels = Labels { swept: &[], keys: &keys, variants: false, scenes: false, outputs: &outputs };
        let columns = labels.with_results();
        let last = columns[columns.len() - 3..].iter().map(|column| (column.header(), column.cell(&case).text()));
        let own = [("a.worst [-]", "0.5"), ("b.worst [-]", ""), ("damage [-]", "0.25")];
        assert_eq!(last.collect::<Vec<_>>(), own.map(|(name, value)| (name.to_string(), value.to_string())));
    }

    /// Every bit is kept in both notations.
    #[test]
    fn numbers_keep_every_bit() {
        for x in [0.1 + 0.2, 1e-300, -2e6, 1.0 / 3.0, 5e-324, 1e22, 0.0] {
            assert_eq!(Cell::Number(Some(x)).text().parse::<f64>().map(f64::to_bits), Ok(x.to_bits()));
        }
        assert_eq!([1.25e-19, -2e6, 2.99].map(|x| Cell::Number(Some(x)).text()), ["1.25e-19", "-2000000", "2.99"]);
    }
}
