//! Rays: pieces with small displacements that are admissible without an end.

use super::piece::Piece;
use crate::path::newton::model::state::{State, Tangent};
use crate::path::newton::model::system::StepSystem;
use crate::path::newton::model::tractions::update;
use crate::path::newton::quantities::measure::motion_size;
use crate::path::newton::tracing::tracer::{LoadStepEnding, Tracer, end_path};
use crate::settings::SETTINGS;
use voussoir_core::limit::Status;

/// Returns the ending of a path on which the load grows without bound along a piece, if it does.
pub(super) fn ray(tracer: &mut Tracer, piece: &Piece, direction: f64) -> Option<LoadStepEnding> {
    let (u, rate) = (tracer.system.units(), &piece.tangent);
    if !tracer.system.limits.carries_any_load {
        return None;
    }
    let motion = motion_size(&tracer.system, rate);
    let force = rate.force.iter().flatten().map(|r| (r / u.force).abs()).fold(0.0, f64::max);
    let factor = rate.factor / u.factor * direction;
    if factor <= SETTINGS.admissible * (motion + force) {
        return None;
    }
    let goes_on = (0..rate.gap.len()).all(|c| {
        let Some(law) = tracer.system.law(c) else { return true };
        let gap = rate.gap[c].map(|g| g / (u.displacement * motion));
        let r = rate.force[c].map(|r| r / (force.max(factor) * u.force));
        law.ray_violation(tracer.state.mode[c], r, gap) <= SETTINGS.active
    });
    if !goes_on || !tractions_persist(&tracer.system, &tracer.state, rate) {
        return None;
    }
    // A support that moves a statically determinate structure causes no forces.
    let constant = force <= 10.0 * SETTINGS.active * motion && tracer.system.settles();
    let of = |x: f64| if constant { 0.0 } else { x / rate.factor };
    tracer.ending.ray = Some(rate.force.iter().map(|r| r.map(of)).collect());
    Some(end_path(tracer, Status::Unbounded, String::new()))
}

/// Returns true if, at some sample lengths, the laws give the forces of a rate however far it is followed.
fn tractions_persist(system: &StepSystem, state: &State, rate: &Tangent) -> bool {
    let u = system.units();
    let motion = motion_size(system, rate).max(1e-300) * u.displacement;
    let largest = |rates: &[[f64; 2]]| rates.iter().flatten().fold(0.0, |a: f64, r| a.max(r.abs()));
    let (held, grown) = (largest(&state.force).max(u.force), largest(&rate.force));
    let small = |x: f64| if x.abs() <= 1e-8 * motion { 0.0 } else { x };
    [1e-9, 1e-6, 1e-3, 1.0].iter().all(|distance| {
        let share = distance * u.length / motion;
        let far = |(g, dg): (&[f64; 2], &[f64; 2])| [0, 1].map(|k| g[k] + share * small(dg[k]));
        let gaps: Vec<[f64; 2]> = state.gap.iter().zip(&rate.gap).map(far).collect();
        let Ok(updates) = update(&system.laws.responses, &gaps, &state.updates.memory, &system.instant(state)) else {
            return false;
        };
        system.laws.responses.points().all(|c| {
            (0..2).all(|k| {
                let traction = system.problem.contacts[c].area * updates.points[c].traction[k];
                let told = state.force[c][k] + share * rate.force[c][k];
                (traction - told).abs() <= 1e-6 * (held + share * grown)
            })
        })
    })
}
