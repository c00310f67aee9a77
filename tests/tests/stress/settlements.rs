//! Moving supports, in thousands of cases by hand and in a hundred in the default tests: every motion of supports,
//! every combination of deforming parts, small and finite displacements, each solver. Every answer is checked by a
//! second method for its class.
//!
//! | class | second method |
//! |---|---|
//! | rigid blocks that follow their supports or cannot | a linear program over the motions: the least overlap |
//! | small displacements, no slip or rigid | limit analysis of the unmoved scene: a settlement changes no limit load (1e-6) |
//! | small displacements, Coulomb friction | the associated limit load is not passed, and both path solvers agree or name the result that is not unique |
//! | finite, compliant joints without slip | the energy program: the first and another peak of one of its branches (1 %) |
//! | finite, else | the mirror image with half the step (1e-3), or the answer names a bifurcation |

use crate::conic::{Extreme, Rows};
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::Instant;
use voussoir::core::limit::Status;
use voussoir::core::model::Bond;
use voussoir::core::model::geometry::Vec2;
use voussoir::results::CaseResult;
use voussoir_independent::energy::{EnergyScene, TraceLimits, load_path, settle};
use voussoir_tests::settled::{Deforming, Draw, Random, SettledScene, Settling, Shape, settled_scene};
use voussoir_tests::{answered, first_case, keep, names_bifurcation};

/// A case of the family.
#[derive(Debug, Clone)]
pub struct Stratum {
    draw: Draw,
    finite: bool,
    solver: &'static str,
}

/// Returns case `k`: levels in turn, so that each level of each factor is equally frequent.
fn stratum(k: usize, random: &mut Random) -> Stratum {
    let settling = Settling::ALL[k % 5];
    let routes = [(false, "event_path"), (false, "newton_path"), (true, "newton_path"), (false, "limit_conic")];
    let (finite, solver) = routes[(k / 10) % 4];
    let deforming = match solver {
        "limit_conic" => Deforming::Rigid,
        _ if (k / 5).is_multiple_of(2) => Deforming::Compliant,
        _ => Deforming::Elastic,
    };
    let stuck = random.whole(0, 1) == 0;
    let decade = random.whole(0, 2) as f64;
    let size = 10f64.powf(-4.0 + decade * 0.8 + random.uniform(0.0, 0.8));
    let shape = if k % 7 == 6 { Shape::Pier } else { Shape::Arch };
    Stratum { draw: Draw { shape, deforming, settling, size, stuck }, finite, solver }
}

pub fn keys(stratum: &Stratum, more: &str) -> String {
    let kinematics = if stratum.finite { "finite" } else { "small" };
    format!("solver = \"{}\"\nkinematics = \"{kinematics}\"\n{more}", stratum.solver)
}

/// The outcome of a case.
#[derive(Debug, Clone, PartialEq)]
enum Class {
    Agrees,
    Wrong(String),
    Refused(String),
    Crashed,
    Slow,
}

fn answer(text: &str) -> Option<CaseResult> {
    catch_unwind(AssertUnwindSafe(|| answered(text))).ok()
}

fn factor(result: &CaseResult) -> Option<f64> {
    result.load_factor.filter(|_| result.status != Status::Stalled && result.certificate.passed)
}

/// Returns true if a result reports that its answer may not be the only one.
fn names_other_states(result: &CaseResult) -> bool {
    let several = |note: &String| ["solutions", "no rate of solution"].iter().any(|words| note.contains(words));
    names_bifurcation(result) || result.notes.iter().any(several)
}

