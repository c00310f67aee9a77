use super::scenes::{Dry, STUCK, block, lintel};
use crate::limit::chain::{ChainEngine, LimitChain};
use crate::limit::conic::{LimitConic, engine};
use crate::limit::equilibrium::{excess, field_error};
use crate::limit::nonassociated::LimitNonassociated;
use crate::limit::sensitivity::{DataRate, OptimalFace, same_data};
use crate::limit::sequential::LimitSequential;
use crate::limit::systems::Systems;
use voussoir_core::law::StressBlock;
use voussoir_core::limit::{
    Engine, Equilibrium, ForceVariables, GreatestFactor, JointForce, LimitProblem, LimitQuestion, LimitSolver, Status,
    combined, force_scale, force_unit, loose_motion, with_unit_power,
};
use voussoir_core::model::Wrenches;

const COLLAPSE: LimitQuestion = LimitQuestion::Collapse { start: 0.0, max: f64::INFINITY };

fn sliding(friction: f64) -> Dry {
    Dry { friction: Some(friction), ..STUCK }
}

fn factor(solver: &dyn LimitSolver, problem: &LimitProblem) -> f64 {
    let answer = solver.solve(problem, COLLAPSE);
    assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
    answer.factor.expect("a collapse has a factor")
}

fn close(found: f64, known: f64) {
    assert!((found - known).abs() <= 1e-11 * known.abs(), "{found} {known}");
}

fn solvers() -> [Box<dyn LimitSolver>; 4] {
    [
        Box::new(LimitChain {}),
        Box::new(LimitConic {}),
        Box::new(LimitSequential {}),
        Box::new(LimitNonassociated::default()),
    ]
}

/// A block rocks at b/h or slides at μ, the lesser of both, with every solver.
#[test]
fn a_block_rocks_or_slides() {
    for (width, height, mu) in [(1.0, 2.0, 0.7), (1.0, 2.0, 0.3), (0.4, 0.175, 0.65), (3.0, 1.0, 4.0)] {
        for solver in solvers() {
            close(factor(&*solver, &block(width, height, sliding(mu))), f64::min(width / height, mu));
        }
    }
}

/// Dilatancy does not change the push on a single block, because its weight alone determines the normal force.
#[test]
fn dilatancy_does_not_matter_to_a_single_block() {
    for (mu, known) in [(0.3, 0.3), (0.9, 0.5)] {
        let problem = block(1.0, 2.0, Dry { associated: false, ..sliding(mu) });
        close(factor(&LimitSequential {}, &problem), known);
        close(factor(&LimitNonassociated::default(), &problem), known);
    }
}

/// The least load of a sliding block has a proved lower bound.
#[test]
fn the_least_load_of_a_block_is_proved() {
    let problem = block(1.0, 2.0, Dry { associated: false, ..sliding(0.3) });
    let answer = LimitNonassociated::default().solve(&problem, COLLAPSE);
    let lower = answer.non_associated.and_then(|own| own.proved_lower).expect("a proved bound");
    assert!((lower - 0.3).abs() <= 1e-6 && lower <= 0.3 + 1e-12, "{lower}");
}

/// A crushing toe reduces the lever arm by W/F: λ = b/h (1 − W/F).
#[test]
fn a_toe_that_crushes_shortens_the_lever() {
    for strength in [1.5, 2.0, 10.0, 1e3, 1e8] {
        let problem = block(1.0, 2.0, Dry { crushing: Some(strength), ..STUCK });
        close(factor(&LimitConic {}, &problem), 0.5 * (1.0 - 1.0 / strength));
        close(factor(&LimitChain {}, &problem), 0.5 * (1.0 - 1.0 / strength));
    }
}

/// The thrust of a lintel is free: its joints crush in the middle of their stress blocks, at N = F/2, and λ = F h/L.
#[test]
fn a_lintel_crushes_amid_its_stress_blocks() {
    for (span, height, strength) in [(4.0, 0.5, 8.0), (10.0, 1.0, 1.0), (2.0, 1.0, 300.0)] {
        let problem = lintel(span, height, strength);
        for answer in [LimitConic {}.solve(&problem, COLLAPSE), LimitChain {}.solve(&problem, COLLAPSE)] {
            close(answer.factor.expect("a collapse"), strength * height / span);
            for force in answer.field.expect("a field") {
                close(force.normal[0] + force.normal[1], strength / 2.0);
            }
        }
    }
}

