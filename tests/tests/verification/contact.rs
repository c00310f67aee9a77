//! Contact of elastic bodies against closed forms: Hertz, Cattaneo and Mindlin, a three-hinge frame, a slider with its
//! history, and the solutions of a frictional system of two degrees of freedom.

use std::f64::consts::PI;
use std::sync::Arc;
use voussoir::core::certificate::PathChecker;
use voussoir::core::limit::Status;
use voussoir::core::model::Bond;
use voussoir::core::model::geometry::Vec2;
use voussoir::core::path::{
    Contact, LoadStep, LoadStepEnd, Loading, PathAnswer, PathBody, PathProblem, PathSettings, PathSolver, PathState,
    PointLaw, Unobserved,
};
use voussoir::solvers::path::continuation::load_control::LoadControl;
use voussoir::solvers::path::event::EventPath;
use voussoir::solvers::path::newton::NewtonPath;
use voussoir_tests::by_hand::{self, body, dry_friction, forces, ground, load_step};
use voussoir_tests::seen::Record;
use voussoir_tests::{assert_close, changed, first_case, small_displacements};

/// Returns the answers of both path solvers; every state of the first is certified.
fn both(problem: &PathProblem) -> [PathAnswer; 2] {
    let mut checker = PathChecker::new(false);
    let event = EventPath {}.trace(problem, &small_displacements(), &mut checker);
    for (name, value) in &checker.worst {
        assert!(*value < 1e-8, "{name} {value:e} {:?}", event.notes);
    }
    let control = LoadControl { first_step: 0.1, largest_step: None };
    let steps = PathSettings { continuation: Some(Arc::new(control)), ..small_displacements() };
    [event, NewtonPath {}.trace(problem, &steps, &mut Unobserved)]
}

/// Returns the greatest difference of two states' forces, relative to the greatest force.
fn difference(a: &PathState, b: &PathState) -> f64 {
    let pairs = || a.force.iter().flatten().zip(b.force.iter().flatten());
    let size = pairs().fold(0.0, |s: f64, (x, _)| s.max(x.abs()));
    pairs().fold(0.0, |s: f64, (x, y)| s.max((x - y).abs())) / size
}

// The roller of NAFEMS (FENET; code_aster SSNP154), plane strain.
const RADIUS: f64 = 0.05;
const LINE_LOAD: f64 = 35e6;
const STEEL: f64 = 210e9;
const SOFT: f64 = 70e9;
const POISSON: f64 = 0.3;

/// Returns E* of two bodies \[Pa\].
fn contact_modulus(one: f64, other: f64) -> f64 {
    1.0 / ((1.0 - POISSON * POISSON) * (1.0 / one + 1.0 / other))
}

/// Returns Hertz's (p_0, a) for a line load P: a = √(4 P R / (π E*)), p_0 = 2 P / (π a).
fn hertz(load: f64, modulus: f64) -> [f64; 2] {
    let a = (4.0 * load * RADIUS / (PI * modulus)).sqrt();
    [2.0 * load / (PI * a), a]
}

fn block(name: &str, [x0, y0, x1, y1]: [f64; 4], rest: &str) -> String {
    format!(
        "{{ name = \"{name}\", vertices = [[{x0:?}, {y0:?}], [{x1:?}, {y0:?}], [{x1:?}, {y1:?}], [{x0:?}, {y1:?}]]{rest} }}"
    )
}

fn study(blocks: &[String], elements: usize, grading: f64, law: &str, moduli: [f64; 2], stages: &str) -> String {
    let material = |name: &str, e: f64| {
        format!(
            "[materials.{name}]\nlaw = \"elastic\"\nyoung_modulus = {e:?}\npoisson_ratio = {POISSON}\ndensity = 0.001\n"
        )
    };
    format!(
        "name = \"contact\"\n[scene]\nscene = \"blocks\"\nwidth = 1.0\nplane = \"strain\"\nmaterial = \"upper\"\njoint = \"face\"\nblocks = [\n{}\n]\n[scene.mesh]\nelements = [{elements}, {elements}]\norder = 2\ngrading = {grading:?}\n{}{}[joints.face]\n{law}\n{stages}",
        blocks.join(",\n"),
        material("upper", moduli[0]),
        material("lower", moduli[1])
    )
}

