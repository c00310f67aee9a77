//! Known paths: their tractions or stresses come from an independent source; the card of a law contains them.

use super::findings::Recorder;
use super::options::Options;
use super::plug_in::PlugIn;
use super::point::Point;
use super::samples::{is_law, samples_of, table};
use voussoir_core::plugin::{Card, KnownPath, Sample};

/// Checks every known path of a law. A law that answers at a point needs at least one; a law with a memory needs one that
/// unloads after an irreversible change.
pub(super) fn check(recorder: &mut Recorder, card: &Card, _: &Options) {
    if !is_law(card) {
        return;
    }
    let points: Vec<Point> = samples_of(card).iter().filter_map(|(_, _, law)| point(law)).collect();
    if points.is_empty() {
        return;
    }
    recorder.whole();
    recorder.hold("known_path", !card.known_paths.is_empty(), || {
        "brings no path whose answer is known from elsewhere: generic checks cannot see a missing memory".into()
    });
    let remembers = points.iter().any(|point| point.state_size() > 0);
    let mut comes_back = !remembers;
    for path in card.known_paths {
        comes_back |= check_path(recorder, card, path);
    }
    recorder.whole();
    recorder.hold("known_path", comes_back, || {
        "has a state, but no known path goes back after something irreversible: that is where memory shows".into()
    });
}

fn point(law: &PlugIn) -> Option<Point> {
    match law {
        PlugIn::Joint(law) => Some(Point::Joint(law.response()?)),
        PlugIn::Material(law) => Some(Point::material(law.stress_update()?)),
        PlugIn::Scene(_) | PlugIn::Load(_) => None,
    }
}

/// Returns the law at a point; materials get the characteristic length on the card.
fn point_of_length(law: &PlugIn, length: f64) -> Option<Point> {
    match point(law)? {
        Point::Material(law, _) => Some(Point::Material(law, length)),
        joint => Some(joint),
    }
}

/// Checks a path. Returns true if the path unloads elastically after an irreversible change.
fn check_path(recorder: &mut Recorder, card: &Card, known: &KnownPath) -> bool {
    recorder.sample(&Sample::new(known.table, 1.0, &[]));
    let law =
        table(card, known.table).ok_or("it is no TOML".to_string()).and_then(|table| PlugIn::read(card.kind, &table));
    let point = match law.as_ref().map(|law| point_of_length(law, card.known_path_length)) {
        Ok(Some(point)) => point,
        Ok(None) => {
            recorder.fail("known_path", format!("{}: the law answers at no point", known.source));
            return false;
        }
        Err(why) => {
            recorder.fail("known_path", format!("{}: the table cannot be read: {why}", known.source));
            return false;
        }
    };
    recorder.hold("known_path", !known.source.is_empty() && !known.steps.is_empty(), || {
        "names no source or has no steps".into()
    });
    let (mut old, mut new, mut path) = (point.untouched(), vec![0.0; point.state_size()], Vec::new());
    let scale = known.steps.iter().flat_map(|(_, force)| force.iter()).fold(0.0_f64, |a, b| a.max(b.abs()));
    let (mut yielded, mut back) = (false, false);
    for (index, (place, force)) in known.steps.iter().enumerate() {
        let n = point.components();
        if place.len() != n || force.len() != n {
            recorder.fail("known_path", format!("{}: step {index} has not {n} components", known.source));
            return false;
        }
        let mut at = [0.0; 6];
        at[..n].copy_from_slice(place);
        path.push(at);
        let said = match point.update(&at, &old, &mut new) {
            Ok(said) => said,
            Err(why) => {
                recorder.hold_on("known_path", false, &path, || {
                    format!("{}: step {index} is refused: {why}", known.source)
                });
                return false;
            }
        };
        old.copy_from_slice(&new);
        let off = (0..n).map(|i| (said.force[i] - force[i]).abs()).fold(0.0, f64::max);
        recorder.hold_on("known_path", off <= known.tolerance * scale, &path, || {
            format!("{}: step {index} at {place:?} gives {:?} instead of {force:?}", known.source, &said.force[..n])
        });
        yielded |= !said.branch.is_elastic();
        back |= yielded && said.branch.is_elastic();
    }
    back
}
