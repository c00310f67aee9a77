//! The rate of change of a problem's data with a parameter, by differences of the data.

use crate::limit::settings::SETTINGS;
use voussoir_core::limit::{LimitJoint, LimitProblem};
use voussoir_core::model::Wrenches;
use voussoir_core::model::geometry::Vec2;

/// Derivatives of the data of a problem with respect to a parameter θ, on one side. Wrenches have the problem's pole.
#[derive(Debug, Clone)]
pub struct DataRate {
    /// Derivatives of the wrenches of each joint's N_0, N_1, T.
    pub wrenches: Vec<[[f64; 3]; 3]>,
    /// Derivatives of the coefficients and the bound of each joint's rows.
    pub rows: Vec<Vec<([f64; 3], f64)>>,
    /// Derivatives of F_t and F_c + F_t of each joint's stress block; zero without a stress block.
    pub blocks: Vec<[f64; 2]>,
    /// Derivatives of the fixed wrenches.
    pub fixed: Wrenches,
    /// Derivatives of the varying wrenches.
    pub varying: Wrenches,
}

/// Returns all data of a problem about a pole, each with its kind (0 coefficients, 1 lengths, 2 forces, 3 moments).
fn data(problem: &LimitProblem, pole: Vec2) -> Vec<(f64, usize)> {
    let mut out = Vec::new();
    for joint in &problem.joints {
        for [x, y, moment] in joint.wrenches(pole) {
            out.extend([(x, 0), (y, 0), (moment, 1)]);
        }
        for row in &joint.strength.rows {
            out.extend(row.normal.map(|x| (x, 0)));
            out.push((row.bound, 2));
        }
        let block = joint.strength.block.map_or([0.0; 2], |block| [block.tension, block.total]);
        out.extend(block.map(|x| (x, 2)));
    }
    let shift = problem.pole - pole;
    for [x, y, moment] in problem.fixed.iter().chain(&problem.varying) {
        out.extend([(*x, 2), (*y, 2), (moment + shift.x * y - shift.y * x, 3)]);
    }
    out
}

/// Returns true if two problems have the same joints, groups and rows.
fn same_topology(a: &LimitProblem, b: &LimitProblem) -> bool {
    let same = |(a, b): (&LimitJoint, &LimitJoint)| {
        let rows = a.strength.rows.iter().map(|row| row.mode).eq(b.strength.rows.iter().map(|row| row.mode));
        let places = (a.joint, a.fill, a.minus, a.plus) == (b.joint, b.fill, b.minus, b.plus);
        places && rows && a.components() == b.components() && a.strength.block.is_some() == b.strength.block.is_some()
    };
    a.group_of == b.group_of && a.joints.len() == b.joints.len() && a.joints.iter().zip(&b.joints).all(same)
}

/// Returns true if the data of two problems are equal to rounding.
pub fn same_data(a: &LimitProblem, b: &LimitProblem) -> bool {
    let close = |((x, kind), (y, _)): (&(f64, usize), &(f64, usize)), scale: &[f64; 4]| {
        (x - y).abs() <= SETTINGS.balanced * scale[*kind]
    };
    let (of_a, of_b) = (data(a, a.pole), data(b, a.pole));
    let scale = scales(&of_a);
    same_topology(a, b) && of_a.iter().zip(&of_b).all(|pair| close(pair, &scale))
}

/// Returns the greatest value of each kind.
fn scales(data: &[(f64, usize)]) -> [f64; 4] {
    let mut scale = [f64::MIN_POSITIVE; 4];
    data.iter().for_each(|(x, kind)| scale[*kind] = scale[*kind].max(x.abs()));
    scale
}

impl DataRate {
    /// Computes derivatives from the problems at θ, θ + `step` and θ + 2 `step`, to second order in the step; for the
    /// left side `step` is counted backwards. An error gives the reason why no rate exists.
    pub fn one_sided(at: &LimitProblem, [near, far]: [&LimitProblem; 2], step: f64) -> Result<Self, String> {
        if !same_topology(at, near) || !same_topology(at, far) {
            return Err("joints, blocks or strengths are others next to the value".into());
        }
        let [here, near, far] = [at, near, far].map(|problem| data(problem, at.pole));
        let scale = scales(&here);
        let mut rates = Vec::with_capacity(here.len());
        for (((x, kind), (y, _)), (z, _)) in here.iter().zip(&near).zip(&far) {
            if (x - 2.0 * y + z).abs() > SETTINGS.jump * scale[*kind] {
                return Err("the data jump at the value: a load comes to stand on another block, or the like".into());
            }
            rates.push((4.0 * y - 3.0 * x - z) / (2.0 * step));
        }
        Ok(Self::gathered(at, &rates))
    }

    /// Creates the derivatives from rates in the order of [`data`].
    fn gathered(at: &LimitProblem, rates: &[f64]) -> Self {
        let mut rates = rates.iter().copied();
        let mut next = || rates.next().unwrap_or(0.0);
        let (mut wrenches, mut rows, mut blocks) = (Vec::new(), Vec::new(), Vec::new());
        for joint in &at.joints {
            wrenches.push([0; 3].map(|_| [0; 3].map(|_| next())));
            rows.push(joint.strength.rows.iter().map(|_| ([0; 3].map(|_| next()), next())).collect());
            blocks.push([0; 2].map(|_| next()));
        }
        let fixed = at.fixed.iter().map(|_| [0; 3].map(|_| next())).collect();
        let varying = at.varying.iter().map(|_| [0; 3].map(|_| next())).collect();
        DataRate { wrenches, rows, blocks, fixed, varying }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::limit::tests::scenes::{Dry, STUCK, block};

    fn with_friction(mu: f64) -> LimitProblem {
        block(1.0, 2.0, Dry { friction: Some(mu), ..STUCK })
    }

    /// The rate of linear data is their slope: friction appears in the rows of sliding with the factor −1.
    #[test]
    fn the_rate_of_linear_data_is_their_slope() {
        let [at, near, far] = [0.5, 0.6, 0.7].map(with_friction);
        let rate = DataRate::one_sided(&at, [&near, &far], 0.1).expect("a rate");
        for (row, (normal, bound)) in at.joints[0].strength.rows.iter().zip(&rate.rows[0]) {
            let slope = if row.mode == voussoir_core::law::FacetMode::Sliding { -1.0 } else { 0.0 };
            assert!((normal[0] - slope).abs() < 1e-12 && normal[2].abs() < 1e-12 && bound.abs() < 1e-12, "{normal:?}");
        }
        assert!(rate.fixed.iter().chain(&rate.varying).flatten().all(|x| x.abs() < 1e-12));
    }

    #[test]
    fn data_that_jump_have_no_rate() {
        let [at, near, far] = [0.5, 0.9, 0.5].map(with_friction);
        assert!(DataRate::one_sided(&at, [&near, &far], 0.1).is_err_and(|why| why.contains("jump")));
    }
}
