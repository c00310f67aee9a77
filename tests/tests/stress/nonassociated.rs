//! Random small walls: the certified least load agrees with an independent mixed-integer program.
//!
//! `fixtures/small_walls.py` makes `fixtures/small_walls.jsonl`. It shares nothing with this project: other code, other
//! formulation, another solver. `fixtures/larger_walls.py` adds walls of 10 to 12 blocks.

use serde_json::Value;
use voussoir::core::limit::Status;
use voussoir::results::CaseResult;
use voussoir_tests::{Wall, answered, assert_close};

const WALLS: &str = include_str!("../../fixtures/small_walls.jsonl");

fn walls() -> Vec<Value> {
    WALLS.lines().map(|line| serde_json::from_str(line).expect("a wall")).collect()
}

fn number(wall: &Value, key: &str) -> f64 {
    wall[key].as_f64().expect("a number")
}

fn blocks(wall: &Value) -> usize {
    wall["rows"].as_array().expect("rows").iter().map(|row| row.as_array().expect("a row").len()).sum()
}

fn answer(wall: &Value, law: &str, solver: &str) -> CaseResult {
    answer_with(wall, law, &format!("solver = \"{solver}\""))
}

fn answer_with(wall: &Value, law: &str, solver: &str) -> CaseResult {
    let rows: Vec<Vec<f64>> = serde_json::from_value(wall["rows"].clone()).expect("rows");
    let rows: Vec<&[f64]> = rows.iter().map(Vec::as_slice).collect();
    let wall = Wall {
        brick: [0.4, 0.2],
        gravity: 10.0,
        push: [10.0, 10.0 * number(wall, "lift")],
        joint: format!("law = \"{law}\"\nfriction = {:?}", number(wall, "friction")),
        solver: solver.into(),
        ..Wall::of_rows(&rows)
    };
    answered(&wall.study())
}

/// Checks least load, proved bracket, and the order least ≤ sequential ≤ associated. At most `most_open` brackets stay
/// open, by less than 1e-3. Returns the number of least loads below 0.98 of the associated load.
fn check(walls: &[Value], most_open: usize) -> usize {
    let mut lower = 0;
    let (mut slowest, mut open, mut stalled) = (0.0f64, 0, 0);
    for wall in walls {
        let result = answer(wall, "coulomb", "limit_least");
        assert_eq!(result.status, Status::Collapse, "{wall} {:?} {:?}", result.notes, result.certificate);
        assert!(result.certificate.passed, "{wall} {:?}", result.certificate);
        let least = result.load_factor.expect("a factor");
        let expected = number(wall, "least");
        let scale = expected.abs().max(1e-3);
        assert!((least - expected).abs() <= 2e-7 * scale, "{wall}: {least}, {:?}", result.bounds);
        let [low, _] = result.both_bounds().expect("a bracket");
        assert!(low <= expected + 2e-7 * scale, "{wall}: {least}, {:?}", result.bounds);
        open += usize::from(low < least * (1.0 - 1e-6));
        assert!(low >= least * (1.0 - 1e-3) - 1e-9, "{wall}: [{low}, {least}]");
        let associated = result.non_associated.associated_load_factor.expect("an upper bound");
        assert_close(associated, number(wall, "associated"), 1e-6);
        assert!(least <= associated * (1.0 + 1e-12));
        slowest = slowest.max(result.seconds);
        lower += usize::from(least < 0.98 * associated);
        let sequential = answer(wall, "coulomb", "limit_sequential");
        if let Some(factor) = sequential.load_factor {
            assert!(least <= factor + 1e-7 * scale && factor <= associated * (1.0 + 1e-9), "{wall}: {factor}");
        }
        if !sequential.certificate.passed {
            let says = |what: &str| sequential.notes.iter().any(|note| note.contains(what));
            assert!(says("did not converge") || says("linear program"), "{wall}: {:?}", sequential.notes);
            let open = sequential.status == Status::Open && sequential.load_factor.is_some();
            assert!(open || says("an admissible field is known"), "{wall}: {:?}", sequential.notes);
            stalled += 1;
        }
    }
    println!(
        "{} walls, {lower} below 0.98 of the associated load, {open} open, slowest {slowest:.2} s, {stalled} sequences stalled",
        walls.len()
    );
    assert!(stalled * 4 <= walls.len(), "{stalled} sequences did not converge");
    assert!(open <= most_open, "{open} brackets stay open");
    lower
}

