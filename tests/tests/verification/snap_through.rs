//! Snap-through and long slips with finite displacements: arches of thick blocks and shallow arches against minima of
//! their potential energy, blocks that slide and overturn against closed forms.
//!
//! Another program, which shares nothing with Voussoir, minimised the energies: unknowns are the motions of the blocks
//! alone, E(q) = Σ ½ k A ⟨−g_n⟩² + ½ k_t A g_t² + Σ W y, ∂E/∂q + P ∂u/∂q = 0 at held displacements u of the load, the
//! peak by golden section. Gaps are in axes that rotate by the mean rotation of two blocks, which with springs is a
//! valid material law.

use std::sync::Arc;
use voussoir::core::limit::Status;
use voussoir::core::path::{Continuation, PathAnswer, PathProblem, PathSettings, PathSolver, PathState};
use voussoir::solvers::path::continuation::displacement_control::DisplacementControl;
use voussoir::solvers::path::newton::NewtonPath;
use voussoir_tests::seen::Record;
use voussoir_tests::{answered, assert_close, first_case};

fn followed(
    text: &str,
    stop: f64,
    continuation: Option<Arc<dyn Continuation>>,
) -> (PathProblem, PathAnswer, Vec<PathState>) {
    let case = first_case(text);
    let problem = PathProblem::new(&case.assembly, &case.stages).expect("a path problem");
    let mut record = Record::default();
    let settings = PathSettings {
        finite: true,
        tolerance: 1e-9,
        stop_displacement: Some(stop),
        stop_factor: None,
        continuation,
        stages: Vec::new(),
    };
    let answer = NewtonPath {}.trace(&problem, &settings, &mut record);
    (problem, answer, record.0)
}

/// Joints that never slide: the tangential spring acts at open points too, or only at closed points.
const STUCK: &str = "law = \"unilateral\"\ntangential = \"stuck\"";
const ROUGH: &str = "law = \"coulomb\"\nfriction = 5.0";
const DRY: &str = "law = \"coulomb\"\nfriction = 0.6";

/// A segmental arch of rigid voussoirs on joints with the stiffness k \[Pa/m\], and half of it along them.
struct Arch {
    span: f64,
    rise: f64,
    thickness: f64,
    voussoirs: usize,
    ends: &'static str,
    across: usize,
    density: f64,
    stiffness: f64,
    law: &'static str,
    /// Span fractions of loads of 1 kN.
    loads: &'static [f64],
    stop: f64,
}

impl Arch {
    /// Two blocks 0.4 m thick over 4 m, rise 0.1 m, loaded on both sides of the crown.
    fn thick(stiffness: f64, law: &'static str) -> Self {
        Arch {
            span: 4.0,
            rise: 0.1,
            thickness: 0.4,
            voussoirs: 2,
            ends: "jointed",
            across: 1,
            density: 2000.0,
            stiffness,
            law,
            loads: &[0.4, 0.6],
            stop: 0.62,
        }
    }

    /// Thirteen voussoirs 0.6 m thick over 9.42 m.
    fn shallow(rise: f64, stiffness: f64, loads: &'static [f64], law: &'static str) -> Self {
        Arch {
            span: 9.42,
            rise,
            thickness: 0.6,
            voussoirs: 13,
            ends: "bonded",
            across: 4,
            density: 2200.0,
            stiffness,
            law,
            loads,
            stop: 0.02,
        }
    }

    fn study(&self) -> String {
        let load = |at: &f64| format!("{{ kind = \"point\", span_fraction = {at:?}, force = [0.0, -1000.0] }}");
        format!(
            r#"name = "snap"
[scene]
scene = "arch"
profile = {{ shape = "segmental", span = {:?}, rise = {:?} }}
thickness = {:?}
width = 1.0
voussoirs = {}
ends = "{}"
material = "stone"
joint = "dry"
[scene.mesh]
elements = [1, {}]
[materials.stone]
law = "rigid"
density = {:?}
[joints.dry]
{}
normal_stiffness = {:?}
shear_stiffness = {:?}
[solver]
solver = "newton_path"
kinematics = "finite"
stop = {{ displacement = {:?} }}
[[stages]]
name = "dead"
gravity = 9.81
[[stages]]
name = "live"
until = "collapse"
loads = [{}]
[output]
curve = true
"#,
            self.span,
            self.rise,
            self.thickness,
            self.voussoirs,
            self.ends,
            self.across,
            self.density,
            self.law,
            self.stiffness,
            self.stiffness / 2.0,
            self.stop,
            self.loads.iter().map(load).collect::<Vec<_>>().join(", ")
        )
    }
}

