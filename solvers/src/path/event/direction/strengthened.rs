//! The rate problem of many points at once, solved by the path of the same structure with a small strength.
//!
//! The active facets a_i·ṙ ≤ 0 are replaced by facets a_i·r ≤ b_i with b_i > 0, so that the structure at rest has no
//! active point. Its path under the growing load goes from event to event, with one or a few points at a time. Beyond
//! the last event its forces grow without limit, so that the strength is negligible: the modes and rates of the last
//! piece solve the rate problem of strength zero. This is Lemke's path with b as covering vector, followed with the
//! factorisations of the whole structure. For associated flow without softening it always ends, with a rate on which λ
//! grows or with a mechanism.
//!
//! Sources: Lemke (1965), Management Science 11, 681-689; Cottle, Pang & Stone (1992), The Linear Complementarity
//! Problem, ch. 4.

use super::continued::Next;
use super::few::{Neighbourhood, by_active_set, by_neighbours};
use super::whole_system::on_whole_system;
use crate::contact::mode::ContactMode;
use crate::path::event::next_event::{advance, next_event};
use crate::path::event::piece::point::Point;
use crate::path::event::piece::rates::{Direction, Rates, leaving, residual};
use crate::path::event::trace::{Factors, Log, State, Trace};
use crate::path::system::{Load, System};
use crate::settings::SETTINGS;
use voussoir_core::law::Facet;
use voussoir_core::path::Unobserved;

/// Greatest number of events of the path for each active point.
const EVENTS: usize = 20;

/// Returns the rates of the last piece of the path with strength, and the modes of all points. `None` if this path does
/// not end, or if its rates do not solve the problem.
pub fn by_strength(trace: &mut Trace, load: &Load, active: &[usize]) -> Option<(Vec<ContactMode>, Rates)> {
    let (direction, modes) = last_piece(trace, load, active)?;
    let modes: Vec<ContactMode> =
        trace.state.points.iter().zip(modes).map(|(point, mode)| mode_without_strength(point, mode)).collect();
    let (system, points) = (&trace.system, trace.state.points.as_slice());
    let mut rates = Rates::new(system, direction.x, direction.factor, load);
    rates.worst = residual(system, &rates, load, &modes).0;
    let holds =
        rates.worst <= trace.believed() && leaving((system, points), (&rates, load), active, &modes)?.is_empty();
    holds.then_some((modes, rates))
}

/// Returns the direction of the last piece and the modes in it.
fn last_piece(trace: &mut Trace, load: &Load, active: &[usize]) -> Option<(Direction, Vec<ContactMode>)> {
    let mut observer = Unobserved;
    let system = with_strength(&trace.system, &trace.state.points);
    let points = trace.state.points.iter().map(at_rest).collect();
    let mut strong = Trace {
        problem: trace.problem,
        settings: trace.settings,
        observer: &mut observer,
        associated: trace.associated,
        state: State::at_rest(&system, points, trace.state.load_step),
        system,
        factors: Factors::default(),
        log: Log::default(),
    };
    let mut found = None;
    for _ in 0..EVENTS * active.len() {
        let Some(direction) = direction(&mut strong, load) else { break };
        let (step, hits) = next_event(&strong, &direction, SETTINGS.residual());
        if step.is_infinite() {
            let modes = strong.state.points.iter().map(|point| point.mode).collect();
            found = Some((direction, modes));
            break;
        }
        advance(&mut strong, &direction, step, 1.0, &hits);
    }
    let (counts, own) = (&mut trace.log.counts, strong.log.counts);
    counts.factorisations += own.factorisations;
    counts.solves += own.solves;
    counts.rates.trials += own.rates.trials;
    found
}

/// Returns the direction of the path with strength, on which a few points at a time are active.
fn direction(strong: &mut Trace, load: &Load) -> Option<Direction> {
    let active = strong.active_points();
    if active.is_empty() {
        return on_whole_system(strong, load, &active);
    }
    let next = match by_neighbours(strong, load, &active) {
        Neighbourhood::Next(next) => next,
        _ => by_active_set(strong, load, &active).next,
    };
    match next {
        Next::Go(direction) | Next::Falling(direction) => Some(direction),
        _ => None,
    }
}

/// Returns the system with strength instead of each active facet. Facets with slack cannot be reached.
fn with_strength(system: &System, points: &[Point]) -> System {
    let strong = |(facets, point): (&Option<Vec<Facet>>, &Point)| {
        let bound = |f: usize, facet: &Facet| match point.settled().is_none() && point.active.contains(&f) {
            // The corners of opening and sliding stay separate: at the strength of opening a point may also slide.
            true => facet.normal[0].abs() + facet.normal[1].abs(),
            false => f64::INFINITY,
        };
        let facets = facets.as_ref()?.iter().enumerate();
        Some(facets.map(|(f, facet)| Facet { bound: bound(f, facet), ..*facet }).collect())
    };
    System { facets: system.facets.iter().zip(points).map(strong).collect(), ..system.clone() }
}

/// Returns a point of the structure with strength before any load. Points without a choice keep their modes.
fn at_rest(point: &Point) -> Point {
    let opening = if point.open() { f64::INFINITY } else { 0.0 };
    let rests = Point { opening, arrived_from: None, noted: true, ..point.clone() };
    match (point.settled(), point.open()) {
        (Some(_), _) => rests,
        (None, true) => Point { active: point.opening_facet.into_iter().collect(), ..rests },
        (None, false) => Point { active: Vec::new(), apex: false, mode: ContactMode::Stick, ..rests },
    }
}

/// Returns the mode in the rate problem without strength: at the apex every opening mode is the open mode.
fn mode_without_strength(point: &Point, mode: ContactMode) -> ContactMode {
    let opens = |f: u8| point.opening_facet == Some(f as usize);
    match mode {
        _ if point.settled().is_some() || !point.apex => point.settled().unwrap_or(mode),
        ContactMode::Corner(..) => ContactMode::Open,
        ContactMode::Facet(f) if opens(f) => ContactMode::Open,
        own => own,
    }
}
