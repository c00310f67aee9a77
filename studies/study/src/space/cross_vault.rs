//! `cross_vault`: four webs of two crossing barrels that meet in groins.
#![doc = include_str!("cross_vault.md")]

use super::barrel_vault::StripBond;
use super::fill::{Columns, VaultFill};
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

/// Section of both barrels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Keys)]
pub enum WebSection {
    /// Circular arcs; the spans are equal.
    Segmental,
    /// Half ellipses.
    Elliptical,
}

/// A groin vault.
#[derive(Debug, Clone, PartialEq, Keys)]
#[keys(check = CrossVault::validate)]
pub struct CrossVault {
    /// clear spans along x and along y
    #[key(names = ["x", "y"], unit = "m", range = "> 0")]
    pub spans: [f64; 2],
    /// rise of the intrados of both barrels
    #[key(unit = "m", range = "> 0")]
    pub rise: f64,
    /// thickness of the webs, normal to the intrados
    #[key(unit = "m", range = "> 0")]
    pub thickness: f64,
    /// section of the barrels: segmental with equal spans, or elliptical
    #[key(default = "segmental")]
    pub section: WebSection,
    /// number of courses of a barrel from springing to springing
    #[key(range = ">= 3, <= MAX_VOUSSOIRS")]
    pub voussoirs: usize,
    /// number of blocks along the axis of a barrel from the centre to the edge
    #[key(range = ">= 1, <= MAX_STRIPS", default = 1)]
    pub strips: usize,
    /// joints between strips: continuous, or shifted by half a strip in odd courses, counted from 0 at the springing
    #[key(default = "continuous")]
    pub bond: StripBond,
    /// courses at each springing that are part of the supports
    #[key(range = ">= 1, <= MAX_VOUSSOIRS")]
    pub springers: usize,
    /// fill above the webs up to a level; its weight acts on the blocks below: { height = 2.5, density = 1800.0 }
    #[key(optional = "no fill")]
    pub fill: Option<VaultFill>,
    /// Material of the blocks.
    #[key(like = SceneKeys)]
    pub material: String,
    /// Interface law of the joints.
    #[key(like = SceneKeys)]
    pub joint: String,
}

const MAX_VOUSSOIRS: usize = 1000;
const MAX_STRIPS: usize = 1000;
/// Least length of a block along the axis as a share of a strip; shorter ones are part of their neighbour.
const LEAST_PART: f64 = 0.25;
/// Names of the webs, each turned by 90° from the one before.
const WEBS: [&str; 4] = ["east", "north", "west", "south"];

/// A web in its own axes: u from the centre to the edge, v across, z up.
struct Web {
    turns: usize,
    /// Half the span along u and across \[m\].
    half: [f64; 2],
    ring: Ring,
}

impl CrossVault {
    /// Returns the webs, or all mistakes in the geometry, with paths from the scene's table.
    fn webs(&self) -> Result<Vec<Web>, Vec<Diagnostic>> {
        let mut diagnostics = Vec::new();
        let spans = self.spans.iter().enumerate();
        diagnostics.extend(spans.filter_map(|(i, span)| out_of_range::<Self>(&format!("spans.{i}"), *span)));
        let lengths = [("rise", self.rise), ("thickness", self.thickness)];
        diagnostics.extend(lengths.iter().filter_map(|(key, value)| out_of_range::<Self>(key, *value)));
        for (key, count, least, most) in [
            ("voussoirs", self.voussoirs, 3.0, MAX_VOUSSOIRS),
            ("strips", self.strips, 1.0, MAX_STRIPS),
            ("springers", self.springers, 1.0, MAX_VOUSSOIRS),
        ] {
            diagnostics.extend(outside(Range::new(least, false, most as f64, false), key, count as f64));
        }
        if let Some(fill) = self.fill {
            let numbers = [("fill.height", fill.height), ("fill.density", fill.density)];
            diagnostics.extend(numbers.into_iter().filter_map(|(key, value)| out_of_range::<VaultFill>(key, value)));
        }
        if diagnostics.is_empty() && 2 * self.springers >= self.voussoirs {
            let message = format!("{} of {} courses at each springing leave none", self.springers, self.voussoirs);
            diagnostics.push(Diagnostic::new("springers", message));
        }
        let [x, y] = self.spans;
        if self.section == WebSection::Segmental && x != y {
            let wrong = Diagnostic::new("spans", "circular arcs of different spans do not meet in plane groins");
            diagnostics.push(wrong.help("give equal spans, or section = \"elliptical\""));
        }
        if !diagnostics.is_empty() {
            return Err(diagnostics);
        }
        // A web along x has its section across y.
        let webs = [(x, y), (y, x), (x, y), (y, x)].into_iter().enumerate();
        let web = |(turns, (along, across)): (usize, (f64, f64))| {
            let ring = self.ring(across)?;
            Ok(Web { turns, half: [along / 2.0, across / 2.0], ring })
        };
        let webs = webs.map(web).collect::<Result<Vec<Web>, Vec<Diagnostic>>>()?;
        match webs.iter().find_map(|web| self.low_springers(web)) {
            Some(wrong) => Err(vec![wrong]),
            None => Ok(webs),
        }
    }

