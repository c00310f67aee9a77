//! Each class of residual detects a violation: in a run with a dishonest solver, and in the verification of results.

use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::sync::Arc;
use voussoir::core::certificate::{
    PathChecker, flow_residual, leaves_forces, power_residual, ray_residual, settlement_residuals, tolerance,
};
use voussoir::core::law::FlowRule;
use voussoir::core::limit::{
    JointForce, LimitAnswer, LimitProblem, LimitQuestion, LimitSolver, SettlementAnswer, Status, Velocity,
};
use voussoir::core::model::Wrenches;
use voussoir::core::model::geometry::Vec2;
use voussoir::core::path::{PathObserver, PathProblem, PathSolver, PathState, Yielded};
use voussoir::results::CaseResult;
use voussoir::solve_case;
use voussoir::solvers::path::event::EventPath;
use voussoir::solvers::path::newton::NewtonPath;
use voussoir::study::{Case, SelectedSolver};
use voussoir::verify::case::verify_case;
use voussoir_tests::{
    Arch, answered, as_blocks, changed, compliant, crushing, elastic, first_case, small_displacements,
};

type Lie = fn(&mut LimitAnswer);
type FollowLie = fn(&dyn LimitSolver, &LimitProblem, &mut Vec<JointForce>, &mut [Velocity]);

/// Makes a state wrong.
type Violation<'v> = &'v dyn Fn(&mut PathState);

/// A solver that gives the answers of another one with one lie.
#[derive(Debug, Default, Serialize, Deserialize)]
struct Lying {
    #[serde(skip)]
    honest: Option<Arc<dyn LimitSolver>>,
    #[serde(skip)]
    lie: Option<Lie>,
    #[serde(skip)]
    follow: Option<FollowLie>,
}

impl Lying {
    fn honest(&self) -> &dyn LimitSolver {
        self.honest.as_deref().expect("a solver")
    }
}

#[typetag::serde(name = "lying")]
impl LimitSolver for Lying {
    fn solve(&self, problem: &LimitProblem, question: LimitQuestion) -> LimitAnswer {
        let mut answer = self.honest().solve(problem, question);
        // Lies concern the answer for the stage, not the state at its start.
        if let (Some(lie), LimitQuestion::Collapse { .. }) = (self.lie, question) {
            lie(&mut answer);
        }
        answer
    }

    fn refuses(&self, problem: &LimitProblem) -> Option<String> {
        self.honest().refuses(problem)
    }

    fn settle(&self, problem: &LimitProblem, loads: &Wrenches, openings: &[[f64; 3]]) -> SettlementAnswer {
        let mut answer = self.honest().settle(problem, loads, openings);
        if let (SettlementAnswer::Follows { field, motion, .. }, Some(lie)) = (&mut answer, self.follow) {
            lie(self.honest(), problem, field, motion);
        }
        answer
    }
}

/// Returns the messages for a lie of the solver named in a study.
fn said_of_a_lie(text: &str, lie: Option<Lie>, follow: Option<FollowLie>) -> String {
    let mut case = first_case(text);
    let honest = solve_case(&case);
    assert!(honest.certificate.passed, "{:?}", honest.certificate);
    let SelectedSolver::Limit(tag, solver) = &case.solver.solver else { panic!("the study names a limit solver") };
    let lying = Lying { honest: Some(solver.clone()), lie, follow };
    case.solver.solver = SelectedSolver::Limit(tag.clone(), Arc::new(lying));
    let result = solve_case(&case);
    assert!(!result.status.is_answer() && !result.certificate.passed, "{:?} {:?}", result.status, result.notes);
    [result.notes, result.certificate.failures].concat().join("\n")
}

fn arch() -> Arch {
    Arch { voussoirs: 7, ends: "jointed", solver: "limit_conic", ..Arch::default() }
}

/// No equilibrium under dead load, but above a certain factor.
const PUSHED_BACK: &str = "name = \"cube\"\n[scene]\nscene = \"blocks\"\nwidth = 1.0\nmaterial = \"stone\"\njoint = \"dry\"\n\
    blocks = [\n{ name = \"ground\", vertices = [[-1.0, -1.0], [2.0, -1.0], [2.0, 0.0], [-1.0, 0.0]], fixed = true },\n\
    { name = \"a\", vertices = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] },\n]\n[materials.stone]\nlaw = \"rigid\"\n\
    density = 1000.0\n[joints.dry]\nlaw = \"coulomb_associated\"\nfriction = 0.6\n[[stages]]\nname = \"dead\"\n\
    gravity = [8.0, -10.0]\n[[stages]]\nname = \"push\"\nuntil = \"collapse\"\nloads = [{ kind = \"point\", block = \"a\", \
    point = [1.0, 0.0], force = [-1000.0, 0.0] }]\n[solver]\nsolver = \"limit_conic\"\n";

