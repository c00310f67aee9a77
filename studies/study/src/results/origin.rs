//! The origin of results: program, processor and plug-ins.

use crate::fnv::Fnv64;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value as Json};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::LazyLock;
use voussoir_core::plugin::{Package, cards};

/// The version of the format of results.json.
pub const FORMAT: u32 = 1;

/// The keys of an [`Origin`] in results.json.
pub const HEAD: [&str; 7] = ["format", "commit", "sources", "platform", "processor_features", "mathematics", "plugins"];

/// The head of a results.json that a kind of study writes itself: study, version, origin, and the names of its files.
pub fn head(study: (&str, &toml::Value), version: &str, files: &[String]) -> Map<String, Json> {
    let mut head = Map::from_iter([("study".into(), study.0.into()), ("version".into(), version.into())]);
    if let Ok(Json::Object(origin)) = serde_json::to_value(Origin::here(&words(study.1))) {
        head.extend(origin);
    }
    head.insert("files".into(), files.into());
    head
}

/// Removes the origin from the entries of a results.json.
pub fn without_origin(mut results: Json) -> Json {
    if let Some(map) = results.as_object_mut() {
        HEAD.iter().for_each(|key| drop(map.shift_remove(*key)));
    }
    results
}

/// A crate with plug-ins.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct PluginCrate {
    /// Name of the crate.
    #[serde(rename = "crate")]
    pub name: String,
    /// Version of the crate.
    pub version: String,
    /// Tags of its plug-ins that the study uses, sorted.
    pub tags: Vec<String>,
}

/// The origin of results. Two programs with the same origin give the same bits.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Origin {
    /// The version of the format, [`FORMAT`]; 0 if the results have no such entry.
    pub format: u32,
    /// The commit of the program; `unknown` without git.
    pub commit: String,
    /// A hash of its sources, which also detects changes that were not committed; `unknown` outside the workspace.
    pub sources: String,
    /// The target triple of the compiled program.
    pub platform: String,
    /// Processor features by which libraries choose their code.
    pub processor_features: Vec<String>,
    /// A hash of sines, logarithms and powers, because mathematical libraries differ in the last digits.
    pub mathematics: String,
    /// All crates of the program with plug-ins, sorted by name.
    pub plugins: Vec<PluginCrate>,
}

impl Origin {
    /// Returns a finding if a newer program has written the results.
    pub fn too_new(&self) -> Option<String> {
        (self.format > FORMAT)
            .then(|| format!("format is {}, but this program reads formats up to {FORMAT}", self.format))
    }

    /// Returns the origin of results of this program on this processor. `named` contains the words of a study,
    /// including the tags of its plug-ins.
    pub fn here(named: &BTreeSet<String>) -> Origin {
        let mut origin = HERE.clone();
        for (package, tags) in TAGS.iter() {
            let own =
                origin.plugins.iter_mut().filter(|own| own.name == package.name && own.version == package.version);
            own.for_each(|own| {
                own.tags = tags.iter().filter(|tag| named.contains(**tag)).map(ToString::to_string).collect()
            });
        }
        origin
    }

    /// Returns true if results of both origins must agree bit by bit.
    pub fn agrees(&self, other: &Origin) -> bool {
        self == other && self.format == FORMAT && self.sources != UNKNOWN
    }

    /// Returns commit, sources and crates: the part that is included in the hash of a case.
    pub fn program(&self) -> (&str, &str, Vec<(&str, &str)>) {
        let crates = self.plugins.iter().map(|own| (own.name.as_str(), own.version.as_str()));
        (&self.commit, &self.sources, crates.collect())
    }
}

/// Returns the origin for this program and this processor, without tags.
pub fn this_program() -> &'static Origin {
    &HERE
}

/// Returns all words in a study file.
pub fn words(study: &toml::Value) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    let mut left = vec![study];
    while let Some(value) = left.pop() {
        match value {
            toml::Value::String(word) => drop(found.insert(word.clone())),
            toml::Value::Array(items) => left.extend(items),
            toml::Value::Table(table) => left.extend(table.values()),
            _ => {}
        }
    }
    found
}

const UNKNOWN: &str = "unknown";

