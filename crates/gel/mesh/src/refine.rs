//! Refinement of a mesh: every tetrahedron is cut into eight. The solver has displacements on the
//! refined mesh, and pressures on the coarse one.

use std::collections::{HashMap, HashSet};

use crate::TetMesh;
use crate::tet_mesh::signed_volume_mm3;

/// A refined mesh, and the coarse mesh that it was cut from.
#[derive(Clone, Debug, PartialEq)]
pub struct Refinement {
    /// The refined mesh. Its first nodes are those of the coarse mesh; tetrahedra `8 t` to
    /// `8 t + 7` are cut from the coarse tetrahedron `t`.
    pub mesh: TetMesh,
    /// Nodes of each coarse tetrahedron.
    pub coarse_tets: Vec<[u32; 4]>,
    /// Number of nodes of the coarse mesh.
    pub n_coarse_nodes: usize,
    /// For each further node the two coarse nodes that it is midway between, smaller index first;
    /// `[n_nodes - n_coarse_nodes]`.
    pub midpoints: Vec<[u32; 2]>,
}

/// Corners of a tetrahedron that are the ends of its six edges.
const EDGES: [[usize; 2]; 6] = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];

/// The four tetrahedra at the corners: a corner and three midpoints, which are numbered from 4 in
/// the order of [`EDGES`].
const CORNERS: [[usize; 4]; 4] = [[0, 4, 5, 6], [4, 1, 7, 8], [5, 7, 2, 9], [6, 8, 9, 3]];

/// A way to cut the octahedron that remains: two opposite midpoints, and the ring of the other
/// four.
type Diagonal = ([usize; 2], [usize; 4]);

const DIAGONALS: [Diagonal; 3] = [
    ([4, 9], [5, 6, 8, 7]),
    ([5, 8], [4, 6, 9, 7]),
    ([6, 7], [4, 5, 9, 8]),
];

impl TetMesh {
    /// Number of nodes of the mesh that [`TetMesh::refined`] makes: one for each node and each
    /// edge.
    #[must_use]
    pub fn n_nodes_refined(&self) -> usize {
        let edges_of = |tet: &[u32; 4]| EDGES.map(|[a, b]| [tet[a].min(tet[b]), tet[a].max(tet[b])]);
        let edges: HashSet<[u32; 2]> = self.tets.iter().flat_map(edges_of).collect();
        self.nodes_mm.len() + edges.len()
    }

    /// Cuts every tetrahedron into eight. The octahedron inside is cut along its shortest diagonal
    /// (Bey, Computing 55, 1995, leaves the choice open). Of equally short ones, the diagonal from
    /// the longest edge is taken, so that mirror images are cut in the same way. A new node is
    /// bonded if it is on a boundary triangle whose corners are all bonded.
    #[must_use]
    pub fn refined(&self) -> Refinement {
        let mut mesh = TetMesh {
            nodes_mm: self.nodes_mm.clone(),
            tets: Vec::with_capacity(8 * self.tets.len()),
            ..TetMesh::default()
        };
        let mut midpoints = Vec::new();
        let mut midpoint_of = HashMap::new();
        for tet in &self.tets {
            let mut nodes = [0; 10];
            nodes[..4].copy_from_slice(tet);
            for (node, edge) in nodes[4..].iter_mut().zip(EDGES) {
                let [a, b] = edge.map(|corner| tet[corner]);
                let ends = [a.min(b), a.max(b)];
                *node = *midpoint_of.entry(ends).or_insert_with(|| {
                    midpoints.push(ends);
                    let [a, b] = ends.map(|end| self.nodes_mm[end as usize]);
                    mesh.nodes_mm.push(0.5 * (a + b));
                    mesh.nodes_mm.len() as u32 - 1
                });
            }
            let at_mm = |corner: usize| mesh.nodes_mm[nodes[corner] as usize];
            let length_mm = |diagonal: &Diagonal| at_mm(diagonal.0[0]).distance(at_mm(diagonal.0[1]));
            let longest_edge_mm = |diagonal: &Diagonal| {
                let edges = diagonal.0.map(|midpoint| EDGES[midpoint - 4]);
                let [one_mm, other_mm] = edges.map(|[a, b]| at_mm(a).distance(at_mm(b)));
                one_mm.max(other_mm)
            };
            let mut best = &DIAGONALS[0];
            for diagonal in &DIAGONALS[1..] {
                let ratio = length_mm(diagonal) / length_mm(best);
                let is_tie = (ratio - 1.0).abs() < 1e-6;
                if is_tie && longest_edge_mm(diagonal) > longest_edge_mm(best) || !is_tie && ratio < 1.0 {
                    best = diagonal;
                }
            }
            let ([low, high], ring) = *best;
            let inner = (0..4).map(|i| [low, high, ring[i], ring[(i + 1) % 4]]);
            for child in CORNERS.into_iter().chain(inner) {
                let mut child = child.map(|corner| nodes[corner]);
                if signed_volume_mm3(child.map(|node| mesh.nodes_mm[node as usize])) < 0.0 {
                    child.swap(2, 3);
                }
                mesh.tets.push(child);
            }
        }
        let n_coarse_nodes = self.nodes_mm.len();
        let mut bonded = vec![false; mesh.nodes_mm.len()];
        self.sets
            .bonded
            .iter()
            .for_each(|&node| bonded[node as usize] = true);
        for triangle in self.boundary_triangles() {
            if triangle.iter().all(|&node| bonded[node as usize]) {
                for [a, b] in [[0, 1], [0, 2], [1, 2]] {
                    let (a, b) = (triangle[a], triangle[b]);
                    bonded[midpoint_of[&[a.min(b), a.max(b)]] as usize] = true;
                }
            }
        }
        mesh.name_nodes(|node| bonded[node as usize]);
        Refinement {
            mesh,
            coarse_tets: self.tets.clone(),
            n_coarse_nodes,
            midpoints,
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    #[test]
    fn eight_children_fill_their_parent() {
        let parent = TetMesh {
            nodes_mm: vec![
                DVec3::ZERO,
                DVec3::X,
                DVec3::new(0.2, 1.0, 0.1),
                DVec3::new(0.1, 0.3, 2.0),
            ],
            tets: vec![[0, 1, 2, 3]],
            ..TetMesh::default()
        };
        let refined = parent.refined();
        assert_eq!(refined.mesh.nodes_mm.len(), 10);
        assert_eq!(parent.n_nodes_refined(), 10);
        for tet in 0..8 {
            let share = refined.mesh.tet_volume_mm3(tet) / parent.tet_volume_mm3(0);
            assert!((share - 0.125).abs() < 1e-12, "{share}");
        }
    }
}
