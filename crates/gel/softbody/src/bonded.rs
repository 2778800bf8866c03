//! The pressure where the body is bonded, from the forces that hold it.
//!
//! A sensor's ports are in the bonded surface, where the linear pressure of an element is least
//! accurate: it has only the resolution of the coarse mesh, and no neighbour on the other side.
//! The forces that hold the nodes have the resolution of the fine mesh, and are the exact
//! counterpart of the solution (consistent fluxes: Wheeler, SIAM J. Numer. Anal. 11, 1974; Carey,
//! Chow and Seager, Comput. Methods Appl. Mech. Eng. 50, 1985). With the shape functions `N` on the
//! surface, the traction `t` follows from the force `f` that holds each node `a`:
//!
//! `Σ_b ∫ N_a N_b dA t_b = f_a`
//!
//! A surface that keeps its shape can only be sheared, by `γ = |t_s|/μ`, with the tangential
//! traction `t_s` and the shear modulus `μ`. The deviator of the stress along its normal `n` is
//! then `-μ γ²/3`, and the pressure is `p = -n·t - |t_s|²/(3 μ)`. This is exact for a neo-Hookean
//! gel. For other laws and for gels that relax, `μ` differs from the initial modulus that is used
//! here; in the middle of a press, the term is 1 to 2 % of the pressure.

use std::collections::HashMap;
use std::fmt::Display;
use std::ops::Range;

use faer::linalg::solvers::Solve;
use faer::sparse::linalg::solvers::Llt;
use faer::sparse::{SparseColMat, Triplet};
use faer::{Mat, Side};
use glam::DVec3;
use twintac_mesh::TetMesh;

use crate::element::{EDGES, Elements, NODES, Response};
use crate::wide::LANES;
use crate::{MPA_PER_KPA, SoftBodyError};

/// Corners and midpoints of a face: each midpoint is between the two corners before it in a cycle,
/// so that corner, corner and midpoint `i` are `i`, `i + 1` and `3 + i`.
const FACE_NODES: usize = 6;

