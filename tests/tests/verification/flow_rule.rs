//! Non-associated flow: walls of Ferris & Tin-Loi (2001), Int. J. Mech. Sci. 43, and Gilbert, Casapulla & Ahmed (2006),
//! Computers & Structures 84, and cases that follow from statics alone.

use voussoir::core::limit::Status;
use voussoir::results::CaseResult;
use voussoir::solve_case;
use voussoir::study::load;
use voussoir::verify::verify;
use voussoir_tests::known::{FIVE, PublishedWall, REFERENCE_ARCH, REFERENCE_ARCH_LOW_FRICTION, SIX, published_wall};
use voussoir_tests::{Arch, Wall, answered, assert_close, study};

/// Returns a wall with this joint and solver.
fn wall(wall: Wall, joint: &str, solver: &str) -> String {
    Wall { joint: joint.into(), solver: solver.into(), ..wall }.study()
}

const COULOMB: &str = "law = \"coulomb\"\nfriction = 0.65";

fn collapse(text: &str) -> (f64, CaseResult) {
    let result = answered(text);
    assert_eq!(result.status, Status::Collapse, "{:?} {:?}", result.notes, result.certificate);
    assert!(result.certificate.passed, "{:?}", result.certificate);
    (result.load_factor.expect("a factor"), result)
}

/// Checks that the least load of wall `number` is `least`; prints bracket and time. `LEAST_SEARCH` gives the search
/// more work than the second that the test allows.
fn least_of(number: usize) {
    let PublishedWall { wall: bricks, least, associated, .. } = published_wall(number);
    let limit = std::env::var("LEAST_SEARCH").unwrap_or("1.0".into());
    let solver = format!("solver = \"limit_least\"\nsearch_limit = {limit}");
    let result = answered(&wall(bricks, COULOMB, &solver));
    let found = result.load_factor.expect("a factor");
    let [low, high] = result.bounds.expect("a bracket");
    // Without a proved lower end the least load is open.
    assert_eq!(result.status, if low.is_some() { Status::Collapse } else { Status::Open }, "{:?}", result.certificate);
    assert_close(found, least, 2e-8);
    assert_close(result.non_associated.associated_load_factor.expect("an upper bound"), associated, 2e-8);
    let low = low.unwrap_or(0.0);
    assert!(0.0 <= low && low <= least * (1.0 + 2e-8) && high == Some(found));
    println!("wall {number}: [{low:.8}, {found:.8}] in {:.1} s, {:?}", result.seconds, result.counters);
    let end = result.non_associated.bracket.last().expect("a curve");
    assert_eq!((end.lower, end.found), (low, Some(found)));
    // The search gives up if it cannot prove a bound.
    assert!(low > 0.0 || result.notes.iter().any(|note| note.contains("given up")), "{:?}", result.notes);
    assert_eq!(result.flow_read_as, None);
    assert!(result.certificate.residuals["complementarity"] < 1e-12, "{:?}", result.certificate);
}

/// The least load of wall 1 is .63898183, as an independent program finds, below the published .640.
#[test]
fn least_of_wall_1() {
    least_of(1);
}

/// The least load is .35581738; the published value is .356.
#[test]
fn least_of_wall_3() {
    least_of(3);
}

/// The least load is 24/91; the published value is .264.
#[test]
fn least_of_wall_4() {
    least_of(4);
}

/// Gilbert, Casapulla & Ahmed (2006) print .640, .356, .264. On wall 1 the sequence ends at the load of the path of
/// elastic blocks (.6399686, `docs/theory/flow_rule.md`), above the least load.
#[test]
fn sequential_programs_give_the_published_factors() {
    for PublishedWall { number, wall: bricks, least, published: printed, .. } in [1, 3, 4].map(published_wall) {
        let (factor, result) = collapse(&wall(bricks, COULOMB, "solver = \"limit_sequential\""));
        println!("wall {number}: {factor:.8}, {:.2} s, {:?}", result.seconds, result.counters);
        assert!((factor - printed).abs() <= 0.5e-3, "wall {number}: {factor}");
        assert!(factor >= least * (1.0 - 1e-7));
        assert!(factor <= result.non_associated.associated_load_factor.expect("an upper bound") * (1.0 + 1e-9));
        assert!(result.counters["linear_programs"] <= 40 && result.counters["pivots"] <= 1000);
    }
}

