//! Keys: each key changes the behaviour of a plug-in, and a table that the card accepts gives a law with correct signs, or a
//! scene or load without mistakes.

use super::findings::Recorder;
use super::options::Options;
use super::plug_in::PlugIn;
use super::point::Point;
use super::random::random_step;
use super::samples::{own_check, samples_of};
use super::site::{Site, catalogue};
use super::subject::Subject;
use super::{assembly, facets, load, scene_space, sign, walk};
use serde_json::{Value as Json, json};
use voussoir_core::law::{Fields, PointContext};
use voussoir_core::plugin::{Card, Need, Parameter, PluginKind, Property, Sample, Shape};
use voussoir_core::random::Random;
use voussoir_study::config::default_table::default_of;

/// Steps of the walks by which two laws are compared, as multiples of the sample's size, with walks and steps of each.
const SIZES: [f64; 3] = [1.0, 10.0, 100.0];
const WALKS: usize = 8;
const STEPS: usize = 25;

/// Checks the keys of a plug-in with samples.
pub(super) fn check(recorder: &mut Recorder, card: &Card, _: &Options) {
    if !PlugIn::is_of(card.kind) {
        return;
    }
    let laws = samples_of(card);
    for (sample, table, _) in &laws {
        recorder.sample(sample);
        for (what, other) in accepted(card, table) {
            let Ok(law) = PlugIn::read(card.kind, &other) else { continue };
            let mut own = Recorder::new(card);
            is_sound(&mut own, card, sample, &law);
            let report = own.report();
            let first = report.findings.first();
            recorder.hold("ranges", first.is_none(), || {
                let (check, why) = first.map_or(("", ""), |finding| (finding.check, finding.what.as_str()));
                format!(
                    "the card accepts {what}, but the check `{check}` then fails: {why}; narrow a range or add a check"
                )
            });
        }
    }
    recorder.whole();
    for parameter in card.parameters {
        match changes(card, &laws, parameter) {
            Some(changed) => recorder.hold("keys", changed, || {
                format!("{} changes nothing: no {} of any sample", parameter.name, observed(card.kind))
            }),
            None => {
                recorder.leave_out(&format!("keys: no sample has a value of {} that can be changed", parameter.name))
            }
        }
    }
}

/// Returns the names of the quantities that the check of keys compares.
fn observed(kind: PluginKind) -> &'static str {
    match kind {
        PluginKind::Scene => "block or joint",
        PluginKind::LoadKind => "force or acceleration on the standard bridge",
        _ => "traction, stress, energy or stiffness",
    }
}

/// Returns true if some other value of a key changes the plug-in of some sample; `None` if no other value could be tried.
fn changes(card: &Card, laws: &[(Sample, Json, PlugIn)], parameter: &Parameter) -> Option<bool> {
    let mut tried = None;
    for (sample, table, _) in laws {
        let value = match (table.get(parameter.name), parameter.need) {
            (Some(value), _) => value.clone(),
            (None, Need::Default(text)) => default_of(text)?,
            (None, _) => continue,
        };
        let own = with(table, &[(parameter.name, value.clone())]);
        let Ok(law) = PlugIn::read(card.kind, &own) else { continue };
        let before = behaviour(&law, sample.size);
        for other in other_values(&parameter.shape, &value) {
            let table = with(table, &[(parameter.name, other)]);
            let Some(law) = read_accepted(card, &table) else { continue };
            let after = behaviour(&law, sample.size);
            let same =
                before.len() == after.len() && before.iter().zip(&after).all(|(a, b)| a.to_bits() == b.to_bits());
            if !same {
                return Some(true);
            }
            tried = Some(false);
        }
    }
    tried
}

fn with(table: &Json, keys: &[(&str, Json)]) -> Json {
    let mut table = table.clone();
    keys.iter().for_each(|(key, value)| table[*key] = value.clone());
    table
}

fn read_accepted(card: &Card, table: &Json) -> Option<PlugIn> {
    own_check(card, table).is_empty().then(|| PlugIn::read(card.kind, table).ok())?
}