/// The build of a program. The crate `voussoir` submits its own, so that no other crate is compiled again for a new commit.
pub struct Build {
    /// Commit of its sources.
    pub commit: &'static str,
    /// Hash of its sources.
    pub sources: &'static str,
    /// Its target.
    pub platform: &'static str,
}

voussoir_core::inventory::collect!(Build);

/// Returns the build of this program.
fn build() -> &'static Build {
    static NONE: Build = Build { commit: UNKNOWN, sources: UNKNOWN, platform: UNKNOWN };
    voussoir_core::inventory::iter::<Build>.into_iter().next().unwrap_or(&NONE)
}

static TAGS: LazyLock<BTreeMap<Package, BTreeSet<&'static str>>> = LazyLock::new(|| {
    let mut tags: BTreeMap<Package, BTreeSet<&'static str>> = BTreeMap::new();
    for card in cards() {
        tags.entry(card.package).or_default().insert(card.tag);
    }
    tags
});

static HERE: LazyLock<Origin> = LazyLock::new(|| Origin {
    format: FORMAT,
    commit: build().commit.into(),
    sources: build().sources.into(),
    platform: build().platform.into(),
    processor_features: processor_features(),
    mathematics: mathematics(),
    plugins: TAGS
        .keys()
        .map(|own| PluginCrate { name: own.name.into(), version: own.version.into(), tags: Vec::new() })
        .collect(),
});

/// Features by which matrix kernels and mathematical libraries choose their code.
#[cfg(target_arch = "x86_64")]
fn processor_features() -> Vec<String> {
    let known = [
        ("avx", std::is_x86_feature_detected!("avx")),
        ("avx2", std::is_x86_feature_detected!("avx2")),
        ("avx512f", std::is_x86_feature_detected!("avx512f")),
        ("fma", std::is_x86_feature_detected!("fma")),
        ("sse4.1", std::is_x86_feature_detected!("sse4.1")),
    ];
    known.into_iter().filter(|(_, there)| *there).map(|(name, _)| name.into()).collect()
}

/// Features by which matrix kernels and mathematical libraries choose their code.
#[cfg(target_arch = "aarch64")]
fn processor_features() -> Vec<String> {
    let known = [
        ("fcma", std::arch::is_aarch64_feature_detected!("fcma")),
        ("fp16", std::arch::is_aarch64_feature_detected!("fp16")),
        ("neon", std::arch::is_aarch64_feature_detected!("neon")),
        ("sve", std::arch::is_aarch64_feature_detected!("sve")),
    ];
    known.into_iter().filter(|(_, there)| *there).map(|(name, _)| name.into()).collect()
}

/// For other processors, no features are known.
#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
fn processor_features() -> Vec<String> {
    Vec::new()
}

/// FNV-1a of the bits of functions whose last digits depend on the system's library.
fn mathematics() -> String {
    let functions: [fn(f64) -> f64; 8] =
        [f64::sin, f64::cos, f64::tan, f64::atan, f64::exp, f64::ln, f64::cbrt, |x| x.powf(1.3)];
    let arguments = (1..=64).map(|i| std::hint::black_box(f64::from(i) * 0.137));
    let bits = arguments.flat_map(|x| functions.map(|function| function(x).to_bits()));
    let mut hash = Fnv64::new();
    bits.for_each(|bits| hash.add(&bits.to_le_bytes()));
    hash.text()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_program_agrees_with_itself_and_with_no_other() {
        let study = toml::from_str("[joints.dry]\nlaw = \"coulomb\"\n[scene]\nscene = \"arch\"").expect("TOML");
        let here = Origin::here(&words(&study));
        assert!(here.agrees(&here) || here.sources == UNKNOWN);
        let tags: Vec<&String> = here.plugins.iter().flat_map(|own| &own.tags).collect();
        assert!(tags.iter().any(|tag| *tag == "coulomb") && tags.iter().any(|tag| *tag == "arch"), "{tags:?}");
        assert!(!tags.iter().any(|tag| *tag == "unilateral"));
        let mut others = [Origin::default(), here.clone(), here.clone(), here.clone(), here.clone(), here.clone()];
        others[1].commit += "x";
        others[2].platform += "x";
        others[3].processor_features.clear();
        others[4].mathematics += "x";
        others[5].plugins[0].version += "x";
        assert!(others.iter().all(|other| !here.agrees(other)));
    }
}
