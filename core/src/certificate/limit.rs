//! Certificates of limit analysis: the proof of an answer, recomputed from the assembly alone.
//!
//! This code shares nothing with solvers. Equilibrium is summed body by body from forces at points. Strengths are
//! checked with the rectangular stress block. If several facets bound sliding in one sense, a distribution of tractions
//! with the forces of the joint is constructed, and each of its tractions is checked. Dissipation is the integral of the support function of the law's polygon
//! along each joint. Laws have associated flow, unless the claim is that a field and a mechanism obey the laws' own
//! flow. In this case the jumps must be combinations of the flow directions of the facets, and their power on the
//! distance of the field from the yield surface must vanish, joint by joint.

use super::mechanism::{CentroidVelocity, Jump, jumps_about, velocity_at};
use super::products::proved;
use super::residuals::Certificate;
use super::rounding::{ROUNDED, jump_rounding, lie};
use crate::law::{Facet, FacetMode, ForceRow, ShearEnvelope, ShearPiece, YieldPolygon, is_associated};
use crate::limit::{Greatest, LowerProof, LowerProofKind, Status};
use crate::model::geometry::{Vec2, cross};
use crate::model::{Assembly, Bond, FillReaction, Joint, StageLoads, Wrenches, add_force};
use std::collections::BTreeMap;

/// A contact force at a point of a joint, on the plus body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactForce {
    /// Index of the joint.
    pub joint: usize,
    /// Point of action \[m\].
    pub point: Vec2,
    /// (r_n, r_t) \[N\].
    pub force: [f64; 2],
}

/// The statement of an answer, with its evidence.
#[derive(Debug, Clone, Copy)]
pub struct Claim<'a> {
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
    /// Contact forces.
    pub field: Option<&'a [ContactForce]>,
    /// Forces of the fill that belong to the field, one for each reaction of the assembly \[N\].
    pub fill: &'a [f64],
    /// A field in equilibrium at the start and the forces of the fill that belong to it; results do not store it.
    pub start_field: Option<(&'a [ContactForce], &'a [f64])>,
    /// Velocity of every body.
    pub motion: Option<&'a [CentroidVelocity]>,
    /// Contact forces that balance the varying load alone; with `supports`, forces that balance without any load.
    pub ray: Option<&'a [ContactForce]>,
    /// Motion of every held block (`None` for free blocks). If given, the claim is that no motion of the free blocks is
    /// compatible with it.
    pub supports: Option<&'a [Option<CentroidVelocity>]>,
    /// All feasible factors, if the start is not among them.
    pub feasible_interval: Option<[f64; 2]>,
    /// Set if field and motion are claimed to obey the laws' own flow.
    pub non_associated: Option<NonAssociatedClaim<'a>>,
}

/// The result of checking a claim.
#[derive(Debug, Clone)]
pub struct Verdict {
    /// Residuals; `passed` if the status is neither open nor stalled.
    pub certificate: Certificate,
    /// The status that is proved.
    pub status: Status,
    /// Proved ends of the load factor, lower and upper. Associated flow: from the field and from the motion. The laws' own
    /// flow: ends of the least load. Both `None` if there is no such number.
    pub bounds: [Option<f64>; 2],
    /// The proof of the greatest factor; with the laws' own flow, of the least one.
    pub greatest: Greatest,
    /// Set if a field proves that the loads at the start are carried.
    pub start_is_carried: bool,
}

/// Additional claims if each joint has the flow of its law.
#[derive(Debug, Clone, Copy)]
pub struct NonAssociatedClaim<'a> {
    /// The claimed lower bound of all such factors.
    pub proved_lower: Option<f64>,
    /// The proof of the lower bound. Multipliers of products are checked. An exhaustive search leaves no data to check.
    pub lower_proof: Option<&'a LowerProof>,
    /// True if the solver is part of this project, so that its exhaustive search is trusted.
    pub search_is_trusted: bool,
    /// The collapse factor of associated flow.
    pub associated_factor: Option<f64>,
    /// The motion that proves its upper bound.
    pub associated_motion: Option<&'a [CentroidVelocity]>,
    /// The field that proves its lower bound and the forces of the fill that belong to it; results do not store it.
    pub associated_field: Option<(&'a [ContactForce], &'a [f64])>,
}

/// Tolerance of residuals that are zero except for rounding.
pub const ROUNDING: f64 = 1e-10;

/// Greatest relative distance between the factor of a field and the target of its stage.
const REACHED: f64 = 1e-12;

/// Greatest loss of a lower bound by products to rounding, relative to the factor.
const PRODUCTS: f64 = 1e-6;

/// Least excess of power over dissipation, relative to load times greatest jump, that is significant.
const EXCESS: f64 = 1e-13;

/// Greatest error of a ray that refutes a settlement, relative to its work on the settlement. This is about the ratio
/// of the settlement to the least motion that could be compatible with it.
const REFUTED: f64 = 1e-6;

/// Relative width below which the two ends of a least load count as equal.
const CLOSED: f64 = 1e-6;

/// The forces of a joint that are admitted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Admitted {
    /// Forces within the strengths.
    Strength,
    /// Forces that may grow without bound.
    Recession,
    /// Forces that do no positive work on any flow of the law, associated or not.
    NoWorkOnFlow,
}

/// The greatest jump of a motion; motions that refute equilibrium at every factor are scaled to 1.
pub fn largest_jump(jumps: &[Jump]) -> f64 {
    jumps.iter().map(Jump::size).fold(0.0, f64::max)
}

