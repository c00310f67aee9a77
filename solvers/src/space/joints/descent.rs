//! Descent over mechanisms: from a collapse state to a state with a lower factor and a mechanism nearby.
//!
//! `least` gives the least factor of a mechanism q, and the dual motion y of this program. If a mechanism changes by δq, the direction d
//! of a slipping point changes by δd = P δv / |v|, with v its slip and P the part across it. Virtual power with y gives the change of the
//! factor,
//!
//! ```text
//! δλ = −Σ μ n δd·y_t = −Σ (μ n / |v|) (P y_t)·(P δv)
//! ```
//!
//! with the slip y_t of the point in y. The steepest descent in the metric of the weights μ n / |v| is the projection of y on the motions
//! that keep the state possible: points that carry neither open nor close, others do not overlap, and points that stick slip at most
//! against a shear force at its limit. If a step does not lower the factor, the dual motion of the mechanism after it joins the first one.
//! If that mechanism has no state, its dual motion is the proof of this. The shortest vector in the convex hull of all descents is the
//! next direction, so that the factor falls for all of them.

use super::least::{Associated, Least, least};
use crate::linear::null_space::null_space;
use crate::space::settings::{DESCENT, JOINTS};
use nalgebra::{DMatrix, DVector};
use voussoir_core::limit::Counters;
use voussoir_core::model::space::velocity_at;
use voussoir_core::space::{SpaceContact, SpaceField, SpaceProblem, SpaceVelocity, Vec3, Wrench, power};

/// A state in the units of the problem.
pub struct Found {
    /// Its factor.
    pub factor: f64,
    /// Its forces \[N\].
    pub field: SpaceField,
    /// Its mechanism with p·q = 1.
    pub motion: Vec<SpaceVelocity>,
    /// True if no mechanism tried near it has a lower factor.
    pub local: bool,
}

/// The dual motion of a least state.
pub type Dual = Option<Vec<SpaceVelocity>>;

/// The search of lower states.
#[derive(Clone, Copy)]
pub struct Descent<'a> {
    /// The problem.
    pub problem: &'a SpaceProblem,
    /// The solver of associated flow.
    pub solve: Associated,
    /// The factor at which the loads start.
    pub start: f64,
}

impl Descent<'_> {
    /// Returns the least state of a mechanism with these jumps, from a state at a factor, with the dual motion. A course knows the jumps
    /// more accurately than its motion in the units of the problem.
    pub fn of_mechanism(
        &self,
        (mut motion, jumps): (Vec<SpaceVelocity>, &[[f64; 3]]),
        (factor, field): (f64, SpaceField),
        counters: &mut Counters,
    ) -> (Found, Dual) {
        let unit = power(&self.problem.varying, &motion);
        motion.iter_mut().flatten().for_each(|v| *v /= unit);
        let Least { state, dual } = least(self.problem, self.solve, (self.start, factor), jumps, counters);
        let (factor, field) = state.unwrap_or((factor, field));
        (Found { factor, field, motion, local: false }, dual)
    }

    /// Follows the descent from a state with its dual motion.
    pub fn descend(&self, mut found: Found, mut dual: Dual, counters: &mut Counters) -> Found {
        let small = self.problem.bodies <= DESCENT.bodies;
        let dilates = self.problem.contacts.iter().any(|contact| contact.law.dilatancy > 0.0);
        let mut left = if small && !dilates { DESCENT.mechanisms } else { 0 };
        let mut turn = DESCENT.turn;
        while left > 0 {
            let Some(around) = Surroundings::new(self.problem, &found) else { break };
            let slowest = around.slowest();
            let (slow, others) =
                slowest.split_at(slowest.partition_point(|(slip, _)| *slip <= DESCENT.slow * around.largest));
            let rest = |groups: &[Group], left: &mut usize, counters: &mut Counters| {
                groups.iter().find_map(|(_, rows)| {
                    let next = self.tried(&found, around.nearest(rows.clone()), left, counters);
                    next.filter(|(next, _)| below(self.problem, next, &found))
                })
            };
            let mut lower = rest(slow, &mut left, counters);
            // Dual motions of this mechanism and of those tried near it, with their distances.
            let mut bundle: Vec<(f64, Vec<SpaceVelocity>)> = dual.into_iter().map(|dual| (0.0, dual)).collect();
            while lower.is_none() && left > 0 && turn >= DESCENT.least_turn {
                let Some(step) = around.steepest(bundle.iter().map(|(_, dual)| &dual[..])) else { break };
                match self.tried(&found, around.moved(&step, turn), &mut left, counters) {
                    Some(next) if below(self.problem, &next.0, &found) => lower = Some(next),
                    other => bundle.extend(other.and_then(|(_, dual)| dual).map(|dual| (turn, dual))),
                }
                turn *= if lower.is_none() { DESCENT.turn_again } else { 1.0 };
                bundle.retain(|(distance, _)| *distance <= DESCENT.near * turn);
            }
            let Some(next) = lower.or_else(|| rest(others, &mut left, counters)) else {
                found.local = left > 0 && !bundle.is_empty();
                break;
            };
            (found, dual) = next;
            turn = (turn / DESCENT.turn_again.powi(2)).min(DESCENT.turn);
        }
        found
    }

    /// Returns the least state of a mechanism, from a state, and counts the trial.
    fn tried(
        &self,
        found: &Found,
        motion: Option<Vec<SpaceVelocity>>,
        left: &mut usize,
        counters: &mut Counters,
    ) -> Option<(Found, Dual)> {
        let motion = motion.filter(|_| *left > 0)?;
        *left -= 1;
        *counters.entry("mechanisms_tried".into()).or_default() += 1;
        let jumps = jumps(self.problem, &motion);
        Some(self.of_mechanism((motion, &jumps), (found.factor, found.field.clone()), counters))
    }
}

