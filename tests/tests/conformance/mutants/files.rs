//! Study kinds and writers with one fault each.

use std::sync::atomic::{AtomicUsize, Ordering};
use voussoir::conformance::{Options, conform};
use voussoir::core::inventory;
use voussoir::core::plugin::{Card, PluginKind, Sample};
use voussoir::kinds::{
    KindEntry, LoadedStudy, RunOutput, RunRequest, SceneStudy, StoredResults, StudyKind, Verification,
};
use voussoir::results::CaseResult;
use voussoir::solve::{Observer, solve_cases};
use voussoir::study::{Study, StudyError, StudySource};
use voussoir::writers::{StudyOutput, Writer, WriterEntry};

static CALLS: AtomicUsize = AtomicUsize::new(0);

/// A kind that changes the results of its cases.
struct Changes(fn(&mut CaseResult));

impl StudyKind for Changes {
    fn read(&self, source: StudySource) -> Result<Box<dyn LoadedStudy>, StudyError> {
        SceneStudy::read(source)
    }

    fn solve(&self, study: &Study, wanted: &[usize], jobs: usize, observer: &dyn Observer) -> Vec<CaseResult> {
        let mut results = solve_cases(study, wanted, jobs, observer);
        results.iter_mut().for_each(self.0);
        results
    }
}

/// A kind that confirms all results.
struct Trusting;

struct TrustingStudy(Box<dyn LoadedStudy>);

impl StudyKind for Trusting {
    fn read(&self, source: StudySource) -> Result<Box<dyn LoadedStudy>, StudyError> {
        Ok(Box::new(TrustingStudy(SceneStudy::read(source)?)))
    }
}

impl LoadedStudy for TrustingStudy {
    fn name(&self) -> &str {
        self.0.name()
    }

    fn count(&self) -> usize {
        self.0.count()
    }

    fn resolved(&self) -> &toml::Value {
        self.0.resolved()
    }

    fn explain(&self) -> String {
        self.0.explain()
    }

    fn run(&self, request: &RunRequest, observer: &dyn Observer) -> RunOutput {
        self.0.run(request, observer)
    }

    fn verify_stored(&self, _: &StoredResults, _: &dyn Observer) -> Result<Verification, String> {
        Ok(Verification::default())
    }
}

const SAMPLES: &[Sample] = &[Sample::keys("[sweep]\n\"joints.dry.friction\" = { list = [0.4, 0.7] }")];

macro_rules! kind {
    ($tag:literal, $kind:expr) => {
        inventory::submit! { KindEntry { tag: $tag, kind: &$kind } }
        inventory::submit! {
            Card {
                kind: PluginKind::StudyKind,
                tag: $tag,
                summary: "a kind for tests",
                samples: SAMPLES,
                file: file!(),
                page: "# A kind for tests\n",
                ..Card::BLANK
            }
        }
    };
}

kind!("honest_kind", Changes(|_| ()));
kind!("impure_kind", Changes(|case| case.notes.push(format!("call {}", CALLS.fetch_add(1, Ordering::Relaxed)))));
kind!("exaggerating_kind", Changes(|case| case.load_factor = case.load_factor.map(|factor| 1.01 * factor)));
kind!("trusting_kind", Trusting);

/// A writer of one file.
struct Writes(fn() -> (&'static str, String));

impl Writer for Writes {
    fn files(&self, _: &StudyOutput, _: &serde_json::Value) -> Vec<(String, Vec<u8>)> {
        let (name, text) = self.0();
        vec![(name.into(), text.into_bytes())]
    }
}

macro_rules! writer {
    ($tag:literal, $writer:expr) => {
        inventory::submit! { WriterEntry { tag: $tag, writer: &$writer } }
        inventory::submit! {
            Card {
                kind: PluginKind::Writer,
                tag: $tag,
                summary: "a writer for tests",
                file: file!(),
                page: "# A writer for tests\n",
                ..Card::BLANK
            }
        }
    };
}

writer!("honest_writer", Writes(|| ("own.txt", "same".into())));
writer!("impure_writer", Writes(|| ("impure.txt", format!("{}", CALLS.fetch_add(1, Ordering::Relaxed)))));
writer!("first_writer", Writes(|| ("both.txt", "mine".into())));
writer!("second_writer", Writes(|| ("both.txt", "mine too".into())));
writer!("wandering_writer", Writes(|| ("../own.txt", "outside".into())));
writer!("empty_writer", Writes(|| ("empty.txt", String::new())));

/// The checks find each fault by name, and nothing else.
#[test]
fn faults_of_kinds_and_writers() {
    let faults: [(PluginKind, &str, &[&str]); 10] = [
        (PluginKind::StudyKind, "honest_kind", &[]),
        (PluginKind::StudyKind, "impure_kind", &["purity", "verify"]),
        (PluginKind::StudyKind, "exaggerating_kind", &["verify"]),
        (PluginKind::StudyKind, "trusting_kind", &["lies"]),
        (PluginKind::Writer, "honest_writer", &[]),
        (PluginKind::Writer, "impure_writer", &["purity"]),
        (PluginKind::Writer, "first_writer", &["names"]),
        (PluginKind::Writer, "second_writer", &["names"]),
        (PluginKind::Writer, "wandering_writer", &["names"]),
        (PluginKind::Writer, "empty_writer", &["names"]),
    ];
    for (kind, tag, checks) in faults {
        let card = voussoir::core::plugin::card(kind, tag).expect("a card");
        let report = conform(card, &Options::default());
        let failed: Vec<&str> = report.done.keys().copied().filter(|check| report.fails(check)).collect();
        assert_eq!(failed, checks, "{report}");
    }
}
