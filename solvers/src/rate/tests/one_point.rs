//! One point.

use super::*;

/// A stuck point reaches its friction cone and slips while the load rises.
#[test]
fn a_stuck_point_slips_under_a_rising_load() {
    let laws = dry(0.5, 0.0);
    let case =
        Case::slipping(&laws, 1, &tangential(1, 0.0, |_, _| 2.0), &[0.0, 1.0]).arriving(0, ContactMode::Stick, true);
    let (rate, twins) = case.goes();
    assert_eq!((rate.factor, rate.modes, twins.len()), (1.0, vec![SLIP], 0));
    assert!((rate.gaps[0][1] + 0.5).abs() < 1e-14);
}

/// Slip lowers the normal force faster than the tangential force: the load falls, and a proof excludes a rising one.
#[test]
fn slip_that_unloads_its_own_contact_folds_the_path() {
    let laws = dry(0.5, 0.0);
    let s = [10.0, 2.5, 2.5, 1.0];
    let case = Case::slipping(&laws, 1, &s, &[0.0, 1.0]).arriving(0, ContactMode::Stick, true);
    let answer = case.answer();
    let Continuation::Goes { rate, .. } = answer.continuation else { panic!() };
    assert_eq!((rate.factor, rate.modes), (-1.0, vec![SLIP]));
    assert!(answer.none_rises.is_some());
}

/// A sliding block: no force resists the slip, the load does work on it at a constant factor.
#[test]
fn a_block_that_slides_is_a_mechanism() {
    let laws = dry(0.5, 0.0);
    let case = Case::slipping(&laws, 1, &[0.0; 4], &[0.0, 1.0]).arriving(0, ContactMode::Stick, true);
    let answer = case.answer();
    let Continuation::Goes { rate, .. } = answer.continuation else { panic!("{answer:?}") };
    assert_eq!((rate.factor, rate.modes.clone()), (0.0, vec![SLIP]));
    assert!(case.problem.power(&rate.gaps) > 0.0 && answer.none_rises.is_some());
}

/// The growing load lowers the normal force of a point and pushes it back; other loads drive its slip. The load resists this
/// mechanism, which continues the path only if the event makes it possible.
#[test]
fn other_loads_drive_a_mechanism() {
    let laws = dry(0.5, 0.0);
    let case = || Case::slipping(&laws, 1, &[0.0; 4], &[-1.0, -0.2]);
    let arrived = case().arriving(0, ContactMode::Stick, true);
    let answer = arrived.answer();
    let Continuation::Goes { rate, .. } = answer.continuation else { panic!("{answer:?}") };
    assert_eq!((rate.factor, rate.modes.clone()), (0.0, vec![SLIP]));
    assert!(arrived.problem.load_resists(&rate) && answer.none_rises.is_some());
    let slipped = case().arriving(0, SLIP, true).answer();
    assert!(!matches!(slipped.continuation, Continuation::Goes { .. }), "{slipped:?}");
}

/// A motion without resistance on which the load does no work does not continue the path: the load rises.
#[test]
fn a_neutral_motion_is_no_mechanism() {
    let laws = dry(0.5, 0.0);
    let case = Case::slipping(&laws, 1, &[0.0; 4], &[1.0, 0.0]);
    let (rate, _) = case.goes();
    assert_eq!((rate.factor, rate.modes), (1.0, vec![ContactMode::Stick]));
}

/// A point without force at the apex of its cone opens if the load pulls.
#[test]
fn a_point_at_the_apex_opens() {
    let laws = dry(0.5, 0.0);
    let case = Case::new(&laws, &[(&[0, 1, 2], [0.0; 2])], &tangential(1, 0.0, |_, _| 1.0), &[-1.0, 0.2]).arriving(
        0,
        ContactMode::Stick,
        true,
    );
    let (rate, _) = case.goes();
    assert_eq!((rate.factor, rate.modes), (1.0, vec![ContactMode::Open]));
    assert!((rate.gaps[0][0] - 1.0).abs() < 1e-14 && (rate.gaps[0][1] + 0.2).abs() < 1e-14);
}

