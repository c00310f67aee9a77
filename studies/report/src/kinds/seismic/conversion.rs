//! The conversion of a mechanism to one degree of freedom, and its capacity curve.

use std::f64::consts::PI;
use voussoir_study::results::{DisplacementCapacity, Oscillator, acceleration_at};

/// Two velocities are equal if they differ by less than this share of the greatest velocity.
const EQUAL: f64 = 1e-6;

/// d_s*/d_u*.
const SECANT: f64 = 0.4;

/// A free block with its velocity in the mechanism.
#[derive(Debug, Clone, Copy)]
pub(super) struct MovingBlock {
    /// Mass \[kg\].
    pub mass: f64,
    /// Centroid \[m\].
    pub centroid: [f64; 2],
    /// \[v_x, v_y, ω\] at the centroid.
    pub velocity: [f64; 3],
}

impl MovingBlock {
    /// Returns the velocity of the rigid motion at the origin, with ω times a length.
    fn at_origin(&self, size: f64) -> [f64; 3] {
        let ([x, y], [u, v, turn]) = (self.centroid, self.velocity);
        [u + turn * y, v - turn * x, turn * size]
    }
}

/// Masses and horizontal virtual displacements of a mechanism, reduced to sums over its rigid parts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Participation {
    /// Mass of all blocks that are free \[kg\].
    pub free: f64,
    /// Mass of the blocks that move \[kg\].
    pub moving: f64,
    /// M* = (Σ m δ)²/Σ m δ² \[kg\].
    pub effective: f64,
}

impl Participation {
    /// Returns the sums over the rigid parts of a mechanism of the free blocks. Blocks that move as one rigid body are one
    /// part, so that the sums do not depend on the number of blocks. `size` is a length of the scene \[m\]. `None` if no mass moves
    /// horizontally.
    pub fn of(blocks: &[MovingBlock], size: f64) -> Option<Participation> {
        let motions: Vec<[f64; 3]> = blocks.iter().map(|block| block.at_origin(size)).collect();
        let greatest = motions.iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs()));
        let equal = |a: &[f64; 3], b: &[f64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() <= EQUAL * greatest);
        // Motion, mass and Σ m v_x of each part.
        let mut parts: Vec<([f64; 3], f64, f64)> = Vec::new();
        for (block, motion) in blocks.iter().zip(&motions) {
            let index = parts.iter().position(|part| equal(&part.0, motion)).unwrap_or_else(|| {
                parts.push((*motion, 0.0, 0.0));
                parts.len() - 1
            });
            parts[index].1 += block.mass;
            parts[index].2 += block.mass * block.velocity[0];
        }
        let free = blocks.iter().map(|block| block.mass).sum();
        parts.retain(|(motion, mass, _)| !equal(motion, &[0.0; 3]) && *mass > 0.0);
        let moving = parts.iter().map(|(_, mass, _)| mass).sum();
        let first: f64 = parts.iter().map(|(_, _, momentum)| momentum).sum();
        let second: f64 = parts.iter().map(|(_, mass, momentum)| momentum * momentum / mass).sum();
        let effective = first * first / second;
        (effective.is_finite() && effective > 0.0).then_some(Participation { free, moving, effective })
    }

    /// Returns the oscillator of a mechanism that starts at `multiplier` times the weights under `gravity` \[m/s²\].
    pub fn oscillator(&self, multiplier: f64, gravity: f64, confidence: f64, unique: Option<bool>) -> Oscillator {
        Oscillator {
            mass: self.effective,
            mass_fraction: self.effective / self.moving,
            activation_acceleration: self.acceleration(multiplier, gravity, confidence),
            unique_mechanism: unique,
        }
    }

    /// Returns a* = α g/(e* FC) \[m/s²\].
    fn acceleration(&self, multiplier: f64, gravity: f64, confidence: f64) -> f64 {
        multiplier * gravity * self.moving / (self.effective * confidence)
    }

    /// Converts a curve of (mean horizontal displacement of the free mass \[m\], multiplier) to \[d*, a*\]. With this
    /// displacement as the control point, δ_k = Σ m δ/Σ m, so that d* = d_k Σ m δ²/(δ_k Σ m δ) = d_k Σ m/M*.
    pub fn curve(&self, path: &[[f64; 2]], gravity: f64, confidence: f64) -> Vec<[f64; 2]> {
        let point = |&[d, multiplier]: &[f64; 2]| {
            [d * self.free / self.effective, self.acceleration(multiplier, gravity, confidence)]
        };
        path.iter().map(point).collect()
    }
}

