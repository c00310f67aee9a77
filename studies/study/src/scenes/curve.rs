//! The curves of intrados: points at equal arc length, normals, and the intersection of an offset curve with a plane. Reads
//! no configuration.
//!
//! Every curve is symmetric and convex. It is described by its right half, from the crown (x = 0) to the springing
//! (x = span/2, y = 0); the left half is the exact mirror image. The parameter of a point is the angle φ of its outward
//! normal (sin φ, cos φ), which is 0 at a smooth crown.

use std::f64::consts::{FRAC_PI_2, PI};
use voussoir_core::model::geometry::{Vec2, cross};

/// Right half of an intrados. Lengths in m, angles in radians.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Curve {
    /// Circular arc.
    Segmental { span: f64, rise: f64, radius: f64, half_angle: f64 },
    /// Half ellipse with semi-axes span/2 and rise.
    Elliptical { half_span: f64, rise: f64 },
    /// y = rise − slope²/(2 curvature), slope = curvature · x.
    Parabolic { span: f64, rise: f64, curvature: f64 },
    /// y = rise − c (cosh(x/c) − 1); `slope` = sinh(span/(2c)) is the slope at the springing.
    Catenary { span: f64, rise: f64, parameter: f64, slope: f64 },
    /// Arc of `radius` about (span/2 − radius, 0); `opening` is the angle from springing to apex.
    Pointed { span: f64, rise: f64, radius: f64, opening: f64 },
    /// Crown arc of radius `crown` up to the normal angle `turn`, then a side arc of radius `side`.
    ThreeCentred { span: f64, rise: f64, crown: f64, side: f64, turn: f64 },
}

impl Curve {
    /// R = (span²/4 + rise²)/(2 rise), half angle = 2 atan(2 rise/span).
    pub fn segmental(span: f64, rise: f64) -> Curve {
        Curve::Segmental {
            span,
            rise,
            radius: (span * span / 4.0 + rise * rise) / (2.0 * rise),
            half_angle: 2.0 * (2.0 * rise / span).atan(),
        }
    }

    /// Semi-axes span/2 and rise.
    pub fn elliptical(span: f64, rise: f64) -> Curve {
        Curve::Elliptical { half_span: span / 2.0, rise }
    }

    /// y = rise (1 − (2x/span)²).
    pub fn parabolic(span: f64, rise: f64) -> Curve {
        Curve::Parabolic { span, rise, curvature: 8.0 * rise / (span * span) }
    }

    /// c from rise = c (cosh(span/(2c)) − 1), that is sinh² w / w = 2 rise/span with w = span/(4c).
    pub fn catenary(span: f64, rise: f64) -> Curve {
        let ratio = 2.0 * rise / span;
        let w = increasing_root(0.0, ratio, |w| {
            let (s, c) = (w.sinh(), w.cosh());
            (s * s / w - ratio, s * (2.0 * c * w - s) / (w * w))
        });
        Curve::Catenary { span, rise, parameter: span / (4.0 * w), slope: (2.0 * w).sinh() }
    }

    /// R = (rise² + span²/4)/span, centres on the springing line.
    pub fn pointed(span: f64, rise: f64) -> Curve {
        let radius = (rise * rise + span * span / 4.0) / span;
        // R − span/2 = (rise − span/2)(rise + span/2)/span, in a form without cancellation.
        let centre = (rise - span / 2.0) * (rise + span / 2.0) / span;
        Curve::Pointed { span, rise, radius, opening: rise.atan2(centre) }
    }

    /// Side radius r = (2R rise − rise² − span²/4)/(2R − span); the side arcs are vertical at the springings.
    pub fn three_centred(span: f64, rise: f64, crown: f64) -> Curve {
        let side = (2.0 * crown * rise - rise * rise - span * span / 4.0) / (2.0 * crown - span);
        Curve::ThreeCentred { span, rise, crown, side, turn: (span / 2.0 - side).atan2(crown - rise) }
    }

