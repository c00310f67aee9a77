//! Checks every state of a path and stores the worst value of each residual.

use super::displaced::Displaced;
use super::energy::EnergyBalance;
use super::response::law_residual;
use super::structure::path_structure;
use crate::law::{Facet, FacetMode};
use crate::linear::vectors::largest;
use crate::model::{Assembly, Stage};
use crate::path::{LawStep, PathObserver, PathProblem, PathState, PointLaw};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Share of the greatest forces of a path below which forces are not used as scale: a structure that has come apart
/// carries only rounding errors.
const NOTHING: f64 = 1e-6;

/// Slip beyond the face of a joint that is allowed for rounding of the location of an event, as a share of the size of
/// the scene.
const AT_FACE: f64 = 1e-6;

/// An observer that checks the states of a path and stores the worst value of each residual.
#[derive(Debug, Default)]
pub struct PathChecker {
    /// Worst value by name of the residual.
    pub worst: BTreeMap<&'static str, f64>,
    /// Number of states checked.
    pub states: u64,
    /// (displacement \[m\], λ) of the states of the last load step.
    pub curve: Vec<[f64; 2]>,
    /// True if equilibrium is checked in displaced positions.
    pub finite: bool,
    structure: Option<Arc<PathProblem>>,
    last: Option<(usize, f64)>,
    /// States of all responses after the last state, and the place and gaps of the last state.
    memory: Option<(Vec<f64>, PathState)>,
    greatest: f64,
    energy: EnergyBalance,
}

/// Stores the worse of two residuals; NaN is the worst.
fn worsen(worst: &mut f64, value: f64) {
    if value.is_nan() || value > *worst {
        *worst = value;
    }
}

/// The checks that depend on the facets of a law.
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

/// Scales of the residuals of a state.
struct Scale {
    /// Sum of all forces \[N\].
    force: f64,
    /// Greatest gap or displacement \[m\].
    deformation: f64,
    /// Rounding of a gap \[m\].
    rounding: f64,
}

impl PathChecker {
    /// Creates a checker for small or `finite` displacements that checks states against the problem that they come
    /// with. This is the self-check of a solver, not a certificate.
    pub fn new(finite: bool) -> Self {
        PathChecker { finite, ..PathChecker::default() }
    }

    /// Creates a checker that checks states against the structure of the assembly and the stages, not against the problem
    /// that they come with.
    ///
    /// # Errors
    /// Names the part of the assembly from which no structure can be derived.
    pub fn certifying(assembly: &Assembly, stages: &[Stage], finite: bool) -> Result<Self, String> {
        Ok(PathChecker {
            finite,
            structure: Some(Arc::new(path_structure(assembly, stages)?)),
            ..PathChecker::default()
        })
    }

    /// Returns the structure that states are checked against, if it comes from an assembly.
    pub fn structure(&self) -> Option<Arc<PathProblem>> {
        self.structure.clone()
    }

    fn note(&mut self, name: &'static str, value: f64) {
        worsen(self.worst.entry(name).or_insert(0.0), value);
    }

    /// Checks one state of the problem of `displaced`. A certificate needs the problem of
    /// [`structure`](Self::structure).
    pub fn check(&mut self, displaced: &Displaced) {
        let (problem, state) = (displaced.problem, displaced.state);
        self.states += 1;
        if state.load_step + 1 == problem.load_steps.len() {
            self.curve.push([state.displacement, state.factor]);
        }
        if state.force.len() != problem.contacts.len() || state.motion.len() != problem.bodies.len() {
            return self.note("path_equilibrium", f64::NAN);
        }
        let loads: f64 = problem
            .load_steps
            .iter()
            .zip(problem.applied(state.load_step, state.factor))
            .map(|(step, factor)| {
                let sizes = problem.wrenches(&step.loading).into_iter().map(|[x, y, _]| (x * x + y * y).sqrt());
                factor.abs() * sizes.sum::<f64>()
            })
            .sum();
        let forces: f64 = state.force.iter().map(|f| (f[0] * f[0] + f[1] * f[1]).sqrt()).sum();
        // If all blocks have come apart, the forces are rounding errors of earlier forces.
        self.greatest = self.greatest.max(loads + forces);
        let moves =
            state.motion.iter().fold(largest(state.gap.as_flattened()), |a: f64, u| a.max(u[0].abs()).max(u[1].abs()));
        let scale = Scale {
            force: (loads + forces).max(NOTHING * self.greatest).max(1e-300),
            deformation: moves.max(1e-300),
            // With finite displacements gaps are differences of positions.
            rounding: if self.finite { 512.0 * f64::EPSILON * problem.length } else { 0.0 },
        };
        self.check_bodies(problem, displaced, state, &scale);
        self.check_blocks(problem, state);
        self.check_points(problem, state, &scale);
        // Use the history of the states received so far, if all states were received.
        let (before, step) = match &self.memory {
            Some((memory, last)) => (&memory[..], LawStep::between(problem, last, state)),
            None => (&state.memory[..], LawStep::to(problem, state)),
        };
        let least = NOTHING * self.greatest;
        if let Some((worst, (_, after))) =
            law_residual(problem, state, (before, &step), scale.deformation, self.finite, least)
        {
            self.note("path_law", worst);
            let PathState { load_step, factor, .. } = *state;
            let last = PathState { load_step, factor, gap: state.gap.clone(), ..PathState::default() };
            self.memory = Some((after, last));
        }
        let stored = displaced.stored().unwrap_or(state.stored);
        let energy = state.work.abs().max(state.stored).max(state.dissipated.abs());
        let floor = 1e-12 * self.greatest * problem.length;
        let share = self.energy.add(problem, self.finite, (state, stored), floor);
        self.worst.insert("path_energy", share);
        let before = self.last.map_or(0.0, |(_, dissipated)| dissipated);
        self.note("path_dissipation", (before - state.dissipated) / energy.max(1e-300));
        self.last = Some((state.load_step, state.dissipated));
    }

