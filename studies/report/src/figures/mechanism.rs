//! A mechanism: where its blocks go.

use super::displaced::{Placement, displaced};
use super::drawing::{extent, faces, outline_width, supports};
use super::hinge_closure::close_hinges;
use super::hinges::named_hinges;
use super::scene_canvas::{SceneCanvas, hatching};
use super::symbols::{OUTLINE, STONE, Symbol, YIELDED, mark};
use std::collections::BTreeSet;
use voussoir_core::certificate::{Hinge, Mechanism, MechanismKind, jumps, largest_jump};
use voussoir_core::elastic::Mesh;
use voussoir_core::limit::Status;
use voussoir_core::model::Assembly;
use voussoir_core::model::geometry::Vec2;
use voussoir_plot::colours::FAINT;
use voussoir_study::results::format::{format_short, kind_words};
use voussoir_study::results::inelastic_state::CRUSHED;
use voussoir_study::results::{CaseResult, DisplacementEntry, MotionEntry};

/// The mechanism of a case with displacements exaggerated, as SVG; `None` where it has none.
pub fn mechanism_svg(title: &str, assembly: &Assembly, result: &CaseResult) -> Option<String> {
    let shown = Shown::of(assembly, result)?;
    let mechanism = &shown.mechanism;
    let (placements, scale) = displaced(assembly, &shown.motion)?;
    let placements = match shown.stands {
        true => placements,
        false => close_hinges(assembly, &shown.held_together(assembly, result), placements),
    };
    let moved: Vec<Vec<Vec2>> = assembly
        .bodies
        .iter()
        .zip(&placements)
        .map(|(body, placement)| body.vertices.iter().map(|&vertex| placement.of(vertex)).collect())
        .collect();
    let further: Vec<Vec2> = moved.iter().flatten().copied().collect();
    let (low, high) = extent(assembly, &further);
    let titles = [
        title.to_string(),
        match shown.stands {
            true => format!("displaced: {} hinges open", named_hinges(&mechanism.hinges).len()),
            false => format!("mechanism: {}", kind_words(mechanism.kind).trim_end_matches(" mechanism")),
        },
    ];
    let mut canvas = SceneCanvas::new(low, high, [46.0, 34.0, 46.0, 30.0], &titles);
    let width = outline_width(&canvas, assembly);
    let free = |body: usize| !assembly.bodies[body].fixed;
    let ground = assembly.bodies.iter().filter(|body| body.fixed).map(|body| body.vertices.as_slice());
    canvas.shapes(ground, &hatching(), OUTLINE, 1.0, "");
    let before = assembly.bodies.iter().filter(|body| !body.fixed).map(|body| body.vertices.as_slice());
    canvas.shapes(before, "none", FAINT, width.min(0.9), "4 3");
    faces(&mut canvas, assembly, FAINT, |_, point| point);
    let after = moved.iter().enumerate().filter(|(body, _)| free(*body)).map(|(_, shape)| shape.as_slice());
    canvas.shapes(after, STONE, OUTLINE, width, "");
    let grey = yielded_elements(assembly, result, |body, point| placements[body].of(point));
    canvas.shapes(grey.iter().map(|element| element.as_slice()), YIELDED, "none", 0.0, "");
    faces(&mut canvas, assembly, OUTLINE, |body, point| placements[body].of(point));
    supports(&mut canvas, assembly);
    let mut legend =
        vec![(Symbol::Block, "blocks as they move".to_string()), (Symbol::Before, "where they were".to_string())];
    if !grey.is_empty() {
        let text = format!("elements that have yielded (mean equivalent plastic strain above {CRUSHED:.0e})");
        legend.push((Symbol::Yielded, text));
    }
    legend.extend(mark(&mut canvas, assembly, (result, mechanism), true, |joint, point| {
        placements[joint.minus].of(point)
    }));
    let scale = format_short(scale, 3);
    let caption = [match (shown.stands, shown.moved_on) {
        (true, _) => format!("The blocks at the end of the path; displacements times {scale}."),
        (_, true) => format!(
            "The blocks at the end of the path, moved on by the mechanism until the first open joint closes; displacements \
             times {scale}."
        ),
        _ => format!(
            "Displacements are exaggerated: the velocities of the mechanism, at unit power of the load, times {scale}. \
             Only directions and ratios mean something, not the size."
        ),
    }];
    Some(canvas.finish(&legend, &caption))
}

