//! The boundary of a mesh as a binary STL file.

use crate::TetMesh;

/// Bytes before the number of triangles. They must not start with "solid", which would mean a text
/// file.
const HEADER: &[u8; 80] = b"boundary of a tetrahedral mesh, mm                                              ";

/// Boundary triangles with outward normals: 80 bytes of header, number of triangles, 50 bytes for
/// each, little-endian, lengths in mm.
#[must_use]
pub fn write(mesh: &TetMesh) -> Vec<u8> {
    let triangles = mesh.boundary_triangles();
    let mut bytes = Vec::with_capacity(84 + 50 * triangles.len());
    bytes.extend(HEADER);
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for triangle in &triangles {
        let normal = mesh.area_vector_mm2(triangle).normalize_or_zero();
        for vector in [normal]
            .into_iter()
            .chain(triangle.map(|node| mesh.nodes_mm[node as usize]))
        {
            vector
                .as_vec3()
                .to_array()
                .iter()
                .for_each(|number| bytes.extend(number.to_le_bytes()));
        }
        // The attribute, which is not used.
        bytes.extend([0; 2]);
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn a_tetrahedron_has_four_triangles_that_face_out() {
        let mesh = TetMesh {
            nodes_mm: vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z],
            tets: vec![[0, 1, 2, 3]],
            ..TetMesh::default()
        };
        let bytes = write(&mesh);
        assert_eq!(bytes.len(), 84 + 4 * 50);
        assert_eq!(bytes[80..84], 4_u32.to_le_bytes());
        let number = |at: usize| f32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
        let vector = |at: usize| [number(at), number(at + 4), number(at + 8)];
        let third = 1.0 / 3.0_f32.sqrt();
        assert_eq!(vector(84), [third; 3]);
        assert_eq!(
            [vector(96), vector(108), vector(120)],
            [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
        );
        assert_eq!(vector(134), [-1.0, 0.0, 0.0]);
    }
}
