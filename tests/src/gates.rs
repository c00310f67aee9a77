//! No certificate passes above its gate: the gates as docs/theory/verifying.md lists them, stated here once more, not asked of the
//! program.

use voussoir::results::CaseResult;

/// Residuals of limit analysis that should be rounding.
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
/// Differences of factors, which the tolerance of the study bounds.
const FACTORS: [&str; 4] = ["gap", "above_associated", "associated_gap", "interval_gap"];

/// How large a residual of a result may be; `None` of one that is not known.
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

/// Residuals of a result above their gates, and what is not known; nothing of a result that does not claim to be proven.
/// `uncertain`: what rounding of enormous strengths may add to the difference of the bounds.
pub fn above_gates(result: &CaseResult, tolerance: f64, uncertain: f64) -> Vec<String> {
    if !result.certificate.passed {
        return Vec::new();
    }
    let residuals = &result.certificate.residuals;
    let above = |(name, value): (&String, &f64)| {
        let fine = match (name.as_str(), gate(name, &result.solver, tolerance)) {
            // The work that the loads do beyond what is dissipated.
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
