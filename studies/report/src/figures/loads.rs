//! Loads and settlements of all stages as arrows: those of the last at its factor, those before it as they stay.

use super::scene_canvas::SceneCanvas;
use super::symbols::{EARLIER, LOAD, SETTLEMENT};
use voussoir_core::model::geometry::{Vec2, contains};
use voussoir_core::model::{Assembly, PointForce, Settlement, Stage, Target};
use voussoir_plot::text::{Area, Spot};
use voussoir_study::results::format::{format_force, format_length, format_number, format_short};

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
    /// Of the stages before the last.
    earlier: Vec<Arrow>,
    /// Where a support moves, and the direction.
    settlements: Vec<(Vec2, Vec2)>,
    /// What is no arrow, and what arrows do not say.
    sentences: Vec<String>,
    length: f64,
}

/// Length of the arrow of a settlement \[px\].
const SETTLED: f64 = 44.0;

/// The forces of a stage that are not zero, thinned to [`ARROWS`].
fn arrows(assembly: &Assembly, stage: &Stage) -> Vec<Arrow> {
    let forces: Vec<&PointForce> = stage.forces.iter().filter(|f| f.force.norm() > 0.0).collect();
    let strongest = forces.iter().map(|f| f.force.norm()).fold(0.0, f64::max);
    let arrow = |f: &&PointForce| {
        let direction = f.force.normalize();
        let behind = f.point - direction * (1e-3 * assembly.size());
        let body = assembly.bodies.get(f.body);
        let pulls = body.is_some_and(|b| !b.vertices.is_empty() && contains(&b.vertices, behind, 0.0));
        Arrow { point: f.point, direction, share: f.force.norm() / strongest, pulls }
    };
    forces.iter().step_by(forces.len().div_ceil(ARROWS).max(1)).map(arrow).collect()
}

/// What the arrows of a stage before the last do not say: its name and its forces.
fn earlier_forces(stage: &Stage) -> Option<String> {
    let Target::Factor(factor) = stage.target else { return None };
    let count = stage.forces.iter().filter(|f| f.force.norm() > 0.0).count();
    let sum = stage.forces.iter().fold(Vec2::zeros(), |sum, f| sum + f.force).norm();
    let words = if count == 1 { String::new() } else { format!(" in {count} forces") };
    (count > 0).then(|| format!("Stage \"{}\" before: {}{words}.", stage.name, format_force(sum * factor)))
}

/// A settlement in words.
fn moved(assembly: &Assembly, stage: &Stage, settlement: &Settlement) -> String {
    let name = assembly.bodies.get(settlement.body).map_or("", |body| body.name.as_str());
    let [x, y] = [settlement.displacement.x, settlement.displacement.y].map(format_length);
    let turn = match settlement.rotation {
        0.0 => String::new(),
        angle => format!(" and turns by {} mrad", format_short(angle * 1e3, 4)),
    };
    format!("Stage \"{}\": \"{name}\" moves by ({x}, {y}){turn}.", stage.name)
}

