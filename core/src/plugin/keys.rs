//! Keys declared by a struct: the typed form of [`Parameter`].

use super::schema::{Need, Parameter, Shape};
use super::units::same;

#[doc(hidden)]
pub use serde;

/// A table of keys; a struct declares each key once.
///
/// `#[derive(Keys)]` makes the card's parameters, the reader and the writer (serde's `Deserialize` and `Serialize`) from the
/// fields. Users read the doc comment of a field as the meaning of the key: only its first paragraph, and a single
/// sentence without its full stop. Give meaning and sign convention.
///
/// ```
/// use voussoir_core::plugin::{Card, Keys, PluginKind};
///
/// /// Friction that ends at a strength.
/// #[derive(Debug, Clone, Keys)]
/// pub struct Capped {
///     /// coefficient of friction μ
///     #[key(unit = "-", range = ">= 0")]
///     pub friction: f64,
///     /// greatest shear stress, in both directions
///     #[key(unit = "Pa", range = "> 0", default = 1e6)]
///     pub strength: f64,
///     /// stiffness of the joint itself
///     #[key(unit = "Pa/m", range = "> 0", optional = "the joint itself is stiff")]
///     pub stiffness: Option<f64>,
/// }
///
/// const CARD: Card = Card { kind: PluginKind::InterfaceLaw, tag: "capped", ..Card::of::<Capped>() };
/// assert_eq!(CARD.parameters.len(), 3);
/// ```
///
/// | `#[key(…)]` | of | meaning |
/// |---|---|---|
/// | `unit = "Pa"` | `f64` | the SI unit of the number; `"-"` for a pure number |
/// | `range = "> 0"` | number | comparisons with numbers or constants: `">= 0, < 90"`, or a constant of type `Range` |
/// | `default = 0.0` | any | the value of an absent key: number, text, bool, list, or `{}` |
/// | `optional = "…"` | `Option` | there is no single default: the effect if the key is absent |
/// | `reference = "joints"` | `String` | the name of an entry of a top-level table of the study |
/// | `names = ["x", "y"]` | array | the entries of `[f64; 2]`; `unit` and `range` may be lists, one for each |
/// | `len = ">= 1"` | `Vec` | the number of entries |
/// | `like = Shared` | any | the key of the same name of another struct, which describes it; `Option`, `default` and `optional` are the field's own; `default` without a value is the shared one |
/// | `name = "…"`, `doc = "…"` | any | replaces the field's name or doc comment |
/// | `shape = …`, `of = …` | any | a constant of type [`Shape`] for the value, or for the entries of a list or map |
///
/// Other types of a field implement [`KeyValue`]: another struct with keys, a plug-in (`Box<dyn Scene>`), or an enum with
/// `#[derive(Keys)]`. An enum is a list of words, or of tables that are distinguished by a word (`#[keys(tag = "shape")]`) or
/// by their form (`#[keys(untagged)]`).
/// `#[keys(check = Law::validate)]` on a struct names the check of the whole table.
///
/// A unit that does not exist, or a default outside its range, is a compile error:
/// ```compile_fail
/// #[derive(voussoir_core::plugin::Keys)]
/// struct Law {
///     /// strength
///     #[key(unit = "Pascal")]
///     strength: f64,
/// }
/// ```
/// ```compile_fail
/// #[derive(voussoir_core::plugin::Keys)]
/// struct Law {
///     /// strength
///     #[key(unit = "Pa", range = "> 0", default = -1.0)]
///     strength: f64,
/// }
/// ```
pub trait Keys: serde::Serialize + serde::de::DeserializeOwned {
    /// The keys, in the order of the fields.
    const PARAMETERS: &'static [Parameter];

    /// Returns the mistakes in the combination of keys: pairs of key and sentence. Single keys are already checked.
    fn check(&self) -> Vec<(String, String)> {
        Vec::new()
    }

    /// Returns the table without any key.
    ///
    /// # Panics
    /// A key must be given.
    fn defaults() -> Self {
        read_default("{}")
    }

    /// Returns the default of a key.
    ///
    /// # Panics
    /// There is no such key, or it has no default, or its default has another type.
    fn default_of<T: serde::de::DeserializeOwned>(key: &str) -> T {
        read_default(shared_default(like(Self::PARAMETERS, key)))
    }
}

/// A value that a key may hold.
pub trait KeyValue {
    /// Its form in a study file.
    const SHAPE: Shape;
}

impl KeyValue for serde_json::Value {
    const SHAPE: Shape = Shape::Free;
}

impl KeyValue for serde_json::Map<String, serde_json::Value> {
    const SHAPE: Shape = Shape::Map(&Shape::Free);
}

