//! What ends a path: limit points and peaks, mechanisms, rays, and how far it was asked to go.

use super::control::Control;
use super::limit_point::test_limit_point;
use super::measure::{increment_along, motion_size};
use super::peak::scaled_motion;
use super::plastic_plateau::stands_still;
use super::softening::{forget_lower_peak, softens_down};
use super::state::{State, Tangent};
use super::step::solve_step;
use super::system::{StepFailure, StepSystem};
use super::tangent::tangent_at;
use super::tracer::{LoadStepEnding, Tracer, end_path, moved_along};
use crate::path::continuation::arc_length::ArcLength;
use std::sync::Arc;
use voussoir_core::limit::Status;
use voussoir_core::path::{Continuation, LoadStep};

/// No step is small enough: a limit point for strategies that cannot pass one, else a stall.
pub(super) fn no_step(tracer: &mut Tracer, failure: &StepFailure, rate: &Tangent, direction: f64) -> LoadStepEnding {
    let points: Vec<String> = failure
        .cycling
        .iter()
        .take(6)
        .map(|&c| format!("{c} of joint {}", tracer.system.problem.contacts[c].joint))
        .collect();
    let who = if points.is_empty() { String::new() } else { format!(" (contact points {})", points.join(", ")) };
    let why = format!("no step from factor {} converges: {}{who}", tracer.state.factor, failure.why);
    let falls = rate.factor * direction <= 0.0;
    if !tracer.strategy.passes_limit_points()
        && (falls || softens_down(tracer, rate, direction) || turns_back(tracer, rate, direction))
    {
        test_limit_point(tracer, &tracer.state.clone(), direction);
        end_path(tracer, Status::LimitPoint, format!("{why}; the path goes on with a factor that does not grow"))
    } else {
        let ended = end_path(tracer, Status::Stalled, why);
        tracer.record.notes.extend(tracer.limit.unproven.take().map(|why| format!("at its last state {why}")));
        ended
    }
}

/// The greatest rate of a contact force in units.
fn greatest_force(system: &StepSystem, rate: &Tangent) -> f64 {
    let unit = system.units().force;
    rate.force.iter().flatten().map(|r| (r / unit).abs()).fold(0.0, f64::max)
}

/// Whether the path goes on with a factor that does not grow.
pub(super) fn turns_back(tracer: &mut Tracer, rate: &Tangent, direction: f64) -> bool {
    let arc = Arc::new(ArcLength::default());
    let size = arc.constraint(&increment_along(&tracer.system, &tracer.state, rate), None).value;
    for exponent in [-2, -3, -4, -6] {
        let length = size * 10f64.powi(exponent);
        let control = Control::Strategy { strategy: arc.clone(), previous: None, length };
        let guess = moved_along(tracer, rate, 10f64.powi(exponent));
        if let Ok((next, _)) = solve_step(&mut tracer.system, &tracer.state, guess, &control) {
            if stands_still(tracer, &next) {
                return true;
            }
            let Some(after) = tangent_at(&mut tracer.system, &tracer.state, &next, &control) else { continue };
            if after.factor * direction <= 1e-9 * tracer.system.units().factor * motion_size(&tracer.system, &after) {
                return true;
            }
        }
    }
    false
}

/// Whether the rate goes on for ever: collapse, or a ray that carries any load.
pub(super) fn ends_in_ray(tracer: &mut Tracer, rate: &Tangent, direction: f64, target: f64) -> bool {
    let u = tracer.system.units();
    let motion = motion_size(&tracer.system, rate);
    let force = greatest_force(&tracer.system, rate);
    let factor = rate.factor / u.factor * direction;
    let still = force <= 1e-9 * motion && factor.abs() <= 1e-9 * motion;
    let force_unit = if still { f64::INFINITY } else { force.max(factor.abs()) * u.force };
    let goes_on = (0..rate.gap.len()).all(|c| {
        let Some(law) = tracer.system.law(c) else { return true };
        let gap = rate.gap[c].map(|g| g / (u.displacement * motion));
        let r = rate.force[c].map(|r| r / force_unit);
        law.ray_violation(tracer.state.mode[c], r, gap) <= 1e-8
    });
    if !goes_on || !tractions_persist(&tracer.system, &tracer.state, rate) {
        return false;
    }
    forget_lower_peak(tracer, direction);
    if still {
        tracer.ending.motion = scaled_motion(tracer, &tracer.state, rate);
        if tracer.ending.motion.is_none() {
            return false;
        }
        end_path(
            tracer,
            if tracer.limit.peak.is_some() { Status::LimitPoint } else { Status::Collapse },
            String::new(),
        );
        if tracer.limit.peak.is_some() {
            tracer
                .record
                .notes
                .push(format!("after the limit point the path ends in a mechanism at factor {}", tracer.state.factor));
        }
        return true;
    }
    // What strengths bound is no ray: the facets have been looked at above with the ray's forces, and no
    // block that may yield carries any load.
    if target.is_infinite() && !tracer.system.problem.yields() && factor > 1e-9 * (motion + force) {
        // A support that moves what is statically determinate asks for no forces.
        let constant = force <= 1e-7 * motion && tracer.system.settles();
        let of = |x: f64| if constant { 0.0 } else { x / rate.factor };
        tracer.ending.ray = Some(rate.force.iter().map(|r| r.map(of)).collect());
        end_path(
            tracer,
            if tracer.limit.peak.is_some() { Status::LimitPoint } else { Status::Unbounded },
            String::new(),
        );
        if tracer.limit.peak.is_some() {
            tracer.record.notes.push(format!(
                "after the limit point the load grows without bound from factor {}",
                tracer.state.factor
            ));
        }
        return true;
    }
    false
}

/// Whether the laws give, however far a rate is followed, the forces that it says (sampled).
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
        let Ok(updates) = system.laws.responses.update(&gaps, &state.updates.memory) else { return false };
        system.laws.responses.points().all(|c| {
            (0..2).all(|k| {
                let traction = system.problem.contacts[c].area * updates.points[c].traction[k];
                let told = state.force[c][k] + share * rate.force[c][k];
                (traction - told).abs() <= 1e-6 * (held + share * grown)
            })
        })
    })
}

/// Returns true if the path went as far after its limit point as its stage asks for, and has ended.
pub(super) fn stops(tracer: &mut Tracer, load_step: &LoadStep, direction: f64) -> bool {
    let (factor, displacement) = (tracer.state.factor, tracer.record.state.displacement);
    let Some(peak) = &tracer.limit.peak else { return false };
    if !tracer.system.laws.responses.is_empty() && (factor - peak.factor) * direction > 0.0 {
        return false;
    }
    let beyond = (displacement - peak.state.displacement).abs();
    let done = match tracer.settings.stop(load_step.stage) {
        [None, None] => {
            let (fallen, grown) = ((peak.factor - factor) * direction, (peak.factor - load_step.start).abs());
            fallen >= 0.1 * grown || beyond >= peak.state.displacement.abs()
        }
        [most, least] => {
            most.is_some_and(|most| beyond >= most) || least.is_some_and(|least| (factor - least) * direction <= 0.0)
        }
    };
    if done {
        end_path(tracer, Status::LimitPoint, String::new());
    }
    done
}
