//! The data of the system of a step: units, laws, loads, geometry; and cached evaluations.

use super::blocks::{YieldingBlock, undeformed};
use super::control::MonitorWeights;
use super::derivatives::Gradient;
use super::equations::Equations;
use super::factors::LastFactors;
use super::geometry::Geometry;
use super::kinematics::{gradient, hessian};
use super::limits::Limits;
use super::loads::StagedLoads;
use super::state::State;
use super::tractions::{TractionUpdates, update};
use crate::contact::mode::ContactMode;
use crate::contact::yield_polygon::YieldPolygon;
use crate::linear::condensed::Elimination;
use crate::path::system::{Load, System, Units};
use crate::settings::SETTINGS;
use std::cell::RefCell;
use std::collections::VecDeque;
use std::rc::Rc;
use voussoir_core::law::TractionPoint;
use voussoir_core::limit::Counters;
use voussoir_core::path::{LawStep, PathProblem, Responses};

/// Laws of the contact points.
pub struct Laws {
    /// Laws of facets, each stored once.
    pub polygons: Vec<YieldPolygon>,
    /// Index of the polygon of each contact point.
    pub polygon_of: Vec<Option<usize>>,
    /// Laws of tractions from gaps.
    pub responses: Responses,
    /// Undeformed bodies with yielding material.
    undeformed: Vec<Option<YieldingBlock>>,
}

/// Work and failures of the last steps, for reports only.
#[derive(Default)]
pub struct Report {
    pub counters: Counters,
    /// Number of iterations of Newton's method, compared with the budget of a load step.
    pub iterations: u64,
    /// Greatest relative residual of each iteration of the last attempted step.
    pub residuals: Vec<f64>,
    /// The reason of the last failure of a law or a block.
    pub failure: Option<String>,
}

/// Number of states with stored equations: the start and the end of a step, and between.
const MAX_EQUATIONS: usize = 4;

/// Results that are computed once for many iterations.
#[derive(Default)]
pub struct Cache {
    /// Gaps and balance of linear blocks with small displacements in the present load step.
    pub equations: Option<Rc<Equations>>,
    /// The last equations with finite displacements or yielding blocks, with their states; latest first.
    pub at: VecDeque<(State, Rc<Equations>)>,
    /// The last gradient, with its state.
    pub gradient: RefCell<Option<(State, Rc<Gradient>)>>,
    pub factors: LastFactors,
}

/// The system of a step.
pub struct StepSystem<'a> {
    pub problem: &'a PathProblem,
    pub geometry: Geometry<'a>,
    pub laws: Laws,
    pub limits: Limits,
    /// The problem in scaled units, with the unit of the growing factor.
    pub scaled: System,
    pub loads: StagedLoads<'a>,
    /// Index of the present load step.
    pub load_step: usize,
    pub cache: Cache,
    /// Monitors of the strategy.
    pub monitors: Vec<MonitorWeights>,
    pub report: Report,
    /// Relative tolerance of loads.
    pub tolerance: f64,
}

/// Returns the fields before the first load.
fn first_fields(problem: &PathProblem) -> Vec<(&str, f64)> {
    problem.load_steps.first().map_or_else(Vec::new, |step| problem.fields_at(0, step.start))
}

/// Returns the additional compliance of contact points with laws of tractions from gaps, before any motion.
fn softening(problem: &PathProblem, responses: &Responses) -> Result<Vec<[f64; 2]>, String> {
    let closed = vec![[0.0; 2]; problem.contacts.len()];
    // Without fields: a pressure of water may open a joint before any load presses it.
    let step = LawStep::instant(&closed, Vec::new());
    let untouched = update(responses, &closed, &problem.untouched(), &step)?;
    let of_point = |(point, c): (&TractionPoint, &voussoir_core::path::Contact)| {
        [0, 1].map(|k| {
            let stiffness = -point.tangent[k][k] * c.area;
            if stiffness > 0.0 { 1.0 / stiffness } else { 0.0 }
        })
    };
    Ok(untouched.points.iter().zip(&problem.contacts).map(of_point).collect())
}

