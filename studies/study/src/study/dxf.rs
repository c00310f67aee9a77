//! DXF files: the polylines of a drawing, and the lines and arcs that belong to no polyline.
//!
//! A file is a list of pairs of a group code and a value, as two lines of text or binary. An entity begins with the code 0.
//! The codes are those in the DXF reference of AutoCAD 2024 (Autodesk): 5 handle, 8 layer, 10 20 30 points, 42 bulge, 67
//! paper space, 70 flags, 210 220 230 normal.

use super::drawing::{Corner, Drawing, Polyline};

/// The first bytes of a binary file.
const BINARY: &str = "AutoCAD Binary DXF\r\n\u{1a}\0";

/// A group code with its value and the line of the value; 0 in binary files.
struct Pair {
    code: i32,
    value: String,
    line: usize,
}

/// An entity: its kind and its pairs.
struct Entity<'a> {
    kind: &'a str,
    pairs: &'a [Pair],
}

impl Entity<'_> {
    fn value(&self, code: i32) -> Option<&Pair> {
        self.pairs.iter().find(|pair| pair.code == code)
    }

    /// Returns a number; `default` if it is not given. Numbers are already checked.
    fn number(&self, code: i32, default: f64) -> f64 {
        self.value(code).and_then(|pair| pair.value.parse().ok()).unwrap_or(default)
    }

    fn flag(&self, bit: i64) -> bool {
        self.value(70).and_then(|pair| pair.value.parse::<i64>().ok()).is_some_and(|flags| flags & bit != 0)
    }

    fn layer(&self) -> &str {
        self.value(8).map_or("0", |pair| &pair.value)
    }

    /// Returns the kind, the handle and its line.
    fn name(&self) -> String {
        match self.value(5) {
            None => self.kind.to_string(),
            Some(handle) if handle.line == 0 => format!("{} {}", self.kind, handle.value),
            Some(handle) => format!("{} {} (line {})", self.kind, handle.value, handle.line),
        }
    }

    fn out_of_plane(&self) -> String {
        format!("{} on layer \"{}\" does not lie in the plane of the drawing", self.name(), self.layer())
    }

    /// Returns the points of a polyline with their bulges.
    fn corners(&self) -> Vec<Corner> {
        let mut corners: Vec<Corner> = Vec::new();
        for pair in self.pairs {
            let number = || pair.value.parse().unwrap_or_default();
            match (pair.code, corners.last_mut()) {
                (10, _) => corners.push(Corner { point: [number(), 0.0], bulge: 0.0 }),
                (20, Some(corner)) => corner.point[1] = number(),
                (42, Some(corner)) => corner.bulge = number(),
                _ => {}
            }
        }
        corners
    }
}

/// Returns the polylines of a DXF file. `text` contains its characters, or its bytes as characters.
///
/// # Errors
/// The mistake, and its line if the file is text.
pub(super) fn read_drawing(text: &str) -> Result<Drawing, String> {
    let pairs = if text.starts_with(BINARY.trim_end_matches('\0')) { binary_pairs(text)? } else { text_pairs(text)? };
    let mut drawing = Drawing { unit: unit(&pairs), ..Drawing::default() };
    let entities =
        entities(&pairs).ok_or("the section ENTITIES is missing: this is not a DXF file, or it is incomplete")?;
    let mut next = entities.iter().peekable();
    while let Some(entity) = next.next() {
        let mut vertices = Vec::new();
        while let Some(vertex) = next.next_if(|next| entity.kind == "POLYLINE" && next.kind == "VERTEX") {
            vertices.push(vertex);
        }
        // Paper space contains only frames and titles.
        if entity.number(67, 0.0) == 0.0 {
            add(entity, &vertices, &mut drawing)?;
        }
    }
    Ok(drawing)
}