/// Returns the contact points between upper and lower bodies: points on y = 0 with a vertical normal.
fn face(problem: &PathProblem) -> Vec<usize> {
    let on = |c: &Contact| c.position.y.abs() < 1e-12 && c.normal.y.abs() > 0.5;
    (0..problem.contacts.len()).filter(|k| on(&problem.contacts[*k])).collect()
}

/// The right half of the roller as a block whose curvature is the initial gap x²/(2R), on another block, both `size` ×
/// `size`, under uniform pressure. A uniform lateral pressure keeps the plane of symmetry (a smooth wall) closed and
/// causes no bending.
fn roller(elements: usize, size: f64) -> PathProblem {
    let s = size;
    let blocks = [
        block("wall", [-0.02, -s, 0.0, s], ", fixed = true"),
        block("ground", [0.0, -s - 0.02, s, -s], ", fixed = true"),
        block("lower", [0.0, -s, s, 0.0], ", material = \"lower\""),
        block("upper", [0.0, 0.0, s, s], ""),
    ];
    let pressure = LINE_LOAD / 2.0 / s;
    let load = |on: &str, edge: usize| {
        // The block bends over its support: at the top of the wall there is tension of up to 3 × the pressure.
        let value = if edge == 1 { 4.0 * pressure } else { pressure };
        format!("{{ kind = \"pressure\", block = \"{on}\", edge = {edge}, value = {value:?} }}")
    };
    let stages = format!(
        "[[stages]]\nname = \"press\"\nloads = [{}, {}, {}]\n",
        load("upper", 2),
        load("upper", 1),
        load("lower", 1)
    );
    let law = "law = \"unilateral\"\ntangential = \"free\"";
    let case = first_case(&study(&blocks, elements, 20.0, law, [STEEL, SOFT], &stages));
    let mut problem = PathProblem::new(&case.assembly, &case.stages).expect("a path problem");
    for k in face(&problem) {
        let contact = &mut problem.contacts[k];
        contact.gap = contact.position.x.powi(2) / (2.0 * RADIUS);
    }
    problem
}

/// Returns line load, greatest pressure and half-width of the normal forces (from the second moment of the pressure: ∫
/// p x² = P a²/4).
fn measured(problem: &PathProblem, state: &PathState) -> [f64; 3] {
    let (mut load, mut second, mut pressure) = (0.0, 0.0, 0.0f64);
    for k in face(problem) {
        let (contact, force) = (&problem.contacts[k], state.force[k][0]);
        load += force;
        second += force * contact.position.x.powi(2);
        if contact.position.x.abs() < 1e-12 {
            pressure = pressure.max(force / contact.area);
        }
    }
    [load, pressure, 2.0 * (second / load).sqrt()]
}

/// A roller on a block: p_0 and a tend to Hertz's theory, 3585.37 MPa and 6.21 mm, and both solvers agree.
#[test]
fn roller_on_block_tends_to_hertz() {
    let [p0, a] = hertz(LINE_LOAD, contact_modulus(STEEL, SOFT));
    assert_close(p0, 3585.37e6, 1e-5);
    assert_close(a, 6.21e-3, 1e-3);
    let mut errors = Vec::new();
    for elements in [8, 16, 32] {
        let problem = roller(elements, 20.0 * a);
        let [event, newton] = both(&problem);
        assert_eq!(event.status, Status::Stands, "{:?}", event.notes);
        assert_eq!(newton.status, Status::Stands, "{:?}", newton.notes);
        let arc = NewtonPath {}.trace(&problem, &small_displacements(), &mut Unobserved);
        assert_eq!(arc.status, Status::Stands, "{:?}", arc.notes);
        let apart = difference(&event.state, &newton.state).max(difference(&event.state, &arc.state));
        let [load, pressure, width] = measured(&problem, &event.state);
        errors.push([pressure / p0 - 1.0, width / a - 1.0]);
        assert_close(2.0 * load, LINE_LOAD, 1e-9);
        assert!(apart < 1e-8, "{apart:e}");
        // The plane of symmetry stays closed.
        let wall = problem.contacts.iter().zip(&event.state.gap).filter(|(c, _)| c.normal.x.abs() > 0.5);
        let open =
            wall.map(|(c, g)| [c.position.y, g[0]]).fold([0.0; 2], |m: [f64; 2], g| if g[1] > m[1] { g } else { m });
        assert!(open[1] < 1e-8 * a, "the plane of symmetry opens: {open:?}");
    }
    // The finite size contributes (a / size)² = 0.25 %; the rest is the error of the mesh.
    let [coarse, _, fine] = [0, 1, 2].map(|k: usize| errors[k].map(f64::abs));
    assert!(fine[0] < 0.005 && fine[1] < 0.005, "{errors:?}");
    assert!(4.0 * fine[0] < coarse[0] && 4.0 * fine[1] < coarse[1], "{errors:?}");
    assert!(errors.iter().all(|e| e[0].abs() < 0.01 && e[1].abs() < 0.06), "{errors:?}");
}

