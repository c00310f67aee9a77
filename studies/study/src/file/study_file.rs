//! A study file with its axes: makes the cases.

use crate::config::check::Checker;
use crate::config::checked_keys::CheckedKeys;
use crate::config::common_keys::own_keys;
use crate::config::diagnostic::{LocatedDiagnostic, sort};
use crate::config::document::Node;
use crate::config::dotted_key::segments;
use crate::config::expand::{Expanded, Expansion};
use crate::config::origin::Origin;
use crate::kind::kind;
use crate::side_by_side::in_order;
use crate::study::Outline;
use crate::study::StudyError;
use crate::study::case::{build_case, shared_key};
use crate::study::diagnostics::located;
use crate::study::keys::{RECORD, kind_tables, tables_apart};
use crate::study::source::{FILE_NAME, no_file_name};
use crate::study::study_keys;
use crate::study::tables::WriterKeys;
use crate::study::{Case, Drawn, Output, Study};
use crate::study::{OutputKeys, RecordTable, VariantTable};
use crate::study::{StudySource, kind_of};
use serde_json::{Map, Value as Json};
use std::collections::HashMap;
use voussoir_core::plugin::{KeyValue, Parameter, Shape};

/// Greatest number of cases of a study for which path proofs are written by default.
const MOST_WITH_PATH_PROOFS: usize = 20;
/// Greatest number of numbers in the states of a path for which its proof is written by default: 4 MB.
const SMALL_PATH_PROOF: usize = 200_000;
/// Greatest number of different mistakes reported.
const MAX_MISTAKES: usize = 100;
/// Number of cases that are made before they are passed on.
const AT_ONCE: usize = 64;
/// Greatest number of cases of a study that a command keeps in memory. The cases of a larger study are made one at a time
/// when they are needed.
pub const HELD: usize = 1000;
/// Greatest number of different notes of a study that are kept.
const MAX_NOTES: usize = 100;

/// A study file with a scene: variants, scenes and axes are read; no case is made yet.
#[derive(Debug)]
pub struct StudyFile {
    root: Node,
    expansion: Expansion,
    checked: CheckedKeys,
    outline: Outline,
    record: Option<RecordTable>,
    /// Mistakes so far.
    diagnostics: Vec<LocatedDiagnostic>,
}

impl StudyFile {
    /// Reads the axes of a source. Mistakes that do not affect the axes are reported with the mistakes of the cases.
    pub fn read(source: StudySource) -> Result<Self, StudyError> {
        let StudySource { root, sets, mut diagnostics } = source;
        if kind(kind_of(&root)).is_some_and(|kind| kind.file_keys().is_some()) {
            let message = format!("\"{}\" has no scene to solve", kind_of(&root));
            let wrong = LocatedDiagnostic::new(&root.place("kind"), "kind", message);
            diagnostics.push(wrong.help("run it by `voussoir run STUDY.toml`"));
            return Err(diagnostics.into());
        }
        check_variants(&root, &mut diagnostics);
        let before = diagnostics.len();
        let table = kind_table(&root, &mut diagnostics);
        let table_is_fine = diagnostics.len() == before;
        let record = record(&root, &mut diagnostics);
        let expansion = match Expansion::new(&root, tables_apart(), study_keys()) {
            Ok(expansion) => expansion,
            Err(wrong) => {
                diagnostics.extend(wrong);
                sort(&mut diagnostics);
                return Err(diagnostics.into());
            }
        };
        check_sets(&sets, &expansion, &mut diagnostics);
        if expansion.changes(RECORD) {
            let message = "is the same for all cases; a sweep or a variant cannot change it";
            let swept = expansion.swept().any(|key| segments(key).first().is_some_and(|first| first == RECORD));
            let table = if swept { "sweep" } else { "variants" };
            diagnostics.push(LocatedDiagnostic::new(&root.place(table), RECORD, message));
        }
        let outline =
            Outline { variants: expansion.variants(), scenes: expansion.scenes(), axes: expansion.axes(), table };
        // If the table has mistakes, its content is not checked further.
        if table_is_fine {
            check_outline(&root, &outline, &mut diagnostics);
        }
        Ok(StudyFile { root, expansion, checked: CheckedKeys::default(), outline, record, diagnostics })
    }