/// Returns the pairs of a text file.
fn text_pairs(text: &str) -> Result<Vec<Pair>, String> {
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    let pair = |(i, pair): (usize, &[&str])| {
        let code = pair[0].parse().map_err(|_| format!("line {}: \"{}\" is not a group code", 2 * i + 1, pair[0]))?;
        if (10..60).contains(&code) && !pair[1].parse::<f64>().is_ok_and(f64::is_finite) {
            return Err(format!("line {}: \"{}\" is not a number", 2 * i + 2, pair[1]));
        }
        Ok(Pair { code, value: pair[1].to_string(), line: 2 * i + 2 })
    };
    lines.chunks_exact(2).enumerate().map(pair).collect()
}

/// Returns the pairs of a binary file; each character is a byte.
fn binary_pairs(text: &str) -> Result<Vec<Pair>, String> {
    let bytes: Option<Vec<u8>> = text.chars().map(|c| u8::try_from(u32::from(c)).ok()).collect();
    let bytes = bytes.ok_or("a binary DXF file holds bytes that were changed to text: save it as text")?;
    let mut at = BINARY.len();
    let mut pairs = Vec::new();
    while at < bytes.len() {
        let pair =
            binary_pair(&bytes, &mut at).ok_or_else(|| format!("byte {at}: the binary file ends within a value"))?;
        if pair.code == 0 && pair.value == "EOF" {
            break;
        }
        pairs.push(pair);
    }
    Ok(pairs)
}

/// Returns the pair at a position and moves the position behind it. `None` if the file ends before.
fn binary_pair(bytes: &[u8], at: &mut usize) -> Option<Pair> {
    let mut take = |count: usize| {
        let taken = bytes.get(*at..*at + count)?;
        *at += count;
        Some(taken)
    };
    let code = i32::from(i16::from_le_bytes(take(2)?.try_into().ok()?));
    let value = match code {
        10..60 | 110..150 | 210..240 | 460..470 | 1010..1060 => {
            f64::from_le_bytes(take(8)?.try_into().ok()?).to_string()
        }
        60..80 | 170..180 | 270..290 | 370..390 | 400..410 | 1060..1071 => {
            i16::from_le_bytes(take(2)?.try_into().ok()?).to_string()
        }
        90..100 | 420..430 | 440..460 | 1071 => i32::from_le_bytes(take(4)?.try_into().ok()?).to_string(),
        160..170 => i64::from_le_bytes(take(8)?.try_into().ok()?).to_string(),
        290..300 => take(1)?[0].to_string(),
        310..320 | 1004 => {
            let length = usize::from(take(1)?[0]);
            take(length)?;
            String::new()
        }
        _ => {
            let mut text = String::new();
            loop {
                match take(1)?[0] {
                    0 => break text,
                    byte => text.push(char::from(byte)),
                }
            }
        }
    };
    Some(Pair { code, value, line: 0 })
}

/// Returns the entities of the section ENTITIES. `None` if there is no such section, or if it does not end.
fn entities(pairs: &[Pair]) -> Option<Vec<Entity<'_>>> {
    let is = |pair: &Pair, code: i32, value: &str| pair.code == code && pair.value == value;
    let start = pairs.windows(2).position(|two| is(&two[0], 0, "SECTION") && is(&two[1], 2, "ENTITIES"))? + 2;
    let end = start + pairs[start..].iter().position(|pair| is(pair, 0, "ENDSEC"))?;
    let own = &pairs[start..end];
    let begins: Vec<usize> = (0..own.len()).filter(|i| own[*i].code == 0).collect();
    let ends = begins.iter().skip(1).copied().chain([own.len()]);
    Some(begins.iter().zip(ends).map(|(b, e)| Entity { kind: &own[*b].value, pairs: &own[b + 1..e] }).collect())
}

