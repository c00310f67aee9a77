//! Run time against error: every solver on a set of scenes, over the parameters that control its accuracy. Writes
//! `bench.csv`, `bench.svg` and `profile.svg` into `target/work_precision`, or into the folder named by WORK_PRECISION.
//!
//! `cargo bench -p voussoir-benches --bench work_precision`; a further word selects the scenes whose names contain it.

use std::path::PathBuf;
use std::{env, fs};
use voussoir::bench::{Bench, BenchOptions, Measurement, bench, csv, error_chart, profile_chart, table};
use voussoir::cli::processor_time;
use voussoir_tests::known::peers_ring;
use voussoir_tests::{Arch, Wall, compliant, crushing, elastic, friction, study};

/// Names and studies: arches (shallow, deep, strong, many voussoirs), walls, elastic, crushing, compliant, finite
/// displacements.
fn scenes() -> Vec<(&'static str, String)> {
    let stone = || elastic(5e9, 0.3);
    let finite = |arch: Arch| arch.study().replacen("[[stages]]", "kinematics = \"finite\"\n[[stages]]", 1);
    let arch = Arch { voussoirs: 9, ..Arch::default() };
    vec![
        ("rigid ring of 13", peers_ring(13).study()),
        ("rigid ring of 1000", peers_ring(1000).study()),
        ("rigid, shallow", Arch { rise: 1.79, ..arch.clone() }.study()),
        ("rigid, deep", Arch { rise: 4.49, ..arch.clone() }.study()),
        ("rigid that crushes", Arch { joint: crushing(0.6, 1e7), ..arch.clone() }.study()),
        ("wall of 10 x 10", Wall::in_bond(10, 10).study()),
        ("compliant joints", Arch { joint: compliant(&friction(0.6), 2e10, 8e9), ..arch.clone() }.study()),
        ("elastic", Arch { material: stone(), ..arch.clone() }.study()),
        ("elastic that crushes", Arch { material: stone(), joint: crushing(0.6, 1e7), ..arch.clone() }.study()),
        ("elastic, finite", finite(Arch { material: stone(), voussoirs: 7, ..arch })),
    ]
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
        all.join(name, bench(&study(&text), &options));
    }
    print!("{}", table(&all));
    let folder = env::var_os("WORK_PRECISION").map_or_else(|| PathBuf::from("target/work_precision"), PathBuf::from);
    fs::create_dir_all(&folder).expect("a folder");
    let write = |name: &str, text: String| fs::write(folder.join(name), text).expect("a file");
    write("bench.csv", csv(&all));
    error_chart("Run time against error", &all).into_iter().for_each(|chart| write("bench.svg", chart));
    profile_chart("Problems answered", &all, 1e-3).into_iter().for_each(|chart| write("profile.svg", chart));
}
