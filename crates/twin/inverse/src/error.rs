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