    fn ring(&self, span: f64) -> Result<Ring, Vec<Diagnostic>> {
        let rise = self.rise;
        let profile = match self.section {
            WebSection::Segmental => Profile::Segmental { span, rise },
            WebSection::Elliptical => Profile::Elliptical { span, rise },
        };
        let ring = profile.ring(Some(Thickness::Even(self.thickness)), Some(self.voussoirs), None)?;
        if ring.is_plainly_simple() {
            return Ok(ring);
        }
        Err(vec![Diagnostic::new("thickness", "the section runs into itself, or a voussoir is concave")])
    }

    /// Reports supports that end below the height at which the extrados is inside of the edges.
    fn low_springers(&self, web: &Web) -> Option<Diagnostic> {
        let inside = |joint: &usize| web.ring.extrados[*joint].x.abs() < web.half[1] * (1.0 - 1e-6);
        let least = (0..=self.voussoirs / 2).find(inside)?;
        (self.springers < least).then(|| {
            let message = format!("the extrados is outside of the edges up to joint {least}");
            Diagnostic::new("springers", message).help(format!("give springers ≥ {least}"))
        })
    }

    fn validate(&self) -> Vec<(String, String)> {
        self.webs().err().map(pairs_of).unwrap_or_default()
    }

    fn is_springer(&self, course: usize) -> bool {
        course < self.springers || course + self.springers >= self.voussoirs
    }

    /// Returns the cuts along u of a course whose groin ends at a distance from the centre, without the groin \[m\].
    fn cuts(&self, course: usize, groin: f64, edge: f64) -> Vec<f64> {
        let step = edge / self.strips as f64;
        let from_springing = course.min(self.voussoirs - 1 - course);
        let shift = if self.bond == StripBond::Half && from_springing % 2 == 1 { 0.5 } else { 0.0 };
        let all = (0..self.strips).map(|k| (k as f64 + shift) * step);
        let inner = all.filter(|cut| *cut > groin + LEAST_PART * step && *cut < edge - LEAST_PART * step);
        inner.chain([edge]).collect()
    }

    fn assemble(&self, parts: &mut Parts, webs: &[Web]) {
        for web in webs {
            for course in 0..self.voussoirs {
                let springer = self.is_springer(course);
                let section = web.section(course);
                let groin = section.iter().flatten().map(|point| web.groin(point)).fold(0.0, f64::max);
                let cuts = if springer { vec![web.half[0]] } else { self.cuts(course, groin, web.half[0]) };
                let mut from = None;
                for (strip, cut) in cuts.into_iter().enumerate() {
                    let name = format!("{}.{course}.{strip}", WEBS[web.turns]);
                    let block = web.block(&section, from, cut);
                    let body = parts.body(name, block.shape(), springer);
                    self.add_fill(parts, body, &block, springer);
                    from = Some(cut);
                }
            }
        }
        parts.find_contacts();
    }
}

impl CrossVault {
    /// Adds the fill above the extrados of a free block.
    fn add_fill(&self, parts: &mut Parts, body: usize, block: &ShellBlock, springer: bool) {
        let Some(fill) = self.fill.filter(|_| !springer) else { return };
        let extrados = (0..block.columns.len() - 1).map(|s| block.outside(s));
        let columns = Columns::above(extrados, fill.height);
        if let Some(centroid) = columns.centroid() {
            parts.fill(body, fill.density * columns.volume, centroid);
        }
    }
}

impl Web {
    /// Returns the inner and outer points (v, z) of a course, by descending v. A course over the axis has a point on it.
    fn section(&self, course: usize) -> Vec<[Vec2; 2]> {
        let joint = |k: usize| [self.ring.intrados[k], self.ring.extrados[k]];
        let (left, right) = (joint(course), joint(course + 1));
        if 2 * course + 1 != self.ring.voussoirs() {
            return vec![right, left];
        }
        let middle = [0, 1].map(|face| Vec2::new(0.0, (left[face].y + right[face].y) / 2.0));
        vec![right, middle, left]
    }

    /// Returns the distance u of the groin at a point (v, z), at most to the edge \[m\].
    fn groin(&self, point: &Vec2) -> f64 {
        (point.x.abs() / self.half[1] * self.half[0]).min(self.half[0])
    }

