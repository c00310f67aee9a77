//! Assemblies of blocks of any shape.

use super::families::{extreme, law};
use super::model::{Block, Law, Model, Point, area_centroid};
use std::f64::consts::PI;
use voussoir::core::random::Random;

fn free(model: &mut Model, polygon: Vec<Point>, density: f64) {
    let name = format!("b{}", model.blocks.len());
    model.blocks.push(Block { name, polygon, held: false, density });
}

fn fixed(model: &mut Model, polygon: Vec<Point>) {
    let name = format!("ground{}", model.blocks.len());
    model.blocks.push(Block { name, polygon, held: true, density: 2000.0 });
}

fn rectangle([x0, y0]: Point, [x1, y1]: Point) -> Vec<Point> {
    vec![[x0, y0], [x1, y0], [x1, y1], [x0, y1]]
}

/// Returns both parts of a convex polygon that is cut along a line through a point.
fn cut(polygon: &[Point], through: Point, angle: f64) -> [Vec<Point>; 2] {
    let (sin, cos) = angle.sin_cos();
    let side = |p: Point| cos * (p[1] - through[1]) - sin * (p[0] - through[0]);
    let mut parts = [Vec::new(), Vec::new()];
    for i in 0..polygon.len() {
        let (a, b) = (polygon[i], polygon[(i + 1) % polygon.len()]);
        let (da, db) = (side(a), side(b));
        parts[usize::from(da < 0.0)].push(a);
        if (da < 0.0) != (db < 0.0) {
            let t = da / (da - db);
            let p = [a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t];
            parts.iter_mut().for_each(|part| part.push(p));
        }
    }
    parts
}

/// Returns true if no edge is too short and the part is not too thin.
fn stout(polygon: &[Point], size: f64) -> bool {
    let edge = |i: usize| {
        let (a, b) = (polygon[i], polygon[(i + 1) % polygon.len()]);
        (b[0] - a[0]).hypot(b[1] - a[1])
    };
    polygon.len() > 2
        && (0..polygon.len()).all(|i| edge(i) > 0.03 * size)
        && area_centroid(polygon).0 > 0.002 * size * size
}

/// Adds a rectangle on the ground that lines cut into convex blocks, usually at bed and head joints or at any angle.
/// Some blocks are removed, and there may be ground beside it.
pub fn arranged(r: &mut Random, model: &mut Model) {
    let (width, height) = (r.between(0.5, 3.0), r.between(0.5, 3.0));
    let (count, regular) = (r.whole(1, 18), r.chance(0.5));
    let mut parts = vec![rectangle([0.0, 0.0], [width, height])];
    for _ in 0..20 * count {
        if parts.len() >= count {
            break;
        }
        let index = (0..parts.len())
            .max_by(|a, b| area_centroid(&parts[*a]).0.total_cmp(&area_centroid(&parts[*b]).0))
            .unwrap_or(0);
        let (_, centre) = area_centroid(&parts[index]);
        let through = centre.map(|x| x + 0.1 * r.between(-width, width) / count as f64);
        let angle = match regular {
            true => PI / 2.0 * r.whole(0, 1) as f64 + if r.chance(0.3) { r.between(-0.2, 0.2) } else { 0.0 },
            false => r.between(0.0, PI),
        };
        let halves = cut(&parts[index], through, angle);
        if halves.iter().all(|part| stout(part, width.min(height))) {
            parts.swap_remove(index);
            parts.extend(halves);
        }
    }
    if parts.len() > 3 && r.chance(0.3) {
        parts.swap_remove(r.whole(0, parts.len() - 1));
    }
    let densities = [r.between(1600.0, 2700.0), r.between(1000.0, 3500.0)];
    for part in parts {
        let density = *r.one_of(&densities);
        free(model, part, density);
    }
    fixed(model, rectangle([-1.0, -0.5], [width + 1.0, 0.0]));
    if r.chance(0.4) {
        fixed(model, rectangle([-1.0, 0.0], [0.0, height * r.between(0.1, 1.0)]));
    }
    if r.chance(0.3) {
        fixed(model, rectangle([width, 0.0], [width + 1.0, height * r.between(0.1, 1.0)]));
    }
}

