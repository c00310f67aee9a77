//! Mechanisms: the joints that rotate, slide and crush in a motion, and the kind of collapse.

use super::moving_contact::{ContactMode, MovingContact};
use crate::law::{FacetMode, FlowRule, InterfaceLaw, YieldPolygon};
use crate::model::geometry::{Vec2, turned};
use crate::model::{Assembly, Bond, Joint};
use serde::{Deserialize, Serialize};

/// The kind of a mechanism.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MechanismKind {
    /// Three hinges.
    ThreeHinge,
    /// Four hinges.
    FourHinge,
    /// Five hinges.
    FiveHinge,
    /// Any other number of hinges.
    Rocking,
    /// Sliding only.
    Sliding,
    /// Crushing only.
    Crushing,
    /// Torsion of contacts only; in space.
    Twisting,
    /// Contacts only open completely; in space.
    Separating,
    /// A combination of hinges, sliding, torsion and crushing.
    Mixed,
}

/// The face of an arch on which a hinge closes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// Inner face.
    Intrados,
    /// Outer face.
    Extrados,
}

/// A joint that rotates while its blocks stay in contact.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Hinge {
    /// Index of the joint.
    pub joint: usize,
    /// Names of the bodies \[minus, plus\].
    pub between: [String; 2],
    /// Side of the contact; arches only.
    pub side: Option<Side>,
    /// Point of contact \[m\].
    pub point: [f64; 2],
    /// Rotation of plus relative to minus \[rad per unit of motion\].
    pub rotation: f64,
}

/// A joint that slides.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Sliding {
    /// Index of the joint.
    pub joint: usize,
    /// Names of the bodies \[minus, plus\].
    pub between: [String; 2],
    /// Slip of plus relative to minus along t \[m per unit of motion\].
    pub slip: f64,
}

/// A joint that crushes: by its law over more than half of the height, or by the blocks next to it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Crushing {
    /// Index of the joint.
    pub joint: usize,
    /// Names of the bodies \[minus, plus\].
    pub between: [String; 2],
    /// Crushed share of the height.
    pub share: f64,
}

/// A collapse mechanism.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Mechanism {
    /// Its kind.
    pub kind: MechanismKind,
    /// Number of hinges; neighbouring joints with equal side and sense count as one. In space: number of distinct axes.
    pub hinge_count: usize,
    /// True if it is the only mechanism; `null` if not known.
    pub unique: Option<bool>,
    /// All rotating joints whose blocks stay in contact.
    pub hinges: Vec<Hinge>,
    /// Every sliding joint.
    pub sliding: Vec<Sliding>,
    /// All joints that crush over more than [`CRUSHES`] of their height, and all joints next to a yielding block that
    /// has crushed, over any share. The kind counts shares above [`CRUSHES`].
    pub crushing: Vec<Crushing>,
    /// In space: all contacts that move. The lists above are then empty.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub contacts: Vec<MovingContact>,
    /// Its place on a path; `None` for limit analysis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<MechanismPlace>,
}

/// The place of a mechanism on a path.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MechanismPlace {
    /// At constant load: forces do not change.
    Plateau,
    /// Just after a limit point: the load falls and forces change.
    Peak,
}

impl MechanismPlace {
    /// Relative change of a load that counts as constant.
    const STANDS_STILL: f64 = 1e-6;

    /// Returns the place of a mechanism at a factor, if the path continues from there to another factor.
    pub fn of(factor: f64, followed_to: f64) -> Self {
        let still = (followed_to - factor).abs() <= Self::STANDS_STILL * factor.abs();
        if still { MechanismPlace::Plateau } else { MechanismPlace::Peak }
    }
}

/// Velocity of a body: \[v_x, v_y\] at its centroid and ω.
pub type CentroidVelocity = [f64; 3];

/// Relative velocity of the plus body at a joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jump {
    /// ġ_n at the two ends.
    pub open: [f64; 2],
    /// ġ_t, constant along the joint.
    pub slip: f64,
}

impl Jump {
    /// Returns the relative rotation of plus for a joint of this height.
    pub fn rotation(&self, height: f64) -> f64 {
        (self.open[0] - self.open[1]) / height
    }

