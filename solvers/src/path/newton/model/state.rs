//! A state of a step, its history, and its rate along the path.

use super::blocks::YieldingBlock;
use super::geometry::Place;
use super::loads::Loads;
use super::tractions::TractionUpdates;
use crate::contact::mode::ContactMode;
use std::rc::Rc;

/// A state with its history.
#[derive(Debug, Clone)]
pub struct State {
    pub force: Vec<[f64; 2]>,
    pub motion: Vec<[f64; 3]>,
    pub factor: f64,
    pub gap: Vec<[f64; 2]>,
    pub mode: Vec<ContactMode>,
    /// s: irreversible gap.
    pub slip: Vec<[f64; 2]>,
    /// Responses of laws of tractions from gaps, with their history.
    pub updates: TractionUpdates,
    /// Bodies with yielding material, by body.
    pub blocks: Vec<Option<YieldingBlock>>,
}

impl State {
    /// Returns the point at which its derivatives are computed.
    pub fn place<'a>(&'a self, loads: &'a Loads<'a>) -> Place<'a> {
        Place { force: &self.force, motion: &self.motion, loads, blocks: &self.blocks }
    }

    /// Returns true if derivatives at another state are those at this one.
    pub fn is_at_place_of(&self, other: &State) -> bool {
        let same = |(a, b): (&Option<YieldingBlock>, &Option<YieldingBlock>)| match (a, b) {
            (Some(a), Some(b)) => Rc::ptr_eq(&a.linear, &b.linear),
            (None, None) => true,
            _ => false,
        };
        self.factor == other.factor
            && self.force == other.force
            && self.motion == other.motion
            && self.blocks.iter().zip(&other.blocks).all(same)
    }

    /// Returns true if the tangent of a block differs from its elastic stiffness.
    pub fn changes_stiffness(&self) -> bool {
        self.blocks.iter().flatten().any(|inner| inner.linear.changed)
    }

    /// Returns true if a block yields in the step that ends here.
    pub fn yields(&self) -> bool {
        self.blocks.iter().flatten().any(|inner| inner.linear.yielding > 0)
    }
}

/// Tangent of a state per unit of its control.
#[derive(Debug, Clone)]
pub struct Tangent {
    pub force: Vec<[f64; 2]>,
    pub motion: Vec<[f64; 3]>,
    pub factor: f64,
    pub gap: Vec<[f64; 2]>,
}

impl Tangent {
    pub fn scaled(&self, by: f64) -> Tangent {
        Tangent {
            force: self.force.iter().map(|r| r.map(|x| x * by)).collect(),
            motion: self.motion.iter().map(|q| q.map(|x| x * by)).collect(),
            factor: self.factor * by,
            gap: self.gap.iter().map(|g| g.map(|x| x * by)).collect(),
        }
    }
}

/// Returns a state moved by a share of a rate.
pub fn moved(state: &State, rate: &Tangent, share: f64) -> State {
    let mut guess = state.clone();
    for (r, dr) in guess.force.iter_mut().zip(&rate.force) {
        (0..2).for_each(|k| r[k] += share * dr[k]);
    }
    for (q, dq) in guess.motion.iter_mut().zip(&rate.motion) {
        (0..3).for_each(|k| q[k] += share * dq[k]);
    }
    guess.factor += share * rate.factor;
    guess
}
