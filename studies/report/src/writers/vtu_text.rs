//! Text of VTK XML files of unstructured grids.

use std::fmt::Write;

/// Adds an array with one line for each row.
pub(super) fn array(text: &mut String, name: &str, kind: &str, components: usize, rows: impl Iterator<Item = String>) {
    let _ = writeln!(
        text,
        "        <DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"ascii\">"
    );
    for row in rows {
        let _ = writeln!(text, "          {row}");
    }
    text.push_str("        </DataArray>\n");
}

/// The start of a file with one piece, up to its points.
pub(super) fn head(points: usize, cells: usize) -> String {
    format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\">\n  \
         <UnstructuredGrid>\n    <Piece NumberOfPoints=\"{points}\" NumberOfCells=\"{cells}\">\n      <Points>\n"
    )
}

/// The end of a file with one piece.
pub(super) fn tail() -> &'static str {
    "    </Piece>\n  </UnstructuredGrid>\n</VTKFile>\n"
}
