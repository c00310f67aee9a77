//! Supernodes: nodes of a graph that are eliminated together, and the later nodes in their rows.
//!
//! The column of a node in the factor has the rows of the matrix and the rows of its children in the elimination tree
//! (Liu 1990, SIAM J. Matrix Anal. Appl. 11, 134–172). Neighbours with the same rows form a supernode. Two supernodes
//! are merged if the stored zeros cost less than another supernode (Ashcraft and Grimes 1989, ACM Trans. Math. Softw.
//! 15, 291–309).

use std::ops::Range;

/// Nodes that are eliminated together.
#[derive(Debug, Clone, PartialEq)]
pub struct Supernode {
    /// Range of the nodes.
    pub nodes: Range<usize>,
    /// Later nodes in their rows, ascending.
    pub below: Vec<usize>,
}

/// Greatest share of zeros for merging two supernodes, by the greatest number of nodes in the result.
const MERGED: [(usize, f64); 4] = [(2, 1.0), (5, 0.8), (16, 0.1), (usize::MAX, 0.05)];

impl Supernode {
    /// Iterates over the nodes of its rows, its own first.
    pub fn rows(&self) -> impl Iterator<Item = usize> + '_ {
        self.nodes.clone().chain(self.below.iter().copied())
    }

    /// Returns the number of blocks of its columns on and below the diagonal, with this number of rows below.
    fn blocks(&self, below: usize) -> usize {
        let width = self.nodes.len();
        width * (width + 1) / 2 + width * below
    }

    /// Returns the nodes of this supernode merged with the one before, and the number of additional zero blocks.
    fn merged(&self, before: &Supernode) -> (Range<usize>, usize) {
        let both = Supernode { nodes: before.nodes.start..self.nodes.end, below: Vec::new() };
        let apart = self.blocks(self.below.len()) + before.blocks(before.below.len());
        let zeros = both.blocks(self.below.len()) - apart;
        (both.nodes, zeros)
    }
}

/// Returns the supernodes in order of elimination. `columns` lists for each node the later nodes coupled with it.
pub fn supernodes(columns: Vec<Vec<usize>>) -> Vec<Supernode> {
    // Each supernode with the number of zeros that it stores.
    let mut found: Vec<(Supernode, usize)> = Vec::new();
    for (node, below) in filled(columns).into_iter().enumerate() {
        let mut last = Supernode { nodes: node..node + 1, below };
        let mut zeros = 0;
        while let Some((before, known)) = found.last() {
            if before.below.first() != Some(&last.nodes.start) {
                break;
            }
            let (nodes, new) = last.merged(before);
            let both = Supernode { nodes, below: Vec::new() };
            let share = (zeros + known + new) as f64 / both.blocks(last.below.len()) as f64;
            let most = MERGED.iter().find(|(most, _)| both.nodes.len() <= *most);
            if most.is_none_or(|(_, most)| share > *most) {
                break;
            }
            zeros += known + new;
            last.nodes = both.nodes;
            found.pop();
        }
        found.push((last, zeros));
    }
    found.into_iter().map(|(supernode, _)| supernode).collect()
}

/// Returns the rows of the factor below the diagonal, by columns.
fn filled(mut columns: Vec<Vec<usize>>) -> Vec<Vec<usize>> {
    let mut seen = vec![usize::MAX; columns.len()];
    let mut children: Vec<Vec<usize>> = vec![Vec::new(); columns.len()];
    for node in 0..columns.len() {
        let mut own = std::mem::take(&mut columns[node]);
        seen[node] = node;
        let mut new = |row: &usize| std::mem::replace(&mut seen[*row], node) != node;
        own.retain(&mut new);
        for child in &children[node] {
            own.extend(columns[*child].iter().filter(|row| new(row)));
        }
        own.sort_unstable();
        own.first().into_iter().for_each(|parent| children[*parent].push(node));
        columns[node] = own;
    }
    columns
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The rows of the factor of a ring of six nodes include its fill: later nodes are coupled with node 5 too.
    #[test]
    fn rows_are_those_of_the_factor() {
        let ring = vec![vec![1, 5], vec![2], vec![3], vec![4], vec![5], vec![]];
        let rows = filled(ring.clone());
        assert_eq!(rows, [vec![1, 5], vec![2, 5], vec![3, 5], vec![4, 5], vec![5], vec![]]);
        // A coupling that is repeated counts once.
        let mut twice = ring.clone();
        twice[0] = vec![5, 1, 5];
        assert_eq!(filled(twice), rows);
        let found = supernodes(ring);
        assert_eq!(found.iter().flat_map(|own| own.nodes.clone()).collect::<Vec<_>>(), (0..6).collect::<Vec<_>>());
        for own in &found {
            for node in own.nodes.clone() {
                assert!(rows[node].iter().all(|row| own.rows().any(|other| other == *row)), "{own:?}");
            }
        }
    }

    /// Nodes without coupling are separate supernodes; a complete graph is one supernode.
    #[test]
    fn full_parts_are_one_and_parts_without_coupling_are_apart() {
        let full: Vec<Vec<usize>> = (0..9).map(|node| (node + 1..9).collect()).collect();
        assert_eq!(supernodes(full), [Supernode { nodes: 0..9, below: Vec::new() }]);
        assert_eq!(supernodes(vec![Vec::new(); 3]).len(), 3);
    }
}
