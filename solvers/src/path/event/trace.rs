//! The data of a path: the problem in its units, the present state, the factorisation for many events, and the records.

use super::energy::work_state;
use super::joint_chain::{JointChain, Question, by_joint_chain};
use super::piece::factorisation::FactorisedModes;
use super::piece::point::Point;
use super::piece::rates::{Direction, Rates, direction_of};
use crate::contact::facet::dot;
use crate::contact::mode::ContactMode;
use crate::linear::largest;
use crate::path::energy::{EnergyBalance, WorkState};
use crate::path::system::{Load, System};
use crate::rate::arrival::Arrival;
use crate::rate::counts::RateCounts;
use crate::settings::SETTINGS;
use voussoir_core::path::{
    Branching, Loading, PathEvent, PathObserver, PathProblem, PathSettings, PathState, StageStability,
};

/// The present state in scaled units.
pub struct State {
    /// All unknowns.
    pub x: Vec<f64>,
    /// Gaps of all contact points.
    pub gaps: Vec<[f64; 2]>,
    /// Contact points.
    pub points: Vec<Point>,
    /// The load step in force and its factor.
    pub load_step: usize,
    /// λ.
    pub factor: f64,
    /// The sense of λ on the piece before: 1, 0 or −1. It is 1 at the start of a load step.
    pub sense: f64,
    /// Stability under the loads, if it was examined.
    pub stable_under_load: Option<bool>,
    /// Work of loads and supports, and dissipated energy \[J\].
    pub energy: EnergyBalance,
}

impl State {
    /// Creates a state without forces and motions.
    pub fn at_rest(system: &System, points: Vec<Point>, load_step: usize) -> State {
        State {
            x: vec![0.0; system.size()],
            gaps: system.gap.iter().map(|gap| [*gap, 0.0]).collect(),
            points,
            load_step,
            factor: 0.0,
            sense: 1.0,
            stable_under_load: None,
            energy: EnergyBalance::default(),
        }
    }

    /// Returns the force at a contact point.
    pub fn force(&self, c: usize) -> [f64; 2] {
        [self.x[2 * c], self.x[2 * c + 1]]
    }
}

/// The factorisation that is used for many events.
#[derive(Default)]
pub struct Factors {
    /// The present factorisation; `None` before the first event.
    pub present: Option<FactorisedModes>,
    /// True close to a collapse: responses are refined one by one.
    pub refine_columns: bool,
    /// The joints in a chain, if they form one.
    pub chain: Option<JointChain>,
}

/// Events, notes and counts of the work.
#[derive(Default)]
pub struct Log {
    /// Events in their order.
    pub events: Vec<PathEvent>,
    /// Work done.
    pub counts: Counts,
    /// Stability of the states at which stages end.
    pub stability: Vec<StageStability>,
    /// Continuations with twins.
    pub branchings: Vec<Branching>,
    /// Remarks for the answer.
    pub notes: Vec<String>,
    /// The last record: its state, from which work is counted, and its stored energy.
    pub last: Option<(WorkState, f64)>,
}

/// Work done.
#[derive(Debug, Default)]
pub struct Counts {
    /// Sparse factorisations.
    pub factorisations: u64,
    /// Right-hand sides solved for.
    pub solves: u64,
    /// Rate problems.
    pub rate_problems: u64,
    /// Parts of the search that decided rate problems, and the number of small systems.
    pub rates: RateCounts,
    /// Rate problems that the chain of joints solved.
    pub by_chain: u64,
}

/// One path.
pub struct Trace<'a> {
    /// The problem.
    pub problem: &'a PathProblem,
    /// Stops and other settings.
    pub settings: &'a PathSettings,
    /// Observer of every state.
    pub observer: &'a mut dyn PathObserver,
    /// The problem in scaled units.
    pub system: System,
    /// True if all flow is associated.
    pub associated: bool,
    /// The present state.
    pub state: State,
    /// The factorisation in use.
    pub factors: Factors,
    /// Events, notes, counts.
    pub log: Log,
}

impl<'a> Trace<'a> {
    /// Creates a path at the unloaded state.
    pub fn new(problem: &'a PathProblem, settings: &'a PathSettings, observer: &'a mut dyn PathObserver) -> Self {
        let system = System::new(problem, |_| [0.0; 2]);
        let points = (0..system.contacts).map(|c| Point::untouched(&system, c)).collect();
        let associated = problem.shared_facets().0.into_iter().all(voussoir_core::law::is_associated);
        Trace {
            problem,
            settings,
            observer,
            associated,
            state: State::at_rest(&system, points, 0),
            system,
            factors: Factors::default(),
            log: Log::default(),
        }
    }

    /// Returns the relative residual up to which rates are accepted: the tolerance of loads, but not below rounding.
    pub fn believed(&self) -> f64 {
        self.settings.tolerance.clamp(SETTINGS.residual(), SETTINGS.admissible)
    }

    /// Returns the contact points that have a choice.
    pub fn active_points(&self) -> Vec<usize> {
        let points = &self.state.points;
        (0..points.len()).filter(|c| points[*c].settled().is_none()).collect()
    }

