//! Builds a soft body from a mesh.

use twintac_mesh::TetMesh;

use crate::body::{SoftBody, Sources};
use crate::bonded::BondedSurface;
use crate::contact::{Boundary, BoundaryTriangle, ContactPoint};
use crate::element::{EDGES, Element, Elements, NODES, Side};
use crate::linear::coarse::CoarseSystem;
use crate::linear::direct::DirectSystem;
use crate::linear::matrix::Pattern;
use crate::linear::numbering::{Numbered, number};
use crate::newton::rest_factors;
use crate::{LinearSolver, MPA_PER_KPA, Material, SoftBodyError, SolverSettings};

impl SoftBody {
    /// Builds the model of a mesh. Its bonded nodes are held; the rest of its boundary can come
    /// into contact. Every tetrahedron is cut into eight: displacements are unknowns at all nodes
    /// of the finer mesh, pressures at those of the given mesh.
    ///
    /// # Errors
    /// A mesh that is empty or not held anywhere, or whose nodes or tetrahedra are invalid; an
    /// invalid material or setting.
    pub fn new(mesh: &TetMesh, material: Material, settings: SolverSettings) -> Result<Self, SoftBodyError> {
        material.check()?;
        settings.check()?;
        check(mesh)?;
        let Numbered {
            mesh,
            coarse_nodes_mm,
            coarse_bonded,
            coarse_tets,
            ends,
            halves,
        } = number(mesh);
        let children: Vec<[[u32; 4]; 8]> = mesh
            .tets
            .chunks_exact(8)
            .map(|eight| std::array::from_fn(|child| eight[child]))
            .collect();
        let parents = parents(&coarse_tets, &ends);
        let sides: Vec<Side> = parents.iter().map(|nodes| halves.side(nodes)).collect();
        let elements = Elements::new(
            settings.element,
            &mesh.nodes_mm,
            &mesh.sets.bonded,
            &parents,
            &children,
            &sides,
        );
        let bonded_surface = (settings.element != Element::Composite)
            .then(|| BondedSurface::new(&elements, &mesh, &parents, settings.element.flat_share()))
            .transpose()?
            .flatten();

        let modulus_mpa = MPA_PER_KPA * material.volume_modulus_kpa();
        let volume_stiffness: Vec<f64> = corner_volumes_mm3(&elements, &coarse_tets, coarse_nodes_mm.len())
            .iter()
            .map(|volume| modulus_mpa / volume)
            .collect();
        // Slots without a tetrahedron have no volume, and their corners are not used.
        let mut slot_corners = vec![[0; 4]; elements.n_slots()];
        for (corners, &slot) in coarse_tets.iter().zip(&elements.slots) {
            slot_corners[slot as usize] = *corners;
        }
        let pattern = Pattern::new(&elements, &parents, &coarse_tets, halves, &volume_stiffness);
        let coarse = CoarseSystem::new(&coarse_nodes_mm, &coarse_tets, &coarse_bonded, &volume_stiffness)?;

        let direct = (settings.linear == LinearSolver::Direct)
            .then(|| DirectSystem::new(&pattern))
            .transpose()?;

        let entries = |nodes: &[u32], stride: usize, tet: usize| -> Vec<(u32, u32)> {
            let first = elements.slots[tet] * stride as u32;
            nodes
                .iter()
                .zip(first..)
                .map(|(&node, entry)| (node, entry))
                .collect()
        };
        let n_tets = coarse_tets.len();
        let force_sources = Sources::new(mesh.nodes_mm.len(), n_tets, &|tet| {
            entries(&parents[tet], NODES, tet)
        });
        let volume_sources = Sources::new(coarse_nodes_mm.len(), n_tets, &|tet| {
            entries(&coarse_tets[tet], 4, tet)
        });

        let shear_mpa = MPA_PER_KPA * material.model.shear_modulus_kpa();
        let node_stiffness = elements
            .node_stiffness_mm(mesh.nodes_mm.len())
            .iter()
            .map(|sum| shear_mpa * sum)
            .collect();
        let boundary = boundary(&mesh, settings.contact_stiffness * shear_mpa);
        let size_mm = mesh.volume_mm3().cbrt();
        let mut body = Self {
            mesh,
            material,
            settings,
            elements,
            boundary,
            obstacles: Vec::new(),
            loads_n: Vec::new(),
            on_two_threads: false,
            slot_corners,
            ends,
            volume_stiffness,
            pattern,
            coarse,
            direct,
            force_sources,
            volume_sources,
            node_stiffness,
            bonded_surface,
            size_mm,
            rest_factors: None,
        };
        body.rest_factors = rest_factors(&body);
        Ok(body)
    }
}