impl<'a> StepSystem<'a> {
    pub fn new(problem: &'a PathProblem, finite: bool) -> Result<Self, String> {
        let responses = Responses::new(problem);
        let softening = softening(problem, &responses)?;
        let own = |c: usize| softening.get(c).copied().filter(|_| responses.is(c)).unwrap_or_default();
        let scaled = System::new(problem, own);
        if scaled.compliance.iter().flatten().all(|c| *c <= 0.0) {
            return Err("nothing in the scene deforms: rigid blocks without joint compliance have no path before their collapse; limit analysis answers that".into());
        }
        let geometry = Geometry::new(problem, finite);
        let limits = Limits::of(problem, finite, scaled.chain.is_some() && geometry.pattern.couples(), scaled.units);
        let mut cache = Cache::default();
        cache.factors.elimination = Elimination::along(scaled.chain.clone());
        let (facets, polygon_of) = problem.shared_facets();
        let polygons = facets.into_iter().map(YieldPolygon::new).collect();
        Ok(StepSystem {
            geometry,
            limits,
            problem,
            laws: Laws { polygons, polygon_of, responses, undeformed: undeformed(problem)? },
            scaled,
            loads: StagedLoads::new(Vec::new(), &problem.load_steps[0].loading, 0.0),
            load_step: 0,
            report: Report::default(),
            tolerance: SETTINGS.admissible,
            cache,
            monitors: Vec::new(),
        })
    }

    /// Returns the relative residual of a converged state. The error of a load is about the residual divided by the
    /// remaining stiffness. Residuals are therefore four orders of magnitude below the tolerance of loads, but not
    /// below rounding.
    pub fn found(&self) -> f64 {
        (SETTINGS.fine * self.tolerance).clamp(SETTINGS.rounding, SETTINGS.inequality())
    }

    /// Returns the units of the unknowns.
    pub fn units(&self) -> Units {
        self.scaled.units
    }

    /// Returns the number of unknowns.
    pub fn size(&self) -> usize {
        self.scaled.size() + 1
    }

    /// Starts a load step.
    pub fn load(&mut self, load_step: usize, loads: StagedLoads<'a>) {
        self.load_step = load_step;
        self.scaled.units.factor = self.scaled.units.of_factor(self.problem, loads.growing);
        self.loads = loads;
        self.cache.equations = None;
        self.cache.at.clear();
        self.cache.gradient.take();
        self.cache.factors.forget();
    }

    /// Adds to a counter of the work.
    pub fn count(&mut self, what: &str, by: u64) {
        *self.report.counters.entry(what.into()).or_default() += by;
    }

    /// Returns true with finite displacements: equilibrium in displaced positions.
    pub fn finite(&self) -> bool {
        self.geometry.finite
    }

    /// Returns true if the present load step moves supports and adds no load.
    pub fn settles(&self) -> bool {
        self.problem.load_size(self.loads.growing) == 0.0
    }

    /// With small displacements, sets forces and a factor within rounding to zero. Forces of bonds stay.
    pub fn drop_rounding(&self, state: &mut State) {
        let (u, start) = (self.scaled.units, self.loads.start);
        let largest = state.force.iter().flatten().fold(0.0, |a: f64, r| a.max(r.abs()));
        if self.loads.earlier.is_empty()
            && !self.finite()
            && self.laws.responses.is_empty()
            && largest <= 1e-10 * u.force
            && (state.factor - start).abs() <= 1e-10 * u.factor
        {
            state.force.fill([0.0; 2]);
            state.factor = start;
        }
    }

    /// Returns the state before any motion.
    pub fn undeformed(&self) -> State {
        let points = self.problem.contacts.len();
        let motion = vec![[0.0; 3]; self.problem.bodies.len()];
        let mut state = State {
            force: vec![[0.0; 2]; points],
            gap: self.problem.contacts.iter().map(|c| [c.gap, 0.0]).collect(),
            motion,
            factor: 0.0,
            mode: vec![ContactMode::Stick; points],
            slip: vec![[0.0; 2]; points],
            updates: TractionUpdates { memory: self.problem.untouched(), ..TractionUpdates::default() },
            blocks: self.laws.undeformed.clone(),
        };
        // The update of undeformed joints has succeeded in `new`.
        let step = LawStep::instant(&state.gap, first_fields(self.problem));
        if let Ok(updates) = update(&self.laws.responses, &state.gap, &state.updates.memory, &step) {
            state.updates = updates;
        }
        state
    }

