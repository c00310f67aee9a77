//! Stability of the state at the end of a stage of an exact path, by its factorised equations.
//!
//! With small displacements K is the stiffness that connects the bodies with the modes of the contact points held. If
//! no point slides with non-associated flow, K is GᵀC⁻¹G, which is positive semidefinite: the state is stable unless
//! some motion has no stiffness. In a chain of joints every motion has stiffness if two points of each joint stick. If
//! slip is not associated, K is not symmetric, and its second-order work is examined
//! ([`stability`](crate::path::stability)). Points that slide, or are about to, may continue or stick: positive with
//! all of them free is sufficient, negative with all of them held is instability, otherwise nothing is proved.

use super::piece::factorisation::FactorisedModes;
use super::piece::point::Point;
use super::trace::Trace;
use crate::contact::mode::ContactMode;
use crate::path::stability::{SecondOrderWork, over_weak_points, work_by_responses};
use crate::path::system::Load;
use crate::settings::SETTINGS;
use nalgebra::DMatrix;
use voussoir_core::path::StageStability;
use voussoir_core::random::Random;

/// Number of iterations that find the softest motion.
const ITERATIONS: usize = 8;

/// Properties of the equations with the modes of all points held.
struct HeldModes {
    equations: FactorisedModes,
    work: Work,
}

/// Their second-order work.
enum Work {
    /// Semidefinite; true if it is positive definite.
    Symmetric(bool),
    Examined(SecondOrderWork),
}

impl HeldModes {
    /// Creates the equations with some modes; `None` if motions without stiffness make the result undecided.
    fn new(trace: &Trace, modes: Vec<ContactMode>) -> Option<Self> {
        let system = &trace.system;
        let associated = modes.iter().zip(&system.facets).all(|(mode, facets)| match (mode, facets) {
            (ContactMode::Facet(f), Some(facets)) => facets[*f as usize].flow == facets[*f as usize].normal,
            _ => true,
        });
        let equations = FactorisedModes::new(system, modes, false)?;
        let motions = system.size() - 2 * system.contacts;
        let respond = |wrenches: &DMatrix<f64>, refined: bool| {
            let columns = wrenches.column_iter().map(|wrench| equations.moved_by(system, wrench.as_slice(), refined));
            let columns: Option<Vec<Vec<f64>>> = columns.collect();
            columns.map(|columns| DMatrix::from_fn(motions, columns.len(), |i, j| columns[j][i]))
        };
        let work = if associated {
            // Only the order of magnitude of the flexibility of the softest motion matters.
            Work::Symmetric(is_stiff(motions, |wrenches| respond(wrenches, false))?)
        } else {
            Work::Examined(work_by_responses(motions, |wrenches| respond(wrenches, true))?)
        };
        Some(HeldModes { equations, work })
    }

    /// Returns true if second-order work is positive with all loads held.
    fn positive(&self) -> bool {
        match &self.work {
            Work::Symmetric(positive) => *positive,
            Work::Examined(work) => work.negative == 0,
        }
    }

    /// Returns true if second-order work is positive with the load point held; `None` if the load has no response.
    fn positive_under_control(&mut self, trace: &Trace, load: &Load) -> Option<bool> {
        let Work::Examined(work) = &self.work else { return Some(self.positive()) };
        self.equations.forget_load();
        let x = self.equations.load_rate(&trace.system, trace.state.load_step, load)?;
        let (forces, motions) = x.split_at(2 * trace.system.contacts);
        let dot = |own: &mut dyn Iterator<Item = &f64>, rates: &[f64]| -> f64 {
            own.zip(rates).map(|(own, rate)| own * rate).sum()
        };
        let yields = dot(&mut load.wrench.iter().flatten(), motions) + dot(&mut load.gap.iter().flatten(), forces);
        Some(work.stable_under_control(yields))
    }
}

/// Returns true if a semidefinite stiffness leaves no motion free, by the softest motion.
fn is_stiff(motions: usize, respond: impl Fn(&DMatrix<f64>) -> Option<DMatrix<f64>>) -> Option<bool> {
    let mut random = Random::from_state(7);
    let mut motion = DMatrix::from_fn(motions, 1, |_, _| random.signed());
    let mut flexibility = 0.0;
    for _ in 0..ITERATIONS {
        let size = motion.norm();
        if size == 0.0 {
            break;
        }
        motion = respond(&(motion / size))?;
        flexibility = motion.norm();
    }
    Some(flexibility < SETTINGS.soft())
}

/// Returns the stability of the present state under a completed load; supports may settle in the stage.
pub fn stage_stability(trace: &Trace, load: &Load) -> StageStability {
    let stage = trace.problem.load_steps[trace.state.load_step].stage;
    let (free, held) = (modes(trace, released), modes(trace, |_, _| ContactMode::Stick));
    if trace.associated && trace.factors.chain.as_ref().is_some_and(|chain| chain.is_stiff(&free)) {
        let stable = Some(true);
        return StageStability { stage, under_load: stable, under_control: stable, sufficient_only: false };
    }
    let same = free == held;
    let mut free = HeldModes::new(trace, free);
    let positive = |found: &Option<HeldModes>| found.as_ref().map(HeldModes::positive);
    // Positive with all of them free is sufficient.
    let enough = same || positive(&free) == Some(true);
    let mut stuck = if enough { None } else { HeldModes::new(trace, held) };
    let under_load = if same { positive(&free) } else { over_weak_points(positive(&free), positive(&stuck)) };
    let sufficient_only = free.as_ref().is_some_and(|free| matches!(free.work, Work::Examined(_)));
    let under_control = if load.settles || under_load == Some(true) {
        under_load
    } else {
        let controlled =
            |found: &mut Option<HeldModes>| found.as_mut().and_then(|found| found.positive_under_control(trace, load));
        over_weak_points(controlled(&mut free), controlled(&mut stuck))
    };
    StageStability { stage, under_load, under_control, sufficient_only }
}

/// Returns the modes of all points; points without a choice keep theirs.
fn modes(trace: &Trace, choose: impl Fn(&Point, f64) -> ContactMode) -> Vec<ContactMode> {
    let points = &trace.state.points;
    let largest = (0..points.len()).flat_map(|c| trace.state.force(c)).fold(0.0, |a: f64, r| a.max(r.abs()));
    let share = |c: usize| trace.state.force(c).into_iter().fold(0.0, |a: f64, r| a.max(r.abs())) / largest.max(1e-300);
    points.iter().enumerate().map(|(c, point)| point.settled().unwrap_or_else(|| choose(point, share(c)))).collect()
}

/// Returns the mode in which a weakly active point yields, with its force relative to the greatest.
fn released(point: &Point, force: f64) -> ContactMode {
    match (point.mode, point.active.first()) {
        (ContactMode::Stick, _) if point.apex && force <= SETTINGS.admissible => ContactMode::Open,
        (ContactMode::Stick, Some(facet)) => ContactMode::Facet(*facet as u8),
        (own, _) => own,
    }
}
