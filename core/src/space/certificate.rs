//! Certificate.
use super::*;
use crate::certificate::{Certificate, Verdict};
use crate::limit::{Greatest, Status};
/// Claim.
#[derive(Debug, Clone, Copy)]
pub struct SpaceClaim<'a> {
    /// hint
    pub hint: Status,
    /// target
    pub target: f64,
    /// start
    pub start: f64,
    /// factor
    pub factor: Option<f64>,
    /// field factor
    pub field_factor: f64,
    /// field
    pub field: Option<&'a SpaceField>,
    /// motion
    pub motion: Option<&'a [SpaceVelocity]>,
    /// ray
    pub ray: Option<&'a SpaceField>,
}
/// Stub.
pub fn certify_space(_: &SpaceProblem, _: &SpaceClaim, _: f64) -> Verdict {
    Verdict {
        certificate: Certificate { passed: false, residuals: Default::default(), failures: vec![] },
        status: Status::Stalled,
        bounds: [None; 2],
        greatest: Greatest::Open,
        start_is_carried: false,
    }
}
