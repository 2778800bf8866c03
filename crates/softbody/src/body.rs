//! The soft body.

use std::sync::Arc;

use glam::{DMat3, DVec3};
use twintac_mesh::TetMesh;
use twintac_shape::{Pose, SignedDistance};

use crate::contact::{BoundaryNode, Contact};
use crate::element::Element;
use crate::material::{KPA_PER_MPA, Material, Memory, Relaxation};
use crate::ordering::elimination_order;
use crate::pressure::{Compressibility, element_compressibility};
use crate::state::State;
use crate::system::System;
use crate::{SoftBodyError, SolverSettings};

/// A soft body that rigid shapes press, bonded where its mesh says so. Shared by many presses; each has its own [`State`].
pub struct SoftBody {
    mesh: TetMesh,
    material: Material,
    pub(crate) settings: SolverSettings,
    pub(crate) elements: Vec<Element>,
    pub(crate) boundary: Vec<BoundaryNode>,
    pub(crate) obstacles: Vec<(Arc<dyn SignedDistance>, Pose)>,
    pub(crate) system: System,
    pub(crate) compressibility: Compressibility,
    /// Sum over the tetrahedra around each node of `μ V |G|²`, N/mm: what a node's own stiffness is like.
    pub(crate) node_stiffness: Vec<f64>,
    size_mm: f64,
}

impl SoftBody {
    /// Builds the model of a mesh: its bonded nodes are held, the rest of its boundary can touch.
    pub fn new(mesh: TetMesh, material: Material, settings: SolverSettings) -> Result<Self, SoftBodyError> {
        material.check()?;
        settings.check()?;
        check(&mesh)?;
        let n_nodes = mesh.nodes_mm.len();
        let neighbours = neighbours(&mesh)?;
        let order = elimination_order(&mesh.nodes_mm, &neighbours);
        let elements = elements(&mesh, &order);
        let mut free = vec![true; n_nodes];
        mesh.sets
            .bonded
            .iter()
            .for_each(|&node| free[node as usize] = false);

        let shear_mpa = material.isochoric.shear_modulus_kpa() / KPA_PER_MPA;
        let bulk_mpa = material.bulk_modulus_kpa / KPA_PER_MPA;
        let of_element =
            |element: &Element| element_compressibility(element, bulk_mpa, shear_mpa, settings.stabilisation);
        let compressibility = Compressibility::new(&elements, n_nodes, of_element)?;
        let system = System::new(&elements, &order, &neighbours, free, of_element)?;

        let mut node_stiffness = vec![0.0; n_nodes];
        for element in &elements {
            for (&node, gradient) in element.nodes.iter().zip(&element.gradients) {
                node_stiffness[node as usize] += shear_mpa * element.volume_mm3 * gradient.length_squared();
            }
        }
        let areas_mm2 = mesh.node_areas_mm2();
        let boundary = mesh
            .sets
            .free
            .iter()
            .map(|&node| {
                // μ/h per area, with h² the area that belongs to the node.
                let edge_mm = areas_mm2[node as usize].sqrt();
                BoundaryNode {
                    node,
                    stiffness: settings.contact_stiffness * shear_mpa * edge_mm,
                }
            })
            .filter(|boundary| boundary.stiffness > 0.0)
            .collect();
        let size_mm = mesh.volume_mm3().cbrt();
        Ok(Self {
            mesh,
            material,
            settings,
            elements,
            boundary,
            obstacles: Vec::new(),
            system,
            compressibility,
            node_stiffness,
            size_mm,
        })
    }

    /// Adds a rigid shape that stands still. States made before do not know it.
    #[must_use]
    pub fn with_obstacle(mut self, shape: Arc<dyn SignedDistance>, gel_from_obstacle: Pose) -> Self {
        self.obstacles.push((shape, gel_from_obstacle));
        self
    }

    /// The mesh at rest.
    #[must_use]
    pub fn mesh(&self) -> &TetMesh {
        &self.mesh
    }

    /// The material.
    #[must_use]
    pub fn material(&self) -> &Material {
        &self.material
    }

    /// Entries of the factors of the linear system, which take most of the time and memory of a press.
    #[must_use]
    pub fn n_factor_entries(&self) -> usize {
        self.system.n_factor_entries()
    }

