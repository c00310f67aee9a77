//! Scenes and answers made by hand, for tests of figures and writers: an arch with exact statics
//! of a supposed four-hinge mechanism, a ring of many voussoirs, a wall with invented forces.

use std::sync::Arc;
use voussoir_core::certificate::{Certificate, Hinge, Mechanism, MechanismKind, Side, Sliding};
use voussoir_core::law::Plane;
use voussoir_core::limit::Status;
use voussoir_core::model::geometry::{Vec2, cross, turned};
use voussoir_core::model::*;
use voussoir_laws::coulomb::Coulomb;
use voussoir_laws::rigid::Rigid;
use voussoir_study::results::{CaseLabel, CaseResult, FieldEntry, MotionEntry, ProofFields, StageResult};
use voussoir_study::scenes::mesh::Mesh;

fn catalogue() -> Catalogue {
    let law = Coulomb {
        friction: Some(0.6),
        friction_angle: None,
        dilatancy_angle: 0.0,
        normal_stiffness: None,
        shear_stiffness: None,
    };
    Catalogue {
        materials: vec![("stone".into(), Arc::new(Rigid { density: 2200.0 }))],
        laws: vec![("dry".into(), Arc::new(law))],
    }
}

fn stage(name: &str, gravity: Option<Vec2>, forces: Vec<PointForce>, target: Target) -> Stage {
    Stage {
        name: name.into(),
        gravity,
        forces,
        accelerations: vec![],
        spreads: vec![],
        settlements: vec![],
        target,
        factor_min: 0.0,
        factor_max: 1e9,
        duration: 0.0,
        fields: Vec::new(),
    }
}

/// A segmental arch of the Strathmashie bridge's size (thickness 0.6 m) between shapeless supports.
pub fn arch(span: f64, rise: f64, voussoirs: usize) -> Assembly {
    let radius = (span * span / 4.0 + rise * rise) / (2.0 * rise);
    let half = (span / 2.0).atan2(radius - rise);
    let centre = Vec2::new(0.0, rise - radius);
    let ends = |k: usize| {
        let angle = -half + 2.0 * half * k as f64 / voussoirs as f64;
        let out = Vec2::new(angle.sin(), angle.cos());
        [centre + out * radius, centre + out * (radius + 0.6)]
    };
    let support = |name: &str| Body { name: name.into(), vertices: vec![], material: 0, fixed: true };
    let mut bodies = vec![support("left")];
    bodies.extend((0..voussoirs).map(|k| {
        let ([a, b], [c, d]) = (ends(k), ends(k + 1));
        Body { name: format!("v{k}"), vertices: vec![a, c, d, b], material: 0, fixed: false }
    }));
    bodies.push(support("right"));
    let joints = (0..=voussoirs)
        .map(|k| Joint { minus: k, plus: k + 1, ends: ends(k), bond: Bond::Law(0), gap: Gap::default() })
        .collect();
    let arch = Some(ArchLayout { first: 1, voussoirs, span, rise });
    Assembly {
        catalogue: catalogue(),
        bodies,
        joints,
        width: 5.81,
        plane: Plane::Strain,
        mesh: Mesh::default().into(),
        arch,
        bridge: None,
    }
}

/// Dead load, then 1 kN at the quarter of the span.
pub fn arch_stages(assembly: &Assembly) -> Vec<Stage> {
    let layout = assembly.arch.as_ref().expect("an arch");
    let x = -layout.span / 4.0;
    let body = (1..=layout.voussoirs).find(|&b| assembly.joints[b].ends[1].x >= x).expect("the load is on the arch");
    let (a, b) = (assembly.joints[body - 1].ends[1], assembly.joints[body].ends[1]);
    let point = a + (b - a) * ((x - a.x) / (b.x - a.x));
    let force = PointForce { body, point, force: Vec2::new(0.0, -1000.0) };
    vec![
        stage("dead", Some(Vec2::new(0.0, -9.81)), vec![], Target::Factor(1.0)),
        stage("live", None, vec![force], Target::Collapse),
    ]
}

/// An answer without anything in it.
pub fn blank(id: usize, status: Status) -> CaseResult {
    CaseResult {
        label: CaseLabel { id, ..CaseLabel::default() },
        status,
        solver: "limit_chain".into(),
        certificate: Certificate {
            passed: true,
            residuals: [
                ("equilibrium".to_string(), 3.1e-15),
                ("strength".to_string(), 0.0),
                ("gap_of_bounds".to_string(), 2e-14),
            ]
            .into(),
            failures: vec![],
        },
        seconds: 1.2e-3,
        stages: vec![StageResult {
            name: "live".into(),
            status,
            factor: None,
            hinges: vec![],
            stability: Default::default(),
        }],
        ..CaseResult::empty()
    }
}

