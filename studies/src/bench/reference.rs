//! A reference that no contestant computes: extrapolated from two meshes that are fine at the joints' ends.
//!
//! λ₁ and λ₂ are the load factors on meshes whose elements at the joints' ends have the sizes h₁ > h₂ = ρ h₁. An error of order p
//! gives λ = λ₂ + (λ₂ − λ₁) ρ^p/(1 − ρ^p). The observed order is between 1 and 2, so the reference takes p = 3/2, and its band
//! contains the values of p = 1 and p = 2.

use super::contestants::with;
use super::measured::{Measurement, Source};
use voussoir_core::plugin::{PluginKind, card};
use voussoir_study::cases::solve_case;
use voussoir_study::solve::knobs::{mesh_at_hinges, smaller_steps};
use voussoir_study::study::Case;

/// Elements of the two meshes, divided by the numbers in the mesh of an error estimate.
const MESHES: [f64; 2] = [1.0, 1.5];
/// Length of the steps, divided by the length in the study.
const STEPS: f64 = 0.25;

/// Extrapolates the load factor of the fastest path solver that has a certified result for the unchanged case.
pub(super) fn extrapolated<'a>(case: &Case, measured: impl Iterator<Item = &'a Measurement>) -> Option<Source> {
    let whole = measured.filter(|own| own.rung.is_none() && own.factor().is_some());
    let paths = whole.filter_map(|own| Some((own, card(PluginKind::PathSolver, &own.result.solver)?)));
    let (_, card) = paths.min_by(|(a, _), (b, _)| a.seconds.total_cmp(&b.seconds))?;
    let solved = |times: f64| {
        let (sets, size) = mesh_at_hinges(case, times)?;
        let sets = sets.into_iter().chain(smaller_steps(case, card, STEPS)).collect();
        Some((solve_case(&with(case, card, sets).ok()?).collapse_load()?, size))
    };
    let ((coarse, first), (fine, second)) = (solved(MESHES[0])?, solved(MESHES[1])?);
    let share = second / first;
    let at = |order: f64| fine + (fine - coarse) * share.powf(order) / (1.0 - share.powf(order));
    let factor = at(1.5);
    let band = (at(1.0) - factor).abs().max((at(2.0) - factor).abs()) / factor.abs();
    let from = format!("{} extrapolated from two meshes finer at the joints' ends", card.tag);
    band.is_finite().then_some(Source { factor, from, band: Some(band) })
}