    /// The body at rest, where it has been for ever.
    #[must_use]
    pub fn rest(&self) -> State {
        let n_nodes = self.mesh.nodes_mm.len();
        State {
            displacements_mm: vec![DVec3::ZERO; n_nodes],
            pressures_mpa: vec![0.0; n_nodes],
            memory: Memory::new(self.elements.len(), &self.material.prony),
            contacts: vec![Contact::new(self.boundary.len()); 1 + self.obstacles.len()],
            gel_from_indenter: None,
            last: None,
            workspace: crate::newton::Workspace::default(),
        }
    }

    /// Hydrostatic pressure `-tr(σ)/3` at each node, kPa, positive in compression. `[n_nodes]`
    #[must_use]
    pub fn pressure_kpa(&self, state: &State) -> Vec<f64> {
        state.pressures_kpa()
    }

    /// Von Mises stress at each node, kPa, of the mean over the deformed volume of the tetrahedra around it of the Cauchy stress, its
    /// relaxing part included. `[n_nodes]`
    #[must_use]
    pub fn von_mises_kpa(&self, state: &State) -> Vec<f64> {
        // What acts now is what a step of no time would find.
        let now = Relaxation::new(&self.material.prony, 0.0);
        let mut deviators = vec![DMat3::ZERO; self.mesh.nodes_mm.len()];
        let mut volumes_mm3 = vec![0.0; self.mesh.nodes_mm.len()];
        for (tet, element) in self.elements.iter().enumerate() {
            let deformation = element.deformation(&state.displacements_mm);
            let right_cauchy_green = deformation.isochoric_right_cauchy_green();
            let offset = now.offset(&state.memory, tet);
            let response = now.response_mpa(&self.material.isochoric, &offset, &right_cauchy_green);
            let volume_mm3 = element.volume_mm3 * deformation.volume_ratio;
            let deviator = deformation.cauchy_deviator(&response) * volume_mm3;
            for &node in &element.nodes {
                deviators[node as usize] += deviator;
                volumes_mm3[node as usize] += volume_mm3;
            }
        }
        let von_mises_mpa = |deviator: &DMat3| (1.5 * crate::material::contract(deviator, deviator)).sqrt();
        deviators
            .iter()
            .zip(&volumes_mm3)
            .map(|(sum, volume)| KPA_PER_MPA * von_mises_mpa(sum) / volume)
            .collect()
    }

    /// Shear modulus times volume, N mm.
    pub(crate) fn energy_scale_n_mm(&self) -> f64 {
        self.material.isochoric.shear_modulus_kpa() / KPA_PER_MPA * self.size_mm.powi(3)
    }

    /// Loads below this count as none, N: far below what matters, above what round-off makes of a large bulk modulus.
    pub(crate) fn negligible_load_n(&self) -> f64 {
        let stress_kpa =
            1e-7 * self.material.isochoric.shear_modulus_kpa() + 1e-9 * self.material.bulk_modulus_kpa;
        stress_kpa / KPA_PER_MPA * self.size_mm * self.size_mm
    }
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
    for (tet, nodes) in mesh.tets.iter().enumerate() {
        nodes
            .iter()
            .try_for_each(|&node| check(&|| format!("tetrahedron {tet}"), node))?;
        let volume_mm3 = mesh.tet_volume_mm3(tet);
        if volume_mm3.is_nan() || volume_mm3 <= 0.0 {
            return Err(SoftBodyError::Degenerate { tet, volume_mm3 });
        }
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

/// The nodes that share a tetrahedron with each node, itself included, sorted.
fn neighbours(mesh: &TetMesh) -> Result<Vec<Vec<u32>>, SoftBodyError> {
    let mut neighbours: Vec<Vec<u32>> = vec![Vec::new(); mesh.nodes_mm.len()];
    for nodes in &mesh.tets {
        nodes
            .iter()
            .for_each(|&node| neighbours[node as usize].extend(nodes));
    }
    for (node, neighbours) in neighbours.iter_mut().enumerate() {
        neighbours.sort_unstable();
        neighbours.dedup();
        if neighbours.is_empty() {
            return Err(SoftBodyError::Stray { node });
        }
    }
    Ok(neighbours)
}

/// The tetrahedra, each with its nodes in the order of elimination.
fn elements(mesh: &TetMesh, order: &[u32]) -> Vec<Element> {
    let mut rank = vec![0; order.len()];
    order
        .iter()
        .enumerate()
        .for_each(|(position, &node)| rank[node as usize] = position);
    mesh.tets
        .iter()
        .map(|nodes| {
            let mut nodes = *nodes;
            nodes.sort_unstable_by_key(|&node| rank[node as usize]);
            Element::new(nodes, nodes.map(|node| mesh.nodes_mm[node as usize]))
        })
        .collect()
}
