//! Random walks through gaps and strains.

use voussoir_core::random::Random;

/// Makes one step of a walk through `components` numbers, with sizes over two decades around `size`.
pub(super) fn random_step(random: &mut Random, at: &mut [f64; 6], components: usize, size: f64) {
    let step = size * random.power(-1.5, 0.5);
    at[..components].iter_mut().for_each(|x| *x += step * random.signed());
}
