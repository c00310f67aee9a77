//! Rigid blocks on supports that move: the motion of least potential energy, and its dual field.
//!
//! ```text
//! motions   min −w·q + Σ b_i γ_i     Eᵀ q + g_s + Dᵀ γ = 0,  γ ≥ 0
//! fields    max −r·g_s               E r + w = 0,  A r ≤ b
//! ```
//!
//! g_s are the openings and slips that the supports alone cause. With associated flow D = A. With the laws' own flow D
//! the field solves the program with D r ≤ b + (D − A) r̄, where r̄ are its own forces: a fixed point, found as in
//! `limit_sequential`. By complementary slackness the best motions have γ_i = 0 wherever the best field has slack. The
//! result is the mean of the motions with the greatest γ_i each: it is in the relative interior and as symmetric as the
//! scene. If the fields have no bound, no motion exists; the answer is the ray that proves it. Source: Iannuzzo et al.
//! 2018, Meccanica 53 (rigid blocks under settlements by least energy).

use super::nearest::nearest;
use super::systems::{LARGEST, PIVOTS, Pair, Systems};
use crate::limit::settings::SETTINGS;
use crate::linear::largest;
use crate::optimise::dense_simplex::{Dictionary, Equations, Feasibility};
use voussoir_core::law::FlowRule;
use voussoir_core::limit::{LimitProblem, SettlementAnswer, SparseRow, Velocity};
use voussoir_core::model::Wrenches;

/// Greatest number of linear programs of a sequence.
const MAX_PROGRAMS: usize = 60;
/// Number of first programs that start from the forces of the previous one; later programs move half of the way.
const FULL_STEPS: usize = 24;

/// Solves the settlement with this flow, or with the laws' own flow if no motion exists with associated flow.
pub fn settle(problem: &LimitProblem, loads: &Wrenches, openings: &[[f64; 3]], flow: FlowRule) -> SettlementAnswer {
    settled(problem, loads, openings, flow).unwrap_or_else(SettlementAnswer::Refused)
}

fn settled(
    problem: &LimitProblem,
    loads: &Wrenches,
    openings: &[[f64; 3]],
    flow: FlowRule,
) -> Result<SettlementAnswer, String> {
    if problem.joints.iter().any(|joint| joint.strength.block.is_some()) {
        return Err("settlements of rigid blocks take no joints that crush".into());
    }
    if problem.has_envelopes() {
        return Err("settlements of rigid blocks take one sliding facet in each sense".into());
    }
    if problem.magnitude(loads) == 0.0 {
        return Err("without loads nothing tells how rigid blocks follow their supports".into());
    }
    let loaded = LimitProblem { varying: loads.clone(), ..problem.clone() };
    let systems = Systems::new(&loaded, loads);
    if systems.entries() > LARGEST {
        return Err(format!("the scene is too large for settlements of rigid blocks ({} entries)", systems.entries()));
    }
    // Openings over the force variables, scaled by the greatest opening.
    let unit = openings.iter().flatten().fold(0.0, |a: f64, g| a.max(g.abs()));
    let mut driven = vec![0.0; systems.forces];
    for (opening, &(first, count)) in openings.iter().zip(&systems.variables.joints) {
        for k in 0..count {
            driven[first + k] = if unit > 0.0 { opening[k] / unit } else { 0.0 };
        }
    }
    let own = systems.pairs.iter().any(|pair| pair.non_associated());
    if (!own || flow == FlowRule::Associated)
        && let Some(force) = field(&systems, &driven)?
    {
        return follows(&systems, &driven, unit, &force, FlowRule::Associated);
    }
    if let Some(ray) = ray(&systems, &driven)? {
        return Ok(SettlementAnswer::Blocked(systems.variables.joint_forces(&ray, systems.force)));
    }
    if !own {
        return Err("rigid blocks neither follow their supports nor is it proved that they cannot".into());
    }
    let state = own_flow(&systems, &driven)
        .and_then(|force| follows(&fictitious(&systems, &force), &driven, unit, &force, FlowRule::NonAssociated));
    match state {
        // If no state with the laws' own flow is found, flow is associated; the answer reports it.
        Err(why) if flow == FlowRule::NonAssociated => {
            let force = field(&systems, &driven)?.ok_or(why)?;
            follows(&systems, &driven, unit, &force, FlowRule::Associated)
        }
        state => state,
    }
}

