//! The energy, its gradient and its Hessian.

use super::scene::{EnergyScene, Held};
use nalgebra::{DMatrix, DVector, SMatrix, SVector};
use voussoir::core::model::geometry::{Vec2, turned};

/// The energy \[J\] at given motions and its derivatives with respect to them \[N, N m; N/m …\].
#[derive(Debug, Clone)]
pub struct Derivatives {
    /// E without the live load that is followed.
    pub energy: f64,
    /// ∂E/∂q.
    pub gradient: DVector<f64>,
    /// ∂²E/∂q²; for a point that is about to open, the value of the closed side.
    pub hessian: DMatrix<f64>,
    /// (r_n, r_t) of every point \[N\], r_n ≥ 0 in compression, r_t on the plus block.
    pub force: Vec<[f64; 2]>,
    /// (g_n, g_t) of every point \[m\].
    pub gap: Vec<[f64; 2]>,
}

type Six = SVector<f64, 6>;
type SixBySix = SMatrix<f64, 6, 6>;

/// A rotation by θ: sin θ and 1 − cos θ, which avoids cancellation.
#[derive(Clone, Copy)]
struct Rotation {
    sine: f64,
    versine: f64,
}

impl Rotation {
    fn by(angle: f64) -> Self {
        Rotation { sine: angle.sin(), versine: 2.0 * (angle / 2.0).sin().powi(2) }
    }

    /// (R − 1) v.
    fn shift(self, v: Vec2) -> Vec2 {
        turned(v) * self.sine - v * self.versine
    }

    fn turn(self, v: Vec2) -> Vec2 {
        v + self.shift(v)
    }
}

/// Returns one gap e(θ_c)·(x⁺ − x⁻) with its derivatives with respect to (u⁻, θ⁻, u⁺, θ⁺). `arms` are R(θ)(X − P) of
/// both sides, `jump` is x⁺ − x⁻, `shares` are the weights of both sides in θ_c.
fn gap_derivatives(e: Vec2, jump: Vec2, arms: [Vec2; 2], shares: [f64; 2]) -> (f64, Six, SixBySix) {
    let de = turned(e);
    let (mut first, mut second) = (Six::zeros(), SixBySix::zeros());
    for (side, sign) in [(0, -1.0), (1, 1.0)] {
        let at = 3 * side;
        first[at] = sign * e.x;
        first[at + 1] = sign * e.y;
        first[at + 2] = sign * e.dot(&turned(arms[side])) + shares[side] * de.dot(&jump);
        for other in 0..2 {
            let column = 3 * other + 2;
            for (k, value) in [(at, de.x), (at + 1, de.y)] {
                second[(k, column)] = sign * shares[other] * value;
                second[(column, k)] = second[(k, column)];
            }
            let signs = [-1.0, 1.0];
            let mut value = shares[side] * signs[other] * de.dot(&turned(arms[other]))
                + shares[other] * sign * de.dot(&turned(arms[side]))
                - shares[side] * shares[other] * e.dot(&jump);
            if side == other {
                value -= sign * e.dot(&arms[side]);
            }
            second[(at + 2, column)] = value;
        }
    }
    (e.dot(&jump), first, second)
}

/// Returns the energy at the unknowns `q` and the slip `s` of every point.
pub fn evaluate(scene: &EnergyScene, held: &Held, q: &DVector<f64>, slip: Option<&[f64]>) -> Derivatives {
    let place = scene.place(held, q);
    let size = scene.unknowns();
    let mut out = Derivatives {
        energy: -held.constant * scene.load.dot(q),
        gradient: -held.constant * &scene.load,
        hessian: DMatrix::zeros(size, size),
        force: Vec::with_capacity(scene.points.len()),
        gap: Vec::with_capacity(scene.points.len()),
    };
    let turns: Vec<Rotation> = place.motion.iter().map(|motion| Rotation::by(motion[2])).collect();
    let mut joint_turn = (usize::MAX, 0.0, Rotation::by(0.0));
    for (index, point) in scene.points.iter().enumerate() {
        let [minus, plus] = point.sides.map(|side| (&scene.blocks[side], place.motion[side], turns[side]));
        let shares = [1.0 - point.share, point.share];
        if (joint_turn.0, joint_turn.1) != (point.joint, point.share) {
            joint_turn = (point.joint, point.share, Rotation::by(shares[0] * minus.1[2] + shares[1] * plus.1[2]));
        }
        let arms = [minus, plus].map(|(block, _, turn)| turn.turn(point.position - block.pole));
        let moved = [minus, plus]
            .map(|(block, motion, turn)| Vec2::new(motion[0], motion[1]) + turn.shift(point.position - block.pole));
        let axes = point.axes.map(|axis| joint_turn.2.turn(axis));
        let (mut gap, mut force) = ([0.0; 2], [0.0; 2]);
        let (mut first, mut second) = (Six::zeros(), SixBySix::zeros());
        for i in 0..2 {
            let (value, dg, ddg) = gap_derivatives(axes[i], moved[1] - moved[0], arms, shares);
            gap[i] = value + if i == 0 { point.gap } else { 0.0 };
            let stretch = if i == 0 { gap[0].min(0.0) } else { gap[1] - slip.map_or(0.0, |s| s[index]) };
            if i == 0 && gap[0] > 0.0 {
                continue;
            }
            let k = point.stiffness[i];
            force[i] = -k * stretch;
            out.energy += 0.5 * k * stretch * stretch;
            first += dg * (k * stretch);
            second += dg * dg.transpose() * k + ddg * (k * stretch);
        }
        out.force.push(force);
        out.gap.push(gap);
        for (a, side) in [minus, plus].iter().enumerate() {
            let Some(row) = side.0.unknown else { continue };
            let own = first.fixed_rows::<3>(3 * a);
            let mut gradient = out.gradient.fixed_rows_mut::<3>(row);
            gradient += own;
            for (b, other) in [minus, plus].iter().enumerate() {
                let Some(column) = other.0.unknown else { continue };
                let part = second.fixed_view::<3, 3>(3 * a, 3 * b);
                let mut hessian = out.hessian.fixed_view_mut::<3, 3>(row, column);
                hessian += part;
            }
        }
    }
    for ((block, motion), turn) in scene.blocks.iter().zip(&place.motion).zip(&turns) {
        let Some(at) = block.unknown else { continue };
        let weight = held.gravity * block.mass;
        let arm = turn.turn(block.centroid - block.pole);
        let shift = turn.shift(block.centroid - block.pole);
        out.energy -= weight.dot(&(Vec2::new(motion[0], motion[1]) + shift));
        out.gradient[at] -= weight.x;
        out.gradient[at + 1] -= weight.y;
        out.gradient[at + 2] -= weight.dot(&turned(arm));
        out.hessian[(at + 2, at + 2)] += weight.dot(&arm);
    }
    out
}
