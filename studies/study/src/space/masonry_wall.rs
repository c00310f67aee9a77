//! `masonry_wall`: a wall of one or more leaves, or two walls that meet in a corner.
#![doc = include_str!("masonry_wall.md")]

use super::parts::Parts;
use crate::scenes::keys::SceneKeys;
use crate::scenes::lookup::{out_of_range, outside, pairs_of};
use voussoir_core::model::{Assembly, Catalogue, Scene};
use voussoir_core::plugin::{Card, Diagnostic, Keys, PluginKind, Range, Sample};
use voussoir_core::space::{Polyhedron, SpaceAssembly, Vec3};

/// Joint of two walls in a corner.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Keys)]
pub enum CornerJoint {
    /// Walls run through in turns, course by course.
    Toothed,
    /// The first wall runs through in all courses.
    Straight,
}

/// A second wall, along y.
#[derive(Debug, Clone, Copy, PartialEq, Keys)]
pub struct Corner {
    /// whole blocks of the second wall behind the corner
    #[key(range = ">= 1, <= MAX_BLOCKS")]
    pub blocks: usize,
    /// toothed: the walls run through in turns; straight: the first wall runs through in all courses
    #[key(default = "toothed")]
    pub joint: CornerJoint,
}

/// The wall of an opening.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Keys)]
pub enum Wing {
    /// Along x.
    X,
    /// Along y.
    Y,
}

/// A rectangle without blocks, through the whole thickness of a wall.
#[derive(Debug, Clone, Copy, PartialEq, Keys)]
pub struct WallOpening {
    /// lower corner nearer to the start of the wall: distance along the wall, height
    #[key(names = ["along", "z"], unit = "m")]
    pub from: [f64; 2],
    /// upper corner at the other side
    #[key(names = ["along", "z"], unit = "m")]
    pub to: [f64; 2],
    /// the wall along x, or the second wall along y
    #[key(default = "x")]
    pub wall: Wing,
}

/// Ends of walls with a support.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Keys)]
pub enum SideSupports {
    /// No end.
    None,
    /// The end at x = 0; not with a corner.
    Start,
    /// The far ends of all walls.
    End,
    /// All ends.
    Both,
}

/// A wall in running bond, of leaves that headers can join.
#[derive(Debug, Clone, PartialEq, Keys)]
#[keys(check = MasonryWall::validate)]
pub struct MasonryWall {
    /// length of a block along the wall, thickness of a leaf, height of a course
    #[key(names = ["length", "thickness", "height"], unit = "m", range = "> 0")]
    pub block: [f64; 3],
    /// number of courses
    #[key(range = ">= 1, <= MAX_BLOCKS")]
    pub courses: usize,
    /// whole blocks of an even course, counted from 0 at the bottom; with a corner, the whole blocks behind it
    #[key(range = ">= 1, <= MAX_BLOCKS")]
    pub blocks: usize,
    /// number of leaves side by side; the wall is as thick as all of them
    #[key(range = ">= 1, <= MAX_LEAVES", default = 1)]
    pub leaves: usize,
    /// every n-th course, counted from the bottom, is of headers: blocks of half the length through all leaves
    #[key(range = ">= 1, <= MAX_BLOCKS", optional = "no headers: the leaves only touch")]
    pub header_every: Option<usize>,
    /// a second wall along y that meets the first at x = 0
    #[key(optional = "a single wall")]
    pub corner: Option<Corner>,
    /// rectangles cut out, between bed joints
    #[key(default = [])]
    pub openings: Vec<WallOpening>,
    /// ends with a fixed pier: none, start, end or both; with a corner the walls have no start
    #[key(default = "none")]
    pub side_supports: SideSupports,
    /// Material of the blocks.
    #[key(like = SceneKeys)]
    pub material: String,
    /// Interface law of the joints.
    #[key(like = SceneKeys)]
    pub joint: String,
}

const MAX_BLOCKS: usize = 1000;
const MAX_LEAVES: usize = 20;
/// Cuts closer to a block's side than this share of its length coincide with it.
const SNAP: f64 = 1e-6;

/// Sides of the blocks of a course, in order along the wall \[m\].
type Course = Vec<[f64; 2]>;

/// The courses of a wall from the bottom.
struct WallCourses {
    wing: Wing,
    courses: Vec<Course>,
}

