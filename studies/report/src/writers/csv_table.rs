//! Tables as CSV. No cell can be read as a formula by a spreadsheet.

/// A table with its header. Rows are as long as the header.
pub fn csv_table(header: Vec<String>, rows: impl Iterator<Item = Vec<String>>) -> String {
    let lines: Vec<u8> = std::iter::once(header).chain(rows).flat_map(|row| csv_row(row.into_iter())).collect();
    String::from_utf8(lines).expect("every cell is text")
}

/// A row with its line end.
pub fn csv_row(cells: impl Iterator<Item = String>) -> Vec<u8> {
    let mut line = csv::WriterBuilder::new().buffer_capacity(1 << 10).from_writer(Vec::new());
    line.write_record(cells.map(plain)).expect("memory takes what is written");
    line.into_inner().expect("memory takes what is written")
}

/// A cell that is text or a number. If a spreadsheet would read it as a formula, it begins with an apostrophe, which
/// spreadsheets do not show. A hyphen alone is the unit of a pure number.
fn plain(cell: String) -> String {
    let formula = cell.starts_with(['=', '+', '-', '@', '\t', '\r']) && cell != "-" && cell.parse::<f64>().is_err();
    if formula { format!("'{cell}") } else { cell }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_stay_and_formulas_become_text() {
        let row = ["-1.5", "=1+1", "@x", "+2", "-a", "a=b", "-"].map(String::from).to_vec();
        let header = (0..7).map(|i| format!("c{i}")).collect();
        assert_eq!(csv_table(header, [row].into_iter()), "c0,c1,c2,c3,c4,c5,c6\n-1.5,'=1+1,'@x,+2,'-a,a=b,-\n");
    }
}
