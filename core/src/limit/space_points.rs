//! The points of a contact at which forces act, with the area that belongs to each.
//!
//! Tractions in a convex set T have the same resultants as forces at points of the contact, but which forces depends on T.
//!
//! - **T is a cone with its tip at a constant traction** (dry friction; cohesion with full tension): forces at the vertices,
//!   plus the tip's traction times the area. Barycentric weights move every traction to the vertices, so this is exact.
//! - **Otherwise** the contact is divided into triangles. One constant traction for each triangle acts at its centroid: these
//!   *inner* points reach only resultants of tractions in T. Barycentric weights move every traction of a triangle to its
//!   corners; the force of a corner is then one third of the area times a weighted mean of tractions, which is in T. So these
//!   *outer* points reach every resultant of tractions in T. If T has no bound in compression, forces in its cone of
//!   recession at the vertices are limits of tractions in T, and belong to the inner points with no area.
//!
//! The dissipation of a motion is at most its sum over the outer points, because dissipation is convex in the rate and the rate is
//! linear in the point.

use crate::law::FrictionCone;
use crate::model::space::Vec3;

/// Points with areas.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PointSet {
    /// Points relative to the pole of the problem \[m\].
    pub points: Vec<Vec3>,
    /// The area of each \[m²\].
    pub areas: Vec<f64>,
}

impl PointSet {
    fn push(&mut self, point: Vec3, area: f64) {
        self.points.push(point);
        self.areas.push(area);
    }
}

/// Returns the inner and the outer points of a convex contact with these vertices. Each side and each line from the middle
/// to a vertex has `parts` parts.
pub(super) fn point_sets(vertices: &[Vec3], law: &FrictionCone, parts: usize) -> [PointSet; 2] {
    if law.has_one_tip() {
        let exact = at_vertices(vertices);
        return [exact.clone(), exact];
    }
    let grid = Grid { vertices, middle: vertices.iter().sum::<Vec3>() / vertices.len() as f64, parts: parts.max(1) };
    let (mut inner, mut outer) = (PointSet::default(), grid.points());
    if law.compressive_strength.is_infinite() {
        vertices.iter().for_each(|vertex| inner.push(*vertex, 0.0));
    }
    for corners in grid.triangles() {
        let [a, b, c] = corners.map(|corner| outer.points[corner]);
        let area = area(&a, &b, &c);
        inner.push((a + b + c) / 3.0, area);
        corners.iter().for_each(|corner| outer.areas[*corner] += area / 3.0);
    }
    [inner, outer]
}

fn area(a: &Vec3, b: &Vec3, c: &Vec3) -> f64 {
    (b - a).cross(&(c - a)).norm() / 2.0
}

/// Returns the vertices; the areas have the area of the polygon as sum and its centroid as mean. They are means over the fans from all
/// vertices, so that they do not depend on the first one.
fn at_vertices(vertices: &[Vec3]) -> PointSet {
    let count = vertices.len();
    let mut set = PointSet { points: vertices.to_vec(), areas: vec![0.0; count] };
    for (first, side) in (0..count).flat_map(|first| (1..count.max(2) - 1).map(move |side| (first, side))) {
        let corners = [first, (first + side) % count, (first + side + 1) % count];
        let [a, b, c] = corners.map(|corner| vertices[corner]);
        let third = area(&a, &b, &c) / (3.0 * count as f64);
        corners.iter().for_each(|corner| set.areas[*corner] += third);
    }
    set
}

/// Triangles between rings of points about the middle of a polygon.
struct Grid<'a> {
    vertices: &'a [Vec3],
    middle: Vec3,
    parts: usize,
}

