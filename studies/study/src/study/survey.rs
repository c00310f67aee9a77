//! Surveyed profiles: `profile = { shape = …, file = "survey.csv" }` becomes the points in the file, so that the resolved
//! study does not need the file. The file can also be a drawing, `survey.dxf`; a scene of blocks can have a drawing too. The
//! file of a scene `assembly` becomes its blocks and interfaces in the same way.

use super::drawing::{Drawing, DrawnBlock};
use super::dxf::read_drawing;
use crate::config::diagnostic::{LocatedDiagnostic, suggest};
use crate::config::document::{Entry, Node, Table, Value, from_json};
use crate::config::limits::MAX_FILE_BYTES;
use crate::config::origin::Origin;
use crate::regular_file::open_regular;
use crate::space::import;
use flate2::read::GzDecoder;
use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::Path;
use std::sync::Arc;

/// Reads a file that a study names; the error is the reason of a failure.
pub type ReadFile<'a> = &'a dyn Fn(&str) -> Result<String, String>;

/// Refuses all files, for studies that do not come from a folder.
pub fn no_files(_: &str) -> Result<String, String> {
    Err("files are read where a study is read from a file; give the points themselves".into())
}

/// Reads a whole file of at most [`MAX_FILE_BYTES`]. A longer one, such as a device that never ends, is an error.
pub fn read_bounded(path: &Path) -> std::io::Result<Vec<u8>> {
    at_most(File::open(path)?)
}

/// Reads at most [`MAX_FILE_BYTES`]; more is an error.
fn at_most(source: impl Read) -> std::io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    source.take(MAX_FILE_BYTES + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > MAX_FILE_BYTES {
        let message = format!("it is larger than {} MiB", MAX_FILE_BYTES >> 20);
        return Err(std::io::Error::new(ErrorKind::FileTooLarge, message));
    }
    Ok(bytes)
}

/// Reads files in the folder of a study file.
pub fn beside(study: &Path) -> impl Fn(&str) -> Result<String, String> {
    let folder = study.parent().unwrap_or(Path::new("")).to_path_buf();
    move |file| {
        let path = folder.join(file);
        let bytes = open_regular(&path, MAX_FILE_BYTES).and_then(|_| read_bounded(&path));
        let bytes = bytes.and_then(|bytes| if is_compressed(file) { decompressed(&bytes) } else { Ok(bytes) });
        let bytes = bytes.map_err(|error| error.to_string())?;
        match String::from_utf8(bytes) {
            Ok(text) => Ok(text),
            // Older drawings have one byte per character.
            Err(error) if is_drawing(file) => Ok(error.as_bytes().iter().copied().map(char::from).collect()),
            Err(error) => Err(error.to_string()),
        }
    }
}

fn is_compressed(file: &str) -> bool {
    file.to_lowercase().ends_with(".gz")
}

/// Returns the content of a gzip file of at most [`MAX_FILE_BYTES`].
fn decompressed(bytes: &[u8]) -> std::io::Result<Vec<u8>> {
    at_most(GzDecoder::new(bytes))
}

fn is_drawing(file: &str) -> bool {
    file.to_lowercase().ends_with(".dxf")
}

/// Shapes of profiles whose points may be in a file.
const SHAPES: [&str; 2] = ["points", "surveyed"];

/// Replaces every `file` of a profile of points, and of a scene of blocks, by its content.
pub fn import(root: &mut Node, read: ReadFile, mistakes: &mut Vec<LocatedDiagnostic>) {
    let table = root.table().and_then(|root| root.get("materials")).and_then(Node::table);
    let materials: Vec<String> = table.into_iter().flat_map(Table::keys).map(String::from).collect();
    Import { read, materials, mistakes }.node(root);
}

/// The purpose of a file: points of a profile, plane blocks, or an assembly in space.
#[derive(Clone, Copy)]
enum Wanted {
    Profile,
    Blocks,
    Assembly,
}

