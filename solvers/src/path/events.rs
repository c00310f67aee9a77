//! Events of a contact point: its status, and the event between two statuses.

use voussoir_core::law::{Facet, FacetMode};
use voussoir_core::path::ContactEvent;

/// The status of a contact point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ContactStatus {
    Sticks,
    Open,
    /// It slides with t on the plus body, or against it.
    Slides {
        forward: bool,
    },
    Crushes,
    Softens,
}

impl ContactStatus {
    /// Returns the status of a point at which a facet yields.
    pub fn of_facet(facet: &Facet) -> Self {
        match facet.mode {
            FacetMode::Opening => ContactStatus::Open,
            FacetMode::Crushing => ContactStatus::Crushes,
            FacetMode::Sliding => ContactStatus::Slides { forward: facet.flow[1] < 0.0 },
        }
    }
}

/// Returns the event if a point changes from one status to another.
pub(super) fn transition(before: ContactStatus, after: ContactStatus) -> Option<ContactEvent> {
    use ContactStatus::{Crushes, Open, Slides, Softens, Sticks};
    Some(match (before, after) {
        (before, after) if before == after => return None,
        (_, Open) => ContactEvent::Opens,
        (_, Softens) => ContactEvent::Softens,
        (_, Crushes) => ContactEvent::Crushes,
        (_, Slides { forward: true }) => ContactEvent::SlipsForward,
        (_, Slides { forward: false }) => ContactEvent::SlipsBackward,
        (Open, Sticks) => ContactEvent::Closes,
        (Crushes | Softens, Sticks) => ContactEvent::Unloads,
        (_, Sticks) => ContactEvent::Sticks,
    })
}
