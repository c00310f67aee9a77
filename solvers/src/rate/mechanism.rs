//! Mechanisms under constant forces as a linear program.
//!
//! Every rigid motion with
//!
//! ```text
//! G q̇ = −Σ γ_i d_i over the facets without slack,   γ ≥ 0,   p·q̇ = 1
//! ```
//!
//! is a solution rate with constant forces (the flow of limit analysis at a given field: Livesley 1978, Int. J. Numer.
//! Meth. Engng 12).

use crate::optimise::dense_simplex::{Dictionary, Equations};

/// Creates the program of the mechanisms over some motions. Variables are the motions forwards, the motions backwards,
/// then the multipliers γ. `rows`: contact points with their normal and tangential rows of G over the motions; `flows`:
/// contact points with a flow d each; `power`: p over the motions. `None` if the equations contradict each other.
pub fn mechanisms(rows: &[(usize, [Vec<f64>; 2])], flows: &[(usize, [f64; 2])], power: &[f64]) -> Option<Dictionary> {
    let equation = |motions: &[f64], flow: &dyn Fn(usize) -> f64| -> Vec<f64> {
        let backwards = motions.iter().map(|v| -v);
        motions.iter().copied().chain(backwards).chain((0..flows.len()).map(flow)).collect()
    };
    let mut equations: Vec<Vec<f64>> = Vec::with_capacity(2 * rows.len() + 1);
    for (c, own) in rows {
        for (i, row) in own.iter().enumerate() {
            equations.push(equation(row, &|f| if flows[f].0 == *c { flows[f].1[i] } else { 0.0 }));
        }
    }
    equations.push(equation(power, &|_| 0.0));
    let mut right = vec![0.0; equations.len()];
    right[2 * rows.len()] = 1.0;
    Equations { free: 0, variables: 2 * power.len() + flows.len(), rows: equations, right }.dictionary()
}
