//! Tests of newton_path on hand-made systems of few unknowns.

mod derivatives;
mod one_block;
mod snap_through;
mod two_degrees;
mod yielding;

use nalgebra::DMatrix;
use std::sync::Arc;
use voussoir_core::model::geometry::Vec2;
use voussoir_core::path::{Continuation, PathBody, PathObserver, PathProblem, PathSettings, PathState};

fn settings(continuation: Option<Arc<dyn Continuation>>) -> PathSettings {
    PathSettings {
        finite: false,
        tolerance: 1e-9,
        stop_displacement: None,
        stop_factor: None,
        continuation,
        stages: Vec::new(),
    }
}

fn body(pole: Vec2, points: Vec<Vec2>, flexibility: Option<DMatrix<f64>>, held: bool) -> PathBody {
    PathBody {
        members: vec![0],
        pole,
        held,
        mass: 2.0,
        points,
        flexibility: flexibility.map(Arc::new),
        inelastic: None,
    }
}

/// Keeps all states.
struct Kept(Vec<PathState>);

impl PathObserver for Kept {
    fn state(&mut self, _problem: &PathProblem, state: &PathState) -> bool {
        self.0.push(state.clone());
        true
    }
}
