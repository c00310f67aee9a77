//! Limit points of structures whose laws have a history: the check that no rate of one loading set raises the load.
//!
//! Just beyond a state in the direction of a rate, the updates of all such laws give tangents: ṙ = A T ġ for a
//! response, a flexibility for a block that yields. With the modes of all other contact points they form a linear rate
//! problem. A linear functional c is positive if the set loads: points that soften continue to soften, and yielding
//! dissipates. Multipliers then prove c·x = −λ̇/μ with μ ≥ 0 for all rates x of the set: if c·x ≥ 0, no rate rises.
//! Another loading set may have a rising rate. The set must dissipate: pure unloading proves nothing. If all laws have
//! the same tangents on both sides, there is no other set, and λ̇ = 0.
//!
//! The multipliers are the solution of one linear system. They are checked like the multipliers of a witness.

use super::chain::{Link, PathChain, deformation, greatest_force};
use super::claims::length;
use super::none_rises::{Products, RateProblem, Refuted};
use super::point_modes::{ModeCone, dot};
use super::rate_equations::{Column, RateEquations};
use crate::law::Facet;
use crate::linear::{Entries, SparseLu};
use crate::path::{FarkasVector, LawStep, PathProblem, PathRate, PathState, PointMode, RateClaim, Responses, Witness};
use nalgebra::DMatrix;
use std::sync::Arc;

/// Distance from the state at which updates are evaluated, as a share of the greatest gap or displacement.
const AHEAD: f64 = 1e-6;
/// Relative difference below which two tangents belong to one branch of a law.
const SAME_BRANCH: f64 = 1e-3;
/// Number of loading sets that are tried; each is found with the rate of the last.
const SETS: usize = 4;
/// Least dissipation of a set that loads, relative to the work of contact forces.
const DISSIPATES: f64 = 1e-6;
/// Share of their terms below which sums count as rounding errors.
const NOISE: f64 = 1e-12;
/// Iterations for the nodes of a block that yields.
const ITERATIONS: usize = 6;
/// Steps of refinement of linear systems.
const REFINEMENTS: usize = 3;

/// A 2 × 2 matrix, row by row.
type Matrix = [[f64; 2]; 2];

/// A linearised block that yields.
struct Block {
    /// Displacements of its points per force on them \[m/N\].
    flexibility: Arc<DMatrix<f64>>,
    /// Gradient of its plastic work with respect to these forces \[m\]; empty if it does not yield.
    power: Vec<f64>,
    /// Energy dissipated between the state and the linearisation \[J\].
    dissipated: f64,
}

/// The linear rate problem of a loading set.
struct LoadingSet {
    /// A T of each contact point with a response.
    tangents: Vec<Option<Matrix>>,
    /// The structure with the flexibilities of its blocks.
    structure: Arc<PathProblem>,
    /// Coefficients of c for rates of force and of gap of each contact point, and for λ̇.
    forces: Vec<[f64; 2]>,
    gaps: Vec<[f64; 2]>,
    factor: f64,
    /// False if nothing softens or yields: c then has no sign.
    loads: bool,
    equations: RateEquations,
    /// The mode of each contact point that has facets or is bonded.
    modes: Vec<Option<ModeCone>>,
}

/// A scaled linear system.
struct System {
    entries: Entries,
    /// Factors of the rows.
    scales: Vec<f64>,
    /// Coefficients of ġ for the scaled unknowns.
    gaps: Vec<Vec<(usize, f64)>>,
}

fn product(matrix: Matrix, v: [f64; 2]) -> [f64; 2] {
    matrix.map(|row| dot(row, v))
}

fn transposed(m: Matrix) -> Matrix {
    [[m[0][0], m[1][0]], [m[0][1], m[1][1]]]
}

/// Returns the size of the greatest entry.
fn size(matrix: Matrix) -> f64 {
    matrix.as_flattened().iter().fold(0.0, |a: f64, x| a.max(x.abs()))
}

fn same(a: Matrix, b: Matrix) -> bool {
    let difference = [0, 1].map(|i| [a[i][0] - b[i][0], a[i][1] - b[i][1]]);
    size(difference) <= SAME_BRANCH * size(a).max(size(b))
}

