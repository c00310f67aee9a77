//! Random scenes with finite displacements, each by several continuation strategies and in several disguises: an answer
//! does not depend on the strategy, its step, a mirror or the numbers of the blocks.

use std::collections::BTreeMap;
use voussoir::core::limit::Status;
use voussoir_tests::settled::{Deforming, Draw, Random, SettledScene, Settling, Shape, settled_scene};
use voussoir_tests::{answered, names_bifurcation};

/// Strategies: arc length with three step sizes, displacement control, dissipation.
const STRATEGIES: [(&str, &str); 5] = [
    ("arc_length", "{ strategy = \"arc_length\" }"),
    ("arc_length, 1/2", "{ strategy = \"arc_length\", largest_step = 0.001 }"),
    ("arc_length, 1/4", "{ strategy = \"arc_length\", largest_step = 0.0005 }"),
    ("displacement_control", "{ strategy = \"displacement_control\" }"),
    ("dissipation", "{ strategy = \"dissipation\" }"),
];

/// Loads that are equal, relative.
const APART: f64 = 1e-6;

/// Scene `k` of the family: elastic voussoirs or compliant joints, with friction or stuck, half of them settled.
pub fn scene(k: usize) -> SettledScene {
    let mut random = Random::new(5000 + k as u64);
    let shape = if k % 3 == 2 { Shape::Pier } else { Shape::Arch };
    let deforming = if k.is_multiple_of(2) { Deforming::Compliant } else { Deforming::Elastic };
    let settling = Settling::ALL[(k / 2) % 5];
    // Half of them without settlement.
    let size = if (k / 2).is_multiple_of(2) { 0.0 } else { 10f64.powf(random.uniform(-4.0, -2.3)) };
    settled_scene(&mut random, Draw { shape, deforming, settling, size, stuck: k % 4 == 3 })
}

/// What the runs of one scene said.
struct Runs {
    factors: Vec<(String, f64)>,
    stalled: Vec<(String, String)>,
    names_bifurcation: bool,
}

fn runs(k: usize) -> Runs {
    let scene = scene(k);
    let mut out = Runs { factors: Vec::new(), stalled: Vec::new(), names_bifurcation: false };
    for (name, strategy) in STRATEGIES {
        let solver = format!("solver = \"newton_path\"\nkinematics = \"finite\"\ncontinuation = {strategy}");
        let disguises = [
            ("", Some(scene.study(&solver))),
            (", mirrored", Some(scene.mirrored(&solver))),
            (", renumbered", scene.renumbered(&solver)),
        ];
        for (disguise, text) in disguises.into_iter().filter_map(|(d, text)| Some((d, text?))) {
            if let Ok(folder) = std::env::var("KEEP") {
                let name = format!("{k}{}{}", name.replace([' ', ',', '/'], "_"), disguise.replace(", ", "_"));
                std::fs::write(format!("{folder}/strategy{name}.toml"), &text).expect("the folder exists");
            }
            let result = answered(&text);
            out.names_bifurcation |= names_bifurcation(&result);
            let run = format!("{name}{disguise}");
            println!("scene {k} {run}: {:?} {:?}", result.status, result.load_factor);
            match result.load_factor {
                Some(factor) if result.status != Status::Stalled => out.factors.push((run, factor)),
                _ => out.stalled.push((run, format!("{:?} {:?}", result.status, result.notes))),
            }
        }
    }
    out
}

/// Sees that all answers of each scene agree; prints the table.
fn agree(scenes: &[usize]) {
    let (mut table, mut apart, mut unanswered) = (BTreeMap::<String, [usize; 3]>::new(), Vec::new(), Vec::new());
    let mut stalls = Vec::new();
    let count = scenes.len();
    for &k in scenes {
        let runs = runs(k);
        for (run, why) in &runs.stalled {
            table.entry(run.clone()).or_default()[1] += 1;
            stalls.push(format!("{k} {run}: {why}"));
        }
        let mut factors: Vec<f64> = runs.factors.iter().map(|(_, factor)| *factor).collect();
        factors.sort_by(f64::total_cmp);
        let Some(&middle) = factors.get(factors.len() / 2) else {
            unanswered.push(k);
            continue;
        };
        let off: Vec<String> = runs
            .factors
            .iter()
            .filter(|(_, factor)| (factor - middle).abs() > APART * middle.abs())
            .map(|(run, factor)| format!("{run}: {factor:.9}"))
            .collect();
        for (run, factor) in &runs.factors {
            let agrees = (factor - middle).abs() <= APART * middle.abs();
            table.entry(run.clone()).or_default()[if agrees { 0 } else { 2 }] += 1;
        }
        if !off.is_empty() && !runs.names_bifurcation {
            apart.push(format!("{k}: most say {middle:.9}, {}", off.join(", ")));
        }
    }
    println!("{count} scenes; run: agrees, stalls, differs");
    for (run, [agrees, stalls, differs]) in &table {
        println!("{run:40} {agrees:4} {stalls:4} {differs:4}");
    }
    println!("{}\n{}\nunanswered {unanswered:?}", apart.join("\n"), stalls.join("\n"));
    assert!(apart.is_empty(), "{} of {count} scenes depend on how they are traced:\n{}", apart.len(), apart.join("\n"));
    // A refusal that another strategy answers counts as a stall.
    let runs: usize = table.values().flatten().sum();
    assert!(50 * stalls.len() <= runs, "{} of {runs} runs stalled:\n{}", stalls.len(), stalls.join("\n"));
}

/// Five strategies, three disguises: one answer.
#[test]
fn strategies_and_disguises_agree() {
    agree(&[7, 8, 15]);
}

/// STRATEGIES=N tries N scenes from FIRST on, 250 by default.
#[test]
#[ignore = "long; of the first 18 scenes one is refused, and 4 more runs stall"]
fn strategies_and_disguises_agree_in_250_scenes() {
    let number = |name: &str, other: usize| std::env::var(name).ok().and_then(|n| n.parse().ok()).unwrap_or(other);
    let first = number("FIRST", 0);
    agree(&(first..first + number("STRATEGIES", 250)).collect::<Vec<_>>());
}
