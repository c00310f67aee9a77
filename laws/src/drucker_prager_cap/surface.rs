//! The yield surface of the cap model and the return to it, in the meridian plane (p, q).
//!
//! With x = |p − p_a| and D = d + p_a tan β the three surfaces are one convex gauge around (p_a, 0):
//!
//! ```text
//! cap          p ≥ p_a   √((x/R)² + (q/k)²) = D                       k = 1 + α − α/cos β
//! transition   p < p_a   √(x² + (q − κ D)²) = α D                     κ = 1 − α/cos β
//! shear        beyond    q + x tan β = D
//! ```
//!
//! The flow potentials √((x/R)² + (q/k)²) and √((x tan β)² + (q/k)²) give the flow
//!
//! ```text
//! Δε_q = η q / k²        |Δε_v| = w = η a x,   a = 1/R² (cap) or tan² β (shear, transition)
//! q = Q / (1 + 3 G η / k²)            x = |P − p_a(ε_v ± w)| − K w
//! ```
//!
//! (ε_v: compaction, growing on the cap, decreasing on the other side.) A trial point with P > p_a returns to the cap, one
//! with P < p_a to the other two surfaces. At the point where they meet, flow does not change the volume, and at the tip of
//! the cone the potential is smooth: no corner needs a separate equation.
//!
//! One unknown, η ≥ 0, remains. p_a is piecewise linear in ε_v, so w(η) is explicit in each piece. Let t be the factor that
//! moves (x, q) to the surface along its ray: ψ(η) = t − 1 is negative at η = 0 and tends to ∞. For a fixed surface x and q
//! are inverses of affine functions of η, and ψ is a concave mean of them on shear and cap. Newton's method from η = 0
//! increases to the root without overshooting; a bracket covers the other cases. (The rational form is the form of Moré for
//! the secular equation of trust regions: Moré & Sorensen 1983.)

use crate::meridian::{APEX, Returned, SHEAR};
use voussoir_core::law::{Effect, Isotropic, UpdateBranch, UpdateFailure};

/// On the surface between shear failure and cap.
const TRANSITION: UpdateBranch = UpdateBranch::new("transition", Effect::Yielding);
/// On the cap: compaction, crushing.
const CAP: UpdateBranch = UpdateBranch::new("cap", Effect::Yielding);

/// The search for η ends without a root.
const NO_RETURN: UpdateFailure =
    UpdateFailure::Law("the return to the surface of drucker_prager_cap did not meet its tolerance");

const ITERATIONS: usize = 200;

/// A piece of the hardening table: from `strain` on, p_a = `centre` + `slope` (ε_v − `strain`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// ε_v at the start of the piece.
    pub strain: f64,
    /// p_a at the start \[Pa\].
    pub centre: f64,
    /// dp_a/dε_v \[Pa\].
    pub slope: f64,
}

/// Change of p_a as the cap yields.
#[derive(Debug, Clone, Copy)]
pub struct Table<'a> {
    /// Pieces in order of `strain`; the first starts at −∞ with slope 0, the last has slope 0.
    pub pieces: &'a [Piece],
    /// True if flow on shear and transition, which loosens the material, goes back along the table. This is the case for
    /// hardening; crushed material does not recover.
    pub reversible: bool,
}

/// Yield surface and flow.
#[derive(Debug, Clone)]
pub struct Surface {
    /// K and G.
    pub elastic: Isotropic,
    /// tan β.
    pub friction: f64,
    /// d \[Pa\].
    pub cohesion: f64,
    /// R.
    pub eccentricity: f64,
    /// α.
    pub transition: f64,
    /// k.
    pub roundness: f64,
    /// κ.
    pub middle: f64,
    /// Point at which transition and shear meet: (x, q) / D.
    pub tangency: [f64; 2],
}

impl Table<'_> {
    /// Returns the piece at ε_v, its index, and p_a there. At the boundary of two pieces the next one in the direction of flow is
    /// used.
    fn piece(&self, compaction: f64, side: Side) -> (usize, f64) {
        let before = match side {
            Side::Cap => self.pieces.partition_point(|piece| piece.strain <= compaction),
            Side::Shear => self.pieces.partition_point(|piece| piece.strain < compaction),
        };
        let index = before.saturating_sub(1);
        let Piece { strain, centre, slope } = self.pieces[index];
        (index, if slope == 0.0 { centre } else { centre + slope * (compaction - strain) })
    }

    /// Returns dp_a/dε_v of a piece for flow on a side.
    fn slope(&self, index: usize, side: Side) -> f64 {
        if side == Side::Shear && !self.reversible { 0.0 } else { self.pieces[index].slope }
    }

    /// Returns the flow on a side from ε_v to the next piece, the index of that piece, and p_a there.
    fn next(&self, index: usize, side: Side, compaction: f64) -> Option<(f64, usize, f64)> {
        match side {
            Side::Cap => self.pieces.get(index + 1).map(|next| (next.strain - compaction, index + 1, next.centre)),
            Side::Shear if self.reversible && index > 0 => {
                let Piece { strain, centre, .. } = self.pieces[index];
                Some((compaction - strain, index - 1, centre))
            }
            Side::Shear => None,
        }
    }
}

