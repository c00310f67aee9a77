//! Dishonest solvers of scenes in space: no certificate accepts a false statement.

use super::plug_ins::LIAR;
use serde::{Deserialize, Serialize};
use voussoir::core::limit::{LimitAnswer, LimitProblem, LimitQuestion, LimitSolver, Status};
use voussoir::core::plugin::{Capability, Card, Need, Parameter, PluginKind, Shape};
use voussoir::core::space::{SpaceAnswer, SpaceField, SpaceNonAssociated, SpaceProblem, SpaceSettled};
use voussoir::core::{inventory, typetag};
use voussoir::solve_case;
use voussoir_tests::first_case;

/// A solver that changes the answer of `limit_cones`.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct LyingSpace {
    lie: String,
}

const KEYS: &[Parameter] = &[Parameter { name: "lie", doc: "the lie", shape: Shape::Text, need: Need::Required }];

inventory::submit! {
    Card { kind: PluginKind::LimitSolver, tag: "lying_space", parameters: KEYS, provides: &[Capability::SPACE], ..LIAR }
}

#[typetag::serde(name = "lying_space")]
impl LimitSolver for LyingSpace {
    fn solve(&self, _: &LimitProblem, _: LimitQuestion) -> LimitAnswer {
        LimitAnswer::stalled("it lies in space only")
    }

    fn refuses(&self, _: &LimitProblem) -> Option<String> {
        Some("it lies in space only".into())
    }

    fn solve_space(&self, problem: &SpaceProblem, question: LimitQuestion) -> Option<SpaceAnswer> {
        let truthful = if self.lie == "searched" { "limit_sequential" } else { "limit_cones" };
        let honest: Box<dyn LimitSolver> = serde_json::from_value(serde_json::json!({ "solver": truthful })).ok()?;
        let all = LimitQuestion::Collapse { start: START, max: f64::INFINITY };
        let mut answer = match self.lie.as_str() {
            // The loads at the start of the stage are not carried, and the answer begins at a factor at which they are.
            "begins_elsewhere" => SpaceAnswer { status: Status::Collapse, ..honest.solve_space(problem, all)? },
            _ => honest.solve_space(problem, question)?,
        };
        let forces = |answer: &mut SpaceAnswer, by: f64| {
            answer.field.iter_mut().flatten().flatten().flatten().for_each(|force| *force *= by);
        };
        match self.lie.as_str() {
            "honest" => {}
            lie if lie.starts_with("settled") => {}
            "begins_elsewhere" => {
                if let LimitQuestion::Admissible(factor) = question {
                    (answer.status, answer.field_factor) = (Status::Stands, factor);
                }
            }
            "factor_high" => answer.factor = answer.factor.map(|factor| 1.05 * factor),
            "field_factor_high" => {
                (answer.factor, answer.field_factor) = (answer.factor.map(|f| 1.05 * f), 1.05 * answer.field_factor);
            }
            "forces_high" => {
                forces(&mut answer, 1.05);
                (answer.factor, answer.field_factor) = (answer.factor.map(|f| 1.05 * f), 1.05 * answer.field_factor);
            }
            "forces_of_nothing" => forces(&mut answer, 0.0),
            "motion_mirrored" => answer.motion.iter_mut().flatten().for_each(|own| own[1] = -own[1] - 1e-3),
            "motion_does_not_open" => answer.motion.iter_mut().flatten().for_each(|own| own[2] = 0.0),
            "motion_scaled" => answer.motion.iter_mut().flatten().flatten().for_each(|v| *v *= 0.9),
            "stands" => answer.status = Status::Stands,
            "searched" => answer.non_associated.iter_mut().for_each(|own| own.searched = Some(0.39)),
            "own_flow" => answer.non_associated = Some(SpaceNonAssociated::default()),
            "unbounded" => (answer.status, answer.ray) = (Status::Unbounded, answer.field.clone()),
            "no_equilibrium" => answer.status = Status::NoEquilibrium,
            "short_lists" => {
                answer.field = answer.field.map(|field| field[1..].to_vec());
                answer.motion = answer.motion.map(|motion| motion[1..].to_vec());
            }
            "not_finite" => answer.field.iter_mut().flatten().flatten().for_each(|force| force[0] = f64::NAN),
            lie => unreachable!("there is no lie {lie}"),
        }
        Some(answer)
    }

