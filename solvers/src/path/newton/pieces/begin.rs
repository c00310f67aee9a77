//! The first piece of a load step, or the first piece after a jump: a rate on which the factor changes in its sense.

use super::piece::Piece;
use super::switch::{Start, is_admissible};
use crate::contact::mode::ContactMode;
use crate::path::event::first_modes;
use crate::path::newton::model::control::Control;
use crate::path::newton::model::state::State;
use crate::path::newton::solve::nearby::Accuracy;
use crate::path::newton::solve::rate_after_event::rising_rate;
use crate::path::newton::solve::step::solve_step;
use crate::path::newton::solve::tangent::tangent_at;
use crate::path::newton::tracing::commit::commit;
use crate::path::newton::tracing::tracer::{LoadStepEnding, Tracer, end_path};
use crate::settings::SETTINGS;
use voussoir_core::limit::Status;

/// Returns the first piece, or the ending if the load step ends at its start.
pub(super) fn begin(tracer: &mut Tracer, target: f64, direction: f64) -> Result<Piece, LoadStepEnding> {
    match first_rate(tracer, target, direction) {
        Ok((rate, modes)) => {
            tracer.state.mode = modes;
            let piece = Piece::new(&tracer.system, &tracer.state, &rate);
            piece.ok_or_else(|| end_path(tracer, Status::Stalled, "nothing moves under this load".into()))
        }
        Err((status, why)) => Err(end_path(tracer, status, why)),
    }
}

/// Returns the rate from a state without forces. First it uses the modes of a state under a small load: Newton's method
/// keeps the symmetry of a scene, while non-associated friction may have other solutions. If that finds none, it solves
/// the rate problem of the first piece. The path begins at the small load if joints are open, because no such rate exists
/// then, or if no rate is found, because a law of tractions can change its tangent as soon as there is a force.
fn rate_from_nothing(tracer: &mut Tracer, target: f64, direction: f64) -> Result<Start, String> {
    let start = tracer.state.clone();
    let length = SETTINGS.first_load * tracer.system.units().factor.min((target - start.factor).abs());
    let control = Control::Factor(start.factor + direction * length);
    let near = solve_step(&mut tracer.system, &start, start.clone(), &control).ok().map(|(state, _)| state);
    if start.gap.iter().any(|gap| gap[0] > 0.0) {
        let found = near.and_then(|near| rate_after_beginning(tracer, near, target, direction));
        return found.ok_or_else(|| "joints are open, and no state in which they carry it was found".into());
    }
    if let Some(found) = near.as_ref().and_then(|state| rate_in(tracer, state.mode.clone(), target, direction)) {
        return Ok(found);
    }
    let modes = first_modes(tracer.system.problem, tracer.settings, tracer.in_force.load_step, direction)?;
    let found = rate_in(tracer, modes, target, direction);
    let found = found.or_else(|| near.and_then(|near| rate_after_beginning(tracer, near, target, direction)));
    found.ok_or_else(|| "the modes that were found have no rate".into())
}

/// Begins the path at a state, and returns the rate there in its modes.
fn rate_after_beginning(tracer: &mut Tracer, state: State, target: f64, direction: f64) -> Option<Start> {
    let begins = commit(tracer, state);
    let modes = tracer.state.mode.clone();
    begins.then(|| rate_in(tracer, modes, target, direction)).flatten()
}

/// Returns the rate at the present state in some modes, if they admit it.
fn rate_in(tracer: &mut Tracer, modes: Vec<ContactMode>, target: f64, direction: f64) -> Option<Start> {
    let state = State { mode: modes, ..tracer.state.clone() };
    let rate = tangent_at(&mut tracer.system, &state, &Control::Factor(target), Accuracy::Fine)?.scaled(direction);
    is_admissible(&tracer.system, &state, &state.mode, &rate).then_some((rate, state.mode))
}

fn first_rate(tracer: &mut Tracer, target: f64, direction: f64) -> Result<Start, (Status, String)> {
    if tracer.state.force.iter().flatten().all(|r| *r == 0.0) {
        let found = rate_from_nothing(tracer, target, direction);
        return found.map_err(|why| (Status::Stalled, format!("no rate was found under the first load: {why}")));
    }
    let state = tracer.state.clone();
    let factor = state.factor;
    if let Some(found) = rate_in(tracer, state.mode.clone(), target, direction) {
        return Ok(found);
    }
    tracer.system.count("rate_problems", 1);
    match rising_rate(&mut tracer.system, &state, direction) {
        Ok(Some(found)) => Ok(found),
        Ok(None) => {
            tracer.limit.proven = Some(factor);
            Err((Status::LimitPoint, format!("at factor {factor} no rate of equilibrium has a growing load")))
        }
        Err(why) => Err((
            Status::Stalled,
            format!("at factor {factor} no rate of equilibrium under the growing load was found: {why}"),
        )),
    }
}
