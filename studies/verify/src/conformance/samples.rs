//! The card itself, and its samples as tables: they are legal, are read back unchanged, and unknown or missing keys are
//! refused.

use super::findings::Recorder;
use super::options::Options;
use super::plug_in::PlugIn;
use serde_json::Value as Json;
use voussoir_core::plugin::{Card, Need, Parameter, PluginKind, Sample, Shape};
use voussoir_study::config::default_table::default_of;

/// Returns true if a card belongs to a law.
pub(super) fn is_law(card: &Card) -> bool {
    matches!(card.kind, PluginKind::InterfaceLaw | PluginKind::BulkMaterial)
}

/// Returns a TOML table as a plug-in's configuration; `None` if it is not valid TOML.
pub(super) fn table(card: &Card, keys: &str) -> Option<Json> {
    let keys: toml::Table = keys.parse().ok()?;
    let mut value = serde_json::to_value(keys).ok()?;
    value[card.kind.tag_key()] = card.tag.into();
    Some(value)
}

/// Returns the mistakes that the card's own check finds in a table.
pub(super) fn own_check(card: &Card, table: &Json) -> Vec<(String, String)> {
    let mut keys = table.clone();
    keys.as_object_mut().and_then(|keys| keys.shift_remove(card.kind.tag_key()));
    (card.check)(&keys)
}

/// Returns every sample with its plug-in; [`check`] reports samples that cannot be read.
pub(super) fn samples_of(card: &Card) -> Vec<(Sample, Json, PlugIn)> {
    let read = |sample: &Sample| {
        let table = table(card, sample.table)?;
        let law = PlugIn::read(card.kind, &table).ok()?;
        Some((*sample, table, law))
    };
    card.samples.iter().filter_map(read).collect()
}

/// Checks the card, and its samples as tables.
pub(super) fn check(recorder: &mut Recorder, card: &Card, _: &Options) {
    recorder.hold("card", !card.summary.is_empty() && !card.page.is_empty(), || "has no summary or no page".into());
    for parameter in card.parameters {
        documented(recorder, parameter);
    }
    if !PlugIn::is_of(card.kind) {
        return;
    }
    recorder.hold("card", !is_law(card) || !card.sources.is_empty(), || "names no source of its equations".into());
    recorder.hold("card", !card.samples.is_empty(), || "has no sample: nothing can be checked".into());
    for sample in card.samples {
        recorder.sample(sample);
        check_sample(recorder, card, sample);
    }
}

fn documented(recorder: &mut Recorder, parameter: &Parameter) {
    let Parameter { name, doc, shape, need } = parameter;
    recorder.hold("card", !doc.is_empty(), || format!("{name} is not explained"));
    recorder.hold("units", !matches!(shape, Shape::Free), || {
        format!("{name} may be anything: give it a shape, and its numbers a unit")
    });
    if let Need::Default(value) = need {
        recorder.hold("card", default_of(value).is_some(), || format!("the default {value} of {name} is no TOML"));
    }
}

fn check_sample(recorder: &mut Recorder, card: &Card, sample: &Sample) {
    let Some(table) = table(card, sample.table) else {
        return recorder.fail("samples", "the sample is no TOML".into());
    };
    let law = match PlugIn::read(card.kind, &table) {
        Ok(law) => law,
        Err(why) => return recorder.fail("samples", format!("the sample cannot be read: {why}")),
    };
    let wrong = own_check(card, &table);
    recorder.hold("samples", wrong.is_empty(), || format!("the card's own check refuses the sample: {wrong:?}"));
    let names: Vec<&str> = card.parameters.iter().map(|parameter| parameter.name).collect();
    for (key, _) in table.as_object().into_iter().flatten().filter(|(key, _)| *key != card.kind.tag_key()) {
        recorder.hold("samples", names.contains(&key.as_str()), || format!("{key} is not among the card's parameters"));
    }
    let again = law.write().and_then(|written| PlugIn::read(card.kind, &written));
    let same = again.as_ref().is_ok_and(|again| again.says() == law.says());
    recorder.hold("round_trip", same, || {
        format!("written and read again it is {:?}, not {}", again.map(|again| again.says()), law.says())
    });
    recorder.hold("purity", law.says() == law.says(), || "two equal calls give different results".into());
    let mut unknown = table.clone();
    unknown["no_such_key"] = 1.0.into();
    recorder.hold("unknown_keys", PlugIn::read(card.kind, &unknown).is_err(), || {
        "accepts a key that it does not know: #[serde(deny_unknown_fields)] is missing".into()
    });
    for parameter in card.parameters {
        check_need(recorder, card, &table, parameter);
    }
}

/// A missing key is refused if it is required, and is replaced by its default otherwise.
fn check_need(recorder: &mut Recorder, card: &Card, table: &Json, parameter: &Parameter) {
    let mut without = table.clone();
    without.as_object_mut().and_then(|table| table.shift_remove(parameter.name));
    match parameter.need {
        Need::Required => recorder.hold("defaults", PlugIn::read(card.kind, &without).is_err(), || {
            format!("is read without {}, which the card calls required", parameter.name)
        }),
        Need::Default(value) => {
            let with = default_of(value).map(|default| {
                let mut with = table.clone();
                with[parameter.name] = default;
                with
            });
            let says = |table: &Json| PlugIn::read(card.kind, table).map(|law| law.says());
            let [without, with] = [Some(&without), with.as_ref()].map(|table| table.map(says));
            recorder.hold("defaults", without.as_ref().is_some_and(Result::is_ok) && without == with, || {
                format!("without {} it is not the same as with the card's default {value}", parameter.name)
            });
        }
        Need::Optional(_) => recorder.hold("defaults", PlugIn::read(card.kind, &without).is_ok(), || {
            format!("is not read without {}, which the card calls optional", parameter.name)
        }),
    }
}
