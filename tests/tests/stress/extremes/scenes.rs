//! Scenes with extreme numbers. Each has an answer that is known without solving it: by hand, or by a change of units,
//! size or stiffness that must not matter.

use std::f64::consts::PI;
use voussoir::core::limit::Status;
use voussoir_tests::{Arch, Wall, changed, compliant, crushing, elastic, friction};

/// The known answer.
#[derive(Debug, Clone, Copy)]
pub enum Known {
    /// The load factor, with a relative tolerance.
    Factor(f64, f64),
    /// The status.
    Ends(Status),
    /// At the border between two answers both are right: a factor above this one, or any of these statuses.
    Edge(&'static [Status], f64),
}

/// A scene; its text has `SOLVER` instead of the solver.
pub struct Extreme {
    pub family: &'static str,
    pub name: String,
    pub text: String,
    pub solvers: &'static [&'static str],
    pub known: Known,
}

/// Limit solvers for rings.
const CHAIN: &[&str] = &["limit_chain", "limit_conic"];
/// All solvers for rigid blocks with facets of friction.
const RIGID: &[&str] = &["limit_chain", "limit_conic", "limit_sequential"];
const WALLS: &[&str] = &["limit_conic", "limit_sequential"];
const PATHS: &[&str] = &["limit_conic", "event_path", "newton_path"];
const FINITE: &[&str] = &["newton_path"];

/// One block on the ground that is pushed, with closed forms.
#[derive(Debug, Clone)]
struct OneBlock {
    /// Length along the ground, and height.
    size: [f64; 2],
    /// Share of the length that is in contact with the ground, from the left.
    seated: f64,
    /// Slope of the ground, anticlockwise.
    slope: f64,
    density: f64,
    gravity: [f64; 2],
    /// Point of action of the load, in shares of the block.
    at: [f64; 2],
    force: [f64; 2],
    joint: String,
}

impl OneBlock {
    fn new() -> OneBlock {
        OneBlock {
            size: [1.0, 0.5],
            seated: 1.0,
            slope: 0.0,
            density: 2000.0,
            gravity: [0.0, -9.81],
            at: [0.5, 0.0],
            force: [1000.0, 0.0],
            joint: friction(0.5),
        }
    }

    /// Returns the weight ρ b h g, for unit width.
    fn weight(&self) -> f64 {
        self.density * self.size[0] * self.size[1] * self.gravity[0].hypot(self.gravity[1])
    }

    fn study(&self) -> String {
        let ([b, h], (sin, cos)) = (self.size, self.slope.sin_cos());
        let turn = |[x, y]: [f64; 2]| [cos * x - sin * y, sin * x + cos * y];
        let quad = |x: f64, y0: f64, y1: f64| [[0.0, y0], [x, y0], [x, y1], [0.0, y1]].map(turn);
        let below = b.min(h).min(b * self.seated);
        let (ground, block) = (quad(b * self.seated, -below, 0.0), quad(b, 0.0, h));
        let (point, force) = (turn([self.at[0] * b, self.at[1] * h]), turn(self.force));
        format!(
            r#"name = "one block"
[scene]
scene = "blocks"
width = 1.0
material = "stone"
joint = "dry"
blocks = [{{ name = "ground", fixed = true, vertices = {ground:?} }}, {{ name = "block", vertices = {block:?} }}]
[materials.stone]
law = "rigid"
density = {:?}
[joints.dry]
{}
[solver]
solver = "SOLVER"
[[stages]]
name = "dead"
gravity = {:?}
[[stages]]
name = "live"
until = "collapse"
loads = [{{ kind = "point", block = "block", point = {point:?}, force = {force:?} }}]
"#,
            self.density, self.joint, self.gravity
        )
    }
}

/// Returns the ring of all families: nine voussoirs between springers.
fn ring() -> Arch {
    Arch { voussoirs: 9, ends: "jointed", span_fraction: 0.3, solver: "SOLVER", ..Arch::default() }
}

/// Returns a ring and its load s times as large, of the same stone.
fn scaled(arch: &Arch, s: f64) -> Arch {
    Arch {
        span: arch.span * s,
        rise: arch.rise * s,
        thickness: arch.thickness * s,
        width: arch.width * s,
        load: arch.load * s.powi(3),
        ..arch.clone()
    }
}

