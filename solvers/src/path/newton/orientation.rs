//! Whether an equilibrium is stable under its loads, by its second-order work.

use super::second_order::{is_unstable_at_rest, second_order_work};
use super::state::State;
use super::system::StepSystem;
use crate::path::stability::SecondOrderWork;

/// Eigenvalue in units, the mean stiffness of a contact, below which its sign means nothing: ten times what
/// regularises the equations.
const SINGULAR: f64 = 1e-8;

/// The second-order work of a state.
#[derive(Debug, Clone)]
pub(super) struct Orientation {
    pub work: SecondOrderWork,
    /// True if the state is unstable under its loads, on a rising branch: also with the points that slide held.
    pub unstable: bool,
}

impl Orientation {
    /// Of a state at which the factor goes on in its sense, or not. `None` if its second-order work is not known.
    pub fn of(system: &mut StepSystem, state: &State, rises: bool) -> Option<Self> {
        let work = second_order_work(system, state)?;
        let negative = rises && work.turned > 0 && work.nearest > SINGULAR;
        let unstable = negative && is_unstable_at_rest(system, state);
        Some(Orientation { work, unstable })
    }
}
