//! Checks the claim at the end of a path again: a claim that is not confirmed becomes a stall.
//!
//! - every claim: the field of its state is in equilibrium, within its strengths and complementary;
//! - collapse at a constant load: a mechanism with p·q̇ = 1 that satisfies the laws' flow at that field and changes no
//!   force;
//! - no equilibrium: the same under the dead load, before all of it is carried. A limit point of the dead load proves less:
//!   on another path, or behind it, the structure may carry more;
//! - unbounded: rates of forces that balance the load and stay in the recession cone of the facets;
//! - limit point: no modes of the active points have a rate with growing λ (`rising`).

use crate::settings::SETTINGS;
use voussoir_core::certificate::{
    MechanismPlace, PathChecker, flow_residual, forces_rest, leaves_forces, power_residual, ray_residual, tolerance,
};
use voussoir_core::limit::Status;
use voussoir_core::path::{PathAnswer, PathObserver, PathProblem};

/// Returns the answer, or a stall with the reason if its claim is not confirmed.
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
    let own = answer.state.factor;
    if let Some(factor) =
        answer.factor.filter(|f| f.is_nan() || (f - own).abs() > SETTINGS.admissible * f.abs().max(own.abs()))
    {
        return Err(format!("the factor {factor} is not that of the state"));
    }
    let mut checker = PathChecker::new(finite);
    checker.state(problem, &answer.state);
    // Gaps that are rounding errors of the deformation by the forces have no scale for a comparison.
    let force = answer.state.force.iter().flatten().fold(0.0, |a: f64, r| a.max(r.abs()));
    let soft = problem.contacts.iter().flat_map(|c| c.compliance).fold(0.0, f64::max);
    let blocks = problem.bodies.iter().filter_map(|b| b.flexibility.as_ref()).map(|f| f.amax()).fold(soft, f64::max);
    let moves = answer.state.gap.iter().flatten().fold(0.0, |a: f64, g| a.max(g.abs()));
    let still = moves <= 1e-9 * force * blocks;
    let applied = problem.applied(answer.state.load_step, answer.state.factor);
    let parts = problem.load_steps.iter().zip(applied);
    let load: f64 = parts.map(|(d, factor)| (factor * problem.load_size(&d.loading)).abs()).sum();
    for (name, value) in checker.worst {
        if still && !matches!(name, "path_equilibrium" | "path_strength" | "path_inner_equilibrium") {
            continue;
        }
        // If all points are open, the forces are rounding errors of the loads.
        if name == "path_strength" && force <= 1e-12 * load {
            continue;
        }
        small(name, value)?;
    }
    let place = answer.last.as_ref().map(|last| MechanismPlace::of(own, last.factor));
    let rest = forces_rest(problem, finite, place);
    match answer.status {
        Status::NoEquilibrium if answer.motion.is_none() => Err("there is no mechanism under the dead load".into()),
        Status::Collapse | Status::NoEquilibrium if !rest => Ok(()),
        Status::Collapse | Status::NoEquilibrium => mechanism(problem, answer),
        Status::Unbounded => ray(problem, answer),
        _ => Ok(()),
    }
}

/// Returns an error if a residual with a bound for claims is above it or NaN.
fn small(name: &str, value: f64) -> Result<(), String> {
    let bound = tolerance(name).claim;
    if value <= bound || bound.is_infinite() { Ok(()) } else { Err(format!("{name} is {value:.2e}")) }
}

/// Returns an error unless the motion can continue without limit under the present forces.
fn mechanism(problem: &PathProblem, answer: &PathAnswer) -> Result<(), String> {
    let Some(motion) = &answer.motion else { return Err("there is no mechanism".into()) };
    if problem.bodies.iter().zip(motion).any(|(body, q)| body.held && *q != [0.0; 3]) {
        return Err("the mechanism moves the ground".into());
    }
    small("path_flow", flow_residual(problem, &answer.state.force, motion))?;
    small("path_power", power_residual(problem, &problem.load_steps[answer.load_step].loading, motion))?;
    small("path_forces", leaves_forces(problem, &answer.state, motion))?;
    if answer.status == Status::NoEquilibrium && answer.state.factor >= 1.0 - 1e-9 {
        return Err("all of the dead load is carried".into());
    }
    Ok(())
}

