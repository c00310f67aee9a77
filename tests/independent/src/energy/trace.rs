//! Paths of stable states: over the settlement of supports with constant loads, and over the displacement of the load
//! point.

use super::descent::{Control, Landing, held_hessian, land, stationary};
use super::potential::evaluate;
use super::scene::{EnergyScene, Held};
use nalgebra::DVector;

/// Greatest number of branches of settlements.
const MOST_BRANCHES: usize = 4;

/// A state in equilibrium.
#[derive(Debug, Clone)]
pub struct State {
    /// Share of the settlement stage, or the displacement ℓ·q/|ℓ| \[m\].
    pub at: f64,
    /// The stationary point of the energy.
    pub landing: Landing,
}

/// A point without a stable state nearby: the path continues at the state that damped descent reaches.
#[derive(Debug, Clone)]
pub struct Snap {
    /// Share of the settlement stage, or the displacement \[m\].
    pub at: f64,
    /// λ before and after.
    pub factors: [f64; 2],
    /// Released energy \[J\]; zero within rounding at a bifurcation with a continuous path.
    pub released: f64,
    /// Greatest difference of the unknowns \[m, rad\].
    pub jump: f64,
    /// The twin: the state that descent to the other side of an unstable state reaches, if it differs.
    pub twin: Option<Landing>,
}

/// A maximum of the load along the path.
#[derive(Debug, Clone)]
pub struct Peak {
    /// Displacement of the load point since the live load began \[m\].
    pub displacement: f64,
    /// Factor λ.
    pub factor: f64,
    /// True if the path snaps there.
    pub snaps: bool,
    /// The state.
    pub landing: Landing,
}

/// A path of stable states.
#[derive(Debug, Clone, Default)]
pub struct Trace {
    /// States in order.
    pub states: Vec<State>,
    /// Snaps and bifurcations.
    pub snaps: Vec<Snap>,
    /// Maxima of the load, in order; empty for a settlement.
    pub peaks: Vec<Peak>,
    /// The reason for an early end of the path, if it ended early.
    pub broken: Option<String>,
}

impl Trace {
    /// Returns the last state.
    pub fn last(&self) -> &State {
        &self.states[self.states.len() - 1]
    }

    /// Returns the greatest peak, if there is one.
    pub fn greatest(&self) -> Option<&Peak> {
        self.peaks.iter().max_by(|a, b| a.factor.total_cmp(&b.factor))
    }
}

/// Step length and range of a path.
#[derive(Debug, Clone, Copy)]
pub struct TraceLimits {
    /// Largest step, in spans (or in shares of the stage).
    pub largest: f64,
    /// Greatest displacement of the load point, in spans.
    pub farthest: f64,
}

impl Default for TraceLimits {
    fn default() -> Self {
        TraceLimits { largest: 1e-3, farthest: 0.1 }
    }
}

/// A motion with one parameter.
struct Motion<'a> {
    scene: &'a EnergyScene,
    held: Box<dyn Fn(f64) -> Held + 'a>,
    control: Control,
    /// Length of one unit of the parameter \[m\].
    unit: f64,
    /// Step over a point without a stable state nearby, in units; the two sides of a bifurcation differ after it.
    leap: f64,
}

