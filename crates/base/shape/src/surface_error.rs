//! Why a file holds no closed surface.

/// A file that holds no closed surface.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SurfaceError {
    /// The file is neither text nor as long as its number of triangles asks for.
    #[error("is no complete STL file: has {found_bytes} bytes, expected {expected_bytes}")]
    Length {
        /// Length that goes with the number of triangles, bytes.
        expected_bytes: usize,
        /// Length of the file, bytes.
        found_bytes: usize,
    },
    /// A text that is no STL.
    #[error("line {line}: {problem}")]
    Text {
        /// Line, from 1.
        line: usize,
        /// What is wrong.
        problem: String,
    },
    /// A corner that is nowhere.
    #[error("triangle {triangle} has a corner that is not finite")]
    NotFinite {
        /// Number of the triangle, from 0.
        triangle: usize,
    },
    /// Nothing that has an inside.
    #[error("has {triangles} triangles of more than no area, expected at least 4")]
    Empty {
        /// Triangles with three different corners.
        triangles: usize,
    },
    /// Edges that do not belong to exactly two triangles which run along them in opposite directions.
    #[error("is not closed: {edges} edges lack a single opposite neighbour, one at ({:.3}, {:.3}, {:.3}) mm", at_mm[0], at_mm[1], at_mm[2])]
    NotClosed {
        /// Number of such edges, counted once for each triangle.
        edges: usize,
        /// Middle of one of them, mm.
        at_mm: [f64; 3],
    },
    /// The triangles face inwards.
    #[error("is inside out: encloses {volume_mm3:.3} mm³")]
    InsideOut {
        /// Enclosed volume, mm³.
        volume_mm3: f64,
    },
}
