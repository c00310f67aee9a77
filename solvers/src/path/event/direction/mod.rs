//! The direction of the next piece of the path: the order of the methods for its rate problem.

mod continued;
mod few;
mod strengthened;
mod whole_system;

pub use self::continued::{Continued, Next};
use self::few::{MANY, Neighbourhood, by_active_set, by_neighbours};
use self::strengthened::by_strength;
use self::whole_system::on_whole_system;
use crate::path::event::piece::rates::Rates;
use crate::path::event::trace::Trace;
use crate::path::system::Load;

/// Returns the direction from the present state. A chain is solved by its joints. Otherwise it is the only rate next to
/// the arrival, if there is one, or the answer to the rate problem of the whole active set.
pub fn next_direction(trace: &mut Trace, load: &Load) -> Continued {
    trace.log.counts.rate_problems += 1;
    let active = trace.active_points();
    // A single point that arrives can enter one cell only: the present modes lead there.
    if trace.state.sense > 0.0 && (trace.associated || trace.arrived() <= 1) {
        let modes = trace.present_modes();
        if let Some((modes, rates)) = trace.by_chain(load, &active, modes) {
            trace.log.counts.by_chain += 1;
            return Continued { by_chain: true, ..Next::Go(trace.take(modes, rates, load)).into() };
        }
    }
    // At the unloaded state all points are in the active set, and no rate is next to another one.
    let many = if trace.state.x.iter().all(|v| *v == 0.0) {
        true
    } else {
        match by_neighbours(trace, load, &active) {
            Neighbourhood::Next(next) => return next.into(),
            Neighbourhood::NotFound => active.len() > MANY && trace.state.sense > 0.0,
            Neighbourhood::Several => false,
        }
    };
    if many {
        if let Some(direction) = on_whole_system(trace, load, &active) {
            return Next::Go(direction).into();
        }
        // With associated flow a mechanism itself proves that no rate raises the load.
        let proves =
            |rates: &Rates, associated| rates.factor > 0.0 || associated && rates.factor == 0.0 && !load.settles;
        if let Some((modes, rates)) = by_strength(trace, load, &active)
            && proves(&rates, trace.associated)
        {
            return Next::Go(trace.take(modes, rates, load)).into();
        }
    }
    by_active_set(trace, load, &active)
}
