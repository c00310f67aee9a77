//! Certificates of limit analysis in space: the proof of an answer, recomputed from the problem alone.
//!
//! This code shares nothing with solvers. Equilibrium is summed body by body from the stored forces. Forces are compared
//! with the set of the law at the inner points of each contact. The rates of a motion are compared with the dual cone
//! v_n ≥ μ |v_t| of associated flow at the outer points, unless joints crush, and dissipate D = Σ a d(v), the greatest work
//! of admissible tractions against them; dry friction dissipates nothing. For a field at the factor λ and a motion with
//! varying·q = 1, virtual power gives
//!
//! ```text
//! λ ≤ D − fixed·q,   fixed·q + λ varying·q = −Σ f·v ≤ D
//! ```
//!
//! so that a field proves a lower bound and a motion an upper bound of the greatest factor. Source: Drucker, Prager and
//! Greenberg (1952), *Q. Appl. Math.* 9, 381–389.
//!
//! With the laws' own flow a collapse needs a field and a mechanism at one factor: v_n ≥ ψ |v_t|, and no contact has power left,
//! n (v_n − ψ |v_t|) + μ n |v_t| + t·v_t = 0. Both terms are at least zero for admissible forces and rates.

use super::residuals::Certificate;
use crate::law::FrictionCone;
use crate::limit::{
    Greatest, SpaceContact, SpaceField, SpaceNonAssociated, SpaceProblem, SpaceVelocity, Status, power,
};
use crate::model::space::{Vec3, Wrench, velocity_at};
use std::collections::BTreeMap;

/// Tolerance of residuals that are zero except for rounding. It is below that of plane scenes, because a bound may be wrong by
/// a residual times the sum of the forces that a mechanism prices, which is thousands of block weights in vaults.
const ROUNDING: f64 = 1e-12;

/// Greatest relative distance between the factor of a field and the target of its stage.
const REACHED: f64 = 1e-12;

/// Least excess of power, relative to load times greatest jump, that is significant.
const EXCESS: f64 = 1e-13;

/// Greatest error of the power of the varying loads on a motion, which must be 1.
const UNIT_POWER: f64 = 1e-9;

/// Greatest jump, relative to the greatest speed, that counts as none: a body without contact moves.
const NO_JUMP: f64 = 1e-9;

/// Greatest relative distance between a state and the lower end of a search that proves it to be the least one.
const CLOSED: f64 = 2e-5;

/// Factor, relative to the ratio of fixed and varying loads, below which the gap is compared with the loads.
const LEAST_FACTOR: f64 = 1e-3;

/// The statement of an answer, with its evidence.
#[derive(Debug, Clone, Copy)]
pub struct SpaceClaim<'a> {
    /// The status in the solver's answer: the proof that is tried first.
    pub hint: Status,
    /// The factor to which the stage goes; infinite for a search for collapse without an end.
    pub target: f64,
    /// The collapse factor.
    pub factor: Option<f64>,
    /// The factor at which the field is in equilibrium.
    pub field_factor: f64,
    /// The factor at which the stage starts.
    pub start: f64,
    /// Forces at the points of each contact of the problem \[N\].
    pub field: Option<&'a SpaceField>,
    /// Velocity of each free body about the problem's pole.
    pub motion: Option<&'a [SpaceVelocity]>,
    /// Forces that balance the varying loads alone \[N\].
    pub ray: Option<&'a SpaceField>,
    /// Set if the claim is about the laws' own flow.
    pub non_associated: Option<&'a SpaceNonAssociated>,
    /// True if the solver belongs to this project: its search for lower factors is believed.
    pub search_is_trusted: bool,
}

/// The result of checking a claim.
#[derive(Debug, Clone)]
pub struct SpaceVerdict {
    /// Residuals; `passed` if the status is neither open nor stalled.
    pub certificate: Certificate,
    /// The status that is proved.
    pub status: Status,
    /// Proved ends of the greatest factor, from the field and from the motion. Both `None` if there is no such number.
    pub bounds: [Option<f64>; 2],
    /// The proof of the greatest factor.
    pub greatest: Greatest,
}

/// Checks a claim about a problem and returns the status that its evidence proves. The hint is tried first; if it fails,
/// every other statement that the evidence could prove is tried. `gap` is the greatest relative distance of the bounds
/// of a collapse.
pub fn certify_space(problem: &SpaceProblem, claim: &SpaceClaim, gap: f64) -> SpaceVerdict {
    if let Some(why) = misfit(problem, claim) {
        return SpaceVerdict {
            certificate: Certificate { passed: false, residuals: BTreeMap::new(), failures: vec![why] },
            status: Status::Stalled,
            bounds: [None; 2],
            greatest: Greatest::Open,
        };
    }
    Check::new(problem).decide(claim, gap)
}