/// An open point closes and sticks if the load presses it steeply, and slips if the load is inclined.
#[test]
fn a_closing_point_sticks_or_slips() {
    let laws = dry(0.5, 0.0);
    for (load, mode) in [([1.0, 0.2], ContactMode::Stick), ([1.0, 0.8], SLIP), ([1.0, -0.8], BACK)] {
        let case = Case::new(&laws, &[(&[0, 1, 2], [0.0; 2])], &tangential(1, 0.0, |_, _| 1.0), &load).arriving(
            0,
            ContactMode::Open,
            true,
        );
        assert_eq!(case.goes().0.modes, vec![mode]);
    }
}

/// A slipping point stops: its slip rate would change its sign.
#[test]
fn a_slipping_point_comes_to_rest() {
    let laws = dry(0.5, 0.0);
    let case = Case::slipping(&laws, 1, &tangential(1, 0.0, |_, _| 1.0), &[1.0, 0.3]).arriving(0, SLIP, true);
    let (rate, _) = case.goes();
    assert_eq!((rate.factor, rate.modes), (1.0, vec![ContactMode::Stick]));
}

/// A point that is not in the event keeps its present modes.
#[test]
fn present_modes_go_on() {
    let laws = dry(0.5, 0.0);
    let case = Case::slipping(&laws, 1, &tangential(1, 0.0, |_, _| 1.0), &[0.0, 1.0]).arriving(0, SLIP, false);
    assert_eq!(case.goes().0.modes, vec![SLIP]);
}

/// On a falling path the rate back up existed before the event and is excluded.
#[test]
fn a_falling_path_does_not_go_back() {
    let laws = dry(0.5, 0.0);
    // Hinges have opened before; a stuck point reaches its cone while λ falls.
    let case = Case::slipping(&laws, 1, &tangential(1, 0.0, |_, _| 1.0), &[0.0, -1.0])
        .arriving(0, ContactMode::Stick, true)
        .falling();
    let (rate, _) = case.goes();
    assert_eq!((rate.factor, rate.modes), (-1.0, vec![SLIP]));
}

/// A rate without any active point continues in the sense of the arrival.
#[test]
fn nothing_active_goes_on_in_the_same_sense() {
    let rising = Case::new(&[], &[], &[], &[]);
    assert_eq!(rising.goes().0.factor, 1.0);
    assert_eq!(rising.falling().goes().0.factor, -1.0);
}

/// A support moves a determinate structure at constant forces: λ continues, so this is not a mechanism.
#[test]
fn a_moving_support_at_constant_forces_goes_on() {
    let laws = dry(0.5, 0.0);
    let mut case = Case::slipping(&laws, 1, &tangential(1, 0.0, |_, _| 1.0), &[0.0, 0.0]);
    case.problem.settles = true;
    let (rate, _) = case.goes();
    assert_eq!((rate.factor, rate.modes), (1.0, vec![ContactMode::Stick]));
}

/// Dilatant slip against a stiff bed presses the contact: the load rises, and without dilatancy it falls.
#[test]
fn dilatancy_turns_a_fold_into_a_rise() {
    for (dilatancy, factor) in [(0.0, -1.0), (0.5, 1.0)] {
        let laws = dry(0.5, dilatancy);
        let case = Case::slipping(&laws, 1, &[10.0, 2.5, 2.5, 1.0], &[0.0, 1.0]).arriving(0, ContactMode::Stick, true);
        assert_eq!(case.goes().0.factor, factor);
    }
}

/// Unloading existed before the event: no rate continues, although a falling one exists.
#[test]
fn unloading_is_no_continuation() {
    let laws = dry(0.5, 0.0);
    let case = only_unloading(&laws);
    let unloading = Rate { factor: -1.0, modes: vec![ContactMode::Stick], gaps: vec![[0.0; 2]] };
    assert!(!case.arrival.continues(&case.problem, &unloading));
    let Continuation::NoneContinues(proofs) = case.answer().continuation else { panic!() };
    proofs.iter().for_each(|proof| super::proofs::check(&case.problem, proof));
}
