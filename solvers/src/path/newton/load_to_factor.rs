//! Load steps to a factor: in one step where that is exact, from nothing by a mixed control, else in equal steps.

use super::control::Control;
use super::flow_rule_homotopy::{by_flow_rule_homotopy, take_associated};
use super::follow::follow;
use super::following::mixed_weight;
use super::homotopy::by_homotopy;
use super::iteration::iterate;
use super::measure::motion_size;
use super::peak::scaled_motion;
use super::pieces;
use super::response::tractions_dissipate;
use super::second_order::second_order_work;
use super::state::{State, Tangent, in_proportion};
use super::step::solve_step;
use super::step_energy::step_energy;
use super::tracer::{LoadStepEnding, Tracer, commit, end_path};
use voussoir_core::limit::Status;
use voussoir_core::path::LoadStep;

/// Longest step as a share of a load history, and the share below which a step is not made shorter for its energy.
const LONGEST: f64 = 1.0 / 16.0;
const SHORTEST_FOR_ENERGY: f64 = 1e-8;

/// Why there is no first state.
const NO_START: &str = "the first load has no state that Newton's method or pivoting found, and no proof that there is none: friction that is not associated may leave no state, or several; try event_path, smaller stages, or limit_least";

/// To a factor: in one step where nothing irreversible happens in it, else in steps.
pub(super) fn load_to_factor(tracer: &mut Tracer, load_step: &LoadStep, factor: f64) -> LoadStepEnding {
    // From nothing a load grows in proportion; later a point may slide and come to rest within any step.
    let from_nothing = tracer.state.force.iter().flatten().all(|r| *r == 0.0);
    if tracer.in_pieces && !from_nothing {
        return pieces::driver::follow(tracer, load_step, factor);
    }
    let control = Control::Factor(factor);
    let whole = solve_step(&mut tracer.system, &tracer.state, tracer.state.clone(), &control);
    let small = !tracer.system.finite();
    if let Ok((next, iterations)) = whole {
        let slips = (0..next.gap.len()).any(|c| {
            let gap = tracer.system.step_gap(&tracer.state, &next, c);
            tracer
                .system
                .law(c)
                .is_some_and(|law| !law.opens(next.mode[c]) && law.irreversible(next.mode[c], gap).0 != [0.0; 2])
        });
        let slips = slips || next.yields();
        let far = !small && iterations > 12;
        let straight = !slips && !far && !tractions_dissipate(&tracer.system, &next);
        let whole = (small && is_proportional(tracer))
            || (straight && step_energy(tracer, &next).holds && (small || is_stable(tracer, &next)));
        if whole {
            return if commit(tracer, next) { LoadStepEnding::Reached } else { LoadStepEnding::Ended };
        }
        if small && tracer.system.monotone() {
            return equal_steps(tracer, load_step, factor);
        }
    }
    if small && is_proportional(tracer) {
        return start_proportional(tracer, load_step, factor);
    }
    if tracer.in_pieces {
        return pieces::driver::follow(tracer, load_step, factor);
    }
    follow(tracer, load_step, factor)
}

/// Whether a state that one step reached is stable: with finite displacements others may be in equilibrium as well.
fn is_stable(tracer: &mut Tracer, next: &State) -> bool {
    second_order_work(&mut tracer.system, next).is_none_or(|work| work.turned == 0)
}

