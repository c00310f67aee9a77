//! Systematic forgery: every number and every word of results.json changed one at a time, cases deleted and doubled,
//! several entries changed together. `verify` finds each forgery, in every kind of result.
//!
//! The short form tries a fixed sample of each result; `FORGERY=all cargo test -p voussoir-tests --release --test files
//! forgery` tries every entry.

use super::forged_claims::FREE;
use serde_json::{Value, json};
use voussoir::core::random::Random;
use voussoir::kinds::read_study;
use voussoir::results::CaseResult;
use voussoir::solve_case;
use voussoir::study::Study;
use voussoir::verify::case::verify_case;
use voussoir_tests::written::{findings, results};
use voussoir_tests::{Arch, changed, crushing, first_case, friction};

/// Words of results, by meaning: any other word of the same row is a forgery.
pub const WORDS: [&[&str]; 7] = [
    &["collapse", "stands", "unbounded", "no_equilibrium", "limit_point", "stalled"],
    &["three_hinge", "four_hinge", "five_hinge", "rocking", "sliding", "crushing", "twisting", "separating", "mixed"],
    &["intrados", "extrados"],
    &["opens", "closes", "slips", "sticks", "reverses"],
    &["limit_chain", "limit_conic", "event_path", "newton_path"],
    &["associated", "own"],
    &["target", "requested", "load_control", "joint_lost", "none"],
];

/// Collects every entry below `value` together with a forged one.
pub fn forgeries(value: &Value, path: &str, out: &mut Vec<(String, Value)>) {
    if FREE.iter().any(|free| path.ends_with(free)) {
        return;
    }
    match value {
        Value::Number(number) if number.is_f64() => {
            let x = number.as_f64().expect("a float");
            out.push((path.into(), json!(if x == 0.0 { 1e-6 } else { x * (1.0 + 1e-6) })));
        }
        Value::Number(number) => out.push((path.into(), json!(number.as_u64().map_or(1, |n| n + 1)))),
        Value::String(word) => {
            let row = WORDS.iter().find(|row| row.contains(&word.as_str()));
            match row {
                Some(row) => out.extend(row.iter().filter(|w| *w != word).map(|w| (path.to_string(), json!(w)))),
                None => out.push((path.into(), json!(format!("{word}x")))),
            }
        }
        Value::Bool(yes) => out.push((path.into(), json!(!yes))),
        Value::Null => out.push((path.into(), json!(1.0))),
        Value::Array(items) => {
            items.iter().enumerate().for_each(|(i, item)| forgeries(item, &format!("{path}/{i}"), out));
            if !items.is_empty() {
                out.push((path.into(), json!(items[1..])));
                out.push((path.into(), json!([items, &items[..1]].concat())));
            }
        }
        Value::Object(map) => {
            let slashes = |key: &str| key.replace('~', "~0").replace('/', "~1");
            map.iter().for_each(|(key, item)| forgeries(item, &format!("{path}/{}", slashes(key)), out));
        }
    }
}

/// Returns a reproducible sample.
fn sample<T>(mut all: Vec<T>, count: usize) -> Vec<T> {
    if std::env::var("FORGERY").is_ok_and(|form| form == "all") {
        return all;
    }
    let mut random = Random::new(14);
    let mut out = Vec::new();
    while out.len() < count && !all.is_empty() {
        out.push(all.swap_remove(random.whole(0, all.len() - 1)));
    }
    out
}

/// Returns true for the head of the results and of a case, without long lists: the short form tries all of these
/// entries.
fn short(path: &str) -> bool {
    let long =
        ["/field/", "/ray/", "/motion/", "/events/", "/curve/", "/displacements/", "/thrust_line/", "/joint_states/"];
    !long.iter().any(|list| path.contains(list)) && !path.contains("/lower_proof/") && !path.contains("/yielded/")
}

