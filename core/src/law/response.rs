//! Tractions from gaps: what a law with state says at a point of a joint.

use super::branch::UpdateBranch;
use super::update::{BatchFailure, UpdateFailure};
use std::fmt::Debug;

/// What an update gives for one point of a joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TractionPoint {
    /// (t_n, t_t) on the plus side \[Pa\], t_n ≥ 0 in compression.
    pub traction: [f64; 2],
    /// ∂t/∂g of the update itself \[Pa/m\], row by row.
    pub tangent: [[f64; 2]; 2],
    /// What happened.
    pub branch: UpdateBranch,
    /// Energy stored at the end of the step \[J/m²\].
    pub stored: f64,
    /// Energy dissipated in the step \[J/m²\].
    pub dissipated: f64,
}

impl TractionPoint {
    /// No traction and no stiffness: something to be overwritten.
    pub const ZERO: TractionPoint = TractionPoint {
        traction: [0.0; 2],
        tangent: [[0.0; 2]; 2],
        branch: UpdateBranch::ELASTIC,
        stored: 0.0,
        dissipated: 0.0,
    };
}

/// Traction from gap: a pure function of the gap g = (g_n, g_t) \[m\] (g_n > 0 open) and the state at
/// the start of the step. −t·ġ is the power the joint takes up per area. Nothing is allocated; call
/// [`respond`](InterfaceResponse::respond) once per group of points.
pub trait InterfaceResponse: Debug + Send + Sync {
    /// Numbers in the state of a point.
    fn state_size(&self) -> usize;

    /// Writes the state of the untouched joint into a slice of [`state_size`](Self::state_size).
    fn initial_state(&self, state: &mut [f64]);

    /// What each number of the state is, with its unit, such as `"damage [-]"`.
    fn state_names(&self) -> &'static [&'static str];

    /// Tensile strength f_t \[Pa\] and the energy G_I that full opening dissipates \[J/m²\], where the law
    /// softens in tension: what the spacing of contact points is compared with.
    fn tensile_softening(&self) -> Option<[f64; 2]> {
        None
    }

    /// The update of one point. `old` and `new` are as long as the state. With `#[inline]` on a law's own,
    /// [`respond`](Self::respond) takes it into its loop, and the call from the registry is one a batch.
    fn respond_point(&self, gap: [f64; 2], old: &[f64], new: &mut [f64]) -> Result<TractionPoint, UpdateFailure>;

    /// Updates a group of points; one gap and result each, states one after the other.
    fn respond(
        &self,
        gaps: &[[f64; 2]],
        old: &[f64],
        new: &mut [f64],
        points: &mut [TractionPoint],
    ) -> Result<(), BatchFailure> {
        let (size, count) = (self.state_size(), gaps.len());
        if points.len() != count || old.len() != count * size || new.len() != count * size {
            return Err(BatchFailure { point: 0, failure: UpdateFailure::WrongSize });
        }
        for (index, (gap, point)) in gaps.iter().zip(points).enumerate() {
            let place = index * size..(index + 1) * size;
            match self.respond_point(*gap, &old[place.clone()], &mut new[place]) {
                Ok(found) => *point = found,
                Err(failure) => return Err(BatchFailure { point: index, failure }),
            }
        }
        Ok(())
    }
}
