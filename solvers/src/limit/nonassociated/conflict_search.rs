//! Search for a non-associated limit state with θ ≤ t, or proof that none exists.
//!
//! In every such state each pair i *yields* (s_i = 0) or is *at rest* (γ_i = 0). Statics can refute that a set of pairs
//! yields together; kinematics can refute that a set is at rest together. Each refutation is a clause over the pairs,
//! valid for this and every lower t. Clauses are propagated and combined as in conflict-driven clause learning
//! (Marques-Silva & Sakallah 1999). If neither system refutes, the search sets a moving pair to yield: the pair with
//! most recent refutations, at first the pair with the greatest product s_i γ_i of the two present points.

use crate::limit::settings::SETTINGS;
use crate::optimise::dense_simplex::{Dictionary, Feasibility};

/// A pair and its status, as 2 i + (1 if at rest, 0 if it yields).
type Literal = usize;

fn literal(pair: usize, yields: bool) -> Literal {
    2 * pair + usize::from(!yields)
}

fn pair_of(literal: Literal) -> usize {
    literal / 2
}

/// The end of a search.
#[derive(Debug, Clone, PartialEq)]
pub enum Ending {
    /// These pairs can yield together and move together.
    Found(Vec<usize>),
    /// No state with θ ≤ t exists.
    Exhausted,
    /// The limit of work was reached.
    Limit,
}

/// The state of the search.
pub struct Search {
    /// Statics, with variables s_i.
    pub statics: Dictionary,
    /// Kinematics, with variables γ_i.
    pub kinematics: Dictionary,
    pairs: usize,
    excluded: Vec<bool>,
    value: Vec<Option<bool>>,
    level: Vec<usize>,
    cause: Vec<Option<usize>>,
    trail: Vec<usize>,
    limits: Vec<usize>,
    propagated: usize,
    clauses: Vec<Vec<Literal>>,
    watches: Vec<Vec<usize>>,
    activity: Vec<f64>,
    bump: f64,
    /// Number of refutations.
    pub conflicts: u64,
    /// Number of feasibility questions.
    pub programs: u64,
    empty: bool,
}

impl Search {
    /// Creates a search over two systems; `excluded` pairs never move.
    pub fn new(statics: Dictionary, mut kinematics: Dictionary, excluded: &[bool]) -> Self {
        let pairs = excluded.len();
        for (i, _) in excluded.iter().enumerate().filter(|(_, e)| **e) {
            kinematics.fix(i, true);
        }
        Search {
            statics,
            kinematics,
            pairs,
            excluded: excluded.to_vec(),
            value: excluded.iter().map(|e| e.then_some(false)).collect(),
            level: vec![0; pairs],
            cause: vec![None; pairs],
            trail: Vec::new(),
            limits: Vec::new(),
            propagated: 0,
            clauses: Vec::new(),
            watches: vec![Vec::new(); 2 * pairs],
            activity: vec![0.0; pairs],
            bump: 1.0,
            conflicts: 0,
            programs: 0,
            empty: false,
        }
    }

    fn is_false(&self, l: Literal) -> bool {
        self.value[pair_of(l)] == Some(l % 2 == 1)
    }

    fn is_true(&self, l: Literal) -> bool {
        self.value[pair_of(l)] == Some(l.is_multiple_of(2))
    }

    fn assign(&mut self, l: Literal, cause: Option<usize>) {
        let pair = pair_of(l);
        self.value[pair] = Some(l.is_multiple_of(2));
        self.level[pair] = self.limits.len();
        self.cause[pair] = cause;
        self.trail.push(pair);
        if l.is_multiple_of(2) {
            self.statics.fix(pair, true);
        } else {
            self.kinematics.fix(pair, true);
        }
    }

    fn undo(&mut self, level: usize) {
        let Some(&limit) = self.limits.get(level) else { return };
        for pair in self.trail.drain(limit..) {
            if self.value[pair] == Some(true) {
                self.statics.fix(pair, false);
            } else {
                self.kinematics.fix(pair, false);
            }
            self.value[pair] = None;
        }
        self.limits.truncate(level);
        self.propagated = self.propagated.min(limit);
    }

