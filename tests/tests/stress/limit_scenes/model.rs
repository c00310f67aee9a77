//! Blocks, joints and loads of any assembly as a conic program: N, T, M at the middle of every joint, and λ.

use crate::conic::{Extreme, Rows};

pub type Point = [f64; 2];

/// Friction above which a joint does not slide.
const NO_SLIDING: f64 = 1e11;

/// Strength of a joint: |T| ≤ c A + μ N, |M| ≤ (N + f_t A)(f_c A − N) h / (2 A (f_c + f_t)).
#[derive(Debug, Clone, PartialEq)]
pub struct Law {
    pub tag: &'static str,
    /// Infinite if it never slides.
    pub friction: f64,
    pub cohesion: f64,
    pub tensile: f64,
    /// Infinite if it never crushes.
    pub compressive: f64,
}

impl Law {
    /// Returns dry friction with a tag.
    pub fn dry(tag: &'static str, friction: f64) -> Law {
        Law { tag, friction, cohesion: 0.0, tensile: 0.0, compressive: f64::INFINITY }
    }

    /// Returns the table for a study.
    pub fn table(&self) -> String {
        let mut text = format!("law = \"{}\"\n", self.tag);
        match self.tag {
            "unilateral" if self.friction == 0.0 => text += "tangential = \"free\"\n",
            "unilateral" => text += "tangential = \"stuck\"\n",
            _ => text += &format!("friction = {:?}\n", self.friction),
        }
        if self.tag == "mohr_coulomb" {
            text += &format!("cohesion = {:?}\ntensile_strength = {:?}\n", self.cohesion, self.tensile);
            if self.compressive.is_finite() {
                text += &format!("compressive_strength = {:?}\n", self.compressive);
            }
        }
        text
    }

    /// Returns true if the rounding of a motion times the strengths is significant.
    pub fn is_enormous(&self) -> bool {
        self.cohesion > 1e9 || (self.compressive > 1e9 && self.compressive.is_finite())
    }

    /// Returns the tension per area at which opening or sliding ends.
    fn apex(&self) -> f64 {
        if self.friction > 0.0 && self.friction.is_finite() {
            self.tensile.min(self.cohesion / self.friction)
        } else {
            self.tensile
        }
    }
}

/// A block; `held` if the ground holds it, directly or by a bond.
#[derive(Debug, Clone)]
pub struct Block {
    pub name: String,
    pub polygon: Vec<Point>,
    pub held: bool,
    pub density: f64,
}

/// A straight joint. The second block is on the right of the direction between its ends.
#[derive(Debug, Clone)]
pub struct Contact {
    pub on: [usize; 2],
    pub ends: [Point; 2],
    pub law: usize,
}

/// A force on a block.
#[derive(Debug, Clone)]
pub struct Force {
    pub block: usize,
    pub point: Point,
    pub force: Point,
}

/// The whole model: forces at factor 1, and accelerations of all blocks.
#[derive(Debug, Clone, Default)]
pub struct Model {
    pub blocks: Vec<Block>,
    pub contacts: Vec<Contact>,
    pub laws: Vec<Law>,
    pub width: f64,
    pub gravity: Point,
    pub forces: Vec<Force>,
    pub acceleration: Point,
}

/// The factors that are carried.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Carried {
    No,
    /// From the least to the greatest; either may be infinite.
    Between([f64; 2]),
    /// The program was not decided.
    Unknown,
}

fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn cross(a: Point, b: Point) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// Returns area and centroid of an anticlockwise polygon.
pub fn area_centroid(polygon: &[Point]) -> (f64, Point) {
    let (origin, mut area, mut sum) = (polygon[0], 0.0, [0.0; 2]);
    for pair in polygon[1..].windows(2) {
        let (a, b) = (minus(pair[0], origin), minus(pair[1], origin));
        let part = cross(a, b) / 2.0;
        area += part;
        (0..2).for_each(|d| sum[d] += part * (a[d] + b[d]) / 3.0);
    }
    (area, [origin[0] + sum[0] / area, origin[1] + sum[1] / area])
}

fn edges(polygon: &[Point]) -> impl Iterator<Item = [Point; 2]> {
    (0..polygon.len()).map(|i| [polygon[i], polygon[(i + 1) % polygon.len()]])
}

