//! The linear program of the cutting-plane method (Kelley 1960): the greatest value that linear bounds of a function permit in a
//! box.

use super::dense_simplex::{Equations, Feasibility};

/// A linear upper bound: `value` + `slope` · step.
#[derive(Debug, Clone, PartialEq)]
pub struct Cut {
    /// The bound without a step.
    pub value: f64,
    /// The derivatives of the bound.
    pub slope: Vec<f64>,
}

impl Cut {
    /// Returns the bound at a step.
    pub fn at(&self, step: &[f64]) -> f64 {
        self.value + self.slope.iter().zip(step).map(|(slope, step)| slope * step).sum::<f64>()
    }
}

/// Returns the step in `bounds` (least and greatest entry) at which the least of the cuts is greatest, and this value. If `level`
/// is given, level · step = 0. `None` if there is no cut, no such step, or rounding prevents an answer.
pub fn highest_step(cuts: &[Cut], bounds: &[[f64; 2]], level: Option<&[f64]>) -> Option<(Vec<f64>, f64)> {
    let n = bounds.len();
    let corner: Vec<f64> = bounds.iter().map(|[low, _]| *low).collect();
    let widths: Vec<f64> = bounds.iter().map(|[low, high]| high - low).collect();
    let reach = |cut: &Cut| cut.slope.iter().zip(&widths).map(|(slope, width)| (slope * width).abs()).sum::<f64>();
    let scale = cuts.iter().map(|cut| reach(cut).max(cut.value.abs())).fold(0.0, f64::max).max(f64::MIN_POSITIVE);
    let floor = cuts.iter().map(|cut| cut.at(&corner) - reach(cut)).reduce(f64::min)?;
    // Variables: the share of each width, the rest of it, the value over the floor, the slack of each cut.
    let variables = 2 * n + 1 + cuts.len();
    let (mut rows, mut right) = (Vec::new(), Vec::new());
    for j in 0..n {
        let mut row = vec![0.0; variables];
        (row[j], row[n + j]) = (1.0, 1.0);
        rows.push(row);
        right.push(1.0);
    }
    for (index, cut) in cuts.iter().enumerate() {
        let mut row = vec![0.0; variables];
        (0..n).for_each(|j| row[j] = -cut.slope[j] * widths[j] / scale);
        (row[2 * n], row[2 * n + 1 + index]) = (1.0, 1.0);
        rows.push(row);
        right.push((cut.at(&corner) - floor) / scale);
    }
    if let Some(level) = level {
        let size = level.iter().zip(&widths).map(|(a, width)| (a * width).abs()).fold(0.0, f64::max);
        let mut row = vec![0.0; variables];
        (0..n).for_each(|j| row[j] = level[j] * widths[j] / size);
        rows.push(row);
        right.push(-level.iter().zip(&corner).map(|(a, x)| a * x).sum::<f64>() / size);
    }
    let most = 200 + 50 * rows.len() as u64;
    let mut own = Equations { free: 0, variables, rows, right }.dictionary()?;
    if own.feasible() != Feasibility::Point {
        return None;
    }
    let (value, true) = own.minimise(&[(2 * n, -1.0)], most)? else { return None };
    let step = (0..n).map(|j| corner[j] + widths[j] * own.value(j).clamp(0.0, 1.0)).collect();
    Some((step, floor - value * scale))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The highest point of a roof over a square, with and without a line on which it must be.
    #[test]
    fn the_ridge_of_a_roof_is_found() {
        let cut = |value: f64, x: f64, y: f64| Cut { value, slope: vec![x, y] };
        let roof = [cut(5.0, 2.0, 1.0), cut(4.0, -1.0, 1.0), cut(9.0, 0.0, -2.0)];
        let (step, value) = highest_step(&roof, &[[-4.0, 4.0], [-4.0, 4.0]], None).expect("a program");
        // 5 + 2x + y = 4 - x + y = 9 - 2y
        assert!((step[0] + 1.0 / 3.0).abs() < 1e-9 && (step[1] - 14.0 / 9.0).abs() < 1e-9, "{step:?}");
        assert!((value - 53.0 / 9.0).abs() < 1e-9, "{value}");
        let (step, value) = highest_step(&roof, &[[-4.0, 4.0], [-4.0, 4.0]], Some(&[1.0, 1.0])).expect("a program");
        assert!((step[0] + step[1]).abs() < 1e-9 && (value - roof[1].at(&step)).abs() < 1e-9, "{step:?} {value}");
        assert!((step[0] + 1.0 / 3.0).abs() < 1e-9, "{step:?}");
        assert!(highest_step(&[], &[[0.0, 1.0]], None).is_none());
        assert!(highest_step(&roof, &[[1.0, 2.0], [1.0, 2.0]], Some(&[1.0, 1.0])).is_none());
    }
}
