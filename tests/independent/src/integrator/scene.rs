//! Blocks, contact points and loads, read from the geometry of a case.

use super::dual::Dual;
use super::law::{Mode, PointLaw};
use nalgebra::Vector2;
use voussoir::core::model::{Assembly, Joint};
use voussoir::study::Case;

type Point = Vector2<f64>;
type Number = Dual<6>;

/// A free block.
#[derive(Debug, Clone)]
pub struct Block {
    /// Centre of mass \[m\].
    pub centre: Point,
    /// Weight \[N\].
    pub weight: Point,
    /// Live forces at factor 1 and their points of action \[N, m\].
    pub forces: Vec<(Point, Point)>,
}

/// A contact point.
#[derive(Debug, Clone)]
pub struct Contact {
    /// Rows of the minus and the plus block; `None` for the ground.
    pub rows: [Option<usize>; 2],
    /// The point relative to the centres of both blocks \[m\].
    pub arms: [Point; 2],
    /// n and t.
    pub axes: [Point; 2],
    /// Its law.
    pub law: PointLaw,
    /// β without slip, after negative slip and after positive slip.
    pub shares: [f64; 3],
    /// Slip at which β has changed \[m\]; 0 if β is constant.
    pub passing: f64,
    /// Least and greatest slip for which both blocks still touch \[m\].
    pub range: [f64; 2],
}

/// The scene.
#[derive(Debug, Clone)]
pub struct Scene {
    /// Free blocks, three unknowns each.
    pub blocks: Vec<Block>,
    /// Contact points.
    pub contacts: Vec<Contact>,
    /// Diagonal of the bounding box \[m\].
    pub size: f64,
    /// Total weight \[N\].
    pub weight: f64,
    /// Displacement of the load point at which the range ends \[m\].
    pub range: f64,
}

/// Slip at which β has reached a corner, as a share of the height of the joint, and the share of this slip at which the
/// change begins.
const PASSING: [f64; 2] = [0.05, 0.1];

impl Scene {
    /// Creates the scene: rigid blocks under gravity (stage 1) and growing point loads or accelerations (stage 2), compliant
    /// joints. Blocks that are bonded to the ground belong to it.
    pub fn of_case(case: &Case) -> Scene {
        let assembly = &case.assembly;
        let gravity = case.stages[0].gravity.expect("the first stage is gravity");
        let mut rows = vec![None; assembly.bodies.len()];
        let (mut blocks, mut centres) = (Vec::new(), Vec::new());
        for (index, body) in assembly.bodies.iter().enumerate() {
            let (area, centre) = area_and_centre(&body.vertices);
            centres.push(centre);
            let on_ground = |joint: &Joint| {
                let sides = [joint.minus, joint.plus];
                let bonded = assembly.law(joint).is_none() && sides.contains(&index);
                bonded && sides.iter().any(|side| assembly.bodies[*side].fixed)
            };
            if body.fixed || assembly.joints.iter().any(on_ground) {
                continue;
            }
            rows[index] = Some(3 * blocks.len());
            let mass = area * assembly.width * assembly.material(index).density();
            let weight = gravity * mass;
            let forces = case.stages[1].forces.iter().filter(|force| force.body == index);
            let forces = forces.map(|force| (force.force, force.point - centre));
            let pushed = case.stages[1].accelerations.iter().map(|acceleration| (acceleration * mass, Point::zeros()));
            let forces = forces.chain(pushed).collect();
            blocks.push(Block { centre, weight, forces });
        }
        let free = assembly.bodies.iter().flat_map(|body| &body.vertices);
        let [low, high] =
            free.fold([Point::repeat(f64::MAX), Point::repeat(f64::MIN)], |[low, high], p| [low.inf(p), high.sup(p)]);
        let size = (high - low).norm();
        let points = |joint| contacts(assembly, joint, size, (&rows, &centres));
        let contacts = assembly.joints.iter().flat_map(points).collect();
        let weight = blocks.iter().map(|block| block.weight.norm()).sum();
        let range = case.solver.settings.stop_displacement.unwrap_or(high.y - low.y);
        Scene { blocks, contacts, size, weight, range }
    }

