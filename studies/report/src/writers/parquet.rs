//! The part of the Parquet format that a flat table needs: optional columns of texts, doubles, integers and booleans,
//! plain encoding, no compression, one data page for each column and group of rows.
//!
//! Source: Apache Parquet, `parquet-format` 2 (`parquet.thrift`, Encodings.md); the compact protocol of Apache Thrift.

use crate::output::columns::{Cell, CellKind};
use std::io::{self, Write};

impl CellKind {
    /// Its number in `enum Type` of the format.
    fn stored(self) -> i64 {
        match self {
            CellKind::Truth => 0,
            CellKind::Whole => 2,
            CellKind::Number => 5,
            CellKind::Text => 6,
        }
    }
}

impl Cell {
    fn is_there(&self) -> bool {
        match self {
            Cell::Text(text) => text.is_some(),
            Cell::Number(number) => number.is_some(),
            Cell::Whole(count) => count.is_some(),
            Cell::Truth(truth) => truth.is_some(),
        }
    }
}

/// A struct in the compact protocol of Thrift. Fields are added by increasing number.
#[derive(Default)]
struct Struct {
    bytes: Vec<u8>,
    last: u8,
}

const I32: u8 = 5;
const I64: u8 = 6;
const BINARY: u8 = 8;
const LIST: u8 = 9;
const STRUCT: u8 = 12;

fn varint(bytes: &mut Vec<u8>, mut value: u64) {
    while value >= 0x80 {
        bytes.push(value as u8 | 0x80);
        value >>= 7;
    }
    bytes.push(value as u8);
}

fn zigzag(value: i64) -> u64 {
    ((value << 1) ^ (value >> 63)) as u64
}

impl Struct {
    /// Writes the header of a field. In this format, consecutive field numbers differ by less than 16.
    fn field(mut self, number: u8, kind: u8) -> Self {
        self.bytes.push((number - self.last) << 4 | kind);
        self.last = number;
        self
    }

    fn integer(self, number: u8, kind: u8, value: i64) -> Self {
        let mut own = self.field(number, kind);
        varint(&mut own.bytes, zigzag(value));
        own
    }

    fn i32(self, number: u8, value: i64) -> Self {
        self.integer(number, I32, value)
    }

    fn i64(self, number: u8, value: i64) -> Self {
        self.integer(number, I64, value)
    }

    fn text(self, number: u8, text: &str) -> Self {
        let mut own = self.field(number, BINARY);
        own.bytes.extend(binary(text));
        own
    }

    fn inner(self, number: u8, value: Struct) -> Self {
        let mut own = self.field(number, STRUCT);
        own.bytes.extend(value.end());
        own
    }

    /// A list of elements that are already encoded.
    fn list(self, number: u8, kind: u8, elements: Vec<Vec<u8>>) -> Self {
        let mut own = self.field(number, LIST);
        if elements.len() < 15 {
            own.bytes.push((elements.len() as u8) << 4 | kind);
        } else {
            own.bytes.push(0xF0 | kind);
            varint(&mut own.bytes, elements.len() as u64);
        }
        elements.into_iter().for_each(|element| own.bytes.extend(element));
        own
    }

    fn end(mut self) -> Vec<u8> {
        self.bytes.push(0);
        self.bytes
    }
}

fn binary(text: &str) -> Vec<u8> {
    let mut bytes = Vec::new();
    varint(&mut bytes, text.len() as u64);
    bytes.extend(text.as_bytes());
    bytes
}

/// Encodes which values are present: runs of equal levels (hybrid encoding, one bit wide), preceded by their length.
fn levels(there: &[bool]) -> Vec<u8> {
    let mut runs = Vec::new();
    for run in there.chunk_by(|a, b| a == b) {
        varint(&mut runs, (run.len() as u64) << 1);
        runs.push(u8::from(run[0]));
    }
    let mut bytes = (runs.len() as u32).to_le_bytes().to_vec();
    bytes.extend(runs);
    bytes
}

/// Encodes the values that are present, one after another.
fn plain(cells: &[Cell]) -> Vec<u8> {
    let (mut bytes, mut truths) = (Vec::new(), 0_usize);
    for cell in cells {
        match cell {
            Cell::Text(Some(text)) => {
                bytes.extend((text.len() as u32).to_le_bytes());
                bytes.extend(text.as_bytes());
            }
            Cell::Number(Some(number)) => bytes.extend(number.to_le_bytes()),
            Cell::Whole(Some(count)) => bytes.extend(count.to_le_bytes()),
            Cell::Truth(Some(truth)) => {
                if truths.is_multiple_of(8) {
                    bytes.push(0);
                }
                let last = bytes.len() - 1;
                bytes[last] |= u8::from(*truth) << (truths % 8);
                truths += 1;
            }
            _ => {}
        }
    }
    bytes
}

/// A page of one column: its header and its data.
fn page(cells: &[Cell]) -> Vec<u8> {
    let there: Vec<bool> = cells.iter().map(Cell::is_there).collect();
    let mut data = levels(&there);
    data.extend(plain(cells));
    const PLAIN: i64 = 0;
    const RLE: i64 = 3;
    let values = Struct::default().i32(1, cells.len() as i64).i32(2, PLAIN).i32(3, RLE).i32(4, RLE);
    let size = data.len() as i64;
    let mut bytes = Struct::default().i32(1, 0).i32(2, size).i32(3, size).inner(5, values).end();
    bytes.extend(data);
    bytes
}

const MAGIC: &[u8; 4] = b"PAR1";
/// Number of rows that are buffered before they are written.
const GROUP: usize = 4096;

