//! What charts are made of: lines, marked places, and how their axes run.

/// One line of a chart.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Series {
    /// For the legend.
    pub name: String,
    /// By growing abscissa, or along a path.
    pub points: Vec<(f64, f64)>,
    /// Points without an ordinate (unbounded), shown at the top edge; only abscissas count.
    pub open_points: Vec<(f64, f64)>,
    /// Proved ends of values that are not known: abscissa, lower end, upper end. Arrows point to where the value lies.
    pub ends: Vec<(f64, Option<f64>, Option<f64>)>,
    /// Marked places; where there are some, only those are marked unless `dots` says so, and the line is drawn in the
    /// order of its points.
    pub spots: Option<Vec<Spot>>,
    /// Whether every point has a mark although places are marked.
    pub dots: bool,
    /// Whether points are marked and not joined.
    pub unjoined: bool,
    /// Ids of the cases that the points belong to, where they do.
    pub cases: Vec<usize>,
}

/// How a place is marked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Marker {
    /// A filled octagon.
    Dot,
    /// A filled square.
    Square,
    /// A circle around what else is there.
    Ring,
}

/// A marked place of a line.
#[derive(Debug, Clone, PartialEq)]
pub struct Spot {
    /// Where.
    pub at: (f64, f64),
    /// What, for the legend: a kind has one marker.
    pub kind: &'static str,
    /// How it is drawn.
    pub marker: Marker,
    /// Written beside it.
    pub label: String,
}

/// How the axes of a chart run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ChartStyle {
    /// Whether abscissa and ordinate are logarithmic.
    pub log: [bool; 2],
}
