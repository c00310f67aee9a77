//! A bridge as numbers, and the text of its study.

use std::fmt::Write;
use voussoir::core::random::Random;

/// A segmental span.
#[derive(Debug, Clone)]
pub struct Span {
    pub span: f64,
    pub rise: f64,
    /// Thickness at the crown and at the springings.
    pub thickness: [f64; 2],
    pub voussoirs: usize,
    pub rings: usize,
}

/// Fill or backing of one material up to a level.
#[derive(Debug, Clone)]
pub struct Soil {
    pub to_level: f64,
    pub density: f64,
    pub friction_angle: f64,
    pub cohesion: f64,
    /// Angle of the spread of loads \[deg\].
    pub spread: f64,
    /// Strength as a horizontal pressure, if this is backing.
    pub backing: Option<f64>,
}

#[derive(Debug, Clone)]
pub struct Axle {
    pub at: f64,
    pub force: f64,
    pub length: f64,
    pub wheel: f64,
}

/// Joints that have lost mortar: span, ring, joint, true if from the intrados, depth.
pub type Lost = (usize, usize, usize, bool, f64);

#[derive(Debug, Clone)]
pub struct Bridge {
    pub width: f64,
    pub density: f64,
    pub friction: f64,
    pub ring_friction: f64,
    /// Crushing strength and cohesion of all joints.
    pub crushing: Option<f64>,
    pub spans: Vec<Span>,
    /// Height, width, width at the foot, and number of courses.
    pub piers: Vec<(f64, f64, f64, usize)>,
    pub cover: f64,
    /// Slope of the road: rise over length.
    pub slope: f64,
    /// Layers from the lowest; the last one reaches up to the road.
    pub soils: Vec<Soil>,
    /// Shares of passive pressure by friction and cohesion; `None` for no resistance.
    pub passive: Option<[f64; 2]>,
    pub lower: &'static str,
    pub springings_only: bool,
    pub spreads: bool,
    pub effective: bool,
    pub axles: Vec<Axle>,
    pub at: f64,
    pub lost: Vec<Lost>,
    /// Lost voussoirs of outermost rings: span, number.
    pub gone: Vec<(usize, usize)>,
    /// Bed joints of piers that have lost mortar: pier, joint, true if from the left, depth.
    pub bed: Vec<(usize, usize, bool, f64)>,
    /// True if loads spread as the stress of a half-plane, cut off at the angles of spread.
    pub half_plane: bool,
    pub factors: Factors,
}

/// Partial factors: weights and loads are multiplied, strengths and tangents are divided.
#[derive(Debug, Clone)]
pub struct Factors {
    pub masonry_weight: f64,
    pub fill_weight: f64,
    pub friction: f64,
    pub compressive_strength: f64,
    pub fill_friction: f64,
    pub fill_cohesion: f64,
    pub backing_strength: f64,
    pub loads: f64,
}

impl Factors {
    const NONE: Factors = Factors {
        masonry_weight: 1.0,
        fill_weight: 1.0,
        friction: 1.0,
        compressive_strength: 1.0,
        fill_friction: 1.0,
        fill_cohesion: 1.0,
        backing_strength: 1.0,
        loads: 1.0,
    };
}

/// Seeds from this one on also have partial factors and loads that spread as in a half-plane.
pub const MORE: u64 = 10_000;
/// Seeds from this one on also have damage of outermost rings and of piers.
pub const DAMAGED: u64 = 1_000_000;

