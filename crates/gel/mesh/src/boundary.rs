//! The faces that belong to one tetrahedron only.

/// Faces of a positively oriented tetrahedron, counter-clockwise seen from outside.
pub(crate) const FACES: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

/// Boundary triangles, counterclockwise seen from outside, in the order of the tetrahedra. Nodes
/// must be below `n_nodes`.
pub(crate) fn outward_triangles(tets: &[[u32; 4]], n_nodes: usize) -> Vec<[u32; 3]> {
    // Faces sorted by their lowest node: each node has a range of `faces`.
    let mut ends = vec![0_usize; n_nodes + 1];
    for (nodes, face) in all_faces(tets) {
        ends[lowest(nodes, face) as usize + 1] += 1;
    }
    for node in 0..n_nodes {
        ends[node + 1] += ends[node];
    }
    let starts = ends.clone();
    let mut faces = vec![([0_u32; 2], 0_usize); 4 * tets.len()];
    for (index, (nodes, face)) in all_faces(tets).enumerate() {
        let mut key = face.map(|corner| nodes[corner]);
        key.sort_unstable();
        let place = &mut ends[key[0] as usize];
        faces[*place] = ([key[1], key[2]], index);
        *place += 1;
    }
    // Within a range, the two sides of an inner face have the same other nodes.
    let mut is_outer = vec![false; 4 * tets.len()];
    for node in 0..n_nodes {
        let stretch = &mut faces[starts[node]..starts[node + 1]];
        stretch.sort_unstable();
        for same in stretch.chunk_by(|a, b| a.0 == b.0).filter(|same| same.len() == 1) {
            is_outer[same[0].1] = true;
        }
    }
    all_faces(tets)
        .zip(is_outer)
        .filter(|&(_, is_outer)| is_outer)
        .map(|((nodes, face), _)| face.map(|corner| nodes[corner]))
        .collect()
}

fn all_faces(tets: &[[u32; 4]]) -> impl Iterator<Item = ([u32; 4], [usize; 3])> {
    tets.iter().flat_map(|&nodes| FACES.map(|face| (nodes, face)))
}

fn lowest(nodes: [u32; 4], face: [usize; 3]) -> u32 {
    nodes[face[0]].min(nodes[face[1]]).min(nodes[face[2]])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_tetrahedra_share_a_face() {
        let triangles = outward_triangles(&[[0, 1, 2, 3], [1, 3, 2, 4]], 5);
        assert_eq!(triangles.len(), 6);
        assert!(triangles.iter().all(|t| t.contains(&0) || t.contains(&4)));
    }
}
