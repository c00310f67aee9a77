//! Laws of joints: facets, tractions from gaps, and their agreement.

use super::findings::Recorder;
use super::options::Options;
use super::plug_in::PlugIn;
use super::point::Point;
use super::samples::samples_of;
use super::subject::Subject;
use super::walk;
use super::{cone, energy, facets, outputs, sign, softening, units};
use voussoir_core::law::InterfaceLaw;
use voussoir_core::plugin::{Capability, Card, PluginKind, Sample};

/// Checks every sample of a law of joints; does nothing for other plug-ins.
pub(super) fn check(recorder: &mut Recorder, card: &Card, options: &Options) {
    if card.kind != PluginKind::InterfaceLaw {
        return;
    }
    for (sample, table, law) in samples_of(card) {
        recorder.sample(&sample);
        let PlugIn::Joint(law) = law else { continue };
        let other = units::other_units(recorder, card, &table);
        check_sample(recorder, (card, &sample), law.as_ref(), other.as_ref(), options);
    }
}

fn check_sample(
    recorder: &mut Recorder,
    (card, sample): (&Card, &Sample),
    law: &dyn InterfaceLaw,
    other: Option<&PlugIn>,
    options: &Options,
) {
    let (own, response) = (law.facets(), law.response());
    for (given, capability) in [(own.is_some(), Capability::FACETS), (response.is_some(), Capability::RESPONSE)] {
        recorder.hold("capabilities", given == card.offers(capability), || {
            let word = if given { "gives" } else { "does not give" };
            format!("{word} {}, which is not what its card says", capability.words)
        });
    }
    recorder.hold("capabilities", own.is_some() || response.is_some(), || {
        "gives neither facets nor tractions from gaps".into()
    });
    if let Some(own) = &own {
        facets::check(recorder, card, own);
    }
    cone::check(recorder, card, own.as_deref(), law.cone());
    let Some(response) = response else { return };
    let written = serde_json::to_value(law).ok().and_then(|table| PlugIn::read(card.kind, &table).ok());
    let again = match &written {
        Some(PlugIn::Joint(again)) => again.response(),
        _ => None,
    };
    let point = Point::Joint(response.clone());
    let Some(stiffness) = walk::measure(recorder, &point, sample) else { return };
    let again = Point::Joint(again.unwrap_or(response.clone()));
    let subject = Subject { card, sample, point, again, stiffness };
    walk::check(recorder, &subject, options);
    sign::check_joint(recorder, &subject, law);
    energy::check(recorder, &subject);
    softening::check(recorder, &subject, response.as_ref());
    if let (Some(own), Some(k)) = (&own, law.stiffness()) {
        facets::against_response(recorder, &subject, own, k);
    }
    let there = match other {
        Some(PlugIn::Joint(other)) => other.response().map(Point::Joint),
        _ => None,
    };
    if let Some(there) = &there {
        units::check(recorder, &subject, there);
    }
    outputs::check(recorder, &subject, there.as_ref());
}