impl Bridge {
    pub fn random(seed: u64) -> Bridge {
        let mut r = Random::new(seed);
        let count = [1, 1, 2, 3][r.whole(0, 3)];
        let spans: Vec<Span> = (0..count)
            .map(|_| {
                let span = r.between(2.0, 9.0);
                let crown = span * r.between(0.04, 0.09);
                let springing = if r.chance(0.3) { crown * r.between(1.0, 1.4) } else { crown };
                let (rise, voussoirs) = (span * r.between(0.15, 0.5), r.whole(6, 22));
                Span { span, rise, thickness: [crown, springing], voussoirs, rings: r.whole(1, 2) }
            })
            .collect();
        let piers = (1..count)
            .map(|_| {
                let width = r.between(0.8, 1.8);
                (r.between(0.5, 5.0), width, width * r.between(1.0, 1.3), r.whole(1, 3))
            })
            .collect();
        let top = spans.iter().map(|span| span.rise + span.thickness[0]).fold(0.0, f64::max);
        let soil = |r: &mut Random, to_level: f64| Soil {
            to_level,
            density: r.between(1500.0, 2200.0),
            friction_angle: r.between(0.0, 45.0),
            cohesion: if r.chance(0.5) { r.between(0.0, 2e4) } else { 0.0 },
            spread: r.between(0.0, 50.0),
            backing: None,
        };
        let mut soils = Vec::new();
        if r.chance(0.35) {
            let level = top * r.between(0.1, 0.6);
            soils.push(Soil {
                backing: Some(r.between(0.0, 2e5)),
                friction_angle: 0.0,
                cohesion: 0.0,
                ..soil(&mut r, level)
            });
        }
        if r.chance(0.35) {
            let level = top * r.between(0.65, 0.95);
            soils.push(soil(&mut r, level));
        }
        soils.push(soil(&mut r, f64::INFINITY));
        // Backing spreads loads as the fill does: it has no separate angle.
        let last = soils[soils.len() - 1].spread;
        soils.iter_mut().filter(|soil| soil.backing.is_some()).for_each(|soil| soil.spread = last);
        let total: f64 = spans.iter().map(|span| span.span).sum();
        let lost = if r.chance(0.3) {
            (0..r.whole(1, 3))
                .map(|_| {
                    let span = r.whole(0, count - 1);
                    let s: &Span = &spans[span];
                    let depth = s.thickness[0] / s.rings as f64 * r.between(0.05, 0.3);
                    (span, r.whole(0, s.rings - 1), r.whole(0, s.voussoirs), r.chance(0.5), depth)
                })
                .collect()
        } else {
            Vec::new()
        };
        let mut bridge = Bridge {
            width: r.between(2.0, 6.0),
            density: r.between(1800.0, 2600.0),
            friction: r.between(0.5, 0.9),
            ring_friction: r.between(0.2, 0.8),
            crushing: r.chance(0.5).then(|| 10f64.powf(r.between(5.8, 7.2))),
            piers,
            cover: r.between(0.05, 0.8),
            slope: if r.chance(0.3) { r.between(0.0, 0.03) } else { 0.0 },
            soils,
            passive: r.chance(0.7).then(|| [r.between(0.0, 1.0), r.between(0.0, 0.5)]),
            lower: ["zero", "zero", "active", "at_rest"][r.whole(0, 3)],
            springings_only: r.chance(0.3),
            spreads: r.chance(0.7),
            effective: r.chance(0.3),
            axles: (0..r.whole(1, 3))
                .map(|i| Axle {
                    at: 1.1 * i as f64,
                    force: r.between(500.0, 2000.0),
                    length: if r.chance(0.8) { r.between(0.1, 0.5) } else { 0.0 },
                    wheel: r.between(0.3, 1.5),
                })
                .collect(),
            at: total * r.between(0.05, 0.9),
            spans,
            lost,
            gone: Vec::new(),
            bed: Vec::new(),
            half_plane: false,
            factors: Factors::NONE,
        };
        if seed >= MORE {
            bridge.half_plane = r.chance(0.6);
            if r.chance(0.6) {
                let mut factor = |most: f64| r.between(1.0, most);
                bridge.factors = Factors {
                    masonry_weight: factor(1.3),
                    fill_weight: factor(1.4),
                    friction: factor(1.2),
                    compressive_strength: factor(2.5),
                    fill_friction: factor(1.4),
                    fill_cohesion: factor(1.6),
                    backing_strength: factor(1.5),
                    loads: factor(2.0),
                };
            }
        }
        if seed >= DAMAGED {
            bridge.damage(&mut r);
        }
        bridge
    }