/// Returns the fault if the greatest and the first limit point are not both peaks of the energy on one branch, within 1
/// %. Shorter steps of the energy program are tried too, since it may pass over a dip.
fn no_peaks_of_the_energy(study: &str, result: &CaseResult, own: f64) -> Option<String> {
    let energy = EnergyScene::of_case(&first_case(study));
    let first = result.path.first_limit_point.unwrap_or(own);
    let is = |load: f64, peak: &f64| (load - peak).abs() <= 1e-2 * peak.abs().max(1e-9);
    let known = |branch: &Vec<f64>| {
        branch.first().is_some_and(|peak| is(first, peak)) && branch.iter().any(|peak| is(own, peak))
    };
    let branches = settle(&energy, TraceLimits::default());
    let ends: Vec<_> = branches
        .iter()
        .filter_map(|stages| stages.last())
        .filter(|trace| trace.broken.is_none())
        .map(|trace| trace.last().landing.clone())
        .collect();
    let mut peaks = Vec::new();
    for largest in [TraceLimits::default().largest, 2e-5, 2e-6] {
        let limits = TraceLimits { largest, ..TraceLimits::default() };
        let of = |landing| load_path(&energy, landing, limits).peaks.iter().map(|peak| peak.factor).collect();
        peaks = ends.iter().map(of).collect::<Vec<Vec<f64>>>();
        if peaks.is_empty() || peaks.iter().any(known) {
            return None;
        }
    }
    Some(format!("{first:.9} and {own:.9} are no peaks of the energy: {peaks:?}"))
}

/// Compares an answer with the second method for its class; returns the fault, if any.
fn second_route(stratum: &Stratum, scene: &SettledScene, result: &CaseResult, own: f64) -> Option<String> {
    let apart = |a: f64, b: f64, tolerance: f64| (a - b).abs() > tolerance * b.abs().max(1e-9);
    if !stratum.finite {
        let limit = answered(&scene.unmoved("solver = \"limit_conic\""));
        let associated = limit.load_factor.filter(|_| limit.certificate.passed)?;
        if stratum.draw.stuck || stratum.draw.deforming == Deforming::Rigid {
            return apart(own, associated, 1e-6).then(|| format!("{own:.9} is not the limit load {associated:.9}"));
        }
        if own > associated * (1.0 + 1e-7) {
            return Some(format!("{own:.9} is above the associated limit load {associated:.9}"));
        }
        let other = if stratum.solver == "event_path" { "newton_path" } else { "event_path" };
        let other = answered(&scene.study(&keys(&Stratum { solver: other, ..stratum.clone() }, "")));
        let value = factor(&other)?;
        let unnamed = !names_other_states(result) && !names_other_states(&other);
        return (apart(own, value, 1e-3) && unnamed).then(|| format!("{own:.9}, {} says {value:.9}", other.solver));
    }
    if stratum.draw.deforming == Deforming::Compliant && stratum.draw.stuck {
        return no_peaks_of_the_energy(&scene.study(&keys(stratum, "")), result, own);
    }
    let finer =
        answered(&scene.mirrored(&keys(stratum, "continuation = { strategy = \"arc_length\", largest_step = 0.001 }")));
    let value = factor(&finer)?;
    let unnamed = !names_other_states(result) && !names_other_states(&finer);
    (apart(own, value, 1e-3) && unnamed).then(|| format!("{own:.9}, the mirror image with half the step {value:.9}"))
}

/// Returns the processor time of this thread \[s\], if the machine reports it; other work on the machine then has no
/// effect.
fn processor_seconds(started: Instant) -> f64 {
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = told.and_then(|told| told.split(' ').next()?.parse::<f64>().ok());
    nanoseconds.map_or(started.elapsed().as_secs_f64(), |nanoseconds| 1e-9 * nanoseconds)
}

pub fn scene(k: usize) -> (Stratum, SettledScene) {
    let mut random = Random::new(9000 + k as u64);
    let stratum = stratum(k, &mut random);
    let scene = settled_scene(&mut random, stratum.draw);
    (stratum, scene)
}

