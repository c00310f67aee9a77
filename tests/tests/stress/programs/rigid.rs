//! Rigid blocks with contact at the ends of their joints: equilibrium and motions as rows of a linear program.
//!
//! ```text
//! Σ ± (r_n n + r_t t) + w + λ p = 0     |r_t| ≤ μ r_n     p·q̇ = 1     ġ_n ≥ d |ġ_t|
//! ```

use crate::conic::{Extreme, Rows};
use voussoir::core::model::geometry::Vec2;
use voussoir::study::Case;

/// A contact point.
#[derive(Debug, Clone)]
pub struct Touch {
    /// Free blocks on the minus and on the plus side.
    sides: [Option<usize>; 2],
    place: Vec2,
    axes: [Vec2; 2],
}

/// Rigid blocks with their contact points, two per joint.
#[derive(Debug, Clone)]
pub struct Rigid {
    centres: Vec<Vec2>,
    /// (force, moment / length) of the dead load on each free block \[N\].
    dead: Vec<[f64; 3]>,
    /// (force, moment / length) of the live load at factor 1 on each free block \[N\].
    live: Vec<[f64; 3]>,
    pub touches: Vec<Touch>,
    /// Friction μ; `None` if joints do not slip.
    pub friction: Option<f64>,
    /// Dilatancy d.
    pub dilatancy: f64,
    length: f64,
}

fn area_and_centre(vertices: &[Vec2]) -> (f64, Vec2) {
    let (mut twice, mut moment) = (0.0, Vec2::zeros());
    for (i, a) in vertices.iter().enumerate() {
        let b = vertices[(i + 1) % vertices.len()];
        let part = a.x * b.y - a.y * b.x;
        twice += part;
        moment += (a + b) * part;
    }
    (twice.abs() / 2.0, moment / (3.0 * twice))
}

impl Rigid {
    /// Creates it from a case with gravity in the first stage and the live load in the last.
    pub fn of_case(case: &Case, friction: Option<f64>, dilatancy: f64) -> Rigid {
        let assembly = &case.assembly;
        let length = assembly.size();
        let gravity = case.stages[0].gravity.expect("gravity first");
        let last = case.stages.last().expect("a stage");
        let mut rows = vec![None; assembly.bodies.len()];
        let (mut centres, mut dead, mut live) = (Vec::new(), Vec::new(), Vec::new());
        for (index, body) in assembly.bodies.iter().enumerate().filter(|(_, body)| !body.fixed) {
            let (area, centre) = area_and_centre(&body.vertices);
            let mass = area * assembly.width * assembly.material(index).density();
            rows[index] = Some(centres.len());
            dead.push([mass * gravity.x, mass * gravity.y, 0.0]);
            let mut load = [0.0; 3];
            for acceleration in &last.accelerations {
                (0..2).for_each(|k| load[k] += mass * acceleration[k]);
            }
            for force in last.forces.iter().filter(|force| force.body == index) {
                let arm = force.point - centre;
                let moment = arm.x * force.force.y - arm.y * force.force.x;
                [force.force.x, force.force.y, moment / length].iter().zip(&mut load).for_each(|(f, l)| *l += f);
            }
            live.push(load);
            centres.push(centre);
        }
        let ends = |joint: &voussoir::core::model::Joint| {
            let (n, t) = joint.frame();
            let sides = [rows[joint.minus], rows[joint.plus]];
            joint.ends.map(|place| Touch { sides, place, axes: [n, t] })
        };
        let touches = assembly.joints.iter().flat_map(ends).collect();
        Rigid { centres, dead, live, touches, friction, dilatancy, length }
    }

    /// Returns the entries of a component of a contact force in the equilibrium of both blocks: (row, value).
    fn entries(&self, touch: &Touch, axis: usize) -> Vec<(usize, f64)> {
        let along = touch.axes[axis];
        let mut all = Vec::new();
        for (side, sign) in touch.sides.iter().zip([-1.0, 1.0]) {
            let Some(block) = *side else { continue };
            let arm = touch.place - self.centres[block];
            let moment = (arm.x * along.y - arm.y * along.x) / self.length;
            all.extend([along.x, along.y, moment].iter().enumerate().map(|(k, v)| (3 * block + k, sign * v)));
        }
        all
    }