fn field(answer: &mut LimitAnswer) -> &mut Vec<JointForce> {
    answer.field.as_mut().expect("a field")
}

fn motion(answer: &mut LimitAnswer) -> &mut Vec<Velocity> {
    answer.motion.as_mut().expect("a motion")
}

fn scale(motion: &mut [Velocity], by: f64) {
    motion.iter_mut().flatten().for_each(|v| *v *= by);
}

/// Returns a cube with non-associated friction, pushed sideways.
fn slides() -> String {
    let text = changed(PUSHED_BACK, "[8.0, -10.0]", "10.0");
    let text = changed(&text, "law = \"coulomb_associated\"", "law = \"coulomb\"");
    changed(&text, "\"limit_conic\"", "\"limit_least\"")
}

fn bridge() -> String {
    "name = \"bridge\"\n[scene]\nscene = \"bridge\"\nwidth = 3.0\nmaterial = \"stone\"\njoint = \"dry\"\n\
     spans = [{ profile = { shape = \"segmental\", span = 3.0, rise = 0.75 }, thickness = 0.25, voussoirs = 9 }]\n\
     [scene.fill]\ncover = 0.3\ndensity = 1800.0\nfriction_angle = 30.0\nresistance = { law = \"fill_pressure\" }\n\
     [materials.stone]\nlaw = \"rigid\"\ndensity = 2200.0\n[joints.dry]\nlaw = \"coulomb_associated\"\nfriction = 0.6\n\
     [[stages]]\nname = \"dead\"\ngravity = 9.81\n[[stages]]\nname = \"live\"\nuntil = \"collapse\"\n\
     loads = [{ kind = \"vehicle\", vehicle = \"cs454_single\", at = 0.8 }]\n[solver]\nsolver = \"limit_conic\"\n"
        .into()
}

/// `run` detects each lie of a dishonest limit solver by its class of residual.
#[test]
fn run_refuses_each_lie_of_a_limit_solver() {
    let collapse = arch().study();
    let strength = Arch { joint: crushing(0.6, 10e6), ..arch() }.study();
    let unbounded = Arch { rise: 1.19, voussoirs: 15, ends: "bonded", ..arch() }.study();
    let thin = Arch { thickness: 0.12, ..arch() }.study();
    let (slides, bridge) = (slides(), bridge());
    let lies: [(&str, &str, Lie); 18] = [
        ("equilibrium:", &collapse, |a| field(a)[2].normal[0] += 10.0),
        ("strength:", &collapse, |a| field(a)[2].shear += 1e7),
        ("strength:", &strength, |a| field(a).iter_mut().for_each(|f| f.normal = f.normal.map(|n| n + 40e6))),
        ("fill:", &bridge, |a| field(a).iter_mut().for_each(|f| f.normal[0] = 1e9)),
        ("gap:", &collapse, |a| a.factor = a.factor.map(|f| f * (1.0 + 1e-6))),
        ("flow:", &collapse, |a| motion(a)[2][1] += 1e-3),
        ("motion_scale:", &collapse, |a| scale(motion(a), 1.0 + 1e-6)),
        ("ray_equilibrium:", &unbounded, |a| a.ray.as_mut().expect("a ray")[2].normal[0] += 1e-3),
        ("ray_strength:", &unbounded, |a| a.ray.as_mut().expect("a ray")[2].shear += 1e9),
        ("the loads do no more work", &thin, |a| scale(motion(a), -1.0)),
        ("flow:", &thin, |a| motion(a)[2][0] += 1.0),
        ("interval_gap:", PUSHED_BACK, |a| a.feasible_interval.as_mut().expect("an interval")[0] *= 1.0 + 1e-6),
        ("motion_scale:", PUSHED_BACK, |a| scale(motion(a), 1.0 + 1e-6)),
        ("complementarity:", &slides, |a| field(a).iter_mut().for_each(|f| f.normal[0] += 1e4)),
        ("above_associated:", &slides, |a| own(a).associated_factor = Some(1e-3)),
        ("associated_flow:", &slides, |a| associated(a)[0][1] -= 1e-3),
        ("associated_motion_scale:", &slides, |a| scale(associated(a), 1.0 + 1e-6)),
        ("associated_gap:", &slides, |a| own(a).associated_factor = own(a).associated_factor.map(|f| f * (1.0 + 1e-6))),
    ];
    for (class, text, lie) in lies {
        let said = said_of_a_lie(text, Some(lie), None);
        assert!(said.contains(class), "{class}: {said}");
    }
}