/// Returns the direction in which a law leaves the branch of the opposite direction: its tangents differ by m ⊗ n.
fn loading_direction(ahead: Matrix, behind: Matrix, along: [f64; 2]) -> Option<[f64; 2]> {
    if same(ahead, behind) {
        return None;
    }
    let rows = [0, 1].map(|i| [ahead[i][0] - behind[i][0], ahead[i][1] - behind[i][1]]);
    let row = if length(rows[0]) >= length(rows[1]) { rows[0] } else { rows[1] };
    let sense = dot(row, along).signum() / length(row);
    Some(row.map(|x| x * sense))
}

impl PathChain {
    /// Checks that no rate of one loading set raises the load at a state. A witness at the state gives the rate just beyond it.
    ///
    /// # Errors
    /// Names the first part of the last witness that is wrong.
    pub fn check_loading_set(&self, state: &PathState, witnesses: &[&Witness]) -> Result<(), String> {
        let link =
            self.links.iter().rev().find(|link| link.state.is_same(state)).ok_or("the state is not on the path")?;
        let mut found = Err("no rate just beyond the state".to_string());
        for witness in witnesses.iter().filter(|witness| witness.state.is_same(state)) {
            if let RateClaim::Rate(rate) = &witness.claim {
                found = self.check_beyond(link, rate);
            }
            if found.is_ok() {
                break;
            }
        }
        found
    }

    /// Checks the loading set of a rate; if it is not consistent, checks the set of the resulting rate.
    fn check_beyond(&self, link: &Link, rate: &PathRate) -> Result<(), String> {
        let contacts = self.structure.contacts.len();
        if rate.force.len() != contacts
            || rate.gap.len() != contacts
            || rate.motion.len() != self.structure.bodies.len()
        {
            return Err("a malformed rate".into());
        }
        let numbers = rate.force.iter().chain(&rate.gap).flatten().chain(rate.motion.as_flattened());
        if !numbers.chain([&rate.factor]).all(|number| number.is_finite()) {
            return Err("a malformed rate".into());
        }
        let mut rate = rate.clone();
        for _ in 0..SETS {
            rate = self.scaled(&link.state, &rate);
            let set = self.loading_set(link, &rate)?;
            let (next, vector, behind) = set.solve(&link.state)?;
            if self.is_consistent(link, &set, &next)? {
                return set.check(&vector, behind);
            }
            rate = next;
        }
        Err("the rate just after the state violates the loading conditions of the laws".into())
    }

    /// Returns a rate in the same direction, scaled to the size of the motion of the state.
    fn scaled(&self, state: &PathState, rate: &PathRate) -> PathRate {
        let moves = rate.motion.iter().flat_map(|v| [v[0], v[1], v[2] * self.structure.length]);
        let fastest = rate.gap.as_flattened().iter().copied().chain(moves).fold(0.0, |a: f64, v| a.max(v.abs()));
        let by = deformation(state) / fastest;
        let of = |pairs: &[[f64; 2]]| pairs.iter().map(|own| own.map(|v| v * by)).collect();
        PathRate {
            factor: rate.factor * by,
            force: of(&rate.force),
            gap: of(&rate.gap),
            motion: rate.motion.iter().map(|own| own.map(|v| v * by)).collect(),
        }
    }

    /// Returns the tangents A T of responses at a share of a rate from a state, and the energy that they dissipate
    /// \[J\].
    fn tangents(&self, link: &Link, rate: &PathRate, share: f64) -> Result<(Vec<Option<Matrix>>, f64), String> {
        let gap = |(gap, rate): (&[f64; 2], &[f64; 2])| [0, 1].map(|k| gap[k] + share * rate[k]);
        let gaps: Vec<[f64; 2]> = link.state.gap.iter().zip(&rate.gap).map(gap).collect();
        let responses = Responses::new(&self.structure);
        let step = LawStep::from(&self.structure, &link.state);
        let (points, _) = responses.update(&gaps, &link.history.memory, &step)?;
        let (mut tangents, mut dissipated) = (vec![None; points.len()], 0.0);
        for contact in responses.points() {
            let (area, point) = (self.structure.contacts[contact].area, &points[contact]);
            dissipated += area * point.dissipated;
            tangents[contact] = Some(point.tangent.map(|row| row.map(|t| area * t)));
        }
        Ok((tangents, dissipated))
    }