    /// Returns the step of laws from a state to a factor of the present load step.
    pub fn law_step<'s>(&'s self, start: &'s State, factor: f64) -> LawStep<'s> {
        LawStep {
            previous_gap: &start.gap,
            time_step: self.problem.time_between((self.load_step, start.factor), (self.load_step, factor)),
            fields: self.problem.fields_at(self.load_step, factor),
            previous_fields: self.problem.fields_at(self.load_step, start.factor),
        }
    }

    /// Returns the step of laws from a state without duration.
    pub fn instant<'s>(&'s self, state: &'s State) -> LawStep<'s> {
        self.law_step(state, state.factor)
    }

    /// Returns the facets of a contact point, if its law has facets.
    pub fn law(&self, contact: usize) -> Option<&YieldPolygon> {
        self.laws.polygon_of[contact].map(|law| &self.laws.polygons[law])
    }

    /// Returns ρ of a contact point: the inverse of its own compliance \[N/m\].
    pub fn stiffness(&self, contact: usize) -> [f64; 2] {
        let mean = self.scaled.units.displacement / self.scaled.units.force;
        self.scaled.compliance[contact].map(|own| 1.0 / if own > 1e-9 * mean { own } else { mean })
    }

    /// Moves the held bodies to their settlements.
    pub fn settle(&self, motion: &mut [[f64; 3]], factor: f64) {
        let settled = self.loads.at(factor).settled(motion.len());
        for (body, motion) in motion.iter_mut().enumerate() {
            if self.scaled.free[body].is_none() {
                *motion = settled[body];
            }
        }
    }

    /// Returns the first derivatives of Π at a state.
    pub fn gradient(&self, state: &State) -> Rc<Gradient> {
        let mut last = self.cache.gradient.borrow_mut();
        if let Some((_, found)) = last.as_ref().filter(|(at, _)| at.is_at_place_of(state)) {
            return found.clone();
        }
        let loads = self.loads.at(state.factor);
        let found = Rc::new(gradient(&self.geometry, &state.place(&loads)));
        *last = Some((state.clone(), found.clone()));
        found
    }

    /// Returns gaps and balance linearised at a state.
    pub fn equations(&mut self, state: &State) -> Rc<Equations> {
        if self.finite() || state.changes_stiffness() {
            let known = self.cache.at.iter().position(|(at, _)| at.is_at_place_of(state));
            let own = match known.and_then(|known| self.cache.at.remove(known)) {
                Some(own) => own,
                None => {
                    let (gradient, loads) = (self.gradient(state), self.loads.at(state.factor));
                    let hessian = hessian(&self.geometry, &state.place(&loads), &gradient);
                    self.count("assemblies", 1);
                    (state.clone(), Rc::new(Equations::new(&self.scaled, hessian)))
                }
            };
            let equations = own.1.clone();
            self.cache.at.push_front(own);
            self.cache.at.truncate(MAX_EQUATIONS);
            return equations;
        }
        let linear = || {
            let load = Load::new(&self.scaled, self.problem, self.loads.growing);
            Rc::new(Equations::linear(&self.scaled, &load, self.geometry.pattern.clone()))
        };
        self.cache.equations.get_or_insert_with(linear).clone()
    }

    /// Returns Δg of a step at a contact point.
    pub fn step_gap(&self, start: &State, state: &State, contact: usize) -> [f64; 2] {
        [state.gap[contact][0] - start.slip[contact][0], state.gap[contact][1] - start.slip[contact][1]]
    }

    /// Adds the irreversible gaps and the plastic strains of a step to the history.
    pub fn keep(&self, start: &State, state: &mut State) {
        state.blocks.iter_mut().flatten().for_each(|inner| inner.base = inner.linear.end.clone());
        for c in 0..state.gap.len() {
            let gap = self.step_gap(start, state, c);
            state.slip[c] = start.slip[c];
            if let Some(law) = self.law(c) {
                let (kept, _) = law.irreversible(state.mode[c], gap);
                (0..2).for_each(|k| state.slip[c][k] += kept[k]);
            }
        }
    }
}
