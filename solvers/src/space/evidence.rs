//! Repair of iterates to exact evidence: fields inside the cones and in equilibrium, motions inside the dual cones.
//!
//! Forces are corrected to equilibrium in the metric of the flexibilities. Points near the boundary are soft and
//! move little, so that a field inside the cones stays inside. Rounding may prevent this close to the optimum. Then the
//! correction of least norm is used, and the field is mixed with an earlier one that is strictly inside. Motions have
//! exact rates Aᵀ q. If some are outside the cones, an earlier opening mechanism is added.

use super::cone::{Cone, Scaling, UNIT, inner, margin, plus};
use super::interior_point::{InteriorPoint, add, dot, greatest};
use super::program::{Bodies, Program};
use super::settings::SETTINGS;
use super::stiffness::Stiffness;

/// A field inside the cones in equilibrium at a factor.
#[derive(Debug, Clone)]
pub struct Field {
    /// Factor above the start, in units of the program.
    pub lambda: f64,
    /// Forces of all points.
    pub y: Vec<Cone>,
}

/// A motion with rates inside the dual cones.
#[derive(Debug, Clone)]
pub struct Opening {
    /// Velocities of all bodies.
    pub q: Bodies,
    /// Its rates.
    z: Vec<Cone>,
    /// Upper bound of the factor above the start; infinite if the varying loads do no positive work.
    pub bound: f64,
}

/// Results that the iterates of a program have proved.
#[derive(Default)]
pub struct Evidence {
    /// A field at the start.
    pub start: Option<Field>,
    /// The field with the greatest factor.
    pub lower: Option<Field>,
    /// The motion with the least bound.
    pub upper: Option<Opening>,
    /// Forces inside the cones that balance the varying loads alone.
    pub ray: Option<Vec<Cone>>,
    /// A motion on which the loads at the start do work.
    pub refutation: Option<Bodies>,
    /// True if the motion is the only mechanism.
    pub unique: Option<bool>,
    /// Motions and fields inside the cones, with the mean product at their time; the products fall from one to the next.
    openings: Vec<(f64, Opening)>,
    /// As `openings`.
    fields: Vec<(f64, Field)>,
}

impl Evidence {
    /// Returns the distance of the bounds.
    pub fn gap(&self) -> f64 {
        match (&self.lower, &self.upper) {
            (Some(lower), Some(upper)) => upper.bound - lower.lambda,
            _ => f64::INFINITY,
        }
    }

    /// Returns true if the distance of the bounds is at most a share of the factor.
    pub fn is_within(&self, share: f64) -> bool {
        let size = self.lower.as_ref().map_or(0.0, |lower| lower.lambda.abs()).max(SETTINGS.least_factor);
        self.gap() <= share * size
    }

    /// Collects the evidence of a factorised state.
    pub fn collect(&mut self, method: &mut InteriorPoint) {
        let (program, held, mean) = (method.program, method.held, method.state.mean());
        self.motion(program, &method.state.q, mean, held);
        let (lambda, tau) = (method.state.lambda, method.state.tau);
        if self.start.is_none() {
            let y = method.state.forces(tau);
            self.start =
                balanced(method, y, [0.0, 1.0]).filter(|y| inside(program, y)).map(|y| Field { lambda: 0.0, y });
        }
        if method.held {
            return;
        }
        self.field(method, lambda / tau);
        if self.ray.is_none() && lambda > 0.0 && method.state.kappa > tau {
            let y = method.state.forces(lambda);
            self.ray = balanced(method, y, [1.0, 0.0]).filter(|y| inside(program, y));
        }
    }

    /// Adds a field near the forces of a state. Late in the search rounding can prevent a balance in the metric of the flexibilities. The
    /// forces are then repaired like those at the end: their errors are still small.
    fn field(&mut self, method: &mut InteriorPoint, lambda: f64) {
        let forces = |method: &InteriorPoint| method.state.forces(method.state.tau);
        let y = forces(method);
        let program = method.program;
        let Some(y) = balanced(method, y, [lambda, 1.0]).filter(|y| inside(program, y)) else {
            if !self.fields.is_empty() && !self.is_within(SETTINGS.closed) {
                self.repair(program, forces(method), lambda);
            }
            return;
        };
        let field = Field { lambda, y };
        let mean = method.state.mean();
        if self.fields.last().is_none_or(|(last, _)| mean <= SETTINGS.apart * last) {
            self.fields.push((mean, field.clone()));
        }
        self.raise(field);
    }

