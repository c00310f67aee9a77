//! Collapse factors that are known in closed form.

use super::scenes::{Scene, at_angle, collapse, rectangle};
use voussoir_core::space::Vec3;

/// Relative tolerance of closed forms.
const CLOSED_FORM: f64 = 1e-9;

fn meets(found: f64, expected: f64, case: &str) {
    assert!((found - expected).abs() <= CLOSED_FORM * expected, "{case}: {found} instead of {expected}");
}

/// Returns a body on the ground with a base, weight 1 and the centroid at a height above the centre of the base.
fn standing(base: Vec<Vec3>, height: f64, friction: f64) -> Scene {
    let centre = base.iter().sum::<Vec3>() / base.len() as f64;
    let centroid = Vec3::new(centre.x, centre.y, height);
    Scene { bodies: vec![(1.0, centroid)], contacts: vec![(None, Some(0), base, Vec3::z(), friction)] }
}

/// A block b × d × h pushed at φ slides, or topples about one side: min(μ, (b/h)/cos φ, (d/h)/sin φ).
#[test]
fn a_block_slides_or_topples_about_its_sides() {
    for (b, d, h, friction, angles) in
        [(1.0, 1.0, 2.0, 0.6, [0.0, 15.0, 30.0, 45.0]), (1.0, 2.0, 2.5, 0.7, [0.0, 20.0, 40.0, 60.0])]
    {
        let block = standing(rectangle([0.0, b], [0.0, d], 0.0), h / 2.0, friction);
        for angle in angles {
            let (sin, cos) = f64::to_radians(angle).sin_cos();
            let expected = friction.min(b / h / cos).min(if sin > 0.0 { d / h / sin } else { f64::INFINITY });
            meets(collapse(&block.problem(&at_angle(angle))), expected, &format!("{b} × {d} × {h} at {angle}°"));
        }
    }
}

/// A triangular prism of side 1 and height 2 topples about the edge that the push meets first.
#[test]
fn a_prism_topples_about_the_nearest_edge() {
    let radius = 1.0 / 3.0f64.sqrt();
    let corner = |degrees: f64| at_angle(degrees) * radius;
    let prism = standing(vec![corner(-150.0), corner(-30.0), corner(90.0)], 1.0, 0.8);
    for angle in [0.0, 30.0, 75.0, 90.0, -90.0] {
        let edge = |normal: f64| {
            let cos = f64::to_radians(angle - normal).cos();
            if cos > 1e-9 { radius / 2.0 / cos } else { f64::INFINITY }
        };
        let expected = [-90.0, 30.0, 150.0].into_iter().map(edge).fold(0.8, f64::min);
        meets(collapse(&prism.problem(&at_angle(angle))), expected, &format!("prism at {angle}°"));
    }
}

/// A pyramid on a rectangle 1 × 1.6 turned by 25°, of height 3: the centroid is at .75.
#[test]
fn a_turned_pyramid_topples_about_its_base() {
    let turn = |x: f64, y: f64| at_angle(25.0) * x + at_angle(115.0) * y;
    let base = vec![turn(-0.5, -0.8), turn(0.5, -0.8), turn(0.5, 0.8), turn(-0.5, 0.8)];
    let pyramid = standing(base, 0.75, 0.9);
    for angle in [0.0, 25.0, 70.0] {
        let (sin, cos) = f64::to_radians(angle - 25.0).sin_cos();
        let expected = 0.9f64.min(0.5 / 0.75 / cos.abs()).min(0.8 / 0.75 / sin.abs().max(1e-9));
        meets(collapse(&pyramid.problem(&at_angle(angle))), expected, &format!("pyramid at {angle}°"));
    }
}

/// Two unit cubes, the upper one shifted by .2 in x, topple together about the base.
#[test]
fn two_shifted_cubes_topple_about_the_base() {
    let mut cubes = Scene::default();
    cubes.add_box([0.0, 1.0], [0.0, 1.0], [0.0, 1.0]);
    cubes.add_box([0.2, 1.2], [0.0, 1.0], [1.0, 2.0]);
    cubes.contacts.push((None, Some(0), rectangle([0.0, 1.0], [0.0, 1.0], 0.0), Vec3::z(), 0.7));
    cubes.contacts.push((Some(0), Some(1), rectangle([0.2, 1.0], [0.0, 1.0], 1.0), Vec3::z(), 0.7));
    for (angle, expected) in
        [(0.0, 0.4), (180.0, 0.6), (90.0, 0.5), (30.0, 0.461_880_215_351_700_6), (150.0, 0.692_820_323_027_550_9)]
    {
        meets(collapse(&cubes.problem(&at_angle(angle))), expected, &format!("cubes at {angle}°"));
    }
}