/// Returns the size of a motion: its greatest jump, or its greatest speed if jumps are negligible, for example if
/// blocks without contact move.
pub fn motion_size(jumps: &[Jump], motion: &[CentroidVelocity]) -> f64 {
    let speed = motion.iter().map(|v| v[0].hypot(v[1])).fold(0.0, f64::max);
    let jump = largest_jump(jumps);
    if jump > 1e-9 * speed { jump } else { speed }
}

struct Check<'a> {
    assembly: &'a Assembly,
    loads: &'a StageLoads,
    groups: Vec<Option<usize>>,
    facets: Vec<Vec<Facet>>,
    polygons: Vec<YieldPolygon>,
    /// Envelopes of the shear of one square metre, for laws with several sliding facets in one sense.
    envelopes: Vec<Vec<ShearEnvelope>>,
    /// Centroid of every body.
    centroids: Vec<Vec2>,
    size: f64,
    /// Sum of the sizes of the fixed and of the varying loads on free bodies \[N\].
    sizes: [f64; 2],
    /// Set if the laws of all joints have associated flow.
    associated: bool,
    certificate: Certificate,
}

/// Checks a claim about the stage with these loads and returns the status that its evidence proves. The hint is tried
/// first; if it fails, every other statement that the evidence could prove is tried.
pub fn certify(assembly: &Assembly, loads: &StageLoads, claim: &Claim, gap: f64) -> Verdict {
    let joined = |law: usize| assembly.joints.iter().any(|joint| joint.bond == Bond::Law(law));
    let unread = assembly
        .catalogue
        .laws
        .iter()
        .enumerate()
        .find_map(|(index, (name, law))| (joined(index) && law.facets().is_none()).then_some(name));
    if let Some(name) = unread {
        return Verdict::nothing(format!("joint law \"{name}\" has no facets: its strength cannot be checked"));
    }
    if let Some(why) = claim.misfit(assembly) {
        return Verdict::nothing(why);
    }
    let facets: Vec<Vec<Facet>> =
        assembly.catalogue.laws.iter().map(|(_, law)| law.facets().unwrap_or_default()).collect();
    let polygons: Vec<YieldPolygon> = facets.iter().map(|facets| YieldPolygon::of(facets)).collect();
    let mut check = Check {
        groups: assembly.rigid_groups().0,
        envelopes: polygons.iter().map(ShearEnvelope::both).collect(),
        polygons,
        centroids: assembly.centroids(),
        size: assembly.size(),
        sizes: [0.0; 2],
        associated: (0..facets.len()).all(|law| !joined(law) || is_associated(&facets[law])),
        facets,
        assembly,
        loads,
        certificate: Certificate::blank(),
    };
    let size = |wrenches: &Wrenches| check.free_bodies().map(|b| wrenches[b][0].hypot(wrenches[b][1])).sum();
    check.sizes = [size(&loads.fixed), size(&loads.varying)];
    let start_is_carried = check.start_is_carried(claim);
    Verdict { start_is_carried, ..check.decide(claim, gap) }
}

impl Verdict {
    /// Adds the residuals of the proof. The certificate fails if the status is open or stalled.
    fn with(self, mut certificate: Certificate) -> Self {
        if !self.status.is_answer() {
            certificate.passed = false;
            certificate.failures.push("no lower end of the least load is proved beyond the start of the stage".into());
        }
        Verdict { certificate, ..self }
    }

    /// A verdict that proves nothing, with the reason.
    fn nothing(why: String) -> Self {
        Verdict {
            certificate: Certificate { passed: false, residuals: BTreeMap::new(), failures: vec![why] },
            status: Status::Stalled,
            bounds: [None; 2],
            greatest: Greatest::Open,
            start_is_carried: false,
        }
    }
}

impl Claim<'_> {
    /// Returns the reason why the evidence does not match the assembly.
    fn misfit(&self, assembly: &Assembly) -> Option<String> {
        if !self.in_range() {
            return Some("a force or velocity is not finite, or too great to be checked".into());
        }
        let own = self.non_associated;
        let beside = [self.start_field, own.and_then(|own| own.associated_field)];
        let fields = [self.field, self.ray].into_iter().chain(beside.map(|beside| beside.map(|(field, _)| field)));
        if fields.flatten().flatten().any(|contact| contact.joint >= assembly.joints.len()) {
            return Some("a contact force acts on a joint that does not exist".into());
        }
        let motions = [self.motion, own.and_then(|own| own.associated_motion)];
        let fits = |motion: &[CentroidVelocity]| motion.len() == assembly.bodies.len();
        (!motions.into_iter().flatten().all(fits)).then(|| "the motion does not have one velocity for each body".into())
    }

    /// Returns true if the field is at the factor to which the stage goes.
    fn reaches_target(&self, idle: bool) -> bool {
        let near = (self.field_factor - self.target).abs() <= REACHED * self.target.abs();
        self.target.is_finite() && (idle || near)
    }
}

