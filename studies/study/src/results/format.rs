//! How numbers, units and results are written in words, for figures, tables and reports alike.

use crate::results::{CaseResult, other_limit_point};
use voussoir_core::certificate::{ContactMode, Mechanism, MechanismKind};
use voussoir_core::limit::Status;
use voussoir_core::model::Stage;
use voussoir_core::model::geometry::Vec2;
pub use voussoir_core::number_text::{format_number, format_short};
use voussoir_core::path::LimitPointEnd;

fn scaled(x: f64, steps: &[(f64, &str)]) -> String {
    let (unit, name) = steps.iter().find(|(unit, _)| x.abs() >= 0.999_95 * unit).unwrap_or(&steps[steps.len() - 1]);
    format!("{} {name}", format_number(x / unit, 4))
}

/// A force \[N\] with four digits, in N, kN or MN.
pub fn format_force(newtons: f64) -> String {
    scaled(newtons, &[(1e6, "MN"), (1e3, "kN"), (1.0, "N")])
}

/// An energy \[J\] with four digits, in J, kJ or MJ.
pub fn format_energy(joules: f64) -> String {
    scaled(joules, &[(1e6, "MJ"), (1e3, "kJ"), (1.0, "J")])
}

/// A length \[m\], short, in m or mm.
pub fn format_length(metres: f64) -> String {
    if metres.abs() < 0.1 && metres != 0.0 {
        return format!("{} mm", format_short(metres * 1e3, 4));
    }
    format!("{} m", format_short(metres, 4))
}

/// A number with its unit; stresses in the unit in which they are short.
pub fn format_quantity(x: f64, unit: &str) -> String {
    let (x, unit) = match unit {
        "Pa" if x.abs() >= 1e9 => (x / 1e9, "GPa"),
        "Pa" if x.abs() >= 1e5 => (x / 1e6, "MPa"),
        unit => (x, unit),
    };
    format!("{} {unit}", format_short(x, 7)).trim_end().to_string()
}

/// A time \[s\] with three digits, in s, ms or µs.
pub fn format_seconds(seconds: f64) -> String {
    let (unit, name) = match seconds {
        s if s >= 1.0 => (1.0, "s"),
        s if s >= 1e-3 => (1e-3, "ms"),
        _ => (1e-6, "µs"),
    };
    format!("{} {name}", format_short(seconds / unit, 3))
}

/// A JSON value of a swept key: text bare, numbers short.
pub fn format_value(value: &serde_json::Value) -> String {
    match value {
        serde_json::Value::String(text) => text.clone(),
        other => other.as_f64().map_or_else(|| other.to_string(), |x| format_short(x, 7)),
    }
}

/// A status as it stands in results.json.
pub fn status_word(status: Status) -> &'static str {
    match status {
        Status::Stands => "stands",
        Status::Collapse => "collapse",
        Status::Unbounded => "unbounded",
        Status::NoEquilibrium => "no_equilibrium",
        Status::LimitPoint => "limit_point",
        Status::Open => "open",
        Status::Stalled => "stalled",
    }
}

/// The reason why a path ends at a limit point, as results.json has it.
pub fn continuation_word(end: LimitPointEnd) -> &'static str {
    match end {
        LimitPointEnd::Target => "target",
        LimitPointEnd::Requested => "requested",
        LimitPointEnd::LoadControl => "load_control",
        LimitPointEnd::JointLost => "joint_lost",
        LimitPointEnd::None => "none",
    }
}

/// A status in a sentence.
pub fn status_meaning(status: Status) -> &'static str {
    match status {
        Status::Stands => "every stage reached its factor",
        Status::Collapse => "collapses at this load factor",
        Status::Unbounded => "carries any multiple of the load: a strut proves it",
        Status::NoEquilibrium => {
            "cannot carry the loads present before the stage begins, or cannot follow its supports"
        }
        Status::LimitPoint => "no equilibrium path with a growing load factor",
        Status::Open => "bounds of the load factor are proved, the load factor itself is not",
        Status::Stalled => "nothing is proved; the notes give the reason",
    }
}

/// Capitalises the first letter.
pub fn capitalised(text: &str) -> String {
    let mut characters = text.chars();
    characters.next().map_or(String::new(), |first| first.to_uppercase().chain(characters).collect())
}

/// The verdict of a certificate: only the bounds of an open result are proved.
pub fn certificate_verdict(case: &CaseResult) -> &'static str {
    match (case.certificate.passed, case.status) {
        (true, _) => "passed",
        (false, Status::Open) => "bounds",
        (false, _) => "failed",
    }
}

/// A mechanism's kind as it stands in results.json.
pub fn kind_word(kind: MechanismKind) -> &'static str {
    match kind {
        MechanismKind::ThreeHinge => "three_hinge",
        MechanismKind::FourHinge => "four_hinge",
        MechanismKind::FiveHinge => "five_hinge",
        MechanismKind::Rocking => "rocking",
        MechanismKind::Sliding => "sliding",
        MechanismKind::Crushing => "crushing",
        MechanismKind::Twisting => "twisting",
        MechanismKind::Separating => "separating",
        MechanismKind::Mixed => "mixed",
    }
}