    /// Returns the intrados point and the unit outward normal at the share `part / of` of the right half's length, measured from
    /// the crown. The apex of a pointed curve gets the normal of its symmetry axis.
    pub fn at_share(&self, part: usize, of: usize) -> (Vec2, Vec2) {
        if part == 0 {
            return (Vec2::new(0.0, self.rise()), Vec2::new(0.0, 1.0));
        }
        if part == of {
            return (Vec2::new(self.half_span(), 0.0), self.springing_normal());
        }
        let share = part as f64 / of as f64;
        let at = |angle: f64| (self.point(angle), direction(angle));
        match *self {
            Curve::Segmental { half_angle, .. } => at(half_angle * share),
            Curve::Elliptical { half_span, rise } => {
                let total = elliptic_length(half_span, rise, FRAC_PI_2);
                let eccentric = increasing_root(0.0, FRAC_PI_2, |t| {
                    (elliptic_length(half_span, rise, t) - total * share, elliptic_speed(half_span, rise, t))
                });
                let (sine, cosine) = eccentric.sin_cos();
                let normal = Vec2::new(rise * sine, half_span * cosine).normalize();
                (Vec2::new(half_span * sine, rise * cosine), normal)
            }
            Curve::Parabolic { span, rise, curvature } => {
                // Twice the curvature times the arc length from the crown.
                let length = |p: f64| p * p.hypot(1.0) + p.asinh();
                let end = 4.0 * rise / span;
                let target = length(end) * share;
                let slope = increasing_root(0.0, end, |p| (length(p) - target, 2.0 * p.hypot(1.0)));
                let point = Vec2::new(slope / curvature, rise - slope * slope / (2.0 * curvature));
                (point, Vec2::new(slope, 1.0) / slope.hypot(1.0))
            }
            Curve::Catenary { rise, parameter, slope, .. } => {
                // The arc length from the crown is c sinh(x/c).
                let slope = slope * share;
                let drop = parameter * slope * slope / (slope.hypot(1.0) + 1.0);
                (Vec2::new(parameter * slope.asinh(), rise - drop), Vec2::new(slope, 1.0) / slope.hypot(1.0))
            }
            Curve::Pointed { opening, span, radius, .. } => {
                let above = opening * ((of - part) as f64 / of as f64);
                (side_arc(span, radius, above), Vec2::new(above.cos(), above.sin()))
            }
            Curve::ThreeCentred { span, crown, side, turn, .. } => {
                let (upper, lower) = (crown * turn, side * (FRAC_PI_2 - turn));
                let length = (upper + lower) * share;
                if length <= upper {
                    return at(length / crown);
                }
                let above = (upper + lower) * ((of - part) as f64 / of as f64) / side;
                (side_arc(span, side, above), Vec2::new(above.cos(), above.sin()))
            }
        }
    }

    /// Returns the point with normal angle φ, also beyond the springing.
    pub fn point(&self, angle: f64) -> Vec2 {
        match *self {
            Curve::Segmental { radius, rise, .. } => crown_arc(rise, radius, angle),
            Curve::Elliptical { half_span, rise } => {
                let (sine, cosine) = angle.sin_cos();
                let (x, y) = (half_span * sine, rise * cosine);
                Vec2::new(half_span * x, rise * y) / x.hypot(y)
            }
            Curve::Parabolic { rise, curvature, .. } => {
                let slope = angle.tan();
                Vec2::new(slope / curvature, rise - slope * slope / (2.0 * curvature))
            }
            Curve::Catenary { rise, parameter, .. } => {
                let slope = angle.tan();
                let drop = parameter * slope * slope / (slope.hypot(1.0) + 1.0);
                Vec2::new(parameter * slope.asinh(), rise - drop)
            }
            Curve::Pointed { span, radius, .. } => side_arc(span, radius, FRAC_PI_2 - angle),
            Curve::ThreeCentred { span, rise, crown, side, turn } => {
                if angle <= turn {
                    crown_arc(rise, crown, angle)
                } else {
                    side_arc(span, side, FRAC_PI_2 - angle)
                }
            }
        }
    }

