//! The cone y₀ ≥ |(y₁, y₂)| in its Jordan algebra: spectrum, Nesterov–Todd scaling, length of a step.
//!
//! Each element has two eigenvalues y₀ ± |(y₁, y₂)| with idempotents (1, ±u)/2. The scaling point w of y and z
//! satisfies y = Q(w) z; the map Q(w) has the eigenvalues θ²a², θ²/a² along (1, ±u) and θ² across. Roots are formed from
//! eigenvalues and eigenvectors, because the difference 2 w wᵀ − det(w) J loses all digits of the small eigenvalues near
//! the boundary. Source: Nesterov and Todd (1997), *Math. Oper. Res.* 22, 1–42; Faraut and Korányi (1994).

/// An element of the algebra.
pub type Cone = [f64; 3];

/// The unit element.
pub const UNIT: Cone = [1.0, 0.0, 0.0];

/// Returns the product of two elements.
pub fn product(a: &Cone, b: &Cone) -> Cone {
    [inner(a, b), a[0] * b[1] + a[1] * b[0], a[0] * b[2] + a[2] * b[0]]
}

/// Returns a·b.
pub fn inner(a: &Cone, b: &Cone) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Returns the distance y₀ − |(y₁, y₂)| from the boundary: the smaller eigenvalue.
pub fn margin(y: &Cone) -> f64 {
    y[0] - y[1].hypot(y[2])
}

/// Returns a + s b.
pub fn plus(a: &Cone, s: f64, b: &Cone) -> Cone {
    [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]]
}

/// Returns the greatest length ≤ `most` for which y + length · d stays in the cone.
pub fn step_length(y: &Cone, d: &Cone, most: f64) -> f64 {
    // det(y + α d) = c + 2 b α + a α².
    let a = margin(d) * (d[0] + d[1].hypot(d[2]));
    let b = y[0] * d[0] - y[1] * d[1] - y[2] * d[2];
    let c = margin(y) * (y[0] + y[1].hypot(y[2]));
    let discriminant = b * b - a * c;
    if c <= 0.0 {
        return 0.0;
    }
    let root = if a < 0.0 || (b < 0.0 && discriminant >= 0.0) {
        // The first positive root, without cancellation.
        let far = discriminant.max(0.0).sqrt();
        if b <= 0.0 { c / (far - b) } else { (b + far) / -a }
    } else {
        f64::INFINITY
    };
    // Through the tip the roots are equal, and rounding may lose them.
    let tip = if d[0] < 0.0 { -y[0] / d[0] } else { f64::INFINITY };
    root.min(tip).min(most)
}

/// The scaling of a pair of interior elements: y = V² z, v = V⁻¹ y = V z.
#[derive(Debug, Clone, Copy)]
pub struct Scaling {
    /// Eigenvalues of V along (1, u), (1, −u) and across.
    values: [f64; 3],
    /// The unit vector u.
    direction: [f64; 2],
}

impl Scaling {
    /// Returns the scaling of a pair. `None` if one of them is not inside the cone.
    pub fn new(y: &Cone, z: &Cone) -> Option<Self> {
        let size = |x: &Cone| (margin(x) * (x[0] + x[1].hypot(x[2]))).sqrt();
        let (p, d) = (size(y), size(z));
        if !(p > 0.0 && d > 0.0 && p.is_finite() && d.is_finite()) {
            return None;
        }
        let (y, z) = (y.map(|x| x / p), z.map(|x| x / d));
        let gamma = (0.5 * (1.0 + inner(&y, &z))).sqrt();
        let w = [(y[0] + z[0]) / (2.0 * gamma), (y[1] - z[1]) / (2.0 * gamma), (y[2] - z[2]) / (2.0 * gamma)];
        let length = w[1].hypot(w[2]);
        let direction = if length > 0.0 { [w[1] / length, w[2] / length] } else { [1.0, 0.0] };
        // det w = 1: the eigenvalues are a and 1/a.
        let a = length + (1.0 + length * length).sqrt();
        let theta = (p / d).sqrt();
        (a.is_finite() && theta > 0.0).then_some(Scaling { values: [theta * a, theta / a, theta], direction })
    }

    /// Applies V (`power` 1) or V⁻¹ (`power` −1).
    fn apply(&self, values: [f64; 3], x: &Cone) -> Cone {
        let [u, v] = self.direction;
        let (along, across) = (u * x[1] + v * x[2], u * x[2] - v * x[1]);
        let (plus, minus) = (0.5 * values[0] * (x[0] + along), 0.5 * values[1] * (x[0] - along));
        let (along, across) = (plus - minus, values[2] * across);
        [plus + minus, u * along - v * across, v * along + u * across]
    }

    /// Returns V x.
    pub fn times(&self, x: &Cone) -> Cone {
        self.apply(self.values, x)
    }

    /// Returns V⁻¹ x.
    pub fn divide(&self, x: &Cone) -> Cone {
        self.apply(self.values.map(f64::recip), x)
    }

    /// Returns V² x.
    pub fn square(&self, x: &Cone) -> Cone {
        self.apply(self.values.map(|v| v * v), x)
    }

    /// Returns the columns of a root R with R Rᵀ = V².
    pub fn root(&self) -> [Cone; 3] {
        let [u, v] = self.direction;
        let [a, b, c] = self.values;
        let (a, b) = (a * std::f64::consts::FRAC_1_SQRT_2, b * std::f64::consts::FRAC_1_SQRT_2);
        [[a, a * u, a * v], [b, -b * u, -b * v], [0.0, -c * v, c * u]]
    }
}

/// Returns the x with v ∘ x = r. `v` is inside the cone.
pub fn quotient(v: &Cone, r: &Cone) -> Cone {
    let determinant = margin(v) * (v[0] + v[1].hypot(v[2]));
    let first = (v[0] * r[0] - v[1] * r[1] - v[2] * r[2]) / determinant;
    [first, (r[1] - first * v[1]) / v[0], (r[2] - first * v[2]) / v[0]]
}

#[cfg(test)]
mod tests {
    use super::*;

    const Y: Cone = [2.0, 1.2, -0.9];
    const Z: Cone = [0.7, -0.1, 0.5];

    fn near(a: &Cone, b: &Cone) -> bool {
        a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-13)
    }

    /// The scaling maps both elements to one: V⁻¹ y = V z, and V² z = y; the root's square is V².
    #[test]
    fn the_scaling_maps_a_pair_to_one_element() {
        let scaling = Scaling::new(&Y, &Z).unwrap();
        assert!(near(&scaling.divide(&Y), &scaling.times(&Z)));
        assert!(near(&scaling.square(&Z), &Y));
        let root = scaling.root();
        let sum = root.iter().fold([0.0; 3], |sum, column| plus(&sum, inner(column, &Z), column));
        assert!(near(&sum, &Y));
    }

    /// The quotient reverses the product.
    #[test]
    fn the_quotient_reverses_the_product() {
        assert!(near(&quotient(&Y, &product(&Y, &Z)), &Z));
    }

    /// A step of the returned length ends on the boundary, whatever the signs of the coefficients; a step inwards has
    /// no bound.
    #[test]
    fn the_step_ends_on_the_boundary() {
        for d in [[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 2.0, 0.5], [-1.0, -3.0, 2.0], [0.5, 1.0, 1.0]] {
            let length = step_length(&Y, &d, 1e9);
            assert!(margin(&plus(&Y, length, &d)).abs() < 1e-12, "{d:?} {length}");
        }
        assert_eq!(step_length(&Y, &Z, 7.0), 7.0);
    }
}