    /// Returns the size of the greatest component.
    pub fn size(&self) -> f64 {
        self.open[0].abs().max(self.open[1].abs()).max(self.slip.abs())
    }
}

/// Returns the velocity of a point of a body.
pub fn velocity_at(centroid: Vec2, velocity: CentroidVelocity, point: Vec2) -> Vec2 {
    Vec2::new(velocity[0], velocity[1]) + turned(point - centroid) * velocity[2]
}

/// Returns the jumps at all joints for a motion of all bodies.
pub fn jumps(assembly: &Assembly, motion: &[CentroidVelocity]) -> Vec<Jump> {
    jumps_about(assembly, &assembly.centroids(), motion)
}

/// Returns the jumps at all joints, given the centroids of all bodies.
pub(super) fn jumps_about(assembly: &Assembly, centroids: &[Vec2], motion: &[CentroidVelocity]) -> Vec<Jump> {
    let jump = |joint: &Joint| {
        let (n, t) = joint.frame();
        let apart = joint.ends.map(|point| {
            let at = |body: usize| velocity_at(centroids[body], motion[body], point);
            at(joint.plus) - at(joint.minus)
        });
        Jump { open: apart.map(|v| v.dot(&n)), slip: (apart[0] + apart[1]).dot(&t) / 2.0 }
    };
    assembly.joints.iter().map(jump).collect()
}

/// Share of a joint's height above which its rotation counts as crushing instead of a hinge.
pub const CRUSHES: f64 = 0.5;

/// Greatest size of jumps that are ignored, as a share of the greatest jump.
const TOLERANCE: f64 = 1e-9;

/// Returns the clearance of a point of a joint, given the rays of the law without crushing: positive if apart, zero in
/// contact (including slip with dilatancy), negative if crushing.
fn clearance(rays: &[[f64; 2]], open: f64, slip: f64) -> f64 {
    let along = |ray: &[f64; 2]| (ray[0] * open + ray[1] * slip) / ray[0].max(0.1);
    rays.iter().map(along).fold(f64::INFINITY, f64::min)
}

/// Identifies the mechanism of a motion in which joints have the flow `flow`. `None` if nothing moves.
pub fn mechanism(
    assembly: &Assembly,
    motion: &[CentroidVelocity],
    unique: Option<bool>,
    flow: FlowRule,
) -> Option<Mechanism> {
    mechanism_of_deforming(Deforming { share: TOLERANCE, pressed: &[] }, assembly, motion, unique, flow)
}

/// Data of bodies that deform while they move.
#[derive(Debug, Clone, Copy)]
pub struct Deforming<'a> {
    /// Jumps below this share of the greatest jump are deformation.
    pub share: f64,
    /// For each joint, the end near which its blocks press on each other: the point of contact, also if the toe yields.
    pub pressed: &'a [Option<usize>],
}

