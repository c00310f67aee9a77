use super::residuals::greatest;
use super::{Loads, Program, solve};
use crate::limit::tests::scenes::{Dry, STUCK, block};
use voussoir_core::limit::LimitProblem;

fn loads(problem: &LimitProblem) -> Loads<'_> {
    Loads { fixed: Some(&problem.fixed), varying: &problem.varying, cap: f64::INFINITY, strengths: true }
}

/// Two equal blocks beside each other, each with its own loads.
fn twins(friction: f64) -> LimitProblem {
    let mut problem = block(1.0, 2.0, Dry { friction: Some(friction), ..STUCK });
    let mut other = problem.joints[0].clone();
    (other.joint, other.plus) = (1, Some(1));
    problem.joints.push(other);
    problem.group_of.push(Some(1));
    problem.groups = 2;
    problem.fixed.push(problem.fixed[0]);
    problem.varying.push(problem.varying[0]);
    problem
}

/// The jump of a motion is dual to the wrenches of forces: x · Eᵀ q = q · E x.
#[test]
fn jumps_are_dual_to_wrenches() {
    let problem = block(1.3, 2.0, Dry { friction: Some(0.5), ..STUCK });
    let program = Program::new(&problem, loads(&problem)).expect("a program");
    let (x, q) = ([0.3, -1.7, 0.9], [0.2, 1.1, -0.6]);
    let jump = program.jump(&program.members[0], &q);
    let mut wrench = vec![0.0; 3];
    program.press(&program.members[0], &x, &mut wrench);
    let of_forces: f64 = (0..3).map(|k| x[k] * jump[k]).sum();
    let of_motion: f64 = (0..3).map(|i| q[i] * wrench[i]).sum();
    assert!((of_forces - of_motion).abs() < 1e-14, "{of_forces} {of_motion}");
}

/// One block has one mechanism; two equal blocks fall alone or together, at the same load.
#[test]
fn equal_blocks_have_more_than_one_mechanism() {
    for (friction, known) in [(0.9, 0.5), (0.3, 0.3)] {
        let alone = block(1.0, 2.0, Dry { friction: Some(friction), ..STUCK });
        for (problem, unique) in [(alone, true), (twins(friction), false)] {
            let program = Program::new(&problem, loads(&problem)).expect("a program");
            let solution = solve(&program, false).solution.expect("an optimum");
            assert!((solution.factor - known).abs() < 1e-12 && solution.unique == unique, "{solution:?}");
        }
    }
}

/// The motion of equal blocks is in the middle of all mechanisms: both move equally.
#[test]
fn equal_blocks_move_alike() {
    let problem = twins(0.9);
    let program = Program::new(&problem, loads(&problem)).expect("a program");
    let motion = solve(&program, false).solution.expect("an optimum").motion;
    for (a, b) in motion[0].iter().zip(&motion[1]) {
        assert!((a - b).abs() <= 1e-6 * motion[0][2].abs(), "{motion:?}");
    }
}

/// A mirrored load has the mirrored motion and the same factor.
#[test]
fn a_mirrored_load_has_the_same_factor() {
    let problem = block(1.0, 2.0, Dry { friction: Some(0.9), ..STUCK });
    let mut mirrored = problem.clone();
    mirrored.varying[0] = [-problem.varying[0][0], problem.varying[0][1], -problem.varying[0][2]];
    let [own, other] = [&problem, &mirrored].map(|problem| {
        let program = Program::new(problem, loads(problem)).expect("a program");
        solve(&program, false).solution.expect("an optimum")
    });
    assert!((own.factor - other.factor).abs() < 1e-13);
    assert!((own.motion[0][2] + other.motion[0][2]).abs() < 1e-12 * own.motion[0][2].abs(), "{own:?} {other:?}");
}

/// The field that carries the dead load alone is inside all bounds: half the weight of the block at each end.
#[test]
fn the_dead_load_stands_amid_the_bounds() {
    let problem = block(1.0, 2.0, Dry { friction: Some(0.5), ..STUCK });
    let program = Program::new(&problem, loads(&problem)).expect("a program");
    let field = solve(&program, true).stands.expect("a field");
    assert!((field[0].normal[0] - 0.5).abs() < 1e-9 && (field[0].normal[1] - 0.5).abs() < 1e-9, "{field:?}");
    assert!(field[0].shear.abs() < 1e-9);
}

/// A joint with five rows has no program.
#[test]
fn five_rows_are_refused() {
    let mut problem = block(1.0, 2.0, Dry { friction: Some(0.5), ..STUCK });
    let row = problem.joints[0].strength.rows[0];
    problem.joints[0].strength.rows.push(row);
    assert!(Program::new(&problem, loads(&problem)).is_none());
}

/// The greatest of several numbers is NaN if one of them is NaN, whatever its place.
#[test]
fn no_number_is_lost_among_the_greatest() {
    let mut values = vec![1.0; 21];
    values[3] = -7.0;
    assert_eq!(greatest(&values), 7.0);
    for index in [0, 7, 8, 20] {
        let mut wrong = values.clone();
        wrong[index] = f64::NAN;
        assert!(greatest(&wrong).is_nan(), "{index}");
    }
}
