//! From one expanded case of a study file to bodies, joints and stages.

use super::Case;
use super::keys::STUDY;
use super::solver::{choose_solver, unused_by_limit_analysis};
use crate::config::check::{Checker, gravity_of};
use crate::config::document::Node;
use crate::config::expand::Expanded;
use crate::config::overlay::join;
use crate::config::report::{Mistake, suggest};
use crate::loads::{Load, place};
use serde_json::{Map, Value as Json};
use std::sync::Arc;
use voussoir_core::law::{BulkMaterial, InterfaceLaw};
use voussoir_core::model::geometry::Vec2;
use voussoir_core::model::{Assembly, Catalogue, Joint, Scene, Settlement, Stage, Target};
use voussoir_core::plugin::{Diagnostic, PluginKind, card, cards_of};

/// The mistakes of one case, gathered while it is built.
pub(super) struct Builder<'a> {
    root: &'a Node,
    mistakes: Vec<Mistake>,
}

impl Builder<'_> {
    pub(super) fn wrong(&mut self, key: &str, message: impl Into<String>, help: impl Into<String>) {
        self.mistakes.push(Mistake::new(&self.root.place(key), key, message).help(help));
    }

    fn diagnostics(&mut self, diagnostics: Vec<Diagnostic>) {
        for diagnostic in diagnostics {
            let mut mistake = Mistake::new(&self.root.place(&diagnostic.path), diagnostic.path, diagnostic.message);
            mistake.help = diagnostic.help;
            self.mistakes.push(mistake);
        }
    }

    fn plugins<T: serde::de::DeserializeOwned>(&mut self, name: &str, tables: &Json) -> Option<Vec<(String, T)>> {
        let mut out = Vec::new();
        for (entry, table) in tables.as_object()? {
            match serde_json::from_value(table.clone()) {
                Ok(plugin) => out.push((entry.clone(), plugin)),
                Err(error) => self.wrong(&join(name, entry), format!("cannot be read: {error}"), "correct this table"),
            }
        }
        Some(out)
    }
}

/// Checks and builds one case.
pub(super) fn build_case(id: usize, expanded: Expanded) -> Result<Case, Vec<Mistake>> {
    let Expanded { variant, scene, parameters, root } = expanded;
    let mut checker = Checker::new(&root);
    checker.gravity = gravity_of(&root);
    let Some(table) = root.table() else {
        return Err(vec![Mistake::new(&root.origin, "", "must be a table")]);
    };
    let names: Vec<_> = STUDY.iter().map(|parameter| parameter.name).collect();
    // A key that is written wrongly is not missing as well.
    let mut misspelt = Vec::new();
    for entry in table.entries.iter().filter(|entry| !names.contains(&entry.key.as_str())) {
        misspelt.extend(voussoir_core::plugin::nearest(&entry.key, names.iter().copied()));
        let help = suggest(&entry.key, &names, "keys here");
        checker.mistakes.push(Mistake::new(&entry.origin, &entry.key, "is not a key of a study").help(help));
    }
    let mut resolved = Map::new();
    let apart = ["sweep", "variants", "compare", "map"];
    for parameter in STUDY.iter().filter(|p| !apart.contains(&p.name)) {
        if table.get(parameter.name).is_none() && misspelt.contains(&parameter.name) {
            continue;
        }
        if let Ok(Some(value)) = checker.parameter(&root, table, parameter, "") {
            resolved.insert(parameter.name.into(), value);
        }
    }
    let Checker { mistakes, unused, .. } = checker;
    let mut builder = Builder { root: &root, mistakes };
    let mut notes: Vec<String> =
        unused.into_iter().map(|unused| format!("{} is not used by {}", unused.key, unused.by)).collect();

    check_kind_and_output(&mut builder, &resolved);
    let catalogue = catalogue(&mut builder, &resolved);
    let assembly = catalogue.and_then(|catalogue| assembly(&mut builder, &resolved, &catalogue));
    let stages = resolved.get("stages").and_then(|stages| build_stages(&mut builder, stages, assembly.as_ref()));
    let solver =
        resolved.get("solver").and_then(|solver| choose_solver(&mut builder, solver, &resolved, assembly.as_ref()));
    let limit = solver.as_ref().is_some_and(|solver| card(PluginKind::LimitSolver, &solver.tag).is_some());
    let rigid = assembly.as_ref().is_some_and(|assembly| !assembly.deforms());
    if limit || rigid {
        notes.extend(unused_by_limit_analysis(&resolved));
    }
    match (assembly, stages, solver) {
        (Some(assembly), Some(stages), Some(solver)) if builder.mistakes.is_empty() => {
            let output_curve = resolved.get("output").is_some_and(|output| output["curve"] == true);
            Ok(Case {
                id,
                variant,
                scene,
                parameters,
                assembly,
                stages,
                solver,
                output_curve,
                notes,
                resolved: Json::Object(resolved),
            })
        }
        _ => Err(builder.mistakes),
    }
}

