//! The profile of an arch: its intrados, and the vertices of a ring of straight-sided voussoirs on it. x = 0 at midspan, y = 0
//! at the intrados springings.
//!
//! Joints are normal to the intrados at equal arc length; on a segmental arch this means equal angles. The thickness is
//! measured along the joints and may grow from the crown to the springings. At the apex of a pointed arch the intrados has no
//! normal; the joint there is vertical. Sources: plane geometry; the catenary after Bernoulli, Huygens and Leibniz (1691).

use super::curve::Curve;
use super::lookup::{out_of_range, outside};
use super::surveyed::cut;
use super::thickness::Thickness;
use voussoir_core::model::crosses_itself;
use voussoir_core::model::geometry::{Vec2, area_and_centroid, bounding_box, is_convex};
use voussoir_core::plugin::{Diagnostic, Keys, Range};

/// Keys that profiles share.
#[derive(Debug, Keys)]
pub struct ProfileKeys {
    /// clear span of the intrados
    #[key(unit = "m", range = "> 0")]
    span: f64,
    /// rise of the intrados
    #[key(unit = "m", range = "> 0")]
    rise: f64,
    /// a table of these points beside the study: one line per point, columns curve, x, y, or one line per joint, columns intrados_x,
    /// intrados_y, extrados_x, extrados_y; a unit may follow a name: x \[mm\]
    #[key(optional = "intrados and extrados are given")]
    file: Option<String>,
}

/// `profile = { shape = …, … }`.
#[derive(Debug, Clone, PartialEq, Keys)]
#[keys(tag = "shape")]
pub enum Profile {
    /// circular arc; rise > span/2 is more than a half circle
    Segmental {
        /// Clear span \[m\].
        #[key(like = ProfileKeys)]
        span: f64,
        /// Rise of the intrados \[m\].
        #[key(like = ProfileKeys)]
        rise: f64,
    },
    /// half ellipse
    Elliptical {
        /// Clear span \[m\].
        #[key(like = ProfileKeys)]
        span: f64,
        /// Rise of the intrados \[m\].
        #[key(like = ProfileKeys)]
        rise: f64,
    },
    /// parabola
    Parabolic {
        /// Clear span \[m\].
        #[key(like = ProfileKeys)]
        span: f64,
        /// Rise of the intrados \[m\].
        #[key(like = ProfileKeys)]
        rise: f64,
    },
    /// hanging chain turned over
    Catenary {
        /// Clear span \[m\].
        #[key(like = ProfileKeys)]
        span: f64,
        /// Rise of the intrados \[m\].
        #[key(like = ProfileKeys)]
        rise: f64,
    },
    /// two arcs with centres on the springing line, rise ≥ span/2
    Pointed {
        /// Clear span \[m\].
        #[key(like = ProfileKeys)]
        span: f64,
        /// Rise of the intrados \[m\].
        #[key(like = ProfileKeys)]
        rise: f64,
    },
    /// crown arc between two side arcs, upright at the springings, rise < span/2
    ThreeCentred {
        /// Clear span \[m\].
        #[key(like = ProfileKeys)]
        span: f64,
        /// Rise of the intrados \[m\].
        #[key(like = ProfileKeys)]
        rise: f64,
        /// radius of the crown arc, more than the radius of the segmental arc with this span and rise
        #[key(unit = "m", range = "> 0")]
        crown_radius: f64,
    },
    /// vertices joint by joint, from left to right
    Points {
        /// intrados end of each joint
        #[key(names = ["x", "y"], unit = "m", len = ">= 2", optional = "file is given")]
        intrados: Vec<[f64; 2]>,
        /// extrados end of each joint
        #[key(names = ["x", "y"], unit = "m", len = ">= 2", optional = "file is given")]
        extrados: Vec<[f64; 2]>,
        /// Replaced by the points before this table is read.
        #[key(like = ProfileKeys)]
        file: Option<String>,
    },
    /// points along both faces, cut into `voussoirs` of equal length along the intrados
    Surveyed {
        /// points of the intrados from springing to springing
        #[key(names = ["x", "y"], unit = "m", len = ">= 2", optional = "file is given")]
        intrados: Vec<[f64; 2]>,
        /// points of the extrados, beginning and ending at the springing faces
        #[key(names = ["x", "y"], unit = "m", len = ">= 2", optional = "file is given")]
        extrados: Vec<[f64; 2]>,
        /// Replaced by the points before this table is read.
        #[key(like = ProfileKeys)]
        file: Option<String>,
    },
}

