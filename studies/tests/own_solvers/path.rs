//! A path solver with its own Newton's method: load control with bisection of steps.

use voussoir::solvers::path::newton::{PathPoint, StepEquations, Trial};
use voussoir_plug::nalgebra::{DMatrix, DVector};
use voussoir_plug::path::{LoadStepEnd, PathAnswer, PathObserver, PathProblem, PathSettings, PathSolver, PathState};
use voussoir_plug::plugin::{Capability, Card, Keys, PluginKind};
use voussoir_plug::{inventory, typetag};

/// Error of a trial that ends the iteration.
const CONVERGED: f64 = 1e-13;
/// Shortest step, as a share of its load step.
const SHORTEST: f64 = 1e-4;

/// `solver = "own_newton"`: the load grows to its target; a step that fails is halved.
#[derive(Debug, Keys)]
pub struct OwnNewton {
    /// number of steps of a load step, before any of them is halved
    #[key(range = ">= 1, <= 100000", default = 40)]
    steps: usize,
}

#[typetag::serde(name = "own_newton")]
impl PathSolver for OwnNewton {
    fn trace(&self, problem: &PathProblem, settings: &PathSettings, observer: &mut dyn PathObserver) -> PathAnswer {
        let mut last = PathState::default();
        match self.follow(problem, settings, observer, &mut last) {
            Ok(()) => PathAnswer::stands(last),
            Err(why) => PathAnswer { state: last, ..PathAnswer::stalled(why) },
        }
    }

    fn refuses(&self, problem: &PathProblem, settings: &PathSettings) -> Option<String> {
        let endless = problem.load_steps.iter().any(|step| !end(step.end).is_finite());
        let why = match () {
            () if !problem.deforms() => "nothing deforms",
            () if endless => "load control needs a target: set `factor` or `factor_max`",
            () if settings.strategies().next().is_some() => "it has load control only",
            () => return None,
        };
        Some(why.into())
    }
}

fn end(of: LoadStepEnd) -> f64 {
    match of {
        LoadStepEnd::Factor(end) | LoadStepEnd::Collapse(end) => end,
    }
}

impl OwnNewton {
    /// Follows all load steps; `last` is the last state in equilibrium.
    fn follow(
        &self,
        problem: &PathProblem,
        settings: &PathSettings,
        observer: &mut dyn PathObserver,
        last: &mut PathState,
    ) -> Result<(), String> {
        let mut equations = StepEquations::new(problem, settings.finite)?;
        let mut point = equations.undeformed();
        for (index, load_step) in problem.load_steps.iter().enumerate() {
            equations.begin(index, &mut point);
            let (start, range) = (load_step.start, end(load_step.end) - load_step.start);
            // The share of the load step that is reached, and the length of the next step.
            let (mut reached, mut length) = (0.0, 1.0 / self.steps as f64);
            while reached < 1.0 {
                let next = if reached + 1.001 * length >= 1.0 { 1.0 } else { reached + length };
                let factor = if next == 1.0 { start + range } else { start + next * range };
                match newton(&mut equations, &point, factor) {
                    Ok(trial) => {
                        point = equations.accept(&point, trial)?;
                        reached = next;
                        length = (1.5 * length).min(1.0 / self.steps as f64);
                        last.clone_from(point.state());
                        if !observer.state(problem, last) {
                            return Err("stopped by the observer".into());
                        }
                    }
                    Err(why) if length < SHORTEST => return Err(format!("no step from factor {}: {why}", last.factor)),
                    Err(_) => length /= 2.0,
                }
            }
        }
        Ok(())
    }
}

/// Newton's method at a factor. A step that raises the residual too much is halved.
fn newton(equations: &mut StepEquations, start: &PathPoint, factor: f64) -> Result<Trial, String> {
    let mut trial = equations.trial(start, factor)?;
    for _ in 0..40 {
        let residual = DVector::from_vec(equations.residual(start, &trial));
        if equations.error(start, &trial) <= CONVERGED {
            return Ok(trial);
        }
        let mut matrix = DMatrix::zeros(equations.size(), equations.size());
        for (i, j, value) in equations.tangent(&trial).into_iter().filter(|entry| entry.1 < equations.size()) {
            matrix[(i, j)] += value;
        }
        let change = matrix.lu().solve(&-&residual).ok_or("the tangent is singular")?;
        if !change.iter().all(|x| x.is_finite()) {
            return Err("the tangent is singular".into());
        }
        trial = equations.changed(start, &trial, change.as_slice(), 1.0)?;
    }
    Err("Newton's method does not converge".into())
}

inventory::submit! {
    Card {
        kind: PluginKind::PathSolver,
        tag: "own_newton",
        summary: "load control with bisection, for paths that stand",
        provides: &[Capability::FINITE_DISPLACEMENTS, Capability::SETTLEMENT],
        requires: &[&[Capability::FACETS, Capability::RESPONSE]],
        file: file!(),
        package: voussoir_plug::package!(),
        page: "# `own_newton`\n\nNewton's method at fixed loads.\n",
        ..Card::of::<OwnNewton>()
    }
}