fn check_kind_and_output(builder: &mut Builder<'_>, resolved: &Map<String, Json>) {
    if let Some(kind) = resolved.get("kind").and_then(Json::as_str) {
        let mut kinds: Vec<_> = cards_of(PluginKind::StudyKind).iter().map(|card| card.tag).collect();
        if !kinds.contains(&"run") {
            kinds.insert(0, "run");
        }
        if !kinds.contains(&kind) {
            let help = suggest(kind, &kinds, "kinds available");
            builder.wrong("kind", format!("there is no study kind \"{kind}\""), help);
        }
    }
}

fn catalogue(builder: &mut Builder<'_>, resolved: &Map<String, Json>) -> Option<Catalogue> {
    let materials = resolved.get("materials").and_then(|t| builder.plugins::<Box<dyn BulkMaterial>>("materials", t));
    let laws = resolved.get("joints").and_then(|t| builder.plugins::<Box<dyn InterfaceLaw>>("joints", t));
    let (materials, laws) = (materials?, laws?);
    Some(Catalogue {
        materials: materials.into_iter().map(|(name, material)| (name, Arc::from(material))).collect(),
        laws: laws.into_iter().map(|(name, law)| (name, Arc::from(law))).collect(),
    })
}

fn assembly(builder: &mut Builder<'_>, resolved: &Map<String, Json>, catalogue: &Catalogue) -> Option<Assembly> {
    let scene: Box<dyn Scene> = match serde_json::from_value(resolved.get("scene")?.clone()) {
        Ok(scene) => scene,
        Err(error) => {
            builder.wrong("scene", format!("cannot be read: {error}"), "correct this table");
            return None;
        }
    };
    scene.build(catalogue).map_err(|diagnostics| builder.diagnostics(diagnostics)).ok()
}

