//! The scaled data of a problem and the two maps of statics and kinematics.
//!
//! The unit of force is the root mean square of the loads of a body, the unit of length the mean size of a contact. Each
//! body has a pole at the centre of its contacts. A contact has six rates in its own frame at its centre; the rates of
//! its points follow from them. Forces of a point are y = (μ n + c a, s, t), so that every cone is y₀ ≥ |(y₁, y₂)|; the
//! forces of the tip, y = 0, count as loads. Without friction the shear forces have no effect. A tensile strength below the
//! tip and a compressive strength bound y₀. Without friction, cohesion bounds the shear force alone: a second member has the
//! points with areas, no normal force, and y₀ ≤ c a.

use super::cone::{Cone, UNIT, margin};
use std::ops::Range;
use voussoir_core::space::{PointSet, SpaceContact, SpaceProblem, Vec3, Wrench};

/// Velocities or wrenches of all bodies in units of the program, six numbers each.
pub type Bodies = Vec<f64>;

/// A contact of a program, or the cohesion of a contact without friction.
#[derive(Clone)]
pub struct Member {
    /// Index of the contact in the problem.
    contact: usize,
    /// Indices of its points in the contact.
    places: Vec<usize>,
    /// Plus and minus body.
    pub bodies: [Option<usize>; 2],
    /// Unit vectors n, s, t.
    pub frame: [Vec3; 3],
    /// Centre of the contact relative to the pole of each body.
    pub arms: [Vec3; 2],
    /// Its points in the list of all points.
    pub points: Range<usize>,
    /// Forces n and (s, t) for y = 1.
    pub strengths: [f64; 2],
}

/// The points of a contact that a program uses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Side {
    /// Those whose forces are admissible.
    Inner,
    /// Those that bound the dissipation.
    Outer,
}

impl Side {
    fn of(self, contact: &SpaceContact) -> &PointSet {
        match self {
            Side::Inner => &contact.inner,
            Side::Outer => &contact.outer,
        }
    }
}

/// Data of a problem in units of the program.
#[derive(Clone)]
pub struct Program {
    /// All contacts of the problem.
    pub members: Vec<Member>,
    /// Points relative to the centre of their contact, in its frame.
    pub points: Vec<Vec3>,
    /// Number of points of each contact of the problem.
    counts: Vec<usize>,
    /// y₀ of each point without force.
    offsets: Vec<f64>,
    /// Least and greatest y₀ of each point.
    pub limits: Vec<[f64; 2]>,
    /// Loads at the start, with the forces of the tips.
    pub base: Bodies,
    /// Varying loads.
    pub varying: Bodies,
    /// Poles of the bodies relative to the pole of the problem \[m\].
    poles: Vec<Vec3>,
    /// Unit of length \[m\].
    length: f64,
    /// Unit of force \[N\].
    force: f64,
    /// Load factor for λ = 1 in units of the program.
    pub unit: f64,
    /// Load factor at the start.
    pub start: f64,
}

/// Returns the mean of the outer points of a contact.
fn centre(contact: &SpaceContact) -> Vec3 {
    contact.outer.points.iter().sum::<Vec3>() / contact.outer.points.len().max(1) as f64
}

/// Returns the root mean square of the entries, and zero for none.
fn mean_size(values: &[f64]) -> f64 {
    (values.iter().map(|x| x * x).sum::<f64>() / values.len().max(1) as f64).sqrt()
}

impl Program {
    /// Scales a problem whose loads start at a factor. Both sides have the same units and poles.
    pub fn new(problem: &SpaceProblem, start: f64, side: Side) -> Self {
        let length = length(problem);
        let poles = poles(problem);
        let mut points = Vec::new();
        let parts = parts(problem, side);
        let members = parts.iter().map(|part| {
            let contact = &problem.contacts[part.contact];
            member(contact, (part, side.of(contact)), (&poles, length), &mut points)
        });
        let members: Vec<Member> = members.collect();
        let counts = problem.contacts.iter().map(|contact| side.of(contact).points.len()).collect();
        let local = |wrench: &Wrench, pole: &Vec3| {
            let (force, moment) =
                (Vec3::new(wrench[0], wrench[1], wrench[2]), Vec3::new(wrench[3], wrench[4], wrench[5]));
            let moment = (moment - pole.cross(&force)) / length;
            [force.x, force.y, force.z, moment.x, moment.y, moment.z]
        };
        let gather = |wrenches: &[Wrench]| -> Bodies {
            wrenches.iter().zip(&poles).flat_map(|(wrench, pole)| local(wrench, pole)).collect()
        };
        let (fixed, mut varying) = (gather(&problem.fixed), gather(&problem.varying));
        let mut base: Bodies = fixed.iter().zip(&varying).map(|(w, p)| w + start * p).collect();
        let sizes = [mean_size(&base), mean_size(&varying)];
        let force = [sizes[0], sizes[1], 1.0].into_iter().find(|size| *size > 0.0).unwrap_or(1.0);
        let unit = if sizes[1] > 0.0 { force / sizes[1] } else { 1.0 };
        base.iter_mut().for_each(|w| *w /= force);
        varying.iter_mut().for_each(|p| *p *= unit / force);
        let [offsets, least, most] = [0, 1, 2].map(|k| {
            parts.iter().flat_map(|part| part.bounds.iter().map(move |bounds| bounds[k] / force)).collect::<Vec<f64>>()
        });
        let limits = least.into_iter().zip(most).map(<[f64; 2]>::from).collect();
        let mut program =
            Program { members, points, counts, offsets, limits, base, varying, poles, length, force, unit, start };
        let tips: Vec<Cone> = program.offsets.iter().map(|offset| [-offset, 0.0, 0.0]).collect();
        let mut base = std::mem::take(&mut program.base);
        program.press(&tips, &mut base);
        Program { base, ..program }
    }

