//! `event_path` against limit analysis, closed forms and published numbers, with small displacements.

use std::sync::Arc;
use voussoir::core::certificate::PathChecker;
use voussoir::core::limit::Status;
use voussoir::core::model::geometry::Vec2;
use voussoir::core::path::{
    Attachment, Contact, LoadStepEnd, PathAnswer, PathBody, PathObserver, PathProblem, PathSolver, PathState,
};
use voussoir::solvers::path::event::EventPath;
use voussoir::solvers::path::newton::NewtonPath;
use voussoir_tests::by_hand::{self, contact, dry_friction, ground, load_step};
use voussoir_tests::family::{Family, Form, family_scene};
use voussoir_tests::known::REFERENCE_ARCH;
use voussoir_tests::seen::Record;
use voussoir_tests::{Arch, Wall, answered, assert_close, changed, elastic, first_case, friction, small_displacements};

/// Friction whose dilatancy angle is its friction angle, or zero.
const FRICTION_LAWS: [&str; 2] = ["coulomb", "coulomb_associated"];

fn elastic_study(arch: &Arch, mesh: &str) -> String {
    Arch { material: elastic(5e9, 0.3), mesh: mesh.into(), ..arch.clone() }.study()
}

/// The last factor is that of limit analysis to 1e-9 on any mesh of any order, also if slip does not dilate, with the
/// same hinges.
#[test]
fn the_last_factor_is_that_of_limit_analysis_on_any_mesh() {
    let limit = answered(&Arch::default().study());
    for mesh in [
        "elements = [1, 1]\norder = 1",
        "elements = [2, 2]\norder = 2",
        "elements = [2, 3]\norder = 3",
        "elements = [4, 6]\norder = 2\ngrading = 5.0",
    ] {
        for law in FRICTION_LAWS {
            let joint = format!("law = {law:?}\nfriction = 0.6");
            let result = answered(&elastic_study(&Arch { joint, ..Arch::default() }, mesh));
            assert!(result.certificate.passed && result.solver == "event_path", "{:?}", result.notes);
            assert_close(result.load_factor.unwrap(), REFERENCE_ARCH, 1e-9);
            let hinges = |r: &voussoir::results::CaseResult| -> Vec<_> {
                r.stages.last().unwrap().hinges.iter().map(|h| (h.joint, h.side)).collect()
            };
            assert_eq!(hinges(&result), hinges(&limit));
            let (own, other) = (result.mechanism.as_ref().unwrap(), limit.mechanism.as_ref().unwrap());
            assert_eq!(own.kind, other.kind);
            assert_eq!((own.unique, other.unique), (Some(true), Some(true)));
        }
    }
}

/// Friction whose dilatancy differs by 1e-11 from its friction angle is not associated, so that the search for rates is
/// another one. The path has, point by point, the same events at the same factors.
#[test]
fn flow_that_misses_associated_flow_by_rounding_gives_the_same_path() {
    for mu in [0.6f64, 0.35] {
        let dilatancy = (mu * (1.0 - 1e-11)).atan().to_degrees();
        let all = [
            format!("law = \"coulomb_associated\"\nfriction = {mu:?}"),
            format!("law = \"coulomb\"\nfriction = {mu:?}\ndilatancy_angle = {dilatancy:?}"),
        ]
        .map(|joint| {
            let arch = Arch { joint, voussoirs: 17, ends: "jointed", ..Arch::default() };
            let case = first_case(&elastic_study(&arch, "elements = [1, 4]\norder = 2"));
            let problem = PathProblem::new(&case.assembly, &case.stages).unwrap();
            let (answer, _) = trace(&problem);
            let mut events: Vec<_> =
                answer.events.iter().map(|e| (e.contact, format!("{:?}", e.what), e.factor)).collect();
            events.sort_by(|a, b| (a.0, a.2).partial_cmp(&(b.0, b.2)).unwrap());
            (answer, events)
        });
        let [(associated, own), (nearly, other)] = all;
        assert_eq!(
            (associated.status, nearly.status),
            (Status::Collapse, Status::Collapse),
            "{:?} {:?}",
            associated.notes,
            nearly.notes
        );
        assert_close(associated.factor.unwrap(), nearly.factor.unwrap(), 1e-10);
        assert_eq!(own.len(), other.len());
        for (a, b) in own.iter().zip(&other) {
            assert!((a.0, &a.1) == (b.0, &b.1) && (a.2 - b.2).abs() < 1e-7 * b.2.abs().max(1.0), "{a:?} {b:?}");
        }
    }
}

