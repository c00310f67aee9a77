//! The load steps one after the other, converged states taken over, and the answer.

use super::kinematics::Slopes;
use super::ledger::{Ledger, events};
use super::model::{Loaded, Model, State};
use super::wandering::Wandering;
use std::sync::Arc;
use voussoir_core::certificate::flow_residual;
use voussoir_core::limit::{Counters, Status};
use voussoir_core::path::{
    Continuation, LoadStepEnd, PathAnswer, PathEvent, PathObserver, PathProblem, PathSettings, PathState,
};

/// Greatest contact force behind a peak of finite displacements, by that at the peak, with which the blocks have
/// come apart: what is left is rounding.
const APART: f64 = 1e-6;

/// How a load step ended.
pub(super) enum Outcome {
    /// At its factor.
    Reached,
    /// The path ends here.
    Ended,
}

/// A peak or limit point.
pub(super) struct Peak {
    pub state: PathState,
    pub factor: f64,
    pub motion: Option<Vec<[f64; 3]>>,
}

pub(super) struct Tracer<'a, 'o> {
    pub(super) model: Model<'a>,
    pub(super) settings: &'a PathSettings,
    pub(super) strategy: Arc<dyn Continuation>,
    pub(super) observer: &'o mut dyn PathObserver,
    pub(super) ledger: Ledger,
    pub(super) slopes: Slopes,
    pub(super) events: Vec<PathEvent>,
    pub(super) notes: Vec<String>,
    pub(super) state: State,
    pub(super) recorded: PathState,
    pub(super) load_step: usize,
    pub(super) status: Status,
    pub(super) motion: Option<Vec<[f64; 3]>>,
    pub(super) ray: Option<Vec<[f64; 2]>>,
    pub(super) peak: Option<Peak>,
    /// Why the first limit point is not proven to be one.
    pub(super) doubt: Option<String>,
    /// Factor at which it is proven that no rate has growing λ.
    pub(super) proven: Option<f64>,
    /// Factor at which a branch with growing λ was taken last, and how often there.
    pub(super) rose: Option<(f64, u32)>,
    /// The least load behind the peak, before the path rises again by a tenth of what it fell, and whether it has.
    pub(super) trough: Option<Peak>,
    pub(super) risen: bool,
    /// The way behind the peak.
    pub(super) wandering: Wandering,
}

/// Follows all load steps.
pub(super) fn trace(
    problem: &PathProblem,
    settings: &PathSettings,
    strategy: Arc<dyn Continuation>,
    observer: &mut dyn PathObserver,
) -> PathAnswer {
    let model = match Model::new(problem, settings.finite) {
        Ok(model) => model,
        Err(why) => return stalled(why),
    };
    let state = model.undeformed();
    let slopes = model.slopes(&state);
    let recorded = Ledger::default().recorded(&model, 0, &state, &slopes);
    let mut tracer = Tracer {
        model,
        settings,
        strategy,
        observer,
        ledger: Ledger::default(),
        slopes,
        events: Vec::new(),
        notes: Vec::new(),
        state,
        recorded,
        load_step: 0,
        status: Status::Stalled,
        motion: None,
        ray: None,
        peak: None,
        doubt: None,
        proven: None,
        rose: None,
        trough: None,
        risen: false,
        wandering: Wandering::default(),
    };
    tracer.run(problem);
    tracer.answer()
}

/// An answer that says only why there is none.
pub(super) fn stalled(why: String) -> PathAnswer {
    PathAnswer {
        status: Status::Stalled,
        load_step: 0,
        factor: None,
        state: PathState::default(),
        last: None,
        motion: None,
        unique: None,
        ray: None,
        events: Vec::new(),
        counters: Counters::new(),
        notes: vec![why],
    }
}

