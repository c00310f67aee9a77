//! Random small scenes: stacks, portals, arches of three to five blocks and walls, each with its mirror image.

use std::fmt::Write as _;
use voussoir::core::random::Random;

/// A scene: blocks with their vertices \[m\]; the first are the ground.
#[derive(Debug, Clone)]
pub struct SmallScene {
    /// Name of the family.
    pub family: &'static str,
    blocks: Vec<Vec<[f64; 2]>>,
    grounds: usize,
    loaded: usize,
    at: [f64; 2],
    force: [f64; 2],
    friction: f64,
    stiffness: [f64; 2],
    segments: usize,
    /// True if slip dilates by the friction angle.
    pub associated: bool,
}

fn rectangle(low: [f64; 2], high: [f64; 2]) -> Vec<[f64; 2]> {
    vec![low, [high[0], low[1]], high, [low[0], high[1]]]
}

impl SmallScene {
    /// Returns the scene with this seed.
    pub fn of_seed(seed: u64) -> SmallScene {
        let mut numbers = Random::new(seed);
        let mut scene = match seed % 4 {
            0 => stack(&mut numbers),
            1 => portal(&mut numbers),
            2 => arch(&mut numbers),
            _ => wall(&mut numbers),
        };
        scene.friction = numbers.between(0.2, 0.9);
        let normal = numbers.power(6.7, 9.0);
        scene.stiffness = [normal, normal * numbers.between(0.3, 0.8)];
        scene.segments = numbers.whole(1, 3);
        scene
    }

    fn new(family: &'static str, grounds: usize, blocks: Vec<Vec<[f64; 2]>>) -> SmallScene {
        let (loaded, at, force) = (blocks.len() - 1, [0.0; 2], [0.0; 2]);
        let (friction, stiffness, segments) = (0.5, [1e8, 5e7], 2);
        SmallScene { family, blocks, grounds, loaded, at, force, friction, stiffness, segments, associated: false }
    }

    fn loaded(mut self, block: usize, at: [f64; 2], force: [f64; 2]) -> SmallScene {
        (self.loaded, self.at, self.force) = (block, at, force);
        self
    }

    /// Returns the mirror image at the line x = 0.
    pub fn mirrored(&self) -> SmallScene {
        let flip = |p: [f64; 2]| [-p[0], p[1]];
        let blocks = self.blocks.iter().map(|block| block.iter().rev().map(|p| flip(*p)).collect()).collect();
        SmallScene { blocks, at: flip(self.at), force: flip(self.force), ..self.clone() }
    }

    /// Returns the study; `solver` is a list of further lines of its solver's table.
    pub fn study(&self, solver: &str) -> String {
        let mut blocks = String::new();
        for (index, vertices) in self.blocks.iter().enumerate() {
            let fixed = if index < self.grounds { ", fixed = true" } else { "" };
            let _ = writeln!(blocks, "  {{ name = \"b{index}\", vertices = {vertices:?}{fixed} }},");
        }
        let law = if self.associated { "coulomb_associated" } else { "coulomb" };
        let SmallScene { friction, stiffness: [normal, shear], segments, loaded, at, force, .. } = self;
        format!(
            r#"name = "{}"
[scene]
scene = "blocks"
width = 1.0
material = "stone"
joint = "dry"
blocks = [
{blocks}]
[scene.mesh]
elements = [1, {segments}]
[materials.stone]
law = "rigid"
density = 2000.0
[joints.dry]
law = "{law}"
friction = {friction:?}
normal_stiffness = {normal:?}
shear_stiffness = {shear:?}
[solver]
kinematics = "finite"
{solver}
[[stages]]
name = "dead"
gravity = 9.81
[[stages]]
name = "live"
until = "collapse"
loads = [{{ kind = "point", block = "b{loaded}", point = {at:?}, force = {force:?} }}]
"#,
            self.family
        )
    }
}

/// A stack of blocks with a horizontal push on one of the upper blocks.
fn stack(numbers: &mut Random) -> SmallScene {
    let mut blocks = vec![rectangle([-3.0, -0.4], [3.0, 0.0])];
    let (mut low, mut width, mut middle) = (0.0, numbers.between(0.5, 0.9), 0.0);
    for _ in 0..numbers.whole(2, 5) {
        let high = low + numbers.between(0.25, 0.7);
        blocks.push(rectangle([middle - width / 2.0, low], [middle + width / 2.0, high]));
        (low, middle) = (high, middle + width * numbers.between(-0.08, 0.08));
        width *= numbers.between(0.75, 0.99);
    }
    let loaded = numbers.whole(blocks.len() / 2, blocks.len() - 1).max(1);
    let [corner, _, top, _] = blocks[loaded].clone()[..] else { unreachable!("a rectangle") };
    let height = corner[1] + (top[1] - corner[1]) * numbers.between(0.2, 0.9);
    SmallScene::new("stack", 1, blocks).loaded(loaded, [corner[0], height], [1000.0, 0.0])
}

