//! `wall`: bricks in running bond on the ground.
#![doc = include_str!("wall.md")]

use super::keys::{PlaneState, SceneKeys};
use super::lookup::{from_root, law, material, out_of_range, pairs_of, take};
use super::mesh::{Mesh, density, mesh_diagnostics};
use voussoir_core::model::geometry::{Vec2, bounding_box};
use voussoir_core::model::{Assembly, Body, Bond, Catalogue, Gap, Scene, find_joints};
use voussoir_core::plugin::{Card, Diagnostic, Keys, PluginKind, Sample};

/// Bond of the courses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Keys)]
pub enum BondPattern {
    /// Staggered by half a brick.
    Running,
}

/// A rectangle without bricks.
#[derive(Debug, Clone, Copy, PartialEq, Keys)]
pub struct Opening {
    /// lower left corner
    #[key(names = ["x", "y"], unit = "m")]
    pub from: [f64; 2],
    /// upper right corner
    #[key(names = ["x", "y"], unit = "m")]
    pub to: [f64; 2],
}

/// A brick wall.
#[derive(Debug, Clone, PartialEq, Keys)]
#[keys(check = Wall::validate)]
pub struct Wall {
    /// Width out of plane \[m\].
    #[key(like = SceneKeys)]
    pub width: f64,
    /// Stress state of deformable bricks.
    #[key(like = SceneKeys, default)]
    pub plane: PlaneState,
    /// Material of the bricks.
    #[key(like = SceneKeys)]
    pub material: String,
    /// Law of all joints.
    #[key(like = SceneKeys)]
    pub joint: String,
    /// length and height of a brick
    #[key(names = ["length", "height"], unit = "m", range = "> 0")]
    pub brick: [f64; 2],
    /// how courses are staggered: running, by half a brick
    #[key(default = "running")]
    pub bond: BondPattern,
    /// number of courses
    #[key(range = ">= 1, <= MAX_BRICKS", optional = "rows is given")]
    pub courses: Option<usize>,
    /// whole bricks in an even course, counted from 0 at the bottom; odd ones begin and end with a half
    #[key(range = ">= 1, <= MAX_BRICKS", optional = "rows is given")]
    pub bricks: Option<usize>,
    /// from the bottom, widths in brick lengths from the left; a negative number is an opening
    #[key(unit = "-", len = ">= 1, <= MAX_BRICKS", optional = "courses and bricks are given")]
    pub rows: Option<Vec<Vec<f64>>>,
    /// rectangles cut out, between bed joints
    #[key(default = [])]
    pub openings: Vec<Opening>,
    /// x at which the ground is cut, ascending; its parts are supports "ground.0", "ground.1" and so on
    #[key(unit = "m", range = "> 0", len = "<= 100", default = [])]
    pub ground_cuts: Vec<f64>,
    /// Mesh of deformable bricks.
    #[key(like = SceneKeys)]
    pub mesh: Option<Mesh>,
}

const MAX_BRICKS: usize = 1000;
/// Cuts closer to a brick's side than this share of its length coincide with it.
const SNAP: f64 = 1e-6;

/// Sides of the bricks of a course, from the left \[m\].
type Course = Vec<[f64; 2]>;

impl Wall {
    /// Returns the widths in brick lengths, from the bottom; each mistake has a path from the scene's table.
    fn widths(&self, diagnostics: &mut Vec<Diagnostic>) -> Vec<Vec<f64>> {
        if let Some(rows) = &self.rows {
            for (key, given) in [("courses", self.courses), ("bricks", self.bricks)] {
                if given.is_some() {
                    diagnostics.push(Diagnostic::new(key, "given besides rows; give one of the two"));
                }
            }
            if rows.is_empty() {
                diagnostics.push(Diagnostic::new("rows", "there is no row"));
            }
            for (i, row) in rows.iter().enumerate() {
                if !row.iter().any(|&width| width > 0.0) {
                    diagnostics.push(Diagnostic::new(format!("rows.{i}"), "there is no brick in this row"));
                }
                for (j, width) in row.iter().enumerate().filter(|(_, w)| !w.is_finite() || w.abs() <= SNAP) {
                    let message = format!("{width} is no width: > 0 a brick, < 0 an opening");
                    diagnostics.push(Diagnostic::new(format!("rows.{i}.{j}"), message));
                }
            }
            return rows.clone();
        }
        for (key, given) in [("courses", self.courses), ("bricks", self.bricks)] {
            match given {
                None => diagnostics.push(Diagnostic::new(key, "is missing; give courses and bricks, or rows")),
                Some(count) if !(1..=MAX_BRICKS).contains(&count) => {
                    diagnostics.push(Diagnostic::new(key, format!("{count} must be from 1 to {MAX_BRICKS}")));
                }
                Some(_) => {}
            }
        }
        let (Some(courses), Some(bricks)) = (self.courses, self.bricks) else {
            return Vec::new();
        };
        if !diagnostics.is_empty() {
            return Vec::new();
        }
        let odd: Vec<_> = std::iter::once(0.5).chain(vec![1.0; bricks - 1]).chain([0.5]).collect();
        (0..courses).map(|course| if course % 2 == 0 { vec![1.0; bricks] } else { odd.clone() }).collect()
    }

