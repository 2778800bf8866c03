//! The soft body: the data that all of its presses share.

use std::sync::Arc;

use glam::DVec3;
use twintac_mesh::TetMesh;
use twintac_shape::{Pose, SignedDistance};

use crate::bonded::BondedSurface;
use crate::contact::{Boundary, ContactPoint};
use crate::element::Elements;
use crate::linear::coarse::{CoarseSystem, Factors};
use crate::linear::direct::DirectSystem;
use crate::linear::matrix::Pattern;
use crate::parallel::join_halves;
use crate::{MPA_PER_KPA, Material, SolverSettings};

/// Fraction of the shear modulus that, as a stress over the body's size, gives the smallest load to
/// which tolerances are relative.
const LEAST_LOAD: f64 = 1e-3;

/// A soft body that is pressed by rigid shapes, and bonded at the nodes that its mesh states. It is
/// shared by many presses; each press has its own [`State`].
pub struct SoftBody {
    pub(crate) mesh: TetMesh,
    pub(crate) material: Material,
    pub(crate) settings: SolverSettings,
    pub(crate) elements: Elements,
    pub(crate) boundary: Boundary,
    pub(crate) obstacles: Vec<(Arc<dyn SignedDistance>, Pose)>,
    /// External forces on nodes, N.
    pub(crate) loads_n: Vec<(u32, DVec3)>,
    pub(crate) on_two_threads: bool,
    /// Factors that every press starts with; `None` if the body at rest has none.
    pub(crate) rest_factors: Option<Factors>,
    /// Corners of the coarse tetrahedron in each slot of the elements; `[n_slots]`.
    pub(crate) slot_corners: Vec<[u32; 4]>,
    /// The two coarse nodes that each node is midway between; twice the same for a coarse node;
    /// `[n_nodes]`.
    pub(crate) ends: Vec<[u32; 2]>,
    /// For each coarse node the modulus of the averaged volume change, divided by the volume,
    /// MPa/mm³.
    pub(crate) volume_stiffness: Vec<f64>,
    pub(crate) pattern: Pattern,
    pub(crate) coarse: CoarseSystem,
    /// `None` unless linear systems are solved by factors of the whole system.
    pub(crate) direct: Option<DirectSystem>,
    /// Where the forces on each node come from: `slot NODES + node`.
    pub(crate) force_sources: Sources,
    /// Where the volume changes of each coarse node come from: `4 slot + corner`.
    pub(crate) volume_sources: Sources,
    /// Sum of `μ V |G|²` over the quadrature points around each node, N/mm: an estimate of the
    /// node's own stiffness.
    pub(crate) node_stiffness: Vec<f64>,
    /// Where pressures follow from the forces that hold the body; `None` for composite elements,
    /// which do not gain by it, and where bonded nodes span no face.
    pub(crate) bonded_surface: Option<BondedSurface>,
    /// Cube root of the volume, mm.
    pub(crate) size_mm: f64,
}

/// For each node, the entries of the elements that are summed there.
pub(crate) struct Sources {
    /// Start of each node's entries; `[n_nodes + 1]`.
    starts: Vec<u32>,
    entries: Vec<u32>,
}

impl Sources {
    /// `of_tet` gives the nodes of a tetrahedron, and the entry for each.
    pub(crate) fn new(n_nodes: usize, n_tets: usize, of_tet: &dyn Fn(usize) -> Vec<(u32, u32)>) -> Self {
        let mut rows = vec![Vec::new(); n_nodes];
        for tet in 0..n_tets {
            for (row, entry) in of_tet(tet) {
                rows[row as usize].push(entry);
            }
        }
        let mut starts = vec![0];
        let mut entries = Vec::new();
        for row in rows {
            entries.extend(row);
            starts.push(entries.len() as u32);
        }
        Self { starts, entries }
    }

    /// The entries of each node, starting with the node `first`.
    #[inline]
    pub(crate) fn from(&self, first: usize) -> impl Iterator<Item = &[u32]> {
        let ranges = self.starts[first..].windows(2);
        ranges.map(|range| &self.entries[range[0] as usize..range[1] as usize])
    }

