//! One point of a material or of a joint on a path of mixed control.
//!
//! For each component, either the strain (the gap of a joint) or the stress (its traction) is prescribed. Newton's
//! method with the tangent of the law finds the free strains; a step that does not converge is halved. Stresses beyond
//! the strength of the law end in [`Stop`], never in a result. A controlled stress that falls unloads the point; use
//! controlled strains to follow the falling branch of a law that softens.

use crate::settings::SETTINGS;
use std::fmt;
use std::sync::Arc;
use voussoir_core::law::{InterfaceResponse, PlanarUpdate, PointContext, StressUpdate, UpdateContext, UpdateFailure};

/// Greatest number of components.
pub const COMPONENTS: usize = 6;
const ITERATIONS: usize = 50;
/// Greatest number of halvings of a step.
const HALVINGS: u32 = 14;

/// The law at the point.
#[derive(Debug, Clone)]
pub enum PointLaw {
    /// A material in space: strains and stresses xx, yy, zz, xy, yz, zx; characteristic length \[m\].
    Space(Arc<dyn StressUpdate>, f64),
    /// A material in a plane: xx, yy, xy; characteristic length \[m\].
    Plane(PlanarUpdate, f64),
    /// A joint: gaps and tractions n, t.
    Joint(Arc<dyn InterfaceResponse>),
}

/// The response of the law at the end of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointResponse {
    /// Strains or gaps; unused components are 0.
    pub strain: [f64; COMPONENTS],
    /// Stresses or tractions \[Pa\].
    pub stress: [f64; COMPONENTS],
    /// In a plane: ε_zz and σ_zz.
    pub across: [f64; 2],
    /// ∂stress/∂strain.
    pub tangent: [[f64; COMPONENTS]; COMPONENTS],
    /// Region, or branch of the update.
    pub region: &'static str,
    /// Plastic work or dissipated energy of the step, per volume or per area.
    pub dissipated: f64,
}

/// The prescribed quantity of one component.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Control {
    /// Strain or gap.
    Strain(f64),
    /// Stress or traction \[Pa\].
    Stress(f64),
}

/// The reason why a path ends early.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Stop {
    /// The update of the law failed.
    Law(UpdateFailure),
    /// The controlled stresses could not be reached: they are beyond the strength, or beyond a peak that only a
    /// controlled strain can pass.
    Unreachable {
        /// Completed share of the step, from 0 to 1.
        done: f64,
        /// Greatest error of a controlled stress at the last attempt \[Pa\].
        error: f64,
    },
}

impl fmt::Display for Stop {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Stop::Law(failure) => write!(out, "{failure}"),
            Stop::Unreachable { done, error } => write!(
                out,
                "the controlled stresses cannot be reached (done: {:.3} of the step, error {error:.3e} Pa): they are beyond \
                 the strength, or beyond a peak that only a controlled strain passes",
                done
            ),
        }
    }
}

impl PointLaw {
    /// Returns the number of components.
    pub fn components(&self) -> usize {
        match self {
            PointLaw::Space(..) => 6,
            PointLaw::Plane(..) => 3,
            PointLaw::Joint(_) => 2,
        }
    }

