//! The step problem: unknowns and their units, states, increments, rates.
//!
//! Unknowns (r of all contact points, q of the free bodies, λ), each in its unit: force F, the size
//! of the loads; displacement U = F × mean compliance; rotation U / length; factor Λ.

use super::inelastic::Inner;
use super::kinematics::{Curvature, Kinematics, Loads, Slopes};
use super::response::{Answers, Local, Responses};
use crate::contact::mode::ContactMode as Regime;
use crate::contact::yield_polygon::YieldPolygon as Polygon;
use voussoir_core::limit::Counters;
use voussoir_core::path::{Continuation, Increment, Loading, PathProblem};

/// Units of the unknowns.
#[derive(Debug, Clone, Copy)]
pub(super) struct Units {
    pub force: f64,
    pub displacement: f64,
    pub length: f64,
    pub factor: f64,
}

/// A state with its history.
#[derive(Debug, Clone)]
pub(super) struct State {
    pub force: Vec<[f64; 2]>,
    pub motion: Vec<[f64; 3]>,
    pub factor: f64,
    pub gap: Vec<[f64; 2]>,
    pub regime: Vec<Regime>,
    /// s: irreversible gap.
    pub slip: Vec<[f64; 2]>,
    /// What laws of tractions from gaps say, with their history.
    pub answers: Answers,
    /// Bodies whose material yields, by body.
    pub blocks: Vec<Option<Inner>>,
}

impl State {
    /// Whether a block yields in the step that ends here.
    pub fn yields(&self) -> bool {
        self.blocks.iter().flatten().any(|inner| inner.linear.yielding > 0)
    }
}

/// Rate of a state per unit of its control.
#[derive(Debug, Clone)]
pub(super) struct Rate {
    pub force: Vec<[f64; 2]>,
    pub motion: Vec<[f64; 3]>,
    pub factor: f64,
    pub gap: Vec<[f64; 2]>,
}

impl Rate {
    pub fn scaled(&self, by: f64) -> Rate {
        Rate {
            force: self.force.iter().map(|r| r.map(|x| x * by)).collect(),
            motion: self.motion.iter().map(|q| q.map(|x| x * by)).collect(),
            factor: self.factor * by,
            gap: self.gap.iter().map(|g| g.map(|x| x * by)).collect(),
        }
    }
}

/// What fixes a step.
pub(super) enum Control<'a> {
    /// λ itself.
    Factor(f64),
    /// c(increment) = length.
    Strategy { strategy: &'a dyn Continuation, previous: Option<Increment>, length: f64 },
    /// Weighted gaps.
    Gaps { local: &'a Local, length: f64 },
    /// weight × Δλ + the displacement that λ works on = length, in units (small displacements).
    Spring { weight: f64, length: f64 },
}

/// The present load step on top of what earlier ones left.
#[derive(Clone)]
pub(super) struct Loaded<'a> {
    pub earlier: Vec<(f64, &'a Loading)>,
    pub growing: &'a Loading,
    pub start: f64,
}

impl<'a> Loaded<'a> {
    pub fn at(&self, factor: f64) -> Loads<'a> {
        let mut parts = self.earlier.clone();
        parts.push((factor - self.start, self.growing));
        Loads { parts }
    }
}

pub(super) struct Model<'a> {
    pub problem: &'a PathProblem,
    pub kinematics: Kinematics<'a>,
    pub polygons: Vec<Polygon>,
    /// For each contact point the index of its polygon.
    pub polygon_of: Vec<Option<usize>>,
    pub responses: Responses,
    pub units: Units,
    /// Own compliance of every contact point, normal and tangential \[m/N\].
    pub compliance: Vec<[f64; 2]>,
    /// Index among the free bodies.
    pub free: Vec<Option<usize>>,
    pub bodies_free: usize,
    pub counters: Counters,
    pub loaded: Loaded<'a>,
    /// Greatest relative residual of each iteration of the last step that was tried.
    pub residuals: Vec<f64>,
    /// Whether Newton's method may resort to a line search.
    pub searches: bool,
    /// Undeformed bodies whose material yields.
    blocks: Vec<Option<Inner>>,
    /// Second derivatives with small displacements, of the present load step.
    pub(super) constant: Option<std::rc::Rc<Curvature>>,
    pub(super) factorised: super::system::SparseLdlt,
}

/// Why a step was not found.
#[derive(Debug, Clone)]
pub(super) struct Refusal {
    pub why: String,
    /// Contact points that kept changing.
    pub restless: Vec<usize>,
}

