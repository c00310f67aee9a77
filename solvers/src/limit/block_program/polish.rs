//! Improves an interior point to rounding: the carrying rows become equations.
//!
//! Forces move along the null space Z of the carrying rows of each joint, so that E Z Zᵀ Eᵀ, with a shift of δ, is the
//! stiffness of the remaining structure. At collapse it is singular only in the mechanism; θ balances the equilibrium
//! error along it. The solution gives the forces nearest to the interior point, and the nearest velocities that no
//! joint resists.

use super::cone::{Cone, ROWS, dot, span};
use super::program::Program;
use super::residuals::imbalance;
use super::solution::Solution;
use super::state::State;
use super::stiffness::{Root, Stiffness};
use crate::limit::settings::SETTINGS;
use crate::linear::inner;

/// Greatest number of corrections of forces, and of velocities.
const MAX_CORRECTIONS: usize = 12;

/// The free directions of the forces of one joint, with its carrying rows and their multipliers.
struct Frame {
    /// Orthonormal basis of the space of their normals.
    normals: Vec<[f64; 3]>,
    /// Z Zᵀ, which is its own square root.
    free: Root,
}

impl Frame {
    fn new(cone: &Cone, carrying: &[bool; ROWS]) -> Self {
        let chosen: Vec<[f64; 3]> =
            cone.normals.iter().zip(carrying).filter(|(_, carries)| **carries).map(|(normal, _)| *normal).collect();
        let normals = span(&chosen);
        let mut free = [[0.0; 3]; 3];
        if normals.len() < cone.forces {
            for (i, line) in free.iter_mut().enumerate().take(cone.forces) {
                for (k, value) in line.iter_mut().enumerate().take(cone.forces) {
                    *value = f64::from(u8::from(i == k)) - normals.iter().map(|n| n[i] * n[k]).sum::<f64>();
                }
            }
        }
        Frame { normals, free }
    }
}

/// Returns L of the carrying rows, with A = L Qᵀ and Q the frame's normals, and the solution of (Lᵀ L) c = right.
fn least_squares(
    rows: &[[f64; 3]],
    frame: &Frame,
    right: impl Fn(&[[f64; 3]]) -> [f64; 3],
) -> ([f64; 3], Vec<[f64; 3]>) {
    let rank = frame.normals.len();
    let l: Vec<[f64; 3]> = rows
        .iter()
        .map(|row| std::array::from_fn(|c| if c < rank { dot(row, &frame.normals[c]) } else { 0.0 }))
        .collect();
    let mut squares = nalgebra::Matrix3::identity();
    for i in 0..rank {
        for k in 0..rank {
            squares[(i, k)] = l.iter().map(|l| l[i] * l[k]).sum();
        }
    }
    let right = right(&l);
    let solved = squares.try_inverse().unwrap_or_else(nalgebra::Matrix3::zeros) * nalgebra::Vector3::from(right);
    (std::array::from_fn(|c| if c < rank { solved[c] } else { 0.0 }), l)
}

/// A state during the polish.
struct Polish<'a> {
    program: &'a Program,
    state: State,
    carrying: Vec<[bool; ROWS]>,
    capped: bool,
    frames: Vec<Frame>,
}

/// Polishes a state. Returns the optimum and its greatest error; `None` if the stiffness has no factorisation.
pub fn polish(
    program: &Program,
    start: &State,
    stiffness: &mut Stiffness,
    corrections: &mut u64,
) -> Option<(f64, Solution)> {
    let carrying = start.slacks.iter().zip(&start.multipliers);
    let carrying = carrying.map(|(s, z)| std::array::from_fn(|row| z[row] > s[row])).collect();
    let capped = program.cap.is_some() && start.cap[1] > start.cap[0];
    let mut polish = Polish { program, state: start.clone(), carrying, capped, frames: Vec::new() };
    let v = polish.factorise(stiffness)?;
    *corrections += polish.statics(stiffness, &v) + polish.kinematics(stiffness, &v);
    Some((polish.error(), polish.solution(stiffness)?))
}

/// Returns a state without polish, for optima without a clear set of carrying rows.
pub fn unpolished(program: &Program, state: &State, stiffness: &mut Stiffness) -> Option<Solution> {
    let capped = program.cap.is_some() && state.cap[1] > state.cap[0];
    let polish = Polish { program, state: state.clone(), carrying: Vec::new(), capped, frames: Vec::new() };
    polish.solution(stiffness)
}

