//! A scene in space of a case: its blocks with their contacts, and the loads of its stages.

use super::diagnostics::DiagnosticList;
use super::stages::support;
use super::tables::{Gravity, Rotation, SettlementTable, StageTable};
use crate::config::common_keys::{Kinematics, SolverKeys, own_keys, tag_of};
use crate::loads::{Components, LoadKind, SpacePlaced, SpaceSite};
use serde::Deserialize;
use serde_json::Value as Json;
use std::sync::Arc;
use voussoir_core::law::{FrictionCone, InterfaceLaw};
use voussoir_core::model::{Stage, Target};
use voussoir_core::plugin::{Capability, Card, PluginKind, candidate, cards_of};
use voussoir_core::space::{SpaceAssembly, SpaceLoads, SpaceSettlement, SpaceStage, Vec3, space_loads};

/// Blocks in space with the loads of each stage. The stages of the case have the names and targets.
#[derive(Debug, Clone, Default)]
pub struct SpaceCase {
    /// Blocks and contacts.
    pub assembly: SpaceAssembly,
    /// Loads, stage by stage.
    pub stages: Vec<SpaceStage>,
    /// Parts of each side of a contact whose strength is more than a cone.
    pub parts: usize,
}

impl SpaceCase {
    /// Returns the wrenches of each stage of the case.
    pub fn loads(&self, stages: &[Stage]) -> Vec<SpaceLoads> {
        space_loads(&self.assembly, &self.stages(stages))
    }

    /// Returns the stages of the case with those in space.
    pub fn stages<'a>(&'a self, stages: &'a [Stage]) -> Vec<(&'a Stage, &'a SpaceStage)> {
        stages.iter().zip(&self.stages).collect()
    }

    /// Returns true if a support has moved by the end of a stage.
    pub fn settles(&self, index: usize) -> bool {
        let all = self.stages[..=index].iter().flat_map(|stage| &stage.settlements);
        all.into_iter().any(|own| own.displacement.norm() + own.rotation.norm() > 0.0)
    }

    /// Returns the friction cone of each law of the catalogue. An error names the first law of a contact without one that
    /// limit analysis supports.
    pub fn cones(&self) -> Result<Vec<FrictionCone>, String> {
        let laws = self.assembly.catalogue.laws.iter().enumerate();
        let cone = |(index, (name, law)): (usize, &(String, Arc<dyn InterfaceLaw>))| {
            let used = self.assembly.contacts.iter().any(|contact| contact.law == index);
            match law.cone() {
                Some(cone) => Ok(cone),
                None if used => Err(format!(
                    "joint law \"{name}\" has no friction cone: it never slides, or its friction depends on the direction; limit \
                     analysis in space needs a cone. For a joint that hardly slides, give a large coefficient of friction"
                )),
                None => Ok(FrictionCone::dry(0.0, 0.0)),
            }
        };
        laws.map(cone).collect()
    }

    /// Returns true if the flow of some contact is not associated.
    pub fn non_associated(&self) -> bool {
        let flows = |law: usize| self.assembly.catalogue.laws[law].1.cone().is_some_and(|cone| !cone.is_associated());
        self.assembly.contacts.iter().any(|contact| flows(contact.law))
    }
}

/// Parts of each side of a contact if the study does not give them: bounds of joints that crush are then some percent apart.
const PARTS: usize = 4;

/// Returns the parts of each side of a contact, from the table `[solver]`.
pub(super) fn subdivisions(solver: Option<&Json>) -> usize {
    solver.and_then(own_keys::<SolverKeys>).and_then(|keys| keys.subdivisions).unwrap_or(PARTS)
}

/// Returns a note if the key `subdivisions` is given and has no effect.
pub(super) fn unused_subdivisions(solver: Option<&Json>, space: Option<&SpaceCase>) -> Option<String> {
    solver?.get("subdivisions")?;
    let one_tip = |space: &SpaceCase| space.cones().is_ok_and(|cones| cones.iter().all(FrictionCone::has_one_tip));
    space.is_none_or(one_tip).then(|| {
        "solver.subdivisions has no effect: it divides contacts in space with tension cut-off or crushing".to_string()
    })
}

/// Returns the loads of all stages of a scene in space.
pub(super) fn space_stages(
    diagnostics: &mut DiagnosticList<'_>,
    written: &[StageTable],
    stages: &[Stage],
    assembly: &SpaceAssembly,
) -> Vec<SpaceStage> {
    let mut out = Vec::new();
    for (index, (table, stage)) in written.iter().zip(stages).enumerate() {
        let at = format!("stages.{index}");
        let gravity = table.gravity.and_then(|gravity| gravity_in_space(diagnostics, gravity, &at));
        let before = diagnostics.found.len();
        let SpacePlaced { forces, accelerations } = placed(diagnostics, &table.loads, assembly, &at);
        let settlements = settlements(diagnostics, &table.settlement, assembly, &at);
        let idle = forces.iter().all(|force| force.force == Vec3::zeros())
            && accelerations.iter().all(|acceleration| *acceleration == Vec3::zeros());
        if idle && stage.target == Target::Collapse && diagnostics.found.len() == before {
            let message = "\"collapse\" needs a load to raise, but this stage has none";
            let help = "give this stage a load that is not zero; gravity is not multiplied by the factor";
            diagnostics.wrong(&format!("{at}.until"), message, help);
        }
        out.push(SpaceStage { gravity, forces, accelerations, settlements });
    }
    out
}

