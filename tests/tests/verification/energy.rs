//! Paths with finite displacements against the energy program, which shares no mechanics with them: motions as
//! unknowns, minima of the potential energy, the load point held.

use nalgebra::DVector;
use voussoir_independent::energy::*;
use voussoir_tests::settled::{Deforming, Draw, Random, Settling, Shape, settled_scene};
use voussoir_tests::{answered, assert_close, first_case};

const FINITE: &str = "solver = \"newton_path\"\nkinematics = \"finite\"";

/// The arch of 15 voussoirs on compliant joints without slip, with its left support moved.
fn spread_arch(voussoirs: usize, displacement: f64, loaded: bool) -> String {
    let settle = format!(
        "[[stages]]\nname = \"settle\"\nsettlement = [{{ support = \"left\", displacement = [{displacement:?}, 0.0] }}]\n"
    );
    let live = "[[stages]]\nname = \"live\"\nuntil = \"collapse\"\nloads = [{ kind = \"point\", span_fraction = 0.25, force = [0.0, -1000.0] }]\n";
    format!(
        r#"name = "spread"
[scene]
scene = "arch"
profile = {{ shape = "segmental", span = 9.42, rise = 2.99 }}
thickness = 0.60
width = 5.81
voussoirs = {voussoirs}
ends = "bonded"
material = "stone"
joint = "dry"
mesh = {{ elements = [1, 8] }}
[materials.stone]
law = "rigid"
density = 2200.0
[joints.dry]
law = "unilateral"
tangential = "stuck"
normal_stiffness = 2e10
shear_stiffness = 1e10
[solver]
{FINITE}
[[stages]]
name = "dead"
gravity = 9.81
{}{}"#,
        if displacement == 0.0 { "" } else { &settle },
        if loaded { live } else { "" }
    )
}

/// Returns the scene with `count` points of the trapezoidal rule on each joint.
fn with_trapezoidal_rule(mut scene: EnergyScene, count: usize) -> EnergyScene {
    let old = std::mem::take(&mut scene.points);
    for joint in old.chunk_by(|a, b| a.joint == b.joint) {
        let total = [0, 1].map(|i| joint.iter().map(|p| p.stiffness[i]).sum::<f64>());
        let (first, last) = (joint[0].position, joint[joint.len() - 1].position);
        for k in 0..count {
            let x = k as f64 / (count - 1) as f64;
            let share = if k == 0 || k + 1 == count { 0.5 } else { 1.0 } / (count - 1) as f64;
            let stiffness = total.map(|k| k * share);
            scene.points.push(SpringPoint { position: first + (last - first) * x, stiffness, ..joint[0].clone() });
        }
    }
    scene
}

fn rotation(scene: &EnergyScene, landing: &Landing, joint: usize) -> f64 {
    let all = scene.joint_rotations(&scene.settled_supports(), &landing.q);
    all.iter().find(|(k, _)| *k == joint).expect("the joint").1
}

/// Gradient and Hessian of the energy are its difference quotients, with closed, open and slipped points and rotated
/// blocks.
#[test]
fn the_energy_program_derives_its_energy() {
    let mut random = Random::new(1);
    for settling in [Settling::Out, Settling::Both] {
        let draw = Draw { shape: Shape::Arch, deforming: Deforming::Compliant, settling, size: 3e-2, stuck: true };
        let scene = EnergyScene::of_case(&first_case(&settled_scene(&mut random, draw).study(FINITE)));
        let held = scene.held(0, 0.7);
        let q = DVector::from_fn(scene.unknowns(), |_, _| random.uniform(-0.05, 0.05));
        let slip: Vec<f64> = scene.points.iter().map(|_| random.uniform(-1e-3, 1e-3)).collect();
        let at = evaluate(&scene, &held, &q, Some(&slip));
        assert!(at.gap.iter().any(|g| g[0] > 0.0) && at.gap.iter().any(|g| g[0] < 0.0));
        let h = 1e-7;
        for k in 0..q.len() {
            let [up, down] = [h, -h].map(|h| {
                let mut moved = q.clone();
                moved[k] += h;
                evaluate(&scene, &held, &moved, Some(&slip))
            });
            let slope = (up.energy - down.energy) / (2.0 * h);
            assert!((slope - at.gradient[k]).abs() <= 1e-6 * at.gradient.amax(), "{k}: {slope} {}", at.gradient[k]);
            let column = (&up.gradient - &down.gradient) / (2.0 * h);
            let off = (&column - at.hessian.column(k)).amax();
            assert!(off <= 1e-6 * at.hessian.amax(), "{k}: {off:e}");
        }
    }
}

