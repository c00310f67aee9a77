//! Loads: the same forces each time, on blocks that exist, independently of units and of the numbers of blocks.

use super::findings::Recorder;
use super::options::Options;
use super::plug_in::PlugIn;
use super::samples::samples_of;
use super::scaled::{LENGTH, STRESS};
use super::site::Site;
use super::units::other_units;
use voussoir_core::model::geometry::{Vec2, contains};
use voussoir_core::model::{Assembly, CONTACT_TOLERANCE};
use voussoir_core::plugin::{Card, PluginKind};
use voussoir_study::loads::{LoadKind, Placed};

/// Greatest difference of forces and places, as a share of the greatest one.
const SAME: f64 = 1e-9;

/// Checks every sample of a kind of load; does nothing for other plug-ins.
pub(super) fn check(recorder: &mut Recorder, card: &Card, _: &Options) {
    if card.kind != PluginKind::LoadKind {
        return;
    }
    for (sample, table, plug_in) in samples_of(card) {
        recorder.sample(&sample);
        let PlugIn::Load(load) = plug_in else { continue };
        let site = Site::standard();
        let Some(here) = placed(recorder, "samples", load.as_ref(), &site) else { continue };
        is_sound(recorder, &here, &site.assembly);
        recorder.hold("samples", !is_nothing(&here), || "the sample is no load".into());
        let count = site.assembly.bodies.len();
        if let Some(mut there) = placed(recorder, "numbering", load.as_ref(), &site.renumbered()) {
            there.forces.iter_mut().for_each(|force| force.body = count - 1 - force.body.min(count - 1));
            recorder.hold("numbering", same(&here, &there, [1.0; 2]), || {
                "with the blocks in another order it is another load".into()
            });
        }
        if let Some(PlugIn::Load(other)) = other_units(recorder, card, &table)
            && let Some(there) = placed(recorder, "units", other.as_ref(), &Site::in_other_units())
        {
            recorder.hold("units", same(&here, &there, [LENGTH, STRESS * LENGTH * LENGTH]), || {
                format!("with lengths × {LENGTH} and stresses × {STRESS} it is another load: a key has a wrong unit, or the code contains a number with a unit")
            });
        }
    }
}

/// Checks forces: numbers are finite, and each acts on a block of the assembly, at a point in or on it.
pub(super) fn is_sound(recorder: &mut Recorder, placed: &Placed, assembly: &Assembly) {
    let finite = |vector: &Vec2| vector.iter().all(|x| x.is_finite());
    let numbers = placed.forces.iter().flat_map(|force| [&force.point, &force.force]).chain(&placed.accelerations);
    recorder.hold("finite", numbers.into_iter().all(finite), || "places a force that is not finite".into());
    let tolerance = CONTACT_TOLERANCE * assembly.size();
    for force in &placed.forces {
        let block = assembly.bodies.get(force.body);
        let on = block.is_some_and(|block| contains(&block.vertices, force.point, tolerance));
        recorder.hold("geometry", on, || {
            let name = block.map_or("that does not exist".into(), |block| format!("\"{}\"", block.name));
            format!("places a force at {:?}, outside of block {name}", force.point.as_slice())
        });
    }
}

/// Places a load; a refusal is a finding of a check.
fn placed(recorder: &mut Recorder, check: &'static str, load: &dyn LoadKind, site: &Site) -> Option<Placed> {
    let placed = load.place(&site.place());
    let refused = placed.as_ref().err().and_then(|wrong| wrong.first()).map(ToString::to_string);
    recorder
        .hold(check, placed.is_ok(), || format!("is refused on the standard bridge: {}", refused.unwrap_or_default()));
    placed.ok()
}

fn is_nothing(placed: &Placed) -> bool {
    placed.forces.iter().all(|force| force.force == Vec2::zeros())
        && placed.accelerations.iter().all(|acceleration| *acceleration == Vec2::zeros())
}

/// Returns true if two loads are the same after lengths and forces of the second are divided by factors. The order of their
/// forces does not matter.
fn same(here: &Placed, there: &Placed, [length, force]: [f64; 2]) -> bool {
    let rows = |placed: &Placed, [length, force]: [f64; 2]| {
        let of = |own: &voussoir_core::model::PointForce| (own.body, own.point / length, own.force / force);
        let mut rows: Vec<_> = placed.forces.iter().map(of).collect();
        rows.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.x.total_cmp(&b.1.x)).then(a.1.y.total_cmp(&b.1.y)));
        rows
    };
    let (a, b) = (rows(here, [1.0; 2]), rows(there, [length, force]));
    let size = |pick: fn(&(usize, Vec2, Vec2)) -> f64| SAME * a.iter().map(pick).fold(0.0, f64::max);
    let [place, strength] = [size(|row| row.1.amax()), size(|row| row.2.amax())];
    let near = |(a, b): (&(usize, Vec2, Vec2), &(usize, Vec2, Vec2))| {
        a.0 == b.0 && (a.1 - b.1).amax() <= place && (a.2 - b.2).amax() <= strength
    };
    let moved = |(a, b): (&Vec2, &Vec2)| (a - b).amax() <= SAME * a.amax();
    a.len() == b.len()
        && a.iter().zip(&b).all(near)
        && here.accelerations.len() == there.accelerations.len()
        && here.accelerations.iter().zip(&there.accelerations).all(moved)
}
