//! Line search: the accepted step length of an iteration of Newton's method.
//!
//! The equations of a step are one semismooth system F(x) = 0 in x = (r, q, λ), for all modes,
//!
//! ```text
//! facets     F_c = r − P(z),   z = r − ρ Δg,   P the return to the polygon along ρ d (see `law`)
//! no facets  F_c = ρ Δg        laws of tractions from gaps   F_c = σ (r − A t(g))   (see `response`)
//! bodies     F_b = ∂Π/∂q       control   F_λ = c(increment) − length
//! ```
//!
//! in the units of the unknowns (Alart & Curnier 1991; the natural map of the complementarity conditions: Facchinei &
//! Pang 2003, section 1.5). F is linear in every combination of modes, up to large rotations. The equations of the
//! modes of z are linear combinations of the rows of F + F'Δx = 0. With all modes those of z, the step Δx of `iterate`
//! is therefore Newton's step for F, and the merit Ψ = ½‖F‖² has the slope Ψ' = −‖F‖² along it. If the full step does
//! not lower Ψ, it is halved until
//!
//! ```text
//! ‖F(x + t Δx)‖ ≤ (1 − σ t) max ‖F‖ of the last m iterations
//! ```
//!
//! ([`optimise::line_search`](crate::optimise::line_search); frictional contact: Christensen, Klarbring, Pang &
//! Strömberg 1998, Int. J. Numer. Meth. Engng 42, 145-173). A line search finds local minima of Ψ; a minimum is a
//! solution only if F = 0, by the test of `iterate`.

use super::linearised::residual_of;
use super::tangent::apply_step;
use crate::optimise::line_search::LineSearch;
use crate::path::newton::model::control::Control;
use crate::path::newton::model::derivatives::Gradient;
use crate::path::newton::model::state::State;
use crate::path::newton::model::system::StepSystem;
use crate::path::newton::quantities::control_row::control_value;
use crate::path::newton::quantities::inelastic::{block_error, update_blocks};
use crate::path::newton::quantities::response::update_tractions;
use std::rc::Rc;

/// Returns ‖F‖ of a state in the units of the unknowns.
fn merit(system: &StepSystem, start: &State, state: &State, gradient: &Gradient, control: &Control) -> f64 {
    let u = system.units();
    let mut rows = residual_of(system, start, state, gradient);
    let last = rows.len() - 1;
    rows[last] = control_value(system, start, state, control);
    for c in (0..state.gap.len()).filter(|c| !system.laws.responses.is(*c)) {
        let (rho, gap) = (system.stiffness(c), system.step_gap(start, state, c));
        let pulled = [0, 1].map(|k| rho[k] * gap[k]);
        let left = match system.law(c) {
            Some(law) => {
                let r = state.force[c];
                let z = [r[0] - pulled[0], r[1] - pulled[1]];
                let back = law.return_map(z, rho, system.problem.contacts[c].area);
                [r[0] - back[0], r[1] - back[1]]
            }
            None => pulled,
        };
        (0..2).for_each(|k| rows[2 * c + k] = left[k] / u.force);
    }
    let inner = block_error(system, state);
    rows.iter().map(|f| f * f).sum::<f64>().sqrt().hypot(inner)
}

/// Returns the state moved by a share of a step, with its blocks, gaps and tractions.
pub fn advanced(
    system: &mut StepSystem,
    start: &State,
    state: &State,
    step: &[f64],
    share: f64,
) -> Result<(State, Rc<Gradient>), String> {
    let mut next = state.clone();
    apply_step(system, &mut next, step, share);
    update_blocks(system, &mut next)?;
    let gradient = system.gradient(&next);
    next.gap = gradient.gap.clone();
    update_tractions(system, start, &mut next)?;
    Ok((next, gradient))
}

/// Returns the state on a step with a merit that is low enough, otherwise the state of least merit, and true for the
/// full step. The step is at most `most`.
pub fn searched(
    system: &mut StepSystem,
    start: &State,
    (state, gradient): (&State, &Gradient),
    control: &Control,
    (step, most): (&[f64], f64),
    search: &mut LineSearch,
) -> Result<(State, Rc<Gradient>, bool), String> {
    let points = state.gap.len() as u64;
    if search.merits.is_empty() {
        system.count("law_evaluations", points);
        search.merits.push(merit(system, start, state, gradient, control));
    }
    let at = |halvings: i32, share: f64| {
        match halvings {
            0 => {}
            1 => ["line_searches", "halvings"].into_iter().for_each(|what| system.count(what, 1)),
            _ => system.count("halvings", 1),
        }
        let (next, gradient) = advanced(system, start, state, step, share)?;
        system.count("law_evaluations", points);
        let merit = merit(system, start, &next, &gradient, control);
        Ok((merit, (next, gradient)))
    };
    let unknown = || "an iteration left the numbers".to_string();
    let ((next, gradient), whole) =
        search.search(most, at).map_err(|failure: Option<String>| failure.unwrap_or_else(unknown))?;
    Ok((next, gradient, whole))
}

