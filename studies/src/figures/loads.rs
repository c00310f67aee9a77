//! Loads of the last stage as arrows.

use super::format::{format_force, format_number};
use super::svg_canvas::SvgCanvas;
use super::symbols::LOAD;
use super::text_layout::{Area, Spot};
use voussoir_core::model::geometry::{Vec2, contains};
use voussoir_core::model::{Assembly, PointForce, Stage};

/// More forces than this share one label.
const SINGLE: usize = 3;
/// More arrows than this are not drawn.
const ARROWS: usize = 40;

/// An arrow for a force: it points at where the force acts, or away from it where the force pulls.
#[derive(Debug, Clone, Copy)]
struct Arrow {
    point: Vec2,
    /// Unit vector.
    direction: Vec2,
    /// Share of the longest arrow.
    share: f64,
    pulls: bool,
}

/// The arrows of a scene's loads, thinned where there are many.
#[derive(Debug)]
pub struct Loads {
    arrows: Vec<Arrow>,
    labels: Vec<String>,
    accelerations: Vec<String>,
    length: f64,
}

impl Loads {
    /// Of the last stage, at factor `factor`; without one the labels say `λ ×`.
    pub fn new(assembly: &Assembly, stages: &[Stage], factor: Option<f64>) -> Self {
        let none = Loads { arrows: Vec::new(), labels: Vec::new(), accelerations: Vec::new(), length: 0.0 };
        let Some(stage) = stages.last() else { return none };
        let text = |newtons: f64| match factor {
            Some(factor) => format_force(newtons * factor),
            None => format!("λ × {}", format_force(newtons)),
        };
        let forces: Vec<&PointForce> = stage.forces.iter().filter(|f| f.force.norm() > 0.0).collect();
        let strongest = forces.iter().map(|f| f.force.norm()).fold(0.0, f64::max);
        let step = forces.len().div_ceil(ARROWS).max(1);
        let arrows = forces
            .iter()
            .step_by(step)
            .map(|f| {
                let direction = f.force.normalize();
                let behind = f.point - direction * (1e-3 * assembly.size());
                let pulls = assembly
                    .bodies
                    .get(f.body)
                    .is_some_and(|b| !b.vertices.is_empty() && contains(&b.vertices, behind, 0.0));
                Arrow { point: f.point, direction, share: f.force.norm() / strongest, pulls }
            })
            .collect();
        let labels = if forces.len() <= SINGLE {
            forces.iter().map(|f| text(f.force.norm())).collect()
        } else {
            let sum = forces.iter().fold(Vec2::zeros(), |sum, f| sum + f.force).norm();
            let sum = if sum > 1e-9 * strongest { format!("{} in all", text(sum)) } else { "resultant 0".into() };
            vec![format!("{sum} ({} forces)", forces.len())]
        };
        let accelerations = stage
            .accelerations
            .iter()
            .map(|a| {
                let each = |x: f64| format_number(x * factor.unwrap_or(1.0), 4);
                let lambda = if factor.is_some() { "" } else { "λ × " };
                format!("every block: {lambda}({}, {}) m/s² × its mass", each(a.x), each(a.y))
            })
            .collect();
        let length = if forces.len() <= SINGLE { 62.0 } else { 30.0 };
        Loads { arrows, labels, accelerations, length }
    }

    /// Whether there is nothing to draw.
    pub fn is_empty(&self) -> bool {
        self.arrows.is_empty() && self.accelerations.is_empty()
    }

    /// Whether there are forces.
    pub fn has_arrows(&self) -> bool {
        !self.arrows.is_empty()
    }

    /// Sentences for loads that are no arrows.
    pub fn sentences(&self) -> &[String] {
        &self.accelerations
    }

    fn length_of(&self, arrow: &Arrow) -> f64 {
        self.length * arrow.share.max(0.35)
    }

    /// Free margin \[px\] that arrows and labels need (left, top, right, bottom) around a scene
    /// within `low`..`high` \[m\].
    pub fn margins(&self, low: Vec2, high: Vec2) -> [f64; 4] {
        let middle = (low + high) / 2.0;
        let extent = (high - low).sup(&Vec2::repeat(1e-12));
        let mut margins: [f64; 4] = [46.0, 34.0, 46.0, 30.0];
        for arrow in &self.arrows {
            let tail = if arrow.pulls { arrow.direction } else { -arrow.direction } * self.length_of(arrow);
            let near = |axis: usize, side: f64| side * (arrow.point[axis] - middle[axis]) / extent[axis] > 0.2;
            for (i, axis, side, label) in [(0, 0, -1.0, 80.0), (1, 1, 1.0, 34.0), (2, 0, 1.0, 80.0), (3, 1, -1.0, 34.0)]
            {
                if side * tail[axis] > 1.0 && near(axis, side) {
                    margins[i] = margins[i].max(side * tail[axis] + label);
                }
            }
        }
        margins
    }

    /// Draws the arrows and keeps labels off them; labels come later.
    pub fn draw(&self, canvas: &mut SvgCanvas) {
        for arrow in &self.arrows {
            let (from, to) = self.ends(canvas, arrow);
            let small = self.arrows.len() > SINGLE;
            canvas.arrow(from, to, LOAD, if small { 1.4 } else { 2.4 }, if small { 7.0 } else { 11.0 });
            for i in 0..=8 {
                let s = f64::from(i) / 8.0;
                let spot = [from[0] + s * (to[0] - from[0]), from[1] + s * (to[1] - from[1])];
                canvas.take(Area::around(spot, [4.0, 4.0]));
            }
        }
    }

    /// Writes the values at the tails.
    pub fn label(&self, canvas: &mut SvgCanvas) {
        let chosen: Vec<&Arrow> = if self.arrows.len() <= SINGLE {
            self.arrows.iter().collect()
        } else {
            self.arrows.get(self.arrows.len() / 2).into_iter().collect()
        };
        for (arrow, text) in chosen.into_iter().zip(&self.labels) {
            let (from, to) = self.ends(canvas, arrow);
            let away = if arrow.pulls { 1.0 } else { -1.0 };
            let tail = if arrow.pulls { to } else { from };
            canvas.label(tail, [away * (to[0] - from[0]), away * (to[1] - from[1])], text, LOAD, true);
        }
    }

    fn ends(&self, canvas: &SvgCanvas, arrow: &Arrow) -> (Spot, Spot) {
        let [x, y] = canvas.at(arrow.point);
        let reach = self.length_of(arrow) * if arrow.pulls { -1.0 } else { 1.0 };
        let tail = [x - arrow.direction.x * reach, y + arrow.direction.y * reach];
        if arrow.pulls { ([x, y], tail) } else { (tail, [x, y]) }
    }
}