fn build_stages(builder: &mut Builder<'_>, stages: &Json, assembly: Option<&Assembly>) -> Option<Vec<Stage>> {
    let stages = stages.as_array()?;
    let before = builder.mistakes.len();
    let mut out: Vec<Stage> = Vec::new();
    for (index, stage) in stages.iter().enumerate() {
        let at = format!("stages.{index}");
        let name = stage["name"].as_str().unwrap_or_default().to_string();
        if stages[..index].iter().any(|earlier| earlier["name"] == stage["name"]) {
            builder.wrong(
                &join(&at, "name"),
                format!("two stages are called \"{name}\""),
                "give each stage a name of its own",
            );
        }
        let collapse = stage["until"] == "collapse";
        if collapse && stage.get("factor").is_some() {
            let help = "keep until to raise the loads to collapse, or factor to stop at that factor";
            builder.wrong(&join(&at, "factor"), "is given besides until = \"collapse\"", help);
        }
        if collapse && index + 1 < stages.len() {
            let help = "make it the last stage, or give this stage a factor";
            builder.wrong(
                &join(&at, "until"),
                "\"collapse\" is only possible in the last stage: nothing can be loaded after it",
                help,
            );
        }
        let factor = |key: &str| stage.get(key).and_then(Json::as_f64);
        let (least, greatest) = (factor("factor_min").unwrap_or(0.0), factor("factor_max").unwrap_or(f64::INFINITY));
        if least > greatest {
            let named = if factor("factor_max").is_some() { "factor_max" } else { "factor_min" };
            let message = format!("the search would go from factor_min = {least} to factor_max = {greatest}");
            builder.wrong(&join(&at, named), message, "factor_min must be at most factor_max");
        }
        let settlements = match assembly {
            Some(assembly) => build_settlements(builder, &stage["settlement"], assembly, &at),
            None => Vec::new(),
        };
        let (mut forces, mut accelerations) = (Vec::new(), Vec::new());
        for (number, load) in stage["loads"].as_array().into_iter().flatten().enumerate() {
            let path = format!("{at}.loads.{number}");
            let load: Load = match serde_json::from_value(load.clone()) {
                Ok(load) => load,
                Err(error) => {
                    builder.wrong(&path, format!("cannot be read: {error}"), "correct this load");
                    continue;
                }
            };
            let Some(assembly) = assembly else { continue };
            match place(&load, assembly, &path) {
                Ok((placed, accelerated)) => {
                    let (groups, _) = assembly.rigid_groups();
                    let held = placed.iter().find(|f| groups[f.body].is_none() && assembly.is_rigid(f.body));
                    if let Some(force) = held {
                        let name = &assembly.bodies[force.body].name;
                        let message = format!(
                            "the load acts on \"{name}\", which is rigid and held by the ground, so it has no effect"
                        );
                        let help = "move the load to a block that can move, or join the ends: ends = \"jointed\"";
                        builder.wrong(&path, message, help);
                    }
                    forces.extend(placed);
                    accelerations.extend(accelerated);
                }
                Err(diagnostics) => builder.diagnostics(diagnostics),
            }
        }
        if collapse
            && assembly.is_some()
            && builder.mistakes.len() == before
            && forces.iter().all(|force| force.force.norm() == 0.0)
            && accelerations.iter().all(|acceleration| acceleration.norm() == 0.0)
            && settlements.is_empty()
        {
            let help = "give this stage a load that is not zero; gravity is not multiplied by the factor";
            builder.wrong(&join(&at, "until"), "\"collapse\" needs a load to raise, but this stage has none", help);
        }
        let gravity = match &stage["gravity"] {
            Json::Array(vector) => {
                Some(Vec2::new(vector[0].as_f64().unwrap_or(0.0), vector[1].as_f64().unwrap_or(0.0)))
            }
            number => number.as_f64().map(|down| Vec2::new(0.0, -down)),
        };
        let target = if collapse { Target::Collapse } else { Target::Factor(factor("factor").unwrap_or(1.0)) };
        out.push(Stage {
            name,
            gravity,
            forces,
            accelerations,
            settlements,
            target,
            factor_min: least,
            factor_max: greatest,
        });
    }
    Some(out)
}

/// The movements of supports of a stage.
fn build_settlements(builder: &mut Builder<'_>, list: &Json, assembly: &Assembly, at: &str) -> Vec<Settlement> {
    let mut out = Vec::new();
    for (number, entry) in list.as_array().into_iter().flatten().enumerate() {
        let support = entry["support"].as_str().unwrap_or_default();
        let fixed: Vec<&str> = assembly.bodies.iter().filter(|b| b.fixed).map(|b| b.name.as_str()).collect();
        let Some(body) = assembly.body(support).filter(|body| assembly.bodies[*body].fixed) else {
            let path = format!("{at}.settlement.{number}.support");
            let help = suggest(support, &fixed, "supports here");
            builder.wrong(&path, format!("there is no support \"{support}\""), help);
            continue;
        };
        let joint = assembly.joints.iter().find(|joint| joint.minus == body || joint.plus == body);
        let number = |key: &str, i: usize| entry[key][i].as_f64().unwrap_or(0.0);
        out.push(Settlement {
            body,
            displacement: Vec2::new(number("displacement", 0), number("displacement", 1)),
            rotation: entry["rotation"].as_f64().unwrap_or(0.0),
            about: joint.map_or(Vec2::zeros(), Joint::middle),
        });
    }
    out
}
