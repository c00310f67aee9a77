//! Solves the modes' equations with factors of nearby equations: a few contact points have other modes (Sherman,
//! Morrison & Woodbury), or the state is slightly different, which refinement corrects.
//!
//! ```text
//! B x_0 = f     B Y = [e_i]     (1 + D Y) w = D x_0     x = x_0 − Y w     f ← f − A x
//! ```
//!
//! B: the factorised equations; A: the equations to solve; D: the difference A − B in the rows i of points with other
//! modes. If the residual does not decrease fast enough, the factors are too different.

use super::linearised::{all_kept, chain_rows, solve_linear};
use crate::linear::bordered::BorderedSystem;
use crate::linear::chain::{ChainFactors, ChainRows};
use crate::linear::factorised::Factorised;
use crate::linear::{inner, largest};
use crate::path::newton::model::equations::Equations;
use crate::path::newton::model::factors::{Kept, ModeEquations};
use crate::path::newton::model::state::State;
use crate::path::newton::model::system::StepSystem;
use crate::settings::SETTINGS;
use nalgebra::{DMatrix, DVector, Dyn, LU};
use std::collections::btree_map::Entry;
use std::rc::Rc;

/// Greatest number of points with other modes for which factors count as near.
const MAX_CHANGED_POINTS: usize = 6;
/// Greatest number of refinements.
const MAX_REFINEMENTS: usize = 8;

/// Factors, with the equations to solve.
struct Nearby<'k> {
    kept: &'k Kept,
    factors: &'k ChainFactors,
    bordered: BorderedSystem<ModeEquations>,
    control: &'k [f64],
    rows: ChainRows,
    /// Points with other modes.
    changed: Vec<usize>,
    /// Y, in the order of the rows of the changed points.
    responses: Vec<Vec<f64>>,
    /// 1 + D Y.
    small: Option<LU<f64, Dyn, Dyn>>,
}

/// The required accuracy of a solution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Accuracy {
    /// Sufficient for Newton's method and for signs of rates.
    Rough,
    /// To rounding.
    Fine,
}

/// Solves the modes' linear equations, with nearby factors if there are any, and returns true if they are solved.
pub fn solve(
    system: &mut StepSystem,
    state: &State,
    equations: &Rc<Equations>,
    (control, right): (&[f64], &[f64]),
    accuracy: Accuracy,
) -> Option<(Vec<f64>, bool)> {
    let left = if accuracy == Accuracy::Rough { SETTINGS.admissible } else { SETTINGS.ulps() };
    let found = solve_nearby(system, state, equations, (control, right), left);
    found.map(|x| (x, true)).or_else(|| solve_linear(system, state, equations, control, right))
}

/// Solves with the nearest factors. `None` if no factors are near enough.
fn solve_nearby(
    system: &mut StepSystem,
    state: &State,
    equations: &Rc<Equations>,
    (control, right): (&[f64], &[f64]),
    accuracy: f64,
) -> Option<Vec<f64>> {
    if !system.limits.nearby {
        return None;
    }
    let changed = |kept: &Kept| (0..state.mode.len()).filter(|c| kept.modes[*c] != state.mode[*c]).collect::<Vec<_>>();
    let serving = all_kept(system).filter(|kept| kept.held.serves(control));
    let counted = serving.map(|kept| (changed(kept), kept)).filter(|(changed, _)| changed.len() <= MAX_CHANGED_POINTS);
    let nearest = counted.min_by_key(|(changed, kept)| (!Rc::ptr_eq(&kept.equations, equations), changed.len()));
    let (changed, kept) = nearest.map(|(changed, kept)| (changed, kept.clone()))?;
    let ModeEquations::Chain(factors) = kept.held.equations() else { return None };
    let rows = chain_rows(system, state, equations);
    let found = Nearby::new(&kept, factors, control, rows, changed)?.solve(right, accuracy);
    system.count(if found.is_some() { "solved_nearby" } else { "not_nearby" }, 1);
    found
}