/// Other arches end at the load of limit analysis, with low friction, jointed ends and other rises; a locked arch is
/// unbounded.
#[test]
fn other_arches_end_where_limit_analysis_does() {
    for law in FRICTION_LAWS {
        for (rise, mu, ends, voussoirs) in [
            (2.99, 0.6, "jointed", 13),
            (2.99, 0.3, "bonded", 15),
            (4.49, 0.6, "bonded", 15),
            (1.79, 0.6, "bonded", 15),
            (1.49, 0.6, "bonded", 15),
            (2.09, 0.4, "bonded", 15),
            (1.19, 0.6, "bonded", 15),
            (0.59, 0.6, "bonded", 15),
        ] {
            let joint = friction(mu);
            let arch = Arch { rise, voussoirs, ends, joint, ..Arch::default() };
            let limit = answered(&arch.study());
            let own = Arch { joint: format!("law = {law:?}\nfriction = {mu:?}"), ..arch };
            let path = answered(&elastic_study(&own, "elements = [4, 6]\norder = 2"));
            assert!(path.certificate.passed, "{:?}", path.notes);
            assert_eq!(path.status, limit.status, "rise {rise} friction {mu} {law}");
            if let (Some(a), Some(b)) = (path.load_factor, limit.load_factor) {
                assert_close(a, b, 1e-9);
            }
        }
    }
}

/// 13 congruent voussoirs need one factorisation; if all blocks are rigid, there is no factorisation and no path.
#[test]
fn congruent_voussoirs_are_condensed_once() {
    let arch = Arch { voussoirs: 13, ends: "jointed", ..Arch::default() };
    let result = answered(&elastic_study(&arch, "elements = [4, 6]\norder = 2"));
    assert_eq!(result.counters["condensation_factorisations"], 1);
    let case = first_case(&arch.study());
    let problem = PathProblem::new(&case.assembly, &case.stages).unwrap();
    assert_eq!(problem.counters["condensation_factorisations"], 0);
    assert!(problem.bodies.iter().all(|body| body.flexibility.is_none()));
    assert!(EventPath {}.refuses(&problem, &small_displacements()).unwrap().contains("rigid"));
}

/// An example with two degrees of freedom of Klarbring's kind: K = [[1, −1], [−1, 2]] in (t, n).
fn two_degrees(friction: f64, forces: &[([f64; 2], LoadStepEnd)]) -> PathProblem {
    // C = K⁻¹ = [[2, 1], [1, 1]]; axes x = t, y = n. The plus body is held and deforms.
    let elastic = PathBody {
        points: vec![Vec2::zeros()],
        flexibility: Some(Arc::new(nalgebra::DMatrix::from_row_slice(2, 2, &[2.0, 1.0, 1.0, 1.0]))),
        ..ground(1, Vec2::zeros())
    };
    let point = contact(0, Vec2::zeros(), Vec2::new(0.0, 1.0), [0, 1], dry_friction(friction));
    let point = Contact { tangent: Vec2::new(1.0, 0.0), plus: Attachment { body: 1, slot: Some(0) }, ..point };
    let pushes = forces.iter().enumerate().map(|(stage, (force, end))| {
        load_step(stage, by_hand::forces(vec![(1, Some(0), Vec2::zeros(), Vec2::new(force[0], force[1]))]), *end)
    });
    by_hand::problem(vec![ground(0, Vec2::zeros()), elastic], vec![point], pushes.collect(), 1.0)
}