/// Returns the reason why the evidence does not match the problem.
fn misfit(problem: &SpaceProblem, claim: &SpaceClaim) -> Option<String> {
    let SpaceProblem { bodies, contacts, fixed, varying, .. } = problem;
    let known = |body: Option<usize>| body.is_none_or(|body| body < *bodies);
    if fixed.len() != *bodies
        || varying.len() != *bodies
        || !contacts.iter().all(|contact| known(contact.minus) && known(contact.plus))
    {
        return Some("the problem does not have one wrench for each free body".into());
    }
    let fits = |field: &SpaceField| {
        let same = |(contact, forces): (&SpaceContact, &Vec<[f64; 3]>)| contact.inner.points.len() == forces.len();
        field.len() == contacts.len() && contacts.iter().zip(field).all(same)
    };
    let fields = || [claim.field, claim.ray].into_iter().flatten();
    if !fields().all(fits) {
        return Some("the field does not have one force for each point of each contact".into());
    }
    let motions = || claim.motion.into_iter().chain(associated_motion(claim));
    if motions().any(|motion| motion.len() != *bodies) {
        return Some("the motion does not have one velocity for each free body".into());
    }
    let velocities = motions().flatten().flatten();
    if !fields().flatten().flatten().flatten().chain(velocities).all(|x| x.is_finite()) {
        return Some("a force or velocity is not finite".into());
    }
    None
}

/// Returns the motion that proves the associated factor.
fn associated_motion<'a>(claim: &SpaceClaim<'a>) -> Option<&'a [SpaceVelocity]> {
    claim.non_associated.and_then(|own| own.associated_motion.as_deref())
}

/// Returns the size of wrenches \[N\]: forces, and moments divided by a length.
fn size(wrenches: &[Wrench], length: f64) -> f64 {
    let of = |[x, y, z, mx, my, mz]: &Wrench| Vec3::new(*x, *y, *z).norm() + Vec3::new(*mx, *my, *mz).norm() / length;
    wrenches.iter().map(of).sum()
}

struct Check<'a> {
    problem: &'a SpaceProblem,
    /// Length by which moments are divided \[m\].
    length: f64,
    /// Sizes of the fixed and of the varying loads \[N\].
    sizes: [f64; 2],
    certificate: Certificate,
}

impl<'a> Check<'a> {
    fn new(problem: &'a SpaceProblem) -> Self {
        let length = if problem.length > 0.0 { problem.length } else { 1.0 };
        let sizes = [size(&problem.fixed, length), size(&problem.varying, length)];
        Check { problem, length, sizes, certificate: Certificate::blank() }
    }

    /// Tries the hint, then every other statement, and returns the first that is proved.
    fn decide(&mut self, claim: &SpaceClaim, gap: f64) -> SpaceVerdict {
        let all = [Status::Stands, Status::Collapse, Status::Unbounded, Status::NoEquilibrium];
        // If blocks can wedge, a state with the laws' own flow bounds the least load, but the structure may stand beyond it.
        let left_open = claim.hint == Status::Open && claim.non_associated.is_some();
        let states = [Status::Stands, Status::Collapse];
        let others = all.into_iter().filter(|status| *status != claim.hint && !(left_open && states.contains(status)));
        let mut first = None;
        for status in std::iter::once(claim.hint).filter(|hint| all.contains(hint)).chain(others) {
            self.certificate = Certificate::blank();
            let bounds = self.proves(status, claim, gap);
            let certificate = std::mem::replace(&mut self.certificate, Certificate::blank());
            match bounds {
                Some(bounds) if certificate.passed => {
                    let greatest = match claim.non_associated {
                        Some(own) if status == Status::Collapse => self.least(own, bounds),
                        _ if status == Status::Stands => Greatest::Open,
                        _ => Greatest::ProvedOptimal,
                    };
                    return SpaceVerdict { certificate, status, bounds, greatest };
                }
                _ if status == claim.hint => first = Some(certificate),
                _ => {}
            }
        }
        self.open(claim, gap, first.unwrap_or_else(Certificate::blank))
    }

    /// Returns how far a state with the laws' own flow is known to be the least one.
    fn least(&self, own: &SpaceNonAssociated, bounds: [Option<f64>; 2]) -> Greatest {
        match (bounds, own.searched) {
            ([Some(lower), Some(factor)], Some(_)) if self.closed(lower, factor) => Greatest::ProvedOptimal,
            (_, Some(_)) => Greatest::Bracketed,
            _ => Greatest::Open,
        }
    }

