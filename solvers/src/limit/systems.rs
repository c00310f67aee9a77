//! The statics and kinematics of a non-associated limit state over its complementarity pairs.
//!
//! In units of the force scale F, the length L and the factor unit Λ (θ = λ/Λ): *statics* is E r + p θ = −w and s = b −
//! A r ≥ 0, 0 ≤ θ ≤ t; *kinematics* is Eᵀ q̇ + Dᵀ γ = 0, p·q̇ = 1, γ ≥ 0. A pair i is a row of a joint: s_i γ_i = 0.

use crate::limit::settings::SETTINGS;
use crate::optimise::dense_simplex::{Dictionary, Equations};
use voussoir_core::law::FacetMode;
use voussoir_core::limit::{ForceVariables, LimitProblem, force_scale, force_unit};
use voussoir_core::model::Wrenches;

/// Greatest number of entries of the equations for dense dictionaries.
pub const LARGEST: usize = 1_500_000;
/// Greatest number of pivots of a dense linear program.
pub const PIVOTS: u64 = 20_000;

/// One row of one joint.
#[derive(Debug, Clone)]
pub struct Pair {
    /// Index of the joint in the problem.
    pub joint: usize,
    /// The mode of the joint when the pair yields.
    pub mode: FacetMode,
    /// Entries of a over the force variables.
    pub normal: Vec<(usize, f64)>,
    /// Entries of d.
    pub flow: Vec<(usize, f64)>,
    /// b in units of F.
    pub bound: f64,
    /// The relief if d − a = (relief, relief, 0), as in sliding.
    pub relief: f64,
    /// For sliding, the pairs that open the same joint.
    pub openings: Vec<usize>,
}

impl Pair {
    /// Returns true if the pair limits sliding.
    pub fn slides(&self) -> bool {
        self.mode == FacetMode::Sliding
    }

    /// Returns true if d differs from a.
    pub fn non_associated(&self) -> bool {
        self.flow != self.normal
    }
}

/// The scaled data.
#[derive(Debug, Clone)]
pub struct Systems {
    /// All pairs.
    pub pairs: Vec<Pair>,
    /// The force variables of all joints.
    pub variables: ForceVariables,
    /// Number of force variables.
    pub forces: usize,
    /// Rows of E, three per group.
    pub equilibrium: Vec<Vec<(usize, f64)>>,
    /// w of each row of E.
    pub fixed: Vec<f64>,
    /// p of each row of E.
    pub varying: Vec<f64>,
    /// F \[N\].
    pub force: f64,
    /// L \[m\].
    pub length: f64,
    /// Λ.
    pub unit: f64,
}

impl Systems {
    /// Scales a problem with base loads `fixed`.
    pub fn new(problem: &LimitProblem, fixed: &Wrenches) -> Self {
        let varying = &problem.varying;
        let force = force_scale(problem, fixed, varying);
        let unit = force / force_unit(problem, varying);
        let length = problem.length;
        let variables = ForceVariables::new(problem);
        let equilibrium = variables.equilibrium(problem);
        let mut pairs = Vec::new();
        for (index, (joint, &(first, count))) in problem.joints.iter().zip(&variables.joints).enumerate() {
            let (opens, before) = (|mode| mode == FacetMode::Opening, pairs.len());
            for row in &joint.strength.rows {
                let entries = |a: &[f64; 3]| -> Vec<(usize, f64)> {
                    (0..count).filter(|&k| a[k] != 0.0).map(|k| (first + k, a[k])).collect()
                };
                let normal = entries(&row.normal);
                if !normal.is_empty() {
                    let kept: Vec<_> = joint.strength.rows.iter().filter(|r| !entries(&r.normal).is_empty()).collect();
                    let openings = if opens(row.mode) {
                        Vec::new()
                    } else {
                        (0..kept.len()).filter(|&k| opens(kept[k].mode)).map(|k| before + k).collect()
                    };
                    pairs.push(Pair {
                        joint: index,
                        mode: row.mode,
                        normal,
                        flow: entries(&row.flow),
                        bound: row.bound / force,
                        relief: row.flow[0] - row.normal[0],
                        openings,
                    });
                }
            }
        }
        let scaled = |wrenches: &Wrenches, by: f64| -> Vec<f64> {
            wrenches.iter().flat_map(|w| [w[0] * by, w[1] * by, w[2] * by / length]).collect()
        };
        Systems {
            pairs,
            forces: variables.count,
            variables,
            equilibrium,
            fixed: scaled(fixed, 1.0 / force),
            varying: scaled(varying, unit / force),
            force,
            length,
            unit,
        }
    }