    /// The entries of one node.
    pub(crate) fn of(&self, node: u32) -> &[u32] {
        &self.entries[self.starts[node as usize] as usize..self.starts[node as usize + 1] as usize]
    }
}

impl SoftBody {
    /// Adds a rigid shape that does not move. It should have no concave corners: walls that meet
    /// are added as separate shapes. States that were made before do not have it.
    #[must_use]
    pub fn with_obstacle(mut self, shape: Arc<dyn SignedDistance>, gel_from_obstacle: Pose) -> Self {
        self.obstacles.push((shape, gel_from_obstacle));
        self
    }

    /// Solves each step on two threads, which are both busy during the whole step; this is for a
    /// single press that has to be fast. For many presses at the same time, one thread for each is
    /// better. The results are the same, bit for bit.
    #[must_use]
    pub fn on_two_threads(mut self) -> Self {
        self.on_two_threads = true;
        self
    }

    /// The undeformed mesh: the finer one, with its nodes renumbered.
    #[must_use]
    pub fn mesh(&self) -> &TetMesh {
        &self.mesh
    }

    /// The material.
    #[must_use]
    pub fn material(&self) -> &Material {
        &self.material
    }

    /// How many of the shapes (the parts of the indenter and the obstacles) are parts of the
    /// indenter.
    pub(crate) fn n_indenter_parts(&self, n_shapes: usize) -> usize {
        n_shapes - self.obstacles.len()
    }

    /// The contact points at the nodes of the boundary, and their positions, mm.
    pub(crate) fn boundary_mm(
        &self,
        displacements_mm: &[DVec3],
    ) -> impl Iterator<Item = (&ContactPoint, DVec3)> {
        let nodes = self.boundary.nodes.iter();
        nodes.map(|point| (point, self.point_mm(point, displacements_mm)))
    }

    /// Position of a contact point, mm.
    #[inline]
    pub(crate) fn point_mm(&self, point: &ContactPoint, displacements_mm: &[DVec3]) -> DVec3 {
        point.value(&self.mesh.nodes_mm) + point.value(displacements_mm)
    }

    /// The pressures of the corners of each slot, MPa.
    pub(crate) fn corner_pressures(&self, pressures_mpa: &[f64], corners: &mut Vec<[f64; 4]>) {
        corners.resize(self.slot_corners.len(), [0.0; 4]);
        let half = corners.len() / 2;
        let (first, second) = corners.split_at_mut(half);
        let of_corners = self.slot_corners.split_at(half);
        let gather = |corners: &mut [[f64; 4]], nodes: &[[u32; 4]]| {
            for (corners, nodes) in corners.iter_mut().zip(nodes) {
                *corners = nodes.map(|node| pressures_mpa[node as usize]);
            }
        };
        join_halves(|| gather(first, of_corners.0), || gather(second, of_corners.1));
    }

    /// Shear modulus times volume, N mm.
    pub(crate) fn energy_scale_n_mm(&self) -> f64 {
        MPA_PER_KPA * self.material.model.shear_modulus_kpa() * self.size_mm.powi(3)
    }

    /// Smallest load to which tolerances are relative, N: that of a light touch. Below it, errors
    /// do not matter.
    pub(crate) fn least_load_n(&self) -> f64 {
        let stress_kpa = LEAST_LOAD * self.material.model.shear_modulus_kpa();
        self.negligible_load_n()
            .max(MPA_PER_KPA * stress_kpa * self.size_mm * self.size_mm)
    }

    /// Loads below this count as zero, N. It is far below any load of interest, and above the
    /// round-off of a large bulk modulus.
    pub(crate) fn negligible_load_n(&self) -> f64 {
        let stress_kpa =
            1e-7 * self.material.model.shear_modulus_kpa() + 1e-9 * self.material.bulk_modulus_kpa;
        MPA_PER_KPA * stress_kpa * self.size_mm * self.size_mm
    }
}
