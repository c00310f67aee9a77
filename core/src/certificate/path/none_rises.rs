//! The proof that no rate at a state has a sense of λ̇: a complete tree of mode decisions with a Farkas vector at each
//! leaf.
//!
//! A leaf with multipliers (y, β) proves that λ̇ > 0 is impossible if, with α as in [`FarkasVector`],
//!
//! - Kᵀ y + Gᵀ β = 0 for the motion of every free body,
//! - α·ṙ + β·ġ ≥ 0 in every remaining mode at every contact point,
//! - p·y + g_p·β is negative by a margin.
//!
//! For λ̇ < 0 the last sum is positive instead. For λ̇ = 0 it is not used, and Kᵀ y + Gᵀ β = −κ p with κ > 0 by a
//! margin.
//!
//! Sums are compared with the sizes of their terms. The proof therefore holds for all structures whose coefficients
//! differ from these by the tolerances. The check involves no search.

use super::arrival::Arrival;
use super::claims::length;
use super::point_modes::{Decided, ModeCone};
use super::rate_equations::{Column, RateEquations};
use crate::path::{FarkasVector, ModeTree};

/// Greatest number of leaves of a tree.
pub const MAX_LEAVES: usize = 10_000;
/// Rounding of sums that must vanish or have a sign, as a share of their terms.
const ROUNDING: f64 = 1e-10;
/// The same for the geometric terms Kᵀ y: the accuracy of a limit point on a curved path.
const LOCATED: f64 = 1e-7;
/// Share of the greatest sum of terms below which sums count as rounding errors.
const NOISE: f64 = 1e-14;
/// Least size of the negative factor of λ̇, as a share of its terms.
const MARGIN: f64 = 1e-6;

/// The rate problem at a state with the modes of all contact points.
pub(super) struct RateProblem<'a> {
    pub equations: &'a RateEquations,
    /// The modes that each contact point may take.
    pub modes: &'a [Vec<ModeCone>],
}

/// The rates that a tree refutes.
#[derive(Clone, Copy)]
pub(super) enum Refuted<'a> {
    /// Rates with λ̇ > 0.
    Rising,
    /// Rates with λ̇ = 0 and a load that does work.
    Standing,
    /// Rates with λ̇ > 0 on a path that arrives with λ falling, except rates in modes of the piece before, which are
    /// the way back.
    RisingNew(&'a Arrival),
    /// Rates with λ̇ < 0, except rates in modes of the piece before.
    FallingNew(&'a Arrival),
}

impl<'a> Refuted<'a> {
    /// Returns the sense of λ̇ relative to the sense of the load step.
    fn factor(self) -> f64 {
        match self {
            Refuted::Rising | Refuted::RisingNew(_) => 1.0,
            Refuted::Standing => 0.0,
            Refuted::FallingNew(_) => -1.0,
        }
    }

    /// Returns the piece before, if rates in its modes are excluded.
    fn left_out(self) -> Option<&'a Arrival> {
        match self {
            Refuted::RisingNew(arrival) | Refuted::FallingNew(arrival) => Some(arrival),
            Refuted::Rising | Refuted::Standing => None,
        }
    }
}

/// A sum with the sum of the sizes of its terms.
#[derive(Debug, Clone, Copy, Default)]
struct Sum {
    value: f64,
    terms: f64,
}

impl Sum {
    fn add(&mut self, term: f64) {
        self.value += term;
        self.terms += term.abs();
    }
}

/// Multipliers with their sums.
pub(super) struct Products {
    /// α of each contact point with the sizes of its terms.
    alpha: Vec<([f64; 2], f64)>,
    beta: Vec<[f64; 2]>,
    /// Kᵀ y and Gᵀ β by index 3 × body + component.
    motions: Vec<[Sum; 2]>,
    /// The factor of λ̇.
    load: Sum,
}

/// Returns the products of a column with y and with β.
fn sums(column: &Column, vector: &FarkasVector) -> [Sum; 2] {
    let mut sums = [Sum::default(); 2];
    let y = vector.equilibrium.as_flattened();
    let beta = vector.gap.as_flattened();
    column.equilibrium.iter().for_each(|(row, value)| sums[0].add(value * y[*row]));
    column.gap.iter().for_each(|(row, value)| sums[1].add(value * beta[*row]));
    sums
}