    /// Returns true if a search has closed the bracket of the least load.
    fn closed(&self, lower: f64, factor: f64) -> bool {
        factor - lower <= CLOSED * factor.abs().max(self.factor_scale())
    }

    /// Returns the lower end that a search proves. `None` if the answer has no search, or if the search proves nothing.
    fn searched(&mut self, claim: &SpaceClaim, own: &SpaceNonAssociated) -> Option<f64> {
        let lower = own.searched?;
        if !claim.search_is_trusted {
            self.certificate.fail("the lower bound: an exhaustive search leaves nothing that could be checked");
        }
        Some(lower).filter(|lower| claim.search_is_trusted && *lower > claim.start)
    }

    /// Returns the verdict with the ends that field and motion prove by themselves.
    fn open(&mut self, claim: &SpaceClaim, gap: f64, mut certificate: Certificate) -> SpaceVerdict {
        self.certificate = Certificate::blank();
        // A field does not bound factors of other than associated flow, but every motion of associated flow does.
        let lower = match claim.non_associated {
            Some(own) => self.searched(claim, own),
            None => self.field(claim).filter(|lower| *lower > claim.start),
        };
        self.certificate = Certificate::blank();
        let upper = match claim.non_associated {
            None => self.upper_bound(claim.motion),
            Some(own) => {
                let ends = [self.upper_bound(own.associated_motion.as_deref()), self.state(claim, own, gap)];
                ends.into_iter().flatten().min_by(f64::total_cmp)
            }
        };
        let consistent = lower.zip(upper).is_none_or(|(lower, upper)| lower <= upper);
        let bounds = if consistent { [lower, upper] } else { [None; 2] };
        let status = if bounds == [None; 2] { Status::Stalled } else { Status::Open };
        certificate.passed = false;
        if certificate.failures.is_empty() {
            certificate.failures.push("not proven".into());
        }
        SpaceVerdict { certificate, status, bounds, greatest: Greatest::Open }
    }

    /// Checks the evidence for one status and returns the bounds. `None` if a part of the evidence is missing or fails.
    fn proves(&mut self, status: Status, claim: &SpaceClaim, gap: f64) -> Option<[Option<f64>; 2]> {
        match status {
            Status::Stands => self.stands(claim).map(|()| [None; 2]),
            Status::Collapse => match claim.non_associated {
                Some(own) => self.own_flow(claim, own, gap).map(|bounds| bounds.map(Some)),
                None => self.collapse(claim, gap).map(|bounds| bounds.map(Some)),
            },
            Status::Unbounded => self.field(claim).and(self.ray(claim)).map(|()| [None; 2]),
            Status::NoEquilibrium => self.refutation(claim).map(|()| [None; 2]),
            Status::LimitPoint | Status::Open | Status::Stalled => None,
        }
    }

    fn stands(&mut self, claim: &SpaceClaim) -> Option<()> {
        let (at, target) = (claim.field_factor, claim.target);
        let near = target.is_finite() && (self.sizes[1] == 0.0 || (at - target).abs() <= REACHED * target.abs());
        if !near {
            self.certificate.fail(format!("the field is at the factor {at}, not at the target {target} of the stage"));
            return None;
        }
        self.field(claim).map(|_| ())
    }

    fn collapse(&mut self, claim: &SpaceClaim, gap: f64) -> Option<[f64; 2]> {
        let (Some(lower), Some(upper)) = (self.field(claim), self.upper_bound(claim.motion)) else {
            self.certificate.fail("a collapse needs a factor, an admissible field and a mechanism");
            return None;
        };
        let factor = claim.factor.unwrap_or(lower);
        let scale = lower.abs().max(upper.abs()).max(self.factor_scale());
        self.certificate.residual("gap", (upper - lower).abs().max((factor - lower).abs()) / scale, gap);
        if lower > claim.target && claim.target >= claim.start {
            self.certificate.fail(format!("the collapse lies beyond the target {} of the stage", claim.target));
        }
        Some([lower.min(upper), upper.max(lower)])
    }