impl Wanted {
    /// Returns the purpose of the `file` of a table.
    fn of(table: &Table) -> Option<Wanted> {
        let word = |key: &str| table.get(key).and_then(Node::text);
        match (word("shape"), word("scene")) {
            (Some(shape), _) if SHAPES.contains(&shape) => Some(Wanted::Profile),
            (_, Some("blocks")) => Some(Wanted::Blocks),
            (_, Some("assembly")) => Some(Wanted::Assembly),
            _ => None,
        }
    }

    /// Returns the names of the keys that the file replaces.
    fn keys(self) -> &'static [&'static str] {
        match self {
            Wanted::Profile => &CURVES,
            Wanted::Blocks => &["blocks"],
            Wanted::Assembly => &import::KEYS,
        }
    }

    /// Returns the keys that have no meaning after the file has been read.
    fn replaced(self) -> &'static [&'static str] {
        match self {
            Wanted::Profile | Wanted::Blocks => &["file", "unit"],
            Wanted::Assembly => &["file"],
        }
    }
}

struct Import<'a> {
    read: ReadFile<'a>,
    materials: Vec<String>,
    mistakes: &'a mut Vec<LocatedDiagnostic>,
}

impl Import<'_> {
    fn node(&mut self, node: &mut Node) {
        match &mut node.value {
            Value::Array(nodes) => nodes.iter_mut().for_each(|node| self.node(node)),
            Value::Table(table) => match self.imported(table) {
                Some(Ok(entries)) => {
                    let replaced = Wanted::of(table).map_or(&[][..], Wanted::replaced);
                    table.entries.retain(|entry| !replaced.contains(&entry.key.as_str()));
                    table.entries.extend(entries);
                }
                Some(Err(found)) => self.mistakes.extend(found),
                None => table.entries.iter_mut().for_each(|entry| self.node(&mut entry.node)),
            },
            _ => {}
        }
    }

    /// Returns the entries that a table's `file` replaces; `None` if it names no file.
    fn imported(&self, table: &Table) -> Option<Result<Vec<Entry>, Vec<LocatedDiagnostic>>> {
        let wanted = Wanted::of(table)?;
        let node = table.get("file")?;
        let (file, origin) = (node.text()?, node.origin.clone());
        let key = match wanted {
            Wanted::Profile => "profile.file",
            Wanted::Blocks | Wanted::Assembly => "scene.file",
        };
        let wrong = |message: String| LocatedDiagnostic::new(&origin, key, message);
        let besides = wanted.keys().iter().filter(|key| table.get(key).is_some());
        let besides: Vec<_> =
            besides.map(|key| wrong(format!("is given besides {key}")).help("keep one of the two")).collect();
        if !besides.is_empty() {
            return Some(Err(besides));
        }
        let text = match (self.read)(file) {
            Ok(text) => text,
            Err(why) => return Some(Err(vec![wrong(format!("\"{file}\" cannot be read: {why}"))])),
        };
        if let Wanted::Assembly = wanted {
            let found = assembly_entries(file, &text, &origin);
            return Some(found.map_err(|all| all.into_iter().map(|why| wrong(format!("\"{file}\": {why}"))).collect()));
        }
        if is_drawing(file) {
            let found = self.of_drawing(wanted, &text, table.get("unit"), &origin);
            return Some(found.map_err(|all| all.into_iter().map(|why| wrong(format!("\"{file}\": {why}"))).collect()));
        }
        match wanted {
            Wanted::Profile => Some(Survey::read(&text, file).map(|survey| survey.entries(&origin))),
            Wanted::Blocks | Wanted::Assembly => Some(Err(vec![wrong(format!("\"{file}\" is no drawing (.dxf)"))])),
        }
    }

    /// Returns the same entries from the text of a drawing.
    fn of_drawing(
        &self,
        wanted: Wanted,
        text: &str,
        unit: Option<&Node>,
        origin: &Origin,
    ) -> Result<Vec<Entry>, Vec<String>> {
        let drawing = read_drawing(text).map_err(|why| vec![why])?;
        let materials: Vec<&str> = self.materials.iter().map(String::as_str).collect();
        drawn(&drawing, wanted, unit, &materials, origin)
    }
}

