//! Quantities derived from a path: joints that became hinges, curves, recovered stresses and their files.

use voussoir::core::model::geometry::Vec2;
use voussoir::postprocess::{DisplacedBlock, displaced_blocks};
use voussoir::postprocess::{JointState, joint_events};
use voussoir::results::CaseResult;
use voussoir::solve::{Observer, PathProgress};
use voussoir::solve::{solve_case, solve_cases};
use voussoir::study::Case;
use voussoir::writers::vtu::vtu_text;
use voussoir_tests::known::REFERENCE_ARCH;
use voussoir_tests::{first_case, study};

fn arch(live: &str, solver: &str) -> Case {
    first_case(&text(live, solver))
}

fn text(live: &str, solver: &str) -> String {
    format!(
        r#"
name = "arch"
scene = {{ scene = "arch", profile = {{ shape = "segmental", span = 9.42, rise = 2.99 }}, thickness = 0.60, width = 5.81, voussoirs = 15, ends = "bonded", material = "stone", joint = "dry", mesh = {{ elements = [4, 6], order = 2 }} }}
materials.stone = {{ law = "elastic", young_modulus = "5 GPa", poisson_ratio = 0.3, density = 2200.0 }}
joints.dry = {{ law = "coulomb_associated", friction = 0.6 }}
solver = {solver}
output = {{ curve = true }}
[[stages]]
name = "dead"
gravity = 9.81
{live}
"#
    )
}

const LIVE: &str = r#"
[[stages]]
name = "live"
until = "collapse"
loads = [{ kind = "point", span_fraction = 0.25, force = [0.0, -1000.0] }]
"#;

fn blocks(case: &Case) -> (CaseResult, Vec<DisplacedBlock>) {
    let result = solve_case(case);
    assert!(result.certificate.passed, "{:?} {:?}", result.notes, result.certificate);
    let blocks = displaced_blocks(&case.assembly, &case.stages, &result, case.solver.settings.finite).expect("a path");
    (result, blocks)
}

