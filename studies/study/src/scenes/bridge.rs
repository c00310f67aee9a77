//! `bridge`: spans with one or several rings on abutments and piers, with fill.
#![doc = include_str!("bridge.md")]

mod builder;
mod damage;
mod fill;
mod piers;
mod rings;

pub use self::damage::{Damage, Face};
pub use self::fill::{Extent, Fill, Haunching, Layer};
pub use self::piers::{Footing, Pier};
pub use self::rings::{Counts, RadialJoints, Span};

use self::builder::Builder;
use self::piers::PierBlocks;
use self::rings::SpanBlocks;
use super::abutments::{AbutmentBlock, Abutments};
use super::arch::Ends;
use super::keys::{PlaneState, SceneKeys};
use super::lookup::{from_root, law, material, out_of_range, pairs_of, take};
use super::mesh::{Mesh, density, mesh_diagnostics};
use super::overlap::overlap;
use voussoir_core::model::{ArchLayout, Assembly, Bond, Bridge, Catalogue, Scene};
use voussoir_core::plugin::{Card, Diagnostic, Keys, PluginKind, Sample};

/// Spans on abutments and piers, with fill.
#[derive(Debug, Keys)]
#[keys(check = BridgeScene::validate)]
pub struct BridgeScene {
    /// Width out of plane \[m\].
    #[key(like = SceneKeys)]
    pub width: f64,
    /// Stress state of deformable blocks.
    #[key(like = SceneKeys, default)]
    pub plane: PlaneState,
    /// Material of blocks that do not name one.
    #[key(like = SceneKeys)]
    pub material: String,
    /// Interface law of all joints except the joints between rings.
    #[key(like = SceneKeys)]
    pub joint: String,
    /// interface law of the joints between rings
    #[key(reference = "joints", optional = "the law of joint")]
    pub ring_joint: Option<String>,
    /// from left to right
    #[key(len = ">= 1, <= 1000")]
    pub spans: Vec<Span>,
    /// one between two spans
    #[key(len = "<= 1000", default = [])]
    pub piers: Vec<Pier>,
    /// abutments behind the outermost springings, on a base with friction
    #[key(optional = "fixed supports")]
    pub abutments: Option<Abutments>,
    /// fill between the rings and the road
    #[key(optional = "bare rings")]
    pub fill: Option<Fill>,
    /// joints that have lost mortar or are repointed, lost voussoirs: { kind = "lost_mortar", depth = 0.05
    /// }
    #[key(default = [])]
    pub damage: Vec<Damage>,
    /// Mesh of deformable blocks.
    #[key(like = SceneKeys)]
    pub mesh: Option<Mesh>,
}

/// All parts at their positions.
struct Shapes {
    spans: Vec<SpanBlocks>,
    piers: Vec<PierBlocks>,
    abutments: Vec<AbutmentBlock>,
}

/// Adds a prefix to the paths of diagnostics.
fn within(path: &str, diagnostics: Vec<Diagnostic>) -> impl Iterator<Item = Diagnostic> + '_ {
    diagnostics.into_iter().map(move |wrong| wrong.below(path))
}

impl BridgeScene {
    /// Returns the blocks, or all mistakes in the geometry, with paths from the scene's table.
    fn shapes(&self) -> Result<Shapes, Vec<Diagnostic>> {
        let mut diagnostics = Vec::new();
        diagnostics.extend(out_of_range::<Self>("width", self.width));
        diagnostics.extend(mesh_diagnostics(self.mesh.as_ref()));
        if self.spans.is_empty() {
            diagnostics.push(Diagnostic::new("spans", "there is no span"));
        } else if self.piers.len() + 1 != self.spans.len() {
            let message = format!("{} for {} spans: one pier between two spans", self.piers.len(), self.spans.len());
            diagnostics.push(Diagnostic::new("piers", message));
        }
        for (i, pier) in self.piers.iter().enumerate() {
            diagnostics.extend(within(&format!("piers.{i}"), pier.mistakes()));
        }
        if let Some(fill) = &self.fill {
            diagnostics.extend(within("fill", fill.mistakes()));
        }
        if let Some(abutments) = &self.abutments {
            diagnostics.extend(within("abutments", abutments.mistakes()));
        }
        let (mut spans, mut x) = (Vec::new(), 0.0);
        for (i, span) in self.spans.iter().enumerate() {
            match span.blocks(x) {
                Ok(blocks) => {
                    x = blocks.springing(1)[0].x + self.piers.get(i).map_or(0.0, |pier| pier.width);
                    spans.push(blocks);
                }
                Err(wrong) => diagnostics.extend(within(&format!("spans.{i}"), wrong)),
            }
        }
        if !diagnostics.is_empty() {
            return Err(diagnostics);
        }
        let mut piers = Vec::new();
        for (i, (pier, pair)) in self.piers.iter().zip(spans.windows(2)).enumerate() {
            match pier.blocks(pair[0].springing(1), pair[1].springing(0)) {
                Ok(blocks) => piers.push(blocks),
                Err(wrong) => diagnostics.extend(within(&format!("piers.{i}"), vec![wrong])),
            }
        }
        let ends = [spans[0].springing(0), spans[spans.len() - 1].springing(1)];
        let abutments = match self.abutments.map(|abutments| abutments.blocks(ends)) {
            Some(Ok(blocks)) => blocks,
            Some(Err(wrong)) => {
                diagnostics.extend(within("abutments", wrong));
                Vec::new()
            }
            None => Vec::new(),
        };
        if diagnostics.is_empty() { Ok(Shapes { spans, piers, abutments }) } else { Err(diagnostics) }
    }

