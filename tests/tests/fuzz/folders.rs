//! Damaged result folders and damaged parts of a study: `verify` and `merge` end with an exit code.

use super::mutation::{mutate, scramble};
use super::worker::{Input, own_folder, phase};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::sync::LazyLock;
use voussoir::core::random::Random;

/// An arch under a load.
const ARCH: &str = r#"
name = "arch"
[scene]
scene = "arch"
profile = { shape = "segmental", span = 9.42, rise = 2.99 }
thickness = 0.60
width = 5.81
voussoirs = 7
ends = "bonded"
material = "stone"
joint = "dry"
[scene.mesh]
elements = [1, 2]
[materials.stone]
law = "elastic"
young_modulus = "5 GPa"
poisson_ratio = 0.3
density = 2200.0
[joints.dry]
law = "coulomb_associated"
friction = 0.6
[[stages]]
name = "dead"
gravity = 9.81
[[stages]]
name = "live"
until = "collapse"
loads = [{ kind = "point", span_fraction = 0.25, force = [0.0, -1000.0] }]
"#;

/// The lines that each folder adds to the study.
const FOLDERS: [&str; 3] = [
    "[solver]\nsolver = \"limit_chain\"\n",
    "[solver]\nsolver = \"event_path\"\n[output]\ncurve = true\nfigures = false\n",
    "[output]\nfigures = false\n[sweep]\n\"scene.thickness\" = { list = [0.6, 0.7] }\n[[variants]]\nname = \"a\"\n[[variants]]\nname = \"b\"\nset = { \"joints.dry.friction\" = 0.5 }\n",
];

fn command(words: &[&str]) -> Result<u8, String> {
    voussoir::cli::main_from(words.iter().map(Into::into)).map_err(|error| error.to_string())
}

/// The folders as `run` writes them, made once for each process.
static BASE: LazyLock<Vec<PathBuf>> = LazyLock::new(|| {
    let make = |(index, more): (usize, &&str)| {
        let (file, out) = (own_folder().join(format!("{index}.toml")), own_folder().join(format!("base-{index}")));
        std::fs::write(&file, format!("{ARCH}{more}")).expect("a study");
        let code = command(&["run", &file.display().to_string(), "--quiet", "--out", &out.display().to_string()]);
        assert_eq!(code, Ok(0), "{more}");
        out
    };
    FOLDERS.iter().enumerate().map(make).collect()
});

/// Both parts of the last study.
static PARTS: LazyLock<Vec<PathBuf>> = LazyLock::new(|| {
    let (file, out) = (own_folder().join("parts.toml"), own_folder().join("parts"));
    std::fs::write(&file, format!("{ARCH}{}", FOLDERS[2])).expect("a study");
    for part in ["1/2", "2/2"] {
        let words =
            ["run", &file.display().to_string(), "--quiet", "--shard", part, "--out", &out.display().to_string()];
        assert_eq!(command(&words), Ok(0), "part {part}");
    }
    files(&out)
});

fn files(folder: &Path) -> Vec<PathBuf> {
    let inner = std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    let mut all: Vec<PathBuf> = inner.flat_map(|path| if path.is_dir() { files(&path) } else { vec![path] }).collect();
    all.sort();
    all
}

/// Returns the mutated text of a file of one of the folders; `beside` is the file.
pub fn folder(seed: u64) -> Input {
    let mut random = Random::new(seed);
    let base = random.one_of(&BASE);
    let names = ["results.json", "results.json", "results.json", "resolved.toml", "results.csv"];
    let path = base.join(random.one_of(&names));
    damaged(path, &mut random)
}

/// Returns the mutated text of a part.
pub fn part(seed: u64) -> Input {
    let mut random = Random::new(seed);
    let path = random.one_of(&PARTS).clone();
    damaged(path, &mut random)
}

fn damaged(path: PathBuf, random: &mut Random) -> Input {
    let text = String::from_utf8_lossy(&std::fs::read(&path).expect("a file")).into_owned();
    let text = match random.whole(0, 3) {
        0 => scramble(&text, random),
        _ => structured(&text, random).unwrap_or_else(|| scramble(&text, random)),
    };
    Input { text, beside: path }
}

