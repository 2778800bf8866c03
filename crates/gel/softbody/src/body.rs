//! The soft body.

use std::sync::Arc;

use glam::DVec3;
use twintac_mesh::TetMesh;
use twintac_shape::{Pose, SignedDistance};

use crate::contact::{Boundary, BoundaryTriangle, Contact, ContactPoint};
use crate::element::{self, Elements, NODES, Response, Side};
use crate::linear::coarse::{CoarseSystem, Factors};
use crate::linear::direct::DirectSystem;
use crate::linear::matrix::Pattern;
use crate::linear::numbering::{Numbered, number};
use crate::newton::rest_factors;
use crate::relaxation::{Memory, Relaxation};
use crate::state::State;
use crate::{LinearSolver, MPA_PER_KPA, Material, SoftBodyError, SolverSettings};

/// Part of the shear modulus whose stress over the body's size makes the load that tolerances are at least relative to.
const LEAST_LOAD: f64 = 1e-3;

/// A soft body that rigid shapes press, bonded where its mesh says so. Shared by many presses; each has its own [`State`].
pub struct SoftBody {
    mesh: TetMesh,
    material: Material,
    pub(crate) settings: SolverSettings,
    pub(crate) elements: Elements,
    pub(crate) boundary: Boundary,
    pub(crate) obstacles: Vec<(Arc<dyn SignedDistance>, Pose)>,
    /// Forces from outside on nodes, N.
    pub(crate) loads_n: Vec<(u32, DVec3)>,
    pub(crate) on_two_threads: bool,
    /// Factors that every press starts with; none if the body at rest has none.
    pub(crate) rest_factors: Option<Factors>,
    /// Corners of the coarse tetrahedra, and of what is in each of the elements' slots.
    pub(crate) slot_corners: Vec<[u32; 4]>,
    /// The coarse nodes that each node lies midway between; the same twice for a coarse node. `[n_nodes]`
    pub(crate) ends: Vec<[u32; 2]>,
    /// Modulus of the mean volume change over volume of each coarse node, MPa/mm³.
    pub(crate) volume_stiffness: Vec<f64>,
    pub(crate) pattern: Pattern,
    pub(crate) coarse: CoarseSystem,
    /// None unless systems are solved by factors of the whole.
    pub(crate) direct: Option<DirectSystem>,
    /// Where forces on each node come from: `slot NODES + node`. `[n_nodes + 1]`, and the places.
    pub(crate) force_starts: Vec<u32>,
    pub(crate) force_sources: Vec<u32>,
    /// Where volume changes of each coarse node come from: `4 slot + corner`. `[n_coarse + 1]`, and the places.
    pub(crate) volume_starts: Vec<u32>,
    pub(crate) volume_sources: Vec<u32>,
    /// Sum over the points around each node of `μ V |G|²`, N/mm: what a node's own stiffness is like.
    pub(crate) node_stiffness: Vec<f64>,
    size_mm: f64,
}

impl SoftBody {
    /// Builds the model of a mesh, whose bonded nodes are held while the rest of its boundary can touch. Every tetrahedron is cut into
    /// eight: displacements live on all nodes of the finer mesh, pressures on those of the mesh given.
    ///
    /// # Errors
    /// A mesh that is empty, held nowhere, or has nodes or tetrahedra that make no sense; a material or settings that make none.
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
        let elements = Elements::new(settings.element, &mesh.nodes_mm, &parents, &children, &sides);

        let modulus_mpa = MPA_PER_KPA * material.volume_modulus_kpa();
        let corner_volumes_mm3 = elements.corner_volumes_mm3();
        let mut volumes_mm3 = vec![0.0; coarse_nodes_mm.len()];
        // Slots without a tetrahedron have no volume; their corners stand for nothing.
        let mut slot_corners = vec![[0; 4]; elements.n_slots()];
        for (corners, &slot) in coarse_tets.iter().zip(&elements.slots) {
            slot_corners[slot as usize] = *corners;
            for (&node, volume) in corners.iter().zip(corner_volumes_mm3[slot as usize]) {
                volumes_mm3[node as usize] += volume;
            }
        }
        let volume_stiffness: Vec<f64> = volumes_mm3.iter().map(|volume| modulus_mpa / volume).collect();
        let pattern = Pattern::new(&elements, &parents, &coarse_tets, halves, &volume_stiffness);
        let coarse = CoarseSystem::new(&coarse_nodes_mm, &coarse_tets, &coarse_bonded, &volume_stiffness)?;

        let direct = (settings.linear == LinearSolver::Direct)
            .then(|| DirectSystem::new(&pattern))
            .transpose()?;