/// Collects the scenes of one family.
struct Family<'a> {
    all: &'a mut Vec<Extreme>,
    family: &'static str,
    solvers: &'static [&'static str],
}

impl Family<'_> {
    fn add(&mut self, name: String, text: String, known: Known) {
        self.all.push(Extreme { family: self.family, name, text, solvers: self.solvers, known });
    }
}

/// Returns all scenes. `factor` solves the scenes with ordinary numbers that other scenes are compared with.
pub fn all(factor: impl Fn(&str) -> f64) -> Vec<Extreme> {
    let mut all = Vec::new();
    one_block(&mut all);
    slopes(&mut all);
    edges(&mut all);
    rings(&mut all, &factor);
    strengths(&mut all, &factor);
    units(&mut all, &factor);
    walls(&mut all, &factor);
    stiffness(&mut all, &factor);
    finite(&mut all, &factor);
    all
}

/// Known load: min(μ, b/2h at the height of the push) times the weight.
fn one_block(all: &mut Vec<Extreme>) {
    let mut family = Family { all, family: "one block", solvers: RIGID };
    let tight = |x: f64| Known::Factor(x, 1e-9);
    for e in [-3.0, -1.0, 1.0, 3.0] {
        let s = 10f64.powf(e);
        let block = OneBlock { size: [s, 0.5 * s], ..OneBlock::new() };
        family.add(format!("size {s:e} m"), block.study(), tight(0.5 * block.weight() / 1000.0));
    }
    for density in [1e-9, 1e-3, 1e6, 1e12] {
        let block = OneBlock { density, ..OneBlock::new() };
        family.add(format!("{density:e} kg/m3"), block.study(), tight(0.5 * block.weight() / 1000.0));
    }
    for load in [1e-9, 1e-3, 1e9, 1e15] {
        let block = OneBlock { force: [load, 0.0], ..OneBlock::new() };
        family.add(format!("load {load:e} N"), block.study(), tight(0.5 * block.weight() / load));
    }
    for mu in [1e-12, 1e-9, 1e-6, 1e-3, 1e3] {
        // Pushed at the foot the block slides, with any friction; it cannot rotate.
        let block = OneBlock { joint: friction(mu), ..OneBlock::new() };
        family.add(format!("friction {mu:e}"), block.study(), tight(mu * block.weight() / 1000.0));
    }
    // Pushed at the top it rotates about its foot: λ F h = W b/2.
    for ratio in [1e-6, 1e-3, 1.0, 1e3, 1e6] {
        let block = OneBlock { size: [ratio, 1.0], at: [0.5, 1.0], joint: friction(1e9), ..OneBlock::new() };
        family.add(format!("b/h {ratio:e}"), block.study(), tight(0.5 * ratio * block.weight() / 1000.0));
    }
    for mu in [1.0 - 1e-12, 1.0, 1.0 + 1e-12] {
        // It slides and rotates at the same load.
        let block = OneBlock { at: [0.5, 1.0], joint: friction(mu), ..OneBlock::new() };
        family.add(format!("turns and slides, {:e}", mu - 1.0), block.study(), tight(block.weight() / 1000.0));
    }
    // A joint of almost no length: the block rests on slightly more than one half and overturns at W x.
    for share in [1e-9, 1e-6, 1e-3] {
        let block = OneBlock { seated: 0.5 + share, at: [0.5, 1.0], joint: friction(1e3), ..OneBlock::new() };
        let arm = share * block.size[0] / block.size[1];
        family.add(format!("stands by {share:e}"), block.study(), Known::Factor(arm * block.weight() / 1000.0, 1e-5));
    }
    for share in [1e-9, 1e-6, 1e-3] {
        let block = OneBlock { seated: share, ..OneBlock::new() };
        family.add(format!("seated on {share:e}"), block.study(), Known::Ends(Status::NoEquilibrium));
    }
    // Without gravity, with gravity upwards, and with gravity sideways, where it slides off.
    let lifted = OneBlock { gravity: [0.0, 9.81], ..OneBlock::new() };
    family.add("gravity upwards".into(), lifted.study(), Known::Ends(Status::NoEquilibrium));
    let across = OneBlock { gravity: [9.81, 0.0], ..OneBlock::new() };
    family.add("gravity across".into(), across.study(), Known::Ends(Status::NoEquilibrium));
    let floating = OneBlock { gravity: [0.0, 0.0], ..OneBlock::new() };
    family.add("gravity off, pushed across".into(), floating.study(), Known::Edge(&[Status::NoEquilibrium], 0.0));
    let pressed = OneBlock { force: [0.0, -1.0], ..floating.clone() };
    family.add("gravity off, pressed".into(), pressed.study(), Known::Ends(Status::Unbounded));
    let lifted = OneBlock { force: [0.0, 1.0], ..OneBlock::new() };
    family.add("lifted".into(), lifted.study(), tight(lifted.weight()));
}

