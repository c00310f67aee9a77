//! Random bridges against an independent program: geometry, fill, spread, strengths and equilibrium are written again
//! from the equations of docs/theory/bridges.md, as a conic program for Clarabel. It shares no code with the scenes,
//! loads and solvers of Voussoir; only the text of the study uses the same numbers.

mod bridge;
mod fill;
mod program;
mod twins;

use self::bridge::{Bridge, DAMAGED, MORE};
use voussoir::core::limit::Status;
use voussoir_tests::answered;

/// 12 random bridges carry the load of an independent program: with ring joints, piers, layers, backing, resistance of
/// every kind, spread, crushing, tapered rings and lost mortar. `VOUSSOIR_BRIDGES` sets the number, `VOUSSOIR_FIRST`
/// the first seed.
#[test]
fn random_bridges_carry_what_an_independent_program_says() {
    compare(0, 12);
}

/// Random bridges with partial factors, and with loads that spread as in a half-plane, carry the load of an independent
/// program.
#[test]
fn random_bridges_with_partial_factors_carry_what_an_independent_program_says() {
    compare(MORE, 10);
}

/// Random bridges with voussoirs lost from outermost rings, and with bed joints of piers that have lost mortar, carry
/// the load of an independent program.
#[test]
fn random_bridges_with_damage_carry_what_an_independent_program_says() {
    compare(DAMAGED, 10);
}

fn compare(first: u64, count: u64) {
    let count = std::env::var("VOUSSOIR_BRIDGES").ok().and_then(|count| count.parse().ok()).unwrap_or(count);
    let first = first + std::env::var("VOUSSOIR_FIRST").ok().and_then(|first| first.parse().ok()).unwrap_or(0);
    let (mut compared, mut refused, mut wrong) = (0, 0, Vec::new());
    for seed in first..first + count {
        let bridge = Bridge::random(seed);
        let text = bridge.study();
        if voussoir::study::load(&text, "bridge.toml", &[]).is_err() {
            refused += 1;
            continue;
        }
        let (result, expected) = (answered(&text), bridge.design().load_factor());
        let same = match (expected, result.status, result.load_factor) {
            (Some(expected), Status::Collapse, Some(factor)) => {
                compared += 1;
                result.certificate.passed && (factor - expected).abs() <= 2e-6 * expected.abs()
            }
            // Dead load alone may fail although the structure carries it with an additional load.
            (Some(expected), Status::NoEquilibrium, _) => {
                let most = result.feasible_interval.and_then(|interval| interval[1]);
                most.is_some_and(|most| (most - expected).abs() <= 2e-6 * expected.abs())
            }
            (None, Status::NoEquilibrium | Status::Unbounded, _) => true,
            _ => false,
        };
        if !same {
            let said = format!("{:?} {:?} {:?}", result.status, result.load_factor, result.notes);
            wrong.push(format!("{seed}: {said}, but {expected:?}\n{text}"));
        }
    }
    println!("{compared} of {count} compared, {refused} no bridges, {} wrong", wrong.len());
    assert!(wrong.is_empty(), "{} of {count} wrong\n{}", wrong.len(), wrong.join("\n"));
    assert!(compared * 3 >= count * 2, "{compared} of {count}, {refused} refused");
}
