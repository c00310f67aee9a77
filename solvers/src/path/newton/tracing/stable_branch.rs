//! Which branch a path takes where its state becomes unstable under fixed loads and settlements: the one to which damped
//! descent leads, of two the one whose energy falls more. Twins, whose energies are the same, are told apart by what
//! geometry says and numbers do not: the later loads that do more work on one of them.

use super::commit::commit;
use super::relaxation::{Relaxation, relaxations};
use super::tracer::Tracer;
use crate::path::energy::EnergyBalance;
use crate::path::newton::model::state::State;
use crate::path::newton::quantities::events::events;
use crate::path::newton::quantities::recorded::{energy_after, recorded, work_state};
use crate::path::stability::SecondOrderWork;
use crate::path::twins::favoured;
use crate::settings::SETTINGS;
use voussoir_core::path::Branching;

/// How a path goes on from an unstable state.
pub enum Departure {
    /// From a stable one.
    Stable,
    /// There is none.
    Falls,
    /// The observer has ended it.
    Stopped,
}

/// Leaves an unstable state, or the last one before a limit point that it `snaps` from, for the stable one that damped
/// descent from it reaches.
pub fn leave_unstable(tracer: &mut Tracer, state: &State, work: &SecondOrderWork, snaps: bool) -> Departure {
    let found = relaxations(&mut tracer.system, state, work);
    let fallen = |relaxation: Relaxation| (fall(tracer, &relaxation), relaxation);
    let found = found.into_iter().map(fallen).collect();
    let Some((fall, chosen, twins)) = choose(tracer, found) else { return Departure::Falls };
    let Relaxation { before, next, dissipated, .. } = chosen;
    let released = (fall - dissipated).max(0.0);
    tracer.record.branchings.push(Branching {
        load_step: tracer.in_force.load_step,
        factor: state.factor,
        snaps,
        released,
        twins,
    });
    let what = if snaps { "snaps" } else { "becomes unstable, and leaves its branch" };
    tracer.record.notes.push(format!(
        "at factor {} the structure {what}: damped descent sets free {released:.6e} J{}",
        state.factor,
        if twins { "; the mirrored branch has the same energy" } else { "" }
    ));
    tracer.record.events.extend(events(&tracer.system, tracer.in_force.load_step, &tracer.state, &before));
    tracer.record.energy.dissipated += released + dissipated;
    tracer.state = before;
    if commit(tracer, next) { Departure::Stable } else { Departure::Stopped }
}

/// Fall of the potential of constant loads in a descent, friction of its last step taken off \[J\].
fn fall(tracer: &Tracer, relaxation: &Relaxation) -> f64 {
    let Relaxation { before, next, .. } = relaxation;
    let system = &tracer.system;
    let [gradient, last] = [next, before].map(|state| system.gradient(state));
    let (end, begun) = (work_state(system, next, &gradient), work_state(system, before, &last));
    let nothing = EnergyBalance::default();
    let work = energy_after(nothing, system, (&tracer.state, &tracer.record.work), (next, &end)).work;
    let friction = energy_after(nothing, system, (before, &begun), (next, &end)).dissipated;
    let stored = recorded(&nothing, system, tracer.in_force.load_step, next, &gradient).stored;
    work - (stored - tracer.record.state.stored) - friction
}

/// The descent on which the energy falls most, and whether the other is its twin.
fn choose(tracer: &Tracer, mut found: Vec<(f64, Relaxation)>) -> Option<(f64, Relaxation, bool)> {
    let (b, other) = found.pop()?;
    let Some((a, one)) = found.pop() else { return Some((b, other, false)) };
    let rounding = SETTINGS.admissible * tracer.record.state.stored.abs();
    if (a - b).abs() > SETTINGS.small * a.abs().max(b.abs()) + rounding {
        return Some(if a > b { (a, one, false) } else { (b, other, false) });
    }
    if one.side * other.side > 0.0 {
        return Some((a, one, false));
    }
    let motions = [&one.next.motion[..], &other.next.motion[..]];
    let chosen = favoured(tracer.system.problem, tracer.in_force.load_step, &motions);
    Some((a, if chosen == 0 { one } else { other }, true))
}