    /// Returns the distance of the forces of a point from the boundary of its strength.
    pub fn margin(&self, point: usize, y: &Cone) -> f64 {
        let [least, most] = self.limits[point];
        margin(y).min(if least > 0.0 { y[0] - least } else { f64::INFINITY }).min(most - y[0])
    }

    /// Returns the distance of the rates of a point from the boundary of those that it can have.
    pub fn margin_of_rate(&self, point: usize, z: &Cone) -> f64 {
        if self.limits[point][1].is_finite() { f64::INFINITY } else { margin(z) }
    }

    /// Returns the dissipation of all points beyond the work of the tips: the greatest −y·z.
    pub fn dissipation(&self, z: &[Cone]) -> f64 {
        let of = |(z, [least, most]): (&Cone, &[f64; 2])| {
            let inside = margin(z);
            -inside * if inside < 0.0 && most.is_finite() { *most } else { *least }
        };
        z.iter().zip(&self.limits).map(of).sum()
    }

    /// Returns the rates z of all points for velocities of the bodies.
    pub fn rates(&self, q: &[f64]) -> Vec<Cone> {
        let mut rates = vec![[0.0; 3]; self.points.len()];
        for member in &self.members {
            let [translation, rotation] = member.jump(q);
            for point in member.points.clone() {
                let v = translation + rotation.cross(&self.points[point]);
                rates[point] = [member.strengths[0] * v.x, member.strengths[1] * v.y, member.strengths[1] * v.z];
            }
        }
        rates
    }

    /// Adds the wrenches of forces y on all bodies to `sum`.
    pub fn press(&self, y: &[Cone], sum: &mut [f64]) {
        for member in &self.members {
            let (mut force, mut moment) = (Vec3::zeros(), Vec3::zeros());
            for point in member.points.clone() {
                let f = member.force(&y[point]);
                force += f;
                moment += self.points[point].cross(&f);
            }
            member.act(&force, &moment, sum);
        }
    }

    /// Returns A y + λ p + τ w.
    pub fn imbalance(&self, y: &[Cone], lambda: f64, tau: f64) -> Bodies {
        let mut sum: Bodies = self.base.iter().zip(&self.varying).map(|(w, p)| tau * w + lambda * p).collect();
        self.press(y, &mut sum);
        sum
    }

    /// Returns the same contacts without fixed loads, and with unit normal forces at all points as varying loads. Its
    /// factor has no bound if forces inside all cones are in balance without loads.
    pub fn of_self_stress(&self) -> Self {
        let mut varying = vec![0.0; self.base.len()];
        self.press(&vec![UNIT; self.points.len()], &mut varying);
        Program { base: vec![0.0; self.base.len()], varying, ..self.clone() }
    }

    /// Returns forces (n, s, t) of all points \[N\], contact by contact.
    pub fn forces(&self, y: &[Cone]) -> Vec<Vec<[f64; 3]>> {
        let less = |(y, offset): (&Cone, &f64)| [y[0] - offset, y[1], y[2]];
        self.differences(&y.iter().zip(&self.offsets).map(less).collect::<Vec<_>>())
    }

    /// Returns forces (n, s, t) of all points \[N\], contact by contact, from forces in units of the program.
    pub fn by_contacts(&self, forces: &[[f64; 3]]) -> Vec<Vec<[f64; 3]>> {
        self.sums(|_, point| forces[point])
    }

