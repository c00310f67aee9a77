//! Points that benches drive: the crushing stone of Drosopoulos et al. (2008), a mortar joint.

use voussoir::core::law::{StressUpdate, UpdateContext};
use voussoir::laws::cohesive::Cohesive;
use voussoir::laws::drucker_prager_cap::DruckerPragerCap;

/// The parameters β = 70°, d = 1 GPa, R = 0.005, α = 0.03, p_b = 10 MPa.
pub fn paper_stone() -> DruckerPragerCap {
    DruckerPragerCap::drosopoulos_2008(10e6)
}

/// The same model with parameters of a soft stone, with hardening.
pub fn ordinary_stone() -> DruckerPragerCap {
    DruckerPragerCap {
        cap_friction_angle: 30.0,
        cap_cohesion: 5e6,
        cap_eccentricity: 0.5,
        transition: 0.05,
        hardening: Some(vec![[0.0, 15e6], [0.005, 25e6], [0.02, 60e6]]),
        ..paper_stone()
    }
}

/// A mortar joint.
pub fn cohesive() -> Cohesive {
    Cohesive {
        friction: Some(0.75),
        friction_angle: None,
        tensile_strength: 0.25e6,
        cohesion: 0.35e6,
        normal_stiffness: 82e9,
        shear_stiffness: 36e9,
        tensile_fracture_energy: 18.0,
        shear_fracture_energy: 125.0,
    }
}

/// Initial states of `count` points.
pub fn states(update: &dyn StressUpdate, count: usize) -> Vec<f64> {
    let mut one = vec![0.0; update.state_size()];
    update.initial_state(&mut one);
    one.iter().copied().cycle().take(count * one.len()).collect()
}

/// Returns `count` strains that all return to the region with this name, spread over it. Panics if there are none.
pub fn strains(update: &dyn StressUpdate, region: &str, count: usize) -> Vec<[f64; 6]> {
    let old = states(update, 1);
    let mut new = old.clone();
    let mut out = Vec::with_capacity(count);
    // A low-discrepancy sequence over mean strain, shear and size.
    for i in 1..4_000_000_u32 {
        let share = |step: f64| (f64::from(i) * step).fract();
        let size = 10f64.powf(-4.0 + 4.0 * share(0.754_877_666));
        let angle = std::f64::consts::PI * share(0.569_840_291);
        let turn = std::f64::consts::TAU * share(0.618_033_989);
        let (mean, shear) = (-size * angle.cos(), size * angle.sin());
        let shear = if region == "apex" { 0.0 } else { shear };
        let strain = [
            mean + shear * turn.cos(),
            mean + shear * (turn + std::f64::consts::TAU / 3.0).cos(),
            mean + shear * (turn - std::f64::consts::TAU / 3.0).cos(),
            0.5 * shear,
            0.0,
            0.0,
        ];
        let found = update.update_point(&strain, &UpdateContext::of_length(1.0), &old, &mut new);
        let here = found.map_or("elastic", |point| point.branch.name);
        if here == region {
            out.push(strain);
            if out.len() == count {
                return out;
            }
        }
    }
    panic!("only {} strains return to {region}", out.len());
}
