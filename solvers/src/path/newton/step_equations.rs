//! The equations of a step, for path solvers with their own iteration: residual, tangent and energies.
//!
//! The unknowns are the contact forces r (n and t of every contact point), the motions q of the free bodies (x, y, rotation
//! about the pole) and the load factor λ, all in units in which they have size one. The elastic deformation of blocks is
//! condensed into their flexibility.
//!
//! ```text
//! stuck     g − s = 0                 facet   a·r = b A,  Δg × d = 0       corner   r = corner A
//! response  r − A t(g, history) = 0   body    Gᵀ r + w + λ p = 0
//! ```
//!
//! A contact point has the rows of the mode to which its forces and gaps return. If the residual of such a trial vanishes,
//! the trial is in equilibrium and satisfies the laws, so that Newton's method on these rows is semismooth. Small and finite
//! displacements, rigid, elastic and yielding blocks have the same interface.

use super::model::control::Control;
use super::model::derivatives::Gradient;
use super::model::loads::StagedLoads;
use super::model::state::State;
use super::model::system::StepSystem;
use super::quantities::inelastic::block_error;
use super::quantities::recorded::{energy_after, recorded, work_state};
use super::quantities::response::at_once;
use super::solve::iteration::{advanced, first_state, relative_residual};
use super::solve::linearised::{assembled, residual_of};
use super::solve::tangent::wanted_modes;
use super::tracing::commit::left_its_pairing;
use crate::path::energy::{EnergyBalance, WorkState};
use std::rc::Rc;
use voussoir_core::path::{PathProblem, PathState};

/// The equations of a step of a path problem.
pub struct StepEquations<'a> {
    system: StepSystem<'a>,
}

/// An accepted state with its history: the start of a step.
pub struct PathPoint {
    state: State,
    energy: EnergyBalance,
    work: WorkState,
    recorded: PathState,
}

impl PathPoint {
    /// Returns the state with its forces, gaps, motions and energies: pass it to the observer.
    pub fn state(&self) -> &PathState {
        &self.recorded
    }
}

/// The unknowns of an iteration, with gaps and responses of the laws at them.
pub struct Trial {
    state: State,
    gradient: Rc<Gradient>,
    /// True if the laws hold in the modes of the contact points.
    holds: bool,
}

impl Trial {
    /// Returns the gaps (n, t) of the contact points \[m\].
    pub fn gaps(&self) -> &[[f64; 2]] {
        &self.state.gap
    }

    /// Returns the contact forces (n, t) \[N\].
    pub fn forces(&self) -> &[[f64; 2]] {
        &self.state.force
    }

    /// Returns the motions of all bodies about their poles \[m, rad\].
    pub fn motions(&self) -> &[[f64; 3]] {
        &self.state.motion
    }

    /// Returns the load factor.
    pub fn factor(&self) -> f64 {
        self.state.factor
    }
}

impl<'a> StepEquations<'a> {
    /// Creates the equations, for equilibrium in displaced positions if `finite`.
    ///
    /// # Errors
    /// There are no loads, nothing deforms, or a law or material fails in its initial state.
    pub fn new(problem: &'a PathProblem, finite: bool) -> Result<Self, String> {
        if problem.load_steps.is_empty() {
            return Err("nothing is loaded".into());
        }
        StepSystem::new(problem, finite).map(|system| StepEquations { system })
    }

    /// Returns the state without loads and motion.
    pub fn undeformed(&self) -> PathPoint {
        let (state, energy) = (self.system.undeformed(), EnergyBalance::default());
        let gradient = self.system.gradient(&state);
        PathPoint {
            recorded: recorded(&energy, &self.system, 0, &state, &gradient),
            work: work_state(&self.system, &state, &gradient),
            state,
            energy,
        }
    }

