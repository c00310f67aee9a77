//! Checks that no certificate passes above its gate. The gates of docs/theory/verifying.md are repeated here,
//! independent of the program.

use voussoir::results::CaseResult;

/// Residuals of limit analysis that are zero except for rounding.
const ROUNDING: [&str; 10] = [
    "equilibrium",
    "strength",
    "fill",
    "flow",
    "ray_equilibrium",
    "ray_strength",
    "complementarity",
    "associated_flow",
    "associated_equilibrium",
    "associated_strength",
];
/// Differences of factors, with the tolerance of the study as gate.
const FACTORS: [&str; 4] = ["gap", "above_associated", "associated_gap", "interval_gap"];

/// Returns the greatest allowed residual of a result; `None` if the name is not known.
fn gate(name: &str, solver: &str, tolerance: f64) -> Option<f64> {
    Some(match name {
        _ if ROUNDING.contains(&name) => 1e-10,
        _ if FACTORS.contains(&name) => tolerance,
        "motion_scale" | "associated_motion_scale" => 1e-9,
        "settlement_supports" | "settlement_flow" | "settlement_gap" => 1e-8,
        "settlement_ray" => 1e-6,
        "path_equilibrium" | "path_ray" => 1e-9,
        "path_kinematics" | "path_strength" | "path_penetration" | "path_complementarity" | "path_law" => 1e-8,
        "path_inner_equilibrium" | "path_yield" | "path_dissipation" => 1e-8,
        "path_flow" => 1e-6,
        "path_energy" if solver == "event_path" => 1e-9,
        "path_energy" => 1e-3,
        _ => return None,
    })
}

/// Returns the residuals of a result above their gates, and unknown names; empty if the result does not claim to be
/// proved. `uncertain` is the rounding of very large strengths that the difference of the bounds may contain.
pub fn above_gates(result: &CaseResult, tolerance: f64, uncertain: f64) -> Vec<String> {
    if !result.certificate.passed {
        return Vec::new();
    }
    // Bounds in space come from an interior-point method.
    let tolerance = if result.proof.space.is_some() { tolerance.max(1e-8) } else { tolerance };
    let residuals = &result.certificate.residuals;
    let above = |(name, value): (&String, &f64)| {
        let fine = match (name.as_str(), gate(name, &result.solver, tolerance)) {
            // The work of the loads minus the dissipation.
            ("excess_power", _) => *value > 1e-13,
            ("gap" | "interval_gap", Some(gate)) => *value <= gate.max(uncertain),
            (_, Some(gate)) => *value <= gate,
            (_, None) => false,
        };
        (!fine).then(|| format!("{name} = {value:.2e} passed ({:?}, {})", result.status, result.solver))
    };
    let mut found: Vec<String> = residuals.iter().filter_map(above).collect();
    if residuals.is_empty() {
        found.push(format!("{:?} by {} without a residual", result.status, result.solver));
    }
    found
}
