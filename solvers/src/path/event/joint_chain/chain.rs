//! Responses of all joints of the chain to the redundants and the load, updated when points change their modes.

use super::factors::{Factor, Factors};
use super::joint::joints;
use super::rates::ChainRates;
use super::redundants::{MOST_WEAK, Open, closing};
use super::sections::Sections;
use crate::contact::mode::{ContactMode, parts};
use crate::linear::dense::{add_outer, add_product};
use crate::path::event::piece::rates::Rates;
use crate::path::system::{Load, System};
use crate::settings::SETTINGS;
use nalgebra::{DMatrix, DVector, Matrix3xX, Vector3};
use voussoir_core::path::PathProblem;

/// Number of changes of modes after which everything is factorised again.
const CHANGES: usize = 1000;
/// Number of simultaneous changes above which a new factorisation is cheaper.
const AT_ONCE: usize = 24;

/// A chain of joints in the present modes.
pub struct JointChain {
    /// The sections of the joints.
    sections: Sections,
    factors: Factors,
    /// Joint of every contact point, and position in the joint.
    places: Vec<(usize, usize)>,
    modes: Vec<ContactMode>,
    load: LoadStatics,
    columns: Columns,
    /// Rates with λ̇ = 1. Each change of modes corrects them, so that they keep their accuracy.
    rates: Option<ChainRates>,
    updates: Updates,
}

#[derive(Default)]
struct LoadStatics {
    /// R about the centre of every joint as functions of (X, s).
    resultants: Vec<Matrix3xX<f64>>,
    /// The load step of this load.
    step: Option<usize>,
}

/// Responses of every joint.
#[derive(Default)]
struct Columns {
    /// Responses to (X, s) and to the twists of weak joints.
    responses: Vec<DMatrix<f64>>,
    /// Joints with a separate twist, in the order of its columns.
    weak: Vec<usize>,
}

/// The age of the factors.
#[derive(Default)]
struct Updates {
    /// True if there are factors.
    ready: bool,
    /// Number of changes of modes since the last factorisation.
    changes: usize,
    /// Number of factorisations of all joints.
    factorisations: u64,
}

impl JointChain {
    /// Creates the chain of a problem. `None` if its joints do not form chains.
    pub fn new(system: &System, problem: &PathProblem) -> Option<Self> {
        let sections = Sections::new(system, problem)?;
        let (joints, places) = joints(system, &sections)?;
        Some(JointChain {
            sections,
            factors: Factors { all: joints.into_iter().map(Factor::new).collect() },
            places,
            modes: Vec::new(),
            load: LoadStatics::default(),
            columns: Columns::default(),
            rates: None,
            updates: Updates::default(),
        })
    }

    /// Returns the number of joints.
    pub fn joints(&self) -> usize {
        self.factors.all.len()
    }

    /// Returns true if two points of each joint stick in given modes, so that each motion deforms a joint.
    pub fn is_stiff(&self, modes: &[ContactMode]) -> bool {
        self.factors.all.iter().all(|factor| !factor.joint.is_weak(modes))
    }

    /// Returns the number of factorisations of all joints.
    pub fn factorisations(&self) -> u64 {
        self.updates.factorisations
    }

    /// Forgets the load, before another one is applied.
    pub fn forget_load(&mut self) {
        self.load.step = None;
    }

    /// Sets the modes of the points. `None` if the equations are singular.
    pub fn set_modes(&mut self, system: &System, (step, load): (usize, &Load), modes: &[ContactMode]) -> Option<()> {
        if self.load.step != Some(step) {
            let resultants = self.sections.resultants(&load.wrench);
            let section = |f: &Factor| self.sections.all[f.joint.section].statics(&resultants[f.joint.section]);
            self.load.resultants = self.factors.all.iter().map(section).collect();
            (self.load.step, self.rates) = (Some(step), None);
            if self.updates.ready {
                self.respond_to(load);
            }
        }
        if !self.updates.ready {
            return self.factorise(system, load, modes);
        }
        let changed: Vec<usize> = (0..modes.len()).filter(|c| modes[*c] != self.modes[*c]).collect();
        if changed.len() > AT_ONCE || self.updates.changes + changed.len() > CHANGES {
            return self.factorise(system, load, modes);
        }
        for c in changed {
            if self.set_mode(system, load, c, modes[c]).is_none() {
                return self.factorise(system, load, modes);
            }
        }
        Some(())
    }