    /// Returns the names of the components.
    pub fn names(&self) -> &'static [&'static str] {
        match self {
            PointLaw::Space(..) => &["xx", "yy", "zz", "xy", "yz", "zx"],
            PointLaw::Plane(..) => &["xx", "yy", "xy"],
            PointLaw::Joint(_) => &["n", "t"],
        }
    }

    /// Returns the state of the undeformed point.
    pub fn initial_state(&self) -> Vec<f64> {
        let size = match self {
            PointLaw::Space(law, _) => law.state_size(),
            PointLaw::Plane(law, _) => law.state_size(),
            PointLaw::Joint(law) => law.state_size(),
        };
        let mut state = vec![0.0; size];
        match self {
            PointLaw::Space(law, _) => law.initial_state(&mut state),
            PointLaw::Plane(law, _) => law.initial_state(&mut state),
            PointLaw::Joint(law) => law.initial_state(&mut state),
        }
        state
    }

    /// Returns the names of the state variables, with units.
    pub fn state_names(&self) -> Vec<&'static str> {
        match self {
            PointLaw::Space(law, _) => law.state_names().to_vec(),
            PointLaw::Plane(law, _) => {
                let mut names = law.law().state_names().to_vec();
                names.extend((names.len() < law.state_size()).then_some("strain_across [-]"));
                names
            }
            PointLaw::Joint(law) => law.state_names().to_vec(),
        }
    }

    /// Computes one update.
    pub fn update(
        &self,
        strain: &[f64; COMPONENTS],
        old: &[f64],
        new: &mut [f64],
    ) -> Result<PointResponse, UpdateFailure> {
        let mut out = PointResponse {
            strain: *strain,
            stress: [0.0; COMPONENTS],
            across: [0.0; 2],
            tangent: [[0.0; COMPONENTS]; COMPONENTS],
            region: "",
            dissipated: 0.0,
        };
        match self {
            PointLaw::Space(law, length) => {
                let point = law.update_point(strain, &UpdateContext::of_length(*length), old, new)?;
                (out.stress, out.tangent) = (point.stress, point.tangent);
                (out.region, out.dissipated) = (point.branch.name, point.dissipated);
            }
            PointLaw::Plane(law, length) => {
                let point =
                    law.update_point(&[strain[0], strain[1], strain[2]], &UpdateContext::of_length(*length), old, new)?;
                out.stress[..3].copy_from_slice(&point.stress);
                for (row, given) in out.tangent.iter_mut().zip(&point.tangent) {
                    row[..3].copy_from_slice(given);
                }
                out.across = [point.strain_across, point.stress_across];
                (out.region, out.dissipated) = (point.branch.name, point.dissipated);
            }
            PointLaw::Joint(law) => {
                let point = law.respond_point([strain[0], strain[1]], &PointContext::default(), old, new)?;
                out.stress[..2].copy_from_slice(&point.traction);
                for (row, given) in out.tangent.iter_mut().zip(&point.tangent) {
                    row[..2].copy_from_slice(given);
                }
                (out.region, out.dissipated) = (point.branch.name, point.dissipated);
            }
        }
        Ok(out)
    }
}

/// A point on its path.
#[derive(Debug, Clone)]
pub struct DrivenPoint {
    law: PointLaw,
    state: Vec<f64>,
    scratch: Vec<f64>,
    /// Tangent of the undeformed point.
    elastic: [[f64; COMPONENTS]; COMPONENTS],
    /// Greatest entry of that tangent \[Pa\]; it converts rounding errors of strains into stresses.
    stiffness: f64,
    /// Present response.
    pub response: PointResponse,
    /// Number of evaluations of the law.
    pub evaluations: u64,
    /// Number of halved steps.
    pub halvings: u64,
}

impl DrivenPoint {
    /// Creates an undeformed point.
    pub fn new(law: PointLaw) -> Result<Self, UpdateFailure> {
        let state = law.initial_state();
        let mut scratch = state.clone();
        let response = law.update(&[0.0; COMPONENTS], &state, &mut scratch)?;
        let elastic = response.tangent;
        let stiffness = elastic.iter().flatten().fold(0.0_f64, |a, b| a.max(b.abs()));
        Ok(DrivenPoint { law, state, scratch, elastic, stiffness, response, evaluations: 1, halvings: 0 })
    }

    /// Returns the law.
    pub fn law(&self) -> &PointLaw {
        &self.law
    }

    /// Returns the state variables.
    pub fn state(&self) -> &[f64] {
        &self.state
    }