    /// Returns equilibrium: unknowns are (r_n, r_t) of each contact point, then λ.
    pub fn equilibrium(&self) -> Rows {
        let factor = 2 * self.touches.len();
        let mut rows = Rows::new(factor + 1);
        rows.right = self.dead.iter().flatten().map(|force| -force).collect();
        for (index, touch) in self.touches.iter().enumerate() {
            for axis in 0..2 {
                self.entries(touch, axis).iter().for_each(|&(row, value)| rows.entry(row, 2 * index + axis, value));
            }
        }
        self.live.iter().flatten().enumerate().for_each(|(row, force)| rows.entry(row, factor, *force));
        rows.linear_from = rows.right.len();
        rows
    }

    /// Returns the motions: unknowns are (v, ω × length) of each block, then −w·q̇ with p·q̇ = 1, both relative to the
    /// size of the live load.
    pub fn motions(&self) -> Rows {
        let power = 3 * self.centres.len();
        let size = self.live.iter().flatten().fold(0.0, |most: f64, force| most.max(force.abs()));
        let mut rows = Rows::new(power + 1);
        let row = |loads: &[[f64; 3]]| -> Vec<(usize, f64)> {
            loads.iter().flatten().enumerate().map(|(k, force)| (k, force / size)).collect()
        };
        rows.row(&row(&self.live), 1.0);
        let mut dead = row(&self.dead);
        dead.push((power, 1.0));
        rows.row(&dead, 0.0);
        rows.linear_from = rows.right.len();
        rows
    }

    /// Returns the entries of ġ_n or ġ_t of a contact point over the motions.
    pub fn rate(&self, index: usize, axis: usize) -> Vec<(usize, f64)> {
        self.entries(&self.touches[index], axis)
    }

    /// Returns the greatest λ with an admissible field.
    pub fn associated_limit(&self) -> Extreme {
        let mut rows = self.equilibrium();
        (0..self.touches.len()).for_each(|index| self.cone(&mut rows, index));
        rows.extreme(2 * self.touches.len(), 1.0)
    }

    /// Adds r_n ≥ 0 and |r_t| ≤ μ r_n.
    pub fn cone(&self, rows: &mut Rows, index: usize) {
        let (n, t) = (2 * index, 2 * index + 1);
        rows.row(&[(n, -1.0)], 0.0);
        if let Some(friction) = self.friction {
            [1.0, -1.0].iter().for_each(|sign| rows.row(&[(n, -friction), (t, *sign)], 0.0));
        }
    }

    /// Adds ġ_n ≥ d |ġ_t|; without slip ġ_t = 0 by two rows.
    pub fn flow(&self, rows: &mut Rows, index: usize) {
        let [n, t] = [0, 1].map(|axis| self.rate(index, axis));
        for sign in [1.0, -1.0] {
            let along = t.iter().map(|&(k, v)| (k, sign * v));
            match self.friction {
                Some(_) => {
                    let opening = n.iter().map(|&(k, v)| (k, -v));
                    rows.row(&sum(opening.chain(along.map(|(k, v)| (k, self.dilatancy * v)))), 0.0);
                }
                None => rows.row(&sum(along), 0.0),
            }
        }
        if self.friction.is_none() {
            rows.row(&sum(n.iter().map(|&(k, v)| (k, -v))), 0.0);
        }
    }
}

/// Returns the entries with equal columns added.
pub fn sum(entries: impl Iterator<Item = (usize, f64)>) -> Vec<(usize, f64)> {
    let mut all = std::collections::BTreeMap::new();
    entries.for_each(|(k, v)| *all.entry(k).or_insert(0.0) += v);
    all.into_iter().collect()
}
