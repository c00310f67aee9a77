//! Cards and reported numbers with one fault each: defaults, ranges, checks, and the softening that a law reports.

use serde::{Deserialize, Serialize};
use std::sync::Arc;
use voussoir::conformance::{Options, Report, conform};
use voussoir::core::law::{
    BatchFailure, Facet, FacetResponse, InterfaceLaw, InterfaceResponse, PointContext, TractionPoint, UpdateFailure,
};
use voussoir::core::plugin::{Capability, Card, KnownPath, Parameter, PluginKind, Property, Quantity, Range, Sample};
use voussoir::laws::cohesive::Cohesive;

/// Friction with dilatancy.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct MutantKeys {
    friction: f64,
    #[serde(default = "dilatancy")]
    dilatancy: f64,
    cohesion: f64,
    stiffness: f64,
}

fn dilatancy() -> f64 {
    0.2
}

#[typetag::serde(name = "mutant_keys")]
impl InterfaceLaw for MutantKeys {
    fn facets(&self) -> Option<Vec<Facet>> {
        let [left, right] = Facet::friction(self.friction, self.cohesion, self.dilatancy);
        Some(vec![Facet::opening(0.0), left, right])
    }

    fn response(&self) -> Option<Arc<dyn InterfaceResponse>> {
        Some(Arc::new(FacetResponse::new(self.facets()?, self.stiffness()?)?))
    }

    fn stiffness(&self) -> Option<[f64; 2]> {
        Some([self.stiffness, self.stiffness])
    }
}

const FRICTION: Parameter = Parameter::number("friction", Quantity::Ratio, Range::NON_NEGATIVE, "μ");
const DILATANCY: Parameter =
    Parameter::number("dilatancy", Quantity::Ratio, Range::NON_NEGATIVE, "tangent of the angle").default("0.2");
const OTHERS: [Parameter; 2] = [
    Parameter::number("cohesion", Quantity::Stress, Range::NON_NEGATIVE, "c"),
    Parameter::number("stiffness", Quantity::Stiffness, Range::POSITIVE, "k"),
];

/// The dilatancy is at most the friction.
fn no_more_than_friction(table: &serde_json::Value) -> Vec<(String, String)> {
    let number = |key: &str, absent: f64| table.get(key).and_then(serde_json::Value::as_f64).unwrap_or(absent);
    let wrong = number("dilatancy", dilatancy()) > number("friction", 0.0);
    wrong.then(|| ("dilatancy".to_string(), "is more than the friction".to_string())).into_iter().collect()
}

const TABLE: &str = "friction = 0.6\ndilatancy = 0.3\ncohesion = 1e4\nstiffness = 1e10";

const CARD: Card = Card {
    kind: PluginKind::InterfaceLaw,
    tag: "mutant_keys",
    summary: "for this test",
    parameters: &[FRICTION, DILATANCY, OTHERS[0], OTHERS[1]],
    provides: &[Capability::FACETS, Capability::RESPONSE],
    claims: &[Property::DISSIPATIVE],
    samples: &[Sample::new(TABLE, 2e-4, &["elastic", "sliding"])],
    known_paths: &[KnownPath {
        table: TABLE,
        source: "by hand: pressed, slipped a little within stick, and back",
        steps: &[(&[-1e-3, 0.0], &[1e7, 0.0]), (&[-1e-3, 1e-4], &[1e7, -1e6]), (&[-8e-4, 0.0], &[8e6, 0.0])],
        tolerance: 1e-12,
    }],
    sources: &["this test"],
    file: file!(),
    page: "for this test",
    check: no_more_than_friction,
    ..Card::BLANK
};

fn report(card: Card) -> Report {
    conform(&card, &Options::default())
}

/// Checks that a card has a finding in a check.
fn fails(card: Card, check: &str) {
    let report = report(card);
    assert!(report.fails(check), "{check} should have found it\n{report}");
}

/// The card without a fault has no finding in these checks.
#[test]
fn the_card_without_a_fault_has_no_finding() {
    let report = report(CARD);
    for check in ["defaults", "keys", "card", "samples", "facets", "friction", "dissipation"] {
        assert!(report.done.contains_key(check) && !report.fails(check), "{check}: {report}");
    }
    assert!(!report.fails("ranges"), "{report}");
}

/// A default of the card that is not the default of the reader is found, also if every sample gives the key.
#[test]
fn a_default_that_differs_from_the_reader_is_found() {
    let parameters = [FRICTION, DILATANCY.default("0.1"), OTHERS[0], OTHERS[1]];
    fails(Card { parameters: Box::leak(Box::new(parameters)), ..CARD }, "defaults");
}