/// At collapse of the reference arch the joints that the events turned into hinges, together with joints that only the
/// mechanism rotates, are the four hinges of limit analysis; the curve ends at its load.
#[test]
fn the_hinges_of_the_path_are_those_of_the_mechanism() {
    let case = arch(LIVE, r#"{ solver = "event_path" }"#);
    let result = solve_case(&case);
    let mut state = std::collections::BTreeMap::new();
    let events = joint_events(&case.assembly, &result);
    for event in &events {
        state.insert(event.joint, event.became);
    }
    let hinges: Vec<_> = state
        .iter()
        .filter_map(|(joint, became)| match became {
            Some(JointState::Hinge(end)) => Some((*joint, *end)),
            _ => None,
        })
        .collect();
    assert_eq!(hinges, [(1, 0), (5, 1), (10, 0), (14, 1)], "{events:?}");
    assert!(events.windows(2).all(|pair| pair[0].gravity || pair[0].factor <= pair[1].factor));
    let factor = result.load_factor.expect("a collapse");
    assert!((factor - REFERENCE_ARCH).abs() < 1e-9 * factor);
    assert_eq!(result.path.curve.expect("a curve").last().expect("points")[1], factor);
}

fn column(kinematics: &str) -> Case {
    first_case(&format!(
        r#"
name = "column"
[scene]
scene = "blocks"
width = 0.5
material = "stone"
joint = "dry"
mesh = {{ elements = [2, 3], order = 2 }}
[[scene.blocks]]
name = "ground"
vertices = [[-1.0, -1.0], [2.0, -1.0], [2.0, 0.0], [-1.0, 0.0]]
fixed = true
[[scene.blocks]]
name = "low"
vertices = [[0.0, 0.0], [1.0, 0.0], [1.0, 2.0], [0.0, 2.0]]
[[scene.blocks]]
name = "high"
vertices = [[0.0, 2.0], [1.0, 2.0], [1.0, 3.0], [0.0, 3.0]]
[materials.stone]
law = "elastic"
young_modulus = 1e9
poisson_ratio = 0.0
density = 2000.0
[joints.dry]
law = "coulomb_associated"
friction = 0.6
[[stages]]
name = "dead"
gravity = 10.0
[solver]
solver = "newton_path"
kinematics = "{kinematics}"
"#
    ))
}

/// A column under its weight with ν = 0 has σ_yy = −ρ g (H − y) at every node, u_y = −ρ g (H y − y²/2) / E at the nodes
/// of the elements and no lateral displacement, also with finite displacements (strains of 1e-4).
#[test]
fn a_column_carries_its_weight() {
    for (kinematics, far) in [("small", 1e-9), ("finite", 1e-9)] {
        let (_, blocks) = blocks(&column(kinematics));
        assert_eq!(blocks.iter().map(|b| b.order).collect::<Vec<_>>(), [0, 2, 2]);
        let weight = 2000.0 * 10.0;
        for block in &blocks[1..] {
            assert!(block.imbalance < 1e-9, "{}", block.imbalance);
            for ((x, u), stress) in block.nodes.iter().zip(&block.displacement).zip(&block.stress) {
                let exact = -weight * (3.0 - x.y);
                assert!((stress[1] - exact).abs() < far * 3.0 * weight, "{kinematics} {x:?} {stress:?} {exact}");
                assert!(stress[0].abs().max(stress[3].abs()) < far * 3.0 * weight, "{stress:?}");
                let sinks = -weight * (3.0 * x.y - x.y * x.y / 2.0) / 1e9;
                assert!(
                    (u - Vec2::new(0.0, sinks)).norm() < 1e-9 * 9e-5 + far * 9e-5,
                    "{kinematics} {x:?} {u:?} {sinks}"
                );
            }
        }
        assert!(blocks[0].displacement.iter().all(|u| u.norm() == 0.0) && blocks[0].stress.is_empty());
    }
}

/// The stress on the springings of the arch under its weight, integrated by Simpson's rule over the nodes of each
/// element edge, carries the weight, and the thrusts cancel, within 1 %.
#[test]
fn stresses_at_the_springings_carry_the_arch() {
    let case = arch("", r#"{ solver = "event_path" }"#);
    let (_, blocks) = blocks(&case);
    let width = case.assembly.width;
    let mut sum = Vec2::zeros();
    let mut thrust: f64 = 0.0;
    let elastic: Vec<&DisplacedBlock> = blocks.iter().filter(|b| b.order > 0).collect();
    let weight: f64 = elastic.iter().map(|b| case.assembly.inertia(b.block).mass * 9.81).sum();
    for joint in &case.assembly.joints {
        let sides = [(joint.minus, 1.0), (joint.plus, -1.0)];
        let (minus, plus) = (case.assembly.bodies[joint.minus].fixed, case.assembly.bodies[joint.plus].fixed);
        if minus == plus {
            continue;
        }
        let (own, _) = if minus { sides[1] } else { sides[0] };
        let block = elastic.iter().find(|b| b.block == own).expect("an elastic voussoir");
        let (normal, _) = joint.frame();
        // Outward from the voussoir.
        let normal = if own == joint.plus { -normal } else { normal };
        let axis = (joint.ends[1] - joint.ends[0]).normalize();
        let mut along: Vec<(f64, Vec2)> = block
            .nodes
            .iter()
            .zip(&block.stress)
            .filter(|(x, _)| (**x - joint.ends[0]).dot(&normal).abs() < 1e-9)
            .map(|(x, s)| {
                let traction = Vec2::new(s[0] * normal.x + s[3] * normal.y, s[3] * normal.x + s[1] * normal.y);
                ((x - joint.ends[0]).dot(&axis), traction)
            })
            .collect();
        along.sort_by(|a, b| a.0.total_cmp(&b.0));
        assert_eq!(along.len(), 13);
        let force: Vec2 = along
            .windows(3)
            .step_by(2)
            .map(|t| (t[0].1 + t[1].1 * 4.0 + t[2].1) * ((t[2].0 - t[0].0) / 6.0 * width))
            .sum();
        thrust = thrust.max(force.x.abs());
        sum += force;
    }
    assert!((sum.y / weight - 1.0).abs() < 0.01, "{} of {weight}", sum.y);
    assert!(sum.x.abs() < 0.01 * thrust, "{sum:?} {thrust}");
    assert!(blocks.iter().all(|b| b.imbalance < 1e-9));
}

/// Files for ParaView are well formed: tags close in order, every array has one number per point or cell, all are
/// finite.
#[test]
fn files_for_paraview_are_well_formed() {
    let case = arch(LIVE, r#"{ solver = "event_path" }"#);
    let (result, blocks) = blocks(&case);
    let text = vtu_text(&blocks, result.proof.field_factor.expect("a factor"));
    let mut open: Vec<&str> = Vec::new();
    for tag in text.split('<').skip(1).map(|rest| rest.split('>').next().expect("a tag")) {
        match tag.strip_prefix('/') {
            Some(name) => assert_eq!(open.pop(), Some(name)),
            None if tag.starts_with('?') || tag.ends_with('/') => {}
            None => open.push(tag.split(' ').next().expect("a name")),
        }
    }
    assert!(open.is_empty());
    let (points, cells) =
        (blocks.iter().map(|b| b.nodes.len()).sum::<usize>(), blocks.iter().map(|b| b.cells.len()).sum::<usize>());
    assert!(text.contains(&format!("NumberOfPoints=\"{points}\" NumberOfCells=\"{cells}\"")));
    let corners: usize = blocks.iter().flat_map(|b| b.cells.iter().map(Vec::len)).sum();
    for (section, name, count) in [
        ("<Points>", "Points", 3 * points),
        ("<Cells>", "connectivity", corners),
        ("<Cells>", "offsets", cells),
        ("<Cells>", "types", cells),
        ("<PointData", "displacement [m]", 3 * points),
        ("<PointData", "stress [Pa]", 6 * points),
        ("<CellData", "stress [Pa]", 6 * cells),
        ("<CellData", "block", cells),
        ("<CellData", "deformable", cells),
    ] {
        let rest = text.split(section).nth(1).expect("a section");
        let rest = rest.split(&format!("Name=\"{name}\"")).nth(1).expect("an array");
        let body = rest.split('>').nth(1).expect("numbers").split('<').next().expect("an end");
        let numbers: Vec<f64> = body.split_whitespace().map(|word| word.parse().expect("a number")).collect();
        assert_eq!(numbers.len(), count, "{section} {name}");
        assert!(numbers.iter().all(|x| x.is_finite()));
    }
    let limit = arch(LIVE, r#"{ solver = "limit_chain" }"#);
    let result = solve_case(&limit);
    let none = displaced_blocks(&limit.assembly, &limit.stages, &result, false);
    assert_eq!(none.err().as_deref(), Some("limit analysis leaves no deformed state"));
}

/// An observer of a study receives every state of its path, stage after stage; the answer is the same as without it.
#[test]
fn a_path_is_followed_while_it_is_traced() {
    #[derive(Default)]
    struct Seen(std::sync::Mutex<Vec<(String, bool, f64, u64)>>);
    impl Observer for Seen {
        fn answered(&self, _case: &CaseResult) {}
        fn on_path(&self, at: &PathProgress) {
            self.0.lock().unwrap().push((at.stage.into(), at.gravity, at.factor, at.states));
        }
    }
    let followed = study(&text(LIVE, "{ solver = \"event_path\" }"));
    let seen = Seen::default();
    let mut result = solve_cases(&followed, &[0], 1, &seen).swap_remove(0);
    let mut unseen = solve_case(&followed.cases[0]);
    (result.seconds, unseen.seconds) = (0.0, 0.0);
    assert_eq!(serde_json::to_string(&result).unwrap(), serde_json::to_string(&unseen).unwrap());
    let seen = seen.0.into_inner().unwrap();
    assert_eq!(seen.len() as u64, result.counters["states"]);
    assert!(seen.iter().enumerate().all(|(k, at)| at.3 == k as u64 + 1));
    assert!(seen.first().is_some_and(|at| at.0 == "dead" && at.1));
    assert!(seen.last().is_some_and(|at| at.0 == "live" && !at.1 && Some(at.2) == result.load_factor));
}
