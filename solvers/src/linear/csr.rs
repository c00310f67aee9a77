//! A sparse matrix stored by rows, for products with dense vectors.

use voussoir_core::linear::Entries;

/// Least number of entries for which a row is summed in four independent sums.
const LONG: usize = 16;

/// Rows of (column, value). Repeated entries are stored separately; products add them.
#[derive(Debug, Clone, Default)]
pub struct CsrMatrix {
    start: Vec<usize>,
    entries: Vec<(usize, f64)>,
}

impl CsrMatrix {
    /// Creates a matrix with entries sorted by row; within a row they keep their order.
    pub fn new(rows: usize, unsorted: &Entries) -> Self {
        let mut start = vec![0; rows + 1];
        for entry in unsorted {
            start[entry.0 + 1] += 1;
        }
        for i in 0..rows {
            start[i + 1] += start[i];
        }
        let mut next = start.clone();
        let mut entries = vec![(0, 0.0); unsorted.len()];
        for &(i, j, value) in unsorted {
            entries[next[i]] = (j, value);
            next[i] += 1;
        }
        CsrMatrix { start, entries }
    }

    /// Creates a matrix from its rows.
    pub fn from_rows(rows: &[Vec<(usize, f64)>]) -> Self {
        let mut all = CsrMatrix { start: vec![0], entries: Vec::with_capacity(rows.iter().map(Vec::len).sum()) };
        for row in rows {
            all.entries.extend(row);
            all.start.push(all.entries.len());
        }
        all
    }

    /// Creates a matrix without rows.
    pub fn with_capacity(capacity: usize) -> Self {
        CsrMatrix { start: vec![0], entries: Vec::with_capacity(capacity) }
    }

    /// Creates a matrix without entries.
    pub fn empty(rows: usize) -> Self {
        CsrMatrix { start: vec![0; rows + 1], entries: Vec::new() }
    }

    /// Returns the list to which entries of the next row are added; [`CsrMatrix::end_row`] ends the row.
    pub fn open_row(&mut self) -> &mut Vec<(usize, f64)> {
        &mut self.entries
    }

    /// Ends a row.
    pub fn end_row(&mut self) {
        self.start.push(self.entries.len());
    }

    /// Number of entries.
    pub fn entries(&self) -> usize {
        self.entries.len()
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.start.len() - 1
    }

    /// One row.
    pub fn row(&self, i: usize) -> &[(usize, f64)] {
        &self.entries[self.start[i]..self.start[i + 1]]
    }

    /// Returns `right` minus the product of row i with a vector, and the sum of the absolute values of all terms.
    pub fn left_of_row(&self, i: usize, right: f64, x: &[f64]) -> (f64, f64) {
        let row = self.row(i);
        let (short, fours) = if row.len() < LONG { (row, &row[..0]) } else { row.split_at(row.len() % 4) };
        let (mut left, mut size) = (right, right.abs());
        for &(j, value) in short {
            left -= value * x[j];
            size += (value * x[j]).abs();
        }
        let (mut sums, mut sizes) = ([0.0; 4], [0.0; 4]);
        for four in fours.chunks_exact(4) {
            for (k, &(j, value)) in four.iter().enumerate() {
                let product = value * x[j];
                sums[k] += product;
                sizes[k] += product.abs();
            }
        }
        (left - sums.iter().sum::<f64>(), size + sizes.iter().sum::<f64>())
    }

    /// Returns the product of row i with a vector.
    pub fn row_dot(&self, i: usize, x: &[f64]) -> f64 {
        let row = self.row(i);
        if row.len() < LONG {
            return row.iter().map(|&(j, value)| value * x[j]).sum();
        }
        let fours = row.chunks_exact(4);
        let rest: f64 = fours.remainder().iter().map(|&(j, value)| value * x[j]).sum();
        let mut sums = [0.0; 4];
        for four in fours {
            sums.iter_mut().zip(four).for_each(|(sum, &(j, value))| *sum += value * x[j]);
        }
        (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
    }
}