/// Identifies the mechanism of rates of bodies that also deform.
pub fn mechanism_of_deforming(
    deforming: Deforming,
    assembly: &Assembly,
    motion: &[CentroidVelocity],
    unique: Option<bool>,
    flow: FlowRule,
) -> Option<Mechanism> {
    let jumps = jumps(assembly, motion);
    let tolerance = deforming.share * jumps.iter().map(Jump::size).fold(0.0, f64::max);
    if tolerance == 0.0 {
        return None;
    }
    let rays: Vec<Vec<[f64; 2]>> = assembly.catalogue.laws.iter().map(|(_, law)| contact_rays(&**law, flow)).collect();
    let can_crush: Vec<bool> = assembly.catalogue.laws.iter().map(|(_, law)| crushes(&**law)).collect();
    let mut found = Mechanism {
        kind: MechanismKind::Rocking,
        hinge_count: 0,
        unique,
        hinges: Vec::new(),
        sliding: Vec::new(),
        crushing: Vec::new(),
        contacts: Vec::new(),
        at: None,
    };
    for (index, (joint, jump)) in assembly.joints.iter().zip(&jumps).enumerate() {
        let Bond::Law(law) = joint.bond else { continue };
        let height = joint.height();
        let between = || [joint.minus, joint.plus].map(|body| assembly.bodies[body].name.clone());
        let clear = jump.open.map(|open| clearance(&rays[law], open, jump.slip));
        if clear[0] > tolerance && clear[1] > tolerance {
            continue; // apart along the whole joint
        }
        if jump.slip.abs() > tolerance {
            found.sliding.push(Sliding { joint: index, between: between(), slip: jump.slip });
        }
        // If nothing can crush, an end with closing velocity was open and closes again, unless deformable blocks are
        // pressed and rotate.
        let crushable = can_crush[law];
        let pressed = deforming.pressed.get(index).copied().flatten();
        let gives_way = pressed.filter(|end| turns_about(clear, *end));
        if !crushable && gives_way.is_none() && clear.iter().all(|c| c.abs() > tolerance) {
            continue;
        }
        let crushed = if crushable { crushed_share(clear, tolerance) } else { 0.0 };
        if crushed > CRUSHES {
            found.crushing.push(Crushing { joint: index, between: between(), share: crushed });
        }
        let rotation = jump.rotation(height);
        if (rotation * height).abs() > tolerance && crushed < 1.0 {
            let nearer = if crushable { clear[1] < clear[0] } else { clear[1].abs() < clear[0].abs() };
            let touching = gives_way.filter(|_| !crushable).unwrap_or(usize::from(nearer));
            let toward = joint.ends[1 - touching] - joint.ends[touching];
            let point = joint.ends[touching] + toward * crushed;
            let arch = assembly.arch.as_ref().filter(|arch| arch.crosses_ring(index));
            let side = arch.map(|_| [Side::Intrados, Side::Extrados][touching]);
            found.hinges.push(Hinge { joint: index, between: between(), side, point: point.into(), rotation });
        }
    }
    found.name_kind(assembly);
    Some(found)
}

impl Mechanism {
    /// Adds joints next to crushing blocks. A joint next to which more than half of the height crushes does not count
    /// as a hinge.
    pub fn with_crushing(mut self, assembly: &Assembly, crushing: Vec<Crushing>) -> Self {
        for new in crushing {
            match self.crushing.iter_mut().find(|own| own.joint == new.joint) {
                Some(own) => own.share = own.share.max(new.share),
                None => self.crushing.push(new),
            }
        }
        self.crushing.sort_by_key(|c| c.joint);
        let turning = std::mem::take(&mut self.hinges);
        self.hinges = turning.into_iter().filter(|hinge| !self.crushes(hinge.joint)).collect();
        self.name_kind(assembly);
        self
    }

    /// Returns true if more than [`CRUSHES`] of a joint crushes.
    pub fn crushes(&self, joint: usize) -> bool {
        self.crushing.iter().any(|c| c.joint == joint && c.share > CRUSHES)
    }

    /// Returns the number of contacts in space that move in this way.
    pub fn count_of(&self, mode: ContactMode) -> usize {
        self.contacts.iter().filter(|contact| contact.has(mode)).count()
    }

    /// Returns the contacts in space that move in one of these ways.
    pub fn contacts_with<'a>(&'a self, modes: &'a [ContactMode]) -> impl Iterator<Item = usize> + 'a {
        let moves = |contact: &&MovingContact| modes.iter().any(|mode| contact.has(*mode));
        self.contacts.iter().filter(moves).map(|contact| contact.joint)
    }

    /// Counts hinges and determines the kind.
    fn name_kind(&mut self, assembly: &Assembly) {
        let crushing = self.crushing.iter().any(|c| c.share > CRUSHES);
        let hinges: Vec<&Hinge> = self.hinges.iter().filter(|hinge| !self.crushes(hinge.joint)).collect();
        self.hinge_count = count_merged(assembly, &hinges);
        self.kind = match (self.hinge_count, self.sliding.is_empty(), !crushing) {
            (0, false, true) => MechanismKind::Sliding,
            (0, true, false) => MechanismKind::Crushing,
            (3, true, true) => MechanismKind::ThreeHinge,
            (4, true, true) => MechanismKind::FourHinge,
            (5, true, true) => MechanismKind::FiveHinge,
            (_, true, true) => MechanismKind::Rocking,
            _ => MechanismKind::Mixed,
        };
    }
}

