//! Joints whose law gives tractions from gaps: load steps with small displacements against the results of facets.

use crate::path::newton::NewtonPath;
use crate::path::two_blocks::{
    STIFFNESS, assert_close, block, block_on, live, pushed_at, settings, stage, strategies, traced,
};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use voussoir_core::law::{
    BatchFailure, Facet, FacetResponse, InterfaceResponse, PointContext, TractionPoint, UpdateBranch, UpdateFailure,
};
use voussoir_core::limit::Status;
use voussoir_core::path::{LoadStepEnd, Loading, PathAnswer, PathProblem, PathSolver, PointLaw, Unobserved};

/// The block on two corners whose law holds the stiffness of the joint.
fn responding(friction: f64, pushed: Loading) -> PathProblem {
    let mut problem = block(friction, pushed);
    let facets = problem.contacts[0].law.facets().expect("facets").to_vec();
    let law: PointLaw = PointLaw::Response(Arc::new(FacetResponse::new(facets, [STIFFNESS; 2]).expect("a law")));
    for contact in &mut problem.contacts {
        (contact.law, contact.compliance) = (law.clone(), [0.0; 2]);
    }
    problem
}

fn stepped(problem: &PathProblem) -> PathAnswer {
    NewtonPath {}.trace(problem, &settings(None), &mut Unobserved)
}

/// Before any slip the law is that of two springs: the same forces as with facets and compliance.
#[test]
fn a_law_with_stiffness_is_a_spring() {
    let until = |mut problem: PathProblem| {
        problem.load_steps[1].end = LoadStepEnd::Factor(0.2);
        problem
    };
    let one = traced(&until(block(0.3, pushed_at(0.4))));
    let other = stepped(&until(responding(0.3, pushed_at(0.4))));
    assert_eq!(other.status, Status::Stands, "{:?}", other.notes);
    for (a, b) in one.state.force.iter().flatten().zip(other.state.force.iter().flatten()) {
        assert_close(*b, *a, 1e-9);
    }
}

/// A block slides at λ = μ W.
#[test]
fn a_block_slides_at_its_friction() {
    let answer = stepped(&responding(0.3, pushed_at(0.1)));
    assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
    assert_close(answer.factor.expect("a factor"), 0.3, 1e-7);
}

/// A block tips at λ = W b/(2 h).
#[test]
fn a_block_tips_at_half_its_width() {
    let answer = stepped(&responding(0.9, pushed_at(0.8)));
    assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
    assert_close(answer.factor.expect("a factor"), 0.625, 1e-7);
}

/// All strategies slide the block at λ = μ W.
#[test]
fn strategies_agree_on_the_collapse_load() {
    for strategy in strategies() {
        let answer = NewtonPath {}.trace(&responding(0.3, pushed_at(0.1)), &settings(strategy), &mut Unobserved);
        assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
        assert_close(answer.factor.expect("a factor"), 0.3, 1e-7);
    }
}

/// The memory of the law is the slip: on the way back the corner keeps the force t = μ (W/2 − λ h) − λ/2.
#[test]
fn a_law_remembers_its_slip() {
    let (friction, height, factor) = (0.3, 0.4, 0.28);
    let mut problem = responding(friction, pushed_at(height));
    problem.load_steps[1].end = LoadStepEnd::Factor(factor);
    let mut back = pushed_at(height);
    back.forces[0].3 *= -1.0;
    problem.load_steps.push(stage(2, back, LoadStepEnd::Factor(factor)));
    let answer = stepped(&problem);
    assert_eq!(answer.status, Status::Stands, "{:?}", answer.notes);
    let kept = friction * (0.5 - factor * height) - 0.5 * factor;
    assert_close(answer.state.force[0][1], kept, 2e-3 * factor);
}

/// A tensile strength f on the area A of two points holds the block down to λ = W + 2 f A.
#[test]
fn a_tensile_strength_holds_a_lifted_block() {
    let strength = 0.2;
    let [left, right] = Facet::friction(2.0, 2.0 * strength, 0.0);
    let law = FacetResponse::new(vec![Facet::opening(strength), left, right], [STIFFNESS; 2]).expect("a law");
    let law: PointLaw = PointLaw::Response(Arc::new(law));
    let mut lifted = pushed_at(0.0);
    (lifted.forces[0].2, lifted.forces[0].3) = ([0.5, 0.5].into(), [0.0, 1.0].into());
    let mut problem = responding(2.0, lifted);
    problem.contacts.iter_mut().for_each(|contact| contact.law = law.clone());
    let answer = stepped(&problem);
    assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
    assert_close(answer.factor.expect("a factor"), 1.0 + 2.0 * strength, 1e-7);
}

