//! The status and the factor in a solver's own answer, before a certificate decides.

use std::sync::{Arc, Mutex};
use voussoir_core::limit::Status;

/// Status and factor of an answer.
type Answered = (Status, Option<f64>);

/// The last status and factor in the answers of a solver.
#[derive(Debug, Clone, Default)]
pub struct LastAnswer(Arc<Mutex<Option<Answered>>>);

impl LastAnswer {
    /// Stores an answer.
    pub(super) fn store(&self, status: Status, factor: Option<f64>) {
        if let Ok(mut last) = self.0.lock() {
            *last = Some((status, factor));
        }
    }

    /// Returns the last answer.
    pub(super) fn get(&self) -> Option<Answered> {
        self.0.lock().ok().and_then(|last| *last)
    }
}
