//! A load that is carried: the forces of each joint, the reserve to collapse, and the permissible limit state.
//!
//! Signs: N > 0 presses. V > 0 acts along the joint from its end 0 to its end 1 on the plus block. M > 0 if the resultant
//! acts nearer to end 1; on arches end 1 is the extrados. Eccentricity e = M/N from the middle of the joint.

use serde::{Deserialize, Serialize};
use voussoir_core::certificate::ContactForce;
use voussoir_core::law::{Facet, FacetMode, ShearEnvelope, UnitStrength, YieldPolygon};
use voussoir_core::limit::Status;
use voussoir_core::model::{Assembly, Bond, Joint};

/// Joints with a smaller normal force, relative to the greatest one, are treated as unloaded.
const NO_FORCE: f64 = 1e-9;

/// The greatest share of the collapse load that the permissible limit state allows.
pub const PERMISSIBLE_SHARE: f64 = 0.5;
/// The document that states this rule.
const PERMISSIBLE_RULE: &str = "CS 454 (National Highways), masonry arch bridges, permissible limit state: load effects at most 0.5 of the ultimate capacity";

/// The forces of a joint under a load that is carried.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct JointEntry {
    /// Index of the joint.
    pub joint: usize,
    /// Names of its blocks, minus and plus.
    pub between: [String; 2],
    /// N \[N\].
    pub normal: f64,
    /// V \[N\].
    pub shear: f64,
    /// M about the middle \[N m\].
    pub moment: f64,
    /// M/N \[m\]; `null` if the joint does not press.
    pub eccentricity: Option<f64>,
    /// Contact length \[m\] for a linear pressure distribution without tension.
    pub contact_length: f64,
    /// Greatest pressure of that distribution \[Pa\]; `null` if the resultant acts at the edge of the joint or outside.
    pub greatest_stress: Option<f64>,
    /// The rectangular stress block, if the joint crushes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub block: Option<BlockEntry>,
    /// Factor on V at which the joint slides, with the same N; `null` if it never does.
    pub sliding_reserve: Option<f64>,
    /// Least and greatest eccentricity over all admissible fields of rigid blocks \[m\].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub zone: Option<[f64; 2]>,
}

/// A rectangular stress block about the resultant, which ends at the nearer edge of the joint.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct BlockEntry {
    /// Compressed length h − 2|e| \[m\].
    pub length: f64,
    /// Its pressure \[Pa\].
    pub stress: f64,
    /// Compressive strength \[Pa\].
    pub strength: f64,
}

/// The flow rule that the reserve analysis uses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ReserveFlow {
    /// All laws have associated flow: the reserve is the collapse factor.
    Associated,
    /// Some law has non-associated flow but is solved with associated flow: the reserve is an upper bound.
    ReadAsAssociated,
}

/// The factor on the loads of the last stage at which the scene collapses, by limit analysis of rigid blocks that have not moved.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ReserveEntry {
    /// Name of the stage.
    pub stage: String,
    /// The factor that is carried.
    pub target: f64,
    /// Status of the search for the collapse load.
    pub status: Status,
    /// The collapse factor; `null` if the loads do not lead to collapse.
    pub factor: Option<f64>,
    /// Proved lower and upper bound of the factor.
    pub bounds: Option<[Option<f64>; 2]>,
    /// The flow rule of the joints.
    pub flow: ReserveFlow,
}

/// The check of the permissible limit state of masonry arches.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PermissibleEntry {
    /// Document and rule.
    pub rule: String,
    /// Greatest share of the collapse load.
    pub share: f64,
    /// Used share: the carried factor divided by the collapse factor. 0 if no factor leads to collapse.
    pub used: f64,
    /// True if the proved lower end of the collapse factor fulfils the rule, false if the upper end violates it, `null` if
    /// neither is proved.
    pub holds: Option<bool>,
}

/// Results for a load that is carried.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct CarriedLoad {
    /// The forces of all joints in `field`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub joints: Vec<JointEntry>,
    /// The reserve to collapse.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reserve: Option<ReserveEntry>,
    /// On arches and bridges, the permissible limit state.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub permissible: Option<PermissibleEntry>,
}

impl CarriedLoad {
    /// Returns true if there are no results.
    pub fn is_empty(&self) -> bool {
        self.joints.is_empty() && self.reserve.is_none()
    }
}

/// The forces of all joints in a field, without zones.
pub fn joint_entries(assembly: &Assembly, field: &[ContactForce]) -> Vec<JointEntry> {
    let mut sums: Vec<Option<[f64; 3]>> = vec![None; assembly.joints.len()];
    for contact in field {
        let joint = &assembly.joints[contact.joint];
        let place = (contact.point - joint.middle()).dot(&joint.frame().1);
        let [normal, shear, moment] = sums[contact.joint].get_or_insert([0.0; 3]);
        *normal += contact.force[0];
        *shear += contact.force[1];
        *moment += contact.force[0] * place;
    }
    let largest = sums.iter().flatten().fold(0.0f64, |most, sum| most.max(sum[0].abs()));
    let entries = sums.into_iter().enumerate();
    entries.filter_map(|(index, sum)| Some(entry(assembly, index, sum?, NO_FORCE * largest))).collect()
}