    /// Propagates unit clauses. Returns the index of a violated clause.
    fn propagate(&mut self) -> Option<usize> {
        while self.propagated < self.trail.len() {
            let pair = self.trail[self.propagated];
            self.propagated += 1;
            let false_now = literal(pair, self.value[pair] == Some(false));
            let mut watching = std::mem::take(&mut self.watches[false_now]);
            let mut kept = 0;
            let mut conflict = None;
            let mut at = 0;
            while at < watching.len() {
                let clause = watching[at];
                at += 1;
                let literals = &mut self.clauses[clause];
                if literals[0] == false_now {
                    literals.swap(0, 1);
                }
                let first = self.clauses[clause][0];
                if self.is_true(first) {
                    watching[kept] = clause;
                    kept += 1;
                    continue;
                }
                let other = (2..self.clauses[clause].len()).find(|&k| !self.is_false(self.clauses[clause][k]));
                if let Some(k) = other {
                    self.clauses[clause].swap(1, k);
                    let l = self.clauses[clause][1];
                    self.watches[l].push(clause);
                    continue;
                }
                watching[kept] = clause;
                kept += 1;
                if self.is_false(first) {
                    conflict = Some(clause);
                    break;
                }
                self.assign(first, Some(clause));
            }
            while at < watching.len() {
                watching[kept] = watching[at];
                kept += 1;
                at += 1;
            }
            watching.truncate(kept);
            self.watches[false_now] = watching;
            if conflict.is_some() {
                return conflict;
            }
        }
        None
    }

    fn add(&mut self, literals: Vec<Literal>) -> usize {
        let index = self.clauses.len();
        if literals.len() >= 2 {
            self.watches[literals[0]].push(index);
            self.watches[literals[1]].push(index);
        }
        self.clauses.push(literals);
        index
    }

    /// Learns from a clause with only false literals: backtracks and asserts the consequence. Returns false if no
    /// decision is left to revise.
    fn learn(&mut self, literals: Vec<Literal>) -> bool {
        self.conflicts += 1;
        let top = literals.iter().map(|&l| self.level[pair_of(l)]).max().unwrap_or(0);
        if top == 0 {
            self.empty = true;
            return false;
        }
        self.undo(top);
        // Resolve until one literal of the highest level is left.
        let mut seen = vec![false; self.pairs];
        let mut learnt: Vec<Literal> = Vec::new();
        let mut open = 0;
        let mut current = literals;
        let mut at = self.trail.len();
        let asserted = loop {
            for &l in &current {
                let pair = pair_of(l);
                if seen[pair] || self.level[pair] == 0 {
                    continue;
                }
                seen[pair] = true;
                self.activity[pair] += self.bump;
                if self.level[pair] == top {
                    open += 1;
                } else {
                    learnt.push(l);
                }
            }
            let pair = loop {
                at -= 1;
                if seen[self.trail[at]] {
                    break self.trail[at];
                }
            };
            open -= 1;
            let false_literal = literal(pair, self.value[pair] == Some(false));
            if open == 0 {
                break false_literal;
            }
            let cause = self.cause[pair].expect("only the decision has no cause, and it comes last");
            let own = literal(pair, self.value[pair] == Some(true));
            current = self.clauses[cause].iter().copied().filter(|&l| l != own).collect();
        };
        self.bump /= 0.95;
        if self.bump > 1e100 {
            self.activity.iter_mut().for_each(|a| *a *= 1e-100);
            self.bump *= 1e-100;
        }
        learnt.sort_by_key(|&l| std::cmp::Reverse(self.level[pair_of(l)]));
        let back = learnt.first().map_or(0, |&l| self.level[pair_of(l)]);
        learnt.insert(0, asserted);
        self.undo(back);
        let clause = self.add(learnt);
        self.assign(asserted, Some(clause));
        true
    }

