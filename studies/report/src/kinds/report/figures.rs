//! Charts and tables of series, and the images of a text.

use super::evaluate::evaluate;
use super::expression::Expression;
use super::parts::Parts;
use super::series::Selection;
use super::value::Value;
use crate::writers::page;
use maud::Markup;
use std::collections::BTreeMap;
use voussoir_core::plugin::Keys;
use voussoir_plot::chart::chart;
use voussoir_plot::series::{ChartStyle, Marker, Series, Spot};
use voussoir_study::results::format::format_short;

/// The table `[[report.charts]]`.
#[derive(Debug, Clone, Keys)]
pub struct Chart {
    /// name: the chart replaces !\[caption\](chart:NAME) in texts
    pub name: String,
    /// its heading
    pub title: String,
    /// words and unit of the abscissa
    pub x_label: String,
    /// words and unit of the ordinate
    pub y_label: String,
    /// names of series, one line each
    #[key(len = ">= 1, <= 20")]
    pub series: Vec<String>,
    /// logarithmic abscissa
    #[key(default = false)]
    pub x_log: bool,
    /// logarithmic ordinate
    #[key(default = false)]
    pub y_log: bool,
    /// mark where the kind of mechanism changes along a line
    #[key(default = false)]
    pub modes: bool,
    /// mark the greatest value of each line
    #[key(default = false)]
    pub peaks: bool,
}

/// The table `[[report.tables]]`.
#[derive(Debug, Clone, Keys)]
pub struct Table {
    /// name: the table replaces !\[caption\](table:NAME) in texts
    pub name: String,
    /// words and unit of the abscissa, the first column
    pub x_label: String,
    /// names of series, a column each
    #[key(len = ">= 1, <= 20")]
    pub series: Vec<String>,
}

/// The content of an image in a text.
#[derive(Debug, Clone, PartialEq)]
pub enum Image {
    /// A chart by name.
    Chart(String),
    /// A table by name.
    Table(String),
    /// The chart of a study.
    Study(String),
    /// `scene`, `mechanism` or `curve` of the case of a series at an abscissa.
    Case(String, String, f64),
}

impl Image {
    /// Parses the address of an image: `chart:NAME`, `table:NAME`, `study:NAME`, `mechanism:SERIES@x`.
    pub fn parse(place: &str) -> Option<Image> {
        let (what, name) = place.split_once(':')?;
        match what {
            "chart" => Some(Image::Chart(name.into())),
            "table" => Some(Image::Table(name.into())),
            "study" => Some(Image::Study(name.into())),
            "scene" | "mechanism" | "curve" => {
                let (series, x) = name.split_once('@')?;
                Some(Image::Case(what.into(), series.into(), x.parse().ok()?))
            }
            _ => None,
        }
    }
}

/// A series in the coordinates of charts: its points, and abscissas at which it has no bound.
struct Line {
    points: Vec<(f64, Value)>,
}

fn line(selection: &Selection, parts: &Parts) -> Line {
    let Value::Series(points) = selection.value(&|study| parts.json(study)) else { return Line { points: Vec::new() } };
    let [x_of, y_of] = [&selection.x, &selection.y].map(|text| Expression::parse(text));
    let (Ok(x_of), Ok(y_of)) = (x_of, y_of) else { return Line { points: Vec::new() } };
    let point = |(x, y): (f64, Value)| {
        let names = |name: &str| match name {
            "x" => Some(Value::Number(x)),
            "y" => Some(y.clone()),
            _ => None,
        };
        Some((evaluate(&x_of, &names).number()?, evaluate(&y_of, &names)))
    };
    Line { points: points.into_iter().filter_map(point).collect() }
}