/// Two equal bodies that are pressed together and then sheared. Each consists of two bonded halves so that the mesh is
/// finest in the middle. The upper body hangs on a plate that moves down and then sideways.
fn sheared(elements: usize, size: f64, down: f64, sideways: f64, law: &str) -> PathProblem {
    let s = size;
    let blocks = [
        block("ground", [-s, -s - 0.02, s, -s], ", fixed = true"),
        block("plate", [-s, s, s, s + 0.02], ", fixed = true"),
        block("lower_left", [-s, -s, 0.0, 0.0], ""),
        block("lower_right", [0.0, -s, s, 0.0], ""),
        block("upper_left", [-s, 0.0, 0.0, s], ""),
        block("upper_right", [0.0, 0.0, s, s], ""),
    ];
    let stage = |name: &str, x: f64, y: f64| {
        format!(
            "[[stages]]\nname = \"{name}\"\nsettlement = [{{ support = \"plate\", displacement = [{x:?}, {y:?}], rotation = 0.0 }}]\n"
        )
    };
    let mut stages = stage("press", 0.0, -down);
    if sideways != 0.0 {
        stages += &stage("shear", sideways, 0.0);
    }
    let mut case = first_case(&study(&blocks, elements, 12.0, law, [STEEL, STEEL], &stages));
    for joint in &mut case.assembly.joints {
        if joint.ends.iter().any(|p| p.y.abs() > 1e-9) {
            joint.bond = Bond::Bonded;
        }
    }
    let mut problem = PathProblem::new(&case.assembly, &case.stages).expect("a path problem");
    for k in face(&problem) {
        let contact = &mut problem.contacts[k];
        contact.gap = contact.position.x.powi(2) / (2.0 * RADIUS);
    }
    problem
}

/// The stick zone is that of Cattaneo and Mindlin's theory: under P and then Q < μ P of equal bodies the middle |x| < c
/// sticks, c/a = √(1 − Q/(μ P)). The last sticking and the first sliding node enclose it within 2 % of a, and the
/// pressure is that of Hertz within 1 % (a is 8 % of the size of the bodies; its square, 0.7 %, is the order of the
/// error from finite bodies).
#[test]
fn the_stick_zone_is_that_of_cattaneo_and_mindlin() {
    let (friction, size) = (0.3, 0.06);
    for (elements, node, shears) in [(16, 0.25, &[1.2e-4, 2.4e-4][..]), (24, 0.15, &[2.4e-4])] {
        for &sideways in shears {
            let problem =
                sheared(elements, size, 8e-4, sideways, &format!("law = \"coulomb\"\nfriction = {friction:?}"));
            let [event, newton] = both(&problem);
            assert_eq!(
                (event.status, newton.status),
                (Status::Stands, Status::Stands),
                "{:?} {:?}",
                event.notes,
                newton.notes
            );
            let apart = difference(&event.state, &newton.state);
            assert!(apart < 1e-8, "{apart:e}");
            let [load, pressure, _] = measured(&problem, &event.state);
            let [p0, a] = hertz(load, contact_modulus(STEEL, STEEL));
            let all = face(&problem);
            let shear = |k: &usize| event.state.force[*k][1] * problem.contacts[*k].tangent.x;
            let ratio = all.iter().map(shear).sum::<f64>().abs() / (friction * load);
            let pressed = |k: &&usize| event.state.force[**k][0] > 0.0;
            let slides = |k: &usize| event.state.force[*k][1].abs() >= (friction - 1e-9) * event.state.force[*k][0];
            let (out, inside): (Vec<usize>, Vec<usize>) = all.iter().filter(pressed).partition(|k| slides(k));
            let at = |k: &usize| problem.contacts[*k].position.x.abs() / a;
            let low = inside.iter().map(at).fold(0.0, f64::max);
            let high = out.iter().map(at).fold(f64::INFINITY, f64::min);
            let expected = (1.0 - ratio).sqrt();
            assert!(ratio > 0.2 && ratio < 0.8, "{ratio}");
            assert!(low - 0.02 <= expected && expected <= high + 0.02 && high - low < node, "{low} {expected} {high}");
            assert_close(pressure, p0, 0.01);
            // Slip has one direction: the outer nodes all slide against the shear.
            let sense = all.iter().map(shear).sum::<f64>().signum();
            assert!(out.iter().all(|k| shear(k) * sense > 0.0));
        }
    }
}