impl Loads {
    /// Of the last stage, at factor `factor`; without one the labels say `λ ×`.
    pub fn new(assembly: &Assembly, stages: &[Stage], factor: Option<f64>) -> Self {
        let mut sentences = Vec::new();
        let mut settlements = Vec::new();
        for stage in stages {
            for settlement in &stage.settlements {
                sentences.push(moved(assembly, stage, settlement));
                let length = settlement.displacement.norm();
                settlements.extend((length > 0.0).then(|| (settlement.about, settlement.displacement / length)));
            }
        }
        let (earlier, last) = stages.split_at(stages.len().saturating_sub(1));
        for stage in earlier {
            sentences.extend(earlier_forces(stage));
            sentences.extend(stage.accelerations.iter().map(|a| {
                let [x, y] = [a.x, a.y].map(|x| format_number(x, 4));
                format!("Stage \"{}\" before: every block ({x}, {y}) m/s² × its mass.", stage.name)
            }));
        }
        let earlier = earlier.iter().flat_map(|stage| arrows(assembly, stage)).collect();
        let none = Loads { arrows: Vec::new(), labels: Vec::new(), earlier, settlements, sentences, length: 30.0 };
        let Some(stage) = last.first() else { return none };
        let text = |newtons: f64| match factor {
            Some(factor) => format_force(newtons * factor),
            None => format!("λ × {}", format_force(newtons)),
        };
        let forces: Vec<&PointForce> = stage.forces.iter().filter(|f| f.force.norm() > 0.0).collect();
        let strongest = forces.iter().map(|f| f.force.norm()).fold(0.0, f64::max);
        let labels = if forces.len() <= SINGLE {
            forces.iter().map(|f| text(f.force.norm())).collect()
        } else {
            let sum = forces.iter().fold(Vec2::zeros(), |sum, f| sum + f.force).norm();
            let sum = if sum > 1e-9 * strongest { format!("{} in all", text(sum)) } else { "resultant 0".into() };
            vec![format!("{sum} ({} forces)", forces.len())]
        };
        let accelerations = stage.accelerations.iter().map(|a| {
            let each = |x: f64| format_number(x * factor.unwrap_or(1.0), 4);
            let lambda = if factor.is_some() { "" } else { "λ × " };
            format!("every block: {lambda}({}, {}) m/s² × its mass", each(a.x), each(a.y))
        });
        let length = if forces.len() <= SINGLE { 62.0 } else { 30.0 };
        let arrows = arrows(assembly, stage);
        Loads { arrows, labels, length, sentences: accelerations.chain(none.sentences).collect(), ..none }
    }

    /// Whether there are forces.
    pub fn has_arrows(&self) -> bool {
        !self.arrows.is_empty()
    }

    /// Whether there are forces of stages before the last.
    pub fn has_earlier(&self) -> bool {
        !self.earlier.is_empty()
    }

    /// Whether supports move.
    pub fn has_settlements(&self) -> bool {
        !self.settlements.is_empty()
    }

    /// Sentences for what arrows do not say.
    pub fn sentences(&self) -> &[String] {
        &self.sentences
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
        for arrow in self.arrows.iter().chain(&self.earlier) {
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
    pub fn draw(&self, canvas: &mut SceneCanvas) {
        for (about, direction) in &self.settlements {
            let [x, y] = canvas.at(*about);
            let to = [x + direction.x * SETTLED, y - direction.y * SETTLED];
            canvas.arrow([x, y], to, SETTLEMENT, 3.0, 11.0);
        }
        let coloured = self.earlier.iter().map(|arrow| (arrow, EARLIER)).chain(self.arrows.iter().map(|a| (a, LOAD)));
        for (arrow, colour) in coloured {
            let (from, to) = self.ends(canvas, arrow);
            let small = self.arrows.len() > SINGLE;
            canvas.arrow(from, to, colour, if small { 1.4 } else { 2.4 }, if small { 7.0 } else { 11.0 });
            for i in 0..=8 {
                let s = f64::from(i) / 8.0;
                let spot = [from[0] + s * (to[0] - from[0]), from[1] + s * (to[1] - from[1])];
                canvas.take(Area::around(spot, [4.0, 4.0]));
            }
        }
    }

    /// Writes the values at the tails.
    pub fn label(&self, canvas: &mut SceneCanvas) {
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

    fn ends(&self, canvas: &SceneCanvas, arrow: &Arrow) -> (Spot, Spot) {
        let [x, y] = canvas.at(arrow.point);
        let reach = self.length_of(arrow) * if arrow.pulls { -1.0 } else { 1.0 };
        let tail = [x - arrow.direction.x * reach, y + arrow.direction.y * reach];
        if arrow.pulls { ([x, y], tail) } else { (tail, [x, y]) }
    }
}
