//! The data of the energy: blocks, springs of the joints, loads, motions of supports.

use nalgebra::DVector;
use voussoir::core::model::geometry::{Vec2, cross, turned};
use voussoir::core::path::{LoadStepEnd, PathProblem};
use voussoir::study::Case;

/// A block.
#[derive(Debug, Clone)]
pub struct RigidBlock {
    /// Pole P, where u is measured \[m\].
    pub pole: Vec2,
    /// Centre of mass \[m\].
    pub centroid: Vec2,
    /// Mass \[kg\].
    pub mass: f64,
    /// Index of its first unknown; `None` if the ground holds it.
    pub unknown: Option<usize>,
}

/// A spring between two blocks.
#[derive(Debug, Clone)]
pub struct SpringPoint {
    /// Index of the joint.
    pub joint: usize,
    /// Minus and plus block.
    pub sides: [usize; 2],
    /// Position \[m\].
    pub position: Vec2,
    /// n and t of the undeformed joint.
    pub axes: [Vec2; 2],
    /// k_n, k_t of its area \[N/m\].
    pub stiffness: [f64; 2],
    /// Initial gap g_0 \[m\].
    pub gap: f64,
    /// β: its axes rotate by θ⁻ + β (θ⁺ − θ⁻).
    pub share: f64,
}

/// Motions of the held blocks, and all loads except the live load.
#[derive(Debug, Clone)]
pub struct Held {
    /// \[u_x, u_y, θ\] of every block about its pole; the entries of free blocks are not read.
    pub motion: Vec<[f64; 3]>,
    /// Gravity \[m/s²\].
    pub gravity: Vec2,
    /// λ of a constant live load, in addition to the one that is followed.
    pub constant: f64,
}

/// Rigid blocks on elastic unilateral joints.
#[derive(Debug, Clone)]
pub struct EnergyScene {
    /// Blocks; a bonded end forms one block with its support.
    pub blocks: Vec<RigidBlock>,
    /// Springs of the scene.
    pub points: Vec<SpringPoint>,
    /// Live load ℓ \[N\], over the unknowns.
    pub load: DVector<f64>,
    /// States of the supports: before any settlement, then after each stage with a settlement.
    pub settled: Vec<Vec<[f64; 3]>>,
    /// Gravity of the first stage \[m/s²\].
    pub gravity: Vec2,
    /// Diagonal of the bounding box \[m\].
    pub size: f64,
    /// Clear span, or the size if the scene is not an arch \[m\].
    pub span: f64,
    /// μ of the joints, if they can slide.
    pub friction: Option<f64>,
}

/// Motions of all blocks at given unknowns.
#[derive(Debug, Clone)]
pub struct Place {
    /// \[u_x, u_y, θ\] about each pole.
    pub motion: Vec<[f64; 3]>,
}

impl EnergyScene {
    /// Creates it from a case whose blocks are rigid and whose joints are compliant: dead load, stages with
    /// settlements, a live load that grows.
    pub fn of_case(case: &Case) -> Self {
        let problem = PathProblem::new(&case.assembly, &case.stages).expect("a path problem");
        let mut count = 0;
        let mut blocks: Vec<RigidBlock> = problem
            .bodies
            .iter()
            .map(|body| {
                assert!(body.flexibility.is_none(), "only rigid blocks have this energy");
                let unknown = (!body.held).then(|| {
                    count += 3;
                    count - 3
                });
                RigidBlock { pole: body.pole, centroid: body.pole, mass: body.mass, unknown }
            })
            .collect();
        let spring = |contact: &voussoir::core::path::Contact| SpringPoint {
            joint: contact.joint,
            sides: [contact.minus.body, contact.plus.body],
            position: contact.position,
            axes: [contact.normal, contact.tangent],
            stiffness: contact.compliance.map(|c| 1.0 / c),
            gap: contact.gap,
            share: contact.sliding.share,
        };
        let points: Vec<SpringPoint> = problem.contacts.iter().map(spring).collect();
        assert!(
            points.iter().all(|p| p.stiffness.iter().all(|k| k.is_finite() && *k > 0.0)),
            "joints without stiffness"
        );
        let mut load = DVector::zeros(count);
        let mut settled = vec![vec![[0.0; 3]; blocks.len()]];
        let mut gravity = Vec2::zeros();
        for step in &problem.load_steps {
            let reached = if let LoadStepEnd::Factor(end) = step.end { end - step.start } else { 1.0 };
            if step.gravity {
                gravity += step.loading.acceleration;
                continue;
            }
            if !step.loading.settlements.is_empty() {
                let mut next = settled[settled.len() - 1].clone();
                for (body, motion) in &step.loading.settlements {
                    (0..3).for_each(|k| next[*body][k] += reached * motion[k]);
                }
                settled.push(next);
            }
            if matches!(step.end, LoadStepEnd::Collapse(_)) {
                add_live_load(&mut blocks, &mut load, &step.loading);
            }
        }
        let friction = case.assembly.catalogue.laws.iter().find_map(|(_, law)| {
            law.facets()?.iter().find(|facet| facet.normal[1] != 0.0).map(|facet| -facet.normal[0])
        });
        let span = case.assembly.arch.as_ref().map_or(problem.length, |arch| arch.span);
        EnergyScene { blocks, points, load, settled, gravity, size: problem.length, span, friction }
    }

