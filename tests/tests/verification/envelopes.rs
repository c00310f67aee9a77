//! Joints with several sliding facets in one sense: the exact strength of whole joints against cells, paths and known loads.

use voussoir::core::certificate::{Claim, ContactForce, certify};
use voussoir::core::limit::{JointForce, LimitJoint, LimitProblem, LimitQuestion, LimitSolver, Status};
use voussoir::core::model::stage_loads;
use voussoir::solvers::limit::conic::LimitConic;
use voussoir_tests::{answered, assert_close, changed, first_case};

/// An arch whose joints are rough: teeth are climbed up to 80 kPa and sheared off above. A separate linear program with each
/// joint cut into 160 cells brackets its load: cells with a uniform traction carry 588.947, cells with a free point of action
/// 589.227.
const TEETH: &str = r#"name = "teeth"
[scene]
scene = "arch"
profile = { shape = "segmental", span = 9.42, rise = 2.99 }
thickness = 0.60
width = 5.81
voussoirs = 15
ends = "bonded"
material = "stone"
joint = "rough"
[materials.stone]
law = "rigid"
density = 2200.0
[joints.rough]
law = "strength_envelope"
corners = [[0.0, 0.0], [8e4, 4e4]]
residual_friction = 0.25
dilatancy_angle = 80.0
[[stages]]
name = "dead"
gravity = 9.81
[[stages]]
name = "live"
until = "collapse"
loads = [{ kind = "point", span_fraction = 0.25, force = ["0 N", "-1 kN"] }]
"#;

const CORNERS: &str = "corners = [[0.0, 0.0], [8e4, 4e4]]\nresidual_friction = 0.25";

/// Other envelopes: several corners, tension, a sloped cap, a cap that ends with shear strength.
const OTHERS: [&str; 3] = [
    "corners = [[-2e3, 0.0], [1e4, 9e3], [5e4, 3e4], [2e5, 7e4]]\nresidual_friction = 0.2",
    "corners = [[0.0, 0.0], [8e4, 5e4], [6e5, 2e5], [3e6, 0.0]]",
    "corners = [[0.0, 5e3], [3e4, 2.5e4], [2e6, 5e5]]",
];

fn load(text: &str) -> f64 {
    let result = answered(text);
    assert_eq!((result.status, result.certificate.passed), (Status::Collapse, true), "{:?}", result.notes);
    result.load_factor.expect("a load factor")
}

#[test]
fn the_load_of_rough_joints_lies_in_the_bracket_of_cells() {
    let found = load(TEETH);
    assert!((588.947..589.227).contains(&found), "{found}");
}

/// A corner at a pressure that only the very end of a joint reaches leaves Coulomb friction.
#[test]
fn a_corner_out_of_reach_changes_nothing() {
    let straight = changed(TEETH, CORNERS, "corners = [[0.0, 0.0], [1e11, 4e10]]\nresidual_friction = 0.2");
    let plain = format!("law = \"strength_envelope\"\n{CORNERS}\ndilatancy_angle = 80.0");
    let coulomb = changed(TEETH, &plain, "law = \"coulomb_associated\"\nfriction = 0.4");
    assert_close(load(&straight), load(&coulomb), 2e-6);
}

/// The load on the other half of the arch, and in other units, is the same.
#[test]
fn loads_do_not_depend_on_the_side_and_the_units() {
    for corners in std::iter::once(CORNERS).chain(OTHERS) {
        let text = changed(TEETH, CORNERS, corners);
        let one = load(&text);
        assert_close(load(&changed(&text, "span_fraction = 0.25", "span_fraction = 0.75")), one, 1e-8);
        assert_close(1e3 * load(&changed(&text, "\"-1 kN\"", "\"-1 MN\"")), one, 1e-8);
    }
}

/// With associated flow the path on compliant joints converges to the limit load with the number of points in a joint.
#[test]
fn paths_converge_to_the_limit_load() {
    for (corners, meshes) in [(CORNERS, [(3, 1e-3), (6, 1e-5)]), (OTHERS[0], [(6, 5e-4), (24, 2e-5)])] {
        let text = changed(TEETH, CORNERS, corners);
        let limit = load(&text);
        for (elements, tolerance) in meshes {
            let stiff = format!("{corners}\nnormal_stiffness = 2e10\nshear_stiffness = 1e10");
            let path = changed(&text, corners, &stiff) + "[solver]\nsolver = \"event_path\"\n";
            let mesh = format!("joint = \"rough\"\nmesh = {{ elements = [1, {elements}] }}");
            assert_close(load(&changed(&path, "joint = \"rough\"", &mesh)), limit, tolerance);
        }
    }
}