/// `springing`: inclination of the support planes above the horizontal, rising outwards \[deg\].
#[derive(Debug, Clone, Copy, PartialEq, Keys)]
#[keys(untagged)]
pub enum Springing {
    /// The same on both sides.
    #[key(unit = "deg", range = INCLINATION)]
    Both(f64),
    /// Left, right.
    #[key(names = ["left", "right"], unit = "deg", range = INCLINATION)]
    Each([f64; 2]),
}

const INCLINATION: Range = Range::new(-90.0, true, 90.0, false);
impl Springing {
    /// Returns \[left, right\] \[deg\], each with its key.
    fn sides(self) -> [(f64, &'static str); 2] {
        match self {
            Springing::Both(angle) => [(angle, "springing"); 2],
            Springing::Each([left, right]) => [(left, "springing.0"), (right, "springing.1")],
        }
    }
}

/// Vertices of a ring of voussoirs, joint by joint from left to right \[m\].
#[derive(Debug, Clone, PartialEq)]
pub struct Ring {
    /// Intrados ends of the N + 1 joints.
    pub intrados: Vec<Vec2>,
    /// Extrados ends of the N + 1 joints.
    pub extrados: Vec<Vec2>,
    /// Horizontal distance of the intrados springings.
    pub span: f64,
    /// Height of the highest intrados point above the middle of the springings.
    pub rise: f64,
}

impl Ring {
    /// Returns voussoir k, anticlockwise: intrados from left to right, extrados from right to left.
    pub fn voussoir(&self, k: usize) -> Vec<Vec2> {
        vec![self.intrados[k], self.intrados[k + 1], self.extrados[k + 1], self.extrados[k]]
    }

    /// Returns true if the ring's outline proves that no two voussoirs overlap. Convex voussoirs of one orientation, each joined
    /// to the next along a whole edge, form a disc that is laid into the plane without folds. Every point is covered as often as
    /// the outline winds around it, which is at most once if the outline does not cross itself.
    pub fn is_plainly_simple(&self) -> bool {
        let outline: Vec<Vec2> = self.intrados.iter().chain(self.extrados.iter().rev()).copied().collect();
        let convex = |k: usize| {
            let voussoir = self.voussoir(k);
            is_convex(&voussoir) && area_and_centroid(&voussoir).0 > 0.0
        };
        (0..self.voussoirs()).all(convex) && !crosses_itself(&outline)
    }

    /// Returns the number of voussoirs.
    pub fn voussoirs(&self) -> usize {
        self.intrados.len() - 1
    }
}

impl Profile {
    /// Returns the ring with `voussoirs` voussoirs and the thickness `thickness` \[m\]. Both must be given, except for `points`,
    /// which define them. Diagnostics have paths from the scene's table.
    pub fn ring(
        &self,
        thickness: Option<Thickness>,
        voussoirs: Option<usize>,
        springing: Option<Springing>,
    ) -> Result<Ring, Vec<Diagnostic>> {
        if let Profile::Points { intrados, extrados, .. } = self {
            return ring_of_points(intrados, extrados, thickness, voussoirs, springing);
        }
        if let Profile::Surveyed { intrados, extrados, .. } = self {
            let Some(voussoirs) = voussoirs else {
                return Err(vec![Diagnostic::new("voussoirs", "is missing: the number of voussoirs")]);
            };
            let [intrados, extrados] = cut(intrados, extrados, voussoirs)?;
            return ring_of_points(&intrados, &extrados, thickness, None, springing);
        }
        let mut diagnostics = Vec::new();
        match thickness {
            None => diagnostics.push(Diagnostic::new("thickness", "is missing: the thickness of the ring [m]")),
            Some(thickness) => diagnostics.extend(thickness.mistakes()),
        }
        match voussoirs {
            None => diagnostics.push(Diagnostic::new("voussoirs", "is missing: the number of voussoirs")),
            Some(0) => diagnostics.push(Diagnostic::new("voussoirs", "there must be at least one")),
            Some(_) => {}
        }
        if let Some(springing) = springing {
            let sides = springing.sides();
            let sides = if sides[0] == sides[1] { &sides[..1] } else { &sides[..] };
            diagnostics.extend(sides.iter().filter_map(|&(angle, key)| outside(INCLINATION, key, angle)));
        }
        let curve = self.curve().map_err(|mut wrong| diagnostics.append(&mut wrong)).ok();
        let (Some(curve), Some(thickness), Some(voussoirs)) = (curve, thickness, voussoirs) else {
            return Err(diagnostics);
        };
        if !diagnostics.is_empty() {
            return Err(diagnostics);
        }
        let mut ring = ring_on(&curve, thickness, voussoirs);
        if let Some(springing) = springing {
            let Some(thickness) = thickness.even() else {
                let wrong = Diagnostic::new("springing", "is given besides a thickness that varies");
                return Err(vec![wrong.help("the end joints are normal to the intrados there; remove this key")]);
            };
            move_springings(&mut ring, &curve, thickness, springing)?;
        }
        check_voussoirs(&ring, springing)?;
        Ok(ring)
    }

