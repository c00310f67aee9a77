//! The certificate of a path starts from the assembly: a solver that gets a wrong problem solves this problem and is
//! refused.

use voussoir::core::certificate::{PathChecker, path_structure, tolerance};
use voussoir::core::law::Facet;
use voussoir::core::path::{PathProblem, PathSolver, PointLaw};
use voussoir::solvers::path::event::EventPath;
use voussoir::solvers::path::newton::NewtonPath;
use voussoir::study::Case;
use voussoir_tests::{first_case, small_displacements};

/// An elastic block that is glued to the ground by cohesion, pushed sideways until it slides.
fn pushed() -> Case {
    first_case(
        r#"name = "pushed"
[scene]
scene = "blocks"
width = 0.5
material = "stone"
joint = "mortar"
blocks = [
  { name = "ground", vertices = [[-1.0, -0.5], [2.0, -0.5], [2.0, 0.0], [-1.0, 0.0]], fixed = true },
  { name = "block", vertices = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.4], [0.0, 0.4]] },
]
[scene.mesh]
elements = [6, 3]
order = 2
[materials.stone]
law = "elastic"
young_modulus = 1e9
poisson_ratio = 0.2
density = 2000.0
[joints.mortar]
law = "mohr_coulomb"
friction = 0.5
cohesion = 1e4
tensile_strength = 5e3
dilatancy_angle = 0.0
[solver]
solver = "newton_path"
[[stages]]
name = "dead"
gravity = 10.0
[[stages]]
name = "live"
until = "collapse"
loads = [{ kind = "point", block = "block", point = [0.0, 0.1], force = [1000.0, 0.0] }]
"#,
    )
}

/// Returns the residuals above their gates if a solver gets the problem changed by `forge`.
fn refused(solver: &dyn PathSolver, forge: impl Fn(&mut PathProblem)) -> Vec<&'static str> {
    let case = pushed();
    let mut problem = PathProblem::new(&case.assembly, &case.stages).expect("a path problem");
    forge(&mut problem);
    let mut checker = PathChecker::certifying(&case.assembly, &case.stages, false).expect("a structure");
    let answer = solver.trace(&problem, &small_displacements(), &mut checker);
    assert!(checker.states > 2, "{:?}", answer.notes);
    let above = checker.worst.iter().filter(|(name, value)| value.is_nan() || **value > tolerance(name).result);
    above.map(|(name, _)| *name).collect()
}

fn solvers() -> [Box<dyn PathSolver>; 2] {
    [Box::new(EventPath {}), Box::new(NewtonPath {})]
}

/// The unchanged problem passes.
#[test]
fn what_the_assembly_says_is_confirmed() {
    for solver in solvers() {
        assert_eq!(refused(&*solver, |_| {}), Vec::<&str>::new());
    }
}

/// A contact point with twice its area carries twice its cohesion and is refused.
#[test]
fn a_forged_contact_area_is_refused() {
    for solver in solvers() {
        let found = refused(&*solver, |problem| problem.contacts[0].area *= 2.0);
        assert!(found.contains(&"path_strength"), "{found:?}");
    }
}

/// A load that is a hundredth too small is refused.
#[test]
fn a_forged_load_is_refused() {
    for solver in solvers() {
        let found = refused(&*solver, |problem| problem.load_steps[1].loading.forces[0].3 *= 0.99);
        assert!(found.contains(&"path_equilibrium"), "{found:?}");
    }
}

/// A weight, which is a resultant, a hundredth too great is refused.
#[test]
fn a_forged_resultant_is_refused() {
    for solver in solvers() {
        let found = refused(&*solver, |problem| problem.bodies[1].mass *= 1.01);
        assert!(found.contains(&"path_equilibrium"), "{found:?}");
    }
}

/// Forged initial gaps, flexibilities and laws are refused, because they come from the assembly too.
#[test]
fn forged_gaps_flexibilities_and_laws_are_refused() {
    for solver in solvers() {
        let gap = refused(&*solver, |problem| problem.contacts[3].gap = 1e-7);
        assert!(gap.contains(&"path_kinematics"), "{gap:?}");
        let soft = refused(&*solver, |problem| {
            let flexibility = problem.bodies[1].flexibility.take().expect("an elastic block");
            problem.bodies[1].flexibility = Some((*flexibility).clone().scale(1.01).into());
        });
        assert!(soft.contains(&"path_kinematics"), "{soft:?}");
        let rough = refused(&*solver, |problem| {
            let [left, right] = Facet::friction(0.55, 1e4, 0.0);
            let law = PointLaw::Facets(vec![Facet::opening(5e3), left, right].into());
            problem.contacts.iter_mut().for_each(|contact| contact.law = law.clone());
        });
        assert!(rough.contains(&"path_strength"), "{rough:?}");
    }
}

/// The structure of the certificate and the problem for solvers agree for one assembly.
#[test]
fn both_readings_of_an_assembly_agree() {
    let case = pushed();
    let problem = PathProblem::new(&case.assembly, &case.stages).expect("a path problem");
    let structure = path_structure(&case.assembly, &case.stages).expect("a structure");
    assert_eq!((problem.bodies.len(), problem.body_of.clone()), (structure.bodies.len(), structure.body_of.clone()));
    assert_eq!(problem.contacts.len(), structure.contacts.len());
    let close = |a: f64, b: f64| (a - b).abs() <= 1e-13 * a.abs().max(b.abs());
    for (a, b) in problem.contacts.iter().zip(&structure.contacts) {
        assert_eq!((a.joint, a.minus, a.plus, a.sliding), (b.joint, b.minus, b.plus, b.sliding));
        assert!(close(a.area, b.area) && (a.position - b.position).norm() < 1e-15 && a.gap == b.gap);
        assert!(close(a.compliance[0], b.compliance[0]) && close(a.compliance[1], b.compliance[1]));
    }
    let height: f64 = structure.contacts.iter().map(|c| c.area).sum::<f64>() / case.assembly.width;
    assert!(close(height, case.assembly.joints[0].height()));
}
