//! One factorisation for many events. Every contact point has a mode in the factorised matrix; points that have changed
//! their mode since then are right-hand sides of their own two rows. Contact forces with their own equations are
//! condensed out ([`condensed`](crate::linear::condensed)); of the responses to changed points only the kept unknowns
//! are stored.
//!
//! ```text
//! stick   C ṙ + G q̇ = ε − λ̇ g_p          free    ṙ = ε
//! facet   −a·ṙ = ε_1,  d⊥·(C ṙ + G q̇ + λ̇ g_p) = ε_2
//! bodies  Gᵀ ṙ = −λ̇ p
//! ```

use crate::contact::mode::{ContactMode, parts};
use crate::linear::condensed::{Condensed, Elimination};
use crate::linear::updated::UpdatedFactorisation;
use crate::path::system::{Load, System};
use crate::settings::SETTINGS;
use nalgebra::DMatrix;
use voussoir_core::linear::Entries;

/// Greatest number of refinement steps of a solution.
pub const REFINEMENTS: usize = 3;

/// The equations in given modes, factorised.
pub struct FactorisedModes {
    /// Mode of each contact point in the matrix.
    pub modes: Vec<ContactMode>,
    /// True if responses to single points are refined, as claims about the rate problem require.
    pub refine_columns: bool,
    updated: UpdatedFactorisation,
    load_rate: Option<(usize, Vec<f64>)>,
}

impl FactorisedModes {
    /// Assembles and factorises. `None` if the system is singular.
    pub fn new(system: &System, modes: Vec<ContactMode>, refine_columns: bool) -> Option<Self> {
        let nc = system.contacts;
        let (mut entries, mut regularisation): (Entries, Entries) = (Vec::new(), Vec::new());
        for (c, mode) in modes.iter().enumerate() {
            for (k, own) in system.rows(c, *mode)?.into_iter().enumerate() {
                let row = 2 * c + k;
                entries.extend((0..2).filter(|t| own[*t] != 0.0).map(|t| (row, 2 * c + t, own[t])));
                for (t, by) in [own[2], own[3]].into_iter().enumerate().filter(|(_, by)| *by != 0.0) {
                    let (forces, motions) = (system.flexibility.row(2 * c + t), system.kinematics.row(2 * c + t));
                    entries.extend(forces.iter().map(|&(j, v)| (row, j, by * v)));
                    entries.extend(motions.iter().map(|&(j, v)| (row, 2 * nc + j, by * v)));
                }
                if *mode == ContactMode::Stick {
                    regularisation.push((row, row, SETTINGS.shift()));
                }
            }
        }
        for row in 0..2 * nc {
            entries.extend(system.kinematics.row(row).iter().map(|&(j, v)| (2 * nc + j, row, v)));
        }
        let equations = Condensed::new(
            system.size(),
            nc,
            (&entries, &regularisation),
            &mut Elimination::along(system.chain.clone()),
        )?;
        let updated = UpdatedFactorisation::new(equations);
        Some(FactorisedModes { modes, refine_columns, updated, load_rate: None })
    }

    /// Returns x for λ̇ = 1 with every mode as factorised.
    pub fn load_rate(&mut self, system: &System, index: usize, load: &Load) -> Option<&Vec<f64>> {
        if self.load_rate.as_ref().is_none_or(|(i, _)| *i != index) {
            let right = self.right(system, load);
            self.load_rate = Some((index, self.updated.factors.solve(&right, REFINEMENTS)?));
        }
        self.load_rate.as_ref().map(|(_, x)| x)
    }

    /// Returns the motions caused by a wrench on the bodies with every mode as factorised, in units; `refined` or not.
    pub fn moved_by(&self, system: &System, wrench: &[f64], refined: bool) -> Option<Vec<f64>> {
        let first = 2 * system.contacts;
        let mut right = vec![0.0; system.size()];
        right[first..].iter_mut().zip(wrench).for_each(|(right, wrench)| *right = -wrench);
        let refinements = if refined { REFINEMENTS } else { 0 };
        self.updated.factors.solve(&right, refinements).map(|mut x| x.split_off(first))
    }

    /// Returns all unknowns for gaps of points that stick, at a held load.
    pub fn opened(&self, system: &System, points: &[usize], gaps: &[[f64; 2]]) -> Option<Vec<f64>> {
        let mut right = vec![0.0; system.size()];
        for (c, gap) in points.iter().zip(gaps) {
            right[2 * c..2 * c + 2].copy_from_slice(gap);
        }
        self.updated.factors.solve(&right, REFINEMENTS)
    }

    /// Forgets responses to single points, and sets if later ones are refined.
    pub fn set_refined(&mut self, refine_columns: bool) {
        self.refine_columns = refine_columns;
        self.updated.forget_responses();
    }

    /// Forgets the load, before another one is applied.
    pub fn forget_load(&mut self) {
        self.load_rate = None;
    }

