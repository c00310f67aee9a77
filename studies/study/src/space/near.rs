//! Warnings of blocks that intersect and of faces that almost touch.

use std::collections::HashSet;
use voussoir_core::space::{FoundOverlaps, NearMiss, SpaceAssembly, SpaceOverlap, find_overlaps, near_misses};

/// Greatest number of pairs that a warning names; further ones are counted.
const MAX_NAMED: usize = 3;

/// Returns warnings of blocks whose interiors intersect, and of blocks without a contact whose faces almost touch.
pub fn warnings_of_blocks(assembly: &SpaceAssembly) -> Vec<String> {
    let FoundOverlaps { pairs, unchecked } = find_overlaps(assembly);
    let intersect: HashSet<[usize; 2]> = pairs.iter().map(|pair| pair.bodies).collect();
    let mut near = near_misses(assembly);
    near.retain(|near| !intersect.contains(&near.bodies));
    let pairs = pairs.iter().map(|pair| intersecting(assembly, pair)).collect();
    let mut warnings = shortened(pairs, "pairs of blocks intersect");
    let near = near.iter().map(|near| described(assembly, near)).collect();
    warnings.extend(shortened(near, "pairs of blocks have faces that almost touch"));
    if let Some(&first) = unchecked.first() {
        let name = &assembly.bodies[first].name;
        let count = unchecked.len();
        warnings.push(format!("blocks that are not convex are not checked for overlaps: {count}, \"{name}\" first"));
    }
    warnings
}

/// Returns the first warnings, and the number of further ones.
fn shortened(mut warnings: Vec<String>, what: &str) -> Vec<String> {
    let more = warnings.len().saturating_sub(MAX_NAMED);
    warnings.truncate(MAX_NAMED);
    warnings.extend((more > 0).then(|| format!("{more} more {what}")));
    warnings
}

fn intersecting(assembly: &SpaceAssembly, pair: &SpaceOverlap) -> String {
    let [a, b] = pair.bodies.map(|body| &assembly.bodies[body].name);
    format!("blocks \"{a}\" and \"{b}\" intersect: one must move by {:.3e} m to leave the other", pair.depth)
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

    /// Returns the warnings of a block at a gap above another one, which is on the ground.
    fn of_gap(gap: f64) -> Vec<String> {
        let cuboid = |name: &str, low: [f64; 3], high: [f64; 3], fixed: bool| -> Value {
            let corner = |k: usize| [0, 1, 2].map(|axis| if k >> axis & 1 == 1 { high[axis] } else { low[axis] });
            let corners: Vec<[f64; 3]> = (0..8).map(corner).collect();
            let faces = json!([[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]);
            json!({ "name": name, "vertices": corners, "faces": faces, "fixed": fixed })
        };
        let blocks = json!([
            cuboid("ground", [-1.0, -1.0, -1.0], [2.0, 2.0, 0.0], true),
            cuboid("low", [0.0; 3], [1.0; 3], false),
            cuboid("high", [0.0, 0.0, 1.0 + gap], [1.0, 1.0, 2.0], false),
        ]);
        warnings_of_blocks(&built("blocks_3d", &json!({ "blocks": blocks })).unwrap())
    }

    /// A block 1 mm above another one is named with its gap; the block on the ground is not.
    #[test]
    fn a_gap_of_a_millimetre_is_named() {
        let warnings = of_gap(1e-3);
        assert_eq!(warnings.len(), 1, "{warnings:?}");
        assert!(warnings[0].contains("\"low\" and \"high\"") && warnings[0].contains("1.000e-3"), "{warnings:?}");
    }

    /// A block 1 mm or 10 cm deep in another one is named once, with the depth; a block that rests on it is not.
    #[test]
    fn blocks_that_intersect_are_named() {
        assert_eq!(of_gap(0.0), Vec::<String>::new());
        for (gap, depth) in [(-1e-3, "1.000e-3"), (-0.1, "1.000e-1")] {
            let warnings = of_gap(gap);
            assert_eq!(warnings.len(), 1, "{warnings:?}");
            assert!(
                warnings[0].contains("\"low\" and \"high\" intersect") && warnings[0].contains(depth),
                "{warnings:?}"
            );
        }
    }

    /// No generated scene has blocks that intersect.
    #[test]
    fn blocks_of_generated_scenes_do_not_intersect() {
        let scenes = [
            (
                "masonry_wall",
                json!({ "block": [2.0, 1.0, 0.5], "courses": 4, "blocks": 3, "leaves": 2, "header_every": 2,
                                     "corner": { "blocks": 2 } }),
            ),
            (
                "cross_vault",
                json!({ "spans": [4.0, 4.0], "rise": 2.0, "thickness": 0.3, "voussoirs": 11, "strips": 3,
                                    "bond": "half", "springers": 3 }),
            ),
            ("dome", json!({ "radius": 1.0, "thickness": 0.1, "rings": 8, "meridians": 16, "oculus": 10.0 })),
        ];
        for (tag, keys) in scenes {
            let found = find_overlaps(&built(tag, &keys).unwrap());
            assert_eq!(found.pairs, [], "{tag}");
        }
    }
}