/// A block on a slope: downhill it carries μ cos α − sin α times the weight, and nothing at the angle of friction.
fn slopes(all: &mut Vec<Extreme>) {
    let mut family = Family { all, family: "slope", solvers: RIGID };
    let mu = 0.5_f64;
    for below in [1e-9, 1e-6, 1e-3] {
        let slope = mu.atan() - below;
        // The load acts at the foot of the block, down the slope; the block is flat enough not to rotate.
        let block = OneBlock { size: [1.0, 0.1], slope, force: [-1000.0, 0.0], ..OneBlock::new() };
        let room = (mu * slope.cos() - slope.sin()) * block.weight() / 1000.0;
        family.add(format!("{below:e} rad below friction"), block.study(), Known::Factor(room, 1e-4));
        let steep = OneBlock { slope: mu.atan() + below, ..block };
        family.add(format!("{below:e} rad above friction"), steep.study(), Known::Ends(Status::NoEquilibrium));
    }
    let block = OneBlock { size: [1.0, 0.1], slope: mu.atan(), force: [-1000.0, 0.0], ..OneBlock::new() };
    family.add("at the angle of friction".into(), block.study(), Known::Edge(&[Status::NoEquilibrium], 0.0));
}

/// Loads at the edge of the friction cone and on vertices.
fn edges(all: &mut Vec<Extreme>) {
    let mut family = Family { all, family: "edge of a cone", solvers: RIGID };
    let mu = 0.5_f64;
    for beside in [1e-9, 1e-6, 1e-3] {
        let pushed = |angle: f64| OneBlock { force: [1e3 * angle.sin(), -1e3 * angle.cos()], ..OneBlock::new() };
        let outside = mu.atan() + beside;
        let block = pushed(outside);
        let factor = mu * block.weight() / 1e3 / (outside.sin() - mu * outside.cos());
        // The difference of two nearly equal numbers loses this number of digits.
        let digits = (1e-15 / beside).max(1e-9) * 10.0;
        family.add(format!("{beside:e} rad outside"), block.study(), Known::Factor(factor, digits));
        family.add(
            format!("{beside:e} rad inside"),
            pushed(mu.atan() - beside).study(),
            Known::Ends(Status::Unbounded),
        );
    }
    let exact = OneBlock { force: [1000.0, -2000.0], ..OneBlock::new() };
    family.add("on the cone".into(), exact.study(), Known::Edge(&[Status::Unbounded], 1e9));
    for (name, at, known) in [
        ("pressed on its corner", [1.0, 1.0], Known::Edge(&[Status::Unbounded], 1e9)),
        ("pressed at its foot", [1.0, 0.0], Known::Edge(&[Status::Unbounded], 1e9)),
        ("pressed beside its corner", [1.0 - 1e-9, 1.0], Known::Edge(&[Status::Unbounded], 1e9)),
    ] {
        let block = OneBlock { at, force: [0.0, -1000.0], ..OneBlock::new() };
        family.add(name.into(), block.study(), known);
    }
}

