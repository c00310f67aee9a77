//! What an envelope is asked: the table of its study, and what is tried on a case.

use crate::study::{Case, Outline};
use serde_json::Value as Json;

/// `[envelope]`, read.
#[derive(Debug, Clone)]
pub(super) struct Request {
    /// Path of the key that moves the load.
    pub parameter: String,
    /// Its least and greatest value.
    pub range: [f64; 2],
    /// Of the worst value, as a share of the range.
    pub tolerance: f64,
    /// Number of even places.
    pub scan: usize,
    /// Which way vehicles stand.
    pub directions: Option<String>,
    /// Entries of `[vehicles]`.
    pub vehicles: Option<Vec<String>>,
}

impl Request {
    /// From the table of the study's kind; `None` where something is missing.
    pub fn of(outline: &Outline) -> Option<Self> {
        let table = &outline.table;
        let number = |key: &str| table.get(key)?.as_f64();
        Some(Request {
            parameter: table.get("parameter")?.as_str()?.to_string(),
            range: [number("from")?, number("to")?],
            tolerance: number("tolerance").unwrap_or(1e-3),
            scan: table.get("scan").and_then(Json::as_u64).map_or(41, |scan| scan as usize),
            directions: table.get("directions").and_then(|word| Some(word.as_str()?.to_string())),
            vehicles: table.get("vehicles").and_then(|list| serde_json::from_value(list.clone()).ok()),
        })
    }

    /// A key beside the parameter, in the same table.
    pub fn beside(&self, key: &str) -> String {
        let table = self.parameter.rsplit_once('.').map_or("", |(table, _)| table);
        format!("{table}.{key}")
    }

    /// The keys that the envelope sets: the parameter, vehicle and direction.
    pub fn keys(&self) -> Vec<String> {
        vec![self.parameter.clone(), self.beside("vehicle"), self.beside("direction")]
    }

    /// What is tried on a case: vehicle and direction, each where there is one.
    pub fn runs(&self, case: &Case) -> Vec<Run> {
        let load = self.parameter.rsplit_once('.').and_then(|(table, _)| case.resolved.at(table));
        let own = load.and_then(|load| Some(load.get("vehicle")?.as_str()?.to_string()));
        let Some(own) = own else { return vec![Run { vehicle: None, direction: None }] };
        let vehicles = self.vehicles.clone().unwrap_or_else(|| vec![own]);
        let directions: &[&str] = match self.directions.as_deref() {
            Some("forward") => &["forward"],
            Some("backward") => &["backward"],
            _ => &["forward", "backward"],
        };
        let each = |vehicle: &String| {
            let run = |direction: &&str| Run { vehicle: Some(vehicle.clone()), direction: Some(direction.to_string()) };
            directions.iter().map(run).collect::<Vec<_>>()
        };
        vehicles.iter().flat_map(each).collect()
    }

    /// The values of a run at a place, by key.
    pub fn values(&self, run: &Run, value: f64) -> Vec<(String, Json)> {
        let mut values = vec![(self.parameter.clone(), Json::from(value))];
        values.extend(run.vehicle.iter().map(|vehicle| (self.beside("vehicle"), vehicle.clone().into())));
        values.extend(run.direction.iter().map(|direction| (self.beside("direction"), direction.clone().into())));
        values
    }
}

/// A vehicle that moves one way.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Run {
    /// Entry of `[vehicles]`.
    pub vehicle: Option<String>,
    /// Which way it stands.
    pub direction: Option<String>,
}
