//! Compares two runs. Cases with the same variant, scene and swept values are compared with each other.

use super::stored::{StoredCase, StoredJoint, StoredMechanism, StoredRun};
use serde::Serialize;
use serde_json::{Value as Json, json};
use std::collections::{BTreeMap, HashMap, VecDeque};
use voussoir_study::results::format::format_value;
use voussoir_verify::{KeyDifference, key_differences};

/// Significant digits of swept values that identify a case. A search finds its values again with fewer digits.
const DIGITS: [usize; 2] = [12, 6];

/// A result that differs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Change {
    /// Name of the entry.
    pub entry: String,
    /// Its value in the first run; `null` without a value.
    pub a: Json,
    /// Its value in the second run.
    pub b: Json,
    /// (b − a) / |a|, if both are numbers; for a driven point, relative to the greatest number of the column.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub relative: Option<f64>,
    #[serde(skip)]
    weight: f64,
}

impl Change {
    /// A change of a word or of a list.
    fn of_word(entry: &str, a: Json, b: Json, weight: f64) -> Option<Self> {
        (a != b).then(|| Change { entry: entry.into(), a, b, relative: None, weight })
    }

    /// A change of a number that is greater than the tolerance. A number that appears or disappears outweighs all others.
    fn of_number(entry: &str, a: Option<f64>, b: Option<f64>, tolerance: f64) -> Option<Self> {
        let change =
            |relative: Option<f64>, weight| Change { entry: entry.into(), a: a.into(), b: b.into(), relative, weight };
        match (a, b) {
            (Some(a), Some(b)) if a != b => {
                let share = (b - a).abs() / a.abs().max(b.abs());
                (share > tolerance).then(|| change((a != 0.0).then(|| (b - a) / a.abs()), share))
            }
            (Some(_), None) | (None, Some(_)) => Some(change(None, f64::INFINITY)),
            _ => None,
        }
    }
}

/// Identifies a case for readers.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct CaseName {
    /// Its id.
    pub id: usize,
    /// Variant, scene and swept values in words; empty for the only case of a study.
    pub name: String,
}

impl CaseName {
    fn of(case: &StoredCase) -> Self {
        let values = case.parameters.iter().map(|(key, value)| format!("{key} = {}", format_value(value)));
        let words: Vec<String> = case.variant.iter().chain(&case.scene).cloned().chain(values).collect();
        CaseName { id: case.id, name: words.join(", ") }
    }
}

/// A case that differs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CaseDifference {
    /// The case in the first run.
    pub a: CaseName,
    /// The case in the second run.
    pub b: CaseName,
    /// Its results that differ.
    pub changes: Vec<Change>,
}

impl CaseDifference {
    /// The greatest relative change; infinite if the status differs.
    fn weight(&self) -> f64 {
        self.changes.iter().map(|change| change.weight).fold(0.0, f64::max)
    }
}

/// The differences of two runs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RunDifference {
    /// Greatest relative change of numbers that count as equal.
    pub tolerance: f64,
    /// Studies, and versions and commits of the programs.
    pub runs: [RunName; 2],
    /// Keys of the studies that differ; `None` if a study is not stored.
    pub inputs: Option<Vec<KeyDifference>>,
    /// Number of cases that both runs have.
    pub compared: usize,
    /// Cases that only the first run has.
    pub only_a: Vec<CaseName>,
    /// Cases that only the second run has.
    pub only_b: Vec<CaseName>,
    /// Cases that differ, the largest change first.
    pub cases: Vec<CaseDifference>,
    /// Other results that differ, such as `optima`.
    pub others: Vec<Change>,
}

/// The study and the program of a run.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct RunName {
    /// Name of the study.
    pub study: String,
    /// Version and commit of the program.
    pub program: String,
}

impl RunDifference {
    /// Returns true if both runs have the same cases with the same results. Inputs are not considered.
    pub fn is_equal(&self) -> bool {
        self.only_a.is_empty() && self.only_b.is_empty() && self.cases.is_empty() && self.others.is_empty()
    }
}