    /// Returns the intersection of the curve offset outwards by `thickness` with the plane that leaves the right springing at
    /// `inclination` \[rad\] above the horizontal, rising outwards. `None` if there is no intersection on this side of the crown,
    /// or if the plane leaves the springing into the opening.
    ///
    /// Along the offset curve the distance from the plane changes at the rate −(ρ + thickness) sin(φ + inclination). So there is
    /// at most one such point with 0 < φ + inclination < π; the other intersection is behind the springing.
    pub fn offset_on_plane(&self, thickness: f64, inclination: f64) -> Option<Vec2> {
        let (sine, cosine) = inclination.sin_cos();
        let along = Vec2::new(cosine, sine);
        if self.springing_normal().dot(&along) <= 0.0 {
            return None;
        }
        let springing = Vec2::new(self.half_span(), 0.0);
        let offset = |angle: f64| self.point(angle) + direction(angle) * thickness - springing;
        let (first, last) = self.angles();
        let (low, high) = (first.max(-inclination), last.min(PI - inclination));
        // Negated, because the distance decreases as φ grows.
        let distance = |angle: f64| -cross(along, offset(angle));
        // A plane through the end of the range counts as an intersection there, within rounding.
        let slack = 1e-14 * (self.half_span() + self.rise() + thickness);
        if low >= high || distance(low) > slack || distance(high) < -slack {
            return None;
        }
        let angle = increasing_root(low, high, |angle| {
            let rate = (self.curvature_radius(angle) + thickness) * (angle + inclination).sin();
            (distance(angle), rate)
        });
        let reach = along.dot(&offset(angle));
        (reach > 0.0).then(|| springing + along * reach)
    }

    /// Returns the least and greatest normal angle of the right half, extended beyond the springing.
    fn angles(&self) -> (f64, f64) {
        match *self {
            Curve::Segmental { .. } | Curve::Elliptical { .. } | Curve::ThreeCentred { .. } => (0.0, PI),
            // The legs of these curves never become vertical.
            Curve::Parabolic { .. } | Curve::Catenary { .. } => (0.0, FRAC_PI_2 - 1e-9),
            Curve::Pointed { opening, .. } => (FRAC_PI_2 - opening, PI),
        }
    }

    /// Returns the radius of curvature at the normal angle φ.
    fn curvature_radius(&self, angle: f64) -> f64 {
        match *self {
            Curve::Segmental { radius, .. } | Curve::Pointed { radius, .. } => radius,
            Curve::Elliptical { half_span, rise } => {
                let (sine, cosine) = angle.sin_cos();
                (half_span * rise).powi(2) / (half_span * sine).hypot(rise * cosine).powi(3)
            }
            Curve::Parabolic { curvature, .. } => 1.0 / (curvature * angle.cos().powi(3)),
            Curve::Catenary { parameter, .. } => parameter / angle.cos().powi(2),
            Curve::ThreeCentred { crown, side, turn, .. } => {
                if angle <= turn {
                    crown
                } else {
                    side
                }
            }
        }
    }

    fn springing_normal(&self) -> Vec2 {
        match *self {
            Curve::Segmental { span, rise, .. } => {
                let half = span / 2.0;
                Vec2::new(2.0 * half * rise, (half - rise) * (half + rise)) / (half * half + rise * rise)
            }
            Curve::Elliptical { .. } | Curve::Pointed { .. } | Curve::ThreeCentred { .. } => Vec2::new(1.0, 0.0),
            Curve::Parabolic { span, rise, .. } => {
                let slope = 4.0 * rise / span;
                Vec2::new(slope, 1.0) / slope.hypot(1.0)
            }
            Curve::Catenary { slope, .. } => Vec2::new(slope, 1.0) / slope.hypot(1.0),
        }
    }

    /// Returns x of the right springing.
    pub fn half_span(&self) -> f64 {
        match *self {
            Curve::Elliptical { half_span, .. } => half_span,
            Curve::Segmental { span, .. }
            | Curve::Parabolic { span, .. }
            | Curve::Catenary { span, .. }
            | Curve::Pointed { span, .. }
            | Curve::ThreeCentred { span, .. } => span / 2.0,
        }
    }