/// Returns true if the factor of a state is below another one, and no power is left at its points.
fn below(problem: &SpaceProblem, next: &Found, found: &Found) -> bool {
    next.factor < found.factor - JOINTS.differ * found.factor.abs() && is_state(problem, next)
}

/// Returns true if the motion follows the flow of the forces; the certificate checks the same.
pub fn is_state(problem: &SpaceProblem, found: &Found) -> bool {
    let force = |wrenches: &[Wrench]| wrenches.iter().map(|w| Vec3::new(w[0], w[1], w[2]).norm()).sum::<f64>();
    let loads = force(&problem.fixed) + found.factor.abs() * force(&problem.varying);
    let own = jumps(problem, &found.motion);
    let points = problem.contacts.iter().zip(&found.field);
    let forces = points.flat_map(|(contact, forces)| forces.iter().map(|force| (contact.law.friction, force)));
    let (mut largest, mut closing, mut idle) = (0.0f64, 0.0f64, 0.0);
    for ([n, s, t], (friction, force)) in own.into_iter().zip(forces) {
        let slip = s.hypot(t);
        largest = largest.max(n.hypot(slip));
        closing = closing.max(-n);
        idle += (force[0] * n).abs() + (friction * force[0] * slip + force[1] * s + force[2] * t).abs();
    }
    closing <= DESCENT.proved * largest && idle <= DESCENT.proved * largest * loads
}

/// A point that carries and slips.
struct Slipping {
    contact: usize,
    slip: f64,
    /// Derivatives of its slip along both tangents and across the slip.
    along: [DVector<f64>; 2],
    across: DVector<f64>,
    /// Across the slip, in the tangents of the contact.
    axis: [f64; 2],
    /// √(μ n / |v|).
    weight: f64,
    /// Its place in the list of all points.
    point: usize,
}

/// The mechanisms around a state that keep the part of each point.
struct Surroundings<'a> {
    problem: &'a SpaceProblem,
    motion: DVector<f64>,
    /// Rows that vanish.
    fixed: Vec<DVector<f64>>,
    /// Rows with a present value that do not become negative.
    one_sided: Vec<(f64, DVector<f64>)>,
    slipping: Vec<Slipping>,
    /// Greatest jump.
    largest: f64,
}

/// Points that can stick together: their mean slip, and the derivatives of their slip along both tangents.
type Group<'a> = (f64, Vec<&'a DVector<f64>>);

/// A direction of descent.
struct Direction {
    direction: DVector<f64>,
    /// Greatest change of a direction of slip for unit length \[rad\].
    turn: f64,
    /// Length at which a gap closes.
    longest: f64,
}

