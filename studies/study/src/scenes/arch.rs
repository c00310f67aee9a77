//! `arch`: a ring of voussoirs between two supports.
#![doc = include_str!("arch.md")]

use super::abutments::{AbutmentBlock, Abutments};
use super::keys::{PlaneState, SceneKeys};
use super::lookup::{from_root, law, material, out_of_range, pairs_of, take};
use super::mesh::{Mesh, density, mesh_diagnostics};
use super::overlap::overlap;
use super::profile::{Profile, Ring, Springing};
use super::thickness::Thickness;
use voussoir_core::model::geometry::bounding_box;
use voussoir_core::model::{ArchLayout, Assembly, Body, Bond, Bridge, Catalogue, Gap, Joint, Scene, find_joints};
use voussoir_core::plugin::{Card, Diagnostic, Keys, PluginKind, Sample};

/// Connection of the ring with its supports.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Keys)]
pub enum Ends {
    /// The springing faces move with the supports.
    Bonded,
    /// The springing joints follow the interface law.
    Jointed,
}

const MAX_VOUSSOIRS: usize = 2_000_000;

/// A ring of voussoirs between two supports.
#[derive(Debug, Clone, PartialEq, Keys)]
#[keys(check = Arch::validate)]
pub struct Arch {
    /// shape of the intrados
    pub profile: Profile,
    /// thickness of the ring, along the joints; { crown, springing } grows with the arc length between them
    #[key(optional = "the profile is a list of points")]
    pub thickness: Option<Thickness>,
    /// Width out of plane \[m\].
    #[key(like = SceneKeys)]
    pub width: f64,
    /// Stress state of deformable voussoirs.
    #[key(like = SceneKeys, default)]
    pub plane: PlaneState,
    /// number of voussoirs
    #[key(range = ">= 1, <= MAX_VOUSSOIRS", optional = "the profile is a list of points")]
    pub voussoirs: Option<usize>,
    /// bonded: the springing faces move with the supports; jointed: they follow the interface law
    #[key(default = "jointed")]
    pub ends: Ends,
    /// inclination of the support plane above the horizontal, rising outwards; one number or \[left, right\]
    #[key(optional = "the end joints are normal to the intrados")]
    pub springing: Option<Springing>,
    /// abutments behind the springings, on a base with friction
    #[key(optional = "fixed supports")]
    pub abutments: Option<Abutments>,
    /// Material of the voussoirs.
    #[key(like = SceneKeys)]
    pub material: String,
    /// Interface law of the joints.
    #[key(like = SceneKeys)]
    pub joint: String,
    /// Mesh of deformable voussoirs.
    #[key(like = SceneKeys)]
    pub mesh: Option<Mesh>,
}

impl Arch {
    /// Returns the ring, or all mistakes in the geometry, with paths from the scene's table.
    pub fn ring(&self) -> Result<Ring, Vec<Diagnostic>> {
        let mut diagnostics = Vec::new();
        diagnostics.extend(out_of_range::<Self>("width", self.width));
        diagnostics.extend(mesh_diagnostics(self.mesh.as_ref()));
        if self.voussoirs.is_some_and(|n| n > MAX_VOUSSOIRS) {
            diagnostics.push(Diagnostic::new("voussoirs", format!("at most {MAX_VOUSSOIRS}")));
            return Err(diagnostics);
        }
        match self.profile.ring(self.thickness, self.voussoirs, self.springing) {
            Ok(ring) => {
                diagnostics.extend(self.overlap(&ring));
                if diagnostics.is_empty() { Ok(ring) } else { Err(diagnostics) }
            }
            Err(mut wrong) => {
                diagnostics.append(&mut wrong);
                Err(diagnostics)
            }
        }
    }