    /// Returns the displacement of the load along itself \[m\] in the motion `q`.
    pub fn load_displacement(&self, q: &[f64]) -> f64 {
        let (mut work, mut size) = (0.0, 0.0f64);
        for (block, q) in self.blocks.iter().zip(q.chunks(3)) {
            for (force, arm) in &block.forces {
                let (sine, cosine) = q[2].sin_cos();
                let turned = Point::new(cosine * arm.x - sine * arm.y, sine * arm.x + cosine * arm.y);
                work += force.dot(&(Point::new(q[0], q[1]) + turned - arm));
                size += force.norm();
            }
        }
        work / size.max(1e-300)
    }
}

fn area_and_centre(vertices: &[Point]) -> (f64, Point) {
    let (mut twice, mut moment) = (0.0, Point::zeros());
    for (i, a) in vertices.iter().enumerate() {
        let b = vertices[(i + 1) % vertices.len()];
        let part = a.x * b.y - a.y * b.x;
        twice += part;
        moment += (a + b) * part;
    }
    (twice.abs() / 2.0, if twice == 0.0 { Point::zeros() } else { moment / (3.0 * twice) })
}

/// Returns the contact points of a joint: Simpson's rule on each of the equal segments, with its weights.
fn contacts(
    assembly: &Assembly,
    joint: &Joint,
    size: f64,
    (rows, centres): (&[Option<usize>], &[Point]),
) -> Vec<Contact> {
    let Some(law) = assembly.law(joint) else { return Vec::new() };
    let stiffness = law.stiffness().expect("joints are compliant");
    let facets = law.facets().expect("friction");
    let sliding = facets.iter().find(|facet| facet.normal[1] != 0.0).expect("friction");
    let (friction, dilatancy) = (-sliding.normal[0], -sliding.flow[0]);
    let along = joint.ends[1] - joint.ends[0];
    let height = along.norm();
    let t = along / height;
    let n = Point::new(t.y, -t.x);
    let parts = assembly.mesh.elements[1];
    assert_eq!(assembly.mesh.order, 2, "Simpson's rule");
    let faces = [joint.minus, joint.plus].map(|body| face(&assembly.bodies[body].vertices, joint, 1e-9 * size));
    let point = |index: usize| {
        let position = index as f64 / (2 * parts) as f64;
        let at = joint.ends[0] + along * position;
        let weight = match index {
            _ if index % 2 == 1 => 4.0,
            _ if index == 0 || index == 2 * parts => 1.0,
            _ => 2.0,
        } / (6 * parts) as f64;
        let area = weight * height * assembly.width;
        let law = PointLaw { stiffness: stiffness.map(|k| k * area), friction, dilatancy };
        let rows = [rows[joint.minus], rows[joint.plus]];
        let arms = [joint.minus, joint.plus].map(|body| at - centres[body]);
        let (shares, passing, range) = sliding_rule(faces, height, index, 2 * parts);
        Contact { rows, arms, axes: [n, t], law, shares, passing, range }
    };
    (0..=2 * parts).map(point).collect()
}

/// Returns both ends of the edge of a block that contains a joint, along the joint \[m\].
fn face(vertices: &[Point], joint: &Joint, tolerance: f64) -> [f64; 2] {
    let along = joint.ends[1] - joint.ends[0];
    let t = along / along.norm();
    let place = |p: &Point| ((p - joint.ends[0]).dot(&t), (p - joint.ends[0]).perp(&t).abs());
    let found = (0..vertices.len()).find_map(|i| {
        let [a, b] = [place(&vertices[i]), place(&vertices[(i + 1) % vertices.len()])];
        let [low, high] = [a.0.min(b.0), a.0.max(b.0)];
        let holds = a.1.max(b.1) <= tolerance && low <= tolerance && high >= along.norm() - tolerance;
        holds.then_some([low, high])
    });
    found.expect("the joint lies on an edge")
}