/// Returns the least overlap (or slip, if joints are stuck), in units of settlements, of any motion of the rigid blocks
/// whose supports move as in the study: zero if the blocks can follow. Joints slide and open as Coulomb friction
/// without dilatancy allows. This is a linear program in the motions about the origin; it shares only ends and frames
/// of joints with limit analysis.
fn least_overlap(text: &str) -> Extreme {
    let case = first_case(text);
    let stuck = text.contains("tangential = \"stuck\"");
    let bodies = &case.assembly.bodies;
    let length = case.assembly.size();
    let settlements = || case.stages.iter().flat_map(|stage| &stage.settlements);
    let size = settlements().map(|s| s.displacement.norm() + s.rotation.abs() * length).fold(1e-300, f64::max);
    // Velocity of a point of a block in a direction: entries over its own motion, and the prescribed part.
    let along = |body: usize, point: Vec2, direction: Vec2| -> ([f64; 3], f64) {
        let own = if bodies[body].fixed { 0.0 } else { 1.0 };
        let lever = (point.x * direction.y - point.y * direction.x) / length;
        let told = settlements().filter(|s| s.body == body).map(|s| {
            let from = point - s.about;
            let turned = Vec2::new(-from.y, from.x) * s.rotation;
            (s.displacement + turned).dot(&direction) / size
        });
        ([own * direction.x, own * direction.y, own * lever], told.sum())
    };
    let overlap = 3 * bodies.len();
    let (mut equations, mut unequal) = (Vec::new(), Vec::new());
    for joint in &case.assembly.joints {
        let (n, t) = joint.frame();
        for end in joint.ends {
            for direction in [n, t] {
                let [(plus, a), (minus, b)] = [joint.plus, joint.minus].map(|body| along(body, end, direction));
                let mut entries = Vec::new();
                for i in 0..3 {
                    entries.push((3 * joint.plus + i, plus[i]));
                    entries.push((3 * joint.minus + i, -minus[i]));
                }
                let of = |sign: f64| -> Vec<(usize, f64)> {
                    entries.iter().map(|&(j, v)| (j, -sign * v)).chain([(overlap, -1.0)]).collect()
                };
                match joint.bond {
                    Bond::Bonded => equations.push((entries, b - a)),
                    Bond::Law(_) if direction == n => unequal.push((of(1.0), a - b)),
                    Bond::Law(_) if stuck => unequal.extend([(of(1.0), a - b), (of(-1.0), b - a)]),
                    Bond::Law(_) => {}
                }
            }
        }
    }
    let mut rows = Rows::new(overlap + 1);
    equations.iter().for_each(|(entries, right)| rows.row(entries, *right));
    rows.linear_from = equations.len();
    unequal.iter().for_each(|(entries, right)| rows.row(entries, *right));
    rows.row(&[(overlap, -1.0)], 0.0);
    rows.extreme(overlap, -1.0)
}

/// Returns the fault of an answer to the question if rigid blocks follow their supports.
fn wrongly_followed(text: &str, result: &CaseResult) -> Option<String> {
    let blocked = match result.status {
        Status::NoEquilibrium if result.proof.ray.is_some() => true,
        Status::NoEquilibrium | Status::Stalled => return None,
        _ => false,
    };
    let least = least_overlap(text);
    let fits = match least {
        Extreme::Value(least) => blocked == (least > 1e-6),
        _ => false,
    };
    (!fits).then(|| format!("{:?}, and blocks overlap by {least:?} settlements", result.status))
}

fn classify(k: usize) -> (Stratum, Class) {
    let (stratum, scene) = scene(k);
    let text = scene.study(&keys(&stratum, ""));
    let now = Instant::now();
    let before = processor_seconds(now);
    let result = answer(&text);
    let seconds = processor_seconds(now) - before;
    let followed = result.as_ref().is_some_and(|result| result.notes.iter().any(|n| n.starts_with("followed by")));
    if followed {
        println!("case {k}: another strategy than the usual one answers");
    }
    let class = match &result {
        None => Class::Crashed,
        Some(_) if seconds > 60.0 => Class::Slow,
        Some(result)
            if stratum.draw.deforming == Deforming::Rigid
                && let Some(why) = wrongly_followed(&text, result) =>
        {
            Class::Wrong(why)
        }
        // Dead load alone, or the settlement itself, may be impossible to carry.
        Some(result) if matches!(result.status, Status::NoEquilibrium | Status::Unbounded | Status::LimitPoint) => {
            Class::Agrees
        }
        Some(result) => match factor(result) {
            None => Class::Refused(format!("{:?} {:?} {:?}", result.status, result.notes, result.certificate.failures)),
            Some(own) => second_route(&stratum, &scene, result, own).map_or(Class::Agrees, Class::Wrong),
        },
    };
    if followed || class != Class::Agrees {
        keep(&format!("settlement{k}.toml"), &text);
    }
    (stratum, class)
}

