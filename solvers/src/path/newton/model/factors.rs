//! The factorised equations of contact modes, and the data kept from one factorisation to the next.

use super::equations::Equations;
use crate::contact::mode::ContactMode;
use crate::linear::bordered::BorderedFactors;
use crate::linear::chain::ChainFactors;
use crate::linear::condensed::{Condensed, Elimination};
use crate::linear::factorised::Factorised;
use std::cell::RefCell;
use std::collections::{BTreeMap, VecDeque};
use std::rc::Rc;

/// Factorised equations of contact modes.
pub enum ModeEquations {
    /// Any arrangement of bodies.
    Sparse(Condensed),
    /// A chain of elastic bodies.
    Chain(ChainFactors),
}

impl ModeEquations {
    /// Returns the unknowns from `first`, after the forces, for right-hand sides that are zero at contact points.
    pub fn motions(&self, first: usize, rights: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
        match self {
            ModeEquations::Chain(factors) => factors.motions(rights),
            ModeEquations::Sparse(factors) => {
                let size = rights.first().map_or(first, Vec::len);
                let found = factors.condense(rights)?;
                Some(found.iter().map(|y| (first..size).map(|j| factors.other(j, y)).collect()).collect())
            }
        }
    }
}

impl Factorised for ModeEquations {
    fn apply(&self, right: &[f64]) -> Option<Vec<f64>> {
        match self {
            ModeEquations::Sparse(factors) => factors.apply(right),
            ModeEquations::Chain(factors) => factors.apply(right),
        }
    }

    fn errors(&self, right: &[f64], x: &[f64]) -> (Vec<f64>, f64) {
        match self {
            ModeEquations::Sparse(factors) => factors.errors(right, x),
            ModeEquations::Chain(factors) => factors.errors(right, x),
        }
    }

    fn last_row_dot(&self, x: &[f64]) -> f64 {
        match self {
            ModeEquations::Sparse(factors) => factors.last_row_dot(x),
            ModeEquations::Chain(factors) => factors.last_row_dot(x),
        }
    }
}

/// Factors with the data that identify their equations.
pub struct Kept {
    pub equations: Rc<Equations>,
    pub modes: Vec<ContactMode>,
    /// Normals and flows of the laws' facets.
    pub directions: Vec<[f64; 4]>,
    /// Rate of viscous wrenches.
    pub damping: f64,
    pub held: Rc<BorderedFactors<ModeEquations>>,
    /// Responses to unit right-hand sides of the rows of contact points, with an unknown held.
    pub responses: RefCell<BTreeMap<usize, [Vec<f64>; 2]>>,
}

/// Number of stored factors: from the start and the end of a step, and between.
const MAX_FACTORS: usize = 4;

/// Factors kept for later solutions.
#[derive(Default)]
pub struct LastFactors {
    /// The last factors, latest first, if only modes and laws determine the matrix.
    held: VecDeque<Rc<Kept>>,
    pub elimination: Elimination,
}

impl LastFactors {
    /// Removes all factors, for another load or after they have failed.
    pub fn forget(&mut self) {
        self.held.clear();
    }

    /// Stores factors.
    pub fn hold(&mut self, kept: Kept) {
        self.held.push_front(Rc::new(kept));
        self.held.truncate(MAX_FACTORS);
    }

    /// Returns all stored factors.
    pub fn held(&self) -> impl Iterator<Item = &Rc<Kept>> {
        self.held.iter()
    }
}
