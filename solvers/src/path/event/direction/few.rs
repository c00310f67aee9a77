//! The rate problem over a few points, with one factorisation for many events.

use super::continued::{Continued, Next};
use crate::contact::mode::ContactMode;
use crate::path::event::piece::factorisation::{FactorisedModes, REFINEMENTS};
use crate::path::event::piece::point::Point;
use crate::path::event::piece::rates::{Rates, direction_of, leaving, motion_alone, residual};
use crate::path::event::piece::schur::SchurComplement;
use crate::path::event::trace::{Log, Trace};
use crate::path::system::{Load, System};
use crate::path::twins::{self, favoured};
use crate::rate::answer::{Budget, Continuation, Neighbour, RateAnswer, answer, only_neighbour};
use crate::rate::neighbours::settled;
use crate::rate::problem::Rate;
use crate::settings::SETTINGS;
use voussoir_core::path::PathProblem;

/// Greatest number of points whose mode differs from the factorised one; with more, the matrix is factorised again.
const UPDATES: usize = 40;
/// Greatest number of points with computed responses in one rate problem; with more, it is factorised again.
const AT_ONCE: usize = 8;
/// Greatest size of the active set that is solved next to the arrival; larger sets are solved for all points at once.
pub const MANY: usize = 24;
/// Greatest size of the active set whose rate problem is solved alone if flow is not associated. Its matrix is dense,
/// and pivoting needs about one pivot per point, each with work of the size squared.
const DENSE: usize = 400;

/// Returns the answer to the rate problem of the whole active set.
pub fn by_active_set(trace: &mut Trace, load: &Load, active: &[usize]) -> Continued {
    if active.len() > DENSE {
        return Next::Lost(format!(
            "at λ = {:.9} {} contact points may change their modes, and no rate was found: neither by an active set on the whole system nor by the path with strength",
            trace.state.factor,
            active.len()
        ))
        .into();
    }
    // First with the present factorisation, then with a new one.
    for fresh in [false, true] {
        // The matrix with closed points of the active set is best conditioned; with flowing points it is nearly
        // singular close to a collapse.
        let stale = trace.factors.present.as_ref().is_none_or(|factors| {
            // The results depend on the responses themselves.
            !factors.refine_columns
                || factors.responses() > UPDATES.max(2 * active.len())
                || active.iter().any(|c| factors.modes[*c] != ContactMode::Stick)
        });
        let closed = |p: &Point| p.settled().unwrap_or(ContactMode::Stick);
        if (fresh || stale) && !trace.factorise(trace.state.points.iter().map(closed).collect(), true) {
            return Next::Lost(
                "the system is singular with the contact points of the active set closed: a block is held by nothing"
                    .into(),
            )
            .into();
        }
        if let Some(next) = by_rate_problem(trace, load, active) {
            return next;
        }
    }
    Next::Lost("the rates of the contact points of the active set could not be computed accurately".into()).into()
}

/// Factorises again if the present factorisation cannot be used with the `open` points free in these modes.
fn refresh_for(trace: &mut Trace, open: &[usize], modes: &[ContactMode]) -> bool {
    let refine_columns = trace.factors.refine_columns;
    let changed =
        |factors: &FactorisedModes| modes.iter().zip(&factors.modes).filter(|(now, then)| now != then).count();
    let stale = |factors: &FactorisedModes| {
        (!factors.refine_columns && refine_columns)
            || factors.responses() > UPDATES.max(2 * open.len())
            || changed(factors) > 2 * UPDATES
            // Other methods solved the last events: a factorisation costs less than this number of responses.
            || changed(factors) > factors.responses() + AT_ONCE
    };
    if !trace.factors.present.as_ref().is_none_or(stale) {
        return true;
    }
    // Open points are closed, because flow at them may be a mechanism.
    let mut closed = modes.to_vec();
    open.iter().for_each(|c| closed[*c] = ContactMode::Stick);
    if let Some(present) = trace.factors.present.as_mut().filter(|present| present.modes == closed) {
        // Only its responses are out of date.
        present.set_refined(refine_columns);
        return true;
    }
    trace.factorise(closed, refine_columns)
}

/// The continuation next to the arrival.
pub enum Neighbourhood {
    /// The only one.
    Next(Next),
    /// The search found no rate.
    NotFound,
    /// Several, or undecided.
    Several,
}