    fn right(&self, system: &System, load: &Load) -> Vec<f64> {
        let mut right = vec![0.0; system.size()];
        for (c, (mode, gap)) in self.modes.iter().zip(&load.gap).enumerate() {
            let parts = system.rows(c, *mode).map(|rows| parts(&rows, [0.0; 2], *gap)).unwrap_or_default();
            (0..2).for_each(|k| right[2 * c + k] = -parts[k][1]);
        }
        for (b, wrench) in load.wrench.iter().enumerate() {
            (0..3).for_each(|i| right[2 * system.contacts + 3 * b + i] = -wrench[i]);
        }
        right
    }

    /// Returns the kept unknowns for any right-hand side with every mode as factorised, not refined.
    pub fn kept(&self, right: &[f64]) -> Option<Vec<f64>> {
        Some(self.updated.factors.condense(&[right.to_vec()])?.swap_remove(0))
    }

    /// Computes the responses to the rows of these points if they are not known. `solves` counts right-hand sides.
    pub fn respond(&mut self, points: &[usize], solves: &mut u64) -> Option<()> {
        let refinements = if self.refine_columns { REFINEMENTS } else { 0 };
        for c in points {
            *solves += self.updated.respond(*c, refinements)?;
        }
        Some(())
    }

    /// Returns the number of points with known responses.
    pub fn responses(&self) -> usize {
        self.updated.responses()
    }

    /// Returns (ṙ, ġ) at `points`, 4 rows each, per ε of `points` (2 columns each) and, last, per λ̇. Responses and the
    /// load rate must be known.
    pub fn local(&self, system: &System, points: &[usize], load: &Load) -> DMatrix<f64> {
        let n = points.len();
        let mut out = DMatrix::zeros(4 * n, 2 * n + 1);
        let gap = |row: usize, x: &[f64]| {
            system.flexibility.row_dot(row, x) + system.kinematics.row_dot(row, &x[2 * system.contacts..])
        };
        let at = |x: &[f64], c: usize| [x[2 * c], x[2 * c + 1], gap(2 * c, x), gap(2 * c + 1, x)];
        for (k, own) in points.iter().enumerate() {
            let Some(columns) = self.updated.columns(*own) else { continue };
            for (i, column) in columns.iter().enumerate() {
                let epsilon = [[1.0, 0.0], [0.0, 1.0]][i];
                let right = |c: usize| if c == *own { epsilon } else { [0.0; 2] };
                let seen = match &column.x {
                    Some(x) => points.iter().map(|c| at(x, *c)).collect(),
                    None => self.seen(system, points, right, &column.y),
                };
                for (row, here) in seen.into_iter().enumerate() {
                    (0..4).for_each(|t| out[(4 * row + t, 2 * k + i)] = here[t]);
                }
            }
        }
        if let Some((_, x)) = &self.load_rate {
            for (row, &c) in points.iter().enumerate() {
                let here = at(x, c);
                (0..2).for_each(|t| out[(4 * row + t, 2 * n)] = here[t]);
                (0..2).for_each(|t| out[(4 * row + 2 + t, 2 * n)] = here[2 + t] + load.gap[c][t]);
            }
        }
        out
    }

    /// Returns (ṙ, ġ) at `points` from kept unknowns and the right-hand sides of contact points.
    pub fn seen(
        &self,
        system: &System,
        points: &[usize],
        right: impl Fn(usize) -> [f64; 2],
        y: &[f64],
    ) -> Vec<[f64; 4]> {
        let forces = 2 * system.contacts;
        let at = |&c: &usize| {
            let own = (c, self.updated.factors.force(c, right(c), y));
            let gap = |row: usize| {
                let by_force = system.flexibility.row(row).iter().copied();
                let by_motion = system.kinematics.row(row).iter().map(|&(j, v)| (forces + j, v));
                self.updated.row_dot(by_force, own, &right, y) + self.updated.row_dot(by_motion, own, &right, y)
            };
            [own.1[0], own.1[1], gap(2 * c), gap(2 * c + 1)]
        };
        points.iter().map(at).collect()
    }

    /// Returns x for ε at `points`, added to right-hand sides of all rows with their kept unknowns.
    pub fn combine(&self, points: &[usize], epsilon: &[f64], onto: (Vec<f64>, Vec<f64>)) -> Vec<f64> {
        let (mut right, mut y) = onto;
        for (c, epsilon) in points.iter().zip(epsilon.chunks_exact(2)) {
            (0..2).for_each(|k| right[2 * c + k] += epsilon[k]);
            self.updated.add(*c, [epsilon[0], epsilon[1]], &mut y);
        }
        self.updated.factors.expand(&right, &y)
    }

    /// Returns a zero right-hand side, and its kept unknowns.
    pub fn nothing(&self) -> (Vec<f64>, Vec<f64>) {
        self.updated.factors.nothing()
    }
}