/// Adds towers, leaning stacks, flat arches, wedges, blocks on slopes, hanging blocks or beams between walls, also
/// without weight, without friction, or symmetric.
pub fn degenerate(r: &mut Random, model: &mut Model) {
    let strengths = r.chance(0.5);
    model.laws = vec![if r.chance(0.5) { extreme(r) } else { law(r, strengths) }];
    let density = if r.chance(0.15) { 0.0 } else { 2000.0 };
    match r.whole(0, 6) {
        0 => {
            // A tower, vertical or leaning.
            let (lean, mut y, mut x) = (if r.chance(0.5) { 0.0 } else { r.between(-0.2, 0.2) }, 0.0, 0.0);
            for _ in 0..r.whole(1, 12) {
                let height = r.between(0.2, 0.6);
                free(model, rectangle([x, y], [x + 1.0, y + height]), density);
                y += height;
                x += lean;
            }
            fixed(model, rectangle([-3.0, -0.5], [4.0, 0.0]));
        }
        1 => flat_arch(r, model, density),
        2 => {
            // A wedge between two walls.
            let (top, foot) = (1.0, r.between(0.1, 0.95));
            let half = (top - foot) / 2.0;
            free(model, vec![[half, 0.0], [half + foot, 0.0], [top, 1.0], [0.0, 1.0]], density);
            fixed(model, vec![[half, 0.0], [0.0, 1.0], [-1.0, 1.0], [-1.0, 0.0]]);
            fixed(model, vec![[half + foot, 0.0], [2.0, 0.0], [2.0, 1.0], [top, 1.0]]);
        }
        3 => {
            // Blocks on a slope, sometimes exactly at the angle of friction.
            let mu = model.laws[0].friction;
            let slope = if r.chance(0.2) && mu < 2.0 { mu } else { r.between(0.05, 1.5) };
            let at = |s: f64, n: f64| {
                let c = 1.0 / slope.hypot(1.0);
                [c * (s - slope * n), c * (slope * s + n)]
            };
            for k in 0..r.whole(1, 4) {
                let (from, to) = (k as f64, k as f64 + 1.0);
                free(model, vec![at(from, 0.0), at(to, 0.0), at(to, 0.7), at(from, 0.7)], density);
            }
            fixed(model, vec![at(-1.0, -1.0), at(6.0, -1.0), at(6.0, 0.0), at(-1.0, 0.0)]);
        }
        4 => {
            // Hanging blocks.
            model.laws = vec![Law { tensile: r.power(3.0, 6.0), cohesion: r.power(3.0, 6.0), ..model.laws[0].clone() }];
            model.laws[0].tag = "mohr_coulomb";
            model.laws[0].friction = r.between(0.1, 1.0);
            for k in 0..r.whole(1, 5) {
                let y = -(k as f64);
                free(model, rectangle([0.0, y - 1.0], [1.0, y]), density);
            }
            fixed(model, rectangle([-1.0, 0.0], [2.0, 1.0]));
        }
        5 => {
            // A beam between two walls.
            let count = r.whole(1, 9);
            for k in 0..count {
                free(model, rectangle([k as f64, 0.0], [k as f64 + 1.0, 1.0]), density);
            }
            fixed(model, rectangle([-1.0, 0.0], [0.0, 1.0]));
            fixed(model, rectangle([count as f64, 0.0], [count as f64 + 1.0, 1.0]));
        }
        _ => {
            // A symmetric gate.
            let (height, length) = (r.between(0.5, 3.0), r.between(1.5, 3.0));
            free(model, rectangle([0.0, 0.0], [1.0, height]), density);
            free(model, rectangle([length, 0.0], [length + 1.0, height]), density);
            free(model, rectangle([0.0, height], [length + 1.0, height + 0.5]), density);
            fixed(model, rectangle([-1.0, -0.5], [length + 2.0, 0.0]));
        }
    }
}

/// Adds wedges with vertical or inclined joints between two walls, with a level soffit.
fn flat_arch(r: &mut Random, model: &mut Model, density: f64) {
    let (count, height) = (r.whole(1, 11), r.between(0.2, 0.8));
    let (span, spread) = (2.0, r.between(0.0, 0.5));
    let bottom = |k: usize| span * k as f64 / count as f64;
    let top = |k: usize| bottom(k) + spread * (2.0 * k as f64 / count as f64 - 1.0);
    for k in 0..count {
        free(model, vec![[bottom(k), 0.0], [bottom(k + 1), 0.0], [top(k + 1), height], [top(k), height]], density);
    }
    fixed(model, vec![[0.0, 0.0], [top(0), height], [-1.0, height], [-1.0, 0.0]]);
    fixed(model, vec![[span, 0.0], [span + 1.0, 0.0], [span + 1.0, height], [top(count), height]]);
}
