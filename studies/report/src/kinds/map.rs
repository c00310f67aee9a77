//! `map`: several laws and solvers over two swept numbers.
#![doc = include_str!("map.md")]

use super::case_study::SceneStudy;
use super::compare::{CompareTable, beside_each_other, check_variants};
use voussoir_core::plugin::{Card, Diagnostic, Keys, PluginKind, Sample};
use voussoir_study::kind::{KindEntry, LoadedStudy, OwnResults, StudyKind};
use voussoir_study::results::{CaseResult, Comparison, MapAxes};
use voussoir_study::study::{Outline, Study, StudyError, StudySource};

struct Map;

/// `[map]`.
#[derive(Debug, Clone, Keys)]
struct MapTable {
    #[key(like = CompareTable)]
    reference: Option<String>,
    /// name of the variant whose load, divided by the load of the reference, is drawn as contours
    #[key(optional = "the first that is not the reference")]
    contours: Option<String>,
    /// name of the variant whose kinds of mechanism are coloured
    #[key(optional = "the reference")]
    regions: Option<String>,
    /// name of the first axis of the sweep in the figure
    #[key(optional = "its key in words")]
    x_label: Option<String>,
    /// name of the second axis of the sweep in the figure
    #[key(optional = "its key in words")]
    y_label: Option<String>,
}

voussoir_core::inventory::submit! { KindEntry { tag: "map", kind: &Map } }

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::StudyKind,
        tag: "map",
        summary: "one or several laws (variants) over two swept numbers: regions of mechanisms, contours of loads or ratios",
        samples: &[Sample::keys(r#"[[variants]]
name = "as it is"

[[variants]]
name = "smooth"
set = { "joints.dry.friction" = 0.45 }

[sweep]
"scene.profile.rise" = { list = [0.9, 1.0] }
"scene.thickness" = { list = [0.4, 0.5] }"#)],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("map.md"),
        ..Card::of::<MapTable>()
    }
}

/// Returns the different values of a key in the order of the cases; `None` unless all are numbers.
fn values(study: &Study, key: &str) -> Option<Vec<f64>> {
    let mut found: Vec<f64> = Vec::new();
    for value in study.values(key) {
        let value = value.as_f64()?;
        if !found.contains(&value) {
            found.push(value);
        }
    }
    Some(found)
}

impl StudyKind for Map {
    fn read(&self, source: StudySource) -> Result<Box<dyn LoadedStudy>, StudyError> {
        SceneStudy::read(source)
    }

    fn check(&self, outline: &Outline) -> Vec<Diagnostic> {
        let table = outline.read().unwrap_or_else(MapTable::defaults);
        let named = [("reference", &table.reference), ("contours", &table.contours), ("regions", &table.regions)];
        let mut diagnostics = check_variants("map", outline, &named, 0);
        if outline.axes.len() != 2 {
            let message = format!("\"map\" needs two axes, but [sweep] has {}", outline.axes.len());
            diagnostics
                .push(Diagnostic::new("kind", message).help("the first axis is drawn along x, the second along y"));
        }
        for (keys, _) in outline.axes.iter().filter(|(_, numbers)| !numbers) {
            let key = keys.first().map_or("", String::as_str);
            let path = format!("sweep.\"{key}\"");
            diagnostics.push(
                Diagnostic::new(path, "takes texts, which are no coordinates").help("sweep a number without a unit"),
            );
        }
        diagnostics
    }

    fn own_results(&self, study: &Study, cases: &[CaseResult]) -> OwnResults {
        OwnResults { comparison: map_of(study, cases), ..OwnResults::default() }
    }
}

/// Returns the comparison of the variants over the two axes.
fn map_of(study: &Study, cases: &[CaseResult]) -> Option<Comparison> {
    let outline = &study.outline;
    let table = outline.read().unwrap_or_else(MapTable::defaults);
    let reference = outline.variant(table.reference.as_ref()).unwrap_or(0);
    // For a single law, loads are drawn instead of ratios.
    let other = if outline.variants.len() < 2 { 0 } else { usize::from(reference == 0) };
    let mut comparison = beside_each_other(study, cases, reference)?;
    let [x, y] = [0, 1].map(|axis| outline.axes.get(axis).and_then(|(keys, _)| keys.first()).cloned());
    let (x, y) = (x?, y?);
    let keys = study.swept_keys();
    let label = |given: Option<String>, key: &str| given.unwrap_or_else(|| keys.title(key));
    let names = comparison.variants.clone();
    let name =
        |given: Option<String>, otherwise: usize| names[outline.variant(given.as_ref()).unwrap_or(otherwise)].clone();
    if let (Some(x_values), Some(y_values)) = (values(study, &x), values(study, &y)) {
        comparison.map = Some(MapAxes {
            x_label: label(table.x_label, &x),
            y_label: label(table.y_label, &y),
            contours: name(table.contours, other),
            regions: name(table.regions, reference),
            x,
            x_values,
            y,
            y_values,
        });
    }
    Some(comparison)
}
