//! Damage of a bridge: joints that have lost mortar, repointed joints, lost voussoirs.

use super::builder::{Builder, NumberedJoints, RingPlace};
use crate::scenes::lookup::{law, take};
use std::collections::BTreeMap;
use voussoir_core::model::geometry::Vec2;
use voussoir_core::model::{Bond, Catalogue, Chord, Joint};
use voussoir_core::plugin::{Diagnostic, Keys};

/// The face of a ring or a pier from which a joint is damaged.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Keys)]
pub enum Face {
    /// The lower face of the ring.
    Intrados,
    /// Its upper face.
    Extrados,
    /// The left face of the pier.
    Left,
    /// Its right face.
    Right,
}

/// Keys that all kinds of damage share.
#[derive(Debug, Keys)]
pub(super) struct DamageKeys {
    /// span, from 0 at the left
    #[key(range = "<= 1_000_000", optional = "the first")]
    span: Option<usize>,
    /// ring, from 0 at the inside
    #[key(range = "<= 1_000_000", optional = "the innermost")]
    ring: Option<usize>,
    /// pier instead of a ring, from 0 at the left
    #[key(range = "<= 1_000_000", optional = "a ring")]
    pier: Option<usize>,
    /// numbers of joints across the ring, from 0 at the left springing; of a pier from 0 under its cap
    #[key(range = "<= 1_000_000", len = ">= 1", optional = "all but bonded ones")]
    joints: Option<Vec<usize>>,
    /// the face from which the depth counts: of rings intrados or extrados, of piers left or right
    #[key(optional = "intrados; of piers it must be given")]
    side: Option<Face>,
    /// along the joint, from that face
    #[key(unit = "m", range = "> 0")]
    depth: f64,
}

/// A piece of damage.
#[derive(Debug, Clone, PartialEq, Keys)]
#[keys(tag = "kind")]
pub enum Damage {
    /// joints across a ring or a pier that do not touch down to a depth
    LostMortar {
        /// Span, from 0 at the left.
        #[key(like = DamageKeys)]
        span: Option<usize>,
        /// Ring, from 0 at the inside.
        #[key(like = DamageKeys)]
        ring: Option<usize>,
        /// Pier instead of a ring.
        #[key(like = DamageKeys)]
        pier: Option<usize>,
        /// Numbers of joints; all if they are not given.
        #[key(like = DamageKeys)]
        joints: Option<Vec<usize>>,
        /// The face from which the depth counts.
        #[key(like = DamageKeys)]
        side: Option<Face>,
        /// Depth \[m\].
        #[key(like = DamageKeys)]
        depth: f64,
    },
    /// joints across a ring or a pier that follow another law down to a depth
    Repointed {
        /// Span, from 0 at the left.
        #[key(like = DamageKeys)]
        span: Option<usize>,
        /// Ring, from 0 at the inside.
        #[key(like = DamageKeys)]
        ring: Option<usize>,
        /// Pier instead of a ring.
        #[key(like = DamageKeys)]
        pier: Option<usize>,
        /// Numbers of joints; all if they are not given.
        #[key(like = DamageKeys)]
        joints: Option<Vec<usize>>,
        /// The face from which the depth counts.
        #[key(like = DamageKeys)]
        side: Option<Face>,
        /// Depth \[m\].
        #[key(like = DamageKeys)]
        depth: f64,
        /// interface law of the part that is repointed
        #[key(reference = "joints")]
        joint: String,
    },
    /// lost voussoirs; the fill then rests on the ring below
    LostVoussoir {
        /// Span, from 0 at the left.
        #[key(like = DamageKeys)]
        span: Option<usize>,
        /// Ring, from 0 at the inside.
        #[key(like = DamageKeys)]
        ring: Option<usize>,
        /// numbers of the voussoirs, from 0 at the left
        #[key(range = "<= 1_000_000", len = ">= 1")]
        voussoirs: Vec<usize>,
    },
}

/// Joints of a ring or a pier with the same damage.
struct Section<'a> {
    span: Option<usize>,
    ring: Option<usize>,
    pier: Option<usize>,
    joints: Option<&'a [usize]>,
    side: Option<Face>,
    depth: f64,
    joint: Option<&'a str>,
}

/// Remaining parts of joints: intervals along them from their first end \[m\].
#[derive(Default)]
struct Remains {
    left: BTreeMap<(bool, usize), [f64; 2]>,
    repointed: Vec<Joint>,
}

impl Damage {
    /// Returns the joints of a piece of damage; `None` for lost voussoirs.
    fn section(&self) -> Option<Section<'_>> {
        let (Damage::LostMortar { span, ring, pier, joints, side, depth }
        | Damage::Repointed { span, ring, pier, joints, side, depth, .. }) = self
        else {
            return None;
        };
        let joint = if let Damage::Repointed { joint, .. } = self { Some(joint.as_str()) } else { None };
        let (joints, depth) = (joints.as_deref(), *depth);
        Some(Section { span: *span, ring: *ring, pier: *pier, joints, side: *side, depth, joint })
    }
}

