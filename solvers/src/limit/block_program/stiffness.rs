//! The stiffness of bodies on springs: E R Rᵀ Eᵀ, R the roots of the joints' flexibilities.

use super::program::Program;
use voussoir_core::linear::SparseCholesky;

/// The root of a joint's flexibility, by forces.
pub type Root = [[f64; 3]; 3];

/// Stiffness matrices of one program.
pub struct Stiffness {
    cholesky: SparseCholesky,
    /// For each body where its columns begin on the diagonal.
    diagonals: Vec<[usize; 3]>,
    /// For each joint between two bodies: which side comes first, and where its columns begin in those of the other.
    couplings: Vec<Option<(usize, [usize; 3])>>,
    /// Factorisations done.
    pub factorisations: u64,
}

impl Stiffness {
    /// Analyses the pattern. `None` where memory is short.
    pub fn new(program: &Program) -> Option<Self> {
        let size = program.fixed.len();
        let mut columns: Vec<Vec<usize>> = (0..size).map(|j| (j - j % 3..=j).collect()).collect();
        let pair = |bodies: [Option<usize>; 2]| match bodies {
            [Some(a), Some(b)] if a < b => Some((0, a, b)),
            [Some(a), Some(b)] => Some((1, b, a)),
            _ => None,
        };
        for member in &program.members {
            if let Some((_, first, second)) = pair(member.bodies) {
                columns[second..second + 3].iter_mut().for_each(|column| column.extend(first..first + 3));
            }
        }
        let cholesky = SparseCholesky::new(columns)?;
        let place = |row: usize, body: usize| -> Option<[usize; 3]> {
            let at = |k: usize| cholesky.place(row, body + k);
            Some([at(0)?, at(1)?, at(2)?])
        };
        let diagonals = (0..size / 3).map(|body| place(3 * body, 3 * body)).collect::<Option<_>>()?;
        let couplings = program.members.iter().map(|member| match pair(member.bodies) {
            Some((side, first, second)) => Some(Some((side, place(first, second)?))),
            None => Some(None),
        });
        let couplings = couplings.collect::<Option<_>>()?;
        Some(Stiffness { cholesky, diagonals, couplings, factorisations: 0 })
    }

    /// Factorises the matrix of these roots, with `shift` on its diagonal and of each entry there the share `relative`.
    pub fn factorise(&mut self, program: &Program, roots: &[Root], shift: f64, relative: f64) -> bool {
        let values = self.cholesky.values();
        values.fill(0.0);
        for ((member, root), coupling) in program.members.iter().zip(roots).zip(&self.couplings) {
            // Σ_k (wrench of force k) R_k: one row for each direction of the body.
            let along = |side: usize| -> [[f64; 3]; 3] {
                let wrenches = &member.wrenches[side];
                std::array::from_fn(|i| {
                    std::array::from_fn(|c| {
                        wrenches[0][i] * root[0][c] + wrenches[1][i] * root[1][c] + wrenches[2][i] * root[2][c]
                    })
                })
            };
            let mut sides = [[[0.0; 3]; 3]; 2];
            for (side, at) in member.bodies.iter().enumerate() {
                let Some(at) = *at else { continue };
                let f = along(side);
                for (j, start) in self.diagonals[at / 3].iter().enumerate() {
                    (0..=j)
                        .for_each(|i| values[start + i] += f[i][0] * f[j][0] + f[i][1] * f[j][1] + f[i][2] * f[j][2]);
                }
                sides[side] = f;
            }
            if let Some((first, starts)) = coupling {
                let (a, b) = (&sides[*first], &sides[1 - first]);
                for (j, start) in starts.iter().enumerate() {
                    (0..3).for_each(|i| values[start + i] += a[i][0] * b[j][0] + a[i][1] * b[j][1] + a[i][2] * b[j][2]);
                }
            }
        }
        for starts in &self.diagonals {
            for (j, start) in starts.iter().enumerate() {
                values[start + j] += shift + relative * values[start + j];
            }
        }
        self.factorisations += 1;
        self.cholesky.factorise()
    }

    /// Solves for one or two right-hand sides in place.
    pub fn solve(&mut self, right: &mut [f64]) {
        self.cholesky.solve(right);
    }
}