impl<'a> Tracer<'a, '_> {
    fn run(&mut self, problem: &'a PathProblem) {
        let mut earlier = Vec::new();
        for (index, load_step) in problem.load_steps.iter().enumerate() {
            self.load_step = index;
            self.state.factor = load_step.start;
            self.model.load(Loaded { earlier: earlier.clone(), growing: &load_step.loading, start: load_step.start });
            self.slopes = self.model.slopes(&self.state);
            let mut outcome = match load_step.end {
                LoadStepEnd::Factor(factor) => self.reach(load_step, factor),
                LoadStepEnd::Collapse(most) => self.follow(load_step, most),
            };
            // Behind a peak a structure with finite displacements comes back to the load as another one:
            // it has snapped through.
            if self.model.finite() && self.peak.is_some() && matches!(outcome, Outcome::Reached) {
                self.status = Status::Collapse;
                outcome = Outcome::Ended;
            }
            match outcome {
                Outcome::Reached => earlier.push((self.state.factor - load_step.start, &load_step.loading)),
                Outcome::Ended => {
                    if load_step.gravity && matches!(self.status, Status::Collapse | Status::LimitPoint) {
                        self.notes.push(format!(
                            "the change of gravity is carried up to {:.9} of its value only",
                            self.peak.as_ref().map_or(self.state.factor, |p| p.factor)
                        ));
                        self.status = Status::NoEquilibrium;
                    }
                    return;
                }
            }
        }
        self.status = if self.peak.is_some() { Status::LimitPoint } else { Status::Stands };
    }

    fn answer(mut self) -> PathAnswer {
        if let (Status::LimitPoint, Some(why)) = (self.status, self.doubt.take()) {
            self.peak = None;
            self.end(Status::Stalled, format!("the limit point on the path is not proven: {why}"));
        }
        if let (Status::LimitPoint, Some(factor)) = (self.status, self.proven) {
            self.notes.push(format!(
                "at factor {factor} no rate of solution has a factor that grows: all regimes of the contact points at the verge of a change are excluded"
            ));
        }
        let mut counters = self.model.counters.clone();
        for name in ["newton_iterations", "factorisations", "law_evaluations", "steps", "cutbacks"] {
            counters.entry(name.into()).or_default();
        }
        let mut notes = self.notes;
        let r = &self.recorded;
        let (balance, size) = (r.work - r.stored - r.dissipated, r.work.abs() + r.stored.abs() + r.dissipated.abs());
        if size > 1e-12 * self.model.units.force * self.model.units.displacement {
            notes.push(format!(
                "energy balance at the last state: work − stored − dissipated = {:.3e} of their sum (trapezoidal rule over the steps)",
                balance / size
            ));
        }
        if self.status != Status::NoEquilibrium
            && let (Some(peak), Some(trough)) = (&self.peak, &self.trough)
        {
            notes.push(format!(
                "behind the peak the load falls to the factor {} at a displacement of {} m and rises again: snap-through",
                trough.factor,
                trough.state.displacement - peak.state.displacement
            ));
        }
        let (state, last, factor, motion) = match self.peak {
            Some(peak) => {
                // Where bonds soften every joint moves at a peak: only the end shows which ones are hinges.
                let problem = self.model.problem;
                let softens = !self.model.responses.is_empty();
                // The mechanism of the last state may not be one at the peak.
                let fits = |motion: &Vec<[f64; 3]>| {
                    softens || self.model.finite() || flow_residual(problem, &peak.state.force, motion) <= 1e-6
                };
                let of_peak = peak.motion.filter(|_| self.model.finite() || !softens).filter(fits);
                let of_end = self.motion.filter(fits);
                let motion = if softens { of_end.or(of_peak) } else { of_peak.or(of_end) };
                (peak.state, Some(self.recorded), Some(peak.factor), motion)
            }
            None => {
                let factor = matches!(
                    self.status,
                    Status::Collapse | Status::LimitPoint | Status::Stands | Status::NoEquilibrium
                )
                .then_some(self.state.factor);
                (self.recorded, None, factor, self.motion)
            }
        };
        PathAnswer {
            status: self.status,
            load_step: self.load_step,
            factor,
            state,
            last,
            motion,
            unique: None,
            ray: self.ray,
            events: self.events,
            counters,
            notes,
        }
    }

    /// Takes a converged state as the next one. Whether to go on.
    pub(super) fn commit(&mut self, mut next: State) -> bool {
        let greatest = |force: &[[f64; 2]]| force.iter().flatten().fold(0.0, |a: f64, r| a.max(r.abs()));
        if self.model.finite()
            && let Some(peak) = &self.peak
            && greatest(&next.force) <= APART * greatest(&peak.state.force)
        {
            self.end(Status::Collapse, "behind the peak the blocks come apart: no forces are left between them".into());
            return false;
        }
        if !self.model.finite() {
            self.model.clean(&mut next, self.model.loaded.start);
        }
        let slopes = self.model.slopes(&next);
        self.events.extend(events(&self.model, self.load_step, &self.state, &next));
        self.ledger.add(&self.model, &self.state, &next, [&self.slopes, &slopes]);
        let start = self.state.clone();
        self.model.keep(&start, &mut next);
        self.recorded = self.ledger.recorded(&self.model, self.load_step, &next, &slopes);
        self.state = next;
        self.slopes = slopes;
        self.model.count("steps", 1);
        if !self.observer.state(self.model.problem, &self.recorded) {
            self.end(Status::Stalled, "stopped by the observer".into());
            return false;
        }
        if self.model.finite()
            && let Some(why) = self.left_its_pairing()
        {
            let status = if self.peak.is_some() { Status::Collapse } else { Status::Stalled };
            self.end(status, why);
            return false;
        }
        true
    }

    pub(super) fn end(&mut self, status: Status, note: String) {
        self.status = status;
        if !note.is_empty() {
            self.notes.push(note);
        }
    }

    /// A pressed point that has slipped further than its pairing holds.
    fn left_its_pairing(&self) -> Option<String> {
        let largest = self.state.force.iter().flatten().map(|r| r.abs()).fold(0.0, f64::max);
        let points = self.model.problem.contacts.iter().zip(&self.state.force).zip(&self.state.gap);
        let mut pressed = points.filter(|((_, force), _)| force[0] > 1e-9 * largest);
        let ((c, _), gap) = pressed.find(|((c, _), gap)| !c.sliding.holds(gap[1]))?;
        let why = if c.sliding.share == 0.5 {
            "contact points between corners that were together are paired for less"
        } else {
            "its contact point leaves the face that it slides on"
        };
        let (joint, factor) = (c.joint, self.state.factor);
        Some(format!("joint {joint} has slipped by {:.4e} m at factor {factor}: {why}", gap[1].abs()))
    }
}
