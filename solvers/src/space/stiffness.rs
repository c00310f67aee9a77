//! The stiffness of bodies on springs: A R Rᵀ Aᵀ with the roots R of the flexibilities of all points.
//!
//! Each contact is condensed to a 6 × 6 block in its own frame. The block is then moved to the poles of both bodies. A
//! body is two nodes of three unknowns of the block Cholesky factorisation.

use super::cone::Cone;
use super::program::{Member, Program};
use super::settings::SETTINGS;
use voussoir_core::linear::{BlockCholesky, elimination_order};

/// A 6 × 6 matrix by rows.
pub type Block = [[f64; 6]; 6];

/// Start of a 3 × 3 block in the factor, and the distance between its columns.
type Place = (usize, usize);

/// True if plus is eliminated after minus, and the four blocks of the coupling by rows.
type Coupling = (bool, [Place; 4]);

/// Stiffness matrices of one program.
pub struct Stiffness {
    cholesky: BlockCholesky,
    /// Place of each body in the order of elimination.
    places: Vec<usize>,
    /// Starts of the three blocks below the diagonal of each body, and their column distances.
    diagonals: Vec<[Place; 3]>,
    /// For each contact between two bodies.
    couplings: Vec<Option<Coupling>>,
    work: Vec<f64>,
    /// Factorisations done.
    pub factorisations: u64,
}

impl Stiffness {
    /// Analyses the pattern. `None` if memory is short.
    pub fn new(program: &Program) -> Option<Self> {
        let count = program.base.len() / 6;
        let pair = |member: &Member| match member.bodies {
            [Some(plus), Some(minus)] if plus != minus => Some((plus, minus)),
            _ => None,
        };
        let edges: Vec<(usize, usize)> = program.members.iter().filter_map(pair).collect();
        let order = elimination_order(count, &edges)?;
        let mut places = vec![0; count];
        order.iter().enumerate().for_each(|(place, body)| places[*body] = place);
        let mut columns: Vec<Vec<usize>> = vec![Vec::new(); 2 * count];
        (0..count).for_each(|place| columns[2 * place].push(2 * place + 1));
        for (a, b) in &edges {
            let (first, second) = (places[*a].min(places[*b]), places[*a].max(places[*b]));
            columns[2 * first..2 * first + 2].iter_mut().for_each(|column| column.extend([2 * second, 2 * second + 1]));
        }
        columns.iter_mut().for_each(|column| {
            column.sort_unstable();
            column.dedup();
        });
        let cholesky = BlockCholesky::new(columns);
        let diagonal = |place: usize| {
            let (a, b) = (2 * place, 2 * place + 1);
            Some([cholesky.place(a, a)?, cholesky.place(b, a)?, cholesky.place(b, b)?])
        };
        let diagonals = places.iter().map(|place| diagonal(*place)).collect::<Option<_>>()?;
        let coupling = |(plus, minus): (usize, usize)| {
            let (plus, minus) = (places[plus], places[minus]);
            let (row, column) = (2 * plus.max(minus), 2 * plus.min(minus));
            let place = |i, j| cholesky.place(row + i, column + j);
            Some((plus > minus, [place(0, 0)?, place(0, 1)?, place(1, 0)?, place(1, 1)?]))
        };
        let couplings = program.members.iter().map(|member| match pair(member) {
            Some(bodies) => coupling(bodies).map(Some),
            None => Some(None),
        });
        let couplings = couplings.collect::<Option<_>>()?;
        Some(Stiffness { cholesky, places, diagonals, couplings, work: vec![0.0; 6 * count], factorisations: 0 })
    }

