//! Abutments of an arch or a bridge: blocks behind and below the outermost springings, on a base with friction.

use super::lookup::out_of_range;
use serde_json::{Map, Value as Json, json};
use std::sync::Arc;
use voussoir_core::law::{FacetMode, FillResistance, InterfaceLaw, is_associated};
use voussoir_core::model::geometry::{Vec2, area_and_centroid};
use voussoir_core::model::{Body, Bond, Catalogue, Chord, FillPart, FillReaction, Gap, Joint, crosses_itself};
use voussoir_core::plugin::{Diagnostic, Keys};

/// Keys of an abutment. A key that is not given has the value of `[scene.abutments]`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Keys)]
pub struct Abutment {
    /// from the intrados end of the springing to the back
    #[key(unit = "m", range = "> 0", optional = "that of abutments")]
    pub width: Option<f64>,
    /// from the base up to the intrados end of the springing
    #[key(unit = "m", range = "> 0", optional = "that of abutments")]
    pub height: Option<f64>,
    /// coefficient of friction between the base and fixed ground
    #[key(unit = "-", range = ">= 0", optional = "that of abutments")]
    pub base_friction: Option<f64>,
    /// horizontal pressure up to which the ground behind the back resists
    #[key(unit = "Pa", range = ">= 0", optional = "that of abutments")]
    pub backing: Option<f64>,
}

/// `[scene.abutments]`.
#[derive(Debug, Clone, Copy, PartialEq, Keys)]
pub struct Abutments {
    /// Distance from the intrados end of the springing to the back \[m\].
    #[key(like = Abutment, optional = "left and right give it")]
    pub width: Option<f64>,
    /// Height of the intrados end of the springing above the base \[m\].
    #[key(like = Abutment, optional = "left and right give it")]
    pub height: Option<f64>,
    /// Coefficient of friction of the base.
    #[key(like = Abutment, optional = "left and right give it")]
    pub base_friction: Option<f64>,
    /// Greatest horizontal pressure behind the back \[Pa\].
    #[key(like = Abutment, optional = "the ground behind does not resist")]
    pub backing: Option<f64>,
    /// keys of the left abutment only
    #[key(optional = "it has the keys of abutments; without these the support is fixed")]
    pub left: Option<Abutment>,
    /// keys of the right abutment only
    #[key(optional = "it has the keys of abutments; without these the support is fixed")]
    pub right: Option<Abutment>,
}

/// Names of the blocks, left and right.
pub const NAMES: [&str; 2] = ["left_abutment", "right_abutment"];
/// Sub-tables, left and right.
const SIDES: [&str; 2] = ["left", "right"];

/// An abutment at its position.
#[derive(Debug, Clone)]
pub struct AbutmentBlock {
    /// Name of the block.
    pub name: &'static str,
    vertices: Vec<Vec2>,
    /// Ends of the joint on the ground, from right to left.
    base: [Vec2; 2],
    /// Level top from left to right; `None` if the springing reaches the back.
    top: Option<[Vec2; 2]>,
    /// Middle of the back.
    back: Vec2,
    /// Height of the back \[m\].
    back_height: f64,
    /// x of the direction towards the arch.
    towards: f64,
    base_friction: f64,
    backing: f64,
}

impl Abutments {
    /// Returns the keys of a side, with their values if the table or the side gives them. `None` if the support is fixed.
    fn side(&self, side: usize) -> Option<Abutment> {
        let Abutments { width, height, base_friction, backing, .. } = *self;
        let shared = Abutment { width, height, base_friction, backing };
        let own = [self.left, self.right][side];
        if own.is_none() && shared == Abutment::default() {
            return None;
        }
        let own = own.unwrap_or_default();
        Some(Abutment {
            width: own.width.or(width),
            height: own.height.or(height),
            base_friction: own.base_friction.or(base_friction),
            backing: own.backing.or(backing),
        })
    }