fn trace(problem: &PathProblem) -> (PathAnswer, Vec<PathState>) {
    let mut record = Record::default();
    let answer = EventPath {}.trace(problem, &small_displacements(), &mut record);
    (answer, record.0)
}

/// Friction can reverse the load: for f = (λ, −1), μ = 1.25 the point sticks up to 1.25, slips back to λ = 1 at u_t =
/// 1, then opens without bound.
#[test]
fn friction_can_turn_the_load_back() {
    let problem =
        two_degrees(1.25, &[([0.0, -1.0], LoadStepEnd::Factor(1.0)), ([1.0, 0.0], LoadStepEnd::Collapse(100.0))]);
    let (answer, states) = trace(&problem);
    assert_eq!(answer.status, Status::LimitPoint, "{:?}", answer.notes);
    assert_close(answer.factor.unwrap(), 1.25, 1e-12);
    let turn = states.iter().find(|s| (s.gap[0][1] - 1.0).abs() < 1e-9).expect("the end of the slip");
    assert_close(turn.factor, 1.0, 1e-12);
    let last = answer.last.unwrap();
    assert_close(last.gap[0][1], 2.0 * last.factor - 1.0, 1e-12);
    assert_close(last.gap[0][0], last.factor - 1.0, 1e-12);
}

/// Separation is found if it is the only solution: f = (1.2, −1) at once with low friction.
#[test]
fn separation_where_it_is_the_only_solution() {
    for mu in [0.5, 0.9, 1.1] {
        let (answer, states) = trace(&two_degrees(mu, &[([1.2, -1.0], LoadStepEnd::Factor(1.0))]));
        assert_eq!(answer.status, Status::Stands, "{mu} {:?}", answer.notes);
        let end = states.last().unwrap();
        // K u = f without contact force: u_t = 2·1.2 − 1, u_n = 1.2 − 1.
        assert_close(end.gap[0][1], 1.4, 1e-12);
        assert_close(end.gap[0][0], 0.2, 1e-12);
    }
}

/// f = (1.2, −1) with more friction has several solutions: slip (u_t = 0.2, r = (−1.0, 0.8) for μ = 1.25; 0.6 for 1.5;
/// 0.8 for 2.0), stick with r = (−1.2, 1), and separation. Each satisfies the equations. If the load grows from zero,
/// in proportion or with the pressure first, both solvers reach stick.
#[test]
fn solutions_that_friction_allows_and_the_one_a_path_reaches() {
    for (mu, slip) in [(1.25f64, 0.2f64), (1.5, 0.6), (2.0, 0.8)] {
        let problem = two_degrees(mu, &[([1.2, -1.0], LoadStepEnd::Factor(1.0))]);
        // u_t and (r_t, r_n): K u = f + r.
        let slides = [slip, slip - 1.2, 1.0 - slip];
        let sticks = [0.0, -1.2, 1.0];
        let residuals = |[u, r_t, r_n]: [f64; 3], u_n: f64| {
            let motion = vec![[0.0; 3]; 2];
            let (force, gap) = (vec![[r_n, r_t]], vec![[u_n, u]]);
            let state = PathState { factor: 1.0, force, gap, motion, ..PathState::default() };
            let mut checker = PathChecker::new(false);
            checker.state(&problem, &state);
            let names = ["path_kinematics", "path_strength", "path_penetration", "path_complementarity"];
            let dissipated = -r_t * u;
            assert!(dissipated >= 0.0);
            names.iter().map(|name| checker.worst.get(name).copied().unwrap_or(0.0)).fold(0.0, f64::max)
        };
        assert!((slides[1].abs() - mu * slides[2]).abs() < 1e-14, "slip at the limit of friction");
        for (solution, opening) in [(slides, 0.0), (sticks, 0.0), ([1.4, 0.0, 0.0], 0.2)] {
            assert!(residuals(solution, opening) < 1e-14, "{mu} {solution:?} {:e}", residuals(solution, opening));
        }
        // Another slip is not a solution.
        assert!(residuals([slip + 0.1, slip - 1.1, 0.9 - slip], 0.0) > 0.01);
        let in_turn = [([0.0, -1.0], LoadStepEnd::Factor(1.0)), ([1.2, 0.0], LoadStepEnd::Factor(1.0))];
        for problem in [problem, two_degrees(mu, &in_turn)] {
            for solver in [&EventPath {} as &dyn PathSolver, &NewtonPath {}] {
                let answer = solver.trace(&problem, &small_displacements(), &mut Record::default());
                assert_eq!(answer.status, Status::Stands, "{mu} {:?}", answer.notes);
                let ([r_n, r_t], [u_n, u_t]) = (answer.state.force[0], answer.state.gap[0]);
                let found = [u_t, r_t, r_n];
                assert!(u_n.abs() < 1e-9 && (0..3).all(|i| (found[i] - sticks[i]).abs() < 1e-9), "{mu} {found:?}");
            }
        }
    }
}

