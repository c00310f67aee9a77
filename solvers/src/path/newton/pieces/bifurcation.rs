//! Bifurcations: the equations of the modes become singular while the load grows.
//!
//! At a bifurcation the rate t of the present branch and a motion φ at a held load satisfy the same equations, Kφ = 0. A
//! structure with imperfections does not stay on the present branch beyond it. The other branch starts with φ. If φ
//! moves sliding points against their sense, the other branch starts with t + αφ: α is the share at which the first of
//! these points stops (Shanley 1947, J. Aeronaut. Sci. 14, 261-268; Hill 1958, J. Mech. Phys. Solids 6, 236-249). The
//! path follows the sense of φ that gives the lower load at the same distance. If both loads are equal, the two senses
//! are twins.

use super::advance::{Advance, StepEnd, Watched, advance, between, state_at};
use super::monitors::{MAX_BISECTIONS, Monitor, What};
use super::piece::Piece;
use super::switch::{NextPiece, after_event};
use crate::contact::mode::ContactMode;
use crate::linear::inner;
use crate::path::newton::model::state::{State, Tangent};
use crate::path::newton::quantities::control_row::scaled_row;
use crate::path::newton::solve::second_order::{critical_rate, is_unstable_at_rest, second_order_work};
use crate::path::newton::tracing::tracer::Tracer;
use crate::path::stability::SecondOrderWork;
use crate::path::twins::favoured;
use crate::settings::SETTINGS;

/// The first state of a step that is unstable under its loads.
pub(super) struct Unstable {
    pub first: StepEnd,
    pub work: SecondOrderWork,
    /// True if a shorter step may locate it better. From a state far beyond a bifurcation, damped descent may reach
    /// another branch.
    pub far: bool,
}

/// Locates the first state of a step on a rising branch that is unstable under its loads and above all limit points.
/// A step whose modes become unstable contains a bifurcation; sliding points may still be stable at rest. Modes that
/// were unstable before have no bifurcation in the step, but their stability at rest may end in it.
pub(super) fn first_unstable(
    tracer: &mut Tracer,
    (start, piece): (&State, &Piece),
    end: &StepEnd,
    direction: f64,
) -> Option<Unstable> {
    let own = tracer.limit.proven_peaks.iter().filter(|peak| peak.load_step == tracer.in_force.load_step);
    let greatest = own.map(|peak| peak.factor * direction).fold(f64::NEG_INFINITY, f64::max);
    let above = |state: &State| state.factor * direction > greatest;
    if !above(&end.state) || end.length == 0.0 {
        return None;
    }
    let system = &mut tracer.system;
    let mut work = second_order_work(system, &end.state).filter(|work| work.turned > 0)?;
    let before = second_order_work(system, start)?;
    let size = before.nearest.max(work.nearest);
    let least = SETTINGS.same_rate() * size;
    let neutral = |work: &SecondOrderWork| work.nearest <= least.max(SETTINGS.active);
    let bifurcates = before.turned == 0 && !neutral(&before);
    if neutral(&work) || !(bifurcates || is_unstable_at_rest(system, &end.state)) {
        return None;
    }
    let (mut low, mut high) = (StepEnd::first(start, piece), end.clone());
    // The eigenvalue nearest to zero at the first state of the bracket, unless that state has negative ones.
    let mut stable = (before.turned == 0).then_some(before.nearest);
    let mut at_bifurcation = None;
    // In a very short step a state is not found as near to a requested length as the bracket is narrow.
    for _ in 0..MAX_BISECTIONS {
        let width = high.length - low.length;
        let narrow = bifurcates && work.nearest.max(width / end.length * size) <= SETTINGS.small * size;
        // A solution at the bifurcation itself contains an arbitrary part of the critical motion.
        at_bifurcation = stable.filter(|_| narrow).and_then(|stable| {
            let share = (stable + least) / (stable + work.nearest);
            between(system, (start, piece), [&low, &high], share)
        });
        if at_bifurcation.is_some() || width <= SETTINGS.admissible * end.length {
            break;
        }
        let middle = [0.5, 0.4, 0.6].into_iter().find_map(|share| {
            let middle = state_at(system, (start, piece), &[&low, &high], low.length + share * width)?;
            let work = second_order_work(system, &middle.state);
            // An almost singular state has no exact rate.
            let regular = !bifurcates || work.as_ref().is_some_and(|work| work.nearest > SETTINGS.fine * size);
            regular.then_some((middle, work))
        });
        let Some((middle, found)) = middle else { break };
        let mut is_unstable = |work: &SecondOrderWork| {
            let turned = work.turned > 0 && work.nearest > least;
            turned && above(&middle.state) && (bifurcates || is_unstable_at_rest(system, &middle.state))
        };
        match found {
            Some(here) if is_unstable(&here) => (work, high) = (here, middle),
            found => {
                stable = found.filter(|work| work.turned == 0).map(|work| work.nearest);
                low = middle;
            }
        }
    }
    let located = bifurcates && work.nearest <= SETTINGS.small * size;
    let far = !located && high.length - low.length > SETTINGS.distinct() * end.length;
    let first = at_bifurcation.unwrap_or(high);
    Some(Unstable { first, work, far })
}

/// The other branch at a bifurcation.
pub(super) struct OtherBranch {
    pub piece: Piece,
    pub modes: Vec<ContactMode>,
    /// A state on it, a short step away.
    pub next: StepEnd,
    /// True if the mirrored branch carries the same load.
    pub twins: bool,
}

