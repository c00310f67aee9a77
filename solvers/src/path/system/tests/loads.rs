//! Loadings in units: wrenches about the poles, and gaps by settlements.

use super::super::Load;
use super::{system, uneven};
use crate::path::two_blocks::{assert_close, force, settlement, v};
use voussoir_core::model::geometry::cross;
use voussoir_core::path::Loading;

/// A force F at a point p is (F, (p − pole) × F) on its body.
#[test]
fn a_force_has_a_moment_about_the_pole() {
    let problem = uneven();
    let system = system(&problem);
    let (at, pushes) = (v(0.9, 0.2), v(2.0, -5.0));
    let load = Load::new(&system, &problem, &force(at, pushes));
    let moment = cross(at - problem.bodies[1].pole, pushes);
    for (found, right) in load.wrench[0].iter().zip([pushes.x, pushes.y, moment / problem.length]) {
        assert_close(found * system.units.force, right, 1e-14);
    }
    assert_eq!(load.wrench[1], [0.0; 3]);
    assert!(!load.opens && !load.settles);
}

/// An acceleration a acts on each body as m a at its pole, without a moment.
#[test]
fn an_acceleration_acts_at_the_poles() {
    let mut problem = uneven();
    problem.bodies[2].mass = 7.0;
    let system = system(&problem);
    let load = Load::new(&system, &problem, &Loading { acceleration: v(0.5, -10.0), ..Loading::default() });
    for (wrench, mass) in load.wrench.iter().zip([2.0, 7.0]) {
        for (found, right) in wrench.iter().zip([0.5 * mass, -10.0 * mass, 0.0]) {
            assert_close(found * system.units.force, right, 1e-13);
        }
    }
}

/// A ground that moves by u and turns by θ opens its joints by −(u + θ × p) and no others.
#[test]
fn a_settlement_opens_the_joints_of_its_support() {
    let problem = uneven();
    let system = system(&problem);
    let [x, y, theta] = [2e-3, -1e-3, 4e-3];
    let load = Load::new(&system, &problem, &settlement(0, [x, y, theta]));
    for (contact, gap) in problem.contacts.iter().zip(&load.gap) {
        let p = contact.position;
        let moved = if contact.minus.body == 0 { v(x - theta * p.y, y + theta * p.x) } else { v(0.0, 0.0) };
        for (k, e) in [contact.normal, contact.tangent].iter().enumerate() {
            assert_close(gap[k] * system.units.displacement, -moved.dot(e), 1e-15);
        }
    }
    assert!(load.opens && load.settles);
    assert!(load.wrench.iter().flatten().all(|w| *w == 0.0));
}

/// A settlement of zero moves no support.
#[test]
fn a_settlement_of_nothing_does_not_settle() {
    let problem = uneven();
    let load = Load::new(&system(&problem), &problem, &settlement(0, [0.0; 3]));
    assert!(!load.settles && !load.opens && load.size == 0.0);
}

/// The opposite loading has the opposite wrenches and gaps, and the same size.
#[test]
fn the_opposite_loading() {
    let problem = uneven();
    let system = system(&problem);
    let mut loading = force(v(0.9, 0.2), v(2.0, -5.0));
    loading.settlements = vec![(0, [1e-3, 0.0, 0.0])];
    let load = Load::new(&system, &problem, &loading);
    let [same, opposite] = [false, true].map(|reversed| load.clone().reversed_if(reversed));
    assert_eq!((&same.wrench, &same.gap), (&load.wrench, &load.gap));
    let all =
        |load: &Load| -> Vec<f64> { load.wrench.iter().flatten().chain(load.gap.iter().flatten()).copied().collect() };
    all(&load).iter().zip(all(&opposite)).for_each(|(one, other)| assert_close(other, -one, 0.0));
    assert_eq!(opposite.size, load.size);
}
