//! The request of an envelope: the table of its study, and the runs of a case.

use serde_json::Value as Json;
use voussoir_core::plugin::Keys;
use voussoir_study::loads::VehicleAxles;
use voussoir_study::study::Case;

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
    /// of the least load factor, as a share of it: the search ends if its neighbours do not permit a lower one
    #[key(unit = "-", range = "> 0, <= 1", default = 1e-6)]
    pub accuracy: f64,
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
            let once = directions.len() > 1 && self.is_same_both_ways(case, vehicle);
            directions.iter().take(if once { 1 } else { 2 }).map(run).collect::<Vec<_>>()
        };
        vehicles.iter().flat_map(each).collect()
    }

    /// Returns true if a vehicle that stands backward loads the bridge as one that stands forward at another place of the range:
    /// it is symmetric, and no axle of it is on the bridge at those places of a vehicle that stands backward which one that
    /// stands forward does not reach.
    fn is_same_both_ways(&self, case: &Case, vehicle: &str) -> bool {
        // Sleepers reach beyond the axles.
        if case.resolved.at(&self.beside("track")).is_some_and(|track| !track.is_null()) {
            return false;
        }
        let table = case.resolved.get("vehicles").and_then(|all| all.get(vehicle));
        let Some(vehicle) = table.and_then(|table| serde_json::from_value::<VehicleAxles>(table.clone()).ok()) else {
            return false;
        };
        let Some(centre) = vehicle.centre_of_symmetry() else { return false };
        let ends = vehicle.axles.iter().flat_map(|axle| [axle.at - axle.length / 2.0, axle.at + axle.length / 2.0]);
        let (first, last) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        let joints = case.assembly.extrados().into_iter().flat_map(|chord| chord.ends.map(|end| end.x));
        let (left, right) = joints.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        // Backward at x is forward at x - 2 centre.
        let (from, to) = (self.from, self.to);
        match centre {
            0.0 => true,
            centre if centre > 0.0 => from + last < left,
            _ => to + first > right,
        }
    }

    /// The values of a run at a place, by key.
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
