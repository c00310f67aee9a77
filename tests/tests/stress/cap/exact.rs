//! The return to the cap model with fifty digits: Newton's method with 200-bit numbers on the printed equations,
//! started from a bisection with ordinary numbers.

use super::{active_pieces, on_cap};
use dashu_float::{FBig, round::mode::HalfEven};
use voussoir::core::law::Isotropic;
use voussoir::laws::drucker_prager_cap::DruckerPragerCap;

type Big = FBig<HalfEven, 2>;

const BITS: usize = 200;

fn big(x: f64) -> Big {
    Big::try_from(x).expect("a finite number").with_precision(BITS).value()
}

fn small(x: &Big) -> f64 {
    x.to_f64().value()
}

fn hypot(a: &Big, b: &Big) -> Big {
    let sum = a * a + b * b;
    if sum == big(0.0) { sum } else { sum.sqrt() }
}

/// Constants of a law. β enters through the law's own tan β and cos β, so that the return is compared and not the
/// trigonometry.
struct Constants<'a> {
    law: &'a DruckerPragerCap,
    tan: Big,
    cos: Big,
    cohesion: Big,
    eccentricity: Big,
    transition: Big,
    roundness: Big,
    bulk: Big,
    shear: Big,
}

impl Constants<'_> {
    /// Returns p_b from the piece of the table near the solution.
    fn strength(&self, compaction: &Big, piece: usize) -> Big {
        let table = self.law.hardening();
        if piece == 0 || piece == table.len() {
            return big(table[piece.saturating_sub(1).min(table.len() - 1)][1]);
        }
        let ([from, weak], [to, strong]) = (table[piece - 1], table[piece]);
        big(weak) + (compaction - big(from)) / (big(to) - big(from)) * (big(strong) - big(weak))
    }

    /// Returns p_a and D.
    fn centre(&self, compaction: &Big, piece: usize) -> (Big, Big) {
        let one = big(1.0);
        let strength = self.strength(compaction, piece);
        let centre = (strength - &self.eccentricity * &self.cohesion) / (one + &self.eccentricity * &self.tan);
        let size = &self.cohesion + &centre * &self.tan;
        (centre, size)
    }
}

/// Returns (p, q) of the return of (P, Q) at a compaction, from a solution (p, μ) with the precision of `f64`.
pub fn exact(
    law: &DruckerPragerCap,
    [p_trial, q_trial]: [f64; 2],
    compaction: f64,
    [p_start, mu_start]: [f64; 2],
) -> [f64; 2] {
    let Isotropic { bulk, shear } = Isotropic::new(law.young_modulus, law.poisson_ratio);
    let (sine, cosine) = law.cap_friction_angle.to_radians().sin_cos();
    let (cos, transition) = (big(cosine), big(law.transition));
    let c = Constants {
        law,
        tan: big(sine / cosine),
        cohesion: big(law.cap_cohesion),
        eccentricity: big(law.cap_eccentricity),
        roundness: big(1.0) + &transition - &transition / &cos,
        cos,
        transition,
        bulk: big(bulk),
        shear: big(shear),
    };
    let cap = on_cap(law, p_trial, compaction);
    let (p_big, q_big, start) = (big(p_trial), big(q_trial), big(compaction));
    let (piece, in_arc) = active_pieces(law, p_start, q_of(&c, cap, q_trial, mu_start), p_trial, compaction);
    let (p_weight, q_weight) = if cap {
        let over = &c.eccentricity / &c.roundness;
        (big(1.0), &over * &over)
    } else {
        (&c.tan * &c.tan, big(1.0) / (&c.roundness * &c.roundness))
    };
    let equations = |p: &Big, mu: &Big| -> ([Big; 2], Big) {
        let now = &start + (&p_big - p) / &c.bulk;
        let (centre, size) = c.centre(&now, piece);
        let q = &q_big / (big(1.0) + big(3.0) * &c.shear * mu * &q_weight);
        let x = p - &centre;
        let flow = p - &p_big + &c.bulk * mu * &p_weight * &x;
        let surface = if cap {
            hypot(&x, &(&c.eccentricity * &q / &c.roundness)) - &c.eccentricity * &size
        } else if in_arc {
            let middle = (big(1.0) - &c.transition / &c.cos) * &size;
            hypot(&x, &(&q - middle)) - &c.transition * &size
        } else {
            &q - p * &c.tan - &c.cohesion
        };
        ([flow, surface], q)
    };
    let step = big(2f64.powi(-90));
    let (mut p, mut mu) = (big(p_start), big(mu_start));
    let unit = small(&c.centre(&start, piece).1).abs() + p_trial.hypot(q_trial);
    for _ in 0..60 {
        let ([a, b], q) = equations(&p, &mu);
        if small(&a).abs().max(small(&b).abs()) <= 1e-45 * unit {
            return [small(&p), small(&q)];
        }
        let (dp, dmu) = (&step * big(unit), &step * &mu);
        let ([a_p, b_p], _) = equations(&(&p + &dp), &mu);
        let ([a_m, b_m], _) = equations(&p, &(&mu + &dmu));
        let (a_p, b_p) = ((a_p - &a) / &dp, (b_p - &b) / &dp);
        let (a_m, b_m) = ((a_m - &a) / &dmu, (b_m - &b) / &dmu);
        let determinant = &a_p * &b_m - &a_m * &b_p;
        p -= (&a * &b_m - &a_m * &b) / &determinant;
        mu -= (&a_p * &b - &a * &b_p) / &determinant;
    }
    panic!("fifty digits are not reached from ({p_trial}, {q_trial}) at {compaction}");
}

fn q_of(c: &Constants, cap: bool, q_trial: f64, mu: f64) -> f64 {
    let k = small(&c.roundness);
    let weight = if cap { (small(&c.eccentricity) / k).powi(2) } else { 1.0 / (k * k) };
    q_trial / (1.0 + 3.0 * small(&c.shear) * mu * weight)
}