    /// Returns the sums over the members of each contact of forces of all points \[N\], in units of the program.
    fn sums(&self, force: impl Fn(&Member, usize) -> [f64; 3]) -> Vec<Vec<[f64; 3]>> {
        let mut all: Vec<Vec<[f64; 3]>> = self.counts.iter().map(|count| vec![[0.0; 3]; *count]).collect();
        for member in &self.members {
            for (place, point) in member.places.iter().zip(member.points.clone()) {
                let own = force(member, point);
                (0..3).for_each(|k| all[member.contact][*place][k] += self.force * own[k]);
            }
        }
        all
    }

    /// Returns forces (n, s, t) of all points in units of the program.
    pub fn scaled(&self, field: &[Vec<[f64; 3]>]) -> Vec<[f64; 3]> {
        field.iter().flatten().map(|force| force.map(|f| f / self.force)).collect()
    }

    /// Returns differences of forces (n, s, t) of all points \[N\], contact by contact.
    pub fn differences(&self, y: &[Cone]) -> Vec<Vec<[f64; 3]>> {
        self.sums(|member, point| member.force(&y[point]).into())
    }

    /// Returns y of all points without any force.
    pub fn without_forces(&self) -> Vec<Cone> {
        self.offsets.iter().map(|offset| [*offset, 0.0, 0.0]).collect()
    }

    /// Returns velocities about the pole of the problem; they have the scale of the program.
    pub fn motion(&self, q: &[f64]) -> Vec<[f64; 6]> {
        let about = |(q, pole): (&[f64], &Vec3)| {
            let omega = Vec3::new(q[3], q[4], q[5]) / self.length;
            let v = Vec3::new(q[0], q[1], q[2]) - omega.cross(pole);
            [v.x, v.y, v.z, omega.x, omega.y, omega.z]
        };
        q.chunks_exact(6).zip(&self.poles).map(about).collect()
    }

    /// Returns a motion in units of the program, with unit power of the varying loads, from velocities about the pole of the problem.
    pub fn scaled_motion(&self, velocities: &[[f64; 6]]) -> Bodies {
        let about = |(v, pole): (&[f64; 6], &Vec3)| {
            let omega = Vec3::new(v[3], v[4], v[5]);
            let (v, omega) = (Vec3::new(v[0], v[1], v[2]) + omega.cross(pole), omega * self.length);
            [v.x, v.y, v.z, omega.x, omega.y, omega.z]
        };
        let motion: Bodies = velocities.iter().zip(&self.poles).flat_map(about).collect();
        let power: f64 = motion.iter().zip(&self.varying).map(|(q, p)| q * p).sum();
        motion.iter().map(|q| q / power).collect()
    }
}

impl Member {
    /// Returns the force (n, s, t) of a point.
    pub fn force(&self, y: &Cone) -> Vec3 {
        Vec3::new(self.strengths[0] * y[0], self.strengths[1] * y[1], self.strengths[1] * y[2])
    }

    /// Returns the wrench on the bodies of a unit of component `k` of the force of a point.
    pub fn wrench(&self, point: &Vec3, k: usize) -> Vec<(usize, f64)> {
        let mut unit = [0.0; 3];
        unit[k] = 1.0;
        let force = self.force(&unit);
        let global = |x: &Vec3| self.frame[0] * x.x + self.frame[1] * x.y + self.frame[2] * x.z;
        let (force, moment) = (global(&force), global(&point.cross(&force)));
        let sides = self.bodies.iter().zip(&self.arms).zip([1.0, -1.0]);
        let of = |((body, arm), sign): ((&Option<usize>, &Vec3), f64)| {
            let moment = moment + arm.cross(&force);
            let both = [force * sign, moment * sign];
            body.map(|body| (0..6).map(move |i| (6 * body + i, both[i / 3][i % 3])))
        };
        let mut entries: Vec<(usize, f64)> = sides.filter_map(of).flatten().collect();
        entries.sort_unstable_by_key(|entry| entry.0);
        entries
    }

    /// Returns relative translation at the centre, and relative rotation, of plus to minus in the frame of the contact.
    fn jump(&self, q: &[f64]) -> [Vec3; 2] {
        let (mut v, mut omega) = (Vec3::zeros(), Vec3::zeros());
        for ((body, arm), sign) in self.bodies.iter().zip(&self.arms).zip([1.0, -1.0]) {
            let Some(body) = body else { continue };
            let own = &q[6 * body..6 * body + 6];
            let turn = Vec3::new(own[3], own[4], own[5]);
            v += (Vec3::new(own[0], own[1], own[2]) + turn.cross(arm)) * sign;
            omega += turn * sign;
        }
        let local = |x: Vec3| Vec3::new(self.frame[0].dot(&x), self.frame[1].dot(&x), self.frame[2].dot(&x));
        [local(v), local(omega)]
    }

