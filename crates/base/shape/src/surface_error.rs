//! Why a file holds no closed surface.

use crate::ExtentError;

/// A file that holds no closed surface.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SurfaceError {
    /// A file of another format, or an empty one.
    #[error("is {found}, expected an STL file")]
    Format {
        /// What it is.
        found: &'static str,
    },
    /// The file is neither text nor as long as its number of triangles asks for.
    #[error("is no whole STL file: has {found_bytes} bytes, as a binary one it would have {expected_bytes}")]
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
    /// A size or a place that lengths in mm do not explain.
    #[error(transparent)]
    Extent(#[from] ExtentError),
    /// Nothing that has an inside.
    #[error("has {triangles} triangles of more than no area, expected at least 4")]
    Empty {
        /// Triangles with three different corners that no other covers.
        triangles: usize,
    },
    /// Edges that do not belong to two triangles, or to more in pairs.
    #[error("is not closed: {edges} edges lack a neighbour, one at {}", place(at_mm))]
    NotClosed {
        /// Number of such edges, counted once for each triangle.
        edges: usize,
        /// Middle of one of them, mm.
        at_mm: [f64; 3],
    },
    /// A surface with one side only, like a Klein bottle: it has no inside.
    #[error("is one-sided: its triangles can't all face outwards, as at {}", place(at_mm))]
    OneSided {
        /// Middle of an edge where two of them can't agree, mm.
        at_mm: [f64; 3],
    },
    /// A body that is a sheet without thickness.
    #[error("body {body}, at {}, encloses nothing", place(at_mm))]
    Flat {
        /// Which of the connected surfaces, from 0 in order of their first triangles.
        body: usize,
        /// One of its corners, mm.
        at_mm: [f64; 3],
    },
    /// A connected surface that runs through itself.
    #[error("body {body} overlaps itself with {:.1} % of its surface, as at {}", 100.0 * share, place(at_mm))]
    SelfOverlap {
        /// Which of the connected surfaces, from 0 in order of their first triangles.
        body: usize,
        /// Share of its area that lies in its own inside.
        share: f64,
        /// One place there, mm.
        at_mm: [f64; 3],
    },
    /// A hollow in a hollow: one of the two faces the wrong way, and nothing says which.
    #[error(
        "body {body}, at {}, lies in a cavity and faces inwards like it",
        place(at_mm)
    )]
    Nested {
        /// Which of the connected surfaces, from 0 in order of their first triangles.
        body: usize,
        /// One of its corners, mm.
        at_mm: [f64; 3],
    },
}

impl SurfaceError {
    /// The same in two parts: what is wrong, to be read after the file's name, and what to do about it.
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