/// A mechanism's kind in words.
pub fn kind_words(kind: MechanismKind) -> &'static str {
    match kind {
        MechanismKind::ThreeHinge => "three hinges",
        MechanismKind::FourHinge => "four hinges",
        MechanismKind::FiveHinge => "five hinges",
        MechanismKind::Rocking => "rocking",
        MechanismKind::Sliding => "sliding",
        MechanismKind::Crushing => "crushing",
        MechanismKind::Twisting => "twisting",
        MechanismKind::Separating => "separating",
        MechanismKind::Mixed => "mixed mechanism",
    }
}

/// The contacts of a mechanism in space in words: `6 hinges about 2 axes, 3 sliding`. Empty in the plane.
pub fn contact_words(mechanism: &Mechanism) -> String {
    let several = |count: usize, one: &str, more: &str| format!("{count} {}", if count == 1 { one } else { more });
    let hinges = mechanism.count_of(ContactMode::Hinge);
    let axes = several(mechanism.hinge_count, "axis", "axes");
    let turning = (hinges > 0).then(|| format!("{} about {axes}", several(hinges, "hinge", "hinges")));
    let others = [
        (ContactMode::Sliding, "sliding"),
        (ContactMode::Twisting, "twisting"),
        (ContactMode::Crushing, "crushing"),
        (ContactMode::Separating, "separating"),
    ];
    let others = others.map(|(mode, word)| (mechanism.count_of(mode), word));
    let others = others.into_iter().filter(|(count, _)| *count > 0).map(|(count, word)| format!("{count} {word}"));
    turning.into_iter().chain(others).collect::<Vec<_>>().join(", ")
}

/// The resultant of a stage's forces at factor 1 \[N\]; `None` where the last stage has none, they
/// cancel, or it also has accelerations.
pub fn unit_load(stages: &[Stage]) -> Option<f64> {
    let stage = stages.last().filter(|stage| stage.accelerations.is_empty() && !stage.forces.is_empty())?;
    let sum = stage.forces.iter().fold(Vec2::zeros(), |sum, f| sum + f.force).norm();
    let largest = stage.forces.iter().map(|f| f.force.norm()).fold(0.0, f64::max);
    (sum > 1e-9 * largest).then_some(sum)
}

/// Relative width from which bounds are open.
const OPEN: f64 = 1e-6;

/// \[proved, found\] where they are not one: the load found is then an upper bound only.
pub fn open_bounds(result: &CaseResult) -> Option<[f64; 2]> {
    // With associated flow the certificate has compared them, on the scale of the loads: of a factor of zero what lies between
    // is rounding.
    let met = result.certificate.passed && result.certificate.residuals.contains_key("gap");
    result.both_bounds().filter(|[low, high]| !met && (high - low).abs() > OPEN * high.abs().max(low.abs()))
}

/// The proved ends of an open result: `≥ a`, `≤ b` or `[a, b]`. `None` if no end is proved.
pub fn proved_interval(result: &CaseResult) -> Option<String> {
    let digits = |x: f64| format_number(x, 7);
    match result.bounds? {
        [Some(lower), None] => Some(format!("≥ {}", digits(lower))),
        [None, Some(upper)] => Some(format!("≤ {}", digits(upper))),
        [Some(lower), Some(upper)] => Some(format!("[{}, {}]", digits(lower), digits(upper))),
        [None, None] => None,
    }
}

/// The greatest and the first limit point with equal weight, if they differ: `carries 23.1; snaps from 1.37`.
pub fn snap_words(load_factor: Option<f64>, first: Option<f64>, number: impl Fn(f64) -> String) -> Option<String> {
    let first = other_limit_point(load_factor, first)?;
    Some(format!("carries {}; snaps from {}", number(load_factor?), number(first)))
}

/// What a case came to, in one line: `collapse, λ = 698.0 (load 698.0 kN)`.
pub fn headline(result: &CaseResult, stages: &[Stage]) -> String {
    let load = |factor: f64| match unit_load(stages) {
        Some(unit) => format!("λ = {} (load {})", format_number(factor, 4), format_force(factor * unit)),
        None => format!("λ = {}", format_number(factor, 4)),
    };
    let snaps = result.snaps_from().map(|first| format!("snaps from {}", load(first)));
    let beside = |words: String| snaps.as_ref().map_or(words.clone(), |snaps| format!("{words}; {snaps}"));
    match (result.status, result.load_factor) {
        (Status::Collapse, Some(found)) if let Some([proved, _]) = open_bounds(result) => {
            format!("carries at least {}: proved; a collapse was found at {}", load(proved), load(found))
        }
        (Status::Open, _) if let Some(interval) = proved_interval(result) => {
            beside(format!("open: proved for the load factor: {interval}"))
        }
        (Status::Unbounded, _) => "unbounded: it carries any multiple of the load".into(),
        _ if result.supports_cannot_move() => {
            "no equilibrium: the rigid blocks have no motion that is compatible with the support displacements".into()
        }
        (Status::NoEquilibrium, _) => "no equilibrium: the loads before the last stage cannot be carried".into(),
        (Status::Stands, None) => "stands: every stage reached its factor".into(),
        (Status::LimitPoint, None) if let Some(last) = result.path.limit_points.last() => {
            format!("limit point at {} of the gravity of stage \"{}\"", format_number(last.factor, 4), last.stage)
        }
        (status, Some(factor)) if snaps.is_some() => {
            beside(format!("{}: carries {}", status_word(status).replace('_', " "), load(factor)))
        }
        (status, Some(factor)) => format!("{}, {}", status_word(status).replace('_', " "), load(factor)),
        (status, None) => status_word(status).replace('_', " "),
    }
}
