//! The search: a tree of parts, of which the one with the least bound is divided next.

use super::motions::{nearest, restrict};
use super::points::{Force, Mode, Points};
use super::statics::{Statics, least};
use crate::space::program::{Program, Side};
use crate::space::settings::BRANCHING;
use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::f64::consts::FRAC_PI_4;
use voussoir_core::space::SpaceProblem;

/// The result of a search.
#[derive(Debug, Clone, Copy)]
pub struct Bracket {
    /// No state has a factor below this one.
    pub lower: f64,
    /// Number of parts.
    pub parts: u64,
    /// Matrix entries swept.
    pub work: u64,
}

/// A part of the search.
struct Part {
    /// No state of this part is below this factor.
    bound: f64,
    /// The number of the part: of equal bounds, newer ones come first.
    number: u64,
    modes: Vec<Mode>,
    /// The contacts that do not rest: parts in which they rest are searched elsewhere.
    moving: Vec<bool>,
}

impl PartialEq for Part {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Part {}

impl PartialOrd for Part {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Part {
    /// The greatest part has the least bound.
    fn cmp(&self, other: &Self) -> Ordering {
        other.bound.total_cmp(&self.bound).then(self.number.cmp(&other.number))
    }
}

/// Returns why a problem is not searched.
pub fn misfit(problem: &SpaceProblem) -> Option<String> {
    let (bodies, most) = (problem.bodies, BRANCHING.bodies);
    if bodies > most {
        return Some(format!("the scene has {bodies} blocks that move, and the search for lower loads allows {most}"));
    }
    let fits = problem.contacts.iter().all(|contact| contact.law.is_dry() && contact.law.dilatancy == 0.0);
    (!fits).then(|| "the search for lower loads allows dry joints without dilatancy only".into())
}

/// Proves that no collapse state with the laws' own flow is below a factor, from the start to a known factor above it. `most`: greatest
/// number of matrix entries that are swept. The problem has no [`misfit`].
pub fn lower_bound(problem: &SpaceProblem, start: f64, known: f64, most: u64) -> Bracket {
    let program = Program::new(problem, start, Side::Inner);
    let points = Points::new(problem, &program);
    let top = (known - start) / program.unit * (1.0 - BRANCHING.gap);
    let open = BinaryHeap::new();
    let mut search = Search { points, top, closed: f64::INFINITY, work: 0, parts: 0, pushed: 0, open };
    let modes = vec![Mode::Undecided; search.points.points.len()];
    search.push(0.0, modes, vec![false; problem.contacts.len()]);
    let lower = search.run(most);
    Bracket { lower: start + lower * program.unit, parts: search.parts, work: search.work }
}

/// A search in work.
struct Search {
    points: Points,
    /// The factor at which the proof ends.
    top: f64,
    /// The least bound of parts that cannot be divided.
    closed: f64,
    work: u64,
    /// Numbers of the parts that were searched, and of all parts.
    parts: u64,
    pushed: u64,
    open: BinaryHeap<Part>,
}

impl Search {
    /// Divides parts until the bound is proved or the work is used up, and returns the proved bound.
    fn run(&mut self, most: u64) -> f64 {
        while let Some(part) = self.open.pop() {
            if self.work >= most || part.bound >= self.closed {
                return part.bound.min(self.closed).min(self.top);
            }
            self.parts += 1;
            self.divide(part);
        }
        self.closed.min(self.top)
    }

    fn divide(&mut self, Part { bound, mut modes, moving, .. }: Part) {
        if !restrict(&self.points, &mut modes, self.top, &mut self.work) || self.rests_elsewhere(&modes, &moving) {
            return;
        }
        let (bound, forces) = match self.statics(&modes) {
            Statics::Impossible => return,
            Statics::Least(least, forces) => (bound.max(least * (1.0 - BRANCHING.outward)), forces),
            Statics::Undecided => (bound, vec![[1.0, 0.0, 0.0]; modes.len()]),
        };
        let Some(jumps) = nearest(&self.points, &modes, &forces, self.top, &mut self.work) else { return };
        let Some(place) = self.worst((&modes, &moving), &forces, &jumps) else {
            if self.refine(&modes, &forces, BRANCHING.outward) {
                self.push(bound, modes, moving);
            } else {
                self.closed = self.closed.min(bound);
            }
            return;
        };
        if modes[place] == Mode::Undecided {
            return self.divide_contact(self.points.points[place].contact, (bound, &modes, &moving));
        }
        for mode in divided(modes[place]) {
            let mut modes = modes.clone();
            modes[place] = mode;
            self.push(bound, modes, moving.clone());
        }
    }

    fn push(&mut self, bound: f64, modes: Vec<Mode>, moving: Vec<bool>) {
        self.pushed += 1;
        self.open.push(Part { bound, number: self.pushed, modes, moving });
    }

