//! Random arches and bridges on abutments against an independent program of polygons: the ring, the abutments, the fill,
//! the backing and the loads are written again as a conic program for Clarabel. It shares no code with the scenes, loads
//! and solvers of Voussoir; only the text of the study uses the same numbers.

use crate::conic::{Extreme, Rows};
use voussoir::core::limit::Status;
use voussoir::results::CaseResult;
use voussoir_tests::settled::Random;
use voussoir_tests::{answered, assert_close, changed, collapse_factor};

type Point = [f64; 2];

/// An abutment.
#[derive(Debug, Clone, Copy)]
struct Abutment {
    width: f64,
    height: f64,
    friction: f64,
    backing: f64,
}

/// A load of 1 N downwards.
#[derive(Debug, Clone, Copy)]
enum Load {
    /// On the extrados at a fraction of the span.
    Fraction(f64),
    /// Two axles on the road with this length of their patches: x of the left springing is 0.
    Axles([f64; 2], f64),
}

/// An arch or a bridge of one ring.
#[derive(Debug, Clone)]
struct Scene {
    span: f64,
    rise: f64,
    thickness: f64,
    width: f64,
    voussoirs: usize,
    friction: f64,
    crushing: Option<f64>,
    /// Left and right; `None` is a fixed support.
    abutments: [Option<Abutment>; 2],
    /// Cover and density of the fill of a bridge.
    fill: Option<[f64; 2]>,
    load: Load,
}

const DENSITY: f64 = 2350.0;
const GRAVITY: f64 = 9.81;

impl Scene {
    fn random(seed: u64, crushing: bool, bridge: bool) -> Scene {
        let mut random = Random::new(seed);
        let span = random.uniform(3.0, 14.0);
        let one = |random: &mut Random| Abutment {
            width: span * random.uniform(0.2, 0.7),
            height: span * random.uniform(0.05, 0.4),
            friction: random.uniform(0.3, 0.7),
            backing: if random.whole(0, 1) == 0 { 0.0 } else { random.uniform(0.0, 5e4) },
        };
        let abutments = match random.whole(0, 4) {
            0 => [None, Some(one(&mut random))],
            1 => [Some(one(&mut random)), None],
            _ => [Some(one(&mut random)), Some(one(&mut random))],
        };
        let at = random.uniform(0.1, 0.9);
        let load = match bridge {
            true => Load::Axles([span * at, -span * random.uniform(0.05, 0.15)], 0.3),
            false => Load::Fraction(at),
        };
        Scene {
            span,
            rise: span * random.uniform(0.15, if bridge { 0.45 } else { 0.52 }),
            thickness: span * random.uniform(0.05, 0.09),
            width: random.uniform(1.0, 6.0),
            voussoirs: random.whole(7, 25),
            friction: random.uniform(0.45, 0.8),
            crushing: crushing.then(|| random.uniform(3e6, 12e6)),
            abutments,
            fill: bridge.then(|| [random.uniform(0.1, 0.6), random.uniform(0.0, 2000.0)]),
            load,
        }
    }

    /// Returns the mirror image.
    fn mirrored(&self) -> Scene {
        let load = match self.load {
            Load::Fraction(at) => Load::Fraction(1.0 - at),
            Load::Axles(at, length) => Load::Axles(at.map(|x| self.span - x), length),
        };
        Scene { abutments: [self.abutments[1], self.abutments[0]], load, ..self.clone() }
    }

    /// Returns the keys of the abutments: one table if both are equal.
    fn table(&self) -> String {
        let keys = |own: &Abutment| {
            let Abutment { width, height, friction, backing } = own;
            format!("width = {width:?}\nheight = {height:?}\nbase_friction = {friction:?}\nbacking = {backing:?}\n")
        };
        let side = |name: &str, own: &Option<Abutment>| {
            own.as_ref().map(|own| format!("[scene.abutments.{name}]\n{}", keys(own))).unwrap_or_default()
        };
        side("left", &self.abutments[0]) + &side("right", &self.abutments[1])
    }

    /// Returns the tables after the scene.
    fn rest(&self, load: &str) -> String {
        let strength = self.crushing.map(|own| format!("compressive_strength = {own:?}\n")).unwrap_or_default();
        format!(
            "[materials.stone]\nlaw = \"rigid\"\ndensity = {DENSITY:?}\n[joints.dry]\nlaw = \"mohr_coulomb\"\n\
             friction = {:?}\n{strength}[[stages]]\nname = \"dead\"\ngravity = {GRAVITY:?}\n[[stages]]\nname = \"live\"\n\
             until = \"collapse\"\nloads = [{load}]\n",
            self.friction
        )
    }