impl Polish<'_> {
    /// Returns the optimum of the present state.
    fn solution(&self, stiffness: &mut Stiffness) -> Option<Solution> {
        let unique = self.capped || self.unique(stiffness)?;
        let (forces, motion) = (self.program.joint_forces(&self.state.x), self.program.motion(&self.state.q));
        Some(Solution { factor: self.state.theta * self.program.unit, capped: self.capped, forces, motion, unique })
    }

    /// Factorises the stiffness that the carrying rows leave, and returns the motion caused by the varying load.
    fn factorise(&mut self, stiffness: &mut Stiffness) -> Option<Vec<f64>> {
        let joints = self.program.members.iter().zip(&self.carrying);
        self.frames = joints.map(|(member, carrying)| Frame::new(&self.program.cones[member.cone], carrying)).collect();
        let mut v = self.program.varying.clone();
        let roots = self.frames.iter().map(|frame| &frame.free);
        stiffness.factorise(self.program, roots, SETTINGS.shift, 0.0).then(|| stiffness.solve(&mut v))?;
        Some(v)
    }

    /// Returns the carrying rows of a joint, with their indices.
    fn rows(&self, index: usize) -> Vec<(usize, [f64; 3])> {
        let cone = &self.program.cones[self.program.members[index].cone];
        let rows = cone.normals.iter().enumerate().filter(|(row, _)| self.carrying[index][*row]);
        rows.map(|(row, normal)| (row, *normal)).collect()
    }

    /// Finds the nearest forces on the carrying rows in equilibrium. Returns the number of corrections.
    fn statics(&mut self, stiffness: &mut Stiffness, v: &[f64]) -> u64 {
        if let Some(cap) = self.program.cap.filter(|_| self.capped) {
            self.state.theta = cap;
        }
        let mut best = f64::INFINITY;
        let mut count = 0;
        for _ in 0..MAX_CORRECTIONS {
            for index in 0..self.frames.len() {
                self.onto_rows(index);
            }
            let residual = imbalance(self.program, &self.state.x, self.state.theta);
            let error = residual.iter().fold(0.0f64, |m, r| m.max(r.abs()));
            if error < SETTINGS.exhausted || (error > 0.5 * best && error < SETTINGS.rounding) || error > 1e3 * best {
                break;
            }
            best = best.min(error);
            let mut u = residual;
            stiffness.solve(&mut u);
            count += 1;
            if !self.capped {
                let change = -inner(&self.program.varying, &u) / inner(&self.program.varying, v);
                u.iter_mut().zip(v).for_each(|(u, v)| *u += change * v);
                self.state.theta += change;
            }
            for (index, member) in self.program.members.iter().enumerate() {
                let jump = self.program.jump(member, &u);
                let free = &self.frames[index].free;
                (0..3).for_each(|k| self.state.x[index][k] -= dot(&free[k], &jump));
            }
        }
        count
    }

    /// Moves the forces of a joint the shortest way onto its carrying rows.
    fn onto_rows(&mut self, index: usize) {
        let rows = self.rows(index);
        if rows.is_empty() {
            return;
        }
        let bounds = self.program.members[index].bounds;
        if rows.len() >= self.frames[index].normals.len()
            && self.frames[index].normals.len() == self.program.cones[self.program.members[index].cone].forces
            && rows.iter().all(|(row, _)| bounds[*row] == 0.0)
        {
            self.state.x[index] = [0.0; 3];
            return;
        }
        let frame = &self.frames[index];
        let x = self.state.x[index];
        let normals: Vec<[f64; 3]> = rows.iter().map(|(_, normal)| *normal).collect();
        let short: Vec<f64> = rows.iter().map(|(row, normal)| bounds[*row] - dot(normal, &x)).collect();
        let (c, _) = least_squares(&normals, frame, |l| {
            std::array::from_fn(|i| l.iter().zip(&short).map(|(l, short)| l[i] * short).sum())
        });
        for (c, normal) in c.iter().zip(&frame.normals) {
            (0..3).for_each(|k| self.state.x[index][k] += c * normal[k]);
        }
    }

    /// Finds the nearest velocities without resistance, and their multipliers. Returns the number of corrections.
    fn kinematics(&mut self, stiffness: &mut Stiffness, v: &[f64]) -> u64 {
        let program = self.program;
        let normalise = |q: &mut Vec<f64>, capped: bool| {
            if !capped {
                let change = (1.0 - inner(&program.varying, q)) / inner(&program.varying, v);
                q.iter_mut().zip(v).for_each(|(q, v)| *q += change * v);
            }
        };
        normalise(&mut self.state.q, self.capped);
        let mut best = f64::INFINITY;
        let mut count = 0;
        for _ in 0..MAX_CORRECTIONS {
            let mut resisted = vec![0.0; self.state.q.len()];
            let mut error = 0.0f64;
            for (member, frame) in program.members.iter().zip(&self.frames) {
                let jump = program.jump(member, &self.state.q);
                let along = [dot(&frame.free[0], &jump), dot(&frame.free[1], &jump), dot(&frame.free[2], &jump)];
                error = along.iter().fold(error, |m, v| m.max(v.abs()));
                program.press(member, &along, &mut resisted);
            }
            if error < 0.1 * SETTINGS.exhausted
                || (error > 0.5 * best && error < SETTINGS.rounding)
                || error > 1e3 * best
            {
                break;
            }
            best = best.min(error);
            stiffness.solve(&mut resisted);
            count += 1;
            self.state.q.iter_mut().zip(&resisted).for_each(|(q, r)| *q -= r);
            normalise(&mut self.state.q, self.capped);
        }
        self.state.cap[1] = if self.capped { 1.0 - inner(&program.varying, &self.state.q) } else { 0.0 };
        for index in 0..self.frames.len() {
            self.flow(index);
        }
        count
    }

    /// Finds the multipliers of the carrying rows of a joint that give its jump and are nearest to the present ones.
    fn flow(&mut self, index: usize) {
        let rows = self.rows(index);
        let old = std::mem::replace(&mut self.state.multipliers[index], [0.0; ROWS]);
        if rows.is_empty() {
            return;
        }
        let frame = &self.frames[index];
        let mut left = self.program.jump(&self.program.members[index], &self.state.q);
        for (row, normal) in &rows {
            (0..3).for_each(|k| left[k] += old[*row] * normal[k]);
        }
        let normals: Vec<[f64; 3]> = rows.iter().map(|(_, normal)| *normal).collect();
        let (c, l) = least_squares(&normals, frame, |_| {
            std::array::from_fn(|i| frame.normals.get(i).map_or(0.0, |n| dot(n, &left)))
        });
        for ((row, _), l) in rows.iter().zip(&l) {
            self.state.multipliers[index][*row] = old[*row] - dot(l, &c);
        }
    }

    /// Returns the greatest error, negative multiplier or violation of a row.
    fn error(&self) -> f64 {
        let (program, scale) = (self.program, self.greatest_multiplier());
        let mut error = 0.0f64;
        for (index, member) in program.members.iter().enumerate() {
            let slacks = self.state.true_slacks(program, index);
            let mut flow = program.jump(member, &self.state.q);
            for (row, normal) in program.cones[member.cone].normals.iter().enumerate() {
                let z = self.state.multipliers[index][row];
                (0..3).for_each(|k| flow[k] += z * normal[k]);
                error = error.max(match self.carrying[index][row] {
                    true => slacks[row].abs().max(-z / scale),
                    false => -slacks[row],
                });
            }
            error = flow.iter().fold(error, |m, v| m.max(v.abs() / scale));
        }
        let residual = imbalance(program, &self.state.x, self.state.theta);
        error = residual.iter().fold(error, |m, r| m.max(r.abs()));
        if let Some(cap) = program.cap {
            error = error.max(if self.capped { -self.state.cap[1] } else { self.state.theta - cap });
        }
        let all = self.state.x.iter().flatten().chain(&self.state.q).chain(self.state.multipliers.iter().flatten());
        let finite = self.state.theta.is_finite() && all.copied().all(f64::is_finite);
        if finite { error } else { f64::INFINITY }
    }

    fn greatest_multiplier(&self) -> f64 {
        self.state.multipliers.iter().flatten().fold(f64::MIN_POSITIVE, |m, z| m.max(z.abs())).max(1.0)
    }

    /// Returns true if no other motion is possible with the same yielding rows. Inverse iteration seeks a second one.
    fn unique(&self, stiffness: &mut Stiffness) -> Option<bool> {
        let scale = self.greatest_multiplier();
        let joints = self.program.members.iter().zip(&self.state.multipliers);
        let roots: Vec<Root> = joints
            .map(|(member, z)| {
                let yields = std::array::from_fn(|row| z[row] > SETTINGS.negligible * scale);
                Frame::new(&self.program.cones[member.cone], &yields).free
            })
            .collect();
        stiffness.factorise(self.program, roots.iter(), SETTINGS.shift, 0.0).then_some(())?;
        let q = &self.state.q;
        let squared = inner(q, q);
        let without = |w: &mut Vec<f64>| {
            let along = inner(w, q) / squared;
            w.iter_mut().zip(q).for_each(|(w, q)| *w -= along * q);
            let norm = inner(w, w).sqrt();
            w.iter_mut().for_each(|w| *w /= norm);
            norm
        };
        // A fixed, irregular start: no symmetry of the scene is orthogonal to it.
        let mut w: Vec<f64> =
            (0..q.len()).map(|i| 1.0 + 0.37 * ((i as f64 * 0.754_877_666 + 0.1).fract() - 0.5)).collect();
        without(&mut w);
        let mut softest = f64::INFINITY;
        for _ in 0..8 {
            stiffness.solve(&mut w);
            softest = 1.0 / without(&mut w);
        }
        // If a second motion exists, the least stiffness is the shift alone.
        Some(softest > SETTINGS.shift * (1.0 + 1e-3))
    }
}
