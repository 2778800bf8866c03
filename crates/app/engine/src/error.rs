//! Errors of requests.

/// Why a request fails. Errors in files that people write have the same texts as on the command
/// line.
#[derive(Debug, thiserror::Error)]
pub(crate) enum EngineError {
    /// The text is no request.
    #[error("this is not a request: {0}")]
    Request(#[from] serde_json::Error),
    /// The request needs a sensor.
    #[error("there is no sensor yet: open a description first")]
    NoSensor,
    /// The request needs a mesh.
    #[error("there is no mesh yet: prepare a press first")]
    NoPress,
    /// The request needs a connected sensor.
    #[error("there is no sensor on the desk: connect one first")]
    NoDesk,
    /// The connected sensor has another number of taxels than the description.
    #[error(
        "frames have {n_pressures} pressures, and the description of the sensor has {n_taxels} taxels: open the description of the sensor that is connected"
    )]
    Taxels {
        /// Number of taxels of the description.
        n_taxels: usize,
        /// Number of pressures of a frame.
        n_pressures: usize,
    },
    /// The description cannot be used.
    #[error(transparent)]
    Sensor(#[from] twintac_sensor::SensorError),
    /// The gel cannot be pressed in this way.
    #[error(transparent)]
    Simulate(#[from] twintac_simulate::SimulateError),
    /// A stored file is missing.
    #[error("{0}")]
    File(#[from] std::io::Error),
    /// The file is no surrogate.
    #[error("{file}: {problem}")]
    Surrogate {
        /// The file.
        file: String,
        /// What is wrong.
        problem: String,
    },
    /// The surrogate is that of another gel.
    #[error(transparent)]
    Mismatch(#[from] twintac_fast::FastGelMismatch),
    /// The shape is impossible.
    #[error(transparent)]
    Shape(#[from] twintac_shape::ShapeError),
    /// A setting is out of its range.
    #[error("`{field}` is {found}; give {expected}")]
    Setting {
        /// The setting.
        field: &'static str,
        /// What was found.
        found: f64,
        /// What was expected.
        expected: &'static str,
    },
}