fn each_is_found(name: &str, original: &Value, find: &dyn Fn(&Value) -> Vec<String>) {
    assert_eq!(find(original), Vec::<String>::new(), "{name}: untouched");
    let mut all = Vec::new();
    forgeries(original, "", &mut all);
    let possible = all.len();
    let (head, lists): (Vec<_>, Vec<_>) = all.into_iter().partition(|(path, _)| short(path));
    let tried: Vec<_> = sample(head, 150).into_iter().chain(sample(lists, 60)).collect();
    assert!(tried.len() > 25, "{name}: only {} forgeries", tried.len());
    println!("{name}: {} of {possible} forgeries of single entries are tried", tried.len());
    for (path, forged) in tried {
        let mut changed = original.clone();
        *changed.pointer_mut(&path).expect("the path exists") = forged.clone();
        assert!(!find(&changed).is_empty(), "{name}: {path} changed to {forged} was not found");
    }
    let cases = original["cases"].as_array().expect("cases");
    let with = |cases: Vec<Value>| {
        let mut changed = original.clone();
        changed["cases"] = json!(cases);
        changed
    };
    assert!(!find(&with(vec![])).is_empty(), "{name}: all cases were deleted");
    assert!(!find(&with([&cases[..], &cases[..1]].concat())).is_empty(), "{name}: a case was doubled");
    if cases.len() > 1 {
        assert!(!find(&with(cases[1..].to_vec())).is_empty(), "{name}: a case was deleted");
        let mut swapped = cases.clone();
        swapped.swap(0, 1);
        assert!(!find(&with(swapped)).is_empty(), "{name}: cases were exchanged");
        // The whole answer of another case with the label of this one.
        let mut foreign = cases.clone();
        foreign[0] = cases[1].clone();
        for key in ["id", "case_hash", "variant", "parameters", "seconds"] {
            foreign[0][key] = cases[0][key].clone();
        }
        // Two widths may have the same motion: then the answers are the same.
        let same = foreign[0] == cases[0];
        assert!(same || !find(&with(foreign)).is_empty(), "{name}: another case's answer");
    }
}

/// Asserts that every change of the results of a study is found.
pub fn forged(name: &str, text: &str) {
    let (study, original): (Study, Value) = results(text);
    each_is_found(name, &original, &|changed| findings(&study, changed));
}

const ELASTIC: &str = "[scene.mesh]\nelements = [1, 2]\n[materials.stone]\nlaw = \"elastic\"\nyoung_modulus = 5e9\n\
                       poisson_ratio = 0.2\ndensity = 2200.0\n";

/// Returns a ring of seven voussoirs on a path, with or without a support that moves first.
pub fn path(solver: &str, kinematics: &str, settled: bool) -> String {
    let settle = "[[stages]]\nname = \"settle\"\nsettlement = [{ support = \"right\", displacement = [0.005, 0.0] }]\n";
    format!(
        "name = \"path\"\n[scene]\nscene = \"arch\"\nprofile = {{ shape = \"segmental\", span = 4.0, rise = 1.0 }}\n\
         thickness = 0.3\nwidth = 1.0\nvoussoirs = 7\nends = \"jointed\"\nmaterial = \"stone\"\njoint = \"dry\"\n{ELASTIC}\
         [joints.dry]\nlaw = \"coulomb\"\nfriction = 0.7\n[solver]\nsolver = \"{solver}\"\nkinematics = \"{kinematics}\"\n\
         [output]\ncurve = true\n[[stages]]\nname = \"dead\"\ngravity = 9.81\n{}[[stages]]\nname = \"live\"\n\
         until = \"collapse\"\nloads = [{{ kind = \"point\", span_fraction = 0.3, force = [0.0, -1000.0] }}]\n",
        if settled { settle } else { "" }
    )
}