    /// Returns the intrados, or the reasons why it cannot exist.
    fn curve(&self) -> Result<Curve, Vec<Diagnostic>> {
        let (span, rise) = match *self {
            Profile::Segmental { span, rise }
            | Profile::Elliptical { span, rise }
            | Profile::Parabolic { span, rise }
            | Profile::Catenary { span, rise }
            | Profile::Pointed { span, rise }
            | Profile::ThreeCentred { span, rise, .. } => (span, rise),
            Profile::Points { .. } | Profile::Surveyed { .. } => unreachable!("a list of points is no curve"),
        };
        let mut diagnostics = Vec::new();
        diagnostics.extend(out_of_range::<ProfileKeys>("profile.span", span));
        diagnostics.extend(out_of_range::<ProfileKeys>("profile.rise", rise));
        if diagnostics.is_empty() && !(1e-6..=1e3).contains(&(rise / span)) {
            let message = format!("{rise} m is out of proportion to the span of {span} m: 1e-6 to 1e3 times the span");
            diagnostics.push(Diagnostic::new("profile.rise", message));
        }
        if !diagnostics.is_empty() {
            return Err(diagnostics);
        }
        match *self {
            Profile::Segmental { .. } => Ok(Curve::segmental(span, rise)),
            Profile::Elliptical { .. } => Ok(Curve::elliptical(span, rise)),
            Profile::Parabolic { .. } => Ok(Curve::parabolic(span, rise)),
            Profile::Catenary { .. } => Ok(Curve::catenary(span, rise)),
            Profile::Pointed { .. } if rise < span / 2.0 => Err(vec![
                Diagnostic::new(
                    "profile.rise",
                    format!("{rise} m is too low for a pointed arch: at least half the span, {} m", span / 2.0),
                )
                .help("a lower pointed arch needs centres below the springings; give its points"),
            ]),
            Profile::Pointed { .. } => Ok(Curve::pointed(span, rise)),
            Profile::ThreeCentred { crown_radius, .. } => three_centred(span, rise, crown_radius).map_err(|i| vec![i]),
            Profile::Points { .. } | Profile::Surveyed { .. } => unreachable!("returned above"),
        }
    }
}

/// With rise < span/2 the side radius is between 0 and the crown radius exactly if the crown radius is greater than the
/// radius of the segmental arc. With a greater rise the crown arc would turn beyond the vertical.
fn three_centred(span: f64, rise: f64, crown: f64) -> Result<Curve, Diagnostic> {
    if rise >= span / 2.0 {
        let message =
            format!("{rise} m is too high for a three-centred arch: less than half the span, {} m", span / 2.0);
        return Err(Diagnostic::new("profile.rise", message));
    }
    let least = (span * span / 4.0 + rise * rise) / (2.0 * rise);
    let curve = Curve::three_centred(span, rise, crown);
    match curve {
        Curve::ThreeCentred { side, .. } if crown > least && side > 0.0 && side < crown && crown.is_finite() => {
            Ok(curve)
        }
        _ => Err(Diagnostic::new(
            "profile.crown_radius",
            format!("{crown} m must be more than {least} m, the radius of the segmental arc of this span and rise"),
        )),
    }
}

/// Builds joints normal to the curve at equal arc length. Joint N − k is the exact mirror image of joint k.
fn ring_on(curve: &Curve, thickness: Thickness, voussoirs: usize) -> Ring {
    let (mut intrados, mut extrados) = (Vec::new(), Vec::new());
    for k in 0..=voussoirs {
        let from_crown = (2 * k).abs_diff(voussoirs);
        let (point, normal) = curve.at_share(from_crown, voussoirs);
        let outer = point + normal * thickness.at(from_crown as f64 / voussoirs as f64);
        let left = 2 * k < voussoirs;
        intrados.push(if left { mirrored(point) } else { point });
        extrados.push(if left { mirrored(outer) } else { outer });
    }
    Ring { intrados, extrados, span: 2.0 * curve.half_span(), rise: curve.rise() }
}

fn mirrored(p: Vec2) -> Vec2 {
    Vec2::new(-p.x, p.y)
}

/// Moves the end vertices of the extrados along the offset curve onto the support planes.
fn move_springings(
    ring: &mut Ring,
    curve: &Curve,
    thickness: f64,
    springing: Springing,
) -> Result<(), Vec<Diagnostic>> {
    let last = ring.voussoirs();
    let mut diagnostics = Vec::new();
    for (side, (degrees, key)) in springing.sides().into_iter().enumerate() {
        match curve.offset_on_plane(thickness, degrees.to_radians()) {
            Some(point) if side == 0 => ring.extrados[0] = mirrored(point),
            Some(point) => ring.extrados[last] = point,
            None if diagnostics.is_empty() || key != "springing" => diagnostics.push(Diagnostic::new(
                key,
                format!("a plane at {degrees} deg through the springing does not meet the extrados on its side of the crown, outside of the opening"),
            )),
            None => {}
        }
    }
    if diagnostics.is_empty() { Ok(()) } else { Err(diagnostics) }
}

/// Checks that every voussoir has an area and does not cross itself.
fn check_voussoirs(ring: &Ring, springing: Option<Springing>) -> Result<(), Vec<Diagnostic>> {
    let last = ring.voussoirs() - 1;
    let sound = |k: usize| is_sound(&ring.voussoir(k));
    let mut diagnostics = Vec::new();
    for k in (0..=last).filter(|&k| !sound(k)) {
        diagnostics.push(match springing {
            Some(springing) if k == 0 || k == last => {
                let (degrees, key) = springing.sides()[usize::from(k == last)];
                let message =
                    format!("a springing at {degrees} deg cuts voussoir {k} away: it has no area or crosses itself");
                Diagnostic::new(key, message)
            }
            _ => Diagnostic::new("voussoirs", format!("voussoir {k} has no area or crosses itself"))
                .help("use more voussoirs"),
        });
    }
    diagnostics.dedup_by(|a, b| a.path == b.path);
    if diagnostics.is_empty() { Ok(()) } else { Err(diagnostics) }
}

/// Returns true if an anticlockwise polygon has an area beyond rounding and does not cross itself.
fn is_sound(vertices: &[Vec2]) -> bool {
    let (low, high) = bounding_box(vertices);
    area_and_centroid(vertices).0 > 1e-12 * (high - low).norm_squared() && !crosses_itself(vertices)
}

fn ring_of_points(
    intrados: &[[f64; 2]],
    extrados: &[[f64; 2]],
    thickness: Option<Thickness>,
    voussoirs: Option<usize>,
    springing: Option<Springing>,
) -> Result<Ring, Vec<Diagnostic>> {
    let mut diagnostics = Vec::new();
    if thickness.is_some() {
        diagnostics
            .push(Diagnostic::new("thickness", "the points of the profile already fix it").help("remove this key"));
    }
    if springing.is_some() {
        diagnostics
            .push(Diagnostic::new("springing", "the points of the profile already fix it").help("remove this key"));
    }
    if intrados.len() != extrados.len() {
        let message = format!("{} points, but the intrados has {}", extrados.len(), intrados.len());
        diagnostics.push(Diagnostic::new("profile.extrados", message).help("give both ends of every joint"));
    }
    if intrados.len() < 2 {
        diagnostics.push(Diagnostic::new("profile.intrados", "at least two points: the springings"));
    }
    if let Some(voussoirs) = voussoirs
        && voussoirs + 1 != intrados.len()
    {
        let message = format!("{voussoirs}, but {} points make {}", intrados.len(), intrados.len().saturating_sub(1));
        diagnostics.push(Diagnostic::new("voussoirs", message).help("remove this key"));
    }
    for (key, points) in [("intrados", intrados), ("extrados", extrados)] {
        for (i, point) in points.iter().enumerate().filter(|(_, p)| !p.iter().all(|x| x.is_finite())) {
            diagnostics.push(Diagnostic::new(format!("profile.{key}.{i}"), format!("{point:?} is not finite")));
        }
    }
    if !diagnostics.is_empty() {
        return Err(diagnostics);
    }
    let vectors = |points: &[[f64; 2]]| points.iter().map(|&[x, y]| Vec2::new(x, y)).collect::<Vec<_>>();
    let (intrados, extrados) = (vectors(intrados), vectors(extrados));
    let (first, last) = (intrados[0], intrados[intrados.len() - 1]);
    let crown = intrados.iter().fold(f64::NEG_INFINITY, |top, p| top.max(p.y));
    let ring = Ring { span: last.x - first.x, rise: crown - (first.y + last.y) / 2.0, intrados, extrados };
    if ring.span <= 0.0 {
        diagnostics.push(Diagnostic::new("profile.intrados", "the last point must lie to the right of the first"));
    }
    for k in (0..ring.voussoirs()).filter(|&k| !is_sound(&ring.voussoir(k))) {
        let message =
            format!("voussoir {k}, between points {k} and {}, has no area, crosses itself or is turned over", k + 1);
        diagnostics
            .push(Diagnostic::new(format!("profile.intrados.{k}"), message).help("list both from left to right"));
    }
    if diagnostics.is_empty() { Ok(ring) } else { Err(diagnostics) }
}

#[cfg(test)]
mod tests;