/// Slip is irreversible: a rigid block on a compliant joint, pushed to the limit of sliding, back and forth, follows
/// the closed form of a spring with a Coulomb slider, and its dissipation is the energy loss of the loads.
#[test]
fn a_spring_slider_keeps_its_history() {
    let law = "law = \"coulomb\"\nfriction = 0.5\nnormal_stiffness = 1e9\nshear_stiffness = 1e8";
    let stage = |name: &str, factor: f64| {
        format!(
            "[[stages]]\nname = \"{name}\"\nfactor = {factor:?}\nloads = [{{ kind = \"point\", block = \"b\", point = [0.5, 0.0], force = [1000.0, 0.0] }}]\n"
        )
    };
    // Two blocks hold a third between them: the left joint can slide, the right one is stuck and elastic.
    let text = format!(
        "name = \"slider\"\n[scene]\nscene = \"blocks\"\nwidth = 1.0\nmaterial = \"stone\"\njoint = \"dry\"\nblocks = [\n{{ name = \"ground\", vertices = [[-1.0, -0.5], [2.0, -0.5], [2.0, 0.0], [-1.0, 0.0]], fixed = true }},\n{{ name = \"b\", vertices = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.2], [0.0, 0.2]] }}\n]\n[materials.stone]\nlaw = \"rigid\"\ndensity = 2000.0\n[joints.dry]\n{law}\n[solver]\nsolver = \"event_path\"\n[[stages]]\nname = \"dead\"\ngravity = 10.0\n{}{}{}",
        stage("out", 1.5),
        stage("back", -3.0),
        stage("forth", 1.5),
    );
    let case = first_case(&text);
    let problem = PathProblem::new(&case.assembly, &case.stages).unwrap();
    let mut checker = PathChecker::new(false);
    let answer = EventPath {}.trace(&problem, &small_displacements(), &mut checker);
    // 4 kN of weight, friction 2 kN: ±1.5 kN never slide as a whole; the forces at the points of the joint do not
    // change, because weight and shear are uniform.
    assert_eq!(answer.status, Status::Stands, "{:?}", answer.notes);
    assert!(checker.worst["path_energy"] < 1e-9 && checker.worst["path_strength"] < 1e-9, "{:?}", checker.worst);
    let slip = answer.state.motion[1][0];
    assert!(slip.abs() < 1e-12, "back where it began: {slip:e}");
    // 2.5 kN is more than friction carries: the block slides at 2.
    let sliding = changed(&text, "factor = 1.5\nloads", "until = \"collapse\"\nloads");
    let cut = sliding.find("[[stages]]\nname = \"back\"").unwrap();
    let result = answered(&sliding[..cut]);
    assert_eq!(result.status, Status::Collapse, "{:?}", result.notes);
    assert_close(result.load_factor.unwrap(), 2.0, 1e-9);
}

