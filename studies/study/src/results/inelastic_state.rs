//! Entries for blocks whose material has yielded, and the crushing of mechanisms computed from them.

use super::entries::YieldedEntry;
use std::sync::Arc;
use voussoir_core::certificate::{Crushing, Mechanism};
use voussoir_core::elastic::InelasticState;
use voussoir_core::law::FacetMode;
use voussoir_core::model::Assembly;
use voussoir_core::path::{PathProblem, PathState, Yielded};

/// Equivalent plastic strain under compression above which a Gauss point counts as crushed: a tenth of the elastic
/// strain of stone with 10 MPa and 5 GPa, and far above rounding errors.
pub const CRUSHED: f64 = 2e-4;

/// The yielded blocks of a state.
pub fn entries(assembly: &Assembly, problem: &PathProblem, state: &PathState) -> Vec<YieldedEntry> {
    let mut out = Vec::new();
    for (index, body) in problem.bodies.iter().enumerate() {
        let (Some(inelastic), Some(own)) = (&body.inelastic, state.inelastic(index)) else { continue };
        let (size, memory) = (inelastic.state_size(), inelastic.memory_size());
        let initial = inelastic.initial().history;
        let points = (0..inelastic.gauss_points())
            .filter(|i| own.state.history[i * size..i * size + memory] != initial[i * size..i * size + memory])
            .map(|i| {
                let state = own.state.history[i * size..(i + 1) * size].to_vec();
                (i, own.state.equivalent[i], own.state.crushed[i], state)
            })
            .collect();
        out.push(YieldedEntry {
            body: assembly.bodies[body.members[0]].name.clone(),
            displacement: own.displacement.to_vec(),
            points,
            elements: inelastic.by_element(&own.state.equivalent),
        });
    }
    out
}

/// Reads the states of the entries, by body of the problem. Returns the reason if they do not fit the scene.
pub fn read(
    assembly: &Assembly,
    problem: &PathProblem,
    entries: &[YieldedEntry],
) -> Result<Vec<Option<Yielded>>, String> {
    let mut out: Vec<Option<Yielded>> = vec![None; problem.bodies.len()];
    for entry in entries {
        let body = assembly.body(&entry.body).ok_or(format!("yielded: no block \"{}\"", entry.body))?;
        let index = problem.body_of[body];
        let misfit = || {
            format!(
                "yielded: the entry of \"{}\" has another number of nodes or points than its mesh, or a number that is not finite",
                entry.body
            )
        };
        let inelastic = problem.bodies[index].inelastic.as_ref().ok_or_else(misfit)?;
        let mut state: InelasticState = inelastic.initial();
        let size = inelastic.state_size();
        let finite = entry.displacement.iter().all(|x| x.is_finite());
        if entry.displacement.len() != 2 * inelastic.nodes() || !finite || out[index].is_some() {
            return Err(misfit());
        }
        for (point, equivalent, crushed, own) in &entry.points {
            let numbers = own.iter().chain([equivalent, crushed]).all(|x| x.is_finite());
            if *point >= inelastic.gauss_points() || own.len() != size || !numbers {
                return Err(misfit());
            }
            state.history[point * size..(point + 1) * size].copy_from_slice(own);
            (state.equivalent[*point], state.crushed[*point]) = (*equivalent, *crushed);
        }
        state.yielded = true;
        if inelastic.by_element(&state.equivalent) != entry.elements {
            return Err(format!(
                "yielded: the values in elements of \"{}\" differ from those that its points give",
                entry.body
            ));
        }
        out[index] = Some(Yielded { displacement: Arc::new(entry.displacement.clone()), state: Arc::new(state) });
    }
    Ok(out)
}

/// Returns the joints next to which blocks have crushed, with the crushed share of the height. In the elements along
/// the joint, a row of Gauss points counts if one of its points has an equivalent plastic strain under compression
/// above [`CRUSHED`]. The block with the larger share is used.
pub fn crushing(assembly: &Assembly, problem: &PathProblem, yielded: &[Option<Yielded>]) -> Vec<Crushing> {
    let mut found = Vec::new();
    for (index, joint) in assembly.joints.iter().enumerate() {
        let mut share: f64 = 0.0;
        for block in [joint.minus, joint.plus] {
            let body = problem.body_of[block];
            let (Some(inelastic), Some(Some(own))) = (&problem.bodies[body].inelastic, yielded.get(body)) else {
                continue;
            };
            let rows = inelastic.rows_along(joint.ends[0], joint.ends[1]);
            let crushed = rows.iter().filter(|(_, points)| points.iter().any(|i| own.state.crushed[*i] > CRUSHED));
            share = share.max(crushed.map(|(length, _)| length).sum::<f64>() / joint.height());
        }
        if share > 0.0 {
            let between = [joint.minus, joint.plus].map(|body| assembly.bodies[body].name.clone());
            found.push(Crushing { joint: index, between, share: share.min(1.0) });
        }
    }
    found
}

/// Returns the mechanism of a path, with the joints next to which blocks have crushed. If blocks yield, their
/// deformation makes their rigid motions overlap. Such an overlap counts as crushing only if the law of the joint crushes.
pub fn with_crushing(
    mut mechanism: Mechanism,
    assembly: &Assembly,
    problem: &PathProblem,
    yielded: &[Option<Yielded>],
) -> Mechanism {
    if problem.yields() {
        mechanism.crushing.retain(|crushing| {
            let facets = assembly.law(&assembly.joints[crushing.joint]).and_then(|law| law.facets());
            facets.unwrap_or_default().iter().any(|facet| facet.mode == FacetMode::Crushing)
        });
    }
    mechanism.with_crushing(assembly, crushing(assembly, problem, yielded))
}