    /// Returns the modes of all points. Points of the active set keep their modes.
    pub fn present_modes(&self) -> Vec<ContactMode> {
        self.state.points.iter().map(|p| p.settled().unwrap_or(p.mode)).collect()
    }

    /// Accepts rates as the direction, and the modes of all points.
    pub fn take(&mut self, modes: Vec<ContactMode>, rates: Rates, load: &Load) -> Direction {
        self.state.points.iter_mut().zip(modes).for_each(|(point, mode)| point.mode = mode);
        direction_of(&self.system, &mut self.state.points, rates, load)
    }

    /// Factorises the equations in given modes again. Returns true if they are regular.
    pub fn factorise(&mut self, modes: Vec<ContactMode>, refine_columns: bool) -> bool {
        self.log.counts.factorisations += 1;
        self.factors.present = FactorisedModes::new(&self.system, modes, refine_columns);
        self.factors.present.is_some()
    }

    /// Returns the modes of all points from a guess and the rates in them with λ̇ = 1, by the chain of joints. `None`
    /// if there is no chain, or if the whole system must be solved: with a moving support.
    pub fn by_chain(
        &mut self,
        load: &Load,
        active: &[usize],
        guess: Vec<ContactMode>,
    ) -> Option<(Vec<ContactMode>, Rates)> {
        if load.settles {
            return None;
        }
        let chain = self.factors.chain.as_mut()?;
        let before = chain.factorisations();
        let question = Question { system: &self.system, points: &self.state.points, load, active };
        let found = by_joint_chain(chain, &question, self.state.load_step, guess, &mut self.log.counts.rates.trials);
        self.log.counts.factorisations += chain.factorisations() - before;
        self.log.counts.solves += found.as_ref().map_or(0, |(_, rates)| rates.refinements);
        found
    }

    /// Returns the number of contact points of the present event.
    pub fn arrived(&self) -> usize {
        self.state.points.iter().filter(|point| point.arrived_from.is_some()).count()
    }

    /// Returns the arrival of some contact points at the present event.
    pub fn arrival(&self, points: &[usize]) -> Arrival {
        let arrived = |c: &usize| self.state.points[*c].arrival(self.state.force(*c));
        let greatest = largest(&self.state.x[..2 * self.system.contacts]);
        Arrival::new(self.state.sense, points.iter().map(arrived), greatest)
    }

    fn motion(&self) -> Vec<[f64; 3]> {
        let mut motion = self.system.motions(&self.state.x[2 * self.system.contacts..]);
        let applied = self.problem.applied(self.state.load_step, self.state.factor);
        for (load_step, factor) in self.problem.load_steps.iter().zip(applied) {
            for (body, settlement) in &load_step.loading.settlements {
                (0..3).for_each(|i| motion[*body][i] += factor * settlement[i]);
            }
        }
        motion
    }

    /// Returns the displacement at the load \[m\].
    pub fn displacement(&self) -> f64 {
        self.displacement_of(&self.motion())
    }

    fn displacement_of(&self, motion: &[[f64; 3]]) -> f64 {
        let loading = &self.problem.load_steps[self.state.load_step].loading;
        let growing = (loading, self.state.factor);
        let moved = |body, point| self.problem.rigid_displacement(motion, body, point, false);
        self.problem.load_displacement(growing, motion, moved)
    }

    /// Returns the present state in physical units, with the energies of the last record.
    pub fn present(&self) -> PathState {
        let (motion, state, units) = (self.motion(), &self.state, self.system.units);
        PathState {
            load_step: state.load_step,
            factor: state.factor,
            force: (0..self.system.contacts).map(|c| state.force(c).map(|f| f * units.force)).collect(),
            gap: state.gaps.iter().map(|[n, t]| [n * units.displacement, t * units.displacement]).collect(),
            stored: self.log.last.as_ref().map_or(0.0, |(_, stored)| *stored),
            dissipated: state.energy.dissipated,
            work: state.energy.work,
            displacement: self.displacement_of(&motion),
            motion,
            stable_under_load: state.stable_under_load,
            ..PathState::default()
        }
    }

    /// Returns the energy stored by the tensile strength of open points \[J\].
    fn stored_by_opening(&self) -> f64 {
        let held = |(c, point): (usize, &Point)| match (&self.system.facets[c], point.opening_facet) {
            (Some(facets), Some(open)) if point.open() && !point.apex => {
                dot(facets[open].flow, self.state.force(c)) * point.opening
            }
            _ => 0.0,
        };
        let sum: f64 = self.state.points.iter().enumerate().map(held).sum();
        sum * self.system.units.energy()
    }

    /// Updates the energy balance and calls the observer. Returns true if the path continues.
    pub fn record(&mut self) -> bool {
        let mut state = self.present();
        let (now, elastic) = work_state(self.problem, &state);
        let stored = elastic + self.stored_by_opening();
        if let Some((before, _)) = &self.log.last {
            let loadings: Vec<&Loading> = self.problem.load_steps.iter().map(|step| &step.loading).collect();
            self.state.energy.add_work(self.problem, &loadings, before, &now);
        }
        (state.work, state.stored) = (self.state.energy.work, stored);
        self.log.last = Some((now, stored));
        self.observer.state(self.problem, &state)
    }
}