impl<'a> Surroundings<'a> {
    fn new(problem: &'a SpaceProblem, found: &Found) -> Option<Self> {
        let own = jumps(problem, &found.motion);
        let largest = own.iter().map(|v| v[0].hypot(v[1]).hypot(v[2])).fold(0.0, f64::max);
        let pressed = found.field.iter().flatten().map(|f| f[0]).fold(0.0, f64::max);
        if largest <= 0.0 || pressed <= 0.0 {
            return None;
        }
        let scaled = found
            .motion
            .iter()
            .flat_map(|v| [v[0], v[1], v[2]].into_iter().chain(v[3..].iter().map(|turn| turn * problem.length)));
        let motion = DVector::from_iterator(6 * problem.bodies, scaled);
        let (fixed, one_sided, slipping) = (Vec::new(), Vec::new(), Vec::new());
        let mut around = Surroundings { problem, motion, fixed, one_sided, slipping, largest };
        let points = problem.contacts.iter().zip(&found.field).enumerate();
        let points = points.flat_map(|(index, (contact, forces))| {
            contact.inner.points.iter().zip(forces).map(move |(x, f)| (index, contact, x, f))
        });
        for (point, ((index, contact, x, force), v)) in points.zip(&own).enumerate() {
            let row = |axis: &Vec3| row(problem, contact, x, axis);
            let [normal, first, second] = contact.frame;
            let [n, s, t] = *force;
            let (slip, shear) = (v[1].hypot(v[2]), s.hypot(t));
            if n <= DESCENT.idle * pressed {
                around.one_sided.push((v[0].max(0.0), row(&normal)));
                continue;
            }
            around.fixed.push(row(&normal));
            if slip > JOINTS.at_rest * largest {
                let axis = [-v[2] / slip, v[1] / slip];
                let along = [row(&first), row(&second)];
                let across = &along[0] * axis[0] + &along[1] * axis[1];
                let weight = (contact.law.friction * n / slip).sqrt();
                around.slipping.push(Slipping { contact: index, slip, along, across, axis, weight, point });
            } else if shear < (1.0 - DESCENT.full) * contact.law.friction * n {
                around.fixed.extend([row(&first), row(&second)]);
            } else if shear > 0.0 {
                // It may slip against its shear force; without friction it may slip along any direction.
                let against = (first * s + second * t) / -shear;
                around.fixed.push(row(&normal.cross(&against)));
                around.one_sided.push((0.0, row(&against)));
            }
        }
        Some(around)
    }

