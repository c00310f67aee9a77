//! What fill beside a ring can press with: the trait that laws of its resistance implement.

use std::fmt::Debug;

/// Fill at a point beside a ring.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FillState {
    /// Vertical stress of the dead fill above the point, ≥ 0 in compression \[Pa\].
    pub vertical_stress: f64,
    /// Angle of internal friction \[rad\].
    pub friction_angle: f64,
    /// Cohesion \[Pa\].
    pub cohesion: f64,
}

/// How fill resists the ring, chosen by `resistance = { law = … }`. A law is parameters and pure functions; flow is
/// associated: the greatest pressure flows with motion into the fill only, the least with motion away from it.
#[typetag::serde(tag = "law")]
pub trait FillResistance: Debug + Send + Sync {
    /// Least and greatest horizontal pressure on the ring \[Pa\], 0 ≤ least ≤ greatest.
    fn pressures(&self, state: &FillState) -> [f64; 2];

    /// Pressure by displacement into the fill before it yields \[Pa/m\]; `None` where the fill is rigid up to there.
    fn stiffness(&self) -> Option<f64> {
        None
    }
}
