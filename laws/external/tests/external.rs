//! Behaviours of a shared library, compiled here from C: numbers against closed forms, and every way to be refused.

use serde_json::{Value, json};
use std::path::PathBuf;
use std::process::Command;
use std::sync::LazyLock;
use voussoir_core::law::{BulkMaterial, InterfaceLaw, PointContext, UpdateContext, UpdateFailure};
use voussoir_core::plugin::{PluginKind, card};

/// The library, compiled once and allowed; `None` where there is no C compiler.
static LIBRARY: LazyLock<Option<PathBuf>> = LazyLock::new(|| {
    let library = compiled("behaviours")?;
    voussoir_external::allow(&library).expect("it is there");
    Some(library)
});

/// With `VOUSSOIR_TEST_CFLAGS=-fsanitize=address,undefined` and `LD_PRELOAD="$(gcc -print-file-name=libasan.so)
/// $(gcc -print-file-name=libubsan.so)"` the library is watched by GCC's sanitizers.
fn compiled(name: &str) -> Option<PathBuf> {
    let library = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("lib{name}.so"));
    let source = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/behaviours.c");
    let flags = std::env::var("VOUSSOIR_TEST_CFLAGS").unwrap_or_default();
    let mut command = Command::new("cc");
    command.args(flags.split_whitespace()).args(["-O1", "-shared", "-fPIC", "-o"]).arg(&library).arg(source);
    let status = command.status();
    match status {
        Ok(status) => {
            assert!(status.success(), "the C compiler refuses the behaviours of the tests");
            Some(library)
        }
        Err(error) => {
            eprintln!("not tested: there is no C compiler (cc: {error})");
            None
        }
    }
}

const STIFFNESS: [f64; 2] = [1e10, 4e9];
const STRENGTH: f64 = 2e5;
const ENERGY: f64 = 20.0;

fn bond(behaviour: &str) -> Option<Value> {
    let library = LIBRARY.as_ref()?;
    Some(json!({ "law": "external", "library": library, "behaviour": behaviour, "properties": {
        "NormalStiffness": STIFFNESS[0], "ShearStiffness": STIFFNESS[1], "Strength": STRENGTH, "FractureEnergy": ENERGY
    } }))
}

/// What the card of the law says of a table, all in one text.
fn complaints(kind: PluginKind, table: &Value) -> String {
    let mut own = table.clone();
    own.as_object_mut().expect("a table").remove("law");
    let card = card(kind, "external").expect("it is registered");
    (card.check)(&own).iter().map(|(key, what)| format!("{key}: {what}\n")).collect()
}

/// Opened on the bilinear law, back on the secant with the state that was kept, and pressed.
#[test]
fn a_bond_of_a_library_is_its_closed_form() {
    let Some(table) = bond("BilinearBond") else { return };
    assert_eq!(complaints(PluginKind::InterfaceLaw, &table), "");
    let law: Box<dyn InterfaceLaw> = serde_json::from_value(table).expect("a law");
    assert_eq!(law.stiffness(), Some(STIFFNESS));
    let response = law.response().expect("it answers");
    assert_eq!(response.state_names()[0], "Damage [-]");
    let (mut old, mut new) = (vec![0.0; response.state_size()], vec![9.0; response.state_size()]);
    let end = 2.0 * ENERGY / STRENGTH;
    let onset = STRENGTH / STIFFNESS[0];
    let falling = |gap: f64| STRENGTH * (end - gap) / (end - onset);
    let (far, back) = (8e-5, 3e-5);
    let steps = [
        ([1e-5, 0.0], -STIFFNESS[0] * 1e-5),
        ([far, 0.0], -falling(far)),
        ([back, 0.0], -falling(far) * back / far),
        ([-1e-6, 0.0], STIFFNESS[0] * 1e-6),
        ([1.2e-4, 0.0], -falling(1.2e-4)),
    ];
    for (gap, expected) in steps {
        let point = response.respond_point(gap, &PointContext::default(), &old, &mut new).expect("a step");
        assert!(
            (point.traction[0] - expected).abs() <= 1e-9 * STRENGTH,
            "{} for {expected} at {gap:?}",
            point.traction[0]
        );
        assert!(point.stored >= 0.0 && point.dissipated >= 0.0, "{point:?}");
        // The tangent is the derivative.
        let h = 1e-10;
        for j in 0..2 {
            let mut ends = [[0.0; 2]; 2];
            for (end, sign) in ends.iter_mut().zip([1.0, -1.0]) {
                let mut moved = gap;
                moved[j] += sign * h;
                *end = response
                    .respond_point(moved, &PointContext::default(), &old, &mut vec![0.0; old.len()])
                    .expect("a step")
                    .traction;
            }
            for (i, (ahead, back)) in ends[0].iter().zip(ends[1]).enumerate() {
                let slope = (ahead - back) / (2.0 * h);
                assert!(
                    (slope - point.tangent[i][j]).abs() <= 1e-4 * STIFFNESS[0],
                    "{i}{j}: {slope} {:?}",
                    point.tangent
                );
            }
        }
        std::mem::swap(&mut old, &mut new);
    }
    assert_eq!(
        response.respond_point([f64::NAN, 0.0], &PointContext::default(), &old, &mut new),
        Err(UpdateFailure::NotFinite)
    );
}