/// A flat block on a plane inclined by 20°, pushed horizontally at ψ from the line of descent, slides when the
/// tangential load reaches μ times the normal one.
#[test]
fn a_flat_block_on_a_slope_slides() {
    let slope = 20.0f64.to_radians();
    let (normal, descent) = (Vec3::new(slope.sin(), 0.0, slope.cos()), Vec3::new(slope.cos(), 0.0, -slope.sin()));
    let corner = |a: f64, b: f64| descent * a + Vec3::y() * b;
    let base = vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    let block = Scene { bodies: vec![(1.0, normal * 0.001)], contacts: vec![(None, Some(0), base, normal, 0.7)] };
    let friction = 0.7f64.atan();
    for (angle, expected) in [
        (0.0, (friction - slope).tan()),
        (45.0, 0.324_355_990_0),
        (90.0, 0.561_874_639_2),
        (135.0, 1.066_244_436_2),
        (180.0, (friction + slope).tan()),
    ] {
        meets(collapse(&block.problem(&at_angle(angle))), expected, &format!("slope at {angle}°"));
    }
}

/// Torsion of a square face about its centre: μ N a / √2 with forces at the vertices.
#[test]
fn torsion_of_a_square_face_is_carried_at_its_vertices() {
    let block = standing(rectangle([-0.5, 0.5], [-0.5, 0.5], 0.0), 0.5, 1.0);
    let mut problem = block.problem(&Vec3::x());
    problem.varying = vec![[0.0, 0.0, 0.0, 0.0, 0.0, 1.0]];
    meets(collapse(&problem), std::f64::consts::FRAC_1_SQRT_2, "torsion");
}

/// Vertices carry as much as a grid of 7 × 7 points, for torsion with an eccentric weight and a push.
#[test]
fn a_grid_of_points_carries_no_more_than_the_vertices() {
    let at = |points: Vec<Vec3>| {
        let block = Scene {
            bodies: vec![(1.0, Vec3::new(0.1, -0.05, 0.3))],
            contacts: vec![(None, Some(0), points, Vec3::z(), 0.5)],
        };
        let mut problem = block.problem(&at_angle(35.0));
        problem.varying[0][5] += 0.4;
        collapse(&problem)
    };
    let grid = (0..49).map(|k| Vec3::new(f64::from(k / 7) / 6.0 - 0.5, f64::from(k % 7) / 6.0 - 0.5, 0.0));
    meets(at(grid.collect()), at(rectangle([-0.5, 0.5], [-0.5, 0.5], 0.0)), "grid");
}

/// A wall of bricks pushed across topples about its base: t/H, whatever its length.
#[test]
fn a_wall_pushed_across_topples_at_thickness_over_height() {
    let wall = wall(5, 8, 0.7);
    meets(collapse(&wall.problem(&Vec3::y())), 0.5 / 8.0 / 0.25, "wall");
}

/// A running bond of bricks 2 × .5 × .25 without head joints; courses start at a half brick.
pub fn wall(bricks: usize, courses: usize, friction: f64) -> Scene {
    let mut wall = Scene::default();
    let (length, thickness, height) = (2.0, 0.5, 0.25);
    let mut below: Vec<(Option<usize>, [f64; 2])> = vec![(None, [-1e3, 1e3])];
    for course in 0..courses {
        let shift = if course % 2 == 0 { 0.0 } else { -length / 2.0 };
        let count = bricks + course % 2;
        let total = length * bricks as f64;
        let z = height * course as f64;
        let mut own = Vec::new();
        for brick in 0..count {
            let from = (shift + length * brick as f64).max(0.0);
            let to = (shift + length * (brick + 1) as f64).min(total);
            let body = wall.add_box([from, to], [0.0, thickness], [z, z + height]);
            for (under, [start, end]) in &below {
                let (low, high) = (from.max(*start), to.min(*end));
                if high - low > 1e-9 {
                    let face = rectangle([low, high], [0.0, thickness], z);
                    wall.contacts.push((*under, Some(body), face, Vec3::z(), friction));
                }
            }
            own.push((Some(body), [from, to]));
        }
        below = own;
    }
    wall
}
