//! The rows that bound the forces of one joint, and the inverse square root of their weighted normal matrix.

use crate::limit::settings::SETTINGS;

/// Greatest number of rows of a joint.
pub const ROWS: usize = 4;

/// The rows split into a basis and at most one other row.
#[derive(Debug, Clone, PartialEq)]
struct Split {
    /// The row outside the basis, if any.
    over: Option<usize>,
    /// Rows of the basis.
    basis: [usize; 3],
    /// Inverse of the matrix of the basis, by rows.
    inverse: [[f64; 3]; 3],
    /// The other row as a combination of the basis.
    shares: [f64; 3],
}

/// The normals of the rows of a joint, scaled to greatest entry 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Cone {
    /// Number of forces.
    pub forces: usize,
    /// Normals; entries are zero for forces that the joint does not have.
    pub normals: Vec<[f64; 3]>,
    /// The normals by forces; entries are zero for rows that the joint does not have.
    columns: [[f64; ROWS]; 3],
    splits: Vec<Split>,
}

impl Cone {
    /// Creates the cone of normals. `None` if more than one row is outside a basis.
    pub fn new(forces: usize, normals: Vec<[f64; 3]>) -> Option<Self> {
        if normals.len() > ROWS || forces > 3 {
            return None;
        }
        // Forces that a joint does not have, and unbounded forces, get extra rows at the end.
        let mut all = normals.clone();
        let independent = |rows: &[[f64; 3]], row: &[f64; 3]| orthonormal(rows, Some(row)).1;
        for k in 0..3 {
            let mut unit = [0.0; 3];
            unit[k] = 1.0;
            if independent(&all, &unit) && (k >= forces || basis_size(&all) < 3) {
                all.push(unit);
            }
        }
        let mut splits = Vec::new();
        match all.len() {
            3 => splits.push(split(&all, None)?),
            4 => splits.extend((0..4).filter_map(|over| split(&all, Some(over)))),
            _ => return None,
        }
        let columns = [0, 1, 2].map(|k| std::array::from_fn(|row| normals.get(row).map_or(0.0, |normal| normal[k])));
        (!splits.is_empty()).then_some(Cone { forces, normals, columns, splits })
    }

    /// Returns A x.
    #[inline(always)]
    pub fn values(&self, x: &[f64; 3]) -> [f64; ROWS] {
        combination(&self.columns, x)
    }

    /// Returns Aᵀ z.
    #[inline(always)]
    pub fn weighted(&self, z: &[f64; ROWS]) -> [f64; 3] {
        self.columns.map(|column| (column[0] * z[0] + column[1] * z[1]) + (column[2] * z[2] + column[3] * z[3]))
    }

    /// Returns R of (Aᵀ W A)⁻¹ = R Rᵀ by rows, and A R by columns. Weights may differ by any power of ten: the row of
    /// least weight is outside the basis, so that no large numbers are subtracted, also in A R.
    pub fn root(&self, weights: &[f64; ROWS]) -> ([[f64; 3]; 3], [[f64; ROWS]; 3]) {
        let weight = |row: usize| if row < self.normals.len() { weights[row] } else { SETTINGS.unbounded };
        let least = |split: &Split| split.over.map_or(0.0, weight);
        let mut split = &self.splits[0];
        for other in &self.splits[1..] {
            if least(other) < least(split) {
                split = other;
            }
        }
        // (W_B + w c cᵀ)⁻¹ = D (I − β u uᵀ)² D with D = W_B^(−1/2), u = √w D c, β = (1 − 1/√(1 + |u|²))/|u|².
        let inverse = split.basis.map(|row| 1.0 / weight(row).sqrt());
        let size = least(split).sqrt();
        let u: [f64; 3] = std::array::from_fn(|i| size * inverse[i] * split.shares[i]);
        let squared = u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
        let beta = if squared > SETTINGS.moves {
            (1.0 - 1.0 / (1.0 + squared).sqrt()) / squared
        } else {
            0.5 - 0.375 * squared
        };
        let mut root = [[0.0; 3]; 3];
        for (line, of) in root.iter_mut().zip(&split.inverse).take(self.forces) {
            let scaled: [f64; 3] = std::array::from_fn(|i| of[i] * inverse[i]);
            let along = beta * (scaled[0] * u[0] + scaled[1] * u[1] + scaled[2] * u[2]);
            *line = std::array::from_fn(|i| scaled[i] - along * u[i]);
        }
        let mut columns = [[0.0; ROWS]; 3];
        for (k, column) in columns.iter_mut().enumerate() {
            for (i, row) in split.basis.iter().enumerate() {
                column[*row] = inverse[i] * (f64::from(u8::from(i == k)) - beta * u[i] * u[k]);
            }
            if let Some(over) = split.over {
                column[over] = split.shares[k] * inverse[k] * (1.0 - beta * squared);
            }
            // Extra rows of unbounded forces do not belong to the joint.
            column[self.normals.len()..].fill(0.0);
        }
        (root, columns)
    }
}

/// Returns orthonormal vectors that span rows, and true if `other` is not in their span.
fn orthonormal(rows: &[[f64; 3]], other: Option<&[f64; 3]>) -> (Vec<[f64; 3]>, bool) {
    let mut basis: Vec<[f64; 3]> = Vec::new();
    let mut added = false;
    for row in rows.iter().chain(other) {
        let size = dot(row, row).sqrt();
        let mut rest = *row;
        for _ in 0..2 {
            for known in &basis {
                let along = dot(known, &rest);
                (0..3).for_each(|k| rest[k] -= along * known[k]);
            }
        }
        let left = dot(&rest, &rest).sqrt();
        added = left > SETTINGS.independent * size;
        if added {
            basis.push(rest.map(|v| v / left));
        }
    }
    (basis, added)
}

