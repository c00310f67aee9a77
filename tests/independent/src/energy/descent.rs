//! Minima of the energy by a trust region, and stationary points by Newton's method.

use super::potential::{Derivatives, evaluate};
use super::scene::{EnergyScene, Held};
use nalgebra::{Cholesky, DMatrix, DVector, SymmetricEigen};

/// Largest gradient at a stationary point, relative to the force scale.
const TOLERANCE: f64 = 1e-9;
/// Greatest number of steps.
const MOST: usize = 400;

/// The end of a descent.
#[derive(Debug, Clone)]
pub struct Landing {
    /// The unknowns.
    pub q: DVector<f64>,
    /// The energy and its derivatives there.
    pub at: Derivatives,
    /// λ: given, or the multiplier of the held load point.
    pub factor: f64,
    /// Size of the remaining gradient, relative to the force scale.
    pub residual: f64,
    /// True if E is a minimum with the loads constant.
    pub stable_under_load: bool,
    /// True if E is a minimum with the load point held; the same value if there is no live load.
    pub stable_under_control: bool,
    /// Number of steps.
    pub steps: usize,
    /// True if Newton's method found an indefinite Hessian.
    pub met_indefinite: bool,
}

impl Landing {
    /// Returns true if it is a stationary point.
    pub fn converged(&self) -> bool {
        self.residual <= TOLERANCE
    }

    /// Returns the least eigenvalue of the Hessian with the loads constant (displacements in m at the poles of the
    /// scene, rotations in rad) \[N/m, N m\], and its direction.
    pub fn least_under_load(&self) -> (f64, DVector<f64>) {
        least(self.at.hessian.clone())
    }

    /// Returns the same for motions with the load point held.
    pub fn least_under_control(&self, scene: &EnergyScene) -> (f64, DVector<f64>) {
        least(constrained(scene, &self.at.hessian))
    }

    /// Returns the softest direction of the state under a control.
    pub fn softest(&self, scene: &EnergyScene, control: Control) -> DVector<f64> {
        match control {
            Control::Factor(_) => self.least_under_load().1,
            Control::Displacement => self.least_under_control(scene).1,
        }
    }
}

/// The controlled quantity: the factor, or the displacement of the load.
#[derive(Debug, Clone, Copy)]
pub enum Control {
    /// The factor λ.
    Factor(f64),
    /// ℓ·q / |ℓ| with its value at the start.
    Displacement,
}

/// The reduced problem at some unknowns.
struct Reduced {
    at: Derivatives,
    value: f64,
    gradient: DVector<f64>,
    hessian: DMatrix<f64>,
    factor: f64,
}

fn reduce(scene: &EnergyScene, held: &Held, q: &DVector<f64>, slip: Option<&[f64]>, control: Control) -> Reduced {
    let at = evaluate(scene, held, q, slip);
    match control {
        Control::Factor(factor) => Reduced {
            value: at.energy - factor * scene.load.dot(q),
            gradient: &at.gradient - factor * &scene.load,
            hessian: at.hessian.clone(),
            factor,
            at,
        },
        Control::Displacement => {
            let v = scene.load.normalize();
            let (value, factor) = (at.energy, v.dot(&at.gradient) / scene.load.norm());
            let gradient = &at.gradient - &v * v.dot(&at.gradient);
            Reduced { value, gradient, hessian: held_hessian(&at.hessian, &v), factor, at }
        }
    }
}

/// Returns the Hessian on the motions orthogonal to v, with a large stiffness along v.
pub(super) fn held_hessian(hessian: &DMatrix<f64>, v: &DVector<f64>) -> DMatrix<f64> {
    let stiff = hessian.diagonal().amax();
    let hv = hessian * v;
    let vhv = v.dot(&hv);
    hessian - v * hv.transpose() - &hv * v.transpose() + v * v.transpose() * (vhv + stiff)
}

/// Returns the step of least model value within a radius: Newton's step if it fits, else the step of the shifted
/// system.
fn trust_step(gradient: &DVector<f64>, hessian: &DMatrix<f64>, radius: f64) -> DVector<f64> {
    if let Some(factor) = Cholesky::new(hessian.clone()) {
        let step = -factor.solve(gradient);
        if step.norm() <= radius {
            return step;
        }
    }
    let eigen = SymmetricEigen::new(hessian.clone());
    let g = eigen.eigenvectors.transpose() * gradient;
    let least = eigen.eigenvalues.min();
    let scale = eigen.eigenvalues.amax().max(1e-300);
    let length = |shift: f64| -> f64 {
        g.iter().zip(eigen.eigenvalues.iter()).map(|(g, e)| (g / (e + shift)).powi(2)).sum::<f64>().sqrt()
    };
    let mut low = (-least).max(0.0) + 1e-14 * scale;
    let mut y: DVector<f64>;
    if length(low) < radius {
        // The hard case: use the rest of the radius along the softest direction.
        y = DVector::from_iterator(g.len(), g.iter().zip(eigen.eigenvalues.iter()).map(|(g, e)| -g / (e + low)));
        if least < 0.0 {
            let softest = eigen.eigenvalues.imin();
            let sense = if g[softest] > 0.0 { -1.0 } else { 1.0 };
            y[softest] += sense * (radius * radius - y.norm_squared()).max(0.0).sqrt();
        }
    } else {
        let mut high = low + gradient.norm() / radius + 1e-14 * scale;
        for _ in 0..100 {
            let middle = if high > 4.0 * low.max(1e-14 * scale) {
                (low.max(1e-14 * scale) * high).sqrt()
            } else {
                (low + high) / 2.0
            };
            if length(middle) > radius {
                low = middle
            } else {
                high = middle
            }
            if (high - low) <= 1e-6 * high {
                break;
            }
        }
        y = DVector::from_iterator(g.len(), g.iter().zip(eigen.eigenvalues.iter()).map(|(g, e)| -g / (e + high)));
    }
    &eigen.eigenvectors * y
}