/// The side of p_a on which a point returns.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Side {
    Cap,
    Shear,
}

/// A point during the iteration, with the derivatives of t.
#[derive(Debug, Clone, Copy)]
struct Gauge {
    /// t, greater than 1 inside the surface.
    factor: f64,
    /// ∂t/∂x, ∂t/∂q, ∂t/∂D.
    gradient: [f64; 3],
    branch: UpdateBranch,
}

/// x, q and D at some η, with the derivatives for Newton's method.
#[derive(Debug, Clone, Copy)]
struct Way {
    x: f64,
    q: f64,
    ratio: f64,
    w: f64,
    centre: f64,
    slope: f64,
    gauge: Gauge,
    /// 1 + η a (K + dp_a/dε_v).
    stiffening: f64,
    /// ∂w/∂η, ∂q/∂η, ∂t/∂η.
    rates: [f64; 3],
}

impl Surface {
    /// Creates the surface from β \[deg\], d, R and α.
    pub fn new(elastic: Isotropic, angle: f64, cohesion: f64, eccentricity: f64, transition: f64) -> Self {
        let (sine, cosine) = angle.to_radians().sin_cos();
        let friction = sine / cosine;
        let middle = 1.0 - transition / cosine;
        Surface {
            elastic,
            friction,
            cohesion,
            eccentricity,
            transition,
            roundness: 1.0 + transition - transition / cosine,
            middle,
            tangency: [transition * sine, middle + transition * cosine],
        }
    }

    /// Returns p_a over compaction from (ε_v, p_b) pairs in order of ε_v.
    pub fn pieces(&self, hardening: &[[f64; 2]]) -> Vec<Piece> {
        let centre = |strength: f64| self.centre_of(strength);
        let first = hardening.first().map_or(0.0, |[_, strength]| centre(*strength));
        let mut pieces = vec![Piece { strain: f64::NEG_INFINITY, centre: first, slope: 0.0 }];
        for (index, &[strain, strength]) in hardening.iter().enumerate() {
            let slope = match hardening.get(index + 1) {
                Some(&[next, stronger]) => (centre(stronger) - centre(strength)) / (next - strain),
                None => 0.0,
            };
            pieces.push(Piece { strain, centre: centre(strength), slope });
        }
        pieces
    }

    /// Returns p_a = (p_b − R d) / (1 + R tan β) \[Pa\].
    pub fn centre_of(&self, strength: f64) -> f64 {
        (strength - self.eccentricity * self.cohesion) / (1.0 + self.eccentricity * self.friction)
    }

    fn in_transition(&self, x: f64, q: f64) -> bool {
        x * self.tangency[1] <= self.tangency[0] * q && self.transition > 0.0
    }

    fn gauge(&self, side: Side, x: f64, q: f64, size: f64) -> Gauge {
        if x == 0.0 && q == 0.0 {
            return Gauge { factor: f64::INFINITY, gradient: [0.0; 3], branch: UpdateBranch::ELASTIC };
        }
        match side {
            Side::Cap => {
                let (along, across) = (x / self.eccentricity, q / self.roundness);
                let length = along.hypot(across);
                let factor = size / length;
                let by_x = -factor * (along / length) / length / self.eccentricity;
                let by_q = -factor * (across / length) / length / self.roundness;
                Gauge { factor, gradient: [by_x, by_q, 1.0 / length], branch: CAP }
            }
            Side::Shear if self.in_transition(x, q) => {
                // The larger root of (t x)² + (t q − κ D)² = (α D)², with x and q relative to the length of the ray.
                let ray = x.hypot(q);
                let (a, b) = (x / ray, q / ray);
                let (m, r) = (self.middle, self.transition);
                // (b m)² − (m² − r²) = r² − (a m)², positive on every ray to the arc.
                let reach = b * m + (r * r - a * a * m * m).max(0.0).sqrt();
                let factor = reach * size / ray;
                // D ∂F_t: from the differential of the same equation, divided by D².
                let (u, v) = (reach * a, reach * b - m);
                let slope = (u * a + v * b) * ray / size;
                let by_x = -factor * u / (slope * size);
                let by_q = -factor * v / (slope * size);
                let by_size = (m * v + r * r) / (slope * size);
                Gauge { factor, gradient: [by_x, by_q, by_size], branch: TRANSITION }
            }
            Side::Shear => {
                let length = q + self.friction * x;
                let factor = size / length;
                Gauge {
                    factor,
                    gradient: [-factor * self.friction / length, -factor / length, 1.0 / length],
                    branch: SHEAR,
                }
            }
        }
    }

