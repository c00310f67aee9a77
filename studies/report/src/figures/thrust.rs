//! Thrust lines and struts: joint resultants, and the corners that forces have inside blocks.

use voussoir_core::model::geometry::{Vec2, contains, cross};
use voussoir_core::model::{Assembly, Joint};
use voussoir_study::results::FieldEntry;
use voussoir_study::results::carried::JointEntry;

/// The resultant that a joint passes to its plus body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Resultant {
    /// Where it crosses the joint's line \[m\].
    pub point: Vec2,
    /// \[N\].
    pub force: Vec2,
}

/// The resultant of each joint; `None` where a joint carries nothing.
pub fn resultants(assembly: &Assembly, field: &[FieldEntry]) -> Vec<Option<Resultant>> {
    let mut sums = vec![(0.0, 0.0, Vec2::zeros()); assembly.joints.len()];
    for entry in field {
        if let Some((normal, shear, moment)) = sums.get_mut(entry.joint) {
            let [r_n, r_t] = entry.force;
            *normal += r_n;
            *shear += r_t;
            *moment += Vec2::from(entry.point) * r_n;
        }
    }
    let strongest = sums.iter().map(|(n, t, _)| n.hypot(*t)).fold(0.0, f64::max);
    let resultant = |joint: &Joint, (normal, shear, moment): (f64, f64, Vec2)| {
        if normal.abs() <= 1e-9 * strongest {
            return None;
        }
        let (n, t) = joint.frame();
        Some(Resultant { point: moment / normal, force: n * normal + t * shear })
    };
    assembly.joints.iter().zip(sums).map(|(joint, sum)| resultant(joint, sum)).collect()
}

/// Where two lines cross, each through a point along a direction; `None` if they hardly do.
fn crossing((p, a): (Vec2, Vec2), (q, b): (Vec2, Vec2)) -> Option<Vec2> {
    let (a, b) = (a.normalize(), b.normalize());
    let sine = cross(a, b);
    (sine.abs() > 1e-9).then(|| p + a * (cross(q - p, b) / sine))
}

/// The line along which force runs through an arch, in pieces: from joint to joint, with a corner
/// inside a voussoir where the forces of its two joints meet there. `points` holds where the force
/// crosses each joint, `forces` its direction where known.
pub fn thrust_pieces(assembly: &Assembly, points: &[Option<Vec2>], forces: &[Option<Resultant>]) -> Vec<Vec<Vec2>> {
    let mut pieces: Vec<Vec<Vec2>> = vec![Vec::new()];
    for (k, point) in points.iter().enumerate() {
        let piece = pieces.last_mut().expect("there is always a piece");
        let across = assembly.arch.as_ref().is_none_or(|arch| arch.crosses_ring(k));
        let Some(point) = point.as_ref().filter(|_| across) else {
            if !piece.is_empty() {
                pieces.push(Vec::new());
            }
            continue;
        };
        if let (Some(&last), Some(joint)) = (piece.last(), assembly.joints.get(k)) {
            let force = |joint: usize| forces.get(joint).copied().flatten().map(|r| r.force);
            let corner = force(k - 1).zip(force(k)).and_then(|(a, b)| crossing((last, a), (*point, b)));
            let block = &assembly.bodies[joint.minus].vertices;
            // Only joints keep the line inside the masonry: under a load its corner may lie above.
            piece.extend(corner.filter(|&c| block.len() > 2 && contains(block, c, joint.height() / 2.0)));
        }
        piece.push(*point);
    }
    pieces.retain(|piece| piece.len() > 1);
    pieces
}

/// The zone of thrust of an arch: for each block between two joints whose zones are known the quadrilateral between them.
pub fn zone_parts(assembly: &Assembly, joints: &[JointEntry]) -> Vec<[Vec2; 4]> {
    let mut ends: Vec<Option<[Vec2; 2]>> = vec![None; assembly.joints.len()];
    for entry in joints {
        if let (Some(zone), Some(joint)) = (entry.zone, assembly.joints.get(entry.joint)) {
            ends[entry.joint] = Some(zone.map(|e| joint.middle() + joint.frame().1 * e));
        }
    }
    let pairs = assembly.joints.windows(2).zip(ends.windows(2));
    let part = |(joints, ends): (&[Joint], &[Option<[Vec2; 2]>])| {
        let ([a, b], [c, d]) = ends[0].zip(ends[1])?;
        (joints[0].plus == joints[1].minus).then_some([a, b, d, c])
    };
    pairs.filter_map(part).collect()
}

/// Lines that join the resultants of a strut through the blocks of any assembly: two joints of a
/// block directly, more than two through its centroid, one with the load on that block.
pub fn strut_lines(assembly: &Assembly, ray: &[Option<Resultant>], loads: &[(usize, Vec2)]) -> Vec<[Vec2; 2]> {
    let mut at: Vec<Vec<Vec2>> = vec![Vec::new(); assembly.bodies.len()];
    for (joint, resultant) in assembly.joints.iter().zip(ray) {
        if let Some(resultant) = resultant {
            at[joint.minus].push(resultant.point);
            at[joint.plus].push(resultant.point);
        }
    }
    let count = at.len();
    for &(body, point) in loads.iter().filter(|(body, _)| *body < count) {
        at[body].push(point);
    }
    let mut lines = Vec::new();
    for (body, points) in at.iter().enumerate().filter(|(body, _)| !assembly.bodies[*body].fixed) {
        match points.as_slice() {
            [] | [_] => {}
            [a, b] => lines.push([*a, *b]),
            many => {
                let centroid = assembly.inertia(body).centroid;
                lines.extend(many.iter().map(|&point| [point, centroid]));
            }
        }
    }
    lines
}