impl<'k> Nearby<'k> {
    fn new(
        kept: &'k Kept,
        factors: &'k ChainFactors,
        control: &'k [f64],
        rows: ChainRows,
        changed: Vec<usize>,
    ) -> Option<Self> {
        let bordered = BorderedSystem::new(kept.held.clone(), control)?;
        let (responses, small) = (Vec::new(), None);
        let mut own = Nearby { kept, factors, bordered, control, rows, changed, responses, small };
        own.responses = own.changed.iter().map(|c| own.respond(*c)).collect::<Option<Vec<_>>>()?.concat();
        let size = own.responses.len();
        let mut small = DMatrix::identity(size, size);
        for (j, response) in own.responses.iter().enumerate() {
            own.differences(response).iter().enumerate().for_each(|(i, value)| small[(i, j)] += value);
        }
        own.small = (size > 0).then(|| small.lu());
        Some(own)
    }

    /// Returns the columns of Y for the two rows of a point.
    fn respond(&self, contact: usize) -> Option<Vec<Vec<f64>>> {
        let mut known = self.kept.responses.borrow_mut();
        let mut columns = match known.entry(contact) {
            Entry::Occupied(found) => found.get().to_vec(),
            Entry::Vacant(place) => {
                let unit = |k: usize| {
                    let mut right = vec![0.0; self.control.len()];
                    right[2 * contact + k] = 1.0;
                    self.kept.held.equations().apply(&right)
                };
                place.insert([unit(0)?, unit(1)?]).to_vec()
            }
        };
        columns.iter_mut().for_each(|y| self.bordered.onto_control(y, 0, 0.0));
        Some(columns)
    }

    /// Returns D x.
    fn differences(&self, x: &[f64]) -> Vec<f64> {
        let of_point = |c: &usize| {
            let [own, before] = [self.rows.point(*c, x, true), self.factors.point(*c, x)];
            [own[0] - before[0], own[1] - before[1]]
        };
        self.changed.iter().flat_map(of_point).collect()
    }

    /// Solves once with the factors and D.
    fn apply(&self, right: &[f64]) -> Option<Vec<f64>> {
        let mut x = self.bordered.apply(right)?;
        let Some(small) = &self.small else { return Some(x) };
        let w = small.solve(&DVector::from_vec(self.differences(&x)))?;
        for (w, y) in w.iter().zip(&self.responses) {
            x.iter_mut().zip(y).for_each(|(x, y)| *x -= w * y);
        }
        Some(x)
    }

