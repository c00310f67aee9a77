//! Keys that several laws share, each described once: the field of a law refers to them by `#[key(like = …)]`.

use voussoir_core::plugin::Keys;

/// Keys of joint laws.
#[derive(Debug, Keys)]
pub struct JointKeys {
    /// coefficient of friction μ; or give friction_angle
    #[key(unit = "-", range = ">= 0", optional = "friction_angle is given")]
    friction: Option<f64>,
    /// angle of friction, μ = tan(angle)
    #[key(unit = "deg", range = ">= 0, < 90", optional = "friction is given")]
    friction_angle: Option<f64>,
    /// angle by which slip opens the joint, at most the angle of friction
    #[key(unit = "deg", range = ">= 0, < 90")]
    dilatancy_angle: f64,
    /// stiffness of the joint itself against closing
    #[key(unit = "Pa/m", range = "> 0", optional = "the joint itself is stiff")]
    normal_stiffness: Option<f64>,
    /// stiffness of the joint itself against slip
    #[key(unit = "Pa/m", range = "> 0", optional = "the joint itself is stiff")]
    shear_stiffness: Option<f64>,
}

/// Keys of materials.
#[derive(Debug, Keys)]
pub struct MaterialKeys {
    /// Young's modulus E
    #[key(unit = "Pa", range = "> 0")]
    young_modulus: f64,
    /// Poisson's ratio ν
    #[key(unit = "-", range = "> -1, < 0.5")]
    poisson_ratio: f64,
    /// density, or specific weight such as "22 kN/m3"
    #[key(unit = "kg/m3", range = ">= 0")]
    density: f64,
}

/// Gaps \[m\] and tractions \[Pa\] of a joint without tensile strength with μ = 0.5, k_n = 1e10 Pa/m and k_t = 5e9 Pa/m: slipped,
/// moved back, opened, closed again.
pub const DRY_FRICTION: &[(&[f64], &[f64])] = &[
    (&[-1e-4, 4e-4], &[1e6, -5e5]),
    (&[-1e-4, 3.5e-4], &[1e6, -2.5e5]),
    (&[1e-5, 3.5e-4], &[0.0, 0.0]),
    (&[-1e-4, 3.5e-4], &[1e6, 0.0]),
];

/// Returns μ from the key that is given.
pub fn friction(friction: Option<f64>, friction_angle: Option<f64>) -> f64 {
    friction.or(friction_angle.map(tangent)).unwrap_or(0.0)
}

/// Returns the tangent of an angle in degrees.
pub fn tangent(degrees: f64) -> f64 {
    degrees.to_radians().tan()
}

/// Returns \[k_n, k_t\] if one of them is given; a rigid direction is ∞.
pub fn stiffness(normal: Option<f64>, shear: Option<f64>) -> Option<[f64; 2]> {
    (normal.is_some() || shear.is_some()).then(|| [normal.unwrap_or(f64::INFINITY), shear.unwrap_or(f64::INFINITY)])
}

/// Checks that exactly one of `friction` and `friction_angle` is given, and that dilatancy does not exceed friction.
pub fn validate_friction(
    coefficient: Option<f64>,
    angle: Option<f64>,
    dilatancy_angle: Option<f64>,
) -> Vec<(String, String)> {
    let mut wrong = Vec::new();
    match (coefficient, angle) {
        (None, None) => wrong.push((String::new(), "needs friction or friction_angle".into())),
        (Some(_), Some(_)) => {
            wrong.push(("friction_angle".into(), "given besides friction; give one of the two".into()));
        }
        _ => {}
    }
    if let Some(dilatancy) = dilatancy_angle
        && tangent(dilatancy) > friction(coefficient, angle) * (1.0 + 1e-12)
    {
        wrong.push((
            "dilatancy_angle".into(),
            format!(
                "{dilatancy} deg is more than the angle of friction, {:.6} deg: slip would create energy",
                friction(coefficient, angle).atan().to_degrees()
            ),
        ));
    }
    wrong
}
