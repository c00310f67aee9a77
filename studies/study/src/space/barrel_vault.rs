//! `barrel_vault`: a straight or skew barrel of voussoirs between two supports.
#![doc = include_str!("barrel_vault.md")]

use super::parts::Parts;
use super::shell_block::ShellBlock;
use crate::scenes::keys::SceneKeys;
use crate::scenes::lookup::{out_of_range, outside, pairs_of};
use crate::scenes::profile::{Profile, Ring};
use crate::scenes::thickness::Thickness;
use voussoir_core::model::geometry::Vec2;
use voussoir_core::model::{Assembly, Catalogue, Scene};
use voussoir_core::plugin::{Card, Diagnostic, Keys, PluginKind, Range, Sample};
use voussoir_core::space::{SpaceAssembly, Vec3};

/// Joints between the strips of a vault.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Keys)]
pub enum StripBond {
    /// They continue from course to course.
    Continuous,
    /// Odd courses are shifted by half a strip and end with halves.
    Half,
}

/// A barrel vault.
#[derive(Debug, Clone, PartialEq, Keys)]
#[keys(check = BarrelVault::validate)]
pub struct BarrelVault {
    /// shape of the intrados in a section normal to the axis; y of its points is the height
    pub profile: Profile,
    /// thickness, along the joints; { crown, springing } grows with the arc length between them
    #[key(optional = "the profile is a list of points")]
    pub thickness: Option<Thickness>,
    /// number of courses from springing to springing
    #[key(range = ">= 1, <= MAX_VOUSSOIRS", optional = "the profile is a list of points")]
    pub voussoirs: Option<usize>,
    /// length along the axis
    #[key(unit = "m", range = "> 0")]
    pub length: f64,
    /// number of blocks of an even course along the axis
    #[key(range = ">= 1, <= MAX_STRIPS", default = 1)]
    pub strips: usize,
    /// joints between strips: continuous, or shifted by half a strip in odd courses
    #[key(default = "continuous")]
    pub bond: StripBond,
    /// angle between the end faces and the plane normal to the axis, about the vertical
    #[key(unit = "deg", range = "> -80, < 80", default = 0.0)]
    pub skew: f64,
    /// Material of the blocks.
    #[key(like = SceneKeys)]
    pub material: String,
    /// Interface law of the joints.
    #[key(like = SceneKeys)]
    pub joint: String,
}

const MAX_VOUSSOIRS: usize = 10_000;
const MAX_STRIPS: usize = 1000;

impl BarrelVault {
    /// Returns the section, or all mistakes in the geometry, with paths from the scene's table.
    fn ring(&self) -> Result<Ring, Vec<Diagnostic>> {
        let mut diagnostics = Vec::new();
        diagnostics.extend(out_of_range::<Self>("length", self.length));
        diagnostics.extend(out_of_range::<Self>("skew", self.skew));
        let strips = Range::new(1.0, false, MAX_STRIPS as f64, false);
        diagnostics.extend(outside(strips, "strips", self.strips as f64));
        if self.voussoirs.is_some_and(|n| n > MAX_VOUSSOIRS) {
            diagnostics.push(Diagnostic::new("voussoirs", format!("at most {MAX_VOUSSOIRS}")));
            return Err(diagnostics);
        }
        match self.profile.ring(self.thickness, self.voussoirs, None) {
            Ok(ring) => {
                if !ring.is_plainly_simple() {
                    diagnostics
                        .push(Diagnostic::new("profile", "the section runs into itself, or a voussoir is concave"));
                }
                if diagnostics.is_empty() { Ok(ring) } else { Err(diagnostics) }
            }
            Err(wrong) => {
                diagnostics.extend(wrong);
                Err(diagnostics)
            }
        }
    }

    fn validate(&self) -> Vec<(String, String)> {
        self.ring().err().map(pairs_of).unwrap_or_default()
    }

    /// Returns the cuts between the strips of a course, in strips.
    fn cuts(&self, course: usize) -> Vec<f64> {
        let whole = |k: usize| k as f64;
        if self.bond == StripBond::Half && course % 2 == 1 {
            let halves = (0..self.strips).map(|k| whole(k) + 0.5);
            return [0.0].into_iter().chain(halves).chain([whole(self.strips)]).collect();
        }
        (0..=self.strips).map(whole).collect()
    }

    /// Returns a point of the section at a distance along the axis, in strips \[m\].
    fn point(&self, section: &Vec2, strips: f64) -> Vec3 {
        let along = self.length * strips / self.strips as f64;
        Vec3::new(section.x, along + section.x * self.skew.to_radians().tan(), section.y)
    }

    /// Returns the part between two columns of the section, each with an inner and an outer point, and two cuts.
    fn block(&self, columns: [[Vec2; 2]; 2], [start, end]: [f64; 2]) -> ShellBlock {
        let column = |[inner, outer]: [Vec2; 2]| {
            let at = |section: &Vec2, cut: f64| self.point(section, cut);
            [at(&inner, start), at(&outer, start), at(&inner, end), at(&outer, end)]
        };
        ShellBlock { columns: columns.map(column).to_vec() }
    }

