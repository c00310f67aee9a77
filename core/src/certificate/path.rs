//! Certificates of paths: every state that an observer sees is checked from the problem alone.
//!
//! - `path_equilibrium`: resultants of loads and contact forces on each free body, relative to the
//!   sum of all forces (moments divided by the scene's length), in displaced positions where
//!   displacements are finite ([`Displaced`]);
//! - `path_kinematics`: gaps recomputed from motions, forces and loads, relative to the greatest gap or
//!   displacement; where displacements are finite the rounding of positions is granted;
//! - `path_strength`: greatest excess of a facet over its bound, relative to the greatest contact force;
//! - `path_penetration`: greatest overlap of blocks, relative to the greatest gap or deformation;
//! - `path_complementarity`: greatest force × gap of open contact points, relative to both;
//! - `path_law`: difference between the force of a contact point and what its law of tractions from
//!   gaps gives for the recorded gap and the history of gaps, relative to the greatest contact force.
//!   Such a law has its own compliance: strength, penetration and complementarity say nothing there;
//! - `path_dissipation`: energy that friction would have created, relative to the work;
//! - `path_inner_equilibrium`: of blocks whose material yields, forces on the nodes that stresses leave,
//!   relative to the sum of the forces on the block; stresses are those that the law itself gives at the
//!   recorded displacements and history;
//! - `path_yield`: how much the law would still change that history, relative to the greatest strain: 0
//!   where no stress lies beyond the yield surface (a block recorded as elastic yields nowhere);
//! - `path_energy`: |work − stored − dissipated|, relative to the work (a step's error: no bound);
//!
//! and of what is claimed at a path's end:
//!
//! - `path_flow`: how far a mechanism's jumps leave the flow of the facets that yield;
//! - `path_power`: |p·q̇ − 1| of a mechanism;
//! - `path_ray`: what a ray leaves of the load, or its excess over a facet, relative to its forces.

use crate::law::{Facet, FacetMode};
use crate::path::{Displaced, Loading, PathObserver, PathProblem, PathState, PointLaw};
use std::collections::BTreeMap;

/// How large a residual may be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerance {
    /// Name of the residual.
    pub name: &'static str,
    /// In a result.
    pub result: f64,
    /// Where a solver checks what it is about to claim: infinite where the claim's one state does not
    /// show it.
    pub claim: f64,
}

/// The tolerances of all residuals of paths that have one.
#[rustfmt::skip]
pub const TOLERANCES: &[Tolerance] = &[
    Tolerance { name: "path_equilibrium", result: 1e-9, claim: 1e-8 },
    Tolerance { name: "path_kinematics", result: 1e-8, claim: 1e-7 },
    Tolerance { name: "path_strength", result: 1e-8, claim: 1e-8 },
    Tolerance { name: "path_penetration", result: 1e-8, claim: 1e-7 },
    Tolerance { name: "path_complementarity", result: 1e-8, claim: 1e-7 },
    Tolerance { name: "path_law", result: 1e-8, claim: 1e-8 },
    Tolerance { name: "path_inner_equilibrium", result: 1e-8, claim: 1e-8 },
    Tolerance { name: "path_yield", result: 1e-8, claim: 1e-8 },
    Tolerance { name: "path_forces", result: 1e-6, claim: 1e-6 },
    Tolerance { name: "path_dissipation", result: 1e-8, claim: f64::INFINITY },
    Tolerance { name: "path_flow", result: 1e-6, claim: 1e-6 },
    Tolerance { name: "path_power", result: 1e-6, claim: 1e-6 },
    Tolerance { name: "path_ray", result: 1e-9, claim: 1e-6 },
];

/// The tolerance of a residual: infinite where it has none.
pub fn tolerance(name: &str) -> Tolerance {
    let free = Tolerance { name: "", result: f64::INFINITY, claim: f64::INFINITY };
    TOLERANCES.iter().copied().find(|t| t.name == name).unwrap_or(free)
}

/// Share of the greatest forces of a path below which forces are not compared with themselves: a structure
/// that has come apart carries rounding.
const NOTHING: f64 = 1e-6;

