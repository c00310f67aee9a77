//! Scenes whose load or support is shifted by 1e-6 of the scene: the answer changes by less than 1e-3, or one of the
//! two results names the bifurcation. A load below 1 kN changes by less than 1 N: it is the small difference that a
//! settlement has left.

use crate::strategies::scene;
use voussoir_tests::family::{Family, Form, family_scene};
use voussoir_tests::{answered, names_bifurcation, pushed};

const FINITE: &str = "solver = \"newton_path\"\nkinematics = \"finite\"";

/// Greatest change of a load factor from an imperfection, relative to the factor or to 1 kN.
const CHANGE: f64 = 1e-3;

/// Counts the outcomes of imperfect scenes, and lists the scenes that depend on the imperfection without a note.
fn imperfect(scenes: impl Iterator<Item = usize>) {
    let [mut alike, mut bifurcate, mut refused] = [0; 3];
    let mut apart = Vec::new();
    for k in scenes {
        let scene = scene(k);
        let perfect = answered(&scene.study(FINITE));
        for (load, what) in [(true, "load"), (false, "support")] {
            let shifted = answered(&scene.shifted(FINITE, load));
            let case = format!("{k}, {what}: {:?} becomes {:?}", perfect.load_factor, shifted.load_factor);
            println!("{case}");
            match (perfect.load_factor, shifted.load_factor) {
                (Some(before), Some(after)) if (after - before).abs() < CHANGE * before.abs().max(1.0) => alike += 1,
                (None, None) => refused += 1,
                (Some(_), Some(_)) if names_bifurcation(&perfect) || names_bifurcation(&shifted) => bifurcate += 1,
                _ => apart.push(case),
            }
        }
    }
    println!(
        "{alike} change by less than {CHANGE:e}, {bifurcate} name a bifurcation, {refused} refused, apart {apart:?}"
    );
    assert!(apart.is_empty(), "{apart:?}");
}

#[test]
fn small_imperfections_change_little() {
    imperfect([300, 302, 303].into_iter());
}

#[test]
#[ignore = "long: 50 scenes"]
fn small_imperfections_of_50_scenes_change_little() {
    imperfect(300..350);
}

/// First limit points of symmetric scenes are at most 2 % above those with an additional horizontal load of 1e-6 of the
/// last load. FIRST and CASES choose the scenes.
#[test]
fn first_limit_points_of_symmetric_scenes_change_little() {
    let number = |key: &str, default: u64| std::env::var(key).ok().and_then(|s| s.parse().ok()).unwrap_or(default);
    let (first, cases) = (number("FIRST", 12_660), number("CASES", 20));
    let mut apart = Vec::new();
    for seed in first..first + cases {
        let scene = family_scene(Family::Symmetric, seed);
        if !scene.has_point_loads() {
            continue;
        }
        let study = scene.study(Form::Given, "");
        let first = |study: &str| {
            let result = answered(study);
            result.path.first_limit_point.or(result.load_factor)
        };
        let [perfect, imperfect] = [first(&study), first(&pushed(&study, 1e-6))];
        if let (Some(perfect), Some(imperfect)) = (perfect, imperfect)
            && perfect > 1.02 * imperfect
        {
            apart.push(format!("{seed}: {perfect} instead of {imperfect}"));
        }
    }
    assert!(apart.is_empty(), "{apart:?}");
}