/// A default in the form that the compiler can check.
#[doc(hidden)]
#[derive(Debug, Clone, Copy)]
pub enum Literal {
    Number(f64),
    Word(&'static str),
    Other,
}

/// Returns the parameter of this name.
#[doc(hidden)]
pub const fn like(parameters: &'static [Parameter], name: &str) -> Parameter {
    let mut i = 0;
    while i < parameters.len() {
        if same(parameters[i].name, name) {
            return parameters[i];
        }
        i += 1;
    }
    panic!("`like` names a struct that has no key of this name")
}

/// Returns the need of an optional key that another struct describes.
#[doc(hidden)]
pub const fn otherwise(like: Parameter) -> Need {
    match like.need {
        Need::Optional(_) => like.need,
        _ => panic!("say what happens without this key: #[key(optional = \"…\")]"),
    }
}

/// Returns the default of a key that another struct describes.
#[doc(hidden)]
pub const fn shared_default(like: Parameter) -> &'static str {
    match like.need {
        Need::Default(text) => text,
        _ => panic!("the key that `like` names has no default"),
    }
}

/// Refuses a default that its key does not accept.
#[doc(hidden)]
pub const fn check_default(shape: &Shape, default: Literal) {
    match (shape, default) {
        (Shape::Number(_, range), Literal::Number(number)) => {
            assert!(range.contains(number), "the default is out of the range of its key");
        }
        (Shape::Integer { min, max }, Literal::Number(number)) => {
            assert!(number >= *min as f64 && number <= *max as f64, "the default is out of the range of its key");
        }
        (Shape::Choice(words), Literal::Word(word)) => {
            let mut i = 0;
            while i < words.len() && !same(words[i], word) {
                i += 1;
            }
            assert!(i < words.len(), "the default is not one of the words of its key");
        }
        (Shape::Boolean | Shape::Number(..) | Shape::Integer { .. } | Shape::Choice(_), Literal::Other)
        | (Shape::Either(_) | Shape::Text | Shape::Reference(_), _)
        | (_, Literal::Other) => {}
        _ => panic!("the default has another type than its key"),
    }
}