    /// Returns the supports at a `share` between one state and the next, at full gravity.
    pub fn held(&self, from: usize, share: f64) -> Held {
        let (a, b) = (&self.settled[from], &self.settled[(from + 1).min(self.settled.len() - 1)]);
        let mix = |(a, b): (&[f64; 3], &[f64; 3])| [0, 1, 2].map(|k| a[k] + share * (b[k] - a[k]));
        Held { motion: a.iter().zip(b).map(mix).collect(), gravity: self.gravity, constant: 0.0 }
    }

    /// Returns the supports after the last settlement.
    pub fn settled_supports(&self) -> Held {
        self.held(self.settled.len() - 1, 0.0)
    }

    /// Returns the number of unknowns.
    pub fn unknowns(&self) -> usize {
        self.load.len()
    }

    /// Returns the motions of all blocks.
    pub fn place(&self, held: &Held, q: &DVector<f64>) -> Place {
        let of =
            |(block, held): (&RigidBlock, &[f64; 3])| block.unknown.map_or(*held, |at| [q[at], q[at + 1], q[at + 2]]);
        Place { motion: self.blocks.iter().zip(&held.motion).map(of).collect() }
    }

    /// Returns the rotation of each joint's plus block relative to its minus block \[rad\], by joint.
    pub fn joint_rotations(&self, held: &Held, q: &DVector<f64>) -> Vec<(usize, f64)> {
        let place = self.place(held, q);
        let mut out: Vec<(usize, f64)> = Vec::new();
        for point in &self.points {
            if out.last().is_none_or(|last| last.0 != point.joint) {
                out.push((point.joint, place.motion[point.sides[1]][2] - place.motion[point.sides[0]][2]));
            }
        }
        out
    }

    /// Returns the mirror image of motions of an arch whose blocks are ordered from left to right and whose supports
    /// have moved symmetrically; `None` for other scenes.
    pub fn mirrored(&self, held: &Held, q: &DVector<f64>) -> Option<DVector<f64>> {
        let last = self.blocks.len() - 1;
        let held_ends = self.blocks.iter().enumerate().all(|(k, b)| b.unknown.is_none() == (k == 0 || k == last));
        let middle = (self.blocks[1].centroid.x + self.blocks[last - 1].centroid.x) / 2.0;
        let close = |a: f64, b: f64, size: f64| (a - b).abs() <= 1e-9 * size;
        let symmetric = (1..last).all(|k| {
            let (a, b) = (&self.blocks[k], &self.blocks[last - k]);
            close(a.centroid.x + b.centroid.x, 2.0 * middle, self.size)
                && close(a.centroid.y, b.centroid.y, self.size)
                && close(a.mass, b.mass, a.mass)
        });
        let [left, right] = [held.motion[0], held.motion[last]];
        if !held_ends || !symmetric || last < 3 || left[1] != right[1] || left[2] != -right[2] {
            return None;
        }
        // In the frame that moves with the middle of the supports.
        let drift = (left[0] + right[0]) / 2.0;
        let place = self.place(held, q);
        let mut out = q.clone();
        for k in 1..last {
            let (from, to) = (&self.blocks[last - k], &self.blocks[k]);
            let [x, y, turn] = place.motion[last - k];
            let at = Vec2::new(x, y) + about(turn, from.centroid - from.pole);
            let mirrored = Vec2::new(2.0 * drift - at.x, at.y) - about(-turn, to.centroid - to.pole);
            let row = to.unknown?;
            (out[row], out[row + 1], out[row + 2]) = (mirrored.x, mirrored.y, -turn);
        }
        Some(out)
    }

    /// Returns a force scale \[N\]: the weight, or the live load if blocks have no weight.
    pub fn force_scale(&self) -> f64 {
        let weight: f64 = self.blocks.iter().map(|b| b.mass * self.gravity.norm()).sum();
        weight.max(self.load.norm() * 1e-3)
    }
}

/// Adds live loads. A point load moves the pole of its block to its point of action; accelerations act at centroids.
fn add_live_load(blocks: &mut [RigidBlock], load: &mut DVector<f64>, loading: &voussoir::core::path::Loading) {
    for (body, _, point, force) in &loading.forces {
        let Some(at) = blocks[*body].unknown else { continue };
        // Several forces on one block act as their resultant on its line of action, if that exists.
        let total: Vec2 = loading.forces.iter().filter(|f| f.0 == *body).map(|f| f.3).sum();
        let moment: f64 = loading.forces.iter().filter(|f| f.0 == *body).map(|f| cross(f.2 - *point, f.3)).sum();
        let alone = loading.forces.iter().filter(|f| f.0 == *body).count() == 1;
        assert!(alone, "two point loads on one block");
        blocks[*body].pole = *point + turned(total) * (moment / total.norm_squared());
        load[at] += force.x;
        load[at + 1] += force.y;
    }
    if loading.acceleration != Vec2::zeros() {
        assert!(loading.forces.is_empty(), "an acceleration together with point loads");
        for block in blocks.iter() {
            if let Some(at) = block.unknown {
                load[at] += block.mass * loading.acceleration.x;
                load[at + 1] += block.mass * loading.acceleration.y;
            }
        }
    }
}

/// (R − 1) v.
fn about(angle: f64, v: Vec2) -> Vec2 {
    turned(v) * angle.sin() - v * (2.0 * (angle / 2.0).sin().powi(2))
}
