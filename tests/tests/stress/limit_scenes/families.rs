//! Random scenes: the text of a study, and the same blocks, laws and loads as a model.

use super::assemblies::{arranged, degenerate};
use super::model::{Block, Contact, Force, Law, Model, Point, area_centroid};
use std::f64::consts::PI;
use std::fmt::Write;
use voussoir::core::model::Body;
use voussoir::core::random::Random;

/// A scene in both forms.
pub struct Scene {
    pub family: &'static str,
    pub text: String,
    pub model: Model,
}

pub const FAMILIES: [&str; 6] =
    ["arch", "arch, other loads", "wall", "assembly", "assembly of strengths", "degenerate"];

/// Returns the scene of a seed; `None` if its numbers give no valid scene.
pub fn scene(seed: u64) -> Option<Scene> {
    let mut r = Random::new(seed);
    match seed % 6 {
        0 => arch(&mut r, FAMILIES[0], false),
        1 => arch(&mut r, FAMILIES[1], true),
        2 => wall(&mut r, FAMILIES[2]),
        3 => assembly(&mut r, FAMILIES[3], false),
        4 => assembly(&mut r, FAMILIES[4], true),
        _ => Some(finish(&mut r, FAMILIES[5], degenerate)),
    }
}

/// Returns a law of any kind.
pub fn law(r: &mut Random, strengths: bool) -> Law {
    let friction = r.between(0.05, 1.2);
    let kind = if strengths { r.whole(4, 7) } else { r.whole(0, 5) };
    match kind {
        0 => Law::dry("unilateral", f64::INFINITY),
        1..=3 => Law::dry(if r.chance(0.2) { "coulomb" } else { "coulomb_associated" }, friction),
        4 => Law { compressive: r.power(4.3, 8.0), ..Law::dry("mohr_coulomb", friction) },
        5 => {
            let cohesion = r.power(2.0, 6.0);
            Law { cohesion, tensile: cohesion * r.unit(), ..Law::dry("mohr_coulomb", friction) }
        }
        6 => {
            let (cohesion, compressive) = (r.power(2.0, 6.0), r.power(4.3, 8.0));
            let tensile = if r.chance(0.5) { cohesion * r.between(0.0, 3.0) } else { 0.0 };
            Law { cohesion, tensile, compressive, ..Law::dry("mohr_coulomb", friction) }
        }
        _ => Law { tensile: r.power(2.0, 5.0), cohesion: r.power(3.0, 5.0), ..Law::dry("mohr_coulomb", friction) },
    }
}

/// Returns a law without friction, with unrealistic friction, or with strengths that have no effect.
pub fn extreme(r: &mut Random) -> Law {
    match r.whole(0, 5) {
        0 => Law::dry("unilateral", 0.0),
        1 => Law::dry("coulomb_associated", 0.0),
        2 => Law::dry("coulomb_associated", r.power(12.0, 16.0)),
        3 => Law { compressive: r.power(15.0, 17.0), ..Law::dry("mohr_coulomb", r.between(0.2, 1.0)) },
        4 => Law { cohesion: r.power(10.0, 12.0), ..Law::dry("mohr_coulomb", r.between(0.0, 1.0)) },
        _ => Law { tensile: r.power(3.0, 6.0), cohesion: 1e5, ..Law::dry("mohr_coulomb", 0.0) },
    }
}

/// Returns the tables of laws, materials and solver.
fn tables(laws: &[Law], solver: &str, densities: &[f64]) -> String {
    let mut text = String::new();
    for (i, density) in densities.iter().enumerate() {
        let _ = write!(text, "[materials.m{i}]\nlaw = \"rigid\"\ndensity = {density:?}\n");
    }
    for (i, law) in laws.iter().enumerate() {
        let _ = write!(text, "[joints.j{i}]\n{}", law.table());
    }
    text + &format!("[solver]\nsolver = \"{solver}\"\n")
}

