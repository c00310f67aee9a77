//! The schema of configuration tables: keys, shapes, units, ranges.
//!
//! One description is used for the check of a study file, its JSON Schema and the pages of `voussoir explain`. It is beside
//! the traits because every plug-in's card contains one. Files are read elsewhere.

use super::units::Quantity;

/// The values that a number may have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// Least value.
    pub min: f64,
    /// True if the least value is excluded.
    pub min_open: bool,
    /// Greatest value.
    pub max: f64,
    /// True if the greatest value is excluded.
    pub max_open: bool,
}

impl Range {
    /// Any finite number.
    pub const ANY: Range = Range::new(f64::NEG_INFINITY, true, f64::INFINITY, true);
    /// `> 0`.
    pub const POSITIVE: Range = Range::new(0.0, true, f64::INFINITY, true);
    /// `≥ 0`.
    pub const NON_NEGATIVE: Range = Range::new(0.0, false, f64::INFINITY, true);

    /// Creates an interval; `*_open` excludes its end.
    pub const fn new(min: f64, min_open: bool, max: f64, max_open: bool) -> Self {
        Range { min, min_open, max, max_open }
    }

    /// Returns true if the finite number `x` is in the range.
    pub const fn contains(&self, x: f64) -> bool {
        x.is_finite()
            && (if self.min_open { x > self.min } else { x >= self.min })
            && (if self.max_open { x < self.max } else { x <= self.max })
    }

    /// Describes the range in words: `greater than 0`, `from 0 to 0.5 (excluded)`.
    pub fn describe(&self) -> String {
        let lower = (self.min != f64::NEG_INFINITY)
            .then(|| format!("{} {}", if self.min_open { "greater than" } else { "at least" }, self.min));
        let upper = (self.max != f64::INFINITY)
            .then(|| format!("{} {}", if self.max_open { "less than" } else { "at most" }, self.max));
        match (lower, upper) {
            (None, None) => "a finite number".into(),
            (Some(l), None) => l,
            (None, Some(u)) => u,
            (Some(l), Some(u)) => format!("{l} and {u}"),
        }
    }
}

/// The kinds of plug-in; each is chosen by the value of its tag key.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum PluginKind {
    /// Law of a joint: `[joints.NAME] law = …`.
    InterfaceLaw,
    /// Law of a block's material: `[materials.NAME] law = …`.
    BulkMaterial,
    /// Geometry: `[scene] scene = …`.
    Scene,
    /// Limit solver: `[solver] solver = …`.
    LimitSolver,
    /// Path solver: `[solver] solver = …`.
    PathSolver,
    /// Continuation of a path: `[solver] continuation = { strategy = … }`.
    Continuation,
    /// A load of a stage: `loads = [{ kind = … }]`.
    LoadKind,
    /// Spread of a live load: `dispersion = { law = … }`.
    Dispersion,
    /// Resistance of the fill: `resistance = { law = … }`.
    FillResistance,
    /// Use of the cases: `kind = …`.
    StudyKind,
    /// A kind of result file.
    Writer,
}

impl PluginKind {
    /// All kinds, in the order of `voussoir list`.
    pub const ALL: [PluginKind; 11] = [
        PluginKind::InterfaceLaw,
        PluginKind::BulkMaterial,
        PluginKind::Scene,
        PluginKind::LimitSolver,
        PluginKind::PathSolver,
        PluginKind::Continuation,
        PluginKind::LoadKind,
        PluginKind::Dispersion,
        PluginKind::FillResistance,
        PluginKind::StudyKind,
        PluginKind::Writer,
    ];