    /// Returns the yielding blocks, linearised at a share of a rate from a state.
    fn blocks(&self, link: &Link, rate: &PathRate, share: f64) -> Result<Vec<Option<Block>>, String> {
        let problem = &*self.structure;
        if !problem.yields() {
            return Ok(problem.bodies.iter().map(|_| None).collect());
        }
        if self.finite {
            return Err("rates of blocks that yield are checked with small displacements only".into());
        }
        let state = &link.state;
        let force = state.force.iter().zip(&rate.force).map(|(r, v)| [0, 1].map(|k| r[k] + share * v[k])).collect();
        let factor = state.factor + share * rate.factor;
        let ahead = PathState { force, factor, yielded: Vec::new(), ..state.clone() };
        let [now, ahead] = [state, &ahead].map(|state| problem.forces_on_points(state, false));
        let flat =
            |forces: &[crate::model::geometry::Vec2]| -> Vec<f64> { forces.iter().flat_map(|f| [f.x, f.y]).collect() };
        let of = |(index, body): (usize, &crate::path::PathBody)| {
            let Some(inelastic) = &body.inelastic else { return Ok(None) };
            let (displacement, end) = match state.inelastic(index) {
                Some(own) => (own.displacement.to_vec(), own.state.clone()),
                None => {
                    let (displacement, state) = inelastic.elastic_state(&flat(&now[index]));
                    (displacement, Arc::new(state))
                }
            };
            let forces = flat(&ahead[index]);
            let mut linear = inelastic.linearise(displacement, &end)?;
            for _ in 0..ITERATIONS {
                linear = inelastic.linearise(inelastic.displaced(&linear, &forces), &end)?;
            }
            let power = if linear.yielding > 0 { inelastic.dissipation_by_force(&linear, &end)? } else { Vec::new() };
            let dissipated = linear.end.dissipated - end.dissipated;
            Ok(Some(Block { flexibility: linear.flexibility, power, dissipated }))
        };
        problem.bodies.iter().enumerate().map(of).collect()
    }

    /// Returns the loading set of a rate.
    fn loading_set(&self, link: &Link, rate: &PathRate) -> Result<LoadingSet, String> {
        let (tangents, mut dissipated) = self.tangents(link, rate, AHEAD)?;
        let (behind, _) = self.tangents(link, rate, -AHEAD)?;
        let blocks = self.blocks(link, rate, AHEAD)?;
        let mut structure = (*self.structure).clone();
        for (body, block) in structure.bodies.iter_mut().zip(&blocks) {
            if let Some(Block { flexibility, dissipated: own, .. }) = block {
                body.flexibility = Some(flexibility.clone());
                dissipated += own;
            }
        }
        let contacts = structure.contacts.len();
        let equations = RateEquations::new(&structure, &link.state, self.finite);
        let (mut forces, mut gaps, mut factor) = (vec![[0.0; 2]; contacts], vec![[0.0; 2]; contacts], 0.0);
        for (index, gap) in gaps.iter_mut().enumerate() {
            let (Some(ahead), Some(behind)) = (tangents[index], behind[index]) else { continue };
            *gap = loading_direction(ahead, behind, rate.gap[index]).unwrap_or_default();
        }
        let of_gaps: f64 = gaps.iter().zip(&rate.gap).map(|(n, g)| dot(*n, *g)).sum();
        gaps.iter_mut().flatten().for_each(|n| *n /= if of_gaps > 0.0 { of_gaps } else { 1.0 });
        let yields = plastic_power(&structure, &link.state, &blocks, &mut forces, &mut factor);
        let power: f64 = forces.iter().zip(&rate.force).map(|(w, r)| dot(*w, *r)).sum::<f64>() + factor * rate.factor;
        let by = if yields && power > 0.0 { power } else { f64::INFINITY };
        forces.iter_mut().flatten().chain([&mut factor]).for_each(|w| *w /= by);
        let loads = of_gaps > 0.0 || by.is_finite();
        let work = link.state.force.iter().zip(&rate.gap).map(|(r, g)| (AHEAD * dot(*r, *g)).abs()).sum::<f64>();
        if loads && dissipated <= DISSIPATES * work {
            return Err("the rate just beyond the state may only unload".into());
        }
        if !loads {
            let square: f64 = rate.gap.iter().map(|g| dot(*g, *g)).sum();
            gaps = rate.gap.iter().map(|g| g.map(|x| x / square)).collect();
        }
        let modes = self.modes(&link.state, &link.openings);
        let modes = modes.into_iter().enumerate().map(|(index, own)| nearest_mode(own, rate, index)).collect();
        Ok(LoadingSet { tangents, structure: Arc::new(structure), forces, gaps, factor, loads, equations, modes })
    }

