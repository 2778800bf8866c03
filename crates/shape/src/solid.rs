//! What a gel can look like. A gel stands on the plane z = 0 (the printed circuit board).

use serde::{Deserialize, Serialize};

/// The undeformed gel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Solid {
    /// A block centred on x = y = 0.
    Block {
        /// Full size along x, y and z, mm.
        size_mm: [f64; 3],
        /// Rounding of the top edges, mm; 0 leaves them sharp.
        #[serde(default)]
        edge_radius_mm: f64,
    },
    /// A block with a domed top.
    Dome(Dome),
    /// A closed triangle surface in an STL file, path relative to the file that names it.
    Stl {
        /// Path of the STL file.
        path: String,
    },
}

/// A rectangular footprint whose top falls off quadratically from a crown: with `s` the fraction of the way from the crown to
/// an edge, the top stands at `crown - drop_x s_x² - drop_y s_y²`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Dome {
    /// Footprint along x, mm: [minimum, maximum].
    pub x_mm: [f64; 2],
    /// Footprint along y, mm: [minimum, maximum].
    pub y_mm: [f64; 2],
    /// Where the crown stands, mm: [x, y].
    pub crown_at_mm: [f64; 2],
    /// Height of the crown, mm.
    pub crown_mm: f64,
    /// Fall from the crown to the edge at minimum and maximum x, mm.
    pub drop_x_mm: [f64; 2],
    /// Fall from the crown to the edge at minimum and maximum y, mm.
    pub drop_y_mm: [f64; 2],
}