fn gravity(r: &mut Random) -> Point {
    match r.whole(0, 9) {
        0 => [r.between(-3.0, 3.0), -9.81],
        _ => [0.0, -9.81],
    }
}

/// Returns the stages: dead load, and the loads that grow.
fn stages(gravity: Point, loads: &[String]) -> String {
    format!(
        "[[stages]]\nname = \"dead\"\ngravity = {gravity:?}\n[[stages]]\nname = \"live\"\nuntil = \"collapse\"\nloads = [{}]\n",
        loads.join(", ")
    )
}

/// Returns a direction; downwards, upwards and horizontal are more frequent.
fn direction(r: &mut Random) -> Point {
    match r.whole(0, 5) {
        0 | 1 => [0.0, -1.0],
        2 => [if r.chance(0.5) { 1.0 } else { -1.0 }, 0.0],
        3 => [0.0, 1.0],
        _ => {
            let angle = r.between(-PI, PI);
            [angle.cos(), angle.sin()]
        }
    }
}

/// Returns the solver named in the study.
fn solver(r: &mut Random, laws: &[Law], chain: bool) -> &'static str {
    // By default these laws have their own flow.
    let own = laws.iter().any(|law| law.tag == "coulomb");
    match r.whole(0, 4) {
        0 if chain => "limit_chain",
        0 | 1 => "limit_conic",
        _ if own => "limit_conic",
        _ => "auto",
    }
}

