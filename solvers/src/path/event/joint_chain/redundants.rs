//! The few remaining equations of a rate problem: compatibility of the cycles, and the twists of weak joints.

use super::factors::Factor;
use super::rates::ChainRates;
use super::sections::Sections;
use crate::settings::SETTINGS;
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

/// Greatest number of joints with a separate twist; with more, the whole system is solved.
pub const MOST_WEAK: usize = 24;

/// Returns the twist of a joint: the last three of its unknowns.
fn twist(unknowns: &[f64]) -> Vector3<f64> {
    Vector3::from_column_slice(&unknowns[unknowns.len() - 3..])
}

/// The rates whose cycles the redundants close: for λ̇ = 1, or for the residual in a step of refinement.
pub enum Open<'a> {
    /// The load alone.
    Load,
    /// Rates of the joints, and the additions from right-hand sides of their own equations.
    Refined(&'a [Vec<f64>], &'a [DMatrix<f64>]),
    /// Rates whose joints satisfy their own equations with the previous resultants.
    Corrected(&'a ChainRates),
}

/// Returns the factors of the columns of all responses that close the cycles and give weak joints their twists:
/// redundants, then λ̇, then twists of the `weak` joints. `None` near a mechanism.
pub fn closing(
    sections: &Sections,
    factors: &[Factor],
    responses: &[DMatrix<f64>],
    weak: &[usize],
    open: &Open,
) -> Option<DVector<f64>> {
    let n = 3 * sections.cycles;
    let size = n + 3 * weak.len();
    let column = |j: usize| if j < n { j } else { j + 1 };
    let mut matrix: DMatrix<f64> = DMatrix::zeros(size, size);
    let mut right: DVector<f64> = DVector::zeros(size);
    for (e, factor) in factors.iter().enumerate() {
        let section = &sections.all[factor.joint.section];
        let to_origin: Matrix3<f64> = section.to_centre.transpose();
        let w = weak.iter().position(|w| *w == e);
        let height = responses[e].nrows();
        let by = |j: usize| twist(&responses[e].as_slice()[..height * (j + 1)]);
        let (constant, before) = match open {
            Open::Load => (by(n), Vector3::zeros()),
            Open::Refined(rates, added) => (twist(added[e].as_slice()), twist(&rates[e])),
            Open::Corrected(rates) => {
                let given = w.map(|w| Vector3::from_fn(|i, _| rates.share[n + 1 + 3 * w + i]));
                let twist = twist(&rates.own[e]);
                (twist - given.unwrap_or(twist), given.unwrap_or(twist))
            }
        };
        let shares = || section.shares.iter().enumerate().filter(|s| *s.1 != 0.0);
        for (j, sums) in matrix.as_mut_slice().chunks_exact_mut(size.max(1)).enumerate() {
            let own = by(column(j));
            // The twist of a weak joint moves only the joints that are coupled with it.
            if own.iter().all(|v| *v == 0.0) {
                continue;
            }
            let at_origin = to_origin * own;
            shares().for_each(|(k, share)| (0..3).for_each(|i| sums[3 * k + i] += share * at_origin[i]));
            w.into_iter().for_each(|w| sums[n + 3 * w..][..3].copy_from_slice(own.as_slice()));
        }
        let at_origin = to_origin * (constant + before);
        shares().for_each(|(k, share)| (0..3).for_each(|i| right[3 * k + i] -= share * at_origin[i]));
        for (i, at) in w.into_iter().flat_map(|w| n + 3 * w..n + 3 * w + 3).enumerate() {
            matrix[(at, at)] -= 1.0;
            right[at] = -constant[i];
        }
    }
    let solved = solved(matrix, right)?;
    let load = if matches!(open, Open::Load) { 1.0 } else { 0.0 };
    Some(DVector::from_fn(size + 1, |j, _| match j.cmp(&n) {
        std::cmp::Ordering::Less => solved[j],
        std::cmp::Ordering::Equal => load,
        std::cmp::Ordering::Greater => solved[j - 1],
    }))
}

/// Solves a small system: rows, then columns scaled to one, full pivoting, one step of refinement. `None` if the matrix
/// is singular to rounding.
fn solved(mut matrix: DMatrix<f64>, mut right: DVector<f64>) -> Option<DVector<f64>> {
    if right.is_empty() {
        return Some(right);
    }
    let usable = |size: &f64| *size > 0.0 && size.is_finite();
    for (i, right) in right.iter_mut().enumerate() {
        let size = Some(matrix.row(i).amax()).filter(usable)?;
        matrix.row_mut(i).unscale_mut(size);
        *right /= size;
    }
    let mut columns = Vec::with_capacity(right.len());
    for mut column in matrix.column_iter_mut() {
        let size = Some(column.amax()).filter(usable)?;
        column.unscale_mut(size);
        columns.push(size);
    }
    let lu = matrix.clone().full_piv_lu();
    let (least, greatest) = lu
        .lu_internal()
        .diagonal()
        .iter()
        .fold((f64::INFINITY, 0.0f64), |(least, greatest), v| (least.min(v.abs()), greatest.max(v.abs())));
    if least <= SETTINGS.shift() * greatest {
        return None;
    }
    let mut x = lu.solve(&right)?;
    x += lu.solve(&(&right - &matrix * &x))?;
    let size = x.amax().max(right.amax());
    let left = (right - matrix * &x).amax();
    x.iter_mut().zip(columns).for_each(|(x, size)| *x /= size);
    (left <= SETTINGS.residual() * size && x.iter().all(|v| v.is_finite())).then_some(x)
}
