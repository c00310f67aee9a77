//! Code that tests share: reading a study from text, solving it, and scenes in equivalent forms.
//!
//! There is one binary for each folder of `tests/tests/`: `verification` has answers from other sources, `regression`
//! our last answers, `invariance` changes that must not matter, `stress` random scenes, `conformance` every plug-in,
//! `files` studies and results read back, `messages` the exact text of every error, `architecture` the structure of the
//! code. To run one file: `cargo test --release -p voussoir-tests --test verification arch::`.

mod arch;
pub mod book;
pub mod by_hand;
pub mod family;
pub mod gates;
mod keep;
pub mod known;
pub mod random;
pub mod seen;
pub mod settled;
mod wall;
pub mod written;

pub use arch::{Arch, as_blocks};
pub use keep::{keep, keep_in};
pub use wall::Wall;

use voussoir::core::limit::Status;
use voussoir::core::path::PathSettings;
use voussoir::results::CaseResult;
use voussoir::solve_case;
use voussoir::study::{Case, Study, load};

/// Reads a study that must be valid.
pub fn study(text: &str) -> Study {
    load(text, "test.toml", &[]).unwrap_or_else(|wrong| panic!("the test's study is wrong:\n{wrong}\n{text}"))
}

/// Returns the first case of a study.
pub fn first_case(text: &str) -> Case {
    study(text).cases.swap_remove(0)
}

/// Solves the first case of a study. Panics if a certificate passes above its gate.
pub fn answered(text: &str) -> CaseResult {
    answered_within(text, 0.0)
}

/// The same, if rounding of very large strengths may leave the difference `uncertain` between the bounds.
pub fn answered_within(text: &str, uncertain: f64) -> CaseResult {
    let case = first_case(text);
    let result = solve_case(&case);
    assert_eq!(gates::above_gates(&result, case.solver.settings.tolerance, uncertain), Vec::<String>::new());
    result
}

/// Asserts that the certificate of a result passes.
pub fn passes(result: &CaseResult) {
    assert!(result.certificate.passed, "{:?} {:?}", result.certificate, result.notes);
}

/// Returns a study with an additional horizontal `share` of its last point load.
pub fn pushed(study: &str, share: f64) -> String {
    let (before, rest) = study.rsplit_once("force = [").expect("a load");
    let (force, after) = rest.split_once(']').expect("a vector");
    let (x, y) = force.split_once(", ").expect("two components");
    let [x, y]: [f64; 2] = [x, y].map(|component| component.parse().expect("a number"));
    format!("{before}force = [{:?}, {y:?}]{after}", x + share * x.abs().max(y.abs()))
}

/// Returns true if a result names a bifurcation. A note about a lost branch, or about a step to another branch, does
/// not count.
pub fn names_bifurcation(result: &CaseResult) -> bool {
    let lost = ["the branch after the peak", "to another branch"];
    let names = |note: &String| {
        let rest = lost.iter().fold(note.clone(), |note, words| note.replace(words, ""));
        rest.contains("bifurcat") || rest.contains("branch")
    };
    result.notes.iter().any(names)
}

/// Returns the load factor of a case that must collapse with a certificate.
pub fn collapse_factor(text: &str) -> f64 {
    let result = answered(text);
    assert_eq!(result.status, Status::Collapse, "{:?} {:?}", result.notes, result.certificate);
    assert!(result.certificate.passed, "{:?}", result.certificate);
    result.load_factor.expect("a collapse has a factor")
}

/// Returns the settings of a path with small displacements and defaults otherwise.
pub fn small_displacements() -> PathSettings {
    PathSettings {
        finite: false,
        tolerance: 1e-9,
        stop_displacement: None,
        stop_factor: None,
        continuation: None,
        stages: Vec::new(),
    }
}

/// Asserts |a − b| ≤ tolerance × |b|.
pub fn assert_close(a: f64, b: f64, tolerance: f64) {
    assert!((a - b).abs() <= tolerance * b.abs(), "{a:.16} is not {b:.16}: relative difference {:.2e}", (a - b) / b);
}

/// Returns the text with `from` replaced by `to`. Panics if `from` is not in the text.
pub fn changed(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "nothing to change: {from:?} is not in\n{text}");
    text.replace(from, to)
}

/// Returns a law of associated Coulomb friction.
pub fn friction(mu: f64) -> String {
    format!("law = \"coulomb_associated\"\nfriction = {mu:?}")
}

/// Returns a law of friction with a crushing strength \[Pa\].
pub fn crushing(mu: f64, strength: f64) -> String {
    format!("law = \"mohr_coulomb\"\nfriction = {mu:?}\ncompressive_strength = {strength:?}")
}

/// Returns a linear elastic material without its density.
pub fn elastic(young_modulus: f64, poisson_ratio: f64) -> String {
    format!("law = \"elastic\"\nyoung_modulus = {young_modulus:?}\npoisson_ratio = {poisson_ratio:?}")
}

/// Returns a joint law with compliance \[Pa/m\].
pub fn compliant(joint: &str, normal_stiffness: f64, shear_stiffness: f64) -> String {
    format!("{joint}\nnormal_stiffness = {normal_stiffness:?}\nshear_stiffness = {shear_stiffness:?}")
}
