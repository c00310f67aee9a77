//! Random limit scenes against an independent program: arches of every profile, walls, blocks of any shape, degenerate
//! scenes; laws of every kind, loads in all directions. The program reads the vertices of blocks and computes the rest
//! again: joints as overlaps of edges, weights, loads, strengths, equilibrium. It shares no code with the model and the
//! solvers of Voussoir.

mod assemblies;
mod families;
mod model;

use self::families::{FAMILIES, Scene, scene};
use self::model::Carried;
use std::collections::BTreeMap;
use voussoir::core::limit::Status;
use voussoir::results::CaseResult;
use voussoir::solve_case;
use voussoir_tests::gates::above_gates;
use voussoir_tests::{first_case, keep};

/// Relative difference of equal factors.
const SAME: f64 = 2e-6;

/// The outcome of a comparison.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Verdict {
    Collapse,
    Unbounded,
    NoEquilibrium,
    Stalled,
    /// The independent program did not decide.
    Undecided,
    /// A certificate passed above a gate.
    AboveGate,
    Wrong,
}

/// Compares the answers of some scenes with the independent program; a share of the scenes may be refused as invalid.
fn compare(seeds: std::ops::Range<u64>) -> BTreeMap<(&'static str, Verdict), usize> {
    let (mut counts, mut bad) = (BTreeMap::new(), Vec::new());
    for seed in seeds {
        let Some(Scene { family, text, model }) = scene(seed).filter(|scene| scene.model.is_loaded()) else { continue };
        if let Err(why) = voussoir::study::load(&text, "random.toml", &[]) {
            if std::env::var_os("REFUSED").is_some() {
                println!("{seed}, {family}: {why}");
            }
            continue;
        }
        let case = first_case(&text);
        assert_eq!(case.assembly.joints.len(), joints_of(&model, &text), "{seed}\n{text}");
        let result = solve_case(&case);
        let (carried, unit) = (model.carried(), model.typical_factor());
        // Bounds may differ by the rounding of very large strengths, as the certificate allows, and by the rounding of
        // vertices far from the origin, which rotates joints: by 1.2e-11 of the loads for a scene that is 140 sizes
        // away.
        let enormous = model.laws.iter().any(|law| law.is_enormous());
        let rounding = 1e-8 * (model.sizes_from_origin() / 100.0).max(1.0);
        let above = above_gates(&result, 1e-9, if enormous { f64::INFINITY } else { rounding });
        let verdict = if above.is_empty() { verdict(&result, carried, unit) } else { Verdict::AboveGate };
        *counts.entry((family, verdict)).or_default() += 1;
        if !matches!(verdict, Verdict::Collapse | Verdict::Unbounded | Verdict::NoEquilibrium) {
            let said = format!("{:?} {:?} {:?}", result.status, result.load_factor, result.feasible_interval);
            let said = format!("{said}, {:?}, {:?}, {above:?}", result.bounds, result.notes);
            bad.push((verdict, format!("{seed}, {family}: {said}, but {carried:?}")));
            keep(&format!("{seed}.toml"), &text);
        }
    }
    bad.sort();
    bad.iter().for_each(|(verdict, said)| println!("{verdict:?}: {said}"));
    assert!(bad.iter().all(|(verdict, _)| !matches!(verdict, Verdict::Wrong | Verdict::AboveGate)));
    counts
}

/// Returns the number of joints of the scene of the text: as many as in the model, plus those that bonded ends remove
/// from it.
fn joints_of(model: &model::Model, text: &str) -> usize {
    model.contacts.len() + if text.contains("ends = \"bonded\"") { 2 } else { 0 }
}

fn verdict(result: &CaseResult, carried: Carried, unit: f64) -> Verdict {
    // For loads far above the dead load the independent program has fewer digits.
    let same = |a: f64, b: f64| {
        let digits = if b.abs() > 100.0 * unit { 5.0 } else { 1.0 };
        a == b || (a - b).abs() <= digits * SAME * (b.abs() + 1e-3 * unit)
    };
    // If the dead load is only just carried, both answers are right.
    let at_zero = |end: f64| end.abs() <= 1e-6 * unit;
    if result.status == Status::Stalled || !result.certificate.passed {
        return Verdict::Stalled;
    }
    let (low, high) = match carried {
        Carried::Unknown => return Verdict::Undecided,
        Carried::No => {
            return if result.status == Status::NoEquilibrium { Verdict::NoEquilibrium } else { Verdict::Wrong };
        }
        Carried::Between([low, high]) => (low, high),
    };
    let zero = (low < 0.0 || at_zero(low)) && (high > 0.0 || at_zero(high));
    match (result.status, result.load_factor) {
        // Strengths are far above all loads: no digit of the load is significant.
        (Status::Collapse, Some(factor)) if zero && factor.min(high) > 1e6 * unit => Verdict::Unbounded,
        (Status::Collapse, Some(factor)) if zero && same(factor, high) => Verdict::Collapse,
        (Status::Unbounded, _) if zero && high.is_infinite() => Verdict::Unbounded,
        (Status::NoEquilibrium, _) if !zero || at_zero(low) || at_zero(high) => {
            let said = result
                .feasible_interval
                .map(|ends| [ends[0].unwrap_or(f64::NEG_INFINITY), ends[1].unwrap_or(f64::INFINITY)]);
            match said {
                Some([from, to]) if !same(from, low) || !same(to, high) => Verdict::Wrong,
                _ => Verdict::NoEquilibrium,
            }
        }
        _ => Verdict::Wrong,
    }
}

fn count(counts: &BTreeMap<(&'static str, Verdict), usize>, verdict: Verdict) -> usize {
    counts.iter().filter(|((_, own), _)| *own == verdict).map(|(_, count)| count).sum()
}

/// 60 random scenes carry the load of an independent program. `LIMIT_SCENES` sets the number, `LIMIT_FIRST` the first
/// seed, `KEEP=FOLDER` writes the scenes with a wrong answer.
#[test]
fn random_scenes_carry_what_an_independent_program_says() {
    let number = |name: &str| std::env::var(name).ok().and_then(|text| text.parse::<u64>().ok());
    let (first, scenes) = (number("LIMIT_FIRST").unwrap_or(0), number("LIMIT_SCENES").unwrap_or(60));
    let counts = compare(first..first + scenes);
    for family in FAMILIES {
        let own: Vec<_> = counts.iter().filter(|((own, _), _)| *own == family).map(|((_, v), n)| (v, n)).collect();
        println!("{family}: {own:?}");
    }
    let all: usize = counts.values().sum();
    let [stalled, undecided] = [Verdict::Stalled, Verdict::Undecided].map(|verdict| count(&counts, verdict));
    assert!(all as u64 * 10 >= scenes * 8, "{all} scenes");
    assert!(stalled * 100 <= all && undecided * 50 <= all, "{stalled} stalled, {undecided} undecided");
    assert!(count(&counts, Verdict::Collapse) * 3 > all, "{counts:?}");
}

/// Difficult scenes are solved, as an independent program confirms: cohesion of 1e10 Pa and more, friction of 1e12,
/// beams without weight, blocks a kilometre from the origin, a tower on its edge, a wall with crushing.
#[test]
fn scenes_that_once_stalled_are_answered() {
    for seed in [470, 890, 982, 1157, 1355, 1541, 1657, 1725, 1990] {
        let counts = compare(seed..seed + 1);
        assert_eq!(counts.values().sum::<usize>(), 1, "{seed}");
        assert_eq!(count(&counts, Verdict::Stalled), 0, "{seed}");
    }
}
