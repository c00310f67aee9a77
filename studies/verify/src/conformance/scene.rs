//! Scenes: they build the same blocks each time, independently of units and of the order of materials and laws.

use super::assembly;
use super::findings::Recorder;
use super::options::Options;
use super::plug_in::PlugIn;
use super::samples::samples_of;
use super::scaled::LENGTH;
use super::scene_space;
use super::site::{catalogue, reversed_catalogue};
use super::units::other_units;
use voussoir_core::model::geometry::Vec2;
use voussoir_core::model::{Assembly, Bond, Catalogue, Gap, Scene};
use voussoir_core::plugin::{Card, PluginKind};
use voussoir_core::space::SpaceAssembly;

/// Greatest difference of coordinates, as a share of the size of the scene.
const SAME: f64 = 1e-9;

/// Checks every sample of a scene; does nothing for other plug-ins.
pub(super) fn check(recorder: &mut Recorder, card: &Card, _: &Options) {
    if card.kind != PluginKind::Scene {
        return;
    }
    for (sample, table, plug_in) in samples_of(card) {
        recorder.sample(&sample);
        let PlugIn::Scene(scene) = plug_in else { continue };
        let Some(here) = built(recorder, "samples", scene.as_ref(), &catalogue()) else { continue };
        here.check(recorder);
        if let Some(there) = built(recorder, "numbering", scene.as_ref(), &reversed_catalogue()) {
            recorder.hold("numbering", here.described() == there.described(), || {
                "with materials and laws in another order it is another scene".into()
            });
        }
        if let Some(PlugIn::Scene(other)) = other_units(recorder, card, &table)
            && let Some(there) = built(recorder, "units", other.as_ref(), &catalogue())
        {
            let (here, there) = (here.lengths(), there.lengths());
            let size = here.iter().fold(0.0, |a: f64, x| a.max(x.abs()));
            let near = |(a, b): (&f64, &f64)| (a - b / LENGTH).abs() <= SAME * size;
            recorder.hold("units", here.len() == there.len() && here.iter().zip(&there).all(near), || {
                format!("with lengths × {LENGTH} it is not {LENGTH} times as large: a key has a wrong unit, or the code contains a length")
            });
        }
    }
}

/// The blocks of a scene.
enum Built {
    Plane(Box<Assembly>),
    Space(SpaceAssembly),
}

impl Built {
    fn check(&self, recorder: &mut Recorder) {
        match self {
            Built::Plane(assembly) => assembly::check(recorder, assembly),
            Built::Space(assembly) => scene_space::check(recorder, assembly),
        }
    }

    fn described(&self) -> Vec<String> {
        match self {
            Built::Plane(assembly) => described(assembly),
            Built::Space(assembly) => scene_space::described(assembly),
        }
    }

    fn lengths(&self) -> Vec<f64> {
        match self {
            Built::Plane(assembly) => lengths(assembly),
            Built::Space(assembly) => scene_space::lengths(assembly),
        }
    }
}

/// Builds a scene; a refusal is a finding of a check.
fn built(recorder: &mut Recorder, check: &'static str, scene: &dyn Scene, catalogue: &Catalogue) -> Option<Built> {
    let built = match scene.build_space(catalogue) {
        Some(space) => space.map(Built::Space),
        None => scene.build(catalogue).map(|assembly| Built::Plane(Box::new(assembly))),
    };
    let refused = built.as_ref().err().and_then(|wrong| wrong.first()).map(ToString::to_string);
    recorder.hold(check, built.is_ok(), || format!("is refused: {}", refused.unwrap_or_default()));
    built.ok()
}

/// Returns all data of blocks and joints in words, with materials and laws by name.
fn described(assembly: &Assembly) -> Vec<String> {
    let Catalogue { materials, laws } = &assembly.catalogue;
    let bodies = assembly.bodies.iter().map(|body| {
        let material = materials.get(body.material).map(|(name, _)| name);
        format!("{} {:?} {material:?} {}", body.name, body.vertices, body.fixed)
    });
    let joints = assembly.joints.iter().map(|joint| {
        let law = match joint.bond {
            Bond::Bonded => None,
            Bond::Law(law) => laws.get(law).map(|(name, _)| name),
        };
        format!("{} {} {:?} {law:?} {:?}", joint.minus, joint.plus, joint.ends, joint.gap)
    });
    let rest = format!("{} {:?} {:?} {:?}", assembly.width, assembly.plane, assembly.arch, assembly.bridge);
    bodies.chain(joints).chain([rest]).collect()
}

/// Returns all lengths of an assembly, in a fixed order \[m\].
fn lengths(assembly: &Assembly) -> Vec<f64> {
    let mut all = vec![assembly.width];
    let mut points = |points: &[Vec2]| all.extend(points.iter().flat_map(|point| [point.x, point.y]));
    assembly.bodies.iter().for_each(|body| points(&body.vertices));
    assembly.joints.iter().for_each(|joint| points(&joint.ends));
    if let Some(bridge) = &assembly.bridge {
        points(&bridge.road);
        bridge.extrados.iter().for_each(|chord| points(&chord.ends));
        all.extend(bridge.springings.iter().chain([&bridge.longest_span]));
        // The uppermost layer has no upper end.
        all.extend(bridge.layers.iter().map(|layer| layer.0).filter(|level| level.is_finite()));
    }
    for joint in &assembly.joints {
        match &joint.gap {
            Gap::Uniform(gap) => all.push(*gap),
            Gap::Table(rows) => all.extend(rows.iter().flatten()),
        }
    }
    all.extend(assembly.arch.iter().flat_map(|arch| [arch.span, arch.rise]));
    all
}
