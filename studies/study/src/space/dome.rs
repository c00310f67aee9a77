//! `dome`: a spherical dome of rings and meridians, or of lunes.
#![doc = include_str!("dome.md")]

use super::parts::Parts;
use super::shell_block::{ShellBlock, surface};
use crate::scenes::keys::SceneKeys;
use crate::scenes::lookup::{out_of_range, outside, pairs_of};
use voussoir_core::model::{Assembly, Catalogue, Scene};
use voussoir_core::plugin::{Card, Diagnostic, Keys, PluginKind, Range, Sample};
use voussoir_core::space::{SpaceAssembly, Vec3};

/// Joints between the blocks of a ring.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Keys)]
pub enum MeridianBond {
    /// They continue from ring to ring.
    Continuous,
    /// Each ring is turned by half a block.
    Half,
}

/// A spherical dome.
#[derive(Debug, Clone, PartialEq, Keys)]
#[keys(check = Dome::validate)]
pub struct Dome {
    /// radius of the middle surface
    #[key(unit = "m", range = "> 0")]
    pub radius: f64,
    /// thickness, less than twice the radius
    #[key(unit = "m", range = "> 0")]
    pub thickness: f64,
    /// number of rings
    #[key(range = ">= 1, <= MAX_RINGS")]
    pub rings: usize,
    /// number of blocks in a ring
    #[key(range = ">= 3, <= MAX_MERIDIANS")]
    pub meridians: usize,
    /// angle from the axis to the upper edge of the highest ring; 0 closes the dome
    #[key(unit = "deg", range = ">= 0, < 90", default = 0.0)]
    pub oculus: f64,
    /// angle from the axis to the springing, more than `oculus`
    #[key(unit = "deg", range = "> 0, <= 150", default = 90.0)]
    pub springing: f64,
    /// a block closes the oculus
    #[key(default = false)]
    pub crown: bool,
    /// joints between the blocks of a ring: continuous, or turned by half a block in odd rings, counted from 0 at the
    /// springing
    #[key(default = "continuous")]
    pub bond: MeridianBond,
    /// contact between the blocks of a ring; without it the dome consists of lunes
    #[key(default = true)]
    pub hoop: bool,
    /// azimuth of the first joint, from x to y
    #[key(unit = "deg", default = 0.0)]
    pub azimuth: f64,
    /// Material of the blocks.
    #[key(like = SceneKeys)]
    pub material: String,
    /// Interface law of the joints.
    #[key(like = SceneKeys)]
    pub joint: String,
}

const MAX_RINGS: usize = 1000;
const MAX_MERIDIANS: usize = 1000;

impl Dome {
    /// Returns the mistakes in the geometry, with paths from the scene's table.
    fn mistakes(&self) -> Vec<Diagnostic> {
        let mut diagnostics = Vec::new();
        let numbers = [
            ("radius", self.radius),
            ("thickness", self.thickness),
            ("oculus", self.oculus),
            ("springing", self.springing),
            ("azimuth", self.azimuth),
        ];
        diagnostics.extend(numbers.iter().filter_map(|(key, value)| out_of_range::<Self>(key, *value)));
        for (key, count, range) in [
            ("rings", self.rings, Range::new(1.0, false, MAX_RINGS as f64, false)),
            ("meridians", self.meridians, Range::new(3.0, false, MAX_MERIDIANS as f64, false)),
        ] {
            diagnostics.extend(outside(range, key, count as f64));
        }
        if !diagnostics.is_empty() {
            return diagnostics;
        }
        if self.thickness >= 2.0 * self.radius {
            let message = format!("{} m must be less than twice the radius of {} m", self.thickness, self.radius);
            diagnostics.push(Diagnostic::new("thickness", message));
        }
        if self.springing <= self.oculus {
            let message = format!("{}° must be more than the angle of the oculus, {}°", self.springing, self.oculus);
            diagnostics.push(Diagnostic::new("springing", message));
        }
        if self.crown && self.oculus == 0.0 {
            let wrong = Diagnostic::new("crown", "there is no oculus that a block can close");
            diagnostics.push(wrong.help("give oculus > 0, or crown = false"));
        }
        if !self.hoop && !self.crown {
            let wrong = Diagnostic::new("hoop", "lunes without a crown block do not touch each other");
            diagnostics.push(wrong.help("give crown = true and oculus > 0"));
        }
        if !self.hoop && self.bond == MeridianBond::Half {
            diagnostics.push(Diagnostic::new("bond", "the joints of lunes are continuous"));
        }
        diagnostics
    }

    fn validate(&self) -> Vec<(String, String)> {
        pairs_of(self.mistakes())
    }

    /// Returns the number of plane facets of a block along its ring.
    fn facets(&self) -> usize {
        match self.bond {
            MeridianBond::Continuous => 1,
            MeridianBond::Half => 2,
        }
    }

    /// Returns the number of facets in a ring.
    fn facets_of_ring(&self) -> usize {
        self.facets() * self.meridians
    }

