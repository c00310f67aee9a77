//! The pressure of fill on a ring: the trait that laws of fill resistance implement.

use crate::plugin::{KeyValue, PluginKind, Shape};
use std::fmt::Debug;

/// State of the fill at a point beside a ring.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FillState {
    /// Vertical stress from the dead weight of the fill above the point, ≥ 0 in compression \[Pa\].
    pub vertical_stress: f64,
    /// Angle of internal friction \[rad\].
    pub friction_angle: f64,
    /// Cohesion \[Pa\].
    pub cohesion: f64,
}

/// A law for the horizontal pressure of fill on the ring, chosen by `resistance = { law = … }`. A law consists of
/// parameters and pure functions. Flow is associated: the greatest pressure acts only if the ring moves into the fill,
/// the least pressure only if it moves away.
#[typetag::serde(tag = "law")]
pub trait FillResistance: Debug + Send + Sync {
    /// Returns the least and greatest horizontal pressure on the ring \[Pa\], 0 ≤ least ≤ greatest.
    fn pressures(&self, state: &FillState) -> [f64; 2];

    /// Returns the pressure per displacement into the fill before it yields \[Pa/m\]. `None` if the fill is rigid until
    /// it yields.
    fn stiffness(&self) -> Option<f64> {
        None
    }
}

impl KeyValue for Box<dyn FillResistance> {
    const SHAPE: Shape = Shape::Plugin(PluginKind::FillResistance);
}
