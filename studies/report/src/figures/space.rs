//! Scenes in space: axonometry, elevation and plan, with forces of contacts, and the blocks as they move.

use super::scene_canvas::{SceneCanvas, hatching};
use super::symbols::{FILL, LOAD, MOTION, OUTLINE, STONE, Symbol, THRUST};
use voussoir_core::limit::Status;
use voussoir_core::model::Stage;
use voussoir_core::model::geometry::Vec2;
use voussoir_core::space::{Contact, SpaceAssembly, Vec3, velocity_at};
use voussoir_study::results::format::{format_short, headline};
use voussoir_study::results::{CaseResult, SpaceFieldEntry, SpaceMotionEntry};
use voussoir_study::study::SpaceCase;

/// Fill of faces that turn away from the light.
const SHADED: &str = "#b9ad93";
/// Distance between views, as a share of the scene's size.
const GAP: f64 = 0.08;
/// Length of the greatest force or load, as a share of the scene's size.
const LONGEST: f64 = 0.12;
/// Greatest displacement in a drawing of a mechanism, as a share of the scene's size.
pub(crate) const MOVED: f64 = 0.12;
/// Relative displacement of two bodies that is drawn, as a share of the scene's size.
const APART: f64 = 1e-3;
/// Sine and cosine of 30°, the azimuth and the elevation of the axonometry.
const VIEW: [f64; 2] = [0.5, 0.866_025_403_784_438_6];

/// A parallel projection.
#[derive(Debug, Clone, Copy)]
struct View {
    right: Vec3,
    up: Vec3,
    /// Towards the viewer.
    towards: Vec3,
    /// Place of the projected origin on the sheet \[m\].
    shift: Vec2,
}

impl View {
    fn new(right: Vec3, up: Vec3) -> Self {
        View { right, up, towards: right.cross(&up), shift: Vec2::zeros() }
    }

    /// Axonometry, elevation along y, and plan.
    fn all() -> [View; 3] {
        let [sin, cos] = VIEW;
        let axonometry = View::new(Vec3::new(cos, sin, 0.0), Vec3::new(-sin * sin, cos * sin, cos));
        [axonometry, View::new(Vec3::x(), Vec3::z()), View::new(Vec3::x(), Vec3::y())]
    }

    fn of(&self, point: &Vec3) -> Vec2 {
        Vec2::new(self.right.dot(point), self.up.dot(point)) + self.shift
    }

    /// Returns the corners of the box around points.
    fn extent<'a>(&self, points: impl Iterator<Item = &'a Vec3>) -> [Vec2; 2] {
        around(points.map(|point| self.of(point)).map(|point| [point, point]))
    }
}

/// Returns the corners of the box around boxes.
fn around(boxes: impl Iterator<Item = [Vec2; 2]>) -> [Vec2; 2] {
    let infinite = Vec2::repeat(f64::INFINITY);
    boxes.fold([infinite, -infinite], |[low, high], own| [low.inf(&own[0]), high.sup(&own[1])])
}

/// Blocks with the corners at which they are drawn.
struct Blocks<'a> {
    assembly: &'a SpaceAssembly,
    corners: Vec<Vec<Vec3>>,
}

impl<'a> Blocks<'a> {
    fn in_place(assembly: &'a SpaceAssembly) -> Self {
        Blocks { assembly, corners: assembly.bodies.iter().map(|body| body.shape.vertices.clone()).collect() }
    }

    /// Returns the views side by side, the axonometry on the left and elevation above plan on the right, and the sheet.
    fn layout(&self, size: f64) -> ([View; 3], [Vec2; 2]) {
        let points = || self.corners.iter().flatten();
        let mut views = View::all();
        let [axonometry, elevation, plan] = views.map(|view| view.extent(points()));
        let left = axonometry[1].x - axonometry[0].x + GAP * size;
        let above = plan[1].y - plan[0].y + GAP * size;
        views[0].shift = -axonometry[0];
        views[1].shift = Vec2::new(left, above) - elevation[0];
        views[2].shift = Vec2::new(left, 0.0) - plan[0];
        (views, around(views.iter().map(|view| view.extent(points()))))
    }

    /// Draws the faces that the viewer sees, from back to front.
    fn draw(&self, canvas: &mut SceneCanvas, view: &View) {
        let ground = hatching();
        let mut faces: Vec<(f64, &str, Vec<Vec2>)> = Vec::new();
        for (body, corners) in self.assembly.bodies.iter().zip(&self.corners) {
            for face in &body.shape.faces {
                let points: Vec<&Vec3> = face.iter().map(|corner| &corners[*corner]).collect();
                let normal = newell(&points);
                if normal.dot(&view.towards) > 0.0 {
                    let depth = points.iter().map(|point| view.towards.dot(point)).sum::<f64>() / points.len() as f64;
                    let fill = if body.fixed { &ground } else { shade(&normal) };
                    faces.push((depth, fill, points.iter().map(|point| view.of(point)).collect()));
                }
            }
        }
        faces.sort_by(|a, b| a.0.total_cmp(&b.0));
        // Outlines of many blocks are thin.
        let width = (30.0 / (self.assembly.bodies.len().max(1) as f64).sqrt()).clamp(0.3, 1.2);
        for (_, fill, outline) in &faces {
            canvas.shapes([outline.as_slice()].into_iter(), fill, OUTLINE, width, "");
        }
    }
}

