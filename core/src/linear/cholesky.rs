//! Factorisation L Lᵀ of symmetric positive definite sparse matrices of 3 × 3 blocks. Matrices with the same pattern
//! share one analysis.
//!
//! Nodes have three unknowns each. They are eliminated by supernodes ([`supernodes`]), whose columns are a dense panel
//! over the rows that they reach. A panel is factorised three columns at a time. Then its updates of later panels are
//! computed and subtracted, also three columns at a time, so that they stay in the fastest cache; no front is stored.
//! Panels are a few nodes wide if bodies touch few others. The work is therefore arranged by three columns and not by
//! large blocks.
//!
//! Source: Ng and Peyton 1993, SIAM J. Sci. Comput. 14, 1034–1056 (block sparse Cholesky algorithms).

use super::panel::{NODE, SPARE, eliminate, inner_products, outer_products, subtract};
use super::supernodes::{Supernode, supernodes};
use super::vectors::Simd;
use crate::with_vectors;
use std::ops::Range;

/// Greatest pivot that counts as zero but for rounding, and the value that replaces it.
const VANISHED: f64 = 1e-30;
const HUGE: f64 = 1e128;

/// The columns of a supernode.
#[derive(Debug, Clone)]
struct Panel {
    /// First unknown, and number of unknowns.
    first: usize,
    width: usize,
    /// Number of rows; the rows of its own unknowns come first.
    height: usize,
    /// Start in the factor, which is stored column by column.
    start: usize,
    /// Range of its rows below, in the list of all panels.
    below: Range<usize>,
    /// Range of its updates of other panels, in the list of all updates.
    updates: Range<usize>,
}

/// The update of three columns of another panel by a panel.
#[derive(Debug, Clone)]
struct Update {
    /// First row of the panel that contributes: the row of the first of the three columns.
    row: usize,
    /// Start of the three columns in the factor, and their length.
    column: usize,
    height: usize,
    /// Start, in the list of all places, of the positions of the panel's rows in these columns, by node.
    places: usize,
}

/// Factors of matrices with one pattern, with nodes in the given order. A factorisation allocates no memory.
pub struct BlockCholesky {
    panels: Vec<Panel>,
    /// The panel of each node.
    panel_of: Vec<usize>,
    /// First unknowns of the nodes below, panel by panel.
    below: Vec<usize>,
    updates: Vec<Update>,
    places: Vec<usize>,
    factor: Vec<f64>,
    products: Vec<f64>,
    gathered: Vec<f64>,
}

impl BlockCholesky {
    /// Analyses a pattern. `columns` lists for each node the later nodes that are coupled with it.
    pub fn new(columns: Vec<Vec<usize>>) -> Self {
        let nodes = columns.len();
        let supernodes = supernodes(columns);
        let mut panel_of = vec![0; nodes];
        let (mut panels, mut below, mut start) = (Vec::with_capacity(supernodes.len()), Vec::new(), 0);
        for (index, own) in supernodes.iter().enumerate() {
            panel_of[own.nodes.clone()].fill(index);
            let (width, from) = (NODE * own.nodes.len(), below.len());
            let height = width + NODE * own.below.len();
            below.extend(own.below.iter().map(|node| NODE * node));
            let first = NODE * own.nodes.start;
            panels.push(Panel { first, width, height, start, below: from..below.len(), updates: 0..0 });
            start += width * height;
        }
        let tallest = panels.iter().map(|panel| panel.height).max().unwrap_or(0);
        let mut cholesky = BlockCholesky {
            panels,
            panel_of,
            below,
            updates: Vec::new(),
            places: Vec::new(),
            factor: vec![0.0; start + SPARE],
            products: vec![0.0; NODE * (tallest + SPARE)],
            gathered: vec![0.0; tallest],
        };
        let mut places = vec![0; nodes];
        for (index, own) in supernodes.iter().enumerate() {
            let from = cholesky.updates.len();
            cholesky.plan(own, &supernodes, &mut places);
            cholesky.panels[index].updates = from..cholesky.updates.len();
        }
        cholesky
    }

    /// Adds the updates of other panels by a supernode. `places` is a work array.
    fn plan(&mut self, own: &Supernode, supernodes: &[Supernode], places: &mut [usize]) {
        let (width, below) = (NODE * own.nodes.len(), &own.below);
        let mut done = 0;
        while let Some(next) = below.get(done) {
            let target = self.panel_of[*next];
            let (other, panel) = (&supernodes[target], &self.panels[target]);
            other.rows().enumerate().for_each(|(place, node)| places[node] = NODE * place);
            let end = below.partition_point(|node| *node < other.nodes.end);
            for (k, node) in below[done..end].iter().enumerate() {
                self.updates.push(Update {
                    row: width + NODE * (done + k),
                    column: panel.start + places[*node] * panel.height,
                    height: panel.height,
                    places: self.places.len() + k,
                });
            }
            self.places.extend(below[done..].iter().map(|node| places[*node]));
            done = end;
        }
    }