/// The motion of a block in a drawing of a mechanism: at a share s of the way it has followed the twist
/// s `velocity` + s² `closing[0]` + s³ `closing[1]` about its centroid for unit time. Velocities leave hinges open by the
/// square of the way; the other terms close them halfway and at the end, where [`mechanism_svg`] draws the block.
pub(crate) struct MovingBlock {
    /// (v at the centroid, ω) \[m, rad\].
    pub velocity: [f64; 3],
    /// The same of the corrections.
    pub closing: [[f64; 3]; 2],
}

/// The motion of every block of a case's mechanism; `None` if it has none or stands.
pub(crate) fn moving_blocks(assembly: &Assembly, result: &CaseResult) -> Option<Vec<MovingBlock>> {
    let shown = Shown::of(assembly, result).filter(|shown| !shown.stands)?;
    let (whole, _) = displaced(assembly, &shown.motion)?;
    let mechanism = shown.held_together(assembly, result);
    let half: Vec<Placement> = whole.iter().map(|placement| placement.at_share(0.5)).collect();
    let corrections = [&half, &whole].map(|begun| {
        let closed = close_hinges(assembly, &mechanism, begun.clone());
        let correction = |(closed, begun): (&Placement, &Placement)| {
            let (closed, begun) = (closed.twist(), begun.twist());
            [0, 1, 2].map(|i| closed[i] - begun[i])
        };
        closed.iter().zip(begun).map(correction).collect::<Vec<_>>()
    });
    let block = |(body, whole): (usize, &Placement)| {
        let [half, all] = [0, 1].map(|share| corrections[share][body]);
        let square = [0, 1, 2].map(|i| 8.0 * half[i] - all[i]);
        MovingBlock { velocity: whole.twist(), closing: [square, [0, 1, 2].map(|i| all[i] - square[i])] }
    };
    Some(whole.iter().enumerate().map(block).collect())
}

/// A joint crushed over less than this share of its height still touches at its end, in a drawing.
const TOE: f64 = 0.25;

/// What is drawn: a mechanism as it begins to move, or a scene that stands with the hinges that are open.
struct Shown {
    mechanism: Mechanism,
    motion: Vec<MotionEntry>,
    /// Whether the motion is that of a path's end and the mechanism together.
    moved_on: bool,
    stands: bool,
}

impl Shown {
    fn of(assembly: &Assembly, result: &CaseResult) -> Option<Self> {
        if result.status == Status::Stands {
            return Shown::standing(result);
        }
        let (mechanism, motion) = (result.mechanism.clone()?, result.proof.motion.as_ref()?);
        let further = moved_on(assembly, result, motion);
        let moved_on = further.is_some();
        Some(Shown { mechanism, motion: further.unwrap_or_else(|| motion.clone()), moved_on, stands: false })
    }

    /// The mechanism with a hinge at every joint of a path's end that is pressed, at the end that parts less: blocks
    /// deform, and exaggerated that would show as gaps. Where more than toes crush all is deformation.
    fn held_together(&self, assembly: &Assembly, result: &CaseResult) -> Mechanism {
        let mut all = self.mechanism.clone();
        if result.path.displacements.is_none() || all.crushing.iter().any(|crushing| crushing.share > TOE) {
            return all;
        }
        let velocities: Vec<_> = self.motion.iter().map(|entry| entry.velocity).collect();
        let parts = jumps(assembly, &velocities);
        let known = |index: usize| {
            let hinge = self.mechanism.hinges.iter().any(|hinge| hinge.joint == index);
            hinge || self.mechanism.sliding.iter().any(|slide| slide.joint == index)
        };
        let pressed = result.proof.field.iter().flatten().filter(|at| at.force[0] > 0.0).map(|at| at.joint);
        for index in pressed.filter(|index| !known(*index)).collect::<BTreeSet<_>>() {
            let Some((joint, part)) = assembly.joints.get(index).zip(parts.get(index)) else { continue };
            let nearer = usize::from(part.open[1].abs() < part.open[0].abs());
            let between = [joint.minus, joint.plus].map(|body| assembly.bodies[body].name.clone());
            let (point, rotation) = (joint.ends[nearer].into(), part.rotation(joint.height()));
            all.hinges.push(Hinge { joint: index, between, side: None, point, rotation });
        }
        all
    }

