//! Following the path: direction, step to the next event, bookkeeping.

use super::base::Base;
use super::energy::{Snapshot, load_displacement, snapshot, work};
use super::rate::{Piece, RateProblem, Verdict, Verge, corner, dilatancy};
use super::system::{Load, PointFacet, System, dot};
use nalgebra::{DMatrix, DVector};
use voussoir_core::interface::FacetMode;
use voussoir_core::limit::{Counters, Status};
use voussoir_core::path::certificate::flow_residual;
use voussoir_core::path::{
    DriveEnd, Happening, PathAnswer, PathEvent, PathObserver, PathProblem, PathSettings, PathState,
};

/// Slacks and gaps below this (in scaled units) are events of the same moment.
const SAME: f64 = 1e-12;
/// Relative residual of a direction above which it is solved anew.
const RESIDUAL: f64 = 1e-12;
/// Rates of force below this share of the rates of gaps (in scaled units) are rounding.
const MECHANISM: f64 = 1e-8;
/// Points with a piece of their own beside the factorised one before factorising anew.
const FRESH: usize = 40;
/// Points at the verge of a change above which they are searched on the whole system.
const MANY: usize = 24;

/// What is kept of a contact point between events.
#[derive(Debug, Clone)]
struct Point {
    /// Facets without slack.
    active: Vec<usize>,
    /// Opening: gap above the dilated surface; > 0 where open.
    opening: f64,
    /// What it does on the present piece of the path.
    piece: Piece,
    /// Whether it has just arrived at a facet.
    hit: bool,
    /// Bound at the apex: opening and both senses of slip end in one corner.
    apex: bool,
    /// Index of the opening facet.
    opening_facet: Option<usize>,
    stiffness: f64,
}

impl Point {
    fn open(&self) -> bool {
        self.opening > 0.0
    }

    /// The piece of a point that has no choice; `None` at the verge of a change.
    fn settled(&self) -> Option<Piece> {
        match (self.open(), self.apex) {
            (true, true) => Some(Piece::Free),
            (true, false) if self.active.len() <= 1 => self.opening_facet.map(Piece::Facet),
            (false, _) if self.active.is_empty() => Some(Piece::Stick),
            _ => None,
        }
    }
}

/// A direction of the path.
struct Direction {
    x: Vec<f64>,
    factor: f64,
    gaps: Vec<[f64; 2]>,
}

enum Next {
    Go(Direction),
    Falling(Direction),
    Nothing,
    Lost(String),
}

/// Follows one problem.
pub struct Tracer<'a> {
    problem: &'a PathProblem,
    settings: &'a PathSettings,
    observer: &'a mut dyn PathObserver,
    system: System,
    points: Vec<Point>,
    base: Option<Base>,
    x: Vec<f64>,
    applied: Vec<f64>,
    drive: usize,
    factor: f64,
    work: f64,
    dissipated: f64,
    last: Option<(Snapshot, Vec<f64>)>,
    events: Vec<PathEvent>,
    counts: Counts,
    notes: Vec<String>,
    limit_point: Option<PathState>,
    associated: bool,
}

#[derive(Debug, Default)]
struct Counts {
    factorisations: u64,
    solves: u64,
    rate_problems: u64,
    trials: u64,
    bifurcations: u64,
}

