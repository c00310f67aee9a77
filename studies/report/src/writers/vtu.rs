//! `vtu/`: the blocks at the end of each path, for ParaView, as VTK XML files of unstructured grids.

use super::register::register;
use super::vtu_space::{blocks_text, forces_text};
use super::vtu_text::{array, head, tail};
use super::writer::Writer;
use crate::output::StudyOutput;
use crate::postprocess::displaced_mesh::{DisplacedBlock, displaced_blocks};
use serde_json::Value as Json;
use voussoir_core::plugin::OutputOf;
use voussoir_plot::svg::escape;
use voussoir_study::results::CaseResult;

/// Writes `vtu/`.
#[derive(Debug)]
pub struct Vtu;

impl Writer for Vtu {
    fn files(&self, study: &StudyOutput, _options: &Json) -> Vec<(String, Vec<u8>)> {
        if !study.output.vtu {
            return Vec::new();
        }
        let mut files: Vec<(String, String)> = Vec::new();
        let mut sets = String::new();
        let mut list = String::from(MEANING);
        for (case, scene) in study.results.cases.iter().zip(&study.scenes) {
            let title = study.case_title(case);
            if let Some(space) = scene.space {
                let name = format!("case-{:04}.vtu", case.label.id);
                list += &format!("{name}: {title}; blocks in space with the velocities of the mechanism\n");
                sets += &format!("    <DataSet timestep=\"{}\" part=\"0\" file=\"{name}\"/>\n", case.label.id);
                let forces = forces_text(space, case);
                files.extend(forces.map(|text| (format!("vtu/points-{:04}.vtu", case.label.id), text)));
                files.push((format!("vtu/{name}"), blocks_text(space, case)));
                continue;
            }
            match displaced_blocks(scene.assembly, scene.stages, case, scene.finite) {
                Ok(blocks) => {
                    let name = format!("case-{:04}.vtu", case.label.id);
                    let imbalance = blocks.iter().map(|block| block.imbalance).fold(0.0, f64::max);
                    list += &format!("{name}: {title}; forces on the blocks balance within {imbalance:.1e}\n");
                    sets += &format!("    <DataSet timestep=\"{}\" part=\"0\" file=\"{name}\"/>\n", case.label.id);
                    let points = points_text(case).map(|text| (format!("vtu/points-{:04}.vtu", case.label.id), text));
                    files.extend(points);
                    files.push((format!("vtu/{name}"), vtu_text(&blocks, case.proof.field_factor.unwrap_or(0.0))));
                }
                Err(why) => list += &format!("no file: {title}: {why}\n"),
            }
        }
        let collection = format!(
            "<?xml version=\"1.0\"?>\n<!-- {} -->\n<VTKFile type=\"Collection\" version=\"1.0\" \
             byte_order=\"LittleEndian\">\n  <Collection>\n{sets}  </Collection>\n</VTKFile>\n",
            escape(study.name).replace("--", "- -")
        );
        files.push(("vtu/cases.pvd".into(), collection));
        files.push(("vtu/README.txt".into(), list));
        files.into_iter().map(|(name, text)| (name, text.into_bytes())).collect()
    }
}

const MEANING: &str = "Blocks at the end of each path, for ParaView. cases.pvd opens all cases; its time is the case's id.\n\
    Points stand where they were before any load [m]; Warp By Vector with \"displacement [m]\" shows where they went.\n\
    \"stress [Pa]\": xx, yy, zz, xy, yz, xz, tension positive, at nodes (mean of the elements around) and in cells (their\n\
    middle); with finite displacements in axes that turn with the block. Rigid blocks have deformable = 0 and no stress\n\
    (zeros stand for it). \"equivalent plastic strain [-]\": mean of each cell, 0 where nothing yields; stresses of blocks that\n\
    have yielded are those of the nearest Gauss points. Stresses at the ends of contact zones are singular: they grow with the mesh.\n\
    Outputs of plug-ins: cells of case-NNNN.vtu have those of materials (outputs of points as means); points-NNNN.vtu has the\n\
    contact and stress points with all outputs of points, joints and blocks; nan where there is no value.\n\n";