/// The first load step where it is proportional and no state at its factor was found: by a mixed control, which
/// has a solution whatever the load. If λ grows with it, that state in proportion is the one looked
/// for. If λ stays at nothing, the motion is a mechanism. Where flow is not associated that proves
/// something only if λ stays at nothing with associated flow too.
pub(super) fn start_proportional(tracer: &mut Tracer, load_step: &LoadStep, factor: f64) -> LoadStepEnding {
    let direction = if factor < load_step.start { -1.0 } else { 1.0 };
    let control = Control::Mixed { weight: mixed_weight(tracer), length: direction };
    let nothing = 1e-9 * tracer.system.units().factor;
    if !tracer.system.monotone()
        && let Some(next) = by_flow_rule_homotopy(&mut tracer.system, &tracer.state, factor)
    {
        return if commit(tracer, next) { LoadStepEnding::Reached } else { LoadStepEnding::Ended };
    }
    let own = by_homotopy(&mut tracer.system, &tracer.state, &tracer.state.clone(), &control);
    let Ok((state, _)) = own else {
        return end_path(tracer, Status::Stalled, NO_START.into());
    };
    if (state.factor - load_step.start) * direction > nothing {
        let guess = in_proportion(&state, (factor - load_step.start) / (state.factor - load_step.start));
        return match iterate(&mut tracer.system, &tracer.state, guess, &Control::Factor(factor), 8, None) {
            Ok((next, _)) if commit(tracer, next.clone()) => LoadStepEnding::Reached,
            Ok(_) => LoadStepEnding::Ended,
            Err(_) => follow(tracer, load_step, factor),
        };
    }
    if !tracer.system.monotone() {
        let polygons = take_associated(&mut tracer.system);
        let other = by_homotopy(&mut tracer.system, &tracer.state, &tracer.state.clone(), &control);
        tracer.system.laws.polygons = polygons;
        if !other.is_ok_and(|(other, _)| (other.factor - load_step.start) * direction <= nothing) {
            return end_path(tracer, Status::Stalled, NO_START.into());
        }
    }
    let mut rate = Tangent {
        force: vec![[0.0; 2]; state.force.len()],
        motion: state.motion.clone(),
        factor: 0.0,
        gap: state.gap.clone(),
    };
    let size = motion_size(&tracer.system, &rate).max(1e-300);
    rate = rate.scaled(1.0 / size);
    tracer.ending.motion = scaled_motion(tracer, &tracer.state, &rate);
    end_path(tracer, Status::Collapse, String::new())
}

/// Whether the path to any factor is a straight line: nothing has happened yet, and neither gaps nor
/// strengths give a load a size to be compared with.
pub(super) fn is_proportional(tracer: &Tracer) -> bool {
    let problem = tracer.system.problem;
    let untouched = tracer.state.force.iter().flatten().chain(tracer.state.gap.iter().flatten()).all(|v| *v == 0.0);
    let linear = tracer.system.piecewise_linear();
    linear && untouched && problem.shared_facets().0.into_iter().flatten().all(|f| f.bound == 0.0)
}

/// To a factor that is known to be carried, in equal steps of λ (associated flow: what carries a
/// factor carries all between).
pub(super) fn equal_steps(tracer: &mut Tracer, load_step: &LoadStep, factor: f64) -> LoadStepEnding {
    let from = tracer.state.factor;
    let mut last: Option<State> = None;
    let mut at = 0.0;
    let mut share = LONGEST;
    while at < 1.0 {
        let next_at = if at + share > 1.0 - 1e-9 { 1.0 } else { at + share };
        let target = if next_at < 1.0 { from + next_at * (factor - from) } else { factor };
        let mut guess = tracer.state.clone();
        if let Some(last) = &last {
            let ratio = (target - tracer.state.factor) / (tracer.state.factor - last.factor);
            for c in 0..guess.force.len() {
                (0..2).for_each(|k| guess.force[c][k] += ratio * (guess.force[c][k] - last.force[c][k]));
            }
            for b in 0..guess.motion.len() {
                (0..3).for_each(|k| guess.motion[b][k] += ratio * (guess.motion[b][k] - last.motion[b][k]));
            }
        }
        let found = solve_step(&mut tracer.system, &tracer.state, guess, &Control::Factor(target));
        let found = found.ok().map(|(next, _)| (step_energy(tracer, &next), next));
        match found {
            Some((energy, next)) if energy.holds || share < SHORTEST_FOR_ENERGY => {
                last = Some(tracer.state.clone());
                if !commit(tracer, next) {
                    return LoadStepEnding::Ended;
                }
                at = next_at;
                share = (share * energy.growth.clamp(0.5, 2.0)).min(LONGEST);
            }
            Some(_) => {
                tracer.system.count("cutbacks", 1);
                share *= 0.5;
            }
            None => {
                tracer.system.count("cutbacks", 1);
                share *= 0.5;
                if share < 1e-4 {
                    return follow(tracer, load_step, factor);
                }
            }
        }
    }
    LoadStepEnding::Reached
}