    fn settle_space(&self, problem: &SpaceProblem, openings: &SpaceField) -> SpaceSettled {
        let honest: Box<dyn LimitSolver> =
            serde_json::from_value(serde_json::json!({ "solver": "limit_cones" })).expect("a solver");
        let SpaceSettled::Follows { mut field, mut motion } = honest.settle_space(problem, openings) else {
            return SpaceSettled::Refused("it lies about blocks that follow".into());
        };
        match self.lie.as_str() {
            "settled_too_far" => motion.iter_mut().flatten().for_each(|v| *v *= 1.001),
            "settled_nowhere" => motion.iter_mut().flatten().for_each(|v| *v = 0.0),
            "settled_by_other_forces" => field.iter_mut().flatten().flatten().for_each(|f| *f *= 1.001),
            "settled_short" => motion.truncate(motion.len() - 1),
            "settled_not_finite" => motion[0][3] = f64::NAN,
            "settled_blocked" => return SpaceSettled::Blocked(field),
            "settled_blocked_short" => return SpaceSettled::Blocked(field[1..].to_vec()),
            "settled_blocked_by_nothing" => {
                field.iter_mut().flatten().flatten().for_each(|f| *f = 0.0);
                return SpaceSettled::Blocked(field);
            }
            _ => {}
        }
        SpaceSettled::Follows { field, motion }
    }
}

/// Factor at which the lie about the start begins.
const START: f64 = 0.3;

const LIES: [&str; 14] = [
    "honest",
    "begins_elsewhere",
    "factor_high",
    "field_factor_high",
    "forces_high",
    "forces_of_nothing",
    "motion_mirrored",
    "motion_does_not_open",
    "motion_scaled",
    "stands",
    "unbounded",
    "no_equilibrium",
    "short_lists",
    "not_finite",
];

/// Returns a study of a cube of side 1 with μ = 0.4 on the ground, under a gravity vector, pushed along x.
fn cube(gravity: &str, lie: &str) -> String {
    format!(
        "name = \"cube\"\n[scene]\nscene = \"masonry_wall\"\nblock = [1.0, 1.0, 1.0]\ncourses = 1\nblocks = 1\n\
         material = \"stone\"\njoint = \"dry\"\n[materials.stone]\nlaw = \"rigid\"\ndensity = 1.0\n[joints.dry]\n\
         law = \"coulomb_associated\"\nfriction = 0.4\n[[stages]]\nname = \"push\"\ngravity = {gravity}\nuntil = \"collapse\"\n\
         loads = [{{ kind = \"body\", acceleration = [1.0, 0.0, 0.0] }}]\n[solver]\nsolver = \"lying_space\"\nlie = \"{lie}\"\n"
    )
}

/// A cube slides at λ = μ. A changed answer is never certified with another statement, and bounds that remain are true.
#[test]
fn no_lie_about_a_sliding_cube_is_believed() {
    for lie in LIES {
        let result = solve_case(&first_case(&cube("1.0", lie)));
        let factor = result.load_factor.filter(|_| result.status == Status::Collapse);
        let told = format!("{lie}: {:?} {:?} {:?}", result.status, result.bounds, result.notes);
        assert!(factor.is_none_or(|factor| (factor - 0.4).abs() < 4e-9), "{told}");
        assert!(matches!(result.status, Status::Collapse | Status::Open | Status::Stalled), "{told}");
        let [lower, upper] = result.bounds.unwrap_or_default();
        assert!(
            lower.is_none_or(|lower| lower <= 0.4 + 4e-9) && upper.is_none_or(|upper| upper >= 0.4 - 4e-9),
            "{told}"
        );
        assert!(factor.is_some() || lie != "honest", "{told}");
    }
}

