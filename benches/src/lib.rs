//! Scenes that benches share, made from problems of the tests with known answers.

pub mod boundary;
pub mod point;
pub mod walk;

use voussoir::cli::processor_time;
use voussoir::study::Case;
use voussoir_tests::known::{PEERS_RING, peers_ring};
use voussoir_tests::{Arch, Wall, assert_close, collapse_factor, compliant, elastic, first_case, friction};

/// A jointed segmental ring of `voussoirs` (span 9.42 m, rise 2.99 m, thickness 0.6 m, 1 m wide, μ 0.6) with a load
/// above quarter span, the scene on which all peers were measured. `solver` is a tag. If the collapse load is known, it
/// is checked.
pub fn ring(voussoirs: usize, solver: &'static str) -> Case {
    let study = Arch { solver, ..peers_ring(voussoirs) }.study();
    if voussoirs == 13 {
        assert_close(collapse_factor(&study), PEERS_RING, 1e-9);
    }
    first_case(&study)
}

/// The same ring with compliant joints.
pub fn compliant_ring(voussoirs: usize) -> Case {
    first_case(&Arch { joint: compliant(&friction(0.6), 1e10, 4e9), ..peers_ring(voussoirs) }.study())
}

/// The same ring with elastic voussoirs, E = 5 GPa.
pub fn elastic_ring(voussoirs: usize) -> Case {
    first_case(&Arch { material: elastic(5e9, 0.3), ..peers_ring(voussoirs) }.study())
}

/// A wall of `courses` × `bricks` under a horizontal force proportional to weight.
pub fn wall(courses: usize, bricks: usize) -> Case {
    first_case(&Wall::in_bond(courses, bricks).study())
}

/// Returns the least processor time of this thread \[s\] for a piece of work over a number of runs; elapsed time if the
/// system does not report processor time.
pub fn least_processor_time<T>(runs: usize, work: impl Fn() -> T) -> f64 {
    let timed = |_| {
        let start = processor_time();
        std::hint::black_box(work());
        processor_time() - start
    };
    (0..runs.max(1)).map(timed).fold(f64::INFINITY, f64::min)
}
