//! The standard input for samples of scenes and loads: materials and joint laws by name, and a bridge on which loads are placed.

use super::scaled::{LENGTH, STRESS, scaled_table};
use serde_json::{Value as Json, json};
use std::sync::Arc;
use voussoir_core::law::{BulkMaterial, InterfaceLaw};
use voussoir_core::model::{Assembly, Catalogue, Scene};
use voussoir_core::plugin::{PluginKind, card};
use voussoir_study::loads::{Axle, LoadSite, LoadTables, VehicleAxles};

/// Density of the standard materials \[kg/m³\].
const DENSITY: f64 = 2200.0;

/// Returns the standard materials and joint laws: `stone` is rigid, `brick` is elastic, `dry` and `mortar` have friction.
///
/// # Panics
/// The program does not contain the laws of the project.
pub(super) fn catalogue() -> Catalogue {
    let material = |name: &str, table: Json| -> (String, Arc<dyn BulkMaterial>) {
        let material: Box<dyn BulkMaterial> =
            serde_json::from_value(table).expect("the program has the project's laws");
        (name.into(), Arc::from(material))
    };
    let law = |name: &str, friction: f64| -> (String, Arc<dyn InterfaceLaw>) {
        let table = json!({ "law": "coulomb", "friction": friction });
        let law: Box<dyn InterfaceLaw> = serde_json::from_value(table).expect("the program has the project's laws");
        (name.into(), Arc::from(law))
    };
    let elastic = json!({ "law": "elastic", "young_modulus": 5e9, "poisson_ratio": 0.2, "density": DENSITY });
    Catalogue {
        materials: vec![material("stone", json!({ "law": "rigid", "density": DENSITY })), material("brick", elastic)],
        laws: vec![law("dry", 0.6), law("mortar", 0.75)],
    }
}

/// Returns the catalogue in the opposite order.
pub(super) fn reversed_catalogue() -> Catalogue {
    let mut catalogue = catalogue();
    catalogue.materials.reverse();
    catalogue.laws.reverse();
    catalogue
}

/// A bridge with fill and a road, and the tables to which its loads can refer.
pub(super) struct Site {
    pub assembly: Assembly,
    tables: LoadTables,
}

impl Site {
    /// The standard bridge: one span of 6 m with 15 voussoirs, whose names are 0 to 14, and the vehicle `cart`.
    ///
    /// # Panics
    /// The program does not contain the scenes of the project.
    pub(super) fn standard() -> Self {
        Site::of(|table| table, [1.0, 1.0])
    }

    /// The same bridge and vehicle in other units.
    pub(super) fn in_other_units() -> Self {
        let keys = card(PluginKind::Scene, "bridge").map_or(&[][..], |card| card.parameters);
        Site::of(|table| scaled_table(&table, keys), [LENGTH, STRESS * LENGTH * LENGTH])
    }

    fn of(units: impl Fn(Json) -> Json, [length, force]: [f64; 2]) -> Self {
        let table = units(json!({
            "scene": "bridge",
            "width": 3.0,
            "material": "stone",
            "joint": "dry",
            "spans": [{ "profile": { "shape": "segmental", "span": 6.0, "rise": 1.5 }, "thickness": 0.4, "voussoirs": 15 }],
            "fill": {
                "cover": 0.3, "density": 2000.0, "friction_angle": 35.0, "cohesion": 0.0,
                "dispersion": { "law": "uniform", "angle": 26.6 },
                "resistance": { "law": "fill_pressure", "passive_factor": 0.33 },
            },
        }));
        let axle = |at: f64, share: f64| Axle {
            at: at * length,
            force: share * force,
            wheel_width: Some(2.0 * length),
            length: 0.3 * length,
            lift_off: 1.0,
        };
        let cart = VehicleAxles { axles: vec![axle(0.0, 60e3), axle(1.8, 90e3)] };
        let dispersion = json!({ "law": "uniform", "angle": 26.6 });
        let read = "the program has the project's scenes and laws";
        let scene: Box<dyn Scene> = serde_json::from_value(table).expect(read);
        Site {
            assembly: scene.build(&catalogue()).expect("a bridge"),
            tables: LoadTables {
                vehicles: [("cart".to_string(), cart)].into(),
                dispersion: Some(serde_json::from_value(dispersion).expect(read)),
            },
        }
    }

    /// The same bridge with its bodies in the opposite order.
    pub(super) fn renumbered(mut self) -> Self {
        let count = self.assembly.bodies.len();
        let other = |body: &mut usize| *body = count - 1 - *body;
        self.assembly.bodies.reverse();
        for joint in &mut self.assembly.joints {
            other(&mut joint.minus);
            other(&mut joint.plus);
        }
        if let Some(bridge) = &mut self.assembly.bridge {
            bridge.extrados.iter_mut().for_each(|chord| other(&mut chord.body));
            bridge.masses.iter_mut().for_each(|mass| other(&mut mass.body));
            bridge.reactions.iter_mut().for_each(|reaction| other(&mut reaction.body));
        }
        self
    }

    /// Returns the place at which loads are put on the bridge.
    pub(super) fn place(&self) -> LoadSite<'_> {
        LoadSite::new(&self.assembly, &self.tables, "load")
    }
}
