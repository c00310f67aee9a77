//! A piece: its modes, its tangent and its monitors.

use super::monitors::{Monitors, Reading};
use crate::path::newton::model::control::Control;
use crate::path::newton::model::state::{State, Tangent};
use crate::path::newton::model::system::StepSystem;
use crate::path::newton::quantities::control_row::scaled_row;
use crate::path::newton::solve::nearby::Accuracy;
use crate::path::newton::solve::tangent::tangent_at;
use std::rc::Rc;

/// A piece at one of its states.
#[derive(Clone)]
pub(super) struct Piece {
    /// Rate with motions and factor of size 1.
    pub tangent: Tangent,
    /// Its motions and factor over the scaled unknowns.
    pub row: Rc<Vec<f64>>,
    pub monitors: Rc<Monitors>,
}

impl Piece {
    /// Creates the piece of a rate at a state with its modes.
    pub fn new(system: &StepSystem, state: &State, tangent: &Tangent) -> Option<Piece> {
        Piece::along(system, tangent, Rc::new(Monitors::of(system, state)))
    }

    /// Returns the same piece with another tangent.
    pub fn turned(&self, system: &StepSystem, tangent: &Tangent) -> Option<Piece> {
        Piece::along(system, tangent, self.monitors.clone())
    }

    fn along(system: &StepSystem, tangent: &Tangent, monitors: Rc<Monitors>) -> Option<Piece> {
        let mut row = scaled_row(system, tangent);
        let size = row.iter().map(|x| x * x).sum::<f64>().sqrt();
        if !(size.is_finite() && size > 0.0) {
            return None;
        }
        row.iter_mut().for_each(|x| *x /= size);
        Some(Piece { tangent: tangent.scaled(1.0 / size), row: Rc::new(row), monitors })
    }

    /// Returns the control of a step of a length along the tangent.
    pub fn control(&self, length: f64) -> Control {
        Control::Along { row: self.row.clone(), length }
    }

    /// Returns the rate of another state of the piece per unit of the step's length.
    pub fn rate_at(&self, system: &mut StepSystem, state: &State) -> Option<Tangent> {
        tangent_at(system, state, &self.control(0.0), Accuracy::Fine)
    }

    /// Returns the readings of the monitors at a state along a rate, in a step from `start`.
    pub fn read(&self, system: &StepSystem, start: &State, state: &State, rate: &Tangent) -> Vec<Reading> {
        self.monitors.read(system, start, state, rate)
    }
}