/// Returns the answer with this field; at its yield points `systems` have associated flow.
fn follows(
    systems: &Systems,
    driven: &[f64],
    unit: f64,
    force: &[f64],
    flow: FlowRule,
) -> Result<SettlementAnswer, String> {
    let tight = tight(systems, force);
    let (multipliers, unique) = multipliers(systems, driven, &tight)?;
    let motion = motion(systems, driven, &tight, &multipliers)?;
    let length = systems.length;
    let of = |q: &[f64]| -> Velocity { [q[0] * unit, q[1] * unit, q[2] * unit / length] };
    Ok(SettlementAnswer::Follows {
        field: systems.variables.joint_forces(force, systems.force),
        motion: motion.chunks_exact(3).map(of).collect(),
        // Unique among the motions of this field; other fields may have others.
        unique: unique.filter(|unique| flow == FlowRule::Associated || !unique),
        flow,
    })
}

/// Makes non-associated pairs associated, through the yield point at the forces of `reference`: d·r ≤ b + (d − a)·r̄.
fn fictitious(systems: &Systems, reference: &[f64]) -> Systems {
    let mut replaced = systems.clone();
    for pair in replaced.pairs.iter_mut().filter(|pair| pair.non_associated()) {
        pair.bound += relief(pair, reference).max(0.0);
        pair.normal.clone_from(&pair.flow);
    }
    replaced
}

/// Returns (d − a)·r.
fn relief(pair: &Pair, force: &[f64]) -> f64 {
    let along = |row: &[(usize, f64)]| -> f64 { row.iter().map(|&(j, v)| v * force[j]).sum() };
    along(&pair.flow) - along(&pair.normal)
}

/// Returns a field that solves the program with its own fictitious cohesion: it is admissible, and on the yield surface
/// where blocks slide.
fn own_flow(systems: &Systems, driven: &[f64]) -> Result<Vec<f64>, String> {
    let start = field(systems, &vec![0.0; systems.forces])?.ok_or("no field carries the loads")?;
    let mut reference = start.clone();
    let mut change = f64::INFINITY;
    for step in 0..MAX_PROGRAMS {
        let program = fictitious(systems, &reference);
        let Ok(Some(force)) = field(&program, driven) else {
            // The forces violate the strengths too far: the next program has no field that carries the loads.
            reference.iter_mut().zip(&start).for_each(|(old, own)| *old += 0.5 * (own - *old));
            continue;
        };
        let size = largest(&force).max(f64::MIN_POSITIVE);
        let moved = |pair: &Pair| (relief(pair, &force) - relief(pair, &reference)).abs();
        change = systems.pairs.iter().map(moved).fold(0.0, f64::max) / size;
        if change <= SETTINGS.balanced {
            return Ok(force);
        }
        if change <= SETTINGS.close_forces
            && let Some(force) = onto_yield(systems, &program, &force)
        {
            return Ok(force);
        }
        let share = if step < FULL_STEPS { 1.0 } else { 0.5 };
        reference.iter_mut().zip(&force).for_each(|(old, new)| *old += share * (new - *old));
    }
    Err(format!(
        "no associated flow lets rigid blocks follow their supports, and {MAX_PROGRAMS} linear programs with the laws' own flow did \
         not converge: forces still change by {change:.1e}. Such blocks may jam, with forces as great as joints are stiff: give \
         joints a stiffness, and a path follows them"
    ))
}

/// Corrects a field near its fixed point: the tight pairs of its program move onto the yield surface itself.
fn onto_yield(systems: &Systems, program: &Systems, force: &[f64]) -> Option<Vec<f64>> {
    let tight = tight(program, force);
    let yields = tight.iter().map(|&i| (&systems.pairs[i].normal, systems.pairs[i].bound));
    let moved = nearest_to(force.to_vec(), balance(systems).chain(yields), "forces").ok()?;
    let least = -SETTINGS.balanced * largest(&moved).max(f64::MIN_POSITIVE);
    (0..systems.pairs.len()).all(|i| systems.slack(i, &moved) >= least).then_some(moved)
}

