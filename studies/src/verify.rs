//! `voussoir verify`: checks results against the study they claim to answer.
//!
//! Reads only `results.json` and `resolved.toml`. Everything that can be recomputed without a solver
//! is recomputed: certificate, bounds, mechanism, thrust line, stages.

use crate::answer::{start_of, thrust_line};
use crate::results::{CaseResult, FieldEntry, MotionEntry, StudyResults};
use crate::study::{Case, Study};
use voussoir_core::certificate::{
    CentroidVelocity, Claim, ContactForce, Mechanism, NonAssociatedClaim, certify, mechanism,
};
use voussoir_core::law::{FlowRule, is_associated};
use voussoir_core::limit::Status;
use voussoir_core::model::geometry::{Vec2, distance_to_segment};
use voussoir_core::model::{Assembly, Bond, Target, stage_loads};
use voussoir_core::plugin::{PluginKind, card};

/// Relative difference up to which recomputed numbers count as equal.
const EQUAL: f64 = 1e-9;

/// What is wrong with a set of results, by case; empty when everything is confirmed.
pub fn verify(study: &Study, results: &StudyResults) -> Vec<(usize, String)> {
    let mut wrong = Vec::new();
    if results.study != study.name {
        wrong.push((0, format!("results of \"{}\", study \"{}\"", results.study, study.name)));
    }
    let mut seen = std::collections::BTreeSet::new();
    for result in &results.cases {
        if !seen.insert(result.id) {
            wrong.push((result.id, "appears twice".into()));
        }
        match study.cases.get(result.id) {
            Some(case) => wrong.extend(verify_case(case, result).into_iter().map(|why| (result.id, why))),
            None => wrong.push((result.id, "the study has no such case".into())),
        }
    }
    let comparison = crate::kinds::kind(&study.kind).and_then(|kind| kind.compare(study, &results.cases));
    if comparison != results.comparison {
        wrong.push((0, "the comparison is not that of the cases".into()));
    }
    wrong
}

fn close(a: f64, b: f64) -> bool {
    a == b || (a - b).abs() <= EQUAL * a.abs().max(b.abs())
}

/// Contact forces of a stored field, or why it is none.
pub(crate) fn contacts(assembly: &Assembly, field: &[FieldEntry]) -> Result<Vec<ContactForce>, String> {
    let size = assembly.size();
    field
        .iter()
        .map(|entry| {
            let joint = assembly.joints.get(entry.joint).ok_or(format!("field: no joint {}", entry.joint))?;
            let point = Vec2::from(entry.point);
            // Written so that NaN fails.
            let on_joint = distance_to_segment(point, joint.ends[0], joint.ends[1]) <= EQUAL * size;
            if !on_joint || !entry.force.iter().all(|f| f.is_finite()) {
                return Err(format!("field: a force of joint {} does not act on that joint", entry.joint));
            }
            Ok(ContactForce { joint: entry.joint, point, force: entry.force })
        })
        .collect()
}

fn verify_case(case: &Case, result: &CaseResult) -> Vec<String> {
    match recompute(case, result) {
        Ok(wrong) => wrong,
        Err(why) => vec![why],
    }
}