/// Adds blocks of given lengths from a start \[m\].
fn row(start: f64, lengths: impl IntoIterator<Item = f64>) -> Course {
    let mut from = start;
    let next = |length: f64| {
        let side = [from, from + length];
        from += length;
        side
    };
    lengths.into_iter().map(next).collect()
}

/// Returns whole blocks, or a half at both ends.
fn running(start: f64, length: f64, blocks: usize, halves: bool) -> Course {
    let side = |k: usize| {
        // Sides are multiples of half a block, so that sides above each other have the same coordinates.
        let twice = if halves { (2 * k).saturating_sub(1).min(2 * blocks) } else { 2 * k };
        start + twice as f64 * 0.5 * length
    };
    (0..blocks + usize::from(halves)).map(|k| [side(k), side(k + 1)]).collect()
}

/// Returns headers of half a block's length between two distances, with a quarter at the start: in a single
/// wall no head joint of headers is above one of whole and half blocks \[m\].
fn headers([start, end]: [f64; 2], length: f64) -> Course {
    let quarters = |k: usize| start + (2 * k + 1) as f64 * 0.25 * length;
    // A last header shorter than an eighth of a block is part of its neighbour.
    let inner = (0..).map(quarters).take_while(|cut| *cut < end - 0.125 * length);
    let cuts: Vec<f64> = [start].into_iter().chain(inner).chain([end]).collect();
    cuts.windows(2).map(|pair| [pair[0], pair[1]]).collect()
}

impl MasonryWall {
    /// Returns the thickness of all leaves \[m\].
    fn thickness(&self) -> f64 {
        self.leaves as f64 * self.block[1]
    }

    /// Returns true if a course is of headers.
    fn is_header(&self, course: usize) -> bool {
        self.leaves > 1 && self.header_every.is_some_and(|every| (course + 1).is_multiple_of(every))
    }

    /// Returns a course of stretchers, or of headers in its place.
    fn bonded(&self, course: usize, stretchers: Course) -> Course {
        match (self.is_header(course), stretchers.first(), stretchers.last()) {
            (true, Some([start, _]), Some([_, end])) => headers([*start, *end], self.block[0]),
            _ => stretchers,
        }
    }

    /// Returns the walls, or all mistakes with paths from the scene's table.
    fn walls(&self) -> Result<Vec<WallCourses>, Vec<Diagnostic>> {
        let mut diagnostics = Vec::new();
        let sides = self.block.iter().enumerate();
        diagnostics.extend(sides.filter_map(|(i, side)| out_of_range::<Self>(&format!("block.{i}"), *side)));
        let corner = self.corner.map(|corner| ("corner.blocks", corner.blocks));
        let every = self.header_every.map(|every| ("header_every", every));
        let counts = [("courses", self.courses), ("blocks", self.blocks)].into_iter().chain(corner).chain(every);
        let range = Range::new(1.0, false, MAX_BLOCKS as f64, false);
        diagnostics.extend(counts.filter_map(|(key, count)| outside(range, key, count as f64)));
        diagnostics.extend(outside(Range::new(1.0, false, MAX_LEAVES as f64, false), "leaves", self.leaves as f64));
        if self.leaves == 1 && self.header_every.is_some() {
            let wrong = Diagnostic::new("header_every", "headers join leaves, but the wall has one leaf");
            diagnostics.push(wrong.help("give leaves ≥ 2, or remove header_every"));
        }
        let start = matches!(self.side_supports, SideSupports::Start | SideSupports::Both);
        if start && self.corner.is_some() {
            let wrong = Diagnostic::new("side_supports", "walls that meet in a corner have no start");
            diagnostics.push(wrong.help("\"end\" supports the far ends of both walls"));
        }
        if !diagnostics.is_empty() {
            return Err(diagnostics);
        }
        let mut walls = match self.corner {
            None => vec![self.single()],
            Some(corner) => self.corner_walls(corner),
        };
        for (i, opening) in self.openings.iter().enumerate() {
            diagnostics.extend(self.cut(&mut walls, opening, &format!("openings.{i}")).err().into_iter().flatten());
        }
        if diagnostics.is_empty() && walls.iter().all(|wall| wall.courses.iter().all(Vec::is_empty)) {
            diagnostics.push(Diagnostic::new("openings", "no block is left"));
        }
        if diagnostics.is_empty() { Ok(walls) } else { Err(diagnostics) }
    }