/// A behaviour that keeps its elastic strain, as MFront's implicit ones do: `elastic` while that follows the strain, and
/// `inelastic` where it lags behind, though no other number of its state says so.
#[test]
fn an_elastic_strain_that_follows_the_strain_is_no_change() {
    let Some(library) = LIBRARY.as_ref() else { return };
    let table = json!({ "law": "external", "library": library, "behaviour": "Yielding", "density": 2200.0,
        "properties": { "Modulus": 1e9, "Strength": 1e6 } });
    assert_eq!(complaints(PluginKind::BulkMaterial, &table), "");
    let law: Box<dyn BulkMaterial> = serde_json::from_value(table).expect("a law");
    let update = law.stress_update().expect("it answers");
    let (mut old, mut new) = (vec![0.0; update.state_size()], vec![0.0; update.state_size()]);
    let steps =
        [(3e-4, 3e5, "elastic"), (9.1e-4, 9.1e5, "elastic"), (2e-3, 1e6, "inelastic"), (1.7e-3, 7e5, "elastic")];
    for (along, stress, branch) in steps {
        let strain = [along, -0.3 * along, 0.1 * along, 0.2 * along, 0.0, 0.4 * along];
        let point = update.update_point(&strain, &UpdateContext::of_length(1.0), &old, &mut new).expect("a step");
        assert!((point.stress[0] - stress).abs() <= 1e-9 * stress, "{} for {stress}", point.stress[0]);
        assert_eq!(point.branch.name, branch, "at {along}");
        std::mem::swap(&mut old, &mut new);
    }
}

/// Three different shear moduli come back in our order, of engineering strains; elasticity and update agree.
#[test]
fn tensors_of_a_library_are_turned_into_ours() {
    let Some(library) = LIBRARY.as_ref() else { return };
    let moduli = [3e9, 1e9, 2e9, 4e9]; // along, xy, xz, yz
    let table = json!({ "law": "external", "library": library, "behaviour": "Crystal", "density": 2200.0, "properties": {
        "Modulus": moduli[0], "Shear12": moduli[1], "Shear13": moduli[2], "Shear23": moduli[3]
    } });
    assert_eq!(complaints(PluginKind::BulkMaterial, &table), "");
    let law: Box<dyn BulkMaterial> = serde_json::from_value(table).expect("a law");
    let update = law.stress_update().expect("it answers");
    let old = vec![0.0; update.state_size()];
    let mut new = old.clone();
    let strain = [1e-4, -2e-4, 3e-4, 4e-4, 5e-4, 6e-4];
    let point = update.update_point(&strain, &UpdateContext::of_length(1.0), &old, &mut new).expect("a step");
    let stiffness = law.elasticity().expect("it deforms").stiffness();
    // Ours: xx, yy, zz, xy, yz, zx.
    let along = [moduli[0], moduli[0], moduli[0], moduli[1], moduli[3], moduli[2]];
    let mut work = 0.0;
    for i in 0..6 {
        assert!((point.stress[i] - along[i] * strain[i]).abs() < 1e-3, "{:?}", point.stress);
        for (j, stiffness) in stiffness[i].iter().enumerate() {
            let expected = if i == j { along[i] } else { 0.0 };
            assert!((stiffness - expected).abs() < 1.0 && (point.tangent[i][j] - expected).abs() < 1.0, "{i}{j}");
        }
        work += 0.5 * along[i] * strain[i] * strain[i];
    }
    assert!((point.stored - work).abs() < 1e-12 * work && point.dissipated == 0.0, "{} {work}", point.stored);
}

