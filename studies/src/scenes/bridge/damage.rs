//! Damage of a bridge: joints that have lost mortar, joints that are repointed, voussoirs that are gone.

use super::builder::{Builder, RingPlace};
use crate::scenes::lookup::{law, take};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use voussoir_core::model::geometry::Vec2;
use voussoir_core::model::{Bond, Catalogue, Joint};
use voussoir_core::plugin::{Diagnostic, Need, Parameter, Quantity, Range, Shape, Variant};

/// The face of a ring from which a joint is damaged.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Face {
    /// The lower face of the ring.
    #[default]
    Intrados,
    /// Its upper face.
    Extrados,
}

/// A piece of damage.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Damage {
    /// Joints across a ring that touch no longer down to a depth.
    LostMortar {
        /// From 0 at the left.
        #[serde(default)]
        span: usize,
        /// From 0 at the inside.
        #[serde(default)]
        ring: usize,
        /// From 0 at the left springing; all of the ring where they are not given.
        joints: Option<Vec<usize>>,
        /// From which face.
        #[serde(default)]
        side: Face,
        /// \[m\].
        depth: f64,
    },
    /// Joints across a ring that follow another law down to a depth.
    Repointed {
        /// From 0 at the left.
        #[serde(default)]
        span: usize,
        /// From 0 at the inside.
        #[serde(default)]
        ring: usize,
        /// From 0 at the left springing; all of the ring where they are not given.
        joints: Option<Vec<usize>>,
        /// From which face.
        #[serde(default)]
        side: Face,
        /// \[m\].
        depth: f64,
        /// The law of the part that is repointed.
        joint: String,
    },
    /// Voussoirs that are gone.
    LostVoussoir {
        /// From 0 at the left.
        #[serde(default)]
        span: usize,
        /// From 0 at the inside.
        #[serde(default)]
        ring: usize,
        /// From 0 at the left.
        voussoirs: Vec<usize>,
    },
}

const fn number(name: &'static str, doc: &'static str) -> Parameter {
    Parameter { name, doc, shape: Shape::Integer { min: 0, max: 1_000_000 }, need: Need::Default("0") }
}

const NUMBERS: Shape = Shape::List { of: &Shape::Integer { min: 0, max: 1_000_000 }, min: 1, max: usize::MAX };
const SPAN: Parameter = number("span", "span, from 0 at the left");
const RING: Parameter = number("ring", "ring, from 0 at the inside");
const JOINTS: Parameter = Parameter {
    name: "joints",
    doc: "numbers of joints across the ring, from 0 at the left springing",
    shape: NUMBERS,
    need: Need::Optional("all of the ring but bonded ones"),
};
const SIDE: Parameter = Parameter {
    name: "side",
    doc: "the face of the ring from which the depth counts",
    shape: Shape::Choice(&["intrados", "extrados"]),
    need: Need::Default("\"intrados\""),
};
const DEPTH: Parameter =
    Parameter::number("depth", Quantity::Length, Range::POSITIVE, "along the joint, from that face");

/// What an entry of `damage` may hold.
pub(super) const DAMAGE: Shape = Shape::Tagged {
    key: "kind",
    variants: &[
        Variant {
            tag: "lost_mortar",
            doc: "joints across a ring that touch no longer down to a depth",
            parameters: &[SPAN, RING, JOINTS, SIDE, DEPTH],
        },
        Variant {
            tag: "repointed",
            doc: "joints across a ring that follow another law down to a depth",
            parameters: &[
                SPAN,
                RING,
                JOINTS,
                SIDE,
                DEPTH,
                Parameter {
                    name: "joint",
                    doc: "interface law of the part that is repointed",
                    shape: Shape::Reference("joints"),
                    need: Need::Required,
                },
            ],
        },
        Variant {
            tag: "lost_voussoir",
            doc: "voussoirs of an inner ring that are gone",
            parameters: &[
                SPAN,
                RING,
                Parameter {
                    name: "voussoirs",
                    doc: "their numbers, from 0 at the left",
                    shape: NUMBERS,
                    need: Need::Required,
                },
            ],
        },
    ],
};

/// Joints of a ring that are damaged in the same way.
struct Section<'a> {
    span: usize,
    ring: usize,
    joints: Option<&'a [usize]>,
    side: Face,
    depth: f64,
    joint: Option<&'a str>,
}

/// What is left of joints: places along them from their intrados end \[m\].
#[derive(Default)]
struct Remains {
    left: BTreeMap<usize, [f64; 2]>,
    repointed: Vec<Joint>,
}

impl Builder {
    /// Damages what has been put together. Issues have paths from the scene's table.
    pub(super) fn damage(&mut self, list: &[Damage], catalogue: &Catalogue) -> Result<(), Vec<Diagnostic>> {
        let (mut diagnostics, mut remains, mut gone) = (Vec::new(), Remains::default(), BTreeSet::new());
        for (i, entry) in list.iter().enumerate() {
            let path = format!("damage.{i}");
            let section = match entry {
                Damage::LostMortar { span, ring, joints, side, depth } => Section {
                    span: *span,
                    ring: *ring,
                    joints: joints.as_deref(),
                    side: *side,
                    depth: *depth,
                    joint: None,
                },
                Damage::Repointed { span, ring, joints, side, depth, joint } => {
                    let (joints, joint) = (joints.as_deref(), Some(joint.as_str()));
                    Section { span: *span, ring: *ring, joints, side: *side, depth: *depth, joint }
                }
                Damage::LostVoussoir { span, ring, voussoirs } => {
                    match self.voussoirs([*span, *ring], voussoirs, &path) {
                        Ok(lost) => gone.extend(lost),
                        Err(wrong) => diagnostics.push(wrong),
                    }
                    continue;
                }
            };
            let bond = section.joint.map(|name| take(law(catalogue, name, &format!("{path}.joint")), &mut diagnostics));
            if let Some(None) = bond {
                continue;
            }
            let wrong = self.shorten(&section, bond.flatten().map(Bond::Law), &mut remains, &path);
            diagnostics.extend(wrong.err());
        }
        if !diagnostics.is_empty() {
            return Err(diagnostics);
        }
        for (index, [from, to]) in remains.left {
            let joint = &mut self.radial[index];
            joint.ends = part(joint.ends, from, to);
        }
        self.other.append(&mut remains.repointed);
        self.remove(&gone);
        Ok(())
    }

