//! Test for polygons that cross themselves, with a hierarchy of boxes: n log n for boundaries without a crossing.

use super::geometry::Vec2;

/// A box: lower left and upper right corner.
type Bounds = (Vec2, Vec2);

/// The edges of a closed polygon in a binary tree; each node has the box around its edges. Node 1 is the root, node k
/// has the children 2k and 2k + 1, edge i is node `first + i`.
struct EdgeTree<'a> {
    vertices: &'a [Vec2],
    boxes: Vec<Bounds>,
    first: usize,
}

impl<'a> EdgeTree<'a> {
    fn new(vertices: &'a [Vec2]) -> EdgeTree<'a> {
        let (n, first) = (vertices.len(), vertices.len().next_power_of_two());
        let nothing = (Vec2::repeat(f64::INFINITY), Vec2::repeat(f64::NEG_INFINITY));
        let mut boxes = vec![nothing; 2 * first];
        for i in 0..n {
            let (a, b) = (vertices[i], vertices[(i + 1) % n]);
            boxes[first + i] = (a.inf(&b), a.sup(&b));
        }
        for k in (1..first).rev() {
            let ((low, high), (other_low, other_high)) = (boxes[2 * k], boxes[2 * k + 1]);
            boxes[k] = (low.inf(&other_low), high.sup(&other_high));
        }
        EdgeTree { vertices, boxes, first }
    }

    fn crosses_within(&self, node: usize) -> bool {
        if node >= self.first {
            return false;
        }
        let (left, right) = (2 * node, 2 * node + 1);
        self.crosses_within(left) || self.crosses_within(right) || self.crosses_between(left, right)
    }

    /// Both nodes are on one level of the tree, so that both are edges or neither is.
    fn crosses_between(&self, one: usize, other: usize) -> bool {
        let ((low, high), (other_low, other_high)) = (self.boxes[one], self.boxes[other]);
        if (0..2).any(|k| high[k] < other_low[k] || other_high[k] < low[k]) {
            return false;
        }
        if one >= self.first {
            return self.edges_cross(one - self.first, other - self.first);
        }
        [2 * one, 2 * one + 1].iter().any(|&a| [2 * other, 2 * other + 1].iter().any(|&b| self.crosses_between(a, b)))
    }

    fn edges_cross(&self, i: usize, j: usize) -> bool {
        edges_cross(self.vertices, i, j)
    }
}

/// Returns true if edges i < j, whose boxes meet, touch or cross. Neighbours do not count.
fn edges_cross(vertices: &[Vec2], i: usize, j: usize) -> bool {
    let n = vertices.len();
    if j == i + 1 || (j + 1) % n == i {
        return false;
    }
    let edge = |i: usize| (vertices[i], vertices[(i + 1) % n]);
    let ((a, b), (c, d)) = (edge(i), edge(j));
    let side = |p: Vec2, q: Vec2, r: Vec2| super::geometry::cross(q - p, r - p);
    side(a, b, c) * side(a, b, d) <= 0.0 && side(c, d, a) * side(c, d, b) <= 0.0
}

/// Number of edges up to which every pair is tested: building the tree would take longer.
const FEW: usize = 64;

/// Tests every pair of at most `MOST` edges.
fn crosses_by_pairs<const MOST: usize>(vertices: &[Vec2]) -> bool {
    let n = vertices.len();
    let mut boxes = [(Vec2::zeros(), Vec2::zeros()); MOST];
    for (i, own) in boxes[..n].iter_mut().enumerate() {
        let (a, b) = (vertices[i], vertices[(i + 1) % n]);
        *own = (a.inf(&b), a.sup(&b));
    }
    let apart = |(low, high): &Bounds, (other_low, other_high): &Bounds| {
        high.x < other_low.x || other_high.x < low.x || high.y < other_low.y || other_high.y < low.y
    };
    (0..n).any(|i| (i + 1..n).any(|j| !apart(&boxes[i], &boxes[j]) && edges_cross(vertices, i, j)))
}

/// Returns true if two edges of the polygon that are not neighbours touch or cross.
pub fn crosses_itself(vertices: &[Vec2]) -> bool {
    match vertices.len() {
        ..4 => false,
        4 => crosses_by_pairs::<4>(vertices),
        5..=FEW => crosses_by_pairs::<FEW>(vertices),
        _ => EdgeTree::new(vertices).crosses_within(1),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polygon(points: &[(f64, f64)]) -> Vec<Vec2> {
        points.iter().map(|&(x, y)| Vec2::new(x, y)).collect()
    }

    #[test]
    fn a_bow_tie_crosses_itself() {
        assert!(crosses_itself(&polygon(&[(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)])));
        assert!(!crosses_itself(&polygon(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])));
    }

    #[test]
    fn edges_on_one_line_do_not_cross_unless_they_overlap() {
        let legs = [(0.0, 0.0), (3.0, 0.0), (3.0, 2.0), (2.0, 2.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)];
        assert!(!crosses_itself(&polygon(&legs)));
        assert!(!crosses_itself(&polygon(&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (3.0, 0.0), (0.0, 1.0)])));
        assert!(crosses_itself(&polygon(&[(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (3.0, 0.0), (1.0, 0.0), (0.0, 1.0)])));
    }

    #[test]
    fn the_tree_finds_what_every_pair_of_edges_finds() {
        let mut crossing = 0;
        for case in 0..400_u32 {
            let n = 4 + case % 24;
            // A circle with a ripple; in every second case two vertices are exchanged.
            let mut vertices: Vec<Vec2> = (0..n)
                .map(|i| {
                    let angle = std::f64::consts::TAU * f64::from(i) / f64::from(n);
                    Vec2::new(angle.cos(), angle.sin()) * (1.0 + 0.3 * (f64::from(case) * angle.sin()).sin())
                })
                .collect();
            if case % 2 == 1 {
                vertices.swap(case as usize % 5, (case as usize / 7) % n as usize);
            }
            let by_pairs = crosses_by_pairs::<FEW>(&vertices);
            assert_eq!(EdgeTree::new(&vertices).crosses_within(1), by_pairs, "{vertices:?}");
            crossing += usize::from(by_pairs);
        }
        assert!(crossing > 100 && crossing < 300, "{crossing}");
    }
}
