//! Random elastic scenes: the exact path ends where limit analysis does, every state certified.

use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use std::cell::RefCell;
use voussoir::core::limit::Status;
use voussoir::core::mechanism::MechanismKind;
use voussoir::results::CaseResult;
use voussoir_tests::{answered, study};

/// Which law the joints have: frictionless, associated, or the real one.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Law {
    Stuck,
    Associated,
    Coulomb,
    Dilatant,
}

fn joint(law: Law, friction: f64) -> String {
    match law {
        Law::Stuck => "law = \"unilateral\"\ntangential = \"stuck\"".into(),
        Law::Associated => format!("law = \"coulomb_associated\"\nfriction = {friction:?}"),
        Law::Coulomb => format!("law = \"coulomb\"\nfriction = {friction:?}"),
        Law::Dilatant => {
            let angle = friction.atan().to_degrees() / 2.0;
            format!("law = \"coulomb\"\nfriction = {friction:?}\ndilatancy_angle = {angle:?}")
        }
    }
}

/// Materials m0 … m3 whose stiffnesses spread over `spread` powers of ten.
fn materials(spread: f64) -> String {
    (0..4)
        .map(|k| {
            let modulus = 1e10 * 10f64.powf(-spread * f64::from(k) / 3.0);
            format!("[materials.m{k}]\nlaw = \"elastic\"\nyoung_modulus = {modulus:?}\npoisson_ratio = 0.2\ndensity = 2000.0\n")
        })
        .collect()
}

fn scene(
    blocks: &[String],
    joint: &str,
    spread: f64,
    elements: [usize; 2],
    order: usize,
    stages: &str,
    solver: &str,
) -> String {
    format!(
        "name = \"random\"\n[scene]\nscene = \"blocks\"\nwidth = 0.5\nmaterial = \"m0\"\njoint = \"dry\"\nblocks = [\n{}\n]\n[scene.mesh]\nelements = [{}, {}]\norder = {order}\n{}[joints.dry]\n{joint}\n[solver]\nsolver = \"{solver}\"\n{stages}",
        blocks.join(",\n"),
        elements[0],
        elements[1],
        materials(spread)
    )
}

/// A wall in running bond with joints off the middle.
fn wall(courses: usize, bricks: usize, shift: f64, seed: usize) -> Vec<String> {
    let (length, height) = (0.4, 0.2);
    let total = bricks as f64 * length;
    let mut blocks = vec![format!(
        "{{ name = \"ground\", vertices = [[-1.0, -0.2], [{:?}, -0.2], [{:?}, 0.0], [-1.0, 0.0]], fixed = true }}",
        total + 1.0,
        total + 1.0
    )];
    for row in 0..courses {
        let mut cuts = vec![0.0];
        let offset = if row % 2 == 0 { length } else { shift * length };
        cuts.extend((0..bricks).map(|k| offset + k as f64 * length).filter(|x| *x < total - 1e-9));
        cuts.push(total);
        for (k, x) in cuts.windows(2).enumerate() {
            let (y, top) = (row as f64 * height, (row + 1) as f64 * height);
            blocks.push(format!(
                "{{ name = \"b{row}_{k}\", vertices = [[{:?}, {y:?}], [{:?}, {y:?}], [{:?}, {top:?}], [{:?}, {top:?}]], material = \"m{}\" }}",
                x[0],
                x[1],
                x[1],
                x[0],
                (seed + 7 * row + 3 * k) % 4
            ));
        }
    }
    blocks
}

