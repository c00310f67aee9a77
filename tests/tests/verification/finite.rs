//! Finite displacements: closed forms of arches of two bars, spreading supports, the peak of the reference bridge, and
//! independence of step, strategy, units and side.

use std::sync::Arc;
use voussoir::core::certificate::MechanismKind;
use voussoir::core::limit::Status;
use voussoir::core::model::geometry::Vec2;
use voussoir::core::path::{
    Contact, Continuation, LoadStepEnd, PathAnswer, PathProblem, PathSettings, PathSolver, PathState, PointLaw,
};
use voussoir::solvers::path::newton::NewtonPath;
use voussoir_tests::by_hand::{self, body, contact, forces, ground, load_step};
use voussoir_tests::known::REFERENCE_ARCH;
use voussoir_tests::seen::Record;
use voussoir_tests::{answered, assert_close, changed, first_case};

fn settings(stop_displacement: Option<f64>, continuation: Option<Arc<dyn Continuation>>) -> PathSettings {
    PathSettings {
        finite: true,
        tolerance: 1e-9,
        stop_displacement,
        stop_factor: None,
        continuation,
        stages: Vec::new(),
    }
}

fn followed(text: &str, settings: &PathSettings) -> (PathProblem, PathAnswer, Vec<PathState>) {
    let case = first_case(text);
    let problem = PathProblem::new(&case.assembly, &case.stages).expect("a path problem");
    let mut record = Record::default();
    let answer = NewtonPath {}.trace(&problem, settings, &mut record);
    (problem, answer, record.0)
}

/// Half span \[m\].
const SPAN: f64 = 5.0;
/// Horizontal distance of the loads from the supports \[m\].
const LOADED: f64 = 3.5;
/// Compliance of the pins, along the first direction of the bar and across it, at a support and at the crown \[m/N\].
const PIN: [f64; 2] = [1.0e-7, 0.4e-7];
const CROWN: f64 = 0.5e-7;

/// Two rigid bars pinned to the ground and to each other by compliant pins; a load P on each.
fn two_bars(rise: f64) -> PathProblem {
    let along = Vec2::new(SPAN, rise).normalize();
    let mirrored = Vec2::new(along.x, -along.y);
    let crown = Vec2::new(0.0, rise);
    let pin = |joint: usize, position: Vec2, normal: Vec2, compliance: [f64; 2]| Contact {
        compliance,
        ..contact(joint, position, normal, [joint, (joint + 1) % 3], PointLaw::Bonded)
    };
    let load = Vec2::new(0.0, -1.0e3);
    let loading = forces(vec![
        (1, None, Vec2::new(LOADED - SPAN, rise * 0.6), load),
        (2, None, Vec2::new(SPAN - LOADED, rise * 0.6), load),
    ]);
    let middle = |x: f64| Vec2::new(x, rise / 2.0);
    by_hand::problem(
        vec![ground(0, middle(0.0)), body(1, middle(-SPAN / 2.0)), body(2, middle(SPAN / 2.0))],
        vec![
            pin(0, Vec2::new(-SPAN, 0.0), along, PIN),
            pin(1, crown, Vec2::new(1.0, 0.0), [CROWN, PIN[1]]),
            pin(2, Vec2::new(SPAN, 0.0), mirrored, PIN),
        ],
        vec![load_step(0, loading, LoadStepEnd::Collapse(f64::INFINITY))],
        2.0 * SPAN,
    )
}

/// The left bar of a symmetric three-hinged arch; the right bar is its mirror image.
struct Bar {
    /// Positions relative to the support: hinge of the crown, load, centroid \[m\].
    crown: Vec2,
    load: Vec2,
    centroid: Vec2,
    /// Half the span between the hinges \[m\].
    span: f64,
    /// Weight \[N\].
    weight: f64,
    /// Angle of the normal at the support, and compliance along and across it \[m/N\].
    normal: f64,
    support: [f64; 2],
    /// Compliance of the hinge of the crown along the normal, which is horizontal \[m/N\].
    hinge: f64,
}

