//! `track`: rails, sleepers and ballast between an axle and the road.

use super::vehicle_axles::Axle;
use crate::scenes::dispersion::Patch;
use voussoir_core::plugin::Keys;

/// Rails, sleepers and ballast between an axle and the road. The road is the level under the ballast.
#[derive(Debug, Clone, Copy, PartialEq, Keys)]
pub struct Track {
    /// distance of sleepers
    #[key(unit = "m", range = "> 0")]
    pub sleeper_spacing: f64,
    /// size of a sleeper along the track
    #[key(unit = "m", range = "> 0")]
    pub sleeper_width: f64,
    /// size of a sleeper across the track
    #[key(unit = "m", range = "> 0", optional = "the wheel_width of the axle counts for an effective width")]
    pub sleeper_length: Option<f64>,
    /// depth of the ballast below the sleepers
    #[key(unit = "m", range = ">= 0", default = 0.0)]
    pub ballast_depth: f64,
    /// angle of the spread in the ballast, from the vertical; the default is 4 : 1
    #[key(unit = "deg", range = ">= 0, < 90", default = 14.036243467926479)]
    pub ballast_angle: f64,
    /// shares of an axle on the sleeper before it, under it and after it
    #[key(unit = "-", range = ">= 0, <= 1", default = [0.25, 0.5, 0.25])]
    pub shares: [f64; 3],
}

impl Track {
    /// Returns the distance by which the ballast widens a patch on each side \[m\].
    fn reach(&self) -> f64 {
        self.ballast_depth * self.ballast_angle.to_radians().tan()
    }

    /// Returns the key and the reason if the numbers are not possible.
    pub(super) fn mistake(&self) -> Option<(&'static str, String)> {
        let sum: f64 = self.shares.iter().sum();
        ((sum - 1.0).abs() > 1e-9).then(|| ("track.shares", format!("add up to {sum}, not to 1")))
    }
}

/// Returns the patches of the road that an axle loads, with positions relative to the axle.
pub fn footprints(axle: &Axle, track: Option<&Track>) -> Vec<Patch> {
    let Some(track) = track else {
        let half = axle.length / 2.0;
        return vec![Patch { from: -half, to: half, share: 1.0 }];
    };
    let half = track.sleeper_width / 2.0 + track.reach();
    let sleeper = |(i, share): (usize, &f64)| {
        let x = (i as f64 - 1.0) * track.sleeper_spacing;
        Patch { from: x - half, to: x + half, share: *share }
    };
    track.shares.iter().enumerate().map(sleeper).filter(|patch| patch.share > 0.0).collect()
}

/// Returns the width across the road that an axle loads \[m\]; `None` if the axle does not define it.
pub(super) fn loaded_width(axle: &Axle, track: Option<&Track>) -> Option<f64> {
    let sleepers = track.and_then(|track| Some(track.sleeper_length? + 2.0 * track.reach()));
    sleepers.or(axle.wheel_width)
}
