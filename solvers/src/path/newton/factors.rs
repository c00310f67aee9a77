//! What one factorisation leaves to the next.

use crate::contact::mode::ContactMode;
use crate::linear::bordered::BorderedFactors;
use crate::linear::condensed::Elimination;
use std::rc::Rc;

/// Factors with what they are of.
pub(super) struct Kept {
    pub modes: Vec<ContactMode>,
    /// Normals and flows of the laws' facets.
    pub directions: Vec<[f64; 4]>,
    pub held: Rc<BorderedFactors>,
}

/// What the last factorisation leaves to the next.
#[derive(Default)]
pub(super) struct Factorised {
    /// The last ones, where nothing but modes and laws makes the matrix.
    pub last: Option<Kept>,
    pub elimination: Elimination,
}

impl Factorised {
    /// Another load grows.
    pub fn forget(&mut self) {
        self.last = None;
    }
}