/// Returns true if a law allows overlap of blocks: it crushes, or it is a response.
fn crushes(law: &dyn InterfaceLaw) -> bool {
    law.facets().is_none_or(|facets| facets.iter().any(|facet| facet.mode == FacetMode::Crushing))
}

fn contact_rays(law: &dyn InterfaceLaw, flow: FlowRule) -> Vec<[f64; 2]> {
    let facets = law.facets().unwrap_or_default();
    let mut uncrushed: Vec<_> = facets.into_iter().filter(|f| f.mode != FacetMode::Crushing).collect();
    if flow == FlowRule::NonAssociated {
        uncrushed.iter_mut().for_each(|f| f.normal = f.flow);
    }
    let mut rays = YieldPolygon::of(&uncrushed).rays;
    let opposite = |a: &[f64; 2], b: &[f64; 2]| a[0] * b[0] + a[1] * b[1] < -0.999;
    if rays.len() < 2 || rays.iter().any(|a| rays.iter().any(|b| opposite(a, b))) {
        // No sliding along the joint: blocks separate only by opening.
        rays = vec![[1.0, 0.0]];
    }
    rays
}

/// Returns true if pressed deformable blocks rotate about an end: one end closes while the other opens, or the pressed
/// end moves far less than the other.
fn turns_about(clear: [f64; 2], end: usize) -> bool {
    clear[0] * clear[1] < 0.0 || clear[end].abs() < CRUSHES * clear[1 - end].abs()
}

/// Returns the share of the height over which the clearance, linear along the joint, is negative.
fn crushed_share(clear: [f64; 2], tolerance: f64) -> f64 {
    let [low, high] = if clear[0] < clear[1] { clear } else { [clear[1], clear[0]] };
    if low >= -tolerance {
        0.0
    } else if high <= tolerance {
        1.0
    } else {
        low / (low - high)
    }
}

/// Counts hinges; joints that share a body and rotate in the same sense on the same side count as one.
fn count_merged(assembly: &Assembly, hinges: &[&Hinge]) -> usize {
    let mut count = hinges.len();
    let mut group: Vec<usize> = (0..hinges.len()).collect();
    for i in 0..hinges.len() {
        for j in 0..i {
            let (a, b) = (&assembly.joints[hinges[i].joint], &assembly.joints[hinges[j].joint]);
            let neighbours =
                [a.minus, a.plus].iter().any(|body| !assembly.bodies[*body].fixed && [b.minus, b.plus].contains(body));
            let off = |joint: &Joint, hinge: &Hinge| Vec2::from(hinge.point) - joint.middle();
            let alike =
                hinges[i].rotation * hinges[j].rotation > 0.0 && off(a, hinges[i]).dot(&off(b, hinges[j])) > 0.0;
            if neighbours && alike && group[i] != group[j] {
                let (from, to) = (group[i], group[j]);
                group.iter_mut().filter(|g| **g == from).for_each(|g| *g = to);
                count -= 1;
            }
        }
    }
    count
}

#[cfg(test)]
mod tests {
    use super::turns_about;

    #[test]
    fn a_pressed_joint_turns_about_the_end_that_is_pressed() {
        let cases = [
            ([-0.1, 1.0], true),   // the toe yields by a tenth of the opening of the other end
            ([-1.5, 1.0], true),   // the toe yields by more
            ([0.1, -1.0], true),   // an open joint closes and its toe is relieved
            ([0.05, 1.0], true),   // the joint gets longer
            ([-0.2, -1.0], true),  // an open joint closes and is pressed
            ([-0.8, -1.0], false), // the joint is pressed along its whole height
            ([0.8, 1.0], false),
            ([-1.0, -0.2], false),
        ];
        for (clear, turns) in cases {
            assert_eq!(turns_about(clear, 0), turns, "{clear:?}");
            assert_eq!(turns_about([clear[1], clear[0]], 1), turns, "{clear:?}");
        }
    }
}