fn recompute(case: &Case, result: &CaseResult) -> Result<Vec<String>, String> {
    let mut wrong: Vec<String> = Vec::new();
    let mut expect = |fine: bool, what: &str| {
        if !fine {
            wrong.push(what.to_string());
        }
    };
    expect(result.variant == case.variant, "variant is not that of the study");
    expect(result.scene == case.scene, "scene is not that of the study");
    expect(result.parameters == case.parameters, "parameters are not those of the study");
    let assembly = &case.assembly;
    let last = result.stages.len().checked_sub(1).ok_or("no stage")?;
    let stage = case.stages.get(last).ok_or("more stages than the study has")?;
    let named = result.stages.iter().zip(&case.stages).all(|(done, stage)| done.name == stage.name);
    expect(named, "stages are not those of the study");
    expect(result.stages[last].status == result.status, "status is not that of the last stage");
    let earlier_stand = result.stages[..last].iter().all(|s| s.status == Status::Stands);
    expect(
        earlier_stand || result.status == Status::NoEquilibrium || result.status == Status::Stalled,
        "an earlier stage did not stand",
    );
    for (done, stage) in result.stages[..last].iter().zip(&case.stages) {
        let reached = matches!(stage.target, Target::Factor(factor) if done.factor == Some(factor));
        expect(reached || done.status != Status::Stands, "the factor of an earlier stage is not that of the study");
        expect(done.hinges.is_empty(), "an earlier stage has hinges");
    }
    if result.status == Status::Stalled {
        expect(result.load_factor.is_none(), "stalled with a load factor");
        return Ok(wrong);
    }
    let start = match stage.target {
        Target::Collapse => start_of(stage),
        // A stage whose loads decrease is asked at its end, any other at its start.
        Target::Factor(factor) => factor.min(0.0),
    };
    if card(PluginKind::PathSolver, &result.solver).is_some() {
        wrong.extend(crate::path::verify(case, result)?);
        return Ok(wrong);
    }
    let field = result.field.as_deref().map(|f| contacts(assembly, f)).transpose()?;
    let ray = result.ray.as_deref().map(|f| contacts(assembly, f)).transpose()?;
    let motion = result.motion.as_deref().map(|motion| velocities(assembly, motion)).transpose()?;
    let infinite = [f64::NEG_INFINITY, f64::INFINITY];
    let interval = result.feasible_interval.map(|ends| [0, 1].map(|i| ends[i].unwrap_or(infinite[i])));
    let non_associated = assembly.joints.iter().any(|joint| match joint.bond {
        Bond::Bonded => false,
        Bond::Law(law) => {
            let facets = assembly.catalogue.laws[law].1.formulation().facets();
            facets.is_some_and(|facets| !is_associated(&facets))
        }
    });
    let own = (non_associated && result.flow_read_as.is_none()) || result.associated_load_factor.is_some();
    expect(!own || result.flow_read_as.is_none(), "flow_read_as does not fit the associated load factor");
    let associated_motion =
        result.associated_motion.as_deref().map(|motion| velocities(assembly, motion)).transpose()?;
    let claim = Claim {
        status: result.status,
        factor: result.load_factor,
        field_factor: result.field_factor.unwrap_or(start),
        start,
        field: field.as_deref(),
        motion: motion.as_deref(),
        ray: ray.as_deref(),
        feasible_interval: interval,
        non_associated: own.then_some(NonAssociatedClaim {
            proved_lower: result.bounds.map(|b| b[0]),
            lower_proof: result.lower_proof.as_ref(),
            associated_factor: result.associated_load_factor,
            associated_motion: associated_motion.as_deref(),
        }),
    };
    let loads = stage_loads(assembly, &case.stages);
    let (certificate, bounds) = certify(assembly, &loads[last], &claim, case.solver.tolerance);
    expect(certificate.passed == result.certificate.passed, "the stored verdict is not the recomputed one");
    let same = certificate.residuals.iter().all(|(name, value)| {
        result.certificate.residuals.get(name).is_some_and(|stored| (stored - value).abs() <= EQUAL)
    });
    expect(same, "stored residuals are not the recomputed ones");
    expect((result.load_factor.is_some()) == (result.status == Status::Collapse), "only a collapse has a load factor");
    let bounds_match = match (result.bounds, bounds) {
        (Some(a), Some(b)) => close(a[0], b[0]) && close(a[1], b[1]),
        (None, None) => true,
        _ => false,
    };
    expect(bounds_match, "bounds are not those of field and mechanism");
    if let Some([Some(low), Some(high)]) = result.feasible_interval {
        expect(low <= high && !(low <= start && start <= high), "the feasible interval holds the start");
    }
    if let (Some(reached), Target::Factor(factor)) = (result.stages[last].factor, stage.target) {
        let expected = if result.status == Status::Collapse { result.load_factor.unwrap_or(f64::NAN) } else { factor };
        expect(close(reached, expected), "the factor of the last stage is not the load factor");
    }
    if let (Status::Collapse, Target::Collapse) = (result.status, stage.target) {
        expect(result.stages[last].factor == result.load_factor, "the factor of the last stage is not the load factor");
    }
    if result.status == Status::Stands {
        let reached = match stage.target {
            Target::Factor(factor) => factor,
            Target::Collapse => stage.factor_max,
        };
        let idle = loads[last].varying.iter().all(|w| *w == [0.0; 3]);
        expect(idle || close(claim.field_factor, reached), "the field is not at the factor the stage goes to");
    }
    let reading = if own { FlowRule::NonAssociated } else { FlowRule::Associated };
    let unique = result.mechanism.as_ref().and_then(|m| m.unique);
    let recomputed = motion.as_ref().and_then(|motion| mechanism(assembly, motion, unique, reading));
    match (&result.mechanism, &recomputed) {
        (Some(stored), Some(recomputed)) => wrong.extend(differences(stored, recomputed)),
        (None, None) => {}
        _ => wrong.push("there is a motion without a mechanism, or a mechanism without a motion".into()),
    }
    let hinges: Vec<usize> = result.mechanism.iter().flat_map(|m| &m.hinges).map(|h| h.joint).collect();
    if result.stages[last].hinges != hinges {
        wrong.push("hinges of the last stage are not those of the mechanism".into());
    }
    let line = field.as_ref().and_then(|field| thrust_line(assembly, field));
    if !same_line(&line, &result.thrust_line) {
        wrong.push("the thrust line is not that of the field".into());
    }
    if result.flow_read_as.as_deref().is_some_and(|word| word != "associated" || !non_associated) {
        wrong.push("flow_read_as does not fit the laws".into());
    }
    if !certificate.passed {
        wrong.extend(certificate.failures);
    }
    Ok(wrong)
}

