//! Positions in the gel's plane.

/// A rectangle along the axes in the gel's plane, mm.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rectangle {
    /// Corner with the smallest x and y, mm.
    pub min_mm: [f64; 2],
    /// Corner with the largest x and y, mm.
    pub max_mm: [f64; 2],
}

/// The mean distance from a taxel to its nearest neighbour, mm; 8 if there are fewer than two
/// taxels.
pub fn pitch_mm(taxels_mm: &[[f64; 2]]) -> f64 {
    const ALONE_MM: f64 = 8.0;
    let nearest = |index: usize| {
        let others = taxels_mm.iter().enumerate().filter(|&(other, _)| other != index);
        others
            .map(|(_, &other)| distance_mm(taxels_mm[index], other))
            .fold(f64::INFINITY, f64::min)
    };
    let distances: Vec<f64> = (0..taxels_mm.len())
        .map(nearest)
        .filter(|distance| distance.is_finite() && *distance > 0.0)
        .collect();
    if distances.is_empty() {
        ALONE_MM
    } else {
        distances.iter().sum::<f64>() / distances.len() as f64
    }
}

pub(crate) fn distance_mm(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

pub(crate) fn finite_or_zero(value: f64) -> f64 {
    if value.is_finite() { value } else { 0.0 }
}

/// The centres of a grid's cells, row by row.
pub(crate) fn cells(rectangle: Rectangle, [columns, rows]: [usize; 2]) -> impl Iterator<Item = [f64; 2]> {
    let Rectangle { min_mm, max_mm } = rectangle;
    let centre = move |cell: usize, cells: usize, axis: usize| {
        min_mm[axis] + (max_mm[axis] - min_mm[axis]) * (cell as f64 + 0.5) / cells as f64
    };
    (0..rows).flat_map(move |row| {
        (0..columns).map(move |column| [centre(column, columns, 0), centre(row, rows, 1)])
    })
}