    /// Checks that field and mechanism exist at one factor with the laws' own flow, and that the bound of associated flow is not
    /// exceeded. Returns \[lower, factor\]: there may be lower factors, and a search bounds them. Without one, the start is the lower end.
    fn own_flow(&mut self, claim: &SpaceClaim, own: &SpaceNonAssociated, gap: f64) -> Option<[f64; 2]> {
        let (Some(factor), Some(motion)) = (self.field(claim), claim.motion) else {
            self.certificate.fail("a collapse needs a factor, an admissible field and a mechanism");
            return None;
        };
        if claim.factor != Some(factor) || factor < claim.start || factor > claim.target {
            self.certificate.fail("the field is not at the collapse factor, or the factor is outside the stage");
        }
        if !self.problem.contacts.iter().all(|contact| contact.law.is_dry()) {
            self.certificate.fail("the own flow of joints with cohesion, tension or crushing is not checked in space");
        }
        let varying = power(&self.problem.varying, motion);
        self.certificate.residual("motion_scale", (varying - 1.0).abs(), UNIT_POWER);
        let (largest, _) = self.flow(motion, FrictionCone::violation_of_own_flow)?;
        let scale = self.load_scale(factor, claim.field?) * largest;
        let idle = self.idle_power(claim.field?, motion);
        self.certificate.residual("complementarity", idle / scale, ROUNDING);
        if let Some(greatest) = own.associated_factor {
            let scale = factor.abs().max(greatest.abs()).max(self.factor_scale());
            self.certificate.residual("above_associated", ((factor - greatest) / scale).max(0.0), gap);
            let shown = self.associated_bound(own.associated_motion.as_deref());
            let distance = shown.map_or(f64::INFINITY, |shown| (shown - greatest).abs() / scale);
            self.certificate.residual("associated_gap", distance, gap);
        }
        let lower = self.searched(claim, own).unwrap_or(claim.start);
        if lower > factor {
            self.certificate.fail(format!("the lower bound {lower} is above the factor"));
        } else if own.searched.is_some() && lower <= claim.start && !self.closed(lower, factor) {
            self.certificate.fail("no lower end of the least load is proved");
        }
        Some([lower, factor])
    }

    /// Returns the factor of a state with the laws' own flow: the least collapse factor is not above it.
    fn state(&mut self, claim: &SpaceClaim, own: &SpaceNonAssociated, gap: f64) -> Option<f64> {
        self.certificate = Certificate::blank();
        let at = SpaceClaim { factor: Some(claim.field_factor), target: f64::INFINITY, ..*claim };
        let found = SpaceNonAssociated { searched: None, ..own.clone() };
        let found = self.own_flow(&at, &found, gap).filter(|_| self.certificate.passed);
        found.map(|[_, factor]| factor)
    }

    /// Returns the factor that a motion of associated flow proves. Its residuals have separate names.
    fn associated_bound(&mut self, motion: Option<&[SpaceVelocity]>) -> Option<f64> {
        let own = std::mem::replace(&mut self.certificate, Certificate::blank());
        let shown = self.upper_bound(motion);
        let Certificate { passed, residuals, failures } = std::mem::replace(&mut self.certificate, own);
        let named = |name: String| format!("associated_{name}");
        self.certificate.residuals.extend(residuals.into_iter().map(|(name, value)| (named(name), value)));
        self.certificate.failures.extend(failures.into_iter().map(named));
        self.certificate.passed &= passed;
        shown
    }

    /// Returns the power that the forces lack from the laws' own flow on a motion \[W\].
    fn idle_power(&self, field: &SpaceField, motion: &[SpaceVelocity]) -> f64 {
        let of = |(contact, forces): (&SpaceContact, &Vec<[f64; 3]>)| -> f64 {
            let points = contact.inner.points.iter().zip(forces);
            points.map(|(point, force)| contact.law.idle_power(force, &jump(contact, point, motion)).abs()).sum()
        };
        self.problem.contacts.iter().zip(field).map(of).sum()
    }

    /// Checks the field and returns its factor.
    fn field(&mut self, claim: &SpaceClaim) -> Option<f64> {
        let Some(field) = claim.field else {
            self.certificate.fail("no field");
            return None;
        };
        let scale = self.load_scale(claim.field_factor, field);
        let imbalance = self.imbalance(field, [1.0, claim.field_factor]);
        let balanced = self.certificate.residual("equilibrium", imbalance / scale, ROUNDING);
        let admissible = self.certificate.residual("strength", self.violation(field, true) / scale, ROUNDING);
        (balanced && admissible && claim.field_factor.is_finite()).then_some(claim.field_factor)
    }

    /// Checks that forces balance the varying loads alone.
    fn ray(&mut self, claim: &SpaceClaim) -> Option<()> {
        let Some(ray) = claim.ray else {
            self.certificate.fail("no ray proves that every factor is carried");
            return None;
        };
        // A ray cannot be too small: the varying loads are its scale.
        let scale = if self.sizes[1] > 0.0 { self.sizes[1] } else { 1.0 };
        let balanced = self.certificate.residual("ray_equilibrium", self.imbalance(ray, [0.0, 1.0]) / scale, ROUNDING);
        let admissible = self.certificate.residual("ray_strength", self.violation(ray, false) / scale, ROUNDING);
        (balanced && admissible).then_some(())
    }

