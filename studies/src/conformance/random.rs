//! Pseudo-random numbers that are the same on every machine.

/// A linear congruential generator (Knuth's MMIX constants); its upper bits are used.
pub(super) struct Random(u64);

impl Random {
    pub(super) fn new(seed: u64) -> Self {
        let mut random = Random(seed);
        for _ in 0..8 {
            random.unit();
        }
        random
    }

    /// Returns a number in [0, 1).
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Makes one step of a walk through `components` numbers, with sizes over two decades around `size`.
    pub(super) fn step(&mut self, at: &mut [f64; 6], components: usize, size: f64) {
        let step = size * 10f64.powf(self.between(-1.5, 0.5));
        at[..components].iter_mut().for_each(|x| *x += step * self.between(-1.0, 1.0));
    }
}