    /// Returns the mistakes in its numbers, with paths from its table.
    pub fn mistakes(&self) -> Vec<Diagnostic> {
        let mut wrong = Vec::new();
        let Abutments { width, height, base_friction, backing, left, right } = *self;
        let shared = Abutment { width, height, base_friction, backing };
        for (prefix, keys) in [("", Some(shared)), ("left.", left), ("right.", right)] {
            let Some(Abutment { width, height, base_friction, backing }) = keys else { continue };
            let named = [("width", width), ("height", height), ("base_friction", base_friction), ("backing", backing)];
            let given = named.into_iter().filter_map(|(key, value)| Some((key, value?)));
            wrong.extend(given.filter_map(|(key, value)| out_of_range::<Abutment>(&format!("{prefix}{key}"), value)));
        }
        for (side, name) in SIDES.into_iter().enumerate() {
            let Some(keys) = self.side(side) else { continue };
            let named = [("width", keys.width), ("height", keys.height), ("base_friction", keys.base_friction)];
            for (key, _) in named.iter().filter(|(_, value)| value.is_none()) {
                wrong.push(Diagnostic::new(*key, format!("is missing for the {name} abutment")));
            }
        }
        if [0, 1].iter().all(|side| self.side(*side).is_none()) {
            wrong.push(Diagnostic::new("width", "is missing: the table is empty"));
        }
        wrong.dedup_by(|a, b| a.path == b.path);
        wrong
    }

    /// Returns the abutments at the springings (left and right, each with its intrados and extrados end), or the mistakes
    /// with paths from its table.
    pub fn blocks(&self, springings: [[Vec2; 2]; 2]) -> Result<Vec<AbutmentBlock>, Vec<Diagnostic>> {
        let mut wrong = self.mistakes();
        if !wrong.is_empty() {
            return Err(wrong);
        }
        let mut blocks = Vec::new();
        for (side, springing) in springings.into_iter().enumerate() {
            let Some(keys) = self.side(side) else { continue };
            match keys.block(side, springing) {
                Ok(block) => blocks.extend(block),
                Err((key, message)) => {
                    let own = [self.left, self.right][side];
                    let beside = own.is_some_and(|own| if key == "width" { own.width } else { own.height }.is_some());
                    let path = if beside { format!("{}.{key}", SIDES[side]) } else { key.to_string() };
                    wrong.push(Diagnostic::new(path, message));
                }
            }
        }
        if wrong.is_empty() { Ok(blocks) } else { Err(wrong) }
    }
}

impl Abutment {
    /// Returns the block at a springing, or the key that does not fit with the reason.
    fn block(&self, side: usize, [inner, outer]: [Vec2; 2]) -> Result<Option<AbutmentBlock>, (&'static str, String)> {
        let (Some(width), Some(height), Some(base_friction)) = (self.width, self.height, self.base_friction) else {
            return Ok(None);
        };
        let outwards = [-1.0, 1.0][side];
        let (far, foot) = (inner.x + outwards * width, inner.y - height);
        let tolerance = 1e-12 * (width + height);
        let reach = outwards * (outer.x - inner.x);
        if reach > width + tolerance {
            return Err(("width", format!("{width} m is too narrow: the springing reaches {reach:.6} m outwards")));
        }
        if outer.y - foot <= tolerance {
            return Err(("height", format!("{height} m is too low: the springing reaches the base")));
        }
        let mut vertices = vec![Vec2::new(inner.x, foot), Vec2::new(far, foot), Vec2::new(far, outer.y), outer, inner];
        vertices.dedup_by(|a, b| (*a - *b).norm() <= tolerance);
        if side == 0 {
            vertices.reverse();
        }
        if area_and_centroid(&vertices).0 <= 0.0 || crosses_itself(&vertices) {
            return Err(("height", format!("{height} m: the springing crosses the sides of the {}", NAMES[side])));
        }
        let sorted = |a: Vec2, b: Vec2| if a.x < b.x { [a, b] } else { [b, a] };
        let [left, right] = sorted(Vec2::new(inner.x, foot), Vec2::new(far, foot));
        let corner = Vec2::new(far, outer.y);
        Ok(Some(AbutmentBlock {
            name: NAMES[side],
            vertices,
            base: [right, left],
            top: (width - reach > tolerance).then(|| sorted(corner, outer)),
            back: Vec2::new(far, (foot + outer.y) / 2.0),
            back_height: outer.y - foot,
            towards: -outwards,
            base_friction,
            backing: self.backing.unwrap_or(0.0),
        }))
    }
}