/// A range that allows negative friction is found.
#[test]
fn a_range_that_allows_negative_friction_is_found() {
    let any = Parameter::number("friction", Quantity::Ratio, Range::ANY, "μ");
    let parameters = [any, DILATANCY, OTHERS[0], OTHERS[1]];
    fails(Card { parameters: Box::leak(Box::new(parameters)), check: |_| Vec::new(), ..CARD }, "ranges");
}

/// A card whose check of the dilatancy is missing is found: with more dilatancy than friction, slip creates energy.
#[test]
fn a_missing_check_is_found() {
    fails(Card { check: |_| Vec::new(), ..CARD }, "ranges");
}

/// A cohesive joint that reports a wrong strength or fracture energy.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct MutantSoftening {
    strength_factor: f64,
    energy_factor: f64,
    #[serde(flatten)]
    inner: Cohesive,
}

#[typetag::serde(name = "mutant_softening")]
impl InterfaceLaw for MutantSoftening {
    fn response(&self) -> Option<Arc<dyn InterfaceResponse>> {
        let factors = [self.strength_factor, self.energy_factor];
        Some(Arc::new(Reports { inner: self.inner.response()?, factors }))
    }

    fn stiffness(&self) -> Option<[f64; 2]> {
        self.inner.stiffness()
    }
}

#[derive(Debug)]
struct Reports {
    inner: Arc<dyn InterfaceResponse>,
    factors: [f64; 2],
}

impl InterfaceResponse for Reports {
    fn state_size(&self) -> usize {
        self.inner.state_size()
    }

    fn initial_state(&self, state: &mut [f64]) {
        self.inner.initial_state(state);
    }

    fn state_names(&self) -> &'static [&'static str] {
        self.inner.state_names()
    }

    fn tensile_softening(&self) -> Option<[f64; 2]> {
        let [strength, energy] = self.inner.tensile_softening()?;
        Some([self.factors[0] * strength, self.factors[1] * energy])
    }

    fn respond_point(
        &self,
        gap: [f64; 2],
        context: &PointContext,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<TractionPoint, UpdateFailure> {
        self.inner.respond_point(gap, context, old, new)
    }

    fn respond(
        &self,
        gaps: &[[f64; 2]],
        contexts: &[PointContext],
        old: &[f64],
        new: &mut [f64],
        points: &mut [TractionPoint],
    ) -> Result<(), BatchFailure> {
        self.inner.respond(gaps, contexts, old, new, points)
    }
}

/// A law that reports its tensile strength or its fracture energy wrong by a factor of 100 is found.
#[test]
fn a_wrong_tensile_softening_is_found() {
    let number = |name, quantity| Parameter::number(name, quantity, Range::POSITIVE, "for this test");
    let parameters = [
        number("strength_factor", Quantity::Ratio),
        number("energy_factor", Quantity::Ratio),
        number("friction", Quantity::Ratio),
        number("tensile_strength", Quantity::Stress),
        number("cohesion", Quantity::Stress),
        number("normal_stiffness", Quantity::Stiffness),
        number("shear_stiffness", Quantity::Stiffness),
        number("tensile_fracture_energy", Quantity::EnergyPerArea),
        number("shear_fracture_energy", Quantity::EnergyPerArea),
    ];
    let parameters: &'static [Parameter] = Box::leak(Box::new(parameters));
    for (strength, energy) in [(1.0, 1.0), (1.0, 100.0), (1.0, 0.01), (100.0, 1.0), (0.01, 1.0)] {
        let table = format!(
            "strength_factor = {strength:?}\nenergy_factor = {energy:?}\nfriction = 0.6\ntensile_strength = 3e5\ncohesion = 5e5\n\
             normal_stiffness = 1e10\nshear_stiffness = 5e9\ntensile_fracture_energy = 20.0\nshear_fracture_energy = 150.0"
        );
        let samples = [Sample::new(table.leak(), 1.5e-4, &["elastic", "softening", "sliding"])];
        let card = Card {
            tag: "mutant_softening",
            parameters,
            provides: &[Capability::RESPONSE],
            samples: Box::leak(Box::new(samples)),
            known_paths: &[],
            check: |_| Vec::new(),
            ..CARD
        };
        let report = report(card);
        let right = strength == 1.0 && energy == 1.0;
        assert!(report.done.contains_key("tensile_softening"), "{report}");
        assert_eq!(report.fails("tensile_softening"), !right, "{strength} {energy}: {report}");
    }
}
