//! Every file and picture shows the units and words of keys from the schema of the owning plug-in.

use serde_json::{Map, Value as Json, json};
use std::collections::{BTreeSet, HashSet};
use std::path::{Path, PathBuf};
use voussoir::config::common_parameters;
use voussoir::config::join;
use voussoir::config::{KeyMeaning, key_meaning};
use voussoir::core::plugin::{Parameter, Quantity, Shape, candidates, cards};
use voussoir::kinds::{RunRequest, kind, kinds, read_source};
use voussoir::solve::Unobserved;
use voussoir::study::{StudyFile, StudySource, SweptKeys, beside, kind_of, meaning_in, study_keys};
use voussoir_tests::study;

/// A number of the schema: its path below a parameter, a value that contains it, and its description.
struct Number {
    path: Vec<String>,
    value: Json,
    name: &'static str,
    doc: &'static str,
    quantity: Quantity,
}

impl Number {
    fn below(mut self, segment: &str, value: impl FnOnce(Json) -> Json) -> Self {
        self.path.insert(0, segment.into());
        self.value = value(self.value);
        self
    }
}

/// Returns every number of a table with these keys; `tag` is the word that chooses them.
fn numbers_of_table(parameters: &'static [Parameter], tag: Option<(&str, &str)>) -> Vec<Number> {
    let of = |parameter: &'static Parameter| {
        let table = move |value: Json| {
            let own = [(parameter.name.to_string(), value)].into_iter();
            let tag = tag.map(|(key, word)| (key.to_string(), Json::from(word)));
            Json::Object(own.chain(tag).collect::<Map<_, _>>())
        };
        numbers(parameter.shape, parameter).into_iter().map(move |number| number.below(parameter.name, table))
    };
    parameters.iter().flat_map(of).collect()
}

/// Returns every number of a shape that belongs to a parameter.
fn numbers(shape: Shape, parameter: &'static Parameter) -> Vec<Number> {
    let one = |value: Json, quantity| {
        vec![Number { path: Vec::new(), value, name: parameter.name, doc: parameter.doc, quantity }]
    };
    match shape {
        Shape::Number(quantity, _) => one(1.5.into(), quantity),
        Shape::Integer { .. } => one(1.into(), Quantity::Ratio),
        Shape::List { of, .. } => {
            let entry = |number: Number| number.below("0", |value| json!([value]));
            numbers(*of, parameter).into_iter().map(entry).collect()
        }
        Shape::Tuple(entries) => {
            let of = |(index, (_, shape)): (usize, &(&str, Shape))| {
                let list = move |value: Json| {
                    (0..entries.len()).map(|place| if place == index { value.clone() } else { json!(0.0) }).collect()
                };
                let entry = move |number: Number| number.below(&index.to_string(), list);
                numbers(*shape, parameter).into_iter().map(entry)
            };
            entries.iter().enumerate().flat_map(of).collect()
        }
        Shape::Map(of) => {
            let named = |number: Number| number.below("my 1.5", |value| json!({ "my 1.5": value }));
            numbers(*of, parameter).into_iter().map(named).collect()
        }
        Shape::Either(shapes) => shapes.iter().flat_map(|shape| numbers(*shape, parameter)).collect(),
        Shape::Table(parameters) => numbers_of_table(parameters, None),
        Shape::Tagged { key, variants } => {
            variants.iter().flat_map(|own| numbers_of_table(own.parameters, Some((key, own.tag)))).collect()
        }
        Shape::Plugin(kind) => {
            let of = |tag: &'static str, parameters| numbers_of_table(parameters, Some((kind.tag_key(), tag)));
            let all = candidates(kind).into_iter();
            let common = all.clone().flat_map(|card| {
                let own = |name: &str| card.parameters.iter().any(|parameter| parameter.name == name);
                of(card.tag, common_parameters(kind)).into_iter().filter(move |number| !own(&number.path[0]))
            });
            all.clone().flat_map(|card| of(card.tag, card.parameters)).chain(common).collect()
        }
        _ => Vec::new(),
    }
}