impl Motion<'_> {
    /// Returns the tangent predictor from a state.
    fn predicted(&self, from: &State, step: f64) -> DVector<f64> {
        let (scene, q) = (self.scene, &from.landing.q);
        match self.control {
            Control::Displacement => {
                let v = scene.load.normalize();
                let hessian = &from.landing.at.hessian;
                let side = hessian * &v;
                let z = held_hessian(hessian, &v).lu().solve(&(&side - &v * v.dot(&side)));
                q + (&v - z.unwrap_or_else(|| DVector::zeros(q.len()))) * step
            }
            Control::Factor(_) => {
                let h = 1e-7;
                let gradient = |t: f64| evaluate(scene, &(self.held)(t), q, None).gradient;
                let side = (gradient(from.at + h) - gradient(from.at - h)) / (2.0 * h);
                let rate = from.landing.at.hessian.clone().lu().solve(&side);
                q - rate.unwrap_or_else(|| DVector::zeros(q.len())) * step
            }
        }
    }

    /// Returns the stable state near the prediction, and true if it is on the same branch.
    fn step(&self, from: &State, step: f64) -> Option<(State, bool)> {
        let predicted = self.predicted(from, step);
        let held = (self.held)(from.at + step);
        let landing = stationary(self.scene, &held, &predicted, None, self.control);
        if !landing.converged() || !self.is_stable(&landing) {
            return None;
        }
        let moved = (&landing.q - &from.landing.q).norm();
        let off = (&landing.q - &predicted).norm();
        let on_branch = match self.control {
            // Supports move most blocks with them, so a twin state is close in comparison. But the way to it from the
            // prediction, which is on the branch that has become unstable, meets states that are not minima.
            Control::Factor(_) => off <= 0.03 * moved && !landing.met_indefinite,
            Control::Displacement => {
                let powers = [self.power(from.at, &from.landing), self.power(from.at + step, &landing)];
                let work = 0.5 * (powers[0] + powers[1]) * step;
                let spread = 0.5 * ((powers[1] - powers[0]) * step).abs();
                let balanced = (landing.at.energy - from.landing.at.energy - work).abs() <= 0.1 * spread;
                balanced || off <= 0.3 * moved || off <= 1e-7 * self.scene.size
            }
        };
        Some((State { at: from.at + step, landing }, on_branch))
    }

    /// Returns dE/dt of the parameter t \[J per unit\].
    fn power(&self, at: f64, landing: &Landing) -> f64 {
        match self.control {
            Control::Displacement => landing.factor * self.scene.load.norm(),
            Control::Factor(_) => {
                let h = 1e-4;
                let energy = |t: f64| evaluate(self.scene, &(self.held)(t), &landing.q, None).energy;
                (energy(at + h) - energy(at - h)) / (2.0 * h)
            }
        }
    }

    fn is_stable(&self, landing: &Landing) -> bool {
        match self.control {
            Control::Displacement => landing.stable_under_control,
            Control::Factor(_) => landing.stable_under_load,
        }
    }

    /// Returns the state that descent from the last state reaches after a step of the parameter, and the snap with its
    /// twin, the state that descent to the other side of an unstable state reaches.
    fn snap(&self, from: &State, step: f64) -> (State, Snap) {
        let at = from.at + step;
        let held = (self.held)(at);
        let near = stationary(self.scene, &held, &self.predicted(from, step), None, self.control);
        let jumped = (&near.q - &from.landing.q).amax() > 1e-3 * self.scene.size;
        let start = if near.converged() && !jumped { near.clone() } else { from.landing.clone() };
        let soft = start.softest(self.scene, self.control);
        // The load point keeps its prescribed position.
        let shift = match self.control {
            Control::Displacement => {
                let v = self.scene.load.normalize();
                &v * (at - v.dot(&start.q))
            }
            Control::Factor(_) => DVector::zeros(start.q.len()),
        };
        let mut landings: Vec<Landing> = Vec::new();
        for sense in [1.0, -1.0] {
            let from = &start.q + &shift + &soft * (sense * 1e-5 * self.scene.size);
            let landing = land(self.scene, &held, &from, None, self.control);
            let new = landings.iter().all(|l| (&l.q - &landing.q).amax() > 3e-9 * self.scene.size);
            if landing.converged() && new {
                landings.push(landing);
            }
        }
        landings.sort_by(|a, b| a.at.energy.total_cmp(&b.at.energy));
        let mut landings = landings.into_iter();
        let landing = landings.next().unwrap_or(near);
        let power = 0.5 * (self.power(from.at, &from.landing) + self.power(at, &landing));
        let snap = Snap {
            at,
            factors: [from.landing.factor, landing.factor],
            released: from.landing.at.energy + power * step - landing.at.energy,
            jump: (&landing.q - &from.landing.q).amax(),
            twin: landings.next(),
        };
        (State { at, landing }, snap)
    }

    /// Follows the parameter until `done`.
    fn follow(&self, start: State, limits: TraceLimits, done: &dyn Fn(&Trace) -> bool, end: f64) -> Trace {
        let mut trace = Trace { states: vec![start], ..Trace::default() };
        let least = if let Control::Displacement = self.control { 1e-9 } else { 1e-7 };
        let mut step: f64 = 1e-2 * limits.largest;
        while !done(&trace) {
            let from = trace.last().clone();
            let left = end - from.at;
            if left <= 1e-12 * end.abs() || trace.states.len() > 20_000 {
                break;
            }
            let now = (step * self.unit).min(left);
            match self.step(&from, now) {
                Some((state, true)) => {
                    step = (1.5 * step).min(limits.largest);
                    trace.states.push(state);
                }
                _ => {
                    if step > least {
                        step *= 0.4;
                        continue;
                    }
                    // Even the smallest step ends on another branch or fails: a kink, a bifurcation or a snap.
                    let (state, snap) = self.snap(&from, (self.leap * self.unit).min(left));
                    let kink = snap.twin.is_none() && snap.jump <= 1e-4 * self.scene.size;
                    let lost = !state.landing.converged() || !self.is_stable(&state.landing);
                    if !kink {
                        trace.snaps.push(snap);
                    }
                    if lost {
                        trace.broken = Some(format!("no stable state is reached at {}", state.at));
                        break;
                    }
                    trace.states.push(state);
                    step = 1e-2 * limits.largest;
                }
            }
        }
        trace
    }
}