/// The VTK cell type: quadrilaterals of order 1, 2, 3; a polygon for a rigid block.
fn cell_type(order: usize) -> u8 {
    match order {
        0 => 7,
        1 => 9,
        2 => 28,
        _ => 70,
    }
}

fn tensor([xx, yy, zz, xy]: &[f64; 4]) -> String {
    format!("{xx:e} {yy:e} {zz:e} {xy:e} 0 0")
}

/// A number of an array; `nan` without a value.
fn number(value: Option<f64>) -> String {
    value.filter(|value| value.is_finite()).map_or("nan".into(), |value| format!("{value:e}"))
}

/// Creates a file with the points of joints and blocks at which plug-ins have outputs. An output of a joint or a block is given at
/// each of its points. `None` without such points.
fn points_text(case: &CaseResult) -> Option<String> {
    let mut places: Vec<[f64; 2]> = Vec::new();
    let mut columns: Vec<(String, Vec<Option<f64>>)> = Vec::new();
    let bases = case.outputs.iter().filter(|entry| entry.of == OutputOf::Point);
    let mut done: Vec<(&str, &str)> = Vec::new();
    for base in bases {
        let law = (base.kind.as_str(), base.plugin.as_str());
        if done.contains(&law) {
            continue;
        }
        done.push(law);
        let first = places.len();
        places.extend(&base.positions);
        for entry in case.outputs.iter().filter(|own| (own.kind.as_str(), own.plugin.as_str()) == law) {
            let of_place =
                |place| entry.places.iter().position(|own| *own == place).and_then(|at| *entry.values.get(at)?);
            let values: Vec<Option<f64>> = match entry.of {
                OutputOf::Point => entry.values.clone(),
                OutputOf::Case => continue,
                _ => base.places.iter().map(|place| of_place(*place)).collect(),
            };
            let header = entry.header();
            let at = columns.iter().position(|(own, _)| *own == header).unwrap_or_else(|| {
                columns.push((header, Vec::new()));
                columns.len() - 1
            });
            columns[at].1.resize(first, None);
            columns[at].1.extend(values);
        }
    }
    let count = places.len();
    let mut text = head(count, count);
    array(&mut text, "Points", "Float64", 3, places.iter().map(|[x, y]| format!("{x:e} {y:e} 0")));
    text.push_str("      </Points>\n      <Cells>\n");
    array(&mut text, "connectivity", "Int64", 1, (0..count).map(|i| i.to_string()));
    array(&mut text, "offsets", "Int64", 1, (1..=count).map(|i| i.to_string()));
    array(&mut text, "types", "UInt8", 1, (0..count).map(|_| "1".into()));
    text.push_str("      </Cells>\n      <PointData>\n");
    for (name, values) in &mut columns {
        values.resize(count, None);
        array(&mut text, &escape(name), "Float64", 1, values.iter().map(|value| number(*value)));
    }
    text.push_str("      </PointData>\n");
    text.push_str(tail());
    (count > 0).then_some(text)
}

