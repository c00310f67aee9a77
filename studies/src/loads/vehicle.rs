//! `vehicle`: the axles of a vehicle on the road of a bridge.
#![doc = include_str!("vehicle.md")]

use super::dispersion::Patch;
use super::extrados::from_road;
use super::load_kind::{LoadKind, Placed};
use super::site::LoadSite;
use super::vehicle_axles::Axle;
use serde::{Deserialize, Serialize};
use voussoir_core::plugin::{Card, Diagnostic, Need, Parameter, PluginKind, Quantity, Range, Shape};

/// Which way the axles stand.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Direction {
    /// As in the vehicle's table.
    #[default]
    Forward,
    /// Turned round.
    Backward,
}

/// How much of the bridge's width carries a wheel.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Across {
    /// All of it.
    #[default]
    FullWidth,
    /// The wheel's width, spread on both sides like its length.
    Effective,
}

/// A vehicle on the road.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VehicleLoad {
    /// Entry of `[vehicles]`.
    pub vehicle: String,
    /// x of its origin \[m\].
    pub at: f64,
    /// Which way it stands.
    #[serde(default)]
    pub direction: Direction,
    /// What carries it.
    #[serde(default)]
    pub across: Across,
}

impl VehicleLoad {
    /// x of an axle.
    fn place_of(&self, axle: &Axle) -> f64 {
        match self.direction {
            Direction::Forward => self.at + axle.at,
            Direction::Backward => self.at - axle.at,
        }
    }

    /// Width that carries an axle, of the bridge's width, with its reach to both sides in the fill \[m\].
    fn carrying(&self, axle: &Axle, width: f64, reach: f64) -> f64 {
        match (self.across, axle.wheel_width) {
            (Across::Effective, Some(wheel)) => width.min(wheel + 2.0 * reach),
            _ => width,
        }
    }
}

#[typetag::serde(name = "vehicle")]
impl LoadKind for VehicleLoad {
    fn place(&self, site: &LoadSite) -> Result<Placed, Vec<Diagnostic>> {
        site.finite(&[("at", &[self.at])])?;
        let Some(vehicle) = site.tables.vehicles.get(&self.vehicle) else {
            return site.fail("vehicle", format!("there is no vehicle called \"{}\"", self.vehicle));
        };
        let width = site.assembly.width;
        let mut placed = Placed::default();
        for (i, axle) in vehicle.axles.iter().enumerate() {
            let (x, half) = (self.place_of(axle), axle.length / 2.0);
            let patch = Patch { from: x - half, to: x + half, share: 1.0 };
            let Some(spread) = from_road(site, patch, "at")? else {
                placed.notes.push(format!("axle {i} of \"{}\" is off the bridge: it counts zero", self.vehicle));
                continue;
            };
            let force = axle.force * axle.lift_off * width / self.carrying(axle, width, spread.reach);
            placed.forces.extend(spread.forces.into_iter().map(|mut share| {
                share.force *= force;
                share
            }));
        }
        Ok(placed)
    }
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::LoadKind,
        tag: "vehicle",
        summary: "the axles of a vehicle on the road of a bridge",
        parameters: &[
            Parameter {
                name: "vehicle",
                doc: "entry of [vehicles]",
                shape: Shape::Reference("vehicles"),
                need: Need::Required,
            },
            Parameter::number("at", Quantity::Length, Range::ANY, "x of its origin, which is its first axle"),
            Parameter {
                name: "direction",
                doc: "forward: axles at x + their distances; backward: at x − their distances",
                shape: Shape::Choice(&["forward", "backward"]),
                need: Need::Default("\"forward\""),
            },
            Parameter {
                name: "across",
                doc: "full_width: the whole width carries an axle; effective: its wheel_width, spread like its length",
                shape: Shape::Choice(&["full_width", "effective"]),
                need: Need::Default("\"full_width\""),
            },
        ],
        sources: &["National Highways 2020, CS 454 (effective width, lift-off)"],
        file: file!(),
        page: include_str!("vehicle.md"),
        ..Card::BLANK
    }
}