/// Returns the minimum under dead load that belongs to the undeformed shape.
pub fn dead_load(scene: &EnergyScene) -> Landing {
    let mut held = scene.held(0, 0.0);
    held.gravity *= 0.01;
    let mut landing = land(scene, &held, &DVector::zeros(scene.unknowns()), None, Control::Factor(0.0));
    for share in [0.1, 0.3, 0.6, 1.0] {
        held.gravity = scene.gravity * share;
        landing = land(scene, &held, &landing.q, None, Control::Factor(0.0));
    }
    landing
}

/// Follows gravity from a thousandth of it to all of it, with the supports in their first positions. The parameter is the
/// share of gravity. Returns the path, and the shares just below and above each state without a stable state nearby.
pub fn weigh(scene: &EnergyScene) -> (Trace, Vec<[f64; 2]>) {
    let held = move |share: f64| {
        let mut held = scene.held(0, 0.0);
        held.gravity *= share;
        held
    };
    let (first, leap) = (1e-3, 1e-5);
    let landing = land(scene, &held(first), &DVector::zeros(scene.unknowns()), None, Control::Factor(0.0));
    let motion = Motion { scene, held: Box::new(held), control: Control::Factor(0.0), unit: 1.0, leap };
    let limits = TraceLimits { largest: 0.02, ..TraceLimits::default() };
    let trace = motion.follow(State { at: first, landing }, limits, &|_| false, 1.0);
    let broken = trace.broken.as_ref().map(|_| [trace.last().at, trace.last().at + leap]);
    let ends = trace.snaps.iter().map(|snap| [snap.at - leap, snap.at]).chain(broken).collect();
    (trace, ends)
}

/// Follows the settlements of all stages one after the other, from the dead load on, with constant loads. Each list is
/// one branch with one trace for each stage with a settlement. There are several lists if the path bifurcates; the
/// branch of least energy at the bifurcation comes first.
pub fn settle(scene: &EnergyScene, limits: TraceLimits) -> Vec<Vec<Trace>> {
    let limits = TraceLimits { largest: 0.02, ..limits };
    let mut open = vec![(Vec::new(), 0, State { at: 0.0, landing: dead_load(scene) })];
    let mut done: Vec<Vec<Trace>> = Vec::new();
    while let Some((mut traces, stage, start)) = open.pop() {
        if stage + 1 == scene.settled.len() {
            if traces.is_empty() {
                traces.push(Trace { states: vec![start], ..Trace::default() });
            }
            done.push(traces);
            continue;
        }
        let motion = Motion {
            scene,
            held: Box::new(move |share| scene.held(stage, share)),
            control: Control::Factor(0.0),
            unit: 1.0,
            leap: 1e-3,
        };
        let trace = motion.follow(start, limits, &|_| false, 1.0);
        let landing = trace.last().landing.clone();
        for (snap, twin) in trace.snaps.iter().filter_map(|snap| Some((snap, snap.twin.as_ref()?))) {
            if open.len() + done.len() + 1 >= MOST_BRANCHES {
                break;
            }
            open.push((traces.clone(), stage, State { at: snap.at, landing: twin.clone() }));
        }
        let broken = trace.broken.is_some();
        traces.push(trace);
        if broken {
            done.push(traces);
        } else {
            open.push((traces, stage + 1, State { at: 0.0, landing }));
        }
    }
    add_mirror_twins(scene, &mut done);
    done
}

/// If scene and settlements are symmetric, adds the mirror image of each branch.
fn add_mirror_twins(scene: &EnergyScene, branches: &mut Vec<Vec<Trace>>) {
    for index in 0..branches.len() {
        let Some(last) = branches[index].last().filter(|trace| trace.broken.is_none()) else { continue };
        let held = scene.settled_supports();
        let Some(mirrored) = scene.mirrored(&held, &last.last().landing.q) else { return };
        let twin = land(scene, &held, &mirrored, None, Control::Factor(0.0));
        let same =
            |branch: &Vec<Trace>| (&branch[branch.len() - 1].last().landing.q - &twin.q).amax() <= 1e-7 * scene.size;
        if twin.converged() && twin.stable_under_load && !branches.iter().any(same) {
            let end = State { at: 1.0, landing: twin };
            branches.push(vec![Trace { states: vec![end], ..Trace::default() }]);
        }
    }
}