    /// Returns the first facet of a block; ring 0 is at the springing.
    fn first_facet(&self, ring: usize, block: usize) -> usize {
        self.facets() * block + if self.facets() == 2 { ring % 2 } else { 0 }
    }

    /// Returns the block of a ring that has a facet.
    fn block_of(&self, ring: usize, facet: usize) -> usize {
        let count = self.facets_of_ring();
        (facet + count - self.first_facet(ring, 0)) % count / self.facets()
    }

    /// Returns the angle from the axis to a bed joint \[rad\]; joint 0 is the springing.
    fn angle(&self, joint: usize) -> f64 {
        let share = joint as f64 / self.rings as f64;
        (self.springing + (self.oculus - self.springing) * share).to_radians()
    }

    /// Returns the horizontal direction of a facet's first side.
    fn direction(&self, facet: usize) -> Vec3 {
        let facet = facet % self.facets_of_ring();
        let azimuth = (self.azimuth + 360.0 * facet as f64 / self.facets_of_ring() as f64).to_radians();
        Vec3::new(azimuth.cos(), azimuth.sin(), 0.0)
    }

    /// Returns the inner and the outer point of a bed joint at a facet's first side \[m\].
    fn ends(&self, joint: usize, facet: usize) -> [Vec3; 2] {
        let (angle, half) = (self.angle(joint), self.thickness / 2.0);
        let normal = self.direction(facet) * angle.sin() + Vec3::z() * angle.cos();
        [self.radius - half, self.radius + half].map(|radius| normal * radius)
    }

    fn block(&self, ring: usize, block: usize) -> ShellBlock {
        let first = self.first_facet(ring, block);
        let column = |facet: usize| {
            let ([a, b], [c, d]) = (self.ends(ring, facet), self.ends(ring + 1, facet));
            [a, b, c, d]
        };
        ShellBlock { columns: (first..=first + self.facets()).map(column).collect() }
    }

    /// Returns a ring below the springing as high as the dome is thick, as columns all the way round.
    fn ground(&self) -> ShellBlock {
        let angle = self.angle(0);
        let column = |facet: usize| {
            let down = (self.direction(facet) * angle.cos() - Vec3::z() * angle.sin()) * self.thickness;
            let [inner, outer] = self.ends(0, facet);
            [inner + down, outer + down, inner, outer]
        };
        ShellBlock { columns: (0..=self.facets_of_ring()).map(column).collect() }
    }

    /// Returns the faces of the block in the oculus: one below, one above, and a facet for each facet of the highest ring.
    fn crown_faces(&self) -> Vec<Vec<Vec3>> {
        let count = self.facets_of_ring();
        let ends: Vec<[Vec3; 2]> = (0..count).map(|facet| self.ends(self.rings, facet)).collect();
        let mut faces = vec![ends.iter().rev().map(|end| end[0]).collect(), ends.iter().map(|end| end[1]).collect()];
        faces.extend((0..count).map(|facet| {
            let ([a, b], [c, d]) = (ends[facet], ends[(facet + 1) % count]);
            vec![a, c, d, b]
        }));
        faces
    }

    fn assemble(&self, parts: &mut Parts) {
        let ground = self.ground();
        let mut faces = Vec::new();
        for facet in 0..self.facets_of_ring() {
            let ring = ShellBlock { columns: ground.columns[facet..facet + 2].to_vec() };
            faces.extend([ring.low(0), ring.high(0), ring.outside(0), ring.inside(0)]);
        }
        let ground_index = parts.body("ground", surface(&faces), true);
        let index = |ring: usize, block: usize| ground_index + 1 + ring * self.meridians + block % self.meridians;
        for ring in 0..self.rings {
            for block in 0..self.meridians {
                parts.body(format!("{ring}.{block}"), self.block(ring, block).shape(), false);
            }
        }
        for facet in 0..self.facets_of_ring() {
            parts.contact(ground_index, index(0, self.block_of(0, facet)), &ground.high(facet));
        }
        for ring in 0..self.rings {
            for block in 0..self.meridians {
                let shape = self.block(ring, block);
                if self.hoop {
                    parts.contact(index(ring, block), index(ring, block + 1), &shape.last());
                }
                for s in 0..self.facets() {
                    let facet = (self.first_facet(ring, block) + s) % self.facets_of_ring();
                    if ring + 1 < self.rings {
                        let above = index(ring + 1, self.block_of(ring + 1, facet));
                        parts.contact(index(ring, block), above, &shape.high(s));
                    }
                }
            }
        }
        if self.crown {
            self.add_crown(parts, index);
        }
    }

    fn add_crown(&self, parts: &mut Parts, index: impl Fn(usize, usize) -> usize) {
        let crown = parts.body("crown", surface(&self.crown_faces()), false);
        let top = self.rings - 1;
        for block in 0..self.meridians {
            let shape = self.block(top, block);
            (0..self.facets()).for_each(|s| parts.contact(index(top, block), crown, &shape.high(s)));
        }
    }
}

