//! Reads polyhedra from Wavefront OBJ files: each object or group with faces is a block.

use serde_json::{Map, Value as Json, json};

/// An object with the corners of its faces, counted from 0 in the file.
#[derive(Default)]
struct Object {
    name: Option<String>,
    faces: Vec<Vec<usize>>,
}

/// Returns the key `blocks` of the scene `assembly`. Lines other than `o`, `g`, `v` and `f` are ignored.
///
/// # Errors
/// A sentence with the line that is wrong.
pub(super) fn read(text: &str) -> Result<Map<String, Json>, String> {
    let (mut vertices, mut objects) = (Vec::<[f64; 3]>::new(), vec![Object::default()]);
    for (number, line) in text.lines().enumerate() {
        let wrong = |why: &str| format!("line {}: {why}", number + 1);
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => vertices.push(point(words).ok_or_else(|| wrong("a vertex has three numbers"))?),
            Some("f") => {
                let corners = words.map(|word| corner(word, vertices.len())).collect::<Option<Vec<_>>>();
                let corners = corners.ok_or_else(|| wrong("a face names a vertex that is not above it"))?;
                objects.iter_mut().last().into_iter().for_each(|object| object.faces.push(corners.clone()));
            }
            Some("o" | "g") => {
                let name = words.collect::<Vec<_>>().join(" ");
                objects.push(Object { name: Some(name), faces: Vec::new() });
            }
            _ => {}
        }
    }
    objects.retain(|object| !object.faces.is_empty());
    if objects.is_empty() {
        return Err("it has no object with faces".into());
    }
    let blocks = objects.iter().enumerate().map(|(index, object)| block(index, object, &vertices)).collect();
    Ok([("blocks".to_string(), Json::Array(blocks))].into_iter().collect())
}

fn point<'a>(words: impl Iterator<Item = &'a str>) -> Option<[f64; 3]> {
    let numbers: Option<Vec<f64>> =
        words.take(3).map(|word| word.parse().ok().filter(|x: &f64| x.is_finite())).collect();
    numbers?.try_into().ok()
}

/// Returns the index of a corner `v`, `v/vt` or `v/vt/vn`; negative numbers count from the last vertex.
fn corner(word: &str, vertices: usize) -> Option<usize> {
    let number: i64 = word.split('/').next()?.parse().ok()?;
    let index = if number < 0 { i64::try_from(vertices).ok()? + number } else { number - 1 };
    usize::try_from(index).ok().filter(|index| *index < vertices)
}

/// Returns a block with the vertices that its faces use.
fn block(index: usize, object: &Object, vertices: &[[f64; 3]]) -> Json {
    let mut used: Vec<usize> = object.faces.iter().flatten().copied().collect();
    used.sort_unstable();
    used.dedup();
    let own = |corner: &usize| used.partition_point(|other| other < corner);
    let faces: Vec<Vec<usize>> = object.faces.iter().map(|face| face.iter().map(own).collect()).collect();
    let points: Vec<[f64; 3]> = used.iter().map(|&corner| vertices[corner]).collect();
    let name = object.name.clone().filter(|name| !name.is_empty()).unwrap_or_else(|| index.to_string());
    json!({ "name": name, "vertices": points, "faces": faces })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_object_with_faces_is_a_block() {
        let text = "# two\no low\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1/1 2/1/1 4//1\nf 2 3 4\nf -2 -4 -1\n\
                    o none\ng high part\nv 0 0 2\nf 1 2 5\nf 1 5 2\n";
        let blocks = &read(text).unwrap()["blocks"];
        assert_eq!(blocks[0]["faces"], json!([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]));
        assert_eq!((&blocks[0]["name"], &blocks[1]["name"]), (&json!("low"), &json!("high part")));
        assert_eq!(blocks[1]["vertices"], json!([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 2.0]]));
    }

    #[test]
    fn mistakes_name_their_line() {
        assert_eq!(read("v 0 0\n").unwrap_err(), "line 1: a vertex has three numbers");
        assert!(read("v 0 0 0\nf 1 2 3\n").unwrap_err().starts_with("line 2"));
        assert_eq!(read("v 0 0 0\n").unwrap_err(), "it has no object with faces");
    }
}