/// The GAMNI plate (code_aster SSNV128) slips along the bottom within the scatter of published codes.
#[test]
fn the_gamni_plate_slips_as_published() {
    let text = r#"name = "gamni"
[scene]
scene = "blocks"
width = 1.0
plane = "strain"
material = "steel"
joint = "rough"
blocks = [
  { name = "ground", vertices = [[-0.02, -0.02], [0.06, -0.02], [0.06, 0.0], [-0.02, 0.0]], fixed = true },
  { name = "side", vertices = [[0.04, 0.0], [0.06, 0.0], [0.06, 0.04], [0.04, 0.04]], fixed = true },
  { name = "plate", vertices = [[0.0, 0.0], [0.04, 0.0], [0.04, 0.04], [0.0, 0.04]] },
]
pairs = [{ between = ["side", "plate"], joint = "smooth" }]
[scene.mesh]
elements = [32, 10]
order = 1
[materials.steel]
law = "elastic"
young_modulus = 1.3e11
poisson_ratio = 0.2
density = 0.001
[joints.rough]
law = "coulomb"
friction = 1.0
[joints.smooth]
law = "unilateral"
tangential = "free"
[solver]
solver = "event_path"
[[stages]]
name = "pressures"
loads = [
  { kind = "pressure", block = "plate", edge = 3, value = 15e7 },
  { kind = "pressure", block = "plate", edge = 2, value = 5e7 },
]
"#;
    let case = first_case(text);
    let problem = PathProblem::new(&case.assembly, &case.stages).unwrap();
    let mut checker = PathChecker::new(false);
    let answer = EventPath {}.trace(&problem, &small_displacements(), &mut checker);
    assert_eq!(answer.status, Status::Stands, "{:?}", answer.notes);
    let bottom = |x: f64| {
        let at = |c: &Contact| c.position.y.abs() < 1e-12 && (c.position.x - x).abs() < 1e-9;
        let k = problem.contacts.iter().position(at).expect("a contact point there");
        let (contact, gap) = (&problem.contacts[k], answer.state.gap[k]);
        // Displacement of the plate, whichever side it is on.
        let sign = if problem.bodies[contact.plus.body].held { -1.0 } else { 1.0 };
        sign * (contact.tangent.x * gap[1] + contact.normal.x * gap[0])
    };
    let published = [(0.0, 2.86e-5), (0.00125, 2.72e-5), (0.005, 2.28e-5), (0.0075, 1.98e-5), (0.01125, 1.50e-5)];
    for (x, u) in published {
        assert_close(bottom(x), u, 0.05);
    }
    for (name, value) in checker.worst.iter().filter(|(name, _)| **name != "path_energy") {
        assert!(*value < 1e-8, "{name} {value:e}");
    }
}

/// The mechanism of two equal blocks that begin to slide at the same load is not unique (the signs of the flows
/// decide); the mechanism of one block alone is unique.
#[test]
fn a_mechanism_is_not_unique_where_two_are_possible() {
    for count in [1, 2] {
        let each = |make: &dyn Fn(usize) -> String| (0..count).map(make).collect::<Vec<_>>().join(",\n");
        let at = |k: usize| 3.0 * k as f64;
        let blocks = each(&|k| {
            let x = at(k);
            format!(
                "{{ name = \"b{k}\", vertices = [[{x:?}, 0.0], [{0:?}, 0.0], [{0:?}, 0.2], [{x:?}, 0.2]] }}",
                x + 1.0
            )
        });
        let loads = each(&|k| {
            format!("{{ kind = \"point\", block = \"b{k}\", point = [{:?}, 0.0], force = [1000.0, 0.0] }}", at(k) + 0.5)
        });
        let text = format!(
            "name = \"sliders\"\n[scene]\nscene = \"blocks\"\nwidth = 1.0\nmaterial = \"stone\"\njoint = \"dry\"\nblocks = [\n{{ name = \"ground\", vertices = [[-1.0, -0.5], [6.0, -0.5], [6.0, 0.0], [-1.0, 0.0]], fixed = true }},\n{blocks}\n]\n[materials.stone]\nlaw = \"rigid\"\ndensity = 2000.0\n[joints.dry]\nlaw = \"coulomb\"\nfriction = 0.5\nnormal_stiffness = 1e9\nshear_stiffness = 1e8\n[solver]\nsolver = \"event_path\"\n[[stages]]\nname = \"dead\"\ngravity = 10.0\n[[stages]]\nname = \"push\"\nuntil = \"collapse\"\nloads = [{loads}]\n"
        );
        let result = answered(&text);
        assert_eq!(result.status, Status::Collapse, "{:?}", result.notes);
        assert_close(result.load_factor.unwrap(), 2.0, 1e-9);
        assert_eq!(result.mechanism.unwrap().unique, Some(count == 1));
    }
}

