//! A tetrahedral mesh and its node sets.

use glam::DVec3;

use crate::Cuboid;
use crate::boundary::outward_triangles;

/// Linear tetrahedra with positive volume: for each, `(b - a) × (c - a) · (d - a) > 0`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TetMesh {
    /// Positions of the nodes in the undeformed state, mm.
    pub nodes_mm: Vec<DVec3>,
    /// Node indices of each tetrahedron.
    pub tets: Vec<[u32; 4]>,
    /// Named sets of nodes: bonded, free, pressed.
    pub sets: NodeSets,
}

/// Named sets of nodes, each sorted.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NodeSets {
    /// Nodes that are glued to something rigid: the board at z = 0, and the faces of inclusions.
    pub bonded: Vec<u32>,
    /// Boundary nodes that are not bonded.
    pub free: Vec<u32>,
    /// Free nodes on the surface that is pressed: those at a facet whose outward normal is within
    /// 60° of +z.
    pub top: Vec<u32>,
}

impl TetMesh {
    /// Corner positions of a tetrahedron, mm.
    #[must_use]
    pub fn corners_mm(&self, tet: usize) -> [DVec3; 4] {
        self.tets[tet].map(|node| self.nodes_mm[node as usize])
    }

    /// Volume of a tetrahedron, mm³.
    #[must_use]
    pub fn tet_volume_mm3(&self, tet: usize) -> f64 {
        signed_volume_mm3(self.corners_mm(tet))
    }

    /// Volume of the whole mesh, mm³.
    #[must_use]
    pub fn volume_mm3(&self) -> f64 {
        (0..self.tets.len()).map(|tet| self.tet_volume_mm3(tet)).sum()
    }

    /// Volume of each node: a quarter of each tetrahedron around it, mm³; `[n_nodes]`.
    #[must_use]
    pub fn node_volumes_mm3(&self) -> Vec<f64> {
        let mut volumes_mm3 = vec![0.0; self.nodes_mm.len()];
        for (tet, nodes) in self.tets.iter().enumerate() {
            let share = 0.25 * self.tet_volume_mm3(tet);
            for &node in nodes {
                volumes_mm3[node as usize] += share;
            }
        }
        volumes_mm3
    }

    /// Triangles of the boundary, with corners counterclockwise seen from outside, in the order of
    /// their tetrahedra.
    #[must_use]
    pub fn boundary_triangles(&self) -> Vec<[u32; 3]> {
        outward_triangles(&self.tets, self.nodes_mm.len())
    }

    /// Boundary area of each node: a third of each triangle around it, and zero inside, mm²;
    /// `[n_nodes]`.
    #[must_use]
    pub fn node_areas_mm2(&self) -> Vec<f64> {
        self.node_areas_of_mm2(&self.boundary_triangles())
    }

    /// Area of each node if only these triangles count, mm²; `[n_nodes]`.
    #[must_use]
    fn node_areas_of_mm2(&self, triangles: &[[u32; 3]]) -> Vec<f64> {
        let mut areas_mm2 = vec![0.0; self.nodes_mm.len()];
        for triangle in triangles {
            let share = self.area_vector_mm2(triangle).length() / 3.0;
            for &node in triangle {
                areas_mm2[node as usize] += share;
            }
        }
        areas_mm2
    }

    /// Outward normal of a boundary triangle, with the area as its length, mm².
    #[must_use]
    pub fn area_vector_mm2(&self, triangle: &[u32; 3]) -> DVec3 {
        let [a, b, c] = triangle.map(|node| self.nodes_mm[node as usize]);
        0.5 * (b - a).cross(c - a)
    }

    /// Additionally bonds the boundary nodes within a tolerance of an inclusion, because an
    /// imported mesh does not state which these are.
    pub fn bond_to(&mut self, inclusions: &[Cuboid], tolerance_mm: f64) {
        let bonded = std::mem::take(&mut self.sets.bonded);
        let is_near: Vec<bool> = self
            .nodes_mm
            .iter()
            .map(|&node| {
                inclusions
                    .iter()
                    .any(|inclusion| inclusion.distance_mm(node) <= tolerance_mm)
            })
            .collect();
        self.name_nodes(|node| is_near[node as usize] || bonded.binary_search(&node).is_ok());
    }

    /// Sets the node sets: the bonded nodes of the boundary, and the rest of the boundary.
    pub(crate) fn name_nodes(&mut self, is_bonded: impl Fn(u32) -> bool) {
        let triangles = self.boundary_triangles();
        let mut on_boundary = vec![false; self.nodes_mm.len()];
        let mut upward = vec![false; self.nodes_mm.len()];
        for triangle in &triangles {
            let area = self.area_vector_mm2(triangle);
            for &node in triangle {
                on_boundary[node as usize] = true;
                upward[node as usize] |= area.z > 0.5 * area.length();
            }
        }
        let boundary = (0..self.nodes_mm.len() as u32).filter(|&node| on_boundary[node as usize]);
        let (bonded, free): (Vec<u32>, Vec<u32>) = boundary.partition(|&node| is_bonded(node));
        let top = free
            .iter()
            .copied()
            .filter(|&node| upward[node as usize])
            .collect();
        self.sets = NodeSets { bonded, free, top };
    }
}

/// Volume of a tetrahedron, mm³; negative if its orientation is wrong.
pub(crate) fn signed_volume_mm3([a, b, c, d]: [DVec3; 4]) -> f64 {
    (b - a).cross(c - a).dot(d - a) / 6.0
}
