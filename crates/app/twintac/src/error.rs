//! What can go wrong.

/// What is wrong, where, and what to do. The text of an error leaves its [`source`](std::error::Error::source) out.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A sensor description cannot be used.
    #[error(transparent)]
    Sensor(#[from] twintac_sensor::SensorError),
    /// The gel cannot be pressed as asked for.
    #[error(transparent)]
    Gel(#[from] twintac_simulate::SimulateError),
    /// The solver found no equilibrium at a depth.
    #[error("the gel cannot be pressed {depth_mm} mm deep: {reason}; press less deep")]
    Depth {
        /// The depth that was asked for, mm.
        depth_mm: f64,
        /// Where the press ended, and why.
        reason: String,
    },
    /// A recording cannot be read.
    #[cfg(feature = "recording")]
    #[error(transparent)]
    Recording(#[from] twintac_recording::RecordingError),
    /// A pressure map cannot be made.
    #[cfg(feature = "map")]
    #[error(transparent)]
    Map(#[from] twintac_map::MapError),
    /// A picture cannot be written.
    #[cfg(feature = "map")]
    #[error(transparent)]
    Picture(#[from] twintac_plot::PlotError),
    /// A twin cannot be read or used.
    #[cfg(feature = "twin")]
    #[error(transparent)]
    Twin(#[from] digitac::DigitacError),
    /// A twin's record does not fit this version of the library.
    #[cfg(feature = "twin")]
    #[error("the twin's settings of the simulation cannot be used")]
    TwinSettings(#[from] serde_json::Error),
    /// A shape can't be.
    #[error(transparent)]
    Shape(#[from] twintac_shape::ShapeError),
    /// A fast twin cannot be read.
    #[cfg(feature = "fast")]
    #[error(transparent)]
    Fast(#[from] twintac_fast::FastFileError),
    /// A sensor cannot be read.
    #[cfg(feature = "live")]
    #[error(transparent)]
    Live(#[from] twintac_live::LiveError),
    /// A run failed.
    #[cfg(feature = "run")]
    #[error(transparent)]
    Run(#[from] twintac_run::RunError),
}