/// The springs of a joint have the stiffness of its area and of its moment of inertia.
#[test]
fn springs_of_a_joint_have_its_area_and_moment_of_inertia() {
    let scene = EnergyScene::of_case(&first_case(&spread_arch(15, 0.0, true)));
    for joint in scene.points.chunk_by(|a, b| a.joint == b.joint) {
        let (first, last) = (joint[0].position, joint[joint.len() - 1].position);
        let (height, middle) = ((last - first).norm(), (first + last) / 2.0);
        let area: f64 = joint.iter().map(|p| p.stiffness[0]).sum();
        let inertia: f64 = joint.iter().map(|p| p.stiffness[0] * (p.position - middle).norm_squared()).sum();
        assert_close(area, 2e10 * 5.81 * height, 1e-12);
        assert_close(inertia, 2e10 * 5.81 * height.powi(3) / 12.0, 1e-12);
    }
}

/// The peak of the arch of 15 voussoirs on compliant joints without settlements is equal by path and by energy program.
#[test]
fn peak_of_an_arch_on_compliant_joints_by_two_routes() {
    let text = spread_arch(15, 0.0, true);
    let scene = EnergyScene::of_case(&first_case(&text));
    let path = load_path(&scene, &dead_load(&scene), TraceLimits::default());
    let [peak] = &path.peaks[..] else { panic!("{:?}", path.peaks) };
    assert_close(peak.factor, 609.604410, 1e-8);
    let result = answered(&text);
    assert!(result.certificate.passed, "{:?}", result.certificate);
    assert_close(result.load_factor.expect("a factor"), peak.factor, 1e-7);
}

/// With 15 voussoirs and a support 5 cm out, the symmetric state, in which joints 7 and 8 rotate equally, is an
/// unstable equilibrium of the energy program; the stable states are mirror twins.
#[test]
fn a_spread_arch_of_15_voussoirs_leaves_its_symmetric_state() {
    let scene = EnergyScene::of_case(&first_case(&spread_arch(15, -0.05, false)));
    let branches = settle(&scene, TraceLimits::default());
    let ends: Vec<&Landing> = branches.iter().map(|b| &b[b.len() - 1].last().landing).collect();
    assert_eq!(ends.len(), 2);
    for (end, [seven, eight]) in ends.iter().zip([[14.107, 4.266], [4.266, 14.107]]) {
        let found = [7, 8].map(|joint| 1e3 * rotation(&scene, end, joint));
        let expected = if (found[0] > found[1]) == (seven > eight) { [seven, eight] } else { [eight, seven] };
        assert!(end.stable_under_load && end.residual < 1e-9);
        assert_close(found[0], expected[0], 1e-3);
        assert_close(found[1], expected[1], 1e-3);
    }
    assert!(rotation(&scene, ends[0], 7) * rotation(&scene, ends[1], 8) > 0.0);
    let symmetric = (&ends[0].q + &ends[1].q) / 2.0;
    let symmetric = stationary(&scene, &scene.settled_supports(), &symmetric, None, Control::Factor(0.0));
    let turned = [7, 8].map(|joint| rotation(&scene, &symmetric, joint));
    assert!(symmetric.converged() && (turned[0] - turned[1]).abs() < 1e-8, "{turned:?}");
    assert!(!symmetric.stable_under_load && symmetric.least_under_load().0 < -5e4);
}

/// With the trapezoidal rule of nine points an independent program gives the same: 17.14 and 0.70 mrad, and with 16
/// voussoirs a first peak near 56, then a fall and a rise to 557.9 (tangential springs of that program act at closed
/// points only).
#[test]
fn spread_arches_by_the_trapezoidal_rule_of_nine_points() {
    let scene = with_trapezoidal_rule(EnergyScene::of_case(&first_case(&spread_arch(15, -0.05, true))), 9);
    let branches = settle(&scene, TraceLimits::default());
    assert_eq!(branches.len(), 2);
    for branch in &branches {
        let end = &branch[branch.len() - 1].last().landing;
        let mut turned = [7, 8].map(|joint| 1e3 * rotation(&scene, end, joint));
        turned.sort_by(f64::total_cmp);
        assert!((turned[0] - 0.70).abs() < 5e-3 && (turned[1] - 17.14).abs() < 5e-3, "{turned:?}");
        let greatest = load_path(&scene, end, TraceLimits::default()).greatest().expect("a peak").factor;
        assert_close(greatest, 616.5, 1e-2);
    }
    let scene = with_trapezoidal_rule(EnergyScene::of_case(&first_case(&spread_arch(16, -0.05, true))), 9);
    let branches = settle(&scene, TraceLimits::default());
    let [branch] = &branches[..] else { panic!("{} branches", branches.len()) };
    let path = load_path(&scene, &branch[0].last().landing, TraceLimits::default());
    assert_close(path.greatest().expect("a peak").factor, 557.9, 1e-2);
    assert!(path.peaks.iter().any(|peak| (peak.factor - 56.0).abs() < 1.0));
    let low = path.states.iter().skip_while(|s| s.at < 1.5e-3).map(|s| s.landing.factor).fold(f64::INFINITY, f64::min);
    assert!((low - 39.8).abs() < 3.0, "{low}");
}
