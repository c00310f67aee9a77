//! Loads on the extrados of an arch or a bridge.
//!
//! On arches `span_fraction` f is measured along the intrados span from the left springing. A load acts on the straight
//! extrados chord above (or below) that x. If a vertical line crosses two chords, the load acts on the upper one. A force at
//! the boundary of two voussoirs acts on the voussoir nearer to midspan. Exactly at midspan each voussoir gets half, so that
//! mirrored loads act on mirrored blocks.

use super::site::LoadSite;
use crate::scenes::dispersion::{Dispersion, Patch, Through};
use voussoir_core::model::geometry::Vec2;
use voussoir_core::model::{CONTACT_TOLERANCE, Chord, LoadSpread, PointForce, carried};
use voussoir_core::plugin::Diagnostic;

/// Share of the size of the scene within which a load is moved to a vertex.
const ROUNDING: f64 = 1e-12;

/// Returns the faces that carry loads.
fn faces(site: &LoadSite, key: &str) -> Result<Vec<Chord>, Vec<Diagnostic>> {
    let faces = site.assembly.extrados();
    if faces.is_empty() {
        let message = "counts along the span of an arch, but this scene is not one";
        let wrong = Diagnostic::new(site.key(key), message).help("give block and point, or block and edge");
        return Err(vec![wrong]);
    }
    Ok(faces)
}

/// Returns x of a span fraction, between the intrados ends of the first and last joint across a ring.
pub fn x_at(site: &LoadSite, fraction: f64, key: &str) -> Result<f64, Vec<Diagnostic>> {
    faces(site, key)?;
    site.finite(&[(key, &[fraction])])?;
    let [left, span] = match (&site.assembly.bridge, &site.assembly.arch) {
        (Some(bridge), _) => [bridge.springings[0], bridge.springings[1] - bridge.springings[0]],
        (None, Some(arch)) => [site.assembly.joints[0].ends[0].x, arch.span],
        (None, None) => [0.0; 2],
    };
    Ok(left + fraction * span)
}

/// Returns the horizontal range of the faces that carry loads \[m\].
pub fn reach(site: &LoadSite, key: &str) -> Result<(f64, f64), Vec<Diagnostic>> {
    let (left, right) = extent(&faces(site, key)?);
    let tolerance = ROUNDING * site.assembly.size();
    Ok((left - tolerance, right + tolerance))
}

/// Places a force at x on the upper chord: at a boundary on the chord nearer to midspan, at midspan half on each.
pub fn on_extrados(site: &LoadSite, x: f64, force: Vec2, key: &str) -> Result<Vec<PointForce>, Vec<Diagnostic>> {
    let chords = faces(site, key)?;
    let chosen = upper_at(&chords, x, ROUNDING * site.assembly.size());
    if chosen.is_empty() {
        let (left, right) = extent(&chords);
        let message = format!("x = {x} m hits no block: the extrados reaches from {left} to {right} m");
        return site.fail(key, message);
    }
    let share = force / chosen.len() as f64;
    let on = |chord: Chord| Ok(PointForce { body: site.movable(chord.body, key)?, point: chord.at(x), force: share });
    chosen.into_iter().map(on).collect()
}

/// Returns the upper chords at x: one chord, two equal ones at the middle of a ring, none beyond the ends.
fn upper_at(chords: &[Chord], x: f64, tolerance: f64) -> Vec<Chord> {
    let here: Vec<_> = chords
        .iter()
        .filter(|chord| chord.left() - tolerance <= x && x <= chord.right() + tolerance)
        .map(|chord| (chord, chord.at(x)))
        .collect();
    let Some(top) = here.iter().map(|(_, point)| point.y).max_by(f64::total_cmp) else { return Vec::new() };
    // Chords that meet at x share a vertex, within the tolerance and the slope of the chord.
    let near = |point: &Vec2| here.iter().any(|(_, p)| p.y == top && (point - p).norm() <= 4.0 * tolerance);
    let upper: Vec<_> = here.iter().filter(|(_, point)| point.y == top || near(point)).collect();
    let nearest = upper.iter().map(|(chord, _)| chord.from_middle).min().unwrap_or(0);
    upper.into_iter().filter(|(chord, _)| chord.from_middle == nearest).map(|(chord, _)| **chord).collect()
}

/// Returns the forces of a uniform load per plan length \[N/m\] between two x. Each rigid voussoir gets one force at the
/// middle of its loaded length, each deformable one the points of a quadrature rule. `keys` name the ends in messages.
pub fn on_patch(
    site: &LoadSite,
    [start, end]: [f64; 2],
    density: Vec2,
    keys: [&str; 2],
) -> Result<Vec<PointForce>, Vec<Diagnostic>> {
    let chords = faces(site, keys[0])?;
    let tolerance = CONTACT_TOLERANCE * site.assembly.size();
    let (left, right) = extent(&chords);
    for (key, x) in keys.into_iter().zip([start, end]) {
        if x < left - tolerance || x > right + tolerance {
            let message = format!("x = {x} m lies beyond the extrados, which reaches from {left} to {right} m");
            return site.fail(key, message);
        }
    }
    let mut forces = Vec::new();
    for (chord, low, high) in carried(&chords, [start, end], ROUNDING * site.assembly.size()) {
        let body = site.movable(chord.body, "")?;
        forces.extend(site.spread(body, [chord.at(low), chord.at(high)], density * (high - low)));
    }
    Ok(forces)
}