impl AbutmentBlock {
    /// Returns true if it is the block at the left springing.
    pub fn is_left(&self) -> bool {
        self.name == NAMES[0]
    }

    /// Returns the block with a material of the catalogue.
    pub fn body(&self, material: usize) -> Body {
        Body { name: self.name.into(), vertices: self.vertices.clone(), material, fixed: false }
    }

    /// Returns its joint with the ground, and adds the law of this joint to the catalogue. `joint` is the law of the other
    /// joints.
    pub fn base(
        &self,
        catalogue: &mut Catalogue,
        joint: usize,
        [ground, body]: [usize; 2],
    ) -> Result<Joint, Diagnostic> {
        let table = base_law(&*catalogue.laws[joint].1, self.base_friction);
        let law = serde_json::from_value::<Box<dyn InterfaceLaw>>(table)
            .map_err(|error| Diagnostic::new("abutments", format!("need the law \"mohr_coulomb\": {error}")))?;
        let mut name = format!("{}_base", self.name);
        while catalogue.law(&name).is_some() {
            name.push('_');
        }
        catalogue.laws.push((name, Arc::from(law)));
        let bond = Bond::Law(catalogue.laws.len() - 1);
        Ok(Joint { minus: ground, plus: body, ends: self.base, bond, gap: Gap::default() })
    }

    /// Returns its top, which carries fill and loads.
    pub fn face(&self, body: usize) -> Option<Chord> {
        self.top.map(|ends| Chord { body, ends, from_middle: Chord::NO_RING })
    }

    /// Returns the force of the ground behind it. `width` is the thickness out of plane \[m\].
    pub fn reaction(&self, body: usize, width: f64) -> Option<FillReaction> {
        if self.backing == 0.0 {
            return None;
        }
        let law = backing(self.backing)?;
        let area = self.back_height * width;
        let part = FillPart { area, overburden: 0.0, friction_angle: 0.0, cohesion: 0.0, law };
        let direction = Vec2::new(self.towards, 0.0);
        Some(FillReaction { body, point: self.back, direction, parts: vec![part] })
    }
}

/// Returns the law of ground or masonry that resists up to a pressure \[Pa\].
pub(super) fn backing(strength: f64) -> Option<Arc<dyn FillResistance>> {
    let table = json!({ "law": "backing", "strength": strength });
    serde_json::from_value::<Box<dyn FillResistance>>(table).ok().map(Arc::from)
}

