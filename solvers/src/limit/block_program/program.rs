//! The scaled data of a program: bodies in their order of elimination, joints with their cones.
//!
//! The unit of force is the load divided by the square root of the number of bodies, the typical force of a column.
//! Each body has a pole at the centre of its joints; moments are divided by the mean length of a joint. The velocities
//! of all bodies are then of similar size.

use super::cone::{Cone, ROWS, dot};
use voussoir_core::limit::{JointForce, LimitProblem, Velocity, force_unit};
use voussoir_core::linear::elimination_order;
use voussoir_core::model::Wrenches;
use voussoir_core::model::geometry::{Vec2, cross, turned};

/// A joint in a program.
#[derive(Debug, Clone)]
pub struct Member {
    /// First unknown of the body on its plus and on its minus side.
    pub bodies: [Option<usize>; 2],
    /// Wrench about the body's own pole per unit of each force, on its plus and on its minus side.
    pub wrenches: [[[f64; 3]; 3]; 2],
    /// Index of its cone.
    pub cone: usize,
    /// Number of rows.
    pub rows: usize,
    /// b of its rows; 1 for rows that it does not have.
    pub bounds: [f64; ROWS],
}

/// The loads of a program.
#[derive(Clone, Copy)]
pub struct Loads<'a> {
    /// Loads with factor one.
    pub fixed: Option<&'a Wrenches>,
    /// Loads multiplied by the factor.
    pub varying: &'a Wrenches,
    /// Greatest factor.
    pub cap: f64,
    /// True with strengths; false for the recession cone.
    pub strengths: bool,
}

/// A linear program with block structure.
pub struct Program {
    /// Its joints.
    pub members: Vec<Member>,
    /// Cones of joints.
    pub cones: Vec<Cone>,
    /// w, three entries for each body.
    pub fixed: Vec<f64>,
    /// p.
    pub varying: Vec<f64>,
    /// t, if the factor has a cap.
    pub cap: Option<f64>,
    /// Number of rows of all joints.
    pub rows: usize,
    /// Load factor for θ = 1.
    pub unit: f64,
    force: f64,
    length: f64,
    /// For each group its first unknown, and its pole relative to the problem's pole.
    bodies: Vec<(usize, Vec2)>,
}

/// Returns the poles of all groups relative to the problem's pole: the mean of the joints of each group.
fn poles(problem: &LimitProblem) -> Vec<Vec2> {
    let mut sums = vec![(Vec2::zeros(), 0.0); problem.groups];
    for joint in &problem.joints {
        // The fill acts at its first end.
        let middle = if joint.fill.is_some() { joint.ends[0] } else { (joint.ends[0] + joint.ends[1]) / 2.0 };
        for group in [joint.plus, joint.minus].into_iter().flatten() {
            sums[group].0 += middle - problem.pole;
            sums[group].1 += 1.0;
        }
    }
    sums.into_iter().map(|(sum, count)| sum / f64::max(count, 1.0)).collect()
}

impl Program {
    /// Creates the program of a problem. `None` if a joint has more than four rows or crushes.
    pub fn new(problem: &LimitProblem, loads: Loads) -> Option<Self> {
        if problem.groups == 0 || problem.joints.iter().any(|joint| joint.strength.block.is_some()) {
            return None;
        }
        let pairs: Vec<(usize, usize)> = problem
            .joints
            .iter()
            .filter_map(|joint| Some((joint.plus?, joint.minus?)))
            .filter(|(a, b)| a != b)
            .collect();
        let order = elimination_order(problem.groups, &pairs)?;
        let mut bodies: Vec<(usize, Vec2)> = poles(problem).into_iter().map(|pole| (0, pole)).collect();
        order.iter().enumerate().for_each(|(place, &group)| bodies[group].0 = 3 * place);
        let has_fixed = loads.fixed.is_some_and(|fixed| problem.magnitude(fixed) > 0.0);
        let sizing = loads.fixed.filter(|_| has_fixed).unwrap_or(loads.varying);
        let total = force_unit(problem, sizing);
        let force = total / (problem.groups as f64).sqrt();
        let unit = total / force_unit(problem, loads.varying);
        let heights = problem.joints.iter().map(|joint| (joint.ends[1] - joint.ends[0]).norm());
        let length = heights.sum::<f64>() / problem.joints.len().max(1) as f64;
        let scaled = |wrenches: &Wrenches, by: f64| {
            let mut out = vec![0.0; 3 * problem.groups];
            for (&(at, pole), [x, y, moment]) in bodies.iter().zip(wrenches) {
                let moment = moment - cross(pole, Vec2::new(*x, *y));
                out[at..at + 3].copy_from_slice(&[x * by / force, y * by / force, moment * by / force / length]);
            }
            out
        };
        let (varying, fixed) = (scaled(loads.varying, unit), loads.fixed.map(|fixed| scaled(fixed, 1.0)));
        let mut program = Program {
            members: Vec::new(),
            cones: Vec::new(),
            fixed: fixed.unwrap_or_else(|| vec![0.0; 3 * problem.groups]),
            varying,
            cap: loads.cap.is_finite().then_some(loads.cap / unit),
            rows: 0,
            unit,
            force,
            length,
            bodies,
        };
        for index in 0..problem.joints.len() {
            let member = program.member(problem, index, loads.strengths)?;
            program.rows += member.rows;
            program.members.push(member);
        }
        Some(program)
    }

