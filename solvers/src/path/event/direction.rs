//! The direction of the next piece of the path: the rate problem over the active set on one factorisation for many
//! events, or an active set on the whole system.

use super::elastic_chain::by_elastic_chain;
use super::factorisation::FactorisedModes;
use super::point::{Point, active_points};
use super::rates::{Direction, Rates, direction_of, leaving, motion_alone, residual};
use super::schur::SchurComplement;
use super::trace::Trace;
use crate::contact::mode::ContactMode;
use crate::path::system::{Load, System};
use crate::rate::active_set::active_set;
use crate::rate::problem::{Rate, RateOutcome};
use crate::rate::solve::{EXAMINED, solve};

/// Relative residual of a direction above which it is solved anew.
const RESIDUAL: f64 = 1e-12;
/// Relative residual of a direction up to which it is refined, and the most steps of that.
const REFINED: (f64, usize) = (2e-15, 3);
/// The same above which a direction is not believed: the active set gives way to the whole rate
/// problem, and its answer is given up.
const BELIEVED: [f64; 2] = [1e-9, 1e-6];
/// Points with a mode of their own beside the factorised one before factorising anew.
const UPDATES: usize = 40;
/// Points whose responses are found for one rate problem: for more of them it is factorised anew.
const AT_ONCE: usize = 8;
/// Points of the active set above which they are treated on the whole system.
const MANY: usize = 24;
/// Points of the active set up to which its rate problem is solved by itself where flow is not associated: its matrix is
/// dense, and pivoting takes as many steps of its size squared as it has points.
const DENSE: usize = 400;
/// Rounds of the active set on the whole system, and those in which all points change at once.
const ROUNDS: [usize; 2] = [80, 40];

/// Where the path goes on.
pub enum Next {
    /// With λ rising or standing still.
    Go(Direction),
    /// With λ falling: nothing else is possible.
    Falling(Direction),
    /// Nowhere.
    Nothing,
    /// Not with λ rising; whether with λ standing still or falling is not decided.
    NoneRises,
    /// Not decided, and why.
    Lost(String),
}

/// The direction from the present state.
pub fn next_direction(trace: &mut Trace, load: &Load) -> Next {
    trace.log.counts.rate_problems += 1;
    let points = &trace.state.points;
    let active: Vec<usize> = (0..points.len()).filter(|c| points[*c].settled().is_none()).collect();
    // Where there are few combinations and several solutions are possible, all are examined.
    if trace.associated || combinations(trace, &active) > EXAMINED {
        let modes = present_modes(trace);
        if let Some((modes, rates)) = by_elastic_chain(trace, load, &active, modes) {
            trace.log.counts.by_force_method += 1;
            return Next::Go(take(trace, modes, rates, load));
        }
        if let Some(direction) = by_newcomers(trace, load, &active) {
            return Next::Go(direction);
        }
    }
    if (active.len() > MANY || trace.factors.present.is_none())
        && let Some(direction) = on_whole_system(trace, load, &active)
    {
        return Next::Go(direction);
    }
    if active.len() > DENSE && !trace.associated {
        return Next::Lost(format!(
            "the rate problem at λ = {:.9} has {} contact points in its active set, friction is not associated, and the active set on the whole system did not solve it: newton_path may",
            trace.state.factor,
            active.len()
        ));
    }
    // One attempt on the present factorisation, one on a fresh one.
    for fresh in [false, true] {
        // Closed points of the active set make the best conditioned factorisation: close to a collapse
        // one in which they flow is nearly singular.
        let stale = trace.factors.present.as_ref().is_none_or(|factors| {
            // What is claimed here rests on the responses themselves.
            !factors.refine_columns
                || factors.responses() > UPDATES.max(2 * active.len())
                || active.iter().any(|c| factors.modes[*c] != ContactMode::Stick)
        });
        let closed = |p: &Point| p.settled().unwrap_or(ContactMode::Stick);
        if (fresh || stale) && !factorise(trace, trace.state.points.iter().map(closed).collect(), true) {
            return Next::Lost(
                "the system is singular with the contact points of the active set closed: a block is held by nothing"
                    .into(),
            );
        }
        if let Some(next) = by_rate_problem(trace, load, &active) {
            return next;
        }
    }
    Next::Lost("the stiffness of the contact points of the active set could not be found".into())
}

pub(super) fn factorise(trace: &mut Trace, modes: Vec<ContactMode>, refine_columns: bool) -> bool {
    trace.log.counts.factorisations += 1;
    trace.factors.present = FactorisedModes::new(&trace.system, modes, refine_columns);
    trace.factors.present.is_some()
}

fn combinations(trace: &Trace, active: &[usize]) -> usize {
    let points = active_points(&trace.system, &trace.state.points, active);
    points.iter().fold(1, |n: usize, point| n.saturating_mul(point.candidates().len()))
}

/// Modes of all points; those of the active set keep theirs.
fn present_modes(trace: &Trace) -> Vec<ContactMode> {
    trace.state.points.iter().map(|p| p.settled().unwrap_or(p.mode)).collect()
}

