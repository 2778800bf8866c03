//! The order of the unknowns: two halves that do not touch each other, and the nodes between them.
//!
//! The halves can be worked on at the same time. A coarse node belongs to the half on its side of a
//! plane across the longest axis of the body. A fine node belongs to a half if all coarse
//! tetrahedra around it have their corners there; otherwise it is between the halves.

use glam::DVec3;
use twintac_mesh::{NodeSets, Refinement, TetMesh};

use crate::element::Side;

/// Numbers of nodes in the halves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Halves {
    /// Number of coarse nodes of the first half.
    pub(crate) coarse: usize,
    /// Number of free fine nodes of the first half.
    pub(crate) first: usize,
    /// Number of free fine nodes of both halves.
    pub(crate) both: usize,
    /// Number of free fine nodes.
    pub(crate) free: usize,
}

impl Halves {
    /// The half that an element with these nodes is in.
    pub(crate) fn side(&self, nodes: &[u32]) -> Side {
        let mut free = nodes
            .iter()
            .map(|&node| node as usize)
            .filter(|&node| node < self.free);
        let in_first = |node: usize| node < self.first;
        if free.clone().all(in_first) {
            Side::First
        } else if free.all(|node| !in_first(node) && node < self.both) {
            Side::Second
        } else {
            Side::Between
        }
    }
}

/// A mesh and its refinement, both numbered by halves.
pub(crate) struct Numbered {
    /// The fine mesh: free nodes of the first half, of the second half, and between them, followed
    /// by bonded nodes.
    pub(crate) mesh: TetMesh,
    /// Positions of the coarse nodes in the undeformed state, mm.
    pub(crate) coarse_nodes_mm: Vec<DVec3>,
    /// Whether a coarse node is bonded.
    pub(crate) coarse_bonded: Vec<bool>,
    /// Corners of the coarse tetrahedra.
    pub(crate) coarse_tets: Vec<[u32; 4]>,
    /// The two coarse nodes that each fine node is midway between; twice the same for a coarse
    /// node.
    pub(crate) ends: Vec<[u32; 2]>,
    pub(crate) halves: Halves,
}

/// Numbers a mesh that has been checked.
pub(crate) fn number(mesh: &TetMesh) -> Numbered {
    let coarse_order = by_sides(&mesh.nodes_mm);
    let n_first_coarse = coarse_order.1;
    let new_coarse = inverse(&coarse_order.0);
    let coarse = renumbered(mesh, &coarse_order.0, &new_coarse);
    let refinement = coarse.refined();
    let class = classes(&refinement, n_first_coarse);
    let order = by_classes(&class, &refinement.mesh.nodes_mm);
    let count = |up_to: u8| class.iter().filter(|&&class| class <= up_to).count();
    let halves = Halves {
        coarse: n_first_coarse,
        first: count(0),
        both: count(1),
        free: count(2),
    };
    let new = inverse(&order);
    let ends = order
        .iter()
        .map(
            |&node| match (node as usize).checked_sub(refinement.n_coarse_nodes) {
                Some(midpoint) => refinement.midpoints[midpoint],
                None => [node; 2],
            },
        )
        .collect();
    let fine = renumbered(&refinement.mesh, &order, &new);
    let mut coarse_bonded = vec![false; coarse.nodes_mm.len()];
    coarse
        .sets
        .bonded
        .iter()
        .for_each(|&node| coarse_bonded[node as usize] = true);
    Numbered {
        mesh: fine,
        coarse_nodes_mm: coarse.nodes_mm,
        coarse_bonded,
        coarse_tets: refinement.coarse_tets,
        ends,
        halves,
    }
}

/// A mesh with its nodes in another order; `new` has the new index of each node.
fn renumbered(mesh: &TetMesh, order: &[u32], new: &[u32]) -> TetMesh {
    let renumber = |nodes: &[u32]| {
        let mut nodes: Vec<u32> = nodes.iter().map(|&node| new[node as usize]).collect();
        nodes.sort_unstable();
        nodes
    };
    TetMesh {
        nodes_mm: order.iter().map(|&node| mesh.nodes_mm[node as usize]).collect(),
        tets: mesh
            .tets
            .iter()
            .map(|nodes| nodes.map(|node| new[node as usize]))
            .collect(),
        sets: NodeSets {
            bonded: renumber(&mesh.sets.bonded),
            free: renumber(&mesh.sets.free),
            top: renumber(&mesh.sets.top),
        },
    }
}

/// The class of each fine node: 0 and 1 for the halves, 2 between them, 3 for bonded nodes.
fn classes(refinement: &Refinement, n_first_coarse: usize) -> Vec<u8> {
    let mut class = vec![u8::MAX; refinement.mesh.nodes_mm.len()];
    for (tet, nodes) in refinement.mesh.tets.iter().enumerate() {
        let corners = refinement.coarse_tets[tet / 8];
        let n_low = corners.iter().filter(|&&c| (c as usize) < n_first_coarse).count();
        let of_tet = match n_low {
            4 => 0,
            0 => 1,
            _ => 2,
        };
        for &node in nodes {
            let class = &mut class[node as usize];
            *class = if *class == u8::MAX || *class == of_tet {
                of_tet
            } else {
                2
            };
        }
    }
    for &node in &refinement.mesh.sets.bonded {
        class[node as usize] = 3;
    }
    class
}

/// The fine nodes by class, and by position within each class.
fn by_classes(class: &[u8], nodes_mm: &[DVec3]) -> Vec<u32> {
    let mut order: Vec<u32> = (0..nodes_mm.len() as u32).collect();
    order.sort_by_key(|&node| {
        let at = nodes_mm[node as usize];
        (
            class[node as usize],
            ordered(at.x),
            ordered(at.y),
            ordered(at.z),
            node,
        )
    });
    order
}

/// The nodes, sorted by their side of a plane across the longest axis, and the number of nodes on
/// the first side.
fn by_sides(nodes_mm: &[DVec3]) -> (Vec<u32>, usize) {
    let bound = |f: fn(DVec3, DVec3) -> DVec3| nodes_mm.iter().copied().reduce(f).unwrap_or_default();
    let size_mm = bound(DVec3::max) - bound(DVec3::min);
    let axis = if size_mm.x >= size_mm.y && size_mm.x >= size_mm.z {
        0
    } else if size_mm.y >= size_mm.z {
        1
    } else {
        2
    };
    let mut along: Vec<f64> = nodes_mm.iter().map(|node| node[axis]).collect();
    along.sort_by(f64::total_cmp);
    // Slightly below the middle, so that no plane of nodes is divided.
    let cut_mm = along[along.len() / 2] - 1e-9 * size_mm[axis];
    let is_low = |node: u32| nodes_mm[node as usize][axis] < cut_mm;
    let mut order: Vec<u32> = (0..nodes_mm.len() as u32).collect();
    order.sort_by_key(|&node| {
        let at = nodes_mm[node as usize];
        (!is_low(node), ordered(at.x), ordered(at.y), ordered(at.z), node)
    });
    let n_low = order.iter().filter(|&&node| is_low(node)).count();
    (order, n_low)
}

/// A number that sorts like a coordinate, without its round-off.
fn ordered(coordinate_mm: f64) -> i64 {
    (coordinate_mm * 1e6).round() as i64
}

fn inverse(order: &[u32]) -> Vec<u32> {
    let mut new = vec![0; order.len()];
    for (position, &node) in order.iter().enumerate() {
        new[node as usize] = position as u32;
    }
    new
}
