//! Blocks with nodes at given coordinates, for comparisons with closed forms and other programs.

use glam::DVec3;

use crate::TetMesh;

/// `n + 1` equally spaced values.
#[must_use]
pub fn even(from: f64, to: f64, n: usize) -> Vec<f64> {
    (0..=n)
        .map(|i| from + (to - from) * i as f64 / n as f64)
        .collect()
}

/// Values from 0 to `to`. Their spacing is `edge` up to `fine`, and grows by the factor `growth`
/// from there on.
#[must_use]
pub fn graded(edge: f64, fine: f64, growth: f64, to: f64) -> Vec<f64> {
    let mut values = vec![0.0];
    let (mut at, mut step) = (0.0, edge);
    while at < to {
        if at >= fine {
            step *= growth;
        }
        at += step;
        values.push(at);
    }
    // Scales the graded part so that the last value is `to`.
    let last = values[values.len() - 1];
    let scale_from = fine.min(to);
    for value in &mut values {
        if *value > scale_from {
            *value = scale_from + (*value - scale_from) * (to - scale_from) / (last - scale_from);
        }
    }
    values
}

/// The values, the first of which is 0, and their mirror images.
#[must_use]
pub fn mirrored(half: &[f64]) -> Vec<f64> {
    half.iter()
        .skip(1)
        .rev()
        .map(|x| -x)
        .chain(half.iter().copied())
        .collect()
}

/// A block of bricks between these lines, each cut into six tetrahedra. Its bottom is bonded.
#[must_use]
pub fn block(x_mm: &[f64], y_mm: &[f64], z_mm: &[f64]) -> TetMesh {
    let (nx, ny, nz) = (x_mm.len(), y_mm.len(), z_mm.len());
    let index = |i: usize, j: usize, k: usize| (i + nx * (j + ny * k)) as u32;
    let mut mesh = TetMesh::default();
    for z in z_mm {
        for y in y_mm {
            for x in x_mm {
                mesh.nodes_mm.push(DVec3::new(*x, *y, *z));
            }
        }
    }
    for k in 0..nz - 1 {
        for j in 0..ny - 1 {
            for i in 0..nx - 1 {
                for order in [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]] {
                    let mut corner = [i, j, k];
                    let mut tet = [index(i, j, k); 4];
                    for (step, axis) in order.into_iter().enumerate() {
                        corner[axis] += 1;
                        tet[step + 1] = index(corner[0], corner[1], corner[2]);
                    }
                    mesh.tets.push(tet);
                }
            }
        }
    }
    for tet in 0..mesh.tets.len() {
        if mesh.tet_volume_mm3(tet) < 0.0 {
            mesh.tets[tet].swap(2, 3);
        }
    }
    let bottom_mm = z_mm[0];
    bond(&mut mesh, |at| at.z == bottom_mm);
    mesh
}

/// Bonds the boundary nodes for which `is_bonded` holds, and no others; the rest of the boundary is
/// free.
pub fn bond(mesh: &mut TetMesh, is_bonded: impl Fn(DVec3) -> bool) {
    let bonded: Vec<bool> = mesh.nodes_mm.iter().map(|&at| is_bonded(at)).collect();
    mesh.name_nodes(|node| bonded[node as usize]);
}
