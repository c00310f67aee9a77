//! Tolerances of the residuals of paths.

/// The tolerance of a residual.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerance {
    /// Name of the residual.
    pub name: &'static str,
    /// Tolerance in a result.
    pub result: f64,
    /// Tolerance for a solver that checks its own claim: infinite if the one state of the claim does not show the
    /// residual.
    pub claim: f64,
}

/// The tolerances of all residuals of paths that have a tolerance.
#[rustfmt::skip]
pub const TOLERANCES: &[Tolerance] = &[
    Tolerance { name: "path_equilibrium", result: 1e-9, claim: 1e-8 },
    Tolerance { name: "path_kinematics", result: 1e-8, claim: 1e-7 },
    Tolerance { name: "path_strength", result: 1e-8, claim: 1e-8 },
    Tolerance { name: "path_penetration", result: 1e-8, claim: 1e-7 },
    Tolerance { name: "path_complementarity", result: 1e-8, claim: 1e-7 },
    Tolerance { name: "path_law", result: 1e-8, claim: 1e-8 },
    Tolerance { name: "path_inner_equilibrium", result: 1e-8, claim: 1e-8 },
    Tolerance { name: "path_yield", result: 1e-8, claim: 1e-8 },
    Tolerance { name: "path_forces", result: 1e-6, claim: 1e-6 },
    Tolerance { name: "path_dissipation", result: 1e-8, claim: f64::INFINITY },
    Tolerance { name: "path_energy", result: 1e-3, claim: f64::INFINITY },
    Tolerance { name: "path_flow", result: 1e-6, claim: 1e-6 },
    Tolerance { name: "path_power", result: 1e-6, claim: 1e-6 },
    Tolerance { name: "path_ray", result: 1e-9, claim: 1e-6 },
];

/// Returns the tolerance of a residual: infinite if it has none.
pub fn tolerance(name: &str) -> Tolerance {
    let free = Tolerance { name: "", result: f64::INFINITY, claim: f64::INFINITY };
    TOLERANCES.iter().copied().find(|t| t.name == name).unwrap_or(free)
}
