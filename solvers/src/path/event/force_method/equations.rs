//! Compatibility of the cycles: the few equations that are left of a rate problem.
//!
//! ```text
//! Σ_e s_ek Eᵀ ξ̇_e = 0                     for each cycle k
//! ξ̇_e = −K⁻¹ Ṙ_e                          where K can be inverted
//! K ξ̇_e + Ṙ_e = 0                         else, with ξ̇_e unknown
//! Ṙ_e = E (Σ_l s_el Ẋ_l + L_e)
//! ```

use super::joint::Joint;
use super::section::{Section, Sections};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

/// Sections whose sums are kept together.
const BLOCK: usize = 32;
/// Sections with a twist of their own above which the whole system is asked.
const MOST_WEAK: usize = 12;
/// Relative residual up to which a solution is believed.
const RESIDUAL: f64 = 1e-12;
/// Pivots below this share of the greatest: a mechanism is near.
const SINGULAR: f64 = 1e-11;

/// Σ s_k s_l Eᵀ K⁻¹ E, Σ s_k Eᵀ K⁻¹ E L and the same with L on the left, over some sections.
#[derive(Clone)]
struct Sums {
    matrix: DMatrix<f64>,
    right: DVector<f64>,
    /// Σ (E L)ᵀ K⁻¹ E s_k, and Σ (E L)ᵀ K⁻¹ E L: displacement at the load.
    work: DVector<f64>,
    load: f64,
}

impl Sums {
    fn new(cycles: usize) -> Self {
        let n = 3 * cycles;
        Sums { matrix: DMatrix::zeros(n, n), right: DVector::zeros(n), work: DVector::zeros(n), load: 0.0 }
    }

    fn clear(&mut self) {
        self.matrix.fill(0.0);
        self.right.fill(0.0);
        self.work.fill(0.0);
        self.load = 0.0;
    }

    fn add_section(&mut self, section: &Section, joint: &Joint) {
        let Some(flexibility) = &joint.flexibility else { return };
        let load: Vector3<f64> = joint.statics.fixed_view::<3, 1>(0, joint.statics.ncols() - 1).into_owned();
        let by_load = flexibility * load;
        self.load += load.dot(&by_load);
        if section.shares.iter().all(|s| *s == 0.0) {
            return;
        }
        let across = section.to_centre.transpose() * flexibility * section.to_centre;
        let right = section.to_centre.transpose() * by_load;
        let work = section.to_centre.transpose() * (flexibility.transpose() * load);
        for (k, a) in section.shares.iter().enumerate().filter(|s| *s.1 != 0.0) {
            for (l, b) in section.shares.iter().enumerate().filter(|s| *s.1 != 0.0) {
                let mut block = self.matrix.fixed_view_mut::<3, 3>(3 * k, 3 * l);
                block += across * (a * b);
            }
            let mut own = self.right.fixed_rows_mut::<3>(3 * k);
            own += right * *a;
            let mut own = self.work.fixed_rows_mut::<3>(3 * k);
            own += work * *a;
        }
    }

    fn add(&mut self, other: &Sums) {
        self.matrix += &other.matrix;
        self.right += &other.right;
        self.work += &other.work;
        self.load += other.load;
    }
}

/// Rates of redundants and of the twists that are unknowns of their own.
pub struct Solution {
    /// Ẋ.
    pub redundants: Vec<f64>,
    /// (section, ξ̇).
    pub weak: Vec<(usize, Vector3<f64>)>,
    /// Rate of displacement at the load, Σ p·q̇.
    pub displacement: f64,
}

/// Sums over all sections, a block at a time.
pub struct Equations {
    blocks: Vec<Sums>,
    stale: Vec<bool>,
    whole: Sums,
}

impl Equations {
    /// Of so many sections.
    pub fn new(sections: &Sections) -> Self {
        let blocks = sections.all.len().div_ceil(BLOCK);
        let empty = Sums::new(sections.cycles);
        Equations { blocks: vec![empty.clone(); blocks], stale: vec![true; blocks], whole: empty }
    }

    /// The tangent of a section is another one.
    pub fn changed(&mut self, section: usize) {
        self.stale[section / BLOCK] = true;
    }