    /// Reports a ring given by points that overlaps itself, as can happen near a full circle.
    fn overlap(&self, ring: &Ring) -> Option<Diagnostic> {
        if ring.is_plainly_simple() {
            return None;
        }
        let bodies: Vec<_> = (0..ring.voussoirs()).map(|k| voussoir(ring, k, 0)).collect();
        let (low, high) = bounding_box(ring.intrados.iter().chain(&ring.extrados));
        let (_, overlaps) = find_joints(&bodies, (high - low).norm(), |_, _| (Bond::Bonded, Gap::default()));
        let worst = overlaps.into_iter().max_by(|a, b| a.depth.total_cmp(&b.depth))?;
        let [a, b] = worst.bodies;
        let key = if self.springing.is_some() { "springing" } else { "profile" };
        Some(Diagnostic::new(
            key,
            format!("voussoirs {a} and {b} overlap by {:.3e} m: the ring runs into itself", worst.depth),
        ))
    }

    /// Returns the ring and its abutments, or all mistakes in the geometry.
    fn shapes(&self) -> Result<(Ring, Vec<AbutmentBlock>), Vec<Diagnostic>> {
        let below = |wrong: Vec<Diagnostic>| wrong.into_iter().map(|own| own.below("abutments"));
        let ring = self.ring().map_err(|mut wrong| {
            wrong.extend(below(self.abutments.map(|own| own.mistakes()).unwrap_or_default()));
            wrong
        })?;
        let blocks = match &self.abutments {
            Some(abutments) => {
                let springing = |k: usize| [ring.intrados[k], ring.extrados[k]];
                let blocks = abutments.blocks([springing(0), springing(ring.voussoirs())]);
                blocks.map_err(|wrong| below(wrong).collect::<Vec<_>>())?
            }
            None => Vec::new(),
        };
        Ok((ring, blocks))
    }

    fn validate(&self) -> Vec<(String, String)> {
        self.shapes().err().map(pairs_of).unwrap_or_default()
    }
}

fn voussoir(ring: &Ring, k: usize, material: usize) -> Body {
    Body { name: k.to_string(), vertices: ring.voussoir(k), material, fixed: false }
}

#[typetag::serde(name = "arch")]
impl Scene for Arch {
    fn build(&self, catalogue: &Catalogue) -> Result<Assembly, Vec<Diagnostic>> {
        let mut diagnostics = Vec::new();
        let material = take(material(catalogue, &self.material, "material"), &mut diagnostics);
        let law = take(law(catalogue, &self.joint, "joint"), &mut diagnostics);
        let shapes = self.shapes().map_err(|mut wrong| diagnostics.append(&mut wrong)).ok();
        let (Some(material), Some(law), Some((ring, abutments))) = (material, law, shapes) else {
            return Err(from_root(diagnostics));
        };
        let count = ring.voussoirs();
        let support = |name: &str| Body { name: name.into(), vertices: Vec::new(), material, fixed: true };
        let mut bodies = vec![support("left")];
        let (left, right): (Vec<_>, Vec<_>) = abutments.iter().partition(|abutment| abutment.is_left());
        bodies.extend(left.iter().map(|abutment| abutment.body(material)));
        let first = bodies.len();
        bodies.extend((0..count).map(|k| voussoir(&ring, k, material)));
        bodies.extend(right.iter().map(|abutment| abutment.body(material)));
        bodies.push(support("right"));
        let joint = |k: usize| Joint {
            minus: first + k - 1,
            plus: first + k,
            ends: [ring.intrados[k], ring.extrados[k]],
            bond: if self.ends == Ends::Bonded && (k == 0 || k == count) { Bond::Bonded } else { Bond::Law(law) },
            gap: Gap::default(),
        };
        let mut assembly = Assembly {
            joints: (0..=count).map(joint).collect(),
            bodies,
            width: self.width,
            plane: self.plane.into(),
            mesh: density(self.mesh),
            arch: Some(ArchLayout { first, voussoirs: count, span: ring.span, rise: ring.rise }),
            bridge: None,
            catalogue: catalogue.clone(),
        };
        if !abutments.is_empty() {
            self.add_abutments(&mut assembly, &abutments, law).map_err(|wrong| from_root(vec![wrong]))?;
        }
        Ok(assembly)
    }
}