pub(crate) fn velocities(assembly: &Assembly, motion: &[MotionEntry]) -> Result<Vec<CentroidVelocity>, String> {
    if motion.len() != assembly.bodies.len() {
        return Err("motion: not one velocity for each body".into());
    }
    assembly
        .bodies
        .iter()
        .zip(motion)
        .map(|(body, entry)| {
            let fine = body.name == entry.body && entry.velocity.iter().all(|v| v.is_finite());
            fine.then_some(entry.velocity)
                .ok_or(format!("motion: \"{}\" is not the velocity of \"{}\"", entry.body, body.name))
        })
        .collect()
}

fn differences(stored: &Mechanism, recomputed: &Mechanism) -> Vec<String> {
    let mut wrong = Vec::new();
    if stored.kind != recomputed.kind {
        wrong.push(format!("kind {:?}, by the motion {:?}", stored.kind, recomputed.kind));
    }
    if stored.hinge_count != recomputed.hinge_count {
        wrong.push(format!("hinge_count {}, by the motion {}", stored.hinge_count, recomputed.hinge_count));
    }
    let hinges = stored.hinges.len() == recomputed.hinges.len()
        && stored.hinges.iter().zip(&recomputed.hinges).all(|(a, b)| {
            (a.joint, &a.between, a.side) == (b.joint, &b.between, b.side)
                && close(a.rotation, b.rotation)
                && (Vec2::from(a.point) - Vec2::from(b.point)).norm() <= EQUAL * (1.0 + Vec2::from(b.point).norm())
        });
    if !hinges {
        wrong.push("hinges are not those of the motion".into());
    }
    let sliding = stored.sliding.len() == recomputed.sliding.len()
        && stored
            .sliding
            .iter()
            .zip(&recomputed.sliding)
            .all(|(a, b)| (a.joint, &a.between) == (b.joint, &b.between) && close(a.slip, b.slip));
    let crushing = stored.crushing.len() == recomputed.crushing.len()
        && stored
            .crushing
            .iter()
            .zip(&recomputed.crushing)
            .all(|(a, b)| (a.joint, &a.between) == (b.joint, &b.between) && close(a.share, b.share));
    if !sliding || !crushing {
        wrong.push("sliding or crushing joints are not those of the motion".into());
    }
    wrong
}

fn same_line(a: &Option<Vec<Option<[f64; 2]>>>, b: &Option<Vec<Option<[f64; 2]>>>) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => {
            a.len() == b.len()
                && a.iter().zip(b).all(|pair| match pair {
                    (Some(p), Some(q)) => {
                        (Vec2::from(*p) - Vec2::from(*q)).norm() <= EQUAL * (1.0 + Vec2::from(*q).norm())
                    }
                    (None, None) => true,
                    _ => false,
                })
        }
        (None, None) => true,
        _ => false,
    }
}
