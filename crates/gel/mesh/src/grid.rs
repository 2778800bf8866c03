//! Meshes of blocks and domes: a bent tensor grid whose hexahedra are cut into six tetrahedra each.
//!
//! Each hexahedron is cut along the diagonal from its lower corner nearest to the mirror lines
//! (through the centre of contact) to its upper corner farthest from them (Kuhn's subdivision).
//! Every hexahedron of a quadrant is cut in the same way. All inner nodes then have the same
//! neighbours and all surface nodes the same share of area, which contact forces and nodal
//! pressures need. Alternating cuts into five tetrahedra would give better angles, but two kinds of
//! nodes, one with twice the area of the other.
//!
//! The four quadrants mirror each other, so a centred press of a symmetric gel stays symmetric. The
//! diagonals end in the top edges, which can then be rounded: a cut across a rounded edge would
//! leave flat tetrahedra.

use crate::footprint::Footprint;
use crate::lattice::Lattice;
use crate::{Cuboid, MeshError, MeshSettings, TetMesh};

/// The paths along the edges of a cube from one corner to the opposite one, as the order of axes,
/// with their signs.
const PATHS: [([usize; 3], bool); 6] = [
    ([0, 1, 2], true),
    ([1, 2, 0], true),
    ([2, 0, 1], true),
    ([0, 2, 1], false),
    ([2, 1, 0], false),
    ([1, 0, 2], false),
];

/// The lattice of a block or dome, in the coordinates of its box before bending.
pub(crate) fn lattice(
    footprint: &Footprint,
    inclusions: &[Cuboid],
    settings: &MeshSettings,
) -> Result<Lattice, MeshError> {
    let tallest_mm = inclusions
        .iter()
        .fold(0.0, |top: f64, inclusion| top.max(inclusion.max_mm.z));
    for (index, inclusion) in inclusions.iter().enumerate() {
        inclusion.check(index, footprint.box_mm, footprint.full_height_mm())?;
    }
    let mut settings = settings.clone();
    for focus in &mut settings.focuses {
        focus.center_mm = footprint.unbend_mm(focus.center_mm, tallest_mm);
    }
    // A tetrahedron that is cut across a rounded edge would be flat.
    Lattice::new(
        footprint.box_mm,
        inclusions,
        &settings,
        footprint.edge_radius_mm(),
    )
}

/// Cuts a lattice into tetrahedra, and bends it into the solid.
pub(crate) fn mesh(footprint: &Footprint, lattice: &Lattice) -> TetMesh {
    let [nx, ny, nz] = lattice.points();
    let index = |[i, j, k]: [usize; 3]| (k * ny + j) * nx + i;
    let (n_nodes, numbers) = number_nodes(lattice);
    let mut mesh = TetMesh {
        nodes_mm: Vec::with_capacity(n_nodes),
        ..TetMesh::default()
    };
    let mut bonded = Vec::with_capacity(n_nodes);
    let base_mm = lattice.inclusion_top_mm();
    for k in 0..nz {
        for j in 0..ny {
            for i in 0..nx {
                if numbers[index([i, j, k])] != u32::MAX {
                    mesh.nodes_mm
                        .push(footprint.bend_mm(lattice.position_mm([i, j, k]), base_mm));
                    bonded.push(lattice.is_bonded([i, j, k]));
                }
            }
        }
    }
    for cell in cells(lattice) {
        for_each_tet(lattice, cell, |points| {
            mesh.tets.push(points.map(|point| numbers[index(point)]))
        });
    }
    mesh.name_nodes(|node| bonded[node as usize]);
    mesh
}

/// Cells outside of inclusions.
fn cells(lattice: &Lattice) -> impl Iterator<Item = [usize; 3]> {
    let [nx, ny, nz] = lattice.points();
    (0..nz - 1)
        .flat_map(move |k| (0..ny - 1).flat_map(move |j| (0..nx - 1).map(move |i| [i, j, k])))
        .filter(|&cell| !lattice.is_inclusion(cell))
}

/// Numbers the lattice points that belong to a cell. Returns how many there are, and the number of
/// each (`u32::MAX` without a cell).
pub(crate) fn number_nodes(lattice: &Lattice) -> (usize, Vec<u32>) {
    let [nx, ny, nz] = lattice.points();
    let mut numbers = vec![u32::MAX; nx * ny * nz];
    for [i, j, k] in cells(lattice) {
        for corner in 0..8 {
            let (i, j, k) = (i + (corner & 1), j + (corner >> 1 & 1), k + (corner >> 2));
            numbers[(k * ny + j) * nx + i] = 0;
        }
    }
    let mut n_nodes = 0;
    for number in numbers.iter_mut().filter(|number| **number == 0) {
        *number = n_nodes;
        n_nodes += 1;
    }
    (n_nodes as usize, numbers)
}

/// Calls `put` with the corners of the six tetrahedra of a cell, each of positive volume.
fn for_each_tet(lattice: &Lattice, cell: [usize; 3], mut put: impl FnMut([[usize; 3]; 4])) {
    let mirrored = [cell[0] < lattice.x.mirror, cell[1] < lattice.y.mirror, false];
    let flips = mirrored[0] != mirrored[1];
    for (path, even) in PATHS {
        let mut at = [0, 1, 2].map(|axis| cell[axis] + usize::from(mirrored[axis]));
        let mut corners = [at; 4];
        for (step, axis) in path.into_iter().enumerate() {
            at[axis] = if mirrored[axis] {
                at[axis] - 1
            } else {
                at[axis] + 1
            };
            corners[step + 1] = at;
        }
        if even == flips {
            corners.swap(2, 3);
        }
        put(corners);
    }
}