impl Bar {
    /// Returns the load P on the bar \[N\] at its rotation θ, in closed form.
    ///
    /// The frame e_1, e_2 of a hinge has the mean rotation of its two bodies, here θ/2 at the support and 0 at the
    /// crown. Its jump is δ = −K F with K = Σ c_i e_i e_iᵀ, where F = (H, V) is the force on the bar, V = P + W, and F
    /// acts midway between the two sides. With L, D, G = R(θ)(crown, load, centroid − support) and a half the span:
    ///
    /// ```text
    /// crown      −a + δ_x + L_x = c H / 2                               so H = α − β V
    /// moments    H (L_y + δ_y/2) = P (D_x + δ_x/2) + W (G_x + δ_x/2)    about the support's point of action
    /// ```
    ///
    /// With the first equation inserted the second is quadratic in V; the hinges are stiff, so the smaller root is
    /// used.
    fn closed_load(&self, theta: f64) -> f64 {
        let (sine, cosine) = theta.sin_cos();
        let turn = |v: Vec2| Vec2::new(cosine * v.x - sine * v.y, sine * v.x + cosine * v.y);
        let (arm, load, centroid) = (turn(self.crown), turn(self.load), turn(self.centroid));
        let angle = self.normal + theta / 2.0;
        let (e, t) = (Vec2::new(angle.cos(), angle.sin()), Vec2::new(-angle.sin(), angle.cos()));
        let k = |i: usize, j: usize| self.support[0] * e[i] * e[j] + self.support[1] * t[i] * t[j];
        let whole = k(0, 0) + self.hinge / 2.0;
        let (alpha, beta) = ((arm.x - self.span) / whole, k(0, 1) / whole);
        // δ_x = −k00 H − k01 V and δ_y = −k01 H − k11 V, each as constant + slope × V.
        let x = [-k(0, 0) * alpha, k(0, 0) * beta - k(0, 1)];
        let y = [-k(0, 1) * alpha, k(0, 1) * beta - k(1, 1)];
        let constant = alpha * (arm.y + y[0] / 2.0) + self.weight * (load.x - centroid.x);
        let linear = -beta * (arm.y + y[0] / 2.0) + alpha * y[1] / 2.0 - (load.x + x[0] / 2.0);
        let square = -beta * y[1] / 2.0 - x[1] / 2.0;
        let root = (linear * linear - 4.0 * square * constant).sqrt();
        2.0 * constant / (-linear + root) - self.weight
    }

    /// Returns the first maximum of the load while the bar rotates downwards, by golden section.
    fn peak(&self) -> f64 {
        let step = 1e-3;
        let load = |i: i32| self.closed_load(-step * f64::from(i));
        let top = (1..).find(|i| load(i + 1) < load(*i)).expect("a peak");
        let (mut low, mut high) = (-step * f64::from(top + 1), -step * f64::from(top - 1));
        let golden = (5f64.sqrt() - 1.0) / 2.0;
        while high - low > 1e-9 {
            let (a, b) = (high - golden * (high - low), low + golden * (high - low));
            if self.closed_load(a) < self.closed_load(b) { low = a } else { high = b }
        }
        self.closed_load((low + high) / 2.0)
    }
}

/// A shallow three-hinged arch snaps through on its closed form: every state of the whole loop, from the unloaded arch
/// over the peak and the trough to the unloaded arch below its supports and beyond, and the load of the peak.
#[test]
fn a_three_hinged_arch_follows_its_closed_form_through_the_whole_loop() {
    for rise in [0.4, 1.5] {
        let problem = two_bars(rise);
        let mut record = Record::default();
        let answer = NewtonPath {}.trace(&problem, &settings(Some(2.2 * rise), None), &mut record);
        // Below its supports the arch carries more than at the peak: an answer would depend on the end of the path.
        assert_eq!(answer.status, Status::Stalled, "{:?}", answer.notes);
        assert!(answer.notes.iter().any(|note| note.starts_with("still rising")), "{:?}", answer.notes);
        let [peak] = answer.limit_points[..] else { panic!("one peak: {:?}", answer.limit_points) };
        let factor = peak.factor;
        let bar = Bar {
            crown: Vec2::new(SPAN, rise),
            load: Vec2::new(LOADED, 0.6 * rise),
            centroid: Vec2::zeros(),
            span: SPAN,
            weight: 0.0,
            normal: rise.atan2(SPAN),
            support: PIN,
            hinge: CROWN,
        };
        assert_close(factor, bar.peak() / 1e3, 1e-8);
        let (mut worst, mut least): (f64, f64) = (0.0, 0.0);
        for state in &record.0 {
            let closed = bar.closed_load(state.motion[1][2]) / 1e3;
            worst = worst.max((state.factor - closed).abs() / factor);
            least = least.min(state.factor);
            assert!((state.motion[1][2] + state.motion[2][2]).abs() < 1e-9, "the arch stays symmetric");
        }
        let last = record.0.last().expect("states");
        assert!(worst < 1e-8, "rise {rise}: {worst:.1e} of the peak");
        assert!(least < -0.5 * factor && last.factor > 0.0, "the loop is whole: least {least}, last {}", last.factor);
    }
}

