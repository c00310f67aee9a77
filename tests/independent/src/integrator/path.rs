//! The path of equilibria: small steps of given length, and the choice at corners.

use super::balance::{Balance, Loads, balance, load_rate};
use super::law::{Memory, Mode};
use super::scene::Scene;
use nalgebra::{DMatrix, DVector};
use std::collections::VecDeque;

/// Greatest unbalanced force, relative to the weight.
const TOLERANCE: f64 = 1e-11;
/// Greatest number of iterations of a step.
const ITERATIONS: usize = 14;
/// Step length below which a step may change direction.
const TURNING_STEP: f64 = 2e-8;
/// Cosine between two steps above which the step is accepted.
const STRAIGHT: f64 = 0.98;
/// Weight of the load in the length of a step: if λ p has the size of the weight, it counts as this length.
const LOAD_LENGTH: f64 = 0.01;
/// Greatest difference between one step and two of half its length.
const STEP_ERROR: f64 = 3e-10;
/// Longest step in which a contact point may change its mode.
const EVENT_STEP: f64 = 1e-5;
/// Searches at a corner, tried in order: force relative to the weight within which a point is at the limit of its mode,
/// length of the confirming steps, cosine between rate and step, and greatest number of combinations of modes.
const SEARCHES: [Search; 3] = [
    Search { edge: 1e-5, length: 20.0 * TURNING_STEP, straight: 0.99, combinations: 400 },
    Search { edge: 1e-4, length: 200.0 * TURNING_STEP, straight: 0.95, combinations: 2000 },
    Search { edge: 1e-3, length: 2000.0 * TURNING_STEP, straight: 0.9, combinations: 4000 },
];
/// Least distance to the earlier state that identifies unloading.
const LENGTH_BEHIND: f64 = 40.0 * TURNING_STEP;
/// Greatest number of steps of a path.
const STEPS: usize = 12_000;

/// A search for continuations at a corner.
#[derive(Debug, Clone, Copy)]
struct Search {
    edge: f64,
    length: f64,
    straight: f64,
    combinations: usize,
}

/// A state of equilibrium.
#[derive(Debug, Clone)]
pub struct State {
    /// u / size and θ of all blocks, then the scaled factor.
    pub x: DVector<f64>,
    /// Memories of the contact points.
    pub memory: Vec<Memory>,
    /// Their forces \[N\].
    pub force: Vec<[f64; 2]>,
    /// Their modes in the step to this state.
    pub mode: Vec<Mode>,
}

/// The reason for the end of a path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// The stage's factor was reached.
    Target,
    /// The load has fallen to half of its greatest value.
    Fallen,
    /// The load point has moved through the range.
    Range,
    /// A contact point has left a face.
    JointLost,
    /// No continuation was found.
    Lost,
    /// The number of steps is exhausted.
    Steps,
}

/// The result of a path.
#[derive(Debug, Clone)]
pub struct Found {
    /// Local maxima of λ in order, each with the fall of λ after it.
    pub peaks: Vec<[f64; 2]>,
    /// Greatest λ of all states.
    pub greatest: f64,
    /// The reason for its end.
    pub end: End,
    /// Number of steps.
    pub steps: usize,
    /// Factors at which more than one continuation was found.
    pub forks: Vec<f64>,
    /// The last state.
    pub last: State,
}

/// One load history.
#[derive(Debug, Clone, Copy)]
pub struct Path<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// True if gravity grows, false if the live load grows.
    pub dead: bool,
    /// Longest step.
    pub longest: f64,
}