/// The lookup gives each number of each plug-in the unit and the text of the schema.
#[test]
fn every_number_of_every_plugin_has_the_unit_and_the_words_of_its_schema() {
    let own_keys = kinds().into_iter().filter_map(|entry| entry.kind.file_keys());
    let (mut count, mut met) = (0, HashSet::new());
    for keys in own_keys.chain([study_keys()]) {
        for number in numbers_of_table(keys, None) {
            let key = number.path.iter().fold(String::new(), |key, segment| join(&key, segment));
            let meaning = key_meaning(keys, &|name| number.value.get(name), &key);
            let meaning = meaning.unwrap_or_else(|| panic!("{key} is unknown in {}", number.value));
            let unit = Some(number.quantity.unit()).filter(|unit| !unit.is_empty());
            assert_eq!((meaning.unit(), meaning.name, meaning.doc), (unit, number.name, number.doc), "{key}");
            assert!(meaning.used && !meaning.tag, "{key}");
            assert_words(&key, &meaning);
            met.insert((number.name, number.doc, number.quantity.unit()));
            count += 1;
        }
    }
    for card in cards() {
        for number in numbers_of_table(card.parameters, None) {
            let known = met.contains(&(number.name, number.doc, number.quantity.unit()));
            assert!(known, "{:?} of {} was not looked up", number.path, card.tag);
        }
    }
    assert!(count > 500, "{count} numbers");
}

/// Asserts that words come from the schema: a clause of its text, the name of the parameter, or both.
fn assert_words(key: &str, meaning: &KeyMeaning) {
    let words = meaning.words();
    let name = meaning.name.replace('_', " ");
    let clause = words.strip_prefix(&name).map(|rest| rest.trim_start_matches([',', ' ']));
    let entries = meaning.entries.iter().map(|entry| format!(", {entry}")).collect::<String>();
    let clause = clause.unwrap_or(&words);
    let clause = clause.strip_suffix(entries.trim_start_matches([',', ' '])).unwrap_or(clause);
    let clause = clause.trim_end_matches([',', ' ']);
    assert!(!words.is_empty() && meaning.doc.contains(clause), "{key}: {words}");
    assert!(meaning.words_in_place().ends_with(&words) && meaning.title().starts_with(&meaning.words_in_place()));
}

/// If several plug-ins have keys with one name, the owner decides the unit, and a key in another place has no effect.
#[test]
fn the_owner_of_a_key_decides_its_unit() {
    let load = |load: Json| json!({ "stages": [{ "name": "live", "loads": [load] }] });
    let unit = |tables: &Json, key: &str| {
        key_meaning(study_keys(), &|name| tables.get(name), key).map(|meaning| meaning.unit())
    };
    let vehicle = load(json!({ "kind": "vehicle", "at": 1.0 }));
    let axles = load(json!({ "kind": "axles", "at": 0.5, "positions": [0.0], "forces": [1.0] }));
    for key in ["stages.0.loads.0.at", "stages.live.loads.0.at"] {
        assert_eq!((unit(&vehicle, key), unit(&axles, key)), (Some(Some("m")), Some(None)), "{key}");
    }
    assert_eq!(unit(&axles, "stages.0.loads.0.positions"), Some(Some("m")));
    assert_eq!(unit(&axles, "stages.0.loads.0.forces.0"), Some(Some("N")));
    let scene = |thickness: Json| json!({ "scene": { "scene": "arch", "thickness": thickness, "springing": 30.0 } });
    let (number, table) = (scene(json!(0.6)), scene(json!({ "springing": 0.8, "crown": 0.5 })));
    assert_eq!(unit(&number, "scene.thickness"), Some(Some("m")));
    assert_eq!(unit(&table, "scene.thickness"), Some(None), "a table has no unit");
    assert_eq!(unit(&table, "scene.thickness.springing"), Some(Some("m")));
    assert_eq!(unit(&table, "scene.springing"), Some(Some("deg")));
    let joint = |law: &str| json!({ "joints": { "dry": { "law": law } } });
    assert_eq!(unit(&joint("coulomb"), "joints.dry.friction"), Some(None));
    assert_eq!(unit(&joint("mohr_coulomb"), "joints.dry.compressive_strength"), Some(Some("Pa")));
    assert_eq!(unit(&json!({}), "factors.compressive_strength"), Some(None));
    assert_eq!(unit(&json!({}), "solver.stop.displacement"), Some(Some("m")));
    for unknown in
        ["rise", "scene.no_such", "no.such.key", "stages.0.at", "joints.dry.no_such", "scene.thickness.at", ""]
    {
        assert_eq!(unit(&table, unknown), None, "{unknown}");
    }
}