/// A ring of any size, weight and load, with very small or very large friction.
fn rings(all: &mut Vec<Extreme>, factor: &impl Fn(&str) -> f64) {
    let mut family = Family { all, family: "ring", solvers: RIGID };
    let base = ring();
    let reference = factor(&base.study());
    let tight = |x: f64| Known::Factor(x, 1e-9);
    for span in [1e-3, 1e-1, 1e2, 1e3] {
        let arch = scaled(&base, span / base.span);
        family.add(format!("span {span:e} m"), arch.study(), tight(reference));
    }
    for density in [1e-6, 1e9] {
        let known = tight(reference * density / base.density);
        family.add(format!("{density:e} kg/m3"), Arch { density, ..base.clone() }.study(), known);
    }
    for load in [1e-6, 1e12] {
        let known = tight(reference * base.load / load);
        family.add(format!("load {load:e} N"), Arch { load, ..base.clone() }.study(), known);
    }
    let rough = factor(&Arch { joint: "law = \"unilateral\"".into(), ..base.clone() }.study());
    for mu in [1e3, 1e6, 1e12] {
        family.add(format!("friction {mu:e}"), Arch { joint: friction(mu), ..base.clone() }.study(), tight(rough));
    }
    for mu in [0.0, 1e-12, 1e-6] {
        let arch = Arch { joint: friction(mu), ..base.clone() };
        family.add(format!("friction {mu:e}"), arch.study(), Known::Ends(Status::NoEquilibrium));
    }
    for thickness in [1e-6, 1e-3] {
        let arch = Arch { thickness, ..base.clone() };
        family.add(format!("thickness {thickness:e} m"), arch.study(), Known::Ends(Status::NoEquilibrium));
    }
    let upside_down = changed(&base.study(), "gravity = 9.81", "gravity = [0.0, 9.81]");
    family.add("gravity upwards".into(), upside_down, Known::Ends(Status::NoEquilibrium));
    let mut chains = Family { solvers: CHAIN, ..family };
    // Slivers: the load is on a joint of each division, and only the joint below it matters.
    for voussoirs in [300, 3000] {
        let arch = Arch { voussoirs, ..base.clone() };
        let near = factor(&changed(&arch.study(), "0.3,", "0.3000000001,"));
        chains.add(format!("{voussoirs} slivers"), arch.study(), Known::Factor(near, 1e-6));
    }
}

/// Crushing strengths from below the weight to beyond rounding.
fn strengths(all: &mut Vec<Extreme>, factor: &impl Fn(&str) -> f64) {
    let mut family = Family { all, family: "strength", solvers: CHAIN };
    let base = ring();
    let reference = factor(&base.study());
    for exponent in [-3, 1, 3] {
        let arch = Arch { joint: crushing(0.6, 10f64.powi(exponent)), ..base.clone() };
        family.add(format!("1e{exponent} Pa"), arch.study(), Known::Ends(Status::NoEquilibrium));
    }
    // A hinge crushes over N/f of its height: the load differs from the load without crushing by this share.
    for (exponent, within) in [(9, 1e-2), (12, 1e-5), (15, 1e-8), (18, 1e-8), (30, 1e-8)] {
        let arch = Arch { joint: crushing(0.6, 10f64.powi(exponent)), ..base.clone() };
        family.add(format!("1e{exponent} Pa"), arch.study(), Known::Factor(reference, within));
    }
    let crushed = Arch { joint: crushing(0.6, 5e6), ..base.clone() };
    let known = factor(&crushed.study());
    for s in [1e-4, 1e-2, 1e2] {
        let arch = Arch { joint: crushing(0.6, 5e6 * s), ..scaled(&base, s) };
        family.add(format!("size and strength {s:e}"), arch.study(), Known::Factor(known, 1e-9));
    }
}

/// The same ring in other units.
fn units(all: &mut Vec<Extreme>, factor: &impl Fn(&str) -> f64) {
    let mut family = Family { all, family: "units", solvers: RIGID };
    let base = Arch { joint: crushing(0.6, 5e6), ..ring() };
    let text = base.study();
    let reference = factor(&text);
    let lengths: [(&str, f64); 4] = [("mm", 1e-3), ("ft", 0.3048), ("in", 0.0254), ("m", 1.0)];
    let forces: [(&str, f64); 4] = [("kN", 1e3), ("lbf", 4.4482216152605), ("MN", 1e6), ("N", 1.0)];
    let stresses: [(&str, f64); 4] = [("kPa", 1e3), ("psi", 6894.757293168361), ("N/mm2", 1e6), ("GPa", 1e9)];
    for (((length, m), (force, n)), (stress, pa)) in lengths.iter().zip(forces).zip(stresses) {
        let mut said = text.clone();
        for (key, value) in
            [("span = ", base.span), ("rise = ", base.rise), ("thickness = ", base.thickness), ("width = ", base.width)]
        {
            said = changed(&said, &format!("{key}{value:?}"), &format!("{key}\"{:?} {length}\"", value / m));
        }
        said = changed(&said, "-1000.0]", &format!("\"{:?} {force}\"]", -1000.0 / n));
        said = changed(&said, "5000000.0", &format!("\"{:?} {stress}\"", 5e6 / pa));
        family.add(format!("{length}, {force}, {stress}"), said, Known::Factor(reference, 1e-11));
    }
}