/// Returns the other branch at the present state, which is a bifurcation of a piece; the first step on it has at most
/// this `length`. `None` if the branch is not found.
pub(super) fn other_branch(
    tracer: &mut Tracer,
    piece: &Piece,
    work: &SecondOrderWork,
    (direction, length): (f64, f64),
) -> Option<OtherBranch> {
    let here = tracer.state.clone();
    let critical = critical_rate(&mut tracer.system, &here, work)?;
    // Its part along the present branch is arbitrary.
    let along = inner(&scaled_row(&tracer.system, &critical), &piece.row);
    let critical = sum(&critical, -along, &piece.tangent);
    let mut found = [1.0, -1.0].into_iter().filter_map(|sense| {
        let (piece, modes) = begin(tracer, &here, piece, &critical.scaled(sense), direction)?;
        let next = first_step(tracer, &State { mode: modes.clone(), ..here.clone() }, &piece, length)?;
        Some(OtherBranch { piece, modes, next, twins: false })
    });
    let one = found.next()?;
    let Some(other) = found.next() else { return Some(one) };
    drop(found);
    let gained = [&one, &other].map(|branch| (branch.next.state.factor - here.factor) * direction / branch.next.length);
    let size = gained[0].abs().max(gained[1].abs()) + SETTINGS.distinct() * tracer.system.units().factor;
    if (gained[0] - gained[1]).abs() > SETTINGS.wanted_error * size {
        return Some(if gained[0] < gained[1] { one } else { other });
    }
    let motions = [&one, &other].map(|branch| &branch.piece.tangent.motion[..]);
    let chosen = favoured(tracer.system.problem, tracer.in_force.load_step, &motions);
    Some(OtherBranch { twins: true, ..if chosen == 0 { one } else { other } })
}

/// Returns a + share · b.
fn sum(a: &Tangent, share: f64, b: &Tangent) -> Tangent {
    let pairs =
        |a: &[[f64; 2]], b: &[[f64; 2]]| a.iter().zip(b).map(|(a, b)| [0, 1].map(|k| a[k] + share * b[k])).collect();
    Tangent {
        force: pairs(&a.force, &b.force),
        motion: a.motion.iter().zip(&b.motion).map(|(a, b)| [0, 1, 2].map(|k| a[k] + share * b[k])).collect(),
        factor: a.factor + share * b.factor,
        gap: pairs(&a.gap, &b.gap),
    }
}

/// Returns the piece of the other branch in one sense of the critical motion, and its modes. `None` if no rate leads there.
/// If the first sliding points that stop along the critical motion do not lead to another branch, the next ones stop as well.
fn begin(
    tracer: &mut Tracer,
    here: &State,
    present: &Piece,
    critical: &Tangent,
    direction: f64,
) -> Option<(Piece, Vec<ContactMode>)> {
    let system = &mut tracer.system;
    let [own, by] = [&present.tangent, critical].map(|rate| present.read(system, here, here, rate));
    // The share of φ at which a sliding point stops.
    let rest = |i: usize| {
        let slides = matches!(present.monitors.0[i].what, What::Flow(_)) && by[i].value < -by[i].tolerance;
        slides.then(|| own[i].value.max(0.0) / -by[i].value)
    };
    let mut rests: Vec<(usize, f64)> = (0..own.len()).filter_map(|i| Some((i, rest(i)?))).collect();
    if rests.is_empty() {
        return Some((present.turned(system, critical)?, here.mode.clone()));
    }
    rests.sort_by(|a, b| a.1.total_cmp(&b.1));
    let next_is_later =
        |end: usize| rests.get(end).is_none_or(|next| next.1 > rests[end - 1].1 * (1.0 + SETTINGS.distinct()));
    (1..=rests.len()).filter(|end| next_is_later(*end)).find_map(|end| {
        let hits: Vec<Monitor> = rests[..end].iter().map(|(i, _)| present.monitors.0[*i]).collect();
        let arrival = present.turned(system, &sum(&present.tangent, rests[end - 1].1, critical))?;
        let NextPiece::Goes { rate, modes, .. } = after_event(system, here, &arrival, &hits, (direction, true)) else {
            return None;
        };
        let piece = Piece::new(system, &State { mode: modes.clone(), ..here.clone() }, &rate)?;
        // The present branch is no other branch.
        let turns = inner(&piece.row, &present.row) < 1.0 - SETTINGS.distinct();
        (turns && modes != here.mode).then_some((piece, modes))
    })
}

/// Returns a state on the other branch near its beginning, before its first event.
fn first_step(tracer: &mut Tracer, here: &State, piece: &Piece, length: f64) -> Option<StepEnd> {
    let watched = Watched { sense: None, target: None };
    // With the equations of the bifurcation a step along φ is not determined.
    let nearby = std::mem::replace(&mut tracer.system.limits.nearby, false);
    let shorter = std::iter::successors(Some(length), |length| Some(SETTINGS.telling * length));
    let found = shorter.take_while(|shorter| *shorter >= SETTINGS.fine * length).find_map(|length| {
        match advance(&mut tracer.system, (here, piece), length, watched) {
            Advance::Whole(end) if end.length > 0.0 && end.error <= SETTINGS.most_error => Some(end),
            _ => None,
        }
    });
    tracer.system.limits.nearby = nearby;
    found
}
