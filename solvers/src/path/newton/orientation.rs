//! Whether two states lie on one branch of the path: by the sense of the factor and the inertia of the tangent.
//!
//! Along a branch the sign of λ̇ changes exactly where a real eigenvalue of K does with p·z ≠ 0 (a limit point); both
//! are functions of the state alone. So
//!
//! ```text
//! λ̇ grows on both sides    as many negative eigenvalues        λ̇ turns down    one more        up    one fewer
//! ```
//!
//! Anything else is a bifurcation between them (more negative eigenvalues with the same sense), or a step that has
//! turned back or landed on another branch. At a kink, where contact modes change, the same holds of the pieces on both
//! sides: det K × sign λ̇ is the orientation of a piecewise linear path (Eaves & Scarf 1976, Math. Operations
//! Research 1, 1-27).

use super::measure::motion_size;
use super::second_order::{is_unstable_at_rest, second_order_work};
use super::state::{State, Tangent};
use super::system::StepSystem;
use crate::path::stability::SecondOrderWork;

/// Eigenvalue in units, the mean stiffness of a contact, below which its sign means nothing: ten times what
/// regularises the equations.
const SINGULAR: f64 = 1e-8;

/// Rate of the factor relative to that of the motion, in units, at which it stands still.
pub(super) const STILL: f64 = 1e-10;

/// The sense of the factor at a state and its second-order work.
#[derive(Debug, Clone)]
pub(super) struct Orientation {
    pub work: SecondOrderWork,
    pub rises: bool,
    /// Whether the factor stands still: its sense is rounding.
    pub still: bool,
    /// Whether the state is unstable under its loads, on a rising branch: also with the points that slide held.
    pub unstable: bool,
}

impl Orientation {
    /// Of a state at which the factor goes on in its sense, or not. `None` where its second-order work is not known.
    pub fn of(system: &mut StepSystem, state: &State, rises: bool) -> Option<Self> {
        let work = system.rules.oriented.then(|| second_order_work(system, state)).flatten()?;
        let negative = rises && work.turned > 0 && work.nearest > SINGULAR;
        let unstable = negative && system.finite() && is_unstable_at_rest(system, state);
        Some(Orientation { work, rises, still: false, unstable })
    }

    /// Of a state with its tangent, in the sense `direction` of the factor.
    pub fn along(system: &mut StepSystem, state: &State, tangent: &Tangent, direction: f64) -> Option<Self> {
        let still = tangent.factor.abs() <= STILL * system.units().factor * motion_size(system, tangent);
        let found = Orientation::of(system, state, tangent.factor * direction > 0.0);
        found.map(|found| Orientation { still, ..found })
    }

    /// Whether the path leads from this state to another one of the same branch.
    pub fn leads_to(&self, next: &Orientation) -> bool {
        let [from, to] = match (self.rises, next.rises) {
            (true, false) => [self.work.turned + 1, next.work.turned],
            (false, true) => [self.work.turned, next.work.turned + 1],
            _ => [self.work.turned, next.work.turned],
        };
        if self.work.symmetric && next.work.symmetric { from == to } else { from % 2 == to % 2 }
    }

    /// The same over a kink, where contact modes change: det K × sign λ̇ stays.
    pub fn leads_over_kink_to(&self, next: &Orientation) -> bool {
        let falls = |side: &Orientation| side.work.turned + usize::from(!side.rises);
        falls(self) % 2 == falls(next) % 2
    }

    /// Of the same state with its tangent in the other sense.
    pub fn reversed(&self) -> Orientation {
        Orientation { rises: !self.rises, unstable: false, ..self.clone() }
    }

    /// Whether an eigenvalue is rounding of the equations' own size, and its sign too.
    pub fn is_singular(&self) -> bool {
        self.still || self.work.nearest <= SINGULAR
    }
}
