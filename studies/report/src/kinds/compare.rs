//! `compare`: several laws and solvers on one or several scenes, in one table.
#![doc = include_str!("compare.md")]

use super::case_study::SceneStudy;
use voussoir_core::limit::Status;
use voussoir_core::plugin::{Card, Diagnostic, Keys, PluginKind, Sample};
use voussoir_study::config::diagnostic::suggest;
use voussoir_study::kind::{KindEntry, LoadedStudy, OwnResults, StudyKind};
use voussoir_study::results::{CaseResult, Comparison, ComparisonCell, ComparisonRow};
use voussoir_study::study::{Outline, Study, StudyError, StudySource, VariantTable};

struct Compare;

/// `[compare]`.
#[derive(Debug, Clone, Keys)]
pub(super) struct CompareTable {
    /// name of the variant that the others are divided by
    #[key(optional = "the first variant")]
    pub reference: Option<String>,
    /// \[\[compare.scenes\]\]: name and set, as in \[\[variants\]\]; a variant is set on top of each
    #[key(len = ">= 1", optional = "the study's own scene")]
    scenes: Option<Vec<VariantTable>>,
}

voussoir_core::inventory::submit! { KindEntry { tag: "compare", kind: &Compare } }

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::StudyKind,
        tag: "compare",
        summary: "several laws and solvers (variants) on one or several scenes: one table with ratios, one figure",
        samples: &[Sample::keys(r#"[[variants]]
name = "as it is"

[[variants]]
name = "smooth"
set = { "joints.dry.friction" = 0.45 }

[sweep]
"scene.profile.rise" = { list = [0.9, 1.0] }"#)],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("compare.md"),
        ..Card::of::<CompareTable>()
    }
}

/// Returns the mistakes that every kind that compares looks for: too few variants, and names (by key) of variants that do not
/// exist.
pub(super) fn check_variants(
    kind: &str,
    outline: &Outline,
    named: &[(&str, &Option<String>)],
    least: usize,
) -> Vec<Diagnostic> {
    let mut diagnostics = Vec::new();
    if outline.variants.len() < least {
        let message =
            format!("\"{kind}\" sets variants beside each other, but the study has {}", outline.variants.len());
        diagnostics.push(
            Diagnostic::new("kind", message)
                .help("give at least two [[variants]], each with a law or a solver of its own"),
        );
        return diagnostics;
    }
    for (key, name) in named {
        if let Some(name) = name
            && outline.variant(Some(name)).is_none()
        {
            let names: Vec<&str> = outline.variants.iter().map(String::as_str).collect();
            let message = format!("there is no variant \"{name}\"");
            diagnostics.push(Diagnostic::new(format!("{kind}.{key}"), message).help(suggest(name, &names, "variants")));
        }
    }
    diagnostics
}

/// Returns the comparison of the variants; `reference` is the index of the variant that the others are divided by.
pub(super) fn beside_each_other(study: &Study, cases: &[CaseResult], reference: usize) -> Option<Comparison> {
    // A study without variants is a single variant.
    let alone = [study.name.clone()];
    let variants = if study.outline.variants.is_empty() { &alone[..] } else { &study.outline.variants };
    let rows = study.count().checked_div(variants.len())?;
    let answered = |id: usize| cases.binary_search_by_key(&id, |case| case.label.id).ok().map(|place| &cases[place]);
    let row = |row: usize| {
        let base = answered(reference * rows + row).and_then(factor);
        let cell = |variant: usize| {
            let id = variant * rows + row;
            let case = answered(id);
            let ratio = case.and_then(factor).zip(base).and_then(|(own, base)| (base > 0.0).then(|| own / base));
            ComparisonCell {
                case: id,
                status: case.map(|case| case.status),
                load_factor: case.and_then(|case| case.load_factor),
                first_limit_point: case.and_then(|case| case.path.first_limit_point),
                bounds: case.and_then(|case| case.bounds),
                ratio,
                mechanism: case.and_then(|case| case.mechanism.as_ref()).map(|mechanism| mechanism.kind),
                flow_read_as: case.and_then(|case| case.flow_read_as.clone()),
            }
        };
        let first = study.label(row).unwrap_or_default();
        ComparisonRow {
            scene: first.scene,
            parameters: first.parameters,
            cells: (0..variants.len()).map(cell).collect(),
        }
    };
    Some(Comparison {
        reference: variants.get(reference)?.clone(),
        variants: variants.to_vec(),
        rows: (0..rows).map(row).collect(),
        map: None,
    })
}

/// Returns the load factor at which a case ended, by a mechanism or at a limit point.
fn factor(case: &CaseResult) -> Option<f64> {
    case.load_factor.filter(|_| matches!(case.status, Status::Collapse | Status::LimitPoint))
}

impl StudyKind for Compare {
    fn read(&self, source: StudySource) -> Result<Box<dyn LoadedStudy>, StudyError> {
        SceneStudy::read(source)
    }

    fn check(&self, outline: &Outline) -> Vec<Diagnostic> {
        let table = outline.read::<CompareTable>();
        check_variants("compare", outline, &[("reference", &table.and_then(|table| table.reference))], 2)
    }

    fn own_results(&self, study: &Study, cases: &[CaseResult]) -> OwnResults {
        let table = study.outline.read::<CompareTable>();
        let reference = study.outline.variant(table.and_then(|table| table.reference).as_ref());
        let comparison = beside_each_other(study, cases, reference.unwrap_or(0));
        OwnResults { comparison, ..OwnResults::default() }
    }
}
