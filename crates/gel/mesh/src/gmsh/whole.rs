//! Checks that the tetrahedra of a file form one mesh: they are joined at common nodes, and none
//! overlaps another.

use std::collections::BTreeMap;

use glam::DVec3;
use twintac_shape::{SurfaceError, TriangleSurface};

use crate::boundary::FACES;
use crate::tet_mesh::signed_volume_mm3;
use crate::{MeshError, TetMesh};

/// Nodes of the boundary that are nearer to each other than this fraction of the mesh's diagonal
/// are at the same position.
const SAME_PLACE: f64 = 1e-6;
/// Largest difference between the volume that the boundary encloses and that of the tetrahedra, as
/// a fraction.
const VOLUME_TOLERANCE: f64 = 1e-6;

/// Checks a mesh. `tags` are those of its nodes in the file.
pub(super) fn check(mesh: &TetMesh, tags: &[u64]) -> Result<(), MeshError> {
    check_faces(mesh)?;
    let boundary = mesh.boundary_triangles();
    check_nodes(mesh, &boundary, tags)?;
    let corners = |triangle: &[u32; 3]| triangle.map(|node| mesh.nodes_mm[node as usize]);
    let triangles: Vec<[DVec3; 3]> = boundary.iter().map(corners).collect();
    let surface = TriangleSurface::from_triangles(&triangles).map_err(|error| match error {
        SurfaceError::SelfOverlap { at_mm, .. } => overlap(at_mm.into()),
        other => MeshError::Boundary(other),
    })?;
    if let Some(at_mm) = surface.bodies_meet_at_mm() {
        return Err(overlap(at_mm));
    }
    let volume_mm3 = mesh.volume_mm3();
    if (surface.volume_mm3() - volume_mm3).abs() > VOLUME_TOLERANCE * volume_mm3 {
        return Err(overlap(surface.vertices_mm()[0]));
    }
    Ok(())
}

fn overlap(at_mm: DVec3) -> MeshError {
    MeshError::Overlap { at_mm }
}

/// Checks that each face belongs to one tetrahedron, or to two on opposite sides.
fn check_faces(mesh: &TetMesh) -> Result<(), MeshError> {
    // For each face: whether it has a tetrahedron on its one and on its other side so far.
    let mut faces: BTreeMap<[u32; 3], [bool; 2]> = BTreeMap::new();
    for (tet, nodes) in mesh.tets.iter().enumerate() {
        for face in FACES {
            let mut key = face.map(|corner| nodes[corner]);
            key.sort_unstable();
            let [a, b, c] = key.map(|node| mesh.nodes_mm[node as usize]);
            let center: DVec3 = mesh.corners_mm(tet).iter().sum::<DVec3>() / 4.0;
            let side = usize::from(signed_volume_mm3([a, b, c, center]) > 0.0);
            if std::mem::replace(&mut faces.entry(key).or_default()[side], true) {
                return Err(overlap((a + b + c) / 3.0));
            }
        }
    }
    Ok(())
}

/// Checks that no two nodes of the boundary are at the same position.
fn check_nodes(mesh: &TetMesh, boundary: &[[u32; 3]], tags: &[u64]) -> Result<(), MeshError> {
    let mut nodes: Vec<u32> = boundary.iter().flatten().copied().collect();
    nodes.sort_unstable();
    nodes.dedup();
    let at_mm = |node: u32| mesh.nodes_mm[node as usize];
    let low = nodes.iter().fold(DVec3::MAX, |low, &node| low.min(at_mm(node)));
    let high = nodes.iter().fold(DVec3::MIN, |high, &node| high.max(at_mm(node)));
    let tolerance_mm = SAME_PLACE * low.distance(high);
    let mut cells: BTreeMap<[i64; 3], Vec<u32>> = BTreeMap::new();
    for node in nodes {
        let cell = ((at_mm(node) - low) / tolerance_mm)
            .to_array()
            .map(|index| index as i64);
        let around =
            (0..27).map(|shift| [0, 1, 2].map(|axis| cell[axis] + shift / 3_i64.pow(axis as u32) % 3 - 1));
        let mut near = around.filter_map(|cell| cells.get(&cell)).flatten();
        if let Some(&other) = near.find(|&&other| at_mm(other).distance(at_mm(node)) <= tolerance_mm) {
            return Err(MeshError::NodesTwice {
                tags: [other, node].map(|node| tags[node as usize]),
                at_mm: at_mm(node),
            });
        }
        cells.entry(cell).or_default().push(node);
    }
    Ok(())
}