/// Writes a table as Parquet, row by row. It buffers at most one group of rows.
pub struct Parquet {
    at: i64,
    /// Name and `enum Type` of each column.
    columns: Vec<(String, i64)>,
    waiting: Vec<Vec<Cell>>,
    groups: Vec<Vec<u8>>,
    rows: i64,
}

impl Parquet {
    /// Creates a table whose columns have these names and types.
    pub fn new(columns: impl Iterator<Item = (String, CellKind)>) -> Self {
        let columns = columns.map(|(name, kind)| (name, kind.stored())).collect();
        Parquet { at: MAGIC.len() as i64, columns, waiting: Vec::new(), groups: Vec::new(), rows: 0 }
    }

    /// Writes the beginning of the file.
    pub fn begin(&mut self, out: &mut dyn Write) -> io::Result<()> {
        out.write_all(MAGIC)
    }

    /// Adds a row with one cell for each column, of the type of the column.
    pub fn add(&mut self, row: Vec<Cell>, out: &mut dyn Write) -> io::Result<()> {
        let fits = row.len() == self.columns.len()
            && row.iter().zip(&self.columns).all(|(cell, own)| cell.kind().stored() == own.1);
        if !fits {
            return Err(io::Error::other("a row is not like the columns of its table"));
        }
        self.waiting.push(row);
        if self.waiting.len() == GROUP { self.write_group(out) } else { Ok(()) }
    }

    fn write_group(&mut self, out: &mut dyn Write) -> io::Result<()> {
        let rows = std::mem::take(&mut self.waiting);
        let count = rows.len() as i64;
        let mut rows: Vec<_> = rows.into_iter().map(Vec::into_iter).collect();
        let (mut chunks, begun) = (Vec::new(), self.at);
        for (name, stored) in &self.columns {
            let cells: Vec<Cell> = rows.iter_mut().filter_map(Iterator::next).collect();
            let page = page(&cells);
            let size = page.len() as i64;
            out.write_all(&page)?;
            let encodings = [0, 3].map(|encoding| zigzag(encoding) as u8).map(|byte| vec![byte]);
            let meta = Struct::default()
                .i32(1, *stored)
                .list(2, I32, encodings.into())
                .list(3, BINARY, vec![binary(name)])
                .i32(4, 0)
                .i64(5, count)
                .i64(6, size)
                .i64(7, size)
                .i64(9, self.at);
            chunks.push(Struct::default().i64(2, self.at).inner(3, meta).end());
            self.at += size;
        }
        let group = Struct::default().list(1, STRUCT, chunks).i64(2, self.at - begun).i64(3, count);
        self.groups.push(group.end());
        self.rows += count;
        Ok(())
    }

    /// Writes the buffered rows and the list of all groups.
    pub fn end(&mut self, out: &mut dyn Write) -> io::Result<()> {
        if !self.waiting.is_empty() {
            self.write_group(out)?;
        }
        let root = Struct::default().text(4, "rows").i32(5, self.columns.len() as i64).end();
        let column = |(name, stored): &(String, i64)| {
            let own = Struct::default().i32(1, *stored).i32(3, 1).text(4, name);
            // Texts are marked as UTF-8.
            if *stored == 6 { own.i32(6, 0).end() } else { own.end() }
        };
        let schema = std::iter::once(root).chain(self.columns.iter().map(column)).collect();
        let footer = Struct::default()
            .i32(1, 1)
            .list(2, STRUCT, schema)
            .i64(3, self.rows)
            .list(4, STRUCT, std::mem::take(&mut self.groups))
            .text(6, concat!("voussoir version ", env!("CARGO_PKG_VERSION")))
            .end();
        out.write_all(&footer)?;
        out.write_all(&(footer.len() as u32).to_le_bytes())?;
        out.write_all(MAGIC)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Examples from the specifications of Thrift and Parquet.
    #[test]
    fn numbers_and_levels_are_written_as_specified() {
        let written = |value| {
            let mut bytes = Vec::new();
            varint(&mut bytes, value);
            bytes
        };
        assert_eq!((written(50_399), written(0)), (vec![0xDF, 0x89, 0x03], vec![0]));
        assert_eq!([0, -1, 1, -2, 2_147_483_647].map(zigzag), [0, 1, 2, 3, 4_294_967_294]);
        assert_eq!(levels(&[true, true, true, false]), [4, 0, 0, 0, 6, 1, 2, 0]);
        let truths = [true, false, true, true, false, false, false, false, true].map(|truth| Cell::Truth(Some(truth)));
        assert_eq!(plain(&truths), [0b0000_1101, 1]);
        assert_eq!(plain(&[Cell::Text(None), Cell::Text(Some("ab".into()))]), [2, 0, 0, 0, b'a', b'b']);
        assert_eq!(Struct::default().i32(1, 1).text(4, "x").end(), [0x15, 2, 0x38, 1, b'x', 0]);
    }

    #[test]
    fn a_table_takes_rows_like_its_columns_only() {
        let (mut table, mut bytes) = (Parquet::new([("a".to_string(), CellKind::Whole)].into_iter()), Vec::new());
        table.begin(&mut bytes).expect("a table");
        table.add(vec![Cell::Whole(Some(1))], &mut bytes).expect("a row");
        assert!(
            table.add(vec![Cell::Number(Some(1.0))], &mut bytes).is_err() && table.add(Vec::new(), &mut bytes).is_err()
        );
        table.end(&mut bytes).expect("a file");
        assert!(bytes.starts_with(MAGIC) && bytes.ends_with(MAGIC));
    }
}
