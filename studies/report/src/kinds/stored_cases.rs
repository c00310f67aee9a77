//! Reads results.json from its beginning to its end, one case at a time: the memory does not grow with the number of cases.

use serde::de::{DeserializeSeed, Deserializer, Error, IgnoredAny, MapAccess, SeqAccess, Visitor};
use serde_json::{Map, Value as Json};
use std::fmt;
use std::io::{BufReader, Read};

/// Passes on each case with the entries that come before all cases. Returns the entries beside the cases; an error if it is
/// not a results file.
pub fn read_stored_cases(file: impl Read, take: Take) -> Result<Map<String, Json>, String> {
    let mut text = serde_json::Deserializer::from_reader(BufReader::with_capacity(1 << 16, file));
    let whole = Whole(take).deserialize(&mut text).map_err(|error| error.to_string())?;
    text.end().map_err(|error| error.to_string())?;
    Ok(whole)
}

/// Returns the entries before the cases, as far as they can be read.
pub fn read_head(file: impl Read) -> Map<String, Json> {
    let mut head = Map::new();
    let mut text = serde_json::Deserializer::from_reader(BufReader::with_capacity(1 << 16, file));
    // This ends with an error, because the cases are not read.
    drop(Head(&mut head).deserialize(&mut text));
    head
}

/// The entries before the cases, added to a map.
struct Head<'a>(&'a mut Map<String, Json>);

impl<'de> DeserializeSeed<'de> for Head<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        deserializer.deserialize_map(self)
    }
}

impl<'de> Visitor<'de> for Head<'_> {
    type Value = ();

    fn expecting(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        formatter.write_str("results of a study")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<(), A::Error> {
        while let Some(key) = map.next_key::<String>()? {
            if key == "cases" {
                return Err(A::Error::custom("the cases are not read"));
            }
            self.0.insert(key, map.next_value()?);
        }
        Ok(())
    }
}

/// Receives the head of the file and a case.
pub type Take<'a> = &'a mut dyn FnMut(&Map<String, Json>, Json);

/// The whole file.
struct Whole<'a>(Take<'a>);

impl<'de> DeserializeSeed<'de> for Whole<'_> {
    type Value = Map<String, Json>;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Self::Value, D::Error> {
        deserializer.deserialize_map(self)
    }
}

impl<'de> Visitor<'de> for Whole<'_> {
    type Value = Map<String, Json>;

    fn expecting(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        formatter.write_str("results of a study")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
        let (mut beside, mut listed) = (Map::new(), false);
        while let Some(key) = map.next_key::<String>()? {
            if (key == "cases" && listed) || beside.contains_key(&key) {
                return Err(A::Error::custom(format!("\"{key}\" stands there twice")));
            }
            if key == "cases" {
                map.next_value_seed(Cases(&beside, &mut *self.0))?;
                listed = true;
            } else {
                beside.insert(key, map.next_value()?);
            }
        }
        if listed { Ok(beside) } else { Err(A::Error::custom("there is no list of cases")) }
    }
}

/// The list of cases.
struct Cases<'a>(&'a Map<String, Json>, Take<'a>);

impl<'de> DeserializeSeed<'de> for Cases<'_> {
    type Value = IgnoredAny;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Self::Value, D::Error> {
        deserializer.deserialize_seq(self)
    }
}

impl<'de> Visitor<'de> for Cases<'_> {
    type Value = IgnoredAny;

    fn expecting(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        formatter.write_str("a list of cases")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<IgnoredAny, A::Error> {
        while let Some(case) = list.next_element()? {
            (self.1)(self.0, case);
        }
        Ok(IgnoredAny)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn cases_come_one_by_one_and_the_rest_stays() {
        let read = |text: &str| {
            let mut cases = Vec::new();
            read_stored_cases(text.as_bytes(), &mut |_, case| cases.push(case))
                .map(|beside| (Json::from(beside), cases))
        };
        let (beside, cases) = read(r#"{ "study": "a", "cases": [1, { "b": 0.1 }], "own": [] }"#).expect("results");
        assert_eq!((beside, cases), (json!({ "study": "a", "own": [] }), vec![json!(1), json!({ "b": 0.1 })]));
        for wrong in [
            "",
            "[]",
            "{}",
            r#"{ "cases": 1 }"#,
            r#"{ "cases": [1, }"#,
            r#"{ "cases": [], "cases": [] }"#,
            r#"{ "study": "a", "cases": [], "study": "b" }"#,
            r#"{ "cases": [] } x"#,
        ] {
            assert!(read(wrong).is_err(), "{wrong}");
        }
    }
}
