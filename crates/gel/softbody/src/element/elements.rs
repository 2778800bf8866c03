//! The elements of a body, in packs of eight tetrahedra.

use std::ops::Range;

use glam::{DMat3, DVec3};
use serde::{Deserialize, Serialize};

use super::deformation::{self, Vector};
use super::table::{NODES, Table};
use super::{composite, layered, quadratic};
use crate::wide::{LANES, Wide};

/// How displacements vary between the nodes of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Element {
    /// Composite, and mostly quadratic in the tetrahedra with bonded nodes, where stresses change
    /// fastest: more accurate pressures there than composite, and a little slower.
    #[default]
    Layered,
    /// Linear on each of the eight tetrahedra that a coarse one is cut into: fast and robust.
    Composite,
    /// Mostly quadratic on all tetrahedra, for meshes that are fine at the rims of an indenter:
    /// more accurate there than layered, but a frame takes half as long again or longer.
    Blended,
    /// Quadratic on each tetrahedron: a little more accurate, but deep presses end early, because
    /// tetrahedra would turn inside out; used as a reference.
    Quadratic,
}

impl Element {
    fn table(self, nodes: &[u32; NODES], children: &[[u32; 4]; 8], is_bonded: [bool; 4]) -> Table {
        match self {
            Self::Layered if is_bonded.contains(&true) => {
                Table::new(layered::points(nodes, children, is_bonded), Vec::new())
            }
            Self::Layered | Self::Composite => composite::table(nodes, children),
            Self::Blended => {
                let points = layered::points(nodes, children, [true; 4]);
                Table::new(points, quadratic::corners().collect())
            }
            Self::Quadratic => quadratic::table(),
        }
    }

    /// Part of the composite element in the energy at bonded nodes.
    pub(crate) fn flat_share(self) -> f64 {
        match self {
            Self::Layered | Self::Blended => layered::FLAT_SHARE,
            Self::Composite => 1.0,
            Self::Quadratic => 0.0,
        }
    }
}

/// Eight coarse tetrahedra with the same table, side by side.
pub(crate) struct Pack {
    /// Index of their table.
    pub(super) table: usize,
    pub(super) nodes: [[u32; LANES]; NODES],
    /// Gradients of the barycentric coordinates of all corners except for the first, 1/mm.
    pub(super) gradients: [[Wide<f64>; 3]; 3],
    pub(super) volume_mm3: Wide<f64>,
    /// Index of their first quadrature point, for the history variables.
    pub(super) first_point: usize,
}

/// All elements of a body. Slot `8 i + l` is lane `l` of pack `i`; not every slot has a
/// tetrahedron.
pub(crate) struct Elements {
    pub(crate) tables: Vec<Table>,
    pub(crate) packs: Vec<Pack>,
    /// End of the packs of the first half, and of the second.
    pub(crate) halves: [usize; 2],
    /// The slot of each coarse tetrahedron.
    pub(crate) slots: Vec<u32>,
}

/// The half of the body that contains all free nodes of a coarse tetrahedron.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Side {
    First,
    Second,
    Between,
}

impl Elements {
    /// `parents` are the ten nodes of each coarse tetrahedron, `children` the eight tetrahedra that
    /// it is cut into, and `sides` the half of the body that it is in; `bonded` nodes are sorted.
    pub(crate) fn new(
        element: Element,
        nodes_mm: &[DVec3],
        bonded: &[u32],
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
                let is_bonded = [0, 1, 2, 3].map(|corner| bonded.binary_search(&nodes[corner]).is_ok());
                let table = element.table(nodes, children, is_bonded);
                let known = elements.tables.iter().position(|other| other.same_as(&table));
                known.unwrap_or_else(|| {
                    elements.tables.push(table);
                    elements.tables.len() - 1
                })
            })
            .collect();
        // Neighbours are close to each other in this order.
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

    /// Number of points in all packs.
    pub(crate) fn n_points(&self) -> usize {
        self.packs
            .last()
            .map_or(0, |pack| pack.first_point + self.tables[pack.table].points.len())
    }

    /// The table of the tetrahedron in a slot.
    pub(crate) fn table_of(&self, slot: u32) -> &Table {
        &self.tables[self.packs[slot as usize / LANES].table]
    }

    /// The ten nodes of the tetrahedron in a slot.
    pub(crate) fn nodes_of(&self, slot: usize) -> impl Iterator<Item = u32> {
        let pack = &self.packs[slot / LANES];
        pack.nodes.iter().map(move |lanes| lanes[slot % LANES])
    }

    /// The packs with one of these nodes, as ranges.
    pub(crate) fn packs_with(&self, is_one: &dyn Fn(u32) -> bool) -> Vec<Range<usize>> {
        let has_one = |pack: &Pack| pack.nodes.as_flattened().iter().any(|&node| is_one(node));
        let mut ranges: Vec<Range<usize>> = Vec::new();
        for (index, _) in self.packs.iter().enumerate().filter(|(_, pack)| has_one(pack)) {
            match ranges.last_mut() {
                Some(range) if range.end == index => range.end += 1,
                _ => ranges.push(index..index + 1),
            }
        }
        ranges
    }

    pub(crate) fn n_slots(&self) -> usize {
        self.packs.len() * LANES
    }

    /// Volume of each coarse corner of each slot, mm³.
    pub(crate) fn corner_volumes_mm3(&self) -> Vec<[f64; 4]> {
        let mut volumes_mm3 = Vec::with_capacity(self.n_slots());
        for pack in &self.packs {
            let mut shares = [0.0; 4];
            for point in &self.tables[pack.table].points {
                for (share, weight) in shares.iter_mut().zip(point.weights) {
                    *share += weight * point.volume;
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

    /// `Σ V |G|²` for each node, mm.
    pub(crate) fn node_stiffness_mm(&self, n_nodes: usize) -> Vec<f64> {
        let mut sums = vec![0.0; n_nodes];
        for pack in &self.packs {
            for point in &self.tables[pack.table].points {
                let gradients = deformation::gradients(&pack.gradients, point);
                for (node, gradient) in point.nodes.iter().zip(&gradients) {
                    let square = deformation::dot(gradient, gradient) * pack.volume_mm3;
                    for lane in 0..LANES {
                        sums[pack.nodes[*node as usize][lane] as usize] += point.volume * square.0[lane];
                    }
                }
            }
        }
        sums
    }
}

impl Pack {
    /// The displacements of the ten nodes.
    #[inline(always)]
    pub(super) fn gather(&self, displacements_mm: &[DVec3]) -> [Vector<f64>; NODES] {
        let mut ten = [[Wide([0.0; LANES]); 3]; NODES];
        for (out, nodes) in ten.iter_mut().zip(&self.nodes) {
            for lane in 0..LANES {
                let u = displacements_mm[nodes[lane] as usize];
                out[0].0[lane] = u.x;
                out[1].0[lane] = u.y;
                out[2].0[lane] = u.z;
            }
        }
        ten
    }

    /// A pack of the tetrahedra `members` of all `parents`.
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
            // Empty lanes repeat the first tetrahedron, without volume.
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
