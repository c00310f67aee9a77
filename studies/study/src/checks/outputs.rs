//! Outputs of laws: they follow from the state of a path that a result stores. Solving and verifying compute them with this
//! code.

use crate::checks::findings::Findings;
use crate::checks::stored_state::stored_state;
use crate::checks::tolerances::{GEOMETRY, Route, STATE};
use crate::results::{CaseResult, OutputEntry};
use crate::study::Case;
use std::collections::BTreeSet;
use voussoir_core::certificate::path_structure;
use voussoir_core::model::{Assembly, Bond};
use voussoir_core::path::{PathProblem, PathState, PointOutputs};
use voussoir_core::plugin::{Card, OutputOf, PluginKind, card};

/// Returns the outputs of the laws of a case at the stored state; none for limit analysis.
///
/// # Errors
/// If the stored state does not fit the case, or a law fails there.
pub fn law_outputs(case: &Case, result: &CaseResult) -> Result<Vec<OutputEntry>, String> {
    if result.path.displacements.is_none() || !Declared::by(&case.assembly).any() {
        return Ok(Vec::new());
    }
    let (assembly, finite) = (&case.assembly, case.solver.settings.finite);
    let problem = path_structure(assembly, &case.stages)?;
    let state = stored_state(assembly, &problem, result, finite)?;
    entries(assembly, &problem, &state, finite)
}

/// Checks the stored outputs: those of laws against the stored state, those of solvers against their cards.
pub(super) fn verify(
    case: &Case,
    (problem, state): (&PathProblem, &PathState),
    result: &CaseResult,
    findings: &mut Findings,
) {
    let stored: Vec<&OutputEntry> = result.outputs.iter().filter(|entry| entry.is_of_law()).collect();
    // If a law fails at the stored state, there are no outputs.
    let expected = entries(&case.assembly, problem, state, case.solver.settings.finite).unwrap_or_default();
    let names = |entry: &OutputEntry| format!("{} of {}", entry.name, entry.plugin);
    let (own, due): (Vec<_>, Vec<_>) =
        (stored.iter().map(|own| names(own)).collect(), expected.iter().map(names).collect());
    findings.expect_entry(own == due, "the list of names in outputs", (&own, "the stored state gives", &due));
    if own == due {
        stored.iter().zip(&expected).for_each(|(stored, expected)| compare(stored, expected, findings));
    }
}

/// Checks that the outputs of solvers are on their cards, and that limit analysis has no outputs of laws. No check proves the
/// values of solvers.
pub(super) fn verify_origin(result: &CaseResult, findings: &mut Findings) {
    let followed = card(PluginKind::PathSolver, &result.solver).is_some();
    for entry in &result.outputs {
        if entry.is_of_law() {
            let what = format!("outputs: limit analysis gives no output \"{}\" of {}", entry.name, entry.plugin);
            findings.expect(followed, &what);
            continue;
        }
        let declared = entry.declaration().is_some_and(|own| (own.unit, own.of) == (entry.unit.as_str(), entry.of));
        let fits = declared && entry.plugin == result.solver && entry.values.len() == 1;
        let what = format!("outputs: the card of \"{}\" declares no output like \"{}\"", entry.plugin, entry.name);
        findings.expect(fits, &what);
    }
}

/// Compares one stored output with the one that the stored state gives.
fn compare(stored: &OutputEntry, expected: &OutputEntry, findings: &mut Findings) {
    let what = format!("output \"{}\" of {}", stored.name, stored.plugin);
    let rows = |entry: &OutputEntry| entry.positions.iter().map(|place| place.to_vec()).collect::<Vec<_>>();
    let same = (&stored.unit, stored.of, &stored.places) == (&expected.unit, expected.of, &expected.places)
        && stored.values.len() == expected.values.len()
        && GEOMETRY.same_rows(&rows(stored), &rows(expected));
    findings.expect(same, &format!("{what}: unit, places or positions differ from the study"));
    if !same {
        return;
    }
    let greatest = expected.values.iter().flatten().fold(0.0, |most: f64, value| most.max(value.abs()));
    let within = STATE.of(Route::Steps) * greatest;
    let near = |(a, b): (&Option<f64>, &Option<f64>)| match (a, b) {
        (Some(a), Some(b)) => (a - b).abs() <= within,
        (a, b) => a == b,
    };
    let pairs = stored.values.iter().zip(&expected.values);
    if let Some((index, (own, due))) = pairs.enumerate().find(|(_, pair)| !near(*pair)) {
        findings.expect_entry(false, &format!("{what}, value {index}"), (own, "the stored state gives", due));
    }
}

/// The cards of the laws of joints and blocks.
struct Declared {
    joints: Vec<Option<&'static Card>>,
    blocks: Vec<Option<&'static Card>>,
}

impl Declared {
    /// Reads the cards with outputs of the laws of an assembly.
    fn by(assembly: &Assembly) -> Self {
        let with_outputs = |kind, tag: &str| card(kind, tag).filter(|card| !card.outputs.is_empty());
        let catalogue = &assembly.catalogue;
        let joint = |bond: &Bond| match bond {
            Bond::Law(law) => with_outputs(PluginKind::InterfaceLaw, catalogue.laws[*law].1.typetag_name()),
            _ => None,
        };
        let block =
            |material: usize| with_outputs(PluginKind::BulkMaterial, catalogue.materials[material].1.typetag_name());
        Declared {
            joints: assembly.joints.iter().map(|own| joint(&own.bond)).collect(),
            blocks: assembly.bodies.iter().map(|own| block(own.material)).collect(),
        }
    }

