//! Which branch a path takes where its state becomes unstable under fixed loads and settlements: the one to which damped
//! descent leads, of two the one whose energy falls more. Twins, whose energies are the same, are told apart by what
//! geometry says and numbers do not: the later loads that do more work on one of them.

use super::events::events;
use super::relaxation::{Relaxation, relaxations};
use super::state::State;
use super::tracer::{Tracer, commit};
use crate::path::energy::load_displacement;
use crate::path::stability::SecondOrderWork;
use voussoir_core::path::{Branching, Loading};

/// Difference of two falls of energy, relative to them, with which branches are twins.
const TWINS: f64 = 1e-3;
/// Difference of displacements, relative to them, that is none.
const SAME: f64 = 1e-6;

/// How a path goes on from an unstable state.
pub(super) enum Departure {
    /// From a stable one.
    Stable,
    /// There is none.
    Falls,
    /// The observer has ended it.
    Stopped,
}

/// Leaves an unstable state, or the last one before a limit point that it `snaps` from, for the stable one that damped
/// descent from it reaches.
pub(super) fn leave_unstable(tracer: &mut Tracer, state: &State, work: &SecondOrderWork, snaps: bool) -> Departure {
    let found = relaxations(&mut tracer.system, state, work);
    let Some((chosen, twins)) = choose(tracer, found) else { return Departure::Falls };
    let Relaxation { before, next, released, dissipated } = chosen;
    tracer.record.branchings.push(Branching {
        load_step: tracer.load_step,
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
    tracer.record.events.extend(events(&tracer.system, tracer.load_step, &tracer.state, &before));
    tracer.record.energy.dissipated += released + dissipated;
    tracer.state = before;
    if commit(tracer, next) { Departure::Stable } else { Departure::Stopped }
}

/// The descent on which the energy falls most, and whether the other is its twin.
fn choose(tracer: &Tracer, mut found: Vec<Relaxation>) -> Option<(Relaxation, bool)> {
    let other = found.pop()?;
    let Some(one) = found.pop() else { return Some((other, false)) };
    let (a, b) = (one.fall(), other.fall());
    if (a - b).abs() > TWINS * a.abs().max(b.abs()) {
        return Some((if a > b { one } else { other }, false));
    }
    let size = |r: &Relaxation| r.next.motion.iter().flatten().fold(0.0, |a: f64, q| a.max(q.abs()));
    let pairs = one.next.motion.iter().flatten().zip(other.next.motion.iter().flatten());
    let apart = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    if apart <= SAME * size(&one).max(size(&other)) {
        return Some((one, false));
    }
    let problem = tracer.system.problem;
    let works = |loading: &Loading, r: &Relaxation| {
        let rigid = |body, point| tracer.system.geometry.rigid(body, point, &r.next.motion);
        load_displacement(problem, loading, &r.next.motion, rigid)
    };
    for later in &problem.load_steps[tracer.load_step..] {
        let [a, b] = [works(&later.loading, &one), works(&later.loading, &other)];
        if (a - b).abs() > 1e-3 * apart {
            return Some((if a > b { one } else { other }, true));
        }
    }
    let right = |r: &Relaxation| -> f64 { problem.bodies.iter().zip(&r.next.motion).map(|(b, q)| b.mass * q[0]).sum() };
    Some((if right(&one) >= right(&other) { one } else { other }, true))
}