    /// A ring by span and ring, or the mistake.
    fn ring_place(&self, [span, ring]: [usize; 2], path: &str) -> Result<RingPlace, Diagnostic> {
        let missing = |key: &str, what: &str, number: usize, count: usize| {
            Diagnostic::new(
                format!("{path}.{key}"),
                format!("there is no {what} {number}: they are 0 to {}", count - 1),
            )
        };
        let rings = self.rings.get(span).ok_or_else(|| missing("span", "span", span, self.rings.len()))?;
        rings.get(ring).copied().ok_or_else(|| missing("ring", "ring", ring, rings.len()))
    }

    /// Indices of voussoirs that are lost.
    fn voussoirs(&self, [span, ring]: [usize; 2], numbers: &[usize], path: &str) -> Result<Vec<usize>, Diagnostic> {
        let place = self.ring_place([span, ring], path)?;
        if ring + 1 == self.rings[span].len() {
            let message = "the outermost ring carries the fill: only voussoirs of rings below it can be lost";
            return Err(Diagnostic::new(format!("{path}.ring"), message));
        }
        if let Some(i) = numbers.iter().position(|&number| number >= place.count) {
            let message = format!("there is no voussoir {}: they are 0 to {}", numbers[i], place.count - 1);
            return Err(Diagnostic::new(format!("{path}.voussoirs.{i}"), message));
        }
        Ok(numbers.iter().map(|number| place.body + number).collect())
    }

    /// Takes a depth off the joints of a section, for good or for a joint of its own.
    fn shorten(
        &self,
        section: &Section<'_>,
        bond: Option<Bond>,
        remains: &mut Remains,
        path: &str,
    ) -> Result<(), Diagnostic> {
        let place = self.ring_place([section.span, section.ring], path)?;
        let named = |i: usize| if section.joints.is_some() { format!("{path}.joints.{i}") } else { path.to_string() };
        let numbers: Vec<usize> = section.joints.map_or_else(|| (0..=place.count).collect(), <[usize]>::to_vec);
        for (i, number) in numbers.into_iter().enumerate() {
            if number > place.count {
                let message = format!("there is no joint {number}: they are 0 to {}", place.count);
                return Err(Diagnostic::new(named(i), message));
            }
            let index = place.joint + number;
            let joint = &self.radial[index];
            if joint.bond == Bond::Bonded {
                if section.joints.is_none() {
                    continue;
                }
                let message = format!("joint {number} is bonded: it has no mortar to lose");
                return Err(Diagnostic::new(named(i), message).help("give this span ends = \"jointed\""));
            }
            let height = joint.height();
            let [from, to] = *remains.left.get(&index).unwrap_or(&[0.0, height]);
            let (taken, kept) = match section.side {
                Face::Intrados => ([from, section.depth], [from.max(section.depth), to]),
                Face::Extrados => ([height - section.depth, to], [from, to.min(height - section.depth)]),
            };
            if kept[1] - kept[0] <= 1e-6 * height {
                let message =
                    format!("{} m leaves nothing of joint {number}, which is {height:.6} m high", section.depth);
                return Err(Diagnostic::new(format!("{path}.depth"), message));
            }
            remains.left.insert(index, kept);
            // What an earlier entry has taken from this side is gone.
            if let Some(bond) = bond.filter(|_| taken[1] - taken[0] > 1e-6 * height) {
                let ends = part(joint.ends, taken[0], taken[1]);
                remains.repointed.push(Joint { ends, bond, ..joint.clone() });
            }
        }
        Ok(())
    }

    /// Takes bodies away, with their joints.
    fn remove(&mut self, gone: &BTreeSet<usize>) {
        if gone.is_empty() {
            return;
        }
        let mut next = 0;
        let new: Vec<Option<usize>> = (0..self.bodies.len())
            .map(|body| {
                (!gone.contains(&body)).then(|| {
                    next += 1;
                    next - 1
                })
            })
            .collect();
        let kept = |joints: &mut Vec<Joint>| {
            joints.retain(|joint| new[joint.minus].is_some() && new[joint.plus].is_some());
            for joint in joints {
                joint.minus = new[joint.minus].unwrap_or(joint.minus);
                joint.plus = new[joint.plus].unwrap_or(joint.plus);
            }
        };
        kept(&mut self.radial);
        kept(&mut self.other);
        for chord in &mut self.extrados {
            chord.body = new[chord.body].unwrap_or(chord.body);
        }
        let mut index = 0;
        self.bodies.retain(|_| {
            index += 1;
            new[index - 1].is_some()
        });
    }
}

/// The part of a segment between two distances from its first end.
fn part([a, b]: [Vec2; 2], from: f64, to: f64) -> [Vec2; 2] {
    let height = (b - a).norm();
    // An end that stays is kept to the last bit.
    let at = |s: f64| {
        if s <= 0.0 {
            a
        } else if s >= height {
            b
        } else {
            a + (b - a) * (s / height)
        }
    };
    [at(from), at(to)]
}