impl Path<'_> {
    /// The factor per unit of the last unknown.
    fn factor_unit(&self) -> f64 {
        let live: f64 = self.scene.blocks.iter().flat_map(|b| &b.forces).map(|f| f.0.norm()).sum();
        if self.dead { 1.0 / LOAD_LENGTH } else { self.scene.weight / live / LOAD_LENGTH }
    }

    /// λ of a state.
    pub fn factor(&self, state: &State) -> f64 {
        state.x[state.x.len() - 1] * self.factor_unit()
    }

    fn balance(&self, x: &DVector<f64>, before: &[Memory], modes: Option<&[Mode]>) -> (Balance, DVector<f64>) {
        let n = x.len() - 1;
        let q: Vec<f64> = (0..n).map(|k| x[k] * if k % 3 == 2 { 1.0 } else { self.scene.size }).collect();
        let factor = x[n] * self.factor_unit();
        let loads =
            |factor| if self.dead { Loads { dead: factor, live: 0.0 } } else { Loads { dead: 1.0, live: factor } };
        let at = balance(self.scene, &q, loads(factor), before, modes);
        let unit = if self.dead { Loads { dead: 1.0, live: 0.0 } } else { Loads { dead: 0.0, live: 1.0 } };
        (at, load_rate(self.scene, &q, unit) * self.factor_unit())
    }

    /// Returns the bordered matrix of equilibrium and the row `c`.
    fn bordered(&self, at: &Balance, rate: &DVector<f64>, c: &DVector<f64>) -> DMatrix<f64> {
        let n = rate.len();
        DMatrix::from_fn(n + 1, n + 1, |i, j| match (i < n, j < n) {
            (true, true) => at.tangent[(i, j)],
            (true, false) => rate[i],
            _ => c[j],
        })
    }

    /// Returns the state at the distance `length` along `c` from `from`, searched from the point at this distance.
    fn step(&self, from: &State, c: &DVector<f64>, length: f64) -> Option<(State, usize)> {
        let mut x = &from.x + c * length;
        let n = x.len() - 1;
        let whole = |at: &Balance, x: &DVector<f64>| {
            let mut all = at.residual.clone().insert_row(n, 0.0);
            all[n] = c.dot(&(x - &from.x)) - length;
            all
        };
        let (mut at, mut rate) = self.balance(&x, &from.memory, None);
        let mut residual = whole(&at, &x);
        for iteration in 0..ITERATIONS {
            if residual.amax() <= TOLERANCE {
                let force = at.points.iter().map(|p| p.force).collect();
                let memory = at.points.iter().map(|p| p.memory).collect();
                let mode = at.points.iter().map(|p| p.mode).collect();
                return Some((State { x, memory, force, mode }, iteration));
            }
            let change = self.bordered(&at, &rate, c).lu().solve(&residual)?;
            let mut share = 1.0;
            loop {
                let next = &x - &change * share;
                let (there, there_rate) = self.balance(&next, &from.memory, None);
                let left = whole(&there, &next);
                if left.norm() < residual.norm() || share < 0.1 {
                    (x, at, rate, residual) = (next, there, there_rate, left);
                    break;
                }
                share *= 0.5;
            }
            if !(&x - &from.x).norm().is_finite() || (&x - &from.x).norm() > 20.0 * length {
                return None;
            }
        }
        None
    }

    /// Takes two steps of half the length if they agree with one step of the whole length. Very short steps are not
    /// compared.
    fn checked_step(&self, from: &State, along: &DVector<f64>, length: f64) -> Option<(State, usize)> {
        let (whole, iterations) = self.step(from, along, length)?;
        if length <= TURNING_STEP {
            return Some((whole, iterations));
        }
        if length > EVENT_STEP && whole.mode != from.mode {
            return None;
        }
        let (half, _) = self.step(from, along, length / 2.0)?;
        let (end, _) = self.step(&half, along, length / 2.0)?;
        (self.apart(&end, &whole) <= STEP_ERROR).then_some((end, iterations))
    }

    /// Returns the greatest difference of two states: motions, scaled factor, and slip of closed points relative to the
    /// size.
    fn apart(&self, a: &State, b: &State) -> f64 {
        let slip = |k: usize| match a.mode[k] {
            Mode::Open => 0.0,
            _ => (a.memory[k].slip[1] - b.memory[k].slip[1]).abs() / self.scene.size,
        };
        (0..a.mode.len()).map(slip).fold((&a.x - &b.x).norm(), f64::max)
    }

    /// A state without loads and the direction in which the loads grow.
    fn start(&self, from: Option<&State>) -> (State, DVector<f64>) {
        let n = 3 * self.scene.blocks.len();
        let mut state = from.cloned().unwrap_or_else(|| State {
            x: DVector::zeros(n + 1),
            memory: vec![Memory::default(); self.scene.contacts.len()],
            force: vec![[0.0; 2]; self.scene.contacts.len()],
            mode: vec![Mode::Stuck; self.scene.contacts.len()],
        });
        state.x[n] = 0.0;
        let mut upwards = DVector::zeros(n + 1);
        upwards[n] = 1.0;
        let (at, rate) = self.balance(&state.x, &state.memory, None);
        let tangent = self.bordered(&at, &rate, &upwards).lu().solve(&upwards).filter(|t| t.norm().is_finite());
        (state, tangent.map_or(upwards, |t| t.normalize()))
    }

    /// Returns the directions in which equilibrium continues from a corner: rates for all modes of the points at the
    /// limit of their mode, each confirmed by a step.
    fn continuations(
        &self,
        (previous, state): (&State, &State),
        along: &DVector<f64>,
        search: Search,
    ) -> Vec<(f64, State)> {
        let (at, rate) = self.balance(&state.x, &state.memory, None);
        let modes: Vec<Mode> = (0..at.points.len()).map(|k| state.mode[k]).collect();
        let edges = self.edges(state, search);
        let mut found: Vec<(f64, State, DVector<f64>)> = Vec::new();
        let mut counter = vec![0; edges.len()];
        loop {
            let mut tried = modes.clone();
            edges.iter().zip(&counter).for_each(|((point, choices), &k)| tried[*point] = choices[k]);
            let (forced, _) = self.balance(&state.x, &state.memory, Some(&tried));
            let mut right = DVector::zeros(rate.len() + 1);
            right[rate.len()] = 1.0;
            if let Some(direction) = self.bordered(&forced, &rate, along).lu().solve(&right) {
                for sense in [1.0, -1.0] {
                    let direction = direction.normalize() * sense;
                    self.confirm((previous, state), &direction, search, &mut found);
                }
            }
            let Some(next) = (0..edges.len()).find(|&k| counter[k] + 1 < edges[k].1.len()) else { break };
            counter[next] += 1;
            counter[..next].iter_mut().for_each(|k| *k = 0);
        }
        found.into_iter().map(|(dissipated, state, _)| (dissipated, state)).collect()
    }

    fn confirm(
        &self,
        (previous, state): (&State, &State),
        direction: &DVector<f64>,
        search: Search,
        found: &mut Vec<(f64, State, DVector<f64>)>,
    ) {
        let Some((next, _)) = self.step(state, direction, search.length) else { return };
        let moved = (&next.x - &state.x).normalize();
        let back = (&previous.x - &state.x).normalize();
        if moved.dot(&back) > 0.99 || self.existed_before(previous, &moved) {
            return;
        }
        // If another event lies within the step, the next step must be straight.
        if moved.dot(direction) < search.straight {
            let second = self.step(&next, &moved, search.length);
            let goes_on = second.is_some_and(|(end, _)| (&end.x - &next.x).normalize().dot(&moved) > search.straight);
            if !goes_on {
                return;
            }
        }
        if found.iter().all(|(_, _, other)| other.dot(&moved) < 0.99) {
            found.push((self.dissipated(state, &next), next, moved));
        }
    }

    /// Returns true if a motion was possible at the state before: it is then unloading and not a continuation.
    fn existed_before(&self, previous: &State, moved: &DVector<f64>) -> bool {
        let step = self.step(previous, moved, 20.0 * TURNING_STEP);
        step.is_some_and(|(next, _)| (&next.x - &previous.x).normalize().dot(moved) > 0.999)
    }

    fn dissipated(&self, from: &State, to: &State) -> f64 {
        let shear = |k: usize| (to.force[k][1] * (to.memory[k].slip[1] - from.memory[k].slip[1])).abs();
        let slides = |k: &usize| matches!(to.mode[*k], Mode::Slides { .. });
        (0..to.force.len()).filter(slides).map(shear).sum()
    }

    /// Returns the contact points at the limit of their mode, with the modes that they may have.
    fn edges(&self, state: &State, search: Search) -> Vec<(usize, Vec<Mode>)> {
        let small = search.edge * self.scene.weight;
        let mut all: Vec<(f64, usize, Vec<Mode>)> = Vec::new();
        for (index, contact) in self.scene.contacts.iter().enumerate() {
            let [normal, shear] = state.force[index];
            let memory = &state.memory[index];
            let open = (memory.gap[0] - memory.slip[0]).max(0.0) * contact.law.stiffness[0];
            let slides = Mode::Slides { positive: shear > 0.0 };
            let sides = [true, false].map(|positive| Mode::Slides { positive });
            if normal.max(open) < small {
                all.push((normal.max(open), index, vec![Mode::Open, Mode::Stuck, sides[0], sides[1]]));
            } else if normal > 0.0 && contact.law.friction * normal - shear.abs() < small {
                all.push((contact.law.friction * normal - shear.abs(), index, vec![Mode::Stuck, slides]));
            }
        }
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut combinations = 1;
        let fits = |edge: &(f64, usize, Vec<Mode>)| {
            combinations *= edge.2.len();
            combinations <= search.combinations
        };
        all.into_iter().take_while(fits).map(|(_, index, modes)| (index, modes)).collect()
    }

    /// Returns the next state: a step along `along` if it does not change direction; at a corner one of the
    /// continuations.
    fn advance(&self, previous: &State, state: &State, along: &DVector<f64>, length: &mut f64) -> Option<Advance> {
        loop {
            if let Some((next, iterations)) = self.checked_step(state, along, *length) {
                let moved = (&next.x - &state.x).normalize();
                let straight = moved.dot(along);
                let turns = straight > 0.0 && *length <= TURNING_STEP && !self.existed_before(previous, &moved);
                if straight > STRAIGHT || turns {
                    let grows = iterations <= 5 && straight > 0.998;
                    *length = (*length * if grows { 1.6 } else { 1.0 }).min(self.longest);
                    return Some(Advance { next, moved, forks: 1 });
                }
            }
            if *length > TURNING_STEP {
                *length *= 0.4;
                continue;
            }
            let ways_of = |search| {
                let mut ways = self.continuations((previous, state), along, search);
                ways.sort_by(|a, b| b.0.total_cmp(&a.0));
                (!ways.is_empty()).then_some(ways)
            };
            let (forks, next) = match ways_of(SEARCHES[0]) {
                Some(ways) => (ways.len(), ways.into_iter().next()?.1),
                None => match self.longer_step((previous, state), along) {
                    Some(next) => (0, next),
                    None => {
                        let ways = SEARCHES[1..].iter().find_map(|search| ways_of(*search))?;
                        (ways.len(), ways.into_iter().next()?.1)
                    }
                },
            };
            let moved = (&next.x - &state.x).normalize();
            *length = 20.0 * TURNING_STEP;
            return Some(Advance { next, moved, forks });
        }
    }

    /// A longer step over a corner at which no short step is found.
    fn longer_step(&self, (previous, state): (&State, &State), along: &DVector<f64>) -> Option<State> {
        [1e-6, 1e-5, 1e-4].into_iter().find_map(|length| {
            let (next, _) = self.step(state, along, length)?;
            let moved = (&next.x - &state.x).normalize();
            (moved.dot(along) > 0.5 && !self.existed_before(previous, &moved)).then_some(next)
        })
    }

    /// Follows gravity to its full value; `None` if the dead load is not carried.
    pub fn dead_load(&self) -> Option<State> {
        let found = self.follow(None);
        (found.end == End::Target).then_some(found.last)
    }

    /// Follows the load from a state, or from the unloaded scene.
    pub fn follow(&self, from: Option<&State>) -> Found {
        let (state, along) = self.start(from);
        let mut run = Run::new(state, along, self.longest);
        let end = loop {
            if run.steps >= STEPS {
                break End::Steps;
            }
            let before = run.clone_position();
            let Some(advance) = self.advance(&run.previous, &run.state, &run.along, &mut run.length) else {
                run.close_peak(self.factor(&run.state));
                break End::Lost;
            };
            if advance.forks > 1 {
                run.forks.push(self.factor(&run.state));
            }
            run.take(advance);
            if self.dead && self.factor(&run.state) >= 1.0 {
                run.state = self.at_factor(&before, &run.state);
                break End::Target;
            }
            self.note_peak(&mut run, before);
            if let Some(end) = self.ended(&run) {
                break end;
            }
        };
        Found {
            peaks: run.peaks.into_iter().filter(|p| p[1] > 1e-10 * p[0].abs()).collect(),
            greatest: run.greatest,
            end,
            steps: run.steps,
            forks: run.forks,
            last: run.state,
        }
    }

    /// The state at the factor 1 between two states.
    fn at_factor(&self, before: &Position, after: &State) -> State {
        let n = after.x.len() - 1;
        let mut upwards = DVector::zeros(n + 1);
        upwards[n] = 1.0;
        let length = 1.0 / self.factor_unit() - before.state.x[n];
        self.step(&before.state, &upwards, length).map_or_else(|| after.clone(), |step| step.0)
    }

    fn ended(&self, run: &Run) -> Option<End> {
        let n = run.state.x.len() - 1;
        let state = &run.state;
        let lost = |k: usize| state.mode[k] != Mode::Open && !self.scene.contacts[k].holds(state.memory[k].gap[1]);
        if (0..state.mode.len()).any(lost) {
            return Some(End::JointLost);
        }
        if self.dead {
            return None;
        }
        let q: Vec<f64> = (0..n).map(|k| run.state.x[k] * if k % 3 == 2 { 1.0 } else { self.scene.size }).collect();
        let fallen = !run.peaks.is_empty() && self.factor(&run.state) < 0.5 * run.greatest;
        match fallen {
            true => Some(End::Fallen),
            false => (self.scene.load_displacement(&q) > self.scene.range).then_some(End::Range),
        }
    }

    /// Stores the greatest load. After λ has fallen, also stores its maximum, computed again with shorter steps.
    fn note_peak(&self, run: &mut Run, before: Position) {
        let [old, new] = [self.factor(&before.state), self.factor(&run.state)];
        if let Some(peak) = run.peaks.last_mut() {
            peak[1] = peak[1].max(peak[0] - new);
        }
        if new < old && run.rising {
            let start = run.rose_from.clone().unwrap_or(before);
            let top = self.refined(start).max(old);
            run.peaks.push([top, top - new]);
            run.greatest = run.greatest.max(top);
            run.rising = false;
        } else if new > old {
            run.rising = true;
            run.rose_from = Some(before);
            run.greatest = run.greatest.max(new);
        }
    }

    /// Returns the greatest load between a position and the next fall, with shorter and shorter steps.
    fn refined(&self, mut from: Position) -> f64 {
        let mut top = self.factor(&from.state);
        for _ in 0..8 {
            let path = Path { longest: (from.length / 6.0).max(TURNING_STEP), ..*self };
            let mut here = Position { length: path.longest, ..from.clone() };
            let mut last = here.clone();
            for _ in 0..200 {
                let Some(advance) = path.advance(&here.previous, &here.state, &here.along, &mut here.length) else {
                    break;
                };
                if self.factor(&advance.next) < self.factor(&here.state) {
                    break;
                }
                last = here.clone();
                here =
                    Position { previous: here.state, state: advance.next, along: advance.moved, length: here.length };
            }
            let found = self.factor(&here.state);
            let better = found - top;
            top = top.max(found);
            from = Position { length: path.longest, ..last };
            if better.abs() <= 1e-9 * top.abs() && path.longest < 1e-5 {
                break;
            }
        }
        top
    }
}

