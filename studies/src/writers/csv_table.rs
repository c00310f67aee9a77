//! Tables as CSV, of which no cell is a formula to a spreadsheet.

use std::io::{self, Write};

/// A table with its header. Rows are as long as the header.
pub fn csv_table(header: Vec<String>, rows: impl Iterator<Item = Vec<String>>) -> String {
    let whole = || -> io::Result<Vec<u8>> {
        let mut table = CsvRows::new(Vec::new(), header)?;
        for row in rows {
            table.add(row)?;
        }
        table.finish()
    };
    String::from_utf8(whole().expect("every row is as long as the header")).expect("every cell is text")
}

/// The same table, row by row.
pub struct CsvRows<W: Write>(csv::Writer<W>);

impl<W: Write> CsvRows<W> {
    /// Writes the header.
    pub fn new(out: W, header: Vec<String>) -> io::Result<Self> {
        let mut rows = CsvRows(csv::Writer::from_writer(out));
        rows.add(header).map(|()| rows)
    }

    /// Writes a row, as long as the header.
    pub fn add(&mut self, row: Vec<String>) -> io::Result<()> {
        Ok(self.0.write_record(row.into_iter().map(plain))?)
    }

    /// Where it was written to, all of it.
    pub fn finish(self) -> io::Result<W> {
        self.0.into_inner().map_err(|error| error.into_error())
    }
}

/// A cell that is text or a number: what a spreadsheet would read as a formula gets an apostrophe in front, which
/// spreadsheets do not show.
fn plain(cell: String) -> String {
    let formula = cell.starts_with(['=', '+', '-', '@', '\t', '\r']) && cell.parse::<f64>().is_err();
    if formula { format!("'{cell}") } else { cell }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_stay_and_formulas_become_text() {
        let row = ["-1.5", "=1+1", "@x", "+2", "-a", "a=b", ""].map(String::from).to_vec();
        let header = (0..7).map(|i| format!("c{i}")).collect();
        assert_eq!(csv_table(header, [row].into_iter()), "c0,c1,c2,c3,c4,c5,c6\n-1.5,'=1+1,'@x,+2,'-a,a=b,\n");
    }
}
