//! Bodies in a chain: the order in which factorisations eliminate their unknowns.
//!
//! Levels of free bodies from one end, by the joints between them (Cuthill & McKee 1969, Proc. 24th Nat. Conf. ACM,
//! 157-172). If no level has more than two bodies (an arch, a bar, a ring), the unknowns of a joint follow those of the
//! body before it, so that equations contain only a few neighbouring ranks.

use std::collections::VecDeque;
use voussoir_core::path::PathProblem;

/// Greatest number of bodies in a level of a chain.
const WIDTH: usize = 2;

/// Returns the bodies of the part of the structure that contains `start`, with their levels, in breadth-first order.
fn levels(beside: &[Vec<usize>], start: usize) -> Vec<(usize, usize)> {
    let mut met = vec![false; beside.len()];
    let (mut all, mut next) = (Vec::new(), VecDeque::from([(start, 0)]));
    met[start] = true;
    while let Some((body, level)) = next.pop_front() {
        all.push((body, level));
        for &other in &beside[body] {
            if !std::mem::replace(&mut met[other], true) {
                next.push_back((other, level + 1));
            }
        }
    }
    all
}

/// Returns the ranks of the unknowns (forces of contact points, motions of free bodies) in the order of their
/// elimination. `None` if the bodies form no chain.
pub fn ranks(problem: &PathProblem, free: &[Option<usize>]) -> Option<Vec<usize>> {
    let bodies = free.iter().flatten().count();
    let mut beside: Vec<Vec<usize>> = vec![Vec::new(); bodies];
    let sides = |c: usize| [problem.contacts[c].minus.body, problem.contacts[c].plus.body].map(|b| free[b]);
    for c in 0..problem.contacts.len() {
        if let [Some(a), Some(b)] = sides(c)
            && a != b
            && !beside[a].contains(&b)
        {
            beside[a].push(b);
            beside[b].push(a);
        }
    }
    // Levels of each part follow the levels of the previous part, with a free rank at both ends.
    let mut rank_of: Vec<Option<(usize, usize)>> = vec![None; bodies];
    let mut first = 1;
    for body in 0..bodies {
        if rank_of[body].is_some() {
            continue;
        }
        let end = levels(&beside, body).last()?.0;
        let part = levels(&beside, end);
        if part.chunk_by(|a, b| a.1 == b.1).any(|level| level.len() > WIDTH) {
            return None;
        }
        part.iter().for_each(|&(body, level)| rank_of[body] = Some((first + 2 * level, first)));
        first += 2 * part.last()?.1 + 3;
    }
    // A joint to the ground comes before the first level of its part, or with the joint after its body.
    let of_joint = |c: usize| match sides(c).map(|b| b.and_then(|b| rank_of[b])) {
        [Some((a, _)), Some((b, _))] => (a + b) / 2,
        [Some((rank, first)), None] | [None, Some((rank, first))] if rank == first => rank - 1,
        [Some((rank, _)), None] | [None, Some((rank, _))] => rank + 1,
        [None, None] => 0,
    };
    let mut ranks: Vec<usize> = (0..problem.contacts.len()).flat_map(|c| [of_joint(c); 2]).collect();
    // A body has the rank of the joint after it.
    ranks.extend(rank_of.iter().flat_map(|rank| [rank.map_or(0, |r| r.0 + 1); 3]));
    Some(ranks)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector2;
    use voussoir_core::limit::Counters;
    use voussoir_core::path::{Attachment, Contact, PathBody, PointLaw, Sliding};

    fn contact(minus: usize, plus: usize) -> Contact {
        let side = |body| Attachment { body, slot: None };
        Contact {
            joint: 0,
            position: Vector2::zeros(),
            normal: Vector2::x(),
            tangent: Vector2::y(),
            minus: side(minus),
            plus: side(plus),
            area: 1.0,
            gap: 0.0,
            law: PointLaw::Bonded,
            compliance: [1.0; 2],
            sliding: Sliding::middle(0.0),
        }
    }

    fn problem(bodies: usize, joints: &[(usize, usize)]) -> PathProblem {
        let held = |b: usize| PathBody { held: b == 0, ..PathBody::default() };
        PathProblem {
            bodies: (0..bodies).map(held).collect(),
            body_of: (0..bodies).collect(),
            contacts: joints.iter().map(|&(a, b)| contact(a, b)).collect(),
            load_steps: Vec::new(),
            length: 1.0,
            span: 1.0,
            width: 1.0,
            counters: Counters::new(),
        }
    }

    fn of(bodies: usize, joints: &[(usize, usize)]) -> Option<Vec<usize>> {
        let free: Vec<Option<usize>> = (0..bodies).map(|b| b.checked_sub(1)).collect();
        ranks(&problem(bodies, joints), &free)
    }

    /// An arch of three voussoirs between two ends of the ground, numbered from the middle.
    #[test]
    fn an_arch_is_a_chain_and_a_wall_is_none() {
        let ranks = of(4, &[(2, 1), (1, 3), (0, 2), (3, 0)]).unwrap();
        let joints: Vec<usize> = (0..4).map(|c| ranks[2 * c]).collect();
        let bodies: Vec<usize> = (0..3).map(|b| ranks[8 + 3 * b]).collect();
        let order = |mut along: Vec<usize>| {
            let up = along.is_sorted();
            along.reverse();
            up || along.is_sorted()
        };
        assert!(order(vec![joints[2], joints[0], joints[1], joints[3]]), "{ranks:?}");
        assert!(order(vec![bodies[1], bodies[0], bodies[2]]), "{ranks:?}");
        // Four bodies beside one.
        assert_eq!(of(6, &[(0, 1), (1, 2), (1, 3), (1, 4), (1, 5)]), None);
    }
}
