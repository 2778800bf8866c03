//! Measures of the quality of a mesh.

use serde::{Deserialize, Serialize};

use crate::tet_mesh::signed_volume_mm3;
use crate::{MeshError, TetMesh};

/// The quality of a mesh, which is written beside it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Quality {
    /// Number of nodes.
    pub n_nodes: usize,
    /// Number of tetrahedra.
    pub n_tets: usize,
    /// Number of boundary triangles.
    pub n_boundary_triangles: usize,
    /// Number of bonded nodes.
    pub n_bonded: usize,
    /// Number of nodes on the pressed surface.
    pub n_top: usize,
    /// Lengths of all edges, mm.
    pub edge_mm: Spread,
    /// The six dihedral angles of every tetrahedron, degrees (70.5 in a regular one).
    pub dihedral_deg: Spread,
    /// Volume of the mesh, mm³.
    pub volume_mm3: f64,
    /// Relative difference between the volume of the mesh and that of the solid without its
    /// inclusions; `None` if the latter is unknown.
    pub volume_error: Option<f64>,
}

/// The distribution of some numbers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Spread {
    /// Smallest.
    pub min: f64,
    /// 5 % are smaller.
    pub percentile_5: f64,
    /// Half are smaller.
    pub median: f64,
    /// 5 % are larger.
    pub percentile_95: f64,
    /// Largest.
    pub max: f64,
}

/// Smallest volume of a tetrahedron, as a fraction of that of a regular one with the same longest
/// edge.
const LEAST_VOLUME_SHARE: f64 = 1e-3;

/// Corners of the edges of a tetrahedron; each row has an edge and the opposite edge.
const EDGES: [[usize; 4]; 6] = [
    [0, 1, 2, 3],
    [0, 2, 1, 3],
    [0, 3, 1, 2],
    [1, 2, 0, 3],
    [1, 3, 0, 2],
    [2, 3, 0, 1],
];

impl Quality {
    /// Measures a mesh of at least one tetrahedron. `solid_volume_mm3` is the volume of the solid
    /// without its inclusions; see [`crate::gel_volume_mm3`].
    #[must_use]
    pub fn of(mesh: &TetMesh, solid_volume_mm3: Option<f64>) -> Self {
        let volume_mm3 = mesh.volume_mm3();
        Self {
            n_nodes: mesh.nodes_mm.len(),
            n_tets: mesh.tets.len(),
            n_boundary_triangles: mesh.boundary_triangles().len(),
            n_bonded: mesh.sets.bonded.len(),
            n_top: mesh.sets.top.len(),
            edge_mm: Spread::of(edge_lengths_mm(mesh)),
            dihedral_deg: Spread::of(dihedral_angles_deg(mesh)),
            volume_mm3,
            volume_error: solid_volume_mm3.map(|expected_mm3| volume_mm3 / expected_mm3 - 1.0),
        }
    }
}

impl Spread {
    /// The distribution of at least one number.
    fn of(mut values: Vec<f64>) -> Self {
        values.sort_by(f64::total_cmp);
        let last = values.len().checked_sub(1).expect("a mesh has a tetrahedron");
        let at = |share: f64| values[(share * last as f64).round() as usize];
        Self {
            min: at(0.0),
            percentile_5: at(0.05),
            median: at(0.5),
            percentile_95: at(0.95),
            max: at(1.0),
        }
    }
}

impl TetMesh {
    /// Fails for a tetrahedron that is inverted or flat: its volume is less than a thousandth of
    /// that of a regular one with the same longest edge.
    ///
    /// # Errors
    /// [`MeshError::Degenerate`] for the first such tetrahedron.
    pub fn check_volumes(&self) -> Result<(), MeshError> {
        check_volumes(self, LEAST_VOLUME_SHARE)
    }
}

/// Fails for a tetrahedron that is inverted or flat: its volume is less than `least_share` times
/// that of a regular tetrahedron with the same longest edge.
pub(crate) fn check_volumes(mesh: &TetMesh, least_share: f64) -> Result<(), MeshError> {
    for tet in 0..mesh.tets.len() {
        let [a, b, c, d] = mesh.corners_mm(tet);
        let volume_mm3 = signed_volume_mm3([a, b, c, d]);
        let longest_mm = [b - a, c - a, d - a, c - b, d - b, d - c]
            .iter()
            .fold(0.0, |l: f64, e| l.max(e.length()));
        let least_mm3 = least_share * longest_mm.powi(3) / (6.0 * std::f64::consts::SQRT_2);
        if !(volume_mm3 > 0.0 && volume_mm3 >= least_mm3) {
            let center_mm: glam::DVec3 = 0.25 * (a + b + c + d);
            return Err(MeshError::Degenerate {
                tet,
                center_mm,
                volume_mm3,
                least_mm3,
            });
        }
    }
    Ok(())
}

fn edge_lengths_mm(mesh: &TetMesh) -> Vec<f64> {
    let mut edges: Vec<[u32; 2]> = mesh
        .tets
        .iter()
        .flat_map(|nodes| EDGES.map(|[a, b, ..]| [nodes[a].min(nodes[b]), nodes[a].max(nodes[b])]))
        .collect();
    edges.sort_unstable();
    edges.dedup();
    edges
        .iter()
        .map(|&[a, b]| mesh.nodes_mm[a as usize].distance(mesh.nodes_mm[b as usize]))
        .collect()
}

/// Smallest dihedral angle, degrees; zero if any tetrahedron is inverted or flat.
pub(crate) fn least_dihedral_deg(mesh: &TetMesh) -> f64 {
    if (0..mesh.tets.len()).any(|tet| mesh.tet_volume_mm3(tet) <= 0.0) {
        return 0.0;
    }
    dihedral_angles_deg(mesh).into_iter().fold(180.0, f64::min)
}

fn dihedral_angles_deg(mesh: &TetMesh) -> Vec<f64> {
    let angles = |tet: usize| {
        let corners = mesh.corners_mm(tet);
        EDGES.map(|[a, b, c, d]| {
            let edge = corners[b] - corners[a];
            let (left, right) = (
                edge.cross(corners[c] - corners[a]),
                edge.cross(corners[d] - corners[a]),
            );
            // The angle between the two faces, about their common edge.
            left.cross(right).length().atan2(left.dot(right)).to_degrees()
        })
    };
    (0..mesh.tets.len()).flat_map(angles).collect()
}