impl<'a> Model<'a> {
    pub fn new(problem: &'a PathProblem, finite: bool) -> Result<Self, String> {
        let (mut mean, mut count) = (0.0, 0);
        let compliance: Vec<[f64; 2]> = problem
            .contacts
            .iter()
            .map(|c| {
                let mut own = c.compliance;
                for side in [c.minus, c.plus] {
                    if let (Some(slot), Some(flexibility)) = (side.slot, &problem.bodies[side.body].flexibility) {
                        let block = flexibility.fixed_view::<2, 2>(2 * slot, 2 * slot);
                        own[0] += (block * c.normal).dot(&c.normal);
                        own[1] += (block * c.tangent).dot(&c.tangent);
                    }
                }
                own
            })
            .collect();
        let responses = Responses::new(problem);
        let untouched = responses.update(&vec![[0.0; 2]; problem.contacts.len()], &problem.untouched())?;
        let compliance: Vec<[f64; 2]> = compliance
            .into_iter()
            .enumerate()
            .map(|(c, own)| match untouched.points.get(c).filter(|_| responses.is(c)) {
                Some(point) => [0, 1].map(|k| {
                    let stiffness = -point.tangent[k][k] * problem.contacts[c].area;
                    own[k] + if stiffness > 0.0 { 1.0 / stiffness } else { 0.0 }
                }),
                None => own,
            })
            .collect();
        for c in compliance.iter().flatten().filter(|c| **c > 0.0) {
            mean += c;
            count += 1;
        }
        if count == 0 {
            return Err("nothing in the scene deforms: rigid blocks without joint compliance have no path before their collapse; limit analysis answers that".into());
        }
        mean /= f64::from(count);
        let mut free = vec![None; problem.bodies.len()];
        let mut bodies_free = 0;
        for (body, _) in problem.bodies.iter().enumerate().filter(|(_, b)| !b.held) {
            free[body] = Some(bodies_free);
            bodies_free += 1;
        }
        let size = |loading: &Loading| load_size(problem, loading);
        let sizes: Vec<f64> = problem.load_steps.iter().map(|d| size(&d.loading)).collect();
        let settlement = problem
            .load_steps
            .iter()
            .flat_map(|d| &d.loading.settlements)
            .map(|s| s.1[0].hypot(s.1[1]).max(s.1[2].abs() * problem.length))
            .fold(0.0, f64::max);
        let force = sizes.iter().copied().find(|s| *s > 0.0).unwrap_or(settlement / mean);
        let force = if force > 0.0 { force } else { 1.0 };
        let units = Units { force, displacement: force * mean, length: problem.length, factor: 1.0 };
        let (facets, polygon_of) = problem.shared_facets();
        let polygons = facets.into_iter().map(Polygon::new).collect();
        let loaded = Loaded { earlier: Vec::new(), growing: &problem.load_steps[0].loading, start: 0.0 };
        Ok(Model {
            kinematics: Kinematics::new(problem, finite),
            problem,
            polygons,
            polygon_of,
            responses,
            units,
            compliance,
            free,
            bodies_free,
            counters: Counters::new(),
            loaded,
            residuals: Vec::new(),
            searches: true,
            blocks: super::inelastic::undeformed(problem)?,
            constant: None,
            factorised: super::system::SparseLdlt::default(),
        })
    }

    /// Begins a load step.
    pub fn load(&mut self, loaded: Loaded<'a>) {
        let size = load_size(self.problem, loaded.growing);
        let settlement = loaded
            .growing
            .settlements
            .iter()
            .map(|s| s.1[0].hypot(s.1[1]).max(s.1[2].abs() * self.units.length))
            .fold(0.0, f64::max);
        self.units.factor = match (size, settlement) {
            (s, _) if s > 0.0 => self.units.force / s,
            (_, s) if s > 0.0 => self.units.displacement / s,
            _ => 1.0,
        };
        self.loaded = loaded;
        self.constant = None;
        self.factorised.forget();
    }

    pub fn count(&mut self, what: &str, by: u64) {
        *self.counters.entry(what.into()).or_default() += by;
    }

    pub fn size(&self) -> usize {
        2 * self.problem.contacts.len() + 3 * self.bodies_free + 1
    }

    pub fn finite(&self) -> bool {
        self.kinematics.finite
    }

    /// Whether flow is associated everywhere: then every step is a monotone problem.
    pub fn monotone(&self) -> bool {
        self.piecewise_linear() && self.polygons.iter().all(|law| !law.is_non_associated())
    }

    /// Whether with small displacements every law is one of facets.
    pub fn piecewise_linear(&self) -> bool {
        self.responses.is_empty() && self.blocks.iter().all(Option::is_none)
    }