impl Arch {
    /// Adds the bases of abutments, their upper faces, and the ground behind them.
    fn add_abutments(
        &self,
        assembly: &mut Assembly,
        abutments: &[AbutmentBlock],
        law: usize,
    ) -> Result<(), Diagnostic> {
        if let Some(wrong) = overlap(&assembly.bodies, "abutments") {
            return Err(wrong);
        }
        let mut extrados = assembly.extrados();
        let (radial, last) = (assembly.joints.len(), assembly.bodies.len() - 1);
        let mut reactions = Vec::new();
        for abutment in abutments {
            let [ground, body] = if abutment.is_left() { [0, 1] } else { [last, last - 1] };
            assembly.joints.push(abutment.base(&mut assembly.catalogue, law, [ground, body])?);
            let place = if abutment.is_left() { 0 } else { extrados.len() };
            extrados.splice(place..place, abutment.face(body));
            reactions.extend(abutment.reaction(body, self.width));
        }
        let springings = [0, radial - 1].map(|joint| assembly.joints[joint].ends[0].x);
        let longest_span = assembly.span();
        assembly.bridge = Some(Bridge { extrados, springings, longest_span, radial, reactions, ..Bridge::default() });
        Ok(())
    }
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::Scene,
        tag: "arch",
        summary: "a ring of voussoirs between two supports",
        sources: &["Heyman 1982, The Masonry Arch"],
        samples: &[
            Sample::keys(r#"profile = { shape = "segmental", span = 9.0, rise = 2.0 }
thickness = 0.6
width = 2.0
voussoirs = 15
springing = 30.0
material = "stone"
joint = "dry""#),
            Sample::keys(r#"profile = { shape = "elliptical", span = 9.0, rise = 2.0 }
thickness = { crown = 0.5, springing = 0.7 }
width = 2.0
voussoirs = 9
ends = "bonded"
plane = "strain"
material = "brick"
joint = "mortar"
mesh = { elements = [2, 4] }"#),
            Sample::keys(r#"profile = { shape = "segmental", span = 9.0, rise = 3.0 }
thickness = 0.6
width = 2.0
voussoirs = 9
material = "stone"
joint = "dry"
abutments = { width = 3.0, height = 2.0, base_friction = 0.5, right = { width = 4.0, backing = 1e4 } }"#),
        ],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("arch.md"),
        ..Card::of::<Arch>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenes::test_catalogue::catalogue;
    use serde_json::{Value, json};
    use voussoir_core::model::geometry::Vec2;

    fn arch(extra: Value) -> Result<Assembly, Vec<Diagnostic>> {
        let mut scene = json!({
            "scene": "arch", "profile": { "shape": "segmental", "span": 9.42, "rise": 2.99 }, "thickness": 0.6,
            "width": 5.81, "voussoirs": 15, "material": "stone", "joint": "dry",
        });
        for (key, value) in extra.as_object().unwrap() {
            scene[key] = value.clone();
        }
        serde_json::from_value::<Box<dyn Scene>>(scene).unwrap().build(&catalogue())
    }

    #[test]
    fn bodies_and_joints_run_from_left_to_right_with_normals_into_the_next_body() {
        let arch = arch(json!({ "ends": "bonded" })).unwrap();
        assert_eq!(arch.bodies.len(), 17);
        assert_eq!(arch.bodies[0].name, "left");
        assert_eq!(arch.bodies[16].name, "right");
        assert_eq!(arch.bodies[15].name, "14");
        assert_eq!(arch.joints.len(), 16);
        for (k, joint) in arch.joints.iter().enumerate() {
            assert_eq!((joint.minus, joint.plus), (k, k + 1));
            assert_eq!(joint.bond == Bond::Bonded, k == 0 || k == 15);
            assert!((joint.height() - 0.6).abs() < 1e-14);
            if (1..15).contains(&k) {
                assert!((arch.inertia(k + 1).centroid - joint.middle()).dot(&joint.frame().0) > 0.0);
            }
        }
        assert_eq!(arch.arch.as_ref().map(|layout| (layout.first, layout.voussoirs)), Some((1, 15)));
    }

    #[test]
    fn joints_found_from_the_polygons_are_those_of_the_ring() {
        let arch = arch(json!({})).unwrap();
        let (found, overlaps) = find_joints(&arch.bodies[1..16], arch.size(), |_, _| (Bond::Law(0), Gap::default()));
        assert!(overlaps.is_empty());
        assert_eq!(found.len(), 14);
        for (found, joint) in found.iter().zip(&arch.joints[1..]) {
            assert_eq!(found.ends, joint.ends);
        }
    }

    #[test]
    fn mistakes_are_reported_together_each_at_its_key() {
        let wrong = arch(json!({
            "material": "ston", "joint": "damp", "width": 0.0, "thickness": -1.0, "springing": 100.0,
            "mesh": { "elements": [0, 4], "order": 4, "grading": 0.5 },
            "profile": { "shape": "pointed", "span": 4.0, "rise": 1.0 },
        }));
        let mut paths: Vec<_> = wrong.unwrap_err().into_iter().map(|diagnostic| diagnostic.path).collect();
        paths.sort();
        let keys = [
            "joint",
            "material",
            "mesh.elements.0",
            "mesh.grading",
            "mesh.order",
            "profile.rise",
            "springing",
            "thickness",
            "width",
        ];
        assert_eq!(paths, keys.map(|key| format!("scene.{key}")));
    }

    #[test]
    fn a_nearly_closed_ring_with_a_gap_at_the_springings_is_accepted() {
        let profile = json!({ "shape": "segmental", "span": 0.2, "rise": 2.0 });
        assert!(arch(json!({ "profile": profile, "thickness": 0.3, "voussoirs": 24, "springing": -89.0 })).is_ok());
    }

    #[test]
    fn a_ring_whose_ends_run_into_each_other_is_refused() {
        let points = json!({
            "profile": {
                "shape": "points",
                "intrados": [[-0.1, 0.0], [-1.0, 1.0], [0.0, 2.0], [1.0, 1.0], [0.1, 0.0]],
                "extrados": [[0.2, -0.5], [-1.5, 1.0], [0.0, 2.5], [1.5, 1.0], [-0.2, -0.5]],
            },
            "thickness": null, "voussoirs": null,
        });
        let wrong = arch(points).unwrap_err();
        assert!(wrong[0].path == "scene.profile" && wrong[0].message.contains("overlap"), "{wrong:?}");
    }

    /// Spirals of points, some of which overlap themselves: the check of the outline agrees with the check of all pairs of
    /// voussoirs.
    #[test]
    fn a_ring_with_a_plainly_simple_outline_has_no_overlaps() {
        let mut simple = 0;
        for case in 0..60 {
            let (turn, shrinks) = (4.0 + 0.05 * f64::from(case), 0.02 * f64::from(case % 7));
            let side = |radius: f64| -> Vec<Vec2> {
                let angles = (0..=24).map(|k| (f64::from(k), turn * (0.5 - f64::from(k) / 24.0)));
                angles.map(|(k, a)| Vec2::new(-a.sin(), a.cos()) * radius * (1.0 - shrinks * k / 24.0)).collect()
            };
            let ring = Ring { intrados: side(1.0), extrados: side(1.1), span: 1.0, rise: 1.0 };
            let bodies: Vec<_> = (0..ring.voussoirs()).map(|k| voussoir(&ring, k, 0)).collect();
            let (_, overlaps) = find_joints(&bodies, 2.0, |_, _| (Bond::Bonded, Gap::default()));
            assert!(!ring.is_plainly_simple() || overlaps.is_empty(), "{case}: {overlaps:?}");
            simple += usize::from(ring.is_plainly_simple());
        }
        assert!(simple > 10 && simple < 60, "{simple}");
    }

    #[test]
    fn unknown_keys_are_refused() {
        let value = json!({ "shape": "segmental", "span": 1.0, "rise": 0.4, "crown": 1.0 });
        assert!(serde_json::from_value::<Profile>(value).is_err());
    }
}
