//! The plug-in boundary: dry friction as a plug-in, and the same formula written out at the place of the call.

use serde::{Deserialize, Serialize};
use serde_json::json;
use std::sync::Arc;
use voussoir::core::law::{
    Effect, InterfaceLaw, InterfaceResponse, PointContext, TractionPoint, UpdateBranch, UpdateFailure,
};

/// Stiffness \[k_n, k_t\] \[Pa/m\].
pub const STIFFNESS: [f64; 2] = [1e10, 5e9];
/// Coefficient of friction μ.
pub const FRICTION: f64 = 0.6;

/// 64 gaps \[m\]: half of the points stick, a quarter slides, a quarter is open.
pub fn gaps() -> Vec<[f64; 2]> {
    (0..64)
        .map(|i| match i % 4 {
            0 | 2 => [-1e-5, 1e-6 * f64::from(i)],
            1 => [-1e-5, 1e-4 + 1e-6 * f64::from(i)],
            _ => [1e-5, 1e-5],
        })
        .collect()
}

/// Creates a law with this tag and friction from the table of a study.
pub fn through_the_registry(tag: &str) -> Arc<dyn InterfaceResponse> {
    let table = json!({
        "law": tag, "friction": FRICTION, "normal_stiffness": STIFFNESS[0], "shear_stiffness": STIFFNESS[1],
    });
    let law: Box<dyn InterfaceLaw> = serde_json::from_value(table).expect("a registered law");
    law.response().expect("tractions from gaps")
}

/// Dry friction at a point, written out at the place of the call, to measure the cost of the plug-in boundary. It has
/// the same operations in the same order as the law; it gives tractions, tangent, energies and state.
#[inline(always)]
pub fn inlined(
    [k_n, k_t]: [f64; 2],
    friction: f64,
    gap: [f64; 2],
    old: f64,
) -> Result<(TractionPoint, f64), UpdateFailure> {
    if !gap.iter().chain([&old]).all(|x| x.is_finite()) {
        return Err(UpdateFailure::NotFinite);
    }
    let trial = [-k_n * gap[0], -k_t * (gap[1] - old)];
    if trial[0] < 0.0 {
        return Ok((TractionPoint::ZERO, gap[1]));
    }
    let limit = friction * trial[0];
    let stored = |t: [f64; 2]| 0.5 * (t[0] * t[0] / k_n + t[1] * t[1] / k_t);
    if trial[1].abs() <= limit {
        let tangent = [[-k_n, 0.0], [0.0, -k_t]];
        let branch = UpdateBranch::ELASTIC;
        return Ok((
            TractionPoint { traction: trial, tangent, branch, stored: stored(trial), dissipated: 0.0, supplied: 0.0 },
            old,
        ));
    }
    let sense = trial[1].signum();
    let traction = [trial[0], sense * limit];
    let slip = (trial[1] - traction[1]) / k_t;
    let tangent = [[-k_n, 0.0], [-sense * friction * k_n, 0.0]];
    let branch = UpdateBranch::new("sliding", Effect::Sliding);
    let dissipated = limit * slip.abs();
    Ok((TractionPoint { traction, tangent, branch, stored: stored(traction), dissipated, supplied: 0.0 }, old - slip))
}

/// Computes a batch without a plug-in.
#[inline(always)]
pub fn written_out(
    stiffness: [f64; 2],
    friction: f64,
    gaps: &[[f64; 2]],
    old: &[f64],
    new: &mut [f64],
    points: &mut [TractionPoint],
) -> Result<(), UpdateFailure> {
    for (i, gap) in gaps.iter().enumerate() {
        (points[i], new[i]) = inlined(stiffness, friction, *gap, old[i])?;
    }
    Ok(())
}

/// [`inlined`] as a plug-in, so that both sides of the boundary have the same formula.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BenchFriction {
    /// Coefficient of friction μ.
    pub friction: f64,
    /// Normal stiffness k_n \[Pa/m\].
    pub normal_stiffness: f64,
    /// Shear stiffness k_t \[Pa/m\].
    pub shear_stiffness: f64,
}

#[typetag::serde(name = "bench_friction")]
impl InterfaceLaw for BenchFriction {
    fn response(&self) -> Option<Arc<dyn InterfaceResponse>> {
        Some(Arc::new(self.clone()))
    }

    fn stiffness(&self) -> Option<[f64; 2]> {
        Some([self.normal_stiffness, self.shear_stiffness])
    }
}

impl InterfaceResponse for BenchFriction {
    fn state_size(&self) -> usize {
        1
    }

    fn initial_state(&self, state: &mut [f64]) {
        state.fill(0.0);
    }

    fn state_names(&self) -> &'static [&'static str] {
        &["slip [m]"]
    }

    #[inline]
    fn respond_point(
        &self,
        gap: [f64; 2],
        _: &PointContext,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<TractionPoint, UpdateFailure> {
        let (point, slip) = inlined([self.normal_stiffness, self.shear_stiffness], self.friction, gap, old[0])?;
        new[0] = slip;
        Ok(point)
    }
}