    fn single(&self) -> WallCourses {
        let stretchers = |course: usize| running(0.0, self.block[0], self.blocks, course % 2 == 1);
        let course = |course: usize| self.bonded(course, stretchers(course));
        WallCourses { wing: Wing::X, courses: (0..self.courses).map(course).collect() }
    }

    /// Returns the wall along x and the wall along y.
    fn corner_walls(&self, corner: Corner) -> Vec<WallCourses> {
        let (length, thickness) = (self.block[0], self.thickness());
        let (along_x, along_y) = ([self.blocks, 0], [corner.blocks, 1]);
        // A wall that runs through begins at the outer corner with whole blocks, and ends with a block as long as the
        // walls are thick. The other begins behind it.
        let through = |blocks: usize| row(0.0, (0..blocks).map(|_| length).chain([thickness]));
        let behind = |blocks: usize| row(thickness, (0..blocks).map(|_| length));
        let shifted = |blocks: usize| row(0.0, [thickness].into_iter().chain((0..blocks).map(|_| length)));
        let course = |[blocks, wall]: [usize; 2], course: usize| match (corner.joint, wall) {
            (CornerJoint::Toothed, _) if course % 2 == wall => through(blocks),
            (CornerJoint::Toothed, _) => behind(blocks),
            (CornerJoint::Straight, 0) if course.is_multiple_of(2) => through(blocks),
            (CornerJoint::Straight, 0) => shifted(blocks),
            (CornerJoint::Straight, _) => running(thickness, length, blocks, course % 2 == 1),
        };
        let bonded = |which, k| self.bonded(k, course(which, k));
        let wall = |wing, which| WallCourses { wing, courses: (0..self.courses).map(|k| bonded(which, k)).collect() };
        vec![wall(Wing::X, along_x), wall(Wing::Y, along_y)]
    }

    fn cut(&self, walls: &mut [WallCourses], opening: &WallOpening, path: &str) -> Result<(), Vec<Diagnostic>> {
        let ([left, bottom], [right, top]) = (opening.from, opening.to);
        if !(opening.from.iter().chain(&opening.to).all(|x| x.is_finite()) && left < right && bottom < top) {
            let message = "from must be the lower corner nearer to the start, to the upper corner at the other side";
            return Err(vec![Diagnostic::new(path, message)]);
        }
        let Some(wall) = walls.iter_mut().find(|wall| wall.wing == opening.wall) else {
            return Err(vec![Diagnostic::new(format!("{path}.wall"), "there is no second wall: corner is not given")]);
        };
        let height = self.block[2];
        let mut diagnostics = Vec::new();
        let mut bed = |key: &str, z: f64| {
            let number = (z / height).round();
            if (z / height - number).abs() > SNAP {
                let message = format!("z = {z} m lies between bed joints, which are {height} m apart");
                let near = format!("the nearest is z = {}", number * height);
                diagnostics.push(Diagnostic::new(format!("{path}.{key}.1"), message).help(near));
            }
            number.clamp(0.0, self.courses as f64) as usize
        };
        let (first, last) = (bed("from", bottom), bed("to", top));
        if !diagnostics.is_empty() {
            return Err(diagnostics);
        }
        let snap = SNAP * self.block[0];
        let cut: Vec<bool> =
            wall.courses[first..last].iter_mut().map(|course| cut_course(course, [left, right], snap)).collect();
        if cut.contains(&true) { Ok(()) } else { Err(vec![Diagnostic::new(path, "the opening cuts no block")]) }
    }

    fn validate(&self) -> Vec<(String, String)> {
        self.walls().err().map(pairs_of).unwrap_or_default()
    }

    /// Returns the lengths of the walls along x and along y; a single wall is as long as it is thick along y \[m\].
    fn extent(&self) -> [f64; 2] {
        let (length, thickness) = (self.block[0], self.thickness());
        let long = |blocks: usize| blocks as f64 * length;
        match self.corner {
            None => [long(self.blocks), thickness],
            Some(corner) => [long(self.blocks) + thickness, long(corner.blocks) + thickness],
        }
    }