    /// Removes voussoirs from outermost rings of two, but not at springings, and mortar from bed joints.
    fn damage(&mut self, r: &mut Random) {
        for span in 0..self.spans.len() {
            self.spans[span].rings = if r.chance(0.8) { 2 } else { 1 };
            self.lost.retain(|lost| lost.1 < self.spans[lost.0].rings);
            let count = self.spans[span].voussoirs;
            if self.spans[span].rings == 2 && r.chance(0.8) {
                let first = r.whole(1, count - 3);
                self.gone.extend((first..first + r.whole(1, 2)).map(|k| (span, k)));
            }
        }
        for (pier, (_, width, foot, courses)) in self.piers.iter().enumerate() {
            if r.chance(0.8) {
                let joint = r.whole(0, *courses);
                let across = width + (foot - width) * joint as f64 / *courses as f64;
                self.bed.push((pier, joint, r.chance(0.5), across * r.between(0.02, 0.3)));
            }
        }
    }

    /// Returns the bridge whose characteristic values are the design values of this one.
    pub fn design(&self) -> Bridge {
        let (f, mut design) = (&self.factors, self.clone());
        design.factors = Factors::NONE;
        design.density *= f.masonry_weight;
        design.friction /= f.friction;
        design.ring_friction /= f.friction;
        design.crushing = self.crushing.map(|strength| strength / f.compressive_strength);
        for soil in &mut design.soils {
            soil.density *= f.fill_weight;
            soil.friction_angle = (soil.friction_angle.to_radians().tan() / f.fill_friction).atan().to_degrees();
            soil.cohesion /= f.fill_cohesion;
            soil.backing = soil.backing.map(|strength| strength / f.backing_strength);
        }
        design.axles.iter_mut().for_each(|axle| axle.force *= f.loads);
        design
    }

    /// Returns the study with the same numbers.
    pub fn study(&self) -> String {
        let mut text = format!(
            "name = \"random\"\n[scene]\nscene = \"bridge\"\nwidth = {:?}\nmaterial = \"stone\"\njoint = \"dry\"\nring_joint = \"ring\"\nspans = [\n",
            self.width
        );
        for span in &self.spans {
            let [crown, springing] = span.thickness;
            let thickness = if crown == springing {
                format!("{crown:?}")
            } else {
                format!("{{ crown = {crown:?}, springing = {springing:?} }}")
            };
            let _ = writeln!(
                text,
                "  {{ profile = {{ shape = \"segmental\", span = {:?}, rise = {:?} }}, thickness = {thickness}, voussoirs = {}, rings = {} }},",
                span.span, span.rise, span.voussoirs, span.rings
            );
        }
        text += "]\npiers = [\n";
        for (height, width, base, courses) in &self.piers {
            let _ = writeln!(
                text,
                "  {{ height = {height:?}, width = {width:?}, base_width = {base:?}, courses = {courses} }},"
            );
        }
        text += "]\ndamage = [\n";
        for (span, ring, joint, intrados, depth) in &self.lost {
            let side = if *intrados { "intrados" } else { "extrados" };
            let _ = writeln!(
                text,
                "  {{ kind = \"lost_mortar\", span = {span}, ring = {ring}, joints = [{joint}], side = \"{side}\", depth = {depth:?} }},"
            );
        }
        for (span, voussoir) in &self.gone {
            let _ =
                writeln!(text, "  {{ kind = \"lost_voussoir\", span = {span}, ring = 1, voussoirs = [{voussoir}] }},");
        }
        for (pier, joint, left, depth) in &self.bed {
            let side = if *left { "left" } else { "right" };
            let _ = writeln!(
                text,
                "  {{ kind = \"lost_mortar\", pier = {pier}, joints = [{joint}], side = \"{side}\", depth = {depth:?} }},"
            );
        }
        text += "]\n";
        text += &self.fill_text();
        let law = |mu: f64| match self.crushing {
            Some(strength) => {
                format!("law = \"mohr_coulomb\"\nfriction = {mu:?}\ncompressive_strength = {strength:?}\n")
            }
            None => format!("law = \"coulomb_associated\"\nfriction = {mu:?}\n"),
        };
        let _ = write!(
            text,
            "[materials.stone]\nlaw = \"rigid\"\ndensity = {:?}\n[joints.dry]\n{}[joints.ring]\n{}[vehicles.cart]\naxles = [\n",
            self.density,
            law(self.friction),
            law(self.ring_friction)
        );
        for Axle { at, force, length, wheel } in &self.axles {
            let _ =
                writeln!(text, "  {{ at = {at:?}, force = {force:?}, length = {length:?}, wheel_width = {wheel:?} }},");
        }
        let across = if self.effective { "effective" } else { "full_width" };
        let _ = write!(
            text,
            "]\n[[stages]]\nname = \"dead\"\ngravity = 9.81\n[[stages]]\nname = \"live\"\nuntil = \"collapse\"\nloads = [{{ kind = \"vehicle\", vehicle = \"cart\", at = {:?}, across = \"{across}\" }}]\n",
            self.at
        );
        let f = &self.factors;
        let _ = write!(
            text,
            "[factors]\nmasonry_weight = {:?}\nfill_weight = {:?}\nfriction = {:?}\ncompressive_strength = {:?}\nfill_friction = {:?}\nfill_cohesion = {:?}\nbacking_strength = {:?}\nloads = {{ live = {:?} }}\n",
            f.masonry_weight,
            f.fill_weight,
            f.friction,
            f.compressive_strength,
            f.fill_friction,
            f.fill_cohesion,
            f.backing_strength,
            f.loads
        );
        text
    }

