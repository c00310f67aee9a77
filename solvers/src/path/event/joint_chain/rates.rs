//! Rates of the joints of a chain, kept from event to event.

use crate::linear::dense::add_product;
use crate::linear::largest;
use nalgebra::{DMatrix, DVector};

/// Rates of the joints.
#[derive(Clone)]
pub struct ChainRates {
    /// Forces and twist of every joint.
    pub own: Vec<Vec<f64>>,
    /// Factors of the columns of the responses: rates of the redundants, λ̇, twists of weak joints.
    pub share: DVector<f64>,
    /// Number of corrections since they were last examined.
    pub unchecked: usize,
}

impl ChainRates {
    /// Adds responses multiplied by these shares.
    pub fn add(&mut self, responses: &[DMatrix<f64>], share: DVector<f64>) {
        self.own.iter_mut().zip(responses).for_each(|(own, response)| add_product(own, response, share.as_slice()));
        self.share += share;
    }

    /// Returns the greatest absolute value.
    pub fn size(&self) -> f64 {
        self.own.iter().map(|own| largest(own)).fold(0.0, f64::max)
    }
}