/// Returns the only rate next to the arrival. Its modes may change at the points of the event and at points that it
/// moves out of their modes; all others keep theirs.
pub fn by_neighbours(trace: &mut Trace, load: &Load, active: &[usize]) -> Neighbourhood {
    let mut open: Vec<usize> =
        active.iter().copied().filter(|c| trace.state.points[*c].arrived_from.is_some()).collect();
    loop {
        if open.len() > MANY {
            return Neighbourhood::NotFound;
        }
        match by_newcomers(trace, load, active, &open) {
            Some(Newcomers::Next(next)) => return Neighbourhood::Next(next),
            Some(Newcomers::Move(points)) => open.extend(points),
            Some(Newcomers::Again) => {}
            Some(Newcomers::Several) => return Neighbourhood::Several,
            None => return Neighbourhood::NotFound,
        }
    }
}

/// The rates next to the arrival over some open points.
enum Newcomers {
    Next(Next),
    /// The rates move these points out of their modes.
    Move(Vec<usize>),
    /// A mechanism is near: repeat with refined responses.
    Again,
    Several,
}

/// Returns the only rate over the `open` points while all others keep their modes. `None` if there is not exactly one.
fn by_newcomers(trace: &mut Trace, load: &Load, active: &[usize], open: &[usize]) -> Option<Newcomers> {
    let mut modes = trace.present_modes();
    if !refresh_for(trace, open, &modes) {
        return None;
    }
    let arrival = trace.arrival(open);
    let Trace { system, state, factors, log, associated, .. } = &mut *trace;
    let base = factors.present.as_mut()?;
    let refined_columns = base.refine_columns;
    let at = (state.load_step, load);
    let local = SchurComplement::new((system, &state.points), base, at, open, &modes, &mut log.counts.solves)?;
    let trials = &mut log.counts.rates.trials;
    let rate = if *associated {
        // All rising rates have the same forces, and a mechanism proves that no rate rises. A moving support does no
        // work on a mechanism: if it can continue, it does.
        let (guess, free) = (open.iter().map(|c| modes[*c]).collect(), vec![false; open.len()]);
        settled(&local.rate, guess, &free, 1.0, trials)
            .filter(|rate| rate.factor > 0.0 || !load.settles && local.rate.leads_on(rate))?
    } else {
        match only_neighbour(&local.rate, &arrival, &Budget::default(), trials) {
            Neighbour::Only(rate) => rate,
            Neighbour::None => return None,
            Neighbour::Several => return Some(Newcomers::Several),
        }
    };
    let falls = rate.factor < 0.0;
    let rates = rates_of(&local, base, at, &rate, (open, &mut modes))?;
    log.counts.solves += rates.refinements;
    if rates.factor != 0.0 && !refined_columns && rates.nears_mechanism(2 * system.contacts) {
        factors.refine_columns = true;
        return Some(Newcomers::Again);
    }
    let rates = solved_anew(trace, rates, load, &modes);
    let moved = leaving((&trace.system, &trace.state.points), (&rates, load), active, &modes)?;
    if moved.is_empty() {
        let believed = rates.worst <= trace.believed();
        return believed.then(|| {
            let direction = trace.take(modes, rates, load);
            Newcomers::Next(if falls { Next::Falling(direction) } else { Next::Go(direction) })
        });
    }
    let new: Vec<usize> = moved.into_iter().map(|(_, c, _)| c).filter(|c| !open.contains(c)).collect();
    (!new.is_empty()).then_some(Newcomers::Move(new))
}

/// Returns the refined rates of all unknowns of a solution over the open points and stores their modes.
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

