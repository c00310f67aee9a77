//! The active set on the whole system, for many points at once.

use crate::contact::mode::ContactMode;
use crate::path::event::piece::factorisation::FactorisedModes;
use crate::path::event::piece::rates::{Direction, Rates, leaving, residual};
use crate::path::event::trace::Trace;
use crate::path::system::Load;

/// Greatest number of rounds, and the number of first rounds in which all points change at once.
const ROUNDS: [usize; 2] = [80, 40];

/// Returns the direction with λ̇ = 1 if the active set finds it: points change their modes until no rate violates one.
pub fn on_whole_system(trace: &mut Trace, load: &Load, active: &[usize]) -> Option<Direction> {
    let mut modes = trace.present_modes();
    let mut seen: Vec<Vec<ContactMode>> = Vec::new();
    for round in 0..ROUNDS[0] {
        trace.log.counts.factorisations += 1;
        let system = &trace.system;
        let mut base = FactorisedModes::new(system, modes.clone(), trace.factors.refine_columns)?;
        let x = base.load_rate(system, trace.state.load_step, load)?.clone();
        let rates = Rates::new(system, x, 1.0, load);
        let mut changes = leaving((system, &trace.state.points), (&rates, load), active, &modes)?;
        if changes.is_empty() {
            if residual(system, &rates, load, &modes).0 > trace.believed() {
                return None;
            }
            trace.factors.present = Some(base);
            return Some(trace.take(modes, rates, load));
        }
        if seen.contains(&modes) || round > ROUNDS[1] {
            changes.sort_by_key(|change| change.1);
            changes.truncate(1);
        }
        seen.push(modes.clone());
        for (_, c, to) in changes {
            modes[c] = to;
        }
    }
    None
}
