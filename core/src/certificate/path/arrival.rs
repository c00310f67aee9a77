//! The piece of a path before a state: the modes that all points could have on it, and the increments on it.
//!
//! A rate at the state in modes of that piece also existed on the piece. Unloading is such a rate, and so is the way
//! back. Neither of them continues the path.

use super::point_modes::{Decided, ModeCone};
use crate::path::PointMode;

/// Distance of an increment from a mode, relative to the greatest increment, above which the point was not in this
/// mode.
const APART: f64 = 1e-6;

/// The piece before a state.
#[derive(Debug)]
pub(super) struct Arrival {
    /// True if λ has not grown on it, in the sense of its load step.
    pub falls: bool,
    /// Modes that each contact point could have on it.
    pub modes: Vec<Vec<ModeCone>>,
    /// Increments of force and gap of each contact point.
    pub increments: Vec<[[f64; 2]; 2]>,
}

impl Arrival {
    /// Checks that all remaining modes at a state were possible on the piece. If λ fell on it, one of the decided modes
    /// must also differ from the mode on the piece; otherwise the path continues as before.
    pub fn had(&self, modes: &[Vec<ModeCone>], decided: &Decided) -> Result<(), String> {
        for (contact, (before, now)) in self.modes.iter().zip(modes).enumerate() {
            let mut left = now.iter().filter(|cone| decided.get(&contact).is_none_or(|mode| *mode == cone.mode));
            if let Some(new) = left.find(|cone| !before.iter().any(|old| contains(old, cone))) {
                return Err(format!("{:?} at contact point {contact} is a mode that it did not have before", new.mode));
            }
        }
        let differs = |(contact, mode): (&usize, &PointMode)| {
            let cone = modes[*contact].iter().find(|cone| cone.mode == *mode);
            cone.is_some_and(|cone| self.leaves(*contact, cone))
        };
        if self.falls && !decided.iter().any(differs) {
            return Err("the path may go on in the modes that it has had".into());
        }
        Ok(())
    }

    /// Returns true if a contact point was not in a mode on the piece.
    fn leaves(&self, contact: usize, cone: &ModeCone) -> bool {
        let [force, gap] = self.increments[contact];
        let distances = cone.distances(force, gap);
        let greatest = |i: usize| self.increments.iter().map(|own| own[i][0].hypot(own[i][1])).fold(0.0, f64::max);
        (0..2).any(|i| distances[i] > APART * greatest(i))
    }
}

/// Returns true if a mode before an event has all rates of a mode at the event.
fn contains(old: &ModeCone, now: &ModeCone) -> bool {
    match (old.mode, now.mode) {
        (PointMode::Open, PointMode::Vertex) => true,
        (old_mode, mode) => old_mode == mode && old.gap.len() >= now.gap.len(),
    }
}