/// A block on a joint with tensile strength is pushed until it opens, and released: without sliding and crushing the
/// dissipation is zero, and the work is stored and returned.
#[test]
fn a_tensile_strength_that_opens_gives_its_work_back() {
    let case = first_case(
        r#"name = "bed"
[scene]
scene = "blocks"
width = 1.0
material = "stone"
joint = "bed"
blocks = [
    { name = "ground", vertices = [[0.0, -0.2], [1.0, -0.2], [1.0, 0.0], [0.0, 0.0]], fixed = true },
    { name = "block", vertices = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] },
]
[materials.stone]
law = "rigid"
density = 2000.0
[joints.bed]
law = "mohr_coulomb"
friction = 2.0
cohesion = 1e5
tensile_strength = 1e4
normal_stiffness = 1e9
shear_stiffness = 1e9
[[stages]]
name = "dead"
gravity = 9.81
[[stages]]
name = "push"
loads = [{ kind = "body", acceleration = [7.0, 0.0] }]
[[stages]]
name = "let go"
loads = [{ kind = "body", acceleration = [-7.0, 0.0] }]
[[stages]]
name = "live"
until = "collapse"
loads = [{ kind = "body", acceleration = [-9.81, 0.0] }]
"#,
    );
    let problem = PathProblem::new(&case.assembly, &case.stages).expect("a path problem");
    let mut record = Record::default();
    let answer = EventPath {}.trace(&problem, &small_displacements(), &mut record);
    assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
    let opened = record.0.iter().filter(|s| s.force.iter().any(|f| f[0] < 0.0)).count();
    let at = |load_step: usize| record.0.iter().rfind(|s| s.load_step == load_step).expect("a state");
    let (dead, pushed, back) = (at(0), at(1), at(2));
    assert!(opened > 4 && pushed.stored > 2.0 * dead.stored);
    for state in &record.0 {
        let size = 1e-12 * pushed.work.max(state.work);
        assert!(state.dissipated.abs() <= size, "{} of {}", state.dissipated, state.work);
        assert!((state.work - state.stored).abs() <= size, "{} of {}", state.stored, state.work);
    }
    assert_close(back.stored, dead.stored, 1e-9);
}

