//! `track`: rails, sleepers and ballast between an axle and the road.

use super::dispersion::Patch;
use super::vehicle_axles::Axle;
use serde::{Deserialize, Serialize};
use voussoir_core::plugin::{Need, Parameter, Quantity, Range, Shape};

/// What carries an axle to the road. The road is the level under the ballast.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Track {
    /// Distance of sleepers \[m\].
    pub sleeper_spacing: f64,
    /// Of a sleeper, along the track \[m\].
    pub sleeper_width: f64,
    /// Of a sleeper, across the track \[m\].
    pub sleeper_length: Option<f64>,
    /// Of the ballast below the sleepers \[m\].
    #[serde(default)]
    pub ballast_depth: f64,
    /// Of the spread in the ballast, from the vertical \[deg\].
    #[serde(default = "one_in_four")]
    pub ballast_angle: f64,
    /// Shares of the sleeper before the axle, under it, and after it.
    #[serde(default = "quarters")]
    pub shares: [f64; 3],
}

fn one_in_four() -> f64 {
    14.036243467926479
}

fn quarters() -> [f64; 3] {
    [0.25, 0.5, 0.25]
}

const SHARE: Shape = Shape::Number(Quantity::Ratio, Range::new(0.0, false, 1.0, false));

/// What `track` may hold.
pub(super) const TRACK: Shape = Shape::Table(&[
    Parameter::number("sleeper_spacing", Quantity::Length, Range::POSITIVE, "distance of sleepers"),
    Parameter::number("sleeper_width", Quantity::Length, Range::POSITIVE, "of a sleeper, along the track"),
    Parameter::number("sleeper_length", Quantity::Length, Range::POSITIVE, "of a sleeper, across the track")
        .optional("the wheel_width of the axle counts for an effective width"),
    Parameter::number("ballast_depth", Quantity::Length, Range::NON_NEGATIVE, "of the ballast below the sleepers")
        .default("0.0"),
    Parameter::number(
        "ballast_angle",
        Quantity::Degrees,
        Range::new(0.0, false, 90.0, true),
        "of the spread in the ballast, from the vertical; the default is 4 : 1",
    )
    .default("14.036243467926479"),
    Parameter {
        name: "shares",
        doc: "of an axle on the sleeper before it, under it and after it",
        shape: Shape::List { of: &SHARE, min: 3, max: 3 },
        need: Need::Default("[0.25, 0.5, 0.25]"),
    },
]);

impl Track {
    /// How far the ballast widens a patch to each side \[m\].
    fn reach(&self) -> f64 {
        self.ballast_depth * self.ballast_angle.to_radians().tan()
    }

    /// Why its numbers cannot be, with the key.
    pub(super) fn mistake(&self) -> Option<(&'static str, String)> {
        let sum: f64 = self.shares.iter().sum();
        ((sum - 1.0).abs() > 1e-9).then(|| ("track.shares", format!("add up to {sum}, not to 1")))
    }
}

/// What of an axle reaches the road, with places counted from the axle.
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

/// Width across the road that an axle loads \[m\]; `None` where the axle says nothing of it.
pub(super) fn loaded_width(axle: &Axle, track: Option<&Track>) -> Option<f64> {
    let sleepers = track.and_then(|track| Some(track.sleeper_length? + 2.0 * track.reach()));
    sleepers.or(axle.wheel_width)
}
