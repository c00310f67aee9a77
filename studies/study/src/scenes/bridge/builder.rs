//! Builds the bodies and joints of a bridge from left to right.

use super::piers::{Footing, Pier, PierBlocks};
use super::rings::SpanBlocks;
use crate::scenes::abutments::AbutmentBlock;
use voussoir_core::model::geometry::Vec2;
use voussoir_core::model::{Body, Bond, Catalogue, Chord, Gap, Joint};
use voussoir_core::plugin::Diagnostic;

/// Indices of a ring among the bodies and joints of a bridge.
#[derive(Debug, Clone, Copy)]
pub(super) struct RingPlace {
    /// Index of its first voussoir.
    pub body: usize,
    /// Index of its first joint among the radial joints.
    pub joint: usize,
    /// Number of its voussoirs.
    pub count: usize,
}

/// Joints that damage numbers from 0: across a ring, or the bed joints of a pier.
#[derive(Debug, Clone, Copy)]
pub(super) struct NumberedJoints {
    /// True if they are in the list of other joints, false if in the list of radial joints.
    pub of_pier: bool,
    /// Index of the first joint.
    pub first: usize,
    /// Number of joints.
    pub count: usize,
}

/// Bodies and joints built so far.
#[derive(Default)]
pub(super) struct Builder {
    /// Blocks and supports.
    pub bodies: Vec<Body>,
    /// Joints across rings; they come first in the assembly.
    pub radial: Vec<Joint>,
    /// All other joints.
    pub other: Vec<Joint>,
    /// Upper faces from left to right.
    pub extrados: Vec<Chord>,
    /// Positions of rings, by span and ring.
    pub rings: Vec<Vec<RingPlace>>,
    /// Bed joints of each pier from its cap downwards; their first ends are on the right.
    pub piers: Vec<NumberedJoints>,
}

impl Builder {
    /// Adds a body and returns its index.
    pub fn body(&mut self, name: String, vertices: Vec<Vec2>, material: usize, fixed: bool) -> usize {
        self.bodies.push(Body { name, vertices, material, fixed });
        self.bodies.len() - 1
    }

    /// Adds the rings of a span; its left springing is on the body `before`. `bonds` are the bonds of joints across rings,
    /// between rings and at springings. The joints at the right end do not have their second body yet.
    pub fn span(
        &mut self,
        index: usize,
        blocks: &SpanBlocks,
        before: usize,
        bonds: [Bond; 3],
        alone: bool,
        material: usize,
    ) {
        let [bond, ring_bond, springing] = bonds;
        let (mut first, mut places) = (Vec::new(), Vec::new());
        for (r, ring) in blocks.rings.iter().enumerate() {
            first.push(self.bodies.len());
            let count = ring.voussoirs.len();
            places.push(RingPlace { body: self.bodies.len(), joint: self.radial.len(), count });
            for (k, vertices) in ring.voussoirs.iter().enumerate() {
                let name = if alone { k.to_string() } else { format!("s{index}r{r}v{k}") };
                let body = self.body(name, vertices.clone(), material, false);
                let minus = if k == 0 { before } else { body - 1 };
                let bond = if k == 0 { springing } else { bond };
                self.radial.push(Joint { minus, plus: body, ends: ring.joints[k], bond, gap: Gap::default() });
            }
            let minus = self.bodies.len() - 1;
            // The next body is not yet known: `usize::MAX` marks it.
            let end = Joint { minus, plus: usize::MAX, ends: ring.joints[count], bond: springing, gap: Gap::default() };
            self.radial.push(end);
        }
        self.rings.push(places);
        for (r, interface) in blocks.interfaces.iter().enumerate() {
            for (below, above, ends) in interface {
                let (minus, plus) = (first[r] + below, first[r + 1] + above);
                self.other.push(Joint { minus, plus, ends: *ends, bond: ring_bond, gap: Gap::default() });
            }
        }
        if let (Some(outermost), Some(first)) = (blocks.rings.last(), first.last()) {
            let count = outermost.voussoirs.len();
            self.extrados.extend((0..count).map(|k| Chord {
                body: first + k,
                ends: [outermost.joints[k][1], outermost.joints[k + 1][1]],
                from_middle: (2 * k + 1).abs_diff(count),
            }));
        }
    }

    /// Connects the rings that end here to a body.
    pub fn join_ends(&mut self, body: usize) {
        self.radial.iter_mut().filter(|joint| joint.plus == usize::MAX).for_each(|joint| joint.plus = body);
    }

    /// Adds a pier, on which the preceding rings end. Returns the body on which the next span begins.
    pub fn pier(&mut self, index: usize, pier: &Pier, blocks: &PierBlocks, bond: Bond, material: usize) -> usize {
        let cap = blocks.cap.as_ref().map(|cap| self.body(format!("p{index}cap"), cap.clone(), material, false));
        let courses: Vec<usize> = (blocks.courses.iter().enumerate())
            .map(|(i, course)| self.body(format!("p{index}c{i}"), course.clone(), material, false))
            .collect();
        let ground = self.body(format!("footing{index}"), Vec::new(), material, true);
        let top = cap.unwrap_or(courses[0]);
        self.join_ends(top);
        if let Some(ends) = blocks.top {
            self.extrados.push(Chord { body: top, ends, from_middle: Chord::NO_RING });
        }
        let below = courses.iter().copied().chain([ground]);
        let above = cap.into_iter().chain(courses.iter().copied());
        let levels = if cap.is_some() { &blocks.levels[..] } else { &blocks.levels[1..] };
        let below = below.skip(usize::from(cap.is_none()));
        self.piers.push(NumberedJoints { of_pier: true, first: self.other.len(), count: levels.len() });
        for ((minus, plus), [left, right]) in below.zip(above).zip(levels) {
            let bond = if minus == ground && pier.footing == Footing::Bonded { Bond::Bonded } else { bond };
            self.other.push(Joint { minus, plus, ends: [*right, *left], bond, gap: Gap::default() });
        }
        top
    }
    /// Adds an abutment on fixed ground and returns its index. `laws` are the indices of the material and of the law of
    /// joints.
    pub fn abutment(
        &mut self,
        abutment: &AbutmentBlock,
        ground: usize,
        [material, joint]: [usize; 2],
        catalogue: &mut Catalogue,
    ) -> Result<usize, Diagnostic> {
        self.bodies.push(abutment.body(material));
        let body = self.bodies.len() - 1;
        self.other.push(abutment.base(catalogue, joint, [ground, body])?);
        self.extrados.extend(abutment.face(body));
        Ok(body)
    }
}
