//! The control of a step: a factor, or a length along a row of the unknowns. The monitors of strategies.

use std::rc::Rc;
use voussoir_core::model::geometry::Vec2;

/// The control of a step.
#[derive(Debug, Clone)]
pub enum Control {
    /// λ itself.
    Factor(f64),
    /// Along a row over the scaled unknowns: row · (x − x_start) = length.
    Along { row: Rc<Vec<f64>>, length: f64 },
    /// A quantity of a contact point that is zero: offset + by_force · r + by_gap · g \[units\].
    Zero { contact: usize, offset: f64, by_force: [f64; 2], by_gap: [f64; 2] },
}

/// A monitor of a problem.
#[derive(Debug, Clone, Default)]
pub struct MonitorWeights {
    /// Contact points with the weights of their normal gaps.
    pub gaps: Vec<(usize, f64)>,
    /// A body, a point of it and a direction.
    pub point: Option<(usize, Vec2, Vec2)>,
}