/// Bricks of any size and shape, pushed in all directions under gravity in all directions.
fn walls(all: &mut Vec<Extreme>, factor: &impl Fn(&str) -> f64) {
    let mut family = Family { all, family: "wall", solvers: WALLS };
    let base = Wall { solver: "solver = \"SOLVER\"".into(), ..Wall::in_bond(4, 3) };
    let reference = factor(&base.study());
    let tight = |x: f64| Known::Factor(x, 1e-9);
    for s in [1e-4, 1e-2, 1e2, 1e4] {
        let wall = Wall { brick: base.brick.map(|x| x * s), width: s, ..base.clone() };
        family.add(format!("size {s:e}"), wall.study(), tight(reference));
    }
    for density in [1e-6, 1e9] {
        family.add(format!("{density:e} kg/m3"), Wall { density, ..base.clone() }.study(), tight(reference));
    }
    for push in [1e-9, 1e9] {
        let wall = Wall { push: [push, 0.0], ..base.clone() };
        family.add(format!("pushed by {push:e} m/s2"), wall.study(), tight(reference * 9.81 / push));
    }
    for mu in [0.0, 1e-12, 1e-9, 1e-6] {
        // The uppermost course slides.
        let wall = Wall { joint: friction(mu), ..base.clone() };
        let known = if mu > 0.0 { tight(mu) } else { Known::Edge(&[Status::NoEquilibrium], 0.0) };
        family.add(format!("friction {mu:e}"), wall.study(), known);
    }
    let rough = factor(&Wall { joint: "law = \"unilateral\"".into(), ..base.clone() }.study());
    for mu in [1e3, 1e6] {
        family.add(format!("friction {mu:e}"), Wall { joint: friction(mu), ..base.clone() }.study(), tight(rough));
    }
    for (name, push, known) in [
        ("pushed down", [0.0, -9.81], Known::Ends(Status::Unbounded)),
        ("lifted", [0.0, 9.81], Known::Factor(1.0, 1e-9)),
        ("pushed back", [-9.81, 0.0], tight(reference)),
    ] {
        // In running bond the wall is its own mirror image.
        family.add(name.into(), Wall { push, ..base.clone() }.study(), known);
    }
    let upwards = changed(&base.study(), "gravity = 9.81", "gravity = [0.0, 9.81]");
    family.add("gravity upwards".into(), upwards, Known::Ends(Status::NoEquilibrium));
    let off = Wall { gravity: 0.0, ..base.clone() };
    family.add("gravity off".into(), off.study(), Known::Edge(&[Status::NoEquilibrium], 0.0));
    let flat = Wall { brick: [0.4, 0.4e-6], ..base.clone() };
    family.add("slivers a millionth as high as long".into(), flat.study(), tight(0.65));
    let slender = Wall { brick: [0.4e-4, 0.4], ..base.clone() };
    // λ of a tower of bricks of almost no length: it overturns at a slope equal to its slenderness, or less.
    family.add(
        "slivers ten thousand times as high as long".into(),
        slender.study(),
        Known::Edge(&[Status::Collapse], 0.0),
    );
}

