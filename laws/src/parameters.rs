//! Keys that several laws share, described once.

use voussoir_core::plugin::{Parameter, Quantity, Range};

pub const FRICTION: Parameter = Parameter::number(
    "friction",
    Quantity::Ratio,
    Range::NON_NEGATIVE,
    "coefficient of friction μ; or give friction_angle",
)
.optional("friction_angle is given");

pub const FRICTION_ANGLE: Parameter = Parameter::number(
    "friction_angle",
    Quantity::Degrees,
    Range::new(0.0, false, 90.0, true),
    "angle of friction, μ = tan(angle)",
)
.optional("friction is given");

pub const DILATANCY_ANGLE: Parameter = Parameter::number(
    "dilatancy_angle",
    Quantity::Degrees,
    Range::new(0.0, false, 90.0, true),
    "angle by which slip opens the joint, at most the angle of friction",
);

pub const NORMAL_STIFFNESS: Parameter = Parameter::number(
    "normal_stiffness",
    Quantity::Stiffness,
    Range::POSITIVE,
    "stiffness of the joint itself against closing",
)
.optional("the joint itself is stiff");

pub const SHEAR_STIFFNESS: Parameter = Parameter::number(
    "shear_stiffness",
    Quantity::Stiffness,
    Range::POSITIVE,
    "stiffness of the joint itself against slip",
)
.optional("the joint itself is stiff");

/// μ from whichever of the two keys is given.
pub fn friction(friction: Option<f64>, friction_angle: Option<f64>) -> f64 {
    friction.or(friction_angle.map(tangent)).unwrap_or(0.0)
}

/// tan of an angle in degrees.
pub fn tangent(degrees: f64) -> f64 {
    degrees.to_radians().tan()
}

/// \[k_n, k_t\] where either is given; a stiff direction is ∞.
pub fn stiffness(normal: Option<f64>, shear: Option<f64>) -> Option<[f64; 2]> {
    (normal.is_some() || shear.is_some()).then(|| [normal.unwrap_or(f64::INFINITY), shear.unwrap_or(f64::INFINITY)])
}

/// Exactly one of `friction` and `friction_angle`, and dilatancy at most friction.
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
