//! Other branches at a limit point of laws with a history.
//!
//! A rate holds for its loading set, the points that soften or yield along it. With the tangents of this set,
//! second-order work q̇·K q̇ is negative along the falling path. If it is negative in more directions with the load
//! held, the path may bifurcate there: for example, a bed joint that softens evenly may also tilt (de Borst 1987; Hill
//! 1958, J. Mech. Phys. Solids 6).

use crate::path::newton::model::state::Tangent;
use crate::path::newton::quantities::ahead::facing_ahead;
use crate::path::newton::solve::second_order::second_order_work;
use crate::path::newton::tracing::tracer::Tracer;
use voussoir_core::path::Branching;

/// Adds a note and a branching for a limit point at the present state, beyond which the path follows a rate, if the
/// second-order work of its loading set is also negative in other directions.
pub(super) fn note_other_branches(tracer: &mut Tracer, rate: &Tangent) {
    if !tracer.system.limits.remembers {
        return;
    }
    let (here, factor) = (tracer.state.clone(), tracer.state.factor);
    let Some(facing) = facing_ahead(&mut tracer.system, &here, rate) else { return };
    let Some(work) = second_order_work(&mut tracer.system, &facing) else { return };
    let others = work.negative.saturating_sub(1);
    if others == 0 {
        return;
    }
    let load_step = tracer.in_force.load_step;
    tracer.record.branchings.push(Branching { load_step, factor, snaps: false, released: 0.0, twins: false });
    tracer.record.notes.push(format!(
        "at the limit point at factor {factor} the second-order work of the points that soften or yield is negative in {others} other \
         direction(s): the path may bifurcate there, and one branch is followed"
    ));
}