fn own(answer: &mut LimitAnswer) -> &mut voussoir::core::limit::NonAssociated {
    answer.non_associated.as_mut().expect("the laws' own flow")
}

fn associated(answer: &mut LimitAnswer) -> &mut Vec<Velocity> {
    own(answer).associated_motion.as_mut().expect("a motion")
}

/// For rigid blocks that cannot follow, the proof finds a forged ray without solving again.
#[test]
fn a_forged_ray_of_a_settlement_is_found() {
    let settle = "[[stages]]\nname = \"settle\"\nsettlement = [{ support = \"left\", displacement = [0.01, 0.0] }]\n";
    let low = Arch { span: 8.65, rise: 1.44, thickness: 0.887, voussoirs: 5, ends: "bonded", ..arch() };
    let text = low.study();
    let text = text.replace("[[stages]]\nname = \"live\"", &format!("{settle}[[stages]]\nname = \"live\""));
    let (case, honest) = (first_case(&text), answered(&text));
    assert_eq!(honest.status, Status::NoEquilibrium);
    assert_eq!(verify_case(&case, &honest), Vec::<String>::new());
    let forgeries: [(&str, Forgery); 4] = [
        ("settlement_ray:", |r| r.proof.ray.as_mut().expect("a ray")[2].force[0] *= 1.001),
        ("the ray does no work", |r| {
            let ray = r.proof.ray.as_mut().expect("a ray");
            ray.iter_mut().flat_map(|entry| &mut entry.force).for_each(|v| *v *= -1.0);
        }),
        ("no ray", |r| r.proof.ray = None),
        ("certificate.residuals.settlement_ray is 1e-7", |r| {
            _ = r.certificate.residuals.insert("settlement_ray".into(), 1e-7)
        }),
    ];
    for (what, forge) in forgeries {
        let mut forged = honest.clone();
        forge(&mut forged);
        let said = verify_case(&case, &forged).join("; ");
        assert!(said.contains(what), "{what}: {said}");
    }
}

/// A support that is not at its prescribed position is detected.
#[test]
fn a_support_elsewhere_is_seen() {
    let case = first_case(&arch().study());
    let still = vec![[0.0; 3]; case.assembly.bodies.len()];
    let told = |x: f64| -> Vec<Option<[f64; 3]>> {
        case.assembly.bodies.iter().map(|body| body.fixed.then_some([x, 0.0, 0.0])).collect()
    };
    let off = |x: f64| settlement_residuals(&case.assembly, &[], &still, &told(x), FlowRule::Associated)[0];
    assert_eq!(off(0.0), ("settlement_supports", 0.0));
    assert!(off(1e-3).1 > 1e-8);
}

/// `run` detects each lie about rigid blocks that follow their supports.
#[test]
fn run_refuses_each_lie_about_settlements() {
    let settle = "[[stages]]\nname = \"settle\"\nsettlement = [{ support = \"left\", displacement = [-0.01, 0.0] }]\n";
    let text = arch().study();
    let live = text.find("[[stages]]\nname = \"live\"").expect("a live load");
    let after = text[live..].find("[solver]").map_or("", |at| &text[live + at..]);
    let text = format!("{}{settle}{after}", &text[..live]);
    let lies: [(&str, FollowLie); 2] = [
        ("settlement_flow", |_, _, _, motion| motion[2][1] -= 1e-3), // Another field in equilibrium within the strengths: its work is not the dissipation.
        ("settlement_gap", |honest, problem, field, _| {
            *field = honest.solve(problem, LimitQuestion::Admissible(0.0)).field.expect("a field");
        }),
    ];
    for (class, lie) in lies {
        let said = said_of_a_lie(&text, None, Some(lie));
        assert!(said.contains(class), "{class}: {said}");
    }
}

type Forgery = fn(&mut CaseResult);

