//! Makes a mesh from the contents of a file.

use std::collections::BTreeSet;

use glam::DVec3;
use twintac_shape::ExtentError;

use super::input::Input;
use super::whole;
use crate::quality::check_volumes;
use crate::tet_mesh::signed_volume_mm3;
use crate::{MeshError, TetMesh};

/// Nodes within this fraction of the mesh's diagonal above the lowest node are bonded: twice the
/// default envelope of fTetWild.
const BOARD_TOLERANCE: f64 = 2e-3;

/// Smallest volume of a tetrahedron, as a fraction of that of a regular one with the same longest
/// edge.
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

/// A tetrahedron, given by the tags of its nodes, and its position in the file.
pub(super) struct TetEntry {
    pub(super) tags: [u64; 4],
    pub(super) at: usize,
}

/// Numbers the nodes that are used, turns inverted tetrahedra, and sets the node sets.
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
    let mut used_tags = Vec::new();
    for (number, node) in numbers.iter_mut().zip(&nodes).filter(|(number, _)| **number == 0) {
        *number = mesh.nodes_mm.len() as u32;
        mesh.nodes_mm.push(node.position_mm);
        used_tags.push(node.tag);
    }
    let mut seen = BTreeSet::new();
    for tet in &tets {
        let mut corners = tet
            .tags
            .map(|tag| numbers[place_of(tag).expect("looked up above")]);
        let mut sorted = corners;
        sorted.sort_unstable();
        if !seen.insert(sorted) {
            continue;
        }
        if signed_volume_mm3(corners.map(|node| mesh.nodes_mm[node as usize])) < 0.0 {
            corners.swap(2, 3);
        }
        mesh.tets.push(corners);
    }
    let (low, high) = bounds_mm(&mesh);
    ExtentError::check(low, high)?;
    check_volumes(&mesh, LEAST_VOLUME_SHARE)?;
    whole::check(&mesh, &used_tags)?;
    match bonded {
        Some(values) => {
            let mut is_bonded = vec![false; mesh.nodes_mm.len()];
            for (tag, value) in values {
                let Some(place) = place_of(tag) else {
                    return input.error(
                        "data of nodes of the file",
                        format!("the tag {tag}, which no node has"),
                    );
                };
                // Nodes that no tetrahedron uses have no number.
                if let Some(is_bonded) = is_bonded.get_mut(numbers[place] as usize) {
                    *is_bonded = value >= 0.5;
                }
            }
            mesh.name_nodes(|node| is_bonded[node as usize]);
        }
        None => bond_lowest(&mut mesh),
    }
    Ok(mesh)
}

fn bounds_mm(mesh: &TetMesh) -> (DVec3, DVec3) {
    let nodes_mm = || mesh.nodes_mm.iter().copied();
    (
        nodes_mm().fold(DVec3::MAX, DVec3::min),
        nodes_mm().fold(DVec3::MIN, DVec3::max),
    )
}

/// Bonds the nodes on the board.
fn bond_lowest(mesh: &mut TetMesh) {
    let (low, high) = bounds_mm(mesh);
    let highest_mm = low.z + BOARD_TOLERANCE * low.distance(high);
    let is_low: Vec<bool> = mesh.nodes_mm.iter().map(|node| node.z <= highest_mm).collect();
    mesh.name_nodes(|node| is_low[node as usize]);
}