/// Every forged result of limit analysis is found: collapse, unbounded, no equilibrium, with strengths.
#[test]
fn limit_results() {
    for (name, arch) in [
        ("collapse", Arch::default()),
        ("unbounded", Arch { rise: 1.19, ..Arch::default() }),
        ("no equilibrium", Arch { thickness: 0.12, ends: "jointed", ..Arch::default() }),
        ("crushing", Arch { joint: crushing(0.6, 10e6), ..Arch::default() }),
        ("sliding", Arch { joint: friction(0.3), ..Arch::default() }),
    ] {
        let swept = format!("{}[sweep]\n\"scene.width\" = {{ list = [1.0, 2.0] }}\n", arch.study());
        forged(name, &swept);
    }
}

/// Returns a study of a small wall with a corner that an acceleration or a pressure pushes, after its own weight.
fn space(friction: f64, law: &str, gravity: &str, load: &str) -> String {
    format!(
        "name = \"space\"\n[scene]\nscene = \"masonry_wall\"\nblock = [2.0, 1.0, 0.5]\ncourses = 2\nblocks = 1\n\
         corner = {{ blocks = 1 }}\nmaterial = \"stone\"\njoint = \"dry\"\n[materials.stone]\nlaw = \"rigid\"\n\
         density = 2000.0\n[joints.dry]\nlaw = \"{law}\"\nfriction = {friction:?}\n[[stages]]\nname = \"weight\"\n\
         gravity = {gravity}\n[[stages]]\nname = \"push\"\nuntil = \"collapse\"\nloads = [{load}]\n\
         [sweep]\n\"joints.dry.friction\" = {{ list = [{friction:?}, {:?}] }}\n",
        friction + 0.1
    )
}

/// Every forged result in space is found: collapse by an acceleration and by a pressure, with flow that is read as
/// associated, unbounded, no equilibrium, bounds by points, and flow of the laws.
#[test]
fn space_results() {
    let push = "{ kind = \"body\", acceleration = [9.81, 0.0, 0.0] }";
    let pressure = "{ kind = \"pressure\", block = \"x.1.0\", face = [-1, 0, 0], value = 1e4 }";
    let down = "{ kind = \"body\", acceleration = [0.0, 0.0, -9.81] }";
    for (name, friction, law, gravity, load) in [
        ("collapse in space", 0.5, "coulomb_associated", "9.81", push),
        ("pressure in space", 0.5, "coulomb", "9.81", pressure),
        ("unbounded in space", 0.5, "coulomb_associated", "9.81", down),
        ("no equilibrium in space", 0.2, "coulomb_associated", "[6.0, 0.0, -9.81]", push),
    ] {
        forged(name, &space(friction, law, gravity, load));
    }
    let own = space(0.5, "coulomb", "9.81", push) + "[solver]\nsolver = \"limit_sequential\"\n";
    forged("own flow in space", &own);
    let mortar = "mohr_coulomb\"\ncohesion = 2e3\ntensile_strength = 1e3\ncompressive_strength = \"2 MPa";
    forged("strengths in space", &space(0.5, mortar, "9.81", push));
}

/// Every forged result of a path is found: from event to event, and Newton's with small and with finite displacements,
/// each also with a support that moves.
#[test]
fn path_results() {
    for (solver, kinematics, settled) in [
        ("event_path", "small", false),
        ("event_path", "small", true),
        ("newton_path", "small", false),
        ("newton_path", "finite", false),
        ("newton_path", "finite", true),
    ] {
        forged(&format!("{solver}, {kinematics}, settled: {settled}"), &path(solver, kinematics, settled));
    }
}

