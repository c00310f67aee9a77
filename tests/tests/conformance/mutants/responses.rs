//! Responses with one fault each: a joint that slides with friction and tears without softening.

use super::every_fault_is_found;
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use voussoir::conformance::{Options, conform};
use voussoir::core::law::{
    BatchFailure, Effect, Facet, FacetResponse, InterfaceLaw, InterfaceResponse, PointContext, TractionPoint,
    UpdateBranch, UpdateFailure,
};
use voussoir::core::plugin::{
    Capability, Card, KnownPath, Need, Output, Parameter, PluginKind, Property, Quantity, Range, Sample, Shape,
};

use voussoir::kinds::{RunRequest, read_study};
use voussoir::solve::Unobserved;

#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct MutantResponse {
    fault: String,
    friction: f64,
    cohesion: f64,
    normal_stiffness: f64,
    shear_stiffness: f64,
    #[serde(default = "one")]
    factor: f64,
}

fn one() -> f64 {
    1.0
}

impl MutantResponse {
    fn inner(&self) -> Option<FacetResponse> {
        let mut strength = self.cohesion;
        if self.fault != "unused_key" {
            strength *= self.factor;
        }
        if self.fault == "a_number_of_its_own" {
            strength += 2e5;
        }
        let friction = if self.fault == "friction_of_the_wrong_sign" { -self.friction } else { self.friction };
        let dilatancy = if self.fault == "symmetry_claimed_and_untrue" { 0.0 } else { friction };
        let [left, right] = Facet::friction(friction, strength, dilatancy);
        FacetResponse::new(
            vec![Facet::opening(0.5 * strength), left, right],
            [self.normal_stiffness, self.shear_stiffness],
        )
    }
}

#[typetag::serde(name = "mutant_response")]
impl InterfaceLaw for MutantResponse {
    fn response(&self) -> Option<Arc<dyn InterfaceResponse>> {
        Some(Arc::new(Mutated { inner: self.inner()?, fault: self.fault.clone(), friction: self.friction }))
    }

    fn stiffness(&self) -> Option<[f64; 2]> {
        let share = if self.fault == "wrong_stiffness" { 0.1 } else { 1.0 };
        Some([self.normal_stiffness * share, self.shear_stiffness])
    }
}

#[derive(Debug, Clone)]
struct Mutated {
    inner: FacetResponse,
    fault: String,
    friction: f64,
}

impl InterfaceResponse for Mutated {
    fn respond(
        &self,
        gaps: &[[f64; 2]],
        contexts: &[PointContext],
        old: &[f64],
        new: &mut [f64],
        points: &mut [TractionPoint],
    ) -> Result<(), BatchFailure> {
        let extra = if self.fault == "allocates_in_batches" { vec![0.0; gaps.len()] } else { Vec::new() };
        for (index, (gap, context)) in gaps.iter().zip(contexts).enumerate() {
            let place = 2 * index..2 * index + 2;
            let said = self.respond_point(*gap, context, &old[place.clone()], &mut new[place]);
            points[index] = said.map_err(|failure| BatchFailure { point: index, failure })?;
            points[index].stored += extra.get(index).copied().unwrap_or(0.0);
        }
        Ok(())
    }

    fn state_size(&self) -> usize {
        2
    }

    fn initial_state(&self, state: &mut [f64]) {
        if self.fault != "state_not_written" {
            state.fill(0.0);
        }
    }

