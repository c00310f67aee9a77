//! Mutated surveys (CSV), drawings and claims of reports.

use super::mutation::scramble;
use super::studies::refused;
use super::worker::{Input, phase};
use std::path::PathBuf;
use voussoir::core::random::Random;
use voussoir::kinds::{RunRequest, read_source_beside};
use voussoir::solve::Unobserved;
use voussoir::study::StudySource;
use voussoir::study::drawing::{Corner, Drawing, Polyline};

const SURVEYS: [&str; 3] = [
    "intrados_x,intrados_y,extrados_x,extrados_y\n0,0,-0.5,0.5\n1.5,0.75,1.5,1.25\n3,0,3.5,0.5\n",
    "# surveyed in May\ncurve;x [mm];y [mm];remark\nintrados;0;0;left\nextrados;-500;0,500\nintrados;1500;700\nintrados;3000;250\nextrados;3500;750\n",
    "\u{feff}curve\tx [ft]\ty [in]\nIntrados\t0\t0\nextrados\t-1\t20\nintrados\t4\t40\nextrados\t5\t9e1\n",
];

const SURVEYED: &str = "name = \"s\"\n[scene]\nscene = \"arch\"\nprofile = { shape = \"surveyed\", file = \"survey.csv\" }\n\
    width = 1.0\nvoussoirs = 5\nmaterial = \"stone\"\njoint = \"dry\"\n[materials.stone]\nlaw = \"rigid\"\ndensity = 2200\n\
    [joints.dry]\nlaw = \"coulomb\"\nfriction = 0.6\n[[stages]]\nname = \"dead\"\ngravity = 9.81\n";

/// Returns the survey of a seed.
pub fn survey(seed: u64) -> Input {
    let mut random = Random::new(seed);
    let text = *random.one_of(&SURVEYS);
    let text = if random.chance(0.5) { cells(text, &mut random) } else { scramble(text, &mut random) };
    Input { text, beside: PathBuf::new() }
}

/// Replaces some numbers of a table.
fn cells(text: &str, random: &mut Random) -> String {
    const CELLS: [&str; 12] = ["nan", "inf", "1e308", "-1e308", "", "0", "1e-320", "x", "0x1p3", "1e400", "-0", "3,5"];
    let mut pieces: Vec<String> = text.split_inclusive([',', ';', '\t', '\n']).map(String::from).collect();
    for _ in 0..random.whole(1, 4) {
        let place = random.whole(0, pieces.len() - 1);
        let end = pieces[place].chars().last().unwrap_or(',');
        pieces[place] = format!("{}{end}", random.one_of(&CELLS));
    }
    pieces.concat()
}

/// Reads a study with this survey.
pub fn attempt_survey(input: &Input) -> Result<(), String> {
    let read = |_: &str| Ok(input.text.clone());
    phase("check");
    let source = StudySource::parse_with(SURVEYED, "study.toml", &[], &read);
    source.and_then(|source| read_source_beside(source, &read)).map(drop).or_else(|wrong| refused(&wrong))
}

/// Returns the drawing of a seed, as its debug text.
pub fn drawing(seed: u64) -> Input {
    Input { text: format!("{:?}", drawn(seed)), beside: seed.to_string().into() }
}

fn drawn(seed: u64) -> Drawing {
    const NUMBERS: [f64; 10] = [0.0, 1.0, 2.0, -1.0, 1e300, -1e308, f64::NAN, f64::INFINITY, 1e-300, 0.5];
    const LAYERS: [&str; 8] = ["intrados", "extrados", "Intrados", "stone", "0", "ground", "", "\u{202e}x"];
    let mut random = Random::new(seed);
    let mut line = |entity: usize| {
        let corners = (0..random.whole(0, 6)).map(|_| {
            let mut number = || if random.chance(0.8) { random.between(-2.0, 5.0) } else { *random.one_of(&NUMBERS) };
            Corner { point: [number(), number()], bulge: if number() > 3.0 { number() } else { 0.0 } }
        });
        let corners = corners.collect();
        let layer = (*random.one_of(&LAYERS)).to_string();
        Polyline { entity: format!("LWPOLYLINE {entity}"), layer, closed: random.chance(0.6), corners }
    };
    let polylines: Vec<Polyline> = (0..2 + seed as usize % 3).map(&mut line).collect();
    Drawing { unit: Some(1e-3), polylines, loose: vec![["LINE 1".into(), "0".into()]] }
}

/// Reads the points and the blocks of this drawing.
pub fn attempt_drawing(input: &Input) -> Result<(), String> {
    let seed = input.beside.display().to_string().parse().expect("a seed");
    phase("drawing");
    let drawing = drawn(seed);
    for wrong in [drawing.profile(1e-3).err(), drawing.blocks(1.0, &["stone"]).err()].into_iter().flatten() {
        if wrong.is_empty() {
            return Err("refused without a mistake".into());
        }
    }
    Ok(())
}

