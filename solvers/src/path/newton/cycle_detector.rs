//! How far a path has gone after its peak, and whether it still leads on.
//!
//! Behind a peak with finite displacements the path of an assembly with friction may fold where a sliding
//! point lifts off: on both sides of that event equilibrium exists only on the side the path comes from
//! (the equations of a point that slides without dilating are not monotone). The path then goes back on a
//! neighbouring branch, folds again at the other end, and so on for ever. Two things end it: turning
//! points that repeat, and a length of way out of proportion to what was asked for.

/// Share of the range of displacements that a path must go back for a turn to count.
const TURN: f64 = 0.02;

/// Difference of two turns that are the same one, as a share of the ranges of displacement and factor.
const SAME: f64 = 0.01;

/// Difference of two folds that are the same one, as a share of the same ranges.
const FOLD: f64 = 0.005;

/// Turns in a row that repeat earlier ones.
const REPEATED: u32 = 2;

/// Way of the fastest body after the peak, by the displacement that was asked for and a fiftieth of the
/// scene.
const LONGEST: f64 = 8.0;

const SLACK: f64 = 0.02;

/// The way of a path after its peak.
#[derive(Debug, Clone, Default)]
pub(super) struct CycleDetector {
    /// Ranges of displacement \[m\] and factor so far.
    ranges: Option<[[f64; 2]; 2]>,
    /// Translations of all bodies at the last state \[m\].
    places: Vec<[f64; 2]>,
    /// Way of the fastest body \[m\].
    way: f64,
    /// Displacement and factor where the path went furthest in its present sense, and that sense.
    furthest: [f64; 2],
    sense: f64,
    /// Turns: displacement and factor, and the sense before.
    turns: Vec<([f64; 2], f64)>,
    repeated: u32,
    /// Places from which no rate goes on in the sense of the factor.
    folds: Vec<[f64; 2]>,
}

impl CycleDetector {
    /// Takes a place (displacement, factor) from which no rate goes on: whether the path has been there before.
    pub fn folds_again(&mut self, place: [f64; 2]) -> bool {
        let sizes = self.ranges.map_or([0.0; 2], |ranges| ranges.map(|r| r[1] - r[0]));
        let again = self.folds.iter().any(|fold| (0..2).all(|i| (fold[i] - place[i]).abs() <= FOLD * sizes[i]));
        self.folds.push(place);
        again
    }

    /// Takes a state after the peak: displacement of the load and factor, and the motion of all bodies. Why the
    /// path leads nowhere, if so; `asked`: displacement after the peak that it should reach, `length` the scene's \[m\].
    pub fn leads_nowhere(&mut self, place: [f64; 2], motion: &[[f64; 3]], asked: f64, length: f64) -> Option<String> {
        let places: Vec<[f64; 2]> = motion.iter().map(|q| [q[0], q[1]]).collect();
        let moved = places.iter().zip(&self.places).map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1]));
        self.way += moved.fold(0.0, f64::max);
        self.places = places;
        let Some(ranges) = &mut self.ranges else {
            self.ranges = Some([0, 1].map(|i| [place[i].min(0.0), place[i].max(0.0)]));
            self.furthest = place;
            return None;
        };
        for (range, x) in ranges.iter_mut().zip(place) {
            *range = [range[0].min(x), range[1].max(x)];
        }
        let size = ranges.map(|r| r[1] - r[0]);
        let gone = place[0] - self.furthest[0];
        if self.sense == 0.0 && gone != 0.0 {
            self.sense = gone.signum();
        }
        if gone * self.sense >= 0.0 {
            self.furthest = place;
        } else if gone.abs() > TURN * size[0] {
            let turn = (self.furthest, self.sense);
            let same = |(at, sense): &([f64; 2], f64)| {
                *sense == turn.1 && (0..2).all(|i| (at[i] - turn.0[i]).abs() <= SAME * size[i])
            };
            self.repeated = if self.turns.iter().any(same) { self.repeated + 1 } else { 0 };
            let before = self.turns.last().map_or(turn.0, |turn| turn.0);
            self.turns.push(turn);
            (self.furthest, self.sense) = (place, -self.sense);
            if self.repeated >= REPEATED {
                let [a, b] = [before[1], turn.0[1]];
                return Some(format!(
                    "after the peak the path cycles between the factors {a:.6} and {b:.6}, where it folds; other branches were not searched"
                ));
            }
        }
        (self.way > LONGEST * (asked + SLACK * length)).then(|| {
            format!(
                "after the peak blocks have moved {:.3} m along the path, back and forth, without bringing the load {asked:.3} m away from its place at the peak",
                self.way
            )
        })
    }
}