/// An arch of two thick blocks on supports without tension, with friction that is not reached, hinges at the intrados
/// of the supports and at the extrados of the crown and snaps through. Near the peak the corners are pressed in so far
/// that more points touch. If one point touches in each joint and sticks, also at the trough, states are on the closed
/// form of the three-hinged arch. (`unilateral`, stuck, would carry shear at open points too.)
#[test]
fn a_shallow_arch_of_thick_blocks_hangs_from_its_corners() {
    let text = r#"name = "snap"
[scene]
scene = "arch"
profile = { shape = "segmental", span = 4.0, rise = 0.1 }
thickness = 0.4
width = 1.0
voussoirs = 2
ends = "jointed"
material = "stone"
joint = "rough"
[scene.mesh]
elements = [1, 1]
[materials.stone]
law = "rigid"
density = 2000.0
[joints.rough]
law = "coulomb"
friction = 5.0
normal_stiffness = 1e8
shear_stiffness = 5e9
[solver]
solver = "newton_path"
kinematics = "finite"
[[stages]]
name = "dead"
gravity = 9.81
[[stages]]
name = "live"
until = "collapse"
loads = [{ kind = "point", span_fraction = 0.4, force = [0.0, -1000.0] }, { kind = "point", span_fraction = 0.6, force = [0.0, -1000.0] }]
"#;
    let (problem, answer, states) = followed(text, &settings(Some(0.62), None));
    assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
    let contacts = |joint: usize| problem.contacts.iter().filter(move |c| c.joint == joint);
    let support = contacts(0).min_by(|a, b| a.position.y.total_cmp(&b.position.y)).expect("points");
    let crown = contacts(1).max_by(|a, b| a.position.y.total_cmp(&b.position.y)).expect("points");
    let left = support.plus.body;
    let load = problem.load_steps[1].loading.forces.iter().find(|f| f.0 == left).expect("a load on the left block").2;
    let bar = Bar {
        crown: crown.position - support.position,
        load: load - support.position,
        centroid: problem.bodies[left].pole - support.position,
        span: crown.position.x - support.position.x,
        weight: 9.81 * problem.bodies[left].mass,
        normal: support.normal.y.atan2(support.normal.x),
        support: support.compliance,
        hinge: crown.compliance[0],
    };
    let factor = answer.factor.expect("a peak");
    let (mut compared, mut least, mut least_compared) = (0, 0.0f64, 0.0f64);
    for state in states.iter().filter(|s| s.load_step == 1) {
        least = least.min(state.factor);
        let largest = state.force.iter().fold(0.0, |a: f64, r| a.max(r[0]));
        let pressed = |joint: usize| {
            let own = problem.contacts.iter().zip(&state.force).filter(move |(c, _)| c.joint == joint);
            own.filter(|(_, r)| r[0] > 1e-9 * largest).map(|(_, r)| *r).collect::<Vec<_>>()
        };
        let sticks = |r: &[f64; 2]| r[1].abs() < 4.99 * r[0];
        if (0..3).all(|joint| matches!(&pressed(joint)[..], [r] if sticks(r))) {
            let closed = bar.closed_load(state.motion[left][2]) / 1e3;
            assert!((state.factor - closed).abs() < 1e-8 * factor, "{} {closed}", state.factor);
            least_compared = least_compared.min(state.factor);
            compared += 1;
        }
    }
    assert!(compared > 50 && least == least_compared, "{compared} of {}, {least_compared} {least}", states.len());
    assert!(least < -0.3 * factor, "trough {least}");
}

/// The reference bridge with elastic voussoirs; lengths in units of 1/`unit` m, forces in N.
struct Bridge {
    young_modulus: f64,
    mesh: &'static str,
    span_fraction: f64,
    unit: f64,
    stop: f64,
    strategy: &'static str,
}

