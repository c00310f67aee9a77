//! Proved lower ends of loads with slip that does not open the joints.

use super::own_flow::{duct, groove, in_a_corner, under_a_block, without_dilatancy};
use super::random::stack;
use super::scenes::{COLLAPSE, certified};
use crate::space::{lower_bound, prove_least, solve, solve_with_own_flow};
use voussoir_core::law::FrictionCone;
use voussoir_core::limit::{Greatest, Status};
use voussoir_core::random::Random;
use voussoir_core::space::{SpaceProblem, Vec3};

/// Greatest number of matrix entries that a proof sweeps.
const WORK: u64 = 500_000_000;

/// Scenes whose least load is known.
fn scenes() -> Vec<(&'static str, SpaceProblem, f64)> {
    let slope = |angle: f64| angle.to_radians().sin_cos();
    let (sin, cos) = slope(30.0);
    vec![
        ("groove 45°", groove(45.0, 0.5, 6.0), 0.5 / slope(45.0).0),
        ("groove 30°", groove(30.0, 0.3, 6.0), 0.6),
        ("duct", without_dilatancy(&duct(30.0, 0.4).0, &Vec3::x()), 0.4 * (cos + sin)),
        ("wall", under_a_block(0.6, &[Vec3::x()], &Vec3::x()), 0.6 * (1.0 + 1.0 / 1.36)),
        ("jam", under_a_block(1.0, &[Vec3::x()], &Vec3::x()), 1.5),
    ]
}

/// The proved end is just below the least load. A slab in a corner needs more work than is spent here.
#[test]
fn proofs_reach_the_least_loads() {
    for (name, problem, least) in scenes() {
        let lower = lower_bound(&problem, 0.0, least, WORK).lower;
        assert!(lower >= (1.0 - 2e-5) * least, "{name}: {lower}");
    }
    let least = 0.857_514_058;
    let lower = lower_bound(&in_a_corner(), 0.0, least, WORK).lower;
    assert!(lower >= 0.99 * least, "corner: {lower}");
}

/// If the known factor is too high, the proof ends at the least load: nothing that exists is excluded.
#[test]
fn proofs_do_not_exclude_the_least_state() {
    for (name, problem, least) in scenes() {
        for above in [1.1, 2.0] {
            let lower = lower_bound(&problem, 0.0, above * least, WORK).lower;
            assert!(lower <= least * (1.0 + 1e-9), "{name} {above}: {lower}");
            assert!(lower >= 0.99 * least, "{name} {above}: {lower}");
        }
    }
}

/// In random stacks the search of states and the proof, which share no algorithm, lead to the same load from above and from below.
#[test]
fn the_least_loads_of_random_stacks_are_proved() {
    let mut random = Random::new(3);
    let mut proved = 0;
    for case in 0..12 {
        let direction = Vec3::new(random.between(-1.0, 1.0), random.between(-1.0, 1.0), random.between(-0.3, 0.3));
        let problem = without_dilatancy(&stack(&mut random), &direction);
        let answer = solve_with_own_flow(&problem, COLLAPSE, solve);
        let Some(found) = answer.factor.filter(|_| answer.status == Status::Collapse) else { continue };
        let lower = lower_bound(&problem, 0.0, 1.3 * found, WORK).lower;
        assert!(lower <= found * (1.0 + 1e-9), "{case}: {lower} {found}");
        proved += usize::from(lower >= 0.999 * found);
    }
    assert!(proved >= 8, "{proved}");
}

/// The answer has both ends. Without work, with too many blocks and with dilatancy, no lower end is proved.
#[test]
fn the_answer_states_what_is_proved() {
    let known = groove(45.0, 0.5, 6.0);
    let mut many = known.clone();
    many.bodies = 13;
    (many.fixed, many.varying) = (vec![[0.0; 6]; 13], vec![[0.0; 6]; 13]);
    (many.fixed[0], many.varying[0]) = (known.fixed[0], known.varying[0]);
    let mut dilates = known.clone();
    dilates.contacts.iter_mut().for_each(|contact| contact.law = FrictionCone::dry(0.5, 0.1));
    for (problem, work, greatest) in [
        (&known, WORK, Greatest::ProvedOptimal),
        (&known, 0, Greatest::Open),
        (&many, WORK, Greatest::Open),
        (&dilates, WORK, Greatest::Open),
    ] {
        let answer = prove_least(problem, COLLAPSE, solve_with_own_flow(problem, COLLAPSE, solve), work);
        let verdict = certified(problem, &answer, COLLAPSE);
        let status = if greatest == Greatest::Open { Status::Open } else { Status::Collapse };
        assert_eq!((verdict.status, verdict.greatest), (status, greatest), "{:?} {:?}", answer.notes, verdict.bounds);
    }
}