    fn assemble(&self, parts: &mut Parts, walls: &[WallCourses]) {
        let [length, _, height] = self.block;
        let [x, y] = self.extent();
        let ground = [Vec3::new(-length, -length, -height), Vec3::new(x + length, y + length, 0.0)];
        parts.body("ground", Polyhedron::cuboid(&ground[0], &ground[1]), true);
        self.add_piers(parts);
        for wall in walls {
            for (i, course) in wall.courses.iter().enumerate() {
                course.iter().enumerate().for_each(|(j, side)| self.add_block(parts, wall.wing, [i, j], *side));
            }
        }
        parts.find_contacts();
    }

    /// Adds block j of course i: a header through all leaves, or a block of each leaf.
    fn add_block(&self, parts: &mut Parts, wing: Wing, [i, j]: [usize; 2], side: [f64; 2]) {
        let name = match (self.corner, wing) {
            (None, _) => format!("{i}.{j}"),
            (_, Wing::X) => format!("x.{i}.{j}"),
            (_, Wing::Y) => format!("y.{i}.{j}"),
        };
        if self.leaves == 1 || self.is_header(i) {
            let [low, high] = self.corners(wing, side, [0, self.leaves], [i, i + 1]);
            parts.body(name, Polyhedron::cuboid(&low, &high), false);
            return;
        }
        for leaf in 0..self.leaves {
            let [low, high] = self.corners(wing, side, [leaf, leaf + 1], [i, i + 1]);
            parts.body(format!("{name}.{leaf}"), Polyhedron::cuboid(&low, &high), false);
        }
    }

    /// Returns two corners of a block between two distances along its wall, two faces of leaves and two bed joints \[m\].
    fn corners(&self, wing: Wing, [start, end]: [f64; 2], leaves: [usize; 2], beds: [usize; 2]) -> [Vec3; 2] {
        let [_, thickness, height] = self.block;
        let [front, back] = leaves.map(|face| face as f64 * thickness);
        let [low, high] = beds.map(|bed| bed as f64 * height);
        match wing {
            Wing::X => [Vec3::new(start, front, low), Vec3::new(end, back, high)],
            Wing::Y => [Vec3::new(front, start, low), Vec3::new(back, end, high)],
        }
    }

    /// Adds a pier as thick as the wall at each supported end.
    fn add_piers(&self, parts: &mut Parts) {
        let ([x, y], thickness) = (self.extent(), self.thickness());
        let beds = [0, self.courses];
        let mut pier = |name: &str, wing, side| {
            let [low, high] = self.corners(wing, side, [0, self.leaves], beds);
            parts.body(name, Polyhedron::cuboid(&low, &high), true);
        };
        if matches!(self.side_supports, SideSupports::Start | SideSupports::Both) {
            pier("start", Wing::X, [-thickness, 0.0]);
        }
        if matches!(self.side_supports, SideSupports::End | SideSupports::Both) {
            let single = self.corner.is_none();
            pier(if single { "end" } else { "end.x" }, Wing::X, [x, x + thickness]);
            if !single {
                pier("end.y", Wing::Y, [y, y + thickness]);
            }
        }
    }
}

/// Cuts the part between two distances out of a course; returns true if a block was cut.
fn cut_course(course: &mut Course, [left, right]: [f64; 2], snap: f64) -> bool {
    let mut cut = false;
    for [start, end] in std::mem::take(course) {
        if end <= left + snap || start >= right - snap {
            course.push([start, end]);
            continue;
        }
        cut = true;
        if start < left - snap {
            course.push([start, left]);
        }
        if end > right + snap {
            course.push([right, end]);
        }
    }
    cut
}

#[typetag::serde(name = "masonry_wall")]
impl Scene for MasonryWall {
    fn build(&self, catalogue: &Catalogue) -> Result<Assembly, Vec<Diagnostic>> {
        Ok(Assembly::without_blocks(catalogue.clone()))
    }