/// The supposed hinges of [`arch_answer`].
struct FourHinges {
    joints: [usize; 4],
    sides: [Side; 4],
    points: [Vec2; 4],
    load: PointForce,
}

impl FourHinges {
    /// Hinges at joint 0, right of the load, at 3n/5 and at the last joint.
    fn new(assembly: &Assembly, stages: &[Stage]) -> Self {
        let n = assembly.arch.as_ref().expect("an arch").voussoirs;
        let load = stages[1].forces[0];
        let joints = [0, load.body, 3 * n / 5, n];
        let sides = [Side::Intrados, Side::Extrados, Side::Intrados, Side::Extrados];
        let point = |i: usize| assembly.joints[joints[i]].ends[usize::from(sides[i] == Side::Extrados)];
        FourHinges { joints, sides, points: [0, 1, 2, 3].map(point), load }
    }

    /// Force H on joint 0 and λ such that the line of thrust passes the hinges.
    fn thrust(&self, assembly: &Assembly) -> (Vec2, f64) {
        let [a, b, c, d] = self.points;
        let (mut matrix, mut right) = (nalgebra::Matrix3::zeros(), nalgebra::Vector3::zeros());
        for (row, (pole, joint)) in [(b, 1), (c, 2), (d, 3)].into_iter().enumerate() {
            let (arm, last) = (a - pole, self.joints[joint]);
            let live = if self.load.body <= last { cross(self.load.point - pole, self.load.force) } else { 0.0 };
            matrix.set_row(row, &nalgebra::RowVector3::new(-arm.y, arm.x, live));
            let weights = (1..=last).map(|k| cross(assembly.inertia(k).centroid - pole, weight(assembly, k)));
            right[row] = -weights.sum::<f64>();
        }
        let solution = matrix.lu().solve(&right).expect("four hinges make a mechanism");
        (Vec2::new(solution[0], solution[1]), solution[2])
    }

    /// Contact forces and thrust line from the force on joint 0 and λ.
    fn fields(&self, assembly: &Assembly, (mut force, factor): (Vec2, f64)) -> ProofFields {
        let mut moment = cross(self.points[0], force);
        let (mut field, mut line) = (Vec::new(), Vec::new());
        for (k, joint) in assembly.joints.iter().enumerate() {
            if k > 0 {
                let mut add = |f: Vec2, at: Vec2| {
                    force += f;
                    moment += cross(at, f);
                };
                add(weight(assembly, k), assembly.inertia(k).centroid);
                if self.load.body == k {
                    add(self.load.force * factor, self.load.point);
                }
            }
            let (n, t) = joint.frame();
            let share = (moment - cross(joint.ends[0], force)) / (cross(t, force) * joint.height());
            for (end, part) in joint.ends.iter().zip([1.0 - share, share]) {
                let force = [part * force.dot(&n), 0.5 * force.dot(&t)];
                field.push(FieldEntry { joint: k, point: [end.x, end.y], force });
            }
            let point = joint.ends[0] + t * (share * joint.height());
            line.push(Some([point.x, point.y]));
        }
        let (field, thrust_line) = (Some(field), Some(line));
        ProofFields { field_factor: Some(factor), field, thrust_line, ..ProofFields::default() }
    }

    /// Velocities and mechanism: the middle link turns about where AB and CD cross, velocities agree at B and C.
    fn motion(&self, assembly: &Assembly) -> (Vec<MotionEntry>, Mechanism) {
        let ([a, b, c, d], joints) = (self.points, self.joints);
        let (ab, cd) = (b - a, d - c);
        let centre = a + ab * (cross(c - a, cd) / cross(ab, cd));
        let ratio = |p: Vec2, from: Vec2, to: Vec2| (p - from).dot(&(p - to)) / (p - to).norm_squared();
        let spin = [1.0, ratio(b, a, centre), ratio(b, a, centre) / ratio(c, d, centre)];
        let link = |body: usize| usize::from(body > joints[1]) + usize::from(body > joints[2]);
        let centres = [a, centre, d];
        let velocity = |body: usize, p: Vec2| turned(p - centres[link(body)]) * spin[link(body)];
        let work = velocity(self.load.body, self.load.point).dot(&self.load.force);
        let names = |k: usize| [assembly.bodies[k].name.clone(), assembly.bodies[k + 1].name.clone()];
        let turns = [spin[0], spin[1] - spin[0], spin[2] - spin[1], -spin[2]];
        let hinges = (0..4).map(|i| Hinge {
            joint: joints[i],
            between: names(joints[i]),
            side: Some(self.sides[i]),
            point: self.points[i].into(),
            rotation: turns[i] / work,
        });
        let motion = (1..=joints[3]).map(|body| {
            let v = velocity(body, assembly.inertia(body).centroid) / work;
            MotionEntry { body: assembly.bodies[body].name.clone(), velocity: [v.x, v.y, spin[link(body)] / work] }
        });
        let mechanism = Mechanism {
            kind: MechanismKind::FourHinge,
            hinge_count: 4,
            unique: Some(true),
            hinges: hinges.collect(),
            sliding: vec![],
            crushing: vec![],
            contacts: vec![],
            at: None,
        };
        (motion.collect(), mechanism)
    }
}