/// A body force that lifts a block off the ground has many mechanisms: at the weight of the block it may rise, rotate
/// and shift. A push that makes it rock about one corner has one mechanism.
#[test]
fn a_block_that_is_lifted_has_many_mechanisms_and_one_that_rocks_has_one() {
    let text = |acceleration: [f64; 2]| {
        format!(
            r#"name = "lifted"
[scene]
scene = "blocks"
width = 1.0
material = "stone"
joint = "dry"
blocks = [
  {{ name = "ground", vertices = [[-1.0, -0.5], [3.0, -0.5], [3.0, 0.0], [-1.0, 0.0]], fixed = true }},
  {{ name = "a", vertices = [[0.0, 0.0], [0.4, 0.0], [0.4, 1.0], [0.0, 1.0]] }},
]
[scene.mesh]
elements = [2, 2]
[materials.stone]
law = "elastic"
young_modulus = 1e9
poisson_ratio = 0.2
density = 2000.0
[joints.dry]
law = "coulomb"
friction = 0.7
[solver]
solver = "event_path"
[[stages]]
name = "dead"
gravity = 10.0
[[stages]]
name = "live"
until = "collapse"
loads = [{{ kind = "body", acceleration = {acceleration:?} }}]
"#
        )
    };
    for (acceleration, factor, unique) in [([0.0, 10.0], 1.0, false), ([10.0, 0.0], 0.4, true)] {
        let case = first_case(&text(acceleration));
        let problem = PathProblem::new(&case.assembly, &case.stages).expect("a path problem");
        let answer = EventPath {}.trace(&problem, &small_displacements(), &mut PathChecker::default());
        assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
        assert_close(answer.factor.expect("a factor"), factor, 1e-12);
        assert_eq!(answer.unique, Some(unique), "{acceleration:?}");
    }
}

/// The exact path refuses a dense problem of friction at once: a wall of 62 dry bricks on compliant joints under its
/// weight (1950 contact points, all initially at the apex of their friction).
#[test]
fn an_exact_path_gives_up_a_dense_problem_of_friction_at_once() {
    let result = answered(&Wall::around_a_window("friction = 0.577", "event_path").under_its_weight());
    assert_eq!(result.status, Status::Stalled);
    assert!(
        result.notes.iter().any(|note| note.contains("1950 contact points may change their modes")),
        "{:?}",
        result.notes
    );
    assert!(result.counters["factorisations"] < 200, "{:?}", result.counters);
}

/// A state of small displacements is stable if its elastic blocks cannot move without force, also in a settled arch
/// that three hinges have made statically determinate. The exact path decides it from its own equations, Newton's
/// method from the eigenvalues of its flexibility, and both agree. If points that slide without dilatancy are free,
/// neither decides.
#[test]
fn stages_of_exact_paths_say_whether_they_are_stable_as_newtons_do() {
    let settled = |law: &str| {
        let stages = "[[stages]]\nname = \"dead\"\ngravity = 9.81\n[[stages]]\nname = \"settle\"\nsettlement = [{ support = \"left\", displacement = [-0.02, 0.0] }]\n";
        let joint = format!("law = {law:?}\nfriction = 0.6");
        let arch = Arch { joint, voussoirs: 10, ..Arch::default() };
        let study = elastic_study(&arch, "elements = [1, 2]");
        let (scene, _) = study.split_once("[solver]").expect("stages and solver after the scene");
        format!("{scene}\n{stages}")
    };
    let sliding = include_str!("peaks/137.toml").to_string();
    for (study, decided) in [(settled("coulomb_associated"), true), (settled("coulomb"), true), (sliding, false)] {
        let [exact, stepped] = ["event_path", "newton_path"]
            .map(|solver| answered(&format!("{study}\n[solver]\nsolver = {solver:?}\n")))
            .map(|result| result.stages.into_iter().map(|stage| stage.stability).collect::<Vec<_>>());
        assert_eq!(exact, stepped);
        assert_eq!(exact[0].stable_under_load, decided.then_some(true), "{exact:?}");
        assert!(exact[0].stability.is_some() && (!decided || exact[1].stable_under_control == Some(true)), "{exact:?}");
    }
}

/// Mechanisms and rays of joints that cannot slide are proved, also if open points hardly move in them: their rates are
/// rounding, which closes no gap.
#[test]
fn open_points_that_hardly_move_do_not_close() {
    for (seed, status) in [(12013, Status::Collapse), (12031, Status::Unbounded), (12073, Status::Collapse)] {
        let result = answered(&family_scene(Family::Random, seed).study(Form::Given, ""));
        assert_eq!((result.status, result.path.end_is_checked), (status, Some(true)), "{seed}: {:?}", result.notes);
    }
}
