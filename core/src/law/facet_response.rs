//! Tractions from gaps for laws that are given by facets, with the stiffness of the joint.
//!
//! The update is fully implicit: t = −K (g − g_p) with K = diag(k_n, k_t), a·t ≤ b on every facet, ġ_p = −Σ γ_i d_i,
//! γ_i ≥ 0, and γ_i > 0 only on facets that are reached. In the plane at most two facets can be active. The update
//! therefore tries every single facet and every pair and uses the admissible candidate. An opening facet without
//! tensile strength causes no plastic flow, since the joint closes again where it opened: its part of g_p is not
//! stored. Plastic parts from tearing, crushing and dilation are stored.

use super::branch::{Effect, UpdateBranch};
use super::context::PointContext;
use super::facet::{Facet, FacetMode};
use super::response::{InterfaceResponse, TractionPoint};
use super::update::UpdateFailure;

/// The joint yields on a facet.
const SLIDING: UpdateBranch = UpdateBranch::new("sliding", Effect::Sliding);
/// The joint opens in a step in which it also slides.
const SLIDING_OPEN: UpdateBranch = UpdateBranch::new("sliding_open", Effect::Sliding);

/// A joint law made of facets and a stiffness.
#[derive(Debug, Clone)]
pub struct FacetResponse {
    facets: Vec<Facet>,
    stiffness: [f64; 2],
}

/// A candidate active set: its facets, their multipliers \[m\], and the traction.
struct Active<'a> {
    facets: [Option<&'a Facet>; 2],
    steps: [f64; 2],
    traction: [f64; 2],
    excess: f64,
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

impl FacetResponse {
    /// Creates the response from facets and the stiffness \[k_n, k_t\] \[Pa/m\]. Returns `None` unless both are finite.
    pub fn new(facets: Vec<Facet>, stiffness: [f64; 2]) -> Option<Self> {
        stiffness.iter().all(|k| k.is_finite()).then_some(FacetResponse { facets, stiffness })
    }

    fn pull(&self, direction: [f64; 2]) -> [f64; 2] {
        [self.stiffness[0] * direction[0], self.stiffness[1] * direction[1]]
    }

    fn excess(&self, traction: [f64; 2]) -> f64 {
        self.facets.iter().map(|f| dot(f.normal, traction) - f.bound).fold(f64::NEG_INFINITY, f64::max)
    }

    fn alone<'a>(&self, trial: [f64; 2], facet: &'a Facet) -> Option<Active<'a>> {
        let pull = self.pull(facet.flow);
        let step = (dot(facet.normal, trial) - facet.bound) / dot(facet.normal, pull);
        let traction = [trial[0] - step * pull[0], trial[1] - step * pull[1]];
        (step >= 0.0).then(|| Active {
            facets: [Some(facet), None],
            steps: [step, 0.0],
            traction,
            excess: self.excess(traction),
        })
    }

    fn pair<'a>(&self, trial: [f64; 2], one: &'a Facet, two: &'a Facet) -> Option<Active<'a>> {
        let corner = intersection(one, two)?;
        // Σ γ K d = trial − corner.
        let (a, b) = (self.pull(one.flow), self.pull(two.flow));
        let away = [trial[0] - corner[0], trial[1] - corner[1]];
        let determinant = a[0] * b[1] - a[1] * b[0];
        if determinant == 0.0 {
            return None;
        }
        let steps = [(away[0] * b[1] - away[1] * b[0]) / determinant, (a[0] * away[1] - a[1] * away[0]) / determinant];
        (steps[0] >= 0.0 && steps[1] >= 0.0).then(|| Active {
            facets: [Some(one), Some(two)],
            steps,
            traction: corner,
            excess: self.excess(corner),
        })
    }

    fn tangent(&self, active: &[Option<&Facet>; 2]) -> [[f64; 2]; 2] {
        let [k_n, k_t] = self.stiffness;
        match active {
            [Some(_), Some(_)] => [[0.0; 2]; 2],
            [Some(facet), None] => {
                let pull = self.pull(facet.flow);
                let across = dot(facet.normal, pull);
                let row = [facet.normal[0] * k_n, facet.normal[1] * k_t];
                let entry =
                    |i: usize, j: usize| pull[i] * row[j] / across - if i == j { self.stiffness[i] } else { 0.0 };
                [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]]
            }
            _ => [[-k_n, 0.0], [0.0, -k_t]],
        }
    }
}

fn intersection(one: &Facet, two: &Facet) -> Option<[f64; 2]> {
    let (a, b) = (one.normal, two.normal);
    let determinant = a[0] * b[1] - a[1] * b[0];
    let corner = [one.bound * b[1] - two.bound * a[1], two.bound * a[0] - one.bound * b[0]];
    (determinant != 0.0).then(|| [corner[0] / determinant, corner[1] / determinant])
}

impl InterfaceResponse for FacetResponse {
    fn state_size(&self) -> usize {
        2
    }

    fn initial_state(&self, state: &mut [f64]) {
        state.fill(0.0);
    }

    fn state_names(&self) -> &'static [&'static str] {
        &["plastic_gap_n [m]", "plastic_gap_t [m]"]
    }

    fn respond_point(
        &self,
        gap: [f64; 2],
        _: &PointContext,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<TractionPoint, UpdateFailure> {
        if !gap.iter().chain(old).all(|x| x.is_finite()) {
            return Err(UpdateFailure::NotFinite);
        }
        let trial = [-self.stiffness[0] * (gap[0] - old[0]), -self.stiffness[1] * (gap[1] - old[1])];
        new.copy_from_slice(old);
        let mut found =
            Active { facets: [None; 2], steps: [0.0; 2], traction: trial, excess: self.excess(trial).max(0.0) };
        if found.excess > 0.0 {
            let alone = self.facets.iter().filter_map(|facet| self.alone(trial, facet));
            let pairs = self
                .facets
                .iter()
                .enumerate()
                .flat_map(|(i, one)| self.facets[i + 1..].iter().filter_map(move |two| self.pair(trial, one, two)));
            for candidate in alone.chain(pairs) {
                if candidate.excess < found.excess {
                    found = candidate;
                }
            }
            let size = trial[0].abs().max(trial[1].abs());
            if found.excess > 1e-12 * size {
                return Err(UpdateFailure::Law("no flow of the law's facets returns the traction to them"));
            }
        }
        let mut branch = UpdateBranch::ELASTIC;
        let mut dissipated = 0.0;
        for (facet, step) in found.facets.iter().zip(found.steps) {
            let Some(facet) = facet else { continue };
            dissipated += step * dot(facet.flow, found.traction);
            if step > 0.0 && !(facet.mode == FacetMode::Opening && facet.bound == 0.0) {
                branch = SLIDING;
                new[0] -= step * facet.flow[0];
                new[1] -= step * facet.flow[1];
            }
        }
        let parts = |facet: &&Facet| facet.mode == FacetMode::Opening && facet.bound == 0.0;
        if found.facets.iter().flatten().any(parts) {
            branch = if branch == SLIDING { SLIDING_OPEN } else { UpdateBranch::OPEN };
        }
        let elastic = [found.traction[0] / self.stiffness[0], found.traction[1] / self.stiffness[1]];
        let stored = 0.5 * dot(found.traction, elastic);
        Ok(TractionPoint {
            traction: found.traction,
            tangent: self.tangent(&found.facets),
            branch,
            stored,
            dissipated: dissipated.max(0.0),
            supplied: 0.0,
        })
    }
}