/// Mutates a text by its form: TOML, JSON, or lines of JSON.
fn structured(text: &str, random: &mut Random) -> Option<String> {
    if let Ok(mut table) = text.parse::<toml::Table>() {
        mutate(&mut table, &toml::Table::new(), random);
        return toml::to_string(&table).ok();
    }
    if let Ok(mut value) = serde_json::from_str::<Value>(text) {
        (0..random.whole(1, 3)).for_each(|_| change(&mut value, random));
        return Some(value.to_string());
    }
    let mut lines: Vec<String> = text.lines().map(String::from).collect();
    if lines.is_empty() {
        return None;
    }
    let place = random.whole(0, lines.len() - 1);
    let mut value: Value = serde_json::from_str(&lines[place]).ok()?;
    change(&mut value, random);
    lines[place] = value.to_string();
    Some(lines.join("\n") + "\n")
}

/// Changes one value of a JSON tree: walks down from the root and stops at a random place.
fn change(value: &mut Value, random: &mut Random) {
    let down = !random.chance(0.15);
    match value {
        Value::Object(map) if down && !map.is_empty() => {
            let keys: Vec<String> = map.keys().cloned().collect();
            let key = random.one_of(&keys);
            if random.chance(0.05) {
                map.remove(key);
            } else if let Some(inner) = map.get_mut(key) {
                change(inner, random);
            }
        }
        Value::Array(list) if down && !list.is_empty() => {
            let place = random.whole(0, list.len() - 1);
            match random.whole(0, 9) {
                0 => drop(list.remove(place)),
                1 => list.push(list[place].clone()),
                _ => change(&mut list[place], random),
            }
        }
        other => *other = replacement(other, random),
    }
}

fn replacement(old: &Value, random: &mut Random) -> Value {
    match (old.as_f64(), random.whole(0, 9)) {
        (Some(x), 0..=3) => json!(x * *random.one_of(&[0.0, -1.0, 2.0, 1e-9, 1e300, 1.0 + 1e-12])),
        (Some(x), 4) => json!(x as i64 + 1),
        (_, 5) => Value::Null,
        (_, 6) => json!([]),
        (_, 7) => json!({}),
        (_, 8) => json!("collapse"),
        _ => random
            .one_of(&[
                json!(1e308),
                json!(-1e308),
                json!(u64::MAX),
                json!(i64::MIN),
                json!(0),
                json!(1_000_000_000),
                json!(true),
            ])
            .clone(),
    }
}

/// Copies the folder of the file that is replaced and returns the copy.
fn copy(input: &Input) -> PathBuf {
    let whole = input.beside.strip_prefix(own_folder()).expect("a file of this process");
    let from = own_folder().join(whole.components().next().expect("a folder"));
    let to = own_folder().join("copy");
    drop(std::fs::remove_dir_all(&to));
    for file in files(&from) {
        let place = to.join(file.strip_prefix(&from).expect("a file of the folder"));
        std::fs::create_dir_all(place.parent().expect("a folder")).expect("a folder");
        let own =
            if file == input.beside { input.text.clone().into_bytes() } else { std::fs::read(&file).expect("a file") };
        std::fs::write(place, own).expect("a copy");
    }
    to
}

pub fn attempt_folder(input: &Input) -> Result<(), String> {
    let dir = copy(input).display().to_string();
    phase("verify");
    allowed(command(&["verify", &dir])?)
}

pub fn attempt_part(input: &Input) -> Result<(), String> {
    let dir = copy(input).display().to_string();
    phase("merge");
    let out = own_folder().join("merged").display().to_string();
    allowed(command(&["merge", &dir, "--quiet", "--out", &out])?)
}

fn allowed(code: u8) -> Result<(), String> {
    if code <= 3 { Ok(()) } else { Err(format!("exit code {code}")) }
}
