//! Events between two states of a contact point.

use crate::path::events::{ContactStatus, transition};
use voussoir_core::law::Facet;
use voussoir_core::path::ContactEvent;

const FORWARD: ContactStatus = ContactStatus::Slides { forward: true };
const BACKWARD: ContactStatus = ContactStatus::Slides { forward: false };
const ALL: [ContactStatus; 6] =
    [ContactStatus::Sticks, ContactStatus::Open, FORWARD, BACKWARD, ContactStatus::Crushes, ContactStatus::Softens];

/// A point whose status does not change has no event.
#[test]
fn no_change_is_no_event() {
    ALL.iter().for_each(|status| assert_eq!(transition(*status, *status), None));
}

#[test]
fn every_change_is_an_event() {
    for before in ALL {
        for after in ALL.into_iter().filter(|after| *after != before) {
            assert!(transition(before, after).is_some(), "{before:?} {after:?}");
        }
    }
}

/// The event is named by what begins, except that sticking is named by what ends.
#[test]
fn events_are_named_by_what_begins() {
    let begun = |after| {
        ALL.into_iter().filter(move |before| *before != after).filter_map(move |before| transition(before, after))
    };
    assert!(begun(ContactStatus::Open).all(|event| event == ContactEvent::Opens));
    assert!(begun(ContactStatus::Crushes).all(|event| event == ContactEvent::Crushes));
    assert!(begun(ContactStatus::Softens).all(|event| event == ContactEvent::Softens));
    assert!(begun(FORWARD).all(|event| event == ContactEvent::SlipsForward));
    assert!(begun(BACKWARD).all(|event| event == ContactEvent::SlipsBackward));
}

/// An open point closes, a crushed or softened one unloads, a sliding one sticks.
#[test]
fn sticking_is_named_by_what_ends() {
    let ends = |before| transition(before, ContactStatus::Sticks).expect("an event");
    assert_eq!(ends(ContactStatus::Open), ContactEvent::Closes);
    assert_eq!([ContactStatus::Crushes, ContactStatus::Softens].map(ends), [ContactEvent::Unloads; 2]);
    assert_eq!([FORWARD, BACKWARD].map(ends), [ContactEvent::Sticks; 2]);
}

/// A facet t_t ≤ b is left along −t: ġ = −γ d with d_t > 0.
#[test]
fn the_sense_of_slip_is_opposite_to_friction() {
    let [positive, negative] = Facet::friction(0.3, 0.0, 0.0);
    assert_eq!(ContactStatus::of_facet(&positive), BACKWARD);
    assert_eq!(ContactStatus::of_facet(&negative), FORWARD);
    assert_eq!(ContactStatus::of_facet(&Facet::opening(0.0)), ContactStatus::Open);
    assert_eq!(ContactStatus::of_facet(&Facet::crushing(1.0)), ContactStatus::Crushes);
}