/// Each violated residual of a path's last state is found by the proofs alone, without solving again. `run` uses the
/// same function.
#[test]
fn violated_residuals_are_found_without_solving() {
    let mut seen = std::collections::BTreeSet::new();
    for (solver, kinematics) in [("event_path", "small"), ("newton_path", "finite")] {
        let case = first_case(&path(solver, kinematics, false));
        let result = solve_case(&case);
        assert_eq!(verify_case(&case, &result), Vec::<String>::new(), "{kinematics}");
        let field = result.proof.field.clone().expect("a field");
        let pressed = |i: &usize| field[*i].force[0];
        let most = (0..field.len()).max_by(|a, b| pressed(a).total_cmp(&pressed(b))).expect("a force");
        let middle = result.path.displacements.as_ref().map_or(0, Vec::len) / 2;
        let mut violate = |change: &dyn Fn(&mut CaseResult)| {
            let mut changed = result.clone();
            change(&mut changed);
            let found = verify_case(&case, &changed);
            assert!(!found.is_empty(), "{kinematics}");
            seen.extend(found.iter().filter_map(|why| why.split(' ').next().map(String::from)));
            seen.extend(found);
        };
        let force = |r: &mut CaseResult, i: usize, by: [f64; 2]| {
            let entry = &mut r.proof.field.as_mut().expect("a field")[most].force;
            entry[i] = by[0] * entry[i] + by[1] * field[most].force[0];
        };
        violate(&|r| force(r, 0, [1.0 + 1e-6, 0.0]));
        violate(&|r| force(r, 1, [1.0, 2.0]));
        violate(&|r| force(r, 0, [f64::NAN, 0.0]));
        for by in [-1e-3, 1e-3] {
            violate(&|r| r.path.displacements.as_mut().expect("displacements")[middle].displacement[1] += by);
        }
        violate(&|r| r.proof.field_factor = r.proof.field_factor.map(|factor| factor * (1.0 + 1e-6)));
        if kinematics == "small" {
            violate(&|r| r.proof.motion.as_mut().expect("a motion")[middle].velocity[2] += 1.0);
            violate(&|r| r.proof.motion.iter_mut().flatten().flat_map(|e| &mut e.velocity).for_each(|v| *v *= 1.01));
        }
    }
    for class in [
        "violate equilibrium",
        "violate the strength",
        "violate contact without penetration",
        "violate contact, which presses",
        "directions that their laws do not allow",
        "must do the work 1",
    ] {
        assert!(seen.iter().any(|why| why.contains(class)), "{class}: {seen:?}");
    }
}

/// Forgeries that are consistent with each other are found: another load with field, velocities and curve scaled
/// together, a collapse under other names, the factor of the last stage, the verdict.
#[test]
fn forgeries_that_were_once_confirmed() {
    let (study, original) = results(&path("newton_path", "finite", false));
    let entries = original["cases"][0].as_object().expect("a case").clone();
    let scaled = |value: &Value, by: f64| -> Value {
        fn all(value: &Value, by: f64) -> Value {
            match value {
                Value::Number(n) if n.is_f64() => json!(n.as_f64().expect("a float") * by),
                Value::Array(items) => items.iter().map(|item| all(item, by)).collect(),
                other => other.clone(),
            }
        }
        all(value, by)
    };
    // A state of the path below its peak, which its equilibrium alone would confirm.
    let text = changed(&path("newton_path", "finite", false), "until = \"collapse\"", "factor = 20.0");
    let (_, below) = results(&text);
    let mut forged = original.clone();
    for key in ["field", "displacements", "thrust_line"] {
        forged["cases"][0][key] = below["cases"][0][key].clone();
    }
    for key in ["load_factor", "field_factor"] {
        forged["cases"][0][key] = json!(20.0);
    }
    forged["cases"][0]["stages"][1]["factor"] = json!(20.0);
    assert!(!findings(&study, &forged).is_empty(), "a state below the peak");
    let mut forged = original.clone();
    for key in ["load_factor", "field_factor", "curve", "field"].into_iter().filter(|key| entries.contains_key(*key)) {
        forged["cases"][0][key] = scaled(&original["cases"][0][key], 1.01);
    }
    assert!(!findings(&study, &forged).is_empty(), "load, field and curve scaled together");
    for status in ["limit_point", "stands", "no_equilibrium", "unbounded", "collapse", "stalled"] {
        if original["cases"][0]["status"] == status {
            continue;
        }
        let mut forged = original.clone();
        forged["cases"][0]["status"] = json!(status);
        forged["cases"][0]["stages"][1]["status"] = json!(status);
        assert!(!findings(&study, &forged).is_empty(), "{status}");
    }
}