    /// Adds a force and a moment about the centre, in the frame of the contact, to the wrenches of the bodies.
    fn act(&self, force: &Vec3, moment: &Vec3, sum: &mut [f64]) {
        let global = |x: &Vec3| self.frame[0] * x.x + self.frame[1] * x.y + self.frame[2] * x.z;
        let (force, moment) = (global(force), global(moment));
        for ((body, arm), sign) in self.bodies.iter().zip(&self.arms).zip([1.0, -1.0]) {
            let Some(body) = body else { continue };
            let moment = moment + arm.cross(&force);
            for i in 0..3 {
                sum[6 * body + i] += sign * force[i];
                sum[6 * body + 3 + i] += sign * moment[i];
            }
        }
    }
}

/// Returns the mean distance of the points of a contact from its centre \[m\].
fn length(problem: &SpaceProblem) -> f64 {
    let (mut sum, mut count) = (0.0, 0);
    for contact in &problem.contacts {
        let centre = centre(contact);
        sum += contact.outer.points.iter().map(|point| (point - centre).norm()).sum::<f64>();
        count += contact.outer.points.len();
    }
    let mean = sum / f64::from(u32::try_from(count.max(1)).unwrap_or(u32::MAX));
    if mean > 0.0 { mean } else { problem.length.max(f64::MIN_POSITIVE) }
}

/// Returns the centre of the contacts of each body.
fn poles(problem: &SpaceProblem) -> Vec<Vec3> {
    let mut poles = vec![(Vec3::zeros(), 0.0); problem.bodies];
    for contact in &problem.contacts {
        for body in [contact.minus, contact.plus].into_iter().flatten() {
            poles[body].0 += centre(contact);
            poles[body].1 += 1.0;
        }
    }
    poles.into_iter().map(|(sum, count)| if count > 0.0 { sum / count } else { sum }).collect()
}

/// A member before it is scaled.
struct Part {
    /// Index of the contact in the problem.
    contact: usize,
    /// Indices of its points in the contact.
    places: Vec<usize>,
    /// Forces n and (s, t) for y = 1.
    strengths: [f64; 2],
    /// y₀ without force, and its least and greatest value, of each point \[N\].
    bounds: Vec<[f64; 3]>,
}

/// Returns the members of all contacts.
fn parts(problem: &SpaceProblem, side: Side) -> Vec<Part> {
    let of = |(contact, own): (usize, &SpaceContact)| {
        let (law, areas) = (&own.law, &side.of(own).areas);
        // Without friction y₀ is the normal force above the tensile strength.
        let (slope, tip) = if law.friction > 0.0 { (law.friction, law.cohesion) } else { (1.0, law.tension()) };
        let crushing = law.compressive_strength;
        let most = |area: f64| if crushing.is_finite() { (tip + slope * crushing) * area } else { f64::INFINITY };
        let least = |area: f64| {
            if law.has_one_tip() { 0.0 } else { ((tip - slope * law.tension()) * area).max(0.0) }
        };
        let bounds = areas.iter().map(|area| [tip * area, least(*area), most(*area)]).collect();
        let strengths = if law.friction > 0.0 { [law.friction.recip(), 1.0] } else { [1.0, 0.0] };
        let main = Part { contact, places: (0..areas.len()).collect(), strengths, bounds };
        let sheared: Vec<usize> = (0..areas.len()).filter(|k| law.cohesion * areas[*k] > 0.0).collect();
        let bounds = sheared.iter().map(|k| [0.0, 0.0, law.cohesion * areas[*k]]).collect();
        let shear = Part { contact, places: sheared, strengths: [0.0, 1.0], bounds };
        std::iter::once(main).chain((law.friction == 0.0 && law.cohesion > 0.0).then_some(shear))
    };
    problem.contacts.iter().enumerate().flat_map(of).collect()
}

/// Scales a member and appends its points.
fn member(
    contact: &SpaceContact,
    (part, set): (&Part, &PointSet),
    (poles, length): (&[Vec3], f64),
    points: &mut Vec<Vec3>,
) -> Member {
    let (centre, frame, first) = (centre(contact), contact.frame, points.len());
    points.extend(part.places.iter().map(|place| {
        let arm = (set.points[*place] - centre) / length;
        Vec3::new(frame[0].dot(&arm), frame[1].dot(&arm), frame[2].dot(&arm))
    }));
    let bodies = [contact.plus, contact.minus];
    let arms = bodies.map(|body| body.map_or(Vec3::zeros(), |body| (centre - poles[body]) / length));
    Member {
        contact: part.contact,
        places: part.places.clone(),
        bodies,
        frame,
        arms,
        points: first..points.len(),
        strengths: part.strengths,
    }
}