#[typetag::serde(name = "dome")]
impl Scene for Dome {
    fn build(&self, catalogue: &Catalogue) -> Result<Assembly, Vec<Diagnostic>> {
        Ok(Assembly::without_blocks(catalogue.clone()))
    }

    fn build_space(&self, catalogue: &Catalogue) -> Option<Result<SpaceAssembly, Vec<Diagnostic>>> {
        let parts = Parts::new(catalogue, [&self.material, &self.joint], self.mistakes());
        Some(parts.map(|mut parts| {
            self.assemble(&mut parts);
            parts.finish()
        }))
    }
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::Scene,
        tag: "dome",
        summary: "a spherical dome of rings and meridians, or of lunes",
        sources: &["Heyman 1977, Equilibrium of Shell Structures (domes and lunes)"],
        samples: &[
            Sample::keys(r#"radius = 4.0
thickness = 0.4
rings = 4
meridians = 8
oculus = 10.0
material = "stone"
joint = "dry""#),
            Sample::keys(r#"radius = 4.0
thickness = 0.4
rings = 5
meridians = 6
springing = 80.0
bond = "half"
material = "brick"
joint = "mortar""#),
            Sample::keys(r#"radius = 4.0
thickness = 0.4
rings = 4
meridians = 6
oculus = 5.0
crown = true
hoop = false
azimuth = 15.0
material = "stone"
joint = "dry""#),
        ],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("dome.md"),
        ..Card::of::<Dome>()
    }
}

#[cfg(test)]
mod tests {
    use super::super::parts::tests::{assert_conforming, built, counts, wrong};
    use serde_json::{Value, json};
    use std::f64::consts::PI;

    fn keys(extra: Value) -> Value {
        let mut keys = json!({ "radius": 1.0, "thickness": 0.1, "rings": 8, "meridians": 16, "oculus": 10.0 });
        for (key, value) in extra.as_object().unwrap() {
            keys[key] = value.clone();
        }
        keys
    }

    #[test]
    fn a_dome_of_eight_rings_and_sixteen_meridians_has_its_known_numbers() {
        let dome = built("dome", &keys(json!({}))).unwrap();
        assert_eq!(counts(&dome), [128, 256, 1024]);
        assert_conforming(&dome);
    }

    #[test]
    fn every_form_of_a_dome_is_closed_and_has_the_contacts_that_the_finder_finds() {
        for extra in [
            json!({ "bond": "half" }),
            json!({ "bond": "half", "crown": true, "azimuth": 7.0, "springing": 75.0 }),
            json!({ "oculus": 0.0 }),
            json!({ "oculus": 0.0, "bond": "half", "rings": 3, "meridians": 5 }),
            json!({ "springing": 110.0, "crown": true }),
        ] {
            assert_conforming(&built("dome", &keys(extra)).unwrap());
        }
    }

    /// Bonded blocks have two facets a bed joint. Lunes have no contact between neighbours, and a common crown block.
    #[test]
    fn bonds_and_lunes_have_their_numbers_of_contacts() {
        assert_eq!(counts(&built("dome", &keys(json!({ "bond": "half" }))).unwrap())[..2], [128, 128 + 8 * 32]);
        let lunes = built("dome", &keys(json!({ "hoop": false, "crown": true }))).unwrap();
        assert_eq!(counts(&lunes)[..2], [129, 9 * 16]);
    }

    /// With many blocks the volume tends to the volume of the spherical shell between two cones.
    #[test]
    fn the_volume_is_that_of_the_shell() {
        let dome = built("dome", &keys(json!({ "rings": 60, "meridians": 120 }))).unwrap();
        let free = dome.bodies.iter().filter(|body| !body.fixed);
        let volume: f64 = free.map(|body| body.shape.volume_and_centroid().0).sum();
        let shell = 2.0 * PI / 3.0 * (1.05_f64.powi(3) - 0.95_f64.powi(3)) * 10_f64.to_radians().cos();
        assert!((volume / shell - 1.0).abs() < 1e-3, "{volume} {shell}");
    }

    #[test]
    fn mistakes_are_reported_at_their_keys() {
        assert_eq!(wrong("dome", &keys(json!({ "thickness": 3.0 }))), ["scene.thickness"]);
        assert_eq!(wrong("dome", &keys(json!({ "springing": 5.0 }))), ["scene.springing"]);
        assert_eq!(wrong("dome", &keys(json!({ "oculus": 0.0, "crown": true }))), ["scene.crown"]);
        assert_eq!(wrong("dome", &keys(json!({ "hoop": false, "bond": "half" }))), ["scene.hoop", "scene.bond"]);
        assert_eq!(
            wrong("dome", &keys(json!({ "meridians": 2, "material": "ston" }))),
            ["scene.meridians", "scene.material"]
        );
    }
}
