//! Why there is no map.

/// Why a pressure map could not be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MapError {
    /// Two inputs that belong together differ in length, or a setting is out of its range.
    #[error("{what}: expected {expected}, found {found}")]
    Input {
        /// The input that is wrong.
        what: &'static str,
        /// What it should have been.
        expected: String,
        /// What it was.
        found: String,
    },
    /// The interpolation through the taxels has no unique solution.
    #[error("the pressure map cannot meet the taxels' values: two taxels share a place (pivot {pivot:e})")]
    Singular {
        /// The pivot that vanished, relative to a diagonal of one.
        pivot: f64,
    },
}
