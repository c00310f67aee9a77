//! Piers of a bridge: courses of blocks, and a cap between the springings above them.

use crate::scenes::lookup::out_of_range;
use voussoir_core::model::crosses_itself;
use voussoir_core::model::geometry::{Vec2, area_and_centroid};
use voussoir_core::plugin::{Diagnostic, Keys};

/// Greatest number of courses.
pub(super) const MAX_COURSES: usize = 1000;

/// Foundation of a pier.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Keys)]
pub enum Footing {
    /// On fixed ground, with a joint like any other.
    Fixed,
    /// The lowest course belongs to the ground.
    Bonded,
}

/// A pier.
#[derive(Debug, Clone, PartialEq, Keys)]
pub struct Pier {
    /// height below the lower of the springings on it
    #[key(unit = "m", range = "> 0")]
    pub height: f64,
    /// at the springings: the distance of their intrados ends
    #[key(unit = "m", range = "> 0")]
    pub width: f64,
    /// at its foot
    #[key(unit = "m", range = "> 0", optional = "that at the springings")]
    pub base_width: Option<f64>,
    /// number of courses, equally high
    #[key(range = ">= 1, <= MAX_COURSES", default = 1)]
    pub courses: usize,
    /// fixed: it stands on fixed ground with a joint like any other; bonded: its lowest course is one with
    /// the ground
    #[key(default = "fixed")]
    pub footing: Footing,
    /// material of its blocks
    #[key(reference = "materials", optional = "that of the scene")]
    pub material: Option<String>,
}

/// A pier at its position.
#[derive(Debug, Clone)]
pub struct PierBlocks {
    /// Cap between the springing faces; `None` if these are level on the pier.
    pub cap: Option<Vec<Vec2>>,
    /// Courses from the top down.
    pub courses: Vec<Vec<Vec2>>,
    /// Upper ends (left, right) of each course, then of the ground.
    pub levels: Vec<[Vec2; 2]>,
    /// Free top of the cap or of the pier, from left to right.
    pub top: Option<[Vec2; 2]>,
}

impl Pier {
    /// Returns the mistakes in its numbers.
    pub fn mistakes(&self) -> Vec<Diagnostic> {
        let mut diagnostics = Vec::new();
        diagnostics.extend(out_of_range::<Self>("height", self.height));
        diagnostics.extend(out_of_range::<Self>("width", self.width));
        diagnostics.extend(self.base_width.and_then(|width| out_of_range::<Self>("base_width", width)));
        if !(1..=MAX_COURSES).contains(&self.courses) {
            let message = format!("{} must be from 1 to {MAX_COURSES}", self.courses);
            diagnostics.push(Diagnostic::new("courses", message));
        }
        diagnostics
    }

    /// Returns the blocks between the right springing of one span and the left springing of the next (intrados and extrados
    /// ends).
    pub fn blocks(
        &self,
        [left, outer_left]: [Vec2; 2],
        [right, outer_right]: [Vec2; 2],
    ) -> Result<PierBlocks, Diagnostic> {
        let base = left.y.min(right.y);
        let size = self.width + self.height;
        let (low_left, low_right) = (Vec2::new(left.x, base), Vec2::new(right.x, base));
        let mut cap = vec![low_left, low_right, right, outer_right, outer_left, left];
        cap.dedup_by(|a, b| (*a - *b).norm() <= 1e-12 * size);
        if cap.len() > 1 && (cap[0] - cap[cap.len() - 1]).norm() <= 1e-12 * size {
            cap.pop();
        }
        let area = if cap.len() > 2 { area_and_centroid(&cap).0 } else { 0.0 };
        let flat = area.abs() <= 1e-12 * size * size;
        if outer_left.x > outer_right.x + 1e-12 * size || area < 0.0 || (!flat && crosses_itself(&cap)) {
            let message = format!("{} m is too narrow: the springings of its two spans cross above it", self.width);
            return Err(Diagnostic::new("width", message));
        }
        let open = outer_right.x - outer_left.x > 1e-9 * size;
        let middle = (left.x + right.x) / 2.0;
        let foot = self.base_width.unwrap_or(self.width);
        let level = |i: usize| {
            let share = i as f64 / self.courses as f64;
            let half = (self.width + (foot - self.width) * share) / 2.0;
            let y = base - self.height * share;
            if i == 0 { [low_left, low_right] } else { [Vec2::new(middle - half, y), Vec2::new(middle + half, y)] }
        };
        let levels: Vec<_> = (0..=self.courses).map(level).collect();
        let courses = levels.windows(2).map(|pair| vec![pair[1][0], pair[1][1], pair[0][1], pair[0][0]]).collect();
        Ok(PierBlocks { cap: (!flat).then_some(cap), courses, levels, top: open.then_some([outer_left, outer_right]) })
    }
}
