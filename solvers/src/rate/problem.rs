//! The rate problem over the active set: the contact points that may change their mode.
//!
//! All other points keep their modes, so that forces and gaps of the active points are linear: ṙ = S ġ + s λ̇. Each of
//! them must have a mode of its law that its rate does not violate ([`active_point`](crate::contact::active_point)). A
//! given combination of modes is a small linear system; if it is singular with one null vector, that vector is a
//! mechanism. Sources: Klarbring (1990), Ing.-Arch. 60; Björkman (1992) on rate problems with friction.

use crate::contact::active_point::ActivePoint;
use crate::contact::mode::ContactMode;
use crate::settings::SETTINGS;
use nalgebra::{DMatrix, DVector};

/// A solution of the rate problem.
#[derive(Debug, Clone)]
pub struct Rate {
    /// 1, 0 or −1: the sense of λ.
    pub factor: f64,
    /// Mode of each point.
    pub modes: Vec<ContactMode>,
    /// ġ of each point.
    pub gaps: Vec<[f64; 2]>,
}

impl Rate {
    /// Returns true if the gaps of another rate are the same within a tolerance relative to the greatest gap.
    pub fn is_same(&self, other: &Rate, tolerance: f64) -> bool {
        let size = other.gaps.iter().flatten().fold(1e-300, |a: f64, g| a.max(g.abs()));
        let mut both = self.gaps.iter().flatten().zip(other.gaps.iter().flatten());
        self.factor == other.factor && both.all(|(a, b)| (a - b).abs() <= tolerance * size)
    }
}

/// The rate problem: ṙ = `s` ġ + `load_rate` λ̇ over the points.
#[derive(Debug)]
pub struct RateProblem<'a> {
    /// The active set.
    pub points: Vec<ActivePoint<'a>>,
    /// S.
    pub s: DMatrix<f64>,
    /// s.
    pub load_rate: DVector<f64>,
    /// The greatest force that λ̇ = 1 causes at any point of the structure if all points are held: forces far below it are rounding.
    pub load_force: f64,
    /// p·q̇ for a unit of λ̇ if all points are held; 0 if it is not known.
    pub load_flexibility: f64,
    /// Products of the motions (and factors) of the structure for unit gap rates and, last, for λ̇ = 1: the square of the
    /// length of a rate. If it is not known, gap rates measure a rate.
    pub metric: Option<DMatrix<f64>>,
    /// True if a support moves: then forces may be constant while λ changes, and their rates are rounding errors.
    pub settles: bool,
}

/// The solved linear system of a combination of modes.
pub struct Attempt {
    /// Multipliers, or gap rates of open points, in the order of the modes.
    unknowns: Vec<f64>,
    /// ġ.
    pub gaps: DVector<f64>,
    forces: DVector<f64>,
    /// True if it is a null vector.
    pub singular: bool,
}

impl Attempt {
    fn gaps_of_points(&self) -> Vec<[f64; 2]> {
        self.gaps.as_slice().chunks_exact(2).map(|gap| [gap[0], gap[1]]).collect()
    }
}

/// A direction at a point.
type At = (usize, [f64; 2]);

