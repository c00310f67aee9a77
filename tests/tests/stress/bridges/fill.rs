//! Fill above and beside a chord, computed by clipping polygons and by fine sums instead of the formulas of the scene.

use super::bridge::{Bridge, Soil};

pub type Point = [f64; 2];

/// Returns the part of a polygon with `side` ≥ 0.
fn clip(polygon: &[Point], side: impl Fn(Point) -> f64) -> Vec<Point> {
    let mut out = Vec::new();
    for i in 0..polygon.len() {
        let (a, b) = (polygon[i], polygon[(i + 1) % polygon.len()]);
        let (da, db) = (side(a), side(b));
        if da >= 0.0 {
            out.push(a);
        }
        if (da > 0.0 && db < 0.0) || (da < 0.0 && db > 0.0) {
            let t = da / (da - db);
            out.push([a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t]);
        }
    }
    out
}

/// Returns the area, and the centroid times the area.
pub fn area_moment(polygon: &[Point]) -> [f64; 3] {
    let mut sums = [0.0; 3];
    for i in 0..polygon.len() {
        let (a, b) = (polygon[i], polygon[(i + 1) % polygon.len()]);
        let cross = a[0] * b[1] - b[0] * a[1];
        sums[0] += cross / 2.0;
        sums[1] += cross * (a[0] + b[0]) / 6.0;
        sums[2] += cross * (a[1] + b[1]) / 6.0;
    }
    if sums[0] < 0.0 { sums.map(|s| -s) } else { sums }
}

/// A horizontal force of the fill with its least and greatest value.
pub struct Reaction {
    pub point: Point,
    /// +1 to the right.
    pub sense: f64,
    pub bounds: [f64; 2],
}

impl Bridge {
    fn bottom_of(&self, soil: usize) -> f64 {
        if soil == 0 { f64::NEG_INFINITY } else { self.soils[soil - 1].to_level }
    }

    /// Returns the mass above a chord between two x, and its moment about x = 0.
    pub fn column(&self, [a, b]: [Point; 2], [low, high]: [f64; 2]) -> [f64; 2] {
        let road = |p: Point| [p[0], self.road_at(p[0])];
        let above = [a, b, road(b), road(a)];
        let above = clip(&clip(&above, |p| p[0] - low), |p| high - p[0]);
        let mut sums = [0.0; 2];
        for (i, soil) in self.soils.iter().enumerate() {
            let bottom = self.bottom_of(i).max(-1e3);
            let part = clip(&clip(&above, |p| p[1] - bottom), |p| soil.to_level.min(1e3) - p[1]);
            let [area, moment, _] = area_moment(&part);
            sums[0] += soil.density * area * self.width;
            sums[1] += soil.density * moment * self.width;
        }
        sums
    }

    /// Returns the vertical stress from the weight above a point \[Pa\].
    fn vertical_stress(&self, p: Point) -> f64 {
        let top = self.road_at(p[0]);
        let depth = |i: usize, soil: &Soil| (top.min(soil.to_level) - p[1].max(self.bottom_of(i))).max(0.0);
        self.soils.iter().enumerate().map(|(i, soil)| 9.81 * soil.density * depth(i, soil)).sum()
    }

    /// Returns the least and greatest pressure of one material.
    fn pressures(&self, soil: &Soil, stress: f64) -> [f64; 2] {
        if let Some(strength) = soil.backing {
            return [0.0, strength];
        }
        let Some([m_p, m_c]) = self.passive else { return [0.0; 2] };
        let sine = soil.friction_angle.to_radians().sin();
        let k = (1.0 + sine) / (1.0 - sine);
        let most = m_p * k * stress + m_c * 2.0 * k.sqrt() * soil.cohesion;
        let least = match self.lower {
            "active" => (stress / k - 2.0 * soil.cohesion / k.sqrt()).max(0.0),
            "at_rest" => (1.0 - sine) * stress,
            _ => 0.0,
        };
        [least.min(most), most]
    }

    /// Returns the force beside a chord, in pieces of one material, by Simpson's rule between the levels.
    pub fn reaction(&self, [a, b]: [Point; 2], [low, high]: [f64; 2]) -> Option<Reaction> {
        let (from, to) = ((low - a[0]) / (b[0] - a[0]), (high - a[0]) / (b[0] - a[0]));
        let (from, to) = (from.min(to).max(0.0), from.max(to).min(1.0));
        if from >= to || (b[1] - a[1]).abs() < 1e-12 {
            return None;
        }
        let at = |t: f64| [a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t];
        let mut cuts = vec![from, to];
        for soil in self.soils.iter().filter(|soil| soil.to_level.is_finite()) {
            let t = (soil.to_level - a[1]) / (b[1] - a[1]);
            cuts.extend((from < t && t < to).then_some(t));
            // The x at which the road itself crosses the level.
            let gap = |t: f64| self.road_at(at(t)[0]) - soil.to_level;
            let (g0, g1) = (gap(from), gap(to));
            cuts.extend((g0 * g1 < 0.0).then(|| from + (to - from) * g0 / (g0 - g1)));
        }
        cuts.sort_by(f64::total_cmp);
        let height = (b[1] - a[1]).abs();
        let (mut whole, mut moment) = (0.0, 0.0);
        let mut of_soil = vec![[0.0; 2]; self.soils.len()];
        for pair in cuts.windows(2) {
            let (t0, t1) = (pair[0], pair[1]);
            let stress = |t: f64| self.vertical_stress(at(t));
            let middle = (t0 + t1) / 2.0;
            let simpson = |f: &dyn Fn(f64) -> f64| (t1 - t0) * (f(t0) + 4.0 * f(middle) + f(t1)) / 6.0;
            let sum = simpson(&stress);
            whole += sum;
            moment += simpson(&|t| stress(t) * at(t)[1]);
            let soil = self.soils.iter().position(|soil| at(middle)[1] <= soil.to_level).unwrap_or(0);
            of_soil[soil][0] += t1 - t0;
            of_soil[soil][1] += sum;
        }
        let mut bounds = [0.0; 2];
        for (soil, [share, sum]) in self.soils.iter().zip(of_soil).filter(|(_, part)| part[0] > 0.0) {
            let pressures = self.pressures(soil, sum / share);
            (0..2).for_each(|i| bounds[i] += pressures[i] * share * height * self.width);
        }
        let y = moment / whole;
        let point = at((y - a[1]) / (b[1] - a[1]));
        Some(Reaction { point, sense: if b[1] > a[1] { 1.0 } else { -1.0 }, bounds })
    }

    /// Returns the spread of a load to each side above a point of the extrados.
    pub fn reach(&self, p: Point) -> f64 {
        if !self.spreads {
            return 0.0;
        }
        let top = self.road_at(p[0]);
        let part = |(i, soil): (usize, &Soil)| {
            (top.min(soil.to_level) - p[1].max(self.bottom_of(i))).max(0.0) * soil.spread.to_radians().tan()
        };
        self.soils.iter().enumerate().map(part).sum()
    }
}