/// Returns the bricks of a wall of Ferris & Tin-Loi as `blocks`, every `stride`-th first and with rotated lists of
/// vertices: joints have other numbers and other ends.
fn as_blocks(rows: &[&[f64]], stride: usize) -> String {
    let mut bricks = Vec::new();
    for (course, row) in rows.iter().enumerate() {
        let (mut left, low) = (0.0, 0.175 * course as f64);
        for length in row.iter().map(|part| 0.4 * part) {
            let (right, high) = (left + length, low + 0.175);
            let mut corners = [[left, low], [right, low], [right, high], [left, high]];
            corners.rotate_left(bricks.len() * stride % 4);
            bricks.push(format!("{{ name = \"b{}\", vertices = {corners:?} }}", bricks.len()));
            left = right;
        }
    }
    bricks.push("{ name = \"ground\", fixed = true, vertices = [[-1, -1], [9, -1], [9, 0], [-1, 0]] }".into());
    let shuffled: Vec<_> = (0..stride).flat_map(|first| bricks.iter().skip(first).step_by(stride).cloned()).collect();
    let study = wall(Wall::of_rows(rows), COULOMB, "solver = \"limit_sequential\"");
    let brick = "brick = [0.4, 0.175]\n";
    let study = study.replace("scene = \"wall\"", "scene = \"blocks\"").replace(brick, "");
    study.replace(&format!("rows = {rows:?}"), &format!("blocks = [{}]", shuffled.join(", ")))
}

/// A wall has the same sequential load for any order of blocks, as `wall` and as `blocks`: of the fields that carry a
/// factor the sequence uses the one of least fictitious cohesion. This holds also for a second wall with ten courses.
#[test]
fn a_wall_has_one_sequential_load_however_it_is_numbered() {
    let rows: Vec<&[f64]> = [SIX, FIVE].into_iter().cycle().take(10).collect();
    for (courses, within) in [(6, 1e-10), (10, 2e-8)] {
        let rows = &rows[..courses];
        let factor = collapse(&wall(Wall::of_rows(rows), COULOMB, "solver = \"limit_sequential\"")).0;
        println!("{courses} courses: {factor}");
        for stride in [1, 7] {
            assert_close(collapse(&as_blocks(rows, stride)).0, factor, within);
        }
    }
}

/// Sequential programs solve a wall of 20 courses by 20 bricks in seconds.
#[test]
fn twenty_by_twenty_in_sequence() {
    let text = wall(Wall::in_bond(20, 20), COULOMB, "solver = \"limit_sequential\"");
    let result = answered(&text);
    println!("{:?} {:?} {:.1} s {:?}", result.status, result.load_factor, result.seconds, result.counters);
    assert!(result.status == Status::Collapse || result.notes.iter().any(|note| note.contains("did not converge")));
    assert!(result.counters["linear_programs"] >= 1);
}

/// The programs of a wall of twelve by twelve cubes wander between 0.279537 and 0.279624. The result is open. Its upper end is a
/// certified state below the associated load, for `limit_sequential` and for `limit_least`, whose search is too small for this wall.
#[test]
fn a_sequence_that_wanders_has_a_certified_upper_end() {
    for solver in ["limit_sequential", "limit_least"] {
        let cubes = Wall { brick: [1.0, 1.0], ..Wall::in_bond(12, 12) };
        let result = answered(&wall(cubes, "law = \"coulomb\"\nfriction = 0.7", &format!("solver = \"{solver}\"")));
        assert_eq!(result.status, Status::Open, "{:?}", result.notes);
        let [lower, upper] = result.bounds.expect("an upper end");
        let associated = result.non_associated.associated_load_factor.expect("an upper bound");
        assert_close(associated, 0.337289824, 1e-8);
        assert_eq!((lower, upper), (None, result.load_factor));
        // The least load of this mechanism by a linear program of blocks, independent of this project (HiGHS).
        assert_close(upper.expect("an upper end"), 0.2674418604651161, 1e-9);
        let residuals = &result.certificate.residuals;
        assert!(residuals["complementarity"] < 1e-6 && residuals["flow"] < 1e-6, "{residuals:?}");
        assert!(result.notes.iter().any(|note| note.contains("wander between")), "{:?}", result.notes);
    }
}

