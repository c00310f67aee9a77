//! Events of a contact point: what it does, and what happens between two such states.

use voussoir_core::interface::{Facet, FacetMode};
use voussoir_core::path::Happening;

/// What a contact point does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ContactStatus {
    Sticks,
    Open,
    /// With t on the plus body, or against it.
    Slides {
        forward: bool,
    },
    Crushes,
    Softens,
}

impl ContactStatus {
    /// Of a point at which a facet yields.
    pub fn of_facet(facet: &Facet) -> Self {
        match facet.mode {
            FacetMode::Opening => ContactStatus::Open,
            FacetMode::Crushing => ContactStatus::Crushes,
            FacetMode::Sliding => ContactStatus::Slides { forward: facet.flow[1] < 0.0 },
        }
    }
}

/// What happens where a point goes over from one status to another.
pub(super) fn transition(before: ContactStatus, after: ContactStatus) -> Option<Happening> {
    use ContactStatus::{Crushes, Open, Slides, Softens, Sticks};
    Some(match (before, after) {
        (before, after) if before == after => return None,
        (_, Open) => Happening::Opens,
        (_, Softens) => Happening::Softens,
        (_, Crushes) => Happening::Crushes,
        (_, Slides { forward: true }) => Happening::SlipsForward,
        (_, Slides { forward: false }) => Happening::SlipsBackward,
        (Open, Sticks) => Happening::Closes,
        (Crushes | Softens, Sticks) => Happening::Unloads,
        (_, Sticks) => Happening::Sticks,
    })
}
