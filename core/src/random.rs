//! Pseudo-random numbers that are the same in every run and on every machine.

/// The one generator of this program: a linear congruential generator (Knuth 1997, The Art of Computer Programming 2,
/// 3.3.4, MMIX). Its upper 53 bits are used.
#[derive(Debug, Clone)]
pub struct Random(u64);

impl Random {
    /// Creates the sequence of a seed. Neighbouring seeds have unrelated sequences.
    pub fn new(seed: u64) -> Self {
        let mut random = Random(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x5851_f42d);
        (0..4).for_each(|_| _ = random.unit());
        random
    }

    /// Creates the sequence that follows a state of the generator.
    pub fn from_state(state: u64) -> Self {
        Random(state)
    }

    /// Returns a number from 0 to less than 1.
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Returns a number from −1 to less than 1.
    pub fn signed(&mut self) -> f64 {
        self.between(-1.0, 1.0)
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

#[cfg(test)]
mod tests {
    use super::*;

    /// The states follow the equation of MMIX.
    #[test]
    fn numbers_are_those_of_mmix() {
        let mut random = Random::from_state(7);
        let states: Vec<u64> = (0..3).map(|_| (random.unit(), random.0).1).collect();
        let next = |x: u128| ((x * 6_364_136_223_846_793_005 + 1_442_695_040_888_963_407) % (1 << 64)) as u64;
        let one = next(7);
        assert_eq!(states, [one, next(one.into()), next(next(one.into()).into())]);
        assert_eq!(Random::from_state(7).unit(), (one >> 11) as f64 / 2f64.powi(53));
    }

    /// Ten thousand numbers have the mean and the variance of a uniform distribution, and the first numbers of neighbouring
    /// seeds have no correlation.
    #[test]
    fn numbers_are_uniform_and_seeds_unrelated() {
        let mut random = Random::new(1);
        let uniform: Vec<f64> = (0..10_000).map(|_| random.unit()).collect();
        let first: Vec<f64> = (0..10_000).map(|seed| Random::new(seed).unit()).collect();
        for all in [&uniform, &first] {
            let mean = all.iter().sum::<f64>() / 1e4;
            let about =
                |lag: usize| all.iter().zip(&all[lag..]).map(|(a, b)| (a - mean) * (b - mean)).sum::<f64>() / 1e4;
            assert!((mean - 0.5).abs() < 0.01, "{mean}");
            assert!((about(0) - 1.0 / 12.0).abs() < 0.005 && about(1).abs() < 0.005, "{} {}", about(0), about(1));
        }
    }

    /// Both ends of whole numbers and all items of a list occur; a share of one is always met.
    #[test]
    fn draws_keep_their_ranges() {
        let mut random = Random::new(2);
        let mut seen = [0; 3];
        for _ in 0..300 {
            seen[random.whole(4, 6) - 4] += 1;
            assert!((-1.0..1.0).contains(&random.signed()) && (10.0..100.0).contains(&random.power(1.0, 2.0)));
            assert!(random.chance(1.0) && !random.chance(0.0) && [7, 8].contains(random.one_of(&[7, 8])));
        }
        assert!(seen.iter().all(|count| *count > 50), "{seen:?}");
    }
}