/// Returns an error unless rates of forces carry any amount of the load.
fn ray(problem: &PathProblem, answer: &PathAnswer) -> Result<(), String> {
    let Some(ray) = &answer.ray else { return Err("there is no ray".into()) };
    small("path_ray", ray_residual(problem, &problem.load_steps[answer.load_step].loading, ray))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::path::newton::NewtonPath;
    use voussoir_core::law::Facet;
    use voussoir_core::limit::Counters;
    use voussoir_core::model::geometry::Vec2;
    use voussoir_core::path::{
        Attachment, Contact, LoadStep, LoadStepEnd, Loading, PathBody, PathSettings, PathSolver, Period, PointLaw,
        Sliding, Unobserved,
    };

    /// A rigid block of 1 kg on two compliant points of the ground, μ = 0.5, under its weight of 10 N and then a force
    /// λ f at its pole; the height of the pole is half the distance of the points.
    fn pushed(force: Vec2) -> PathProblem {
        let body = |held, pole, mass| PathBody {
            members: vec![0],
            pole,
            held,
            mass,
            points: vec![],
            flexibility: None,
            inelastic: None,
        };
        let [left, right] = Facet::friction(0.5, 0.0, 0.0);
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
            compliance: [1e-6, 2e-6],
            sliding: Sliding::middle(0.0),
        };
        let load_step = |stage, gravity, loading, end| LoadStep {
            stage,
            gravity,
            loading,
            start: 0.0,
            end,
            period: Period::default(),
        };
        let pole = Vec2::new(0.0, 0.5);
        let live = Loading { forces: vec![(1, None, pole, force)], ..Loading::default() };
        let dead = Loading { acceleration: Vec2::new(0.0, -10.0), ..Loading::default() };
        PathProblem {
            bodies: vec![body(true, Vec2::zeros(), 0.0), body(false, pole, 1.0)],
            body_of: vec![0, 1],
            contacts: vec![contact(-1.0), contact(1.0)],
            load_steps: vec![
                load_step(0, true, dead, LoadStepEnd::Factor(1.0)),
                load_step(1, false, live, LoadStepEnd::Collapse(f64::INFINITY)),
            ],
            length: 2.0,
            span: 2.0,
            counters: Counters::new(),
            width: 1.0,
        }
    }

    fn answer(problem: &PathProblem) -> PathAnswer {
        let settings = PathSettings {
            finite: false,
            tolerance: 1e-9,
            stop_displacement: None,
            stop_factor: None,
            continuation: None,
            stages: Vec::new(),
        };
        NewtonPath {}.trace(problem, &settings, &mut Unobserved)
    }

    /// Changes an answer and checks that the result is a stall that names the error and claims nothing.
    fn refused(problem: &PathProblem, honest: &PathAnswer, says: &str, change: impl Fn(&mut PathAnswer)) {
        let mut tampered = honest.clone();
        change(&mut tampered);
        let found = confirmed(problem, false, tampered);
        assert_eq!(found.status, Status::Stalled, "{says}");
        assert!(found.factor.is_none() && found.motion.is_none() && found.ray.is_none());
        assert!(found.notes.last().is_some_and(|note| note.contains(says)), "{says}: {:?}", found.notes);
    }

    #[test]
    fn a_tampered_collapse_is_refused() {
        let problem = pushed(Vec2::new(1.0, 0.0));
        let honest = answer(&problem);
        assert_eq!(honest.status, Status::Collapse, "{:?}", honest.notes);
        assert!(honest.factor.is_some_and(|factor| (factor - 5.0).abs() < 1e-8), "{:?}", honest.factor);
        assert_eq!(confirmed(&problem, false, honest.clone()).status, Status::Collapse);
        refused(&problem, &honest, "not that of the state", |a| a.factor = Some(5.001));
        refused(&problem, &honest, "not that of the state", |a| a.factor = Some(f64::NAN));
        refused(&problem, &honest, "path_equilibrium", |a| {
            a.factor = Some(5.001);
            a.state.factor = 5.001;
        });
        refused(&problem, &honest, "path_equilibrium", |a| a.state.force[0][0] *= 1.001);
        refused(&problem, &honest, "path_equilibrium", |a| a.state.force[0][0] = f64::NAN);
        refused(&problem, &honest, "path_kinematics", |a| a.state.motion[1][1] *= 1.01);
        refused(&problem, &honest, "no mechanism", |a| a.motion = None);
        refused(&problem, &honest, "moves the ground", |a| a.motion.as_mut().expect("a motion")[0][0] = 1.0);
        refused(&problem, &honest, "path_power", |a| {
            a.motion.as_mut().expect("a motion").iter_mut().flatten().for_each(|v| *v *= 1.01);
        });
        // Lifts points that are in contact.
        refused(&problem, &honest, "path_flow", |a| a.motion.as_mut().expect("a motion")[1][1] += 0.1);
    }

    #[test]
    fn a_tampered_ray_is_refused() {
        let problem = pushed(Vec2::new(0.0, -1.0));
        let honest = answer(&problem);
        assert_eq!(honest.status, Status::Unbounded, "{:?}", honest.notes);
        assert_eq!(confirmed(&problem, false, honest.clone()).status, Status::Unbounded);
        refused(&problem, &honest, "no ray", |a| a.ray = None);
        // Does not carry the load; carries it by more than friction allows.
        refused(&problem, &honest, "path_ray", |a| a.ray.as_mut().expect("a ray")[0][0] *= 1.01);
        refused(&problem, &honest, "path_ray", |a| {
            let ray = a.ray.as_mut().expect("a ray");
            (ray[0][1], ray[1][1]) = (1.0, -1.0);
        });
    }

    /// A collapse presented as a failure of the dead load, which is fully carried.
    #[test]
    fn another_status_is_refused() {
        let problem = pushed(Vec2::new(1.0, 0.0));
        let honest = answer(&problem);
        refused(&problem, &honest, "all of the dead load", |a| a.status = Status::NoEquilibrium);
        refused(&problem, &honest, "no ray", |a| a.status = Status::Unbounded);
    }
}
