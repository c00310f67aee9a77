//! A scene of a family as a study.

use super::{FamilyScene, Form, Law, Load};
use std::fmt::Write as _;

/// Returns the mirror image of a quadrilateral; its edges 0 and 2 keep their numbers.
fn mirrored(vertices: [[f64; 2]; 4]) -> [[f64; 2]; 4] {
    [1, 0, 3, 2].map(|k| flipped(vertices[k]))
}

fn flipped([x, y]: [f64; 2]) -> [f64; 2] {
    [0.0 - x, y]
}

impl FamilyScene {
    /// Returns the study in a form, with these lines under `[solver]`.
    pub fn study(&self, form: Form, solver: &str) -> String {
        let kinematics = if self.finite { "finite" } else { "small" };
        let mut text = String::from(
            "name = \"family\"\n[scene]\nscene = \"blocks\"\nwidth = 1.0\nmaterial = \"m0\"\njoint = \"dry\"\nblocks = [\n",
        );
        for index in self.order(form) {
            let block = &self.blocks[index];
            let vertices = if form == Form::Mirrored { mirrored(block.vertices) } else { block.vertices };
            let fixed = if block.fixed { ", fixed = true" } else { "" };
            let material = if self.moduli.is_empty() || block.fixed { 0 } else { index };
            let _ = writeln!(
                text,
                "  {{ name = \"b{index}\", vertices = {vertices:?}, material = \"m{material}\"{fixed} }},"
            );
        }
        let _ = writeln!(text, "]\n[scene.mesh]\nelements = {:?}", self.elements);
        text + &self.materials()
            + &self.joint()
            + &format!("[solver]\nkinematics = \"{kinematics}\"\n{solver}\n")
            + &self.stages(form)
    }

    /// Returns the order of the blocks; the renumbered form has the odd places in reverse order first, then the even
    /// places.
    fn order(&self, form: Form) -> Vec<usize> {
        let count = self.blocks.len();
        match form {
            Form::Renumbered => {
                (0..count).rev().filter(|k| k % 2 == 1).chain((0..count).filter(|k| k % 2 == 0)).collect()
            }
            _ => (0..count).collect(),
        }
    }

    fn materials(&self) -> String {
        if self.moduli.is_empty() {
            return "[materials.m0]\nlaw = \"rigid\"\ndensity = 2000.0\n".into();
        }
        let elastic = |(k, modulus): (usize, &f64)| {
            format!(
                "[materials.m{k}]\nlaw = \"elastic\"\nyoung_modulus = {modulus:?}\npoisson_ratio = 0.2\ndensity = 2000.0\n"
            )
        };
        self.moduli.iter().enumerate().map(elastic).collect()
    }

    fn joint(&self) -> String {
        let friction = self.friction;
        let mut text = match self.law {
            Law::Stuck => "[joints.dry]\nlaw = \"unilateral\"\ntangential = \"stuck\"\n".to_string(),
            Law::Associated => format!("[joints.dry]\nlaw = \"coulomb_associated\"\nfriction = {friction:?}\n"),
            Law::Coulomb => format!("[joints.dry]\nlaw = \"coulomb\"\nfriction = {friction:?}\n"),
            Law::Dilatant => {
                let angle = friction.atan().to_degrees() / 2.0;
                format!("[joints.dry]\nlaw = \"coulomb\"\nfriction = {friction:?}\ndilatancy_angle = {angle:?}\n")
            }
        };
        if let Some([normal, shear]) = self.stiffness {
            text += &format!("normal_stiffness = {normal:?}\nshear_stiffness = {shear:?}\n");
        }
        text
    }

    fn stages(&self, form: Form) -> String {
        let of = |v: [f64; 2]| if form == Form::Mirrored { flipped(v) } else { v };
        let sign = if form == Form::Mirrored { -1.0 } else { 1.0 };
        let mut text = "[[stages]]\nname = \"dead\"\ngravity = 9.81\n".to_string();
        let motion = |(support, [x, y, turn]): &(usize, [f64; 3])| {
            let [x, y] = of([*x, *y]);
            format!("{{ support = \"b{support}\", displacement = [{x:?}, {y:?}], rotation = {:?} }}", sign * turn)
        };
        let motions: Vec<String> = self.settlements.iter().map(motion).collect();
        if !motions.is_empty() {
            text += &format!("[[stages]]\nname = \"settle\"\nsettlement = [{}]\n", motions.join(", "));
        }
        let load = |load: &Load| match *load {
            Load::Point { block, point, force } => {
                let (point, force) = (of(point), of(force));
                format!("{{ kind = \"point\", block = \"b{block}\", point = {point:?}, force = {force:?} }}")
            }
            Load::Body { acceleration } => {
                format!("{{ kind = \"body\", acceleration = [{:?}, 0.0] }}", sign * acceleration)
            }
        };
        let loads: Vec<String> = self.loads.iter().map(load).collect();
        text + &format!("[[stages]]\nname = \"live\"\nuntil = \"collapse\"\nloads = [{}]\n", loads.join(", "))
    }
}