/// In a process of its own a behaviour gives the same numbers, refuses with the same words, and takes nobody with it when it crashes.
#[test]
#[cfg(unix)]
fn an_isolated_behaviour_crashes_alone() {
    let Some(table) = bond("BilinearBond") else { return };
    voussoir_external::isolate_with(env!("CARGO_BIN_EXE_external_worker").into(), Vec::new());
    let law = |behaviour: &str, isolate: bool| -> Box<dyn InterfaceLaw> {
        let mut own = table.clone();
        (own["behaviour"], own["isolate"]) = (behaviour.into(), isolate.into());
        assert_eq!(complaints(PluginKind::InterfaceLaw, &own), "");
        serde_json::from_value(own).expect("a law")
    };
    let (here, apart) = (law("FragileBond", false), law("FragileBond", true));
    assert_eq!(here.stiffness(), apart.stiffness());
    let (here, apart) = (here.response().expect("a response"), apart.response().expect("a response"));
    assert_eq!(here.state_names(), apart.state_names());
    let mut states = [0, 1].map(|_| [vec![0.0; here.state_size()], vec![9.0; here.state_size()]]);
    for gap in [[1e-5, 0.0], [8e-5, 1e-6], [2e-4, 0.0], [3e-5, -1e-6], [-1e-6, 0.0], [1e-2, 0.0]] {
        let [one, other] = &mut states;
        let [a, b] = [(&here, one), (&apart, other)].map(|(response, [old, new])| {
            let answered = response.respond_point(gap, &PointContext::default(), old, new);
            if answered.is_ok() {
                std::mem::swap(old, new);
            }
            answered
        });
        assert_eq!(a, b, "{gap:?}");
        assert_eq!(states[0][0], states[1][0]);
    }
    let crashing = law("CrashingBond", true).response().expect("a response");
    let step = |gap: f64| {
        crashing.respond_point([gap, 0.0], &PointContext::default(), &states[0][0], &mut states[1][0].clone())
    };
    assert!(step(1e-6).is_ok());
    let Err(UpdateFailure::Law(why)) = step(9e-5) else { panic!("it crashes") };
    assert!(why.contains("has ended: signal"), "{why}");
    assert_eq!(step(1e-6), Err(UpdateFailure::Law("the process of the external behaviour has ended")));
    // The next case starts another.
    assert!(law("CrashingBond", true).response().is_some());
    let mut misspelt = table.clone();
    (misspelt["behaviour"], misspelt["isolate"]) = ("BilinearBnod".into(), true.into());
    assert!(complaints(PluginKind::InterfaceLaw, &misspelt).contains("no behaviour called BilinearBnod"));
}

/// What is not allowed is not opened; what does not fit is named with its key; a step that fails says the library's words.
#[test]
fn whatever_does_not_fit_is_refused_by_name() {
    let Some(table) = bond("BilinearBond") else { return };
    let joint = PluginKind::InterfaceLaw;
    let with = |key: &str, value: Value| {
        let mut own = table.clone();
        own[key] = value;
        own
    };
    let other = compiled("not_allowed").expect("compiled before");
    let says = |table: &Value, words: &str| {
        let said = complaints(joint, table);
        assert!(said.contains(words), "\"{words}\" is not in \"{said}\"");
    };
    says(&with("library", json!(other)), "is not allowed");
    says(&with("library", json!("nowhere.so")), "library: cannot read nowhere.so");
    says(&with("behaviour", json!("Missing")), "behaviour: the library has no behaviour called Missing");
    says(&with("behaviour", json!("OldBond")), "version 0 of the generic interface; version 1 is read");
    says(&with("behaviour", json!("OtherBond")), "compiled for the interface Aster");
    says(&with("behaviour", json!("Crystal")), "Crystal is no cohesive zone model");
    let mut misspelt = table["properties"].clone();
    misspelt["Strenght"] = misspelt.as_object_mut().expect("a table").remove("Strength").expect("it is there");
    says(&with("properties", misspelt), "properties.Strenght: the behaviour has no such entry; did you mean Strength?");
    says(&with("properties", json!({})), "properties: the behaviour needs NormalStiffness, ShearStiffness, Strength");
    says(&with("variables", json!({ "Moisture": 0.1 })), "variables.Moisture: the behaviour has no such entry");
    let fragile = with("behaviour", json!("FragileBond"));
    assert_eq!(complaints(joint, &fragile), "");
    let law: Box<dyn InterfaceLaw> = serde_json::from_value(fragile).expect("a law");
    let response = law.response().expect("it answers");
    let old = vec![0.0; response.state_size()];
    let at = |gap| match response.respond_point(gap, &PointContext::default(), &old, &mut vec![0.0; old.len()]) {
        Err(UpdateFailure::Law(why)) => why,
        other => panic!("{other:?}"),
    };
    assert_eq!(at([2e-3, 0.0]), "the external behaviour could not integrate the step: opened too far");
    assert_eq!(at([2e-4, 0.0]), "the external behaviour calls its result unreliable");
    assert_eq!(at([1e-6, 2e-4]), "the external behaviour gives a number that is not finite");
    // What is not allowed was never made into a law that answers.
    let law: Box<dyn InterfaceLaw> = serde_json::from_value(with("library", json!(other))).expect("a table");
    assert!(law.response().is_none() && law.stiffness().is_none());
}