impl Builder {
    /// Damages the bridge built so far. Diagnostics have paths from the scene's table.
    pub(super) fn damage(&mut self, list: &[Damage], catalogue: &Catalogue) -> Result<(), Vec<Diagnostic>> {
        let (mut diagnostics, mut remains, mut gone) = (Vec::new(), Remains::default(), BTreeMap::new());
        for (i, entry) in list.iter().enumerate() {
            let path = format!("damage.{i}");
            if let Damage::LostVoussoir { span, ring, voussoirs } = entry {
                match self.voussoirs([*span, *ring], voussoirs, &path) {
                    Ok(lost) => gone.extend(lost.into_iter().map(|body| (body, path.clone()))),
                    Err(wrong) => diagnostics.push(wrong),
                }
            }
            let Some(section) = entry.section() else { continue };
            let bond = section.joint.map(|name| take(law(catalogue, name, &format!("{path}.joint")), &mut diagnostics));
            if let Some(None) = bond {
                continue;
            }
            let wrong = self.shorten(&section, bond.flatten().map(Bond::Law), &mut remains, &path);
            diagnostics.extend(wrong.err());
        }
        // Computed while joints still have their whole height.
        let extrados = self.uncovered(&gone).map_err(|wrong| diagnostics.push(wrong));
        let Some(extrados) = extrados.ok().filter(|_| diagnostics.is_empty()) else { return Err(diagnostics) };
        self.extrados = extrados;
        for ((of_pier, index), [from, to]) in remains.left {
            let joint = if of_pier { &mut self.other[index] } else { &mut self.radial[index] };
            joint.ends = part(joint.ends, from, to);
        }
        self.other.append(&mut remains.repointed);
        self.remove(&gone);
        Ok(())
    }

    /// Returns the position of a ring by span and ring, or the mistake.
    fn ring_place(&self, [span, ring]: [Option<usize>; 2], path: &str) -> Result<RingPlace, Diagnostic> {
        let (span, ring) = (span.unwrap_or(0), ring.unwrap_or(0));
        let rings = self.rings.get(span).ok_or_else(|| missing(path, "span", span, self.rings.len()))?;
        rings.get(ring).copied().ok_or_else(|| missing(path, "ring", ring, rings.len()))
    }

    /// Returns the joints of a section, and true if its side is the side of their first ends.
    fn numbered(&self, section: &Section<'_>, path: &str) -> Result<(NumberedJoints, bool), Diagnostic> {
        let Some(pier) = section.pier else {
            let place = self.ring_place([section.span, section.ring], path)?;
            let joints = NumberedJoints { of_pier: false, first: place.joint, count: place.count + 1 };
            return match section.side {
                None | Some(Face::Intrados) => Ok((joints, true)),
                Some(Face::Extrados) => Ok((joints, false)),
                Some(Face::Left | Face::Right) => {
                    Err(Diagnostic::new(format!("{path}.side"), "of a ring is \"intrados\" or \"extrados\""))
                }
            };
        };
        for (key, given) in [("span", section.span), ("ring", section.ring)] {
            if given.is_some() {
                return Err(
                    Diagnostic::new(format!("{path}.{key}"), "is given besides pier").help("keep one of the two")
                );
            }
        }
        let joints = self.piers.get(pier).copied().ok_or_else(|| missing(path, "pier", pier, self.piers.len()))?;
        match section.side {
            Some(Face::Right) => Ok((joints, true)),
            Some(Face::Left) => Ok((joints, false)),
            _ => Err(Diagnostic::new(format!("{path}.side"), "of a pier is \"left\" or \"right\"")),
        }
    }

    /// Returns the indices of lost voussoirs.
    fn voussoirs(&self, ring: [Option<usize>; 2], numbers: &[usize], path: &str) -> Result<Vec<usize>, Diagnostic> {
        let place = self.ring_place(ring, path)?;
        if let Some(i) = numbers.iter().position(|&number| number >= place.count) {
            let message = format!("there is no voussoir {}: they are 0 to {}", numbers[i], place.count - 1);
            return Err(Diagnostic::new(format!("{path}.voussoirs.{i}"), message));
        }
        Ok(numbers.iter().map(|number| place.body + number).collect())
    }