/// Files and pictures of a study.
pub struct Written(Vec<(String, Vec<u8>)>);

impl Written {
    pub fn of(text: &str) -> Self {
        Self::of_files(text, &|name| Err(format!("there is no file {name}")))
    }

    /// The same for a study that names files.
    pub fn of_files(text: &str, read: &dyn Fn(&str) -> Result<String, String>) -> Self {
        let source = StudySource::parse_with(text, "study.toml", &[], read).and_then(read_source);
        let study = source.unwrap_or_else(|wrong| panic!("{wrong}"));
        let request = RunRequest { wanted: (0..study.count()).collect(), jobs: 1, ..RunRequest::default() };
        Written(study.run(&request, &Unobserved).files)
    }

    pub fn text(&self, name: &str) -> String {
        let found = self.0.iter().find(|(own, _)| own == name);
        let (_, bytes) = found.unwrap_or_else(|| panic!("no {name}"));
        String::from_utf8_lossy(bytes).into_owned()
    }

    /// Returns the row of the calculation record with these words.
    fn record(&self, words: &str) -> String {
        let (page, start) = (self.text("report.html"), format!("<tr><th scope=\"row\">{words}</th><td>"));
        let (_, page) = page.split_once("Inputs, assumptions and sources").expect("the record");
        let row = page.split(&start).nth(1).unwrap_or_else(|| panic!("no row \"{words}\""));
        row.split("</td>").next().unwrap_or_default().to_string()
    }
}

fn arch(thickness: &str, rest: &str) -> String {
    format!(
        "name = \"arch\"\n[scene]\nscene = \"arch\"\nprofile = {{ shape = \"segmental\", span = 9.42, rise = 2.99 }}\n\
         thickness = {thickness}\nwidth = 5.81\nvoussoirs = 15\nends = \"bonded\"\nmaterial = \"stone\"\njoint = \"dry\"\n\
         [materials.stone]\nlaw = \"rigid\"\ndensity = 2200.0\n[joints.dry]\nlaw = \"mohr_coulomb\"\nfriction = 0.6\n\
         compressive_strength = \"10 MPa\"\n[[stages]]\nname = \"dead\"\ngravity = 9.81\n[[stages]]\nname = \"live\"\n\
         until = \"collapse\"\nloads = [{{ kind = \"point\", span_fraction = 0.25, force = [0.0, -1000.0] }}]\n{rest}"
    )
}

#[test]
fn the_thickness_at_the_springings_is_a_length() {
    let sweep = "[output]\nwriters = [\"results_csv\", \"results_parquet\", \"report\", \"figures\"]\n[sweep]\n\
                 \"scene.thickness.springing\" = { list = [0.6, 0.8] }\n";
    let written = Written::of(&arch("{ crown = 0.5, springing = 0.8 }", sweep));
    let name = "scene.thickness.springing [m]";
    assert!(written.text("results.csv").starts_with(&format!("id,variant,{name},status")));
    assert!(written.text("results.parquet").contains(name));
    assert!(written.text("figures/sweep.svg").contains("thickness at both springings [m]"));
    assert!(written.text("figures/case-0000-scene.svg").contains("springing = 0.6 m"));
    assert_eq!(written.record("thickness: thickness at both springings"), "0.6 m");
    assert!(written.text("report.html").contains("<td>0.6, 0.8 m</td>"));
}