impl Check<'_> {
    /// Tries the hint, then every other statement, and returns the first that is proved.
    fn decide(&mut self, claim: &Claim, gap: f64) -> Verdict {
        let all = [Status::Stands, Status::Collapse, Status::Unbounded, Status::NoEquilibrium];
        let mut first: Option<Certificate> = None;
        let others = all.into_iter().filter(|status| *status != claim.hint);
        for status in std::iter::once(claim.hint).filter(|hint| all.contains(hint)).chain(others) {
            self.certificate = Certificate::blank();
            let bounds = self.proves(status, claim, gap);
            let certificate = std::mem::replace(&mut self.certificate, Certificate::blank());
            match bounds {
                Some(proved) if certificate.passed => return proved.with(certificate),
                _ if status == claim.hint => first = Some(certificate),
                _ => {}
            }
        }
        let (bounds, greatest) = (self.proved_ends(claim), Greatest::Open);
        let status = if bounds == [None; 2] { Status::Stalled } else { Status::Open };
        let mut certificate = first.unwrap_or_else(Certificate::blank);
        certificate.passed = false;
        if certificate.failures.is_empty() {
            certificate.failures.push("not proven".into());
        }
        Verdict { certificate, status, bounds, greatest, start_is_carried: false }
    }

    /// Returns true if the field at the start is in equilibrium there and within the strengths.
    fn start_is_carried(&mut self, claim: &Claim) -> bool {
        let Some((field, fill)) = claim.start_field else { return false };
        let at_start = Claim { field: Some(field), fill, field_factor: claim.start, ..*claim };
        let carried = self.field(&at_start);
        self.certificate = Certificate::blank();
        carried
    }

    /// Checks the evidence for one status. `None` if a part of the evidence is missing or fails.
    fn proves(&mut self, status: Status, claim: &Claim, gap: f64) -> Option<Verdict> {
        let idle = self.sizes[1] == 0.0;
        let verdict = |bounds, greatest| {
            let certificate = Certificate::blank();
            Some(Verdict { certificate, status, bounds, greatest, start_is_carried: false })
        };
        match status {
            Status::Stands => {
                if !claim.reaches_target(idle) {
                    let (at, target) = (claim.field_factor, claim.target);
                    self.certificate
                        .fail(format!("the field is at the factor {at}, not at the target {target} of the stage"));
                    return None;
                }
                self.field(claim);
                verdict([None; 2], Greatest::Open)
            }
            Status::Collapse if claim.non_associated.is_some() => {
                let [lower, factor] = self.non_associated(claim, gap)?;
                if factor > claim.target && claim.target >= claim.start {
                    self.certificate.fail(format!("the collapse lies beyond the target {} of the stage", claim.target));
                }
                let met = factor - lower <= CLOSED * factor.abs().max(self.factor_scale());
                // A lower end at the start proves nothing, unless both ends are equal.
                let lower = Some(lower).filter(|lower| met || *lower > claim.start);
                let greatest = match lower {
                    Some(_) if met => Greatest::ProvedOptimal,
                    Some(_) => Greatest::Bracketed,
                    None => Greatest::Open,
                };
                let least = claim.non_associated.is_some_and(|own| own.lower_proof.is_some());
                let status = if least && lower.is_none() { Status::Open } else { status };
                let bounds = [lower, Some(factor)];
                Some(Verdict { status, bounds, ..verdict([None; 2], greatest)? })
            }
            Status::Collapse => {
                let lower = self.field(claim).then_some(claim.field_factor);
                let upper = self.upper_bound(claim);
                let (Some(lower), Some((upper, uncertain))) = (lower, upper) else {
                    self.certificate.fail("a collapse needs a factor, an admissible field and a mechanism");
                    return None;
                };
                let factor = claim.factor.unwrap_or(lower);
                let scale = lower.abs().max(upper.abs()).max(self.factor_scale());
                let spread = (upper - lower).abs().max((factor - lower).abs()) / scale;
                self.certificate.residual("gap", spread, gap.max(uncertain / scale));
                if lower > claim.target && claim.target >= claim.start {
                    self.certificate.fail(format!("the collapse lies beyond the target {} of the stage", claim.target));
                }
                verdict([Some(lower.min(upper)), Some(upper.max(lower))], Greatest::ProvedOptimal)
            }
            Status::Unbounded => {
                self.field(claim);
                self.ray(claim);
                verdict([None; 2], Greatest::ProvedOptimal)
            }
            Status::NoEquilibrium => {
                match claim.supports {
                    Some(supports) => self.blocked(claim, supports),
                    None => self.refutation(claim, gap),
                }
                verdict([None; 2], Greatest::ProvedOptimal)
            }
            Status::LimitPoint | Status::Open | Status::Stalled => None,
        }
    }

    /// Returns the ends of the load factor that field and motion prove by themselves with associated flow. An end at
    /// the start of the stage proves nothing and is left out. With the laws' own flow there is only an upper end: no
    /// state is above the associated load.
    fn proved_ends(&mut self, claim: &Claim) -> [Option<f64>; 2] {
        if claim.supports.is_some() {
            return [None; 2];
        }
        let reads_associated = self.associated || claim.non_associated.is_none();
        self.certificate = Certificate::blank();
        let carried = reads_associated && claim.field.is_some() && self.field(claim);
        let lower = (carried && claim.field_factor > claim.start).then_some(claim.field_factor);
        self.certificate = Certificate::blank();
        let bound = self.upper_bound(claim).map(|(upper, _)| upper);
        let upper = bound.filter(|_| self.certificate.passed);
        self.certificate = Certificate::blank();
        let consistent = lower.zip(upper).is_none_or(|(lower, upper)| lower <= upper);
        if consistent { [lower, upper] } else { [None; 2] }
    }

    /// Returns the size of the loads at a factor, in force units.
    fn load_scale(&self, factor: f64) -> f64 {
        self.sizes[0] + factor.abs() * self.sizes[1]
    }

    /// Returns the scale of residuals at a factor [N]: the loads at the factor, or the varying load if there is no
    /// other.
    fn residual_scale(&self, factor: f64) -> f64 {
        let dead = self.load_scale(0.0);
        let at = self.load_scale(factor);
        (if dead > 0.0 { at } else { at.max(self.load_scale(1.0)) }).max(f64::MIN_POSITIVE)
    }

    /// Returns a scale for differences of factors: a thousandth of the fixed loads, used if the factor itself is
    /// smaller. A gap of 1e-9 is then 1e-12 of the fixed loads, while the equilibrium of a field is required only to
    /// 1e-10 of them.
    fn factor_scale(&self) -> f64 {
        let (dead, both) = (self.load_scale(0.0), self.load_scale(1.0));
        if dead == 0.0 {
            1.0
        } else if both > dead {
            1e-3 * dead / (both - dead)
        } else {
            0.0
        }
    }

    fn free_bodies(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.groups.len()).filter(|&body| self.groups[body].is_some())
    }

    /// Returns the greatest unbalanced resultant on any free group \[N\] from contact forces, forces of the fill and
    /// `fixed × dead + factor × varying`. Moments are about the first body of the group and divided by the size of the
    /// scene.
    fn imbalance(&self, forces: &[ContactForce], fill: &[f64], dead: f64, factor: f64) -> f64 {
        let count = self.groups.iter().flatten().max().map_or(0, |g| g + 1);
        let mut pole: Vec<Option<Vec2>> = vec![None; count];
        let mut sums = vec![[0.0f64; 3]; count];
        for body in self.free_bodies() {
            let Some(group) = self.groups[body] else {
                continue;
            };
            let pole = *pole[group].get_or_insert(self.centroids[body]);
            for (wrenches, factor) in [(&self.loads.fixed, dead), (&self.loads.varying, factor)] {
                let [x, y, moment] = wrenches[body];
                sums[group][0] += factor * x;
                sums[group][1] += factor * y;
                sums[group][2] += factor * (moment - cross(pole, Vec2::new(x, y)));
            }
        }
        for contact in forces {
            let joint = &self.assembly.joints[contact.joint];
            let (n, t) = joint.frame();
            let force = n * contact.force[0] + t * contact.force[1];
            for (body, sign) in [(joint.plus, 1.0), (joint.minus, -1.0)] {
                if let Some(group) = self.groups[body]
                    && let Some(pole) = pole[group]
                {
                    add_force(&mut sums[group], contact.point - pole, force, sign);
                }
            }
        }
        for (reaction, force) in self.assembly.fill_reactions().iter().zip(fill) {
            if let Some(group) = self.groups[reaction.body]
                && let Some(pole) = pole[group]
            {
                add_force(&mut sums[group], reaction.point - pole, reaction.direction, *force);
            }
        }
        sums.iter().map(|s| s[0].abs().max(s[1].abs()).max(s[2].abs() / self.size)).fold(0.0, f64::max)
    }

    /// Returns the greatest violation of the strengths of joints \[N\]; for sliding it is the distance from the facet.
    fn violation(&self, forces: &[ContactForce], admitted: Admitted) -> f64 {
        let strengths = admitted == Admitted::Strength;
        let mut resultants: Vec<Option<[f64; 3]>> = vec![None; self.assembly.joints.len()];
        for contact in forces {
            let joint = &self.assembly.joints[contact.joint];
            let lever = (contact.point - joint.middle()).dot(&joint.frame().1);
            let sum = resultants[contact.joint].get_or_insert_default();
            sum[0] += contact.force[0];
            sum[1] += contact.force[1];
            sum[2] += contact.force[0] * lever;
        }
        let directions = |facet: &Facet| if admitted == Admitted::NoWorkOnFlow { facet.flow } else { facet.normal };
        let sizes = |facets: &Vec<Facet>| facets.iter().map(directions).map(|[a, b]| a.hypot(b)).collect::<Vec<f64>>();
        let sizes: Vec<Vec<f64>> = self.facets.iter().map(sizes).collect();
        let mut worst = 0.0f64;
        for (joint, resultant) in self.assembly.joints.iter().zip(resultants) {
            let (Some([n, t, m]), Bond::Law(law)) = (resultant, joint.bond) else { continue };
            let (height, area) = (joint.height(), joint.height() * self.assembly.width);
            let polygon = &self.polygons[law];
            let scale = if strengths { area } else { 0.0 };
            let least = polygon.least_normal() * scale;
            let arm = 2.0 * m.abs() / height;
            let greatest = polygon.greatest_normal();
            if greatest.is_infinite() {
                worst = worst.max(arm - (n - least));
            } else {
                // The compressed depth d of a rectangular stress block must fit beside |M|/N.
                let full = (greatest * scale - least).max(0.0);
                let block = n - least;
                worst = worst.max(-block).max(block - full);
                let depth = if full > 0.0 { block / full } else { 0.0 };
                worst = worst.max(arm - block.max(0.0) * (1.0 - depth));
            }
            for (facet, size) in self.facets[law].iter().zip(&sizes[law]).filter(|(f, _)| f.normal[1] != 0.0) {
                let [a, b] = directions(facet);
                worst = worst.max((a * n + b * t - facet.bound * scale) / size);
            }
            if strengths {
                let force = [n / 2.0 - m / height, n / 2.0 + m / height, t];
                let beyond = |envelope| beyond_envelope(envelope, &self.facets[law], force, area);
                worst = self.envelopes[law].iter().map(beyond).fold(worst, f64::max);
            }
        }
        worst
    }

    fn field(&mut self, claim: &Claim) -> bool {
        let Some(field) = claim.field else {
            self.certificate.fail("no field");
            return false;
        };
        let at = claim.field_factor;
        let scale = self.residual_scale(at);
        let balanced =
            self.certificate.residual("equilibrium", self.imbalance(field, claim.fill, 1.0, at) / scale, ROUNDING);
        let pressed = self.fill(claim, scale);
        self.certificate.residual("strength", self.violation(field, Admitted::Strength) / scale, ROUNDING)
            && balanced
            && pressed
    }

    /// Returns true if the forces of the fill lie between their least and greatest values.
    fn fill(&mut self, claim: &Claim, scale: f64) -> bool {
        let bounds = &self.loads.fill_bounds;
        if claim.fill.len() != bounds.len() {
            self.certificate.fail("the forces of the fill are not one for each of its reactions");
            return false;
        }
        if bounds.is_empty() {
            return true;
        }
        let beyond = |(force, [least, greatest]): (&f64, &[f64; 2])| (least - force).max(force - greatest);
        // NaN counts as a violation.
        let worse = |worst: f64, x: f64| if x <= worst { worst } else { x };
        let worst = claim.fill.iter().zip(bounds).map(beyond).fold(0.0, worse);
        self.certificate.residual("fill", worst / scale, ROUNDING)
    }

    fn ray(&mut self, claim: &Claim) {
        let Some(ray) = claim.ray else {
            return self.certificate.fail("no ray");
        };
        let largest = ray.iter().map(|c| c.force[0].hypot(c.force[1])).fold(0.0, f64::max);
        let load = self.load_scale(1.0) - self.load_scale(0.0);
        let scale = load.max(largest).max(f64::MIN_POSITIVE);
        self.certificate.residual("ray_equilibrium", self.imbalance(ray, &[], 0.0, 1.0) / scale, ROUNDING);
        self.certificate.residual("ray_strength", self.violation(ray, Admitted::Recession) / scale, ROUNDING);
    }

    /// Checks by Farkas' lemma that no motion of the free blocks is compatible with the motion of the supports. The ray
    /// is in balance without loads and does no positive work on any flow of the joints, so its work on the gaps of
    /// every motion is ≥ 0. But this work equals its work on the gaps that the supports alone cause, which is < 0.
    fn blocked(&mut self, claim: &Claim, supports: &[Option<CentroidVelocity>]) {
        let Some(ray) = claim.ray else {
            return self.certificate.fail("no ray that refutes the motion of the supports");
        };
        let still: Vec<CentroidVelocity> = supports.iter().map(|motion| motion.unwrap_or_default()).collect();
        let moved = |body: usize, point: Vec2| velocity_at(self.centroids[body], still[body], point);
        let (mut work, mut forces, mut greatest) = (0.0, 0.0, 0.0f64);
        for contact in ray {
            let joint = &self.assembly.joints[contact.joint];
            // Supports may overlap each other: their joint is part of the ground.
            if supports[joint.minus].is_some() && supports[joint.plus].is_some() {
                continue;
            }
            let (n, t) = joint.frame();
            let apart = moved(joint.plus, contact.point) - moved(joint.minus, contact.point);
            work += contact.force[0] * apart.dot(&n) + contact.force[1] * apart.dot(&t);
            forces += contact.force[0].hypot(contact.force[1]);
            greatest = greatest.max(apart.norm());
        }
        let errors = self.imbalance(ray, &[], 0.0, 0.0) + self.violation(ray, Admitted::NoWorkOnFlow);
        let share = -work / (forces * greatest);
        if share.is_nan() || share <= 0.0 {
            return self.certificate.fail(format!("the ray does no work against the supports: {share:.3e}"));
        }
        self.certificate.residual("settlement_ray", errors / forces / share, REFUTED);
    }

    fn powers(&self, motion: &[CentroidVelocity]) -> Powers {
        let (mut fixed, mut varying, mut turnover) = (0.0, 0.0, [0.0; 2]);
        let lie = self.assembly.joints.iter().map(lie).fold(1.0, f64::max);
        let centroids = &self.centroids;
        for body in self.free_bodies() {
            let c = centroids[body];
            let [vx, vy, omega] = motion[body];
            let power = |w: &[f64; 3]| w[0] * vx + w[1] * vy + (w[2] - (c.x * w[1] - c.y * w[0])) * omega;
            fixed += power(&self.loads.fixed[body]);
            varying += power(&self.loads.varying[body]);
            let terms = |w: &[f64; 3]| {
                let turning = w[2].abs() + (c.x * w[1]).abs() + (c.y * w[0]).abs();
                lie * ((w[0] * vx).abs() + (w[1] * vy).abs()) + turning * omega.abs()
            };
            turnover[0] += terms(&self.loads.fixed[body]);
            turnover[1] += terms(&self.loads.varying[body]);
        }
        let jumps = jumps_about(self.assembly, &self.centroids, motion);
        let largest = motion_size(&jumps, motion).max(f64::MIN_POSITIVE);
        let (mut dissipated, mut impossible, mut uncertain) = (0.0, 0.0f64, 0.0);
        let strongest = |polygon: &YieldPolygon| polygon.vertices.iter().map(|v| v[0].hypot(v[1])).fold(0.0, f64::max);
        let strongest: Vec<f64> = self.polygons.iter().map(strongest).collect();
        for (joint, jump) in self.assembly.joints.iter().zip(&jumps) {
            let Bond::Law(law) = joint.bond else {
                impossible = impossible.max(jump.size());
                continue;
            };
            let polygon = &self.polygons[law];
            for open in jump.open {
                impossible = impossible.max(polygon.impossible([open, jump.slip]));
            }
            let area = joint.height() * self.assembly.width;
            dissipated += support_integral(&polygon.vertices, jump) * area;
            uncertain += strongest[law] * area * jump_rounding(joint, motion, centroids);
        }
        for (reaction, bounds) in self.assembly.fill_reactions().iter().zip(&self.loads.fill_bounds) {
            let speed = self.fill_speed(reaction, motion);
            dissipated += fill_dissipation(*bounds, speed);
            uncertain += ROUNDED * bounds[1] * speed.abs();
        }
        let factor = if varying == 0.0 { 0.0 } else { ((dissipated - fixed) / varying).abs() };
        uncertain += ROUNDED * (turnover[0] + factor * turnover[1]);
        Powers { fixed, varying, dissipated, uncertain, impossible: impossible / largest }
    }

    /// Returns the velocity of the point of action of the fill, towards the ring.
    fn fill_speed(&self, reaction: &FillReaction, motion: &[CentroidVelocity]) -> f64 {
        velocity_at(self.centroids[reaction.body], motion[reaction.body], reaction.point).dot(&reaction.direction)
    }

    /// Returns Σ |H u + dissipation| over the forces H of the fill: zero if the fill flows only on its bounds.
    fn idle_fill(&self, fill: &[f64], motion: &[CentroidVelocity]) -> f64 {
        let reactions = self.assembly.fill_reactions().iter().zip(&self.loads.fill_bounds).zip(fill);
        let idle = reactions.map(|((reaction, bounds), force)| {
            let speed = self.fill_speed(reaction, motion);
            (force * speed + fill_dissipation(*bounds, speed)).abs()
        });
        idle.sum()
    }

    /// Checks field and mechanism with the laws' own flow: both exist at one factor, each joint moves only if it
    /// yields, and no associated bound is exceeded. Returns the bounds \[claimed lower, factor\].
    fn non_associated(&mut self, claim: &Claim, gap: f64) -> Option<[f64; 2]> {
        let own = claim.non_associated?;
        let (Some(factor), Some(motion), Some(field)) = (claim.factor, claim.motion, claim.field) else {
            self.certificate.fail("a collapse needs a factor, an admissible field and a mechanism");
            return None;
        };
        if factor != claim.field_factor {
            self.certificate.fail("the field is not at the collapse factor");
        }
        let admissible = self.field(claim);
        self.held(motion);
        let varying = self.powers(motion).varying;
        let scaled = self.certificate.residual("motion_scale", (varying - 1.0).abs(), 1e-9);
        let jumps = jumps_about(self.assembly, &self.centroids, motion);
        let largest = largest_jump(&jumps).max(f64::MIN_POSITIVE);
        let laws = (&self.facets[..], &self.polygons[..]);
        let (impossible, mut idle) = idle_power(self.assembly, laws, field, (&jumps, largest), |_| true);
        idle += self.idle_fill(claim.fill, motion);
        let flows = self.certificate.residual("flow", impossible / largest, ROUNDING);
        let scale = self.residual_scale(factor) * largest;
        let complementary = self.certificate.residual("complementarity", idle / scale, ROUNDING);
        let unit = factor.abs().max(self.factor_scale());
        if let Some(greatest) = own.associated_factor {
            let unit = unit.max(greatest.abs());
            self.certificate.residual("above_associated", ((factor - greatest) / unit).max(0.0), gap);
            let Some(motion) = own.associated_motion else {
                self.certificate.fail("no motion proves the associated factor");
                return None;
            };
            self.held(motion);
            let Powers { fixed, varying, dissipated, uncertain, impossible } = self.powers(motion);
            self.certificate.residual("associated_flow", impossible, ROUNDING);
            self.certificate.residual("associated_motion_scale", (varying - 1.0).abs(), 1e-9);
            let spread = ((dissipated - fixed) / varying - greatest).abs() / unit;
            self.certificate.residual("associated_gap", spread, gap.max(uncertain / varying.abs() / unit));
            if let Some((field, fill)) = own.associated_field {
                self.associated_field(greatest, field, fill);
            }
        }
        // Without a proof there is no lower bound beyond the start.
        let claimed = own.proved_lower.filter(|_| own.lower_proof.is_some());
        let mut lower = claimed.unwrap_or(claim.start);
        if !(claim.start <= lower && lower <= factor) {
            self.certificate.fail(format!("the lower bound {lower} does not lie between the start and the factor"));
        }
        if let Some(proof) = own.lower_proof {
            let strongest = field.iter().map(|c| c.force[0].abs().max(c.force[1].abs())).fold(0.0, f64::max);
            let shown = match proof.by {
                LowerProofKind::Search if own.search_is_trusted => Ok((f64::INFINITY, 0.0)),
                LowerProofKind::Search => Err("an exhaustive search leaves nothing that could be checked".into()),
                LowerProofKind::Start => Ok((claim.start, 0.0)),
                // The state then has associated flow: its factor is the only one and the greatest.
                LowerProofKind::Associated if self.associated => Ok((factor, 0.0)),
                LowerProofKind::Associated => Err("the flow of some law is not associated".into()),
                LowerProofKind::Products => {
                    proved(self.assembly, self.loads, &proof.steps, [claim.start, factor], [largest, strongest])
                }
            };
            match shown {
                // Subtract the possible rounding error of the multipliers, and subtract it twice, so that a computation
                // with different rounding confirms the bound.
                Ok((shown, rounding)) if lower > shown && lower - shown <= PRODUCTS * unit => {
                    lower = (shown - rounding).max(claim.start);
                }
                Ok((shown, _)) if lower <= shown => {}
                Ok((shown, _)) => self.certificate.fail(format!("the lower bound {lower} is not proved, only {shown}")),
                Err(why) => self.certificate.fail(format!("the lower bound: {why}")),
            }
        }
        (admissible && scaled && flows && complementary).then_some([lower, factor])
    }

    /// Checks the field that proves the lower bound of the associated factor.
    fn associated_field(&mut self, at: f64, field: &[ContactForce], fill: &[f64]) {
        let scale = self.residual_scale(at);
        self.certificate.residual("associated_equilibrium", self.imbalance(field, fill, 1.0, at) / scale, ROUNDING);
        self.certificate.residual("associated_strength", self.violation(field, Admitted::Strength) / scale, ROUNDING);
    }

    /// Returns the factor that the motion proves, and its possible change from rounding of the jumps if strengths are
    /// far above the forces.
    fn upper_bound(&mut self, claim: &Claim) -> Option<(f64, f64)> {
        let motion = claim.motion?;
        let Powers { fixed, varying, dissipated, uncertain, impossible } = self.powers(motion);
        self.held(motion);
        let flows = self.certificate.residual("flow", impossible, ROUNDING);
        let scaled = self.certificate.residual("motion_scale", (varying - 1.0).abs(), 1e-9);
        (flows && scaled).then(|| ((dissipated - fixed) / varying, uncertain / varying.abs()))
    }

    /// Checks that held bodies do not move.
    fn held(&mut self, motion: &[CentroidVelocity]) {
        if self.groups.iter().zip(motion).any(|(group, v)| group.is_none() && v.iter().any(|x| *x != 0.0)) {
            self.certificate.fail("a body held by the ground moves");
        }
    }

    fn refutation(&mut self, claim: &Claim, gap: f64) {
        let Some(motion) = claim.motion else {
            return self.certificate.fail("no motion that refutes equilibrium");
        };
        self.held(motion);
        let Powers { fixed, varying, dissipated, uncertain, impossible } = self.powers(motion);
        self.certificate.residual("flow", impossible, ROUNDING);
        let excess = fixed + claim.start * varying - dissipated;
        let largest = motion_size(&jumps_about(self.assembly, &self.centroids, motion), motion);
        let scale = self.residual_scale(claim.start) * largest;
        if excess.is_nan() || excess <= EXCESS * scale {
            self.certificate
                .fail(format!("the loads do no more work on the motion than is dissipated: excess {excess:.3e}"));
        }
        self.certificate.residuals.insert("excess_power".into(), excess / scale);
        match claim.feasible_interval {
            Some([low, high]) => {
                let near = if low > claim.start { low } else { high };
                self.certificate.residual("motion_scale", (varying.abs() - 1.0).abs(), 1e-9);
                let proven = (dissipated - fixed) / varying;
                let scale = proven.abs().max(near.abs()).max(self.factor_scale());
                self.certificate.residual(
                    "interval_gap",
                    (proven - near).abs() / scale,
                    gap.max(uncertain / varying.abs() / scale),
                );
            }
            None => {
                self.certificate.residual("motion_scale", (largest - 1.0).abs(), 1e-9);
            }
        }
    }
}

