//! Rate problems of one to three points, each one idea, and random ones against complete enumeration.

mod associated;
mod enumeration;
mod fuzzed;
mod numbering;
mod one_point;
mod proofs;
mod random;
mod several_points;

use super::answer::{Budget, Continuation, RateAnswer, answer};
use super::arrival::{Arrival, ArrivalPoint};
use super::counts::RateCounts;
use super::problem::{Rate, RateProblem};
use crate::contact::active_point::ActivePoint;
use crate::contact::mode::ContactMode;
use nalgebra::{DMatrix, DVector};
use voussoir_core::law::Facet;

/// Facets of the laws in these tests: opening, slip with growing tangential force, slip with falling tangential force.
const SLIP: ContactMode = ContactMode::Facet(1);
const BACK: ContactMode = ContactMode::Facet(2);

fn dry(friction: f64, dilatancy: f64) -> Vec<Facet> {
    [vec![Facet::opening(0.0)], Facet::friction(friction, 0.0, dilatancy).to_vec()].concat()
}

/// A rate problem and the arrival of a path that rises.
struct Case<'a> {
    problem: RateProblem<'a>,
    arrival: Arrival,
}

impl<'a> Case<'a> {
    /// Points with these active facets and contact forces, all stuck and none of them in the event.
    fn new(facets: &'a [Facet], points: &[(&[usize], [f64; 2])], s: &[f64], load_rate: &[f64]) -> Case<'a> {
        let n = 2 * points.len();
        let point = |(active, _): &(&[usize], [f64; 2])| ActivePoint {
            facets,
            active: active.to_vec(),
            open: None,
            apex: ActivePoint::is_apex(facets, active),
            guess: ContactMode::Stick,
            stiffness: 1.0,
        };
        let arrived = |(_, force): &(&[usize], [f64; 2])| ArrivalPoint {
            mode: ContactMode::Stick,
            hit: false,
            stops: false,
            force: *force,
        };
        Case {
            problem: RateProblem {
                points: points.iter().map(point).collect(),
                s: DMatrix::from_row_slice(n, n, s),
                load_rate: DVector::from_column_slice(load_rate),
                load_force: 0.0,
                load_flexibility: 0.0,
                metric: None,
                settles: false,
            },
            arrival: Arrival { factor: 1.0, points: points.iter().map(arrived).collect() },
        }
    }

    /// Points that slip in +t at the force (1, friction).
    fn slipping(facets: &'a [Facet], count: usize, s: &[f64], load_rate: &[f64]) -> Case<'a> {
        let force = [1.0, -facets[1].normal[0]];
        Case::new(facets, &vec![(&[1][..], force); count], s, load_rate)
    }

    /// The point was in a mode before, and may be one of the event.
    fn arriving(mut self, k: usize, mode: ContactMode, hit: bool) -> Case<'a> {
        (self.arrival.points[k].mode, self.arrival.points[k].hit) = (mode, hit);
        self
    }

    fn falling(mut self) -> Case<'a> {
        self.arrival.factor = -1.0;
        self
    }

    fn answer(&self) -> RateAnswer {
        answer(&self.problem, &self.arrival, &Budget::default(), &mut RateCounts::default())
    }

    /// The chosen rate and its twins; it satisfies all laws.
    fn goes(&self) -> (Rate, Vec<Rate>) {
        match self.answer().continuation {
            Continuation::Goes { rate, twins } => {
                assert!(self.problem.admits(&rate), "{rate:?}");
                (rate, twins)
            }
            other => panic!("{other:?}"),
        }
    }
}

/// Tangential blocks of a matrix over points: normal stiffness 1, coupling of normal force to slip, and tangential
/// stiffnesses.
fn tangential(count: usize, coupling: f64, stiffness: impl Fn(usize, usize) -> f64) -> Vec<f64> {
    let n = 2 * count;
    let entry = |i: usize, j: usize| match (i % 2, j % 2) {
        (1, 1) => stiffness(i / 2, j / 2),
        (0, 0) => f64::from(u8::from(i == j)),
        _ if i / 2 == j / 2 => coupling,
        _ => 0.0,
    };
    (0..n * n).map(|at| entry(at / n, at % n)).collect()
}

/// The load lowers the normal force of a point, and its slip keeps the distance to the cone: only unloading is left.
fn only_unloading(laws: &[Facet]) -> Case<'_> {
    Case::slipping(laws, 1, &[10.0, 2.0, 2.0, 1.0], &[-1.0, 0.0]).arriving(0, ContactMode::Stick, true)
}
