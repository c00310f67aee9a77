//! Run time against error: every solver on each class of problems, over the parameters that control its accuracy, and the stress
//! update of the cap at a point. Writes `bench.csv`, `bench.svg` and `profile.svg` into `target/work_precision`, or into the
//! folder named by WORK_PRECISION. OTHERS names a CSV file with measurements of other programs (`benches/peers`).
//!
//! `cargo bench -p voussoir-benches --bench work_precision`; a further word selects the studies whose names contain it.

use std::path::PathBuf;
use std::{env, fs};
use voussoir::bench::{
    Bench, BenchOptions, Measurement, bench, csv, error_panels, ladder, problems, profile_chart, read_others, table,
};
use voussoir::cli::processor_time;
use voussoir::figures::{ChartStyle, chart, panels};
use voussoir::study::Study;
use voussoir_benches::walk::ladders;
use voussoir_tests::study;

/// The folder of the studies, one for each class of problems. `voussoir bench benches/scenes/*.toml` measures the same.
const SCENES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes");
/// Name of the panel of the stress update.
const AT_A_POINT: &str = "cap at a point";

/// Returns the studies in alphabetical order.
fn scenes() -> Vec<Study> {
    let files = fs::read_dir(SCENES).expect("the folder of scenes").map(|entry| entry.expect("a file").path());
    let mut files: Vec<PathBuf> = files.collect();
    files.sort();
    files.iter().map(|file| study(&fs::read_to_string(file).expect("a study"))).collect()
}

/// Draws the error of the stress at the end of a path of strains over the time.
fn at_a_point(title: &str) -> String {
    let line = |(stone, kind, runs): (_, _, Vec<voussoir_benches::walk::Run>)| {
        ladder(&format!("{stone} stone, {kind}"), runs.iter().map(|run| (run.seconds, run.error)).collect(), 0.0)
    };
    let series: Vec<_> = ladders().into_iter().map(line).collect();
    let notes = ["Errors are measured from 131,072 returns, extrapolated.".to_string()];
    let style = ChartStyle { log: [true, true] };
    let title = format!("{title}: {AT_A_POINT}");
    chart(&title, "processor time [s]", "relative error of the stress [-]", &series, &notes, &style)
}

fn main() {
    // Cargo passes `--bench`.
    let word = env::args().skip(1).find(|word| !word.starts_with('-')).unwrap_or_default();
    let told = |own: &Measurement| {
        eprintln!("  {}: {:.3e} s", own.contestant, own.seconds);
        true
    };
    let options = BenchOptions { runs: 1, reference: None, clock: &processor_time, told: &told };
    let studies: Vec<Study> = scenes().into_iter().filter(|study| study.name.contains(&word)).collect();
    let names: Vec<String> = studies.iter().flat_map(|study| problems(study, true)).collect();
    let others = env::var_os("OTHERS").map(|file| {
        let text = fs::read_to_string(&file).expect("a file with measurements");
        read_others(&text, &names).unwrap_or_else(|why| panic!("{}: {why}", file.display()))
    });
    let mut all = Bench::default();
    for study in studies {
        eprintln!("{}", study.name);
        all.join(&study.name, bench(&study, &options));
    }
    all.beside(others.unwrap_or_default());
    print!("{}", table(&all));
    let folder = env::var_os("WORK_PRECISION").map_or_else(|| PathBuf::from("target/work_precision"), PathBuf::from);
    fs::create_dir_all(&folder).expect("a folder");
    let write = |name: &str, text: String| fs::write(folder.join(name), text).expect("a file");
    write("bench.csv", csv(&all));
    let title = "Run time against error";
    let mut drawn = error_panels(title, &all);
    drawn.extend(AT_A_POINT.contains(&word).then(|| at_a_point(title)));
    write("bench.svg", panels(&drawn));
    profile_chart("Problems answered", &all, 1e-3).into_iter().for_each(|chart| write("profile.svg", chart));
}