/// A gravity that is inclined by 0.6 along −x cannot be carried without a push. A solver that begins its search at a factor
/// at which the loads are carried does not prove the start.
#[test]
fn the_start_of_a_stage_must_be_carried() {
    for lie in ["honest", "begins_elsewhere"] {
        let result = solve_case(&first_case(&cube("[-0.6, 0.0, -1.0]", lie)));
        let told = format!("{lie}: {:?} {:?} {:?}", result.status, result.bounds, result.notes);
        assert_eq!(result.status == Status::NoEquilibrium, lie == "honest", "{told}");
        assert!(matches!(result.status, Status::NoEquilibrium | Status::Open | Status::Stalled), "{told}");
    }
}

/// A field at the end of a stage is a proof for associated flow only. A solver of another project that calls this the laws' own flow is
/// not believed; `limit_sequential` has loaded the joints step by step.
#[test]
fn a_field_is_no_proof_of_the_laws_own_flow() {
    let own = cube("1.0", "own_flow")
        .replace("coulomb_associated", "coulomb")
        .replace("until = \"collapse\"", "factor = 0.3");
    let ours = own.replace("lying_space", "limit_sequential").replace("lie = \"own_flow\"\n", "");
    for (study, read) in [(own, Some("associated")), (ours, None)] {
        let result = solve_case(&first_case(&study));
        assert_eq!(result.status, Status::Stands, "{:?}", result.notes);
        assert_eq!(result.flow_read_as.as_deref(), read, "{:?}", result.notes);
    }
}

/// A search for lower loads leaves nothing to check. It is believed of `limit_least`, but not of a solver of another project.
#[test]
fn a_search_of_a_stranger_bounds_no_load() {
    let own = cube("1.0", "searched").replace("coulomb_associated", "coulomb");
    let ours = own.replace("lying_space", "limit_least").replace("lie = \"searched\"\n", "");
    for (study, status, least) in [(own, Status::Open, None), (ours, Status::Collapse, Some(0.4))] {
        let result = solve_case(&first_case(&study));
        assert_eq!(result.status, status, "{:?}", result.notes);
        let lower = result.bounds.and_then(|bounds| bounds[0]);
        let near = |lower: f64, least: f64| lower <= least && lower >= least * (1.0 - 2e-5);
        assert!(lower.zip(least).map_or(lower == least, |(lower, least)| near(lower, least)), "{lower:?}");
        assert_eq!(result.non_associated.lower_proof.is_some(), least.is_some());
    }
}

/// A vault of one strip follows its support. A changed answer about this leaves the stage without a result.
#[test]
fn no_lie_about_supports_that_move_is_believed() {
    let vault = |lie: &str| {
        format!(
            "name = \"vault\"\n[scene]\nscene = \"barrel_vault\"\nprofile = {{ shape = \"segmental\", span = 9.42, rise = 2.99 }}\n\
             thickness = 0.6\nvoussoirs = 9\nlength = 1.0\nmaterial = \"stone\"\njoint = \"dry\"\n[materials.stone]\n\
             law = \"rigid\"\ndensity = 1.0\n[joints.dry]\nlaw = \"coulomb_associated\"\nfriction = 0.6\n[[stages]]\n\
             name = \"weight\"\ngravity = 1.0\n[[stages]]\nname = \"settle\"\n\
             settlement = [{{ support = \"left\", displacement = [-0.01, 0.0, 0.0] }}]\n[solver]\nsolver = \"lying_space\"\n\
             lie = \"{lie}\"\n"
        )
    };
    for lie in [
        "honest",
        "settled_too_far",
        "settled_nowhere",
        "settled_by_other_forces",
        "settled_short",
        "settled_not_finite",
        "settled_blocked",
        "settled_blocked_short",
        "settled_blocked_by_nothing",
    ] {
        let result = solve_case(&first_case(&vault(lie)));
        let expected = if lie == "honest" { Status::Stands } else { Status::Stalled };
        assert_eq!(result.status, expected, "{lie}: {:?}", result.notes);
        assert_eq!(result.certificate.passed, lie == "honest", "{lie}");
    }
}