    /// Solves for a unit rate of the load's arc. `None` near a mechanism.
    pub fn solve(&mut self, sections: &Sections, joints: &[Joint], weak: &[usize]) -> Option<Solution> {
        if weak.len() > MOST_WEAK {
            return None;
        }
        for (b, block) in self.blocks.iter_mut().enumerate().filter(|(b, _)| self.stale[*b]) {
            block.clear();
            let range = b * BLOCK..((b + 1) * BLOCK).min(joints.len());
            range.for_each(|e| block.add_section(&sections.all[e], &joints[e]));
        }
        self.stale.fill(false);
        self.whole.clear();
        self.blocks.iter().for_each(|block| self.whole.add(block));
        let (n, m) = (3 * sections.cycles, 3 * weak.len());
        let mut matrix = DMatrix::zeros(n + m, n + m);
        let mut right = DVector::zeros(n + m);
        matrix.view_mut((0, 0), (n, n)).copy_from(&-&self.whole.matrix);
        right.rows_mut(0, n).copy_from(&self.whole.right);
        for (w, &e) in weak.iter().enumerate() {
            let (section, joint, at) = (&sections.all[e], &joints[e], n + 3 * w);
            matrix.view_mut((at, at), (3, 3)).copy_from(&joint.stiffness);
            for (k, share) in section.shares.iter().enumerate().filter(|s| *s.1 != 0.0) {
                let turned: Matrix3<f64> = section.to_centre * *share;
                matrix.view_mut((at, 3 * k), (3, 3)).copy_from(&turned);
                matrix.view_mut((3 * k, at), (3, 3)).copy_from(&turned.transpose());
            }
            let load = joint.statics.fixed_view::<3, 1>(0, joint.statics.ncols() - 1);
            right.rows_mut(at, 3).copy_from(&-load);
        }
        let solved = solved(matrix, &right)?;
        let redundants: Vec<f64> = solved.rows(0, n).iter().copied().collect();
        let twist = |w: usize| Vector3::new(solved[n + 3 * w], solved[n + 3 * w + 1], solved[n + 3 * w + 2]);
        let weak: Vec<(usize, Vector3<f64>)> = weak.iter().enumerate().map(|(w, e)| (*e, twist(w))).collect();
        // p·q̇ = −Σ R·ξ̇ with the resultants that the load has without redundants.
        let mut displacement = self.whole.load + self.whole.work.dot(&solved.rows(0, n));
        for (e, twist) in &weak {
            let statics = &joints[*e].statics;
            displacement -= statics.fixed_view::<3, 1>(0, statics.ncols() - 1).dot(twist);
        }
        Some(Solution { redundants, weak, displacement })
    }
}

/// Rows and columns scaled to one, full pivoting, one step of refinement.
pub fn solved(matrix: DMatrix<f64>, right: &DVector<f64>) -> Option<DVector<f64>> {
    let n = matrix.nrows();
    if n == 0 {
        return Some(DVector::zeros(0));
    }
    let mut scaled = matrix;
    let (mut rows, mut columns) = (vec![1.0; n], vec![1.0; n]);
    for _ in 0..3 {
        for (i, all) in rows.iter_mut().enumerate() {
            let size = scaled.row(i).amax().sqrt();
            if size == 0.0 || !size.is_finite() {
                return None;
            }
            scaled.row_mut(i).unscale_mut(size);
            *all *= size;
        }
        for (j, all) in columns.iter_mut().enumerate() {
            let size = scaled.column(j).amax().sqrt();
            if size == 0.0 || !size.is_finite() {
                return None;
            }
            scaled.column_mut(j).unscale_mut(size);
            *all *= size;
        }
    }
    let right = DVector::from_fn(n, |i, _| right[i] / rows[i]);
    let lu = scaled.clone().full_piv_lu();
    let pivots = lu.u().diagonal().abs();
    if pivots.min() <= SINGULAR * pivots.max() {
        return None;
    }
    let mut x = lu.solve(&right)?;
    x += lu.solve(&(&right - &scaled * &x))?;
    let size = (0..n).map(|i| (0..n).map(|j| (scaled[(i, j)] * x[j]).abs()).sum::<f64>()).fold(right.amax(), f64::max);
    let left = (&right - &scaled * &x).amax();
    (left <= RESIDUAL * size && x.iter().all(|v| v.is_finite())).then(|| DVector::from_fn(n, |j, _| x[j] / columns[j]))
}