/// Tries some cases and prints the table by level of each factor: cases, wrong, crashes, over 60 s, refused.
fn family(range: std::ops::Range<usize>) -> [usize; 5] {
    let mut table = BTreeMap::<String, [usize; 5]>::new();
    let mut said = Vec::new();
    let mut total = [0; 5];
    for k in range {
        let (stratum, class) = classify(k);
        // Print each case at once, so that the results of an interrupted run are known.
        println!("case {k}: {class:?}");
        let column = match &class {
            Class::Agrees => None,
            Class::Wrong(_) => Some(1),
            Class::Crashed => Some(2),
            Class::Slow => Some(3),
            Class::Refused(_) => Some(4),
        };
        let draw = stratum.draw;
        let kinematics = if stratum.finite { "finite" } else { "small" };
        let levels = [
            format!("settlement {:?}", draw.settling),
            format!("deforming {:?}", draw.deforming),
            format!("displacements {kinematics}"),
            format!("solver {}", stratum.solver),
            format!("joints {}", if draw.stuck { "stuck" } else { "coulomb" }),
            format!("size 1e{:.0}", draw.size.log10().floor()),
        ];
        let count = |row: &mut [usize; 5]| {
            row[0] += 1;
            if let Some(column) = column {
                row[column] += 1;
            }
        };
        for level in levels {
            count(table.entry(level).or_default());
        }
        count(&mut total);
        if class != Class::Agrees {
            said.push(format!("{k} {draw:?} {kinematics} {}: {class:?}", stratum.solver));
        }
    }
    println!("{:32} cases wrong crashes over 60 s refused", "level");
    for (level, row) in table.iter().chain([(&"all".to_string(), &total)]) {
        println!("{level:32} {:5} {:5} {:7} {:9} {:7}", row[0], row[1], row[2], row[3], row[4]);
    }
    println!("{}", said.join("\n"));
    total
}

/// A hundred cases of small displacements with every motion of supports: exact and Newton paths on compliant and
/// elastic scenes, and rigid blocks without compliance. Cases with finite displacements take longer
/// (`supports_that_move`).
#[test]
fn a_hundred_supports_that_move() {
    let tens = [0, 3, 4, 7, 8, 11, 12, 16, 5, 9];
    let wrong: Vec<[usize; 5]> = tens
        .into_iter()
        .map(|ten| family(10 * ten..10 * ten + 10))
        .filter(|tally| *tally != [10, 0, 0, 0, 0])
        .collect();
    assert!(wrong.is_empty(), "{wrong:?}");
}

/// A ray and a linear program over the motions both prove that rigid blocks cannot follow their supports; in one scene
/// they can follow.
#[test]
fn supports_that_rigid_blocks_cannot_follow() {
    for k in [1312, 2030, 2837] {
        let (stratum, scene) = scene(k);
        let text = scene.study(&keys(&stratum, ""));
        let result = answered(&text);
        assert_eq!((result.status, result.proof.ray.is_some()), (Status::NoEquilibrium, true), "{k}");
        assert_eq!(wrongly_followed(&text, &result), None, "{k}");
        if stratum.draw.settling == Settling::In {
            let outwards = text.replace("displacement = [0", "displacement = [-0");
            let result = answered(&outwards);
            assert!(result.certificate.passed && result.status != Status::NoEquilibrium, "{k}: {:?}", result.status);
            assert_eq!(wrongly_followed(&outwards, &result), None, "{k}");
        }
    }
}