    /// The end of a path that stands with open hinges, such as after a settlement.
    fn standing(result: &CaseResult) -> Option<Self> {
        let open = result.stages.last().map(|stage| stage.hinges.as_slice()).filter(|hinges| !hinges.is_empty())?;
        let named = named_hinges(open);
        let hinges: Vec<_> = named.iter().flat_map(|hinge| hinge.joints.iter().map(|own| (*own).clone())).collect();
        let displaced = result.path.displacements.as_ref()?;
        let entry = |at: &DisplacementEntry| MotionEntry { body: at.body.clone(), velocity: at.displacement };
        let (kind, hinge_count) = (MechanismKind::Rocking, named.len());
        let (sliding, crushing, contacts) = (Vec::new(), Vec::new(), Vec::new());
        let mechanism = Mechanism { kind, hinge_count, unique: None, hinges, sliding, crushing, contacts, at: None };
        Some(Shown { mechanism, motion: displaced.iter().map(entry).collect(), moved_on: false, stands: true })
    }
}

/// Jumps below this share of the greatest are deformation.
const DEFORMATION: f64 = 1e-2;

/// Displacements of the blocks at the end of a path in whose mechanism open joints close: those of its state and of
/// the mechanism until the first of them is closed, since velocities alone would draw blocks inside each other.
/// `None` where no joint closes, or blocks may come nearer by crushing.
fn moved_on(assembly: &Assembly, result: &CaseResult, motion: &[MotionEntry]) -> Option<Vec<MotionEntry>> {
    let displaced = result.path.displacements.as_ref().filter(|displaced| displaced.len() == motion.len())?;
    let deforms = !result.path.yielded.is_empty() || result.mechanism.as_ref().is_none_or(|m| !m.crushing.is_empty());
    let velocities: Vec<_> = motion.iter().map(|entry| entry.velocity).collect();
    let displacements: Vec<_> = displaced.iter().map(|entry| entry.displacement).collect();
    let rates = jumps(assembly, &velocities);
    let least = -DEFORMATION * largest_jump(&rates);
    let gaps = jumps(assembly, &displacements);
    let ends =
        rates.iter().zip(&gaps).flat_map(|(rate, gap)| [(rate.open[0], gap.open[0]), (rate.open[1], gap.open[1])]);
    let closing = ends.filter(|(rate, _)| *rate < least).map(|(rate, gap)| gap.max(0.0) / -rate);
    let time = closing.min_by(f64::total_cmp).filter(|_| !deforms)?;
    let entry = |(motion, at): (&MotionEntry, &[f64; 3])| MotionEntry {
        body: motion.body.clone(),
        velocity: [0, 1, 2].map(|i| at[i] + time * motion.velocity[i]),
    };
    Some(motion.iter().zip(&displacements).map(entry).collect())
}

/// Corners of the elements that have yielded, moved.
fn yielded_elements(assembly: &Assembly, result: &CaseResult, place: impl Fn(usize, Vec2) -> Vec2) -> Vec<Vec<Vec2>> {
    let mut out = Vec::new();
    for entry in &result.path.yielded {
        let Some(body) = assembly.body(&entry.body) else { continue };
        let Ok(mesh) = Mesh::new(&assembly.bodies[body].vertices, &assembly.mesh) else { continue };
        if mesh.elements.len() != entry.elements.len() {
            continue;
        }
        let yields = (0..mesh.elements.len()).filter(|element| entry.elements[*element] > CRUSHED);
        out.extend(yields.map(|element| mesh.corners(element).map(|corner| place(body, corner)).to_vec()));
    }
    out
}
