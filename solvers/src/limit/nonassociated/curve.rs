//! The bracket as a function of the work: proved lower bounds and states found.

use voussoir_core::limit::{BracketPoint, BracketWork};

/// The points so far, in θ instead of factors.
#[derive(Debug, Clone, Default)]
pub struct Curve {
    points: Vec<BracketPoint>,
}

impl Curve {
    /// Records that after this work no state exists below `lower`.
    pub fn proved(&mut self, by: BracketWork, work: f64, lower: f64) {
        let (most, found) = self.present();
        self.add(BracketPoint { by, work, lower: most.max(lower), found });
    }

    /// Records a state found after this work.
    pub fn found(&mut self, by: BracketWork, work: f64, theta: f64) {
        let (lower, least) = self.present();
        self.add(BracketPoint { by, work, lower, found: Some(least.map_or(theta, |least| least.min(theta))) });
    }

    /// Records a state that is known without further work.
    pub fn known(&mut self, theta: f64) {
        let (by, work) = self.points.last().map_or((BracketWork::Local, 0.0), |point| (point.by, point.work));
        if self.present().1.is_none_or(|found| theta < found) {
            self.found(by, work, theta);
        }
    }

    fn present(&self) -> (f64, Option<f64>) {
        self.points.last().map_or((0.0, None), |point| (point.lower, point.found))
    }

    /// Adds a point. An interval without change keeps only its two ends.
    fn add(&mut self, point: BracketPoint) {
        let same = |other: &BracketPoint| (other.by, other.lower, other.found) == (point.by, point.lower, point.found);
        if self.points.len() > 1 && self.points[self.points.len() - 2..].iter().all(same) {
            self.points.pop();
        }
        self.points.push(point);
    }

    /// Returns the points as factors for a stage that starts at `start`, with the reported ends.
    pub fn factors(mut self, start: f64, unit: f64, [lower, found]: [f64; 2]) -> Vec<BracketPoint> {
        for point in &mut self.points {
            point.lower = (start + unit * point.lower).min(lower);
            point.found = point.found.map(|theta| (start + unit * theta).max(found));
        }
        self.points
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both ends only become narrower, and an interval without change keeps its two ends.
    #[test]
    fn a_bracket_only_closes() {
        let mut curve = Curve::default();
        curve.found(BracketWork::Local, 1.0, 0.5);
        curve.found(BracketWork::Local, 2.0, 0.4);
        [1.0, 2.0, 3.0].into_iter().for_each(|work| curve.proved(BracketWork::Search, work, 0.0));
        curve.proved(BracketWork::Splitting, 5.0, 0.3);
        curve.proved(BracketWork::Splitting, 9.0, 0.2);
        let points: Vec<_> = curve.factors(1.0, 10.0, [4.0, 5.0]).iter().map(|p| (p.work, p.lower, p.found)).collect();
        let expected =
            [(1.0, 1.0, 6.0), (2.0, 1.0, 5.0), (1.0, 1.0, 5.0), (3.0, 1.0, 5.0), (5.0, 4.0, 5.0), (9.0, 4.0, 5.0)];
        assert_eq!(points, expected.map(|(work, lower, found)| (work, lower, Some(found))));
    }
}