    /// Returns the number of cases.
    pub fn count(&self) -> usize {
        self.expansion.count()
    }

    /// Returns the study with all its cases. The error contains all mistakes.
    pub fn study(self) -> Result<Study, StudyError> {
        self.made(usize::MAX)
    }

    /// Returns the study. Each case is made once, so that the error contains all mistakes; the cases are kept if there are few.
    pub fn study_in_turn(self) -> Result<Study, StudyError> {
        self.made(HELD)
    }

    /// Makes each case once. Keeps all cases if there are at most `most`, otherwise none.
    fn made(mut self, most: usize) -> Result<Study, StudyError> {
        let (mut cases, mut first, mut notes) = (Vec::new(), None, Vec::new());
        let count = self.expansion.count();
        make_cases(&self.expansion, &self.checked, &mut self.diagnostics, |mut case| {
            for note in &case.notes {
                if notes.len() < MAX_NOTES && !notes.contains(note) {
                    notes.push(note.clone());
                }
            }
            if count <= MOST_WITH_PATH_PROOFS
                && case.output_fields
                && case.resolved.at("output.path_proofs").is_none_or(Json::is_null)
            {
                case.output_path_proofs = SMALL_PATH_PROOF;
            }
            if count <= most {
                cases.push(case);
            } else {
                first.get_or_insert(case);
            }
        });
        let study = self.study_of(cases.first().or(first.as_ref()))?;
        Ok(Study { cases, notes, ..study })
    }

    /// Returns the study; only the first case is made. The caller must know that [`StudyFile::study_in_turn`] accepts the study.
    pub fn study_unchecked(mut self) -> Result<Study, StudyError> {
        let first = self.expansion.case(0).and_then(|expanded| build_case(0, expanded, &|_| None));
        let first = first.map_err(|wrong| self.diagnostics.extend(wrong)).ok();
        self.study_of(first.as_ref())
    }

    /// Returns the part of the study that does not depend on cases other than the first, or all mistakes.
    fn study_of(mut self, first: Option<&Case>) -> Result<Study, StudyError> {
        if !self.diagnostics.is_empty() {
            sort(&mut self.diagnostics);
            return Err(self.diagnostics.into());
        }
        let first = first.map(|case| &case.resolved);
        // A sweep or a variant may have changed the name.
        if let Some(why) = first.and_then(|case| case.read::<String>("name")).as_deref().and_then(no_file_name) {
            return Err(vec![LocatedDiagnostic::new(&self.root.place("name"), "name", why).help(FILE_NAME)].into());
        }
        let text_of = |name: &str| first.and_then(|case| case.read::<String>(name)).unwrap_or_default();
        Ok(Study {
            name: text_of("name"),
            kind: text_of("kind"),
            outline: self.outline,
            record: self.record,
            output: first.and_then(|case| output(case.get("output")?, self.expansion.count())).unwrap_or_default(),
            cases: Vec::new(),
            notes: Vec::new(),
            resolved: self.root.to_toml(),
            expansion: self.expansion,
            checked: self.checked,
        })
    }
}

/// Returns the output settings, from the checked table `[output]`.
fn output(table: &Json, cases: usize) -> Option<Output> {
    let OutputKeys { curve, figures, animation, vtu, path_proofs, .. } = own_keys(table)?;
    let WriterKeys { writers, options } = own_keys(table)?;
    Some(Output { curve, figures: Drawn::of(figures, cases), animation, vtu, path_proofs, writers, options })
}