    /// Returns the study with the scene `arch`, or `bridge` if there is fill.
    fn study(&self) -> String {
        let Scene { span, rise, thickness, width, voussoirs, .. } = self;
        let ring = format!(
            "profile = {{ shape = \"segmental\", span = {span:?}, rise = {rise:?} }}, thickness = {thickness:?}, \
             voussoirs = {voussoirs}"
        );
        let common = format!("width = {width:?}\nmaterial = \"stone\"\njoint = \"dry\"\n");
        let (scene, load) = match (self.load, self.fill) {
            (Load::Axles([a, b], length), Some([cover, density])) => (
                format!(
                    "scene = \"bridge\"\n{common}spans = [{{ {ring} }}]\nfill = {{ cover = {cover:?}, density = {density:?} }}\n\
                     {}[vehicles.two]\naxles = [{{ at = 0.0, force = 1.0, length = {length:?} }}, \
                     {{ at = {:?}, force = 1.0, length = {length:?} }}]\n",
                    self.table(),
                    b - a
                ),
                format!("{{ kind = \"vehicle\", vehicle = \"two\", at = {a:?} }}"),
            ),
            (Load::Fraction(at), _) => (
                format!(
                    "scene = \"arch\"\n{common}{}\n{}",
                    ring.replace(", thickness", "\nthickness").replace(", voussoirs", "\nvoussoirs"),
                    self.table()
                ),
                format!("{{ kind = \"point\", span_fraction = {at:?}, force = [0.0, -1.0] }}"),
            ),
            other => panic!("{other:?}"),
        };
        format!("name = \"abutments\"\n[scene]\n{scene}{}", self.rest(&load))
    }
}

/// A joint: first block, second block on the right of the direction between the ends (`None` is the ground), and its
/// friction.
struct Contact {
    on: [Option<usize>; 2],
    ends: [Point; 2],
    friction: f64,
}

/// Polygons, joints and forces.
struct Parts {
    blocks: Vec<Vec<Point>>,
    contacts: Vec<Contact>,
    /// Upper faces from left to right: block, ends.
    faces: Vec<(usize, [Point; 2])>,
    /// Ground behind abutments: block, sense of its force, height above y = 0, greatest force.
    backings: Vec<(usize, f64, f64, f64)>,
    /// Blocks of the abutments, left and right.
    abutments: [Option<usize>; 2],
}

/// Returns area and first moments of a polygon in anticlockwise order.
fn moments(polygon: &[Point]) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for (i, [x, y]) in polygon.iter().enumerate() {
        let [u, v] = polygon[(i + 1) % polygon.len()];
        let cross = x * v - u * y;
        sum[0] += cross / 2.0;
        sum[1] += cross * (x + u) / 6.0;
        sum[2] += cross * (y + v) / 6.0;
    }
    sum
}

fn height(face: &[Point; 2], x: f64) -> f64 {
    face[0][1] + (face[1][1] - face[0][1]) * (x - face[0][0]) / (face[1][0] - face[0][0])
}

impl Scene {
    /// Returns the polygons with the left springing at x = 0.
    fn parts(&self) -> Parts {
        let radius = self.span * self.span / (8.0 * self.rise) + self.rise / 2.0;
        let half = if self.rise <= self.span / 2.0 { 1.0 } else { -1.0 };
        let half = (half * (1.0 - (self.span / 2.0 / radius).powi(2)).max(0.0).sqrt()).acos();
        let at = |k: usize, radius_at: f64| -> Point {
            let angle = half * (1.0 - 2.0 * k as f64 / self.voussoirs as f64);
            [self.span / 2.0 - radius_at * angle.sin(), self.rise - radius + radius_at * angle.cos()]
        };
        let joint = |k: usize| [at(k, radius), at(k, radius + self.thickness)];
        let mut parts = Parts {
            blocks: Vec::new(),
            contacts: Vec::new(),
            faces: Vec::new(),
            backings: Vec::new(),
            abutments: [None, None],
        };
        for k in 0..self.voussoirs {
            let ([a, b], [c, d]) = (joint(k), joint(k + 1));
            parts.blocks.push(vec![a, c, d, b]);
            parts.faces.push((k, [b, d]));
        }
        for (side, own) in self.abutments.iter().enumerate() {
            let Some(Abutment { width, height, friction, backing }) = *own else { continue };
            let sense = [-1.0, 1.0][side];
            let [inner, outer] = joint([0, self.voussoirs][side]);
            let (far, foot) = (inner[0] + sense * width, inner[1] - height);
            let mut polygon = vec![[inner[0], foot], [far, foot], [far, outer[1]], outer, inner];
            let mut base = [[far, foot], [inner[0], foot]];
            let mut top = [outer, [far, outer[1]]];
            if side == 0 {
                polygon.reverse();
                base.reverse();
                top.reverse();
            }
            let block = parts.blocks.len();
            parts.blocks.push(polygon);
            parts.contacts.push(Contact { on: [None, Some(block)], ends: base, friction });
            let place = if side == 0 { 0 } else { parts.faces.len() };
            parts.faces.insert(place, (block, top));
            let back = outer[1] - foot;
            parts.backings.push((block, -sense, foot + back / 2.0, backing * back * self.width));
            parts.abutments[side] = Some(block);
        }
        for k in 0..=self.voussoirs {
            let before = if k == 0 { parts.abutments[0] } else { Some(k - 1) };
            let after = if k == self.voussoirs { parts.abutments[1] } else { Some(k) };
            parts.contacts.push(Contact { on: [before, after], ends: joint(k), friction: self.friction });
        }
        parts
    }