    /// Checks that bodies are in equilibrium, that gaps follow from motions, and that supports have moved by their
    /// settlements.
    fn check_bodies(&mut self, problem: &PathProblem, displaced: &Displaced, state: &PathState, scale: &Scale) {
        let mut unbalanced = 0.0;
        for (w, _) in displaced.unbalanced().iter().zip(&problem.bodies).filter(|(_, b)| !b.held) {
            worsen(&mut unbalanced, w[0].hypot(w[1]));
            worsen(&mut unbalanced, w[2].abs() / problem.length);
        }
        self.note("path_equilibrium", unbalanced / scale.force);
        let mut apart = 0.0;
        for (g, own) in displaced.gaps().iter().zip(&state.gap) {
            (0..2).for_each(|i| worsen(&mut apart, (g[i] - own[i]).abs() - scale.rounding));
        }
        let settled = problem.settled(state.load_step, state.factor);
        let supports = problem.bodies.iter().zip(state.motion.iter().zip(&settled)).filter(|(body, _)| body.held);
        for (_, (own, settled)) in supports {
            let lengths = [1.0, 1.0, problem.length];
            (0..3).for_each(|i| worsen(&mut apart, (own[i] - settled[i]).abs() * lengths[i]));
        }
        self.note("path_kinematics", apart / scale.deformation);
    }

    /// Checks contact points with facets, and bonded points.
    fn check_points(&mut self, problem: &PathProblem, state: &PathState, scale: &Scale) {
        let largest = largest(state.force.as_flattened()).max(1e-300);
        let [mut bonded, mut strength, mut penetration, mut complementarity] = [(false, 0.0); 4];
        let note = |worst: &mut (bool, f64), value: f64| {
            worst.0 = true;
            worsen(&mut worst.1, value);
        };
        // Most contact points have the same law as the point before.
        let (mut last, mut asks): (&[Facet], Asks) = (&[], Asks::of(&[]));
        for ((contact, force), gap) in problem.contacts.iter().zip(&state.force).zip(&state.gap) {
            let facets = match &contact.law {
                PointLaw::Bonded => {
                    (0..2).for_each(|i| note(&mut bonded, gap[i].abs() - scale.rounding));
                    continue;
                }
                PointLaw::Response(_) => continue,
                PointLaw::Facets(facets) => facets,
            };
            if self.finite && force[0] > NOTHING * largest {
                let [low, high] = contact.sliding.slip;
                let beyond = (low - gap[1]).max(gap[1] - high) - AT_FACE * problem.length;
                note(&mut bonded, beyond);
            }
            let before = std::mem::replace(&mut last, facets);
            if !std::ptr::eq(before, last) {
                asks = Asks::of(facets);
            }
            for facet in facets.iter() {
                let excess = facet.normal[0] * force[0] + facet.normal[1] * force[1] - facet.bound * contact.area;
                note(&mut strength, excess);
            }
            if asks.penetration {
                note(&mut penetration, -gap[0] - scale.rounding);
            }
            if asks.complementarity {
                let (pressed, open) = (force[0].max(0.0), (gap[0] - scale.rounding).max(0.0));
                let both =
                    if pressed > 0.0 && open > 0.0 { (pressed / largest).min(open / scale.deformation) } else { 0.0 };
                note(&mut complementarity, both);
            }
        }
        for (name, worst, scale) in [
            ("path_kinematics", bonded, scale.deformation),
            ("path_strength", strength, largest),
            ("path_penetration", penetration, scale.deformation),
            ("path_complementarity", complementarity, 1.0),
        ] {
            if worst.0 {
                self.note(name, worst.1 / scale);
            }
        }
    }

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
                None => {
                    let (displacement, own) = inelastic.elastic_state(&flat);
                    inelastic.check(&displacement, &own.history, &flat)
                }
            };
            let [unbalanced, drift] = found.unwrap_or([f64::NAN; 2]);
            self.note("path_inner_equilibrium", unbalanced / size.max(1e-300));
            self.note("path_yield", drift);
        }
    }
}

impl PathObserver for PathChecker {
    fn state(&mut self, problem: &PathProblem, state: &PathState) -> bool {
        let structure = self.structure.clone();
        let problem = structure.as_deref().unwrap_or(problem);
        self.check(&Displaced::new(problem, state, self.finite));
        true
    }
}
