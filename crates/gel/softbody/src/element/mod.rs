//! The elements: tetrahedra with a linear pressure and displacements of twice the resolution.
//!
//! Every coarse tetrahedron has ten nodes, its corners and the midpoints of its edges. An element is a set of points inside it: how each
//! feels the nodes' displacements, and the corners' pressures. With volumes `V`, gradients `G` of the shape functions and `F = 1 + Σ u_a ⊗ G_a`
//! the energy is `Σ V W(F) + ½ Σ_c κ g_c²/m_c`: the volume change `g_c = Σ w_c V (J - 1)` of a corner `c`, its share `w_c` in each point,
//! and its volume `m_c = Σ w_c V`. Its pressure is `p_c = -κ g_c/m_c`, which is what is left of a mixed formulation whose mass matrix
//! of pressures is lumped.

mod composite;
mod deformation;
mod forces;
mod principal;
mod quadratic;
mod spectral;
mod stress;
mod table;
mod tangent;

use glam::{DMat3, DVec3};
use serde::{Deserialize, Serialize};
use twintac_material::{Law, Material, Model, Visitor};

use crate::relaxation::{Memory, Relaxation};
use crate::wide::{LANES, Wide};

pub(crate) use forces::{Forces, Volumes};
pub(crate) use stress::{hydrostatic_shares, mean_deviators, remember};
pub(crate) use table::{EDGES, Table};
pub(crate) use tangent::{CoarseSink, CoarseTangent, NodeBlock, NodeSlopes, Sink};

/// Nodes of a coarse tetrahedron: corners and midpoints.
pub(crate) const NODES: usize = 10;

/// How displacements vary between the nodes of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Element {
    /// Linearly, on the eight tetrahedra that each is cut into: fast, and robust.
    #[default]
    Composite,
    /// Quadratically on each tetrahedron: more accurate with the same nodes, for reference.
    Quadratic,
}

impl Element {
    fn table(self, nodes: &[u32; NODES], children: &[[u32; 4]; 8]) -> Table {
        match self {
            Self::Composite => composite::table(nodes, children),
            Self::Quadratic => quadratic::table(),
        }
    }
}

/// Eight coarse tetrahedra with the same table, side by side.
pub(crate) struct Pack {
    /// Which of the elements' tables is theirs.
    table: usize,
    nodes: [[u32; LANES]; NODES],
    /// Gradients of the barycentric coordinates of all corners but the first, 1/mm.
    gradients: [[Wide<f64>; 3]; 3],
    volume_mm3: Wide<f64>,
    /// Where its points' memory is.
    first_point: usize,
}

/// All elements of a body. Slot `8 i + l` is lane `l` of pack `i`; not all slots hold a tetrahedron.
pub(crate) struct Elements {
    pub(crate) tables: Vec<Table>,
    pub(crate) packs: Vec<Pack>,
    /// Where the packs of the first half end, and those of the second.
    pub(crate) halves: [usize; 2],
    /// The slot of each coarse tetrahedron.
    pub(crate) slots: Vec<u32>,
}

/// Which half of the body a coarse tetrahedron lies in with all its free nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Side {
    First,
    Second,
    Between,
}

/// Everything but the displacements that a point's stress depends on.
#[derive(Clone, Copy)]
pub(crate) struct Response<'a> {
    pub(crate) material: &'a Material,
    pub(crate) relaxation: &'a Relaxation,
    pub(crate) memory: &'a Memory,
}

/// Runs a kernel for a material's law, with the vectors that the processor has.
pub(crate) fn dispatch<K: LawKernel>(model: &Model, kernel: K) -> K::Output {
    model.visit(OnVectors(kernel))
}

/// Work on packs, to be made for each law.
pub(crate) trait LawKernel {
    type Output;

    fn run<L: Law>(self, law: L) -> Self::Output;
}

struct OnVectors<K>(K);

impl<K: LawKernel> Visitor for OnVectors<K> {
    type Output = K::Output;

    fn visit<L: Law>(self, law: L) -> K::Output {
        pulp::Arch::new().dispatch(WithLaw(self.0, law))
    }
}

struct WithLaw<K, L>(K, L);

impl<K: LawKernel, L: Law> pulp::NullaryFnOnce for WithLaw<K, L> {
    type Output = K::Output;

    #[inline(always)]
    fn call(self) -> K::Output {
        self.0.run(self.1)
    }
}