/// Returns the answer to the rate problem over the active set. `None` if linear algebra fails.
fn by_rate_problem(trace: &mut Trace, load: &Load, active: &[usize]) -> Option<Continued> {
    let mut modes = trace.present_modes();
    let arrival = trace.arrival(active);
    let Trace { system, state, factors, log, problem, associated, .. } = &mut *trace;
    let base = factors.present.as_mut()?;
    let (at, solves) = ((state.load_step, load), &mut log.counts.solves);
    let mut local = SchurComplement::new((system, &state.points), base, at, active, &modes, solves)?;
    local.measure(base, at, system.units.of_factor(problem, &problem.load_steps[state.load_step].loading))?;
    let RateAnswer { continuation, none_rises } =
        answer(&local.rate, &arrival, &Budget::default(), &mut log.counts.rates);
    let (rate, twins) = match continuation {
        Continuation::Goes { rate, twins } => (rate, twins),
        Continuation::NoneContinues(_) => return Some(Continued { next: Next::Nothing, none_rises, by_chain: false }),
        Continuation::Open(why) if none_rises.is_some() => {
            return Some(Continued { next: Next::NoneRises(why), none_rises, by_chain: false });
        }
        Continuation::Open(why) => return Some(Next::Lost(lost(state.factor, active.len(), &why)).into()),
    };
    // A mechanism of associated flow is itself the proof.
    let proved = none_rises.is_some() || arrival.factor < 0.0 || (*associated && rate.factor == 0.0);
    if rate.factor <= 0.0 && !proved {
        let why = "a rate that raises the load is not excluded";
        return Some(Next::Lost(lost(state.factor, active.len(), why)).into());
    }
    let rate = favoured_twin(&local, base, (problem, at, state.factor), rate, twins, log)?;
    let rates = rates_of(&local, base, at, &rate, (active, &mut modes))?;
    log.counts.solves += rates.refinements;
    let mut rates = solved_anew(trace, rates, load, &modes);
    // A mechanism ends the path: the error of its equations is the error of the load.
    let accepted = if rates.factor == 0.0 { trace.believed() } else { SETTINGS.distinct() };
    if rates.worst > accepted {
        let motion = motion_alone((&trace.system, &trace.state.points), &rates, load, active, &modes);
        let Some(motion) = motion.filter(|_| rates.factor != 0.0) else {
            let why = format!(
                "the rates at λ = {:.9} leave {:.1e} of their equations: the system is singular to rounding",
                trace.state.factor, rates.worst
            );
            return Some(Next::Lost(why).into());
        };
        rates = motion;
    }
    active.iter().zip(&rate.modes).for_each(|(c, mode)| trace.state.points[*c].mode = *mode);
    let direction = direction_of(&trace.system, &mut trace.state.points, rates, load);
    let next = if rate.factor < 0.0 { Next::Falling(direction) } else { Next::Go(direction) };
    Some(Continued { next, none_rises, by_chain: false })
}

fn lost(factor: f64, points: usize, why: &str) -> String {
    format!(
        "the rate problem at λ = {factor:.9} has {points} contact points in its active set and is not decided: {why}; a slightly different mesh or load may pass"
    )
}

/// Returns a rate, or the twin that later loads favour. Twins are recorded.
fn favoured_twin(
    local: &SchurComplement,
    base: &mut FactorisedModes,
    (problem, at, factor): (&PathProblem, (usize, &Load), f64),
    rate: Rate,
    twins: Vec<Rate>,
    log: &mut Log,
) -> Option<Rate> {
    if twins.is_empty() {
        return Some(rate);
    }
    let mut rates: Vec<Rate> = std::iter::once(rate).chain(twins).collect();
    let (system, load_step) = (local.system, at.0);
    let motion = |rate: &Rate| {
        let x = local.combine(base, at, rate)?;
        Some(system.motions(&x[2 * system.contacts..]))
    };
    let motions: Option<Vec<Vec<[f64; 3]>>> = rates.iter().map(motion).collect();
    let motions = motions?;
    let motions: Vec<&[[f64; 3]]> = motions.iter().map(Vec::as_slice).collect();
    let chosen = favoured(problem, load_step, &motions);
    let (branching, note) = twins::record(load_step, factor, rates.len() - 1);
    log.branchings.push(branching);
    log.notes.push(note);
    Some(rates.swap_remove(chosen))
}

/// Refines rates with all equations in the modes found. Unrefined responses of points cancel close to a collapse.
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
    for _ in 0..REFINEMENTS {
        if worst <= SETTINGS.refined && !still {
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
    if still {
        // In a mechanism the rates of forces are rounding errors.
        rates.x[..2 * system.contacts].fill(0.0);
        rates = Rates { refinements: rates.refinements, ..Rates::new(system, rates.x, 0.0, load) };
        worst = residual(system, &rates, load, modes).0;
    }
    rates.worst = worst;
    rates
}

/// Solves the direction again with all modes in the factorisation, if refinement leaves residuals.
fn solved_anew(trace: &mut Trace, rates: Rates, load: &Load, modes: &[ContactMode]) -> Rates {
    if rates.factor == 0.0 || rates.worst <= SETTINGS.residual() {
        return rates;
    }
    trace.log.counts.factorisations += 1;
    let system = &trace.system;
    let Some(mut base) = FactorisedModes::new(system, modes.to_vec(), trace.factors.refine_columns) else {
        return rates;
    };
    let Some(direct) = base.load_rate(system, trace.state.load_step, load) else { return rates };
    let x: Vec<f64> = direct.iter().map(|v| v * rates.factor).collect();
    // If the matrix is singular, the sign of its solution is rounding.
    let along: f64 = x.iter().zip(&rates.x).map(|(a, b)| a * b).sum();
    let direct = Rates::new(system, x, rates.factor, load);
    if along > 0.0 && residual(system, &direct, load, modes).0 < rates.worst {
        trace.factors.present = Some(base);
        return direct;
    }
    rates
}