    /// Returns the point and its derivatives at some η.
    fn way(&self, table: Table, side: Side, trial: [f64; 2], compaction: f64, eta: f64) -> Way {
        let [p_trial, q_trial] = trial;
        let sign = if side == Side::Cap { 1.0 } else { -1.0 };
        let a = match side {
            Side::Cap => 1.0 / (self.eccentricity * self.eccentricity),
            Side::Shear => self.friction * self.friction,
        };
        let bulk = self.elastic.bulk;
        let along = eta * a;
        let (mut index, mut centre) = table.piece(compaction, side);
        let mut done = 0.0;
        let (mut stiffening, mut x, mut w);
        loop {
            let slope = table.slope(index, side);
            let distance = sign * (p_trial - centre);
            stiffening = 1.0 + along * (bulk + slope);
            x = (distance + slope * done) / stiffening;
            w = along * x;
            match table.next(index, side, compaction) {
                Some((end, next, there)) if w > end && end.is_finite() => {
                    (done, index, centre) = (end, next, there);
                }
                _ => break,
            }
        }
        let slope = table.slope(index, side);
        let centre = centre + sign * slope * (w - done);
        let size = self.cohesion + centre * self.friction;
        let pull = 3.0 * self.elastic.shear / (self.roundness * self.roundness);
        let ratio = 1.0 / (1.0 + pull * eta);
        let q = ratio * q_trial;
        let gauge = self.gauge(side, x, q, size);
        let w_rate = x * a / stiffening;
        let x_rate = -(bulk + slope) * w_rate;
        let q_rate = -pull * q * ratio;
        let size_rate = self.friction * sign * slope * w_rate;
        let [by_x, by_q, by_size] = gauge.gradient;
        let rate = by_x * x_rate + by_q * q_rate + by_size * size_rate;
        Way { x, q, ratio, w, centre, slope, gauge, stiffening, rates: [w_rate, q_rate, rate] }
    }

    /// Computes the return of a trial point (P, Q) at some ε_v of the table to the surface; `None` if it is elastic.
    pub fn project(&self, table: Table, trial: [f64; 2], compaction: f64) -> Result<Option<Returned>, UpdateFailure> {
        let side = if trial[0] >= table.piece(compaction, Side::Cap).1 { Side::Cap } else { Side::Shear };
        let at = |eta: f64| self.way(table, side, trial, compaction, eta);
        let start = at(0.0);
        if start.gauge.factor >= 1.0 {
            return Ok(None);
        }
        // Dilatancy may weaken the surface faster than the stress falls at first: then Newton has no step, and the search starts at
        // the η that halves the shear stress approximately.
        let unit = self.roundness * self.roundness / (3.0 * self.elastic.shear);
        let (mut eta, mut low, mut high, mut way) = (0.0, 0.0, f64::INFINITY, start);
        for _ in 0..ITERATIONS {
            let psi = way.gauge.factor - 1.0;
            if psi.abs() <= 4.0 * f64::EPSILON {
                return Ok(Some(self.finished(side, eta, &way)));
            }
            if psi < 0.0 {
                low = eta
            } else {
                high = eta
            }
            let mut next = eta - psi / way.rates[2];
            if !(next > low && next < high) {
                next = if high.is_finite() { 0.5 * (low + high) } else { 4.0 * eta + unit };
            }
            if next <= low || next >= high || next == eta {
                // The bracket cannot be divided further in floating-point numbers.
                let met = psi.abs() <= 1e-12;
                return if met { Ok(Some(self.finished(side, eta, &way))) } else { Err(NO_RETURN) };
            }
            eta = next;
            way = at(eta);
        }
        Err(NO_RETURN)
    }

    fn finished(&self, side: Side, eta: f64, way: &Way) -> Returned {
        let sign = if side == Side::Cap { 1.0 } else { -1.0 };
        let along = match side {
            Side::Cap => eta / (self.eccentricity * self.eccentricity),
            Side::Shear => eta * self.friction * self.friction,
        };
        let bulk = self.elastic.bulk;
        let [by_x, by_q, by_size] = way.gauge.gradient;
        let [w_rate, q_rate, rate] = way.rates;
        // At fixed η: ∂w/∂P, ∂x/∂P, ∂D/∂P, ∂q/∂Q; then ∂η by ψ = 0.
        let w_by_p = along * sign / way.stiffening;
        let x_by_p = sign / way.stiffening;
        let size_by_p = self.friction * sign * way.slope * w_by_p;
        let eta_by_p = -(by_x * x_by_p + by_size * size_by_p) / rate;
        let eta_by_q = -by_q * way.ratio / rate;
        let w_by_p = w_by_p + w_rate * eta_by_p;
        let w_by_q = w_rate * eta_by_q;
        let size = self.cohesion + way.centre * self.friction;
        let tip = side == Side::Shear && way.q <= 1e-8 * size;
        Returned {
            pressure: way.centre + sign * way.x,
            ratio: way.ratio,
            compaction: sign * way.w,
            jacobian: [
                [1.0 - sign * bulk * w_by_p, -sign * bulk * w_by_q],
                [q_rate * eta_by_p, way.ratio + q_rate * eta_by_q],
            ],
            branch: if tip { APEX } else { way.gauge.branch },
        }
    }
}