    fn any(&self) -> bool {
        self.joints.iter().chain(&self.blocks).any(Option::is_some)
    }
}

/// Returns the outputs of all laws at a state, plug-in by plug-in.
fn entries(
    assembly: &Assembly,
    problem: &PathProblem,
    state: &PathState,
    finite: bool,
) -> Result<Vec<OutputEntry>, String> {
    let declared = Declared::by(assembly);
    let of = |cards: &[Option<&'static Card>], place: usize| cards.get(place).copied().flatten();
    let count = |card: Option<&Card>| card.map_or(0, |card| card.point_outputs().count());
    let mut found = Vec::new();
    if declared.joints.iter().any(Option::is_some) {
        let points = PointOutputs::of_joints(problem, state, |joint| count(of(&declared.joints, joint)))?;
        add(&declared.joints, &points, &mut found);
    }
    if declared.blocks.iter().any(Option::is_some) {
        let points = PointOutputs::of_blocks(problem, state, finite, |block| count(of(&declared.blocks, block)))?;
        add(&declared.blocks, &points, &mut found);
    }
    Ok(found)
}

/// Adds the outputs of the laws of joints, or of blocks.
fn add(cards: &[Option<&'static Card>], points: &[PointOutputs], found: &mut Vec<OutputEntry>) {
    let tags: BTreeSet<&str> = cards.iter().flatten().map(|card| card.tag).collect();
    for tag in tags {
        let of_tag = |place: usize| cards[place].filter(|card| card.tag == tag);
        let own: Vec<&PointOutputs> = points.iter().filter(|point| of_tag(point.place).is_some()).collect();
        if let Some(card) = own.first().and_then(|point| of_tag(point.place)) {
            found.extend(of_card(card, &own));
        }
    }
}

/// Returns all outputs of one law from its values at points.
fn of_card(card: &Card, points: &[&PointOutputs]) -> Vec<OutputEntry> {
    let column = |name: &str| card.point_outputs().position(|output| output.name == name);
    let known = |value: f64| value.is_finite().then_some(value);
    let entry = |output| {
        let mut entry = OutputEntry::new(card, output);
        let Some((name, rule)) = output.from else {
            let column = column(output.name)?;
            entry.places = points.iter().map(|point| point.place).collect();
            entry.positions = points.iter().map(|point| point.position).collect();
            entry.values = points.iter().map(|point| known(point.values[column])).collect();
            return Some(entry);
        };
        let column = column(name)?;
        let value =
            |group: &[&PointOutputs]| known(rule.of(group.iter().map(|point| (point.size, point.values[column]))));
        if output.of == OutputOf::Case {
            entry.values = vec![value(points)];
        } else {
            let groups = || points.chunk_by(|a, b| a.place == b.place);
            entry.places = groups().map(|group| group[0].place).collect();
            entry.values = groups().map(value).collect();
        }
        Some(entry)
    };
    card.outputs.iter().filter_map(entry).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use voussoir_core::plugin::Output;

    const CARD: Card = Card {
        kind: PluginKind::InterfaceLaw,
        tag: "own",
        outputs: &[
            Output::joint("crack_length", "m", "open length").integral("open"),
            Output::point("depth", "m", "depth"),
            Output::point("open", "-", "1 if open"),
            Output::case("greatest_depth", "m", "greatest depth").greatest("depth"),
        ],
        ..Card::BLANK
    };

    /// Outputs of joints and of the case follow from those of points, in any order on the card.
    #[test]
    fn outputs_of_joints_and_the_case_follow_from_points() {
        let point =
            |place, depth, open| PointOutputs { place, position: [0.0, 1.0], size: 0.5, values: vec![depth, open] };
        let points = [point(1, 2.0, 1.0), point(1, 3.0, 1.0), point(4, f64::NAN, 0.0)];
        let found = of_card(&CARD, &points.iter().collect::<Vec<_>>());
        let values: Vec<_> = found.iter().map(|entry| (entry.name.as_str(), entry.values.clone())).collect();
        assert_eq!(values[0], ("crack_length", vec![Some(1.0), Some(0.0)]));
        assert_eq!(values[1], ("depth", vec![Some(2.0), Some(3.0), None]));
        assert_eq!(values[2], ("open", vec![Some(1.0), Some(1.0), Some(0.0)]));
        assert_eq!(values[3], ("greatest_depth", vec![None]));
        assert_eq!((&found[0].places, &found[1].places), (&vec![1, 4], &vec![1, 1, 4]));
        assert!(found[0].positions.is_empty() && found[1].positions.len() == 3 && found[3].places.is_empty());
    }

    /// A stored value that differs is found, and so is a missing one.
    #[test]
    fn a_value_that_the_state_does_not_give_is_found() {
        let entry = OutputEntry { values: vec![Some(1.0), Some(2.0)], ..OutputEntry::new(&CARD, &CARD.outputs[0]) };
        let says = |values: &[Option<f64>]| {
            let mut findings = Findings::default();
            compare(&OutputEntry { values: values.to_vec(), ..entry.clone() }, &entry, &mut findings);
            findings.0
        };
        assert_eq!(says(&[Some(1.0), Some(2.0 + 1e-9)]), Vec::<String>::new());
        let changed = "output \"crack_length\" of own, value 1 is 2.1, but the stored state gives 2.0";
        assert_eq!(says(&[Some(1.0), Some(2.1)]), [changed]);
        assert_eq!(says(&[None, Some(2.0)]).len(), 1);
        let fewer = "output \"crack_length\" of own: unit, places or positions differ from the study";
        assert_eq!(says(&[Some(1.0)]), [fewer]);
    }
}
