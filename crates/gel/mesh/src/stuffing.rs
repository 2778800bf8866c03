//! Meshes of triangle surfaces by isosurface stuffing (Labelle & Shewchuk 2007, "Isosurface
//! stuffing: fast tetrahedral meshes with good dihedral angles").
//!
//! A body-centred lattice fills the box of the surface. Lattice points close to where the surface
//! cuts their edges are moved onto the surface; of the tetrahedra that are still cut, the inner
//! part is kept. Here the lattice is also graded to be fine where the settings require it, and it
//! ends at the board: the tetrahedra there are halves, and their points move within the plane of
//! the board only.

use std::collections::BTreeSet;

use glam::DVec3;

use crate::lattice::Lattice;
use crate::region::Region;
use crate::stencil::{Side, inner_part};
use crate::{MeshError, TetMesh};

/// A lattice point moves to a cut that is nearer than this fraction of the edge (section 4.1 of the
/// paper): long edges, short edges.
const TOO_NEAR: [f64; 2] = [0.24999, 0.41189];

/// The lattice's points and tetrahedra.
struct Background {
    points_mm: Vec<DVec3>,
    on_board: Vec<bool>,
    is_center: Vec<bool>,
    tets: Vec<[u32; 4]>,
}

/// Meshes the interior of a region. The lattice covers the box of the region.
pub(crate) fn mesh(lattice: &Lattice, region: &Region) -> Result<TetMesh, MeshError> {
    let mut background = background(lattice);
    let mut sides: Vec<Side> = background
        .points_mm
        .iter()
        .map(|&point| region.side(point))
        .collect();
    let edges = cut_edges(&background.tets, &sides);
    let cuts_mm: Vec<DVec3> = edges
        .iter()
        .map(|&edge| cut_mm(&background, &sides, region, edge))
        .collect();
    move_points(&mut background, &mut sides, region, &edges, &cuts_mm);

    let n_points = background.points_mm.len() as u32;
    let mut positions_mm = background.points_mm.clone();
    positions_mm.extend(&cuts_mm);
    let mut centers_mm = Vec::new();
    let first_center = positions_mm.len() as u32;
    let mut tets = Vec::new();
    for nodes in &background.tets {
        let cut = |a: usize, b: usize| {
            let edge = [nodes[a].min(nodes[b]), nodes[a].max(nodes[b])];
            let place = edges
                .binary_search(&edge)
                .expect("every edge from inside to outside was cut; moving points leaves fewer of them");
            (n_points + place as u32, cuts_mm[place])
        };
        let center = |center_mm: DVec3| {
            centers_mm.push(center_mm);
            (first_center + centers_mm.len() as u32 - 1, center_mm)
        };
        let corners = nodes.map(|node| (node, background.points_mm[node as usize]));
        inner_part(
            corners,
            nodes.map(|node| sides[node as usize]),
            cut,
            center,
            &mut tets,
        );
    }
    positions_mm.extend(centers_mm);
    let mut mesh = without_unused(&positions_mm, tets)?;
    let bonded: Vec<bool> = mesh.nodes_mm.iter().map(|&node| region.is_bonded(node)).collect();
    mesh.name_nodes(|node| bonded[node as usize]);
    Ok(mesh)
}