impl RateProblem<'_> {
    /// Returns the directions of ġ and the functionals of ṙ of a combination of modes, in the units of the points.
    fn flows_and_rows(&self, modes: &[ContactMode]) -> (Vec<At>, Vec<At>) {
        let (mut flows, mut rows) = (Vec::new(), Vec::new());
        for (k, (point, mode)) in self.points.iter().zip(modes).enumerate() {
            let unit = point.stiffness.sqrt();
            flows.extend(mode.flows(point.facets).into_iter().map(|f| (k, f.map(|x| x / unit))));
            rows.extend(mode.force_rows(point.facets).into_iter().map(|r| (k, r.map(|x| x / unit))));
        }
        (flows, rows)
    }

    fn matrix(&self, flows: &[At], rows: &[At]) -> DMatrix<f64> {
        let entry = |(i, a): &At, (j, d): &At| {
            a[0] * (self.s[(2 * i, 2 * j)] * d[0] + self.s[(2 * i, 2 * j + 1)] * d[1])
                + a[1] * (self.s[(2 * i + 1, 2 * j)] * d[0] + self.s[(2 * i + 1, 2 * j + 1)] * d[1])
        };
        DMatrix::from_fn(flows.len(), flows.len(), |i, j| entry(&rows[i], &flows[j]))
    }

    /// Returns the flows of a combination of modes and its matrix.
    fn system(&self, modes: &[ContactMode]) -> (Vec<At>, DMatrix<f64>) {
        let (flows, rows) = self.flows_and_rows(modes);
        let matrix = self.matrix(&flows, &rows);
        (flows, matrix)
    }

    /// Returns AᵀSD over the flows and rows of a combination of modes, in the units of the points.
    pub(super) fn mode_matrix(&self, modes: &[ContactMode]) -> DMatrix<f64> {
        self.system(modes).1
    }

    /// Solves for the unknowns of a combination of modes with λ̇ = `factor`. If the system is singular with one null
    /// vector, returns that vector.
    pub fn attempt(&self, modes: &[ContactMode], factor: f64) -> Option<Attempt> {
        let (flows, rows) = self.flows_and_rows(modes);
        let n = flows.len();
        if n == 0 {
            return self.completed(&flows, &[], factor, false);
        }
        let lu = self.matrix(&flows, &rows).full_piv_lu();
        let u = lu.u();
        let singular = match u.diagonal().iter().filter(|pivot| pivot.abs() <= SETTINGS.inequality()).count() {
            0 => false,
            1 => true,
            _ => return None,
        };
        let solved = if singular {
            // The null vector: the last unknown in the order of the pivots is one.
            let last = u.view((0, n - 1), (n - 1, 1)) * -1.0;
            let mut null = u.view((0, 0), (n - 1, n - 1)).solve_upper_triangular(&last)?.resize_vertically(n, 1.0);
            lu.q().inv_permute_rows(&mut null);
            null
        } else {
            lu.solve(&DMatrix::from_fn(n, 1, |i, _| {
                let (k, a) = &rows[i];
                -(a[0] * self.load_rate[2 * k] + a[1] * self.load_rate[2 * k + 1]) * factor
            }))?
        };
        self.completed(&flows, solved.as_slice(), factor, singular)
    }

    /// Returns gaps, forces and unknowns from the scaled unknowns.
    fn completed(&self, flows: &[At], scaled: &[f64], factor: f64, singular: bool) -> Option<Attempt> {
        let mut gaps = DVector::zeros(2 * self.points.len());
        for ((k, f), c) in flows.iter().zip(scaled) {
            gaps[2 * k] += f[0] * c;
            gaps[2 * k + 1] += f[1] * c;
        }
        let forces = &self.s * &gaps + &self.load_rate * if singular { 0.0 } else { factor };
        let unknowns = scaled.iter().zip(flows).map(|(v, (k, _))| v / self.points[*k].stiffness.sqrt()).collect();
        Some(Attempt { unknowns, gaps, forces, singular })
    }

    /// Returns the violations of an attempt: size, point, and the mode that repairs it.
    pub fn violations(&self, modes: &[ContactMode], attempt: &Attempt, sign: f64) -> Vec<(f64, usize, ContactMode)> {
        let gap_size = attempt.gaps.amax().max(1e-300);
        let force_size = attempt.forces.amax().max(if attempt.singular {
            // A mechanism has no forces: their scale is the gap size times the stiffness.
            gap_size * self.points.iter().map(|p| p.stiffness).fold(0.0, f64::max)
        } else {
            let share = if self.settles { SETTINGS.cancelled } else { 1e-4 };
            share * self.load_rate.amax().max(self.load_force)
        });
        let sizes = [force_size.max(1e-300), gap_size];
        let mut at = 0;
        let mut out = Vec::new();
        for (k, (point, mode)) in self.points.iter().zip(modes).enumerate() {
            let count = mode.flows(point.facets).len();
            let v: Vec<f64> = attempt.unknowns[at..at + count].iter().map(|v| v * sign).collect();
            at += count;
            let force = [attempt.forces[2 * k] * sign, attempt.forces[2 * k + 1] * sign];
            if let Some((size, to)) = point.violation(*mode, &v, force, sizes)
                && size > SETTINGS.inequality()
            {
                out.push((size, k, to));
            }
        }
        out
    }

    /// Returns the rate of an attempt in the sense `sign`.
    pub fn rate(&self, modes: &[ContactMode], attempt: &Attempt, sign: f64, factor: f64) -> Rate {
        let gaps = attempt.gaps_of_points().into_iter().map(|gap| gap.map(|g| g * sign));
        Rate { factor, modes: modes.to_vec(), gaps: gaps.collect() }
    }

    /// Returns the work of the load on a motion without forces. Virtual work with the forces that a growing load causes
    /// at held points gives it exactly if all other points stick or have associated flow. At a constant load a path
    /// continues in the sense in which the load does work.
    pub fn power(&self, gaps: &[[f64; 2]]) -> f64 {
        -gaps.iter().flatten().zip(&self.load_rate).map(|(gap, force)| gap * force).sum::<f64>()
    }

    /// Returns true if a path can continue with a rate: λ grows, or the load does work.
    pub fn leads_on(&self, rate: &Rate) -> bool {
        rate.factor > 0.0 || (rate.factor == 0.0 && self.power(&rate.gaps) > self.least_power(rate))
    }

    /// True if the load does negative work on a rate with λ̇ = 0: other loads drive it.
    pub fn load_resists(&self, rate: &Rate) -> bool {
        rate.factor == 0.0 && self.power(&rate.gaps) < -self.least_power(rate)
    }

    /// Returns the work of the load on a rate up to which it is rounding. If the load causes no force at the points,
    /// the force rates are rounding too.
    fn least_power(&self, rate: &Rate) -> f64 {
        let size = rate.gaps.iter().flatten().fold(0.0, |a: f64, gap| a.max(gap.abs()));
        SETTINGS.inequality() * size * self.load_rate.amax().max(self.load_force)
    }

    /// Returns the motion at constant load that some modes allow. The load does work on it; if no such motion exists,
    /// the load resists it.
    pub fn at_constant_load(&self, modes: &[ContactMode]) -> Option<Rate> {
        let attempt = self.attempt(modes, 1.0).filter(|attempt| attempt.singular)?;
        let fitting = [1.0, -1.0].into_iter().filter(|sign| self.violations(modes, &attempt, *sign).is_empty());
        let rates: Vec<Rate> = fitting.map(|sign| self.rate(modes, &attempt, sign, 0.0)).collect();
        let drives = |rate: &&Rate| self.leads_on(rate);
        rates.iter().find(drives).or_else(|| rates.iter().find(|rate| self.load_resists(rate))).cloned()
    }
}