/// Watches a path and keeps the worst of each residual.
#[derive(Debug, Default)]
pub struct PathChecker {
    /// Name → worst value.
    pub worst: BTreeMap<&'static str, f64>,
    /// Number of states seen.
    pub states: u64,
    /// (displacement \[m\], λ) of the states of the last load step.
    pub curve: Vec<[f64; 2]>,
    /// Whether equilibrium holds in displaced positions.
    pub finite: bool,
    last: Option<(usize, f64)>,
    memory: Option<Vec<f64>>,
    greatest: f64,
}

/// Keeps the worse of two residuals; a NaN stays.
fn worsen(worst: &mut f64, value: f64) {
    if value.is_nan() || value > *worst {
        *worst = value;
    }
}

/// Which checks the facets of a law ask for.
#[derive(Clone, Copy)]
struct Asks {
    penetration: bool,
    complementarity: bool,
}

impl Asks {
    fn of(facets: &[Facet]) -> Asks {
        let has = |mode: FacetMode| facets.iter().any(|f| f.mode == mode);
        let dry = facets.iter().any(|f| f.mode == FacetMode::Opening && f.bound == 0.0);
        let dilates = facets.iter().any(|f| f.mode == FacetMode::Sliding && f.flow[0] != 0.0);
        let penetration = dry && !has(FacetMode::Crushing);
        Asks { penetration, complementarity: penetration && !dilates }
    }
}

impl PathChecker {
    /// A checker over small or `finite` displacements.
    pub fn new(finite: bool) -> Self {
        PathChecker { finite, ..PathChecker::default() }
    }

    fn note(&mut self, name: &'static str, value: f64) {
        worsen(self.worst.entry(name).or_insert(0.0), value);
    }

    /// Checks one state.
    fn check(&mut self, problem: &PathProblem, state: &PathState) {
        let largest = state.force.iter().flatten().fold(0.0, |a: f64, f| a.max(f.abs()));
        let mut size = 0.0;
        for (load_step, factor) in problem.load_steps.iter().zip(problem.applied(state.load_step, state.factor)) {
            for [x, y, _] in problem.wrenches(&load_step.loading) {
                size += (factor * x.hypot(y)).abs();
            }
        }
        size += state.force.iter().map(|f| (f[0] * f[0] + f[1] * f[1]).sqrt()).sum::<f64>();
        // Where everything has come apart the forces are rounding of what they were.
        self.greatest = self.greatest.max(size);
        let size = size.max(NOTHING * self.greatest);
        let mut deformation = state.gap.iter().flatten().fold(0.0, |a: f64, g| a.max(g.abs()));
        for motion in &state.motion {
            deformation = deformation.max(motion[0].abs()).max(motion[1].abs());
        }
        let deformation = deformation.max(1e-300);
        let displaced = Displaced::new(problem, state, self.finite);
        let mut unbalanced = 0.0;
        for (w, _) in displaced.unbalanced().iter().zip(&problem.bodies).filter(|(_, b)| !b.held) {
            worsen(&mut unbalanced, w[0].hypot(w[1]));
            worsen(&mut unbalanced, w[2].abs() / problem.length);
        }
        self.note("path_equilibrium", unbalanced / size.max(1e-300));
        // Gaps of finite displacements are differences of positions.
        let rounding = if self.finite { 512.0 * f64::EPSILON * problem.length } else { 0.0 };
        let mut apart = 0.0;
        for (g, own) in displaced.gaps().iter().zip(&state.gap) {
            (0..2).for_each(|i| worsen(&mut apart, (g[i] - own[i]).abs() - rounding));
        }
        self.note("path_kinematics", apart / deformation);
        self.check_blocks(problem, state);
        let force_scale = largest.max(1e-300);
        let (mut bonded, mut strength) = (None, None);
        let (mut penetration, mut complementarity) = (None, None);
        let note = |worst: &mut Option<f64>, value: f64| worsen(worst.get_or_insert(0.0), value);
        for ((contact, force), gap) in problem.contacts.iter().zip(&state.force).zip(&state.gap) {
            let facets = match &contact.law {
                PointLaw::Bonded => {
                    (0..2).for_each(|i| note(&mut bonded, gap[i].abs() - rounding));
                    continue;
                }
                PointLaw::Response(_) => continue,
                PointLaw::Facets(facets) => facets,
            };
            let asks = Asks::of(facets);
            for facet in facets.iter() {
                let excess = facet.normal[0] * force[0] + facet.normal[1] * force[1] - facet.bound * contact.area;
                note(&mut strength, excess);
            }
            if asks.penetration {
                note(&mut penetration, -gap[0] - rounding);
            }
            if asks.complementarity {
                let product = (force[0] / force_scale).max(0.0).min(((gap[0] - rounding) / deformation).max(0.0));
                note(&mut complementarity, product);
            }
        }
        for (name, worst, scale) in [
            ("path_kinematics", bonded, deformation),
            ("path_strength", strength, force_scale),
            ("path_penetration", penetration, deformation),
            ("path_complementarity", complementarity, 1.0),
        ] {
            if let Some(worst) = worst {
                self.note(name, worst / scale);
            }
        }
        // The history is that of the states seen, where all of them were.
        let before = self.memory.as_deref().unwrap_or(&state.memory);
        if let Some((worst, after)) =
            problem.law_residual(state, before, deformation, self.finite, NOTHING * self.greatest)
        {
            self.note("path_law", worst);
            self.memory = Some(after);
        }
        let energy = state.work.abs().max(state.stored).max(state.dissipated.abs());
        self.note("path_energy", (state.work - state.stored - state.dissipated).abs() / energy.max(1e-300));
        let before = self.last.map_or(0.0, |(_, dissipated)| dissipated);
        self.note("path_dissipation", (before - state.dissipated) / energy.max(1e-300));
        self.last = Some((state.load_step, state.dissipated));
    }
}

