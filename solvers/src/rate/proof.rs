//! A proof that no rate has a given sense of λ: a complete tree of mode decisions.
//!
//! Over all active facets i of all points, with multipliers z ≥ 0 and slack rates w ≥ 0, rates satisfy
//!
//! ```text
//! w = λ̇ q + M z,   w_i z_i = 0,   M_ij = a_i·S d_j,   q_i = −a_i·s     and for λ̇ = 0   c·z ≥ 1,   c_i = d_i·s
//! ```
//!
//! A mode of a point sets some of its w and z to zero: in the mode *facet i*, w_i = 0 and the other z are zero; *stick*
//! sets all its z to zero; *open* sets all its w to zero. A leaf holds multipliers y of the rows (Farkas 1902): y·w −
//! (yᵀM + y_c c)·z + y_c e = λ̇ y·q − y_c, in which no coefficient of a variable that may be positive is negative while
//! the right-hand side is. For associated flow without softening the root is a leaf: one dual vector.

use crate::contact::mode::ContactMode;

/// A node of the tree.
#[derive(Debug, Clone, PartialEq)]
pub enum ModeTree {
    /// Multipliers y of the rows that contradict each other in the modes above, and last y_c for λ̇ = 0.
    Contradiction(Vec<f64>),
    /// A rate in these modes, which does not continue the path.
    Rate(Vec<ContactMode>),
    /// All modes of a point, each with the tree below it.
    Point {
        /// Index of the point.
        point: usize,
        /// Its modes.
        modes: Vec<(ContactMode, ModeTree)>,
    },
}

/// A proof that no rate with a sense of λ continues the path.
#[derive(Debug, Clone, PartialEq)]
pub struct NoRate {
    /// The sense of λ: 1, 0 or −1.
    pub factor: f64,
    /// (point, facet) of each row.
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
    /// The proof over points in another order: point k becomes `to[k]`.
    pub(super) fn renumbered(self, to: &[usize]) -> NoRate {
        let rows = self.rows.into_iter().map(|(point, facet)| (to[point], facet)).collect();
        NoRate { factor: self.factor, rows, tree: self.tree.renumbered(to) }
    }
}