    /// Keeps a field if its factor is the greatest.
    fn raise(&mut self, field: Field) {
        if self.lower.as_ref().is_none_or(|lower| lower.lambda < field.lambda) {
            self.lower = Some(field);
        }
    }

    /// Repairs forces at a factor by corrections of least norm and the best mixture with an earlier field. Points with
    /// less than the negligible share of the greatest force get none: they cannot be loaded.
    pub fn repair(&mut self, program: &Program, mut y: Vec<Cone>, lambda: f64) -> Option<()> {
        let least = if self.fields.is_empty() { SETTINGS.negligible * size(&y) } else { 0.0 };
        let idle: Vec<bool> =
            y.iter().zip(&program.limits).map(|(y, limits)| limits[0] == 0.0 && y[0] <= least).collect();
        y.iter_mut().zip(&idle).filter(|(_, idle)| **idle).for_each(|(y, _)| *y = [0.0; 3]);
        let y = evened(program, y, [lambda, 1.0], &idle)?;
        if y.iter().enumerate().all(|(point, y)| program.margin(point, y) >= 0.0) {
            self.raise(Field { lambda, y });
            return Some(());
        }
        let earlier = self.fields.iter().map(|(_, field)| field).chain(&self.start);
        let mixed = earlier.filter_map(|field| mixture(program, &y, lambda, field));
        let best = mixed.max_by(|a, b| a.lambda.total_cmp(&b.lambda))?;
        self.raise(best);
        Some(())
    }

    /// Adds forces at the start that have a margin from the cones.
    pub fn interior(&mut self, program: &Program, y: Vec<Cone>) {
        let kept = self.lower.take();
        let found = self.repair(program, y, 0.0).and(self.lower.take());
        self.lower = kept;
        if let Some(field) = found {
            self.fields.push((f64::INFINITY, field.clone()));
            self.start.get_or_insert(field);
        }
    }

    /// Adds forces that balance the varying loads alone, after a correction of least norm.
    pub fn ray_near(&mut self, program: &Program, y: Vec<Cone>) {
        let idle = vec![false; y.len()];
        self.ray = evened(program, y, [1.0, 0.0], &idle).filter(|y| y.iter().all(|y| margin(y) >= 0.0));
    }

    /// Adds forces that are in balance without loads, near forces whose greatest component becomes one, after a correction of
    /// least norm.
    pub fn self_stress_near(&mut self, program: &Program, y: &[Cone]) {
        let most = greatest(y.as_flattened());
        let idle = vec![false; y.len()];
        self.ray = evened(program, y.iter().map(|y| y.map(|y| y / most)).collect(), [0.0, 0.0], &idle);
    }

    /// Returns a field at a factor that lies between two known ones.
    pub fn between(&self, lambda: f64) -> Option<Field> {
        let (start, lower) = (self.start.as_ref()?, self.lower.as_ref()?);
        let share = (lambda - start.lambda) / (lower.lambda - start.lambda);
        let mix = |(a, b): (&Cone, &Cone)| plus(&a.map(|a| (1.0 - share) * a), share, b);
        let y = start.y.iter().zip(&lower.y).map(mix).collect();
        (0.0..=1.0).contains(&share).then_some(Field { lambda, y })
    }