/// Makes every case, in parallel if the caller does so, and passes them on in order. A mistake that several cases share is
/// reported once. It names the first of these cases if other cases do not have it.
fn make_cases(
    expansion: &Expansion,
    checked: &CheckedKeys,
    diagnostics: &mut Vec<LocatedDiagnostic>,
    mut take: impl FnMut(Case),
) {
    let count = expansion.count();
    let mut times: HashMap<LocatedDiagnostic, usize> = HashMap::new();
    let mut order: Vec<(LocatedDiagnostic, String)> = Vec::new();
    let known = |name: &str| if count > 1 { shared_key(checked, expansion, name) } else { None };
    let one = |id: &usize| expansion.case(*id).and_then(|expanded| build_case(*id, expanded, &known));
    // Cases are made in chunks to bound the memory: a study may have a million cases.
    let chunks = (0..count).step_by(AT_ONCE).map(|from| (from..count.min(from + AT_ONCE)).collect::<Vec<_>>());
    let made = chunks.flat_map(|ids| in_order(&ids, one));
    for (id, result) in made.enumerate() {
        match result {
            Ok(case) => take(case),
            Err(wrong) => {
                let label = expansion.case(id).map(|expanded| describe_case(&expanded)).unwrap_or_default();
                for diagnostic in wrong {
                    let times = times.entry(diagnostic.clone()).or_insert(0);
                    if *times == 0 {
                        order.push((diagnostic, label.clone()));
                    }
                    *times += 1;
                }
            }
        }
        if order.len() > MAX_MISTAKES {
            break;
        }
    }
    diagnostics.extend(order.into_iter().map(|(mut diagnostic, label)| {
        if times[&diagnostic] < count && !label.is_empty() {
            diagnostic.case = Some(label);
        }
        diagnostic
    }));
}

fn check_variants(root: &Node, diagnostics: &mut Vec<LocatedDiagnostic>) {
    let Some(variants) = root.table().and_then(|table| table.get("variants")) else {
        return;
    };
    let mut checker = Checker::new(root);
    checker.check(variants, &Shape::List { of: &VariantTable::SHAPE, min: 0, max: usize::MAX }, "variants");
    diagnostics.append(&mut checker.diagnostics);
}

/// Reports swept keys that are also set on the command line.
fn check_sets(sets: &[(String, String)], expansion: &Expansion, diagnostics: &mut Vec<LocatedDiagnostic>) {
    for (path, _) in sets.iter().filter(|(path, _)| expansion.swept().any(|swept| swept == path)) {
        let message = "is swept, so setting it has no effect";
        let help = format!("change the axis instead: --set 'sweep.\"{path}\".list=[…]'");
        diagnostics.push(LocatedDiagnostic::new(&Origin::Set(path.as_str().into()), path, message).help(help));
    }
}

/// Returns the checked table of the study's kind; the table of another kind is a mistake.
fn kind_table(root: &Node, diagnostics: &mut Vec<LocatedDiagnostic>) -> Map<String, Json> {
    let (kind, tables, mut own) = (kind_of(root), kind_tables(), Map::new());
    let of_kinds = |parameter: &&Parameter| tables.contains(&parameter.name);
    for parameter in study_keys().iter().filter(of_kinds) {
        let name = parameter.name;
        let Some(node) = root.table().and_then(|table| table.get(name)) else { continue };
        let mut checker = Checker::new(root);
        let value = checker.check(node, &parameter.shape, name);
        diagnostics.append(&mut checker.diagnostics);
        if kind == name {
            own = value.as_ref().and_then(Json::as_object).cloned().unwrap_or_default();
        } else {
            let message = format!("is only read by kind = \"{name}\", but the kind is \"{kind}\"");
            let help = format!("write kind = \"{name}\", or remove this table");
            diagnostics.push(LocatedDiagnostic::new(&root.place(name), name, message).help(help));
        }
    }
    own
}

/// Returns the checked table of the people who sign the report.
fn record(root: &Node, diagnostics: &mut Vec<LocatedDiagnostic>) -> Option<RecordTable> {
    let node = root.table()?.get(RECORD)?;
    let mut checker = Checker::new(root);
    let value = checker.check(node, &RecordTable::SHAPE, RECORD);
    diagnostics.append(&mut checker.diagnostics);
    own_keys(&value?)
}

/// Adds the mistakes that the study's kind finds in its axes and its table.
fn check_outline(root: &Node, outline: &Outline, diagnostics: &mut Vec<LocatedDiagnostic>) {
    let Some(kind) = kind(kind_of(root)) else { return };
    diagnostics.extend(kind.check(outline).into_iter().map(|wrong| located(root, wrong)));
}

fn describe_case(case: &Expanded) -> String {
    let variant = case.variant.iter().map(|name| format!("variant \"{name}\""));
    let scene = case.scene.iter().map(|name| format!("scene \"{name}\""));
    let swept = case.parameters.iter().map(|(key, value)| format!("{key} = {value}"));
    variant.chain(scene).chain(swept).collect::<Vec<_>>().join(", ")
}