/// A segmental ring between two fixed blocks.
fn ring(voussoirs: usize, rise: f64, thickness: f64, seed: usize) -> Vec<String> {
    let (span, outer) = (4.0, thickness);
    let radius = (span * span / 4.0 + rise * rise) / (2.0 * rise);
    let half = f64::atan2(span / 2.0, radius - rise);
    let centre = rise - radius;
    let at = |k: f64, r: f64| {
        let angle = half * (1.0 - 2.0 * k / voussoirs as f64);
        [-r * angle.sin(), centre + r * angle.cos()]
    };
    let quad = |a: f64, b: f64| {
        let points = [at(a, radius), at(b, radius), at(b, radius + outer), at(a, radius + outer)];
        let all: Vec<String> = points.iter().map(|p| format!("[{:?}, {:?}]", p[0], p[1])).collect();
        format!("[{}]", all.join(", "))
    };
    let mut blocks = vec![
        format!("{{ name = \"left\", vertices = {}, fixed = true }}", quad(-0.5, 0.0)),
        format!("{{ name = \"right\", vertices = {}, fixed = true }}", quad(voussoirs as f64, voussoirs as f64 + 0.5)),
    ];
    for k in 0..voussoirs {
        blocks.push(format!(
            "{{ name = \"v{k}\", vertices = {}, material = \"m{}\" }}",
            quad(k as f64, k as f64 + 1.0),
            (seed + 5 * k) % 4
        ));
    }
    blocks
}

#[derive(Default)]
struct Tally {
    scenes: usize,
    walls: usize,
    sliding: usize,
    events: Vec<usize>,
    statuses: std::collections::BTreeMap<String, usize>,
    below: usize,
    wrong: Vec<String>,
    unsolved: Vec<String>,
}

fn check(text: &str, law: Law, is_wall: bool, tally: &RefCell<Tally>) {
    let associated = {
        let other = if law == Law::Coulomb || law == Law::Dilatant {
            text.replace("law = \"coulomb\"", "law = \"coulomb_associated\"")
        } else {
            text.to_string()
        };
        let lines: Vec<&str> = other.lines().filter(|l| !l.starts_with("dilatancy_angle")).collect();
        answered(&lines.join("\n").replace("event_path", "limit_conic"))
    };
    assert!(associated.certificate.passed, "limit analysis: {:?}\n{text}", associated.notes);
    let path: CaseResult = answered(text);
    if std::env::var("SHOW").is_ok() {
        eprintln!(
            "{law:?} wall {is_wall} limit {:?} {:?} path {:?} {:?} events {} {:?} {:.2} s",
            associated.status,
            associated.load_factor,
            path.status,
            path.load_factor,
            path.events.len(),
            path.notes,
            path.seconds
        );
    }
    let tally = &mut *tally.borrow_mut();
    tally.scenes += 1;
    tally.walls += usize::from(is_wall);
    tally.events.push(path.events.len());
    *tally.statuses.entry(format!("{:?}", path.status)).or_default() += 1;
    if let Some(mechanism) = &path.mechanism {
        tally.sliding += usize::from(!mechanism.sliding.is_empty() || mechanism.kind == MechanismKind::Sliding);
    }
    let number = tally.scenes;
    let sure = law == Law::Stuck || law == Law::Associated;
    let mut wrong = Vec::new();
    let stalled = path.status == Status::Stalled && path.load_factor.is_none() && !path.notes.is_empty();
    if !sure && stalled {
        tally.unsolved.push(format!("{number} {law:?}: {:?}", path.notes));
    } else if !path.certificate.passed {
        wrong.push(format!("{number} {law:?}: {:?} {:?}", path.notes, path.certificate.failures));
    }
    if sure && path.status != associated.status {
        wrong.push(format!(
            "{number} {law:?}: {:?}, limit analysis {:?}: {:?}",
            path.status, associated.status, path.notes
        ));
    }
    if let (Some(a), Some(b)) = (path.load_factor, associated.load_factor) {
        let scale = b.abs().max(1e-6);
        if a > b + 1e-8 * scale || (sure && (a - b).abs() > 1e-8 * scale) {
            wrong.push(format!("{number} {law:?}: path {a:.12}, associated limit {b:.12}"));
        }
        tally.below += usize::from(a < 0.999 * b);
    }
    if let (false, Ok(folder)) = (wrong.is_empty(), std::env::var("KEEP")) {
        std::fs::write(format!("{folder}/{number}.toml"), text).expect("the folder exists");
    }
    tally.wrong.extend(wrong);
}