    /// Begins a load step at its first factor. The loads of all earlier load steps keep their last factors.
    pub fn begin(&mut self, load_step: usize, point: &mut PathPoint) {
        let problem = self.system.problem;
        let own = &problem.load_steps[load_step];
        let applied = problem.applied(load_step, own.start);
        let earlier = problem.load_steps[..load_step].iter().zip(applied);
        let earlier = earlier.map(|(step, factor)| (factor, &step.loading)).collect();
        self.system.load(load_step, StagedLoads::new(earlier, &own.loading, own.start));
        point.state.factor = own.start;
        if load_step > 0 && problem.load_steps[load_step - 1].period.passes() {
            at_once(&self.system, &mut point.state);
        }
        let gradient = self.system.gradient(&point.state);
        point.work = work_state(&self.system, &point.state, &gradient);
    }

    /// Returns the number of equations n. There are n + 1 unknowns: the last one is the load factor.
    pub fn size(&self) -> usize {
        self.system.size() - 1
    }

    /// Returns the unknowns of an accepted state at another factor, with settled supports: the first guess of a step.
    ///
    /// # Errors
    /// A law or a material fails.
    pub fn trial(&mut self, start: &PathPoint, factor: f64) -> Result<Trial, String> {
        let control = Control::Factor(factor);
        let found = first_state(&mut self.system, &start.state, start.state.clone(), &control)?;
        Ok(self.in_modes(start, found))
    }

    /// Returns a trial after a share of a change of the unknowns. Without its last entry, the factor does not change.
    ///
    /// # Errors
    /// A law or a material fails.
    pub fn changed(&mut self, start: &PathPoint, trial: &Trial, change: &[f64], share: f64) -> Result<Trial, String> {
        let mut whole = change.to_vec();
        whole.resize(self.size() + 1, 0.0);
        let found = advanced(&mut self.system, &start.state, &trial.state, &whole, share)?;
        Ok(self.in_modes(start, found))
    }

    fn in_modes(&mut self, start: &PathPoint, (mut state, gradient): (State, Rc<Gradient>)) -> Trial {
        let (modes, holds) = wanted_modes(&mut self.system, &start.state, &state);
        state.mode = modes;
        Trial { state, gradient, holds }
    }

    /// Returns the residual of the n equations in units of one.
    pub fn residual(&self, start: &PathPoint, trial: &Trial) -> Vec<f64> {
        let mut residual = residual_of(&self.system, &start.state, &trial.state, &trial.gradient);
        residual.truncate(self.size());
        residual
    }

    /// Returns the consistent tangent as entries (row, column, value): n rows and n + 1 columns.
    pub fn tangent(&mut self, trial: &Trial) -> Vec<(usize, usize, f64)> {
        let equations = self.system.equations(&trial.state);
        let [rows, _] = assembled(&self.system, &trial.state, &equations, 0.0);
        (0..self.size()).flat_map(|i| rows.row(i).iter().map(move |&(j, value)| (i, j, value))).collect()
    }

    /// Returns the greatest residual relative to forces and motions. It is infinite if the laws do not hold in the modes
    /// of the trial.
    pub fn error(&self, start: &PathPoint, trial: &Trial) -> f64 {
        if !trial.holds {
            return f64::INFINITY;
        }
        let mut residual = self.residual(start, trial);
        residual.push(0.0);
        relative_residual(&self.system, &residual, &trial.state).max(block_error(&self.system, &trial.state))
    }

    /// Accepts a trial as the end of a step: adds its work and dissipation, and keeps the history of the laws.
    ///
    /// # Errors
    /// With finite displacements a contact point has slipped beyond its face, so that its joint is lost.
    pub fn accept(&mut self, start: &PathPoint, trial: Trial) -> Result<PathPoint, String> {
        let Trial { mut state, .. } = trial;
        if let Some((_, why)) = left_its_pairing(&self.system, &state, 0.0) {
            return Err(why);
        }
        self.system.drop_rounding(&mut state);
        let gradient = self.system.gradient(&state);
        let work = work_state(&self.system, &state, &gradient);
        let energy = energy_after(start.energy, &self.system, (&start.state, &start.work), (&state, &work));
        self.system.keep(&start.state, &mut state);
        let recorded = recorded(&energy, &self.system, self.system.load_step, &state, &gradient);
        Ok(PathPoint { state, energy, work, recorded })
    }
}