/// Returns the factor of the trough that the notes name.
fn trough(notes: &[String]) -> f64 {
    let start = "after the peak the load falls to the factor ";
    let note = notes.iter().find_map(|note| note.strip_prefix(start)).unwrap_or_else(|| panic!("{notes:?}"));
    note.split(' ').next().and_then(|number| number.parse().ok()).expect("a number")
}

/// Two thick blocks hinge at the intrados of the supports and the extrados of the crown and snap through at the
/// peak and the trough that another program finds from minima of the energy, with springs along the whole joint and
/// along its closed part. At the troughs one point touches in each joint. In the second case it has slipped so far that its corner has left the face, which
/// that energy does not model.
#[test]
fn two_thick_blocks_snap_through_at_the_extremes_of_their_energy() {
    for (law, stiffness, peak, low) in [
        (STUCK, 1e8, 22.594774717, Some(-41.444908413)),
        (STUCK, 1e9, 313.922138411, Some(-327.591054661)),
        (STUCK, 1e10, 3227.196225769, Some(-3189.053173702)),
        (ROUGH, 1e8, 22.590219654, None),
        (ROUGH, 1e9, 313.886632213, None),
        (ROUGH, 1e10, 3226.851006952, None),
    ] {
        let arch = Arch::thick(stiffness, law);
        let (_, answer, states) = followed(&arch.study(), if low.is_some() { 0.62 } else { 0.1 }, None);
        assert_eq!(answer.status, Status::Collapse, "{law} {stiffness}: {:?}", answer.notes);
        assert_close(answer.factor.expect("a peak"), peak, 1e-9);
        if let Some(low) = low {
            assert_close(trough(&answer.notes), low, 1e-9);
            assert!(states.last().expect("states").factor > 0.8 * low, "the post-peak branch rises");
        }
        for state in &states {
            assert!((state.motion[1][2] + state.motion[2][2]).abs() < 1e-9, "the arch stays symmetric");
        }
    }
}

/// Shallow arches of thirteen voussoirs have the peaks that another program finds from minima of the energy, with arc
/// length and with displacement control.
#[test]
fn shallow_arches_peak_where_their_energy_does() {
    for (rise, stiffness, loads, peak) in [
        (0.6, 1e8, &[0.5][..], 30.569708703),
        (0.6, 1e10, &[0.5], 7923.266108075),
        (0.6, 1e10, &[0.25], 9562.461847736),
        (0.9, 1e9, &[0.25], 764.568054877),
    ] {
        let arch = Arch::shallow(rise, stiffness, loads, STUCK);
        let control: Arc<dyn Continuation> = Arc::new(DisplacementControl::default());
        for continuation in [None, Some(control)] {
            let (_, answer, _) = followed(&arch.study(), arch.stop, continuation);
            assert_eq!(answer.status, Status::Collapse, "{rise} {stiffness}: {:?}", answer.notes);
            assert_close(answer.factor.expect("a peak"), peak, 1e-9);
        }
    }
}

