//! The first piece of a load step, or of what follows a jump: a rate on which the factor goes in its sense.

use super::super::control::Control;
use super::super::limit_point_test::{LimitPointTest, limit_point_test};
use super::super::step::solve_step;
use super::super::tangent::tangent_at;
use super::super::tracer::{LoadStepEnding, Tracer, commit, end_path};
use super::piece::Piece;
use super::switch::{Start, is_admissible};
use voussoir_core::limit::Status;

/// Load of the first state of all, relative to the unit of the factor. From nothing a load has no scale: what slides or opens
/// first does so under any load.
const FROM_NOTHING: f64 = 0.05;
/// Shares of the load step at which a state is looked for if no rate has been found.
const AHEAD: [f64; 3] = [1e-6, 1e-4, 1e-2];

/// The first piece, or how the load step ends at its start.
pub(super) fn begin(tracer: &mut Tracer, target: f64, direction: f64) -> Result<Piece, LoadStepEnding> {
    if tracer.state.force.iter().flatten().all(|r| *r == 0.0) && !from_nothing(tracer, target, direction) {
        let why = format!("no state was found under the first load; the factor is {}", tracer.state.factor);
        return Err(end_path(tracer, Status::Stalled, why));
    }
    match first_rate(tracer, target, direction) {
        Ok((rate, modes)) => {
            let piece = Piece::new(&tracer.system, &modes, &rate);
            tracer.state.mode = modes;
            piece.ok_or_else(|| end_path(tracer, Status::Stalled, "nothing moves under this load".into()))
        }
        Err((status, why)) => Err(end_path(tracer, status, why)),
    }
}

/// Takes a state under a small load. Whether there is one.
fn from_nothing(tracer: &mut Tracer, target: f64, direction: f64) -> bool {
    let unit = tracer.system.units().factor;
    let most = (target - tracer.state.factor).abs() / 16.0;
    for k in 0..6 {
        let length = (FROM_NOTHING * unit * 10f64.powi(-k)).min(most);
        let control = Control::Factor(tracer.state.factor + direction * length);
        let start = tracer.state.clone();
        if let Ok((state, _)) = solve_step(&mut tracer.system, &start, start.clone(), &control) {
            return commit(tracer, state);
        }
    }
    false
}

fn first_rate(tracer: &mut Tracer, target: f64, direction: f64) -> Result<Start, (Status, String)> {
    let state = tracer.state.clone();
    let factor = state.factor;
    let control = Control::Factor(target);
    if let Some(rate) = tangent_at(&mut tracer.system, &state, &state, &control) {
        let rate = rate.scaled(direction);
        if is_admissible(&tracer.system, &state, &state.mode, &rate) {
            return Ok((rate, state.mode));
        }
    }
    tracer.system.count("rate_problems", 1);
    let unknown = match limit_point_test(&mut tracer.system, &state, direction) {
        LimitPointTest::Tangent(rate, modes) => return Ok((rate, modes)),
        LimitPointTest::None => {
            tracer.limit.proven = Some(factor);
            return Err((Status::LimitPoint, format!("at factor {factor} no rate of equilibrium has a growing load")));
        }
        LimitPointTest::Unknown(why) => why,
    };
    for share in AHEAD {
        let ahead =
            Control::Factor(factor + share * direction * (target - factor).abs().min(tracer.system.units().factor));
        let Ok((next, _)) = solve_step(&mut tracer.system, &state, state.clone(), &ahead) else { continue };
        let mut turned = state.clone();
        turned.mode.clone_from(&next.mode);
        let Some(rate) = tangent_at(&mut tracer.system, &state, &turned, &control) else { continue };
        let rate = rate.scaled(direction);
        if is_admissible(&tracer.system, &state, &next.mode, &rate) {
            return Ok((rate, next.mode));
        }
    }
    Err((
        Status::Stalled,
        format!("at factor {factor} no rate of equilibrium under the growing load was found: {unknown}"),
    ))
}