/// Adds an entity; a POLYLINE with its vertices.
fn add(entity: &Entity, vertices: &[&Entity], drawing: &mut Drawing) -> Result<(), String> {
    let corners = match entity.kind {
        "LWPOLYLINE" => entity.corners(),
        "POLYLINE" => {
            if entity.flag(8) && vertices.iter().any(|vertex| vertex.number(30, 0.0) != 0.0) {
                return Err(entity.out_of_plane());
            }
            vertices.iter().flat_map(|vertex| vertex.corners()).collect()
        }
        "LINE" | "ARC" | "SPLINE" => {
            drawing.loose.push([entity.name(), entity.layer().to_string()]);
            return Ok(());
        }
        _ => return Ok(()),
    };
    let normal = [(210, 0.0), (220, 0.0), (230, 1.0)].map(|(code, default)| entity.number(code, default));
    if normal[2] <= 0.0 || normal[0] != 0.0 || normal[1] != 0.0 {
        return Err(entity.out_of_plane());
    }
    let (layer, closed) = (entity.layer().to_string(), entity.flag(1));
    drawing.polylines.push(Polyline { entity: entity.name(), layer, closed, corners });
    Ok(())
}

/// Returns one unit of a drawing \[m\], by the variable $INSUNITS of the header.
fn unit(pairs: &[Pair]) -> Option<f64> {
    let at = pairs.iter().position(|pair| pair.code == 9 && pair.value == "$INSUNITS")?;
    match pairs.get(at + 1)?.value.as_str() {
        "1" => Some(0.0254),
        "2" => Some(0.3048),
        "4" => Some(1e-3),
        "5" => Some(1e-2),
        "6" => Some(1.0),
        "7" => Some(1e3),
        "10" => Some(0.9144),
        "14" => Some(0.1),
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

    /// An old POLYLINE with its vertices, and lines in paper space, which are ignored.
    #[test]
    fn vertices_belong_to_their_polyline() {
        let vertex = |x: f64, y: f64| format!("0\nVERTEX\n8\nintrados\n10\n{x:?}\n20\n{y:?}\n30\n0.0\n");
        let line =
            format!("0\nPOLYLINE\n8\nintrados\n66\n1\n70\n1\n{}{}0\nSEQEND\n", vertex(0.0, 1.0), vertex(2.0, 3.0));
        let frame = "0\nLINE\n8\nframe\n67\n1\n10\n0.0\n20\n0.0\n11\n1.0\n21\n1.0\n";
        let drawing = read_drawing(&file("6", &format!("{line}{frame}"))).expect("a drawing");
        let [line] = &drawing.polylines[..] else { panic!("{drawing:?}") };
        assert!(line.closed && line.entity == "POLYLINE" && drawing.loose.is_empty(), "{drawing:?}");
        assert_eq!(line.corners.iter().map(|corner| corner.point).collect::<Vec<_>>(), [[0.0, 1.0], [2.0, 3.0]]);
    }

    /// The same drawing as binary pairs.
    #[test]
    fn a_binary_file_is_read() {
        let mut bytes: Vec<u8> = BINARY.bytes().collect();
        let text = file("4", INTRADOS);
        let lines: Vec<&str> = text.lines().collect();
        for pair in lines.chunks_exact(2) {
            let code: i16 = pair[0].parse().expect("a code");
            bytes.extend(code.to_le_bytes());
            match code {
                10..60 => bytes.extend(pair[1].parse::<f64>().expect("a number").to_le_bytes()),
                60..80 => bytes.extend(pair[1].parse::<i16>().expect("a number").to_le_bytes()),
                90..100 => bytes.extend(pair[1].parse::<i32>().expect("a number").to_le_bytes()),
                _ => bytes.extend(pair[1].bytes().chain([0])),
            }
        }
        let binary: String = bytes.iter().map(|byte| char::from(*byte)).collect();
        let [own, other] = [&text, &binary].map(|text| read_drawing(text).expect("a drawing"));
        assert_eq!((own.unit, &own.polylines[0].corners), (other.unit, &other.polylines[0].corners));
        assert_eq!(other.polylines[0].entity, "LWPOLYLINE 2A");
        let cut: String = binary.chars().take(BINARY.len() + 40).collect();
        assert!(read_drawing(&cut).is_err());
    }

    #[test]
    fn another_file_is_refused() {
        for text in ["", "0\nEOF\n", "hello\nworld\n", "0\nSECTION\n2\nENTITIES\n0\nLINE\n"] {
            assert!(read_drawing(text).is_err(), "{text:?}");
        }
    }
}