/// Two engines without common programs agree in the factor and in the power of the loads on the motion.
#[test]
fn two_engines_agree() {
    for crushing in [None, Some(3.0), Some(50.0)] {
        let problem = block(0.7, 1.9, Dry { crushing, ..sliding(0.5) });
        let mut engines: [Box<dyn Engine>; 2] =
            [engine(&problem), Box::new(ChainEngine::new(&problem).expect("a chain"))];
        let found =
            engines.each_mut().map(|engine| match engine.greatest(&problem.fixed, &problem.varying, f64::INFINITY) {
                GreatestFactor::Collapse { factor, motion, .. } => {
                    let power: f64 = (0..3).map(|i| problem.varying[0][i] * motion[0][i]).sum();
                    close(power, 1.0);
                    factor
                }
                other => panic!("{other:?}"),
            });
        close(found[0], found[1]);
    }
}

/// A cap below the collapse load is reached with a field there, for linear and crushing joints.
#[test]
fn a_cap_below_the_collapse_load_is_reached() {
    for crushing in [None, Some(20.0)] {
        let problem = block(1.0, 2.0, Dry { crushing, ..STUCK });
        let GreatestFactor::Capped(field) = engine(&problem).greatest(&problem.fixed, &problem.varying, 0.25) else {
            panic!("not capped")
        };
        let loads = combined(&problem.fixed, &problem.varying, 0.25);
        assert!(field_error(&problem, &loads, &field) <= 1e-11);
    }
}

/// A block carries any varying load that presses it down; if it crushes, it carries at most F.
#[test]
fn a_load_that_presses_has_no_bound_but_the_strength() {
    let pressed: Wrenches = vec![[0.0, -1.0, 0.0]];
    let problem = block(1.0, 2.0, sliding(0.5));
    let GreatestFactor::Unbounded(ray) = engine(&problem).greatest(&problem.fixed, &pressed, f64::INFINITY) else {
        panic!("bounded")
    };
    assert!(field_error(&problem, &pressed, &ray) <= 1e-10);
    let problem = block(1.0, 2.0, Dry { crushing: Some(7.0), ..sliding(0.5) });
    let GreatestFactor::Collapse { factor, .. } = engine(&problem).greatest(&problem.fixed, &pressed, f64::INFINITY)
    else {
        panic!("no collapse")
    };
    close(factor, 6.0);
}

/// Shear of a joint that crushes has no bound if it cannot slide: the ray is that shear alone.
#[test]
fn shear_of_a_stuck_joint_that_crushes_is_a_ray() {
    let mut problem = block(1.0, 2.0, Dry { crushing: Some(7.0), ..STUCK });
    problem.varying = vec![[1.0, 0.0, 0.0]];
    let GreatestFactor::Unbounded(ray) = engine(&problem).greatest(&problem.fixed, &problem.varying, f64::INFINITY)
    else {
        panic!("bounded")
    };
    assert_eq!(ray[0].normal, [0.0; 2]);
    close(ray[0].shear.abs(), 1.0);
}

/// A block that is pulled up is refuted by a motion on which its load does work. If it is also pulled sideways, no
/// factor is admissible.
#[test]
fn loads_that_nothing_carries_are_refuted() {
    let problem = block(1.0, 2.0, sliding(0.5));
    let up: Wrenches = vec![[0.0, 1.0, 0.0]];
    let mut engine = engine(&problem);
    let Equilibrium::Motion(motion) = engine.admissible(&up) else { panic!("carried") };
    assert!(motion[0][1] > 0.0);
    let Equilibrium::Motion(motion) = engine.possible(&up, &problem.varying) else { panic!("possible") };
    let power: f64 = (0..3).map(|i| problem.varying[0][i] * motion[0][i]).sum();
    assert!(motion[0][1] > 0.0 && power.abs() <= 1e-9 * motion[0][1], "{motion:?}");
}

/// A block that leans too much is carried with a push back: the admissible factors are an interval.
#[test]
fn factors_that_make_equilibrium_possible_are_found() {
    let problem = block(1.0, 2.0, STUCK);
    let leaning = combined(&problem.fixed, &problem.varying, 100.0);
    assert!(matches!(engine(&problem).possible(&leaning, &problem.varying), Equilibrium::Field(_)));
    let answer = LimitConic {}.solve(&problem, LimitQuestion::Collapse { start: 100.0, max: f64::INFINITY });
    let [low, high] = answer.feasible_interval.expect("an interval");
    assert_eq!(answer.status, Status::NoEquilibrium);
    assert!((low + 0.5).abs() < 1e-9 && (high - 0.5).abs() < 1e-9, "{low} {high}");
}