/// A state whose bracket stays open is a local minimum: no exchange of one mode lowers its load.
#[test]
fn an_open_bracket_is_a_local_minimum() {
    let cubes = Wall { brick: [1.0, 1.0], ..Wall::in_bond(6, 7) };
    let result = answered(&wall(cubes, "law = \"coulomb\"\nfriction = 0.7", "solver = \"limit_least\""));
    assert!(
        result.load_factor.is_some_and(|factor| (factor - 0.28688524590163).abs() < 1e-10),
        "{:?}",
        result.load_factor
    );
    assert!(result.notes.iter().any(|note| note.contains("the load found is a local minimum")), "{:?}", result.notes);
}

/// Dilatancy equal to the friction angle is associated flow; for smaller dilatancy the least load is not above it.
#[test]
fn dilatancy_equal_to_friction_is_associated() {
    let rows: Vec<&[f64]> = vec![&[1.0; 3], &[0.5, 1.0, 1.0, 0.5], &[1.0; 3]];
    let with = |joint: &str| collapse(&wall(Wall::of_rows(&rows), joint, "solver = \"limit_least\"")).0;
    let associated = with("law = \"coulomb_associated\"\nfriction_angle = 40.0");
    let equal = with("law = \"coulomb\"\nfriction_angle = 40.0\ndilatancy_angle = 40.0");
    assert_close(equal, associated, 1e-14);
    let factors: Vec<f64> = [0.0, 20.0]
        .map(|angle| with(&format!("law = \"coulomb\"\nfriction_angle = 40.0\ndilatancy_angle = {angle:?}")))
        .into();
    assert!(factors.iter().all(|factor| *factor <= associated * (1.0 + 1e-12)), "{factors:?} {associated}");
}

/// Without friction the law is the same as `unilateral` with a free tangent.
#[test]
fn no_friction_is_a_free_tangent() {
    let rows: Vec<&[f64]> = vec![&[1.0; 3], &[0.5, 1.0, 1.0, 0.5]];
    for joint in ["law = \"coulomb\"\nfriction = 0.0", "law = \"unilateral\"\ntangential = \"free\""] {
        for solver in ["limit_least", "limit_sequential", "limit_conic"] {
            assert_eq!(
                collapse(&wall(Wall::of_rows(&rows), joint, &format!("solver = \"{solver}\""))).0,
                0.0,
                "{joint} {solver}"
            );
        }
    }
    let arch = |joint: &str| {
        let joint = joint.to_string();
        answered(&Arch { joint, ends: "jointed", solver: "limit_least", ..Arch::default() }.study()).status
    };
    let free = arch("law = \"unilateral\"\ntangential = \"free\"");
    assert_eq!(arch("law = \"coulomb\"\nfriction = 0.0"), free);
}

/// The bracket of an arch with blocks that slide out between inclined joints closes: if rounding finds the known state
/// again, the proof continues a little further below it.
#[test]
fn a_flat_arch_closes() {
    let study = study(include_str!("../../../studies/cases/flow_rule_ten_scenes.toml"));
    for name in ["flat arch on piers, friction 0.5", "arch on inclined springings, friction 0.3"] {
        let mut cases = study.cases.iter().filter(|case| case.variant.as_deref() == Some("least"));
        let case = cases.find(|case| case.scene.as_deref() == Some(name)).expect("a scene of the study");
        let result = solve_case(case);
        let ([low, _], found) = (result.both_bounds().expect("a bracket"), result.load_factor.expect("a factor"));
        assert!(low >= found * (1.0 - 2e-6), "{name}: [{low}, {found}] {:?}", result.notes);
    }
}

/// Two rings without bond are highly redundant: the least load is well below the associated one, and no load is below
/// it.
#[test]
fn two_rings_feel_the_flow_rule() {
    let study = study(include_str!("../../../studies/cases/flow_rule_rings.toml"));
    let mut ratios = Vec::new();
    for case in study.cases.iter().filter(|case| case.variant.as_deref() == Some("least")) {
        let result = solve_case(case);
        let ([low, _], found) = (result.both_bounds().expect("a bracket"), result.load_factor.expect("a factor"));
        assert!(result.certificate.passed && low >= found * (1.0 - 2e-6), "[{low}, {found}] {:?}", result.notes);
        ratios.push(found / result.non_associated.associated_load_factor.expect("an upper bound"));
    }
    assert_eq!(ratios.len(), 4);
    assert!(ratios.is_sorted_by(|a, b| a > b) && ratios[3] < 0.9, "{ratios:?}");
}