    /// Factorises everything in given modes. `None` if the equations are singular.
    pub fn factorise(&mut self, system: &System, load: &Load, modes: &[ContactMode]) -> Option<()> {
        self.updates.factorisations += 1;
        (self.updates.changes, self.updates.ready, self.rates) = (0, false, None);
        self.modes = modes.to_vec();
        for factor in &mut self.factors.all {
            factor.rows = factor.joint.rows(system, modes)?;
            factor.weak = factor.joint.is_weak(modes);
        }
        self.columns.weak = (0..self.joints()).filter(|e| self.factors.all[*e].weak).collect();
        if self.columns.weak.len() > MOST_WEAK {
            return None;
        }
        self.factors.factorise()?;
        self.respond_to(load);
        self.updates.ready = true;
        Some(())
    }

    /// Computes all responses in the present modes.
    fn respond_to(&mut self, load: &Load) {
        let n = 3 * self.sections.cycles + 1;
        let columns = n + 3 * self.columns.weak.len();
        let mut right = Vec::with_capacity(self.joints());
        for (e, (factor, statics)) in self.factors.all.iter().zip(&self.load.resultants).enumerate() {
            let m = 2 * factor.joint.contacts.len();
            let mut own = DMatrix::zeros(m + 3, columns);
            for (p, (c, rows)) in factor.joint.contacts.iter().zip(&factor.rows).enumerate() {
                let gap = load.gap[*c];
                (0..2).for_each(|i| own[(2 * p + i, n - 1)] = -(rows[i][2] * gap[0] + rows[i][3] * gap[1]));
            }
            own.view_mut((m, 0), (3, n)).copy_from(statics);
            if let Some(w) = self.columns.weak.iter().position(|w| *w == e) {
                (0..3).for_each(|i| own[(m + i, n + 3 * w + i)] = -factor.joint.spring[i]);
            }
            right.push(own);
        }
        self.columns.responses = self.factors.solve(right.clone());
        self.refine_responses(right);
    }

    /// Refines all responses by one step.
    fn refine_responses(&mut self, mut right: Vec<DMatrix<f64>>) {
        let mut gap = Vec::new();
        for (e, factor) in self.factors.all.iter().enumerate() {
            let m = 2 * factor.joint.contacts.len();
            for j in 0..right[e].ncols() {
                let column = |e: usize| column(&self.columns.responses[e], j);
                let own = column(e);
                factor.joint.set_gaps(&mut gap, e, &column);
                for (p, rows) in factor.rows.iter().enumerate() {
                    let left = left_of(rows, pair(own, p), pair(&gap, p));
                    (0..2).for_each(|i| right[e][(2 * p + i, j)] += left[i]);
                }
                for i in 0..3 {
                    let twist = if factor.weak { factor.joint.spring[i] * own[m + i] } else { 0.0 };
                    right[e][(m + i, j)] -= factor.joint.resultant(i, own) - twist;
                }
            }
        }
        let added = self.factors.solve(right);
        self.columns.responses.iter_mut().zip(&added).for_each(|(response, added)| *response += added);
    }

    fn set_mode(&mut self, system: &System, load: &Load, c: usize, mode: ContactMode) -> Option<()> {
        let (e, p) = self.places[c];
        self.updates.changes += 1;
        self.modes[c] = mode;
        if !self.factors.all[e].weak && self.factors.all[e].joint.is_weak(&self.modes) {
            self.set_weak(e)?;
        }
        let rows = system.rows(c, mode)?;
        self.factors.set_rows(e, p, rows)?;
        let columns = self.columns.responses[e].ncols();
        let mut left = DMatrix::zeros(2, columns);
        for j in 0..columns {
            let mut gap = self.factors.all[e].joint.gap(e, p, &|e: usize| column(&self.columns.responses[e], j));
            if j == 3 * self.sections.cycles {
                (0..2).for_each(|i| gap[i] += load.gap[c][i]);
            }
            let force = pair(column(&self.columns.responses[e], j), p);
            left.column_mut(j).copy_from_slice(&left_of(&rows, force, gap));
        }
        let kept = self.rates.as_ref().map(|rates| {
            let gap = self.factors.all[e].joint.gap(e, p, &|e: usize| &rates.own[e]);
            let gap = [gap[0] + load.gap[c][0], gap[1] + load.gap[c][1]];
            left_of(&rows, pair(&rates.own[e], p), gap)
        });
        self.respond(e, 2 * p, &left, kept.as_ref().map_or(&[], |kept| kept));
        if matches!(mode, ContactMode::Open | ContactMode::Corner(..)) {
            (0..columns).for_each(|j| (0..2).for_each(|i| self.columns.responses[e][(2 * p + i, j)] = 0.0));
            self.rates.iter_mut().for_each(|rates| rates.own[e][2 * p..2 * p + 2].fill(0.0));
        }
        Some(())
    }