fn forces(result: &mut CaseResult) -> &mut Vec<voussoir::results::FieldEntry> {
    result.proof.field.as_mut().expect("a field")
}

fn speeds(list: &mut Option<Vec<voussoir::results::MotionEntry>>) -> &mut Vec<voussoir::results::MotionEntry> {
    list.as_mut().expect("a motion")
}

fn slower(list: &mut Option<Vec<voussoir::results::MotionEntry>>, by: f64) {
    speeds(list).iter_mut().flat_map(|entry| &mut entry.velocity).for_each(|v| *v *= by);
}

/// `verify` detects each violation of limit analysis in stored results, from the proofs, without solving again.
#[test]
fn verify_finds_each_violation_of_limit_analysis() {
    let collapse = arch().study();
    let unbounded = Arch { rise: 1.19, voussoirs: 15, ends: "bonded", ..arch() }.study();
    let thin = Arch { thickness: 0.12, ..arch() }.study();
    let (slides, bridge) = (slides(), bridge());
    let forgeries: [(&str, &str, Forgery); 16] = [
        ("equilibrium:", &collapse, |r| forces(r)[4].force[0] += 10.0),
        ("strength:", &collapse, |r| forces(r)[4].force[1] += 1e7),
        ("fill:", &bridge, |r| r.proof.fill[1].force = 2.0 * r.proof.fill[1].bounds[1]),
        ("gap:", &collapse, |r| r.load_factor = r.load_factor.map(|f| f * (1.0 + 1e-6))),
        ("flow:", &collapse, |r| speeds(&mut r.proof.motion)[3].velocity[1] += 1e-3),
        ("motion_scale:", &collapse, |r| slower(&mut r.proof.motion, 1.0 + 1e-6)),
        ("ray_equilibrium:", &unbounded, |r| r.proof.ray.as_mut().expect("a ray")[4].force[0] += 1e-3),
        ("ray_strength:", &unbounded, |r| r.proof.ray.as_mut().expect("a ray")[4].force[1] += 1e9),
        ("the loads do no more work", &thin, |r| slower(&mut r.proof.motion, -1.0)),
        ("interval_gap:", PUSHED_BACK, |r| {
            r.feasible_interval = r.feasible_interval.map(|ends| ends.map(|end| end.map(|x| x * (1.0 + 1e-6))));
        }),
        ("motion_scale:", &thin, |r| slower(&mut r.proof.motion, 1.0 + 1e-6)),
        ("complementarity:", &slides, |r| forces(r).iter_mut().for_each(|entry| entry.force[0] += 1e4)),
        ("above_associated:", &slides, |r| r.non_associated.associated_load_factor = Some(1e-3)),
        ("associated_flow:", &slides, |r| speeds(&mut r.proof.associated_motion)[1].velocity[1] -= 1e-3),
        ("associated_motion_scale:", &slides, |r| slower(&mut r.proof.associated_motion, 1.0 + 1e-6)),
        ("associated_gap:", &slides, |r| {
            let factor = &mut r.non_associated.associated_load_factor;
            *factor = factor.map(|f| f * (1.0 + 1e-6));
        }),
    ];
    for (class, text, forge) in forgeries {
        let case = first_case(text);
        let mut result = solve_case(&case);
        assert_eq!(verify_case(&case, &result), Vec::<String>::new(), "{class}");
        forge(&mut result);
        let found = verify_case(&case, &result).join("\n");
        assert!(found.contains(class), "{class}: {found}");
    }
}

/// A factor that is off by 3e-9 is detected, at the origin and a kilometre from it: the allowance for rounding is far
/// smaller.
#[test]
fn a_factor_that_is_off_by_little_is_seen() {
    let order: Vec<usize> = (0..arch().voussoirs).collect();
    let away = as_blocks(&arch(), |p| p + Vec2::new(1000.0, -500.0), |force| force, &order);
    for text in [arch().study(), away] {
        let case = first_case(&text);
        let mut result = solve_case(&case);
        assert_eq!(verify_case(&case, &result), Vec::<String>::new());
        result.load_factor = result.load_factor.map(|factor| factor * (1.0 + 3e-9));
        let found = verify_case(&case, &result).join("\n");
        assert!(found.contains("gap:"), "{found}");
    }
}

/// Passes states on, changed from the third state of the second load step on.
struct Changed<'a> {
    checker: PathChecker,
    seen: usize,
    change: &'a dyn Fn(&mut PathState),
}