/// Returns the entries of a drawing, in its own unit or another one.
fn drawn(
    drawing: &Drawing,
    wanted: Wanted,
    unit: Option<&Node>,
    materials: &[&str],
    origin: &Origin,
) -> Result<Vec<Entry>, Vec<String>> {
    let units = UNITS.map(|known| known.0).join(", ");
    let unit = match unit.map(Node::text) {
        None => drawing.unit.ok_or(vec![format!(
            "the drawing does not say its unit ($INSUNITS); write unit = \"mm\" beside file (units: {units})"
        )])?,
        Some(word) => match UNITS.iter().find(|known| Some(known.0) == word) {
            Some(known) => known.1,
            None => return Err(vec![format!("unit is none of {units}")]),
        },
    };
    match wanted {
        Wanted::Profile => Ok(Survey { curves: drawing.profile(unit)? }.entries(origin)),
        Wanted::Blocks | Wanted::Assembly => {
            let blocks = drawing.blocks(unit, materials)?;
            let list = Value::Array(blocks.into_iter().map(|block| block_node(block, origin)).collect());
            Ok(vec![entry("blocks", list, origin)])
        }
    }
}

/// Returns the entries of a file of an assembly in space.
fn assembly_entries(file: &str, text: &str, origin: &Origin) -> Result<Vec<Entry>, Vec<String>> {
    let keys = import::keys_of_file(file, text).map_err(|why| vec![why])?;
    let one = |(key, value): (String, serde_json::Value)| {
        let mut node = from_json(&value).map_err(|all| all.iter().map(ToString::to_string).collect::<Vec<_>>())?;
        node.set_origin(origin);
        Ok(Entry { key, origin: origin.clone(), node })
    };
    keys.into_iter().map(one).collect()
}

fn entry(key: &str, value: Value, origin: &Origin) -> Entry {
    Entry { key: key.into(), origin: origin.clone(), node: Node { value, origin: origin.clone() } }
}

/// Returns points as a list of pairs.
fn points_value(points: Vec<[f64; 2]>, origin: &Origin) -> Value {
    let node = |value: Value| Node { value, origin: origin.clone() };
    let point = |point: [f64; 2]| node(Value::Array(point.map(|x| node(Value::Float(x))).into()));
    Value::Array(points.into_iter().map(point).collect())
}

/// Returns a block as an entry of the key `blocks`.
fn block_node(block: DrawnBlock, origin: &Origin) -> Node {
    let mut entries = vec![
        entry("name", Value::String(block.name), origin),
        entry("vertices", points_value(block.vertices, origin), origin),
    ];
    entries.extend(block.material.map(|material| entry("material", Value::String(material), origin)));
    entries.extend(block.fixed.then(|| entry("fixed", Value::Boolean(true), origin)));
    Node { value: Value::Table(Table { entries }), origin: origin.clone() }
}

/// Points of an intrados and an extrados \[m\].
#[derive(Debug, Default, PartialEq)]
struct Survey {
    curves: [Vec<[f64; 2]>; 2],
}

/// Content of a column: its curve (`None` if each line names the curve), and x or y.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Column {
    Curve,
    Coordinate { curve: Option<usize>, axis: usize, unit: f64 },
    Other,
}

const CURVES: [&str; 2] = ["intrados", "extrados"];
const UNITS: [(&str, f64); 5] = [("m", 1.0), ("mm", 1e-3), ("cm", 1e-2), ("ft", 0.3048), ("in", 0.0254)];
const COLUMNS: [&str; 7] = ["curve", "x", "y", "intrados_x", "intrados_y", "extrados_x", "extrados_y"];

