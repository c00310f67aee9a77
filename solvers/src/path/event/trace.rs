//! Following the path: from load step to load step and from event to event, and how it ended.

use super::base::Base;
use super::direction::{Direction, Next};
use super::energy::{Snapshot, load_displacement, snapshot, work};
use super::point::Point;
use super::redundants::{Followed, Sections};
use super::system::{Load, System};
use super::unique::unique;
use voussoir_core::certificate::flow_residual;
use voussoir_core::limit::{Counters, Status};
use voussoir_core::path::{
    LoadStep, LoadStepEnd, PathAnswer, PathEvent, PathObserver, PathProblem, PathSettings, PathState,
};

/// Rate problems put to the whole system, at most, before the force method is tried again.
const MOST_RESTS: u32 = 32;

/// Follows one problem.
pub struct Tracer<'a> {
    problem: &'a PathProblem,
    settings: &'a PathSettings,
    observer: &'a mut dyn PathObserver,
    pub(super) system: System,
    pub(super) points: Vec<Point>,
    pub(super) base: Option<Base>,
    /// Where statics leaves little open.
    pub(super) sections: Option<Sections>,
    /// Whether responses are refined one by one: close to a collapse.
    pub(super) careful: bool,
    /// All unknowns at the present state.
    pub(super) x: Vec<f64>,
    pub(super) load_step: usize,
    pub(super) factor: f64,
    pub(super) work: f64,
    pub(super) dissipated: f64,
    last: Option<(Snapshot, Vec<f64>)>,
    pub(super) events: Vec<PathEvent>,
    pub(super) counts: Counts,
    pub(super) notes: Vec<String>,
    limit_point: Option<PathState>,
    pub(super) associated: bool,
    /// Gaps that each load step's loading opens per unit of its factor \[m\], where it opens any.
    loading_gaps: Vec<Option<Vec<[f64; 2]>>>,
}

/// Work done.
#[derive(Debug, Default)]
pub struct Counts {
    pub(super) factorisations: u64,
    pub(super) solves: u64,
    pub(super) rate_problems: u64,
    pub(super) trials: u64,
    pub(super) bifurcations: u64,
    /// Rate problems of the force method.
    pub(super) by_redundants: u64,
    /// Sections whose points it looked at.
    pub(super) sections: u64,
}

impl<'a> Tracer<'a> {
    /// At the unloaded state.
    pub fn new(problem: &'a PathProblem, settings: &'a PathSettings, observer: &'a mut dyn PathObserver) -> Self {
        let system = System::new(problem);
        let points = (0..system.contacts).map(|c| Point::untouched(&system, c)).collect();
        let opened = |load_step: &LoadStep| {
            let gaps = problem.loading_gaps(&load_step.loading);
            gaps.iter().flatten().any(|g| *g != 0.0).then_some(gaps)
        };
        let associated = problem.facets.iter().all(|f| voussoir_core::law::is_associated(f));
        Tracer {
            x: vec![0.0; system.size()],
            loading_gaps: problem.load_steps.iter().map(opened).collect(),
            points,
            base: None,
            sections: Sections::new(&system, problem),
            careful: false,
            load_step: 0,
            factor: 0.0,
            work: 0.0,
            dissipated: 0.0,
            last: None,
            events: Vec::new(),
            counts: Counts::default(),
            notes: Vec::new(),
            limit_point: None,
            associated,
            problem,
            settings,
            observer,
            system,
        }
    }

    pub(super) fn force(&self, c: usize) -> [f64; 2] {
        [self.x[2 * c], self.x[2 * c + 1]]
    }

