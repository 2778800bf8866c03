//! Errors of a table over depth.

/// A table that can't be interpolated over depth.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DepthTableError {
    /// A frame has values for another number of taxels.
    #[error("expected features of {expected} taxels, found those of {found}")]
    Taxels {
        /// Taxels of the sensor.
        expected: usize,
        /// Taxels of the frame.
        found: usize,
    },
    /// A frame has a value that is infinite or NaN.
    #[error("expected finite features, found another value at {depth_mm:.3} mm")]
    NotFinite {
        /// Depth of the frame, mm.
        depth_mm: f64,
    },
    /// No frame is below the surface.
    #[error("expected a press into the gel, found {found}")]
    NoPress {
        /// Why the table ends before, in the words of the simulation.
        found: String,
    },
    /// The depths of the frames do not increase.
    #[error("expected increasing depths, found another order")]
    Order,
}