    /// Returns the start of the block (row node, column node) in [`BlockCholesky::values`] and the distance between its
    /// columns. The column node must not be after the row node. `None` if the pattern does not have the block.
    pub fn place(&self, row: usize, column: usize) -> Option<(usize, usize)> {
        let (row, column) = (NODE * row, NODE * column);
        let panel = self.panels.get(*self.panel_of.get(column / NODE)?)?;
        let place = match row.checked_sub(panel.first).filter(|place| *place < panel.width) {
            Some(place) => place,
            None => panel.width + NODE * self.below[panel.below.clone()].binary_search(&row).ok()?,
        };
        Some((panel.start + (column - panel.first) * panel.height + place, panel.height))
    }

    /// Returns the entries of the next matrix: blocks below the diagonal and the lower triangles of diagonal blocks.
    /// Set all other entries to zero.
    pub fn values(&mut self) -> &mut [f64] {
        &mut self.factor
    }

    /// Factorises the present entries. Pivots that are zero but for rounding are replaced by large ones, which sets
    /// their unknowns to zero. Returns true if all pivots are finite.
    pub fn factorise(&mut self) -> bool {
        let all = self;
        with_vectors!('a, factorise(all: &'a mut BlockCholesky) -> bool)
    }

    /// Solves for any number of right-hand sides, stored one after the other in `right`, with the last factorisation.
    pub fn solve(&mut self, right: &mut [f64]) {
        let all = self;
        with_vectors!('a, solve(all: &'a mut BlockCholesky, right: &'a mut [f64]) -> ());
    }
}

/// Returns one over the square root of a pivot.
fn reciprocal(pivot: f64) -> f64 {
    (if pivot <= VANISHED { HUGE } else { pivot }).sqrt().recip()
}

/// Returns three columns of `height` numbers, each from row `first`.
#[inline(always)]
fn three(columns: &[f64], height: usize, first: usize) -> [&[f64]; NODE] {
    [0, 1, 2].map(|j| &columns[j * height + first..(j + 1) * height])
}

/// Returns three mutable columns of `height` numbers, each from row `first`.
#[inline(always)]
fn three_mut(columns: &mut [f64], height: usize, first: usize) -> [&mut [f64]; NODE] {
    let (a, rest) = columns.split_at_mut(height);
    let (b, c) = rest.split_at_mut(height);
    [&mut a[first..], &mut b[first..], &mut c[first..height]]
}

#[inline(always)]
fn factorise<S: Simd>(simd: S, all: &mut BlockCholesky) -> bool {
    let BlockCholesky { panels, updates, places, factor, products, .. } = all;
    for Panel { width, height, start, updates: own, .. } in panels.iter() {
        let (width, height, start) = (*width, *height, *start);
        for column in (0..width).step_by(NODE) {
            let rows = height - column;
            if column > 0 {
                outer_products(simd, products, &factor[start + column..], (height, column), rows);
            }
            let columns = three_mut(&mut factor[start + column * height..], height, column);
            if column > 0 {
                for (out, products) in columns.into_iter().zip(products.chunks_exact(rows + SPARE)) {
                    out.iter_mut().zip(products).for_each(|(out, product)| *out -= product);
                }
            }
            let columns = three_mut(&mut factor[start + column * height..], height, column);
            if !eliminate(simd, columns, reciprocal) {
                return false;
            }
        }
        for update in &updates[own.clone()] {
            let rows = height - update.row;
            outer_products(simd, products, &factor[start + update.row..], (height, width), rows);
            let columns = three_mut(&mut factor[update.column..], update.height, 0);
            let places = &places[update.places..update.places + rows / NODE];
            for (out, products) in columns.into_iter().zip(products.chunks_exact(rows + SPARE)) {
                subtract_at(out, places, products);
            }
        }
    }
    true
}

/// Subtracts numbers, three per node, at the places of the nodes.
#[inline(always)]
fn subtract_at(out: &mut [f64], places: &[usize], off: &[f64]) {
    for (place, off) in places.iter().zip(off.as_chunks::<NODE>().0) {
        if let Some(out) = out[*place..].first_chunk_mut::<NODE>() {
            out.iter_mut().zip(off).for_each(|(out, off)| *out -= off);
        }
    }
}

