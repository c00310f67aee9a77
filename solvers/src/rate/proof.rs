//! A proof that no rate has a given sense of λ: a complete tree of mode decisions.
//!
//! Over all active facets i of all points, with multipliers z ≥ 0 and slack rates w ≥ 0, rates satisfy
//!
//! ```text
//! w = λ̇ q + M z,   w_i z_i = 0,   M_ij = a_i·S d_j,   q_i = −a_i·s     and for λ̇ = 0   c·z ≥ 1,   c_i = d_i·s
//! ```
//!
//! A mode of a point sets some of its w and z to zero: in the mode *facet i*, w_i = 0 and the other z are zero; *stick*
//! sets all its z to zero; *vertex* sets all its w to zero. A leaf holds multipliers y of the rows (Farkas 1902):
//! y·w − (yᵀM + y_c c)·z + y_c e = λ̇ y·q − y_c, in which no coefficient of a variable that may be positive is negative
//! while the right-hand side is. For associated flow without softening the root is a leaf: one dual vector.
//!
//! With α = −Σ y_i a_i at each point this is α·ṙ + β·ġ = λ̇ s·α, β = −Sᵀα: the form that the certificate checks.

use crate::contact::active_point::ActivePoint;
use voussoir_core::path::{FarkasVector, ModeTree as CertifiedTree, PointMode};

/// A node of the tree.
#[derive(Debug, Clone, PartialEq)]
pub enum ModeTree {
    /// Multipliers y of the rows that contradict each other in the modes above, and last y_c for λ̇ = 0.
    Contradiction(Vec<f64>),
    /// A rate in these modes, which does not continue the path.
    Rate(Vec<PointMode>),
    /// All modes of a point, each with the tree below it.
    Point {
        /// Index of the point.
        point: usize,
        /// Its modes.
        modes: Vec<(PointMode, ModeTree)>,
    },
}

/// A proof that no rate with a sense of λ continues the path.
#[derive(Debug, Clone, PartialEq)]
pub struct NoRate {
    /// The sense of λ: 1, 0 or −1.
    pub factor: f64,
    /// (point, facet) of each row. The opening facets of points that are open with a strength are last: their w is zero
    /// and their z has any sign.
    pub rows: Vec<(usize, usize)>,
    /// The tree.
    pub tree: ModeTree,
}

impl ModeTree {
    /// Number of leaves.
    #[cfg(test)]
    pub(super) fn leaves(&self) -> usize {
        match self {
            ModeTree::Contradiction(_) | ModeTree::Rate(_) => 1,
            ModeTree::Point { modes, .. } => modes.iter().map(|(_, tree)| tree.leaves()).sum(),
        }
    }

    /// The tree over points in another order: point k becomes `to[k]`.
    pub(super) fn renumbered(self, to: &[usize]) -> ModeTree {
        match self {
            ModeTree::Point { point, modes } => ModeTree::Point {
                point: to[point],
                modes: modes.into_iter().map(|(mode, tree)| (mode, tree.renumbered(to))).collect(),
            },
            ModeTree::Rate(modes) => {
                let mut all = modes.clone();
                modes.into_iter().enumerate().for_each(|(k, mode)| all[to[k]] = mode);
                ModeTree::Rate(all)
            }
            leaf => leaf,
        }
    }
}

impl NoRate {
    /// The proof in the form of the certificate, over the `points` of the problem, which are the contact points `contacts` of
    /// the structure. `None` if a rate with λ̇ = 0 is left; other rates that continue nothing are in modes that the path had before.
    ///
    /// `vector` completes gap multipliers α of the points and the multiplier y_c to multipliers of the whole structure. If the
    /// structure is symmetric, it is the negative response of the structure to the gap rates α and to λ̇ = −y_c: y = −q̇, β = −ṙ.
    pub fn certified(
        &self,
        points: &[ActivePoint],
        contacts: &[usize],
        vector: &impl Fn(&[[f64; 2]], f64) -> FarkasVector,
    ) -> Option<CertifiedTree> {
        self.certified_tree(&self.tree, points, contacts, vector)
    }

    fn certified_tree(
        &self,
        tree: &ModeTree,
        points: &[ActivePoint],
        contacts: &[usize],
        vector: &impl Fn(&[[f64; 2]], f64) -> FarkasVector,
    ) -> Option<CertifiedTree> {
        match tree {
            ModeTree::Rate(_) => (self.factor != 0.0).then_some(CertifiedTree::Before),
            ModeTree::Contradiction(y) => {
                let work = y.get(self.rows.len()).copied().unwrap_or_default();
                Some(CertifiedTree::Leaf(vector(&self.force_multipliers(points, y), work)))
            }
            ModeTree::Point { point, modes } => {
                let branch = |(mode, tree): &(PointMode, ModeTree)| {
                    self.certified_tree(tree, points, contacts, vector).map(|tree| (*mode, tree))
                };
                let branches: Option<Vec<_>> = modes.iter().map(branch).collect();
                Some(CertifiedTree::Split { contact: contacts[*point], branches: branches? })
            }
        }
    }

    /// α = −Σ y_i a_i of each point.
    fn force_multipliers(&self, points: &[ActivePoint], y: &[f64]) -> Vec<[f64; 2]> {
        let mut alpha = vec![[0.0; 2]; points.len()];
        for (&(k, f), y) in self.rows.iter().zip(y) {
            let normal = points[k].facets[f].normal;
            (0..2).for_each(|i| alpha[k][i] -= y * normal[i]);
        }
        alpha
    }

    /// The proof over points in another order: point k becomes `to[k]`.
    pub(super) fn renumbered(self, to: &[usize]) -> NoRate {
        let rows = self.rows.into_iter().map(|(point, facet)| (to[point], facet)).collect();
        NoRate { factor: self.factor, rows, tree: self.tree.renumbered(to) }
    }
}
