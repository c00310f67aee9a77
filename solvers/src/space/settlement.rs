//! Rigid blocks in space on supports that move: the motion of least potential energy, and its dual field.
//!
//! ```text
//! motions   min −w·q      B q + g in the dual cones
//! fields    min Σ y·g     A y + w = 0,  y in the cones
//! ```
//!
//! g are the jumps that the supports alone cause, with the factors of the cones. Clarabel solves the program of the fields; the
//! dual solution is the motion. The forces are repaired like the forces of a collapse. If Σ y·g has no bound, the ray proves that no
//! motion is compatible with the supports. Source: as for plane scenes (`limit/settlement.rs`).

use super::by_clarabel::{LeastWork, least_work};
use super::cone::Cone;
use super::program::{Program, Side};
use voussoir_core::space::{SpaceField, SpaceProblem, SpaceSettled};

const NOT_EXACT: &str =
    "settlements of rigid blocks in space need joints whose strength is one cone: no crushing and no tension cut-off";
const NO_FIELD: &str = "the loads before the supports move have no admissible field";
const NO_MOTION: &str = "rigid blocks neither follow their supports nor is it proved that they cannot";

/// Finds how rigid blocks follow their supports with associated flow.
pub fn settle(problem: &SpaceProblem, openings: &SpaceField) -> SpaceSettled {
    settled(problem, openings).unwrap_or_else(|why| SpaceSettled::Refused(why.into()))
}

fn settled(problem: &SpaceProblem, openings: &SpaceField) -> Result<SpaceSettled, &'static str> {
    if !problem.is_exact() {
        return Err(NOT_EXACT);
    }
    let program = Program::new(problem, 0.0, Side::Inner);
    let unit = openings.iter().flatten().flatten().fold(0.0, |most: f64, gap| most.max(gap.abs()));
    if unit == 0.0 {
        return Err("no support moves against another body");
    }
    let mut driven: Vec<Cone> = Vec::with_capacity(program.points.len());
    for (member, gaps) in program.members.iter().zip(openings) {
        let [normal, shear] = member.strengths;
        driven.extend(gaps.iter().map(|[n, s, t]| [normal * n / unit, shear * s / unit, shear * t / unit]));
    }
    match least_work(&program, &driven) {
        Some(LeastWork::Field(y, q)) => {
            let motion = program.motion(&q).into_iter().map(|own| own.map(|v| v * unit)).collect();
            Ok(SpaceSettled::Follows { field: program.forces(&y), motion })
        }
        Some(LeastWork::Ray(y)) => Ok(SpaceSettled::Blocked(program.differences(&y))),
        Some(LeastWork::Nothing) => Err(NO_FIELD),
        None => Err(NO_MOTION),
    }
}