#[inline(always)]
fn solve<S: Simd>(simd: S, all: &mut BlockCholesky, right: &mut [f64]) {
    let BlockCholesky { panels, panel_of, below, factor, gathered, .. } = all;
    let size = (NODE * panel_of.len()).max(1);
    for panel in panels.iter() {
        for right in right.chunks_exact_mut(size) {
            forwards(simd, panel, &below[panel.below.clone()], factor, gathered, right);
        }
    }
    for panel in panels.iter().rev() {
        for right in right.chunks_exact_mut(size) {
            backwards(simd, panel, &below[panel.below.clone()], factor, gathered, right);
        }
    }
}

/// Solves the part of a panel in L y = b, in place.
#[inline(always)]
fn forwards<S: Simd>(simd: S, panel: &Panel, below: &[usize], factor: &[f64], gathered: &mut [f64], right: &mut [f64]) {
    let Panel { first, width, height, start, .. } = *panel;
    let x = &mut gathered[..height];
    x[..width].copy_from_slice(&right[first..first + width]);
    x[width..].fill(0.0);
    let columns = factor[start..start + width * height].chunks_exact(NODE * height);
    for (k, columns) in columns.enumerate() {
        let [a, b, c] = three(columns, height, NODE * k);
        let x = &mut x[NODE * k..];
        x[0] *= a[0];
        x[1] = (x[1] - a[1] * x[0]) * b[1];
        x[2] = (x[2] - a[2] * x[0] - b[2] * x[1]) * c[2];
        let (known, rest) = x.split_at_mut(NODE);
        subtract(simd, rest, [&a[NODE..], &b[NODE..], &c[NODE..]], [known[0], known[1], known[2]]);
    }
    right[first..first + width].copy_from_slice(&x[..width]);
    for (at, change) in below.iter().zip(x[width..].as_chunks::<NODE>().0) {
        if let Some(out) = right[*at..].first_chunk_mut::<NODE>() {
            out.iter_mut().zip(change).for_each(|(out, change)| *out += change);
        }
    }
}

/// Solves the part of a panel in Lᵀ x = y, in place.
#[inline(always)]
fn backwards<S: Simd>(
    simd: S,
    panel: &Panel,
    below: &[usize],
    factor: &[f64],
    gathered: &mut [f64],
    right: &mut [f64],
) {
    let Panel { first, width, height, start, .. } = *panel;
    let x = &mut gathered[..height];
    x[..width].copy_from_slice(&right[first..first + width]);
    for (at, own) in below.iter().zip(x[width..].as_chunks_mut::<NODE>().0) {
        own.copy_from_slice(&right[*at..*at + NODE]);
    }
    let columns = factor[start..start + width * height].chunks_exact(NODE * height);
    for (k, columns) in columns.enumerate().rev() {
        let [a, b, c] = three(columns, height, NODE * k);
        let x = &mut x[NODE * k..];
        let [p, q, r] = inner_products(simd, &x[NODE..], [&a[NODE..], &b[NODE..], &c[NODE..]]);
        x[2] = (x[2] - r) * c[2];
        x[1] = (x[1] - q - b[2] * x[2]) * b[1];
        x[0] = (x[0] - p - a[1] * x[1] - a[2] * x[2]) * a[0];
    }
    right[first..first + width].copy_from_slice(&x[..width]);
}

#[cfg(test)]
mod tests {
    use super::super::elimination_order;
    use super::*;

    /// A stiffness matrix of springs between nodes (three components of both ends in three directions), plus 0.3 on the
    /// diagonal.
    struct Springs {
        nodes: usize,
        pairs: Vec<(usize, usize)>,
        stretch: f64,
    }

    impl Springs {
        /// Numbers the nodes in an order that keeps the factor sparse.
        fn ordered(nodes: usize, edges: &[(usize, usize)], stretch: f64) -> Self {
            let order = elimination_order(nodes, edges).unwrap();
            let mut place = vec![usize::MAX; nodes];
            order.iter().enumerate().for_each(|(i, &node)| place[node] = i);
            assert!(place.iter().all(|p| *p != usize::MAX));
            let pair = |&(a, b): &(usize, usize)| (place[a].min(place[b]), place[a].max(place[b]));
            Springs { nodes, pairs: edges.iter().map(pair).collect(), stretch }
        }

        fn pattern(&self) -> Vec<Vec<usize>> {
            let mut columns = vec![Vec::new(); self.nodes];
            self.pairs.iter().for_each(|&(a, b)| columns[a].push(b));
            columns
        }

