//! Tractions from gaps at a point of a joint, for laws with state.

use super::branch::UpdateBranch;
use super::context::PointContext;
use super::update::{BatchFailure, UpdateFailure};
use std::fmt::Debug;

/// Result of an update at one point of a joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TractionPoint {
    /// Traction (t_n, t_t) on the plus side \[Pa\], t_n ≥ 0 in compression.
    pub traction: [f64; 2],
    /// Consistent tangent ∂t/∂g of the update \[Pa/m\], row by row.
    pub tangent: [[f64; 2]; 2],
    /// The branch of the law.
    pub branch: UpdateBranch,
    /// Energy stored per area at the end of the step \[J/m²\].
    pub stored: f64,
    /// Energy dissipated per area in the step \[J/m²\].
    pub dissipated: f64,
    /// Energy supplied per area by changing fields in the step, besides the work −t·ġ of the gap \[J/m²\]: a rising
    /// pressure of water in an open joint raises the energy that is stored there.
    pub supplied: f64,
}

impl TractionPoint {
    /// Zero traction and zero stiffness, as initial value of a buffer.
    pub const ZERO: TractionPoint = TractionPoint {
        traction: [0.0; 2],
        tangent: [[0.0; 2]; 2],
        branch: UpdateBranch::ELASTIC,
        stored: 0.0,
        dissipated: 0.0,
        supplied: 0.0,
    };

    /// Returns true if all its numbers are finite.
    pub fn is_finite(&self) -> bool {
        let own = [self.stored, self.dissipated, self.supplied];
        self.traction.iter().chain(self.tangent.as_flattened()).chain(&own).all(|v| v.is_finite())
    }
}

/// A law that computes the traction from the gap: a pure function of the gap g = (g_n, g_t) \[m\] (g_n > 0 is open) and
/// of the state at the start of the step, and of the [`PointContext`]. Two calls with equal arguments give equal results:
/// a law stores nothing and reads no clock. −t·ġ is the power per area that the joint absorbs. An update allocates no
/// memory. Call [`respond`](InterfaceResponse::respond) once per group of points.
pub trait InterfaceResponse: Debug + Send + Sync {
    /// Returns the number of state variables of a point.
    fn state_size(&self) -> usize;

    /// Writes the initial state of the joint into a slice of length [`state_size`](Self::state_size).
    fn initial_state(&self, state: &mut [f64]);

    /// Returns the name of each state variable with its unit, such as `"damage [-]"`.
    fn state_names(&self) -> &'static [&'static str];

    /// Returns the tensile strength f_t \[Pa\] and the fracture energy G_I \[J/m²\] that full opening dissipates, if
    /// the law softens in tension. The spacing of contact points is checked against them.
    fn tensile_softening(&self) -> Option<[f64; 2]> {
        None
    }

    /// Updates one point. `old` and `new` have the length of the state. Mark an implementation `#[inline]`:
    /// [`respond`](Self::respond) then inlines it into its loop, and there is one dynamic call per group of points.
    fn respond_point(
        &self,
        gap: [f64; 2],
        context: &PointContext,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<TractionPoint, UpdateFailure>;

    /// Writes the outputs of points that the card of the law declares, in their order. They belong to the end of a step: its
    /// gap, its context, the state and the result of the update there. A pure function, like the update.
    fn outputs(&self, gap: [f64; 2], context: &PointContext, state: &[f64], point: &TractionPoint, values: &mut [f64]) {
        let _ = (gap, context, state, point, values);
    }

    /// Updates a group of points: one gap, one context and one result per point; the states of the points follow one
    /// another.
    fn respond(
        &self,
        gaps: &[[f64; 2]],
        contexts: &[PointContext],
        old: &[f64],
        new: &mut [f64],
        points: &mut [TractionPoint],
    ) -> Result<(), BatchFailure> {
        let (size, count) = (self.state_size(), gaps.len());
        if points.len() != count || contexts.len() != count || old.len() != count * size || new.len() != count * size {
            return Err(BatchFailure { point: 0, failure: UpdateFailure::WrongSize });
        }
        for (index, ((gap, context), point)) in gaps.iter().zip(contexts).zip(points).enumerate() {
            let place = index * size..(index + 1) * size;
            match self.respond_point(*gap, context, &old[place.clone()], &mut new[place]) {
                Ok(found) => *point = found,
                Err(failure) => return Err(BatchFailure { point: index, failure }),
            }
        }
        Ok(())
    }
}
