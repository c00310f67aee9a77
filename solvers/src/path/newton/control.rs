//! What fixes a step: a factor, a continuation strategy, weighted gaps, or a mixed control.

use super::state::State;
use std::rc::Rc;
use std::sync::Arc;
use voussoir_core::model::geometry::Vec2;
use voussoir_core::path::{Continuation, Increment};

/// What fixes a step.
#[derive(Debug, Clone)]
pub(super) enum Control {
    /// λ itself.
    Factor(f64),
    /// c(increment) = length.
    Strategy { strategy: Arc<dyn Continuation>, previous: Option<Increment>, length: f64 },
    /// Along a row over the scaled unknowns: row · (x − x_start) = length.
    Along { row: Rc<Vec<f64>>, length: f64 },
    /// Weighted gaps.
    Gaps { local: LocalControl, length: f64 },
    /// weight × Δλ + the displacement that λ works on = length, in units (small displacements).
    Mixed { weight: f64, length: f64 },
}

/// A monitor of a problem.
#[derive(Debug, Clone, Default)]
pub(super) struct MonitorWeights {
    /// Contact points with the weights of their normal gaps.
    pub gaps: Vec<(usize, f64)>,
    /// A body, a point of it and a direction.
    pub point: Option<(usize, Vec2, Vec2)>,
}

/// Weights of the gaps in a local control: Σ w·(g − g_start) = length.
#[derive(Debug, Clone)]
pub(super) struct LocalControl {
    pub by_gap: Vec<f64>,
}

impl LocalControl {
    /// Gaps of some points along their `direction`, 1 where they have moved by it.
    pub fn along(points: &[usize], direction: &[[f64; 2]]) -> Option<LocalControl> {
        let whole: f64 = points.iter().map(|c| direction[*c][0].powi(2) + direction[*c][1].powi(2)).sum();
        let mut by_gap = vec![0.0; 2 * direction.len()];
        for c in points {
            (0..2).for_each(|k| by_gap[2 * c + k] = direction[*c][k] / whole);
        }
        (whole > 0.0).then_some(LocalControl { by_gap })
    }

    /// How far the weighted gaps have moved.
    pub fn value(&self, start: &State, state: &State) -> f64 {
        let moved = state.gap.iter().flatten().zip(start.gap.iter().flatten());
        moved.zip(&self.by_gap).map(|((g, before), w)| w * (g - before)).sum()
    }

    /// The control that takes them so far.
    pub fn control(&self, length: f64) -> Control {
        Control::Gaps { local: self.clone(), length }
    }
}