    /// Returns true if the rate of a loading set loads in the same way: its laws have the same tangents, and no mode is
    /// left.
    fn is_consistent(&self, link: &Link, set: &LoadingSet, rate: &PathRate) -> Result<bool, String> {
        let rate = &self.scaled(&link.state, rate);
        let (laws, _) = self.tangents(link, rate, AHEAD)?;
        let both = |(a, b): (&Option<Matrix>, &Option<Matrix>)| a.zip(*b).is_none_or(|(a, b)| same(a, b));
        let blocks = self.blocks(link, rate, AHEAD)?;
        let body = |(block, body): (&Option<Block>, &crate::path::PathBody)| {
            let (Some(block), Some(own)) = (block, &body.flexibility) else { return true };
            (&*block.flexibility - &**own).amax() <= SAME_BRANCH * own.amax()
        };
        let sizes = [&rate.force, &rate.gap].map(|v| v.iter().map(|x| length(*x)).fold(0.0, f64::max));
        let inside = |(index, mode): (usize, &Option<ModeCone>)| {
            let Some(mode) = mode else { return true };
            let distances = mode.distances(rate.force[index], rate.gap[index]);
            (0..2).all(|i| distances[i] <= super::rate_check::RATE * sizes[i])
        };
        Ok(set.tangents.iter().zip(&laws).all(both)
            && blocks.iter().zip(&set.structure.bodies).all(body)
            && set.modes.iter().enumerate().all(inside))
    }
}

/// Adds the gradient of the plastic work of all blocks with respect to contact forces and λ. Returns true if a block
/// yields.
fn plastic_power(
    problem: &PathProblem,
    state: &PathState,
    blocks: &[Option<Block>],
    forces: &mut [[f64; 2]],
    factor: &mut f64,
) -> bool {
    let at = |body: usize, slot: Option<usize>| {
        let power = blocks[body].as_ref().map(|block| &block.power).filter(|power| !power.is_empty())?;
        slot.map(|slot| crate::model::geometry::Vec2::new(power[2 * slot], power[2 * slot + 1]))
    };
    for (force, contact) in forces.iter_mut().zip(&problem.contacts) {
        for (side, sign) in [(contact.minus, -1.0), (contact.plus, 1.0)] {
            let Some(power) = at(side.body, side.slot) else { continue };
            force[0] += sign * power.dot(&contact.normal);
            force[1] += sign * power.dot(&contact.tangent);
        }
    }
    for (body, slot, _, load) in &problem.load_steps[state.load_step].loading.forces {
        *factor += at(*body, *slot).map_or(0.0, |power| power.dot(load));
    }
    blocks.iter().flatten().any(|block| !block.power.is_empty())
}

/// Returns the mode that is nearest to a rate. `None` for responses.
fn nearest_mode(modes: Vec<ModeCone>, rate: &PathRate, index: usize) -> Option<ModeCone> {
    let sizes = [&rate.force, &rate.gap].map(|v| v.iter().map(|x| length(*x)).fold(f64::MIN_POSITIVE, f64::max));
    let off = |cone: &ModeCone| {
        let distances = cone.distances(rate.force[index], rate.gap[index]);
        (distances[0] / sizes[0]).max(distances[1] / sizes[1])
    };
    modes.into_iter().min_by(|a, b| off(a).total_cmp(&off(b)))
}

