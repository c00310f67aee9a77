//! Compares the events of two paths by their identity: stage, joint, contact point and kind of event.

use crate::checks::tolerances::{BEYOND, FACTOR, GEOMETRY, Route};
use crate::results::EventEntry;
use serde::Deserialize;
use serde_json::Value as Json;
use std::collections::BTreeMap;

/// Returns the differences between the events of two runs. `steps_differ`: the second run has another number of steps.
pub(crate) fn differences(stored: &Json, again: &Json, route: Route, steps_differ: bool) -> Vec<String> {
    let read = |events: &Json| Vec::<EventEntry>::deserialize(events).map_err(|error| vec![format!("events: {error}")]);
    let (stored, again) = match (read(stored), read(again)) {
        (Ok(stored), Ok(again)) => (stored, again),
        (Err(why), _) | (_, Err(why)) => return why,
    };
    let all = || stored.iter().chain(&again);
    let greatest = all().map(|event| event.factor.abs()).fold(0.0, f64::max);
    if !all().all(|event| event.factor.is_finite()) {
        return vec!["events: a factor is no number".into()];
    }
    let mut ids = Identities::default();
    let [ours, theirs] = [&stored, &again].map(|list| list.iter().map(|event| ids.of(event)).collect::<Vec<_>>());
    let ours: Vec<Event> = ours.into_iter().zip(&stored).map(|(id, event)| (id, event.factor)).collect();
    let theirs: Vec<Event> = theirs.into_iter().zip(&again).map(|(id, event)| (id, event.factor)).collect();
    let near = FACTOR.of(route) * greatest;
    if route != Route::Steps {
        return strict(&ours, &theirs, near).into_iter().collect();
    }
    // Both runs must agree up to the greatest factor.
    let peak = theirs.iter().enumerate().max_by(|a, b| a.1.1.total_cmp(&b.1.1)).map_or(0, |(index, _)| index + 1);
    if ours.len() < peak {
        return vec![format!(
            "{} events, but solving the case again gives {} up to the greatest factor",
            ours.len(),
            peak
        )];
    }
    let mut found: Vec<String> = strict(&ours[..peak], &theirs[..peak], near).into_iter().collect();
    let share = BEYOND.of(route);
    let (left, right) = (&ours[peak..], &theirs[peak..]);
    let unmatched = unmatched(left, right, share * greatest);
    let allowed = if steps_differ { 2.0 + share * (left.len() + right.len()) as f64 } else { 0.0 };
    if unmatched as f64 > allowed {
        found.push(format!("{unmatched} events beyond the greatest factor differ when the case is solved again"));
    }
    found
}

/// The number of an identity, and the factor.
type Event = (usize, f64);

/// Assigns numbers to identities.
#[derive(Default)]
struct Identities(Vec<EventEntry>);

impl Identities {
    /// The number of an event's identity.
    fn of(&mut self, event: &EventEntry) -> usize {
        let same = |known: &EventEntry| {
            let size = known.point.iter().chain(&event.point).fold(1.0, |a: f64, x| a.max(x.abs()));
            let near =
                |axis: usize| (known.point[axis] - event.point[axis]).abs() <= 1e3 * GEOMETRY.of(Route::Steps) * size;
            (known.joint, known.what, known.gravity, &known.stage)
                == (event.joint, event.what, event.gravity, &event.stage)
                && near(0)
                && near(1)
        };
        self.0.iter().position(same).unwrap_or_else(|| {
            self.0.push(event.clone());
            self.0.len() - 1
        })
    }
}

/// Returns the first difference of two lists that must have the same events. Events at the same factor may be in any
/// order.
fn strict(stored: &[Event], again: &[Event], near: f64) -> Option<String> {
    if stored.len() != again.len() {
        return Some(format!("{} events, but solving the case again gives {}", stored.len(), again.len()));
    }
    let mut places: BTreeMap<usize, std::collections::VecDeque<usize>> = BTreeMap::new();
    again.iter().enumerate().for_each(|(index, (id, _))| places.entry(*id).or_default().push_back(index));
    let mut last: Option<usize> = None;
    for (index, (id, factor)) in stored.iter().enumerate() {
        let Some(place) = places.get_mut(id).and_then(std::collections::VecDeque::pop_front) else {
            return Some(format!("events[{index}]: solving the case again gives no such event"));
        };
        let other = again[place].1;
        if (factor - other).abs() > near {
            return Some(format!("events[{index}].factor is {factor}, but solving the case again gives {other}"));
        }
        let before = last.filter(|last| *last > place);
        if before.is_some_and(|before| (again[before].1 - other).abs() > near) {
            return Some(format!("events[{index}] is not in its order"));
        }
        last = Some(place);
    }
    None
}

