//! Controls for a case: sliders for its numbers, with ranges from the schema and steps from the values, and lists of laws and
//! solvers from the registry.

use super::swap;
use maud::{Markup, html};
use serde_json::Value as Json;
use voussoir_core::plugin::{Quantity, Range};
use voussoir_plot::number::step_below;
use voussoir_study::config::key_meaning::key_meaning;
use voussoir_study::results::format::format_short;
use voussoir_study::study::{NumberKind, NumericKey, PluginTable, numeric_keys, study_keys};

/// Greatest length of a list of numbers with controls.
const LONGEST: usize = 400;
/// Number of steps of a slider.
const PARTS: f64 = 500.0;

/// Headings of the groups of controls, each with its table of the study.
const GROUPS: [(&str, &str); 7] = [
    ("Geometry", "scene"),
    ("Materials", "materials"),
    ("Joints", "joints"),
    ("Vehicles", "vehicles"),
    ("Stages and loads", "stages"),
    ("Partial factors", "factors"),
    ("Solver", "solver"),
];

/// The ends and the step of a slider.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Track {
    pub from: f64,
    pub to: f64,
    pub step: f64,
}

/// Returns the usual greatest value of a quantity, in its unit, if neither value nor range gives one.
fn usual(quantity: Quantity) -> f64 {
    match quantity {
        Quantity::Ratio | Quantity::Length => 1.0,
        Quantity::Degrees => 45.0,
        Quantity::Radians => 0.1,
        Quantity::Force => 1e4,
        Quantity::Stress => 1e6,
        Quantity::Stiffness => 1e11,
        Quantity::Density => 2500.0,
        Quantity::Acceleration => 10.0,
        Quantity::EnergyPerArea => 100.0,
        Quantity::Temperature => 300.0,
        Quantity::Time => 86_400.0,
    }
}

/// Returns the track of a slider: the range of the schema if it is finite, otherwise up to three times the value.
pub(super) fn track(kind: NumberKind, value: f64) -> Track {
    match kind {
        NumberKind::Whole(min, max) => {
            let most = (3.0 * value.max(3.0)).min(max as f64).max(value);
            Track { from: (min as f64).max(value.min(0.0)), to: most, step: 1.0 }
        }
        NumberKind::Real(quantity, range) => real_track(quantity, range, value),
    }
}

fn real_track(quantity: Quantity, range: Range, value: f64) -> Track {
    let far = if value == 0.0 { usual(quantity) } else { 3.0 * value.abs() };
    let from = if range.min.is_finite() {
        range.min
    } else if value > 0.0 {
        0.0
    } else {
        -far
    };
    // If a range ends a little beyond the value, the slider covers it completely.
    let to = if range.max.is_finite() && range.max - from <= 20.0 * far {
        range.max
    } else if value < 0.0 && range.min.is_infinite() {
        0.0
    } else {
        far.max(from + f64::MIN_POSITIVE)
    };
    let step = step_below((to - from) / PARTS);
    let open = |end: f64, is_open: bool, inwards: f64| if is_open && end.is_finite() { end + inwards } else { end };
    let from = if from == range.min { open(from, range.min_open, step) } else { from };
    let to = if to == range.max { open(to, range.max_open, -step) } else { to };
    Track { from: from.min(value), to: to.max(value), step }
}

/// Returns the label of a number: names of the tables above it, its words and its unit.
fn label(key: &NumericKey, resolved: &Json) -> String {
    let meaning = key_meaning(study_keys(), &|name| resolved.get(name), &key.key);
    meaning.map_or(key.key.clone(), |meaning| meaning.title())
}

fn control(key: &NumericKey, resolved: &Json) -> Markup {
    let (label, name) = (label(key, resolved), key.key.as_str());
    let title = format!("{name}: {}", key.doc);
    let exactly = format!("{label}, exactly");
    let given = key.value.map(|value| (value, track(key.kind, value)));
    let field = given.map_or(String::new(), |(value, _)| format_short(value, 12));
    html! {
        div class="control" {
            span { (label) }
            @if let Some((value, Track { from, to, step })) = given {
                input type="range" data-key=(name) min=(from) max=(to) step="any" data-step=(step) value=(value) aria-label=(label);
            }
            input type="text" inputmode="decimal" data-key=(name) value=(field) placeholder="not given" aria-label=(exactly)
                title=(title);
        }
    }
}

/// Returns true for a coordinate or another entry of a list of lists: `scene.blocks.1.vertices.2.1`.
fn is_coordinate(key: &str) -> bool {
    key.rsplit('.').take(2).all(|segment| segment.parse::<usize>().is_ok())
}

/// A list of the laws or solvers that a table may name.
fn choice(table: &PluginTable) -> Markup {
    let name = table.key.rsplit('.').next().unwrap_or(&table.key);
    let tag_key = table.kind.tag_key();
    let label = if name == tag_key { name.to_string() } else { format!("{name}: {tag_key}") };
    html! {
        div class="control" {
            span { (label) }
            select data-table=(table.key) aria-label=(label) {
                @for (tag, summary) in swap::choices(table) {
                    option value=(tag) title=(summary) selected[tag == table.tag] { (tag) }
                }
            }
        }
    }
}