/// Returns the normal of a polygon, twice its area long.
fn newell(points: &[&Vec3]) -> Vec3 {
    (0..points.len()).map(|k| points[k].cross(points[(k + 1) % points.len()])).sum()
}

/// Returns the fill of a face by its direction.
fn shade(normal: &Vec3) -> &'static str {
    let unit = normal / normal.norm().max(f64::MIN_POSITIVE);
    match (unit.z > VIEW[0], unit.x > -unit.y) {
        (true, _) => FILL,
        (false, true) => SHADED,
        (false, false) => STONE,
    }
}

fn size_of(assembly: &SpaceAssembly) -> f64 {
    let (low, high) = assembly.bounding_box();
    if low.x.is_finite() { (high - low).norm() } else { 1.0 }
}

/// Returns the entries of the legend for the blocks that the scene has.
fn legend_of(assembly: &SpaceAssembly, blocks: &str) -> Vec<(Symbol, String)> {
    let ground = assembly.bodies.iter().any(|body| body.fixed).then(|| (Symbol::Ground, "support".to_string()));
    [(Symbol::Block, blocks.to_string())].into_iter().chain(ground).collect()
}

/// The drawing of a case in space, as SVG.
pub fn space_svg(title: &str, space: &SpaceCase, stages: &[Stage], result: &CaseResult) -> String {
    let assembly = &space.assembly;
    let (blocks, size) = (Blocks::in_place(assembly), size_of(assembly));
    let (views, [low, high]) = blocks.layout(size);
    let titles = [title.to_string(), headline(result, stages)];
    let titles = if title.is_empty() { &[][..] } else { &titles[..] };
    let mut canvas = SceneCanvas::new(low, high, [30.0; 4], titles);
    let field = result.proof.space.as_ref().and_then(|proof| proof.field.as_deref()).unwrap_or_default();
    let forces = resultants(field, &assembly.contacts);
    for view in &views {
        blocks.draw(&mut canvas, view);
        draw_forces(&mut canvas, view, &forces, LONGEST * size);
        draw_loads(&mut canvas, view, space, LONGEST * size);
    }
    let mut legend = legend_of(assembly, "blocks");
    if !forces.is_empty() {
        legend.push((Symbol::Force, "resultant force of a contact".into()));
    }
    let loads = space.stages.last();
    if loads.is_some_and(|stage| !stage.forces.is_empty()) {
        legend.push((Symbol::Load, "load, λ is its factor".into()));
    }
    let accelerations = loads.into_iter().flat_map(|stage| &stage.accelerations).map(|a| {
        let [x, y, z] = [a.x, a.y, a.z].map(|component| format_short(component, 4));
        format!("Load: the mass of every block times ({x}, {y}, {z}) m/s², λ is its factor.")
    });
    let views = "Left: axonometry. Right: elevation with x to the right and z upwards, and below it the plan.";
    canvas.finish(&legend, &std::iter::once(views.to_string()).chain(accelerations).collect::<Vec<_>>())
}

/// Returns the resultant force of each loaded contact, and the mean of its points weighted by the sizes of their normal forces: its
/// centre of pressure, if no point is in tension.
fn resultants(field: &[SpaceFieldEntry], contacts: &[Contact]) -> Vec<(Vec3, Vec3)> {
    let mut sums = vec![(0.0, Vec3::zeros(), Vec3::zeros()); contacts.len()];
    for SpaceFieldEntry { joint, point, force: [n, s, t] } in field {
        let (Some((normal, force, moment)), Some(contact)) = (sums.get_mut(*joint), contacts.get(*joint)) else {
            continue;
        };
        *normal += n.abs();
        *force += contact.normal * *n + contact.tangents[0] * *s + contact.tangents[1] * *t;
        *moment += Vec3::from(*point) * n.abs();
    }
    sums.into_iter().filter(|(n, ..)| *n > 0.0).map(|(n, force, moment)| (force, moment / n)).collect()
}

