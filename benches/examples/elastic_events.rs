//! Prints events and processor time per number of voussoirs for whole paths of elastic rings to collapse.
//!
//! `cargo run --release -p voussoir-benches --example elastic_events -- 13 40 130`

use std::time::Instant;
use voussoir::core::path::{PathProblem, PathSettings, PathSolver, Unobserved};
use voussoir::solvers::path::event::EventPath;
use voussoir_benches::elastic_ring;

fn main() {
    let settings = PathSettings {
        finite: false,
        tolerance: 1e-9,
        stop_displacement: None,
        stop_factor: None,
        continuation: None,
        stages: Vec::new(),
    };
    for voussoirs in std::env::args().skip(1).filter_map(|n| n.parse().ok()) {
        let case = elastic_ring(voussoirs);
        let start = Instant::now();
        let problem = PathProblem::new(&case.assembly, &case.stages).expect("a path problem");
        let condensed = start.elapsed();
        let start = Instant::now();
        let answer = EventPath {}.trace(&problem, &settings, &mut Unobserved);
        println!(
            "{voussoirs}: {:?} {:?}, condensed in {condensed:?}, followed in {:?}",
            answer.status,
            answer.factor,
            start.elapsed()
        );
        println!("    {:?}", answer.counters);
        for note in &answer.notes {
            println!("    {note}");
        }
    }
}