    /// Returns y of the crown.
    pub fn rise(&self) -> f64 {
        match *self {
            Curve::Segmental { rise, .. }
            | Curve::Elliptical { rise, .. }
            | Curve::Parabolic { rise, .. }
            | Curve::Catenary { rise, .. }
            | Curve::Pointed { rise, .. }
            | Curve::ThreeCentred { rise, .. } => rise,
        }
    }
}

fn direction(angle: f64) -> Vec2 {
    Vec2::new(angle.sin(), angle.cos())
}

/// Returns the point on the circle through (0, rise) about (0, rise − radius), at `angle` from the vertical. The drop is
/// written with sin² to keep the digits of flat arcs.
fn crown_arc(rise: f64, radius: f64, angle: f64) -> Vec2 {
    Vec2::new(radius * angle.sin(), rise - 2.0 * radius * (angle / 2.0).sin().powi(2))
}

/// Returns the point on the circle through (span/2, 0) about (span/2 − radius, 0), at the angle `above` the horizontal.
fn side_arc(span: f64, radius: f64, above: f64) -> Vec2 {
    Vec2::new(span / 2.0 - 2.0 * radius * (above / 2.0).sin().powi(2), radius * above.sin())
}

/// ds/dt of the ellipse (a sin t, b cos t).
fn elliptic_speed(a: f64, b: f64, t: f64) -> f64 {
    (a * t.cos()).hypot(b * t.sin())
}

/// Arc length of the ellipse (a sin t, b cos t) from 0 to t: Gauss's rule on panels that are halved until the change is
/// below rounding.
fn elliptic_length(a: f64, b: f64, t: f64) -> f64 {
    fn panel(a: f64, b: f64, low: f64, high: f64) -> f64 {
        let (middle, half) = ((low + high) / 2.0, (high - low) / 2.0);
        let pair = |&(x, w): &(f64, f64)| {
            w * (elliptic_speed(a, b, middle - half * x) + elliptic_speed(a, b, middle + half * x))
        };
        half * GAUSS_10.iter().map(pair).sum::<f64>()
    }
    fn refine(a: f64, b: f64, ends: (f64, f64), whole: f64, scale: f64, depth: u32) -> f64 {
        let middle = (ends.0 + ends.1) / 2.0;
        let (left, right) = (panel(a, b, ends.0, middle), panel(a, b, middle, ends.1));
        if depth == 0 || (left + right - whole).abs() <= 2.0 * f64::EPSILON * scale {
            return left + right;
        }
        refine(a, b, (ends.0, middle), left, scale, depth - 1) + refine(a, b, (middle, ends.1), right, scale, depth - 1)
    }
    let whole = panel(a, b, 0.0, t);
    refine(a, b, (0.0, t), whole, whole, 40)
}

/// Gauss–Legendre nodes > 0 and weights of the rule with ten points on \[−1, 1\] (Abramowitz & Stegun
/// 1964, table 25.4).
const GAUSS_10: [(f64, f64); 5] = [
    (0.148_874_338_981_631_21, 0.295_524_224_714_752_87),
    (0.433_395_394_129_247_2, 0.269_266_719_309_996_35),
    (0.679_409_568_299_024_4, 0.219_086_362_515_982_04),
    (0.865_063_366_688_984_5, 0.149_451_349_150_580_6),
    (0.973_906_528_517_171_7, 0.066_671_344_308_688_14),
];

/// Root in \[low, high\] of an increasing function given with its slope: Newton's method, with bisection if a step would leave
/// the bracket. Ends when a step is below rounding.
pub(crate) fn increasing_root(low: f64, high: f64, f: impl Fn(f64) -> (f64, f64)) -> f64 {
    let (mut low, mut high) = (low, high);
    let mut x = (low + high) / 2.0;
    for _ in 0..200 {
        let (value, slope) = f(x);
        if value == 0.0 {
            return x;
        }
        if value < 0.0 {
            low = x;
        } else {
            high = x;
        }
        let newton = x - value / slope;
        let next = if newton >= low && newton <= high { newton } else { (low + high) / 2.0 };
        let done = (next - x).abs() <= f64::EPSILON * x.abs();
        x = next;
        if done {
            break;
        }
    }
    x
}