/// A path passes a sharp fold in the right direction: a longest step of a thousandth of the arch gives 11 484.9171.
#[test]
fn a_sharp_fold_is_passed_in_the_right_sense() {
    let (stratum, scene) = scene(1463);
    let result = answered(&scene.study(&keys(&stratum, "")));
    let found = factor(&result).expect("an answer");
    assert!((found - 11_484.917).abs() <= 1e-6 * found, "{found} {:?}", result.notes);
}

/// A path does not turn back at a corner with the greatest load, however steep the branch after it. The energy program
/// gives 158.41213799 on this branch.
#[test]
fn a_path_does_not_turn_back_at_a_corner() {
    let (stratum, scene) = scene(2343);
    for step in ["0.002", "0.0005"] {
        let strategy = format!("continuation = {{ strategy = \"arc_length\", largest_step = {step} }}");
        let result = answered(&scene.study(&keys(&stratum, &strategy)));
        let peaks: Vec<f64> = result.path.limit_points.iter().map(|peak| peak.factor).collect();
        assert!((peaks[0] - 158.412_153).abs() <= 1e-7 * peaks[0], "{step}: {peaks:?}");
        assert_eq!(result.load_factor, Some(peaks[0]), "{step}: {peaks:?}");
        assert!(result.path.branches.is_empty(), "{step}: {:?}", result.notes);
    }
}

/// Folds at which only one rate among thousands continues the path are passed: a point opens while all sliding points
/// stop (1264), or one begins to slide while others stop (1508). Paths with another first step give the same loads.
#[test]
fn folds_of_many_points_are_passed() {
    for (k, known) in [(1264, 7.462_409_788), (1508, 7_481.227_062)] {
        let (stratum, scene) = scene(k);
        let further = "continuation = { strategy = \"arc_length\" }\nstop = { displacement = 0.5 }";
        let result = answered(&scene.study(&keys(&stratum, further)));
        let mut found = result.path.limit_points.iter().map(|peak| peak.factor).chain(result.load_factor);
        assert!(found.any(|found| (found - known).abs() <= 1e-7 * known), "{k}: {:?}", result.path.limit_points);
    }
}

/// A settlement that cannot continue at a corner snaps and then reaches its prescribed value. Steps of a thousandth to
/// a hundred thousandth of the arch give the same factor to 2e-10.
#[test]
fn a_settlement_that_turns_back_at_a_corner_snaps() {
    let (stratum, scene) = scene(383);
    let result = answered(&scene.settlement_only(&keys(&stratum, "")));
    assert_eq!((result.status, result.certificate.passed), (Status::Stands, true), "{:?}", result.notes);
    let snap = |note: &String| note.starts_with("at factor 0.8053720") && note.contains("snaps");
    assert!(result.notes.iter().any(snap), "{:?}", result.notes);
}

/// A step of a settlement does not jump to another branch. Steps of 1e-4 and 3e-5 of the arch end at the same state to
/// 1e-13.
#[test]
fn a_step_of_a_settlement_does_not_jump() {
    let (stratum, scene) = scene(1904);
    let result = answered(&scene.settlement_only(&keys(&stratum, "")));
    assert_eq!((result.status, result.certificate.passed), (Status::Stands, true), "{:?}", result.notes);
    assert!(!result.notes.iter().any(|note| note.contains("snaps")), "{:?}", result.notes);
    let crown = result.stages[1].hinges.iter().find(|hinge| hinge.joint == 6).expect("a hinge");
    assert!((crown.rotation - 0.019_278_869_708_4).abs() < 1e-10, "{}", crown.rotation);
}

/// CASES=N tries N cases from FIRST on.
#[test]
#[ignore = "long; what came out stands in docs/notebook/random_scenes.md"]
fn supports_that_move() {
    let number = |name: &str, other: usize| std::env::var(name).ok().and_then(|n| n.parse().ok()).unwrap_or(other);
    let first = number("FIRST", 0);
    let [cases, wrong, crashes, slow, refused] = family(first..first + number("CASES", 100));
    assert_eq!([wrong, crashes, slow], [0; 3]);
    assert!(50 * refused <= cases, "{refused} of {cases} refused");
}
