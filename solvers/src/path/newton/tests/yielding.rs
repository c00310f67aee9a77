//! Convergence of steps in which a block yields.

use crate::path::newton::model::control::Control;
use crate::path::newton::model::loads::StagedLoads;
use crate::path::newton::model::system::StepSystem;
use crate::path::newton::solve::step::solve_step;
use crate::path::two_blocks::body;
use std::sync::Arc;
use voussoir_core::elastic::{Condenser, MeshDensity};
use voussoir_core::law::{
    Effect, Elasticity, Isotropic, PlanarUpdate, Plane, StressPoint, StressUpdate, UpdateBranch, UpdateContext,
    UpdateFailure, Voigt, von_mises,
};
use voussoir_core::limit::Counters;
use voussoir_core::model::geometry::Vec2;
use voussoir_core::path::{
    Attachment, Contact, LoadStep, LoadStepEnd, Loading, PathProblem, Period, PointLaw, Sliding,
};

/// Von Mises with linear hardening H = E / 10, radial return (Simo & Hughes 1998, box 3.2).
#[derive(Debug)]
struct Mises {
    elastic: Isotropic,
    strength: f64,
    hardening: f64,
}

impl StressUpdate for Mises {
    fn state_size(&self) -> usize {
        7
    }

    fn initial_state(&self, state: &mut [f64]) {
        state.fill(0.0);
    }

    fn state_names(&self) -> &'static [&'static str] {
        &["xx [-]", "yy [-]", "zz [-]", "xy [-]", "yz [-]", "zx [-]", "cumulated [-]"]
    }

    fn update_point(
        &self,
        strain: &Voigt,
        _context: &UpdateContext,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<StressPoint, UpdateFailure> {
        new.copy_from_slice(old);
        let left: Voigt = std::array::from_fn(|i| strain[i] - old[i]);
        let (deviator, pressure) = self.elastic.split(&left);
        let trial = von_mises(&deviator);
        let excess = trial - self.strength - self.hardening * old[6];
        let (g, h) = (self.elastic.shear, self.hardening);
        let step = (excess / (3.0 * g + h)).max(0.0);
        let share = if step > 0.0 { 3.0 * g * step / trial } else { 0.0 };
        let mut point = StressPoint { tangent: self.elastic.tangent(), ..StressPoint::ZERO };
        point.stress = std::array::from_fn(|i| deviator[i] * (1.0 - share) - if i < 3 { pressure } else { 0.0 });
        let mises = trial - 3.0 * g * step;
        point.stored = mises * mises / (6.0 * g) + pressure * pressure / (2.0 * self.elastic.bulk);
        if step > 0.0 {
            point.branch = UpdateBranch::new("shear", Effect::Yielding);
            new[6] += step;
            (0..6).for_each(|i| new[i] += deviator[i] / trial * step * if i < 3 { 1.5 } else { 3.0 });
            point.dissipated = (trial - 3.0 * g * step) * step;
            point.tangent = Isotropic::stiffness(g * (1.0 - share), self.elastic.bulk);
            let turn = 9.0 * g * g * (step / trial - 1.0 / (3.0 * g + h));
            for i in 0..6 {
                (0..6).for_each(|j| point.tangent[i][j] += turn * deviator[i] * deviator[j] / (trial * trial));
            }
        }
        Ok(point)
    }
}

/// In a step in which a bent block yields, residuals fall quadratically to rounding, with small and with finite
/// displacements: the tangent is that of the whole iteration.
#[test]
fn steps_with_yielding_blocks_converge_quadratically() {
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Vec2::from);
    let places = [0.0, 0.5, 1.0].map(|t| Vec2::new(t, 0.0));
    let mut points = places.to_vec();
    points.push(Vec2::new(1.0, 1.0));
    let elasticity = Elasticity::isotropic(1e9, 0.2);
    let law = Mises { elastic: Isotropic::new(1e9, 0.2), strength: 1e6, hardening: 1e8 };
    let update = Arc::new(PlanarUpdate::new(Arc::new(law), Plane::Strain).unwrap());
    let mesh = MeshDensity { elements: [2, 2], order: 2, grading: [1.0; 2] };
    let inelastic = Condenser::new(Plane::Strain, 1.0).inelastic(&square, &elasticity, update, &mesh, &points).unwrap();
    let mut block = body(Vec2::new(0.5, 0.5), points, None, false);
    block.flexibility = Some(inelastic.flexibility());
    block.inelastic = Some(Arc::new(inelastic));
    let ground = body(Vec2::zeros(), Vec::new(), None, true);
    let contacts = places.iter().enumerate().map(|(slot, place)| Contact {
        joint: 0,
        position: *place,
        normal: Vec2::new(0.0, 1.0),
        tangent: Vec2::new(-1.0, 0.0),
        minus: Attachment { body: 0, slot: None },
        plus: Attachment { body: 1, slot: Some(slot) },
        area: 1.0,
        gap: 0.0,
        law: PointLaw::Bonded,
        compliance: [0.0; 2],
        sliding: Sliding::middle(0.0),
    });
    let loading =
        Loading { forces: vec![(1, Some(3), Vec2::new(1.0, 1.0), Vec2::new(3e5, -4e5))], ..Loading::default() };
    let load_step = LoadStep {
        stage: 0,
        gravity: false,
        loading: loading.clone(),
        start: 0.0,
        end: LoadStepEnd::Factor(1.0),
        period: Period::default(),
    };
    let problem = PathProblem {
        bodies: vec![ground, block],
        body_of: vec![0, 1],
        contacts: contacts.collect(),
        load_steps: vec![load_step],
        length: 1.0,
        span: 1.0,
        counters: Counters::new(),
        width: 1.0,
    };
    for finite in [false, true] {
        let mut system = StepSystem::new(&problem, finite).unwrap();
        system.load(0, StagedLoads::new(Vec::new(), &loading, 0.0));
        let start = system.undeformed();
        let (state, _) = solve_step(&mut system, &start, start.clone(), &Control::Factor(1.0)).unwrap();
        let yielding = state.blocks.iter().flatten().map(|inner| inner.linear.yielding).sum::<usize>();
        assert!(yielding > 10 && yielding < 36, "{yielding} of 36 points yield");
        let r = &system.report.residuals;
        let fast: Vec<&[f64]> = r.windows(2).filter(|p| p[0] < 0.1 && p[0] > 1e-6).collect();
        assert!(fast.len() >= 2, "{r:?}");
        assert!(fast.iter().all(|p| p[1] <= 3.0 * p[0] * p[0] + 1e-12), "finite {finite}: {r:?}");
        assert!(r[r.len() - 1] < 1e-11, "{r:?}");
    }
}