/// Creates a file with all blocks as one piece, at a factor of the last loads.
pub fn vtu_text(blocks: &[DisplacedBlock], factor: f64) -> String {
    let points: usize = blocks.iter().map(|b| b.nodes.len()).sum();
    let cells: usize = blocks.iter().map(|b| b.cells.len()).sum();
    let mut text = format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\">\n  \
         <UnstructuredGrid>\n    <FieldData>\n      <DataArray type=\"Float64\" Name=\"load_factor\" NumberOfTuples=\"1\" \
         format=\"ascii\">{factor:e}</DataArray>\n    </FieldData>\n    <Piece NumberOfPoints=\"{points}\" \
         NumberOfCells=\"{cells}\">\n      <Points>\n"
    );
    let three = |v: &voussoir_core::model::geometry::Vec2| format!("{:e} {:e} 0", v.x, v.y);
    array(&mut text, "Points", "Float64", 3, blocks.iter().flat_map(|b| b.nodes.iter().map(three)));
    text.push_str("      </Points>\n      <Cells>\n");
    let words = |list: &mut dyn Iterator<Item = usize>| list.map(|i| i.to_string()).collect::<Vec<_>>().join(" ");
    let mut first = 0;
    let mut connectivity = Vec::new();
    let mut offsets = Vec::new();
    let mut end = 0;
    for block in blocks {
        for cell in &block.cells {
            connectivity.push(words(&mut cell.iter().map(|i| i + first)));
            end += cell.len();
            offsets.push(end.to_string());
        }
        first += block.nodes.len();
    }
    array(&mut text, "connectivity", "Int64", 1, connectivity.into_iter());
    array(&mut text, "offsets", "Int64", 1, offsets.into_iter());
    let of_cells = |value: &dyn Fn(&DisplacedBlock) -> String| -> Vec<String> {
        blocks.iter().flat_map(|b| std::iter::repeat_n(value(b), b.cells.len())).collect()
    };
    array(&mut text, "types", "UInt8", 1, of_cells(&|b| cell_type(b.order).to_string()).into_iter());
    text.push_str("      </Cells>\n      <PointData Vectors=\"displacement [m]\" Tensors=\"stress [Pa]\">\n");
    array(&mut text, "displacement [m]", "Float64", 3, blocks.iter().flat_map(|b| b.displacement.iter().map(three)));
    let rows = |stress: &[[f64; 4]], count: usize| -> Vec<String> {
        if stress.is_empty() { vec![tensor(&[0.0; 4]); count] } else { stress.iter().map(tensor).collect() }
    };
    array(&mut text, "stress [Pa]", "Float64", 6, blocks.iter().flat_map(|b| rows(&b.stress, b.nodes.len())));
    text.push_str("      </PointData>\n      <CellData>\n");
    array(&mut text, "stress [Pa]", "Float64", 6, blocks.iter().flat_map(|b| rows(&b.cell_stress, b.cells.len())));
    let strains = |b: &DisplacedBlock| -> Vec<String> {
        (0..b.cells.len()).map(|i| format!("{:e}", b.plastic_strain.get(i).copied().unwrap_or(0.0))).collect()
    };
    array(&mut text, "equivalent plastic strain [-]", "Float64", 1, blocks.iter().flat_map(strains));
    let mut names: Vec<&String> = Vec::new();
    for (name, _) in blocks.iter().flat_map(|block| &block.outputs) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    for name in names {
        let values = |b: &DisplacedBlock| -> Vec<String> {
            let own = b.outputs.iter().find(|(own, _)| own == name).map(|(_, values)| values);
            (0..b.cells.len()).map(|i| number(own.and_then(|own| own.get(i).copied()))).collect()
        };
        array(&mut text, &escape(name), "Float64", 1, blocks.iter().flat_map(values));
    }
    array(&mut text, "block", "Int64", 1, of_cells(&|b| b.block.to_string()).into_iter());
    array(&mut text, "deformable", "UInt8", 1, of_cells(&|b| u8::from(b.order > 0).to_string()).into_iter());
    text + "      </CellData>\n" + tail()
}

register!(
    "vtu",
    Vtu,
    "vtu/*.vtu: meshes with displacements and stresses at the end of each path, on request",
    "# `vtu`\n\nWith `[output] vtu = true`: `vtu/case-NNNN.vtu` for each case that a path solver followed, \
     `vtu/points-NNNN.vtu` with the outputs of plug-ins at contact and stress points, `vtu/cases.pvd` for all \
     of them, and `vtu/README.txt`, which says what the arrays are and which cases have none. Stresses are recovered from the \
     contact forces and loads of the result by the elements that the path was computed with. Scenes in space: the faces of \
     the blocks with the velocities of the mechanism, and the points of contacts with their forces.\n"
);