fn basis_size(rows: &[[f64; 3]]) -> usize {
    orthonormal(rows, None).0.len()
}

/// Returns orthonormal vectors that span rows.
pub fn span(rows: &[[f64; 3]]) -> Vec<[f64; 3]> {
    orthonormal(rows, None).0
}

/// Returns the sum of three columns times numbers.
#[inline(always)]
pub fn combination(columns: &[[f64; ROWS]; 3], x: &[f64; 3]) -> [f64; ROWS] {
    std::array::from_fn(|row| columns[0][row] * x[0] + columns[1][row] * x[1] + columns[2][row] * x[2])
}

/// Returns a · b.
#[inline(always)]
pub fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn split(all: &[[f64; 3]], over: Option<usize>) -> Option<Split> {
    let basis: Vec<usize> = (0..all.len()).filter(|row| Some(*row) != over).collect();
    let basis: [usize; 3] = basis.try_into().ok()?;
    if basis_size(&basis.map(|row| all[row])) < 3 {
        return None;
    }
    let matrix = nalgebra::Matrix3::from_fn(|i, k| all[basis[i]][k]);
    let inverse = matrix.try_inverse()?;
    let shares = over.map_or([0.0; 3], |over| {
        let row = nalgebra::RowVector3::from(all[over]) * inverse;
        [row[0], row[1], row[2]]
    });
    let inverse = std::array::from_fn(|i| std::array::from_fn(|k| inverse[(i, k)]));
    Some(Split { over, basis, inverse, shares })
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Matrix3;

    fn friction(mu: f64) -> Vec<[f64; 3]> {
        vec![[-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [-mu, -mu, 1.0], [-mu, -mu, -1.0]]
    }

    /// For all weights, R Rᵀ times the normal matrix is the identity within the rounding of the product.
    #[test]
    fn the_root_inverts_the_normal_matrix() {
        let cases = [
            (3, friction(0.65), [1.0, 2.0, 3.0, 4.0]),
            (3, friction(0.65), [1e4, 1e-4, 1e-4, 1e-3]),
            (3, friction(0.1), [1e-4, 1e-3, 1e3, 1e-4]),
            (3, friction(0.65)[..3].to_vec(), [0.3, 2.0, 7.0, 0.0]),
            (2, vec![[-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]], [3.0, 1e5, 0.0, 0.0]),
            (1, vec![[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]], [3.0, 0.25, 0.0, 0.0]),
        ];
        for (forces, normals, weights) in cases {
            let cone = Cone::new(forces, normals.clone()).unwrap();
            let (root, columns) = cone.root(&weights);
            for (row, normal) in normals.iter().enumerate() {
                for (k, column) in columns.iter().enumerate() {
                    let product: f64 = (0..3).map(|i| normal[i] * root[i][k]).sum();
                    let size: f64 = (0..3).map(|i| (normal[i] * root[i][k]).abs()).sum();
                    assert!((column[row] - product).abs() <= 1e-14 * size, "{forces} {weights:?} {columns:?}");
                }
            }
            assert!(columns.iter().all(|column| column[normals.len()..].iter().all(|entry| *entry == 0.0)));
            let root = Matrix3::from_fn(|i, k| root[i][k]);
            let mut normal = Matrix3::zeros();
            for (row, weight) in normals.iter().zip(weights) {
                let row = nalgebra::Vector3::from(*row);
                normal += row * row.transpose() * weight;
            }
            let product = root.transpose() * normal * root;
            // In unbounded directions the product is zero.
            for i in 0..3 {
                let own = product.row(i).iter().fold(0.0f64, |m, v| m.max(v.abs()));
                assert!(i >= forces || (product[(i, i)] - 1.0).abs() < 1e-10, "{forces} {weights:?} {product}");
                assert!(own < 1.0 + 1e-10, "{forces} {weights:?} {product}");
            }
        }
    }

    /// A soft spring holds shear that cannot slide.
    #[test]
    fn forces_without_rows_have_soft_springs() {
        let cone = Cone::new(3, friction(0.65)[..2].to_vec()).unwrap();
        let (root, _) = cone.root(&[1.0, 4.0, 0.0, 0.0]);
        assert!(
            (root[2][2] - SETTINGS.unbounded.powf(-0.5)).abs() < 1.0
                && root[0][0].abs() == 1.0
                && root[1][1].abs() == 0.5
        );
    }

    /// A span has as many orthonormal vectors as independent rows, and contains each row.
    #[test]
    fn a_span_holds_its_rows() {
        for (mu, size) in [(0.5, 3), (0.0, 3)] {
            let rows = friction(mu);
            let basis = span(&rows);
            assert_eq!(basis.len(), size);
            for (i, a) in basis.iter().enumerate() {
                basis
                    .iter()
                    .enumerate()
                    .for_each(|(j, b)| assert!((dot(a, b) - f64::from(u8::from(i == j))).abs() < 1e-14));
            }
        }
        let line = [[1.0, 2.0, 2.0], [-0.5, -1.0, -1.0]];
        assert_eq!(span(&line).len(), 1);
        assert!((dot(&span(&line)[0], &line[0]).abs() - 3.0).abs() < 1e-14);
    }

    /// Each force is weighted by its column.
    #[test]
    fn a_combination_weights_columns() {
        let columns = [1.0, 10.0, 100.0].map(|v| [v; ROWS]);
        assert_eq!(combination(&columns, &[1.0, 2.0, 3.0]), [321.0; ROWS]);
    }
}