#[cfg(test)]
mod tests {
    use super::super::linearised::solve_linear;
    use super::super::tangent::wanted_modes;
    use super::*;
    use crate::contact::mode::ContactMode;
    use crate::path::newton::model::loads::StagedLoads;
    use crate::path::newton::quantities::control_row::control_row;
    use voussoir_core::law::Facet;
    use voussoir_core::limit::Counters;
    use voussoir_core::model::geometry::Vec2;
    use voussoir_core::path::{
        Attachment, Contact, LoadStep, LoadStepEnd, Loading, PathBody, PathProblem, Period, PointLaw,
    };
    use voussoir_core::random::Random;

    /// A rigid block on three compliant points of the ground with dilatant friction, pushed down and sideways.
    fn pushed() -> PathProblem {
        let body = |held, pole| PathBody {
            members: vec![0],
            pole,
            held,
            mass: 0.0,
            points: vec![],
            flexibility: None,
            inelastic: None,
        };
        let [left, right] = Facet::friction(0.5, 0.0, 0.2);
        let law = PointLaw::Facets(vec![Facet::opening(0.0), left, right].into());
        let contact = |x: f64| Contact {
            joint: 0,
            position: Vec2::new(x, 0.0),
            normal: Vec2::new(0.0, 1.0),
            tangent: Vec2::new(-1.0, 0.0),
            minus: Attachment { body: 0, slot: None },
            plus: Attachment { body: 1, slot: None },
            area: 1.0,
            gap: 0.0,
            law: law.clone(),
            sliding: voussoir_core::path::Sliding::middle(0.0),
            compliance: [1e-6, 2e-6],
        };
        let pole = Vec2::new(0.0, 0.5);
        let loading = Loading { forces: vec![(1, None, pole, Vec2::new(4.0, -10.0))], ..Loading::default() };
        PathProblem {
            bodies: vec![body(true, Vec2::zeros()), body(false, pole)],
            body_of: vec![0, 1],
            contacts: vec![contact(-1.0), contact(0.2), contact(1.0)],
            load_steps: vec![LoadStep {
                stage: 0,
                gravity: false,
                loading,
                start: 0.0,
                end: LoadStepEnd::Factor(1.0),
                period: Period::default(),
            }],
            length: 2.0,
            span: 2.0,
            counters: Counters::new(),
            width: 1.0,
        }
    }

    /// From any state the step of the modes of z lowers the merit at the rate of its full value per full step.
    #[test]
    fn the_merit_falls_along_the_step() {
        let problem = pushed();
        let control = Control::Factor(1.0);
        for finite in [false, true] {
            let mut system = StepSystem::new(&problem, finite).expect("a system");
            system.load(0, StagedLoads::new(Vec::new(), &problem.load_steps[0].loading, 0.0));
            let (start, u) = (system.undeformed(), system.units());
            let (mut random, mut compared) = (Random::from_state(5), [0; 3]);
            for _ in 0..600 {
                let mut state = start.clone();
                state.factor = 0.7;
                state
                    .force
                    .iter_mut()
                    .for_each(|r| *r = [u.force * (random.signed() + 0.3), u.force * random.signed()]);
                let unit = [u.displacement, u.displacement, u.displacement / u.length];
                state.motion[1] = unit.map(|unit| unit * random.signed());
                let gradient = system.gradient(&state);
                state.gap = gradient.gap.clone();
                state.mode = wanted_modes(&mut system, &start, &state).0;
                let mut rows = residual_of(&system, &start, &state, &gradient);
                let left = control_value(&system, &start, &state, &control);
                let last = rows.len() - 1;
                rows[last] = left;
                let equations = system.equations(&state);
                let row = control_row(&system, &control);
                let right: Vec<f64> = rows.iter().map(|x| -x).collect();
                let Some((step, true)) = solve_linear(&mut system, &state, &equations, &row, &right) else { continue };
                // If all points slide to the same side, the modes do not hold the block.
                if step.iter().any(|x| x.abs() > 1e3) {
                    continue;
                }
                let mut at = |share: f64| {
                    let (state, gradient) = advanced(&mut system, &start, &state, &step, share).expect("a state");
                    merit(&system, &start, &state, &gradient, &control)
                };
                let (here, small) = (at(0.0), 1e-7);
                let slope = (at(small) - here) / small;
                assert!((slope + here).abs() <= 1e-4 * here, "{finite} {:?}: {slope:e} {here:e}", state.mode);
                for mode in &state.mode {
                    compared[match mode {
                        ContactMode::Stick => 0,
                        ContactMode::Facet(_) => 1,
                        ContactMode::Corner(..) | ContactMode::Open => 2,
                    }] += 1;
                }
            }
            assert!(compared.iter().all(|n| *n > 20), "{compared:?}");
        }
    }
}
