//! A law at a point, in one form for joints and materials, so that each check is written once.

use super::options::CountAllocations;
use std::sync::Arc;
use voussoir_core::law::{
    InterfaceResponse, PointContext, StressPoint, StressUpdate, TractionPoint, UpdateBranch, UpdateContext,
    UpdateFailure,
};

/// The result of an update, with as many components as the law has.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Said {
    /// Tractions or stresses.
    pub force: [f64; 6],
    pub tangent: [[f64; 6]; 6],
    pub branch: UpdateBranch,
    pub stored: f64,
    pub dissipated: f64,
}

/// A law at a point: a joint from gaps to tractions, or a material from strains to stresses.
#[derive(Debug, Clone)]
pub(super) enum Point {
    Joint(Arc<dyn InterfaceResponse>),
    /// With its characteristic length \[m\].
    Material(Arc<dyn StressUpdate>, f64),
}

impl Point {
    /// Returns a material with a characteristic length that it supports.
    pub(super) fn material(law: Arc<dyn StressUpdate>) -> Self {
        let length = if law.largest_length().is_finite() { 0.3 * law.largest_length() } else { 1.0 };
        Point::Material(law, length)
    }

    pub(super) fn components(&self) -> usize {
        match self {
            Point::Joint(_) => 2,
            Point::Material(..) => 6,
        }
    }

    /// Returns the sign of the work that the point absorbs: σ·dε, but −t·dg, because compressive tractions and opening gaps are
    /// positive.
    pub(super) fn sign(&self) -> f64 {
        match self {
            Point::Joint(_) => -1.0,
            Point::Material(..) => 1.0,
        }
    }

    pub(super) fn state_size(&self) -> usize {
        match self {
            Point::Joint(law) => law.state_size(),
            Point::Material(law, _) => law.state_size(),
        }
    }

    pub(super) fn state_names(&self) -> &'static [&'static str] {
        match self {
            Point::Joint(law) => law.state_names(),
            Point::Material(law, _) => law.state_names(),
        }
    }

    /// Returns the state of the untouched point; numbers that the law does not write are NaN.
    pub(super) fn untouched(&self) -> Vec<f64> {
        let mut state = vec![f64::NAN; self.state_size()];
        match self {
            Point::Joint(law) => law.initial_state(&mut state),
            Point::Material(law, _) => law.initial_state(&mut state),
        }
        state
    }

    pub(super) fn update(&self, at: &[f64; 6], old: &[f64], new: &mut [f64]) -> Result<Said, UpdateFailure> {
        match self {
            Point::Joint(_) => self.update_in(&PointContext::default(), at, old, new),
            Point::Material(law, length) => {
                Ok(material(&law.update_point(at, &UpdateContext::of_length(*length), old, new)?))
            }
        }
    }

    /// Updates a joint in a step with this context; a material has no such context.
    pub(super) fn update_in(
        &self,
        context: &PointContext,
        at: &[f64; 6],
        old: &[f64],
        new: &mut [f64],
    ) -> Result<Said, UpdateFailure> {
        match self {
            Point::Joint(law) => Ok(joint(&law.respond_point([at[0], at[1]], context, old, new)?)),
            Point::Material(..) => self.update(at, old, new),
        }
    }

    /// Returns the same updates through the law's own loop over points.
    pub(super) fn batch(&self, at: &[[f64; 6]], old: &[f64], new: &mut [f64]) -> Result<Vec<Said>, UpdateFailure> {
        match self {
            Point::Joint(law) => {
                let gaps: Vec<[f64; 2]> = at.iter().map(|at| [at[0], at[1]]).collect();
                let mut points = vec![TractionPoint::ZERO; at.len()];
                law.respond(&gaps, &vec![PointContext::default(); at.len()], old, new, &mut points)
                    .map_err(|failed| failed.failure)?;
                Ok(points.iter().map(joint).collect())
            }
            Point::Material(law, length) => {
                let contexts = vec![UpdateContext::of_length(*length); at.len()];
                let mut points = vec![StressPoint::ZERO; at.len()];
                law.update(at, &contexts, old, new, &mut points).map_err(|failed| failed.failure)?;
                Ok(points.iter().map(material).collect())
            }
        }
    }

    /// Returns the number of allocations of the law's own loop over points, for a single point; 0 if the update fails.
    pub(super) fn allocations_in_batch(&self, at: &[f64; 6], old: &[f64], count: CountAllocations) -> u64 {
        let (mut new, mut done) = (vec![0.0; old.len()], false);
        let counted = match self {
            Point::Joint(law) => {
                let (gaps, contexts) = ([[at[0], at[1]]], [PointContext::default()]);
                let mut points = [TractionPoint::ZERO];
                count(&mut || done = law.respond(&gaps, &contexts, old, &mut new, &mut points).is_ok())
            }
            Point::Material(law, length) => {
                let (contexts, mut points) = ([UpdateContext::of_length(*length)], [StressPoint::ZERO]);
                let strains = [*at];
                count(&mut || done = law.update(&strains, &contexts, old, &mut new, &mut points).is_ok())
            }
        };
        if done { counted } else { 0 }
    }

    /// Returns the greatest entry of the tangent at the untouched point under a small compression: the scale of stiffnesses
    /// and stresses.
    pub(super) fn stiffness(&self, size: f64) -> Option<f64> {
        let (old, mut new) = (self.untouched(), vec![0.0; self.state_size()]);
        let mut at = [0.0; 6];
        at[0] = if matches!(self, Point::Joint(_)) { -1e-3 * size } else { 0.0 };
        let said = self.update(&at, &old, &mut new).ok()?;
        let greatest = said.tangent.iter().flatten().fold(0.0_f64, |a, b| a.max(b.abs()));
        (greatest > 0.0 && greatest.is_finite()).then_some(greatest)
    }
}

fn joint(point: &TractionPoint) -> Said {
    let (mut force, mut tangent) = ([0.0; 6], [[0.0; 6]; 6]);
    force[..2].copy_from_slice(&point.traction);
    for (row, own) in tangent.iter_mut().zip(&point.tangent) {
        row[..2].copy_from_slice(own);
    }
    let TractionPoint { branch, stored, dissipated, .. } = *point;
    Said { force, tangent, branch, stored, dissipated }
}

fn material(point: &StressPoint) -> Said {
    let StressPoint { stress, tangent, branch, stored, dissipated } = *point;
    Said { force: stress, tangent, branch, stored, dissipated }
}
