//! Shapes of the families: stacks, portals, arches and walls with their loads and settlements.

use super::{Block, Family, FamilyScene, Law, Load};
use voussoir::core::random::Random;

fn rectangle(low: [f64; 2], high: [f64; 2]) -> Block {
    Block { vertices: [low, [high[0], low[1]], high, [low[0], high[1]]], fixed: false }
}

fn ground(from: f64, to: f64) -> Block {
    Block { fixed: true, ..rectangle([from, -0.4], [to, 0.0]) }
}

fn scene(shape: &'static str, blocks: Vec<Block>, loads: Vec<Load>) -> FamilyScene {
    FamilyScene {
        shape,
        law: Law::Coulomb,
        finite: false,
        friction: 0.5,
        stiffness: None,
        moduli: Vec::new(),
        blocks,
        elements: [1, 1],
        loads,
        settlements: Vec::new(),
    }
}

/// Returns a scene of a family without law and stiffness.
pub fn drawn(family: Family, numbers: &mut Random) -> FamilyScene {
    match family {
        Family::Random => any(numbers, 1.0),
        Family::Symmetric => symmetric(numbers),
        Family::Bricks => bricks(numbers),
        Family::Settlements => settled(numbers),
        Family::Finite => any(numbers, 0.4),
    }
}

/// Returns a shape of unequal blocks; a small `rise` makes arches shallow and stacks slender.
fn any(numbers: &mut Random, rise: f64) -> FamilyScene {
    match numbers.whole(0, 3) {
        0 => stack(numbers, rise),
        1 => portal(numbers, false),
        2 => {
            let half = numbers.between(35.0, 75.0) * if numbers.chance(0.5) { rise } else { 1.0 };
            let count = numbers.whole(3, 7);
            arch(numbers, count, half)
        }
        _ => wall(numbers),
    }
}

/// A stack of blocks with a horizontal push on one of the upper blocks.
fn stack(numbers: &mut Random, slender: f64) -> FamilyScene {
    let mut blocks = vec![ground(-3.0, 3.0)];
    let (mut low, mut width, mut middle) = (0.0, numbers.between(0.5, 0.9) * slender.sqrt(), 0.0);
    for _ in 0..numbers.whole(2, 6) {
        let high = low + numbers.between(0.25, 0.7);
        blocks.push(rectangle([middle - width / 2.0, low], [middle + width / 2.0, high]));
        (low, middle) = (high, middle + width * numbers.between(-0.08, 0.08));
        width *= numbers.between(0.75, 0.99);
    }
    let block = numbers.whole(blocks.len() / 2, blocks.len() - 1).max(1);
    let load = pushed(numbers, &blocks, block);
    scene("stack", blocks, vec![load])
}

/// A push on the left face of a rectangle.
fn pushed(numbers: &mut Random, blocks: &[Block], block: usize) -> Load {
    let [corner, _, top, _] = blocks[block].vertices;
    let height = corner[1] + (top[1] - corner[1]) * numbers.between(0.2, 0.9);
    Load::Point { block, point: [corner[0], height], force: [1000.0, 1000.0 * numbers.between(-0.3, 0.0)] }
}

/// Two posts of one or two blocks and a lintel, on one ground or on two.
fn portal(numbers: &mut Random, two_grounds: bool) -> FamilyScene {
    let mut blocks = if two_grounds { vec![ground(-2.0, -0.1), ground(0.1, 2.0)] } else { vec![ground(-2.0, 2.0)] };
    let (half, width, height) = (numbers.between(0.55, 0.9), numbers.between(0.3, 0.6), numbers.between(0.6, 1.4));
    let courses = numbers.whole(1, 2);
    for side in [-1.0, 1.0] {
        let width = width * numbers.between(0.9, 1.1);
        for course in 0..courses {
            let level = |k: usize| height * k as f64 / courses as f64;
            let x = side * half;
            blocks.push(rectangle([x - width / 2.0, level(course)], [x + width / 2.0, level(course + 1)]));
        }
    }
    let [left, right] = [-half - width * numbers.between(0.1, 0.4), half + width * numbers.between(0.1, 0.4)];
    let top = height + numbers.between(0.25, 0.5);
    blocks.push(rectangle([left, height], [right, top]));
    let block = blocks.len() - 1;
    let load = if numbers.chance(0.7) {
        pushed(numbers, &blocks, block)
    } else {
        let x = left + (right - left) * numbers.between(0.1, 0.9);
        Load::Point { block, point: [x, top], force: [numbers.between(300.0, 900.0), -1000.0] }
    };
    scene("portal", blocks, vec![load])
}

/// Returns the position of a polar point of an arch: share 0 is the left springing, 1 the right one.
fn polar(half: f64, share: f64, radius: f64) -> [f64; 2] {
    let angle = half * (1.0 - 2.0 * share);
    [-radius * angle.sin(), radius * angle.cos()]
}

