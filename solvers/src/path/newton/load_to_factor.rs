//! Load steps to a factor: in one step if that is exact, otherwise in several steps.

use super::pieces;
use crate::path::newton::model::control::Control;
use crate::path::newton::model::state::State;
use crate::path::newton::quantities::response::tractions_dissipate;
use crate::path::newton::solve::second_order::second_order_work;
use crate::path::newton::solve::step::solve_step;
use crate::path::newton::tracing::commit::commit;
use crate::path::newton::tracing::step_energy::step_energy;
use crate::path::newton::tracing::tracer::{LoadStepEnding, Tracer};
use voussoir_core::path::LoadStep;

/// Applies the load up to a factor: in one step if nothing irreversible happens in it, otherwise in several steps.
pub(super) fn load_to_factor(tracer: &mut Tracer, load_step: &LoadStep, factor: f64) -> LoadStepEnding {
    // From the unloaded state a load grows in proportion; later a point may slide and stop within any step.
    let from_nothing = tracer.state.force.iter().flatten().all(|r| *r == 0.0);
    if !from_nothing {
        return pieces::driver::follow(tracer, load_step, factor);
    }
    let control = Control::Factor(factor);
    let whole = solve_step(&mut tracer.system, &tracer.state, tracer.state.clone(), &control);
    if let Ok((next, iterations)) = whole {
        let slips = (0..next.gap.len()).any(|c| {
            let gap = tracer.system.step_gap(&tracer.state, &next, c);
            tracer
                .system
                .law(c)
                .is_some_and(|law| !law.opens(next.mode[c]) && law.irreversible(next.mode[c], gap).0 != [0.0; 2])
        });
        let slips = slips || next.yields();
        let far = iterations > tracer.system.limits.newton.one_step;
        let straight = !slips && !far && !tractions_dissipate(&tracer.system, &next);
        if straight && step_energy(tracer, &next).holds && is_stable(tracer, &next) {
            return if commit(tracer, next) { LoadStepEnding::Reached } else { LoadStepEnding::Ended };
        }
    }
    pieces::driver::follow(tracer, load_step, factor)
}

/// Returns true if a state after one step is stable: with finite displacements other equilibria may exist.
fn is_stable(tracer: &mut Tracer, next: &State) -> bool {
    !tracer.system.finite() || second_order_work(&mut tracer.system, next).is_none_or(|work| work.turned == 0)
}
