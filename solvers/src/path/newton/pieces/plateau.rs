//! Whether a piece is a mechanism that moves on under a constant load.

use super::super::limit_point_test::{LimitPointTest, limit_point_test};
use super::super::measure::fastest;
use super::super::state::State;
use super::super::tracer::Tracer;
use super::advance::{Advance, StepEnd, Watched, advance};
use super::piece::Piece;

/// Rates of the factor and of forces, in units, relative to that of motions, at which they stand still.
const STILL: [f64; 2] = [1e-9, 1e-4];
/// Motion, as a share of the scene's size, over which a mechanism is followed, and least motion before an event.
const FOLLOWED: f64 = 1e-2;
const LEAST: f64 = 1e-3;
/// Change of factor and forces, relative to them, over that motion.
const CHANGE: f64 = 1e-8;

/// A mechanism: the state to which it moves.
pub(super) struct Plateau {
    pub moved: State,
    /// Set if it is not proved that no rate has a growing factor.
    pub unproved: Option<String>,
}

/// Returns true if a piece starts with a factor and forces that stand still.
pub(super) fn stands_still(tracer: &Tracer, piece: &Piece) -> bool {
    let u = tracer.system.units();
    let motion = piece.row[..piece.row.len() - 1].iter().map(|x| x * x).sum::<f64>().sqrt();
    let force = piece.tangent.force.iter().flatten().fold(0.0, |a: f64, r| a.max((r / u.force).abs()));
    (piece.tangent.factor / u.factor).abs() <= STILL[0] * motion && force <= STILL[1] * motion
}

/// Moves along a piece that stands still. `None` if it is no plateau.
pub(super) fn plateau(tracer: &mut Tracer, piece: &Piece, direction: f64) -> Option<Plateau> {
    let start = tracer.state.clone();
    let fastest = fastest(&tracer.system, &piece.tangent.motion).max(1e-300);
    let size = tracer.system.units().length;
    let (mut state, mut piece_here) = (start.clone(), piece.clone());
    let (mut moved, mut length) = (0.0, 1e-5 * size / fastest);
    let watched = Watched { sense: None, target: None };
    let whole = FOLLOWED * size / fastest;
    for _ in 0..200 {
        let step = length.min(whole - moved);
        match advance(&mut tracer.system, &state, &piece_here, step, watched) {
            Advance::Whole(StepEnd { state: mut next, rate, length: taken, .. }) => {
                tracer.system.keep(&state, &mut next);
                piece_here = piece_here.turned(&tracer.system, &rate)?;
                state = next;
                moved += taken;
                length *= 3.0;
            }
            Advance::Event(end, _) => {
                moved += end.length;
                state = end.state;
                break;
            }
            _ => length *= 0.2,
        }
        if moved >= whole * (1.0 - 1e-9) {
            break;
        }
    }
    if moved * fastest < LEAST * size || !is_same(&start, &state) {
        return None;
    }
    match limit_point_test(&mut tracer.system, &start, direction) {
        LimitPointTest::None => Some(Plateau { moved: state, unproved: None }),
        LimitPointTest::Unknown(why) => Some(Plateau { moved: state, unproved: Some(why) }),
        LimitPointTest::Tangent(..) => None,
    }
}

/// Returns true if factor and forces of two states are the same.
fn is_same(start: &State, state: &State) -> bool {
    let largest = start.force.iter().flatten().fold(0.0, |a: f64, r| a.max(r.abs()));
    let pairs = start.force.iter().flatten().zip(state.force.iter().flatten());
    let change = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    change <= CHANGE * largest && (start.factor - state.factor).abs() <= CHANGE * start.factor.abs()
}
