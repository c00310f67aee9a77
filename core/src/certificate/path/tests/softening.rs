//! A block that hangs on two points with a softening bond: its chain, its limit point, and forged rates.

use super::scenes::{point, structure};
use crate::certificate::path::chain::PathChain;
use crate::law::{Facet, InterfaceResponse, PointContext, TractionPoint, UpdateBranch, UpdateFailure};
use crate::model::geometry::Vec2;
use crate::path::{LawStep, PathProblem, PathRate, PathState, PointLaw, RateClaim, Responses, Witness};
use std::sync::Arc;

/// Stiffness \[Pa/m\], strength \[Pa\] and slope of the falling branch \[Pa/m\] in tension.
const BOND: [f64; 3] = [1e6, 20.0, 2e5];

/// Opening at the strength \[m\].
const PEAK: f64 = BOND[1] / BOND[0];

/// A bond that unloads to its origin; its state is its greatest opening. With a slope < 0 it hardens.
#[derive(Debug)]
struct Bond {
    slope: f64,
}

impl Bond {
    fn envelope(&self, opening: f64) -> f64 {
        if opening <= PEAK { BOND[0] * opening } else { (BOND[1] - self.slope * (opening - PEAK)).max(0.0) }
    }

    /// Returns the energy dissipated up to a greatest opening.
    fn dissipated(&self, opening: f64) -> f64 {
        let area = 0.5 * BOND[1] * PEAK + 0.5 * (BOND[1] + self.envelope(opening)) * (opening - PEAK);
        area - 0.5 * self.envelope(opening) * opening
    }
}

impl InterfaceResponse for Bond {
    fn state_size(&self) -> usize {
        1
    }

    fn initial_state(&self, state: &mut [f64]) {
        state[0] = PEAK;
    }

    fn state_names(&self) -> &'static [&'static str] {
        &["greatest opening [m]"]
    }

    fn respond_point(
        &self,
        gap: [f64; 2],
        _: &PointContext,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<TractionPoint, UpdateFailure> {
        new[0] = old[0].max(gap[0]);
        let secant = self.envelope(new[0]) / new[0];
        let normal = if gap[0] > old[0] { self.slope } else { -secant };
        Ok(TractionPoint {
            traction: [-secant * gap[0], -BOND[0] * gap[1]],
            tangent: [[normal, 0.0], [0.0, -BOND[0]]],
            branch: UpdateBranch::ELASTIC,
            stored: 0.5 * secant * gap[0] * gap[0] + 0.5 * BOND[0] * gap[1] * gap[1],
            dissipated: self.dissipated(new[0]) - self.dissipated(old[0]),
            supplied: 0.0,
        })
    }
}

/// A block of 10 N on two points, lifted by a force λ.
fn hanging(slope: f64) -> PathProblem {
    let law = PointLaw::Response(Arc::new(Bond { slope }));
    let at = |x: f64| point(Vec2::new(x, 0.0), Vec2::new(0.0, 1.0), law.clone(), [0.0; 2]);
    structure(Vec2::zeros(), vec![at(-1.0), at(1.0)], Vec2::new(0.0, 1.0))
}

/// The state in which both points have this opening.
fn opened(opening: f64, slope: f64) -> PathState {
    let pull = Bond { slope }.envelope(opening);
    PathState {
        load_step: 1,
        factor: 10.0 + 2.0 * pull,
        force: vec![[-pull, 0.0]; 2],
        gap: vec![[opening, 0.0]; 2],
        motion: vec![[0.0; 3], [0.0, opening, 0.0]],
        displacement: opening,
        ..PathState::default()
    }
}

fn weight() -> PathState {
    PathState {
        load_step: 0,
        factor: 1.0,
        force: vec![[5.0, 0.0]; 2],
        gap: vec![[-5e-6, 0.0]; 2],
        motion: vec![[0.0; 3], [0.0, -5e-6, 0.0]],
        displacement: 5e-6,
        ..PathState::default()
    }
}

fn chain(slope: f64, openings: &[f64]) -> PathChain {
    let mut chain = PathChain::new(Arc::new(hanging(slope)), false);
    chain.add(weight());
    openings.iter().for_each(|opening| chain.add(opened(*opening, slope)));
    chain
}

/// The rate with these velocities of both points; `stiff` is the slope of their forces.
fn rate(velocity: [f64; 2], stiff: [f64; 2]) -> PathRate {
    let force = [0, 1].map(|k| [-stiff[k] * velocity[k], 0.0]);
    PathRate {
        factor: -(force[0][0] + force[1][0]),
        force: force.into(),
        gap: velocity.map(|v| [v, 0.0]).into(),
        motion: vec![[0.0; 3], [0.0, 0.5 * (velocity[0] + velocity[1]), 0.5 * (velocity[1] - velocity[0])]],
    }
}

fn verdict(chain: &PathChain, state: &PathState, rate: PathRate) -> Result<(), String> {
    let witness = Witness { state: state.clone(), claim: RateClaim::Rate(rate) };
    chain.check_loading_set(state, &[&witness])
}

