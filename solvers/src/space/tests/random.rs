//! Random assemblies: the interior point method of this crate and Clarabel prove brackets that overlap.

use super::scenes::{COLLAPSE, Scene, certified, rectangle};
use crate::space::{solve, solve_by_clarabel};
use voussoir_core::limit::Status;
use voussoir_core::random::Random;
use voussoir_core::space::Vec3;

/// Returns a stack of boxes of random size and offset with random friction.
fn stack(random: &mut Random) -> Scene {
    let mut scene = Scene::default();
    let mut below = (None, [-10.0, 10.0], [-10.0, 10.0], 0.0);
    for _ in 0..random.whole(2, 6) {
        let mut side = || {
            let (centre, half) = (0.3 * random.between(-1.0, 1.0), random.between(0.4, 0.9));
            [centre - half, centre + half]
        };
        let (x, y) = (side(), side());
        let (z, height) = (below.3, random.between(0.2, 0.8));
        let body = scene.add_box(x, y, [z, z + height]);
        let overlap = |a: [f64; 2], b: [f64; 2]| [a[0].max(b[0]), a[1].min(b[1])];
        let face = rectangle(overlap(x, below.1), overlap(y, below.2), z);
        scene.contacts.push((below.0, Some(body), face, Vec3::z(), random.between(0.2, 0.9)));
        below = (Some(body), x, y, z + height);
    }
    scene
}

/// Both routes certify the same status of random stacks, and brackets with a common point.
#[test]
fn both_routes_prove_overlapping_brackets_of_random_stacks() {
    let mut random = Random::new(47);
    let (mut collapses, mut near) = (0, 0);
    for case in 0..60 {
        let direction = Vec3::new(random.between(-1.0, 1.0), random.between(-1.0, 1.0), random.between(-0.3, 0.3));
        let problem = stack(&mut random).problem(&direction);
        let [own, other] = [solve(&problem, COLLAPSE), solve_by_clarabel(&problem, COLLAPSE)];
        let verdict = certified(&problem, &own, COLLAPSE);
        assert_eq!(verdict.status, own.status, "{case} {:?} {:?}", own.notes, verdict.certificate);
        assert!(own.status.is_answer(), "{case}: {:?}", own.notes);
        let second = certified(&problem, &other, COLLAPSE);
        if own.status == Status::Collapse {
            let ([Some(low), Some(high)], [least, most]) = (verdict.bounds, second.bounds) else { panic!("{case}") };
            // Brackets that are both proved have a common point.
            assert!(least.is_none_or(|least| least <= high), "{case}: {least:?} above {high}");
            assert!(most.is_none_or(|most| most >= low), "{case}: {most:?} below {low}");
            near += usize::from(least.zip(most).is_some_and(|(least, most)| most - least <= 1e-3 * low));
            collapses += 1;
        } else {
            assert_eq!(own.status, other.status, "{case}: {:?}", other.notes);
        }
    }
    assert!(collapses >= 30 && near >= 30, "{collapses} {near}");
}
