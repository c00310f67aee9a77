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

use super::second_order::second_order_work;
use super::state::State;
use super::system::StepSystem;
use crate::path::stability::SecondOrderWork;

/// The sense of the factor at a state and its second-order work.
#[derive(Debug, Clone)]
pub(super) struct Orientation {
    pub work: SecondOrderWork,
    pub rises: bool,
}

impl Orientation {
    /// Of a state at which the factor goes on in its sense, or not. `None` where its second-order work is not known.
    pub fn of(system: &mut StepSystem, state: &State, rises: bool) -> Option<Self> {
        system.finite().then(|| second_order_work(system, state)).flatten().map(|work| Orientation { work, rises })
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

    /// Whether the loads of a state on a rising branch are carried by an unstable equilibrium.
    pub fn is_unstable(&self) -> bool {
        self.rises && self.work.turned > 0
    }
}