impl Default for Bridge {
    fn default() -> Self {
        Bridge {
            young_modulus: 5e9,
            mesh: "elements = [4, 6]",
            span_fraction: 0.25,
            unit: 1.0,
            stop: 1e-5,
            strategy: "strategy = \"arc_length\"",
        }
    }
}

impl Bridge {
    fn study(&self) -> String {
        let u = self.unit;
        format!(
            r#"name = "bridge"
[scene]
scene = "arch"
profile = {{ shape = "segmental", span = {:?}, rise = {:?} }}
thickness = {:?}
width = {:?}
voussoirs = 15
ends = "bonded"
material = "stone"
joint = "dry"
[scene.mesh]
{}
[materials.stone]
law = "elastic"
young_modulus = {:?}
poisson_ratio = 0.3
density = {:?}
[joints.dry]
law = "coulomb"
friction = 0.6
[solver]
solver = "newton_path"
kinematics = "finite"
stop = {{ displacement = {:?} }}
continuation = {{ {} }}
[[stages]]
name = "dead"
gravity = {:?}
[[stages]]
name = "live"
until = "collapse"
loads = [{{ kind = "point", span_fraction = {:?}, force = [0.0, -1000.0] }}]
[output]
curve = true
"#,
            9.42 * u,
            2.99 * u,
            0.6 * u,
            5.81 * u,
            self.mesh,
            self.young_modulus / (u * u),
            // Weight per volume ρ g in N per unit of length cubed, with g in units of length per s².
            2200.0 / (u * u * u * u),
            self.stop * u,
            self.strategy,
            9.81 * u,
            self.span_fraction,
        )
    }

    fn peak(&self) -> f64 {
        let result = answered(&self.study());
        assert_eq!(result.status, Status::Collapse, "{:?}", result.notes);
        assert!(result.certificate.passed, "{:?}", result.certificate);
        result.load_factor.expect("a peak")
    }
}

/// Rigid-block limit load of the reference bridge \[kN\].
const RIGID: f64 = REFERENCE_ARCH;

/// The tolerance of a study is the accuracy of its states: a loose tolerance saves iterations and keeps the peak within
/// it; a tight one has the same peak as the default. In a stiff bridge the first iteration is exact to rounding.
#[test]
fn the_tolerance_of_a_study_is_that_of_its_states() {
    let of = |tolerance: &str| {
        let kinematics = "kinematics = \"finite\"";
        let soft = Bridge { young_modulus: 1e8, ..Bridge::default() };
        let text = changed(&soft.study(), kinematics, &format!("{kinematics}\ntolerance = {tolerance}"));
        let result = answered(&text);
        (result.load_factor.expect("a peak"), result.counters["newton_iterations"])
    };
    let [loose, default, tight] = ["1e-6", "1e-9", "1e-12"].map(of);
    assert!(loose.1 < default.1 && default.1 <= tight.1, "{loose:?} {default:?} {tight:?}");
    assert_close(loose.0, default.0, 1e-6);
    assert_close(tight.0, default.0, 1e-9);
}

/// Step size, strategy, unit of length and reflection do not change the peak.
#[test]
fn the_peak_does_not_depend_on_steps_strategy_units_or_side() {
    let peak = Bridge::default().peak();
    let others = [
        Bridge { strategy: "strategy = \"arc_length\", largest_step = 0.0002", ..Bridge::default() },
        Bridge { strategy: "strategy = \"displacement_control\"", ..Bridge::default() },
        Bridge { unit: 1000.0, ..Bridge::default() },
        Bridge { span_fraction: 0.75, ..Bridge::default() },
    ];
    for other in others {
        assert_close(other.peak(), peak, 1e-6);
    }
}

