//! Compares a stored result with the same case solved again by another program or on another processor: the claims, not
//! the bits.
//!
//! Statuses, mechanisms, events and all other words must be the same. Numbers may differ by the tolerances of
//! [`super::tolerances`]. Residuals are compared with their gates, curves as functions, events by identity.

use crate::checks::curves::same_curve;
use crate::checks::events;
use crate::checks::repeat::{differs, listed, pairs};
use crate::checks::tolerances::{
    BEYOND, DERIVATIVE, ESTIMATE, FACTOR, FREE, GEOMETRY, PEAK, RATE, Route, SEARCHED, STATE, Tolerance, ZONE,
};
use serde_json::Value as Json;
use std::collections::HashMap;
use voussoir_core::certificate::tolerance;
use voussoir_core::plugin::{PluginKind, card};

/// The gate of the energy balance of a path from event to event.
const EVENT_ENERGY: f64 = 1e-9;
/// Greatest error of a controlled stress of a driven point, relative to the greatest number of its rows.
const CONTROL: f64 = 1e-9;

/// Returns the differences of `stored` from `again` in words; none if both claim the same.
pub fn differences(stored: &Json, again: &Json) -> Vec<String> {
    let mut comparison = Comparison::new(stored, again);
    comparison.entry(stored, again, "", "");
    listed(comparison.found)
}

/// Returns true if two values that are not cases are the same: words, and numbers as factors.
pub fn same(stored: &Json, again: &Json) -> bool {
    let mut comparison = Comparison { case: false, ..Comparison::new(stored, again) };
    comparison.entry(stored, again, "", "");
    comparison.found.is_empty()
}

/// The rule by which an entry is compared.
enum Rule {
    /// The entry is not compared.
    Free,
    /// Words must be the same; the certificate proves the numbers.
    Proved,
    /// Only its kind of value must be the same; the certificate proves the rest.
    Any,
    /// Numbers may differ by a share of the greatest number of the same key.
    Within(f64),
    /// Numbers may differ by a share of the number itself.
    Relative(f64),
    /// Numbers may differ by a share of the load factor.
    OfFactor(f64),
    /// Numbers must be within the gate of their residual.
    Gate,
    /// A load-displacement curve.
    Curve,
    /// A list of events.
    Events,
}

/// The comparison of two values.
struct Comparison<'a> {
    /// True if both are cases: rules exist for their keys.
    case: bool,
    route: Route,
    /// True if fields are stored. The certificate has checked them.
    fields: bool,
    /// True if the mechanism is unique.
    unique: bool,
    /// True if the second run has another number of steps.
    steps_differ: bool,
    /// True if the stored certificate has passed.
    passed: bool,
    factor: f64,
    /// The greatest number below each key, without indices.
    greatest: HashMap<String, f64>,
    again: &'a Json,
    found: Vec<String>,
}

impl<'a> Comparison<'a> {
    fn new(stored: &Json, again: &'a Json) -> Self {
        let mut greatest = HashMap::new();
        [stored, again].iter().for_each(|case| measure(case, "", &mut greatest));
        let there = |key: &str| !stored[key].is_null();
        let steps = |case: &Json| case["counters"]["steps"].clone();
        Comparison {
            case: true,
            route: route(again["solver"].as_str()),
            fields: there("field") || there("motion") || there("ray"),
            unique: again["mechanism"]["unique"] == Json::Bool(true),
            steps_differ: steps(stored) != steps(again),
            passed: stored["certificate"]["passed"] == Json::Bool(true),
            factor: again["load_factor"].as_f64().unwrap_or(0.0).abs(),
            greatest,
            again,
            found: Vec::new(),
        }
    }

    /// Returns the rule of a key without indices.
    fn rule(&self, key: &str) -> Rule {
        let (top, leaf) = (key.split('.').next().unwrap_or(key), key.rsplit('.').next().unwrap_or(key));
        let within = |tolerance: &Tolerance| Rule::Within(tolerance.of(self.route));
        let proved = self.route == Route::Limit && self.fields;
        match top {
            _ if !self.case => within(&FACTOR),
            _ if FREE.contains(&key) || top == "case_hash" => Rule::Free,
            "lower_proof" | "associated_motion" if self.fields => Rule::Any,
            "mechanism" if proved && self.unique => Rule::Proved,
            "mechanism" if proved => Rule::Any,
            "field" | "ray" | "motion" | "thrust_line" if proved => Rule::Proved,
            "stages" if proved && leaf == "hinges" => Rule::Any,
            "fill" if proved && leaf == "force" => Rule::Proved,
            "joints" if leaf == "zone" => within(&ZONE),
            "joints" if self.fields => Rule::Proved,
            "certificate" => Rule::Gate,
            "curve" => Rule::Curve,
            "events" => Rule::Events,
            "bracket" if leaf == "work" => Rule::Free,
            "load_factor_error" => Rule::OfFactor(ESTIMATE.of(self.route)),
            "sensitivities" if leaf == "why" => Rule::Free,
            "sensitivities" if leaf != "value" => Rule::Relative(DERIVATIVE.of(self.route)),
            "parameters" => Rule::Relative(SEARCHED.of(self.route)),
            "states" if self.steps_differ => Rule::Proved,
            "limit_points" | "followed_to" if leaf == "fall" || top == "followed_to" => match self.steps_differ {
                true => Rule::OfFactor(BEYOND.of(self.route)),
                false => within(&PEAK),
            },
            "limit_points" if key.starts_with("limit_points.next_state") && self.steps_differ => {
                Rule::Relative(BEYOND.of(self.route))
            }
            "limit_points" if leaf == "released_energy" && self.steps_differ => Rule::Relative(BEYOND.of(self.route)),
            "limit_points" if ["displacement", "released_energy"].contains(&leaf) => within(&PEAK),
            _ if ["point", "direction", "bounds"].contains(&leaf) && key != "bounds" => within(&GEOMETRY),
            "loads" => within(&GEOMETRY),
            "outputs" if leaf == "positions" => within(&GEOMETRY),
            "outputs" if self.route != Route::Limit => within(&STATE),
            "motion" | "mechanism" | "branches" => within(&RATE),
            "stages" if leaf != "factor" => within(&RATE),
            "field" | "fill" | "displacements" | "thrust_line" | "states" | "yielded" | "joint_states"
            | "joint_time_step" | "joint_gaps" | "ray" | "rows" => within(&STATE),
            _ => within(&FACTOR),
        }
    }

