//! Mutated study files: `check`, and a run of the first case with a time limit.

use super::corpus::{RIGHT, STUDIES};
use super::mutation::{mutate, scramble};
use super::worker::{Input, phase};
use std::sync::Mutex;
use std::time::{Duration, Instant};
use voussoir::core::random::Random;
use voussoir::kinds::{LoadedStudy, RunRequest, StoredResults, read_source_beside};
use voussoir::solve::Observer;
use voussoir::study::{StudyError, StudySource, beside};

/// A run is cancelled after this time; limit analysis cannot be cancelled.
const LONGEST_RUN: Duration = Duration::from_millis(700);

/// Returns the study of a seed.
pub fn input(seed: u64) -> Input {
    let mut random = Random::new(seed);
    let own = if random.chance(0.9) { random.one_of(&STUDIES[..*RIGHT]) } else { random.one_of(&STUDIES) };
    let other = random.one_of(&STUDIES);
    let mut table = own.table.clone();
    mutate(&mut table, &other.table, &mut random);
    let text = toml::to_string(&table).unwrap_or_default();
    let text = if random.chance(0.1) { scramble(&text, &mut random) } else { text };
    Input { text, beside: own.path.clone() }
}

/// Cancels a run after its time limit.
struct Deadline(Mutex<Option<Instant>>);

impl Observer for Deadline {
    fn cancelled(&self) -> bool {
        let mut end = self.0.lock().expect("no thread panics while it holds this");
        Instant::now() > *end.get_or_insert_with(|| Instant::now() + LONGEST_RUN)
    }
}

/// Reads a study, and runs it if it is valid.
pub fn attempt(input: &Input) -> Result<(), String> {
    phase("check");
    let read = beside(&input.beside);
    let source = StudySource::parse_with(&input.text, "study.toml", &[], &read);
    match source.and_then(|source| read_source_beside(source, &read)) {
        Ok(study) => run(study.as_ref()),
        Err(wrong) => refused(&wrong),
    }
}

/// Checks that every mistake has a message without invisible characters.
pub fn refused(wrong: &StudyError) -> Result<(), String> {
    if wrong.mistakes().is_empty() {
        return Err("refused without a mistake".into());
    }
    for mistake in wrong.mistakes() {
        let text = mistake.to_string();
        if mistake.message.is_empty() || text.chars().any(|c| c.is_control() && c != '\n') || text.len() > 20_000 {
            return Err(format!("the message {text:?}"));
        }
    }
    Ok(())
}

fn run(study: &dyn LoadedStudy) -> Result<(), String> {
    phase("explain");
    let _ = (study.notes(), study.explain(), study.as_blocks());
    study.resolved_text()?;
    phase("run");
    let request = RunRequest {
        wanted: (0..study.count().min(1)).collect(),
        jobs: 1,
        version: "0".into(),
        ..RunRequest::default()
    };
    let output = study.run(&request, &Deadline(Mutex::default()));
    phase("verify");
    let file = |name: &str| {
        let found = output.files.iter().find(|(own, _)| own == name);
        found.map(|(_, bytes)| Box::new(std::io::Cursor::new(bytes.clone())) as Box<dyn std::io::Read>)
    };
    let _ = study.verify_stored(&StoredResults { jobs: 1, file: &file }, &Deadline(Mutex::default()));
    Ok(())
}