/// Returns the number of events in both lists that have no partner: the same identity, in order, and a factor that
/// differs by at most `near`.
fn unmatched(stored: &[Event], again: &[Event], near: f64) -> usize {
    let by_identity = |list: &[Event]| {
        let mut own: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
        list.iter().for_each(|(id, factor)| own.entry(*id).or_default().push(*factor));
        own
    };
    let (stored, again) = (by_identity(stored), by_identity(again));
    let ids: std::collections::BTreeSet<&usize> = stored.keys().chain(again.keys()).collect();
    let factors = |own: &BTreeMap<usize, Vec<f64>>, id: &usize| own.get(id).cloned().unwrap_or_default();
    ids.into_iter()
        .map(|id| {
            let (a, b) = (factors(&stored, id), factors(&again, id));
            a.len() + b.len() - 2 * common(&a, &b, near)
        })
        .sum()
}

/// Returns the length of the longest common subsequence of numbers that are equal within `near`.
fn common(a: &[f64], b: &[f64], near: f64) -> usize {
    let mut row = vec![0; b.len() + 1];
    for x in a {
        let mut diagonal = 0;
        for (j, y) in b.iter().enumerate() {
            let above = row[j + 1];
            row[j + 1] = if (x - y).abs() <= near { diagonal + 1 } else { above.max(row[j]) };
            diagonal = above;
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn events() -> Json {
        // 20 events up to the greatest factor, 40 after it.
        let factor = |i: usize| if i < 20 { i as f64 } else { 20.0 - 0.5 * i as f64 };
        (0..60)
            .map(|i| json!({ "stage": "live", "factor": factor(i), "joint": i % 7, "point": [1.0 / 3.0, i % 2], "what": "opens" }))
            .collect()
    }

    fn found(change: impl Fn(&mut Vec<Json>), steps_differ: bool) -> bool {
        let mut changed = events();
        change(changed.as_array_mut().expect("a list"));
        !differences(&changed, &events(), Route::Steps, steps_differ).is_empty()
    }

    #[test]
    fn events_are_compared_by_identity() {
        for steps_differ in [false, true] {
            assert!(!found(|_| {}, steps_differ));
            assert!(!found(|list| list[9]["factor"] = json!(9.0 + 19.0 * 0.9e-8), steps_differ), "just inside");
            assert!(found(|list| list[9]["factor"] = json!(9.0 + 19.0 * 1.1e-8), steps_differ), "just outside");
            assert!(found(|list| list[9]["what"] = json!("closes"), steps_differ));
            assert!(found(|list| list[9]["joint"] = json!(6), steps_differ));
            assert!(found(|list| list[9]["point"] = json!([1.0 / 3.0, 0.5]), steps_differ));
            assert!(found(|list| list.swap(8, 9), steps_differ));
            assert!(found(|list| drop(list.remove(9)), steps_differ));
            assert!(found(|list| list.truncate(20), steps_differ));
        }
        // After the greatest factor, short events may be missing if the numbers of steps differ, and only then.
        let brief = |list: &mut Vec<Json>| drop(list.drain(40..42));
        assert!(found(brief, false) && !found(brief, true));
        assert!(found(|list| drop(list.drain(40..50)), true));
        let moved = |by: f64| {
            move |list: &mut Vec<Json>| {
                for event in &mut list[25..] {
                    event["factor"] = json!(event["factor"].as_f64().expect("a number") + by);
                }
            }
        };
        for steps_differ in [false, true] {
            assert!(!found(moved(19.0 * 0.049), steps_differ) && found(moved(19.0 * 0.2), steps_differ));
        }
    }

    /// Two events at one factor may be in any order.
    #[test]
    fn ties_have_no_order() {
        let list = |order: [usize; 2]| {
            let event = |joint: usize| json!({ "stage": "live", "factor": 2.0, "joint": joint, "point": [0.0, 0.0], "what": "opens" });
            json!(order.map(event))
        };
        assert!(differences(&list([1, 2]), &list([2, 1]), Route::Events, false).is_empty());
    }
}