    /// Moves to these controls, one per component, in a straight line from the present ones; the dissipation of the
    /// step is the sum over its parts. After a failure the point stays at the end of the last completed part.
    pub fn step(&mut self, controls: &[Control]) -> Result<(), Stop> {
        let count = self.law.components();
        let start: [f64; COMPONENTS] = std::array::from_fn(|i| match controls.get(i) {
            Some(Control::Stress(_)) => self.response.stress[i],
            _ => self.response.strain[i],
        });
        let (mut done, mut share, mut dissipated) = (0.0, 1.0, 0.0);
        let mut left = HALVINGS;
        while done < 1.0 {
            let to = if done + share >= 1.0 { 1.0 } else { done + share };
            let part: Vec<Control> = controls[..count]
                .iter()
                .zip(start)
                .map(|(control, from)| {
                    // The end of a step is reached exactly, without rounding.
                    let between = |target: f64| if to == 1.0 { target } else { from + to * (target - from) };
                    match control {
                        Control::Strain(target) => Control::Strain(between(*target)),
                        Control::Stress(target) => Control::Stress(between(*target)),
                    }
                })
                .collect();
            match self.solve(&part) {
                Ok(found) => {
                    dissipated += found.dissipated;
                    self.response = found;
                    std::mem::swap(&mut self.state, &mut self.scratch);
                    done = to;
                }
                Err(stop) if left == 0 => {
                    self.response.dissipated = dissipated;
                    return Err(match stop {
                        Stop::Unreachable { error, .. } => Stop::Unreachable { done, error },
                        law => law,
                    });
                }
                Err(_) => {
                    share *= 0.5;
                    left -= 1;
                    self.halvings += 1;
                }
            }
        }
        self.response.dissipated = dissipated;
        Ok(())
    }

    /// Returns the greatest error of a controlled stress \[Pa\].
    pub fn error(&self, controls: &[Control]) -> f64 {
        residual(controls, &self.response).iter().fold(0.0, |a, b| a.max(b.abs()))
    }

    /// Solves one part of a step. If stresses are controlled, unloading is tried first: beyond a peak a falling stress
    /// has two solutions, unloading and more softening. Only the first is stable (its second-order work Δσ·Δε is
    /// positive, Hill 1958).
    fn solve(&mut self, controls: &[Control]) -> Result<PointResponse, Stop> {
        if controls.iter().any(|control| matches!(control, Control::Stress(_))) {
            let unloading = self.unloading_tangent()?;
            if let Ok(found) = self.solve_from(controls, &unloading)
                && found.dissipated == 0.0
            {
                return Ok(found);
            }
        }
        self.solve_from(controls, &self.response.tangent.clone())
    }

    /// Returns the tangent for unloading: for materials the initial one; for joints that slightly before the gap.
    fn unloading_tangent(&mut self) -> Result<[[f64; COMPONENTS]; COMPONENTS], Stop> {
        if !matches!(self.law, PointLaw::Joint(_)) {
            return Ok(self.elastic);
        }
        let before = self.response.strain.map(|gap| (1.0 - 1e-6) * gap);
        self.evaluate(&before).map(|found| found.tangent)
    }

