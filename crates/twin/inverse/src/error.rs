//! What can be wrong with an inverse.

use twintac_shape::ShapeError;

/// Why there is no inverse.
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
    #[error("the inverse's `{field}` is {found}, expected {expected}")]
    Setting {
        /// Its name.
        field: &'static str,
        /// What it is.
        found: f64,
        /// What it may be.
        expected: &'static str,
    },
}