impl PathChecker {
    /// Checks the blocks whose material yields.
    fn check_blocks(&mut self, problem: &PathProblem, state: &PathState) {
        if !problem.yields() {
            return;
        }
        let forces = problem.forces_on_points(state, self.finite);
        for (index, (body, forces)) in problem.bodies.iter().zip(&forces).enumerate() {
            let Some(inelastic) = &body.inelastic else { continue };
            let flat: Vec<f64> = forces.iter().flat_map(|f| [f.x, f.y]).collect();
            let size = forces.iter().map(|f| f.norm()).sum::<f64>();
            if size == 0.0 && state.inelastic(index).is_none() {
                continue;
            }
            let found = match state.inelastic(index) {
                Some(own) => inelastic.check(&own.displacement, &own.state.history, &flat),
                None => inelastic.check(&inelastic.elastic_displacement(&flat), &inelastic.initial().history, &flat),
            };
            let [unbalanced, drift] = found.unwrap_or([f64::NAN; 2]);
            self.note("path_inner_equilibrium", unbalanced / size.max(1e-300));
            self.note("path_yield", drift);
        }
    }
}

impl PathObserver for PathChecker {
    fn state(&mut self, problem: &PathProblem, state: &PathState) -> bool {
        self.states += 1;
        self.check(problem, state);
        if state.load_step + 1 == problem.load_steps.len() {
            self.curve.push([state.displacement, state.factor]);
        }
        true
    }
}

/// `path_power`: |p·q̇ − 1|, p the loading and q̇ the velocities of all bodies about their poles.
pub fn power_residual(problem: &PathProblem, loading: &Loading, motion: &[[f64; 3]]) -> f64 {
    let load = problem.wrenches(loading);
    let power: f64 = load.iter().flatten().zip(motion.iter().flatten()).map(|(p, v)| p * v).sum();
    (power - 1.0).abs()
}

