//! Scenes of the random stress test with difficult corners of the path: the present result, and its work. The numbers
//! define the scene for `random::scene`.

use voussoir::core::certificate::MechanismKind;
use voussoir::core::limit::Status;
use voussoir::results::CaseResult;
use voussoir_tests::random::{Law, Numbers, RandomScene, scene};
use voussoir_tests::{Arch, answered, assert_close};

fn scene_of(numbers: Numbers) -> RandomScene {
    scene(numbers).expect("a scene")
}

/// Solves a scene with a solver, after its load history.
fn followed(scene: &RandomScene, solver: &str) -> CaseResult {
    let limit = answered(&scene.associated());
    let known = if limit.status == Status::Collapse { limit.load_factor } else { None };
    answered(&scene.study(solver, known))
}

fn certified(result: &CaseResult, status: Status) -> f64 {
    assert_eq!(result.status, status, "{:?}", result.notes);
    assert!(result.certificate.passed, "{:?}", result.certificate);
    result.load_factor.expect("a factor")
}

/// On a wall of very different bricks both path solvers follow the same pieces to the same collapse.
#[test]
fn both_path_solvers_follow_the_same_pieces() {
    let scene = scene_of((
        Law::Coulomb,
        -0.989_660_220_568_051_8,
        4.116_891_444_282_939,
        3,
        4,
        0.765_339_188_501_275_7,
        2,
        0.825_892_737_888_373_3,
        0.672_786_948_105_318_8,
        3,
    ));
    let [event, newton] = std::thread::scope(|threads| {
        let both = ["event_path", "newton_path"].map(|solver| threads.spawn(|| followed(&scene, solver)));
        both.map(|thread| thread.join().expect("a result"))
    });
    assert_close(certified(&newton, Status::Collapse), certified(&event, Status::Collapse), 1e-12);
}

/// The collapse load of a ring with many compliant points to a joint is that of rigid blocks.
fn collapses_as_rigid(ring: Arch, elements: usize, material: &str) {
    let law = |stiffness: &str| format!("law = \"unilateral\"\ntangential = \"stuck\"\n{stiffness}");
    let rigid = Arch { joint: law(""), ..ring };
    let known = certified(&answered(&rigid.study()), Status::Collapse);
    let many = Arch {
        joint: law("normal_stiffness = 2e10\nshear_stiffness = 1e10"),
        mesh: format!("elements = [1, {elements}]"),
        material: material.into(),
        solver: "event_path",
        ..rigid
    };
    assert_close(certified(&answered(&many.study()), Status::Collapse), known, 1e-9);
}

/// Between rigid blocks, joints with many points are solved by the whole system.
#[test]
fn a_ring_with_many_points_to_a_joint_collapses() {
    collapses_as_rigid(Arch::default(), 72, "law = \"rigid\"");
}

/// Between elastic blocks, here nearly rigid, joints with many points are solved joint by joint. At one event the
/// refined rates leave the modes that the rates before refinement keep.
#[test]
fn refined_rates_of_a_chain_keep_their_modes() {
    let ring = Arch { voussoirs: 3, ends: "jointed", width: 1.0, load: 1000.0, density: 2200.0, ..Arch::default() };
    collapses_as_rigid(ring, 74, "law = \"elastic\"\nyoung_modulus = 1e18\npoisson_ratio = 0.0");
}

/// Bricks that slide side by side are a mechanism. On this wall every brick slides on the ground by itself at λ = μ:
/// the modes leave many motions, and a linear program finds one that can continue without closing a gap.
#[test]
fn bricks_that_slide_side_by_side_are_a_mechanism() {
    let exponent: f64 = -0.785_625_467_461_697_8;
    let scene = scene_of((
        Law::Dilatant,
        exponent,
        4.350_181_491_860_756,
        0,
        4,
        0.226_829_416_723_166_9,
        3,
        0.160_499_699_410_223_38,
        0.736_706_306_441_423_3,
        4,
    ));
    let newton = followed(&scene, "newton_path");
    assert_close(certified(&newton, Status::Collapse), 10f64.powf(exponent), 1e-9);
    assert_eq!(newton.mechanism.as_ref().map(|m| m.kind), Some(MechanismKind::Sliding));
}

/// A limit point at a corner is proved also if no continuation is found: the result is open and lists it.
#[test]
fn a_proved_limit_point_is_listed_if_the_way_on_is_open() {
    let unloaded = [
        (
            Law::Dilatant,
            0.054_696_262_769_130_12,
            0.685_318_683_286_208,
            3,
            3,
            0.492_323_579_475_519_5,
            2,
            0.387_528_387_141_931_8,
            0.718_811_857_433_311_6,
            0,
        ),
        (
            Law::Dilatant,
            0.194_864_736_423_322_67,
            4.936_377_551_916_530_5,
            2,
            3,
            0.314_509_582_819_827_27,
            2,
            0.562_670_547_877_737,
            0.669_956_988_283_859,
            0,
        ),
    ];
    for numbers in unloaded {
        let newton = followed(&scene_of(numbers), "newton_path");
        assert!(matches!(newton.status, Status::Open | Status::LimitPoint), "{:?} {:?}", newton.status, newton.notes);
        let listed = newton.path.limit_points.iter().any(|point| Some(point.factor) == newton.load_factor);
        assert!(listed, "{:?} {:?}", newton.load_factor, newton.notes);
    }
}

/// Many points at the limit of their mode are decided: under the dead load 47 points are at this limit before any live
/// load, and a search for their rate is decided. The wall slides on its ground at λ = μ.
#[test]
fn many_points_at_the_verge_of_a_change_are_decided() {
    let exponent: f64 = -0.263_854_514_873_449_8;
    let scene = scene_of((
        Law::Dilatant,
        exponent,
        5.548_207_716_270_577,
        1,
        2,
        0.501_784_948_968_964_6,
        3,
        0.899_317_350_741_552_4,
        0.876_105_356_668_826_8,
        5,
    ));
    for solver in ["event_path", "newton_path"] {
        assert_close(certified(&followed(&scene, solver), Status::Collapse), 10f64.powf(exponent), 1e-9);
    }
}

/// With finite displacements the modes of these steps settle slowly. Newton's method needs no line search for them: steps
/// are cut only for their energy.
#[test]
fn slow_modes_cost_no_cut_backs() {
    let strengths = (
        Law::Strengths,
        -1.073_508_420_946_689_9,
        3.026_884_668_671_921_7,
        0,
        2,
        0.621_349_840_049_509_1,
        0,
        0.503_996_402_383_757_4,
        0.488_994_030_408_313_84,
        2,
    );
    let associated = (
        Law::Associated,
        0.163_670_435_213_347_56,
        3.074_001_033_804_661,
        3,
        3,
        0.412_792_814_661_272_77,
        0,
        0.452_211_534_815_403,
        0.800_507_552_843_484_1,
        4,
    );
    for (numbers, factor) in [(strengths, 2.634_072), (associated, 1.3073)] {
        let study = scene_of(numbers).study("newton_path\"\nkinematics = \"finite", None);
        let result = answered(&study);
        assert_close(certified(&result, Status::Collapse), factor, 1e-4);
        assert!(result.counters["cutbacks"] <= 20, "{:?}", result.counters);
        // The history of slip needs many steps; each needs few iterations.
        assert!(result.counters["newton_iterations"] <= 6 * result.counters["steps"], "{:?}", result.counters);
    }
}
