//! The positions to try: evenly spaced ones, those at which an axle enters the bridge, and those at which an edge of its
//! patch meets a joint.

use super::request::{Request, Run};
use voussoir_core::model::Chord;
use voussoir_study::loads::{LoadSite, LoadTables, Track, VehicleAxles, fill_layers, footprints};
use voussoir_study::scenes::dispersion::{Dispersion, Patch};
use voussoir_study::study::Case;

/// Positions closer than this share of the range are equal.
const SAME: f64 = 1e-9;

/// Values of the parameter.
#[derive(Debug, Default)]
pub(super) struct Places {
    /// Positions of the scan in ascending order: evenly spaced ones, and those at which an axle enters or leaves.
    pub scan: Vec<f64>,
    /// Positions at which an edge of a patch meets a joint, in ascending order. They are tried if the scan is low there.
    pub joints: Vec<f64>,
}

/// Returns the positions of a run.
pub(super) fn places(case: &Case, request: &Request, run: &Run) -> Places {
    let [from, to] = request.range();
    let last = (request.scan - 1) as f64;
    let even = (0..request.scan).map(|i| if i + 1 == request.scan { to } else { from + (to - from) * i as f64 / last });
    let load = request.parameter.rsplit_once('.').and_then(|(table, _)| case.resolved.at(table));
    let track = load.and_then(|load| serde_json::from_value(load.get("track")?.clone()).ok());
    let Places { scan: entering, joints } = events(case, run, track.as_ref());
    let tidy = |places: &mut Vec<f64>| {
        places.retain(|x| from <= *x && *x <= to);
        places.sort_by(f64::total_cmp);
        places.dedup_by(|b, a| *b - *a <= SAME * (to - from));
    };
    let mut places = Places { scan: even.chain(entering).collect(), joints };
    tidy(&mut places.scan);
    tidy(&mut places.joints);
    places
}

/// Returns the positions at which an axle enters or leaves, and at which an edge of its patch on the extrados meets a joint.
fn events(case: &Case, run: &Run, track: Option<&Track>) -> Places {
    let name = run.vehicle.as_deref().unwrap_or_default();
    let vehicle = case.resolved.get("vehicles").and_then(|all| all.get(name));
    let vehicle: Option<VehicleAxles> = vehicle.and_then(|table| serde_json::from_value(table.clone()).ok());
    let Some(vehicle) = vehicle else { return Places::default() };
    let law = case.resolved.at("scene.fill.dispersion").cloned();
    let tables =
        LoadTables { dispersion: law.and_then(|law| serde_json::from_value(law).ok()), ..LoadTables::default() };
    let site = LoadSite::new(&case.assembly, &tables, "");
    let chords = case.assembly.extrados();
    let mut joints: Vec<f64> = chords.iter().flat_map(|chord| chord.ends.map(|end| end.x)).collect();
    joints.sort_by(f64::total_cmp);
    joints.dedup();
    let (Some(&first), Some(&last)) = (joints.first(), joints.last()) else { return Places::default() };
    let sense = if run.direction.as_deref() == Some("backward") { -1.0 } else { 1.0 };
    // Slightly inside: beyond the ends the axle is ignored.
    let hair = 1e-9 * (last - first);
    let mut places = Places::default();
    for axle in &vehicle.axles {
        for Patch { from, to, .. } in footprints(axle, track) {
            let origin = |x: f64| x - sense * axle.at - (from + to) / 2.0;
            places.scan.extend([first + hair, last - hair].map(origin));
            for joint in &joints {
                for side in [-1.0, 1.0] {
                    let centre = centre_of(&site, &chords, *joint, side, (to - from) / 2.0);
                    // A patch without length moves abruptly from one block to the next.
                    let apart = if to == from { hair } else { 0.0 };
                    places.joints.push(origin(centre + side * apart));
                }
            }
        }
    }
    places
}

/// Returns the centre of a patch whose edge on its `side` meets a joint. The spread depends on the depth under the centre, so
/// the centre is found by iteration.
fn centre_of(site: &LoadSite, chords: &[Chord], joint: f64, side: f64, half: f64) -> f64 {
    let mut centre = joint - side * half;
    for _ in 0..8 {
        let next = joint - side * (half + reach(site, chords, centre, half));
        if (next - centre).abs() <= 1e-12 * site.assembly.size() {
            break;
        }
        centre = next;
    }
    centre
}

/// Returns the distance by which the fill spreads a patch on one side.
fn reach(site: &LoadSite, chords: &[Chord], centre: f64, half: f64) -> f64 {
    let law: Option<&dyn Dispersion> = site.tables.dispersion.as_deref();
    let above = chords.iter().filter(|chord| chord.left() <= centre && centre <= chord.right());
    let level = above.map(|chord| chord.at(centre).y).fold(f64::NEG_INFINITY, f64::max);
    let Some(law) = law.filter(|_| level.is_finite()) else { return 0.0 };
    let patch = Patch { from: centre - half, to: centre + half, share: 1.0 };
    let spread = law.spread(patch, &fill_layers(site, centre, level));
    spread.iter().map(|part| patch.from - part.from).fold(0.0, f64::max)
}