/// Powers on a motion.
struct Powers {
    /// Power of the fixed loads.
    fixed: f64,
    /// Power of the varying loads.
    varying: f64,
    /// Power dissipated in the joints.
    dissipated: f64,
    /// Uncertainty of the difference of these powers: rounding of the jumps times the strengths, and rounding of the
    /// powers of the loads.
    uncertain: f64,
    /// The greatest jump that is not possible for any force of a law, relative to the greatest jump.
    impossible: f64,
}

/// Returns the power dissipated in fill whose point of action moves towards the ring at a speed. The greatest force
/// resists motion into the fill; the least force drives motion away from it.
fn fill_dissipation([least, greatest]: [f64; 2], speed: f64) -> f64 {
    (-speed * least).max(-speed * greatest)
}

/// Returns ∫₀¹ max_v v·(−ġ(s)) ds of the linear jump along a joint: the power dissipated per area. The maximum of
/// linear functions is integrated exactly between their crossings.
pub(super) fn support_integral(vertices: &[[f64; 2]], jump: &Jump) -> f64 {
    let end = |v: &[f64; 2], i: usize| -(v[0] * jump.open[i] + v[1] * jump.slip);
    // Dry joints: there is one function and no crossing.
    if let [vertex] = vertices {
        return (end(vertex, 0) + end(vertex, 1)) / 2.0;
    }
    let lines: Vec<[f64; 2]> = vertices.iter().map(|v| [end(v, 0), end(v, 1)]).collect();
    let mut cuts = vec![0.0, 1.0];
    for (i, a) in lines.iter().enumerate() {
        for b in &lines[i + 1..] {
            let (first, last) = (a[0] - b[0], a[1] - b[1]);
            if first * last < 0.0 {
                cuts.push(first / (first - last));
            }
        }
    }
    cuts.sort_by(f64::total_cmp);
    let greatest = |s: f64| lines.iter().map(|l| l[0] + s * (l[1] - l[0])).fold(f64::NEG_INFINITY, f64::max);
    cuts.windows(2).map(|w| (w[1] - w[0]) * (greatest(w[0]) + greatest(w[1])) / 2.0).sum()
}