    /// Compares the values at `path`; `key` is the path without indices.
    fn entry(&mut self, stored: &Json, again: &Json, path: &str, key: &str) {
        match (self.rule(key), stored, again) {
            (Rule::Free, ..) => {}
            (Rule::Any, ..) if stored.is_null() == again.is_null() => {}
            (Rule::Curve, Json::Array(_), Json::Array(_)) => {
                if !same_curve(stored, again, self.route) {
                    self.found.push("solving the case again gives another curve".into());
                }
            }
            (Rule::Events, Json::Array(_), Json::Array(_)) => {
                self.found.extend(events::differences(stored, again, self.route, self.steps_differ));
            }
            (rule, Json::Number(a), Json::Number(b)) if a.is_f64() || b.is_f64() => {
                let (a, b) = (a.as_f64().unwrap_or(f64::NAN), b.as_f64().unwrap_or(f64::NAN));
                if !(a == b || self.near(&rule, a, b, key)) {
                    self.found.push(differs(path, stored, again));
                }
            }
            (_, Json::Array(a), Json::Array(b)) if a.len() == b.len() => {
                for (index, (a, b)) in a.iter().zip(b).enumerate() {
                    self.entry(a, b, &format!("{path}[{index}]"), &item(key, index));
                }
            }
            (_, Json::Object(a), Json::Object(b)) => {
                for (path, a, b) in pairs((a, b), path, &mut self.found) {
                    let below = path.rsplit('.').next().unwrap_or_default();
                    let key = if key.is_empty() { below.to_string() } else { format!("{key}.{below}") };
                    self.entry(a, b, &path, &key);
                }
            }
            _ if stored == again => {}
            _ => self.found.push(differs(path, stored, again)),
        }
    }

    /// Returns true if two numbers agree within the rule; false if one is NaN.
    fn near(&self, rule: &Rule, a: f64, b: f64, key: &str) -> bool {
        let apart = (a - b).abs();
        let greatest = self.greatest.get(key).copied().unwrap_or(0.0);
        if key == "largest_control_error" {
            return a.abs() <= CONTROL * self.greatest_row();
        }
        match rule {
            Rule::Proved | Rule::Any | Rule::Free => a.is_finite(),
            Rule::Within(share) => apart <= share * greatest,
            Rule::Relative(share) => apart <= share * a.abs().max(b.abs()) + 1e-12 * greatest,
            Rule::OfFactor(share) => apart <= share * self.factor + 1e-6 * b.abs(),
            Rule::Gate => !self.passed || within_gate(a, b, key, self.route, self.fields),
            Rule::Curve | Rule::Events => false,
        }
    }

    /// Returns the greatest number in the rows of a driven point.
    fn greatest_row(&self) -> f64 {
        self.again["rows"].as_array().into_iter().flatten().map(greatest_number).fold(0.0, f64::max)
    }
}

/// Returns true if a stored residual is within its gate. The certificate of limit analysis is recomputed from stored fields.
fn within_gate(stored: f64, again: f64, key: &str, route: Route, fields: bool) -> bool {
    let name = key.rsplit('.').next().unwrap_or(key);
    let gate = match (route, name) {
        (Route::Events, "path_energy") => EVENT_ENERGY,
        _ => tolerance(name).result,
    };
    let recomputed = route == Route::Limit && fields;
    recomputed || (gate.is_finite() && stored <= gate) || (stored - again).abs() <= 1e-9 * again.abs().max(1.0)
}

/// The kind of solver of a case.
fn route(solver: Option<&str>) -> Route {
    match solver {
        Some("event_path") => Route::Events,
        Some(tag) if card(PluginKind::LimitSolver, tag).is_some() => Route::Limit,
        _ => Route::Steps,
    }
}

/// Returns the key of an entry of a list: the key of the list. The columns of a driven point have separate keys,
/// because each has its unit; so have outputs.
fn item(key: &str, index: usize) -> String {
    match key {
        "rows" => "rows.".into(),
        "rows." => format!("rows.{index}"),
        "outputs" => format!("outputs.{index}"),
        _ => key.into(),
    }
}

/// Stores the greatest number of each key.
fn measure(value: &Json, key: &str, greatest: &mut HashMap<String, f64>) {
    match value {
        Json::Number(number) => {
            let own = greatest.entry(key.into()).or_insert(0.0);
            *own = own.max(number.as_f64().map_or(0.0, f64::abs));
        }
        Json::Array(items) => {
            items.iter().enumerate().for_each(|(index, own)| measure(own, &item(key, index), greatest));
        }
        Json::Object(map) => map.iter().for_each(|(name, own)| {
            let key = if key.is_empty() { name.clone() } else { format!("{key}.{name}") };
            measure(own, &key, greatest);
        }),
        _ => {}
    }
}

/// The greatest absolute value of a list.
fn greatest_number(list: &Json) -> f64 {
    list.as_array().into_iter().flatten().filter_map(Json::as_f64).fold(0.0, |most, x| most.max(x.abs()))
}
