//! Detects pieces that are mechanisms under a constant load.

use super::advance::{Advance, StepEnd, Watched, advance};
use super::piece::Piece;
use crate::linear::largest;
use crate::path::newton::model::state::State;
use crate::path::newton::quantities::measure::{fastest, increment_between};
use crate::path::newton::solve::active_set::active_set;
use crate::path::newton::solve::rate_after_event::rising_rate;
use crate::path::newton::tracing::tracer::Tracer;
use crate::settings::SETTINGS;

/// A mechanism.
pub(super) struct Plateau {
    /// The states through which it moves.
    pub moved: Vec<State>,
    /// Set if it is not proved that no rate has a growing factor.
    pub unproved: Option<String>,
}

/// Returns true if factor and forces are constant at the start of a piece.
pub(super) fn stands_still(tracer: &Tracer, piece: &Piece) -> bool {
    let u = tracer.system.units();
    let motion = piece.row[..piece.row.len() - 1].iter().map(|x| x * x).sum::<f64>().sqrt();
    let force = piece.tangent.force.iter().flatten().fold(0.0, |a: f64, r| a.max((r / u.force).abs()));
    (piece.tangent.factor / u.factor).abs() <= SETTINGS.admissible * motion && force <= SETTINGS.fine * motion
}

/// Moves along a piece with constant factor and forces; `flows` is true if the last step has shown that blocks flow.
/// `None` if it is no plateau.
pub(super) fn plateau(tracer: &mut Tracer, piece: &Piece, direction: f64, flows: bool) -> Option<Plateau> {
    let start = tracer.state.clone();
    let fastest = fastest(&tracer.system, &piece.tangent.motion).max(1e-300);
    let size = tracer.system.units().length;
    let (mut state, mut piece_here) = (start.clone(), piece.clone());
    let mut states = Vec::new();
    let watched = Watched { sense: None, target: None };
    let whole = SETTINGS.visible * size / fastest;
    let (mut moved, mut length) = (0.0, tracer.system.limits.mechanism * whole);
    for _ in 0..200 {
        let step = length.min(whole - moved);
        match advance(&mut tracer.system, (&state, &piece_here), step, watched) {
            Advance::Whole(StepEnd { state: mut next, rate, length: taken, .. }) => {
                states.push(next.clone());
                tracer.system.keep(&state, &mut next);
                piece_here = piece_here.turned(&tracer.system, &rate)?;
                state = next;
                moved += taken;
                length *= 3.0;
            }
            Advance::Event(end, _) => {
                moved += end.length;
                state = end.state;
                states.push(state.clone());
                break;
            }
            _ => length *= 0.2,
        }
        if moved >= whole * (1.0 - 1e-9) {
            break;
        }
    }
    if moved * fastest < SETTINGS.small * size || !is_same(tracer, &start, &state) {
        return None;
    }
    // If no facet may change its mode, the only rate has a constant factor. Tangents of flowing blocks are
    // regularised and do not show it.
    let remembers = tracer.system.limits.remembers;
    // Slip and forces of facets give the dissipation of the whole motion.
    let moved = if remembers { states } else { vec![state] };
    if flows || remembers && active_set(&tracer.system, &start, &[]).contacts.is_empty() {
        return Some(Plateau { moved, unproved: None });
    }
    match rising_rate(&mut tracer.system, &start, direction) {
        Ok(None) => Some(Plateau { moved, unproved: None }),
        Err(why) => Some(Plateau { moved, unproved: (!remembers).then_some(why) }),
        Ok(Some(_)) => None,
    }
}

/// Returns true if blocks yield in a step with constant factor and forces. The tangent of a block that flows as a whole
/// is regularised, so that only the step itself shows it.
pub(super) fn stood_still(tracer: &Tracer, next: &State) -> bool {
    let motion = increment_between(&tracer.system, &tracer.state, next).motion;
    let change = (next.factor - tracer.state.factor).abs() / tracer.system.units().factor;
    next.yields() && is_same(tracer, &tracer.state, next) && change <= SETTINGS.flat * motion
}

/// Returns true if factor and forces of two states are the same.
fn is_same(tracer: &Tracer, start: &State, state: &State) -> bool {
    let pairs = start.force.iter().flatten().zip(state.force.iter().flatten());
    let change = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    // If the load has fallen to zero, both are rounding of their values at the limit point.
    let peak = tracer.limit.peak.as_ref().map_or(0.0, |peak| peak.factor.abs());
    let carried =
        largest(start.force.as_flattened()).max(tracer.system.units().force * peak / tracer.system.units().factor);
    change <= SETTINGS.active * carried
        && (start.factor - state.factor).abs() <= SETTINGS.active * start.factor.abs().max(peak)
}