/// Descends from `q` to a minimum of the energy (under [`Control::Displacement`], of the energy with the load point
/// held at its place in `q`). From a saddle point it starts along the softest direction.
pub fn land(scene: &EnergyScene, held: &Held, q: &DVector<f64>, slip: Option<&[f64]>, control: Control) -> Landing {
    let scale = scene.force_scale();
    let mut q = q.clone();
    let mut here = reduce(scene, held, &q, slip, control);
    let mut radius = 1e-3 * scene.size;
    let mut steps = 0;
    while steps < MOST {
        let size = here.gradient.norm();
        if size <= TOLERANCE * scale && Cholesky::new(here.hessian.clone()).is_some() {
            break;
        }
        steps += 1;
        let step = trust_step(&here.gradient, &here.hessian, radius);
        let promised = -(here.gradient.dot(&step) + 0.5 * step.dot(&(&here.hessian * &step)));
        let next = &q + &step;
        let there = reduce(scene, held, &next, slip, control);
        let gained = here.value - there.value;
        // Below the rounding of the energy the gradient decides.
        let noise = 1e-13 * here.value.abs().max(there.value.abs()).max(scale * 1e-6 * scene.size);
        let good = if promised.abs() <= 10.0 * noise {
            there.gradient.norm() <= size.max(TOLERANCE * scale)
        } else {
            gained >= 1e-4 * promised
        };
        if good {
            if promised > 10.0 * noise && gained < 0.25 * promised {
                radius *= 0.5;
            } else if step.norm() > 0.8 * radius && gained > 0.75 * promised {
                radius = (2.0 * radius).min(0.05 * scene.size);
            }
            (q, here) = (next, there);
        } else {
            radius = 0.25 * step.norm().min(radius);
            if radius < 1e-15 * scene.size {
                break;
            }
        }
    }
    finished(scene, q, here, steps)
}

/// Returns a stationary point near `q` by Newton's method on the gradient, stable or not.
pub fn stationary(
    scene: &EnergyScene,
    held: &Held,
    q: &DVector<f64>,
    slip: Option<&[f64]>,
    control: Control,
) -> Landing {
    let scale = scene.force_scale();
    let mut q = q.clone();
    let mut here = reduce(scene, held, &q, slip, control);
    let (mut steps, mut met_indefinite) = (0, false);
    while here.gradient.norm() > TOLERANCE * scale && steps < 25 {
        steps += 1;
        met_indefinite |= Cholesky::new(here.hessian.clone()).is_none();
        let Some(step) = here.hessian.clone().lu().solve(&here.gradient) else { break };
        let mut share = 1.0;
        loop {
            let next = &q - &step * share;
            let there = reduce(scene, held, &next, slip, control);
            if there.gradient.norm() < (1.0 - 0.1 * share) * here.gradient.norm() || share < 0.01 {
                (q, here) = (next, there);
                break;
            }
            share *= 0.5;
        }
    }
    Landing { met_indefinite, ..finished(scene, q, here, steps) }
}

fn finished(scene: &EnergyScene, q: DVector<f64>, here: Reduced, steps: usize) -> Landing {
    let stable_under_load = Cholesky::new(here.at.hessian.clone()).is_some();
    Landing {
        residual: here.gradient.norm() / scene.force_scale(),
        q,
        factor: here.factor,
        stable_under_load,
        stable_under_control: stable_under_load || Cholesky::new(constrained(scene, &here.at.hessian)).is_some(),
        at: here.at,
        steps,
        met_indefinite: false,
    }
}

/// Returns the Hessian with the load point held, if there is a load.
fn constrained(scene: &EnergyScene, hessian: &DMatrix<f64>) -> DMatrix<f64> {
    if scene.load.norm() > 0.0 { held_hessian(hessian, &scene.load.normalize()) } else { hessian.clone() }
}

fn least(hessian: DMatrix<f64>) -> (f64, DVector<f64>) {
    let eigen = SymmetricEigen::new(hessian);
    let at = eigen.eigenvalues.imin();
    (eigen.eigenvalues[at], eigen.eigenvectors.column(at).into_owned())
}