impl PathObserver for Changed<'_> {
    fn state(&mut self, problem: &PathProblem, state: &PathState) -> bool {
        let mut state = state.clone();
        self.seen += usize::from(state.load_step > 0);
        if self.seen > 2 {
            (self.change)(&mut state);
        }
        self.checker.state(problem, &state)
    }
}

/// Returns the residuals above their tolerances if each state of a path is changed before it is checked.
fn above(case: &Case, solver: &dyn PathSolver, change: &dyn Fn(&mut PathState)) -> BTreeSet<&'static str> {
    let problem = PathProblem::new(&case.assembly, &case.stages).expect("a path problem");
    let checker = PathChecker::certifying(&case.assembly, &case.stages, false).expect("a structure");
    let mut changed = Changed { checker, seen: 0, change };
    let answer = solver.trace(&problem, &small_displacements(), &mut changed);
    assert!(changed.seen > 2, "{:?}", answer.notes);
    let worst = changed.checker.worst.into_iter();
    worst.filter(|(name, value)| value.is_nan() || *value > tolerance(name).result).map(|(name, _)| name).collect()
}

/// Each violation at a dry joint of a path is detected by its class.
#[test]
fn each_violation_at_a_dry_joint_is_seen() {
    let arch = Arch {
        voussoirs: 5,
        ends: "jointed",
        material: elastic(5e9, 0.2),
        mesh: "elements = [1, 2]".into(),
        joint: "law = \"coulomb\"\nfriction = 0.6".into(),
        ..Arch::default()
    };
    let case = first_case(&arch.study());
    let solver = EventPath {};
    assert_eq!(above(&case, &solver, &|_| {}), BTreeSet::new());
    let pressed = |state: &PathState| {
        let force = |i: &usize| state.force[*i][0];
        (0..state.force.len()).max_by(|a, b| force(a).total_cmp(&force(b))).expect("a contact")
    };
    let violations: [(&str, Violation); 8] = [
        ("path_equilibrium", &|s| s.force[3][0] += 1e-5 * s.force[pressed(s)][0]),
        ("path_kinematics", &|s| s.gap[3][1] += 1e-4),
        ("path_strength", &|s| s.force[3][1] = s.force[pressed(s)][0]),
        ("path_penetration", &|s| s.gap[3][0] = -1e-4),
        ("path_complementarity", &|s| {
            let most = pressed(s);
            s.gap[most][0] = 1e-4;
        }),
        ("path_dissipation", &|s| s.dissipated -= 0.1 * s.work.abs()),
        ("path_energy", &|s| s.work *= 1.1),
        ("path_equilibrium", &|s| s.force[3][0] = f64::NAN),
    ];
    for (class, change) in violations {
        let found = above(&case, &solver, change);
        assert!(found.contains(class), "{class}: {found:?}");
    }
}

/// Each violation of a response and of a yielding block is detected by its class.
#[test]
fn each_violation_of_a_law_and_of_a_yielding_block_is_seen() {
    let text = "name = \"pressed\"\n[scene]\nscene = \"blocks\"\nwidth = 1.0\nmaterial = \"stone\"\njoint = \"mortar\"\nblocks = [\n\
        { name = \"ground\", vertices = [[-1.0, -1.0], [2.0, -1.0], [2.0, 0.0], [-1.0, 0.0]], fixed = true, material = \"rock\" },\n\
        { name = \"a\", vertices = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.5], [0.0, 0.5]] },\n]\n[scene.mesh]\nelements = [2, 1]\n\
        [materials.rock]\nlaw = \"rigid\"\ndensity = 2200.0\n[materials.stone]\nlaw = \"drucker_prager_cap\"\n\
        young_modulus = 5e9\npoisson_ratio = 0.2\ndensity = 2200.0\ncap_friction_angle = 70.0\ncap_cohesion = 1e9\n\
        cap_eccentricity = 0.005\ntransition = 0.03\nhardening = [[0.0, 1e6], [0.01, 2e6]]\n[joints.mortar]\nlaw = \"cohesive\"\n\
        friction = 0.6\ntensile_strength = 2e5\ncohesion = 3e5\nnormal_stiffness = 1e11\nshear_stiffness = 4e10\n\
        tensile_fracture_energy = 20.0\nshear_fracture_energy = 60.0\n[[stages]]\nname = \"dead\"\ngravity = 9.81\n[[stages]]\n\
        name = \"live\"\nfactor = 5.0\nloads = [{ kind = \"pressure\", block = \"a\", edge = 2, value = 1e6 }]\n";
    let case = first_case(text);
    let solver = NewtonPath {};
    assert_eq!(above(&case, &solver, &|_| {}), BTreeSet::new());
    let yielded = |state: &mut PathState, displace: f64, history: f64| {
        let Some(own) = state.yielded.iter_mut().flatten().next() else { return };
        let mut inner = (*own.state).clone();
        inner.history.iter_mut().for_each(|h| *h *= history);
        let displacement = own.displacement.iter().enumerate().map(|(i, u)| if i == 5 { u * displace } else { *u });
        *own = Yielded { displacement: Arc::new(displacement.collect()), state: Arc::new(inner) };
    };
    let violations: [(&str, Violation); 3] = [
        ("path_law", &|s| s.force[0][0] *= 1.0 + 1e-5),
        ("path_inner_equilibrium", &|s| yielded(s, 1.01, 1.0)),
        ("path_yield", &|s| yielded(s, 1.0, 0.9)),
    ];
    for (class, change) in violations {
        let found = above(&case, &solver, change);
        assert!(found.contains(class), "{class}: {found:?}");
    }
}

