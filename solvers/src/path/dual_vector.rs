//! Multipliers of the certificate from the response of a structure.

use super::system::System;
use crate::linear::largest;
use voussoir_core::path::FarkasVector;

/// Forces per gap, in scaled units, that are rounding: along a mechanism forces rest.
const REST: f64 = 1e-10;
/// Motions per greatest motion that are rounding.
const STILL: f64 = 1e-10;

/// The multipliers that complete `alpha`, the gap rates of the active points, by the response `x` to them at a held load, in scaled
/// units. The active points stick in it, so that the structure is symmetric: y = −q̇, β = −ṙ.
pub(super) fn dual_vector(system: &System, x: &[f64], alpha: &[[f64; 2]]) -> FarkasVector {
    let (forces, motions) = x.split_at(2 * system.contacts);
    let unit = if largest(forces) <= REST * largest(alpha.as_flattened()) { 0.0 } else { system.units.force };
    let still = STILL * largest(motions);
    let moving: Vec<f64> = motions.iter().map(|v| if v.abs() <= still { 0.0 } else { *v }).collect();
    let negative = |force: &[f64]| [0, 1].map(|i| -force[i] * unit);
    FarkasVector {
        equilibrium: system.motions(&moving).into_iter().map(|own| own.map(|v| -v)).collect(),
        gap: forces.chunks_exact(2).map(negative).collect(),
    }
}
