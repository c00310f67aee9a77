//! Warnings of faces that almost touch.

use voussoir_core::space::{NearMiss, SpaceAssembly, near_misses};

/// Greatest number of pairs that a warning names; further ones are counted.
const MAX_NAMED: usize = 3;

/// Returns warnings of blocks without a contact whose faces almost touch.
pub fn near_miss_warnings(assembly: &SpaceAssembly) -> Vec<String> {
    let near = near_misses(assembly);
    let mut warnings: Vec<String> = near.iter().take(MAX_NAMED).map(|near| described(assembly, near)).collect();
    if near.len() > MAX_NAMED {
        warnings.push(format!("{} more pairs of blocks have faces that almost touch", near.len() - MAX_NAMED));
    }
    warnings
}

fn described(assembly: &SpaceAssembly, near: &NearMiss) -> String {
    let [a, b] = near.bodies.map(|body| &assembly.bodies[body].name);
    let [least, greatest] = near.gap;
    format!(
        "blocks \"{a}\" and \"{b}\" are not in contact, but their faces {} and {} almost touch: gap {least:.3e} to \
         {greatest:.3e} m over {:.3e} m²",
        near.faces[0], near.faces[1], near.area
    )
}

#[cfg(test)]
mod tests {
    use super::super::parts::tests::built;
    use super::*;
    use serde_json::{Value, json};

    /// A block 1 mm above another one is named with its gap; the block on the ground is not.
    #[test]
    fn a_gap_of_a_millimetre_is_named() {
        let cuboid = |name: &str, low: [f64; 3], high: [f64; 3], fixed: bool| -> Value {
            let corner = |k: usize| [0, 1, 2].map(|axis| if k >> axis & 1 == 1 { high[axis] } else { low[axis] });
            let corners: Vec<[f64; 3]> = (0..8).map(corner).collect();
            let faces = json!([[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]);
            json!({ "name": name, "vertices": corners, "faces": faces, "fixed": fixed })
        };
        let blocks = json!([
            cuboid("ground", [-1.0, -1.0, -1.0], [2.0, 2.0, 0.0], true),
            cuboid("low", [0.0; 3], [1.0; 3], false),
            cuboid("high", [0.0, 0.0, 1.001], [1.0, 1.0, 2.0], false),
        ]);
        let scene = built("blocks_3d", &json!({ "blocks": blocks })).unwrap();
        let warnings = near_miss_warnings(&scene);
        assert_eq!(warnings.len(), 1, "{warnings:?}");
        assert!(warnings[0].contains("\"low\" and \"high\"") && warnings[0].contains("1.000e-3"), "{warnings:?}");
    }
}