    /// Adds the response to right-hand sides of some rows of a joint to all columns, and to the rates if any are
    /// `kept`.
    fn respond(&mut self, e: usize, first: usize, left: &DMatrix<f64>, kept: &[f64]) {
        let window = self.factors.respond(e, first, left.nrows());
        let responses = self.columns.responses[window.first..].iter_mut().zip(&window.columns);
        let rows = left.transpose();
        responses.for_each(|(response, columns)| add_outer(response, columns, &rows));
        if let (Some(rates), false) = (&mut self.rates, kept.is_empty()) {
            let own = rates.own[window.first..].iter_mut().zip(&window.columns);
            own.for_each(|(own, columns)| add_product(own, columns, kept));
        }
    }

    /// Gives a joint a separate twist.
    fn set_weak(&mut self, e: usize) -> Option<()> {
        if self.columns.weak.len() == MOST_WEAK {
            return None;
        }
        self.factors.set_weak(e)?;
        let (m, spring) = (2 * self.factors.all[e].joint.contacts.len(), self.factors.all[e].joint.spring);
        let columns = self.columns.responses[e].ncols();
        let mut left = DMatrix::zeros(3, columns + 3);
        for i in 0..3 {
            (0..columns).for_each(|j| left[(i, j)] = spring[i] * self.columns.responses[e][(m + i, j)]);
            left[(i, columns + i)] = -spring[i];
        }
        for response in &mut self.columns.responses {
            *response = std::mem::replace(response, DMatrix::zeros(0, 0)).insert_columns(columns, 3, 0.0);
        }
        self.respond(e, m, &left, &[]);
        if let Some(rates) = &mut self.rates {
            let twist = &rates.own[e][m..];
            rates.share = DVector::from_iterator(columns + 3, rates.share.iter().chain(twist).copied());
        }
        self.columns.weak.push(e);
        Some(())
    }

    /// Computes the rates of the joints in the present modes with λ̇ = 1. `None` near a mechanism.
    pub fn find_rates(&mut self) -> Option<()> {
        if let Some(mut rates) = self.rates.take() {
            let before = rates.size();
            let share = self.closing(&Open::Corrected(&rates))?;
            rates.add(&self.columns.responses, share);
            rates.unchecked = rates.unchecked.saturating_add(1);
            if before <= SETTINGS.cancels * rates.size() {
                self.rates = Some(rates);
                return Some(());
            }
        }
        let share = self.closing(&Open::Load)?;
        let own = self.columns.responses.iter().map(|b| vec![0.0; b.nrows()]).collect();
        let mut rates = ChainRates { own, share: DVector::zeros(share.len()), unchecked: usize::MAX };
        rates.add(&self.columns.responses, share);
        self.rates = Some(rates);
        Some(())
    }

    fn closing(&self, open: &Open) -> Option<DVector<f64>> {
        closing(&self.sections, &self.factors.all, &self.columns.responses, &self.columns.weak, open)
    }

    /// Returns the number of changes of modes since the rates were last examined. `None` without rates.
    pub fn unchecked(&self) -> Option<usize> {
        self.rates.as_ref().map(|rates| rates.unchecked)
    }

    /// Returns the rates as those of the whole system; gaps of points that stick are zero.
    pub fn rates(&self, system: &System, load: &Load) -> Option<Rates> {
        let rates = self.rates.as_ref()?;
        let (mut gaps, mut all) = (vec![[0.0; 2]; system.contacts], Vec::new());
        for (e, factor) in self.factors.all.iter().enumerate() {
            let contacts = &factor.joint.contacts;
            let own = |e: usize| rates.own[e].as_slice();
            let moving = contacts.iter().enumerate().filter(|(_, c)| self.modes[**c] != ContactMode::Stick);
            if 2 * moving.clone().count() <= contacts.len() {
                moving.for_each(|(p, c)| gaps[*c] = factor.joint.gap(e, p, &own));
            } else {
                factor.joint.set_gaps(&mut all, e, &own);
                moving.for_each(|(p, c)| gaps[*c] = pair(&all, p));
            }
            contacts.iter().filter(|c| load.opens && self.modes[**c] != ContactMode::Stick).for_each(|c| {
                (0..2).for_each(|i| gaps[*c][i] += load.gap[*c][i]);
            });
        }
        Some(Rates { x: self.unknowns(system, &rates.own), factor: 1.0, gaps, worst: 0.0, refinements: 0 })
    }

    /// Returns the greatest residual of the resultants. A correction that is much smaller than a later step may leave a
    /// larger one than that step may.
    pub fn unbalanced(&self) -> f64 {
        let Some(rates) = &self.rates else { return f64::INFINITY };
        let mut worst = 0.0f64;
        for ((factor, statics), own) in self.factors.all.iter().zip(&self.load.resultants).zip(&rates.own) {
            for i in 0..3 {
                worst = worst.max((given(statics, i, &rates.share) - factor.joint.resultant(i, own)).abs());
            }
        }
        worst
    }