    fn member(&mut self, problem: &LimitProblem, index: usize, strengths: bool) -> Option<Member> {
        let joint = &problem.joints[index];
        let forces = joint.components();
        let (mut normals, mut bounds) = (Vec::new(), [1.0; ROWS]);
        for row in &joint.strength.rows {
            let mut normal = row.normal;
            normal[forces..].fill(0.0);
            let size = normal.iter().fold(0.0f64, |m, v| m.max(v.abs()));
            if size > 0.0 {
                *bounds.get_mut(normals.len())? = if strengths { row.bound / self.force / size } else { 0.0 };
                normals.push(normal.map(|v| v / size));
            }
        }
        let rows = normals.len();
        let known = self.cones.iter().position(|cone| cone.forces == forces && cone.normals == normals);
        let cone = match known {
            Some(cone) => cone,
            None => {
                self.cones.push(Cone::new(forces, normals)?);
                self.cones.len() - 1
            }
        };
        let side = |group: Option<usize>, sign: f64| {
            let Some((at, pole)) = group.map(|group| self.bodies[group]) else { return (None, [[0.0; 3]; 3]) };
            let mut wrenches = joint.wrenches(problem.pole + pole);
            wrenches[forces..].fill([0.0; 3]);
            (Some(at), wrenches.map(|w| [sign * w[0], sign * w[1], sign * w[2] / self.length]))
        };
        let (plus, minus) = (side(joint.plus, 1.0), side(joint.minus, -1.0));
        Some(Member { bodies: [plus.0, minus.0], wrenches: [plus.1, minus.1], cone, rows, bounds })
    }

    /// Returns the joint forces \[N\] of forces x.
    pub fn joint_forces(&self, x: &[[f64; 3]]) -> Vec<JointForce> {
        let of = |x: &[f64; 3]| JointForce { normal: [x[0] * self.force, x[1] * self.force], shear: x[2] * self.force };
        x.iter().map(of).collect()
    }

    /// Returns the velocities of all groups about the problem's pole, up to a common factor.
    pub fn motion(&self, q: &[f64]) -> Vec<Velocity> {
        let velocity = |&(at, pole): &(usize, Vec2)| {
            let omega = q[at + 2] / self.length;
            let v = Vec2::new(q[at], q[at + 1]) - turned(pole) * omega;
            [v.x, v.y, omega]
        };
        self.bodies.iter().map(velocity).collect()
    }

    /// Returns the jump of a motion at a joint, which is dual to its forces.
    #[inline(always)]
    pub fn jump(&self, member: &Member, q: &[f64]) -> [f64; 3] {
        let mut jump = [0.0; 3];
        for (at, wrenches) in member.bodies.iter().zip(&member.wrenches) {
            if let Some(q) = at.and_then(|at| q[at..].first_chunk::<3>()) {
                (0..3).for_each(|k| jump[k] += dot(&wrenches[k], q));
            }
        }
        jump
    }

    /// Adds the wrenches of the forces of a joint to `sum`.
    #[inline(always)]
    pub fn press(&self, member: &Member, x: &[f64; 3], sum: &mut [f64]) {
        for (at, wrenches) in member.bodies.iter().zip(&member.wrenches) {
            if let Some(sum) = at.and_then(|at| sum[at..].first_chunk_mut::<3>()) {
                (0..3).for_each(|i| sum[i] += wrenches[0][i] * x[0] + wrenches[1][i] * x[1] + wrenches[2][i] * x[2]);
            }
        }
    }
}