/// The least loads of walls with up to six blocks agree with an independent mixed-integer program.
#[test]
fn least_loads_of_the_smallest_walls_agree_with_a_mixed_integer_program() {
    let small: Vec<Value> = walls().into_iter().filter(|wall| blocks(wall) <= 6).collect();
    assert!(small.len() >= 100, "{}", small.len());
    let (first, rest) = small.split_at(small.len() / 2);
    std::thread::scope(|threads| {
        threads.spawn(|| check(first, 0));
        check(rest, 0);
    });
}

/// The least loads of all walls with up to nine blocks agree with an independent mixed-integer program: at least 300
/// walls, at least 50 of them with a least load below 0.98 of the associated one.
#[test]
#[ignore = "minutes"]
fn least_loads_of_all_small_walls_agree_with_a_mixed_integer_program() {
    let all: Vec<Value> = walls().into_iter().filter(|wall| blocks(wall) <= 9).collect();
    assert!(all.len() >= 300, "{}", all.len());
    assert!(check(&all, 0) >= 50);
}

/// The program of products alone, without any search, proves a bound that is never above the independent least load,
/// and that usually is this load.
#[test]
fn products_alone_bound_the_least_loads() {
    let small: Vec<Value> = walls().into_iter().filter(|wall| blocks(wall) <= 5).step_by(3).collect();
    let mut closed = 0;
    for wall in &small {
        let result = answer_with(wall, "coulomb", "solver = \"limit_least\"\nsearch_limit = 0.0");
        let [low, _] = result.both_bounds().expect("a bracket");
        let expected = number(wall, "least");
        assert!(low <= expected + 2e-7 * expected.abs().max(1e-3), "{wall}: {low}");
        closed += usize::from(low >= expected * (1.0 - 1e-6));
    }
    println!("{closed} of {} closed", small.len());
    assert!(closed * 10 >= small.len() * 9, "{closed} of {}", small.len());
}

/// Splitting the program of all products never proves more than the independent least load, and usually nearly as much.
#[test]
fn split_products_bound_the_least_loads() {
    let small: Vec<Value> = walls().into_iter().filter(|wall| blocks(wall) <= 5).step_by(9).collect();
    let (mut near, mut tried) = (0, 0);
    for wall in &small {
        let limits = "solver = \"limit_least\"\nsearch_limit = 0.0\nproduct_rows = 0\nproduct_limit = 1.0";
        let result = answer_with(wall, "coulomb", limits);
        assert!(result.certificate.passed, "{wall} {:?}", result.certificate);
        let [low, _] = result.both_bounds().expect("a bracket");
        let expected = number(wall, "least");
        println!("{low} of {expected}, {:?}", result.counters.get("product_multiplications"));
        assert!(low <= expected + 2e-7 * expected.abs().max(1e-3), "{wall}: {low}");
        tried += usize::from(expected > 0.0);
        near += usize::from(expected > 0.0 && low >= 0.98 * expected);
    }
    println!("{near} of {tried} nearly closed");
    assert!(near * 4 >= tried * 3, "{near} of {tried}");
}

/// The least loads of walls of 10 to 12 blocks agree with an independent mixed-integer program: search and products
/// together close every bracket but one, which stays open by 4e-4 (a wall that slides as a whole, found to the last
/// digit).
#[test]
#[ignore = "minutes"]
fn least_loads_of_larger_walls_agree_with_a_mixed_integer_program() {
    let larger: Vec<Value> = walls().into_iter().filter(|wall| blocks(wall) >= 10).collect();
    assert!(larger.len() >= 30, "{}", larger.len());
    assert!(check(&larger, 1) >= 20);
}