    fn state_names(&self) -> &'static [&'static str] {
        match self.fault.as_str() {
            "state_without_unit" => &["plastic_gap_n", "plastic_gap_t"],
            "state_of_another_unit" => &["plastic_gap_n [-]", "plastic_gap_t [-]"],
            "state_of_another_size" => &["plastic_gap_n [m]"],
            _ => &["plastic_gap_n [m]", "plastic_gap_t [m]"],
        }
    }

    fn respond_point(
        &self,
        gap: [f64; 2],
        context: &PointContext,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<TractionPoint, UpdateFailure> {
        let fault = self.fault.as_str();
        let asked = match fault {
            "normal_of_the_wrong_sign" => [-gap[0], gap[1]],
            "shear_of_the_wrong_sign" => [gap[0], -gap[1]],
            _ => gap,
        };
        if fault == "no_number_is_answered" && gap.iter().any(|x| x.is_nan()) {
            return Ok(TractionPoint::ZERO);
        }
        let mut said = self.inner.respond_point(asked, context, old, new)?;
        let slides = !said.branch.is_elastic();
        match fault {
            "tangent_off_the_diagonal" if slides => said.tangent[0][1] *= -1.0,
            "tangent_of_the_elastic_joint" if slides => {
                said.tangent = self.inner.respond_point([-1e-12, 0.0], context, &[0.0; 2], &mut [0.0; 2])?.tangent;
            }
            "state_forgotten_on_unloading" if !slides => new.fill(0.0),
            "state_never_kept" => new.copy_from_slice(old),
            "state_half_kept" => new[1] = 0.5 * (old[1] + new[1]),
            "called_elastic" => said.branch = UpdateBranch::ELASTIC,
            "called_sliding" => said.branch = UpdateBranch::new("sliding", Effect::Sliding),
            "zero_dissipation" => said.dissipated = 0.0,
            "negative_dissipation" => said.dissipated *= -1.0,
            "nothing_stored" => said.stored = 0.0,
            "not_a_number_at_no_gap" if gap[0] == 0.0 => said.traction[1] *= 0.0 / gap[0],
            "allocates" => said.stored += vec![0.0; 1 + usize::from(gap[0] > 0.0)].iter().sum::<f64>(),
            "allocates_and_refuses" if gap[1] > 1e-3 => return Err(UpdateFailure::NoConvergence),
            "allocates_and_refuses" => said.stored += std::hint::black_box(vec![0.0; 2]).iter().sum::<f64>(),
            // Friction that pushes in the direction of slip.
            "creates_energy" if slides => said.traction[1] *= -self.friction,
            "refuses_to_open" if gap[0] > 1e-4 => return Err(UpdateFailure::NoConvergence),
            "presses_when_open" if gap[0] > 0.0 => said.traction[0] = said.traction[0].abs(),
            _ => {}
        }
        Ok(said)
    }

    fn outputs(&self, _: [f64; 2], _: &PointContext, state: &[f64], point: &TractionPoint, values: &mut [f64]) {
        static CALLS: AtomicUsize = AtomicUsize::new(0);
        values[0] = state[1];
        match self.fault.as_str() {
            "output_forgotten_when_elastic" if point.branch.is_elastic() => values[0] = f64::NAN,
            "output_divided_by_nothing" => values[0] /= (state[0] * 1e9).min(0.0),
            "output_in_millimetres_of_a_metre" => values[0] += 1e-3,
            "output_of_a_stress" => values[0] = point.traction[0],
            "output_that_counts" => values[0] += 1e-12 * CALLS.fetch_add(1, Ordering::Relaxed) as f64,
            "more_outputs_than_declared" => values[1] = 0.0,
            _ => {}
        }
    }
}

const CARD: Card = Card {
    kind: PluginKind::InterfaceLaw,
    tag: "mutant_response",
    summary: "for this test",
    parameters: &[
        Parameter { name: "fault", doc: "which", shape: Shape::Text, need: Need::Required },
        Parameter::number("friction", Quantity::Ratio, Range::NON_NEGATIVE, "μ"),
        Parameter::number("cohesion", Quantity::Stress, Range::POSITIVE, "c"),
        Parameter::number("normal_stiffness", Quantity::Stiffness, Range::POSITIVE, "k_n"),
        Parameter::number("shear_stiffness", Quantity::Stiffness, Range::POSITIVE, "k_t"),
        Parameter::number("factor", Quantity::Ratio, Range::POSITIVE, "of the cohesion").default("1.0"),
    ],
    provides: &[Capability::RESPONSE],
    claims: &[Property::ASSOCIATED, Property::DISSIPATIVE, Property::SYMMETRIC_TANGENT],
    known_paths: &[KnownPath {
        table: TABLE,
        source: "by hand: torn, then closed",
        steps: &[(&[1e-4, 0.0], &[-2e5, 0.0]), (&[0.0, 0.0], &[8e5, 0.0]), (&[0.0, 0.0], &[8e5, 0.0])],
        tolerance: 1e-12,
    }],
    outputs: &[Output::point("plastic_slip", "m", "plastic part of the tangential gap")],
    sources: &["this test"],
    file: file!(),
    page: "for this test",
    ..Card::BLANK
};

const TABLE: &str = "friction = 0.6\ncohesion = 4e5\nnormal_stiffness = 1e10\nshear_stiffness = 5e9";
const SAMPLE: Sample = Sample::new("", 2e-4, &["elastic", "sliding"]);