    /// Returns the sides of the bricks, course by course from the bottom.
    fn courses(&self) -> Result<Vec<Course>, Vec<Diagnostic>> {
        let mut diagnostics = Vec::new();
        diagnostics.extend(out_of_range::<Self>("width", self.width));
        diagnostics.extend(mesh_diagnostics(self.mesh.as_ref()));
        for (i, &side) in self.brick.iter().enumerate() {
            diagnostics.extend(out_of_range::<Self>(&format!("brick.{i}"), side));
        }
        let widths = self.widths(&mut diagnostics);
        if !diagnostics.is_empty() {
            return Err(diagnostics);
        }
        let mut courses: Vec<_> = widths.iter().map(|row| course(row, self.brick[0])).collect();
        for (i, opening) in self.openings.iter().enumerate() {
            if let Err(mut wrong) = self.cut(&mut courses, opening, &format!("openings.{i}")) {
                diagnostics.append(&mut wrong);
            }
        }
        let end = right_end(&courses);
        for (i, cut) in self.ground_cuts.iter().enumerate() {
            let before = i.checked_sub(1).map_or(0.0, |before| self.ground_cuts[before]);
            if !(*cut > before && *cut < end) {
                let message = format!("{cut} m must lie between {before} m and the end of the wall at {end} m");
                diagnostics.push(Diagnostic::new(format!("ground_cuts.{i}"), message));
            }
        }
        if diagnostics.is_empty() && courses.iter().all(|course| course.is_empty()) {
            diagnostics.push(Diagnostic::new("openings", "no brick is left"));
        }
        if diagnostics.is_empty() { Ok(courses) } else { Err(diagnostics) }
    }

    fn cut(&self, courses: &mut [Course], opening: &Opening, path: &str) -> Result<(), Vec<Diagnostic>> {
        let ([left, bottom], [right, top]) = (opening.from, opening.to);
        if !(opening.from.iter().chain(&opening.to).all(|x| x.is_finite()) && left < right && bottom < top) {
            return Err(vec![Diagnostic::new(path, "from must be the lower left corner, to the upper right one")]);
        }
        let height = self.brick[1];
        let mut diagnostics = Vec::new();
        let mut bed = |key: &str, y: f64| {
            let number = (y / height).round();
            if (y / height - number).abs() > SNAP {
                let message = format!("y = {y} m lies between bed joints, which are {height} m apart");
                let near = format!("the nearest is y = {}", number * height);
                diagnostics.push(Diagnostic::new(format!("{path}.{key}.1"), message).help(near));
            }
            number.clamp(0.0, courses.len() as f64) as usize
        };
        let (first, last) = (bed("from", bottom), bed("to", top));
        if !diagnostics.is_empty() {
            return Err(diagnostics);
        }
        let snap = SNAP * self.brick[0];
        let mut any = false;
        for course in &mut courses[first..last] {
            let whole = std::mem::take(course);
            for [start, end] in whole {
                if end <= left + snap || start >= right - snap {
                    course.push([start, end]);
                    continue;
                }
                any = true;
                if start < left - snap {
                    course.push([start, left]);
                }
                if end > right + snap {
                    course.push([right, end]);
                }
            }
        }
        if any { Ok(()) } else { Err(vec![Diagnostic::new(path, "the opening cuts no brick")]) }
    }

    fn validate(&self) -> Vec<(String, String)> {
        self.courses().err().map(pairs_of).unwrap_or_default()
    }
}

