//! Two and three points: several points in one event, twins, the rule.

use super::*;

/// Two points with a coupling of their slips: above 1 they soften each other, and the symmetric mode is unstable.
fn pair(cross: f64) -> Vec<f64> {
    tangential(2, 0.0, |i, j| if i == j { 1.0 } else { cross })
}

/// An event contains two points of a symmetric structure; the symmetric mode is stable and continues.
#[test]
fn a_stable_symmetric_mode_goes_on() {
    let laws = dry(0.5, 0.0);
    let case = both_hit(&laws, 0.3);
    let (rate, twins) = case.goes();
    assert_eq!((rate.factor, rate.modes, twins.len()), (1.0, vec![SLIP, SLIP], 0));
}

fn both_hit(laws: &[Facet], cross: f64) -> Case<'_> {
    Case::slipping(laws, 2, &pair(cross), &[0.0, 1.0, 0.0, 1.0]).arriving(0, ContactMode::Stick, true).arriving(
        1,
        ContactMode::Stick,
        true,
    )
}

/// The symmetric mode is unstable under control: one of the two points slips, and the other one is its twin.
#[test]
fn an_unstable_symmetric_mode_gives_way_to_twins() {
    let laws = dry(0.5, 0.0);
    let case = both_hit(&laws, 1.5);
    let (rate, twins) = case.goes();
    assert_eq!((rate.factor, twins.len()), (1.0, 1));
    let modes = [&rate.modes, &twins[0].modes];
    assert!(modes.contains(&&vec![SLIP, ContactMode::Stick]) && modes.contains(&&vec![ContactMode::Stick, SLIP]));
}

/// Each point softens alone, and together they carry more, but this mode is unstable: the path follows one of two falling
/// rates, and it is not claimed that no rate rises.
#[test]
fn an_unstable_rising_mode_gives_way_to_falling_twins() {
    let laws = dry(0.5, 0.0);
    let s = tangential(2, 0.0, |i, j| if i == j { -1.0 } else { 2.0 });
    let mut case = Case::slipping(&laws, 2, &s, &[0.0, 1.0, 0.0, 1.0]);
    for k in 0..2 {
        case = case.arriving(k, ContactMode::Stick, true);
    }
    let (rate, twins) = case.goes();
    assert_eq!((rate.factor, twins.len()), (-1.0, 1));
    let modes = [&rate.modes, &twins[0].modes];
    assert!(modes.contains(&&vec![SLIP, ContactMode::Stick]) && modes.contains(&&vec![ContactMode::Stick, SLIP]));
    assert!(case.answer().none_rises.is_none());
}

/// One of two points that soften each other has a slightly greater force: that point dissipates more, slips, and has no twin.
#[test]
fn the_greatest_dissipation_is_chosen() {
    let laws = dry(0.5, 0.0);
    let mut case = both_hit(&laws, 1.5);
    case.arrival.points[1].force = [1.1, 0.55];
    let (rate, twins) = case.goes();
    assert_eq!((rate.modes, twins.len()), (vec![ContactMode::Stick, SLIP], 0));
}

/// Without dissipation the least second-order energy decides: the softer of two cracks opens.
#[test]
fn without_dissipation_the_softer_point_moves() {
    let laws = vec![Facet::opening(0.0)];
    let case = |first: f64| {
        #[rustfmt::skip]
        let s = [
            first, 0.0, 1.5, 0.0,
            0.0, 1.0, 0.0, 0.0,
            1.5, 0.0, 1.0, 0.0,
            0.0, 0.0, 0.0, 1.0,
        ];
        Case::new(&laws, &[(&[0], [0.0; 2]), (&[0], [0.0; 2])], &s, &[-1.0, 0.0, -1.0, 0.0])
            .arriving(0, ContactMode::Stick, true)
            .arriving(1, ContactMode::Stick, true)
            .goes()
    };
    let open = ContactMode::Facet(0);
    assert_eq!(case(1.1).0.modes, vec![ContactMode::Stick, open]);
    assert_eq!(case(0.9).0.modes, vec![open, ContactMode::Stick]);
    assert_eq!(case(1.0).1.len(), 1);
}

/// One point is hit; its slip moves another point, which is not of the event, out of its mode.
#[test]
fn other_points_leave_their_modes_by_their_inequalities() {
    let laws = dry(0.5, 0.0);
    let s = tangential(2, 0.0, |i, j| if i == j { 1.0 } else { -0.8 });
    let case = Case::slipping(&laws, 2, &s, &[0.0, 1.0, 0.0, -0.1]).arriving(0, ContactMode::Stick, true);
    let (rate, _) = case.goes();
    assert_eq!((rate.factor, rate.modes), (1.0, vec![SLIP, SLIP]));
}

