//! `vehicle`: the axles of a vehicle on the road of a bridge.
#![doc = include_str!("vehicle.md")]

use super::extrados::from_road;
use super::load_kind::{LoadKind, Placed};
use super::site::LoadSite;
use super::track::{Track, footprints, loaded_width};
use super::vehicle_axles::Axle;
use crate::scenes::dispersion::Patch;
use voussoir_core::plugin::{Card, Diagnostic, Keys, PluginKind, Sample};

/// Direction of the vehicle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Keys)]
pub enum Direction {
    /// As in the vehicle's table.
    Forward,
    /// Reversed.
    Backward,
}

/// The part of the bridge's width that carries an axle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Keys)]
pub enum Across {
    /// The whole width.
    FullWidth,
    /// The wheel width, spread on both sides like its length.
    Effective,
}

/// A vehicle on the road.
#[derive(Debug, Clone, Keys)]
pub struct VehicleLoad {
    /// entry of \[vehicles\]
    #[key(reference = "vehicles")]
    pub vehicle: String,
    /// x of the vehicle's origin, which is its first axle
    #[key(unit = "m")]
    pub at: f64,
    /// forward: axles at x + their distances; backward: at x − their distances
    #[key(default = "forward")]
    pub direction: Direction,
    /// full_width: the whole width carries an axle; effective: its wheel_width, spread like its length
    #[key(default = "full_width")]
    pub across: Across,
    /// rails, sleepers and ballast between the axles and the road, which is the level under the ballast
    #[key(optional = "each axle presses on the road itself")]
    pub track: Option<Track>,
}

impl VehicleLoad {
    /// Returns x of an axle.
    fn place_of(&self, axle: &Axle) -> f64 {
        match self.direction {
            Direction::Forward => self.at + axle.at,
            Direction::Backward => self.at - axle.at,
        }
    }

    /// Returns the part of the bridge's width that carries an axle, with its spread on both sides in the fill \[m\].
    fn carrying(&self, axle: &Axle, width: f64, reach: f64) -> f64 {
        match (self.across, loaded_width(axle, self.track.as_ref())) {
            (Across::Effective, Some(wheel)) => width.min(wheel + 2.0 * reach),
            _ => width,
        }
    }
}

#[typetag::serde(name = "vehicle")]
impl LoadKind for VehicleLoad {
    fn place(&self, site: &LoadSite) -> Result<Placed, Vec<Diagnostic>> {
        site.finite(&[("at", &[self.at])])?;
        // An unknown name, or an entry with mistakes, is reported by the check of keys.
        let Some(vehicle) = site.tables.vehicles.get(&self.vehicle) else { return Err(Vec::new()) };
        if let Some((key, message)) = self.track.as_ref().and_then(Track::mistake) {
            return site.fail(key, message);
        }
        let width = site.assembly.width;
        let mut placed = Placed::default();
        for (i, axle) in vehicle.axles.iter().enumerate() {
            let x = self.place_of(axle);
            let prints = footprints(axle, self.track.as_ref());
            let count = prints.len();
            let mut off = 0;
            for Patch { from, to, share } in prints {
                let patch = Patch { from: x + from, to: x + to, share: 1.0 };
                let Some(spread) = from_road(site, patch, "at")? else {
                    off += 1;
                    continue;
                };
                let force = share * axle.force * axle.lift_off * width / self.carrying(axle, width, spread.reach);
                placed.spreads.push(spread.spread);
                placed.forces.extend(spread.forces.into_iter().map(|mut part| {
                    part.force *= force;
                    part
                }));
            }
            if off > 0 {
                let what =
                    if count > 1 { format!("{off} of {count} sleepers under axle {i}") } else { format!("axle {i}") };
                let (is, counts) = if off > 1 { ("are", "they count") } else { ("is", "it counts") };
                placed.notes.push(format!("{what} of \"{}\" {is} off the bridge: {counts} zero", self.vehicle));
            }
        }
        Ok(placed)
    }
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::LoadKind,
        tag: "vehicle",
        summary: "the axles of a vehicle on the road of a bridge",
        sources: &[
            "National Highways 2020, CS 454 (effective width, lift-off)",
            "EN 1991-2:2003, 6.3.6.1 and 6.3.6.2 (25, 50 and 25 % on three sleepers; 4 : 1 in ballast)",
        ],
        samples: &[
            Sample::keys(r#"vehicle = "cart"
at = 1.5
direction = "backward"
across = "effective""#),
        ],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("vehicle.md"),
        ..Card::of::<VehicleLoad>()
    }
}
