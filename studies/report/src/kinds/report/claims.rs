//! Claims, their tests, and the verdicts from the numbers.

use super::evaluate::evaluate;
use super::expression::Expression;
use super::value::{SeriesByName, Value};
use serde::Serialize;
use serde_json::{Value as Json, json};
use voussoir_core::plugin::Keys;

/// The table `[[report.claims]]`.
#[derive(Debug, Clone, PartialEq, Keys)]
pub struct Claim {
    /// number or name of the claim
    pub id: String,
    /// text of the claim
    pub claim: String,
    /// place of the claim in its source
    #[key(default = "")]
    pub source: String,
    /// difference between the tests, named if some hold and some do not
    #[key(optional = "one test")]
    pub depends_on: Option<String>,
    /// one sentence on the reading that the source probably had: model, kinematics, strength, mesh
    #[key(optional = "no reading is shown")]
    pub reading: Option<String>,
    /// notes for the reader, in Markdown
    #[key(default = "")]
    pub remark: String,
    /// tests that decide about the claim
    #[key(len = ">= 1, <= 100")]
    pub tests: Vec<Test>,
}

/// A test of a claim.
#[derive(Debug, Clone, PartialEq, Keys)]
pub struct Test {
    /// subject of the test: a model, a rise, a settlement
    pub of: String,
    /// expression of series: the number behind the test
    pub value: String,
    /// its unit
    #[key(default = "")]
    pub unit: String,
    /// condition on `value` and series under which the claim holds in this test
    pub holds: String,
}

/// The verdict of a claim.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Every test holds.
    Reproduced,
    /// No test holds.
    Refuted,
    /// Some tests hold.
    DependsOn,
    /// A number that a test needs is missing, or a test holds with some settings only.
    Undecided,
}

impl Verdict {
    /// Returns the verdict in words.
    pub fn words(self) -> &'static str {
        match self {
            Verdict::Reproduced => "reproduced",
            Verdict::Refuted => "refuted",
            Verdict::DependsOn => "depends on",
            Verdict::Undecided => "undecided",
        }
    }
}

/// The result of a test.
#[derive(Debug, Clone, PartialEq)]
pub struct Tested {
    /// The number of the test, with the finest settings.
    pub value: Value,
    /// The numbers with coarser settings, from coarse to fine, if one differs.
    pub coarser: Vec<Value>,
    /// True if the test holds; `None` if a number is missing, or if the test holds with some settings only.
    pub holds: Option<bool>,
}

/// A claim with its verdict.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer<'a> {
    /// The claim.
    pub claim: &'a Claim,
    /// The verdict from the numbers.
    pub verdict: Verdict,
    /// Results of the tests.
    pub tests: Vec<Tested>,
}

