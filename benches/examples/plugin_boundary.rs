//! Runs batches of 64 updates of dry friction, to count the instructions of one batch:
//!
//! `valgrind --tool=callgrind target/release/examples/plugin_boundary KIND BATCHES`, where KIND is `facets`, `response`
//! or `written`. The difference between two numbers of batches is the cost of the batches alone. The program first
//! checks that the three kinds agree.

use std::hint::black_box;
use voussoir::core::law::{PointContext, TractionPoint};
use voussoir_benches::boundary::{FRICTION, STIFFNESS, gaps, through_the_registry, written_out};

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    let kind = arguments.get(1).map_or("written", String::as_str);
    let batches: usize = arguments.get(2).and_then(|word| word.parse().ok()).unwrap_or(1000);
    let gaps = gaps();
    let contexts = vec![PointContext::default(); gaps.len()];
    let old = vec![0.0; 64];
    let (mut new, mut points) = (old.clone(), vec![TractionPoint::ZERO; 64]);
    written_out(STIFFNESS, FRICTION, &gaps, &old, &mut new, &mut points).expect("answers");
    let expected = points.clone();
    for tag in ["coulomb", "bench_friction"] {
        let response = through_the_registry(tag);
        let old = vec![0.0; 64 * response.state_size()];
        response.respond(&gaps, &contexts, &old, &mut old.clone(), &mut points).expect("answers");
        let near =
            |(a, b): (&TractionPoint, &TractionPoint)| (0..2).all(|i| (a.traction[i] - b.traction[i]).abs() < 1e-4);
        assert!(points.iter().zip(&expected).all(near), "{tag} is another law");
    }
    let response = through_the_registry(if kind == "facets" { "coulomb" } else { "bench_friction" });
    let own = vec![0.0; 64 * response.state_size()];
    let mut after = own.clone();
    for _ in 0..batches {
        if kind == "written" {
            written_out(black_box(STIFFNESS), black_box(FRICTION), black_box(&gaps), &old, &mut new, &mut points)
                .expect("answers");
        } else {
            response.respond(black_box(&gaps), &contexts, &own, &mut after, &mut points).expect("answers");
        }
        black_box((&points, &new, &after));
    }
}
