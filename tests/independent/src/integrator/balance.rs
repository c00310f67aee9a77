//! Residual and tangent of equilibrium.

use super::dual::Dual;
use super::law::{Memory, Mode, Response};
use super::scene::{Contact, Scene};
use nalgebra::{DMatrix, DVector};

/// Shares of the dead load and of the live load.
#[derive(Debug, Clone, Copy)]
pub struct Loads {
    /// Factor of gravity.
    pub dead: f64,
    /// λ.
    pub live: f64,
}

/// Equilibrium at given motions.
#[derive(Debug, Clone)]
pub struct Balance {
    /// Unbalanced forces and moments, relative to the weight and the size of the scene.
    pub residual: DVector<f64>,
    /// Its derivative with respect to the scaled motions.
    pub tangent: DMatrix<f64>,
    /// The contact points.
    pub points: Vec<Response>,
}

/// Rotations \[rad\] for the difference quotient of G.
const DIFFERENCE: f64 = 1e-6;

/// Returns the motions of both sides of a contact point.
fn motions(rows: [Option<usize>; 2], q: &[f64]) -> [[f64; 3]; 2] {
    rows.map(|row| row.map_or([0.0; 3], |row| [q[row], q[row + 1], q[row + 2]]))
}

/// Returns equilibrium at the motions `q`, from the memories at the start of the step. If `modes` are given, the
/// tangent is that of these modes.
pub fn balance(scene: &Scene, q: &[f64], loads: Loads, before: &[Memory], modes: Option<&[Mode]>) -> Balance {
    let count = q.len();
    let mut force = DVector::zeros(count);
    let mut tangent = DMatrix::zeros(count, count);
    let mut points = Vec::with_capacity(scene.contacts.len());
    for (index, contact) in scene.contacts.iter().enumerate() {
        let at = motions(contact.rows, q);
        let gap = contact.gap(at);
        let response = contact.law.respond(&before[index], gap.map(|g| g.value));
        let stiffness = modes.map_or(response.tangent, |modes| contact.tangent(modes[index]));
        let rows: Vec<(usize, usize)> = (0..6).filter_map(|k| Some((k, contact.rows[k / 3]? + k % 3))).collect();
        for &(k, row) in &rows {
            force[row] += pull(&gap, response.force, k);
            for &(l, column) in &rows {
                for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                    tangent[(row, column)] += gap[i].slope[k] * stiffness[i][j] * gap[j].slope[l];
                }
            }
        }
        if response.force != [0.0; 2] {
            add_turning(scene, contact, (at, response.force), &rows, &mut tangent);
        }
        points.push(response);
    }
    add_loads(scene, q, loads, (&mut force, &mut tangent));
    let unit = |k: usize| if k % 3 == 2 { scene.size } else { 1.0 };
    let residual = DVector::from_fn(count, |k, _| force[k] / (scene.weight * unit(k)));
    // Unknowns are u / size and θ.
    let column = |l: usize| if l % 3 == 2 { 1.0 } else { scene.size };
    let tangent = DMatrix::from_fn(count, count, |k, l| tangent[(k, l)] * column(l) / (scene.weight * unit(k)));
    Balance { residual, tangent, points }
}

/// Returns the generalised force of a contact force on one of the six motions.
fn pull(gap: &[Dual<6>; 2], force: [f64; 2], k: usize) -> f64 {
    gap[0].slope[k] * force[0] + gap[1].slope[k] * force[1]
}

/// Adds r·∂²g/∂q²: G rotates with the blocks.
fn add_turning(
    scene: &Scene,
    contact: &Contact,
    (at, force): ([[f64; 3]; 2], [f64; 2]),
    rows: &[(usize, usize)],
    tangent: &mut DMatrix<f64>,
) {
    for &(l, column) in rows {
        let h = DIFFERENCE * if l % 3 == 2 { 1.0 } else { scene.size };
        let [up, down] = [h, -h].map(|h| {
            let mut at = at;
            at[l / 3][l % 3] += h;
            contact.gap(at)
        });
        for &(k, row) in rows {
            tangent[(row, column)] += (pull(&up, force, k) - pull(&down, force, k)) / (2.0 * h);
        }
    }
}

/// Returns the scaled forces of loads, without contact.
pub fn load_rate(scene: &Scene, q: &[f64], loads: Loads) -> DVector<f64> {
    let mut force = DVector::zeros(q.len());
    add_loads(scene, q, loads, (&mut force, &mut DMatrix::zeros(q.len(), q.len())));
    DVector::from_fn(q.len(), |k, _| force[k] / (scene.weight * if k % 3 == 2 { scene.size } else { 1.0 }))
}

fn add_loads(scene: &Scene, q: &[f64], loads: Loads, (force, tangent): (&mut DVector<f64>, &mut DMatrix<f64>)) {
    for (index, block) in scene.blocks.iter().enumerate() {
        let row = 3 * index;
        force[row] += loads.dead * block.weight.x;
        force[row + 1] += loads.dead * block.weight.y;
        let (sine, cosine) = q[row + 2].sin_cos();
        for (p, arm) in &block.forces {
            let at = [cosine * arm.x - sine * arm.y, sine * arm.x + cosine * arm.y];
            force[row] += loads.live * p.x;
            force[row + 1] += loads.live * p.y;
            force[row + 2] += loads.live * (at[0] * p.y - at[1] * p.x);
            tangent[(row + 2, row + 2)] += loads.live * (-at[1] * p.y - at[0] * p.x);
        }
    }
}