    /// Returns the slowest slipping points, and contacts of several such points, in the order of their slip.
    fn slowest(&self) -> Vec<Group<'_>> {
        let mut groups: Vec<Group> = Vec::new();
        for own in self.slipping.chunk_by(|a, b| a.contact == b.contact) {
            groups.extend(own.iter().map(|point| (point.slip, point.along.iter().collect())));
            let mean = own.iter().map(|point| point.slip).sum::<f64>() / own.len() as f64;
            if own.len() > 1 {
                groups.push((mean, own.iter().flat_map(|point| &point.along).collect()));
            }
        }
        groups.sort_by(|a, b| a.0.total_cmp(&b.0));
        groups.truncate(DESCENT.slowest);
        groups
    }

    /// Returns the nearest mechanism in which further rows vanish. `None` if it does not exist.
    fn nearest<'s>(&'s self, mut rows: Vec<&'s DVector<f64>>) -> Option<Vec<SpaceVelocity>> {
        for _ in 0..JOINTS.rounds {
            let fixed = self.fixed.iter().chain(rows.iter().copied());
            let kept = null_space(&matrix(fixed, self.motion.len()), DESCENT.null)?;
            let motion = &kept * (kept.transpose() * &self.motion);
            let overlaps = |(_, row): &&(f64, DVector<f64>)| row.dot(&motion) < -JOINTS.settled * self.largest;
            let closing = rows.len();
            rows.extend(self.one_sided.iter().filter(overlaps).map(|(_, row)| row));
            if rows.len() == closing {
                return self.possible(motion);
            }
        }
        None
    }

    /// Returns velocities if no points overlap, and the live load does work.
    fn possible(&self, motion: DVector<f64>) -> Option<Vec<SpaceVelocity>> {
        let overlap = self.one_sided.iter().map(|(_, row)| -row.dot(&motion)).fold(0.0, f64::max);
        let velocities = velocities(self.problem, &motion);
        let works = power(&self.problem.varying, &velocities) > DESCENT.idle;
        (works && overlap <= DESCENT.proved * self.largest).then_some(velocities)
    }

    /// Returns the mechanism after a step in which the directions of slip change by `turn` at most.
    fn moved(&self, step: &Direction, turn: f64) -> Option<Vec<SpaceVelocity>> {
        let length = (turn / step.turn).min(step.longest);
        self.possible(&self.motion + &step.direction * length)
    }

    /// Returns the steepest common descent for some dual motions; `None` if no mechanism changes the directions of slip.
    fn steepest<'d>(&self, duals: impl Iterator<Item = &'d [SpaceVelocity]>) -> Option<Direction> {
        let goals = |dual: &[SpaceVelocity]| {
            let wanted = jumps(self.problem, dual);
            let goal = |own: &Slipping| {
                let [_, s, t] = wanted[own.point];
                own.weight * (own.axis[0] * s + own.axis[1] * t)
            };
            DVector::from_iterator(self.slipping.len(), self.slipping.iter().map(goal))
        };
        let goals: Vec<DVector<f64>> = duals.map(goals).collect();
        let metric: Vec<DVector<f64>> = self.slipping.iter().map(|own| &own.across * own.weight).collect();
        let metric = matrix(&metric, self.motion.len());
        let (mut fixed, mut one_sided) =
            (self.fixed.iter().collect::<Vec<_>>(), self.one_sided.iter().collect::<Vec<_>>());
        for _ in 0..JOINTS.rounds {
            let kept = null_space(&matrix(fixed.iter().copied(), self.motion.len()), DESCENT.null)?;
            if kept.ncols() == 0 || goals.is_empty() || self.slipping.is_empty() {
                return None;
            }
            let svd = (&metric * &kept).try_svd(true, true, f64::EPSILON, 10_000)?;
            let few = DESCENT.null * svd.singular_values.max();
            let parts: Vec<DVector<f64>> = goals.iter().map(|goal| svd.solve(goal, few).ok()).collect::<Option<_>>()?;
            let images: Vec<DVector<f64>> = parts.iter().map(|part| &metric * &kept * part).collect();
            let shares = least_of_hull(&images);
            let direction = kept * parts.iter().zip(shares).map(|(part, share)| part * share).sum::<DVector<f64>>();
            let turn = self.slipping.iter().map(|own| own.across.dot(&direction).abs() / own.slip).fold(0.0, f64::max);
            if turn <= 0.0 {
                return None;
            }
            let tiny = JOINTS.settled * self.largest * turn;
            let closes = |(gap, row): &&(f64, DVector<f64>)| {
                *gap <= JOINTS.at_rest * self.largest && row.dot(&direction) < -tiny
            };
            let (closing, others): (Vec<_>, Vec<_>) = one_sided.into_iter().partition(closes);
            one_sided = others;
            if closing.is_empty() {
                // A row without a rate has no reach.
                let reach = |(gap, row): &&(f64, DVector<f64>)| {
                    Some(-row.dot(&direction)).filter(|rate| *rate > tiny).map(|rate| gap / rate)
                };
                let longest = one_sided.iter().filter_map(reach).fold(f64::INFINITY, f64::min);
                return Some(Direction { direction, turn, longest });
            }
            fixed.extend(closing.into_iter().map(|(_, row)| row));
        }
        None
    }
}

/// Returns the shares of the shortest vector in the convex hull of some vectors (Gilbert 1966, *SIAM J. Control* 4, 61–80).
fn least_of_hull(vectors: &[DVector<f64>]) -> Vec<f64> {
    let mut shares = vec![0.0; vectors.len()];
    shares[0] = 1.0;
    let mut least = vectors[0].clone();
    for _ in 0..DESCENT.hull {
        let along: Vec<f64> = vectors.iter().map(|vector| vector.dot(&least)).collect();
        let next = (0..along.len()).min_by(|a, b| along[*a].total_cmp(&along[*b])).unwrap_or(0);
        let towards = &vectors[next] - &least;
        let share = (-least.dot(&towards) / towards.norm_squared()).clamp(0.0, 1.0);
        if share.is_nan() || share <= 0.0 {
            break;
        }
        least += towards * share;
        shares.iter_mut().for_each(|own| *own *= 1.0 - share);
        shares[next] += share;
    }
    shares
}

