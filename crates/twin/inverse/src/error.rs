//! Errors of contact estimation.

use twintac_config::Problem;
use twintac_shape::ShapeError;

/// Why an [`Inverse`](crate::Inverse) cannot be made, or a frame cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum InverseError {
    /// An impossible shape.
    #[error(transparent)]
    Shape(#[from] ShapeError),
    /// The table of a shape is too large to be searched.
    #[error(
        "a shape's table has {presses:.0} presses of {readings} readings, at most {most:.0} numbers can be searched; \
         reduce the range of the shape, or the number of ports"
    )]
    TooLarge {
        /// Number of presses in the table, whose locations are 2 mm apart.
        presses: f64,
        /// Number of readings of each press.
        readings: usize,
        /// Largest number of values in a table.
        most: f64,
    },
    /// A map of the base of a gel, from a surrogate that was trained at its taxels alone.
    #[error(
        "there is no map of the base of this gel: boxes are cast into it, so its surrogate was trained at the taxels alone"
    )]
    NoFloor,
    /// There is no known shape.
    #[error("there is no known shape: at least one is needed")]
    NoShape,
    /// A setting outside its range.
    #[error("the setting of the contact estimation {0}")]
    Setting(Problem),
    /// Readings or a time outside their ranges.
    #[error("a frame's {0}")]
    Frame(Problem),
}