/// Distance from the greatest peak and difference of loads, as shares of what the path has gone and fallen since, at which
/// it has come back to it.
const RETURN: f64 = 0.01;

/// How far a path has been from its greatest peak since.
#[derive(Debug, Clone, Default)]
pub(super) struct Excursion {
    /// Greatest distance of a body from its place there \[m\].
    furthest: f64,
    /// Greatest fall of the factor.
    fallen: f64,
}

impl Excursion {
    /// Takes a state: greatest distance of a body \[m\] from the peak, and by how much the factor is below it.
    pub fn goes_to(&mut self, [distance, below]: [f64; 2]) {
        (self.furthest, self.fallen) = (self.furthest.max(distance), self.fallen.max(below));
    }

    /// Whether another peak, the same as seen from the first one, is that one again: with friction that dissipates a path
    /// may come back to its peak in a loop over other ones, a little beside itself each time.
    pub fn returns(&self, [distance, below]: [f64; 2]) -> bool {
        distance <= RETURN * self.furthest && below.abs() <= RETURN * self.fallen
    }
}

/// Greatest distance between the places of a body \[m\].
pub(super) fn distance(motion: &[[f64; 3]], other: &[[f64; 3]]) -> f64 {
    motion.iter().zip(other).map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1])).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Feeds a zigzag between displacements; the index of the state at which it ends.
    fn ended(corners: &[[f64; 2]], asked: f64) -> Option<(usize, String)> {
        let mut cycles = CycleDetector::default();
        let mut index = 0;
        for pair in corners.windows(2) {
            for step in 0..20 {
                let place = [0, 1].map(|i| pair[0][i] + (pair[1][i] - pair[0][i]) * f64::from(step) / 20.0);
                if let Some(why) = cycles.leads_nowhere(place, &[[place[0], 0.0, 0.0]], asked, 1.0) {
                    return Some((index, why));
                }
                index += 1;
            }
        }
        None
    }

    #[test]
    fn a_path_to_and_fro_ends_and_a_snap_back_does_not() {
        // Falls, snaps back twice at different places, and goes on.
        let on = [[1.0, 9.0], [1.5, 5.0], [1.2, 3.0], [1.6, 2.0], [1.3, 1.0], [3.0, 0.5]];
        assert_eq!(ended(&on, 3.0), None);
        let to_and_fro = [[1.0, 9.0], [2.0, 5.0], [1.2, 8.0], [2.0, 5.01], [1.2, 8.01], [2.0, 5.0], [1.2, 8.0]];
        let (index, why) = ended(&to_and_fro, 3.0).expect("an end");
        assert!((60..90).contains(&index) && why.contains("cycles between"), "{index} {why}");
        // Ever new places, but far too long a way.
        let drifting: Vec<[f64; 2]> = (0..40).map(|i| [1.0 + f64::from(i % 2), 9.0 - 0.3 * f64::from(i)]).collect();
        let (_, why) = ended(&drifting, 1.5).expect("an end");
        assert!(why.contains("along the path"), "{why}");
    }
    #[test]
    fn a_path_returns_to_its_peak_only_from_afar() {
        let mut excursion = Excursion::default();
        // A second peak close to the first one, with a small dip between.
        excursion.goes_to([1e-4, 0.1]);
        assert!(!excursion.returns([1e-4, -0.01]));
        excursion.goes_to([0.1, 70.0]);
        excursion.goes_to([0.01, 3.0]);
        assert!(excursion.returns([1e-4, -0.02]));
        // The same place under another load, and the same load at another place.
        assert!(!excursion.returns([1e-4, -0.8]) && !excursion.returns([2e-3, 0.02]));
    }
}
