//! The entries of results.json: one for each case of the study and each direction.

use super::checks;
use super::conversion::{MovingBlock, Participation, displacement_capacity};
use super::push::{Push, made_id};
use super::request::Request;
use std::collections::BTreeMap;
use voussoir_core::limit::Status;
use voussoir_study::results::{CaseResult, KindEntries, PushDirection, SeismicEntry};
use voussoir_study::study::{Case, Study};

/// Returns `seismic` for results.json.
pub(super) fn entries(study: &Study, request: &Request, cases: &[CaseResult]) -> KindEntries {
    let mut entries = Vec::new();
    for base in (0..study.count()).filter_map(|id| study.case(id)) {
        let Some(push) = Push::of(&base) else { continue };
        let result = |id: usize| cases.iter().find(|result| result.label.id == id);
        for (opposite, made) in
            [(false, [base.id, made_id(study, base.id, 1)]), (true, [0, 2].map(|i| made_id(study, base.id, i)))]
        {
            let [limit, path] = made.map(result);
            entries.extend(limit.map(|limit| entry(request, &base, &push, opposite, limit, path)));
        }
    }
    KindEntries { seismic: Some(entries), ..KindEntries::default() }
}

/// Returns the proved load factor, or the proved lower bound of a case that is open.
fn proved_factor(result: &CaseResult) -> Option<f64> {
    let lower = || result.bounds.and_then(|[lower, _]| lower).filter(|_| result.status == Status::Open);
    result.collapse_load().or_else(lower).filter(|factor| factor.is_finite())
}

fn entry(
    request: &Request,
    base: &Case,
    push: &Push,
    opposite: bool,
    limit: &CaseResult,
    path: Option<&CaseResult>,
) -> SeismicEntry {
    let right = (push.acceleration > 0.0) != opposite;
    let per_factor = push.acceleration.abs() / push.gravity;
    let multiplier = proved_factor(limit).map(|factor| factor * per_factor);
    let participation = participation(base, limit);
    let confidence = request.confidence_factor;
    let oscillator = multiplier.zip(participation.as_ref()).map(|(multiplier, own)| {
        let unique = limit.mechanism.as_ref().and_then(|mechanism| mechanism.unique);
        own.oscillator(multiplier, push.gravity, confidence, unique)
    });
    let points = path.filter(|path| path.certificate.passed).and_then(|path| path.path.curve.as_ref());
    let multipliers =
        points.map(|points| points.iter().map(|[d, factor]| [*d, factor * per_factor]).collect::<Vec<_>>());
    let converted = multipliers.zip(participation.as_ref());
    let curve = converted.map_or(Vec::new(), |(points, own)| own.curve(&points, push.gravity, confidence));
    let capacity = displacement_capacity(&curve, request.ultimate_share());
    let mut all = oscillator.as_ref().map_or(Vec::new(), |own| checks::accelerations(request, own, push.gravity));
    all.extend(capacity.iter().flat_map(|own| checks::displacements(request, own)));
    SeismicEntry {
        variant: base.variant.clone(),
        parameters: base.parameters.clone(),
        direction: if right { PushDirection::Right } else { PushDirection::Left },
        case: limit.label.id,
        path_case: path.map(|path| path.label.id),
        activation_multiplier: multiplier,
        oscillator,
        capacity,
        checks: all,
        curve,
    }
}

/// Returns the participation of the masses in the mechanism of a result.
fn participation(base: &Case, limit: &CaseResult) -> Option<Participation> {
    let (motion, assembly) = (limit.proof.motion.as_ref()?, &base.assembly);
    let velocities: BTreeMap<&str, [f64; 3]> =
        motion.iter().map(|entry| (entry.body.as_str(), entry.velocity)).collect();
    let block = |index: usize| {
        let body = &assembly.bodies[index];
        let velocity = *velocities.get(body.name.as_str())?;
        let own = assembly.inertia(index);
        Some(MovingBlock { mass: own.mass, centroid: own.centroid.into(), velocity })
    };
    let free = (0..assembly.bodies.len()).filter(|index| !assembly.bodies[*index].fixed);
    Participation::of(&free.map(block).collect::<Option<Vec<_>>>()?, assembly.size())
}