    /// Returns the block between two distances u; `None` is the groin.
    fn block(&self, section: &[[Vec2; 2]], from: Option<f64>, to: f64) -> ShellBlock {
        let column = |[inner, outer]: &[Vec2; 2]| {
            let low = |point: &Vec2| self.place(from.unwrap_or_else(|| self.groin(point)), point);
            [low(inner), low(outer), self.place(to, inner), self.place(to, outer)]
        };
        ShellBlock { columns: section.iter().map(column).collect() }
    }

    /// Returns a point at u and (v, z) in the axes of the scene \[m\].
    fn place(&self, u: f64, point: &Vec2) -> Vec3 {
        let (v, z) = (point.x, point.y);
        match self.turns {
            0 => Vec3::new(u, v, z),
            1 => Vec3::new(-v, u, z),
            2 => Vec3::new(-u, -v, z),
            _ => Vec3::new(v, -u, z),
        }
    }
}

#[typetag::serde(name = "cross_vault")]
impl Scene for CrossVault {
    fn build(&self, catalogue: &Catalogue) -> Result<Assembly, Vec<Diagnostic>> {
        Ok(Assembly::without_blocks(catalogue.clone()))
    }

    fn build_space(&self, catalogue: &Catalogue) -> Option<Result<SpaceAssembly, Vec<Diagnostic>>> {
        let (webs, mistakes) = match self.webs() {
            Ok(webs) => (webs, Vec::new()),
            Err(mistakes) => (Vec::new(), mistakes),
        };
        let parts = Parts::new(catalogue, [&self.material, &self.joint], mistakes);
        Some(parts.map(|mut parts| {
            self.assemble(&mut parts, &webs);
            parts.finish()
        }))
    }
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::Scene,
        tag: "cross_vault",
        summary: "a cross (groin) vault of two barrels on four supports",
        sources: &["Heyman 1995, The Stone Skeleton"],
        samples: &[
            Sample::keys(r#"spans = [4.0, 4.0]
rise = 2.0
thickness = 0.3
voussoirs = 11
strips = 3
bond = "half"
springers = 3
material = "stone"
joint = "dry""#),
            Sample::keys(r#"spans = [5.0, 4.0]
rise = 2.0
thickness = 0.3
section = "elliptical"
voussoirs = 10
springers = 3
fill = { height = 2.5, density = 1800.0 }
material = "brick"
joint = "mortar""#),
        ],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("cross_vault.md"),
        ..Card::of::<CrossVault>()
    }
}

#[cfg(test)]
mod tests {
    use super::super::parts::tests::{built, wrong};
    use serde_json::{Value, json};
    use voussoir_core::space::{Contact, SpaceAssembly, Vec3};

    fn keys(extra: Value) -> Value {
        let mut keys = json!({
            "spans": [4.0, 4.0], "rise": 2.0, "thickness": 0.3, "voussoirs": 11, "strips": 3, "springers": 3,
        });
        for (key, value) in extra.as_object().unwrap() {
            keys[key] = value.clone();
        }
        keys
    }

    fn area(contact: &Contact) -> f64 {
        let first = contact.points[0];
        let fan = contact.points[1..].windows(2).map(|pair| (pair[0] - first).cross(&(pair[1] - first)));
        fan.sum::<Vec3>().norm() / 2.0
    }

    /// Returns, for each free block, the area of its contacts and of its joint faces: all but the intrados, the extrados and
    /// the face at the edge of the vault.
    fn covered(scene: &SpaceAssembly, edge: f64) -> Vec<[f64; 2]> {
        let mut areas = vec![[0.0; 2]; scene.bodies.len()];
        for contact in &scene.contacts {
            areas[contact.minus][0] += area(contact);
            areas[contact.plus][0] += area(contact);
        }
        for (body, areas) in scene.bodies.iter().zip(&mut areas) {
            for (i, face) in body.shape.faces.iter().enumerate() {
                // Faces of a shell block: both sides, then low, high, outer and inner for each column.
                let joint = i < 2 || (i - 2) % 4 < 2;
                let mean = body.shape.face_mean(face);
                let at_edge = mean.x.abs().max(mean.y.abs()) > edge - 1e-9;
                areas[1] += if joint && !at_edge { body.shape.area_vector(face).norm() } else { 0.0 };
            }
        }
        let free = scene.bodies.iter().zip(areas).filter(|(body, _)| !body.fixed);
        free.map(|(_, areas)| areas).collect()
    }

    /// With equal spans every joint face of every free block is covered by contacts.
    #[test]
    fn joint_faces_of_equal_webs_are_covered_by_contacts() {
        for extra in [json!({}), json!({ "bond": "half" }), json!({ "voussoirs": 12 }), json!({ "strips": 1 })] {
            let scene = built("cross_vault", &keys(extra.clone())).unwrap();
            scene.bodies.iter().for_each(|body| assert_eq!(body.shape.check(), Ok(()), "{}", body.name));
            for (index, [contacts, faces]) in covered(&scene, 2.0).into_iter().enumerate() {
                assert!((contacts - faces).abs() < 1e-9, "{extra} {index}: {contacts} {faces}");
            }
        }
    }