/// Peaks of converged meshes at E = 5, 20, 80, 320 GPa tend to the rigid limit. Near it (page
/// `docs/theory/finite_displacements.md`)
///
/// ```text
/// λ(t) = λ_0 − A t − B / (E' t) + O(1/E),  deficit → 2 √(A B / E')
/// ```
///
/// where A is the rate at which the load of the rigid mechanism falls and B = Σ ξ N² / width over the hinges: the
/// contact zone of a hinge rotated by θ has its resultant at e = ξ N / (width E' θ) from the corner. A from the finite
/// motion of the four hinges, ξ = 2.516 (extrados corners, 85.7°) and 1.8225 (intrados corners, 94.3°) from a wedge
/// pressed on a line, both computed by another program, give √E × deficit = 81.40 × √5 kN √GPa.
#[test]
fn the_rigid_limit_is_approached_as_the_root_of_the_modulus() {
    let meshes = [(5.0, "elements = [8, 12]\ngrading = 10.0"), (80.0, "elements = [10, 16]\ngrading = 70.0")];
    let mut before: Option<f64> = None;
    for (modulus, mesh) in meshes {
        let peak = Bridge { young_modulus: modulus * 1e9, mesh, ..Bridge::default() }.peak();
        let deficit = RIGID - peak;
        let asymptote = 81.40 * (5.0f64 / modulus).sqrt();
        // The error of the mesh, and the term in 1/E.
        assert_close(deficit, asymptote, 0.08);
        if let Some(before) = before {
            let exponent = (deficit / before).ln() / 16f64.ln();
            assert!((exponent + 0.5).abs() < 0.05, "E = {modulus} GPa: deficit {deficit}, exponent {exponent}");
        }
        before = Some(deficit);
    }
}

/// The converged peak of the reference bridge, 620.6 kN, is within the error estimate of an affordable mesh; after the
/// peak the load falls along the whole branch.
#[test]
fn the_peak_of_the_reference_bridge_and_the_branch_behind_it() {
    let bridge = Bridge { mesh: "elements = [8, 12]\ngrading = 10.0", stop: 0.01, ..Bridge::default() };
    let result = answered(&bridge.study());
    assert_eq!(result.status, Status::Collapse, "{:?}", result.notes);
    let peak = result.load_factor.expect("a peak");
    assert_close(peak, 620.6, 0.003);
    let curve = result.path.curve.expect("a curve");
    let top = curve.iter().map(|p| p[1]).fold(0.0, f64::max);
    assert!(top <= peak * (1.0 + 1e-9));
    let post_peak: Vec<&[f64; 2]> = curve.iter().skip_while(|p| p[1] < top).skip(1).collect();
    assert!(post_peak.len() > 3);
    for pair in post_peak.windows(2) {
        assert!(pair[1][0] > pair[0][0] && pair[1][1] < pair[0][1], "{pair:?}");
    }
    assert!(post_peak[post_peak.len() - 1][1] < 0.98 * peak);
    let mechanism = result.mechanism.expect("a mechanism");
    assert_eq!(mechanism.kind, MechanismKind::FourHinge);
    assert_eq!(mechanism.hinges.iter().map(|hinge| hinge.joint).collect::<Vec<_>>(), [1, 5, 10, 14]);
}

/// Returns the semicircular arch of the benchmark: radii 13 and 16, 19 voussoirs of 2 kN, the one at the crown in two
/// halves. Vertices of the left blocks from the springing to the crown.
fn semicircle() -> Vec<[Vec2; 4]> {
    let at = |radius: f64, k: usize| {
        let angle = std::f64::consts::PI / 19.0 * k as f64;
        if k == 10 { Vec2::new(0.0, radius) } else { Vec2::new(-angle.cos(), angle.sin()) * radius }
    };
    (0..10).map(|k| [at(13.0, k), at(13.0, k + 1), at(16.0, k + 1), at(16.0, k)]).collect()
}

fn area_and_centroid(block: &[Vec2; 4]) -> (f64, Vec2) {
    let (mut area, mut first) = (0.0, Vec2::zeros());
    for i in 0..4 {
        let (a, b) = (block[i], block[(i + 1) % 4]);
        let part = (a.x * b.y - a.y * b.x) / 2.0;
        area += part;
        first += (a + b) * (part / 3.0);
    }
    (area.abs(), first / area)
}

