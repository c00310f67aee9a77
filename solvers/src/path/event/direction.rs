//! The direction of the next piece of the path: the rate problem over the points at the verge of a
//! change on one factorisation for many events, or guess and correction on the whole system.

use super::base::{Base, rows};
use super::local::Local;
use super::point::Point;
use super::rate::{Piece, Verdict, Verge};
use super::system::{Load, System};
use super::trace::Tracer;

/// Relative residual of a direction above which it is solved anew.
const RESIDUAL: f64 = 1e-12;
/// Relative residual of a direction up to which it is refined, and the most steps of that.
const REFINED: (f64, usize) = (2e-15, 3);
/// The same above which a direction is not believed: guess and correction give way to the whole rate
/// problem, and its answer is given up.
const BELIEVED: [f64; 2] = [1e-9, 1e-6];
/// Forces below this share of the motions of a system that is singular to rounding are rounding.
const SINGULAR: f64 = 1e-6;
/// Rates of force below this share of the rates of gaps (in scaled units) are rounding.
pub const MECHANISM: f64 = 1e-8;
/// Forces below this share of the motions (in scaled units): directions are only taken from responses that
/// are refined one by one, for what tells a mechanism from a soft structure cancels in their sum.
const SHAKY: f64 = 1e-4;
/// Points with a piece of their own beside the factorised one before factorising anew.
const FRESH: usize = 40;
/// Points at the verge of a change above which they are searched on the whole system.
const MANY: usize = 24;
/// Combinations of pieces up to which a non-associated rate problem is searched for other solutions.
pub const EXAMINED: usize = 64;

/// A direction of the path.
pub struct Direction {
    /// Rates of all unknowns.
    pub x: Vec<f64>,
    /// λ̇: 1, 0 or −1.
    pub factor: f64,
    /// Rates of all gaps.
    pub gaps: Vec<[f64; 2]>,
}

/// Rates on the way to a direction.
struct Rates {
    x: Vec<f64>,
    factor: f64,
    /// The load's own included.
    gaps: Vec<[f64; 2]>,
    worst: f64,
    refinements: u64,
}

impl Rates {
    fn new(system: &System, x: Vec<f64>, factor: f64, load: &Load) -> Rates {
        let mut gaps = system.gaps(&x);
        if load.opens && factor != 0.0 {
            for (gap, load) in gaps.iter_mut().zip(&load.gap) {
                (0..2).for_each(|i| gap[i] += factor * load[i]);
            }
        }
        Rates { x, factor, gaps, worst: 0.0, refinements: 0 }
    }

    /// Whether motions are so large beside the forces that a mechanism is near.
    fn shaky(&self, forces: usize) -> bool {
        let largest = |values: &[f64]| values.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        largest(&self.x[..forces]) < SHAKY * largest(&self.x[forces..])
    }
}

/// Where the path goes on.
pub enum Next {
    /// With λ rising or standing still.
    Go(Direction),
    /// With λ falling: nothing else is possible.
    Falling(Direction),
    /// Nowhere.
    Nothing,
    /// Not with λ rising; whether with λ standing still or falling is not decided.
    NoneRises,
    /// Not decided, and why.
    Lost(String),
}