    /// Returns the key whose value is the tag.
    pub fn tag_key(self) -> &'static str {
        match self {
            PluginKind::InterfaceLaw
            | PluginKind::BulkMaterial
            | PluginKind::Dispersion
            | PluginKind::FillResistance => "law",
            PluginKind::Scene => "scene",
            PluginKind::LimitSolver | PluginKind::PathSolver => "solver",
            PluginKind::Continuation => "strategy",
            PluginKind::StudyKind | PluginKind::LoadKind => "kind",
            PluginKind::Writer => "writer",
        }
    }

    /// Describes the kind in words, in the singular.
    pub fn describe(self) -> &'static str {
        match self {
            PluginKind::InterfaceLaw => "interface law",
            PluginKind::BulkMaterial => "bulk material",
            PluginKind::Scene => "scene",
            PluginKind::LimitSolver => "limit solver",
            PluginKind::PathSolver => "path solver",
            PluginKind::Continuation => "continuation strategy",
            PluginKind::LoadKind => "load kind",
            PluginKind::Dispersion => "dispersion",
            PluginKind::FillResistance => "fill resistance",
            PluginKind::StudyKind => "study kind",
            PluginKind::Writer => "writer",
        }
    }

    /// Returns the plural, which is the argument of `voussoir list`.
    pub fn plural(self) -> &'static str {
        match self {
            PluginKind::InterfaceLaw => "laws",
            PluginKind::BulkMaterial => "materials",
            PluginKind::Scene => "scenes",
            PluginKind::LimitSolver => "solvers",
            PluginKind::PathSolver => "path_solvers",
            PluginKind::Continuation => "strategies",
            PluginKind::LoadKind => "loads",
            PluginKind::Dispersion => "dispersions",
            PluginKind::FillResistance => "fill_resistances",
            PluginKind::StudyKind => "kinds",
            PluginKind::Writer => "writers",
        }
    }
}

/// One alternative of a tagged table.
#[derive(Debug)]
pub struct Variant {
    /// The tag's value.
    pub tag: &'static str,
    /// Description in one line.
    pub doc: &'static str,
    /// Its keys.
    pub parameters: &'static [Parameter],
}

/// The form of a value.
#[derive(Debug, Clone, Copy)]
pub enum Shape {
    /// A number in `quantity`'s unit, or a string with a unit.
    Number(Quantity, Range),
    /// A whole number in `[min, max]`.
    Integer {
        /// Least value.
        min: i64,
        /// Greatest value.
        max: i64,
    },
    /// `true` or `false`.
    Boolean,
    /// Any text.
    Text,
    /// One of these words.
    Choice(&'static [&'static str]),
    /// The name of an entry of the top-level table of that name.
    Reference(&'static str),
    /// A list of `min..=max` entries.
    List {
        /// Shape of an entry.
        of: &'static Shape,
        /// Least number of entries.
        min: usize,
        /// Greatest number of entries.
        max: usize,
    },
    /// A list with one entry for each of these names and shapes, in order: `[x, y]`.
    Tuple(&'static [(&'static str, Shape)]),
    /// A table with these keys.
    Table(&'static [Parameter]),
    /// A table whose keys depend on the word under `key`.
    Tagged {
        /// The deciding key.
        key: &'static str,
        /// The alternatives.
        variants: &'static [Variant],
    },
    /// The first alternative whose outer form matches.
    Either(&'static [Shape]),
    /// A table that configures a plug-in of this kind.
    Plugin(PluginKind),
    /// A table from free names to values of one shape.
    Map(&'static Shape),
    /// Any value; its reader checks it.
    Free,
}

/// The need of a key.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Need {
    /// The key must be given.
    Required,
    /// The key may be absent. There is no single default; the text describes the effect.
    Optional(&'static str),
    /// The key may be absent; its default is this TOML value.
    Default(&'static str),
}

/// One key of a configuration table.
#[derive(Debug, Clone, Copy)]
pub struct Parameter {
    /// The key.
    pub name: &'static str,
    /// Meaning and sign convention in one line.
    pub doc: &'static str,
    /// Form of its value.
    pub shape: Shape,
    /// Required, optional or with a default.
    pub need: Need,
}

impl Parameter {
    /// Creates a number that must be given.
    pub const fn number(name: &'static str, quantity: Quantity, range: Range, doc: &'static str) -> Self {
        Parameter { name, doc, shape: Shape::Number(quantity, range), need: Need::Required }
    }

    /// Makes the parameter optional.
    pub const fn optional(self, otherwise: &'static str) -> Self {
        Parameter { need: Need::Optional(otherwise), ..self }
    }

    /// Gives the parameter a default, a TOML value.
    pub const fn default(self, value: &'static str) -> Self {
        Parameter { need: Need::Default(value), ..self }
    }
}
