//! A behaviour in this process or in a separate process.

use crate::behaviour::{Behaviour, Family, Request, Step, Wrong, check_rest};
use crate::isolated::Isolated;
use voussoir_core::law::UpdateFailure;

/// The process in which a behaviour runs.
#[derive(Debug)]
pub(crate) enum Runner {
    Here(Behaviour),
    Apart(Isolated),
}

impl Runner {
    /// Opens the library and checks the behaviour. An error names the key of the study and the fault.
    pub fn load<const N: usize>(request: &Request, family: &Family, isolate: bool) -> Result<Self, Wrong> {
        if isolate {
            Isolated::load::<N>(request).map(Runner::Apart)
        } else {
            Behaviour::load::<N>(request, family).map(Runner::Here)
        }
    }

    /// Returns the names of the whole state.
    pub fn names(&self) -> &'static [&'static str] {
        match self {
            Runner::Here(behaviour) => behaviour.names,
            Runner::Apart(isolated) => isolated.names,
        }
    }

    /// Returns the tangent in the initial state. An error names the key of the study and the fault.
    pub fn at_rest<const N: usize>(&self) -> Result<[[f64; N]; N], Wrong> {
        let old = vec![0.0; self.names().len()];
        check_rest(self.step([0.0; N], 0.0, &old, &mut old.clone()))
    }

    /// Integrates a step. The state consists of the behaviour's own state, then gradients, forces and energies at the
    /// start of the step.
    pub fn step<const N: usize>(
        &self,
        gradients: [f64; N],
        time_step: f64,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<Step<N>, UpdateFailure> {
        match self {
            Runner::Here(behaviour) => behaviour.step(gradients, time_step, old, new),
            Runner::Apart(isolated) => isolated.step(gradients, time_step, old, new),
        }
    }
}