/// Returns the greatest jump that is not a combination of flow directions, and Σ γ_i s_i over all joints: the power of
/// the flow on the distance of the field from the yield surface. Slip gives the multiplier of its sliding facet; the
/// rest of the opening is associated. Joints that do not `count` are skipped.
pub(super) fn idle_power(
    assembly: &Assembly,
    (facets, polygons): (&[Vec<Facet>], &[YieldPolygon]),
    field: &[ContactForce],
    (jumps, largest): (&[Jump], f64),
    counts: impl Fn(&Joint) -> bool,
) -> (f64, f64) {
    let mut resultants = vec![[0.0f64; 3]; jumps.len()];
    for contact in field {
        let joint = &assembly.joints[contact.joint];
        let lever = (contact.point - joint.middle()).dot(&joint.frame().1);
        let sum = &mut resultants[contact.joint];
        sum[0] += contact.force[0];
        sum[1] += contact.force[1];
        sum[2] += contact.force[0] * lever;
    }
    let (mut impossible, mut idle) = (0.0f64, 0.0);
    for ((joint, jump), [n, t, m]) in assembly.joints.iter().zip(jumps).zip(resultants) {
        if !counts(joint) {
            continue;
        }
        let Bond::Law(law) = joint.bond else {
            impossible = impossible.max(jump.size());
            continue;
        };
        let (height, area) = (joint.height(), joint.height() * assembly.width);
        let mut open = jump.open;
        // Slip within rounding counts as zero, whatever the distance of a facet from yielding.
        let slip = if jump.slip.abs() > 8.0 * f64::EPSILON * largest { jump.slip } else { 0.0 };
        let slack = |f: &Facet| f.bound * area - f.normal[0] * n - f.normal[1] * t;
        let sliding = facets[law].iter().filter(|f| f.mode == FacetMode::Sliding && f.flow[1] * slip < 0.0);
        match sliding.min_by(|a, b| slack(a).total_cmp(&slack(b))) {
            Some(facet) => {
                let gamma = -slip / facet.flow[1];
                open.iter_mut().for_each(|o| *o += gamma * facet.flow[0]);
                idle += gamma * slack(facet).abs();
            }
            None => impossible = impossible.max(slip.abs()),
        }
        let polygon = &polygons[law];
        let (least, greatest) = (polygon.least_normal(), polygon.greatest_normal());
        let mut corners = vec![[least, 0.0]];
        if greatest.is_finite() {
            corners.push([greatest, 0.0]);
        } else {
            impossible = open.iter().fold(impossible, |worst, o| worst.max(-o));
        }
        let opening = Jump { open, slip: 0.0 };
        let ends = [n / 2.0 - m / height, n / 2.0 + m / height];
        let power = support_integral(&corners, &opening) * area + ends[0] * open[0] + ends[1] * open[1];
        idle += power.abs();
    }
    (impossible, idle)
}