/// Returns the field of most work of the supports against the blocks, in units of force; `None` without a bound.
fn field(systems: &Systems, driven: &[f64]) -> Result<Option<Vec<f64>>, String> {
    let (free, pairs) = (systems.forces, systems.pairs.len());
    // s_i of all pairs, then the two parts of r·g_s.
    let variables = pairs + 2;
    let (mut rows, mut right) = (Vec::new(), Vec::new());
    let mut equation = |entries: &[(usize, f64)], slack: &[(usize, f64)], value: f64| {
        let mut row = vec![0.0; free + variables];
        entries.iter().for_each(|&(j, v)| row[j] += v);
        slack.iter().for_each(|&(j, v)| row[free + j] += v);
        rows.push(row);
        right.push(value);
    };
    for (entries, load) in systems.equilibrium.iter().zip(&systems.fixed) {
        equation(entries, &[], -load);
    }
    for (i, pair) in systems.pairs.iter().enumerate() {
        equation(&pair.normal, &[(i, 1.0)], pair.bound);
    }
    let work: Vec<(usize, f64)> = driven.iter().copied().enumerate().filter(|(_, g)| *g != 0.0).collect();
    equation(&work, &[(pairs, -1.0), (pairs + 1, 1.0)], 0.0);
    let mut program = Equations { free, variables, rows, right }.dictionary().ok_or("the equations of statics fail")?;
    if program.feasible() != Feasibility::Point {
        return Err("the loads before the supports move have no admissible field".into());
    }
    let Some((least, finished)) = program.minimise(&[(pairs, 1.0), (pairs + 1, -1.0)], PIVOTS) else {
        return Ok(None);
    };
    if !finished {
        return Err("the program of the field took too many pivots".into());
    }
    // The forces for these slacks and this work.
    let yields =
        systems.pairs.iter().enumerate().map(|(i, pair)| (&pair.normal, pair.bound - program.value(i).max(0.0)));
    nearest_to(vec![0.0; free], balance(systems).chain(yields).chain([(&work, least)]), "forces").map(Some)
}

/// Returns balanced forces without loads, the greatest force one, that prove that no motion fits the supports (Farkas'
/// lemma): E r = 0, D r ≤ 0, r·g_s < 0. They do no positive work on any flow d of the joints and negative work on the
/// gaps of the supports. The flow is the laws' own: with non-associated friction blocks have more motions.
fn ray(systems: &Systems, driven: &[f64]) -> Result<Option<Vec<f64>>, String> {
    let (free, pairs) = (systems.forces, systems.pairs.len());
    let row = |entries: &[(usize, f64)], slack: Option<usize>| {
        let mut row = vec![0.0; free + pairs];
        entries.iter().for_each(|&(j, v)| row[j] += v);
        slack.into_iter().for_each(|i| row[free + i] = 1.0);
        row
    };
    let work: Vec<(usize, f64)> = driven.iter().copied().enumerate().filter(|(_, g)| *g != 0.0).collect();
    let balance = systems.equilibrium.iter().map(|entries| row(entries, None));
    let flows = systems.pairs.iter().enumerate().map(|(i, pair)| row(&pair.flow, Some(i)));
    let rows: Vec<Vec<f64>> = balance.chain(flows).chain([row(&work, None)]).collect();
    let mut right = vec![0.0; rows.len()];
    right[rows.len() - 1] = -1.0;
    let Some(mut program) = (Equations { free, variables: pairs, rows, right }).dictionary() else { return Ok(None) };
    if program.feasible() != Feasibility::Point {
        return Ok(None);
    }
    // The least sum of slacks selects one vertex with few forces.
    let slacks: Vec<(usize, f64)> = (0..pairs).map(|i| (i, 1.0)).collect();
    program.minimise(&slacks, PIVOTS);
    let flows = systems.pairs.iter().enumerate().map(|(i, pair)| (&pair.flow, -program.value(i).max(0.0)));
    let balance = systems.equilibrium.iter().map(|entries| (entries, 0.0));
    let mut ray = nearest_to(vec![0.0; free], balance.chain(flows).chain([(&work, -1.0)]), "ray")?;
    let greatest = largest(&ray).max(f64::MIN_POSITIVE);
    ray.iter_mut().for_each(|r| *r /= greatest);
    Ok(Some(ray))
}