    /// A state reached from nothing, all of it times a share.
    pub fn in_proportion(&self, state: &State, share: f64) -> State {
        let mut state = state.clone();
        state.force.iter_mut().flatten().for_each(|r| *r *= share);
        state.motion.iter_mut().flatten().for_each(|q| *q *= share);
        state.gap.iter_mut().flatten().for_each(|g| *g *= share);
        state.factor *= share;
        state
    }

    /// Forces and a factor that are rounding of the loads become nothing (small displacements).
    pub fn clean(&self, state: &mut State, start: f64) {
        let u = self.units;
        let largest = state.force.iter().flatten().fold(0.0, |a: f64, r| a.max(r.abs()));
        if self.loaded.earlier.is_empty()
            && largest <= 1e-10 * u.force
            && (state.factor - start).abs() <= 1e-10 * u.factor
        {
            state.force.fill([0.0; 2]);
            state.factor = start;
        }
    }

    pub fn undeformed(&self) -> State {
        let points = self.problem.contacts.len();
        let motion = vec![[0.0; 3]; self.problem.bodies.len()];
        let mut state = State {
            force: vec![[0.0; 2]; points],
            gap: self.problem.contacts.iter().map(|c| [c.gap, 0.0]).collect(),
            motion,
            factor: 0.0,
            regime: vec![Regime::Stick; points],
            slip: vec![[0.0; 2]; points],
            answers: Answers { memory: self.problem.untouched(), ..Answers::default() },
            blocks: self.blocks.clone(),
        };
        // The update of untouched joints has succeeded in `new`.
        if let Ok(answers) = self.responses.update(&state.gap, &state.answers.memory) {
            state.answers = answers;
        }
        state
    }

    /// The facets of a contact point, where its law has that form.
    pub fn law(&self, contact: usize) -> Option<&Polygon> {
        self.polygon_of[contact].map(|law| &self.polygons[law])
    }

    /// Motions with the held bodies where their settlements put them.
    pub fn settle(&self, motion: &mut [[f64; 3]], factor: f64) {
        let settled = self.loaded.at(factor).settled(motion.len());
        for (body, motion) in motion.iter_mut().enumerate() {
            if self.free[body].is_none() {
                *motion = settled[body];
            }
        }
    }

    pub fn slopes(&self, state: &State) -> Slopes {
        self.kinematics.slopes(&state.force, &state.motion, &self.loaded.at(state.factor), &state.blocks)
    }

    pub fn curvature(&mut self, state: &State, slopes: &Slopes) -> std::rc::Rc<Curvature> {
        let yields = state.yields();
        if let Some(constant) = self.constant.as_ref().filter(|_| !yields) {
            return constant.clone();
        }
        let loads = self.loaded.at(state.factor);
        let curvature = self.kinematics.curvature(&state.force, &state.motion, &loads, slopes, &state.blocks);
        let curvature = std::rc::Rc::new(curvature);
        if !self.finite() && !yields {
            self.constant = Some(curvature.clone());
        }
        curvature
    }

    /// Column of a global index, and its unit; `None` for held bodies.
    pub fn column(&self, index: usize) -> Option<(usize, f64)> {
        let base = 2 * self.problem.contacts.len();
        if index < base {
            return Some((index, self.units.force));
        }
        let (body, k) = ((index - base) / 3, (index - base) % 3);
        let unit = if k == 2 { self.units.displacement / self.units.length } else { self.units.displacement };
        self.free[body].map(|free| (base + 3 * free + k, unit))
    }

    /// Δg of a step at a contact point.
    pub fn step_gap(&self, start: &State, state: &State, contact: usize) -> [f64; 2] {
        [state.gap[contact][0] - start.slip[contact][0], state.gap[contact][1] - start.slip[contact][1]]
    }

    /// The irreversible gaps and the plastic strains of a step become history.
    pub fn keep(&self, start: &State, state: &mut State) {
        state.blocks.iter_mut().flatten().for_each(|inner| inner.base = inner.linear.end.clone());
        for c in 0..state.gap.len() {
            let gap = self.step_gap(start, state, c);
            state.slip[c] = start.slip[c];
            if let Some(law) = self.law(c) {
                let (kept, _) = law.irreversible(state.regime[c], gap);
                (0..2).for_each(|k| state.slip[c][k] += kept[k]);
            }
        }
    }
}

/// Σ|F| of a loading, weights of accelerated free bodies included \[N\].
pub(super) fn load_size(problem: &PathProblem, loading: &Loading) -> f64 {
    let forces: f64 = loading.forces.iter().map(|f| f.3.norm()).sum();
    let masses: f64 = problem.bodies.iter().filter(|b| !b.held).map(|b| b.mass).sum();
    forces + masses * loading.acceleration.norm()
}
