//! Every law, with the samples of its card: serde, facets, claims. A new law edits nothing here.

use voussoir::core::law::{BulkMaterial, InterfaceLaw};
use voussoir::core::plugin::{Capability, PluginKind, Property};
use voussoir_tests::samples::samples;

/// Every interface law: a pure function with admissible origin, dissipative flow, that survives
/// serde unchanged and refuses unknown keys.
#[test]
fn every_interface_law_conforms() {
    let mut checked = 0;
    for (card, _, table) in samples(PluginKind::InterfaceLaw) {
        let law: Box<dyn InterfaceLaw> = serde_json::from_value(table.clone()).expect("the sample is legal");
        let again: Box<dyn InterfaceLaw> =
            serde_json::from_value(serde_json::to_value(&law).expect("serialises")).expect("and back");
        let says = |law: &dyn InterfaceLaw| format!("{:?} {:?}", law.facets(), law.response());
        assert_eq!(says(&*law), says(&*law), "{} is not pure", card.tag);
        assert_eq!(says(&*law), says(&*again), "{}", card.tag);
        let facets = law.facets();
        assert_eq!(facets.is_some(), card.offers(Capability::FACETS), "{}", card.tag);
        for facet in facets.iter().flatten() {
            checked += 1;
            assert!(facet.bound >= 0.0, "{}: the stress-free joint is not admissible", card.tag);
            // Dissipation −t·ġ = γ t·d at every corner of the facet: d at least as steep as friction allows.
            let [a, d] = [facet.normal, facet.flow];
            let dissipates = a[1] == d[1] && d[0] >= a[0];
            assert!(dissipates || !card.claims(Property::DISSIPATIVE), "{}: flow {d:?} on {a:?}", card.tag);
            assert!(a == d || !card.claims(Property::ASSOCIATED), "{}: flow {d:?} on {a:?}", card.tag);
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
    for (card, _, table) in samples(PluginKind::BulkMaterial) {
        let material: Box<dyn BulkMaterial> = serde_json::from_value(table.clone()).expect("the sample is legal");
        let again: Box<dyn BulkMaterial> =
            serde_json::from_value(serde_json::to_value(&material).expect("serialises")).expect("and back");
        assert_eq!(material.density(), again.density());
        assert_eq!(material.elasticity(), again.elasticity());
        let mut unknown = table.clone();
        unknown["no_such_key"] = 1.0.into();
        assert!(serde_json::from_value::<Box<dyn BulkMaterial>>(unknown).is_err(), "{}", card.tag);
    }
}