pub fn matrix<'a>(rows: impl IntoIterator<Item = &'a DVector<f64>>, columns: usize) -> DMatrix<f64> {
    let rows: Vec<_> = rows.into_iter().map(DVector::transpose).collect();
    if rows.is_empty() { DMatrix::zeros(0, columns) } else { DMatrix::from_rows(&rows) }
}

/// Returns the derivatives of the jump along an axis with respect to velocities and rotations times length of all bodies.
pub fn row(problem: &SpaceProblem, contact: &SpaceContact, point: &Vec3, axis: &Vec3) -> DVector<f64> {
    let mut row = DVector::zeros(6 * problem.bodies);
    let moment = point.cross(axis) / problem.length;
    for (body, sign) in [(contact.plus, 1.0), (contact.minus, -1.0)] {
        let Some(body) = body else { continue };
        for k in 0..3 {
            row[6 * body + k] += sign * axis[k];
            row[6 * body + 3 + k] += sign * moment[k];
        }
    }
    row
}

/// Returns velocities from velocities and rotations times length of all bodies.
pub fn velocities(problem: &SpaceProblem, motion: &DVector<f64>) -> Vec<SpaceVelocity> {
    let length = problem.length;
    let of = |v: &[f64]| [v[0], v[1], v[2], v[3] / length, v[4] / length, v[5] / length];
    motion.as_slice().chunks_exact(6).map(of).collect()
}

/// Returns the jumps (n, s, t) of all points, contact by contact.
pub fn jumps(problem: &SpaceProblem, motion: &[SpaceVelocity]) -> Vec<[f64; 3]> {
    let of = |contact: &SpaceContact, point: &Vec3| {
        let at = |body: Option<usize>| body.map_or(Vec3::zeros(), |body| velocity_at(&motion[body], point));
        let apart = at(contact.plus) - at(contact.minus);
        contact.frame.map(|axis| axis.dot(&apart))
    };
    problem.contacts.iter().flat_map(|contact| contact.inner.points.iter().map(move |x| of(contact, x))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::solve;
    use crate::space::tests::own_flow::in_a_corner;

    /// The predicted change of the least factor is the change of the factors of two mechanisms.
    #[test]
    fn the_slope_is_the_change_of_the_factor() {
        let problem = in_a_corner();
        let descent = Descent { problem: &problem, solve, start: 0.0 };
        let mut counters = Counters::new();
        // The slab slides and turns about the vertical; the pole of the problem is on its axis.
        let mut of = |turn: f64| {
            let motion = vec![[1.0, 1.0, 0.0, 0.0, 0.0, turn], [0.0; 6]];
            let field = problem.contacts.iter().map(|contact| vec![[0.0; 3]; contact.inner.points.len()]).collect();
            let jumps = jumps(&problem, &motion);
            descent.of_mechanism((motion, &jumps), (2.0, field), &mut counters)
        };
        let (turn, small) = (0.3, 1e-4);
        let (found, dual) = of(turn);
        let changed = (of(turn + small).0.factor - of(turn - small).0.factor) / (2.0 * small);
        let around = Surroundings::new(&problem, &found).unwrap();
        let scale = found.motion[0][5] / turn;
        let mut rate = DVector::zeros(12);
        rate[5] = scale * problem.length;
        let wanted = jumps(&problem, &dual.unwrap());
        let part = |own: &Slipping| {
            let [_, s, t] = wanted[own.point];
            own.weight.powi(2) * (own.axis[0] * s + own.axis[1] * t) * own.across.dot(&rate)
        };
        let slope = -around.slipping.iter().map(part).sum::<f64>();
        assert!((slope - changed).abs() < 1e-6 * changed.abs().max(0.1), "{slope} {changed}");
    }
}
