//! Orders of elimination, computed by faer.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SymbolicSparseColMat;
use faer::sparse::linalg::amd;

/// Returns an order of elimination that keeps the factors of a graph's matrices sparse (approximate minimum degree):
/// the first node, the second, and so on. `edges` join different nodes and may be repeated. `None` if memory is short.
pub fn elimination_order(nodes: usize, edges: &[(usize, usize)]) -> Option<Vec<usize>> {
    let mut columns: Vec<Vec<usize>> = (0..nodes).map(|node| vec![node]).collect();
    edges.iter().for_each(|&(a, b)| columns[a.max(b)].push(a.min(b)));
    let (mut starts, mut rows) = (vec![0], Vec::new());
    for column in &mut columns {
        column.sort_unstable();
        column.dedup();
        rows.extend_from_slice(column);
        starts.push(rows.len());
    }
    let pattern = SymbolicSparseColMat::new_checked(nodes, nodes, starts, None, rows);
    let scratch = amd::order_maybe_unsorted_scratch::<usize>(nodes, pattern.compute_nnz());
    let mut memory = MemBuffer::try_new(scratch).ok()?;
    let (mut order, mut place) = (vec![0; nodes], vec![0; nodes]);
    let control = amd::Control::default();
    amd::order_maybe_unsorted(&mut order, &mut place, pattern.as_ref(), control, MemStack::new(&mut memory)).ok()?;
    Some(order)
}