/// The volume of each coarse node, mm³.
fn corner_volumes_mm3(elements: &Elements, coarse_tets: &[[u32; 4]], n_nodes: usize) -> Vec<f64> {
    let of_slots_mm3 = elements.corner_volumes_mm3();
    let mut volumes_mm3 = vec![0.0; n_nodes];
    for (corners, &slot) in coarse_tets.iter().zip(&elements.slots) {
        for (&node, volume) in corners.iter().zip(of_slots_mm3[slot as usize]) {
            volumes_mm3[node as usize] += volume;
        }
    }
    volumes_mm3
}

/// The part of the boundary that can come into contact: its free nodes, and the triangles between
/// them. `stiffness_mpa` is the contact stiffness per area and inverse edge length.
fn boundary(mesh: &TetMesh, stiffness_mpa: f64) -> Boundary {
    let areas_mm2 = mesh.node_areas_mm2();
    let free = mesh
        .sets
        .free
        .iter()
        .filter(|&&node| areas_mm2[node as usize] > 0.0);
    let mut index_of = vec![None; mesh.nodes_mm.len()];
    let mut boundary_nodes = Vec::new();
    for (index, &node) in (0..).zip(free) {
        index_of[node as usize] = Some(index);
        // μ/h per area, where h² is the area of the node.
        let edge_mm = areas_mm2[node as usize].sqrt();
        boundary_nodes.push(ContactPoint::of_node(node, stiffness_mpa * edge_mm));
    }
    let mut triangles = Vec::new();
    for nodes in mesh.boundary_triangles() {
        let corners = nodes.map(|node| index_of[node as usize]);
        if corners.iter().any(Option::is_some) {
            let at_mm = nodes.map(|node| mesh.nodes_mm[node as usize]);
            triangles.push(BoundaryTriangle::new(nodes, corners, at_mm, stiffness_mpa));
        }
    }
    Boundary::new(boundary_nodes, triangles)
}

/// The ten nodes of each coarse tetrahedron: its corners, followed by the midpoints of its edges.
fn parents(coarse_tets: &[[u32; 4]], ends: &[[u32; 2]]) -> Vec<[u32; NODES]> {
    let node_of: std::collections::HashMap<[u32; 2], u32> =
        ends.iter().zip(0..).map(|(&ends, node)| (ends, node)).collect();
    coarse_tets
        .iter()
        .map(|corners| {
            std::array::from_fn(|node| {
                let [a, b] = match node.checked_sub(4) {
                    Some(edge) => EDGES[edge].map(|corner| corners[corner as usize]),
                    None => [corners[node]; 2],
                };
                node_of[&[a.min(b), a.max(b)]]
            })
        })
        .collect()
}

fn check(mesh: &TetMesh) -> Result<(), SoftBodyError> {
    if mesh.tets.is_empty() {
        return Err(SoftBodyError::Empty);
    }
    let n_nodes = mesh.nodes_mm.len();
    let check = |place: &dyn Fn() -> String, found: u32| {
        if (found as usize) < n_nodes {
            Ok(())
        } else {
            Err(SoftBodyError::Node {
                place: place(),
                found,
                n_nodes,
            })
        }
    };
    let mut is_used = vec![false; n_nodes];
    for (tet, nodes) in mesh.tets.iter().enumerate() {
        for &node in nodes {
            check(&|| format!("tetrahedron {tet}"), node)?;
            is_used[node as usize] = true;
        }
        let volume_mm3 = mesh.tet_volume_mm3(tet);
        if volume_mm3.is_nan() || volume_mm3 <= 0.0 {
            return Err(SoftBodyError::Degenerate { tet, volume_mm3 });
        }
    }
    if let Some(node) = is_used.iter().position(|used| !used) {
        return Err(SoftBodyError::Stray { node });
    }
    mesh.sets
        .bonded
        .iter()
        .try_for_each(|&node| check(&|| "the set `bonded`".into(), node))?;
    mesh.sets
        .free
        .iter()
        .try_for_each(|&node| check(&|| "the set `free`".into(), node))?;
    if mesh.sets.bonded.is_empty() {
        Err(SoftBodyError::NotBonded)
    } else {
        Ok(())
    }
}