/// The body-centred lattice: one cell wider than the given one on all sides except at the board.
fn background(lattice: &Lattice) -> Background {
    let [nx, ny, nz] = lattice.points();
    let size = [nx + 2, ny + 2, nz + 1];
    let corner = |[i, j, k]: [usize; 3]| (k * size[1] + j) * size[0] + i;
    let n_corners = size[0] * size[1] * size[2];
    let cell = |[i, j, k]: [usize; 3]| n_corners + (k * (size[1] - 1) + j) * (size[0] - 1) + i;
    let mut points_mm = Vec::new();
    for index in 0..n_corners {
        let [i, j, k] = [
            index % size[0],
            index / size[0] % size[1],
            index / (size[0] * size[1]),
        ];
        points_mm.push(outer_position_mm(lattice, [i, j, k]));
    }
    let cells = || {
        let [cx, cy, cz] = size.map(|n| n - 1);
        (0..cz).flat_map(move |k| (0..cy).flat_map(move |j| (0..cx).map(move |i| [i, j, k])))
    };
    let around = |[i, j, k]: [usize; 3]| {
        [0, 1, 2, 3, 4, 5, 6, 7].map(|c| [i + (c & 1), j + (c >> 1 & 1), k + (c >> 2)])
    };
    for at in cells() {
        let sum: DVec3 = around(at).iter().map(|&c| points_mm[corner(c)]).sum();
        points_mm.push(sum / 8.0);
    }
    let n_with_cells = points_mm.len();
    let mut tets = Vec::new();
    // The four tetrahedra around the line between two neighbours: cell centres, or the centre of a
    // cell and the middle of its face on the board.
    let mut ring = |ends: [usize; 2], face: [[usize; 3]; 4]| {
        for side in 0..4 {
            let [p, q] = [face[side], face[(side + 1) % 4]].map(&corner);
            tets.push([ends[0] as u32, ends[1] as u32, p as u32, q as u32]);
        }
    };
    for at @ [i, j, k] in cells() {
        for axis in 0..3 {
            let mut next = at;
            next[axis] += 1;
            if next[axis] + 1 < size[axis] {
                let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
                let shifted = |du: usize, dv: usize| {
                    let mut c = next;
                    c[u] += du;
                    c[v] += dv;
                    c
                };
                ring(
                    [cell(at), cell(next)],
                    [shifted(0, 0), shifted(1, 0), shifted(1, 1), shifted(0, 1)],
                );
            }
        }
        if k == 0 {
            let face = [[i, j, 0], [i + 1, j, 0], [i + 1, j + 1, 0], [i, j + 1, 0]];
            let middle: DVec3 = face.iter().map(|&c| points_mm[corner(c)]).sum::<DVec3>() / 4.0;
            ring([points_mm.len(), cell(at)], face);
            points_mm.push(middle);
        }
    }
    let on_board = (0..points_mm.len())
        .map(|p| p < size[0] * size[1] || p >= n_with_cells)
        .collect();
    let is_center = (0..points_mm.len()).map(|p| p >= n_corners).collect();
    Background {
        points_mm,
        on_board,
        is_center,
        tets,
    }
}

/// Position of a lattice point, whose index starts one cell outside of the given lattice in x and
/// y.
fn outer_position_mm(lattice: &Lattice, [i, j, k]: [usize; 3]) -> DVec3 {
    let [nx, ny, nz] = lattice.points();
    let inner = [i.clamp(1, nx) - 1, j.clamp(1, ny) - 1, k.min(nz - 1)];
    let at = |point| lattice.position_mm(point);
    let mut position_mm = at(inner);
    let wider = [
        (i == 0) as i8 - (i == nx + 1) as i8,
        (j == 0) as i8 - (j == ny + 1) as i8,
        -((k == nz) as i8),
    ];
    for (axis, side) in wider.into_iter().enumerate() {
        let mut inward = inner;
        match side {
            1 => inward[axis] += 1,
            -1 => inward[axis] -= 1,
            _ => continue,
        }
        position_mm[axis] += at(inner)[axis] - at(inward)[axis];
    }
    position_mm
}

/// Edges between a point inside and one outside, sorted.
fn cut_edges(tets: &[[u32; 4]], sides: &[Side]) -> Vec<[u32; 2]> {
    let mut edges = Vec::new();
    for nodes in tets {
        for (a, b) in [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)] {
            let edge = [nodes[a].min(nodes[b]), nodes[a].max(nodes[b])];
            let [from, to] = edge.map(|node| sides[node as usize]);
            if matches!(
                (from, to),
                (Side::Inside, Side::Outside) | (Side::Outside, Side::Inside)
            ) {
                edges.push(edge);
            }
        }
    }
    edges.sort_unstable();
    edges.dedup();
    edges
}