#[test]
fn responses_with_a_fault_are_found() {
    let faults: [(&str, &[&str]); 28] = [
        ("tangent_off_the_diagonal", &["tangent", "symmetry"]),
        ("tangent_of_the_elastic_joint", &["tangent"]),
        ("symmetry_claimed_and_untrue", &["symmetry", "associated"]),
        ("normal_of_the_wrong_sign", &["normal"]),
        ("shear_of_the_wrong_sign", &["friction"]),
        ("friction_of_the_wrong_sign", &["friction"]),
        ("state_forgotten_on_unloading", &["memory", "known_path"]),
        ("state_never_kept", &["regions", "known_path"]),
        ("state_half_kept", &["memory"]),
        ("state_not_written", &["state"]),
        ("state_without_unit", &["state"]),
        ("state_of_another_unit", &["state"]),
        ("state_of_another_size", &["state"]),
        ("called_elastic", &["regions"]),
        ("called_sliding", &["regions"]),
        ("zero_dissipation", &["energy"]),
        ("negative_dissipation", &["dissipation"]),
        ("nothing_stored", &["energy"]),
        ("not_a_number_at_no_gap", &["untouched", "finite"]),
        ("no_number_is_answered", &["finite"]),
        ("allocates", &["allocation"]),
        ("allocates_in_batches", &["allocation"]),
        ("allocates_and_refuses", &["allocation"]),
        ("unused_key", &["keys"]),
        ("creates_energy", &["cycles", "energy"]),
        ("refuses_to_open", &["finite"]),
        ("presses_when_open", &["normal"]),
        ("wrong_stiffness", &["stiffness"]),
    ];
    every_fault_is_found(&CARD, TABLE, SAMPLE, &faults);
}

#[test]
fn outputs_with_a_fault_are_found() {
    let faults: [(&str, &[&str]); 6] = [
        ("output_forgotten_when_elastic", &["outputs"]),
        ("output_divided_by_nothing", &["outputs"]),
        ("output_in_millimetres_of_a_metre", &["outputs"]),
        ("output_of_a_stress", &["outputs"]),
        ("output_that_counts", &["outputs"]),
        ("more_outputs_than_declared", &["panic"]),
    ];
    every_fault_is_found(&CARD, TABLE, SAMPLE, &faults);
}

/// Parameters whose cards have a wrong or missing unit, or a default of the wrong type, are found.
#[test]
fn parameters_without_a_unit_are_found() {
    const NO_UNIT: Parameter = Parameter::number("cohesion", Quantity::Ratio, Range::POSITIVE, "c");
    let [fault, friction, _, k_n, k_t, factor] = CARD.parameters else { panic!("six parameters") };
    let leaked = |parameters: Vec<Parameter>| -> Card { Card { parameters: parameters.leak(), ..CARD } };
    let cases: [(&str, Card, &str); 4] = [
        ("no unit", leaked(vec![*fault, *friction, NO_UNIT, *k_n, *k_t, *factor]), "units"),
        (
            "any shape",
            leaked(vec![*fault, *friction, Parameter { shape: Shape::Free, ..NO_UNIT }, *k_n, *k_t, *factor]),
            "units",
        ),
        (
            "another default",
            leaked(vec![*fault, *friction, CARD.parameters[2], *k_n, *k_t, factor.default("2.0")]),
            "defaults",
        ),
        (
            "not explained",
            leaked(vec![*fault, *friction, Parameter { doc: "", ..CARD.parameters[2] }, *k_n, *k_t, *factor]),
            "card",
        ),
    ];
    for (what, card, check) in cases {
        let samples = [Sample {
            table: "fault = \"none\"\nfriction = 0.6\ncohesion = 4e5\nnormal_stiffness = 1e10\nshear_stiffness = 5e9",
            ..SAMPLE
        }];
        let report = voussoir::conformance::conform(
            &Card { samples: Box::leak(Box::new(samples)), ..card },
            &Default::default(),
        );
        assert!(report.fails(check), "{what}: {report}");
    }
    every_fault_is_found(&CARD, TABLE, SAMPLE, &[("a_number_of_its_own", &["units"])]);
}

/// A failure writes a study that drives the law to the place of the failure. The law of this test is not a plug-in of a
/// study, so another law is driven along the same path.
#[test]
fn a_failure_writes_a_study_that_shows_it() {
    const REFUSES: &str =
        "fault = \"refuses_to_open\"\nfriction = 0.6\ncohesion = 4e5\nnormal_stiffness = 1e10\nshear_stiffness = 5e9";
    let samples: &[Sample] = Box::leak(Box::new([Sample { table: REFUSES, ..SAMPLE }]));
    let report = conform(&Card { samples, ..CARD }, &Options::default());
    let finding = report.findings.iter().find(|finding| finding.check == "finite").expect("a finding");
    let study = finding.study.as_ref().expect("a study");
    let other =
        study.replace(CARD.tag, "coulomb").replace("fault = \"refuses_to_open\"\n", "").replace("cohesion = 4e5\n", "");
    let loaded = read_study(&other, "found.toml", &[]).unwrap_or_else(|wrong| panic!("{wrong}\n{study}"));
    let output = loaded.run(&RunRequest { wanted: vec![0], jobs: 1, ..RunRequest::default() }, &Unobserved);
    assert!(output.certified, "{}", output.table);
}