    /// Adds a motion of a state with a mean product.
    pub fn motion(&mut self, program: &Program, q: &[f64], mean: f64, held: bool) {
        let z = program.rates(q);
        let found = if opens(program, &z) {
            let found = opening(program, q.to_vec(), z);
            if self.openings.last().is_none_or(|(last, _)| mean <= SETTINGS.apart * last) {
                self.openings.push((mean, found.clone()));
            }
            Some(found)
        } else {
            let opened = self.openings.iter().filter_map(|(_, earlier)| opened(program, q, &z, earlier));
            let nearly = || within_rounding(program, &z).then(|| opening(program, q.to_vec(), z.clone()));
            opened.min_by(|a, b| a.bound.total_cmp(&b.bound)).or_else(nearly)
        };
        let Some(found) = found else { return };
        let work = dot(&program.base, &found.q) - program.dissipation(&found.z);
        let power = dot(&program.varying, &found.q);
        let loads: f64 = program.base.iter().map(|w| w.abs()).sum();
        let fastest = found.z.iter().map(|z| greatest(z)).fold(0.0, f64::max);
        let significant = SETTINGS.worked * loads * fastest;
        if self.refutation.is_none() && work > significant && (held || power >= 0.0) {
            self.refutation = Some(found.q.clone());
        }
        if self.upper.as_ref().is_none_or(|upper| found.bound < upper.bound) {
            self.upper = Some(found);
        }
    }
}

/// Returns true if all forces are inside their strengths.
fn inside(program: &Program, y: &[Cone]) -> bool {
    y.iter().enumerate().all(|(point, y)| program.margin(point, y) > 0.0)
}

/// Returns true if all rates are inside the dual cones.
fn opens(program: &Program, z: &[Cone]) -> bool {
    z.iter().enumerate().all(|(point, z)| program.margin_of_rate(point, z) > 0.0)
}

/// Returns true if rates leave the dual cones by rounding only.
fn within_rounding(program: &Program, z: &[Cone]) -> bool {
    let most = z.iter().map(|z| greatest(z)).fold(0.0, f64::max);
    let nearly = |(point, z): (usize, &Cone)| program.margin_of_rate(point, z) >= -SETTINGS.balanced * most;
    most > 0.0 && z.iter().enumerate().all(nearly)
}

/// Returns the greatest normal force, at least the unit of force.
fn size(y: &[Cone]) -> f64 {
    y.iter().map(|y| y[0].abs()).fold(1.0, f64::max)
}

/// Returns the stiffness with unit flexibilities of all points but the idle ones.
fn evenly(program: &Program, idle: &[bool]) -> Option<Stiffness> {
    let (root, none) = (Scaling::new(&UNIT, &UNIT)?.root(), [[0.0; 3]; 3]);
    let mut even = Stiffness::new(program)?;
    even.factorise(program, idle.iter().map(|idle| if *idle { &none } else { &root })).then_some(even)
}

/// Returns forces in equilibrium with λ p + τ w after corrections of least norm of all points but the idle ones.
fn evened(program: &Program, mut y: Vec<Cone>, [lambda, tau]: [f64; 2], idle: &[bool]) -> Option<Vec<Cone>> {
    let mut even = evenly(program, idle)?;
    for _ in 0..SETTINGS.repairs {
        let mut left = program.imbalance(&y, lambda, tau);
        if greatest(&left) <= SETTINGS.exact * size(&y) {
            break;
        }
        even.solve(&mut left);
        let changes = program.rates(&left);
        let loaded = y.iter_mut().zip(&changes).zip(idle).filter(|(_, idle)| !**idle);
        loaded.for_each(|((y, d), _)| *y = plus(y, -1.0, d));
    }
    (greatest(&program.imbalance(&y, lambda, tau)) <= SETTINGS.balanced * size(&y)).then_some(y)
}

/// Returns a motion with its bound.
fn opening(program: &Program, q: Bodies, z: Vec<Cone>) -> Opening {
    let work = dot(&program.base, &q) - program.dissipation(&z);
    let power = dot(&program.varying, &q);
    Opening { bound: if power > 0.0 { -work / power } else { f64::INFINITY }, q, z }
}

/// Adds as much of an earlier opening motion as moves all rates into the cones.
fn opened(program: &Program, q: &[f64], z: &[Cone], earlier: &Opening) -> Option<Opening> {
    let share = share(z, &earlier.z, |point, z| program.margin_of_rate(point, z))?;
    let mut q = q.to_vec();
    add(&mut q, share / (1.0 - share), &earlier.q);
    let z = program.rates(&q);
    opens(program, &z).then(|| opening(program, q, z))
}