        let sources = |n_rows: usize, each: &dyn Fn(usize) -> Vec<(u32, u32)>| {
            let mut rows = vec![Vec::new(); n_rows];
            for tet in 0..coarse_tets.len() {
                for (row, source) in each(tet) {
                    rows[row as usize].push(source);
                }
            }
            let mut starts = vec![0];
            let mut all = Vec::new();
            for row in rows {
                all.extend(row);
                starts.push(all.len() as u32);
            }
            (starts, all)
        };
        let places = |nodes: &[u32], stride: usize, tet: usize| -> Vec<(u32, u32)> {
            let first = elements.slots[tet] * stride as u32;
            nodes
                .iter()
                .zip(first..)
                .map(|(&node, source)| (node, source))
                .collect()
        };
        let (force_starts, force_sources) =
            sources(mesh.nodes_mm.len(), &|tet| places(&parents[tet], NODES, tet));
        let (volume_starts, volume_sources) =
            sources(coarse_nodes_mm.len(), &|tet| places(&coarse_tets[tet], 4, tet));

        let shear_mpa = MPA_PER_KPA * material.model.shear_modulus_kpa();
        let node_stiffness = elements
            .node_stiffness_mm(mesh.nodes_mm.len())
            .iter()
            .map(|sum| shear_mpa * sum)
            .collect();
        let areas_mm2 = mesh.node_areas_mm2();
        let stiffness_mpa = settings.contact_stiffness * shear_mpa;
        let free = mesh
            .sets
            .free
            .iter()
            .filter(|&&node| areas_mm2[node as usize] > 0.0);
        let mut place_of = vec![None; mesh.nodes_mm.len()];
        let mut boundary_nodes = Vec::new();
        for (place, &node) in (0..).zip(free) {
            place_of[node as usize] = Some(place);
            // μ/h per area, with h² the area that belongs to the node.
            let edge_mm = areas_mm2[node as usize].sqrt();
            boundary_nodes.push(ContactPoint::of_node(node, stiffness_mpa * edge_mm));
        }
        let mut triangles = Vec::new();
        for nodes in mesh.boundary_triangles() {
            let free: Vec<u32> = nodes.iter().filter_map(|&node| place_of[node as usize]).collect();
            if !free.is_empty() {
                let at_mm = nodes.map(|node| mesh.nodes_mm[node as usize]);
                triangles.push(BoundaryTriangle::new(nodes, at_mm, free, stiffness_mpa));
            }
        }
        let boundary = Boundary::new(boundary_nodes, triangles);
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
            force_starts,
            force_sources,
            volume_starts,
            volume_sources,
            node_stiffness,
            size_mm,
            rest_factors: None,
        };
        body.rest_factors = rest_factors(&body);
        Ok(body)
    }

    /// Adds a rigid shape that stands still, best one without hollow corners: walls that meet are added one by one. States made before do not
    /// know it.
    #[must_use]
    pub fn with_obstacle(mut self, shape: Arc<dyn SignedDistance>, gel_from_obstacle: Pose) -> Self {
        self.obstacles.push((shape, gel_from_obstacle));
        self
    }

    /// Solves each step on two threads, of which the second is busy as long as a step takes: for one press that is waited for. Many presses
    /// at once had better take a thread each. The results are the same, bit for bit.
    #[must_use]
    pub fn on_two_threads(mut self) -> Self {
        self.on_two_threads = true;
        self
    }

    /// The mesh at rest: the finer one, numbered anew.
    #[must_use]
    pub fn mesh(&self) -> &TetMesh {
        &self.mesh
    }

    /// The material.
    #[must_use]
    pub fn material(&self) -> &Material {
        &self.material
    }

    /// Entries of the factors of the coarse linear system.
    #[must_use]
    pub fn n_factor_entries(&self) -> usize {
        self.coarse.n_factor_entries()
    }

    /// The body at rest, where it has been for ever.
    #[must_use]
    pub fn rest(&self) -> State {
        State {
            displacements_mm: vec![DVec3::ZERO; self.mesh.nodes_mm.len()],
            pressures_mpa: vec![0.0; self.volume_stiffness.len()],
            memory: Memory::new(self.elements.n_points(), &self.material.prony),
            contacts: std::iter::once(self.settings.friction)
                .chain(self.obstacles.iter().map(|_| self.settings.obstacle_friction))
                .map(|friction| Contact::new(self.boundary.nodes.len(), friction))
                .collect(),
            gel_from_indenter: None,
            last: None,
            stiffness_n_per_mm: None,
            sensitivities: Vec::new(),
            workspace: crate::newton::Workspace::default(),
        }
    }

    /// Hydrostatic pressure `-tr(σ)/3` at each node, kPa, positive in compression. `[n_nodes]`
    #[must_use]
    pub fn pressure_kpa(&self, state: &State) -> Vec<f64> {
        let now = Relaxation::new(&self.material.prony, 0.0);
        let response = self.response(&now, state);
        self.nodal_pressure_kpa(response, &state.displacements_mm, &state.pressures_mpa)
    }

    /// The same, of the parts of a state.
    pub(crate) fn nodal_pressure_kpa(
        &self,
        response: Response,
        displacements_mm: &[DVec3],
        pressures_mpa: &[f64],
    ) -> Vec<f64> {
        let shares = element::hydrostatic_shares(&self.elements, response, displacements_mm);
        // Averaged as the volume changes are that make the rest of the pressure.
        let pressures_mpa = shares.map_or(pressures_mpa.to_vec(), |shares| {
            let shares = shares.as_flattened();
            let modulus_mpa = MPA_PER_KPA * self.material.volume_modulus_kpa();
            let nodes = pressures_mpa.iter().zip(&self.volume_stiffness);
            nodes
                .zip(self.volume_starts.windows(2))
                .map(|((pressure, stiffness), range)| {
                    let sources = &self.volume_sources[range[0] as usize..range[1] as usize];
                    let share: f64 = sources.iter().map(|&source| shares[source as usize]).sum();
                    pressure + share * stiffness / modulus_mpa
                })
                .collect()
        });
        let at_kpa = |node: u32| pressures_mpa[node as usize] / MPA_PER_KPA;
        self.ends
            .iter()
            .map(|&[a, b]| 0.5 * (at_kpa(a) + at_kpa(b)))
            .collect()
    }

    /// What acts at a state: over a step of no time.
    pub(crate) fn response<'a>(&'a self, now: &'a Relaxation, state: &'a State) -> Response<'a> {
        Response {
            material: &self.material,
            relaxation: now,
            memory: &state.memory,
        }
    }

    /// Von Mises stress at each node, kPa, of the mean over the deformed volume of the tetrahedra around it of the Cauchy stress, its
    /// relaxing part included. `[n_nodes]`
    #[must_use]
    pub fn von_mises_kpa(&self, state: &State) -> Vec<f64> {
        let now = Relaxation::new(&self.material.prony, 0.0);
        let response = self.response(&now, state);
        element::mean_deviators(&self.elements, response, &state.displacements_mm)
            .into_iter()
            .map(|([xx, yy, zz, yz, xz, xy], volume)| {
                let square = xx * xx + yy * yy + zz * zz + 2.0 * (yz * yz + xz * xz + xy * xy);
                (1.5 * square).sqrt() / (MPA_PER_KPA * volume)
            })
            .collect()
    }

    /// The nodes of the boundary, and where they are, mm.
    pub(crate) fn boundary_mm(
        &self,
        displacements_mm: &[DVec3],
    ) -> impl Iterator<Item = (&ContactPoint, DVec3)> {
        let nodes = self.boundary.nodes.iter();
        nodes.map(|point| (point, self.point_mm(point, displacements_mm)))
    }

    /// Where a point of the boundary is, mm.
    #[inline]
    pub(crate) fn point_mm(&self, point: &ContactPoint, displacements_mm: &[DVec3]) -> DVec3 {
        point.value(&self.mesh.nodes_mm) + point.value(displacements_mm)
    }

    /// The pressures of each slot's corners, MPa.
    pub(crate) fn corner_pressures(&self, pressures_mpa: &[f64], corners: &mut Vec<[f64; 4]>) {
        corners.clear();
        let at = |node: u32| pressures_mpa[node as usize];
        corners.extend(self.slot_corners.iter().map(|corners| corners.map(at)));
    }

    /// Shear modulus times volume, N mm.
    pub(crate) fn energy_scale_n_mm(&self) -> f64 {
        MPA_PER_KPA * self.material.model.shear_modulus_kpa() * self.size_mm.powi(3)
    }

    /// Load that tolerances are at least relative to, N: that of a light touch. Where next to nothing presses, next to nothing matters.
    pub(crate) fn least_load_n(&self) -> f64 {
        let stress_kpa = LEAST_LOAD * self.material.model.shear_modulus_kpa();
        self.negligible_load_n()
            .max(MPA_PER_KPA * stress_kpa * self.size_mm * self.size_mm)
    }

    /// Loads below this count as none, N: far below what matters, above what round-off makes of a large bulk modulus.
    pub(crate) fn negligible_load_n(&self) -> f64 {
        let stress_kpa =
            1e-7 * self.material.model.shear_modulus_kpa() + 1e-9 * self.material.bulk_modulus_kpa;
        MPA_PER_KPA * stress_kpa * self.size_mm * self.size_mm
    }
}

/// The ten nodes of each coarse tetrahedron: its corners, then the midpoints of its edges.
fn parents(coarse_tets: &[[u32; 4]], ends: &[[u32; 2]]) -> Vec<[u32; NODES]> {
    let node_of: std::collections::HashMap<[u32; 2], u32> =
        ends.iter().zip(0..).map(|(&ends, node)| (ends, node)).collect();
    coarse_tets
        .iter()
        .map(|corners| {
            std::array::from_fn(|node| {
                let [a, b] = match node.checked_sub(4) {
                    Some(edge) => element::EDGES[edge].map(|corner| corners[corner as usize]),
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