/// An accepted step.
struct Advance {
    next: State,
    moved: DVector<f64>,
    forks: usize,
}

/// A position on a path.
#[derive(Clone)]
struct Position {
    previous: State,
    state: State,
    along: DVector<f64>,
    length: f64,
}

/// The data of a path while it is followed.
struct Run {
    /// The states since `previous`.
    trail: VecDeque<State>,
    previous: State,
    state: State,
    along: DVector<f64>,
    length: f64,
    steps: usize,
    rising: bool,
    rose_from: Option<Position>,
    peaks: Vec<[f64; 2]>,
    greatest: f64,
    forks: Vec<f64>,
}

impl Run {
    fn new(state: State, along: DVector<f64>, longest: f64) -> Run {
        Run {
            trail: VecDeque::new(),
            previous: state.clone(),
            state,
            along,
            length: longest.min(1e-4),
            steps: 0,
            rising: true,
            rose_from: None,
            peaks: Vec::new(),
            greatest: 0.0,
            forks: Vec::new(),
        }
    }

    fn clone_position(&self) -> Position {
        let (previous, state, along) = (self.previous.clone(), self.state.clone(), self.along.clone());
        Position { previous, state, along, length: self.length }
    }

    fn take(&mut self, advance: Advance) {
        self.trail.push_back(std::mem::replace(&mut self.state, advance.next));
        let far = |state: &State, from: &State| (&state.x - &from.x).norm() >= LENGTH_BEHIND;
        while self.trail.len() > 1 && far(&self.trail[1], &self.state) {
            self.trail.pop_front();
        }
        self.previous = self.trail[0].clone();
        self.along = advance.moved;
        self.steps += 1;
    }

    /// A path that ends while the load rises ends at a maximum.
    fn close_peak(&mut self, factor: f64) {
        if self.rising {
            self.peaks.push([factor, f64::INFINITY]);
            self.greatest = self.greatest.max(factor);
        }
    }
}