impl Chart {
    /// Returns the chart as SVG.
    pub fn svg(&self, all: &BTreeMap<String, Selection>, parts: &Parts) -> String {
        let series = self.series.iter().filter_map(|name| Some((name, all.get(name)?)));
        let drawn: Vec<Series> = series.map(|(name, selection)| self.series(name, selection, parts)).collect();
        let style = ChartStyle { log: [self.x_log, self.y_log] };
        chart(&self.title, &self.x_label, &self.y_label, &drawn, &[], &style)
    }

    fn series(&self, name: &str, selection: &Selection, parts: &Parts) -> Series {
        let line = line(selection, parts);
        let mut points: Vec<(f64, f64)> = line.points.iter().filter_map(|(x, y)| Some((*x, y.number()?))).collect();
        let mut open_points: Vec<(f64, f64)> = points.iter().copied().filter(|(_, y)| y.is_infinite()).collect();
        points.retain(|(_, y)| y.is_finite());
        let path = selection.result == "curve";
        if !path {
            points.sort_by(|a, b| a.0.total_cmp(&b.0));
            open_points.sort_by(|a, b| a.0.total_cmp(&b.0));
        }
        let mut spots = Vec::new();
        // If loads are unbounded, there is no greatest load.
        if self.peaks
            && open_points.is_empty()
            && let Some(&top) = points.iter().max_by(|a, b| a.1.total_cmp(&b.1))
        {
            spots.push(Spot { at: top, kind: "greatest", marker: Marker::Ring, label: format_short(top.1, 4) });
        }
        if self.modes {
            spots.extend(self.changes(selection, parts, &points));
        }
        let name = selection.label.clone().unwrap_or_else(|| name.to_string());
        let dots = !path && selection.points.is_none();
        let all_points = selection.points.is_some();
        let spots = (path || !spots.is_empty()).then_some(spots);
        Series { name, points, open_points, spots, dots, unjoined: all_points, ..Series::default() }
    }

    /// Returns the changes of the kind of mechanism along a line: the first point of each new kind.
    fn changes(&self, selection: &Selection, parts: &Parts, points: &[(f64, f64)]) -> Vec<Spot> {
        let kinds = line(&Selection { result: "mechanism.kind".into(), y: "y".into(), ..selection.clone() }, parts);
        let mut kinds: Vec<(f64, String)> = kinds.points.iter().map(|(x, kind)| (*x, kind.describe())).collect();
        kinds.sort_by(|a, b| a.0.total_cmp(&b.0));
        let changed = kinds.windows(2).filter(|pair| pair[0].1 != pair[1].1);
        let spot = |pair: &[(f64, String)]| {
            let at = *points.iter().find(|(x, _)| *x == pair[1].0)?;
            Some(Spot { at, kind: "the mechanism changes", marker: Marker::Square, label: pair[1].1.clone() })
        };
        changed.filter_map(spot).collect()
    }
}

impl Table {
    /// The table as HTML.
    pub fn html(&self, all: &BTreeMap<String, Selection>, parts: &Parts) -> Markup {
        let columns: Vec<(String, Line)> = self
            .series
            .iter()
            .filter_map(|name| {
                let selection = all.get(name)?;
                Some((selection.label.clone().unwrap_or_else(|| name.clone()), line(selection, parts)))
            })
            .collect();
        let mut places: Vec<f64> = Vec::new();
        for (x, _) in columns.iter().flat_map(|(_, line)| &line.points) {
            if !places.iter().any(|place| (place - x).abs() <= 1e-9 * x.abs().max(1.0)) {
                places.push(*x);
            }
        }
        places.sort_by(f64::total_cmp);
        let mut header = vec![self.x_label.clone()];
        header.extend(columns.iter().map(|(name, _)| name.clone()));
        let rows = places.iter().map(|place| {
            let mut row = vec![format_short(*place, 7)];
            row.extend(columns.iter().map(|(_, line)| {
                let own = line.points.iter().find(|(x, _)| (place - x).abs() <= 1e-9 * x.abs().max(1.0));
                own.map_or(String::new(), |(_, value)| value.describe())
            }));
            row
        });
        page::table(&header, rows)
    }
}
