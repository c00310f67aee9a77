//! Rate problems by every algorithm against complete enumeration.

use crate::contact::active_point::ActivePoint;
use crate::contact::mode::ContactMode;
use crate::optimise::lcg::Lcg;
use crate::rate::active_set::active_set;
use crate::rate::branching::branching;
use crate::rate::enumerate::enumerate_modes;
use crate::rate::homotopy::homotopy;
use crate::rate::lcp::{Pivoted, pivoting};
use crate::rate::line_search::line_search;
use crate::rate::problem::{Rate, RateOutcome, RateProblem};
use crate::rate::solve::{RateCounts, solve};
use nalgebra::{DMatrix, DVector};
use std::collections::BTreeMap;
use voussoir_core::law::Facet;

/// Dry friction without dilatancy at its apex.
fn facets(friction: f64) -> Vec<Facet> {
    [vec![Facet::opening(0.0)], Facet::friction(friction, 0.0, 0.0).to_vec()].concat()
}

/// Branching and every combination of modes find the same kind of rate.
#[test]
fn branching_agrees_with_every_combination() {
    let mut random = Lcg::new(11);
    let mut kinds = [0; 4];
    for number in 0..300 {
        let count = 1 + number % 3;
        let laws = facets(0.3 + 1.2 * (number % 5) as f64);
        let root = DMatrix::from_fn(2 * count, 2 * count, |_, _| random.next());
        // At the apex, or pressed and slipping one way.
        let point = |k: usize| ActivePoint {
            facets: &laws,
            active: if (number + k).is_multiple_of(4) { vec![0, 1, 2] } else { vec![1 + k % 2] },
            open: None,
            apex: (number + k).is_multiple_of(4),
            guess: ContactMode::Stick,
            hit: true,
            stiffness: 1.0,
        };
        let problem = RateProblem {
            points: (0..count).map(point).collect(),
            s: &root * root.transpose() + DMatrix::identity(2 * count, 2 * count) * 0.01,
            load_rate: DVector::from_fn(2 * count, |_, _| random.next()),
            from_nothing: false,
            load_force: 0.0,
            load_flexibility: 0.0,
            metric: None,
            settles: false,
        };
        let all = enumerate_modes(&problem, &mut 0);
        let known = if all.iter().any(|r| r.factor > 0.0) {
            0
        } else if all.iter().any(|r| r.factor == 0.0) {
            1
        } else if all.iter().any(|r| problem.goes_on(r)) {
            2
        } else {
            3
        };
        let found = match branching(&problem, &mut 0).expect("decided") {
            RateOutcome::Found(rate, _) if rate.factor > 0.0 => 0,
            RateOutcome::Found(..) => 1,
            RateOutcome::Falling(_) => 2,
            _ => 3,
        };
        assert_eq!(known, found, "{number}: {all:?}");
        kinds[known] += 1;
    }
    assert!(kinds[0] > 100 && kinds[2] + kinds[3] > 10, "{kinds:?}");
}