/// Returns the forces of a uniform load per plan length \[N/m\] between two x. Load beyond the bridge or on fixed bodies
/// goes to the ground.
pub fn on_faces(site: &LoadSite, ends: [f64; 2], density: Vec2, key: &str) -> Result<Vec<PointForce>, Vec<Diagnostic>> {
    let chords = faces(site, key)?;
    let carried = carried(&chords, ends, ROUNDING * site.assembly.size());
    let movable = carried.into_iter().filter(|(chord, ..)| site.moves(chord.body));
    let on = |(chord, low, high): (Chord, f64, f64)| {
        site.spread(chord.body, [chord.at(low), chord.at(high)], density * (high - low))
    };
    Ok(movable.flat_map(on).collect())
}

/// The action of a load on the road on the blocks.
#[derive(Debug)]
pub struct FromRoad {
    /// Forces for a load of 1 N downwards.
    pub forces: Vec<PointForce>,
    /// Distance by which the patch is longer on each side after its way through the fill \[m\].
    pub reach: f64,
    /// The spread, for drawings.
    pub spread: LoadSpread,
}

/// Spreads a load of 1 N, uniform over a patch of the road, in the fill. Returns `None` if its centre is off the bridge.
pub fn from_road(site: &LoadSite, patch: Patch, key: &str) -> Result<Option<FromRoad>, Vec<Diagnostic>> {
    let chords = faces(site, key)?;
    let tolerance = ROUNDING * site.assembly.size();
    let centre = (patch.from + patch.to) / 2.0;
    let Some(chord) = upper_at(&chords, centre, tolerance).first().copied() else { return Ok(None) };
    let fill = fill_layers(site, centre, chord.at(centre).y);
    let dispersion: Option<&dyn Dispersion> = site.tables.dispersion.as_deref();
    let spread = dispersion.map_or_else(|| vec![patch], |law| law.spread(patch, &fill));
    let reach = spread.iter().map(|part| patch.from - part.from).fold(0.0, f64::max);
    let parts = spread.len();
    let mut forces = Vec::new();
    for Patch { from, to, share } in spread {
        let force = Vec2::new(0.0, -share);
        if to > from {
            forces.extend(on_faces(site, [from, to], force / (to - from), key)?);
            continue;
        }
        let under = upper_at(&chords, from, tolerance);
        let each = force / under.len().max(1) as f64;
        let movable = under.into_iter().filter(|chord| site.moves(chord.body));
        forces.extend(movable.map(|chord| PointForce { body: chord.body, point: chord.at(from), force: each }));
    }
    let forces = if parts > 1 { merged(site, forces) } else { forces };
    let ends = |y: f64, reach: f64| [Vec2::new(patch.from - reach, y), Vec2::new(patch.to + reach, y)];
    let level = chord.at(centre).y;
    let road = site.assembly.bridge.as_ref().and_then(|bridge| bridge.road_at(centre)).unwrap_or(level);
    let spread = LoadSpread { on_road: ends(road, 0.0), below: ends(level, reach) };
    Ok(Some(FromRoad { forces, reach, spread }))
}

/// Merges downward forces into one resultant for each rigid block, on the straight chord that carries them.
fn merged(site: &LoadSite, forces: Vec<PointForce>) -> Vec<PointForce> {
    let mut out: Vec<PointForce> = Vec::new();
    for force in forces {
        match out.iter_mut().find(|other| other.body == force.body && site.assembly.is_rigid(force.body)) {
            Some(other) => {
                let sum = other.force + force.force;
                other.point += (force.point - other.point) * (force.force.y / sum.y);
                other.force = sum;
            }
            None => out.push(force),
        }
    }
    out
}

/// Returns the layers between the road and a level at x, from bottom to top.
pub fn fill_layers(site: &LoadSite, x: f64, level: f64) -> Vec<Through> {
    let Some((bridge, road)) = site.assembly.bridge.as_ref().and_then(|bridge| Some((bridge, bridge.road_at(x)?)))
    else {
        return Vec::new();
    };
    let mut bottom = level;
    let mut through = Vec::new();
    for &(top, angle) in &bridge.layers {
        let thickness = top.min(road) - bottom;
        if thickness > 0.0 {
            through.push(Through { thickness, angle });
            bottom = top.min(road);
        }
    }
    through
}

/// Spreads a load above the extrados at x by the law that the load names. Reports a mistake at `key` if neither the law nor
/// a fill defines the depth.
pub fn dispersed(
    site: &LoadSite,
    law: &dyn Dispersion,
    patch: Patch,
    key: &str,
) -> Result<Vec<Patch>, Vec<Diagnostic>> {
    let chords = faces(site, key)?;
    let centre = (patch.from + patch.to) / 2.0;
    let chord = upper_at(&chords, centre, ROUNDING * site.assembly.size()).first().copied();
    let fill = chord.map(|chord| fill_layers(site, centre, chord.at(centre).y)).unwrap_or_default();
    if fill.is_empty() && !law.has_depth() {
        return site.fail("dispersion.depth", "is missing: there is no fill above the extrados that would give it");
    }
    Ok(law.spread(patch, &fill))
}

/// Returns the least and greatest x of the extrados.
fn extent(chords: &[Chord]) -> (f64, f64) {
    let left = chords.iter().fold(f64::INFINITY, |x, chord| x.min(chord.left()));
    (left, chords.iter().fold(f64::NEG_INFINITY, |x, chord| x.max(chord.right())))
}