/// Splits a line of the file into cells, each with the column of its first character.
fn cells(line: &str, separator: char) -> Vec<(usize, &str)> {
    let mut at = 0;
    line.split(separator)
        .map(|cell| {
            let (start, trimmed) = (at, cell.trim());
            at += cell.len() + separator.len_utf8();
            let blank = cell.len() - cell.trim_start().len();
            (line[..start + blank].chars().count() + 1, trimmed)
        })
        .collect()
}

impl Survey {
    /// Reads a table: a header, then one line for each point. The error lists all mistakes with line and column.
    fn read(text: &str, file: &str) -> Result<Survey, Vec<LocatedDiagnostic>> {
        let name: Arc<str> = file.into();
        let at = |line: usize, column: usize| Origin::File { file: name.clone(), line, column };
        let lines = text.trim_start_matches('\u{feff}').lines().enumerate();
        let mut lines =
            lines.map(|(i, line)| (i + 1, line)).filter(|(_, line)| !line.trim().is_empty() && !line.starts_with('#'));
        let Some((first, header)) = lines.next() else {
            return Err(vec![LocatedDiagnostic::new(&at(1, 1), "", "there is no line with the names of columns")]);
        };
        let separator = [';', '\t', ','].into_iter().find(|c| header.contains(*c)).unwrap_or(',');
        let columns = Self::columns(&cells(header, separator), &|column| at(first, column))?;
        let (mut survey, mut mistakes) = (Survey::default(), Vec::new());
        for (number, line) in lines {
            let row = Row { cells: cells(line, separator), columns: &columns, decimal_comma: separator != ',' };
            match row.points(&|column| at(number, column)) {
                Ok(points) => points.into_iter().for_each(|(curve, point)| survey.curves[curve].push(point)),
                Err(wrong) => mistakes.push(*wrong),
            }
        }
        if mistakes.is_empty()
            && let Some(curve) = (0..2).find(|&curve| survey.curves[curve].len() < 2)
        {
            let message = format!("the {} has {} point(s); it needs two", CURVES[curve], survey.curves[curve].len());
            mistakes.push(LocatedDiagnostic::new(&at(first, 1), "", message));
        }
        if mistakes.is_empty() { Ok(survey) } else { Err(mistakes) }
    }

    /// Returns the content of the columns, by their names.
    fn columns(header: &[(usize, &str)], at: &dyn Fn(usize) -> Origin) -> Result<Vec<Column>, Vec<LocatedDiagnostic>> {
        let (mut columns, mut mistakes) = (Vec::new(), Vec::new());
        for &(place, title) in header {
            let (name, unit) = title
                .split_once('[')
                .map_or((title, "m"), |(name, rest)| (name.trim(), rest.trim_end_matches(']').trim()));
            let Some((_, unit)) = UNITS.iter().find(|known| known.0 == unit) else {
                let units = UNITS.map(|known| known.0).join(", ");
                mistakes.push(
                    LocatedDiagnostic::new(&at(place), "", format!("\"{unit}\" is no unit here"))
                        .help(format!("units: {units}")),
                );
                continue;
            };
            let lower = name.to_lowercase();
            let axis = |name: &str| ["x", "y"].iter().position(|axis| *axis == name);
            let column = match lower.split_once('_') {
                Some((curve, rest)) => (CURVES.iter().position(|name| *name == curve).zip(axis(rest)))
                    .map(|(curve, axis)| Column::Coordinate { curve: Some(curve), axis, unit: *unit }),
                None if lower == "curve" => Some(Column::Curve),
                None => axis(&lower).map(|axis| Column::Coordinate { curve: None, axis, unit: *unit }),
            };
            let near = voussoir_core::plugin::nearest(&lower, COLUMNS).is_some();
            match column {
                None if near => {
                    let help = suggest(&lower, &COLUMNS, "columns");
                    mistakes.push(
                        LocatedDiagnostic::new(&at(place), "", format!("there is no column \"{name}\"")).help(help),
                    );
                }
                column => columns.push(column.unwrap_or(Column::Other)),
            }
        }
        let has = |curve: Option<usize>, axis: usize| {
            columns.iter().any(
                |column| matches!(column, Column::Coordinate { curve: c, axis: a, .. } if (*c, *a) == (curve, axis)),
            )
        };
        let by_line = columns.contains(&Column::Curve) && has(None, 0) && has(None, 1);
        let by_column = (0..2).all(|curve| has(Some(curve), 0) && has(Some(curve), 1));
        if mistakes.is_empty() && !by_line && !by_column {
            let message = "the columns are neither curve, x, y nor intrados_x, intrados_y, extrados_x, extrados_y";
            mistakes.push(LocatedDiagnostic::new(&at(1), "", message).help("a unit may follow a name: x [mm]"));
        }
        if mistakes.is_empty() { Ok(columns) } else { Err(mistakes) }
    }