/// Whether a rate satisfies the law of every point, by the definition: ġ lies in the cone of the flows of those active
/// facets on which ṙ stays, and ṙ leaves none of the others outwards. An opening facet that is open keeps ṙ on it.
fn holds(problem: &RateProblem, rate: &Rate) -> bool {
    let gaps = DVector::from_iterator(2 * rate.gaps.len(), rate.gaps.iter().flatten().copied());
    let forces = &problem.s * &gaps + &problem.load_rate * rate.factor;
    let gap_size = gaps.amax().max(1e-300);
    let force_size = forces.amax().max(problem.s.amax() * gap_size).max(1e-300);
    problem.points.iter().enumerate().all(|(k, point)| {
        let (r, g) = ([forces[2 * k], forces[2 * k + 1]], rate.gaps[k]);
        let slack = |i: usize| -(point.facets[i].normal[0] * r[0] + point.facets[i].normal[1] * r[1]) / force_size;
        if point.active.iter().any(|i| slack(*i) < -1e-8) || point.open.is_some_and(|i| slack(i).abs() > 1e-8) {
            return false;
        }
        // Directions that ġ may be made of.
        let mut flows: Vec<[f64; 2]> = Vec::new();
        for &i in point.active.iter().filter(|i| slack(**i).abs() <= 1e-8) {
            let d = point.facets[i].flow;
            flows.push([-d[0], -d[1]]);
            if point.open == Some(i) {
                flows.push(d);
            }
        }
        let small = |v: [f64; 2]| v[0].abs().max(v[1].abs()) <= 1e-7 * gap_size;
        let along = |d: [f64; 2]| {
            let share = (g[0] * d[0] + g[1] * d[1]) / (d[0] * d[0] + d[1] * d[1]);
            share >= 0.0 && small([g[0] - share * d[0], g[1] - share * d[1]])
        };
        let between = |a: [f64; 2], b: [f64; 2]| {
            let determinant = a[0] * b[1] - a[1] * b[0];
            let shares = [(g[0] * b[1] - g[1] * b[0]) / determinant, (a[0] * g[1] - a[1] * g[0]) / determinant];
            determinant != 0.0 && shares.iter().all(|s| *s >= -1e-7 * gap_size)
        };
        small(g)
            || flows.iter().any(|d| along(*d))
            || flows.iter().enumerate().any(|(i, a)| flows[i + 1..].iter().any(|b| between(*a, *b)))
    })
}

/// A law with the facets that are active, whether the point is open with a strength, and at the apex.
struct Sample {
    facets: Vec<Facet>,
    active: Vec<usize>,
    open: Option<usize>,
    apex: bool,
}

/// Laws of the fuzzed problems.
fn laws(random: &mut Lcg) -> Vec<Sample> {
    let mut all = Vec::new();
    for dilatancy in [0.0, 0.3, 1.0] {
        let friction = 0.2 + 2.5 * random.next().abs();
        let slip = |cohesion: f64| Facet::friction(friction, cohesion, dilatancy * friction).to_vec();
        let dry = [vec![Facet::opening(0.0)], slip(0.0)].concat();
        let strong = [vec![Facet::opening(0.4)], slip(1.0), vec![Facet::crushing(9.0)]].concat();
        let mut add = |facets: &[Facet], active: &[usize], open, apex| {
            all.push(Sample { facets: facets.to_vec(), active: active.to_vec(), open, apex });
        };
        add(&dry, &[0, 1, 2], None, true);
        add(&dry, &[1], None, false);
        add(&dry, &[2], None, false);
        add(&strong, &[1, 3], None, false);
        add(&strong, &[0, 2], None, false);
        add(&strong, &[0, 1], Some(0), false);
    }
    all
}

/// What algorithms found of the problems of a family that the active set does not solve at once.
#[derive(Debug, Default)]
struct Tally {
    problems: usize,
    at_once: usize,
    decided: BTreeMap<&'static str, usize>,
    alone: BTreeMap<&'static str, usize>,
    undecided: usize,
    unlike_enumeration: Vec<usize>,
    order: RateCounts,
}

/// All algorithms on a problem that the active set does not solve: those that give a rate with λ growing, or a
/// mechanism, or a proof.
fn deciders(problem: &RateProblem, number: usize) -> Vec<&'static str> {
    let trials = &mut 0;
    let mut all = Vec::new();
    let mut note = |name: &'static str, rate: Option<Rate>| {
        if let Some(rate) = rate {
            assert!(holds(problem, &rate), "{number}: {name} {rate:?}");
            all.push(name);
        }
    };
    match pivoting(problem, false, trials) {
        Some(Pivoted::Guess(modes)) => {
            note("pivoting", active_set(problem, modes, trials));
        }
        Some(Pivoted::Ray(rate)) => note("pivoting", Some(rate)),
        None => {}
    }
    let stuck = vec![ContactMode::Stick; problem.points.len()];
    note("line search", line_search(problem, &stuck, trials));
    let by_path = (0..8).find_map(|start| {
        let (modes, gaps) = homotopy(problem, start, trials)?;
        active_set(problem, modes.clone(), trials).or_else(|| problem.mechanism_near(&modes, &gaps))
    });
    note("homotopy", by_path);
    match branching(problem, trials) {
        Some(RateOutcome::Found(rate, _) | RateOutcome::Falling(rate)) => note("branching", Some(rate)),
        Some(_) => all.push("branching"),
        None => {}
    }
    all
}