/// Returns the problem with each joint cut into cells. A cell bounds its shear by its facets over its own area: the load
/// is an upper bound, and with more cells it comes down to the exact load.
fn in_cells(problem: &LimitProblem, count: usize) -> LimitProblem {
    let share = |index: usize| index as f64 / count as f64;
    let cell = |joint: &LimitJoint, index: usize| {
        let mut cell = joint.clone();
        cell.ends = [index, index + 1].map(|end| joint.ends[0] + (joint.ends[1] - joint.ends[0]) * share(end));
        cell.strength.envelopes.clear();
        cell.strength.rows.iter_mut().for_each(|row| row.bound /= count as f64);
        cell
    };
    let joints = problem.joints.iter().flat_map(|joint| (0..count).map(move |index| cell(joint, index))).collect();
    LimitProblem { joints, ..problem.clone() }
}

#[test]
fn cells_come_down_to_the_load_of_whole_joints() {
    for corners in [CORNERS, OTHERS[0]] {
        let text = changed(TEETH, CORNERS, corners);
        let exact = load(&text);
        let case = first_case(&text);
        let loads = stage_loads(&case.assembly, &case.stages);
        let problem = LimitProblem::new(&case.assembly, &loads[1]).expect("a problem");
        let question = LimitQuestion::Collapse { start: 0.0, max: f64::INFINITY };
        let above = |count: usize| {
            let factor = LimitConic {}.solve(&in_cells(&problem, count), question).factor.expect("a factor");
            factor / exact - 1.0
        };
        let [few, some, many] = [1, 4, 16].map(above);
        assert!(few > some && some > many && many > -1e-9, "{few} {some} {many}");
        assert!(many < 0.3 * some, "{some} {many}");
    }
}

/// Solvers that read one facet in each sense refuse such joints and state the reason.
#[test]
fn solvers_for_one_facet_refuse() {
    for solver in ["limit_chain", "limit_sequential", "limit_least"] {
        let result = answered(&format!("{TEETH}[solver]\nsolver = \"{solver}\"\n"));
        assert_eq!(result.status, Status::Stalled);
        assert!(result.notes.iter().any(|note| note.contains("several facets")), "{solver}: {:?}", result.notes);
    }
}

/// A solver that reads the facets over whole joints finds too much load. The certificate refuses its field, and confirms the
/// exact one.
#[test]
fn the_field_of_a_solver_that_ignores_envelopes_is_refused() {
    for corners in [CORNERS, OTHERS[0]] {
        let text = changed(TEETH, CORNERS, corners);
        let case = first_case(&text);
        let loads = &stage_loads(&case.assembly, &case.stages)[1];
        let exact = LimitProblem::new(&case.assembly, loads).expect("a problem");
        let status = |problem: &LimitProblem| {
            let question = LimitQuestion::Collapse { start: 0.0, max: f64::INFINITY };
            let answer = LimitConic {}.solve(problem, question);
            let (factor, forces) = (answer.factor.expect("a factor"), answer.field.expect("a field"));
            let at = |joint: &LimitJoint, point, force| ContactForce { joint: joint.joint, point, force };
            let of = |(joint, force): (&LimitJoint, &JointForce)| {
                let [n_0, n_1] = force.normal;
                [at(joint, joint.ends[0], [n_0, force.shear]), at(joint, joint.ends[1], [n_1, 0.0])]
            };
            let field: Vec<ContactForce> = problem.joints.iter().zip(&forces).flat_map(of).collect();
            let claim = Claim {
                hint: Status::Stands,
                target: factor,
                factor: None,
                field_factor: factor,
                start: 0.0,
                field: Some(&field),
                fill: &[],
                start_field: None,
                motion: None,
                ray: None,
                supports: None,
                feasible_interval: None,
                non_associated: None,
            };
            certify(&case.assembly, loads, &claim, 1e-9).status
        };
        assert_eq!(status(&exact), Status::Stands);
        assert_ne!(status(&in_cells(&exact, 1)), Status::Stands);
    }
}