impl Grid<'_> {
    /// Returns the index of a point of a ring; ring 0 is the middle.
    fn index(&self, ring: usize, along: usize) -> usize {
        let sides = self.vertices.len();
        if ring == 0 { 0 } else { 1 + sides * ring * (ring - 1) / 2 + along % (sides * ring) }
    }

    /// Returns all points, without areas.
    fn points(&self) -> PointSet {
        let mut set = PointSet::default();
        set.push(self.middle, 0.0);
        let sides = self.vertices.len();
        for ring in 1..=self.parts {
            for side in 0..sides {
                let (a, b) = (self.vertices[side], self.vertices[(side + 1) % sides]);
                for step in 0..ring {
                    let on_side = a + (b - a) * (step as f64 / ring as f64);
                    set.push(self.middle + (on_side - self.middle) * (ring as f64 / self.parts as f64), 0.0);
                }
            }
        }
        set
    }

    /// Returns the corners of all triangles.
    fn triangles(&self) -> Vec<[usize; 3]> {
        let mut triangles = Vec::with_capacity(self.vertices.len() * self.parts * self.parts);
        for (ring, side) in (1..=self.parts).flat_map(|ring| (0..self.vertices.len()).map(move |side| (ring, side))) {
            let outside = |step: usize| self.index(ring, side * ring + step);
            let inside = |step: usize| self.index(ring - 1, side * (ring - 1) + step);
            triangles.extend((0..ring).map(|step| [outside(step), outside(step + 1), inside(step)]));
            triangles.extend((1..ring).map(|step| [outside(step), inside(step), inside(step - 1)]));
        }
        triangles
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITED: FrictionCone = FrictionCone {
        friction: 0.5,
        dilatancy: 0.5,
        cohesion: 1.0,
        tensile_strength: 0.1,
        compressive_strength: f64::INFINITY,
    };

    fn quadrilateral() -> Vec<Vec3> {
        [[0.0, 0.0], [3.0, 0.2], [2.5, 2.0], [-0.3, 1.4]].map(|[x, y]| Vec3::new(x, y, 0.7)).to_vec()
    }

    fn resultant(set: &PointSet) -> (f64, Vec3) {
        (set.areas.iter().sum(), set.points.iter().zip(&set.areas).map(|(point, area)| point * *area).sum())
    }

    /// The areas of vertices do not depend on the first vertex and on the sense.
    #[test]
    fn areas_of_vertices_do_not_depend_on_their_order() {
        let vertices = quadrilateral();
        let own = at_vertices(&vertices).areas;
        let turned: Vec<Vec3> = [2, 1, 0, 3].map(|k| vertices[k]).to_vec();
        for (area, vertex) in at_vertices(&turned).areas.iter().zip([2, 1, 0, 3]) {
            assert!((area - own[vertex]).abs() < 1e-14);
        }
    }

    /// All sets have the area and the first moment of the polygon, however fine they are.
    #[test]
    fn a_constant_traction_has_the_same_resultant() {
        let vertices = quadrilateral();
        let (area, moment) = resultant(&at_vertices(&vertices));
        assert!((area - 4.8).abs() < 1e-12, "{area}");
        for parts in [1, 2, 5] {
            for set in point_sets(&vertices, &LIMITED, parts) {
                let (own, first) = resultant(&set);
                assert!((own - area).abs() < 1e-12 && (first - moment).norm() < 1e-12, "{parts}");
            }
        }
    }

    /// The inner points have a smaller polar moment than the polygon, the outer points a greater one, and both converge with the
    /// square of the size: x² is convex, as dissipation is.
    #[test]
    fn the_sets_enclose_a_convex_integral() {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| Vec3::new(x, y, 0.0));
        let polar = |set: &PointSet| -> f64 {
            set.points.iter().zip(&set.areas).map(|(p, area)| area * p.norm_squared()).sum()
        };
        let errors = |parts| point_sets(&square, &LIMITED, parts).map(|set| polar(&set) - 2.0 / 3.0);
        let ([low, high], [lower, higher]) = (errors(4), errors(8));
        assert!(low < 0.0 && high > 0.0, "{low} {high}");
        assert!((low / lower - 4.0).abs() < 1e-9 && (high / higher - 4.0).abs() < 1e-9);
    }

    /// A cone with one tip needs its vertices only.
    #[test]
    fn a_cone_with_one_tip_acts_at_the_vertices() {
        let [inner, outer] = point_sets(&quadrilateral(), &FrictionCone::dry(0.5, 0.5), 7);
        assert_eq!((inner.points.len(), &inner), (4, &outer));
    }
}
