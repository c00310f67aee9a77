//! Compares a stored mechanism and thrust line with those computed from the stored motion and forces.

use crate::checks::fields::{EQUAL, close};
use crate::checks::findings::{Findings, mismatch};
use voussoir_core::certificate::{Hinge, Mechanism, MovingContact};
use voussoir_core::model::geometry::Vec2;

/// The source of values that are recomputed from the stored motion.
const MOTION: &str = "the stored motion gives";

/// The joints of hinges.
pub(crate) fn joints(hinges: &[Hinge]) -> Vec<usize> {
    hinges.iter().map(|hinge| hinge.joint).collect()
}

/// Compares a stored mechanism with the one that the stored motion gives.
pub(crate) fn compare(stored: Option<&Mechanism>, recomputed: Option<&Mechanism>, findings: &mut Findings) {
    match (stored, recomputed) {
        (Some(stored), Some(recomputed)) => findings.0.extend(differences(stored, recomputed)),
        (None, None) => {}
        (Some(_), None) => findings.expect(false, "mechanism is given, but motion is missing or moves no joint"),
        (None, Some(_)) => findings.expect(false, "motion is given, but mechanism is missing"),
    }
}

/// Returns the differences between a stored mechanism and the recomputed one.
fn differences(stored: &Mechanism, recomputed: &Mechanism) -> Vec<String> {
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
    if stored.at != recomputed.at {
        wrong.push("mechanism.at: only a mechanism of a path has a place on it".into());
    }
    if !same_contacts(&stored.contacts, &recomputed.contacts) {
        wrong.push("mechanism.contacts: they differ from those that the stored motion gives".into());
    }
    wrong
}

/// Returns true if two lists of moving contacts differ only by rounding, relative to the greatest number of their kind.
fn same_contacts(stored: &[MovingContact], recomputed: &[MovingContact]) -> bool {
    let words = |own: &MovingContact| (own.joint, own.between.clone(), own.modes.clone(), own.closed, own.points.len());
    let numbers: [fn(&MovingContact) -> Vec<f64>; 4] = [
        |own| own.rotation.to_vec(),
        |own| own.slip.iter().copied().chain([own.opening]).collect(),
        |own| own.points.concat(),
        |own| vec![own.share],
    ];
    let near = |of: &fn(&MovingContact) -> Vec<f64>| {
        let [a, b] = [stored, recomputed].map(|list| list.iter().flat_map(of).collect::<Vec<f64>>());
        let greatest = b.iter().fold(0.0f64, |most, x| most.max(x.abs()));
        a.len() == b.len() && a.iter().zip(&b).all(|(a, b)| a == b || (a - b).abs() <= EQUAL * greatest)
    };
    stored.iter().map(words).eq(recomputed.iter().map(words)) && numbers.iter().all(near)
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