        /// Calls `each` with every 3 × 3 block on and below the diagonal.
        fn blocks(&self, mut each: impl FnMut(usize, usize, [[f64; 3]; 3])) {
            let diagonal = [0, 1, 2].map(|i| [0, 1, 2].map(|j| if i == j { 0.3 } else { 0.0 }));
            (0..self.nodes).for_each(|node| each(node, node, diagonal));
            for (index, &(a, b)) in self.pairs.iter().enumerate() {
                let end = |of: usize, i: usize, k: usize| {
                    (self.stretch * ((7 * index + 3 * i + k + 11 * of) as f64 + 0.3).powf(1.3)).sin()
                };
                for (row, column, i, j) in [(a, a, 0, 0), (b, b, 1, 1), (b, a, 1, 0)] {
                    let entry = |r: usize, c: usize| (0..3).map(|k| end(i, r, k) * end(j, c, k)).sum::<f64>();
                    each(row, column, [0, 1, 2].map(|r| [0, 1, 2].map(|c| entry(r, c))));
                }
            }
        }

        fn fill(&self, cholesky: &mut BlockCholesky) {
            cholesky.values().fill(0.0);
            self.blocks(|row, column, block| {
                let (start, apart) = cholesky.place(row, column).unwrap();
                for (j, i) in (0..3).flat_map(|j| (0..3).map(move |i| (j, i))).filter(|(j, i)| row != column || i >= j)
                {
                    cholesky.values()[start + j * apart + i] += block[i][j];
                }
            });
        }

        fn product(&self, x: &[f64]) -> Vec<f64> {
            let mut out = vec![0.0; x.len()];
            self.blocks(|row, column, block| {
                for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
                    out[3 * row + i] += block[i][j] * x[3 * column + j];
                    if row != column {
                        out[3 * column + j] += block[i][j] * x[3 * row + i];
                    }
                }
            });
            out
        }
    }

    fn grid(side: usize) -> Vec<(usize, usize)> {
        let node = |x: usize, y: usize| x * side + y;
        let lines = (0..side).flat_map(|x| (1..side).map(move |y| (x, y)));
        lines.flat_map(|(x, y)| [(node(x, y - 1), node(x, y)), (node(y, x), node(y - 1, x))]).collect()
    }

    /// Matrices of one pattern are factorised with one analysis and solve for two right-hand sides: grids, rings,
    /// stars, full graphs, and nodes without coupling.
    #[test]
    fn matrices_of_one_pattern_are_analysed_once() {
        let ring: Vec<_> = (0..50).map(|node| (node, (node + 1) % 50)).collect();
        let star: Vec<_> = (1..20).map(|node| (0, node)).collect();
        let full: Vec<_> = (0..17).flat_map(|a| (0..a).map(move |b| (b, a))).collect();
        for (nodes, edges) in [(196, grid(14)), (50, ring), (20, star), (17, full), (4, vec![(1, 2)]), (1, Vec::new())]
        {
            let mut cholesky = BlockCholesky::new(Springs::ordered(nodes, &edges, 1.0).pattern());
            for stretch in [1.0, 1.7] {
                let springs = Springs::ordered(nodes, &edges, stretch);
                springs.fill(&mut cholesky);
                assert!(cholesky.factorise());
                let x: Vec<f64> = (0..6 * nodes).map(|i| (i as f64 * 0.7).sin()).collect();
                let (first, second) = x.split_at(3 * nodes);
                let mut right = [springs.product(first), springs.product(second)].concat();
                cholesky.solve(&mut right);
                assert!(right.iter().zip(&x).all(|(a, b)| (a - b).abs() < 1e-12), "{nodes}");
            }
        }
    }

    /// Unknowns without stiffness are set to zero and leave the others unchanged; values that are not finite are
    /// reported.
    #[test]
    fn vanished_pivots_fix_their_unknowns() {
        let mut cholesky = BlockCholesky::new(vec![vec![1], vec![]]);
        let fill = |cholesky: &mut BlockCholesky, last: f64| {
            cholesky.values().fill(0.0);
            for (node, k, value) in [(0, 0, 2.0), (0, 2, 4.0), (1, 0, 1.0), (1, 1, 5.0), (1, 2, last)] {
                let (start, apart) = cholesky.place(node, node).unwrap();
                cholesky.values()[start + k * apart + k] = value;
            }
        };
        fill(&mut cholesky, 8.0);
        assert!(cholesky.factorise());
        let mut right = vec![2.0, 3.0, 4.0, 5.0, 5.0, 4.0];
        cholesky.solve(&mut right);
        assert!(right.iter().zip([1.0, 0.0, 1.0, 5.0, 1.0, 0.5]).all(|(a, b)| (a - b).abs() < 1e-15), "{right:?}");
        for none in [f64::NAN, f64::INFINITY] {
            fill(&mut cholesky, none);
            assert!(!cholesky.factorise());
        }
    }

    /// A block outside the pattern has no place.
    #[test]
    fn only_blocks_of_the_pattern_have_places() {
        let cholesky = BlockCholesky::new(vec![vec![1], vec![2], vec![], vec![]]);
        assert!(cholesky.place(3, 0).is_none() && cholesky.place(4, 4).is_none() && cholesky.place(2, 1).is_some());
    }
}