/// A point that slipped stops when another one begins to slip and relieves it.
#[test]
fn a_slipping_point_stops_when_another_slips() {
    let laws = dry(0.5, 0.0);
    let s = tangential(2, 0.0, |i, j| [[1.0, 0.9], [0.9, 1.0]][i][j]);
    let case = Case::slipping(&laws, 2, &s, &[0.0, 1.0, 0.0, 0.5])
        .arriving(0, ContactMode::Stick, true)
        .arriving(1, SLIP, false);
    let (rate, _) = case.goes();
    assert_eq!((rate.factor, rate.modes), (1.0, vec![SLIP, ContactMode::Stick]));
}

/// The neighbour folds, but a rate with other modes rises: equilibrium under a growing load comes first.
#[test]
fn a_rising_rate_comes_before_a_falling_neighbour() {
    let laws = dry(0.5, 0.0);
    let problem = rises_elsewhere(&laws);
    let answer = problem.answer();
    let Continuation::Goes { rate, .. } = answer.continuation else { panic!("{answer:?}") };
    assert_eq!(rate.factor, 1.0);
    assert!(answer.none_rises.is_none());
}

/// The first point folds if it slips alone; if the second one slips too, its normal force keeps the first one pressed.
fn rises_elsewhere(laws: &[Facet]) -> Case<'_> {
    #[rustfmt::skip]
    let s = [
        10.0, 2.5, 0.0, -3.0,
        2.5, 1.0, 0.0, 0.0,
        0.0, 0.0, 1.0, 0.0,
        -3.0, 0.0, 0.0, 1.0,
    ];
    Case::slipping(laws, 2, &s, &[0.0, 1.0, 0.0, 0.9]).arriving(0, ContactMode::Stick, true)
}

/// On a falling path the rule applies to all rates: a rising one does not come first.
#[test]
fn a_falling_path_keeps_its_neighbour() {
    let laws = dry(0.5, 0.0);
    let case = Case::slipping(&laws, 1, &[10.0, 2.5, 2.5, 1.0], &[0.0, 1.0]).arriving(0, SLIP, false).falling();
    let (rate, _) = case.goes();
    assert_eq!((rate.factor, rate.modes), (-1.0, vec![SLIP]));
}

/// A falling rate that dissipates nothing continues: a crack opens at an unstable crown.
#[test]
fn a_falling_rate_without_dissipation_continues() {
    let laws = vec![Facet::opening(0.0)];
    let case = Case::new(&laws, &[(&[0], [0.0; 2])], &[-1.0, 0.0, 0.0, 1.0], &[-1.0, 0.0]).arriving(
        0,
        ContactMode::Stick,
        true,
    );
    let answer = case.answer();
    let Continuation::Goes { rate, .. } = answer.continuation else { panic!("{answer:?}") };
    assert_eq!((rate.factor, rate.modes), (-1.0, vec![ContactMode::Facet(0)]));
    assert!(answer.none_rises.is_some());
}

/// Three symmetric points that soften each other: one slips, since pairs are unstable under control although they dissipate
/// more. The two others are twins.
#[test]
fn three_points_have_two_twins() {
    let laws = dry(0.5, 0.0);
    let s = tangential(3, 0.0, |i, j| if i == j { 1.0 } else { 1.5 });
    let mut case = Case::slipping(&laws, 3, &s, &[0.0, 1.0, 0.0, 1.0, 0.0, 1.0]);
    for k in 0..3 {
        case = case.arriving(k, ContactMode::Stick, true);
    }
    let (rate, twins) = case.goes();
    assert_eq!((rate.factor, twins.len()), (1.0, 2));
    assert_eq!(rate.modes.iter().filter(|mode| **mode == SLIP).count(), 1);
}

/// Two blocks may slide, each alone or both: mechanisms without dissipation and without energy are twins.
#[test]
fn mechanisms_without_resistance_are_twins() {
    let laws = dry(1e-12, 0.0);
    let s = tangential(2, 0.0, |_, _| 0.0);
    let mut case = Case::slipping(&laws, 2, &s, &[0.0, 1.0, 0.0, 1.0]).arriving(0, ContactMode::Stick, true).arriving(
        1,
        ContactMode::Stick,
        true,
    );
    case.arrival.points.iter_mut().for_each(|point| point.force = [1.0, 0.0]);
    let (rate, twins) = case.goes();
    assert!(rate.factor == 0.0 && !twins.is_empty(), "{rate:?} {twins:?}");
}

/// Two points that may slide independently under the load that has been reached: a rate in which both slide is not determined
/// by its modes, so that one of them slides first. The other one is its twin.
#[test]
fn one_of_two_independent_parts_slides_first() {
    let laws = dry(0.5, 0.0);
    let case = Case::slipping(&laws, 2, &tangential(2, 0.0, |_, _| 0.0), &[0.0, 1.0, 0.0, 1.0])
        .arriving(0, ContactMode::Stick, true)
        .arriving(1, ContactMode::Stick, true);
    let (rate, twins) = case.goes();
    assert_eq!((rate.factor, twins.len()), (0.0, 1));
    let modes = [&rate.modes, &twins[0].modes];
    assert!(modes.contains(&&vec![SLIP, ContactMode::Stick]) && modes.contains(&&vec![ContactMode::Stick, SLIP]));
}