impl Claim {
    /// Returns the verdict of the claim. Each of `levels` returns a series by its name, with finer settings than the one before.
    pub fn answer(&self, levels: &[SeriesByName<'_>]) -> Answer<'_> {
        let tests: Vec<Tested> = self.tests.iter().map(|test| test.at_levels(levels)).collect();
        let all = |holds: bool| tests.iter().all(|test| test.holds == Some(holds));
        let verdict = match () {
            () if tests.iter().any(|test| test.holds.is_none()) => Verdict::Undecided,
            () if all(true) => Verdict::Reproduced,
            () if all(false) => Verdict::Refuted,
            () => Verdict::DependsOn,
        };
        Answer { claim: self, verdict, tests }
    }
}

impl Test {
    /// Runs the test with coarse and fine settings. It is decided only if all agree.
    fn at_levels(&self, levels: &[SeriesByName<'_>]) -> Tested {
        let mut results: Vec<(Value, Option<bool>)> = levels.iter().map(|series| self.run(series)).collect();
        let (value, holds) = results.pop().unwrap_or_else(|| (Value::unknown("there are no results"), None));
        let agree = results.iter().all(|(_, coarse)| *coarse == holds);
        let coarser: Vec<Value> = results.into_iter().map(|(value, _)| value).collect();
        let coarser = if coarser.iter().any(|coarse| *coarse != value) { coarser } else { Vec::new() };
        Tested { value, coarser, holds: holds.filter(|_| agree) }
    }

    fn run(&self, series: SeriesByName<'_>) -> (Value, Option<bool>) {
        let value = match Expression::parse(&self.value) {
            Ok(expression) => evaluate(&expression, series),
            Err(why) => Value::unknown(why),
        };
        let names = |name: &str| if name == "value" { Some(value.clone()) } else { series(name) };
        let holds = Expression::parse(&self.holds).map(|expression| evaluate(&expression, &names));
        let holds = match holds {
            Ok(Value::Truth(truth)) => Some(truth),
            _ => None,
        };
        (value, holds)
    }
}

impl Answer<'_> {
    /// Returns the verdict in one line: `depends on the strength`.
    pub fn words(&self) -> String {
        match (self.verdict, &self.claim.depends_on) {
            (Verdict::DependsOn, Some(parameter)) => format!("depends on {parameter}"),
            (verdict, _) => verdict.words().into(),
        }
    }

    /// Returns the entry for results.json.
    pub fn entry(&self) -> Json {
        let test = |(test, tested): (&Test, &Tested)| {
            let plain = |value: &Value| match value {
                Value::Number(x) if x.is_finite() => json!(x),
                Value::Truth(truth) => json!(truth),
                other => json!(other.describe()),
            };
            let mut entry = json!({ "of": test.of, "value": plain(&tested.value), "unit": test.unit, "expression": test.value,
                                    "condition": test.holds, "holds": tested.holds });
            if !tested.coarser.is_empty() {
                entry["coarser"] = tested.coarser.iter().map(plain).collect();
            }
            entry
        };
        let mut entry = json!({
            "id": self.claim.id,
            "claim": self.claim.claim,
            "source": self.claim.source,
            "verdict": self.verdict,
            "depends_on": self.claim.depends_on.as_ref().filter(|_| self.verdict == Verdict::DependsOn),
            "tests": self.claim.tests.iter().zip(&self.tests).map(test).collect::<Vec<_>>(),
        });
        if let Some(reading) = &self.claim.reading {
            entry["reading"] = json!(reading);
        }
        entry
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn verdict(conditions: &[&str]) -> Verdict {
        let test = |holds: &&str| Test {
            of: String::new(),
            value: "2 * a".into(),
            unit: String::new(),
            holds: holds.to_string(),
        };
        let claim = Claim {
            id: "1".into(),
            claim: String::new(),
            source: String::new(),
            depends_on: Some("a".into()),
            reading: None,
            remark: String::new(),
            tests: conditions.iter().map(test).collect(),
        };
        claim.answer(&[&|name| (name == "a").then_some(Value::Number(3.0))]).verdict
    }

    /// A claim that holds on a coarse mesh only is undecided; if all meshes agree, the number comes from the finest.
    #[test]
    fn a_claim_holds_only_if_it_holds_on_all_meshes() {
        let [coarse, fine] = [3.0, 3.5].map(|number| move |name: &str| (name == "a").then_some(Value::Number(number)));
        for (condition, verdict) in [("value < 7.5", Verdict::Reproduced), ("value < 6.5", Verdict::Undecided)] {
            let test = Test { of: String::new(), value: "2 * a".into(), unit: String::new(), holds: condition.into() };
            let claim = Claim {
                id: "1".into(),
                claim: String::new(),
                source: String::new(),
                depends_on: None,
                reading: (condition == "value < 7.5").then(|| "the mesh was fine".to_string()),
                remark: String::new(),
                tests: vec![test],
            };
            let answer = claim.answer(&[&coarse, &fine]);
            assert_eq!(answer.verdict, verdict);
            assert_eq!(answer.entry().get("reading"), claim.reading.as_ref().map(|own| json!(own)).as_ref());
            let entry = &answer.entry()["tests"][0];
            assert_eq!((&entry["value"], &entry["coarser"]), (&json!(7.0), &json!([6.0])));
            assert!(claim.answer(&[&fine, &fine]).entry()["tests"][0].get("coarser").is_none());
        }
    }

    #[test]
    fn verdicts_come_from_numbers() {
        assert_eq!(verdict(&["value == 6", "a < value"]), Verdict::Reproduced);
        assert_eq!(verdict(&["value == 6", "a > value"]), Verdict::DependsOn);
        assert_eq!(verdict(&["value == 5", "a > value"]), Verdict::Refuted);
        assert_eq!(verdict(&["value == 6", "b > value"]), Verdict::Undecided);
    }
}
