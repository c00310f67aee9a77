//! What a path claims at its end, checked again: a claim that is not confirmed becomes a stall.
//!
//! - every claim: the field of its state is in equilibrium, within its strengths and complementary;
//! - collapse: a mechanism with p·q̇ = 1 that obeys the laws' flow at that field and leaves forces alone;
//! - no equilibrium: the same under the dead load, before all of it is carried. A limit point of the
//!   dead load is no proof: with friction that is not associated another path may carry it;
//! - unbounded: rates of forces that balance the load and stay in the recession cone of the facets;
//! - limit point: no combination of regimes of the points at the verge of a change has a rate with
//!   growing λ (all are tried).

use super::law::Regime;
use super::model::{Control, Model, State};
use voussoir_core::limit::Status;
use voussoir_core::path::certificate::{Watch, flow_residual};
use voussoir_core::path::{ContactLaw, PathAnswer, PathObserver, PathProblem};

/// Residuals above which a field proves nothing.
const FIELD: [(&str, f64); 7] = [
    ("path_equilibrium", 1e-8),
    ("path_kinematics", 1e-7),
    ("path_strength", 1e-8),
    ("path_penetration", 1e-7),
    ("path_complementarity", 1e-7),
    ("path_inner_equilibrium", 1e-8),
    ("path_yield", 1e-8),
];

/// How far a mechanism may leave the laws' flow, and a ray its equations, relative to their size.
const MECHANISM: f64 = 1e-6;

/// Slack, relative to the greatest force, up to which a facet may yield in a rate.
const VERGE: f64 = 1e-8;

/// Combinations of regimes that are tried.
const COMBINATIONS: usize = 3000;

/// The answer, or a stall with the reason where its claim is not confirmed.
pub(super) fn confirmed(problem: &PathProblem, finite: bool, mut answer: PathAnswer) -> PathAnswer {
    if answer.status == Status::Stalled {
        return answer;
    }
    if let Err(why) = confirm(problem, finite, &answer) {
        answer.notes.push(format!("{:?} at factor {} is not confirmed: {why}", answer.status, answer.state.factor));
        if let Some(last) = answer.last.take() {
            answer.state = last;
        }
        answer.status = Status::Stalled;
        (answer.factor, answer.motion, answer.ray) = (None, None, None);
    }
    answer
}

fn confirm(problem: &PathProblem, finite: bool, answer: &PathAnswer) -> Result<(), String> {
    let mut watch = Watch::new(finite);
    watch.state(problem, &answer.state);
    // Gaps that are rounding of what the forces deform have no size to compare with.
    let force = answer.state.force.iter().flatten().fold(0.0, |a: f64, r| a.max(r.abs()));
    let soft = problem.contacts.iter().flat_map(|c| c.compliance).fold(0.0, f64::max);
    let blocks = problem.bodies.iter().filter_map(|b| b.flexibility.as_ref()).map(|f| f.amax()).fold(soft, f64::max);
    let moves = answer.state.gap.iter().flatten().fold(0.0, |a: f64, g| a.max(g.abs()));
    let still = moves <= 1e-9 * force * blocks;
    let applied = problem.applied(answer.state.drive, answer.state.factor);
    let parts = problem.drives.iter().zip(applied);
    let load: f64 = parts.map(|(d, factor)| (factor * super::model::load_size(problem, &d.loading)).abs()).sum();
    for (name, bound) in FIELD {
        if still && !matches!(name, "path_equilibrium" | "path_strength" | "path_inner_equilibrium") {
            continue;
        }
        // Where everything is open the forces are rounding of the loads.
        if name == "path_strength" && force <= 1e-12 * load {
            continue;
        }
        let value = watch.worst.get(name).copied().unwrap_or(0.0);
        // Written so that NaN fails.
        if !matches!(value.partial_cmp(&bound), Some(std::cmp::Ordering::Less | std::cmp::Ordering::Equal)) {
            return Err(format!("{name} is {value:.2e}"));
        }
    }
    match answer.status {
        Status::NoEquilibrium if answer.motion.is_none() => Err("there is no mechanism under the dead load".into()),
        Status::Collapse if finite => Ok(()),
        Status::NoEquilibrium if finite => Ok(()),
        Status::Collapse | Status::NoEquilibrium => mechanism(problem, answer),
        Status::Unbounded => ray(problem, answer),
        _ => Ok(()),
    }
}

/// Whether the motion is one that goes on for ever under the present forces.
fn mechanism(problem: &PathProblem, answer: &PathAnswer) -> Result<(), String> {
    let Some(motion) = &answer.motion else { return Err("there is no mechanism".into()) };
    if problem.bodies.iter().zip(motion).any(|(body, q)| body.held && *q != [0.0; 3]) {
        return Err("the mechanism moves the ground".into());
    }
    let flow = flow_residual(problem, &answer.state.force, motion);
    if flow.is_nan() || flow > MECHANISM {
        return Err(format!("the mechanism leaves the flow of the laws by {flow:.2e}"));
    }
    let drive = &problem.drives[answer.drive];
    let load = problem.wrenches(&drive.loading);
    let power: f64 = load.iter().flatten().zip(motion.iter().flatten()).map(|(p, v)| p * v).sum();
    if power.is_nan() || (power - 1.0).abs() > MECHANISM {
        return Err(format!("the load does the work {power:.6} on the mechanism, not 1"));
    }
    if answer.status == Status::NoEquilibrium && answer.state.factor >= 1.0 - 1e-9 {
        return Err("all of the dead load is carried".into());
    }
    Ok(())
}

