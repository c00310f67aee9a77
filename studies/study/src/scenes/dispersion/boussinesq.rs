//! `boussinesq`: the stress of an elastic half-plane under the load, cut off at an angle.
#![doc = include_str!("boussinesq.md")]

use crate::scenes::dispersion::law::{Dispersion, Patch, Through};
use std::f64::consts::PI;
use voussoir_core::plugin::{Card, Keys, PluginKind};

/// Number of parts of equal width into which the stress is divided. Each part is uniform and has the exact force of its
/// interval.
const PARTS: usize = 40;

/// The vertical stress of an elastic half-plane.
#[derive(Debug, Keys)]
pub struct Boussinesq {
    /// from the vertical: beyond it no load is carried, and the load within it is scaled up to the whole load
    #[key(unit = "deg", range = ">= 0, < 90")]
    pub angle: f64,
    /// at which the stress is taken
    #[key(unit = "m", range = ">= 0", optional = "the depth of the fill under the load's centre")]
    pub depth: Option<f64>,
}

/// Returns the share of a strip load between −`half` and `half` that is to the left of x at a depth z > 0.
fn to_the_left(x: f64, half: f64, z: f64) -> f64 {
    // The share under a line load at 0, and its integral.
    let line = |u: f64| 0.5 + ((u / z).atan() + z * u / (u * u + z * z)) / PI;
    let integral = |u: f64| u / 2.0 + u / PI * (u / z).atan();
    if half <= 1e-6 * z { line(x) } else { (integral(x + half) - integral(x - half)) / (2.0 * half) }
}

#[typetag::serde(name = "boussinesq")]
impl Dispersion for Boussinesq {
    fn spread(&self, patch: Patch, fill: &[Through]) -> Vec<Patch> {
        let own = self.angle.to_radians();
        let (depth, reach) = match self.depth {
            Some(depth) => (depth, depth * own.tan()),
            None => (
                fill.iter().map(|layer| layer.thickness).sum(),
                fill.iter().map(|layer| layer.thickness * layer.angle.unwrap_or(own).tan()).sum::<f64>(),
            ),
        };
        if reach <= 0.0 || depth <= 0.0 {
            return vec![patch];
        }
        let (centre, half) = ((patch.from + patch.to) / 2.0, (patch.to - patch.from) / 2.0);
        let most = half + reach;
        let place = |i: usize| most * (2.0 * i as f64 / PARTS as f64 - 1.0);
        let shares: Vec<f64> =
            (0..PARTS).map(|i| to_the_left(place(i + 1), half, depth) - to_the_left(place(i), half, depth)).collect();
        // Mirrored parts carry the same share, so that the moment is unchanged; all parts together carry the whole load.
        let even = |i: usize| (shares[i] + shares[PARTS - 1 - i]) / 2.0;
        let total: f64 = (0..PARTS).map(even).sum();
        let part = |i: usize| Patch {
            from: if i == 0 { patch.from - reach } else { centre + place(i) },
            to: if i + 1 == PARTS { patch.to + reach } else { centre + place(i + 1) },
            share: patch.share * even(i) / total,
        };
        (0..PARTS).map(part).collect()
    }

    fn has_depth(&self) -> bool {
        self.depth.is_some()
    }
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::Dispersion,
        tag: "boussinesq",
        summary: "the vertical stress of an elastic half-plane under the load, cut off under an angle",
        sources: &[
            "Flamant 1892, C. R. Acad. Sci. 114 (line load on a half-plane, from Boussinesq 1885)",
            "Poulos & Davis 1974, Elastic Solutions for Soil and Rock Mechanics, 3.2.1 (strip load)",
        ],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("boussinesq.md"),
        ..Card::of::<Boussinesq>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spread(angle: f64, depth: f64, half: f64) -> Vec<Patch> {
        let law = Boussinesq { angle, depth: None };
        let fill = [Through { thickness: depth, angle: None }];
        law.spread(Patch { from: 2.0 - half, to: 2.0 + half, share: 1.0 }, &fill)
    }

    /// Force and moment do not change, for any patch and cut-off.
    #[test]
    fn force_and_moment_stay() {
        for (angle, depth, half) in [(30.0, 0.5, 0.15), (60.0, 2.0, 0.0), (1.0, 0.1, 1.0), (89.9, 0.3, 0.2)] {
            let parts = spread(angle, depth, half);
            let force: f64 = parts.iter().map(|part| part.share).sum();
            let moment: f64 = parts.iter().map(|part| part.share * (part.from + part.to) / 2.0).sum();
            assert!((force - 1.0).abs() < 1e-14 && (moment - 2.0).abs() < 1e-12, "{angle}: {force} {moment}");
            assert!(parts.windows(2).all(|pair| (pair[0].to - pair[1].from).abs() < 1e-14));
            let reach = depth * f64::to_radians(angle).tan();
            assert!((parts[0].from - (2.0 - half - reach)).abs() < 1e-13);
        }
    }

    /// Compares the parts with Flamant's stress 2 z³/(π (x² + z²)²), integrated numerically over load and part.
    #[test]
    fn parts_carry_flamants_stress() {
        let (depth, half, angle) = (0.6_f64, 0.25, 45.0_f64);
        let stress = |x: f64| 2.0 * depth.powi(3) / (PI * (x * x + depth * depth).powi(2));
        let mean = |from: f64, to: f64, f: &dyn Fn(f64) -> f64| {
            let n = 400;
            (0..n).map(|i| f(from + (to - from) * (f64::from(i) + 0.5) / f64::from(n))).sum::<f64>() / f64::from(n)
        };
        let under = |x: f64| mean(-half, half, &|load: f64| stress(x - load));
        let most = half + depth * angle.to_radians().tan();
        let within = mean(-most, most, &under) * 2.0 * most;
        for part in spread(angle, depth, half) {
            let (from, to) = (part.from - 2.0, part.to - 2.0);
            let share = mean(from, to, &under) * (to - from) / within;
            assert!((part.share / share - 1.0).abs() < 1e-4, "{from}: {} {share}", part.share);
        }
    }

    /// Without depth the load reaches the extrados unchanged.
    #[test]
    fn no_depth_no_spread() {
        assert_eq!(spread(30.0, 0.0, 0.1).len(), 1);
        assert_eq!(spread(0.0, 0.5, 0.1).len(), 1);
    }
}