/// Returns other values of a key within its range.
fn other_values(shape: &Shape, value: &Json) -> Vec<Json> {
    match shape {
        Shape::Number(_, range) => {
            let Some(own) = value.as_f64() else { return Vec::new() };
            let moved = [1.1 * own, 0.9 * own, 2.0 * own, 0.5 * own, own + 0.1, 1e3 + own];
            moved.into_iter().filter(|x| *x != own && range.contains(*x)).map(|x| json!(x)).collect()
        }
        Shape::Integer { min, max } => {
            let Some(own) = value.as_i64() else { return Vec::new() };
            [own + 1, own - 1].into_iter().filter(|x| (min..=max).contains(&x)).map(|x| json!(x)).collect()
        }
        Shape::Boolean => value.as_bool().map(|own| json!(!own)).into_iter().collect(),
        Shape::Choice(words) => words.iter().filter(|word| value != **word).map(|word| json!(word)).collect(),
        // Numbers in lists and tables have no single range; the check of the card decides.
        Shape::List { .. } | Shape::Tuple(_) | Shape::Table(_) | Shape::Either(_) | Shape::Tagged { .. } => {
            [1.01, 0.99].map(|factor| scaled(value, factor)).into_iter().filter(|other| other != value).collect()
        }
        Shape::Text | Shape::Reference(_) | Shape::Plugin(_) | Shape::Map(_) | Shape::Free => Vec::new(),
    }
}

/// Multiplies all numbers of a value by a factor.
fn scaled(value: &Json, factor: f64) -> Json {
    match value {
        Json::Number(number) if number.is_f64() => json!(number.as_f64().map(|x| factor * x)),
        Json::Array(entries) => entries.iter().map(|entry| scaled(entry, factor)).collect(),
        Json::Object(table) => table.iter().map(|(key, entry)| (key.clone(), scaled(entry, factor))).collect(),
        other => other.clone(),
    }
}

/// Returns the tables that the card accepts beside a sample: a number with the other sign, and two numbers of one quantity
/// exchanged.
fn accepted(card: &Card, table: &Json) -> Vec<(String, Json)> {
    let numbers: Vec<_> = card
        .parameters
        .iter()
        .filter_map(|parameter| match parameter.shape {
            Shape::Number(quantity, range) => {
                Some((parameter.name, quantity, range, table.get(parameter.name)?.as_f64()?))
            }
            _ => None,
        })
        .collect();
    let mut found = Vec::new();
    for (index, (name, quantity, range, value)) in numbers.iter().enumerate() {
        if *value != 0.0 && range.contains(-value) {
            found.push((format!("{name} = {}", -value), with(table, &[(name, json!(-value))])));
        }
        for (other, _, other_range, other_value) in numbers[index + 1..].iter().filter(|own| own.1 == *quantity) {
            if value != other_value && range.contains(*other_value) && other_range.contains(*value) {
                let keys = [(*name, json!(other_value)), (*other, json!(value))];
                found.push((format!("{name} = {other_value} with {other} = {value}"), with(table, &keys)));
            }
        }
    }
    found.retain(|(_, table)| own_check(card, table).is_empty());
    found
}

