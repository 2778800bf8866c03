//! Writes a `.msh` file.

use std::fmt::Write;

use super::{BONDED, elements::TET_4};
use crate::TetMesh;

/// The mesh as a Gmsh 4.1 text file, with its bonded nodes as node data. [`super::read`] gives the
/// same mesh back, bit for bit.
#[must_use]
pub fn write(mesh: &TetMesh) -> String {
    let mut text = String::with_capacity(64 * (mesh.nodes_mm.len() + mesh.tets.len()));
    // Writing to a string cannot fail.
    let _ = write_to(&mut text, mesh);
    text
}

fn write_to(text: &mut String, mesh: &TetMesh) -> std::fmt::Result {
    let (n_nodes, n_tets) = (mesh.nodes_mm.len(), mesh.tets.len());
    let low = mesh
        .nodes_mm
        .iter()
        .fold(glam::DVec3::MAX, |low, &node| low.min(node));
    let high = mesh
        .nodes_mm
        .iter()
        .fold(glam::DVec3::MIN, |high, &node| high.max(node));
    writeln!(text, "$MeshFormat\n4.1 0 8\n$EndMeshFormat")?;
    writeln!(text, "$Entities\n0 0 0 1")?;
    writeln!(
        text,
        "1 {} {} {} {} {} {} 0 0\n$EndEntities",
        low.x, low.y, low.z, high.x, high.y, high.z
    )?;
    writeln!(text, "$Nodes\n1 {n_nodes} 1 {n_nodes}\n3 1 0 {n_nodes}")?;
    for tag in 1..=n_nodes {
        writeln!(text, "{tag}")?;
    }
    for node in &mesh.nodes_mm {
        writeln!(text, "{} {} {}", node.x, node.y, node.z)?;
    }
    writeln!(
        text,
        "$EndNodes\n$Elements\n1 {n_tets} 1 {n_tets}\n3 1 {TET_4} {n_tets}"
    )?;
    for (tet, nodes) in mesh.tets.iter().enumerate() {
        let [a, b, c, d] = nodes.map(|node| node + 1);
        writeln!(text, "{} {a} {b} {c} {d}", tet + 1)?;
    }
    writeln!(
        text,
        "$EndElements\n$NodeData\n1\n\"{BONDED}\"\n1\n0\n3\n0\n1\n{n_nodes}"
    )?;
    for node in 0..n_nodes as u32 {
        let is_bonded = mesh.sets.bonded.binary_search(&node).is_ok();
        writeln!(text, "{} {}", node + 1, u8::from(is_bonded))?;
    }
    writeln!(text, "$EndNodeData")
}
