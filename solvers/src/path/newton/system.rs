//! The system of a step as data: units, laws, loads, geometry; and what the last evaluations leave to the next.

use super::blocks::{YieldingBlock, undeformed};
use super::control::MonitorWeights;
use super::derivatives::{Gradient, Hessian};
use super::factors::Factorised;
use super::geometry::Geometry;
use super::kinematics::{gradient, hessian};
use super::loads::StagedLoads;
use super::state::State;
use super::tractions::{Responses, TractionUpdates};
use super::unknowns::{Units, Unknowns};
use crate::contact::mode::ContactMode;
use crate::contact::yield_polygon::YieldPolygon;
use crate::path::energy::load_size;
use std::rc::Rc;
use voussoir_core::limit::Counters;
use voussoir_core::path::{Loading, PathProblem};

/// Laws of the contact points.
pub(super) struct Laws {
    /// Of facets, each once.
    pub polygons: Vec<YieldPolygon>,
    /// For each contact point the index of its polygon.
    pub polygon_of: Vec<Option<usize>>,
    /// Of tractions from gaps.
    pub responses: Responses,
    /// Own compliance of every contact point, normal and tangential \[m/N\].
    pub compliance: Vec<[f64; 2]>,
}

/// What is computed once for many iterations.
#[derive(Default)]
pub(super) struct Cache {
    /// Second derivatives with small displacements, of the present load step.
    pub hessian: Option<Rc<Hessian>>,
    pub factors: Factorised,
}

/// The system of a step.
pub(super) struct StepSystem<'a> {
    pub problem: &'a PathProblem,
    pub geometry: Geometry<'a>,
    pub laws: Laws,
    pub unknowns: Unknowns,
    pub loads: StagedLoads<'a>,
    /// Undeformed bodies whose material yields.
    blocks: Vec<Option<YieldingBlock>>,
    pub cache: Cache,
    /// What the strategy watches.
    pub monitors: Vec<MonitorWeights>,
    pub counters: Counters,
    /// Greatest relative residual of each iteration of the last step that was tried.
    pub residuals: Vec<f64>,
    /// Whether Newton's method may resort to a line search.
    pub line_search: bool,
    /// Viscous wrenches of a descent to a stable equilibrium.
    pub damping: Option<Damping>,
}

/// Viscous wrenches on the free bodies: rate × the motion since, both in units.
#[derive(Debug, Clone)]
pub(super) struct Damping {
    pub rate: f64,
    /// Motions from which they pull.
    pub from: Vec<[f64; 3]>,
}

/// Why a step was not found.
#[derive(Debug, Clone)]
pub(super) struct StepFailure {
    pub why: String,
    /// Contact points that kept changing.
    pub cycling: Vec<usize>,
}

impl StepFailure {
    /// With nothing to say of contact points.
    pub fn new(why: impl Into<String>) -> Self {
        let why = why.into();
        StepFailure { cycling: Vec::new(), why }
    }
}

/// Compliance of every contact point with all else held.
fn own_compliance(problem: &PathProblem, responses: &Responses) -> Result<Vec<[f64; 2]>, String> {
    let untouched = responses.update(&vec![[0.0; 2]; problem.contacts.len()], &problem.untouched())?;
    let of_point = |(index, c): (usize, &voussoir_core::path::Contact)| {
        let mut own = c.compliance;
        for side in [c.minus, c.plus] {
            if let (Some(slot), Some(flexibility)) = (side.slot, &problem.bodies[side.body].flexibility) {
                let block = flexibility.fixed_view::<2, 2>(2 * slot, 2 * slot);
                own[0] += (block * c.normal).dot(&c.normal);
                own[1] += (block * c.tangent).dot(&c.tangent);
            }
        }
        match untouched.points.get(index).filter(|_| responses.is(index)) {
            Some(point) => [0, 1].map(|k| {
                let stiffness = -point.tangent[k][k] * c.area;
                own[k] + if stiffness > 0.0 { 1.0 / stiffness } else { 0.0 }
            }),
            None => own,
        }
    };
    Ok(problem.contacts.iter().enumerate().map(of_point).collect())
}

/// Greatest displacement of a point by settlements.
fn settlement_size<'l>(loadings: impl Iterator<Item = &'l Loading>, length: f64) -> f64 {
    let size = |s: &(usize, [f64; 3])| s.1[0].hypot(s.1[1]).max(s.1[2].abs() * length);
    loadings.flat_map(|loading| &loading.settlements).map(size).fold(0.0, f64::max)
}

impl<'a> StepSystem<'a> {
    pub fn new(problem: &'a PathProblem, finite: bool) -> Result<Self, String> {
        let responses = Responses::new(problem);
        let compliance = own_compliance(problem, &responses)?;
        let (mut mean, mut count) = (0.0, 0);
        for c in compliance.iter().flatten().filter(|c| **c > 0.0) {
            mean += c;
            count += 1;
        }
        if count == 0 {
            return Err("nothing in the scene deforms: rigid blocks without joint compliance have no path before their collapse; limit analysis answers that".into());
        }
        mean /= f64::from(count);
        let mut bodies = 0;
        let number = |held: bool| {
            bodies += usize::from(!held);
            (!held).then(|| bodies - 1)
        };
        let free = problem.bodies.iter().map(|body| body.held).map(number).collect();
        let size = problem.load_steps.iter().map(|d| load_size(problem, &d.loading)).find(|s| *s > 0.0);
        let settlement = settlement_size(problem.load_steps.iter().map(|d| &d.loading), problem.length);
        let force = size.unwrap_or(settlement / mean);
        let force = if force > 0.0 { force } else { 1.0 };
        let units = Units { force, displacement: force * mean, length: problem.length, factor: 1.0 };
        let (facets, polygon_of) = problem.shared_facets();
        let polygons = facets.into_iter().map(YieldPolygon::new).collect();
        Ok(StepSystem {
            geometry: Geometry::new(problem, finite),
            problem,
            laws: Laws { polygons, polygon_of, responses, compliance },
            unknowns: Unknowns { units, contacts: problem.contacts.len(), free, bodies },
            counters: Counters::new(),
            loads: StagedLoads { earlier: Vec::new(), growing: &problem.load_steps[0].loading, start: 0.0 },
            residuals: Vec::new(),
            line_search: true,
            damping: None,
            blocks: undeformed(problem)?,
            cache: Cache::default(),
            monitors: Vec::new(),
        })
    }

