//! The request of an envelope: the table of its study, and the runs of a case.

use crate::study::Case;
use serde_json::Value as Json;
use voussoir_core::plugin::Keys;

/// Greatest number of evenly spaced positions of the scan.
const MAX_SCAN: usize = 100_000;

/// The directions of vehicles that are tried.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Keys)]
pub enum Directions {
    /// Both directions, one after the other.
    Both,
    /// As in the vehicle's table.
    Forward,
    /// Reversed.
    Backward,
}

impl Directions {
    /// Returns the values of the key `direction` of a load.
    fn words(self) -> &'static [&'static str] {
        match self {
            Directions::Both => &["forward", "backward"],
            Directions::Forward => &["forward"],
            Directions::Backward => &["backward"],
        }
    }
}

/// `[envelope]`.
#[derive(Debug, Clone, Keys)]
pub(super) struct Request {
    /// path of the key that moves the load, such as "stages.1.loads.0.at"
    pub parameter: String,
    /// least value, in the unit of the key
    #[key(unit = "-")]
    pub from: f64,
    /// greatest value, in the unit of the key
    #[key(unit = "-")]
    pub to: f64,
    /// of the worst value, as a share of the range from `from` to `to`
    #[key(unit = "-", range = "> 0, <= 1", default = 1e-3)]
    pub tolerance: f64,
    /// number of places on an even scan; places where axles enter or edges of patches meet joints are added
    #[key(range = ">= 2, <= MAX_SCAN", default = 41)]
    pub scan: usize,
    /// direction of the vehicles
    #[key(optional = "both for a load of kind \"vehicle\", forward for others")]
    pub directions: Option<Directions>,
    /// entries of \[vehicles\] that are tried in turn
    #[key(reference = "vehicles", len = ">= 1, <= 1000", optional = "the load's own vehicle")]
    pub vehicles: Option<Vec<String>>,
}

impl Request {
    /// Returns the least and greatest value.
    pub fn range(&self) -> [f64; 2] {
        [self.from, self.to]
    }

    /// Returns a key in the same table as the parameter.
    pub fn beside(&self, key: &str) -> String {
        let table = self.parameter.rsplit_once('.').map_or("", |(table, _)| table);
        format!("{table}.{key}")
    }

    /// Returns the keys that the envelope sets: the parameter, vehicle and direction.
    pub fn keys(&self) -> Vec<String> {
        vec![self.parameter.clone(), self.beside("vehicle"), self.beside("direction")]
    }

    /// Returns the runs of a case: vehicles and directions, if the load has these keys.
    pub fn runs(&self, case: &Case) -> Vec<Run> {
        let load = self.parameter.rsplit_once('.').and_then(|(table, _)| case.resolved.at(table));
        let own = load.and_then(|load| Some(load.get("vehicle")?.as_str()?.to_string()));
        let Some(own) = own else { return vec![Run { vehicle: None, direction: None }] };
        let vehicles = self.vehicles.clone().unwrap_or_else(|| vec![own]);
        let directions = self.directions.unwrap_or(Directions::Both).words();
        let each = |vehicle: &String| {
            let run = |direction: &&str| Run { vehicle: Some(vehicle.clone()), direction: Some(direction.to_string()) };
            directions.iter().map(run).collect::<Vec<_>>()
        };
        vehicles.iter().flat_map(each).collect()
    }

    /// Returns the values of a run at a position, by key.
    pub fn values(&self, run: &Run, value: f64) -> Vec<(String, Json)> {
        let mut values = vec![(self.parameter.clone(), Json::from(value))];
        values.extend(run.vehicle.iter().map(|vehicle| (self.beside("vehicle"), vehicle.clone().into())));
        values.extend(run.direction.iter().map(|direction| (self.beside("direction"), direction.clone().into())));
        values
    }
}

/// A vehicle that moves in one direction.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Run {
    /// Entry of `[vehicles]`.
    pub vehicle: Option<String>,
    /// Direction of the vehicle.
    pub direction: Option<String>,
}