/// Returns the two equations of a contact point in a mode: coefficients of ṙ and of ġ in each.
fn rows(facets: &[Facet], mode: PointMode) -> [[[f64; 2]; 2]; 2] {
    match mode {
        PointMode::Stick => [[[0.0; 2], [1.0, 0.0]], [[0.0; 2], [0.0, 1.0]]],
        PointMode::Facet(f) => {
            let d = facets[f].flow;
            [[facets[f].normal, [0.0; 2]], [[0.0; 2], [d[1], -d[0]]]]
        }
        PointMode::Vertex | PointMode::Open => [[[1.0, 0.0], [0.0; 2]], [[0.0, 1.0], [0.0; 2]]],
    }
}

impl LoadingSet {
    /// Returns the two equations of a contact point.
    fn rows_of(&self, index: usize) -> [[[f64; 2]; 2]; 2] {
        match (&self.tangents[index], &self.modes[index]) {
            (Some(k), _) => [[[1.0, 0.0], k[0].map(|x| -x)], [[0.0, 1.0], k[1].map(|x| -x)]],
            (None, Some(cone)) => rows(self.structure.contacts[index].law.facets().unwrap_or_default(), cone.mode),
            (None, None) => rows(&[], PointMode::Stick),
        }
    }

    /// Returns the columns of the unknowns ṙ, q̇ of free bodies and λ̇ with their units, for given sizes of forces and
    /// motions.
    fn columns(&self, free: &[usize], [force, moved]: [f64; 2]) -> Vec<(&Column, f64)> {
        let equations = &self.equations;
        let most = equations.load.equilibrium.iter().map(|(row, p)| (p / self.turn(*row)).abs()).fold(0.0, f64::max);
        let load = if most > 0.0 { force / most } else { 1.0 };
        let forces = equations.forces.iter().map(|column| (column, force));
        let motions = free.iter().map(|i| (&equations.motions[*i], moved / self.turn(*i)));
        forces.chain(motions).chain([(&equations.load, load)]).collect()
    }

    /// Returns the unit of a row or column of a motion: moments and rotations have a length.
    fn turn(&self, index: usize) -> f64 {
        if index % 3 == 2 { self.equations.length } else { 1.0 }
    }

    /// Returns the matrix (equations of contact points, equilibrium, and c) with the scales of its rows, and ġ in the
    /// unknowns.
    fn matrix(&self, free: &[usize], columns: &[(&Column, f64)], [force, moved]: [f64; 2]) -> System {
        let (contacts, bodies, size) = (self.gaps.len(), self.equations.held.len(), columns.len());
        let mut gaps: Vec<Vec<(usize, f64)>> = vec![Vec::new(); 2 * contacts];
        let mut balance: Vec<Vec<(usize, f64)>> = vec![Vec::new(); 3 * bodies];
        for (j, (column, unit)) in columns.iter().enumerate() {
            column.gap.iter().for_each(|(row, value)| gaps[*row].push((j, value * unit)));
            column.equilibrium.iter().for_each(|(row, value)| balance[*row].push((j, value * unit)));
        }
        let (mut entries, mut scales): (Entries, Vec<f64>) = (Vec::new(), vec![1.0; size]);
        for index in 0..contacts {
            for (k, [by_force, by_gap]) in self.rows_of(index).into_iter().enumerate() {
                let row = 2 * index + k;
                scales[row] = 1.0 / (length(by_force) * force + length(by_gap) * moved);
                let own = (0..2).map(|t| (2 * index + t, by_force[t] * force));
                let seen = (0..2).flat_map(|t| gaps[2 * index + t].iter().map(move |(j, v)| (*j, by_gap[t] * v)));
                entries.extend(own.chain(seen).map(|(j, v)| (row, j, v * scales[row])));
            }
            for t in 0..2 {
                entries.push((size - 1, 2 * index + t, self.forces[index][t] * force));
                entries.extend(gaps[2 * index + t].iter().map(|(j, v)| (size - 1, *j, self.gaps[index][t] * v)));
            }
        }
        for (at, i) in free.iter().enumerate() {
            let row = 2 * contacts + at;
            scales[row] = 1.0 / (force * self.turn(*i));
            entries.extend(balance[*i].iter().map(|(j, v)| (row, *j, v * scales[row])));
        }
        entries.push((size - 1, size - 1, self.factor * columns[size - 1].1));
        entries.retain(|entry| entry.2 != 0.0);
        System { entries, scales, gaps }
    }