    /// Makes a reason smaller: tries to leave out each member.
    fn shrink(&mut self, reason: Vec<usize>, statics: bool) -> Vec<usize> {
        let pairs = self.pairs;
        let base = self.excluded.clone();
        let system = if statics { &mut self.statics } else { &mut self.kinematics };
        let before: Vec<bool> = (0..pairs).map(|i| system.is_fixed(i)).collect();
        let permanent = |i: usize| !statics && base[i];
        (0..pairs).filter(|&i| !permanent(i)).for_each(|i| system.fix(i, false));
        let mut kept: Vec<usize> = reason.into_iter().filter(|&i| i < pairs && !permanent(i)).collect();
        kept.iter().for_each(|&i| system.fix(i, true));
        let mut at = 0;
        let mut programs = 0;
        while at < kept.len() {
            let tried = kept[at];
            system.fix(tried, false);
            programs += 1;
            match system.feasible() {
                Feasibility::Reason(smaller) => {
                    let smaller: Vec<usize> = smaller.into_iter().filter(|&i| i < pairs && !permanent(i)).collect();
                    kept.iter().filter(|i| !smaller.contains(i)).for_each(|&i| system.fix(i, false));
                    let done: Vec<usize> = kept[..at].to_vec();
                    kept.retain(|i| smaller.contains(i));
                    at = kept.iter().filter(|i| done.contains(i)).count();
                }
                _ => {
                    system.fix(tried, true);
                    at += 1;
                }
            }
        }
        (0..pairs).for_each(|i| system.fix(i, before[i]));
        self.programs += programs;
        kept
    }

    /// Adds the clause that the pairs of `reason` do not all yield (statics) or are not all at rest (kinematics).
    fn refuse(&mut self, reason: Vec<usize>, statics: bool) -> bool {
        let reason = if reason.len() <= 60 { self.shrink(reason, statics) } else { reason };
        let clause: Vec<Literal> = reason
            .iter()
            .filter(|&&i| i < self.pairs && (statics || !self.excluded[i]))
            .map(|&i| literal(i, !statics))
            .collect();
        self.learn(clause)
    }

    /// Adds the clause that one of two pairs is at rest. Call it before the first decision.
    pub fn not_both(&mut self, first: usize, second: usize) {
        self.restart_with(vec![literal(first, false), literal(second, false)]);
    }

    fn restart_with(&mut self, mut clause: Vec<Literal>) {
        clause.retain(|&l| !self.is_false(l));
        if clause.iter().any(|&l| self.is_true(l)) {
            return;
        }
        match clause.len() {
            0 => self.empty = true,
            1 => {
                let index = self.add(clause.clone());
                self.assign(clause[0], Some(index));
            }
            _ => {
                self.add(clause);
            }
        }
    }

    /// Matrix entries swept so far.
    pub fn work(&self) -> u64 {
        self.statics.work() + self.kinematics.work()
    }

    /// Continues until a state is found, no case is left, or the total work reaches `most`.
    pub fn run(&mut self, most: u64) -> Ending {
        loop {
            if self.empty {
                return Ending::Exhausted;
            }
            if let Some(clause) = self.propagate() {
                let literals = self.clauses[clause].clone();
                if !self.learn(literals) {
                    return Ending::Exhausted;
                }
                continue;
            }
            if self.work() >= most {
                return Ending::Limit;
            }
            // A question that rounding leaves undecided refutes nothing.
            let refuted = [true, false].into_iter().find_map(|statics| {
                self.programs += 1;
                let system = if statics { &mut self.statics } else { &mut self.kinematics };
                if let Feasibility::Reason(reason) = system.feasible() { Some((reason, statics)) } else { None }
            });
            if let Some((reason, statics)) = refuted {
                if !self.refuse(reason, statics) {
                    return Ending::Exhausted;
                }
                continue;
            }
            let gamma: Vec<f64> = (0..self.pairs).map(|i| self.kinematics.value(i).max(0.0)).collect();
            let greatest = gamma.iter().fold(0.0f64, |m, g| m.max(*g));
            let moving: Vec<usize> = (0..self.pairs).filter(|&i| gamma[i] > SETTINGS.active * greatest).collect();
            let product = |i: usize| self.statics.value(i).max(0.0) * gamma[i] / greatest;
            let key = |i: usize| self.activity[i] / self.bump + SETTINGS.active * product(i);
            let chosen =
                moving.iter().copied().filter(|&i| self.value[i].is_none()).max_by(|&a, &b| key(a).total_cmp(&key(b)));
            match chosen {
                Some(pair) => {
                    self.limits.push(self.trail.len());
                    self.assign(literal(pair, true), None);
                }
                None => return Ending::Found(moving),
            }
        }
    }
}