/// Returns the table of the law of a base: friction and crushing, without tension and cohesion. Crushing strength, flow and
/// stiffness are as in `joint`.
fn base_law(joint: &dyn InterfaceLaw, friction: f64) -> Json {
    let facets = joint.facets().unwrap_or_default();
    let strength =
        facets.iter().filter(|facet| facet.normal[0] > 0.0).map(|facet| facet.bound / facet.normal[0]).reduce(f64::min);
    let sliding = || facets.iter().filter(|facet| facet.mode == FacetMode::Sliding && facet.flow[1] != 0.0);
    let mut table = Map::new();
    table.insert("law".into(), "mohr_coulomb".into());
    table.insert("friction".into(), friction.into());
    if let Some(strength) = strength {
        table.insert("compressive_strength".into(), strength.into());
    }
    if sliding().next().is_none() || !is_associated(&facets) {
        let dilatancy = sliding().map(|facet| -facet.flow[0] / facet.flow[1].abs()).reduce(f64::min);
        let angle = dilatancy.unwrap_or(0.0).clamp(0.0, friction).atan().to_degrees();
        table.insert("dilatancy_angle".into(), angle.into());
    }
    for (key, stiffness) in
        ["normal_stiffness", "shear_stiffness"].into_iter().zip(joint.stiffness().into_iter().flatten())
    {
        if stiffness.is_finite() {
            table.insert(key.into(), stiffness.into());
        }
    }
    table.into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenes::test_catalogue::catalogue;
    use voussoir_core::model::{Assembly, Scene};

    fn arch(abutments: Json) -> Result<Assembly, Vec<String>> {
        let scene = json!({
            "scene": "arch", "profile": { "shape": "segmental", "span": 9.42, "rise": 2.99 }, "thickness": 0.6,
            "width": 5.81, "voussoirs": 15, "material": "stone", "joint": "dry", "abutments": abutments,
        });
        let scene: Box<dyn Scene> = serde_json::from_value(scene).expect("a scene");
        scene.build(&catalogue()).map_err(|wrong| wrong.into_iter().map(|own| own.path).collect())
    }

    /// A key of one side replaces the key of both; a side without keys is a fixed support.
    #[test]
    fn each_side_has_its_own_keys_or_those_of_both() {
        let widths = |table: Json| {
            let assembly = arch(table).expect("an arch");
            let base = |name: &str| {
                let body = assembly.body(name)?;
                assembly.joints.iter().rfind(|joint| joint.plus == body).map(|joint| joint.height())
            };
            NAMES.map(base)
        };
        let near = |found: [Option<f64>; 2], expected: [Option<f64>; 2]| {
            let same = |(a, b): (Option<f64>, Option<f64>)| a.zip(b).map_or(a == b, |(a, b)| (a - b).abs() < 1e-12);
            assert!(found.into_iter().zip(expected).all(same), "{found:?} {expected:?}");
        };
        let both = json!({ "width": 3.0, "height": 2.0, "base_friction": 0.5 });
        near(widths(both.clone()), [Some(3.0), Some(3.0)]);
        near(widths(json!({ "left": both })), [Some(3.0), None]);
        let mut one = both;
        one["right"] = json!({ "width": 4.0 });
        near(widths(one), [Some(3.0), Some(4.0)]);
    }

    /// Missing, negative and too small numbers have the key of their table.
    #[test]
    fn mistakes_name_their_key() {
        let wrong = |table: Json| arch(table).expect_err("a mistake");
        assert_eq!(wrong(json!({})), ["scene.abutments.width"]);
        assert_eq!(wrong(json!({ "width": 3.0, "height": 2.0 })), ["scene.abutments.base_friction"]);
        let small = json!({ "width": 3.0, "height": 2.0, "base_friction": 0.5, "right": { "width": 0.2 } });
        assert_eq!(wrong(small), ["scene.abutments.right.width"]);
        let negative = json!({ "width": 3.0, "height": 2.0, "base_friction": -0.5, "left": { "height": f64::MIN } });
        assert_eq!(wrong(negative), ["scene.abutments.base_friction", "scene.abutments.left.height"]);
    }

    /// The base has the friction of its key, and crushing strength and flow of the other joints; it has neither cohesion
    /// nor tensile strength.
    #[test]
    fn a_base_slides_and_crushes_like_the_other_joints() {
        let base = |law: Json| {
            let law: Box<dyn InterfaceLaw> = serde_json::from_value(law).expect("a law");
            let base = base_law(&*law, 0.3);
            serde_json::from_value::<Box<dyn InterfaceLaw>>(base).expect("a law").facets().expect("facets")
        };
        let mortar = json!({
            "law": "mohr_coulomb", "friction": 0.6, "cohesion": 1e5, "tensile_strength": 1e5, "compressive_strength": 8e6
        });
        let facets = base(mortar);
        assert!(is_associated(&facets));
        assert_eq!(facets.iter().map(|facet| facet.bound).collect::<Vec<_>>(), [0.0, 0.0, 0.0, 8e6]);
        assert!(facets.iter().filter(|facet| facet.mode == FacetMode::Sliding).all(|facet| facet.normal[0] == -0.3));
        let facets = base(json!({ "law": "coulomb", "friction": 0.6 }));
        assert_eq!(facets.len(), 3);
        assert!(facets.iter().filter(|facet| facet.mode == FacetMode::Sliding).all(|facet| facet.flow[0] == 0.0));
    }
}
