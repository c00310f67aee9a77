//! The registry, and the conformance of every card.

use std::path::Path;
use voussoir::core::law::{BulkMaterial, Formulation, InterfaceLaw};
use voussoir::core::plugin::{Need, Parameter, PluginKind, Shape, audit, cards, cards_of};

/// Every kind of plug-in is there, no tag twice, every card complete, file = tag.
#[test]
fn every_card_is_complete() {
    assert_eq!(audit(), Vec::<String>::new());
    for card in cards() {
        assert!(!card.summary.is_empty() && !card.page.is_empty(), "{}", card.tag);
        let stem = Path::new(card.file).file_stem().expect("a file").to_string_lossy().into_owned();
        let folder = Path::new(card.file)
            .parent()
            .expect("a folder")
            .file_name()
            .expect("a name")
            .to_string_lossy()
            .into_owned();
        let named = [stem.clone(), format!("limit_{folder}"), format!("{folder}_path"), format!("results_{stem}")];
        assert!(named.contains(&card.tag.to_string()), "{} stands in {}", card.tag, card.file);
        for parameter in card.parameters {
            documented(card.tag, parameter);
        }
        if matches!(card.kind, PluginKind::InterfaceLaw | PluginKind::BulkMaterial | PluginKind::LimitSolver) {
            assert!(!card.sources.is_empty(), "{} names no source", card.tag);
        }
    }
}

fn documented(tag: &str, parameter: &Parameter) {
    assert!(!parameter.doc.is_empty(), "{tag}.{} is not explained", parameter.name);
    if let Need::Default(value) = parameter.need {
        let line = format!("x = {value}");
        assert!(line.parse::<toml::Table>().is_ok(), "{tag}.{}: default {value} is no TOML", parameter.name);
    }
}

/// A configuration of a law or material with a plausible number for every key that must be given.
fn sample(card: &voussoir::core::plugin::Card) -> serde_json::Value {
    let mut table = serde_json::Map::new();
    table.insert("law".into(), card.tag.into());
    for parameter in card.parameters {
        let value = match (&parameter.shape, parameter.need) {
            (_, Need::Optional(_)) if parameter.name != "friction" => continue,
            (Shape::Number(_, range), _) => {
                serde_json::json!(if range.contains(0.25) { 0.25 } else { range.min + 1.0 })
            }
            (Shape::Choice(words), _) => serde_json::json!(words[0]),
            (Shape::Boolean, _) => serde_json::json!(true),
            _ => continue,
        };
        if parameter.name != "dilatancy_angle" {
            table.insert(parameter.name.into(), value);
        }
    }
    serde_json::Value::Object(table)
}

/// Every interface law: a pure function with admissible origin, dissipative flow, that survives
/// serde unchanged and refuses unknown keys.
#[test]
fn every_interface_law_conforms() {
    let mut checked = 0;
    for card in cards_of(PluginKind::InterfaceLaw) {
        let table = sample(card);
        assert_eq!((card.check)(&without_tag(&table)), vec![], "{}", card.tag);
        let law: Box<dyn InterfaceLaw> = serde_json::from_value(table.clone()).expect("the sample is legal");
        let again: Box<dyn InterfaceLaw> =
            serde_json::from_value(serde_json::to_value(&law).expect("serialises")).expect("and back");
        assert_eq!(format!("{:?}", law.formulation()), format!("{:?}", law.formulation()));
        assert_eq!(format!("{:?}", law.formulation()), format!("{:?}", again.formulation()));
        // Laws with state are walked through by `state.rs`.
        let facets = law.formulation().facets().unwrap_or_default();
        assert_eq!(facets.is_empty(), matches!(law.formulation(), Formulation::Response(_)), "{}", card.tag);
        for facet in &facets {
            checked += 1;
            assert!(facet.bound >= 0.0, "{}: the stress-free joint is not admissible", card.tag);
            // Dissipation −t·ġ = γ t·d at every corner of the facet: d at least as steep as friction allows.
            let [a, d] = [facet.normal, facet.flow];
            assert!(a[1] == d[1] && d[0] >= a[0], "{}: flow {d:?} on facet {a:?} creates energy", card.tag);
            assert!(a.iter().chain(&d).all(|x| x.is_finite()));
        }
        let mut unknown = table.clone();
        unknown["no_such_key"] = 1.0.into();
        assert!(serde_json::from_value::<Box<dyn InterfaceLaw>>(unknown).is_err(), "{} accepts unknown keys", card.tag);
    }
    assert!(checked >= 10, "only {checked} facets were checked");
}

/// Every material: survives serde unchanged, refuses unknown keys, has a density.
#[test]
fn every_material_conforms() {
    for card in cards_of(PluginKind::BulkMaterial) {
        let table = sample(card);
        let material: Box<dyn BulkMaterial> = serde_json::from_value(table.clone()).expect("the sample is legal");
        let again: Box<dyn BulkMaterial> =
            serde_json::from_value(serde_json::to_value(&material).expect("serialises")).expect("and back");
        assert_eq!(material.density(), again.density());
        assert_eq!(material.deformability(), again.deformability());
        let mut unknown = table.clone();
        unknown["no_such_key"] = 1.0.into();
        assert!(serde_json::from_value::<Box<dyn BulkMaterial>>(unknown).is_err(), "{}", card.tag);
    }
}

fn without_tag(table: &serde_json::Value) -> serde_json::Value {
    let mut table = table.clone();
    table.as_object_mut().expect("a table").remove("law");
    table
}