/// Returns two springings and equal voussoirs; `half` is half the opening angle \[degrees\].
fn ring(count: usize, radius: f64, thickness: f64, half: f64) -> Vec<Block> {
    let half = half.to_radians();
    let at = |k: f64, r: f64| polar(half, k / count as f64, r);
    let outer = radius + thickness;
    let voussoir = |from: f64, to: f64, fixed: bool| Block {
        vertices: [at(from, outer), at(from, radius), at(to, radius), at(to, outer)],
        fixed,
    };
    let n = count as f64;
    let mut blocks = vec![voussoir(-0.3, 0.0, true), voussoir(n, n + 0.3, true)];
    blocks.extend((0..count).map(|k| voussoir(k as f64, k as f64 + 1.0, false)));
    blocks
}

/// Returns a force on the extrados of a block of a ring, at a share of its chord.
fn on_extrados(blocks: &[Block], block: usize, share: f64, force: [f64; 2]) -> Load {
    let [a, _, _, b] = blocks[block].vertices;
    let point = [0, 1].map(|k| a[k] + (b[k] - a[k]) * share);
    Load::Point { block, point, force }
}

/// Voussoirs between two springings.
fn arch(numbers: &mut Random, count: usize, half: f64) -> FamilyScene {
    let radius = numbers.between(1.5, 3.0);
    let blocks = ring(count, radius, radius * numbers.between(0.15, 0.3), half);
    let force = [numbers.between(-400.0, 400.0), -1000.0];
    let load = on_extrados(&blocks, 2 + numbers.whole(0, count - 1), numbers.between(0.1, 0.9), force);
    scene("arch", blocks, vec![load])
}

/// Two or three courses of two blocks and of one block.
fn wall(numbers: &mut Random) -> FamilyScene {
    let mut blocks = vec![ground(-2.0, 2.0)];
    let (length, courses) = (numbers.between(0.4, 0.7), numbers.whole(2, 3));
    let mut low = 0.0;
    for course in 0..courses {
        let high = low + numbers.between(0.2, 0.45);
        if course % 2 == 0 {
            let shift = numbers.between(-0.15, 0.15) * length;
            blocks.push(rectangle([-length, low], [shift, high]));
            blocks.push(rectangle([shift, low], [length, high]));
        } else {
            let ends = [0; 2].map(|_| length * numbers.between(0.6, 1.0));
            blocks.push(rectangle([-ends[0], low], [ends[1], high]));
        }
        low = high;
    }
    // The lowest block on the left of the top course.
    let block = if courses == 3 { blocks.len() - 2 } else { blocks.len() - 1 };
    let load = pushed(numbers, &blocks, block);
    scene("wall", blocks, vec![load])
}

/// A shape with a vertical axis of symmetry; loads are symmetric, or horizontal.
fn symmetric(numbers: &mut Random) -> FamilyScene {
    match numbers.whole(0, 3) {
        0 => {
            let count = 2 * numbers.whole(1, 3) + 1;
            let radius = numbers.between(1.5, 3.0);
            let blocks = ring(count, radius, radius * numbers.between(0.12, 0.25), numbers.between(40.0, 85.0));
            let crown = on_extrados(&blocks, 2 + count / 2, 0.5, [0.0, -1000.0]);
            scene("arch", blocks, vec![crown])
        }
        1 => {
            let count = 2 * numbers.whole(2, 3);
            let radius = numbers.between(1.5, 3.0);
            let blocks = ring(count, radius, radius * numbers.between(0.12, 0.25), numbers.between(40.0, 85.0));
            let (place, share) = (numbers.whole(0, count / 2 - 1), numbers.between(0.1, 0.9));
            let side = numbers.between(-300.0, 300.0);
            let left = on_extrados(&blocks, 2 + place, share, [side, -1000.0]);
            let right = on_extrados(&blocks, 1 + count - place, 1.0 - share, [-side, -1000.0]);
            scene("arch", blocks, vec![left, right])
        }
        2 => symmetric_portal(numbers),
        _ => symmetric_wall(numbers),
    }
}

/// Two equal posts and a lintel; the posts are pushed outwards, or the lintel is pushed to the right.
fn symmetric_portal(numbers: &mut Random) -> FamilyScene {
    let (half, width, height) = (numbers.between(0.55, 0.9), numbers.between(0.3, 0.6), numbers.between(0.6, 1.4));
    let top = height + numbers.between(0.25, 0.5);
    let reach = half + width * numbers.between(0.1, 0.4);
    let post = |x: f64| rectangle([x - width / 2.0, 0.0], [x + width / 2.0, height]);
    let blocks = vec![ground(-2.0, 2.0), post(-half), post(half), rectangle([-reach, height], [reach, top])];
    let level = height * numbers.between(0.5, 0.95);
    let inner = half - width / 2.0;
    let outwards =
        |block: usize, side: f64| Load::Point { block, point: [side * inner, level], force: [side * 1000.0, 0.0] };
    let loads = if numbers.chance(0.6) {
        vec![outwards(1, -1.0), outwards(2, 1.0)]
    } else {
        vec![Load::Point { block: 3, point: [-reach, 0.5 * (height + top)], force: [1000.0, 0.0] }]
    };
    scene("portal", blocks, loads)
}

