//! Random assemblies: the interior point method of this crate and Clarabel prove brackets that overlap.

use super::scenes::{COLLAPSE, Scene, certified, rectangle};
use crate::space::{solve, solve_by_clarabel};
use std::collections::BTreeMap;
use voussoir_core::limit::Status;
use voussoir_core::random::Random;
use voussoir_core::space::Vec3;

/// Returns a stack of boxes of random size and offset with random friction.
pub fn stack(random: &mut Random) -> Scene {
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

/// Returns boxes in the cells of a grid, some of them missing, with contacts to all neighbours and to the ground. One
/// contact in ten has no friction.
pub fn grid(random: &mut Random) -> Scene {
    let count: [usize; 3] = std::array::from_fn(|_| random.whole(1, 3));
    let lines = count.map(|count| {
        let mut line = vec![0.0];
        for k in 0..count {
            line.push(line[k] + random.between(0.5, 1.5));
        }
        line
    });
    let mut scene = Scene::default();
    let mut cells = BTreeMap::new();
    for x in 0..count[0] {
        for y in 0..count[1] {
            for z in 0..count[2] {
                if random.chance(0.2) {
                    continue;
                }
                let side = |axis: usize, cell: usize| [lines[axis][cell], lines[axis][cell + 1]];
                let body = scene.add_box(side(0, x), side(1, y), side(2, z));
                cells.insert([x, y, z], body);
                let mut friction = || if random.chance(0.1) { 0.0 } else { random.between(0.2, 0.9) };
                let own = [side(0, x), side(1, y), side(2, z)];
                for axis in 0..3 {
                    let before = |cell: [usize; 3]| cell[axis].checked_sub(1).map(|k| (axis, k));
                    let under = before([x, y, z]).map(|(axis, k)| {
                        let mut cell = [x, y, z];
                        cell[axis] = k;
                        cells.get(&cell).copied()
                    });
                    let minus = match under {
                        None if axis == 2 => None,
                        Some(Some(body)) => Some(body),
                        _ => continue,
                    };
                    let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
                    let corner = |i: usize, j: usize| {
                        let mut corner = Vec3::zeros();
                        (corner[axis], corner[b], corner[c]) = (own[axis][0], own[b][i], own[c][j]);
                        corner
                    };
                    let mut normal = Vec3::zeros();
                    normal[axis] = 1.0;
                    let face = vec![corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
                    scene.contacts.push((minus, Some(body), face, normal, friction()));
                }
            }
        }
    }
    scene
}

/// Random grids of blocks, some without support or friction, end with a certified status.
#[test]
fn random_grids_of_blocks_are_decided() {
    let mut random = Random::new(2026);
    let mut count = BTreeMap::new();
    let mut undecided = Vec::new();
    for case in 0..300 {
        let direction = Vec3::new(random.between(-1.0, 1.0), random.between(-1.0, 1.0), random.between(-0.3, 0.3));
        let problem = grid(&mut random).problem(&direction);
        let answer = solve(&problem, COLLAPSE);
        let verdict = certified(&problem, &answer, COLLAPSE);
        *count.entry(format!("{:?}", verdict.status)).or_insert(0) += 1;
        if !verdict.status.is_answer() {
            undecided
                .push(format!("{case} {:?} {:?} {:?}", verdict.bounds, answer.notes, verdict.certificate.failures));
        }
    }
    assert!(undecided.is_empty(), "{count:?} {undecided:#?}");
    assert!(count.values().filter(|count| **count >= 30).count() >= 2, "{count:?}");
}
