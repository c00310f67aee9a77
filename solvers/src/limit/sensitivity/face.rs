//! The optimal face of a limit problem around one of its fields, in scaled units.

use super::data::DataRate;
use super::program::{Direction, Program};
use super::row::{FaceRow, Source};
use crate::limit::settings::SETTINGS;
use nalgebra::{DMatrix, DVector};
use voussoir_core::limit::{JointForce, LimitProblem, Velocity};

/// Greatest number of forces: larger scenes take too long.
const MAX_FORCES: usize = 900;

/// All fields that carry the limit load, and all mechanisms at it, described by one field and one mechanism.
#[derive(Debug)]
pub struct OptimalFace<'a> {
    problem: &'a LimitProblem,
    factor: f64,
    /// First force of each joint, and the number of all forces.
    offsets: Vec<usize>,
    /// r̂ / `force`.
    field: DVector<f64>,
    rows: Vec<FaceRow>,
    program: Program,
    /// Greatest force \[N\].
    force: f64,
    /// Size of the varying loads \[N\].
    load: f64,
}

/// Returns an orthonormal basis of the null space, the pseudo-inverse, and the rank.
fn null_space(matrix: &DMatrix<f64>) -> Result<(DMatrix<f64>, DMatrix<f64>, usize), String> {
    let (rows, columns) = matrix.shape();
    // Zero rows make the decomposition return all right singular vectors.
    let padded = matrix.clone().resize_vertically(rows.max(columns), 0.0);
    let svd = padded.try_svd(false, true, f64::EPSILON, 10_000).ok_or("singular values were not found")?;
    let v = svd.v_t.ok_or("singular values were not found")?;
    let greatest = svd.singular_values.max().max(f64::MIN_POSITIVE);
    let (null, full): (Vec<usize>, Vec<usize>) =
        (0..columns).partition(|&i| svd.singular_values[i] <= SETTINGS.negligible * greatest);
    let basis = DMatrix::from_fn(columns, null.len(), |i, j| v[(null[j], i)]);
    let mut inverse = DMatrix::zeros(columns, rows);
    // Uses the images of the right vectors: without full rank the left vectors may belong to other right vectors.
    for &k in &full {
        let own = v.row(k).transpose();
        let image = matrix * &own;
        inverse += own * image.transpose() / image.norm_squared();
    }
    Ok((basis, inverse, full.len()))
}

impl<'a> OptimalFace<'a> {
    /// Creates the face around a field that carries `factor` and a mechanism at it, from the answer of a limit solver.
    /// An error gives the reason why no derivatives exist.
    pub fn new(
        problem: &'a LimitProblem,
        factor: f64,
        forces: &[JointForce],
        motion: &[Velocity],
    ) -> Result<Self, String> {
        if problem.has_envelopes() {
            return Err("several facets bound sliding in one sense".into());
        }
        let mut offsets = vec![0];
        for joint in &problem.joints {
            offsets.push(offsets[offsets.len() - 1] + joint.components());
        }
        let count = offsets[problem.joints.len()];
        if count > MAX_FORCES {
            return Err(format!("more than {MAX_FORCES} forces in joints"));
        }
        let all = |force: &JointForce| [force.normal[0], force.normal[1], force.shear];
        let force = forces.iter().flat_map(all).fold(problem.magnitude(&problem.fixed), |m, x| m.max(x.abs()));
        let load = problem.magnitude(&problem.varying);
        if !(force > 0.0 && load > 0.0 && force.is_finite() && load.is_finite()) {
            return Err("nothing is loaded".into());
        }
        let mut field = DVector::zeros(count);
        for (joint, of) in forces.iter().enumerate().take(problem.joints.len()) {
            let own = all(of);
            (offsets[joint]..offsets[joint + 1]).enumerate().for_each(|(k, i)| field[i] = own[k] / force);
        }
        let mut face =
            OptimalFace { problem, factor, offsets, field, rows: Vec::new(), program: Program::default(), force, load };
        face.rows = (0..problem.joints.len()).flat_map(|joint| face.rows_of(joint)).collect();
        face.program = face.prepared(motion)?;
        Ok(face)
    }

    /// Returns the wrenches on groups as one vector; moments are divided by the length.
    fn stacked(&self, wrench: impl Fn(usize, usize) -> f64) -> DVector<f64> {
        let unit = |i: usize| if i == 2 { 1.0 / self.problem.length } else { 1.0 };
        DVector::from_fn(3 * self.problem.groups, |row, _| wrench(row / 3, row % 3) * unit(row % 3))
    }