    /// Checks that the loads at the start do more work on the motion than admissible forces can do against it.
    fn refutation(&mut self, claim: &SpaceClaim) -> Option<()> {
        let Some(motion) = claim.motion else {
            self.certificate.fail("no motion");
            return None;
        };
        let (largest, flow) = self.flow(motion, FrictionCone::violation_of_flow)?;
        let (fixed, varying) = (power(&self.problem.fixed, motion), power(&self.problem.varying, motion));
        let dissipated = self.dissipation(motion);
        let excess = fixed + claim.start * varying - dissipated;
        let scale = ((self.sizes[0] + claim.start.abs() * self.sizes[1]) * largest).max(dissipated.abs());
        // Rates outside the dual cones, though within rounding, could do this work with forces as great as the loads.
        let significant = excess > EXCESS.max(flow) * scale;
        if !significant {
            self.certificate
                .fail(format!("the loads do no more work on the motion than forces against it: excess {excess:.3e}"));
        }
        self.certificate.residuals.insert("excess_power".into(), excess / scale);
        significant.then_some(())
    }

    /// Returns the factor that the motion proves to be the greatest possible one.
    fn upper_bound(&mut self, motion: Option<&[SpaceVelocity]>) -> Option<f64> {
        let Some(motion) = motion else {
            self.certificate.fail("no motion");
            return None;
        };
        self.flow(motion, FrictionCone::violation_of_flow)?;
        let (fixed, varying) = (power(&self.problem.fixed, motion), power(&self.problem.varying, motion));
        self.certificate
            .residual("motion_scale", (varying - 1.0).abs(), UNIT_POWER)
            .then_some((self.dissipation(motion) - fixed) / varying)
    }

    /// Checks that no rate of a motion violates the flow. Returns the greatest jump, and the greatest violation relative to it.
    fn flow(&mut self, motion: &[SpaceVelocity], violation: fn(&FrictionCone, &[f64; 3]) -> f64) -> Option<(f64, f64)> {
        let (mut largest, mut worst) = (0.0f64, 0.0f64);
        for contact in &self.problem.contacts {
            for point in &contact.outer.points {
                let rate = jump(contact, point, motion);
                largest = largest.max(Vec3::from(rate).norm());
                worst = worst.max(violation(&contact.law, &rate));
            }
        }
        let speed = motion
            .iter()
            .map(|v| Vec3::new(v[0], v[1], v[2]).norm() + self.length * Vec3::new(v[3], v[4], v[5]).norm());
        let speed = speed.fold(0.0, f64::max);
        let largest = if largest > NO_JUMP * speed { largest } else { speed };
        let flow = if largest > 0.0 { worst / largest } else { f64::NAN };
        self.certificate.residual("flow", flow, ROUNDING).then_some((largest, flow))
    }

    /// Returns the greatest unbalanced force or moment per length on any body \[N\] from contact forces and
    /// `fixed × shares[0] + varying × shares[1]`. Moments are about the mean of the points of the body's contacts.
    fn imbalance(&self, field: &SpaceField, shares: [f64; 2]) -> f64 {
        let poles = self.poles();
        let load = |body: usize| {
            let wrench: [f64; 6] = std::array::from_fn(|i| {
                shares[0] * self.problem.fixed[body][i] + shares[1] * self.problem.varying[body][i]
            });
            let force = Vec3::new(wrench[0], wrench[1], wrench[2]);
            (force, Vec3::new(wrench[3], wrench[4], wrench[5]) - poles[body].cross(&force))
        };
        let mut sums: Vec<(Vec3, Vec3)> = (0..self.problem.bodies).map(load).collect();
        for (contact, forces) in self.problem.contacts.iter().zip(field) {
            let [n, s, t] = &contact.frame;
            for (point, force) in contact.inner.points.iter().zip(forces) {
                let force = n * force[0] + s * force[1] + t * force[2];
                for (body, sign) in [(contact.plus, 1.0), (contact.minus, -1.0)] {
                    let Some(body) = body else { continue };
                    sums[body].0 += force * sign;
                    sums[body].1 += (point - poles[body]).cross(&force) * sign;
                }
            }
        }
        let greatest = |(force, moment): &(Vec3, Vec3)| force.norm().max(moment.norm() / self.length);
        // NaN must not be lost.
        sums.iter().map(greatest).fold(0.0, |most, x| if x > most || x.is_nan() { x } else { most })
    }

    /// Returns the mean of the points of the contacts of each body.
    fn poles(&self) -> Vec<Vec3> {
        let mut sums = vec![(Vec3::zeros(), 0.0); self.problem.bodies];
        for contact in &self.problem.contacts {
            for body in [contact.plus, contact.minus].into_iter().flatten() {
                sums[body].0 += contact.inner.points.iter().sum::<Vec3>();
                sums[body].1 += contact.inner.points.len() as f64;
            }
        }
        sums.into_iter().map(|(sum, count)| if count > 0.0 { sum / count } else { sum }).collect()
    }