impl Model {
    /// Returns centre and size of the scene.
    fn frame(&self) -> (Point, f64) {
        let points = || self.blocks.iter().flat_map(|block| &block.polygon);
        let most = |d: usize| points().fold(f64::NEG_INFINITY, |most, p| most.max(p[d]));
        let least = |d: usize| points().fold(f64::INFINITY, |least, p| least.min(p[d]));
        let size = (most(0) - least(0)).hypot(most(1) - least(1));
        ([(most(0) + least(0)) / 2.0, (most(1) + least(1)) / 2.0], size)
    }

    /// Adds the overlaps of edges as joints, each with the law that `law` returns for the two blocks.
    pub fn join(&mut self, law: impl Fn(usize, usize) -> usize) {
        let (_, size) = self.frame();
        let tolerance = 1e-9 * size;
        for a in 0..self.blocks.len() {
            for b in a + 1..self.blocks.len() {
                if self.blocks[a].held && self.blocks[b].held {
                    continue;
                }
                for [p, q] in edges(&self.blocks[a].polygon) {
                    let length = minus(q, p)[0].hypot(minus(q, p)[1]);
                    let t = [(q[0] - p[0]) / length, (q[1] - p[1]) / length];
                    for [r, s] in edges(&self.blocks[b].polygon) {
                        let off = |x: Point| cross(t, minus(x, p)).abs();
                        if off(r) > tolerance || off(s) > tolerance || dot(t, minus(s, r)) >= 0.0 {
                            continue;
                        }
                        let (from, to) = (dot(t, minus(s, p)).max(0.0), dot(t, minus(r, p)).min(length));
                        if to - from > tolerance {
                            let at = |x: f64| [p[0] + t[0] * x, p[1] + t[1] * x];
                            // The outside of an anticlockwise polygon is on the right of every edge.
                            self.contacts.push(Contact { on: [a, b], ends: [at(from), at(to)], law: law(a, b) });
                        }
                    }
                }
            }
        }
    }

    /// Returns the sums of dead and live forces on each block, with their moments about a point.
    fn loads(&self, pole: Point) -> [Vec<[f64; 3]>; 2] {
        let mut loads = [vec![[0.0; 3]; self.blocks.len()], vec![[0.0; 3]; self.blocks.len()]];
        let mut add = |which: usize, block: usize, point: Point, force: Point| {
            let sum = &mut loads[which][block];
            sum[0] += force[0];
            sum[1] += force[1];
            sum[2] += cross(minus(point, pole), force);
        };
        for (index, block) in self.blocks.iter().enumerate().filter(|(_, block)| !block.held) {
            let (area, centroid) = area_centroid(&block.polygon);
            let mass = area * self.width * block.density;
            add(0, index, centroid, self.gravity.map(|a| mass * a));
            add(1, index, centroid, self.acceleration.map(|a| mass * a));
        }
        for Force { block, point, force } in self.forces.iter().filter(|force| !self.blocks[force.block].held) {
            add(1, *block, *point, *force);
        }
        loads
    }

    /// Returns true if the live load on a block is greater than the rounding error of forces that cancel.
    pub fn is_loaded(&self) -> bool {
        let (pole, size) = self.frame();
        let single: f64 = self.forces.iter().map(|force| force.force[0].hypot(force.force[1])).sum();
        let [_, live] = self.loads(pole).map(|loads| greatest(&loads, size));
        live > 1e-9 * single
    }

    /// Returns the distance of the scene from the origin, in units of its size.
    pub fn sizes_from_origin(&self) -> f64 {
        let (pole, size) = self.frame();
        pole[0].hypot(pole[1]) / size
    }

    /// Returns the factor at which live loads have the size of dead loads.
    pub fn typical_factor(&self) -> f64 {
        let (pole, size) = self.frame();
        let [dead, live] = self.loads(pole).map(|loads| greatest(&loads, size));
        if dead > 0.0 && live > 0.0 { dead / live } else { 1.0 }
    }

