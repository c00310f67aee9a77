//! The extrados of an arch or a bridge, on which loads stand.
//!
//! On arches `span_fraction` f counts along the intrados span from the left springing, and a load
//! acts on the straight extrados chord above (or below) that x; where a vertical meets two chords,
//! on the upper one. A force on the boundary of two voussoirs goes to the one nearer to midspan,
//! and exactly at midspan half to each, so that mirrored loads load mirrored blocks.

use super::dispersion::{Dispersion, Patch, Through};
use super::site::LoadSite;
use voussoir_core::model::geometry::Vec2;
use voussoir_core::model::{CONTACT_TOLERANCE, Chord, LoadSpread, PointForce, carried};
use voussoir_core::plugin::Diagnostic;

/// Share of the scene's size within which a load is at a vertex.
const ROUNDING: f64 = 1e-12;

/// The faces on which loads stand.
fn faces(site: &LoadSite, key: &str) -> Result<Vec<Chord>, Vec<Diagnostic>> {
    let faces = site.assembly.extrados();
    if faces.is_empty() {
        let message = "counts along the span of an arch, but this scene is not one";
        let wrong = Diagnostic::new(site.key(key), message).help("give block and point, or block and edge");
        return Err(vec![wrong]);
    }
    Ok(faces)
}

/// x of a span fraction, between the intrados ends of the first and last joint across a ring.
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

/// How far the faces reach on which loads stand \[m\].
pub fn reach(site: &LoadSite, key: &str) -> Result<(f64, f64), Vec<Diagnostic>> {
    let (left, right) = extent(&faces(site, key)?);
    let tolerance = ROUNDING * site.assembly.size();
    Ok((left - tolerance, right + tolerance))
}

/// A force at x: on the upper chord, at the boundary of two on the one nearer to midspan, at midspan half on each.
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

/// The upper chords at x: one, or two alike where they meet in the middle of a ring; none beyond the ends.
fn upper_at(chords: &[Chord], x: f64, tolerance: f64) -> Vec<Chord> {
    let here: Vec<_> = chords
        .iter()
        .filter(|chord| chord.left() - tolerance <= x && x <= chord.right() + tolerance)
        .map(|chord| (chord, chord.at(x)))
        .collect();
    let Some(top) = here.iter().map(|(_, point)| point.y).max_by(f64::total_cmp) else { return Vec::new() };
    // Chords that meet at x have their common vertex there, to within the tolerance and its slope.
    let near = |point: &Vec2| here.iter().any(|(_, p)| p.y == top && (point - p).norm() <= 4.0 * tolerance);
    let upper: Vec<_> = here.iter().filter(|(_, point)| point.y == top || near(point)).collect();
    let nearest = upper.iter().map(|(chord, _)| chord.from_middle).min().unwrap_or(0);
    upper.into_iter().filter(|(chord, _)| chord.from_middle == nearest).map(|(chord, _)| **chord).collect()
}

/// Forces of an even load per plan length \[N/m\] between two x; each voussoir gets one force at the middle of what
/// it carries, or the points of a rule. `keys` name the ends in what is wrong.
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

/// Forces of an even load per plan length \[N/m\] between two x; what lies beyond the bridge, or on what the ground
/// holds, goes to the ground.
pub fn on_faces(site: &LoadSite, ends: [f64; 2], density: Vec2, key: &str) -> Result<Vec<PointForce>, Vec<Diagnostic>> {
    let chords = faces(site, key)?;
    let carried = carried(&chords, ends, ROUNDING * site.assembly.size());
    let movable = carried.into_iter().filter(|(chord, ..)| site.moves(chord.body));
    let on = |(chord, low, high): (Chord, f64, f64)| {
        site.spread(chord.body, [chord.at(low), chord.at(high)], density * (high - low))
    };
    Ok(movable.flat_map(on).collect())
}

/// What a load on the road does to the blocks.
#[derive(Debug)]
pub struct FromRoad {
    /// Forces for a load of 1 N downwards.
    pub forces: Vec<PointForce>,
    /// How far the patch reaches beyond its own ends after its way through the fill \[m\].
    pub reach: f64,
    /// The same for drawings.
    pub spread: LoadSpread,
}

/// A load of 1 N, even over a patch of the road, spread in the fill; `None` where its centre is off the bridge.
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

/// Downward forces with one resultant for each rigid block: on its straight chord, where they stand.
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

/// The layers between the road and a level at x, from the lowest.
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

/// How a load above the extrados at x spreads by a law of its own; a mistake at `key` where the law gives no depth and
/// there is no fill.
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

/// Least and greatest x of the extrados.
fn extent(chords: &[Chord]) -> (f64, f64) {
    let left = chords.iter().fold(f64::INFINITY, |x, chord| x.min(chord.left()));
    (left, chords.iter().fold(f64::NEG_INFINITY, |x, chord| x.max(chord.right())))
}