/// Adds a load on the free blocks of a model and returns its text.
fn load_on(r: &mut Random, model: &mut Model) -> String {
    let free: Vec<usize> = (0..model.blocks.len()).filter(|b| !model.blocks[*b].held).collect();
    let block = *r.one_of(&free);
    let Block { polygon, name, density, .. } = model.blocks[block].clone();
    let (area, centre) = area_centroid(&polygon);
    let weight = (9.81 * density.max(1.0) * area * model.width).max(1e-9);
    match r.whole(0, 3) {
        0 | 1 => {
            let corner = polygon[r.whole(0, polygon.len() - 1)];
            let share = if r.chance(0.3) { 0.0 } else { r.between(0.0, 0.95) };
            let point = [0, 1].map(|d| centre[d] + (corner[d] - centre[d]) * share);
            let force = direction(r).map(|x| x * weight);
            model.forces.push(Force { block, point, force });
            format!("{{ kind = \"point\", block = \"{name}\", point = {point:?}, force = {force:?} }}")
        }
        2 => {
            let acceleration = direction(r).map(|x| 9.81 * x);
            (0..2).for_each(|d| model.acceleration[d] += acceleration[d]);
            format!("{{ kind = \"body\", acceleration = {acceleration:?} }}")
        }
        _ => {
            let edge = r.whole(0, polygon.len() - 1);
            let [a, b] = [polygon[edge], polygon[(edge + 1) % polygon.len()]];
            let length = (b[0] - a[0]).hypot(b[1] - a[1]);
            let value = weight / (length * model.width) * if r.chance(0.8) { 1.0 } else { -1.0 };
            let force = [-(b[1] - a[1]), b[0] - a[0]].map(|x| x * value * model.width);
            let point = [(a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0];
            model.forces.push(Force { block, point, force });
            format!("{{ kind = \"pressure\", block = \"{name}\", edge = {edge}, value = {value:?} }}")
        }
    }
}

/// Returns the bodies of a scene that is read with an idle stage.
fn bodies(head: &str, tables: &str) -> Option<Vec<Body>> {
    let text = format!("name = \"random\"\n{head}{tables}[[stages]]\nname = \"dead\"\ngravity = 9.81\n");
    let study = voussoir::study::load(&text, "random.toml", &[]).ok()?;
    Some(study.cases.first()?.assembly.bodies.clone())
}

fn blocks_of(bodies: &[Body], density: f64) -> Vec<Block> {
    let points = |body: &Body| body.vertices.iter().map(|p| [p.x, p.y]).collect();
    let block = |body: &Body| Block { name: body.name.clone(), polygon: points(body), held: body.fixed, density };
    bodies.iter().filter(|body| !body.vertices.is_empty()).map(block).collect()
}

/// Returns the intrados profile of an arch.
fn profile(r: &mut Random, span: f64) -> (String, f64) {
    let shape =
        *r.one_of(&["segmental", "segmental", "elliptical", "parabolic", "catenary", "pointed", "three_centred"]);
    let rise = span
        * match shape {
            "pointed" => r.between(0.5, 1.2),
            "three_centred" => r.between(0.2, 0.45),
            _ if r.chance(0.15) => r.power(-3.0, -1.0),
            "segmental" => r.between(0.08, 0.9),
            _ => r.between(0.08, 1.0),
        };
    let more = match shape {
        "three_centred" => format!(", crown_radius = {:?}", span * r.between(0.55, 1.5)),
        _ => String::new(),
    };
    (format!("{{ shape = \"{shape}\", span = {span:?}, rise = {rise:?}{more} }}"), rise)
}

/// Returns a ring with any profile.
fn arch(r: &mut Random, family: &'static str, other_loads: bool) -> Option<Scene> {
    let span = r.power(-0.3, 1.6);
    let (profile, rise) = profile(r, span);
    let (thickness, width, voussoirs) = (span * r.between(0.02, 0.2), r.power(-1.0, 1.0), r.whole(2, 40));
    let bonded = voussoirs > 4 && r.chance(0.3);
    let density = r.between(1600.0, 2700.0);
    let strengths = r.chance(0.4);
    let law = if r.chance(0.15) { extreme(r) } else { law(r, strengths) };
    let springing = match r.whole(0, 4) {
        0 => format!("springing = [{:?}, {:?}]\n", r.between(20.0, 90.0), r.between(20.0, 90.0)),
        _ => String::new(),
    };
    let head = format!(
        "[scene]\nscene = \"arch\"\nprofile = {profile}\nthickness = {thickness:?}\nwidth = {width:?}\nvoussoirs = {voussoirs}\n\
         ends = \"{}\"\nmaterial = \"m0\"\njoint = \"j0\"\n{springing}",
        if bonded { "bonded" } else { "jointed" }
    );
    let tables = tables(std::slice::from_ref(&law), solver(r, std::slice::from_ref(&law), true), &[density]);
    let mut model = Model { laws: vec![law], width, gravity: gravity(r), ..Model::default() };
    model.blocks = blocks_of(&bodies(&head, &tables)?, density);
    if model.blocks.len() != voussoirs {
        return None;
    }
    if bonded {
        [0, voussoirs - 1].iter().for_each(|end| model.blocks[*end].held = true);
    }
    ring_contacts(&mut model, bonded);
    let loads = if other_loads {
        (0..r.whole(1, 2)).map(|_| ring_load(r, &mut model, span, rise)).collect()
    } else {
        let (fraction, force) = (r.between(0.03, 0.97), direction(r).map(|x| 1e4 * x));
        on_extrados(&mut model, span * (fraction - 0.5), force)?;
        vec![format!("{{ kind = \"point\", span_fraction = {fraction:?}, force = {force:?} }}")]
    };
    let text = format!("name = \"random\"\n{head}{tables}{}", stages(model.gravity, &loads));
    Some(Scene { family, text, model })
}

/// Adds the joints of a ring whose edges are intrados, right, extrados, left; the ground is an additional held block.
fn ring_contacts(model: &mut Model, bonded: bool) {
    let count = model.blocks.len();
    let far = model.blocks[0].clone();
    model.blocks.push(Block { name: "ground".into(), held: true, ..far });
    for k in 0..=count {
        let ends = if k < count {
            [model.blocks[k].polygon[0], model.blocks[k].polygon[3]]
        } else {
            [model.blocks[k - 1].polygon[1], model.blocks[k - 1].polygon[2]]
        };
        let left = if k == 0 { count } else { k - 1 };
        if !(bonded && (k == 0 || k == count)) {
            model.contacts.push(Contact { on: [left, k], ends, law: 0 });
        }
    }
}

/// Adds a force on the upper extrados chord at x.
fn on_extrados(model: &mut Model, x: f64, force: Point) -> Option<()> {
    let chord = |block: &Block| [block.polygon[3], block.polygon[2]];
    let y = |[a, b]: [Point; 2]| a[1] + (b[1] - a[1]) * (x - a[0]) / (b[0] - a[0]);
    let over = |block: &Block| {
        let [a, b] = chord(block);
        a[0].min(b[0]) <= x && x <= a[0].max(b[0])
    };
    let all = 0..model.blocks.len() - 1;
    let block = all
        .filter(|b| over(&model.blocks[*b]))
        .max_by(|a, b| y(chord(&model.blocks[*a])).total_cmp(&y(chord(&model.blocks[*b]))))?;
    let point = [x, y(chord(&model.blocks[block]))];
    model.forces.push(Force { block, point, force });
    Some(())
}

/// Adds strips and axles if no chord is above another one, else loads on any block.
fn ring_load(r: &mut Random, model: &mut Model, span: f64, rise: f64) -> String {
    let kind = if rise < 0.45 * span { r.whole(0, 3) } else { 3 };
    match kind {
        0 => {
            let (from, to) = (r.between(0.05, 0.5), r.between(0.55, 0.95));
            let pressure = 1e4;
            for block in 0..model.blocks.len() - 1 {
                let [a, b] = [3, 2].map(|i| model.blocks[block].polygon[i]);
                let (low, high) = (a[0].max(span * (from - 0.5)), b[0].min(span * (to - 0.5)));
                if high > low {
                    let force = [0.0, -pressure * model.width * (high - low)];
                    model.forces.push(Force { block, point: [(low + high) / 2.0, a[1]], force });
                }
            }
            format!("{{ kind = \"strip\", from = {from:?}, to = {to:?}, pressure = {pressure:?} }}")
        }
        1 => {
            let at = r.between(0.1, 0.6);
            let positions = [0.0, span * r.between(0.05, 0.3)];
            let forces = [1e4, 1e4 * r.between(0.2, 2.0)];
            for (position, force) in positions.iter().zip(forces) {
                let _ = on_extrados(model, span * (at - 0.5) + position, [0.0, -force]);
            }
            format!("{{ kind = \"axles\", at = {at:?}, positions = {positions:?}, forces = {forces:?} }}")
        }
        _ => {
            // The ground has no name here.
            let ground = model.blocks.pop().expect("a ground");
            let load = load_on(r, model);
            model.blocks.push(ground);
            load
        }
    }
}

/// Returns a wall in running bond with windows.
fn wall(r: &mut Random, family: &'static str) -> Option<Scene> {
    let (courses, bricks) = (r.whole(1, 6), r.whole(1, 6));
    let brick = [r.between(0.2, 0.8), r.between(0.1, 0.4)];
    let (width, density) = (r.between(0.1, 1.0), r.between(1600.0, 2700.0));
    let strengths = r.chance(0.4);
    let law = if r.chance(0.1) { extreme(r) } else { law(r, strengths) };
    let mut head = format!(
        "[scene]\nscene = \"wall\"\nwidth = {width:?}\nbrick = {brick:?}\ncourses = {courses}\nbricks = {bricks}\nmaterial = \"m0\"\n\
         joint = \"j0\"\n"
    );
    if courses > 2 && bricks > 2 && r.chance(0.5) {
        let from = [brick[0] * r.between(0.4, 1.2), brick[1] * r.whole(1, courses - 2) as f64];
        let to = [from[0] + brick[0] * r.between(0.3, 1.2), from[1] + brick[1]];
        let _ = writeln!(head, "openings = [{{ from = {from:?}, to = {to:?} }}]");
    }
    let tables = tables(std::slice::from_ref(&law), solver(r, std::slice::from_ref(&law), false), &[density]);
    let mut model = Model { laws: vec![law], width, gravity: gravity(r), ..Model::default() };
    model.blocks = blocks_of(&bodies(&head, &tables)?, density);
    model.join(|_, _| 0);
    let loads: Vec<String> = (0..r.whole(1, 2)).map(|_| load_on(r, &mut model)).collect();
    let text = format!("name = \"random\"\n{head}{tables}{}", stages(model.gravity, &loads));
    Some(Scene { family, text, model })
}

/// Returns convex blocks that fill a rectangle; some of them are removed.
fn assembly(r: &mut Random, family: &'static str, strengths: bool) -> Option<Scene> {
    let laws: Vec<Law> = match r.whole(0, 9) {
        0 => vec![extreme(r)],
        _ => (0..r.whole(1, 3)).map(|_| law(r, strengths)).collect(),
    };
    Some(finish(r, family, |r, model| {
        model.laws = laws;
        arranged(r, model);
    }))
}

/// Returns a scene `blocks` whose blocks and laws `fill` has put into the model. It is rotated, scaled and shifted,
/// with random loads if it has none.
fn finish(r: &mut Random, family: &'static str, fill: impl FnOnce(&mut Random, &mut Model)) -> Scene {
    let mut model = Model { width: r.between(0.2, 2.0), gravity: gravity(r), ..Model::default() };
    fill(r, &mut model);
    if r.chance(0.3) {
        disguise(r, &mut model);
    }
    let count = model.laws.len();
    let seed = r.whole(0, 1000);
    model.join(|a, b| (seed + 3 * a + 5 * b) % count);
    let mut densities: Vec<f64> = model.blocks.iter().map(|block| block.density).collect();
    densities.dedup();
    let mut text = format!(
        "name = \"random\"\n[scene]\nscene = \"blocks\"\nwidth = {:?}\nmaterial = \"m0\"\njoint = \"j0\"\nblocks = [\n",
        model.width
    );
    for block in &model.blocks {
        let material = densities.iter().position(|density| *density == block.density).unwrap_or(0);
        let fixed = if block.held { ", fixed = true" } else { "" };
        let _ = writeln!(
            text,
            "  {{ name = \"{}\", vertices = {:?}, material = \"m{material}\"{fixed} }},",
            block.name, block.polygon
        );
    }
    text += "]\npairs = [\n";
    let mut pairs: Vec<([usize; 2], usize)> = model.contacts.iter().map(|c| (c.on, c.law)).collect();
    pairs.dedup();
    for ([a, b], law) in pairs.iter().filter(|(_, law)| *law > 0) {
        let [a, b] = [a, b].map(|block| &model.blocks[*block].name);
        let _ = writeln!(text, "  {{ between = [\"{a}\", \"{b}\"], joint = \"j{law}\" }},");
    }
    text += "]\n";
    text += &tables(&model.laws, solver(r, &model.laws, false), &densities);
    let loads: Vec<String> = (0..r.whole(1, 3)).map(|_| load_on(r, &mut model)).collect();
    text += &stages(model.gravity, &loads);
    Scene { family, text, model }
}

/// Rotates the scene with its gravity, changes the unit of length, and moves it far from the origin.
fn disguise(r: &mut Random, model: &mut Model) {
    let (angle, scale) = (r.between(-PI, PI), r.power(-2.0, 2.0));
    let off = if r.chance(0.3) { [r.between(-1e3, 1e3), 1e3 * scale] } else { [0.0; 2] };
    let (sin, cos) = angle.sin_cos();
    let turn = |[x, y]: Point| [cos * x - sin * y, sin * x + cos * y];
    for block in &mut model.blocks {
        for p in &mut block.polygon {
            let turned = turn(*p);
            *p = [0, 1].map(|d| scale * turned[d] + off[d]);
        }
    }
    model.gravity = turn(model.gravity);
}
