//! What can be wrong with an inverse.

use twintac_config::Problem;
use twintac_shape::ShapeError;

/// Why there is no inverse, or no contact.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum InverseError {
    /// A shape that can't be.
    #[error(transparent)]
    Shape(#[from] ShapeError),
    /// More is known of a shape than can be searched.
    #[error(
        "a shape's table has {presses:.0} presses of {readings} readings, at most {most:.0} numbers can be searched; \
         let it span less, or the sensor have fewer ports"
    )]
    TooLarge {
        /// Presses of the table, 2 mm apart.
        presses: f64,
        /// Readings of each.
        readings: usize,
        /// Most numbers in all.
        most: f64,
    },
    /// No shape is known.
    #[error("no known shape: at least one is needed")]
    NoShape,
    /// A setting that can't be.
    #[error("the inverse's setting {0}")]
    Setting(Problem),
    /// A frame that can't be.
    #[error("a frame's {0}")]
    Frame(Problem),
}