/// Each violated claim at the end of a path is detected: the mechanism and the ray.
#[test]
fn each_violated_claim_at_the_end_of_a_path_is_seen() {
    let arch = Arch {
        voussoirs: 5,
        ends: "jointed",
        material: elastic(5e9, 0.2),
        mesh: "elements = [1, 2]".into(),
        ..Arch::default()
    };
    let case = first_case(&arch.study());
    let problem = PathProblem::new(&case.assembly, &case.stages).expect("a path problem");
    let answer = EventPath {}.trace(&problem, &small_displacements(), &mut voussoir::core::path::Unobserved);
    let (load, honest) = (&problem.load_steps[1].loading, answer.motion.clone().expect("a mechanism"));
    let mut moved = honest.clone();
    moved[2][1] += 0.1 * honest[2][1].abs().max(1e-3);
    let faster: Vec<[f64; 3]> = honest.iter().map(|v| v.map(|x| 1.00001 * x)).collect();
    let [flow, power] = ["path_flow", "path_power"].map(|name| tolerance(name).result);
    assert!(flow_residual(&problem, &answer.state.force, &honest) <= flow);
    assert!(flow_residual(&problem, &answer.state.force, &moved) > flow);
    assert!(power_residual(&problem, load, &honest) <= power && power_residual(&problem, load, &faster) > power);
    let steep = Arch { rise: 1.19, ..arch };
    let case = first_case(&steep.study());
    let problem = PathProblem::new(&case.assembly, &case.stages).expect("a path problem");
    let answer = EventPath {}.trace(&problem, &small_displacements(), &mut voussoir::core::path::Unobserved);
    let (load, mut ray) = (&problem.load_steps[1].loading, answer.ray.expect("a ray"));
    let bound = tolerance("path_ray").result;
    assert!(ray_residual(&problem, load, &ray) <= bound);
    ray.iter_mut().flatten().for_each(|r| *r *= 1.0001);
    assert!(ray_residual(&problem, load, &ray) > bound);
    // A motion that stretches a joint with a response is not a mechanism.
    let soft = Arch { joint: compliant("law = \"coulomb\"\nfriction = 0.6", 1e10, 1e10), ..steep };
    let case = first_case(&changed(
        &soft.study(),
        "law = \"coulomb\"",
        "law = \"cohesive\"\ntensile_strength = 1e5\ncohesion = 1e5\ntensile_fracture_energy = 20.0\nshear_fracture_energy = 60.0",
    ));
    let problem = PathProblem::new(&case.assembly, &case.stages).expect("a path problem");
    let state = PathState {
        force: vec![[0.0; 2]; problem.contacts.len()],
        gap: vec![[0.0; 2]; problem.contacts.len()],
        motion: vec![[0.0; 3]; problem.bodies.len()],
        memory: problem.untouched(),
        ..PathState::default()
    };
    let still = vec![[0.0; 3]; problem.bodies.len()];
    let mut opens = still.clone();
    opens[2][1] = 1e-3;
    let bound = tolerance("path_forces").result;
    assert!(leaves_forces(&problem, &state, &still) <= bound && leaves_forces(&problem, &state, &opens) > bound);
}