impl<'a> Tracer<'a> {
    /// At the unloaded state.
    pub fn new(problem: &'a PathProblem, settings: &'a PathSettings, observer: &'a mut dyn PathObserver) -> Self {
        let system = System::new(problem);
        let points = (0..system.contacts).map(|c| Self::untouched(&system, c)).collect();
        let associated = problem.facets.iter().all(|f| voussoir_core::interface::is_associated(f));
        Tracer {
            x: vec![0.0; system.size()],
            applied: vec![0.0; problem.drives.len()],
            points,
            base: None,
            drive: 0,
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

    fn untouched(system: &System, c: usize) -> Point {
        let diagonal = |row: usize| system.flexibility[row].iter().find(|e| e.0 == row).map_or(0.0, |e| e.1);
        let flexibility = diagonal(2 * c);
        let stiffness = if flexibility > 0.0 { 1.0 / flexibility } else { 1.0 };
        let Some(facets) = &system.facets[c] else {
            let piece = Piece::Stick;
            return Point {
                active: vec![],
                opening: 0.0,
                piece,
                hit: false,
                apex: false,
                opening_facet: None,
                stiffness,
            };
        };
        let opening_facet = facets.iter().position(|f| f.mode == FacetMode::Opening);
        let bare = |f: &PointFacet| f.bound <= 0.0;
        let slides =
            |sense: f64| facets.iter().any(|f| f.mode == FacetMode::Sliding && f.normal[1] * sense > 0.0 && bare(f));
        let apex = opening_facet.is_some_and(|f| bare(&facets[f])) && slides(1.0) && slides(-1.0);
        let active: Vec<usize> = (0..facets.len()).filter(|f| bare(&facets[*f])).collect();
        let opening = system.gap[c].max(0.0);
        let piece = if opening > 0.0 && apex { Piece::Free } else { Piece::Stick };
        Point { active, opening, piece, hit: true, apex, opening_facet, stiffness }
    }

    fn force(&self, c: usize) -> [f64; 2] {
        [self.x[2 * c], self.x[2 * c + 1]]
    }

    /// Follows all drives.
    pub fn run(mut self) -> PathAnswer {
        let greatest_events = 400 + 40 * self.system.contacts;
        for drive in 0..self.problem.drives.len() {
            self.drive = drive;
            let end = self.problem.drives[drive].end;
            self.factor = self.problem.drives[drive].start;
            let sense = match end {
                DriveEnd::Factor(f) if f < self.factor => -1.0,
                _ => 1.0,
            };
            let mut load = self.system.load(self.problem, &self.problem.drives[drive].loading);
            load.wrench.iter_mut().flatten().for_each(|v| *v *= sense);
            load.gap.iter_mut().flatten().for_each(|v| *v *= sense);
            if let Some(base) = &mut self.base {
                base.forget_drive();
            }
            if self.last.is_none() && !self.record() {
                return self.finish(Status::Stalled, None, None, Some("stopped by its observer".into()));
            }
            let target = match end {
                DriveEnd::Factor(f) | DriveEnd::Collapse(f) => f,
            };
            let mut steps = 0;
            while (target - self.factor) * sense > 0.0 {
                steps += 1;
                if steps > greatest_events {
                    return self.lost(format!("{greatest_events} events without an end: the path turns in small loops, as friction without dilatancy can; newton_path steps over them"));
                }
                let (direction, falling) = match self.direction(&load) {
                    Next::Go(direction) => (direction, false),
                    Next::Falling(direction) => (direction, true),
                    Next::Nothing => {
                        self.notes.push(format!(
                            "at λ = {:.12} no rate of solution goes on, rising or falling: every combination of the contact points at the verge of a change was tried; what follows is dynamic",
                            self.factor
                        ));
                        return self.ended();
                    }
                    Next::Lost(why) => return self.lost(why),
                };
                if falling && self.limit_point.is_none() {
                    self.limit_point = Some(self.state());
                    self.notes.push(format!(
                        "at λ = {:.12} no rate of solution has λ rising or standing still: every combination of the contact points at the verge of a change was tried; the path goes on with λ falling",
                        self.factor
                    ));
                }
                let left = (target - self.factor) * sense;
                let behind = (self.factor - self.problem.drives[drive].start) * sense;
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

    /// Points whose piece is open to change, and those that differ from the factorised ones.
    fn direction(&mut self, load: &Load) -> Next {
        self.counts.rate_problems += 1;
        let verge: Vec<usize> = (0..self.points.len()).filter(|c| self.points[*c].settled().is_none()).collect();
        if (verge.len() > MANY || self.base.is_none())
            && let Some(direction) = self.whole(load, &verge)
        {
            return Next::Go(direction);
        }
        // One attempt on the present factorisation, one on a fresh one.
        for fresh in [false, true] {
            let stale = self.base.as_ref().is_none_or(|base| base.responses() > FRESH.max(2 * verge.len()));
            if (fresh || stale) && !self.factorise() {
                return Next::Lost("the system is singular with the contact points at the verge of a change closed: a block is held by nothing".into());
            }
            match self.reduced(load, &verge) {
                Some(next) => return next,
                None if fresh => {}
                None => {}
            }
        }
        Next::Lost("the stiffness of the contact points at the verge of a change could not be found".into())
    }

    /// Factorises with the settled pieces; points at the verge of a change are closed.
    fn factorise(&mut self) -> bool {
        let pieces = self.points.iter().map(|p| p.settled().unwrap_or(Piece::Stick)).collect();
        self.counts.factorisations += 1;
        self.base = Base::new(&self.system, pieces);
        self.base.is_some()
    }

    fn verges<'s>(system: &'s System, points: &[Point], at: &[usize]) -> Vec<Verge<'s>> {
        at.iter()
            .map(|&c| {
                let point = &points[c];
                Verge {
                    facets: system.facets[c].as_deref().unwrap_or_default(),
                    active: point.active.clone(),
                    open: if point.open() { point.opening_facet } else { None },
                    apex: point.apex && point.opening_facet.is_some_and(|f| point.active.contains(&f)),
                    guess: point.piece,
                    hit: point.hit,
                    stiffness: point.stiffness,
                }
            })
            .collect()
    }

    /// The rate problem over the points at the verge of a change. `None` where linear algebra fails.
    fn reduced(&mut self, load: &Load, verge: &[usize]) -> Option<Next> {
        let base = self.base.as_mut()?;
        let mut local: Vec<usize> = verge.to_vec();
        for (c, point) in self.points.iter().enumerate() {
            if let Some(piece) = point.settled()
                && piece != base.pieces[c]
            {
                local.push(c);
            }
        }
        let n = local.len();
        base.respond(&self.system, &local, &mut self.counts.solves)?;
        base.drive(&self.system, self.drive, load)?;
        let response = base.local(&self.system, &local, load);
        // Rows that fix ε: ġ of points at the verge of a change, the piece of the others.
        let m = verge.len();
        let mut rows = DMatrix::zeros(2 * n, 2 * n);
        let mut drive = DVector::zeros(2 * n);
        for (k, &c) in local.iter().enumerate() {
            let pick: [[f64; 4]; 2] = match self.points[c].settled() {
                None | Some(Piece::Stick) => [[0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]],
                Some(Piece::Facet(f)) => {
                    let facet = &self.system.facets[c].as_ref()?[f];
                    [[facet.normal[0], facet.normal[1], 0.0, 0.0], [0.0, 0.0, -facet.flow[1], facet.flow[0]]]
                }
                Some(Piece::Free | Piece::Corner(..)) => [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]],
            };
            for (i, pick) in pick.iter().enumerate() {
                for (j, p) in pick.iter().enumerate().filter(|(_, p)| **p != 0.0) {
                    for column in 0..2 * n {
                        rows[(2 * k + i, column)] += p * response[(4 * k + j, column)];
                    }
                    drive[2 * k + i] += p * response[(4 * k + j, 2 * n)];
                }
            }
        }
        let lu = rows.lu();
        let mut right = DMatrix::zeros(2 * n, 2 * m + 1);
        (0..2 * m).for_each(|i| right[(i, i)] = 1.0);
        right.set_column(2 * m, &-drive);
        let epsilon = if n == 0 { right } else { lu.solve(&right)? };
        if epsilon.iter().any(|v| !v.is_finite()) {
            return None;
        }
        let responses = response.columns(0, 2 * n) * &epsilon;
        let row = |i: usize| 4 * (i / 2) + i % 2;
        let rate = RateProblem {
            points: Self::verges(&self.system, &self.points, verge),
            s: DMatrix::from_fn(2 * m, 2 * m, |i, j| responses[(row(i), j)]),
            drive: DVector::from_fn(2 * m, |i, _| responses[(row(i), 2 * m)] + response[(row(i), 2 * n)]),
            from_nothing: self.x.iter().all(|v| *v == 0.0),
        };
        let verdict = rate.solve(!self.associated, &mut self.counts.trials);
        let (rate, falling) = match verdict {
            Verdict::Found(rate, others) => {
                if others.is_some_and(|n| n > 0) {
                    self.counts.bifurcations += 1;
                    if self.counts.bifurcations == 1 {
                        self.notes.push(format!(
                            "at λ = {:.9} the rate problem with friction has at least {} solutions; the one taken keeps the pieces of the contact points as far as it can",
                            self.factor,
                            others.unwrap_or(0) + 1
                        ));
                    }
                }
                (rate, false)
            }
            Verdict::Falling(rate) => (rate, true),
            Verdict::Nothing => return Some(Next::Nothing),
            Verdict::Undecided(combinations) => {
                return Some(Next::Lost(format!(
                    "the rate problem at λ = {:.9} has {m} contact points at the verge of a change ({combinations} combinations), and pivoting did not solve it; newton_path or a slightly different mesh or load may pass",
                    self.factor
                )));
            }
        };
        let mut gaps = DVector::zeros(2 * m + 1);
        for (k, gap) in rate.gaps.iter().enumerate() {
            gaps[2 * k] = gap[0];
            gaps[2 * k + 1] = gap[1];
        }
        gaps[2 * m] = rate.factor;
        let epsilon = &epsilon * gaps;
        let x = base.combine(&local, epsilon.as_slice(), rate.factor);
        for (&c, piece) in verge.iter().zip(&rate.pieces) {
            self.points[c].piece = *piece;
        }
        let x = self.refined(x, rate.factor, load);
        let direction = self.completed(x, rate.factor, load);
        Some(if falling { Next::Falling(direction) } else { Next::Go(direction) })
    }

    /// The direction solved anew with all pieces in the factorisation, where what was combined from
    /// responses leaves residuals: close to a collapse the responses of single points cancel.
    fn refined(&mut self, x: Vec<f64>, factor: f64, load: &Load) -> Vec<f64> {
        let pieces: Vec<Piece> = self.points.iter().map(|p| p.settled().unwrap_or(p.piece)).collect();
        if factor == 0.0 || self.residual(&x, factor, load, &pieces) <= RESIDUAL {
            return x;
        }
        self.counts.factorisations += 1;
        let Some(mut base) = Base::new(&self.system, pieces.clone()) else { return x };
        let Some(direct) = base.drive(&self.system, self.drive, load) else { return x };
        let direct: Vec<f64> = direct.iter().map(|v| v * factor).collect();
        if self.residual(&direct, factor, load, &pieces) < self.residual(&x, factor, load, &pieces) {
            self.base = Some(base);
            return direct;
        }
        x
    }

    /// The worst residual of a direction: equilibrium and pieces, relative to the forces and gaps.
    fn residual(&self, x: &[f64], factor: f64, load: &Load, pieces: &[Piece]) -> f64 {
        let nc = self.system.contacts;
        let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(1e-300, |a: f64, b| a.max(b.abs()));
        let forces = largest(&mut x[..2 * nc].iter().copied());
        let motions = largest(&mut x[2 * nc..].iter().copied());
        let mut worst: f64 = 0.0;
        for (sum, p) in self.system.resultants(x).iter().zip(load.wrench.iter().flatten()) {
            worst = worst.max((sum + factor * p).abs() / forces);
        }
        let gaps = self.system.gaps(x);
        for (c, piece) in pieces.iter().enumerate() {
            let gap = [0, 1].map(|i| gaps[c][i] + factor * load.gap[c][i]);
            let force = [x[2 * c], x[2 * c + 1]];
            let own = match piece {
                Piece::Stick => gap[0].abs().max(gap[1].abs()) / motions.max(forces),
                Piece::Free | Piece::Corner(..) => force[0].abs().max(force[1].abs()) / forces,
                Piece::Facet(f) => match &self.system.facets[c] {
                    Some(facets) => dot(facets[*f].normal, force).abs() / forces,
                    None => 0.0,
                },
            };
            worst = worst.max(own);
        }
        worst
    }

    /// The direction with gaps of all points; those of settled points are made exact.
    fn completed(&mut self, mut x: Vec<f64>, factor: f64, load: &Load) -> Direction {
        let mut gaps = self.system.gaps(&x);
        // In a mechanism forces and λ stand still; what is left of them beside the motion is rounding.
        let largest = |values: &[f64]| values.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        let forces = 2 * self.system.contacts;
        let mut factor = factor;
        let stiffest = self.points.iter().map(|p| p.stiffness).fold(1.0, f64::max);
        let still = if factor == 0.0 { 100.0 * MECHANISM * stiffest } else { MECHANISM };
        if largest(&x[..forces]) < still * largest(&x[forces..]) {
            factor = 0.0;
            x[..forces].fill(0.0);
            gaps = self.system.gaps(&x);
        }
        for (c, gap) in gaps.iter_mut().enumerate() {
            (0..2).for_each(|i| gap[i] += factor * load.gap[c][i]);
            if let Some(piece) = self.points[c].settled() {
                self.points[c].piece = piece;
            }
            if self.points[c].piece == Piece::Stick {
                *gap = [0.0; 2];
            }
        }
        Direction { x, factor, gaps }
    }

    /// Guess and correction on the whole system with λ̇ = 1: for many points at once.
    fn whole(&mut self, load: &Load, verge: &[usize]) -> Option<Direction> {
        let mut pieces: Vec<Piece> = self.points.iter().map(|p| p.settled().unwrap_or(p.piece)).collect();
        let mut seen: Vec<Vec<Piece>> = Vec::new();
        for round in 0..80 {
            self.counts.factorisations += 1;
            let mut base = Base::new(&self.system, pieces.clone())?;
            let x = base.drive(&self.system, self.drive, load)?.clone();
            let mut gaps = self.system.gaps(&x);
            for (gap, load) in gaps.iter_mut().zip(&load.gap) {
                (0..2).for_each(|i| gap[i] += load[i]);
            }
            let force_size = x[..2 * self.system.contacts].iter().fold(0.0, |a: f64, b| a.max(b.abs()));
            let gap_size = gaps.iter().flatten().fold(0.0, |a: f64, b| a.max(b.abs()));
            if gap_size > 1e10 {
                return None;
            }
            let verges = Self::verges(&self.system, &self.points, verge);
            let mut changes: Vec<(f64, usize, Piece)> = Vec::new();
            for (&c, point) in verge.iter().zip(&verges) {
                let unknowns = point.unknowns(pieces[c], gaps[c]);
                let force = [x[2 * c], x[2 * c + 1]];
                if let Some((size, to)) = point.violation(pieces[c], &unknowns, force, [force_size, gap_size])
                    && size > 1e-10
                {
                    changes.push((size, c, to));
                }
            }
            if changes.is_empty() {
                for (c, piece) in pieces.into_iter().enumerate() {
                    self.points[c].piece = piece;
                }
                self.base = Some(base);
                return Some(self.completed(x, 1.0, load));
            }
            if seen.contains(&pieces) || round > 40 {
                changes.sort_by_key(|change| change.1);
                changes.truncate(1);
            }
            seen.push(pieces.clone());
            for (_, c, to) in changes {
                pieces[c] = to;
            }
        }
        None
    }

    /// How far it is to the next events along a direction, and which facets (or `usize::MAX` for a
    /// closing) of which points they are.
    fn next_event(&self, direction: &Direction) -> (f64, Vec<(usize, usize)>) {
        let mut all: Vec<(f64, f64, usize, usize)> = Vec::new();
        for (c, point) in self.points.iter().enumerate() {
            let Some(facets) = &self.system.facets[c] else { continue };
            if point.open() {
                let rate = self.opening_rate(c, direction);
                if rate < 0.0 {
                    all.push((point.opening / -rate, rate, c, usize::MAX));
                }
                if point.apex {
                    continue;
                }
            }
            let force = self.force(c);
            let rate = [direction.x[2 * c], direction.x[2 * c + 1]];
            for (f, facet) in facets.iter().enumerate().filter(|(f, _)| !point.active.contains(f)) {
                let falls = dot(facet.normal, rate);
                if falls > 0.0 {
                    all.push((facet.slack(force).max(0.0) / falls, -falls, c, f));
                }
            }
        }
        let step = all.iter().map(|e| e.0).fold(f64::INFINITY, f64::min);
        // A rate that is rounding brings no event.
        let size = direction.x[..2 * self.system.contacts].iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        let gap_size = direction.gaps.iter().flatten().fold(0.0, |a: f64, b| a.max(b.abs()));
        let real = |e: &&(f64, f64, usize, usize)| {
            let own = if e.3 == usize::MAX {
                gap_size
            } else if direction.factor == 0.0 {
                size.max(gap_size)
            } else {
                size
            };
            -e.1 > if direction.factor == 0.0 { MECHANISM } else { 1e-13 } * own
        };
        let step = all.iter().filter(real).map(|e| e.0).fold(f64::INFINITY, f64::min).max(step);
        let hits = all.iter().filter(real).filter(|e| (e.0 - step) * -e.1 <= SAME).map(|e| (e.2, e.3)).collect();
        (step, hits)
    }

    /// Rate of the opening above the dilated surface.
    fn opening_rate(&self, c: usize, direction: &Direction) -> f64 {
        let Some(facets) = &self.system.facets[c] else { return 0.0 };
        let gap = direction.gaps[c];
        match self.points[c].piece {
            Piece::Free => gap[0] - dilatancy(facets) * gap[1].abs(),
            Piece::Facet(f) if facets[f].mode == FacetMode::Opening => {
                -dot(gap, facets[f].flow) / dot(facets[f].flow, facets[f].flow)
            }
            Piece::Corner(i, j) => {
                let solved = corner(facets[i].flow, facets[j].flow, gap);
                if facets[i].mode == FacetMode::Opening {
                    solved[0]
                } else if facets[j].mode == FacetMode::Opening {
                    solved[1]
                } else {
                    0.0
                }
            }
            _ => 0.0,
        }
    }

    /// Goes a step along a direction and notes the events at its end.
    fn advance(&mut self, direction: &Direction, step: f64, sense: f64, hits: &[(usize, usize)]) {
        let unit = self.system.force_unit * self.system.displacement_unit;
        for (c, point) in self.points.iter().enumerate() {
            if matches!(point.piece, Piece::Stick | Piece::Free) {
                continue;
            }
            let mean = [0, 1].map(|i| self.x[2 * c + i] + 0.5 * step * direction.x[2 * c + i]);
            self.dissipated -= dot(mean, direction.gaps[c]) * step * unit;
        }
        let before = self.factor;
        let openings: Vec<f64> = (0..self.points.len()).map(|c| self.opening_rate(c, direction)).collect();
        for (x, rate) in self.x.iter_mut().zip(&direction.x) {
            *x += step * rate;
        }
        self.factor += sense * step * direction.factor;
        self.applied[self.drive] += sense * step * direction.factor;
        let size = direction.x[..2 * self.system.contacts].iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        let mut events = Vec::new();
        for (c, opening_rate) in openings.into_iter().enumerate() {
            let rate = [direction.x[2 * c], direction.x[2 * c + 1]];
            let Some(facets) = &self.system.facets[c] else { continue };
            let was_open = self.points[c].open();
            let was_hit = std::mem::take(&mut self.points[c].hit);
            let point = &mut self.points[c];
            point.opening = if was_open || matches!(point.piece, Piece::Free | Piece::Facet(_) | Piece::Corner(..)) {
                (point.opening + step * opening_rate).max(0.0)
            } else {
                0.0
            };
            if !was_open && point.open() {
                events.push((before, c, Happening::Opens));
            }
            if was_hit || !point.active.is_empty() {
                // What began to flow in this step began at its start.
                if let Piece::Facet(f) = point.piece
                    && was_hit
                {
                    let what = match facets[f].mode {
                        FacetMode::Sliding if facets[f].flow[1] > 0.0 => Some(Happening::SlipsBackward),
                        FacetMode::Sliding => Some(Happening::SlipsForward),
                        FacetMode::Crushing => Some(Happening::Crushes),
                        FacetMode::Opening => None,
                    };
                    events.extend(what.map(|what| (before, c, what)));
                }
            }
            // Facets that this direction leaves are active no more.
            if !(point.open() && point.apex) {
                let force = [self.x[2 * c], self.x[2 * c + 1]];
                let had = point.active.len();
                point.active.retain(|f| {
                    let facet = &facets[*f];
                    dot(facet.normal, rate) > -1e-11 * size || facet.slack(force) <= SAME
                });
                if had > 0 && point.active.is_empty() && !was_hit && self.events.iter().rev().any(|e| e.contact == c) {
                    events.push((before, c, Happening::Sticks));
                }
            }
        }
        self.events.extend(events.into_iter().map(|(factor, contact, what)| PathEvent {
            drive: self.drive,
            factor,
            contact,
            what,
        }));
        for &(c, f) in hits {
            let Some(facets) = &self.system.facets[c] else { continue };
            let point = &mut self.points[c];
            point.hit = true;
            if f == usize::MAX {
                point.opening = 0.0;
                if point.apex {
                    point.active = (0..facets.len()).filter(|f| facets[*f].bound <= 0.0).collect();
                }
                point.piece = Piece::Stick;
                self.events.push(PathEvent {
                    drive: self.drive,
                    factor: self.factor,
                    contact: c,
                    what: Happening::Closes,
                });
            } else {
                if !point.active.contains(&f) {
                    point.active.push(f);
                }
                let force = [self.x[2 * c], self.x[2 * c + 1]];
                // At the apex all facets meet.
                if point.apex && (facets[f].mode == FacetMode::Opening || force[0].abs() <= SAME) {
                    point.active = (0..facets.len()).filter(|f| facets[*f].bound <= 0.0).collect();
                    point.piece = Piece::Free;
                } else {
                    let other = point.active.iter().copied().find(|g| *g != f);
                    point.piece = match (point.open(), other) {
                        (true, _) => point.opening_facet.map_or(Piece::Facet(f), |open| Piece::Corner(open, f)),
                        (false, _) => Piece::Facet(f),
                    };
                }
            }
        }
    }

    fn motion(&self) -> Vec<[f64; 3]> {
        let q = &self.x[2 * self.system.contacts..];
        let mut motion: Vec<[f64; 3]> = self
            .system
            .free
            .iter()
            .map(|free| {
                free.map_or([0.0; 3], |f| {
                    let u = self.system.displacement_unit;
                    [q[3 * f] * u, q[3 * f + 1] * u, q[3 * f + 2] * u / self.system.length]
                })
            })
            .collect();
        for (drive, factor) in self.problem.drives.iter().zip(&self.applied) {
            for (body, settlement) in &drive.loading.settlements {
                (0..3).for_each(|i| motion[*body][i] += factor * settlement[i]);
            }
        }
        motion
    }

    fn displacement(&self) -> f64 {
        load_displacement(self.problem, &self.problem.drives[self.drive].loading, &self.motion())
    }

    fn state(&self) -> PathState {
        let mut gap = self.system.gaps(&self.x);
        for (g, initial) in gap.iter_mut().zip(&self.system.gap) {
            g[0] += initial;
            g.iter_mut().for_each(|g| *g *= self.system.displacement_unit);
        }
        for (drive, factor) in self.problem.drives.iter().zip(&self.applied) {
            for (g, load) in gap.iter_mut().zip(self.problem.loading_gaps(&drive.loading)) {
                (0..2).for_each(|i| g[i] += factor * load[i]);
            }
        }
        let force: Vec<[f64; 2]> =
            (0..self.system.contacts).map(|c| self.force(c).map(|f| f * self.system.force_unit)).collect();
        PathState {
            drive: self.drive,
            factor: self.factor,
            gap,
            motion: self.motion(),
            stored: self.last.as_ref().map_or(0.0, |(s, _)| s.stored),
            dissipated: self.dissipated,
            work: self.work,
            displacement: self.displacement(),
            force,
        }
    }

    /// Energy balance and observer. Returns whether to go on.
    fn record(&mut self) -> bool {
        let force: Vec<[f64; 2]> =
            (0..self.system.contacts).map(|c| self.force(c).map(|f| f * self.system.force_unit)).collect();
        let now = snapshot(self.problem, &force, &self.motion(), &self.applied);
        if let Some((before, applied)) = &self.last {
            self.work += work(before, &now, [applied, &self.applied]);
        }
        self.last = Some((now, self.applied.clone()));
        let state = self.state();
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
        let bodies: Vec<[f64; 3]> = self
            .system
            .free
            .iter()
            .map(|free| {
                free.map_or([0.0; 3], |f| {
                    [q[3 * f] * size, q[3 * f + 1] * size, q[3 * f + 2] * size / self.system.length]
                })
            })
            .collect();
        // p·q̇ = 1 in physical units.
        let physical = power * self.system.force_unit * size * sense;
        let scale = if physical.abs() > 0.0 { 1.0 / physical.abs() } else { 1.0 };
        let motion: Vec<[f64; 3]> = bodies.into_iter().map(|b| b.map(|v| v * scale)).collect();
        if direction.factor < 0.0 {
            let mut this = self;
            this.notes.push("behind the limit point λ falls without end".into());
            return this.ended();
        }
        let gravity = self.problem.drives[self.drive].gravity;
        let status = if gravity { Status::NoEquilibrium } else { Status::Collapse };
        let factor = (!gravity).then_some(self.factor);
        let limit = self.limit_point.is_some();
        // The mechanism belongs to the last state; the one at the limit point may not allow it.
        let motion = Some(motion).filter(|motion| {
            self.limit_point.as_ref().is_none_or(|state| flow_residual(self.problem, &state.force, motion) <= 1e-6)
        });
        let mut answer = self.finish(if limit { Status::LimitPoint } else { status }, factor, motion, None);
        if limit {
            answer.notes.push("behind the limit point the path ends in a mechanism".into());
        }
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
            drive: state.drive,
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
