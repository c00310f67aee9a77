//! Blocks whose material yields, in `newton_path`: closed forms, the one-point driver, elastic blocks as the limit of
//! strong ones, energies, and changes that must not matter.

use std::sync::Arc;
use voussoir::core::limit::Status;
use voussoir::core::path::{Continuation, PathAnswer, PathProblem, PathSettings, PathSolver, PathState, Unobserved};
use voussoir::solvers::path::continuation::{
    arc_length::ArcLength, displacement_control::DisplacementControl, dissipation::Dissipation,
    load_control::LoadControl,
};
use voussoir::solvers::path::newton::NewtonPath;
use voussoir::solvers::point::{Control, DrivenPoint, PointLaw};
use voussoir_tests::seen::Seen;
use voussoir_tests::{Arch, answered, assert_close, changed, elastic, first_case, small_displacements};

/// Returns the stone of the paper with p_b = 10 MPa, E = 5 GPa, ν = 0.2; `hardening` is TOML.
fn stone(hardening: &str) -> String {
    format!(
        "law = \"drucker_prager_cap\"\nyoung_modulus = 5e9\npoisson_ratio = 0.2\ndensity = 2200.0\n\
         cap_friction_angle = 70.0\ncap_cohesion = 1e9\ncap_eccentricity = 0.005\ntransition = 0.03\n\
         hardening = {hardening}"
    )
}

/// Push on the plate at factor 1 [N].
const LOAD: f64 = 1e6;

/// Blocks on the ground under a rigid plate that is pushed down. `blocks` are (name, material, from height, to height),
/// all with the width `width` [m], rotated by `angle` about the origin and scaled by `scale`.
struct Press {
    blocks: Vec<(&'static str, &'static str, f64, f64)>,
    materials: Vec<(&'static str, String)>,
    width: f64,
    elements: [usize; 2],
    order: usize,
    plane: &'static str,
    sides: bool,
    guided: bool,
    stages: String,
    angle: f64,
    scale: f64,
}

impl Press {
    fn new(material: String, stages: &str) -> Self {
        Press {
            blocks: vec![("a", "stone", 0.0, 0.1)],
            materials: vec![("stone", material)],
            width: 0.1,
            elements: [2, 2],
            order: 2,
            plane: "strain",
            sides: false,
            guided: false,
            stages: stages.into(),
            angle: 0.0,
            scale: 1.0,
        }
    }

    fn top(&self) -> f64 {
        self.blocks.iter().fold(0.0, |top, b| f64::max(top, b.3))
    }

    fn point(&self, x: f64, y: f64) -> String {
        let (sine, cosine) = self.angle.sin_cos();
        format!("[{:?}, {:?}]", self.scale * (cosine * x - sine * y), self.scale * (sine * x + cosine * y))
    }

    fn vertices(&self, [left, right]: [f64; 2], [low, high]: [f64; 2]) -> String {
        let all = [(left, low), (right, low), (right, high), (left, high)].map(|(x, y)| self.point(x, y));
        format!("[{}]", all.join(", "))
    }