#[test]
fn a_partial_factor_is_a_ratio() {
    let rest = "[factors]\ncompressive_strength = 1.5\n[output]\nsensitivities = true\n[sweep]\n\
                \"factors.compressive_strength\" = { list = [1.0, 1.5, 2.0] }\n";
    let written = Written::of(&arch("0.6", rest));
    assert!(written.text("results.csv").starts_with("id,variant,factors.compressive_strength,status"));
    let (words, chart) = ("partial factor on the crushing strength of joints", written.text("figures/sweep.svg"));
    assert!(chart.contains(&format!(">\n{words}\n<")) || chart.contains(&format!(">{words}<")), "{chart}");
    assert!(!chart.contains("[Pa]"));
    assert_eq!(written.record(words), "1");
    assert_eq!(written.record("thickness of the ring"), "0.6 m");
    assert_eq!(written.record("dry: crushing strength of the joint"), "10 MPa");
    // Derivatives have the units of the owners too.
    let table = written.text("sensitivities.csv");
    let unit = |key: &str| {
        let row =
            table.lines().find(|row| row.split(',').nth(2) == Some(key)).unwrap_or_else(|| panic!("{key}: {table}"));
        row.split(',').nth(3).unwrap_or_default().to_string()
    };
    let keys = [
        "factors.compressive_strength",
        "joints.dry.compressive_strength",
        "scene.thickness",
        "materials.stone.density",
    ];
    assert_eq!(keys.map(unit), ["", "Pa", "m", "kg/m3"]);
}

#[test]
fn the_place_of_a_vehicle_is_a_length() {
    let span = |span: f64, rise: f64| {
        format!(
            "{{ profile = {{ shape = \"segmental\", span = {span:?}, rise = {rise:?} }}, thickness = 0.44, voussoirs = 8 }}"
        )
    };
    let text = format!(
        "name = \"bridge\"\n[scene]\nscene = \"bridge\"\nwidth = 4.0\nmaterial = \"brick\"\njoint = \"mortar\"\n\
         spans = [{}, {}]\npiers = [{{ height = 2.0, width = 1.2, courses = 2 }}]\n[scene.fill]\ncover = 0.4\n\
         density = 1800.0\nfriction_angle = 35.0\ndispersion = {{ law = \"uniform\", angle = 26.6 }}\n\
         resistance = {{ law = \"fill_pressure\", passive_factor = 0.33 }}\n[materials.brick]\nlaw = \"rigid\"\n\
         density = 2100.0\n[joints.mortar]\nlaw = \"coulomb_associated\"\nfriction = 0.6\n[vehicles.bogie]\n\
         axles = [{{ at = 0.0, force = \"100 kN\", length = 0.3 }}, {{ at = 1.8, force = \"100 kN\", length = 0.3 }}]\n\
         [[stages]]\nname = \"dead\"\ngravity = 9.81\n[[stages]]\nname = \"live\"\nuntil = \"collapse\"\n\
         loads = [{{ kind = \"vehicle\", vehicle = \"bogie\", at = 2.0 }}]\n[sweep]\n\
         \"stages.1.loads.0.at\" = {{ list = [2.0, 3.0] }}\n\"vehicles.bogie.axles.1.at\" = {{ list = [1.8, 2.0] }}\n\
         \"vehicles.bogie.axles.0.force\" = {{ list = [100000.0] }}\n",
        span(5.0, 1.25),
        span(6.0, 1.5)
    );
    let written = Written::of(&text);
    let columns = "stages.1.loads.0.at [m],vehicles.bogie.axles.1.at [m],vehicles.bogie.axles.0.force [N]";
    assert!(written.text("results.csv").starts_with(&format!("id,variant,{columns},status")));
    assert_eq!(written.record("live: vehicle: at, x of the vehicle's origin"), "2 m");
    assert_eq!(written.record("bogie: axle 2: at, distance of the axle from the vehicle's origin"), "1.8 m");
    assert_eq!(written.record("fill: dispersion: angle, from the vertical"), "26.6 deg");
    assert!(!written.text("report.html").contains("span fraction"));
}