/// Two blocks, one block on both, and again two. The lower blocks are pulled apart, or all blocks are pushed to the
/// right.
fn symmetric_wall(numbers: &mut Random) -> FamilyScene {
    let (length, height) = (numbers.between(0.4, 0.7), numbers.between(0.2, 0.45));
    let mut blocks = vec![ground(-2.0, 2.0)];
    let pair =
        |low: f64| [rectangle([-length, low], [0.0, low + height]), rectangle([0.0, low], [length, low + height])];
    let middle = length * numbers.between(0.6, 1.0);
    blocks.extend(pair(0.0));
    blocks.push(rectangle([-middle, height], [middle, 2.0 * height]));
    if numbers.chance(0.5) {
        blocks.extend(pair(2.0 * height));
    }
    let level = height * numbers.between(0.2, 0.8);
    let apart =
        |block: usize, side: f64| Load::Point { block, point: [side * length, level], force: [side * 1000.0, 0.0] };
    let loads =
        if numbers.chance(0.5) { vec![apart(1, -1.0), apart(2, 1.0)] } else { vec![Load::Body { acceleration: 9.81 }] };
    scene("wall", blocks, loads)
}

/// Equal blocks: a wall in running bond, a stack, or a half circle.
fn bricks(numbers: &mut Random) -> FamilyScene {
    let push = |block: usize, point: [f64; 2]| Load::Point { block, point, force: [1000.0, 0.0] };
    match numbers.whole(0, 2) {
        0 => {
            let (courses, count) = (numbers.whole(2, 3), numbers.whole(1, 2));
            let mut blocks = vec![ground(-1.0, 2.0)];
            for course in 0..courses {
                let (low, shift) = (0.2 * course as f64, if course % 2 == 0 { 0.0 } else { 0.2 });
                for k in 0..count {
                    let left = 0.4 * k as f64 + shift;
                    blocks.push(rectangle([left, low], [left + 0.4, low + 0.2]));
                }
            }
            let block = blocks.len() - count;
            let [corner, ..] = blocks[block].vertices;
            let loads = if numbers.chance(0.5) {
                vec![Load::Body { acceleration: 9.81 }]
            } else {
                vec![push(block, [corner[0], corner[1] + 0.1])]
            };
            scene("wall", blocks, loads)
        }
        1 => {
            let (count, height) = (numbers.whole(2, 6), *numbers.one_of(&[0.25, 0.5, 1.0]));
            let mut blocks = vec![ground(-1.0, 1.0)];
            let levels = (0..count).map(|k| height * k as f64);
            blocks.extend(levels.map(|low| rectangle([-0.25, low], [0.25, low + height])));
            let block = numbers.whole(1, count);
            let loads = if numbers.chance(0.5) {
                vec![Load::Body { acceleration: 9.81 }]
            } else {
                vec![push(block, [-0.25, height * (block as f64 - 0.5)])]
            };
            scene("stack", blocks, loads)
        }
        _ => {
            let (count, half) = (numbers.whole(3, 7), *numbers.one_of(&[45.0, 60.0, 90.0]));
            let thickness = *numbers.one_of(&[0.25, 0.4, 0.5]);
            let blocks = ring(count, 2.0, thickness, half);
            let place = numbers.whole(0, count / 2);
            let load = on_extrados(&blocks, 2 + place, 0.5, [0.0, -1000.0]);
            scene("arch", blocks, vec![load])
        }
    }
}

/// An arch, a portal on two grounds, or a stack, on supports that move.
fn settled(numbers: &mut Random) -> FamilyScene {
    let size = numbers.power(-4.0, -2.3);
    let mut scene = match numbers.whole(0, 2) {
        0 => {
            let (count, half) = (numbers.whole(4, 7), numbers.between(35.0, 75.0));
            arch(numbers, count, half)
        }
        1 => portal(numbers, true),
        _ => stack(numbers, 1.0),
    };
    let span = 3.0;
    let grounds = scene.blocks.iter().filter(|block| block.fixed).count();
    let motion = |numbers: &mut Random| match numbers.whole(0, 3) {
        0 => [size * span, 0.0, 0.0],
        1 => [-size * span, 0.0, 0.0],
        2 => [0.0, -size * span, 0.0],
        _ => [0.0, 0.0, 2.0 * size * if numbers.chance(0.5) { 1.0 } else { -1.0 }],
    };
    let moved = if grounds == 2 && numbers.chance(0.3) { vec![0, 1] } else { vec![numbers.whole(0, grounds - 1)] };
    scene.settlements = moved.into_iter().map(|support| (support, motion(numbers))).collect();
    scene
}