/// Returns the default of an absent key.
#[doc(hidden)]
pub fn read_default<T: serde::de::DeserializeOwned>(text: &str) -> T {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("the default {text} does not fit its key: {error}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plugin::{Quantity, Range};
    use serde_json::json;

    /// The ends of a ring.
    #[derive(Debug, Clone, Copy, PartialEq, crate::plugin::Keys)]
    enum Ends {
        Bonded,
        PartlyJointed,
    }

    /// Distinguished by a word.
    #[derive(Debug, Clone, PartialEq, crate::plugin::Keys)]
    #[keys(tag = "shape")]
    enum Profile {
        /// half ellipse
        Elliptical {
            /// clear span
            #[key(unit = "m", range = "> 0")]
            span: f64,
            /// of the crown
            #[key(unit = "m", default = 0.25)]
            rise: f64,
        },
        /// flat.
        Flat,
    }

    /// Distinguished by their form.
    #[derive(Debug, Clone, PartialEq, crate::plugin::Keys)]
    #[keys(untagged)]
    enum Thickness {
        #[key(unit = "m")]
        Even(f64),
        Tapered(Taper),
    }

    #[derive(Debug, Clone, PartialEq, crate::plugin::Keys)]
    struct Taper {
        /// at the crown. Two sentences keep their full stops.
        #[key(unit = "m", range = "> 0")]
        crown: f64,
        /// at the springing
        #[key(unit = "m", default = 0.5)]
        low: f64,
    }

    const MOST: usize = 7;

    #[derive(Debug, Clone, PartialEq, crate::plugin::Keys)]
    #[keys(check = Table::whole)]
    struct Table {
        #[key(like = Taper)]
        crown: f64,
        #[key(like = Taper, default)]
        low: f64,
        /// how it ends
        #[key(default = "partly_jointed")]
        ends: Ends,
        /// its shape
        profile: Profile,
        /// along the joints
        #[key(optional = "it is even")]
        thickness: Option<Thickness>,
        /// pairs of compaction
        /// and pressure
        ///
        /// More for readers of the code.
        #[key(names = ["compaction", "pressure"], unit = ["-", "Pa"], range = [">= 0, < 1", "> 0"], len = ">= 1", optional = "none")]
        hardening: Vec<[f64; 2]>,
        /// how many
        #[key(range = ">= 1, < MOST", default = 3)]
        count: usize,
        /// the law
        #[key(reference = "joints", name = "type")]
        kind: String,
        /// anything
        #[key(default = {})]
        free: serde_json::Value,
    }

    impl Table {
        fn whole(&self) -> Vec<(String, String)> {
            vec![("count".into(), format!("{}", self.count))]
        }
    }

    #[test]
    fn a_struct_is_the_one_declaration_of_its_keys() {
        let table = json!({ "crown": 0.5, "profile": { "shape": "elliptical", "span": 3.0 }, "type": "dry" });
        let read: Table = serde_json::from_value(table).unwrap();
        assert_eq!(read.ends, Ends::PartlyJointed);
        assert_eq!(read.profile, Profile::Elliptical { span: 3.0, rise: 0.25 });
        assert_eq!((read.low, read.crown), (0.5, 0.5));
        assert_eq!((read.count, read.hardening.len(), read.thickness.is_none()), (3, 0, true));
        assert_eq!(read.check(), [("count".to_string(), "3".to_string())]);
        let names: Vec<_> = Table::PARAMETERS.iter().map(|key| key.name).collect();
        assert_eq!(names, ["crown", "low", "ends", "profile", "thickness", "hardening", "count", "type", "free"]);
        let written = serde_json::to_value(&read).unwrap();
        let present = names.iter().filter(|name| **name != "thickness");
        assert!(written.as_object().unwrap().keys().eq(present), "an absent key is not written");
        assert_eq!(serde_json::from_value::<Table>(written).unwrap(), read);
        assert!(serde_json::from_value::<Taper>(json!({ "crown": 1.0, "crow": 1.0 })).is_err());
        assert!(serde_json::from_value::<Profile>(json!({ "shape": "flat", "span": 1.0 })).is_err());
    }

    #[test]
    fn shapes_are_those_of_the_types() {
        let shape = |name: &str| like(Table::PARAMETERS, name).shape;
        assert!(matches!(shape("ends"), Shape::Choice(["bonded", "partly_jointed"])));
        assert!(matches!(shape("count"), Shape::Integer { min: 1, max: 6 }));
        assert!(matches!(shape("type"), Shape::Reference("joints")));
        let Shape::List { of: Shape::Tuple([(_, first), ("pressure", second)]), min: 1, max: usize::MAX } =
            shape("hardening")
        else {
            panic!("{:?}", shape("hardening"))
        };
        assert!(matches!(second, Shape::Number(Quantity::Stress, Range::POSITIVE)));
        assert!(matches!(first, Shape::Number(Quantity::Ratio, range) if range.contains(0.0) && !range.contains(1.0)));
        assert!(matches!(shape("thickness"), Shape::Either([Shape::Number(Quantity::Length, _), Shape::Table(_)])));
        let Shape::Tagged { key: "shape", variants: [one, Variant { tag: "flat", doc: "flat", parameters: [] }] } =
            shape("profile")
        else {
            panic!("{:?}", shape("profile"))
        };
        assert_eq!((one.tag, one.doc, one.parameters[1].need), ("elliptical", "half ellipse", Need::Default("0.25")));
        assert_eq!(like(Table::PARAMETERS, "hardening").doc, "pairs of compaction and pressure");
        assert_eq!(like(Table::PARAMETERS, "crown").doc, Taper::PARAMETERS[0].doc);
        assert!(Taper::PARAMETERS[0].doc.ends_with("full stops."));
    }

    /// A field that is `like` an optional key is optional with the same effect, and the default of a key is found by its name.
    #[test]
    fn what_a_key_shares_is_its_need() {
        let optional = otherwise(like(Table::PARAMETERS, "thickness"));
        assert_eq!(optional, Need::Optional("it is even"));
        assert_eq!(Table::default_of::<usize>("count"), 3);
        assert_eq!(Taper::default_of::<f64>("low"), 0.5);
        assert!(Taper { crown: 1.0, low: 0.5 }.check().is_empty(), "a table without a check has no mistakes");
    }

    #[test]
    #[should_panic = "say what happens without this key"]
    fn a_key_with_a_default_is_no_optional_key() {
        let _ = otherwise(like(Table::PARAMETERS, "count"));
    }

    #[test]
    #[should_panic = "has no default"]
    fn a_required_key_has_no_default() {
        Taper::default_of::<f64>("crown");
    }

    #[test]
    #[should_panic = "no key of this name"]
    fn a_key_that_does_not_exist_describes_none() {
        like(Taper::PARAMETERS, "lo");
    }

    /// Both ends of the range of an integer are allowed defaults; the numbers beside them are refused.
    #[test]
    fn a_default_is_compared_with_both_ends_of_a_range() {
        let accepted = |number| {
            let range = Shape::Integer { min: 1, max: 6 };
            std::panic::catch_unwind(|| check_default(&range, Literal::Number(number))).is_ok()
        };
        assert_eq!([0.0, 1.0, 6.0, 7.0].map(accepted), [false, true, true, false]);
    }

    #[test]
    #[should_panic = "out of the range"]
    fn a_default_out_of_its_range_is_refused() {
        check_default(&Shape::Number(Quantity::Stress, Range::POSITIVE), Literal::Number(0.0));
    }

    #[test]
    #[should_panic = "not one of the words"]
    fn a_default_that_is_no_choice_is_refused() {
        check_default(&Shape::Choice(&["one", "other"]), Literal::Word("another"));
    }

    #[test]
    #[should_panic = "another type"]
    fn a_default_of_another_type_is_refused() {
        check_default(&Shape::Boolean, Literal::Number(1.0));
    }

    use crate::plugin::schema::Variant;
}