/// Corners of the faces of a tetrahedron.
const FACES: [[usize; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

/// A surface keeps its shape if no distance changes by more than this fraction.
const STRETCH: f64 = 1e-6;

/// The faces at which a body is bonded.
pub(crate) struct BondedSurface {
    /// The packs with nodes of these faces.
    packs: Vec<Range<usize>>,
    /// Nodes of the faces, sorted, and their undeformed positions.
    nodes: Vec<u32>,
    nodes_mm: Vec<DVec3>,
    /// For each node of the body, its index among these.
    index_of: Vec<Option<u32>>,
    /// Indices of the nodes of each face. Seen from outside, corners are counterclockwise.
    faces: Vec<[u32; FACE_NODES]>,
    /// Factors of the matrix `∫ N_a N_b dA`, mm².
    factors: Llt<u32, f64>,
}

impl BondedSurface {
    /// `parents` are the ten nodes of each coarse tetrahedron; `flat_share` is the part of the
    /// composite element in the energy at the surface. `None` for a mesh whose bonded nodes span no
    /// face.
    pub(crate) fn new(
        elements: &Elements,
        mesh: &TetMesh,
        parents: &[[u32; NODES]],
        flat_share: f64,
    ) -> Result<Option<Self>, SoftBodyError> {
        let faces = bonded_faces(mesh, parents);
        if faces.is_empty() {
            return Ok(None);
        }
        let mut nodes: Vec<u32> = faces.iter().flatten().copied().collect();
        nodes.sort_unstable();
        nodes.dedup();
        let mut index_of = vec![None; mesh.nodes_mm.len()];
        for (index, &node) in (0..).zip(&nodes) {
            index_of[node as usize] = Some(index);
        }
        let index = |node: u32| index_of[node as usize].expect("nodes of faces have an index");
        let faces: Vec<[u32; FACE_NODES]> = faces.iter().map(|face| face.map(index)).collect();
        let nodes_mm: Vec<DVec3> = nodes.iter().map(|&node| mesh.nodes_mm[node as usize]).collect();
        let shares = shares(flat_share);
        let mut entries = Vec::new();
        for face in &faces {
            let area_mm2 = area_vector_mm2(face, |node| nodes_mm[node]).length();
            for (&a, shares) in face.iter().zip(&shares) {
                let row = face.iter().zip(shares);
                entries.extend(row.map(|(&b, share)| Triplet::new(a, b, share * area_mm2)));
            }
        }
        let analysis = |reason: &dyn Display| SoftBodyError::Analysis {
            n_unknowns: nodes.len(),
            reason: reason.to_string(),
        };
        let matrix = SparseColMat::try_new_from_triplets(nodes.len(), nodes.len(), &entries);
        let matrix = matrix.map_err(|error| analysis(&error))?;
        let factors = matrix
            .sp_cholesky(Side::Lower)
            .map_err(|error| analysis(&error))?;
        Ok(Some(Self {
            packs: elements.packs_with(&|node| index_of[node as usize].is_some()),
            nodes,
            nodes_mm,
            index_of,
            faces,
            factors,
        }))
    }

    /// Replaces the pressures of these nodes, MPa, given those of the slots' corners. It does
    /// nothing while the surface is deformed, and nothing in a body that was never moved, whose
    /// pressures are exactly zero.
    pub(crate) fn set_pressures(
        &self,
        elements: &Elements,
        response: &Response,
        displacements_mm: &[DVec3],
        corner_pressures_mpa: &[[f64; 4]],
        nodal_mpa: &mut [f64],
    ) {
        let is_at_rest = displacements_mm.iter().all(|moved| *moved == DVec3::ZERO);
        if is_at_rest || !self.keeps_its_shape(displacements_mm) {
            return;
        }
        let normals = self.normals(displacements_mm);
        let held_n = self.held_n(elements, response, displacements_mm, corner_pressures_mpa);
        let shear_mpa = MPA_PER_KPA * response.material.model.shear_modulus_kpa();
        let surface = self.nodes.iter().zip(&normals);
        for ((&node, normal), traction_mpa) in surface.zip(self.tractions_mpa(&held_n)) {
            let along_mpa = traction_mpa.dot(*normal);
            let shear_squared = (traction_mpa - along_mpa * *normal).length_squared();
            nodal_mpa[node as usize] = -along_mpa - shear_squared / (3.0 * shear_mpa);
        }
    }

    /// The forces that hold these nodes, N.
    fn held_n(
        &self,
        elements: &Elements,
        response: &Response,
        displacements_mm: &[DVec3],
        corner_pressures_mpa: &[[f64; 4]],
    ) -> Vec<DVec3> {
        let mut sums_n = vec![DVec3::ZERO; self.nodes.len()];
        for packs in &self.packs {
            let forces_n =
                elements.forces_of(packs.clone(), response, displacements_mm, corner_pressures_mpa);
            for (slot, forces_n) in (packs.start * LANES..).zip(&forces_n) {
                for (node, force_n) in elements.nodes_of(slot).zip(forces_n) {
                    if let Some(index) = self.index_of[node as usize] {
                        sums_n[index as usize] += *force_n;
                    }
                }
            }
        }
        sums_n
    }

    /// Whether the distances between corners are those of the undeformed faces.
    fn keeps_its_shape(&self, displacements_mm: &[DVec3]) -> bool {
        let moved_mm =
            |node: u32| self.nodes_mm[node as usize] + displacements_mm[self.nodes[node as usize] as usize];
        self.faces.iter().all(|face| {
            [[0, 1], [1, 2], [2, 0]].iter().all(|side| {
                let [a, b] = side.map(|corner| face[corner]);
                let rest_mm = self.nodes_mm[a as usize].distance(self.nodes_mm[b as usize]);
                (moved_mm(a).distance(moved_mm(b)) - rest_mm).abs() <= STRETCH * rest_mm
            })
        })
    }

    /// Outward normals of the nodes.
    fn normals(&self, displacements_mm: &[DVec3]) -> Vec<DVec3> {
        let mut sums_mm2 = vec![DVec3::ZERO; self.nodes.len()];
        for face in &self.faces {
            let area_mm2 = area_vector_mm2(face, |node| {
                self.nodes_mm[node] + displacements_mm[self.nodes[node] as usize]
            });
            face.iter().for_each(|&node| sums_mm2[node as usize] += area_mm2);
        }
        sums_mm2.iter().map(|sum| sum.normalize_or_zero()).collect()
    }

    /// The tractions whose integrals with the shape functions are these forces.
    fn tractions_mpa(&self, forces_n: &[DVec3]) -> Vec<DVec3> {
        let mut tractions_mpa = Mat::from_fn(forces_n.len(), 3, |node, axis| forces_n[node][axis]);
        self.factors.solve_in_place(tractions_mpa.as_mut());
        let rows = 0..forces_n.len();
        rows.map(|node| DVec3::from_array([0, 1, 2].map(|axis| tractions_mpa[(node, axis)])))
            .collect()
    }
}

/// The faces of the boundary whose corners and midpoints are all bonded.
fn bonded_faces(mesh: &TetMesh, parents: &[[u32; NODES]]) -> Vec<[u32; FACE_NODES]> {
    let is_bonded = |node: &u32| mesh.sets.bonded.binary_search(node).is_ok();
    let mut found: Vec<[u32; FACE_NODES]> = Vec::new();
    let mut n_tets_at: HashMap<[u32; 3], u32> = HashMap::new();
    let key = |face: &[u32; FACE_NODES]| {
        let mut corners = [face[0], face[1], face[2]];
        corners.sort_unstable();
        corners
    };
    for parent in parents {
        for corners in FACES {
            let midpoint = |from: usize| {
                let mut ends = [corners[from], corners[(from + 1) % 3]].map(|corner| corner as u8);
                ends.sort_unstable();
                let edge = EDGES.iter().position(|edge| *edge == ends);
                parent[4 + edge.expect("any two corners have an edge")]
            };
            let [a, b, c] = corners.map(|corner| parent[corner]);
            let face = [a, b, c, midpoint(0), midpoint(1), midpoint(2)];
            if face.iter().all(is_bonded) {
                *n_tets_at.entry(key(&face)).or_default() += 1;
                found.push(face);
            }
        }
    }
    found.retain(|face| n_tets_at[&key(face)] == 1);
    found
}

/// Half the product of two sides of a face: its normal, with the area as the length. The corners
/// are given by their indices.
fn area_vector_mm2(face: &[u32; FACE_NODES], at_mm: impl Fn(usize) -> DVec3) -> DVec3 {
    let [a, b, c] = [0, 1, 2].map(|corner| at_mm(face[corner] as usize));
    0.5 * (b - a).cross(c - a)
}

/// `∫ N_a N_b dA` over a face, divided by its area, if a part of the energy is that of
/// displacements that are linear in the four parts of a face, and the rest that of quadratic ones.
fn shares(flat_share: f64) -> [[f64; FACE_NODES]; FACE_NODES] {
    let mut shares = quadratic_shares().map(|row| row.map(|share| (1.0 - flat_share) * share));
    for part in [[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]] {
        for a in part {
            for b in part {
                shares[a][b] += flat_share * if a == b { 2.0 } else { 1.0 } / 48.0;
            }
        }
    }
    shares
}

/// The same for quadratic displacements.
fn quadratic_shares() -> [[f64; FACE_NODES]; FACE_NODES] {
    let is_corner = |node: usize| node < 3;
    let are_opposite = |corner: usize, midpoint: usize| midpoint - 3 == (corner + 1) % 3;
    let share = |a: usize, b: usize| match (is_corner(a), is_corner(b)) {
        (true, true) if a == b => 6.0,
        (true, true) => -1.0,
        (true, false) if are_opposite(a, b) => -4.0,
        (false, true) if are_opposite(b, a) => -4.0,
        (true, false) | (false, true) => 0.0,
        (false, false) if a == b => 32.0,
        (false, false) => 16.0,
    };
    std::array::from_fn(|a| std::array::from_fn(|b| share(a, b) / 180.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Quadratic shape functions of a face, at barycentric coordinates.
    fn quadratic_at(l: [f64; 3]) -> [f64; FACE_NODES] {
        std::array::from_fn(|node| match node.checked_sub(3) {
            None => l[node] * (2.0 * l[node] - 1.0),
            Some(from) => 4.0 * l[from] * l[(from + 1) % 3],
        })
    }

    #[test]
    fn shares_are_integrals_of_products() {
        // Seven points integrate polynomials of degree five exactly (Radon 1948).
        let root = 15.0_f64.sqrt();
        let [near, far] = [(6.0 - root) / 21.0, (6.0 + root) / 21.0];
        let [of_near, of_far] = [(155.0 - root) / 1200.0, (155.0 + root) / 1200.0];
        let mut points = vec![([1.0 / 3.0; 3], 9.0 / 40.0)];
        for corner in 0..3 {
            for (aside, weight) in [(near, of_near), (far, of_far)] {
                let mut l = [aside; 3];
                l[corner] = 1.0 - 2.0 * aside;
                points.push((l, weight));
            }
        }
        let found = quadratic_shares();
        for a in 0..FACE_NODES {
            for b in 0..FACE_NODES {
                let product =
                    |(l, weight): &([f64; 3], f64)| weight * quadratic_at(*l)[a] * quadratic_at(*l)[b];
                let expected: f64 = points.iter().map(product).sum();
                assert!(
                    (found[a][b] - expected).abs() < 1e-12,
                    "{a} {b}: {} {expected}",
                    found[a][b]
                );
            }
        }
        for flat_share in [0.0, 0.5, 1.0] {
            let total: f64 = shares(flat_share).as_flattened().iter().sum();
            assert!((total - 1.0).abs() < 1e-12, "{total}");
        }
    }
}