    fn validate(&self) -> Vec<(String, String)> {
        self.shapes().err().map(pairs_of).unwrap_or_default()
    }
}

/// Indices of materials and laws.
struct Indices {
    spans: Vec<usize>,
    piers: Vec<usize>,
    material: usize,
    joint: usize,
    ring_joint: usize,
}

impl BridgeScene {
    fn indices(&self, catalogue: &Catalogue) -> Result<Indices, Vec<Diagnostic>> {
        let mut diagnostics = Vec::new();
        let own = take(material(catalogue, &self.material, "material"), &mut diagnostics);
        let joint = take(law(catalogue, &self.joint, "joint"), &mut diagnostics);
        let ring_joint = match &self.ring_joint {
            Some(name) => take(law(catalogue, name, "ring_joint"), &mut diagnostics),
            None => joint,
        };
        let mut each = |name: &Option<String>, path: String| match name {
            Some(name) => take(material(catalogue, name, &path), &mut diagnostics),
            None => own,
        };
        let spans: Vec<_> =
            self.spans.iter().enumerate().map(|(i, s)| each(&s.material, format!("spans.{i}.material"))).collect();
        let piers: Vec<_> =
            self.piers.iter().enumerate().map(|(i, p)| each(&p.material, format!("piers.{i}.material"))).collect();
        let indices = (|| {
            Some(Indices {
                spans: spans.into_iter().collect::<Option<_>>()?,
                piers: piers.into_iter().collect::<Option<_>>()?,
                material: own?,
                joint: joint?,
                ring_joint: ring_joint?,
            })
        })();
        indices.ok_or(diagnostics)
    }

    /// Builds bodies, joints and upper faces, and adds the laws of abutments to the catalogue.
    fn put_together(
        &self,
        shapes: &Shapes,
        indices: &Indices,
        catalogue: &mut Catalogue,
    ) -> Result<Builder, Diagnostic> {
        let mut builder = Builder::default();
        let [joint, ring_joint] = [indices.joint, indices.ring_joint].map(Bond::Law);
        let abutment = |left: bool| shapes.abutments.iter().find(|own| own.is_left() == left);
        let laws = [indices.material, indices.joint];
        let mut before = builder.body("left".into(), Vec::new(), indices.material, true);
        if let Some(own) = abutment(true) {
            before = builder.abutment(own, before, laws, catalogue)?;
        }
        let alone = self.spans.len() == 1 && shapes.spans[0].rings.len() == 1;
        for (index, (span, blocks)) in self.spans.iter().zip(&shapes.spans).enumerate() {
            let springing = if span.ends == Ends::Bonded { Bond::Bonded } else { joint };
            builder.span(index, blocks, before, [joint, ring_joint, springing], alone, indices.spans[index]);
            if let (Some(pier), Some(blocks)) = (self.piers.get(index), shapes.piers.get(index)) {
                before = builder.pier(index, pier, blocks, joint, indices.piers[index]);
            }
        }
        let mut after = builder.body("right".into(), Vec::new(), indices.material, true);
        if let Some(own) = abutment(false) {
            after = builder.abutment(own, after, laws, catalogue)?;
        }
        builder.join_ends(after);
        Ok(builder)
    }
}