/// Factorises anew where the present factorisation does not serve to open some points in these modes.
fn refresh_for(trace: &mut Trace, open: &[usize], modes: &[ContactMode]) -> bool {
    let refine_columns = trace.factors.refine_columns;
    let changed =
        |factors: &FactorisedModes| modes.iter().zip(&factors.modes).filter(|(now, then)| now != then).count();
    let stale = |factors: &FactorisedModes| {
        (!factors.refine_columns && refine_columns)
            || factors.responses() > UPDATES.max(2 * open.len())
            || changed(factors) > 2 * UPDATES
            // After events that others followed: a factorisation costs less than so many responses.
            || changed(factors) > factors.responses() + AT_ONCE
    };
    if !trace.factors.present.as_ref().is_none_or(stale) {
        return true;
    }
    // With open points closed: what flows there may be a mechanism.
    let mut closed = modes.to_vec();
    open.iter().for_each(|c| closed[*c] = ContactMode::Stick);
    if let Some(present) = trace.factors.present.as_mut().filter(|present| present.modes == closed) {
        // Stale for its responses alone.
        present.set_refined(refine_columns);
        return true;
    }
    factorise(trace, closed, refine_columns)
}

/// The active set over the points that have just arrived somewhere and those that this moves out of their modes,
/// while all others go on as they are. `None` where nothing with λ rising is found so.
fn by_newcomers(trace: &mut Trace, load: &Load, active: &[usize]) -> Option<Direction> {
    let mut open: Vec<usize> = active.iter().copied().filter(|c| trace.state.points[*c].hit).collect();
    loop {
        if open.len() > MANY {
            return None;
        }
        let mut modes = present_modes(trace);
        if !refresh_for(trace, &open, &modes) {
            return None;
        }
        let Trace { system, state, factors, log, .. } = &mut *trace;
        let base = factors.present.as_mut()?;
        let refined_columns = base.refine_columns;
        let at = (state.load_step, load);
        let local = SchurComplement::new((system, &state.points), base, at, &open, &modes, &mut log.counts.solves)?;
        let guess: Vec<ContactMode> = open.iter().map(|c| modes[*c]).collect();
        let rate = active_set(&local.rate, guess.clone(), &mut log.counts.rates.trials);
        // A moving support does no work on a mechanism: where it can move on, it does.
        let standing = || if load.settles { None } else { local.rate.at_constant_load(&guess) };
        let rate = rate.or_else(standing)?;
        let mut rates = rates_of(&local, base, at, &rate, (&open, &mut modes))?;
        log.counts.solves += rates.refinements;
        let forces = 2 * system.contacts;
        if rates.factor == 0.0 {
            rates.x[..forces].fill(0.0);
            rates = Rates::new(system, rates.x, 0.0, load);
            rates.worst = residual(system, &rates, load, &modes).0;
        } else if !refined_columns && rates.nears_mechanism(forces) {
            factors.refine_columns = true;
            continue;
        }
        let moved = leaving((system, &state.points), (&rates, load), active, &modes)?;
        if moved.is_empty() {
            let rates = solved_anew(trace, rates, load, &modes);
            let believed = rates.worst <= BELIEVED[0];
            return believed.then(|| take(trace, modes, rates, load));
        }
        let new = moved.into_iter().map(|(_, c, _)| c).filter(|c| !open.contains(c));
        let before = open.len();
        open = open.iter().copied().chain(new).collect();
        if open.len() == before {
            return None;
        }
    }
}

/// Takes rates as the direction, and the modes of all points.
fn take(trace: &mut Trace, modes: Vec<ContactMode>, rates: Rates, load: &Load) -> Direction {
    trace.state.points.iter_mut().zip(modes).for_each(|(point, mode)| point.mode = mode);
    direction_of(&trace.system, &mut trace.state.points, rates, load)
}

/// Refined rates of all unknowns of a solution over the open points, whose modes are put among all.
fn rates_of(
    local: &SchurComplement,
    base: &mut FactorisedModes,
    at: (usize, &Load),
    rate: &Rate,
    (open, modes): (&[usize], &mut [ContactMode]),
) -> Option<Rates> {
    open.iter().zip(&rate.modes).for_each(|(c, mode)| modes[*c] = *mode);
    let x = local.combine(base, at, rate)?;
    Some(refined(local, base, Rates::new(local.system, x, rate.factor, at.1), at.1, modes))
}

