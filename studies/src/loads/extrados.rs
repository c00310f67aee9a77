//! The extrados of an arch, on which loads stand.
//!
//! On arches `span_fraction` f counts along the intrados span from the left springing, and a load
//! acts on the straight extrados chord above (or below) that x; where a vertical meets two chords,
//! on the upper one. A force on the boundary of two voussoirs goes to the one nearer to midspan,
//! and exactly at midspan half to each, so that mirrored loads load mirrored blocks.

use super::site::LoadSite;
use voussoir_core::model::geometry::Vec2;
use voussoir_core::model::{ArchLayout, Assembly, CONTACT_TOLERANCE, PointForce};
use voussoir_core::plugin::Diagnostic;

/// Share of the scene's size within which a load is at a vertex.
const ROUNDING: f64 = 1e-12;

/// The straight extrados of a voussoir.
#[derive(Clone, Copy)]
struct Chord {
    body: usize,
    ends: [Vec2; 2],
}

impl Chord {
    fn left(&self) -> f64 {
        self.ends[0].x.min(self.ends[1].x)
    }

    fn right(&self) -> f64 {
        self.ends[0].x.max(self.ends[1].x)
    }

    /// Its point at x, or the nearest one; of an upright chord the upper end.
    fn at(&self, x: f64) -> Vec2 {
        let [a, b] = self.ends;
        // An end is returned as it is, so that a load at a vertex acts at that vertex.
        if a.x == b.x {
            return if a.y > b.y { a } else { b };
        }
        let share = (x - a.x) / (b.x - a.x);
        if share <= 0.0 {
            a
        } else if share >= 1.0 {
            b
        } else {
            Vec2::new(x, a.y + share * (b.y - a.y))
        }
    }
}

fn arch<'a>(site: &'a LoadSite, key: &str) -> Result<&'a ArchLayout, Vec<Diagnostic>> {
    site.assembly.arch.as_ref().ok_or_else(|| {
        let message = "counts along the span of an arch, but this scene is not one";
        vec![Diagnostic::new(site.key(key), message).help("give block and point, or block and edge")]
    })
}

/// x of a span fraction, between the intrados ends of the first and last joint.
pub fn x_at(site: &LoadSite, fraction: f64, key: &str) -> Result<f64, Vec<Diagnostic>> {
    let arch = arch(site, key)?;
    site.finite(&[(key, &[fraction])])?;
    let left = site.assembly.joints[0].ends[0].x;
    Ok(left + fraction * arch.span)
}

fn chords(assembly: &Assembly, arch: &ArchLayout) -> Vec<Chord> {
    let chord =
        |k: usize| Chord { body: arch.first + k, ends: [assembly.joints[k].ends[1], assembly.joints[k + 1].ends[1]] };
    (0..arch.voussoirs).map(chord).collect()
}

/// A force at x: on the upper chord, at the boundary of two on the one nearer to midspan, at midspan half on each.
pub fn on_extrados(site: &LoadSite, x: f64, force: Vec2, key: &str) -> Result<Vec<PointForce>, Vec<Diagnostic>> {
    let arch = arch(site, key)?;
    let tolerance = ROUNDING * site.assembly.size();
    let chords = chords(site.assembly, arch);
    let here: Vec<_> = chords
        .iter()
        .enumerate()
        .filter(|(_, chord)| chord.left() - tolerance <= x && x <= chord.right() + tolerance)
        .map(|(k, chord)| (k, chord.body, chord.at(x)))
        .collect();
    let Some(top) = here.iter().map(|(_, _, point)| point.y).max_by(f64::total_cmp) else {
        let (left, right) = extent(&chords);
        let message = format!("x = {x} m hits no block: the extrados reaches from {left} to {right} m");
        return site.fail(key, message);
    };
    let from_middle = |k: usize| (2 * k + 1).abs_diff(arch.voussoirs);
    // Chords that meet at x have their common vertex there, to within the tolerance and its slope.
    let near = |point: &Vec2| here.iter().any(|(_, _, p)| p.y == top && (point - p).norm() <= 4.0 * tolerance);
    let upper: Vec<_> = here.iter().filter(|(_, _, point)| point.y == top || near(point)).collect();
    let nearest = upper.iter().map(|&&(k, _, _)| from_middle(k)).min().unwrap_or(0);
    let chosen: Vec<_> = upper.into_iter().filter(|&&(k, _, _)| from_middle(k) == nearest).collect();
    let share = force / chosen.len() as f64;
    chosen
        .into_iter()
        .map(|&(_, body, point)| Ok(PointForce { body: site.movable(body, key)?, point, force: share }))
        .collect()
}

/// Forces of an even load per plan length \[N/m\] between two x; each voussoir gets one force at the middle of what
/// it carries, or the points of a rule. `keys` name the ends in what is wrong.
pub fn on_patch(
    site: &LoadSite,
    [start, end]: [f64; 2],
    density: Vec2,
    keys: [&str; 2],
) -> Result<Vec<PointForce>, Vec<Diagnostic>> {
    let chords = chords(site.assembly, arch(site, keys[0])?);
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

/// The upper chords between two x, each with the part of it that lies there.
fn carried(chords: &[Chord], [start, end]: [f64; 2], rounding: f64) -> Vec<(Chord, f64, f64)> {
    let mut cuts: Vec<f64> = chords.iter().flat_map(|chord| chord.ends.map(|p| p.x)).collect();
    // An end that is a vertex but for rounding is that vertex: no sliver on the next voussoir.
    let vertex = |x: f64| cuts.iter().copied().find(|cut| (cut - x).abs() <= rounding).unwrap_or(x);
    let (start, end) = (vertex(start), vertex(end));
    cuts.extend([start, end]);
    cuts.retain(|&x| start <= x && x <= end);
    cuts.sort_by(f64::total_cmp);
    // Between two cuts one chord is the upper one all along. Its parts are joined again, so that
    // each voussoir gets one force at the middle of what it carries.
    let mut parts: Vec<(Chord, f64, f64)> = Vec::new();
    for pair in cuts.windows(2).filter(|pair| pair[0] < pair[1]) {
        let middle = (pair[0] + pair[1]) / 2.0;
        let above = chords.iter().filter(|chord| chord.left() <= middle && middle <= chord.right());
        let Some(&top) = above.max_by(|a, b| a.at(middle).y.total_cmp(&b.at(middle).y)) else {
            continue;
        };
        match parts.last_mut() {
            Some((chord, _, high)) if chord.body == top.body && *high == pair[0] => *high = pair[1],
            _ => parts.push((top, pair[0], pair[1])),
        }
    }
    parts
}

/// Least and greatest x of the extrados.
fn extent(chords: &[Chord]) -> (f64, f64) {
    let left = chords.iter().fold(f64::INFINITY, |x, chord| x.min(chord.left()));
    (left, chords.iter().fold(f64::NEG_INFINITY, |x, chord| x.max(chord.right())))
}