    /// Returns the upper faces without these voussoirs: below each of them the faces of the lower ring, and beside it the sides
    /// of its neighbours that face upwards.
    fn uncovered(&self, gone: &BTreeMap<usize, String>) -> Result<Vec<Chord>, Diagnostic> {
        let mut extrados = Vec::new();
        for chord in &self.extrados {
            let Some(path) = gone.get(&chord.body) else {
                extrados.push(*chord);
                continue;
            };
            let below: Vec<&Joint> =
                self.other.iter().filter(|joint| joint.plus == chord.body && !self.bodies[joint.minus].fixed).collect();
            if below.is_empty() || below.iter().any(|joint| gone.contains_key(&joint.minus)) {
                let message = "nothing is left under it that would carry the fill: a ring below must go on there";
                return Err(Diagnostic::new(format!("{path}.voussoirs"), message));
            }
            let side = |body: usize, ends: [Vec2; 2]| {
                let carries = !gone.contains_key(&body) && !self.bodies[body].fixed && ends[0].x < ends[1].x;
                carries.then_some(Chord { body, ends, from_middle: Chord::NO_RING })
            };
            let radial = |here: &dyn Fn(&Joint) -> bool| self.radial.iter().find(|joint| here(joint));
            let left = radial(&|joint| joint.plus == chord.body);
            let right = radial(&|joint| joint.minus == chord.body);
            extrados.extend(left.and_then(|joint| side(joint.minus, [joint.ends[1], joint.ends[0]])));
            extrados.extend(below.iter().map(|joint| Chord {
                body: joint.minus,
                ends: [joint.ends[1], joint.ends[0]],
                from_middle: chord.from_middle,
            }));
            extrados.extend(right.and_then(|joint| side(joint.plus, joint.ends)));
        }
        Ok(extrados)
    }

    /// Removes a depth from the joints of a section. The removed part is lost, or becomes a separate joint.
    fn shorten(
        &self,
        section: &Section<'_>,
        bond: Option<Bond>,
        remains: &mut Remains,
        path: &str,
    ) -> Result<(), Diagnostic> {
        let (place, from_first) = self.numbered(section, path)?;
        let named = |i: usize| if section.joints.is_some() { format!("{path}.joints.{i}") } else { path.to_string() };
        let numbers: Vec<usize> = section.joints.map_or_else(|| (0..place.count).collect(), <[usize]>::to_vec);
        for (i, number) in numbers.into_iter().enumerate() {
            if number >= place.count {
                let message = format!("there is no joint {number}: they are 0 to {}", place.count - 1);
                return Err(Diagnostic::new(named(i), message));
            }
            let index = (place.of_pier, place.first + number);
            let joint = if place.of_pier { &self.other[index.1] } else { &self.radial[index.1] };
            if joint.bond == Bond::Bonded {
                if section.joints.is_none() {
                    continue;
                }
                let message = format!("joint {number} is bonded: it has no mortar to lose");
                let help = if place.of_pier { "footing = \"fixed\"" } else { "ends = \"jointed\"" };
                return Err(Diagnostic::new(named(i), message).help(format!("give it {help}")));
            }
            let height = joint.height();
            let [from, to] = *remains.left.get(&index).unwrap_or(&[0.0, height]);
            let (taken, kept) = if from_first {
                ([from, section.depth], [from.max(section.depth), to])
            } else {
                ([height - section.depth, to], [from, to.min(height - section.depth)])
            };
            if kept[1] - kept[0] <= 1e-6 * height {
                let message =
                    format!("{} m leaves nothing of joint {number}, which is {height:.6} m high", section.depth);
                return Err(Diagnostic::new(format!("{path}.depth"), message));
            }
            remains.left.insert(index, kept);
            // Skip a part that an earlier entry has already removed from this side.
            if let Some(bond) = bond.filter(|_| taken[1] - taken[0] > 1e-6 * height) {
                let ends = part(joint.ends, taken[0], taken[1]);
                remains.repointed.push(Joint { ends, bond, ..joint.clone() });
            }
        }
        Ok(())
    }

    /// Removes bodies with their joints.
    fn remove(&mut self, gone: &BTreeMap<usize, String>) {
        if gone.is_empty() {
            return;
        }
        let mut next = 0;
        let new: Vec<Option<usize>> = (0..self.bodies.len())
            .map(|body| {
                (!gone.contains_key(&body)).then(|| {
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

/// Reports a number to which no part belongs.
fn missing(path: &str, what: &str, number: usize, count: usize) -> Diagnostic {
    let message = match count {
        0 => format!("there is no {what} {number}: there is none"),
        count => format!("there is no {what} {number}: they are 0 to {}", count - 1),
    };
    Diagnostic::new(format!("{path}.{what}"), message)
}

/// Returns the part of a segment between two distances from its first end.
fn part([a, b]: [Vec2; 2], from: f64, to: f64) -> [Vec2; 2] {
    let height = (b - a).norm();
    // An end that does not move keeps its exact coordinates.
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
