//! Compares a stored mechanism and thrust line with those computed from the stored motion and forces.

use crate::checks::fields::{EQUAL, close};
use crate::checks::findings::mismatch;
use voussoir_core::certificate::{Hinge, Mechanism};
use voussoir_core::model::geometry::Vec2;

/// The source of values that are recomputed from the stored motion.
const MOTION: &str = "the stored motion gives";

/// The joints of hinges.
pub(crate) fn joints(hinges: &[Hinge]) -> Vec<usize> {
    hinges.iter().map(|hinge| hinge.joint).collect()
}

/// Returns the differences between a stored mechanism and the recomputed one.
pub(crate) fn differences(stored: &Mechanism, recomputed: &Mechanism) -> Vec<String> {
    let mut wrong = Vec::new();
    if stored.kind != recomputed.kind {
        wrong.push(mismatch("mechanism.kind", (stored.kind, MOTION, recomputed.kind)));
    }
    if stored.hinge_count != recomputed.hinge_count {
        wrong.push(mismatch("mechanism.hinge_count", (stored.hinge_count, MOTION, recomputed.hinge_count)));
    }
    let hinges = stored.hinges.len() == recomputed.hinges.len()
        && stored.hinges.iter().zip(&recomputed.hinges).all(|(a, b)| {
            (a.joint, &a.between, a.side) == (b.joint, &b.between, b.side)
                && close(a.rotation, b.rotation)
                && (Vec2::from(a.point) - Vec2::from(b.point)).norm() <= EQUAL * (1.0 + Vec2::from(b.point).norm())
        });
    if !hinges {
        let lists = (joints(&stored.hinges), MOTION, joints(&recomputed.hinges));
        wrong.push(match lists.0 == lists.2 {
            true => {
                "mechanism.hinges: sides, points or rotations differ from those that the stored motion gives".into()
            }
            false => mismatch("the list of joints in mechanism.hinges", lists),
        });
    }
    let sliding = stored.sliding.len() == recomputed.sliding.len()
        && stored
            .sliding
            .iter()
            .zip(&recomputed.sliding)
            .all(|(a, b)| (a.joint, &a.between) == (b.joint, &b.between) && close(a.slip, b.slip));
    let crushing = stored.crushing.len() == recomputed.crushing.len()
        && stored
            .crushing
            .iter()
            .zip(&recomputed.crushing)
            .all(|(a, b)| (a.joint, &a.between) == (b.joint, &b.between) && close(a.share, b.share));
    if !sliding || !crushing {
        wrong.push("mechanism: sliding or crushing joints differ from those that the stored motion gives".into());
    }
    wrong
}

/// Returns true if two thrust lines differ only by rounding.
pub(crate) fn same_line(a: &Option<Vec<Option<[f64; 2]>>>, b: &Option<Vec<Option<[f64; 2]>>>) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => {
            a.len() == b.len()
                && a.iter().zip(b).all(|pair| match pair {
                    (Some(p), Some(q)) => {
                        (Vec2::from(*p) - Vec2::from(*q)).norm() <= EQUAL * (1.0 + Vec2::from(*q).norm())
                    }
                    (None, None) => true,
                    _ => false,
                })
        }
        (None, None) => true,
        _ => false,
    }
}