    fn study(&self) -> String {
        let (w, top) = (self.width, self.top());
        let block = |name: &str, x: [f64; 2], y: [f64; 2], more: &str| {
            format!("  {{ name = \"{name}\", vertices = {}{more} }},\n", self.vertices(x, y))
        };
        let rigid = ", material = \"rigid\"";
        let fixed = ", material = \"rigid\", fixed = true";
        let mut blocks = block("ground", [-w, 2.0 * w], [-0.1, 0.0], fixed);
        for (name, material, low, high) in &self.blocks {
            blocks += &block(name, [0.0, w], [*low, *high], &format!(", material = \"{material}\""));
        }
        blocks += &block("plate", [0.0, w], [top, top + 0.1], rigid);
        if self.sides {
            blocks += &block("left", [-0.1, 0.0], [0.0, top], fixed);
            blocks += &block("right", [w, w + 0.1], [0.0, top], fixed);
        }
        if self.guided {
            blocks += &block("left guide", [-0.1, 0.0], [top, top + 0.1], fixed);
            blocks += &block("right guide", [w, w + 0.1], [top, top + 0.1], fixed);
        }
        let mut materials = String::from("[materials.rigid]\nlaw = \"rigid\"\ndensity = 1.0\n");
        for (name, text) in &self.materials {
            materials += &format!("[materials.{name}]\n{text}\n");
        }
        let (sine, cosine) = self.angle.sin_cos();
        // Times the scale², so that stresses are equal.
        let force = LOAD * self.scale * self.scale;
        let push = format!(
            "{{ kind = \"point\", block = \"plate\", point = {}, force = [{:?}, {:?}] }}",
            self.point(w / 2.0, top + 0.1),
            sine * force,
            -cosine * force
        );
        format!(
            "name = \"press\"\n[scene]\nscene = \"blocks\"\nwidth = {:?}\nplane = \"{}\"\nmaterial = \"rigid\"\njoint = \
             \"smooth\"\nblocks = [\n{blocks}]\n[scene.mesh]\nelements = {:?}\norder = {}\n{materials}[joints.smooth]\nlaw = \
             \"unilateral\"\ntangential = \"free\"\n{}",
            self.scale,
            self.plane,
            self.elements,
            self.order,
            changed(&self.stages, "PUSH", &push)
        )
    }
}

fn stages(factors: &[f64]) -> String {
    let stage =
        |(i, factor): (usize, &f64)| format!("[[stages]]\nname = \"s{i}\"\nfactor = {factor:?}\nloads = [PUSH]\n");
    factors.iter().enumerate().map(stage).collect()
}

const COLLAPSE: &str = "[[stages]]\nname = \"live\"\nuntil = \"collapse\"\nloads = [PUSH]\n";

fn settings(continuation: Option<Arc<dyn Continuation>>) -> PathSettings {
    PathSettings { continuation, ..small_displacements() }
}

fn traced(text: &str, settings: &PathSettings) -> (PathProblem, PathAnswer, Seen) {
    let case = first_case(text);
    let problem = PathProblem::new(&case.assembly, &case.stages).expect("a path problem");
    let mut seen = Seen::default();
    let answer = NewtonPath {}.trace(&problem, settings, &mut seen);
    (problem, answer, seen)
}

/// Returns the downward displacement of the plate [m], in the axes of the press.
fn sunk(problem: &PathProblem, state: &PathState, press: &Press) -> f64 {
    let block = press.blocks.len() + 1;
    let [x, y, _] = state.motion[problem.body_of[block]];
    let (sine, cosine) = press.angle.sin_cos();
    sine * x - cosine * y
}

/// A block between smooth plates begins to yield in plane strain at 24.99635444 MPa for ν = 0.2, in plane stress at
/// 29.99250136 MPa (BENCHMARKS: closed form derived from the equations of the cap), for every order of element. In
/// plane strain it does not flow there: σ_zz becomes tensile, and the cap yields at increasing axial stress.
#[test]
fn a_pressed_block_begins_to_yield_at_the_closed_form() {
    for (order, (plane, strength)) in
        [1, 2, 3].iter().flat_map(|o| [("strain", 24.99635444e6), ("stress", 29.99250136e6)].map(|p| (*o, p)))
    {
        for (share, yields) in [(1.0 - 1e-8, false), (1.0 + 1e-8, true)] {
            let factor = strength * 0.1 / LOAD * share;
            let hardening = "[[0.0, 10e6], [0.02, 30e6]]";
            let press = Press { order, plane, ..Press::new(stone(hardening), &stages(&[factor])) };
            let (_, answer, seen) = traced(&press.study(), &settings(None));
            assert_eq!(answer.status, Status::Stands, "{:?}", answer.notes);
            assert_eq!(answer.state.yielded.iter().any(Option::is_some), yields, "{plane}, order {order}, {share}");
            seen.is_certified();
        }
    }
}

/// Stress and strain of the path equal those of one driven point: hardening with a free and a held side face, unloading
/// and reloading, plane strain.
#[test]
fn a_pressed_block_follows_one_point() {
    let hardening = "[[0.0, 10e6], [0.002, 12e6], [0.02, 20e6]]";
    let law = || {
        let case = first_case(&Press::new(stone(hardening), COLLAPSE).study());
        let all = &case.assembly.catalogue.materials;
        let stone = &all.iter().find(|(name, _)| name == "stone").expect("the stone").1;
        stone.stress_update().expect("it yields")
    };
    for (sides, factors) in [(false, vec![3.1, -2.0, 2.2]), (true, vec![2.5, -0.6, 0.8])] {
        let press = Press { sides, ..Press::new(stone(hardening), &stages(&factors)) };
        let (problem, answer, seen) = traced(&press.study(), &settings(None));
        assert_eq!(answer.status, Status::Stands, "{:?}", answer.notes);
        assert!(seen.states.len() > 10 * factors.len().min(2), "{} states", seen.states.len());
        seen.is_certified();
        let mut point = DrivenPoint::new(PointLaw::Space(law(), 1.0)).expect("a point");
        let (held, free) = (Control::Strain(0.0), Control::Stress(0.0));
        let across = if sides { held } else { free };
        let mut yields = 0;
        for state in &seen.states {
            let applied: f64 = problem.applied(state.load_step, state.factor).iter().sum();
            let strain = -sunk(&problem, state, &press) / 0.1;
            point.step(&[across, Control::Strain(strain), held, held, held, held]).expect("a step");
            let (found, wanted) = (-applied * LOAD / press.width, point.response.stress[1]);
            // If three blocks meet, the joint has an additional compliance of 1e-5 of that of the block.
            let bedding = if sides { 1e-4 * wanted.abs() } else { 0.0 };
            assert!((found - wanted).abs() < 1e-8 * 3e7 + bedding, "{found} instead of {wanted}");
            yields += usize::from(point.response.region == "cap");
        }
        assert!(yields > 5, "{yields}");
    }
}

/// Two blocks of different materials, one above the other, pass the patch test: every Gauss point has the same stress. The points that
/// yield are counted in the same way with and without a linearisation.
#[test]
fn two_yielding_blocks_pass_the_patch_test() {
    let mut press = Press::new(stone("[[0.0, 10e6], [0.02, 30e6]]"), &stages(&[3.0]));
    press.blocks = vec![("a", "stone", 0.0, 0.1), ("b", "soft", 0.1, 0.27)];
    press.materials.push(("soft", changed(&stone("[[0.0, 9e6], [0.02, 28e6]]"), "5e9", "3e9")));
    press.elements = [3, 2];
    let (problem, answer, seen) = traced(&press.study(), &settings(None));
    assert_eq!(answer.status, Status::Stands, "{:?}", answer.notes);
    seen.is_certified();
    for body in problem.bodies.iter().filter(|body| body.inelastic.is_some()) {
        let index = problem.body_of[body.members[0]];
        let (own, inelastic) =
            (answer.state.inelastic(index).expect("it yields"), body.inelastic.as_ref().expect("it"));
        let found = inelastic.recover(&own.displacement, &own.state).expect("stresses");
        // From the undeformed state all points yield; points are counted as for a linearisation, which factorises one matrix.
        let start = inelastic.initial();
        let linear = inelastic.linearise(own.displacement.to_vec(), &start).expect("a tangent");
        assert_eq!(linear.factorisations, 1);
        assert_eq!(linear.yielding, inelastic.gauss_points());
        assert_eq!(inelastic.yielding(&own.displacement, &start).expect("stresses"), linear.yielding);
        let barely: Vec<f64> = own.displacement.iter().map(|v| 1e-3 * v).collect();
        assert_eq!(inelastic.yielding(&barely, &start).expect("stresses"), 0);
        for stress in found.stress.iter().chain(&found.element_stress) {
            assert!(stress[0].abs() < 30.0 && stress[3].abs() < 30.0, "{stress:?}");
            assert!((stress[1] + 3.0e7).abs() < 30.0, "{stress:?}");
        }
    }
}

/// A block that is too strong to yield is the same as an elastic block: same status and factor, and no tangent is
/// factorised, with small and finite displacements. Forces of single points depend on the instant of sliding, which
/// pieces find exactly and steps do not.
#[test]
fn strong_blocks_are_elastic() {
    for finite in [false, true] {
        let strong = changed(&stone("[[0.0, 1e13]]"), "density = 2200.0\n", "");
        let strong = changed(&strong, "1e9\ncap_ecc", "1e15\ncap_ecc");
        let of = |material: String| {
            let case = first_case(&Arch { voussoirs: 9, material, ..Arch::default() }.study());
            let problem = PathProblem::new(&case.assembly, &case.stages).expect("a path problem");
            let own = PathSettings { finite, stop_displacement: Some(0.0), ..settings(None) };
            NewtonPath {}.trace(&problem, &own, &mut Unobserved)
        };
        let (a, b) = (of(elastic(5e9, 0.2)), of(strong));
        assert_eq!(a.status, b.status, "{:?} {:?}", a.notes, b.notes);
        let tolerance = if finite { 1e-6 } else { 1e-10 };
        assert_close(a.factor.expect("a factor"), b.factor.expect("a factor"), tolerance);
        assert_eq!(b.counters.get("block_factorisations").copied().unwrap_or(0), 0);
        assert!(b.counters["stress_updates"] > 0);
        assert!(b.state.yielded.iter().all(Option::is_none));
    }
}

/// The energy of a stage balances for any requested step, because steps are shortened until it does.
#[test]
fn energy_balances_whatever_the_steps() {
    let press =
        Press::new(stone("[[0.0, 10e6], [0.02, 30e6]]"), &changed(COLLAPSE, "until = \"collapse\"", "factor = 4.0"));
    let error = |first_step: f64| {
        let strategy = ArcLength { first_step, largest_step: Some(first_step * 1e-3), ..ArcLength::default() };
        let (_, answer, seen) = traced(&press.study(), &settings(Some(Arc::new(strategy))));
        assert_eq!(answer.status, Status::Stands, "{:?}", answer.notes);
        let end = &answer.state;
        assert!(end.dissipated > 0.1 * end.work, "{} of {}", end.dissipated, end.work);
        (seen.states.len(), (end.work - end.stored - end.dissipated).abs() / end.work)
    };
    let all = [0.1, 0.05, 0.025].map(error);
    assert!(all.iter().all(|(_, error)| *error < 2e-3), "{all:?}");
}

/// Rotated by any angle, or in a scene a thousand times as large, the block crushes in the same way.
#[test]
fn rotation_and_size_do_not_matter() {
    let of = |angle: f64, scale: f64| {
        let press = Press { angle, scale, ..Press::new(stone("[[0.0, 10e6], [0.02, 30e6]]"), &stages(&[4.0])) };
        let (problem, answer, seen) = traced(&press.study(), &settings(None));
        assert_eq!(answer.status, Status::Stands, "{:?}", answer.notes);
        seen.is_certified();
        (sunk(&problem, &answer.state, &press) / scale, answer.state.dissipated / scale.powi(3))
    };
    let (sunk, dissipated) = of(0.0, 1.0);
    for (angle, scale) in [(0.7, 1.0), (2.5, 1.0), (0.0, 1e3), (-1.2, 1e-3)] {
        let found = of(angle, scale);
        assert_close(found.0, sunk, 1e-9);
        assert_close(found.1, dissipated, 1e-7);
    }
}

/// A column of one block, and of three, of perfectly plastic stone crushed over its whole section: the load is that of
/// the closed form (29.99250136 MPa) and is constant while the column shortens, the plastic work is load × inelastic
/// shortening, and load control ends at a limit point with this load.
#[test]
fn a_column_crushed_through_is_followed() {
    let strength = 29.99250136e6;
    let followed: [Arc<dyn Continuation>; 2] =
        [Arc::new(ArcLength::default()), Arc::new(DisplacementControl::default())];
    for (blocks, order) in [(1, 1), (1, 2), (3, 1)] {
        let mut press = Press { order, plane: "stress", ..Press::new(stone("[[0.0, 10e6]]"), COLLAPSE) };
        if blocks == 3 {
            press.blocks = vec![("a", "stone", 0.0, 0.1), ("b", "stone", 0.1, 0.25), ("c", "stone", 0.25, 0.33)];
        }
        let (height, carried) = (press.top(), strength * 0.1 / LOAD);
        for strategy in &followed {
            let (problem, answer, seen) = traced(&press.study(), &settings(Some(strategy.clone())));
            println!("{blocks} of order {order}, {strategy:?}: {:?}", answer.counters);
            assert_eq!(answer.status, Status::Collapse, "{strategy:?}: {:?}", answer.notes);
            assert_close(answer.factor.expect("a factor"), carried, 1e-8);
            seen.is_certified();
            let elastic = strength / 5e9 * height;
            let last = answer.last.expect("the path goes on");
            let shortening = sunk(&problem, &last, &press);
            assert!(shortening > 1.9 * elastic, "{strategy:?}: {shortening} m");
            assert_close(last.factor, carried, 1e-8);
            assert_close(last.dissipated, carried * LOAD * (shortening - elastic), 1e-6);
        }
        let load: Arc<dyn Continuation> = Arc::new(LoadControl::default());
        let (_, answer, seen) = traced(&press.study(), &settings(Some(load)));
        assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
        assert_close(answer.factor.expect("a factor"), carried, 1e-8);
        seen.is_certified();
    }
}

/// A bar of 1.2 m in plane stress, one element wide, with one layer of elements that softens with this fracture energy
/// \[J/m²\], and the factor at which it softens.
fn softening_bar(energy: f64, layer: f64, width: f64) -> (Press, f64) {
    let softening = format!(
        "law = \"drucker_prager_softening\"\nyoung_modulus = 5e9\npoisson_ratio = 0.2\ndensity = 2200.0\n\
         pressure_coefficient = 0.2\nyield_stress = 8e6\ncrushing_fracture_energy = {energy:?}"
    );
    let mut press = Press::new(softening, COLLAPSE);
    press
        .materials
        .push(("sound", "law = \"elastic\"\nyoung_modulus = 5e9\npoisson_ratio = 0.2\ndensity = 2200.0".into()));
    press.blocks = vec![("weak", "stone", 0.0, layer), ("rest", "sound", layer, 1.2)];
    // A plate that can rotate, and rows of Gauss points of order 2, bifurcate from the uniform solution.
    (press.width, press.elements, press.guided, press.order) = (width, [1, 1], true, 1);
    press.plane = "stress";
    // R / (1 − A) = 10 MPa.
    (press, 10e6 * width / LOAD)
}

/// A softening bar does not depend on the mesh: one layer of elements of 10, 5 or 2.5 cm softens, the load over the
/// shortening through snap-back is the same, and the dissipated energy is that of the softening law. Arc length and
/// dissipation control, down to a quarter of the strength; steps do not converge far below it.
#[test]
fn a_softening_bar_does_not_depend_on_the_mesh() {
    let energy = 6e3;
    let largest_step = Some(2e-6);
    let strategies: [Arc<dyn Continuation>; 2] = [
        Arc::new(ArcLength { largest_step, ..ArcLength::default() }),
        Arc::new(Dissipation { largest_step, ..Dissipation::default() }),
    ];
    let (mut curves, mut energies): (Vec<Vec<[f64; 2]>>, Vec<f64>) = (Vec::new(), Vec::new());
    for (refinement, strategy) in [1, 2, 4].iter().flat_map(|n| strategies.iter().map(move |s| (*n, s.clone()))) {
        let layer = 0.1 / refinement as f64;
        let (press, strength) = softening_bar(energy, layer, layer);
        let own = PathSettings { stop_factor: Some(0.25 * strength), ..settings(Some(strategy)) };
        let (problem, answer, seen) = traced(&press.study(), &own);
        assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
        assert_close(answer.factor.expect("a peak"), strength, 1e-6);
        seen.is_certified();
        let last = answer.last.expect("the path goes on");
        let share = last.factor / strength;
        assert!(share < 0.26, "{share}");
        // Linear softening: the work of opening down to the share λ of the strength is G (1 − λ²) times the area.
        let wanted = energy * layer * (1.0 - share * share);
        let lost = last.work - last.stored;
        assert_close(lost, wanted, 0.01);
        // σ·Δε^p with σ at the end of the step is less, but tends to it with smaller steps.
        assert!(last.dissipated < lost && last.dissipated > 0.9 * lost, "{} of {lost} J", last.dissipated);
        energies.push(lost / wanted);
        let curve: Vec<[f64; 2]> =
            seen.states.iter().map(|s| [sunk(&problem, s, &press), s.factor / strength]).collect();
        let shortest = curve.windows(2).any(|p| p[1][0] < p[0][0] && p[1][1] < p[0][1]);
        assert!(shortest, "it snaps back");
        curves.push(curve);
    }
    // Shortening at given loads of the falling branch, against the first curve.
    let at = |curve: &Vec<[f64; 2]>, factor: f64| {
        let peak = curve.iter().enumerate().max_by(|a, b| a.1[1].total_cmp(&b.1[1])).expect("states").0;
        let pair = curve[peak..].windows(2).find(|p| p[1][1] <= factor).expect("the load falls");
        let t = (factor - pair[0][1]) / (pair[1][1] - pair[0][1]);
        pair[0][0] + t * (pair[1][0] - pair[0][0])
    };
    for (one, other) in energies.iter().zip(&energies[1..]) {
        assert_close(*other, *one, 0.01);
    }
    for curve in &curves[1..] {
        for factor in [0.9, 0.7, 0.5, 0.3] {
            assert_close(at(curve, factor), at(&curves[0], factor), 0.01);
        }
    }
}

/// A layer of elements twice as long as wide, or half as long, across the band: its energy is that of the law times h∥
/// / √A = √2 or 1/√2, the error of the characteristic length √A.
#[test]
fn the_band_is_as_wide_as_its_element_is_long() {
    let (energy, layer) = (6e3, 0.05);
    for aspect in [0.5, 1.0, 2.0] {
        let (press, strength) = softening_bar(energy, layer, layer / aspect);
        let strategy: Arc<dyn Continuation> = Arc::new(ArcLength { largest_step: Some(2e-6), ..ArcLength::default() });
        let own = PathSettings { stop_factor: Some(0.5 * strength), ..settings(Some(strategy)) };
        let (_, answer, _) = traced(&press.study(), &own);
        assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
        let last = answer.last.expect("the path goes on");
        let share = last.factor / strength;
        let wanted = energy * press.width * (1.0 - share * share) * f64::sqrt(aspect);
        assert_close(last.work - last.stored, wanted, 0.01);
    }
}

/// Elements that are too large for the fracture energy are a mistake of the study file that names the sizes and the
/// key.
#[test]
fn elements_too_large_to_soften_are_refused() {
    let softening = "law = \"drucker_prager_softening\"\nyoung_modulus = 5e9\npoisson_ratio = 0.2\ndensity = 2200.0\n\
                     pressure_coefficient = 0.2\nyield_stress = 8e6\ncrushing_fracture_energy = 100.0";
    let text = Press::new(softening.into(), COLLAPSE).study();
    let Err(mistakes) = voussoir::study::load(&text, "bar.toml", &[]) else { panic!("it must be refused") };
    let all: Vec<String> = mistakes.mistakes().iter().map(ToString::to_string).collect();
    assert!(all.len() == 1 && all[0].contains("elements") && all[0].contains("fracture energy"), "{all:?}");
}

/// Limit analysis treats such blocks as rigid and reports it; `event_path` is refused and names `newton_path`; `auto`
/// chooses `newton_path`; `verify` confirms results of a path with crushed blocks and finds a changed plastic strain.
#[test]
fn solvers_say_what_they_can() {
    let press = Press::new(stone("[[0.0, 10e6], [0.02, 30e6]]"), &stages(&[3.0]));
    let with = |solver: &str| format!("{}[solver]\nsolver = \"{solver}\"\n", press.study());
    let Err(mistakes) = voussoir::study::load(&with("event_path"), "press.toml", &[]) else { panic!("refused") };
    assert!(mistakes.mistakes().iter().any(|m| m.to_string().contains("newton_path")), "{mistakes:?}");
    let limit = answered(&with("limit_conic"));
    assert!(limit.notes.iter().any(|note| note.contains("their yielding")), "{:?}", limit.notes);
    let study = voussoir_tests::study(&press.study());
    let result = voussoir::solve_case(&study.cases[0]);
    assert_eq!((result.solver.as_str(), result.status), ("newton_path", Status::Stands), "{:?}", result.notes);
    let mut results = study.results("", vec![result]);
    assert!(!results.cases[0].path.yielded.is_empty());
    assert_eq!(voussoir::verify::verify(&study, &results), vec![]);
    results.cases[0].path.yielded[0].points[0].3[1] *= 1.001;
    assert!(!voussoir::verify::verify(&study, &results).is_empty());
}