fn cut_mm(background: &Background, sides: &[Side], region: &Region, [a, b]: [u32; 2]) -> DVec3 {
    let [a_mm, b_mm] = [a, b].map(|node| background.points_mm[node as usize]);
    if sides[a as usize] == Side::Inside {
        region.cut_mm(a_mm, b_mm)
    } else {
        region.cut_mm(b_mm, a_mm)
    }
}

/// Moves lattice points onto cuts that are too near to them.
fn move_points(
    background: &mut Background,
    sides: &mut [Side],
    region: &Region,
    edges: &[[u32; 2]],
    cuts_mm: &[DVec3],
) {
    // The cut edges of each point, nearest cut (relative to the length of the edge) first.
    let mut near: BTreeSet<(u32, u64, usize)> = BTreeSet::new();
    for (place, &[a, b]) in edges.iter().enumerate() {
        let [a_mm, b_mm] = [a, b].map(|node| background.points_mm[node as usize]);
        let is_short = background.is_center[a as usize] != background.is_center[b as usize];
        for (node, node_mm) in [(a, a_mm), (b, b_mm)] {
            let share = cuts_mm[place].distance(node_mm) / a_mm.distance(b_mm);
            if share < TOO_NEAR[usize::from(is_short)] {
                // The bits of positive numbers have the same order as the numbers.
                near.insert((node, share.to_bits(), place));
            }
        }
    }
    let reach_mm = board_reach_mm(background);
    for (node, _, place) in near {
        let [a, b] = edges[place];
        let other = if node == a { b } else { a };
        let node = node as usize;
        // An edge is no longer cut once one of its ends has moved onto the surface.
        if sides[node] == Side::On || sides[other as usize] == Side::On {
            continue;
        }
        let cut_mm = cuts_mm[place];
        // Faces of inclusions are planes of the lattice, so points need not move onto them.
        if region.is_on_inclusion(cut_mm) {
            continue;
        }
        if !background.on_board[node] || background.on_board[other as usize] {
            background.points_mm[node] = cut_mm;
        } else {
            let level_mm = cut_mm.with_z(background.points_mm[node].z);
            let foot = region.level_foot_mm(level_mm);
            let Some(foot_mm) =
                foot.filter(|foot| foot.distance(background.points_mm[node]) <= reach_mm[node])
            else {
                continue;
            };
            background.points_mm[node] = foot_mm;
        }
        sides[node] = Side::On;
    }
}

/// How far points may move along the board, mm: three of them that move onto a wall must not become
/// collinear.
fn board_reach_mm(background: &Background) -> Vec<f64> {
    let mut reach_mm = vec![f64::INFINITY; background.points_mm.len()];
    for nodes in &background.tets {
        // The last two are corners of the same cell.
        let [p, q] = [nodes[2], nodes[3]].map(|node| node as usize);
        if background.on_board[p] && background.on_board[q] {
            let side_mm = background.points_mm[p].distance(background.points_mm[q]);
            for &node in nodes {
                let reach = &mut reach_mm[node as usize];
                *reach = reach.min(0.2 * side_mm);
            }
        }
    }
    reach_mm
}

/// A mesh of the nodes that are used, numbered in the order of the positions.
fn without_unused(positions_mm: &[DVec3], mut tets: Vec<[u32; 4]>) -> Result<TetMesh, MeshError> {
    if tets.is_empty() {
        return Err(MeshError::Empty {
            reason: "the surface holds no cell of the lattice".to_owned(),
        });
    }
    let mut numbers = vec![u32::MAX; positions_mm.len()];
    tets.iter().flatten().for_each(|&node| numbers[node as usize] = 0);
    let mut mesh = TetMesh::default();
    for (number, &position_mm) in numbers
        .iter_mut()
        .zip(positions_mm)
        .filter(|(number, _)| **number == 0)
    {
        *number = mesh.nodes_mm.len() as u32;
        mesh.nodes_mm.push(position_mm);
    }
    tets.iter_mut()
        .flatten()
        .for_each(|node| *node = numbers[*node as usize]);
    mesh.tets = tets;
    Ok(mesh)
}