/// No tension, elastic shear: a law that names no branches and whose tangent is found by central differences.
#[derive(Debug)]
struct NoTension;

impl InterfaceResponse for NoTension {
    fn state_size(&self) -> usize {
        0
    }

    fn initial_state(&self, _: &mut [f64]) {}

    fn state_names(&self) -> &'static [&'static str] {
        &[]
    }

    fn respond_point(
        &self,
        gap: [f64; 2],
        _: &PointContext,
        _: &[f64],
        _: &mut [f64],
    ) -> Result<TractionPoint, UpdateFailure> {
        let pressed = |normal: f64| STIFFNESS * (-normal).max(0.0);
        let traction = [pressed(gap[0]), -STIFFNESS * gap[1]];
        let slope = (pressed(gap[0] + 1e-8) - pressed(gap[0] - 1e-8)) / 2e-8;
        let stored = (traction[0].powi(2) + traction[1].powi(2)) / (2.0 * STIFFNESS);
        let tangent = [[slope, 0.0], [0.0, -STIFFNESS]];
        Ok(TractionPoint { traction, tangent, branch: UpdateBranch::ELASTIC, stored, dissipated: 0.0, supplied: 0.0 })
    }
}

/// A block on a law that names no branches tips at λ = W b/(2 h) as well: its points open one after the other, at events.
#[test]
fn openings_of_a_law_without_branches_are_events() {
    let law: PointLaw = PointLaw::Response(Arc::new(NoTension));
    let mut problem = block_on(&[0.0, 0.25, 0.5, 0.75, 1.0], &law, live(pushed_at(0.8)));
    problem.contacts.iter_mut().for_each(|contact| contact.compliance = [0.0; 2]);
    let answer = stepped(&problem);
    assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
    assert_close(answer.factor.expect("a factor"), 0.625, 1e-9);
    assert!(answer.counters["newton_iterations"] < 500, "{:?}", answer.counters);
}

/// A law that counts how often it is asked, and for how many points.
#[derive(Debug, Default)]
struct Counted {
    questions: AtomicU64,
    points: AtomicU64,
}

impl Counted {
    fn count(&self, points: usize) {
        self.questions.fetch_add(1, Ordering::Relaxed);
        self.points.fetch_add(points as u64, Ordering::Relaxed);
    }
}

impl InterfaceResponse for Counted {
    fn state_size(&self) -> usize {
        0
    }

    fn initial_state(&self, _: &mut [f64]) {}

    fn state_names(&self) -> &'static [&'static str] {
        &[]
    }

    fn respond_point(
        &self,
        gap: [f64; 2],
        context: &PointContext,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<TractionPoint, UpdateFailure> {
        self.count(1);
        NoTension.respond_point(gap, context, old, new)
    }

    fn respond(
        &self,
        gaps: &[[f64; 2]],
        contexts: &[PointContext],
        old: &[f64],
        new: &mut [f64],
        points: &mut [TractionPoint],
    ) -> Result<(), BatchFailure> {
        self.count(gaps.len());
        NoTension.respond(gaps, contexts, old, new, points)
    }
}

/// A law is asked for several points at once and not often, by the solver and by the certificate: a law of another language pays for
/// every question.
#[test]
fn a_law_is_asked_for_several_points_at_once() {
    let counted = Arc::new(Counted::default());
    let law: PointLaw = PointLaw::Response(counted.clone());
    let mut problem = block_on(&[0.0, 0.25, 0.5, 0.75, 1.0], &law, live(pushed_at(0.8)));
    problem.contacts.iter_mut().for_each(|contact| contact.compliance = [0.0; 2]);
    let answer = stepped(&problem);
    assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
    let [questions, points] = [&counted.questions, &counted.points].map(|count| count.load(Ordering::Relaxed));
    let iterations = answer.counters["newton_iterations"];
    assert!(
        points > 2 * questions && questions < 10 * iterations,
        "{points} points in {questions} questions, {iterations} iterations"
    );
}