/// Statuses of admissibility: carried below b/h, refuted above, by both engines.
#[test]
fn admissible_loads_end_at_the_collapse_load() {
    for crushing in [None, Some(10.0)] {
        let problem = block(1.0, 2.0, Dry { crushing, ..STUCK });
        let most = 0.5 * (1.0 - crushing.map_or(0.0, |strength| 1.0 / strength));
        for (share, status) in [(0.9, Status::Stands), (1.1, Status::NoEquilibrium)] {
            for solver in [&LimitChain {} as &dyn LimitSolver, &LimitConic {}] {
                let answer = solver.solve(&problem, LimitQuestion::Admissible(share * most));
                assert_eq!(answer.status, status, "{share} {crushing:?}");
            }
        }
    }
}

/// dλ/db of a block that rocks at b/h is 1/h from both sides; with unchanged data the derivative is zero.
#[test]
fn the_load_of_a_block_changes_with_its_width() {
    let of = |width: f64| block(width, 2.0, sliding(0.9));
    let (problem, step) = (of(1.0), 1e-4);
    let answer = LimitChain {}.solve(&problem, COLLAPSE);
    let (field, motion) = (answer.field.expect("a field"), answer.motion.expect("a motion"));
    let face = OptimalFace::new(&problem, 0.5, &field, &motion).expect("a face");
    for sense in [1.0, -1.0] {
        let rate = DataRate::one_sided(&problem, [&of(1.0 + sense * step), &of(1.0 + 2.0 * sense * step)], step);
        let rate = face.derivative(&rate.expect("smooth data")).expect("a rate");
        assert!((sense * rate - 0.5).abs() < 1e-7, "{rate}");
    }
    assert!(same_data(&problem, &of(1.0)) && !same_data(&problem, &of(1.0 + 1e-9)));
}

/// With another number of rows the topology differs: there is no rate, and the error gives the reason.
#[test]
fn another_topology_has_no_rate() {
    let (one, other) = (block(1.0, 2.0, sliding(0.5)), block(1.0, 2.0, STUCK));
    assert!(DataRate::one_sided(&one, [&other, &other], 1e-3).is_err() && !same_data(&one, &other));
}

/// dλ/dF of a crushing toe is b W/(h F²): the stress block is represented by its tangents.
#[test]
fn the_load_of_a_toe_changes_with_its_strength() {
    let of = |strength: f64| block(1.0, 2.0, Dry { crushing: Some(strength), ..sliding(0.9) });
    let (problem, step) = (of(4.0), 1e-4);
    let answer = LimitChain {}.solve(&problem, COLLAPSE);
    let (field, motion) = (answer.field.expect("a field"), answer.motion.expect("a motion"));
    let face = OptimalFace::new(&problem, answer.factor.expect("a factor"), &field, &motion).expect("a face");
    let rate = DataRate::one_sided(&problem, [&of(4.0 + step), &of(4.0 + 2.0 * step)], step).expect("smooth data");
    assert!((face.derivative(&rate).expect("a rate") - 0.5 / 16.0).abs() < 1e-7);
}

/// Errors of fields agree with hand calculation: zero in balance, violation of a row, and unbalanced forces.
#[test]
fn errors_of_fields_are_shares_of_the_loads() {
    let problem = block(1.0, 2.0, sliding(0.5));
    let force = |normal: [f64; 2], shear: f64| [JointForce { normal, shear }];
    assert_eq!(field_error(&problem, &problem.fixed, &force([0.5, 0.5], 0.0)), 0.0);
    assert!((field_error(&problem, &problem.fixed, &force([0.5, 0.4], 0.0)) - 0.1).abs() < 1e-15);
    let leaning = combined(&problem.fixed, &problem.varying, 0.8);
    let size = problem.magnitude(&leaning);
    assert!((field_error(&problem, &leaning, &force([1.3, -0.3], 0.8)) - 0.3 / size).abs() < 1e-15);
}