    fn build_space(&self, catalogue: &Catalogue) -> Option<Result<SpaceAssembly, Vec<Diagnostic>>> {
        let (walls, mistakes) = match self.walls() {
            Ok(walls) => (walls, Vec::new()),
            Err(mistakes) => (Vec::new(), mistakes),
        };
        let parts = Parts::new(catalogue, [&self.material, &self.joint], mistakes);
        Some(parts.map(|mut parts| {
            self.assemble(&mut parts, &walls);
            parts.finish()
        }))
    }
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::Scene,
        tag: "masonry_wall",
        summary: "a wall in space of one or more leaves, with headers, openings and corners, loaded in any direction",
        sources: &["de Felice & Giannini 2001, J. Earthq. Eng. 5 (walls out of plane)"],
        samples: &[
            Sample::keys(r#"block = [0.4, 0.2, 0.2]
courses = 4
blocks = 3
side_supports = "both"
openings = [{ from = [0.4, 0.2], to = [0.8, 0.6] }]
material = "stone"
joint = "dry""#),
            Sample::keys(r#"block = [0.4, 0.2, 0.2]
courses = 3
blocks = 2
corner = { blocks = 3 }
side_supports = "end"
material = "brick"
joint = "mortar""#),
            Sample::keys(r#"block = [0.4, 0.2, 0.2]
courses = 3
blocks = 2
leaves = 2
header_every = 2
material = "stone"
joint = "dry""#),
            Sample::keys(r#"block = [0.4, 0.2, 0.2]
courses = 3
blocks = 2
corner = { blocks = 2, joint = "straight" }
openings = [{ from = [0.4, 0.0], to = [0.6, 0.4], wall = "y" }]
material = "brick"
joint = "mortar""#),
        ],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("masonry_wall.md"),
        ..Card::of::<MasonryWall>()
    }
}

#[cfg(test)]
mod tests {
    use super::super::parts::tests::{assert_conforming, built, counts, wrong};
    use serde_json::{Value, json};

    fn keys(extra: Value) -> Value {
        let mut keys = json!({ "block": [2.0, 1.0, 0.5], "courses": 8, "blocks": 4 });
        for (key, value) in extra.as_object().unwrap() {
            keys[key] = value.clone();
        }
        keys
    }

    #[test]
    fn a_toothed_corner_has_its_known_numbers() {
        let corner = built("masonry_wall", &keys(json!({ "corner": { "blocks": 4 } }))).unwrap();
        assert_eq!(counts(&corner), [72, 192, 768]);
        assert_conforming(&corner);
    }

    /// A wall of n blocks and c courses has n blocks in even courses and n + 1 in odd ones, n contacts with the ground, 2 n
    /// between courses, and the head joints.
    #[test]
    fn a_single_wall_has_a_block_above_two() {
        let wall = built("masonry_wall", &keys(json!({ "blocks": 5 }))).unwrap();
        assert_eq!(counts(&wall)[..2], [4 * 5 + 4 * 6, 5 + 7 * 10 + 4 * 4 + 4 * 5]);
        let volume: f64 = wall.bodies[1..].iter().map(|body| body.shape.volume_and_centroid().0).sum();
        assert!((volume - 10.0 * 1.0 * 4.0).abs() < 1e-12);
        let held = built("masonry_wall", &keys(json!({ "blocks": 5, "side_supports": "both" }))).unwrap();
        assert_eq!(counts(&held)[1], counts(&wall)[1] + 2 * 8);
    }

    /// A straight joint has no block of one wall above a block of the other; both joints fill the same volume.
    #[test]
    fn a_straight_joint_does_not_bond_the_walls() {
        let straight = built("masonry_wall", &keys(json!({ "corner": { "blocks": 4, "joint": "straight" } }))).unwrap();
        let wall = |index: usize| straight.bodies[index].name.chars().next();
        let between = straight.contacts.iter().filter(|contact| {
            let pair = [wall(contact.minus), wall(contact.plus)];
            pair.contains(&Some('x')) && pair.contains(&Some('y'))
        });
        let normals: Vec<f64> = between.map(|contact| contact.normal.z.abs()).collect();
        assert!(normals.len() == 8 && normals.iter().all(|z| *z < 1e-15), "{normals:?}");
        let toothed = built("masonry_wall", &keys(json!({ "corner": { "blocks": 4 } }))).unwrap();
        let volume = |scene: &voussoir_core::space::SpaceAssembly| {
            scene.bodies.iter().filter(|body| !body.fixed).map(|body| body.shape.volume_and_centroid().0).sum::<f64>()
        };
        assert!((volume(&straight) - volume(&toothed)).abs() < 1e-10);
    }

    /// Two leaves of n blocks with headers in the second of three courses: each leaf has n blocks in course 0 and n in course 2,
    /// and 2 n headers with a quarter at both ends lie between. No head joint is above another one.
    #[test]
    fn headers_join_leaves() {
        let n = 3;
        let wall = keys(json!({ "blocks": n, "courses": 3, "leaves": 2, "header_every": 2 }));
        let wall = built("masonry_wall", &wall).unwrap();
        let headers = 2 * n + 1;
        let beds = |joints: usize, blocks: usize| joints + blocks;
        let contacts = [
            2 * n,                        // the ground
            2 * (2 * (n - 1) + n),        // head joints and the joint between the leaves, in two courses
            headers - 1,                  // head joints of headers
            2 * 2 * beds(n - 1, headers), // beds below and above the headers, for each leaf
        ];
        assert_eq!(counts(&wall)[..2], [4 * n + headers, contacts.iter().sum()]);
        assert_conforming(&wall);
        let volume: f64 = wall.bodies[1..].iter().map(|body| body.shape.volume_and_centroid().0).sum();
        assert!((volume - 6.0 * 2.0 * 1.5).abs() < 1e-12);
        assert!(wall.body("0.2.1").is_some() && wall.body("1.6").is_some() && wall.body("1.6.0").is_none());
    }

    /// Corners, openings and piers of a wall of three leaves fill the same volume as those of one leaf as thick as three.
    #[test]
    fn leaves_fill_the_volume_of_a_thick_leaf() {
        let opening = json!([{ "from": [3.0, 1.0], "to": [5.0, 2.0] }]);
        for joint in ["toothed", "straight"] {
            let extra = json!({
                "corner": { "blocks": 4, "joint": joint }, "openings": opening, "side_supports": "end",
            });
            let thick = keys(json!({ "block": [2.0, 3.0, 0.5] }));
            let thin = keys(json!({ "leaves": 3, "header_every": 3 }));
            let [thick, thin] = [thick, thin].map(|mut wall| {
                extra.as_object().unwrap().iter().for_each(|(key, value)| wall[key] = value.clone());
                built("masonry_wall", &wall).unwrap()
            });
            assert_conforming(&thin);
            let volume = |scene: &voussoir_core::space::SpaceAssembly| {
                scene.bodies.iter().map(|body| body.shape.volume_and_centroid().0).sum::<f64>()
            };
            assert!((volume(&thick) - volume(&thin)).abs() < 1e-9, "{joint}");
        }
    }

    #[test]
    fn openings_cut_blocks_of_one_wall() {
        let opening = |wall: &str| json!({ "from": [3.0, 1.0], "to": [5.0, 2.0], "wall": wall });
        let whole = built("masonry_wall", &keys(json!({ "corner": { "blocks": 4 } }))).unwrap();
        let volume = |scene: &voussoir_core::space::SpaceAssembly| {
            scene.bodies.iter().map(|body| body.shape.volume_and_centroid().0).sum::<f64>()
        };
        for wall in ["x", "y"] {
            let cut = keys(json!({ "corner": { "blocks": 4 }, "openings": [opening(wall)] }));
            let cut = built("masonry_wall", &cut).unwrap();
            assert!((volume(&whole) - volume(&cut) - 2.0).abs() < 1e-10, "{wall}");
        }
        assert_eq!(wrong("masonry_wall", &keys(json!({ "openings": [opening("y")] }))), ["scene.openings.0.wall"]);
    }

    #[test]
    fn mistakes_are_reported_at_their_keys() {
        assert_eq!(wrong("masonry_wall", &keys(json!({ "block": [2.0, 0.0, 0.5] }))), ["scene.block.1"]);
        assert_eq!(wrong("masonry_wall", &keys(json!({ "leaves": 0 }))), ["scene.leaves"]);
        assert_eq!(wrong("masonry_wall", &keys(json!({ "header_every": 2 }))), ["scene.header_every"]);
        assert_eq!(wrong("masonry_wall", &keys(json!({ "leaves": 2, "header_every": 0 }))), ["scene.header_every"]);
        let start = json!({ "corner": { "blocks": 2 }, "side_supports": "both" });
        assert_eq!(wrong("masonry_wall", &keys(start)), ["scene.side_supports"]);
        let between = json!({ "openings": [{ "from": [1.0, 0.3], "to": [2.0, 1.0] }] });
        assert_eq!(wrong("masonry_wall", &keys(between)), ["scene.openings.0.from.1"]);
        let beside = json!({ "openings": [{ "from": [20.0, 0.0], "to": [22.0, 1.0] }] });
        assert_eq!(wrong("masonry_wall", &keys(beside)), ["scene.openings.0"]);
    }
}