/// Returns the thrust H \[N\] of the rigid three-hinged arch whose right support has moved out by dx, and the position
/// of the reaction on the springing \[m\]. The blocks above joint 3 rotate about its intrados end until the extrados
/// end of the crown is at dx/2. Moments about this hinge give H, moments of the whole half the reaction.
fn spread(dx: f64) -> (f64, f64) {
    let blocks = semicircle();
    let (hinge, crown) = (blocks[3][0], blocks[9][2]);
    let arm = crown - hinge;
    let angle = ((dx / 2.0 - hinge.x) / arm.norm()).acos() - arm.y.atan2(arm.x);
    let turn = |p: Vec2| {
        let a = p - hinge;
        hinge + Vec2::new(angle.cos() * a.x - angle.sin() * a.y, angle.sin() * a.x + angle.cos() * a.y)
    };
    let weight = |k: usize| if k == 9 { 1000.0 } else { 2000.0 };
    let place = |k: usize| {
        let centroid = area_and_centroid(&blocks[k]).1;
        if k < 3 { centroid } else { turn(centroid) }
    };
    let moment: f64 = (3..10).map(|k| weight(k) * (place(k).x - hinge.x)).sum();
    let height = turn(crown).y;
    let thrust = moment / (height - hinge.y);
    let all: f64 = (0..10).map(weight).sum();
    let reaction = ((0..10).map(|k| weight(k) * place(k).x).sum::<f64>() - thrust * height) / all;
    (thrust, reaction)
}

/// Returns the arch of the benchmark as a study with joints of this stiffness \[Pa/m\].
fn spreading(stiffness: f64) -> String {
    let left = semicircle();
    let mirrored = |block: &[Vec2; 4]| [3, 2, 1, 0].map(|i| Vec2::new(-block[i].x, block[i].y));
    let entry = |name: String, block: &[Vec2; 4], more: &str| {
        let vertices: Vec<String> = block.iter().map(|p| format!("[{:?}, {:?}]", p.x, p.y)).collect();
        format!("{{ name = \"{name}\", vertices = [{}]{more} }}", vertices.join(", "))
    };
    let ground =
        |side: f64| [(12.0, 0.0), (12.0, -1.0), (17.0, -1.0), (17.0, 0.0)].map(|(x, y)| Vec2::new(side * x, y));
    let mut blocks = vec![
        entry("left".into(), &ground(-1.0), ", fixed = true"),
        entry("right".into(), &ground(1.0), ", fixed = true"),
    ];
    for (k, block) in left.iter().enumerate() {
        blocks.push(entry(format!("l{k}"), block, if k == 9 { ", material = \"half\"" } else { "" }));
    }
    for (k, block) in left.iter().enumerate().rev() {
        blocks.push(entry(format!("r{k}"), &mirrored(block), if k == 9 { ", material = \"half\"" } else { "" }));
    }
    let density = |block: usize, weight: f64| weight / 9.81 / area_and_centroid(&left[block]).0;
    format!(
        r#"name = "spreading"
[scene]
scene = "blocks"
width = 1.0
material = "whole"
joint = "dry"
blocks = [
{}
]
[scene.mesh]
elements = [1, 2]
[materials.whole]
law = "rigid"
density = {:?}
[materials.half]
law = "rigid"
density = {:?}
[joints.dry]
law = "coulomb"
friction = 0.65
normal_stiffness = {stiffness:?}
shear_stiffness = {stiffness:?}
[[stages]]
name = "weight"
gravity = 9.81
[[stages]]
name = "spread"
until = "collapse"
settlement = [{{ support = "right", displacement = [1.0, 0.0] }}]
[solver]
solver = "newton_path"
kinematics = "finite"
"#,
        blocks.join(",\n"),
        density(0, 2000.0),
        density(9, 1000.0)
    )
}

/// The right support moves out until there is no equilibrium: the closed form has H = 5.767992 kN at dx = 0 and dx =
/// 4.408971 at collapse (the numbers of the benchmark). Stiff joints tend to both as 1/k, and the thrust follows the
/// closed form along the whole path.
#[test]
fn spreading_supports_end_where_three_rigid_hinges_do() {
    assert_close(spread(0.0).0, 5767.992, 1e-7);
    let (mut low, mut high) = (0.0, 8.0);
    for _ in 0..80 {
        let middle = (low + high) / 2.0;
        if spread(middle).1 > -16.0 { low = middle } else { high = middle }
    }
    assert_close(low, 4.408971, 3e-7);
    let mut deficits = Vec::new();
    for stiffness in [1e8, 1e9, 1e10] {
        let (problem, answer, states) = followed(&spreading(stiffness), &settings(None, None));
        assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
        assert!(answer.motion.is_some(), "a collapse has a mechanism");
        deficits.push(low - answer.factor.expect("a spread"));
        if stiffness < 1e10 {
            continue;
        }
        let crown: Vec<usize> =
            (0..problem.contacts.len()).filter(|c| problem.contacts[*c].position.x.abs() < 1e-9).collect();
        let mut compared = 0;
        for state in states.iter().filter(|s| s.load_step == 1 && s.factor > 0.02) {
            let thrust: f64 = crown.iter().map(|c| state.force[*c][0]).sum();
            assert_close(thrust, spread(state.factor).0, 1e-3);
            compared += 1;
        }
        assert!(compared > 20);
    }
    for pair in deficits.windows(2) {
        assert!((pair[0] / pair[1] - 10.0).abs() < 0.05, "{deficits:?}");
    }
    // Extrapolated to rigid joints.
    assert!((deficits[2] - (deficits[1] - deficits[2]) / 9.0).abs() < 1e-6, "{deficits:?}");
}