/// Shallow and steeper arches with friction 0.6, followed 0.2 m beyond the peak: each path ends with a peak and a
/// certified post-peak branch, at the distance of `stop` or with a reason in the notes. On a branch with many slips the
/// reason depends on rounding: a change of 1e-13 of the thickness changes it. Under a load at its crown the arch of
/// rise 1.5 m on soft joints leans from 170.3 on: the symmetric branch would have its peak at 180.0517 (joints that
/// slip without losing contact at their corners); with the load 0.1 % of the span beside the crown the peak is
/// 176.8752.
#[test]
fn paths_of_shallow_arches_end_for_a_reason() {
    let reasons = [
        "cycles between",
        "back and forth",
        "unloading from there has come back",
        "has slipped by",
        "was not followed further",
        "steps were not enough",
    ];
    for (rise, stiffness, loads, peak) in [
        (0.3, 1e9, &[0.5][..], 330.5274137),
        (0.3, 1e10, &[0.25], 5894.382263),
        (0.6, 1e8, &[0.5], 30.4253175),
        (0.6, 1e10, &[0.5], 7878.548595),
        (0.6, 1e10, &[0.25], 9465.684196),
        (0.9, 1e9, &[0.25], 755.8113941),
        (1.5, 1e8, &[0.5], 178.6029942),
        (1.5, 1e10, &[0.25], 543.7871937),
    ] {
        let arch = Arch { stop: 0.2, ..Arch::shallow(rise, stiffness, loads, DRY) };
        let result = answered(&arch.study());
        assert_eq!(result.status, Status::Collapse, "{rise} {stiffness}: {:?}", result.notes);
        assert!(result.certificate.passed, "{:?}", result.certificate);
        assert_close(result.load_factor.expect("a peak"), peak, 1e-6);
        let curve = result.path.curve.expect("a curve");
        let highest = curve.iter().map(|p| p[1]).fold(0.0, f64::max);
        let (top, last) = (curve.iter().position(|p| p[1] == highest).expect("a peak"), curve.len() - 1);
        // `stop` counts from the last limit point.
        let from = result.path.limit_points.last().map_or(curve[top][0], |limit_point| limit_point.displacement);
        let far = (curve[last][0] - from).abs() > 0.9 * arch.stop;
        let named = result.notes.iter().any(|note| reasons.iter().any(|reason| note.contains(reason)));
        assert!(far || named, "{rise} {stiffness}: {:?}", result.notes);
        let least = curve[top..].iter().map(|p| p[1]).fold(peak, f64::min);
        assert!(least < 0.75 * peak, "the branch falls: {least} of {peak}");
    }
}

/// An arch that snaps through under its own weight ends at a limit point of gravity, which its states prove. Below the
/// supports it may stand again, so that nothing refutes its equilibrium. The end of the range of the live load does not
/// change it.
#[test]
fn an_arch_that_its_weight_snaps_through_ends_at_a_limit_point_of_gravity() {
    for stop in [0.02, 0.96] {
        let result = answered(&Arch { stop, ..Arch::shallow(0.3, 1e8, &[0.5], DRY) }.study());
        assert_eq!((result.status, result.load_factor), (Status::LimitPoint, None), "{:?}", result.notes);
        assert!(result.certificate.passed, "{:?}", result.certificate);
        let [limit] = result.path.limit_points.as_slice() else { panic!("{:?}", result.path.limit_points) };
        assert_close(limit.factor, 0.702285227, 1e-8);
        assert!(limit.gravity && result.path.first_limit_point.is_none());
        assert_eq!(result.path.end_is_checked, Some(true));
        let words = voussoir::figures::format::headline(&result, &[]);
        assert_eq!(words, "limit point at 0.7023 of the gravity of stage \"dead\"");
    }
}

/// A rigid block on the ground, μ = 0.5, weight 2000 × 10 N per m² of its face.
fn blocks(ground: [f64; 4], block: [f64; 4], push: [f64; 2], stiffness: f64) -> String {
    let corners = |[left, bottom, right, top]: [f64; 4]| {
        format!("[[{left:?}, {bottom:?}], [{right:?}, {bottom:?}], [{right:?}, {top:?}], [{left:?}, {top:?}]]")
    };
    format!(
        r#"name = "slide"
[scene]
scene = "blocks"
width = 1.0
material = "stone"
joint = "dry"
blocks = [
  {{ name = "ground", vertices = {}, fixed = true }},
  {{ name = "block", vertices = {} }},
]
[scene.mesh]
elements = [1, 2]
[materials.stone]
law = "rigid"
density = 2000.0
[joints.dry]
law = "coulomb"
friction = 0.5
normal_stiffness = {stiffness:?}
shear_stiffness = {stiffness:?}
[solver]
solver = "newton_path"
kinematics = "finite"
[[stages]]
name = "dead"
gravity = 10.0
[[stages]]
name = "live"
until = "collapse"
loads = [{{ kind = "point", block = "block", point = {push:?}, force = [1000.0, 0.0] }}]
"#,
        corners(ground),
        corners(block)
    )
}

