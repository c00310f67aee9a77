//! Closes the small gaps that a finite motion along constant velocities leaves at hinges.
//!
//! Velocities agree at hinges, finite motions along them only to second order. Blocks that move as
//! one are taken together as links; the links get the least corrections (Gauss–Newton) that bring
//! the two sides of every hinge together again.

use super::displaced::Placement;
use nalgebra::{DMatrix, DVector};
use voussoir_core::certificate::Mechanism;
use voussoir_core::model::geometry::{Vec2, turned};
use voussoir_core::model::{Assembly, root};

/// With more unknowns or more equations than this the gaps stay: they are a matter of looks.
const GREATEST: usize = 150;

/// Bounds the iterations of one decomposition.
const MAX_SVD_ITERATIONS: usize = 10_000;

/// Corrects placements so that hinges stay closed. Bodies at rest stay at rest. Hinges of joints that slide, or
/// crush over more than a toe, are left alone: they do not stay where they are.
pub fn close_hinges(assembly: &Assembly, mechanism: &Mechanism, mut placements: Vec<Placement>) -> Vec<Placement> {
    let wanders = |joint: usize| mechanism.sliding.iter().any(|slide| slide.joint == joint) || mechanism.crushes(joint);
    let (link_of, links) = links(assembly, &placements);
    let hinges: Vec<(usize, usize, Vec2)> = mechanism
        .hinges
        .iter()
        .filter(|hinge| !wanders(hinge.joint))
        .filter_map(|hinge| {
            let joint = assembly.joints.get(hinge.joint)?;
            (link_of[joint.minus] != link_of[joint.plus]).then(|| (joint.minus, joint.plus, Vec2::from(hinge.point)))
        })
        .collect();
    if links == 0 || hinges.is_empty() || 3 * links > GREATEST || 2 * hinges.len() > GREATEST {
        return placements;
    }
    let length = 0.3 * assembly.size();
    let mut pivots = vec![(Vec2::zeros(), 0.0); links];
    for &(minus, plus, point) in &hinges {
        for body in [minus, plus] {
            if let Some(link) = link_of[body] {
                pivots[link].0 += placements[body].of(point);
                pivots[link].1 += 1.0;
            }
        }
    }
    let pivots: Vec<Vec2> = pivots.into_iter().map(|(sum, count)| sum / f64::max(count, 1.0)).collect();
    for _ in 0..12 {
        let mut matrix = DMatrix::<f64>::zeros(2 * hinges.len(), 3 * links);
        let mut gaps = DVector::<f64>::zeros(2 * hinges.len());
        for (row, &(minus, plus, point)) in hinges.iter().enumerate() {
            for (body, sign) in [(minus, -1.0), (plus, 1.0)] {
                let place = placements[body].of(point);
                (0..2).for_each(|i| gaps[2 * row + i] += sign * place[i]);
                if let Some(link) = link_of[body] {
                    let arm = turned(place - pivots[link]) / length;
                    for i in 0..2 {
                        matrix[(2 * row + i, 3 * link + i)] += sign;
                        matrix[(2 * row + i, 3 * link + 2)] += sign * arm[i];
                    }
                }
            }
        }
        if gaps.amax() < 1e-9 * assembly.size() {
            break;
        }
        if !gaps.iter().chain(&matrix).all(|x| x.is_finite()) {
            break;
        }
        let factors = matrix.try_svd(true, true, f64::EPSILON, MAX_SVD_ITERATIONS);
        let Some(Ok(step)) = factors.map(|svd| svd.solve(&-gaps, 1e-6)) else { break };
        for (placement, link) in placements.iter_mut().zip(&link_of) {
            if let Some(link) = *link {
                let shift = Vec2::new(step[3 * link], step[3 * link + 1]);
                *placement = placement.then(pivots[link], step[3 * link + 2] / length, shift);
            }
        }
    }
    placements
}

/// For each body the number of its link, `None` where it rests, and how many links there are:
/// neighbours whose joint keeps both its ends together move as one.
fn links(assembly: &Assembly, placements: &[Placement]) -> (Vec<Option<usize>>, usize) {
    let tolerance = 1e-6 * assembly.size();
    let mut parent: Vec<usize> = (0..placements.len()).collect();
    for joint in &assembly.joints {
        let apart = |end: &Vec2| (placements[joint.minus].of(*end) - placements[joint.plus].of(*end)).norm();
        if joint.ends.iter().all(|end| apart(end) < tolerance) {
            let (a, b) = (root(&mut parent, joint.minus), root(&mut parent, joint.plus));
            parent[a] = b;
        }
    }
    let mut still = vec![false; placements.len()];
    for (body, placement) in placements.iter().enumerate() {
        let r = root(&mut parent, body);
        still[r] |= *placement == Placement::rest();
    }
    let (mut number, mut count) = (vec![None; placements.len()], 0);
    let link_of = (0..placements.len())
        .map(|body| {
            let r = root(&mut parent, body);
            (!still[r]).then(|| {
                *number[r].get_or_insert_with(|| {
                    count += 1;
                    count - 1
                })
            })
        })
        .collect();
    (link_of, count)
}