    /// Solves by Newton's method from a predictor with this tangent.
    fn solve_from(
        &mut self,
        controls: &[Control],
        predictor: &[[f64; COMPONENTS]; COMPONENTS],
    ) -> Result<PointResponse, Stop> {
        let mut strain = self.response.strain;
        for (entry, control) in strain.iter_mut().zip(controls) {
            if let Control::Strain(target) = control {
                *entry = *target;
            }
        }
        let free: Vec<usize> = (0..controls.len()).filter(|&i| matches!(controls[i], Control::Stress(_))).collect();
        // The predictor applies the change of the given strains to the free ones.
        let change: [f64; COMPONENTS] = std::array::from_fn(|i| strain[i] - self.response.strain[i]);
        let mut right = residual(controls, &self.response);
        for &i in &free {
            right[i] += (0..controls.len()).map(|j| predictor[i][j] * change[j]).sum::<f64>();
        }
        if let Some(delta) = solve_free(predictor, &right, &free) {
            free.iter().for_each(|&i| strain[i] -= delta[i]);
        }
        let mut found = self.evaluate(&strain)?;
        let mut best = f64::INFINITY;
        for _ in 0..ITERATIONS {
            let wrong = residual(controls, &found);
            let error = wrong.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
            let largest = found.stress.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
            let noise = self.stiffness * strain.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
            best = best.min(error);
            if error <= SETTINGS.shift() * largest + 8.0 * f64::EPSILON * noise {
                return Ok(found);
            }
            let Some(delta) = solve_free(&found.tangent, &wrong, &free) else {
                return Err(Stop::Unreachable { done: 0.0, error });
            };
            // Backtracking on the greatest error.
            let (mut fraction, mut accepted) = (1.0, None);
            for _ in 0..12 {
                let mut next = strain;
                free.iter().for_each(|&i| next[i] -= fraction * delta[i]);
                let there = self.evaluate(&next)?;
                let now = residual(controls, &there).iter().fold(0.0_f64, |a, b| a.max(b.abs()));
                if now < error * (1.0 - 1e-4 * fraction) {
                    accepted = Some((next, there));
                    break;
                }
                fraction *= 0.5;
            }
            match accepted {
                Some((next, there)) => (strain, found) = (next, there),
                None => return Err(Stop::Unreachable { done: 0.0, error }),
            }
        }
        Err(Stop::Unreachable { done: 0.0, error: best })
    }

    fn evaluate(&mut self, strain: &[f64; COMPONENTS]) -> Result<PointResponse, Stop> {
        self.evaluations += 1;
        self.law.update(strain, &self.state, &mut self.scratch).map_err(Stop::Law)
    }
}

/// Returns stress minus target for controlled stresses, 0 for other components.
fn residual(controls: &[Control], response: &PointResponse) -> [f64; COMPONENTS] {
    std::array::from_fn(|i| match controls.get(i) {
        Some(Control::Stress(target)) => response.stress[i] - target,
        _ => 0.0,
    })
}

/// Solves for the free components by elimination with full pivoting; `None` if the matrix is singular.
fn solve_free(
    tangent: &[[f64; COMPONENTS]; COMPONENTS],
    right: &[f64; COMPONENTS],
    free: &[usize],
) -> Option<[f64; COMPONENTS]> {
    let n = free.len();
    let mut matrix: Vec<Vec<f64>> =
        free.iter().map(|&i| free.iter().map(|&j| tangent[i][j]).chain([right[i]]).collect()).collect();
    let mut order: Vec<usize> = (0..n).collect();
    let scale = matrix.iter().flat_map(|row| &row[..n]).fold(0.0_f64, |a, b| a.max(b.abs()));
    for k in 0..n {
        let places = (k..n).flat_map(|i| (k..n).map(move |j| (i, j)));
        let (i, j) = places.max_by(|a, b| matrix[a.0][a.1].abs().total_cmp(&matrix[b.0][b.1].abs()))?;
        let pivot = matrix[i][j].abs();
        if pivot.is_nan() || pivot <= 1e-14 * scale {
            return None;
        }
        matrix.swap(k, i);
        matrix.iter_mut().for_each(|row| row.swap(k, j));
        order.swap(k, j);
        let (above, below) = matrix.split_at_mut(k + 1);
        for row in below {
            let factor = row[k] / above[k][k];
            row.iter_mut().zip(&above[k]).skip(k).for_each(|(entry, pivot)| *entry -= factor * pivot);
        }
    }
    let mut out = [0.0; COMPONENTS];
    for k in (0..n).rev() {
        let rest: f64 = (k + 1..n).map(|j| matrix[k][j] * out[free[order[j]]]).sum();
        out[free[order[k]]] = (matrix[k][n] - rest) / matrix[k][k];
    }
    Some(out)
}