    /// Divides a part by the modes of a contact: it rests, or it moves with one of its faces closed.
    fn divide_contact(&mut self, contact: usize, (bound, known, moving): (f64, &[Mode], &[bool])) {
        let points = &self.points.points;
        let places: Vec<usize> = (0..points.len()).filter(|place| points[*place].contact == contact).collect();
        // Without friction a contact that rests has no more forces than one that slips.
        let rough = points[places[0]].friction > 0.0;
        let mut parts: Vec<(Vec<Mode>, bool)> = Vec::new();
        let mut add = |mode: &dyn Fn(usize) -> Mode, moves: bool| {
            let mut modes = known.to_vec();
            places.iter().for_each(|place| modes[*place] = mode(*place));
            parts.push((modes, moves));
        };
        if rough {
            add(&|_| Mode::Sticks, false);
        }
        // A face that does not contain all points known to be closed is part of a greater one.
        let closed: Vec<usize> = places.iter().copied().filter(|place| known[*place] != Mode::Undecided).collect();
        for face in self.points.faces[contact].iter().filter(|face| closed.iter().all(|place| face.contains(place))) {
            let mode = |place: usize| match known[place] {
                _ if !face.contains(&place) => Mode::Open,
                Mode::Undecided => Mode::Closed,
                mode => mode,
            };
            add(&mode, rough);
        }
        for (modes, moves) in parts {
            let mut moving = moving.to_vec();
            moving[contact] = moves;
            self.push(bound, modes, moving);
        }
    }

    /// Returns true if a contact rests that rests in another part.
    fn rests_elsewhere(&self, modes: &[Mode], moving: &[bool]) -> bool {
        let mut rests = moving.to_vec();
        for (point, mode) in self.points.points.iter().zip(modes) {
            rests[point.contact] &= *mode == Mode::Sticks;
        }
        rests.contains(&true)
    }

    /// Returns the least forces. Points whose friction is exceeded get more tangents first.
    fn statics(&mut self, modes: &[Mode]) -> Statics {
        for _ in 0..BRANCHING.rounds {
            let found = least(&self.points, modes, self.top, &mut self.work);
            match &found {
                Statics::Least(_, forces) if self.refine(modes, forces, BRANCHING.exceeded) => {}
                _ => return found,
            }
        }
        least(&self.points, modes, self.top, &mut self.work)
    }

    /// Adds tangents at points whose friction is exceeded by a share. Returns false if there is no such point.
    fn refine(&mut self, modes: &[Mode], forces: &[Force], excess: f64) -> bool {
        let points = self.points.points.iter_mut().zip(modes).zip(forces);
        let full = points.filter(|((_, mode), _)| mode.carries_all());
        full.map(|((point, _), force)| point.refine(force, excess)).filter(|refined| *refined).count() > 0
    }

    /// Returns the point to divide: a closed one of a contact that moves, then the point with the most power left, then the widest
    /// loaded sector.
    fn worst(&self, (modes, moving): (&[Mode], &[bool]), forces: &[Force], jumps: &[[f64; 3]]) -> Option<usize> {
        let divisible = |place: &usize| match modes[*place] {
            Mode::Undecided => true,
            Mode::Closed => self.points.points[*place].friction > 0.0,
            Mode::Slips([from, to]) => to - from > BRANCHING.narrow,
            Mode::Open | Mode::Sticks => false,
        };
        let left = |place: usize| {
            let point = &self.points.points[place];
            let ([n, s, t], [opening, first, second]) = (point.within_friction(forces[place]), jumps[place]);
            n * opening + s * first + t * second + point.friction * n * first.hypot(second)
        };
        let width = |place: usize| match modes[place] {
            Mode::Slips([from, to]) => (to - from) * forces[place][0],
            _ => 0.0,
        };
        let greatest = |of: &dyn Fn(usize) -> f64, least: f64| {
            let places = (0..modes.len()).filter(divisible).map(|place| (of(place), place));
            let places = places.filter(|(value, _)| *value > least);
            places.max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)))
        };
        let size = jumps.iter().flatten().fold(0.0f64, |most, jump| most.max(jump.abs()));
        let most = forces.iter().fold(0.0f64, |most, force| most.max(force[0]));
        // Contacts that do not depend on each other add to the work if one is decided before the next is begun.
        let begun = |place: usize| {
            if modes[place] == Mode::Closed && moving[self.points.points[place].contact] {
                1.0 + left(place)
            } else {
                0.0
            }
        };
        let by_power = || greatest(&left, BRANCHING.fits * size * most);
        greatest(&begun, 0.0)
            .or_else(by_power)
            .or_else(|| greatest(&width, 0.0))
            .or_else(|| greatest(&|_| 0.0, f64::NEG_INFINITY))
            .map(|(_, place)| place)
    }
}

/// Returns modes that together contain a mode.
fn divided(mode: Mode) -> Vec<Mode> {
    match mode {
        Mode::Closed => {
            let sector = |k: u8| Mode::Slips([1.0, 3.0].map(|end| FRAC_PI_4 * (f64::from(2 * k) + end)));
            (0..4).map(sector).chain([Mode::Sticks]).collect()
        }
        Mode::Slips([from, to]) => {
            let middle = f64::midpoint(from, to);
            vec![Mode::Slips([from, middle]), Mode::Slips([middle, to])]
        }
        Mode::Undecided | Mode::Open | Mode::Sticks => vec![mode],
    }
}
