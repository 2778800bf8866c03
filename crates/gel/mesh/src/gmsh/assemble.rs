//! Making a mesh of the contents of a file.

use glam::DVec3;

use super::input::Input;
use crate::quality::check_volumes;
use crate::tet_mesh::signed_volume_mm3;
use crate::{MeshError, TetMesh};

/// Nodes within this part of the mesh's diagonal above its lowest node are bonded: twice fTetWild's default envelope.
const BOARD_TOLERANCE: f64 = 2e-3;

/// Part of the volume of a regular tetrahedron with the same longest edge that every tetrahedron must have.
const LEAST_VOLUME_SHARE: f64 = 1e-6;

/// The contents of a file.
#[derive(Default)]
pub(super) struct Contents {
    pub(super) nodes: Vec<NodeEntry>,
    pub(super) tets: Vec<TetEntry>,
    /// Tags and values of the node data named "bonded".
    pub(super) bonded: Option<Vec<(u64, f64)>>,
}

/// A node, and its position in the file.
pub(super) struct NodeEntry {
    pub(super) tag: u64,
    pub(super) position_mm: DVec3,
    pub(super) at: usize,
}

/// A tetrahedron by the tags of its nodes, and its position in the file.
pub(super) struct TetEntry {
    pub(super) tags: [u64; 4],
    pub(super) at: usize,
}

/// Numbers the nodes that are used, turns inverted tetrahedra and names the nodes.
pub(super) fn assemble(input: &Input, contents: Contents) -> Result<TetMesh, MeshError> {
    let Contents {
        mut nodes,
        tets,
        bonded,
    } = contents;
    if tets.is_empty() {
        return Err(MeshError::Empty {
            reason: "the file has no tetrahedra".to_owned(),
        });
    }
    nodes.sort_by_key(|node| node.tag);
    if let Some(pair) = nodes.windows(2).find(|pair| pair[0].tag == pair[1].tag) {
        return input.error_at(
            pair[1].at,
            "every node once",
            format!("node {} again", pair[1].tag),
        );
    }
    let place_of = |tag: u64| nodes.binary_search_by_key(&tag, |node| node.tag).ok();
    let mut numbers = vec![u32::MAX; nodes.len()];
    for tet in &tets {
        for tag in tet.tags {
            match place_of(tag) {
                Some(place) => numbers[place] = 0,
                None => {
                    return input.error_at(
                        tet.at,
                        "nodes of the file",
                        format!("the tag {tag}, which no node has"),
                    );
                }
            }
        }
    }
    let mut mesh = TetMesh::default();
    for (number, node) in numbers.iter_mut().zip(&nodes).filter(|(number, _)| **number == 0) {
        *number = mesh.nodes_mm.len() as u32;
        mesh.nodes_mm.push(node.position_mm);
    }
    let number_of = |tag: u64| place_of(tag).map_or(u32::MAX, |place| numbers[place]);
    for tet in &tets {
        let mut corners = tet.tags.map(number_of);
        if signed_volume_mm3(corners.map(|node| mesh.nodes_mm[node as usize])) < 0.0 {
            corners.swap(2, 3);
        }
        mesh.tets.push(corners);
    }
    check_volumes(&mesh, LEAST_VOLUME_SHARE)?;
    match bonded {
        Some(values) => {
            let is_bonded = |value: &&(u64, f64)| value.1 >= 0.5;
            let mut bonded: Vec<u32> = values
                .iter()
                .filter(is_bonded)
                .map(|&(tag, _)| number_of(tag))
                .collect();
            bonded.sort_unstable();
            mesh.name_nodes(|node| bonded.binary_search(&node).is_ok());
        }
        None => bond_lowest(&mut mesh),
    }
    Ok(mesh)
}

/// Bonds the nodes on the board.
fn bond_lowest(mesh: &mut TetMesh) {
    let low = mesh.nodes_mm.iter().fold(DVec3::MAX, |low, &node| low.min(node));
    let high = mesh
        .nodes_mm
        .iter()
        .fold(DVec3::MIN, |high, &node| high.max(node));
    let highest_mm = low.z + BOARD_TOLERANCE * low.distance(high);
    let is_low: Vec<bool> = mesh.nodes_mm.iter().map(|node| node.z <= highest_mm).collect();
    mesh.name_nodes(|node| is_low[node as usize]);
}