/// Two posts of one or two blocks and a lintel.
fn portal(numbers: &mut Random) -> SmallScene {
    let mut blocks = vec![rectangle([-3.0, -0.4], [3.0, 0.0])];
    let (half, width, height) = (numbers.between(0.5, 0.9), numbers.between(0.3, 0.6), numbers.between(0.6, 1.4));
    let courses = numbers.whole(1, 2);
    for side in [-1.0, 1.0] {
        let width = width * numbers.between(0.9, 1.1);
        for course in 0..courses {
            let low = height * course as f64 / courses as f64;
            let high = height * (course + 1) as f64 / courses as f64;
            let x = side * half;
            blocks.push(rectangle([x - width / 2.0, low], [x + width / 2.0, high]));
        }
    }
    let [left, right] = [-half - width * numbers.between(0.1, 0.4), half + width * numbers.between(0.1, 0.4)];
    let top = height + numbers.between(0.25, 0.5);
    blocks.push(rectangle([left, height], [right, top]));
    let last = blocks.len() - 1;
    let scene = SmallScene::new("portal", 1, blocks);
    if numbers.chance(0.7) {
        return scene.loaded(last, [left, height + (top - height) * numbers.between(0.1, 0.9)], [1000.0, 0.0]);
    }
    let x = left + (right - left) * numbers.between(0.1, 0.9);
    scene.loaded(last, [x, top], [numbers.between(300.0, 900.0), -1000.0])
}

/// Voussoirs between two springings.
fn arch(numbers: &mut Random) -> SmallScene {
    let (count, radius, thickness) = (numbers.whole(3, 5), numbers.between(1.5, 3.0), numbers.between(0.3, 0.7));
    let half = numbers.between(35.0, 75.0f64).to_radians();
    let at = |k: f64, r: f64| {
        let angle = half * (1.0 - 2.0 * k / count as f64);
        [-r * angle.sin(), r * angle.cos()]
    };
    let outer = radius + thickness;
    let voussoir = |from: f64, to: f64| vec![at(from, outer), at(from, radius), at(to, radius), at(to, outer)];
    let n = count as f64;
    let mut blocks = vec![voussoir(-0.3, 0.0), voussoir(n, n + 0.3)];
    blocks.extend((0..count).map(|k| voussoir(k as f64, k as f64 + 1.0)));
    let loaded = numbers.whole(0, count - 1);
    let [a, b] = [at(loaded as f64, outer), at(loaded as f64 + 1.0, outer)];
    let share = numbers.between(0.1, 0.9);
    let place = [a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share];
    let force = [numbers.between(-500.0, 500.0), -1000.0];
    SmallScene::new("arch", 2, blocks).loaded(loaded + 2, place, force)
}

/// Two or three courses of one, two and one blocks.
fn wall(numbers: &mut Random) -> SmallScene {
    let mut blocks = vec![rectangle([-3.0, -0.4], [3.0, 0.0])];
    let (length, courses) = (numbers.between(0.4, 0.7), numbers.whole(2, 3));
    let mut low = 0.0;
    for course in 0..courses {
        let high = low + numbers.between(0.2, 0.45);
        if course % 2 == 0 {
            let shift = numbers.between(-0.15, 0.15) * length;
            blocks.push(rectangle([-length, low], [shift, high]));
            blocks.push(rectangle([shift, low], [length, high]));
        } else {
            blocks.push(rectangle(
                [-length * numbers.between(0.6, 1.0), low],
                [length * numbers.between(0.6, 1.0), high],
            ));
        }
        low = high;
    }
    // The push acts on the left face of the lowest block of the top course.
    let loaded = if courses == 3 { blocks.len() - 2 } else { blocks.len() - 1 };
    let [corner, _, top, _] = blocks[loaded].clone()[..] else { unreachable!("a rectangle") };
    let height = corner[1] + (top[1] - corner[1]) * numbers.between(0.2, 0.9);
    SmallScene::new("wall", 1, blocks).loaded(loaded, [corner[0], height], [1000.0, 0.0])
}
