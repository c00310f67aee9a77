//! The check of a solver or strategy by `voussoir conform`.

use super::own_answer::false_statement;
use super::suite::{Lie, answered_within, reference, scenes, solver_keys};
use crate::conformance::findings::Recorder;
use std::sync::atomic::Ordering;
use std::time::Duration;
use voussoir_core::limit::Status;
use voussoir_core::plugin::{Card, PluginKind};

/// Time limit for one scene.
const TIME_LIMIT: Duration = Duration::from_secs(60);

/// Checks a solver or strategy; does nothing for other plug-ins.
pub fn check(recorder: &mut Recorder, card: &Card) {
    let kinds = [PluginKind::LimitSolver, PluginKind::PathSolver, PluginKind::Continuation];
    if !kinds.contains(&card.kind) {
        return;
    }
    recorder.whole();
    let mut answers = 0;
    for scene in scenes(card.kind) {
        let case = match scene.case(&solver_keys(card.kind, card.tag)) {
            Ok(case) => case,
            Err(why) => {
                recorder.leave_out(&format!("scene {}: {}", scene.name, why.to_string().trim()));
                continue;
            }
        };
        let known = reference(scene);
        let Some(result) = answered_within(TIME_LIMIT, case.clone()) else {
            recorder.fail("returns", format!("no answer to {} within {} s", scene.name, TIME_LIMIT.as_secs()));
            return;
        };
        recorder.hold("returns", true, String::new);
        answers += usize::from(result.status != Status::Stalled);
        let panicked = result.notes.iter().find(|note| note.starts_with("a panic ended the case"));
        recorder.hold("panic", panicked.is_none(), || format!("{}: {}", scene.name, result.notes.join("; ")));
        let wrong = scene.truth.contradictions(&result, known.as_ref());
        recorder.hold("truth", wrong.is_empty(), || format!("{}: {}", scene.name, wrong.join("; ")));
        let own = false_statement(case.clone(), &scene.truth, TIME_LIMIT);
        recorder.hold("own_answer", own.is_none(), || format!("{}: {}", scene.name, own.clone().unwrap_or_default()));
        for lie in Lie::of(card.kind) {
            let mut case = case.clone();
            let Some(told) = lie.put_into(&mut case) else { continue };
            let Some(result) = answered_within(TIME_LIMIT, case) else {
                recorder.fail("lies", format!("{} of {}: no answer within the time", lie.name(), scene.name));
                continue;
            };
            if told.load(Ordering::Relaxed) > 0 {
                let wrong = scene.truth.contradictions(&result, known.as_ref());
                recorder.hold("lies", wrong.is_empty(), || {
                    format!("{} of {} is believed: {}", lie.name(), scene.name, wrong.join("; "))
                });
            }
        }
    }
    recorder.hold("answers", answers > 0, || "no scene is answered".into());
}