fn weight(assembly: &Assembly, body: usize) -> Vec2 {
    Vec2::new(0.0, -9.81 * assembly.inertia(body).mass)
}

/// The four-hinge answer of [`arch`] for hinges at joint 0, right of the load, at 3n/5 and the last: statics and
/// kinematics are exact for these hinges, whether or not they are the right ones.
pub fn arch_answer(assembly: &Assembly, stages: &[Stage]) -> CaseResult {
    let hinges = FourHinges::new(assembly, stages);
    let thrust = hinges.thrust(assembly);
    let (motion, mechanism) = hinges.motion(assembly);
    CaseResult {
        load_factor: Some(thrust.1),
        bounds: Some([Some(thrust.1); 2]),
        mechanism: Some(mechanism),
        proof: ProofFields { motion: Some(motion), ..hinges.fields(assembly, thrust) },
        ..blank(0, Status::Collapse)
    }
}

/// An unbounded answer: a strut from springing to load to springing.
pub fn arch_unbounded(assembly: &Assembly, stages: &[Stage]) -> CaseResult {
    let load = stages[1].forces[0];
    let last = assembly.joints.len() - 1;
    let (left, right) = (assembly.joints[0].middle(), assembly.joints[last].middle());
    let ray = assembly.joints.iter().enumerate().map(|(k, joint)| {
        let line = if k < load.body { load.point - left } else { right - load.point };
        let from = if k < load.body { left } else { load.point };
        let (n, t) = joint.frame();
        let at = from + line * (cross(joint.ends[0] - from, t) / cross(line, t));
        let force = line / line.x.abs() * 1000.0;
        FieldEntry { joint: k, point: [at.x, at.y], force: [force.dot(&n), force.dot(&t)] }
    });
    let proof = ProofFields { ray: Some(ray.collect()), ..ProofFields::default() };
    CaseResult { proof, ..blank(1, Status::Unbounded) }
}

/// Length and height of a brick of [`wall`] \[m\].
const BRICK: [f64; 2] = [0.4, 0.2];

/// Bricks in running bond on a ground block, and the first brick of the top course.
fn bricks_and_joints(courses: usize, bricks: usize) -> (Vec<Body>, Vec<Joint>, usize) {
    let ([length, height], total) = (BRICK, BRICK[0] * bricks as f64);
    let shape = |x0: f64, x1: f64, y0: f64, y1: f64| {
        vec![Vec2::new(x0, y0), Vec2::new(x1, y0), Vec2::new(x1, y1), Vec2::new(x0, y1)]
    };
    let mut bodies =
        vec![Body { name: "ground".into(), vertices: shape(-0.4, total + 0.4, -0.2, 0.0), material: 0, fixed: true }];
    let mut rows: Vec<Vec<(usize, f64, f64)>> = vec![vec![(0, -0.4, total + 0.4)]];
    let mut joints = Vec::new();
    for course in 0..courses {
        let cuts: Vec<f64> = if course % 2 == 0 {
            (0..=bricks).map(|i| length * i as f64).collect()
        } else {
            std::iter::once(0.0).chain((0..bricks).map(|i| length * (i as f64 + 0.5))).chain([total]).collect()
        };
        let y = height * course as f64;
        let mut row = Vec::new();
        for pair in cuts.windows(2) {
            let body = bodies.len();
            bodies.push(Body {
                name: format!("b{body}"),
                vertices: shape(pair[0], pair[1], y, y + height),
                material: 0,
                fixed: false,
            });
            let bond = Bond::Law(0);
            for &(below, x0, x1) in &rows[course] {
                let (low, high) = (pair[0].max(x0), pair[1].min(x1));
                if high - low > 1e-9 {
                    joints.push(Joint {
                        minus: below,
                        plus: body,
                        ends: [Vec2::new(high, y), Vec2::new(low, y)],
                        bond,
                        gap: Gap::default(),
                    });
                }
            }
            if let Some(&(left, _, x)) = row.last() {
                joints.push(Joint {
                    minus: left,
                    plus: body,
                    ends: [Vec2::new(x, y), Vec2::new(x, y + height)],
                    bond,
                    gap: Gap::default(),
                });
            }
            row.push((body, pair[0], pair[1]));
        }
        rows.push(row);
    }
    let first = rows[courses][0].0;
    (bodies, joints, first)
}

