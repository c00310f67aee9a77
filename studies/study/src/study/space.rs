//! A scene in space of a case: its blocks with their contacts, and the loads of its stages.

use super::diagnostics::DiagnosticList;
use super::tables::{Gravity, StageTable};
use crate::config::common_keys::{Kinematics, SolverKeys, own_keys, tag_of};
use crate::loads::{LoadKind, SpacePlaced, SpaceSite};
use serde::Deserialize;
use serde_json::Value as Json;
use std::sync::Arc;
use voussoir_core::law::{FrictionCone, InterfaceLaw};
use voussoir_core::model::{Stage, Target};
use voussoir_core::plugin::{Capability, Card, PluginKind, candidate, cards_of};
use voussoir_core::space::{SpaceAssembly, SpaceLoads, SpaceStage, Vec3, space_loads};

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
        let stages: Vec<_> = stages.iter().zip(&self.stages).collect();
        space_loads(&self.assembly, &stages)
    }

    /// Returns the friction cone of each law of the catalogue. An error names the first law of a contact without one that
    /// limit analysis supports.
    pub fn cones(&self) -> Result<Vec<FrictionCone>, String> {
        let laws = self.assembly.catalogue.laws.iter().enumerate();
        let cone = |(index, (name, law)): (usize, &(String, Arc<dyn InterfaceLaw>))| {
            let used = self.assembly.contacts.iter().any(|contact| contact.law == index);
            // Without friction cohesion leaves no cone.
            match law.cone().filter(|cone| cone.friction > 0.0 || cone.cohesion == 0.0) {
                Some(cone) => Ok(cone),
                None if used => Err(format!(
                    "joint law \"{name}\" is not isotropic friction, or has cohesion without friction; limit analysis in space needs a cone"
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
        if !table.settlement.is_empty() {
            let message = "limit analysis in space does not move supports";
            diagnostics.wrong(&format!("{at}.settlement"), message, "remove this list, or use a plane scene");
        }
        let idle = forces.iter().all(|force| force.force == Vec3::zeros())
            && accelerations.iter().all(|acceleration| *acceleration == Vec3::zeros());
        if idle && stage.target == Target::Collapse && diagnostics.found.len() == before {
            let message = "\"collapse\" needs a load to raise, but this stage has none";
            let help = "give this stage a load that is not zero; gravity is not multiplied by the factor";
            diagnostics.wrong(&format!("{at}.until"), message, help);
        }
        out.push(SpaceStage { gravity, forces, accelerations });
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
        let help = "laws that have it: coulomb, coulomb_associated, mohr_coulomb with friction";
        diagnostics.wrong("joints", why, help);
    }
}