/// Returns the displacements of a capacity curve for d_u* = `share` d₀*; `None` if the curve has no displacement or no
/// acceleration.
pub(super) fn displacement_capacity(curve: &[[f64; 2]], share: f64) -> Option<DisplacementCapacity> {
    let falls_to_zero = |pair: &[[f64; 2]]| pair[0][1] > 0.0 && pair[1][1] <= 0.0;
    let zero = curve.windows(2).find(|pair| falls_to_zero(pair)).map(|pair| {
        let [[d0, a0], [d1, a1]] = [pair[0], pair[1]];
        d0 + (d1 - d0) * a0 / (a0 - a1)
    });
    let zero_displacement = zero.or_else(|| Some(curve.last()?[0]))?;
    let ultimate_displacement = share * zero_displacement;
    let secant_displacement = SECANT * ultimate_displacement;
    let secant_acceleration = acceleration_at(curve, secant_displacement)?;
    if secant_displacement <= 0.0 || secant_acceleration <= 0.0 {
        return None;
    }
    Some(DisplacementCapacity {
        zero_displacement,
        reaches_zero: zero.is_some(),
        ultimate_displacement,
        secant_displacement,
        secant_acceleration,
        secant_period: 2.0 * PI * (secant_displacement / secant_acceleration).sqrt(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: f64, b: f64) {
        assert!((a - b).abs() <= 1e-12 * b.abs(), "{a} {b}");
    }

    fn block(mass: f64, centroid: [f64; 2], velocity: [f64; 3]) -> MovingBlock {
        MovingBlock { mass, centroid, velocity }
    }

    /// One rigid part has e* = 1, also if it consists of several blocks. Two equal parts, one of which moves twice as much,
    /// have M* = (1 + 2)²/(1 + 4) m = 1.8 m. A block at rest changes neither e* nor a*.
    #[test]
    fn participating_masses_by_hand() {
        // Three blocks turn about (0, 0): v = ω (−y, x).
        let turning = [1.0, 3.0, 5.0].map(|y| block(7.0, [-0.5, y], [-0.1 * y, -0.05, 0.1]));
        let one = Participation::of(&turning, 6.0).expect("blocks move");
        near(one.effective, 21.0);
        let own = one.oscillator(0.2, 10.0, 1.0, None);
        near(own.mass_fraction, 1.0);
        near(own.activation_acceleration, 2.0);
        assert_eq!(one.curve(&[[0.5, 0.1]], 10.0, 1.0), [[0.5, 1.0]]);

        let still = block(5.0, [0.0, 1.0], [0.0; 3]);
        let slides = |velocity: f64| block(5.0, [0.0, 1.0], [velocity, 0.0, 0.0]);
        let two = Participation::of(&[slides(1.0), slides(2.0), still], 1.0).expect("blocks move");
        near(two.effective, 9.0);
        let own = two.oscillator(0.2, 10.0, 1.35, Some(true));
        near(own.mass_fraction, 0.9);
        near(own.activation_acceleration, 0.2 * 10.0 / (0.9 * 1.35));
        // The mean displacement of 15 kg is 1 where δ = 1: d* = Σmδ²/Σmδ = 25/15.
        near(two.curve(&[[1.0, 0.0]], 10.0, 1.35)[0][0], 25.0 / 15.0);
        assert_eq!(Participation::of(&[still], 1.0), None);
        assert_eq!(Participation::of(&[], 1.0), None);
    }

    /// On a* = 2 (1 − d*/0.5): d_u* = 0.2 m, d_s* = 0.08 m, a_s* = 1.68 m/s², T_s = 2π √(0.08/1.68) = 1.371 s.
    #[test]
    fn displacements_of_a_straight_curve_by_hand() {
        let own = displacement_capacity(&[[0.0, 2.0], [0.3, 0.8], [0.6, -0.4]], 0.4).expect("a capacity");
        near(own.zero_displacement, 0.5);
        assert!(own.reaches_zero);
        near(own.ultimate_displacement, 0.2);
        near(own.secant_displacement, 0.08);
        near(own.secant_acceleration, 1.68);
        near(own.secant_period, 2.0 * PI * (0.08f64 / 1.68).sqrt());
        let short = displacement_capacity(&[[0.0, 2.0], [0.3, 0.8]], 0.4).expect("a capacity");
        assert!(!short.reaches_zero);
        near(short.ultimate_displacement, 0.12);
        assert_eq!(displacement_capacity(&[], 0.4), None);
        assert_eq!(displacement_capacity(&[[0.0, 1.0]], 0.4), None);
    }
}
