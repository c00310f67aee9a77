//! The branch of a path whose state becomes unstable under fixed loads and settlements. It is the state that damped
//! descent reaches; of two, the one with the greater decrease of energy. Twins have the same energy: later loads do
//! more work on the chosen one, so that the choice does not depend on numbering.

use super::commit::commit;
use super::relaxation::{Relaxation, relaxations};
use super::tracer::Tracer;
use crate::path::newton::model::state::State;
use crate::path::newton::quantities::events::events;
use crate::path::stability::SecondOrderWork;
use crate::path::twins::favoured;
use crate::settings::SETTINGS;
use voussoir_core::path::Branching;

/// The continuation of a path from an unstable state.
pub enum Departure {
    /// From a stable state.
    Stable,
    /// No stable state is found.
    Falls,
    /// The observer has ended the path.
    Stopped,
}

/// Leaves an unstable state, or the last one before a limit point from which it `snaps`, for the stable state that
/// damped descent from it reaches.
pub fn leave_unstable(tracer: &mut Tracer, state: &State, work: &SecondOrderWork, snaps: bool) -> Departure {
    let found = relaxations(&mut tracer.system, state, work);
    let Some((chosen, twins)) = choose(tracer, found) else { return Departure::Falls };
    let Relaxation { before, next, released, dissipated, .. } = chosen;
    let branching = Branching { load_step: tracer.in_force.load_step, factor: state.factor, snaps, released, twins };
    tracer.record.branchings.push(branching);
    let what = if snaps { "snaps" } else { "becomes unstable, and leaves its branch" };
    tracer.record.notes.push(format!(
        "at factor {} the structure {what}: damped descent sets free {released:.3e} J{}",
        state.factor,
        if twins { "; the mirrored branch has the same energy, and can carry another load" } else { "" }
    ));
    tracer.record.events.extend(events(&tracer.system, tracer.in_force.load_step, &tracer.state, &before));
    tracer.record.energy.dissipated += released + dissipated;
    tracer.state = before;
    if commit(tracer, next) { Departure::Stable } else { Departure::Stopped }
}

/// Returns the descent with the greatest decrease of energy, and true if the other is its twin.
fn choose(tracer: &Tracer, mut found: Vec<Relaxation>) -> Option<(Relaxation, bool)> {
    let other = found.pop()?;
    let Some(one) = found.pop() else { return Some((other, false)) };
    let (a, b) = (one.fall, other.fall);
    let rounding = SETTINGS.admissible * tracer.record.state.stored.abs();
    if (a - b).abs() > SETTINGS.small * a.abs().max(b.abs()) + rounding {
        return Some((if a > b { one } else { other }, false));
    }
    if one.side * other.side > 0.0 {
        return Some((one, false));
    }
    let motions = [&one.next.motion[..], &other.next.motion[..]];
    let chosen = favoured(tracer.system.problem, tracer.in_force.load_step, &motions);
    Some((if chosen == 0 { one } else { other }, true))
}
