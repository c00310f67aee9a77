//! Pure functions of newton_path: loads in force, monitors, speeds.

use crate::path::newton::model::loads::StagedLoads;
use crate::path::newton::model::system::StepSystem;
use crate::path::newton::quantities::measure::fastest;
use crate::path::newton::quantities::monitors::resolve;
use crate::path::two_blocks::{assert_close, block, block_on, coulomb, live, pushed_at, settlement};
use voussoir_core::path::{Loading, Monitor};

fn accelerated(x: f64, y: f64) -> Loading {
    Loading { acceleration: [x, y].into(), ..Loading::default() }
}

/// At λ a load step has earlier loads whole and its own with λ − λ_start.
#[test]
fn the_growing_load_counts_from_its_start() {
    let (earlier, growing) = (accelerated(0.0, -10.0), accelerated(2.0, 0.0));
    let loads = StagedLoads::new(vec![(0.5, &earlier)], &growing, 1.0);
    let acceleration = loads.at(4.0).acceleration();
    assert_eq!([acceleration.x, acceleration.y], [6.0, -5.0]);
}

/// Settlements of all present loads are added: 2 (0.1, 0, 0) + 3 (0, 0, 0.2).
#[test]
fn settlements_add_up() {
    let (earlier, growing) = (settlement(0, [0.1, 0.0, 0.0]), settlement(0, [0.0, 0.0, 0.2]));
    let loads = StagedLoads::new(vec![(2.0, &earlier)], &growing, 0.0);
    let settled = loads.at(3.0).settled(2);
    [0.2, 0.0, 0.6].iter().zip(settled[0]).for_each(|(right, found)| assert_close(found, *right, 1e-15));
    assert_eq!(settled[1], [0.0; 3]);
}

/// The mean opening of a joint weighs points by their areas: 1/4 and 3/4.
#[test]
fn a_mean_opening_weighs_by_areas() {
    let mut problem = block(0.3, pushed_at(0.1));
    problem.contacts[1].area = 3.0;
    let weights = resolve(&problem, &[Monitor::Opening { joint: 0, at: None }]).expect("a joint");
    assert_eq!(weights[0].gaps, [(0, 0.25), (1, 0.75)]);
}

/// The opening at a share of a joint is interpolated between the two points beside it: at 0.6 of 0, 0.5, 1 with 0.8 and 0.2.
#[test]
fn an_opening_at_a_share_is_interpolated() {
    let problem = block_on(&[0.0, 0.5, 1.0], &coulomb(0.3, 0.0, 0.0), live(pushed_at(0.1)));
    let weights = resolve(&problem, &[Monitor::Opening { joint: 0, at: Some(0.6) }]).expect("a joint");
    let [(low, before), (high, after)] = weights[0].gaps[..] else { panic!("{weights:?}") };
    assert_eq!([low, high], [1, 2]);
    assert_close(before, 0.8, 1e-15);
    assert_close(after, 0.2, 1e-15);
}

/// A monitor of a block or a joint that does not exist is refused by its name.
#[test]
fn an_absent_monitor_is_refused() {
    let problem = block(0.3, pushed_at(0.1));
    let of = |monitor: Monitor| resolve(&problem, &[monitor]).expect_err("a refusal");
    assert!(of(Monitor::Opening { joint: 3, at: None }).contains("joint 3"));
    let displacement = Monitor::Displacement { block: 5, point: [0.0; 2], direction: [1.0, 0.0] };
    assert!(of(displacement).contains("block 5"));
}

/// A strategy has at most four monitors.
#[test]
fn five_monitors_are_too_many() {
    let problem = block(0.3, pushed_at(0.1));
    let opening = Monitor::Opening { joint: 0, at: None };
    assert!(resolve(&problem, &[opening; 4]).is_ok());
    assert!(resolve(&problem, &[opening; 5]).is_err());
}

/// The fastest body has the greatest |(u_x, u_y)| or |θ| L.
#[test]
fn the_fastest_body_translates_or_turns() {
    let mut problem = block(0.3, pushed_at(0.1));
    problem.length = 10.0;
    let system = StepSystem::new(&problem, false).expect("a system");
    assert_close(fastest(&system, &[[0.0; 3], [3.0, 4.0, 0.1]]), 5.0, 1e-15);
    assert_close(fastest(&system, &[[0.0; 3], [3.0, 4.0, -0.6]]), 6.0, 1e-15);
}
