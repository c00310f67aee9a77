//! Unusual inputs: mutations of real studies, surveys, drawings, results and parts, by the schema.
//!
//! One rule for all: an exit code from 0 to 3 or a message, no panic, bounded time and memory. Inputs follow from a
//! seed, so that a failure can be repeated. Each target runs in a child process. If a child process ends or hangs, its
//! seed is reported and a new process starts with the next seed.
//!
//! `VOUSSOIR_FUZZ_CASES=10000 cargo test --release -p voussoir-tests --test fuzz` tries that many inputs of each target;
//! `VOUSSOIR_FUZZ_FROM=500` begins with another seed. Inputs of findings, and a single input, are kept in `target/tmp`.

mod corpus;
mod folders;
mod mutation;
mod shapes;
mod studies;
mod supervisor;
mod surveys;
mod worker;

use supervisor::hold;

/// Inputs of each target in the default tests.
const SHORT: u64 = 150;

#[test]
fn mutated_studies() {
    hold("studies", SHORT);
}

#[test]
fn mutated_results_and_resolved_studies() {
    hold("folders", SHORT / 2);
}

#[test]
fn mutated_parts() {
    hold("merge", SHORT / 2);
}

#[test]
fn mutated_surveys() {
    hold("surveys", 4 * SHORT);
}

#[test]
fn mutated_drawings() {
    hold("drawings", 4 * SHORT);
}

#[test]
fn mutated_claims() {
    hold("claims", 4 * SHORT);
}

/// The child process of the other tests.
#[test]
fn worker() {
    worker::work();
}