/// Checks a plug-in that the card accepts: a scene or load has no mistakes, a law has correct signs, and that no step creates energy if the card claims it.
fn is_sound(recorder: &mut Recorder, card: &Card, sample: &Sample, law: &PlugIn) {
    let point = match law {
        PlugIn::Joint(law) => {
            if let Some(own) = law.facets() {
                facets::check(recorder, card, &own);
            }
            law.response().map(Point::Joint)
        }
        PlugIn::Material(law) => {
            let density = law.density();
            recorder.hold("density", density.is_finite() && density >= 0.0, || format!("has a density of {density}"));
            let possible = law.elasticity().map_or(Ok(()), |elasticity| elasticity.check());
            recorder.hold("elasticity", possible.is_ok(), || format!("{possible:?}"));
            law.stress_update().map(Point::material)
        }
        PlugIn::Scene(scene) => {
            match scene.build_space(&catalogue()) {
                Some(Ok(built)) => scene_space::check(recorder, &built),
                Some(Err(_)) => {}
                None => scene.build(&catalogue()).iter().for_each(|built| assembly::check(recorder, built)),
            }
            None
        }
        PlugIn::Load(load) => {
            let site = Site::standard();
            if let Ok(placed) = load.place(&site.place()) {
                load::is_sound(recorder, &placed, &site.assembly);
            }
            None
        }
    };
    let Some(point) = point else { return };
    let Some(stiffness) = walk::measure(recorder, &point, sample) else { return };
    let subject = Subject { card, sample, point: point.clone(), again: point, stiffness };
    match law {
        PlugIn::Joint(law) => sign::check_joint(recorder, &subject, law.as_ref()),
        _ => sign::check_material(recorder, &subject),
    }
    let worst = -1e-9 * stiffness * sample.size * sample.size;
    each_step(&subject.point, sample.size, false, &mut |said| {
        let creates = said.is_some_and(|(_, dissipated)| dissipated < worst);
        recorder
            .hold("dissipation", !creates || !card.claims(Property::DISSIPATIVE), || "a step creates energy".into());
    });
}

/// Walks through gaps or strains, and passes the force and the dissipated energy of each step; `None` if the law refuses it.
/// If time passes, the steps take 1 s to 32 years, and the fields that every study knows change.
fn each_step(point: &Point, size: f64, passes: bool, see: &mut dyn FnMut(Option<([f64; 6], f64)>)) {
    let mut random = Random::new(29);
    for _ in 0..WALKS {
        let (mut old, mut new) = (point.untouched(), vec![0.0; point.state_size()]);
        let (mut at, mut fields) = ([0.0; 6], [("temperature", 280.0), ("water_level", 0.0)]);
        for _ in 0..STEPS {
            let before = (at, fields);
            random_step(&mut random, &mut at, point.components(), size);
            let said = if passes {
                let time = random.power(0.0, 9.0);
                fields = [("temperature", random.between(260.0, 320.0)), ("water_level", random.between(0.0, 100.0))];
                let ends = [Fields::new(&before.1), Fields::new(&fields)];
                let context = PointContext::default().during([before.0[0], before.0[1]], time, ends);
                point.update_in(&context, &at, &old, &mut new)
            } else {
                point.update(&at, &old, &mut new)
            };
            see(said.as_ref().ok().map(|said| (said.force, said.dissipated)));
            if said.is_err() {
                break;
            }
            old.copy_from_slice(&new);
        }
    }
}

/// Returns numbers that describe all that a plug-in does: two plug-ins with equal numbers behave alike.
fn behaviour(law: &PlugIn, size: f64) -> Vec<f64> {
    let mut numbers = Vec::new();
    let point = match law {
        PlugIn::Joint(law) => {
            for facet in law.facets().into_iter().flatten() {
                numbers.extend(facet.normal.iter().chain(&facet.flow).chain([&facet.bound]));
            }
            numbers.extend(law.stiffness().into_iter().flatten());
            let response = law.response();
            numbers.extend(response.iter().filter_map(|own| own.tensile_softening()).flatten());
            response.map(Point::Joint)
        }
        PlugIn::Material(law) => {
            numbers.push(law.density());
            numbers.extend(law.elasticity().iter().flat_map(|own| own.stiffness()).flatten());
            let update = law.stress_update();
            numbers.extend(update.iter().map(|own| own.largest_length()));
            update.map(Point::material)
        }
        PlugIn::Scene(_) | PlugIn::Load(_) => {
            numbers.extend(law.says().bytes().map(f64::from));
            None
        }
    };
    for (scale, passes) in SIZES.iter().flat_map(|scale| [(scale, false), (scale, true)]) {
        let Some(point) = &point else { break };
        each_step(point, scale * size, passes, &mut |said| match said {
            Some((force, dissipated)) => numbers.extend(force.iter().chain([&dissipated])),
            None => numbers.push(-1.0),
        });
    }
    numbers
}