    fn assemble(&self, parts: &mut Parts, ring: &Ring) {
        let joint = |k: usize| [ring.intrados[k], ring.extrados[k]];
        let (count, whole) = (ring.voussoirs(), [0.0, self.strips as f64]);
        let beyond = |k: usize, outward: f64| {
            let ends = joint(k);
            let across = ends[1] - ends[0];
            ends.map(|end| end + Vec2::new(across.y, -across.x) * outward)
        };
        let left = self.block([beyond(0, -1.0), joint(0)], whole);
        let right = self.block([joint(count), beyond(count, 1.0)], whole);
        let supports = [parts.body("left", left.shape(), true), parts.body("right", right.shape(), true)];
        let mut below = vec![(supports[0], whole)];
        for course in 0..count {
            let row: Vec<(usize, [f64; 2])> = self
                .cuts(course)
                .windows(2)
                .enumerate()
                .map(|(strip, cuts)| {
                    let cuts = [cuts[0], cuts[1]];
                    let shape = self.block([joint(course), joint(course + 1)], cuts).shape();
                    (parts.body(format!("{course}.{strip}"), shape, false), cuts)
                })
                .collect();
            for pair in row.windows(2) {
                let shape = self.block([joint(course), joint(course + 1)], pair[0].1);
                parts.contact(pair[0].0, pair[1].0, &shape.high(0));
            }
            self.join(parts, &below, &row, joint(course));
            below = row;
        }
        self.join(parts, &below, &[(supports[1], whole)], joint(count));
    }

    /// Adds the contacts of two courses at a joint of the section.
    fn join(&self, parts: &mut Parts, below: &[(usize, [f64; 2])], above: &[(usize, [f64; 2])], joint: [Vec2; 2]) {
        for (minus, one) in below {
            for (plus, other) in above {
                let cuts = [one[0].max(other[0]), one[1].min(other[1])];
                if cuts[1] > cuts[0] {
                    parts.contact(*minus, *plus, &self.block([joint, joint], cuts).last());
                }
            }
        }
    }
}

#[typetag::serde(name = "barrel_vault")]
impl Scene for BarrelVault {
    fn build(&self, catalogue: &Catalogue) -> Result<Assembly, Vec<Diagnostic>> {
        Ok(Assembly::without_blocks(catalogue.clone()))
    }

    fn build_space(&self, catalogue: &Catalogue) -> Option<Result<SpaceAssembly, Vec<Diagnostic>>> {
        let (ring, mistakes) = match self.ring() {
            Ok(ring) => (Some(ring), Vec::new()),
            Err(mistakes) => (None, mistakes),
        };
        let parts = Parts::new(catalogue, [&self.material, &self.joint], mistakes);
        Some(parts.map(|mut parts| {
            ring.iter().for_each(|ring| self.assemble(&mut parts, ring));
            parts.finish()
        }))
    }
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::Scene,
        tag: "barrel_vault",
        summary: "a straight or skew barrel vault between two supports",
        sources: &["Heyman 1995, The Stone Skeleton"],
        samples: &[
            Sample::keys(r#"profile = { shape = "segmental", span = 4.0, rise = 1.5 }
thickness = 0.4
voussoirs = 9
length = 3.0
strips = 3
bond = "half"
material = "stone"
joint = "dry""#),
            Sample::keys(r#"profile = { shape = "pointed", span = 4.0, rise = 2.5 }
thickness = 0.4
voussoirs = 8
length = 3.0
skew = 30.0
material = "brick"
joint = "mortar""#),
        ],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("barrel_vault.md"),
        ..Card::of::<BarrelVault>()
    }
}

#[cfg(test)]
mod tests {
    use super::super::parts::tests::{assert_conforming, built, counts, wrong};
    use serde_json::{Value, json};

    /// A semicircle of mean radius 1 and thickness 0.15.
    fn keys(extra: Value) -> Value {
        let mut keys = json!({
            "profile": { "shape": "segmental", "span": 1.85, "rise": 0.925 }, "thickness": 0.15, "voussoirs": 15,
            "length": 2.0,
        });
        for (key, value) in extra.as_object().unwrap() {
            keys[key] = value.clone();
        }
        keys
    }

    #[test]
    fn a_straight_barrel_is_an_arch_with_a_length() {
        let vault = built("barrel_vault", &keys(json!({}))).unwrap();
        assert_eq!(counts(&vault), [15, 16, 64]);
        assert_conforming(&vault);
        let wedge = (std::f64::consts::PI / 15.0).sin() / 2.0 * (1.075_f64.powi(2) - 0.925_f64.powi(2)) * 2.0;
        let (volume, _) = vault.bodies[5].shape.volume_and_centroid();
        assert!((volume - wedge).abs() < 1e-12, "{volume} {wedge}");
    }

    /// Strips in half bond: an even course of n blocks meets n + 1 blocks of the next course at 2 n contacts.
    #[test]
    fn strips_and_skew_are_conforming() {
        let bonded = built("barrel_vault", &keys(json!({ "strips": 4, "bond": "half" }))).unwrap();
        assert_eq!(counts(&bonded)[..2], [8 * 4 + 7 * 5, 2 * 4 + 14 * 8 + 8 * 3 + 7 * 4]);
        assert_conforming(&bonded);
        for skew in [-35.0, 35.0] {
            let skewed = built("barrel_vault", &keys(json!({ "strips": 3, "skew": skew, "bond": "half" }))).unwrap();
            assert_conforming(&skewed);
            let volume = |scene: &voussoir_core::space::SpaceAssembly| {
                scene.bodies[2..].iter().map(|body| body.shape.volume_and_centroid().0).sum::<f64>()
            };
            assert!((volume(&skewed) - volume(&bonded)).abs() < 1e-12, "skew keeps the volume");
        }
    }

    #[test]
    fn mistakes_are_reported_at_their_keys() {
        assert_eq!(
            wrong("barrel_vault", &keys(json!({ "length": 0.0, "skew": 85.0 }))),
            ["scene.length", "scene.skew"]
        );
        assert_eq!(wrong("barrel_vault", &keys(json!({ "thickness": -1.0 }))), ["scene.thickness"]);
        assert_eq!(wrong("barrel_vault", &keys(json!({ "voussoirs": null }))), ["scene.voussoirs"]);
    }
}
