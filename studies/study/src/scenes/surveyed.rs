//! Surveyed faces of a ring, cut into voussoirs. Joints have equal distances along the intrados and are normal to it.

use voussoir_core::model::geometry::{Vec2, cross};
use voussoir_core::plugin::Diagnostic;

/// Ends of the joints on the intrados and on the extrados \[m\].
pub type JointEnds = [Vec<[f64; 2]>; 2];

/// A polyline with the length up to each of its points \[m\].
struct Polyline {
    points: Vec<Vec2>,
    lengths: Vec<f64>,
}

impl Polyline {
    fn new(points: &[[f64; 2]]) -> Polyline {
        let points: Vec<Vec2> = points.iter().map(|&point| Vec2::from(point)).collect();
        let mut lengths = vec![0.0];
        for pair in points.windows(2) {
            lengths.push(lengths[lengths.len() - 1] + (pair[1] - pair[0]).norm());
        }
        Polyline { points, lengths }
    }

    fn length(&self) -> f64 {
        self.lengths[self.lengths.len() - 1]
    }

    /// Returns the point at a length from the start; the ends beyond them.
    fn at(&self, s: f64) -> Vec2 {
        let i = self.lengths.partition_point(|&length| length <= s).clamp(1, self.points.len() - 1);
        let (from, to) = (self.lengths[i - 1], self.lengths[i]);
        let share = if to > from { ((s - from) / (to - from)).clamp(0.0, 1.0) } else { 0.0 };
        self.points[i - 1] + (self.points[i] - self.points[i - 1]) * share
    }

    /// Returns the first intersection with a ray.
    fn met_by(&self, from: Vec2, direction: Vec2) -> Option<Vec2> {
        let meets = |pair: &[Vec2]| {
            let along = pair[1] - pair[0];
            let determinant = cross(direction, along);
            let (t, share) =
                (cross(pair[0] - from, along) / determinant, cross(pair[0] - from, direction) / determinant);
            (t > 0.0 && (-1e-12..=1.0 + 1e-12).contains(&share)).then_some(t)
        };
        let nearest = self.points.windows(2).filter_map(meets).min_by(f64::total_cmp)?;
        Some(from + direction * nearest)
    }
}

/// Cuts a ring between two faces into voussoirs. The first and the last joint connect the ends of the faces. The direction of
/// the intrados at a joint is the direction of its chord over one voussoir, so that the scatter of single points has little
/// influence. Diagnostics have paths from the scene's table.
pub fn cut(intrados: &[[f64; 2]], extrados: &[[f64; 2]], voussoirs: usize) -> Result<JointEnds, Vec<Diagnostic>> {
    let mut diagnostics = Vec::new();
    for (key, points) in [("intrados", intrados), ("extrados", extrados)] {
        if points.len() < 2 {
            diagnostics.push(Diagnostic::new(format!("profile.{key}"), "at least two points: both springing faces"));
        }
        for (i, point) in points.iter().enumerate().filter(|(_, point)| !point.iter().all(|x| x.is_finite())) {
            diagnostics.push(Diagnostic::new(format!("profile.{key}.{i}"), format!("{point:?} is not finite")));
        }
    }
    if voussoirs == 0 {
        diagnostics.push(Diagnostic::new("voussoirs", "there must be at least one"));
    }
    if !diagnostics.is_empty() {
        return Err(diagnostics);
    }
    let (inner, outer) = (Polyline::new(intrados), Polyline::new(extrados));
    let step = inner.length() / voussoirs as f64;
    let mut ends: JointEnds = [vec![intrados[0]], vec![extrados[0]]];
    for k in 1..voussoirs {
        let s = step * k as f64;
        let (point, along) = (inner.at(s), inner.at(s + step / 2.0) - inner.at(s - step / 2.0));
        let upwards = Vec2::new(-along.y, along.x);
        match outer.met_by(point, upwards.normalize()) {
            Some(end) => {
                ends[0].push(point.into());
                ends[1].push(end.into());
            }
            None => {
                let message = format!(
                    "joint {k}, normal to the intrados at ({:.4}, {:.4}), does not meet the extrados",
                    point.x, point.y
                );
                diagnostics
                    .push(Diagnostic::new("profile.extrados", message).help("list both faces from left to right"));
            }
        }
    }
    ends[0].push(intrados[intrados.len() - 1]);
    ends[1].push(extrados[extrados.len() - 1]);
    if diagnostics.is_empty() { Ok(ends) } else { Err(diagnostics) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two arcs with points as in a survey, independent of the joints: cut into voussoirs they agree with the ring of the
    /// segmental profile, within the error of the chords.
    #[test]
    fn a_finely_surveyed_segmental_ring_is_that_ring() {
        let (span, rise, thickness, n) = (6.0_f64, 1.5, 0.4, 11);
        let radius = (span * span / 4.0 + rise * rise) / (2.0 * rise);
        let half = f64::atan2(span / 2.0, radius - rise);
        let at = |share: f64, r: f64| {
            let angle = half * (1.0 - 2.0 * share);
            [-r * angle.sin(), rise - radius + r * angle.cos()]
        };
        let arc =
            |r: f64, count: usize| -> Vec<[f64; 2]> { (0..=count).map(|i| at(i as f64 / count as f64, r)).collect() };
        let [intrados, extrados] = cut(&arc(radius, 1700), &arc(radius + thickness, 2300), n).unwrap();
        for k in 0..=n {
            for (point, r) in [(intrados[k], radius), (extrados[k], radius + thickness)] {
                let expected = at(k as f64 / n as f64, r);
                let off = (point[0] - expected[0]).hypot(point[1] - expected[1]);
                assert!(off < 2e-6, "{k}: {off}");
            }
        }
    }

    #[test]
    fn faces_that_do_not_face_each_other_are_refused() {
        let arc = [[0.0, 0.0], [1.0, 1.0], [2.0, 0.0]];
        let below = [[0.0, -1.0], [1.0, -1.0], [2.0, -1.0]];
        assert_eq!(cut(&arc, &below, 4).unwrap_err()[0].path, "profile.extrados");
        assert_eq!(cut(&arc[..1], &below, 4).unwrap_err()[0].path, "profile.intrados");
    }
}
