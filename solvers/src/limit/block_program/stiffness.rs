//! The stiffness of bodies on springs: E R Rᵀ Eᵀ with the roots R of the joints' flexibilities.

use super::cone::dot;
use super::program::Program;
use voussoir_core::linear::BlockCholesky;

/// The square root of a joint's flexibility, by forces.
pub type Root = [[f64; 3]; 3];

/// Stiffness matrices of one program.
pub struct Stiffness {
    cholesky: BlockCholesky,
    /// Start of the diagonal block of each body, and the distance between its columns.
    diagonals: Vec<(usize, usize)>,
    /// For each joint between two bodies: its first side, and start and column distance of the block.
    couplings: Vec<Option<(usize, (usize, usize))>>,
    /// Factorisations done.
    pub factorisations: u64,
}

impl Stiffness {
    /// Analyses the pattern.
    pub fn new(program: &Program) -> Option<Self> {
        let count = program.fixed.len() / 3;
        let pair = |bodies: [Option<usize>; 2]| match bodies {
            [Some(a), Some(b)] if a < b => Some((0, a / 3, b / 3)),
            [Some(a), Some(b)] => Some((1, b / 3, a / 3)),
            _ => None,
        };
        let pairs: Vec<_> = program.members.iter().map(|member| pair(member.bodies)).collect();
        let mut columns: Vec<Vec<usize>> = vec![Vec::new(); count];
        pairs.iter().flatten().for_each(|&(_, first, second)| columns[first].push(second));
        let cholesky = BlockCholesky::new(columns);
        let diagonals = (0..count).map(|body| cholesky.place(body, body)).collect::<Option<_>>()?;
        let couplings = pairs.into_iter().map(|pair| match pair {
            Some((side, first, second)) => Some(Some((side, cholesky.place(second, first)?))),
            None => Some(None),
        });
        let couplings = couplings.collect::<Option<_>>()?;
        Some(Stiffness { cholesky, diagonals, couplings, factorisations: 0 })
    }

    /// Factorises the matrix of these roots. The diagonal is increased by `shift` and the share `relative`.
    pub fn factorise<'a>(
        &mut self,
        program: &Program,
        roots: impl Iterator<Item = &'a Root>,
        shift: f64,
        relative: f64,
    ) -> bool {
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
                let (start, apart) = self.diagonals[at / 3];
                for (j, b) in f.iter().enumerate() {
                    for (i, a) in f.iter().enumerate().skip(j) {
                        values[start + j * apart + i] += dot(a, b);
                    }
                }
                sides[side] = f;
            }
            if let Some((first, (start, apart))) = coupling {
                for (j, b) in sides[*first].iter().enumerate() {
                    for (i, a) in sides[1 - first].iter().enumerate() {
                        values[start + j * apart + i] += dot(a, b);
                    }
                }
            }
        }
        for (start, apart) in &self.diagonals {
            for j in 0..3 {
                let own = &mut values[start + j * (apart + 1)];
                *own += shift + relative * *own;
            }
        }
        self.factorisations += 1;
        self.cholesky.factorise()
    }

    /// Solves for right-hand sides in place.
    pub fn solve(&mut self, right: &mut [f64]) {
        self.cholesky.solve(right);
    }
}