    /// Returns the rate with c·x = 1, the multipliers, and κ with λ̇ = κ c·x in the sense of the load step.
    fn solve(&self, state: &PathState) -> Result<(PathRate, FarkasVector, f64), String> {
        let (equations, contacts) = (&self.equations, self.gaps.len());
        let free: Vec<usize> = (0..equations.motions.len()).filter(|i| !equations.held[i / 3]).collect();
        let sizes = [greatest_force(state), deformation(state)];
        let columns = self.columns(&free, sizes);
        let System { entries, scales, gaps } = self.matrix(&free, &columns, sizes);
        let (size, load) = (columns.len(), columns[columns.len() - 1].1);
        let solved = |entries: &Entries, last: f64| {
            let right = (0..size).map(|i| if i + 1 == size { last } else { 0.0 }).collect();
            SparseLu::new(size, entries)?.solve(&[right], REFINEMENTS)?.pop()
        };
        let transposed: Entries = entries.iter().map(|(i, j, v)| (*j, *i, *v)).collect();
        let singular = "the rate of the loading set is not unique";
        let x = solved(&entries, 1.0).ok_or(singular)?;
        let z = solved(&transposed, load * equations.sense).ok_or(singular)?;
        let factor = x[size - 1] * load;
        let mut rate = PathRate {
            factor,
            force: x[..2 * contacts].chunks_exact(2).map(|r| [r[0] * sizes[0], r[1] * sizes[0]]).collect(),
            gap: vec![[0.0; 2]; contacts],
            motion: equations.settlements.iter().map(|u| u.map(|u| u * factor)).collect(),
        };
        for (at, i) in free.iter().enumerate() {
            rate.motion[i / 3][i % 3] = x[2 * contacts + at] * sizes[1] / self.turn(*i);
        }
        for (row, own) in gaps.iter().enumerate() {
            rate.gap[row / 2][row % 2] = own.iter().map(|(j, v)| v * x[*j]).sum();
        }
        Ok((rate, self.multipliers(&z, &scales, &free), z[size - 1]))
    }

    /// Returns the multipliers of equilibrium and kinematics with the opposite sign, from the multipliers of all rows.
    fn multipliers(&self, z: &[f64], scales: &[f64], free: &[usize]) -> FarkasVector {
        let (contacts, last) = (self.gaps.len(), z.len() - 1);
        let mut vector = FarkasVector {
            equilibrium: vec![[0.0; 3]; self.equations.held.len()],
            gap: vec![[0.0; 2]; contacts],
            work: 0.0,
        };
        for index in 0..contacts {
            let of_rows = self.rows_of(index);
            vector.gap[index] = [0, 1].map(|t| {
                let own = |k: usize| z[2 * index + k] * scales[2 * index + k] * of_rows[k][1][t];
                let terms = [own(0), own(1), z[last] * self.gaps[index][t]];
                let sum: f64 = terms.iter().sum();
                let rounding = NOISE * terms.iter().map(|term| term.abs()).sum::<f64>();
                if sum.abs() > rounding { -sum } else { 0.0 }
            });
        }
        for (at, i) in free.iter().enumerate() {
            let row = 2 * contacts + at;
            vector.equilibrium[i / 3][i % 3] = -z[row] * scales[row];
        }
        vector
    }

    /// Checks the multipliers: with κ = `behind`, α·ṙ + β·ġ + κ c·x ≥ 0 in all modes of the set, and the factor of λ̇
    /// is negative.
    fn check(&self, vector: &FarkasVector, behind: f64) -> Result<(), String> {
        // If the set does not load, c has either sign, and the load is constant.
        let kept = if self.loads { behind.min(0.0) } else { 0.0 };
        let modes: Vec<Vec<ModeCone>> = self.modes.iter().map(|mode| mode.iter().cloned().collect()).collect();
        let problem = RateProblem { equations: &self.equations, modes: &modes };
        let mut products = Products::new(&self.equations, vector, Refuted::Rising);
        products.leave_out(kept, (&self.forces, &self.gaps, self.factor));
        products.refutes_linear(&problem, |index, alpha, beta| {
            let matrix = transposed(self.tangents[index]?);
            let sum = [0, 1].map(|k| product(matrix, alpha)[k] + beta[k]);
            Some([length(sum), length(product(matrix, alpha)) + length(beta)])
        })
    }
}