/// Variants and lockstep axes have the units of their owners, also for one key with different owners in different
/// variants.
#[test]
fn variants_and_lockstep_have_units_of_their_owners() {
    let sweep = "[sweep.zip]\n\"scene.thickness\" = { list = [0.6, 0.8] }\n\"joints.dry.compressive_strength\" = \
                 { list = [\"10 MPa\", \"12 MPa\"] }\n[[variants]]\nname = \"stuck\"\nset = { \"joints.dry\" = { law = \
                 \"unilateral\", tangential = \"stuck\" } }\n[[variants]]\nname = \"crushing\"\nset = { }\n";
    let keys = study(&arch("0.6", sweep)).swept_keys();
    assert_eq!(keys.column("scene.thickness"), "scene.thickness [m]");
    assert_eq!(keys.title("joints.dry.compressive_strength"), "crushing strength of the joint [Pa]");
    let values = json!({ "scene.thickness": 0.6, "joints.dry.compressive_strength": "10 MPa" });
    let line = keys.text(values.as_object().expect("a table"));
    assert_eq!(
        line.split(", ").collect::<BTreeSet<_>>(),
        BTreeSet::from(["thickness = 0.6 m", "compressive_strength = 10 MPa"])
    );
    let mixed = "[sweep]\n\"stages.live.loads.0.from\" = { list = [0.2, 0.3] }\n[[variants]]\nname = \"strip\"\nset = { \
                 \"stages.live.loads\" = [{ kind = \"strip\", from = 0.1, to = 0.5, pressure = 1000.0 }] }\n";
    let study = study(&arch("0.6", mixed));
    assert_eq!(study.swept_keys().unit("stages.live.loads.0.from"), None);
    assert_eq!(
        meaning_in(&study.cases[0].resolved, "stages.live.loads.0.pressure").and_then(|meaning| meaning.unit()),
        Some("Pa")
    );
}

/// TOML files below a folder.
fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    for path in std::fs::read_dir(folder).expect("studies").flatten().map(|entry| entry.path()) {
        match path.extension() {
            _ if path.is_dir() => files(&path, found),
            Some(end) if end == "toml" => found.push(path),
            _ => {}
        }
    }
}

/// The schema knows every key that a study of the repository sweeps, or that its kind varies.
#[test]
fn every_key_that_a_study_of_the_repository_varies_is_known() {
    let mut all = Vec::new();
    files(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../studies/cases"), &mut all);
    let (mut studies, mut keys) = (0, 0);
    for path in all {
        let text = std::fs::read_to_string(&path).expect("a study");
        let source = StudySource::parse_with(&text, "study.toml", &[], &beside(&path));
        let Ok(source) = source else { continue };
        if kind(kind_of(&source.root)).is_none_or(|kind| kind.file_keys().is_some()) {
            continue;
        }
        let sweep = StudyFile::read(source).and_then(StudyFile::study_unchecked);
        let sweep = sweep.unwrap_or_else(|wrong| panic!("{}: {wrong}", path.display()));
        let swept: SweptKeys = sweep.swept_keys();
        for key in sweep.keys() {
            assert!(swept.first(&key).is_some(), "{}: {key}", path.display());
            keys += 1;
        }
        let table = &sweep.outline.table;
        let one = table.get("parameter").and_then(Json::as_str).into_iter();
        let several = table.get("parameters").and_then(Json::as_array).into_iter().flatten().filter_map(Json::as_str);
        let first = sweep.case(0).unwrap_or_else(|| panic!("{}: no case", path.display()));
        for key in one.chain(several) {
            assert!(meaning_in(&first.resolved, key).is_some(), "{}: {key}", path.display());
            keys += 1;
        }
        studies += 1;
    }
    assert!(studies > 20 && keys > 20, "{studies} studies, {keys} keys");
}