/// A switch that keeps a load at its most onerous position; `movable` are the keys that move loads, with their names.
fn follow(movable: &[(String, String)]) -> Markup {
    html! {
        @for (key, name) in movable {
            label class="follow" {
                input type="checkbox" data-follow=(key);
                " Follow the most onerous position of " (name)
            }
        }
    }
}

/// Returns the controls of a case: lists of laws and solvers, sliders for its numbers, fields for optional numbers that are not
/// given. Coordinates are in one closed panel.
pub(super) fn controls(resolved: &Json, movable: &[(String, String)]) -> Markup {
    let (tables, keys) = (swap::tables(resolved), numeric_keys(study_keys(), resolved, LONGEST));
    let (listed, keys): (Vec<&NumericKey>, Vec<&NumericKey>) = keys.iter().partition(|key| is_coordinate(&key.key));
    let of = |key: &str, table: &str| key.split('.').next() == Some(table);
    html! {
        @for (heading, table) in GROUPS {
            @let choices: Vec<_> = tables.iter().filter(|own| of(&own.key, table)).collect();
            @let own: Vec<&NumericKey> = keys.iter().copied().filter(|key| of(&key.key, table)).collect();
            @let (given, absent): (Vec<&NumericKey>, Vec<&NumericKey>) =
                own.iter().copied().partition(|key| key.value.is_some());
            @let switches = if table == "stages" { movable } else { &[] };
            @if !choices.is_empty() || !own.is_empty() {
                fieldset {
                    legend { (heading) }
                    (follow(switches))
                    @for table in choices { (choice(table)) }
                    @for key in given { (control(key, resolved)) }
                    @if !absent.is_empty() {
                        details { summary { "not given" } @for key in absent { (control(key, resolved)) } }
                    }
                }
            }
        }
        @if !listed.is_empty() {
            details class="coordinates" {
                summary { "Coordinates (" (listed.len()) ")" }
                @for key in listed { (control(key, resolved)) }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_tell_numbers_apart() {
        let text = "name = \"pier\"\n[scene]\nscene = \"blocks\"\nwidth = 1.0\nmaterial = \"stone\"\njoint = \"dry\"\n\
            blocks = [{ name = \"ground\", fixed = true, vertices = [[0.0, -1.0], [1.0, -1.0], [1.0, 0.0], [0.0, 0.0]] }, \
            { name = \"pier\", vertices = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] }]\n\
            [materials.stone]\nlaw = \"rigid\"\ndensity = 2000.0\n[joints.dry]\nlaw = \"coulomb\"\nfriction = 0.5\n\
            [[stages]]\nname = \"live\"\ngravity = 9.81\n\
            loads = [{ kind = \"point\", block = \"pier\", point = [1.0, 1.0], force = [-1.0, 0.0] }]\n";
        let study = voussoir_study::file::load(text, "pier.toml", &[]).unwrap_or_else(|wrong| panic!("{wrong}"));
        let resolved = study.cases[0].resolved.to_json();
        let keys = numeric_keys(study_keys(), &resolved, LONGEST);
        for (key, words) in [
            ("scene.blocks.1.vertices.2.1", "pier: vertices, number 3, y [m]"),
            ("materials.stone.density", "stone: density [kg/m3]"),
            ("stages.0.loads.0.force.1", "live: point: force, y [N]"),
            ("stages.0.loads.0.point.0", "live: point: point in or on the block, x [m]"),
        ] {
            let own = keys.iter().find(|own| own.key == key).unwrap_or_else(|| panic!("no {key}"));
            assert_eq!(label(own, &resolved), words);
        }
    }

    #[test]
    fn coordinates_are_entries_of_lists_of_lists() {
        for (key, expected) in [
            ("scene.blocks.1.vertices.2.1", true),
            ("scene.profile.points.3.0", true),
            ("scene.brick.1", false),
            ("scene.spans.0.thickness", false),
            ("stages.0.loads.0.force.1", false),
        ] {
            assert_eq!(is_coordinate(key), expected, "{key}");
        }
    }

    #[test]
    fn tracks_stay_within_the_range_and_reach_the_value() {
        let real = |range, value| track(NumberKind::Real(Quantity::Ratio, range), value);
        assert_eq!(real(Range::POSITIVE, 2.0), Track { from: 0.01, to: 6.0, step: 0.01 });
        assert_eq!(real(Range::ANY, -1000.0), Track { from: -3000.0, to: 0.0, step: 5.0 });
        assert_eq!(real(Range::new(0.0, false, 0.5, true), 0.2), Track { from: 0.0, to: 0.499, step: 0.001 });
        assert_eq!(track(NumberKind::Whole(1, 100_000), 15.0), Track { from: 1.0, to: 45.0, step: 1.0 });
        for (range, value) in
            [(Range::ANY, 0.0), (Range::NON_NEGATIVE, 0.0), (Range::POSITIVE, 1e-9), (Range::ANY, 7e12)]
        {
            let Track { from, to, step } = real(range, value);
            assert!(from <= value && value <= to && step > 0.0, "{from} {value} {to} {step}");
        }
    }
}
