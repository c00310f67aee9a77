//! The least factor with forces that the modes of the points allow: a linear program.

use super::points::{Force, Mode, Points};
use crate::optimise::dense_simplex::{Equations, Feasibility};
use crate::space::settings::BRANCHING;

/// The result of statics in a part of the search.
pub enum Statics {
    /// No forces with a factor up to the greatest one exist.
    Impossible,
    /// The least factor, with its forces.
    Least(f64, Vec<Force>),
    /// Rounding or the limit of pivots prevented an answer.
    Undecided,
}

/// Returns the least factor ≥ 0 of forces that the modes allow, if it is at most `greatest`. Adds the work to `work`.
pub fn least(points: &Points, modes: &[Mode], greatest: f64, work: &mut u64) -> Statics {
    let generators: Vec<Vec<Force>> =
        points.points.iter().zip(modes).map(|(point, mode)| point.generators(*mode)).collect();
    let count: usize = generators.iter().map(Vec::len).sum();
    // The shares of all forces, then the factor and its distance from the greatest one.
    let (factor, variables) = (count, count + 2);
    let mut rows: Vec<Vec<f64>> = vec![vec![0.0; variables]; points.base.len() + 1];
    let own = points.points.iter().zip(&generators);
    for (column, (point, force)) in own.flat_map(|(point, own)| own.iter().map(move |f| (point, f))).enumerate() {
        for (body, row) in rows.iter_mut().take(points.base.len()).enumerate() {
            row[column] = (0..3).map(|k| point.jumps[k][body] * force[k]).sum();
        }
    }
    rows.iter_mut().zip(&points.varying).for_each(|(row, p)| row[factor] = *p);
    let mut right: Vec<f64> = points.base.iter().map(|w| -w).collect();
    rows[points.base.len()][factor..].fill(1.0);
    right.push(greatest);
    // Most entries are zero and not swept.
    *work += (rows.len() * rows.len() * variables / 4) as u64;
    let Some(mut dictionary) = (Equations { free: 0, variables, rows, right }).dictionary() else {
        return Statics::Impossible;
    };
    let found = match dictionary.feasible() {
        Feasibility::Reason(_) => Statics::Impossible,
        Feasibility::Undecided => Statics::Undecided,
        Feasibility::Point => match dictionary.minimise(&[(factor, 1.0)], BRANCHING.pivots) {
            Some((value, true)) => {
                let mut column = 0;
                let mut force = |own: &Vec<Force>| {
                    own.iter().fold([0.0; 3], |sum, unit| {
                        let share = dictionary.value(column).max(0.0);
                        column += 1;
                        std::array::from_fn(|k| sum[k] + share * unit[k])
                    })
                };
                Statics::Least(value.max(0.0), generators.iter().map(&mut force).collect())
            }
            _ => Statics::Undecided,
        },
    };
    *work += dictionary.work();
    found
}