    /// Returns E from the wrenches of each joint.
    fn equilibrium(&self, wrenches: impl Fn(usize) -> [[f64; 3]; 3]) -> DMatrix<f64> {
        let mut matrix = DMatrix::zeros(3 * self.problem.groups, self.offsets[self.problem.joints.len()]);
        for (index, joint) in self.problem.joints.iter().enumerate() {
            let own = wrenches(index);
            for (k, column) in (self.offsets[index]..self.offsets[index + 1]).enumerate() {
                for (group, sense) in [(joint.minus, -1.0), (joint.plus, 1.0)] {
                    let Some(group) = group else { continue };
                    for i in 0..3 {
                        let unit = if i == 2 { 1.0 / self.problem.length } else { 1.0 };
                        matrix[(3 * group + i, column)] += sense * own[k][i] * unit;
                    }
                }
            }
        }
        matrix
    }

    fn rows_of(&self, joint: usize) -> Vec<FaceRow> {
        let (first, components) = (self.offsets[joint], self.offsets[joint + 1] - self.offsets[joint]);
        let own = |k: usize| if k < components { self.field[first + k] } else { 0.0 };
        let strength = &self.problem.joints[joint].strength;
        let row = |source, normal: [f64; 3], slack: f64| {
            let length = normal[..components].iter().map(|a| a * a).sum::<f64>().sqrt();
            (length > 0.0).then(|| {
                let mut coefficients = DVector::zeros(self.field.len());
                (0..components).for_each(|k| coefficients[first + k] = normal[k] / length);
                FaceRow { joint, source, scale: 1.0 / length, coefficients, slack: (slack / length).max(0.0) }
            })
        };
        let linear = strength.rows.iter().enumerate().filter_map(|(index, of)| {
            let carried: f64 = (0..3).map(|k| of.normal[k] * own(k)).sum();
            row(Source::Row(index), of.normal, of.bound / self.force - carried)
        });
        let ends = strength.block.into_iter().flat_map(|block| [0, 1].map(|end| (block, end)));
        let blocks = ends.filter_map(|(block, end)| {
            let (tension, total) = (block.tension / self.force, block.total / self.force);
            let sum = own(0) + own(1) + tension;
            let normal = [0, 1].map(|k| 2.0 * sum / total - if k == end { 2.0 } else { 0.0 });
            row(Source::Block(end), [normal[0], normal[1], 0.0], 2.0 * own(end) + tension - sum * sum / total)
        });
        linear.chain(blocks).collect()
    }

    /// Computes the parts that do not depend on the parameter.
    fn prepared(&self, motion: &[Velocity]) -> Result<Program, String> {
        let problem = self.problem;
        let equilibrium = self.equilibrium(|joint| problem.joints[joint].wrenches(problem.pole));
        let (steps, inverse, rank) = null_space(&equilibrium)?;
        if rank < 3 * problem.groups {
            return Err("some blocks are held by nothing".into());
        }
        let count = self.field.len();
        // If a joint moves in the mechanism, the difference of a field from r̂ does no work at it, and a yielding stress
        // block keeps its forces.
        let mut held: Vec<DVector<f64>> = Vec::new();
        let jumps: Vec<[f64; 3]> = (0..problem.joints.len()).map(|joint| self.jump(joint, motion)).collect();
        let greatest = jumps.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
        let mut pinned = vec![false; problem.joints.len()];
        for (joint, jump) in jumps.iter().enumerate() {
            let first = self.offsets[joint];
            let jump = jump.map(|x| if x.abs() <= SETTINGS.moves * greatest { 0.0 } else { x });
            if jump == [0.0; 3] {
                continue;
            }
            let unit = |k: usize, x: f64| DVector::from_fn(count, |i, _| if i == first + k { x } else { 0.0 });
            let components = self.offsets[joint + 1] - first;
            held.push((0..components).map(|k| unit(k, jump[k] / greatest)).sum());
            if problem.joints[joint].strength.block.is_some() && jump[..2] != [0.0; 2] {
                held.extend([unit(0, 1.0), unit(1, 1.0)]);
                pinned[joint] = true;
            }
        }
        let mut fixed = equilibrium.clone().resize_vertically(3 * problem.groups + held.len(), 0.0);
        for (row, of) in held.iter().enumerate() {
            fixed.row_mut(3 * problem.groups + row).copy_from(&of.transpose());
        }
        let (spread, _, _) = null_space(&fixed)?;
        let curved = |joint: usize| problem.joints[joint].strength.block.is_some() && !pinned[joint];
        let moved = |joint: usize| spread.rows(self.offsets[joint], 2).amax() > SETTINGS.moves;
        if spread.ncols() > 0 && (0..problem.joints.len()).any(|joint| curved(joint) && moved(joint)) {
            return Err("the field is not unique in joints that may crush".into());
        }
        let load = self.stacked(|group, i| problem.varying[group][i]) / self.load;
        let tight: Vec<usize> = (0..self.rows.len()).filter(|&row| self.rows[row].slack <= SETTINGS.moves).collect();
        let program = Program { spread, steps, response: -(&inverse * load), inverse, tight };
        program.stable(&self.rows)?;
        Ok(program)
    }