/// A rigid body on frictional feet at these x (together μ N and tangential stiffness k) beside a spring k_s, all at the
/// height of its pole, under its weight N at x = 0 and then horizontal forces Q in both directions.
fn slider(friction: f64, weight: f64, [k, spring]: [f64; 2], feet: &[f64], history: &[f64]) -> PathProblem {
    let point = |x: f64, law, compliance| Contact {
        compliance,
        ..by_hand::contact(0, Vec2::new(x, 0.0), Vec2::new(0.0, 1.0), [0, 1], law)
    };
    let foot = |x| point(x, dry_friction(friction), [1e-3 / k, feet.len() as f64 / k]);
    // The spring acts sideways only: its other stiffness is negligible compared with the feet.
    let pulling = point(0.0, PointLaw::Bonded, [1e9 / k, 1.0 / spring]);
    let dead = Loading { acceleration: Vec2::new(0.0, -10.0), ..Loading::default() };
    let push = forces(vec![(1, None, Vec2::zeros(), Vec2::new(1.0, 0.0))]);
    let gravity = LoadStep { gravity: true, ..load_step(0, dead, LoadStepEnd::Factor(1.0)) };
    let pushes = history.iter().enumerate();
    let pushes = pushes.map(|(stage, q)| load_step(stage + 1, push.clone(), LoadStepEnd::Factor(*q)));
    by_hand::problem(
        vec![ground(0, Vec2::zeros()), PathBody { mass: weight / 10.0, ..body(1, Vec2::zeros()) }],
        feet.iter().map(|x| foot(*x)).chain([pulling]).collect(),
        std::iter::once(gravity).chain(pushes).collect(),
        2.0,
    )
}

/// A Jenkin element beside a spring follows its closed form: with F = μ N the force is Q = k_s u + clamp(k (u − s),
/// ±F), where s is the slip. During loading, reversal and reloading tangent stiffness, displacement, slip force and
/// dissipation agree with it at every state of both solvers.
#[test]
fn a_slider_beside_a_spring_keeps_its_hysteresis() {
    let (friction, weight, stiffness, spring) = (0.5, 40.0, 1000.0, 250.0);
    let limit = friction * weight;
    let history = [45.0, -80.0, 70.0, -20.0];
    let problem = slider(friction, weight, [stiffness, spring], &[-1.0, 1.0], &history);
    let control = PathSettings {
        continuation: Some(Arc::new(LoadControl { first_step: 0.01, largest_step: None })),
        ..small_displacements()
    };
    for (solver, settings, exact) in
        [(&EventPath {} as &dyn PathSolver, small_displacements(), true), (&NewtonPath {}, control, false)]
    {
        let mut record = Record::default();
        let answer = solver.trace(&problem, &settings, &mut record);
        assert_eq!(answer.status, Status::Stands, "{:?}", answer.notes);
        let (mut slip, mut dissipated, mut seen) = (0.0, 0.0, 0);
        for state in record.0.iter().filter(|state| state.load_step > 0) {
            let force: f64 = history[..state.load_step - 1].iter().sum::<f64>() + state.factor;
            // The point slides if the force required for sticking is above F.
            let stuck = (force + stiffness * slip) / (stiffness + spring);
            let sense = (stiffness * (stuck - slip)).signum();
            let u = if (stiffness * (stuck - slip)).abs() <= limit { stuck } else { (force - sense * limit) / spring };
            let pull = (stiffness * (u - slip)).clamp(-limit, limit);
            let moved = u - pull / stiffness - slip;
            dissipated += pull * moved;
            slip += moved;
            assert!((state.motion[1][0] - u).abs() < 1e-9 * limit / spring, "{} at {force}: {u}", state.motion[1][0]);
            let carried = -(state.force[0][1] + state.force[1][1]) * problem.contacts[0].tangent.x;
            assert!((carried - pull).abs() < 1e-9 * limit, "{carried} {pull}");
            if exact {
                assert!((state.dissipated - dissipated).abs() < 1e-9 * limit * limit / spring);
            }
            seen += 1;
        }
        assert!(seen >= history.len());
        assert!(dissipated > limit * limit / spring, "it slid");
    }
}

