//! Straight joints between two bodies: their bond, their frame, their initial opening.

use super::geometry::{Vec2, turned};
use crate::plugin::Keys;

/// The connection of two bodies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Bond {
    /// The bodies are one piece.
    Bonded,
    /// The interface law with this index in the catalogue.
    Law(usize),
}

/// Initial opening of a joint: a number, or a table along it.
#[derive(Debug, Clone, PartialEq, Keys)]
#[keys(untagged)]
pub enum Gap {
    /// The same everywhere \[m\].
    #[key(unit = "m", range = ">= 0")]
    Uniform(f64),
    /// Pairs \[s, gap\] \[m\], s ascending from the joint's end 0; linear between them, constant
    /// before the first and after the last.
    #[key(names = ["s", "gap"], unit = "m", range = ["", ">= 0"], len = ">= 1")]
    Table(Vec<[f64; 2]>),
}

impl Default for Gap {
    fn default() -> Self {
        Gap::Uniform(0.0)
    }
}

impl Gap {
    /// Returns the opening \[m\] at the distance s \[m\] from end 0 of the joint.
    pub fn at(&self, s: f64) -> f64 {
        let table = match self {
            Gap::Uniform(gap) => return *gap,
            Gap::Table(table) => table,
        };
        let after = table.partition_point(|row| row[0] <= s);
        match (after.checked_sub(1).map(|i| table[i]), table.get(after)) {
            (Some([a, from]), Some(&[b, to])) => from + (to - from) * (s - a) / (b - a),
            (Some([_, gap]), None) => gap,
            (None, first) => first.map_or(0.0, |row| row[1]),
        }
    }
}

/// A straight contact between two bodies.
#[derive(Debug, Clone)]
pub struct Joint {
    /// Index of the body on the minus side.
    pub minus: usize,
    /// Index of the body on the plus side.
    pub plus: usize,
    /// Ends at s = −h/2 and s = +h/2. t points from the first to the second; n = t rotated by −90° points into plus.
    pub ends: [Vec2; 2],
    /// Connection of the bodies.
    pub bond: Bond,
    /// Initial opening, along s from end 0.
    pub gap: Gap,
}

impl Joint {
    /// Returns the height h \[m\].
    pub fn height(&self) -> f64 {
        (self.ends[1] - self.ends[0]).norm()
    }

    /// Returns the point at s = 0.
    pub fn middle(&self) -> Vec2 {
        (self.ends[0] + self.ends[1]) / 2.0
    }

    /// Returns the unit vectors (n, t).
    pub fn frame(&self) -> (Vec2, Vec2) {
        let t = (self.ends[1] - self.ends[0]).normalize();
        (-turned(t), t)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A table of gaps is linear between its rows and constant outside.
    #[test]
    fn gaps_along_a_joint() {
        let gap = Gap::Table(vec![[0.0, 0.1], [1.0, 0.3], [2.0, 0.0]]);
        for (s, expected) in [(-1.0, 0.1), (0.0, 0.1), (0.5, 0.2), (1.0, 0.3), (1.5, 0.15), (2.0, 0.0), (3.0, 0.0)] {
            assert!((gap.at(s) - expected).abs() < 1e-15, "{s}");
        }
        assert_eq!(Gap::Uniform(0.2).at(7.0), 0.2);
    }
}
