//! Contact points with laws of tractions from gaps: r = A t(g, history).
//!
//! Each point has two rows. With K = −A ∂t/∂g of the update itself and a separate scale for each row,
//!
//! ```text
//! σ (r − A t(g)) = 0,    σ (dr + K dg) = −σ (r − A t(g)),    σ = 1 / (F + U max|K|)
//! ```
//!
//! If the joint is stiff compared with the rest, this is g − c r = 0; if it has lost its stiffness, it is r = A t. Both
//! are conditioned like the other rows. The history is that of the last converged state until the step is accepted.

use voussoir_core::law::{TractionPoint, UpdateBranch};
use voussoir_core::path::{LawStep, Responses};

/// Returns a point with the name of its branch: if its law names no branches, a point without normal traction is open.
/// Next to the corner a tangent by differences mixes both sides.
fn named(point: TractionPoint, gap: [f64; 2]) -> TractionPoint {
    match point.branch == UpdateBranch::ELASTIC && point.traction[0] == 0.0 && gap[0] > 0.0 {
        true => TractionPoint { branch: UpdateBranch::OPEN, tangent: [[0.0; 2], point.tangent[1]], ..point },
        false => point,
    }
}

/// Responses of the laws at a state.
#[derive(Debug, Clone, Default)]
pub struct TractionUpdates {
    /// Response of each contact point; empty without such laws.
    pub points: Vec<TractionPoint>,
    /// States of the laws after the step, in the order of the contact points.
    pub memory: Vec<f64>,
    /// States of the laws before the step.
    pub before: Vec<f64>,
    /// Gaps before the step, if it has a duration.
    pub previous_gap: Vec<[f64; 2]>,
    /// Duration of the step \[s\].
    pub time_step: f64,
}

/// Returns the responses of contact points at gaps in a step, from the states of all points before. `None` where a contact point has
/// no such law or its law fails.
pub fn at(
    responses: &Responses,
    asked: &[(usize, [f64; 2])],
    before: &[f64],
    step: &LawStep,
) -> Vec<Option<TractionPoint>> {
    let points = responses.at(asked, before, step);
    points.into_iter().zip(asked).map(|(point, (_, gap))| Some(named(point?, *gap))).collect()
}

/// Updates all points in a step. An error gives the reason of the failure.
pub fn update(
    responses: &Responses,
    gaps: &[[f64; 2]],
    before: &[f64],
    step: &LawStep,
) -> Result<TractionUpdates, String> {
    if responses.is_empty() {
        return Ok(TractionUpdates::default());
    }
    let (mut points, memory) = responses.update(gaps, before, step)?;
    responses.points().for_each(|c| points[c] = named(points[c], gaps[c]));
    let previous_gap = if step.time_step > 0.0 { step.previous_gap.to_vec() } else { Vec::new() };
    Ok(TractionUpdates { points, memory, before: before.to_vec(), previous_gap, time_step: step.time_step })
}