/// A wall in running bond on a ground block, pushed at its top left corner.
pub fn wall(courses: usize, bricks: usize) -> (Assembly, Vec<Stage>, CaseResult) {
    let (height, top) = (BRICK[1], BRICK[1] * courses as f64);
    let (bodies, joints, body) = bricks_and_joints(courses, bricks);
    let force = PointForce { body, point: Vec2::new(0.0, top - height / 2.0), force: Vec2::new(1000.0, 0.0) };
    let stages = vec![
        stage("dead", Some(Vec2::new(0.0, -9.81)), vec![], Target::Factor(1.0)),
        stage("push", None, vec![force], Target::Collapse),
    ];
    let assembly = Assembly {
        catalogue: catalogue(),
        bodies,
        joints,
        width: 0.2,
        plane: Plane::Strain,
        mesh: Mesh::default().into(),
        arch: None,
        bridge: None,
    };
    let answer = wall_answer(&assembly, top, Vec2::new(BRICK[0] * bricks as f64, height * (courses / 2) as f64));
    (assembly, stages, answer)
}

/// Invented forces; the upper half turns about its lower right corner `pole`, its lowest left joint slides.
fn wall_answer(assembly: &Assembly, top: f64, pole: Vec2) -> CaseResult {
    let total = pole.x;
    let field = assembly.joints.iter().enumerate().flat_map(|(k, joint)| {
        let bed = joint.frame().0.y > 0.5;
        let depth = top - joint.middle().y;
        let share = if bed { 0.5 + 0.4 * (joint.middle().x / total - 0.5) } else { 0.5 };
        let normal = if bed { 400.0 * depth + 20.0 } else { 30.0 };
        [1.0 - share, share].into_iter().zip(joint.ends).map(move |(part, end)| FieldEntry {
            joint: k,
            point: [end.x, end.y],
            force: [part * normal, -0.1 * normal],
        })
    });
    let field: Vec<_> = field.collect();
    let moving = |body: usize| assembly.bodies[body].vertices.iter().all(|v| v.y >= pole.y - 1e-9);
    let motion = (1..assembly.bodies.len()).filter(|&body| moving(body)).map(|body| {
        let v = turned(assembly.inertia(body).centroid - pole) * -1e-3;
        MotionEntry { body: assembly.bodies[body].name.clone(), velocity: [v.x, v.y, -1e-3] }
    });
    let between = |joint: &Joint| [assembly.bodies[joint.minus].name.clone(), assembly.bodies[joint.plus].name.clone()];
    let corner = assembly.joints.iter().enumerate().find(|(_, j)| (j.ends[0] - pole).norm() < 1e-9 && moving(j.plus));
    let slide = assembly.joints.iter().enumerate().find(|(_, j)| !moving(j.minus) && moving(j.plus));
    let mechanism = Mechanism {
        kind: MechanismKind::Mixed,
        hinge_count: 1,
        unique: Some(false),
        hinges: corner
            .map(|(k, j)| Hinge { joint: k, between: between(j), side: None, point: [pole.x, pole.y], rotation: -1e-3 })
            .into_iter()
            .collect(),
        sliding: slide.map(|(k, j)| Sliding { joint: k, between: between(j), slip: -1e-3 }).into_iter().collect(),
        crushing: vec![],
        contacts: vec![],
        at: None,
    };
    CaseResult {
        load_factor: Some(1.234567890),
        bounds: Some([Some(1.2345678), Some(1.2345679)]),
        mechanism: Some(mechanism),
        proof: ProofFields { motion: Some(motion.collect()), field: Some(field), ..ProofFields::default() },
        notes: vec!["read as associated: \"a < b\" & so on".into()],
        ..blank(0, Status::Collapse)
    }
}