#[typetag::serde(name = "bridge")]
impl Scene for BridgeScene {
    fn build(&self, catalogue: &Catalogue) -> Result<Assembly, Vec<Diagnostic>> {
        let mut diagnostics = Vec::new();
        let indices = self.indices(catalogue).map_err(|mut wrong| diagnostics.append(&mut wrong)).ok();
        let shapes = self.shapes().map_err(|mut wrong| diagnostics.append(&mut wrong)).ok();
        let (Some(indices), Some(shapes)) = (indices, shapes) else { return Err(from_root(diagnostics)) };
        let mut own = catalogue.clone();
        let builder = self.put_together(&shapes, &indices, &mut own);
        let mut builder = builder.map_err(|wrong| from_root(vec![wrong]))?;
        builder.damage(&self.damage, catalogue).map_err(from_root)?;
        let Builder { bodies, radial, other, extrados, rings: _, piers: _ } = builder;
        if let Some(wrong) = overlap(&bodies, "spans") {
            return Err(from_root(vec![wrong]));
        }
        let ends = [shapes.spans[0].springing(0)[0], shapes.spans[shapes.spans.len() - 1].springing(1)[0]];
        // A repointed joint consists of two joints; then joints are not numbered along the ring.
        let bases = shapes.abutments.len();
        let alone = shapes.spans.len() == 1 && shapes.spans[0].rings.len() == 1 && other.len() == bases;
        let ring = || {
            let joints = &shapes.spans[0].rings[0].joints;
            let crown = joints.iter().fold(f64::NEG_INFINITY, |top, ends| top.max(ends[0].y));
            let rise = crown - (ends[0].y + ends[1].y) / 2.0;
            let first = 1 + usize::from(shapes.abutments.iter().any(AbutmentBlock::is_left));
            ArchLayout { first, voussoirs: radial.len() - 1, span: ends[1].x - ends[0].x, rise }
        };
        let arch = alone.then(ring);
        let springings = ends.map(|end| end.x);
        let span = |shape: &SpanBlocks| shape.springing(1)[0].x - shape.springing(0)[0].x;
        let longest_span = shapes.spans.iter().map(span).fold(0.0, f64::max);
        let mut bridge = Bridge { extrados, springings, longest_span, radial: radial.len(), ..Bridge::default() };
        let mut assembly = Assembly {
            catalogue: own,
            joints: radial.into_iter().chain(other).collect(),
            bodies,
            width: self.width,
            plane: self.plane.into(),
            mesh: density(self.mesh),
            arch,
            bridge: None,
        };
        if let Some(fill) = &self.fill {
            let crown = shapes.spans.iter().fold(f64::NEG_INFINITY, |top, span| top.max(span.crown));
            let added = fill.add_to(&assembly, &mut bridge, crown, springings);
            added.map_err(|wrong| from_root(within("fill", wrong).collect()))?;
        }
        for abutment in &shapes.abutments {
            let body = assembly.body(abutment.name);
            bridge.reactions.extend(body.and_then(|body| abutment.reaction(body, self.width)));
        }
        assembly.bridge = Some(bridge);
        Ok(assembly)
    }
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::Scene,
        tag: "bridge",
        summary: "spans of one or several rings on abutments and piers, with fill",
        sources: &["Heyman 1982, The Masonry Arch", "Melbourne, Gilbert & Wagstaff 1997, Struct. Eng. 75 (multi-span)"],
        samples: &[
            Sample::keys(r#"width = 3.0
material = "stone"
joint = "dry"
ring_joint = "mortar"
spans = [{ profile = { shape = "segmental", span = 4.0, rise = 1.0 }, thickness = 0.4, voussoirs = 12, rings = 2 }]
[fill]
cover = 0.3
density = 2000.0
friction_angle = 35.0
cohesion = 0.0
dispersion = { law = "uniform", angle = 26.6 }
resistance = { law = "fill_pressure", passive_factor = 0.33 }"#),
            Sample::keys(r#"width = 3.0
material = "stone"
joint = "dry"
spans = [{ profile = { shape = "segmental", span = 4.0, rise = 1.0 }, thickness = 0.4, voussoirs = 12 }]
abutments = { width = 3.0, height = 2.0, base_friction = 0.5, backing = 1e4 }
fill = { cover = 0.3, density = 2000.0 }"#),
        ],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("bridge.md"),
        ..Card::of::<BridgeScene>()
    }
}