    /// Follows all load steps.
    pub fn run(mut self) -> PathAnswer {
        let greatest_events = 400 + 40 * self.system.contacts;
        for load_step in 0..self.problem.load_steps.len() {
            self.load_step = load_step;
            let end = self.problem.load_steps[load_step].end;
            self.factor = self.problem.load_steps[load_step].start;
            let sense = match end {
                LoadStepEnd::Factor(f) if f < self.factor => -1.0,
                _ => 1.0,
            };
            let mut load = self.system.load(self.problem, &self.problem.load_steps[load_step].loading);
            load.wrench.iter_mut().flatten().for_each(|v| *v *= sense);
            load.gap.iter_mut().flatten().for_each(|v| *v *= sense);
            if let Some(base) = &mut self.base {
                base.forget_load_rate();
            }
            self.careful = false;
            if self.last.is_none() && !self.record() {
                return self.finish(Status::Stalled, None, None, Some("stopped by its observer".into()));
            }
            let target = match end {
                LoadStepEnd::Factor(f) | LoadStepEnd::Collapse(f) => f,
            };
            let mut steps = 0;
            // Rate problems that are put to the whole system before the few equations are asked again.
            let (mut rests, mut patience) = (0_u32, 1);
            while (target - self.factor) * sense > 0.0 {
                if rests > 0 || self.limit_point.is_some() {
                    rests = rests.saturating_sub(1);
                } else {
                    let before = steps;
                    match self.by_redundants(&load, sense, target, &mut steps, greatest_events) {
                        Followed::Reached => continue,
                        Followed::Stopped => {
                            let stopped = Some("stopped by its observer".into());
                            return self.finish(Status::Stalled, None, None, stopped);
                        }
                        Followed::Left => {}
                    }
                    patience = if steps > before { 1 } else { (2 * patience).min(MOST_RESTS) };
                    rests = patience - 1;
                }
                steps += 1;
                if steps > greatest_events {
                    return self.lost(format!("{greatest_events} events without an end: the path turns in small loops, as friction without dilatancy can; newton_path steps over them"));
                }
                let (direction, falling) = match self.direction(&load) {
                    Next::Go(direction) => (direction, false),
                    Next::Falling(direction) => (direction, true),
                    Next::Nothing => {
                        self.notes.push(format!(
                            "at λ = {:.12} no rate of solution goes on, rising or falling: every combination of the contact points at the verge of a change is excluded; what follows is dynamic",
                            self.factor
                        ));
                        return self.ended();
                    }
                    Next::NoneRises => {
                        self.notes.push(format!(
                            "at λ = {:.12} no rate of solution has λ rising: every combination of the contact points at the verge of a change is excluded; whether a rate goes on with λ standing still or falling is not decided",
                            self.factor
                        ));
                        return self.ended();
                    }
                    Next::Lost(why) => return self.lost(why),
                };
                if falling && self.limit_point.is_none() {
                    self.limit_point = Some(self.state());
                    self.notes.push(format!(
                        "at λ = {:.12} no rate of solution has λ rising or standing still: every combination of the contact points at the verge of a change is excluded; the path goes on with λ falling",
                        self.factor
                    ));
                }
                let left = (target - self.factor) * sense;
                let behind = (self.factor - self.problem.load_steps[load_step].start) * sense;
                let bound = match direction.factor {
                    f if f > 0.0 => left / f,
                    f if f < 0.0 => behind.max(0.0) / -f,
                    _ => f64::INFINITY,
                };
                let (step, hits) = self.next_event(&direction);
                let whole = bound <= step;
                let step = step.min(bound);
                if step.is_infinite() {
                    return self.ray(&direction, &load, sense);
                }
                self.advance(&direction, step, sense, if whole { &[] } else { &hits });
                if whole && direction.factor > 0.0 {
                    self.factor = target;
                }
                if !self.record() {
                    let stopped = Some("stopped by its observer".into());
                    return self.finish(Status::Stalled, None, None, stopped);
                }
                if whole && direction.factor < 0.0 {
                    self.notes.push("behind the limit point λ fell back to where the loads began".into());
                    return self.ended();
                }
                if self.limit_point.is_some()
                    && self.settings.stop_displacement.is_some_and(|stop| self.displacement().abs() > stop)
                {
                    return self.ended();
                }
            }
        }
        if self.limit_point.is_some() {
            self.notes.push(format!("behind the limit point λ rose again to {}", self.factor));
            return self.ended();
        }
        let reached = self.factor;
        self.finish(Status::Stands, Some(reached), None, None)
    }

    fn ended(self) -> PathAnswer {
        self.finish(Status::LimitPoint, None, None, None)
    }

    /// The path cannot be followed further: an answer where a limit point is proven already.
    fn lost(mut self, why: String) -> PathAnswer {
        if self.limit_point.is_some() {
            self.notes.push(format!("the branch behind the limit point was not followed to an end: {why}"));
            return self.ended();
        }
        self.stalled(why)
    }

    fn stalled(self, why: String) -> PathAnswer {
        self.finish(Status::Stalled, None, None, Some(why))
    }

    /// Motions of all bodies in physical units from unknowns; held bodies stand still.
    fn bodies(&self, x: &[f64]) -> Vec<[f64; 3]> {
        let (q, u) = (&x[2 * self.system.contacts..], self.system.displacement_unit);
        let own = |f: usize| [q[3 * f] * u, q[3 * f + 1] * u, q[3 * f + 2] * u / self.system.length];
        self.system.free.iter().map(|free| free.map_or([0.0; 3], own)).collect()
    }

    fn motion(&self) -> Vec<[f64; 3]> {
        let mut motion = self.bodies(&self.x);
        for (load_step, factor) in self.problem.load_steps.iter().zip(self.problem.applied(self.load_step, self.factor))
        {
            for (body, settlement) in &load_step.loading.settlements {
                (0..3).for_each(|i| motion[*body][i] += factor * settlement[i]);
            }
        }
        motion
    }

    fn displacement(&self) -> f64 {
        load_displacement(self.problem, &self.problem.load_steps[self.load_step].loading, &self.motion())
    }

    /// Gaps at the present state in scaled units.
    fn gaps_at(&self) -> Vec<[f64; 2]> {
        let mut gap = self.system.gaps(&self.x);
        gap.iter_mut().zip(&self.system.gap).for_each(|(g, initial)| g[0] += initial);
        for (opened, factor) in self.loading_gaps.iter().zip(self.problem.applied(self.load_step, self.factor)) {
            if let (Some(opened), true) = (opened, factor != 0.0) {
                let factor = factor / self.system.displacement_unit;
                gap.iter_mut().flatten().zip(opened.iter().flatten()).for_each(|(g, o)| *g += factor * o);
            }
        }
        gap
    }

