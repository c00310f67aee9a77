//! Random rate problems over laws of all kinds, with fewer and more freedoms than points.

use super::enumeration::enumerate_modes;
use super::*;
use std::collections::BTreeMap;
use voussoir_core::random::Random;

/// A law with the facets that are active, and whether the point is open with a strength.
struct Sample {
    facets: Vec<Facet>,
    active: Vec<usize>,
    open: Option<usize>,
}

/// Laws of the fuzzed problems.
fn samples(random: &mut Random) -> Vec<Sample> {
    let mut all = Vec::new();
    for dilatancy in [0.0, 0.3, 1.0] {
        let friction = 0.2 + 2.5 * random.signed().abs();
        let slip = |cohesion: f64| Facet::friction(friction, cohesion, dilatancy * friction).to_vec();
        let dry = [vec![Facet::opening(0.0)], slip(0.0)].concat();
        let strong = [vec![Facet::opening(0.4)], slip(1.0), vec![Facet::crushing(9.0)]].concat();
        let mut add = |facets: &[Facet], active: &[usize], open| {
            all.push(Sample { facets: facets.to_vec(), active: active.to_vec(), open });
        };
        add(&dry, &[0, 1, 2], None);
        add(&dry, &[1], None);
        add(&dry, &[2], None);
        add(&strong, &[1, 3], None);
        add(&strong, &[0, 2], None);
        add(&strong, &[0, 1], Some(0));
    }
    all
}

/// A structure on some points, all of one event, pushed by a load on its freedoms or at the points.
fn case<'a>(samples: &'a [Sample], count: usize, number: usize, random: &mut Random) -> Case<'a> {
    let chosen: Vec<&Sample> = (0..count).map(|_| &samples[((random.signed() + 1.0) * 9.0) as usize]).collect();
    let columns = [2 * count, count + 1, 3 * count][number / 3 % 3];
    let root = DMatrix::from_fn(2 * count, columns, |_, _| random.signed());
    let soft = [0.0, 1e-3, 0.1][number / 5 % 3];
    let point = |sample: &&'a Sample| ActivePoint {
        facets: &sample.facets,
        active: sample.active.clone(),
        open: sample.open,
        apex: sample.open.is_none() && ActivePoint::is_apex(&sample.facets, &sample.active),
        guess: ContactMode::Stick,
        stiffness: 1.0,
    };
    let arrived = |sample: &&Sample| ArrivalPoint {
        mode: sample.open.map_or(ContactMode::Stick, |open| ContactMode::Facet(open as u8)),
        hit: true,
        stops: false,
        force: [0.0; 2],
    };
    let push = DVector::from_fn(columns, |_, _| random.signed());
    let load_rate = match number % 2 {
        0 => &root * push,
        _ => DVector::from_fn(2 * count, |_, _| random.signed()),
    };
    let problem = RateProblem {
        points: chosen.iter().map(point).collect(),
        s: &root * root.transpose() + DMatrix::identity(2 * count, 2 * count) * soft,
        load_rate,
        load_force: 0.0,
        load_flexibility: 0.0,
        metric: None,
        settles: false,
    };
    Case { problem, arrival: Arrival { factor: 1.0, points: chosen.iter().map(arrived).collect() } }
}

/// Every accepted rate satisfies the laws, on few points a rate rises exactly if some combination of modes does, and few
/// problems are left open. `VOUSSOIR_RATE_FUZZ` sets the number of problems.
#[test]
fn fuzzed_rate_problems_are_answered() {
    let long = std::env::var("VOUSSOIR_RATE_FUZZ").ok().and_then(|n| n.parse::<usize>().ok());
    let mut random = Random::from_state(29);
    let mut tallies: BTreeMap<&str, (usize, usize, RateCounts)> = BTreeMap::new();
    for number in 0..long.unwrap_or(150) {
        let (family, count) = match number % 8 {
            0..=3 => ("1-4 points", 1 + number / 8 % 4),
            4..=6 => ("5-8 points", 5 + number / 8 % 4),
            _ => ("20-40 points", 20 + number / 8 % 21),
        };
        let samples = samples(&mut random);
        let case = case(&samples, count, number, &mut random);
        let (problems, open, counts) = tallies.entry(family).or_default();
        *problems += 1;
        let budget = Budget { leaves: 2000, ..Budget::default() };
        let found = answer(&case.problem, &case.arrival, &budget, counts);
        let rises = match &found.continuation {
            Continuation::Goes { rate, twins } => {
                std::iter::once(rate).chain(twins).for_each(|rate| assert!(case.problem.admits(rate), "{number}"));
                Some(rate.factor > 0.0)
            }
            Continuation::NoneContinues(_) => Some(false),
            Continuation::Open(_) => None,
        };
        *open += usize::from(rises.is_none());
        if let Some(proof) = &found.none_rises {
            super::proofs::check(&case.problem, proof);
        }
        if let (true, Some(rises)) = (count <= 4, rises) {
            let all = enumerate_modes(&case.problem, &mut 0);
            assert_eq!(all.iter().any(|rate| rate.factor > 0.0), rises, "{number}: {all:?}");
        }
    }
    assert!(tallies.values().all(|(problems, open, _)| 10 * open <= *problems), "{tallies:#?}");
}