/// `path_ray`: whether rates of contact forces carry any amount of a loading: what they leave of it
/// on a free body (moments divided by the scene's length), or their greatest excess over a facet of
/// the recession cone, relative to the sum of all of them; NaN where there are none.
pub fn ray_residual(problem: &PathProblem, loading: &Loading, ray: &[[f64; 2]]) -> f64 {
    let mut sum = problem.wrenches(loading);
    let size: f64 = ray.iter().map(|r| r[0].hypot(r[1])).sum();
    let mut worst: f64 = 0.0;
    for (contact, r) in problem.contacts.iter().zip(ray) {
        for plus in [false, true] {
            let rows = problem.kinematics(contact, plus);
            let body = if plus { contact.plus.body } else { contact.minus.body };
            (0..3).for_each(|i| sum[body][i] += rows[0][i] * r[0] + rows[1][i] * r[1]);
        }
        for facet in contact.law.facets().unwrap_or_default() {
            worst = worst.max(facet.normal[0] * r[0] + facet.normal[1] * r[1]);
        }
    }
    for (w, _) in sum.iter().zip(&problem.bodies).filter(|(_, body)| !body.held) {
        worst = worst.max(w[0].hypot(w[1])).max(w[2].abs() / problem.length);
    }
    if size.is_finite() { worst / size } else { f64::NAN }
}

/// Checks a mechanism against a field: how far the jumps leave the flow of the facets that yield,
/// relative to the greatest jump. Every contact point with slack in all facets must not move. Laws of
/// tractions from gaps have no flow: see [`PathProblem::leaves_forces`].
pub fn flow_residual(problem: &PathProblem, force: &[[f64; 2]], motion: &[[f64; 3]]) -> f64 {
    let largest = force.iter().flatten().fold(0.0, |a: f64, f| a.max(f.abs()));
    let jumps: Vec<[f64; 2]> = problem
        .contacts
        .iter()
        .map(|contact| {
            let mut jump = [0.0; 2];
            for plus in [false, true] {
                let rows = problem.kinematics(contact, plus);
                let body = if plus { contact.plus.body } else { contact.minus.body };
                (0..2).for_each(|i| jump[i] += (0..3).map(|k| rows[i][k] * motion[body][k]).sum::<f64>());
            }
            jump
        })
        .collect();
    let size = jumps.iter().map(|j| j[0].hypot(j[1])).fold(1e-300, f64::max);
    let mut worst: f64 = 0.0;
    for ((contact, force), jump) in problem.contacts.iter().zip(force).zip(&jumps) {
        let facets = match &contact.law {
            PointLaw::Bonded => {
                worst = worst.max(jump[0].hypot(jump[1]) / size);
                continue;
            }
            PointLaw::Response(_) => continue,
            PointLaw::Facets(facets) => facets,
        };
        let yielding: Vec<[f64; 2]> = facets
            .iter()
            .filter(|f| {
                let slack = f.bound * contact.area - f.normal[0] * force[0] - f.normal[1] * force[1];
                slack <= YIELDING * largest
            })
            .map(|f| f.flow.map(|d| -d))
            .collect();
        worst = worst.max(outside(*jump, &yielding) / size);
    }
    worst
}

/// Slack, relative to the greatest contact force, up to which a facet counts as yielding.
const YIELDING: f64 = 1e-9;

/// Distance of v from the cone of some directions in the plane.
fn outside(v: [f64; 2], cone: &[[f64; 2]]) -> f64 {
    let mut least = v[0].hypot(v[1]);
    for (k, a) in cone.iter().enumerate() {
        let along = ((v[0] * a[0] + v[1] * a[1]) / (a[0] * a[0] + a[1] * a[1])).max(0.0);
        least = least.min((v[0] - along * a[0]).hypot(v[1] - along * a[1]));
        for b in &cone[k + 1..] {
            let determinant = a[0] * b[1] - a[1] * b[0];
            if determinant != 0.0 {
                let shares = [(v[0] * b[1] - v[1] * b[0]) / determinant, (a[0] * v[1] - a[1] * v[0]) / determinant];
                if shares.iter().all(|s| *s >= 0.0) {
                    return 0.0;
                }
            }
        }
    }
    least
}
