//! Rates of all unknowns in given modes: their residuals, and the points that they move out of their modes.

use super::point::{Point, active_points};
use crate::contact::mode::{ContactMode, parts};
use crate::linear::largest;
use crate::path::system::{Load, System};
use crate::settings::SETTINGS;

/// A direction of the path.
pub struct Direction {
    /// Rates of all unknowns.
    pub x: Vec<f64>,
    /// λ̇: 1, 0 or −1.
    pub factor: f64,
    /// Rates of all gaps.
    pub gaps: Vec<[f64; 2]>,
}

/// Rates before they are accepted as a direction.
pub struct Rates {
    /// Rates of all unknowns.
    pub x: Vec<f64>,
    /// λ̇.
    pub factor: f64,
    /// Rates of all gaps, including the gaps opened by the load.
    pub gaps: Vec<[f64; 2]>,
    /// Worst relative residual.
    pub worst: f64,
    /// Number of refinement steps.
    pub refinements: u64,
}

impl Rates {
    /// Creates rates with their gaps.
    pub fn new(system: &System, x: Vec<f64>, factor: f64, load: &Load) -> Rates {
        let mut gaps = system.gaps(&x);
        if load.opens && factor != 0.0 {
            for (gap, load) in gaps.iter_mut().zip(&load.gap) {
                (0..2).for_each(|i| gap[i] += factor * load[i]);
            }
        }
        Rates { x, factor, gaps, worst: 0.0, refinements: 0 }
    }

    /// Returns true if motions are so large compared with forces that a mechanism is near.
    pub fn nears_mechanism(&self, forces: usize) -> bool {
        largest(&self.x[..forces]) < SETTINGS.fine * largest(&self.x[forces..])
    }
}

/// Returns the points of the active set that rates move out of their modes: violation, point, and the mode that repairs
/// it. `None` if gaps have no bound.
pub fn leaving(
    (system, points): (&System, &[Point]),
    (rates, load): (&Rates, &Load),
    active: &[usize],
    modes: &[ContactMode],
) -> Option<Vec<(f64, usize, ContactMode)>> {
    let (x, gaps) = (&rates.x, &rates.gaps);
    let least = if load.settles { SETTINGS.small * rates.factor.abs() * load.size } else { 0.0 };
    let force_size = largest(&x[..2 * system.contacts]).max(least);
    let gap_size = largest(gaps.as_flattened());
    if gap_size.is_nan() || gap_size > SETTINGS.unbounded() {
        return None;
    }
    let mut changes = Vec::new();
    for (&c, point) in active.iter().zip(&active_points(system, points, active)) {
        let unknowns = modes[c].unknowns(point.facets, gaps[c]);
        let force = [x[2 * c], x[2 * c + 1]];
        if let Some((size, to)) = point.violation(modes[c], &unknowns, force, [force_size, gap_size])
            && size > SETTINGS.inequality()
        {
            changes.push((size, c, to));
        }
    }
    Some(changes)
}

/// Returns the worst residual of rates relative to the forces and gaps, and all residuals: modes, then equilibrium.
pub fn residual(system: &System, rates: &Rates, load: &Load, modes: &[ContactMode]) -> (f64, Vec<f64>) {
    let nc = system.contacts;
    let x = &rates.x;
    // If all joints open, forces are zero up to their residual.
    let forces = largest(&x[..2 * nc]).max(1e-300).max(rates.factor.abs() * load.size);
    let motions = largest(&x[2 * nc..]).max(1e-300).max(forces);
    let mut worst: f64 = 0.0;
    let mut left = Vec::with_capacity(x.len());
    for (c, mode) in modes.iter().enumerate() {
        let rows = system.rows(c, *mode).unwrap_or_default();
        for [by_force, by_gap] in parts(&rows, [x[2 * c], x[2 * c + 1]], rates.gaps[c]) {
            worst = worst.max(by_force.abs() / forces).max(by_gap.abs() / motions);
            left.push(-(by_force + by_gap));
        }
    }
    for (sum, p) in system.resultants(x).iter().zip(load.wrench.iter().flatten()) {
        let rest = sum + rates.factor * p;
        worst = worst.max(rest.abs() / forces);
        left.push(-rest);
    }
    (worst, left)
}

/// Returns the motion without forces of rates whose system is singular to rounding, in the sense in which it keeps its
/// modes. `None` if forces are not small compared with the motion, or if the motion violates its modes.
pub fn motion_alone(
    (system, points): (&System, &[Point]),
    rates: &Rates,
    load: &Load,
    active: &[usize],
    modes: &[ContactMode],
) -> Option<Rates> {
    let forces = 2 * system.contacts;
    let size = largest(&rates.x[forces..]);
    if largest(&rates.x[..forces]) > SETTINGS.distinct() * size {
        return None;
    }
    [1.0, -1.0].into_iter().find_map(|sense| {
        let x = rates.x.iter().enumerate().map(|(i, v)| if i < forces { 0.0 } else { sense * v / size });
        let motion = Rates::new(system, x.collect(), 0.0, load);
        let moved = leaving((system, points), (&motion, load), active, modes);
        let fits = moved.is_some_and(|moved| moved.iter().all(|m| m.0 <= SETTINGS.distinct()));
        (fits && residual(system, &motion, load, modes).0 <= SETTINGS.distinct()).then_some(motion)
    })
}

/// Returns rates with a moving support and zero forces. `None` if the forces are more than rounding, because the motion
/// alone violates the modes or a load grows too.
fn at_constant_forces((system, points): (&System, &[Point]), (x, factor): (&[f64], f64), load: &Load) -> Option<Rates> {
    let forces = 2 * system.contacts;
    let loaded = load.wrench.iter().flatten().any(|w| *w != 0.0);
    if loaded || largest(&x[..forces]) > SETTINGS.active * largest(&x[forces..]).max(factor.abs() * load.size) {
        return None;
    }
    let motion = x.iter().enumerate().map(|(i, v)| if i < forces { 0.0 } else { *v });
    let moved = Rates::new(system, motion.collect(), factor, load);
    let modes: Vec<ContactMode> = points.iter().map(|p| p.settled().unwrap_or(p.mode)).collect();
    (residual(system, &moved, load, &modes).0 <= SETTINGS.shift()).then_some(moved)
}

/// Returns the direction of rates and sets the modes of points without a choice; gaps of stuck points are made exact.
pub fn direction_of(system: &System, points: &mut [Point], rates: Rates, load: &Load) -> Direction {
    let Rates { mut x, mut gaps, mut factor, .. } = rates;
    // In a mechanism forces and λ are constant; their rates are rounding errors.
    let forces = 2 * system.contacts;
    let stiffest = || points.iter().map(|p| p.stiffness).fold(1.0, f64::max);
    let still = if factor == 0.0 { 100.0 * SETTINGS.active * stiffest() } else { SETTINGS.active };
    let motions = largest(&x[forces..]);
    if load.settles && factor != 0.0 && motions * SETTINGS.active <= factor.abs() * load.size {
        if let Some(moved) = at_constant_forces((system, points), (&x, factor), load) {
            (x, gaps) = (moved.x, moved.gaps);
        }
    } else if largest(&x[..forces]) < still * motions {
        factor = 0.0;
        x[..forces].fill(0.0);
        let still = Rates::new(system, x, factor, load);
        (x, gaps) = (still.x, still.gaps);
    }
    for (gap, point) in gaps.iter_mut().zip(points) {
        point.mode = point.settled().unwrap_or(point.mode);
        if point.mode == ContactMode::Stick {
            *gap = [0.0; 2];
        }
    }
    Direction { x, factor, gaps }
}