impl Products {
    /// Computes the products of the multipliers with the equations, for the rates that are `refuted`.
    pub fn new(equations: &RateEquations, vector: &FarkasVector, refuted: Refuted) -> Self {
        let both = |column: &Column| {
            let [a, b] = sums(column, vector);
            Sum { value: a.value + b.value, terms: a.terms + b.terms }
        };
        let mut forces: Vec<Sum> = equations.forces.iter().map(both).collect();
        let mut motions: Vec<[Sum; 2]> = equations.motions.iter().map(|column| sums(column, vector)).collect();
        let mut load = both(&equations.load);
        if matches!(refuted, Refuted::Standing) {
            load = Sum { value: -equations.sense * vector.work, terms: 0.0 };
            let Column { equilibrium, gap } = &equations.load;
            equilibrium.iter().for_each(|(row, p)| motions[*row][1].add(vector.work * p));
            gap.iter().for_each(|(row, g)| forces[*row].add(vector.work * g));
        }
        let pair = |pair: &[Sum]| ([-pair[0].value, -pair[1].value], pair[0].terms.max(pair[1].terms));
        Products { alpha: forces.chunks_exact(2).map(pair).collect(), beta: vector.gap.clone(), motions, load }
    }

    /// Returns an error if work of the load is not excluded; `largest` is the size of the greatest sum over motions.
    fn excludes_work(&self, equations: &RateEquations, work: f64, largest: f64) -> Result<(), String> {
        let scale = |row: usize| if row % 3 == 2 { equations.length } else { 1.0 };
        let share = |(row, p): &(usize, f64)| (work * p / scale(*row)).abs();
        let size = equations.load.equilibrium.iter().map(share).fold(0.0, f64::max);
        let proves = self.load.value < 0.0 && size > MARGIN * largest;
        if proves { Ok(()) } else { Err("the multipliers do not exclude that the load does work".into()) }
    }

    /// Returns the first reason why these multipliers prove nothing.
    fn refutes(&self, problem: &RateProblem, decided: &Decided, refuted: Refuted, work: f64) -> Result<(), String> {
        let largest = self.balance(problem.equations)?;
        if matches!(refuted, Refuted::Standing) {
            self.excludes_work(problem.equations, work, largest)?;
        } else {
            self.excludes(refuted.factor() * problem.equations.sense)?;
        }
        self.admit(problem, decided)
    }

    /// Checks Kᵀ y + Gᵀ β = 0 and returns the size of the greatest of these sums.
    fn balance(&self, equations: &RateEquations) -> Result<f64, String> {
        let scale = |index: usize| if index % 3 == 2 { equations.length } else { 1.0 };
        let moved = self.motions.iter().enumerate().map(|(i, [k, g])| (k.terms + g.terms) / scale(i));
        let largest = moved.fold(0.0, f64::max);
        for (index, [k, g]) in self.motions.iter().enumerate() {
            let allowed = LOCATED * k.terms + ROUNDING * g.terms + NOISE * largest * scale(index);
            if (k.value + g.value).abs() > allowed {
                return Err(format!("the multipliers leave a part of the motion of body {}", index / 3));
            }
        }
        Ok(largest)
    }

    /// Checks that the factor of λ̇ has the opposite sign of `sense`.
    fn excludes(&self, sense: f64) -> Result<(), String> {
        let factor = sense * self.load.value;
        if factor.is_nan() || factor > -MARGIN * self.load.terms || factor == 0.0 {
            return Err("the multipliers do not exclude this sense of the load".into());
        }
        Ok(())
    }

    /// Adds κ times a functional of ṙ, ġ and λ̇ to α·ṙ + β·ġ.
    pub fn leave_out(&mut self, kappa: f64, (forces, gaps, factor): (&[[f64; 2]], &[[f64; 2]], f64)) {
        for (index, (alpha, _)) in self.alpha.iter_mut().enumerate() {
            (0..2).for_each(|k| alpha[k] += kappa * forces[index][k]);
            (0..2).for_each(|k| self.beta[index][k] += kappa * gaps[index][k]);
        }
        self.load.add(-kappa * factor);
    }

