//! The radial basis functions of a map, and the linear system of their weights.

use crate::geometry::distance_mm;
use crate::{Kernel, MapError};

/// Smallest pivot of a matrix whose entries are of order one.
const SMALLEST_PIVOT: f64 = 1e-10;
/// If the taxels' spread from a line is smaller than this, they count as lying on a line; in
/// lengths of the kernel.
const ON_A_LINE: f64 = 1e-6;

/// The value at a distance in units of the kernel's length: the Gaussian's width, or for a thin
/// plate the pitch, which scales it well.
pub(crate) fn value(kernel: Kernel, distance: f64) -> f64 {
    match kernel {
        Kernel::Gaussian => (-0.5 * distance * distance).exp(),
        Kernel::ThinPlate if distance > 0.0 => distance * distance * distance.ln(),
        Kernel::ThinPlate => 0.0,
    }
}

/// A plane `a + b x + c y`. It has no bending energy.
pub(crate) type Plane = [f64; 3];

/// The planes in addition to the kernels: none for Gaussians. For a thin plate as many as the
/// taxels determine: fewer than three if they lie on a line.
pub(crate) fn planes(kernel: Kernel, taxels_mm: &[[f64; 2]], length_mm: f64) -> Vec<Plane> {
    let n = taxels_mm.len() as f64;
    if kernel == Kernel::Gaussian || taxels_mm.is_empty() {
        return Vec::new();
    }
    let mut planes = vec![[1.0, 0.0, 0.0]];
    // Gram-Schmidt: each coordinate, minus its part in the planes before it.
    for mut plane in [[0.0, 1.0 / length_mm, 0.0], [0.0, 0.0, 1.0 / length_mm]] {
        for known in &planes {
            let product = |one: &Plane, two: &Plane| -> f64 {
                taxels_mm
                    .iter()
                    .map(|&taxel| height(one, taxel) * height(two, taxel))
                    .sum()
            };
            let part = product(&plane, known) / product(known, known);
            plane = std::array::from_fn(|term| plane[term] - part * known[term]);
        }
        let spread: f64 = taxels_mm.iter().map(|&taxel| height(&plane, taxel).powi(2)).sum();
        if (spread / n).sqrt() > ON_A_LINE {
            planes.push(plane);
        }
    }
    planes
}

pub(crate) fn height(plane: &Plane, [x, y]: [f64; 2]) -> f64 {
    plane[0] + plane[1] * x + plane[2] * y
}

/// The linear system of weights and planes: kernels between the taxels, with `ridge` added to the
/// diagonal, bordered by the planes.
pub(crate) fn system(
    kernel: Kernel,
    taxels_mm: &[[f64; 2]],
    length_mm: f64,
    ridge: f64,
    planes: &[Plane],
) -> Vec<Vec<f64>> {
    let n = taxels_mm.len();
    let entry = |row: usize, column: usize| match (row < n, column < n) {
        (true, true) => {
            let between = value(kernel, distance_mm(taxels_mm[row], taxels_mm[column]) / length_mm);
            between + if row == column { ridge } else { 0.0 }
        }
        (true, false) => height(&planes[column - n], taxels_mm[row]),
        (false, true) => height(&planes[row - n], taxels_mm[column]),
        (false, false) => 0.0,
    };
    let size = n + planes.len();
    (0..size)
        .map(|row| (0..size).map(|column| entry(row, column)).collect())
        .collect()
}

/// The inverse of a small matrix by Gauss-Jordan elimination with row pivots.
pub(crate) fn inverse(mut matrix: Vec<Vec<f64>>) -> Result<Vec<Vec<f64>>, MapError> {
    let n = matrix.len();
    let mut inverse: Vec<Vec<f64>> = (0..n)
        .map(|row| (0..n).map(|column| f64::from(u8::from(row == column))).collect())
        .collect();
    for step in 0..n {
        let largest = (step..n).max_by(|&a, &b| matrix[a][step].abs().total_cmp(&matrix[b][step].abs()));
        let pivot_row = largest.unwrap_or(step);
        matrix.swap(step, pivot_row);
        inverse.swap(step, pivot_row);
        let pivot = matrix[step][step];
        if pivot.is_nan() || pivot.abs() < SMALLEST_PIVOT {
            return Err(MapError::Singular { pivot });
        }
        let [from_matrix, from_inverse] = [&matrix[step], &inverse[step]]
            .map(|row| row.iter().map(|entry| entry / pivot).collect::<Vec<f64>>());
        for row in (0..n).filter(|row| *row != step) {
            let factor = matrix[row][step];
            for (entry, from) in matrix[row].iter_mut().zip(&from_matrix) {
                *entry -= factor * from;
            }
            for (entry, from) in inverse[row].iter_mut().zip(&from_inverse) {
                *entry -= factor * from;
            }
        }
        (matrix[step], inverse[step]) = (from_matrix, from_inverse);
    }
    Ok(inverse)
}
