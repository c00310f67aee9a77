//! Vehicles of published rules: a study may name them without giving their axles.

use super::document::{Entry, Node, Table, Value, parse};

/// The vehicles, with their sources.
const LIBRARY: &str = include_str!("../loads/documented_vehicles.toml");

/// Returns the table of the library; empty if it cannot be read, which a test rules out.
fn library() -> Table {
    match parse(LIBRARY, "documented_vehicles.toml").map(|library| library.value) {
        Ok(Value::Table(library)) => library,
        _ => Table::default(),
    }
}

/// Returns the names of all documented vehicles.
pub fn names() -> Vec<String> {
    library().entries.into_iter().map(|entry| entry.key).collect()
}

/// Returns the lines of the library about a vehicle.
pub fn lines_of(name: &str) -> Option<String> {
    let heading = format!("[{name}]");
    let mut lines = LIBRARY.lines().skip_while(|line| *line != heading);
    let first = lines.next()?;
    let own = lines.take_while(|line| !line.starts_with(['[', '#']));
    Some(std::iter::once(first).chain(own).map(|line| format!("{line}\n")).collect())
}

/// Adds the documented vehicles that the study names but does not define to `[vehicles]`, so that its resolved file contains
/// every axle.
pub fn add(root: &mut Node) {
    let mut named = Vec::new();
    texts(root, &mut named);
    let entries: Vec<Entry> = library().entries.into_iter().filter(|entry| named.contains(&entry.key)).collect();
    let Value::Table(study) = &mut root.value else { return };
    if entries.is_empty() {
        return;
    }
    if study.get("vehicles").is_none() {
        let (origin, value) = (root.origin.clone(), Value::Table(Table::default()));
        let node = Node { value, origin: origin.clone() };
        study.entries.push(Entry { key: "vehicles".into(), origin, node });
    }
    let Some(Node { value: Value::Table(vehicles), .. }) = study.get_mut("vehicles") else { return };
    for entry in entries {
        if vehicles.get(&entry.key).is_none() {
            vehicles.entries.push(entry);
        }
    }
}

/// Collects all texts of a document.
fn texts(node: &Node, out: &mut Vec<String>) {
    match &node.value {
        Value::String(text) => out.push(text.clone()),
        Value::Array(nodes) => nodes.iter().for_each(|node| texts(node, out)),
        Value::Table(table) => table.entries.iter().for_each(|entry| texts(&entry.node, out)),
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::loads::VehicleAxles;

    fn all() -> Vec<(String, VehicleAxles)> {
        let table: toml::Table = toml::from_str(LIBRARY).unwrap();
        table.into_iter().map(|(name, vehicle)| (name, vehicle.try_into().unwrap())).collect()
    }

    /// EN 15528: the mass of a wagon is its mass per metre times its length, p = 5.0, 6.4, 7.2 and 8.0 t/m (8.8 for E5); the
    /// standard rounds c accordingly. The axles are symmetric.
    #[test]
    fn wagons_have_the_mass_per_metre_of_their_category() {
        let per_metre = [
            ("a", 5.0),
            ("b1", 5.0),
            ("b2", 6.4),
            ("c2", 6.4),
            ("c3", 7.2),
            ("c4", 8.0),
            ("d2", 6.4),
            ("d3", 7.2),
            ("d4", 8.0),
            ("e4", 8.0),
            ("e5", 8.8),
        ];
        for (name, p) in per_metre {
            let all = all();
            let (_, wagon) = all.iter().find(|(other, _)| *other == format!("en15528_{name}")).unwrap();
            let at: Vec<f64> = wagon.axles.iter().map(|axle| axle.at).collect();
            let mass: f64 = wagon.axles.iter().map(|axle| axle.force / 9810.0).sum();
            assert!((mass / (at[3] + 3.0) / p - 1.0).abs() < 0.005, "{name}: {}", mass / (at[3] + 3.0));
            assert!((at[3] - at[2] - (at[1] - at[0])).abs() < 1e-12 && at[1] == 1.8);
        }
    }

    /// The page of the load names each of them.
    #[test]
    fn the_page_names_every_vehicle() {
        let page = include_str!("../loads/vehicle.md");
        for (name, _) in all() {
            assert!(page.contains(&format!("`{name}`")), "{name}");
        }
    }
}