    /// Returns the live forces downwards: block, x, force.
    fn live(&self, parts: &Parts) -> Vec<(usize, f64, f64)> {
        let covering = |x: f64| parts.faces.iter().find(|(_, face)| face[0][0] <= x && x < face[1][0]);
        match self.load {
            Load::Fraction(at) => {
                let x = at * self.span;
                covering(x).map(|(block, _)| (*block, x, 1.0)).into_iter().collect()
            }
            Load::Axles(axles, length) => {
                let mut forces = Vec::new();
                // An axle without a face under its centre is ignored.
                for x in axles.into_iter().filter(|x| covering(*x).is_some()) {
                    let (from, to) = (x - length / 2.0, x + length / 2.0);
                    for (block, face) in &parts.faces {
                        let (low, high) = (face[0][0].max(from), face[1][0].min(to));
                        if high > low {
                            forces.push((*block, (low + high) / 2.0, (high - low) / length));
                        }
                    }
                }
                forces
            }
        }
    }

    /// Returns the dead loads of each block: force and moment about the origin that the joints must balance.
    fn dead(&self, parts: &Parts) -> Vec<[f64; 3]> {
        let mut right = vec![[0.0; 3]; parts.blocks.len()];
        for (block, polygon) in parts.blocks.iter().enumerate() {
            let [area, moment, _] = moments(polygon);
            let weight = GRAVITY * DENSITY * self.width;
            right[block][1] += weight * area;
            right[block][2] += weight * moment;
        }
        let Some([cover, density]) = self.fill else { return right };
        let road = self.rise + self.thickness + cover;
        for (block, face) in &parts.faces {
            let [x, u] = [face[0][0], face[1][0]];
            let column = vec![face[0], face[1], [u, road], [x, road]];
            let [area, moment, _] = moments(&column);
            right[*block][1] += GRAVITY * density * self.width * area;
            right[*block][2] += GRAVITY * density * self.width * moment;
        }
        right
    }