    /// Returns the first reason why these multipliers do not exclude a rising load in one linear rate problem at a
    /// located state. For a contact point whose rates are linear, `linear` gives the size of the sum that must vanish
    /// and of its terms.
    pub fn refutes_linear(
        &self,
        problem: &RateProblem,
        linear: impl Fn(usize, [f64; 2], [f64; 2]) -> Option<[f64; 2]>,
    ) -> Result<(), String> {
        self.balance(problem.equations)?;
        self.excludes(problem.equations.sense)?;
        let largest = self.alpha.iter().map(|own| own.1).fold(0.0, f64::max);
        let largest_beta = self.beta.iter().map(|beta| length(*beta)).fold(0.0, f64::max);
        for (contact, (alpha, terms)) in self.alpha.iter().enumerate() {
            let refutes = match linear(contact, *alpha, self.beta[contact]) {
                Some([sum, terms]) => sum <= LOCATED * terms,
                None => problem.modes[contact].iter().all(|cone| {
                    let products = cone.least_products([*alpha, self.beta[contact]]);
                    products[0] >= -LOCATED * terms - NOISE * largest && products[1] >= -LOCATED * largest_beta
                }),
            };
            if !refutes {
                return Err(format!("the multipliers do not refute the loading set at contact point {contact}"));
            }
        }
        Ok(())
    }

    /// Checks α·ṙ + β·ġ ≥ 0 in all remaining modes.
    fn admit(&self, problem: &RateProblem, decided: &Decided) -> Result<(), String> {
        let largest_alpha = self.alpha.iter().map(|own| own.1).fold(0.0, f64::max);
        let largest_beta = self.beta.iter().map(|beta| length(*beta)).fold(0.0, f64::max);
        for (contact, (modes, (alpha, terms))) in problem.modes.iter().zip(&self.alpha).enumerate() {
            let left = |cone: &&ModeCone| decided.get(&contact).is_none_or(|mode| *mode == cone.mode);
            let allowed = [ROUNDING * terms + NOISE * largest_alpha, ROUNDING * largest_beta];
            for cone in modes.iter().filter(left) {
                let products = cone.least_products([*alpha, self.beta[contact]]);
                if (0..2).any(|i| products[i] < -allowed[i]) {
                    return Err(format!("the multipliers do not refute {:?} at contact point {contact}", cone.mode));
                }
            }
        }
        Ok(())
    }
}

impl RateProblem<'_> {
    /// Checks the proof that no rate has λ̇ > 0; returns the number of its leaves.
    ///
    /// # Errors
    /// Names the first part that proves nothing.
    pub fn check_none_rises(&self, tree: &ModeTree) -> Result<usize, String> {
        self.check_none(tree, Refuted::Rising)
    }

    /// Checks the proof that no such rates exist and returns the number of its leaves.
    ///
    /// # Errors
    /// Names the first part that proves nothing.
    pub fn check_none(&self, tree: &ModeTree, refuted: Refuted) -> Result<usize, String> {
        if tree.leaves(MAX_LEAVES) > MAX_LEAVES {
            return Err(format!("the tree has more than {MAX_LEAVES} leaves"));
        }
        if let Some(contact) = self.modes.iter().position(Vec::is_empty) {
            return Err(format!("contact point {contact} has no mode"));
        }
        self.check_tree(tree, &mut Decided::new(), refuted)
    }

    fn check_tree(&self, tree: &ModeTree, decided: &mut Decided, refuted: Refuted) -> Result<usize, String> {
        let (contact, branches) = match tree {
            ModeTree::Leaf(vector) => {
                self.check_form(vector)?;
                let products = Products::new(self.equations, vector, refuted);
                return products.refutes(self, decided, refuted, vector.work).map(|()| 1);
            }
            ModeTree::Before => {
                let arrival =
                    refuted.left_out().ok_or("rates in the modes of the piece before are not left out here")?;
                return arrival.had(self.modes, decided).map(|()| 1);
            }
            ModeTree::Split { contact, branches } => (*contact, branches),
        };
        let modes = self.modes.get(contact).ok_or("a decision at a contact point that does not exist")?;
        if decided.contains_key(&contact) {
            return Err(format!("contact point {contact} is decided twice"));
        }
        let complete = modes.iter().all(|cone| branches.iter().any(|(mode, _)| *mode == cone.mode));
        if !complete || branches.len() != modes.len() {
            return Err(format!("the modes of contact point {contact} are not complete"));
        }
        let mut leaves = 0;
        for (mode, branch) in branches {
            decided.insert(contact, *mode);
            leaves += self.check_tree(branch, decided, refuted)?;
        }
        decided.remove(&contact);
        Ok(leaves)
    }

    fn check_form(&self, vector: &FarkasVector) -> Result<(), String> {
        let fits = vector.equilibrium.len() == self.equations.held.len() && vector.gap.len() == self.modes.len();
        let numbers = vector.equilibrium.as_flattened().iter().chain(vector.gap.as_flattened());
        let mut numbers = numbers.chain([&vector.work]);
        if fits && numbers.all(|number| number.is_finite()) { Ok(()) } else { Err("a malformed Farkas vector".into()) }
    }
}