/// The violation of a stress block follows its parabola: N²/F − 2 N_i at the end with less compression.
#[test]
fn a_stress_block_is_exceeded_by_its_parabola() {
    let block = StressBlock { tension: 0.0, total: 4.0 };
    let force = |normal| JointForce { normal, shear: 0.0 };
    assert_eq!(excess(block, &force([1.0, 1.0])), -1.0);
    assert_eq!(excess(block, &force([0.5, 1.5])), 0.0);
    assert_eq!(excess(block, &force([1.5, 0.25])), 0.265_625);
}

/// Variables convert to joint forces in their unit; equilibrium in variables equals equilibrium of the wrenches.
#[test]
fn force_variables_are_joint_forces() {
    let problem = block(1.0, 2.0, sliding(0.5));
    let variables = ForceVariables::new(&problem);
    let forces = variables.joint_forces(&[1.0, 2.0, 3.0], 10.0);
    assert_eq!((forces[0].normal, forces[0].shear), ([10.0, 20.0], 30.0));
    let rows = variables.equilibrium(&problem);
    let sums = rows.iter().map(|row| row.iter().map(|(j, v)| v * [1.0, 2.0, 3.0][*j]).sum());
    let sums: Vec<f64> = sums.collect();
    // 3 N of shear act along the tangent, which points left; N_0 − N_1 turns the block by half its width.
    assert!((sums[0] + 3.0).abs() < 1e-15 && (sums[1] - 3.0).abs() < 1e-15);
    assert!((sums[2] + 0.5 / problem.length).abs() < 1e-15, "{sums:?}");
}

/// Scales: an unloaded problem has the unit 1 N, motions have unit power, and fixed loads set the scale if they exist.
#[test]
fn scales_are_those_of_the_loads() {
    let problem = block(1.0, 2.0, STUCK);
    let none: Wrenches = vec![[0.0; 3]];
    assert_eq!(force_unit(&problem, &none), 1.0);
    assert_eq!(force_scale(&problem, &problem.fixed, &problem.varying), force_unit(&problem, &problem.fixed));
    assert_eq!(force_scale(&problem, &none, &problem.varying), force_unit(&problem, &problem.varying));
    let motion = with_unit_power(&problem.varying, vec![[3.0, 5.0, -1.0]]);
    // Power of the push at half height: v_x − ω h/2.
    close(motion[0][0] - motion[0][2], 1.0);
}

/// A group without joints floats: a motion along its weight refutes the weight. A fixed push is not refuted if the
/// varying load is the same push.
#[test]
fn groups_without_joints_float() {
    let mut problem = block(1.0, 2.0, STUCK);
    assert!(loose_motion(&problem, &problem.fixed, &problem.varying).is_none());
    problem.joints.clear();
    let motion = loose_motion(&problem, &problem.fixed, &problem.varying).expect("a motion");
    assert!(motion[0][1] < 0.0);
    assert!(loose_motion(&problem, &problem.varying, &problem.varying).is_none());
}

/// Multipliers of a motion with the laws' own flow: slip only slides, and a rotation about one end opens the other.
#[test]
fn multipliers_of_a_motion_are_its_jumps() {
    let problem = block(1.0, 2.0, Dry { associated: false, ..sliding(0.5) });
    let systems = Systems::new(&problem, &problem.fixed);
    let slip = systems.multipliers(&problem, &[[1.0, 0.0, 0.0]]);
    assert_eq!(slip.iter().filter(|gamma| **gamma > 0.0).count(), 1);
    assert!(systems.pairs[slip.iter().position(|gamma| *gamma > 0.0).expect("one")].slides());
    let turn = systems.multipliers(&problem, &[[0.0, 0.5, -1.0]]);
    assert_eq!(turn.iter().filter(|gamma| **gamma > 0.0).count(), 1);
    assert!((turn[1] - 1.0).abs() < 1e-12, "{turn:?}");
}

/// From any field, the nearest field on the yield surface is the field at the limit load.
#[test]
fn the_field_of_a_rocking_block_is_recovered() {
    let problem = block(1.0, 2.0, sliding(0.9));
    let systems = Systems::new(&problem, &problem.fixed);
    let (z, violation) = systems.field(&[1], vec![0.3; systems.forces + 1]).expect("a field");
    close(z[systems.forces] * systems.unit, 0.5);
    assert!(violation <= 1e-13 && systems.joint_forces(&z)[0].normal[1].abs() <= 1e-13);
}