/// Elastic blocks and compliant joints under small displacements: for any stiffness they end at the load of limit
/// analysis.
fn stiffness(all: &mut Vec<Extreme>, factor: &impl Fn(&str) -> f64) {
    let mut family = Family { all, family: "stiffness", solvers: PATHS };
    let base = Arch { voussoirs: 7, ..ring() };
    let reference = factor(&base.study());
    let known = Known::Factor(reference, 1e-7);
    let joints = |kn: f64, ks: f64| Arch { joint: compliant(&friction(0.6), kn, ks), ..base.clone() };
    for kn in [1.0, 1e5, 1e15] {
        for ratio in [1e-9, 1e-3, 1.0, 1e3, 1e9] {
            family.add(format!("joints {kn:e} Pa/m, shear {ratio:e} of it"), joints(kn, kn * ratio).study(), known);
        }
    }
    let mesh = "elements = [1, 2]\norder = 2".to_string();
    let blocks = |e: f64, nu: f64| Arch { material: elastic(e, nu), mesh: mesh.clone(), ..base.clone() };
    for e in [1.0, 1e3, 1e6, 1e9, 1e12, 1e15] {
        family.add(format!("E {e:e} Pa"), blocks(e, 0.2).study(), known);
    }
    for nu in [-0.99, 0.0, 0.49, 0.4999999] {
        family.add(format!("Poisson's ratio {nu}"), blocks(1e10, nu).study(), known);
    }
    for (e, kn) in [(1e3, 1e15), (1e15, 1e3), (1e10, 1e10)] {
        let arch = Arch { joint: compliant(&friction(0.6), kn, kn), ..blocks(e, 0.2) };
        family.add(format!("E {e:e} Pa, joints {kn:e} Pa/m"), arch.study(), known);
    }
    for span in [1e-3, 1e3] {
        let s = span / base.span;
        family.add(format!("span {span:e} m, E 1e10 Pa"), scaled(&blocks(1e10, 0.2), s).study(), known);
        family.add(format!("span {span:e} m, joints 1e10 Pa/m"), scaled(&joints(1e10, 1e10), s).study(), known);
    }
    let slippery = Arch { joint: compliant(&friction(1e-12), 1e10, 1e10), ..base.clone() };
    family.add("friction 1e-12".into(), slippery.study(), Known::Ends(Status::NoEquilibrium));
    let rough = Arch { joint: compliant(&friction(1e6), 1e10, 1e10), ..base.clone() };
    let unilateral = factor(&Arch { joint: "law = \"unilateral\"".into(), ..base.clone() }.study());
    family.add("friction 1e6".into(), rough.study(), Known::Factor(unilateral, 1e-7));
}

/// Finite displacements: a ring s times as large is the same problem if E is also s times as large.
fn finite(all: &mut Vec<Extreme>, factor: &impl Fn(&str) -> f64) {
    let mut family = Family { all, family: "finite displacements", solvers: FINITE };
    let kinematics =
        |text: String| changed(&text, "solver = \"SOLVER\"", "solver = \"SOLVER\"\nkinematics = \"finite\"");
    let base = Arch { voussoirs: 7, ..ring() };
    let limit = factor(&base.study());
    let joints = |kn: f64, s: f64| {
        let arch = Arch { joint: compliant(&friction(0.6), kn, kn), ..scaled(&base, s) };
        kinematics(arch.study())
    };
    let reference = factor(&joints(1e9, 1.0));
    for span in [1e-3, 1e-1, 1e2, 1e3] {
        let s = span / base.span;
        family.add(format!("span {span:e} m"), joints(1e9, s), Known::Factor(reference, 1e-5));
    }
    // A hinge with the rotation θ is pressed over a length a, a² θ = 2 N/k. The loss is the least of a and of the
    // displacement from θ, so of the order (N/k L²)^(1/3), until a is less than the distance of contact points.
    for (kn, within) in [(1e12, 2e-2), (1e15, 2e-3)] {
        family.add(format!("joints {kn:e} Pa/m"), joints(kn, 1.0), Known::Factor(limit, within));
    }
    // Joints that the dead load compresses by metres: the answer is not known, but no step may fail.
    let any: &[Status] = &[Status::NoEquilibrium, Status::Stands, Status::LimitPoint, Status::Collapse];
    for kn in [1.0, 1e4] {
        family.add(format!("joints {kn:e} Pa/m"), joints(kn, 1.0), Known::Edge(any, f64::NEG_INFINITY));
    }
    let turned = OneBlock { slope: PI / 6.0, joint: compliant(&friction(0.5), 1e9, 1e9), ..OneBlock::new() };
    family.add("slides off".into(), kinematics(turned.study()), Known::Ends(Status::NoEquilibrium));
}