/// The energy of exact pieces balances within rounding, for any number of stages of the load. Feet with increasing
/// normal forces begin to slide one after the other, so that Q(u) is almost a smooth curve (Iwan's model).
#[test]
fn no_energy_is_lost_between_events() {
    let feet: Vec<f64> = (0..400).map(|k| -1.3 + 2.0 * f64::from(k) / 399.0).collect();
    for parts in [2, 4, 8] {
        let problem = slider(0.5, 40.0, [1000.0, 250.0], &feet, &vec![22.0 / f64::from(parts); parts as usize]);
        let mut checker = PathChecker::new(false);
        let answer = NewtonPath {}.trace(&problem, &small_displacements(), &mut checker);
        assert_eq!(answer.status, Status::Stands, "{:?}", answer.notes);
        let state = &answer.state;
        assert!(state.dissipated > 0.1 * state.work, "feet slide");
        let left = (state.work - state.stored - state.dissipated).abs() / state.work;
        assert!(left < 1e-9, "{left:e}");
    }
}

/// A three-hinge arch has the thrust of statics: two leaning elastic blocks with contact at one point each with the
/// ground and with each other. With the weight W of a half at x_G, the thrust is H = W (x_G − x_A)/(y_C − y_A).
#[test]
fn a_three_hinge_arch_has_the_thrust_of_statics() {
    // The left half, springing face at y = 0, crown face at x = 0; the right half is its mirror image.
    let left = [[-2.0, 0.0], [-1.4, 0.0], [0.0, 1.1], [0.0, 1.7]];
    let vertices =
        |sign: f64| left.iter().map(|[x, y]| format!("[{:?}, {y:?}]", sign * x)).collect::<Vec<_>>().join(", ");
    let blocks = [
        block("ground", [-3.0, -0.5, 3.0, 0.0], ", fixed = true"),
        format!("{{ name = \"west\", vertices = [{}] }}", vertices(1.0)),
        format!("{{ name = \"east\", vertices = [{}] }}", vertices(-1.0)),
    ];
    let law = "law = \"coulomb\"\nfriction = 2.0";
    let stages = "[[stages]]\nname = \"dead\"\ngravity = 10.0\n";
    let text = changed(&study(&blocks, 3, 1.0, law, [5e9, 5e9], stages), "density = 0.001", "density = 2000.0");
    // Positions of the hinges: x of the contact point at the springing, y at the crown.
    for (springing, crown) in [(-2.0, 1.7), (-1.4, 1.7), (-2.0, 1.1), (-1.4, 1.1)] {
        let case = first_case(&text);
        let mut problem = PathProblem::new(&case.assembly, &case.stages).expect("a path problem");
        let hinge = |c: &Contact| {
            (c.position.x.abs() - f64::abs(springing)).abs() < 1e-9 && c.position.y.abs() < 1e-9
                || c.position.x.abs() < 1e-9 && (c.position.y - crown).abs() < 1e-9
        };
        for contact in problem.contacts.iter_mut().filter(|c| !hinge(c)) {
            contact.gap = 1.0;
        }
        assert_eq!(problem.contacts.iter().filter(|c| hinge(c)).count(), 3);
        let half = problem.bodies.iter().find(|b| !b.held && b.pole.x < 0.0).expect("a left half");
        let weight = 10.0 * half.mass;
        let thrust = weight * (half.pole.x - springing) / crown;
        let mut checker = PathChecker::new(false);
        let answer = EventPath {}.trace(&problem, &small_displacements(), &mut checker);
        assert_eq!(answer.status, Status::Stands, "{:?}", answer.notes);
        assert!(checker.worst.values().all(|value| *value < 1e-8), "{:?}", checker.worst);
        let stepped = NewtonPath {}.trace(&problem, &small_displacements(), &mut Unobserved);
        assert_eq!(stepped.status, Status::Stands, "{:?}", stepped.notes);
        assert!(difference(&answer.state, &stepped.state) < 1e-9);
        let at_crown =
            problem.contacts.iter().zip(&answer.state.force).find(|(c, _)| c.position.x.abs() < 1e-9 && hinge(c));
        let (_, force) = at_crown.expect("a crown");
        assert_close(force[0], thrust, 1e-9);
        assert!(force[1].abs() < 1e-9 * weight);
    }
}
