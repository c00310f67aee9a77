//! Load steps to a factor: in one step where that is exact, else in steps.

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

/// To a factor: in one step where nothing irreversible happens in it, else in steps.
pub(super) fn load_to_factor(tracer: &mut Tracer, load_step: &LoadStep, factor: f64) -> LoadStepEnding {
    // From nothing a load grows in proportion; later a point may slide and come to rest within any step.
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

/// Whether a state that one step reached is stable: with finite displacements others may be in equilibrium as well.
fn is_stable(tracer: &mut Tracer, next: &State) -> bool {
    !tracer.system.finite() || second_order_work(&mut tracer.system, next).is_none_or(|work| work.turned == 0)
}