#[test]
fn a_softening_chain_follows_its_law() {
    let [_, _, slope] = BOND;
    let softens = [0.5 * PEAK, PEAK, 1.5 * PEAK, 2.0 * PEAK];
    assert_eq!(chain(slope, &softens).broken(), None);
    // A step over the peak loses energy, and an intact bond cannot follow a broken one.
    let jumps = chain(slope, &[0.5 * PEAK, 2.0 * PEAK]);
    assert!(jumps.broken().is_some_and(|why| why.contains("work")), "{:?}", jumps.broken());
    let back = chain(slope, &[PEAK, 2.0 * PEAK, PEAK]);
    assert!(back.broken().is_some_and(|why| why.contains("law of tractions")), "{:?}", back.broken());
    // A peak between two states is added between them.
    let mut passed = chain(slope, &[0.5 * PEAK, 0.999 * PEAK, 1.002 * PEAK]);
    assert_eq!(passed.broken(), None);
    passed.add_peak(&opened(PEAK, slope));
    assert_eq!(passed.states().filter(|state| state.factor == opened(PEAK, slope).factor).count(), 1);
    let states = passed.states().count();
    passed.add_peak(&opened(0.7 * PEAK, slope));
    assert_eq!(passed.states().count(), states);
}

/// The strength of a bond is a limit point of a loading set: both points soften, or one of them, and no rate of either
/// set raises the load.
#[test]
fn the_strength_of_a_bond_is_a_limit_point_of_a_loading_set() {
    let [stiff, _, slope] = BOND;
    let softening = chain(slope, &[0.5 * PEAK, PEAK]);
    let limit = opened(PEAK, slope);
    for (velocity, own) in [([1.0, 1.0], [-slope; 2]), ([2.0, 1.9], [-slope; 2])] {
        assert_eq!(verdict(&softening, &limit, rate(velocity, own)), Ok(()));
    }
    // Unloading proves nothing; a rate of zero size proves nothing.
    let unloads = verdict(&softening, &limit, rate([-1.0; 2], [stiff; 2]));
    assert!(unloads.clone().is_err_and(|why| why.contains("unload")), "{unloads:?}");
    assert!(verdict(&softening, &limit, rate([0.0; 2], [stiff; 2])).is_err());
    assert!(verdict(&softening, &limit, rate([f64::NAN, 1.0], [stiff; 2])).is_err());
    // Below the strength the load rises, whatever the witness claims.
    let before = opened(0.5 * PEAK, slope);
    assert!(verdict(&softening, &before, rate([1.0; 2], [-slope; 2])).is_err());
    assert!(verdict(&softening, &before, rate([-1.0; 2], [stiff; 2])).is_err());
    assert!(verdict(&softening, &opened(0.7 * PEAK, slope), rate([1.0; 2], [-slope; 2])).is_err());
}

/// A bond that hardens has no limit point at its kink.
#[test]
fn a_bond_that_hardens_has_no_limit_point() {
    let slope = -BOND[2];
    let hardening = chain(slope, &[0.5 * PEAK, PEAK, 1.5 * PEAK]);
    assert_eq!(hardening.broken(), None);
    for opening in [PEAK, 1.5 * PEAK] {
        let state = opened(opening, slope);
        for velocity in [[1.0, 1.0], [1.0, 0.5], [-1.0, -1.0], [1.0, -0.5], [1.0, -2.0]] {
            assert!(verdict(&hardening, &state, rate(velocity, [-slope; 2])).is_err(), "{opening} {velocity:?}");
        }
    }
}

/// Points of two laws in any order have the results and the states that each has alone; other points are zero.
#[test]
fn laws_are_asked_together_and_say_what_they_say_alone() {
    let [soft, hard] = [2e5, -1e5].map(|slope| Arc::new(Bond { slope }));
    let [a, b] = [&soft, &hard].map(|law| PointLaw::Response(law.clone()));
    let facets = PointLaw::Facets(Facet::friction(0.5, 0.0, 0.0).to_vec().into());
    let at = |(k, law): (usize, PointLaw)| point(Vec2::new(k as f64, 0.0), Vec2::new(0.0, 1.0), law, [0.0; 2]);
    let points = [a.clone(), b.clone(), facets, a, b].into_iter().enumerate().map(at).collect();
    let problem = structure(Vec2::zeros(), points, Vec2::new(0.0, 1.0));
    let gaps: Vec<[f64; 2]> = (1..=5).map(|k| [k as f64 * PEAK, 1e-6 * k as f64]).collect();
    let (before, step) = ([3.5 * PEAK; 4], LawStep::instant(&gaps, Vec::new()));
    let responses = Responses::new(&problem);
    let (found, after) = responses.update(&gaps, &before, &step).expect("finite results");
    let asked: Vec<(usize, [f64; 2])> = [4, 2, 0].map(|c| (c, gaps[c])).into();
    let some = responses.at(&asked, &before, &step);
    for (place, (contact, law)) in [(0, &soft), (1, &hard), (3, &soft), (4, &hard)].into_iter().enumerate() {
        let mut new = [0.0];
        let alone =
            law.respond_point(gaps[contact], &PointContext::default(), &before[..1], &mut new).expect("a result");
        assert_eq!((found[contact], after[place]), (alone, new[0]), "point {contact}");
    }
    assert_eq!((found[2], responses.count()), (TractionPoint::ZERO, 4));
    assert_eq!(some, [Some(found[4]), None, Some(found[0])]);
}
