//! Pseudo-random numbers that are the same on every machine.

/// A linear congruential generator (Knuth's constants), with the draws that scenes need.
#[derive(Debug, Clone)]
pub struct Sequence(u64);

impl Sequence {
    /// Creates the sequence of a seed; neighbouring seeds have unrelated sequences.
    pub fn new(seed: u64) -> Sequence {
        let mut own = Sequence(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x5851_f42d);
        (0..4).for_each(|_| _ = own.unit());
        own
    }

    /// Returns a number from 0 to less than 1.
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Returns a number uniformly distributed between two ends.
    pub fn between(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * self.unit()
    }

    /// Returns 10 to a power uniformly distributed between two ends.
    pub fn power(&mut self, from: f64, to: f64) -> f64 {
        10f64.powf(self.between(from, to))
    }

    /// Returns a whole number from `from` to `to`, both included.
    pub fn whole(&mut self, from: usize, to: usize) -> usize {
        from + (self.unit() * (to - from + 1) as f64) as usize
    }

    /// Returns true with the probability `share`.
    pub fn chance(&mut self, share: f64) -> bool {
        self.unit() < share
    }

    /// Returns one of the items.
    pub fn one_of<'a, T>(&mut self, all: &'a [T]) -> &'a T {
        &all[self.whole(0, all.len() - 1)]
    }
}
