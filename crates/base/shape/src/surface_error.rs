//! Errors of files that do not contain a closed surface.

use crate::ExtentError;

/// A file that does not contain a closed surface.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SurfaceError {
    /// A file of another format, or an empty one.
    #[error("is {found}, expected an STL file")]
    Format {
        /// What it is.
        found: &'static str,
    },
    /// The file is neither a text nor as long as its number of triangles requires.
    #[error(
        "is not a complete STL file: it has {found_bytes} bytes, a binary one would have {expected_bytes}"
    )]
    Length {
        /// Length that the number of triangles requires, bytes.
        expected_bytes: usize,
        /// Length of the file, bytes.
        found_bytes: usize,
    },
    /// A text that is not an STL file.
    #[error("line {line}: {problem}")]
    Text {
        /// Line, from 1.
        line: usize,
        /// What is wrong.
        problem: String,
    },
    /// A corner whose coordinates are not finite.
    #[error("triangle {triangle} has a corner that is not finite")]
    NotFinite {
        /// Index of the triangle, from 0.
        triangle: usize,
    },
    /// A size or a position that is not plausible in mm.
    #[error(transparent)]
    Extent(#[from] ExtentError),
    /// A surface without an interior.
    #[error("has {triangles} triangles with an area above zero, expected at least 4")]
    Empty {
        /// Number of triangles with three different corners that are not covered by another.
        triangles: usize,
    },
    /// Edges that do not belong to two triangles, or to a larger number that can be paired.
    #[error("is not closed: {edges} edges lack a neighbour, one at {}", place(at_mm))]
    NotClosed {
        /// Number of such edges, counted once for each triangle.
        edges: usize,
        /// Midpoint of one of them, mm.
        at_mm: [f64; 3],
    },
    /// A surface with one side only, like a Klein bottle: it has no interior.
    #[error(
        "is one-sided: its triangles can't all face outwards, for example at {}",
        place(at_mm)
    )]
    OneSided {
        /// Midpoint of an edge whose two triangles cannot agree, mm.
        at_mm: [f64; 3],
    },
    /// A body that is a sheet without thickness.
    #[error("body {body}, at {}, encloses no volume", place(at_mm))]
    Flat {
        /// Index of the connected surface, from 0 in order of first triangles.
        body: usize,
        /// One of its corners, mm.
        at_mm: [f64; 3],
    },
    /// A connected surface that runs through itself.
    #[error("body {body} overlaps itself: {:.1} % of its surface is inside of it, for example at {}", 100.0 * share, place(at_mm))]
    SelfOverlap {
        /// Index of the connected surface, from 0 in order of first triangles.
        body: usize,
        /// Fraction of its area that is inside of itself.
        share: f64,
        /// A point there, mm.
        at_mm: [f64; 3],
    },
    /// A cavity in a cavity: one of the two faces the wrong way, and it is unknown which.
    #[error(
        "body {body}, at {}, lies in a cavity and faces inwards like it",
        place(at_mm)
    )]
    Nested {
        /// Index of the connected surface, from 0 in order of first triangles.
        body: usize,
        /// One of its corners, mm.
        at_mm: [f64; 3],
    },
}

impl SurfaceError {
    /// The error in two parts: what is wrong, as the end of a sentence that begins with the file's
    /// name, and what to do about it.
    #[must_use]
    pub fn problem_and_remedy(&self) -> (String, String) {
        match self {
            Self::Extent(extent) => (extent.problem(), extent.remedy()),
            other => (
                other.to_string(),
                "export it again as a closed STL surface".to_owned(),
            ),
        }
    }
}

fn place(at_mm: &[f64; 3]) -> String {
    let [x, y, z] = at_mm;
    format!("({x:.3}, {y:.3}, {z:.3}) mm")
}