/// A library that breaks the interface is found out and refused: numbers that are not finite, codes that do not exist, writes
/// beyond its buffers and into its input.
#[test]
fn a_hostile_library_is_found_out() {
    let Some(table) = bond("BilinearBond") else { return };
    for (behaviour, words) in [
        ("NanForce", "not finite"),
        ("InfTangent", "not finite"),
        ("NanState", "not finite"),
        ("InfEnergy", "not finite"),
        ("LongForces", "writes outside of its buffers"),
        ("EarlyForces", "writes outside of its buffers"),
        ("LongState", "writes outside of its buffers"),
        ("LongTangent", "writes outside of its buffers"),
        ("LongMessage", "writes outside of its buffers"),
        ("FullMessage", "could not integrate the step: xxx"),
        ("RawMessage", "could not integrate the step:  [\u{fffd}"),
        ("WritesStart", "changes numbers that it may only read"),
        ("WritesProperties", "changes numbers that it may only read"),
        ("WritesGradients", "changes numbers that it may only read"),
        ("StrangeCode", "could not integrate the step"),
        ("LeastCode", "could not integrate the step"),
    ] {
        let mut own = table.clone();
        own["behaviour"] = behaviour.into();
        assert_eq!(complaints(PluginKind::InterfaceLaw, &own), "", "{behaviour}");
        let law: Box<dyn InterfaceLaw> = serde_json::from_value(own).expect("a law");
        let response = law.response().expect("it answers");
        let old = vec![0.0; response.state_size()];
        let step =
            |gap: f64| response.respond_point([gap, 0.0], &PointContext::default(), &old, &mut vec![0.0; old.len()]);
        let before = step(1e-6);
        assert!(before.is_ok(), "{behaviour}: {before:?}");
        match step(9e-5) {
            Err(UpdateFailure::Law(why)) => assert!(why.contains(words), "{behaviour}: {why}"),
            other => panic!("{behaviour}: {other:?}"),
        }
        assert_eq!(old, vec![0.0; old.len()], "{behaviour}");
        // The failed step leaves no trace.
        assert_eq!(step(1e-6), before, "{behaviour}");
    }
    let mut own = table.clone();
    own["behaviour"] = "WritesPointers".into();
    let law: Box<dyn InterfaceLaw> = serde_json::from_value(own).expect("a law");
    let response = law.response().expect("it answers");
    assert!(
        response
            .respond_point(
                [9e-5, 0.0],
                &PointContext::default(),
                &vec![0.0; response.state_size()],
                &mut vec![0.0; response.state_size()]
            )
            .is_ok()
    );
}

/// The description that a library gives of itself is checked before it is called.
#[test]
fn wrong_words_of_a_library_are_refused() {
    let Some(library) = LIBRARY.as_ref() else { return };
    for (behaviour, words) in [
        ("NullName", "InternalStateVariables"),
        ("OddType", "of a type that is not known, -1"),
        ("HugeType", "of a type that is not known, 2147483647"),
        ("HugeState", "at most 10000 are read"),
        ("NoState", "its tangent at rest is not stiff"),
        ("NoFunction", "has no function NoFunction_PlaneStrain"),
        ("NoCounts", "MaterialProperties"),
        ("NewerBond", "has version 65535 of the generic interface"),
        ("bad\0name", "behaviour"),
    ] {
        let table = json!({ "law": "external", "library": library, "behaviour": behaviour });
        let said = complaints(PluginKind::InterfaceLaw, &table);
        assert!(said.contains(words), "{behaviour}: {said}");
    }
}

/// A loop without an end and a jump to nowhere end the other process only.
#[test]
#[cfg(unix)]
fn an_isolated_behaviour_has_limited_time() {
    let Some(table) = bond("BilinearBond") else { return };
    voussoir_external::isolate_with(env!("CARGO_BIN_EXE_external_worker").into(), Vec::new());
    for (behaviour, words) in [
        ("Endless", "does not answer within 10s"),
        ("Closes", "has ended: signal"),
        ("LongState", "outside of its buffers"),
    ] {
        let mut own = table.clone();
        (own["behaviour"], own["isolate"]) = (behaviour.into(), true.into());
        let law: Box<dyn InterfaceLaw> = serde_json::from_value(own).expect("a law");
        let response = law.response().expect("it answers");
        let old = vec![0.0; response.state_size()];
        let Err(UpdateFailure::Law(why)) =
            response.respond_point([9e-5, 0.0], &PointContext::default(), &old, &mut old.clone())
        else {
            panic!("{behaviour}")
        };
        assert!(why.contains(words), "{behaviour}: {why}");
    }
}