/// Compares two runs; numbers are equal if they differ by at most `tolerance` times the greater one.
pub fn compare(a: &StoredRun, b: &StoredRun, tolerance: f64) -> RunDifference {
    let pairs = pairs(&a.cases, &b.cases);
    let mut only_b = vec![true; b.cases.len()];
    pairs.iter().flatten().for_each(|place| only_b[*place] = false);
    let both = a.cases.iter().zip(&pairs).filter_map(|(case, place)| Some((case, &b.cases[(*place)?])));
    let mut cases: Vec<CaseDifference> = both
        .map(|(a, b)| CaseDifference { a: CaseName::of(a), b: CaseName::of(b), changes: changes(a, b, tolerance) })
        .filter(|case| !case.changes.is_empty())
        .collect();
    cases.sort_by(|a, b| b.weight().total_cmp(&a.weight()));
    let mut others = Vec::new();
    value_changes("", &Json::from(a.others.clone()), &Json::from(b.others.clone()), tolerance, &mut others);
    let name = |run: &StoredRun| RunName { study: run.study.clone(), program: run.program.clone() };
    RunDifference {
        tolerance,
        runs: [name(a), name(b)],
        inputs: a.resolved.as_ref().zip(b.resolved.as_ref()).map(|(a, b)| key_differences(a, b)),
        compared: pairs.iter().flatten().count(),
        only_a: a
            .cases
            .iter()
            .zip(&pairs)
            .filter(|(_, place)| place.is_none())
            .map(|(case, _)| CaseName::of(case))
            .collect(),
        only_b: b.cases.iter().zip(only_b).filter(|(_, only)| *only).map(|(case, _)| CaseName::of(case)).collect(),
        cases,
        others,
    }
}

/// Variant, scene and swept values with some digits.
fn identity(case: &StoredCase, digits: usize) -> String {
    let value = |value: &Json| value.as_f64().map_or(value.to_string(), |x| format!("{:.*e}", digits - 1, x));
    let values: BTreeMap<&String, String> = case.parameters.iter().map(|(key, own)| (key, value(own))).collect();
    format!("{:?}", (&case.variant, &case.scene, values))
}

/// The place of the corresponding case in `b` for each case of `a`.
fn pairs(a: &[StoredCase], b: &[StoredCase]) -> Vec<Option<usize>> {
    let mut pairs = vec![None; a.len()];
    let mut free: Vec<usize> = (0..b.len()).collect();
    for digits in DIGITS {
        let mut places: HashMap<String, VecDeque<usize>> = HashMap::new();
        free.iter().for_each(|place| places.entry(identity(&b[*place], digits)).or_default().push_back(*place));
        for (case, pair) in a.iter().zip(&mut pairs).filter(|(_, pair)| pair.is_none()) {
            *pair = places.get_mut(&identity(case, digits)).and_then(VecDeque::pop_front);
        }
        free = places.into_values().flatten().collect();
        free.sort_unstable();
    }
    pairs
}

/// The results of a case that differ, the most important first.
fn changes(a: &StoredCase, b: &StoredCase, tolerance: f64) -> Vec<Change> {
    let number = |entry: &str, a: Option<f64>, b: Option<f64>| Change::of_number(entry, a, b, tolerance);
    let factor = number("load_factor", a.load_factor, b.load_factor);
    // Bounds that meet differ together with the load factor.
    let [lower, upper] = [0, 1].map(|end| [a, b].map(|case| case.bounds.and_then(|bounds| bounds[end])));
    let bounds = if factor.is_some() {
        [None, None]
    } else {
        [number("lower_bound", lower[0], lower[1]), number("upper_bound", upper[0], upper[1])]
    };
    let reserve = |case: &StoredCase| case.reserve.and_then(|reserve| reserve.factor);
    let passed = |case: &StoredCase| case.certificate.map(|certificate| certificate.passed).into();
    let words = |case: &StoredCase| case.mechanism.as_ref().map(mechanism_words).into();
    let mut found =
        vec![Change::of_word("status", a.status.clone().into(), b.status.clone().into(), f64::INFINITY), factor];
    found.extend(bounds);
    found.push(number("first_limit_point", a.first_limit_point, b.first_limit_point));
    found.push(number("reserve", reserve(a), reserve(b)));
    found.push(Change::of_word("certificate_passed", passed(a), passed(b), f64::INFINITY));
    found.push(Change::of_word("mechanism", words(a), words(b), 0.0));
    found.push(limit_points(a, b, tolerance));
    found.extend(columns(a, b, tolerance));
    found.into_iter().flatten().collect()
}

/// `four_hinge: hinges 1 5 9 14, sliding 3`.
fn mechanism_words(mechanism: &StoredMechanism) -> String {
    let lists = [("hinges", &mechanism.hinges), ("sliding", &mechanism.sliding), ("crushing", &mechanism.crushing)];
    let joints = |list: &[StoredJoint]| list.iter().map(|own| own.joint.to_string()).collect::<Vec<_>>().join(" ");
    let lists =
        lists.iter().filter(|(_, list)| !list.is_empty()).map(|(name, list)| format!("{name} {}", joints(list)));
    let moving = mechanism.contacts.iter().map(|own| format!("{} {}", own.modes.join("+"), own.joint));
    format!("{}: {}", mechanism.kind, lists.chain(moving).collect::<Vec<_>>().join(", "))
}