/// Random rate problems of three sizes: every accepted rate satisfies the laws by their definition, and on few points
/// the outcome is that of complete enumeration. `VOUSSOIR_RATE_FUZZ` sets how many; the table says who decided.
#[test]
fn fuzzed_rate_problems_are_solved() {
    let long = std::env::var("VOUSSOIR_RATE_FUZZ").ok().and_then(|n| n.parse::<usize>().ok());
    let mut random = Lcg::new(29);
    let mut tallies: BTreeMap<&str, Tally> = BTreeMap::new();
    for number in 0..long.unwrap_or(150) {
        let (family, count) = match number % 8 {
            0..=3 => ("1-4 points", 1 + number / 8 % 4),
            4..=6 => ("5-8 points", 5 + number / 8 % if long.is_some() { 4 } else { 2 }),
            _ => ("20-40 points", 20 + number / 8 % 21),
        };
        let laws = laws(&mut random);
        let chosen: Vec<usize> = (0..count).map(|_| ((random.next() + 1.0) * 9.0) as usize).collect();
        // Elastic structures with fewer or more freedoms than points, pushed by a load on them.
        let columns = [2 * count, count + 1, 3 * count][number / 3 % 3];
        let root = DMatrix::from_fn(2 * count, columns, |_, _| random.next());
        let soft = [0.0, 1e-3, 0.1][number / 5 % 3];
        let mut point = |k: &usize| {
            let Sample { facets, active, open, apex } = &laws[*k];
            let (active, guess) = (active.clone(), ContactMode::Stick);
            let mut point = ActivePoint { facets, active, open: *open, apex: *apex, guess, hit: true, stiffness: 1.0 };
            let candidates = point.candidates();
            point.guess = candidates[((random.next() + 1.0) / 2.0 * candidates.len() as f64) as usize];
            point
        };
        let points: Vec<ActivePoint> = chosen.iter().map(&mut point).collect();
        let push = DVector::from_fn(columns, |_, _| random.next());
        let s = &root * root.transpose() + DMatrix::identity(2 * count, 2 * count) * soft;
        let load_rate = match number % 2 {
            0 => &root * push,
            _ => DVector::from_fn(2 * count, |_, _| random.next()),
        };
        let problem = RateProblem {
            points,
            s,
            load_rate,
            from_nothing: false,
            load_force: 0.0,
            load_flexibility: 0.0,
            metric: None,
            settles: false,
        };
        let tally = tallies.entry(family).or_default();
        tally.problems += 1;
        let outcome = solve(&problem, false, &mut tally.order);
        match &outcome {
            RateOutcome::Found(rate, _) | RateOutcome::Falling(rate) => {
                assert!(holds(&problem, rate), "{number}: {rate:?}");
            }
            RateOutcome::Undecided(_) => tally.undecided += 1,
            RateOutcome::NoRate | RateOutcome::NoneRises => {}
        }
        if count <= 4 {
            let all = enumerate_modes(&problem, &mut 0);
            let rises = all.iter().any(|rate| rate.factor > 0.0);
            let found = matches!(&outcome, RateOutcome::Found(rate, _) if rate.factor > 0.0);
            if rises != found {
                tally.unlike_enumeration.push(number);
            }
        }
        let guess = problem.points.iter().map(|p| p.guess).collect();
        if active_set(&problem, guess, &mut 0).is_some() {
            tally.at_once += 1;
        } else if long.is_some() || number % 3 == 0 {
            let deciders = deciders(&problem, number);
            deciders.iter().for_each(|name| *tally.decided.entry(name).or_default() += 1);
            if let [name] = deciders[..] {
                *tally.alone.entry(name).or_default() += 1;
            }
        }
    }
    assert!(tallies.values().all(|tally| tally.unlike_enumeration.is_empty()), "{tallies:#?}");
    assert!(tallies.values().all(|tally| tally.at_once > 0 && 10 * tally.undecided <= tally.problems), "{tallies:#?}");
}