    /// Returns the opening of both ends and the slip of a joint in a motion.
    fn jump(&self, joint: usize, motion: &[Velocity]) -> [f64; 3] {
        let of = |group: Option<usize>| group.and_then(|group| motion.get(group)).copied().unwrap_or([0.0; 3]);
        let own = &self.problem.joints[joint];
        let (minus, plus) = (of(own.minus), of(own.plus));
        own.wrenches(self.problem.pole).map(|wrench| (0..3).map(|i| wrench[i] * (plus[i] - minus[i])).sum())
    }

    /// Returns the derivative of the limit load for the change of the data with this rate. An error gives the reason if
    /// it does not exist.
    pub fn derivative(&self, rate: &DataRate) -> Result<f64, String> {
        let matrix = self.equilibrium(|joint| rate.wrenches[joint]);
        let loads = self.stacked(|group, i| rate.fixed[group][i] + self.factor * rate.varying[group][i]) / self.force;
        let tight = self.program.tight.iter().map(|&row| self.row_rate(&self.rows[row], rate));
        let direction = Direction { residual: &matrix * &self.field + loads, matrix, rows: tight.collect() };
        Ok(self.program.greatest(&self.rows, &direction)? * self.force / self.load)
    }

    /// Returns A′ r̂ − b′ of a row, and A′ over all forces.
    fn row_rate(&self, row: &FaceRow, rate: &DataRate) -> (f64, DVector<f64>) {
        let first = self.offsets[row.joint];
        let components = self.offsets[row.joint + 1] - first;
        let own = |k: usize| if k < components { self.field[first + k] } else { 0.0 };
        let (normal, constant) = match row.source {
            Source::Row(index) => {
                let (normal, bound) = rate.rows[row.joint][index];
                (normal, -bound / self.force)
            }
            Source::Block(end) => {
                let block = self.problem.joints[row.joint].strength.block.map_or([0.0; 2], |b| [b.tension, b.total]);
                let [tension, total] = block.map(|x| x / self.force);
                let [tension_rate, total_rate] = rate.blocks[row.joint].map(|x| x / self.force);
                let normal =
                    [0, 1].map(|k| (2.0 * tension_rate - if k == end { 2.0 * total_rate } else { 0.0 }) / total);
                let constant = (2.0 * tension * tension_rate - total_rate * tension) / total - tension_rate;
                // Derivative of ((N + F_t)² − (F_c + F_t)(2 N_i + F_t)) / (F_c + F_t) at a zero of the row.
                ([normal[0], normal[1], 0.0], constant)
            }
        };
        let mut coefficients = DVector::zeros(self.field.len());
        (0..components).for_each(|k| coefficients[first + k] = normal[k] * row.scale);
        let carried: f64 = (0..3).map(|k| normal[k] * own(k)).sum();
        ((carried + constant) * row.scale, coefficients)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A N = 0 with orthonormal N, A A⁺ A = A, and the rank of a product of thin matrices is their width.
    #[test]
    fn the_null_space_and_the_inverse_belong_to_the_matrix() {
        for (rows, columns, width) in [(3, 5, 2), (5, 3, 3), (4, 4, 1)] {
            let value = |seed: usize| move |i: usize, j: usize| ((7 * i * i + 11 * j + 5 * i * j + seed) as f64).sin();
            let matrix = DMatrix::from_fn(rows, width, value(1)) * DMatrix::from_fn(width, columns, value(2));
            let (null, inverse, rank) = null_space(&matrix).expect("singular values");
            assert_eq!((rank, null.ncols()), (width, columns - width));
            assert!((&matrix * &null).amax() < 1e-13);
            assert!((null.transpose() * &null - DMatrix::identity(columns - width, columns - width)).amax() < 1e-13);
            assert!((&matrix * inverse * &matrix - &matrix).amax() < 1e-12);
        }
    }
}