/// Returns the distance \[N\] of forces N_0, N_1 and T of a joint from the forces of an admissible distribution of
/// tractions with at least as much shear in the envelope's sense. If tractions exceed a facet, the excess is added. The first
/// distribution has the same normal forces; because the envelope may be steep, the second one has the normal forces nearest to
/// the deepest row.
fn beyond_envelope(envelope: &ShearEnvelope, facets: &[Facet], [n_0, n_1, t]: [f64; 3], area: f64) -> f64 {
    let whole = envelope.over(area);
    let distance = |asked: [f64; 2]| {
        let distribution = whole.greatest(asked);
        let [first, second, shear] = distribution.resultants();
        let excess = |piece: &ShearPiece, facet: &Facet| {
            let force = [piece.force[0], envelope.sense * piece.force[1]];
            let bound = facet.bound * area * (piece.ends[1] - piece.ends[0]);
            (facet.normal[0] * force[0] + facet.normal[1] * force[1] - bound) / facet.normal[0].hypot(facet.normal[1])
        };
        let excesses = distribution.pieces.iter().flat_map(|piece| facets.iter().map(|facet| excess(piece, facet)));
        let exceeded: f64 = excesses.fold(0.0, f64::max);
        exceeded + (n_0 - first).abs().max((n_1 - second).abs()).max(envelope.sense * t - shear)
    };
    let own = distance([n_0, n_1]);
    if own <= 0.0 {
        return own;
    }
    let Some(ForceRow { normal: [a, b, c], bound, .. }) = whole.deepest_row([n_0, n_1, t]) else { return own };
    let beyond = (a * n_0 + b * n_1 + c * t - bound) / (a * a + b * b + c * c);
    own.min(distance([n_0 - a * beyond, n_1 - b * beyond]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_dissipation_of_a_crushing_rotation_is_that_of_its_compressed_part() {
        // f_c = 4 on the closing part of a joint whose ends move by −1 and +3: 4 · (1/2 · 1/4).
        let jump = Jump { open: [-1.0, 3.0], slip: 0.0 };
        let power = support_integral(&[[0.0, 0.0], [4.0, 0.0]], &jump);
        assert!((power - 0.5).abs() < 1e-15);
    }

    /// Teeth sheared off at 4 + 0.6 t_n: with N = 20 and M/h = 8 a joint of one square metre carries T = 14.53, by hand. Each
    /// facet over the whole joint would admit 16.
    #[test]
    fn an_eccentric_joint_carries_less_shear_than_its_facets_admit() {
        let pairs = [Facet::friction(1.0, 0.0, 1.0), Facet::friction(0.6, 4.0, 0.6)];
        let facets: Vec<Facet> = pairs.into_iter().flatten().chain([Facet::opening(0.0)]).collect();
        let envelopes = ShearEnvelope::both(&YieldPolygon::of(&facets));
        let beyond = |t: f64| {
            let of = |envelope| beyond_envelope(envelope, &facets, [2.0, 18.0, t], 1.0);
            envelopes.iter().map(of).fold(0.0, f64::max)
        };
        let greatest = 0.4f64.sqrt() * 10.0 * 0.4 + 0.6 * 20.0;
        for sense in [1.0, -1.0] {
            assert!(beyond(sense * (greatest - 1e-9)) < 1e-12);
            let over = beyond(sense * (greatest + 0.1));
            assert!((0.02..0.1).contains(&over), "{over}");
        }
    }
}
