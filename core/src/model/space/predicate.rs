//! The exact sign of the area of a triangle in a plane.
//!
//! Source: Shewchuk 1997, Discrete Comput. Geom. 18 (expansions of floating-point numbers).

use nalgebra::Vector2;

/// Relative rounding error of the plain determinant, (3 + 16 ε) ε with ε = 2⁻⁵³ (Shewchuk 1997, section 4.2).
const PLAIN_ERROR: f64 = (3.0 + 16.0 * HALF_ULP) * HALF_ULP;
/// 2⁻⁵³.
const HALF_ULP: f64 = f64::EPSILON / 2.0;

/// Returns twice the signed area of the triangle a, b, c \[m²\]; its sign is exact if no product underflows. It is positive
/// if the corners are anticlockwise.
pub(super) fn orientation(a: Vector2<f64>, b: Vector2<f64>, c: Vector2<f64>) -> f64 {
    let left = (a.x - c.x) * (b.y - c.y);
    let right = (a.y - c.y) * (b.x - c.x);
    let plain = left - right;
    if plain.abs() > PLAIN_ERROR * (left.abs() + right.abs()) { plain } else { exact(a, b, c) }
}

/// Returns the largest component of the exact expansion.
fn exact(a: Vector2<f64>, b: Vector2<f64>, c: Vector2<f64>) -> f64 {
    let mut sum = Expansion::default();
    sum.add_product(difference(a.x, c.x), difference(b.y, c.y));
    sum.add_product(difference(c.y, a.y), difference(b.x, c.x));
    sum.largest()
}

/// A sum of components that do not overlap, from the smallest. Two products of two pairs have sixteen components.
#[derive(Default)]
struct Expansion {
    components: [f64; 16],
    length: usize,
}

impl Expansion {
    /// Adds the product of two pairs.
    fn add_product(&mut self, one: [f64; 2], other: [f64; 2]) {
        for x in one {
            for y in other {
                let high = x * y;
                self.add(x.mul_add(y, -high));
                self.add(high);
            }
        }
    }

    /// Adds a number without error.
    fn add(&mut self, number: f64) {
        let mut carried = number;
        for component in &mut self.components[..self.length] {
            let [high, low] = sum(carried, *component);
            (carried, *component) = (high, low);
        }
        self.components[self.length] = carried;
        self.length += 1;
    }

    fn largest(&self) -> f64 {
        self.components.iter().rev().copied().find(|component| *component != 0.0).unwrap_or(0.0)
    }
}

/// Returns a + b as the rounded sum and its error.
fn sum(a: f64, b: f64) -> [f64; 2] {
    let high = a + b;
    let part = high - a;
    [high, (a - (high - part)) + (b - part)]
}

/// Returns a − b as the rounded difference and its error.
fn difference(a: f64, b: f64) -> [f64; 2] {
    sum(a, -b)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points on a line with a slope of one, moved by multiples of 2⁻⁵³: the signs are those of integer arithmetic.
    #[test]
    fn signs_near_a_line_are_those_of_integers() {
        let unit = HALF_ULP;
        let mut differs_from_plain = 0;
        for i in 0..64_i64 {
            for j in 0..64_i64 {
                let a = Vector2::new(0.5 + i as f64 * unit, 0.5 + j as f64 * unit);
                let (b, c) = (Vector2::new(12.0, 12.0), Vector2::new(24.0, 24.0));
                // The determinant is (c − a) × (b − a) with b and c on the diagonal: 12 (a.y − a.x).
                let sign = (j - i).signum() as f64;
                let found = orientation(a, b, c);
                assert_eq!(if found == 0.0 { 0.0 } else { found.signum() }, sign, "{i} {j}");
                let plain = (a.x - c.x) * (b.y - c.y) - (a.y - c.y) * (b.x - c.x);
                differs_from_plain += usize::from((plain > 0.0) != (sign > 0.0) || (plain < 0.0) != (sign < 0.0));
            }
        }
        assert!(differs_from_plain > 100, "{differs_from_plain}");
    }
}