    /// Returns the greatest force outside the strength of its point \[N\]; without areas, outside the cones of recession.
    fn violation(&self, field: &SpaceField, areas: bool) -> f64 {
        let of = |(contact, forces): (&SpaceContact, &Vec<[f64; 3]>)| {
            let at = |(force, area): (&[f64; 3], &f64)| contact.law.violation(force, if areas { *area } else { 0.0 });
            forces.iter().zip(&contact.inner.areas).map(at).fold(0.0, f64::max)
        };
        self.problem.contacts.iter().zip(field).map(of).fold(0.0, f64::max)
    }

    /// Returns the greatest work of admissible tractions against a motion \[W\].
    fn dissipation(&self, motion: &[SpaceVelocity]) -> f64 {
        let of = |contact: &SpaceContact| -> f64 {
            let points = contact.outer.points.iter().zip(&contact.outer.areas);
            points.map(|(point, area)| area * contact.law.dissipation(&jump(contact, point, motion))).sum()
        };
        self.problem.contacts.iter().map(of).sum()
    }

    /// Returns the scale of the residuals of a field \[N\]: the loads at the factor, or the greatest force without loads.
    fn load_scale(&self, factor: f64, field: &SpaceField) -> f64 {
        let loads = self.sizes[0] + factor.abs() * self.sizes[1];
        if loads > 0.0 {
            return loads;
        }
        let greatest = field.iter().flatten().flatten().fold(0.0f64, |most, f| most.max(f.abs()));
        if greatest > 0.0 { greatest } else { 1.0 }
    }

    /// Returns the least size of factors with which a gap is compared.
    fn factor_scale(&self) -> f64 {
        let [fixed, varying] = self.sizes;
        if fixed == 0.0 {
            1.0
        } else if varying > 0.0 {
            LEAST_FACTOR * fixed / varying
        } else {
            0.0
        }
    }
}

/// Returns the greatest unbalanced force of a field \[N\] with the fixed loads, and the greatest force outside the cones of
/// recession.
pub(super) fn defects(problem: &SpaceProblem, field: &SpaceField) -> [f64; 2] {
    let check = Check::new(problem);
    [check.imbalance(field, [1.0, 0.0]), check.violation(field, false)]
}