/// Draws each resultant as a line through its centre of pressure; the greatest is `longest` long.
fn draw_forces(canvas: &mut SceneCanvas, view: &View, forces: &[(Vec3, Vec3)], longest: f64) {
    let greatest = forces.iter().map(|(force, _)| force.norm()).fold(f64::MIN_POSITIVE, f64::max);
    for (force, point) in forces {
        let half = force * (0.5 * longest / greatest);
        let ends = [point - half, point + half].map(|end| canvas.at(view.of(&end)));
        canvas.line(&ends, THRUST, 1.6, "");
    }
}

/// Draws the forces of the last stage as arrows that end at their points.
fn draw_loads(canvas: &mut SceneCanvas, view: &View, space: &SpaceCase, longest: f64) {
    let forces = space.stages.last().map_or(&[][..], |stage| &stage.forces);
    let greatest = forces.iter().map(|force| force.force.norm()).fold(f64::MIN_POSITIVE, f64::max);
    for load in forces {
        let from = load.point - load.force * (longest / greatest);
        let [from, to] = [from, load.point].map(|end| canvas.at(view.of(&end)));
        canvas.arrow(from, to, LOAD, 2.0, 8.0);
    }
}

/// The mechanism of a case in space with displacements exaggerated, as SVG; `None` if it has no mechanism.
pub fn space_mechanism_svg(title: &str, space: &SpaceCase, result: &CaseResult) -> Option<String> {
    let assembly = &space.assembly;
    let size = size_of(assembly);
    let moves = Moves::new(assembly, result.proof.space.as_ref()?.motion.as_deref()?, MOVED * size)?;
    let bodies = assembly.bodies.iter().enumerate();
    let corners = bodies.map(|(body, own)| own.shape.vertices.iter().map(|point| moves.place(body, point)).collect());
    let moved = Blocks { assembly, corners: corners.collect() };
    let (views, [low, high]) = moved.layout(size);
    // A stage that stands has a motion only after supports have moved.
    let settled = result.status == Status::Stands;
    let what = if settled { "displacements after supports have moved" } else { "mechanism" };
    let mut canvas = SceneCanvas::new(low, high, [30.0; 4], &[title.to_string(), what.to_string()]);
    let parted: Vec<_> = assembly.contacts.iter().filter_map(|contact| moves.parted(contact, APART * size)).collect();
    for view in &views {
        moved.draw(&mut canvas, view);
        for polygon in &parted {
            let outline: Vec<Vec2> = polygon.iter().map(|point| view.of(point)).collect();
            canvas.shapes([outline.as_slice()].into_iter(), "none", MOTION, 0.8, "");
        }
    }
    let mut legend = legend_of(assembly, "blocks as they move");
    if !parted.is_empty() {
        legend.push((Symbol::Sliding, "outline of a contact that opens or slides".into()));
    }
    let scale = format_short(moves.scale, 3);
    let caption = [if settled {
        format!("The blocks that have followed their supports; displacements times {scale}.")
    } else {
        format!(
            "Displacements are exaggerated: the velocities of the mechanism, at unit power of the load, times {scale}. Only \
             directions and ratios mean something, not the size."
        )
    }];
    Some(canvas.finish(&legend, &caption))
}

/// Displacements of the blocks along a mechanism.
pub(crate) struct Moves {
    /// Centroid and motion of each body.
    bodies: Vec<(Vec3, [f64; 6])>,
    /// Factor of the velocities.
    pub(crate) scale: f64,
}

impl Moves {
    /// Scales a mechanism to a greatest displacement \[m\]. `None` if nothing moves.
    pub(crate) fn new(assembly: &SpaceAssembly, motion: &[SpaceMotionEntry], greatest: f64) -> Option<Self> {
        let bodies = motion.iter().enumerate().map(|(body, entry)| (assembly.centroid(body), entry.velocity)).collect();
        let unit = Moves { bodies, scale: 1.0 };
        let all = assembly
            .bodies
            .iter()
            .enumerate()
            .flat_map(|(body, own)| own.shape.vertices.iter().map(move |point| (body, point)));
        let fastest = all.map(|(body, point)| (unit.place(body, point) - point).norm()).fold(0.0, f64::max);
        (fastest > 0.0).then(|| Moves { scale: greatest / fastest, ..unit })
    }

    fn place(&self, body: usize, point: &Vec3) -> Vec3 {
        let Some((centroid, motion)) = self.bodies.get(body) else { return *point };
        point + velocity_at(motion, &(point - centroid)) * self.scale
    }

    /// Returns the polygon of a contact whose bodies move apart by more than `least`, on the side of the minus body.
    fn parted(&self, contact: &Contact, least: f64) -> Option<Vec<Vec3>> {
        let [minus, plus] = [contact.minus, contact.plus]
            .map(|body| contact.points.iter().map(|point| self.place(body, point)).collect::<Vec<Vec3>>());
        let apart = minus.iter().zip(&plus).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        (apart > least).then_some(minus)
    }
}
