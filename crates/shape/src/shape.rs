//! The rigid shapes that press.

use serde::{Deserialize, Serialize};

/// A rigid indenter. `edge_radius_mm` rounds every convex edge without changing the outer size.
/// Prismatic shapes have their profile in the xy plane and stand on z = 0, `height_mm` tall.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Shape {
    /// A ball.
    Sphere {
        /// Radius, mm.
        radius_mm: f64,
    },
    /// A flat-ended upright cylinder.
    Cylinder {
        /// Radius, mm.
        radius_mm: f64,
        /// Height, mm.
        height_mm: f64,
        /// Edge rounding, mm.
        edge_radius_mm: f64,
    },
    /// A box.
    Box {
        /// Full size along x, y and z, mm.
        size_mm: [f64; 3],
        /// Edge rounding, mm.
        edge_radius_mm: f64,
    },
    /// Two crossed bars in the shape of an X (a plus turned by 45°).
    X {
        /// Length of each bar, mm.
        length_mm: f64,
        /// Width of each bar, mm.
        width_mm: f64,
        /// Height, mm.
        height_mm: f64,
        /// Edge rounding, mm.
        edge_radius_mm: f64,
    },
    /// An upright tube.
    Ring {
        /// Outer radius, mm.
        outer_radius_mm: f64,
        /// Inner radius, mm.
        inner_radius_mm: f64,
        /// Height, mm.
        height_mm: f64,
        /// Edge rounding, mm.
        edge_radius_mm: f64,
    },
    /// An upright equilateral prism, centroid at the origin, one corner towards +x.
    Triangle {
        /// Side length, mm.
        side_mm: f64,
        /// Height, mm.
        height_mm: f64,
        /// Edge rounding, mm.
        edge_radius_mm: f64,
    },
    /// A roof-shaped wedge that touches with its ridge, which lies along y.
    Wedge {
        /// Full opening angle at the ridge, radians.
        angle_rad: f64,
        /// Length of the ridge along y, mm.
        length_mm: f64,
        /// Height from ridge to base, mm.
        height_mm: f64,
        /// Rounding of the ridge and edges, mm.
        edge_radius_mm: f64,
    },
    /// A closed triangle surface in an STL file, path relative to the file that names it; its lowest point is moved to the origin's z.
    Stl {
        /// Path of the STL file.
        path: String,
    },
}

/// A shape that can't be.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("`{field}` is {found}, expected {expected}")]
pub struct ShapeError {
    /// The offending field.
    pub field: String,
    /// What was found.
    pub found: String,
    /// What was expected.
    pub expected: String,
}