/// Returns the rate of the gap (n, s, t) at a point of a contact.
pub(super) fn jump(contact: &SpaceContact, point: &Vec3, motion: &[SpaceVelocity]) -> [f64; 3] {
    let at = |body: Option<usize>| body.map_or(Vec3::zeros(), |body| velocity_at(&motion[body], point));
    let rate = at(contact.plus) - at(contact.minus);
    contact.frame.map(|axis| axis.dot(&rate))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cube of side 1 and weight 1 on a plane with μ = 0.4, pushed along x at its centroid: it slides at λ = 0.4.
    fn cube() -> SpaceProblem {
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let vertices = corners.map(|[x, y]| Vec3::new(x, y, 0.0));
        let frame = [Vec3::z(), Vec3::x(), Vec3::y()];
        let contact = SpaceContact::new(0, [None, Some(0)], &vertices, frame, (FrictionCone::dry(0.4, 0.4), 1));
        let centroid = Vec3::new(0.5, 0.5, 0.5);
        SpaceProblem {
            free: vec![None, Some(0)],
            bodies: 1,
            contacts: vec![contact],
            fixed: vec![SpaceContact::wrench(&centroid, &-Vec3::z())],
            varying: vec![SpaceContact::wrench(&centroid, &Vec3::x())],
            pole: Vec3::zeros(),
            length: 2.0,
        }
    }

    /// The forces at collapse, by hand: the moment about y of the push is 0.2.
    fn forces() -> SpaceField {
        let [near, far] = [0.15, 0.35];
        vec![[near, far, far, near].map(|n| [n, -0.4 * n, 0.0]).to_vec()]
    }

    /// Slip along x with the opening of normality.
    const SLIP: [SpaceVelocity; 1] = [[1.0, 0.0, 0.4, 0.0, 0.0, 0.0]];

    fn claim<'a>(field: &'a SpaceField, motion: &'a [SpaceVelocity]) -> SpaceClaim<'a> {
        SpaceClaim {
            hint: Status::Collapse,
            target: f64::INFINITY,
            factor: Some(0.4),
            field_factor: 0.4,
            start: 0.0,
            field: Some(field),
            motion: Some(motion),
            ray: None,
            non_associated: None,
            search_is_trusted: true,
        }
    }

    /// The claim of the sliding cube passes with both bounds at μ.
    #[test]
    fn a_sliding_cube_is_certified() {
        let (problem, forces) = (cube(), forces());
        let verdict = certify_space(&problem, &claim(&forces, &SLIP), 1e-8);
        assert_eq!(verdict.status, Status::Collapse, "{:?}", verdict.certificate);
        assert!(verdict.bounds.iter().all(|bound| (bound.unwrap() - 0.4).abs() < 1e-15));
        assert_eq!(verdict.greatest, Greatest::ProvedOptimal);
    }

    /// A changed force, velocity or factor leaves at most one end of the factor.
    #[test]
    fn forged_evidence_of_a_collapse_is_refused() {
        let problem = cube();
        let mut heavy = forces();
        heavy[0][0][0] += 1e-8;
        let mut rough = forces();
        (rough[0][0][1], rough[0][1][1]) = (rough[0][0][1] - 1e-8, rough[0][1][1] + 1e-8);
        for field in [&heavy, &rough] {
            let verdict = certify_space(&problem, &claim(field, &SLIP), 1e-8);
            assert_eq!(verdict.status, Status::Open);
            assert!(verdict.bounds[0].is_none() && verdict.bounds[1].is_some());
        }
        let forces = forces();
        for k in [0, 2, 4] {
            let mut motion = SLIP;
            motion[0][k] += if k == 2 { -1e-7 } else { 1e-7 };
            let verdict = certify_space(&problem, &claim(&forces, &motion), 1e-8);
            assert_eq!(verdict.status, Status::Open, "{k}");
            assert_eq!(verdict.bounds, [Some(0.4), None]);
        }
        let high = SpaceClaim { factor: Some(0.4001), ..claim(&forces, &SLIP) };
        assert_eq!(certify_space(&problem, &high, 1e-8).status, Status::Open);
        let shifted = SpaceClaim { field_factor: 0.39, ..claim(&forces, &SLIP) };
        assert_eq!(certify_space(&problem, &shifted, 1e-8).bounds[0], None);
    }

    /// A motion that opens more than normality proves a greater bound, so that the bounds do not meet.
    #[test]
    fn a_worse_mechanism_leaves_the_factor_open() {
        let (problem, forces) = (cube(), forces());
        let verdict = certify_space(&problem, &claim(&forces, &[[1.0, 0.0, 0.5, 0.0, 0.0, 0.0]]), 1e-8);
        assert_eq!((verdict.status, verdict.bounds), (Status::Open, [Some(0.4), Some(0.5)]));
        assert!(!verdict.certificate.passed);
    }

    /// A field at the target proves that the cube stands, whatever the hint; a field elsewhere does not.
    #[test]
    fn a_field_at_the_target_stands() {
        let (problem, forces) = (cube(), forces());
        let field = SpaceClaim { target: 0.4, motion: None, ..claim(&forces, &[]) };
        assert_eq!(certify_space(&problem, &field, 1e-8).status, Status::Stands);
        let beyond = SpaceClaim { target: 0.41, ..field };
        assert_eq!(certify_space(&problem, &beyond, 1e-8).status, Status::Open);
    }

    /// A forged status is replaced by the one that the evidence proves: above μ the slip refutes equilibrium, below it not.
    #[test]
    fn a_refutation_needs_positive_work() {
        let problem = cube();
        let at = |start: f64, hint| {
            let none = SpaceClaim { field: None, start, hint, ..claim(const { &Vec::new() }, &SLIP) };
            certify_space(&problem, &none, 1e-8).status
        };
        assert_eq!(at(0.5, Status::Stands), Status::NoEquilibrium);
        assert_eq!(at(0.3, Status::NoEquilibrium), Status::Open);
    }

    /// A load into the ground is carried at every factor: forces that balance it alone prove it; forged ones do not.
    #[test]
    fn a_ray_proves_that_every_factor_is_carried() {
        let mut problem = cube();
        problem.varying = problem.fixed.clone();
        let field = vec![vec![[0.25, 0.0, 0.0]; 4]];
        let ray = SpaceClaim {
            field_factor: 0.0,
            ray: Some(&field),
            motion: None,
            hint: Status::Unbounded,
            ..claim(&field, &[])
        };
        assert_eq!(certify_space(&problem, &ray, 1e-8).status, Status::Unbounded);
        let forged = vec![vec![[0.25, 0.0, 0.0], [0.25, 0.0, 0.0], [0.5, 0.0, 0.0], [0.0; 3]]];
        let forged = SpaceClaim { ray: Some(&forged), ..ray };
        assert_ne!(certify_space(&problem, &forged, 1e-8).status, Status::Unbounded);
    }

    /// With its own flow the cube slides without opening, and the associated slip proves the bound beside it. Changed forces, motions and
    /// bounds are refused, and so is the field alone as a lower bound.
    #[test]
    fn a_state_with_its_own_flow_is_certified() {
        const LEVEL: [SpaceVelocity; 1] = [[1.0, 0.0, 0.0, 0.0, 0.0, 0.0]];
        let mut problem = cube();
        problem.contacts[0].law = FrictionCone::dry(0.4, 0.0);
        let forces = forces();
        let own = |factor, motion: Option<SpaceVelocity>| SpaceNonAssociated {
            searched: None,
            associated_factor: factor,
            associated_motion: motion.map(|motion| vec![motion]),
        };
        let honest = own(Some(0.4), Some(SLIP[0]));
        fn state<'a>(field: &'a SpaceField, own: &'a SpaceNonAssociated) -> SpaceClaim<'a> {
            SpaceClaim { non_associated: Some(own), ..claim(field, &LEVEL) }
        }
        let verdict = certify_space(&problem, &state(&forces, &honest), 1e-8);
        assert_eq!((verdict.status, verdict.greatest), (Status::Collapse, Greatest::Open), "{:?}", verdict.certificate);
        assert_eq!(verdict.bounds, [Some(0.0), Some(0.4)]);
        // If the hint leaves the answer open, the state is the upper end of the least load, also beyond the target.
        for target in [0.3, 1.0] {
            let none = own(None, None);
            let open = SpaceClaim { hint: Status::Open, target, ..state(&forces, &none) };
            let verdict = certify_space(&problem, &open, 1e-8);
            assert_eq!((verdict.status, verdict.bounds), (Status::Open, [None, Some(0.4)]));
        }
        for forged in [own(Some(0.39), Some(SLIP[0])), own(Some(0.4), Some(LEVEL[0])), own(Some(0.4), None)] {
            assert_ne!(certify_space(&problem, &state(&forces, &forged), 1e-8).status, Status::Collapse);
        }
        for k in [1, 2, 3, 4, 5] {
            let mut motion = LEVEL;
            motion[0][k] += 1e-5;
            let forged = SpaceClaim { motion: Some(&motion), ..state(&forces, &honest) };
            assert_eq!(certify_space(&problem, &forged, 1e-8).status, Status::Open, "{k}");
        }
        // The associated slip opens joints that carry.
        let opens = SpaceClaim { motion: Some(&SLIP), ..state(&forces, &honest) };
        assert_eq!(certify_space(&problem, &opens, 1e-8).status, Status::Open);
        // A field below friction with the same motion is a state that does not move.
        let low = vec![[0.2, 0.3, 0.3, 0.2].map(|n| [n, -0.05, 0.0]).to_vec()];
        let idle = SpaceClaim { factor: Some(0.2), field_factor: 0.2, ..state(&low, &honest) };
        let verdict = certify_space(&problem, &idle, 1e-8);
        assert_eq!((verdict.status, verdict.bounds), (Status::Open, [None, Some(0.4)]));
        // A search of this project bounds the least load; a search of another project is refused.
        for (lower, status, bounds, greatest) in [
            (0.3999999, Status::Collapse, [Some(0.3999999), Some(0.4)], Greatest::ProvedOptimal),
            (0.3, Status::Collapse, [Some(0.3), Some(0.4)], Greatest::Bracketed),
            (0.0, Status::Open, [None, Some(0.4)], Greatest::Open),
            (0.41, Status::Stalled, [None; 2], Greatest::Open),
        ] {
            let searched = SpaceNonAssociated { searched: Some(lower), ..honest.clone() };
            let verdict = certify_space(&problem, &state(&forces, &searched), 1e-8);
            assert_eq!((verdict.status, verdict.bounds, verdict.greatest), (status, bounds, greatest));
            let stranger = SpaceClaim { search_is_trusted: false, ..state(&forces, &searched) };
            let verdict = certify_space(&problem, &stranger, 1e-8);
            assert_eq!((verdict.status, verdict.bounds), (Status::Open, [None, Some(0.4)]), "{lower}");
        }
    }

    /// Evidence of the wrong size and numbers that are not finite are refused without a panic.
    #[test]
    fn evidence_that_does_not_fit_is_refused() {
        let (problem, forces) = (cube(), forces());
        let short: SpaceField = vec![forces[0][..3].to_vec()];
        let wrong = [[f64::NAN, 0.0, 0.4, 0.0, 0.0, 0.0]];
        for claim in [claim(&short, &SLIP), claim(&forces, &[]), claim(&forces, &wrong)] {
            let verdict = certify_space(&problem, &claim, 1e-8);
            assert_eq!((verdict.status, verdict.bounds), (Status::Stalled, [None; 2]));
        }
    }
}
