//! Checks the initial response of a law when its problem is built: at zero gap tractions and their tangent must be
//! finite, and the tangent must be stiff.

use crate::law::{InterfaceLaw, InterfaceResponse, PointContext, TractionPoint};
use crate::model::geometry::Vec2;

/// Determinant of a tangent, relative to the product of its row sums, below which it counts as singular.
const SINGULAR: f64 = 1e-12;

/// Checks a law at a contact point in its initial state. An error names the law with its parameters, the joint, the
/// point, the gap and the reason.
pub(super) fn check_response(
    (name, law): (&str, &dyn InterfaceLaw),
    response: &dyn InterfaceResponse,
    (joint, point): (usize, Vec2),
) -> Result<(), String> {
    let mut state = vec![0.0; response.state_size()];
    response.initial_state(&mut state);
    let mut after = state.clone();
    let said = response
        .respond_point([0.0; 2], &PointContext::default(), &state, &mut after)
        .map_err(|failed| failed.to_string());
    let Err(why) = said.and_then(|said| untouched(&said, &after)) else { return Ok(()) };
    let [x, y]: [f64; 2] = point.into();
    Err(format!(
        "joint law \"{name}\" ({} with {law:?}) cannot be followed: joint {joint}, point ({x}, {y}), untouched, gap [0, 0]: {why}",
        law.typetag_name()
    ))
}

/// Returns an error if the response in the initial state is not finite or not stiff.
fn untouched(said: &TractionPoint, after: &[f64]) -> Result<(), String> {
    let TractionPoint { traction, tangent, stored, dissipated, .. } = said;
    let finite = traction.iter().chain(tangent.as_flattened()).chain([stored, dissipated]).chain(after);
    if !finite.into_iter().all(|v| v.is_finite()) {
        return Err(format!("traction {traction:?}, tangent {tangent:?} or state {after:?} is not finite"));
    }
    let [normal, shear] = tangent;
    let size = (normal[0].abs() + normal[1].abs()) * (shear[0].abs() + shear[1].abs());
    let determinant = normal[0] * shear[1] - normal[1] * shear[0];
    if normal[0] < 0.0 && shear[1] < 0.0 && determinant > SINGULAR * size {
        return Ok(());
    }
    Err(format!("its tangent ∂t/∂g = {tangent:?} is not stiff: a gap must meet a traction that grows against it"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(tangent: [[f64; 2]; 2]) -> TractionPoint {
        TractionPoint { tangent, ..TractionPoint::ZERO }
    }

    #[test]
    fn a_tangent_of_zero_or_nan_or_of_the_wrong_sign_is_refused() {
        assert!(untouched(&said([[-2.0, 0.5], [0.1, -1.0]]), &[0.0]).is_ok());
        for wrong in
            [[[0.0; 2]; 2], [[f64::NAN, 0.0], [0.0, -1.0]], [[1.0, 0.0], [0.0, -1.0]], [[-1.0, -1.0], [-1.0, -1.0]]]
        {
            assert!(untouched(&said(wrong), &[]).is_err(), "{wrong:?}");
        }
        assert!(untouched(&said([[-1.0, 0.0], [0.0, -1.0]]), &[f64::INFINITY]).is_err());
    }
}
