//! Checks the description of a load that is carried. The forces of joints follow from the stored field. The zone of
//! thrust and the reserve must fit these forces; their numbers are compared with solving again.

use crate::checks::fields::{EQUAL, close, contacts};
use crate::checks::findings::Findings;
use crate::results::CaseResult;
use crate::results::carried::{JointEntry, ReserveEntry, joint_entries, permissible};
use crate::solve::carried::is_asked;
use crate::study::Case;
use voussoir_core::limit::Status;
use voussoir_core::model::Target;

/// Rounding tolerance for an eccentricity outside its zone, relative to the joint's height.
const OUTSIDE: f64 = 1e-6;

/// Checks the forces of joints, their zones, the reserve and the permissible limit state.
pub(crate) fn verify(case: &Case, result: &CaseResult, findings: &mut Findings) -> Result<(), String> {
    let carried = &result.carried;
    let asked = is_asked(case, result);
    let field = contacts(&case.assembly, result.proof.field.as_deref().filter(|_| asked).unwrap_or_default())?;
    let expected = joint_entries(&case.assembly, &field);
    let same = carried.joints.len() == expected.len() && same_forces(&carried.joints, &expected);
    findings.expect(
        same,
        "joints: N, V, M or the values made from them differ from those that the stored forces in field give",
    );
    for entry in carried.joints.iter().filter(|entry| !zone_fits(case, entry)) {
        let words = format!("the zone of joint {}", entry.joint);
        findings.expect_entry(false, &words, (entry.zone, "it must contain the eccentricity", entry.eccentricity));
    }
    if let Some(reserve) = &carried.reserve {
        findings.expect(
            asked && reserve_fits(case, reserve),
            "reserve: its stage, its target or its factor contradicts the study or its own bounds",
        );
    }
    let expected = carried.reserve.as_ref().and_then(|reserve| permissible(&case.assembly, reserve));
    let values = (&carried.permissible, "the stored reserve gives", &expected);
    findings.expect_entry(carried.permissible == expected, "permissible", values);
    Ok(())
}

/// Returns true if all numbers differ only by rounding, relative to the greatest number of their kind.
fn same_forces(stored: &[JointEntry], expected: &[JointEntry]) -> bool {
    let numbers = |entry: &JointEntry| {
        let block = entry.block.map(|block| [block.length, block.stress, block.strength]);
        let always = [entry.normal, entry.shear, entry.moment, entry.contact_length].map(Some);
        let block = block.map_or([None; 3], |block| block.map(Some));
        [&always[..], &[entry.eccentricity, entry.greatest_stress, entry.sliding_reserve], &block].concat()
    };
    stored.iter().zip(expected).all(|(a, b)| {
        let same = |(a, b): (&Option<f64>, &Option<f64>)| match (a, b) {
            (Some(a), Some(b)) => close(*a, *b),
            (None, None) => true,
            _ => false,
        };
        (a.joint, &a.between) == (b.joint, &b.between) && numbers(a).iter().zip(&numbers(b)).all(same)
    })
}

fn zone_fits(case: &Case, entry: &JointEntry) -> bool {
    let Some([least, greatest]) = entry.zone else { return true };
    let slack = OUTSIDE * case.assembly.joints[entry.joint].height();
    least <= greatest && entry.eccentricity.is_none_or(|e| least - slack <= e && e <= greatest + slack)
}

fn reserve_fits(case: &Case, reserve: &ReserveEntry) -> bool {
    let Some(stage) = case.stages.last() else { return false };
    let [lower, upper] = reserve.bounds.unwrap_or_default();
    let between = |factor: f64| {
        lower.is_none_or(|lower| lower <= factor * (1.0 + EQUAL))
            && upper.is_none_or(|upper| factor <= upper * (1.0 + EQUAL))
    };
    let carried = |factor: f64| factor >= reserve.target * (1.0 - EQUAL);
    let fits = match reserve.status {
        Status::Collapse | Status::Open => reserve.factor.is_none_or(|factor| between(factor) && carried(factor)),
        _ => reserve.factor.is_none() && reserve.bounds.is_none(),
    };
    reserve.stage == stage.name && stage.target == Target::Factor(reserve.target) && fits
}