/// A brick above an opening that only friction in its vertical joints can hold is reported: an admissible field exists,
/// so the associated load, known from a linear program, is positive. But with slip without dilatancy dead load alone is
/// at a limit state, and no state with p·q̇ = 1 is below it. The elastic path, which starts without compression in the
/// joints, finds no equilibrium.
#[test]
fn a_brick_held_by_wedging_alone_is_reported() {
    let rows: Vec<&[f64]> = vec![&[1.0, -1.0, 1.0], &[1.0; 3], &[0.5, 1.0, 1.0, 0.5], &[1.0; 3]];
    let (factor, result) =
        collapse(&wall(Wall::of_rows(&rows), "law = \"coulomb\"\nfriction = 0.4", "solver = \"limit_least\""));
    // 25/164, by a linear program of another code.
    assert_close(factor, 0.152_439_024_390_243_9, 1e-9);
    assert_eq!(result.flow_read_as.as_deref(), Some("associated"));
    assert!(result.notes.iter().any(|note| note.contains("wedging alone")), "{:?}", result.notes);
}

/// A wall that slides as a whole has many fields and one factor, that of friction: the sequence ends at this factor
/// also if the scene is too large for the simplex method.
#[test]
fn a_wall_that_slides_as_a_whole_ends_the_sequence() {
    let joint = "law = \"coulomb\"\nfriction = 0.3";
    let text = wall(Wall::in_bond(12, 12), joint, "solver = \"limit_sequential\"");
    assert_close(collapse(&text).0, 0.3, 1e-6);
}

/// In a segmental ring four yielding joints determine the three redundants and the factor for any flow, so the least
/// load is equal to the associated one, and the search proves it.
#[test]
fn a_single_ring_hardly_feels_the_flow_rule() {
    for (friction, expected) in [(0.6, REFERENCE_ARCH), (0.3, REFERENCE_ARCH_LOW_FRICTION)] {
        let joint = format!("law = \"coulomb\"\nfriction = {friction:?}");
        let (least, result) = collapse(&Arch { joint, ..Arch::default() }.study());
        assert_eq!(result.solver, "limit_least");
        println!("friction {friction}: {:?} in {:.3} s {:?}", result.bounds, result.seconds, result.counters);
        assert_close(least, expected, 1e-9);
        assert_close(result.both_bounds().expect("a bracket")[0], expected, 3e-8);
        assert_close(result.non_associated.associated_load_factor.expect("an upper bound"), expected, 1e-11);
    }
}

/// `verify` confirms the results of `run`, and finds a changed mechanism, field or associated bound.
#[test]
fn results_are_verified_and_changes_found() {
    let rows: Vec<&[f64]> = vec![&[1.0; 3], &[0.5, 1.0, 1.0, 0.5], &[1.0; 3]];
    for solver in ["limit_least", "limit_sequential"] {
        let original = study(&wall(Wall::of_rows(&rows), COULOMB, &format!("solver = \"{solver}\"")));
        let resolved = toml::to_string(&original.resolved).expect("a study can be written");
        let again = load(&resolved, "resolved.toml", &[]).expect("and read");
        let results = original.results("test", original.cases.iter().map(solve_case).collect());
        assert_eq!(results.cases[0].status, Status::Collapse, "{solver}: {:?}", results.cases[0].notes);
        assert_eq!(verify(&again, &results), vec![]);
        let changes: [fn(&mut CaseResult); 6] = [
            |r| r.load_factor = r.load_factor.map(|f| f * 0.999),
            |r| r.flow_read_as = Some("associated".into()),
            |r| r.non_associated.associated_load_factor = r.non_associated.associated_load_factor.map(|f| f * 1.001),
            |r| r.proof.associated_motion = None,
            |r| r.proof.field.as_mut().expect("a field")[0].force[0] += 1.0,
            |r| r.proof.motion = r.proof.associated_motion.clone(),
        ];
        for (index, change) in changes.iter().enumerate() {
            let mut changed = results.clone();
            change(&mut changed.cases[0]);
            assert!(!verify(&again, &changed).is_empty(), "{solver}: change {index} was not found");
        }
    }
}
