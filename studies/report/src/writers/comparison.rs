//! `comparison.csv` and the figures of comparisons and maps.

use super::csv_table::csv_table;
use super::register::register;
use super::writer::Writer;
use crate::figures::comparison::{comparison_svg, open_bracket, remark, row_name};
use crate::figures::map::map_svg;
use crate::output::StudyOutput;
use crate::output::columns::swept_text;
use comfy_table::{CellAlignment, ContentArrangement, Table, presets};
use serde_json::Value as Json;
use voussoir_plot::svg::as_file;
use voussoir_study::results::format::{format_number, format_short, kind_word, snap_words, status_word};
use voussoir_study::results::{Comparison, ComparisonCell};
use voussoir_study::study::SweptKeys;

/// Writes `comparison.csv`, `figures/comparison.svg` and `figures/map.svg`.
#[derive(Debug)]
pub struct ComparisonFiles;

impl Writer for ComparisonFiles {
    fn files(&self, study: &StudyOutput, _options: &Json) -> Vec<(String, Vec<u8>)> {
        let Some(comparison) = &study.results.comparison else { return Vec::new() };
        let mut files = vec![("comparison.csv".to_string(), comparison_csv(comparison, &study.keys).into_bytes())];
        if study.output.figures.anything() {
            files.extend(
                figure(study, comparison)
                    .map(|(name, svg)| (format!("figures/{name}.svg"), as_file(&svg).into_bytes())),
            );
        }
        files
    }
}

/// Returns the figure of a comparison or of a map, with its name.
pub fn figure(study: &StudyOutput, comparison: &Comparison) -> Option<(&'static str, String)> {
    match comparison.map {
        Some(_) => Some(("map", map_svg(study.name, comparison)?)),
        None => Some(("comparison", comparison_svg(study.name, comparison, &study.keys)?)),
    }
}

fn swept(comparison: &Comparison) -> Vec<String> {
    comparison.rows.first().map(|row| row.parameters.keys().cloned().collect()).unwrap_or_default()
}

/// One row per scene and swept value; for each variant status, factor, first limit point, bounds, ratio and mechanism.
pub fn comparison_csv(comparison: &Comparison, meanings: &SweptKeys) -> String {
    let keys = swept(comparison);
    let mut header = vec!["scene".to_string()];
    header.extend(keys.iter().map(|key| meanings.column(key)));
    for variant in &comparison.variants {
        let columns = [
            "status".to_string(),
            "load_factor [-]".into(),
            "first_limit_point [-]".into(),
            "lower_bound [-]".into(),
            "upper_bound [-]".into(),
            format!("ratio to {} [-]", comparison.reference),
            "mechanism".into(),
            "case".into(),
        ];
        header.extend(columns.map(|column| format!("{variant}: {column}")));
    }
    let number = |x: Option<f64>| x.map_or(String::new(), |x| x.to_string());
    let rows = comparison.rows.iter().map(|row| {
        let mut cells = vec![row.scene.clone().unwrap_or_default()];
        cells.extend(keys.iter().map(|key| swept_text(row.parameters.get(key))));
        for cell in &row.cells {
            cells.extend([
                cell.status.map_or("not answered", status_word).to_string(),
                number(cell.load_factor),
                number(cell.first_limit_point),
                number(cell.bounds.and_then(|bounds| bounds[0])),
                number(cell.bounds.and_then(|bounds| bounds[1])),
                number(cell.ratio),
                cell.mechanism.map_or(String::new(), |kind| kind_word(kind).into()),
                cell.case.to_string(),
            ]);
        }
        cells
    });
    csv_table(header, rows)
}

/// A load factor with its qualification: `0.6389818`, `0.3558174 (≥ 0.351)`, `0.61 (limit point)`, `carries 23.1; snaps
/// from 1.37`.
fn factor(cell: &ComparisonCell) -> String {
    let words = remark(cell);
    let Some(factor) = cell.load_factor else { return words };
    let proved = open_bracket(cell).map(|[low, _]| format!("≥ {}", format_short(low, 4)));
    let said: Vec<String> = Some(words).filter(|words| !words.is_empty()).into_iter().chain(proved).collect();
    let digits = |x: f64| format_number(x, 7);
    let number = snap_words(Some(factor), cell.first_limit_point, digits).unwrap_or_else(|| digits(factor));
    if said.is_empty() { number } else { format!("{number} ({})", said.join(", ")) }
}

/// Header and rows: factors of all variants, then ratios of all variants except the reference.
pub fn comparison_rows(comparison: &Comparison, keys: &SweptKeys) -> (Vec<String>, Vec<Vec<String>>) {
    let mut header = vec![if comparison.rows.iter().any(|row| row.scene.is_some()) { "scene" } else { "" }.to_string()];
    header.extend(comparison.variants.iter().cloned());
    let others: Vec<usize> =
        (0..comparison.variants.len()).filter(|&i| comparison.variants[i] != comparison.reference).collect();
    header.extend(others.iter().map(|&i| format!("{} / {}", comparison.variants[i], comparison.reference)));
    let rows = comparison.rows.iter().map(|row| {
        let mut cells = vec![row_name(row, keys)];
        cells.extend(row.cells.iter().map(factor));
        cells.extend(others.iter().map(|&i| row.cells[i].ratio.map_or("–".into(), |ratio| format!("{ratio:.4}"))));
        cells
    });
    let rows = rows.collect();
    (header, rows)
}

/// The table that is printed on the terminal.
pub fn comparison_table(comparison: &Comparison, keys: &SweptKeys) -> String {
    let (header, rows) = comparison_rows(comparison, keys);
    let mut table = Table::new();
    table.load_style(presets::NOTHING).set_content_arrangement(ContentArrangement::Disabled).set_header(header);
    for row in rows {
        table.add_row(row);
    }
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    let lines: String = table.to_string().lines().map(|line| line.trim_end().to_string() + "\n").collect();
    format!(
        "\nload factors (≥: proved least, where it is not the load found), and ratios to \"{}\"\n{lines}",
        comparison.reference
    )
}

register!(
    "comparison",
    ComparisonFiles,
    "comparison.csv and its figure: variants beside each other, with ratios (kinds compare and map)",
    "# `comparison`\n\nWrites `comparison.csv`, one row for each scene and swept value, eight columns for each variant, and \
     `figures/comparison.svg` or `figures/map.svg`.\n"
);