impl Elements {
    /// `parents` are the ten nodes of each coarse tetrahedron, `children` the eight tetrahedra that each is cut into, and `sides` says which
    /// half of the body it lies in.
    pub(crate) fn new(
        element: Element,
        nodes_mm: &[DVec3],
        parents: &[[u32; NODES]],
        children: &[[[u32; 4]; 8]],
        sides: &[Side],
    ) -> Self {
        let mut elements = Self {
            tables: Vec::new(),
            packs: Vec::new(),
            halves: [0; 2],
            slots: vec![0; parents.len()],
        };
        let table_of: Vec<usize> = parents
            .iter()
            .zip(children)
            .map(|(nodes, children)| {
                let table = element.table(nodes, children);
                let known = elements.tables.iter().position(|other| other.same_as(&table));
                known.unwrap_or_else(|| {
                    elements.tables.push(table);
                    elements.tables.len() - 1
                })
            })
            .collect();
        // Neighbours close to each other.
        let mut order: Vec<usize> = (0..parents.len()).collect();
        order.sort_by_key(|&parent| (sides[parent], table_of[parent], parents[parent].iter().min()));
        for same in order.chunk_by(|&a, &b| (sides[a], table_of[a]) == (sides[b], table_of[b])) {
            for eight in same.chunks(LANES) {
                for (lane, &parent) in eight.iter().enumerate() {
                    elements.slots[parent] = (elements.packs.len() * LANES + lane) as u32;
                }
                let first_point = elements.n_points();
                elements.packs.push(Pack::new(
                    table_of[eight[0]],
                    nodes_mm,
                    parents,
                    eight,
                    first_point,
                ));
            }
            match sides[same[0]] {
                Side::First => elements.halves = [elements.packs.len(); 2],
                Side::Second => elements.halves[1] = elements.packs.len(),
                Side::Between => (),
            }
        }
        elements
    }

    /// Points in all packs.
    pub(crate) fn n_points(&self) -> usize {
        self.packs
            .last()
            .map_or(0, |pack| pack.first_point + self.tables[pack.table].places.len())
    }

    /// The table of what is in a slot.
    pub(crate) fn table_of(&self, slot: u32) -> &Table {
        &self.tables[self.packs[slot as usize / LANES].table]
    }

    pub(crate) fn n_slots(&self) -> usize {
        self.packs.len() * LANES
    }

    /// Volume that belongs to each coarse corner of each slot, mm³.
    pub(crate) fn corner_volumes_mm3(&self) -> Vec<[f64; 4]> {
        let mut volumes_mm3 = Vec::with_capacity(self.n_slots());
        for pack in &self.packs {
            let mut shares = [0.0; 4];
            for place in &self.tables[pack.table].places {
                for (share, weight) in shares.iter_mut().zip(place.weights) {
                    *share += weight * place.volume;
                }
            }
            volumes_mm3.extend(
                pack.volume_mm3
                    .0
                    .map(|volume_mm3| shares.map(|share| share * volume_mm3)),
            );
        }
        volumes_mm3
    }

    /// `Σ V |G|²` of each node, mm.
    pub(crate) fn node_stiffness_mm(&self, n_nodes: usize) -> Vec<f64> {
        let mut sums = vec![0.0; n_nodes];
        for pack in &self.packs {
            for place in &self.tables[pack.table].places {
                let gradients = deformation::gradients(&pack.gradients, place);
                for (node, gradient) in place.nodes.iter().zip(&gradients) {
                    let square = deformation::dot(gradient, gradient) * pack.volume_mm3;
                    for lane in 0..LANES {
                        sums[pack.nodes[*node as usize][lane] as usize] += place.volume * square.0[lane];
                    }
                }
            }
        }
        sums
    }
}

impl Pack {
    /// The tetrahedra `members` of all `parents`.
    fn new(
        table: usize,
        nodes_mm: &[DVec3],
        parents: &[[u32; NODES]],
        members: &[usize],
        first_point: usize,
    ) -> Self {
        let mut pack = Self {
            table,
            nodes: [[0; LANES]; NODES],
            gradients: [[Wide::zero(); 3]; 3],
            volume_mm3: Wide::zero(),
            first_point,
        };
        for lane in 0..LANES {
            // Empty lanes repeat the first tetrahedron, with no volume.
            let parent = parents[*members.get(lane).unwrap_or(&members[0])];
            for (nodes, node) in pack.nodes.iter_mut().zip(parent) {
                nodes[lane] = node;
            }
            let corner = |corner: usize| nodes_mm[parent[corner] as usize];
            let edges = [1, 2, 3].map(|other| corner(other) - corner(0));
            let edges = DMat3::from_cols(edges[0], edges[1], edges[2]);
            let inverse = edges.inverse();
            for k in 0..3 {
                for i in 0..3 {
                    pack.gradients[k][i].0[lane] = inverse.row(k)[i];
                }
            }
            if lane < members.len() {
                pack.volume_mm3.0[lane] = edges.determinant().abs() / 6.0;
            }
        }
        pack
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a test that cannot set itself up has failed
mod tests;