    fn fill_text(&self) -> String {
        let last = &self.soils[self.soils.len() - 1];
        let extent = if self.springings_only { "springings" } else { "extrados" };
        let road: Vec<String> = self.road().iter().map(|[x, y]| format!("[{x:?}, {y:?}]")).collect();
        let mut text = format!(
            "[scene.fill]\nroad = [{}]\ndensity = {:?}\nfriction_angle = {:?}\ncohesion = {:?}\nextent = \"{extent}\"\n",
            road.join(", "),
            last.density,
            last.friction_angle,
            last.cohesion
        );
        if self.spreads {
            let law = if self.half_plane { "boussinesq" } else { "uniform" };
            let _ = writeln!(text, "dispersion = {{ law = \"{law}\", angle = {:?} }}", last.spread);
        }
        if let Some([m_p, m_c]) = self.passive {
            let _ = writeln!(
                text,
                "resistance = {{ law = \"fill_pressure\", passive_factor = {m_p:?}, cohesion_factor = {m_c:?}, lower = \"{}\" }}",
                self.lower
            );
        }
        let mut layers = Vec::new();
        for soil in &self.soils[..self.soils.len() - 1] {
            match soil.backing {
                Some(strength) => {
                    let _ = writeln!(
                        text,
                        "haunching = {{ level = {:?}, density = {:?}, strength = {strength:?} }}",
                        soil.to_level, soil.density
                    );
                }
                None => layers.push(format!(
                    "{{ to_level = {:?}, density = {:?}, friction_angle = {:?}, cohesion = {:?}, angle = {:?} }}",
                    soil.to_level, soil.density, soil.friction_angle, soil.cohesion, soil.spread
                )),
            }
        }
        let _ = writeln!(text, "layers = [{}]", layers.join(", "));
        text
    }

    /// Returns two points of a straight road.
    pub fn road(&self) -> [[f64; 2]; 2] {
        let top = self.spans.iter().map(|span| span.rise + span.thickness[0]).fold(0.0, f64::max) + self.cover;
        // High enough everywhere, also above thick springings of a deep ring.
        [[-5.0, top + 0.3], [40.0, top + 0.3 + 45.0 * self.slope]]
    }

    pub fn road_at(&self, x: f64) -> f64 {
        let [[x0, y0], [x1, y1]] = self.road();
        y0 + (y1 - y0) * (x - x0) / (x1 - x0)
    }
}