/// The limit points of both cases, if one of them differs.
fn limit_points(a: &StoredCase, b: &StoredCase, tolerance: f64) -> Option<Change> {
    let (points, others) = (&a.limit_points, &b.limit_points);
    let same = points.len() == others.len()
        && points.iter().zip(others).all(|(a, b)| {
            a.stage == b.stage && Change::of_number("", Some(a.factor), Some(b.factor), tolerance).is_none()
        });
    let list =
        |case: &StoredCase| Json::from_iter(case.limit_points.iter().map(|point| json!([point.stage, point.factor])));
    (!same).then(|| Change { entry: "limit_points".into(), a: list(a), b: list(b), relative: None, weight: 0.0 })
}

/// For driven points: the columns whose numbers differ, relative to the greatest number of the column. A change contains
/// the two numbers that differ most.
fn columns(a: &StoredCase, b: &StoredCase, tolerance: f64) -> Vec<Option<Change>> {
    let outline = |case: &StoredCase| json!({ "rows": case.rows.len(), "columns": case.columns });
    if outline(a) != outline(b) {
        return vec![Change::of_word("rows", outline(a), outline(b), f64::INFINITY)];
    }
    let column = |(place, name): (usize, &String)| {
        let number = |row: &Vec<Option<f64>>| row.get(place).copied().flatten();
        let pairs = || a.rows.iter().zip(&b.rows).map(|(a, b)| (number(a), number(b)));
        let numbers = pairs().flat_map(|(a, b)| [a, b]).flatten();
        let greatest = numbers.fold(0.0, |most: f64, x| most.max(x.abs()));
        let distance = |(a, b): &(Option<f64>, Option<f64>)| match (a, b) {
            (None, None) => 0.0,
            (Some(a), Some(b)) if greatest > 0.0 => (b - a).abs() / greatest,
            (Some(_), Some(_)) => 0.0,
            _ => f64::INFINITY,
        };
        let farthest = pairs().max_by(|one, other| distance(one).total_cmp(&distance(other)))?;
        let weight = distance(&farthest);
        let relative = farthest.0.zip(farthest.1).map(|(a, b)| (b - a) / greatest);
        let (a, b) = (farthest.0.into(), farthest.1.into());
        (weight > tolerance).then(|| Change { entry: name.clone(), a, b, relative, weight })
    };
    a.columns.iter().enumerate().map(column).collect()
}