    /// The mass of the fill is the density times the volume between the extrados and the level over the plan of the free
    /// courses. Chords of the extrados join points at r + t with equal angles; a web is as wide as the distance to its groins.
    #[test]
    fn the_fill_weighs_as_much_as_its_volume() {
        let outer = |k: usize| {
            let angle = std::f64::consts::PI * k as f64 / 11.0;
            [-2.3 * angle.cos(), 2.3 * angle.sin()]
        };
        let volume = |level: f64| -> f64 {
            let parts = 20_000;
            let of_chord = |k: usize| {
                let ([v, z], [next_v, next_z]) = (outer(k), outer(k + 1));
                let at = |i: usize| {
                    let t = (i as f64 + 0.5) / parts as f64;
                    (level - z - t * (next_z - z)).max(0.0) * (2.0 - (v + t * (next_v - v)).abs())
                };
                (0..parts).map(at).sum::<f64>() * (next_v - v) / parts as f64
            };
            4.0 * (3..8).map(of_chord).sum::<f64>()
        };
        for level in [2.0, 2.5] {
            for extra in [json!({}), json!({ "bond": "half", "strips": 2 })] {
                let mut keys = keys(extra);
                keys["fill"] = json!({ "height": level, "density": 1800.0 });
                let scene = built("cross_vault", &keys).unwrap();
                let mass: f64 = scene.fill.iter().map(|fill| fill.mass).sum();
                let exact = 1800.0 * volume(level);
                assert!((mass - exact).abs() < 1e-7 * exact, "{level}: {mass} {exact}");
                let moment: Vec3 = scene.fill.iter().map(|fill| fill.point * fill.mass).sum();
                assert!(moment.x.abs() < 1e-9 * mass && moment.y.abs() < 1e-9 * mass, "{moment:?}");
                assert!(scene.fill.iter().all(|fill| !scene.bodies[fill.body].fixed && fill.point.z < level));
            }
        }
        assert_eq!(
            wrong("cross_vault", &keys(json!({ "fill": { "height": 0.0, "density": 1.0 } }))),
            ["scene.fill.height"]
        );
    }

    /// A turn by 90° maps each web of a square vault to the next: volumes and numbers of contacts agree.
    #[test]
    fn the_webs_of_a_square_vault_are_equal() {
        let scene = built("cross_vault", &keys(json!({ "bond": "half" }))).unwrap();
        let web = |name: &str| {
            let own: Vec<usize> = (0..scene.bodies.len()).filter(|&i| scene.bodies[i].name.starts_with(name)).collect();
            let volume: f64 = own.iter().map(|&i| scene.bodies[i].shape.volume_and_centroid().0).sum();
            let touch = scene.contacts.iter().filter(|c| own.contains(&c.minus) || own.contains(&c.plus)).count();
            (own.len(), touch, volume)
        };
        let east = web("east");
        for name in ["north", "west", "south"] {
            let other = web(name);
            assert_eq!((east.0, east.1), (other.0, other.1));
            assert!((east.2 - other.2).abs() < 1e-12);
        }
    }

    /// Half ellipses of different spans meet in plane groins: every free block has contacts across them.
    #[test]
    fn an_oblong_vault_has_contacts_in_its_groins() {
        let extra = json!({ "spans": [5.0, 4.0], "section": "elliptical", "voussoirs": 10 });
        let scene = built("cross_vault", &keys(extra)).unwrap();
        let web = |index: usize| scene.bodies[index].name.split('.').next().unwrap().to_string();
        let groins = scene.contacts.iter().filter(|contact| web(contact.minus) != web(contact.plus));
        let slopes: Vec<f64> = groins.map(|contact| (contact.normal.y / contact.normal.x).abs()).collect();
        assert!(slopes.len() >= 4 * 2 * 2, "{}", slopes.len());
        // The plane x/5 = y/4 has the normal (4, −5); crown blocks also touch along the axes.
        assert!(slopes.iter().all(|slope| (slope - 1.25).abs() < 1e-9), "{slopes:?}");
    }

    #[test]
    fn mistakes_are_reported_at_their_keys() {
        let paths = |extra: Value| wrong("cross_vault", &keys(extra));
        assert_eq!(paths(json!({ "spans": [4.0, 5.0] })), ["scene.spans"]);
        assert_eq!(paths(json!({ "springers": 1 })), ["scene.springers"]);
        assert_eq!(paths(json!({ "springers": 6 })), ["scene.springers"]);
        assert_eq!(paths(json!({ "rise": 0.0, "strips": 0 })), ["scene.rise", "scene.strips"]);
    }
}