    /// Returns the keys `intrados` and `extrados`.
    fn entries(self, origin: &Origin) -> Vec<Entry> {
        CURVES
            .into_iter()
            .zip(self.curves)
            .map(|(key, points)| entry(key, points_value(points, origin), origin))
            .collect()
    }
}

/// A line of the table.
struct Row<'a> {
    cells: Vec<(usize, &'a str)>,
    columns: &'a [Column],
    decimal_comma: bool,
}

impl Row<'_> {
    /// Returns the points of the line, each with its curve; a pair of empty cells gives no point.
    fn points(&self, at: &dyn Fn(usize) -> Origin) -> Result<Vec<(usize, [f64; 2])>, Box<LocatedDiagnostic>> {
        let mut of_line = None;
        let mut found = [[None; 2]; 3];
        for (&(place, cell), column) in self.cells.iter().zip(self.columns) {
            match *column {
                Column::Curve => {
                    of_line = CURVES.iter().position(|name| *name == cell.to_lowercase());
                    if of_line.is_none() {
                        let message = format!("\"{cell}\" is neither intrados nor extrados");
                        return Err(Box::new(LocatedDiagnostic::new(&at(place), "", message)));
                    }
                }
                Column::Coordinate { curve, axis, unit } if !cell.is_empty() => {
                    let written = if self.decimal_comma { cell.replace(',', ".") } else { cell.to_string() };
                    let number = written.parse::<f64>().ok().filter(|number| number.is_finite());
                    let Some(number) = number else {
                        return Err(Box::new(LocatedDiagnostic::new(
                            &at(place),
                            "",
                            format!("\"{cell}\" is not a number"),
                        )));
                    };
                    found[curve.unwrap_or(2)][axis] = Some(number * unit);
                }
                _ => {}
            }
        }
        if let Some(curve) = of_line {
            found[curve] = found[2];
        }
        let mut points = Vec::new();
        for (curve, pair) in found.iter().take(2).enumerate() {
            match pair {
                [Some(x), Some(y)] => points.push((curve, [*x, *y])),
                [None, None] => {}
                _ => {
                    let message = format!("a point of the {} has only one coordinate", CURVES[curve]);
                    return Err(Box::new(LocatedDiagnostic::new(&at(1), "", message)));
                }
            }
        }
        if points.is_empty() {
            return Err(Box::new(LocatedDiagnostic::new(&at(1), "", "this line has no point")));
        }
        Ok(points)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Survey, String> {
        Survey::read(text, "survey.csv")
            .map_err(|wrong| wrong.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))
    }

    /// The same four points joint by joint, point by point, and in millimetres with decimal commas.
    #[test]
    fn every_form_gives_the_same_points() {
        let expected = Survey { curves: [vec![[0.0, 0.0], [3.0, 0.25]], vec![[-0.5, 0.5], [3.5, 0.75]]] };
        for text in [
            "intrados_x,intrados_y,extrados_x,extrados_y\n0,0,-0.5,0.5\n3,0.25,3.5,0.75\n",
            "# surveyed in May\ncurve,x,y,remark\nintrados,0,0,left\nintrados,3,0.25,\n\nextrados,-0.5,0.5\nextrados,3.5,0.75\n",
            "\u{feff}curve;x [mm];y [mm]\nIntrados;0;0\nextrados;-500,0;500\nintrados;3000;250\nextrados;3500;750",
            "intrados_x,intrados_y,extrados_x,extrados_y\n0,0,,\n3,0.25,-0.5,0.5\n,,3.5,0.75\n",
        ] {
            assert_eq!(read(text).unwrap(), expected, "{text}");
        }
    }

    /// Mistakes have file, line and column.
    #[test]
    fn mistakes_have_their_line_and_column() {
        let message = |text: &str| read(text).unwrap_err();
        assert_eq!(message("curve,x,y\nintrados,0,0\nextrados, 1,o.5\n"), "survey.csv:3:13: \"o.5\" is not a number");
        assert_eq!(message("curve,x,y\nintrado,0,0\n"), "survey.csv:2:1: \"intrado\" is neither intrados nor extrados");
        assert_eq!(
            message("curve,x,y\nintrados,0,0\nintrados,1,0\nextrados,1,1\n"),
            "survey.csv:1:1: the extrados has 1 point(s); it needs two"
        );
        assert!(message("curve,x [mil],y\n").starts_with("survey.csv:1:7: \"mil\" is no unit here"));
        assert!(message("curv,x,y\n").contains("did you mean \"curve\"?"));
        assert_eq!(
            message("curve,x,y\nintrados,0,\n"),
            "survey.csv:2:1: a point of the intrados has only one coordinate"
        );
        assert!(message("").contains("no line with the names"));
    }

    /// The polylines of a drawing become the keys of a study; the unit comes from the drawing or from the key beside the file.
    #[test]
    fn a_drawing_stands_for_points_and_blocks() {
        use crate::study::drawing::{Corner, Polyline};
        let corners = |points: &[[f64; 2]]| points.iter().map(|&point| Corner { point, bulge: 0.0 }).collect();
        let line = |layer: &str, closed: bool, points: &[[f64; 2]]| Polyline {
            entity: "LWPOLYLINE 2A (line 22)".into(),
            layer: layer.into(),
            closed,
            corners: corners(points),
        };
        let origin = Origin::File { file: "a.toml".into(), line: 1, column: 1 };
        let node = |text: &str| Node { value: Value::String(text.into()), origin: origin.clone() };
        let square = [[0.0, 0.0], [400.0, 0.0], [400.0, 500.0]];
        let blocks = Drawing { unit: None, polylines: vec![line("stone", true, &square)], loose: Vec::new() };
        let of = |unit: Option<&Node>| drawn(&blocks, Wanted::Blocks, unit, &["stone"], &origin);
        assert!(of(None).unwrap_err()[0].contains("$INSUNITS"));
        assert!(of(Some(&node("mil"))).unwrap_err()[0].contains("unit is none of m, mm"));
        let [list] = &of(Some(&node("mm"))).unwrap()[..] else { panic!("one key") };
        let toml = toml::to_string(
            &Node { value: Value::Table(Table { entries: vec![list.clone()] }), origin: origin.clone() }.to_toml(),
        );
        let toml = toml.unwrap();
        assert!(toml.contains("name = \"stone 1\"") && toml.contains("material = \"stone\""), "{toml}");
        assert!(toml.replace(char::is_whitespace, "").contains("[0.4,0.5]"), "{toml}");
        let polylines = vec![line("intrados", false, &square[..2]), line("extrados", false, &square[1..])];
        let profile = Drawing { unit: Some(1e-3), polylines, loose: Vec::new() };
        let keys = drawn(&profile, Wanted::Profile, None, &[], &origin).unwrap();
        assert_eq!(keys.iter().map(|entry| entry.key.as_str()).collect::<Vec<_>>(), ["intrados", "extrados"]);
    }
}
