//! Dual numbers, which carry the derivative along one direction, and plane vectors of them.

use crate::model::geometry::Vec2;
use std::ops::{Add, Mul, Neg, Sub};

/// A number with its derivative.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Dual {
    pub value: f64,
    pub rate: f64,
}

impl Dual {
    /// Creates a number with a derivative.
    pub fn new(value: f64, rate: f64) -> Self {
        Dual { value, rate }
    }

    /// Creates a constant.
    pub fn fixed(value: f64) -> Self {
        Dual { value, rate: 0.0 }
    }
}

impl Add for Dual {
    type Output = Dual;
    fn add(self, other: Dual) -> Dual {
        Dual::new(self.value + other.value, self.rate + other.rate)
    }
}

impl Sub for Dual {
    type Output = Dual;
    fn sub(self, other: Dual) -> Dual {
        Dual::new(self.value - other.value, self.rate - other.rate)
    }
}

impl Neg for Dual {
    type Output = Dual;
    fn neg(self) -> Dual {
        Dual::new(-self.value, -self.rate)
    }
}

impl Mul for Dual {
    type Output = Dual;
    fn mul(self, other: Dual) -> Dual {
        Dual::new(self.value * other.value, self.rate * other.value + self.value * other.rate)
    }
}

impl Mul<f64> for Dual {
    type Output = Dual;
    fn mul(self, factor: f64) -> Dual {
        Dual::new(self.value * factor, self.rate * factor)
    }
}

/// A plane vector with its derivative.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Dual2 {
    pub x: Dual,
    pub y: Dual,
}

impl Dual2 {
    /// Creates a constant vector.
    pub fn fixed(v: Vec2) -> Self {
        Dual2 { x: Dual::fixed(v.x), y: Dual::fixed(v.y) }
    }

    /// Returns the scalar product.
    pub fn dot(self, other: Dual2) -> Dual {
        self.x * other.x + self.y * other.y
    }

    /// Returns the moment of `other` at this position about the origin.
    pub fn cross(self, other: Dual2) -> Dual {
        self.x * other.y - self.y * other.x
    }

    /// Returns the vector rotated by an angle \[rad\].
    pub fn rotated(self, angle: Dual) -> Dual2 {
        let (s, c) = angle.value.sin_cos();
        let (sine, cosine) = (Dual::new(s, c * angle.rate), Dual::new(c, -s * angle.rate));
        Dual2 { x: self.x * cosine - self.y * sine, y: self.x * sine + self.y * cosine }
    }
}

impl Add for Dual2 {
    type Output = Dual2;
    fn add(self, other: Dual2) -> Dual2 {
        Dual2 { x: self.x + other.x, y: self.y + other.y }
    }
}

impl Sub for Dual2 {
    type Output = Dual2;
    fn sub(self, other: Dual2) -> Dual2 {
        Dual2 { x: self.x - other.x, y: self.y - other.y }
    }
}

impl Mul<Dual> for Dual2 {
    type Output = Dual2;
    fn mul(self, factor: Dual) -> Dual2 {
        Dual2 { x: self.x * factor, y: self.y * factor }
    }
}

impl Mul<f64> for Dual2 {
    type Output = Dual2;
    fn mul(self, factor: f64) -> Dual2 {
        Dual2 { x: self.x * factor, y: self.y * factor }
    }
}