/// A block pushed over a wide ground slides under the constant load μ W over four times its width: its points belong to
/// its own face, so the pressures under it do not change.
#[test]
fn a_block_slides_a_long_way_under_the_same_load() {
    for push in [0.2, 0.8] {
        let text = blocks([-1.0, -0.5, 6.0, 0.0], [0.0, 0.0, 1.0, 2.0], [0.0, push], 1e8);
        let (problem, answer, states) = followed(&text, 4.5, None);
        assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
        assert_close(answer.factor.expect("a load"), 20.0, 1e-9);
        let sliding: Vec<&PathState> = states.iter().filter(|s| s.load_step == 1 && s.displacement > 0.05).collect();
        let last = *sliding.last().expect("states");
        assert!(sliding.len() > 20 && last.displacement > 4.0);
        for state in &sliding {
            assert_close(state.factor, 20.0, 1e-9);
            for (force, end) in state.force.iter().zip(&last.force) {
                assert!((force[0] - end[0]).abs() < 1e-6 * 40_000.0, "{force:?} {end:?}");
            }
            // Moments about the left lower corner of the block, which rotates with it.
            let [x, y, theta] = state.motion[1];
            let place = |px: f64, py: f64| {
                let (dx, dy) = (px - 0.5, py - 1.0);
                let (sine, cosine) = theta.sin_cos();
                [x + 0.5 + cosine * dx - sine * dy, y + 1.0 + sine * dx + cosine * dy]
            };
            let pressed: f64 = problem
                .contacts
                .iter()
                .zip(&state.force)
                .map(|(c, r)| {
                    let [px, py] = place(c.position.x, c.position.y);
                    r[0] * (px - place(0.0, 0.0)[0]) + 0.5 * r[0] * (py - place(0.0, 0.0)[1])
                })
                .sum();
            let asked = 40_000.0 * (place(0.5, 1.0)[0] - place(0.0, 0.0)[0])
                + 20_000.0 * (place(0.0, push)[1] - place(0.0, 0.0)[1]);
            assert_close(pressed, asked, 1e-9);
        }
    }
}

/// A block that slides over a shorter block, or over one of equal length with the same corners, tips when the resultant
/// reaches the edge of the support. Its points belong to the support, or change to corners that stay on a face. By
/// theory the load is W tan(φ + θ) with the small tilt θ of the block if all points slide on its face, down to W tan φ
/// if they slide on the face of the support. It tips after a slip of b/2 − μ y, where y is the height of the push, less
/// the tilt from soft joints, which decreases as 1/k. Compared from a slip of h/20 on, when corners have separated.
#[test]
fn a_block_that_slides_over_an_edge_tips_where_the_resultant_reaches_it() {
    let weight = 60.0;
    for (block, own) in [([-3.0, 0.0, 3.0, 0.5], true), ([-1.0, 0.0, 1.0, 1.5], false)] {
        let mut short = Vec::new();
        for stiffness in [1e8, 1e9] {
            let text = blocks([-1.0, -0.5, 1.0, 0.0], block, [block[0], 0.2], stiffness);
            let (_, answer, states) = followed(&text, 2.0, None);
            assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
            let mut tipping = None;
            for state in states.iter().filter(|s| s.load_step == 1 && s.displacement > 0.11) {
                let slip = -state.gap[0][1];
                let [pressed, rubbed] = [0, 1].map(|i| state.force.iter().map(|r| r[i].abs()).sum::<f64>());
                // It sticks while it tips, and slides back far beyond.
                if rubbed > (0.5 - 1e-9) * pressed && state.factor > 25.0 {
                    let exact = |share: f64| weight * (0.5f64.atan() + share * state.motion[1][2]).tan();
                    let of_block = (state.factor - exact(0.0)) / (exact(1.0) - exact(0.0));
                    let least = if own { 1.0 } else { 0.0 };
                    assert!((least - 1e-4..1.0 + 1e-4).contains(&of_block), "{block:?}: {of_block}");
                    tipping = Some(slip);
                }
            }
            let last = states.last().expect("states");
            assert!(last.motion[1][2] < -0.05 && last.factor < 0.6 * answer.factor.expect("a load"), "it tips");
            short.push(0.9 - tipping.expect("a slip"));
        }
        assert!(short[1] > 0.0 && short[1] < 0.004, "{block:?} {short:?}");
    }
}
