//! What a page draws, as flat numbers that it reads where they lie.

use glam::DVec3;

/// One of the arrays, by the number that a page asks for it with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Array {
    /// Corners of the triangles of the gel's surface; `[n_triangles, 3]`, whole numbers.
    SurfaceTriangles,
    /// Corners of the tetrahedra; `[n_tets, 4]`, whole numbers.
    Tets,
    /// Nodes of the gel at rest, mm; `[n_nodes, 3]`.
    RestMm,
    /// How far the nodes have moved, mm; `[n_nodes, 3]`.
    DisplacementsMm,
    /// Hydrostatic pressure at the nodes, kPa; `[n_nodes]`.
    PressureKpa,
    /// Von Mises stress at the nodes, kPa; `[n_nodes]`.
    VonMisesKpa,
    /// The pressure map: readings of the taxels interpolated over the gel, kPa; `[64, 64]`, rows from the lowest y on. None where taxels allow no map.
    MapKpa,
    /// Corners of the indenter's surface in its own frame, mm; `[n_corners, 3]`.
    OutlineMm,
    /// Outward normals there; `[n_corners, 3]`.
    OutlineNormals,
    /// Corners of the triangles of the indenter's surface; `[n_triangles, 3]`, whole numbers.
    OutlineTriangles,
    /// The pressure map of the sensor on the desk, as that of its twin. None where a taxel reads nothing.
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

/// The arrays as they are after the last request. Whole numbers have four bytes, as the others have.
#[derive(Default)]
pub struct Arrays {
    indices: [Vec<u32>; 11],
    numbers: [Vec<f32>; 11],
    is_new: [bool; 11],
}

impl Arrays {
    /// Whole numbers of an array.
    #[must_use]
    pub fn indices(&self, array: Array) -> &[u32] {
        &self.indices[array as usize]
    }

    /// Numbers of an array.
    #[must_use]
    pub fn numbers(&self, array: Array) -> &[f32] {
        &self.numbers[array as usize]
    }

    /// The arrays that were set since this was last asked.
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