fn entry(assembly: &Assembly, index: usize, [normal, shear, moment]: [f64; 3], least: f64) -> JointEntry {
    let joint = &assembly.joints[index];
    let (height, width) = (joint.height(), assembly.width);
    let eccentricity = (normal > least).then(|| moment / normal);
    let facets = facets_of(assembly, joint);
    let pressed = eccentricity.filter(|e| e.abs() < height / 2.0).map(|e| (normal, e));
    let (contact_length, greatest_stress) = match pressed {
        Some((normal, e)) if e.abs() <= height / 6.0 => {
            (height, Some(normal / (width * height) * (1.0 + 6.0 * e.abs() / height)))
        }
        Some((normal, e)) => {
            let length = 3.0 * (height / 2.0 - e.abs());
            (length, Some(2.0 * normal / (width * length)))
        }
        None => (0.0, None),
    };
    let strength = facets.as_deref().and_then(compressive_strength);
    let block = pressed.zip(strength).map(|((normal, e), strength)| {
        let length = height - 2.0 * e.abs();
        BlockEntry { length, stress: normal / (width * length), strength }
    });
    JointEntry {
        joint: index,
        between: [joint.minus, joint.plus].map(|body| assembly.bodies[body].name.clone()),
        normal,
        shear,
        moment,
        eccentricity,
        contact_length,
        greatest_stress,
        block,
        sliding_reserve: facets.and_then(|facets| sliding_reserve(&facets, [height, width], [normal, shear, moment])),
        zone: None,
    }
}

fn facets_of(assembly: &Assembly, joint: &Joint) -> Option<Vec<Facet>> {
    match joint.bond {
        Bond::Bonded => None,
        Bond::Law(law) => assembly.catalogue.laws[law].1.facets(),
    }
}

/// f_c \[Pa\] of a joint's facets, if it is finite.
fn compressive_strength(facets: &[Facet]) -> Option<f64> {
    let block = UnitStrength::of(facets).ok()?.over(1.0).block?;
    Some(block.total - block.tension)
}

/// The factor on V at which a_n N + a_t V = b A for the first sliding facet. For friction without cohesion it is μN/|V|. If
/// several facets bound sliding in this sense, the greatest shear depends on M too.
fn sliding_reserve(facets: &[Facet], [height, width]: [f64; 2], [normal, shear, moment]: [f64; 3]) -> Option<f64> {
    let area = height * width;
    let envelopes = ShearEnvelope::both(&YieldPolygon::of(facets));
    if let Some(envelope) = envelopes.iter().find(|envelope| envelope.sense * shear > 0.0) {
        let ends = [normal / 2.0 - moment / height, normal / 2.0 + moment / height];
        let [.., greatest] = envelope.over(area).greatest(ends).resultants();
        return Some(greatest / shear.abs()).filter(|factor| factor.is_finite());
    }
    let sliding = facets.iter().filter(|facet| facet.mode == FacetMode::Sliding && facet.normal[1] * shear > 0.0);
    let factors = sliding.map(|facet| (facet.bound * area - facet.normal[0] * normal) / (facet.normal[1] * shear));
    factors.reduce(f64::min).filter(|factor| factor.is_finite())
}

/// The check of the permissible limit state; `None` for scenes that are neither arches nor bridges, and if the search for
/// collapse has no answer.
pub fn permissible(assembly: &Assembly, reserve: &ReserveEntry) -> Option<PermissibleEntry> {
    if assembly.arch.is_none() && assembly.bridge.is_none() {
        return None;
    }
    let [lower, upper] = reserve.bounds.unwrap_or_default();
    let (used, holds) = match (reserve.status, reserve.factor) {
        // Associated flow proves that no factor leads to collapse. For non-associated laws it proves nothing.
        (Status::Unbounded, _) => (0.0, (reserve.flow == ReserveFlow::Associated).then_some(true)),
        (_, Some(factor)) => {
            let fulfils = |end: f64| reserve.target <= PERMISSIBLE_SHARE * end;
            let lower = lower.filter(|_| reserve.flow == ReserveFlow::Associated);
            let holds = match (lower.map(fulfils), upper.map(fulfils)) {
                (Some(true), _) => Some(true),
                (_, Some(false)) => Some(false),
                _ => None,
            };
            (reserve.target / factor, holds)
        }
        (_, None) => return None,
    };
    Some(PermissibleEntry { rule: PERMISSIBLE_RULE.into(), share: PERMISSIBLE_SHARE, used, holds })
}
