//! What a page draws, as flat arrays that it can read in place.

use glam::DVec3;

/// One of the arrays. Its number is the one that a page asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Array {
    /// Node indices of the triangles of the gel's surface; `[n_triangles, 3]`, integers.
    SurfaceTriangles,
    /// Node indices of the tetrahedra; `[n_tets, 4]`, integers.
    Tets,
    /// Positions of the nodes of the gel at rest, mm; `[n_nodes, 3]`.
    RestMm,
    /// Displacements of the nodes, mm; `[n_nodes, 3]`.
    DisplacementsMm,
    /// Hydrostatic pressure at the nodes, kPa; `[n_nodes]`.
    PressureKpa,
    /// Von Mises stress at the nodes, kPa; `[n_nodes]`.
    VonMisesKpa,
    /// The pressure map: readings of the taxels interpolated over the gel, kPa; `[64, 64]`, rows
    /// from the lowest y upwards. Empty if the positions of the taxels allow no map.
    MapKpa,
    /// Corners of the indenter's surface in its own frame, mm; `[n_corners, 3]`.
    OutlineMm,
    /// Outward normals there; `[n_corners, 3]`.
    OutlineNormals,
    /// Corner indices of the triangles of the indenter's surface; `[n_triangles, 3]`, integers.
    OutlineTriangles,
    /// The pressure map of the connected sensor, in the same form. Empty if a taxel has no reading.
    DeskMapKpa,
}

impl Array {
    /// All of them, in the order of their numbers.
    pub const ALL: [Self; 11] = [
        Self::SurfaceTriangles,
        Self::Tets,
        Self::RestMm,
        Self::DisplacementsMm,
        Self::PressureKpa,
        Self::VonMisesKpa,
        Self::MapKpa,
        Self::OutlineMm,
        Self::OutlineNormals,
        Self::OutlineTriangles,
        Self::DeskMapKpa,
    ];
}

/// The arrays after the last request. Integers have four bytes, like the other numbers.
#[derive(Default)]
pub struct Arrays {
    indices: [Vec<u32>; 11],
    numbers: [Vec<f32>; 11],
    is_new: [bool; 11],
}

impl Arrays {
    /// The integers of an array; empty for an array of other numbers.
    #[must_use]
    pub fn indices(&self, array: Array) -> &[u32] {
        &self.indices[array as usize]
    }

    /// The numbers of an array; empty for an array of integers.
    #[must_use]
    pub fn numbers(&self, array: Array) -> &[f32] {
        &self.numbers[array as usize]
    }

    /// The arrays that were set since the last call.
    pub(crate) fn take_new(&mut self) -> impl Iterator<Item = Array> {
        let is_new = std::mem::take(&mut self.is_new);
        Array::ALL
            .into_iter()
            .filter(move |array| is_new[*array as usize])
    }

    pub(crate) fn set_indices<const N: usize>(&mut self, array: Array, rows: &[[u32; N]]) {
        self.is_new[array as usize] = true;
        let indices = &mut self.indices[array as usize];
        indices.clear();
        indices.extend_from_slice(rows.as_flattened());
    }

    pub(crate) fn set_points(&mut self, array: Array, points: &[DVec3]) {
        self.is_new[array as usize] = true;
        let numbers = &mut self.numbers[array as usize];
        numbers.clear();
        numbers.extend(points.iter().flat_map(|point| point.as_vec3().to_array()));
    }

    pub(crate) fn set_numbers(&mut self, array: Array, values: &[f64]) {
        self.is_new[array as usize] = true;
        let numbers = &mut self.numbers[array as usize];
        numbers.clear();
        numbers.extend(values.iter().map(|value| *value as f32));
    }
}