/// Returns the rows of equilibrium with their right-hand sides.
fn balance(systems: &Systems) -> impl Iterator<Item = (&SparseRow, f64)> {
    systems.equilibrium.iter().zip(systems.fixed.iter().map(|w| -w))
}

/// Returns the solution of the equations, given as rows with their right-hand sides, that is nearest to `start`.
fn nearest_to<'a>(
    start: Vec<f64>,
    equations: impl Iterator<Item = (&'a SparseRow, f64)>,
    what: &str,
) -> Result<Vec<f64>, String> {
    if start.is_empty() {
        return Ok(start);
    }
    let (rows, right): (Vec<SparseRow>, Vec<f64>) = equations.map(|(row, value)| (row.clone(), value)).unzip();
    let (x, left) =
        nearest(&rows, &right, start).ok_or_else(|| format!("no factorisation gives the {what} of the settlement"))?;
    if left > SETTINGS.active * largest(&right).max(f64::MIN_POSITIVE) {
        return Err(format!("the {what} of the settlement leave {left:.1e} of their equations"));
    }
    Ok(x)
}

/// Returns the pairs without slack.
fn tight(systems: &Systems, force: &[f64]) -> Vec<usize> {
    let least = SETTINGS.active * largest(force);
    (0..systems.pairs.len()).filter(|i| systems.slack(*i, force) <= least).collect()
}

/// Returns γ of the tight pairs, in the relative interior of all solutions, and true if the solution is unique.
fn multipliers(systems: &Systems, driven: &[f64], tight: &[usize]) -> Result<(Vec<f64>, Option<bool>), String> {
    let (free, variables) = (systems.equilibrium.len(), tight.len());
    let mut rows = vec![vec![0.0; free + variables]; systems.forces];
    for (i, entries) in systems.equilibrium.iter().enumerate() {
        entries.iter().for_each(|&(j, v)| rows[j][i] += v);
    }
    for (k, &i) in tight.iter().enumerate() {
        systems.pairs[i].normal.iter().for_each(|&(j, v)| rows[j][free + k] += v);
    }
    let right = driven.iter().map(|g| -g).collect();
    let none = "no motion of the rigid blocks fits the field of the settlement";
    let mut program: Dictionary = Equations { free, variables, rows, right }.dictionary().ok_or(none)?;
    if program.feasible() != Feasibility::Point {
        return Err(none.into());
    }
    let point = |program: &Dictionary| -> Vec<f64> { (0..variables).map(|k| program.value(k).max(0.0)).collect() };
    let mut found = vec![point(&program)];
    let mut bounded = true;
    for k in 0..variables {
        match program.minimise(&[(k, -1.0)], PIVOTS) {
            Some((_, true)) => {
                let other = point(&program);
                let size = other.iter().fold(0.0, |a: f64, v| a.max(*v));
                let same = |v: &Vec<f64>| v.iter().zip(&other).all(|(a, b)| (a - b).abs() <= SETTINGS.apart * size);
                if !found.iter().any(same) {
                    found.push(other);
                }
            }
            _ => bounded = false,
        }
    }
    let mean = (0..variables).map(|k| found.iter().map(|v| v[k]).sum::<f64>() / found.len() as f64).collect();
    Ok((mean, Some(bounded && found.len() == 1)))
}

/// Returns q with Eᵀ q = −g_s − Dᵀ γ.
fn motion(systems: &Systems, driven: &[f64], tight: &[usize], multipliers: &[f64]) -> Result<Vec<f64>, String> {
    let mut rows: Vec<SparseRow> = vec![Vec::new(); systems.forces];
    for (i, entries) in systems.equilibrium.iter().enumerate() {
        entries.iter().for_each(|&(j, v)| rows[j].push((i, v)));
    }
    let mut right: Vec<f64> = driven.iter().map(|g| -g).collect();
    for (&i, gamma) in tight.iter().zip(multipliers) {
        systems.pairs[i].normal.iter().for_each(|&(j, v)| right[j] -= gamma * v);
    }
    nearest_to(vec![0.0; systems.equilibrium.len()], rows.iter().zip(right), "motion")
}