    fn solve(&self, right: &[f64], accuracy: f64) -> Option<Vec<f64>> {
        let aim = largest(right);
        let (mut x, mut rest, mut before) = (vec![0.0; right.len()], right.to_vec(), aim);
        for _ in 0..MAX_REFINEMENTS {
            let step = self.apply(&rest)?;
            x.iter_mut().zip(&step).for_each(|(x, step)| *x += step);
            rest = self.rows.left(right, &x);
            rest.push(right[right.len() - 1] - inner(self.control, &x));
            let now = largest(&rest);
            if now <= accuracy * aim {
                return Some(x);
            }
            if now.is_nan() || now > SETTINGS.contraction * before {
                // The residual may be rounding of the solution.
                return (now.min(before) <= accuracy * largest(&x)).then_some(x);
            }
            before = now;
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::super::linearised::factorised;
    use super::*;
    use crate::contact::mode::ContactMode;
    use crate::path::newton::model::loads::StagedLoads;
    use std::sync::Arc;
    use voussoir_core::law::Facet;
    use voussoir_core::limit::Counters;
    use voussoir_core::model::geometry::Vec2;
    use voussoir_core::path::{
        Attachment, Contact, LoadStep, LoadStepEnd, Loading, PathBody, PathProblem, Period, PointLaw, Sliding,
    };
    use voussoir_core::random::Random;

    /// Two elastic blocks between two supports, three dry joints of two points.
    fn between_supports() -> PathProblem {
        let a = DMatrix::from_fn(8, 8, |i, j| ((7 * i + 3 * j * j + 1) as f64).sin());
        let flexibility = Arc::new((&a * a.transpose()) * 2e-9 + DMatrix::identity(8, 8) * 1e-9);
        let body = |x: f64, elastic: bool| PathBody {
            members: vec![0],
            pole: Vec2::new(x, 0.0),
            held: !elastic,
            mass: 0.0,
            points: [-0.5, 0.5].iter().flat_map(|dx| [-0.2, 0.2].map(|y| Vec2::new(x + dx, y))).collect(),
            flexibility: elastic.then(|| flexibility.clone()),
            inelastic: None,
        };
        let [left, right] = Facet::friction(0.5, 0.0, 0.2);
        let law = PointLaw::Facets(vec![Facet::opening(0.0), left, right].into());
        let contact = |joint: usize, end: usize| Contact {
            joint,
            position: Vec2::new(joint as f64, [-0.2, 0.2][end]),
            normal: Vec2::new(1.0, 0.0),
            tangent: Vec2::new(0.0, 1.0),
            minus: Attachment { body: joint, slot: (joint > 0).then_some(2 + end) },
            plus: Attachment { body: joint + 1, slot: (joint < 2).then_some(end) },
            area: 0.2,
            gap: 0.0,
            law: law.clone(),
            sliding: Sliding::middle(0.0),
            compliance: [1e-9, 2e-9],
        };
        let loading =
            Loading { forces: vec![(1, None, Vec2::new(0.5, 0.0), Vec2::new(1.0, -1e3))], ..Loading::default() };
        PathProblem {
            bodies: vec![body(-0.5, false), body(0.5, true), body(1.5, true), body(2.5, false)],
            body_of: vec![0, 1, 2, 3],
            contacts: (0..6).map(|c| contact(c / 2, c % 2)).collect(),
            load_steps: vec![LoadStep {
                stage: 0,
                gravity: false,
                loading,
                start: 0.0,
                end: LoadStepEnd::Factor(1.0),
                period: Period::default(),
            }],
            length: 2.0,
            span: 2.0,
            width: 1.0,
            counters: Counters::new(),
        }
    }

    /// Factors of other modes at another state give the solution of the equations' own factors; if they are too
    /// different, they give no solution.
    #[test]
    fn nearby_factors_solve_as_own_ones_do() {
        let problem = between_supports();
        let mut random = Random::from_state(3);
        let modes = [ContactMode::Open, ContactMode::Facet(1), ContactMode::Facet(2)];
        for (turn, least) in [(0.0, 100), (1e-6, 100), (1e-3, 1), (1.0, 0)] {
            let (mut solved, mut far) = (0, 0);
            for _ in 0..300 {
                let system = || {
                    let mut system = StepSystem::new(&problem, true).expect("a system");
                    let growing = &problem.load_steps[0].loading;
                    system.load(0, StagedLoads::new(Vec::new(), growing, 0.0));
                    system
                };
                let mut own = system();
                let mut start = own.undeformed();
                let unit = own.units();
                start
                    .force
                    .iter_mut()
                    .for_each(|r| *r = [-unit.force * (random.signed() + 0.3), unit.force * random.signed()]);
                start.factor = 0.5;
                let mut state = start.clone();
                state.motion[1..3].iter_mut().flatten().for_each(|q| *q += turn * random.signed());
                for _ in 0..2 {
                    let [c, mode] =
                        [6.0, 3.0].map(|most| ((0.5 * (random.signed() + 1.0) * most) as usize).min(most as usize - 1));
                    state.mode[c] = modes[mode];
                }
                let control: Vec<f64> = (0..own.size()).map(|_| random.signed()).collect();
                let right: Vec<f64> = (0..own.size()).map(|_| random.signed()).collect();
                let there = own.equations(&state);
                let Some((x, true)) = solve_linear(&mut own, &state, &there, &control, &right) else { continue };
                let mut other = system();
                let (here, there) = (other.equations(&start), other.equations(&state));
                factorised(&mut other, &start, &here, &control).expect("factors");
                match solve_nearby(&mut other, &state, &there, (&control, &right), SETTINGS.ulps()) {
                    Some(y) => {
                        let size = largest(&x);
                        let off = x.iter().zip(&y).fold(0.0, |a: f64, (x, y)| a.max((x - y).abs()));
                        assert!(off <= 1e-8 * size, "{turn}: {off:e} of {size:e}");
                        solved += 1;
                    }
                    None => far += 1,
                }
            }
            assert!(solved >= least && solved + far > 100, "{turn}: {solved} solved, {far} not");
        }
    }
}