    /// Returns the factors that are carried.
    pub fn carried(&self) -> Carried {
        let (pole, size) = self.frame();
        if self.loads(pole).iter().all(|loads| greatest(loads, size) == 0.0) {
            return Carried::Between([f64::NEG_INFINITY, f64::INFINITY]);
        }
        let (rows, factor, unit) = self.rows();
        let range = [-1.0, 1.0].map(|sense| rows.extreme(factor, sense));
        let mut ends = [0.0; 2];
        for (end, extreme, infinite) in [(0, range[0], f64::NEG_INFINITY), (1, range[1], f64::INFINITY)] {
            ends[end] = match extreme {
                Extreme::Value(value) => value * unit,
                Extreme::Unbounded => infinite,
                Extreme::Infeasible => return Carried::No,
                Extreme::Unknown => return Carried::Unknown,
            };
        }
        // A program without bounds may have no feasible point.
        if ends.iter().any(|end| end.is_infinite()) {
            match rows.extreme(factor, 0.0) {
                Extreme::Infeasible => return Carried::No,
                Extreme::Value(_) => {}
                _ => return Carried::Unknown,
            }
        }
        Carried::Between(ends)
    }

    /// Returns the program in units of the size of the scene and its greatest dead (else live) force, its variable λ,
    /// and the unit of this variable.
    fn rows(&self) -> (Rows, usize, f64) {
        let (pole, size) = self.frame();
        let [dead, live] = self.loads(pole);
        let [most_dead, most_live] = [&dead, &live].map(|loads| greatest(loads, size));
        let force = if most_dead > 0.0 { most_dead } else { most_live };
        let mut number = 0;
        let place: Vec<Option<usize>> = self
            .blocks
            .iter()
            .map(|block| {
                (!block.held).then(|| {
                    number += 1;
                    number - 1
                })
            })
            .collect();
        let factor = 3 * self.contacts.len();
        let mut rows = Rows::new(factor + 1);
        rows.right = vec![0.0; 3 * number];
        for (block, place) in place.iter().enumerate() {
            let Some(place) = place else { continue };
            for d in 0..3 {
                let unit = if d == 2 { force * size } else { force };
                rows.right[3 * place + d] = -dead[block][d] / unit;
                let live_unit = if d == 2 { most_live * size } else { most_live };
                rows.entry(3 * place + d, factor, if most_live > 0.0 { live[block][d] / live_unit } else { 0.0 });
            }
        }
        for (j, contact) in self.contacts.iter().enumerate() {
            let [a, b] = contact.ends.map(|p| minus(p, pole).map(|x| x / size));
            let h = minus(b, a)[0].hypot(minus(b, a)[1]);
            let (t, p) = (minus(b, a).map(|x| x / h), [(a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0]);
            let n = [t[1], -t[0]];
            for (side, sign) in [(0, -1.0), (1, 1.0)] {
                let Some(block) = place[contact.on[side]] else { continue };
                for (variable, column) in
                    [[n[0], n[1], cross(p, n)], [t[0], t[1], cross(p, t)], [0.0, 0.0, 1.0]].iter().enumerate()
                {
                    (0..3).for_each(|d| rows.entry(3 * block + d, 3 * j + variable, sign * column[d]));
                }
            }
        }
        rows.linear_from = rows.right.len();
        self.strengths(&mut rows, size, force);
        (rows, factor, force / if most_live > 0.0 { most_live } else { 1.0 })
    }

    fn strengths(&self, rows: &mut Rows, size: f64, force: f64) {
        let of = |contact: &Contact| {
            let h = minus(contact.ends[1], contact.ends[0]);
            let h = h[0].hypot(h[1]);
            (&self.laws[contact.law], h / size, h * self.width / force)
        };
        for (j, contact) in self.contacts.iter().enumerate() {
            let (law, h, area) = of(contact);
            for sign in [-1.0, 1.0] {
                if law.friction < NO_SLIDING {
                    rows.row(&[(3 * j + 1, sign), (3 * j, -law.friction)], law.cohesion * area);
                }
                rows.row(&[(3 * j + 2, sign), (3 * j, -h / 2.0)], law.apex() * area * h / 2.0);
            }
        }
        rows.cones_from = rows.right.len();
        for (j, contact) in self.contacts.iter().enumerate() {
            let (law, h, area) = of(contact);
            // Above this strength no digit of a load depends on it.
            if law.compressive * area < 1e9 {
                let whole = (law.compressive + law.apex()) * area;
                rows.stress_block([3 * j, 3 * j + 2], h, [whole, law.apex() * area], 1.0);
            }
        }
    }
}

/// Returns the greatest force; moments are divided by the size.
fn greatest(loads: &[[f64; 3]], size: f64) -> f64 {
    loads.iter().flat_map(|w| [w[0].hypot(w[1]), w[2].abs() / size]).fold(0.0, f64::max)
}