/// Returns a report of published points with an expression of a seed in its claim.
pub fn claim(seed: u64) -> Input {
    let mut random = Random::new(seed);
    let [value, holds] = [0, 1].map(|_| expression(&mut random, 0));
    let [value, holds] =
        [value, holds].map(|text| if random.chance(0.2) { scramble(&text, &mut random) } else { text });
    let points =
        random.one_of(&["[[0, 1], [1, 3], [2, 2]]", "[[0, 0]]", "[[1, 1e308], [1, -1e308], [0, 5]]"]).to_string();
    let table = toml::toml! {
        name = "r"
        kind = "report"
        [report]
        studies = ["s.toml"]
        [[report.claims]]
        id = "1"
        claim = "c"
    };
    let mut text = toml::to_string(&table).expect("a table");
    text += &format!("[[report.claims.tests]]\nof = \"t\"\nvalue = {}\nholds = {}\n", quoted(&value), quoted(&holds));
    text += &format!(
        "[report.series.a]\npoints = {points}\n[report.series.b]\nstudy = \"s\"\nresult = {}\n",
        quoted(&path(&mut random))
    );
    Input { text, beside: PathBuf::new() }
}

fn quoted(text: &str) -> String {
    toml::Value::from(text).to_string()
}

fn path(random: &mut Random) -> String {
    let words = [
        "load_factor",
        "status",
        "mechanism",
        "hinges",
        "*",
        "joint",
        "sides",
        "places",
        "curve",
        "last.x",
        "0",
        "field",
        "bounds",
        "",
    ];
    (0..random.whole(1, 4)).map(|_| *random.one_of(&words)).collect::<Vec<_>>().join(".")
}

fn expression(random: &mut Random, depth: usize) -> String {
    const FUNCTIONS: [&str; 20] = [
        "abs",
        "argmax",
        "argmin",
        "max",
        "min",
        "all",
        "any",
        "highest_where",
        "lowest_where",
        "count",
        "rising",
        "falling",
        "rises_then_falls",
        "mean",
        "length",
        "first",
        "last",
        "recoveries",
        "words",
        "none",
    ];
    const SIGNS: [&str; 12] = ["or", "and", "==", "!=", "<=", ">=", "<", ">", "+", "-", "*", "/"];
    let inner = |random: &mut Random| expression(random, depth + 1);
    match if depth > 4 { random.whole(0, 3) } else { random.whole(0, 9) } {
        0 => "a".into(),
        1 => "b".into(),
        2 => (*random.one_of(&["value", "1", "0", "1e308", "'x'", "\"collapse\"", "1e400", "x"])).into(),
        3 => format!("{}", random.between(-1.0, 3.0)),
        4 | 5 => format!("{}({})", random.one_of(&FUNCTIONS), inner(random)),
        6 => format!("within({}, {}, {})", inner(random), inner(random), inner(random)),
        7 => format!("{}({}, {})", random.one_of(&["at", "has"]), inner(random), inner(random)),
        8 => format!("not {}", inner(random)),
        _ => format!("({} {} {})", inner(random), random.one_of(&SIGNS), inner(random)),
    }
}

const PART: &str = include_str!("../../../studies/src/commands/new/arch.toml");

/// Reads the report, and evaluates its claims with incomplete results.
pub fn attempt_claim(input: &Input) -> Result<(), String> {
    let part = PART.replacen("name = \"arch\"", "name = \"s\"", 1);
    let read = |_: &str| Ok(part.clone());
    phase("check");
    let source = StudySource::parse_with(&input.text, "report.toml", &[], &read);
    let study = match source.and_then(|source| read_source_beside(source, &read)) {
        Ok(study) => study,
        Err(wrong) => return refused(&wrong),
    };
    phase("run");
    for results in ["", "{\"cases\":[]}", RESULTS, &"[".repeat(100_000)] {
        let request = RunRequest { jobs: 1, version: "0".into(), parts: vec![results.into()], ..RunRequest::default() };
        study.run(&request, &Unobserved);
    }
    Ok(())
}

const RESULTS: &str = r#"{"cases":[{"status":"collapse","load_factor":2.0,"parameters":{"x":1},"bounds":[1,null],"mechanism":{"hinges":[{"joint":1,"side":"extrados"},{"joint":null}]},"curve":[[0,0],[1,null],["a"]]},{"status":"unbounded","load_factor":null,"parameters":{"x":"y"},"mechanism":null},{"status":7,"parameters":[]},[],null]}"#;