/// Returns the movements of supports in a stage. A support turns about the mean of the points of its contacts.
fn settlements(
    diagnostics: &mut DiagnosticList<'_>,
    list: &[SettlementTable],
    assembly: &SpaceAssembly,
    at: &str,
) -> Vec<SpaceSettlement> {
    let mut out = Vec::new();
    let bodies: Vec<(&str, bool)> = assembly.bodies.iter().map(|b| (b.name.as_str(), b.fixed)).collect();
    for (number, entry) in list.iter().enumerate() {
        let at = format!("{at}.settlement.{number}");
        let Some(body) = support(diagnostics, &entry.support, &bodies, &at) else { continue };
        // The defaults of both keys are zero, in the form of a plane scene.
        let still = entry.displacement.plane().is_some_and(|own| own.norm() == 0.0);
        let displacement = entry.displacement.space().or_else(|| still.then(Vec3::zeros));
        let rotation = match entry.rotation {
            Rotation::Space(rotation) => Some(rotation.into()),
            Rotation::Plane(angle) => (angle == 0.0).then(Vec3::zeros),
        };
        let (Some(displacement), Some(rotation)) = (displacement, rotation) else {
            let help = "write displacement = [x, y, z] with z upwards, and rotation = [x, y, z]";
            diagnostics.wrong(&at, "has components in the plane, but the scene is in space", help);
            continue;
        };
        let touches = assembly.contacts.iter().filter(|contact| contact.minus == body || contact.plus == body);
        let points: Vec<Vec3> = touches.flat_map(|contact| contact.points.iter().copied()).collect();
        let about = points.iter().sum::<Vec3>() / points.len().max(1) as f64;
        out.push(SpaceSettlement { body, displacement, rotation, about });
    }
    out
}

fn gravity_in_space(diagnostics: &mut DiagnosticList<'_>, gravity: Gravity, at: &str) -> Option<Vec3> {
    match gravity {
        Gravity::Down(down) => Some(Vec3::new(0.0, 0.0, -down)),
        Gravity::Space(vector) => Some(Vec3::from(vector)),
        Gravity::Vector(_) => {
            let message = "has two components, but the scene is in space";
            diagnostics.wrong(&format!("{at}.gravity"), message, "write [gx, gy, gz] with z upwards, or one number");
            None
        }
    }
}

/// Returns the forces and accelerations of the loads of a stage.
fn placed(diagnostics: &mut DiagnosticList<'_>, loads: &[Json], assembly: &SpaceAssembly, at: &str) -> SpacePlaced {
    let mut all = SpacePlaced::default();
    for (number, table) in loads.iter().enumerate() {
        let path = format!("{at}.loads.{number}");
        // Loads that cannot be read have already been reported.
        let Ok(load) = <Box<dyn LoadKind>>::deserialize(table) else { continue };
        match load.place_space(&SpaceSite::new(assembly, &path)) {
            Some(Ok(placed)) => {
                all.forces.extend(placed.forces);
                all.accelerations.extend(placed.accelerations);
            }
            Some(Err(wrong)) => diagnostics.extend(wrong),
            None => {
                let message = format!("the load \"{}\" exists in plane scenes only", load.typetag_name());
                diagnostics.wrong(&path, message, "in space use \"body\", \"point\" or \"pressure\"");
            }
        }
    }
    all
}

/// Reports settings of `[solver]` and laws that limit analysis in space cannot use.
pub(super) fn check_space_solver(diagnostics: &mut DiagnosticList<'_>, solver: &Json, space: &SpaceCase) {
    let tag = tag_of(PluginKind::LimitSolver, solver);
    let able = || {
        let cards = cards_of(PluginKind::LimitSolver).into_iter();
        let tags: Vec<&str> = cards.filter(|card| card.offers(Capability::SPACE)).map(|card| card.tag).collect();
        format!("solvers in space: {}", tags.join(", "))
    };
    let offers = |card: &Card| card.offers(Capability::SPACE);
    if candidate(PluginKind::LimitSolver, tag).is_some_and(|card| !offers(card)) {
        diagnostics.wrong("solver.solver", format!("solver \"{tag}\" knows plane scenes only"), able());
    }
    let finite = own_keys::<SolverKeys>(solver).is_some_and(|keys| keys.kinematics == Kinematics::Finite);
    if finite {
        let message = "no solver follows finite displacements in space";
        diagnostics.wrong("solver.kinematics", message, "set kinematics = \"small\"");
    }
    if let Err(why) = space.cones() {
        let help =
            "laws that have it: coulomb, coulomb_associated, mohr_coulomb, and unilateral with tangential = \"free\"";
        diagnostics.wrong("joints", why, help);
    }
}
