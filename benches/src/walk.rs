//! A path of strains at one point of the cap model, and its integration with two kinds of steps: one return for each increment
//! ("full"), and step halving with extrapolation inside each increment ("adaptive"). The path has four straight increments, which
//! change direction while the material yields. "Full" divides the increments equally. The reference is the path in 2^17 returns,
//! extrapolated.

use crate::point::{ordinary_stone, paper_stone, states};
use std::time::Instant;
use voussoir::core::law::{BulkMaterial, StressUpdate, UpdateContext};

/// Six components of strain or stress.
type Strain = [f64; 6];

/// Increments of the path, each straight, as a finite-element program would give them.
const INCREMENTS: u32 = 4;

/// The path: straight between the ends of its increments.
fn path(size: f64, s: f64) -> Strain {
    let along = s * f64::from(INCREMENTS);
    let corner = along.floor().min(f64::from(INCREMENTS - 1));
    let at = |corner: f64| curve(size, corner / f64::from(INCREMENTS));
    between(&at(corner), &at(corner + 1.0), along - corner)
}

/// Compression with shear that changes direction: reaches cap and shear surface.
fn curve(size: f64, s: f64) -> Strain {
    let turn = 2.0 * s;
    let axial = -size * s;
    [axial, 0.2 * axial * turn.cos(), 0.1 * axial, 0.8 * size * s * turn.sin(), 0.3 * size * s * s, 0.0]
}

fn between(a: &Strain, b: &Strain, s: f64) -> Strain {
    std::array::from_fn(|i| a[i] + s * (b[i] - a[i]))
}

struct Walk<'a> {
    update: &'a dyn StressUpdate,
    state: Vec<f64>,
    stress: Strain,
    calls: u64,
}

impl Walk<'_> {
    fn one(&mut self, strain: &Strain, from: &[f64], to: &mut [f64]) -> Strain {
        self.calls += 1;
        self.update.update_point(strain, &UpdateContext::of_length(1.0), from, to).expect("the update converges").stress
    }

    /// One implicit return.
    fn full(&mut self, strain: &Strain) {
        let mut new = self.state.clone();
        let old = std::mem::take(&mut self.state);
        self.stress = self.one(strain, &old, &mut new);
        self.state = new;
    }

    /// Divides an increment into parts. Each part is computed as one return and as two; their difference controls the
    /// size of the next part. The result is twice the state of two returns minus that of one (implicit Euler
    /// extrapolated to second order); the stress comes from a return of zero length from there.
    fn adaptive(&mut self, from: &Strain, to: &Strain, tolerance: f64, scale: f64) {
        let (mut done, mut part) = (0.0, 1.0_f64);
        let size = self.state.len();
        let (mut coarse, mut half, mut fine) = (vec![0.0; size], vec![0.0; size], vec![0.0; size]);
        while done < 1.0 {
            part = part.min(1.0 - done);
            let end = if done + part >= 1.0 - 1e-12 { 1.0 } else { done + part };
            let (middle, last) = (between(from, to, 0.5 * (done + end)), between(from, to, end));
            let old = self.state.clone();
            let a = self.one(&last, &old, &mut coarse);
            self.one(&middle, &old, &mut half);
            // Yield begins in the second half: both results are then one return and their difference gives no
            // information. The elastic half is exact; continue from there with half the part.
            if half == old && coarse != old && part > 1e-6 {
                done = 0.5 * (done + end);
                part *= 0.5;
                continue;
            }
            let b = self.one(&last, &half, &mut fine);
            let error = a.iter().zip(&b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / scale;
            if error <= tolerance || part < 1e-6 {
                for (state, (fine, coarse)) in self.state.iter_mut().zip(fine.iter().zip(&coarse)) {
                    *state = 2.0 * fine - coarse;
                }
                let extrapolated = self.state.clone();
                let mut settled = extrapolated.clone();
                self.stress = self.one(&last, &extrapolated, &mut settled);
                self.state = settled;
                done = end;
            }
            part *= (0.9 * (tolerance / error.max(1e-30)).sqrt()).clamp(0.1, 4.0);
        }
    }
}

fn start(update: &dyn StressUpdate) -> Walk<'_> {
    Walk { update, state: states(update, 1), stress: [0.0; 6], calls: 0 }
}

/// Returns the stress at the end, the number of returns, and the seconds of one walk.
fn full(update: &dyn StressUpdate, size: f64, steps: u32) -> (Strain, u64, f64) {
    timed(|| {
        let mut walk = start(update);
        (1..=steps).for_each(|i| walk.full(&path(size, f64::from(i) / f64::from(steps))));
        (walk.stress, walk.calls)
    })
}

fn adaptive(update: &dyn StressUpdate, size: f64, tolerance: f64, scale: f64) -> (Strain, u64, f64) {
    timed(|| {
        let mut walk = start(update);
        for i in 1..=INCREMENTS {
            let at = |i: u32| path(size, f64::from(i) / f64::from(INCREMENTS));
            let (a, b) = (at(i - 1), at(i));
            walk.adaptive(&a, &b, tolerance, scale);
        }
        (walk.stress, walk.calls)
    })
}

/// Returns the least time of several repetitions.
fn timed(work: impl Fn() -> (Strain, u64)) -> (Strain, u64, f64) {
    let (mut best, mut out) = (f64::INFINITY, ([0.0; 6], 0));
    for _ in 0..7 {
        let started = Instant::now();
        out = work();
        best = best.min(started.elapsed().as_secs_f64());
    }
    (out.0, out.1, best)
}

/// A run with one kind of steps.
pub struct Run {
    /// Number of increments, or tolerance.
    pub setting: String,
    /// Number of returns.
    pub returns: u64,
    /// Least time \[s\].
    pub seconds: f64,
    /// Greatest error of a stress component at the end of the path, divided by the greatest component.
    pub error: f64,
}

/// Returns the runs of both kinds of steps for two stones: (stone, kind of steps, runs).
pub fn ladders() -> Vec<(&'static str, &'static str, Vec<Run>)> {
    let mut all = Vec::new();
    for (name, law, size) in [("paper", paper_stone(), 0.02), ("ordinary", ordinary_stone(), 0.02)] {
        let update = law.stress_update().expect("it deforms");
        let (a, _, _) = full(&*update, size, 1 << 16);
        let (b, _, _) = full(&*update, size, 1 << 17);
        let exact: Strain = std::array::from_fn(|i| 2.0 * b[i] - a[i]);
        let scale = exact.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let error = |stress: &Strain| stress.iter().zip(&exact).map(|(s, e)| (s - e).abs()).fold(0.0, f64::max) / scale;
        let run = |setting: String, (stress, returns, seconds): (Strain, u64, f64)| Run {
            setting,
            returns,
            seconds,
            error: error(&stress),
        };
        let counts = (2..=14).step_by(2).map(|k| run(format!("{}", 1 << k), full(&*update, size, 1 << k)));
        all.push((name, "full", counts.collect()));
        let tolerances = (1..=8).map(|k| {
            let tolerance = 10f64.powi(-k);
            run(format!("{tolerance:e}"), adaptive(&*update, size, tolerance, scale))
        });
        all.push((name, "adaptive", tolerances.collect()));
    }
    all
}