    /// Returns the worst relative residual of the rates, and the residual of the equations of every joint. `sizes`: of
    /// forces and motions.
    pub fn examined(&self, load: &Load, [forces, motions]: [f64; 2]) -> Option<(f64, Vec<DMatrix<f64>>)> {
        let rates = self.rates.as_ref()?;
        let (mut worst, mut gap) = ([0.0f64; 2], Vec::new());
        let mut left = Vec::with_capacity(rates.own.len());
        for (e, factor) in self.factors.all.iter().enumerate() {
            let (joint, own) = (&factor.joint, &rates.own[e]);
            let m = 2 * joint.contacts.len();
            joint.set_gaps(&mut gap, e, &|e: usize| rates.own[e].as_slice());
            gap.iter_mut().zip(joint.contacts.iter().flat_map(|c| load.gap[*c])).for_each(|(g, load)| *g += load);
            let mut all = vec![0.0; m + 3];
            for (p, rows) in factor.rows.iter().enumerate() {
                for (i, [by_force, by_gap]) in parts(rows, pair(own, p), pair(&gap, p)).into_iter().enumerate() {
                    worst = [worst[0].max(by_force.abs()), worst[1].max(by_gap.abs())];
                    all[2 * p + i] = -(by_force + by_gap);
                }
            }
            for i in 0..3 {
                all[m + i] = given(&self.load.resultants[e], i, &rates.share) - joint.resultant(i, own);
                worst[0] = worst[0].max(all[m + i].abs());
            }
            left.push(DMatrix::from_vec(m + 3, 1, all));
        }
        Some(((worst[0] / forces).max(worst[1] / motions), left))
    }

    /// Corrects the rates by the residual of the equations. Returns the previous rates. `None` near a mechanism.
    pub fn refine(&mut self, left: Vec<DMatrix<f64>>) -> Option<ChainRates> {
        let before = self.rates.clone()?;
        let added = self.factors.solve(left);
        let share = self.closing(&Open::Refined(&before.own, &added))?;
        let rates = self.rates.as_mut()?;
        rates.own.iter_mut().zip(&added).for_each(|(own, added)| own.iter_mut().zip(added).for_each(|(o, a)| *o += a));
        rates.add(&self.columns.responses, share);
        Some(before)
    }

    /// Replaces the present rates; `None` removes them.
    pub fn set_rates(&mut self, rates: Option<ChainRates>) {
        self.rates = rates;
    }

    /// Records that the present rates have been examined, with this number of corrections counted.
    pub fn checked(&mut self, unchecked: usize) {
        self.rates.iter_mut().for_each(|rates| rates.unchecked = unchecked);
    }

    /// Returns all unknowns of the system from the unknowns of the joints.
    fn unknowns(&self, system: &System, own: &[Vec<f64>]) -> Vec<f64> {
        let mut x = vec![0.0; system.size()];
        let mut twists = vec![Vector3::zeros(); own.len()];
        for (factor, own) in self.factors.all.iter().zip(own) {
            let m = 2 * factor.joint.contacts.len();
            for (p, c) in factor.joint.contacts.iter().enumerate() {
                x[2 * c..2 * c + 2].copy_from_slice(&own[2 * p..2 * p + 2]);
            }
            twists[factor.joint.section] = Vector3::new(own[m], own[m + 1], own[m + 2]);
        }
        for (b, motion) in self.sections.motions(&twists).into_iter().enumerate() {
            x[2 * system.contacts + 3 * b..][..3].copy_from_slice(&motion);
        }
        x
    }
}

/// Returns the residual of the two equations of a point for a force and a gap.
fn left_of(rows: &[[f64; 4]; 2], force: [f64; 2], gap: [f64; 2]) -> [f64; 2] {
    parts(rows, force, gap).map(|[by_force, by_gap]| -(by_force + by_gap))
}

/// Returns the two components of a point of a joint.
fn pair(of: &[f64], point: usize) -> [f64; 2] {
    [of[2 * point], of[2 * point + 1]]
}

/// Returns a component of the resultant for given redundants and load.
fn given(statics: &Matrix3xX<f64>, i: usize, share: &DVector<f64>) -> f64 {
    (0..statics.ncols()).map(|j| statics[(i, j)] * share[j]).sum()
}

fn column(columns: &DMatrix<f64>, j: usize) -> &[f64] {
    &columns.as_slice()[columns.nrows() * j..columns.nrows() * (j + 1)]
}
