//! The only file that knows the crate `dxf`.

use super::drawing::{Corner, Drawing, Polyline};
use dxf::entities::{Entity, EntityType};
use dxf::enums::Units;
use std::collections::BTreeMap;

/// Versions of the format whose text is not UTF-8.
const BEFORE_UTF_8: [&str; 6] = ["AC1009", "AC1012", "AC1014", "AC1015", "AC1018", "AC1006"];

/// What is used of the text of a DXF file; the error says what is wrong, and in which line where that is known.
pub(super) fn read_drawing(text: &str) -> Result<Drawing, String> {
    let binary = text.starts_with("AutoCAD Binary DXF");
    let older = BEFORE_UTF_8.iter().any(|version| text.contains(version));
    // One byte a character, as such files are written.
    let bytes: Vec<u8> = match binary || older {
        true => text.chars().map(|c| u8::try_from(u32::from(c)).unwrap_or(b'?')).collect(),
        false => text.bytes().collect(),
    };
    if !binary {
        numbers(text)?;
    }
    let file = dxf::Drawing::load(&mut bytes.as_slice()).map_err(|error| error.to_string())?;
    let lines = lines_of_handles(text);
    let mut drawing = Drawing { unit: unit(file.header.default_drawing_units), ..Drawing::default() };
    for entity in file.entities().filter(|entity| !entity.common.is_in_paper_space) {
        add(entity, &lines, &mut drawing)?;
    }
    Ok(drawing)
}

/// Whether what should be numbers are: the reader would only say which pair after them it did not expect.
fn numbers(text: &str) -> Result<(), String> {
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    for (i, pair) in lines.chunks_exact(2).enumerate() {
        let number = pair[0].parse().is_ok_and(|code: i32| (10..60).contains(&code));
        if number && !pair[1].parse::<f64>().is_ok_and(f64::is_finite) {
            return Err(format!("line {}: \"{}\" is not a number", 2 * i + 2, pair[1]));
        }
    }
    Ok(())
}

/// Lines in which entities give their handles: group code 5, then the handle.
fn lines_of_handles(text: &str) -> BTreeMap<u64, usize> {
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    let pairs = lines.chunks_exact(2).enumerate().filter(|(_, pair)| pair[0] == "5");
    pairs.filter_map(|(i, pair)| Some((u64::from_str_radix(pair[1], 16).ok()?, 2 * i + 2))).collect()
}

/// The kind of an entity, its handle and its line.
fn named(kind: &str, entity: &Entity, lines: &BTreeMap<u64, usize>) -> String {
    let handle = entity.common.handle;
    match (handle.is_empty(), lines.get(&handle.0)) {
        (true, _) => kind.to_string(),
        (false, None) => format!("{kind} {}", handle.as_string()),
        (false, Some(line)) => format!("{kind} {} (line {line})", handle.as_string()),
    }
}

fn add(entity: &Entity, lines: &BTreeMap<u64, usize>, drawing: &mut Drawing) -> Result<(), String> {
    let layer = entity.common.layer.clone();
    let (name, closed, normal, corners) = match &entity.specific {
        EntityType::LwPolyline(line) => {
            let corner = |v: &dxf::LwPolylineVertex| Corner { point: [v.x, v.y], bulge: v.bulge };
            let corners: Vec<Corner> = line.vertices.iter().map(corner).collect();
            (named("LWPOLYLINE", entity, lines), line.is_closed(), &line.extrusion_direction, corners)
        }
        EntityType::Polyline(line) => {
            let corner = |v: &dxf::entities::Vertex| Corner { point: [v.location.x, v.location.y], bulge: v.bulge };
            let name = named("POLYLINE", entity, lines);
            if line.vertices().any(|v| v.location.z != 0.0) && line.is_3d_polyline() {
                return Err(format!("{name} on layer \"{layer}\" does not lie in the plane of the drawing"));
            }
            (name, line.is_closed(), &line.normal, line.vertices().map(corner).collect())
        }
        EntityType::Line(_) => {
            drawing.loose.push([named("LINE", entity, lines), layer]);
            return Ok(());
        }
        EntityType::Arc(_) => {
            drawing.loose.push([named("ARC", entity, lines), layer]);
            return Ok(());
        }
        EntityType::Spline(_) => {
            drawing.loose.push([named("SPLINE", entity, lines), layer]);
            return Ok(());
        }
        _ => return Ok(()),
    };
    if normal.z <= 0.0 || normal.x != 0.0 || normal.y != 0.0 {
        return Err(format!("{name} on layer \"{layer}\" does not lie in the plane of the drawing"));
    }
    drawing.polylines.push(Polyline { entity: name, layer, closed, corners });
    Ok(())
}

/// One unit of a drawing \[m\].
fn unit(unit: Units) -> Option<f64> {
    match unit {
        Units::Meters => Some(1.0),
        Units::Millimeters => Some(1e-3),
        Units::Centimeters => Some(1e-2),
        Units::Decimeters => Some(0.1),
        Units::Kilometers => Some(1e3),
        Units::Inches => Some(0.0254),
        Units::Feet => Some(0.3048),
        Units::Yards => Some(0.9144),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const INTRADOS: &str = "0\nLWPOLYLINE\n5\n2A\n100\nAcDbEntity\n8\nintrados\n100\nAcDbPolyline\n90\n3\n70\n0\n\
        10\n0.0\n20\n0.0\n10\n1500.0\n20\n750.0\n42\n-0.5\n10\n3000.0\n20\n0.0\n";

    fn file(unit: &str, entities: &str) -> String {
        format!(
            "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1021\n9\n$INSUNITS\n70\n{unit}\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n\
             {entities}0\nENDSEC\n0\nEOF\n"
        )
    }

    #[test]
    fn a_file_is_read() {
        let drawing = read_drawing(&file("4", INTRADOS)).expect("a drawing");
        assert_eq!(drawing.unit, Some(1e-3));
        let [line] = &drawing.polylines[..] else { panic!("{drawing:?}") };
        assert_eq!(
            (line.entity.as_str(), line.layer.as_str(), line.closed),
            ("LWPOLYLINE 2A (line 22)", "intrados", false)
        );
        assert_eq!(line.corners[1], Corner { point: [1500.0, 750.0], bulge: -0.5 });
        let loose = "0\nLINE\n5\n2B\n100\nAcDbEntity\n8\nextrados\n100\nAcDbLine\n10\n0.0\n20\n0.0\n11\n1.0\n21\n1.0\n";
        let drawing = read_drawing(&file("0", &format!("{INTRADOS}{loose}"))).expect("a drawing");
        assert_eq!((drawing.unit, drawing.loose.len()), (None, 1));
        assert!(drawing.loose[0][0].starts_with("LINE 2B (line"), "{:?}", drawing.loose);
    }

    #[test]
    fn what_is_wrong_says_where() {
        let broken = file("4", &INTRADOS.replace("750.0", "seven"));
        let why = read_drawing(&broken).expect_err("a mistake");
        let line = broken.lines().position(|line| line == "seven").expect("a line") + 1;
        assert_eq!(why, format!("line {line}: \"seven\" is not a number"));
        let mirrored = INTRADOS.to_string() + "210\n0.0\n220\n0.0\n230\n-1.0\n";
        let why = read_drawing(&file("4", &mirrored)).expect_err("a mistake");
        assert!(why.starts_with("LWPOLYLINE 2A (line 22) on layer \"intrados\" does not lie"), "{why}");
    }
}
