//! Cohesive joints along a path against closed forms, an integration along the joint and limit analysis.

use voussoir::core::limit::Status;
use voussoir::core::path::{PathAnswer, PathObserver, PathProblem, PathSettings, PathSolver, PathState};
use voussoir::solvers::path::newton::NewtonPath;
use voussoir_tests::{assert_close, first_case};

/// Every state of a path.
#[derive(Default)]
struct States(Vec<PathState>);

impl PathObserver for States {
    fn state(&mut self, _problem: &PathProblem, state: &PathState) -> bool {
        self.0.push(state.clone());
        true
    }
}

fn settings() -> PathSettings {
    PathSettings { finite: false, tolerance: 1e-9, stop_displacement: None, stop_factor: None, continuation: None }
}

fn traced(text: &str, settings: &PathSettings) -> (PathProblem, PathAnswer, Vec<PathState>) {
    let case = first_case(text);
    let problem = PathProblem::new(&case.assembly, &case.stages).expect("a path problem");
    let mut states = States::default();
    let answer = NewtonPath {}.trace(&problem, settings, &mut states);
    (problem, answer, states.0)
}

/// Two elastic blocks of 0.2 × 0.1 m and length L/2 each, the left one bonded to the ground, with one
/// cohesive joint between them, pulled along x by a pressure of 1 Pa on the end: f_t 0.2 MPa, G_I 20 J/m².
fn bar(length: f64, young_modulus: f64) -> String {
    let half = length / 2.0;
    format!(
        r#"name = "bar"
[scene]
scene = "blocks"
width = 0.1
plane = "stress"
material = "stone"
joint = "mortar"
pairs = [{{ between = ["ground", "a"], joint = "glue" }}]
blocks = [
  {{ name = "ground", vertices = [[-0.1, 0.0], [0.0, 0.0], [0.0, 0.2], [-0.1, 0.2]], fixed = true }},
  {{ name = "a", vertices = [[0.0, 0.0], [{half:?}, 0.0], [{half:?}, 0.2], [0.0, 0.2]] }},
  {{ name = "b", vertices = [[{half:?}, 0.0], [{length:?}, 0.0], [{length:?}, 0.2], [{half:?}, 0.2]] }},
]
[scene.mesh]
elements = [2, 2]
order = 2
[materials.stone]
law = "elastic"
young_modulus = {young_modulus:?}
poisson_ratio = 0.0
density = 2000.0
[joints.glue]
law = "mohr_coulomb"
friction = 0.6
cohesion = 1e9
tensile_strength = 1e9
[joints.mortar]
law = "cohesive"
friction = 0.6
tensile_strength = 0.2e6
cohesion = 0.3e6
normal_stiffness = 1e11
shear_stiffness = 4e10
tensile_fracture_energy = 20.0
shear_fracture_energy = 60.0
[solver]
solver = "newton_path"
[[stages]]
name = "pull"
until = "collapse"
loads = [{{ kind = "pressure", block = "b", edge = 1, value = -1e3 }}]
"#
    )
}

#[test]
fn a_bar_in_tension() {
    for (length, modulus) in [(1.0, 5e9), (8.0, 5e9)] {
        let mut settings = settings();
        settings.stop_factor = Some(-1.0);
        let (_, answer, states) = traced(&bar(length, modulus), &settings);
        println!("{:?} {:?} {:?} {:?}", answer.status, answer.factor, answer.notes, answer.counters);
        for s in &states {
            println!(
                "{:.9} {:.6e} {:.9e} {:.3e} gap {:?}",
                s.factor,
                s.displacement,
                s.dissipated,
                s.work - s.stored - s.dissipated,
                s.gap.last()
            );
        }
    }
}