impl Tracer<'_> {
    /// The direction from the present state.
    pub fn direction(&mut self, load: &Load) -> Next {
        self.counts.rate_problems += 1;
        let verge: Vec<usize> = (0..self.points.len()).filter(|c| self.points[*c].settled().is_none()).collect();
        // Where there are few combinations and several solutions are possible, all are looked at.
        if (self.associated || self.combinations(&verge) > EXAMINED)
            && let Some(direction) = self.kept(load, &verge)
        {
            return Next::Go(direction);
        }
        if (verge.len() > MANY || self.base.is_none())
            && let Some(direction) = self.whole(load, &verge)
        {
            return Next::Go(direction);
        }
        // One attempt on the present factorisation, one on a fresh one.
        for fresh in [false, true] {
            // Closed points at the verge of a change make the best conditioned base: close to a collapse
            // one in which they flow is nearly singular.
            let stale = self.base.as_ref().is_none_or(|base| {
                // What is claimed here rests on the responses themselves.
                !base.careful
                    || base.responses() > FRESH.max(2 * verge.len())
                    || verge.iter().any(|c| base.pieces[*c] != Piece::Stick)
            });
            let closed = |p: &Point| p.settled().unwrap_or(Piece::Stick);
            if (fresh || stale) && !self.factorise(self.points.iter().map(closed).collect(), true) {
                return Next::Lost("the system is singular with the contact points at the verge of a change closed: a block is held by nothing".into());
            }
            if let Some(next) = self.reduced(load, &verge) {
                return next;
            }
        }
        Next::Lost("the stiffness of the contact points at the verge of a change could not be found".into())
    }

    fn factorise(&mut self, pieces: Vec<Piece>, careful: bool) -> bool {
        self.counts.factorisations += 1;
        self.base = Base::new(&self.system, pieces, careful);
        self.base.is_some()
    }

    fn combinations(&self, verge: &[usize]) -> usize {
        let candidates = Self::verges(&self.system, &self.points, verge);
        candidates.iter().fold(1, |n: usize, verge| n.saturating_mul(verge.candidates().len()))
    }

    /// Guess and correction over the points that have just arrived somewhere and those that this moves
    /// out of their pieces, while all others go on as they are. `None` where nothing with λ rising is
    /// found so.
    fn kept(&mut self, load: &Load, verge: &[usize]) -> Option<Direction> {
        let mut open: Vec<usize> = verge.iter().copied().filter(|c| self.points[*c].hit).collect();
        loop {
            if open.len() > MANY {
                return None;
            }
            let mut pieces: Vec<Piece> = self.points.iter().map(|p| p.settled().unwrap_or(p.piece)).collect();
            let stale = |base: &Base| {
                (!base.careful && self.careful)
                    || base.responses() > FRESH.max(2 * open.len())
                    || pieces.iter().zip(&base.pieces).filter(|(now, then)| now != then).count() > 2 * FRESH
            };
            if self.base.as_ref().is_none_or(stale) {
                // With what is asked closed: what flows there may be a mechanism.
                let mut held = pieces.clone();
                open.iter().for_each(|c| held[*c] = Piece::Stick);
                if !self.factorise(held, self.careful) {
                    return None;
                }
            }
            let base = self.base.as_mut()?;
            let base_careful = base.careful;
            let solves = &mut self.counts.solves;
            let local = Local::new((&self.system, &self.points), base, (self.load_step, load), &open, &pieces, solves)?;
            let guess: Vec<Piece> = open.iter().map(|c| pieces[*c]).collect();
            let rate = local.rate.corrected(guess.clone(), &mut self.counts.trials);
            let rate = rate.or_else(|| local.rate.at_constant_load(&guess))?;
            open.iter().zip(&rate.pieces).for_each(|(c, piece)| pieces[*c] = *piece);
            let x = local.combine(base, (self.load_step, load), &rate)?;
            let mut rates = self.refined(&local, Rates::new(&self.system, x, rate.factor, load), load, &pieces);
            self.counts.solves += rates.refinements;
            if rates.factor == 0.0 {
                rates.x[..2 * self.system.contacts].fill(0.0);
                rates = Rates::new(&self.system, rates.x, 0.0, load);
                rates.worst = self.left(&rates, load, &pieces).0;
            } else if !base_careful && rates.shaky(2 * self.system.contacts) {
                self.careful = true;
                continue;
            }
            let moved = self.leaving(&rates, verge, &pieces)?;
            if moved.is_empty() {
                let rates = self.anew(rates, load, &pieces);
                if rates.worst > BELIEVED[0] {
                    return None;
                }
                self.points.iter_mut().zip(pieces).for_each(|(point, piece)| point.piece = piece);
                return Some(self.completed(rates, load));
            }
            let new = moved.into_iter().map(|(_, c, _)| c).filter(|c| !open.contains(c));
            let before = open.len();
            open = open.iter().copied().chain(new).collect();
            if open.len() == before {
                return None;
            }
        }
    }

    /// Points at the verge of a change that a direction with λ̇ = 1 moves out of their pieces: how far,
    /// which, and the piece that mends it. `None` where gaps have no bound.
    fn leaving(&self, rates: &Rates, verge: &[usize], pieces: &[Piece]) -> Option<Vec<(f64, usize, Piece)>> {
        let (x, gaps) = (&rates.x, &rates.gaps);
        let force_size = x[..2 * self.system.contacts].iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        let gap_size = gaps.iter().flatten().fold(0.0, |a: f64, b| a.max(b.abs()));
        if gap_size.is_nan() || gap_size > 1e10 {
            return None;
        }
        let mut changes = Vec::new();
        for (&c, point) in verge.iter().zip(&Self::verges(&self.system, &self.points, verge)) {
            let unknowns = point.unknowns(pieces[c], gaps[c]);
            let force = [x[2 * c], x[2 * c + 1]];
            if let Some((size, to)) = point.violation(pieces[c], &unknowns, force, [force_size, gap_size])
                && size > 1e-10
            {
                changes.push((size, c, to));
            }
        }
        Some(changes)
    }

    /// Some points as the rate problem sees them.
    pub fn verges<'s>(system: &'s System, points: &[Point], at: &[usize]) -> Vec<Verge<'s>> {
        at.iter().map(|&c| points[c].verge(system.facets[c].as_deref().unwrap_or_default())).collect()
    }

    /// The rate problem over the points at the verge of a change. `None` where linear algebra fails.
    fn reduced(&mut self, load: &Load, verge: &[usize]) -> Option<Next> {
        let base = self.base.as_mut()?;
        let pieces: Vec<Piece> = self.points.iter().map(|p| p.settled().unwrap_or(p.piece)).collect();
        let solves = &mut self.counts.solves;
        let mut local = Local::new((&self.system, &self.points), base, (self.load_step, load), verge, &pieces, solves)?;
        local.rate.from_nothing = self.x.iter().all(|v| *v == 0.0);
        let verdict = local.rate.solve(!self.associated, &mut self.counts.trials);
        let (rate, falling) = match verdict {
            Verdict::Found(rate, others) => {
                if others.is_some_and(|n| n > 0) {
                    self.counts.bifurcations += 1;
                    if self.counts.bifurcations == 1 {
                        self.notes.push(format!(
                            "at λ = {:.9} the rate problem has at least {} solutions; the one taken keeps the pieces of the contact points as far as it can",
                            self.factor,
                            others.unwrap_or(0) + 1
                        ));
                    }
                }
                (rate, false)
            }
            Verdict::Falling(rate) => (rate, true),
            Verdict::Nothing => return Some(Next::Nothing),
            Verdict::NoneRises => return Some(Next::NoneRises),
            Verdict::Undecided(combinations) => {
                return Some(Next::Lost(format!(
                    "the rate problem at λ = {:.9} has {} contact points at the verge of a change ({combinations} combinations), and pivoting did not solve it; newton_path or a slightly different mesh or load may pass",
                    self.factor,
                    verge.len()
                )));
            }
        };
        let x = local.combine(base, (self.load_step, load), &rate)?;
        let mut pieces = pieces;
        verge.iter().zip(&rate.pieces).for_each(|(c, piece)| pieces[*c] = *piece);
        let rates = self.refined(&local, Rates::new(&self.system, x, rate.factor, load), load, &pieces);
        self.counts.solves += rates.refinements;
        let rates = self.anew(rates, load, &pieces);
        let rates = if rates.factor != 0.0 && rates.worst > BELIEVED[1] {
            let worst = rates.worst;
            let Some(motion) = self.motion_alone(rates, load, verge, &pieces) else {
                return Some(Next::Lost(format!(
                    "the rates at λ = {:.9} leave {worst:.1e} of their equations: the system is singular to rounding",
                    self.factor
                )));
            };
            motion
        } else {
            rates
        };
        for (&c, piece) in verge.iter().zip(&rate.pieces) {
            self.points[c].piece = *piece;
        }
        let direction = self.completed(rates, load);
        Some(if falling { Next::Falling(direction) } else { Next::Go(direction) })
    }

    /// Refined against all equations in the pieces that were found: responses of single points are not,
    /// and close to a collapse they cancel.
    fn refined(&self, local: &Local, rates: Rates, load: &Load, pieces: &[Piece]) -> Rates {
        let Some(base) = &self.base else { return rates };
        let still = rates.factor == 0.0;
        let mut rates = rates;
        let (mut worst, mut left) = self.left(&rates, load, pieces);
        for _ in 0..REFINED.1 {
            if worst <= REFINED.0 && !still {
                break;
            }
            let Some(step) = local.mended(base, pieces, still, &left) else { break };
            let x = rates.x.iter().zip(&step).map(|(x, s)| x + s).collect();
            let mut better = Rates::new(&self.system, x, rates.factor, load);
            let now = self.left(&better, load, pieces);
            better.refinements = rates.refinements + 1;
            if !still && now.0 >= worst {
                rates.refinements += 1;
                break;
            }
            let rounding = now.0 > 0.5 * worst;
            (rates, (worst, left)) = (better, now);
            if still || rounding {
                break;
            }
        }
        rates.worst = worst;
        rates
    }

    /// The direction solved anew with all pieces in the factorisation, where refinement leaves residuals.
    fn anew(&mut self, rates: Rates, load: &Load, pieces: &[Piece]) -> Rates {
        if rates.factor == 0.0 || rates.worst <= RESIDUAL {
            return rates;
        }
        self.counts.factorisations += 1;
        let Some(mut base) = Base::new(&self.system, pieces.to_vec(), self.careful) else { return rates };
        let Some(direct) = base.load_rate(&self.system, self.load_step, load) else { return rates };
        let x: Vec<f64> = direct.iter().map(|v| v * rates.factor).collect();
        // Where the matrix is singular the sense of its solution is rounding.
        let along: f64 = x.iter().zip(&rates.x).map(|(a, b)| a * b).sum();
        let direct = Rates::new(&self.system, x, rates.factor, load);
        if along > 0.0 && self.left(&direct, load, pieces).0 < rates.worst {
            self.base = Some(base);
            return direct;
        }
        rates
    }

    /// What is left of rates whose system is singular to rounding: the motion alone, where forces are small
    /// beside it and it keeps to its pieces, in the sense in which it does.
    fn motion_alone(&self, rates: Rates, load: &Load, verge: &[usize], pieces: &[Piece]) -> Option<Rates> {
        let forces = 2 * self.system.contacts;
        let largest = |values: &[f64]| values.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        let size = largest(&rates.x[forces..]);
        if largest(&rates.x[..forces]) > SINGULAR * size {
            return None;
        }
        [1.0, -1.0].into_iter().find_map(|sense| {
            let x = rates.x.iter().enumerate().map(|(i, v)| if i < forces { 0.0 } else { sense * v / size });
            let motion = Rates::new(&self.system, x.collect(), 0.0, load);
            let fits = self.leaving(&motion, verge, pieces).is_some_and(|moved| moved.iter().all(|m| m.0 <= SINGULAR));
            (fits && self.left(&motion, load, pieces).0 <= SINGULAR).then_some(motion)
        })
    }

    /// The worst residual of a direction relative to the forces and gaps, and what it leaves of the
    /// equations: the rows of the pieces, then equilibrium.
    fn left(&self, rates: &Rates, load: &Load, pieces: &[Piece]) -> (f64, Vec<f64>) {
        let nc = self.system.contacts;
        let x = &rates.x;
        let largest = |values: &[f64]| values.iter().fold(1e-300, |a: f64, b| a.max(b.abs()));
        // Where everything comes apart forces are zero, up to what is left of them.
        let forces = largest(&x[..2 * nc]).max(rates.factor.abs() * load.size);
        let motions = largest(&x[2 * nc..]).max(forces);
        let mut worst: f64 = 0.0;
        let mut left = Vec::with_capacity(x.len());
        for (c, piece) in pieces.iter().enumerate() {
            let (force, gap) = ([x[2 * c], x[2 * c + 1]], rates.gaps[c]);
            let (pair, sizes) = match piece {
                Piece::Stick => (gap, [motions; 2]),
                Piece::Free | Piece::Corner(..) => (force, [forces; 2]),
                Piece::Facet(_) => match rows(&self.system, c, *piece) {
                    Some([yields, across]) => (
                        [yields[0] * force[0] + yields[1] * force[1], across[2] * gap[0] + across[3] * gap[1]],
                        [forces, motions],
                    ),
                    None => ([0.0; 2], [1.0; 2]),
                },
            };
            worst = worst.max(pair[0].abs() / sizes[0]).max(pair[1].abs() / sizes[1]);
            left.extend([-pair[0], -pair[1]]);
        }
        for (sum, p) in self.system.resultants(x).iter().zip(load.wrench.iter().flatten()) {
            let rest = sum + rates.factor * p;
            worst = worst.max(rest.abs() / forces);
            left.push(-rest);
        }
        (worst, left)
    }

    /// The direction with gaps of all points; those of settled points are made exact.
    fn completed(&mut self, rates: Rates, load: &Load) -> Direction {
        let Rates { mut x, mut gaps, mut factor, .. } = rates;
        // In a mechanism forces and λ stand still; what is left of them beside the motion is rounding.
        let largest = |values: &[f64]| values.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        let forces = 2 * self.system.contacts;
        let stiffest = self.points.iter().map(|p| p.stiffness).fold(1.0, f64::max);
        let still = if factor == 0.0 { 100.0 * MECHANISM * stiffest } else { MECHANISM };
        if largest(&x[..forces]) < still * largest(&x[forces..]) {
            factor = 0.0;
            x[..forces].fill(0.0);
            let still = Rates::new(&self.system, x, factor, load);
            (x, gaps) = (still.x, still.gaps);
        }
        for (c, gap) in gaps.iter_mut().enumerate() {
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
            let mut base = Base::new(&self.system, pieces.clone(), self.careful)?;
            let x = base.load_rate(&self.system, self.load_step, load)?.clone();
            let rates = Rates::new(&self.system, x, 1.0, load);
            let mut changes = self.leaving(&rates, verge, &pieces)?;
            if changes.is_empty() {
                if self.left(&rates, load, &pieces).0 > BELIEVED[0] {
                    return None;
                }
                for (c, piece) in pieces.into_iter().enumerate() {
                    self.points[c].piece = piece;
                }
                self.base = Some(base);
                return Some(self.completed(rates, load));
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
}