    /// Factorises the matrix of these roots. Returns false if a pivot is not finite.
    pub fn factorise<'a>(&mut self, program: &Program, mut roots: impl Iterator<Item = &'a [Cone; 3]>) -> bool {
        let values = self.cholesky.values();
        values.fill(0.0);
        for (member, coupling) in program.members.iter().zip(&self.couplings) {
            let condensed = condensed(program, member, &mut roots);
            let moved = member.moves();
            let halves: [Block; 2] = std::array::from_fn(|side| times(&moved[side], &condensed));
            for side in 0..2 {
                if let Some(body) = member.bodies[side] {
                    let own = times_transposed(&halves[side], &moved[side]);
                    add_lower(values, &self.diagonals[body], &own);
                }
            }
            if let Some((plus_is_row, places)) = coupling {
                let (row, column) = if *plus_is_row { (0, 1) } else { (1, 0) };
                let block = times_transposed(&halves[row], &moved[column]);
                for (k, (start, apart)) in places.iter().enumerate() {
                    add(values, (*start, *apart), &block, (3 * (k / 2), 3 * (k % 2)), false);
                }
            }
        }
        for body in &self.diagonals {
            for (start, apart) in [body[0], body[2]] {
                for j in 0..3 {
                    let own = &mut values[start + j * (apart + 1)];
                    *own += SETTINGS.shift + SETTINGS.pivot * *own;
                }
            }
        }
        self.factorisations += 1;
        self.cholesky.factorise()
    }

    /// Solves for one right-hand side, six numbers for each body.
    pub fn solve(&mut self, right: &mut [f64]) {
        for (body, place) in self.places.iter().enumerate() {
            self.work[6 * place..6 * place + 6].copy_from_slice(&right[6 * body..6 * body + 6]);
        }
        self.cholesky.solve(&mut self.work);
        for (body, place) in self.places.iter().enumerate() {
            right[6 * body..6 * body + 6].copy_from_slice(&self.work[6 * place..6 * place + 6]);
        }
    }
}

/// Returns Σ a aᵀ over the columns a of wrenches of all points of a contact, about its centre and in its frame.
fn condensed<'a>(program: &Program, member: &Member, roots: &mut impl Iterator<Item = &'a [Cone; 3]>) -> Block {
    let mut sum = [[0.0; 6]; 6];
    for (point, root) in program.points[member.points.clone()].iter().zip(roots) {
        for column in root {
            let f = member.force(column);
            let m = point.cross(&f);
            let a = [f.x, f.y, f.z, m.x, m.y, m.z];
            for (row, x) in sum.iter_mut().zip(&a) {
                row.iter_mut().zip(&a).for_each(|(sum, y)| *sum += x * y);
            }
        }
    }
    sum
}

impl Member {
    /// Returns the maps from a wrench of the contact to the wrenches of plus and minus.
    pub fn moves(&self) -> [Block; 2] {
        let of = |side: usize| {
            let sign = [1.0, -1.0][side];
            let mut map = [[0.0; 6]; 6];
            for (k, axis) in self.frame.iter().enumerate() {
                let turned = self.arms[side].cross(axis);
                for i in 0..3 {
                    map[i][k] = sign * axis[i];
                    map[3 + i][k] = sign * turned[i];
                    map[3 + i][3 + k] = sign * axis[i];
                }
            }
            map
        };
        [of(0), of(1)]
    }
}

/// Returns a b.
pub fn times(a: &Block, b: &Block) -> Block {
    let mut out = [[0.0; 6]; 6];
    for (out, a) in out.iter_mut().zip(a) {
        for (a, b) in a.iter().zip(b) {
            for j in 0..6 {
                out[j] += a * b[j];
            }
        }
    }
    out
}

/// Returns a bᵀ.
pub fn times_transposed(a: &Block, b: &Block) -> Block {
    a.map(|a| std::array::from_fn(|j| (0..6).map(|k| a[k] * b[j][k]).sum()))
}

/// Adds the lower triangle of a block to the three blocks of a body.
fn add_lower(values: &mut [f64], places: &[Place; 3], block: &Block) {
    add(values, places[0], block, (0, 0), true);
    add(values, places[1], block, (3, 0), false);
    add(values, places[2], block, (3, 3), true);
}

/// Adds a 3 × 3 part of a block, or its lower triangle.
fn add(values: &mut [f64], (start, apart): Place, block: &Block, (row, column): (usize, usize), lower: bool) {
    for j in 0..3 {
        for i in if lower { j } else { 0 }..3 {
            values[start + j * apart + i] += block[row + i][column + j];
        }
    }
}