    /// Returns the number of entries of the equations of statics.
    pub fn entries(&self) -> usize {
        (self.equilibrium.len() + self.pairs.len()) * (self.forces + self.pairs.len())
    }

    /// Returns the index of θ among the variables of statics: pairs come first.
    pub fn theta(&self) -> usize {
        self.pairs.len()
    }

    /// Returns the index of t − θ in statics and of t − (power) in kinematics.
    pub fn upper_slack(&self) -> usize {
        self.pairs.len() + 1
    }

    /// Returns statics with variables s_i, θ and t − θ ≥ 0.
    pub fn statics(&self, most: Option<f64>) -> Option<Dictionary> {
        let (free, pairs) = (self.forces, self.pairs.len());
        let variables = pairs + 1 + usize::from(most.is_some());
        let (mut rows, mut right) = (Vec::new(), Vec::new());
        for (i, entries) in self.equilibrium.iter().enumerate() {
            let mut row = vec![0.0; free + variables];
            entries.iter().for_each(|&(j, v)| row[j] += v);
            row[free + pairs] = self.varying[i];
            rows.push(row);
            right.push(-self.fixed[i]);
        }
        for (i, pair) in self.pairs.iter().enumerate() {
            let mut row = vec![0.0; free + variables];
            pair.normal.iter().for_each(|&(j, v)| row[j] += v);
            row[free + i] = 1.0;
            rows.push(row);
            right.push(pair.bound);
        }
        if let Some(most) = most {
            let mut row = vec![0.0; free + variables];
            row[free + pairs] = 1.0;
            row[free + pairs + 1] = 1.0;
            rows.push(row);
            right.push(most);
        }
        Equations { free, variables, rows, right }.dictionary()
    }

    /// Returns the index of (power) − a in kinematics, if a ≤ θ is set.
    pub fn lower_slack(&self) -> usize {
        self.pairs.len() + 2
    }

    /// Returns kinematics with the variables γ_i of the pairs that are not `excluded`. The dissipation d_i·r on each
    /// pair lies between `least` and `greatest`, which bounds the power θ = −w·q̇ + Σ γ_i d_i·r. For a ≤ θ ≤ t this
    /// gives −w·q̇ + Σ least_i γ_i ≤ t and −w·q̇ + Σ greatest_i γ_i ≥ a.
    pub fn kinematics(&self, range: [f64; 2], dissipation: &[[f64; 2]], excluded: &[bool]) -> Option<Dictionary> {
        let (free, pairs) = (self.equilibrium.len(), self.pairs.len());
        let variables = pairs + 3;
        let mut rows = vec![vec![0.0; free + variables]; self.forces + 1];
        let mut right = vec![0.0; self.forces + 1];
        for (i, entries) in self.equilibrium.iter().enumerate() {
            entries.iter().for_each(|&(j, v)| rows[j][i] += v);
            rows[self.forces][i] = self.varying[i];
        }
        right[self.forces] = 1.0;
        let moving = || (0..pairs).filter(|&i| !excluded[i]);
        for i in moving() {
            self.pairs[i].flow.iter().for_each(|&(j, v)| rows[j][free + i] += v);
        }
        let bounds = [(range[1], 1.0, 0, self.upper_slack()), (range[0], -1.0, 1, self.lower_slack())];
        for (bound, sign, side, variable) in bounds {
            if !bound.is_finite() || moving().any(|i| !dissipation[i][side].is_finite()) {
                continue;
            }
            let mut row = vec![0.0; free + variables];
            (0..free).for_each(|i| row[i] = -sign * self.fixed[i]);
            moving().for_each(|i| row[free + i] = sign * dissipation[i][side]);
            row[free + variable] = 1.0;
            rows.push(row);
            right.push(sign * bound);
        }
        Equations { free, variables, rows, right }.dictionary()
    }
}

/// Returns the pairs with multipliers above rounding.
pub fn greatest_shares(gamma: &[f64]) -> Vec<usize> {
    let greatest = gamma.iter().fold(0.0f64, |m, g| m.max(*g));
    (0..gamma.len()).filter(|&i| gamma[i] > SETTINGS.moves * greatest).collect()
}