/// Whether rates of forces carry any amount of the load.
fn ray(problem: &PathProblem, answer: &PathAnswer) -> Result<(), String> {
    let Some(ray) = &answer.ray else { return Err("there is no ray".into()) };
    let mut sum = problem.wrenches(&problem.drives[answer.drive].loading);
    let size: f64 = ray.iter().map(|r| r[0].hypot(r[1])).sum();
    let mut excess: f64 = 0.0;
    for (contact, r) in problem.contacts.iter().zip(ray) {
        for plus in [false, true] {
            let rows = problem.kinematics(contact, plus);
            let body = if plus { contact.plus.body } else { contact.minus.body };
            (0..3).for_each(|i| sum[body][i] += rows[0][i] * r[0] + rows[1][i] * r[1]);
        }
        if let ContactLaw::Law(law) = contact.law {
            for f in &problem.facets[law] {
                excess = excess.max(f.normal[0] * r[0] + f.normal[1] * r[1]);
            }
        }
    }
    let free = sum.iter().zip(&problem.bodies).filter(|(_, body)| !body.held);
    let left = free.map(|(w, _)| w[0].hypot(w[1]).max(w[2].abs() / problem.length)).fold(0.0, f64::max);
    if size.is_finite() && left <= MECHANISM * size && excess <= MECHANISM * size {
        return Ok(());
    }
    Err(format!("the ray leaves {left:.2e} of the load and exceeds a facet by {excess:.2e}, of forces of {size:.2e}"))
}

impl Model<'_> {
    /// Proves that no rate with growing λ starts at a converged state: every combination of regimes
    /// of the points at the verge of a change is tried. An error says why that is not so.
    pub fn none_rises(&mut self, state: &State, direction: f64) -> Result<(), String> {
        let largest = state.force.iter().flatten().map(|r| r.abs()).fold(0.0, f64::max);
        let points = state.gap.len();
        let mut active = vec![Vec::new(); points];
        let mut open = vec![false; points];
        let mut choices: Vec<(usize, Vec<Regime>)> = Vec::new();
        for c in 0..points {
            let (Some(law), area, r) = (self.law(c), self.problem.contacts[c].area, state.force[c]) else { continue };
            let slack = |i: usize| {
                let f = &law.facets[i];
                f.bound * area - f.normal[0] * r[0] - f.normal[1] * r[1]
            };
            active[c] = (0..law.facets.len()).filter(|i| slack(*i) <= VERGE * largest).collect();
            let (_, opening) = law.irreversible(state.regime[c], self.step_gap(state, state, c));
            open[c] = law.opens(state.regime[c]) && opening > 1e-9 * self.units.displacement;
            if open[c] || active[c].is_empty() {
                continue;
            }
            let mut regimes = vec![Regime::Stuck];
            regimes.extend(active[c].iter().map(|i| Regime::Facet(*i as u8)));
            let at = |k: &usize| law.corners[*k].1.iter().flatten().all(|i| active[c].contains(i));
            regimes.extend((0..law.corners.len()).filter(at).map(|k| Regime::Corner(k as u8)));
            choices.push((c, regimes));
        }
        let count = choices.iter().fold(1usize, |n, (_, regimes)| n.saturating_mul(regimes.len()));
        if count > COMBINATIONS {
            return Err(format!("{count} combinations of regimes are too many to exclude that the load grows"));
        }
        let mut trial = state.clone();
        for number in 0..count {
            let mut rest = number;
            for (c, regimes) in &choices {
                trial.regime[*c] = regimes[rest % regimes.len()];
                rest /= regimes.len();
            }
            let Some(rate) = self.rate(state, &trial, &Control::Factor(state.factor)) else { continue };
            let rate = rate.scaled(direction);
            let force = rate.force.iter().flatten().map(|r| r.abs()).fold(self.units.force, f64::max);
            let gap = self.motion_size(&rate) * self.units.displacement;
            let fits = choices.iter().all(|(c, _)| {
                let Some(law) = self.law(*c) else { return true };
                let v = rate.gap[*c].map(|g| g / gap.max(1e-300));
                let r = rate.force[*c].map(|r| r / force);
                let inside = active[*c].iter().all(|i| {
                    let a = law.facets[*i].normal;
                    a[0] * r[0] + a[1] * r[1] <= 1e-9
                });
                inside && law.ray_violation(trial.regime[*c], [0.0; 2], v) <= 1e-9
            });
            if fits {
                return Err("there is a rate on which the load grows".into());
            }
        }
        Ok(())
    }
}