    /// The present state with the energies of the last record.
    fn state(&self) -> PathState {
        let mut gap = self.gaps_at();
        gap.iter_mut().flatten().for_each(|g| *g *= self.system.displacement_unit);
        let motion = self.motion();
        PathState {
            load_step: self.load_step,
            factor: self.factor,
            force: (0..self.system.contacts).map(|c| self.force(c).map(|f| f * self.system.force_unit)).collect(),
            gap,
            stored: self.last.as_ref().map_or(0.0, |(s, _)| s.stored),
            dissipated: self.dissipated,
            work: self.work,
            displacement: load_displacement(self.problem, &self.problem.load_steps[self.load_step].loading, &motion),
            motion,
            memory: Vec::new(),
            yielded: Vec::new(),
        }
    }

    /// Energy balance and observer. Returns whether to go on.
    pub(super) fn record(&mut self) -> bool {
        let mut state = self.state();
        let mut now = snapshot(self.problem, &state);
        now.stored += self.stored_by_opening();
        let applied = self.problem.applied(self.load_step, self.factor);
        if let Some((before, earlier)) = &self.last {
            self.work += work(before, &now, [earlier, &applied]);
        }
        (state.work, state.stored) = (self.work, now.stored);
        self.last = Some((now, applied));
        self.observer.state(self.problem, &state)
    }

    /// A direction without end: a mechanism where λ stands still, else a ray that carries any load.
    fn ray(self, direction: &Direction, load: &Load, sense: f64) -> PathAnswer {
        let size = self.system.displacement_unit;
        let q = &direction.x[2 * self.system.contacts..];
        if direction.factor > 0.0 {
            let ray = (0..self.system.contacts)
                .map(|c| [0, 1].map(|i| direction.x[2 * c + i] * self.system.force_unit / direction.factor * sense))
                .collect();
            let mut answer = self.finish(Status::Unbounded, None, None, None);
            answer.ray = Some(ray);
            return answer;
        }
        let power: f64 = load.wrench.iter().flatten().zip(q).map(|(w, q)| w * q).sum();
        let bodies = self.bodies(&direction.x);
        // p·q̇ = 1 in physical units.
        let physical = power * self.system.force_unit * size * sense;
        let scale = if physical.abs() > 0.0 { 1.0 / physical.abs() } else { 1.0 };
        let motion: Vec<[f64; 3]> = bodies.into_iter().map(|b| b.map(|v| v * scale)).collect();
        if direction.factor < 0.0 {
            let mut this = self;
            this.notes.push("behind the limit point λ falls without end".into());
            return this.ended();
        }
        let gravity = self.problem.load_steps[self.load_step].gravity;
        let status = if gravity { Status::NoEquilibrium } else { Status::Collapse };
        let factor = (!gravity).then_some(self.factor);
        let limit = self.limit_point.is_some();
        let unique = unique(&self.system, &self.points, load, &direction.x, &direction.gaps);
        // The mechanism belongs to the last state; the one at the limit point may not allow it.
        let motion = Some(motion).filter(|motion| {
            self.limit_point.as_ref().is_none_or(|state| flow_residual(self.problem, &state.force, motion) <= 1e-6)
        });
        let mut answer = self.finish(if limit { Status::LimitPoint } else { status }, factor, motion, None);
        if limit {
            answer.notes.push("behind the limit point the path ends in a mechanism".into());
        }
        answer.unique = unique;
        answer
    }

    fn finish(
        self,
        status: Status,
        factor: Option<f64>,
        motion: Option<Vec<[f64; 3]>>,
        why: Option<String>,
    ) -> PathAnswer {
        let state = self.state();
        let mut notes = self.notes;
        notes.extend(why);
        let mut counters = Counters::new();
        for (name, count) in [
            ("factorisations", self.counts.factorisations),
            ("solves", self.counts.solves),
            ("rate_problems", self.counts.rate_problems),
            ("rate_trials", self.counts.trials),
            ("bifurcations", self.counts.bifurcations),
            ("rate_problems_by_redundants", self.counts.by_redundants),
            ("sections_looked_at", self.counts.sections),
            ("events", self.events.len() as u64),
        ] {
            counters.insert(name.into(), count);
        }
        for (name, count) in &self.problem.counters {
            counters.insert(name.clone(), *count);
        }
        let (state, last) = match (status, self.limit_point) {
            (Status::LimitPoint, Some(limit)) => (limit, Some(state)),
            _ => (state, None),
        };
        let factor = if status == Status::LimitPoint { Some(state.factor) } else { factor };
        PathAnswer {
            status,
            load_step: state.load_step,
            factor,
            state,
            last,
            motion,
            unique: None,
            ray: None,
            events: self.events,
            counters,
            notes,
        }
    }
}
