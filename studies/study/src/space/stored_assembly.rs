//! Reads assemblies that COMPAS has written: a graph of blocks with interfaces, as JSON.
//!
//! Most objects are wrapped as `{"dtype": …, "data": …}`. Keys can be in any order, and unknown keys are ignored.

use serde_json::{Map, Value as Json, json};

/// Returns the keys `blocks` and `contacts` of the scene `assembly`.
///
/// # Errors
/// A sentence with the node or the pair that is wrong.
pub(super) fn read(text: &str) -> Result<Map<String, Json>, String> {
    let file: Json = serde_json::from_str(text).map_err(|error| format!("it is not JSON: {error}"))?;
    let graph = graph(&file).ok_or("it has no graph with nodes: it is not an assembly of COMPAS")?;
    let nodes = graph["node"].as_object().ok_or("its nodes are not a table")?;
    let blocks = nodes.iter().map(|(key, node)| block(key, node)).collect::<Result<Vec<_>, _>>()?;
    let mut contacts = Vec::new();
    for (u, edges) in graph.get("edge").and_then(Json::as_object).into_iter().flatten() {
        for (v, edge) in edges.as_object().into_iter().flatten() {
            for stored in edge.get("interfaces").and_then(Json::as_array).into_iter().flatten() {
                let wrong = |why| format!("the interface between nodes \"{u}\" and \"{v}\" {why}");
                contacts.push(contact(u, v, unwrapped(stored)).map_err(wrong)?);
            }
        }
    }
    let keys = [("blocks".to_string(), Json::Array(blocks)), ("contacts".into(), Json::Array(contacts))];
    Ok(keys.into_iter().collect())
}

/// Removes wrappers.
fn unwrapped(mut value: &Json) -> &Json {
    while value.get("dtype").is_some() {
        let Some(inner) = value.get("data").or_else(|| value.get("value")) else { break };
        value = inner;
    }
    value
}

fn graph(file: &Json) -> Option<&Json> {
    let mut value = unwrapped(file);
    while value.get("node").is_none() {
        value = unwrapped(value.get("graph").or_else(|| value.get("data")).or_else(|| value.get("value"))?);
    }
    Some(value)
}

/// Returns a block. Vertices that belong to no face are left out.
fn block(key: &str, node: &Json) -> Result<Json, String> {
    let wrong = |why: &str| format!("node \"{key}\" {why}");
    let block = node.get("block").map(unwrapped).ok_or_else(|| wrong("has no block"))?;
    let vertices = block.get("vertex").and_then(Json::as_object).ok_or_else(|| wrong("has no vertices"))?;
    let stored = block.get("face").and_then(Json::as_object).ok_or_else(|| wrong("has no faces"))?;
    let (mut names, mut points, mut faces) = (Map::new(), Vec::new(), Vec::new());
    for face in stored.values() {
        let mut corners = Vec::new();
        for corner in face.as_array().ok_or_else(|| wrong("has a face that is not a list"))? {
            let name = corner.as_str().map_or_else(|| corner.to_string(), String::from);
            if !names.contains_key(&name) {
                let point =
                    vertices.get(&name).and_then(point).ok_or_else(|| wrong("has a face with an unknown vertex"))?;
                names.insert(name.clone(), json!(points.len()));
                points.push(point);
            }
            corners.push(names[&name].clone());
        }
        faces.push(corners);
    }
    let mut block = json!({ "name": key, "vertices": points, "faces": faces });
    if node.get("is_support") == Some(&Json::Bool(true)) {
        block["fixed"] = json!(true);
    }
    Ok(block)
}

/// Returns a point or vector: a list of three numbers, or a table with x, y and z.
fn point(stored: &Json) -> Option<[f64; 3]> {
    let stored = unwrapped(stored);
    let [x, y, z] = match stored.as_array() {
        Some(list) => [list.first()?, list.get(1)?, list.get(2)?],
        None => [stored.get("x")?, stored.get("y")?, stored.get("z")?],
    };
    Some([x.as_f64()?, y.as_f64()?, z.as_f64()?])
}

/// Returns a contact; its normal is xaxis × yaxis and points from u to v.
fn contact(u: &str, v: &str, stored: &Json) -> Result<Json, &'static str> {
    let points = stored.get("points").and_then(Json::as_array).ok_or("has no points")?;
    let points: Option<Vec<[f64; 3]>> = points.iter().map(point).collect();
    let points = points.ok_or("has a point without three coordinates")?;
    let frame = stored.get("frame").map(unwrapped).ok_or("has no frame")?;
    let axis = |key: &str| frame.get(key).and_then(point);
    let ([a, b, c], [d, e, f]) = axis("xaxis").zip(axis("yaxis")).ok_or("has no axes")?;
    let normal = [b * f - c * e, c * d - a * f, a * e - b * d];
    Ok(json!({ "between": [u, v], "points": points, "normal": normal }))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrapped and plain objects, gaps in the numbers of vertices, an unused vertex, and both forms of points.
    #[test]
    fn wrappers_are_removed_and_vertices_are_numbered_from_zero() {
        let text = r#"{"data": {"graph": {"dtype": "compas.datastructures/Graph", "data": {
            "edge": {"b": {"a": {"interfaces": [{"dtype": "x/Interface", "data": {
                "points": [{"dtype": "compas.geometry/Point", "data": [0, 0, 0]}, [1, 0, 0], [0, 1, 0]],
                "frame": {"dtype": "f", "data": {"xaxis": [1, 0, 0], "yaxis": [0, 1, 0], "point": [0, 0, 0]}}}}]}}, "a": {}},
            "node": {"b": {"is_support": true, "block": {"dtype": "d", "value": {"vertex": {
                "9": {"x": 0, "y": 0, "z": 0}, "2": {"x": 1, "y": 0, "z": 0}, "3": {"x": 5, "y": 5, "z": 5},
                "4": {"x": 0, "y": 1, "z": 0}, "7": {"x": 0, "y": 0, "z": 1}},
                "face": {"0": [9, 4, 2], "1": ["9", "2", "7"], "2": [2, 4, 7], "3": [4, 9, 7]}}}},
              "a": {"block": {"vertex": {}, "face": {}}}}}}}}"#;
        let read = read(text).unwrap();
        assert_eq!(
            read["blocks"][0],
            json!({ "name": "b", "fixed": true,
            "vertices": [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
            "faces": [[0, 1, 2], [0, 2, 3], [2, 1, 3], [1, 0, 3]] })
        );
        assert_eq!(
            read["contacts"],
            json!([{ "between": ["b", "a"], "normal": [0.0, 0.0, 1.0],
            "points": [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]] }])
        );
    }

    #[test]
    fn mistakes_name_the_node_or_the_pair() {
        assert!(read("{").unwrap_err().starts_with("it is not JSON"));
        assert!(read("{}").unwrap_err().contains("no graph"));
        assert_eq!(read(r#"{"node": {"7": {}}}"#).unwrap_err(), "node \"7\" has no block");
        let block = r#"{"block": {"vertex": {}, "face": {"0": [1, 2, 3]}}}"#;
        assert!(read(&format!(r#"{{"node": {{"7": {block}}}}}"#)).unwrap_err().contains("unknown vertex"));
        let edge = r#"{"1": {"2": {"interfaces": [{"points": []}]}}}"#;
        let why = read(&format!(r#"{{"node": {{}}, "edge": {edge}}}"#)).unwrap_err();
        assert_eq!(why, "the interface between nodes \"1\" and \"2\" has no frame");
    }
}