/// The rate problem over the active set. `None` where linear algebra fails.
fn by_rate_problem(trace: &mut Trace, load: &Load, active: &[usize]) -> Option<Next> {
    let mut modes = present_modes(trace);
    let Trace { system, state, factors, log, associated, .. } = &mut *trace;
    let base = factors.present.as_mut()?;
    let (at, solves) = ((state.load_step, load), &mut log.counts.solves);
    let mut local = SchurComplement::new((system, &state.points), base, at, active, &modes, solves)?;
    local.rate.from_nothing = state.x.iter().all(|v| *v == 0.0);
    let (rate, falling) = match solve(&local.rate, !*associated, &mut log.counts.rates) {
        RateOutcome::Found(rate, others) => {
            if let Some(others) = others.filter(|n| *n > 0) {
                log.counts.bifurcations += 1;
                if log.counts.bifurcations == 1 {
                    log.notes.push(format!(
                        "at λ = {:.9} the rate problem has at least {} solutions; the one taken keeps the modes of the contact points as far as it can",
                        state.factor,
                        others + 1
                    ));
                }
            }
            (rate, false)
        }
        RateOutcome::Falling(rate) => (rate, true),
        RateOutcome::NoRate => return Some(Next::Nothing),
        RateOutcome::NoneRises => return Some(Next::NoneRises),
        RateOutcome::Undecided(combinations) => {
            return Some(Next::Lost(format!(
                "the rate problem at λ = {:.9} has {} contact points in its active set ({combinations} combinations), and pivoting did not solve it; newton_path or a slightly different mesh or load may pass",
                state.factor,
                active.len()
            )));
        }
    };
    let rates = rates_of(&local, base, at, &rate, (active, &mut modes))?;
    log.counts.solves += rates.refinements;
    let mut rates = solved_anew(trace, rates, load, &modes);
    if rates.factor != 0.0 && rates.worst > BELIEVED[1] {
        let Some(motion) = motion_alone((&trace.system, &trace.state.points), &rates, load, active, &modes) else {
            return Some(Next::Lost(format!(
                "the rates at λ = {:.9} leave {:.1e} of their equations: the system is singular to rounding",
                trace.state.factor, rates.worst
            )));
        };
        rates = motion;
    }
    active.iter().zip(&rate.modes).for_each(|(c, mode)| trace.state.points[*c].mode = *mode);
    let direction = direction_of(&trace.system, &mut trace.state.points, rates, load);
    Some(if falling { Next::Falling(direction) } else { Next::Go(direction) })
}

/// Refined against all equations in the modes that were found: responses of single points are not,
/// and close to a collapse they cancel.
fn refined(
    local: &SchurComplement,
    base: &FactorisedModes,
    mut rates: Rates,
    load: &Load,
    modes: &[ContactMode],
) -> Rates {
    let system: &System = local.system;
    let still = rates.factor == 0.0;
    let (mut worst, mut left) = residual(system, &rates, load, modes);
    for _ in 0..REFINED.1 {
        if worst <= REFINED.0 && !still {
            break;
        }
        let Some(step) = local.refinement(base, modes, still, &left) else { break };
        let x = rates.x.iter().zip(&step).map(|(x, s)| x + s).collect();
        let mut better = Rates::new(system, x, rates.factor, load);
        let now = residual(system, &better, load, modes);
        better.refinements = rates.refinements + 1;
        if !still && now.0 >= worst {
            rates.refinements += 1;
            break;
        }
        let rounding = now.0 > 0.5 * worst;
        (rates, (worst, left)) = (better, now);
        if still || rounding {
            break;
        }
    }
    rates.worst = worst;
    rates
}

/// The direction solved anew with all modes in the factorisation, where refinement leaves residuals.
fn solved_anew(trace: &mut Trace, rates: Rates, load: &Load, modes: &[ContactMode]) -> Rates {
    if rates.factor == 0.0 || rates.worst <= RESIDUAL {
        return rates;
    }
    trace.log.counts.factorisations += 1;
    let system = &trace.system;
    let Some(mut base) = FactorisedModes::new(system, modes.to_vec(), trace.factors.refine_columns) else {
        return rates;
    };
    let Some(direct) = base.load_rate(system, trace.state.load_step, load) else { return rates };
    let x: Vec<f64> = direct.iter().map(|v| v * rates.factor).collect();
    // Where the matrix is singular the sense of its solution is rounding.
    let along: f64 = x.iter().zip(&rates.x).map(|(a, b)| a * b).sum();
    let direct = Rates::new(system, x, rates.factor, load);
    if along > 0.0 && residual(system, &direct, load, modes).0 < rates.worst {
        trace.factors.present = Some(base);
        return direct;
    }
    rates
}

/// The active set on the whole system with λ̇ = 1: for many points at once.
fn on_whole_system(trace: &mut Trace, load: &Load, active: &[usize]) -> Option<Direction> {
    let mut modes = present_modes(trace);
    let mut seen: Vec<Vec<ContactMode>> = Vec::new();
    for round in 0..ROUNDS[0] {
        trace.log.counts.factorisations += 1;
        let system = &trace.system;
        let mut base = FactorisedModes::new(system, modes.clone(), trace.factors.refine_columns)?;
        let x = base.load_rate(system, trace.state.load_step, load)?.clone();
        let rates = Rates::new(system, x, 1.0, load);
        let mut changes = leaving((system, &trace.state.points), (&rates, load), active, &modes)?;
        if changes.is_empty() {
            if residual(system, &rates, load, &modes).0 > BELIEVED[0] {
                return None;
            }
            trace.factors.present = Some(base);
            return Some(take(trace, modes, rates, load));
        }
        if seen.contains(&modes) || round > ROUNDS[1] {
            changes.sort_by_key(|change| change.1);
            changes.truncate(1);
        }
        seen.push(modes.clone());
        for (_, c, to) in changes {
            modes[c] = to;
        }
    }
    None
}