/// Mixes forces with as much of an earlier field as moves all of them into the cones.
fn mixture(program: &Program, y: &[Cone], lambda: f64, earlier: &Field) -> Option<Field> {
    let share = share(y, &earlier.y, |point, y| program.margin(point, y))?;
    let mix = |(y, inside): (&Cone, &Cone)| plus(&y.map(|x| (1.0 - share) * x), share, inside);
    let mixed: Vec<Cone> = y.iter().zip(&earlier.y).map(mix).collect();
    let lambda = (1.0 - share) * lambda + share * earlier.lambda;
    inside(program, &mixed).then_some(Field { lambda, y: mixed })
}

/// Returns the least share of elements `inside` that brings all elements `x` inside. `None` if half is not enough.
fn share(x: &[Cone], inside: &[Cone], margin: impl Fn(usize, &Cone) -> f64) -> Option<f64> {
    let needed = |(point, (x, inside)): (usize, (&Cone, &Cone))| {
        // Margins are exact to rounding of their terms.
        let lack = f64::EPSILON * x[0].abs() - margin(point, x);
        if lack > 0.0 { lack / (lack + margin(point, inside)) } else { 0.0 }
    };
    let most = x.iter().zip(inside).enumerate().map(needed).fold(0.0, f64::max);
    let share = most * (1.0 + SETTINGS.mixed);
    (share < 0.5).then_some(share)
}

/// Returns forces near `y` that are in equilibrium with λ p + τ w. `None` if rounding prevents it.
fn balanced(method: &mut InteriorPoint, mut y: Vec<Cone>, [lambda, tau]: [f64; 2]) -> Option<Vec<Cone>> {
    let mut left = method.program.imbalance(&y, lambda, tau);
    let mut corrections = Corrections::default();
    for _ in 0..SETTINGS.repairs {
        let error = greatest(&left) / size(&y);
        if error <= SETTINGS.balanced {
            return Some(y);
        }
        if error.is_nan() || error > SETTINGS.repairable {
            return None;
        }
        let (_, change) = corrections.next(method, &left)?;
        y.iter_mut().zip(&change).for_each(|(y, d)| *y = plus(y, -1.0, d));
        left = method.program.imbalance(&y, lambda, tau);
    }
    None
}

/// Corrections of equilibrium: conjugate gradients with the factorised stiffness as preconditioner.
///
/// Near the optimum flexibilities of points differ by 1e24. Bodies that move together are joined by stiff points and rest on
/// soft ones, and rounding of the stiff entries exceeds the soft entries. The factors are then wrong for a few motions.
/// Products with the matrix are computed point by point, so that a few corrections remove these errors.
#[derive(Default)]
struct Corrections {
    before: Option<(Bodies, f64)>,
}

impl Corrections {
    /// Returns the motion that removes an error of equilibrium, and the decrease of the forces that goes with it. `None`
    /// if it is lost in rounding.
    fn next(&mut self, method: &mut InteriorPoint, left: &[f64]) -> Option<(Bodies, Vec<Cone>)> {
        let mut motion = left.to_vec();
        method.stiffness.solve(&mut motion);
        let product = dot(left, &motion);
        if let Some((before, earlier)) = &self.before {
            let share = product / earlier;
            motion.iter_mut().zip(before).for_each(|(c, d)| *c += share * d);
        }
        let rates = method.program.rates(&motion);
        let mut change: Vec<Cone> = rates.iter().zip(&method.scalings).map(|(z, scaling)| scaling.square(z)).collect();
        let resisted: f64 = rates.iter().zip(&change).map(|(z, y)| inner(z, y)).sum();
        let length = product / resisted;
        if !(length.is_finite() && length > 0.0) {
            return None;
        }
        self.before = Some((motion.clone(), product));
        motion.iter_mut().chain(change.iter_mut().flatten()).for_each(|x| *x *= length);
        Some((motion, change))
    }
}