/// Follows the live load from a state with λ = 0, with the supports after the last settlement and the displacement of
/// the load point as parameter. It stops when the point has moved `limits.farthest` spans, or when λ has fallen to half
/// of the last peak and the point has moved by 2 % of the span since.
pub fn load_path(scene: &EnergyScene, from: &Landing, limits: TraceLimits) -> Trace {
    let held = scene.settled_supports();
    let v = scene.load.normalize();
    let origin = v.dot(&from.q);
    let motion = Motion {
        scene,
        held: Box::new(move |_| held.clone()),
        control: Control::Displacement,
        unit: scene.span,
        leap: 1e-6,
    };
    let landing = land(scene, &scene.settled_supports(), &from.q, None, Control::Displacement);
    let done = |trace: &Trace| {
        let Some(top) = trace.states.iter().max_by(|a, b| a.landing.factor.total_cmp(&b.landing.factor)) else {
            return false;
        };
        let last = trace.last();
        last.landing.factor < 0.5 * top.landing.factor && last.at - top.at > 0.02 * scene.span
    };
    let end = origin + limits.farthest * scene.span;
    let mut trace = motion.follow(State { at: origin, landing }, limits, &done, end);
    trace.peaks = peaks(&motion, &trace);
    for state in &mut trace.states {
        state.at -= origin;
    }
    for snap in &mut trace.snaps {
        snap.at -= origin;
    }
    for peak in &mut trace.peaks {
        peak.displacement -= origin;
    }
    trace
}

/// Returns the maxima of the load, refined by golden section between the neighbours of the greatest state.
fn peaks(motion: &Motion<'_>, trace: &Trace) -> Vec<Peak> {
    let states = &trace.states;
    let factor = |i: usize| states[i].landing.factor;
    let snaps = |a: f64, b: f64| trace.snaps.iter().any(|snap| snap.at > a && snap.at <= b + 1e-15);
    let mut out = Vec::new();
    for i in 1..states.len().saturating_sub(1) {
        if factor(i) <= factor(i - 1) || factor(i) < factor(i + 1) {
            continue;
        }
        let mut best = states[i].clone();
        let jumps = snaps(states[i].at, states[i + 1].at);
        let high = if jumps { states[i].at } else { states[i + 1].at };
        let (mut low, mut high) = (states[i - 1].at, high);
        for _ in 0..40 {
            if high - low <= 1e-9 * motion.unit || (best.landing.factor - factor(i)).abs() > 0.5 * factor(i).abs() {
                break;
            }
            let middle = best.at;
            let next = if high - middle > middle - low {
                middle + 0.382 * (high - middle)
            } else {
                middle - 0.382 * (middle - low)
            };
            let tried = motion.step(&best, next - best.at);
            match tried {
                Some((state, _)) if state.landing.factor > best.landing.factor => {
                    if next > middle {
                        low = middle
                    } else {
                        high = middle
                    }
                    best = state;
                }
                _ => {
                    if next > middle {
                        high = next
                    } else {
                        low = next
                    }
                }
            }
        }
        if jumps && best.landing.stable_under_load {
            best = highest(motion, best);
        }
        out.push(Peak { displacement: best.at, factor: best.landing.factor, snaps: jumps, landing: best.landing });
    }
    out
}

/// Returns the last stable state under an increasing load, from a state at which the displacement turns back.
fn highest(motion: &Motion<'_>, from: State) -> State {
    let scene = motion.scene;
    let held = (motion.held)(from.at);
    let mut best = from;
    let mut step = 1e-3 * best.landing.factor.abs();
    while step > 1e-9 * best.landing.factor.abs() {
        let factor = best.landing.factor + step;
        let rate = best.landing.at.hessian.clone().lu().solve(&scene.load);
        let predicted = &best.landing.q + rate.unwrap_or_else(|| DVector::zeros(scene.unknowns())) * step;
        let landing = stationary(scene, &held, &predicted, None, Control::Factor(factor));
        let near = (&landing.q - &best.landing.q).amax() <= 1e-3 * scene.size;
        if landing.converged() && landing.stable_under_load && near && !landing.met_indefinite {
            best = State { at: scene.load.normalize().dot(&landing.q), landing };
        } else {
            step *= 0.3;
        }
    }
    best
}