    /// Returns the greatest λ; `None` if the program has no solution.
    fn load_factor(&self) -> Option<f64> {
        let parts = self.parts();
        let joints = parts.contacts.len();
        let variables = 3 * joints + parts.backings.len() + 1;
        let mut rows = Rows::new(variables);
        for (j, Contact { on, ends: [a, b], .. }) in parts.contacts.iter().enumerate() {
            let (h, p) = ((b[0] - a[0]).hypot(b[1] - a[1]), [(a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0]);
            let t = [(b[0] - a[0]) / h, (b[1] - a[1]) / h];
            let n = [t[1], -t[0]];
            for (block, sign) in [(on[0], -1.0), (on[1], 1.0)] {
                let Some(block) = block else { continue };
                for (variable, [x, y]) in [(3 * j, n), (3 * j + 1, t)] {
                    let values = [x, y, p[0] * y - p[1] * x];
                    (0..3).for_each(|d| rows.entry(3 * block + d, variable, sign * values[d]));
                }
                rows.entry(3 * block + 2, 3 * j + 2, sign);
            }
        }
        for (i, (block, sense, y, _)) in parts.backings.iter().enumerate() {
            rows.entry(3 * block, 3 * joints + i, *sense);
            rows.entry(3 * block + 2, 3 * joints + i, -sense * y);
        }
        for (block, x, force) in self.live(&parts) {
            rows.entry(3 * block + 1, variables - 1, -force);
            rows.entry(3 * block + 2, variables - 1, -force * x);
        }
        rows.right = self.dead(&parts).concat();
        rows.linear_from = rows.right.len();
        for (j, Contact { ends: [a, b], friction, .. }) in parts.contacts.iter().enumerate() {
            let h = (b[0] - a[0]).hypot(b[1] - a[1]);
            for sign in [-1.0, 1.0] {
                rows.row(&[(3 * j + 1, sign), (3 * j, -friction)], 0.0);
                rows.row(&[(3 * j + 2, sign), (3 * j, -h / 2.0)], 0.0);
            }
        }
        for (i, (.., most)) in parts.backings.iter().enumerate() {
            rows.row(&[(3 * joints + i, 1.0)], *most);
            rows.row(&[(3 * joints + i, -1.0)], 0.0);
        }
        if let Some(strength) = self.crushing {
            rows.cones_from = rows.right.len();
            let typical = rows.typical();
            for (j, Contact { ends: [a, b], .. }) in parts.contacts.iter().enumerate() {
                let h = (b[0] - a[0]).hypot(b[1] - a[1]);
                rows.stress_block([3 * j, 3 * j + 2], h, [strength * h * self.width, 0.0], typical);
            }
        }
        match rows.extreme(variables - 1, 1.0) {
            Extreme::Value(factor) => Some(factor),
            _ => None,
        }
    }

    /// Returns the same scene as polygons of the scene `blocks`, in this order of the blocks, without backing.
    fn as_blocks(&self, order: impl Fn(usize) -> usize) -> String {
        let parts = self.parts();
        let block = |name: String, polygon: &[Point], more: &str| {
            let corners: Vec<String> = polygon.iter().map(|[x, y]| format!("[{x:?}, {y:?}]")).collect();
            format!("{{ name = \"{name}\", vertices = [{}]{more} }}", corners.join(", "))
        };
        let count = parts.blocks.len();
        let mut blocks: Vec<String> =
            (0..count).map(|i| order(i) % count).map(|i| block(format!("b{i}"), &parts.blocks[i], "")).collect();
        let (mut pairs, mut laws) = (Vec::new(), String::new());
        for (i, contact) in parts.contacts.iter().enumerate() {
            let (Some(own), ground) = (match contact.on {
                [None, Some(own)] => (Some(own), 1.0),
                [Some(own), None] => (Some(own), -1.0),
                _ => (None, 0.0),
            }) else {
                continue;
            };
            let [a, b] = contact.ends;
            let off = [-ground * (b[1] - a[1]) * 0.3, ground * (b[0] - a[0]) * 0.3];
            let [c, d] = [b, a].map(|p| [p[0] + off[0], p[1] + off[1]]);
            let mut polygon = vec![a, b, c, d];
            if moments(&polygon)[0] < 0.0 {
                polygon.reverse();
            }
            blocks.push(block(format!("g{i}"), &polygon, ", fixed = true"));
            let strength = self.crushing.map(|own| format!("compressive_strength = {own:?}\n")).unwrap_or_default();
            let friction = contact.friction;
            pairs.push(format!("{{ between = [\"g{i}\", \"b{own}\"], joint = \"g{i}\" }}"));
            laws += &format!("[joints.g{i}]\nlaw = \"mohr_coulomb\"\nfriction = {friction:?}\n{strength}");
        }
        let Load::Fraction(at) = self.load else { panic!("a load at a fraction") };
        let x = at * self.span;
        let (own, face) = parts.faces.iter().find(|(_, face)| face[0][0] <= x && x < face[1][0]).expect("a face");
        let load = format!(
            "{{ kind = \"point\", block = \"b{own}\", point = [{x:?}, {:?}], force = [0.0, -1.0] }}",
            height(face, x)
        );
        format!(
            "name = \"blocks\"\n[scene]\nscene = \"blocks\"\nwidth = {:?}\nmaterial = \"stone\"\njoint = \"dry\"\n\
             blocks = [\n{}\n]\npairs = [{}]\n{laws}{}",
            self.width,
            blocks.join(",\n"),
            pairs.join(", "),
            self.rest(&load)
        )
    }
}

/// Returns the greatest load factor of a result: that of collapse, or the upper end of the feasible interval if dead load
/// alone fails.
fn greatest(result: &CaseResult) -> Option<f64> {
    match result.status {
        Status::Collapse => result.load_factor.filter(|_| result.certificate.passed),
        Status::NoEquilibrium => result.feasible_interval.and_then(|interval| interval[1]),
        _ => None,
    }
}

/// Compares random scenes with the independent program. `VOUSSOIR_ABUTMENTS` sets the number of scenes of each kind.
fn compare(crushing: bool, tolerance: f64) {
    let count = std::env::var("VOUSSOIR_ABUTMENTS").ok().and_then(|count| count.parse().ok()).unwrap_or(12);
    let (mut collapses, mut moving, mut wrong) = (0u64, 0u64, Vec::new());
    for bridge in [false, true] {
        for seed in 0..count {
            let scene = Scene::random(seed, crushing, bridge);
            let (result, expected) = (answered(&scene.study()), scene.load_factor());
            let same = match (expected, greatest(&result)) {
                (Some(expected), Some(factor)) => (factor - expected).abs() <= tolerance * expected.abs(),
                (None, None) => matches!(result.status, Status::NoEquilibrium | Status::Unbounded),
                _ => false,
            };
            collapses += u64::from(result.status == Status::Collapse);
            let base = |between: &[String; 2]| between[1].ends_with("_abutment") || between[0].ends_with("_abutment");
            let moves = result.mechanism.as_ref().is_some_and(|own| {
                own.hinges
                    .iter()
                    .any(|hinge| base(&hinge.between) && ["left", "right"].contains(&hinge.between[0].as_str()))
                    || own.sliding.iter().any(|slip| base(&slip.between))
            });
            moving += u64::from(moves);
            if !same {
                let said = format!("{:?} {:?} {:?}", result.status, greatest(&result), result.notes);
                wrong.push(format!("{seed}: {said}, but {expected:?}\n{}", scene.study()));
            }
        }
    }
    println!("{collapses} of {} collapse, an abutment moves in {moving}, {} wrong", 2 * count, wrong.len());
    assert!(wrong.is_empty(), "{} wrong\n{}", wrong.len(), wrong.join("\n"));
    assert!(2 * collapses >= count && 4 * moving >= count, "{collapses} collapse, {moving} with a moving abutment");
}

/// Random arches and bridges on abutments carry the load of an independent program of polygons, to 1e-6.
#[test]
fn abutments_carry_the_load_of_a_program_of_polygons() {
    compare(false, 1e-6);
}

/// With crushing of all joints, bases included, they carry its load to 2e-5.
#[test]
fn abutments_with_crushing_carry_the_load_of_a_program_of_polygons() {
    compare(true, 2e-5);
}

/// Mirror images carry the same load, and so do the polygons of the scene in any order.
#[test]
fn reflection_and_numbering_of_abutments_do_not_matter() {
    let mut compared = 0;
    for seed in 0..16 {
        for bridge in [false, true] {
            let scene = Scene::random(100 + seed, seed % 2 == 0, bridge);
            let (plain, mirrored) = (answered(&scene.study()), answered(&scene.mirrored().study()));
            assert_eq!(plain.status, mirrored.status, "{}", scene.study());
            if let (Some(plain), Some(mirrored)) = (greatest(&plain), greatest(&mirrored)) {
                assert_close(mirrored, plain, 1e-9);
            }
            if bridge || plain.status != Status::Collapse {
                continue;
            }
            let bare = |own: Abutment| Abutment { backing: 0.0, ..own };
            let scene = Scene { abutments: scene.abutments.map(|own| own.map(bare)), ..scene };
            let result = answered(&scene.study());
            if result.status != Status::Collapse {
                continue;
            }
            let count = scene.parts().blocks.len();
            for order in [(1, 0), (count - 1, 0), (1, count / 2)] {
                let blocks = collapse_factor(&scene.as_blocks(|i| order.0 * i + order.1 + count));
                assert_close(blocks, result.load_factor.expect("a factor"), 1e-8);
            }
            compared += 1;
        }
    }
    assert!(compared >= 3, "{compared}");
}

/// The path of elastic blocks on elastic abutments ends at the load of rigid blocks, and its certificate passes.
#[test]
fn paths_of_elastic_arches_on_abutments_end_at_their_limit_load() {
    let mut compared = 0;
    for seed in 0..6 {
        let text = Scene::random(seed, false, false).study();
        let rigid = answered(&text);
        if rigid.status != Status::Collapse {
            continue;
        }
        let elastic = changed(&text, "law = \"rigid\"", "law = \"elastic\"\nyoung_modulus = 5e9\npoisson_ratio = 0.2");
        let elastic = changed(&elastic, "[materials.stone]", "[scene.mesh]\nelements = [1, 4]\n[materials.stone]");
        assert_close(collapse_factor(&elastic), rigid.load_factor.expect("a factor"), 1e-8);
        compared += 1;
    }
    assert!(compared >= 3, "{compared}");
}