/// Adds the values inside two JSON values that differ, with their paths.
fn value_changes(path: &str, a: &Json, b: &Json, tolerance: f64, found: &mut Vec<Change>) {
    let inner = |key: &str| if path.is_empty() { key.to_string() } else { format!("{path}.{key}") };
    match (a, b) {
        (Json::Object(one), Json::Object(other)) => {
            let keys = one.keys().chain(other.keys().filter(|key| !one.contains_key(*key)));
            keys.for_each(|key| value_changes(&inner(key), &a[key], &b[key], tolerance, found));
        }
        (Json::Array(one), Json::Array(other)) => {
            let value = |list: &[Json], place: usize| list.get(place).cloned().unwrap_or_default();
            for place in 0..one.len().max(other.len()) {
                value_changes(&inner(&place.to_string()), &value(one, place), &value(other, place), tolerance, found);
            }
        }
        (Json::Number(_), Json::Number(_)) => found.extend(Change::of_number(path, a.as_f64(), b.as_f64(), tolerance)),
        _ => found.extend(Change::of_word(path, a.clone(), b.clone(), f64::INFINITY)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(cases: Json, resolved: &str) -> StoredRun {
        let text = json!({ "study": "s", "version": "1", "commit": "c", "optima": [{ "value": 2.0 }], "cases": cases });
        StoredRun::read(text.to_string().as_bytes(), Some(resolved)).expect("results")
    }

    fn case(id: usize, friction: f64, load: Option<f64>) -> Json {
        let status = if load.is_some() { "collapse" } else { "unbounded" };
        json!({
            "id": id, "variant": null, "parameters": { "joints.dry.friction": friction }, "status": status,
            "load_factor": load, "bounds": [load, load], "certificate": { "passed": true },
            "mechanism": { "kind": "four_hinge", "hinges": [{ "joint": 1 }, { "joint": 5 }], "sliding": [], "crushing": [] },
        })
    }

    /// Cases with the same swept values are compared, whatever their order; the rest is listed.
    #[test]
    fn cases_are_matched_by_their_parameters() {
        let a = run(json!([case(0, 0.4, Some(1.0)), case(1, 0.5, Some(2.0)), case(2, 0.6, Some(3.0))]), "x = 1");
        let b = run(json!([case(0, 0.6, Some(3.0)), case(1, 0.4, Some(1.0)), case(2, 0.7, Some(4.0))]), "x = 1.0");
        let found = compare(&a, &b, 1e-9);
        assert_eq!((found.compared, found.cases.len()), (2, 0));
        let names = |cases: &[CaseName]| cases.iter().map(|case| (case.id, case.name.clone())).collect::<Vec<_>>();
        assert_eq!(names(&found.only_a), [(1, "joints.dry.friction = 0.5".to_string())]);
        assert_eq!(names(&found.only_b), [(2, "joints.dry.friction = 0.7".to_string())]);
        assert!(!found.is_equal() && found.inputs == Some(Vec::new()));
        assert!(compare(&a, &a, 0.0).is_equal());
    }

    /// A search finds its value again with a small difference; the two cases are one.
    #[test]
    fn a_value_that_a_search_found_again_is_the_same() {
        let [a, b] = [0.5, 0.500_000_01].map(|x| run(json!([case(0, x, Some(2.0))]), ""));
        assert_eq!(compare(&a, &b, 1e-6).compared, 1);
        let b = run(json!([case(0, 0.5001, Some(2.0))]), "");
        assert_eq!(compare(&a, &b, 1e-6).compared, 0);
    }

    /// A change of status is above every change of a number, and larger changes are above smaller ones.
    #[test]
    fn the_largest_change_is_first() {
        let a = run(json!([case(0, 0.4, Some(1.0)), case(1, 0.5, Some(2.0)), case(2, 0.6, Some(3.0))]), "f = 0.6");
        let b = run(json!([case(0, 0.4, Some(1.01)), case(1, 0.5, Some(3.0)), case(2, 0.6, None)]), "f = 0.5");
        let found = compare(&a, &b, 1e-3);
        assert_eq!(found.cases.iter().map(|case| case.a.id).collect::<Vec<_>>(), [2, 1, 0]);
        assert_eq!(found.cases[0].changes[0].entry, "status");
        let load = &found.cases[1].changes[0];
        assert_eq!(
            (load.entry.as_str(), &load.a, &load.b, load.relative),
            ("load_factor", &json!(2.0), &json!(3.0), Some(0.5))
        );
        assert_eq!(found.inputs.as_ref().map(|keys| keys[0].words()), Some(["0.6".into(), "0.5".into()]));
        assert_eq!(compare(&a, &b, 0.02).cases.len(), 2, "1 % is within 2 %");
        let text = found.text();
        assert!(text.contains("+50 %") && text.contains("0 cases equal, 3 differ"), "{text}");
    }

    /// Mechanisms, limit points, certificates and reserves are compared.
    #[test]
    fn other_results_of_a_case_are_compared() {
        let a = case(0, 0.4, Some(1.0));
        for (key, value) in [
            ("mechanism", json!({ "kind": "four_hinge", "hinges": [{ "joint": 2 }, { "joint": 5 }] })),
            ("mechanism", Json::Null),
            ("limit_points", json!([{ "stage": "live", "factor": 0.5 }])),
            ("first_limit_point", json!(0.5)),
            ("reserve", json!({ "factor": 2.5 })),
            ("certificate", json!({ "passed": false })),
        ] {
            let mut b = a.clone();
            b[key] = value;
            let found = compare(&run(json!([a]), ""), &run(json!([b]), ""), 1e-6);
            assert_eq!(found.cases.first().map(|case| case.changes.len()), Some(1), "{key}");
        }
    }

    /// The numbers of a driven point are compared column by column, relative to the greatest number of the column.
    #[test]
    fn rows_of_a_point_are_compared_by_column() {
        let point = |traction: f64| {
            json!([{ "id": 0, "parameters": {}, "status": "reached", "columns": ["gap [m]", "traction [Pa]"],
                "rows": [[0.0, 1e-9 * traction], [1e-5, traction]] }])
        };
        let found = compare(&run(point(1e6), ""), &run(point(1.1e6), ""), 1e-6);
        assert_eq!(
            found.cases[0].changes.iter().map(|change| change.entry.as_str()).collect::<Vec<_>>(),
            ["traction [Pa]"]
        );
        assert!(compare(&run(point(1e6), ""), &run(point(1.1e6), ""), 0.1).is_equal());
    }

    /// Results beside the cases, such as optima, are compared.
    #[test]
    fn results_beside_the_cases_are_compared() {
        let [a, mut b] = [(); 2].map(|()| run(json!([case(0, 0.4, Some(1.0))]), ""));
        b.others["optima"][0]["value"] = 2.5.into();
        let found = compare(&a, &b, 1e-6);
        assert_eq!(found.others.iter().map(|change| change.entry.as_str()).collect::<Vec<_>>(), ["optima.0.value"]);
    }

    #[test]
    fn a_file_without_results_is_refused() {
        for text in ["", "{}", "[]", r#"{ "cases": [{}] }"#, r#"{ "cases": [{ "id": 0, "status": "collapse" }] }"#] {
            assert!(StoredRun::read(text.as_bytes(), None).is_err(), "{text}");
        }
        assert!(StoredRun::read(&b"{ \"cases\": [] }"[..], Some("x = ")).is_err());
    }
}
