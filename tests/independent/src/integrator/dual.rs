//! Numbers with their first derivatives.

use std::ops::{Add, Mul, Neg, Sub};

/// A value and its derivatives with respect to N variables.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dual<const N: usize> {
    /// The value.
    pub value: f64,
    /// The derivatives.
    pub slope: [f64; N],
}

impl<const N: usize> Dual<N> {
    /// A constant.
    pub fn constant(value: f64) -> Self {
        Dual { value, slope: [0.0; N] }
    }

    /// The variable with this index.
    pub fn variable(value: f64, index: usize) -> Self {
        let mut slope = [0.0; N];
        slope[index] = 1.0;
        Dual { value, slope }
    }

    /// A function of this number: its value and its derivative.
    pub fn map(self, value: f64, derivative: f64) -> Self {
        Dual { value, slope: self.slope.map(|s| s * derivative) }
    }

    fn product(self, other: Self) -> Self {
        self.map(self.value * other.value, other.value) + other.map(0.0, self.value)
    }

    /// The sine.
    pub fn sin(self) -> Self {
        self.map(self.value.sin(), self.value.cos())
    }

    /// The cosine.
    pub fn cos(self) -> Self {
        self.map(self.value.cos(), -self.value.sin())
    }

    /// The reciprocal.
    pub fn recip(self) -> Self {
        self.map(1.0 / self.value, -1.0 / (self.value * self.value))
    }

    /// The absolute value.
    pub fn abs(self) -> Self {
        self.map(self.value.abs(), if self.value < 0.0 { -1.0 } else { 1.0 })
    }
}

impl<const N: usize> Add for Dual<N> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Dual { value: self.value + other.value, slope: std::array::from_fn(|i| self.slope[i] + other.slope[i]) }
    }
}

impl<const N: usize> Sub for Dual<N> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl<const N: usize> Neg for Dual<N> {
    type Output = Self;
    fn neg(self) -> Self {
        self * -1.0
    }
}

impl<const N: usize> Mul for Dual<N> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        self.product(other)
    }
}

impl<const N: usize> Mul<f64> for Dual<N> {
    type Output = Self;
    fn mul(self, by: f64) -> Self {
        Dual { value: self.value * by, slope: self.slope.map(|s| s * by) }
    }
}