/// Returns β (without slip, after negative, after positive slip), the slip that changes it, and the range of the slip.
///
/// A point belongs to the nearer end of its joint. An end that is a corner of one block belongs to that block. If it is
/// a corner of both, it belongs to the corner that stays on the other face after the slip.
fn sliding_rule(faces: [[f64; 2]; 2], height: f64, index: usize, last: usize) -> ([f64; 3], f64, [f64; 2]) {
    let at = height * index as f64 / last as f64;
    let of_end = |end: usize| {
        let place = [0.0, height][end];
        let [minus, plus] = faces.map(|face| (face[end] - place).abs() <= 1e-8 * height);
        match (minus, plus) {
            (false, true) => ([0.0; 3], 0.0, [faces[0][0] - at, faces[0][1] - at]),
            (true, false) => ([1.0; 3], 0.0, [at - faces[1][1], at - faces[1][0]]),
            (true, true) => {
                let after = [[1.0, 0.0], [0.0, 1.0]][end];
                ([0.5, after[0], after[1]], PASSING[0] * height, [-0.5 * height, 0.5 * height])
            }
            (false, false) => panic!("an end of a joint is a corner of one of its blocks"),
        }
    };
    match (2 * index).cmp(&last) {
        std::cmp::Ordering::Less => of_end(0),
        std::cmp::Ordering::Greater => of_end(1),
        std::cmp::Ordering::Equal => {
            let [one, other] = [of_end(0), of_end(1)];
            if one.0 == other.0 {
                return one;
            }
            ([0.5; 3], 0.0, [one.2[0].max(other.2[0]), one.2[1].min(other.2[1])])
        }
    }
}

impl Contact {
    /// Returns (g_n, g_t) and their derivatives with respect to (u⁻, θ⁻, u⁺, θ⁺).
    pub fn gap(&self, motions: [[f64; 3]; 2]) -> [Number; 2] {
        let [minus, plus] = [0, 1].map(|side| [0, 1, 2].map(|k| Number::variable(motions[side][k], 3 * side + k)));
        let place = |motion: [Number; 3], arm: Point| {
            let turned = rotated(motion[2], arm);
            [motion[0] + turned[0] - Number::constant(arm.x), motion[1] + turned[1] - Number::constant(arm.y)]
        };
        let (below, above) = (place(minus, self.arms[0]), place(plus, self.arms[1]));
        let jump = [above[0] - below[0], above[1] - below[1]];
        let turn = plus[2] - minus[2];
        let component = |angle: Number, axis: Point| {
            let axis = rotated(angle, axis);
            axis[0] * jump[0] + axis[1] * jump[1]
        };
        let slip = component(minus[2] + turn * 0.5, self.axes[1]);
        let angle = minus[2] + turn * self.share(slip);
        self.axes.map(|axis| component(angle, axis))
    }

    /// Returns β at a slip.
    fn share(&self, slip: Number) -> Number {
        if self.passing == 0.0 {
            return Number::constant(self.shares[0]);
        }
        let x = (slip.value.abs() / self.passing - PASSING[1]) / (1.0 - PASSING[1]);
        let x = x.clamp(0.0, 1.0);
        let by = self.shares[if slip.value > 0.0 { 2 } else { 1 }] - self.shares[0];
        let scale = (1.0 - PASSING[1]) * self.passing;
        let value = self.shares[0] + by * x.powi(3) * (10.0 - 15.0 * x + 6.0 * x * x);
        slip.map(value, by * slip.value.signum() * 30.0 * (x * (1.0 - x)).powi(2) / scale)
    }

    /// Returns true if both blocks still touch at a slip.
    pub fn holds(&self, slip: f64) -> bool {
        self.range[0] <= slip && slip <= self.range[1]
    }

    /// Returns ∂r/∂g in a mode.
    pub fn tangent(&self, mode: Mode) -> [[f64; 2]; 2] {
        self.law.tangent(mode)
    }
}

/// Returns R(θ) v.
fn rotated(angle: Number, v: Point) -> [Number; 2] {
    let (sine, cosine) = (angle.sin(), angle.cos());
    [cosine * v.x - sine * v.y, sine * v.x + cosine * v.y]
}