/// Returns the sides of the bricks of a row. Widths are summed in brick lengths, in which halves are exact. Therefore sides
/// that are one above the other have the same coordinates.
fn course(row: &[f64], length: f64) -> Course {
    let mut sum = 0.0;
    let mut course = Vec::new();
    for &width in row {
        let start = sum;
        sum += width.abs();
        if width > 0.0 {
            course.push([start * length, sum * length]);
        }
    }
    course
}

/// Returns x of the right end of a wall \[m\].
fn right_end(courses: &[Course]) -> f64 {
    courses.iter().flatten().fold(0.0, |end: f64, brick| end.max(brick[1]))
}

fn rectangle(low: [f64; 2], high: [f64; 2]) -> Vec<Vec2> {
    vec![Vec2::new(low[0], low[1]), Vec2::new(high[0], low[1]), Vec2::new(high[0], high[1]), Vec2::new(low[0], high[1])]
}

#[typetag::serde(name = "wall")]
impl Scene for Wall {
    fn build(&self, catalogue: &Catalogue) -> Result<Assembly, Vec<Diagnostic>> {
        let mut diagnostics = Vec::new();
        let material = take(material(catalogue, &self.material, "material"), &mut diagnostics);
        let law = take(law(catalogue, &self.joint, "joint"), &mut diagnostics);
        let courses = self.courses().map_err(|mut wrong| diagnostics.append(&mut wrong)).ok();
        let (Some(material), Some(law), Some(courses)) = (material, law, courses) else {
            return Err(from_root(diagnostics));
        };
        let [length, height] = self.brick;
        let sides: Vec<f64> = std::iter::once(-length)
            .chain(self.ground_cuts.iter().copied())
            .chain([right_end(&courses) + length])
            .collect();
        let ground = |(i, side): (usize, &[f64])| Body {
            name: if self.ground_cuts.is_empty() { "ground".into() } else { format!("ground.{i}") },
            vertices: rectangle([side[0], -height], [side[1], 0.0]),
            material,
            fixed: true,
        };
        let mut bodies: Vec<Body> = sides.windows(2).enumerate().map(ground).collect();
        for (i, course) in courses.iter().enumerate() {
            let (low, high) = (i as f64 * height, (i + 1) as f64 * height);
            for (j, &[start, end]) in course.iter().enumerate() {
                let vertices = rectangle([start, low], [end, high]);
                bodies.push(Body { name: format!("{i}.{j}"), vertices, material, fixed: false });
            }
        }
        let (low, high) = bounding_box(bodies.iter().flat_map(|body| &body.vertices));
        let (joints, overlaps) = find_joints(&bodies, (high - low).norm(), |_, _| (Bond::Law(law), Gap::default()));
        debug_assert!(overlaps.is_empty(), "bricks of a wall overlap: {overlaps:?}");
        let (width, plane, mesh) = (self.width, self.plane.into(), density(self.mesh));
        Ok(Assembly { catalogue: catalogue.clone(), bodies, joints, width, plane, mesh, arch: None, bridge: None })
    }
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::Scene,
        tag: "wall",
        summary: "bricks in running bond on the ground, with openings",
        sources: &["Ferris & Tin-Loi 2001, Int. J. Mech. Sci. 43 (walls given by rows)"],
        samples: &[
            Sample::keys(r#"width = 1.0
brick = [0.4, 0.2]
courses = 4
bricks = 3
material = "stone"
joint = "dry""#),
            Sample::keys(r#"width = 1.0
brick = [0.4, 0.2]
rows = [[1, 1, 1], [0.5, 1, 1, 0.5]]
material = "brick"
joint = "mortar""#),
        ],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("wall.md"),
        ..Card::of::<Wall>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenes::test_catalogue::catalogue;
    use serde_json::{Value, json};

    fn wall(extra: Value) -> Result<Assembly, Vec<Diagnostic>> {
        let mut scene =
            json!({ "scene": "wall", "width": 1.0, "material": "stone", "joint": "dry", "brick": [0.4, 0.175] });
        for (key, value) in extra.as_object().unwrap() {
            scene[key] = value.clone();
        }
        serde_json::from_value::<Box<dyn Scene>>(scene).unwrap().build(&catalogue())
    }

    fn counts(extra: Value) -> (usize, usize) {
        let wall = wall(extra).unwrap();
        (wall.bodies.len() - 1, wall.joints.len())
    }

    #[test]
    fn the_walls_of_ferris_and_tin_loi_have_their_published_numbers_of_blocks_and_contacts() {
        let (a, b) = (json!([0.5, 1, 1, 1, 1, 0.5]), json!([1, 1, 1, 1, 1]));
        assert_eq!(counts(json!({ "rows": [a, b, a, b, a, b] })), (33, 83));
        let sequence = |fe: &Value, fu: &Value, we: &Value, wu: &Value| json!({ "rows": [fe, fu, fe, wu, we, wu, we, wu, fe, fu, fe] });
        let three = sequence(
            &json!([1, 1, 1, 1]),
            &json!([0.5, 1, 1, 1, 0.5]),
            &json!([1, 0.5, -1, 0.5, 1]),
            &json!([0.5, 1, -1, 1, 0.5]),
        );
        assert_eq!(counts(three), (46, 102));
        let four = sequence(&a, &b, &json!([0.5, 0.5, -1, 0.5, 0.5, -1, 0.5, 0.5]), &json!([1, -1, 1, -1, 1]));
        assert_eq!(counts(four), (55, 116));
    }

    #[test]
    fn courses_and_openings_give_the_wall_that_rows_give() {
        let (even, odd) = (json!([1, 1, 1, 1]), json!([0.5, 1, 1, 1, 0.5]));
        assert_eq!(counts(json!({ "courses": 3, "bricks": 4 })), counts(json!({ "rows": [even, odd, even] })));
        let by_rows = wall(json!({ "rows": [even, [0.5, 1, -1, 1, 0.5], [1, 0.5, -1, 0.5, 1], odd, even] })).unwrap();
        let opening = json!({ "from": [0.6, 0.175], "to": [1.0, 0.35] });
        let by_cutting = wall(
            json!({ "courses": 5, "bricks": 4, "openings": [opening, { "from": [0.6, 0.35], "to": [1.0, 0.525] }] }),
        )
        .unwrap();
        assert_eq!(by_rows.joints.len(), by_cutting.joints.len());
        for (one, other) in by_rows.bodies.iter().zip(&by_cutting.bodies) {
            assert_eq!(one.name, other.name);
            assert!(one.vertices.iter().zip(&other.vertices).all(|(a, b)| (a - b).norm() < 1e-12));
        }
    }

    /// A cut under the middle of a brick gives it two joints with the ground; there is no joint between the parts of the ground.
    #[test]
    fn a_wall_stands_on_several_grounds() {
        let whole = wall(json!({ "courses": 2, "bricks": 4 })).unwrap();
        let cut = wall(json!({ "courses": 2, "bricks": 4, "ground_cuts": [0.6, 0.8] })).unwrap();
        let grounds: Vec<&str> = cut.bodies.iter().filter(|b| b.fixed).map(|b| b.name.as_str()).collect();
        assert_eq!(grounds, ["ground.0", "ground.1", "ground.2"]);
        assert_eq!(cut.joints.len(), whole.joints.len() + 1);
        assert!(cut.joints.iter().all(|joint| !(cut.bodies[joint.minus].fixed && cut.bodies[joint.plus].fixed)));
    }

    #[test]
    fn mistakes_are_refused_at_their_key() {
        let path = |extra| wall(extra).unwrap_err()[0].path.clone();
        assert_eq!(path(json!({ "courses": 2 })), "scene.bricks");
        assert_eq!(path(json!({ "rows": [[1, 0.0]] })), "scene.rows.0.1");
        assert_eq!(path(json!({ "rows": [[-1]] })), "scene.rows.0");
        assert_eq!(path(json!({ "rows": [[1]], "courses": 1 })), "scene.courses");
        assert_eq!(path(json!({ "courses": 2, "bricks": 2, "brick": [0.4, 0.0] })), "scene.brick.1");
        assert_eq!(path(json!({ "courses": 2, "bricks": 2, "ground_cuts": [0.9] })), "scene.ground_cuts.0");
        assert_eq!(path(json!({ "courses": 2, "bricks": 2, "ground_cuts": [0.5, 0.3] })), "scene.ground_cuts.1");
        let cut = |from: [f64; 2], to: [f64; 2]| json!({ "courses": 4, "bricks": 4, "openings": [{ "from": from, "to": to }] });
        assert_eq!(path(cut([0.4, 0.1], [0.8, 0.35])), "scene.openings.0.from.1");
        assert_eq!(path(cut([0.4, 0.35], [0.8, 0.175])), "scene.openings.0");
        assert_eq!(path(cut([4.0, 0.0], [5.0, 0.175])), "scene.openings.0");
    }
}