    /// Units of the unknowns.
    pub fn units(&self) -> Units {
        self.unknowns.units
    }

    /// Number of unknowns.
    pub fn size(&self) -> usize {
        self.unknowns.size()
    }

    /// Column of an index over all bodies, and its unit; `None` for held bodies.
    pub fn column(&self, index: usize) -> Option<(usize, f64)> {
        self.unknowns.column(index)
    }

    /// Begins a load step.
    pub fn load(&mut self, loads: StagedLoads<'a>) {
        let size = load_size(self.problem, loads.growing);
        let settlement = loads
            .growing
            .settlements
            .iter()
            .map(|s| s.1[0].hypot(s.1[1]).max(s.1[2].abs() * self.unknowns.units.length))
            .fold(0.0, f64::max);
        self.unknowns.units.factor = match (size, settlement) {
            (s, _) if s > 0.0 => self.unknowns.units.force / s,
            (_, s) if s > 0.0 => self.unknowns.units.displacement / s,
            _ => 1.0,
        };
        self.loads = loads;
        self.cache.hessian = None;
        self.cache.factors.forget();
    }

    /// Adds to a counter of the work done.
    pub fn count(&mut self, what: &str, by: u64) {
        *self.counters.entry(what.into()).or_default() += by;
    }

    /// Whether equilibrium is that of displaced positions.
    pub fn finite(&self) -> bool {
        self.geometry.finite
    }

    /// Whether flow is associated everywhere: then every step is a monotone problem.
    pub fn monotone(&self) -> bool {
        self.piecewise_linear() && self.joints_flow_associated()
    }

    /// Whether the flow of all facets of joints is associated.
    pub fn joints_flow_associated(&self) -> bool {
        self.laws.polygons.iter().all(|law| !law.is_non_associated())
    }

    /// Whether with small displacements every law is one of facets.
    pub fn piecewise_linear(&self) -> bool {
        self.laws.responses.is_empty() && self.blocks.iter().all(Option::is_none)
    }

    /// Forces and a factor that are rounding of the loads become nothing (small displacements).
    pub fn drop_rounding(&self, state: &mut State, start: f64) {
        let u = self.unknowns.units;
        let largest = state.force.iter().flatten().fold(0.0, |a: f64, r| a.max(r.abs()));
        if self.loads.earlier.is_empty()
            && largest <= 1e-10 * u.force
            && (state.factor - start).abs() <= 1e-10 * u.factor
        {
            state.force.fill([0.0; 2]);
            state.factor = start;
        }
    }

    /// The state before anything has moved.
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
            blocks: self.blocks.clone(),
        };
        // The update of untouched joints has succeeded in `new`.
        if let Ok(updates) = self.laws.responses.update(&state.gap, &state.updates.memory) {
            state.updates = updates;
        }
        state
    }

    /// The facets of a contact point, where its law has that form.
    pub fn law(&self, contact: usize) -> Option<&YieldPolygon> {
        self.laws.polygon_of[contact].map(|law| &self.laws.polygons[law])
    }

    /// ρ of a contact point: the inverse of its own compliance \[N/m\].
    pub fn stiffness(&self, contact: usize) -> [f64; 2] {
        let mean = self.unknowns.units.displacement / self.unknowns.units.force;
        self.laws.compliance[contact].map(|own| 1.0 / if own > 1e-9 * mean { own } else { mean })
    }

    /// Motions with the held bodies where their settlements put them.
    pub fn settle(&self, motion: &mut [[f64; 3]], factor: f64) {
        let settled = self.loads.at(factor).settled(motion.len());
        for (body, motion) in motion.iter_mut().enumerate() {
            if self.unknowns.free[body].is_none() {
                *motion = settled[body];
            }
        }
    }

    /// First derivatives of Π at a state.
    pub fn gradient(&self, state: &State) -> Gradient {
        let loads = self.loads.at(state.factor);
        gradient(&self.geometry, &state.place(&loads))
    }

    /// Second derivatives of Π at a state.
    pub fn hessian(&mut self, state: &State, gradient: &Gradient) -> Rc<Hessian> {
        let yields = state.yields();
        if let Some(constant) = self.cache.hessian.as_ref().filter(|_| !yields) {
            return constant.clone();
        }
        let loads = self.loads.at(state.factor);
        let hessian = hessian(&self.geometry, &state.place(&loads), gradient);
        let hessian = Rc::new(hessian);
        if !self.finite() && !yields {
            self.cache.hessian = Some(hessian.clone());
        }
        hessian
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
                let (kept, _) = law.irreversible(state.mode[c], gap);
                (0..2).for_each(|k| state.slip[c][k] += kept[k]);
            }
        }
    }
}