/// Blocks that the ground holds rotate exactly with their support: both supports rotate by 0.1 about the middle of the
/// left springing as one rigid body.
#[test]
fn blocks_of_a_turned_support_turn_with_it() {
    let angle: f64 = 0.1;
    let text = |right: Vec2| {
        format!(
            r#"name = "turned"
[scene]
scene = "arch"
profile = {{ shape = "segmental", span = 3.0, rise = 1.2 }}
thickness = 0.8
width = 1.0
voussoirs = 5
ends = "bonded"
material = "stone"
joint = "dry"
[materials.stone]
law = "rigid"
density = 2000.0
[joints.dry]
law = "coulomb"
friction = 0.7
normal_stiffness = 1e7
shear_stiffness = 1e7
[solver]
solver = "newton_path"
kinematics = "finite"
[[stages]]
name = "dead"
gravity = 9.81
[[stages]]
name = "turn"
settlement = [
  {{ support = "left", displacement = [0.0, 0.0], rotation = {angle:?} }},
  {{ support = "right", displacement = [{:?}, {:?}], rotation = {angle:?} }},
]
"#,
            right.x, right.y
        )
    };
    let turn = |a: Vec2| Vec2::new(angle.cos() * a.x - angle.sin() * a.y, angle.sin() * a.x + angle.cos() * a.y) - a;
    let joints = first_case(&text(Vec2::zeros())).assembly.joints;
    let (from, to) = (joints[0].middle(), joints[joints.len() - 1].middle());
    let study = text(turn(to - from));
    let result = answered(&study);
    assert_eq!(result.status, Status::Stands, "{:?}", result.notes);
    let assembly = first_case(&study).assembly;
    let displacements = result.path.displacements.expect("displacements");
    for block in [1, 5] {
        let place = assembly.inertia(block).centroid;
        let [x, y, theta] = displacements[block].displacement;
        let exact = turn(place - from);
        let off = (Vec2::new(x, y) - exact).norm() + (theta - angle).abs();
        assert!(off < 1e-12, "block {block}: {x} {y} {theta}, exactly {exact:?}");
    }
}

/// An elastic block that is pushed over a rough floor slides at μ times its weight, to rounding, and both limit points are that load:
/// it moves on under a constant load.
#[test]
fn an_elastic_block_slides_at_its_friction() {
    for friction in [0.1, 0.3, 0.45] {
        let text = format!(
            r#"name = "block"
[scene]
scene = "blocks"
material = "stone"
joint = "dry"
width = 1.0
mesh = {{ elements = [1, 1], order = 2 }}
blocks = [
 {{ name = "ground", vertices = [[-2.0, -0.3], [3.0, -0.3], [3.0, 0.0], [-2.0, 0.0]], fixed = true }},
 {{ name = "a", vertices = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.5], [0.0, 0.5]] }},
]
[materials.stone]
law = "elastic"
young_modulus = 5e9
poisson_ratio = 0.2
density = 2000.0
[joints.dry]
law = "coulomb"
friction = {friction}
[[stages]]
name = "dead"
gravity = 9.81
[[stages]]
name = "live"
until = "collapse"
loads = [{{ kind = "body", acceleration = [9.81, 0.0] }}]
[solver]
solver = "newton_path"
kinematics = "finite"
"#
        );
        let result = answered(&text);
        assert_eq!(result.status, Status::Collapse, "{:?}", result.notes);
        assert_close(result.load_factor.expect("a load"), friction, 1e-12);
        assert_close(result.path.first_limit_point.expect("a limit point"), friction, 1e-12);
    }
}