/// At least 200 scenes, a third of them walls, a third with sliding: without friction or with
/// associated flow every path ends at the limit load to 1e-8; otherwise it is certified and not
/// above, or (in less than a tenth of the scenes) given up with its reason.
#[test]
fn exact_paths_end_where_limit_analysis_does() {
    let cases = std::env::var("SCENES").ok().and_then(|n| n.parse().ok()).unwrap_or(220);
    let laws = prop_oneof![
        Just(Law::Stuck),
        Just(Law::Associated),
        Just(Law::Associated),
        Just(Law::Coulomb),
        Just(Law::Coulomb),
        Just(Law::Dilatant)
    ];
    let scenes =
        (laws, -1.3f64..0.3, 0.0f64..6.0, any::<bool>(), 2usize..5, 0.2f64..0.8, 0usize..4, 0.1f64..0.9, 0.05f64..0.95);
    let mut runner = TestRunner::new_with_rng(
        Config { cases, failure_persistence: None, max_shrink_iters: 0, ..Config::default() },
        TestRng::deterministic_rng(RngAlgorithm::ChaCha),
    );
    let tally = RefCell::new(Tally::default());
    runner
        .run(&scenes, |(law, exponent, spread, is_wall, size, shift, seed, rise, place)| {
            let friction = 10f64.powf(exponent);
            let dead = "[[stages]]\nname = \"dead\"\ngravity = 9.81\n[[stages]]\nname = \"live\"\nuntil = \"collapse\"\n";
            let text = if is_wall {
                let blocks = wall(size, 2 + seed % 3, shift, seed);
                let live = format!("{dead}loads = [{{ kind = \"body\", acceleration = [{:?}, 0.0] }}]\n", if place < 0.5 { 9.81 } else { -9.81 });
                scene(&blocks, &joint(law, friction), spread, [2, 2], 1 + seed % 2, &live, "event_path")
            } else {
                let voussoirs = 4 * size - 3 + seed;
                let blocks = ring(voussoirs, 4.0 * rise, 0.25 + 0.5 * shift, seed);
                let loaded = (place * voussoirs as f64) as usize;
                let (radius, angle) = {
                    let r = (4.0 + 16.0 * rise * rise) / (8.0 * rise);
                    let half = f64::atan2(2.0, r - 4.0 * rise);
                    (r, half * (1.0 - 2.0 * (loaded as f64 + 0.5) / voussoirs as f64))
                };
                let (x, y) = (-(radius + 0.05) * angle.sin(), 4.0 * rise - radius + (radius + 0.05) * angle.cos());
                let live = format!("{dead}loads = [{{ kind = \"point\", block = \"v{loaded}\", point = [{x:?}, {y:?}], force = [0.0, -1000.0] }}]\n");
                scene(&blocks, &joint(law, friction), spread, [1, 3], 1 + seed % 3, &live, "event_path")
            };
            if voussoir::study::load(&text, "random.toml", &[]).is_err() {
                return Ok(());
            }
            let _ = study(&text);
            check(&text, law, is_wall, &tally);
            Ok(())
        })
        .unwrap();
    let mut tally = tally.into_inner();
    tally.events.sort_unstable();
    let median = tally.events[tally.events.len() / 2];
    eprintln!(
        "{} scenes, {} walls, {} with sliding, median {median} events, {:?}, {} below 0.999 of the associated load",
        tally.scenes, tally.walls, tally.sliding, tally.statuses, tally.below
    );
    assert!(tally.wrong.is_empty(), "{}\n{}", tally.wrong.len(), tally.wrong.join("\n"));
    assert!(median >= 20 && 3 * tally.walls >= tally.scenes && 3 * tally.sliding >= tally.scenes);
    // Non-associated rate problems with very many points at the verge of a change are given up with
    // their reason; their share must not grow.
    assert!(10 * tally.unsolved.len() < tally.scenes, "{}\n{}", tally.unsolved.len(), tally.unsolved.join("\n"));
}