/// Every forged result of driven points is found.
#[test]
fn point_results() {
    let name = "point_cap_uniaxial.toml";
    let place = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../studies/cases").join(name);
    let text = std::fs::read_to_string(place).expect("a study of points");
    let study = read_study(&text, name, &[]).unwrap_or_else(|wrong| panic!("{wrong}"));
    let wanted = (0..study.count()).collect();
    let output =
        study.run(&voussoir::kinds::RunRequest { wanted, jobs: 1, ..Default::default() }, &voussoir::solve::Unobserved);
    let (_, bytes) = output.files.iter().find(|(name, _)| name == "results.json").expect("results");
    let original: Value = serde_json::from_slice(bytes).expect("JSON");
    each_is_found("point", &original, &|changed| match study.verify(&changed.to_string()) {
        Ok(found) => found.findings.into_iter().map(|(_, why)| why).collect(),
        Err(why) => vec![why],
    });
}

/// Every forged result of `compare` is found.
#[test]
fn compare_results() {
    let text = format!(
        "kind = \"compare\"\n{}[[variants]]\nname = \"dry\"\n[[variants]]\nname = \"slippery\"\nset = {{ \
         \"joints.dry.friction\" = 0.35 }}\n",
        Arch { joint: friction(0.6), ..Arch::default() }.study()
    );
    forged("compare", &text);
}

/// A bridge whose fill has weight, spreads loads and resists, with partial factors.
pub const BRIDGE: &str = "name = \"bridge\"\n[scene]\nscene = \"bridge\"\nwidth = 3.0\nmaterial = \"stone\"\njoint = \"dry\"\n\
    spans = [{ profile = { shape = \"segmental\", span = 3.0, rise = 0.75 }, thickness = 0.25, voussoirs = 9 }]\n\
    [scene.fill]\ncover = 0.3\ndensity = 1800.0\nfriction_angle = 30.0\n\
    dispersion = { law = \"boussinesq\", angle = 30.0 }\nresistance = { law = \"fill_pressure\" }\n\
    [materials.stone]\nlaw = \"rigid\"\ndensity = 2200.0\n[joints.dry]\nlaw = \"mohr_coulomb\"\nfriction = 0.6\n\
    compressive_strength = 3e6\n[factors]\ncompressive_strength = 1.5\nloads = { live = 1.3 }\n\
    [[stages]]\nname = \"dead\"\ngravity = 9.81\n[[stages]]\nname = \"live\"\nuntil = \"collapse\"\n\
    loads = [{ kind = \"vehicle\", vehicle = \"cs454_single\", at = 0.8 }]\n";

/// Every forged result of a bridge with fill and partial factors is found, alone and as the worst place of an envelope.
#[test]
fn bridge_and_envelope_results() {
    forged("bridge", BRIDGE);
    let moved = "kind = \"envelope\"\nenvelope = { parameter = \"stages.1.loads.0.at\", from = 0.3, to = 1.5, scan = 3, \
                 tolerance = 0.3, directions = \"forward\" }\n";
    forged("envelope", &format!("{moved}{BRIDGE}"));
}

/// Returns a study that optimises the friction for the greatest load.
pub fn optimum() -> String {
    format!(
        "kind = \"optimise\"\noptimise = {{ parameter = \"joints.dry.friction\", from = 0.3, to = 0.6, goal = \"maximise\", \
         scan = 3, tolerance = 0.3 }}\n{}",
        Arch { joint: friction(0.6), ..Arch::default() }.study()
    )
}

/// Every forged result of an optimisation is found.
#[test]
fn optimise_results() {
    forged("optimise", &optimum());
}
