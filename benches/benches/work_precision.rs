//! Run time against error: every solver on a set of scenes, over the parameters that control its accuracy. Writes
//! `bench.csv`, `bench.svg` and `profile.svg` into `target/work_precision`, or into the folder named by WORK_PRECISION.
//!
//! `cargo bench -p voussoir-benches --bench work_precision`; a further word selects the scenes whose names contain it.

use std::path::PathBuf;
use std::{env, fs};
use voussoir::bench::{Bench, BenchOptions, Measurement, bench, csv, error_chart, profile_chart, table};
use voussoir::cli::processor_time;
use voussoir_tests::study;

/// The folder of the scenes: arches (shallow, deep, strong, many voussoirs), a wall, elastic, crushing, compliant, finite
/// displacements, softening, a wall without dilatancy. `voussoir bench benches/scenes/*.toml` measures the same.
const SCENES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes");

/// Returns the studies in alphabetical order.
fn scenes() -> Vec<(String, String)> {
    let files = fs::read_dir(SCENES).expect("the folder of scenes").map(|entry| entry.expect("a file").path());
    let name = |file: &PathBuf| file.file_stem().expect("a name").to_string_lossy().into_owned();
    let mut scenes: Vec<_> = files.map(|file| (name(&file), fs::read_to_string(&file).expect("a study"))).collect();
    scenes.sort();
    scenes
}

fn main() {
    // Cargo passes `--bench`.
    let word = env::args().skip(1).find(|word| !word.starts_with('-')).unwrap_or_default();
    let told = |own: &Measurement| {
        eprintln!("  {}: {:.3e} s", own.contestant, own.seconds);
        true
    };
    let options = BenchOptions { runs: 1, reference: None, clock: &processor_time, told: &told };
    let mut all = Bench::default();
    for (name, text) in scenes().into_iter().filter(|(name, _)| name.contains(&word)) {
        eprintln!("{name}");
        all.join(&name, bench(&study(&text), &options));
    }
    print!("{}", table(&all));
    let folder = env::var_os("WORK_PRECISION").map_or_else(|| PathBuf::from("target/work_precision"), PathBuf::from);
    fs::create_dir_all(&folder).expect("a folder");
    let write = |name: &str, text: String| fs::write(folder.join(name), text).expect("a file");
    write("bench.csv", csv(&all));
    error_chart("Run time against error", &all).into_iter().for_each(|chart| write("bench.svg", chart));
    profile_chart("Problems answered", &all, 1e-3).into_iter().for_each(|chart| write("profile.svg", chart));
}
